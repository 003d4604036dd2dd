"""Rigid-body quantities over any scalar: Pose, Twist, Wrench, Inertia, and the vectors they are made of.

A vector is a tuple of three scalars, a rotation a tuple of three rows. `R_AB v_B = v_A`; `p_AB` goes
from A to B in A's axes. A scalar is a float, an exact number, a node of the graph or a sympy
expression; nothing here asks which. A twist has its angular part first; a wrench its torque.
"""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any

from eomgen.frozen import dataclass
from eomgen.symbolic.expression.node import Scalar
from eomgen.symbolic.expression.rational import Fraction

AnyScalar = Scalar
Vector = tuple[AnyScalar, AnyScalar, AnyScalar]
Matrix = tuple[Vector, Vector, Vector]
Numbers = tuple[Any, Any, Any]  # a vector at one state: floats, or numbers of fifty digits

ZERO: Vector = (0, 0, 0)
IDENTITY: Matrix = ((1, 0, 0), (0, 1, 0), (0, 0, 1))


def vector_of(components: Iterable[AnyScalar]) -> Vector:
    """The vector with these three components."""
    x, y, z = components
    return (x, y, z)


def matrix_of(rows: Iterable[Iterable[AnyScalar]]) -> Matrix:
    """The matrix with these three rows of three."""
    first, second, third = (vector_of(row) for row in rows)
    return (first, second, third)


def dot(a: Vector, b: Vector) -> AnyScalar:
    """a . b; what is multiplied by the number 0 is not looked at."""
    total: AnyScalar = 0
    for x, y in zip(a, b, strict=True):
        if (type(x) is not int or x != 0) and (type(y) is not int or y != 0):
            total = total + x * y
    return total


def cross(a: Vector, b: Vector) -> Vector:
    """a x b"""
    return (a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0])


def plus(a: Vector, b: Vector) -> Vector:
    """a + b"""
    return (a[0] + b[0], a[1] + b[1], a[2] + b[2])


def minus(a: Vector, b: Vector) -> Vector:
    """a - b"""
    return (a[0] - b[0], a[1] - b[1], a[2] - b[2])


def times(k: AnyScalar, a: Vector) -> Vector:
    """k a"""
    return (k * a[0], k * a[1], k * a[2])


def apply(R: Matrix, a: Vector) -> Vector:
    """R a"""
    return (dot(R[0], a), dot(R[1], a), dot(R[2], a))


def in_turned_axes(R: Matrix, a: Vector) -> Vector:
    """R a; a itself where nothing is turned."""
    return a if R is IDENTITY else apply(R, a)


def transposed(R: Matrix) -> Matrix:
    """R^T, the inverse of a rotation."""
    return ((R[0][0], R[1][0], R[2][0]), (R[0][1], R[1][1], R[2][1]), (R[0][2], R[1][2], R[2][2]))


def product(A: Matrix, B: Matrix) -> Matrix:
    """A B"""
    columns = transposed(B)
    return matrix_of((dot(row, column) for column in columns) for row in A)


def added(A: Matrix, B: Matrix) -> Matrix:
    """A + B"""
    return (plus(A[0], B[0]), plus(A[1], B[1]), plus(A[2], B[2]))


def rotation(axis: Vector, cosine: AnyScalar, sine: AnyScalar) -> Matrix:
    """Rotation about a unit axis n (Rodrigues): R = c 1 + s n~ + (1 - c) n n^T."""
    x, y, z = axis
    k = 1 - cosine
    return (
        (cosine + k * x * x, k * x * y - sine * z, k * x * z + sine * y),
        (k * x * y + sine * z, cosine + k * y * y, k * y * z - sine * x),
        (k * x * z - sine * y, k * y * z + sine * x, cosine + k * z * z),
    )


@dataclass(frozen=True)
class Pose:
    """Position and orientation of frame B in frame A.

    Args:
        R: rotation R_AB, 3 x 3.
        p: p_AB, from A to B in A's axes, 3 [m].
    """

    R: Matrix = IDENTITY
    p: Vector = ZERO

    def then(self, other: Pose) -> Pose:
        """The pose of C in A, from B in A (self) and C in B (other)."""
        return Pose(product(self.R, other.R), plus(self.p, apply(self.R, other.p)))

    def point(self, p_B: Vector) -> Vector:
        """A point given in B, seen from A [m]."""
        return plus(self.p, apply(self.R, p_B))

    def inverse(self) -> Pose:
        """The pose of A in B."""
        R_BA = transposed(self.R)
        return Pose(R_BA, times(-1, apply(R_BA, self.p)))


@dataclass(frozen=True)
class Twist:
    """Velocity of a rigid body, at one of its points.

    Args:
        w: angular velocity, 3 [rad/s].
        v: velocity of the point, 3 [m/s].
    """

    w: Vector = ZERO
    v: Vector = ZERO

    def at(self, r: Vector) -> Twist:
        """The same motion at the point r away: v + w x r."""
        return Twist(self.w, plus(self.v, cross(self.w, r)))

    def plus(self, other: Twist) -> Twist:
        return Twist(plus(self.w, other.w), plus(self.v, other.v))

    def turned(self, R: Matrix) -> Twist:
        """The same twist in the axes to which R leads."""
        return Twist(apply(R, self.w), apply(R, self.v))

    def power(self, wrench: Wrench) -> AnyScalar:
        """tau . w + f . v, both at the same point and in the same axes [W]."""
        return dot(wrench.tau, self.w) + dot(wrench.f, self.v)


@dataclass(frozen=True)
class Wrench:
    """Force and couple on a rigid body, at one of its points.

    Args:
        tau: moment about the point, 3 [N m].
        f: force, 3 [N].
    """

    tau: Vector = ZERO
    f: Vector = ZERO

    def moved(self, r: Vector) -> Wrench:
        """The same loading about the point from which the present one is r away: tau + r x f."""
        return Wrench(plus(self.tau, cross(r, self.f)), self.f)

    def plus(self, other: Wrench) -> Wrench:
        return Wrench(plus(self.tau, other.tau), plus(self.f, other.f))

    def turned(self, R: Matrix) -> Wrench:
        """The same wrench in the axes to which R leads."""
        return Wrench(apply(R, self.tau), apply(R, self.f))


@dataclass(frozen=True)
class SpatialInertia:
    """Mass properties of a rigid body about its frame's origin, in its axes.

    Args:
        m: mass [kg].
        h: first moment m p_com, 3 [kg m].
        I: inertia about the origin, 3 x 3 [kg m^2].
    """

    m: AnyScalar
    h: Vector
    I: Matrix

    @staticmethod
    def about_center(m: AnyScalar, com: Vector, I_com: Matrix) -> SpatialInertia:
        """Spatial inertia from the inertia about the mass centre: I = I_com + m (c.c 1 - c c^T) (parallel axes)."""
        h = times(m, com)
        shift = matrix_of(((dot(h, com) if i == j else 0) - h[i] * com[j] for j in range(3)) for i in range(3))
        return SpatialInertia(m, h, added(I_com, shift))

    def momentum(self, xi: Twist) -> Wrench:
        """I xi: angular momentum about the origin and linear momentum.

        L = I w + h x v,  P = m v + w x h
        """
        return Wrench(
            plus(apply(self.I, xi.w), cross(self.h, xi.v)),
            plus(times(self.m, xi.v), cross(xi.w, self.h)),
        )

    def kinetic_energy(self, xi: Twist) -> AnyScalar:
        """T = (m v.v + w.I w) / 2 + w.(h x v) [J], the twist at the origin in body axes."""
        momentum = self.momentum(xi)
        return Fraction(1, 2) * xi.power(momentum)
