"""Model, configuration of its contacts -> PhaseModel: the equations of one phase, as functions of arrays.

Model, configuration of its contacts -> PhaseModel: the equations of one phase, as functions of numbers.
"""

from __future__ import annotations

from collections.abc import Callable, Container, Hashable, Mapping
from dataclasses import field, replace
from functools import cached_property
from typing import Any

import numpy as np

from eomgen.codegen import Program, RightHandSide, Solve
from eomgen.errors import UsageError
from eomgen.frozen import dataclass
from eomgen.mechanics.dynamics import (
    EquationsOfMotion,
    System,
    Valueless,
    WellPosed,
)
from eomgen.mechanics.free_bodies import Reactions, SystemFriction, equations_of_motion
from eomgen.mechanics.kinematics import Motion, SystemScene
from eomgen.mechanics.start import Start
from eomgen.model import Contact, Edge, Model
from eomgen.simulation.constraint_drift import (
    EnergyLevel,
    Nearness,
    Projection,
    Undetermined,
    nearness_of,
    projection_of,
    undetermined_of,
)
from eomgen.simulation.contacts import Configuration, ContactEvents, ContactSignals, EventFunction, PhaseFunctions
from eomgen.simulation.solvers import StateRate
from eomgen.symbolic.expression import Node, depends_on, jacobian
from eomgen.symbolic.numeric import FLOAT, evaluate, tolerances

Fed = Callable[[np.ndarray, float, np.ndarray], np.ndarray]
"""(p, t, x) -> p at a state"""
Values = Mapping[str, float]
"""Coordinates and rates by name, those of every phase alike: {"theta": 0.1, "theta'": 0}."""


