"""scipy's integrators, one step at a time, and the number of correct digits of a run.

scipy's integrators, one step at a time: the start of each, never across a breakpoint, and the replacement of a state.

A step across a bend is a step of order one there, and a step from rest across a short pulse does not see it.
"""

from __future__ import annotations

import math
from bisect import bisect_right
from collections.abc import Callable, Sequence
from functools import partial
from typing import Any

import numpy as np

from eomgen.errors import RunFailed
from eomgen.frozen import dataclass
from eomgen.resources import check_patience
from eomgen.simulation.result import Trajectory
from eomgen.symbolic.numeric import tolerances


def step(solver: Any, breakpoints: Sequence[float], end: float) -> None:
    """One step of an integrator, to the next breakpoint at the latest; it goes on until the end.

    Raises:
        NotFinite: the right-hand side or its slope has no value.
    """
    if breakpoints:
        k = bisect_right(breakpoints, solver.t + tolerances.SOLVED * max(1.0, abs(solver.t)))
        solver.t_bound = min([end, *breakpoints[k : k + 1]])
        if hasattr(solver, "_lsoda_solver"):
            solver._lsoda_solver._integrator.rwork[0] = solver.t_bound
    try:
        solver.step()
    except ValueError as error:  # what an implicit method makes of a slope that is beyond doubles
        raise NotFinite from error
    if solver.status == "finished" and solver.t < end:
        solver.status = "running"


AUTO = "auto"  # DOP853, and Radau where stability alone holds its steps short
TAYLOR = "taylor"  # in C, of what has power series; else as auto
EXPLICIT = ("DOP853", TAYLOR, "RK45", "RK23")
IMPLICIT = ("Radau", "BDF", "LSODA")
METHODS = (AUTO, *EXPLICIT, *IMPLICIT)
HEYOKA = "heyoka"  # of an extra package, for smooth equations without a linear solve

HELD_SHORT = 6.1  # h |lambda|: at the edge of the stability of DOP853 (Hairer & Wanner, IV.2)
SEEN, FORGOTTEN = 15, 6  # steps that are held short until the method changes; others between them until it begins anew

StateRate = Callable[[float, np.ndarray], np.ndarray]
Slope = Callable[[float, np.ndarray], np.ndarray]
LateSlope = Callable[[], Slope | None]
"""A slope that is made where it is needed."""


@dataclass
class StiffnessWatch:
    """Detects that stability alone holds the steps of scipy's DOP853 short."""

    seen: int = 0
    easy: int = 0

    def step(self, solver: Any) -> bool:
        """True if it is time for an implicit method, after a step."""
        moved = float(np.linalg.norm((solver.B - solver.A[-1]) @ solver.K[:12]))  # two stages look at one instant
        rate = float(np.linalg.norm(solver.K[12] - solver.K[11])) / moved if moved > 0 else 0.0
        if rate > HELD_SHORT:
            self.seen, self.easy = self.seen + 1, 0
        else:
            self.easy += 1
            self.seen = 0 if self.easy >= FORGOTTEN else self.seen
        return self.seen >= SEEN


class NotFinite(ArithmeticError):
    """An implicit method met a right-hand side without a value."""


def solver_of(
    method: str,
    f: StateRate,
    span: tuple[float, float],
    x0: np.ndarray,
    *,
    rtol: float,
    atol: float,
    slope: Slope | None = None,
) -> Any:
    """An integrator at its start.

    Args:
        method: one of METHODS.
        slope: (t, x) -> df/dx, for the implicit methods; None: by differences.
    """
    import scipy.integrate

    method = EXPLICIT[0] if method in (AUTO, TAYLOR) else method

    def finite(t: float, x: np.ndarray) -> np.ndarray:
        dx = f(t, x)
        if not np.all(np.isfinite(dx)):
            raise NotFinite
        return dx

    explicit = method in EXPLICIT  # these shrink the step where a trial has no value
    options = {"rtol": rtol, "atol": atol} | ({} if explicit or slope is None else {"jac": slope})
    with np.errstate(all="ignore"):
        solver = getattr(scipy.integrate, method)(f if explicit else finite, span[0], x0, span[1], **options)
    if method == EXPLICIT[0]:
        solver.dense_output = partial(_accurate_between, solver, solver.dense_output)
    return solver


