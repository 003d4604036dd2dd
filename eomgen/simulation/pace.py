"""x' = f(t, x), steps -> why an end is out of reach: what is stiff, or turns too often.

The rates of the fastest motions nearby are the eigenvalues of df/dx. Explicit steps h are held near h |lambda| = 1: by
accuracy where lambda turns, by stability alone where it dies out, and then an implicit method takes longer ones.
Source: Hairer & Wanner, Solving Ordinary Differential Equations II, 2nd ed., IV.2.
"""

from __future__ import annotations

import math

import numpy as np

from eomgen.records import dataclass
from eomgen.simulation.solvers import EXPLICIT, StateRate
from eomgen.symbolic.numeric.tolerances import DIFFERENCE_STEP

LOOK = 10_000  # steps from one look to the next
MOST_STIFF = 200_000  # steps left that an explicit method takes where stability alone holds them short
BEYOND = 2.0**53  # of what changes by more than this, doubles do not know the units
HELD = (0.2, 20.0)  # h |lambda| of steps that an eigenvalue holds short


@dataclass
class Pace:
    """How fast a run comes on.

    Args:
        t: at the last look [s].
        end: of the run [s].
        most: steps in all.
        growth: the largest entry of dx/dt at the last look.
    """

    f: StateRate
    method: str
    t: float
    end: float
    most: int
    growth: float = 0.0

    def hopeless(self, steps: int, t: float, x: np.ndarray) -> str:
        """Why the end is out of reach, every LOOK steps; "" where it is not."""
        if steps % LOOK:
            return ""
        h, self.t = (t - self.t) / LOOK, t
        left = (self.end - t) / h if h > 0 else math.inf
        rate = self._fastest(t, x)
        most = MOST_STIFF if self._is_stiff(rate, h) else self.most
        return self._words(h, left, rate) if left > most else ""

    def words(self, steps: int, t: float, x: np.ndarray) -> str:
        """How far it is to the end, and what holds the steps short."""
        taken = steps % LOOK or LOOK
        h = (t - self.t) / taken if steps else 0.0
        return self._words(h, (self.end - t) / h, self._fastest(t, x)) if h > 0 else ""

    def _words(self, h: float, left: float, rate: complex) -> str:
        steps = f"steps are {h:.1e} s long, {left:.1e} of them are left to t = {self.end:.6g} s"
        if self._is_stiff(rate, h):
            return f"stiff, motions die out at {abs(rate):.1e} 1/s: {steps}; use --method Radau"
        turns = abs(rate.imag) * (self.end - self.t) / math.tau
        if HELD[0] <= h * abs(rate) <= HELD[1] and turns > 1:
            return f"fast, {turns:.1e} turns are left to t = {self.end:.6g} s: give a shorter --time"
        if self.growth * (self.end - self.t) > BEYOND:
            return f"the state grows by {self.growth:.1e} a second, beyond what doubles can follow"
        return f"{steps}; give a shorter --time, or another --method"

    def _is_stiff(self, rate: complex, h: float) -> bool:
        held = HELD[0] <= h * abs(rate) <= HELD[1]
        return self.method in EXPLICIT and held and -rate.real > abs(rate.imag)

    def _fastest(self, t: float, x: np.ndarray) -> complex:
        """The eigenvalue of df/dx of the largest size, by differences; 0 where it has no value."""
        dx = np.asarray(self.f(t, x))
        self.growth = float(np.max(np.abs(dx), initial=0.0))
        columns = []
        with np.errstate(all="ignore"):
            for k, size in enumerate(np.abs(x)):
                beside = x.copy()
                beside[k] += (step := DIFFERENCE_STEP * (1 + float(size)))
                columns.append((np.asarray(self.f(t, beside)) - dx) / step)
        J = np.array(columns).T
        if not np.all(np.isfinite(J)):
            return 0j
        rates = np.linalg.eigvals(J)
        return complex(rates[np.argmax(np.abs(rates))])
