"""Contacts, dampers, springs are proved by what they are: surfaces that touch, power that is taken, V = 0 at rest."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import pytest

import eomgen
from eomgen.model.constraints import rolling, support
from eomgen.model.constraints.round_bodies import Nearest, RollingBall, Wheel
from eomgen.model.forces.damper import Damper
from eomgen.model.forces.spring import Spring
from eomgen.model.forces.torsion_damper import TorsionDamper
from eomgen.proof.check import Certificate
from eomgen.symbolic.expression.spatial import times

MODELS = Path(__file__).parents[2] / "models"
TOUCH = "contacts lie on both surfaces, and neither part nor slip"
BRAKE = "dampers take power"
SLACK = "springs have no energy at their rest length"

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
[coordinates]
x = { start = 0.9, speed = 0.3 }
y = { start = 0.4, speed = -0.2 }
a = { start = 0.3, speed = 0.7 }
[bodies.bar]
shape = { kind = "rod", mass = 1, length = 0.5 }
joint = { kind = "planar", x = "x", y = "y", angle = "a" }
[forces.spring]
kind = "spring"
points = ["O", "bar.end"]
stiffness = 30
length = 0.8
[forces.damper]
kind = "damper"
points = ["O", "bar.start"]
damping = 2
[forces.turn]
kind = "torsion_damper"
body = "bar"
damping = 0.3
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
    return Nearest(times(-self.R, n), 2 * self.R)


def other_side(self, scene, n):
    right = own_nearest(self, scene, n)
    return replace(right, reach=times(-1, right.reach))


def on_top(self, scene, n):
    right = own_lowest(self, scene, n)
    return replace(right, reach=times(-1, right.reach))


def turned_the_other_way(scene, track, center, ball):
    right = own_curved(scene, track, center, ball)
    return replace(right, reach=times(-1, right.reach))


own_nearest, own_lowest, own_curved = RollingBall.nearest, Wheel.nearest, rolling.on_curved
PLANTED = [
    (DISC, RollingBall, "nearest", too_high),
    (DISC, RollingBall, "nearest", other_side),
    ("rolling_disc", Wheel, "nearest", on_top),
    ("epicyclic_gear", rolling, "on_curved", turned_the_other_way),
    (HELD, support, "minus", lambda a, b: tuple(x + y for x, y in zip(a, b, strict=True))),
]


@pytest.mark.parametrize(("model", "place", "attribute", "wrong"), PLANTED)
def test_an_error_in_where_things_touch_is_not_called_right(monkeypatch, model, place, attribute, wrong):
    """Gap and rows agree with one another: only the surfaces, as they are declared, tell."""
    monkeypatch.setattr(place, attribute, wrong)
    assert status(certificate_of(model) if "\n" in model else of_model(model), TOUCH) == "fails"


def pushing(self, scene):
    return tuple(replace(load, force=times(-1, load.force)) for load in own_loads(self, scene))


def turning(self, scene):
    return tuple(replace(load, couple=times(-1, load.couple)) for load in own_turn(self, scene))


def stretched(self, scene, length):
    return length - scene.value(self.length) / 2


own_loads, own_turn = Damper.loads, TorsionDamper.loads
ELEMENT_ERRORS = [
    (BRAKE, Damper, "loads", pushing),
    (BRAKE, TorsionDamper, "loads", turning),
    (SLACK, Spring, "_stretch", stretched),
]


@pytest.mark.parametrize(("check", "place", "attribute", "wrong"), ELEMENT_ERRORS)
def test_an_error_in_the_law_of_an_element_is_seen(monkeypatch, check, place, attribute, wrong):
    """A damper that drives, a spring that is slack at another length: all routes share the law, and agree."""
    assert status(certificate_of(ELEMENTS), check) == "holds"
    monkeypatch.setattr(place, attribute, wrong)
    assert status(certificate_of(ELEMENTS), check) == "fails"
