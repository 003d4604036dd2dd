"""Scope -> mass properties and energies of motion, of bodies and of rotors."""

from __future__ import annotations

from collections.abc import Iterator

from eomgen.errors import ModelError
from eomgen.frozen import dataclass
from eomgen.mechanics.kinematics.motion import BodyLink, Motion, made_of, spin_between
from eomgen.mechanics.kinematics.symbols import Scope
from eomgen.model import MassProperties
from eomgen.symbolic.expression import (
    ZERO,
    Expression,
    Fraction,
    Matrix,
    Scalar,
    ScalarRow,
    Vector,
    apply,
    derivative,
    dot,
    gradient,
    inner,
    is_zero,
    jacobian,
    matrix_of,
    substituted,
    symbols_of,
    tangent,
)

# -------- inertia ---------------------------------------------------------------------------------------------
# Scope -> mass properties and energies of motion.
#
# The kinetic energy here is built on derivatives of the poses, not on the twists of the recursion: v_C = d/dt p_C and
# w~ = R^T R'. So what Lagrange's method derives shares no velocity with what the recursive forms derive, and their
# agreement proves something.


HALF = Fraction(1, 2)


def mass_properties(scope: Scope, body: str) -> MassProperties:
    """Mass properties of one body; a body without mass has zeros.

    Raises:
        ModelError: a body that can turn has a mass and no inertia.
    """
    part = scope.model.bodies[body]
    if part.parts is not None:
        return made_of(scope, body).whole
    if part.shape is not None:
        return part.shape.mass_properties(scope.value)
    m = scope.value(part.mass)
    return MassProperties(m, scope.vector(part.center), _inertia(scope, body, part.inertia))


def _inertia(scope: Scope, body: str, inertia: tuple[Expression, ...] | None) -> Matrix:
    if inertia is None:
        return (ZERO, ZERO, ZERO)
    values = [scope.value(e) for e in inertia]
    if len(values) == 1:
        return (ZERO, ZERO, (0, 0, values[0]))
    if len(values) not in (3, 6):
        raise ModelError(
            f"the inertia of body '{body}' has {len(values)} values",
            f"bodies.{body}.inertia",
            fix="give 1, 3 or 6 of them",
        )
    xx, yy, zz, xy, yz, xz = (*values, 0, 0, 0)[:6] if len(values) == 3 else values
    return ((xx, xy, xz), (xy, yy, yz), (xz, yz, zz))


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


def body_energies(motion: Motion) -> tuple[BodyEnergy, ...]:
    """Kinetic energy of every body, T = m v.v / 2 + w.I w / 2, from derivatives of its pose.

    All poses are differentiated in one sweep, so that a chain costs no more than its length. Where speeds are not
    rates the twists give the energy, in the body's axes: the system over the rates holds that of the poses.
    """
    masses = [mass_properties(motion.scope, link.name) for link in motion.links]
    if any(u.name in motion.scope.model.speeds for u in motion.scope.symbols.u):
        return tuple(_by_twist(link, mass) for link, mass in zip(motion.links, masses, strict=True))
    centers = [link.pose.point(mass.com) for link, mass in zip(motion.links, masses, strict=True)]
    turning = [_orientation(link) for link in motion.links]
    places = tuple(x for pair in zip(centers, turning, strict=True) for part in pair for x in part)
    rates = iter(motion.scope.time_derivative(places))
    energies = []
    for link, mass, orientation in zip(motion.links, masses, turning, strict=True):
        velocity = (next(rates), next(rates), next(rates))
        spin = _spin(link, [next(rates) for _ in orientation])
        translation = HALF * mass.m * dot(velocity, velocity)
        rotation = HALF * dot(spin, apply(mass.I, spin))
        energies.append(BodyEnergy(link.name, velocity, spin, translation, rotation))
    return tuple(energies)


def _by_twist(link: BodyLink, mass: MassProperties) -> BodyEnergy:
    """The same from the twist: v_C = v + w x c in body axes."""
    w = link.twist.w
    v = link.twist.at(mass.com).v
    translation = HALF * mass.m * dot(v, v)
    return BodyEnergy(link.name, apply(link.pose.R, v), w, translation, HALF * dot(w, apply(mass.I, w)))


def _orientation(link: BodyLink) -> tuple[Scalar, ...]:
    """Orientation of a body: its angle in the plane, the entries of its rotation matrix in space."""
    return (link.angle,) if link.angle is not None else tuple(x for row in link.pose.R for x in row)


def _spin(link: BodyLink, rates: list[Scalar]) -> Vector:
    """Angular velocity in body axes from the rates of the orientation [rad/s]."""
    if link.angle is not None:
        return (0, 0, rates[0])
    return spin_between(link.pose.R, matrix_of((rates[0:3], rates[3:6], rates[6:9])))


def spin_of(motion: Motion, link: BodyLink) -> Vector:
    """Angular velocity of one body in body axes, from the derivative of its pose [rad/s]."""
    return _spin(link, list(motion.scope.time_derivative(_orientation(link))))