def states_along(f: StateRate, x0: np.ndarray, instants: np.ndarray, breakpoints: Sequence[float]) -> np.ndarray:
    """The states of a smooth motion at instants, k x n, by steps of fine tolerance.

    Args:
        instants: ascending; states at 0 and before are those of the start.
        breakpoints: instants across which no step goes.
    Raises:
        RunFailed: the motion ends before.
    """
    end = float(instants[-1])
    found = [x0 for t in instants if t <= 0]
    solver = solver_of("DOP853", f, (0.0, end), x0, rtol=tolerances.FINE_RUN, atol=tolerances.FINE_RUN)
    while len(found) < len(instants):
        check_patience()
        step(solver, breakpoints, end)
        if solver.status == "failed":
            raise RunFailed(f"the motion cannot be followed beyond t = {solver.t:.6g} s", fix="a shorter run")
        dense = solver.dense_output()
        while len(found) < len(instants) and instants[len(found)] <= solver.t:
            found.append(dense(instants[len(found)]))
    return np.array(found)


def put_state(solver: Any, x: np.ndarray) -> None:
    """Let an integrator go on from another state that is near its own.

    Methods of one step begin anew from it; in those of several the state is an entry of their history, whose
    differences stay.
    """
    solver.y = x
    if hasattr(solver, "f"):  # of one step
        solver.f = solver.fun(solver.t, x)
    elif hasattr(solver, "_lsoda_solver"):
        solver._lsoda_solver._y = x.copy()
        solver._lsoda_solver._integrator.rwork[20 : 20 + len(x)] = x
    else:  # BDF
        solver.D[0] = x


MISSED, MOST_PIECES = 10.0, 8  # as dop853_pieces.c has them: a test compares


def _accurate_between(solver: Any, dense_output: Callable[[], Any]) -> Callable[[Any], np.ndarray]:
    """t -> x in the last step of DOP853, as accurate as the ends of its steps.

    Where stability alone holds a step short, its end is far more accurate than its polynomial. The rate of that shows
    it, and the step is followed once more in shorter pieces, as dop853_pieces.c does.
    """
    from scipy.integrate import DOP853

    whole = dense_output()
    h, pieces = solver.t - solver.t_old, 1
    with np.errstate(all="ignore"):
        missed = _missed(solver, whole, 0.3)
        while missed > MISSED and pieces < MOST_PIECES:
            missed, pieces = missed / 256, 2 * pieces
        if pieces == 1:
            return whole  # type: ignore[no-any-return]
        length = h / pieces
        shorter = DOP853(
            solver.fun, solver.t_old, whole.y_old, solver.t, first_step=length, max_step=length, rtol=1.0, atol=np.inf
        )
        found: list[Any] = []
        while len(found) < pieces and shorter.status == "running":
            shorter.step()
            found.append(shorter.dense_output())

    begun = solver.t_old

    def between(t: Any) -> np.ndarray:
        k = np.clip(np.floor((np.asarray(t) - begun) / length).astype(int), 0, len(found) - 1)
        if np.ndim(t) == 0:
            return np.asarray(found[int(k)](t))
        return np.column_stack([found[j](each) for j, each in zip(k, t, strict=True)])

    return between


def _missed(solver: Any, whole: Any, part: float) -> float:
    """Tolerances by which the rate of a step's polynomial, times its length, misses that of the equations."""
    value, slope = np.zeros_like(whole.y_old), np.zeros_like(whole.y_old)
    for i, row in enumerate(reversed(whole.F)):
        value = value + row
        factor, sign = (part, 1) if i % 2 == 0 else (1 - part, -1)
        value, slope = value * factor, slope * factor + sign * value
    h = solver.t - solver.t_old
    rate = solver.fun(solver.t_old + part * h, value + whole.y_old)
    size = solver.atol + solver.rtol * np.maximum(np.abs(whole.y_old), np.abs(solver.y))
    return float(np.max(np.abs(h * rate - slope) / size, initial=0.0))


