"""What a product is made of: its number, and its square of a sine or cosine."""

from __future__ import annotations

from functools import reduce
from operator import mul

from eomgen.symbolic.expression.exact_numbers import Number
from eomgen.symbolic.expression.node import Node, Scalar

MOST = 8  # factors of a product that are looked at


def coefficient(x: Node) -> tuple[Number, Node]:
    """x as (number, rest)."""
    if x.op == "mul" and type(x.args[0]) is not Node:
        return x.args[0], x.args[1]
    return 1, x


def common_of_squares(x: Node, y: Node) -> Scalar | None:
    """k when the products x and y are k sin(t)**2 and k cos(t)**2 in whatever order, so that x + y = k; else None."""
    factors_x = _factors(x)
    squares_x = _squared(factors_x)
    if not squares_x:
        return None
    factors_y = _factors(y)
    for g in _squared(factors_y):
        for f in squares_x:
            if f.op != g.op and f.args[0] is g.args[0]:
                rest = _without(factors_x, f)
                if sorted(map(_order, rest)) == sorted(map(_order, _without(factors_y, g))):
                    return reduce(mul, rest, 1)
    return None


def same_number(a: Scalar, b: Scalar) -> bool:
    """Whether both are numbers, and equal."""
    return type(a) is not Node and type(b) is not Node and a == b


def _factors(x: Node) -> list[Scalar]:
    """The factors of a product; none where there are more than MOST."""
    found: list[Scalar] = []
    stack: list[Scalar] = [x]
    while stack:
        factor = stack.pop()
        if type(factor) is Node and factor.op == "mul":
            stack += [factor.args[1], factor.args[0]]
        else:
            found.append(factor)
            if len(found) + len(stack) > MOST:
                return []
    return found


def _squared(factors: list[Scalar]) -> list[Node]:
    """The sines and cosines that stand twice among the factors."""
    circular = [f for f in factors if type(f) is Node and f.op in ("sin", "cos")]
    if len(circular) < 2:
        return []
    return [f for k, f in enumerate(circular) if circular.count(f) == 2 and f in circular[k + 1 :]]


def _without(factors: list[Scalar], f: Node) -> list[Scalar]:
    return [factor for factor in factors if factor is not f]


def _order(factor: Scalar) -> tuple[int, Number]:
    """Equal for equal factors of one graph."""
    return (1, factor.index) if type(factor) is Node else (0, factor)
