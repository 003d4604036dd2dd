"""Polynomials in one variable whose coefficients are formulas: roots in closed form, and when all lie on the left."""

from __future__ import annotations

from collections.abc import Callable, Collection, Iterable, Iterator, Mapping
from typing import Any

from eomgen.errors import DerivationError
from eomgen.frozen import dataclass
from eomgen.symbolic.exact import cramer
from eomgen.symbolic.exact.expansion import Expansion
from eomgen.symbolic.exact.normal_forms import simplest, simplest_sum, written_shortest
from eomgen.symbolic.exact.polynomials import factored, square_root
from eomgen.symbolic.exact.quotient import reduced
from eomgen.symbolic.exact.solving import coefficients, wave_free
from eomgen.symbolic.exact.terms import Key, Terms, TooLarge, content, terms_plus, terms_scaled
from eomgen.symbolic.expression import Node, Number, Scalar, is_zero, over, sqrt, substituted
from eomgen.symbolic.numeric import Work, evaluate, fifty_digits
from eomgen.symbolic.print import text_size

LONG = 24_000  # characters of a polynomial, as it came, that comes to no formula which anybody prints or solves


@dataclass(frozen=True)
class Polynomial:
    """c0 + c1 s + c2 s^2 + ...: coefficients in that order, of the parameters, or floats."""

    coefficients: tuple[Any, ...]

    @property
    def degree(self) -> int:
        return len(self.coefficients) - 1

    @property
    def is_long(self) -> bool:
        """True if its coefficients are too long for any formula."""
        return sum(map(text_size, self.coefficients)) > LONG

    @property
    def is_even(self) -> bool:
        """True if only even powers occur: the roots come in pairs +s and -s."""
        return all(is_zero(c) for c in self.coefficients[1::2])

    def at(self, s: Any) -> Any:
        """Its value."""
        total: Any = 0
        for c in reversed(self.coefficients):
            total = total * s + c
        return total

    def negative(self, positive: Collection[Node]) -> Polynomial:
        """-p(s), of exact coefficients."""
        return Polynomial(tuple(simplest(-c, Work.ANSWER, positive) for c in self.coefficients))

    @classmethod
    def of(cls, x: Scalar | None, s: Node, positive: Collection[Node], *, in_full: bool = True) -> Polynomial | None:
        """A polynomial in s by its coefficients; None where it is too much work."""
        if x is None:
            return None
        expansion = Expansion(s.graph, Work.ANSWER, positive)
        expansion.of(s)
        try:
            parts = coefficients(expansion.of(x), s)
        except TooLarge:
            return None
        terms = [parts.get(n, {}) for n in range(max(parts, default=0) + 1)]
        if not in_full and _stays_long(expansion, terms):
            return Polynomial(tuple(map(expansion.atoms.node, terms)))
        return Polynomial(tuple(simplest_sum(expansion, each) for each in terms))

    def over(self, below: Polynomial, s: Node, positive: Collection[Node]) -> tuple[Polynomial, Polynomial] | None:
        """(numerator, denominator) of self / below without common factors; None where it is too much work."""
        expansion = Expansion(s.graph, Work.ANSWER, positive)
        expansion.of(s)
        try:
            parts = reduced(expansion, expansion.of(over(self.at(s), below.at(s))))
        except TooLarge:
            return None
        numerator, denominator = (Polynomial.of(expansion.atoms.node(part), s, positive) for part in parts)
        return None if numerator is None or denominator is None else (numerator, denominator)

    def frequencies(self, s: Node, positive: Collection[Node]) -> tuple[Scalar, ...]:
        """The angular frequencies Im s of roots that have a closed form, each once.

        Of factors c2 s^2 + c1 s + c0:          w = sqrt(4 c0 c2 - c1^2)/(2 |c2|)
        of factors c4 s^4 + c2 s^2 + c0:        w^2 = (c2 -+ sqrt(c2^2 - 4 c0 c4))/(2 c4)
        with a root less, q^2 = c0 c4:          w = (sqrt((c2 + 2 q)/c4) -+ sqrt((c2 - 2 q)/c4))/2
        """
        found: list[Scalar] = []
        try:
            for w in _frequencies(self.at(s), s, positive):
                w = simplest(w, Work.ANSWER, positive)
                if w not in found:
                    found.append(w)
        except DerivationError:  # too large
            pass
        return tuple(found)

    def conditions(
        self,
        s: Node,
        positive: Collection[Node],
        trial: Mapping[Node, Any],
        *,
        conservative: bool,
        in_full: bool = True,
    ) -> Conditions:
        """Routh-Hurwitz conditions for each factor of p(s), in the shorter form of Lienard and Chipart.

        All coefficients and every other Hurwitz determinant are positive. For an even factor: all s^2 are real and
        negative.

        Args:
            trial: values of the parameters: leading coefficients have the same signs everywhere as there, as det M
                does.
            conservative: True if all s^2 are real in any case.
            in_full: True if the conditions of a long polynomial are brought into their shortest form too.
        Source: Gantmacher, The Theory of Matrices, vol. 2, chapter 15.
        """
        zeros = next(k for k, c in enumerate(self.coefficients) if not is_zero(c))
        factors, legibly = [], in_full or not self.is_long
        for factor in _polynomials(Polynomial(self.coefficients[zeros:]), s, positive, legibly):
            leading = evaluate((factor.coefficients[-1],), trial, fifty_digits())[0]
            one = factor if leading > 0 else factor.negative(positive)
            if one not in factors:
                factors.append(one)
        found = [_conditions(one, conservative) for one in factors]
        if any(x is None for x in found):
            return Conditions()
        each = (_without_number(x, positive, legibly) for part in found for x in part or ())
        expressions = dict.fromkeys(x for x in each if type(x) is Node or x <= 0)
        even = [one.is_even for one in factors]
        return Conditions(tuple(expressions), not all(even), any(even), zeros)


