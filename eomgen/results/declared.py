"""Declared models: the document of a check of one, and of the difference of two."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace
from typing import Any

from eomgen.documents import (
    Document,
    Formula,
    Grid,
    Lines,
    Statement,
    Step,
    document_of,
    listed,
    plain_document,
    prose,
    sides_of,
)
from eomgen.errors import Problem
from eomgen.frozen import dataclass
from eomgen.mechanics.dynamics import EquationsOfMotion
from eomgen.model import Model
from eomgen.proof import branches_otherwise, counted_otherwise, lines_otherwise
from eomgen.study import Checked, model_to_study
from eomgen.symbolic.exact import book_form, equal_at_random_states
from eomgen.symbolic.expression import Graph, Scalar, symbols_of
from eomgen.symbolic.numeric import Work, transplanted
from eomgen.symbolic.print import to_text

# -------- check ------------------------------------------------------------------------------------------------
# Model -> the document of a check: its parts, its degrees of freedom, how its loops close, likely mistakes.


def check_document(model: Model) -> Document:
    """The model's parts and its degrees of freedom, by rank and by the counting formula."""
    model = model_to_study(model)
    found = Checked.of(model)
    lines = [*_declared_lines(found), *_freedom_lines(found), *_start_lines(found), *_rest_lines(found)]
    reported = {**_declared(found), **_counted(found), **_started(found)}
    wrong = counted_otherwise(found) or branches_otherwise(found) or lines_otherwise(lines, reported, found)
    entries = {"ok": not wrong, **reported, "problems": [Problem("", wrong).as_dict()] if wrong else []}
    document = plain_document(model, lambda: entries, Lines(tuple(lines)), failed=wrong)
    return replace(document, cautions=found.cautions)


def _declared_lines(found: Checked) -> list[str]:
    model, missing = found.model, found.missing
    remark = dict.fromkeys(found.driven, " (driven)") | dict.fromkeys(found.dependent, " (dependent)")
    count = len(model.warnings) + len(found.cautions)
    reported = "no problems found" if not count else f"{count} warning{'s' if count > 1 else ''}"
    lines = [f"{model.name}: {reported}", f"space: {model.space}", f"bodies: {listed(model.bodies)}"]
    sizes = (f"{name} ({len(each.nodes)} nodes, {len(each.members)} members)" for name, each in model.trusses.items())
    lines += [f"trusses: {listed(sizes)}"] if model.trusses else []
    lines.append(f"coordinates: {listed(q + remark.get(q, '') for q in model.coordinates)}")
    lines += [f"unknowns: {listed(model.unknowns)}"] if model.unknowns else []
    lines += [f"parameters without a value: {listed(missing)}"] if missing else []
    units = model.inferred_units
    lines += [f"node: {words}" for words in found.nodes]
    return [*lines, f"units inferred: {listed(f'{name} [{unit}]' for name, unit in units.items())}"] if units else lines


def _start_lines(found: Checked) -> list[str]:
    start = found.start
    begun = start.begun
    lines = [f"start: {start.refused}"] if start.refused else []
    lines += [f"start {begun.words}"] if begun is not None and begun.words else []
    lines += [f"the start is {begun.fork.words}"] if begun is not None and begun.fork is not None else []
    return [*lines, *_branch_lines(found)]


def _rest_lines(found: Checked) -> list[str]:
    """Lines about a mechanism or structure without coordinates, open contacts, and parts that are not derived yet."""
    mobility, structure, waiting = found.mobility, found.structure, found.unbuilt
    lines = [] if mobility is None else [f"mobility: {mobility}, the bodies free to move but for their constraints"]
    lines += [] if structure is None else [f"structure: {_held(found)}"]
    lines += [f"open at the start: {listed(found.open)}"] if found.open else []
    lines += [f"not derived yet: {listed(f'{kind} ({where})' for where, kind in waiting)}"] if waiting else []
    return lines


def _held(found: Checked) -> str:
    """Stability and statical determinacy of a structure, by the rank of its supports and the forces to be found."""
    structure = found.structure
    assert structure is not None
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
        "velocity_rows": _velocity_rows(found),
    }


def _started(found: Checked) -> dict[str, Any]:
    start, begun, branches = found.start, found.start.begun, found.start.branches
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


