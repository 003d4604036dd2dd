"""Node -> the products of its sum with the signs and roots of a textbook. Text and LaTeX print from here."""

from __future__ import annotations

from collections.abc import Container
from math import gcd

from eomgen.symbolic.expression.exact_numbers import tidy
from eomgen.symbolic.expression.graph import Node, Scalar
from eomgen.symbolic.expression.rational import Fraction
from eomgen.symbolic.print.decimals import decimal_of
from eomgen.symbolic.print.layout import Factor, Product, plus_first, products_of


def summands(x: Scalar, named: Container[Node] = ()) -> list[Product]:
    """x as a sum of products for print, in the order of `terms`.

    k*(1 - l/r) rather than -k*(l/r - 1), sqrt(14*l/3) rather than 1/3*sqrt(42*l), and k*(b - a) rather than
    -k*(a - b) where that is all.
    """
    products = products_of(x, named)
    alone = len(products) == 1
    return plus_first([_with_shorter_roots(_with_plus(p, named, alone=alone), named) for p in products])


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


def _for_print(base: Node, args: tuple[Scalar, ...]) -> Node:
    """The operation at other arguments, as the graph would not hold it; the graph does not learn of it."""
    return Node(base.graph, base.op, args, base.index)


def _number_under(base: Node) -> int:
    """The whole number c of sqrt(c x); 1 where there is none."""
    inside = base.args[0] if base.op == "sqrt" else None
    if type(inside) is Node and inside.op == "mul" and type(inside.args[0]) is int:
        return inside.args[0]
    return 1
