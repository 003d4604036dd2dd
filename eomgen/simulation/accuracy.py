"""A run, the same with finer tolerances -> how many digits of it hold, and since when none does.

The errors of a run go with its tolerances: against one of a hundredth of them its own error is what differs. Where
neighbouring motions part exponentially (chaos) digits are lost at a steady pace, until none is left.
"""

from __future__ import annotations

import math

import numpy as np

from eomgen.records import dataclass
from eomgen.simulation.result import Trajectory
from eomgen.symbolic.numeric.tolerances import BEST, LEAST_RTOL, SAME_PLACE

FINER = 100.0  # times
FEWEST, DECADES = 6, 3.0  # instants that show a pace; powers of ten by which errors grow where motions part
LOST = 0.1  # of the largest value of a coordinate or speed: a digit that does not hold


@dataclass(frozen=True)
class Accuracy:
    """How well the states of a run are known.

    Args:
        error: of the last state, of each column against its largest value in the run; the largest. Infinite where one
            of the two runs has left the numbers.
        until: the first instant at which no digit holds any more [s]; None where some hold to the end.
        parts: whether digits were lost at a steady pace until then: neighbouring motions part exponentially.
    """

    error: float
    until: float | None
    parts: bool = False

    @property
    def digits(self) -> int:
        """So many hold at the end."""
        return max(0, math.floor(-math.log10(max(self.error, BEST)))) if self.until is None else 0

    def as_dict(self) -> dict[str, float | None]:
        return {"digits": self.digits, "error": self.error if math.isfinite(self.error) else None, "until": self.until}

    def __str__(self) -> str:
        if self.until is not None:
            why = "neighbouring motions part" if self.parts else "a finer run goes another way from there"
            return f"No digit of the states holds from t = {self.until:.4g} s on: {why}."
        return f"Digits that hold at the end: {self.digits}."


def finer(tolerance: float) -> float:
    """The tolerance of the run that one is held against; a coarser one where there is no finer."""
    return tolerance / FINER if tolerance / FINER >= LEAST_RTOL else tolerance * FINER


def accuracy_of(run: Trajectory, other: Trajectory, share: float) -> Accuracy | None:
    """How well a run is known by another of the same motion; None where they have no instant in common.

    Args:
        other: at the same instants.
        share: of the difference that is this run's error: 1 where the other is finer.
    """
    common, mine, its = np.intersect1d(run.t, other.t, return_indices=True)
    if run.coordinates + run.speeds != other.coordinates + other.speeds or not len(common):
        return None
    ended = common[-1] < run.t[-1]  # the other came to another end
    if ended and abs(run.t[-1] - other.t[-1]) <= SAME_PLACE * (run.t[-1] - run.t[0]):  # both at the same event
        common, ended = np.append(common, run.t[-1]), False
        mine, its = np.append(mine, len(run.t) - 1), np.append(its, len(other.t) - 1)
    largest = np.max(np.abs(run.x), axis=0, initial=0.0)
    apart = np.abs(run.x[mine] - other.x[its]) / np.where(largest > 0, largest, 1.0)
    errors = np.nan_to_num(share * np.max(apart, axis=1, initial=0.0), nan=np.inf, posinf=np.inf)
    lost = np.flatnonzero(~(errors < LOST))
    until = float(common[lost[0]]) if lost.size else float(common[-1]) if ended else None
    return Accuracy(
        float(errors[-1]), until, until is not None and _part_steadily(errors[: lost[0]] if lost.size else errors)
    )


def _part_steadily(errors: np.ndarray) -> bool:
    """Whether errors grow exponentially: their digits go one after the other, not most of them at one instant."""
    digits = np.log10(np.maximum.accumulate(errors[errors > 0]))
    if len(digits) < FEWEST:
        return False
    lost = digits[-1] - digits[0]
    return bool(lost >= DECADES and np.max(np.diff(digits)) <= lost / 2)
