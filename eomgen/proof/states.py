"""System -> states at which it is proved: its own start, one in each piece of its piecewise functions, random ones.

A state at which something has no value is not a failure: another near it is taken; if there is none, it is left out.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from contextlib import suppress
from functools import cached_property
from random import Random
from typing import Any

from eomgen.errors import DerivationError, ModelError, UsageError
from eomgen.frozen import dataclass
from eomgen.mechanics.constraints import Closure
from eomgen.mechanics.dynamics import System
from eomgen.mechanics.kinematics import Motion
from eomgen.mechanics.start import Start
from eomgen.model import Couple, PointForce
from eomgen.symbolic.expression import Matrix, Scalar, State, Vector, is_zero
from eomgen.symbolic.numeric import NoValue, Switch, evaluate, fifty_digits, switches_of, tolerances

CONSISTENT = (11,)  # seeds of states at which all constraints hold
OWN_START = "own start"
TRIES = 20  # random states, for one with a value
NEAR = (0.001, 0.01, 0.1, 0.5)  # how far from the start another is looked for, twice each
MOST = 12  # pieces of one quantity that are visited, evenly spread; 1000 samples are one formula


@dataclass(frozen=True)
class TrialState:
    """A state, and the words that name it where something differs there."""

    state: State
    remark: str = ""


class Supply:
    """States that are made when they are needed, and cached."""

    def __init__(self, source: Iterable[TrialState]) -> None:
        self._source, self._kept = iter(source), list[TrialState]()

    def __iter__(self) -> Iterator[TrialState]:
        k = 0
        while True:
            if k == len(self._kept):
                found = next(self._source, None)
                if found is None:
                    return
                self._kept.append(found)
            yield self._kept[k]
            k += 1


@dataclass(frozen=True)
class States:
    """States of a system; the first state with values of each supply is used.

    Args:
        scalars: all scalars to check; piecewise ones are checked in each of their pieces.
    """

    system: System
    scalars: tuple[Scalar, ...]

    @cached_property
    def supplies(self) -> tuple[tuple[str, Supply], ...]:
        """(where, states): "at the start", then "in a piece" of each quantity, then "at random"."""
        pieces = [("in a piece", self._supply(found)) for found in self._pieces()]
        return (
            ("at the start", self._supply(self._at_the_start())),
            *pieces,
            ("at random", self._supply(self._at_random())),
        )

    def _supply(self, states: Iterator[TrialState]) -> Supply:
        return Supply(place for place in states if self._is_near(place.state) and self._satisfied(place.state))

    @property
    def _identities(self) -> tuple[Scalar, ...]:
        """Gaps that vanish identically, but not for all values of the coordinates: |1 + s| + |1 - s| - 2."""
        rows = (row for row in self.system.constraints.rows if row.identical and row.gap is not None)
        return tuple(row.gap for row in rows if row.gap is not None and not is_zero(row.gap))

    def _satisfied(self, state: State) -> bool:
        """True if constraints that hold identically near the start hold here: past its eyelet a string is too long."""
        try:
            return all(abs(x) <= tolerances.COMPUTED for x in evaluate(self._identities, state, fifty_digits()))
        except (NoValue, ZeroDivisionError):
            return True

    def _is_near(self, state: State) -> bool:
        """True if the numbers are small enough to leave digits for differences, and not to overflow when squared."""
        symbols = self.system.symbols
        moving, given = symbols.x, symbols.parameters.values()
        near = all(abs(state[x]) <= tolerances.LARGEST_AT_50 for x in moving if x in state)
        return near and all(abs(state[x]) <= tolerances.LARGEST_SQUARED for x in given if x in state)

    @cached_property
    def switches(self) -> tuple[Switch, ...]:
        """Quantities that decide between pieces of functions and change along the motion."""
        symbols = self.system.symbols
        moving = frozenset((symbols.t, *symbols.x, *symbols.inputs.values()))
        return switches_of(self.scalars, moving)

    def inside(self, state: State) -> bool:
        """True if the state does not lie on the border of two pieces."""
        return all(switch.piece(state) is not None for switch in self.switches)

    def _at_the_start(self) -> Iterator[TrialState]:
        """The model's own start and numbers, then states near it."""
        rng = Random(8)
        start = own_start(self.system)
        if start is not None:
            yield from self._if_inside(start)
            for spread in (*NEAR, *NEAR):
                yield from self._if_inside(_shaken(self.system, start, spread, rng))

    def _if_inside(self, state: State) -> Iterator[TrialState]:
        try:
            if self.inside(state):
                yield TrialState(state, " (at the start)")
        except (NoValue, ZeroDivisionError):
            return

    def _pieces(self) -> Iterator[Iterator[TrialState]]:
        """States in every piece of every such quantity, moving, and with the model's own parameters."""
        rng = Random(6)
        start = own_start(self.system) if self.switches else None
        if start is None:
            return
        visited: set[tuple[int, int]] = set()
        for k, switch in enumerate(self.switches):
            count = len(switch.places(start)) + 1
            for j in sorted({round(i * (count - 1) / (min(count, MOST) - 1)) for i in range(min(count, MOST))}):
                if (k, j) not in visited:
                    yield self._in_piece((k, j), start, visited, rng)

    def _in_piece(
        self, piece: tuple[int, int], start: State, visited: set[tuple[int, int]], rng: Random
    ) -> Iterator[TrialState]:
        """States in one piece; the other pieces in which they lie count as visited."""
        k, j = piece
        switch, symbols = self.switches[k], self.system.symbols
        moving = frozenset((symbols.t, *symbols.x, *symbols.inputs.values()))
        for target in switch.targets(start)[j]:
            try:
                found = switch.moved(_set_moving(self.system, start, rng), target, moving)
                if found is None:
                    continue
                place = self._closed(found, switch, j)
                if place is None or not self.inside(place.state):
                    continue
                visited |= {(i, s.piece(place.state) or 0) for i, s in enumerate(self.switches)}
            except (NoValue, ZeroDivisionError):
                continue
            yield place

    def _closed(self, state: State, switch: Switch, piece: int) -> TrialState | None:
        """State with its constraints satisfied; None where that leads out of its piece: no motion comes there."""
        state = state | self.system.scope.on_unit_norms(state)
        constraints = self.system.constraints
        if all(row.identical for row in constraints.rows):
            return TrialState(state, " (in one of its pieces)")
        found = Closure(constraints).closed(state, constraints.movable)
        if found is None or switch.piece(found) != piece:
            return None
        return TrialState(found, " (in one of its pieces)")

    def _at_random(self) -> Iterator[TrialState]:
        rng = Random(7)
        for _ in range(TRIES):
            state, remark = closed_state(self.system, rng)
            yield TrialState(state, remark)


