"""Which items of a long sweep every run asks, and which the slow run alone.

EOMGEN_ALL_MODELS=1 python -m pytest -q -n 2        # all items of all sweeps: before an issue is closed
"""

from __future__ import annotations

import os
from collections.abc import Iterable, Sequence
from pathlib import Path
from typing import TypeVar

import pytest
from covering_models import covering

Item = TypeVar("Item")
ALL = bool(os.environ.get("EOMGEN_ALL_MODELS"))


in_slow_run = pytest.mark.skipif(not ALL, reason="of the slow run")
"""The mark of one dear example of a law that others hold in every run."""


def usual(items: Sequence[Item], every: int, first: int = 0) -> Sequence[Item]:
    """Each `every`-th item from the `first` on; in the slow run all of them."""
    return items if ALL else items[first::every]


def beside(*items: Item) -> tuple[Item, ...]:
    """These in the slow run alone: dear ones of a law whose other cases every run asks."""
    return items if ALL else ()


def usual_models(models: Iterable[Path], times: int = 2) -> tuple[Path, ...]:
    """Of these models those that hold each of their features `times` times; in the slow run all of them."""
    return tuple(models) if ALL else covering(tuple(models), times)
