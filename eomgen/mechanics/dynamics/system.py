"""Model -> System: motion, loads and constraints of one model; its generalized forces and equations of motion."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import field, replace
from functools import cached_property
from typing import Any

from eomgen.frozen import dataclass
from eomgen.mechanics.constraints import (
    Constraints,
    Elimination,
    begun_places,
    constraints_of,
    dependent_coordinates,
    elimination_of,
    holds_identically,
    rows_alike,
)
from eomgen.mechanics.kinematics import (
    Applied,
    ContactModes,
    JointEffort,
    Loads,
    Motion,
    Scope,
    Solved,
    in_body_axes,
    in_ground_axes,
    loads_of,
    motion_of,
    scope_of,
    shorter,
    slide_of,
    spin_of,
    weights,
    with_declared_speeds,
)
from eomgen.model import Couple, GeneralizedForce, Load, Model, PointForce, UniformField
from eomgen.symbolic.expression import (
    ZERO,
    Node,
    Scalar,
    ScalarRow,
    ScalarRows,
    Symbols,
    Vector,
    dot,
    gradient,
    inner,
    jacobian,
    substituted,
    vector_of,
)
from eomgen.symbolic.numeric import transplanted

# -------- system ----------------------------------------------------------------------------------------------
# Model -> System: motion, loads and constraints of one model, over one graph.


@dataclass(frozen=True)
class System:
    """Motion, loads and constraints from which every formulation assembles the equations; none of them uses another.

    Args:
        motion, loads, constraints: over the independent speeds alone.
        modes: states of the contacts that can end, slide or stick, by constraint.
        elimination: that of the dependent coordinates; None where there are none.
        free: the same system with every rate a speed, dependent coordinates free and all constraints closing; None
            where it is the same.
        declared: the rates that follow from declared speeds, with the places where these do not determine them.
    """

    motion: Motion
    loads: Loads
    constraints: Constraints
    modes: ContactModes = field(default_factory=dict)
    elimination: Elimination | None = None
    free: System | None = None
    declared: tuple[Solved, ...] = ()

    def __repr__(self) -> str:
        return f"<system of {self.scope.model.name!r}>"

    @property
    def scope(self) -> Scope:
        return self.motion.scope

    @cached_property
    def inputs(self) -> dict[str, Scalar]:
        """The model's own expression of each input, in t and parameters."""
        return {name: self.scope.value(part.value.named(name)) for name, part in self.scope.model.inputs.items()}

    @cached_property
    def found(self) -> dict[Any, Any]:
        """Cache of results that several stages use, as its reactions."""
        return {}

    def standing(self, places: Mapping[Node, Scalar]) -> dict[Node, Scalar]:
        """State at t = 0 with all speeds and accelerations 0: the given coordinates, and the inputs there."""
        symbols = self.symbols
        still = {symbols.t: 0, **dict.fromkeys((*symbols.u, *symbols.a), 0), **places}
        own = substituted(tuple(self.inputs[name] for name in symbols.inputs), still)
        return still | dict(zip(symbols.inputs.values(), own, strict=True))

    @cached_property
    def symbols(self) -> Symbols:
        """The symbols of the model, one multiplier for each constraint row included."""
        symbols = self.scope.symbols
        lam = tuple(symbols.graph.symbol(row.label) for row in self.constraints.closing)
        return replace(symbols, lam=lam)


def system_of(
    model: Model, modes: ContactModes | None = None, *, with_laws: bool = False, begun_as: System | None = None
) -> System:
    """Motion, loads and constraints of a model, dependent coordinates eliminated.

    Args:
        modes: how contacts are that can end, slide or stick, by constraint.
        begun_as: the system of the same start whose model this one was, before something in it was let go: what stands
            as it did at the start stands as it does there.
        with_laws: for print: long rates and accelerations of driven coordinates are names (`Scope.laws`).
    Raises:
        NotYet: a kind of joint, force or constraint that this version does not derive.
        DerivationError: what the model says cannot be derived.
    """
    free = free_system_of(model, modes, with_laws=with_laws, begun_as=begun_as)
    return reduced_system(free) if dependent_coordinates(free.scope) or model.speeds else free


def free_system_of(
    model: Model, modes: ContactModes | None = None, *, with_laws: bool = False, begun_as: System | None = None
) -> System:
    """Motion, loads and constraints of a model in which dependent coordinates are as free as others."""
    motion = motion_of(scope_of(model, with_laws=with_laws))
    constraints = constraints_of(motion, modes=modes)
    begun: Mapping[Node, Scalar] = {}
    if begun_as is not None:
        begun = _carried_places(begun_as, motion.scope)
    elif any(force.of_the_start for force in model.forces.values()):
        begun = begun_places(constraints)
    return System(motion, loads_of(motion, begun), constraints, modes or {})


def _carried_places(system: System, scope: Scope) -> dict[Node, Scalar]:
    """Start values, in another scope, of the coordinates of a system whose start is not the declared one."""
    places = system.loads.begun
    values = transplanted(tuple(places.values()), scope.graph, scope.names)
    own = {q.name: q for q in scope.symbols.q}
    return {own[q.name]: x for q, x in zip(places, values, strict=True) if q.name in own}