@dataclass(frozen=True)
class PhaseModel:
    """The model of one phase. Its state is x = (q, u, z), and after these the slack of each string that hangs loose.

    Args:
        watch: its system, with the signals of its contacts.
        declared: the system over the speeds that the model declares; the state may hold more (see `integrated_system`).
        equations: the equations of motion, friction included.
        p: the parameters' values.
        target: of the emitted code.
        known: objects made of its equations, which hold for all values of the parameters.
        fed: Python function that gives the parameters at every state; None: they are constant.
    """

    watch: ContactEvents
    declared: System
    equations: EquationsOfMotion
    p: np.ndarray
    target: str | None
    known: dict[Hashable, Any] = field(default_factory=dict, repr=False, compare=False)
    fed: Fed | None = None

    @staticmethod
    def slack_name(constraint: str) -> str:
        """Name of the integrated slack of a string among the values of a state."""
        return f"{constraint} slack"

    @property
    def system(self) -> System:
        return self.watch.system

    @cached_property
    def functions(self) -> PhaseFunctions:
        return PhaseFunctions(self.equations, self.p, self.target)

    @property
    def interpreted(self) -> PhaseModel:
        """The same by Python alone, which needs no compiler: for few steps."""
        return replace(self, target="numpy", known={})

    def at(self, p: np.ndarray, fed: Fed | None = None) -> PhaseModel:
        """The same at other values of the parameters."""
        found = replace(self, p=p, fed=fed)
        vars(found)["functions"] = self.functions.at(p)
        return found

    @cached_property
    def signals(self) -> ContactSignals:
        return ContactSignals(self.watch, self.functions)

    @property
    def configuration(self) -> Configuration:
        return self.watch.configuration

    @property
    def changes(self) -> bool:
        """True if contacts change in the motion, or could."""
        return self.configuration != Configuration()

    @property
    def contacts(self) -> tuple[Contact, ...]:
        return self.watch.contacts

    @property
    def bounds(self) -> tuple[EventFunction, ...]:
        return self.watch.bounds

    @property
    def loose(self) -> tuple[str, ...]:
        return self.watch.loose

    @property
    def reactions(self) -> Reactions:
        return Reactions.of(self.system)

    @property
    def coordinates(self) -> tuple[str, ...]:
        return tuple(q.name for q in self.system.symbols.q)

    @property
    def speeds(self) -> tuple[str, ...]:
        return tuple(u.name for u in self.system.symbols.u)

    @property
    def states(self) -> tuple[str, ...]:
        """The states of first order."""
        return tuple(z.name for z in self.system.symbols.z)

    @property
    def moving(self) -> tuple[str, ...]:
        """Everything in x = (q, u, z) by name."""
        return tuple(x.name for x in self.system.symbols.x)

    @cached_property
    def rate(self) -> StateRate:
        """(t, x) -> x', the slack of loose strings included."""
        fed, rhs = self.fed, self.functions.rhs
        if fed is not None:
            return lambda t, x: rhs(t, x, fed(self.p, t, x))
        return self._rate_with_slacks if self.loose else rhs.at(self.p)

    def parameters_along(self, t: np.ndarray, x: np.ndarray) -> np.ndarray:
        """The parameters' values; of n states, n x parameters, where a Python function changes them."""
        if self.fed is None:
            return self.p
        rows = [self.fed(self.p, time, state) for time, state in zip(t.tolist(), x, strict=True)]
        return np.array(rows).reshape(len(t), len(self.p))

    def _rate_with_slacks(self, t: float, x: np.ndarray) -> np.ndarray:
        inner = self.functions.inner(x)
        slackening = self._slackening(t, inner, self.p)
        return np.concatenate([self.functions.rhs(t, inner, self.p), slackening])

    def valueless(self, t: float, x: np.ndarray) -> Valueless | None:
        """First quantity without a value in a state, or just after it; None where everything has one."""
        with np.errstate(all="ignore"):
            after = tolerances.COMPUTED * max(1.0, abs(t)) * np.nan_to_num(self.rate(t, x))
        found = (Valueless.in_state(self.system, self._values(t, here)) for here in (x, x + after))
        return next((each for each in found if each is not None), None) or self._jammed(t, x)

    def _jammed(self, t: float, x: np.ndarray) -> Valueless | None:
        """Friction that grows with itself, so that it has several values or none; None where it has one."""
        D = SystemFriction(self.system).feedback()
        if not D:
            return None
        entries = tuple(D[r][s] for r in D for s in D)
        rows = np.array(evaluate(entries, self._values(t, x), FLOAT)).reshape(len(D), len(D))
        radius = float(np.max(np.abs(np.linalg.eigvals(rows)))) if np.all(np.isfinite(rows)) else 0.0
        if radius < 1:
            return None
        rubbing = [contact for contact in self.contacts if contact.name in D]
        names = ", ".join(contact.words for contact in rubbing)
        what = f"the friction of {names} has no single value: it grows by {radius:.4g} of itself, not by less than 1"
        return Valueless(rubbing[0].declared_at, what)

    def overlarge(self, t: float, x: np.ndarray) -> Valueless | None:
        """First quantity that is too large in a state to be calculated with; None where nothing is."""
        return Valueless.overlarge(self.system, self._values(t, x))

    def _values(self, t: float, x: np.ndarray) -> dict[Node, float]:
        symbols = self.system.symbols
        state = zip(symbols.x, self.functions.inner(x).tolist(), strict=True)
        return {symbols.t: t, **dict(state), **dict(zip(symbols.parameters.values(), self.p.tolist(), strict=True))}

    @property
    def conservative(self) -> bool:
        return bool(self._known("conservative", lambda: WellPosed(self.equations).is_conservative))

    @property
    def declared_equations(self) -> EquationsOfMotion:
        """The equations of motion over the speeds that the model declares."""
        if self.declared is self.system:
            return self.equations
        found: EquationsOfMotion = self._known("declared equations", lambda: equations_of_motion(self.declared))
        return found

    @property
    def shown(self) -> tuple[str, ...]:
        """The speeds that a user sees."""
        return tuple(u.name for u in self.declared.symbols.u)

    def begun(
        self, t: float, parameters: Mapping[str, Any] | None, start: Values | None
    ) -> tuple[Start, dict[str, float]]:
        """(the start at which all constraints hold, coordinates, rates and speeds by name).

        Raises:
            DerivationError: the constraints do not hold at the start.
        """
        begun = Start.of(self.declared, parameters, start)
        return begun, self.with_rates(t, begun.values)

    def with_rates(self, t: float, values: Values) -> dict[str, float]:
        """Coordinates and declared speeds by name, with the rates of all coordinates."""
        x = self.state(values)
        found = self.functions.kinematic(self.declared.scope.rates).many(np.array([t]), x[None, :], self.p)[0]
        rates = {f"{q}'": float(rate) for q, rate in zip(self.coordinates, found, strict=True)}
        return rates | dict.fromkeys(map(self.slack_name, self.loose), 0.0) | dict(values)

    def state(self, values: Values) -> np.ndarray:
        """x of the phase; a displacement that did not exist before is 0."""
        names = (*self.moving, *map(self.slack_name, self.loose))
        return np.array([values.get(name, 0.0) for name in names])

    def columns(self, t: np.ndarray, x: np.ndarray) -> dict[str, np.ndarray]:
        """Coordinates, rates, speeds, states and slacks of n states, by name."""
        named = dict(zip(self.moving, x.T, strict=False))
        if any(f"{q}'" not in named for q in self.coordinates):
            rates = self.functions.kinematic(self.system.scope.rates).many(t, self.functions.inner(x), self.p)
            named |= {f"{q}'": column for q, column in zip(self.coordinates, rates.T, strict=True)}
        if not self.loose:
            return named
        return named | dict(zip(map(self.slack_name, self.loose), self.functions.slacks(x).T, strict=True))

    def values(self, t: float, x: np.ndarray) -> dict[str, float]:
        """Coordinates, rates, speeds and slacks of one state, by name."""
        return {name: float(column[0]) for name, column in self.columns(np.array([t]), x[None, :]).items()}

    def energies(self, t: np.ndarray, x: np.ndarray) -> np.ndarray:
        """(T, V), each n [J]."""
        return self.functions.energies.many(t, self.functions.inner(x), self.p).T

    def level(self, t: float, x: np.ndarray) -> EnergyLevel:
        """The energy of a state, to be held constant from there on.

        Raises:
            UsageError: energy need not stay.
        """
        if not self.conservative:
            what = f"energy is not conserved: {WellPosed(self.equations).why_not_conservative}"
            raise UsageError(what, fix='take stabilization "projection"')
        if self.states:
            what = "stabilization by the energy is not made for models with [states]"
            raise UsageError(what, fix='take stabilization "projection"')
        places, size = len(self.coordinates), len(self.coordinates) + len(self.speeds)
        energy = float(self.energies(np.array([t]), x[None, :]).sum())
        return EnergyLevel(self.functions.energies, self.p, places, size, energy)

    def _known(self, key: str, make: Callable[[], Any]) -> Any:
        """Object that is made once of the equations, for all values of the parameters."""
        if key not in self.known:
            self.known[key] = make()
        return self.known[key]

    @cached_property
    def projection(self) -> Projection | None:
        """Onto the constraints that hold; None where none closes."""
        found = self._known("projection", lambda: projection_of(self.system, self.p, self.target))
        return None if found is None else replace(found, p=self.p)

    @property
    def nearness(self) -> Nearness | None:
        """A new measure of the nearness of a motion to positions in which the constraints do not determine it."""
        return None if self._nearness is None else replace(self._nearness)

    @cached_property
    def _nearness(self) -> Nearness | None:
        known = self._known("nearness", lambda: nearness_of(self.equations, self.p, self.declared))
        found: Nearness | None = None if known is None else known.begun(self.p)
        if found is None or not self.loose:
            return found
        (determinants, rows), inner = (found.determinants, found.rows), self.functions.inner
        return replace(
            found,
            determinants=None if determinants is None else lambda t, x: determinants(t, inner(x)),
            rows=None if rows is None else replace(rows, rows=lambda t, x: rows.rows(t, inner(x))),
        )

    @cached_property
    def undetermined(self) -> tuple[Undetermined, ...]:
        """Conditions under which the motion is not determined: the determinants that vanish at singular positions."""
        known = self._known("undetermined", lambda: undetermined_of(self.equations, self.p, self.declared))
        return tuple(each.at(self.p) for each in known)

    @cached_property
    def slope(self) -> ExactSlope | None:
        """d(x')/dx; None where it is found by differences."""
        if self.loose or self.fed is not None:
            return None
        found = self._known("slope", lambda: slope_of(self.equations, self.p, self.target))
        return None if found is None else replace(found, p=self.p)

    @property
    def edges(self) -> tuple[Edge, ...]:
        """Edges at which closed contacts no longer determine the place where they touch."""
        found: tuple[Edge, ...] = self._known("edges", lambda: edges_of(self.system.motion, self.configuration.open))
        return found

    def slowest(self, t: float, x: np.ndarray) -> float:
        """The least speed with which anything slides on a surface; inf where nothing does [m/s]."""
        rows = self.system.constraints.rows
        speeds = tuple(row.sliding for row in rows if row.shares and row.friction is not None)
        return float(np.min(self.functions.evaluated(np.array([t]), x[None, :], speeds))) if speeds else np.inf

    def rests(self, t: float, values: Values) -> bool:
        """True if nothing moves, and nothing is given that could move it later."""
        symbols, coordinates = self.system.symbols, self.system.scope.model.coordinates
        given = (symbols.t, *symbols.inputs.values(), *(q for q in symbols.q if coordinates[q.name].driven))
        needed = (equation.needed for equation in self.reactions.balance.equations)
        sticking = (c.grip for c in self.contacts if self.watch.mode(c).sense == 0)
        grips = (self.system.scope.value(grip) for grip in sticking)
        if any(depends_on(x, given) for x in (*self.equations.forcing, *needed, *grips)):
            return False
        x = self.state(values)
        _, size = self.signals.sizes(t, x)
        return bool(np.max(np.abs(self.rate(t, x)), initial=0.0) <= tolerances.COMPUTED * size)

    @cached_property
    def _slackening(self) -> RightHandSide:
        rates = {s.owner: s.value for s in self.watch.signals if s.what == "gap'" and s.value is not None}
        return self.functions.kinematic(tuple(rates[name] for name in self.loose))


