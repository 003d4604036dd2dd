"""Ties, what was counted -> whether degrees of freedom and redundant rows are so, by the rank of differences.

J of every row that moves something: of a gap its differences (phi+ - phi-)/2h along the rates of the coordinates, of a
row without a gap what its velocity has for each speed; at a state in which the ties hold, drawn by another lot.

    f = nu - rank J,   rank of the rows that are not redundant = rank J,   a redundant row lies in the rows of its ties

A row that only reacts has J = 0. Of a structure the rank is that of the forces and moments of all reactions in doubles.
What is printed is read again, and says what machines get.
"""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator, Mapping, Sequence
from random import Random
from typing import Any

import numpy as np

from eomgen.errors import DerivationError, MissingValues, ModelError
from eomgen.mechanics.bodies.contact_modes import ContactModes
from eomgen.mechanics.bodies.kinematics import motion_of
from eomgen.mechanics.bodies.scope import scope_of
from eomgen.mechanics.constraints.closure import generic_state
from eomgen.mechanics.constraints.freedom import Freedom, RowName
from eomgen.mechanics.constraints.ties import Row, Ties, ties_of
from eomgen.mechanics.initial_state.values_at_rest import values_of_parameters
from eomgen.mechanics.structures.structure import Structure
from eomgen.model.parts import Model
from eomgen.proof.check import first_wrong
from eomgen.proof.in_numbers import STEP
from eomgen.symbolic.expression.node import State
from eomgen.symbolic.expression.spatial import Vector
from eomgen.symbolic.numeric.dense import rank
from eomgen.symbolic.numeric.evaluation import NoValue, evaluate, fifty_digits
from eomgen.symbolic.numeric.tolerances import DIFFERENCE_AT_50

MOST = 60  # speeds, of which the differences are taken
SUMMAND = re.compile(r"([+-]?)\s*(?:(\d+)\*)?(\d+) \([^)]*\)")  # of a count: "3*2 (bodies) - 4 (joints)"


def counted_otherwise(model: Model, modes: ContactModes, found: Freedom) -> str:
    """What of the count is otherwise by differences; "" where nothing is, or nothing was counted."""
    if found.by_formula is not None and _summed(found.formula) != found.by_formula:
        return f"the count {found.formula} is {_summed(found.formula)}, not {found.by_formula}"
    if found.by_rank is None:
        return ""
    try:
        ties = ties_of(motion_of(scope_of(model)), modes=modes)
        if wrong := _unnamed(ties, found):
            return wrong
        if not ties.closing or len(ties.motion.scope.symbols.u) > MOST:
            return ""
        return _by_differences(ties, generic_state(ties, 29), found)
    except (DerivationError, MissingValues, ModelError, NoValue, ZeroDivisionError):  # the count has said so
        return ""


def _unnamed(ties: Ties, found: Freedom) -> str:
    """That fewer rows are named as redundant than the count by components lacks; "" where ties act on no body.

    The count takes off every component that is held: what it lacks of the freedoms by rank is held twice.
    """
    if found.by_rank is None or found.by_formula is None or not all(row.wrenches for row in ties.rows):
        return ""
    lacking = found.by_rank - found.by_formula
    return f"{lacking} components are held twice, and {len(found.redundant)} named" * (lacking > len(found.redundant))


def standing_otherwise(structure: Structure) -> str:
    """What of a structure's rank is otherwise in doubles; "" where nothing is."""
    state = values_of_parameters(structure.system.scope, Random(3))
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


def lines_otherwise(lines: Sequence[str], told: Mapping[str, Any], found: Freedom) -> str:
    """What is printed of a count, or told machines of it, otherwise than it was found; ""."""
    due = {
        "degrees_of_freedom": found.by_rank,
        "by_formula": found.by_formula,
        "closing": list(found.closing),
        "reaction_only": list(found.identical),
        "redundant": [{"tie": r.tie, "row": r.number, "follows_from": list(r.others)} for r in found.redundant],
    }
    wrong = (f"machines get {name} = {told.get(name)}" for name, right in due.items() if told.get(name) != right)
    return first_wrong(wrong) or first_wrong((*(_line_otherwise(line, told) for line in lines), *_unsaid(lines, told)))


def _line_otherwise(line: str, told: Mapping[str, Any]) -> str:
    """That a line says another thing than machines get."""
    for pattern, name in NUMBERS:
        number = pattern.fullmatch(line)
        if number is not None and int(number[1]) != told[name]:
            return f"'{line}' for {told[name]}"
    for begin, name in LISTS.items():
        if line.startswith(begin):
            listed = [each for each in REMARK.sub("", line.removeprefix(begin)).split(", ") if each != "none"]
            if listed != list(told[name]):
                return f"'{line}' for {', '.join(told[name]) or 'none'}"
    if line.startswith("structure: "):
        extra = EXTRA.search(line)
        if (int(extra[1]) if extra else 0) != told["indeterminacy"]:
            return f"'{line}' for {told['indeterminacy']} reactions too many"
    return ""


