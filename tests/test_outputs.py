"""The functions that outputs call obey the laws of mechanics."""

from __future__ import annotations

import math
from random import Random

import pytest
from each import each

import eomgen
from eomgen.mechanics.dynamics import formulations as recursive
from eomgen.mechanics.dynamics.system import System
from eomgen.mechanics.instant.quantities import Quantities
from eomgen.study.programs import accelerations_and_multipliers
from eomgen.symbolic.expression.derivatives import derivative
from eomgen.symbolic.expression.spatial import Matrix, Vector
from eomgen.symbolic.expression.text import parse
from eomgen.symbolic.numeric.evaluation import FLOAT, evaluate

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
        self.system = System.of(self.model)
        symbols, rng = self.system.symbols, Random(seed)
        self.state = {}
        for node in (symbols.t, *symbols.parameters.values(), *symbols.x, *symbols.a):
            self.state[node] = rng.uniform(0.3, 1.2)

    def scalar(self, text: str):
        return parse(text, references=True).evaluate(self.system.scope.names, Quantities(self.system).value)

    def value(self, text: str) -> float:
        return self.number(self.scalar(text))

    def number(self, scalar) -> float:
        return evaluate((scalar,), self.state, FLOAT)[0]

    def vector(self, kind: str, *arguments: str) -> Vector:
        names = [f"{kind}{axis}({', '.join(arguments)})" for axis in "xyz"]
        return Vector(self.value(name) for name in names)

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


@each("point", POINTS)
def test_velocity_and_acceleration_are_the_rates_of_the_position_in_the_plane(point):
    """v = dr/dt, a = dv/dt, each in the axes of the body from which they are seen."""
    motion, arguments = Motion(PLANE), ", ".join(point)
    for axis in "xy":
        assert motion.slope(f"{axis}({arguments})") == pytest.approx(motion.value(f"v{axis}({arguments})"), abs=1e-7)
        assert motion.slope(f"v{axis}({arguments})") == pytest.approx(motion.value(f"a{axis}({arguments})"), abs=1e-6)


@each("point", [("arm.tip",), ("arm.tip", "tray"), ("base.origin", "arm")])
def test_velocity_and_acceleration_are_the_rates_of_the_position_in_space(point):
    """v = dr/dt, a = dv/dt"""
    motion, arguments = Motion(SPACE), ", ".join(point)
    for axis in "xyz":
        assert motion.slope(f"{axis}({arguments})") == pytest.approx(motion.value(f"v{axis}({arguments})"), abs=1e-7)
        assert motion.slope(f"v{axis}({arguments})") == pytest.approx(motion.value(f"a{axis}({arguments})"), abs=1e-6)


@each("text", [PLANE, SPACE])
def test_the_field_of_a_rigid_body_is_that_of_omega_and_epsilon(text):
    """v_P - v_O = w x r,  a_P - a_O = e x r + w x (w x r)"""
    motion, point = Motion(text), "arm.end" if text is PLANE else "arm.tip"
    r = motion.vector("", point) - motion.vector("", "arm.origin")
    w, e = motion.vector("omega_", "arm"), motion.vector("epsilon_", "arm")
    v = motion.vector("v", point) - motion.vector("v", "arm.origin")
    a = motion.vector("a", point) - motion.vector("a", "arm.origin")
    assert v == pytest.approx(w.cross(r), abs=1e-12)
    assert a == pytest.approx(e.cross(r) + w.cross(w.cross(r)), abs=1e-12)


