"""System -> Quantities: the values of output functions as graph scalars."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import field, replace
from functools import cached_property

import numpy as np

from eomgen.errors import DerivationError
from eomgen.frozen import dataclass
from eomgen.mechanics.dynamics import System
from eomgen.mechanics.free_bodies import Balance, DrivingForces, Indeterminate, Reactions, SystemFriction
from eomgen.mechanics.impacts import ImpactEquations
from eomgen.mechanics.instant.kinematic_state import Composition, body_axes, composition_of
from eomgen.mechanics.instant.motion_kind import finite_center
from eomgen.mechanics.kinematics import (
    Applied,
    JointEffort,
    Principal,
    SystemInertia,
    SystemScene,
    VelocityField,
)
from eomgen.mechanics.statics import FreeBodies, RequestedSection, SectionForces
from eomgen.model import (
    FUNCTIONS,
    GROUND,
    Couple,
    GeneralizedForce,
    Load,
    MassProperties,
    PointForce,
    UniformField,
    formula_at,
)
from eomgen.symbolic.exact import simplest
from eomgen.symbolic.expression import (
    Call,
    Expression,
    Matrix,
    Node,
    Scalar,
    Vector,
    depends_on,
    derivative,
    substituted,
    tangent,
)
from eomgen.symbolic.numeric import Work, transplanted

# -------- outputs ---------------------------------------------------------------------------------------------
# System -> Quantities: what output functions ask of it, as graph scalars.
#
# Positions are read off the poses; velocities and accelerations are their time derivatives, and the accelerations
# hold the symbols a, in which they are linear.


@dataclass(frozen=True)
class Quantities:
    """Values of the output functions in one system: the scene in which the functions are written.

    Args:
        system: the system.
        at: exact scalars in place of coordinates, speeds, accelerations and t in the reactions.
        balance: the balance of the bodies, where it is solved already.
    """

    system: System
    at: Mapping[Node, Scalar] = field(default_factory=dict)
    balance: Reactions | None = None

    def value(self, call: Call) -> Scalar:
        """One function at its arguments, in q, u, a, t and the parameters.

        Raises:
            DerivationError: it has no meaning here.
        """
        if call.name not in FUNCTIONS:
            raise DerivationError(
                f"'{call}': there is no function '{call.name}'",
                fix="see docs/reference/outputs.md",
            )
        return FUNCTIONS[call.name].value(self, call)

    def of(self, formula: Expression, value: Callable[[Call], Scalar] | None = None) -> Scalar:
        """A formula, in q, u, a, t and the parameters.

        Reactions that have no single value may have one together: R1 + R2 of two supports in a line.

        Args:
            value: of each function in it; None: that of `value`.
        Raises:
            DerivationError: something in it has no meaning here; no single value.
        """
        try:
            return formula.evaluate(self.names, value or self.value)
        except Indeterminate:
            found = self.reactions.together(self.over_components(formula))
            if found is None:
                raise
            return self.reactions.combined(found[0], formula.text) + found[1]

    def over_components(self, formula: Expression) -> Scalar:
        """A formula over the components of the balance, as symbols."""
        by_components, _ = self.reactions.by_components
        return formula.evaluate(self.names, replace(self, balance=by_components).value)

    # -- places, and how they change ---------------------------------------------------------------

    @property
    def is_plane(self) -> bool:
        """True if all motion is in the plane."""
        return self.system.scope.model.space == "plane"

    @property
    def bodies(self) -> tuple[str, ...]:
        """The bodies, without the ground."""
        return tuple(link.name for link in self.system.motion.links)

    @property
    def names(self) -> Mapping[str, Scalar]:
        """Scalars for which the names of an expression stand."""
        return self.system.scope.names

    def position(self, point: str) -> Vector:
        """Position of a point, ground axes [m]."""
        return self.system.motion.position(self.system.motion.place(point))

    def body_of(self, point: str) -> str:
        """The body on which a point is, or the ground."""
        return self.system.motion.place(point)[0] or GROUND

    def origin(self, body: str) -> Vector:
        """Position of the origin of the frame of a body, or of the ground [m]."""
        return self.system.motion.link(body).pose.p if body in self.system.motion.index else Vector.ZERO

    def axes(self, body: str) -> Matrix:
        """R from the axes of a body to the ground's."""
        return body_axes(self.system.motion, body)

    def angle(self, body: str) -> Scalar:
        """Angle of a body of the plane against the ground's axes; of the ground 0 [rad]."""
        angle = self.system.motion.link(body).angle if body in self.system.motion.index else 0
        assert angle is not None, "in the plane every body has an angle"
        return angle

    def spin(self, body: str) -> Vector:
        """Angular velocity in ground axes, from the twist; of the ground 0 [rad/s]."""
        if body not in self.system.motion.index:
            return Vector.ZERO
        link = self.system.motion.link(body)
        return link.twist.w if link.angle is not None else link.pose.R @ link.twist.w

    def rate(self, place: Vector) -> Vector:
        """d/dt of what depends on q and t."""
        return self.system.scope.rate_of(place)

    def acceleration(self, velocity: Vector) -> Vector:
        """d/dt of what depends on q, u and t."""
        return Vector(self.system.scope.with_accelerations(velocity))

    def placed(self, *vectors: Vector) -> tuple[Vector, ...]:
        """The vectors at the given state; as they are where none is given."""
        if not self.at:
            return vectors
        flat = iter(substituted([x for vector in vectors for x in vector], self.at))
        return tuple(Vector(next(flat) for _ in range(3)) for _ in vectors)

    def here(self, *vectors: Vector) -> tuple[Vector, ...]:
        """Vectors at the given state in readable form."""
        if not self.at:
            return vectors
        return tuple(Vector(map(self._short, vector)) for vector in self.placed(*vectors))

    def _short(self, x: Scalar) -> Scalar:
        return simplest(x, Work.VALUE, self.system.scope.positive)

    # -- fields of velocities ----------------------------------------------------------------------

    def parts_of_motion(self, point: str, body: str) -> Composition:
        """The motion of a point against a body, in its parts."""
        return composition_of(self.system.motion, point, body)

    def _field(self, body: str) -> VelocityField:
        """The field of a body at the given state."""
        field = self.system.motion.field(body)
        return VelocityField(*self.here(field.p, field.v, field.a, field.w, field.e))

    def rotation_center(self, body: str, other: str = GROUND) -> Vector:
        """The centre of rotation of a body against the ground or another body.

        Raises:
            DerivationError: it is at infinity, or there is none.
        """
        whose = f"body '{body}'" + (f" against '{other}'" if other != GROUND else "")
        return finite_center(self._field(body).against(self._field(other)), whose)

    def acceleration_pole(self, body: str) -> Vector:
        """The point of a body that has no acceleration.

        Raises:
            DerivationError: there is none.
        """
        return self._field(body).acceleration_pole()

    def least_speed(self, body: str, start: Vector, end: Vector) -> Scalar:
        """The least speed of the points of a body between two places."""
        return self._field(body).least_speed(start, end, self._short)

    # -- masses and energies -------------------------------------------------------------------------

    def mass(self, body: str) -> MassProperties:
        """Mass, mass centre and inertia about it, body axes."""
        return self.system.scope.mass_properties(body)

    def parts(self, body: str) -> int | None:
        """Number of parts of which a body is made; None where it is not made of parts."""
        parts = self.system.scope.model.bodies[body].parts
        return None if parts is None else len(parts)

    def mass_of_part(self, body: str, number: int) -> Scalar:
        """The mass of a part, counted from 1; of a hole positive [kg]."""
        found: Scalar = self.system.scope.made_of(body).pieces[number - 1].mass.m
        return found

    def without_inertia(self, bodies: Sequence[str]) -> tuple[str, ...]:
        """Names of those bodies that have a mass but no stated inertia."""
        return SystemInertia(self.system.motion).shapeless(bodies)

    def known_about_z(self, bodies: Sequence[str]) -> tuple[str, ...]:
        """Names of those bodies of which only the moment of inertia about z is known."""
        return SystemInertia(self.system.motion).flat(bodies)

    def tensor(self, point: Vector, bodies: Sequence[str]) -> Matrix:
        """I_P of the bodies together [kg m^2]."""
        return SystemInertia(self.system.motion).about(point, bodies)

    def principal_moments(self, tensor: Matrix) -> tuple[Scalar, ...]:
        """Principal moments of inertia, ascending [kg m^2]."""
        return Principal.ascending(tensor, self.system.scope)

    def angular_momentum(self, point: Vector, bodies: Sequence[str]) -> Vector:
        """L_P of the bodies together [kg m^2/s]."""
        return SystemInertia(self.system.motion).angular_momentum(point, bodies)

    def kinetic_energy(self, body: str | None = None) -> Scalar:
        """T of the whole, or of one body [J]."""
        return energy_of_motion(self.system, body)

    def potential_energy(self, name: str | None = None) -> Scalar:
        """V of the whole, of one force, or of one body [J]."""
        return energy_of_force(self.system, name)

    def power(self, name: str | None = None) -> Scalar:
        """Power of all applied loads, of one force, or of the loads on one body [W]."""
        return power_of_loads(self.system, name)

    def effort(self, force: str) -> Scalar:
        """Force that draws the points of a force element together [N], or moment that turns its second body [N m].

        Raises:
            DerivationError: it acts neither between two points nor between two bodies.
        """
        effort = self.system.scope.model.forces[force].effort(
            SystemScene(self.system.motion, f"forces.{force}", self.system.loads.begun)
        )
        if effort is None:
            raise DerivationError(
                f"force '{force}' acts neither between two points nor between two bodies",
                fix="name a spring or a damper",
            )
        return effort

    def generalized_force(self, coordinate: str) -> Scalar:
        """Q_k of everything applied."""
        system, k = self._speed(coordinate, "generalized_force")
        return self._carried(system, system.loads.generalized_forces[k])

    def momentum(self, coordinate: str) -> Scalar:
        """p_k = dT/dq_k', or dT/du_k of a declared speed."""
        system, k = self._speed(coordinate, "momentum")
        return self._carried(system, derivative(SystemInertia(system.motion).kinetic_energy, system.symbols.u[k]))

    # -- the balance of the bodies -------------------------------------------------------------------

    @cached_property
    def reactions(self) -> Reactions:
        """All reactions, of generic coordinates or at the given ones."""
        return Reactions.of(self.system, self.at, short=True) if self.balance is None else self.balance

    def is_truss(self, name: str) -> bool:
        """True if a name is that of a truss."""
        constraint = self.system.scope.model.constraints.get(name)
        return constraint is not None and constraint.table == "trusses"

    def multiplier(self, constraint: str) -> Scalar:
        """lam of a constraint of one row; where it or another action has no place, as it stands in the equations of
        motion."""
        rows = [row for row in self.system.constraints.rows if row.constraint == constraint]
        if any(row.pushes for row in rows) and not self._acts_at_no_place:
            return self.reactions.multiplier(constraint)
        return DrivingForces(self.system).multiplier(constraint)

    @property
    def _acts_at_no_place(self) -> bool:
        """True if the bodies cannot be balanced one by one, as a load acts at no place."""
        try:
            Balance.refuse_placeless(self.system)
        except DerivationError:
            return True
        return False

    def impulse(self, owner: str, along: int | None = None) -> Scalar:
        """Impulse of a contact that closes in this state, or of what holds in that impact; along an axis of the ground.

        Raises:
            DerivationError: several contacts can close, and none is named; the coordinates of the impact are others.
        """
        model, modes = self.system.scope.model, self.system.modes
        ending = [contact.name for contact in model.contacts if contact.unilateral]
        if owner not in ending and len(ending) != 1:
            what = f"impulse of '{owner}': {', '.join(ending) or 'no contact'} can close"
            raise DerivationError(what, fix="ask impulse(CONTACT), or leave one contact that can")
        contact = owner if owner in ending else ending[0]
        standing = [name for name in ending if name not in modes or modes[name].closed]
        found = ImpactEquations.of(model, (contact,), [name for name in standing if name != contact])
        value = found.impulse_along(owner, along) if along is not None else found.impulses.get(owner)
        if value is None:
            raise DerivationError(f"'{owner}' has no impulse of its own", fix=f"one of {', '.join(found.impulses)}")
        symbols = self.system.symbols
        meanings: dict[str, Scalar] = {x.name: x for x in (*symbols.x, *symbols.parameters.values(), symbols.t)}
        return transplanted((value,), self.system.scope.graph, meanings)[0]

    def drive(self, coordinate: str) -> Scalar:
        """Force or moment of the drive that moves a driven coordinate as given."""
        return DrivingForces(self.system).along(coordinate)

    def section(self, body: str) -> SectionForces:
        """The section forces along a body."""
        if body not in self.system.motion.index:
            raise DerivationError(
                f"'{body}' is no body with section forces", fix="declare it as a rail or a beam: an axis and its ends"
            )
        if body not in self._sections:
            self._sections[body] = SectionForces.of(self.reactions, body)
        return self._sections[body]

    def free_bodies(self, calls: Iterable[Call], numbers: Callable[[Sequence[Scalar]], np.ndarray]) -> FreeBodies:
        """The bodies cut free, beams cut where these calls request section forces.

        Args:
            numbers: values of scalars at states, (k, n).
        Raises:
            DerivationError: a body without section forces; something acts off a beam's axis, or at no place.
        """
        sections = [
            RequestedSection(call, self.section(call.name_at(0)), formula_at(call, 1).evaluate(self.names))
            for call in calls
        ]
        return FreeBodies.of(self.system, numbers, sections)

    @cached_property
    def _sections(self) -> dict[str, SectionForces]:
        """Cache of the section forces already found, by body."""
        return {}

    # -- along coordinates ---------------------------------------------------------------------------

    def _speed(self, coordinate: str, function: str) -> tuple[System, int]:
        """The system among whose speeds it is, or its rate, and its place; of replaced rates the system over the rates.

        Raises:
            DerivationError: it is no degree of freedom.
        """
        declared = self.system.scope.model.speeds
        turning = {e.name for four in self.system.scope.quaternions for e in four}
        for system in (self.system, *([self.system.free] if declared and self.system.free else [])):
            names = [u.name for u in system.symbols.u]
            sought = coordinate if coordinate in declared else f"{coordinate}'"
            part = system.scope.model.coordinates.get(coordinate)
            if sought in names and coordinate not in turning and not (part and part.dependent):
                return system, names.index(sought)
        if coordinate in turning:
            raise DerivationError(
                f"{function}({coordinate}): '{coordinate}' is part of a quaternion, it is no degree of freedom",
                fix="take one of the speeds that the joint's `omega` names",
            )
        raise DerivationError(
            f"{function}({coordinate}): '{coordinate}' moves as given, it is no degree of freedom",
            fix=f"use drive({coordinate})",
        )

    def _carried(self, system: System, scalar: Scalar) -> Scalar:
        """A scalar of the system over the rates in the speeds of this one."""
        if system is self.system:
            return scalar
        rates = self.system.free_rates(system)
        return substituted((scalar,), dict(zip(system.symbols.u, rates, strict=True)))[0]

    @staticmethod
    def put_into_rates(system: System) -> System:
        """The same system, reactions in the rates of its states as functions of q, u, a, z and t; made once.

        Raises:
            DerivationError: a reaction in a rate has no single value: the state is named.
        """
        return _with_reactions_in_rates(system)

    @staticmethod
    def requested_by(formula: Expression, source: str) -> bool:
        """True if a formula calls functions that are found from this source."""
        return any(call.name in FUNCTIONS and FUNCTIONS[call.name].source == source for call in formula.calls)


