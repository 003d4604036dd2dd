"""Contacts and elements are proved by what they are declared to be: surfaces that touch, pulls along a line."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import pytest

import eomgen
from eomgen.mechanics.kinematics import loads, symbols
from eomgen.model.constraints import held as support
from eomgen.model.constraints import rolling
from eomgen.model.constraints.rolling import Nearest, RollingBall, Wheel
from eomgen.model.forces import elements as reach
from eomgen.model.forces import elements as straight
from eomgen.model.forces.elements import Damper, Spring
from eomgen.model.forces.torsion import TorsionDamper, TorsionSpring
from eomgen.model.joints import ball as orientation
from eomgen.proof.check import Certificate
from eomgen.symbolic.expression.spatial import Matrix, Vector

MODELS = Path(__file__).parents[2] / "models"
TOUCH = "contacts lie on both surfaces, and neither open nor slip"
DECLARED = "springs, dampers and drives act as they are declared, equal and opposite"

DISC = """
eomgen = 1
space = "plane"
[parameters]
R = 0.2
[coordinates]
x = { start = 0.1, speed = 0.4 }
y = 0.2
phi = { dependent = true, start = 0 }
[bodies.disc]
shape = { kind = "disc", mass = 2, radius = "R" }
joint = { kind = "planar", x = "x", y = "y", angle = "phi" }
[constraints.floor]
kind = "rolling"
body = "disc"
line = { at = [0, 0], normal = [0, 1] }
[forces.weight]
kind = "gravity"
acceleration = [0, -9.81]
"""
HELD = """
eomgen = 1
space = "plane"
[coordinates]
x = { start = 0.1, speed = 0.4 }
y = { dependent = true, near = 0.3 }
[bodies.bead]
shape = { kind = "particle", mass = 2 }
joint = { kind = "placed", at = ["x", "y"] }
[constraints.wall]
kind = "support"
point = "bead.center"
at = [0, 0.3]
normal = [1, 4]
"""
ELEMENTS = """
eomgen = 1
space = "plane"
[points]
O = [0, 0]
W = [-1, 0.2]
[coordinates]
x = { start = 0.9, speed = 0.3 }
phi = { start = 20.5, speed = -0.2 }
psi = { start = 0.3, speed = 0.7 }
[bodies.cart]
mass = 2
joint = { kind = "prismatic", axis = [0.6, 0.8], displacement = "x", stiffness = 40, rest = 0.1, damping = 2 }
[bodies.rod]
shape = { kind = "rod", mass = 1, length = 0.5 }
joint = { kind = "revolute", on = "cart", angle = "phi", stiffness = 7, damping = 0.5, rest = 0.5, torque = "3*t" }
[bodies.bar]
shape = { kind = "rod", mass = 1, length = 0.5 }
joint = { kind = "revolute", on = "rod.end", angle = "psi" }
[forces]
spring = { kind = "spring", points = ["O", "bar.end"], stiffness = 30, length = 0.8 }
slope = { kind = "spring", points = ["rod.end", "W"], stiffness = 30, length = "start", along = [1, 2] }
from_start = { kind = "spring", points = ["bar.end", "cart.origin"], stiffness = 30, length = "start" }
damper = { kind = "damper", points = ["O", "bar.start"], damping = "2 + x^2" }
pull = { kind = "between", points = ["W", "bar.end"], pull = "3/r^2 + r'" }
turn = { kind = "torsion_damper", bodies = ["cart", "bar"], damping = 0.3 }
twist = { kind = "torsion_spring", bodies = ["rod", "bar"], stiffness = 6, rest = "0.2*t + 0.1" }
ground = { kind = "torsion_spring", body = "bar", stiffness = 6 }
"""


SOLID = """
eomgen = 1
space = "space"
[coordinates]
a = { start = 0.3, speed = 0.7 }
[bodies.solid]
mass = 2
inertia = INERTIA
joint = { kind = "revolute", axis = [1, 2, 2], angle = "a" }
"""


def certificate_of(text: str) -> Certificate:
    return eomgen.derive(eomgen.loads(text)).certify()


def of_model(name: str) -> Certificate:
    return eomgen.derive(eomgen.load(next(MODELS.rglob(f"{name}.toml")))).certify()


def status(certificate: Certificate, name: str) -> str:
    return next(check.status for check in certificate.checks if check.name == name)


@pytest.mark.parametrize("name", ["rolling_disc", "disc_leaves_cylinder", "epicyclic_gear", "scotch_yoke", "ch22_p1"])
def test_contacts_touch_in_the_models(name):
    assert status(of_model(name), TOUCH) == "holds"


def too_high(self, scene, n):
    return Nearest(-self.R * n, 2 * self.R)


def other_side(self, scene, n):
    right = own_nearest(self, scene, n)
    return replace(right, reach=-right.reach)


def on_top(self, scene, n):
    right = own_lowest(self, scene, n)
    return replace(right, reach=-right.reach)


def turned_the_other_way(scene, track, center, ball):
    right = own_curved(scene, track, center, ball)
    return replace(right, reach=-right.reach)


own_nearest, own_lowest, own_curved = RollingBall.nearest, Wheel.nearest, rolling.on_curved
PLANTED = [
    (DISC, RollingBall, "nearest", too_high),
    (DISC, RollingBall, "nearest", other_side),
    ("rolling_disc", Wheel, "nearest", on_top),
    ("epicyclic_gear", rolling, "on_curved", turned_the_other_way),
    (HELD, support, "Vector", lambda components: -Vector(components)),
]


@pytest.mark.parametrize(("model", "place", "attribute", "wrong"), PLANTED)
def test_an_error_in_where_things_touch_is_not_called_right(monkeypatch, model, place, attribute, wrong):
    """Gap and rows agree with one another: only the surfaces, as they are declared, tell."""
    monkeypatch.setattr(place, attribute, wrong)
    assert status(certificate_of(model) if "\n" in model else of_model(model), TOUCH) == "fails"


def test_products_of_inertia_in_the_wrong_places_are_seen(monkeypatch):
    """n . I n, by the places in which the model's file has them: all routes share the tensor."""
    name, own = "moments and products of inertia stand where they are declared", symbols._inertia

    def mixed(scope, body, declared):
        (xx, xy, xz), (_, yy, yz), (_, _, zz) = own(scope, body, declared)
        return Matrix.of(((xx, yz, xz), (yz, yy, xy), (xz, xy, zz)))

    text = SOLID.replace("INERTIA", "[3, 4, 5, 0.1, 0.2, 0.3]")
    assert status(certificate_of(text), name) == "holds"
    monkeypatch.setattr(symbols, "_inertia", mixed)
    assert status(certificate_of(text), name) == "fails"


