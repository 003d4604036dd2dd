"""What words of a model file mean, in numbers by hand: every route of the product reads them in one place."""

from __future__ import annotations

from math import cos, pi, sin

import numpy as np
import pytest

import eomgen

pytestmark = pytest.mark.slow

G = 9.81
PLANE = """
eomgen = 1
space = "plane"
forces.weight = { kind = "gravity", acceleration = [0, -9.81] }
"""


def answers(text: str) -> dict[str, float]:
    """The outputs of a model in numbers."""
    return {name: found.value for name, found in eomgen.solve(eomgen.loads(text)).items()}


def test_a_sleeve_slides_by_its_displacement_and_turns_by_its_angle():
    """p = d n + Rot(n, a) r: of r = (1, 0, 0) about z (cos a, sin a, d)."""
    text = """
    eomgen = 1
    space = "space"
    coordinates = { d = 0.2, a = 0.7 }
    bodies.b.mass = 1
    bodies.b.inertia = [1, 1, 1]
    bodies.b.points.P = [1, 0, 0]
    bodies.b.joint = { kind = "cylindrical", axis = [0, 0, 1], displacement = "d", angle = "a" }
    outputs = { x = "x(b.P)", y = "y(b.P)", z = "z(b.P)" }
    """
    assert answers(text) == pytest.approx({"x": cos(0.7), "y": sin(0.7), "z": 0.2})


@pytest.mark.parametrize(("turn", "sense"), [("ccw", 1), ("cw", -1)])
def test_an_arc_bends_to_the_side_that_is_said(turn, sense):
    """Counter-clockwise is to the left: from (0, 0) along x by a third of a turn about (0, sense R)."""
    text = f"""{PLANE}
    coordinates.s = "pi/3*2"
    bodies.b.shape = {{ kind = "particle", mass = 1 }}
    bodies.b.joint = {{ kind = "path", along = "s", pieces = [{{ arc = 2, turn = "{turn}", angle = 2 }}] }}
    outputs = {{ x = "x(b.center)", y = "y(b.center)" }}
    """
    assert answers(text) == pytest.approx({"x": 2 * sin(pi / 3), "y": sense * 2 * (1 - cos(pi / 3))})


def test_an_eyelet_lets_the_string_through():
    """One tension: M hangs and draws m over a smooth table, a = M g/(m + M), T = m a."""
    text = f"""{PLANE}
    coordinates = {{ x = -0.5, y = 0.4 }}
    points.E = [0, 1]
    bodies.a.shape = {{ kind = "particle", mass = 2 }}
    bodies.a.joint = {{ kind = "prismatic", at = [0, 1], axis = [1, 0], displacement = "x" }}
    bodies.b.shape = {{ kind = "particle", mass = 3 }}
    bodies.b.joint = {{ kind = "prismatic", axis = [0, 1], displacement = "y" }}
    constraints.s = {{ kind = "string", path = ["a.center", "E", "b.center"] }}
    outputs = {{ a = "x''", T = "tension(s)" }}
    """
    assert answers(text) == pytest.approx({"a": 3 * G / 5, "T": 2 * 3 * G / 5})


@pytest.mark.parametrize("speed", [3, -3])
def test_friction_of_a_support_is_told_along_its_normal_turned_clockwise(speed):
    """n = (-sin A, cos A), t = (cos A, sin A): F_t = -mu m g cos A sign(v) of a box that slides up with v along t."""
    text = f"""{PLANE}
    parameters = {{ A = 0.4 }}
    coordinates.s = {{ start = 0, speed = {speed} }}
    bodies.b.shape = {{ kind = "particle", mass = 2 }}
    bodies.b.joint = {{ kind = "placed", at = ["s*cos(A)", "s*sin(A)"] }}
    constraints.c = {{ kind = "support", point = "b.center", normal = ["-sin(A)", "cos(A)"], friction = 0.3 }}
    outputs.F = {{ value = "reaction_t(c)", from = "start" }}
    """
    assert answers(text)["F"] == pytest.approx(-np.sign(speed) * 0.3 * 2 * G * cos(0.4))


