"""Arrows of a structure as they are drawn, with the numbers beside them -> check: together they are in equilibrium.

    sum F = 0,   sum (r x F + C) = 0        F along its arrow, of the size that is written there

Of a picture nothing else is read: neither the model nor the reactions that were found.
"""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator, Mapping, Sequence
from functools import cached_property, partial
from typing import Any

import numpy as np

from eomgen.frozen import dataclass
from eomgen.mechanics.statics import SectionForces
from eomgen.proof.check import Check, Tally
from eomgen.proof.drawn_panels import DrawnPanel, said_of
from eomgen.symbolic.expression import Node, Scalar
from eomgen.symbolic.numeric import evaluate, fifty_digits, tolerances

NAME = "what is drawn on the structure holds it at rest"
HOW = "directions of the arrows and the numbers beside them"
PREFIXES = {"": 1.0, "m": 1e-3, "k": 1e3, "M": 1e6, "G": 1e9}
NUMBER = r"-?\d+(?:\.\d+)?(?:e[+-]?\d+)?"
VALUE = re.compile(rf"({NUMBER})(?: to ({NUMBER}))? ([mkMG]?)N(?: m|/m)?")


@dataclass(frozen=True)
class ReportedPush:
    """A force, a couple or a line load as it is drawn.

    Args:
        words: beside it, F = 2 kN.
        at, way: a place on its line of action and its direction, 3 each; of a line load its first arrow's, () where
            that has no length.
        turns: it is a couple.
        end: of a line load the place of its last arrow, and its direction.
    """

    words: str
    at: np.ndarray
    way: np.ndarray
    turns: bool = False
    end: tuple[np.ndarray, np.ndarray] | None = None


def structure_drawn(pushes: Iterable[ReportedPush]) -> Iterator[Check]:
    """Check of all arrows of a picture together."""
    tally, pushes = Tally(NAME, HOW), tuple(pushes)
    if pushes:
        tally.add("the structure", lambda: _unbalanced(pushes))
    return tally.checks()


def _unbalanced(pushes: Sequence[ReportedPush]) -> str:
    """Message if the forces or the couples do not vanish together; ""."""
    wrenches = [_wrench(push) for push in pushes]
    sums = np.sum([wrench for wrench, _ in wrenches], axis=0)
    sizes = np.sum([size for _, size in wrenches], axis=0)
    for what, found, size in (("forces", sums[:3], sizes[0]), ("couples", sums[3:], sizes[1])):
        if float(np.max(np.abs(found))) > tolerances.FOUR_DIGITS * size:
            return f"the {what} together are {', '.join(f'{x:.4g}' for x in found)}"
    return ""


def _wrench(push: ReportedPush) -> tuple[np.ndarray, np.ndarray]:
    """(force and moment about the origin, 6; sizes of both)"""
    first, last = _values(push.words)
    if push.end is not None:
        return _of_a_line(push, first, last)
    along = push.way / (float(np.linalg.norm(push.way)) or 1.0)
    if push.turns:
        return np.array([0, 0, 0, *(first * along)]), np.array([0, first])
    force = first * along
    return np.array([*force, *np.cross(push.at, force)]), np.array([first, first * (1 + np.linalg.norm(push.at))])


def _of_a_line(push: ReportedPush, first: float, last: float) -> tuple[np.ndarray, np.ndarray]:
    """Wrench and sizes of a load per length, linear between two places: each of its two triangles acts at its third."""
    assert push.end is not None
    (end, way), length = push.end, float(np.linalg.norm(push.end[0] - push.at))
    total, sizes = np.zeros(6), np.zeros(2)
    for value, along, share in ((first, push.way, 1 / 3), (last, way, 2 / 3)):
        size = float(np.linalg.norm(along))
        if not np.isfinite(size) or not size:
            continue
        at, force = push.at + share * (end - push.at), 0.5 * length * value / size * along
        total += np.array([*force, *np.cross(at, force)])
        sizes += np.linalg.norm(force) * np.array([1, 1 + np.linalg.norm(at)])
    return total, sizes


def _values(words: str) -> tuple[float, float]:
    """The value that is written beside an arrow, at both ends of a line load."""
    number = words.rpartition(" = ")[2]
    found = VALUE.fullmatch(number)
    if found is None:
        return 0.0, 0.0
    size = PREFIXES[found[3]]
    return size * float(found[1]), size * float(found[2] or found[1])


# -------- beams in space ----------------------------------------------------------------------------------------------
# Diagrams of beams in space as they are drawn -> check: each place of a curve is what acts behind the section.
#
#     N, V_y, V_z = R . (t, e_y, e_z),   T, M_y, M_z = T . (t, e_y, e_z)        R, T: of all that acts behind x, about x
#
# The forces are summed from the other end than where they were found; line loads by Simpson's rule, exact for them.


SECTIONS = "drawn section forces in space are right"
HOW_SECTIONS = "curves and numbers of the picture, from the other end"


def space_sections_drawn(
    values: Mapping[Node, Any], sections: Mapping[str, SectionForces], panels: Iterable[DrawnPanel]
) -> Iterator[Check]:
    """Check of every panel of components of a beam in space.

    Args:
        values: of all symbols, with 50 digits.
    """
    tally = Tally(SECTIONS, HOW_SECTIONS)
    for panel in panels:
        what, unit = said_of(panel.y)
        kinds, _, body = what.partition(" of ")
        names = kinds.split(", ")
        if body in sections and set(names) <= set(sections[body].kinds):
            beam = _Beam(values, sections[body])
            tally.add(what, partial(beam.wrong, names, panel, PREFIXES[unit.partition("N")[0]]))
    yield from tally.checks()


@dataclass(frozen=True)
class _Beam:
    values: Mapping[Node, Any]
    sections: SectionForces

    def numbers(self, v: Sequence[Scalar]) -> np.ndarray:
        return np.array([float(x) for x in evaluate(tuple(v), self.values, fifty_digits())])

    def one(self, x: Scalar) -> float:
        return float(self.numbers((x,))[0])

    @cached_property
    def _actions(self) -> list[tuple[float, np.ndarray, np.ndarray, np.ndarray]]:
        """(x, place, force, couple) of all that acts at places."""
        axis, acting = self.sections.axis, self.sections.loads.actions
        return [(self._x(axis.distance(p)), self.numbers(p), self.numbers(f), self.numbers(c)) for p, f, c in acting]

    @cached_property
    def _spreads(self) -> list[tuple[Any, ...]]:
        """The loads per length, (start, end, at the start, at the end) each."""
        return list(self.sections.loads.spreads)

    def _x(self, x: Scalar | None) -> float:
        return 0.0 if x is None else self.one(x)

    def behind(self, x: float, section: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Resultant, and moment about the section, of all that acts beyond x."""
        R, T = np.zeros(3), np.zeros(3)
        for at, place, force, couple in self._actions:
            if at > x:
                R, T = R + force, T + couple + np.cross(place - section, force)
        for start, end, at_start, at_end in self._spreads:
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
            axes = [self.numbers(e) for e in self.sections.triad(piece)]
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
