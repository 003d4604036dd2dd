"""Formulas -> lines of an aligned block, each about LINE characters wide, broken before + and -."""

from __future__ import annotations

from collections.abc import Callable

from eomgen.report.latex_math import Set, Setter, is_sum
from eomgen.symbolic.graph import Node, Scalar
from eomgen.symbolic.layout import Product

LINE = 82.0  # characters
NARROW = 24.0  # a left side that stands before the alignment


def aligned(rows: list[str]) -> str:
    """Rows as one aligned block."""
    return "\\begin{aligned}\n" + " \\\\\n".join(rows) + "\n\\end{aligned}"


def rows_of(setter: Setter, sides: list[Set | Scalar]) -> list[str]:
    """The rows of one formula: its sides joined by equality signs.

    Args:
        sides: what is set already, or scalars.
    """
    first = _set(setter, sides[0])
    if first.width <= NARROW and len(sides) > 1:
        rows, begin, room = [], f"{first.tex} &", LINE - first.width
        line, width = begin + "=", 0.0
        for number, side in enumerate(sides[1:]):
            whole = _set(setter, side)
            if number and width + whole.width <= room:
                line, width = f"{line} = {whole.tex}", width + whole.width + 3
                continue
            if number:
                rows.append(line)
                line = "&="
            parts = pieces(setter, side, room)
            filled = _filled(parts, room)
            line = f"{line} {filled[0]}"
            for part in filled[1:]:
                rows.append(line)
                line = rf"&\quad {part}"
            width = whole.width
        return [*rows, line]
    parts = pieces(setter, sides[0], LINE)
    for side in sides[1:]:
        head, *rest = pieces(setter, side, LINE)
        parts += [Set(f"= {head.tex}", head.width + 3), *rest]
    filled = _filled(parts, LINE)
    return [f"& {filled[0]}", *(rf"&\quad {part}" for part in filled[1:])]


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
    sums = [base for base, exponent in (*product.numerator, *product.denominator) if is_sum(base)]
    if not sums:
        return [term]
    longest = max(sums, key=lambda base: setter.set(base).width)
    inside = setter.set(longest)
    for begin, end, build in _places(setter, product, longest, inside, term):
        parts = pieces(setter, longest, room - 4)
        parts[0] = Set(build(begin, parts[0].tex), parts[0].width + 4)
        parts[-1] = Set(parts[-1].tex + end, parts[-1].width + 4)
        return parts
    return [term]


Builder = Callable[[str, str], str]


def _places(setter: Setter, product: Product, longest: Node, inside: Set, term: Set) -> list[tuple[str, str, Builder]]:
    """Where the sum stands in the term: what is before it, and what is after it; nothing inside a fraction."""
    bracket = rf"\left({inside.tex}\right)"
    if product.denominator or term.tex.count(bracket) != 1:
        return []
    before, after = term.tex.split(bracket)
    return [(before, rf"\bigr){after}", lambda begin, tex: rf"{begin}\bigl({tex}")]


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
