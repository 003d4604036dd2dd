"""What [outputs] asks: the functions of the motion obey the laws of mechanics; answers are exact, valued, or say why not."""

from __future__ import annotations

import math
from random import Random

import pytest

import eomgen
from eomgen.answers import Answer, explicit_accelerations
from eomgen.mechanics.formulations import recursive
from eomgen.mechanics.outputs import COMPONENTS, MAGNITUDES, TURNING, Quantities, later
from eomgen.mechanics.system import system_of
from eomgen.model.checks.outputs import FUNCTIONS
from eomgen.symbolic.derivative import derivative
from eomgen.symbolic.evaluation import FLOAT, evaluate
from eomgen.symbolic.expressions import parse
from eomgen.symbolic.spatial import apply, cross, dot, minus, plus, transposed

PLANE = """
eomgen = 1
name = "arm on a driven table"
space = "plane"
[parameters]
l = 1.5
m = 2.0
k = 30.0
g = 9.81
[coordinates]
psi = { motion = "sin(3*t)/2" }
x = 0.2
q = { start = 0.7, speed = 0.4 }
[points]
O = [0.1, 0]
[bodies.table]
shape = { kind = "rectangle", mass = "3*m", width = 2, height = 1 }
joint = { kind = "revolute", at = "O", angle = "psi" }
[bodies.slide]
shape = { kind = "disc", mass = "m", radius = 0.1 }
joint = { kind = "prismatic", on = "table", at = [0.3, 0.2], axis = [1, 2], displacement = "x", stiffness = "k" }
[bodies.arm]
shape = { kind = "rod", mass = "m", length = "l" }
joint = { kind = "revolute", on = "slide", angle = "q", torque = "2 - q'", damping = 0.3 }
[forces.weight]
kind = "gravity"
acceleration = [0, "-g"]
[forces.string]
kind = "spring"
points = ["O", "arm.end"]
stiffness = "k"
length = 0.2
[forces.push]
kind = "force"
point = "arm.end"
force = ["t", "3*q'"]
axes = "arm"
[forces.twist]
kind = "couple"
body = "slide"
couple = "x*t"
[forces.field]
kind = "potential"
energy = "k*x^2*q"
[forces.wind]
kind = "generalized"
coordinate = "x"
value = "-x'"
"""
SPACE = """
eomgen = 1
name = "arm in space"
space = "space"
[parameters]
l = 1.5
m = 2.0
[coordinates]
a = { start = 0.3, speed = 1 }
b = { start = 0.4, speed = -0.7 }
c = { motion = "t^2" }
[bodies.base]
joint = { kind = "revolute", axis = [1, 2, 2], angle = "a" }
[bodies.tray]
joint = { kind = "revolute", on = "base", at = [0.5, 0, 0.2], axis = [0, 1, 0], angle = "c" }
[bodies.arm]
shape = { kind = "cylinder", mass = "m", radius = 0.2, length = "l" }
points = { tip = [0.4, "l", 0.1] }
joint = { kind = "revolute", on = "tray", at = [0, 0, 1], axis = [3, 0, 4], angle = "b" }
"""


class Motion:
    """A model at a random state, moving by random accelerations: numbers for whatever the outputs can ask."""

    def __init__(self, text: str, seed: int = 1) -> None:
        self.model = eomgen.loads(text)
        self.system = system_of(self.model)
        symbols, rng = self.system.symbols, Random(seed)
        self.state = {}
        for node in (symbols.t, *symbols.parameters.values(), *symbols.q, *symbols.u, *symbols.a):
            self.state[node] = rng.uniform(0.3, 1.2)

    def scalar(self, text: str):
        return parse(text, references=True).evaluate(self.system.scope.names, Quantities(self.system).value)

    def value(self, text: str) -> float:
        return self.number(self.scalar(text))

    def number(self, scalar) -> float:
        return evaluate((scalar,), self.state, FLOAT)[0]

    def vector(self, kind: str, *arguments: str) -> tuple[float, float, float]:
        names = [f"{kind}{axis}({', '.join(arguments)})" for axis in "xyz"]
        return tuple(self.value(name) for name in names)  # type: ignore[return-value]

    def after(self, dt: float) -> Motion:
        """The same a little later, by Taylor: q + q' dt + q'' dt^2/2, u + a dt."""
        moved = object.__new__(Motion)
        moved.model, moved.system = self.model, self.system
        symbols, scope = self.system.symbols, self.system.scope
        speed = dict(zip(symbols.u, symbols.a, strict=True))
        moved.state = dict(self.state)
        moved.state[symbols.t] += dt
        for node, rate in zip(symbols.q, scope.rates, strict=True):
            second = self.number(scope.with_accelerations((rate,))[0])
            moved.state[node] += self.number(rate) * dt + second * dt**2 / 2
        for node, a in speed.items():
            moved.state[node] += self.state[a] * dt
        return moved

    def slope(self, text: str, dt: float = 1e-5) -> float:
        return (self.after(dt).value(text) - self.after(-dt).value(text)) / (2 * dt)


