"""Two places -> the zigzag line of a spring between them."""

from __future__ import annotations

import math

import numpy as np

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
