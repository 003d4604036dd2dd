"""Motion -> SystemInertia: kinetic energies of bodies, of rotors and as given; the inertia that belongs to no body."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from eomgen.frozen import dataclass
from eomgen.mechanics.kinematics.motion import BodyLink, Motion
from eomgen.mechanics.kinematics.scene import SystemScene
from eomgen.model import BodyPoint, MassProperties
from eomgen.symbolic.expression import (
    Fraction,
    Matrix,
    Node,
    Scalar,
    ScalarRow,
    Twist,
    Vector,
    Wrench,
    gradient,
    inner,
    is_zero,
    jacobian,
    pullback,
    substituted,
    tangent,
)

# -------- inertia ---------------------------------------------------------------------------------------------
# Motion -> SystemInertia: energies of motion, and what belongs to no body: rotors behind gears, given kinetic energies.
#
# The kinetic energy here is built on derivatives of the poses, not on the twists of the recursion: v_C = d/dt p_C and
# w~ = R^T R'. So what Lagrange's method derives shares no velocity with what the recursive forms derive, and their
# agreement proves something.


HALF = Fraction(1, 2)


@dataclass(frozen=True)
class BodyEnergy:
    """The parts of one body's kinetic energy.

    Args:
        body: its name.
        velocity: of its mass centre, ground axes, 3 [m/s].
        spin: angular velocity, body axes, 3 [rad/s].
        translation: m v.v / 2 [J].
        rotation: w.I w / 2 [J].
    """

    body: str
    velocity: Vector
    spin: Vector
    translation: Scalar
    rotation: Scalar


@dataclass(frozen=True)
class SystemInertia:
    """Kinetic energies of a motion, and the inertia in it that belongs to no body.

    Of a rotor T = armature s'^2 / 2. Of a given T(q, q', t), with p = dT/dq' and q' = N u + nu,

        M = N^T (dp/dq') N,   c = N^T (dp/dt at a = 0 - dT/dq)
    """

    motion: Motion

    @property
    def bodies(self) -> tuple[BodyEnergy, ...]:
        """Kinetic energy of every body, T = m v.v / 2 + w.I w / 2, from derivatives of its pose.

        All poses are differentiated in one sweep, so that a chain costs no more than its length. Where speeds are not
        rates the twists give the energy, in the body's axes: the system over the rates holds that of the poses.
        """
        links, scope = self.motion.links, self.motion.scope
        masses = [scope.mass_properties(link.name) for link in links]
        if any(u.name in scope.model.speeds for u in scope.symbols.u):
            return tuple(_by_twist(link, mass) for link, mass in zip(links, masses, strict=True))
        centers = [link.pose.point(mass.com) for link, mass in zip(links, masses, strict=True)]
        turning = [link.orientation for link in links]
        places = tuple(x for pair in zip(centers, turning, strict=True) for part in pair for x in part)
        rates = iter(scope.time_derivative(places))
        energies = []
        for link, mass, orientation in zip(links, masses, turning, strict=True):
            velocity = Vector((next(rates), next(rates), next(rates)))
            spin = link.spin([next(rates) for _ in orientation])
            translation = HALF * mass.m * (velocity @ velocity)
            rotation = HALF * (spin @ (mass.I @ spin))
            energies.append(BodyEnergy(link.name, velocity, spin, translation, rotation))
        return tuple(energies)

    @property
    def kinetic_energy(self) -> Scalar:
        """T of the whole system [J]."""
        total = self.given_energy
        for link, energy in zip(self.motion.links, self.bodies, strict=True):
            total = total + energy.translation + energy.rotation + self.rotor_energy(link)
        return total

    @property
    def changes(self) -> bool:
        """True if the mass of a body changes."""
        return any(self.motion.scope.mass_rates(link.name) is not None for link in self.motion.links)

    @property
    def carried_momenta(self) -> ScalarRow:
        """sum of m' v . dv/du + w . I' dw/du, with the mass that comes at the velocity of its body.

        The share of d/dt dT/du that is no inertia; 0 where masses are constant.
        """
        total: ScalarRow = (0,) * len(self.motion.scope.symbols.u)
        for energy in self.bodies if self.changes else ():
            for row in self.carried_by(energy):
                total = tuple(x + y for x, y in zip(total, row, strict=True))
        return total

    def carried_by(self, energy: BodyEnergy) -> tuple[ScalarRow, ScalarRow]:
        """(m' v . dv/du, w . I' dw/du) of one body."""
        rate, u = self.motion.scope.mass_rates(energy.body), self.motion.scope.symbols.u
        if rate is None:
            return (0,) * len(u), (0,) * len(u)
        v, w = energy.velocity, energy.spin
        return pullback(v, rate.m * v, u), pullback(w, rate.I @ w, u)

    # -- rotors ------------------------------------------------------------------------------------

    def rotor_energy(self, link: BodyLink) -> Scalar:
        """Energy of rotors behind gears: armature * s'^2 / 2 [J]."""
        if link.joint is None:
            return 0
        total: Scalar = 0
        for effort, rate in zip(link.joint.efforts(), link.s_rate, strict=False):
            if effort is not None and effort.armature is not None:
                total = total + HALF * self.motion.scope.value(effort.armature) * rate * rate
        return total

    @property
    def rotors(self) -> Iterator[tuple[BodyLink, int, Scalar]]:
        """(link, variable of its joint, armature) of each rotor."""
        for link in self.motion.links:
            if link.joint is None:
                continue
            for k, effort in enumerate(link.joint.efforts()):
                if effort is not None and effort.armature is not None:
                    yield link, k, self.motion.scope.value(effort.armature)

    @property
    def added_mass(self) -> list[tuple[int, int, Scalar]]:
        """Entries (k, l, value) that are added to M: armature D_k D_l, and those of given energies."""
        return [*self._rotor_mass, *_given_mass(self.motion)]

    @property
    def _rotor_mass(self) -> Iterator[tuple[int, int, Scalar]]:
        for link, k, armature in self.rotors:
            row = self.motion.joint_row(link.name, k)
            yield from ((i, j, armature * a * b) for i, a in row.items() for j, b in row.items())

    @property
    def added_bias(self) -> list[Scalar]:
        """Terms added to c: armature D_k (d/dt s' at a = 0), and those of given energies at a = 0."""
        return self._rotor_bias(self.given_bias)

    def _rotor_bias(self, given: ScalarRow) -> list[Scalar]:
        scope = self.motion.scope
        c: list[Scalar] = [0] * len(scope.symbols.u)
        for link, k, armature in self.rotors:
            bias = scope.time_derivative((link.s_rate[k],))[0]
            for i, factor in self.motion.joint_row(link.name, k).items():
                c[i] = c[i] + armature * factor * bias
        return [x + y for x, y in zip(c, given, strict=True)]

    # -- given energies ----------------------------------------------------------------------------

    @property
    def given_energy(self) -> Scalar:
        """T of the energies that are given, in the speeds [J]."""
        return sum(self.given_energies.values(), start=0)

    @property
    def given_energies(self) -> dict[str, Scalar]:
        """T of each energy that is given, by the name of its force, in the speeds [J]."""
        w, given = _given_kinetics(self.motion)
        energies = substituted(tuple(given.values()), dict(zip(w, self.motion.scope.rates, strict=True)))
        return dict(zip(given, energies, strict=True))

    @property
    def given_momenta(self) -> ScalarRow:
        """p = dT/dq' of the energies that are given, one for each coordinate."""
        w, T = _given_kinetic(self.motion)
        return substituted(gradient(T, w), dict(zip(w, self.motion.scope.rates, strict=True)))

    @property
    def fluids(self) -> list[tuple[str, BodyPoint, Twist, Wrench]]:
        """(force, place, velocity in the fluid, momentum) of every fluid that moves with a body, in its axes."""
        scenes = (
            (name, force, SystemScene(self.motion, name)) for name, force in self.motion.scope.model.forces.items()
        )
        found = ((name, force.fluid(scene)) for name, force, scene in scenes if force.moving)
        return [(name, *fluid) for name, fluid in found if fluid is not None]

    def beside_bodies(self) -> tuple[list[tuple[int, int, Scalar]], list[Scalar]]:
        """(entries added to M, terms added to c) of what moves with no body: rotors, and energies of coordinates."""
        return [*self._rotor_mass, *_given_mass(self.motion, True)], self._rotor_bias(_given_bias(self.motion, True))

    @property
    def given_bias(self) -> ScalarRow:
        """Share of given energies in c, along each speed."""
        return _given_bias(self.motion)

    @property
    def given_inertia(self) -> ScalarRow:
        """Share of given energies in M a + c, along each speed."""
        scope = self.motion.scope
        taken = list(_given_bias(self.motion))
        for i, j, value in _given_mass(self.motion):
            taken[i] = taken[i] + value * scope.symbols.a[j]
        return tuple(taken)

    # -- about a point -----------------------------------------------------------------------------
    #
    # With r from the point P, over the mass of the bodies that are meant:
    #
    #     tensor    I_P = integral (r.r 1 - r r^T) dm = sum (R I_C R^T + m (d.d 1 - d d^T)),   d = C - P
    #     angular momentum   L_P = sum (R I_C R^T w + m d x v_C)

    def in_ground(self, body: str) -> MassProperties:
        """The mass properties of a body where it is: mass centre from the ground's origin, inertia in ground axes."""
        own, pose = self.motion.scope.mass_properties(body), self.motion.link(body).pose
        return MassProperties(own.m, pose.point(own.com), pose.R @ own.I @ pose.R.T)

    def about(self, point: Vector, bodies: Sequence[str]) -> Matrix:
        """I_P of the bodies together, ground axes."""
        total: Matrix = Matrix.of((Vector.ZERO, Vector.ZERO, Vector.ZERO))
        for body in bodies:
            total = total + self.in_ground(body).about(point)
        return total

    def angular_momentum(self, point: Vector, bodies: Sequence[str]) -> Vector:
        """L_P of the bodies together, of the velocities against the ground, ground axes [kg m^2/s]."""
        total: Vector = Vector.ZERO
        for body in bodies:
            link, mass = self.motion.link(body), self.in_ground(body)
            velocity = self.motion.velocity((body, self.motion.scope.mass_properties(body).com))
            spin = mass.I @ (link.pose.R @ link.twist.w)
            total = total + (spin + mass.m * (mass.com - point).cross(velocity))
        return total

    def flat(self, bodies: Sequence[str]) -> tuple[str, ...]:
        """The bodies of a plane model of which only the moment about z is known: those given by `inertia`."""
        scope = self.motion.scope
        if scope.model.space != "plane":
            return ()
        given = [body for body in bodies if scope.model.bodies[body].inertia is not None]
        return tuple(body for body in given if not is_zero(scope.mass_properties(body).I[2][2]))

    def shapeless(self, bodies: Sequence[str]) -> tuple[str, ...]:
        """Bodies that have a mass but no stated inertia."""
        parts = self.motion.scope.model.bodies
        silent = [b for b in bodies if parts[b].shape is None and parts[b].parts is None and parts[b].inertia is None]
        return tuple(body for body in silent if not is_zero(self.motion.scope.mass_properties(body).m))


def _by_twist(link: BodyLink, mass: MassProperties) -> BodyEnergy:
    """The same from the twist: v_C = v + w x c in body axes."""
    w = link.twist.w
    v = link.twist.at(mass.com).v
    translation = HALF * mass.m * (v @ v)
    return BodyEnergy(link.name, link.pose.R @ v, w, translation, HALF * (w @ (mass.I @ w)))


def _given_kinetic(motion: Motion, placeless: bool = False) -> tuple[tuple[Node, ...], Scalar]:
    """(w, T): the kinetic energy that the model gives, as of `_given_kinetics`."""
    w, given = _given_kinetics(motion, placeless)
    return w, sum(given.values(), start=0)


def _given_kinetics(motion: Motion, placeless: bool = False) -> tuple[tuple[Node, ...], dict[str, Scalar]]:
    """(w, {force: T}): the kinetic energies that the model gives, in names w of the rates of all coordinates.

    Args:
        placeless: those of coordinates alone.
    """
    scope = motion.scope.over_rates
    own = {name: force for name, force in scope.model.forces.items() if force.placeless or not placeless}
    links = Motion(scope, motion.links)
    given = {name: force.kinetic_energy(SystemScene(links, name)) for name, force in own.items()}
    return scope.symbols.u, {name: T for name, T in given.items() if T is not None}


def _given_mass(motion: Motion, placeless: bool = False) -> list[tuple[int, int, Scalar]]:
    (w, T), scope = _given_kinetic(motion, placeless), motion.scope
    if is_zero(T):
        return []
    flat = [x for row in jacobian(gradient(T, w), w) for x in row]
    flat = list(substituted(flat, dict(zip(w, scope.rates, strict=True))))
    H = [flat[k : k + len(w)] for k in range(0, len(flat), len(w))]
    columns = list(zip(*scope.N, strict=True))
    pushed = [[inner(row, column) for row in H] for column in columns]
    entries = ((i, j, inner(a, b)) for i, a in enumerate(columns) for j, b in enumerate(pushed))
    return [entry for entry in entries if not is_zero(entry[2])]


def _given_bias(motion: Motion, placeless: bool = False) -> ScalarRow:
    (w, T), scope = _given_kinetic(motion, placeless), motion.scope
    if is_zero(T):
        return (0,) * len(scope.symbols.u)
    bias = scope.time_derivative(scope.rates)
    momenta = tangent(gradient(T, w), {**scope.flow, **dict(zip(w, bias, strict=True))})
    held = gradient(T, scope.symbols.q)
    rows = [p - x for p, x in zip(momenta, held, strict=True)]
    rows = list(substituted(rows, dict(zip(w, scope.rates, strict=True))))
    return tuple(inner(column, rows) for column in zip(*scope.N, strict=True))
