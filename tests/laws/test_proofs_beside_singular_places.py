"""What is right is not called wrong, what has no value says so: dead centres, drives that are sought, no inertia."""

from __future__ import annotations

import math

import numpy as np
import pytest

import eomgen

PLANE = 'eomgen = 1\nspace = "plane"\n'
SPACE = 'eomgen = 1\nspace = "space"\n'

ENGINE = """
bodies.crank = { shape = { kind = "rod", mass = 1, length = 0.1 }, joint = { kind = "revolute", angle = "p" } }
constraints.pin = { kind = "pin", points = ["con.end", "piston.center"] }
[coordinates]
x = START
p = { dependent = true, near = NEAR }
b = { dependent = true, near = 0 }
[bodies.con]
shape = { kind = "rod", mass = 0.5, length = 0.3 }
joint = { kind = "revolute", on = "crank.end", angle = "b - p" }
[bodies.piston]
shape = { kind = "particle", mass = 2 }
joint = { kind = "prismatic", axis = [1, 0], displacement = "x", force = -300 }
"""


def failing(certificate) -> list[str]:
    return [check.name for check in certificate.checks if check.status == "fails"]


@pytest.mark.parametrize(("start", "near"), [("0.4", "0"), ("{ start = 0.3999999999999, speed = -0.001 }", "0.001")])
def test_equations_are_not_called_wrong_at_a_dead_centre(start, near):
    """p' = A x' with A = 1/0 or 1e6 there: differences that depend on their step say nothing."""
    model = eomgen.loads(PLANE + ENGINE.replace("START", start).replace("NEAR", near))
    assert failing(eomgen.derive(model).certify()) == []


@pytest.mark.slow
@pytest.mark.parametrize(("x", "near"), [("0.4", "0"), ("0.2", "3.14")])
def test_a_dead_centre_is_named_where_velocities_and_small_motions_are_asked(x, near):
    """0/0 of rates has a name: the constraint, the coordinates, the place."""
    model = eomgen.loads(PLANE + ENGINE.replace("START", x).replace("NEAR", near))
    words = "'pin' does not determine 'p', 'b' at the .*dead centre"
    with pytest.raises(eomgen.DerivationError, match=words):
        eomgen.kinematics(model)
    with pytest.raises(eomgen.DerivationError, match=words):
        eomgen.linearize(model)


JACK = """
parameters = { W = 8000, lead = 0.006, g = 9.81 }
coordinates = { a = 0.3 }
unknowns = { M = "couple on the handle" }
outputs = { M = "M", rest = "reaction_couple_z(spindle)" }
forces.load = { kind = "force", point = "spindle.origin", force = [0, 0, "-W"] }
[bodies.spindle]
mass = 4
inertia = [0.1, 0.1, 0.02]
joint = { kind = "screw", axis = [0, 0, 1], angle = "a", pitch = "lead/(2*pi)", torque = "M" }
[forces.weight]
kind = "gravity"
acceleration = [0, 0, "-g"]
"""


def test_a_couple_that_is_sought_holds_a_load_on_a_screw_by_both_ways():
    """M = (W + m g) lead/2 pi; the couple through the thread and the drive together is 0: nothing else turns it."""
    model = eomgen.loads(SPACE + JACK)
    found = eomgen.solve(model)
    assert found["M"].value == pytest.approx((8000 + 4 * 9.81) * 0.006 / (2 * math.pi), rel=1e-12)
    assert found["rest"].value == pytest.approx(0, abs=1e-12)
    assert failing(found.certify()) == failing(eomgen.statics(model).certify()) == []


def test_axes_of_a_body_without_inertia_are_any():
    """I = 0 about its mass centre, away from the ground's origin: rounding of m c^2 is no moment."""
    text = """
    bodies.bob = { mass = 1.5, center = [0, 0, 0.12], inertia = [0, 0, 0], joint = { kind = "fixed", at = [3, 0, 0] } }
    """
    assert failing(eomgen.inertia(eomgen.loads(SPACE + text)).certify()) == []


def test_kinds_of_motion_are_left_out_where_no_strand_is_real_nearby():
    """R_hub 20 % larger swallows the mass on its cord: no motion is tried there, and all else is told."""
    text = """
    parameters = { R = 0.5, l = 0.2, w = 5 }
    bodies.hub = { mass = 100, inertia = 10, joint = { kind = "revolute", angle = "psi" } }
    bodies.bob = { shape = { kind = "particle", mass = 0.5 }, joint = { kind = "placed", at = ["x", "y"] } }
    constraints.cord = { kind = "string", path = [{ body = "hub", radius = "R", turn = "ccw" }, "bob.center"] }
    [coordinates]
    psi = { start = 0, speed = "w" }
    x = { start = "R", speed = "-w*l" }
    y = { start = "l", speed = "w*R" }
    """
    assert failing(eomgen.kinematics(eomgen.loads(PLANE + text)).certify()) == []


