"""The balance of cut bodies in which one item is wrong.

An answer of somebody -> the balance of cut bodies in which one item is wrong, all that he solved for being right.

    sum of items = 0;   the answer put in, R = sum of items != 0:   R + sum y_j C_j = 0

An item is a component of a reaction, a load, a weight, what inertia does. It is forgotten, turned, doubled; another
component of it is taken, or its full size; its lever arm is another one; it is none of the cut bodies at all.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from contextlib import suppress
from dataclasses import field, replace
from functools import cached_property
from itertools import chain, combinations, product

import numpy as np

from eomgen.errors import EomgenError
from eomgen.frozen import dataclass
from eomgen.judge.case import Case
from eomgen.judge.comparison import EXTRA, remainder
from eomgen.judge.decision import is_zero_everywhere
from eomgen.judge.diagnosis import (
    FAR_FETCHED,
    PIECES,
    PLACED,
    PLAIN,
    SHARED,
    SHORTER,
    TERMS,
    USUAL,
    WHOLE,
    Explanation,
    Mistake,
    Samples,
    Search,
    Share,
    explained,
)
from eomgen.judge.fixes import Authored
from eomgen.judge.reading import MULTIPLIER, HandEquation
from eomgen.judge.terms import WrongTerms, angles_in, short_text, term_text, terms_of
from eomgen.judge.verdict import FUNCTION_KINDS
from eomgen.mechanics.instant import Quantities
from eomgen.mechanics.statics import ActingForce, CutBalance, FreeBodies, PlacedPush, SectionForces
from eomgen.symbolic.expression import (
    Call,
    Fraction,
    Node,
    Scalar,
    Vector,
    depends_on,
    derivative,
    is_zero,
    over,
    substituted,
)
from eomgen.symbolic.numeric import tolerances

KNOWN = 1.2  # how much less a balance is believed for each reaction in it that has to be known
OBLIQUE = 0.6  # the same, along or across a member of a truss
SISTER = 1.2  # the same, where a couple is requested, and it is the force there
LARGER = 0.15  # the same, for each body beside the first; for the whole and parts of trusses once
FINEST = 2.5  # the same, of a balance whose items are looked at place by place
TURNED = 0.01  # how much less something else is believed of an item than that it was forgotten
MOST_TERMS = 8  # of an equation, each of which may be too many
SHORT = 40  # characters of a factor that is stated


def requests_reactions(written: HandEquation) -> bool:
    """True if reactions stand in an equation."""
    return any(FUNCTION_KINDS.get(call.name) == "reaction" for call in written.calls)


@dataclass(frozen=True)
class InBalance:
    """The place of a change: the sum of all items, the item, whether it is requested, the number of other items."""

    left: Scalar
    value: Scalar
    is_requested: bool
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
            return [replace(x, shares=tuple(map(self._reported, x.shares))) for x in found]
        return []

    def _reported(self, share: Share) -> Share:
        """A share with the factor by which the true item differs from what stands there, where that is short."""
        mistake, (row,) = share.mistake, share.mistake.rows
        value = self._wholes[mistake].value
        if not mistake.text.endswith((FULL, DISTANT)):
            return share
        positive = self.case.system.scope.positive
        ratio = short_text(over(value, value + row), positive)
        if not ratio or len(ratio) > SHORT:
            return share
        reported = replace(mistake, text=f"{mistake.text}: the factor {ratio} is missing")
        self._wholes[reported] = self._wholes[mistake]
        return replace(share, mistake=reported)

    def _dearer(self, explanation: Explanation) -> float:
        """Infinity where a factor is unusual, or what the author speaks of is missing, or all else is."""
        open_ = [share for share in explanation.shares if share.mistake.open and not share.unit]
        gone = [self._wholes[share.mistake] for share in open_ if share.factor == 0]
        usual = {abs(share.factor) for share in open_} <= {0, *(x for some, _ in USUAL for x in some)}
        left = len(gone) < 2 or len(gone) < gone[0].others
        near = not self.finely or explanation.cost < FAR_FETCHED
        possible = near and usual and left and not any(each.is_requested for each in gone)
        return TURNED * (len(explanation.shares) - len(gone)) if possible else float("inf")

    def difference(self, explanation: Explanation) -> str:
        """Difference of the author's sides; the balance itself holds whatever the reactions are."""
        return remainder(self.case, self.case.value(self.written.difference))

    def proves(self, explanation: Explanation) -> bool:
        """True if the balance holds exactly with these mistakes and the answer put in."""
        pi = self.case.system.scope.graph.pi
        total = sum((share.added(pi)[0] for share in explanation.shares), start=self._left(explanation))
        _, answer, true = self._requested
        (put,) = substituted(substituted((total,), true), answer)
        (put,) = substituted((put,), self.place) if self.place else (put,)
        put = put if self._is_free or self.place else self.case.phase.eliminated(put)
        return bool(is_zero_everywhere(self.case.system, put).holds)

    def _left(self, explanation: Explanation) -> Scalar:
        """The sum of the items."""
        return self._wholes[explanation.shares[0].mistake].left

    @cached_property
    def _wholes(self) -> dict[Mistake, InBalance]:
        """The place of each change, by its mistake."""
        return {}

    # -- what is requested -----------------------------------------------------------------------------------

    @cached_property
    def _free(self) -> FreeBodies | None:
        """The loads, beams cut where section forces are requested; None: in space, or something acts at no place."""
        quantities, calls = self.case.quantities, self.written.calls
        if self._states is None or not quantities.is_plane or any(call.name == MULTIPLIER for call in calls):
            return None
        return quantities.free_bodies([call for call in calls if call.name in SectionForces.KINDS], self._states.flat)

    @cached_property
    def _states(self) -> Samples | None:
        """States at which the reactions can be compared; None: there are none."""
        samples = Authored(self.case, self.written, "reaction").samples
        return None if samples is None else samples.with_values(_at(samples, self.place))

    @property
    def _sections(self) -> Mapping[Node, Scalar]:
        """The section forces that are requested."""
        return {} if self._free is None else self._free.sections

    @cached_property
    def _quantities(self) -> Quantities:
        """The values of functions, reactions among them, at the place that is judged."""
        return Quantities(self.case.system, self.place) if self.place else self.case.quantities

    @cached_property
    def _values(self) -> dict[Node, Scalar]:
        """Values of all reactions that have one, and of the unknowns of loads."""
        reactions = self._quantities.reactions
        determined, values = reactions.solution.determined, reactions.solution.constants
        own = {x: values[j] for j, x in enumerate(reactions.balance.symbols) if determined(j)}
        return {**own, **self._sections}

    @cached_property
    def _mine(self) -> tuple[Node, ...]:
        """The reactions, and the unknowns of loads."""
        return self._quantities.reactions.by_components[0].balance.symbols

    @cached_property
    def _scalar(self) -> Scalar:
        """The author's left side minus his right side, over the reactions."""
        case, (by_components, symbols) = self.case, self._quantities.reactions.by_components
        functions = Quantities(case.system, self.place, by_components)

        def called(call: Call) -> Scalar:
            return (
                case.system.scope.graph.symbol(str(call)) if call.name in SectionForces.KINDS else functions.value(call)
            )

        scalar = case.evaluated(self.written.difference, case.names, called)
        return substituted((scalar,), dict(zip(symbols, self._mine, strict=True)))[0]

    @cached_property
    def _requested(self) -> tuple[tuple[Node, ...], dict[Node, Scalar], dict[Node, Scalar]]:
        """(the reactions of the author's equation, one of them by it, true values of the others)."""
        scalar = self._scalar
        requested = tuple(x for x in (*self._mine, *self._sections) if depends_on(scalar, (x,)))
        true = {x: value for x, value in self._values.items() if x not in requested}
        for x in requested:
            slope = derivative(scalar, x)
            if not depends_on(slope, requested) and not is_zero(slope):
                (rest,) = substituted((scalar,), {x: 0})
                return requested, {x: over(-rest, slope)}, true
        return (), {}, true

    @cached_property
    def _samples(self) -> Samples:
        """The same with the answer put in."""
        _, answer, _ = self._requested
        return self._before.with_values(_at(self._before, answer))

    @cached_property
    def _before(self) -> Samples:
        """States with the reactions: those that stand in the equation anything, the others true."""
        assert self._states is not None
        samples, random = self._states, np.random.default_rng(7)
        requested, _, true = self._requested
        if self._is_free:
            a = self.case.system.symbols.a
            samples = samples.with_values({x: random.uniform(0.4, 2, samples.values[x].shape) for x in a})
        samples = samples.with_values(_at(samples, true))
        sizes = samples.flat([self._values.get(x, 1) for x in requested])
        return samples.with_values(dict(zip(requested, sizes * random.uniform(0.4, 2, sizes.shape), strict=True)))

    @property
    def _is_free(self) -> bool:
        """True if the accelerations are arbitrary: the author's equation names them."""
        accelerations = self.case.system.symbols.a
        return not self.case.closing and depends_on(next(iter(self._requested[1].values())), accelerations)

    # -- the balances ------------------------------------------------------------------------------------

    @cached_property
    def _searches(self) -> tuple[Search, ...]:
        if self._free is None or not self._requested[0]:
            return ()
        found = [self._of_whole(*self._requested[0])] if not self.finely and len(self._requested[0]) == 1 else []
        found += [self._at_limit(self._free)] if not self.finely else []
        angles = angles_in([x for each in self._free.acting for push in each.pushes for x in push.force])
        found += [self._search(self._free, cut, angles) for cut in self._free.cuts(self._requested[0])]
        return tuple(search for search in found if search is not None)

    def _of_whole(self, requested: Node) -> Search | None:
        """All of what is requested, with a factor; None: it has no value."""
        true = self._values.get(requested)
        if true is None:
            return None
        whole = Mistake(f"{WHOLE} {requested.name}", "factor", (true,), SHARED - 1)
        self._wholes[whole] = InBalance(true - requested, true, False, 1)
        numbers = self._samples.of([true - requested, true])
        return Search(None, numbers[0], numbers[1:], [whole], 0)

    def _at_limit(self, free: FreeBodies) -> Search | None:
        """Friction that is taken as large as it can be, mu N, where balance needs another; None: there is none."""
        ((requested, _),) = self._requested[1].items()
        true, owners = self._values.get(requested), {each.symbol: each.force for each in free.acting}
        dimensions = self.case.edits.dimensions
        numbers = [x for x in self.case.edits.also if not (d := dimensions.get(x.name)) or d.unknowns]
        others = [
            x for x, owner in owners.items() if x is not None and x is not requested and owner == owners.get(requested)
        ]
        if true is None or not numbers or not others:
            return None
        known = {x: x if x in self._requested[0] else self._values.get(x, x) for x in others}
        limits = []
        for mu, x, k in product(numbers, others, (1, -1)):
            for friction, normal, value in ((requested, x, mu * known[x]), (x, requested, over(known[x], mu))):
                text = (
                    f"{friction.name} is taken at its limit, {mu.name}*{normal.name}: at rest it is what balance needs"
                )
                row = (k * value - true,)
                limits.append(Mistake(friction.name, "wrong_formula", row, SHARED, open=False, text=text))
        self._wholes.update(dict.fromkeys(limits, InBalance(true - requested, true, False, 1)))
        values = self._samples.of([true - requested, *(each.rows[0] for each in limits)])
        return Search(None, values[0], values[1:], limits, 0)

    def _extra(self, cut: CutBalance, left: Scalar) -> Iterator[Mistake]:
        """The author's own terms, each of which may be none of this balance."""
        ((x, _),) = self._requested[1].items()
        ours, slope = derivative(left, x), derivative(self._scalar, x)
        terms = terms_of(self._scalar, frozenset(self.case.system.scope.positive)) if not is_zero(ours) else ()
        for term in terms if 2 < len(terms) <= MOST_TERMS else ():
            if not depends_on(term, (x,)):
                text = f"the term {term_text(term)} does not belong in {cut.name}"
                yield Mistake(text, "extra_term", (over(term * ours, slope),), EXTRA, open=False, text=text)

    def _search(self, free: FreeBodies, cut: CutBalance, angles: Sequence[Node]) -> Search | None:
        """One balance in numbers; None: nothing that is requested stands in it, or more than is known."""
        requested, seen = self._requested[0], [(each, pushes) for each in free.acting if (pushes := each.on(cut.parts))]
        values = [sum(map(cut.value, pushes), start=0) for _, pushes in seen]
        sizes = np.abs(self._before.flat(values)).max(axis=1, initial=0)
        there = sizes > tolerances.CARRIED * sizes.max(initial=0)
        items = [
            Item(each, pushes, value, is_there, each.symbol in requested and not each.follows)
            for (each, pushes), value, is_there in zip(seen, values, there, strict=True)
        ]
        known = {item.acting.symbol for item in items if item.there and item.acting.symbol is not None}
        if not known & {*requested} or not known <= {*requested, *self._requested[2]}:
            return None
        dear = self._dearness(free, cut, items, known - {*requested})
        if self.finely and dear > FINEST:
            return None
        wrong = WrongItems(self.case, free, cut, self._samples, angles, len(requested) == 1)
        left = sum(values, start=0)
        others = sum(item.there and not item.is_requested for item in items)
        apart = wrong.throughout(left) if self.finely else chain(wrong.strangers, self._extra(cut, left))
        found = [(each, InBalance(left, 0, False, others)) for each in apart]
        for item in items:
            changes = wrong.changes(item) if not self.finely else wrong.edits(item) if item.there else ()
            found += [(each, InBalance(left, item.value, item.is_requested, others)) for each in changes]
        mistakes = [replace(each, rank=each.rank + dear) for each, _ in found]
        self._wholes.update(zip(mistakes, (whole for _, whole in found), strict=True))
        numbers = self._samples.of([left, *(each.rows[0] for each in mistakes)])
        return Search(None, numbers[0], numbers[1:], mistakes, 0)

    def _dearness(self, free: FreeBodies, cut: CutBalance, items: list[Item], known: set[Node]) -> float:
        """The cost added to a balance: the higher, the less it is believed that somebody wrote it."""
        requested = [item for item in items if item.acting.symbol in self._requested[0]]
        couples = {item.acting.force for item in requested if all(push.is_couple for push in item.pushes)}
        sisters = {item.acting.symbol for item in items if item.acting.force in couples} & known
        more, truss = len(cut.parts) - 1, free.is_truss(cut.parts)
        larger = LARGER * (min(more, 1) if truss or more + 1 == len(self.case.system.motion.links) else more)
        larger += OBLIQUE * (truss and cut.along not in (None, (1, 0, 0), (0, 1, 0)))
        return KNOWN * len(known) + SISTER * len(sisters) + larger


