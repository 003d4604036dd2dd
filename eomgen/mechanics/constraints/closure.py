"""Ties -> states in which the loops close: phi = 0 and J u + sigma = 0, in numbers of 50 digits.

Where loops are redundant the rank of J shows only as well as phi = 0 holds: an error d of the position
makes redundant rows differ by d. So positions are sought to 1e-28.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from contextlib import suppress
from random import Random
from typing import Any

import numpy as np

from eomgen.errors import EomgenError, MissingValues, OpenTies
from eomgen.mechanics.constraints.ties import Ties
from eomgen.model.values import exact_parameters, first_guesses, start_values
from eomgen.records import dataclass, recalled
from eomgen.symbolic.expression.derivative import jacobian
from eomgen.symbolic.expression.functions import sqrt
from eomgen.symbolic.expression.graph import Node, Scalar
from eomgen.symbolic.expression.node import State
from eomgen.symbolic.numeric.dense import closed_entries
from eomgen.symbolic.numeric.evaluation import NoValue, evaluate, fifty_digits, floats_of
from eomgen.symbolic.numeric.newton import Newton
from eomgen.symbolic.numeric.tolerances import CLOSED_AT_50, LEAST_CHANGE, ROUNDED_AWAY, SUMMED

CLOSING = Newton(enough=CLOSED_AT_50, stalls=SUMMED, damped=True, again=True)
SPREADS = (0.1, 0.01, 0.001)  # how far from the start a generic configuration is looked for


def generic_state(ties: Ties, rng: Random | int = 1, *, shaken: bool = False, spreads: Sequence[float] = ()) -> State:
    """Values of every symbol: near the start, off any special position, with phi = 0 and J u + sigma = 0.

    Parameters without a value get one. Driven coordinates and t are near the start too, as if given by another law.

    Args:
        rng: its numbers, or their seed; of a seed it is found once.
        shaken: parameters have values of their own, near the model's, so that nothing vanishes for these alone.
        spreads: how far from the start it is looked for, the first first; before those near to it.
    Raises:
        MissingValues, DerivationError: the ties do not close there.
    """
    if isinstance(rng, int):
        seed, key = rng, (generic_state, rng, shaken, tuple(spreads))
        known = recalled(ties, key, lambda: generic_state(ties, Random(seed), shaken=shaken, spreads=spreads))
        return dict(known)
    state, q = still_values(ties, rng, shaken=shaken)
    for spread in (*spreads, *SPREADS):
        found = closed(ties, state | _scattered(ties, q, spread, rng), movable(ties))
        if found is not None:
            with suppress(NoValue, ZeroDivisionError):  # a strand into a pulley: nearer then
                return speeds_closed(ties, _with_laws(ties, found))
    raise _open(ties, exact_parameters(ties.motion.scope.model))


def begun_state(ties: Ties) -> State:
    """Values of every symbol at the model's own start, the nearest at which phi = 0; speeds as they are given.

    Raises:
        MissingValues, DerivationError: the ties do not close there.
    """
    model, symbols = ties.motion.scope.model, ties.motion.scope.symbols
    state, q = still_values(ties, Random(1))
    numbers = {name: float(state[node]) for name, node in symbols.parameters.items()}
    speeds = start_values(model, numbers)[1]
    given = {node: of_50_digits(q[node.name]) for node in symbols.q}
    given |= {u: of_50_digits(speeds.get(u.name, 0.0)) for u in symbols.u}
    given |= on_unit_spheres(ties.motion.scope.quaternions, state | given)
    found = closed(ties, state | given, movable(ties))
    if found is None:
        raise _open(ties, exact_parameters(model))
    return speeds_closed(ties, _with_laws(ties, found))


def scattered_state(ties: Ties) -> State:
    """Values of every symbol: near the start, off any special position; the ties need not hold."""
    rng = Random(1)
    state, q = still_values(ties, rng)
    return _with_laws(ties, state | _scattered(ties, q, SPREADS[0], rng))


def still_values(ties: Ties, rng: Random, *, shaken: bool = False) -> tuple[State, dict[str, float]]:
    """(values of every symbol but the coordinates, where the coordinates start)."""
    scope = ties.motion.scope
    model, symbols = scope.model, scope.symbols
    known = exact_parameters(model)
    p = {name: float(known[name]) if name in known else rng.uniform(0.7, 1.3) for name in symbols.parameters}
    if shaken:
        p = {name: value * rng.uniform(0.8, 1.2) if value else rng.uniform(0.05, 0.2) for name, value in p.items()}
    given = {node: p[name] for name, node in symbols.parameters.items()} | {symbols.t: 0.0}
    given |= {node: rng.uniform(-1, 1) for node in (*symbols.u, *symbols.a)}
    state = {node: of_50_digits(value) for node, value in given.items()}
    for name, node in symbols.inputs.items():
        try:
            state[node] = evaluate((scope.value(model.inputs[name].value),), state, fifty_digits())[0]
        except NoValue:  # at t = 0, as 1/t: of another instant then
            state[node] = of_50_digits(rng.uniform(-1, 1))
    return state, start_values(model, p)[0] | first_guesses(model, p)


def _scattered(ties: Ties, q: Mapping[str, float], spread: float, rng: Random) -> State:
    """Coordinates that lie about those given, soon after t = 0."""
    symbols = ties.motion.scope.symbols
    shifted = {node: of_50_digits(q[node.name] + rng.uniform(-spread, spread)) for node in symbols.q}
    shifted |= on_unit_spheres(ties.motion.scope.quaternions, shifted)
    return shifted | {symbols.t: of_50_digits(rng.uniform(0, spread))}


def _with_laws(ties: Ties, state: State) -> State:
    """The state, with the given rates and accelerations that are names (`Scope.laws`)."""
    laws = ties.motion.scope.laws
    return state | dict(zip(laws, evaluate(tuple(laws.values()), state, fifty_digits(partial=True)), strict=True))


def on_unit_spheres(spheres: Sequence[Sequence[Node]], state: State) -> State:
    """The symbols whose squares add up to 1, over their norm."""
    found: State = {}
    for symbols in spheres:
        (norm,) = evaluate((sqrt(sum((x * x for x in symbols), start=0)),), state, fifty_digits())
        found |= {x: state[x] / norm for x in symbols}
    return found


def of_50_digits(value: float) -> Any:
    """A float as a number of 50 digits."""
    return fifty_digits().number(1) * value


def _open(ties: Ties, known: Mapping[str, Any]) -> EomgenError:
    missing = tuple(name for name in ties.motion.scope.symbols.parameters if name not in known)
    if missing:
        return MissingValues(missing)
    names = ", ".join(dict.fromkeys(row.tie for row in ties.rows if not row.identical))
    what = f"the ties do not close near the start values: {names}"
    return OpenTies(what, mend="`eomgen check` says whether they can")


def rows_where_closed(ties: Ties, state: State) -> np.ndarray:
    """J of the closing rows at a state in which they hold, k x nu; entries that vanish there are 0, not what is left.

    Raises:
        NoValue: it has none there.
    """
    values = floats_of(evaluate([x for row in ties.J for x in row], state, fifty_digits()))
    return closed_entries(np.array(values).reshape(len(ties.closing), len(ties.motion.scope.symbols.u)))


def movable(ties: Ties) -> list[Node]:
    """The coordinates that are not driven."""
    scope = ties.motion.scope
    return [q for q in scope.symbols.q if not scope.model.coordinates[q.name].driven]


def gaps_of(ties: Ties) -> tuple[Scalar, ...]:
    """phi of every row that the coordinates do not satisfy by themselves, where it has one."""
    return tuple(row.gap for row in ties.rows if row.gap is not None and not row.identical)


def norms_of(ties: Ties) -> tuple[Scalar, ...]:
    """e . e - 1 of every quaternion."""
    return tuple(sum((e * e for e in four), start=-1) for four in ties.motion.scope.quaternions)


def closed(ties: Ties, state: State, free: Sequence[Node], sizes: np.ndarray | None = None) -> State | None:
    """The nearest state with phi = 0, quaternions of norm 1, by moving the free coordinates; None where none is near.

    What rounding alone would move stays: a distance that is 0 is 0, and what is divided by it has no value.

    Args:
        sizes: what counts as the same change of each of the free coordinates (None: 1 of each).

    The way is damped: see `symbolic.numeric.newton`.
    """
    found = nearest_root((*gaps_of(ties), *norms_of(ties)), state, free, sizes)
    if found is None:
        return None
    return found | {q: state[q] for q in free if abs(found[q] - state[q]) < ROUNDED_AWAY}


def nearest_root(
    gaps: Sequence[Scalar], state: State, free: Sequence[Node], sizes: np.ndarray | None = None
) -> State | None:
    """The nearest state at which these vanish, as `closed`."""
    gaps, scale = tuple(gaps), np.ones(len(free)) if sizes is None else sizes
    slopes = tuple(x for row in jacobian(gaps, free) for x in row) if gaps else ()
    found = CLOSING.root(_Gaps(gaps, slopes, tuple(free), scale), state)
    return found.x if found.met else None


@dataclass(frozen=True)
class _Gaps:
    """What is open in a state, and its slopes by the free coordinates, measured in sizes of these."""

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


def speeds_closed(ties: Ties, state: State) -> State:
    """The state with the nearest speeds that satisfy J u + sigma = 0."""
    u = ties.motion.scope.symbols.u
    if not ties.closing or not u:
        return state
    entries = (*(x for row in ties.J for x in row), *(row.velocity for row in ties.closing))
    values = [float(x) for x in evaluate(entries, state, fifty_digits())]
    k = len(ties.closing)
    J, open_rate = np.reshape(values[:-k], (k, len(u))), np.array(values[-k:])
    step = np.linalg.lstsq(J, -open_rate, rcond=LEAST_CHANGE)[0]
    return state | {node: state[node] + float(d) for node, d in zip(u, step, strict=True)}