def own_start(system: System) -> State | None:
    """Model at its own start, with its own parameters or random ones; None where the constraints do not hold.

    One state serves all checks: its accelerations are found once.
    """
    if OWN_START not in system.found:
        system.found[OWN_START] = _own_state(system, Random(5))
    found: State | None = system.found[OWN_START]
    return found


def _own_state(system: System, rng: Random) -> State | None:
    model, symbols, number = system.scope.model, system.symbols, fifty_digits().number
    known = model.exact_parameters()
    drawn = {name: round(rng.uniform(0.7, 1.3), 6) for name in symbols.parameters if name not in known}
    try:
        values = Start.of(system, drawn).values
    except (DerivationError, ModelError, UsageError):
        return None
    known = {**model.exact_parameters(drawn), **values}
    given = {node: known[name] for name, node in symbols.parameters.items()}
    given |= {node: known[node.name] for node in symbols.x}
    state = {node: number(value) for node, value in (*given.items(), (symbols.t, 0))}
    state |= {x: number(rng.uniform(-1, 1)) for x in (*symbols.a, *symbols.lam)}
    state |= system.scope.on_unit_norms(state)
    if not all(row.identical for row in system.constraints.rows):
        state = Closure(system.constraints).closed(state, system.constraints.movable) or state
    elif not system.scope.quaternions:
        state = in_doubles(state)
    return with_inputs(system, state)


def _set_moving(system: System, state: State, rng: Random) -> State:
    """The state with speeds of its own."""
    return state | {u: state[u] + fifty_digits().number(rng.uniform(-1, 1)) for u in system.symbols.u}


