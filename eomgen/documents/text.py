"""Document -> plain text, 100 columns wide. Formulas are in the grammar of the model file."""

from __future__ import annotations

import textwrap
from collections.abc import Iterator
from functools import lru_cache
from typing import TypeGuard

from eomgen.documents.document import Document
from eomgen.documents.reading import without_cases
from eomgen.documents.statements import (
    Cell,
    Code,
    Entry,
    Formula,
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
    Rate,
    Side,
    Statement,
    key_of,
    unit_text,
)
from eomgen.symbolic.expression import Node, Scalar
from eomgen.symbolic.print import to_text

name = "text"

RELATIONS = {"less": "<", "less_equal": "<="}
KEPT = 4096  # texts of formulas that may be needed again
WIDTH = 100
INDENT = "    "
MEANING = 20  # characters that a column of meanings has at least
LAST = 30  # the same of the last column of a grid


def render(document: Document) -> str:
    """The document as text: contradictions first, its proof last."""
    lines = [document.distrust, ""] if document.distrust else []
    lines += [*_headed(document.title, "="), *_remarks(document)] if document.has_heads else []
    for number, step in enumerate(document.steps, start=1):
        lines += ["", *_headed(f"{number}. {step.title}", "-")] if step.title else []
        lines += [line for statement in step.statements for line in statement_lines(statement)]
    lines += ["", document.proof] if document.proof else []
    return "".join(f"{line}\n" for line in lines)


def _headed(title: str, rule: str) -> list[str]:
    return [title, rule * len(title)]


def _remarks(document: Document) -> list[str]:
    return [line for text in (document.about, document.source_words) if text for line in textwrap.wrap(text, WIDTH)]


def statement_lines(statement: Statement) -> list[str]:
    """A statement on lines of text."""
    if isinstance(statement, Lines):
        return list(statement.lines)
    if isinstance(statement, Listing):
        return _listing_lines(statement)
    if isinstance(statement, Prose):
        return textwrap.wrap(prose_text(statement), WIDTH)
    if isinstance(statement, Formula):
        *left, last = statement.sides
        if left and is_piecewise(last):
            head = broken(f"{formula_text(Formula(tuple(left)))} =", INDENT, WIDTH)
            return [*head, *(line for case in cases_text(last) for line in broken(case, 2 * INDENT, WIDTH))]
        if left and isinstance(last, Matrix):
            return _matrix_lines(f"{INDENT}{formula_text(Formula(tuple(left)))} = ", last)
        return broken(formula_text(statement), INDENT, WIDTH)
    if isinstance(statement, Grid):
        return _column_lines(statement, len(statement.head) - 1, LAST)
    grid = statement.grid
    keys = list(map(key_of, grid.head))
    return _column_lines(grid, keys.index("meaning") if "meaning" in keys else 0, MEANING)


def _matrix_lines(lead: str, matrix: Matrix) -> list[str]:
    """M = [a  b], a row a line, its columns below one another."""
    rows = [[side_text(entry) for entry in row] for row in matrix.rows]
    widths = [max(map(len, column)) for column in zip(*rows, strict=True)]
    lines = ["  ".join(x.ljust(width) for x, width in zip(row, widths, strict=True)) for row in rows]
    return [f"{lead if k == 0 else ' ' * len(lead)}[{line}]" for k, line in enumerate(lines)]


def prose_text(prose: Prose) -> str:
    """A sentence on one line."""
    return "".join(piece_text(piece) for piece in prose.pieces)


def piece_text(piece: Piece) -> str:
    """One piece of a sentence."""
    if isinstance(piece, str):
        return piece
    return f"`{piece.text}`" if isinstance(piece, Code) else side_text(piece)


def formula_text(formula: Formula) -> str:
    """A formula on one line: T = 6*M*R^2*theta'^2."""
    return " = ".join(side_text(side) for side in formula.sides)


def side_text(side: Side) -> str:
    """One side of a formula; scalars as the grammar reads them back."""
    if isinstance(side, Name):
        return _name_text(side)
    if isinstance(side, Entry):
        return f"{side.letter}[{side.row.name}, {side.column.name}]"
    if isinstance(side, Partial):
        return f"{'-' if side.sign < 0 else ''}d{_name_text(side.of)}/d{side.by.name}"
    if isinstance(side, Rate):
        return side.of.name + "'" if isinstance(side.of, Node) else f"d/dt({side_text(side.of)})"
    if isinstance(side, Matrix):
        rows = (f"[{', '.join(map(side_text, row))}]" for row in side.rows)
        return f"[{', '.join(rows)}]"
    if isinstance(side, Omitted):
        return f"({side.operations} operations, not printed)"
    if isinstance(side, Law):
        return side.text
    return "; ".join(cases_text(side)) if is_piecewise(side) else formula_as_text(side)


@lru_cache(maxsize=KEPT, typed=True)
def formula_as_text(x: Scalar) -> str:
    """A formula as the grammar reads it: used when it is printed, and when that is read back."""
    return to_text(without_cases((x,))[0])


