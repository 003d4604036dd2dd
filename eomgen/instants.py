"""System, condition, start -> Instant: the first time after the start at which the condition holds.

It is located in numbers: by integration in time, or, where the motion starts from an unstable rest or a dead centre,
along the configurations by the energy theorem. Then it is sought in closed form, and taken where both agree.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from fractions import Fraction
from functools import cached_property
from random import Random

import numpy as np

from eomgen.codegen.program import right_hand_side
from eomgen.codegen.rhs import RightHandSide, compiled
from eomgen.errors import DerivationError, EomgenError, RunFailed
from eomgen.mechanics.articulated import with_accelerations
from eomgen.mechanics.assembly import Assembly
from eomgen.mechanics.closed_instant import ClosedInstant, position_equations
from eomgen.mechanics.integrals import rates_of, relations_of
from eomgen.mechanics.places import Located
from eomgen.mechanics.positive import positive_parameters
from eomgen.mechanics.system import System
from eomgen.mechanics.ties import holds_identically
from eomgen.model.values import exact_parameters
from eomgen.simulation.arrival import first_arrival
from eomgen.simulation.configurations import Configurations
from eomgen.symbolic.derivative import depends_on, substituted
from eomgen.symbolic.evaluation import FLOAT, evaluate
from eomgen.symbolic.graph import Node, Scalar
from eomgen.symbolic.solving import roots

TRIALS = 6  # sets of values for parameters that have none
RESTING = 1e-11  # of a speed or acceleration against those of a configuration nearby

State = dict[Node, Scalar]
Numbers = dict[Node, float]


@dataclass(frozen=True)
class Instant:
    """The state at an instant.

    Args:
        exact: t, q and u as scalars of the parameters, those that are known in closed form.
        numbers: t, q and u as numbers; t is nan where it takes for ever to leave the start; {} without values of all
            parameters.
        method: how it was found.
    """

    exact: State = field(default_factory=dict)
    numbers: Numbers = field(default_factory=dict)
    method: str = "integration in time"


def reached(
    system: System,
    assembly: Assembly,
    accelerations: Sequence[Scalar],
    condition: Scalar,
    start_exact: Mapping[Node, Scalar],
    start_numbers: Mapping[Node, float],
    rhs: RightHandSide | None = None,
) -> Instant:
    """The first instant after the start at which the condition is 0; one at the start itself is none.

    Args:
        accelerations: a as expressions of q, u and t.
        condition: of q, u, t and parameters.
        start_exact: q and u (t: 0) at the start as scalars of the parameters; {} where they have no closed form.
        start_numbers: the same as numbers; {} where parameters have no values.
        rhs: the right-hand side of the equations of motion.
    Raises:
        RunFailed: the condition is never met.
    """
    own = {node: system.inputs[name] for name, node in assembly.symbols.inputs.items()}
    accelerations = substituted(tuple(accelerations), own)
    (condition,) = substituted((condition,), own)
    search = _Search(system, assembly, accelerations, condition, dict(start_exact))
    if start_numbers:
        return search.at(dict(start_numbers), _values(system), rhs)
    return search.with_trial_values()


def _values(system: System) -> Numbers:
    """The parameters that have values."""
    known = exact_parameters(system.scope.model)
    return {node: float(known[name]) for name, node in system.symbols.parameters.items() if name in known}


@dataclass(frozen=True)
class _Search:
    """An instant that is sought.

    Args:
        system, assembly, accelerations: the equations of motion, inputs replaced by the model's own.
        condition: what is to vanish.
        start: exact.
    """

    system: System
    assembly: Assembly
    accelerations: tuple[Scalar, ...]
    condition: Scalar
    start: State

    def at(self, numbers: Numbers, values: Numbers, rhs: RightHandSide | None) -> Instant:
        """The instant with the parameters' values."""
        run = _Numeric(self, numbers, values, rhs)
        found, method = run.located()
        exact, way = self._exact(found, values)
        return Instant(exact, found, way or method)

    def with_trial_values(self) -> Instant:
        """The instant in closed form alone: branches are chosen at values that the parameters might have.

        Raises:
            RunFailed: at no trial is the condition met.
        """
        rng, reason = Random(1), None
        for _ in range(TRIALS):
            values = {node: rng.uniform(0.7, 1.3) for node in self.system.symbols.parameters.values()}
            values |= _values(self.system)
            try:
                numbers = dict(zip(self.start, evaluate(tuple(self.start.values()), values, FLOAT), strict=True))
                found = self.at({self.system.symbols.t: 0.0, **numbers}, values, None)
            except EomgenError as error:
                reason = reason or error
                continue
            return replace(found, numbers={})
        raise reason or RunFailed("the instant is not reached")

    def _exact(self, numbers: Numbers, values: Numbers) -> tuple[State, str]:
        """(t, q and u in closed form, by which way); the way is "" where nothing was found."""
        symbols = self.system.symbols
        if not all(x in self.start for x in (*symbols.q, *symbols.u)):
            return {}, ""
        positive = positive_parameters(self.system.scope) | {q for q in symbols.q if numbers.get(q, 0) > 0}
        located = Located({**values, **numbers}, positive)
        closed = ClosedInstant(self.system, self.assembly, self.accelerations, self.condition, self.start, located)
        needed = {*symbols.q, *symbols.u}
        by_time = closed.by_laws()
        if needed <= by_time.keys():
            return by_time, "law of motion"
        if not depends_on(self.condition, needed):
            return by_time, "law of motion" if by_time.keys() & needed else ""
        by_energy = closed.by_integrals()
        way = "energy theorem" if by_energy.keys() & set(symbols.u) else "law of motion" if by_time else ""
        return {**by_energy, **by_time}, way or ("closed form" if by_energy else "")


