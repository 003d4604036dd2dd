"""An equation of somebody -> the one place of it that is wrong: where that is changed, it is right."""

from __future__ import annotations

import math
from collections import Counter
from collections.abc import Sequence
from contextlib import suppress
from functools import cached_property

import numpy as np

from eomgen.errors import EomgenError
from eomgen.judge.authored import Authored
from eomgen.judge.comparison import excess
from eomgen.judge.contributions import FEW, Contribution
from eomgen.judge.corruption import Corruption
from eomgen.judge.decision import is_zero_everywhere
from eomgen.judge.diagnosis import PLAINEST, Explanation, Share
from eomgen.judge.edits import power, wrong_power
from eomgen.judge.products import Amended
from eomgen.judge.right import truth_of
from eomgen.judge.terms import powers_of, short_text, term_text, terms_of
from eomgen.records import dataclass
from eomgen.symbolic.expression.derivative import substituted, symbols_of
from eomgen.symbolic.expression.functions import over
from eomgen.symbolic.expression.graph import Node, Scalar, is_zero
from eomgen.symbolic.expression.rational import Fraction
from eomgen.symbolic.expression.traversal import order

MOST_TRIED = 6  # changes that are proven before it is given up
SHORT = 60  # characters of a place that is told
MOST_PAIRS = 2000  # of terms that are compared
ENERGIES = {"kinetic_energy": "T", "potential_energy": "V"}