def is_piecewise(side: Side) -> TypeGuard[Node]:
    """True for a quantity that has one formula in one case and another one in the next."""
    return isinstance(side, Node) and side.op == "select" and side.args[0].op in RELATIONS


def cases_text(x: Scalar) -> list[str]:
    """["m*g*sin(alpha) where s <= L", "0 otherwise"], each case evaluated where those before it do not hold."""
    cases: list[str] = []
    while is_piecewise(x):
        condition, if_true, x = x.args
        relation = f" {RELATIONS[condition.op]} ".join(to_text(a) for a in without_cases(condition.args))
        cases.append(f"{to_text(without_cases((if_true,))[0])} {'else ' if cases else ''}where {relation}")
    return [*cases, f"{to_text(without_cases((x,))[0])} otherwise"]


def _name_text(quantity: Name) -> str:
    inside = ", ".join(([quantity.by.name] if quantity.by is not None else []) + ([quantity.of] if quantity.of else []))
    text = f"{quantity.letter}({inside})" if inside else quantity.letter
    return text if quantity.power == 1 else f"{text}^{quantity.power}"


def _listing_lines(listing: Listing) -> list[str]:
    """Each name and its value to its right; below it where it is explained in words."""
    width = max((len(row.name) for row in listing.rows), default=0)
    lines: list[str] = []
    for row in listing.rows:
        if row.words:
            lines += [
                f"{row.name}: {row.words}",
                *(x for line in row.quantity.lines for x in broken(line, INDENT, WIDTH)),
            ]
        else:
            first, *more = (x for line in row.quantity.lines for x in _on_lines(line, WIDTH - width - 2))
            lines += [f"{row.name:<{width}}  {first}", *(f"{'':<{width}}  {line}" for line in more)]
    return lines


def _on_lines(text: str, width: int) -> list[str]:
    """A formula on lines of at most `width` characters; of a name that leaves no room on one."""
    return [line.removeprefix(INDENT) for line in broken(text, INDENT, width + len(INDENT))] if width > LAST else [text]


def cell_text(cell: Cell) -> str:
    """A cell of a grid."""
    return cell if isinstance(cell, str) else side_text(cell)


def _cell(head: Cell, cell: Cell) -> str:
    """A cell below its head."""
    return unit_text(cell_text(cell)) if head == "unit" else cell_text(cell)


def _column_lines(grid: Grid, wrapped: int, least: int) -> list[str]:
    """Columns as wide as their content; one is wrapped where they do not fit side by side.

    Args:
        least: the width that is left to that column.
    """
    heads, keys = tuple(map(cell_text, grid.head)), tuple(map(key_of, grid.head))
    rows = [heads, *(tuple(map(_cell, keys, row)) for row in grid.rows)]
    if not any(rows):
        return []
    widths = [max(map(len, column)) for column in zip(*rows, strict=True)]
    most = max(least, WIDTH - len(INDENT) - sum(width + 2 for k, width in enumerate(widths) if k != wrapped))
    widths[wrapped] = max(MEANING, min(widths[wrapped], most)) if wrapped else widths[wrapped]
    lines: list[str] = []
    for row in rows:
        for number, part in enumerate(textwrap.wrap(row[wrapped], most) or [""]):
            cells = [part if k == wrapped else "" if number else cell for k, cell in enumerate(row)]
            line = "  ".join(cell.ljust(width) for cell, width in zip(cells, widths, strict=True))
            lines.append(f"{INDENT}{line}".rstrip())
    return lines


def broken(text: str, indent: str, width: int) -> list[str]:
    """A formula on lines of at most `width` characters, broken before = + and - of the least depth.

    A piece that cannot be broken stays whole.
    """
    lines, start, hang = [], 0, indent
    while len(text) - start > width - len(hang):
        stop = _break(text, start, start + width - len(hang))
        if stop is None:
            break
        lines.append(hang + text[start:stop].rstrip())
        start, hang = stop, indent * 2
    return [*lines, hang + text[start:]]


def _break(text: str, start: int, end: int) -> int | None:
    """Place to break a line: the last sign of least depth before `end`, not too near the start; else the next one."""
    within: list[tuple[int, int]] = []
    for sign in _signs(text, start):
        if sign[1] > end:
            if not within:
                return sign[1]
            break
        within.append(sign)
    if not within:
        return None
    far = [sign for sign in within if sign[1] > start + (end - start) // 3]
    return min(far or within, key=lambda sign: (sign[0], -sign[1]))[1]


def _signs(text: str, start: int) -> Iterator[tuple[int, int]]:
    """(depth in parentheses, place) of every = + - between blanks."""
    depth = 0
    for i in range(start + 1, len(text) - 1):
        depth += (text[i] in "([") - (text[i] in ")]")
        if text[i] in "+-=" and text[i - 1] == text[i + 1] == " ":
            yield depth, i
