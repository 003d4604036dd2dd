"""System -> states at which it is proved: its own start, one in each piece of its piecewise functions, random ones.

A state at which something has no value is not a failure: another near it is taken; if there is none, it is left out.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from contextlib import suppress
from functools import cached_property
from random import Random
from typing import Any

from eomgen.errors import DerivationError, ModelError, UsageError
from eomgen.frozen import dataclass
from eomgen.mechanics.constraints import Closure
from eomgen.mechanics.dynamics import System
from eomgen.mechanics.start import Start
from eomgen.proof.in_numbers import with_inputs
from eomgen.symbolic.expression import Scalar, State, is_zero
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
