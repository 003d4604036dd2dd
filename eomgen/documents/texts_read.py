"""A document and the text or JSON that was made of it -> checks that this, read again, says what the document says."""

from __future__ import annotations

import json
import re
import unicodedata
from collections import deque
from collections.abc import Iterable, Iterator, Mapping
from itertools import chain
from typing import Any

from eomgen.documents.document import Document
from eomgen.documents.read_back import NAME, Unlike, columns_of, misspelt, number_said
from eomgen.documents.statements import (
    Cell,
    Code,
    Entry,
    Formula,
    Found,
    Grid,
    Law,
    Lines,
    Listing,
    Matrix,
    Name,
    Omitted,
    Partial,
    Piece,
    Prose,
    Quantity,
    Rate,
    Side,
    Statement,
    Table,
)
from eomgen.documents.text import cases_text, formula_as_text, is_piecewise
from eomgen.proof import Check, checked
from eomgen.symbolic.expression import Node

# -------- json read back --------------------------------------------------------------------------------------
# A document and the JSON that was made of it -> whether it says, read again, what the document holds.


HOW = "entry by entry"


def json_read_back(document: Document, entries: Mapping[str, Any], text: str) -> Iterable[Check]:
    """Checks that the JSON text says what the document holds.

    Args:
        entries: those of the document.
    """
    try:
        reported = json.loads(text)
        count = _same(entries, {name: reported.get(name) for name in entries}, "") if entries else 0
        if document.has_heads and "steps" not in entries:
            count += _steps(document, reported)
    except Unlike as error:
        return (checked(NAME, str(error), HOW),)
    return (Check(NAME, "holds", HOW, f"of {count}"),) if count else ()


def _same(entry: Any, reported: Any, where: str) -> int:
    """Number of leaves of an entry, all of which are reported as they are.

    Raises:
        Unlike: one is reported otherwise.
    """
    if isinstance(entry, Quantity):
        return _quantity(entry, reported, where)
    if isinstance(entry, Mapping):
        if not isinstance(reported, dict) or list(map(str, entry)) != list(reported):
            raise Unlike(f"{where or 'the whole'}: other entries")
        return sum(_same(inner, reported[str(name)], f"{where}.{name}".lstrip(".")) for name, inner in entry.items())
    if isinstance(entry, (list, tuple)):
        if not isinstance(reported, list) or len(reported) != len(entry):
            raise Unlike(f"{where}: not {len(entry)} entries")
        return sum(_same(a, b, f"{where}[{k}]") for k, (a, b) in enumerate(zip(entry, reported, strict=True)))
    if entry != reported:
        raise Unlike(f"{where}: {reported!r:.60} for {entry!r:.60}")
    return 1


def _quantity(found: Quantity, reported: Any, where: str) -> int:
    """Its formula, number, unit, way and message under these names."""
    wanted = {"exact": found.exact, "value": found.value, "unit": found.unit}
    wanted |= {"method": found.method or None, "message": found.message}
    if not isinstance(reported, dict):
        raise Unlike(f"{where}: {reported!r:.60} for a quantity")
    for name, right in wanted.items():
        if (reported.get(name) or None) != (right or None) or (name == "value" and reported.get(name) != right):
            raise Unlike(f"{where}.{name}: {reported.get(name)!r:.60} for {right!r:.60}")
    return 1


def _steps(document: Document, reported: Mapping[str, Any]) -> int:
    """The sections, each with its title and statements; every symbol set by itself."""
    if len(reported["steps"]) != len(document.steps):
        raise Unlike(f"{len(reported['steps'])} steps for {len(document.steps)}")
    count = 0
    for step, section in zip(document.steps, reported["steps"], strict=True):
        if (section["key"], section["title"]) != (step.key, step.title):
            raise Unlike(f"'{section['title']}' for '{step.title}'")
        if len(section["statements"]) != len(step.statements):
            raise Unlike(f"{step.title}: {len(section['statements'])} statements for {len(step.statements)}")
        for statement, said in zip(step.statements, section["statements"], strict=True):
            _statement(statement, said, step.title)
            count += 1
    letters = list(reported["symbols"].values())
    if len(set(letters)) != len(letters):
        raise Unlike("two symbols are set alike")
    if wrong := misspelt(reported["symbols"], document.notation):
        raise Unlike(wrong)
    return count


