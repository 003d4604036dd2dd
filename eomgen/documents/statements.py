"""Elements of a derivation: steps of typed statements, in which formulas are graph scalars until they are printed.

Plain strings are plain text in every format: each format escapes them in its own way.
"""

from __future__ import annotations

import math
import re
from collections.abc import Container, Iterator, Mapping, Sequence
from dataclasses import field
from functools import cached_property
from typing import Any

from eomgen.frozen import dataclass
from eomgen.symbolic.expression import Node, Scalar, operations
from eomgen.symbolic.print import Symbol


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

    @classmethod
    def of_letter(cls, text: str) -> Law:
        """A letter, with an index or without: v_x, J_xy, omega."""
        return cls(text, Symbol.of(text).tex)


@dataclass(frozen=True)
class Omitted:
    """Expressions that are too long to be printed.

    Args:
        parts: of each its expressions.
    """

    parts: tuple[tuple[Scalar, ...], ...]

    @cached_property
    def operations(self) -> int:
        """Number of operations, summed over the parts."""
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
    """Meaning of a symbol.

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
    """A list of symbols and their meanings; `head` names the columns symbol, meaning, unit, value."""

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


class Head(str):
    """The head of a column in another language; `key` is what it is called in ours."""

    __slots__ = ("key",)
    key: str


def key_of(head: Cell) -> Cell:
    """The head of a column as this program calls it, in whatever language it stands."""
    return getattr(head, "key", head)


def narrow_grid(head: Sequence[Cell], rows: Sequence[tuple[Cell, ...]], kept: Sequence[int] | None = None) -> Grid:
    """The table with these of its columns; None: with those in which something stands."""
    if kept is None:
        kept = [k for k in range(len(head)) if any(row[k] != "" for row in rows)]
    return Grid(tuple(head[k] for k in kept), tuple(tuple(row[k] for k in kept) for row in rows))


@dataclass(frozen=True)
class Found:
    """A quantity by its name, and its meaning in words.

    Args:
        letter: a name under which formulas have it; "" where that is its own.
        symbol: how it is set, where its author says so.
    """

    name: str
    quantity: Quantity
    words: str = ""
    letter: str = ""
    symbol: Symbol | None = None

    @property
    def letters(self) -> tuple[Law, ...]:
        """The letter that formulas have for it; none where it has none."""
        name = self.letter or self.name
        if self.symbol is not None:
            return (Law(name, self.symbol.tex),)
        return (Law.of_letter(name),) if name.isidentifier() else ()


@dataclass(frozen=True)
class Listing:
    """Quantities one after the other, each with its known values."""

    rows: tuple[Found, ...]


@dataclass(frozen=True)
class Lines:
    """Text that stands as it is: paths, counts, words of a tool."""

    lines: tuple[str, ...]


Statement = Prose | Formula | Table | Grid | Listing | Lines


def parts_of(statement: Statement) -> list[Piece | Side]:
    """Parts of a statement: words, symbols, quantities, formulas."""
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
    """One step of a derivation, a section of a document.

    Args:
        key: names it for machines, "" where it has no head.
        room: to write in, below it [cm].
    """

    key: str
    title: str
    statements: tuple[Statement, ...]
    room: int = 0


@dataclass(frozen=True)
class Equation:
    """One equation of motion, as printed.

    Args:
        speed: whose equation it is.
        left: inertia: (M a + c) / divisor.
        right: forces: (Q + J^T lam) / divisor.
        divisor: the factor by which both sides were divided.
    """

    speed: Node
    left: Scalar
    right: Scalar
    divisor: Scalar = 1


# -------- notation --------------------------------------------------------------------------------------------
# Steps -> the last step: what the letters mean that stand for quantities.


MEANINGS = {
    "T": ("kinetic energy, of the whole or of a body", "J"),
    "V": ("potential energy, of the whole or of a force", "J"),
    "Q": ("generalized force along a coordinate, of everything applied or of one force", ""),
    "M": ("mass matrix", ""),
    "c": ("inertia terms that are left when nothing accelerates", ""),
    "x": ("position along x, ground axes", "m"),
    "y": ("position along y, ground axes", "m"),
    "z": ("position along z, ground axes", "m"),
    "vx": ("velocity along x, ground axes", "m/s"),
    "vy": ("velocity along y, ground axes", "m/s"),
    "vz": ("velocity along z, ground axes", "m/s"),
    "speed": ("magnitude of the velocity", "m/s"),
    "angle": ("angle of a body against the x axis, counter-clockwise", "rad"),
    "omega": ("angular velocity of a body, counter-clockwise", "rad/s"),
    "omega_1": ("angular velocity of a body about its own x axis", "rad/s"),
    "omega_2": ("angular velocity of a body about its own y axis", "rad/s"),
    "omega_3": ("angular velocity of a body about its own z axis", "rad/s"),
    "Fx": ("force along x, ground axes", "N"),
    "Fy": ("force along y, ground axes", "N"),
    "Fz": ("force along z, ground axes", "N"),
    "couple": ("couple on a body, counter-clockwise", "N*m"),
    "gap": ("function that a constraint holds at zero", ""),
    "Fin_x": ("inertia force of a body along x, minus mass times acceleration of the mass centre", "N"),
    "Fin_y": ("inertia force of a body along y, minus mass times acceleration of the mass centre", "N"),
    "Fin_z": ("inertia force of a body along z, minus mass times acceleration of the mass centre", "N"),
    "Min": ("inertia couple of a body, minus moment of inertia times angular acceleration", "N*m"),
    "Min_x": ("inertia couple of a body about its x axis, minus the rate of its angular momentum", "N*m"),
    "Min_y": ("inertia couple of a body about its y axis, minus the rate of its angular momentum", "N*m"),
    "Min_z": ("inertia couple of a body about its z axis, minus the rate of its angular momentum", "N*m"),
    "P_x": ("momentum of all bodies together along x, ground axes", "kg*m/s"),
    "P_y": ("momentum of all bodies together along y, ground axes", "kg*m/s"),
    "P_z": ("momentum of all bodies together along z, ground axes", "kg*m/s"),
    "L_x": ("angular momentum of all bodies together, along x, ground axes", "kg*m^2/s"),
    "L_y": ("angular momentum of all bodies together, along y, ground axes", "kg*m^2/s"),
    "L_z": ("angular momentum of all bodies together, along z, ground axes", "kg*m^2/s"),
    "L": ("magnitude of the angular momentum of all bodies together", "kg*m^2/s"),
    "Delta": ("what may be added to a reaction that is indeterminate", ""),
}
"""letter -> what it stands for, and its unit ("" where that depends on the coordinate)"""


def notation_step(steps: Sequence[Step], taken: Container[str], more: Sequence[Meaning] = ()) -> Step:
    """The letters that the steps use.

    Args:
        more: names that were given on the way.
        taken: the model's own names; where one of them is such a letter, the table says so.
    """
    letters = {name.letter for step in steps for statement in step.statements for name in quantities(statement)}
    rows = tuple(
        Meaning(Name(letter), meaning + (f"; not the model's own {letter}" if letter in taken else ""), unit)
        for letter, (meaning, unit) in MEANINGS.items()
        if letter in letters
    )
    return Step("notation", "Notation", (Table(("symbol", "meaning", "unit", ""), (*rows, *more)),))


def quantities(statement: Statement) -> Iterator[Name]:
    """The quantities that a statement names."""
    part: object
    for part in parts_of(statement):
        while isinstance(part, (Partial, Rate)):
            part = part.of
        if isinstance(part, Entry):
            yield Name(part.letter)
        elif isinstance(part, Name):
            yield part


# -------- quantity --------------------------------------------------------------------------------------------
# The results for one quantity: exact, as a number, the method; or the reason why they are missing.


WRITTEN_OUT = range(-4, 6)  # powers of ten of numbers that are written without one, however few digits are printed
_RAISED = str.maketrans("-0123456789", "⁻⁰¹²³⁴⁵⁶⁷⁸⁹")
_POWER = re.compile(r"\^(?:\((-?\d+)\)|(-?\d+))")


def unit_text(unit: str) -> str:
    """A unit as it is printed: kg*m^2 as kg·m², which is read back as well."""
    return _POWER.sub(lambda power: (power[1] or power[2]).translate(_RAISED), unit).replace("*", "·")


@dataclass(frozen=True)
class Quantity:
    """One result: exact, as a number, with the method; or the reason why it is missing.

    Args:
        exact: text of the grammar with every parameter as a symbol, or None: an equation between quantities.
        value: a number in the unit, parameters and start (or instant) put in, or None.
        unit: of the number; "" for SI, None where none is known.
        method: the method by which it was found.
        message: the reason if something is missing, or None.
        beside: further JSON entries by name: the way of its proof, its work.
        digits: those that it is printed with; None: ten, without zeros at the end.
    """

    exact: str | None = None
    value: float | None = None
    unit: str | None = ""
    method: str = ""
    message: str | None = None
    beside: Mapping[str, Any] = field(default_factory=dict)
    digits: int | None = None

    @property
    def answered(self) -> bool:
        return self.exact is not None or self.value is not None

    @property
    def number(self) -> str:
        """The number with its unit, as it is printed; "" where there is none."""
        return "" if self.value is None else f"{self._digits(self.value)} {unit_text(self.unit or '')}".rstrip()

    def _digits(self, value: float) -> str:
        """The number in its digits: of those that were requested zeros at the end stay, 7.00."""
        if self.digits is None or not math.isfinite(value):
            return f"{value:.10g}"
        text = f"{value:#.{self.digits}g}"
        if "e" not in text:
            return text.removesuffix(".")
        power = int(text.partition("e")[2])
        return f"{float(text):.0f}" if power in WRITTEN_OUT else f"{value:.{self.digits - 1}e}"

    @property
    def lines(self) -> list[str]:
        """A line for each thing that is known of it."""
        if not self.answered:
            return [f"not answered: {self.message}"]
        found = [f"= {part}" for part in (self.exact, self.number) if part]
        found[-1] += f"   [{self.method}]" if self.method else ""
        return [*found, f"({self.message})"] if self.message else found

    def as_dict(self) -> dict[str, Any]:
        """Entries for `--json`; unit, method and message only where they are given."""
        reported: dict[str, Any] = {"exact": self.exact, "value": self.value}
        reported |= {} if self.unit is None else {"unit": self.unit}
        reported |= {"method": self.method, "message": self.message} if self.method or self.message else {}
        return reported | dict(self.beside)

    def _repr_markdown_(self) -> str:
        parts = [f"`{self.exact}`" if self.exact is not None else "", self.number]
        return " = ".join(part for part in parts if part) or (self.message or "")
