"""Laws of the field of velocities of a rigid body, of motion on a moving body, of centrodes, at random motions.

The oracle: positions as functions of time in 50 digits, written down here, and their differences.
"""

from __future__ import annotations

from collections.abc import Callable
from functools import cache
from random import Random

import pytest
from each import each
from mpmath import mp, mpf

import eomgen
from eomgen.errors import DerivationError
from eomgen.mechanics.dynamics.system import System
from eomgen.mechanics.instant.kinematic_state import BodyMotion, composition_of
from eomgen.mechanics.instant.motion_kind import Kinds
from eomgen.mechanics.kinematics.motion import (
    VelocityField,
)
from eomgen.model.outputs.points import curvature_radius
from eomgen.questions import outputs_answered as answers
from eomgen.study import MotionFromStart, Study, study_of
from eomgen.symbolic.exact.equality import equal_at_random_states
from eomgen.symbolic.expression.node import Node
from eomgen.symbolic.expression.spatial import Vector
from eomgen.symbolic.expression.text import parse
from eomgen.symbolic.numeric.evaluation import FLOAT, evaluate, fifty_digits
from eomgen.symbolic.print.text import to_text

pytestmark = pytest.mark.slow

TOLERANCE = 1e-12

PLANE = """
eomgen = 1
space = "plane"
parameters = { w = 2, b = 1.1, c = 0.3 }
coordinates.x.motion = "0.4*t + 0.1*t^3"
coordinates.q.motion = "0.5*t^2 + sin(w*t)"
coordinates.s.motion = "b + c*cos(3*t)"
[bodies.cart]
joint = { kind = "prismatic", axis = [1, 0.5], displacement = "x" }
[bodies.arm]
points = { tip = ["b", "-c"] }
joint = { kind = "revolute", on = "cart", at = [0.2, 0.1], angle = "q" }
[bodies.bead]
joint = { kind = "prismatic", on = "arm", at = [0, 0.3], axis = [2, 1], displacement = "s" }
"""

SPACE = """
eomgen = 1
space = "space"
parameters = { w = 2, b = 1.1, c = 0.3 }
coordinates.q.motion = "0.5*t^2 + sin(w*t)"
coordinates.p.motion = "t - 0.2*t^3"
coordinates.s.motion = "b + c*cos(3*t)"
[bodies.mast]
joint = { kind = "revolute", at = [0.1, 0, 0.4], axis = [1, 2, 2], angle = "q" }
[bodies.arm]
points = { tip = ["b", "-c", 0.5] }
joint = { kind = "revolute", on = "mast", at = [0, 0.3, 1], axis = [0, 3, 4], angle = "p" }
[bodies.bead]
joint = { kind = "prismatic", on = "arm", at = [0, 0.3, 0.2], axis = [2, 1, 2], displacement = "s" }
"""


@cache
def instant(text: str) -> tuple[Study, dict[Node, float]]:
    """The phase of a driven model, and its state at t = 0.7."""
    phase = study_of(eomgen.loads(text))
    scope = phase.system.scope
    state = {scope.symbols.parameters[n]: float(x.value.literal) for n, x in scope.model.parameters.items()}
    state |= {scope.symbols.t: 0.7}
    for q in scope.symbols.q:
        state[q] = evaluate((scope.value(scope.model.coordinates[q.name].motion),), state, FLOAT)[0]
    return phase, state


def value(text: str, formula: str) -> float:
    """A formula of the outputs at t = 0.7."""
    phase, state = instant(text)
    return phase.number(parse(formula, references=True), state)


def matrix(axis: tuple[float, ...], angle: mpf) -> mp.matrix:
    """The rotation about an axis by an angle, by Rodrigues' formula."""
    n = mp.matrix(axis) / mp.norm(mp.matrix(axis))
    tilde = mp.matrix([[0, -n[2], n[1]], [n[2], 0, -n[0]], [-n[1], n[0], 0]])
    return mp.eye(3) + mp.sin(angle) * tilde + (1 - mp.cos(angle)) * tilde * tilde