class ScipySteps:
    """One of scipy's integrators, one step a call; "auto" goes over to Radau where DOP853 is held short.

    Args:
        method: one of METHODS.
        span, x0: the first and the last instant, and the state at the first.
        rtol, atol: of one step.
        breakpoints: instants across which no step goes.
        slope: df/dx, used where steps are implicit.
    """

    def __init__(
        self,
        method: str,
        f: StateRate,
        span: tuple[float, float],
        x0: np.ndarray,
        *,
        rtol: float,
        atol: float,
        breakpoints: Sequence[float],
        slope: LateSlope,
    ) -> None:
        self._f, self._end, self._breakpoints, self._slope = f, span[1], breakpoints, slope
        self._tolerances = {"rtol": rtol, "atol": atol}
        self._solver = self._begun(method, span[0], x0)
        self._stiffness = StiffnessWatch() if method == AUTO else None
        self._before, self._implicit_steps = 0, 0
        self.stiff_from: float | None = None

    def _begun(self, method: str, t: float, x: np.ndarray) -> Any:
        slope = self._slope() if method in IMPLICIT else None
        return solver_of(method, self._f, (t, self._end), x, slope=slope, **self._tolerances)

    def advance(self, _: int) -> tuple[int, bool]:
        """(1, whether nothing is left to be done about it), or no step where it failed.

        Raises:
            NotFinite: the right-hand side or its slope has no value.
        """
        if self._stiffness is not None and self._solver.t_old is not None and self._stiffness.step(self._solver):
            self._stiffness, self.stiff_from, self._before = None, self.t, self._solver.nfev
            self._solver = self._begun("Radau", self.t, self.y)
        with np.errstate(all="ignore"):
            step(self._solver, self._breakpoints, self._end)
        self._implicit_steps += self.stiff_from is not None
        return int(self.status != "failed"), False

    @property
    def status(self) -> str:
        return str(self._solver.status)

    @property
    def t(self) -> float:
        return float(self._solver.t)

    @property
    def t_old(self) -> float:
        return float(self._solver.t_old)

    @property
    def y(self) -> np.ndarray:
        return np.asarray(self._solver.y)

    @property
    def nfev(self) -> int:
        return int(self._before + self._solver.nfev)

    @property
    def words(self) -> str:
        return stiff_words(self.stiff_from, self._implicit_steps)

    def dense_output(self) -> Any:
        """t -> x in the last step."""
        return self._solver.dense_output()

    def put(self, x: np.ndarray) -> None:
        """Go on from another state nearby."""
        put_state(self._solver, x)


def stiff_words(since: float | None, steps: int) -> str:
    """Sentence on the stiff part of a run; "" where nothing was."""
    return "" if since is None else f"Stiff from t = {since:.3g} s on: {steps} steps by Radau's method."


# -------- accuracy --------------------------------------------------------------------------------------------
# A run, the same with finer tolerances -> how many digits of it hold, and since when none does.
#
# The errors of a run go with its tolerances: against one of a hundredth of them its own error is what differs. Where
# neighbouring motions part exponentially (chaos) digits are lost at a steady pace, until none is left.


FINER = 100.0  # times
FEWEST, DECADES = 6, 3.0  # instants that show a pace; powers of ten by which errors grow where motions part
LOST = 0.1  # of the largest value of a coordinate or speed: a digit that does not hold


@dataclass(frozen=True)
class Accuracy:
    """Accuracy of the states of a run.

    Args:
        error: of the last state, of each column against its largest value in the run; the largest. Infinite where one
            of the two runs has left the numbers.
        until: the first instant at which no digit holds any more [s]; None where some hold to the end.
        parts: True if digits were lost at a steady pace until then: neighbouring motions part exponentially.
    """

    error: float
    until: float | None
    parts: bool = False

    @staticmethod
    def of(run: Trajectory, other: Trajectory, share: float) -> Accuracy | None:
        """Accuracy of a run by another of the same motion; None where they have no instant in common.

        Args:
            other: at the same instants.
            share: of the difference that is this run's error: 1 where the other is finer.
        """
        common, mine, its = np.intersect1d(run.t, other.t, return_indices=True)
        if run.moving != other.moving or not len(common):
            return None
        ended = common[-1] < run.t[-1]  # the other came to another end
        if ended and abs(run.t[-1] - other.t[-1]) <= tolerances.SAME_PLACE * (
            run.t[-1] - run.t[0]
        ):  # both at the same event
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

    @property
    def digits(self) -> int:
        """Number of correct digits at the end."""
        return max(0, math.floor(-math.log10(max(self.error, tolerances.BEST)))) if self.until is None else 0

    def as_dict(self) -> dict[str, float | None]:
        return {"digits": self.digits, "error": self.error if math.isfinite(self.error) else None, "until": self.until}

    def __str__(self) -> str:
        if self.until is not None:
            why = "neighbouring motions part" if self.parts else "a finer run goes another way from there"
            return f"No digit of the states holds from t = {self.until:.4g} s on: {why}."
        return f"Digits that hold at the end: {self.digits}."


def finer(tolerance: float) -> float:
    """The tolerance of the run that one is held against; a coarser one where there is no finer."""
    return tolerance / FINER if tolerance / FINER >= tolerances.LEAST_RTOL else tolerance * FINER


def _part_steadily(errors: np.ndarray) -> bool:
    """True if errors grow exponentially: digits are lost one after the other, not most of them at one instant."""
    digits = np.log10(np.maximum.accumulate(errors[errors > 0]))
    if len(digits) < FEWEST:
        return False
    lost = digits[-1] - digits[0]
    return bool(lost >= DECADES and np.max(np.diff(digits)) <= lost / 2)
