"""Ties, a rough state -> the nearest state at which they hold, and what had to change for it.

Positions:   phi(q) = 0        with the least sum of (s_k dq_k)^2
Speeds:      J u + sigma = 0   with the least du^T M du, as when the ties take hold at once (an impact without rebound)

s_k is how far a change of the k-th coordinate moves the gaps: angles and lengths count alike, whatever their units.
The same holds of speeds that nobody gave, so that those stay which the ties do not need, and where M is not known or
measures nothing. Values that nobody gave move first, then those of the model, at last those that the caller gave.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import replace
from random import Random
from typing import Any

import numpy as np

from eomgen.errors import DerivationError, MissingValues
from eomgen.mechanics.constraints.closure import closed, gaps_of, generic_state, movable, scattered_state
from eomgen.mechanics.constraints.ties import Ties
from eomgen.model.parts import Model
from eomgen.symbolic.expression.derivative import depends_on, jacobian
from eomgen.symbolic.expression.expressions import Expression
from eomgen.symbolic.expression.graph import Node, Scalar
from eomgen.symbolic.expression.node import State
from eomgen.symbolic.numeric.dense import balanced
from eomgen.symbolic.numeric.evaluation import NoValue, evaluate, fifty_digits
from eomgen.symbolic.numeric.tolerances import CLOSED_AT_50, DEGENERATE, RANK, SAME_PLACE, SOLVED

ROUNDS = 12  # of walking along the ties towards the values given
LEAP = 1.0  # of a guess [rad, m], beyond which other guesses are tried too
SPREADS = (0.0, 0.1, 0.5, 1.0)  # rad: how far from a guess another one is tried
EASY = 1e3  # times farther a guess may move than a given value, for the same

Tiers = Sequence[Sequence[Node]]


def nearest_places(ties: Ties, state: State, tiers: Tiers, guessed: Sequence[Node]) -> State | None:
    """The nearest state with phi = 0, moving as few kinds of values as will do; None where none is near.

    Args:
        tiers: what may move, each with those before it: values that nobody gave, those of the model, the caller's.
        guessed: coordinates whose values are guesses: they may move far.
    """
    free: list[Node] = []
    for tier in tiers:
        free += tier
        moved = _moved(ties, state, free) if tier else None
        found = None if moved is None else _nearest(moved, state, free, guessed)
        if found is not None:
            return found
    return None


def nearest_speeds(ties: Ties, state: State, tiers: Tiers, M: np.ndarray | None) -> State | None:
    """The state with the nearest speeds that satisfy J u + sigma = 0, or None where there are none.

    Of each tier no more is changed than what those before it cannot close.

    Args:
        tiers: as in `nearest_places`; the last two are of values that somebody gave.
        M: the mass matrix at the state, where it is known: it measures changes of these.
    """
    u = ties.motion.scope.symbols.u
    if not ties.closing or not u:
        return state
    entries = (*(x for row in ties.J for x in row), *(row.velocity for row in ties.closing))
    values = np.array([float(x) for x in evaluate(entries, state, fifty_digits())])
    closing = len(ties.closing)
    J, open_rate = values[:-closing].reshape(closing, len(u)), values[-closing:]
    found, step = open_rate, np.zeros(len(u))
    columns = [[u.index(x) for x in tier] for tier in tiers]
    for k in reversed(range(len(columns))):
        earlier = [i for tier in columns[:k] for i in tier]
        block = None if M is None or k < len(columns) - 2 else M[np.ix_(columns[k], columns[k])]
        step[columns[k]] = _least(J[:, columns[k]], found, J[:, earlier], block)
        found = found + J[:, columns[k]] @ step[columns[k]]
    size = np.max(abs(J) @ abs(step) + abs(open_rate))
    if np.any(abs(J @ step + open_rate) > RANK * size):
        return None
    return state | {x: state[x] + float(d) for x, d in zip(u, step, strict=True) if d}


def _least(J: np.ndarray, left: np.ndarray, others: np.ndarray, M: np.ndarray | None) -> np.ndarray:
    """The least d for which others can close what J d leaves: P (J d + left) = 0, P = 1 - J_o J_o^+."""
    if not J.shape[1]:
        return np.zeros(0)
    P = np.eye(len(J))
    if others.shape[1]:
        unit = others / _slopes(others)
        P = P - unit @ np.linalg.pinv(unit, rcond=RANK)
    unit = _unit(J, M)
    rows = P @ J @ unit
    rows = np.where(abs(rows) > RANK * np.max(abs(J @ unit)), rows, 0.0)
    open_ = np.where(abs(P @ left) > SOLVED * np.max(abs(left), initial=0.0), P @ left, 0.0)
    found: np.ndarray = unit @ np.linalg.lstsq(rows, -open_, rcond=RANK)[0]
    return found


def _unit(J: np.ndarray, M: np.ndarray | None) -> np.ndarray:
    """U of d = U y, by which |y|^2 = d^T M d; where M is not positive definite |y_k| is how far d_k moves the gaps."""
    if M is not None:
        sizes = np.sqrt(np.maximum(np.diag(M), 0.0))
        try:
            if np.min(sizes) > 0:
                L = np.linalg.cholesky(M / np.outer(sizes, sizes))
                return np.linalg.solve(L.T * sizes, np.eye(len(M)))
        except np.linalg.LinAlgError:
            pass
    return np.diag(1 / _slopes(J))


def regular(ties: Ties, state: State, free: Sequence[Node]) -> bool:
    """Whether the gaps are as independent there as in a configuration that is not special.

    Slopes are measured by those of that configuration: where all gaps are flat none is.
    """
    J = [_slope(ties, each, free) for each in (state, _another(ties, state, free))]
    _, rows, columns = balanced(J[1])
    here, there = (np.linalg.svd(rows[:, None] * each * columns, compute_uv=False) for each in J)
    smallest = RANK * np.max(there, initial=0.0)
    return bool(np.sum(here > smallest) >= np.sum(there > smallest))


def _another(ties: Ties, state: State, free: Sequence[Node]) -> State:
    """A configuration that is not special; where the gaps close in none but this one, they need not close there."""
    try:
        other = generic_state(ties)
    except (DerivationError, MissingValues):
        return scattered_state(ties)
    same = all(abs(other[q] - state[q]) < SAME_PLACE for q in free)
    return scattered_state(ties) if same else other


def far(ties: Ties, before: State, after: State, given: Sequence[Node]) -> bool:
    """Whether a given coordinate moved the gaps by more than a turn of 1 rad of some coordinate does."""
    slopes = _slopes(_slope(ties, after, given))
    moved = [abs(float(after[q] - before[q])) for q in given]
    return bool(np.any(slopes * np.array(moved) > np.max(slopes, initial=0.0)))


def is_guess(model: Model, name: str) -> bool:
    """Whether nobody gave the start of a coordinate or speed."""
    return not _given(model, name)


def is_typed(model: Model, name: str) -> bool:
    """Whether a person typed the start of a coordinate or speed, in place of what the model declares."""
    return any(value.typed for value in _given(model, name))


def _given(model: Model, name: str) -> list[Expression]:
    """What says where a coordinate or speed starts; of a declared speed without a start the speeds of its rates."""
    if name in model.coordinates:
        part = model.coordinates[name]
        found = [part.start if part.near is None else None]
    elif name in model.speeds and model.speeds[name].start is None:
        rate = model.speeds[name].rate
        rates = [] if rate is None else [x[:-1] for x in rate.names if x[:-1] in model.coordinates]
        found = [model.coordinates[q].speed for q in rates]
    elif name in model.speeds:
        found = [model.speeds[name].start]
    else:
        found = [model.coordinates[name[:-1]].speed if name[:-1] in model.coordinates else None]
    return [value for value in found if value is not None]


# -- positions ---------------------------------------------------------------------------------------


def _moved(ties: Ties, state: State, free: Sequence[Node]) -> Ties | None:
    """The rows that these coordinates move; None where another one is open by more than the rounding of its values."""
    others = [row for row in ties.rows if row.gap is not None and not depends_on(row.gap, free)]
    gaps = tuple(row.gap for row in others if row.gap is not None and not row.identical)
    slopes = _slope(replace(ties, rows=tuple(others)), state, movable(ties))
    sizes = np.max(np.abs(slopes), axis=1, initial=0.0)
    try:
        values = evaluate(gaps, state, fifty_digits())
    except (NoValue, ZeroDivisionError):
        return None
    if any(abs(x) > SOLVED * max(size, DEGENERATE) for x, size in zip(values, sizes, strict=True)):
        return None
    return replace(ties, rows=tuple(row for row in ties.rows if row not in others))


def _nearest(ties: Ties, state: State, free: Sequence[Node], guessed: Sequence[Node]) -> State | None:
    """By moving these alone, from where they stand, then from other guesses; the nearest of those that leap."""
    given = [q for q in free if q not in guessed]
    leaps: list[tuple[float, State]] = []
    for start in _guesses(state, [q for q in free if q in guessed]):
        found = _walked(ties, start, free, state, guessed)
        if found is None or far(ties, state, found, given) or not regular(ties, found, free):
            continue
        found = _turned_back(ties, state, found, guessed)
        apart = max((abs(float(found[q] - state[q])) for q in guessed), default=0.0)
        if apart <= LEAP:
            return found
        leaps.append((apart, found))
    return min(leaps, key=lambda leap: leap[0])[1] if leaps else None


def _turned_back(ties: Ties, before: State, found: State, guessed: Sequence[Node]) -> State:
    """The place with whole turns taken back where the ties hold as well without them."""
    turn = 2 * evaluate((ties.motion.scope.graph.pi,), {}, fifty_digits())[0]
    for q in guessed:
        turns = round(float((found[q] - before[q]) / turn))
        if not turns:
            continue
        back = found | {q: found[q] - turns * turn}
        if all(abs(x) <= CLOSED_AT_50 for x in evaluate(gaps_of(ties), back, fifty_digits())):
            found = back
    return found


def _guesses(state: State, guessed: Sequence[Node]) -> Iterator[State]:
    rng = Random(1)
    for spread in SPREADS if guessed else SPREADS[:1]:
        yield state | {q: state[q] + rng.uniform(-spread, spread) for q in guessed}


def _walked(
    ties: Ties, start: State, free: Sequence[Node], wanted: Mapping[Node, Any], guessed: Sequence[Node]
) -> State | None:
    """Closed from the start, then along the ties to the point that is nearest to the wanted values, guesses last.

    dq = (1 - J^+ J) (q_wanted - q), and closed again, till that is nothing.
    """
    sizes = 1 / _slopes(_slope(ties, start, free)) * np.array([EASY if q in guessed else 1.0 for q in free])
    found = closed(ties, start, free, sizes)
    for _ in range(ROUNDS if found is not None else 0):
        assert found is not None
        J = _slope(ties, found, free) * sizes
        left = np.array([float(wanted[q] - found[q]) for q in free]) / sizes
        along = left - np.linalg.pinv(J, rcond=RANK) @ (J @ left)
        if np.max(abs(along), initial=0.0) < SOLVED:
            break
        moved = found | {q: found[q] + float(d) for q, d in zip(free, sizes * along, strict=True)}
        found = closed(ties, moved, free, sizes) or found
    return found


def _slope(ties: Ties, state: State, free: Sequence[Node]) -> np.ndarray:
    """d phi/dq of the free coordinates."""
    gaps: tuple[Scalar, ...] = gaps_of(ties)
    try:
        values = evaluate([x for row in jacobian(gaps, free) for x in row], state, fifty_digits())
    except (NoValue, ZeroDivisionError):
        return np.ones((len(gaps), len(free)))
    return np.array([float(x) for x in values]).reshape(len(gaps), len(free))


def _slopes(J: np.ndarray) -> np.ndarray:
    """How far each column moves the gaps, none of them nothing."""
    lengths = np.linalg.norm(J, axis=0)
    return np.asarray(np.maximum(lengths, DEGENERATE * (np.max(lengths, initial=0.0) or 1.0)))


def bilateral(ties: Ties, ending: Sequence[str], holds: Sequence[str]) -> Ties:
    """The ties without those contacts that can end and do not hold: what is open there may stay open."""
    return replace(ties, rows=tuple(row for row in ties.rows if row.tie not in ending or row.tie in holds))
