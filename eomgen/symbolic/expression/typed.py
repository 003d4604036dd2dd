"""What a person types -> an expression and the unit beside it: `45 deg`, `300 rpm`, `pi/4 rad`, `2*l`; a time."""

from __future__ import annotations

import math
import re
from typing import Any

from eomgen.errors import ExpressionError, UsageError
from eomgen.symbolic.expression.expressions import as_expression, parse, parse_equation
from eomgen.symbolic.expression.formula import Expression
from eomgen.symbolic.expression.units import UNITS, Unit, parse_unit

_BEFORE_UNIT = re.compile(r"(?<=[\d.)])\s*(?=[^\W\d]|°)|\s+(?=[^\W\d]|°|1/)")


Typed = Any
"""A number, a text, (number, unit), a quantity of pint."""
EXACT_INTEGER = 53  # bits of a whole number that a double holds
_OF_PINT = {"[length]": "m", "[mass]": "kg", "[time]": "s"}


def seconds(typed: Any) -> float:
    """A time [s]: a number, "500 ms", (500, "ms"), a quantity of pint; a plain number is in seconds.

    Raises:
        UsageError: it is none.
    """
    if (type(typed) is float and math.isfinite(typed)) or (type(typed) is int and typed.bit_length() < EXACT_INTEGER):
        return float(typed)
    refused = UsageError(f"{typed!r} is no time", mend="write 5, or '5 s'")
    try:
        value, unit = read_typed(typed)
        if not is_plain(value) or not (unit is None or unit.fits(parse_unit("s"))):
            raise refused
        found = float((value if unit is None else unit.expression_in_si(value)).evaluate({"pi": math.pi}))
    except (ExpressionError, TypeError, ValueError, ArithmeticError):
        raise refused from None
    if not math.isfinite(found):
        raise refused
    return found


def read_typed(typed: Any) -> tuple[Expression, Unit | None]:
    """(the expression, its own unit or None) of a number, a text, (number, unit), a quantity of pint.

    Raises:
        ExpressionError: it is none of them.
    """
    if isinstance(typed, str):
        return parse_typed(typed)
    if isinstance(typed, tuple) and len(typed) == 2 and isinstance(typed[1], str):
        return as_expression(_plain(typed[0])), parse_unit(typed[1])
    if hasattr(typed, "to_base_units") and hasattr(typed, "dimensionality"):
        base = typed.to_base_units()
        if not base.dimensionality.keys() <= _OF_PINT.keys():
            raise ExpressionError(f"'{typed}' is in units that mechanics does not have", mend="use m, kg, s, rad")
        powers = (f"{_OF_PINT[kind]}^{int(power)}" for kind, power in base.dimensionality.items())
        return as_expression(_plain(base.magnitude)), parse_unit("*".join(powers) or "1")
    return as_expression(_plain(typed)), None


def is_plain(value: Expression) -> bool:
    """Whether it is a number: no names but pi, nothing that an output would ask."""
    return value.names <= {"pi"} and not value.calls


def _plain(value: Any) -> Any:
    """A number of an array as Python's own."""
    return value.item() if hasattr(value, "item") else value


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
    if not isinstance(text, str):
        raise ExpressionError(f"{text!r} is no equation", mend='write it as a text: "theta = pi/2"')
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
