"""Arrows of a structure as they are drawn, with the numbers beside them -> check: together they are in equilibrium.

    sum F = 0,   sum (r x F + C) = 0        F along its arrow, of the size that is written there

Of a picture nothing else is read: neither the model nor the reactions that were found.
"""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator, Sequence

import numpy as np

from eomgen.frozen import dataclass
from eomgen.proof.check import Check, Tally
from eomgen.symbolic.numeric import tolerances

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
    """Of a load per length that is linear between two places: each of its two triangles acts at its third."""
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
