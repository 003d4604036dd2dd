"""Model -> a variant of it: the same problem with data drawn from the ranges that its parameters declare.

A number gives the same variant on every machine. A parameter is drawn by its own name, so that a further range in the
file leaves the others' values as they are.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator
from decimal import ROUND_CEILING, ROUND_FLOOR, Decimal
from itertools import count
from random import Random
from typing import Any

from eomgen.errors import EomgenError, UsageError
from eomgen.model import Model, ModelOrPath, Valued, model_at
from eomgen.questions.outputs_answered import solve
from eomgen.resources import doing
from eomgen.results import missing_values
from eomgen.study import study_of

ATTEMPTS = 50
FEWEST = 10  # round numbers from which a value is drawn, at least


def variant(model: ModelOrPath, number: int) -> Model:
    """The model with the data of this variant.

    Raises:
        UsageError: no parameter has a range; no draw that was tried gives a system with the same answers.
    """
    return variant_of(model_at(model), number).model


def variant_of(model: Model, number: int) -> Valued:
    """The model with the data of this variant, and a record of what was drawn.

    A draw is taken again where the system cannot be put together, or an output of the file has no answer any more.

    Raises:
        UsageError: as `variant`.
    """
    ranged = {name: part for name, part in model.parameters.items() if part.range is not None}
    if not ranged:
        fix = 'give one: m = { value = 2, unit = "kg", range = [1, 5] }'
        raise UsageError("no parameter of the model has a range from which a variant is drawn", fix=fix)
    with doing("the draw of a variant"):
        due = frozenset(_answered(model))
        for attempt in range(ATTEMPTS):
            drawn = {
                name: _drawn(part.range or (), Random(f"{number}/{attempt}/{name}")) for name, part in ranged.items()
            }
            try:
                valued = Valued.of(model, drawn, declared=True, options=("the variant", "start"))
                if due <= frozenset(_answered(valued.model)):
                    named = valued.model.altered(name=f"{model.name}, variant {number}")
                    return Valued(named, valued.taken, valued.start)
            except (EomgenError, ArithmeticError):
                continue  # this draw is no system
    raise UsageError(
        f"none of {ATTEMPTS} draws of variant {number} gives a system with all answers", fix="make the ranges narrower"
    )


def _answered(model: Model) -> Iterator[str]:
    """The outputs with an answer, and the start where the bodies can be put together there.

    Raises:
        EomgenError: they cannot.
    """
    if model.coordinates and not missing_values(model):
        study_of(model).state_at_start  # noqa: B018  (raises where a constraint stays open)
    for name, answer in solve(model).items() if model.outputs else ():
        if answer.answered and (answer.value is None or math.isfinite(answer.value)):
            yield name


def _drawn(listed: Iterable[Any], random: Random) -> str:
    """A value in the unit of the parameter: one of its list, or a round number of its range."""
    values = tuple(Decimal(str(x)) for x in listed)
    return f"{random.choice(values if len(values) > 2 else round_numbers(*values)):f}"


def round_numbers(low: Decimal, high: Decimal) -> tuple[Decimal, ...]:
    """The multiples of 1, 2 or 5 times a power of ten between two ends, FEWEST of them or somewhat more."""
    exponent = (high - low).adjusted()
    steps = (Decimal(digit).scaleb(exponent - k) for k in count() for digit in (5, 2, 1))
    step = next(each for each in steps if (high - low) / each >= FEWEST)
    first = (low / step).to_integral_value(ROUND_CEILING)
    last = (high / step).to_integral_value(ROUND_FLOOR)
    return tuple((first + k) * step for k in range(int(last - first) + 1))
