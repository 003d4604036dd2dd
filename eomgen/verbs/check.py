"""eomgen check: validates, and counts the degrees of freedom."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

from eomgen.documents import Document, Lines, listed, plain_document
from eomgen.errors import Problem
from eomgen.mechanics.constraints import Freedom
from eomgen.mechanics.dynamics import reported_of_nodes, with_nodes_balanced
from eomgen.mechanics.free_bodies import Structure
from eomgen.model import Model, Truss
from eomgen.proof import branches_otherwise, counted_otherwise, lines_otherwise
from eomgen.symbolic.print import to_text
from eomgen.verbs.checked import Checked, LoopStart, checked_model
from eomgen.verbs.freedom_lines import branch_lines, freedom_lines


def check_document(model: Model) -> Document:
    """The model's parts and its degrees of freedom, by rank and by the counting formula."""
    model = with_nodes_balanced(model)
    found = checked_model(model)
    lines = [*_declared_lines(found), *freedom_lines(model, found.freedom), *_start_lines(found), *_rest_lines(found)]
    reported = {**_declared(found), **_counted(found), **_started(found.start)}
    wrong = (
        counted_otherwise(model, found.modes, found.freedom, found.structure)
        or _closed_otherwise(found)
        or lines_otherwise(lines, reported, found.freedom)
    )
    entries = {"ok": not wrong, **reported, "problems": [Problem("", wrong).as_dict()] if wrong else []}
    document = plain_document(model, lambda: entries, Lines(tuple(lines)), failed=wrong)
    return replace(document, cautions=found.cautions)


def _closed_otherwise(found: Checked) -> str:
    begun, branches = found.start.begun, found.start.branches
    return "" if begun is None or branches is None else branches_otherwise(found.model, begun.values, branches)


def _declared_lines(found: Checked) -> list[str]:
    model, missing = found.model, found.missing
    remark = dict.fromkeys(found.driven, " (driven)") | dict.fromkeys(found.dependent, " (dependent)")
    count = len(model.warnings) + len(found.cautions)
    reported = "no problems found" if not count else f"{count} warning{'s' if count > 1 else ''}"
    lines = [f"{model.name}: {reported}", f"space: {model.space}", f"bodies: {listed(model.bodies)}"]
    lines += [f"trusses: {listed(_truss(*each) for each in model.trusses.items())}"] if model.trusses else []
    lines.append(f"coordinates: {listed(q + remark.get(q, '') for q in model.coordinates)}")
    lines += [f"unknowns: {listed(model.unknowns)}"] if model.unknowns else []
    lines += [f"parameters without a value: {listed(missing)}"] if missing else []
    units = model.inferred_units
    lines += [f"node: {words}" for words in reported_of_nodes(model)]
    return [*lines, f"units inferred: {listed(f'{name} [{unit}]' for name, unit in units.items())}"] if units else lines


def _start_lines(found: Checked) -> list[str]:
    start = found.start
    begun = start.begun
    lines = [f"start: {start.refused}"] if start.refused else []
    lines += [f"start {begun.words}"] if begun is not None and begun.words else []
    lines += [f"the start is {begun.fork.words}"] if begun is not None and begun.fork is not None else []
    return [*lines, *branch_lines(found.model, start.branches)]


def _rest_lines(found: Checked) -> list[str]:
    """Lines about a mechanism or structure without coordinates, open contacts, and parts that are not derived yet."""
    mobility, structure, waiting = found.mobility, found.structure, found.unbuilt
    lines = [] if mobility is None else [f"mobility: {mobility}, the bodies free to move but for their constraints"]
    lines += [] if structure is None else [f"structure: {_held(structure)}"]
    lines += [f"open at the start: {listed(found.open)}"] if found.open else []
    lines += [f"not derived yet: {listed(f'{kind} ({where})' for where, kind in waiting)}"] if waiting else []
    return lines


def _truss(name: str, truss: Truss) -> str:
    return f"{name} ({len(truss.nodes)} nodes, {len(truss.members)} members)"


def _held(structure: Structure) -> str:
    """Stability and statical determinacy of a structure, by the rank of its supports and the forces to be found."""
    unknowns = f", held by {listed(p.name for p in structure.unknowns)} too" if structure.unknowns else ""
    extra = structure.indeterminacy
    surplus = "" if not extra else f"{extra} reaction{'s' if extra > 1 else ''} more than independent ones"
    if structure.mobility and not structure.turns_idly:
        return f"a mechanism, it can move{unknowns}" + (f"; {surplus}" if surplus else "")
    return f"stable, statically {f'indeterminate: {surplus}' if surplus else 'determinate'}{unknowns}"


def _declared(found: Checked) -> dict[str, Any]:
    model, structure = found.model, found.structure
    return {
        "name": model.name,
        "space": model.space,
        "bodies": list(model.bodies),
        "coordinates": list(model.coordinates),
        "driven": found.driven,
        "dependent": found.dependent,
        "missing_values": found.missing,
        "inferred_units": model.inferred_units,
        "unknowns": list(model.unknowns),
        "mobility": found.mobility,
        "indeterminacy": None if structure is None else structure.indeterminacy,
        "open_at_start": list(found.open),
        "not_derived_yet": [{"where": where, "kind": kind} for where, kind in found.unbuilt],
    }


def _counted(found: Checked) -> dict[str, Any]:
    freedom = found.freedom
    return {
        "degrees_of_freedom": freedom.by_rank,
        "by_formula": freedom.by_formula,
        "formula": freedom.formula or None,
        "not_counted": freedom.not_counted or None,
        "position_freedoms": found.positions,
        "closing": list(freedom.closing),
        "reaction_only": list(freedom.identical),
        "redundant": [
            {"tie": r.constraint, "row": r.number, "follows_from": list(r.others)} for r in freedom.redundant
        ],
        "velocity_rows": _velocity_rows(freedom),
    }


def _started(start: LoopStart) -> dict[str, Any]:
    begun, branches = start.begun, start.branches
    changes = () if begun is None else begun.changes
    ways = () if branches is None else (branches.here, *branches.others)
    return {
        "start": None if begun is None else begun.values,
        "start_refused": start.refused or None,
        "change_point": begun is not None and begun.fork is not None,
        "start_changed": [{"name": c.name, "from": c.before, "to": c.after, "given": c.given} for c in changes],
        "branches": [
            {
                "values": dict(way.values),
                "sign": way.sign or None,
                "left": {side.constraint: side.left for side in way.sides},
            }
            for way in ways
        ],
    }


def _velocity_rows(freedom: Freedom) -> list[dict[str, Any]]:
    rows = () if freedom.integrability is None else freedom.integrability.rows
    return [
        {
            "tie": r.constraint,
            "row": r.number,
            "integrable": r.integrable,
            "integral": None if r.integral is None else to_text(r.integral),
        }
        for r in rows
    ]
