"""Text that a person types -> an expression and the unit beside it: `45 deg`, `300 rpm`, `pi/4 rad`, `2*l`."""

from __future__ import annotations

import re

from eomgen.errors import ExpressionError
from eomgen.symbolic.expression.expressions import parse, parse_equation
from eomgen.symbolic.expression.formula import Expression
from eomgen.symbolic.expression.units import UNITS, Unit, parse_unit

_BEFORE_UNIT = re.compile(r"(?<=[\d.)])\s*(?=[^\W\d]|°)|\s+(?=[^\W\d]|°|1/)")


def parse_typed(text: str, *, references: bool = False, start: int = 0) -> tuple[Expression, Unit | None]:
    """(the expression, the unit that stands beside it, or None).

    Args:
        references: functions of the outputs are allowed, as calls.
        start: the column at which the text begins; columns count from there.
    Raises:
        ExpressionError: it is neither; the unit is none; names stand beside a unit.
    """
    try:
        return _padded(text, references, start), None
    except ExpressionError as error:
        failure = error
    for gap in _BEFORE_UNIT.finditer(text):
        try:
            expression = _padded(text[: gap.start()], references, start)
        except ExpressionError:
            continue
        try:
            unit = parse_unit(text[gap.end() :])
        except ExpressionError as error:
            if expression.names <= {"pi"} and text[gap.end() :].strip().isalpha():
                raise ExpressionError(error.what, start + gap.end(), error.mend, error.length) from None
            continue
        if not expression.names <= {"pi"} or expression.calls:
            what = f"names are in SI, and '{expression.text}' has the unit '{unit.text}' beside it"
            raise ExpressionError(what, start + gap.end(), f"write {expression.text}", len(unit.text))
        return expression, unit
    raise failure


def parse_typed_equation(text: str) -> tuple[tuple[Expression, Unit | None], tuple[Expression, Unit | None]]:
    """Both sides of `left = right`, each with the unit beside it.

    Raises:
        ExpressionError: it is no equation; column and length say where.
    """
    left, sign, right = text.partition("=")
    if not sign or not right.strip():
        parse_equation(text)
    return parse_typed(left, references=True), parse_typed(right, references=True, start=len(left) + 1)


def unit_for_name(name: str, expression: Expression) -> str:
    """How `5*m`, or `45*deg`, is written where the name was meant as a unit; "" where it is none."""
    factor = expression.text.replace(" ", "").removesuffix(f"*{name}")
    return f"write {factor} {name}" if name in UNITS and factor != expression.text.replace(" ", "") else ""


def _padded(text: str, references: bool, start: int) -> Expression:
    return parse(" " * start + text, references=references)
