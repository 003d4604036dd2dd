"""Numbers in SI -> labels of a picture: one prefix for all its forces and couples, four figures, no powers of ten."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass

from eomgen.symbolic.numeric.tolerances import SMALLEST_PLAIN

PREFIXES = ((1e9, "G"), (1e6, "M"), (1e3, "k"), (1.0, ""), (1e-3, "m"))
ROOMY = 10.0  # a prefix is used from so many of its units on
FIGURES = 4


@dataclass(frozen=True)
class Scale:
    """The unit in which the forces of a picture are written, and those of couples with it.

    Args:
        factor: of the prefix.
        prefix: "k" of kN.
    """

    factor: float = 1.0
    prefix: str = ""

    def __call__(self, value: float) -> float:
        """A value in SI, in these units."""
        return value / self.factor

    def unit(self, unit: str) -> str:
        """kN of N, kN m of N m."""
        return self.prefix + unit

    def number(self, value: float) -> str:
        """A value in SI as its number in these units."""
        return figures(self(value))

    def text(self, value: float, unit: str) -> str:
        """A value in SI as "41.93 kN"."""
        return f"{self.number(value)} {self.unit(unit)}"


def scale_of(values: Iterable[float]) -> Scale:
    """The scale that the largest of some values asks for: kN from 10 kN on; units without prefix where all are 0."""
    largest = max((abs(value) for value in values), default=0.0)
    if not largest or ROOMY > largest >= 0.1:
        return Scale()
    return next((Scale(*pair) for pair in PREFIXES if largest >= ROOMY * pair[0]), Scale(*PREFIXES[-1]))


def figures(value: float) -> str:
    """A number with four figures, without a power of ten where it has less than eight digits: 12340, 0.05."""
    text = f"{value:.{FIGURES}g}"
    return f"{float(text):.10f}".rstrip("0").rstrip(".") if SMALLEST_PLAIN <= abs(value) < 1e8 else text
