"""eomgen check: validates, and counts the degrees of freedom."""

from __future__ import annotations

from eomgen.mechanics.freedom import Freedom, freedom_of
from eomgen.mechanics.instant.snapshot import mobility_of
from eomgen.mechanics.statics.rest_contacts import modes_at_rest
from eomgen.mechanics.statics.structure import Structure, structure_of
from eomgen.mechanics.system import system_of
from eomgen.model.parts import Model, Truss
from eomgen.model.unbuilt import unbuilt
from eomgen.model.values import exact_parameters
from eomgen.simulation.course import modes_at_start
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
        "not_derived_yet": [{"where": where, "kind": kind} for where, kind in waiting], "problems": [],
    }  # fmt: skip
    return Outcome("\n".join(lines) + "\n", payload)


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
    for row in freedom.redundant:
        others = f", it follows from {listed(row.others)}" if row.others else ""
        lines.append(f"redundant: row {row.number} of tie '{row.tie}'{others}")
    return lines


def _formula_line(model: Model, freedom: Freedom) -> str:
    placed = [name for name, body in model.bodies.items() if body.joint is None or not body.joint.carries_reaction]
    remark = f"; {listed(placed)}: placed, counted as free" if placed else ""
    return f"count by formula: {freedom.by_formula} = {freedom.formula or '0'}{remark}"
