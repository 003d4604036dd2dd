"""Rows of a sweep, its ranges and laws -> checks of the values set, and of the statements on all runs, in doubles.

    F(value) = u    u of the run's seed by SplitMix64 (random), one in each stratum (Latin hypercube), one in each of
                    2^k intervals (the first 2^k of a Sobol sequence)

F is the cumulative distribution function; ranges are counted out run after run.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Mapping, Sequence
from itertools import product
from typing import Any

from eomgen.proof.check import Check, checked, first_wrong
from eomgen.symbolic.numeric import tolerances

HOW = "floating point, every run"
MASK = 2**64 - 1
SHARES: Mapping[str, Callable[..., float]] = {  # of all that lie below a value
    "normal": lambda x, mean, deviation: math.erfc((mean - x) / (deviation * math.sqrt(2))) / 2,
    "uniform": lambda x, low, high: (x - low) / (high - low),
    "loguniform": lambda x, low, high: math.log(x / low) / math.log(high / low),
    "lognormal": lambda x, median, deviation: math.erfc(math.log(median / x) / (deviation * math.sqrt(2))) / 2,
    "triangular": lambda x, low, mode, high: _triangle(x, low, mode, high),
}
Law = tuple[str, str, tuple[float, ...]]  # of a name: which, its arguments


def _triangle(x: float, low: float, mode: float, high: float) -> float:
    if x < mode:
        return (x - low) ** 2 / ((high - low) * (mode - low))
    return 1 - (high - x) ** 2 / ((high - low) * (high - mode))


def drawn_otherwise(
    over: Mapping[str, Sequence[float]], laws: Sequence[Law], draws: int, design: str, rows: Sequence[Sequence[Any]]
) -> Check:
    """Check that the values set in each run are of their ranges and laws.

    Args:
        draws: at each point of the ranges.
        rows: (number, seed, what is set) of each run that is done.
    """
    wrong = (*_ranges(over, draws, rows), *_draws(len(over), laws, draws, design, rows))
    return checked("values set in each run are of their ranges and laws", first_wrong(wrong), HOW)


def _ranges(over: Mapping[str, Sequence[float]], draws: int, rows: Sequence[Sequence[Any]]) -> Iterator[str]:
    points = list(product(*over.values()))
    for number, _, *values in rows:
        due = points[number // draws]
        same = all(abs(x - y) <= tolerances.COMPUTED * abs(y) for x, y in zip(values, due, strict=False))
        yield "" if same else f"run {number} is not at {due}"


def _draws(first: int, laws: Sequence[Law], draws: int, design: str, rows: Sequence[Sequence[Any]]) -> Iterator[str]:
    blocks: dict[int, list[Sequence[Any]]] = {}
    for row in rows:
        blocks.setdefault(row[0] // draws, []).append(row)
    for block in blocks.values():
        for k, (name, law, arguments) in enumerate(laws):
            shares = [SHARES[law](row[2 + first + k], *arguments) for row in block]
            chances = [_chance(row[1], k + 1) for row in block]
            if design == "random":
                yield from (
                    f"'{name}' of run {row[0]} is not by its seed" * (abs(u - v) > tolerances.CARRIED)
                    for row, u, v in zip(block, shares, chances, strict=True)
                )
            elif len(block) == draws:
                many = draws if design == "lhs" else 2 ** (draws.bit_length() - 1)
                strata = sorted(math.floor(u * many) for u in shares[:many])
                yield "" if strata == list(range(many)) else f"'{name}' is not spread as '{design}' says"


def _chance(seed: int, k: int) -> float:
    """The k-th number between 0 and 1 of SplitMix64 begun at a seed, by whole numbers."""
    z = (seed + k * 0x9E3779B97F4A7C15) & MASK
    z = ((z ^ (z >> 30)) * 0xBF58476D1CE4E5B9) & MASK
    z = ((z ^ (z >> 27)) * 0x94D049BB133111EB) & MASK
    return ((z ^ (z >> 31)) // 2**11 + 0.5) / 2**53


def reported_of_all(
    columns: Mapping[str, Sequence[float | None]],
    summary: Mapping[str, Sequence[float | None]],
    remarks: Sequence[str],
    critical: str,
    fine: float,
    requested: Sequence[str],
) -> Check:
    """Check of count, least, mean and largest value of each column, and of the columns reported the same in all runs.

    Args:
        columns: values set and requested, by name, one a run.
        summary: reported count, least, mean and largest value of each.
        critical: name of the column that must change its sign; "" for none.
        fine: share of the largest value that counts as no change.
        requested: columns for which it is reported where they are the same in all runs.
    """
    wrong = (
        *(_summed(name, columns[name], reported) for name, reported in summary.items()),
        *(_remarked(name, columns[name], remarks, name == critical, fine) for name in requested),
    )
    return checked("statements on all runs are those of their rows", first_wrong(wrong), HOW)


def _summed(name: str, column: Sequence[float | None], reported: Sequence[float | None]) -> str:
    values = [x for x in column if x is not None]
    due = [len(values), *((min(values), math.fsum(values) / len(values), max(values)) if values else (None,) * 3)]
    pairs = zip(reported, due, strict=True)
    same = all(x == y if x is None or y is None else abs(x - y) <= tolerances.COMPUTED * (1 + abs(y)) for x, y in pairs)
    return "" if same else f"'{name}': {list(reported)} for {due}"


def _remarked(name: str, column: Sequence[float | None], remarks: Sequence[str], critical: bool, fine: float) -> str:
    """Message if "is ... in all runs" or "goes from" is reported of the wrong column; ""."""
    values = [x for x in column if x is not None]
    reported = any(f"'{name}' is " in x and " in all runs" in x for x in remarks)
    if len(values) < 2:
        return f"'{name}' has no value to be the same" if reported else ""
    same = max(values) - min(values) <= fine * max(map(abs, values))
    wanted = same and not (critical and min(values) < 0 < max(values))
    return "" if reported == wanted else f"'{name}' goes from {min(values):.9g} to {max(values):.9g}"
