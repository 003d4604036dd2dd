"""Where bodies are and how they move: driven coordinates, moving points, the order of bodies, known velocities."""

from __future__ import annotations

from itertools import permutations

import pytest
from each import each
from moving import at, equal, rate, state_of, written
from slow_run import usual

import eomgen
from eomgen.errors import DerivationError, ModelError
from eomgen.mechanics.dynamics import formulations as recursive
from eomgen.mechanics.dynamics.system import System
from eomgen.mechanics.kinematics.scene import SystemScene
from eomgen.symbolic.expression.derivatives import substituted
from eomgen.symbolic.expression.spatial import Vector
from eomgen.symbolic.expression.text import parse

pytestmark = pytest.mark.slow

DRIVEN = """
[parameters]
m = 1.5
A = 0.3
w = 2.0
v0 = 0.7
[coordinates]
s = {{ {law} }}
[bodies.cart]
shape = {{ kind = "particle", mass = "m" }}
joint = {{ kind = "prismatic", axis = [1, 0], displacement = "s" }}
"""


def driven(law: str) -> System:
    return written(DRIVEN.format(law=law))


def value(system: System, text: str):
    """A text in the model's names as a scalar of its graph."""
    return parse(text).evaluate(system.scope.names)


@each(
    "law, speed, acceleration",
    [
        ('motion = "A*sin(w*t)"', "A*w*cos(w*t)", "-A*w^2*sin(w*t)"),
        ('motion = "A*t^3 - v0*t"', "3*A*t^2 - v0", "6*A*t"),
        ('rate = "v0"', "v0", "0"),
        ('rate = "A*w*cos(w*t)"', "A*w*cos(w*t)", "-A*w^2*sin(w*t)"),
        ('acceleration = "A"', "A*t", "A"),
        ('acceleration = "A", speed = "v0"', "v0 + A*t", "A"),
        ('acceleration = "A*cos(w*t)", speed = "v0"', "v0 + A*sin(w*t)/w", "A*cos(w*t)"),
        ('acceleration = "A*sin(w*t)"', "A*(1 - cos(w*t))/w", "A*sin(w*t)"),
        ('acceleration = "A*t^2 + w", speed = 2', "2 + A*t^3/3 + w*t", "A*t^2 + w"),
        ('acceleration = "A*exp(-w*t)"', "A*(1 - exp(-w*t))/w", "A*exp(-w*t)"),
        ('acceleration = "t*sin(t)"', "sin(t) - t*cos(t)", "t*sin(t)"),
    ],
)
def test_a_driven_coordinate_has_the_rate_and_acceleration_of_its_law(law, speed, acceleration):
    """nu = f' of a motion, f of a rate, speed + integral of f from 0 to t of an acceleration; its row of N is zero."""
    system = driven(law)
    scope = system.scope
    assert scope.symbols.u == () and scope.N == ((),)
    assert equal(scope.nu, (value(system, speed),))
    assert equal(scope.time_derivative(scope.nu), (value(system, acceleration),))
    assert equal((scope.names["s'"], scope.names["s''"]), (value(system, speed), value(system, acceleration)))


@pytest.mark.parametrize("f", usual(["exp(-t^2)", "sin(t^2)", "1/(1 + t^5)", "exp(sin(w*t))"], 2, 1))
def test_an_acceleration_without_an_integral_in_closed_form_says_so(f):
    """The integral of exp(-t^2) is no elementary function: an error with a place and a fix, no approximation."""
    with pytest.raises(DerivationError) as caught:
        driven(f'acceleration = "{f}"')
    assert "no integral in closed form" in caught.value.what
    assert caught.value.where == "coordinates.s"
    assert "`motion` or `rate`" in caught.value.fix
    assert caught.value.exit_code == 3


GEOMETRY = """
[parameters]
m = 1.0
[coordinates]
q = 0.1
{coordinate}
[inputs]
tau = "sin(t)"
[bodies.bob]
mass = "m"
inertia = 0.1
points = {{ P = ["q", {point}] }}
joint = {{ kind = "{kind}", {fields} }}
[forces.push]
kind = "generalized"
coordinate = "q"
value = "tau"
"""


