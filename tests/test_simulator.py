"""simulator(model): one motion after another from other values, each what `simulate` gives."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from slow_run import usual

import eomgen
from eomgen.errors import MissingValues, UsageError

MODELS = Path(__file__).parent.parent / "models"


STRETCHED = """
eomgen = 1
space = "plane"
parameters = { l = 1, k = 10 }
coordinates = { x = { start = "l/2" } }
points = { A = [-1, 0] }
[bodies.b]
shape = { kind = "particle", mass = 1 }
joint = { kind = "prismatic", axis = [1, 0], displacement = "x" }
[forces.s]
kind = "spring"
points = ["A", "b.center"]
stiffness = "k"
length = "start"
[forces.weight]
kind = "gravity"
acceleration = [9.81, 0]
"""
"""where it starts follows from a parameter, and so does its spring"""
GEARED = """
eomgen = 1
space = "plane"
coordinates = { a = 0.2, b = { start = 0.1, speed = 1 } }
[bodies.one]
shape = { kind = "rod", mass = 1, length = 1 }
joint = { kind = "revolute", angle = "a" }
[bodies.two]
shape = { kind = "disc", mass = 1, radius = 1 }
joint = { kind = "revolute", at = [3, 0], angle = "b" }
[constraints.wheels]
kind = "gear"
bodies = ["one", "two"]
ratio = -2
[forces.weight]
kind = "gravity"
acceleration = [0, -9.81]
"""
"""which teeth mesh is said by the start"""


def model(name: str) -> eomgen.Model:
    return eomgen.loads(name) if "\n" in name else eomgen.load(MODELS / f"{name}.toml")


@pytest.mark.slow
@pytest.mark.parametrize(
    ("name", "value", "derived"),
    [("double_pendulum", {"l1": 2.0}, 1), ("four_bar", {"b": 1.1}, 1), ("box_on_two_feet", {"m": 9.0}, 1),
     ("four_cranks", {"m": 2.0}, 1), ("four_cranks", {"l": 0.5}, 2)],
)  # fmt: skip
def test_what_other_values_do_not_change_is_not_derived_again(name, value, derived):
    """Rows of equal cranks follow from others for these lengths alone: with other ones it is to be seen anew."""
    run = eomgen.simulator(model(name))
    run(0.01)
    count = len(run.bases)
    run(0.01, parameters=value)
    assert (count, len(run.bases)) == (1, derived)


@pytest.mark.slow
@pytest.mark.parametrize(
    ("name", "parameters", "start"),
    usual(
        [
            ("double_pendulum", {"g": 1.62}, {"theta1": "20 deg"}),
            ("four_bar", {"a": 0.3}, {}),
            ("sliding_ladder", {}, {}),
            ("cart_pole", {}, {"theta": 0.3}),
            ("four_bar", {}, {"alpha": 0.3, "beta": 1}),
            (STRETCHED, {"l": 3}, {}),
            (STRETCHED, {"l": 3}, {"x": 2}),
            (GEARED, {}, {"a": 0.5}),
            ("four_bar", {"b": 1.1, "m": 2}, {"alpha": 0.8}),
            ("box_on_two_feet", {"m": 9, "mu": 0.2}, {"x": 1}),
            ("box_on_two_feet", {"mu": 0}, {}),
            ("rough_incline", {"g": 1.6}, {}),
            ("rolling_cone", {"g": 5}, {}),
        ],
        3,
        2,
    ),
)
def test_it_gives_what_simulate_gives(name, parameters, start):
    """At other values than the model's own, at its own, and at the others again."""
    run = eomgen.simulator(model(name))
    for values, begun in ((parameters, start), ({}, {}), (parameters, start)):
        own = run(1.0, parameters=values, start=begun, samples=21)
        other = eomgen.simulate(model(name), time=1.0, parameters=values, start=begun, samples=21)
        assert own.t.tolist() == other.t.tolist() and own.x.tolist() == other.x.tolist()
        assert own.message == other.message and not own.reactions


@pytest.mark.slow
def test_equations_are_derived_once_for_all_parameters_of_a_model_without_ties(monkeypatch):
    derived = []
    derive = eomgen.pipeline.derive
    monkeypatch.setattr(eomgen.pipeline, "derive", lambda m: derived.append(m) or derive(m))
    run = eomgen.simulator(model("double_pendulum"))
    ends = [run(0.5, parameters={"g": g}).x[-1] for g in (1.0, 2.0, 3.0)]
    assert len(derived) == 1 and not np.allclose(ends[0], ends[1]) and not np.allclose(ends[1], ends[2])


@pytest.mark.slow
def test_a_parameter_that_has_no_value_is_given_at_the_call():
    text = (MODELS / "double_pendulum.toml").read_text().replace("value = 9.81, ", "")
    run = eomgen.simulator(eomgen.loads(text))
    with pytest.raises(MissingValues):
        run(0.1)
    assert run(0.1, parameters={"g": 9.81}).ok


@pytest.mark.slow
def test_reactions_are_columns_where_they_are_asked_for():
    run, whole = (
        eomgen.simulator(model("double_pendulum")),
        eomgen.simulate(model("double_pendulum"), time=1, samples=11),
    )
    name = next(iter(whole.reactions))
    assert list(run(1, samples=11, columns=[name]).columns()) == [
        "t",
        *whole.coordinates,
        *whole.speeds,
        "energy",
        name,
    ]
    assert run(1, samples=11, columns=("reactions", "outputs")).columns().keys() == whole.columns().keys()
    with pytest.raises(UsageError, match="no column 'reaction_q'"):
        run(1, columns=["reaction_q"])
