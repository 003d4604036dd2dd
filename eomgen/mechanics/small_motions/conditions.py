"""Characteristic polynomial -> what must be positive for small motions to fade or to oscillate: Routh and Hurwitz."""

from __future__ import annotations

from collections.abc import Callable, Collection, Iterator, Mapping
from typing import Any

from eomgen.mechanics.small_motions.polynomial import Polynomial, factors_of
from eomgen.records import dataclass
from eomgen.symbolic.exact.expansion import Expansion
from eomgen.symbolic.exact.normal_form import written_shortest
from eomgen.symbolic.exact.terms import Key, TooLarge, content, terms_scaled
from eomgen.symbolic.expression.functions import over
from eomgen.symbolic.expression.graph import Node, Number, Scalar, is_zero
from eomgen.symbolic.numeric.evaluation import evaluate, fifty_digits
from eomgen.symbolic.numeric.work import Work
from eomgen.symbolic.print.text import text_size
from eomgen.symbolic.solve import cramer

MOST_CONDITIONS = 6  # degree of a polynomial whose Hurwitz determinants are written
LONGER = 5_000  # characters of a condition, as it came, that comes to no formula which anybody prints
MOST_EVEN = 4  # degree in s^2 of one whose coefficients are written as conditions


@dataclass(frozen=True)
class Conditions:
    """What must be positive.

    Args:
        expressions: for all motions to fade; those of even factors of p(s) to oscillate.
        fading, oscillating: whether there are factors of which it is said.
        zeros: how many times p(s) holds the factor s: motions that stay as they are, of which nothing is said.
    """

    expressions: tuple[Scalar, ...] = ()
    fading: bool = False
    oscillating: bool = False
    zeros: int = 0

    @property
    def words(self) -> str:
        """What all motions then do."""
        said = [word for word, holds in (("oscillate", self.oscillating), ("fade", self.fading)) if holds]
        return " or ".join(said)


def stability_conditions(
    polynomial: Polynomial,
    s: Node,
    positive: Collection[Node],
    trial: Mapping[Node, Any],
    *,
    conservative: bool,
    in_full: bool = True,
) -> Conditions:
    """Of Routh and Hurwitz for each factor of p(s), in the fewer ones of Lienard and Chipart: all coefficients, every
    other determinant. Of an even factor, what makes all s^2 real and negative.

    Args:
        trial: values of the parameters: leading coefficients keep the signs that they have there, as det M does.
        conservative: whether all s^2 are real in any case.
        in_full: whether those of a long polynomial are brought into their shortest form too.
    Source: Gantmacher, The Theory of Matrices, vol. 2, chapter 15.
    """
    zeros = next(k for k, c in enumerate(polynomial.coefficients) if not is_zero(c))
    factors, legibly = [], in_full or not polynomial.is_long
    for factor in _polynomials(Polynomial(polynomial.coefficients[zeros:]), s, positive, legibly):
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
    """What must be positive; None where that is too long to be written."""
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
