"""First integrals stay constant; the speeds that follow from them, and laws of motion, are those of the motion."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from each import each
from scipy.integrate import solve_ivp
from slow_run import in_slow_run

import eomgen
from eomgen.codegen.program import Program
from eomgen.codegen.rhs import RightHandSide
from eomgen.mechanics.dynamics.accelerations import with_accelerations
from eomgen.mechanics.integrals import first_integrals as integrals
from eomgen.mechanics.integrals.first_integrals import FirstIntegrals
from eomgen.mechanics.integrals.laws import laws_of_motion
from eomgen.mechanics.integrals.speeds import rates_of
from eomgen.study import Study, study_of
from eomgen.symbolic.exact.equality import equal_at_random_states
from eomgen.symbolic.expression.derivatives import depends_on, substituted
from eomgen.symbolic.expression.text import parse
from eomgen.symbolic.numeric.evaluation import FLOAT, evaluate

pytestmark = pytest.mark.slow

HEAD = """
eomgen = 1
name = "system"
space = "plane"
[parameters]
m = 1.3
l = 0.7
g = 9.81
k = 20
c = 1.1
F = 3.1
mu = 0.2
v = 2.1
"""
WEIGHT = '[forces.weight]\nkind = "gravity"\nacceleration = [0, "-g"]\n'
PARTICLE = 'shape = { kind = "particle", mass = "m" }\n'

PENDULUM = (
    HEAD
    + """
[coordinates]
theta = { start = 0.4, speed = 1.5 }
[bodies.bar]
shape = { kind = "rod", mass = "m", length = "l" }
joint = { kind = "revolute", at = [0, 0], angle = "theta - pi/2" }
"""
    + WEIGHT
)

FALLING_BAR = (
    HEAD
    + """
[coordinates]
x = { start = 0, speed = "v" }
theta = { start = 0.3, speed = 0.2 }
[bodies.bar]
shape = { kind = "rod", mass = "m", length = "2*l" }
joint = { kind = "placed", point = "center", at = ["x", "l*cos(theta)"], angle = "theta + pi/2" }
[constraints.floor]
kind = "support"
point = "bar.start"
normal = [0, 1]
"""
    + WEIGHT
)

ORBIT = (
    HEAD
    + """
[coordinates]
r = { start = "l", speed = 0.3 }
phi = { start = 0, speed = 2.9 }
[points]
O = [0, 0]
[bodies.ball]
shape = { kind = "particle", mass = "m" }
joint = { kind = "placed", at = ["r*cos(phi)", "r*sin(phi)"] }
[forces.attraction]
kind = "between"
points = ["O", "ball.center"]
pull = "k/r^2"
"""
)

LADDER_OF_THREE = (
    HEAD
    + """
[coordinates]
x = { start = "2*l*sin(0.3)" }
y = { start = "2*l*cos(0.3)" }
theta = 0.3
[bodies.foot]
joint = { kind = "prismatic", axis = [1, 0], displacement = "x" }
[bodies.bar]
shape = { kind = "rod", mass = "m", length = "2*l" }
joint = { kind = "revolute", on = "foot", angle = "theta + pi/2" }
[bodies.slide]
joint = { kind = "prismatic", axis = [0, 1], displacement = "y" }
[constraints.top]
kind = "pin"
points = ["bar.end", "slide.origin"]
"""
    + WEIGHT
)

PUSHED = (
    HEAD
    + """
[coordinates]
theta = { start = 0.4, speed = 0.5 }
[bodies.bar]
shape = { kind = "rod", mass = "m", length = "l" }
joint = { kind = "revolute", at = [0, 0], angle = "theta", torque = "c" }
[forces.dead]
kind = "force"
point = "bar.end"
force = ["F", "2*F"]
"""
    + WEIGHT
)

FOLLOWER = PUSHED.replace('["F", "2*F"]', '["-F*sin(theta)", "F*cos(theta)"]').replace(', torque = "c"', "")

INCLINE = (
    HEAD
    + """
[coordinates]
x = { start = 0, speed = "v" }
[bodies.block]
shape = { kind = "particle", mass = "m" }
joint = { kind = "placed", at = ["x*cos(pi/6)", "x*sin(pi/6)"] }
[constraints.plane]
kind = "support"
point = "block.center"
normal = ["-sin(pi/6)", "cos(pi/6)"]
friction = "mu"
"""
    + WEIGHT
)

ROUGH_RING = (
    HEAD
    + """
