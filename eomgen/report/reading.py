"""Graph scalars -> the same scalars as a reader wants them, with bounded work; what is too long to print is known."""

from __future__ import annotations

from collections.abc import Container, Sequence
from dataclasses import dataclass

from eomgen.report.statements import Omitted
from eomgen.symbolic.derivative import substituted
from eomgen.symbolic.evaluation import operations, order
from eomgen.symbolic.graph import Graph, Node, Scalar
from eomgen.symbolic.normal_form import readable
from eomgen.symbolic.text import named_parts, text_size

WORK = 2000  # products of terms that are multiplied out for one formula
LONGEST = 1800  # characters of one formula in print
TRIED = 20_000  # characters: what is longer by far will not become short
NAMED = 40  # sub-expressions with a name of their own, at most
NAMED_LENGTH = 6000  # characters of all named sub-expressions together, at most


def read(x: Scalar) -> Scalar | None:
    """x in its readable form; None where it is too long to print."""
    size = text_size(x)
    if size > TRIED:
        return None
    short = readable(x, WORK)
    if text_size(short) <= LONGEST:
        return short
    return x if size <= LONGEST else None


def shown(x: Scalar) -> Scalar | Omitted:
    """x in its readable form, or how large it is."""
    short = read(x)
    return omitted(x) if short is None else short


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