@each(
    "kind, fields",
    [
        ("placed", 'at = ["q", "tau"]'),
        ("placed", 'at = ["q", 0], angle = "2*tau"'),
        ("revolute", 'at = [0, "tau"], angle = "q"'),
        ("revolute", 'at = [0, 0], angle = "q + tau"'),
        ("prismatic", 'axis = [1, 0], displacement = "q*tau"'),
    ],
)
def test_an_input_in_the_geometry_is_refused(kind, fields):
    """A caller may replace an input by anything, so it has no rate: it may act in forces, not in places."""
    with pytest.raises(ModelError, match="'tau' \\(an input\\) cannot stand in"):
        written(GEOMETRY.format(kind=kind, fields=fields, point="0", coordinate=""))


@each("law, name", [("tau", "an input"), ("2*q", "a coordinate")])
def test_a_driving_law_holds_time_and_parameters_only(law, name):
    """q = f(t): with inputs or coordinates in f its rate would not be known."""
    with pytest.raises(ModelError, match=f"\\({name}\\) cannot stand in the motion"):
        text = f'r = {{ motion = "{law}" }}'
        written(GEOMETRY.format(kind="placed", fields='at = ["q", "r"]', point="0", coordinate=text))


MOVING_POINT = """
[parameters]
m = 1.0
l = 0.4
w = 3.0
[coordinates]
theta = 0.2
s = 0.1
[bodies.bar]
mass = "m"
inertia = "m*l^2"
points = { P = ["l + s", "l*sin(w*t)"], Q = ["l", 0] }
joint = { kind = "revolute", angle = "theta" }
[bodies.slider]
shape = { kind = "particle", mass = "m" }
joint = { kind = "prismatic", axis = [1, 0], displacement = "s" }
"""


def test_the_velocity_of_a_moving_point_is_the_rate_of_its_place():
    """d/dt p_P = R (v + w x r + r'): what is fixed in the body, and the point's motion in it."""
    system = written(MOVING_POINT)
    scene, state = SystemScene(system.motion), state_of(system)
    place = scene.place("bar.P")
    assert at(scene.velocity(place), state) == pytest.approx(rate(system, scene.position(place), state), rel=1e-14)
    assert equal(system.motion.velocity(place), scene.velocity(place))
    in_body = (value(system, "s'"), value(system, "l*w*cos(w*t)"), 0)
    assert equal(system.motion.slide(place), system.motion.link("bar").pose.R @ in_body)


def test_the_velocity_of_a_fixed_point_by_its_twist_is_the_rate_of_its_place():
    """R (v + w x r) = d/dt p"""
    system = written(MOVING_POINT)
    scene, state = SystemScene(system.motion), state_of(system)
    place = scene.place("bar.Q")
    assert system.motion.slide(place) == Vector.ZERO
    assert at(system.motion.velocity(place), state) == pytest.approx(rate(system, scene.position(place), state))


BODIES = {
    "arm": """
[bodies.arm]
shape = { kind = "rod", mass = "m", length = "l" }
joint = { kind = "revolute", at = [0, 0], angle = "q1" }
""",
    "hand": """
[bodies.hand]
shape = { kind = "rod", mass = "2*m", length = "l" }
joint = { kind = "revolute", on = "arm.end", angle = "q2", damping = "c" }
""",
    "tool": """
[bodies.tool]
shape = { kind = "disc", mass = "m", radius = "l" }
joint = { kind = "prismatic", on = "hand.end", axis = [1, 1], displacement = "q3" }
""",
}
AROUND = """
[parameters]
m = 1.2
l = 0.7
c = 0.3
[coordinates]
q1 = 0.1
q2 = 0.2
q3 = 0.3
{bodies}
[forces.weight]
kind = "gravity"
acceleration = [0, -9.81]
"""


