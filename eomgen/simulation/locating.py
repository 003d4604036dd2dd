"""System, condition, start -> the state at which the condition first holds after the start, in numbers.

By integration in time, across singular positions of the ties; from an unstable rest or a dead centre, where time does
not lead away or has no say which way, along the configurations by the energy theorem.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from fractions import Fraction
from functools import cached_property
from typing import Any

import numpy as np

from eomgen.codegen.program import program_of, right_hand_side
from eomgen.codegen.rhs import RightHandSide, compiled
from eomgen.errors import DerivationError, RunFailed
from eomgen.mechanics.constraints.elimination import singular_blocks
from eomgen.mechanics.equations.articulated import with_accelerations
from eomgen.mechanics.equations.assembly import Assembly
from eomgen.mechanics.equations.system import System
from eomgen.mechanics.first_integrals.closed_instant import position_equations
from eomgen.mechanics.first_integrals.speeds import rates_of
from eomgen.mechanics.first_integrals.speeds_from_momenta import Relations, relations_of
from eomgen.simulation.arrival import Arrival, first_arrival
from eomgen.simulation.configurations import Configurations
from eomgen.simulation.constraint_rank import PLACE
from eomgen.simulation.measures import nearness_of
from eomgen.simulation.projection import projection_of
from eomgen.simulation.ways import Way
from eomgen.symbolic.expression.derivative import depends_on, substituted
from eomgen.symbolic.expression.functions import inner
from eomgen.symbolic.expression.graph import Node, Scalar
from eomgen.symbolic.expression.node import State
from eomgen.symbolic.numeric.evaluation import FLOAT, evaluate
from eomgen.symbolic.numeric.tolerances import DEGENERATE, GAP_CLOSED, SOLVED
from eomgen.symbolic.solve.solving import roots, vanishes

MEND = "give it a speed"


@dataclass(frozen=True)
class Locating:
    """A motion in numbers, and what is sought on it.

    Args:
        system, assembly, accelerations: the equations of motion.
        condition: of q, u, t and parameters; it vanishes at the instant.
        exact: q and u at the start as scalars of the parameters, {} where they have no closed form.
        start: t, q and u at the start.
        values: of the parameters.
        given_rhs: the right-hand side; None: made here.
    """

    system: System
    assembly: Assembly
    accelerations: tuple[Scalar, ...]
    condition: Scalar
    exact: State
    start: State
    values: State
    given_rhs: RightHandSide | None = None

    def located(self) -> tuple[State, str]:
        """(t, q and u at the instant, how they were found); t is nan where it is not known.

        Raises:
            RunFailed: the condition is not met.
        """
        if not depends_on(self.condition, self._names):
            return self._at_time(), "integration in time"
        if self._is_singular() or self._rests():
            return self._along_configurations(), "energy theorem"
        arrival = self._first()
        self._refuse_undetermined(arrival)
        return self._state(arrival.s, arrival.x), "integration in time"

    @property
    def t0(self) -> float:
        return self.start.get(self.system.symbols.t, 0.0)

    @property
    def _names(self) -> tuple[Node, ...]:
        return (*self.system.symbols.q, *self.system.symbols.u)

    @property
    def _x0(self) -> np.ndarray:
        return np.array([self.start[node] for node in self._names])

    def _state(self, t: float, x: np.ndarray) -> State:
        return {self.system.symbols.t: float(t), **dict(zip(self._names, map(float, x), strict=True))}

    @cached_property
    def _p(self) -> np.ndarray:
        return np.array([self.values[node] for node in self.system.symbols.parameters.values()])

    @cached_property
    def _rhs(self) -> RightHandSide:
        system = self.system
        return self.given_rhs or compiled(right_hand_side(with_accelerations(system, self.assembly), system.inputs))

    def _motion(self, t: float, x: np.ndarray) -> np.ndarray:
        return self._rhs(t, x, self._p)

    def _functions(self, scalars: tuple[Scalar, ...]) -> Callable[[float, np.ndarray], np.ndarray]:
        """Scalars as functions of t and x."""
        function = compiled(program_of(scalars, self.system.symbols), "numpy")
        return lambda t, x: function(t, x, self._p)

    def _function(self, scalar: Scalar) -> Callable[[float, np.ndarray], float]:
        functions = self._functions((scalar,))
        return lambda t, x: float(functions(t, x)[0])

    def _at_time(self) -> State:
        """The state at a time that is given by itself.

        Raises:
            RunFailed: the motion does not go on until then.
        """
        end = self._given_time()
        if end <= self.t0:
            return self._state(end, self._x0)
        run, _ = self._way_in_time.until(end)
        if run.status != "finished" or not np.all(np.isfinite(run.last)):
            raise RunFailed(f"the motion ends before the instant: {run.message[0].lower()}{run.message[1:]}")
        return self._state(end, run.last)

    @property
    def _way_in_time(self) -> Way:
        return Way(
            self._motion,
            self.t0,
            self._x0,
            self._rhs.spheres,
            lambda: nearness_of(self.system, self.assembly, self._p),
            lambda: projection_of(self.system, self._p, "numpy"),
        )

    def _first(self) -> Arrival:
        """Where the condition first holds; by itself where the motion comes by no singular position before.

        Raises:
            NeverReached: it is not met.
        """
        way = self._way_in_time
        if way.nearness() is not None:
            condition = compiled(program_of((self.condition,), self.system.symbols), "numpy")
            arrival, passed = way.first(lambda t, x: condition.many(t, x, self._p))
            if passed:
                return arrival
        return first_arrival(self._motion, self._function(self.condition), self.t0, self._x0)

    def _refuse_undetermined(self, arrival: Arrival) -> None:
        """Refuse an instant at which the rates of dependent coordinates are 0/0.

        Raises:
            RunFailed: they are named.
        """
        blocks = singular_blocks(self.system.elimination, self.system.scope)
        for block in blocks:
            determinant = self._function(block.determinant)
            if abs(determinant(arrival.s, arrival.x)) < DEGENERATE * abs(determinant(self.t0, self._x0)):
                raise RunFailed(
                    f"{block} at that instant ({PLACE})",
                    mend="leave out `dependent`: then their rates belong to the state",
                )

    def _given_time(self) -> float:
        """The first t, from the start on, at which a condition on t alone holds."""
        t = self.system.symbols.t
        values = [float(evaluate((root,), self.values, FLOAT)[0]) for root in roots(self.condition, t)]
        later = [value for value in values if value >= self.t0 - SOLVED]
        if later:
            return min(later)
        if values:
            raise DerivationError(f"the instant t = {max(values):g} s is before the start")
        condition = self._function(self.condition)
        return first_arrival(lambda s, x: np.ones(1), lambda s, x: condition(s, self._x0), self.t0, [0.0]).s

    # -- from rest, from a dead centre ---------------------------------------------------------------

    def _rests(self) -> bool:
        """Whether time does not lead away from the start: an equilibrium, or rates without a value."""
        with np.errstate(all="ignore"):
            dx = self._motion(self.t0, self._x0)
            nq = len(self.system.symbols.q)
            aside = self._x0.copy()
            aside[:nq] += 0.05 * (1 + np.abs(aside[:nq]))
            usual = self._motion(self.t0, aside)
        if not np.all(np.isfinite(dx)):
            return True
        if self._is_moved_by_time:
            return False
        size = float(np.max(np.abs(usual), initial=0.0)) if np.all(np.isfinite(usual)) else 1.0
        return float(np.max(np.abs(dx), initial=0.0)) <= GAP_CLOSED * size

    @property
    def _is_moved_by_time(self) -> bool:
        """Whether given motions, or forces that change with time, can end a rest."""
        symbols, coordinates = self.system.symbols, self.system.scope.model.coordinates
        moving = (symbols.t, *(q for q in symbols.q if coordinates[q.name].driven))
        return any(depends_on(x, moving) for x in (*self.accelerations, *self.system.scope.nu))

    def _is_singular(self) -> bool:
        """Whether the ties do not determine which way the start is left."""
        if not any(not row.identical and row.gap is not None for row in self.system.ties.rows):
            return False
        way = self._way
        return way is not None and not way.is_regular(self._x0[: len(self.system.symbols.q)])

    @cached_property
    def _relations(self) -> Relations | None:
        """Every speed by one of them, homogeneous; None where there are more freedoms, or momenta that are not 0."""
        try:
            found = relations_of(self.system, self.assembly, self._exact_start)
        except DerivationError:  # a start without values
            return None
        if found is None or found.speed is None or not all(map(vanishes, found.constants.values())):
            return None
        return found

    @property
    def _exact_start(self) -> State:
        """The start in exact numbers where it has no closed form."""
        return self.exact or {node: Fraction(self.start[node]) for node in self._names}

    @property
    def _leading(self) -> int:
        """The coordinate whose rate is the one free speed."""
        assert self._relations is not None
        return next(k for k, rate in enumerate(self.system.scope.rates) if rate is self._relations.speed)

    @cached_property
    def _way(self) -> Configurations | None:
        """The configurations that one freedom leaves."""
        if self._relations is None:
            return None
        symbols, scope = self.system.symbols, self.system.scope
        shares = tuple(self._relations.shares.values())
        direction = self._functions(tuple(inner(row, shares) for row in scope.N))
        rows = tuple(position_equations(self.system, self._exact_start))
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

    def _along_configurations(self) -> State:
        """The state where the condition holds on the way that one freedom leaves; the time is not known.

        Raises:
            RunFailed: more than one freedom rests, or the condition is not met on the way.
        """
        way, relations = self._way, self._relations
        if way is None or relations is None or relations.speed is None:
            raise RunFailed("the motion rests at the start", mend=MEND)
        symbols, speed = self.system.symbols, relations.speed
        square = self._function(self._square(speed))
        condition = self._function(substituted((self.condition,), relations.speeds)[0])
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
        return self._state(math.nan, np.append(arrival.x, speeds))

    def _square(self, speed: Node) -> Scalar:
        """u_s^2 as a function of the coordinates.

        Raises:
            RunFailed: no integrals give it.
        """
        found = rates_of(self.system, self.assembly, self._exact_start, accelerations=self.accelerations)
        if found is None:
            raise RunFailed("the motion rests at the start, and no integrals give its speeds elsewhere", mend=MEND)
        return found[speed] * found[speed]

    def _senses(self, speed: Node) -> tuple[int, ...]:
        u = self.start[speed]
        return (1, -1) if u == 0 else (1,) if u > 0 else (-1,)

    def _near(self) -> np.ndarray:
        """The guesses of the coordinates: `near` where it is given, else the start."""
        scope, found = self.system.scope, []
        for q in scope.symbols.q:
            near = scope.model.coordinates[q.name].near
            guess = None if near is None else evaluate((scope.value(near),), self.values, FLOAT)[0]
            found.append(self.start[q] if guess is None else float(guess))
        return np.array(found)


def values_of(parameters: Mapping[str, Node], known: Mapping[str, Any]) -> State:
    """The parameters that have values, by node."""
    return {node: float(known[name]) for name, node in parameters.items() if name in known}
