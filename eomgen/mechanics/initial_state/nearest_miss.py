"""System, a place where ties are open -> how near they come to closing, wherever the coordinates go.

min |phi(q)|^2    over the coordinates that are not driven, by Levenberg and Marquardt from several places
"""

from __future__ import annotations

from collections.abc import Mapping
from functools import cached_property
from random import Random
from typing import Any

import numpy as np

from eomgen.mechanics.constraints.closure import closed, gaps_of, movable, norms_of, of_50_digits
from eomgen.mechanics.equations.system import System
from eomgen.records import dataclass
from eomgen.symbolic.expression.derivative import jacobian, symbols_of
from eomgen.symbolic.expression.graph import Node, Scalar
from eomgen.symbolic.numeric.evaluation import FLOAT, NoValue, evaluate
from eomgen.symbolic.numeric.newton import least_left
from eomgen.symbolic.numeric.tolerances import COMPUTED, OPEN_GAP, SAME_PLACE, SUMMED

TRIES = 12
REACH = 1.5  # how far from the place others are tried [rad, m]
FAILED = 1e6  # stands for a gap that has no value


@dataclass(frozen=True)
class Miss:
    """The place where the ties are open by least.

    Args:
        values: of the coordinates that stand in gaps.
        open: the largest |phi|; 0 where they close.
        ties: that stay open.
    """

    values: Mapping[str, float]
    open: float
    ties: tuple[str, ...]


def nearest_miss(system: System, state: Mapping[Node, Any]) -> Miss | None:
    """The place where the gaps are least, of those that close the nearest; None where nothing moves them."""
    gaps = gaps_of(system.ties)
    standing = set(symbols_of(gaps))
    free = [q for q in movable(system.ties) if q in standing]
    if not free:
        return None
    search = _Search(system, {node: float(x) for node, x in state.items()}, tuple(free))
    here = np.array([search.known[q] for q in free])
    rng = Random(1)
    starts = [here, *(here + np.array([rng.uniform(-REACH, REACH) for _ in free]) for _ in range(TRIES))]
    found = [search.least(start) for start in starts]
    best = min(found, key=lambda place: (round(search.size(place) / COMPUTED), float(np.linalg.norm(place - here))))
    values = search.at(best)[: len(gaps)]
    size = float(np.max(np.abs(values), initial=0.0))
    rows = [row for row in system.ties.rows if row.gap is not None and not row.identical]
    named = [row.tie for row, x in zip(rows, values, strict=False) if abs(x) > OPEN_GAP * size]
    places = {q.name: float(x) if abs(x) > SAME_PLACE else 0.0 for q, x in zip(free, best, strict=True)}
    shut = size <= COMPUTED and (size <= SUMMED or _closes(system, state, dict(zip(free, best, strict=True))))
    return Miss(places, 0.0, ()) if shut else Miss(places, size, tuple(dict.fromkeys(named)))


def _closes(system: System, state: Mapping[Node, Any], place: Mapping[Node, float]) -> bool:
    """Whether all ties close near a place, and not just nearly: with 50 digits."""
    there = {node: of_50_digits(float(x)) for node, x in {**state, **place}.items()}
    return closed(system.ties, there, movable(system.ties)) is not None


@dataclass(frozen=True)
class _Search:
    system: System
    known: dict[Node, float]
    free: tuple[Node, ...]

    @cached_property
    def gaps(self) -> tuple[Scalar, ...]:
        """phi, and e . e - 1 of each quaternion."""
        return (*gaps_of(self.system.ties), *norms_of(self.system.ties))

    @cached_property
    def slopes(self) -> tuple[Scalar, ...]:
        """The derivatives of the gaps, row by row."""
        return tuple(x for row in jacobian(self.gaps, self.free) for x in row)

    def at(self, place: np.ndarray) -> np.ndarray:
        """The gaps as numbers."""
        return self._numbers(self.gaps, place)

    def size(self, place: np.ndarray) -> float:
        return float(np.max(np.abs(self.at(place)), initial=0.0))

    def least(self, start: np.ndarray) -> np.ndarray:
        return least_left(self.at, start, self._slopes_at).x

    def _slopes_at(self, place: np.ndarray) -> np.ndarray:
        return self._numbers(self.slopes, place).reshape(len(self.gaps), -1)

    def _numbers(self, scalars: tuple[Scalar, ...], place: np.ndarray) -> np.ndarray:
        state = self.known | dict(zip(self.free, place.tolist(), strict=True))
        try:
            values = np.array(evaluate(scalars, state, FLOAT), dtype=float)
        except (NoValue, ZeroDivisionError, OverflowError):
            return np.full(len(scalars), FAILED)
        return np.asarray(np.nan_to_num(values, nan=FAILED, posinf=FAILED, neginf=-FAILED))
