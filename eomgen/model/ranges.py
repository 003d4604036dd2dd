"""Text -> Range: values of a parameter or start, "k=100:1000:10" (both ends, how many), "log:k=1:9:5", "k=0.5,1"."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from functools import cached_property
from typing import Any

import numpy as np

from eomgen.errors import ExpressionError, UsageError
from eomgen.model.arithmetic import value_of
from eomgen.model.findings import nearest
from eomgen.model.parts import Model
from eomgen.model.replaced import Taken, taken_of
from eomgen.model.typed import Typing
from eomgen.model.values import exact_parameters
from eomgen.records import dataclass
from eomgen.symbolic.expression.typed import Typed
from eomgen.symbolic.expression.units import Unit

LIKE = '"k=100:1000:10", "log:k=1:100:50" or "k=0.5,1,2"'
MOST = 10_000  # values
SHOWN = 6  # of a list, when it is said what was taken


@dataclass(frozen=True)
class Range:
    """Values that a parameter or start takes one after the other.

    Args:
        values: in SI.
        unit: that the file declares, "" for SI; `size` of it in SI.
        taken: what was made of the text.
    """

    name: str
    values: tuple[float, ...]
    unit: str
    size: float
    taken: Taken


@dataclass(frozen=True)
class TypedNumbers:
    """Numbers as a person types them for one name: "45", "45 deg", "pi/4 rad".

    Args:
        declared: whether plain numbers are in the unit that the file declares; else they are in SI.
    """

    model: Model
    name: str
    declared: bool = True

    @cached_property
    def unit(self) -> Unit | None:
        """The unit that the file declares; of a rate per second."""
        base = self.name.rstrip("'")
        part = self.model.parameters.get(base) or self.model.coordinates.get(base)
        unit = None if part is None else part.unit
        for _ in range(len(self.name) - len(base)):
            unit = None if unit is None else unit.rate
        return unit

    @property
    def size(self) -> float:
        """Of a plain number, in SI."""
        return 1.0 if self.unit is None or not self.declared else self.unit.size

    def taken(self, typed: str, texts: Sequence[str], told: Callable[[list[str]], str]) -> Taken:
        """What is said of numbers that belong together.

        Args:
            typed: all that was typed.
            texts: each number of it.
            told: (the numbers as they were taken, each with its unit) -> how they are said.
        """
        found = [taken_of(self.model, Typing(self.model, self.declared).value(self.name, text)) for text in texts]
        values = tuple(each.value for each in found if isinstance(each.value, float))
        words = [str(each).partition(" = ")[2] for each in found]
        return Taken(self.name, typed, values, found[0].unit, told(words))

    def number(self, text: Typed) -> float:
        """In SI.

        Raises:
            ValueError: it is no number.
            ExpressionError: a unit does not fit.
        """
        try:
            return float(text) * self.size
        except (ValueError, TypeError):
            typed = text.strip() if isinstance(text, str) else text
            value = Typing(self.model, self.declared).value(self.name, typed).value
        found = value_of(value, {**exact_parameters(self.model), "pi": math.pi})
        if found is None:
            raise ValueError(text)
        return float(found)


def typed_values(given: Any) -> list[Typed]:
    """The values of what is given in Python: one, several, an array with a unit beside it, an array of pint's."""
    if isinstance(given, tuple) and len(given) == 2 and isinstance(given[1], str) and not isinstance(given[0], str):
        return [(x, given[1]) for x in np.atleast_1d(given[0]).tolist()]
    if hasattr(given, "to_base_units"):
        return [x * given.units for x in np.atleast_1d(given.magnitude).tolist()]
    return [*given] if isinstance(given, (list, tuple)) else np.atleast_1d(given).tolist()


def are_several(given: Any) -> bool:
    """Whether what is given in Python are values one by one, an array with a unit among them; not one value."""
    if isinstance(given, tuple) and len(given) == 2 and isinstance(given[1], str):
        given = given[0]
    return isinstance(given, list) or np.ndim(getattr(given, "magnitude", given)) == 1


def refuse_what_is_not_set(model: Model, name: str, *, starts: bool) -> None:
    """Refuses a name of what takes no values.

    Args:
        starts: coordinates, rates and speeds may, too.
    Raises:
        UsageError: it is named.
    """
    moving = [*model.coordinates, *(f"{q}'" for q in model.coordinates), *model.speeds] if starts else []
    known = [*model.parameters, *moving]
    if name not in known:
        what = f"no parameter '{name}'" if not starts else f"no parameter, coordinate, rate or speed '{name}'"
        raise UsageError(what, mend=nearest(name, known) or LIKE)


def range_of(model: Model, text: str, *, starts: bool = False, declared: bool = True) -> Range:
    """The values that a text means.

    Args:
        starts: starts of coordinates, rates and speeds may take values too.
        declared: plain numbers are in the unit that the file declares; else in SI.
    Raises:
        UsageError: no parameter of that name, or no values.
    """
    logarithmic = text.startswith("log:")
    name, equals, rest = text.removeprefix("log:").partition("=")
    name = name.strip()
    if not equals:
        raise UsageError(f"'{text}' is no range", mend=LIKE)
    refuse_what_is_not_set(model, name, starts=starts)
    typed = TypedNumbers(model, name, declared)
    try:
        values = _values(rest, logarithmic, text, typed.number)
    except ExpressionError as error:
        raise UsageError(f"'{text}' is no range: {error.what}", mend=error.mend or LIKE) from error
    unit, size = ("", 1.0) if typed.unit is None else (typed.unit.text, typed.unit.size)
    return Range(name, tuple(values), unit, size, _taken(typed, rest, logarithmic))


def _taken(typed: TypedNumbers, rest: str, logarithmic: bool) -> Taken:
    ends = rest.split(":")
    if len(ends) == 1:
        texts = rest.split(",")
        few = texts if len(texts) <= SHOWN else [*texts[: SHOWN - 1], texts[-1]]
        more = "" if few is texts else f", {len(texts)} values"
        return typed.taken(rest, [x.strip() for x in few], lambda x: ", ".join(x) + more)
    spread = "each by one factor" if logarithmic else "equally apart"
    told = f", {int(ends[2])} values {spread}"
    return typed.taken(rest, [x.strip() for x in ends[:2]], lambda x: " to ".join(x) + told)


def _values(rest: str, logarithmic: bool, text: str, number: Callable[[str], float]) -> list[float]:
    """The numbers in SI.

    Raises:
        UsageError: they are none.
    """
    try:
        if ":" not in rest:
            return _finite([number(x) for x in rest.split(",")], text)
        start, stop, count = rest.split(":")
        low, high, n = number(start), number(stop), int(count)
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
