"""Rows of equations -> what may be wrong with single terms of them."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from contextlib import suppress

from eomgen.errors import DerivationError
from eomgen.judge.corruption import EXCHANGED, ODD, TERMS, Corruption
from eomgen.records import dataclass
from eomgen.symbolic.exact.expansion import Expansion
from eomgen.symbolic.exact.normal_form import TooLarge, legible, readable
from eomgen.symbolic.exact.writing import Writer
from eomgen.symbolic.expression.derivative import depends_on, derivative, substituted, symbols_of
from eomgen.symbolic.expression.functions import over
from eomgen.symbolic.expression.graph import Node, Scalar
from eomgen.symbolic.expression.node import linear_terms
from eomgen.symbolic.expression.traversal import order
from eomgen.symbolic.numeric.work import Work
from eomgen.symbolic.print.text import readable_text

MOST_TERMS = 60  # of an equation that is looked at term by term


def terms_of(x: Scalar, positive: frozenset[Node]) -> tuple[Scalar, ...]:
    """The terms of a sum multiplied out, as they are written; () where they are too many."""
    if type(x) is not Node:
        return () if x == 0 else (x,)
    expansion = Expansion(x.graph, Work.FORMULA, positive)
    writer = Writer(expansion)
    try:
        written = writer.written(expansion.of(x))
    except TooLarge:
        return ()
    return tuple(writer.term(*each) for each in written) if len(written) <= MOST_TERMS else ()


def corrupted_terms(
    rows: Sequence[Scalar], parameters: Iterable[Node], positive: frozenset[Node], rates: frozenset[Node]
) -> Iterator[Corruption]:
    """What may be wrong with single terms of each row."""
    known = tuple(parameters)
    for k, row in enumerate(rows):
        terms = terms_of(row, positive)
        whole = sum(terms, start=0)
        if type(whole) is Node:
            yield from _Wrong(whole, k, len(rows), "everything").throughout(known)
        for term in terms:
            squared = [u for u in rates if depends_on(term, (u,))]
            row_ = tuple(term if j == k else 0 for j in range(len(rows)))
            if len(terms) > 1:
                kind = "coriolis" if len(squared) == 2 else "factor"
                yield Corruption(f"the term {term_text(term)}", kind, row_, TERMS)
            if type(term) is Node:
                wrong = _Wrong(term, k, len(rows), f"the term {term_text(term)}")
                yield from wrong.angles()
                yield from wrong.parameters(known)
                yield from wrong.rates(rates)


@dataclass(frozen=True)
class _Wrong:
    """One term of one row.

    Args:
        place, number: which row of how many.
        name: the term as it is written.
    """

    term: Node
    place: int
    number: int
    name: str

    def row(self, x: Scalar) -> tuple[Scalar, ...]:
        return tuple(x if j == self.place else 0 for j in range(self.number))

    def changed(self, kind: str, to: Scalar, what: str, rank: float) -> Corruption:
        text = f"in {self.name} {what}"
        return Corruption(self.name, kind, self.row(to - self.term), rank, open=False, text=text)

    def replaced(self, kind: str, mapping: Mapping[Node, Scalar], what: str, rank: float) -> Iterator[Corruption]:
        """The term with something else in it, where that has a value."""
        with suppress(DerivationError):
            yield self.changed(kind, substituted((self.term,), mapping)[0], what, rank)

    def angles(self) -> Iterator[Corruption]:
        angles = angles_in((self.term,))
        for angle in angles:
            for kind, mapping, what in turned_angles(angle):
                yield from self.replaced(kind, mapping, what.format(term_text(angle)), TERMS)
            for name in ("sin", "cos"):
                wave = self.term.graph.call(name, angle)
                told = f"a factor {name}({term_text(angle)})"
                yield self.changed("factor", self.term * wave, f"{told} is too many", ODD)
                yield self.changed("factor", over(self.term, wave), f"{told} is missing", ODD)
        if len(angles) > 1:
            for kind, mapping, what in _all_turned(angles):
                yield from self.replaced(kind, mapping, what, TERMS)

    def throughout(self, known: Sequence[Node]) -> Iterator[Corruption]:
        """What may be wrong wherever it stands: angles, and parameters."""
        for angle in angles_in((self.term,)):
            for kind, mapping, what in turned_angles(angle):
                yield from self.replaced(kind, mapping, what.format(term_text(angle)), EXCHANGED)
        for kind, mapping, what in wrong_parameters(symbols_of((self.term,)), known):
            yield from self.replaced(kind, mapping, what, EXCHANGED)

    def parameters(self, known: Sequence[Node]) -> Iterator[Corruption]:
        held = {*symbols_of((self.term,))}
        for x in known:
            k = self.power(x) if x in held else 0
            for other in dict.fromkeys((k - 1, k + 1, -k)):
                if other != k:
                    yield self.changed("factor", self.term * x ** (other - k), wrong_power(x.name, k, other), ODD)
        for kind, mapping, what in wrong_parameters(symbols_of((self.term,)), known):
            if kind == "other":
                yield from self.replaced(kind, mapping, what, EXCHANGED)

    def power(self, x: Node) -> int:
        """The power of x in the term; 0 where it is none."""
        power = legible(over(x * derivative(self.term, x), self.term), Work.FORMULA, frozenset(), LONG)
        return int(power) if type(power) is not Node and power == int(power) else 0

    def rates(self, rates: Iterable[Node]) -> Iterator[Corruption]:
        for u in rates:
            if not depends_on(self.term, (u,)):
                continue
            yield self.changed("other", self.term * u, f"{u.name} stands once too often", ODD)
            yield self.changed("other", over(self.term, u), f"{u.name} stands once too few", ODD)
            for w in rates:
                if w is not u:
                    yield from self.replaced("other", {u: w}, f"{w.name} stands where {u.name} is meant", ODD)


LONG = 400  # characters of a term or a difference that is shown


def short_text(x: Scalar, positive: frozenset[Node]) -> str:
    """A scalar in its most legible form; "" where nobody would read it."""
    text = readable_text(legible(x, Work.FORMULA, positive, LONG)) or ""
    return text if len(text) <= LONG else ""


def term_text(x: Scalar) -> str:
    """A term or an angle as a text."""
    return readable_text(readable(x, Work.FORMULA)) or "that is too long to be shown"


def wrong_parameters(held: Iterable[Node], known: Sequence[Node]) -> Iterator[tuple[str, dict[Node, Scalar], str]]:
    """What may happen to the parameters that are held: (kind of the cause, what replaces what, in words)."""
    mine = [x for x in known if x in {*held}]
    for x in mine:
        yield "missing_term", {x: 0}, f"{x.name} is left out"
        yield "sign", {x: -x}, f"{x.name} has the wrong sign"
        yield "factor", {x: 2 * x}, f"2*{x.name} stands where {x.name} is meant"
        yield "factor", {x: over(x, 2)}, f"{x.name}/2 stands where {x.name} is meant"
        for y in known:
            if y is not x:
                yield "other", {x: y}, f"{y.name} stands where {x.name} is meant"
                if y in mine and x.name < y.name:
                    yield "other", {x: y, y: x}, f"{x.name} and {y.name} are exchanged"


def wrong_power(name: str, k: int, other: int) -> str:
    """In words that x^other stands where x^k is meant."""
    if k == 0 or other == 0:
        return f"a factor {name} is {'too many' if other - k > 0 else 'missing'}"
    there, meant = (name if abs(x) == 1 else f"{name}^{abs(x)}" for x in (other, k))
    if k * other > 0:
        return f"{there} stands where {meant} is meant"
    does, should = ("multiplies", "divide") if other > 0 else ("divides", "multiply")
    return f"{there} {does} where {meant} should {should}"


# -- angles ------------------------------------------------------------------------------------------


def angles_in(scalars: Sequence[Scalar]) -> list[Node]:
    """What stands under sines and cosines."""
    found = [x.args[0] for x in order(scalars) if x.op in ("sin", "cos")]
    return list(dict.fromkeys(x for x in found if type(x) is Node))


def turned_angles(angle: Node) -> Iterator[tuple[str, dict[Node, Scalar], str]]:
    """What may happen to an angle: (kind of the cause, what replaces sine and cosine, in words)."""
    graph = angle.graph
    sin, cos = graph.held("sin", (angle,)), graph.held("cos", (angle,))
    yield "wrong_axis", {sin: cos, cos: sin}, "sin and cos of {0} are exchanged: the angle is taken from the other axis"
    yield "wrong_axis", {sin: cos, cos: -sin}, "{0} is taken from the other axis"
    yield "wrong_axis", {sin: -cos, cos: sin}, "{0} is taken from the other axis"
    yield "wrong_axis", {sin: cos}, "cos stands for sin({0}): the angle is taken from the other axis"
    yield "wrong_axis", {cos: sin}, "sin stands for cos({0}): the angle is taken from the other axis"
    yield "sign", {sin: -sin}, "the sign of sin({0}) is wrong"
    yield "sign", {cos: -cos}, "the sign of cos({0}) is wrong"
    for factor, how in ((over(graph.pi, 180), "degrees"), (over(180, graph.pi), "radians")):
        scaled = factor * angle
        mapping = {sin: graph.call("sin", scaled), cos: graph.call("cos", scaled)}
        yield "unit", mapping, f"{{0}} is taken in {how}"
    yield "other", {cos: 1}, "cos({0}) is left out"
    yield "other", {sin: angle, cos: 1}, "sin({0}) and cos({0}) are those of a small angle"
    yield "other", {sin: angle}, "sin({0}) is replaced by the angle"
    yield "other", {sin: 0, cos: 1}, "{0} is taken as zero"
    yield "other", {sin: 1}, "sin({0}) is left out"
    terms = linear_terms(angle)
    if len(terms) > 1:
        for atom in terms:
            if type(atom) is Node and atom.op == "symbol":
                other = substituted((angle,), {atom: -atom})[0]
                mapping = {sin: graph.call("sin", other), cos: graph.call("cos", other)}
                yield "sign", mapping, f"the sign of {atom.name} in the angle {{0}} is wrong"


def _all_turned(angles: Sequence[Node]) -> Iterator[tuple[str, dict[Node, Scalar], str]]:
    """The same for several angles at once."""
    graph = angles[0].graph
    sines, cosines = ([graph.held(op, (x,)) for x in angles] for op in ("sin", "cos"))
    exchanged: dict[Node, Scalar] = {**dict(zip(sines, cosines, strict=True)), **dict(zip(cosines, sines, strict=True))}
    yield "wrong_axis", exchanged, "sin and cos are exchanged: the angles are taken from the other axes"
    small: dict[Node, Scalar] = {**dict(zip(sines, angles, strict=True)), **dict.fromkeys(cosines, 1)}
    yield "other", small, "sines and cosines are those of small angles"
    for factor, how in ((over(graph.pi, 180), "degrees"), (over(180, graph.pi), "radians")):
        mapping: dict[Node, Scalar] = {
            graph.held(op, (x,)): graph.call(op, factor * x) for x in angles for op in ("sin", "cos")
        }
        yield "unit", mapping, f"the angles are taken in {how}"