[coordinates]
theta = { start = 0.2, speed = 6 }
[bodies.bead]
shape = { kind = "particle", mass = "m" }
[bodies.bead.joint]
kind = "path"
along = "theta"
at = [0, 0]
heading = 0
pieces = [{ arc = 1, turn = "ccw", angle = 3, friction = "mu" }]
"""
    + WEIGHT
)

CART = (
    HEAD
    + """
[coordinates]
x = { start = 0, speed = 1 }
theta = { start = 0.1, speed = -2 }
[bodies.cart]
shape = { kind = "particle", mass = "2*m" }
joint = { kind = "placed", at = ["x", 0] }
[bodies.bob]
shape = { kind = "particle", mass = "m" }
joint = { kind = "placed", at = ["x + l*sin(theta)", "-l*cos(theta)"] }
"""
    + WEIGHT
)

ROPE = (
    HEAD
    + """
[coordinates]
y = { start = 0, speed = "-v" }
z = { start = 0, speed = "v" }
[bodies.one]
shape = { kind = "particle", mass = "m" }
joint = { kind = "placed", at = [0, "y"] }
[bodies.other]
shape = { kind = "particle", mass = "2*m" }
joint = { kind = "placed", at = [1, "z"] }
[constraints.rope]
kind = "equation"
gap = "y + z"
"""
    + WEIGHT
)

DROPPED = (
    HEAD
    + """
[coordinates]
y = "l"
[bodies.ball]
shape = { kind = "particle", mass = "m" }
joint = { kind = "placed", at = [0, "y"] }
"""
    + WEIGHT
)

ONE_WAY = {  # name -> (model, how far along the motion is followed: no speed changes its sign there)
    "pendulum": (PENDULUM, 0.1),
    "cart with a pendulum that goes the other way": (CART, 0.2),
    "two loads on a rope": (ROPE, 0.2),
    "a ball that is dropped": (DROPPED, 0.2),
    "falling bar": (FALLING_BAR, 0.2),
    "orbit": (ORBIT, 0.01),
    "ladder": (LADDER_OF_THREE, 0.3),
    "dead force": (PUSHED, 0.2),
    "follower force": (FOLLOWER, 0.02),
    "block on a rough plane": (INCLINE, 0.2),
    "bead on a rough ring": (ROUGH_RING, 0.1),
}

MODELS = Path(__file__).parents[2] / "models"


def phase(text: str) -> Study:
    return study_of(eomgen.loads(text))


def motion(each: Study, end: float) -> tuple[np.ndarray, list[dict]]:
    """(times, states by node with the parameters) of a run by scipy, to 1e-11."""
    system = each.system
    rhs = RightHandSide.of(Program.right_hand_side(with_accelerations(each.equations)), "numpy")
    parameters = each.model.numeric_parameters()
    p = np.array(list(parameters.values()))
    q, u = each.model.start_values()
    nodes = system.symbols.x
    x0 = [(q | u)[node.name] for node in nodes]
    times = np.linspace(0.0, end, 7)
    run = solve_ivp(lambda t, x: rhs(t, x, p), (0.0, end), x0, method="DOP853", rtol=1e-11, atol=1e-11, t_eval=times)
    fixed = {system.symbols.parameters[name]: value for name, value in parameters.items()}
    return times, [
        fixed | {system.symbols.t: t} | dict(zip(nodes, map(float, x), strict=True))
        for t, x in zip(times, run.y.T, strict=True)
    ]


def exact_start(each: Study) -> dict:
    scope = each.system.scope
    part = each.model.coordinates
    start = {q: scope.value(part[q.name].start) for q in scope.symbols.q}
    return start | {u: scope.value(part[u.name[:-1]].speed) for u in scope.symbols.u}


def _integrals(equations):
    return (*FirstIntegrals(equations).of_energy, *FirstIntegrals(equations).of_momentum)


@each("name", ONE_WAY)
def test_first_integrals_stay_constant(name):
    """E and p_k - integral of Q_k dt at seven instants of a motion."""
    text, end = ONE_WAY[name]
    each = phase(text)
    _, states = motion(each, end)
    for integral in _integrals(each.equations):
        values = [evaluate((integral.expression,), state, FLOAT)[0] for state in states]
        assert np.ptp(values) < 1e-8 * (1 + max(map(abs, values))), integral.name


@each(
    "name, expected",
    {
        "pendulum": {"energy"},
        "falling bar": {"energy", "momentum(x)"},
        "orbit": {"energy", "momentum(phi)"},
        "ladder": {"energy"},
        "dead force": {"energy"},
        "follower force": set(),
        "block on a rough plane": set(),
        "bead on a rough ring": set(),
    }.items(),
)
def test_the_integrals_of_a_system_are_found(name, expected):
    """Cyclic coordinates have momenta; energy stays where no force without potential works."""
    each = phase(ONE_WAY[name][0])
    assert {integral.name for integral in _integrals(each.equations) if integral.held.everywhere} == expected


def test_a_momentum_on_which_a_force_of_time_acts_grows_by_its_impulse():
    """m x' - (F/w)(1 - cos(w t)) is constant where F sin(w t) acts."""
    text = (
        HEAD
        + '[coordinates]\nx = { start = 0, speed = "v" }\n[bodies.b]\n'
        + PARTICLE
        + ('joint = { kind = "prismatic", axis = [1, 0], displacement = "x", force = "F*sin(c*t)" }\n')
    )
    each = phase(text)
    (integral,) = _integrals(each.equations)
    symbols = each.system.symbols
    names = {**symbols.parameters, "t": symbols.t, "x'": symbols.u[0]}
    expected = parse("m*x' - F/c*(1 - cos(c*t))").evaluate(names)
    assert equal_at_random_states([(integral.expression, expected)]).equal


