"""One expression of a graph, and what a sum is made of."""

from __future__ import annotations

from collections.abc import Sequence
from heapq import heappop, heappush
from typing import Any, Protocol, final

from eomgen.symbolic.expression.numbers import Number, tidy
from eomgen.symbolic.expression.rational import Fraction


class Owner(Protocol):
    """Interface of the graph that owns a node, as the node uses it."""

    pi: Node
    unit_quaternions: list[tuple[Node, ...]]
    near: dict[Node, float]

    @property
    def nodes(self) -> tuple[Node, ...]: ...
    def held(self, op: str, args: tuple[Any, ...]) -> Node: ...
    def symbol(self, name: str) -> Node: ...
    def found(self, what: Any) -> dict[Any, Any]: ...
    def is_constant(self, x: Scalar) -> bool: ...
    def neg(self, a: Scalar) -> Scalar: ...
    def add(self, a: Scalar, b: Scalar) -> Scalar: ...
    def mul(self, a: Scalar, b: Scalar) -> Scalar: ...
    def div(self, a: Scalar, b: Scalar) -> Scalar: ...
    def pow(self, base: Scalar, exponent: Scalar) -> Scalar: ...
    def sqrt(self, a: Scalar) -> Scalar: ...
    def call(self, name: str, *args: Scalar) -> Scalar: ...
    def select(self, condition: Scalar, if_true: Scalar, if_false: Scalar) -> Scalar: ...
    def adopted(self, a: Scalar) -> Scalar: ...
    def reduced(self, x: Node) -> tuple[Any, ...]: ...


SUMS = frozenset(("add", "sub", "neg"))
ROOT_OF_SUM = "sqrt of a sum"  # an operation of its own: most roots are of numbers
_BITS: dict[str, int] = {}


def op_bits(*ops: str) -> int:
    """A bit for each operation, the same in all of this process."""
    found = 0
    for op in ops:
        bit = _BITS.get(op)
        if bit is None:
            bit = _BITS[op] = 1 << len(_BITS)
        found |= bit
    return found


def holds_op(x: Any, *ops: str) -> bool:
    """True if one of the operations occurs in x."""
    return type(x) is Node and bool(x.ops & op_bits(*ops))


@final
class Node:
    """One expression of a graph: an operation on nodes and exact numbers.

    `op` is one of UNARY, BINARY, "select" (condition, if true, if false), "symbol" (its one
    argument is the name) or "pi". `index` grows from arguments to results: sorting by it is an
    evaluation order. `ops` says which operations it is made of: a bit of `op_bits` for each.
    """

    __slots__ = ("args", "graph", "index", "op", "ops")

    def __init__(self, graph: Owner, op: str, args: tuple[Any, ...], index: int) -> None:
        self.graph, self.op, self.args, self.index = graph, op, args, index
        ops = _BITS.get(op) or op_bits(op)
        for a in args:
            if type(a) is Node:
                ops |= a.ops
        if op == "sqrt" and type(args[0]) is Node and args[0].op in SUMS:
            ops |= op_bits(ROOT_OF_SUM)
        self.ops: int = ops

    def __reduce__(self) -> tuple[Any, ...]:
        """Reconstruction of the node from a pickle, by its graph."""
        return self.graph.reduced(self)

    def is_made_of(self, *ops: str) -> bool:
        """True if no other operation than these occurs in it."""
        return not self.ops & ~op_bits(*ops)

    @property
    def name(self) -> str:
        """The name of a symbol."""
        if self.op != "symbol":
            raise TypeError(f"only a symbol has a name, not '{self.op}'")
        return str(self.args[0])

    def __add__(self, other: Scalar) -> Scalar:
        return self.graph.add(self, other)

    def __radd__(self, other: Scalar) -> Scalar:
        return self.graph.add(other, self)

    def __sub__(self, other: Scalar) -> Scalar:
        return self.graph.add(self, self.graph.neg(other))

    def __rsub__(self, other: Scalar) -> Scalar:
        return self.graph.add(other, self.graph.neg(self))

    def __mul__(self, other: Scalar) -> Scalar:
        return NotImplemented if isinstance(other, tuple) else self.graph.mul(self, other)  # k a: the vector's own

    def __rmul__(self, other: Scalar) -> Scalar:
        return self.graph.mul(other, self)

    def __truediv__(self, other: Scalar) -> Scalar:
        return self.graph.div(self, other)

    def __rtruediv__(self, other: Scalar) -> Scalar:
        return self.graph.div(other, self)

    def __pow__(self, other: Scalar) -> Scalar:
        return self.graph.pow(self, other)

    def __rpow__(self, other: Scalar) -> Scalar:
        return self.graph.pow(other, self)

    def __neg__(self) -> Scalar:
        return self.graph.neg(self)

    def __pos__(self) -> Scalar:
        return self

    def __abs__(self) -> Scalar:
        return self.graph.call("abs", self)

    def __bool__(self) -> bool:
        raise TypeError("an expression is neither true nor false: compare with `is 0`-like checks on numbers")

    def __repr__(self) -> str:
        """Short; `text.to_text` writes the whole expression."""
        if self.op == "symbol":
            return self.name
        return f"{self.op}({', '.join(_short(a) for a in self.args)})"


