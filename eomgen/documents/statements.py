"""What a derivation is made of: steps of typed statements, in which formulas are graph scalars until they are printed.

Plain strings are plain text in every format: each format escapes them in its own way.
"""

from __future__ import annotations

from collections.abc import Sequence
from functools import cached_property

from eomgen.documents.quantity import Quantity
from eomgen.records import dataclass
from eomgen.symbolic.expression.graph import Node, Scalar
from eomgen.symbolic.expression.traversal import operations


@dataclass(frozen=True)
class Name:
    """A quantity by its letter: T, V, Q(theta), x(arm.center), speed(arm.center)^2.

    Args:
        letter: as `text_of` and LETTERS of the formats know it.
        of: whose it is: a body, a force, a point.
        by: the symbol that it belongs to: Q(theta).
        power: a whole exponent.
    """

    letter: str
    of: str = ""
    by: Node | None = None
    power: int = 1


@dataclass(frozen=True)
class Entry:
    """An entry of a matrix: M[theta, phi]."""

    letter: str
    row: Node
    column: Node


@dataclass(frozen=True)
class Partial:
    """The partial derivative of a quantity: dT/dtheta'; with a minus sign where `sign` is -1."""

    of: Name
    by: Node
    sign: int = 1


@dataclass(frozen=True)
class Rate:
    """A time derivative: of a coordinate (`theta'`), or of a quantity (d/dt(dT/dtheta'))."""

    of: Node | Name | Partial


@dataclass(frozen=True)
class Law:
    """A general law, printed as it stands: for text, and for LaTeX."""

    text: str
    latex: str


@dataclass(frozen=True)
class Omitted:
    """What is too long to be printed.

    Args:
        parts: of each its expressions.
    """

    parts: tuple[tuple[Scalar, ...], ...]

    @cached_property
    def operations(self) -> int:
        """How many it has, part by part."""
        return sum(operations(part).total for part in self.parts)


@dataclass(frozen=True)
class Matrix:
    """A matrix as it stands: rows of scalars or numbers."""

    rows: tuple[tuple[Scalar | Law, ...], ...]


@dataclass(frozen=True)
class Code:
    """Something that a user types."""

    text: str


Side = Name | Entry | Partial | Rate | Law | Omitted | Matrix | Scalar
Piece = str | Code | Name | Entry | Partial | Rate | Law | Node


@dataclass(frozen=True)
class Prose:
    """A sentence, with formulas inside."""

    pieces: tuple[Piece, ...]


def prose(*pieces: Piece) -> Prose:
    """A sentence of these pieces."""
    return Prose(pieces)


@dataclass(frozen=True)
class Formula:
    """sides joined by equality signs, on a line of their own."""

    sides: tuple[Side, ...]


@dataclass(frozen=True)
class Meaning:
    """What a symbol stands for.

    Args:
        symbol: a symbol of the formulas, or a quantity.
        meaning: in words, "" where nothing is known.
        unit: "" for a plain number.
        value: as text, "" where it has none.
    """

    symbol: Side
    meaning: str
    unit: str = ""
    value: str = ""


@dataclass(frozen=True)
class Table:
    """A list of symbols and what they stand for; `head` names the columns symbol, meaning, unit, value."""

    head: tuple[str, str, str, str]
    rows: tuple[Meaning, ...]

    @property
    def grid(self) -> Grid:
        """Its columns in which something stands."""
        return narrow_grid(self.head, [(row.symbol, row.meaning, row.unit, row.value) for row in self.rows])


Cell = str | Side


@dataclass(frozen=True)
class Grid:
    """A table of any columns.

    Args:
        head: the names of the columns, words or letters.
        rows: words or formulas, one cell for each column.
    """

    head: tuple[Cell, ...]
    rows: tuple[tuple[Cell, ...], ...]


def narrow_grid(head: Sequence[Cell], rows: Sequence[tuple[Cell, ...]], kept: Sequence[int] | None = None) -> Grid:
    """The table with these of its columns; None: with those in which something stands."""
    if kept is None:
        kept = [k for k in range(len(head)) if any(row[k] != "" for row in rows)]
    return Grid(tuple(head[k] for k in kept), tuple(tuple(row[k] for k in kept) for row in rows))


@dataclass(frozen=True)
class Found:
    """A quantity by its name, and what it is in words."""

    name: str
    quantity: Quantity
    words: str = ""


@dataclass(frozen=True)
class Listing:
    """Quantities one after the other, each with what is known of it."""

    rows: tuple[Found, ...]


@dataclass(frozen=True)
class Lines:
    """Text that stands as it is: paths, counts, words of a tool."""

    lines: tuple[str, ...]


Statement = Prose | Formula | Table | Grid | Listing | Lines


def parts_of(statement: Statement) -> list[Piece | Side]:
    """What stands in a statement: words, symbols, quantities, formulas."""
    if isinstance(statement, Formula):
        return list(statement.sides)
    if isinstance(statement, Prose):
        return list(statement.pieces)
    if isinstance(statement, Table):
        return [row.symbol for row in statement.rows]
    if isinstance(statement, (Listing, Lines)):
        return []
    return [cell for row in (statement.head, *statement.rows) for cell in row]


@dataclass(frozen=True)
class Step:
    """One step of a derivation, a section of a document; `key` names it for machines, "" where it has no head."""

    key: str
    title: str
    statements: tuple[Statement, ...]


@dataclass(frozen=True)
class Equation:
    """One equation of motion, as printed.

    Args:
        speed: whose equation it is.
        left: inertia: (M a + c) / divisor.
        right: forces: (Q + J^T lam) / divisor.
        divisor: what both sides were divided by.
    """

    speed: Node
    left: Scalar
    right: Scalar
    divisor: Scalar = 1
