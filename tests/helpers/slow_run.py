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


def sampled(every: int) -> pytest.MarkDecorator:
    """The mark of a law that the usual run asks of each `every`-th of its cases; the slow run asks it of all."""
    return pytest.mark.sampled(every)


def left_out(items: Iterable[pytest.Item]) -> list[pytest.Item]:
    """The cases of sampled laws that the usual run leaves out."""
    cases: dict[str, list[pytest.Item]] = {}
    for item in items:
        if item.get_closest_marker("sampled") is not None:
            cases.setdefault(item.nodeid.partition("[")[0], []).append(item)
    every = {law: found[0].get_closest_marker("sampled").args[0] for law, found in cases.items()}  # type: ignore[union-attr]
    return [] if ALL else [item for law, found in cases.items() for k, item in enumerate(found) if k % every[law]]


def usual(items: Sequence[Item], every: int, first: int = 0) -> Sequence[Item]:
    """Each `every`-th item from the `first` on; in the slow run all of them."""
    return items if ALL else items[first::every]


def beside(*items: Item) -> tuple[Item, ...]:
    """These in the slow run alone: dear ones of a law whose other cases every run asks."""
    return items if ALL else ()


def usual_models(models: Iterable[Path], times: int = 2) -> tuple[Path, ...]:
    """Of these models those that hold each of their features `times` times; in the slow run all of them."""
    return tuple(models) if ALL else covering(tuple(models), times)