def _velocity_rows(found: Checked) -> list[dict[str, Any]]:
    rows = () if found.freedom.integrability is None else found.freedom.integrability.rows
    return [
        {
            "tie": r.constraint,
            "row": r.number,
            "integrable": r.integrable,
            "integral": None if r.integral is None else to_text(r.integral),
        }
        for r in rows
    ]


# -- degrees of freedom, and how loops close, in words --------------------------------------------------

MOST_REPORTED = 5  # other ways


def _freedom_lines(found: Checked) -> list[str]:
    """Lines that state the degrees of freedom by rank and by formula, and the reasons for both."""
    freedom = found.freedom
    if freedom.by_rank is None:
        lines = [f"degrees of freedom: not counted yet ({freedom.not_counted})"]
        return lines if freedom.by_formula is None else [*lines, _formula_line(found)]
    lines = [f"degrees of freedom: {freedom.by_rank} by rank", _formula_line(found)]
    lines += (
        [f"constraints that close: {_constraints(freedom.closing_rows, freedom.identical)}"] if freedom.closing else []
    )
    lines += (
        [f"constraints that only react: {_constraints(freedom.identical_rows, freedom.closing)}"]
        if freedom.identical
        else []
    )
    lines += _velocity_lines(found)
    for row in freedom.redundant:
        alone = "the joints" if row.by_joints else "its other rows"
        others = f", it follows from {listed(row.others) if row.others else alone}"
        lines.append(f"redundant: row {row.number} of constraint '{row.constraint}'{others}")
    return lines


def _constraints(rows: Sequence[tuple[str, int]], beside: Sequence[str]) -> str:
    """Names the constraints of rows, with row numbers where other rows of it are named too: floor (rows 2 and 3)."""
    return listed(
        f"{constraint} ({_numbered(numbers)})" if constraint in beside else constraint
        for constraint, numbers in _by_constraint(rows).items()
    )


def _by_constraint(rows: Sequence[tuple[str, int]]) -> dict[str, list[int]]:
    found: dict[str, list[int]] = {}
    for constraint, number in rows:
        found.setdefault(constraint, []).append(number)
    return found


def _numbered(numbers: Sequence[int]) -> str:
    """row 1; rows 1, 2 and 3"""
    *before, last = map(str, numbers)
    return f"rows {', '.join(before)} and {last}" if before else f"row {last}"


def _velocity_lines(checked: Checked) -> list[str]:
    """Lines about velocity constraints: the holonomic ones with their integrals, and the degrees of freedom in
    position."""
    found = checked.freedom.integrability
    if found is None:
        return []
    free = [(row.constraint, row.number) for row in found.rows if not row.integrable]
    lines = [f"not integrable (nonholonomic): {listed(_rows(free))}"] if free else []
    kept: dict[str, list[tuple[str, int]]] = {}
    for row in found.rows:
        if row.integrable:
            integral = "" if row.integral is None else f": {to_text(row.integral)} = 0"
            kept.setdefault(integral, []).append((row.constraint, row.number))
    lines += [f"integrable (holonomic): {each}{integral}" for integral, rows in kept.items() for each in _rows(rows)]
    more = found.positions != checked.freedom.by_rank
    return [*lines, f"degrees of freedom in position: {found.positions}"] if more else lines


def _rows(rows: Sequence[tuple[str, int]]) -> list[str]:
    """row 1 of constraint 'edge', rows 2 and 3 of constraint 'wheel'"""
    named = _by_constraint(rows).items()
    return [f"{_numbered(numbers)} of constraint '{constraint}'" for constraint, numbers in named]


def _formula_line(found: Checked) -> str:
    freedom, bodies = found.freedom, found.model.bodies
    placed = [name for name, body in bodies.items() if body.joint is None or not body.joint.carries_reaction]
    remark = f"; {listed(placed)}: placed, counted as free" if placed else ""
    return f"count by formula: {freedom.by_formula} = {freedom.formula or '0'}{remark}"


