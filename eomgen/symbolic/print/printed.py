"""Node -> the products of its sum with the signs and roots of a textbook. Text and LaTeX print from here."""

from __future__ import annotations

from collections.abc import Container
from math import gcd
from typing import Any

from eomgen.symbolic.expression.exact_numbers import tidy
from eomgen.symbolic.expression.graph import Node, Scalar
from eomgen.symbolic.expression.node import SUMS, holds_op
from eomgen.symbolic.expression.rational import Fraction
from eomgen.symbolic.expression.traversal import order
from eomgen.symbolic.print.decimals import decimal_of
from eomgen.symbolic.print.layout import Factor, Product, is_base, plus_first, product_of, products_of, terms

TRIGONOMETRIC = frozenset("sin cos tan sinh cosh tanh".split())
_OTHER = {"sin": "cos", "cos": "sin"}


def summands(x: Scalar, named: Container[Node] = ()) -> list[Product]:
    """x as a sum of products for print, in the order of `terms`.

    k*(1 - l/r) rather than -k*(l/r - 1), sqrt(14*l/3) rather than 1/3*sqrt(42*l), tan(x) rather than sin(x)/cos(x),
    and k*(b - a) rather than -k*(a - b) where that is all.
    """
    found = terms(x, named)
    alone = len(found) == 1
    known: dict[Any, tuple[Product, bool]] = {} if named or type(x) is not Node else x.graph.found(summands)
    for term in found:
        if (term, alone) not in known:
            product = product_of(term, named)
            known[term, alone] = _for_people(product, named, alone=alone), product.coefficient > 0
    products = [known[term, alone] for term in found]
    first = next((i for i, (_, plus) in enumerate(products) if plus), 0)
    return plus_first([product for product, _ in (products[first], *products[:first], *products[first + 1 :])])


def _for_people(product: Product, named: Container[Node], *, alone: bool) -> Product:
    return _with_shorter_roots(_with_plus(_with_tangents(product, named), named, alone=alone), named)


def _with_tangents(product: Product, named: Container[Node]) -> Product:
    """sin(a)/cos(a) as tan(a), cos(a)^2/sin(a) as cos(a)/tan(a); sin(a)/cos(a)^2 as it is."""
    for below, n in product.denominator:
        if (other := _OTHER.get(below.op)) is None or below in named:
            continue
        for above, m in product.numerator:
            if above.op == other and above.args[0] is below.args[0] and m >= n and above not in named:
                tangent = (_for_print(above, above.args, "tan"), n)
                rest = [(above, m - n)] if m > n else []
                top, bottom = (rest, [tangent]) if other == "cos" else ([*rest, tangent], [])
                product = Product(
                    product.coefficient,
                    _replaced(product.numerator, above, top),
                    _replaced(product.denominator, below, bottom),
                )
    return product


def _replaced(factors: tuple[Factor, ...], base: Node, by: list[Factor]) -> tuple[Factor, ...]:
    return tuple(f for factor in factors for f in (by if factor[0] is base else [factor]))


def _with_plus(product: Product, named: Container[Node], *, alone: bool) -> Product:
    """-k/(a - b) as k/(b - a), and where it stands alone -k (a - b) as k (b - a); else as it is."""
    if product.coefficient > 0:
        return product
    above, below = (_turned(factors, named) for factors in (product.numerator, product.denominator))
    if alone and above is not None:
        return Product(-product.coefficient, above, product.denominator)
    return product if below is None else Product(-product.coefficient, product.numerator, below)


def _turned(factors: tuple[Factor, ...], named: Container[Node]) -> tuple[Factor, ...] | None:
    """The factors with the sign of one difference changed; None where none of them is one."""
    for i, (base, exponent) in enumerate(factors):
        if exponent % 2 and base.op == "sub" and base not in named:
            return (*factors[:i], (_for_print(base, base.args[::-1]), exponent), *factors[i + 1 :])
    return None


def is_bare_argument(op: str, x: Scalar) -> bool:
    """Whether x stands behind the function without parentheses: sin x, and of an angle cos 2 x and sin omega t."""
    if type(x) is not Node:
        return False
    if is_base(x) or op not in TRIGONOMETRIC:
        return x.op in ("symbol", "pi")
    alone, *others = products_of(x)
    bases = [factor for factor in (*alone.numerator, *alone.denominator)]
    return not others and alone.coefficient > 0 and all(base.op in ("symbol", "pi") and e == 1 for base, e in bases)


def _with_shorter_roots(product: Product, named: Container[Node]) -> Product:
    """What the number below the line and the number under a root share goes under the root.

    k/(g d) sqrt(g n x) = k/d sqrt(n x/g)
    """
    c = product.coefficient
    above = list(product.numerator)
    for i, (base, exponent) in enumerate(above):
        inside = _number_under(base)
        share = gcd(inside, c.denominator)
        if exponent == 1 and share > 1 and base not in named and decimal_of(c) is None:
            rest = base.graph.mul(Fraction(inside, share * share), base.args[0].args[1])
            above[i] = (_for_print(base, (rest,)), 1)
            c = tidy(Fraction(c) * share)
    return Product(c, tuple(above), product.denominator)


def _for_print(base: Node, args: tuple[Scalar, ...], op: str | None = None) -> Node:
    """An operation as the graph would not hold it; the graph does not learn of it."""
    return Node(base.graph, op or base.op, args, base.index)


def _number_under(base: Node) -> int:
    """The whole number c of sqrt(c x); 1 where there is none."""
    inside = base.args[0] if base.op == "sqrt" else None
    if type(inside) is Node and inside.op == "mul" and type(inside.args[0]) is int:
        return inside.args[0]
    return 1


def has_nested_quotient(x: Scalar) -> bool:
    """True where a sum in a quotient has quotients itself, (a + b/c)/d, functions not looked into."""
    if not holds_op(x, "div") or not any(_is_of_sums(node) for node in order((x,))):
        return False
    stack: list[tuple[Scalar, bool]] = [(x, False)]
    seen = set()
    while stack:
        entry = stack.pop()
        node, within = entry
        if not isinstance(node, Node) or is_base(node) or entry in seen:
            continue
        seen.add(entry)
        for product in summands(node):
            broken = product.coefficient.denominator > 1 and decimal_of(product.coefficient) is None
            if within and (product.denominator or broken):
                return True
            sums = [base for base, _ in (*product.numerator, *product.denominator) if base.op in SUMS]
            stack += [(base, within or bool(product.denominator)) for base in sums]
    return False


def _is_of_sums(x: Node) -> bool:
    """Whether x is a product, quotient or power of which a part is a sum."""
    return x.op in ("mul", "div", "pow") and any(type(a) is Node and a.op in SUMS for a in x.args)
