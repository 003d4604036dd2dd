"""A motion whose closed form is known: a light body in a viscous guide of a heavy one that swings on a spring.

M x'' = -k x + c y',   m (x'' + y'') = -c y':   stability alone holds the steps of an explicit method short.
"""

from __future__ import annotations

import numpy as np
from scipy.linalg import expm

TOLERANCE = 1e-8
STEP = 50  # tolerances: what the end of a step may miss here, whose own estimate is too small where it is stiff
DRAGGED = """
eomgen = 1
space = "plane"
parameters = { M = 1, m = 0.001, k = 2000, c = 1.44 }
coordinates = { x = { start = 0.03, speed = 0 }, y = { start = 0, speed = 0.8 } }
bodies.heavy.shape = { kind = "particle", mass = "M" }
bodies.heavy.joint = { kind = "prismatic", axis = [1, 0], displacement = "x" }
bodies.light.shape = { kind = "particle", mass = "m" }
bodies.light.joint = { kind = "prismatic", on = "heavy", axis = [1, 0], displacement = "y", damping = "c" }
forces.pull = { kind = "force", point = "heavy.center", force = ["-k*x", 0] }
"""


def off(states: np.ndarray, t: np.ndarray, k: float = 2000.0) -> float:
    """The largest error of states (x, y, x', y'), n x 4, in tolerances of the largest state."""
    M, m, c = 1, 0.001, 1.44
    A = np.array([[0, 0, 1, 0], [0, 0, 0, 1], [-k / M, 0, 0, c / M], [k / M, 0, 0, -c / M - c / m]])
    expected = np.array([expm(A * each) for each in t]) @ [0.03, 0, 0, 0.8]
    return float(np.max(np.abs(states - expected)) / (TOLERANCE * (1 + np.max(np.abs(expected)))))
