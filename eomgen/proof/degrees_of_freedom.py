"""Degrees of freedom, constraints that keep a start value, and states near a state.

Constraints, counts -> check of the degrees of freedom and redundant rows, by the rank of differences.

J of every row that restricts the motion: for a gap its differences (phi+ - phi-)/2h along the rates of the coordinates,
for a row without a gap the coefficients of its velocity; at a random state in which the constraints hold.

    f = nu - rank J,   rank of the rows that are not redundant = rank J,   a redundant row lies in the rows of its
    constraints

A row that only reacts has J = 0. The rank of a structure is that of the forces and moments of all reactions in doubles.
Printed lines are read back, and must agree with the entries for machines.
"""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator, Mapping, Sequence
from functools import cached_property
from random import Random
from typing import Any

import numpy as np

from eomgen.errors import DerivationError, ModelError
from eomgen.frozen import dataclass
from eomgen.mechanics.constraints import Closure, Constraints, Row
from eomgen.mechanics.dynamics import EquationsOfMotion, System
from eomgen.mechanics.kinematics import Motion, Scope
from eomgen.mechanics.start import Start
from eomgen.proof.check import first_wrong
from eomgen.proof.declared_loads import declared_state_rates
from eomgen.proof.states import STEP
from eomgen.study import Checked
from eomgen.symbolic.expression import Node, Scalar, State, Vector, jacobian, symbols_of
from eomgen.symbolic.numeric import (
    NoValue,
    evaluate,
    fifty_digits,
    follows_in_digits,
    rank,
    solved_quickly,
    tolerances,
)

MOST = 60  # speeds, of which the differences are taken
SUMMAND = re.compile(r"([+-]?)\s*(?:(\d+)\*)?(\d+) \([^)]*\)")  # of a count: "3*2 (bodies) - 4 (joints)"


def counted_otherwise(checked: Checked) -> str:
    """Message if the count of degrees of freedom, or the rank of a structure, is another in numbers; "".

    "" too where nothing was counted.
    """
    return _freer(checked) or standing_otherwise(checked)


def _freer(checked: Checked) -> str:
    found = checked.freedom
    if found.by_formula is not None and _summed(found.formula) != found.by_formula:
        return f"the count {found.formula} is {_summed(found.formula)}, not {found.by_formula}"
    if found.by_rank is None:
        return ""
    try:
        constraints = Constraints.of(Motion.of(Scope.of(checked.model)), modes=checked.modes)
        if wrong := _unnamed(constraints, checked):
            return wrong
        if not constraints.closing or len(constraints.motion.scope.symbols.u) > MOST:
            return ""
        return _by_differences(constraints, Closure(constraints).generic(29), checked)
    except (DerivationError, ModelError, NoValue, ZeroDivisionError):  # the count has said so
        return ""


def _unnamed(constraints: Constraints, checked: Checked) -> str:
    """Message if fewer rows are named as redundant than the count by components lacks; "".

    The count takes off every component that is held: what it lacks of the degrees of freedom by rank is held twice.
    Nothing is compared where a constraint acts on no body.
    """
    found = checked.freedom
    if found.by_rank is None or found.by_formula is None or not all(row.wrenches for row in constraints.rows):
        return ""
    lacking = found.by_rank - found.by_formula
    return f"{lacking} components are held twice, and {len(found.redundant)} named" * (lacking > len(found.redundant))


def standing_otherwise(checked: Checked) -> str:
    """Message if the rank of a structure is another in doubles; ""."""
    structure = checked.structure
    if structure is None:
        return ""
    state = structure.system.scope.values_of_parameters(Random(3))
    try:
        at = evaluate(tuple(structure.at.values()), state, fifty_digits())
        known = {**dict.fromkeys(structure.unknowns, 0), **state, **dict(zip(structure.at, at, strict=True))}
        G = np.zeros((6 * len(structure.system.motion.links), len(structure.pushes)))
        for j, (_, effects) in enumerate(structure.pushes):
            for e in effects:
                force, couple, arm = (_doubles(v, known) for v in (e.force, e.couple, e.arm))
                G[6 * e.link : 6 * e.link + 6, j] += [*force, *(np.cross(arm, force) + couple)]
    except (NoValue, ZeroDivisionError):
        return ""
    found, total = rank(G), len(structure.pushes)
    if (len(structure.columns) - found, total - found) == (structure.mobility, structure.indeterminacy):
        return ""
    return f"of {total} reactions {found} are independent in doubles, not {structure.rank}"


def _doubles(v: Vector, known: State) -> np.ndarray:
    return np.array([float(x) for x in evaluate(tuple(v), known, fifty_digits())])