POINTS = [("arm.end",), ("arm.end", "table"), ("arm.center", "slide"), ("O", "arm"), ("slide.center", "ground")]


@pytest.mark.parametrize("point", POINTS, ids=", ".join)
def test_velocity_and_acceleration_are_the_rates_of_the_position_in_the_plane(point):
    """v = dr/dt, a = dv/dt, each in the axes of the body from which they are seen."""
    motion, arguments = Motion(PLANE), ", ".join(point)
    for axis in "xy":
        assert motion.slope(f"{axis}({arguments})") == pytest.approx(motion.value(f"v{axis}({arguments})"), abs=1e-7)
        assert motion.slope(f"v{axis}({arguments})") == pytest.approx(motion.value(f"a{axis}({arguments})"), abs=1e-6)


@pytest.mark.parametrize("point", [("arm.tip",), ("arm.tip", "tray"), ("base.origin", "arm")], ids=", ".join)
def test_velocity_and_acceleration_are_the_rates_of_the_position_in_space(point):
    """v = dr/dt, a = dv/dt"""
    motion, arguments = Motion(SPACE), ", ".join(point)
    for axis in "xyz":
        assert motion.slope(f"{axis}({arguments})") == pytest.approx(motion.value(f"v{axis}({arguments})"), abs=1e-7)
        assert motion.slope(f"v{axis}({arguments})") == pytest.approx(motion.value(f"a{axis}({arguments})"), abs=1e-6)


@pytest.mark.parametrize("text", [PLANE, SPACE], ids=["plane", "space"])
def test_the_field_of_a_rigid_body_is_that_of_omega_and_epsilon(text):
    """v_P - v_O = w x r,  a_P - a_O = e x r + w x (w x r)"""
    motion, point = Motion(text), "arm.end" if text is PLANE else "arm.tip"
    r = minus(motion.vector("", point), motion.vector("", "arm.origin"))
    w, e = motion.vector("omega_", "arm"), motion.vector("epsilon_", "arm")
    v = minus(motion.vector("v", point), motion.vector("v", "arm.origin"))
    a = minus(motion.vector("a", point), motion.vector("a", "arm.origin"))
    assert v == pytest.approx(cross(w, r), abs=1e-12)
    assert a == pytest.approx(plus(cross(e, r), cross(w, cross(w, r))), abs=1e-12)


@pytest.mark.parametrize("text", [PLANE, SPACE], ids=["plane", "space"])
def test_angular_velocities_add(text):
    """w(arm) = w(base) + R w(arm, base), and the relative one is that of the joints between: seen from the parent."""
    motion, base = Motion(text), "table" if text is PLANE else "tray"
    R = [[motion.number(x) for x in row] for row in motion.system.motion.link(base).pose.R]
    relative = minus(motion.vector("omega_", "arm"), motion.vector("omega_", base))
    assert motion.vector("omega_", "arm", base) == pytest.approx(apply(transposed(R), relative), abs=1e-12)
    axis, rate = ((0, 0, 1), "q'") if text is PLANE else ((0.6, 0, 0.8), "b'")
    assert motion.vector("omega_", "arm", base) == pytest.approx([motion.value(rate) * n for n in axis], abs=1e-12)
    assert motion.vector("epsilon_", "arm", base) == pytest.approx([motion.value(rate + "'") * n for n in axis], abs=1e-12)


def test_in_the_plane_omega_is_the_rate_of_the_angle():
    """omega = angle', epsilon = omega'; against another body the difference; against itself 0."""
    motion = Motion(PLANE)
    for arguments in ("arm", "arm, table", "arm, ground", "ground, arm"):
        assert motion.slope(f"angle({arguments})") == pytest.approx(motion.value(f"omega({arguments})"), abs=1e-8)
        assert motion.slope(f"omega({arguments})") == pytest.approx(motion.value(f"epsilon({arguments})"), abs=1e-7)
    assert motion.value("omega(arm, arm)") == 0


