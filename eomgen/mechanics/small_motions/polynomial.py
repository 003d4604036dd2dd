"""LinearEquations, exact -> characteristic polynomial, frequencies in closed form, Hurwitz, transfer functions.

    p(s) = det [ s 1 - F,  -E ;  K,  s M + C ],      of second order  p(s) = det(s^2 M + s C + K)
"""

from __future__ import annotations

from collections.abc import Collection, Iterator
from dataclasses import dataclass
from typing import Any

from eomgen.errors import DerivationError
from eomgen.mechanics.small_motions.field import Matrix
from eomgen.mechanics.small_motions.forms import is_second_order
from eomgen.mechanics.small_motions.reduction import LinearEquations
from eomgen.symbolic import cramer
from eomgen.symbolic.circular_equations import wave_free
from eomgen.symbolic.derivative import substituted, symbols_of
from eomgen.symbolic.expansion import Expansion
from eomgen.symbolic.factoring import factored, square_root
from eomgen.symbolic.functions import over, sqrt
from eomgen.symbolic.graph import Graph, Node, Scalar, is_zero
from eomgen.symbolic.normal_form import simplest
from eomgen.symbolic.solving import coefficients
from eomgen.symbolic.terms import Terms, TooLarge, plus

MOST = 6  # rows of a determinant that is written out
LIMIT = 50_000  # products of terms
MOST_CONDITIONS = 4  # degree of a polynomial whose Hurwitz determinants are written


@dataclass(frozen=True)
class Polynomial:
    """c0 + c1 s + c2 s^2 + ...: coefficients in that order, of the parameters."""

    coefficients: tuple[Scalar, ...]

    @property
    def degree(self) -> int:
        return len(self.coefficients) - 1

    @property
    def is_even(self) -> bool:
        """Whether only even powers occur: no motion grows or fades unless another fades or grows."""
        return all(is_zero(c) for c in self.coefficients[1::2])

    def at(self, s: Any) -> Any:
        """Its value."""
        total: Any = 0
        for c in reversed(self.coefficients):
            total = total * s + c
        return total


def graph_of(equations: LinearEquations) -> Graph:
    return equations.speeds[0].graph


def laplace_variable(equations: LinearEquations) -> Node:
    """A symbol s that the entries do not hold."""
    taken = {x.name for x in symbols_of([x for A in (equations.M, equations.C, equations.K, equations.B) for row in A
                                         for x in row])}  # fmt: skip
    return graph_of(equations).symbol(next(name for name in ("s", "s_", "s__", "s___") if name not in taken))


def characteristic_polynomial(equations: LinearEquations, positive: Collection[Node]) -> Polynomial | None:
    """p(s), common factors of its coefficients kept; None where it is too much work."""
    s = laplace_variable(equations)
    return polynomial_in(_determinant(_pencil(equations, s)), s, positive)


def _pencil(e: LinearEquations, s: Node) -> Matrix | None:
    """The matrix whose determinant is p(s); None where it is too large."""
    n = len(e.speeds)
    if is_second_order(e):
        return _of_second_order(e, s) if n <= MOST else None
    if n + len(e.coordinates) > MOST:
        return None
    upper = [[s * int(i == j) - x for j, x in enumerate(row)] + [-x for x in e.E[i]] for i, row in enumerate(e.F)]
    return upper + [[*e.K[i], *(s * m + c for m, c in zip(e.M[i], e.C[i], strict=True))] for i in range(n)]


def _of_second_order(e: LinearEquations, s: Node) -> Matrix:
    return [[s * s * m + s * c + k for m, c, k in zip(*rows, strict=True)] for rows in zip(e.M, e.C, e.K, strict=True)]


def _determinant(matrix: Matrix | None) -> Scalar | None:
    return None if matrix is None else cramer.determinant(matrix)


def polynomial_in(x: Scalar | None, s: Node, positive: Collection[Node]) -> Polynomial | None:
    """A polynomial in s by its coefficients; None where it is too much work."""
    if x is None:
        return None
    expansion = Expansion(s.graph, LIMIT, positive)
    expansion.of(s)
    try:
        parts = coefficients(expansion.of(x), s)
        powers = range(max(parts, default=0) + 1)
        found = [simplest(expansion.atoms.node(parts.get(n, {})), LIMIT, positive) for n in powers]
    except TooLarge:
        return None
    return Polynomial(tuple(found))


# -- frequencies ---------------------------------------------------------------------------------------------------