# -------- reactions in rates ----------------------------------------------------------------------------------
# System -> System: reactions in the rates of its states of first order, by the balance of the bodies cut free.
#
#     z' = Z(q, u, a, z, rho, t),   rho = rho(q, u, a, z, t)
#
# The reactions are linear in the accelerations, as `[outputs]` have them: so z' is a function of q, u, a and z, like a
# rate in which accelerations stand, and all that follows from those follows from these. The order is a and lam first,
# as z is known, then z'. Nothing that pushes may depend on such a rate: it would be an algebraic loop.


BY_ITSELF = "let the rate hold what the reaction follows from, or take out what makes it indeterminate"


def _with_reactions_in_rates(system: System) -> System:
    scope = system.scope
    held = scope.reactions_in_rates if system.symbols.z else {}
    if not held or not depends_on(scope.state_rates, held):
        return system
    key = _with_reactions_in_rates
    if key not in system.found:
        values = {symbol: _in_a_rate(system, symbol, call) for symbol, call in held.items()}
        rates = substituted(scope.state_rates, values)
        names = scope.names | {f"{z.name}'": rate for z, rate in zip(scope.symbols.z, rates, strict=True)}
        system.found[key] = replace(system, motion=replace(system.motion, scope=replace(scope, names=names)))
    found: System = system.found[key]
    return found


