"""What the usual run asks: models that hold every feature, cases that are all told when they fail."""

from __future__ import annotations

from collections import Counter
from pathlib import Path

import pytest
from covering_models import covering, features
from each import each

MODELS = tuple(sorted((Path(__file__).parents[1] / "models").rglob("*.toml")))


@pytest.mark.parametrize("times", [1, 2])
def test_the_covering_models_hold_every_feature_so_often(times):
    """Each feature `times` times, or as often as there are models with it; with half of the models or so."""
    found = covering(MODELS, times)
    everywhere = Counter(feature for path in MODELS for feature in features(path))
    held = Counter(feature for path in found for feature in features(path))
    assert all(held[f] >= min(n, times) for f, n in everywhere.items())
    assert len(found) <= 0.6 * len(MODELS) and set(found) <= set(MODELS)
    for path in found:
        assert any(held[f] - 1 < min(everywhere[f], times) for f in features(path)), f"{path.stem} adds nothing"


def test_each_failing_case_is_told_under_its_name():
    """No case stops the ones behind it."""
    requested = []

    @each("a, b", [(1, 2), (3, 4), (5, 6)])
    def sums(a, b):
        requested.append(a)
        assert a + b == 7

    with pytest.raises(ExceptionGroup, match="2 of 3 cases") as caught:
        sums()
    assert requested == [1, 3, 5]
    assert [failure.__notes__ for failure in caught.value.exceptions] == [["of a=1, b=2"], ["of a=5, b=6"]]
