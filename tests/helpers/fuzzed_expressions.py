"""Random texts of the grammar, what they are worth by arithmetic of another kind, and the laws that they must keep.

A tree is drawn first; its text is written from it with as few or as many parentheses as are drawn, and its value is
computed from it with mpmath, so that the parser, the graph and the printer are compared with neither of themselves.
"""

from __future__ import annotations

from collections.abc import Mapping
from fractions import Fraction
from functools import lru_cache
from random import Random
from typing import Any

from cpu_limit import TooLong, within_cpu
from mpmath.ctx_mp import MPContext

from eomgen.errors import ExpressionError
from eomgen.symbolic.expression.formula import NAMES
from eomgen.symbolic.expression.graph import Graph
from eomgen.symbolic.expression.text import LONGEST, parse
from eomgen.symbolic.numeric.evaluation import NoValue, evaluate, fifty_digits
from eomgen.symbolic.print.text import to_text

Tree = Any
"""A number's text, a name, or (operation, tree, ...)."""

POINT = {"x": Fraction(73, 100), "y": Fraction(-131, 100), "theta": Fraction(5, 12), "theta'": Fraction(-4, 7), "I": 2}
SECONDS = 0.5  # of CPU for one expression: read, evaluated, printed and read again
ONE_PLACE = ("sin", "cos", "tan", "asin", "acos", "atan", "sinh", "cosh", "tanh", "sqrt", "exp", "log", "abs", "sign")
BINDS = {"+": 1, "-": 1, "*": 2, "/": 2, "neg": 3, "^": 4}
LIMIT = "too large"  # what a refusal says whose reason is size alone
mp = MPContext()
mp.dps = 60


def tree(rng: Random, depth: int) -> Tree:
    """A random formula; at depth 0 a leaf."""
    if depth == 0 or rng.random() < 0.1:
        return rng.choice((*POINT, "pi")) if rng.random() < 0.6 else number(rng)
    kind = rng.random()
    if kind < 0.55:
        return (rng.choice("+-*/"), tree(rng, depth - 1), tree(rng, depth - 1))
    if kind < 0.67:
        return ("^", tree(rng, depth - 1), exponent(rng, depth))
    if kind < 0.77:
        return ("neg", tree(rng, depth - 1))
    if kind < 0.93:
        return (rng.choice(ONE_PLACE), tree(rng, depth - 1))
    count = 2 if kind < 0.96 else rng.randint(2, 4)
    name = rng.choice(("min", "max", "atan2")) if count == 2 else rng.choice(("min", "max"))
    return (name, *(tree(rng, depth - 1) for _ in range(count)))


def number(rng: Random) -> str:
    """A number as people write it."""
    plain = str(rng.randint(0, 12))
    return rng.choice(
        (plain, plain, f"{rng.random():.3f}", f".{rng.randint(1, 99)}", f"{plain}.", f"{plain}e-2", "1_0")
    )


def exponent(rng: Random, depth: int) -> Tree:
    """Mostly small whole numbers and roots."""
    if rng.random() < 0.2:
        return tree(rng, depth - 1)
    return rng.choice(("2", "3", "0", "1", ("neg", "1"), ("neg", "2"), ("/", "1", "2"), ("/", "1", "3"), "0.5"))


def written(t: Tree, rng: Random) -> str:
    """The text of a tree: parentheses where they are needed, and by chance elsewhere."""
    blank = rng.choice(("", "", " "))
    if isinstance(t, str):
        return t if rng.random() < 0.97 else f"({t})"
    op, *parts = t
    if op not in BINDS:
        return f"{op}({blank}{f',{blank}'.join(written(p, rng) for p in parts)})"
    if op == "neg":
        return f"-{blank}{_inside(parts[0], BINDS['neg'], rng)}"
    left = _inside(parts[0], BINDS[op] + (op == "^"), rng)
    right = _inside(parts[1], 3 if op == "^" else BINDS[op] + 1, rng)
    return f"{left}{blank}{rng.choice(('^', '**')) if op == '^' else op}{blank}{right}"


def _inside(t: Tree, binding: int, rng: Random) -> str:
    """A part of a text, in parentheses where it binds less than what is around it."""
    needs = isinstance(t, tuple) and t[0] in BINDS and BINDS[t[0]] < binding
    return f"({written(t, rng)})" if needs or rng.random() < 0.05 else written(t, rng)


class Undecided(ArithmeticError):
    """The value is none, is not real, is beyond all size, or hangs on the last digit: nothing can be compared."""


def worth(t: Tree, largest: list[Any]) -> Any:
    """The value of a tree at POINT, and in `largest` what any part of it came to.

    Raises:
        Undecided: see there.
    """
    value = _leaf(t) if isinstance(t, str) else _applied(t[0], [worth(p, largest) for p in t[1:]])
    if isinstance(value, mp.mpc) or not mp.isfinite(value) or abs(value) > mp.mpf(10) ** 20:
        raise Undecided
    largest[0] = max(largest[0], abs(value))
    return value


def _leaf(t: str) -> Any:
    known = {**POINT, "pi": None}
    if t not in known:
        return mp.mpf(t.replace("_", ""))
    return +mp.pi if t == "pi" else mp.mpf(Fraction(known[t]).numerator) / Fraction(known[t]).denominator


