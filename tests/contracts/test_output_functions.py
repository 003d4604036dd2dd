"""What every output function promises: an example, its unit, its value by two ways, a row in the reference."""

from __future__ import annotations

import math
from dataclasses import replace
from fractions import Fraction
from functools import cache
from pathlib import Path
from random import Random

import pytest
from each import each

import eomgen
from eomgen.errors import DerivationError
from eomgen.mechanics.dynamics import formulations as recursive
from eomgen.mechanics.dynamics.system import System
from eomgen.mechanics.instant.quantities import Quantities
from eomgen.mechanics.statics.contacts import ContactsAtStart
from eomgen.model.outputs import ALL, FUNCTIONS
from eomgen.model.outputs import points as velocity
from eomgen.model.outputs.base import OutputSource
from eomgen.model.quantities import Unit
from eomgen.proof.at_a_state import NumericState
from eomgen.proof.instant import second_definition
from eomgen.results.small_motions.result import linearize
from eomgen.symbolic.expression.text import parse
from eomgen.symbolic.numeric import tolerances
from eomgen.symbolic.numeric.evaluation import NoValue

pytestmark = pytest.mark.slow

REFERENCE = (Path(__file__).parents[2] / "docs" / "reference" / "outputs.md").read_text(encoding="utf-8").splitlines()