def lines_otherwise(lines: Sequence[str], reported: Mapping[str, Any], checked: Checked) -> str:
    """Message if a count is printed, or reported to machines, otherwise than it was found; ""."""
    found = checked.freedom
    due = {
        "degrees_of_freedom": found.by_rank,
        "by_formula": found.by_formula,
        "closing": list(found.closing),
        "reaction_only": list(found.identical),
        "redundant": [{"tie": r.constraint, "row": r.number, "follows_from": list(r.others)} for r in found.redundant],
    }
    wrong = (
        f"machines get {name} = {reported.get(name)}" for name, right in due.items() if reported.get(name) != right
    )
    return first_wrong(wrong) or first_wrong(
        (*(_line_otherwise(line, reported) for line in lines), *_unsaid(lines, reported))
    )


def _line_otherwise(line: str, reported: Mapping[str, Any]) -> str:
    """Message if a line differs from what machines get; ""."""
    for pattern, name in NUMBERS:
        number = pattern.fullmatch(line)
        if number is not None and int(number[1]) != reported[name]:
            return f"'{line}' for {reported[name]}"
    for begin, name in LISTS.items():
        if line.startswith(begin):
            listed = [each for each in REMARK.sub("", line.removeprefix(begin)).split(", ") if each != "none"]
            if listed != list(reported[name]):
                return f"'{line}' for {', '.join(reported[name]) or 'none'}"
    if line.startswith("structure: "):
        extra = EXTRA.search(line)
        if (int(extra[1]) if extra else 0) != reported["indeterminacy"]:
            return f"'{line}' for {reported['indeterminacy']} reactions too many"
    return ""


def _unsaid(lines: Sequence[str], reported: Mapping[str, Any]) -> Iterator[str]:
    """Message if a redundant row is not named, or one that is not redundant is."""
    rows = [row for row in map(REDUNDANT.fullmatch, lines) if row is not None]
    said = [(row[2], int(row[1]), [] if row[3] in NO_CONSTRAINTS else row[3].split(", ")) for row in rows]
    due = [(row["tie"], row["row"], row["follows_from"]) for row in reported["redundant"]]
    if reported["degrees_of_freedom"] is not None and said != due:
        yield f"redundant rows {said} are printed for {due}"


NUMBERS = tuple(
    (re.compile(pattern), name)
    for pattern, name in (
        (r"degrees of freedom: (-?\d+) by rank", "degrees_of_freedom"),
        (r"degrees of freedom in position: (-?\d+)", "position_freedoms"),
        (r"count by formula: (-?\d+) = .*", "by_formula"),
        (r"mobility: (-?\d+), .*", "mobility"),
    )
)
LISTS = {
    "constraints that close: ": "closing",
    "constraints that only react: ": "reaction_only",
    "bodies: ": "bodies",
    "coordinates: ": "coordinates",
    "open at the start: ": "open_at_start",
    "parameters without a value: ": "missing_values",
}
REMARK = re.compile(r" \((?:rows? \d[^)]*|driven|dependent)\)")
REDUNDANT = re.compile(r"redundant: row (\d+) of constraint '(.*)', it follows from (.*)")
NO_CONSTRAINTS = ("the joints", "its other rows")
EXTRA = re.compile(r"(\d+) reactions? more than independent ones")


def _summed(formula: str) -> int:
    terms = SUMMAND.findall(formula)
    return sum((-1 if sign == "-" else 1) * int(factor or 1) * int(many) for sign, factor, many in terms)


def _by_differences(constraints: Constraints, state: State, checked: Checked) -> str:
    found = checked.freedom
    scope = constraints.motion.scope
    still = [row for row in constraints.rows if row.identical and row.gap is not None]
    for row, line in zip(still, _lines(constraints, still, state), strict=True):
        if max(map(abs, line), default=0.0) > tolerances.DIFFERENCE_AT_50:
            return f"row {row.number} of '{row.constraint}' restricts the motion, and is reported only to react"
    rows = [row for row in constraints.rows if not row.identical]
    J = {(row.constraint, row.number): line for row, line in zip(rows, _lines(constraints, rows, state), strict=True)}
    whole = _rank(J.values())
    f = len(scope.symbols.u) - len(scope.quaternions) - whole
    if f != found.by_rank:
        return f"by differences there are {f} degrees of freedom, not {found.by_rank}"
    redundant: dict[tuple[str, int], tuple[str, ...]] = {(r.constraint, r.number): r.others for r in found.redundant}
    kept = [line for name, line in J.items() if name not in redundant]
    if _rank(kept) != whole or len(kept) != whole:
        return (
            f"{len(J) - whole} rows are redundant by differences, and without those that are named {_rank(kept)} remain"
        )
    for (constraint, number), others in redundant.items():
        near = [line for name, line in J.items() if name[0] in (constraint, *others) and name not in redundant]
        if (constraint, number) in J and _rank([*near, J[constraint, number]]) != _rank(near):
            return f"row {number} of '{constraint}' does not follow from {', '.join(others) or 'its own rows'}"
    return ""