@each("name", ONE_WAY)
def test_speeds_by_the_integrals_are_those_of_the_motion(name):
    """u(q) of the energy theorem and the momenta against u(t) at q(t)."""
    text, end = ONE_WAY[name]
    each = phase(text)
    rates = rates_of(each.equations, exact_start(each), accelerations=each.accelerations)
    assert rates is not None
    _, states = motion(each, end)
    for state in states[1:]:
        for u, rate in rates.items():
            assert not depends_on(rate, (*each.system.symbols.u, each.system.symbols.t))
            assert evaluate((rate,), state, FLOAT)[0] == pytest.approx(state[u], rel=1e-7, abs=1e-8)


def test_two_freedoms_without_momenta_have_no_speeds():
    """A double pendulum's speeds are no functions of its angles."""
    each = study_of(eomgen.load("models/double_pendulum.toml"))
    assert rates_of(each.equations, exact_start(each)) is None


def test_an_energy_with_an_unknown_start_is_refused():
    """V at a start that is not known exactly must not cancel against V."""
    each = phase(PENDULUM)
    start = {node: x for node, x in exact_start(each).items() if node.name != "theta"}
    with pytest.raises(eomgen.EomgenError, match="no closed form: theta"):
        rates_of(each.equations, start)


# -- laws of motion ----------------------------------------------------------------------------------

BLOCK = (
    HEAD
    + """
[coordinates]
x = { start = "l", speed = "v" }
[bodies.block]
shape = { kind = "particle", mass = "m" }
joint = { kind = "prismatic", axis = [1, 0], displacement = "x", FORCES }
"""
)
FORCES = {
    "nothing": "angle = 0",
    "constant force": 'force = "F"',
    "force of time": 'force = "F*sin(3*t) + F*t^2"',
    "linear drag": 'damping = "c"',
    "linear drag and weight": 'damping = "c", force = "F"',
    "spring": 'stiffness = "k"',
    "spring and constant force": 'stiffness = "k", force = "F"',
    "weak damping": 'stiffness = "k", damping = "c"',
    "critical damping": 'stiffness = "k", damping = "sqrt(4*k*m)"',
    "strong damping": 'stiffness = "k", damping = "30*c"',
    "repulsion": 'force = "k*x"',
    "driven oscillator": 'stiffness = "k", damping = "c", force = "F*sin(2*t) + F*exp(-t) + F*t^3"',
    "drag, force of time": 'damping = "c", force = "F*t + F*cos(2*t)"',
}
TWO_MASSES = """
[coordinates]
x = { start = "l", speed = "v" }
y = { start = 0.1, speed = -1 }
[bodies.A]
shape = { kind = "particle", mass = "m" }
joint = { kind = "prismatic", axis = [1, 0], displacement = "x", FORCES }
[bodies.B]
shape = { kind = "particle", mass = "2*m" }
joint = { kind = "prismatic", axis = [1, 0], displacement = "y", force = "F" }
[forces.between]
kind = "spring"
points = ["A.center", "B.center"]
stiffness = "k"
length = "l"
along = [1, 0]
"""
PUCK = (
    HEAD
    + """
[coordinates]
x = { start = "l", speed = "v" }
y = { start = 0.1, speed = -1 }
[bodies.puck]
shape = { kind = "particle", mass = "m" }
joint = { kind = "placed", at = ["x", "y"] }
[forces.push]
kind = "force"
point = "puck.center"
force = [FORCES]
"""
)
PUSHES = {
    "puck on a turntable": '"m*(c^2*x + 2*c*y\')", "m*(c^2*y - 2*c*x\')"',
    "puck on a turntable that leans": '"m*(c^2*x + 2*c*y\') + F", "m*(c^2*y - 2*c*x\')"',
    "pendulum of Foucault": '"-k*x + 2*c*y\'", "-k*y - 2*c*x\'"',
    "charge in crossed fields": '"F + c*y\'", "-c*x\'"',
    "spring and gyroscopic force": '"-k*x + c*y\'", "-2*k*y - c*x\'"',
    "a pair without a root of its own": '"m*(x - y)", "m*(x - y) + F"',
}
LAWS = {name: BLOCK.replace("FORCES", forces) for name, forces in FORCES.items()} | {
    "two masses and a spring": HEAD + TWO_MASSES.replace("FORCES", "angle = 0"),
    "two masses, one to the ground": HEAD + TWO_MASSES.replace("FORCES", 'stiffness = "3*k"'),
    **{name: PUCK.replace("FORCES", force) for name, force in PUSHES.items()},
    "throw with linear drag": HEAD
    + '[coordinates]\nx = { start = 0, speed = "v" }\ny = { start = "l", speed = "2*v" }\n[bodies.ball]\n'
    + PARTICLE
    + 'joint = { kind = "placed", at = ["x", "y"] }\n[forces.drag]\nkind = "force"\npoint = "ball.center"\n'
    + 'force = ["-c*x\'", "-c*y\'"]\n'
    + WEIGHT,
}