@each("order", list(permutations(BODIES)))
def test_the_order_in_which_bodies_are_declared_changes_nothing(order):
    """M and Q - c are the same functions of q, u and the parameters."""
    results = []
    for names in (tuple(BODIES), order):
        system = written(AROUND.format(bodies="".join(BODIES[name] for name in names)))
        equations = recursive.assembled_by_recursion(system)
        results.append(at([*(x for row in equations.M for x in row), *equations.forcing], state_of(system)))
        parents = [link.parent for link in system.motion.links]
        assert all(parent < i for i, parent in enumerate(parents)), "parents come before children"
    assert results[1] == pytest.approx(results[0], rel=1e-13)


def test_the_rate_of_every_twist_is_B_a_plus_alpha():
    """xi = B u + beta, xi' = B a + alpha, for every body."""
    system = written(AROUND.format(bodies="".join(BODIES.values())))
    scope, motion = system.scope, system.motion
    u, a = scope.symbols.u, scope.symbols.a
    for i, link in enumerate(motion.links):
        twist = (*link.twist.w, *link.twist.v)
        still = substituted(twist, {x: 0 for x in u})
        assert equal(
            twist,
            [
                sum((b * x for b, x in zip(row, u, strict=True)), start=s)
                for row, s in zip(motion.B[i], still, strict=True)
            ],
        )
        assert equal(
            scope.with_accelerations(twist),
            [
                sum((b * x for b, x in zip(row, a, strict=True)), start=s)
                for row, s in zip(motion.B[i], motion.alpha[i], strict=True)
            ],
        )


def kinematics(system: System, point: str):
    """(position, velocity, acceleration) of a point, ground axes."""
    scene = SystemScene(system.motion)
    position = scene.position(scene.place(point))
    velocity = system.scope.time_derivative(position)
    return position, velocity, system.scope.with_accelerations(velocity)


def test_a_ladder_slides_down_the_wall_as_in_the_textbook():
    """B on the floor: v = L cos(phi) phi'; A on the wall: v = -L sin(phi) phi'; C: half of both, w = phi'."""
    system = written("""
[parameters]
m = 1.0
L = 2.0
[coordinates]
phi = 0.3
[bodies.ladder]
shape = { kind = "rod", mass = "m", length = "L" }
joint = { kind = "placed", at = [0, "L*cos(phi)"], angle = "phi - pi/2" }
""")
    velocities = {name: kinematics(system, f"ladder.{name}")[1] for name in ("start", "end", "center")}
    across, down = value(system, "L*cos(phi)*phi'"), value(system, "-L*sin(phi)*phi'")
    assert equal(velocities["end"], (across, 0, 0))
    assert equal(velocities["start"], (0, down, 0))
    assert equal(velocities["center"], (across / 2, down / 2, 0))
    assert equal(system.motion.link("ladder").twist.w, (0, 0, value(system, "phi'")))


def test_a_rolling_disc_touches_with_a_point_at_rest():
    """x = R theta, clockwise: v = 0 below, R theta' in the middle, 2 R theta' above; a = R theta'^2 up below."""
    system = written(
        """
[parameters]
m = 1.0
R = 0.5
[coordinates]
theta = 0.3
[bodies.disc]
shape = { kind = "disc", mass = "m", radius = "R" }
points = { below = ["R*sin(theta0)", "-R*cos(theta0)"], above = ["-R*sin(theta0)", "R*cos(theta0)"] }
joint = { kind = "placed", at = ["R*theta", "R"], angle = "-theta" }
""".replace("theta0", "pi/3")
    )
    here = {system.symbols.q[0]: value(system, "pi/3")}  # then the points are below and above
    expected = {"below": (0, 0, 0), "center": ("R*theta'", 0, 0), "above": ("2*R*theta'", 0, 0)}
    for name, velocity in expected.items():
        found = substituted(kinematics(system, f"disc.{name}")[1], here)
        assert equal(found, [value(system, str(x)) for x in velocity]), name
    acceleration = substituted(kinematics(system, "disc.below")[2], here)
    assert equal(acceleration, (0, value(system, "R*theta'^2"), 0))