def _shaken(system: System, state: State, spread: float, rng: Random) -> State:
    """State near another one, its constraints satisfied where they can be."""
    symbols = system.symbols
    shifted = {x: state[x] + fifty_digits().number(rng.uniform(-spread, spread)) for x in symbols.x}
    shifted[symbols.t] = state[symbols.t] + fifty_digits().number(rng.uniform(0, spread))
    return closed_near(system, state | shifted)


def closed_near(system: System, state: State) -> State:
    """The state near another one at which the constraints hold; itself where none is found."""
    state = state | system.scope.on_unit_norms(state)
    if all(row.identical for row in system.constraints.rows):
        return state
    return Closure(system.constraints).closed(state, system.constraints.movable) or state


def real_state(system: System, rng: Random) -> State:
    """Random values of all symbols, at 50 digits; parameters and times positive."""
    arithmetic = fifty_digits()
    symbols = system.symbols

    def draw(low: int, high: int) -> Any:
        return arithmetic.number(1) * rng.randint(low * 10**12, high * 10**12) / 10**12

    state = {p: draw(1, 3) / 2 for p in symbols.parameters.values()}
    state |= {x: draw(-1, 1) for x in (*symbols.x, *symbols.a, *symbols.lam, *symbols.inputs.values())}
    state[symbols.t] = draw(0, 1)
    return state | system.scope.on_unit_norms(state)


def refuse_open(system: System, state: State) -> None:
    """Refuses a state in which the gap or the rate of a row is not 0.

    Raises:
        NoValue: they are not.
    """
    rows = [row for row in system.constraints.rows if not row.identical]
    requested = [*(row.velocity for row in rows), *(row.gap for row in rows if row.gap is not None)]
    if any(abs(x) > tolerances.COMPUTED for x in evaluate(requested, state, fifty_digits())):
        raise NoValue("the constraints are open")


def is_open(system: System, state: State) -> bool:
    """True if the constraints do not hold at a state, in positions or speeds."""
    try:
        refuse_open(system, state)
    except NoValue:
        return True
    return False


def consistent_states(system: System) -> tuple[tuple[str, Supply], ...]:
    """States in motion at which every constraint holds, positions and speeds, by where dependent coordinates are free.

    A row that is wrongly taken for one that holds something may keep the states of the system from moving.
    """
    whole = system.free if system.free is not None and not system.declared else system
    start = own_start(system)

    def at_random(seed: int) -> Iterator[TrialState]:
        rng = Random(seed)
        for _ in range(TRIES):
            state = real_state(system, rng)
            with suppress(DerivationError, ModelError):
                yield TrialState(
                    state | Closure(whole.constraints).generic(rng), " (at a state at which all constraints hold)"
                )

    begun = () if start is None else (TrialState(start, " (at the start)"),)
    random = [("at random", Supply(at_random(seed))) for seed in CONSISTENT]
    return (("at the start", Supply(begun)), *random)


def in_doubles(state: State) -> State:
    """The state rounded to numbers that code can take as they are."""
    return {node: fifty_digits().number(float(value)) for node, value in state.items()}


def closed_state(system: System, rng: Random) -> tuple[State, str]:
    """A random real state, and a remark; where constraints close, one in which they do if one is near the start."""
    state = real_state(system, rng)
    if all(row.identical for row in system.constraints.rows):
        return state if system.scope.quaternions else in_doubles(state), ""
    try:
        return state | Closure(system.constraints).generic(rng), ""
    except (DerivationError, ModelError) as error:  # the equations still say what a is, if no row is redundant
        return state, f" ({error.what})"


# -------- in numbers ------------------------------------------------------------------------------------------
# System, state -> scalars, vectors, forces on bodies and rates in numbers: 50 digits, ground axes, differences.
#
# q(t +- h) = q +- h q' + h^2 q''/2,   u +- h u',   t +- h;     x' = (x+ - x-)/2h,   x'' = (x+ - 2 x + x-)/h^2

