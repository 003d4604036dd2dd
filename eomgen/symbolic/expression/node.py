"""One expression of a graph, and what a sum is made of."""

from __future__ import annotations

from collections.abc import Sequence
from heapq import heappop, heappush
from typing import Any, Protocol, final

from eomgen.symbolic.expression.numbers import Number, tidy


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
        return self.graph.mul(self, other)

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
