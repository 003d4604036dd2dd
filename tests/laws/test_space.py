"""Bodies that turn in space: Euler's equations, tops, gyrostats; quaternions, declared speeds, joints of space."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from moving import equal

import eomgen
from eomgen.equations import Equations
from eomgen.symbolic.exact.equality import equal_at_random_states

pytestmark = pytest.mark.slow

MODELS = Path(__file__).parents[2] / "models"
HEAD = 'eomgen = 1\nname = "turning"\nspace = "space"\n'
PLANE = 'eomgen = 1\nname = "turning"\nspace = "plane"\n'
INERTIA = "[parameters]\nA = 1.1\nB = 2.3\nC = 3.1\nm = 0.7\nd = 0.2\ng = 9.81\n"
ANGLES = "[coordinates]\npsi = { start = 0.2 }\ntheta = { start = 0.7 }\nphi = { start = 0.4 }\n"
SPEEDS = "[speeds]\nw1 = { start = 0.5 }\nw2 = { start = -1 }\nw3 = { start = 2 }\n"
FOUR = "[coordinates]\ne0 = 1\ne1 = 0.2\ne2 = -0.3\ne3 = 0.1\n" + SPEEDS
BY_QUATERNION = 'orientation = "quaternion", quaternion = ["e0", "e1", "e2", "e3"], omega = ["w1", "w2", "w3"]'
KANE = """[speeds]
w1 = "psi'*sin(theta)*sin(phi) + theta'*cos(phi)"
w2 = "psi'*sin(theta)*cos(phi) - theta'*sin(phi)"
w3 = "psi'*cos(theta) + phi'"
"""
TORQUE = '[forces.torque]\nkind = "couple"\nbody = "body"\ncouple = ["0.3*w2", "t", "-w3"]\naxes = "body"\n'
WEIGHT = '[forces.weight]\nkind = "gravity"\nacceleration = [0, 0, "-g"]\n'


def body(joint: str) -> str:
    return f'[bodies.body]\nmass = "m"\ninertia = ["A", "B", "C"]\njoint = {{ {joint} }}\n'


def derived(text: str) -> Equations:
    return eomgen.derive(eomgen.loads(HEAD + text))


SPHERICAL = body(f'kind = "spherical", {BY_QUATERNION}')
BY_ANGLES = body('kind = "spherical", orientation = "zxz", angles = ["psi", "theta", "phi"]')


@pytest.mark.parametrize("text", [FOUR + SPHERICAL, ANGLES + KANE + BY_ANGLES], ids=["quaternion", "declared speeds"])
def test_the_equations_of_a_body_are_those_of_euler(text):
    """A w1' + (C - B) w2 w3 = N1 and cyclically."""
    equations = derived(INERTIA + text + TORQUE)
    names = equations.system.scope.names
    A, B, C, w1, w2, w3, t = (names[name] for name in ("A", "B", "C", "w1", "w2", "w3", "t"))
    graph = equations.graph
    assert equations.speeds == ("w1", "w2", "w3")
    assert equal([x for row in graph.M for x in row], [A, 0, 0, 0, B, 0, 0, 0, C])
    right = (w2 * 3 / 10 + (B - C) * w2 * w3, t + (C - A) * w3 * w1, -w3 + (A - B) * w1 * w2)
    assert equal(graph.forcing, right)


def test_angular_momentum_stays_where_it_is_in_space():
    """R I w = const, which the wrong signs of the gyroscopic terms break; T and |L| alone do not tell."""
    run = eomgen.simulate(eomgen.load(MODELS / "seeds" / "s1_torque_free.toml"), time=60)
    e, w = run.x[:, :4], run.x[:, 4:]
    v = e[:, 1:]
    L = w * np.array([1.0, 2.0, 3.0])
    turned = L + 2 * np.cross(v, np.cross(v, L) + e[:, :1] * L)
    assert turned == pytest.approx(np.tile([1.0, 0.0, 3.0], (len(run.t), 1)), abs=1e-7)
    assert np.max(np.abs(np.sum(e * e, axis=1) - 1)) < 1e-14


