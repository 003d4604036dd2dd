"""Document -> a complete LaTeX document that compiles as it stands, and its equations alone for notebooks."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterator, Sequence
from dataclasses import replace
from itertools import zip_longest

from eomgen.documents.document import Document
from eomgen.documents.languages import Catalogue
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
    Quantity,
    Rate,
    Side,
    Statement,
    Table,
    key_of,
    parts_of,
    prose,
)
from eomgen.symbolic.expression import AS_WRITTEN, Graph, Node, Scalar, order, parse
from eomgen.symbolic.print import PAPER, Notation, Set, SetLine, Setter, latex_escaped

name = "latex"

PREAMBLE = r"""\documentclass[fleqn]{article}
\usepackage[T1]{fontenc}
\usepackage[utf8]{inputenc}
\usepackage{amsmath}
\usepackage{longtable}
\usepackage[margin=25mm]{geometry}
\setlength{\parindent}{0pt}
\setlength{\parskip}{2pt}
\setlength{\mathindent}{1em}
\setlength{\jot}{4pt}
\setlength{\LTleft}{0pt}
\setlength{\LTright}{\fill}
\renewcommand{\arraystretch}{1.25}
"""
WORDS = 60  # characters in a line of a column of words, and its width in mm
MEANING = "p{85mm}"  # a column of meanings
NARROW = 45  # the same in a table of many columns
LINE = 95  # characters of words in all columns of a table, in which a formula counts as SIDE
SIDE = 8
SHORT = 24  # rows of a table that stays on one page
_STATEMENTS = str.maketrans("⁻⁰¹²³⁴⁵⁶⁷⁸⁹", "-0123456789")
ALIGNED, ALIGNED_END = "\\[\\begin{aligned}\n", "\n\\end{aligned}\\]"
_DECIMAL = re.compile(r"(?<![\w.])(\d+)\.(\d+)(?![\w.])")
LINE_END = r" \\"
BLOCK = 12  # rows of one display; a page ends between displays
LETTERS = {
    "vx": "v_{x",
    "vy": "v_{y",
    "vz": "v_{z",
    "Fx": "F_{x",
    "Fy": "F_{y",
    "Fz": "F_{z",
    "speed": "v_{",
    "angle": r"\varphi_{",
    "omega": r"\omega_{",
    "omega_1": r"\omega_{1",
    "omega_2": r"\omega_{2",
    "omega_3": r"\omega_{3",
    "gap": r"\Phi_{",
    "couple": r"\tau_{",
    "Fin_x": r"F^{\mathrm{in}}_{x",
    "Fin_y": r"F^{\mathrm{in}}_{y",
    "Fin_z": r"F^{\mathrm{in}}_{z",
    "Min": r"M^{\mathrm{in}}_{",
    "Min_x": r"M^{\mathrm{in}}_{x",
    "Min_y": r"M^{\mathrm{in}}_{y",
    "Min_z": r"M^{\mathrm{in}}_{z",
    "Delta": r"\Delta_{",
}
"""letter -> how it begins, its subscript opened"""


class DocumentSetter(Setter):
    """Sets the formulas of a document, and knows the language of its words.

    Args:
        notation: typesetting of names.
        language: that of what stands beside the formulas.
    """

    def __init__(self, notation: Notation, language: Catalogue) -> None:
        super().__init__(notation)
        self.language = language


def setter_of(document: Document) -> DocumentSetter:
    """One notation for the symbols of the whole document."""
    return DocumentSetter(document.notation.reported_apart(names_in(document)), document.language)


def names_in(document: Document) -> tuple[str, ...]:
    """The names of the symbols that stand in its formulas, each once."""
    statements = (statement for step in document.steps for statement in step.statements)
    return tuple(dict.fromkeys(symbol.name for statement in statements for symbol in symbols_in(statement)))


def symbols_in(statement: Statement) -> list[Node]:
    """The symbols that stand in the formulas of a statement."""
    found: list[Node] = []
    for part in parts_of(statement):
        found += _symbols(part)
    return [node for node in order(found) if node.op == "symbol"]


def _symbols(part: object) -> list[Node]:
    if isinstance(part, Node):
        return [part]
    if isinstance(part, Name):
        return [] if part.by is None else [part.by]
    if isinstance(part, Entry):
        return [part.row, part.column]
    if isinstance(part, Partial):
        return [*_symbols(part.of), part.by]
    if isinstance(part, Matrix):
        return [x for row in part.rows for entry in row for x in _symbols(entry)]
    return _symbols(part.of) if isinstance(part, Rate) else []


def render(document: Document) -> str:
    """The document as a file of LaTeX; its proof is a comment, contradictions are visible."""
    document = with_listings_typeset(document)
    setter = setter_of(document)
    if document.fragment:
        return _fragment(document, setter)
    proof = () if document.certificate is None else str(document.certificate).splitlines()
    lines = [*(f"% {line}" for line in proof), PREAMBLE + r"\begin{document}"]
    lines += [rf"\textbf{{{document.distrust}}}"] if document.distrust else []
    lines.append(rf"\section*{{{latex_escaped(document.title)}}}")
    if document.about:
        lines.append(latex_escaped(document.about) + "\n")
    if document.source:
        lines.append(f"{latex_escaped(document.source_words)}\n")
    for step in document.steps:
        lines += [rf"\subsection*{{{latex_escaped(step.title)}}}"] if step.title else []
        lines += latex_blocks(setter, step.statements)
    return "\n".join([*lines, r"\end{document}"]) + "\n"


def _fragment(document: Document, setter: Setter) -> str:
    """The sections as they are pasted into another document, which needs amsmath alone."""
    proof = () if document.certificate is None else (f"% {line}" for line in document.proof.splitlines())
    lines = [*proof]
    several = sum(bool(step.title) for step in document.steps) > 1
    for step in document.steps:
        lines += [rf"\subsection*{{{latex_escaped(step.title)}}}"] if step.title and several else []
        for block in latex_blocks(setter, step.statements, long_tables=False):
            lines.append(_numbered(block) if document.fragment == "numbered" else block)
    return "\n".join(lines).rstrip() + "\n"


def _numbered(block: str) -> str:
    """A display with a number for each formula, at its last row; other blocks as they are."""
    if not (block.startswith(ALIGNED) and block.endswith(ALIGNED_END)):
        return block
    rows = block.removeprefix(ALIGNED).removesuffix(ALIGNED_END).split("\n")
    for k, later in enumerate(rows[1:]):
        if later.startswith(("&\\quad", "&=")):  # it goes on with the row before, whose end has no number then
            rows[k] = rf"{rows[k].removesuffix(LINE_END)} \notag{LINE_END}"
    return "\n".join([r"\begin{align}", *rows, r"\end{align}"])


def latex_blocks(setter: Setter, statements: Sequence[Statement], *, long_tables: bool = True) -> list[str]:
    """Paragraphs, displays and tables; formulas that follow one another are aligned together.

    Args:
        long_tables: those of many rows may go over pages, which takes a package.
    """
    blocks: list[str] = []
    groups = grouped(statements)
    for group, after in zip_longest(groups, groups[1:]):
        if isinstance(group, list):
            blocks += [rf"\[{block}\]" for block in display_blocks(setter, group)]
        elif isinstance(group, Prose):  # a display belongs to the paragraph before it
            end = "" if isinstance(after, list) else "\n"
            blocks.append("".join(piece_latex(setter, piece, latex_escaped) for piece in group.pieces) + end)
        elif isinstance(group, Lines):
            blocks.append("\n".join([r"\begin{verbatim}", *group.lines, r"\end{verbatim}"]))
        else:
            blocks.append(_grid(setter, group, long_tables))
    return blocks


Group = Prose | Table | Grid | Lines | list[Formula]


def grouped(statements: Sequence[Statement]) -> list[Group]:
    """The statements, formulas in a row taken together; listings are typeset before."""
    groups: list[Group] = []
    for statement in statements:
        assert not isinstance(statement, Listing)
        if not isinstance(statement, Formula):
            groups.append(statement)
        elif groups and isinstance(groups[-1], list):
            groups[-1].append(statement)
        else:
            groups.append([statement])
    return groups


def display_blocks(setter: Setter, formulas: Sequence[Formula], line: SetLine = PAPER) -> list[str]:
    """The formulas in aligned blocks of a few rows each."""
    return [_with_decimals(setter, block) for block in setter.displays(_sides(setter, formulas), BLOCK, line)]


def _with_decimals(setter: Setter, tex: str) -> str:
    """A formula with the decimal sign of its document; braces keep the comma from being one between two numbers."""
    return _DECIMAL.sub(r"\1{,}\2", tex) if setter.notation.comma else tex


def _sides(setter: Setter, formulas: Sequence[Formula]) -> list[list[Set | Scalar]]:
    return [[_side(setter, side) for side in formula.sides] for formula in formulas]


def with_listings_typeset(document: Document) -> Document:
    """The document with sentences and formulas in place of listings."""
    graph = Graph()
    steps = (
        replace(step, statements=tuple(x for s in step.statements for x in _typeset(graph, s)))
        for step in document.steps
    )
    return replace(document, steps=tuple(steps))


def _typeset(graph: Graph, statement: Statement) -> Iterator[Statement]:
    """name: words [method], then exact = number, below one another."""
    if not isinstance(statement, Listing):
        yield statement
        return
    for row in statement.rows:
        found = row.quantity
        way, message = (f" [{found.method}]" if found.method else ""), (f" ({found.message})" if found.message else "")
        yield prose(Code(row.name), f": {row.words}" if row.words else "", way, message)
        sides = quantity_sides(graph, found)
        yield from [Formula((*row.letters, *sides))] if sides else []


def quantity_sides(graph: Graph, found: Quantity) -> tuple[Side, ...]:
    """The formula and the number of a quantity, as far as they are known."""
    exact = () if found.exact is None else (_read_back(graph, found.exact),)
    return (*exact, Law(found.number, number_latex(found.number))) if found.number else exact


def _read_back(graph: Graph, exact: str) -> Side:
    """Formula that a text of the grammar states."""
    expression = parse(exact, longest=len(exact), tables=AS_WRITTEN)
    symbols = {name: graph.symbol(name) for kind, name in expression.code if kind == "name"}  # as they stand in it
    read: Scalar = expression.evaluate(symbols | {"pi": graph.pi})
    return read


def number_latex(number: str) -> str:
    """A number and its unit, inside a formula: 2 kg, 45°."""
    value, _, unit = number.partition(" ")
    return value_latex(value).strip("$") + (rf"\ \text{{{unit_latex(unit)}}}" if unit else "")


def equations_latex(derivation: Document) -> str:
    """The equations of motion in one display, for Jupyter: $$ aligned $$."""
    setter = setter_of(derivation)
    formulas = [Formula(pair) for pair in derivation.definitions]
    formulas += [Formula((equation.left, equation.right)) for equation in derivation.equations]
    if not formulas:
        return r"$$\text{The equations are too long to print.}$$"
    return f"$${setter.display(_sides(setter, formulas))}$$"


def piece_latex(setter: Setter, piece: Piece, escape: Callable[[str], str]) -> str:
    """One piece of a sentence, formulas between dollars."""
    if isinstance(piece, str):
        return escape(piece)
    if isinstance(piece, Code):
        text = escape(piece.text).replace("--", "-{}-")  # T1 makes a dash of two hyphens
        return rf"\texttt{{{text}}}"
    return f"${side_latex(setter, piece)}$"


def side_latex(setter: Setter, side: Side) -> str:
    """One side of a formula."""
    return _with_decimals(setter, _whole(setter, side).tex)


def _side(setter: Setter, side: Side) -> Set | Scalar:
    """A scalar as it is; a quantity as set."""
    if isinstance(side, (Name, Entry, Partial, Rate)):
        return Set(_quantity(setter, side))
    if isinstance(side, Matrix):
        return _matrix(setter, side)
    if isinstance(side, Omitted):
        return Set(rf"\text{{({side.operations} operations, not printed)}}")
    return Set(side.latex) if isinstance(side, Law) else side


def _matrix(setter: Setter, matrix: Matrix) -> Set:
    """Matrix in parentheses."""
    rows = [[_whole(setter, entry) for entry in row] for row in matrix.rows]
    lines = r" \\ ".join(" & ".join(entry.tex for entry in row) for row in rows)
    return Set(rf"\begin{{pmatrix}} {lines} \end{{pmatrix}}")


def _whole(setter: Setter, side: Side) -> Set:
    found = _side(setter, side)
    return found if isinstance(found, Set) else setter.set(found)


def _quantity(setter: Setter, side: Name | Entry | Partial | Rate) -> str:
    if isinstance(side, Name):
        return _name(setter, side)
    if isinstance(side, Entry):
        return f"{side.letter}_{{{_symbol(setter, side.row)},{_symbol(setter, side.column)}}}"
    if isinstance(side, Partial):
        sign = "-" if side.sign < 0 else ""
        return rf"{sign}\frac{{\partial {_name(setter, side.of)}}}{{\partial {_symbol(setter, side.by)}}}"
    if isinstance(side.of, Node):
        return setter.notation.latex(f"{side.of.name}'")
    return rf"\frac{{d}}{{dt}} {_quantity(setter, side.of)}"


def _name(setter: Setter, quantity: Name) -> str:
    """x_{arm}, v_{x,arm}, Q_{theta}: a mass centre goes by the name of its body."""
    begin = LETTERS.get(quantity.letter, quantity.letter + "_{")
    inside = [] if quantity.by is None else [_symbol(setter, quantity.by)]
    inside += [setter.notation.index(quantity.of.removesuffix(".center"))] if quantity.of else []
    opened = not begin.endswith("{")
    tex = begin + ("," if opened and inside else "") + ",".join(inside) + "}"
    tex = tex.replace("_{}", "")
    return tex if quantity.power == 1 else f"{tex}^{{{quantity.power}}}"


def _symbol(setter: Setter, symbol: Node) -> str:
    return setter.set(symbol).tex


def unit_latex(unit: str) -> str:
    """kg*m^2 with its exponents raised and dots between its names."""
    pieces = re.split(r"\^\(?(-?\d+)\)?|([⁻⁰¹²³⁴-⁹]+)", unit)
    set_: list[str] = []
    for k, piece in enumerate(pieces):
        if piece and k % 3:
            set_.append(f"$^{{{piece.translate(_STATEMENTS)}}}$")
        elif piece:
            set_.append(latex_escaped(piece.replace("*", "·")))
    return "".join(set_)


def value_latex(value: str) -> str:
    """A value: -0.5 and 2.2e-06 as numbers, anything else as it is."""
    number = re.fullmatch(r"(-?\d+(?:[.,]\d+)?)(?:e([-+]\d+))?", value)
    if number is None:
        return latex_escaped(value)
    scale = rf" \cdot 10^{{{int(number[2])}}}" if number[2] else ""
    digits = number[1].replace(",", "{,}")
    return f"${digits}{scale}$"


def _ruled(alignment: str, head: str, rows: list[str], long: bool) -> str:
    """A table with a line under its head; a long one may go over pages, and then needs a second run of LaTeX."""
    top = head + r" \\ \hline \noalign{\vskip 3pt}"
    columns, lines = f"{{@{{}}{alignment}@{{}}}}", [rf"{row} \\" for row in rows]
    if long and len(rows) > SHORT:
        lines = [rf"\begin{{longtable}}{columns}", rf"{top} \endhead", *lines, r"\end{longtable}"]
    else:
        lines = [r"\medskip", rf"\begin{{tabular}}{columns}", top, *lines, r"\end{tabular}\medskip", ""]
    return "\n".join(lines)


def _grid(setter: Setter, table: Grid | Table, long: bool = True) -> str:
    """A table of words and formulas; columns of long words are wrapped, units and numbers set as such."""
    grid = table if isinstance(table, Grid) else table.grid
    longest = [
        max(len(cell) if isinstance(cell, str) else SIDE for cell in column)
        for column in zip(grid.head, *grid.rows, strict=True)
    ]
    room = WORDS if sum(longest) <= LINE else NARROW
    wide = [f"p{{{room}mm}}" if length > room else "l" for length in longest]
    alignment = wide if table is grid else [MEANING if key_of(head) == "meaning" else "l" for head in grid.head]
    units = [key_of(head) == "unit" for head in grid.head]
    head = _cells(setter, grid.head, [True] * len(grid.head))
    return _ruled("".join(alignment), head, [_cells(setter, row, units) for row in grid.rows], long)


def _cells(setter: Setter, row: tuple[Cell, ...], units: Sequence[bool]) -> str:
    """The cells of a row; `units`: which of them are units, if they are words."""
    words = [unit_latex if unit else value_latex for unit in units]
    return " & ".join(
        set_(cell) if isinstance(cell, str) else f"${side_latex(setter, cell)}$"
        for set_, cell in zip(words, row, strict=True)
    )
