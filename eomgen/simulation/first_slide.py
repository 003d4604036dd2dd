"""The states of a phase -> those at which its reactions are taken.

Friction on a surface is along v/|v|. Where a phase begins with v = 0 that is the sense in which the body begins to
slide, so its reactions are taken as soon as it slides fast enough to have one.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from eomgen.mechanics.constraints.ties import STILL

SLIDES = 1e2 * float(STILL)  # |v|, at which friction is all but along it [m/s]
BRIEF = 1e-2  # of the phase, the longest time that is waited for it
TRIES = 30  # each twice as long as the one before


def begun(
    t: np.ndarray,
    x: np.ndarray,
    rate: Callable[[float, np.ndarray], np.ndarray],
    sliding: Callable[[float, np.ndarray], float],
) -> np.ndarray:
    """n states, n x states, the first of them a little later where a contact begins to slide.

    Args:
        t: their instants.
        rate: (t, x) -> x'.
        sliding: (t, x) -> the least speed with which anything slides on a surface [m/s].
    """
    if len(t) < 2 or sliding(t[0], x[0]) >= SLIDES:
        return x
    later, h = x[0], BRIEF * (t[-1] - t[0]) / 2 ** (TRIES + 1)
    for _ in range(TRIES):
        later, h = later + h * rate(t[0], later), 2 * h
        if sliding(t[0], later) >= SLIDES:
            return np.vstack([later, x[1:]])
    return x