QUANTITIES = ("x(body.center)", "y(body.center)", "z(body.center)", "omega_x(body)")
REQUESTED = "".join(f'a{k} = {{ value = "{value}", at = "t = 2" }}\n' for k, value in enumerate(QUANTITIES))


def heavy(text: str) -> list[float | None]:
    """Where the mass centre of a heavy body about a fixed point is after 2 s, and omega_x."""
    off_center = text.replace("inertia", 'center = ["d/2", 0, "d"]\ninertia')
    answers = eomgen.solve(eomgen.loads(f"{HEAD}{INERTIA}{off_center}{WEIGHT}[outputs]\n{REQUESTED}"))
    return [answer.value for answer in answers.values()]


def test_a_quaternion_and_angles_tell_the_same_motion():
    """e of zxz: e0 = cos(theta/2) cos((psi + phi)/2), e1 = sin(theta/2) cos((psi - phi)/2), ..."""
    psi, theta, phi = 0.2, 0.7, 0.4
    angles = ANGLES.replace("0.7 }", "0.7, speed = 0.3 }").replace("0.4 }", "0.4, speed = 5 }")
    c, s, plus, less = np.cos(theta / 2), np.sin(theta / 2), (psi + phi) / 2, (psi - phi) / 2
    e = [c * np.cos(plus), s * np.cos(less), s * np.sin(less), c * np.sin(plus)]
    w = [0.3 * np.cos(phi), -0.3 * np.sin(phi), 5]
    four = "[coordinates]\n" + "".join(f"e{k} = {float(x)!r}\n" for k, x in enumerate(e))
    four += "[speeds]\n" + "".join(f"w{k} = {{ start = {float(x)!r} }}\n" for k, x in enumerate(w, start=1))
    assert heavy(four + SPHERICAL) == pytest.approx(heavy(angles + BY_ANGLES), abs=1e-7)


def test_a_quaternion_is_put_to_norm_one():
    """e / |e| at the start, whatever was written."""
    equations = derived(INERTIA + FOUR + SPHERICAL)
    assert equations.rhs("numpy").x0[:4] == pytest.approx(np.array([1, 0.2, -0.3, 0.1]) / np.sqrt(1.14))


def test_the_free_body_has_three_freedoms_of_turning():
    """A quaternion's four coordinates and its norm: 6 degrees of freedom, x = (q 7, u 6)."""
    places = FOUR.replace("[coordinates]", "[coordinates]\nx = 0\ny = 0\nz = 0")
    free = body(f'kind = "free", position = ["x", "y", "z"], {BY_QUATERNION}')
    equations = derived(INERTIA + places + free + WEIGHT)
    assert len(equations.coordinates) == 7
    assert equations.speeds == ("x'", "y'", "z'", "w1", "w2", "w3")
    N = equations.graph.N
    assert (len(N), len(N[0])) == (7, 6)


GYROSTAT = MODELS / "gyrostat.toml"


def test_a_rotor_adds_its_angular_momentum():
    """J w' + w x (J w + h) = 0 with the wheel's h = I sigma about z, J of both together."""
    equations = eomgen.derive(eomgen.load(GYROSTAT))
    names = equations.system.scope.names
    A, B, I, T = (names[name] for name in ("A", "B", "J", "J_t"))
    C, sigma, w1, w2, w3 = (names[name] for name in ("C", "sigma", "w1", "w2", "w3"))
    h = (C + I) * w3 + I * sigma
    turning = [-(w2 * h - w3 * (B + T) * w2), -(w3 * (A + T) * w1 - w1 * h), -((B - A) * w1 * w2)]
    assert equal(equations.graph.forcing[3:], turning)


