"""Pose, Twist, Wrench and Inertia run unchanged over floats, fractions, the graph and sympy, with the same values."""

from __future__ import annotations

from collections.abc import Iterator
from fractions import Fraction
from random import Random
from typing import Any

import pytest
import sympy
from each import each

from eomgen.symbolic.expression.graph import Graph
from eomgen.symbolic.expression.spatial import Matrix, Pose, SpatialInertia, Twist, Vector, Wrench
from eomgen.symbolic.numeric.evaluation import evaluate, fifty_digits


class Exact:
    """Numbers as fractions: what the other arithmetics are measured against."""

    def __init__(self, seed: int = 1) -> None:
        self.rng = Random(seed)

    def scalar(self, number: Fraction) -> Any:
        return number

    def value(self, scalar: Any) -> float:
        return float(scalar)

    def draw(self) -> Any:
        return self.scalar(Fraction(self.rng.randint(-20, 20), self.rng.randint(1, 9)))

    def vector(self) -> Vector:
        return Vector(self.draw() for _ in range(3))

    def rotation(self) -> Matrix:
        """About a random axis of rational unit length, by an angle whose sine and cosine are rational."""
        *n, length = self.rng.choice(((2, 3, 6, 7), (1, 2, 2, 3), (4, 4, 7, 9), (2, -6, 9, 11), (-8, 1, 4, 9)))
        a, b, c = self.rng.choice(((3, 4, 5), (-5, 12, 13), (8, -15, 17)))
        axis = Vector(self.scalar(Fraction(x, length)) for x in n)
        return Matrix.rotation(axis, self.scalar(Fraction(a, c)), self.scalar(Fraction(b, c)))

    def pose(self) -> Pose:
        return Pose(self.rotation(), self.vector())

    def twist(self) -> Twist:
        return Twist(self.vector(), self.vector())

    def wrench(self) -> Wrench:
        return Wrench(self.vector(), self.vector())

    def values(self, nested: Any) -> Any:
        if isinstance(nested, tuple):
            return tuple(self.values(x) for x in nested)
        return self.value(nested)


class Floats(Exact):
    """Double precision."""

    def scalar(self, number: Fraction) -> Any:
        return float(number)


class Nodes(Exact):
    """A symbol of the graph for every number; its value is put in at the end."""

    def __init__(self, seed: int = 1) -> None:
        super().__init__(seed)
        self.graph, self.state = Graph(), {}

    def scalar(self, number: Fraction) -> Any:
        symbol = self.graph.symbol(f"x{len(self.state)}")
        self.state[symbol] = fifty_digits().number(number)
        return symbol

    def value(self, scalar: Any) -> float:
        return float(evaluate((scalar,), self.state, fifty_digits())[0])


class Sympy(Exact):
    """A sympy symbol for every number."""

    def __init__(self, seed: int = 1) -> None:
        super().__init__(seed)
        self.state: dict[sympy.Symbol, sympy.Rational] = {}

    def scalar(self, number: Fraction) -> Any:
        symbol = sympy.Symbol(f"x{len(self.state)}")
        self.state[symbol] = sympy.Rational(number.numerator, number.denominator)
        return symbol

    def value(self, scalar: Any) -> float:
        return float(sympy.sympify(scalar).xreplace(self.state))


ARITHMETICS = (Exact, Floats, Nodes, Sympy)


@pytest.fixture(params=ARITHMETICS, ids=lambda kind: kind.__name__)
def world(request) -> Iterator[Exact]:
    yield request.param()


def same(world: Exact, a: Any, b: Any) -> bool:
    """Whether two nested tuples of scalars have the same values, to 1e-12."""
    left, right = flat(world.values(a)), flat(world.values(b))
    return left == pytest.approx(right, rel=1e-12, abs=1e-10)


def flat(nested: Any) -> list[float]:
    return [y for x in nested for y in flat(x)] if isinstance(nested, tuple) else [nested]


def parts(of: Pose | Twist | Wrench) -> tuple[Any, Any]:
    """The two halves of a pose, twist or wrench."""
    if isinstance(of, Pose):
        return of.R, of.p
    return (of.w, of.v) if isinstance(of, Twist) else (of.tau, of.f)


def test_a_rotation_matrix_is_orthonormal_and_right_handed(world):
    """R R^T = 1, det R = +1."""
    R = world.rotation()
    assert same(world, R @ R.T, Matrix.IDENTITY)
    assert same(world, R[0] @ R[1].cross(R[2]), 1)


def test_a_rotation_keeps_its_axis_and_turns_what_is_across_it(world):
    """R n = n, and R a = c a + s n x a for a across n: counter-clockwise about n."""
    n = Vector(world.scalar(Fraction(x, 7)) for x in (2, 3, 6))
    c, s = world.scalar(Fraction(3, 5)), world.scalar(Fraction(4, 5))
    R = Matrix.rotation(n, c, s)
    a = n.cross(world.vector())
    assert same(world, R @ n, n)
    assert same(world, R @ a, c * a + s * n.cross(a))


def test_a_quarter_turn_about_z_takes_x_to_y():
    """Rot(z, pi/2) e_x = e_y: the sign of an angle."""
    assert Matrix.rotation((0, 0, 1), 0, 1) @ Vector((1, 0, 0)) == (0, 1, 0)


