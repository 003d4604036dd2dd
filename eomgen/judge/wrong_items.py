"""Items of a balance -> what people take for them: forgotten, turned, doubled, another component, another lever arm.

F . e -> F x e, |F|, one component;   d x F -> d . F, |d| |F|, d_x F_y, (q - p) x F;   of what acts elsewhere 0 -> F . e
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import field, replace
from itertools import combinations

import numpy as np

from eomgen.judge.acting import ActingForce, PlacedPush
from eomgen.judge.case import Case
from eomgen.judge.corruption import PIECES, PLACED, PLAIN, SHARED, SHORTER, TERMS, Corruption
from eomgen.judge.diagnosis import Samples
from eomgen.judge.free_bodies import CutBalance, FreeBodies
from eomgen.judge.terms import term_text, terms_of
from eomgen.judge.wrong_terms import WrongTerms
from eomgen.records import dataclass
from eomgen.symbolic.expression.derivative import derivative
from eomgen.symbolic.expression.functions import sqrt
from eomgen.symbolic.expression.graph import Scalar, is_zero
from eomgen.symbolic.expression.rational import Fraction
from eomgen.symbolic.expression.spatial import Vector, cross, dot, minus, plus, times, vector_of
from eomgen.symbolic.numeric.tolerances import CARRIED

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
    """What one acting thing adds to a balance.

    Args:
        there: whether that is something.
        is_asked: it is of what the author speaks.
    """

    acting: ActingForce
    pushes: tuple[PlacedPush, ...]
    value: Scalar
    there: bool
    is_asked: bool


@dataclass(frozen=True)
class Otherwise:
    """What somebody takes for what a push adds: how it is told, its value; of a size the sign is that of the item."""

    kind: str
    rank: float
    text: str
    value: Scalar
    is_size: bool = False


@dataclass(frozen=True)
class WrongItems:
    """What may be wrong with the items of one balance.

    Args:
        samples: states with the reactions, where values are compared.
        alone: one reaction is asked alone.
    """

    case: Case
    free: FreeBodies
    cut: CutBalance
    samples: Samples = field(repr=False)
    alone: bool = False

    def changes(self, item: Item) -> Iterator[Corruption]:
        """Of an item, as a vector at its place."""
        what, pushes = f"{item.acting.name} in {self.cut.name}", item.pushes
        if item.there and not (item.is_asked and self.alone):
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
    ) -> Corruption:
        body = self.free.system.motion.links[push.body].name
        told = f"{name} {text}" if text else ""
        return Corruption(name, kind, (by,), rank, body, acting.force, open=not text, text=told)

    def _otherwise(self, item: Item, push: PlacedPush, what: str) -> Iterator[Corruption]:
        true, others = self.cut.value(push), [*self._values(item.acting, push), *self._components(push)]
        own, *numbers = np.nan_to_num(self.samples.flat([true, *(other.value for other in others)]))
        dear = (0 if item.there else 1) + OF_REACTION * (item.acting.kind == "reaction")
        for other, near in zip(others, numbers, strict=True):
            sign = int(np.sign(near[0] * own[0])) if item.there else 0
            for k in ((1, -1) if not sign else (sign,)) if other.is_size else (1,):
                apart, size = np.abs(k * near - own).max(), np.abs(near).max()
                if apart > CARRIED * size and size > CARRIED * np.abs(own).max():  # what is nothing is told as missing
                    by, rank = k * other.value - true, other.rank + dear
                    kind, text = (other.kind, other.text) if sign or not other.is_size else ("extra_term", NOTHING)
                    yield self._of(item.acting, what, push, by, rank, kind, text)

    def _values(self, acting: ActingForce, push: PlacedPush) -> Iterator[Otherwise]:
        """What may be taken for what a push adds."""
        F, e, p = push.force, self.cut.along, self.cut.about
        if e is not None:
            told = "stands with its other component: sin and cos are exchanged"
            yield Otherwise("wrong_axis", SHARED, told, cross(F, e)[2], is_size=True)
            yield Otherwise("factor", SHARED, FULL, self._strength(acting, push), is_size=True)
        elif p is not None and push.place is not None and not push.is_couple:
            d = minus(push.place, p)
            told = "has the other lever arm: sin and cos are exchanged"
            yield Otherwise("wrong_axis", SHARED, told, dot(d, F), is_size=True)
            yield Otherwise("factor", SHARED, DISTANT, _size(d) * self._strength(acting, push), is_size=True)
            for k, value in enumerate((d[0] * F[1], -d[1] * F[0])):
                told = f"stands with its component along {'yx'[k]} alone"
                yield Otherwise("missing_term", PLACED + SHORTER, told, value)
            for where, q, share in self._places(acting, push):
                told = f"acts at {where}: its lever arm is wrong"
                if share != 1:
                    told = f"stands with the factor {share} at {where}: its size and its lever arm are wrong"
                value = share * cross(minus(q, p), F)[2] + push.couple
                yield Otherwise("wrong_point", PLACED + (share != 1), told, value)

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
            for angle in self.free.angles:
                for wave in (angle.graph.call(op, angle) for op in ("sin", "cos")):
                    told = f"stands with a factor {term_text(wave)} that does not belong there"
                    yield Otherwise("factor", PIECES, told, value * wave)

    def _places(self, acting: ActingForce, push: PlacedPush) -> Iterator[tuple[str, Vector, Fraction]]:
        """(where, place, how much of it) a force may be thought to act: points of its body, parts of its line."""
        node = self.free.is_truss(frozenset((push.body,)))
        mine = [(spot.name, spot.place) for spot in self.free.spots if node or push.body in spot.bodies]
        yield from ((where, q, Fraction(1)) for where, q in mine)
        for (one, a), (other, b) in combinations(mine[:MOST_POINTS], 2) if acting.kind == "load" and not node else ():
            yield f"the middle of {one} and {other}", times(Fraction(1, 2), plus(a, b)), Fraction(1)
        for line in acting.spread:
            a, b = (self.free.system.motion.position(place) for place in (line.start, line.end))
            for share, where in SHARES:
                q = vector_of(x + share * (y - x) for x, y in zip(a, b, strict=True))
                for much in (Fraction(1), Fraction(2), Fraction(1, 2)):
                    yield f"{where} of its line", q, much

    @property
    def strangers(self) -> Iterator[Corruption]:
        """What does not act on the cut bodies, or on both sides inside of them, and is counted."""
        for each in self.free.acting:
            mine = tuple(push for push in each.pushes if push.part in self.cut.parts)
            inner = mine and not each.on(self.cut.parts)
            told = "is counted, and is an inner force" if inner else "is counted, and acts elsewhere"
            others = mine if inner else () if each.kind != "load" else self._beyond(each) if mine else each.pushes
            for push in others:
                what, by = f"{each.name} in {self.cut.name}", self.cut.value(push)
                yield self._of(each, what, push, by, TERMS if inner else PIECES, "extra_term", told)

    def _beyond(self, each: ActingForce) -> tuple[PlacedPush, ...]:
        """What stands of a line load on the other part of a beam that is cut."""
        cut = len(self.free.system.motion.links)
        return tuple(
            push for push in each.pushes if min(self.cut.parts) >= cut and cut <= push.part not in self.cut.parts
        )

    def throughout(self, left: Scalar) -> Iterator[Corruption]:
        """Of the whole balance: angles from the other axes, names that are exchanged."""
        parameters = tuple(self.case.system.symbols.parameters.values())
        for each in WrongTerms(self.case.edits, parameters, ()).throughout((left,)):
            text = each.text.replace("in everything", f"in {self.cut.name}", 1)
            yield replace(each, name=self.cut.name, text=text, rank=each.rank + SINGLE)

    def edits(self, item: Item) -> Iterator[Corruption]:
        """Of an item, as a formula; of a reaction what it is multiplied by."""
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
    return nonzero[0] if len(nonzero) == 1 else sqrt(dot(v, v))