def _in_a_rate(system: System, symbol: Node, call: Call) -> Scalar:
    """A reaction in a rate, in q, u, a, z, t and the parameters."""
    scope = system.scope
    rates = zip(scope.symbols.z, scope.state_rates, strict=True)
    where = f"states.{next(z.name for z, rate in rates if depends_on(rate, (symbol,)))}.rate"
    try:
        value = Quantities(system, balance=Reactions.of(system)).value(call)
    except DerivationError as error:
        what = f"'{call}' in the rate of a state: {error.what}"
        raise DerivationError(what, where, error.fix or BY_ITSELF) from error
    if depends_on(value, (*system.symbols.lam, *system.symbols.unknowns.values())):
        what = f"'{call}' in the rate of a state holds a multiplier of a constraint, or an unknown load"
        raise DerivationError(what, where, "ask the reaction of a joint or constraint: reaction_x(A), reaction_n(A)")
    return SystemFriction(system).with_rest((value,))[0]


# -------- energies --------------------------------------------------------------------------------------------
# System -> energies and powers, of the whole, of one body or of one force.


def energy_of_motion(system: System, body: str | None = None) -> Scalar:
    """T = m v.v / 2 + w.I w / 2 of the whole, or of one body with the rotors of its joint [J]."""
    motion = system.motion
    if body is None:
        return SystemInertia(motion).kinetic_energy
    energy = SystemInertia(motion).bodies[motion.index[body]]
    return energy.translation + energy.rotation + SystemInertia(motion).rotor_energy(motion.link(body))


