"""derive --diff: two models differ by what was changed between them, and by nothing else."""

from __future__ import annotations

import json
from pathlib import Path

import pytest
from click.testing import CliRunner

from eomgen.cli import main

MODELS = Path(__file__).parent.parent / "models"
SPRING = """
[forces.coil]
kind = "generalized"
coordinate = "theta2"
value = "-k*theta2"
"""


def difference(first: Path, second: Path, *more: str) -> dict:
    result = CliRunner().invoke(main, ["derive", str(first), "--diff", str(second), "--json", *more])
    assert result.exit_code == 0, result.output
    return json.loads(result.stdout)


@pytest.mark.parametrize("name", ["double_pendulum", "four_bar", "atwood", "rolling_disc"])
def test_a_model_does_not_differ_from_itself(name):
    """R - R = 0 along every speed and in every constraint row."""
    found = difference(MODELS / f"{name}.toml", MODELS / f"{name}.toml", "--no-certify")
    assert found["same"] and found["declared"] == found["values"] == {}
    assert found["equations"] and {x["status"] for x in found["equations"]} == {"same"}


def test_a_force_that_is_added_is_the_difference(tmp_path):
    """M a + c - Q = 0 gains k theta2 along theta2, nothing along theta1; another value of a mass changes nothing."""
    text = (MODELS / "double_pendulum.toml").read_text(encoding="utf-8")
    other = tmp_path / "other.toml"
    other.write_text(text.replace("m1 = { value = 1.0", "k = 3\nm1 = { value = 2.0") + SPRING, encoding="utf-8")
    found = difference(MODELS / "double_pendulum.toml", other)
    assert found["declared"] == {
        "parameters": {"added": ["k"], "removed": []},
        "forces": {"added": ["coil"], "removed": []},
    }
    assert found["values"] == {"m1": [1.0, 2.0]} and not found["same"]
    along = {x["of"]: x for x in found["equations"]}
    assert along["theta1"]["status"] == "same"
    assert along["theta2"]["status"] == "changed" and along["theta2"]["difference"] in ("theta2*k", "k*theta2")
    assert found["certificate"]["ok"]
    back = difference(other, MODELS / "double_pendulum.toml", "--no-certify")
    assert {x["of"]: x["difference"] for x in back["equations"]}["theta2"] in ("-theta2*k", "-k*theta2")


def test_freedoms_that_one_does_not_have_are_told(tmp_path):
    """A second arm: its equation stands alone, that of the first one changed."""
    found = difference(MODELS / "simple_pendulum.toml", MODELS / "double_pendulum.toml", "--no-certify")
    status = {x["of"]: x["status"] for x in found["equations"]}
    assert status == {"theta": "removed", "theta1": "added", "theta2": "added"}