@dataclass(frozen=True)
class _Numeric:
    """The motion of a search in numbers."""

    search: _Search
    start: Numbers
    values: Numbers
    given_rhs: RightHandSide | None

    @property
    def _names(self) -> tuple[Node, ...]:
        symbols = self.search.system.symbols
        return (*symbols.q, *symbols.u)

    @cached_property
    def rhs(self) -> RightHandSide:
        system, assembly = self.search.system, self.search.assembly
        return self.given_rhs or compiled(right_hand_side(with_accelerations(system, assembly), system.inputs))

    @cached_property
    def p(self) -> np.ndarray:
        return np.array([self.values[node] for node in self.search.system.symbols.parameters.values()])

    @property
    def x0(self) -> np.ndarray:
        return np.array([self.start[node] for node in self._names])

    @property
    def t0(self) -> float:
        return self.start.get(self.search.system.symbols.t, 0.0)

    def located(self) -> tuple[Numbers, str]:
        """(t, q and u at the instant, how they were found)."""
        t = self.search.system.symbols.t
        if not depends_on(self.search.condition, self._names):
            return self._at_time(), "integration in time"
        if self._rests():
            return self._along_configurations(), "energy theorem"
        arrival = first_arrival(self._motion, self._condition, self.t0, self.x0)
        return {t: arrival.s, **dict(zip(self._names, map(float, arrival.x), strict=True))}, "integration in time"

    def _motion(self, t: float, x: np.ndarray) -> np.ndarray:
        return self.rhs(t, x, self.p)

    def _condition(self, t: float, x: np.ndarray) -> float:
        return self._value(self.search.condition, t, x)

    def _value(self, scalar: Scalar, t: float, x: np.ndarray) -> float:
        state = {**self.values, self.search.system.symbols.t: t, **dict(zip(self._names, map(float, x), strict=True))}
        return float(evaluate((scalar,), state, FLOAT)[0])

    def _at_time(self) -> Numbers:
        """The state at a time that is given by itself."""
        from scipy.integrate import solve_ivp

        t = self.search.system.symbols.t
        values = [float(evaluate((root,), self.values, FLOAT)[0]) for root in roots(self.search.condition, t)]
        later = [value for value in values if value >= self.t0 - 1e-12]
        if values and not later:
            raise DerivationError(f"the instant t = {max(values):g} s is before the start")
        if later:
            end = min(later)
        else:
            end = first_arrival(lambda s, x: np.ones(1), lambda s, x: self._condition(s, self.x0), self.t0, [0.0]).s
        if end <= self.t0:
            return {t: end, **dict(zip(self._names, map(float, self.x0), strict=True))}
        run = solve_ivp(self._motion, (self.t0, end), self.x0, method="DOP853", rtol=1e-12, atol=1e-12)
        if not run.success or not np.all(np.isfinite(run.y[:, -1])):
            raise RunFailed(f"the motion ends at t = {run.t[-1]:.6g} s, before the instant")
        return {t: end, **dict(zip(self._names, map(float, run.y[:, -1]), strict=True))}

    # -- from rest -----------------------------------------------------------------------------

    def _rests(self) -> bool:
        """Whether time does not lead away from the start: an equilibrium, or accelerations without a value."""
        dx = self._motion(self.t0, self.x0)
        if not np.all(np.isfinite(dx)):
            return True
        nq = len(self.search.system.symbols.q)
        aside = self.x0 + np.concatenate([0.05 * (1 + np.abs(self.x0[:nq])), np.zeros(len(self.x0) - nq)])
        with np.errstate(all="ignore"):
            usual = self._motion(self.t0, aside)
        size = float(np.max(np.abs(usual), initial=0.0)) if np.all(np.isfinite(usual)) else 1.0
        if float(np.max(np.abs(dx), initial=0.0)) > max(RESTING * size, 1e-300):
            return False
        return True

    def _along_configurations(self) -> Numbers:
        """The state where the condition holds on the way that one freedom leaves; the time is not known.

        Raises:
            RunFailed: more than one freedom rests, or the condition is not met on the way.
        """
        system, symbols = self.search.system, self.search.system.symbols
        relations = relations_of(system, self.search.assembly, self._exact_start)
        if relations is None or relations.speed is None or not all(map(holds_identically, relations.constants.values())):
            raise RunFailed("the motion rests at the start", mend="give it a speed")
        speed, shares = relations.speed, tuple(relations.shares.values())
        direction = tuple(sum((n * s for n, s in zip(row, shares, strict=True)), start=0) for row in system.scope.N)
        (condition,) = substituted((self.search.condition,), relations.speeds)
        square, gaps = self._square(speed), tuple(position_equations(system, self._exact_start))
        leading = next(k for k, rate in enumerate(system.scope.rates) if rate is speed)

        def u(q: np.ndarray, sense: int) -> float:
            return sense * math.sqrt(max(float(self._of((square,), q)[0]), 0.0))

        way = Configurations(
            lambda q: self._of(direction, q), lambda q: self._of(gaps, q), leading, self._sought(gaps, leading)
        )
        arrival, sense = way.first(
            lambda q, sense: float(self._of((condition,), q, {speed: u(q, sense)})[0]),
            lambda q: float(self._of((square,), q)[0]),
            self.x0[: len(symbols.q)], self._senses(speed), self._near(),
        )  # fmt: skip
        speeds = self._of(shares, arrival.x) * u(arrival.x, sense)
        return {symbols.t: math.nan, **dict(zip(self._names, map(float, (*arrival.x, *speeds)), strict=True))}

    @property
    def _exact_start(self) -> State:
        """The start in exact numbers where it has no closed form."""
        return self.search.start or {node: Fraction(self.start[node]) for node in self._names}

    def _square(self, speed: Node) -> Scalar:
        """u_s^2 as a function of the coordinates.

        Raises:
            RunFailed: no integrals give it.
        """
        search = self.search
        found = rates_of(search.system, search.assembly, self._exact_start, accelerations=search.accelerations)
        if found is None:
            raise RunFailed("the motion rests at the start, and no integrals give its speeds elsewhere",
                            mend="give it a speed")  # fmt: skip
        return found[speed] * found[speed]

    def _of(self, scalars: tuple[Scalar, ...], q: np.ndarray, also: Mapping[Node, float] | None = None) -> np.ndarray:
        """Functions of the coordinates."""
        symbols = self.search.system.symbols
        state = {**self.values, symbols.t: self.t0, **dict(zip(symbols.q, map(float, q), strict=True)), **(also or {})}
        return np.array(evaluate(scalars, state, FLOAT), dtype=float)

    def _senses(self, speed: Node) -> tuple[int, ...]:
        u = self.start[speed]
        return (1, -1) if u == 0 else (1,) if u > 0 else (-1,)

    def _sought(self, gaps: tuple[Scalar, ...], leading: int) -> tuple[int, ...]:
        symbols = self.search.system.symbols
        return tuple(k for k, q in enumerate(symbols.q) if k != leading and any(depends_on(g, (q,)) for g in gaps))

    def _near(self) -> np.ndarray:
        """The guesses of the coordinates: `near` where it is given, else the start."""
        system = self.search.system
        found = []
        for q in system.symbols.q:
            near = system.scope.model.coordinates[q.name].near
            found.append(self.start[q] if near is None
                         else float(evaluate((system.scope.value(near),), self.values, FLOAT)[0]))  # fmt: skip
        return np.array(found)