def energy_of_force(system: System, name: str | None = None) -> Scalar:
    """V of the whole, of one force, or of what acts on one body alone: its weight, a spring to the ground [J].

    Raises:
        DerivationError: a force without potential; a potential that the body shares with another.
    """
    loads = system.loads
    if name is None:
        return loads.potential_energy
    if name in system.scope.model.forces:
        (force,) = (f for f in loads.applied if f.name == name)
        if force.potential is None:
            raise DerivationError(f"force '{name}' has no potential energy", fix="ask for its power or its work")
        return force.potential
    total: Scalar = sum((_share(system, force, name) for force in loads.applied), start=0)
    return sum((_effort_share(system, effort, name) for effort in loads.efforts), start=total)


def _share(system: System, force: Applied, body: str) -> Scalar:
    """The part of a force's potential that belongs to one body: -F . r of a constant F, else all of it."""
    if force.potential is None:
        return 0
    share: Scalar = 0
    for load in _point_loads(system, force):
        if not _acts_on(load, body):
            continue
        if isinstance(load, PointForce) and _is_constant(system, load):
            share = share - load.force @ system.motion.position(load.place)
        elif all(_acts_on(other, body) or _acts_on(other, None) for other in force.loads):
            return force.potential
        else:
            raise DerivationError(
                f"the potential of force '{force.name}' belongs to more than body '{body}'",
                fix=f"ask potential_energy({force.name})",
            )
    return share