def test_a_slider_has_friction_along_the_line_of_a_body_that_turns():
    """A collar on a bar that turns with w, no weight:  r'' = r w^2 - mu |2 w r'| sign(r')."""
    w, r, v, mu, A = 3.0, 0.8, 1.5, 0.2, 0.4
    direction, across = np.array([cos(A), sin(A)]), np.array([-sin(A), cos(A)])
    place, rate = r * direction, v * direction + r * w * across
    text = f"""
    eomgen = 1
    space = "plane"
    coordinates.p = {{ motion = "{A} + {w}*t" }}
    coordinates.x = {{ start = {place[0]}, speed = {rate[0]} }}
    coordinates.y = {{ start = {place[1]}, speed = {rate[1]} }}
    bodies.bar.points = {{ A = [0, 0], B = [1, 0] }}
    bodies.bar.line = ["A", "B"]
    bodies.bar.joint = {{ kind = "revolute", angle = "p" }}
    bodies.c.shape = {{ kind = "particle", mass = 2 }}
    bodies.c.joint = {{ kind = "placed", at = ["x", "y"] }}
    constraints.s = {{ kind = "slider", point = "c.center", on = "bar", friction = {mu} }}
    """
    run = eomgen.simulate(eomgen.loads(text), time=1e-3, target="numpy")
    x, y, vx, vy = (run.phases[-1].last[name] for name in ("x", "y", "x'", "y'"))
    angle = A + w * 1e-3
    along = vx * cos(angle) + vy * sin(angle)
    assert x * cos(angle) + y * sin(angle) == pytest.approx(r + v * 1e-3, abs=1e-5)
    assert (along - v) / 1e-3 == pytest.approx(r * w * w - mu * 2 * w * v, rel=5e-3)


def test_a_place_seen_from_a_body_is_in_its_axes():
    """R^T (p - o): of o = (1, 2), turned by A, and p = o + (3, 0.5) in the ground's axes."""
    A = 0.4
    text = f"""{PLANE}
    coordinates = {{ a = {A}, x = 4, y = 2.5 }}
    bodies.b.mass = 1
    bodies.b.inertia = 1
    bodies.b.joint = {{ kind = "revolute", at = [1, 2], angle = "a" }}
    bodies.c.shape = {{ kind = "particle", mass = 1 }}
    bodies.c.joint = {{ kind = "placed", at = ["x", "y"] }}
    outputs = {{ x = "x(c.center, b)", y = "y(c.center, b)", v = "angle(b, c)" }}
    """
    x, y = 3 * cos(A) + 0.5 * sin(A), -3 * sin(A) + 0.5 * cos(A)
    assert answers(text) == pytest.approx({"x": x, "y": y, "v": A})


def test_the_components_of_a_contact_on_a_ball_are_those_of_one_force():
    """N^2 + F_t^2 + F_s^2 = |m (a - g)|^2 of a ball that rolls on another, where the normal leans."""
    text = """
    eomgen = 1
    space = "space"
    coordinates = { x = 0.3, y = 0.2, z = { dependent = true, near = 1.1 }, e0 = 1, e1 = 0, e2 = 0, e3 = 0 }
    speeds = { w1 = {}, w2 = {}, w3 = {} }
    bodies.big.shape = { kind = "sphere", mass = 5, radius = 1 }
    bodies.big.joint = { kind = "fixed" }
    bodies.ball.shape = { kind = "sphere", mass = 2, radius = 0.2 }
    constraints.c = { kind = "rolling", body = "ball", on = "big" }
    forces.weight = { kind = "gravity", acceleration = [0, 0, -9.81] }

    [bodies.ball.joint]
    kind = "free"
    position = ["x", "y", "z"]
    orientation = "quaternion"
    quaternion = ["e0", "e1", "e2", "e3"]
    omega = ["w1", "w2", "w3"]

    [outputs]
    n = "reaction_n(c)"
    t = "reaction_t(c)"
    s = "reaction_s(c)"
    ax = "ax(ball.center)"
    ay = "ay(ball.center)"
    az = "az(ball.center)"
    """
    found = answers(text)
    force = 2 * np.array([found["ax"], found["ay"], found["az"] + G])
    assert np.hypot(np.hypot(found["n"], found["t"]), found["s"]) == pytest.approx(np.linalg.norm(force))
    assert found["n"] == pytest.approx(force @ np.array([0.3, 0.2, np.sqrt(1.44 - 0.13)]) / 1.2)