def _stays_long(expansion: Expansion, terms: Iterable[Terms]) -> bool:
    """True if the sums are long, and no common divisor could make them short."""
    divided = any(e < 0 and expansion.atoms.is_a(a, "sum") for each in terms for m, _ in each for a, e in m)
    return not divided and sum(text_size(expansion.atoms.node(each)) for each in terms) > LONG


# -- frequencies ---------------------------------------------------------------------------------------------------


@dataclass(frozen=True)
class PolynomialFactors:
    """The factors of a polynomial in s.

    Args:
        expansion: whose atoms stand in them.
        parts: of each the coefficients by the power of s.
        fresh: what stands for sines and cosines.
        positive: parameters that are.
    """

    expansion: Expansion
    parts: tuple[dict[int, Terms], ...]
    fresh: Mapping[Node, Scalar]
    positive: Collection[Node]

    def written(self, a: Scalar) -> Scalar:
        """The scalar in the symbols of the model, in its simplest form."""
        return simplest(self.as_it_came(a), Work.ANSWER, self.positive)

    def as_it_came(self, a: Scalar) -> Scalar:
        """The scalar in the symbols of the model, not simplified."""
        return substituted((a,), self.fresh)[0]


def factors_of(x: Scalar, s: Node, positive: Collection[Node]) -> PolynomialFactors:
    """Factors of x that hold s, each as often as it occurs.

    Raises:
        TooLarge: it is too much work.
    """
    expansion = Expansion(s.graph, Work.ANSWER, positive)
    expansion.of(s)
    f, _ = expansion.cleared(expansion.of(x))
    f, fresh = wave_free(expansion, f)
    found = ((coefficients(part, s), n) for part, n in factored(f))
    return PolynomialFactors(
        expansion, tuple(c for c, n in found for _ in range(n) if max(c, default=0)), fresh, positive
    )


def _frequencies(x: Scalar, s: Node, positive: Collection[Node]) -> Iterator[Scalar]:
    """w of every factor of which it is known."""
    factors = factors_of(x, s, positive)
    expansion, written = factors.expansion, factors.written
    node = expansion.atoms.node
    for c in factors.parts:
        if max(c) == 2:
            squared = over(4 * node(c.get(0, {})) * node(c[2]) - node(c.get(1, {})) ** 2, 4 * node(c[2]) ** 2)
            yield from _rooted(written(squared))
        elif max(c) == 4 and not c.get(1) and not c.get(3):
            yield from (w for squared in _squares(expansion, c, positive) for w in _rooted(written(squared)))
            yield from _of_single_roots(expansion, c, written)


def _rooted(squared: Scalar) -> tuple[Scalar, ...]:
    """w of w^2, but for a number that has no root."""
    return () if type(squared) is not Node and squared < 0 else (sqrt(squared),)


def _squares(expansion: Expansion, c: dict[int, Terms], positive: Collection[Node]) -> tuple[Scalar, ...]:
    """(c2 -+ sqrt(c2^2 - 4 c0 c4))/(2 c4); () where w has roots that do not stand in one another."""
    node, middle = expansion.atoms.node, c.get(2, {})
    discriminant = terms_plus(expansion.product(middle, middle), expansion.product(c.get(0, {}), c[4]), -4)
    whole = square_root(discriminant) if discriminant else {}
    if whole is None and _single_roots(expansion, c):
        return ()
    root = sqrt(simplest(node(discriminant), Work.ANSWER, positive)) if whole is None else node(whole)
    return tuple(over(node(middle) + sign * root, 2 * node(c[4])) for sign in (-1, 1))


