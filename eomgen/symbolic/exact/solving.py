"""Equation, unknown -> its roots in closed form, as many as are known.

Equation, unknown -> its roots in closed form, as many as are known; nothing is guessed from numbers.

Known are: polynomials that split into factors of degree 1 and 2 in a power of x, equations in the sine and cosine of
one angle, in exponentials with one exponent, and those that a squaring or two rid of their roots, or a sign or two of
their magnitudes. Roots that these brought in are left out where numbers show that they are none.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Collection, Iterator
from dataclasses import replace
from math import comb, gcd
from random import Random

from eomgen.errors import DerivationError
from eomgen.frozen import dataclass
from eomgen.symbolic.exact.equality import equal_at_random_states
from eomgen.symbolic.exact.expansion import Expansion
from eomgen.symbolic.exact.normal_forms import sign_of_terms, simplest
from eomgen.symbolic.exact.polynomials import axes_of, factored, in_powers, square_root
from eomgen.symbolic.exact.terms import Monomial, Terms, common_monomial, terms_plus, terms_scaled
from eomgen.symbolic.expression import (
    Fraction,
    Node,
    Owner,
    Scalar,
    depends_on,
    order,
    over,
    substituted,
    symbols_of,
    tidy,
)
from eomgen.symbolic.numeric import FLOAT, Work, evaluate, tolerances

MOST_SQUARINGS = 2  # and signs of magnitudes
TRIES = 8  # random states at which a root is tried
INVERSE = {"log": "exp", "atan": "tan", "asin": "sin", "acos": "cos"}


def roots(
    equation: Scalar, unknown: Node, positive: Collection[Node] = (), limit: int = Work.ANSWER
) -> tuple[Scalar, ...]:
    """The real x with equation(x) = 0 that have a closed form; of an equation in angles those of one turn.

    Args:
        positive: symbols that stand for positive numbers.
        limit: products of terms for each step of the search.
    """
    if not depends_on(equation, (unknown,)):
        return ()
    assert type(equation) is Node
    found: list[Scalar] = []
    for candidate in _Search(unknown, frozenset(positive), limit).roots(_in_exponentials(equation, unknown)):
        x = simplest(candidate, limit, positive)
        if x not in found and _may_be_root(equation, unknown, x):
            found.append(x)
    return tuple(found)


def has_period(equation: Scalar, unknown: Node, period: Scalar) -> bool:
    """True if equation(x + period) is the same function as equation(x)."""
    (shifted,) = substituted((equation,), {unknown: unknown + period})
    return shifted is equation or vanishes(shifted - equation)


def vanishes(x: Scalar) -> bool:
    """True if x is 0 at all values of its symbols; False where it has a value at no state that was tried."""
    if type(x) is not Node:
        return x == 0
    try:
        return equal_at_random_states([(x, 0)]).equal
    except DerivationError:
        return False


@dataclass(frozen=True)
class _Search:
    """The search for what may be a root.

    Args:
        x: the unknown.
        positive: symbols that stand for positive numbers.
        limit: products of terms for each step.
        squarings: how often the equation may still be squared.
    """

    x: Node
    positive: frozenset[Node]
    limit: int
    squarings: int = MOST_SQUARINGS

    def roots(self, equation: Scalar) -> Iterator[Scalar]:
        """Root by root, factor by factor."""
        expansion = Expansion(self.x.graph, self.limit, self.positive)
        try:
            f, _ = expansion.cleared(expansion.of(equation))
            f, fresh = wave_free(expansion, f)
            for part in _factors(f):
                for root in self._of_factor(expansion, part, fresh):
                    yield substituted((root,), fresh)[0]
        except DerivationError:  # too large, or a value that is not real
            return

    def _of_factor(self, expansion: Expansion, f: Terms, fresh: dict[Node, Scalar]) -> Iterator[Scalar]:
        nodes = {expansion.atoms.nodes[atom] for monomial, _ in f for atom, _ in monomial if atom >= 0}
        holders = {node for node in nodes if depends_on(fresh.get(node, node), (self.x,))}
        if holders == {self.x}:
            return self._powers(expansion, f, self.x)
        simpler = self._simpler(expansion, f, fresh, holders)
        return (root for search, equation in simpler for root in search.roots(equation))

    def _simpler(
        self, expansion: Expansion, f: Terms, fresh: dict[Node, Scalar], holders: set[Node]
    ) -> Iterator[tuple[_Search, Scalar]]:
        """Equations that together have the roots of f: of an angle, an exponent, an argument; squared; with each sign.

        Args:
            holders: the functions in f, and symbols for functions, that hold the unknown.
        """
        atoms = expansion.atoms
        ops = {atoms.opaque[h.index].op for h in holders if h.index in atoms.opaque}
        once_more = replace(self, squarings=self.squarings - 1)
        if holders and holders <= fresh.keys():
            for angle, value in vanishing_angles(expansion, f, fresh, holders, self._powers):
                yield self, angle - value
        elif ops == {"exp"} and all(h.index in atoms.opaque for h in holders):
            for exponent, value in self._exponentials(expansion, f, holders):
                yield self, exponent - value
        elif "sqrt" in ops and self.squarings:
            root = next(h for h in holders if atoms.is_a(h.index, "sqrt"))
            yield once_more, substituted((atoms.node(_squared(expansion, f, root)),), fresh)[0]
        elif "abs" in ops and self.squarings:
            size = next(h for h in holders if atoms.is_a(h.index, "abs"))
            for x in (size.args[0], -size.args[0]):
                yield once_more, substituted(substituted((atoms.node(f),), {size: x}), fresh)[0]
        elif len(holders) == 1 and ops <= INVERSE.keys():
            (holder,) = holders
            for value in self._powers(expansion, f, holder):
                yield self, holder.args[0] - self.x.graph.call(INVERSE[holder.op], value)

    def _powers(self, expansion: Expansion, f: Terms, atom: Node) -> Iterator[Scalar]:
        """The values of the atom of which f = c0 + c1 y + c2 y^2 vanishes, y = atom^k."""
        parts = coefficients(f, atom)
        k = gcd(*parts)
        c0, c1, c2 = (parts.get(n * k, {}) for n in range(3))
        if k == 0 or max(parts) > 2 * k:
            return
        if not c0 and not c1:
            yield 0
            return
        node = expansion.atoms.node
        for y in self._quadratic(expansion, c0, c1, c2) if c2 else [-over(node(c0), node(c1))]:
            yield from self._unpowered(simplest(y, self.limit, self.positive), k)

    def _quadratic(self, expansion: Expansion, c0: Terms, c1: Terms, c2: Terms) -> Iterator[Scalar]:
        """(-c1 +- sqrt(c1^2 - 4 c0 c2))/(2 c2)"""
        discriminant = terms_plus(expansion.product(c1, c1), expansion.product(c0, c2), -4)
        node = expansion.atoms.node
        whole = square_root(discriminant) if discriminant else {}
        under = simplest(node(discriminant), self.limit, self.positive)
        root = self.x.graph.sqrt(under) if whole is None else node(whole)
        for sign in (1, -1):
            yield over(sign * root - node(c1), 2 * node(c2))

    def _unpowered(self, y: Scalar, k: int) -> Iterator[Scalar]:
        """The real x with x^k = y."""
        graph = self.x.graph
        if k == 1:
            yield y
        elif k == 2:
            if sign_of_terms(y, self.positive) != -1:
                yield from (graph.sqrt(y), -graph.sqrt(y))
        elif k > 2:
            yield graph.pow(y, Fraction(1, k))
            yield -graph.pow(-y if k % 2 else y, Fraction(1, k))

    def _exponentials(self, expansion: Expansion, f: Terms, holders: set[Node]) -> Iterator[tuple[Scalar, Scalar]]:
        """(e, log(z)): f is a polynomial in z = exp(e), whole powers of which all its exponentials are."""
        exponents = {h.index: expansion.atoms.opaque[h.index].arguments[0] for h in holders}
        unit = next(iter(exponents.values()))
        unit = terms_scaled(unit, -1) if unit[min(unit)] < 0 else unit
        multiples = {atom: _multiple(argument, unit) for atom, argument in exponents.items()}
        if not all(multiples.values()):
            return
        common = Fraction(1, math.lcm(*(c.denominator for c in multiples.values())))
        z = self.x.graph.symbol("(exp)")
        expansion.of(z)
        polynomial = _in_powers_of(f, {atom: int(c / common) for atom, c in multiples.items()}, z)
        exponent = expansion.atoms.node(terms_scaled(unit, tidy(common)))
        for part in _factors(polynomial):
            for value in self._powers(expansion, part, z):
                if type(value) is Node or value > 0:
                    yield exponent, self.x.graph.call("log", value)


def coefficients(f: Terms, atom: Node) -> dict[int, Terms]:
    """f = sum of part * atom^n, as {n: part}."""
    parts: dict[int, Terms] = {}
    for (monomial, w), c in f.items():
        n = dict(monomial).get(atom.index, 0)
        parts.setdefault(n, {})[tuple(item for item in monomial if item[0] != atom.index), w] = c
    return parts


def _factors(f: Terms) -> list[Terms]:
    """The factors of f, single atoms among them."""
    alone: list[Terms] = [{(((atom, 1),), ()): 1} for atom, e in common_monomial(f) if e > 0]
    return alone + [part for part, _ in factored(f)]


def _squared(expansion: Expansion, f: Terms, root: Node) -> Terms:
    """a^2 - b^2 g of f = a + b sqrt(g)."""
    parts = coefficients(f, root)
    a, b = parts.get(0, {}), parts.get(1, {})
    inside = expansion.atoms.opaque[root.index].arguments[0]
    return terms_plus(expansion.product(a, a), expansion.product(expansion.product(b, b), inside), -1)


def _multiple(a: Terms, unit: Terms) -> Fraction:
    """The number c with a = c unit; 0 where there is none."""
    key = next(iter(unit))
    c = Fraction(a.get(key, 0)) / unit[key]
    return Fraction(0) if terms_plus(a, unit, -c) else c


def _in_powers_of(f: Terms, powers: dict[int, int], z: Node) -> Terms:
    """f with z^powers[atom] for each of the atoms, without negative powers."""
    lowest = min(sum(e * powers.get(atom, 0) for atom, e in monomial) for monomial, _ in f)
    total: Terms = {}
    for (monomial, w), c in f.items():
        n = sum(e * powers.get(atom, 0) for atom, e in monomial) - lowest
        rest = [item for item in monomial if item[0] not in powers] + ([(z.index, n)] if n else [])
        total = terms_plus(total, {(tuple(sorted(rest)), w): c})
    return total


def _in_exponentials(equation: Node, x: Node) -> Scalar:
    """sinh, cosh and tanh of the unknown in exponentials."""
    known: dict[Node, Scalar] = {}
    for node in order((equation,)):
        if node.op in ("sinh", "cosh", "tanh") and depends_on(node, (x,)):
            z = x.graph.call("exp", node.args[0])
            up, down = over(z - over(1, z), 2), over(z + over(1, z), 2)
            known[node] = up if node.op == "sinh" else down if node.op == "cosh" else over(up, down)
    return substituted((equation,), known)[0] if known else equation


def _may_be_root(equation: Scalar, unknown: Node, x: Scalar) -> bool:
    """False where numbers show that x is no root: values of the residual, and none of them zero."""
    try:
        (residual,) = substituted((equation,), {unknown: x})
    except DerivationError:  # a division by zero
        return False
    rng = Random(1)
    symbols = symbols_of((residual,))
    states = ({symbol: rng.uniform(0.5, 2.0) for symbol in symbols} for _ in range(TRIES))
    values = [value for state in states if math.isfinite(value := evaluate((residual,), state, FLOAT)[0])]
    return min(map(abs, values)) < tolerances.NEAR_ROOT if values else bool(symbols)


# -------- circular equations ----------------------------------------------------------------------------------
# Polynomials in the sine and cosine of one angle -> the angles at which they vanish.


PowersIn = Callable[[Expansion, Terms, Node], Iterator[Scalar]]
"""(expansion, f, atom) -> the values of the atom at which f, a polynomial in it, vanishes."""


def wave_free(expansion: Expansion, f: Terms) -> tuple[Terms, dict[Node, Scalar]]:
    """(f with symbols C, S for the cosine and sine of each angle and S^2 eliminated, {symbol: what it stands for})."""
    axes = axes_of(w for _, w in f)
    fresh: dict[Node, Scalar] = {}
    for i, axis in enumerate(axes):
        for name in ("cos", "sin"):
            symbol = expansion.graph.symbol(f"({name} {i})")
            expansion.of(symbol)
            fresh[symbol] = expansion.atoms.wave_node(name, axis)
    total: Terms = {}
    for monomial, powers, c in in_powers(f, axes):
        added = [(symbol.index, e) for symbol, e in zip(fresh, powers, strict=True) if e]
        total = terms_plus(total, {(tuple(sorted((*monomial, *added))), ()): c})
    return total, fresh


def vanishing_angles(
    expansion: Expansion, f: Terms, fresh: dict[Node, Scalar], holders: set[Node], powers: PowersIn
) -> Iterator[tuple[Scalar, Scalar]]:
    """(angle, value): f vanishes where the angle has the value; none where more than one angle is in f.

    Args:
        f: wave-free; irreducible as a polynomial in C, S and the other atoms.
        fresh: what C and S stand for, pair by pair.
        holders: those of them that are in question.
    """
    symbols = iter(fresh)
    pairs = [(C, S) for C, S in zip(symbols, symbols, strict=True) if holders & {C, S}]
    angle = _angle(fresh[pairs[0][0]], fresh[pairs[0][1]]) if len(pairs) == 1 else None
    if angle is not None:
        for value in _values(expansion, f, pairs[0], fresh, powers):
            yield angle, value


def _angle(cosine: Scalar, sine: Scalar) -> Scalar | None:
    """The angle that both are of; the sine of -x is kept as -sin(x)."""
    if type(cosine) is not Node or cosine.op != "cos":
        return None
    angle = cosine.args[0]
    return next((x for x in (angle, -angle) if sine is x.graph.call("sin", x)), None)


def _values(
    expansion: Expansion, f: Terms, pair: tuple[Node, Node], fresh: dict[Node, Scalar], powers: PowersIn
) -> Iterator[Scalar]:
    graph, (C, S) = expansion.graph, pair
    held = {atom for monomial, _ in f for atom, _ in monomial}
    if S.index not in held:
        for c in powers(expansion, f, C):
            angle = _inverse(graph, "cos", substituted((c,), fresh)[0])
            yield from (angle, -angle)
    elif C.index not in held:
        for s in powers(expansion, f, S):
            angle = _inverse(graph, "sin", substituted((s,), fresh)[0])
            yield from (angle, graph.pi - angle)
    elif (ratio := _tangent(expansion, f, C, S)) is not None:
        angle = graph.call("atan", ratio)
        yield from (angle, angle + graph.pi)
    else:
        parts = [part for part, _ in factored(_in_sines(expansion, f, C, S))]
        if any(C.index not in {atom for monomial, _ in part for atom, _ in monomial} for part in parts):
            for part in parts:
                yield from _values(expansion, part, (C, S), fresh, powers)
        else:
            yield from _by_half_angle(expansion, f, C, S, powers)


def _inverse(graph: Owner, name: str, value: Scalar) -> Scalar:
    """One angle with this cosine or sine: of cos(y) it is y."""
    if type(value) is Node and value.op == name:
        angle: Scalar = value.args[0]
        return angle
    return graph.call("a" + name, value)


def _tangent(expansion: Expansion, f: Terms, C: Node, S: Node) -> Scalar | None:
    """-a/b of f = a C + b S; None for any other f."""
    a, b = _share(f, C), _share(f, S)
    if len(a) + len(b) < len(f) or any({C.index, S.index} & {atom for atom, _ in m} for m, _ in (*a, *b)):
        return None
    return -over(expansion.atoms.node(a), expansion.atoms.node(b))


def _share(f: Terms, atom: Node) -> Terms:
    """The terms that hold the atom once, without it."""
    one = (atom.index, 1)
    return {(tuple(item for item in m if item != one), w): c for (m, w), c in f.items() if one in m}


def _in_sines(expansion: Expansion, f: Terms, C: Node, S: Node) -> Terms:
    """f with C^2 = 1 - S^2 in place of S^2 = 1 - C^2."""
    total: Terms = {}
    for (monomial, w), c in f.items():
        exponents = dict(monomial)
        n = exponents.pop(C.index, 0)
        if n % 2:
            exponents[C.index] = 1
        rest: Terms = {(tuple(sorted(exponents.items())), w): c}
        square: Terms = {((), ()): 1, (((S.index, 2),), ()): -1}
        total = terms_plus(total, expansion.product(rest, expansion.power(square, n // 2)))
    return total


def _by_half_angle(expansion: Expansion, f: Terms, C: Node, S: Node, powers: PowersIn) -> Iterator[Scalar]:
    """2 atan(tau) with C = (1 - tau^2)/(1 + tau^2), S = 2 tau/(1 + tau^2); pi where f vanishes there."""
    tau = expansion.graph.symbol("(tan of half)")
    expansion.of(tau)
    degree = max(_degree(m, C) + _degree(m, S) for m, _ in f)
    polynomial: Terms = {}
    at_pi: Terms = {}
    for (monomial, w), c in f.items():
        n, k = _degree(monomial, C), _degree(monomial, S)
        rest: Terms = {(tuple(item for item in monomial if item[0] not in (C.index, S.index)), w): c}
        if k == 0:
            at_pi = terms_plus(at_pi, rest, (-1) ** n)
        polynomial = terms_plus(polynomial, expansion.product(rest, _half_angle_powers(tau, n, k, degree)))
    if not at_pi:
        yield expansion.graph.pi
    for part, _ in factored(polynomial):
        for root in powers(expansion, part, tau):
            yield 2 * expansion.graph.call("atan", root)
    if all(_degree(m, tau) for m, _ in polynomial):
        yield 0


def _half_angle_powers(tau: Node, n: int, k: int, degree: int) -> Terms:
    """(1 - tau^2)^n (2 tau)^k (1 + tau^2)^(degree - n - k)"""
    total: Terms = {}
    for i in range(n + 1):
        for j in range(degree - n - k + 1):
            e = 2 * i + 2 * j + k
            c = (-1) ** i * comb(n, i) * comb(degree - n - k, j) * 2**k
            total = terms_plus(total, {(((tau.index, e),) if e else (), ()): c})
    return total


def _degree(monomial: Monomial, atom: Node) -> int:
    return dict(monomial).get(atom.index, 0)