def _statement(statement: Statement, reported: Mapping[str, Any], where: str) -> None:
    wanted: Any
    if isinstance(statement, Grid):
        found: Any = [reported["head"], *reported["rows"]]
        wanted = [list(map(cell_said, row)) for row in (statement.head, *statement.rows)]
    elif isinstance(statement, Table):
        found = [[row[key] for key in ("symbol", "meaning", "unit", "value")] for row in reported["rows"]]
        wanted = [[side_said(row.symbol), row.meaning, row.unit, row.value] for row in statement.rows]
    elif isinstance(statement, Formula):
        found, wanted = [[reported["text"]]], [["=".join(map(side_said, statement.sides))]]
    elif isinstance(statement, Prose):
        found, wanted = [[reported["text"]]], [["".join(map(piece_said, statement.pieces))]]
    else:
        lines = statement.lines if isinstance(statement, Lines) else map(row_said, statement.rows)
        found, wanted = [["".join(reported["lines"])]], [["".join(lines)]]
    if [list(map(flat, row)) for row in found] != [list(map(flat, row)) for row in wanted]:
        pairs = [(a, b) for x, y in zip(found, wanted, strict=False) for a, b in zip(x, y, strict=False)]
        said, right = next(((a, b) for a, b in pairs if flat(a) != flat(b)), ("other rows", ""))
        raise Unlike(f"{where}: '{said:.60}' for '{right:.60}'")


# -------- text read back --------------------------------------------------------------------------------------
# A document and the text that was made of it -> whether the text says what the document holds, read line by line.
#
# Formulas stand there as the grammar writes them, and are proven as such; here they are to stand in their places,
# whole. The cells of a table are read by where they begin, each under its head.


LINES = "line by line, cells by their places"
SHOWN = 60  # characters of a quoted text
_RAISED = re.compile(r"\^\((-?\d+)\)")
_CELL = re.compile(r"\S+(?: \S+)*")
_FLAT = str.maketrans({"^": "", "·": "*", "\u2212": "-"})


def flat(text: str) -> str:
    """Text without blanks; exponents as digits, raised or not."""
    return "".join(unicodedata.normalize("NFKC", _RAISED.sub(r"\1", text)).translate(_FLAT).split())


class TextRead:
    """Lines that are read one after the other.

    Args:
        text: of the page, without its proof.
    """

    def __init__(self, text: str) -> None:
        self.lines = deque(line for line in text.split("\n") if line.strip())

    def document(self, document: Document) -> int:
        """Reads the whole page and returns the number of its statements.

        Raises:
            Unlike: it says something else.
        """
        if document.has_heads:
            self._heading(document.title, "=")
            for text in (document.about, document.source_words):
                self._says(text)
        count = 0
        for number, step in enumerate(document.steps, start=1):
            if step.title:
                self._heading(f"{number}. {step.title}", "-")
            for statement in step.statements:
                self._statement(statement)
                count += 1
        if self.lines:
            raise Unlike(f"more stands on the page: '{self.lines[0].strip()[:SHOWN]}'")
        return count

    def _heading(self, title: str, rule: str) -> None:
        self._says(title)
        if title.strip():
            self._says(rule * len(title))

    def _statement(self, statement: Statement) -> None:
        if isinstance(statement, (Table, Grid)):
            self._table(statement if isinstance(statement, Grid) else columns_of(statement))
        elif isinstance(statement, Listing):
            for row in statement.rows:
                self._says(row_said(row))
        elif isinstance(statement, Lines):
            self._says("".join(statement.lines))
        elif isinstance(statement, Prose):
            self._says("".join(map(piece_said, statement.pieces)))
        else:
            self._says(formula_said(statement))

    def _says(self, wanted: str) -> None:
        """The next lines say this, and no more."""
        whole, said = flat(wanted), 0
        while said < len(whole):
            if not self.lines:
                raise Unlike(f"'{wanted[:SHOWN]}' is missing")
            line = flat(self.lines[0])
            if not whole.startswith(line, said):
                raise Unlike(f"'{self.lines[0].strip()[:SHOWN]}' for '{wanted[:SHOWN]}'")
            said += len(line)
            self.lines.popleft()

    def _table(self, grid: Grid) -> None:
        """Heads, then rows: each cell begins where its head does, or where it does in the other rows."""
        begins: dict[int, int] = {}
        if not any(map(flat, chain.from_iterable(map(cell_said, row) for row in (grid.head, *grid.rows)))):
            return
        for row in (grid.head, *grid.rows):
            rest = {k: text for k, cell in enumerate(row) if (text := flat(cell_said(cell)))}
            where = next(iter(rest.values()), "")
            while rest:
                if not self.lines:
                    raise Unlike(f"a row of a table is missing: '{where[:SHOWN]}'")
                line = self.lines.popleft()
                for k, begin, text in _placed(line, rest):
                    if begins.setdefault(k, begin) != begin:
                        raise Unlike(f"'{text[:SHOWN]}' does not stand under its head, row '{where[:SHOWN]}'")
                    if not rest[k].startswith(text):
                        raise Unlike(f"'{text[:SHOWN]}' for '{rest[k][:SHOWN]}'")
                    rest[k] = rest[k][len(text) :]
                rest = {k: text for k, text in rest.items() if text}
        inner = sorted(begins.items())
        if [begin for _, begin in inner] != sorted({begin for _, begin in inner}):
            raise Unlike("columns of a table are not side by side")