def _effort_share(system: System, effort: JointEffort, body: str) -> Scalar:
    """The joint's spring, where it stands between the body and the ground."""
    sharing = [name for name, _ in effort.wrenches(system.motion)]
    if body not in sharing or type(effort.potential) is int:
        return 0
    if sharing != [body]:
        raise DerivationError(
            f"the spring in the joint of body '{effort.body}' belongs to more than body '{body}'",
            fix="ask for the potential energy of the whole: potential",
        )
    return effort.potential


def _point_loads(system: System, force: Applied) -> list[Load]:
    """The loads of a force, a uniform field as weights."""
    found: list[Load] = []
    for load in force.loads:
        found += _weights(system, load) if isinstance(load, UniformField) else [load]
    return found


def _weights(system: System, field: UniformField) -> list[PointForce]:
    masses = SystemScene(system.motion).masses(None)
    return [PointForce(place, m * field.acceleration) for place, m in masses]


def _acts_on(load: Load, body: str | None) -> bool:
    return (load.place[0] if isinstance(load, PointForce) else getattr(load, "body", None)) == body


def _is_constant(system: System, load: PointForce) -> bool:
    symbols = system.symbols
    return load.axes is None and not any(depends_on(x, (*symbols.x, symbols.t)) for x in load.force)


def power_of_loads(system: System, name: str | None = None) -> Scalar:
    """Power of everything applied, of one force, or of all that is applied to one body [W].

    P = sum F . v + C . w; of what acts at no place, Q_k q_k' and -dV/dq . q'.
    """
    loads = system.loads
    forces = loads.applied
    if name is not None and name in system.scope.model.forces:
        return sum((_force_power(system, force) for force in forces if force.name == name), start=0)
    if name is not None:
        return _body_power(system, name)
    total = sum((_force_power(system, force) for force in forces), start=0)
    for effort in loads.efforts:
        total = total + effort.effort * system.motion.link(effort.body).s_rate[effort.variable]
    return total


