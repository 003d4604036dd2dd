"""eomgen check: validates, and counts the degrees of freedom."""

from __future__ import annotations

from collections.abc import Sequence

from eomgen.errors import EomgenError, MissingValues, ModelError
from eomgen.mechanics.contacts import Modes
from eomgen.mechanics.instant.snapshot import mobility_of
from eomgen.mechanics.loops.branches import Branches, branches_of_loops
from eomgen.mechanics.loops.freedom import Freedom, freedom_of
from eomgen.mechanics.loops.integrability import VelocityRow
from eomgen.mechanics.loops.start import Start, start_of_motion
from eomgen.mechanics.statics.rest_contacts import modes_at_rest
from eomgen.mechanics.statics.structure import Structure, structure_of
from eomgen.mechanics.system import system_of
from eomgen.model.parts import Model, Truss
from eomgen.model.unbuilt import unbuilt
from eomgen.model.values import exact_parameters
from eomgen.simulation.course import modes_at_start
from eomgen.symbolic.text import to_text
from eomgen.verbs.branch_lines import branch_lines
from eomgen.verbs.outcome import Outcome, listed


def check(model: Model) -> Outcome:
    """The model's parts and its degrees of freedom, by rank beside the count by formula."""
    modes = modes_at_start(model)
    away = [name for name, mode in modes.items() if not mode.closed]
    freedom = freedom_of(model, modes)
    waiting = unbuilt(model)
    missing = [name for name in model.parameters if name not in exact_parameters(model)]
    driven = [name for name, coordinate in model.coordinates.items() if coordinate.driven]
    dependent = [name for name, coordinate in model.coordinates.items() if coordinate.dependent]
    remark = dict.fromkeys(driven, " (driven)") | dict.fromkeys(dependent, " (dependent)")
    lines = [f"{model.name}: no problems found", f"space: {model.space}", f"bodies: {listed(model.bodies)}"]
    lines += [f"trusses: {listed(_truss(*each) for each in model.trusses.items())}"] if model.trusses else []
    lines.append(f"coordinates: {listed(q + remark.get(q, '') for q in model.coordinates)}")
    lines += [f"unknowns: {listed(model.unknowns)}"] if model.unknowns else []
    lines += [f"parameters without a value: {listed(missing)}"] if missing else []
    still = not model.coordinates and bool(model.constraints or model.trusses)
    mobility = mobility_of(model) if still else None
    structure = structure_of(system_of(model, modes_at_rest(model))) if still else None
    lines += _freedom_lines(model, freedom)
    begun, branches, refused = _start_of_loops(model, modes, freedom)
    lines += [f"start: {refused}"] if refused else []
    lines += [f"start {begun.words}"] if begun is not None and begun.words else []
    lines += [f"the start is {begun.fork.words}"] if begun is not None and begun.fork is not None else []
    lines += branch_lines(model, branches)
    lines += [] if mobility is None else [f"mobility: {mobility}, the bodies free to move but for their ties"]
    lines += [] if structure is None else [f"structure: {_held(structure)}"]
    lines += [f"open at the start: {listed(away)}"] if away else []
    lines += [f"not derived yet: {listed(f'{kind} ({where})' for where, kind in waiting)}"] if waiting else []
    payload = {
        "ok": True, "name": model.name, "space": model.space, "bodies": list(model.bodies),
        "coordinates": list(model.coordinates), "driven": driven, "dependent": dependent, "missing_values": missing,
        "degrees_of_freedom": freedom.by_rank, "by_formula": freedom.by_formula, "formula": freedom.formula or None,
        "not_counted": freedom.not_counted or None, "mobility": mobility,
        "indeterminacy": None if structure is None else structure.indeterminacy, "unknowns": list(model.unknowns),
        "open_at_start": away, "closing": list(freedom.closing), "reaction_only": list(freedom.identical),
        "redundant": [{"tie": r.tie, "row": r.number, "follows_from": list(r.others)} for r in freedom.redundant],
        "position_freedoms": _positions(freedom), "velocity_rows": _velocity_rows(freedom),
        "start": None if begun is None else begun.values, "start_refused": refused or None,
        "change_point": bool(begun is not None and begun.fork),
        "start_changed": [{"name": c.name, "from": c.before, "to": c.after, "given": c.given}
                          for c in (begun.changes if begun is not None else ())],
        "branches": [] if branches is None else [
            {"values": dict(each.values), "sign": each.sign or None, "left": {s.tie: s.left for s in each.sides}}
            for each in (branches.here, *branches.others)],
        "not_derived_yet": [{"where": where, "kind": kind} for where, kind in waiting], "problems": [],
    }  # fmt: skip
    return Outcome("\n".join(lines) + "\n", payload)


