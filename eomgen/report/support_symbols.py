"""Symbols of a drawing: hinges, welds, supports, springs; d is their size, in the drawing's units."""

from __future__ import annotations

import math
from collections.abc import Iterable
from typing import Any

import numpy as np

PagePoint = tuple[float, float]
GROUNDED = "#5a5a5a"


def _turned(at: PagePoint, turn: float, points: Iterable[PagePoint]) -> np.ndarray:
    c, s = math.cos(turn), math.sin(turn)
    return np.array([(at[0] + c * x - s * y, at[1] + s * x + c * y) for x, y in points])


def hinge(panel: Any, d: float, at: PagePoint) -> None:
    """A small circle."""
    panel.plot(*at, marker="o", markersize=6, markerfacecolor="white", markeredgecolor=GROUNDED, zorder=5)


def weld(panel: Any, d: float, at: PagePoint) -> None:
    """A small square."""
    panel.plot(*at, marker="s", markersize=5, color=GROUNDED, zorder=5)


def pin(panel: Any, d: float, at: PagePoint) -> None:
    """A triangle on the ground under a hinge."""
    panel.fill(
        *_turned(at, 0.0, [(0, 0), (-d, -1.7 * d), (d, -1.7 * d)]).T, facecolor="white", edgecolor=GROUNDED, zorder=4
    )
    _ground(panel, d, at, 0.0, -1.7 * d)
    hinge(panel, d, at)


def roller(panel: Any, d: float, at: PagePoint, turn: float) -> None:
    """The same on wheels, turned by an angle."""
    panel.fill(
        *_turned(at, turn, [(0, 0), (-d, -1.4 * d), (d, -1.4 * d)]).T, facecolor="white", edgecolor=GROUNDED, zorder=4
    )
    wheel = [(0.28 * d * math.cos(a), 0.28 * d * math.sin(a) - 1.7 * d) for a in np.linspace(0, 2 * math.pi, 25)]
    for side in (-0.55 * d, 0.55 * d):
        panel.plot(*_turned(at, turn, [(x + side, y) for x, y in wheel]).T, color=GROUNDED, linewidth=0.9, zorder=4)
    _ground(panel, d, at, turn, -2.0 * d)
    hinge(panel, d, at)


def clamp(panel: Any, d: float, at: PagePoint) -> None:
    """A block in the ground."""
    panel.plot(*at, marker="s", markersize=7, color=GROUNDED, zorder=5)
    _ground(panel, d, at, 0.0, -0.5 * d)


def rail(panel: Any, d: float, at: PagePoint, turn: float) -> None:
    """A block on a line along which it slides."""
    panel.plot(*_turned(at, turn, [(-3 * d, 0), (3 * d, 0)]).T, color=GROUNDED, linewidth=0.9, zorder=1)
    panel.plot(*at, marker="s", markersize=7, markerfacecolor="white", markeredgecolor=GROUNDED, zorder=4)


def _ground(panel: Any, d: float, at: PagePoint, turn: float, below: float) -> None:
    """A line with hatching."""
    panel.plot(*_turned(at, turn, [(-1.7 * d, below), (1.7 * d, below)]).T, color=GROUNDED, linewidth=1.2, zorder=4)
    for k in range(6):
        x = (-1.5 + 0.6 * k) * d
        panel.plot(
            *_turned(at, turn, [(x, below), (x - 0.5 * d, below - 0.6 * d)]).T, color=GROUNDED, linewidth=0.7, zorder=4
        )


TEETH = 8
STRAIGHT = 0.15  # of its length, at each end


def coil(a: tuple[float, float], b: tuple[float, float], width: float) -> np.ndarray:
    """The points of a zigzag from a to b, straight at its ends; `width` is its amplitude."""
    start, along = np.array(a), np.subtract(b, a)
    length = math.hypot(*along)
    if not length:
        return np.array([a, b])
    shares = [0.0, *np.linspace(STRAIGHT, 1 - STRAIGHT, 2 * TEETH + 1), 1.0]
    sides = [0.0, 0.0, *([1.0, -1.0] * TEETH)[: 2 * TEETH - 1], 0.0, 0.0]
    across = np.array([-along[1], along[0]]) * (width / length)
    return np.array([start + share * along + side * across for share, side in zip(shares, sides, strict=True)])