@each("text", [PLANE, SPACE])
def test_angular_velocities_add(text):
    """w(arm) = w(base) + R w(arm, base), and the relative one is that of the joints between: seen from the parent."""
    motion, base = Motion(text), "table" if text is PLANE else "tray"
    R = Matrix.of((motion.number(x) for x in row) for row in motion.system.motion.link(base).pose.R)
    relative = motion.vector("omega_", "arm") - motion.vector("omega_", base)
    assert motion.vector("omega_", "arm", base) == pytest.approx(R.T @ relative, abs=1e-12)
    axis, rate = ((0, 0, 1), "q'") if text is PLANE else ((0.6, 0, 0.8), "b'")
    assert motion.vector("omega_", "arm", base) == pytest.approx([motion.value(rate) * n for n in axis], abs=1e-12)
    turning = [motion.value(rate + "'") * n for n in axis]
    assert motion.vector("epsilon_", "arm", base) == pytest.approx(turning, abs=1e-12)


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
        assert motion.value(f"{name}(arm.tip, base)") == pytest.approx(math.sqrt(vector @ vector))
    w = motion.vector("omega_", "arm")
    assert motion.value("omega(arm)") == pytest.approx(math.sqrt(w @ w))


def moving(text: str) -> Motion:
    """The model moving as its equations say."""
    motion = Motion(text)
    equations = recursive.assembled_by_recursion(motion.system)
    found = accelerations_and_multipliers(equations)
    motion.state |= {node: motion.number(found[node]) for node in motion.system.symbols.a}
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
    """V = sum over forces + joints' springs; a body's own is its weight's, -m g . r, and a ground spring's."""
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


LINES = """
eomgen = 1
space = "plane"
parameters = { m = 2, k = 30, l0 = 0.4, c = 3, G = 5, kt = 7, ct = 0.6 }
coordinates = { x = { start = 0.7, speed = 0.4 }, y = { start = -0.3, speed = 1.1 }, phi = { start = 0.5, speed = -2 } }
points = { O = [0, 0] }
[bodies.base]
shape = { kind = "disc", mass = "m", radius = 0.1 }
joint = { kind = "revolute", at = "O", angle = "phi/2" }
[bodies.b]
shape = { kind = "disc", mass = "m", radius = 0.2 }
joint = { kind = "placed", at = ["x", "y"], angle = "phi" }
[forces]
free = { kind = "spring", points = ["O", "b.center"], stiffness = "k", length = "l0" }
level = { kind = "spring", points = ["O", "b.center"], stiffness = "k", length = "l0", along = [3, 4] }
loss = { kind = "damper", points = ["b.center", "O"], damping = "c" }
star = { kind = "between", points = ["O", "b.center"], pull = "G*r'/r^2" }
coil = { kind = "torsion_spring", bodies = ["base", "b"], stiffness = "kt", rest = 0.1 }
oil = { kind = "torsion_damper", body = "b", damping = "ct" }
[outputs]
"""
DUE = {
    "pull(free)": "k*(sqrt(x^2 + y^2) - l0)",
    "pull(level)": "k*((3*x + 4*y)/5 - l0)",
    "pull(loss)": "c*(x*x' + y*y')/sqrt(x^2 + y^2)",
    "pull(star)": "G*(x*x' + y*y')/sqrt(x^2 + y^2)^3",
    "couple(coil)": "-kt*(phi/2 - 0.1)",
    "couple(oil)": "-ct*phi'",
}


def test_what_acts_between_two_things_can_be_asked():
    """Pulls by length and rate, couples by the angle of one body against the other; proven by what is declared."""
    requested = {f"f{k}": pair for k, pair in enumerate(DUE.items())}
    text = LINES + "".join(f'{name} = "{is_} - ({due})"\n{name}_ = "{is_}"\n' for name, (is_, due) in requested.items())
    found = eomgen.solve(eomgen.loads(text))
    for name in requested:
        assert found[name].value == pytest.approx(0, abs=1e-13) and abs(found[f"{name}_"].value) > 0.1
    assert found.certify().ok


@each(
    "call, message",
    [
        ("pull(weight)", "unknown force between points 'weight'"),
        ("couple(free)", "unknown force between bodies 'free'"),
    ],
)
def test_what_acts_otherwise_draws_nothing_together(call, message):
    text = LINES.replace("[forces]", "[forces]\nweight = { kind = 'gravity', acceleration = [0, -9.81] }")
    with pytest.raises(eomgen.ModelError, match=message):
        eomgen.loads(text + f'a = "{call}"')
