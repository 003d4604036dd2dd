"""A run whose own energy, constraints or norms say that it is wrong is not ok, without being asked for its proof."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

import eomgen
from eomgen.frozen import with_fields
from eomgen.runs import batch_of_runs as many_runs
from eomgen.simulation.solvers import Accuracy

pytestmark = pytest.mark.slow

MODELS = Path(__file__).parent.parent / "models"


def altered(run, column, by):
    """The run with one column of its states multiplied from the middle of the first phase on."""
    (phase, *others) = run.phases
    t, x = phase.track
    x = x.copy()
    x[len(t) // 2 :, column] *= by
    return with_fields(run, phases=(with_fields(phase, tracked=lambda: (t, x)), *others))


@pytest.mark.parametrize(
    ("name", "column", "what"),
    [
        ("double_pendulum", 2, "E - E0 is the integral of the power"),
        ("cart_pole", 3, "E - E0 is the integral of the power"),
        ("four_bar", 1, "E - E0 is the integral of the power|the constraints are satisfied"),
        ("sliding_ladder", 0, "E - E0|constraints"),
        ("tumbling_body", 3, "E - E0|quaternions keep their norm"),
    ],
)
def test_a_run_that_leaves_what_it_watches_is_contradicted(name, column, what):
    """E - E0 = integral of the power, phi = 0, e . e = 1: one state in a thousandth elsewhere, and ok is False"""
    run = eomgen.simulate(MODELS / f"{name}.toml", time=0.5)
    assert run.ok and run.status == "finished" and not run.contradiction
    wrong = altered(run, column, 1.001)
    assert not wrong.ok and wrong.status == "contradicted"
    assert "It contradicts what it watches" in wrong.message
    assert any(part in wrong.message for part in what.split("|"))
    wrong.certify()
    assert not wrong.ok


def test_a_wrong_right_hand_side_is_seen_by_the_energy(monkeypatch):
    """A force of a twentieth of the weight that is not in the equations: energy is not constant, the run says so"""
    from eomgen.simulation.phase_model import PhaseModel

    rate = PhaseModel.rate.func

    def leaning(self):
        usual = rate(self)
        return lambda t, x: usual(t, x) + np.array([0.0, 0.0, 0.5, 0.0])

    monkeypatch.setattr(PhaseModel, "rate", property(leaning))
    run = eomgen.simulate(MODELS / "double_pendulum.toml", time=1)
    assert run.status == "contradicted" and not run.ok


def test_many_runs_that_leave_what_they_watch_are_contradicted(monkeypatch):
    """The same limits for each of many; what is contradicted is nan"""
    lanes = many_runs._in_lanes

    def drifting(plan, threads):
        names, status, message, x, steps = lanes(plan, threads)
        x[1, 50:, 2] *= 1.001
        return names, status, message, x, steps

    monkeypatch.setattr(many_runs, "_in_lanes", drifting)
    runs = eomgen.simulate_many(MODELS / "double_pendulum.toml", time=1, parameters={"m1": [1, 2, 3]})
    assert runs.status.tolist() == ["finished", "contradicted", "finished"]
    assert "the energy, which is constant, changes" in runs.message[1] and np.isnan(runs.x[1]).all()
    assert np.isfinite(runs.x[[0, 2]]).all()


def test_motions_part_where_their_distance_grows_step_by_step():
    """Chaos is named where digits go one after the other, not where most go at one instant"""
    run = eomgen.simulate(MODELS / "double_pendulum.toml", time=40)
    assert run.accuracy.parts and "neighbouring motions part" in str(run.accuracy)
    other = with_fields(run, x=run.x.copy())
    other.x[500:] = 0.0
    jumped = Accuracy.of(run, other, 1.0)
    assert jumped.until is not None and not jumped.parts and "a finer run goes another way" in str(jumped)