def test_speed_and_acceleration_are_magnitudes():
    """speed = |v|, acceleration = |a|; in space omega and epsilon too."""
    motion = Motion(SPACE)
    for name, kind in (("speed", "v"), ("acceleration", "a")):
        vector = motion.vector(kind, "arm.tip", "base")
        assert motion.value(f"{name}(arm.tip, base)") == pytest.approx(math.sqrt(dot(vector, vector)))
    w = motion.vector("omega_", "arm")
    assert motion.value("omega(arm)") == pytest.approx(math.sqrt(dot(w, w)))


def moving(text: str) -> Motion:
    """The model moving as its equations say."""
    motion = Motion(text)
    assembly = recursive.assemble(motion.system)
    accelerations = explicit_accelerations(motion.system, assembly)
    motion.state |= {node: motion.number(a) for node, a in zip(motion.system.symbols.a, accelerations, strict=True)}
    return motion


FREE = PLANE.replace('psi = { motion = "sin(3*t)/2" }', "psi = 0.3")


def test_power_is_the_rate_of_the_kinetic_energy():
    """dT/dt = P of everything applied, where no motion is given."""
    motion = moving(FREE)
    assert motion.slope("kinetic_energy()") == pytest.approx(motion.value("power()"), rel=1e-7)


def test_powers_of_forces_joints_and_bodies_add_up():
    """P = sum over forces + joints' drives = sum over bodies + what acts at no place."""
    motion = moving(FREE)
    forces = sum(motion.value(f"power({name})") for name in motion.model.forces)
    joints = motion.value("-k*x*x' + (2 - q' - 3/10*q')*q'")
    assert forces + joints == pytest.approx(motion.value("power()"), rel=1e-12)
    bodies = sum(motion.value(f"power({name})") for name in motion.model.bodies)
    placeless = motion.value("power(field) + power(wind)")
    assert bodies + placeless == pytest.approx(motion.value("power()"), rel=1e-12)


def test_kinetic_energies_of_the_bodies_add_up():
    """T = sum T_i"""
    motion = Motion(PLANE)
    assert sum(motion.value(f"kinetic_energy({body})") for body in motion.model.bodies) == pytest.approx(
        motion.value("kinetic_energy()")
    )


def test_potential_energy_belongs_to_forces_and_what_acts_on_one_body_alone_to_it():
    """V = sum over forces + joints' springs; a body's own is its weight's, -m g . r, and that of a spring to the ground."""
    motion = Motion(PLANE)
    V = motion.value("potential_energy(weight) + potential_energy(string) + potential_energy(field) + k*x^2/2")
    assert V == pytest.approx(motion.value("potential_energy()"))
    with pytest.raises(eomgen.DerivationError, match="joint of body 'slide' belongs to more than body 'table'"):
        motion.value("potential_energy(table)")
    assert motion.value("potential_energy(arm)") == pytest.approx(
        motion.value("m*g*y(arm.center) + potential_energy(string)")
    )


def test_the_momentum_changes_by_the_generalized_force():
    """p' = Q + dT/dq  (Lagrange), p = dT/dq'"""
    motion = moving(PLANE)
    for q in ("x", "q"):
        node = next(n for n in motion.system.symbols.q if n.name == q)
        dT = motion.number(derivative(motion.scalar("kinetic_energy()"), node))
        assert motion.slope(f"momentum({q})") == pytest.approx(motion.value(f"generalized_force({q})") + dT, rel=1e-6)


def test_every_function_of_the_model_file_works_or_says_what_it_waits_for():
    """The functions that the reader knows are those that are built here and those that come later."""
    built = {*COMPONENTS, *MAGNITUDES, *TURNING, "angle", "omega", "epsilon", "kinetic_energy", "potential_energy"}
    built |= {"power", "generalized_force", "momentum"}
    assert {name for name in FUNCTIONS if not later(name)} == built


# -- answers ---------------------------------------------------------------------------------------

PENDULUM = """
eomgen = 1
name = "pendulum"
space = "plane"
[parameters]
m = 2.0
l = { value = 50, unit = "cm" }
g = 9.81
[coordinates]
theta = { start = "pi/6", speed = 2 }
[bodies.bob]
shape = { kind = "particle", mass = "m" }
joint = { kind = "placed", at = ["l*sin(theta)", "-l*cos(theta)"] }
[forces.weight]
kind = "gravity"
acceleration = [0, "-g"]
[outputs]
"""


