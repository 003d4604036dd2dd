"""Constraints -> states that satisfy them, phi = 0 and J u + sigma = 0, in numbers of 50 digits.

Where loops are redundant the rank of J can be seen only as precisely as phi = 0 holds: an error d of the position
makes redundant rows differ by d. So positions are sought to 1e-28.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from contextlib import suppress
from dataclasses import replace
from random import Random
from typing import Any

import numpy as np

from eomgen.errors import DerivationError, EomgenError, MissingValues, OpenConstraints
from eomgen.frozen import dataclass, recalled
from eomgen.mechanics.constraints.rows import Constraints
from eomgen.mechanics.state import Numbers
from eomgen.symbolic.expression import Node, Scalar, State, depends_on, jacobian
from eomgen.symbolic.numeric import (
    Newton,
    NoValue,
    balanced,
    evaluate,
    fifty_digits,
    lengths_of,
    tolerances,
)

CLOSING = Newton(enough=tolerances.CLOSED_AT_50, stalls=tolerances.SUMMED, damped=True, again=True)
SPREADS = (0.1, 0.01, 0.001)  # how far from the start a generic configuration is looked for


@dataclass(frozen=True)
class Closure:
    """States in which constraints hold, phi = 0 and J u + sigma = 0, with 50 digits."""

    constraints: Constraints

    def generic(self, rng: Random | int = 1, *, shaken: bool = False, spreads: Sequence[float] = ()) -> State:
        """Values of every symbol: near the start, off any special position, with phi = 0 and J u + sigma = 0.

        Parameters without a value get one. Driven coordinates and t are near the start too, as if given by another law.

        Args:
            rng: its numbers, or their seed; of a seed it is found once.
            shaken: parameters have values of their own, near the model's, so that nothing vanishes for these alone.
            spreads: how far from the start it is looked for, the first first; before those near to it.
        Raises:
            MissingValues, DerivationError: the constraints do not close there.
        """
        if isinstance(rng, int):
            seed, key = rng, ("generic", rng, shaken, tuple(spreads))
            known = recalled(self.constraints, key, lambda: self.generic(Random(seed), shaken=shaken, spreads=spreads))
            return dict(known)
        state, q = self.still(rng, shaken=shaken)
        for spread in (*spreads, *SPREADS):
            found = self.closed(state | _scattered(self.constraints, q, spread, rng), self.constraints.movable)
            if found is not None:
                with suppress(NoValue, ZeroDivisionError):  # a strand into a pulley: nearer then
                    return self.with_speeds(_with_laws(self.constraints, found))
        raise _open(self.constraints, self.constraints.motion.scope.model.exact_parameters())

    def begun(self) -> State:
        """Values of every symbol at the model's own start, the nearest at which phi = 0; speeds as they are given.

        Raises:
            MissingValues, DerivationError: the constraints do not close there.
        """
        model, symbols = self.constraints.motion.scope.model, self.constraints.motion.scope.symbols
        state, q = self.still(Random(1))
        numbers = {name: float(state[node]) for name, node in symbols.parameters.items()}
        speeds = model.start_values(numbers)[1]
        given = {node: fifty_digits().number(q[node.name]) for node in symbols.q}
        given |= {u: fifty_digits().number(speeds.get(u.name, 0.0)) for u in symbols.u}
        given |= self.constraints.motion.scope.on_unit_norms(state | given)
        found = self.closed(state | given, self.constraints.movable)
        if found is None:
            raise _open(self.constraints, model.exact_parameters())
        return self.with_speeds(_with_laws(self.constraints, found))

    def scattered(self) -> State:
        """Values of every symbol: near the start, off any special position; the constraints need not hold."""
        rng = Random(1)
        state, q = self.still(rng)
        return _with_laws(self.constraints, state | _scattered(self.constraints, q, SPREADS[0], rng))

    def still(self, rng: Random, *, shaken: bool = False) -> tuple[State, dict[str, float]]:
        """(values of every symbol but the coordinates, where the coordinates start)."""
        scope = self.constraints.motion.scope
        model, symbols = scope.model, scope.symbols
        known = model.exact_parameters()
        p = {name: float(known[name]) if name in known else rng.uniform(0.7, 1.3) for name in symbols.parameters}
        if shaken:
            p = {name: value * rng.uniform(0.8, 1.2) if value else rng.uniform(0.05, 0.2) for name, value in p.items()}
        given = {node: p[name] for name, node in symbols.parameters.items()} | {symbols.t: 0.0}
        given |= {node: rng.uniform(-1, 1) for node in (*symbols.u, *symbols.a)}
        begun = model.start_values(p)
        near = ((z, float(begun[1][z.name])) for z in symbols.z)
        given |= {z: value + rng.uniform(-0.1, 0.1) * (1 + abs(value)) for z, value in near}
        state = {node: fifty_digits().number(value) for node, value in given.items()}
        for name, node in symbols.inputs.items():
            try:
                state[node] = evaluate((scope.value(model.inputs[name].value),), state, fifty_digits())[0]
            except NoValue:  # at t = 0, as 1/t: of another instant then
                state[node] = fifty_digits().number(rng.uniform(-1, 1))
        return state, begun[0] | model.first_guesses(p)

    def rows_at(self, state: State) -> np.ndarray:
        """J of the constraint rows at a state in which they hold, k x nu; entries that vanish there are exactly 0.

        Raises:
            NoValue: it has none there.
        """
        return Numbers(state).on_manifold(self.constraints.J, len(self.constraints.motion.scope.symbols.u))

    def closed(self, state: State, free: Sequence[Node], sizes: np.ndarray | None = None) -> State | None:
        """The nearest state with phi = 0, quaternions of norm 1, by moving free coordinates; None where none is near.

        What rounding alone would move stays: a distance that is 0 is 0, and what is divided by it has no value.

        Args:
            sizes: what counts as the same change of each of the free coordinates (None: 1 of each).

        The way is damped: see `symbolic.numeric.roots`.
        """
        found = nearest_root((*self.constraints.gaps, *self.constraints.norms), state, free, sizes)
        if found is None:
            return None
        return found | {q: state[q] for q in free if abs(found[q] - state[q]) < tolerances.ROUNDED_AWAY}

    def with_speeds(self, state: State) -> State:
        """The state with the nearest speeds that satisfy J u + sigma = 0."""
        u = self.constraints.motion.scope.symbols.u
        if not self.constraints.closing or not u:
            return state
        J, open_rate = _rates(self.constraints, state)
        step = np.linalg.lstsq(J, -open_rate, rcond=tolerances.LEAST_CHANGE)[0]
        return state | {node: state[node] + float(d) for node, d in zip(u, step, strict=True)}

    def nearest_places(self, state: State, tiers: Tiers, guessed: Sequence[Node]) -> State | None:
        """The nearest state with phi = 0, moving as few kinds of values as will do; None where none is near.

        Args:
            tiers: what may move, each with those before it: values that nobody gave, those of the model, the caller's.
            guessed: coordinates whose values are guesses: they may move far.
        """
        free: list[Node] = []
        for tier in tiers:
            free += tier
            moved = _moved(self.constraints, state, free) if tier else None
            found = None if moved is None else _nearest(moved, state, free, guessed)
            if found is not None:
                return found
        return None

    def nearest_speeds(self, state: State, tiers: Tiers, M: np.ndarray | None) -> State | None:
        """The state with the nearest speeds that satisfy J u + sigma = 0, or None where there are none.

        Of each tier no more is changed than what those before it cannot close.

        Args:
            tiers: as in `nearest_places`; the last two are of values that somebody gave.
            M: the mass matrix at the state, where it is known: it measures changes of these.
        """
        u = self.constraints.motion.scope.symbols.u
        if not self.constraints.closing or not u:
            return state
        J, open_rate = _rates(self.constraints, state)
        found, step = open_rate, np.zeros(len(u))
        columns = [[u.index(x) for x in tier] for tier in tiers]
        for k in reversed(range(len(columns))):
            earlier = [i for tier in columns[:k] for i in tier]
            block = None if M is None or k < len(columns) - 2 else M[np.ix_(columns[k], columns[k])]
            step[columns[k]] = _least(J[:, columns[k]], found, J[:, earlier], block)
            found = found + J[:, columns[k]] @ step[columns[k]]
        size = np.max(abs(J) @ abs(step) + abs(open_rate))
        if np.any(abs(J @ step + open_rate) > tolerances.RANK * size):
            return None
        return state | {x: state[x] + float(d) for x, d in zip(u, step, strict=True) if d}


def _scattered(constraints: Constraints, q: Mapping[str, float], spread: float, rng: Random) -> State:
    """Coordinates that lie about those given, soon after t = 0."""
    symbols = constraints.motion.scope.symbols
    shifted = {node: fifty_digits().number(q[node.name] + rng.uniform(-spread, spread)) for node in symbols.q}
    shifted |= constraints.motion.scope.on_unit_norms(shifted)
    return shifted | {symbols.t: fifty_digits().number(rng.uniform(0, spread))}


def _with_laws(constraints: Constraints, state: State) -> State:
    """The state, with the given rates and accelerations that are names (`Scope.laws`)."""
    laws = constraints.motion.scope.laws
    return state | dict(zip(laws, evaluate(tuple(laws.values()), state, fifty_digits(partial=True)), strict=True))


def _open(constraints: Constraints, known: Mapping[str, Any]) -> EomgenError:
    missing = tuple(name for name in constraints.motion.scope.symbols.parameters if name not in known)
    if missing:
        return MissingValues(missing)
    names = ", ".join(dict.fromkeys(row.constraint for row in constraints.rows if not row.identical))
    what = f"the constraints do not close near the start values: {names}"
    return OpenConstraints(what, fix="`eomgen check` says whether they can")


def nearest_root(
    gaps: Sequence[Scalar], state: State, free: Sequence[Node], sizes: np.ndarray | None = None
) -> State | None:
    """The nearest state at which the scalars vanish, as `closed`."""
    gaps, scale = tuple(gaps), np.ones(len(free)) if sizes is None else sizes
    slopes = tuple(x for row in jacobian(gaps, free) for x in row) if gaps else ()
    found = CLOSING.root(_Gaps(gaps, slopes, tuple(free), scale), state)
    return found.x if found.met else None


@dataclass(frozen=True)
class _Gaps:
    """Gaps of the constraints in a state, and their slopes by the free coordinates, measured in sizes of these."""

    gaps: tuple[Scalar, ...]
    derivatives: tuple[Scalar, ...]
    free: tuple[Node, ...]
    sizes: np.ndarray

    def left(self, state: State) -> Sequence[Any]:
        return evaluate(self.gaps, state, fifty_digits())

    def slopes(self, state: State) -> np.ndarray:
        values = [float(x) for x in evaluate(self.derivatives, state, fifty_digits())]
        return np.asarray(np.array(values).reshape(len(self.gaps), len(self.free)) * self.sizes)

    def moved(self, state: State, step: Sequence[Any]) -> State:
        return state | {q: state[q] + float(s) * d for q, s, d in zip(self.free, self.sizes, step, strict=True)}


def _rates(constraints: Constraints, state: State) -> tuple[np.ndarray, np.ndarray]:
    """(J, J u + sigma)."""
    rows = [(*J, row.velocity) for J, row in zip(constraints.J, constraints.closing, strict=True)]
    found = Numbers(state).array(rows, len(constraints.motion.scope.symbols.u) + 1)
    return found[:, :-1], found[:, -1]


# -------- consistency -----------------------------------------------------------------------------------------
# Constraints, a rough state -> the nearest state at which they hold, and what had to change for it.
#
# Positions:   phi(q) = 0        with the least sum of (s_k dq_k)^2 Speeds:      J u + sigma = 0   with the least du^T
# M du, as when the constraints take hold at once (an impact without rebound)
#
# s_k is how far a change of the k-th coordinate moves the gaps: angles and lengths count alike, whatever their units.
# The same holds of speeds that nobody gave, so that those stay which the constraints do not need, and where M is not
# known or measures nothing. Values that nobody gave move first, then those of the model, at last those that the caller
# gave.


ROUNDS = 12  # of walking along the constraints towards the values given
LEAP = 1.0  # of a guess [rad, m], beyond which other guesses are tried too
SPREADS_OF_ROUGH = (0.0, 0.1, 0.5, 1.0)  # rad: how far from a guess another one is tried
EASY = 1e3  # times farther a guess may move than a given value, for the same

Tiers = Sequence[Sequence[Node]]


def _least(J: np.ndarray, left: np.ndarray, others: np.ndarray, M: np.ndarray | None) -> np.ndarray:
    """The least d for which others can close what J d leaves: P (J d + left) = 0, P = 1 - J_o J_o^+."""
    if not J.shape[1]:
        return np.zeros(0)
    P = np.eye(len(J))
    if others.shape[1]:
        unit = others / _slopes(others)
        P = P - unit @ np.linalg.pinv(unit, rcond=tolerances.RANK)
    unit = _unit(J, M)
    rows = P @ J @ unit
    rows = np.where(abs(rows) > tolerances.RANK * np.max(abs(J @ unit)), rows, 0.0)
    open_ = np.where(abs(P @ left) > tolerances.SOLVED * np.max(abs(left), initial=0.0), P @ left, 0.0)
    found: np.ndarray = unit @ np.linalg.lstsq(rows, -open_, rcond=tolerances.RANK)[0]
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


def regular(constraints: Constraints, state: State, free: Sequence[Node]) -> bool:
    """True if the gaps are as independent in a state as in a configuration that is not special.

    Slopes are compared with those of that configuration: where all slopes vanish, the state is not regular.
    """
    J = [_slope(constraints, each, free) for each in (state, _another(constraints, state, free))]
    _, rows, columns = balanced(J[1])
    here, there = (np.linalg.svd(rows[:, None] * each * columns, compute_uv=False) for each in J)
    smallest = tolerances.RANK * np.max(there, initial=0.0)
    return bool(np.sum(here > smallest) >= np.sum(there > smallest))


def _another(constraints: Constraints, state: State, free: Sequence[Node]) -> State:
    """A configuration that is not special; where the gaps close in none but this one, they need not close there."""
    try:
        other = Closure(constraints).generic()
    except (DerivationError, MissingValues):
        return Closure(constraints).scattered()
    same = all(abs(other[q] - state[q]) < tolerances.SAME_PLACE for q in free)
    return Closure(constraints).scattered() if same else other


def far(constraints: Constraints, before: State, after: State, given: Sequence[Node]) -> bool:
    """True if the change of a given coordinate moved the gaps by more than a change of 1 of any given one would."""
    slopes = _slopes(_slope(constraints, after, given))
    moved = [abs(float(after[q] - before[q])) for q in given]
    return bool(np.any(slopes * np.array(moved) > np.max(slopes, initial=0.0)))


# -- positions ---------------------------------------------------------------------------------------


def _moved(constraints: Constraints, state: State, free: Sequence[Node]) -> Constraints | None:
    """The rows that these coordinates move; None where another one is open by more than the rounding of its values."""
    others = [row for row in constraints.rows if row.gap is not None and not depends_on(row.gap, free)]
    gaps = tuple(row.gap for row in others if row.gap is not None and not row.identical)
    slopes = _slope(replace(constraints, rows=tuple(others)), state, constraints.movable)
    sizes = np.max(np.abs(slopes), axis=1, initial=0.0)
    try:
        values = evaluate(gaps, state, fifty_digits())
    except (NoValue, ZeroDivisionError):
        return None
    if any(
        abs(x) > tolerances.SOLVED * max(size, tolerances.DEGENERATE) for x, size in zip(values, sizes, strict=True)
    ):
        return None
    return replace(constraints, rows=tuple(row for row in constraints.rows if row not in others))


def _nearest(constraints: Constraints, state: State, free: Sequence[Node], guessed: Sequence[Node]) -> State | None:
    """The nearest state that satisfies the constraints with only `free` moved; None where none is found.

    The search starts where they stand, then at other guesses; of states that are all far away, the nearest.
    """
    given = [q for q in free if q not in guessed]
    leaps: list[tuple[float, State]] = []
    for start in _guesses(state, [q for q in free if q in guessed]):
        found = _walked(constraints, start, free, state, guessed)
        if found is None or far(constraints, state, found, given) or not regular(constraints, found, free):
            continue
        found = _turned_back(constraints, state, found, guessed)
        apart = max((abs(float(found[q] - state[q])) for q in guessed), default=0.0)
        if apart <= LEAP:
            return found
        leaps.append((apart, found))
    return min(leaps, key=lambda leap: leap[0])[1] if leaps else None


def _turned_back(constraints: Constraints, before: State, found: State, guessed: Sequence[Node]) -> State:
    """The place with whole turns taken back where the constraints hold as well without them."""
    turn = 2 * evaluate((constraints.motion.scope.graph.pi,), {}, fifty_digits())[0]
    for q in guessed:
        turns = round(float((found[q] - before[q]) / turn))
        if not turns:
            continue
        back = found | {q: found[q] - turns * turn}
        if all(abs(x) <= tolerances.CLOSED_AT_50 for x in evaluate(constraints.gaps, back, fifty_digits())):
            found = back
    return found


def _guesses(state: State, guessed: Sequence[Node]) -> Iterator[State]:
    rng = Random(1)
    for spread in SPREADS_OF_ROUGH if guessed else SPREADS_OF_ROUGH[:1]:
        yield state | {q: state[q] + rng.uniform(-spread, spread) for q in guessed}


def _walked(
    constraints: Constraints, start: State, free: Sequence[Node], wanted: Mapping[Node, Any], guessed: Sequence[Node]
) -> State | None:
    """Closed from the start, then along the constraints to the point that is nearest to the wanted values, guesses
    last.

    dq = (1 - J^+ J) (q_wanted - q), and closed again, till that is nothing.
    """
    sizes = 1 / _slopes(_slope(constraints, start, free)) * np.array([EASY if q in guessed else 1.0 for q in free])
    found = Closure(constraints).closed(start, free, sizes)
    for _ in range(ROUNDS if found is not None else 0):
        assert found is not None
        J = _slope(constraints, found, free) * sizes
        left = np.array([float(wanted[q] - found[q]) for q in free]) / sizes
        along = left - np.linalg.pinv(J, rcond=tolerances.RANK) @ (J @ left)
        if np.max(abs(along), initial=0.0) < tolerances.SOLVED:
            break
        moved = found | {q: found[q] + float(d) for q, d in zip(free, sizes * along, strict=True)}
        found = Closure(constraints).closed(moved, free, sizes) or found
    return found


def _slope(constraints: Constraints, state: State, free: Sequence[Node]) -> np.ndarray:
    """d phi/dq of the free coordinates."""
    gaps: tuple[Scalar, ...] = constraints.gaps
    try:
        return Numbers(state).array(jacobian(gaps, free), len(free))
    except (NoValue, ZeroDivisionError):
        return np.ones((len(gaps), len(free)))


def _slopes(J: np.ndarray) -> np.ndarray:
    """Length of each column of J, bounded below so that none is 0."""
    lengths = lengths_of(J, 0)
    return np.asarray(np.maximum(lengths, tolerances.DEGENERATE * (np.max(lengths, initial=0.0) or 1.0)))


def bilateral(constraints: Constraints, ending: Sequence[str], holds: Sequence[str]) -> Constraints:
    """The constraints without those contacts that can end and do not hold: what is open there may stay open."""
    return replace(
        constraints,
        rows=tuple(row for row in constraints.rows if row.constraint not in ending or row.constraint in holds),
    )