Place = Callable[[mpf], mp.matrix]


def plane_chain(t: mpf) -> tuple[mp.matrix, mp.matrix, mp.matrix]:
    """(origin of the arm, its rotation, the bead) of PLANE."""
    x, q, s = mpf(4) / 10 * t + t**3 / 10, t**2 / 2 + mp.sin(2 * t), mpf(11) / 10 + mpf(3) / 10 * mp.cos(3 * t)
    along = mp.matrix([1, mpf(1) / 2, 0])
    origin = along / mp.norm(along) * x + mp.matrix([mpf(2) / 10, mpf(1) / 10, 0])
    R = matrix((0, 0, 1), q)
    return origin, R, origin + R * (mp.matrix([0, mpf(3) / 10, 0]) + mp.matrix([2, 1, 0]) / mp.sqrt(5) * s)


def space_chain(t: mpf) -> tuple[mp.matrix, mp.matrix, mp.matrix]:
    """(origin of the arm, its rotation, the bead) of SPACE."""
    q, p, s = t**2 / 2 + mp.sin(2 * t), t - t**3 / 5, mpf(11) / 10 + mpf(3) / 10 * mp.cos(3 * t)
    mast = matrix((1, 2, 2), q)
    R = mast * matrix((0, 3, 4), p)
    origin = mp.matrix([mpf(1) / 10, 0, mpf(4) / 10]) + mast * mp.matrix([0, mpf(3) / 10, 1])
    local = mp.matrix([0, mpf(3) / 10, mpf(2) / 10]) + mp.matrix([2, 1, 2]) / 3 * s
    return origin, R, origin + R * local


def slope(place: Place, t: mpf, order: int) -> mp.matrix:
    """The first or second time derivative of a place by central differences."""
    h = mpf(10) ** -12
    if order == 1:
        return (place(t + h) - place(t - h)) / (2 * h)
    return (place(t + h) - 2 * place(t) + place(t - h)) / h**2


CHAINS = {"plane": (PLANE, plane_chain, "xy"), "space": (SPACE, space_chain, "xyz")}


@pytest.fixture(autouse=True)
def many_digits():
    with mp.workdps(50):
        yield


@each("space", CHAINS)
def test_transport_is_the_motion_of_the_point_of_the_body_that_is_passed(space):
    """v_t and a_t are derivatives of the place of the arm's point at which the bead is now."""
    text, chain, letters = CHAINS[space]
    t = mpf(7) / 10
    origin, R, bead = chain(t)
    local = R.T * (bead - origin)
    for order, name in ((1, "v"), (2, "a")):
        true = slope(lambda at: chain(at)[0] + chain(at)[1] * local, t, order)
        for i, letter in enumerate(letters):
            found = value(text, f"transport_{name}{letter}(bead.origin, arm)")
            assert abs(found - true[i]) < TOLERANCE * 10


@each("space", CHAINS)
def test_what_the_body_sees_is_the_motion_in_its_axes(space):
    """v_r, a_r: derivatives of R^T (p - p_O); in the ground's axes by a third argument."""
    text, chain, letters = CHAINS[space]
    t = mpf(7) / 10

    def local(at: mpf) -> mp.matrix:
        origin, R, bead = chain(at)
        return R.T * (bead - origin)

    for order, name in ((1, "v"), (2, "a")):
        own, ground = slope(local, t, order), chain(t)[1] * slope(local, t, order)
        for i, letter in enumerate(letters):
            assert abs(value(text, f"{name}{letter}(bead.origin, arm)") - own[i]) < TOLERANCE * 10
            assert abs(value(text, f"{name}{letter}(bead.origin, arm, ground)") - ground[i]) < TOLERANCE * 10