MODELS = {
    "plane": """
eomgen = 1
space = "plane"
[parameters]
l = { value = 1.5, unit = "m" }
m = { value = 2, unit = "kg" }
k = { value = 30, unit = "N/m" }
b = { value = 0.3, unit = "N*m*s" }
g = { value = 9.81, unit = "m/s^2" }
w = { value = 3, unit = "rad/s" }
[coordinates]
psi = { motion = "sin(w*t)/2" }
x = { start = 0.2, unit = "m" }
q = { start = 0.7, unit = "rad" }
[points]
O = ["l/15", 0]
[bodies.table]
shape = { kind = "rectangle", mass = "3*m", width = "2*l", height = "l" }
joint = { kind = "revolute", at = "O", angle = "psi" }
[bodies.slide]
shape = { kind = "disc", mass = "m", radius = "l/9" }
joint = { kind = "prismatic", on = "table", at = ["l/5", "l/7"], axis = [1, 2], displacement = "x", stiffness = "k" }
[bodies.arm]
shape = { kind = "rod", mass = "m", length = "l" }
joint = { kind = "revolute", on = "slide", angle = "q", damping = "b" }
[forces.weight]
kind = "gravity"
acceleration = [0, "-g"]
[forces.string]
kind = "spring"
points = ["O", "arm.end"]
stiffness = "k"
length = "l/3"
[forces.oil]
kind = "torsion_damper"
bodies = ["table", "arm"]
damping = "b/2"
""",
    "space": """
eomgen = 1
space = "space"
[parameters]
l = { value = 1.5, unit = "m" }
m = { value = 2, unit = "kg" }
g = { value = 9.81, unit = "m/s^2" }
w = { value = 3, unit = "rad/s" }
[coordinates]
a = { start = 0.3, unit = "rad" }
b = { start = 0.4, unit = "rad" }
c = { motion = "w*t" }
[bodies.base]
shape = { kind = "box", mass = "m", size = ["l", "l/2", "l/3"] }
joint = { kind = "revolute", axis = [1, 2, 2], angle = "a" }
[bodies.tray]
joint = { kind = "revolute", on = "base", at = ["l/3", 0, "l/4"], axis = [0, 1, 0], angle = "c" }
[bodies.arm]
parts = [
    { kind = "cylinder", mass = "m", radius = "l/5", length = "l" },
    { kind = "particle", mass = "m/3", at = ["l/2", 0, 0] },
]
points = { tip = ["l/3", "l", "l/9"] }
joint = { kind = "revolute", on = "tray", at = [0, 0, "l"], axis = [3, 0, 4], angle = "b" }
[forces.weight]
kind = "gravity"
acceleration = [0, 0, "-g"]
""",
    "beam": """
eomgen = 1
space = "plane"
[parameters]
p = { value = 3.0, unit = "N/m" }
F = { value = 4.0, unit = "N" }
L = { value = 6.0, unit = "m" }
[bodies.beam]
points = { A = [0, 0], B = ["L", 0], D = ["4*L/3", 0] }
line = ["A", "D"]
[constraints]
A = { kind = "pin", points = ["beam.A"] }
B = { kind = "support", point = "beam.B", normal = [0, 1] }
[forces]
line_load = { kind = "distributed", body = "beam", between = ["A", "B"], intensities = [[0, 0], [0, "-p"]] }
tip = { kind = "force", point = "beam.D", force = ["F/2", "-F"] }
""",
    "block": """
eomgen = 1
space = "space"
[parameters]
m = { value = 2, unit = "kg" }
g = { value = 9.81, unit = "m/s^2" }
[coordinates]
x = { start = 0, speed = 3, unit = "m" }
y = { start = 0, speed = 1, unit = "m" }
[bodies.block]
shape = { kind = "particle", mass = "m" }
joint = { kind = "prismatic", axis = [1, 0, 0], displacement = "x" }
[bodies.rider]
shape = { kind = "particle", mass = "m" }
joint = { kind = "prismatic", on = "block", axis = [0, 1, 0], displacement = "y" }
[constraints.floor]
kind = "support"
point = "rider.center"
normal = [0, 0, 1]
friction = 0.2
[forces.weight]
kind = "gravity"
acceleration = [0, 0, "-g"]
""",
    "tied": """
eomgen = 1
space = "plane"
[parameters]
l = { value = 1.0, unit = "m" }
m = { value = 2, unit = "kg" }
g = { value = 9.81, unit = "m/s^2" }
[coordinates]
x = { start = 0, unit = "m" }
y = { start = "-l", unit = "m" }
[points]
O = [0, 0]
[bodies.bob]
shape = { kind = "particle", mass = "m" }
joint = { kind = "planar", x = "x", y = "y", angle = 0 }
[constraints]
rope = { kind = "link", points = ["O", "bob.center"], length = "l" }
[forces.weight]
kind = "gravity"
acceleration = [0, "-g"]
""",
    "struck": """
eomgen = 1
space = "space"
[parameters]
l = { value = 1.5, unit = "m" }
m = { value = 2, unit = "kg" }
e = 0.4
[coordinates]
a = { start = 0.2, unit = "rad" }
b = { start = 0.7, unit = "rad" }
[bodies.base]
shape = { kind = "box", mass = "m", size = ["l", "l/2", "l/3"] }
joint = { kind = "revolute", angle = "a", axis = [0, 1, 3] }
[bodies.arm]
shape = { kind = "rod", mass = "m", length = "l" }
joint = { kind = "revolute", on = "base", at = ["l/2", 0, 0], point = "start", axis = [0, 1, 0], angle = "b" }
[constraints.floor]
kind = "support"
point = "arm.end"
normal = [0, 0, 1]
at = [0, 0, "-9*l/10"]
unilateral = true
restitution = "e"
""",
    "coupled": """
eomgen = 1
space = "plane"
[parameters]
l = { value = 1.0, unit = "m" }
m = { value = 2, unit = "kg" }
g = { value = 9.81, unit = "m/s^2" }
[coordinates]
q = { start = 0.3, unit = "rad" }
s = { start = 0, unit = "m" }
[bodies.bob]
shape = { kind = "rod", mass = "m", length = "l" }
joint = { kind = "revolute", angle = "q" }
[bodies.cart]
shape = { kind = "particle", mass = "m" }
joint = { kind = "prismatic", axis = [1, 0], displacement = "s" }
[constraints]
same = { kind = "equation", gap = "s - l*q/2" }
[forces.weight]
kind = "gravity"
acceleration = [0, "-g"]
""",
    "stiff": """
eomgen = 1
space = "plane"
[parameters]
l = { value = 1.5, unit = "m" }
m = { value = 2, unit = "kg" }
g = { value = 9.81, unit = "m/s^2" }
T = { value = 3, unit = "N*m" }
[coordinates]
q = { start = 0.3, speed = 1, unit = "rad" }
[bodies.rod]
shape = { kind = "rod", mass = "m", length = "l" }
joint = { kind = "revolute", point = "start", angle = "q", friction = { torque = "T" } }
[forces.weight]
kind = "gravity"
acceleration = [0, "-g"]
""",
}
"""Models without a number that has a dimension: what is measured in other units is the same model."""
POINTS = ("arm.end", "arm.end, table", "arm.end, slide, table")
CALLS = {
    "plane": [
        *(f"{v}{axis}({point})" for v in ("", "v", "a") for axis in "xy" for point in POINTS),
        *(f"{name}(arm.end)" for name in ("speed", "acceleration", "tangential_acceleration", "normal_acceleration")),
        *(f"{name}(arm.end, table)" for name in ("speed", "acceleration", "curvature_radius")),
        *(f"{name}({pair})" for name in ("angle", "omega", "epsilon") for pair in ("arm", "arm, table")),
        *(f"rotation_center_{axis}({pair})" for axis in "xy" for pair in ("arm", "arm, table")),
        *(f"acceleration_pole_{axis}(arm)" for axis in "xy"),
        "least_speed(arm.start, arm.end)",
        *("kinetic_energy()", "kinetic_energy(arm)", "potential_energy()", "potential_energy(weight)"),
        *("power()", "power(string)", "power(weight)", "power(arm)"),
        *("generalized_force(x)", "generalized_force(q)", "momentum(x)", "momentum(q)", "drive(psi)"),
        *("pull(string)", "couple(oil)"),
        *("reaction_x(arm)", "reaction_y(arm, arm)", "reaction_couple(slide)", "mass_of(arm)"),
        *(f"principal_moment(arm.center, {n}, arm)" for n in (1, 2, 3)),
        *("inertia_point(O)", "inertia_axis(O, z, arm, slide)", "angular_momentum_z(O)"),
    ],
    "space": [
        *(f"{v}{axis}({point})" for v in ("", "v", "a") for axis in "xyz" for point in ("arm.tip", "arm.tip, base")),
        *(f"{part}_{v}{axis}(arm.tip, base)" for part, v in (("transport", "v"), ("transport", "a")) for axis in "xyz"),
        *(f"{part}_a{axis}(arm.tip, base, tray)" for part in ("coriolis", "euler", "centripetal") for axis in "xyz"),
        *(f"{part}_acceleration(arm.tip, base)" for part in ("transport", "coriolis", "euler", "centripetal")),
        *(
            "transport_speed(arm.tip, base)",
            "speed(arm.tip)",
            "curvature_radius(arm.tip)",
            "normal_acceleration(arm.tip)",
        ),
        *(f"{name}_{axis}({pair})" for name in ("omega", "epsilon") for axis in "xyz" for pair in ("arm", "arm, base")),
        *(f"{name}_{axis}(arm)" for name in ("omega", "epsilon") for axis in "123"),
        *("omega(arm)", "epsilon(arm)", "least_speed(arm.origin, arm.tip)", "kinetic_energy(arm)", "momentum(a)"),
        *(f"angular_momentum_{axis}(arm.tip)" for axis in "xyz"),
        *("inertia_point(arm.tip)", "inertia_axis(arm.tip, base.origin)", "inertia_plane(arm.tip, x)"),
        *("inertia_product(arm.tip, x, y)", "inertia_tensor(arm.tip, x, y, arm)", "inertia_tensor(arm.tip, y, y)"),
        *("mass_of(arm)", "mass_of(arm, 2)"),
        *(f"reaction{couple}_{axis}(base)" for couple in ("", "_couple") for axis in "xyz"),
    ],
    "beam": [f"{name}(beam, L/3)" for name in ("axial_force", "shear_force", "bending_moment")],
    "block": ["reaction_n(floor)", "reaction_t(floor)", "reaction_s(floor)"],
    "tied": ["tension(rope)"],
    "coupled": ["multiplier(same)"],
    "stiff": ["friction(rod)"],
    "struck": ["impulse(floor)", *(f"impulse_{axis}(arm)" for axis in "xyz"), "impulse_x(base)"],
}
ALONG = [f"{name}(q)" for name in "max min mean rms last time_of_max time_of_min period".split()]
LINEAR = {"plane": ["mass(x, q)", "damping(q, q)", "stiffness(x, x)", "frequency(1)"]}
CASES = [(model, call) for model, calls in CALLS.items() for call in calls]
PROVEN_TWICE = [case for case in CASES if FUNCTIONS[case[1].partition("(")[0]].second is not None]
SIZES = {"length": Fraction(2), "mass": Fraction(3), "time": Fraction(5)}
GAPS = {"same": "m", "rod": "rad", "floor": "m"}