def test_a_guess_of_a_dependent_coordinate_is_no_place():
    """V = k1 k2/(k1 + k2) x^2/2 of springs in series rests at 0; `near` is a guess, and no constant of a motion."""
    text = """
    parameters = { k1 = 100, k2 = 300 }
    coordinates = { y = { dependent = true, near = 0.1 }, x = 0.2 }
    bodies.node.joint = { kind = "prismatic", axis = [1, 0], displacement = "y", stiffness = "k1" }
    constraints.series = { kind = "equation", gap = "k1*y - k2*(x - y)" }
    [bodies.block]
    shape = { kind = "particle", mass = 2 }
    joint = { kind = "prismatic", on = "node", axis = [1, 0], displacement = "x - y", stiffness = "k2" }
    """
    model = eomgen.loads(PLANE + text)
    places = eomgen.statics(model)
    assert [place.numbers[q] for place in places.places for q in place.statics.q] == pytest.approx([0, 0], abs=1e-12)
    roots = np.linalg.eigvals(eomgen.linearize(model).A)
    assert abs(roots.imag) == pytest.approx(math.sqrt(75 / 2), rel=1e-9)


def test_small_motions_about_the_cusp_of_a_cycloid_are_refused_by_name():
    """M = 2 m R^2 (1 + cos u) = 0 at u = pi, the nearest equilibrium of a start at 2."""
    text = """
    parameters = { R = 0.5 }
    coordinates = { u = 2.0 }
    forces.weight = { kind = "gravity", acceleration = [0, -9.81] }
    [bodies.bead]
    shape = { kind = "particle", mass = 0.3 }
    joint = { kind = "placed", at = ["R*(u + sin(u))", "R*(1 - cos(u))"] }
    """
    model = eomgen.loads(PLANE + text)
    assert failing(eomgen.statics(model).certify()) == []
    with pytest.raises(eomgen.DerivationError, match="moves no mass"):
        str(eomgen.linearize(model))


def test_a_string_is_not_proven_where_it_would_be_too_long():
    """|1/2 + s| + |1/2 - s| = 1 for |s| < 1/2 alone: past the eyelet no state is the model's."""
    text = """
    coordinates = { X = 0, s = 0 }
    bodies.a.shape = { kind = "particle", mass = 2 }
    bodies.a.joint = { kind = "prismatic", on = "wedge.top", axis = [-1, -1], displacement = "0.5 + s" }
    bodies.b.shape = { kind = "particle", mass = 1 }
    bodies.b.joint = { kind = "prismatic", on = "wedge.top", axis = [1, -2], displacement = "0.5 - s" }
    constraints.rope = { kind = "string", path = ["a.center", "wedge.top", "b.center"] }
    forces.weight = { kind = "gravity", acceleration = [0, -9.81] }
    [bodies.wedge]
    shape = { kind = "particle", mass = 6 }
    points = { top = [0, 1] }
    joint = { kind = "prismatic", axis = [1, 0], displacement = "X" }
    """
    assert failing(eomgen.derive(eomgen.loads(PLANE + text)).certify()) == []


@pytest.mark.parametrize(("k", "kind"), [("m*9.81*b/(a*h)", "indifferent"), ("1.01*m*9.81*b/(a*h)", "stable")])
def test_a_spring_of_zero_length_may_hold_an_arm_in_every_place(k: str, kind: str) -> None:
    """LaCoste 1934: k a h = m g b; one per cent more, and two equilibria are left, as the formula says."""
    found = eomgen.statics(eomgen.loads(LACOSTE.replace("K", k)))
    assert found.certify().ok
    places = found.found.found
    if kind == "indifferent":
        assert [q.name for q in found.found.indifferent] == ["p"] and len(places) == 1
        assert [q.name for q, _ in found.found.statics.nowhere] == ["p"]
    else:
        assert len(places) == 2 and not found.found.indifferent
    assert kind in {place.stability.kind for place in places}


LACOSTE = """
eomgen = 1
space = "plane"
parameters = { m = 0.5, b = 0.3, h = 0.2, a = 0.25, k = "K" }
coordinates = { p = 0.1 }
points = { O = [0, 0], T = [0, "h"] }
bodies.arm.mass = "m"
bodies.arm.inertia = 0.001
bodies.arm.center = ["b", 0]
bodies.arm.points = { s = ["a", 0] }
bodies.arm.joint = { kind = "revolute", angle = "p" }
forces.spring = { kind = "spring", points = ["T", "arm.s"], stiffness = "k", length = 0 }
forces.weight = { kind = "gravity", acceleration = [0, -9.81] }
"""
