"""Departure of a motion from a rest or a dead centre, and the way along the configurations of one degree of freedom."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from functools import cached_property

import numpy as np

from eomgen.codegen import Program, RightHandSide
from eomgen.errors import DerivationError, RunFailed
from eomgen.frozen import dataclass
from eomgen.mechanics.dynamics import EquationsOfMotion
from eomgen.mechanics.integrals import Relations, position_equations, rates_and_extent
from eomgen.simulation.event_location import Events
from eomgen.simulation.integrator import Run, Stepping, march
from eomgen.simulation.phase_model import PhaseModel
from eomgen.symbolic.exact import vanishes
from eomgen.symbolic.expression import Fraction, Node, Scalar, State, depends_on, inner, substituted
from eomgen.symbolic.numeric import FLOAT, all_roots, evaluate, least_left, tolerances

# -------- rest departure --------------------------------------------------------------------------------------
# System, start -> where a motion goes from a rest or a dead centre: along the configurations, by the energy theorem.
#
# Time does not lead away from an unstable rest, and at a dead centre it has no say which way.


FIX = "give it a speed"


@dataclass(frozen=True)
class RestDeparture:
    """A start from which time may not lead away.

    Args:
        equations, accelerations: the equations of motion.
        exact: q and u at the start as scalars of the parameters, {} where they have no closed form.
        start: t, q and u at the start.
        values: of the parameters.
        phase: the same equations as functions of numbers.
        names: coordinates, rates and speeds at the start, by name.
    """

    equations: EquationsOfMotion
    accelerations: tuple[Scalar, ...]
    exact: State
    start: State
    values: State
    phase: PhaseModel
    names: dict[str, float]

    @property
    def is_needed(self) -> bool:
        """True if the passing of time alone does not determine the motion."""
        return self._is_singular() or self._rests()

    @property
    def t0(self) -> float:
        return float(self.start.get(self.equations.symbols.t, 0.0))

    @property
    def _x0(self) -> np.ndarray:
        return np.array([self.start[node] for node in self.equations.symbols.x])

    def _functions(self, scalars: tuple[Scalar, ...]) -> Callable[[float, np.ndarray], np.ndarray]:
        """Scalars as functions of t and x."""
        function = RightHandSide.of(Program.of(scalars, self.equations.symbols), "numpy")
        return lambda t, x: function(t, x, self.phase.p)

    def _function(self, scalar: Scalar) -> Callable[[float, np.ndarray], float]:
        functions = self._functions((scalar,))
        return lambda t, x: float(functions(t, x)[0])

    def _rests(self) -> bool:
        """True if time does not lead away from the start: an equilibrium, or rates without a value."""
        with np.errstate(all="ignore"):
            x = self.phase.state(self.names)
            dx = self.phase.rate(self.t0, x)
            nq = len(self.equations.symbols.q)
            aside = x.copy()
            aside[:nq] += 0.05 * (1 + np.abs(aside[:nq]))
            usual = self.phase.rate(self.t0, aside)
        if not np.all(np.isfinite(dx)):
            return True
        if self._is_moved_by_time:
            return False
        size = float(np.max(np.abs(usual), initial=0.0)) if np.all(np.isfinite(usual)) else 1.0
        return float(np.max(np.abs(dx), initial=0.0)) <= tolerances.GAP_CLOSED * size

    @property
    def _is_moved_by_time(self) -> bool:
        """True if given motions, or forces that change with time, can end a rest."""
        symbols, coordinates = self.equations.symbols, self.equations.system.scope.model.coordinates
        moving = (symbols.t, *(q for q in symbols.q if coordinates[q.name].driven))
        return any(depends_on(x, moving) for x in (*self.accelerations, *self.equations.system.scope.nu))

    def _is_singular(self) -> bool:
        """True if the constraints do not determine the way in which the start is left."""
        if not any(not row.identical and row.gap is not None for row in self.equations.system.constraints.rows):
            return False
        way = self._way
        return way is not None and not way.is_regular(self._x0[: len(self.equations.symbols.q)])

    @cached_property
    def _relations(self) -> Relations | None:
        """Every speed by one of them, homogeneous; None where there are more degrees of freedom, or momenta that are
        not 0."""
        try:
            found = Relations.of(self.equations, self._exact_start)
        except DerivationError:  # a start without values
            return None
        if found is None or found.speed is None or not all(map(vanishes, found.constants.values())):
            return None
        return found

    @property
    def _exact_start(self) -> State:
        """The start in exact numbers where it has no closed form."""
        return self.exact or {node: Fraction(self.start[node]) for node in self.equations.symbols.x}

    @property
    def _leading(self) -> int:
        """The coordinate whose rate is the one free speed."""
        assert self._relations is not None
        return next(k for k, rate in enumerate(self.equations.system.scope.rates) if rate is self._relations.speed)

    @cached_property
    def _way(self) -> Configurations | None:
        """The configurations that one freedom leaves."""
        if self._relations is None:
            return None
        symbols, scope = self.equations.symbols, self.equations.system.scope
        shares = tuple(self._relations.shares.values())
        direction = self._functions(tuple(inner(row, shares) for row in scope.N))
        rows = tuple(position_equations(self.equations.system, self._exact_start))
        gaps = self._functions(rows)
        held = [k for k, q in enumerate(symbols.q) if any(depends_on(gap, (q,)) for gap in rows)]
        sought = tuple(k for k in held if k != self._leading)
        still = np.zeros(len(symbols.u))
        return Configurations(
            lambda q: direction(self.t0, np.append(q, still)),
            lambda q: gaps(self.t0, np.append(q, still)),
            self._leading,
            sought,
        )

    def first(self, sought: Scalar) -> State:
        """The state where the condition holds on the way that one freedom leaves; the time is not known.

        Raises:
            RunFailed: more than one freedom rests, or the condition is not met on the way.
        """
        lost = self.phase.valueless(self.t0, self.phase.state(self.names))
        if lost is not None:
            raise RunFailed(f"the motion starts where {lost.what}", lost.where, "start elsewhere")
        way, relations = self._way, self._relations
        if way is None or relations is None or relations.speed is None:
            raise RunFailed("the motion rests at the start", fix=FIX)
        symbols, speed = self.equations.symbols, relations.speed
        square = self._function(self._square(speed))
        condition = self._function(substituted((sought,), relations.speeds)[0])
        shares = self._functions(tuple(relations.shares.values()))
        still = np.zeros(len(symbols.u))

        def y(q: np.ndarray) -> float:
            return square(self.t0, np.append(q, still))

        def state(q: np.ndarray, sense: int) -> np.ndarray:
            """(q, u) with the one free speed in u."""
            rate = sense * math.sqrt(max(y(q), 0.0))
            return np.append(q, [rate if u is speed else 0.0 for u in symbols.u])

        arrival, sense = way.first(
            lambda q, sense: condition(self.t0, state(q, sense)),
            y,
            self._x0[: len(symbols.q)],
            self._senses(speed),
            self._near(),
        )
        at = state(arrival.x, sense)
        speeds = shares(self.t0, at) * at[len(symbols.q) + symbols.u.index(speed)]
        names = symbols.x
        return {symbols.t: math.nan} | dict(zip(names, map(float, (*arrival.x, *speeds)), strict=True))

    def _square(self, speed: Node) -> Scalar:
        """u_s^2 as a function of the coordinates.

        Raises:
            RunFailed: no integrals give it.
        """
        found = rates_and_extent(self.equations, self._exact_start, accelerations=self.accelerations)
        if found is None or not found[1].everywhere:
            raise RunFailed("the motion rests at the start, and no integrals give its speeds elsewhere", fix=FIX)
        return found[0][speed] * found[0][speed]

    def _senses(self, speed: Node) -> tuple[int, ...]:
        u = self.start[speed]
        return (1, -1) if u == 0 else (1,) if u > 0 else (-1,)

    def _near(self) -> np.ndarray:
        """The guesses of the coordinates: `near` where it is given, else the start."""
        scope, found = self.equations.system.scope, []
        for q in scope.symbols.q:
            near = scope.model.coordinates[q.name].near
            guess = None if near is None else evaluate((scope.value(near),), self.values, FLOAT)[0]
            found.append(self.start[q] if guess is None else float(guess))
        return np.array(found)


# -------- configurations --------------------------------------------------------------------------------------
# Along the configurations of one freedom, without time: where a motion goes from a rest or a dead centre.
#
# dq/ds = d(q),   u_s^2 = y(q) >= 0 where the motion may be


STEP = 1e-3  # from a singular start, of the leading coordinate
AROUND = 12.0  # steps: how far other coordinates may move in this one
GUESSES = 60
SEARCH = Stepping(rtol=tolerances.FINE_RUN, atol=tolerances.FINE_RUN, most_steps=4000)
REACHES = (1.0, 10.0, 100.0)  # how far the leading coordinate is followed, in sizes of its start and 1
NEARER = 1 - tolerances.COMPUTED  # what the second sense must undercut: of two mirror images the first one is taken
ASIDE = 0.1

VectorFunction = Callable[[np.ndarray], np.ndarray]
NumberFunction = Callable[[np.ndarray], float]
SensedCondition = Callable[[np.ndarray, int], float]
"""(q, sense of motion) -> a number."""


@dataclass(frozen=True)
class Arrival:
    """Place where a condition holds: the way to it, of the leading coordinate, and the state there."""

    s: float
    x: np.ndarray


class NeverReached(RunFailed):
    """The condition stays away from 0 as far as the way was followed."""


@dataclass(frozen=True)
class Configurations:
    """The configurations that one freedom leaves, as numbers.

    Args:
        direction: d(q) = dq/ds.
        gaps: the functions that vanish.
        leading: index of the coordinate whose rate is u_s.
        sought: indices of those that the gaps fix.
    """

    direction: VectorFunction
    gaps: VectorFunction
    leading: int
    sought: tuple[int, ...]

    def first(
        self, g: SensedCondition, y: NumberFunction, q: np.ndarray, senses: Sequence[int], near: np.ndarray
    ) -> tuple[Arrival, int]:
        """(the nearest configuration with g(q, sense) = 0, the sense of motion).

        Args:
            g: the condition, which may hold speeds, and so the sense.
            y: u_s^2; the motion does not go where it is negative.
            q: the start.
            senses: in which the motion may leave it.
            near: guesses of the coordinates, which choose the branch where several leave the start.
        Raises:
            NeverReached: in no sense.
        """
        reasons: list[NeverReached] = []
        for reach in REACHES:
            found: list[tuple[float, Arrival, int]] = []
            for sense in senses:
                within = min([reach * (1 + abs(q[self.leading])), *(NEARER * distance for distance, *_ in found)])
                try:
                    arrival = self._one_way(g, y, q, sense, near, within)
                    found.append((abs(arrival.s), arrival, sense))
                except NeverReached as reason:
                    reasons.append(reason)
            if found:
                _, arrival, sense = min(found, key=lambda each: each[0])
                return arrival, sense
        raise reasons[-1]

    def _one_way(
        self, g: SensedCondition, y: NumberFunction, q: np.ndarray, sense: int, near: np.ndarray, within: float
    ) -> Arrival:
        regular = self.is_regular(q)
        s = 0.0
        if not regular:
            s = sense * STEP
            q = self._beside(q, s, near)
        if y(q + (0 if not regular else tolerances.WIDE_STEP * sense * self.direction(q))) < 0:
            raise NeverReached("the motion does not go this way from the start")
        sensed = _Sensed(self, g, y, sense)
        return sensed.arrival(march(sensed.rate, (abs(s), within), q, how=SEARCH, events=sensed.events))

    def is_regular(self, q: np.ndarray) -> bool:
        """True if the gaps fix the rates of the sought coordinates; False at a branch point, rounded or not."""
        with np.errstate(all="ignore"):
            if not np.all(np.isfinite(self.direction(q))):
                return False
        if not self.sought:
            return True
        aside = q.copy()
        aside[list(self.sought)] += ASIDE
        usual = np.linalg.norm(self._slopes(aside))
        return bool(
            np.min(np.linalg.svd(self._slopes(q), compute_uv=False), initial=usual) > tolerances.RANK_NEARBY * usual
        )

    def _slopes(self, q: np.ndarray) -> np.ndarray:
        """d gaps / d sought coordinates, by central differences."""
        columns = []
        for k in self.sought:
            h = np.zeros(len(q))
            h[k] = tolerances.DIFFERENCE_STEP * (1 + abs(q[k]))
            columns.append((self.gaps(q + h) - self.gaps(q - h)) / (2 * h[k]))
        return np.array(columns).T

    def _beside(self, start: np.ndarray, step: float, near: np.ndarray) -> np.ndarray:
        """The configuration a small step from a singular start: on the branch that is nearest to the guesses.

        Raises:
            NeverReached: there is none.
        """
        rng = np.random.default_rng(1)
        sought = list(self.sought)

        def guess() -> np.ndarray:
            q = start.copy()
            q[self.leading] += step
            q[sought] += abs(step) * rng.uniform(-AROUND / 2, AROUND / 2, len(sought))
            return q

        def beside(q: np.ndarray) -> np.ndarray | None:
            closed = self._closed(q)
            return None if closed is None or not np.max(np.abs(closed - start)) < AROUND * abs(step) else closed

        guesses = (guess() for _ in range(GUESSES))
        found = all_roots(beside, guesses, lambda q: (round(float(np.linalg.norm((q - near)[sought])), 9), *q))
        if not found:
            raise NeverReached("no configuration leads away from the start")
        return found[0]

    def _closed(self, q: np.ndarray) -> np.ndarray | None:
        """The nearest configuration with all gaps 0, moved by the sought coordinates."""
        sought = list(self.sought)

        def gaps(x: np.ndarray) -> np.ndarray:
            moved = q.copy()
            moved[sought] = x
            return self.gaps(moved)

        found = least_left(gaps, q[sought])
        if found.left > tolerances.GAP_CLOSED:
            return None
        closed = q.copy()
        closed[sought] = found.x
        return closed


@dataclass(frozen=True)
class _Sensed:
    """The way in one sense, s growing: the condition, and the range in which u_s^2 > 0.

    Args:
        along: the configurations.
        g, y: as of `Configurations.first`.
    """

    along: Configurations
    g: SensedCondition
    y: NumberFunction
    sense: int

    def rate(self, s: float, q: np.ndarray) -> np.ndarray:
        return self.sense * self.along.direction(q)

    @property
    def events(self) -> Events:
        """The condition, from either side; u_s^2, which may not fall below 0."""

        def values(s: np.ndarray, q: np.ndarray) -> np.ndarray:
            return np.array([(self.g(each, self.sense), self.y(each)) for each in q])

        return Events(values, np.array([tolerances.COMPUTED, tolerances.SUMMED]), (0,))

    def arrival(self, run: Run) -> Arrival:
        """Place where the condition holds; it may do so just where the motion turns back.

        Raises:
            NeverReached: the way ends before.
        """
        if run.crossing is None:
            raise NeverReached(f"the condition is not met as far as the motion was followed, up to {run.end:.6g}")
        if run.crossing.index == 1 and abs(self.g(run.last, self.sense)) > tolerances.CARRIED * self._largest(run):
            raise NeverReached(f"the motion turns back before, at {run.end:.6g}")
        return Arrival(self.sense * run.end, run.last)

    def _largest(self, run: Run) -> float:
        return max(abs(self.g(q, self.sense)) for q in run.x)
