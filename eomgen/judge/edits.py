"""A formula -> what people make of it by mistake: one place of it changed.

A place is a node of the formula as it was derived or as it is written. Of a product a factor is left out, stands once
too often or too few, multiplies where it should divide, is another function of its angle; of a sum a term is left out,
turned, or there with twice or half of it; springs in a row are taken for springs side by side. The formula may be an
energy before it is differentiated, a force, a row of an equation or an answer: the changes are the same.
"""

from __future__ import annotations

from collections.abc import Collection, Iterator, Sequence
from contextlib import suppress
from dataclasses import replace
from itertools import chain

from eomgen.errors import DerivationError
from eomgen.judge.corruption import EXCHANGED, ODD, TERMS
from eomgen.judge.terms import LONG, Powers, all_turned, angles_in, is_product, powers_of, term_text, turned_angles
from eomgen.records import dataclass
from eomgen.symbolic.exact.normal_form import legible
from eomgen.symbolic.expression.derivative import substituted, symbols_of
from eomgen.symbolic.expression.functions import over
from eomgen.symbolic.expression.graph import Node, Scalar, is_zero
from eomgen.symbolic.expression.node import ScalarRow, linear_terms
from eomgen.symbolic.expression.rational import Fraction
from eomgen.symbolic.expression.traversal import order
from eomgen.symbolic.numeric.work import Work

MOST_PLACES = 80  # nodes of a formula that are looked at
SHOWN = 60  # characters of a place that is told
WAVES = ("sin", "cos", "tan")


@dataclass(frozen=True)
class Edit:
    """A formula with one mistake in it.

    Args:
        kind: of the cause.
        to: the formulas with the mistake.
        text: what is wrong, to be read behind "in ...".
        rank: how readily it is believed.
    """

    kind: str
    to: ScalarRow
    text: str
    rank: float


