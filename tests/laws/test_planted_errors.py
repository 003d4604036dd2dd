"""Errors planted one at a time are seen by the product: six of benchmarks/planted_errors.toml, of six rooms.

Twenty of twenty rooms by

    EOMGEN_ALL_MODELS=1 python -m pytest -q tests/laws/test_planted_errors.py
"""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

import pytest
from slow_run import ALL

pytestmark = pytest.mark.slow

COUNT = 20 if ALL else 6
ROOT = Path(__file__).parents[2]
COMMAND = """
import sys
sys.path[:0] = ["benchmarks", "."]
from planted_errors import outcome, sample, seen_by_product, warm
warm()
for planted in sample(int(sys.argv[1])):  # a refusal may be that of the right product too
    contradicted = outcome(planted, planted.run, planted.model).code == 3
    print("product" if contradicted else seen_by_product(planted)[0] or planted.name)
"""


def test_each_old_text_stands_where_the_list_says():
    """A patch that no longer fits would plant nothing: (file, old text) is unique, and so is the name."""
    sys.path.insert(0, str(ROOT / "benchmarks"))
    from planted_errors import entries

    assert [planted.gone for planted in entries() if planted.gone] == []
    assert len({planted.name for planted in entries()}) == len(entries())


def test_the_product_sees_a_sample_of_planted_errors():
    """The verb that uses the wrong law ends in exit 3, or refuses."""
    done = subprocess.run(
        [sys.executable, "-c", COMMAND, str(COUNT)], cwd=ROOT, capture_output=True, text=True, timeout=900
    )
    assert done.stdout.splitlines() == ["product"] * COUNT, done.stdout + done.stderr