def _branch_lines(found: Checked) -> list[str]:
    """The way at the start, the others, and the meaning of (+), (-), left and right."""
    branches = found.start.branches
    if branches is None:
        return []
    here, *others = (each.in_words(branches.sided) for each in (branches.here, *branches.others[:MOST_REPORTED]))
    lines = [f"loops at the start: {here}"]
    if not others:
        return lines
    more = len(branches.others) - MOST_REPORTED
    others += [f"and {more} more ways"] if more > 0 else []
    kept = f" with the same {listed(branches.kept)}" if branches.kept else ""
    also = [f"they also close{kept} at {others[0]}"] if len(others) == 1 else [f"they also close{kept} at"]
    return [*lines, *also, *(f"  {each}" for each in others if len(others) > 1), *_keys(found)]


def _keys(found: Checked) -> list[str]:
    branches = found.start.branches
    assert branches is not None
    here, first = branches.here, branches.others[0]
    sign = f"(+) and (-): det d phi/d({listed(here.values)}), which is 0 in a dead centre, where two ways meet"
    lines = [sign] if here.sign else []
    lines += [
        f"left and right of '{s.constraint}': of the line from the hinge of '{s.first}' to that of '{s.second}'"
        for s in here.sides
        if s.constraint in branches.sided
    ]
    near = ", ".join(f"{name} = {{ near = {_number(found.model, name, x)} }}" for name, x in first.values.items())
    return [f"  {line}" for line in (*lines, f"another way is taken from a start near it: {near}")]


def _number(model: Model, name: str, value: float) -> str:
    """A guess as it stands in the model file, in the unit of the coordinate."""
    return model.in_own_unit(name, value, 4).split()[0]


# -------- difference -------------------------------------------------------------------------------------------
# Equations of two models -> Difference: what is declared otherwise, and which equations of motion differ.

DECLARED = ("coordinates", "speeds", "states", "parameters", "inputs", "bodies", "constraints", "forces")


@dataclass(frozen=True)
class Compared:
    """One equation in both models, R = 0.

    Args:
        name: of the speed along which it is, or of a constraint's row.
        first, second: R in this model and in the other; None where one does not have it.
        same: True if they are the same function, with a factor of 1.
    """

    name: str
    first: Scalar | None
    second: Scalar | None
    same: bool

    @property
    def status(self) -> str:
        if self.first is None or self.second is None:
            return "removed" if self.second is None else "added"
        return "same" if self.same else "changed"


@dataclass(frozen=True)
class Difference:
    """The equations of motion of two models, side by side.

    Args:
        declared: {table of parts: (names that only the other model declares, names that only this one declares)}.
        values: the values of parameters that both have, where they differ [SI].
        equations: every equation of motion and every row that closes a constraint, of either.
    """

    first: Model
    second: Model
    declared: Mapping[str, tuple[list[str], list[str]]]
    values: Mapping[str, tuple[float | None, float | None]]
    equations: tuple[Compared, ...]

    def entries(self) -> Mapping[str, Any]:
        """Entries of the JSON document."""
        return {
            "name": self.first.name,
            "other": self.second.name,
            "same": not (self.declared or self.values or any(x.status != "same" for x in self.equations)),
            "declared": {table: {"added": new, "removed": old} for table, (new, old) in self.declared.items()},
            "values": {name: list(pair) for name, pair in self.values.items()},
            "equations": [
                {
                    "of": x.name,
                    "status": x.status,
                    "this": None if x.first is None else to_text(x.first),
                    "other": None if x.second is None else to_text(x.second),
                    "difference": to_text(_difference(x)) if x.status == "changed" else None,
                }
                for x in self.equations
            ],
        }

    @property
    def steps(self) -> tuple[Step, ...]:
        """Sections of the text: the declarations, then the equations of motion."""
        return (*self._declarations, Step("equations", "Equations of motion", tuple(self._statements)))

    @property
    def _declarations(self) -> tuple[Step, ...]:
        rows = [(table, ", ".join(new), ", ".join(old)) for table, (new, old) in self.declared.items()]
        values = [(name, _shown(a), _shown(b)) for name, (a, b) in self.values.items()]
        reported: list[Statement] = []
        if rows:
            reported.append(Grid(("declared", "only in the other", "only in this one"), tuple(rows)))
        if values:
            reported.append(Grid(("value of", "in this one", "in the other"), tuple(values)))
        return (Step("declared", "What is declared", tuple(reported)),) if reported else ()

    @property
    def _statements(self) -> list[Statement]:
        by_status = {status: [x for x in self.equations if x.status == status] for status in ("same", "changed")}
        reported: list[Statement] = []
        if by_status["same"]:
            names = ", ".join(x.name for x in by_status["same"])
            reported.append(prose(f"The same in both, as functions of all names: {names}."))
        for x in by_status["changed"]:
            assert x.first is not None and x.second is not None
            reported += [prose(f"Along {x.name}, here and in the other, and the other less this one:")]
            reported += [Formula((side, 0)) for side in (x.first, x.second)] + [Formula((_difference(x),))]
        for x in self.equations:
            if x.status in ("added", "removed"):
                where = "in the other" if x.status == "added" else "in this one"
                reported += [prose(f"Along {x.name}, only {where}:"), Formula((_present(x), 0))]
        return reported or [prose("Nothing is free to move in either.")]