def closed_frequencies(polynomial: Polynomial, s: Node, positive: Collection[Node]) -> tuple[Scalar, ...]:
    """The angular frequencies Im s of roots that have a closed form, each once.

    Of factors c2 s^2 + c1 s + c0:          w = sqrt(4 c0 c2 - c1^2)/(2 |c2|)
    of factors c4 s^4 + c2 s^2 + c0:        w^2 = (c2 -+ sqrt(c2^2 - 4 c0 c4))/(2 c4)
    """
    found: list[Scalar] = []
    try:
        for squared in _squares(polynomial.at(s), s, positive):
            w = simplest(sqrt(squared), LIMIT, positive)
            if w not in found:
                found.append(w)
    except DerivationError:  # too large
        pass
    return tuple(found)


def _squares(x: Scalar, s: Node, positive: Collection[Node]) -> Iterator[Scalar]:
    """w^2 of every factor of which it is known."""
    expansion = Expansion(s.graph, LIMIT, positive)
    expansion.of(s)
    f, _ = expansion.cleared(expansion.of(x))
    f, fresh = wave_free(expansion, f)
    node = expansion.atoms.node

    def written(a: Scalar) -> Scalar:
        return simplest(substituted((a,), fresh)[0], LIMIT, positive)

    for part, _ in factored(f):
        c = coefficients(part, s)
        if max(c, default=0) == 2:
            squared = over(4 * node(c.get(0, {})) * node(c[2]) - node(c.get(1, {})) ** 2, 4 * node(c[2]) ** 2)
            yield from _possible(written(squared))
        elif max(c, default=0) == 4 and not c.get(1) and not c.get(3):
            root = _root(expansion, c, positive)
            for sign in (-1, 1):
                yield from _possible(written(over(node(c.get(2, {})) + sign * root, 2 * node(c[4]))))


def _possible(squared: Scalar) -> tuple[Scalar, ...]:
    """w^2, but for a number that has no root."""
    return () if type(squared) is not Node and squared < 0 else (squared,)


def _root(expansion: Expansion, c: dict[int, Terms], positive: Collection[Node]) -> Scalar:
    """sqrt(c2^2 - 4 c0 c4)"""
    middle = c.get(2, {})
    discriminant = plus(expansion.product(middle, middle), expansion.product(c.get(0, {}), c[4]), -4)
    whole = square_root(discriminant) if discriminant else {}
    node = expansion.atoms.node
    return sqrt(simplest(node(discriminant), LIMIT, positive)) if whole is None else node(whole)


# -- stability ------------------------------------------------------------------------------------------------------


def hurwitz_conditions(polynomial: Polynomial, positive: Collection[Node]) -> tuple[Scalar, ...]:
    """What must be positive for all roots to lie on the left: coefficients and Hurwitz determinants; () if too many.

    The leading coefficient is det M, which is positive.
    """
    n = polynomial.degree
    if not 0 < n <= MOST_CONDITIONS or polynomial.is_even:
        return ()
    a = list(reversed(polynomial.coefficients))  # a0 s^n + a1 s^(n-1) + ...

    def entry(i: int, j: int) -> Scalar:
        k = 2 * j - i + 1
        return a[k] if 0 <= k <= n else 0

    minors = [cramer.determinant([[entry(i, j) for j in range(m)] for i in range(m)]) for m in range(2, n)]
    conditions = [*polynomial.coefficients[:-1], *(simplest(x, LIMIT, positive) for x in minors)]
    return tuple(x for x in conditions if type(x) is Node or x <= 0)


# -- transfer functions ---------------------------------------------------------------------------------------------


@dataclass(frozen=True)
class TransferFunction:
    """q/w = above(s)/below(s), of one coordinate and one input."""

    coordinate: Node
    input: Node
    above: Polynomial
    below: Polynomial


def transfer_functions(e: LinearEquations, positive: Collection[Node]) -> tuple[TransferFunction, ...]:
    """From every input to every coordinate, by Cramer's rule; () where it is too much work."""
    if not e.inputs or not is_second_order(e) or len(e.speeds) > MOST:
        return ()
    s = laplace_variable(e)
    pencil = _of_second_order(e, s)
    below = polynomial_in(cramer.determinant(pencil), s, positive)
    found = []
    for k, w in enumerate(e.inputs):
        for j, q in enumerate(e.coordinates):
            column = [[e.B[i][k] if m == j else x for m, x in enumerate(row)] for i, row in enumerate(pencil)]
            above = polynomial_in(cramer.determinant(column), s, positive)
            if above is None or below is None:
                return ()
            found.append(TransferFunction(q, w, *_shortened(above, below, s, positive)))
    return tuple(found)


def _shortened(above: Polynomial, below: Polynomial, s: Node, positive: Collection[Node]
               ) -> tuple[Polynomial, Polynomial]:  # fmt: skip
    """Without the powers of s that they have in common."""
    a, b = list(above.coefficients), list(below.coefficients)
    while len(a) > 1 and len(b) > 1 and is_zero(a[0]) and is_zero(b[0]):
        a, b = a[1:], b[1:]
    return Polynomial(tuple(a)), Polynomial(tuple(b))