def _unsaid(lines: Sequence[str], told: Mapping[str, Any]) -> Iterator[str]:
    """That a redundant row is not named, or one that is not redundant."""
    rows = [row for row in map(REDUNDANT.fullmatch, lines) if row is not None]
    said = [(row[2], int(row[1]), [] if row[3] in NO_TIES else row[3].split(", ")) for row in rows]
    due = [(row["tie"], row["row"], row["follows_from"]) for row in told["redundant"]]
    if told["degrees_of_freedom"] is not None and said != due:
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
    "ties that close: ": "closing",
    "ties that only react: ": "reaction_only",
    "bodies: ": "bodies",
    "coordinates: ": "coordinates",
    "open at the start: ": "open_at_start",
    "parameters without a value: ": "missing_values",
}
REMARK = re.compile(r" \((?:rows? \d[^)]*|driven|dependent)\)")
REDUNDANT = re.compile(r"redundant: row (\d+) of tie '(.*)', it follows from (.*)")
NO_TIES = ("the joints", "its other rows")
EXTRA = re.compile(r"(\d+) reactions? more than independent ones")


def _summed(formula: str) -> int:
    terms = SUMMAND.findall(formula)
    return sum((-1 if sign == "-" else 1) * int(factor or 1) * int(many) for sign, factor, many in terms)


def _by_differences(ties: Ties, state: State, found: Freedom) -> str:
    scope = ties.motion.scope
    still = [row for row in ties.rows if row.identical and row.gap is not None]
    for row, line in zip(still, _lines(ties, still, state), strict=True):
        if max(map(abs, line), default=0.0) > DIFFERENCE_AT_50:
            return f"row {row.number} of '{row.tie}' restricts the motion, and is told only to react"
    rows = [row for row in ties.rows if not row.identical]
    J = {(row.tie, row.number): line for row, line in zip(rows, _lines(ties, rows, state), strict=True)}
    whole = _rank(J.values())
    f = len(scope.symbols.u) - len(scope.quaternions) - whole
    if f != found.by_rank:
        return f"by differences there are {f} degrees of freedom, not {found.by_rank}"
    redundant: dict[RowName, tuple[str, ...]] = {(r.tie, r.number): r.others for r in found.redundant}
    kept = [line for name, line in J.items() if name not in redundant]
    if _rank(kept) != whole or len(kept) != whole:
        return (
            f"{len(J) - whole} rows are redundant by differences, and without those that are named {_rank(kept)} remain"
        )
    for (tie, number), others in redundant.items():
        near = [line for name, line in J.items() if name[0] in (tie, *others) and name not in redundant]
        if (tie, number) in J and _rank([*near, J[tie, number]]) != _rank(near):
            return f"row {number} of '{tie}' does not follow from {', '.join(others) or 'its own rows'}"
    return ""


def _rank(lines: Iterable[Sequence[float]]) -> int:
    return rank(np.array(list(lines), dtype=float))


def _lines(ties: Ties, rows: Sequence[Row], state: State) -> list[list[float]]:
    """What each row has for each speed."""
    scope, lines = ties.motion.scope, [list[float]() for _ in rows]
    places = [k for k, row in enumerate(rows) if row.gap is not None]
    gaps = tuple(row.gap for row in rows if row.gap is not None)
    others = tuple(row.velocity for row in rows if row.gap is None)
    n = len(scope.symbols.u)
    flat = evaluate(tuple(x for row in scope.N for x in row), state, fifty_digits())
    still = {**state, **dict.fromkeys(scope.symbols.u, 0 * STEP)}
    rest = evaluate(others, still, fifty_digits())
    for k, u in enumerate(scope.symbols.u):
        moved = [flat[n * i + k] for i in range(len(scope.N))]
        ways = [{**state, **_moved(ties, state, [h * x for x in moved])} for h in (STEP, -STEP)]
        late, early = (evaluate(gaps, way, fifty_digits()) for way in ways)
        slopes = dict(zip(places, ((a - b) / (2 * STEP) for a, b in zip(late, early, strict=True)), strict=True))
        one = iter(evaluate(others, {**still, u: 1 + 0 * STEP}, fifty_digits()))
        bare = iter(rest)
        for i, line in enumerate(lines):
            line.append(float(slopes[i]) if i in slopes else float(next(one) - next(bare)))
    return lines


def _moved(ties: Ties, state: State, by: Sequence[Any]) -> State:
    return {q: state[q] + x for q, x in zip(ties.motion.scope.symbols.q, by, strict=True)}
