"""Formulas of one step -> as many of them as a reader can take, and an honest word about the rest."""

from __future__ import annotations

from collections.abc import Iterable, Sequence

from eomgen.documents.reading import Reader, omitted
from eomgen.documents.statements import Cell, Code, Formula, Grid, Law, Omitted, Prose, Side, Statement, prose
from eomgen.documents.text import side_text
from eomgen.symbolic.expression import Scalar
from eomgen.symbolic.print import latex_escaped, text_size

WIDE = 96  # characters of a table, all columns side by side
PAGE = 5000  # characters of formulas in one step
FULL = Code("eomgen derive MODEL --full")


def page(reader: Reader, pairs: Iterable[tuple[Side, Scalar]], *, then: tuple[Side, ...] = ()) -> tuple[Statement, ...]:
    """name = readable scalar (= then), up to a page of them; the rest is counted, not read."""
    kept: list[Statement] = []
    length, left_out = 0, 0
    for name, x in pairs:
        shown = reader.shown(x) if reader.full or length < PAGE else omitted(x)
        if isinstance(shown, Omitted):
            left_out += 1
        else:
            kept.append(Formula((name, shown, *then)))
            length += text_size(shown)
    return (*kept, *_rest(left_out, len(kept))) if left_out else tuple(kept)


def tabled(head: tuple[str, ...], rows: Sequence[tuple[Cell, ...]]) -> tuple[Statement, ...]:
    """A table; where its columns do not fit side by side a formula for each of its cells."""
    lines = [head, *([cell if isinstance(cell, str) else side_text(cell) for cell in row] for row in rows)]
    if sum(max(map(len, column)) + 2 for column in zip(*lines, strict=True)) <= WIDE:
        return (Grid(head, tuple(rows)),)
    return tuple(
        Formula((_named(row[0], what), cell))
        for row in rows
        for what, cell in zip(head[1:], row[1:], strict=True)
        if not isinstance(cell, str)
    )


def _named(first: Cell, what: str) -> Law:
    """Name of a cell, by its row and its column."""
    if isinstance(first, Law):
        return Law(f"{first.text}, {what}", rf"{first.latex},\ \text{{{latex_escaped(what)}}}")
    words = f"{first if isinstance(first, str) else side_text(first)}, {what}"
    return Law(words, rf"\text{{{latex_escaped(words)}}}")


def _rest(left_out: int, kept: int) -> tuple[Statement, ...]:
    number = f"{left_out} more" if kept else "All" if left_out > 1 else "It"
    verb = "are" if left_out > 1 else "is"
    return (prose(f"{number} {verb} too long to print here; ", FULL, f" prints {'them' if left_out > 1 else 'it'}."),)


def elsewhere(operations: int) -> Prose:
    """Remark that equations are too long to print, with the commands that give them."""
    return prose(
        f"The equations take {operations} operations and are too long to print here: ",
        FULL,
        " prints them with names for their parts, ",
        Code("eomgen codegen MODEL"),
        " gives them as code.",
    )