def _at(samples: Samples, known: Mapping[Node, Scalar]) -> dict[Node, np.ndarray]:
    """Values of formulas at the states."""
    return dict(zip(known, samples.flat(tuple(known.values())), strict=True))


# -------- wrong items -----------------------------------------------------------------------------------------
# Items of a balance -> what people take for them: forgotten, turned, doubled, another component, another lever arm.
#
# F . e -> F x e, |F|, one component;   d x F -> d . F, |d| |F|, d_x F_y, (q - p) x F;   of what acts elsewhere 0 -> F
# . e


NOTHING = "is counted, and does nothing in this direction"
FULL = "stands with its full size in place of its component"
DISTANT = "has the whole distance for a lever arm, which is not normal to it"
SHARES = (  # of a line: where the resultant of a load along it is thought to be
    (Fraction(0), "the start"),
    (Fraction(1), "the end"),
    (Fraction(1, 2), "the middle"),
    (Fraction(1, 3), "a third"),
    (Fraction(2, 3), "two thirds"),
)
MOST_POINTS = 5  # of a body between which loads may be thought to act
OF_REACTION = 0.4  # how much less another arm of a reaction is believed than one of a load
SINGLE = 0.2  # how much sooner a change of one item is believed than the same of a share in an answer


@dataclass(frozen=True)
class Item:
    """The share of one acting thing in a balance.

    Args:
        there: whether that is something.
        is_requested: it is of what the author speaks.
    """

    acting: ActingForce
    pushes: tuple[PlacedPush, ...]
    value: Scalar
    there: bool
    is_requested: bool


