"""A coordinate or its rate in SI -> its value as its user writes it: 28.6 deg, 90 deg/s."""

from __future__ import annotations

import math

from eomgen.model.parts import Model


def in_own_unit(model: Model, name: str, value: float, digits: int = 9) -> str:
    """The value with its unit, where the coordinate has one that is not of SI; a number alone elsewhere."""
    rate = name.endswith("'")
    part = model.coordinates.get(name[:-1] if rate else name)
    unit = None if part is None else part.unit
    if unit is None or (unit.factor == 1 and unit.pi_power == 0):
        return f"{value:.{digits}g}"
    return f"{float(unit.from_si(value, math.pi)):.{digits}g} {unit.text}{'/s' * rate}"