def _short(a: Any) -> str:
    if type(a) is not Node:
        return str(a)
    return a.args[0] if a.op == "symbol" else f"{a.op}#{a.index}"


Scalar = Number | Node
State = dict[Node, Any]
"""Values of symbols, in any arithmetic: coordinates, speeds, parameters, t."""
ScalarRow = tuple[Scalar, ...]
ScalarRows = Sequence[Sequence[Scalar]]
SparseRow = dict[int, Scalar]
"""A row of linear equations, entries that are 0 left out."""


def argument(x: Node, k: int) -> Scalar:
    """Argument number k of x."""
    found: Scalar = x.args[k]
    return found


def linear_terms(a: Scalar) -> dict[Node | None, Number]:
    """a as a sum of numbers times nodes that are no sums: {node: coefficient}, None for the number.

    Results before arguments, so that a shared sum is opened once with all its coefficients together.
    """
    if type(a) is not Node:
        return {None: a} if a != 0 else {}
    terms: dict[Node | None, Number] = {}
    pending: dict[Node, Number] = {a: 1}
    heap = [(-a.index, a)]
    while heap:
        _, x = heappop(heap)
        c = pending.pop(x)
        for factor, y in _summands(x):
            if y is x:
                terms[x] = c
            elif type(y) is not Node:
                terms[None] = terms.get(None, 0) + c * y
            elif y in pending:
                pending[y] += c * factor
            else:
                pending[y] = c * factor
                heappush(heap, (-y.index, y))
    return {x: tidy(c) for x, c in terms.items() if c != 0}


def _summands(x: Node) -> tuple[tuple[Number, Scalar], ...]:
    """x = sum of factor * summand; an x that is no sum is its own summand."""
    if x.op == "add":
        return (1, x.args[0]), (1, x.args[1])
    if x.op == "sub":
        return (1, x.args[0]), (-1, x.args[1])
    if x.op == "neg":
        return ((-1, x.args[0]),)
    if x.op == "mul" and type(x.args[0]) is not Node:
        return ((x.args[0], x.args[1]),)
    return ((1, x),)


def collected(a: Scalar) -> Scalar:
    """a with its like terms collected: (theta1 - pi/2) + (theta2 - theta1) -> theta2 - pi/2."""
    if type(a) is not Node or a.op not in ("add", "sub", "neg"):
        return a
    terms = linear_terms(a)
    total: Scalar = terms.pop(None, 0)
    for atom, c in sorted(((x, c) for x, c in terms.items() if x is not None), key=lambda item: item[0].index):
        total = a.graph.add(total, a.graph.mul(c, atom))
    return total


def is_zero(a: Scalar) -> bool:
    """True where a is the number 0 (a node never is: what folds to 0 folds on construction)."""
    return type(a) is not Node and a == 0


# -------- angles ---------------------------------------------------------------------------------------------
# The sine and cosine of a linear argument, and their inverses: signs, quarter turns and exact values.
#
# sin(-x) = -sin(x), sin(x + pi/2) = cos(x), cos(pi/6) = sqrt(3)/2, sin(x + 2*pi/3) = cos(x + pi/6);
# cos(acos(x)) = x, sin(acos(x)) = sqrt(1 - x^2), cos(2 atan(x)) = (1 - x^2)/(1 + x^2), acos(1/2) = pi/3,
# sin(atan2(3, 4)) = 3/5.


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