@dataclass(frozen=True)
class Otherwise:
    """A wrong share of a force or couple: its sentence and its value; a magnitude takes the sign of the item."""

    kind: str
    rank: float
    text: str
    value: Scalar
    is_size: bool = False


@dataclass(frozen=True)
class WrongItems:
    """Possible mistakes in the items of one balance.

    Args:
        samples: states with the reactions, where values are compared.
        angles: under whose sines and cosines forces stand.
        alone: one reaction is requested alone.
    """

    case: Case
    free: FreeBodies
    cut: CutBalance
    samples: Samples = field(repr=False)
    angles: Sequence[Node] = ()
    alone: bool = False

    def changes(self, item: Item) -> Iterator[Mistake]:
        """Mistakes in an item, seen as a vector at its place."""
        what, pushes = f"{item.acting.name} in {self.cut.name}", item.pushes
        if item.there and not (item.is_requested and self.alone):
            yield self._of(item.acting, what, pushes[0], item.value, PLAIN)
        positive = self.case.system.scope.positive
        terms = terms_of(item.value, positive) if item.acting.kind == "inertia" else ()
        for term in terms if len(terms) > 1 else ():
            name = f"the term {term_text(term)} of {what}"
            yield self._of(item.acting, name, pushes[0], term, PLAIN + SHORTER)
        several = len({push.place for push in pushes if not push.is_couple}) > 1
        for push in pushes:
            if several:
                name = f"{what} on {self.free.system.motion.links[push.body].name}"
                yield self._of(item.acting, name, push, self.cut.value(push), SHARED)
            yield from self._otherwise(item, push, what)

    def _of(
        self,
        acting: ActingForce,
        name: str,
        push: PlacedPush,
        by: Scalar,
        rank: float,
        kind: str = "factor",
        text: str = "",
    ) -> Mistake:
        body = self.free.system.motion.links[push.body].name
        reported = f"{name} {text}" if text else ""
        return Mistake(name, kind, (by,), rank, body, acting.force, open=not text, text=reported)

    def _otherwise(self, item: Item, push: PlacedPush, what: str) -> Iterator[Mistake]:
        true, others = self.cut.value(push), [*self._values(item.acting, push), *self._components(push)]
        own, *numbers = np.nan_to_num(self.samples.flat([true, *(other.value for other in others)]))
        dear = (0 if item.there else 1) + OF_REACTION * (item.acting.kind == "reaction")
        for other, near in zip(others, numbers, strict=True):
            sign = int(np.sign(near[0] * own[0])) if item.there else 0
            for k in ((1, -1) if not sign else (sign,)) if other.is_size else (1,):
                apart, size = np.abs(k * near - own).max(), np.abs(near).max()
                if (
                    apart > tolerances.CARRIED * size and size > tolerances.CARRIED * np.abs(own).max()
                ):  # what is nothing is stated as missing
                    by, rank = k * other.value - true, other.rank + dear
                    kind, text = (other.kind, other.text) if sign or not other.is_size else ("extra_term", NOTHING)
                    yield self._of(item.acting, what, push, by, rank, kind, text)

    def _values(self, acting: ActingForce, push: PlacedPush) -> Iterator[Otherwise]:
        """Wrong values of the share of a force or couple."""
        F, e, p = push.force, self.cut.along, self.cut.about
        if e is not None:
            reported = "stands with its other component: sin and cos are exchanged"
            yield Otherwise("wrong_axis", SHARED, reported, F.cross(e)[2], is_size=True)
            yield Otherwise("factor", SHARED, FULL, self._strength(acting, push), is_size=True)
        elif p is not None and push.place is not None and not push.is_couple:
            d = push.place - p
            reported = "has the other lever arm: sin and cos are exchanged"
            yield Otherwise("wrong_axis", SHARED, reported, d @ F, is_size=True)
            yield Otherwise("factor", SHARED, DISTANT, _size(d) * self._strength(acting, push), is_size=True)
            for k, value in enumerate((d[0] * F[1], -d[1] * F[0])):
                reported = f"stands with its component along {'yx'[k]} alone"
                yield Otherwise("missing_term", PLACED + SHORTER, reported, value)
            for where, q, share in self._places(acting, push):
                reported = f"acts at {where}: its lever arm is wrong"
                if share != 1:
                    reported = f"stands with the factor {share} at {where}: its size and its lever arm are wrong"
                value = share * (q - p).cross(F)[2] + push.couple
                yield Otherwise("wrong_point", PLACED + (share != 1), reported, value)

    def _strength(self, acting: ActingForce, push: PlacedPush) -> Scalar:
        """The size of a force; of a reaction in one direction with its sign."""
        if push.unit is None or acting.symbol is None:
            return _size(push.force)
        unit = _size(push.unit)
        return acting.symbol if np.allclose(self.samples.flat((unit,)), 1) else acting.symbol * unit

    def _components(self, push: PlacedPush) -> Iterator[Otherwise]:
        """A component of what acts with all of it, by the angles that there are."""
        if self.cut.along is not None:
            value = self.cut.value(push)
            for angle in self.angles:
                for wave in (angle.graph.call(op, angle) for op in ("sin", "cos")):
                    reported = f"stands with a factor {term_text(wave)} that does not belong there"
                    yield Otherwise("factor", PIECES, reported, value * wave)

    def _places(self, acting: ActingForce, push: PlacedPush) -> Iterator[tuple[str, Vector, Fraction]]:
        """(where, place, how much of it) a force may be thought to act: points of its body, parts of its line."""
        node = self.free.is_truss(frozenset((push.body,)))
        mine = [(spot.name, spot.place) for spot in self.free.spots if node or push.body in spot.bodies]
        yield from ((where, q, Fraction(1)) for where, q in mine)
        for (one, a), (other, b) in combinations(mine[:MOST_POINTS], 2) if acting.kind == "load" and not node else ():
            yield f"the middle of {one} and {other}", Fraction(1, 2) * (a + b), Fraction(1)
        for line in acting.spread:
            a, b = (self.free.system.motion.position(place) for place in (line.start, line.end))
            for share, where in SHARES:
                q = Vector(x + share * (y - x) for x, y in zip(a, b, strict=True))
                for much in (Fraction(1), Fraction(2), Fraction(1, 2)):
                    yield f"{where} of its line", q, much

    @property
    def strangers(self) -> Iterator[Mistake]:
        """Mistakes of counting what does not act on the cut bodies, or acts on both sides inside of them."""
        for each in self.free.acting:
            mine = tuple(push for push in each.pushes if push.part in self.cut.parts)
            inner = mine and not each.on(self.cut.parts)
            reported = "is counted, and is an inner force" if inner else "is counted, and acts elsewhere"
            others = mine if inner else () if each.kind != "load" else self._beyond(each) if mine else each.pushes
            for push in others:
                what, by = f"{each.name} in {self.cut.name}", self.cut.value(push)
                yield self._of(each, what, push, by, TERMS if inner else PIECES, "extra_term", reported)

    def _beyond(self, each: ActingForce) -> tuple[PlacedPush, ...]:
        """The part of a line load on the other part of a beam that is cut."""
        cut = len(self.free.system.motion.links)
        return tuple(
            push for push in each.pushes if min(self.cut.parts) >= cut and cut <= push.part not in self.cut.parts
        )

    def throughout(self, left: Scalar) -> Iterator[Mistake]:
        """Mistakes throughout a balance: angles counted from the other axes, names that are exchanged."""
        parameters = tuple(self.case.system.symbols.parameters.values())
        for each in WrongTerms(self.case.edits, parameters, ()).throughout((left,)):
            text = each.text.replace("in everything", f"in {self.cut.name}", 1)
            yield replace(each, name=self.cut.name, text=text, rank=each.rank + SINGLE)

    def edits(self, item: Item) -> Iterator[Mistake]:
        """Mistakes in an item, seen as a formula; in a reaction, in its coefficient."""
        what, edits, push = f"{item.acting.name} in {self.cut.name}", self.case.edits, item.pushes[0]
        symbol = item.acting.symbol
        k: Scalar = 1 if symbol is None else symbol
        formula = item.value if symbol is None else derivative(item.value, symbol)
        for edit in edits.of((formula,)):
            by = k * (edit.to[0] - formula)
            yield self._of(item.acting, f"{what}:", push, by, edit.rank - SINGLE, edit.kind, edit.text)
        parameters = tuple(self.case.system.symbols.parameters.values())
        body = self.free.system.motion.links[push.body].name
        for wrong in WrongTerms(edits, parameters, (), what, body, item.acting.force).in_rows((formula,)):
            yield replace(wrong, rows=(k * wrong.rows[0],), rank=wrong.rank - SINGLE)


def _size(v: Vector) -> Scalar:
    nonzero = [x for x in v if not is_zero(x)]
    return nonzero[0] if len(nonzero) == 1 else v.length
