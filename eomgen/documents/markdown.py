"""Document -> Markdown with formulas between dollars, as notebooks and code forges show it."""

from __future__ import annotations

import re
from collections.abc import Sequence

from eomgen.documents.document import Document, notation_of
from eomgen.documents.latex import (
    display_blocks,
    grouped,
    piece_latex,
    quantity_sides,
    setter_of,
    side_latex,
    with_listings_typeset,
)
from eomgen.documents.statements import (
    Cell,
    Code,
    Found,
    Grid,
    Lines,
    Piece,
    Prose,
    Quantity,
    Statement,
    key_of,
    unit_text,
)
from eomgen.model import Model
from eomgen.symbolic.expression import Graph
from eomgen.symbolic.print import PAPER, Notation, Setter

name = "markdown"

_SPECIAL = re.compile(r"([\\`*_{}\[\]<>#|$~^])")


def render(document: Document) -> str:
    """The document as Markdown: contradictions first, its proof last."""
    document = with_listings_typeset(document)
    setter = setter_of(document)
    blocks = [f"**{document.distrust}**"] if document.distrust else []
    blocks.append(f"# {markdown_escaped(document.title)}")
    blocks += [markdown_escaped(text) for text in (document.about,) if text]
    blocks += [markdown_escaped(document.source_words)] if document.source else []
    for step in document.steps:
        blocks += [f"## {markdown_escaped(step.title)}"] if step.title else []
        blocks += markdown_blocks(setter, step.statements)
    blocks += [f"```\n{document.proof}\n```"] if document.proof else []
    return "\n\n".join(blocks) + "\n"


def markdown_below(text: str) -> str:
    """A document in Markdown inside another one: its headings two levels lower, below those of a notebook."""
    pieces = text.split("```")  # every second one is code
    pieces[::2] = [re.sub(r"^#", "###", piece, flags=re.MULTILINE) for piece in pieces[::2]]
    return "```".join(pieces)


def markdown_blocks(setter: Setter, statements: Sequence[Statement]) -> list[str]:
    """Paragraphs, displays and tables."""
    blocks: list[str] = []
    for group in grouped(statements):
        if isinstance(group, list):
            blocks += [f"$$\n{block}\n$$" for block in display_blocks(setter, group)]
        elif isinstance(group, Prose):
            blocks.append("".join(_piece(setter, piece) for piece in group.pieces))
        elif isinstance(group, Lines):
            blocks.append("\n".join(["```", *group.lines, "```"]))
        else:
            blocks.append(_grid(setter, group if isinstance(group, Grid) else group.grid))
    return blocks


def listing_markdown(rows: Sequence[Found], model: Model | None = None) -> str:
    """Quantities in a table, a row each: name, formula and number typeset; one longer than a line is shortened."""
    setter = Setter(Notation() if model is None else notation_of(model))
    return "\n".join(
        ["| | |", "|---|---|", *(f"| {_row_name(row)} | {_reported(setter, row.quantity)} |" for row in rows)]
    )


def _row_name(row: Found) -> str:
    return f"`{row.name}`" if row.symbol is None else f"${row.symbol.tex}$"


def _reported(setter: Setter, found: Quantity) -> str:
    sides = quantity_sides(Graph(), found)
    shown = [tex for tex in (side_latex(setter, side) for side in sides) if PAPER.width(tex) <= PAPER.room]
    parts = [f"${' = '.join(shown)}$".replace("|", r"\vert ")] if shown else []
    if len(shown) < len(sides):
        parts.append(f"({len(found.exact or '')} characters: `.exact`)")
    return " ".join([*parts, *([markdown_escaped(found.message)] if found.message else [])])


def markdown_escaped(text: str) -> str:
    """Plain text for Markdown: nothing in it is markup, and it stays on its line."""
    return " ".join(_SPECIAL.sub(r"\\\1", text).split())


def _piece(setter: Setter, piece: Piece) -> str:
    if isinstance(piece, Code):
        return f"`{piece.text}`"
    if isinstance(piece, str):  # blanks at the ends join the pieces
        return _SPECIAL.sub(r"\\\1", piece)
    return piece_latex(setter, piece, markdown_escaped)


def _grid(setter: Setter, grid: Grid) -> str:
    """A table of words and formulas; a bar inside a formula would end its cell."""
    plain = [False] * len(grid.head)
    units = [key_of(head) == "unit" for head in grid.head]
    lines = [_cells(setter, grid.head, plain), "|" + "---|" * len(grid.head)]
    return "\n".join([*lines, *(_cells(setter, row, units) for row in grid.rows)])


def _cells(setter: Setter, row: tuple[Cell, ...], units: Sequence[bool]) -> str:
    """The cells of a row; `units`: which of them are units, if they are words."""
    cells = (
        markdown_escaped(unit_text(cell) if unit else cell)
        if isinstance(cell, str)
        else f"${side_latex(setter, cell)}$".replace("|", r"\vert ")
        for cell, unit in zip(row, units, strict=True)
    )
    return "| " + " | ".join(cells) + " |"
