"""Rigid-body quantities over any scalar: Pose, Twist, Wrench, Inertia, and the vectors they are made of.

A vector is a tuple of three scalars, a rotation a tuple of three rows. `R_AB v_B = v_A`; `p_AB` goes
from A to B in A's axes. A scalar is a float, an exact number, a node of the graph or a sympy
expression; nothing here asks which. A twist has its angular part first; a wrench its torque.
"""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any, ClassVar, overload

from eomgen.frozen import dataclass
from eomgen.symbolic.expression.formula import over, sqrt
from eomgen.symbolic.expression.node import Scalar
from eomgen.symbolic.expression.rational import Fraction


class Vector(tuple[Any, Any, Any]):
    """Three scalars: a + b, a - b, -a, k * a; `a @ b` is the scalar product a . b, `a.cross(b)` is a x b."""

    __slots__ = ()
    __array_ufunc__ = None  # numpy's numbers leave `k * a` to the vector
    ZERO: ClassVar[Vector]

    def __add__(self, other: Vector) -> Vector:  # type: ignore[override]
        return Vector((self[0] + other[0], self[1] + other[1], self[2] + other[2]))

    def __sub__(self, other: Vector) -> Vector:
        return Vector((self[0] - other[0], self[1] - other[1], self[2] - other[2]))

    def __rmul__(self, k: Scalar) -> Vector:  # type: ignore[override]
        return Vector((k * self[0], k * self[1], k * self[2]))

    def __mul__(self, k: Scalar) -> Vector:  # type: ignore[override]
        return k * self

    def __neg__(self) -> Vector:
        return -1 * self

    def __matmul__(self, other: Vector) -> Scalar:
        """a . b; what is multiplied by the number 0 is not looked at."""
        total: Scalar = 0
        for x, y in zip(self, other, strict=True):
            if (type(x) is not int or x != 0) and (type(y) is not int or y != 0):
                total = total + x * y
        return total

    @property
    def length(self) -> Scalar:
        """|a|"""
        return sqrt(self @ self)

    @property
    def unit(self) -> Vector:
        """a / |a|, exactly."""
        square = self @ self
        if square == 1:
            return self
        length = sqrt(square)
        return Vector(over(x, length) for x in self)

    @property
    def largest(self) -> Any:
        """max |x_i|, of numbers."""
        return max(map(abs, self))

    def cross(self, other: Vector) -> Vector:
        """a x b"""
        a, b = self, other
        return Vector((a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]))


class Matrix(tuple[Vector, Vector, Vector]):
    """Three rows of three: A + B, k * A; `R @ a` is the vector R a, `A @ B` the product, `R.T` the transpose."""

    __slots__ = ()
    IDENTITY: ClassVar[Matrix]

    @classmethod
    def of(cls, rows: Iterable[Iterable[Any]]) -> Matrix:
        """The matrix with these three rows of three."""
        first, second, third = (Vector(row) for row in rows)  # each at once: a row may be a generator over what changes
        return cls((first, second, third))

    @classmethod
    def rotation(cls, axis: Vector, cosine: Scalar, sine: Scalar) -> Matrix:
        """Rotation about a unit axis n (Rodrigues): R = c 1 + s n~ + (1 - c) n n^T."""
        x, y, z = axis
        k = 1 - cosine
        return cls.of(
            (
                (cosine + k * x * x, k * x * y - sine * z, k * x * z + sine * y),
                (k * x * y + sine * z, cosine + k * y * y, k * y * z - sine * x),
                (k * x * z - sine * y, k * y * z + sine * x, cosine + k * z * z),
            )
        )

    @property
    def T(self) -> Matrix:
        """R^T, the inverse of a rotation."""
        return Matrix(Vector(each) for each in zip(*self, strict=True))

    def __add__(self, other: Matrix) -> Matrix:  # type: ignore[override]
        return Matrix((self[0] + other[0], self[1] + other[1], self[2] + other[2]))

    def __rmul__(self, k: Scalar) -> Matrix:  # type: ignore[override]
        return Matrix((k * self[0], k * self[1], k * self[2]))

    def __mul__(self, k: Scalar) -> Matrix:  # type: ignore[override]
        return k * self

    @overload
    def __matmul__(self, other: Matrix) -> Matrix: ...
    @overload
    def __matmul__(self, other: Vector) -> Vector: ...
    def __matmul__(self, other: Matrix | Vector) -> Matrix | Vector:
        """R a, or A B: what is not turned comes back as it is."""
        if self is Matrix.IDENTITY:
            return other
        if not isinstance(other, Matrix):
            return Vector((self[0] @ other, self[1] @ other, self[2] @ other))
        a, b, c = other.T
        return Matrix(Vector((row @ a, row @ b, row @ c)) for row in self)