def smallest_speed(values: Values) -> float:
    """Smallest speed that is larger than rounding, relative to the fastest of the rates."""
    return tolerances.COMPUTED * max([1.0, *(abs(v) for name, v in values.items() if name.endswith("'"))])


def size_of_places(values: Values, model: Model) -> float:
    """Size of the coordinates, at least 1; speeds and states of first order have other units."""
    return max([1.0, *(abs(v) for name, v in values.items() if name in model.coordinates)])


# -------- slopes ----------------------------------------------------------------------------------------------
# Equations of motion -> d(x')/dx, exactly: what implicit integrators ask for.
#
# x' = (N u + nu, a), with a and lam from  M a - J^T lam = forcing,  J a = -gamma. The derivative of that solution
# comes from the same matrix, nothing is inverted in symbols:
#
#     [[M, -J^T], [J, 0]] [da; dlam] = - d(M a - J^T lam - forcing, J a + gamma) at fixed a, lam


LONG = 60_000  # operations from which on differences are cheaper than the derivative
SHORT = 400  # operations up to which a function runs in numpy: compiling takes longer


def slope_of(equations: EquationsOfMotion, p: np.ndarray, target: str | None = None) -> ExactSlope | None:
    """(t, x) -> d(x')/dx; None where the derivative is so long that differences are cheaper.

    Args:
        p: the parameters' values.
        target: the language in which a long function is run.
    """
    states, further = equations.symbols.x, equations.state_rates
    n, k = len(equations.M), len(equations.J)
    parts = (
        jacobian(equations.kinematic_rates, states),
        jacobian([x for rows in equations.residual for x in rows], states),
        equations.M,
        equations.J,
        jacobian(further, states),
        jacobian(further, equations.symbols.a),
    )
    entries = tuple(x for rows in parts for row in rows for x in row)
    program = Program.of(
        entries,
        equations.system.symbols,
        inputs=equations.system.inputs,
        solve=Solve.bordered(equations) if n else None,
    )
    if program.count.total > LONG:
        return None
    return ExactSlope(
        RightHandSide.of(program, target if program.count.total > SHORT else "numpy"), p, n, k, len(further)
    )