CERTIFIED = {
    "quaternion with weight": FOUR + SPHERICAL.replace("inertia", 'center = ["d", 0, "-d"]\ninertia') + WEIGHT + TORQUE,
    "combined rates": ANGLES + KANE.replace("+ phi'\"", "+ phi' - 2*t\"") + BY_ANGLES + TORQUE,
    "declared and kept": ANGLES
    + "x = 0.3\n[speeds]\na = \"psi' + theta'\"\nb = \"theta' - x*psi'\"\n"
    + BY_ANGLES
    + '[bodies.s]\nmass = 1\njoint = { kind = "prismatic", axis = [1, 1, 0], displacement = "x", damping = 0.4 }\n',
    "free by angles": "[coordinates]\nx = 0\ny = 0\nz = 0\na = 0.1\nb = 0.5\nc = 0.2\n"
    + WEIGHT
    + body('kind = "free", position = ["x", "y", "z"], orientation = "zyx", angles = ["a", "b", "c"]'),
    "cardan shaft": "[coordinates]\na = 0.1\nb = 0.5\nc = 0.2\n"
    + WEIGHT
    + body('kind = "revolute", axis = [1, 0, 0], angle = "a"').replace("inertia", 'center = [0, "d", 0]\ninertia')
    + '[bodies.second]\nmass = 1\ninertia = [0.1, 0.2, 0.2]\njoint = { kind = "universal", on = "body", '
    'at = ["d", 0, 0], axes = [[0, 1, 0], [1, 1, 2]], angles = ["b", "c"] }\n',
    "sleeve and nut": "[coordinates]\na = 0.1\nb = 0.5\nc = 0.2\n"
    + WEIGHT
    + body('kind = "cylindrical", axis = [1, 2, 2], displacement = "a", angle = "b", force = "-a", torque = "2*t"')
    + '[bodies.second]\nmass = 1\ncenter = [0.1, 0, 0]\ninertia = [0.1, 0.2, 0.2]\njoint = { kind = "screw", '
    'on = "body", axis = [0, 0, 1], angle = "c", pitch = "d", stiffness = 2, damping = 0.1, armature = 0.03 }\n',
}


@pytest.mark.parametrize("name", CERTIFIED)
def test_every_description_is_certified(name):
    """Lagrange's equations in the rates, projection, recursion, free bodies, reactions, code: all agree."""
    certificate = derived(INERTIA + CERTIFIED[name]).certify()
    assert certificate.ok, str(certificate)


def test_a_free_particle_needs_no_orientation():
    """m r'' = m g + T u on a thread of length l: T = m (v^2/l + g cos a), at rest in the vertical m g."""
    text = "[parameters]\nm = 0.7\ng = 9.81\n[coordinates]\nx = 0\ny = 0\nz = -2\n" + WEIGHT
    text += '[bodies.bob]\nshape = { kind = "particle", mass = "m" }\n'
    text += 'joint = { kind = "free", position = ["x", "y", "z"] }\n'
    thread = '[points]\nO = [0, 0, 0]\n[constraints.thread]\nkind = "link"\npoints = ["O", "bob.center"]\n'
    moving = text.replace("x = 0", "x = { speed = 3 }") + thread + '[outputs]\nT = "tension(thread)"\n'
    answers = eomgen.solve(eomgen.loads(HEAD + moving))
    assert answers["T"].value == pytest.approx(0.7 * (9.81 + 9 / 2))
    assert answers.certify().ok
    run = eomgen.simulate(eomgen.loads(HEAD + text), time=1, samples=2)
    assert run["z"][-1] == pytest.approx(-2 - 9.81 / 2)
    assert eomgen.freedom_of(eomgen.loads(HEAD + text)).by_rank == 3


