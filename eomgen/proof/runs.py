"""A run in time -> checks of all of it: equations, steps, columns, contacts, and its outputs against its samples."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from dataclasses import replace
from functools import partial

import numpy as np

from eomgen.frozen import dataclass
from eomgen.mechanics.dynamics import EquationsOfMotion
from eomgen.mechanics.instant import Quantities
from eomgen.model import Output, OutputSource
from eomgen.proof.certificate import certify
from eomgen.proof.check import Certificate, Check, Tally, differing, unchecked
from eomgen.proof.contact_phases import bodies_stand_as_reported, changes_follow_impulses, contacts_do_as_assumed
from eomgen.proof.motion import Leg, Promise, code_and_steps, energy_and_constraints
from eomgen.proof.reported_run import output_columns_hold, reaction_columns_hold, rows_left_out
from eomgen.resources import doing
from eomgen.simulation import Phase, PhaseModels, Stepping, Trajectory, WholeRun, formulas_of
from eomgen.symbolic.expression import Call, Expression
from eomgen.symbolic.numeric import NoValue, tolerances


@dataclass(frozen=True)
class RunProof:
    """Proof of a run: a trajectory -> its certificate.

    Args:
        equations: as they were derived.
        how: the tolerances of the run.
        models: its phases.
        whole: the whole run, for outputs such as extremes and means.
    """

    equations: EquationsOfMotion
    how: Stepping
    models: PhaseModels
    whole: WholeRun

    @doing("the proof of the run")
    def __call__(self, found: Trajectory) -> Certificate:
        """The proof of the equations, then that of the run."""
        return certify(self.equations) + run_checks(found, self.models, self.how, self.whole)

    def watch(self, found: Trajectory) -> tuple[Check, ...]:
        """Checks of energy against power, of constraints and of norms, which a run makes in any case."""
        return watched_checks(found, self.how)


def answered_otherwise(found: Trajectory, output: Output, reported: float | None) -> str:
    """Difference in words between a reported value of an output and the samples of the run; "" without one.

    It is that of `SamplesOfRun.answered_otherwise`.

    Raises:
        NoValue: the states of the run are not known.
    """
    if not isinstance(found.proof, RunProof):
        raise NoValue("the states of the run are not known")
    return SamplesOfRun(found.proof.whole).answered_otherwise(output, reported)


def run_checks(
    found: Trajectory,
    models: PhaseModels,
    how: Stepping,
    whole: WholeRun | None = None,
) -> tuple[Check, ...]:
    """Checks of a run; an unmade one where a Python function sets an input.

    Args:
        models: its phases.
        how: the tolerances of the run.
        whole: the outputs of the whole run, and the instants at which it must have a row; None: those that it has.
    """
    if _is_fed(found):
        what = "a Python function sets an input: its values between the states are not known"
        return (unchecked("the run follows its equations", what, "the run's right-hand side"),)
    return (
        *code_and_steps(_legs(found, how), _promise(found, how)),
        *(watched_checks(found, how) if found.watch is None else found.watched),
        *(() if whole is None else (*SamplesOfRun(whole).checks(), *rows_left_out(found, whole.plan.instants))),
        *reaction_columns_hold(found),
        *output_columns_hold(found, formulas_of(models.model)),
        *_contacts(found, models),
    )


def watched_checks(found: Trajectory, how: Stepping) -> tuple[Check, ...]:
    """Checks of energy against power, of constraints and of norms, which a run makes in any case."""
    return () if _is_fed(found) else energy_and_constraints(_legs(found, how), _promise(found, how))


def _is_fed(found: Trajectory) -> bool:
    """True if a Python function sets an input."""
    return any(phase.model.fed is not None for phase in found.phases)


def _promise(found: Trajectory, how: Stepping) -> Promise:
    """Accuracy that the tolerances of a run promise."""
    projected = how.stabilization in ("projection", "energy") and how.every is None
    levelled = projected and how.stabilization == "energy"
    return Promise(how.rtol, how.atol, found.steps, projected, levelled)


def _legs(found: Trajectory, how: Stepping) -> Sequence[Leg]:
    """Leg of the states of each phase, without those after the instant at which the run was cut."""
    return [leg for phase in found.phases for leg in _leg(phase, found, how)]


def _leg(phase: Phase, found: Trajectory, how: Stepping) -> Iterator[Leg]:
    track, phased = _until(phase, found.t).track, phase.model
    if track is not None:
        t, x = track
        pulled = how.stabilization == "baumgarte"
        rhs, inner = phased.functions.rhs, phased.functions.inner(x)
        yield Leg(phased.equations, phased.p, rhs, t, inner, found.carried, pulled, phased.known)


def _until(phase: Phase, t: np.ndarray) -> Phase:
    """A phase without the states after the run was cut."""
    if phase.track is None or not len(t):
        return replace(phase, tracked=None)
    times, states = phase.track
    here = times <= max(t[-1], phase.start)
    return replace(phase, tracked=lambda: (times[here], states[here]))


def _contacts(found: Trajectory, models: PhaseModels) -> Iterator[Check]:
    """Checks of contacts in the phases of a run, and between them."""
    seen = [cut for phase in found.phases if (cut := _until(phase, found.t)).track is not None]
    yield from contacts_do_as_assumed(seen)
    if len(seen) > 1:
        yield from bodies_stand_as_reported(seen, models.without_contacts.system)
        impacts = {impact.t: impact for impact in found.impacts}
        yield from changes_follow_impulses(seen, models.without_contacts.system, models.ends, impacts)


# -- outputs of the whole run, by its samples ----------------------------------------------------------


@dataclass(frozen=True)
class SamplesOfRun:
    """The samples of a run as a witness of its outputs."""

    run: WholeRun

    def checks(self) -> Iterator[Check]:
        """Checks of extremes, means, mean squares and values at events against the samples of the run alone."""
        tally = Tally("outputs of the whole run agree with its samples", "samples as they were integrated")
        for name, output in self.run.model.outputs.items():
            if output.condition is not None and output.event is not None:
                tally.add(name, partial(self._events_against_samples, output))
            for call in self.run.functions_in(output) if WholeRun.answers(output) else ():
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
        if (
            output.of_every_event
            or output.from_ is not None
            or Quantities.requested_by(output.value, OutputSource.SMALL_MOTIONS)
        ):
            return ""
        if output.condition is None:
            return self._by_samples(output, reported) if output.at is None else ""
        n, met = int(output.event or 1), self._met_by_samples(output.condition.left - output.condition.right)
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
        if Quantities.requested_by(output.value, OutputSource.OF_A_RUN):
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
        values = (y for call in calls for _, y in self.run.curves(call))
        size = max(abs(found), self.run.duration, *(float(np.max(np.abs(y), initial=0.0)) for y in values))
        return "" if abs(reported - found) <= tolerances.CARRIED * size else f"{reported:.10g} for {found:.10g}"

    def _met_by_samples(self, difference: Expression) -> list[tuple[float, float]]:
        """Intervals between samples [s] in which the difference of the sides of a condition changes its sign."""
        curves = self.run.sampled(difference)
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
        reported, when = self.run.called(call)
        curves = self.run.curves(call)
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
        assert output.condition is not None
        found = self.run.of(output)
        sides = self.run.sampled(output.condition.left - output.condition.right)
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