@dataclass(frozen=True)
class ExactSlope:
    """(t, x) -> d(x')/dx.

    Args:
        function: the derivatives of q' and of M a - J^T lam - forcing, J a + gamma, at fixed a and lam; M, J; those of
            z' at fixed a, and by a.
        p: the parameters' values.
        n, k: speeds and rows of constraints.
        states: states of first order.
    """

    function: RightHandSide
    p: np.ndarray
    n: int
    k: int
    states: int = 0

    def __call__(self, t: float, x: np.ndarray) -> np.ndarray:
        n, k, z, m = self.n, self.k, self.states, len(x)
        ends = np.cumsum([(m - n - z) * m, (n + k) * m, n * n, k * n, z * m])
        rates, residual, M, J, further, by_a = np.split(np.asarray(self.function(t, x, self.p)), ends)
        M, J = M.reshape(n, n), J.reshape(k, n)
        matrix = np.block([[M, -J.T], [J, np.zeros((k, k))]])
        solved = np.linalg.lstsq(matrix, -residual.reshape(n + k, m), rcond=tolerances.LEAST_CHANGE)[0]
        changed = further.reshape(z, m) + by_a.reshape(z, n) @ solved[:n]
        return np.vstack([rates.reshape(-1, m), solved[:n], changed])


def edges_of(motion: Motion, open: Container[str] = ()) -> tuple[Edge, ...]:
    """Edges of all constraints of the model except the open ones."""
    constraints = [
        (name, constraint) for name, constraint in motion.scope.model.constraints.items() if name not in open
    ]
    return tuple(
        edge
        for name, constraint in constraints
        for edge in constraint.edges(SystemScene(motion, f"{constraint.table}.{name}"))
    )
