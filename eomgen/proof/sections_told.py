"""Section forces as they are told -> a check: by the names of their columns they are those that were found.

    dM/dx = V between the ends of each piece,   V = 0 and M as told at an extreme,   N, V, M the piece's polynomials

Taken as they stand, at random values of all symbols: each under the head that it is printed under, and for machines.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator, Mapping, Sequence
from functools import partial
from random import Random
from typing import Any

from eomgen.errors import ExpressionError
from eomgen.mechanics.statics.section_forces import SectionForces
from eomgen.proof.check import Check, Tally, differing
from eomgen.records import dataclass
from eomgen.symbolic.expression.derivative import symbols_of
from eomgen.symbolic.expression.expressions import LONGEST, parse
from eomgen.symbolic.expression.graph import Node, Scalar
from eomgen.symbolic.numeric.evaluation import FLOAT, NoValue, evaluate
from eomgen.symbolic.numeric.tolerances import CARRIED

NAME, HOW = "section forces as they are told are those that were found", "heads and texts read back, random values"
Told = Scalar | str


@dataclass(frozen=True)
class ToldSections:
    """What is told of one body.

    Args:
        variable: the distance along its axis.
        pieces: of each "from", "to", "N", "V", "M".
        extremes: of each "x", "M".
    """

    variable: str
    pieces: Sequence[Mapping[str, Told]]
    extremes: Sequence[Mapping[str, Told]]


def sections_told(
    found: Mapping[str, SectionForces], told: Iterable[tuple[str, ToldSections]], values: Mapping[str, Any]
) -> Iterator[Check]:
    """Of each body what is told, as often as it is told.

    Args:
        values: of parameters: near to them everything has a value.
    """
    tally, near = Tally(NAME, HOW), {name: float(x) for name, x in values.items()}
    for body, each in told:
        tally.add(body, partial(_wrong, found[body], each, near))
    return tally.checks()


def _wrong(forces: SectionForces, told: ToldSections, near: Mapping[str, float]) -> str:
    if len(told.pieces) != len(forces.pieces) or len(told.extremes) != len(forces.extremes):
        return f"{len(told.pieces)} pieces and {len(told.extremes)} extremes are told"
    values = _Values(told.variable, near)
    for piece, row in zip(forces.pieces, told.pieces, strict=True):
        start, end = values.of(piece.start), values.of(piece.end)
        ends = (("from", start), ("to", end))
        wrong = [differing(values.of(row[name]), right, CARRIED) for name, right in ends]
        x, h = start + (end - start) * 0.37, (end - start) * 0.25
        polynomials = {"N": piece.N, "V": piece.V, "M": piece.M}
        for name, coefficients in polynomials.items():
            right = sum(values.of(c) * (x - start) ** k for k, c in enumerate(coefficients))
            size = sum(abs(values.of(c) * (x - start) ** k) for k, c in enumerate(coefficients))
            at = values.of(row[name], x)
            wrong.append(f"{name}: {at:.10g} for {right:.10g}" if abs(at - right) > CARRIED * (1 + size) else "")
        slope = (8 * _rise(values, row, x, h / 2) - _rise(values, row, x, h)) / (6 * h)  # exact to the fourth power
        V = values.of(row["V"], x)
        if not any(wrong) and abs(slope - V) > CARRIED * (1 + abs(V) + abs(values.of(row["M"], x) / h)):
            wrong.append(f"dM/dx = {slope:.10g}, V = {V:.10g}")
        if any(wrong):
            return next(filter(None, wrong))
    for extreme, one in zip(told.extremes, forces.extremes, strict=True):
        for name, due in (("x", one.x), ("M", one.M)):
            if apart := differing(values.of(extreme[name]), values.of(due), CARRIED):
                return f"{name} of an extreme: {apart}"
    return ""


def _rise(values: _Values, row: Mapping[str, Told], x: float, h: float) -> float:
    return values.of(row["M"], x + h) - values.of(row["M"], x - h)


class _Values:
    """Random values of symbols, the same of one name.

    Args:
        variable: the distance along the axis.
        near: values of those that have one, beside which these lie.
    """

    def __init__(self, variable: str, near: Mapping[str, float]) -> None:
        self.variable, self.near, self.random = variable, near, Random(3)
        self.known = dict[str, float]()

    def of(self, told: Told, x: float = 0.0) -> float:
        """A scalar, or a text of the grammar, in numbers.

        Raises:
            NoValue: it has none.
        """
        if isinstance(told, str):
            found = self._of_text(told, x)
        elif type(told) is Node:
            symbols = symbols_of((told,))
            found = evaluate((told,), {s: self._symbol(s.name, x) for s in symbols}, FLOAT)[0]
        else:
            found = float(told)
        if not math.isfinite(found):
            raise NoValue("at random values it has none")
        return float(found)

    def _of_text(self, text: str, x: float) -> Any:
        if len(text) > LONGEST:
            raise NoValue("too long to be read back")
        try:
            expression = parse(text, longest=len(text))
        except ExpressionError as error:
            raise NoValue(error.what) from error
        names = {name: self._symbol(name, x) for name in expression.names - {"pi"}}
        return expression.evaluate({**names, "pi": math.pi})

    def _symbol(self, name: str, x: float) -> float:
        if name == self.variable:
            return x
        if name not in self.known:
            value = self.near.get(name)
            self.known[name] = self.random.uniform(0.5, 2) if value is None else value * self.random.uniform(0.98, 1.02)
        return self.known[name]
