"""Declared speeds -> those with start values of their own, and those that start by the rates of the coordinates."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any


def begun_speeds(speeds: Mapping[str, Any]) -> dict[str, frozenset[str]]:
    """{speed: the rates that go with it} of those that have a `start`, or share rates with one that has.

    Sharing reaches through others: where w1 holds x' and y', and w2 holds y' and z', a start of w2 decides for both.
    """
    groups: list[tuple[set[str], set[str]]] = []
    for name, part in speeds.items():
        rates = {x for x in _names(part) if x.endswith("'")}
        joined = [group for group in groups if group[1] & rates]
        groups = [group for group in groups if group not in joined]
        groups.append(({name}.union(*(g[0] for g in joined)), rates.union(*(g[1] for g in joined))))
    begun = [group for group in groups if any(_begins(speeds[name]) for name in group[0])]
    return {name: frozenset(rates) for names, rates in begun for name in names}


def _names(part: Any) -> frozenset[str]:
    return frozenset() if part is None or part.rate is None else frozenset(part.rate.names)


def _begins(part: Any) -> bool:
    return part is not None and part.start is not None