def answers(outputs: str, model: str = PENDULUM) -> dict[str, Answer]:
    return eomgen.solve(eomgen.loads(model + outputs))


def answer(output: str, model: str = PENDULUM) -> Answer:
    return answers(f"asked = {output}\n", model)["asked"]


def test_a_function_of_coordinates_and_rates_is_exact_and_valued_at_the_start():
    """T = m l^2 theta'^2 / 2 = 2 * 0.25 * 4 / 2"""
    found = answer('"kinetic_energy()"')
    assert found.exact == "1/2*m*l^2*theta'^2"
    assert (found.value, found.unit, found.message) == (pytest.approx(1.0), "", None)


def test_accelerations_are_replaced_by_the_equations():
    """theta'' = -g/l sin theta: the mass cancels, and its value is not needed."""
    found = answer("\"theta''\"", PENDULUM.replace("m = 2.0", "m = {}"))
    assert (found.exact, found.method) == ("-g*sin(theta)/l", "equations of motion")
    assert found.value == pytest.approx(-9.81)


def test_an_answer_comes_in_its_unit_both_ways():
    """30 deg exactly: theta*180/pi; 0.5 m sin(30 deg) = 25 cm."""
    found = answers('a = { value = "theta", unit = "deg" }\nx = { value = "x(bob.center)", unit = "cm" }\n')
    assert found["a"].value == pytest.approx(30)
    assert (found["x"].exact, found["x"].value, found["x"].unit) == ("100*l*sin(theta)", pytest.approx(25), "cm")
    text = parse(found["a"].exact or "").evaluate({"theta": math.pi / 6, "pi": math.pi})
    assert text == pytest.approx(30)


def test_a_missing_value_leaves_the_exact_answer():
    """value is null while a value is missing, and the message names it."""
    found = answer('"kinetic_energy()"', PENDULUM.replace("m = 2.0", "m = {}"))
    assert (found.exact, found.value) == ("1/2*m*l^2*theta'^2", None)
    assert found.message is not None and "'m'" in found.message


@pytest.mark.parametrize(
    ("output", "word"),
    [
        ('"reaction_x(bob)"', "reactions"),
        ('"frequency(1)"', "linearization"),
        ('{ value = "theta\'^2", from = "rest" }', "energy theorem"),
        ('{ value = "theta\'", at = "theta = 0" }', "condition"),
        ('{ value = "theta\'", at = "t = -1" }', "before the start"),
        ('"1/(theta - theta)"', "division by zero"),
    ],
)
def test_what_cannot_be_answered_says_so_and_the_others_are_given(output, word):
    """Nulls and a message; never a wrong answer."""
    bob = '["l*sin(theta)", "-l*cos(theta)"]'
    model = PENDULUM.replace(f'"placed", at = {bob}', '"revolute", at = [0, 0], angle = "theta"')
    found = answers(f'asked = {output}\nother = "2*theta"\n', model)
    assert (found["asked"].exact, found["asked"].value) == (None, None)
    assert found["asked"].message is not None and word in found["asked"].message
    assert found["other"].exact == "2*theta"


def test_the_message_of_one_output_does_not_depend_on_another():
    """The outputs are answered one by one, in the order of the file."""
    found = answers('b = "tension(rope)"\na = "theta"\n', PENDULUM.replace("[outputs]", """
[constraints.rope]
kind = "link"
points = ["O", "bob.center"]
[points]
O = [0, 0]
[outputs]"""))  # fmt: skip
    assert list(found) == ["b", "a"]
    assert not found["b"].answered and not found["a"].answered
    assert "link" in (found["a"].message or "")


OSCILLATOR = """
eomgen = 1
name = "oscillator"
space = "plane"
[parameters]
w = 2.0
t1 = 1.5
[coordinates]
x = { start = 1, speed = 0.5 }
s = { acceleration = "w", start = 0.1, speed = 3 }
[inputs]
F = "w*t"
[bodies.block]
mass = 1
joint = { kind = "prismatic", axis = [1, 0], displacement = "x", stiffness = "w^2" }
[bodies.lift]
mass = 1
joint = { kind = "prismatic", axis = [0, 1], displacement = "s", force = "F" }
[outputs]
"""


