"""How many digits of a run hold: its own estimate against what is known of the motion."""

from __future__ import annotations

import math
from pathlib import Path

import numpy as np
import pytest
from closed_motions import DRAGGED, STEP, TOLERANCE, off
from scipy.special import ellipj, ellipk

import eomgen
from eomgen.errors import UsageError

MODELS = Path(__file__).parent.parent / "models"

PENDULUM = """
eomgen = 1
space = "plane"
coordinates.theta = 2
bodies.bob = { shape = { kind = "particle", mass = 1 }, joint = { kind = "revolute", angle = "theta" } }
forces.weight = { kind = "gravity", acceleration = [0, -9.81] }
"""
PENDULUM = PENDULUM.replace('kind = "revolute", angle = "theta"', 'kind = "placed", at = ["sin(theta)", "-cos(theta)"]')


def closed(t: np.ndarray) -> np.ndarray:
    """sin(theta/2) = k sn(K + omega t, k), k = sin(theta0/2), from rest at theta0 = 2."""
    k = math.sin(1.0)
    return 2 * np.arcsin(k * ellipj(math.sqrt(9.81) * t + ellipk(k * k), k * k)[0])


@pytest.mark.slow
@pytest.mark.parametrize("method", ["DOP853", "Radau"])
@pytest.mark.parametrize("tolerance", [1e-6, 1e-9])
def test_the_estimate_is_the_error_against_the_closed_motion(tolerance, method):
    """Within a factor of three, after thirty swings."""
    run = eomgen.simulate(eomgen.loads(PENDULUM), time=60, samples=61, rtol=tolerance, atol=tolerance, method=method)
    error = abs(run["theta"][-1] - closed(run.t[-1:])[0]) / 2
    rate = np.sqrt(2 * 9.81 * np.maximum(np.cos(run["theta"][-1]) - math.cos(2), 0))
    error = max(error, abs(abs(run["theta'"][-1]) - rate) / np.max(np.abs(run["theta'"])))
    assert error / 3 < run.accuracy.error < 3 * error + 1e-10
    assert run.accuracy.digits == math.floor(-math.log10(run.accuracy.error)) and run.accuracy.until is None


@pytest.mark.slow
def test_in_chaos_the_digits_run_out_later_at_finer_tolerances():
    """A double pendulum loses them at one pace: nine digits more last some ten seconds longer."""
    simulate = eomgen.simulator(MODELS / "double_pendulum.toml", rtol=1e-6, atol=1e-6)
    run = simulate(60, samples=601)
    assert run.accuracy.digits == 0 and 5 < run.accuracy.until < 40
    assert f"No digit of the states holds from t = {run.accuracy.until:.4g} s on" in str(run.accuracy)
    finest = eomgen.simulator(MODELS / "double_pendulum.toml", rtol=1e-13, atol=1e-13)(60, samples=601)
    assert finest.accuracy.until is None or finest.accuracy.until > run.accuracy.until
    apart = np.max(np.abs(run.x - finest.x), axis=1) / np.max(np.abs(finest.x))
    assert np.max(apart[run.t < run.accuracy.until / 2]) < 0.1


@pytest.mark.slow
def test_the_energy_is_kept_for_a_thousand_swings():
    """DOP853 alone loses it at a steady pace; kept where the swing is fast, the swings keep their time."""
    free, kept = (
        eomgen.simulate(eomgen.loads(PENDULUM), time=1000, samples=501, rtol=1e-6, atol=1e-6, stabilization=way)
        for way in ("projection", "energy")
    )
    errors = [np.max(np.abs(run["theta"] - closed(run.t))[-50:]) for run in (free, kept)]
    assert kept.drift < 1e-2 * free.drift and errors[1] < errors[0] / 20


@pytest.mark.slow
@pytest.mark.parametrize("target", ["c", "numpy"])
def test_the_energy_of_a_linkage_is_kept_beside_its_ties(target):
    run = eomgen.simulate(MODELS / "four_bar.toml", time=5, rtol=1e-6, atol=1e-6, stabilization="energy", target=target)
    assert run.ok and run.drift < 1e-12 and run.gap < 1e-6 and run.gap_rate < 1e-6


def test_what_does_not_keep_its_energy_is_refused():
    with pytest.raises(UsageError, match="energy is not conserved"):
        eomgen.simulate(MODELS / "cart_pole.toml", time=1, stabilization="energy")


def test_a_run_that_ends_at_an_event_keeps_its_digits():
    """Both runs end at theta = 0, some 1e-12 s apart: that is one end, not a motion that goes another way."""
    run = eomgen.simulate(MODELS / "simple_pendulum.toml", time=5, until="theta = 0", target="numpy")
    found = run.accuracy
    assert run.t[-1] < 5 and found.until is None and found.digits >= 8


BETWEEN = {"time": 0.2, "samples": 1001, "method": "DOP853", "rtol": TOLERANCE, "atol": TOLERANCE}


@pytest.mark.parametrize("target", [pytest.param("c", marks=pytest.mark.slow), "numpy"])
def test_states_between_the_steps_are_as_accurate_as_the_steps(target):
    """A damper holds the steps short by stability alone: their polynomials miss it by thousands of tolerances."""
    run = eomgen.simulate(eomgen.loads(DRAGGED), target=target, **BETWEEN)
    assert len(run.t) > 10 * run.steps and off(run.x, run.t) < STEP


@pytest.mark.slow
def test_states_between_the_steps_of_many_runs_are_as_accurate():
    """In lanes; each run is the same among others as alone, to the bit."""
    model, stiffnesses = eomgen.loads(DRAGGED), (2000.0, 1000.0, 8000.0, 1.0, 4000.0)
    many = eomgen.simulate_many(model, parameters={"k": stiffnesses}, **BETWEEN)
    for states, k in zip(many.x, stiffnesses, strict=True):
        assert off(states, many.t, k) < STEP
        alone = eomgen.simulate_many(model, parameters={"k": [k]}, **BETWEEN)
        assert np.array_equal(alone.x[0], states)