def _applied(op: str, args: list[Any]) -> Any:
    tiny = mp.mpf(10) ** -20
    edge = {"/": args[-1], "sign": args[0], "log": args[0], "sqrt": args[0], "tan": mp.cos(args[0])}.get(op, 1)
    if op == "^" and not (mp.isint(args[1]) and args[1] >= 0):
        edge = args[0]
    if op == "atan2":
        edge = max(abs(args[0]), args[1])
    if op in ("asin", "acos"):
        edge = 1 - abs(args[0])
    if abs(edge) < tiny or (op in ("^", "exp", "sinh", "cosh") and abs(args[-1]) > 60) or (op == "sqrt" and edge < 0):
        raise Undecided
    return _FUNCTIONS[op](*args)


_FUNCTIONS = {
    "+": lambda a, b: a + b,
    "-": lambda a, b: a - b,
    "*": lambda a, b: a * b,
    "/": lambda a, b: a / b,
    "^": lambda a, b: mp.power(a, b),
    "neg": lambda a: -a,
    "abs": abs,
    "min": min,
    "max": max,
    **{name: getattr(mp, name) for name in NAMES if name not in ("abs", "min", "max")},
}


@lru_cache(maxsize=1)
def _point() -> Mapping[str, Any]:
    number = fifty_digits().number
    return {name: number(Fraction(value)) for name, value in POINT.items()}


def broken_law(text: str, t: Tree | None = None) -> str:
    """The law that a text breaks, in words; "" where it keeps them all.

    Args:
        t: the tree that it was written from; None for a text that may be no expression.
    """
    try:
        return within_cpu(SECONDS, lambda: _broken(text, t))
    except TooLong:
        return f"it takes no more than {SECONDS} s of CPU"
    except Exception as error:
        return f"only ExpressionError leaves the parser: {type(error).__name__}: {error}"


def _broken(text: str, t: Tree | None) -> str:
    graph = Graph()
    names = {name: graph.symbol(name) for name in POINT} | {"pi": graph.pi}
    try:
        meant = parse(text).evaluate(names)
    except ExpressionError as error:
        if not 0 <= error.column <= len(text):
            return f"an error has its place in the text: column {error.column} of {len(text)}"
        return "" if t is None or LIMIT in error.what else _refused(error, t)
    value = _value(meant, graph)
    if t is not None and (wrong := _differs(value, t)):
        return wrong
    printed = to_text(meant)
    if len(printed) > LONGEST:
        return ""
    try:
        back = parse(printed).evaluate(names)
    except ExpressionError as error:
        return "" if LIMIT in error.what else f"what prints reads back: {printed!r}: {error.what}"
    again = _value(back, graph)
    if value is not None and _is_decided(t) and (again is None or not _close(value, again, 1)):
        return f"what prints reads back to the same value: {printed!r} is {again}, not {value}"
    return ""


def _is_decided(t: Tree | None) -> bool:
    """Whether the value does not hang on the last digit of something beyond all size."""
    try:
        return t is None or bool(worth(t, [mp.mpf(1)]) is not None)
    except Undecided:
        return False


def _value(x: Any, graph: Graph) -> Any:
    """At POINT, with 50 digits; None where there is none."""
    try:
        return evaluate([x], {graph.symbol(name): value for name, value in _point().items()}, fifty_digits())[0]
    except NoValue:
        return None


def _refused(error: ExpressionError, t: Tree) -> str:
    try:
        value = worth(t, [mp.mpf(1)])
    except Undecided:
        return ""
    return f"what has a value is not refused: {mp.nstr(value, 12)}: {error.what}"


def _differs(value: Any, t: Tree) -> str:
    largest = [mp.mpf(1)]
    try:
        expected = worth(t, largest)
    except Undecided:
        return ""
    if value is None or not _close(expected, mp.mpf(value), largest[0]):
        return f"a text means what it says: {value} instead of {mp.nstr(expected, 20)}"
    return ""


def _close(a: Any, b: Any, largest: Any) -> bool:
    """Equal but for rounding: 50 digits, of which what is small after large parts cancel loses some."""
    return abs(a - b) <= mp.mpf(10) ** -20 * max(1, abs(a), largest)


PIECES = ("(", ")", ",", "^", "**", "-", "+", "/", "'", "''", "=", ".", "e9", "1e400", "pi", "t", "nan", "²", "·", "θ")
PIECES += (
    "\x00",
    "\u202e",
    "\t",
    "\n",
    " ",
    "0^",
    "/0",
    "9^9^9^9",
    "sin",
    "min(",
    "atan2(",
    "__",
    "[0]",
    "\ud800",
    "0x1",
    "½",
)


def damaged(text: str, rng: Random) -> str:
    """The text with a few pieces cut out, put in, doubled or turned."""
    for _ in range(rng.randint(1, 3)):
        a = rng.randrange(len(text) + 1)
        b = min(len(text), a + rng.randint(0, 3))
        text = text[:a] + rng.choice((rng.choice(PIECES), text[a:b] * 2, "", text[a:b][::-1])) + text[b:]
    return text


def one(rng: Random) -> tuple[str, Tree | None]:
    """A text, and the tree that it was written from; of each third text none, it is damaged."""
    t = tree(rng, rng.choice((1, 2, 2, 3, 3, 4, 5)))
    text = written(t, rng)
    return (damaged(text, rng), None) if rng.random() < 1 / 3 else (text, t)