def _body_power(system: System, body: str) -> Scalar:
    total: Scalar = 0
    for force in system.loads.applied:
        for load in _point_loads(system, force):
            if _acts_on(load, body):
                total = total + _load_power(system, load)
    for effort in system.loads.efforts:
        for name, wrench in effort.wrenches(system.motion):
            if name == body:
                total = total + system.motion.link(body).twist.power(wrench)
    return total


def _force_power(system: System, force: Applied) -> Scalar:
    if force.loads:
        return sum((_load_power(system, load) for load in _point_loads(system, force)), start=0)
    scope = system.scope
    rates = dict(zip(scope.symbols.q, scope.rates, strict=True))
    return 0 if force.potential is None else -tangent((force.potential,), rates)[0]


def _load_power(system: System, load: Load) -> Scalar:
    motion = system.motion
    if isinstance(load, GeneralizedForce):
        coordinates = [q.name for q in system.symbols.q]
        return load.value * system.scope.rates[coordinates.index(load.coordinate)]
    if isinstance(load, Couple):
        couple = motion.in_body_axes(load.body, load.couple, load.axes)
        return couple @ motion.link(load.body).twist.w
    assert isinstance(load, PointForce), "fields are weights by now"
    return motion.in_ground_axes(load.force, load.axes) @ motion.velocity(load.place)
