"""WholeRun -> checks: what is said of a whole run, held against the samples of its motion alone."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from functools import partial

import numpy as np

from eomgen.frozen import dataclass
from eomgen.mechanics.instant import requests_of
from eomgen.model import EVERY, Output, OutputSource, WrittenEquation, formula_at
from eomgen.proof.check import Check, Tally, differing
from eomgen.simulation import WholeRun, is_of_a_run
from eomgen.symbolic.expression import Call, Expression
from eomgen.symbolic.numeric import tolerances


@dataclass(frozen=True)
class SamplesOfRun:
    """The samples of a run as a witness of its outputs."""

    run: WholeRun

    def checks(self) -> Iterator[Check]:
        """Checks of extremes, means, mean squares and values at events against the samples of the run alone."""
        tally = Tally("outputs of the whole run agree with its samples", "samples as they were integrated")
        for name, output in self.run.model.outputs.items():
            if isinstance(output.at, WrittenEquation) and output.event is not None:
                tally.add(name, partial(self._events_against_samples, output))
            for call in self.run.functions_in(output) if is_of_a_run(output) else ():
                tally.add(str(call), partial(self._against_samples, call))
        yield from tally.checks()

    def answered_otherwise(self, output: Output, reported: float | None) -> str:
        """Difference in words between a reported value of an output and the samples of the run; "" without one.

        For an output at an event, both sides of its condition must be equal there among the samples, the event must
        not be one that the samples show to come later in the order of events, and the value must be that of the
        samples there. No value must be reported only where the event does not occur, or the formula has no value.

        Args:
            reported: the value in SI; None: no value is reported.
        """
        if output.event == EVERY or output.from_ is not None or requests_of(output.value, OutputSource.SMALL_MOTIONS):
            return ""
        if not isinstance(output.at, WrittenEquation):
            return self._by_samples(output, reported) if output.at is None else ""
        n, met = int(output.event or 1), self._met_by_samples(output.at)
        if reported is None:
            if len(met) < n:
                return ""
            when = sum(met[n - 1]) / 2
            value = self._value_near(output.value, when)
            return f"no value, and it is met near t = {when:.6g} s" if math.isfinite(value) else ""
        found = self.run.of(output)
        if not found.t:
            return f"{reported:.10g} for no event"
        before = sum(end < found.t[0] * (1 - tolerances.SAME_PLACE) for _, end in met)
        if before >= n:
            return f"{reported:.10g} at t = {found.t[0]:.6g} s, and it is met {before} times before"
        return self._events_against_samples(output, reported)

    def _by_samples(self, output: Output, reported: float | None) -> str:
        """Difference from the samples, of each function of the run, or of a formula at the start; ""."""
        if requests_of(output.value, OutputSource.OF_A_RUN):
            calls = self.run.functions_in(output)
            wrong = (self._against_samples(call) for call in calls)
            return next(filter(None, wrong), "") or self._otherwise_reported(output, calls, reported)
        start = float(self.run.sampled(output.value)[0][1][0])
        if reported is None:
            return f"no value for {start:.10g}" if math.isfinite(start) else ""
        return differing(reported, start, tolerances.CARRIED)

    def _otherwise_reported(self, output: Output, calls: Sequence[Call], reported: float | None) -> str:
        """Difference between a reported value and the formula of the functions of the run; ""."""
        found = self.run.of(output).value
        if not isinstance(found, float) or reported is None:
            return "" if found is reported or isinstance(found, tuple) else f"{reported} for {found}"
        values = (y for call in calls for _, y in self.run.sampled(formula_at(call, 0)))
        size = max(abs(found), self.run.duration, *(float(np.max(np.abs(y), initial=0.0)) for y in values))
        return "" if abs(reported - found) <= tolerances.CARRIED * size else f"{reported:.10g} for {found:.10g}"

    def _met_by_samples(self, condition: WrittenEquation) -> list[tuple[float, float]]:
        """Intervals between samples [s] in which the difference of the sides of a condition changes its sign."""
        curves = self.run.sampled(condition.left - condition.right)
        sure = tolerances.CARRIED * max(float(np.max(np.abs(y), initial=0.0)) for _, y in curves)
        found: list[tuple[float, float]] = []
        for t, y in curves:
            known = np.flatnonzero(np.abs(y) > sure)
            turns = np.flatnonzero(y[known[:-1]] * y[known[1:]] < 0)
            found += [(float(t[known[k]]), float(t[known[k + 1]])) for k in turns]
        return found

    def _value_near(self, formula: Expression, when: float) -> float:
        """Value of a formula at the sample nearest to an instant."""
        t, y = (np.concatenate(each) for each in zip(*self.run.sampled(formula), strict=True))
        return float(y[np.argmin(np.abs(t - when))])

    def _against_samples(self, call: Call) -> str:
        """Difference between the value of a function of the run and the samples, in words; "" without one.

        No sample is beyond an extreme, and the curve has that value at its instant. A mean is near that of the
        trapezium rule, the last value is that of the last sample, and a period is the mean time between upward
        passages of the samples through the mean.
        """
        formula = formula_at(call, 0)
        reported, when = self.run.called(call)
        curves = self.run.sampled(formula)
        values = np.concatenate([y for _, y in curves])
        size = float(np.max(np.abs(values)))
        if call.name == "period":
            return self._period_against_samples(reported, curves)
        if call.name in ("mean", "rms"):
            return self._mean_against_samples(reported, curves, 2 if call.name == "rms" else 1)
        if call.name == "last":
            return _not_at(curves, when[0], reported, size)
        sign = 1 if call.name.endswith("max") else -1
        extreme = float(np.max(sign * values))
        if call.name.startswith("time"):
            return _not_at(curves, reported, sign * extreme, size)
        beyond = extreme - sign * reported
        rise = max(float(np.max(np.abs(np.diff(y)), initial=0.0)) for _, y in curves)
        if beyond > tolerances.CARRIED * size or -beyond > rise + tolerances.CARRIED * size:
            return f"{reported:.10g} for the sample {sign * extreme:.10g}"
        return _not_at(curves, when[0], reported, size)

    def _mean_against_samples(self, reported: float, curves: Sequence[_Curve], power: int) -> str:
        pairs = [(t, y**power) for t, y in curves]
        size, count = max(float(np.max(np.abs(y))) for _, y in pairs), sum(len(y) for _, y in pairs)
        fine, coarse = (sum(float(np.trapezoid(y[::k], t[::k])) for t, y in pairs) / self.run.duration for k in (1, 2))
        unsure = 4 * abs(fine - coarse) + tolerances.CARRIED * size + size * len(pairs) / count
        return (
            f"{reported:.10g}, squared {reported**2:.10g}, for {fine:.10g}"
            if abs(reported**power - fine) > unsure
            else ""
        )

    def _period_against_samples(self, reported: float, curves: Sequence[_Curve]) -> str:
        """Difference between a period and the samples' passages through the mean; instants are known to a step."""
        level = sum(float(np.trapezoid(y, t)) for t, y in curves) / self.run.duration
        steps = [(t[k], t[k + 1]) for t, y in curves for k in np.flatnonzero((y[:-1] < level) & (y[1:] >= level))]
        if len(steps) < 2:
            return ""
        (first, after), (last, end) = steps[0], steps[-1]
        low, high = ((x - y) / reported for x, y in ((last, after), (end, first)))
        return "" if low - 1 < len(steps) < high + 2 else f"{reported:.10g} for {len(steps)} passages of the samples"

    def _events_against_samples(self, output: Output, reported: float | None = None) -> str:
        """Difference in words between an output at events and the samples there; "" without one.

        Both sides of the condition must be equal there among the samples, and the value must be that of the samples.

        Args:
            reported: value that is checked; None: that of the output itself.
        """
        assert isinstance(output.at, WrittenEquation)
        found = self.run.of(output)
        sides = self.run.sampled(output.at.left - output.at.right)
        curves = self.run.sampled(output.value)
        largest = [max(float(np.max(np.abs(y))) for _, y in each) for each in (sides, curves)]
        values = found.value if isinstance(found.value, tuple) else (found.value if reported is None else reported,)
        for value, t in zip(values, found.t, strict=False):
            wrong = _not_at(sides, t, 0.0, largest[0])
            if value is not None and not wrong:
                wrong = _not_at(curves, t, value, largest[1])
            if wrong:
                return wrong
        return ""


_Curve = tuple[np.ndarray, np.ndarray]
NEAREST = 2  # samples on either side of an instant, which bound the value of a curve between them


def _not_at(curves: Sequence[_Curve], when: float, value: float, size: float) -> str:
    """Message if a curve cannot have this value at an instant, judged by its samples; ""."""
    for t, y in curves:
        k = int(np.searchsorted(t, when))
        near = y[max(0, k - NEAREST) : k + NEAREST]
        if len(near) and t[0] <= when <= t[-1]:
            slack = float(np.max(near) - np.min(near)) + tolerances.CARRIED * size
            if not (np.isfinite(slack) and not np.min(near) - slack <= value <= np.max(near) + slack):
                return ""
    return f"at t = {when:.10g} s it is not {value:.10g}"