Vector.ZERO = Vector((0, 0, 0))
Matrix.IDENTITY = Matrix.of(((1, 0, 0), (0, 1, 0), (0, 0, 1)))


@dataclass(frozen=True)
class Pose:
    """Position and orientation of frame B in frame A.

    Args:
        R: rotation R_AB, 3 x 3.
        p: p_AB, from A to B in A's axes, 3 [m].
    """

    R: Matrix = Matrix.IDENTITY
    p: Vector = Vector.ZERO

    def then(self, other: Pose) -> Pose:
        """The pose of C in A, from B in A (self) and C in B (other)."""
        return Pose(self.R @ other.R, self.p + self.R @ other.p)

    def point(self, p_B: Vector) -> Vector:
        """A point given in B, seen from A [m]."""
        return self.p + self.R @ p_B

    def inverse(self) -> Pose:
        """The pose of A in B."""
        R_BA = self.R.T
        return Pose(R_BA, -(R_BA @ self.p))


@dataclass(frozen=True)
class Twist:
    """Velocity of a rigid body, at one of its points.

    Args:
        w: angular velocity, 3 [rad/s].
        v: velocity of the point, 3 [m/s].
    """

    w: Vector = Vector.ZERO
    v: Vector = Vector.ZERO

    def at(self, r: Vector) -> Twist:
        """The same motion at the point r away: v + w x r."""
        return Twist(self.w, self.v + self.w.cross(r))

    def plus(self, other: Twist) -> Twist:
        return Twist(self.w + other.w, self.v + other.v)

    def turned(self, R: Matrix) -> Twist:
        """The same twist in the axes to which R leads."""
        return Twist(R @ self.w, R @ self.v)

    def power(self, wrench: Wrench) -> Scalar:
        """tau . w + f . v, both at the same point and in the same axes [W]."""
        return wrench.tau @ self.w + wrench.f @ self.v


@dataclass(frozen=True)
class Wrench:
    """Force and couple on a rigid body, at one of its points.

    Args:
        tau: moment about the point, 3 [N m].
        f: force, 3 [N].
    """

    tau: Vector = Vector.ZERO
    f: Vector = Vector.ZERO

    def moved(self, r: Vector) -> Wrench:
        """The same loading about the point from which the present one is r away: tau + r x f."""
        return Wrench(self.tau + r.cross(self.f), self.f)

    def plus(self, other: Wrench) -> Wrench:
        return Wrench(self.tau + other.tau, self.f + other.f)

    def turned(self, R: Matrix) -> Wrench:
        """The same wrench in the axes to which R leads."""
        return Wrench(R @ self.tau, R @ self.f)


@dataclass(frozen=True)
class SpatialInertia:
    """Mass properties of a rigid body about its frame's origin, in its axes.

    Args:
        m: mass [kg].
        h: first moment m p_com, 3 [kg m].
        I: inertia about the origin, 3 x 3 [kg m^2].
    """

    m: Scalar
    h: Vector
    I: Matrix

    @staticmethod
    def about_center(m: Scalar, com: Vector, I_com: Matrix) -> SpatialInertia:
        """Spatial inertia from the inertia about the mass centre: I = I_com + m (c.c 1 - c c^T) (parallel axes)."""
        h = m * com
        shift = Matrix.of(((h @ com if i == j else 0) - h[i] * com[j] for j in range(3)) for i in range(3))
        return SpatialInertia(m, h, I_com + shift)

    def momentum(self, xi: Twist) -> Wrench:
        """I xi: angular momentum about the origin and linear momentum.

        L = I w + h x v,  P = m v + w x h
        """
        return Wrench(
            self.I @ xi.w + self.h.cross(xi.v),
            self.m * xi.v + xi.w.cross(self.h),
        )

    def kinetic_energy(self, xi: Twist) -> Scalar:
        """T = (m v.v + w.I w) / 2 + w.(h x v) [J], the twist at the origin in body axes."""
        momentum = self.momentum(xi)
        return Fraction(1, 2) * xi.power(momentum)