def _single_roots(expansion: Expansion, c: dict[int, Terms]) -> tuple[Terms, ...]:
    """c2 -+ 2 q, q^2 = c0 c4, where one of them by c4 is a square; () elsewhere."""
    q = square_root(expansion.product(c[0], c[4])) if c.get(0) else None
    if q is None:
        return ()
    parts = tuple(terms_plus(c.get(2, {}), q, factor) for factor in (2, -2))
    whole = [not x or square_root(expansion.product(x, c[4])) is not None for x in parts]
    return parts if any(whole) else ()


def _of_single_roots(
    expansion: Expansion, c: dict[int, Terms], written: Callable[[Scalar], Scalar]
) -> Iterator[Scalar]:
    """w where its roots do not stand in one another; of the difference both signs."""
    node = expansion.atoms.node
    squares = [written(over(node(x), node(c[4]))) for x in _single_roots(expansion, c)]
    roots = [w for squared in squares for w in _rooted(squared)]
    if len(roots) == 2:
        a, b = roots
        yield from (over(a + b, 2), over(a - b, 2), over(b - a, 2))


# -------- conditions ------------------------------------------------------------------------------------------
# Polynomial -> what must be positive for its roots to lie on the left, or on the imaginary axis: Routh and Hurwitz.


MOST_CONDITIONS = 6  # degree of a polynomial whose Hurwitz determinants are written
LONGER = 5_000  # characters of a condition, as it came, that comes to no formula which anybody prints
MOST_EVEN = 4  # degree in s^2 of one whose coefficients are written as conditions


@dataclass(frozen=True)
class Conditions:
    """Conditions of stability: expressions that must be positive.

    Args:
        expressions: for all motions to fade; those of even factors of p(s) to oscillate.
        fading, oscillating: True if p(s) has factors of this kind.
        zeros: the order of the root s = 0: motions that stay as they are, of which nothing is said.
    """

    expressions: tuple[Scalar, ...] = ()
    fading: bool = False
    oscillating: bool = False
    zeros: int = 0

    @property
    def words(self) -> str:
        """Behaviour of all motions under the conditions: "oscillate", "fade" or both."""
        said = [word for word, holds in (("oscillate", self.oscillating), ("fade", self.fading)) if holds]
        return " or ".join(said)


def _without_number(x: Scalar, positive: Collection[Node], legibly: bool) -> Scalar:
    """A positive multiple of x, its coefficients whole numbers without a common factor."""
    if type(x) is not Node:
        return x
    expansion, terms = Expansion(x.graph, Work.VALUE, positive), dict[Key, Number]()
    try:
        terms = expansion.of(x)
        bare = terms_scaled(terms, 1 / content(terms))
        plain = 0 if legibly else expansion.atoms.node(bare)
        return plain if text_size(plain) > LONGER else written_shortest(expansion, bare)
    except TooLarge:
        return over(x, content(terms)) if terms else x


def _polynomials(polynomial: Polynomial, s: Node, positive: Collection[Node], legibly: bool) -> Iterator[Polynomial]:
    """The factors of p(s); itself where it is too much work."""
    try:
        factors = factors_of(polynomial.at(s), s, positive)
    except TooLarge:
        yield polynomial
        return
    node, said = factors.expansion.atoms.node, factors.written if legibly else factors.as_it_came
    for c in factors.parts:
        yield Polynomial(tuple(said(node(c.get(k, {}))) for k in range(max(c) + 1)))


def _conditions(polynomial: Polynomial, conservative: bool) -> list[Scalar] | None:
    """Expressions that must be positive for one factor; None where they are too long to be written."""
    n, c = polynomial.degree, polynomial.coefficients
    if not polynomial.is_even:
        return [*c[:-1], *_determinants(polynomial)] if n <= MOST_CONDITIONS else None
    even = c[::2]
    if conservative:
        return [*even[:-1]] if n <= 2 * MOST_EVEN else None
    return [*even[:-1], DISCRIMINANTS[len(even) - 2](*even)] if n <= 2 * len(DISCRIMINANTS) else None


DISCRIMINANTS: tuple[Callable[..., Scalar], ...] = (
    lambda c, a: 1,
    lambda c, b, a: b * b - 4 * a * c,
    lambda d, c, b, a: 18 * a * b * c * d - 4 * b * b * b * d + b * b * c * c - 4 * a * c * c * c - 27 * a * a * d * d,
)
"""Of polynomials in s^2 of degree 1, 2, 3, the constant first: positive where all roots are real."""


def _determinants(polynomial: Polynomial) -> list[Scalar]:
    """Hurwitz' determinants of n - 1, n - 3, ... rows."""
    n = polynomial.degree
    a = list(reversed(polynomial.coefficients))  # a0 s^n + a1 s^(n-1) + ...

    def entry(i: int, j: int) -> Scalar:
        k = 2 * j - i + 1
        return a[k] if 0 <= k <= n else 0

    sizes = range(2 + (n - 1) % 2, n, 2)
    return [cramer.determinant([[entry(i, j) for j in range(m)] for i in range(m)]) for m in sizes]