@in_slow_run
@each("name", LAWS)
def test_laws_of_motion_are_the_motion(name):
    """q(t) and u(t) in closed form against an integration in time."""
    each = phase(LAWS[name])
    laws = laws_of_motion(each.system, each.accelerations, exact_start(each))
    symbols = each.system.symbols
    assert {*symbols.x} <= laws.keys()
    _, states = motion(each, 1.3)
    for state in states:
        fixed = {node: value for node, value in state.items() if node not in laws}
        for node, law in laws.items():
            assert evaluate((law,), fixed, FLOAT)[0] == pytest.approx(state[node], rel=1e-8, abs=1e-8)


def test_a_law_from_a_later_start_counts_time_from_there():
    """x = x0 + v (t - t0) + F (t - t0)^2/(2 m)"""
    each = phase(LAWS["constant force"])
    symbols = each.system.symbols
    start = {**exact_start(each), symbols.t: symbols.parameters["c"]}
    laws = laws_of_motion(each.system, each.accelerations, start)
    names = {**symbols.parameters, "t": symbols.t}
    expected = parse("l + v*(t - c) + F*(t - c)^2/(2*m)").evaluate(names)
    assert equal_at_random_states([(laws[symbols.q[0]], expected)]).equal


@each("name", ["pendulum", "orbit", "bead on a rough ring"])
def test_what_is_not_linear_has_no_law(name):
    """No law is made up."""
    each = phase(ONE_WAY[name][0])
    assert laws_of_motion(each.system, each.accelerations, exact_start(each)) == {}


def test_friction_by_its_law_has_no_law_of_motion_before_its_sense_is_chosen():
    """x'' = -g (sin + mu cos sign(x')) is not linear in x'."""
    each = phase(INCLINE)
    assert laws_of_motion(each.system, each.accelerations, exact_start(each)) == {}


def test_dependent_coordinates_follow_by_integration():
    """A rolling disc's angle is -x/R where x is known as a function of time."""
    text = (
        HEAD
        + """
[coordinates]
x = { start = 0, speed = "v" }
phi = { dependent = true, start = 0.2 }
[bodies.disc]
shape = { kind = "disc", mass = "m", radius = "l" }
joint = { kind = "placed", at = ["x", "l"], angle = "phi" }
[constraints.floor]
kind = "rolling"
body = "disc"
line = { at = [0, 0], normal = [0, 1] }
[forces.push]
kind = "force"
point = "disc.center"
force = ["F", 0]
"""
    )
    each = phase(text)
    symbols = each.system.symbols
    start = exact_start(each) | {q: each.system.scope.value(each.model.coordinates[q.name].start) for q in symbols.q}
    laws = laws_of_motion(each.system, each.accelerations, start)
    x, phi = symbols.q
    (difference,) = substituted((phi - start[phi] + x / symbols.parameters["l"],), laws)
    assert equal_at_random_states([(difference, 0)]).equal