def _placed(line: str, rest: dict[int, str]) -> Iterator[tuple[int, int, str]]:
    """(column, where it begins, text) of the cells of a line: those that are still to be said, in their order."""
    columns = list(rest)
    for found in _CELL.finditer(line):
        text = flat(found[0])
        while columns and not rest[columns[0]].startswith(text):
            columns.pop(0)
        if not columns:
            raise Unlike(f"'{found[0][:SHOWN]}' stands in no column of its row")
        yield columns.pop(0), found.start(), text


def row_said(row: Found) -> str:
    """A quantity by its name."""
    reported = f"{row.name}:{row.words}" if row.words else row.name
    return reported + _quantity_said(row.quantity)


def _quantity_said(found: Quantity) -> str:
    if found.exact is None and found.value is None:
        return f"not answered: {found.message}"
    said = "" if found.exact is None else f"={found.exact}"
    said += "" if found.value is None else f"={number_said(found)}{found.unit or ''}"
    return said + (f"[{found.method}]" if found.method else "") + (f"({found.message})" if found.message else "")


def piece_said(piece: Piece | Side) -> str:
    """A piece of a sentence."""
    if isinstance(piece, str):
        return piece
    return f"`{piece.text}`" if isinstance(piece, Code) else side_said(piece)


def cell_said(cell: Cell) -> str:
    """A cell of a table."""
    return cell if isinstance(cell, str) else side_said(cell)


def formula_said(formula: Formula) -> str:
    """a = b; a matrix row by row, cases one below the other."""
    *left, last = formula.sides
    said = [side_said(side) for side in left]
    if left and isinstance(last, Matrix):
        said.append("".join("[" + "".join(map(side_said, row)) + "]" for row in last.rows))
    elif left and is_piecewise(last):
        said.append("".join(cases_text(last)))
    else:
        said.append(side_said(last))
    return "=".join(said)


def side_said(side: Side) -> str:
    """Quantities by their letters, as Q(theta), v(bob)^2, M[x, y], -dV/dx; a formula as it is proven."""
    if isinstance(side, Name):
        whose = ",".join([*([side.by.name] if side.by is not None else []), *([side.of] if side.of else [])])
        return side.letter + (f"({whose})" if whose else "") + (str(side.power) if side.power != 1 else "")
    if isinstance(side, Entry):
        return f"{side.letter}[{side.row.name},{side.column.name}]"
    if isinstance(side, Partial):
        return f"{'-' if side.sign == -1 else ''}d{side_said(side.of)}/d{side.by.name}"
    if isinstance(side, Rate):
        return f"{side.of.name}'" if isinstance(side.of, Node) else f"d/dt({side_said(side.of)})"
    if isinstance(side, Law):
        return side.text
    if isinstance(side, Omitted):
        return f"({side.operations}operations,notprinted)"
    if isinstance(side, Matrix):
        return "[" + ",".join("[" + ",".join(map(side_said, row)) + "]" for row in side.rows) + "]"
    return ";".join(cases_text(side)) if is_piecewise(side) else formula_as_text(side)


def text_read_back(document: Document, text: str) -> Iterable[Check]:
    """Checks that a text says what its document holds.

    Args:
        text: without its proof.
    """
    try:
        return (Check(NAME, "holds", LINES, f"of {TextRead(text).document(document)}"),)
    except Unlike as error:
        return (checked(NAME, str(error), LINES),)
