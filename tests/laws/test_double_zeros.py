"""A zero eigenvalue that has fewer modes than it counts for: a small motion grows like t, and that is said."""

from __future__ import annotations

import numpy as np
import pytest

import eomgen

BEAD = """
eomgen = 1
space = "space"
parameters = { m = 1, c = 2, g = 9, omega = 6 }
coordinates = { phi = { motion = "omega*t" }, r = { start = 0.3 } }
bodies.wire.joint = { kind = "revolute", axis = [0, 0, 1], angle = "phi" }
bodies.bead.shape = { kind = "particle", mass = "m" }
bodies.bead.joint = { kind = "placed", on = "wire", at = ["r", 0, "c*r^2"] }
forces.w = { kind = "gravity", acceleration = [0, 0, "-g"] }
"""
CRITICAL = """
eomgen = 1
space = "plane"
parameters = { m = 2, l = 0.5, g = 10 }
coordinates = { a = 0 }
bodies.bar.shape = { kind = "rod", mass = "m", length = "l" }
bodies.bar.joint = { kind = "revolute", angle = "a + pi/2", stiffness = "m*g*l/2", rest = "pi/2" }
forces.w = { kind = "gravity", acceleration = [0, "-g"] }
"""
CART = """
eomgen = 1
space = "plane"
coordinates = { x = { start = 0, speed = SPEED }, y = 0 }
bodies.cart.shape = { kind = "particle", mass = 3 }
bodies.cart.joint = { kind = "prismatic", axis = [1, 0], displacement = "x", damping = DAMPING }
bodies.load.shape = { kind = "particle", mass = 1 }
bodies.load.joint = { kind = "prismatic", on = "cart", axis = [1, 0], displacement = "y", stiffness = 8 }
"""


def cart(speed: float = 0, damping: float = 0) -> str:
    return CART.replace("SPEED", str(speed)).replace("DAMPING", str(damping))


@pytest.mark.parametrize(
    ("text", "about", "name"),
    [(BEAD, "steady", "r"), (CRITICAL, "equilibrium", "a"), (cart(), "equilibrium", "x")],
)
def test_what_grows_like_time_is_called_unstable(text, about, name):
    """x = x_2 + t x_1 of A x_1 = 0, A x_2 = x_1:  ||exp(A t)|| grows like t"""
    found = eomgen.linearize(eomgen.loads(text), about=about)
    A = np.array(found.state_space().A, dtype=float)
    values = np.linalg.eigvals(A)
    assert np.linalg.matrix_rank(A @ A, tol=1e-12) < np.linalg.matrix_rank(A, tol=1e-12) and not any(values.real > 1e-6)
    spectrum = found.modes.spectrum
    assert spectrum.stability == "unstable to first order" and f"{name} grows like t" in spectrum.why
    assert found.certify().ok


def test_a_shift_into_a_steady_motion_nearby_is_none():
    """x' = v + d of what nothing depends on is a steady motion too"""
    found = eomgen.linearize(eomgen.loads(cart(speed=2)), about="steady")
    assert found.modes.spectrum.stability == "stable to first order" and "nearby" in found.modes.spectrum.why


def test_a_zero_that_has_its_modes_does_not_grow():
    """m x'' = -c x':  x stays where it comes to rest"""
    found = eomgen.linearize(eomgen.loads(cart(damping=2)))
    assert found.modes.spectrum.stability == "undecided"