def test_at_a_time_the_motion_is_integrated():
    """x(t) = cos(w t) + 0.5 sin(w t)/w, also as velocity and acceleration; from rest without the sine."""
    found = answers("".join(
        f'{name} = {{ value = "{value}", at = "{at}"{more} }}\n'
        for name, value, at, more in (
            ("x", "x", "t = 1.5", ""), ("v", "vx(block.center)", "t1 = t", ""), ("a", "x''", "t = t1", ""),
            ("r", "x", "t = t1", ', from = "rest"'), ("zero", "x'", "t = 0", ""),
        )
    ), OSCILLATOR)  # fmt: skip
    cos, sin = math.cos(3), math.sin(3)
    expected = {"x": cos + sin / 4, "v": -2 * sin + cos / 2, "a": -4 * cos - sin, "r": cos, "zero": 0.5}
    assert {name: found[name].value for name in expected} == pytest.approx(expected, abs=1e-10)
    assert {a.exact for a in found.values()} == {None}
    assert {a.method for a in found.values()} == {"integration in time"}


def test_a_given_motion_is_exact_at_a_time():
    """s(t) = 0.1 + 3 t + w t^2/2; its rate 3 + w t; an input by its own expression."""
    found = answers('s = { value = "s", at = "t = t1" }\nv = { value = "vy(lift.center)", at = "t = 2" }\n'
                    'f = { value = "F", at = "t = t1" }\nt = { value = "t", at = "t = 2*t1" }\n', OSCILLATOR)  # fmt: skip
    exact = {name: parse(a.exact or "").evaluate({"w": 2.0, "t1": 1.5, "pi": math.pi}) for name, a in found.items()}
    assert exact == pytest.approx({"s": 0.1 + 4.5 + 2.25, "v": 7, "f": 3, "t": 3})
    assert {name: a.value for name, a in found.items()} == pytest.approx(exact)


CARTESIAN = """
eomgen = 1
name = "pendulum in x and y"
space = "plane"
[parameters]
m = 2.0
l = 0.5
g = 9.81
[coordinates]
x = 0.3
y = -0.4
[bodies.bob]
shape = { kind = "particle", mass = "m" }
joint = { kind = "placed", at = ["x", "y"] }
[constraints.rod]
kind = "equation"
gap = "x^2 + y^2 - l^2"
[forces.weight]
kind = "gravity"
acceleration = [0, "-g"]
"""
AGAIN = '[constraints.again]\nkind = "equation"\ngap = "2*x^2 + 2*y^2 - 2*l^2"\n'


@pytest.mark.parametrize("more", ["", AGAIN], ids=["one rod", "the same rod twice"])
def test_closing_ties_bear_on_the_accelerations(more):
    """x'' = g x y / l^2 - x (x'^2 + y'^2)/l^2 and y'' = -g + (g y^2 - y v^2)/(x^2 + y^2), redundant rows or not."""
    found = answers('[outputs]\nx_dd = "x\'\'"\ny_dd = "y\'\'"\n', CARTESIAN + more)
    assert found["x_dd"].value == pytest.approx(9.81 * 0.3 * -0.4 / 0.25)
    state = {"x": 0.7, "y": 0.2, "x'": 1.1, "y'": -0.4, "g": 9.81, "m": 2.0, "l": 0.5, "pi": math.pi}
    r2, v2 = 0.7**2 + 0.2**2, 1.1**2 + 0.4**2
    assert parse(found["x_dd"].exact or "").evaluate(state) == pytest.approx(0.7 * (9.81 * 0.2 - v2) / r2)
    assert parse(found["y_dd"].exact or "").evaluate(state) == pytest.approx(-9.81 + 0.2 * (9.81 * 0.2 - v2) / r2)


def test_a_coordinate_that_moves_no_mass_is_an_error_of_the_model_only_where_accelerations_are_asked():
    """M has a zero row."""
    model = PENDULUM.replace("[bodies.bob]", '[bodies.frame]\njoint = { kind = "revolute", angle = "idle" }\n[bodies.bob]')
    model = model.replace("[coordinates]", "[coordinates]\nidle = 0.2")
    assert answer('"angle(frame)"', model).exact == "idle"
    with pytest.raises(eomgen.ModelError, match="idle"):
        answer("\"theta''\"", model)


def test_substituted_accelerations_leave_none_behind():
    """No theta'' is left in an exact answer."""
    found = answer('"ax(bob.center)^2 + ay(bob.center)"')
    assert found.exact is not None and "''" not in found.exact