# What has no second definition of its own, and why
CERTIFIED = {
    "generalized_force": "M a + c - Q agrees with inverse dynamics, body by body",
    "potential_energy": "the energy theorem holds along every motion",
    "mass_of": "",  # `inertia` proves the shape of each by a quadrature of its own boundary
}


@cache
def system(name: str):
    model = eomgen.loads(MODELS[name])
    return System.of(model, ContactsAtStart.of(model).modes)


def scaled(unit: Unit) -> Fraction:
    """How many times larger the number of something becomes when the units get smaller."""
    return SIZES["length"] ** unit.length * SIZES["mass"] ** unit.mass * SIZES["time"] ** unit.time


@cache
def state(name: str, *, units: bool = False) -> NumericState:
    """A random state of the model; the same in units that are smaller."""
    found, rng = system(name), Random(4)
    model, symbols = found.scope.model, found.symbols

    def of(unit: Unit | None) -> Fraction:
        return scaled(unit) if units and unit is not None else Fraction(1)

    parameters = {
        node: found.scope.graph.adopted(
            Fraction(str(model.parameters[n].value.evaluate({}))) * of(model.parameters[n].unit)
        )
        for n, node in symbols.parameters.items()
    }
    second = SIZES["time"] if units else Fraction(1)
    numbers = {symbols.t: float(Fraction(7, 10) * second)}
    for q in symbols.q:
        numbers[q] = float(Fraction(rng.randint(30, 90), 100) * of(model.coordinates[q.name].unit))
    for u in symbols.u:
        unit = model.coordinates[u.name.rstrip("'")].unit
        numbers[u] = float(Fraction(rng.randint(30, 90), 100) * of(unit) / second)
    return NumericState(recursive.assembled_by_recursion(found), parameters, numbers)


