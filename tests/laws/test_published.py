"""Numbers and equations that others have published."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

import eomgen

MODELS = Path(__file__).parents[2] / "models"

ANDREWS = {  # t = 0.03 s; Mazzia & Magherini, Test Set for IVP Solvers, 2.4, problem "Andrews' squeezing mechanism"
    "beta": 15.81077119629904,
    "Theta": -15.75637105984298,
    "gamma": 0.04082224013073101,
    "Phi": -0.5347301163226948,
    "delta": 0.5244099658805304,
    "Omega": 0.5347301163226948,
    "epsilon": 1.048080741042263,
}


def test_andrews_squeezer_ends_where_the_test_set_says():
    """Seven bodies, three loops, a spring and a motor: all seven angles at 0.03 s to 1e-8."""
    run = eomgen.simulate(eomgen.load(MODELS / "andrews_squeezer.toml"), time=0.03, rtol=1e-10, atol=1e-12)
    assert run.ok, run.message
    end = dict(zip(run.coordinates, run.x[-1], strict=False))
    assert end == pytest.approx(ANDREWS, abs=1e-8)
    assert run.gap is not None and run.gap < 1e-10


CHAOTIC = """
eomgen = 1
name = "Chaotic pendulum: a plate that turns on a rod about the rod's own direction"
space = "space"
[parameters]
mA = 0.01
mB = 0.1
LA = 0.075
LB = 0.2
IAx = 5e-5
IBx = 2.5e-4
IBy = 5e-5
IBz = 2e-4
g = 9.81
[coordinates]
qA = "pi/2"
qB = { start = 0.5, unit = "deg" }
[bodies.rod]
mass = "mA"
center = [0, 0, "-LA"]
inertia = ["IAx", "IAx", 0]
joint = { kind = "revolute", axis = [1, 0, 0], angle = "qA" }
[bodies.plate]
mass = "mB"
inertia = ["IBx", "IBy", "IBz"]
joint = { kind = "revolute", on = "rod", at = [0, 0, "-LB"], axis = [0, 0, 1], angle = "qB" }
[forces.weight]
kind = "gravity"
acceleration = [0, 0, "-g"]
"""


def test_the_chaotic_pendulum_has_the_equations_of_kane():
    """The 'babyboot' of Autolev and of PyDy: Kane & Levinson's equations, at random states.

    qA'' = (2 qA' qB' sin cos (IBx - IBy) - (mA LA + mB LB) g sin qA)
           / (IAx + mA LA^2 + mB LB^2 + IBx cos^2 + IBy sin^2)
    qB'' = - qA'^2 sin qB cos qB (IBx - IBy) / IBz
    """
    model = eomgen.loads(CHAOTIC)
    rhs = eomgen.derive(model).rhs("numpy")
    mA, mB, LA, LB, IAx, IBx, IBy, IBz, g = rhs.p0
    for qA, qB, wA, wB in np.random.default_rng(1).uniform(-3, 3, (20, 4)):
        s, c = np.sin(qB), np.cos(qB)
        inertia = IAx + mA * LA**2 + mB * LB**2 + IBx * c**2 + IBy * s**2
        aA = (2 * wA * wB * s * c * (IBx - IBy) - (mA * LA + mB * LB) * g * np.sin(qA)) / inertia
        aB = -(wA**2) * s * c * (IBx - IBy) / IBz
        assert rhs(0.0, [qA, qB, wA, wB], rhs.p0) == pytest.approx([wA, wB, aA, aB], rel=1e-12, abs=1e-12)


FURUTA = """
eomgen = 1
name = "Furuta pendulum"
space = "space"
[parameters]
m = 0.3
L1 = 0.25
l2 = 0.2
J1 = 0.01
J2 = 0.004
g = 9.81
[coordinates]
t1 = 0.1
t2 = 0.3
[inputs]
tau = 0
[bodies.arm]
mass = 1
center = [0, 0, 0]
inertia = [0, "J1", "J1"]
points = { tip = ["L1", 0, 0] }
joint = { kind = "revolute", axis = [0, 0, 1], angle = "t1", torque = "tau" }
[bodies.pendulum]
mass = "m"
center = [0, 0, "-l2"]
inertia = ["J2", "J2", 0]
joint = { kind = "revolute", on = "arm.tip", axis = [1, 0, 0], angle = "t2" }
[forces.weight]
kind = "gravity"
acceleration = [0, 0, "-g"]
"""


def test_the_furuta_pendulum_has_the_published_equations():
    """Cazzolato & Prime, J. Control Science and Engineering 2011, eqs. 33-34, without damping.

    a1 (J1 + m L1^2 + J sin^2 t2) + a2 m L1 l2 cos t2 - m L1 l2 w2^2 sin t2 + w1 w2 J sin 2 t2 = tau
    a1 m L1 l2 cos t2 + a2 J - w1^2 J sin(2 t2) / 2 + m g l2 sin t2 = 0,  J = J2 + m l2^2
    """
    rhs = eomgen.derive(eomgen.loads(FURUTA)).rhs("numpy")
    m, L1, l2, J1, J2, g = rhs.p0
    Jp = J2 + m * l2**2
    for t1, t2, w1, w2, tau in np.random.default_rng(2).uniform(-3, 3, (20, 5)):
        _, _, a1, a2 = rhs(0.0, [t1, t2, w1, w2], rhs.p0, [tau])
        s, c = np.sin(t2), np.cos(t2)
        first = a1 * (J1 + m * L1**2 + Jp * s**2) + m * L1 * l2 * (a2 * c - w2**2 * s) + w1 * w2 * Jp * 2 * s * c
        second = a1 * m * L1 * l2 * c + a2 * Jp - w1**2 * Jp * s * c + m * g * l2 * s
        assert first == pytest.approx(tau, rel=1e-9, abs=1e-9)
        assert second == pytest.approx(0, abs=1e-9)
