"""Text -> Range: values of a parameter, "k=100:1000:10" (both ends, how many), "log:k=1:100:50", "k=0.5,1,2"."""

from __future__ import annotations

import math
from dataclasses import dataclass

from eomgen.errors import UsageError
from eomgen.model.findings import nearest
from eomgen.model.parts import Model

LIKE = '"k=100:1000:10", "log:k=1:100:50" or "k=0.5,1,2"'
MOST = 10_000  # values


@dataclass(frozen=True)
class Range:
    """Values that a parameter takes one after the other.

    Args:
        values: in SI.
        unit: in which they were given, "" for SI; `size` of it in SI.
    """

    name: str
    values: tuple[float, ...]
    unit: str
    size: float


def range_of(model: Model, text: str) -> Range:
    """The values that a text means, in the unit that the file declares.

    Raises:
        UsageError: no parameter of that name, or no values.
    """
    logarithmic = text.startswith("log:")
    name, equals, rest = text.removeprefix("log:").partition("=")
    name = name.strip()
    if not equals:
        raise UsageError(f"'{text}' is no range", mend=LIKE)
    if name not in model.parameters:
        raise UsageError(f"no parameter '{name}'", mend=nearest(name, model.parameters) or LIKE)
    unit = model.parameters[name].unit
    values = _values(rest, logarithmic, text)
    size = 1.0 if unit is None else unit.size
    return Range(name, tuple(x * size for x in values), "" if unit is None else unit.text, size)


def _values(rest: str, logarithmic: bool, text: str) -> list[float]:
    """The numbers as they were given.

    Raises:
        UsageError: they are none.
    """
    try:
        if ":" not in rest:
            return _finite([float(x) for x in rest.split(",")], text)
        start, stop, count = rest.split(":")
        low, high, n = float(start), float(stop), int(count)
    except ValueError as error:
        raise UsageError(f"'{text}' is no range", mend=LIKE) from error
    if not 2 <= n <= MOST or (logarithmic and min(low, high) <= 0):
        what = "a range of powers has ends above 0" if logarithmic and min(low, high) <= 0 else f"{n} values"
        raise UsageError(f"'{text}' is no range: {what}", mend=f"from 2 to {MOST} values, like {LIKE}")
    _finite([low, high], text)
    shares = [k / (n - 1) for k in range(n)]
    if logarithmic:
        return [low * (high / low) ** share for share in shares]
    return [low + (high - low) * share for share in shares]


def _finite(values: list[float], text: str) -> list[float]:
    if all(math.isfinite(x) for x in values):
        return values
    raise UsageError(f"'{text}' is no range: its values are no numbers", mend=LIKE)