@dataclass(frozen=True)
class Edits:
    """What may go wrong in formulas.

    Args:
        positive: symbols that stand for positive numbers.
        alike: groups of parameters of one dimension; the ratio of two of them is looked at as a whole.
        also: nodes by which somebody may multiply or divide although they do not stand there.
    """

    positive: Collection[Node] = ()
    alike: Sequence[frozenset[Node]] = ()
    also: Sequence[Node] = ()

    def of(self, formulas: ScalarRow) -> Iterator[Edit]:
        """Those of formulas as they are and as they are written, each once; a place of several in all of them."""
        seen = {formulas}
        for form in dict.fromkeys((formulas, self.written(formulas))):
            for each in self._in_form(form):
                if each.to not in seen:
                    seen.add(each.to)
                    yield each

    def of_answer(self, answer: ScalarRow) -> Iterator[Edit]:
        """Those of an answer as it is written, which may also stand upside down or under a root."""
        for each in self.of(answer):
            yield replace(each, rank=max(each.rank, ODD))
        for x in answer if len(answer) == 1 else ():
            if type(x) is Node:
                yield Edit(
                    "factor", (over(1, x),), "what is above and below is exchanged: its reciprocal stands there", TERMS
                )
                yield Edit("factor", (x * x,), "the root is missing: its square stands there", TERMS)
                if x.op != "sqrt":
                    yield Edit("factor", (x.graph.sqrt(x),), "a root is too many", EXCHANGED)

    def written(self, formulas: ScalarRow) -> ScalarRow:
        """Formulas as people write them."""
        return tuple(legible(x, Work.FORMULA, self.positive, LONG) for x in formulas)

    def _in_form(self, formulas: ScalarRow) -> Iterator[Edit]:
        places = [node for node in order(formulas) if node.args]
        for node in places[-MOST_PLACES:][::-1]:
            where = "" if node in formulas or len(name := term_text(node)) > SHOWN else f" in {name}"
            for kind, other, text, rank in chain(self._of_product(node), _of_sum(node), self._in_series(node)):
                with suppress(DerivationError):  # it has no value there
                    yield Edit(kind, substituted(formulas, {node: other}), text + where, rank)

    def of_term(self, term: Node) -> Iterator[Edit]:
        """Those of a term of a sum multiplied out: other functions of its angles, too, and factors too many."""
        for kind, other, text, rank in self._of_product(term):
            yield Edit(kind, (other,), text, rank)
        angles = angles_in((term,))
        for angle in angles:
            for kind, mapping, what in turned_angles(angle, (term,)):
                with suppress(DerivationError):
                    rank = EXCHANGED if kind == "factor" else TERMS
                    yield Edit(kind, substituted((term,), mapping), what.format(term_text(angle)), rank)
        if len(angles) > 1:
            for kind, mapping, what in all_turned(angles):
                with suppress(DerivationError):
                    yield Edit(kind, substituted((term,), mapping), what, TERMS)
        held = powers_of(term)
        waves = [term.graph.call(op, x) for x in angles for op in ("sin", "cos")]
        for f in (*self.also, *(x for x in waves if type(x) is Node)):
            if f not in held:
                yield Edit("factor", (term * f,), f"a factor {term_text(f)} is too many", ODD)
                yield Edit("factor", (over(term, f),), f"a division by {term_text(f)} is too many", ODD)

    # -- products --------------------------------------------------------------------------------

    def _of_product(self, x: Node) -> Iterator[tuple[str, Scalar, str, float]]:
        powers = powers_of(x)
        if x.op in ("mul", "div", "pow", "sqrt") or len(powers) > 1:
            for f, k in powers.items():
                name = term_text(f)
                for other in _other_powers(k):
                    if other != k and (len(powers) > 1 or other != 0):
                        yield "factor", x * power(f, other - k), wrong_power(name, k, other), EXCHANGED
                yield from _other_waves(x, f, k)
                yield from _of_square(x, f, k)
            yield from _in_parallel(x, powers)
            for p, q in self._ratios(powers):
                yield from _of_ratio(x, p, q, powers[p])

    def _in_series(self, x: Node) -> Iterator[tuple[str, Scalar, str, float]]:
        """Constants a + b taken for a b/(a + b)."""
        terms = linear_terms(x) if x.op == "add" and {*symbols_of((x,))} <= {*self.also} else {}
        if len(terms) == 2 and None not in terms and all(c == 1 for c in terms.values()):
            a, b = terms
            series = over(a * b, x)  # type: ignore[operator]
            told = f"{term_text(series)} stands where {term_text(x)} is meant: what adds up is taken to act in series"
            yield "wrong_formula", series, told, TERMS

    def _ratios(self, powers: Powers) -> Iterator[tuple[Node, Node]]:
        """Parameters of one dimension of which one stands above and one below with the same power."""
        for p, k in powers.items():
            for q, n in powers.items():
                if k > 0 and k == -n and any(p in some and q in some for some in self.alike):
                    yield p, q


def _of_ratio(x: Node, p: Node, q: Node, k: Fraction) -> Iterator[tuple[str, Scalar, str, float]]:
    ratio, name = over(p, q), f"{p.name}/{q.name}"
    yield "factor", x * power(ratio, -k), f"the ratio {name} is missing", EXCHANGED
    yield "factor", x * power(ratio, -2 * k), f"the ratio {name} is turned over: {q.name}/{p.name} stands there", TERMS
    for other in dict.fromkeys((k - 1, k + 1, 2 * k, k / 2)):
        if other > 0 and other != k:
            told = (f"({name})" + (f"^{n}" if n != 1 else "") for n in (other, k))
            there, meant = told
            square = ": the square is missing" if 2 * other == k else ""
            yield "factor", x * power(ratio, other - k), f"{there} stands where {meant} is meant{square}", EXCHANGED


def _other_powers(k: Fraction) -> tuple[Fraction, ...]:
    """What people write for a power k, each once."""
    halved = (k / 2,) if (k / 2).denominator <= 2 else ()
    return tuple(dict.fromkeys((Fraction(0), k - 1 if k > 0 else k + 1, k + 1 if k > 0 else k - 1, -k, 2 * k, *halved)))