def _rank(lines: Iterable[Sequence[float]]) -> int:
    return rank(np.array(list(lines), dtype=float))


def _lines(constraints: Constraints, rows: Sequence[Row], state: State) -> list[list[float]]:
    """Coefficients of each row, one a speed, by differences."""
    scope, lines = constraints.motion.scope, [list[float]() for _ in rows]
    places = [k for k, row in enumerate(rows) if row.gap is not None]
    gaps = tuple(row.gap for row in rows if row.gap is not None)
    others = tuple(row.velocity for row in rows if row.gap is None)
    n = len(scope.symbols.u)
    flat = evaluate(tuple(x for row in scope.N for x in row), state, fifty_digits())
    still = {**state, **dict.fromkeys(scope.symbols.u, 0 * STEP)}
    rest = evaluate(others, still, fifty_digits())
    for k, u in enumerate(scope.symbols.u):
        moved = [flat[n * i + k] for i in range(len(scope.N))]
        ways = [{**state, **_moved(constraints, state, [h * x for x in moved])} for h in (STEP, -STEP)]
        late, early = (evaluate(gaps, way, fifty_digits()) for way in ways)
        slopes = dict(zip(places, ((a - b) / (2 * STEP) for a, b in zip(late, early, strict=True)), strict=True))
        one = iter(evaluate(others, {**still, u: 1 + 0 * STEP}, fifty_digits()))
        bare = iter(rest)
        for i, line in enumerate(lines):
            line.append(float(slopes[i]) if i in slopes else float(next(one) - next(bare)))
    return lines


def _moved(constraints: Constraints, state: State, by: Sequence[Any]) -> State:
    return {q: state[q] + x for q, x in zip(constraints.motion.scope.symbols.q, by, strict=True)}


# -------- constraints that keep a start value ------------------------------------------------------------------------
# System, state -> check that constraints which keep a value of the start are satisfied there.
#
# phi(q_0, t = 0) = 0,   q_0 as the coordinates are declared to start, quaternions of length 1


def rows_that_stay(system: System) -> tuple[tuple[Row, Scalar], ...]:
    """Rows of constraints that keep a value of the start, with their gaps."""
    constraints = system.scope.model.constraints
    named = ((row, row.gap) for row in system.constraints.rows if row.constraint in constraints and row.gap is not None)
    return tuple((row, gap) for row, gap in named if constraints[row.constraint].stays(row.component))


def open_at_start(system: System, state: State) -> str:
    """Message that names a row which is not satisfied at the start, with the parameters of a state; "".

    Raises:
        NoValue: something has no value there.
    """
    begun = {**state, **_declared_start(system.scope, state)}
    kept = rows_that_stay(system)
    for (row, _), gap in zip(kept, evaluate([gap for _, gap in kept], begun, fifty_digits()), strict=True):
        if abs(gap) > tolerances.ZERO_AT_50 * (1 + max(map(abs, begun.values()))):
            return f"'{row.constraint}' is open by {float(gap):.10g} where it starts"
    return ""


def springs_of_the_start(system: System) -> dict[str, Scalar | None]:
    """Energies of the springs that are slack at the length, or angle, which they have at the start."""
    forces = system.scope.model.forces
    return {applied.name: applied.potential for applied in system.loads.applied if forces[applied.name].slack_at_start}


def pulled_at_start(system: System) -> str:
    """Message that names a spring which is not slack at the start, all constraints satisfied; "".

    Raises:
        NoValue: the start is not known in numbers.
    """
    try:
        start = Start.of(system).values
    except (DerivationError, ModelError) as error:
        raise NoValue(str(error).splitlines()[0]) from None
    symbols = system.symbols
    known = system.scope.model.exact_parameters()
    state = {node: float(known[name]) for name, node in symbols.parameters.items() if name in known}
    state |= {node: start.get(node.name, 0.0) for node in symbols.x} | {symbols.t: 0.0}
    for name, potential in springs_of_the_start(system).items():
        if potential is not None and evaluate((potential,), state)[0] > tolerances.SOLVED:
            return f"forces.{name} is not slack where the motion starts"
    return ""


