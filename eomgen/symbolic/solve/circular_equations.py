"""Polynomials in the sine and cosine of one angle -> the angles at which they vanish."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from math import comb

from eomgen.symbolic.exact.expansion import Expansion
from eomgen.symbolic.exact.factoring import factored
from eomgen.symbolic.exact.powers import axes_of, in_powers
from eomgen.symbolic.exact.terms import Monomial, Terms, terms_plus
from eomgen.symbolic.expression.derivative import substituted
from eomgen.symbolic.expression.functions import over
from eomgen.symbolic.expression.graph import Node, Scalar
from eomgen.symbolic.expression.node import Owner, argument

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
        return argument(value, 0)
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
