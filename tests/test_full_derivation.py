"""eomgen derive --full: everything is printed, however long."""

from __future__ import annotations

import json
from pathlib import Path

import pytest
from click.testing import CliRunner
from slow_run import in_slow_run, sampled, usual

from eomgen.cli import main

pytestmark = pytest.mark.slow

MODELS = Path(__file__).parent.parent / "models"


def derived(model: str, *options: str) -> str:
    result = CliRunner().invoke(main, ["derive", str(MODELS / f"{model}.toml"), "--no-certify", *options])
    assert result.exit_code == 0
    return result.stdout


@sampled(2)
@pytest.mark.parametrize("format", usual(["text", "latex", "markdown", "json"], 2))
def test_full_leaves_nothing_out_in_any_format(format):
    """26 more are too long to print here: not with --full"""
    assert "too long to print here" in derived("arm7", "--format", format)
    full = derived("arm7", "--format", format, "--full")
    assert "too long" not in full and "not printed" not in full


@in_slow_run
def test_full_carries_the_equations_in_the_steps_of_json():
    """q1'' to q7'' stand in the formulas of the last but one step"""
    steps = {step["key"]: step for step in json.loads(derived("arm7", "--json", "--full"))["steps"]}
    formulas = " ".join(s["text"] for s in steps["equations"]["statements"] if s["kind"] == "formula")
    assert all(f"q{k}''" in formulas for k in range(1, 8))


def test_full_changes_nothing_where_everything_fits():
    """ch22_p1 is short"""
    assert derived("seeds/ch22_p1", "--full") == derived("seeds/ch22_p1")