@pytest.mark.parametrize("turned", ["", ", angle = 0"], ids=["without", "with"])
def test_a_free_particle_in_the_plane_needs_no_angle(turned):
    """On a table that turns by b: v = l (b' + 3/l), T = m (g + v^2/l); nothing of the particle can turn."""
    text = """
[parameters]
m = 0.7
[coordinates]
x = { speed = 3 }
y = -2
b = { motion = "0.3*t" }
[points]
O = [0, 0]
[bodies.table]
mass = 1
inertia = 1
joint = { kind = "revolute", angle = "b" }
[bodies.bob]
shape = { kind = "particle", mass = "m" }
joint = { kind = "free", on = "table", x = "x", y = "y"TURNED }
[forces.weight]
kind = "gravity"
acceleration = [0, -9.81]
[constraints.thread]
kind = "link"
points = ["O", "bob.center"]
[outputs]
T = "tension(thread)"
v = "speed(bob.center)"
"""
    model = eomgen.loads(PLANE + text.replace("TURNED", turned))
    answers = eomgen.solve(model)
    assert answers["v"].value == pytest.approx(3 + 2 * 0.3)
    assert answers["T"].value == pytest.approx(0.7 * (9.81 + 3.6**2 / 2))
    assert answers.certify().ok
    assert eomgen.freedom_of(model).by_rank == 1


@pytest.mark.parametrize("body", ['shape = { kind = "rod", mass = 1, length = 2 }', "mass = 1\ninertia = 0.1"])
def test_a_free_body_in_the_plane_that_can_turn_needs_an_angle(body):
    """A rod without one is an error that names it."""
    joint = 'joint = { kind = "free", x = "x", y = "y" }'
    with pytest.raises(eomgen.ModelError, match="the joint of body 'b' has no 'angle'"):
        eomgen.loads(PLANE + f"[coordinates]\nx = 0\ny = 0\n[bodies.b]\n{body}\n{joint}\n")


def test_a_free_body_that_can_turn_needs_an_orientation():
    """A box without one is an error that names it."""
    text = "[coordinates]\nx = 0\ny = 0\nz = 0\n" + INERTIA + body('kind = "free", position = ["x", "y", "z"]')
    with pytest.raises(eomgen.ModelError, match="has no 'orientation'"):
        eomgen.loads(HEAD + text)


def test_a_nut_screws_itself_down():
    """(C + m h^2) a'' = -m g h, and the thread carries m (g + h a'')."""
    text = INERTIA + "[coordinates]\na = 0\n" + body('kind = "screw", axis = [0, 0, 1], angle = "a", pitch = "d"')
    text += WEIGHT + '[outputs]\na = "a\'\'"\nR = "reaction_z(body)"\n'
    answers = eomgen.solve(eomgen.loads(HEAD + text))
    assert answers["a"].value == pytest.approx(-0.7 * 9.81 * 0.2 / (3.1 + 0.7 * 0.04))
    assert answers["R"].value == pytest.approx(0.7 * (9.81 + 0.2 * answers["a"].value))


def test_declared_speeds_move_a_linkage_as_the_rates_do():
    """x' of a dependent coordinate as the speed of a slider-crank: the same course of the crank."""
    text = """
eomgen = 1
space = "plane"
[parameters]
l = 0.5
[coordinates]
a = { start = 0.6 %s }
b = { dependent = true, near = -0.6 }
x = { dependent = true, near = 0.8 }
[bodies.crank]
shape = { kind = "rod", mass = 1, length = "l" }
joint = { kind = "revolute", angle = "a" }
[bodies.bar]
shape = { kind = "rod", mass = 1, length = "l" }
joint = { kind = "revolute", on = "crank.end", angle = "b - a" }
[constraints.pin]
kind = "slider"
point = "bar.end"
on = "rail"
[bodies.rail]
points = { A = [0, 0], B = [1, 0] }
line = ["A", "B"]
[bodies.block]
shape = { kind = "particle", mass = 2 }
joint = { kind = "prismatic", axis = [1, 0], displacement = "x" }
[constraints.P]
kind = "pin"
points = ["bar.end", "block.center"]
[forces.weight]
kind = "gravity"
acceleration = [0, -9.81]
"""
    rates = eomgen.derive(eomgen.loads(text % ", speed = -1"))
    declared = eomgen.derive(eomgen.loads(text % ", speed = -1" + '[speeds]\nv = "3*x\'"\n'))
    assert declared.certify().ok
    assert declared.speeds == ("v",)
    v = 3 * 2 * 0.5 * np.sin(0.6)  # x = 2 l cos(a), a' = -1
    assert declared.rhs("numpy").x0[-1] == pytest.approx(v)
    runs = [eomgen.simulate(equations.model, time=0.2) for equations in (rates, declared)]
    assert runs[0].x[-1, :3] == pytest.approx(runs[1].x[-1, :3], abs=1e-8)


