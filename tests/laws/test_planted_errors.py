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

COUNT = 20 if ALL else 4
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


def test_a_run_of_some_errors_leaves_the_rows_of_the_others():
    """--only --write replaces the rows of what ran, adds new ones at the end, counts anew and keeps the words."""
    sys.path.insert(0, str(ROOT / "benchmarks"))
    from planted_errors import NEW_PAGE, entries, listed, page_with

    first, second, third = entries()[:3]
    page = page_with(NEW_PAGE, [(first, "product", ""), (second, "product", "")]).replace(
        "\n\n| room | error", "\n\nWords.\n\n| room | error"
    )
    again = page_with(page, [(second, "tests", ""), (third, "product", "")])
    assert [seen for _, _, seen in listed(again).values()] == ["product", "tests", "product"]
    assert list(listed(again)) == [first.name, second.name, third.name]
    assert "| all | 3 | 2 | 1 |" in again and "\n\nWords.\n\n" in again and page_with(again, []) == again
    with pytest.raises(SystemExit, match="no table"):
        page_with("# Another page\n", [(first, "product", "")])


def test_every_row_of_the_page_is_of_an_error_of_the_list():
    """A renamed or removed entry leaves no row behind."""
    sys.path.insert(0, str(ROOT / "benchmarks"))
    from planted_errors import entries, listed

    page = (ROOT / "docs" / "planted_errors.md").read_text(encoding="utf-8")
    assert listed(page).keys() <= {planted.name for planted in entries()}
