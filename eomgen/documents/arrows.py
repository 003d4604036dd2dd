"""Arrows of a drawing: forces that end at their point, couples as arcs, loads that are spread along a line."""

from __future__ import annotations

import math
from collections.abc import Iterable
from itertools import pairwise
from typing import Any

import numpy as np

from eomgen.documents.drawing import LOAD, REACTION, PagePoint, Sketch, name_beside

__all__ = ["LOAD", "REACTION", "arrow", "distributed", "is_freer_outward", "moment_arc"]

STEEP = 0.25  # sine of the angle below which two lines run along one another
CLEAR = 0.15  # of an arrow: nearer to a line it is on it; so much of it is at its own place


def arrow(panel: Any, tip: PagePoint, vector: PagePoint, *, color: str, label: str = "", outward: bool = False) -> None:
    """An arrow whose tip is at a place; `outward`: that begins there (velocities, displacements).

    Args:
        vector: direction and length, in the drawing's units.
        label: at its free end.
    """
    (x, y), (dx, dy) = tip, vector
    length = math.hypot(dx, dy)
    if not length:
        return
    begin, end = ((x, y), (x + dx, y + dy)) if outward else ((x - dx, y - dy), (x, y))
    panel.annotate(
        "",
        end,
        xytext=begin,
        zorder=7,
        arrowprops={"arrowstyle": "-|>", "color": color, "linewidth": 1.5, "shrinkA": 0, "shrinkB": 0},
    )
    free = end if outward else begin
    panel.plot(*free, alpha=0)  # so that the axes hold it
    if label:
        name_beside(panel, label, free, color)


def is_freer_outward(lines: Iterable[np.ndarray], at: PagePoint, vector: PagePoint) -> bool:
    """Whether an arrow meets fewer lines where it begins at its place than where it ends there."""
    pieces = [piece for line in lines for piece in pairwise(line)]
    place, stroke = np.array(at), np.array(vector)
    begun, ended = (sum(_meets(a, b, place, s) for a, b in pieces) for s in (stroke, -stroke))
    return begun < ended


def _meets(a: np.ndarray, b: np.ndarray, at: np.ndarray, stroke: np.ndarray) -> bool:
    """Whether a stroke from a place runs along the piece a b, or crosses it further on."""
    along, away = b - a, at - a
    turn = along[0] * stroke[1] - along[1] * stroke[0]
    sizes = float(np.hypot(*along) * np.hypot(*stroke))
    if not sizes:
        return False
    if abs(turn) < STEEP * sizes:
        middle = away + stroke / 2
        share = float(np.clip(middle @ along / (along @ along), 0, 1))
        return bool(np.hypot(*(middle - share * along)) < CLEAR * np.hypot(*stroke))
    on_piece = (away[0] * stroke[1] - away[1] * stroke[0]) / turn
    on_stroke = (away[0] * along[1] - away[1] * along[0]) / turn
    return bool(0 <= on_piece <= 1 and CLEAR < on_stroke <= 1)


def moment_arc(panel: Any, sketch: Sketch, at: PagePoint, sense: float, *, color: str, label: str = "") -> None:
    """A couple: three quarters of a circle with an arrow, counter-clockwise for a positive sense."""
    r = 1.9 * sketch.symbol
    turns = np.linspace(-0.25 * math.pi, 1.25 * math.pi, 40)
    turns = turns if sense > 0 else turns[::-1]
    x, y = at[0] + r * np.cos(turns), at[1] + r * np.sin(turns)
    panel.plot(x[:-2], y[:-2], color=color, linewidth=1.5, zorder=7)
    panel.annotate(
        "",
        (x[-1], y[-1]),
        xytext=(x[-4], y[-4]),
        zorder=7,
        arrowprops={"arrowstyle": "-|>", "color": color, "linewidth": 1.5, "shrinkA": 0, "shrinkB": 0},
    )
    if label:
        name_beside(panel, label, (at[0], at[1] + r), color)


def distributed(
    panel: Any,
    ends: tuple[PagePoint, PagePoint],
    vectors: tuple[PagePoint, PagePoint],
    *,
    color: str = LOAD,
    label: str = "",
) -> None:
    """A load along a line: arrows whose tips are on it, their tails joined.

    Args:
        ends: of the line.
        vectors: of the load there, in the drawing's units.
    """
    (a, b), (p, q) = (np.array(ends), np.array(vectors))
    highest = max(float(np.linalg.norm(p)), float(np.linalg.norm(q)))
    count = 3 + int(min(8.0, 3 * float(np.linalg.norm(b - a)) / (highest or 1.0)))
    tails = []
    for share in np.linspace(0, 1, count):
        tip, vector = a + share * (b - a), p + share * (q - p)
        tails.append(tip - vector)
        arrow(panel, (tip[0], tip[1]), (vector[0], vector[1]), color=color)
    panel.plot(*np.array(tails).T, color=color, linewidth=1.2, zorder=6)
    if label:
        x, y = np.mean(tails, axis=0)
        name_beside(panel, label, (float(x), float(y)), color)
