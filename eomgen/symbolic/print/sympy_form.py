"""Graph nodes <-> sympy expressions, for reading; the only module of this room that needs sympy's expressions.

Sums and products are handed to sympy flat, so that it sorts them once. Loops in evaluation order, no recursion.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from functools import reduce
from typing import Any

import sympy
from sympy.core.relational import Relational
from sympy.logic.boolalg import BooleanAtom, BooleanFunction

from eomgen.errors import DerivationError
from eomgen.symbolic.expression import (
    SUMS,
    Fraction,
    Graph,
    Node,
    Number,
    Owner,
    Sampled,
    Scalar,
    known_to_sympy,
    order,
    selected,
)

known_to_sympy()

TRUTHS = (Relational, BooleanFunction, BooleanAtom)


class NamedSymbol(sympy.Symbol):  # type: ignore[misc]
    """A real symbol that its name replaces too: x.subs("m", 2), x.subs({"m": 2}), x.subs(sympy.Symbol("m"), 2).

    sympy makes of a name a symbol of which nothing is known, which is another one than a real symbol of that name: it
    would be found nowhere, in silence. Else it is the real symbol: sympy.Symbol("m", real=True) equals it.
    """

    __slots__ = ()

    def _eval_subs(self, old: Any, new: Any) -> Any:
        return new if isinstance(old, sympy.Symbol) and old.name == self.name else None

    def __eq__(self, other: object) -> bool:
        if isinstance(other, sympy.Symbol):
            return bool(self._hashable_content() == other._hashable_content())
        return NotImplemented

    def __hash__(self) -> int:
        return hash((sympy.Symbol.__name__, *self._hashable_content()))


NamedSymbol.__name__ = sympy.Symbol.__name__  # sympy sorts factors and summands by the names of their classes


class RateSymbol(NamedSymbol):
    """The symbol of a derivative: theta' is printed with a dot, theta'' with two."""

    __slots__ = ()

    def _latex(self, printer: Any) -> str:
        base = self.name.rstrip("'")
        dots = len(self.name) - len(base)
        letter, _, rest = printer._print(sympy.Symbol(base)).partition("_")
        accent = {1: r"\dot", 2: r"\ddot"}.get(dots, r"\dddot")
        return f"{accent}{{{letter}}}" + (f"_{rest}" if rest else "")


def symbol(name: str) -> sympy.Symbol:
    """The real sympy symbol of a name; a Rate where the name has a prime."""
    return (RateSymbol if name.endswith("'") else NamedSymbol)(name, real=True)


def to_sympy(outputs: Iterable[Scalar]) -> list[sympy.Expr]:
    """The outputs as sympy expressions over real symbols, their common parts made once."""
    outputs = list(outputs)
    nodes = order(outputs)
    inner = _inner_sums(nodes, outputs)
    made: dict[Node, Any] = {}
    for x in nodes:
        if x in inner:
            continue
        if x.op in SUMS:
            made[x] = sympy.Add(*(_summand(c, part, made) for c, part in _flat_sum(x, inner)))
        else:
            made[x] = _TO_SYMPY[x.op](*x.args) if x.op in ("symbol", "pi") else _made(x, made)
    return [_plain(_value(x, made)) for x in outputs]


def _inner_sums(nodes: list[Node], outputs: list[Scalar]) -> set[Node]:
    """Sums that are used once, and in a sum: they are not made by themselves."""
    uses: dict[Node, int] = {x: 2 for x in outputs if type(x) is Node}
    in_sum: set[Node] = set()
    for x in nodes:
        if x.op == "symbol":
            continue
        for a in x.args:
            if type(a) is Node:
                uses[a] = uses.get(a, 0) + 1
                if x.op in SUMS and a.op in SUMS:
                    in_sum.add(a)
    return {x for x in in_sum if uses[x] == 1}


