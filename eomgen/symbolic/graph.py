"""Numbers and symbols -> hash-consed expressions.

A `Graph` owns its nodes; two equal constructions give the same node (value numbering), so a
sub-expression is held, differentiated, counted and emitted once. Exact numbers are plain `int` and
`Fraction`, never nodes: 0 and 1 fold by Python's own arithmetic and cost nothing.

What folds on construction, and nothing else: rational arithmetic; 0 and 1; signs (a negation stands
outermost, a coefficient is positive); like terms; x - x, x / x; sqrt(x)**2; k sin**2 + k cos**2;
sines and cosines of a linear argument (sign, multiples of pi/2, exact values at multiples of pi/6 and pi/4).
There is no expansion and no simplification.
"""

from __future__ import annotations

from fractions import Fraction
from heapq import heappop, heappush
from math import isqrt
from typing import Union

from eomgen.errors import DerivationError

Number = Union[int, Fraction]
Scalar = Union[int, Fraction, "Node"]

UNARY = frozenset("neg sqrt sin cos tan asin acos atan sinh cosh tanh exp log abs sign".split())
BINARY = frozenset("add sub mul div pow atan2 min max less less_equal".split())
LARGEST_POWER = 4096  # of a node, when it stays a whole power
LARGEST_NUMBER = 65_536  # bits of a power of exact numbers: 9**9**9 is refused, not computed


class Node:
    """One expression of a graph: an operation on nodes and exact numbers.

    `op` is one of UNARY, BINARY, "select" (condition, if true, if false), "symbol" (its one
    argument is the name) or "pi". `index` grows from arguments to results: sorting by it is an
    evaluation order.
    """

    __slots__ = ("args", "graph", "index", "op")

    def __init__(self, graph: Graph, op: str, args: tuple, index: int) -> None:
        self.graph, self.op, self.args, self.index = graph, op, args, index

    @property
    def name(self) -> str:
        """The name of a symbol."""
        if self.op != "symbol":
            raise TypeError(f"only a symbol has a name, not '{self.op}'")
        return self.args[0]

    def __add__(self, other):
        return self.graph.add(self, other)

    def __radd__(self, other):
        return self.graph.add(other, self)

    def __sub__(self, other):
        return self.graph.add(self, self.graph.neg(other))

    def __rsub__(self, other):
        return self.graph.add(other, self.graph.neg(self))

    def __mul__(self, other):
        return self.graph.mul(self, other)

    def __rmul__(self, other):
        return self.graph.mul(other, self)

    def __truediv__(self, other):
        return self.graph.div(self, other)

    def __rtruediv__(self, other):
        return self.graph.div(other, self)

    def __pow__(self, other):
        return self.graph.pow(self, other)

    def __rpow__(self, other):
        return self.graph.pow(other, self)

    def __neg__(self):
        return self.graph.neg(self)

    def __pos__(self):
        return self

    def __abs__(self):
        return self.graph.call("abs", self)

    def __bool__(self) -> bool:
        raise TypeError("an expression is neither true nor false: compare with `is 0`-like checks on numbers")

    def __repr__(self) -> str:
        from eomgen.symbolic.text import to_text

        return to_text(self)