def test_a_piston_moves_as_the_crank_drives_it():
    """x = r cos(a) + sqrt(l^2 - r^2 sin(a)^2); x' = -r a' sin(a) (1 + r cos(a) / sqrt(l^2 - r^2 sin(a)^2))."""
    system = written("""
[parameters]
m = 1.0
r = 0.3
l = 1.0
[coordinates]
a = 0.4
[bodies.piston]
shape = { kind = "particle", mass = "m" }
joint = { kind = "placed", at = ["r*cos(a) + sqrt(l^2 - r^2*sin(a)^2)", 0] }
""")
    speed = value(system, "-r*a'*sin(a)*(1 + r*cos(a)/sqrt(l^2 - r^2*sin(a)^2))")
    state = state_of(system) | {system.symbols.parameters["l"]: 2}
    assert at(kinematics(system, "piston.center")[1], state) == pytest.approx(at((speed, 0, 0), state), rel=1e-14)


def test_a_bead_on_a_turning_rod_has_the_acceleration_of_coriolis():
    """a = (r'' - r phi'^2) e_r + (r phi'' + 2 r' phi') e_phi."""
    system = written("""
[parameters]
m = 1.0
[coordinates]
phi = 0.4
r = 0.5
[bodies.rod]
mass = "m"
inertia = "m"
joint = { kind = "revolute", angle = "phi" }
[bodies.bead]
shape = { kind = "particle", mass = "m" }
joint = { kind = "prismatic", on = "rod", axis = [2, 0], displacement = "r" }
""")
    radial, around = value(system, "r'' - r*phi'^2"), value(system, "r*phi'' + 2*r'*phi'")
    c, s = value(system, "cos(phi)"), value(system, "sin(phi)")
    assert equal(kinematics(system, "bead.center")[2], (radial * c - around * s, radial * s + around * c, 0))


GYROSCOPE = """
[parameters]
m = 1.0
[coordinates]
psi = 0.1
theta = 0.4
phi = 0.2
[bodies.outer]
joint = { kind = "revolute", angle = "psi" }
[bodies.inner]
joint = { kind = "revolute", on = "outer", axis = [3, 0, 0], angle = "theta" }
[bodies.wheel]
shape = { kind = "disc", mass = "m", radius = 1 }
joint = { kind = "revolute", on = "inner", angle = "phi" }
"""


def test_three_hinges_turn_a_wheel_by_eulers_equations():
    """Angular velocity of the wheel in its own axes (Goldstein, Classical Mechanics, 3rd ed., eq. 4.87)."""
    system = written(GYROSCOPE, "space")
    expected = (
        "psi'*sin(theta)*sin(phi) + theta'*cos(phi)",
        "psi'*sin(theta)*cos(phi) - theta'*sin(phi)",
        "psi'*cos(theta) + phi'",
    )
    assert equal(system.motion.link("wheel").twist.w, [value(system, x) for x in expected])


def test_three_hinges_and_the_three_angles_of_eulers_are_one_orientation():
    """R = Rz(psi) Rx(theta) Rz(phi), whether by joints or by `placed`."""
    placed = """
[bodies.other]
shape = { kind = "disc", mass = "m", radius = 1 }
joint = { kind = "placed", orientation = "zxz", angles = ["psi", "theta", "phi"] }
"""
    system = written(GYROSCOPE + placed, "space")
    wheel, other = (system.motion.link(name) for name in ("wheel", "other"))
    assert equal([x for row in wheel.pose.R for x in row], [x for row in other.pose.R for x in row])
    assert equal(wheel.twist.w, other.twist.w)


def test_a_tie_that_nothing_free_can_close_is_refused_by_name():
    """A pin of two points that stand apart for good."""
    text = """
    eomgen = 1
    space = "plane"
    [coordinates]
    q = 0
    [bodies.A]
    shape = { kind = "rod", mass = 1, length = 1 }
    joint = { kind = "revolute", angle = "q" }
    [bodies.B]
    points = { P = [1, 0] }
    [bodies.C]
    points = { P = [1, 0.5] }
    [constraints.apart]
    kind = "pin"
    points = ["B.P", "C.P"]
    """
    with pytest.raises(eomgen.DerivationError, match="row 2 of 'apart' cannot hold: no free coordinate moves it"):
        eomgen.derive(eomgen.loads(text))
