"""Projection, tolerance -> DriftCorrection: which states of a run are put back onto the ties, how well they hold."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field

import numpy as np

from eomgen.codegen.spheres import SpherePlaces, on_spheres
from eomgen.simulation.projection import Projection

LOST = 100.0  # absolute tolerances of a step by which a tie that cannot be closed may be open without a word


@dataclass
class DriftCorrection:
    """Keeps the states of one run on the ties and the norms of quaternions at 1.

    Args:
        spheres: the places of quaternions.
        projection: onto the ties; None where nothing is put back.
        atol: the absolute tolerance of a step.
        every: put back at each so many steps, needed or not; None: where a tie is open by more than atol.
        steps: taken so far.
        lost: the first instant at which a tie stayed open by more than LOST tolerances, and by how much.
    """

    spheres: Sequence[SpherePlaces]
    projection: Projection | None
    atol: float
    every: int | None = None
    steps: int = 0
    lost: tuple[float, float] | None = field(default=None)

    def step(self, t: float, x: np.ndarray) -> tuple[np.ndarray, bool]:
        """(the state from which the run goes on after a step, whether it was put back)."""
        self.steps += 1
        if self.every is not None and self.steps % self.every:
            return (on_spheres(x, self.spheres), True) if self.spheres else (x, False)
        found = self.at(t, x, forced=self.every is not None)
        return (x, False) if found is x else (found, True)

    def at(self, t: float, x: np.ndarray, *, forced: bool = False) -> np.ndarray:
        """A state on the ties; itself where it is near enough."""
        if self.projection is None or not (forced or self.projection.is_open(t, x, self.atol)):
            return on_spheres(x, self.spheres) if self.spheres else x
        found, left = self.projection.closed(t, x, self.atol)
        if not left <= LOST * self.atol and self.lost is None:
            self.lost = t, left
        return found

    def rows(self, t: np.ndarray, x: np.ndarray) -> np.ndarray:
        """States between steps, one a row, on the ties too."""
        found = on_spheres(x, self.spheres)
        if self.projection is None or self.every is not None or not len(t):
            return found
        for i in np.flatnonzero(~(np.max(self.projection.open(t, found), axis=1) <= self.atol)):
            found[i] = self.at(float(t[i]), found[i])
        return found

    @property
    def remark(self) -> str:
        """What could not be held, as a sentence; "" where all was."""
        if self.lost is None:
            return ""
        t, left = self.lost
        return f"From t = {t:.6g} s on the ties could not be closed: they stayed open by {left:.1e}."
