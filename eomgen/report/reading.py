"""Graph scalars -> the same scalars as a reader wants them, with bounded work; what is too long to print is known."""

from __future__ import annotations

from collections.abc import Container, Sequence
from dataclasses import dataclass

from eomgen.report.statements import Omitted
from eomgen.symbolic.derivative import substituted
from eomgen.symbolic.evaluation import operations, order
from eomgen.symbolic.graph import Graph, Node, Scalar
from eomgen.symbolic.normal_form import TooLarge, normal_form, readable
from eomgen.symbolic.text import named_parts, text_size

WORK = 2000  # products of terms that are multiplied out for one formula
LONGEST = 1500  # characters of one formula in print
NESTED = 400  # characters of a formula that is not multiplied out, in print
TRIED = 20_000  # characters: what is longer by far will not become short
WAVES = 100  # terms of a normal form that are written shortly; more of them take long, and are long
POLYNOMIAL = frozenset("symbol pi neg add sub mul div sin cos".split())
PATIENCE = 60  # formulas that did not become short, before no more are tried
NAMED = 80  # sub-expressions with a name of their own, at most
NAMED_LENGTH = 8000  # characters of all named sub-expressions together, at most


class Reader:
    """Puts scalars into readable form, each once, with bounded work in all."""

    def __init__(self) -> None:
        self._known: dict[Scalar, Scalar | None] = {}
        self._failures = 0

    def read(self, x: Scalar) -> Scalar | None:
        """x in its readable form; None where it is too long to print."""
        if x not in self._known:
            short = self._known[x] = self._read(x)
            if short is not None:
                self._known[short] = short
        return self._known[x]

    def _read(self, x: Scalar) -> Scalar | None:
        size = text_size(x)
        if size <= TRIED and self._failures < PATIENCE:
            short = _written(x)
            if short is not None and size < text_size(short) and holds_roots(x):
                short = x  # 1/2*k*(sqrt(...) - l)^2 is better left alone
            if short is not None and text_size(short) <= LONGEST:
                return short
            self._failures += 1
        return x if size <= NESTED else None

    def shown(self, x: Scalar) -> Scalar | Omitted:
        """x in its readable form, or how large it is."""
        short = self.read(x)
        return omitted(x) if short is None else short

    def short(self, scalars: Sequence[Scalar]) -> tuple[Scalar, ...]:
        """Each in its readable form, or as it is where that is too long."""
        return tuple(x if (short := self.read(x)) is None else short for x in scalars)


def _written(x: Scalar) -> Scalar | None:
    """x multiplied out and written shortly; None where that takes too much work."""
    try:
        return readable(x, WORK) if len(normal_form(x, WORK).terms) <= WAVES else None
    except TooLarge:
        return None


def holds_roots(x: Scalar) -> bool:
    """True where x holds functions other than sines and cosines."""
    return any(node.op not in POLYNOMIAL for node in order((x,)))


def omitted(*expressions: Scalar) -> Omitted:
    """That the expressions are too long to print."""
    return Omitted(operations(expressions).total)


@dataclass(frozen=True)
class Shortened:
    """Expressions in which long and repeated parts have names.

    Args:
        definitions: (symbol, what it stands for), each before its use.
        expressions: written with the symbols.
    """

    definitions: tuple[tuple[Node, Scalar], ...]
    expressions: tuple[Scalar, ...]


def shortened(graph: Graph, expressions: Sequence[Scalar], limit: int, taken: Container[str]) -> Shortened | None:
    """The expressions with named parts z1, z2, ..., so that none is much longer than `limit` characters.

    None where the names would be too many for a reader.
    """
    parts = named_parts(expressions, limit)
    if len(parts) > NAMED:
        return None
    used = {node.name for node in order(expressions) if node.op == "symbol"}
    names = free_names("z", len(parts), lambda name: name in taken or name in used)
    known: dict[Node, Scalar] = {}
    definitions = []
    for part, name in zip(parts, names, strict=True):
        value = substituted((part,), known)[0]
        known[part] = graph.symbol(name)
        definitions.append((graph.symbol(name), value))
    written = substituted(expressions, known)
    length = sum(text_size(x) for x in (*written, *(value for _, value in definitions)))
    return Shortened(tuple(definitions), written) if length <= NAMED_LENGTH else None


def free_names(letter: str, count: int, taken) -> list[str]:
    """letter1, letter2, ..., without those that are taken."""
    names: list[str] = []
    number = 0
    while len(names) < count:
        number += 1
        if not taken(f"{letter}{number}"):
            names.append(f"{letter}{number}")
    return names