def pushing(self, scene):
    return tuple(replace(load, force=-load.force) for load in own_loads(self, scene))


def turning(self, scene):
    return tuple(replace(load, couple=-load.couple) for load in own_turn(self, scene))


def stretched(self, scene, length):
    return own_stretch(self, scene, length) + 1


def acting_once(self, scene):
    return own_turn(self, scene)[:1]


def relaxed_elsewhere(self, scene):
    return own_twist(self, scene) + 2 * scene.value(self.rest)


def along_the_gap(scene, points, along=None):
    line = own_reach(scene, points, along)
    return replace(line, rate=line.rate * line.length)


def stiffer(motion, link, modes):
    return [
        replace(e, potential=2 * e.potential, effort=2 * e.effort - e.drive) for e in own_efforts(motion, link, modes)
    ]


own_loads, own_turn, own_twist, own_stretch = Damper.loads, TorsionDamper.loads, TorsionSpring._twist, Spring._stretch
own_reach, own_efforts = reach.reach, loads._joint_efforts
ELEMENT_ERRORS = [
    (Damper, "loads", pushing),
    (TorsionDamper, "loads", turning),
    (TorsionDamper, "loads", acting_once),
    (TorsionSpring, "_twist", relaxed_elsewhere),
    (Spring, "_stretch", stretched),
    (straight, "reach", along_the_gap),
    (loads, "_joint_efforts", stiffer),
]


@pytest.mark.slow
@pytest.mark.parametrize(("place", "attribute", "wrong"), ELEMENT_ERRORS)
def test_an_error_in_the_law_of_an_element_is_seen(monkeypatch, place, attribute, wrong):
    """A damper that drives, a spring that is slack elsewhere, a couple without its opposite: all routes share it."""
    monkeypatch.setattr(place, attribute, wrong)
    assert status(certificate_of(ELEMENTS), DECLARED) == "fails"


def test_elements_of_every_kind_act_as_they_are_declared():
    """Along a direction, from the start, on the ground, in joints; an angle of several turns is the same couple."""
    assert status(certificate_of(ELEMENTS), DECLARED) == "holds"


BY_QUATERNION = """
eomgen = 1
space = "space"
[coordinates]
e0 = 0.9
e1 = 0.3
e2 = -0.2
e3 = 0.25
a = { start = 0.1, speed = 1 }
z = { start = 0.06 }
[speeds]
w1 = { start = -0.1 }
w2 = { start = -0.62 }
w3 = { start = 0.51 }
[bodies.top]
shape = { kind = "cone", mass = 2, radius = 0.2, height = 0.6 }
[bodies.top.joint]
kind = "spherical"
turned = { axis = [1, 2, 2], angle = 0.6 }
orientation = "quaternion"
quaternion = ["e0", "e1", "e2", "e3"]
omega = ["w1", "w2", "w3"]
[bodies.wheel]
shape = { kind = "cone", mass = 2, radius = 0.2, height = 0.6 }
joint = { kind = "revolute", on = "top", axis = [1, 2, 0], angle = "a" }
[bodies.puck]
shape = { kind = "particle", mass = 1 }
joint = { kind = "prismatic", axis = [0, 0, 1], displacement = "z" }
[constraints.floor]
kind = "support"
point = "puck.center"
at = [0, 0, 0]
normal = [0, 0, 1]
unilateral = true
[forces.weight]
kind = "gravity"
acceleration = [0, 0, -9.81]
"""
STAND = "bodies stand in every phase as their joints are declared"


def failing_of_the_fall() -> set[str]:
    run = eomgen.simulate(eomgen.loads(BY_QUATERNION), time=0.3, samples=3, target="numpy")
    assert len(run.phases) == 2
    return {check.name for check in run.certify().checks if check.status == "fails"}


def test_a_body_turned_by_a_quaternion_stands_in_every_phase_as_declared():
    """R(turned) R(e) = R(turned o e) where e . e = 1; the doubles of a run miss 1 by 1e-16, which 50 digits see."""
    assert failing_of_the_fall() == set()


def test_a_quaternion_that_turns_the_other_way_is_told_in_every_phase(monkeypatch):
    """R(e)^T = R(e0, -e1, -e2, -e3): the norm is 1, the pose is another."""
    turned = orientation.UnitQuaternion.rotation.fget
    other = property(lambda e: turned(type(e)(e[0], *(-x for x in e[1:]))))
    monkeypatch.setattr(orientation.UnitQuaternion, "rotation", other)
    assert STAND in failing_of_the_fall()