def reduced_system(free: System) -> System:
    """The system over its independent speeds: N = [1; A], nu = [0; b] of dependent coordinates, then as declared.

    Raises:
        DerivationError: a dependent coordinate that no constraint determines.
        ModelError: declared speeds that do not determine the rates.
    """
    elimination = elimination_of(free.constraints) if dependent_coordinates(free.scope) else None
    scope = free.scope if elimination is None else elimination.scope
    solved: tuple[Solved, ...] = ()
    if scope.model.speeds:
        scope, solved = with_declared_speeds(scope, vanishes=holds_identically, shorter=shorter)
    motion = motion_of(scope)
    constraints = constraints_of(motion, {} if elimination is None else elimination.used, free.modes)
    return System(motion, loads_of(motion, free.loads.begun), constraints, free.modes, elimination, free, solved)


# -------- work ------------------------------------------------------------------------------------------------
# Loads -> generalized forces by virtual work on positions and by derivatives of the potential energy.


def generalized_forces(loads: Loads) -> ScalarRow:
    """Q_k of everything applied: -dV/dq_k where there is a potential, else the virtual work per unit of q_k."""
    rows = [force_row(loads, force) for force in loads.applied] + [effort_row(loads.motion, e) for e in loads.efforts]
    return summed(rows, len(loads.motion.scope.symbols.u))


def powered_forces(loads: Loads) -> ScalarRow:
    """Q_nc: the part of Q that comes from no potential, by virtual work."""
    motion = loads.motion
    rows = [force_row(loads, force) for force in loads.applied if force.potential is None]
    rows += [drive_row(motion, effort) for effort in loads.efforts]
    return summed(rows, len(motion.scope.symbols.u))


def acting(loads: Loads, holds: Callable[[ScalarRow], bool]) -> str:
    """Names of the forces and joints whose generalized forces have a property: "the force 'd' and the joint of 'x'"."""
    found = [f"the force '{force.name}'" for force in loads.applied if holds(force_row(loads, force))]
    found += [f"the joint of '{effort.body}'" for effort in loads.efforts if holds(effort_row(loads.motion, effort))]
    return " and ".join(dict.fromkeys(found))


def summed(rows: list[ScalarRow], size: int) -> ScalarRow:
    """The sum of rows, entry by entry."""
    sums: list[Scalar] = [0] * size
    for row in rows:
        sums = [a + b for a, b in zip(sums, row, strict=True)]
    return tuple(sums)


def force_row(loads: Loads, force: Applied) -> ScalarRow:
    """Q of one named force."""
    if force.potential is not None:
        return from_potential(loads.motion, force.potential)
    size = len(loads.motion.scope.symbols.u)
    return summed([load_row(loads, load) for load in force.loads], size)


def effort_row(motion: Motion, effort: JointEffort) -> ScalarRow:
    """Q of a joint's drive, spring and damper: drive ds/dq - dV/dq."""
    elastic = from_potential(motion, effort.potential)
    return tuple(d + e for d, e in zip(drive_row(motion, effort), elastic, strict=True))


def drive_row(motion: Motion, effort: JointEffort) -> ScalarRow:
    """Q of what a joint's drive and damper do: drive ds/dq."""
    s = motion.link(effort.body).s[effort.variable]
    return tuple(effort.drive * d for d in per_speed(motion, gradient(s, motion.scope.symbols.q)))


def from_potential(motion: Motion, V: Scalar) -> ScalarRow:
    """-N^T dV/dq."""
    return tuple(-x for x in per_speed(motion, gradient(V, motion.scope.symbols.q)))


def per_speed(motion: Motion, row: ScalarRow) -> ScalarRow:
    """N^T applied to a row over the coordinates."""
    N = motion.scope.N
    size = len(motion.scope.symbols.u)
    return tuple(sum((N[i][k] * x for i, x in enumerate(row)), start=0) for k in range(size))


def load_row(loads: Loads, load: Load) -> ScalarRow:
    """Q of one load by virtual work."""
    motion = loads.motion
    symbols = motion.scope.symbols
    if isinstance(load, GeneralizedForce):
        row = tuple(load.value if q.name == load.coordinate else 0 for q in symbols.q)
        return per_speed(motion, row)
    if isinstance(load, UniformField):
        return summed([load_row(loads, weight) for weight in weights(loads)], len(symbols.u))
    if isinstance(load, Couple):
        spin = jacobian(spin_of(motion, motion.link(load.body)), symbols.u)
        couple = in_body_axes(motion, load.body, load.couple, load.axes)
        return _weighted(couple, spin, len(symbols.u))
    position = jacobian(motion.position(load.place), symbols.q)
    force = in_ground_axes(motion, load.force, load.axes)
    return per_speed(motion, _weighted(force, position, len(symbols.q)))


def _weighted(force: Vector, rows: ScalarRows, size: int) -> ScalarRow:
    """force . d(position)/dq_k for each k."""
    return tuple(dot(force, vector_of(row[k] for row in rows)) for k in range(size))


