"""A link whose length is a function of time: a load on a winch, by polar coordinates and by its energy."""

from __future__ import annotations

import numpy as np
import pytest
from each import each
from scipy.integrate import solve_ivp

import eomgen

WINCH = """
eomgen = 1
name = "Load on a winch"
space = "plane"
points = { O = [0, 0] }
parameters.m = { value = 1.5, unit = "kg" }
parameters.l0 = { value = 2, unit = "m" }
parameters.a = { value = 0.3, unit = "m" }
parameters.w = { value = 2, unit = "rad/s" }
coordinates.x = { start = 1, unit = "m" }
coordinates.y = { dependent = true, near = -1.7, unit = "m" }
forces.weight = { kind = "gravity", acceleration = [0, -9.81] }
outputs.S = "tension(rope)"

[bodies.load]
shape = { kind = "particle", mass = "m" }
joint = { kind = "planar", x = "x", y = "y", angle = 0 }

[constraints.rope]
kind = "link"
points = ["O", "load.center"]
length = "l0 - a*sin(w*t)"
"""


def polar(t: float) -> tuple[float, float, float]:
    """Angle from the downward vertical, its rate, and L, of the load that starts with x' = 0."""
    L, dL = (lambda s: 2 - 0.3 * np.sin(2 * s)), (lambda s: -0.6 * np.cos(2 * s))
    angle = np.arcsin(0.5)
    rate = -dL(0) * np.sin(angle) / (2 * np.cos(angle))
    law = lambda s, y: [y[1], (-2 * dL(s) * y[1] - 9.81 * np.sin(y[0])) / L(s)]  # noqa: E731
    found = solve_ivp(law, (0, t), [angle, rate], rtol=1e-12, atol=1e-12).y[:, -1]
    return float(found[0]), float(found[1]), float(L(t))


@each("more", ["", "unilateral = true\n"])
def test_a_load_on_a_winch_swings_as_polar_coordinates_say(more):
    run = eomgen.simulate(eomgen.loads(WINCH + more), time=2, target="numpy", rtol=1e-10, atol=1e-10)
    angle, rate, L = polar(2)
    assert (run["x"][-1], run["y"][-1]) == pytest.approx((L * np.sin(angle), -L * np.cos(angle)), abs=1e-7)
    paid = 1.2 * np.sin(4)  # L''
    tension = 1.5 * (L * rate**2 + 9.81 * np.cos(angle) - paid)
    assert run.reactions["tension(rope)"][-1] == pytest.approx(tension, rel=1e-6)
    assert run.ok


@each("method", ["lagrange", "projection", "kinetostatic"])
def test_its_derivation_is_proven(method):
    assert eomgen.derive(eomgen.loads(WINCH), method=method).certify().ok


def test_a_length_of_time_has_a_length():
    with pytest.raises(eomgen.ModelError, match="but the length of constraint 'rope' is in m"):
        eomgen.loads(WINCH.replace('"l0 - a*sin(w*t)"', '"a*t"'))