def _flat_sum(x: Node, inner: set[Node]) -> list[tuple[int, Scalar]]:
    """(sign, part) of a sum, its inner sums opened."""
    parts: list[tuple[int, Scalar]] = []
    stack: list[tuple[int, Node]] = [(1, x)]
    while stack:
        sign, y = stack.pop()
        signs = (-sign,) if y.op == "neg" else (sign, -sign) if y.op == "sub" else (sign, sign)
        for s, a in zip(signs, y.args, strict=True):
            if type(a) is Node and a in inner:
                stack.append((s, a))
            else:
                parts.append((s, a))
    return parts


def _summand(sign: int, x: Scalar, made: Mapping[Node, Any]) -> sympy.Expr:
    value = _plain(_value(x, made))
    return value if sign == 1 else -value


def _made(x: Node, made: Mapping[Node, Any]) -> Any:
    values = [_value(a, made) for a in x.args]
    if x.op == "sampled":
        return Sampled.of(x.args[1]).chosen(_plain(values[0]), selected, sympy.pi)
    if x.op == "select":
        condition, if_true, if_false = values
        return sympy.Piecewise((_plain(if_true), _condition(condition)), (_plain(if_false), True))
    return _TO_SYMPY[x.op](*(_plain(value) for value in values))


def _value(x: Scalar, made: Mapping[Node, Any]) -> Any:
    return made[x] if type(x) is Node else _rational(x)


def _rational(c: Number) -> sympy.Rational:
    return sympy.Integer(c) if type(c) is int else sympy.Rational(c.numerator, c.denominator)


def _plain(value: Any) -> sympy.Expr:
    """A comparison used as a number is 1 or 0."""
    if isinstance(value, TRUTHS):
        return sympy.Piecewise((1, value), (0, True))
    return value


def _condition(value: Any) -> Any:
    return value if isinstance(value, TRUTHS) else sympy.Ne(value, 0)


_TO_SYMPY: dict[str, Callable[..., Any]] = {
    "symbol": symbol,
    "pi": lambda: sympy.pi,
    "mul": sympy.Mul,
    "div": lambda a, b: sympy.Mul(a, sympy.Pow(b, -1)),
    "pow": sympy.Pow,
    "abs": sympy.Abs,
    "min": sympy.Min,
    "max": sympy.Max,
    "less": sympy.Lt,
    "less_equal": sympy.Le,
} | {op: getattr(sympy, op) for op in "sqrt sin cos asin acos atan atan2 sinh cosh tanh exp log sign".split()}


# -- sympy -> graph -----------------------------------------------------------------------------


def scalar_from_sympy(expression: Any, symbols: Mapping[str, Node]) -> Scalar:
    """A sympy expression as a scalar of the symbols' graph.

    Args:
        expression: a sympy expression over symbols that are known by name, exact.
        symbols: the nodes by name; "theta'" for a Rate.
    Raises:
        DerivationError: an unknown symbol, a decimal number, or a function that the graph does not have.
    """
    expression = sympy.sympify(expression, strict=True)
    graph: Owner = next((node.graph for node in symbols.values()), None) or Graph()
    known: dict[Any, Scalar] = {}
    stack = [expression]
    while stack:
        e = stack[-1]
        missing = [a for a in e.args if a not in known]
        if missing:
            stack += missing
            continue
        stack.pop()
        if e not in known:
            known[e] = _read(e, [known[a] for a in e.args], graph, symbols)
    return known[expression]