@each("space", CHAINS)
def test_the_parts_make_up_the_acceleration(space):
    """a = a_t + a_r + a_C and a_t = a_O + epsilon x r + omega x (omega x r), against differences of places."""
    text, chain, letters = CHAINS[space]
    t = mpf(7) / 10
    true = slope(lambda at: chain(at)[2], t, 2)
    for i, letter in enumerate(letters):
        parts = f"transport_a{letter}(bead.origin, arm) + a{letter}(bead.origin, arm, ground)"
        assert abs(value(text, f"{parts} + coriolis_a{letter}(bead.origin, arm)") - true[i]) < TOLERANCE * 10
        turning = f"euler_a{letter}(bead.origin, arm) + centripetal_a{letter}(bead.origin, arm)"
        left = value(text, f"a{letter}(arm.origin) + {turning} - transport_a{letter}(bead.origin, arm)")
        assert abs(left) < TOLERANCE


@each("space", CHAINS)
def test_parts_in_the_axes_of_a_body_have_the_same_magnitude(space):
    """|R^T a_C| = |a_C|"""
    text, _, letters = CHAINS[space]
    for part in ("coriolis_a", "transport_a", "euler_a", "centripetal_a"):
        squares = " + ".join(f"{part}{letter}(bead.origin, arm, bead)^2" for letter in letters)
        size = part.replace("_a", "_acceleration")
        assert abs(value(text, f"sqrt({squares}) - {size}(bead.origin, arm)")) < TOLERANCE


@each("model", ["arm3", "elastic_pendulum", "bead_on_turning_hoop", "cart_pole", "four_bar"])
def test_two_ways_to_the_motion_of_a_point_agree(model):
    """d/dt p = v_t + v_r and d/dt v = a_t + a_r + a_C at random exact states, from every body."""
    system = System.of(eomgen.load(f"models/{model}.toml"))
    scope, motion = system.scope, system.motion
    pairs = []
    for body in motion.index:
        for link in motion.links:
            parts = composition_of(motion, f"{link.name}.origin", body)
            v = scope.time_derivative(link.pose.p)
            pairs += zip(parts.velocity, v, strict=True)
            pairs += zip(parts.acceleration, scope.with_accelerations(v), strict=True)
    assert equal_at_random_states(pairs).equal


# -- centres, poles, slowest points ----------------------------------------------------------------


def exact_field(seed: int) -> VelocityField:
    """A plane field with exact entries."""
    rng = Random(seed)
    p, v, a = (Vector((rng.randint(-9, 9), rng.randint(-9, 9), 0)) for _ in range(3))
    return VelocityField(p, v, a, Vector((0, 0, rng.randint(1, 9))), Vector((0, 0, rng.randint(-9, 9))))


@each("seed", range(5))
def test_centre_and_pole_have_no_velocity_and_no_acceleration(seed):
    """v(C) = 0, a(P) = 0"""
    field = exact_field(seed)
    assert field.velocity(field.rotation_center()) == (0, 0, 0)
    assert field.acceleration(field.acceleration_pole()) == (0, 0, 0)


@each("seed", range(5))
def test_points_of_the_inflection_circle_have_no_acceleration_across_their_path(seed):
    """v x a = 0 at the point opposite to the centre of rotation, and at the one a quarter further."""
    field = exact_field(seed)
    middle, pole = field.inflection_center(), field.rotation_center()
    arm = middle - pole
    for place in (middle + arm, middle + Vector((-arm[1], arm[0], 0))):
        assert field.velocity(place).cross(field.acceleration(place)) == (0, 0, 0)


@each("seed", range(12))
def test_no_point_of_a_bar_is_slower_than_its_least_speed(seed):
    """min |v(A + s (B - A))| over 0 <= s <= 1, in the plane and in space."""
    rng = Random(seed)

    def vector() -> Vector:
        return Vector((rng.randint(-9, 9), rng.randint(-9, 9), 0 if seed % 2 else rng.randint(-9, 9)))

    field = exact_field(seed) if seed % 2 else VelocityField(*(vector() for _ in range(5)))
    start, end = vector(), vector()
    least = float(evaluate((field.least_speed(start, end, lambda x: x),), {}, fifty_digits())[0])
    speeds = []
    for k in range(2001):
        place = start + k / 2000 * (end - start)
        v = field.velocity(place)
        speeds.append(float(v @ v) ** 0.5)
    assert least <= min(speeds) + 1e-12
    assert least == pytest.approx(min(speeds), abs=2e-2)


