"""An equation of small motions -> the model's equations, linearized about the same place: beside what it is wrong.

    E = E_0 + dE/dq (q - q_0) + dE/du u + dE/da a

Who linearizes before he makes another mistake has left out nothing of that mistake beyond the first order, either.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace

from eomgen.errors import DerivationError
from eomgen.judge.comparison import Comparison, linearized
from eomgen.judge.corruption import SHORTER, TERMS, Corruption
from eomgen.judge.diagnosis import PLAINEST, Explanation, Share
from eomgen.records import dataclass
from eomgen.symbolic.expression.derivative import depends_on_any, gradient
from eomgen.symbolic.expression.graph import Node, is_zero
from eomgen.symbolic.expression.node import ScalarRow
from eomgen.symbolic.expression.rational import Fraction

NAME = "the whole equation"
MOST_FREEDOMS = 4  # of a system whose equations are linearized with all that may be wrong in them
RANK = TERMS + 2 * SHORTER


@dataclass(frozen=True)
class InSmallMotions:
    """A comparison with the linearized equations.

    Args:
        whole: the comparison with the equations themselves.
        near: the same with the linearized ones.
    """

    whole: Comparison
    near: Comparison

    def explained(self, number: int) -> list[Explanation]:
        """That the equation is linearized, and beside it one mistake less than there are."""
        rows = tuple(x - y for x, y in zip(self.near.rows, self.whole.rows, strict=True))
        text = "sines, cosines and products of speeds are those of a small motion: the equation is linearized"
        share = Share(Corruption(NAME, "approximation", rows, RANK, open=False, text=text), Fraction(1))
        cost = PLAINEST + RANK
        if number == 1:
            alone = Explanation((share,), 0, cost)
            return [alone] if self.whole.proves(alone) else []
        found = self.near.explained(number - 1)
        return [Explanation((share, *each.shares), each.row, cost + each.cost, each.scale) for each in found]

    def difference(self, explanation: Explanation) -> str:
        """What is too much in the equation."""
        return self.whole.difference(explanation)


def small_motions(whole: Comparison) -> Iterator[InSmallMotions]:
    """The comparisons with linearized equations of an equation that is linear, where the model's are not."""
    symbols = whole.case.system.symbols
    moving = (*symbols.q, *symbols.u, *symbols.a)
    if whole.what != "motion" or whole.case.closing or len(whole.rows) > MOST_FREEDOMS or whole.is_long:
        return
    if not _is_linear((whole.scalar,), moving) or _is_linear(whole.rows, moving):
        return
    still = dict.fromkeys(moving, 0)
    places = [{**still, **place} for place in ({}, *whole.case.places_of_rest)]
    for place in [place for k, place in enumerate(places) if place not in places[:k]]:
        try:
            rows = linearized(whole.rows, place)
        except DerivationError:
            continue  # it has no value there
        if not any(map(is_zero, rows)):
            yield InSmallMotions(whole, replace(whole, rows=rows, near=place))


def _is_linear(rows: ScalarRow, moving: tuple[Node, ...]) -> bool:
    return not depends_on_any([slope for row in rows for slope in gradient(row, moving)], moving)