def armature_energy(motion: Motion, link: BodyLink) -> Scalar:
    """Energy of rotors behind gears: armature * s'^2 / 2 [J]."""
    if link.joint is None:
        return 0
    total: Scalar = 0
    for effort, rate in zip(link.joint.efforts(), link.s_rate, strict=False):
        if effort is not None and effort.armature is not None:
            total = total + HALF * motion.scope.value(effort.armature) * rate * rate
    return total


def kinetic_energy(motion: Motion) -> Scalar:
    """T of the whole system [J]."""
    total = given_energy(motion.scope)
    for link, energy in zip(motion.links, body_energies(motion), strict=True):
        total = total + energy.translation + energy.rotation + armature_energy(motion, link)
    return total


# -------- armature --------------------------------------------------------------------------------------------
# Inertia that belongs to no body, added to M and c: rotors behind gears, and kinetic energies that are given.
#
# Of a rotor T = armature s'^2 / 2. Of a given T(q, q', t), with p = dT/dq' and q' = N u + nu,
#
#     M = N^T (dp/dq') N,   c = N^T (dp/dt at a = 0 - dT/dq)


def joint_row(motion: Motion, body: str, variable: int) -> dict[int, Scalar]:
    """Row of D: how the joint's rate depends on each speed."""
    rate = motion.link(body).s_rate[variable]
    speeds = {u: k for k, u in enumerate(motion.scope.symbols.u)}
    return {speeds[s]: derivative(rate, s) for s in symbols_of((rate,)) if s in speeds}


def armature_mass(motion: Motion) -> list[tuple[int, int, Scalar]]:
    """Entries (k, l, value) that are added to M: armature D_k D_l, and those of given energies."""
    rows = []
    for link, k, armature in armatures(motion):
        row = joint_row(motion, link.name, k)
        rows += [(i, j, armature * a * b) for i, a in row.items() for j, b in row.items()]
    return [*rows, *_given_mass(motion.scope)]


def armature_bias(motion: Motion, size: int) -> list[Scalar]:
    """Terms added to c: armature D_k (d/dt s' at a = 0), and those of given energies at a = 0."""
    c: list[Scalar] = [0] * size
    for link, k, armature in armatures(motion):
        bias = motion.scope.time_derivative((link.s_rate[k],))[0]
        for i, factor in joint_row(motion, link.name, k).items():
            c[i] = c[i] + armature * factor * bias
    return [x + y for x, y in zip(c, _given_bias(motion.scope), strict=True)]


def armatures(motion: Motion) -> Iterator[tuple[BodyLink, int, Scalar]]:
    for link in motion.links:
        if link.joint is None:
            continue
        for k, effort in enumerate(link.joint.efforts()):
            if effort is not None and effort.armature is not None:
                yield link, k, motion.scope.value(effort.armature)


def given_energy(scope: Scope) -> Scalar:
    """T of the energies that are given, in the speeds [J]."""
    w, T = scope.given_kinetic
    return substituted((T,), dict(zip(w, scope.rates, strict=True)))[0]


def given_momenta(scope: Scope) -> ScalarRow:
    """p = dT/dq' of the energies that are given, one for each coordinate."""
    w, T = scope.given_kinetic
    return substituted(gradient(T, w), dict(zip(w, scope.rates, strict=True)))


def given_inertia(scope: Scope) -> ScalarRow:
    """Share of given energies in M a + c, along each speed."""
    taken = list(_given_bias(scope))
    for i, j, value in _given_mass(scope):
        taken[i] = taken[i] + value * scope.symbols.a[j]
    return tuple(taken)


def _given_mass(scope: Scope) -> list[tuple[int, int, Scalar]]:
    w, T = scope.given_kinetic
    if is_zero(T):
        return []
    flat = [x for row in jacobian(gradient(T, w), w) for x in row]
    flat = list(substituted(flat, dict(zip(w, scope.rates, strict=True))))
    H = [flat[k : k + len(w)] for k in range(0, len(flat), len(w))]
    columns = list(zip(*scope.N, strict=True))
    pushed = [[inner(row, column) for row in H] for column in columns]
    entries = ((i, j, inner(a, b)) for i, a in enumerate(columns) for j, b in enumerate(pushed))
    return [entry for entry in entries if not is_zero(entry[2])]


def _given_bias(scope: Scope) -> ScalarRow:
    w, T = scope.given_kinetic
    if is_zero(T):
        return (0,) * len(scope.symbols.u)
    bias = scope.time_derivative(scope.rates)
    momenta = tangent(gradient(T, w), {**scope.flow, **dict(zip(w, bias, strict=True))})
    held = gradient(T, scope.symbols.q)
    rows = [p - x for p, x in zip(momenta, held, strict=True)]
    rows = list(substituted(rows, dict(zip(w, scope.rates, strict=True))))
    return tuple(inner(column, rows) for column in zip(*scope.N, strict=True))