TWO_BODIES = """
eomgen = 1
space = "SPACE"
[parameters]
m1 = 2
m2 = 1
G = 1
[coordinates]
x1 = 0
y1 = { start = 0, speed = -0.3 }
x2 = 1
y2 = { start = 0, speed = 1.2 }
[bodies.A]
shape = { kind = "particle", mass = "m1" }
joint = { kind = "placed", at = ["x1", "y1"Z1] }
[bodies.B]
shape = { kind = "particle", mass = "m2" }
joint = { kind = "placed", at = ["x2", "y2"Z2] }
[forces.pull]
kind = "between"
points = ["A.center", "B.center"]
pull = "G*m1*m2/r^2"
"""


@each("space", ["plane", "space"])
def test_momenta_of_the_whole_stay_though_no_coordinate_is_cyclic(space):
    """Kepler's problem in coordinates of each body: P and L, beside roots that have no meaning in a prime field."""
    height = "z1 = 0\nz2 = { start = 0, speed = 0.2 }\n" if space == "space" else ""
    text = TWO_BODIES.replace("SPACE", space).replace("[bodies.A]", height + "[bodies.A]")
    for k in "12":
        text = text.replace(f"Z{k}", f', "z{k}"' if space == "space" else "")
    model = eomgen.loads(text)
    derivation = eomgen.derive(model).render("text")
    assert "P_x = m1*x1' + m2*x2'" in derivation
    assert "L_z = m1*x1*y1' - m1*y1*x1' - m2*y2*x2' + m2*x2*y2'" in derivation
    assert ("P_z = m1*z1' + m2*z2'" in derivation) is (space == "space")
    run = eomgen.simulate(model, time=5)
    L = 2 * (run["x1"] * run["y1'"] - run["y1"] * run["x1'"]) + run["x2"] * run["y2'"] - run["y2"] * run["x2'"]
    assert L == pytest.approx(np.full_like(L, 1.2), rel=1e-8)


@in_slow_run
def test_jacobis_integral_is_found_beside_a_root():
    """A bead on a spring in a tube that turns steadily: r' ^2/2 - Om^2 r^2/2 + V stays, with the length a root."""
    text = """
eomgen = 1
space = "plane"
[coordinates]
psi = { motion = "2*t" }
r = { start = 1, speed = 0.5 }
[bodies.tube]
joint = { kind = "revolute", angle = "psi" }
[bodies.bead]
shape = { kind = "particle", mass = 3 }
joint = { kind = "prismatic", on = "tube", at = [0, 0.2], axis = [1, 0], displacement = "r" }
[forces.spring]
kind = "spring"
points = ["tube.origin", "bead.center"]
stiffness = 70
length = 0.5
"""
    model = eomgen.loads(text)
    assert "Jacobi's integral" in eomgen.derive(model).render("text")
    run = eomgen.simulate(model, time=2)
    r, rate = run["r"], run["r'"]
    h = 1.5 * rate**2 - 1.5 * 4 * (r**2 + 0.04) + 35 * (np.hypot(r, 0.2) - 0.5) ** 2
    assert h == pytest.approx(np.full_like(h, h[0]), rel=1e-7)


def test_the_work_of_a_constant_couple_belongs_to_the_energy_that_stays():
    """1/2 m v^2 + 1/2 J w^2 - C phi; the angle of the body is an expression, phi = -x/l."""
    text = (
        HEAD
        + '[coordinates]\nx = 0\n[bodies.b]\nshape = { kind = "disc", mass = "m", radius = "l" }\n'
        + 'joint = { kind = "planar", x = "x", y = 0, angle = "-x/l" }\n'
        + '[forces.motor]\nkind = "couple"\nbody = "b"\ncouple = "F"\n'
    )
    each = phase(text)
    energy = FirstIntegrals(each.equations).of_energy[0]
    symbols = each.system.symbols
    names = {**symbols.parameters, "x": symbols.q[0], "x'": symbols.u[0]}
    expected = parse("3/4*m*x'^2 + F*x/l").evaluate(names)
    assert equal_at_random_states([(energy.expression, expected)]).equal


def test_what_is_seen_to_change_is_not_multiplied_out(monkeypatch):
    """Of twenty links none has a momentum that stays, and no rate is written out to see that."""
    read = []
    monkeypatch.setattr(integrals, "readable", lambda x, limit: read.append(x) or x)
    assert FirstIntegrals(eomgen.derive(MODELS / "chain20.toml").graph).of_momentum == ()
    assert read == []
