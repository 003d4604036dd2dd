"""Dry friction that is written as a force, -c*sign(w): where w = 0 it may hold, and no number is told."""

from __future__ import annotations

import pytest

import eomgen

HINGE = """
eomgen = 1
space = "plane"
parameters = { m = 1, l = 1, g = 9.81, Tc = 1 }
coordinates = { q = { start = 0.1, speed = SPEED } }
bodies.arm.shape = { kind = "rod", mass = "m", length = "l" }
bodies.arm.joint = { kind = "revolute", angle = "q - pi/2", torque = "-Tc*LAW" }
forces.w = { kind = "gravity", acceleration = [0, "-g"] }
outputs = { qdd = "q''", Rx = "reaction_x(arm)", x = "x(arm.end)" }
"""


def hinge(speed: float, law: str = "sign(q')"):
    return eomgen.loads(HINGE.replace("SPEED", str(speed)).replace("LAW", law))


def test_where_nothing_slides_dry_friction_gives_no_number():
    """m g l sin(q)/2 = 0.49 N m < Tc: it sticks, and q'' = -1.469 by sign(0) = 0 is none of its accelerations"""
    found = eomgen.solve(hinge(0))
    for name in ("qdd", "Rx"):
        assert found[name].value is None and "tanh(w/eps)" in found[name].message
    assert found["x"].value is not None
    reported = eomgen.reactions(hinge(0))["reaction_x(arm)"]
    assert reported.value is None and "tanh(w/eps)" in reported.message


@pytest.mark.parametrize("speed", [0.5, -0.5])
def test_where_it_slides_dry_friction_has_its_number(speed):
    """m l^2/3 q'' = -m g l sin(q)/2 - Tc sign(q')"""
    sign = 1 if speed > 0 else -1
    expected = -3 * (9.81 * 0.09983341664682815 / 2 + sign)
    assert float(eomgen.solve(hinge(speed))["qdd"].value) == pytest.approx(expected)


def test_the_smooth_law_runs_from_rest():
    """q'' = -3 m g l sin(q)/2 at tanh(0) = 0"""
    found = eomgen.solve(hinge(0, "tanh(q'/0.01)"))
    assert float(found["qdd"].value) == pytest.approx(-3 * 9.81 * 0.09983341664682815 / 2)


def test_a_number_where_a_force_jumps_is_contradicted(monkeypatch):
    """Whoever tells the reaction at q' = 0 all the same has a certificate that fails; at q' = 1/2 it holds."""
    monkeypatch.setattr("eomgen.mechanics.dynamics.pieces.ForceJumps.refuse", lambda self, state: None)
    at_rest, moving = (eomgen.reactions(hinge(speed)) for speed in (0, 0.5))
    assert at_rest["reaction_x(arm)"].value is not None
    assert at_rest.certify().ok is False and moving.certify().ok


@pytest.mark.parametrize("law", ["sign(q' - w)", "sign(q' + w - u)"])
def test_what_slides_is_told_with_the_values_of_parameters_and_inputs(law):
    """q' = w = u = 0: a belt that stands still"""
    belt = HINGE.replace("Tc = 1", "Tc = 1, w = 0").replace(
        "bodies.arm.shape", 'inputs = { u = "w*cos(t)" }\nbodies.arm.shape'
    )
    belt = belt if "u" in law else belt.replace('inputs = { u = "w*cos(t)" }\n', "")
    found = eomgen.solve(eomgen.loads(belt.replace("SPEED", "0").replace("LAW", law)))
    assert found["qdd"].value is None and "tanh(w/eps)" in found["qdd"].message


def test_rest_with_a_force_that_divides_by_a_speed_names_it():
    """q'/|q'| has no value at q' = 0"""
    with pytest.raises(eomgen.DerivationError, match="the joint of 'arm' has no value where nothing moves"):
        eomgen.statics(hinge(0, "q'/abs(q')"))
