"""What a product is made of: its number, and its square of a sine or cosine."""

from __future__ import annotations

from eomgen.symbolic.node import Node, Scalar
from eomgen.symbolic.numbers import Number


def coefficient(x: Node) -> tuple[Number, Node]:
    """x as (number, rest)."""
    if x.op == "mul" and type(x.args[0]) is not Node:
        return x.args[0], x.args[1]
    return 1, x


def common_of_squares(x: Node, y: Node) -> Scalar | None:
    """k when the products x and y are k sin(t)**2 and k cos(t)**2, so that x + y = k; else None."""
    squares_y = _squares(y)
    for k, f in _squares(x):
        for other_k, g in squares_y:
            if f.op != g.op and f.args[0] is g.args[0] and (k is other_k or same_number(k, other_k)):
                return k
    return None


def same_number(a: Scalar, b: Scalar) -> bool:
    """Whether both are numbers, and equal."""
    return type(a) is not Node and type(b) is not Node and a == b


def _squares(x: Node) -> list[tuple[Scalar, Node]]:
    """Every (k, f) such that x, a product of two, is k f**2 and f a sine or cosine."""
    a, b = x.args
    if a is b:
        return [(1, a)] if a.op in ("sin", "cos") else []
    found = []
    for k, square in ((a, b), (b, a)):
        if type(square) is Node and square.op == "mul" and square.args[0] is square.args[1]:
            f = square.args[0]
            if f.op in ("sin", "cos"):
                found.append((k, f))
    return found
