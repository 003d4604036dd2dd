"""System -> moments of inertia of bodies about points, axes and planes, and angular momenta, in ground axes.

With r from the point P, over the mass of the bodies that are meant:

    tensor    I_P = integral (r.r 1 - r r^T) dm = sum (R I_C R^T + m (d.d 1 - d d^T)),   d = C - P   (parallel axes)
    axis      n.I_P n,  n a unit vector along it         point    integral r.r dm = tr(I_P) / 2
    product   + integral x y dm = -I_xy                  plane    integral x^2 dm = tr(I_P) / 2 - I_xx
    angular momentum   L_P = sum (R I_C R^T w + m d x v_C)

The tensor's products carry a minus, those of the textbooks a plus; no function gives both.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass

from eomgen.errors import DerivationError
from eomgen.mechanics.bodies.composition import made_of
from eomgen.mechanics.bodies.inertia import mass_properties
from eomgen.mechanics.bodies.kinematics import Motion, velocity_of
from eomgen.mechanics.masses.principal import principal_moments
from eomgen.model.composite import about
from eomgen.model.shapes import MassProperties
from eomgen.symbolic.expression.expressions import Call, Expression, Reference
from eomgen.symbolic.expression.functions import over
from eomgen.symbolic.expression.graph import Scalar, is_zero
from eomgen.symbolic.expression.rational import Fraction
from eomgen.symbolic.expression.spatial import (
    IDENTITY,
    ZERO,
    Matrix,
    Vector,
    added,
    apply,
    cross,
    dot,
    matrix_of,
    minus,
    plus,
    product,
    times,
    transposed,
)

HALF = Fraction(1, 2)
AXES = {"x": 0, "y": 1, "z": 2}
AtPlace = Callable[[Sequence[Scalar]], Sequence[Scalar]]
"""The scalars of the state at which something is asked."""


def in_ground(motion: Motion, body: str) -> MassProperties:
    """The mass properties of a body where it is: mass centre from the ground's origin, inertia in ground axes."""
    own, pose = mass_properties(motion.scope, body), motion.link(body).pose
    return MassProperties(own.m, pose.point(own.com), product(product(pose.R, own.I), transposed(pose.R)))


def tensor_about(motion: Motion, point: Vector, bodies: Sequence[str]) -> Matrix:
    """I_P of the bodies together, ground axes."""
    total: Matrix = (ZERO, ZERO, ZERO)
    for body in bodies:
        total = added(total, about(in_ground(motion, body), point))
    return total


def about_axis(I: Matrix, along: Vector) -> Scalar:
    """d.I d / d.d, the moment about the axis through the tensor's point in the direction d, of any length."""
    return over(dot(along, apply(I, along)), dot(along, along))


def polar(I: Matrix) -> Scalar:
    """About the point itself: the integral of r.r dm = tr(I) / 2."""
    return HALF * (I[0][0] + I[1][1] + I[2][2])


def second_moments(I: Matrix) -> Matrix:
    """P = tr(I) / 2 - I, the integrals of x_i x_j dm: moments about planes, and the textbook's products with a plus."""
    half = polar(I)
    return matrix_of(((half if i == j else 0) - I[i][j] for j in range(3)) for i in range(3))


def angular_momentum(motion: Motion, point: Vector, bodies: Sequence[str]) -> Vector:
    """L_P of the bodies together, of the velocities against the ground, ground axes [kg m^2/s]."""
    total: Vector = ZERO
    for body in bodies:
        link, mass = motion.link(body), in_ground(motion, body)
        velocity = velocity_of(motion, (body, mass_properties(motion.scope, body).com))
        spin = apply(mass.I, apply(link.pose.R, link.twist.w))
        total = plus(total, plus(spin, times(mass.m, cross(minus(mass.com, point), velocity))))
    return total


# -- what is not known ------------------------------------------------------------------------------


def flat_bodies(motion: Motion, bodies: Sequence[str]) -> tuple[str, ...]:
    """The bodies of a plane model of which only the moment about z is known: those given by `inertia`."""
    scope = motion.scope
    if scope.model.space != "plane":
        return ()
    given = [body for body in bodies if scope.model.bodies[body].inertia is not None]
    return tuple(body for body in given if not is_zero(mass_properties(scope, body).I[2][2]))


def shapeless(motion: Motion, bodies: Sequence[str]) -> tuple[str, ...]:
    """The bodies that have a mass and say nothing of its inertia."""
    parts = motion.scope.model.bodies
    silent = [b for b in bodies if parts[b].shape is None and parts[b].parts is None and parts[b].inertia is None]
    return tuple(body for body in silent if not is_zero(mass_properties(motion.scope, body).m))


def _refuse_unknown(call: Call, motion: Motion, bodies: Sequence[str], flat: bool) -> None:
    """What is asked must be known of the bodies.

    Args:
        flat: the moments about z are enough.
    Raises:
        DerivationError: naming a body of which it is not known.
    """
    if unknown := shapeless(motion, bodies):
        raise DerivationError(
            f"'{call}': body '{unknown[0]}' has a mass and no inertia",
            f"bodies.{unknown[0]}",
            "give 'inertia' (0 for a point), or a shape",
        )
    if not flat and (unknown := flat_bodies(motion, bodies)):
        what = f"'{call}': of body '{unknown[0]}' only the moment about z is known, its 'inertia'"
        raise DerivationError(what, f"bodies.{unknown[0]}", "give it a shape, or parts")


