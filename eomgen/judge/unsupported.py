"""An equation of motion of somebody -> the balance of cut bodies that it is, but for reactions that he left out.

    D = sigma (sum of items without the reactions),   sigma a function of the configuration

Newton's or Euler's equation of a body, written down as if what holds or supports it were not there.
"""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import suppress
from functools import cached_property

import numpy as np

from eomgen.errors import EomgenError
from eomgen.judge.acting import symbols_of_reactions, what_acts
from eomgen.judge.balances import KNOWN, LARGER
from eomgen.judge.case import Case
from eomgen.judge.comparison import excess
from eomgen.judge.corruption import SHARED, Corruption
from eomgen.judge.diagnosis import PLAINEST, Explanation, Search, Share, samples_of
from eomgen.judge.free_bodies import CutBalance, FreeBodies
from eomgen.judge.wrong_items import Item, WrongItems
from eomgen.mechanics.balance.balance import balance_of
from eomgen.records import dataclass
from eomgen.symbolic.expression.derivative import depends_on
from eomgen.symbolic.expression.graph import Node, Scalar
from eomgen.symbolic.expression.rational import Fraction
from eomgen.symbolic.numeric.tolerances import CARRIED, SAME_EIGENVALUE

MOST_LEFT_OUT = 2  # reactions in one balance


@dataclass(frozen=True)
class Unsupported:
    """The balances of which an equation of somebody may be one, without the reactions in them.

    Args:
        case: the model; nothing closes in it.
        scalar: the author's left side minus his right side.
    """

    case: Case
    scalar: Scalar

    def explained(self, number: int) -> list[Explanation]:
        """That reactions are left out, and beside it one mistake less than there are."""
        if number > 2 or self._free is None:
            return []
        with suppress(EomgenError):
            found = sorted(self._found(number), key=lambda each: each.cost)
            return next(([each] for each in found if self._proves(each)), [])
        return []

    def difference(self, explanation: Explanation) -> str:
        """What is missing."""
        return excess(self.case, sum((x.corruption.rows[0] for x in explanation.shares if x.factor == 0), start=0))

    def _proves(self, explanation: Explanation) -> bool:
        pi = self.case.system.scope.graph.pi
        total = self._wholes[explanation.shares[0].corruption]
        total = total + sum((x.added(pi)[0] for x in explanation.shares if x.corruption not in self._wholes), start=0)
        return bool(self.case.follows(self.scalar, (total,)).holds)

    @cached_property
    def _wholes(self) -> dict[Corruption, Scalar]:
        """Of what is left out the sum of the other items."""
        return {}

    @cached_property
    def _free(self) -> FreeBodies | None:
        samples = samples_of(self.case.system, (self.scalar,)) if self.case.quantities.is_plane else None
        if samples is None:
            return None
        symbols = self._symbols
        random = np.random.default_rng(7)
        size = next(iter(samples.values.values())).shape
        samples = samples.with_values({x: random.uniform(0.4, 2, size) for x in symbols})
        return FreeBodies(self.case.system, what_acts(self.case.system), (), samples)

    @cached_property
    def _symbols(self) -> tuple[Node, ...]:
        return symbols_of_reactions(balance_of(self.case.system))

    def _found(self, number: int) -> Iterator[Explanation]:
        free = self._free
        assert free is not None
        (D,) = free.samples.of((self.scalar,))
        for cut in free.cuts(self._symbols):
            seen = [(each, pushes) for each in free.acting if (pushes := each.on(cut.parts))]
            values = [sum(map(cut.value, pushes), start=0) for _, pushes in seen]
            sizes = np.abs(free.samples.flat(values)).max(axis=1, initial=0)
            there = sizes > CARRIED * sizes.max(initial=0)
            items = [Item(*x, *y, False) for x, y in zip(seen, zip(values, there, strict=True), strict=True) if y[1]]
            gone = [item for item in items if item.acting.kind == "reaction"]
            left = [item for item in items if item.acting.kind != "reaction"]
            if 0 < len(gone) <= MOST_LEFT_OUT and any(item.acting.kind == "inertia" for item in left):
                yield from self._of_cut(number, cut, D, gone, left)

    def _of_cut(
        self, number: int, cut: CutBalance, D: np.ndarray, gone: list[Item], left: list[Item]
    ) -> Iterator[Explanation]:
        free = self._free
        assert free is not None
        whole = sum((item.value for item in left), start=0)
        missing = [self._missing(cut, item) for item in gone]
        self._wholes.update({share.corruption: whole for share in missing})
        cost = PLAINEST + SHARED + KNOWN * (len(gone) - 1) + LARGER * (len(cut.parts) - 1)
        wrong = WrongItems(self.case, free, cut, free.samples)
        known = [each for item in left for each in wrong.changes(item)] if number == 2 else []
        numbers = free.samples.of([whole, *(each.rows[0] for each in known)])
        if number == 1:
            if Search(D, numbers[0], numbers[:1], [missing[0].corruption], 0).misfit < SAME_EIGENVALUE:
                yield Explanation(tuple(missing), 0, cost)
            return
        for each in Search(D, numbers[0], numbers[1:], known, 0).explanations(1):
            yield Explanation((*missing, *each.shares), 0, cost + each.cost, each.scale)

    def _missing(self, cut: CutBalance, item: Item) -> Share:
        name = f"in {cut.name} {item.acting.name}"
        body = self.case.system.motion.links[item.pushes[0].body].name
        return Share(Corruption(name, "factor", (item.value,), SHARED, body, item.acting.force), Fraction(0))


def unsupported(case: Case, scalar: Scalar) -> Iterator[Unsupported]:
    """Of an equation with accelerations, where nothing closes."""
    if not case.closing and case.system.free is None and depends_on(scalar, case.system.symbols.a):
        yield Unsupported(case, scalar)
