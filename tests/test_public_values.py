"""What Python functions give: it is pickled and back the same, shows itself, and leaves memory as it was."""

from __future__ import annotations

import gc
import pickle
from pathlib import Path

import numpy as np
import pytest
from slow_run import ALL, usual

import eomgen

pytestmark = pytest.mark.slow

MODELS = Path(__file__).parent.parent / "models"


@pytest.fixture(scope="module")
def pendulum() -> eomgen.Model:
    return eomgen.load(MODELS / "double_pendulum.toml")


VALUES = {
    "run": lambda m: eomgen.simulate(m, time=1),
    "runs": lambda m: eomgen.simulate_many(m, time=1, parameters={"m1": [1, 2]}),
    "sweep": lambda m: eomgen.sweep(m, over={"m1": [1, 2]}, ask="max(theta1)", time=1),
    "linearization": eomgen.linearize,
    "rhs": lambda m: eomgen.derive(m).rhs(),
    "report": eomgen.report,
    "page": lambda m: eomgen.animate(m, time=0.1),
    "sensitivity": lambda m: eomgen.sensitivity(m, "frequency(1)", "m1"),
    "regressor": eomgen.regressor,
    "verdict": lambda m: eomgen.verify(m, "T = 0"),
    "scene": eomgen.scene_of,
    "inertia": eomgen.inertia,
    "reactions": eomgen.reactions,
    "answers": eomgen.solve,
    "generated": lambda m: eomgen.generate(m, ("c",)),
    "inverse dynamics": eomgen.inverse_dynamics,
    "certificate": lambda m: eomgen.derive(m).certify(),
    "statics": lambda m: eomgen.statics(MODELS / "gerber_beam.toml"),
    "kinematics": lambda m: eomgen.kinematics(MODELS / "four_bar.toml"),
}


@pytest.mark.parametrize("what", usual([*VALUES], 3))
def test_a_value_goes_into_a_pickle_and_back(pendulum, what):
    """repr(loads(dumps(x))) = repr(x)"""
    value = VALUES[what](pendulum)
    again = pickle.loads(pickle.dumps(value))
    assert type(again) is type(value) and repr(again) == repr(value)


def test_a_run_out_of_a_pickle_has_its_numbers_and_says_what_it_lacks(pendulum):
    """Columns, energy, drift, phases are the same; its proof takes equations, which are not in it"""
    run = eomgen.simulate(pendulum, time=1)
    again = pickle.loads(pickle.dumps(run))
    assert all(np.array_equal(again[name], column) for name, column in run.columns().items())
    assert again.ok and again.status == run.status
    assert again.drift == run.drift and again.phases[0].end == run.phases[0].end
    assert all(np.array_equal(a, b) for a, b in zip(again.phases[0].track, run.phases[0].track, strict=True))
    for requested in (again.certify, lambda: again.ask("max(theta1)"), lambda: again.accuracy):
        with pytest.raises(eomgen.UsageError, match="nothing is known of the equations"):
            requested()


def test_numbers_of_a_linearization_out_of_a_pickle_are_exactly_those(pendulum):
    """Of 50 digits none is lost"""
    found = eomgen.linearize(pendulum).modes.small.reference.numbers
    again = pickle.loads(pickle.dumps(eomgen.linearize(pendulum))).modes.small.reference.numbers
    assert [str(x) for x in found.values()] == [str(x) for x in again.values()]


def test_a_right_hand_side_out_of_a_pickle_gives_the_same_rates(pendulum):
    rhs = eomgen.derive(pendulum).rhs()
    again = pickle.loads(pickle.dumps(rhs))
    assert np.array_equal(again(0.5, rhs.x0, rhs.p0), rhs(0.5, rhs.x0, rhs.p0))


def test_a_report_out_of_a_pickle_writes_the_same_files(pendulum, tmp_path):
    """The page, and the pictures beside a text"""
    from eomgen.page.formats import written_as

    found = eomgen.report(pendulum, time=0.5)
    again = pickle.loads(pickle.dumps(found))
    assert written_as(again, ".html", "r.html") == written_as(found, ".html", "r.html")
    assert written_as(again, ".md", "r.md").keys() == written_as(found, ".md", "r.md").keys()


def test_a_model_is_derived_once_and_says_nothing_of_it_in_a_pickle(pendulum):
    """derive(m) is derive(m), and the size of the pickle is that of the text"""
    model = eomgen.load(MODELS / "arm3.toml")
    size = len(pickle.dumps(model))
    equations = eomgen.derive(model)
    assert eomgen.derive(model) is equations and eomgen.derive(model, "projection") is not equations
    assert len(pickle.dumps(model)) == size
    assert eomgen.derive(model, parameters={"m1": 2} if "m1" in model.parameters else {}) is not None
    assert pickle.loads(pickle.dumps(model)) == model


def test_values_that_replace_others_do_not_reach_what_is_kept(pendulum):
    """A run with another mass, then one with the model's own: each its own numbers, whatever came before"""
    first = eomgen.simulate(pendulum, time=1, samples=11)
    other = eomgen.simulate(pendulum, time=1, samples=11, parameters={"m2": 3}, start={"theta1": 1})
    again = eomgen.simulate(pendulum, time=1, samples=11)
    assert np.array_equal(first.x, again.x) and not np.allclose(first.x, other.x)


def test_runs_leave_memory_as_it_was(pendulum):
    """Of many runs no object is left behind, with the collector as Python starts it; there were 1500 a run"""
    for _ in range(3):
        eomgen.simulate(pendulum, time=0.1, samples=3)
    gc.collect()
    before = len(gc.get_objects())
    many = 30 if ALL else 10
    for _ in range(many):
        eomgen.simulate(pendulum, time=0.1, samples=3)
    assert len(gc.get_objects()) - before < many * 5


def test_what_notebooks_show(pendulum):
    """A verdict its words, a page and a report themselves, a model and a run their pictures; reprs are short"""
    verdict = eomgen.verify(pendulum, "T = 0")
    assert repr(verdict).startswith("wrong: T = 0\n") and "wrong: T = 0" in verdict._repr_html_()
    report = eomgen.report(pendulum, time=0.5)
    page = eomgen.animate(pendulum, time=0.5)
    for each in (report, page):
        assert each._repr_html_().startswith("<iframe") and len(repr(each)) < 300
    assert pendulum.picture._repr_png_() and eomgen.simulate(pendulum, time=0.5).picture._repr_png_()


def test_a_model_is_animated_as_a_run_is(pendulum, tmp_path):
    """animate(model, time=...) is animate(simulate(model, time=...)); a run has its time already"""
    eomgen.animate(MODELS / "double_pendulum.toml", tmp_path / "a.gif", time=0.2)
    assert (tmp_path / "a.gif").stat().st_size > 1000
    with pytest.raises(eomgen.UsageError, match="has its time and values already"):
        eomgen.animate(eomgen.simulate(pendulum, time=0.1), time=1)
