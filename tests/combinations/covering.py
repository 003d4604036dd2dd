"""Rows of levels in which every possible pair of levels stands at least once: greedy, by a seed."""

from __future__ import annotations

from collections.abc import Iterator
from random import Random

from features import FACTORS, fits, forbidden, pairs_of, possible_pairs


def rows(seed: int, tries: int = 4) -> Iterator[dict[str, str]]:
    """Rows of a covering array, as many as it takes; the same for the same seed."""
    rng = Random(seed)
    order = sorted(possible_pairs())
    rng.shuffle(order)
    left = set(order)
    while left:
        order = [pair for pair in order if pair in left]
        found: list[dict[str, str]] = []
        for _ in range(50):
            found += [row for pair in order[:tries] if (row := _row(rng, dict(pair), left)) is not None]
            if found:
                break
        else:
            raise ValueError(f"no row holds {order[:tries]}")
        best = max(found, key=lambda row: len(pairs_of(row) & left))
        left -= pairs_of(best)
        yield best


def rows_with(level: str, seed: int) -> Iterator[dict[str, str]]:
    """Rows that hold a level, without end; the same for the same seed."""
    rng, pairs = Random(f"{level}{seed}"), set(possible_pairs())
    own = sorted(pair for pair in pairs if level in (x for _, x in pair))
    while True:
        if (row := _row(rng, dict(rng.choice(own)), pairs)) is not None:
            yield row


def _row(rng: Random, row: dict[str, str], left: set) -> dict[str, str] | None:
    """A row that holds a pair that is not covered yet; of each other factor the level with most new pairs."""
    others = [f for f in FACTORS if f not in row]
    rng.shuffle(others)
    for f in others:
        levels = [
            x for x in FACTORS[f] if fits(row | {f: x}) and all(forbidden((f, x), item) is None for item in row.items())
        ]
        if not levels:
            return None
        rng.shuffle(levels)
        row[f] = max(levels, key=lambda x: sum(_pair((f, x), item) in left for item in row.items()))
    return {f: row[f] for f in FACTORS}


_ORDER = {f: k for k, f in enumerate(FACTORS)}


def _pair(a: tuple[str, str], b: tuple[str, str]) -> tuple:
    return (a, b) if _ORDER[a[0]] < _ORDER[b[0]] else (b, a)
