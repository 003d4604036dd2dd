"""Formulas -> lines of an aligned block, each about LINE characters wide, broken before + and -."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import groupby

from eomgen.documents.latex_math import FUNCTIONS, Set, Setter, bracketed, is_sum
from eomgen.symbolic.expression.graph import Node, Scalar
from eomgen.symbolic.print.layout import Product

LINE = 87.0  # characters
NARROW = 24.0  # a left side that stands before the alignment


def aligned(rows: list[str]) -> str:
    """Rows as one aligned block."""
    return "\\begin{aligned}\n" + " \\\\\n".join(rows) + "\n\\end{aligned}"


def runs_of(setter: Setter, formulas: Sequence[Sequence[Set | Scalar]], longest: int) -> list[list[str]]:
    """The rows of the formulas, in runs of about `longest` rows; the equality signs of a run stand below one another.

    A formula whose left side is too wide for that begins another run.

    Args:
        formulas: the sides of each, what is set already, or scalars.
    """
    runs: list[list[str]] = []
    leads: list[float] = []
    for lead, sides in _with_leads(setter, formulas):
        rows = rows_of(setter, sides, lead)
        if not runs or leads[-1] != lead or len(runs[-1]) + len(rows) > longest:
            runs.append([])
            leads.append(lead)
        runs[-1] += rows
    return runs


def _with_leads(
    setter: Setter, formulas: Sequence[Sequence[Set | Scalar]]
) -> list[tuple[float, Sequence[Set | Scalar]]]:
    """(room on the left, sides): neighbours share the room; 0 where the left side is too wide."""
    own = [lead_of(setter, sides) for sides in formulas]
    found = []
    for is_narrow, group in groupby(range(len(own)), key=lambda i: own[i] > 0):
        indices = list(group)
        widest = max(own[i] for i in indices) if is_narrow else 0.0
        found += [(widest, formulas[i]) for i in indices]
    return found


def lead_of(setter: Setter, sides: Sequence[Set | Scalar]) -> float:
    """The width of the left side; 0 where it is too wide to stand before the equality sign of a run."""
    width = _set(setter, sides[0]).width
    return width if width <= NARROW and len(sides) > 1 else 0.0


def rows_of(setter: Setter, sides: Sequence[Set | Scalar], lead: float | None = None) -> list[str]:
    """The rows of one formula: its sides joined by equality signs.

    Args:
        sides: what is set already, or scalars.
        lead: the room for the left side, 0 for none before the alignment; by its own width where none is given.
    """
    lead = lead_of(setter, sides) if lead is None else lead
    if lead:
        return _rows_after(setter, sides, LINE - lead)
    parts = pieces(setter, sides[0], LINE)
    for side in sides[1:]:
        head, *rest = pieces(setter, side, LINE)
        parts += [Set(f"= {head.tex}", head.width + 3), *rest]
    filled = _filled(parts, LINE)
    return [f"& {filled[0]}", *(rf"&\quad {part}" for part in filled[1:])]


def _rows_after(setter: Setter, sides: Sequence[Set | Scalar], room: float) -> list[str]:
    """left &= right, the right in as many rows as it needs."""
    rows, line, width = [], f"{_set(setter, sides[0]).tex} &=", 0.0
    for number, side in enumerate(sides[1:]):
        whole = _set(setter, side)
        if number and width + whole.width <= room:
            line, width = f"{line} = {whole.tex}", width + whole.width + 3
            continue
        if number:
            rows.append(line)
            line = "&="
        filled = _filled(pieces(setter, side, room), room)
        line = f"{line} {filled[0]}"
        for part in filled[1:]:
            rows.append(line)
            line = rf"&\quad {part}"
        width = whole.width
    return [*rows, line]


def _set(setter: Setter, side: Set | Scalar) -> Set:
    return side if isinstance(side, Set) else setter.set(side)


def pieces(setter: Setter, side: Set | Scalar, room: float) -> list[Set]:
    """What may not be broken further, each piece but the first with its sign in front."""
    whole = _set(setter, side)
    if isinstance(side, Set) or type(side) is not Node or whole.width <= room:
        return [whole]
    found: list[Set] = []
    for number, product in enumerate(setter.summands(side)):
        term = setter.term(product, first=number == 0)
        found += [term] if term.width <= room else _opened(setter, product, term, room)
    return found


def _opened(setter: Setter, product: Product, term: Set, room: float) -> list[Set]:
    """A term that is too long for a line, broken inside the parentheses of its longest sum."""
    if product.denominator:
        return _quotient(setter, product, term.tex[:2] if term.tex.startswith(("+", "-")) else "", room)
    bases = [base for base, _ in product.numerator]
    bases += [a for base in bases if base.op in FUNCTIONS for a in base.args if type(a) is Node]
    sums = [base for base in bases if is_sum(base)]
    if not sums:
        return [term]
    longest = max(sums, key=lambda base: setter.set(base).width)
    bracket = bracketed(setter.set(longest)).tex
    if term.tex.count(bracket) != 1:
        return [term]
    before, after = term.tex.split(bracket)
    parts = pieces(setter, longest, room / 2)
    parts[0] = Set(rf"{before}\bigl({parts[0].tex}", term.width - setter.set(longest).width + parts[0].width)
    parts[-1] = Set(rf"{parts[-1].tex}\bigr){after}", parts[-1].width + 2)
    return parts


def _quotient(setter: Setter, product: Product, sign: str, room: float) -> list[Set]:
    """A quotient that is too long for a fraction, in which no line can end: (above) / (below)."""
    c = max(product.coefficient, -product.coefficient)
    above = _factor_pieces(setter, Product(c.numerator, product.numerator, ()), room)
    below = _factor_pieces(setter, Product(c.denominator, product.denominator, ()), room)
    above[0] = Set(f"{sign}{above[0].tex}", above[0].width + len(sign))
    joined = Set(rf"{above[-1].tex} \big/ {below[0].tex}", above[-1].width + below[0].width + 2)
    return [*above[:-1], joined, *below[1:]]


def _factor_pieces(setter: Setter, product: Product, room: float) -> list[Set]:
    """A side of a quotient, in parentheses where it is more than one symbol."""
    lone = product.coefficient == 1 and len(product.numerator) == 1
    if lone and product.numerator[0][1] == 1 and is_sum(product.numerator[0][0]):
        parts = pieces(setter, product.numerator[0][0], room / 2)
    else:
        term = setter.product(product)
        parts = [term] if term.width <= room else _opened(setter, product, term, room)
        if lone or not product.numerator:
            return parts
    parts[0] = Set(rf"\bigl({parts[0].tex}", parts[0].width + 1)
    parts[-1] = Set(rf"{parts[-1].tex}\bigr)", parts[-1].width + 1)
    return parts


def _filled(parts: list[Set], room: float) -> list[str]:
    """The pieces in lines."""
    lines: list[str] = []
    width = 0.0
    for part in parts:
        if lines and width + part.width <= room:
            lines[-1] += f" {part.tex}"
            width += part.width
        else:
            lines.append(part.tex)
            width = part.width + (2 if lines else 0)
    return lines
