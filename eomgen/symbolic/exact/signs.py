"""Expressions -> their sign, where it is the sign of every term."""

from __future__ import annotations

from collections.abc import Collection

from eomgen.symbolic.exact.expansion import expanded
from eomgen.symbolic.exact.terms import TooLarge
from eomgen.symbolic.expression import Node, Scalar, order
from eomgen.symbolic.numeric import Work


def sign_of_terms(x: Scalar, positive: Collection[Node]) -> int | None:
    """1 or -1 where all terms of x are positive or all negative, 0 where there are none; None where that is unknown."""
    try:
        expansion, (terms,) = expanded((x,), Work.VALUE, positive)
    except TooLarge:
        return None
    if not terms:
        return 0
    for sign in (1, -1):
        if expansion.all_positive({key: sign * c for key, c in terms.items()}):
            return sign
    return None


def never_vanishes(x: Node) -> bool:
    """True if x is positive, or negative, wherever it has a value, for positive constants: M + m*sin(alpha)^2."""
    constants = tuple(node for node in order((x,)) if node.op == "symbol" and node.graph.is_constant(node))
    try:
        expansion, (terms,) = expanded((x,), Work.ENTRY, constants)
    except TooLarge:
        return False
    return any(expansion.is_positive({key: sign * c for key, c in terms.items()}) for sign in (1, -1))