def _declared_start(scope: Scope, state: State) -> dict[Any, Any]:
    """t = 0, and where every coordinate is declared to start."""
    digits, parts = fifty_digits(), scope.model.coordinates
    found: dict[Any, Any] = {scope.symbols.t: digits.number(0)}
    for q in scope.symbols.q:
        part = parts[q.name]
        declared = part.motion or (part.near if part.start is None else part.start)
        (found[q],) = evaluate((scope.value(declared),), {**state, **found}, digits)
    for four in scope.quaternions:
        length = digits.functions["sqrt"](sum(found[e] ** 2 for e in four))
        found |= {e: found[e] / length for e in four}
    return found


# -------- nearby ----------------------------------------------------------------------------------------------
# Equations, a state -> states near it that the constraints allow, and the motion from each, with 50 digits.
#
#     phi(q) = 0,   J u + sigma = 0               dependent coordinates and speeds follow the independent ones
#     M a - J^T lam = forcing,   J a + gamma = 0
#
# Everything is taken from the nonlinear equations: derivatives of them serve as slopes of a Newton iteration alone,
# whose end does not depend on them.


STEPS = 12  # of Newton's method with the slope of the start; from doubles two or three are taken

Numbers50 = Mapping[Node, Any]
DigitRow = list[Any]


def solved_nearby(rows: Sequence[Sequence[Any]]) -> DigitRow | None:
    """x of consistent rows [A | b] by elimination with full pivots; None where A leaves an x open.

    Rows that follow from others are not looked at.
    """
    found = solved_quickly(rows)
    if found is not None:
        return found
    left = [_of_one_size(row) for row in rows]
    unknowns = len(rows[0]) - 1 if rows else 0
    chosen: list[tuple[int, Sequence[Any]]] = []
    columns = set(range(unknowns))
    while columns and left:
        i, k = max(((i, k) for i in range(len(left)) for k in columns), key=lambda at: abs(left[at[0]][at[1]]))
        row = left.pop(i)
        if abs(row[k]) < tolerances.ZERO_AT_50:
            return None
        columns.remove(k)
        chosen.append((k, row))
        left = [_without(other, row, k) for other in left]
    if columns:
        return None
    x: DigitRow = [0] * unknowns
    for k, row in reversed(chosen):
        x[k] = (row[-1] - sum(row[j] * x[j] for j in range(unknowns) if j != k and row[j])) / row[k]
    return x


def _of_one_size(row: Sequence[Any]) -> Sequence[Any]:
    size = max(map(abs, row[:-1]), default=0)
    return [x / size for x in row] if size else row


def _without(row: Sequence[Any], pivot: Sequence[Any], k: int) -> Sequence[Any]:
    if not row[k]:
        return row
    factor = row[k] / pivot[k]
    return [0 if j == k else x - factor * y if y else x for j, (x, y) in enumerate(zip(row, pivot, strict=True))]


@dataclass(frozen=True)
class Going:
    """Motion of a system from a state.

    Args:
        state: q, u, z, t, inputs and parameters.
        q1, q2: q' and q''; of states of first order z' by the file's own texts, and nothing.
        a: u'.
    """

    state: Numbers50
    q1: Mapping[Node, Any]
    q2: Mapping[Node, Any]
    a: Mapping[Node, Any]