def test_a_bar_that_does_not_turn_has_one_speed():
    """omega = 0 divides nothing: |v| of all its points."""
    assert VelocityField(v=Vector((3, 4, 0))).least_speed(Vector.ZERO, Vector((1, 0, 0)), lambda x: x) == 5
    assert VelocityField(v=Vector((3, 4, 12))).least_speed(Vector.ZERO, Vector((1, 0, 2)), lambda x: x) == 13


def test_a_ladder_is_slowest_at_the_foot_of_the_perpendicular():
    """v^2/(5 l) exactly: the component of the velocity along the bar."""
    text = """
eomgen = 1
space = "plane"
parameters = { l = 0.5, v = 0.8 }
coordinates = { x = { motion = "v*t" }, theta = { dependent = true, near = 0.3 } }
bodies.rod.points = { B = [0, "l"] }
bodies.rod.joint = { kind = "revolute", at = ["x", 0], angle = "theta" }
constraints.wall = { kind = "support", point = "rod.B", normal = [1, 0], at = [0, 0] }
outputs.least = { value = "least_speed(rod.origin, rod.B)", at = "t = 0.2" }
"""
    answer = answers.solve(eomgen.loads(text))["least"]
    assert answer.exact == "v^2/(5*l)"
    assert answer.value == pytest.approx(0.256, rel=1e-12)


def test_what_a_resting_or_straight_path_has_not_is_said():
    """At rest there is no tangent; a straight path has no finite radius of curvature; a translation no pole."""
    text = """
eomgen = 1
space = "plane"
coordinates = { x = { motion = "t^2" }, q = { motion = "t^2" } }
bodies.cart.joint = { kind = "prismatic", axis = [1, 0], displacement = "x" }
bodies.bar.points = { A = [1, 0] }
bodies.bar.joint = { kind = "revolute", angle = "q" }
[outputs]
still = { value = "tangential_acceleration(cart.origin)", at = "t = 0" }
straight = { value = "curvature_radius(cart.origin)", at = "t = 1" }
pole = { value = "acceleration_pole_x(cart)", at = "t = 1" }
two = { value = "least_speed(cart.origin, bar.A)", at = "t = 1" }
rho = { value = "curvature_radius(bar.A)", at = "t = 1" }
a_t = { value = "tangential_acceleration(bar.A)", at = "t = 1" }
a_n = { value = "normal_acceleration(bar.A)", at = "t = 1" }
"""
    found = answers.solve(eomgen.loads(text))
    assert "at rest" in found["still"].message
    assert "straight" in found["straight"].message
    assert "pole" in found["pole"].message
    assert "two bodies" in found["two"].message
    assert [found[name].exact for name in ("rho", "a_t", "a_n")] == ["1", "2", "4"]


def test_curvature_of_an_ellipse():
    """x = a cos t, y = b sin t: rho = b^2/a at the end of the long axis."""
    with pytest.raises(DerivationError, match="at rest"):
        curvature_radius(Vector.ZERO, Vector((1, 0, 0)))
    a, b = 3, 2
    assert curvature_radius(Vector((0, b, 0)), Vector((-a, 0, 0))) == pytest.approx(b**2 / a)


# -- kinds of motion -------------------------------------------------------------------------------


def kinds_of(text: str) -> tuple[Kinds, eomgen.Model]:
    model = eomgen.loads(text)
    motion = MotionFromStart(model, False)
    return Kinds(motion.phase.system, motion.start), model


