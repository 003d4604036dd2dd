"""What was found of one quantity, and how it is told: exact, as a number, by which way; else what is missing."""

from __future__ import annotations

import re
from collections.abc import Mapping
from dataclasses import field
from typing import Any

from eomgen.records import dataclass

_RAISED = str.maketrans("-0123456789", "⁻⁰¹²³⁴⁵⁶⁷⁸⁹")
_POWER = re.compile(r"\^(?:\((-?\d+)\)|(-?\d+))")


def unit_text(unit: str) -> str:
    """A unit as it is printed: kg*m^2 as kg·m², which is read back as well."""
    return _POWER.sub(lambda power: (power[1] or power[2]).translate(_RAISED), unit).replace("*", "·")


@dataclass(frozen=True)
class Quantity:
    """One thing that was found: exact, as a number, by which way; else what is missing.

    Args:
        exact: text of the grammar with every parameter as a symbol, or None: an equation between quantities.
        value: a number in the unit, parameters and start (or instant) put in, or None.
        unit: of the number; "" for SI, None where nobody names one.
        method: the way on which it was found.
        message: what is missing, or None.
        beside: what else machines get of it, by name: the way of its proof, its work.
    """

    exact: str | None = None
    value: float | None = None
    unit: str | None = ""
    method: str = ""
    message: str | None = None
    beside: Mapping[str, Any] = field(default_factory=dict)

    @property
    def answered(self) -> bool:
        return self.exact is not None or self.value is not None

    @property
    def number(self) -> str:
        """The number with its unit, as it is printed; "" where there is none."""
        return "" if self.value is None else f"{self.value:.10g} {unit_text(self.unit or '')}".rstrip()

    @property
    def lines(self) -> list[str]:
        """A line for each thing that is known of it."""
        if not self.answered:
            return [f"not answered: {self.message}"]
        found = [f"= {part}" for part in (self.exact, self.number) if part]
        found[-1] += f"   [{self.method}]" if self.method else ""
        return [*found, f"({self.message})"] if self.message else found

    def as_dict(self) -> dict[str, Any]:
        """For `--json`; without what nobody says: unit, method and message."""
        told: dict[str, Any] = {"exact": self.exact, "value": self.value}
        told |= {} if self.unit is None else {"unit": self.unit}
        told |= {"method": self.method, "message": self.message} if self.method or self.message else {}
        return told | dict(self.beside)

    def _repr_markdown_(self) -> str:
        parts = [f"`{self.exact}`" if self.exact is not None else "", self.number]
        return " = ".join(part for part in parts if part) or (self.message or "")
