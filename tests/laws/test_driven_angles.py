"""One driven angle of a joint that turns about several axes: its drive does no work on the other angles."""

from __future__ import annotations

from math import cos, sin

import numpy as np
import pytest

import eomgen

HEAD = """
eomgen = 1
space = "space"
[coordinates]
"""
BODY = """
[bodies.B]
shape = {{ kind = "box", mass = 1, size = [1, 2, 3] }}
points = {{ P = [0.3, 0.1, 0.5] }}
joint = {{ {joint} }}
[forces.g]
kind = "gravity"
acceleration = [0, 0, -10]
[outputs]
D = "drive({driven})"
Cx = "reaction_couple_x(B)"
Cy = "reaction_couple_y(B)"
Cz = "reaction_couple_z(B)"
Fx = "reaction_x(B)"
Fy = "reaction_y(B)"
Fz = "reaction_z(B)"
"""
DRIVEN = {"motion": "0.5 + 0.3*t + 0.1*t^2"}
LAW = (0.5, 0.3, 0.2)
STARTS = {"a": (0.7, 0.6), "b": (0.4, 0.5), "c": (0.3, -0.4)}


def about(axis, angle: float) -> np.ndarray:
    """Rodrigues' rotation."""
    n = np.asarray(axis, float) / np.linalg.norm(axis)
    K = np.array([[0, -n[2], n[1]], [n[2], 0, -n[0]], [-n[1], n[0], 0]])
    return np.eye(3) + sin(angle) * K + (1 - cos(angle)) * K @ K


def by_hand(axes, path):
    """(force, couple) on the body at its joint: F = m (a_C - g), C = d/dt(I w) - r x F about the mass centre, by
    differences of R(t)."""
    h, m, r, g = 1e-4, 1.0, -np.array([0.3, 0.1, 0.5]), np.array([0, 0, -10])
    inertia = np.diag([13, 10, 5]) / 12

    def R(t):
        turned = np.eye(3)
        for axis, angle in zip(axes, path(t), strict=True):
            turned = turned @ about(axis, angle)
        return turned

    def momentum(t):
        W = (R(t + h) - R(t - h)) / (2 * h) @ R(t).T
        return R(t) @ inertia @ R(t).T @ np.array([W[2, 1], W[0, 2], W[1, 0]])

    a = (R(h) @ r - 2 * R(0) @ r + R(-h) @ r) / h**2
    F = m * (a - g)
    return F, (momentum(h) - momentum(-h)) / (2 * h) + np.cross(R(0) @ r, F)


def axes_in_space(axes, angles):
    """Each axis as the turns before it leave it."""
    turned, found = np.eye(3), []
    for axis, angle in zip(axes, angles, strict=True):
        found.append(turned @ np.asarray(axis, float) / np.linalg.norm(axis))
        turned = turned @ about(axis, angle)
    return found


OBLIQUE = [[1, 2, 0.5], [0, 1, 3]]
BALL = {name: [np.eye(3)["xyz".index(letter)] for letter in name] for name in ("zyx", "zxz", "xyx")}


@pytest.mark.parametrize(
    ("joint", "names", "axes", "driven"),
    [
        *(
            (f'kind = "spherical", point = "P", orientation = "{name}", angles = ["a", "b", "c"]', "abc", axes, driven)
            for name, axes, driven in (("zyx", BALL["zyx"], "a"), ("zxz", BALL["zxz"], "c"), ("xyx", BALL["xyx"], "b"))
        ),
        *((f'kind = "universal", point = "P", axes = {OBLIQUE}, angles = ["a", "b"]', "ab", OBLIQUE, n) for n in "ab"),
    ],
)
def test_a_driven_angle_does_no_work_on_the_others(joint, names, axes, driven):
    """C = dH/dt - r x F;   D = C . e_driven,   C . e_k = 0 of every other angle"""
    table = "".join(
        f'{n} = {{ motion = "{DRIVEN["motion"]}" }}\n'
        if n == driven
        else f"{n} = {{ start = {STARTS[n][0]}, speed = {STARTS[n][1]} }}\n"
        for n in names
    )
    model = eomgen.loads(HEAD + table + BODY.format(joint=joint, driven=driven))
    run = eomgen.simulate(model, time=0.01, samples=2, target="numpy")
    rhs = eomgen.derive(model).rhs("numpy")
    rates = dict(zip((*rhs.coordinates, *rhs.speeds), rhs(0.0, rhs.x0, rhs.p0), strict=True))

    def path(t):
        laws = [LAW if n == driven else (*STARTS[n], rates[f"{n}'"]) for n in names]
        return [q + v * t + acceleration * t * t / 2 for q, v, acceleration in laws]

    F, C = by_hand(axes, path)
    columns = {name: run[name][0] for name in ("D", "Cx", "Cy", "Cz", "Fx", "Fy", "Fz")}
    assert np.allclose([columns["Fx"], columns["Fy"], columns["Fz"]], F, atol=1e-5)
    assert np.allclose([columns["Cx"], columns["Cy"], columns["Cz"]], C, atol=1e-5)
    for n, e in zip(names, axes_in_space(axes, path(0)), strict=True):
        assert abs(C @ e - (columns["D"] if n == driven else 0)) < 1e-5