def test_gimbal_lock_is_named():
    """At theta = 0 two of the three axes are one."""
    run = eomgen.simulate(eomgen.loads(HEAD + INERTIA + ANGLES.replace("0.7", "0") + BY_ANGLES + WEIGHT), time=1)
    assert not run.ok
    assert "'body'" in run.message and "gimbal lock" in run.message


def test_speeds_that_do_not_determine_the_rates_somewhere_are_named():
    """v = sin(a) a' gives no a' at a = 0."""
    declared = '[coordinates]\na = 0\n[speeds]\nv = "sin(a)*a\'"\n'
    hinge = body('kind = "revolute", axis = [1, 0, 0], angle = "a"')
    run = eomgen.simulate(eomgen.loads(HEAD + INERTIA + declared + hinge), time=1)
    assert not run.ok
    assert "declared speeds do not determine" in run.message


@pytest.mark.parametrize(
    ("text", "what"),
    [
        (ANGLES + "[speeds]\na = \"psi' + theta'\"\nb = \"2*psi' + 2*theta'\"\n" + BY_ANGLES, "depend on one another"),
        (ANGLES + "[speeds]\na = \"psi' + theta'\"\n" + BY_ANGLES, "1 speed is declared for 2 rates"),
        (ANGLES + '[speeds]\na = "psi\'^2"\n' + BY_ANGLES, "not linear"),
        (FOUR.replace("e0 = 1", 'e0 = { motion = "cos(t)" }') + SPHERICAL, "four are free together"),
        (FOUR.replace("w1 = {", 'w1 = { rate = "e1\'",') + SPHERICAL, "leave out the 'rate'"),
        (FOUR.replace('"e3"', '"e2"') + SPHERICAL.replace('"e3"]', '"e2"]'), "stands twice"),
        (
            "[coordinates]\na = 0\nb = 0\n"
            + body('kind = "universal", axes = [[1, 0, "m"], [2, 0, "2*m"]], angles = ["a", "b"]'),
            "parallel",
        ),
    ],
)
def test_what_does_not_determine_a_motion_is_refused(text, what):
    """One clear error, with the fix."""
    with pytest.raises(eomgen.ModelError) as caught:
        derived(INERTIA + text)
    assert what in str(caught.value)


def test_a_quaternion_cannot_start_at_zero():
    """No turn has norm 0."""
    zero = "[coordinates]\ne0 = 0\ne1 = 0\ne2 = 0\ne3 = 0\n[speeds]\nw1 = {}\nw2 = {}\nw3 = {}\n"
    with pytest.raises(eomgen.EomgenError, match="at 0"):
        eomgen.simulate(eomgen.loads(HEAD + INERTIA + zero + SPHERICAL), time=1)


def test_random_states_lie_on_the_sphere_of_a_quaternion():
    """e . e = 1 is an identity where values are chosen, and e0 = e1 is not."""
    equations = derived(INERTIA + FOUR + SPHERICAL)
    e0, e1, e2, e3 = equations.system.scope.symbols.q
    assert equal_at_random_states([(e0 * e0 + e1 * e1 + e2 * e2 + e3 * e3, 1)]).equal
    assert not equal_at_random_states([(e0, e1)]).equal