BODIES = """
eomgen = 1
space = "space"
parameters = { r = 0.4, h = 0.1 }
coordinates = { q = 0.2, p = 0.3, s = 0.1, z = { motion = "0.1*t" } }
"""
KINDS = {
    "rest": '{ kind = "fixed", at = [1, 0, 0] }',
    "rectilinear translation": '{ kind = "prismatic", axis = [1, 2, 2], displacement = "s" }',
    "circular translation": '{ kind = "placed", at = ["r*cos(q)", 1, "r*sin(q)"] }',
    "curvilinear translation": '{ kind = "placed", at = ["q", "q^2", 0] }',
    "rotation about a fixed axis": '{ kind = "revolute", at = [1, 0, 2], axis = [0, 3, 4], angle = "2*q" }',
    "plane motion": '{ kind = "placed", at = ["q", "q^2", 1], angle = "q" }',
    "helical motion": '{ kind = "placed", at = [1, 2, "h*q"], angle = "q" }',
    "rotation about a fixed axis and sliding along it": '{ kind = "placed", at = [1, 2, "s"], angle = "q" }',
    "rotation about a fixed point": '{ kind = "placed", at = [0, 1, 0], point = "tip", orientation = "zxz", '
    'angles = ["q", "p", 0] }',
    "general motion": '{ kind = "placed", at = ["s", 1, "q"], orientation = "zxz", angles = ["q", "p", 0] }',
}


@each("kind", KINDS)
def test_kinds_of_motion_in_space_are_told_apart(kind):
    """By omega, its direction, omega.v, and the rate of the axis."""
    use = 'outputs = { a = "q + p + s + z" }\n'
    text = f"{BODIES}{use}[bodies.body]\npoints = {{ tip = [0, 0.2, 0.1] }}\njoint = {KINDS[kind]}\n"
    kinds, _ = kinds_of(text)
    assert kinds.of("body").name == kind


def test_a_screw_has_its_axis_and_its_pitch():
    """The axis through (1, 2), advancing h per radian."""
    kinds, _ = kinds_of(f'{BODIES}outputs = {{ a = "p + s + z" }}\nbodies.nut.joint = {KINDS["helical motion"]}\n')
    kind = kinds.of("nut")
    assert [to_text(x) for x in (*kind.at, *kind.axis, kind.pitch)] == ["1", "2", "0", "0", "0", "1", "h"]


def test_a_fixed_point_is_found_and_named():
    """The tip of the top."""
    joint = KINDS["rotation about a fixed point"]
    points = "points = { tip = [0, 0.2, 0.1] }"
    kinds, _ = kinds_of(f'{BODIES}outputs = {{ a = "s + z" }}\n[bodies.top]\n{points}\njoint = {joint}\n')
    kind = kinds.of("top")
    assert kind.point == "top.tip"
    assert [to_text(x) for x in kind.at] == ["0", "1", "0"]


def test_the_coupler_of_a_parallelogram_translates_on_a_circle():
    """omega = 0 holds on the configurations where the loop closes, and nowhere else."""
    text = """
eomgen = 1
space = "plane"
parameters = { r = 0.4, d = 1 }
coordinates = { q = 0.9, phi = { dependent = true, near = -0.9 }, psi = { dependent = true, near = 0.9 } }
bodies.crank = { points = { A = ["r", 0] }, joint = { kind = "revolute", angle = "q" } }
bodies.coupler = { points = { B = ["d", 0] }, joint = { kind = "revolute", on = "crank.A", angle = "phi" } }
bodies.rocker = { points = { B = ["r", 0] }, joint = { kind = "revolute", at = ["d", 0], angle = "psi" } }
constraints.B = { kind = "pin", points = ["coupler.B", "rocker.B"] }
"""
    kinds, _ = kinds_of(text)
    assert [kinds.of(body).name for body in ("crank", "coupler", "rocker")] == [
        "rotation about a fixed axis",
        "circular translation",
        "rotation about a fixed axis",
    ]
    assert to_text(kinds.of("coupler").way.radius) == "r"


# -- centrodes -------------------------------------------------------------------------------------

