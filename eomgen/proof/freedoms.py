"""Ties, what was counted -> whether degrees of freedom and redundant rows are so, by the rank of differences.

J of every row that moves something: of a gap its differences (phi+ - phi-)/2h along the rates of the coordinates, of a
row without a gap what its velocity has for each speed; at a state in which the ties hold, drawn by another lot.

    f = nu - rank J,   rank of the rows that are not redundant = rank J,   a redundant row lies in the rows of its ties
"""

from __future__ import annotations

import re
from collections.abc import Iterable, Sequence
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
from eomgen.model.parts import Model
from eomgen.proof.in_numbers import STEP
from eomgen.symbolic.expression.node import State
from eomgen.symbolic.numeric.dense import rank
from eomgen.symbolic.numeric.evaluation import NoValue, evaluate, fifty_digits

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
        if not ties.closing or len(ties.motion.scope.symbols.u) > MOST:
            return ""
        return _by_differences(ties, generic_state(ties, Random(29)), found)
    except (DerivationError, MissingValues, ModelError, NoValue, ZeroDivisionError):  # the count has said so
        return ""


def _summed(formula: str) -> int:
    terms = SUMMAND.findall(formula)
    return sum((-1 if sign == "-" else 1) * int(factor or 1) * int(many) for sign, factor, many in terms)


def _by_differences(ties: Ties, state: State, found: Freedom) -> str:
    scope = ties.motion.scope
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