# -- the functions of the outputs -------------------------------------------------------------------


@dataclass(frozen=True)
class Asked:
    """One function at its arguments: the point, the words or numbers after it, and the bodies.

    Args:
        here: puts the values of the state in, where one is given.
    """

    call: Call
    motion: Motion
    here: AtPlace

    @property
    def point(self) -> Vector:
        return self.position(0)

    def position(self, k: int) -> Vector:
        """Where the point is that the k-th argument names."""
        return self.motion.position(self.motion.place(self.name(k)))

    def name(self, k: int) -> str:
        argument = self.call.args[k]
        if not isinstance(argument, Reference):
            raise DerivationError(f"'{self.call}': a name is needed, not '{argument.text}'")
        return argument.name

    def axis(self, k: int) -> int:
        return AXES[self.name(k)]

    def number(self, k: int, most: int) -> int:
        argument = self.call.args[k]
        number = argument.literal if isinstance(argument, Expression) else None
        if not isinstance(number, int) or not 1 <= number <= most:
            raise DerivationError(f"'{self.call}': a number from 1 to {most} is needed, not '{argument}'")
        return number

    def bodies(self, first: int) -> tuple[str, ...]:
        """The bodies from the argument `first` on; without any, all of them."""
        named = tuple(self.name(k) for k in range(first, len(self.call.args)))
        if len(set(named)) < len(named):
            raise DerivationError(f"'{self.call}' names a body twice")
        if "ground" in named:
            raise DerivationError(f"'{self.call}': the ground has no mass")
        return named or tuple(link.name for link in self.motion.links)

    def tensor(self, first: int, flat: bool = False) -> Matrix:
        """I_P of the bodies from the argument `first` on."""
        bodies = self.bodies(first)
        _refuse_unknown(self.call, self.motion, bodies, flat)
        flat_entries = [x for row in tensor_about(self.motion, self.point, bodies) for x in row]
        entries = list(self.here(flat_entries))
        return matrix_of((entries[0:3], entries[3:6], entries[6:9]))

    def direction(self, k: int) -> Vector:
        """Along x, y or z, or from the point to another one."""
        if self.name(k) in AXES:
            return IDENTITY[self.axis(k)]
        x, y, z = self.here(minus(self.position(k), self.point))
        if all(is_zero(c) for c in (x, y, z)):
            raise DerivationError(f"'{self.call}': both points are in one place, so they are on no single axis")
        return (x, y, z)


def _axis(asked: Asked) -> Scalar:
    along = asked.direction(1)
    return about_axis(asked.tensor(2, flat=is_zero(along[0]) and is_zero(along[1])), along)


def _point(asked: Asked) -> Scalar:
    """A body of the plane that is given by its moment about z counts as thin: its I_xx + I_yy is I_zz."""
    thin = flat_bodies(asked.motion, asked.bodies(1))
    missing = HALF * sum(mass_properties(asked.motion.scope, body).I[2][2] for body in thin)
    return polar(asked.tensor(1, flat=True)) + missing


def _plane(asked: Asked) -> Scalar:
    return second_moments(asked.tensor(2))[asked.axis(1)][asked.axis(1)]


def _product(asked: Asked) -> Scalar:
    return second_moments(asked.tensor(3))[asked.axis(1)][asked.axis(2)]


def _tensor(asked: Asked) -> Scalar:
    i, j = asked.axis(1), asked.axis(2)
    return asked.tensor(3, flat=i == j == 2)[i][j]


def _principal(asked: Asked) -> Scalar:
    return principal_moments(asked.tensor(2), asked.motion.scope)[asked.number(1, 3) - 1]


def _mass(asked: Asked) -> Scalar:
    """Of a body, or of one of its parts (positive for a hole: what it takes away)."""
    body = asked.name(0)
    if body == "ground":
        raise DerivationError(f"'{asked.call}': the ground has no mass")
    if len(asked.call.args) == 1:
        whole: Scalar = mass_properties(asked.motion.scope, body).m
        return whole
    parts = asked.motion.scope.model.bodies[body].parts
    if parts is None:
        raise DerivationError(f"'{asked.call}': body '{body}' is not made of parts", mend=f"write mass_of({body})")
    part: Scalar = made_of(asked.motion.scope, body).pieces[asked.number(1, len(parts)) - 1].mass.m
    return part


def _momentum(axis: int) -> Callable[[Asked], Scalar]:
    def component(asked: Asked) -> Scalar:
        bodies = asked.bodies(1)
        turning = [b for b in bodies if any(not is_zero(w) for w in asked.motion.link(b).twist.w)]
        _refuse_unknown(asked.call, asked.motion, turning, flat=axis == 2)
        return angular_momentum(asked.motion, asked.point, bodies)[axis]

    return component


FUNCTIONS: dict[str, Callable[[Asked], Scalar]] = {
    "inertia_point": _point,
    "inertia_axis": _axis,
    "inertia_plane": _plane,
    "inertia_product": _product,
    "inertia_tensor": _tensor,
    "principal_moment": _principal,
    "mass_of": _mass,
    **{f"angular_momentum_{name}": _momentum(k) for name, k in AXES.items()},
}
"""Functions of the outputs, by name."""
