"""Formulas of one step -> as many of them as a reader can take, and an honest word about the rest."""

from __future__ import annotations

from collections.abc import Iterable

from eomgen.report.statements import Code, Formula, Omitted, Prose, Statement
from eomgen.symbolic.graph import Node
from eomgen.symbolic.text import text_size

PAGE = 7000  # characters of formulas in one step


def page(formulas: Iterable[Formula]) -> tuple[Statement, ...]:
    """The formulas up to a page of them; what is left out is counted, and said where to get."""
    kept: list[Statement] = []
    length, left_out = 0, 0
    for formula in formulas:
        size = sum(text_size(side) for side in formula.sides if isinstance(side, Node))
        if any(isinstance(side, Omitted) for side in formula.sides) or length + size > PAGE:
            left_out += 1
        else:
            kept.append(formula)
            length += size
    return (*kept, *_rest(left_out, len(kept))) if left_out else tuple(kept)


def _rest(left_out: int, kept: int) -> tuple[Statement, ...]:
    number = f"{left_out} more" if kept else "All" if left_out > 1 else "It"
    verb = "are" if left_out > 1 else "is"
    return (Prose((f"{number} {verb} too long to print.",)),)


def elsewhere(operations: int) -> Prose:
    """Where to get what is too long to print."""
    return Prose((
        f"The equations take {operations} operations and are too long to print: ", Code("eomgen derive MODEL --json"),
        " gives all of them as text, ", Code("eomgen codegen MODEL"), " as code.",
    ))  # fmt: skip