def value_of(name: str, call: str, *, units: bool = False) -> float:
    return state(name, units=units).value_of(parse(call, references=True))


def test_every_function_is_named_once_and_has_an_example():
    """FUNCTIONS has as many names as the members together, and each is called above."""
    assert len(FUNCTIONS) == sum(len(function.names) for function in ALL)
    called = {call.partition("(")[0] for calls in (*CALLS.values(), *LINEAR.values(), ALONG) for call in calls}
    assert called | {"az", "vz", "z"} >= FUNCTIONS.keys()


@each("function", ALL)
def test_the_reference_has_its_row(function):
    """docs/reference/outputs.md says of each what it is, in the words and the unit of its own file."""
    assert function.row in REFERENCE, "python docs/_ext/reference.py puts it there"


@each("function", ALL)
def test_what_has_no_second_definition_is_proven_otherwise(function):
    """By a check of the certificate; by the balance of the bodies, solved twice; by `linearize`; by a run's samples."""
    otherwise = CERTIFIED.keys() >= {*function.names} or function.source in (
        OutputSource.BALANCE,
        OutputSource.SMALL_MOTIONS,
        OutputSource.OF_A_RUN,
    )
    assert otherwise or function.second is not None


def test_the_checks_that_stand_for_second_definitions_are_made():
    """Of a model in which something is applied the certificate has each of them, and it holds."""
    checks = {check.name: check.ok for check in eomgen.derive(eomgen.loads(MODELS["plane"])).certify().checks}
    assert [checks[name] for name in CERTIFIED.values() if name] == [True, True]


@each("name, call", PROVEN_TWICE, by="name")
def test_its_value_is_what_its_second_definition_says(name, call):
    """At a random state, moving as the equations say: differences of poses and sums over particles give the same."""
    try:
        assert second_definition(state(name), parse(call, references=True).calls[0]) == ""
    except NoValue as reason:
        assert "depends on time" in str(reason)


@each("name, call", CASES, by="name")
def test_its_unit_is_the_one_in_which_its_number_grows(name, call):
    """In units of length, mass and time that are 2, 3 and 5 times smaller its number is 2^a 3^b 5^c times larger."""
    requested, model = parse(call, references=True).calls[0], system(name).scope.model
    function = FUNCTIONS[requested.name]
    factor = scaled(function.dimension)
    for k in function.per:
        argument = requested.args[k].name
        unit = Unit.parse(GAPS[argument]) if argument in GAPS else model.coordinates.get(argument).unit
        factor /= 1 if unit is None else scaled(unit)
        factor *= SIZES["time"] if "speed" in function.kinds[k] else 1
    found = value_of(name, call)
    assert math.isfinite(found)
    assert value_of(name, call, units=True) == pytest.approx(
        float(factor) * found, rel=tolerances.CARRIED, abs=tolerances.CARRIED
    )