@dataclass(frozen=True)
class Mends:
    """An equation of somebody that one change would make right."""

    author: Authored

    def explained(self, number: int) -> list[Explanation]:
        """The simplest change that makes it right."""
        with suppress(EomgenError, np.linalg.LinAlgError):
            found = [] if number > 1 else list(self.author.changes())
            found.sort(key=lambda each: (each[1].cost, len(self._text(each[0])) + len(self._text(each[1].to))))
            for node, amended in found[:MOST_TRIED]:
                explanation = self._explanation(node, amended)
                if explanation is not None:
                    return [explanation]
        return []

    def difference(self, explanation: Explanation) -> str:
        """What is too much on the left."""
        return excess(self.author.case, self._by[explanation.shares[0]])

    @cached_property
    def _by(self) -> dict[Share, Scalar]:
        """By what the sides differ, of what is told."""
        return {}

    def _explanation(self, node: Node, amended: Amended) -> Explanation | None:
        """The change, where it makes the equation right, exactly."""
        difference, case = self.author.difference, self.author.case
        (mended,) = substituted((difference,), {node: amended.to})
        right, wrong = substituted((mended, difference), self.author.meant)
        still = self.author.is_still
        found = is_zero_everywhere(case.system, right) if still else truth_of(case, right, self.author.kind)
        if not found.holds:
            return None
        share = self._share(node, amended, mended)
        self._by[share] = wrong - right
        return Explanation((share,), 0, PLAINEST + amended.cost)

    # -- what is told ----------------------------------------------------------------------------

    def _share(self, node: Node, amended: Amended, mended: Scalar) -> Share:
        product, term = self._around(node)
        there, should = (self.author.plain(x) for x in (product, substituted((product,), {node: amended.to})[0]))
        term = product if product is not node else term
        around = self.author.plain(substituted((term,), {node: amended.to})[0]) if is_zero(should) else should
        owners = self._owners(mended, around)
        named = " and ".join(part.name for part in owners)
        body, force = (owners[0].body, owners[0].force) if len(owners) == 1 else ("", "")
        (ratio,) = (0,) if is_zero(should) else self.author.case.edits.written((over(there, should),))
        if type(ratio) is not Node and ratio not in (0, 1):
            rates = [x for x in symbols_of((there,)) if x.name.endswith("'")]
            name, kind = named or f"the term {self._text(product)}", "coriolis" if len(rates) == 2 else "factor"
            return Share(Corruption(name, kind, (should,), amended.cost, body, force), Fraction(ratio))
        where = "" if term is node or len(self._text(term)) > SHORT else f"the term {self._text(term)}"
        told = self._told(self.author.plain(node), self.author.plain(amended.to), there)
        place = ", ".join(filter(None, (named, where)))
        text = f"in {place}{',' if named and where else ''} {told}" if place else told
        row = (there if is_zero(should) else should,)
        corruption = Corruption(place or told, amended.kind, row, amended.cost, body, force, open=False, text=text)
        return Share(corruption, Fraction(1))

    def _around(self, node: Node) -> tuple[Node, Node]:
        """The product, and the term that is told, in which a node stands."""
        product = term = node
        in_sum = False
        for x in order((self.author.difference,)):
            if x is not node and x is not self.author.difference and node in order((x,)):
                in_sum = in_sum or x.op in ("add", "sub")
                product = product if in_sum else x
                if x.op not in ("add", "sub") and len(self._text(x)) <= SHORT:
                    term = x
        return product, product if term is node else term

    def _text(self, x: Scalar) -> str:
        return short_text(self.author.plain(x), self.author.case.system.scope.positive)

    def _told(self, there: Scalar, should: Scalar, around: Scalar) -> str:
        """What is wrong where one thing stands and another is meant, in a product."""
        if is_zero(should):
            return f"{term_text(there)} does not belong there"
        (ratio,), held = self.author.case.edits.written((over(should, there),)), powers_of(around)
        powers = powers_of(ratio)
        number = over(ratio, math.prod((power(x, k) for x, k in powers.items()), start=1))
        if number in (1, -1):
            (x, k), *rest = sorted(powers.items(), key=lambda each: -each[1])
            if not rest:
                told = wrong_power(term_text(x), held.get(x, Fraction(0)) + k, held.get(x, Fraction(0)))
                return told if number == 1 else f"{told}, and the sign is wrong"
            ((y, n), *more) = rest
            if number == 1 and not more and n == -k and held.get(y, 0) >= k:
                there, should = power(y, k), power(x, k)
        return f"{term_text(there)} stands where {term_text(should)} is meant"

    def _owners(self, mended: Scalar, around: Scalar) -> Sequence[Contribution]:
        """The contributions in which the change is made: those whose terms, or else names, are the ones meant."""
        case, names = self.author.case, {call.name for call in self.author.written.calls}
        what = next((letter for name, letter in ENERGIES.items() if {name} == names), "motion")
        found: dict[str, Contribution] = {}
        if what != "motion" or (self.author.kind == "motion" and not names):
            called = {x: 0 for x in self.author.meant if x.name.endswith(")")}
            sides = substituted((mended, self.author.difference), {**self.author.meant, **called})
            found = self._of_terms(what, *sides)
        if 0 < len(found) <= FEW:
            return tuple(found.values())
        return case.parts.holding(around, what.replace("motion", ""))

    def _of_terms(self, what: str, right: Scalar, wrong: Scalar) -> dict[str, Contribution]:
        """Those of which a term is what the change makes, where most of the equation is made of such terms."""
        samples, positive = self.author.samples, self.author.case.system.scope.positive
        mine, before = terms_of(right, positive), terms_of(wrong, positive)
        known = self.author.case.corruptions(what)
        theirs = [(part, x) for part in known.whole for row in known.rows(part) for x in terms_of(row, positive)]
        if samples is None or not mine or not theirs or len(mine) * len(theirs) > MOST_PAIRS:
            return {}
        values = samples.flat([*mine, *(x for _, x in theirs)])
        with np.errstate(all="ignore"):
            ratios = values[: len(mine), None] / values[None, len(mine) :]
        keys = [[tuple(f"{x:.6g}" for x in ratio) for ratio in row] for row in ratios]
        ((common, often),) = Counter(key for row in keys for key in row).most_common(1)
        matched = {
            term: [part for (part, _), key in zip(theirs, row, strict=True) if key == common]
            for term, row in zip(mine, keys, strict=True)
        }
        if 2 * often <= len(mine) or not any(matched[term] for term in mine if term in before):
            return {}  # the equation is not made of such terms, or all of them differ
        return {part.name: part for term in mine if term not in before for part in matched[term]}
