"""The sine and cosine of a linear argument, and their inverses: signs, quarter turns and exact values.

sin(-x) = -sin(x), sin(x + pi/2) = cos(x), cos(pi/6) = sqrt(3)/2, sin(x + 2*pi/3) = cos(x + pi/6);
cos(acos(x)) = x, sin(acos(x)) = sqrt(1 - x^2), cos(2 atan(x)) = (1 - x^2)/(1 + x^2), acos(1/2) = pi/3,
sin(atan2(3, 4)) = 3/5.
"""

from __future__ import annotations

from eomgen.symbolic.expression.node import Node, Owner, Scalar, linear_terms
from eomgen.symbolic.expression.numbers import Number, tidy
from eomgen.symbolic.expression.rational import Fraction

_AFTER_QUARTERS = {  # name -> what it is after 0, 1, 2, 3 quarter turns
    "sin": (("sin", 1), ("cos", 1), ("sin", -1), ("cos", -1)),
    "cos": (("cos", 1), ("sin", -1), ("cos", -1), ("sin", 1)),
}
_OTHER = {"sin": "cos", "cos": "sin"}
_SINES: dict[Fraction, Number] = {Fraction(0): 0, Fraction(1, 6): Fraction(1, 2), Fraction(1, 2): 1}  # rational ones
_SQUARES = {Fraction(1, 4): 2, Fraction(1, 3): 3}  # sin(turn pi) = sqrt(square) / 2
_INVERSES = {  # function -> {square of its argument: its value in units of pi}
    "asin": {
        0: Fraction(0),
        Fraction(1, 4): Fraction(1, 6),
        Fraction(1, 2): Fraction(1, 4),
        Fraction(3, 4): Fraction(1, 3),
        1: Fraction(1, 2),
    },
    "atan": {0: Fraction(0), Fraction(1, 3): Fraction(1, 6), 1: Fraction(1, 4), 3: Fraction(1, 3)},
}
LARGEST_MULTIPLE = 4  # of an inverse function under a sine or cosine


def circular(graph: Owner, name: str, a: Scalar) -> Scalar:
    """sin or cos (the name) of a on the graph: the argument starts with a plus, multiples of pi are in [0, 1/2).

    Where nothing else is in it, they are in [0, 1/4].
    """
    if type(a) is Node and a.op == "symbol":
        return graph.held(name, (a,))
    terms = linear_terms(a)
    inverse = next((atom for atom, c in terms.items() if _unfolds(graph, atom, c)), None)
    if inverse is not None:
        return _of_inverse(graph, name, a, inverse, int(terms[inverse]))
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
    turn -= Fraction(quarter, 2)
    if not ordered and number == 0 and turn > Fraction(1, 4):  # sin(3*pi/10) = cos(pi/5)
        name, turn = _OTHER[name], Fraction(1, 2) - turn
    angle: Scalar = number
    for atom, c in ordered:
        angle = graph.add(angle, graph.mul(c, atom))
    angle = graph.add(angle, graph.mul(tidy(turn), graph.pi))
    return graph.mul(sign * flip, graph.held(name, (angle,)))


def _special(graph: Owner, name: str, turn: Number) -> Scalar | None:
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


# -- inverse functions ------------------------------------------------------------------------------


def inverse_circular(graph: Owner, name: str, a: Scalar) -> Scalar | None:
    """asin, acos or atan of a number whose angle is a multiple of pi/6 or pi/4, else None."""
    found = _signed_square(a)
    if found is None:
        return None
    sign, square = found
    if name == "acos":
        sine = inverse_circular(graph, "asin", a)
        return None if sine is None else graph.add(graph.mul(Fraction(1, 2), graph.pi), graph.neg(sine))
    turn = _INVERSES[name].get(square)
    return None if turn is None else graph.mul(tidy(sign * turn), graph.pi)


def _signed_square(a: Scalar) -> tuple[int, Number] | None:
    """(sign, a^2) of a rational number, or of one times a root of one; None for anything else."""
    sign = 1
    if type(a) is Node and a.op == "neg":
        sign, a = -1, a.args[0]
    if type(a) is not Node:
        return (sign if a >= 0 else -sign), tidy(Fraction(a) * a)
    c, root = a.args if a.op == "mul" and type(a.args[0]) is not Node else (1, a)
    if type(root) is Node and root.op == "sqrt" and type(root.args[0]) is not Node:
        return sign, tidy(Fraction(c) * c * root.args[0])
    return None


def _unfolds(graph: Owner, atom: Node | None, c: Number) -> bool:
    """True if the sine of c times the atom has a form without the atom: c asin(x), with a whole c."""
    if atom is None or type(c) is not int or abs(c) > LARGEST_MULTIPLE:
        return False
    if atom.op == "atan2":  # one of what moves has a value at (0, 0) too, where there is no direction
        return graph.is_constant(atom)
    within = atom.op in ("asin", "acos") and (type(atom.args[0]) is Node or abs(atom.args[0]) <= 1)
    return within or atom.op == "atan"


def _of_inverse(graph: Owner, name: str, a: Scalar, atom: Node, c: int) -> Scalar:
    """sin or cos of a = rest + c atom by the addition theorem."""
    rest = graph.add(a, graph.mul(-c, atom))
    cosine, sine = _turned(graph, atom, abs(c))
    sine = sine if c > 0 else graph.neg(sine)
    cos_rest, sin_rest = circular(graph, "cos", rest), circular(graph, "sin", rest)
    if name == "cos":
        return graph.add(graph.mul(cos_rest, cosine), graph.neg(graph.mul(sin_rest, sine)))
    return graph.add(graph.mul(sin_rest, cosine), graph.mul(cos_rest, sine))


def _of_slope(graph: Owner, y: Scalar, x: Scalar) -> tuple[Scalar, Scalar]:
    """(cos, sin) of the direction of (x, y)."""
    length = graph.sqrt(graph.add(graph.mul(x, x), graph.mul(y, y)))
    return graph.div(x, length), graph.div(y, length)


def _of_double_slope(graph: Owner, y: Scalar, x: Scalar) -> tuple[Scalar, Scalar]:
    """(cos, sin) of twice the angle of the direction of (x, y)."""
    square = graph.mul(y, y)
    below = graph.add(graph.mul(x, x), square)
    return (
        graph.div(graph.add(graph.mul(x, x), graph.neg(square)), below),
        graph.div(graph.mul(2, graph.mul(x, y)), below),
    )


def _turned(graph: Owner, atom: Node, n: int) -> tuple[Scalar, Scalar]:
    """(cos, sin) of n times the atom."""
    x = atom.args[0]
    if atom.op in ("atan", "atan2"):  # of y/x; twice the angle needs no root
        y, x = (*atom.args, 1)[:2]
        point, n = (_of_double_slope(graph, y, x), n // 2) if n % 2 == 0 else (_of_slope(graph, y, x), n)
    else:
        other = graph.sqrt(graph.add(1, graph.neg(graph.mul(x, x))))
        point = (x, other) if atom.op == "acos" else (other, x)
    cosine: Scalar = 1
    sine: Scalar = 0
    for _ in range(n):
        cosine, sine = (
            graph.add(graph.mul(cosine, point[0]), graph.neg(graph.mul(sine, point[1]))),
            graph.add(graph.mul(sine, point[0]), graph.mul(cosine, point[1])),
        )
    return cosine, sine
