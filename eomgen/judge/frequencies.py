"""A frequency that somebody gives for a system of several freedoms -> what would have to be wrong for it to be one.

    det(K + y C_K - omega^2 (M + y C_M)) = 0

M and K are the slopes of the equations of motion at the place of rest, C_M and C_K those of what a mistake adds, once
or as often as people write it; at a few sets of values in doubles first, and what holds there is proven exactly.
"""

from __future__ import annotations

from contextlib import suppress
from functools import cached_property
from itertools import islice

import numpy as np

from eomgen.errors import DerivationError
from eomgen.judge.case import Case
from eomgen.judge.comparison import excess
from eomgen.judge.corruption import TERMS, Corruption
from eomgen.judge.decision import is_zero_everywhere
from eomgen.judge.diagnosis import MOST_NEAR, USUAL, Explanation, Share, cost_of, samples_of
from eomgen.records import dataclass
from eomgen.symbolic.expression.derivative import gradient, substituted
from eomgen.symbolic.expression.graph import Node, Scalar, is_zero
from eomgen.symbolic.expression.node import ScalarRow
from eomgen.symbolic.expression.rational import Fraction
from eomgen.symbolic.numeric.tolerances import CARRIED
from eomgen.symbolic.solve.cramer import determinant

MOST_FREEDOMS = 4
STATES = 6  # sets of values at which it is tried
BY_CHANCE = 3.0  # how much less it is believed: many things make a determinant vanish
OTHER = 1.37  # times the frequency: what vanishes there as well says nothing
FACTORS = (Fraction(0), Fraction(-1), *(x for some, _ in USUAL for x in some if x != 1))


@dataclass(frozen=True)
class GivenFrequency:
    """A frequency of somebody.

    Args:
        case: the model.
        omega: what he gives.
        place: where the motion is small; {} where that does not matter.
    """

    case: Case
    omega: Scalar
    place: dict[Node, Scalar]

    def explained(self, number: int) -> list[Explanation]:
        """Single mistakes with which it is a frequency, the most believable first, each proven."""
        found = sorted(self._fitting, key=lambda each: each.cost) if number == 1 else []
        return list(islice(filter(self._proves, found), MOST_NEAR))

    def difference(self, explanation: Explanation) -> str:
        """What of the determinant does not vanish."""
        return excess(self.case, determinant(self._matrix(self._slopes(self.case.rows))))

    # -- slopes ----------------------------------------------------------------------------------

    def _slopes(self, rows: ScalarRow) -> tuple[ScalarRow, ScalarRow]:
        """M and K of rows, flat."""
        symbols = self.case.system.symbols
        named = {q.name: q for q in symbols.q}
        q = tuple(named[u.name.removesuffix("'")] for u in symbols.u)
        still = {**dict.fromkeys((*symbols.u, *symbols.a), 0), **self.place}
        both = [x for along in (symbols.a, q) for row in rows for x in gradient(row, along)]
        flat = substituted(tuple(both), still)
        half = len(flat) // 2
        return flat[:half], flat[half:]

    def _matrix(self, slopes: tuple[ScalarRow, ScalarRow]) -> list[ScalarRow]:
        """K - omega^2 M"""
        n, square = len(self.case.rows), self.omega * self.omega
        flat = [k - square * m for m, k in zip(*slopes, strict=True)]
        return [tuple(flat[i : i + n]) for i in range(0, n * n, n)]

    @cached_property
    def _known(self) -> list[tuple[Corruption, tuple[ScalarRow, ScalarRow]]]:
        """What may be wrong, with its slopes."""
        found = []
        for each in (x for x in self.case.corruptions("motion").all if x.rank < TERMS):
            with suppress(DerivationError):  # it has no value there
                slopes = self._slopes(each.rows)
                if not all(is_zero(x) for row in slopes for x in row):
                    found.append((each, slopes))
        return found

    # -- the search ------------------------------------------------------------------------------

    @cached_property
    def _fitting(self) -> list[Explanation]:
        """Those that make the determinant vanish in numbers."""
        n, own = len(self.case.rows), self._slopes(self.case.rows)
        flat = [self.omega, *(x for M, K in (own, *(slopes for _, slopes in self._known)) for x in (*M, *K))]
        samples = samples_of(self.case.system, flat, places=STATES)
        if samples is None:
            return []
        values = samples.of(flat)[:, :, 0]  # nothing of it moves
        square = values[0] ** 2
        every = np.moveaxis(values[1:].reshape(-1, 2, n, n, values.shape[1]), 4, 2)  # of M and K, state by state

        def size(at: np.ndarray, y: float, k: int) -> np.ndarray:
            M, K = every[0] + y * every[k + 1] if k >= 0 else every[0]
            A = K - at[:, None, None] * M
            scale = np.prod(np.linalg.norm(np.abs(K) + at[:, None, None] * np.abs(M), axis=2), axis=1)
            found: np.ndarray = np.abs(np.linalg.det(A)) / scale
            return found

        found = []
        for k, (corruption, _) in enumerate(self._known):
            for x in FACTORS if corruption.open else (Fraction(1),):
                y = float(x - 1) if corruption.open else 1.0
                with np.errstate(all="ignore"):
                    if np.all(size(square, y, k) < CARRIED) and np.all(size(OTHER * square, y, k) > CARRIED):
                        share = Share(corruption, x)
                        found.append(Explanation((share,), 0, cost_of(share) + BY_CHANCE))
        return found

    def _proves(self, explanation: Explanation) -> bool:
        (share,) = explanation.shares
        rows = tuple(x + y for x, y in zip(self.case.rows, share.added(self.case.system.scope.graph.pi), strict=True))
        return bool(is_zero_everywhere(self.case.system, determinant(self._matrix(self._slopes(rows)))).holds)