def _read(e: Any, args: list[Any], graph: Owner, symbols: Mapping[str, Node]) -> Any:
    if not e.args:
        return _read_leaf(e, graph, symbols)
    if e.is_Add:
        return reduce(graph.add, args)
    if e.is_Mul:
        return _read_product(e, args, graph)
    if e.is_Pow:
        return graph.pow(args[0], args[1])
    if isinstance(e, sympy.Piecewise):
        return _read_pieces(e, args, graph)
    if isinstance(e, sympy.functions.elementary.piecewise.ExprCondPair):
        return tuple(args)
    name = type(e).__name__
    if isinstance(e, Relational) and name in _COMPARISONS:
        return _COMPARISONS[name](graph, *args)
    if name in ("And", "Or"):
        return reduce(lambda a, b: graph.call("min" if name == "And" else "max", a, b), args)
    if name == "Not":
        return graph.add(1, graph.neg(args[0]))
    if name in ("Min", "Max"):
        return reduce(lambda a, b: graph.call(name.lower(), a, b), args)
    if name in _FROM_SYMPY:
        return _FROM_SYMPY[name](graph, *args)
    raise DerivationError(
        f"sympy's function '{name}' has no counterpart here: {e}", fix="write it by functions of the grammar"
    )


def _read_leaf(e: Any, graph: Owner, symbols: Mapping[str, Node]) -> Scalar:
    if isinstance(e, sympy.Symbol):
        if e.name not in symbols:
            raise DerivationError(
                f"unknown symbol '{e.name}' in a sympy expression",
                fix="name a coordinate, a parameter or an input of the model",
            )
        return symbols[e.name]
    if isinstance(e, sympy.Rational):
        return int(e) if e.q == 1 else Fraction(int(e.p), int(e.q))
    if e is sympy.pi:
        return graph.pi
    if e is sympy.E:
        return graph.call("exp", 1)
    if e in (sympy.true, sympy.false):
        return int(bool(e))
    if isinstance(e, sympy.Float):
        raise DerivationError(f"the decimal number {e} in a sympy expression", fix="write it as a Rational")
    raise DerivationError(f"sympy's '{e}' has no counterpart here", fix="write it by functions of the grammar")


def _read_product(e: Any, args: list[Scalar], graph: Owner) -> Scalar:
    """A product, its negative powers below one line."""
    above: Scalar = 1
    below: Scalar = 1
    for factor, value in zip(e.args, args, strict=True):
        if factor.is_Pow and factor.exp.is_Rational and factor.exp.is_negative and type(value) is Node:
            below = graph.mul(below, graph.div(1, value))
        else:
            above = graph.mul(above, value)
    return graph.div(above, below)


def _read_pieces(e: Any, args: list[tuple[Scalar, Scalar]], graph: Owner) -> Scalar:
    value, condition = args[-1]
    if type(condition) is Node or not condition:
        raise DerivationError(
            f"a Piecewise without a value for every case: {e}", fix="add a last case with the condition True"
        )
    for piece, condition in reversed(args[:-1]):
        value = graph.select(condition, piece, value)
    return value


_COMPARISONS: dict[str, Callable[..., Scalar]] = {
    "StrictLessThan": lambda g, a, b: g.call("less", a, b),
    "LessThan": lambda g, a, b: g.call("less_equal", a, b),
    "StrictGreaterThan": lambda g, a, b: g.call("less", b, a),
    "GreaterThan": lambda g, a, b: g.call("less_equal", b, a),
    "Equality": lambda g, a, b: g.call("min", g.call("less_equal", a, b), g.call("less_equal", b, a)),
    "Unequality": lambda g, a, b: g.call("max", g.call("less", a, b), g.call("less", b, a)),
}

_FROM_SYMPY: dict[str, Callable[..., Scalar]] = {
    "Abs": lambda g, a: g.call("abs", a),
    "sec": lambda g, a: g.div(1, g.call("cos", a)),
    "csc": lambda g, a: g.div(1, g.call("sin", a)),
    "cot": lambda g, a: g.div(g.call("cos", a), g.call("sin", a)),
}


def _same_named(op: str) -> Callable[..., Scalar]:
    return lambda graph, *args: graph.call(op, *args)


_FROM_SYMPY |= {op: _same_named(op) for op in "sin cos tan asin acos atan atan2 sinh cosh tanh exp log sign".split()}
