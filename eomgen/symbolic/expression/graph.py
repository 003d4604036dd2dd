"""Numbers and symbols -> hash-consed expressions.

A `Graph` owns its nodes; two equal constructions give the same node (value numbering), so a
sub-expression is held, differentiated, counted and emitted once. Exact numbers are plain `int` and
`Fraction`, never nodes: 0 and 1 fold by Python's own arithmetic and cost nothing.

What folds on construction, and nothing else: rational arithmetic; 0 and 1; signs (a negation stands
outermost, a coefficient is positive); like terms; x - x, x / x; sqrt(x)**2; k sin**2 + k cos**2;
sines and cosines of a linear argument (sign, multiples of pi/2, exact values at multiples of pi/6 and pi/4, inverse
functions in it), and the inverse functions where their value is such a multiple; exp(n log(x)).
There is no expansion and no simplification.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from functools import reduce
from operator import mul
from typing import Any

from eomgen.errors import DerivationError
from eomgen.symbolic.expression.node import (
    Node,
    Owner,
    Scalar,
    argument,
    circular,
    collected,
    inverse_circular,
    is_zero,
    linear_terms,
)
from eomgen.symbolic.expression.numbers import Number, binary_folded_at, exact, exact_power, folded_at, root_of, tidy
from eomgen.symbolic.expression.rational import Fraction
from eomgen.symbolic.expression.splines import Sampled, number_of_sampled

__all__ = [
    "BINARY",
    "CONSTANTS",
    "LARGEST_POWER",
    "UNARY",
    "Graph",
    "Node",
    "Number",
    "Scalar",
    "collected",
    "is_zero",
    "linear_terms",
]


UNARY = frozenset("neg sqrt sin cos tan asin acos atan sinh cosh tanh exp log abs sign".split())
BINARY = frozenset("add sub mul div pow atan2 min max less less_equal sampled".split())
PI = Fraction(103993, 33102), Fraction(104348, 33215)  # below and above it
LARGEST_POWER = 4096  # of a node, when it stays a whole power
_OF_EQUALS = {"min": None, "max": None, "less": 0, "less_equal": 1}  # f(x, x); None: x itself


class Graph:
    """The owner of a set of expressions, each held once."""

    def __init__(self) -> None:
        self._nodes: dict[tuple[str, tuple[Any, ...]], Node] = {}
        self._listed: tuple[Node, ...] = ()
        self._adopted: dict[Node, Node] = {}
        self._waves: dict[tuple[str, Node], Scalar] = {}  # of arguments that were met
        self.pi = self.held("pi", ())
        self._constants = {self.pi}
        self.unit_quaternions: list[tuple[Node, ...]] = []
        self.near: dict[Node, float] = {}
        self._found: dict[Any, dict[Any, Any]] = {}

    def __len__(self) -> int:
        return len(self._nodes)

    def __getstate__(self) -> dict[str, Any]:
        """The graph without references from node to node, so that none is too deep, and with the samples in it."""
        nodes = [(x.op, tuple((True, a.index) if type(a) is Node else (False, a) for a in x.args)) for x in self.nodes]
        return {
            "nodes": nodes,
            "constants": sorted(x.index for x in self._constants),
            "spheres": [tuple(x.index for x in symbols) for symbols in self.unit_quaternions],
            "near": {x.index: value for x, value in self.near.items()},
            "samples": [Sampled.of(x.args[1]) for x in self.nodes if x.op == "sampled"],
        }

    def __setstate__(self, state: dict[str, Any]) -> None:
        self.__init__()  # type: ignore[misc]
        for sampled in state["samples"]:
            number_of_sampled(sampled)
        nodes = [self.pi]
        for op, args in state["nodes"][1:]:
            nodes.append(self.held(op, tuple(nodes[a] if is_node else a for is_node, a in args)))
        self._constants = {nodes[k] for k in state["constants"]}
        self.unit_quaternions = [tuple(nodes[k] for k in symbols) for symbols in state["spheres"]]
        self.near = {nodes[k]: value for k, value in state["near"].items()}

    def reduced(self, x: Node) -> tuple[Any, ...]:
        """Arguments that rebuild a node from a pickle: its graph and its index; of a constant its operation."""
        return (constant_again, (x.op, x.args)) if self is CONSTANTS else (_node_at, (self, x.index))

    @property
    def nodes(self) -> tuple[Node, ...]:
        """Every node, each at its index."""
        if len(self._listed) != len(self._nodes):
            self._listed = tuple(self._nodes.values())
        return self._listed

    def held(self, op: str, args: tuple[Any, ...]) -> Node:
        """The node of this operation, made where there is none yet; nothing folds."""
        key = (op, args)
        node = self._nodes.get(key)
        if node is None:
            node = self._nodes[key] = Node(self, op, args, len(self._nodes))
        return node

    def symbol(self, name: str) -> Node:
        """The symbol of this name (the same node for the same name)."""
        return self.held("symbol", (name,))

    def constant(self, name: str) -> Node:
        """The symbol of a number that stays the same."""
        symbol = self.symbol(name)
        self._constants.add(symbol)
        return symbol

    def found(self, what: Any) -> dict[Any, Any]:
        """Cached results about the nodes, such as lengths or derivatives: a dict for each kind of result."""
        return self._found.setdefault(what, {})

    def hold_on_sphere(self, symbols: tuple[Node, ...]) -> None:
        """Declares symbols whose squares add up to 1, as those of a unit quaternion; random states obey that."""
        self.unit_quaternions.append(symbols)

    def hold_near(self, values: Mapping[Node, float]) -> None:
        """Declares numbers near which the formulas have values, such as the start of a model, for random states."""
        self.near |= values

    def is_constant(self, x: Scalar) -> bool:
        """True if x is made of numbers and of symbols that stay the same."""
        if type(x) is not Node or x in self._constants:
            return True
        return x.op != "symbol" and all(map(self.is_constant, x.args))

    # -- arithmetic ---------------------------------------------------------------------------

    def neg(self, a: Scalar) -> Scalar:
        if type(a) is not Node:
            return -exact(a)
        if a.op == "neg":
            return argument(a, 0)
        return a.graph.held("neg", (a,))  # a constant stays one until it is combined

    def add(self, a: Scalar, b: Scalar) -> Scalar:
        if type(a) is not Node:
            if type(b) is not Node:
                return tidy(exact(a) + exact(b))
            return self._shift(exact(a), b)
        if type(b) is not Node:
            return self._shift(exact(b), a)
        if a.graph is not b.graph:
            return _united(Graph.add, a, b)
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
            return self._shift(tidy(x.args[0] + c), x.args[1])
        return self.held("add", (c, x))

    def _sum(self, x: Node, y: Node) -> Scalar:
        """x + y, both without a sign."""
        if x is y:
            return self.mul(2, x)
        if x.op == "mul" and y.op == "mul":
            cx, fx = coefficient(x)
            cy, fy = coefficient(y)
            if fx is fy:
                return self.mul(tidy(cx + cy), fx)
            merged = common_of_squares(x, y)
            if merged is not None:
                return merged
        elif x.op == "mul" and x.args[1] is y and type(x.args[0]) is not Node:
            return self.mul(tidy(x.args[0] + 1), y)
        elif y.op == "mul" and y.args[1] is x and type(y.args[0]) is not Node:
            return self.mul(tidy(y.args[0] + 1), x)
        if y.op == "sub":
            if y.args[1] is x:  # x + (p - x)
                return argument(y, 0)
        elif x.op == "sub" and x.args[1] is y:
            return argument(x, 0)
        if x.op == "add" and type(x.args[0]) is not Node:  # (c + p) + y = c + (p + y)
            return self.add(x.args[0], self.add(x.args[1], y))
        if y.op == "add" and type(y.args[0]) is not Node:
            return self.add(y.args[0], self.add(x, y.args[1]))
        turned = self._nodes.get(("add", (y, x)))
        return self.held("add", (x, y)) if turned is None else turned  # in the order in which it was written first

    def _difference(self, x: Node, y: Node) -> Scalar:
        """x - y, both without a sign."""
        if x is y:
            return 0
        if x.op == "mul" or y.op == "mul":
            cx, fx = coefficient(x)
            cy, fy = coefficient(y)
            if fx is fy:
                return self.mul(tidy(cx - cy), fx)
        if x.op == "add":  # (p + y) - y
            if x.args[1] is y:
                return argument(x, 0)
            if x.args[0] is y:
                return argument(x, 1)
        if y.op == "add":  # x - (p + x)
            if y.args[1] is x:
                return self.neg(y.args[0])
            if y.args[0] is x:
                return self.neg(y.args[1])
        if x.op == "sub" and x.args[0] is y:  # (y - p) - y
            return self.neg(x.args[1])
        if y.op == "sub" and y.args[0] is x:  # x - (x - p)
            return argument(y, 1)
        if x.op == "add" and type(x.args[0]) is not Node:
            return self.add(x.args[0], self.add(x.args[1], self.neg(y)))
        if y.op == "add" and type(y.args[0]) is not Node:
            return self.add(-y.args[0], self.add(x, self.neg(y.args[1])))
        if ("sub", (y, x)) not in self._nodes:
            return self.held("sub", (x, y))
        return self.held("neg", (self.held("sub", (y, x)),))

    def mul(self, a: Scalar, b: Scalar) -> Scalar:
        if type(a) is not Node:
            if type(b) is not Node:
                return tidy(exact(a) * exact(b))
            return self._scale(exact(a), b)
        if type(b) is not Node:
            return self._scale(exact(b), a)
        if a.graph is not b.graph:
            return _united(Graph.mul, a, b)
        if a.op == "neg":
            return self._product(a.args[0], b.args[0]) if b.op == "neg" else self.neg(self._product(a.args[0], b))
        return self.neg(self._product(a, b.args[0])) if b.op == "neg" else self._product(a, b)

    def _scale(self, c: Number, x: Node) -> Scalar:
        """c x, the number first and positive."""
        if c == 0:
            return 0
        if x.op == "neg":
            c, x = -c, x.args[0]
        if x.op == "mul" and type(x.args[0]) is not Node:
            c, x = tidy(c * x.args[0]), x.args[1]
        if c == 1:
            return x
        if c == -1:
            return self.held("neg", (x,))
        if c < 0:
            return self.held("neg", (self.held("mul", (-c, x)),))
        return self.held("mul", (c, x))

    def _product(self, x: Node, y: Node) -> Scalar:
        """x y, both without a sign."""
        if x.op == "mul" and type(x.args[0]) is not Node:
            if y.op == "mul" and type(y.args[0]) is not Node:
                return self._scale_or_number(x.args[0] * y.args[0], self._product(x.args[1], y.args[1]))
            return self._scale_or_number(x.args[0], self._product(x.args[1], y))
        if y.op == "mul" and type(y.args[0]) is not Node:
            return self._scale_or_number(y.args[0], self._product(x, y.args[1]))
        if x is y and x.op == "mul":
            for k, f in (x.args, x.args[::-1]):
                # (k sin)^2 = k^2 sin^2 meets k^2 cos^2
                if f.op in ("sin", "cos") and type(k) is Node and k is not f:
                    return self.mul(self.mul(k, k), self.held("mul", (f, f)))
        if x.op == "sqrt" and y.op == "sqrt":
            if x is y:
                return argument(x, 0)
            if type(x.args[0]) is not Node and type(y.args[0]) is not Node:
                return self.sqrt(x.args[0] * y.args[0])
        if y.op == "div" and y.args[1] is x:
            return argument(y, 0)
        if x.op == "div" and x.args[1] is y:
            return argument(x, 0)
        if y.op == "div" and y.args[0] == 1:
            return self._quotient(x, y.args[1])
        if x.op == "div" and x.args[0] == 1:
            return self._quotient(y, x.args[1])
        return self.held("mul", (x, y) if x.index <= y.index else (y, x))

    def div(self, a: Scalar, b: Scalar) -> Scalar:
        if type(b) is not Node:
            if exact(b) == 0:
                raise DerivationError("division by zero")
            return self.mul(Fraction(1) / exact(b), a)
        if type(a) is not Node:
            if exact(a) == 0:
                return 0
            negative = (a < 0) is not (b.op == "neg")
            a = -a if a < 0 else a
            b = b.args[0] if b.op == "neg" else b
        elif a.graph is not b.graph:
            return _united(Graph.div, a, b)
        else:
            negative = (a.op == "neg") is not (b.op == "neg")
            a, b = (a.args[0] if a.op == "neg" else a), (b.args[0] if b.op == "neg" else b)
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
                    return argument(x, 1)
                if x.args[1] is y:
                    return argument(x, 0)
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
        return self.held("div", (x, y))

    def _scale_or_number(self, c: Number, x: Scalar) -> Scalar:
        return self._scale(tidy(c), x) if type(x) is Node else tidy(c * x)

    def pow(self, base: Scalar, exponent: Scalar) -> Scalar:
        """base ** exponent; small whole powers are products, halves are square roots."""
        if type(exponent) is Node:
            if type(base) is Node and base.graph is not exponent.graph:
                return _united(Graph.pow, base, exponent)
            if type(base) is not Node and exact(base) == 1:
                return 1
            return self.held("pow", (base, exponent))
        exponent = exact(exponent)
        if exponent == 0:
            return 1
        if exponent == 1:
            return base
        if exponent < 0:
            return self.div(1, self.pow(base, -exponent))
        if type(exponent) is Fraction:
            if exponent.denominator == 2:
                return self.pow(self.sqrt(base), exponent.numerator)
            return base if type(base) is not Node and base in (0, 1) else self.held("pow", (base, exponent))
        if type(base) is not Node:
            return exact_power(exact(base), exponent.numerator)
        if exponent > LARGEST_POWER:
            raise DerivationError(f"the power {exponent} is too large", fix=f"exponents go up to {LARGEST_POWER}")
        if base.op == "neg":
            power = self.pow(base.args[0], exponent)
            return self.neg(power) if exponent % 2 else power
        if exponent <= 8:
            half = self.pow(base, exponent // 2)
            square = self.mul(half, half)
            return self.mul(square, base) if exponent % 2 else square
        return self.held("pow", (base, exponent))

    # -- functions ----------------------------------------------------------------------------

    def sqrt(self, a: Scalar) -> Scalar:
        if type(a) is Node:
            if a.op == "mul" and type(a.args[0]) is not Node:  # sqrt(c x) = sqrt(c) sqrt(x), c > 0
                outside, inside = root_of(a.args[0])
                return self.mul(outside, self.held("sqrt", (self.mul(inside, a.args[1]),)))
            return self.held("sqrt", (a,))
        if exact(a) < 0:
            raise DerivationError(f"the square root of a negative number: sqrt({a})")
        outside, inside = root_of(a)
        return outside if inside == 1 else self.mul(outside, self.held("sqrt", (inside,)))

    def call(self, name: str, *args: Scalar) -> Scalar:
        """A function of the table UNARY or BINARY at its arguments."""
        if name == "sqrt":
            return self.sqrt(args[0])
        if name in ("sin", "cos"):
            return self._wave(name, args[0])
        if name == "tan":
            return self.div(self._wave("sin", args[0]), self._wave("cos", args[0]))
        if name == "neg":
            return self.neg(args[0])
        a = args[0]
        if len(args) == 1:
            if name in ("asin", "acos", "atan") and (known := inverse_circular(self, name, a)) is not None:
                return known
            if name == "exp" and type(a) is Node:
                return exponential(self, a)
            if type(a) is not Node:
                folded = folded_at(name, exact(a))
                return self.held(name, (a,)) if folded is None else folded
            if a.op == "neg":
                if name == "abs":
                    return self.call("abs", a.args[0])
                if name in ("sign", "asin", "atan", "sinh", "tanh"):
                    return self.neg(self.call(name, a.args[0]))
                if name == "cosh":
                    return self.call("cosh", a.args[0])
            if name in ("sign", "abs") and (sign := self._sign_of_angle(a)):
                return sign if name == "sign" else sign * a
            return self.held(name, (a,))
        return self._binary(name, *args)

    def _sign_of_angle(self, a: Node) -> int:
        """The sign of k pi + n of exact numbers k and n; 0 where it is something else, or nearly 0."""
        terms = linear_terms(a)
        if not terms or any(atom is not None and atom is not self.pi for atom in terms):
            return 0
        k, n = (Fraction(terms.get(atom, 0)) for atom in (self.pi, None))
        least, most = sorted(k * bound + n for bound in PI)
        return 1 if least > 0 else -1 if most < 0 else 0

    def _wave(self, name: str, a: Scalar) -> Scalar:
        """sin or cos of a; its argument is put in order once."""
        if type(a) is not Node:
            return circular(self, name, a)
        if (name, a) not in self._waves:
            self._waves[name, a] = circular(self, name, a)
        return self._waves[name, a]

    def _binary(self, name: str, a: Scalar, b: Scalar) -> Scalar:
        if type(a) is not Node and type(b) is not Node:
            folded = binary_folded_at(name, exact(a), exact(b))
            return self.held(name, (a, b)) if folded is None else folded
        if type(a) is Node and type(b) is Node and a.graph is not b.graph:
            return _united(lambda home, a, b: home.call(name, a, b), a, b)
        if a is b and name in _OF_EQUALS:
            folded = _OF_EQUALS[name]
            return a if folded is None else folded
        if name in ("min", "max"):
            first = type(b) is Node and (type(a) is not Node or a.index < b.index)
            return self.held(name, (a, b) if first else (b, a))
        return self.held(name, (a, b))

    def select(self, condition: Scalar, if_true: Scalar, if_false: Scalar) -> Scalar:
        """if_true where the condition (a comparison) holds, else if_false."""
        if type(condition) is not Node:
            return if_true if condition else if_false
        if if_true is if_false or same_number(if_true, if_false):
            return if_true
        if len({x.graph for x in (condition, if_true, if_false) if type(x) is Node}) > 1:
            return _united(Graph.select, condition, if_true, if_false)
        return self.held("select", (condition, if_true, if_false))

    def adopted(self, a: Scalar) -> Scalar:
        """A constant such as sqrt(2) or cos(3/10) as a node of this graph."""
        if type(a) is not Node or a.graph is self:
            return a
        if a.graph is not CONSTANTS:
            raise TypeError("two expressions of different graphs cannot be combined")
        if a.op == "pi":
            return self.pi
        if a not in self._adopted:
            self._adopted[a] = self.held(a.op, tuple(self.adopted(x) for x in a.args))
        return self._adopted[a]


CONSTANTS = Graph()
"""Home of what functions give at exact numbers, sqrt(2) or cos(3/10), until it meets an expression of a graph."""


def _node_at(graph: Graph, index: int) -> Node:
    return graph.nodes[index]


def constant_again(op: str, args: tuple[Any, ...]) -> Node:
    """A constant that comes from another process: in the one home of constants here."""
    return CONSTANTS.pi if op == "pi" else CONSTANTS.held(op, args)


def _united(operation: Callable[..., Scalar], *args: Scalar) -> Scalar:
    """The operation on constants and expressions of one graph, in that graph."""
    home = next(a.graph for a in args if type(a) is Node and a.graph is not CONSTANTS)
    return operation(home, *(home.adopted(a) for a in args))


# -------- exponentials ----------------------------------------------------------------------------------------
# Exponentials of sums with logarithms in them: exp(2 log(x) + y) = x^2 exp(y).


LARGEST_POWER_IN_EXPONENT = 8  # of what stands under a logarithm


def exponential(graph: Owner, a: Scalar) -> Scalar:
    """exp(a) on the graph."""
    logarithms = {x: c for x, c in linear_terms(a).items() if x is not None and _unfolds(x, c)}
    if not logarithms:
        return graph.held("exp", (a,))
    product: Scalar = 1
    for x, c in logarithms.items():
        a = graph.add(a, graph.mul(-c, x))
        product = graph.mul(product, graph.pow(x.args[0], c))
    return graph.mul(product, graph.call("exp", a))


def _unfolds(x: Node, c: Any) -> bool:
    return x.op == "log" and type(c) is int and abs(c) <= LARGEST_POWER_IN_EXPONENT


# -------- factors ---------------------------------------------------------------------------------------------
# What a product is made of: its number, and its square of a sine or cosine.


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
    """True if both are numbers, and equal."""
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
    """Sort key of a factor, equal for equal factors of one graph."""
    return (1, factor.index) if type(factor) is Node else (0, factor)
