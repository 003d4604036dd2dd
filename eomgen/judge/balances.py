"""An answer of somebody -> the balance of cut bodies in which one item is wrong, all that he solved for being right.

    sum of items = 0;   the answer put in, R = sum of items != 0:   R + sum y_j C_j = 0

An item is a component of a reaction, a load, a weight, what inertia does. It is forgotten, turned, doubled; another
component of it is taken, or its full size; its lever arm is another one; it is none of the cut bodies at all.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from contextlib import suppress
from dataclasses import field, replace
from functools import cached_property
from itertools import chain, product

import numpy as np

from eomgen.errors import EomgenError
from eomgen.judge.acting import symbols_of_reactions, what_acts
from eomgen.judge.authored import Authored
from eomgen.judge.case import Case
from eomgen.judge.comparison import EXTRA, remainder
from eomgen.judge.corruption import SHARED, Corruption
from eomgen.judge.cut_beams import cut_beam
from eomgen.judge.decision import is_zero_everywhere
from eomgen.judge.diagnosis import FAR_FETCHED, USUAL, WHOLE, Explanation, Samples, Search, Share, explained
from eomgen.judge.free_bodies import CutBalance, FreeBodies
from eomgen.judge.kinds import FUNCTION_KINDS
from eomgen.judge.reading import MULTIPLIER, HandEquation
from eomgen.judge.terms import short_text, term_text, terms_of
from eomgen.judge.wrong_items import DISTANT, FULL, Item, WrongItems
from eomgen.mechanics.instant.outputs import Quantities
from eomgen.mechanics.reactions.reactions import Reactions
from eomgen.mechanics.statics.section_forces import KINDS
from eomgen.records import dataclass
from eomgen.symbolic.expression.derivative import depends_on, derivative, substituted
from eomgen.symbolic.expression.expressions import Call
from eomgen.symbolic.expression.functions import over
from eomgen.symbolic.expression.graph import Node, Scalar, is_zero
from eomgen.symbolic.numeric.tolerances import CARRIED

KNOWN = 1.2  # how much less a balance is believed for each reaction in it that has to be known
OBLIQUE = 0.6  # the same, along or across a member of a truss
SISTER = 1.2  # the same, where a couple is asked, and it is the force there
LARGER = 0.15  # the same, for each body beside the first; for the whole and parts of trusses once
FINEST = 2.5  # the same, of a balance whose items are looked at place by place
TURNED = 0.01  # how much less something else is believed of an item than that it was forgotten
MOST_TERMS = 8  # of an equation, each of which may be too many
SHORT = 40  # characters of a factor that is told


def asks_reactions(written: HandEquation) -> bool:
    """Whether reactions stand in an equation."""
    return any(FUNCTION_KINDS.get(call.name) == "reaction" for call in written.calls)


@dataclass(frozen=True)
class InBalance:
    """In what a change is made: the sum of all items, the item, whether that is asked, how many others there are."""

    left: Scalar
    value: Scalar
    is_asked: bool
    others: int


@dataclass(frozen=True)
class Balances:
    """The balances in which an answer may stand, or of which an equation of somebody is one.

    Args:
        case: the model.
        written: the equation.
        finely: items are looked at place by place, as formulas.
        place: coordinates, speeds, accelerations at the instant of which it speaks; {} of all states.
    """

    case: Case
    written: HandEquation
    finely: bool = False
    place: Mapping[Node, Scalar] = field(default_factory=dict)

    def explained(self, number: int) -> list[Explanation]:
        """The explanations by so many mistakes in one balance; of places of items by one."""
        if self.finely and number > 1:
            return []
        with suppress(EomgenError):
            found = explained(self._searches, self.proves, number, self._dearer)
            return [replace(x, shares=tuple(map(self._told, x.shares))) for x in found]
        return []

    def _told(self, share: Share) -> Share:
        """A share with the factor by which the true item differs from what stands there, where that is short."""
        corruption, (row,) = share.corruption, share.corruption.rows
        value = self._wholes[corruption].value
        if not corruption.text.endswith((FULL, DISTANT)):
            return share
        positive = self.case.system.scope.positive
        ratio = short_text(over(value, value + row), positive)
        if not ratio or len(ratio) > SHORT:
            return share
        told = replace(corruption, text=f"{corruption.text}: the factor {ratio} is missing")
        self._wholes[told] = self._wholes[corruption]
        return replace(share, corruption=told)

    def _dearer(self, explanation: Explanation) -> float:
        """Infinity where a factor is unusual, or what the author speaks of is missing, or all else is."""
        open_ = [share for share in explanation.shares if share.corruption.open and not share.unit]
        gone = [self._wholes[share.corruption] for share in open_ if share.factor == 0]
        usual = {abs(share.factor) for share in open_} <= {0, *(x for some, _ in USUAL for x in some)}
        left = len(gone) < 2 or len(gone) < gone[0].others
        near = not self.finely or explanation.cost < FAR_FETCHED
        possible = near and usual and left and not any(each.is_asked for each in gone)
        return TURNED * (len(explanation.shares) - len(gone)) if possible else float("inf")

    def difference(self, explanation: Explanation) -> str:
        """What the author's sides differ by; the balance itself holds whatever the reactions are."""
        return remainder(self.case, self.case.value(self.written.difference))

    def proves(self, explanation: Explanation) -> bool:
        """Whether the balance holds with these mistakes, the answer put in, exactly."""
        pi = self.case.system.scope.graph.pi
        total = sum((share.added(pi)[0] for share in explanation.shares), start=self._left(explanation))
        _, answer, true = self._asked
        (put,) = substituted(substituted((total,), true), answer)
        (put,) = substituted((put,), self.place) if self.place else (put,)
        put = put if self._is_free or self.place else self.case.phase.eliminated(put)
        return bool(is_zero_everywhere(self.case.system, put).holds)

    def _left(self, explanation: Explanation) -> Scalar:
        """The sum of the items."""
        return self._wholes[explanation.shares[0].corruption].left

    @cached_property
    def _wholes(self) -> dict[Corruption, InBalance]:
        """Of each change in what it is made."""
        return {}

    # -- what is asked -----------------------------------------------------------------------------------

    @cached_property
    def _free(self) -> FreeBodies | None:
        """What acts, the beams cut where section forces are asked; None: in space, or something acts at no place."""
        system, quantities = self.case.system, self.case.quantities
        samples = Authored(self.case, self.written, "reaction").samples
        if samples is None or not quantities.is_plane or any(call.name == MULTIPLIER for call in self.written.calls):
            return None
        samples = samples.with_values(_at(samples, self.place))
        acting, cuts = what_acts(system), list[CutBalance]()
        for call in self.written.calls:
            if call.name in KINDS:
                beam = cut_beam(quantities, call, acting, len(system.motion.links) + len(cuts))
                acting, cuts = beam.acting, [*cuts, *beam.cuts]
                self._sections.update(beam.true)
        return FreeBodies(system, acting, tuple(cuts), samples)

    @cached_property
    def _sections(self) -> dict[Node, Scalar]:
        """The section forces that are asked."""
        return {}

    @cached_property
    def _reactions(self) -> Reactions:
        return Quantities(self.case.system, self.place).reactions if self.place else self.case.quantities.reactions

    @cached_property
    def _values(self) -> dict[Node, Scalar]:
        """What all reactions are that have a value, and the unknowns of loads."""
        reactions = self._reactions
        mine = (*symbols_of_reactions(reactions.balance), *reactions.balance.unknowns)
        determined, values = reactions.solution.determined, reactions.solution.constants
        return {x: values[j] for j, x in enumerate(mine) if determined(j)} | self._sections

    @cached_property
    def _mine(self) -> tuple[Node, ...]:
        """The reactions, and the unknowns of loads."""
        balance = self._reactions.by_components[0].balance
        return (*symbols_of_reactions(balance), *balance.unknowns)

    @cached_property
    def _scalar(self) -> Scalar:
        """The author's left side minus his right side, over the reactions."""
        case, (by_components, symbols) = self.case, self._reactions.by_components
        functions = Quantities(case.system, self.place, by_components)

        def called(call: Call) -> Scalar:
            return case.system.scope.graph.symbol(str(call)) if call.name in KINDS else functions.value(call)

        scalar = case.evaluated(self.written.difference, case.names, called)
        return substituted((scalar,), dict(zip(symbols, self._mine, strict=True)))[0]

    @cached_property
    def _asked(self) -> tuple[tuple[Node, ...], dict[Node, Scalar], dict[Node, Scalar]]:
        """(the reactions of the author's equation, one of them by it, true values of the others)."""
        scalar = self._scalar
        asked = tuple(x for x in (*self._mine, *self._sections) if depends_on(scalar, (x,)))
        true = {x: value for x, value in self._values.items() if x not in asked}
        for x in asked:
            slope = derivative(scalar, x)
            if not depends_on(slope, asked) and not is_zero(slope):
                (rest,) = substituted((scalar,), {x: 0})
                return asked, {x: over(-rest, slope)}, true
        return (), {}, true

    @cached_property
    def _samples(self) -> Samples:
        """The same with the answer put in."""
        _, answer, _ = self._asked
        return self._before.with_values(_at(self._before, answer))

    @cached_property
    def _before(self) -> Samples:
        """States with the reactions: those that stand in the equation anything, the others true."""
        assert self._free is not None
        samples, random = self._free.samples, np.random.default_rng(7)
        asked, _, true = self._asked
        if self._is_free:
            a = self.case.system.symbols.a
            samples = samples.with_values({x: random.uniform(0.4, 2, samples.values[x].shape) for x in a})
        samples = samples.with_values(_at(samples, true))
        sizes = samples.flat([self._values.get(x, 1) for x in asked])
        return samples.with_values(dict(zip(asked, sizes * random.uniform(0.4, 2, sizes.shape), strict=True)))

    @property
    def _is_free(self) -> bool:
        """Whether the author's accelerations may be any: he speaks of them by their names."""
        accelerations = self.case.system.symbols.a
        return not self.case.closing and depends_on(next(iter(self._asked[1].values())), accelerations)

    # -- the balances ------------------------------------------------------------------------------------

    @cached_property
    def _searches(self) -> tuple[Search, ...]:
        if self._free is None or not self._asked[0]:
            return ()
        found = [self._of_whole(*self._asked[0])] if not self.finely and len(self._asked[0]) == 1 else []
        found += [self._at_limit(self._free)] if not self.finely else []
        found += [self._search(self._free, cut) for cut in self._free.cuts(self._asked[0])]
        return tuple(search for search in found if search is not None)

    def _of_whole(self, asked: Node) -> Search | None:
        """All of what is asked, with a factor; None: it has no value."""
        true = self._values.get(asked)
        if true is None:
            return None
        whole = Corruption(f"{WHOLE} {asked.name}", "factor", (true,), SHARED - 1)
        self._wholes[whole] = InBalance(true - asked, true, False, 1)
        numbers = self._samples.of([true - asked, true])
        return Search(None, numbers[0], numbers[1:], [whole], 0)

    def _at_limit(self, free: FreeBodies) -> Search | None:
        """Friction that is taken as large as it can be, mu N, where balance needs another; None: there is none."""
        ((asked, _),) = self._asked[1].items()
        true, owners = self._values.get(asked), {each.symbol: each.force for each in free.acting}
        dimensions = self.case.parts.dimensions
        numbers = [x for x in self.case.edits.also if not (d := dimensions.get(x.name)) or d.unknowns]
        others = [x for x, owner in owners.items() if x is not None and x is not asked and owner == owners.get(asked)]
        if true is None or not numbers or not others:
            return None
        known = {x: x if x in self._asked[0] else self._values.get(x, x) for x in others}
        limits = []
        for mu, x, k in product(numbers, others, (1, -1)):
            for friction, normal, value in ((asked, x, mu * known[x]), (x, asked, over(known[x], mu))):
                text = (
                    f"{friction.name} is taken at its limit, {mu.name}*{normal.name}: at rest it is what balance needs"
                )
                row = (k * value - true,)
                limits.append(Corruption(friction.name, "wrong_formula", row, SHARED, open=False, text=text))
        self._wholes.update(dict.fromkeys(limits, InBalance(true - asked, true, False, 1)))
        values = self._samples.of([true - asked, *(each.rows[0] for each in limits)])
        return Search(None, values[0], values[1:], limits, 0)

    def _extra(self, cut: CutBalance, left: Scalar) -> Iterator[Corruption]:
        """The author's own terms, each of which may be none of this balance."""
        ((x, _),) = self._asked[1].items()
        ours, slope = derivative(left, x), derivative(self._scalar, x)
        terms = terms_of(self._scalar, frozenset(self.case.system.scope.positive)) if not is_zero(ours) else ()
        for term in terms if 2 < len(terms) <= MOST_TERMS else ():
            if not depends_on(term, (x,)):
                text = f"the term {term_text(term)} does not belong in {cut.name}"
                yield Corruption(text, "extra_term", (over(term * ours, slope),), EXTRA, open=False, text=text)

    def _search(self, free: FreeBodies, cut: CutBalance) -> Search | None:
        """One balance in numbers; None: nothing that is asked stands in it, or more than is known."""
        asked, seen = self._asked[0], [(each, pushes) for each in free.acting if (pushes := each.on(cut.parts))]
        values = [sum(map(cut.value, pushes), start=0) for _, pushes in seen]
        sizes = np.abs(self._before.flat(values)).max(axis=1, initial=0)
        there = sizes > CARRIED * sizes.max(initial=0)
        items = [
            Item(each, pushes, value, is_there, each.symbol in asked and not each.follows)
            for (each, pushes), value, is_there in zip(seen, values, there, strict=True)
        ]
        known = {item.acting.symbol for item in items if item.there and item.acting.symbol is not None}
        if not known & {*asked} or not known <= {*asked, *self._asked[2]}:
            return None
        dear = self._dearness(free, cut, items, known - {*asked})
        if self.finely and dear > FINEST:
            return None
        wrong, left = WrongItems(self.case, free, cut, self._samples, len(asked) == 1), sum(values, start=0)
        others = sum(item.there and not item.is_asked for item in items)
        apart = wrong.throughout(left) if self.finely else chain(wrong.strangers, self._extra(cut, left))
        found = [(each, InBalance(left, 0, False, others)) for each in apart]
        for item in items:
            changes = wrong.changes(item) if not self.finely else wrong.edits(item) if item.there else ()
            found += [(each, InBalance(left, item.value, item.is_asked, others)) for each in changes]
        corruptions = [replace(each, rank=each.rank + dear) for each, _ in found]
        self._wholes.update(zip(corruptions, (whole for _, whole in found), strict=True))
        numbers = self._samples.of([left, *(each.rows[0] for each in corruptions)])
        return Search(None, numbers[0], numbers[1:], corruptions, 0)

    def _dearness(self, free: FreeBodies, cut: CutBalance, items: list[Item], known: set[Node]) -> float:
        """How much less it is believed that somebody wrote this balance."""
        asked = [item for item in items if item.acting.symbol in self._asked[0]]
        couples = {item.acting.force for item in asked if all(push.is_couple for push in item.pushes)}
        sisters = {item.acting.symbol for item in items if item.acting.force in couples} & known
        more, truss = len(cut.parts) - 1, free.is_truss(cut.parts)
        larger = LARGER * (min(more, 1) if truss or more + 1 == len(self.case.system.motion.links) else more)
        larger += OBLIQUE * (truss and cut.along not in (None, (1, 0, 0), (0, 1, 0)))
        return KNOWN * len(known) + SISTER * len(sisters) + larger


def _at(samples: Samples, known: Mapping[Node, Scalar]) -> dict[Node, np.ndarray]:
    """What formulas are at the states."""
    return dict(zip(known, samples.flat(tuple(known.values())), strict=True))
