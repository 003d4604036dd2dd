"""Diagrams of beams in space as they are drawn -> check: each place of a curve is what acts behind the section.

    N, V_y, V_z = R . (t, e_y, e_z),   T, M_y, M_z = T . (t, e_y, e_z)        R, T: of all that acts behind x, about x

The forces are summed from the other end than where they were found from; line loads by Simpson's rule, exact for them.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from functools import cached_property, partial
from typing import Any

import numpy as np

from eomgen.frozen import dataclass
from eomgen.mechanics.statics import SPACE_KINDS, MemberLoads, SectionsInSpace, StaticReactions, triad
from eomgen.proof.check import Check, Tally
from eomgen.proof.drawn_panels import DrawnPanel, said_of
from eomgen.symbolic.expression import Node, Scalar
from eomgen.symbolic.numeric import evaluate, fifty_digits, tolerances

NAME = "drawn section forces in space are right"
HOW = "curves and numbers of the picture, from the other end"
PREFIXES = {"": 1.0, "m": 1e-3, "k": 1e3, "M": 1e6, "G": 1e9}


def space_sections_drawn(
    found: StaticReactions,
    values: Mapping[Node, Any],
    sections: Mapping[str, SectionsInSpace],
    panels: Iterable[DrawnPanel],
) -> Iterator[Check]:
    """Check of every panel of components of a beam in space.

    Args:
        values: of all symbols, with 50 digits.
    """
    tally = Tally(NAME, HOW)
    for panel in panels:
        what, unit = said_of(panel.y)
        kinds, _, body = what.partition(" of ")
        names = kinds.split(", ")
        if body in sections and set(names) <= set(SPACE_KINDS):
            beam = _Beam(found, values, sections[body])
            tally.add(what, partial(beam.wrong, names, panel, PREFIXES[unit.partition("N")[0]]))
    yield from tally.checks()


@dataclass(frozen=True)
class _Beam:
    found: StaticReactions
    values: Mapping[Node, Any]
    sections: SectionsInSpace

    def numbers(self, v: Sequence[Scalar]) -> np.ndarray:
        return np.array([float(x) for x in evaluate(tuple(v), self.values, fifty_digits())])

    def one(self, x: Scalar) -> float:
        return float(self.numbers((x,))[0])

    @cached_property
    def _actions(self) -> list[tuple[float, np.ndarray, np.ndarray, np.ndarray]]:
        """(x, place, force, couple) of all that acts at places."""
        axis, loads = self.sections.axis, self._loads
        return [(self._x(axis.distance(p)), *map(self.numbers, (p, f, c))) for p, f, c in loads.actions]

    @cached_property
    def _loads(self) -> MemberLoads:
        axis = self.sections.axis
        return MemberLoads(self.found.balance, axis.body, axis.sizes)

    def _x(self, x: Scalar | None) -> float:
        return 0.0 if x is None else self.one(x)

    def behind(self, x: float, section: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Resultant, and moment about the section, of all that acts beyond x."""
        R, T = np.zeros(3), np.zeros(3)
        for at, place, force, couple in self._actions:
            if at > x:
                R, T = R + force, T + couple + np.cross(place - section, force)
        for start, end, at_start, at_end in self._loads.spreads:
            a, b = (self._x(self.sections.axis.distance(place)) for place in (start, end))
            p, q, f, g = map(self.numbers, (start, end, at_start, at_end))
            if a > b:
                a, b, p, q, f, g = b, a, q, p, g, f
            first = min(max((x - a) / (b - a), 0.0), 1.0)
            for part, weight in ((first, 1), ((first + 1) / 2, 4), (1.0, 1)):
                force = weight * (1 - first) * (b - a) / 6 * (f + part * (g - f))
                R, T = R + force, T + np.cross(p + part * (q - p) - section, force)
        return R, T

    def wrong(self, names: Sequence[str], panel: DrawnPanel, unit: float) -> str:
        """Message if a curve, or a number beside one, differs; ""."""
        pieces = self.sections.pieces
        if panel.hidden or panel.is_turned or len(panel.curves) != len(pieces) * len(names):
            return "other curves are drawn, or hidden"
        largest = max(float(np.max(np.abs(curve.places[:, 1]))) for curve in panel.curves)
        for k, curve in enumerate(panel.curves):
            piece, name = pieces[k % len(pieces)], names[k // len(pieces)]
            start, end = self.one(piece.start), self.one(piece.end)
            x, y = curve.places[1:-1].T
            if abs(x[0] - start) + abs(x[-1] - end) > tolerances.SAME_PLACE * (1 + abs(end)):
                return f"drawn from {x[0]:.6g} to {x[-1]:.6g}, not from {start:.6g} to {end:.6g}"
            origin, x0 = self.numbers(piece.leg.start), self.one(piece.leg.x)
            axes = [self.numbers(e) for e in triad(piece.leg, self.sections.axis.sizes)]
            near = tolerances.COMPUTED * (end - start)
            for at, value in zip(x, y, strict=True):
                inside = min(max(at, start + near), end - near)
                R, T = self.behind(inside, origin + (inside - x0) * axes[0])
                vector, axis = (
                    (T, ("T", "M_y", "M_z").index(name))
                    if name in ("T", "M_y", "M_z")
                    else (
                        R,
                        ("N", "V_y", "V_z").index(name),
                    )
                )
                right = float(vector @ axes[axis]) / unit
                if abs(value - right) > tolerances.CARRIED * (1 + abs(largest) + abs(right)):
                    return f"{name} at x = {at:.6g} {value:.6g} for {right:.6g}"
        return _misnamed(panel)


def _misnamed(panel: DrawnPanel) -> str:
    """Message if a number beside a place is another than its height; ""."""
    for text, place in panel.names:
        if abs(float(text) - place[1]) > tolerances.FOUR_DIGITS * abs(place[1]):
            return f"{text} stands at {place[1]:.6g}"
    return ""