def test_poses_chain_as_the_points_that_they_carry(world):
    """X_AB (X_BC p_C) = (X_AB X_BC) p_C, and the inverse undoes."""
    X, Y, p = world.pose(), world.pose(), world.vector()
    assert same(world, X.then(Y).point(p), X.point(Y.point(p)))
    assert same(world, parts(X.then(X.inverse())), (Matrix.IDENTITY, Vector.ZERO))
    assert same(world, X.inverse().point(X.point(p)), p)


def test_points_of_a_body_keep_their_distance(world):
    """(v_P - v_Q) . r_PQ = 0 for any twist."""
    xi, r = world.twist(), world.vector()
    assert same(world, (xi.at(r).v + -xi.v) @ r, 0)
    assert same(world, parts(xi.at(r).at(-r)), parts(xi))


def test_velocity_grows_with_the_arm_in_the_sense_of_the_turn():
    """v = w x r: a point to the right of a counter-clockwise turn moves up."""
    assert Twist(w=Vector((0, 0, 3))).at(Vector((2, 0, 0))).v == (0, 6, 0)


def test_a_moment_grows_with_the_arm_in_the_sense_of_the_turn():
    """tau_O = tau_P + r_OP x f: an upward force to the right turns counter-clockwise."""
    assert Wrench(f=Vector((0, 5, 0))).moved(Vector((2, 0, 0))).tau == (0, 0, 10)


def test_power_does_not_depend_on_the_point(world):
    """tau . w + f . v is the same about the point r away."""
    xi, W, r = world.twist(), world.wrench(), world.vector()
    assert same(world, xi.at(r).power(W.moved(-r)), xi.power(W))


def test_power_does_not_depend_on_the_axes(world):
    """(R tau) . (R w) + (R f) . (R v) = tau . w + f . v"""
    xi, W, R = world.twist(), world.wrench(), world.rotation()
    assert same(world, xi.turned(R).power(W.turned(R)), xi.power(W))


def test_twists_and_wrenches_add_and_so_does_their_power(world):
    """(xi + eta) . (W + Z) = xi.W + xi.Z + eta.W + eta.Z"""
    xi, eta, W, Z = world.twist(), world.twist(), world.wrench(), world.wrench()
    separately = xi.power(W) + xi.power(Z) + eta.power(W) + eta.power(Z)
    assert same(world, xi.plus(eta).power(W.plus(Z)), separately)


Particle = tuple[Any, Vector]


def cloud(world: Exact) -> list[Particle]:
    """Five particles (mass, place): a body of which everything can be summed."""
    return [(world.scalar(Fraction(k, 2)), world.vector()) for k in range(1, 6)]


def tensor(particles: list[Particle], about: Vector) -> Matrix:
    """sum m (r.r 1 - r r^T), r from the point."""
    I = (Vector.ZERO, Vector.ZERO, Vector.ZERO)
    for m, place in particles:
        r = place + -about
        one = Matrix.of((m * ((r @ r if i == j else 0) - r[i] * r[j]) for j in range(3)) for i in range(3))
        I = Matrix.of(a + b for a, b in zip(I, one, strict=True))
    return I


def inertia_of(particles: list[Particle]) -> SpatialInertia:
    """The inertia from mass, mass centre and the tensor about it."""
    total = sum((m for m, _ in particles), start=0)
    com = Vector.ZERO
    for m, place in particles:
        com = com + m / total * place
    return SpatialInertia.about_center(total, com, tensor(particles, com))


def test_the_parallel_axes_theorem_moves_an_inertia_to_the_origin(world):
    """I_O = I_C + m (c.c 1 - c c^T), against the sum over particles about O."""
    particles = cloud(world)
    assert same(world, inertia_of(particles).I, tensor(particles, Vector.ZERO))


def test_momentum_is_the_sum_over_particles(world):
    """(L, P) = sum (r x m v_r, m v_r), v_r = v + w x r."""
    particles, xi = cloud(world), world.twist()
    L, P = Vector.ZERO, Vector.ZERO
    for m, r in particles:
        p = m * xi.at(r).v
        L, P = L + r.cross(p), P + p
    assert same(world, parts(inertia_of(particles).momentum(xi)), (L, P))


def test_kinetic_energy_is_the_sum_over_particles(world):
    """T = sum m v_r . v_r / 2"""
    particles, xi = cloud(world), world.twist()
    T = sum((m * (xi.at(r).v @ xi.at(r).v) for m, r in particles), start=0) * Fraction(1, 2)
    assert same(world, inertia_of(particles).kinetic_energy(xi), T)


@each("kind", ARITHMETICS[1:])
def test_every_arithmetic_gives_the_values_of_the_fractions(kind):
    """The same text of the law, the same numbers: T of a turned and moved body."""

    def energy(world: Exact) -> float:
        inertia, X, xi = inertia_of(cloud(world)), world.pose().then(world.pose()), world.twist()
        return world.value(inertia.kinetic_energy(xi.turned(X.R).at(X.p)))

    assert energy(kind(seed=5)) == pytest.approx(energy(Exact(seed=5)), rel=1e-12)