def _start_of_loops(model: Model, modes: Modes, freedom: Freedom) -> tuple[Start | None, Branches | None, str]:
    """(the start at which loops close, the ways in which they do, why there is none); None where nothing closes.

    Raises:
        ModelError: declared speeds that do not stand for the rates.
    """
    if not model.coordinates or not (freedom.closing or model.speeds):
        return None, None, ""
    try:
        system = system_of(model, {name: mode for name, mode in modes.items() if mode.closed})
        if not freedom.closing:
            return None, None, ""
        begun = start_of_motion(system)
        return begun, None if begun.fork else branches_of_loops(system, begun.values), ""
    except MissingValues:
        return None, None, ""
    except ModelError:
        raise
    except EomgenError as error:  # an error of the verbs that need a start
        return None, None, error.what


def _truss(name: str, truss: Truss) -> str:
    return f"{name} ({len(truss.nodes)} nodes, {len(truss.members)} members)"


def _held(structure: Structure) -> str:
    """How a structure stands, by the rank of what holds it; forces that are asked for hold it too."""
    unknowns = f", held by {listed(p.name for p in structure.unknowns)} too" if structure.unknowns else ""
    extra = structure.indeterminacy
    surplus = "" if not extra else f"{extra} reaction{'s' if extra > 1 else ''} more than independent ones"
    if structure.mobility and not structure.turns_idly:
        return f"a mechanism, it can move{unknowns}" + (f"; {surplus}" if surplus else "")
    return f"stable, statically {f'indeterminate: {surplus}' if surplus else 'determinate'}{unknowns}"


def _freedom_lines(model: Model, freedom: Freedom) -> list[str]:
    if freedom.by_rank is None:
        lines = [f"degrees of freedom: not counted yet ({freedom.not_counted})"]
        return lines if freedom.by_formula is None else [*lines, _formula_line(model, freedom)]
    lines = [f"degrees of freedom: {freedom.by_rank} by rank", _formula_line(model, freedom)]
    lines += [f"ties that close: {listed(freedom.closing)}"] if freedom.closing else []
    lines += [f"ties that only react: {listed(freedom.identical)}"] if freedom.identical else []
    lines += _velocity_lines(freedom)
    for row in freedom.redundant:
        others = f", it follows from {listed(row.others) if row.others else 'its other rows'}"
        lines.append(f"redundant: row {row.number} of tie '{row.tie}'{others}")
    return lines


def _velocity_lines(freedom: Freedom) -> list[str]:
    """Of ties that are velocities: which of them are holonomic, what they keep, and how many freedoms in position."""
    found = freedom.integrability
    if found is None:
        return []
    free = [row for row in found.rows if not row.integrable]
    lines = [f"not integrable (nonholonomic): {listed(_rows(free))}"] if free else []
    for row in found.rows:
        if row.integrable:
            kept = "" if row.integral is None else f": {to_text(row.integral)} = 0"
            lines.append(f"integrable (holonomic): row {row.number} of tie '{row.tie}'{kept}")
    more = found.positions != freedom.by_rank
    return [*lines, f"degrees of freedom in position: {found.positions}"] if more else lines


def _rows(rows: Sequence[VelocityRow]) -> list[str]:
    """row 1 of tie 'edge', rows 2 and 3 of tie 'wheel'"""
    numbers: dict[str, list[str]] = {}
    for row in rows:
        numbers.setdefault(row.tie, []).append(str(row.number))
    return [f"row{'s' * (len(each) > 1)} {' and '.join(each)} of tie '{tie}'" for tie, each in numbers.items()]


def _positions(freedom: Freedom) -> int | None:
    return freedom.by_rank if freedom.integrability is None else freedom.integrability.positions


def _velocity_rows(freedom: Freedom) -> list[dict]:
    rows = () if freedom.integrability is None else freedom.integrability.rows
    return [{"tie": r.tie, "row": r.number, "integrable": r.integrable,
             "integral": None if r.integral is None else to_text(r.integral)} for r in rows]  # fmt: skip


def _formula_line(model: Model, freedom: Freedom) -> str:
    placed = [name for name, body in model.bodies.items() if body.joint is None or not body.joint.carries_reaction]
    remark = f"; {listed(placed)}: placed, counted as free" if placed else ""
    return f"count by formula: {freedom.by_formula} = {freedom.formula or '0'}{remark}"