CARDAN = """
eomgen = 1
space = "plane"
parameters = { l = { positive = true } }
coordinates = { theta = 0.3 }
bodies.rod.joint = { kind = "placed", at = [0, "l*sin(theta)"], angle = "-theta" }
"""
WHEEL = """
eomgen = 1
space = "plane"
parameters = { R = { positive = true } }
coordinates = { x = 0.3 }
bodies.wheel.joint = { kind = "placed", at = ["x", "R"], angle = "-x/R" }
"""
ANTIPARALLELOGRAM = """
eomgen = 1
space = "plane"
parameters = { f = 1, d = 2 }
coordinates = { q = 1, phi = { dependent = true, near = 2.05 }, psi = { dependent = true, near = 2.05 } }
bodies.crank = { points = { A = ["d", 0] }, joint = { kind = "revolute", angle = "q" } }
bodies.coupler = { points = { B = ["f", 0] }, joint = { kind = "revolute", on = "crank.A", angle = "phi" } }
bodies.rocker = { points = { B = ["d", 0] }, joint = { kind = "revolute", at = ["f", 0], angle = "psi" } }
constraints.B = { kind = "pin", points = ["coupler.B", "rocker.B"] }
"""


def test_centrodes_of_cardans_motion_are_circles_one_twice_the_other():
    """A ladder: the circle of radius l about the corner, and that over the ladder as diameter."""
    kinds, _ = kinds_of(CARDAN)
    (found,) = kinds.centrodes()
    assert (found.fixed_curve.kind, found.moving_curve.kind) == ("circle", "circle")
    assert [to_text(x) for x in (*found.fixed_curve.at[:2], found.fixed_curve.radius)] == ["0", "0", "l"]
    assert [to_text(x) for x in (*found.moving_curve.at[:2], found.moving_curve.radius)] == ["1/2*l", "0", "1/2*l"]


def test_centrodes_of_a_rolling_wheel_are_the_line_and_its_rim():
    """y = 0, and the circle of the radius R."""
    kinds, _ = kinds_of(WHEEL)
    (found,) = kinds.centrodes()
    assert (found.fixed_curve.kind, found.moving_curve.kind) == ("line", "circle")
    assert [to_text(x) for x in found.fixed_curve.along] == ["1", "0", "0"]
    assert to_text(found.fixed_curve.at[1]) == "0"
    assert [to_text(x) for x in (*found.moving_curve.at[:2], found.moving_curve.radius)] == ["0", "0", "R"]


def test_the_centre_of_a_crossed_parallelogram_runs_on_an_ellipse_with_the_pivots_as_foci():
    """|C - O1| + |C - O2| = d in the ground, |C - A| + |C - B| = d in the coupler's axes, where the loop closes."""
    kinds, _ = kinds_of(ANTIPARALLELOGRAM)
    (found,) = kinds.centrodes()
    assert found.body == "coupler"
    assert found.fixed_curve.kind == found.moving_curve.kind == "curve"
    for state in kinds.possible.states:
        for place in (found.fixed, found.moving):
            x, y, _ = evaluate(place, state, fifty_digits())
            to_first, to_second = (((x - foot) ** 2 + y**2) ** 0.5 for foot in (0, 1))
            assert abs(to_first + to_second - 2) < 1e-25


@each("text", [CARDAN, WHEEL, ANTIPARALLELOGRAM])
def test_the_moving_centrode_touches_the_fixed_one(text):
    """Both places of the centre are the same place, and it has the same velocity along both curves."""
    kinds, _ = kinds_of(text)
    (found,) = kinds.centrodes()
    system, possible = kinds.system, kinds.possible
    field, pose = system.motion.field(found.body), system.motion.link(found.body).pose
    moved = pose.point(found.moving)
    assert possible.vanish(*(moved - found.fixed))
    assert possible.vanish(*field.velocity(found.fixed))


# -- what is told of each body ---------------------------------------------------------------------


def test_every_body_of_a_mechanism_has_its_motion_told():
    """A slider-crank at an instant: the crank's centre is its hinge, the piston has none."""
    model = eomgen.load("models/slider_crank.toml")
    motion = MotionFromStart(model, False)
    system = motion.phase.system
    motions = {m.body: m for m in BodyMotion.all_of(system, {}, Kinds(system, motion.start))}
    assert [to_text(x) for x in motions["flywheel"].center] == ["0", "0", "0"]
    assert motions["piston"].center is None
    assert motions["piston"].kind.name == "rectilinear translation"
    assert motions["rod"].kind.name == "plane motion"
