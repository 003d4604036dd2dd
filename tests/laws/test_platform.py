"""A platform on six legs: eighteen constraint rows, against the textbook's one freedom and the general laws."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from slow_run import in_slow_run

import eomgen

pytestmark = pytest.mark.slow

MODEL = Path(__file__).parents[2] / "models" / "stewart_platform.toml"


@pytest.fixture(scope="module")
def equations():
    return eomgen.derive(eomgen.load(MODEL))


def lift(p: dict[str, float]) -> float:
    """z'' from rest, all drives pushing alike: one freedom, by Lagrange's equation with its effective mass.

    A leg of length s stands at z/s = cos(gamma): s' = z' cos(gamma), omega = z' sin(gamma)/s.
    """
    across = np.hypot(p["X1"], p["Y1"])
    s = np.hypot(across, p["H"])
    cosine, omega = p["H"] / s, across / s / s
    leg = (p["I_c"] + p["m_c"] * p["l_c"] ** 2 / 4 + p["I_r"]) * omega**2
    leg += p["m_r"] * (cosine**2 + ((s - p["l_r"] / 2) * omega) ** 2)
    steeper = 1 / s - p["H"] ** 2 / s**3  # d cos(gamma)/dz
    weights = p["m_c"] * p["l_c"] / 2 * steeper + p["m_r"] * (1 - p["l_r"] / 2 * steeper)
    return (6 * p["P"] * cosine - p["g"] * (p["M"] + 6 * weights)) / (p["M"] + 6 * leg)


@pytest.mark.parametrize("target", ["c", "numpy"])
def test_it_lifts_off_as_one_freedom_does(equations, target):
    """All drives push with P, legs thin: z'' is that of the symmetric motion, and nothing else moves."""
    rhs = equations.rhs(target)
    p = dict(zip(rhs.parameters, rhs.p0, strict=True)) | {"J_c": 0.0, "J_r": 0.0}
    a = dict(zip(rhs.coordinates, rhs(0.0, rhs.x0, list(p.values()), [p["P"]] * 6)[24:], strict=True))
    assert a["z"] == pytest.approx(lift(p), rel=1e-12)
    assert max(abs(a[name]) for name in ("x", "y", "phi", "theta", "psi")) < 1e-12
    assert [a[f"s{i}"] for i in range(1, 7)] == pytest.approx([a["z"] * p["H"] / rhs.x0[8]] * 6, rel=1e-10)


def test_it_is_proved(equations):
    """Lagrange, projection and recursion agree, and the free bodies move as it says."""
    assert equations.certify("c").ok


@in_slow_run
def test_what_the_drives_do_and_the_dampers_take_is_what_it_gains(equations):
    """T + V at the end = T + V at the start + the work of the drives, less that of the dampers."""
    run = eomgen.simulate(equations.model, time=0.5, rtol=1e-10, atol=1e-10)
    p = dict(zip(equations.parameters, equations.rhs("numpy").p0, strict=True))
    power = np.zeros_like(run.t)
    for i in range(1, 7):
        push = p["P"] + (20 if i % 2 else 15) * np.sin((i + 2) * run.t)
        power += (push - p["c"] * run[f"s{i}'"]) * run[f"s{i}'"]
    from scipy.interpolate import CubicSpline

    work = CubicSpline(run.t, power).integrate(0, run.t[-1])
    assert run.status == "finished"
    assert run.energy[-1] - run.energy[0] == pytest.approx(work, rel=1e-5)