SAMPLES = "times of samples"
STEP = fifty_digits().number(1) / 10**15  # of a central difference, whose error is its square
FINER_STEP = STEP / 10**4  # where the way bends sharply
SECOND_STEP = fifty_digits().number(1) / 10**12  # [s] of first and second differences: both are sure to 20 digits


def direction_at(v: Vector) -> Vector:
    """v over its length.

    Raises:
        NoValue: it has none.
    """
    size = fifty_digits().functions["sqrt"](v @ v)
    if size == 0:
        raise NoValue("a direction of length 0")
    unit: Vector = v * (1 / size)
    return unit


def with_inputs(system: System, known: State) -> State:
    """A state with those of the model's inputs that it does not give."""
    own = {node: system.inputs[name] for name, node in system.symbols.inputs.items() if node not in known}
    return {**known, **dict(zip(own, evaluate(tuple(own.values()), known, fifty_digits()), strict=True))}


@dataclass(frozen=True)
class InNumbers:
    """System at a state; its quantities have a value there, or NoValue is raised."""

    system: System
    state: State

    @property
    def motion(self) -> Motion:
        return self.system.motion

    def at(self, scalars: Sequence[Scalar]) -> list[Any]:
        return evaluate(tuple(scalars), self.state, fifty_digits())

    def one(self, x: Scalar) -> Any:
        return self.at((x,))[0]

    def vector(self, v: Sequence[Scalar]) -> Vector:
        return Vector(self.at(v))

    def carried(self, body: str | None, place: Vector, *, direction: bool = False) -> Vector:
        """Place or direction of a body in ground axes."""
        if body is None:
            return place
        R, p = self._stand(body)
        turned = R @ place
        return turned if direction else p + turned

    @cached_property
    def _stands(self) -> dict[str, tuple[Matrix, Vector]]:
        return {}

    def _stand(self, body: str) -> tuple[Matrix, Vector]:
        """R and p of a body, worked once."""
        if body not in self._stands:
            pose = self.motion.link(body).pose
            own = self.at([*(x for row in pose.R for x in row), *pose.p])
            self._stands[body] = Matrix.of((own[0:3], own[3:6], own[6:9])), Vector(own[9:12])
        return self._stands[body]

    def velocity(self, body: str | None, P: Vector) -> Vector:
        """Velocity of the material point of a body at P: R (v + w x R^T (P - p))."""
        if body is None:
            return Vector.ZERO
        (R, p), twist = self._stand(body), self.motion.link(body).twist
        own = self.at((*twist.w, *twist.v))
        w, v = Vector(own[:3]), Vector(own[3:])
        return R @ (v + w.cross(R.T @ (P - p)))


Pushes = dict[str, tuple[Vector, Vector]]
"""(moment about the ground's origin, force) on each body, in ground axes."""


def pushes_of(motion: Motion, state: State, loads: Iterable[Any]) -> Pushes:
    """Wrench of each load and row on each body; a load without a place is left out."""
    found: Pushes = {}
    for load in loads:
        if isinstance(load, PointForce):
            scalars = (*motion.position(load.place), *motion.in_ground_axes(load.force, load.axes))
            values = evaluate(scalars, state, fifty_digits())
            add_push(found, load.place[0], Vector(values[:3]).cross(Vector(values[3:])), Vector(values[3:]))
        elif isinstance(load, Couple):
            couple = evaluate(motion.in_ground_axes(load.couple, load.axes), state, fifty_digits())
            add_push(found, load.body, Vector(couple), Vector.ZERO)
    return found


def add_push(pushes: Pushes, body: str | None, moment: Vector, force: Vector) -> None:
    """One more push; the ground bears all."""
    if body is not None:
        tau, f = pushes.get(body, (Vector.ZERO, Vector.ZERO))
        pushes[body] = tau + moment, f + force


def pushed_otherwise(found: Pushes, due: Pushes, size: Any) -> str:
    """First body on which a wrench differs from the due one, relative to the size of forces times arms; ""."""
    nothing = (Vector.ZERO, Vector.ZERO)
    for body in dict.fromkeys((*found, *due)):
        pairs = zip(found.get(body, nothing), due.get(body, nothing), strict=True)
        apart: list[Any] = [x - y for a, b in pairs for x, y in zip(a, b, strict=True)]
        if any(abs(x) > tolerances.ZERO_AT_50 * size for x in apart):
            return body
    return ""