def test_functions_of_small_motions_are_none_of_a_state():
    """They are asked of the linearized system; of a state they say so."""
    free = MODELS["plane"].replace('psi = { motion = "sin(w*t)/2" }', 'psi = { motion = "0" }')
    small = linearize(eomgen.loads(free))
    for call in LINEAR["plane"]:
        with pytest.raises(DerivationError, match="of the linearized system, not of a state"):
            value_of("plane", call)
        assert small.value(parse(call, references=True).calls[0])[0] is not None


def test_functions_of_a_run_are_none_of_a_state():
    """Of a state they say so; of a run each has a value, in the unit of its formula."""
    for call in ALONG:
        with pytest.raises(DerivationError, match="of a run, not of a state"):
            value_of("plane", call)
    run = eomgen.simulate(eomgen.loads(MODELS["coupled"]), time=20, samples=5)
    assert all(math.isfinite(run.ask(call).value) for call in ALONG)


def test_a_wrong_value_is_seen_by_the_second_definition(monkeypatch):
    """Velocities that are a thousandth too large, and spins of the wrong sign, are told."""
    rate, spin = Quantities.rate, Quantities.spin
    monkeypatch.setattr(Quantities, "rate", lambda self, v: Fraction(1001, 1000) * rate(self, v))
    monkeypatch.setattr(Quantities, "spin", lambda self, body: -spin(self, body))
    for call in (
        "vx(arm.end)",
        "ay(arm.end)",
        "speed(arm.end)",
        "omega(arm)",
        "epsilon(arm)",
        "curvature_radius(arm.end)",
    ):
        assert " for " in second_definition(state("plane"), parse(call, references=True).calls[0]), call


LINKED = """
eomgen = 1
name = "crank, link and slider"
space = "plane"
[parameters]
g = 9.81
[coordinates]
phi = 0.7
x = { dependent = true, near = 1.5 }
[bodies.crank]
shape = { kind = "rod", mass = 2, length = 0.5 }
joint = { kind = "revolute", angle = "phi" }
[bodies.slider]
shape = { kind = "particle", mass = 3 }
joint = { kind = "prismatic", axis = [1, 0], displacement = "x" }
[constraints.link]
kind = "link"
points = ["crank.end", "slider.center"]
length = 1.2
[forces.weight]
kind = "gravity"
acceleration = [0, "-g"]
"""


def test_the_multiplier_of_an_eliminated_row_is_that_of_the_free_bodies(monkeypatch):
    """r(lam) = M a + c - Q - J^T lam = 0 over all coordinates, r by Newton and Euler; of the wrong sign it is told."""
    found = System.of(eomgen.loads(LINKED))
    equations, symbols = recursive.assembled_by_recursion(found), found.symbols
    values = {
        node: Fraction(found.scope.model.parameters[n].value.evaluate({})) for n, node in symbols.parameters.items()
    }
    phi, x = 0.7, 0.5 * math.cos(0.7) + math.sqrt(1.2**2 - (0.5 * math.sin(0.7)) ** 2)
    numbers = {symbols.t: 0.0, **dict(zip(symbols.q, (phi, x), strict=True)), symbols.u[0]: 1.3}
    there, call = NumericState(equations, values, numbers), parse("multiplier(link)", references=True).calls[0]
    assert second_definition(there, call) == ""
    right = Quantities.value
    monkeypatch.setattr(Quantities, "value", lambda self, requested: -right(self, requested))
    assert " for " in second_definition(there, call)


def test_a_wrong_unit_is_seen(monkeypatch):
    """A velocity in m does not grow as one in m/s."""
    monkeypatch.setitem(FUNCTIONS, "vx", replace(velocity.VELOCITY, unit="m"))
    with pytest.raises(AssertionError):
        test_its_unit_is_the_one_in_which_its_number_grows.__wrapped__("plane", "vx(arm.end)")
