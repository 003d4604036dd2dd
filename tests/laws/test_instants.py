"""Instants: in numbers and in closed form they agree with the textbook and with an integration of their own."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest
from each import each
from scipy.integrate import solve_ivp
from slow_run import in_slow_run

import eomgen
from eomgen.codegen.program import Program
from eomgen.codegen.rhs import RightHandSide
from eomgen.errors import RunFailed
from eomgen.mechanics.dynamics.accelerations import with_accelerations
from eomgen.mechanics.integrals.first_integrals import FirstIntegrals
from eomgen.mechanics.integrals.laws import position_equations
from eomgen.mechanics.kinematics.places import Located
from eomgen.mechanics.start.exact import declared_start
from eomgen.mechanics.start.state import Start
from eomgen.simulation.event_location import Events
from eomgen.simulation.integrator import Run, Stepping, march
from eomgen.study import StateAtInstant, Study, study_of
from eomgen.study.motion import reached
from eomgen.symbolic.exact.equality import equal_at_random_states
from eomgen.symbolic.expression.derivatives import substituted
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
v = 6.1
"""
WEIGHT = '[forces.weight]\nkind = "gravity"\nacceleration = [0, "-g"]\n'
PARTICLE = 'shape = { kind = "particle", mass = "m" }\n'
BAR = (
    """
[coordinates]
theta = { start = "START", speed = "SPEED" }
[bodies.bar]
shape = { kind = "rod", mass = "m", length = "l" }
joint = { kind = "revolute", at = [0, 0], angle = "theta - pi/2" }
"""
    + WEIGHT
)
THROW = (
    """
[coordinates]
x = { start = 0, speed = "v*cos(pi/3)" }
y = { start = "l", speed = "v*sin(pi/3)" }
[bodies.ball]
shape = { kind = "particle", mass = "m" }
joint = { kind = "placed", at = ["x", "y"] }
"""
    + WEIGHT
)
DRAG = '[forces.drag]\nkind = "force"\npoint = "ball.center"\nforce = ["-c*m*x\'", "-c*m*y\'"]\n'
ORBIT = """
[coordinates]
r = { start = "l", speed = 0 }
phi = { start = 0, speed = "v/l" }
[points]
O = [0, 0]
[bodies.ball]
shape = { kind = "particle", mass = "m" }
joint = { kind = "placed", at = ["r*cos(phi)", "r*sin(phi)"] }
[forces.attraction]
kind = "between"
points = ["O", "ball.center"]
pull = "2*m*l*v^2/(3*r^2)"
"""
STANDING_BAR = (
    """
[coordinates]
x = { start = 0.4 }
theta = 0
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
BLOCK = """
[coordinates]
x = { start = 0, speed = "v" }
[bodies.block]
shape = { kind = "particle", mass = "m" }
joint = { kind = "prismatic", axis = [1, 0], displacement = "x", FORCES }
"""
CRANK = (
    """
[coordinates]
theta = 0
phi = { dependent = true, near = 0.2 }
x = { dependent = true, near = "4*l" }
[bodies.OA]
shape = { kind = "rod", mass = "3*m", length = "2*l" }
joint = { kind = "revolute", at = [0, 0], angle = "-theta" }
[bodies.AB]
shape = { kind = "rod", mass = "3*m", length = "2*l" }
joint = { kind = "revolute", on = "OA.end", angle = "phi + theta" }
[bodies.B]
shape = { kind = "particle", mass = "2*m" }
joint = { kind = "prismatic", axis = [1, 0], displacement = "x" }
[constraints.pin]
kind = "pin"
points = ["AB.end", "B.center"]
"""
    + WEIGHT
)
PARALLELOGRAM = (
    """
[coordinates]
theta = 0
phi = { dependent = true, near = 0 }
psi = { dependent = true, near = 0 }
[bodies.OA]
shape = { kind = "rod", mass = "3*m", length = "2*l" }
joint = { kind = "revolute", at = [0, 0], angle = "-theta" }
[bodies.AB]
shape = { kind = "rod", mass = "4*m", length = "3*l" }
joint = { kind = "revolute", on = "OA.end", angle = "theta + phi" }
[bodies.CB]
shape = { kind = "rod", mass = "3*m", length = "2*l" }
joint = { kind = "revolute", at = ["3*l", 0], angle = "-psi" }
[constraints.B]
kind = "pin"
points = ["AB.end", "CB.end"]
"""
    + WEIGHT
)
ATWOOD = (
    HEAD
    + """
[coordinates]
s = 0
[bodies.P]
shape = { kind = "particle", mass = "2*m" }
joint = { kind = "placed", at = [0, "-s"] }
[bodies.Q]
shape = { kind = "particle", mass = "m" }
joint = { kind = "placed", at = [1, "s"] }
"""
    + WEIGHT
)


def bar(start: str, speed: str = "0") -> str:
    return HEAD + BAR.replace("START", start).replace("SPEED", speed)


def requested(text: str, condition: str) -> tuple[Study, StateAtInstant]:
    """The instant at which the condition (= 0) holds."""
    each = study_of(eomgen.loads(text))
    symbols = each.system.symbols
    start = declared_start(each.system, at_rest=False)
    numbers: dict = {}
    if not any(part.value is None for part in each.model.parameters.values()):
        values = Start.of(each.system).values
        numbers = {node: values[node.name] for node in symbols.x}
        start |= exact_places(each, start, numbers)
    scalar = each.of_state(parse(condition, references=True))
    return each, reached(each, scalar, start, numbers)


def exact_places(each: Study, start: dict, numbers: dict) -> dict:
    """Dependent coordinates at the start in closed form."""
    symbols = each.system.symbols
    values = each.model.numeric_parameters()
    located = Located({symbols.parameters[n]: x for n, x in values.items()} | numbers, each.system.scope.positive)
    gaps = [*position_equations(each.system, start), *(q - start[q] for q in symbols.q if q in start)]
    return located.places(gaps, [q for q in symbols.q])


def is_exactly(each: Study, found: Any, expected: str) -> bool:
    """Whether a scalar is the function that a text says."""
    names = {**each.system.symbols.parameters, "pi": each.system.symbols.graph.pi}
    return equal_at_random_states([(found, parse(expected).evaluate(names))]).equal


# (model, condition) -> what is known of the instant, in the parameters; and how it is found
KNOWN: dict[str, tuple[str, str, dict[str, str], str]] = {
    "bar from the horizontal": (
        bar("pi/2"),
        "theta",
        {"theta": "0", "theta'": "-sqrt(3*g/l)"},
        "energy theorem",
    ),
    "bar at an angle": (
        bar("pi/2"),
        "cos(theta) - 2/3",
        {"theta": "acos(2/3)", "theta'": "-sqrt(2*g/l)"},
        "energy theorem",
    ),
    "bar turns back": (
        bar("0", "sqrt(g/l)"),
        "theta'",
        {"theta": "acos(2/3)", "theta'": "0"},
        "energy theorem",
    ),
    "bar comes back": (
        bar("pi/3"),
        "theta + pi/3",
        {"theta": "-pi/3", "theta'": "0"},
        "energy theorem",
    ),
    "bar on its head": (
        bar("pi"),
        "theta - 3*pi/2",
        {"theta": "3*pi/2", "theta'": "sqrt(3*g/l)"},
        "energy theorem",
    ),
    "bar after a full turn": (
        bar("0", "4*sqrt(g/l)"),
        "theta - 5*pi/2",
        {"theta'": "sqrt(13*g/l)"},
        "energy theorem",
    ),
    "joint pulls no more": (
        bar("0", "3*sqrt(g/l)"),
        "3*g*cos(theta)/l + theta'^2 - 13/2*g/l",
        {"theta": "acos(1/12)"},
        "energy theorem",
    ),
    "standing bar": (
        HEAD + STANDING_BAR,
        "theta - pi/2",
        {"x": "0.4", "x'": "0", "theta'": "sqrt(3*g/(2*l))"},
        "energy theorem",
    ),
    "throw, highest point": (
        HEAD + THROW,
        "y'",
        {"t": "sqrt(3)/2*v/g", "y": "l + 3*v^2/(8*g)", "x": "sqrt(3)/4*v^2/g"},
        "law of motion",
    ),
    "throw, ground": (
        HEAD + THROW,
        "y",
        {"t": "(sqrt(3)/2*v + sqrt(3/4*v^2 + 2*g*l))/g", "y'": "-sqrt(3/4*v^2 + 2*g*l)"},
        "law of motion",
    ),
    "throw with drag, highest point": (
        HEAD + THROW + DRAG,
        "y'",
        {"t": "log(1 + c*v*sqrt(3)/(2*g))/c", "x'": "v/2/(1 + c*v*sqrt(3)/(2*g))"},
        "law of motion",
    ),
    "orbit, far end": (
        HEAD + ORBIT,
        "r'",
        {"r": "3*l", "r'": "0", "phi'": "v/(9*l)"},
        "energy theorem",
    ),
    "orbit, on the way": (
        HEAD + ORBIT,
        "r - 2*l",
        {"r'": "v/(2*sqrt(3))", "phi'": "v/(4*l)"},
        "energy theorem",
    ),
    "Atwood's machine": (ATWOOD, "s - l", {"t": "sqrt(6*l/g)", "s'": "sqrt(2*g*l/3)"}, "law of motion"),
    "given time": (ATWOOD, "t - 3", {"s": "3*g/2", "s'": "g"}, "law of motion"),
    "spring turns back": (
        HEAD + BLOCK.replace("FORCES", 'stiffness = "k"'),
        "x'",
        {"t": "pi/2*sqrt(m/k)", "x": "v*sqrt(m/k)"},
        "law of motion",
    ),
    "spring, second zero": (
        HEAD + BLOCK.replace("FORCES", 'stiffness = "k"'),
        "x",
        {"t": "pi*sqrt(m/k)", "x'": "-v"},
        "law of motion",
    ),
    "quadratic drag": (
        HEAD + BLOCK.replace("FORCES", 'force = "-c*x\'^2 - F"'),
        "x'",
        {"x": "m/(2*c)*log(1 + c*v^2/F)"},
        "energy theorem",
    ),
    "slider-crank": (
        HEAD
        + CRANK.replace("theta = 0", 'theta = "pi/6"')
        .replace('near = "4*l"', 'near = "3.5*l"')
        .replace("near = 0.2", "near = 0.5"),
        "theta - pi/3",
        {"phi": "pi/3", "x": "2*l"},
        "energy theorem",
    ),
    "parallelogram, all hinges in line": (
        HEAD + PARALLELOGRAM,
        "theta - pi/2",
        {"phi": "0", "psi": "pi/2", "theta'": "sqrt(7*g/(6*l))"},
        "energy theorem",
    ),
}


@each("name", KNOWN)
def test_the_instant_in_closed_form_is_the_textbook_s(name):
    """What is known of the state, as functions of the parameters."""
    text, condition, expected, method = KNOWN[name]
    each, instant = requested(text, condition)
    by_name = {node.name: x for node, x in instant.exact.items()}
    for quantity, value in expected.items():
        assert quantity in by_name and is_exactly(each, by_name[quantity], value), quantity
    assert instant.method == method


@each("name", KNOWN)
def test_the_instant_in_closed_form_is_the_one_located(name):
    """exact = number, of every coordinate and speed."""
    text, condition, _, _ = KNOWN[name]
    each, instant = requested(text, condition)
    values = {each.system.symbols.parameters[n]: x for n, x in each.model.numeric_parameters().items()}
    for node, x in instant.exact.items():
        number = instant.numbers[node]
        assert math.isnan(number) or evaluate((x,), values, FLOAT)[0] == pytest.approx(number, rel=1e-8, abs=1e-8)


@in_slow_run
@each("name", KNOWN)
def test_the_numbers_are_those_of_an_integration_and_keep_the_energy(name):
    """The state of scipy's integration at the same time; E = E(start) also where the time is not known."""
    text, condition, _, _ = KNOWN[name]
    each, instant = requested(text, condition)
    symbols = each.system.symbols
    nodes = symbols.x
    values = {symbols.parameters[n]: x for n, x in each.model.numeric_parameters().items()}
    first = Start.of(each.system).values
    for integral in FirstIntegrals(each.equations).of_energy:
        known = {u: 0 for u in symbols.u if first[u.name] == 0}  # where all hinges are in line, T needs u = 0
        (begin,) = substituted((integral.expression,), known)
        at = [
            values | {node: state[node] for node in nodes}
            for state in ({node: first[node.name] for node in nodes}, instant.numbers)
        ]
        energies = [evaluate((x,), state, FLOAT)[0] for x, state in zip((begin, integral.expression), at, strict=True)]
        assert energies[1] == pytest.approx(energies[0], rel=1e-9, abs=1e-9)
    t = instant.numbers[symbols.t]
    if math.isnan(t):
        return
    rhs = RightHandSide.of(Program.right_hand_side(with_accelerations(each.equations)), "numpy")
    p = np.array(list(values.values()))
    x0 = [first[node.name] for node in nodes]
    run = solve_ivp(lambda t, x: rhs(t, x, p), (0, t), x0, rtol=1e-11, atol=1e-11, method="DOP853")
    assert run.y[:, -1] == pytest.approx([instant.numbers[node] for node in nodes], rel=1e-6, abs=1e-6)


def test_an_instant_without_closed_form_stays_a_number():
    """The landing of a throw with drag is transcendental: y = 0 is known exactly, t, x and the speeds are numbers."""
    each, instant = requested(HEAD + THROW + DRAG, "y")
    assert {node.name for node in instant.exact} == {"y"}
    assert instant.method == "integration in time"
    t, y = each.system.symbols.t, each.system.symbols.q[1]
    assert instant.numbers[y] == pytest.approx(0, abs=1e-11)
    c, g, rise = 1.1, 9.81, 6.1 * math.sqrt(3) / 2
    fallen = 0.7 + (rise + g / c) / c * (1 - math.exp(-c * instant.numbers[t])) - g / c * instant.numbers[t]
    assert fallen == pytest.approx(0, abs=1e-10)


def test_closed_forms_need_no_values():
    """Without values of the parameters the instant is exact and has no numbers."""
    text = bar("pi/2").replace("m = 1.3", "m = {}").replace("g = 9.81", "g = {}").replace("l = 0.7", "l = {}")
    each, instant = requested(
        text.replace("[parameters]", "[parameters]").replace("{}", "{ positive = true }"), "theta"
    )
    (u,) = each.system.symbols.u
    assert instant.numbers == {} and is_exactly(each, instant.exact[u], "-sqrt(3*g/l)")


@each("condition", ["theta - 3", "theta' - 100", "t + 1"])
def test_what_never_holds_is_refused(condition):
    """A pendulum from the horizontal does not come to 3 rad."""
    with pytest.raises(eomgen.EomgenError):
        requested(bar("pi/2"), condition)


def test_two_freedoms_at_rest_are_refused():
    """An upright double pendulum could fall either way, and energy alone does not say how."""
    model = eomgen.load("models/double_pendulum.toml")
    each = study_of(model)
    symbols = each.system.symbols
    start = {**dict.fromkeys(symbols.q, symbols.graph.pi), **dict.fromkeys(symbols.u, 0)}
    numbers = {**dict.fromkeys(symbols.q, math.pi), **dict.fromkeys(symbols.u, 0.0)}
    with pytest.raises(RunFailed, match="rests at the start"):
        reached(each, symbols.q[0], start, numbers)


# -- conditions along an even motion ---------------------------------------------------------------


def met(*conditions, end: float = 100.0) -> Run:
    """x = t until the first condition is 0, from either side, or the second falls to 0."""
    events = Events(lambda t, x: np.hstack([each(x) for each in conditions]), np.full(len(conditions), 1e-9), (0,))
    return march(lambda t, x: np.ones(1), (0.0, end), np.zeros(1), how=Stepping(), events=events)


def test_a_zero_at_the_start_is_not_the_first():
    """sin(t) = 0 at pi, not at 0."""
    assert met(np.sin).end == pytest.approx(math.pi, abs=1e-14)


def test_an_extremum_at_zero_is_a_zero():
    """1 - cos(t) touches 0 at 2 pi."""
    assert met(lambda x: 1 - np.cos(x)).end == pytest.approx(2 * math.pi, abs=1e-12)


def test_no_step_is_too_long_for_the_condition():
    """x grows evenly, and the integrator could leap; cos(40 x) = 0 first at pi/80."""
    assert met(lambda x: np.cos(40 * x)).end == pytest.approx(math.pi / 80, abs=1e-14)


def test_small_conditions_are_as_good_as_large_ones():
    """1e-12 (x - 3) is 0 at 3."""
    assert met(lambda x: 1e-12 * (x - 3)).end == pytest.approx(3, abs=1e-13)


@each("ends", [{"end": 5.0}, {"second": lambda x: 2.0 - x}])
def test_a_path_that_ends_before_is_refused(ends):
    """x = 10 is not met within 5, nor where the path ends at 2."""
    found = met(lambda x: x - 10, *([ends["second"]] if "second" in ends else []), end=ends.get("end", 100.0))
    assert (found.status, found.end) == (("event", pytest.approx(2)) if "second" in ends else ("finished", 5))


def test_a_motion_without_a_beginning_is_refused_at_once():
    """A damper of no length has no direction: no step of time is short enough, and that is said."""
    model = eomgen.loads("""
eomgen = 1
name = "damper of no length"
space = "plane"
[coordinates]
s = { start = 0, speed = 1 }
[points]
O = [0, 0]
[bodies.box]
shape = { kind = "particle", mass = 2 }
joint = { kind = "placed", at = ["s", 0] }
[forces.drag]
kind = "damper"
points = ["box.center", "O"]
damping = 0.4
[outputs]
s = { value = "s", at = "t = 1" }
""")
    assert "force 'drag' is 0/0 at s = 0" in (eomgen.solve(model)["s"].message or "")
    found = march(lambda t, x: np.full(1, math.nan), (0.0, 1.0), np.zeros(1), how=Stepping())
    assert (found.status, found.steps) == ("not finite", 0)


OVERDAMPED = """
eomgen = 1
name = "A rod in thick oil"
space = "plane"
[parameters]
m = 1
l = 1
g = 9.81
c = 5000
[coordinates]
phi = { start = 1.2 }
[bodies.rod]
shape = { kind = "rod", mass = "m", length = "l" }
joint = { kind = "revolute", angle = "phi", damping = "c" }
[forces.weight]
kind = "gravity"
acceleration = [0, "-g"]
[outputs]
w = { value = "phi'", at = "phi = 1.195" }
p = { value = "phi", at = "t = 30" }
"""


def test_an_instant_of_a_stiff_motion_is_reached():
    """c phi' = -m g l cos(phi)/2 after I/c = 67 us: ln tan(pi/4 + phi/2) falls by m g l t/(2 c); proven too."""
    answers = eomgen.solve(eomgen.loads(OVERDAMPED))
    moment = 9.81 / 2
    assert answers["w"].value == pytest.approx(-moment * math.cos(1.195) / 5000, rel=1e-6)
    p = 2 * math.atan(math.tan(math.pi / 4 + 0.6) * math.exp(-moment * 30 / 5000)) - math.pi / 2
    assert answers["p"].value == pytest.approx(p, rel=1e-6)
    certificate = answers.certify()
    assert certificate.ok
    assert [x.status for x in certificate.checks if x.name == "a run in time leads to the requested instants"] == [
        "holds"
    ]