def placeless_forces(loads: Loads) -> ScalarRow:
    """Q of loads that no twist contains: generalized forces, energies of coordinates, forces on sliding points."""
    size = len(loads.motion.scope.symbols.u)
    rows = [load_row(loads, load) for load in loads.generalized]
    energies = [force.potential for force in loads.applied if force.placeless]
    rows += [from_potential(loads.motion, V) for V in energies if V is not None]
    rows += [_sliding_row(loads.motion, load) for load in loads.placed if isinstance(load, PointForce)]
    return summed(rows, size)


def _sliding_row(motion: Motion, force: PointForce) -> ScalarRow:
    """Q of a force whose point moves in its body: F . d(R r')/du."""
    u = motion.scope.symbols.u
    slide = slide_of(motion, force.place)
    if slide == ZERO:
        return (0,) * len(u)
    return _weighted(in_ground_axes(motion, force.force, force.axes), jacobian(slide, u), len(u))


def joint_forces(loads: Loads) -> ScalarRow:
    """Q of the joints' efforts on the joint variables: D^T effort."""
    motion = loads.motion
    size = len(motion.scope.symbols.u)
    rows = []
    for effort in loads.efforts:
        rate = motion.link(effort.body).s_rate[effort.variable]
        rows.append(tuple(effort.effort * d for d in gradient(rate, motion.scope.symbols.u)))
    return summed(rows, size)


# -------- equations of motion ---------------------------------------------------------------------------------
# What every formulation gives: the equations of motion of a system, as graph scalars.


@dataclass(frozen=True)
class EquationsOfMotion:
    """The equations of motion: q' = N u + nu,  M a + c = Q + J^T lam,  J a + gamma = 0.

    Args:
        system: whose motion, loads and constraints they are put together from.
        N, nu: kinematic matrix, nq rows of nu entries, and bias, nq.
        M: mass matrix, nu rows of nu entries.
        c: inertia terms left when a = 0, nu.
        Q: generalized forces of everything applied, nu.
        forcing: Q - c, nu (of its own: it can be cheaper than the difference).
        J, sigma, gamma: constraint rows, k rows of nu entries; velocity bias, k; acceleration bias, k.
        phi: gaps, k (None for a row that has none).
        T, V: kinetic and potential energy [J].
        accelerations: a as explicit expressions where the formulation gives them (articulated body), else None.
        friction: the part of Q that contacts with friction make, nu; () where there is no friction.
        alike: of each constraint row the number of its group of alike rows (`rows_alike`); () of few.
    """

    system: System
    N: tuple[ScalarRow, ...]
    nu: ScalarRow
    M: tuple[ScalarRow, ...]
    c: ScalarRow
    Q: ScalarRow
    forcing: ScalarRow
    J: tuple[ScalarRow, ...]
    sigma: ScalarRow
    gamma: ScalarRow
    phi: tuple[Scalar | None, ...]
    T: Scalar
    V: Scalar
    accelerations: ScalarRow | None = None
    friction: ScalarRow = ()
    alike: tuple[int, ...] = ()

    def __repr__(self) -> str:
        name = self.system.scope.model.name
        return f"<equations of motion of {name!r}: {len(self.M)} speeds, {len(self.J)} constraint rows>"

    @property
    def symbols(self) -> Symbols:
        """The symbols in which everything is written."""
        return self.system.symbols

    @cached_property
    def residual(self) -> tuple[ScalarRow, ScalarRow]:
        """(M a - forcing - J^T lam, J a + gamma) with a and lam as symbols: zero in every motion."""
        a, lam = self.symbols.a, self.symbols.lam
        pushes = list(zip(*self.J, strict=True)) if self.J else [()] * len(self.M)
        balance = tuple(
            inner(row, a) - force - inner(push, lam)
            for row, force, push in zip(self.M, self.forcing, pushes, strict=True)
        )
        return balance, tuple(inner(row, a) + bias for row, bias in zip(self.J, self.gamma, strict=True))

    @property
    def inputs(self) -> dict[str, Scalar]:
        """The model's own expression of each input."""
        return self.system.inputs


def assembled(
    system: System, *, M: tuple[ScalarRow, ...], c: ScalarRow, Q: ScalarRow, T: Scalar, forcing: ScalarRow | None = None
) -> EquationsOfMotion:
    """The formulation's M, c, Q and T with what all formulations share: kinematics, constraint rows, V."""
    scope, constraints = system.scope, system.constraints
    if forcing is None:
        forcing = tuple(force - inertia for force, inertia in zip(Q, c, strict=True))
    return EquationsOfMotion(
        system,
        scope.N,
        scope.nu,
        M,
        c,
        Q,
        forcing,
        constraints.J,
        constraints.sigma,
        constraints.gamma,
        constraints.phi,
        T,
        system.loads.potential_energy,
        alike=_alike(system),
    )


def _alike(system: System) -> tuple[int, ...]:
    if len(system.constraints.closing) < 2:
        return ()
    if rows_alike not in system.found:
        system.found[rows_alike] = rows_alike(system.constraints)
    found: tuple[int, ...] = system.found[rows_alike]
    return found