@dataclass(frozen=True)
class Nearby:
    """States near a given one.

    Args:
        equations: of motion.
        relations: scalars of the positions that must vanish.
        numbers: the state, all symbols with 50 digits.
        q, u: the coordinates and speeds that stay independent; driven coordinates are neither these nor sought.
    """

    equations: EquationsOfMotion
    relations: tuple[Scalar, ...]
    numbers: Numbers50
    q: tuple[Node, ...]
    u: tuple[Node, ...]

    def at(self, scalars: Sequence[Scalar], state: Numbers50) -> DigitRow:
        return evaluate(tuple(scalars), state, fifty_digits())

    def state(self, given: Mapping[Node, Any]) -> Numbers50:
        """State with given values of some unknowns, the dependent ones by the constraints.

        Raises:
            NoValue: the constraints do not close there, or leave a coordinate or speed open.
        """
        state = self._closed({**self.numbers, **given})
        if not self._dependent_u:
            return state
        J, sigma = self._rows(state, self.equations.sigma)
        u, index = self.equations.symbols.u, {u: k for k, u in enumerate(self.equations.symbols.u)}
        columns = [index[x] for x in self._dependent_u]
        known = [k for k, x in enumerate(u) if x not in self._dependent_u]
        rows = [
            [*(row[k] for k in columns), -s - sum(row[k] * state[u[k]] for k in known)]
            for row, s in zip(J, sigma, strict=True)
        ]
        found = solved_nearby(rows)
        if found is None:
            raise NoValue("the constraints do not determine the dependent speeds")
        return {**state, **dict(zip(self._dependent_u, found, strict=True))}

    def going(self, state: Numbers50) -> Going:
        """Accelerations by M a - J^T lam = forcing, J a + gamma = 0, and the rates of the coordinates.

        Raises:
            NoValue: the equations do not determine them.
        """
        symbols, graph = self.equations.symbols, self.equations
        n, k = len(graph.M), len(graph.J)
        flat = self.at([*(x for row in graph.M for x in row), *graph.forcing], state)
        J, gamma = self._rows(state, graph.gamma)
        rows = [[*flat[n * i : n * i + n], *(-J[r][i] for r in range(k)), flat[n * n + i]] for i in range(n)]
        rows += [[*row, *([0] * k), -g] for row, g in zip(J, gamma, strict=True)]
        a = _first(rows, n)
        if a is None:
            raise NoValue("the equations of motion are singular")
        moving = {**state, **dict(zip(symbols.a, a, strict=True))}
        rates = self.equations.system.scope.rates
        q1, q2 = self.at(rates, state), self.at(self.equations.system.scope.with_accelerations(rates), moving)
        further = declared_state_rates(self.equations.system, moving)
        return Going(
            state,
            dict(zip((*symbols.q, *symbols.z), (*q1, *further.values()), strict=True)),
            dict(zip(symbols.q, q2, strict=True)) | dict.fromkeys(symbols.z, 0),
            dict(zip(symbols.u, a, strict=True)),
        )

    # -- the constraints --------------------------------------------------------------------------------------------

    def _rows(self, state: Numbers50, bias: Sequence[Scalar]) -> tuple[list[DigitRow], DigitRow]:
        """(J, a bias of it) at a state."""
        J, n = self.equations.J, len(self.equations.M)
        flat = self.at([*(x for row in J for x in row), *bias], state)
        return [flat[n * i : n * i + n] for i in range(len(J))], flat[n * len(J) :]

    @property
    def _dependent_u(self) -> tuple[Node, ...]:
        return tuple(x for x in self.equations.symbols.u if x not in self.u)

    @cached_property
    def _dependent_q(self) -> tuple[Node, ...]:
        """Dependent coordinates that stand in relations between positions; others keep their values."""
        coordinates, bound = self.equations.system.scope.model.coordinates, {*symbols_of(self.relations)}
        return tuple(q for q in self.equations.symbols.q if q in bound - {*self.q} and not coordinates[q.name].driven)

    @cached_property
    def _slopes(self) -> list[DigitRow]:
        """d relations/d dependent coordinates, at the state."""
        rows = jacobian(self.relations, self._dependent_q)
        flat, n = self.at([x for row in rows for x in row], self.numbers), len(self._dependent_q)
        return [flat[n * i : n * i + n] for i in range(len(rows))]

    def _closed(self, state: Numbers50) -> Numbers50:
        """The dependent coordinates by phi(q) = 0."""
        if not self._dependent_q:
            return state
        for _ in range(STEPS):
            open_ = self.at(self.relations, state)
            step = solved_nearby([[*row, -x] for row, x in zip(self._slopes, open_, strict=True)])
            if step is None:
                raise NoValue("the constraints do not determine the dependent coordinates")
            state = {**state, **{q: state[q] + d for q, d in zip(self._dependent_q, step, strict=True)}}
            if all(
                abs(d) < tolerances.MET_AT_50 * (1 + abs(state[q]))
                for q, d in zip(self._dependent_q, step, strict=True)
            ):
                return state
        raise NoValue("the constraints cannot be satisfied near the state")


def _first(rows: Sequence[Sequence[Any]], n: int) -> DigitRow | None:
    """First n unknowns, with multipliers of dependent rows 0; None where they are not determined."""
    found = solved_nearby(rows)
    if found is not None:
        return found[:n]
    kept, independent = list(range(n)), list[Sequence[Any]]()
    for r, row in enumerate(rows[n:], start=n):
        if not follows_in_digits(independent, row[:n]):
            independent.append(row[:n])
            kept.append(r)
    found = solved_nearby([[*(rows[i][j] for j in kept), rows[i][-1]] for i in kept]) if len(kept) < len(rows) else None
    return None if found is None else found[:n]