def difference_of(first: EquationsOfMotion, second: EquationsOfMotion) -> Difference:
    """The equations of motion of two models, compared."""
    own, other, graph = first.system.scope.model, second.system.scope.model, Graph()
    rows = [_equation_rows(e, graph) for e in (first, second)]
    equations = (_compared(name, *(row.get(name) for row in rows)) for name in dict.fromkeys((*rows[0], *rows[1])))
    return Difference(own, other, _declared_otherwise(own, other), _values(own, other), tuple(equations))


def _declared_otherwise(first: Model, second: Model) -> dict[str, tuple[list[str], list[str]]]:
    found = {}
    for table in DECLARED:
        own, other = (list(getattr(model, table) or ()) for model in (first, second))
        found[table] = ([x for x in other if x not in own], [x for x in own if x not in other])
    return {table: names for table, names in found.items() if any(names)}


def _values(first: Model, second: Model) -> dict[str, tuple[float | None, float | None]]:
    own, other = (model.exact_parameters() for model in (first, second))
    shared = [name for name in first.parameters if name in second.parameters]
    pairs = {name: (own.get(name), other.get(name)) for name in shared}
    return {
        name: (None if a is None else float(a), None if b is None else float(b))
        for name, (a, b) in pairs.items()
        if a != b
    }


def difference_document(first: EquationsOfMotion, second: EquationsOfMotion) -> Document:
    """Differences of the second of two models from the first, not proven yet."""
    found = difference_of(first, second)
    model, other = found.first, found.second
    return replace(document_of(model, f"difference from {other.name}", found.steps), entries=found.entries)


def _equation_rows(equations: EquationsOfMotion, graph: Graph) -> dict[str, Scalar]:
    """R of every equation by its name, over the symbols of a common graph; symbols of one name are one."""
    named = {u.name.removesuffix("'"): R for u, R in zip(equations.symbols.u, _residuals(equations), strict=True)}
    rows = zip(equations.system.constraints.closing, equations.J, equations.gamma, strict=True)
    for row, J, gamma in rows:
        terms = (x * a for x, a in zip(J, equations.symbols.a, strict=True))
        named[row.label] = sum(terms, start=gamma)
    states = zip(equations.symbols.z, equations.state_rates, strict=True)
    named |= {z.name: z.graph.symbol(f"{z.name}'") - rate for z, rate in states}
    scalars = tuple(named.values())
    meanings: dict[str, Scalar] = {symbol.name: graph.symbol(symbol.name) for symbol in symbols_of(scalars)}
    readable = (book_form(x, Work.FORMULA) for x in transplanted(scalars, graph, meanings))
    return dict(zip(named, readable, strict=True))


def _residuals(equations: EquationsOfMotion) -> Sequence[Scalar]:
    """M a - forcing - J^T lam."""
    sides = sides_of(equations, equations.M, [0] * len(equations.M), equations.forcing)
    return [row.left - row.right for row in sides]


def _compared(name: str, first: Scalar | None, second: Scalar | None) -> Compared:
    if first is None or second is None:
        return Compared(name, first, second, same=False)
    return Compared(name, first, second, same=equal_at_random_states([(first, second)]).equal)


def _difference(x: Compared) -> Scalar:
    assert x.first is not None and x.second is not None
    return book_form(x.second - x.first, Work.FORMULA)


def _present(x: Compared) -> Scalar:
    found = x.second if x.first is None else x.first
    assert found is not None
    return found


def _shown(value: float | None) -> str:
    return "" if value is None else f"{value:.10g}"
