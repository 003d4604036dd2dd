"""The sine and cosine of a linear argument: signs, quarter turns and exact values.

sin(-x) = -sin(x), sin(x + pi/2) = cos(x), cos(pi/6) = sqrt(3)/2, sin(x + 2*pi/3) = cos(x + pi/6).
"""

from __future__ import annotations

from fractions import Fraction
from typing import Any

from eomgen.symbolic.node import Node, Scalar, linear_terms
from eomgen.symbolic.numbers import Number, tidy

_AFTER_QUARTERS = {  # name -> what it is after 0, 1, 2, 3 quarter turns
    "sin": (("sin", 1), ("cos", 1), ("sin", -1), ("cos", -1)),
    "cos": (("cos", 1), ("sin", -1), ("cos", -1), ("sin", 1)),
}
_SINES: dict[Fraction, Number] = {Fraction(0): 0, Fraction(1, 6): Fraction(1, 2), Fraction(1, 2): 1}  # rational ones
_SQUARES = {Fraction(1, 4): 2, Fraction(1, 3): 3}  # sin(turn pi) = sqrt(square) / 2


def circular(graph: Any, name: str, a: Scalar) -> Scalar:
    """sin or cos (the name) of a on the graph: the argument starts with a plus, multiples of pi are in [0, 1/2)."""
    if type(a) is Node and a.op == "symbol":
        return graph.held(name, (a,))
    terms = linear_terms(a)
    turn = Fraction(terms.pop(graph.pi, 0)) % 2  # in units of pi
    number = terms.pop(None, 0)
    if not terms and number == 0:
        value = _special(graph, name, turn)
        if value is not None:
            return value
    ordered = sorted(((atom, c) for atom, c in terms.items() if atom is not None), key=lambda item: item[0].index)
    leading = ordered[0][1] if ordered else number or turn
    sign = 1
    if leading < 0:
        ordered = [(atom, -c) for atom, c in ordered]
        number, turn = -number, -turn % 2
        sign = -1 if name == "sin" else 1
    quarter = int(2 * turn)
    name, flip = _AFTER_QUARTERS[name][quarter]
    angle: Scalar = number
    for atom, c in ordered:
        angle = graph.add(angle, graph.mul(c, atom))
    angle = graph.add(angle, graph.mul(tidy(turn - Fraction(quarter, 2)), graph.pi))
    return graph.mul(sign * flip, graph.held(name, (angle,)))


def _special(graph: Any, name: str, turn: Number) -> Scalar | None:
    """sin or cos of turn*pi at the multiples of pi/6 and pi/4, else None."""
    turn = (turn + Fraction(1, 2) if name == "cos" else Fraction(turn)) % 2
    sign = 1
    if turn >= 1:
        turn, sign = turn - 1, -1
    if turn > Fraction(1, 2):
        turn = 1 - turn
    if turn in _SINES:
        return sign * _SINES[turn]
    if turn in _SQUARES:
        return graph.mul(Fraction(sign, 2), graph.sqrt(_SQUARES[turn]))
    return None