@dataclass(frozen=True)
class Way:
    """The states of a motion a step h before an instant, at it, and a step after.

    Args:
        side: 1 or -1: at it, and one, two and three steps after or before, where a given function has a corner there.
    """

    states: tuple[State, ...]
    h: Any
    side: int = 0

    @property
    def now(self) -> State:
        return self.states[0 if self.side else 1]

    def along(self, scalars: Sequence[Scalar]) -> tuple[list[Any], list[Any], list[Any]]:
        """(values, rates, second rates), these of a way to second order."""
        if self.side:
            return self._beside(scalars)
        early, now, late = (evaluate(tuple(scalars), state, fifty_digits()) for state in self.states)
        second = [(a - 2 * x + b) / self.h**2 for a, x, b in zip(early, now, late, strict=True)]
        return now, [(b - a) / (2 * self.h) for a, b in zip(early, late, strict=True)], second

    def _beside(self, scalars: Sequence[Scalar]) -> tuple[list[Any], list[Any], list[Any]]:
        """The same to second order by values on one side: (-3 f0 + 4 f1 - f2)/2h, (2 f0 - 5 f1 + 4 f2 - f3)/h^2."""
        found = [evaluate(tuple(scalars), state, fifty_digits()) for state in self.states]
        rates = [self.side * (4 * b - 3 * a - c) / (2 * self.h) for a, b, c, _ in zip(*found, strict=True)]
        second = [(2 * a - 5 * b + 4 * c - d) / self.h**2 for a, b, c, d in zip(*found, strict=True)]
        return found[0], rates, second

    def rates(self, scalars: Sequence[Scalar]) -> list[Any]:
        if self.side:
            return self._beside(scalars)[1]
        early, late = (evaluate(tuple(scalars), state, fifty_digits()) for state in self.states[::2])
        return [(b - a) / (2 * self.h) for a, b in zip(early, late, strict=True)]


def way_through(system: System, state: State, h: Any = STEP, *, order: int = 1) -> Way:
    """Motion through a state with given accelerations, to first or second order in q."""
    symbols, scope = system.symbols, system.scope
    first = evaluate(scope.rates, state, fifty_digits())
    second = evaluate(scope.with_accelerations(scope.rates), state, fifty_digits()) if order == 2 else [0] * len(first)

    def later(t: Any) -> State:
        moved = {q: state[q] + t * v + t * t / 2 * a for q, v, a in zip(symbols.q, first, second, strict=True)}
        moved |= {u: state[u] + t * state[a] for u, a in zip(symbols.u, symbols.a, strict=True) if a in state}
        return {**state, **moved, symbols.t: state[symbols.t] + t}

    if side := _side(system, state):
        return Way(tuple(later(side * k * h) for k in range(4)), h, side)
    return Way((later(-h), state, later(h)), h)


def _times_of_samples(system: System) -> set[tuple[Any, ...]]:
    """Times of the samples of each function that is given by samples."""
    if SAMPLES not in system.found:
        system.found[SAMPLES] = {given.times for _, _, given in system.scope.model.given_samples}
    found: set[tuple[Any, ...]] = system.found[SAMPLES]
    return found


def instant_of(system: System, t: float) -> Any:
    """A time of doubles with 50 digits; that of a sample where it is the double next to it.

    0.3 is less than 3/10: read as it stands it would lie before the sample at which code takes the piece after.
    """
    number = fifty_digits().number
    at = (number(x) for times in _times_of_samples(system) for x in times if float(x) == t)
    return next(at, number(t))


def _side(system: System, state: State) -> int:
    """1 or -1 at the first or last sample of a given function, to differentiate inside the samples; 0 elsewhere."""
    t, knots = state.get(system.symbols.t, 0), _times_of_samples(system)
    if not any(abs(x - t) < tolerances.ZERO_AT_50 for times in knots for x in map(fifty_digits().number, times)):
        return 0
    return -1 if any(abs(fifty_digits().number(times[-1]) - t) < tolerances.ZERO_AT_50 for times in knots) else 1