def _other_waves(x: Node, f: Node, k: Fraction) -> Iterator[tuple[str, Scalar, str, float]]:
    """Another function of the same angle."""
    for op in WAVES if f.op in WAVES else ():
        other = f.graph.call(op, f.args[0])
        if op != f.op and not is_zero(other):
            told = f"{op} stands for {f.op}({term_text(f.args[0])})"
            told += ": the angle is taken from the other axis" if "tan" not in (op, f.op) else ""
            yield "wrong_axis", x * power(over(other, f), k), told, TERMS


def power(x: Scalar, k: Fraction) -> Scalar:
    """x^k, k a multiple of 1/2."""
    if type(x) is not Node:
        return x
    if k.denominator == 1:
        n = int(k)
        return x**n if n >= 0 else over(1, x**-n)
    root: Scalar = x.graph.sqrt(x)
    return power(root, 2 * k)


def wrong_power(name: str, k: Fraction, other: Fraction) -> str:
    """In words that x^other stands where x^k is meant."""
    name = f"({name})" if any(c in name for c in " +-*/") and not name.endswith(")") else name
    if other == 0:
        return f"a factor {name} is missing" if k > 0 else f"a division by {name} is missing"
    if k == 0:
        return (
            f"a factor {_with_power(name, other)} is too many"
            if other > 0
            else f"a division by {_with_power(name, -other)} is too many"
        )
    there, meant = (_with_power(name, abs(x)) for x in (other, k))
    if k * other > 0:
        root = ": a root is missing" if k.denominator == 2 and other.denominator == 1 else ""
        square = ": the square is missing" if abs(k) == 2 and abs(other) == 1 else ""
        return f"{there} stands where {meant} is meant{root}{square}"
    does, should = ("multiplies", "divide") if other > 0 else ("divides", "multiply")
    return f"{there} {does} where {meant} should {should}"


def _with_power(name: str, k: Fraction) -> str:
    if k == 1:
        return name
    return f"sqrt({name})" if k == Fraction(1, 2) else f"{name}^{k}" if k.denominator == 1 else f"{name}^({k})"


def _of_square(x: Node, f: Node, k: Fraction) -> Iterator[tuple[str, Scalar, str, float]]:
    """The squares of the terms for the square of their sum."""
    terms = linear_terms(f) if k == 2 and f.op in ("add", "sub") else {}
    if len(terms) > 1:
        squares = sum((c * c * (1 if t is None else t * t) for t, c in terms.items()), start=0)
        told = f"of the square of {term_text(f)} the product is missing: the squares of its terms alone stand there"
        yield "missing_term", over(x * squares, f * f), told, TERMS


# -- sums ----------------------------------------------------------------------------------------


def _in_parallel(x: Node, powers: Powers) -> Iterator[tuple[str, Scalar, str, float]]:
    """a b/(a + b) taken for a + b."""
    for f, k in powers.items():
        terms = linear_terms(f) if k == -1 and f.op == "add" else {}
        if len(terms) == 2 and all(n is not None and c == 1 and powers.get(n, 0) >= 1 for n, c in terms.items()):
            a, b = terms
            told = f"{term_text(f)} stands where {term_text(over(a * b, f))} is meant: what acts in series is added"  # type: ignore[operator]
            yield "wrong_formula", over(x * f * f, a * b), told, TERMS  # type: ignore[operator]


def _of_sum(x: Node) -> Iterator[tuple[str, Scalar, str, float]]:
    if x.op not in ("add", "sub"):
        return
    terms = linear_terms(x)
    parts: list[Scalar] = [c * node if node is not None else c for node, c in terms.items()]
    for t in parts:
        name, what = term_text(t), "product" if is_product(t, parts) else "term"
        rank = TERMS if len(name) <= SHOWN else ODD
        yield "missing_term", x - t, f"the {what} {name} is missing", rank
        yield "sign", x - 2 * t, f"the sign of the term {name} is wrong", rank
        yield "factor", x + t, f"the term {name} stands with the factor 2", ODD
        yield "factor", x - over(t, 2), f"the term {name} stands with the factor 1/2", ODD