class Graph:
    """The owner of a set of expressions, each held once."""

    def __init__(self) -> None:
        self._nodes: dict[tuple, Node] = {}
        self.pi = self._node("pi", ())

    def __len__(self) -> int:
        return len(self._nodes)

    def _node(self, op: str, args: tuple) -> Node:
        key = (op, args)
        node = self._nodes.get(key)
        if node is None:
            node = self._nodes[key] = Node(self, op, args, len(self._nodes))
        return node

    def symbol(self, name: str) -> Node:
        """The symbol of this name (the same node for the same name)."""
        return self._node("symbol", (name,))

    # -- arithmetic ---------------------------------------------------------------------------

    def neg(self, a: Scalar) -> Scalar:
        if type(a) is not Node:
            return -_exact(a)
        if a.op == "neg":
            return a.args[0]
        return self._node("neg", (a,))

    def add(self, a: Scalar, b: Scalar) -> Scalar:
        if type(a) is not Node:
            if type(b) is not Node:
                return _tidy(_exact(a) + _exact(b))
            return self._shift(_exact(a), b)
        if type(b) is not Node:
            return self._shift(_exact(b), a)
        if a is b:
            return self.mul(2, a)
        negative_a = a.op == "neg"
        negative_b = b.op == "neg"
        x = a.args[0] if negative_a else a
        y = b.args[0] if negative_b else b
        if negative_a is negative_b:
            total = self._sum(x, y)
            return self.neg(total) if negative_a else total
        return self._difference(y, x) if negative_a else self._difference(x, y)

    def _shift(self, c: Number, x: Node) -> Scalar:
        """c + x, the number first and x without a sign when that can be."""
        if c == 0:
            return x
        if x.op == "neg":
            return self.neg(self._shift(-c, x.args[0]))
        if x.op == "add" and type(x.args[0]) is not Node:
            return self._shift(_tidy(x.args[0] + c), x.args[1])
        return self._node("add", (c, x))

    def _sum(self, x: Node, y: Node) -> Scalar:
        """x + y, both without a sign."""
        if x is y:
            return self.mul(2, x)
        if x.op == "mul" and y.op == "mul":
            cx, fx = _coefficient(x)
            cy, fy = _coefficient(y)
            if fx is fy:
                return self.mul(_tidy(cx + cy), fx)
            merged = self._pythagoras(x, y)
            if merged is not None:
                return merged
        elif x.op == "mul" and x.args[1] is y and type(x.args[0]) is not Node:
            return self.mul(_tidy(x.args[0] + 1), y)
        elif y.op == "mul" and y.args[1] is x and type(y.args[0]) is not Node:
            return self.mul(_tidy(y.args[0] + 1), x)
        if y.op == "sub":
            if y.args[1] is x:  # x + (p - x)
                return y.args[0]
        elif x.op == "sub" and x.args[1] is y:
            return x.args[0]
        if x.op == "add" and type(x.args[0]) is not Node:  # (c + p) + y = c + (p + y)
            return self.add(x.args[0], self.add(x.args[1], y))
        if y.op == "add" and type(y.args[0]) is not Node:
            return self.add(y.args[0], self.add(x, y.args[1]))
        return self._node("add", (x, y) if x.index < y.index else (y, x))

    def _difference(self, x: Node, y: Node) -> Scalar:
        """x - y, both without a sign."""
        if x is y:
            return 0
        if x.op == "mul" or y.op == "mul":
            cx, fx = _coefficient(x)
            cy, fy = _coefficient(y)
            if fx is fy:
                return self.mul(_tidy(cx - cy), fx)
        if x.op == "add":  # (p + y) - y
            if x.args[1] is y:
                return x.args[0]
            if x.args[0] is y:
                return x.args[1]
        if y.op == "add":  # x - (p + x)
            if y.args[1] is x:
                return self.neg(y.args[0])
            if y.args[0] is x:
                return self.neg(y.args[1])
        if x.op == "sub" and x.args[0] is y:  # (y - p) - y
            return self.neg(x.args[1])
        if y.op == "sub" and y.args[0] is x:  # x - (x - p)
            return y.args[1]
        if x.op == "add" and type(x.args[0]) is not Node:
            return self.add(x.args[0], self.add(x.args[1], self.neg(y)))
        if y.op == "add" and type(y.args[0]) is not Node:
            return self.add(-y.args[0], self.add(x, self.neg(y.args[1])))
        if x.index < y.index:
            return self._node("sub", (x, y))
        return self._node("neg", (self._node("sub", (y, x)),))

    def _pythagoras(self, x: Node, y: Node) -> Scalar | None:
        """k when x + y is k sin(t)**2 + k cos(t)**2, else None."""
        squares_x, squares_y = _squares(x), _squares(y)
        for k, f in squares_x:
            for other_k, g in squares_y:
                if f.op != g.op and f.args[0] is g.args[0] and (k is other_k or _same_number(k, other_k)):
                    return k
        return None

    def mul(self, a: Scalar, b: Scalar) -> Scalar:
        if type(a) is not Node:
            if type(b) is not Node:
                return _tidy(_exact(a) * _exact(b))
            return self._scale(_exact(a), b)
        if type(b) is not Node:
            return self._scale(_exact(b), a)
        negative = False
        if a.op == "neg":
            a, negative = a.args[0], True
        if b.op == "neg":
            b, negative = b.args[0], not negative
        product = self._product(a, b)
        return self.neg(product) if negative else product

    def _scale(self, c: Number, x: Node) -> Scalar:
        """c x, the number first and positive."""
        if c == 0:
            return 0
        if x.op == "neg":
            c, x = -c, x.args[0]
        if x.op == "mul" and type(x.args[0]) is not Node:
            c, x = _tidy(c * x.args[0]), x.args[1]
        if c == 1:
            return x
        if c == -1:
            return self._node("neg", (x,))
        if c < 0:
            return self._node("neg", (self._node("mul", (-c, x)),))
        return self._node("mul", (c, x))

    def _product(self, x: Node, y: Node) -> Scalar:
        """x y, both without a sign."""
        if x.op == "mul" and type(x.args[0]) is not Node:
            if y.op == "mul" and type(y.args[0]) is not Node:
                return self._scale_or_number(x.args[0] * y.args[0], self._product(x.args[1], y.args[1]))
            return self._scale_or_number(x.args[0], self._product(x.args[1], y))
        if y.op == "mul" and type(y.args[0]) is not Node:
            return self._scale_or_number(y.args[0], self._product(x, y.args[1]))
        if x.op == "sqrt" and y.op == "sqrt":
            if x is y:
                return x.args[0]
            if type(x.args[0]) is not Node and type(y.args[0]) is not Node:
                return self.sqrt(x.args[0] * y.args[0])
        if y.op == "div" and y.args[1] is x:
            return y.args[0]
        if x.op == "div" and x.args[1] is y:
            return x.args[0]
        if y.op == "div" and y.args[0] == 1:
            return self._quotient(x, y.args[1])
        if x.op == "div" and x.args[0] == 1:
            return self._quotient(y, x.args[1])
        return self._node("mul", (x, y) if x.index <= y.index else (y, x))

    def div(self, a: Scalar, b: Scalar) -> Scalar:
        if type(b) is not Node:
            if _exact(b) == 0:
                raise DerivationError("division by zero")
            return self.mul(Fraction(1) / _exact(b), a)
        if type(a) is not Node:
            if _exact(a) == 0:
                return 0
            negative = (a < 0) is not (b.op == "neg")
            a, b = abs(a), b.args[0] if b.op == "neg" else b
        else:
            negative = (a.op == "neg") is not (b.op == "neg")
            a, b = (n.args[0] if n.op == "neg" else n for n in (a, b))
        quotient = self._quotient(a, b)
        return self.neg(quotient) if negative else quotient

    def _quotient(self, x: Scalar, y: Node) -> Scalar:
        """x / y, neither with a sign."""
        if x is y:
            return 1
        if y.op == "mul" and type(y.args[0]) is not Node:
            return self._scale_or_number(Fraction(1) / y.args[0], self._quotient(x, y.args[1]))
        if type(x) is Node:
            if x.op == "mul":
                if x.args[0] is y:
                    return x.args[1]
                if x.args[1] is y:
                    return x.args[0]
                if type(x.args[0]) is not Node:
                    return self._scale_or_number(x.args[0], self._quotient(x.args[1], y))
            if y.op == "mul":
                if y.args[0] is x:
                    return self._quotient(1, y.args[1])
                if y.args[1] is x:
                    return self._quotient(1, y.args[0])
            if y.op == "sqrt" and y.args[0] is x:
                return y
        elif x != 1:
            return self._scale_or_number(x, self._quotient(1, y))
        if y.op == "sqrt" and type(y.args[0]) is not Node:  # x / sqrt(2) = x sqrt(2) / 2
            return self.mul(Fraction(1, y.args[0]), self.mul(x, y))
        if y.op == "div":
            return self.div(self.mul(x, y.args[1]), y.args[0])
        return self._node("div", (x, y))

    def _scale_or_number(self, c: Number, x: Scalar) -> Scalar:
        return self._scale(_tidy(c), x) if type(x) is Node else _tidy(c * x)

    def pow(self, base: Scalar, exponent: Scalar) -> Scalar:
        """base ** exponent; small whole powers are products, halves are square roots."""
        if type(exponent) is Node:
            if type(base) is not Node and base == 1:
                return 1
            return self._node("pow", (base, exponent))
        exponent = _exact(exponent)
        if exponent == 0:
            return 1
        if exponent == 1:
            return base
        if exponent < 0:
            return self.div(1, self.pow(base, -exponent))
        if type(exponent) is Fraction:
            if exponent.denominator == 2:
                return self.pow(self.sqrt(base), exponent.numerator)
            return base if type(base) is not Node and base in (0, 1) else self._node("pow", (base, exponent))
        if type(base) is not Node:
            return _exact_power(_exact(base), exponent)
        if exponent > LARGEST_POWER:
            raise DerivationError(f"the power {exponent} is too large")
        if base.op == "neg":
            power = self.pow(base.args[0], exponent)
            return self.neg(power) if exponent % 2 else power
        if exponent <= 8:
            half = self.pow(base, exponent // 2)
            square = self.mul(half, half)
            return self.mul(square, base) if exponent % 2 else square
        return self._node("pow", (base, exponent))

    # -- functions ----------------------------------------------------------------------------

    def sqrt(self, a: Scalar) -> Scalar:
        if type(a) is Node:
            if a.op == "mul" and type(a.args[0]) is not Node:  # sqrt(c x) = sqrt(c) sqrt(x), c > 0
                outside, inside = _root(a.args[0])
                return self.mul(outside, self._node("sqrt", (self.mul(inside, a.args[1]),)))
            return self._node("sqrt", (a,))
        if _exact(a) < 0:
            raise DerivationError(f"the square root of a negative number: sqrt({a})")
        outside, inside = _root(a)
        return outside if inside == 1 else self.mul(outside, self._node("sqrt", (inside,)))

    def call(self, name: str, *args: Scalar) -> Scalar:
        """A function of the table UNARY or BINARY at its arguments."""
        if name == "sqrt":
            return self.sqrt(args[0])
        if name in ("sin", "cos"):
            return self._circular(name, args[0])
        if name == "tan":
            return self.div(self._circular("sin", args[0]), self._circular("cos", args[0]))
        if name == "neg":
            return self.neg(args[0])
        a = args[0]
        if len(args) == 1:
            if type(a) is not Node:
                folded = _folded(name, _exact(a))
                return self._node(name, (a,)) if folded is None else folded
            if a.op == "neg":
                if name == "abs":
                    return self.call("abs", a.args[0])
                if name in ("sign", "asin", "atan", "sinh", "tanh"):
                    return self.neg(self.call(name, a.args[0]))
                if name == "cosh":
                    return self.call("cosh", a.args[0])
            return self._node(name, (a,))
        return self._binary(name, *args)

    def _binary(self, name: str, a: Scalar, b: Scalar) -> Scalar:
        numbers = type(a) is not Node and type(b) is not Node
        if name in ("min", "max"):
            if numbers:
                return min(a, b) if name == "min" else max(a, b)
            if a is b:
                return a
            first = type(b) is Node and (type(a) is not Node or a.index < b.index)
            return self._node(name, (a, b) if first else (b, a))
        if name in ("less", "less_equal") and (numbers or a is b):
            return int(name == "less_equal" if a is b else a < b if name == "less" else a <= b)
        if name == "atan2" and numbers and a == 0 and b > 0:
            return 0
        return self._node(name, (a, b))

    def select(self, condition: Scalar, if_true: Scalar, if_false: Scalar) -> Scalar:
        """if_true where the condition (a comparison) holds, else if_false."""
        if type(condition) is not Node:
            return if_true if condition else if_false
        if if_true is if_false or _same_number(if_true, if_false):
            return if_true
        return self._node("select", (condition, if_true, if_false))

    def _circular(self, name: str, a: Scalar) -> Scalar:
        if type(a) is not Node:
            if _exact(a) == 0:
                return 0 if name == "sin" else 1
            if a < 0:
                return self.neg(self._circular(name, -a)) if name == "sin" else self._circular(name, -a)
            return self._node(name, (a,))
        if a.op == "symbol":
            return self._node(name, (a,))
        terms = linear_terms(a)
        turn = _tidy(Fraction(terms.pop(self.pi, 0)) % 2)  # in units of pi
        number = terms.pop(None, 0)
        if not terms and number == 0:
            exact = self._special(name, turn)
            if exact is not None:
                return exact
        ordered = sorted(terms.items(), key=lambda item: item[0].index)
        leading = ordered[0][1] if ordered else number if number else turn
        if leading < 0:  # sin(-x) = -sin(x)
            ordered = [(atom, -c) for atom, c in ordered]
            number, turn = -number, -turn % 2
            sign = -1 if name == "sin" else 1
        else:
            sign = 1
        quarter = int(2 * turn)  # whole quarter turns go into the function, the rest stays
        rest = _tidy(turn - Fraction(quarter, 2))
        angle: Scalar = number
        for atom, c in ordered:
            angle = self.add(angle, self.mul(c, atom))
        angle = self.add(angle, self.mul(rest, self.pi))
        if name == "sin":
            name, flip = (("sin", 1), ("cos", 1), ("sin", -1), ("cos", -1))[quarter]
        else:
            name, flip = (("cos", 1), ("sin", -1), ("cos", -1), ("sin", 1))[quarter]
        if type(angle) is not Node:
            folded = self._circular(name, angle)
        else:
            folded = self._node(name, (angle,))
        return self.mul(sign * flip, folded)

    def _special(self, name: str, turn: Number) -> Scalar | None:
        """sin or cos of turn*pi at the multiples of pi/6 and pi/4, else None."""
        if name == "cos":
            turn = (turn + Fraction(1, 2)) % 2
        sign = 1
        if turn >= 1:
            turn, sign = turn - 1, -1
        if turn > Fraction(1, 2):
            turn = 1 - turn
        table = {Fraction(0): 0, Fraction(1, 6): Fraction(1, 2), Fraction(1, 2): 1}
        if turn in table:
            return sign * table[turn]
        if turn == Fraction(1, 4):
            return self.mul(Fraction(sign, 2), self.sqrt(2))
        if turn == Fraction(1, 3):
            return self.mul(Fraction(sign, 2), self.sqrt(3))
        return None


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
    return {x: _tidy(c) for x, c in terms.items() if c != 0}


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
    for atom, c in sorted(terms.items(), key=lambda item: item[0].index):
        total = a.graph.add(total, a.graph.mul(c, atom))
    return total


def is_zero(a: Scalar) -> bool:
    """True where a is the number 0 (a node never is: what folds to 0 folds on construction)."""
    return type(a) is not Node and a == 0


def _exact(a: object) -> Number:
    """a as an exact number, a whole one as int."""
    if type(a) is int:
        return a
    if isinstance(a, (int, Fraction)):
        return a.numerator if a.denominator == 1 else a
    raise TypeError(f"a derivation holds exact numbers only, not {a!r} of type {type(a).__name__}")


def _exact_power(base: Number, exponent: int) -> Number:
    bits = max(abs(base.numerator), base.denominator).bit_length() * exponent
    if abs(base) not in (0, 1) and bits > LARGEST_NUMBER:
        raise DerivationError(f"a power of an exact number is too large: about 2**{bits}")
    return _tidy(base**exponent)


def _tidy(a: Number) -> Number:
    return a.numerator if type(a) is Fraction and a.denominator == 1 else a


def _coefficient(x: Node) -> tuple[Number, Node]:
    if x.op == "mul" and type(x.args[0]) is not Node:
        return x.args[0], x.args[1]
    return 1, x


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


def _same_number(a: Scalar, b: Scalar) -> bool:
    return type(a) is not Node and type(b) is not Node and a == b


def _root(c: Number) -> tuple[Number, int]:
    """(outside, inside) with sqrt(c) = outside * sqrt(inside), inside a whole number; squares taken out."""
    c = Fraction(c)
    inside = c.numerator * c.denominator  # sqrt(p/q) = sqrt(p q) / q
    outside = Fraction(1, c.denominator)
    root = isqrt(inside)
    if root * root == inside:
        return _tidy(outside * root), 1
    factor = 2
    while factor * factor <= inside and factor < 10_000:
        while inside % (factor * factor) == 0:
            inside //= factor * factor
            outside *= factor
        factor += 1
    return _tidy(outside), inside


def _folded(name: str, a: Number) -> Scalar | None:
    """The exact value of a function at an exact number, or None where there is none."""
    if name == "abs":
        return abs(a)
    if name == "sign":
        return (a > 0) - (a < 0)
    if a == 0 and name in ("asin", "atan", "sinh", "tanh"):
        return 0
    if a == 0 and name in ("exp", "cosh"):
        return 1
    if a == 1 and name in ("log", "acos"):
        return 0
    return None
