"""Phases of a run -> outputs of the whole run: extremes and their times, means, periods, values at events.

A formula is approximated by Chebyshev polynomials between the integrator's steps, so that an extreme, a zero and an
integral are those of the motion and not of its samples.
"""

from __future__ import annotations

import math
import re
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import replace
from functools import cached_property, partial
from typing import Any

import numpy as np

from eomgen.errors import DerivationError, ExpressionError, ModelError, RunFailed, UsageError
from eomgen.frozen import dataclass
from eomgen.mechanics.instant import requests_of
from eomgen.model import (
    EVERY,
    AtRest,
    Model,
    Output,
    OutputSource,
    Table,
    Taken,
    WrittenEquation,
    equation_in,
    equation_typed,
    formula_at,
    parse_typed_equation,
)
from eomgen.proof import Check, Tally, differing
from eomgen.simulation import DenseMotion, OutputColumns, PhaseRun, Plan
from eomgen.symbolic.expression import Call, Expression, parse
from eomgen.symbolic.numeric import ChebyshevPieces, resolved_curve, tolerances


@dataclass(frozen=True)
class RunValue:
    """Value of one output of a run.

    Args:
        value: in SI; None without a value; with `event = "every"` one value an event.
        t: instants of the value or values [s]; () for a value of no instant, such as a mean.
        message: reason why there is no value, or "".
    """

    value: float | tuple[float, ...] | None
    t: tuple[float, ...] = ()
    message: str = ""


@dataclass(frozen=True)
class WholeRun:
    """Outputs of a whole motion.

    Args:
        model: the model with the outputs.
        runs: the phases of the motion.
        plan: the plan by which they were run.
        parameters: values that replace the model's.
        ends: the instant up to which each phase was planned; None: the plan's for all.
    """

    model: Model
    runs: Sequence[PhaseRun]
    plan: Plan
    parameters: Mapping[str, float]
    ends: Sequence[float] | None = None

    def value(self, requested: str | Output) -> RunValue:
        """Value of an output, or of a text: "max(reaction_x(A))", "theta' at theta = 0", "x at y = 0, event 2".

        Raises:
            UsageError: the text cannot be read, or a name in it is unknown.
        """
        return self.of(requested_of(self.model, requested) if isinstance(requested, str) else requested)

    def of(self, output: Output) -> RunValue:
        """Value of one output; an error becomes its message."""
        try:
            if output.at is not None:
                return self._at_events(output)
            if requests_of(output.value, OutputSource.OF_A_RUN):
                return self._of_whole(output.value)
            start = float(self.runs[0].here.t)
            return _valued(self._number(output.value, self.runs[0], start), (start,))
        except (DerivationError, ExpressionError, RunFailed) as error:
            return RunValue(None, (), f"{error.what}; {error.fix}" if error.fix else error.what)

    def outputs(self) -> dict[str, RunValue]:
        """Values of the model's outputs that are functions of a whole run, or belong to its events."""
        requested = {name: output for name, output in self.model.outputs.items() if is_of_a_run(output)}
        return {name: self.of(output) for name, output in requested.items()}

    def checks(self) -> Iterator[Check]:
        """Checks of extremes, means, mean squares and values at events against the samples of the run alone."""
        tally = Tally("outputs of the whole run agree with its samples", "samples as they were integrated")
        for name, output in self.model.outputs.items():
            if isinstance(output.at, WrittenEquation) and output.event is not None:
                tally.add(name, partial(self._events_against_samples, output))
            for call in output.value.calls if is_of_a_run(output) else ():
                if call.name in _FUNCTIONS:
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
        found = self.of(output)
        if not found.t:
            return f"{reported:.10g} for no event"
        before = sum(end < found.t[0] * (1 - tolerances.SAME_PLACE) for _, end in met)
        if before >= n:
            return f"{reported:.10g} at t = {found.t[0]:.6g} s, and it is met {before} times before"
        return self._events_against_samples(output, reported)

    def _by_samples(self, output: Output, reported: float | None) -> str:
        """Difference from the samples, of each function of the run, or of a formula at the start; ""."""
        if requests_of(output.value, OutputSource.OF_A_RUN):
            calls = [call for call in output.value.calls if call.name in _FUNCTIONS]
            wrong = (self._against_samples(call) for call in calls)
            return next(filter(None, wrong), "") or self._otherwise_reported(output, calls, reported)
        start = float(self._sampled(output.value)[0][1][0])
        if reported is None:
            return f"no value for {start:.10g}" if math.isfinite(start) else ""
        return differing(reported, start, tolerances.CARRIED)

    def _otherwise_reported(self, output: Output, calls: Sequence[Call], reported: float | None) -> str:
        """Difference between a reported value and the formula of the functions of the run; ""."""
        found = self.of(output).value
        if not isinstance(found, float) or reported is None:
            return "" if found is reported or isinstance(found, tuple) else f"{reported} for {found}"
        values = (y for call in calls for _, y in self._sampled(formula_at(call, 0)))
        size = max(abs(found), self._duration, *(float(np.max(np.abs(y), initial=0.0)) for y in values))
        return "" if abs(reported - found) <= tolerances.CARRIED * size else f"{reported:.10g} for {found:.10g}"

    def _met_by_samples(self, condition: WrittenEquation) -> list[tuple[float, float]]:
        """Intervals between samples [s] in which the difference of the sides of a condition changes its sign."""
        curves = self._sampled(condition.left - condition.right)
        sure = tolerances.CARRIED * max(float(np.max(np.abs(y), initial=0.0)) for _, y in curves)
        found: list[tuple[float, float]] = []
        for t, y in curves:
            known = np.flatnonzero(np.abs(y) > sure)
            turns = np.flatnonzero(y[known[:-1]] * y[known[1:]] < 0)
            found += [(float(t[known[k]]), float(t[known[k + 1]])) for k in turns]
        return found

    def _value_near(self, formula: Expression, when: float) -> float:
        """Value of a formula at the sample nearest to an instant."""
        t, y = (np.concatenate(each) for each in zip(*self._sampled(formula), strict=True))
        return float(y[np.argmin(np.abs(t - when))])

    def _against_samples(self, call: Call) -> str:
        """Difference between the value of a function of the run and the samples, in words; "" without one.

        No sample is beyond an extreme, and the curve has that value at its instant. A mean is near that of the
        trapezium rule, the last value is that of the last sample, and a period is the mean time between upward
        passages of the samples through the mean.
        """
        formula = formula_at(call, 0)
        reported, when = self._called(call)
        curves = self._sampled(formula)
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

    def _sampled(self, formula: Expression) -> list[_Curve]:
        """(t, values of the formula) of each phase, at its requested states and at the integrator's steps."""
        states = [(run, *run.measured) for run in self.runs]
        return [(t, self._columns(formula, run).along(t, x)["asked"]) for run, t, x in states]

    def _mean_against_samples(self, reported: float, curves: Sequence[_Curve], power: int) -> str:
        pairs = [(t, y**power) for t, y in curves]
        size, count = max(float(np.max(np.abs(y))) for _, y in pairs), sum(len(y) for _, y in pairs)
        fine, coarse = (sum(float(np.trapezoid(y[::k], t[::k])) for t, y in pairs) / self._duration for k in (1, 2))
        unsure = 4 * abs(fine - coarse) + tolerances.CARRIED * size + size * len(pairs) / count
        return (
            f"{reported:.10g}, squared {reported**2:.10g}, for {fine:.10g}"
            if abs(reported**power - fine) > unsure
            else ""
        )

    def _period_against_samples(self, reported: float, curves: Sequence[_Curve]) -> str:
        """Difference between a period and the samples' passages through the mean; instants are known to a step."""
        level = sum(float(np.trapezoid(y, t)) for t, y in curves) / self._duration
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
        found = self.of(output)
        sides = self._sampled(output.at.left - output.at.right)
        curves = self._sampled(output.value)
        largest = [max(float(np.max(np.abs(y))) for _, y in each) for each in (sides, curves)]
        values = found.value if isinstance(found.value, tuple) else (found.value if reported is None else reported,)
        for value, t in zip(values, found.t, strict=False):
            wrong = _not_at(sides, t, 0.0, largest[0])
            if value is not None and not wrong:
                wrong = _not_at(curves, t, value, largest[1])
            if wrong:
                return wrong
        return ""

    # -- functions of the whole run -----------------------------------------------------------------

    def _of_whole(self, formula: Expression) -> RunValue:
        """Value of a formula of functions of the run, and of parameters."""
        when: list[float] = []

        def value(call: Call) -> float:
            found, t = self._called(call)
            when.extend(t)
            return found

        names = {**self.model.numeric_parameters(self.parameters), "pi": math.pi}
        strangers = sorted(name for name in formula.names - names.keys() if not self._stands_inside(formula, name))
        if strangers:
            what = f"'{strangers[0]}' is a function of a state, next to functions of a whole run"
            raise DerivationError(what, fix=f"make it a function of the run too: last({strangers[0]})")
        found = formula.evaluate({name: float(x) for name, x in names.items()}, value)
        return _valued(float(found), tuple(when) if len(when) == 1 else ())

    def _stands_inside(self, formula: Expression, name: str) -> bool:
        return all(what != name for kind, what in formula.code if kind == "name")

    def _called(self, call: Call) -> tuple[float, tuple[float, ...]]:
        """Value of a function of the run, and the instant of this value."""
        if not requests_of(Expression(str(call), (("call", call),), (0,)), OutputSource.OF_A_RUN):
            what = f"'{call}' is a function of a state, next to functions of a whole run"
            raise DerivationError(what, fix=f"last({call})")
        formula = formula_at(call, 0)
        if requests_of(formula, OutputSource.OF_A_RUN):
            raise DerivationError(
                f"'{call}': a function of a whole run has no value along it", fix="request one after the other"
            )
        return _FUNCTIONS[call.name](self, formula)

    def last(self, formula: Expression) -> tuple[float, tuple[float, ...]]:
        """Value at the end of the run, and that instant."""
        run = self.runs[-1]
        return self._number(formula, run, run.run.end), (float(run.run.end),)

    def extreme(self, formula: Expression, sign: int) -> tuple[float, tuple[float, ...]]:
        """Largest (sign = 1) or smallest (sign = -1) value of the formula, and its instant."""
        found = [pieces.extreme(sign) for pieces in self._pieces(formula)]
        value, t = max(found, key=lambda pair: sign * pair[0])
        return value, (t,)

    def when(self, formula: Expression, sign: int) -> tuple[float, tuple[float, ...]]:
        """Instant of the largest (sign = 1) or smallest (sign = -1) value."""
        _, t = self.extreme(formula, sign)
        return t[0], t

    def mean(self, formula: Expression) -> tuple[float, tuple[float, ...]]:
        """1/T times the integral over the run."""
        return sum(pieces.integral() for pieces in self._pieces(formula)) / self._duration, ()

    def rms(self, formula: Expression) -> tuple[float, tuple[float, ...]]:
        """The root of the mean square."""
        squares = (resolved_curve(_squared(pieces), _edges(pieces)) for pieces in self._pieces(formula))
        return math.sqrt(sum(square.integral() for square in squares) / self._duration), ()

    def period(self, formula: Expression) -> tuple[float, tuple[float, ...]]:
        """The mean time between upward passages through the mean.

        Raises:
            DerivationError: there are fewer than two passages, or the times between them differ.
        """
        level = self.mean(formula)[0]
        lifted = [resolved_curve(_less(pieces, level), _edges(pieces)) for pieces in self._pieces(formula)]
        t = [when for pieces in lifted for when, way in pieces.zeros() if way > 0]
        if len(t) < 2:
            raise DerivationError(
                f"'{formula.text}' passes its mean upward {len(t)} times: no period", fix="a longer run"
            )
        apart = np.diff(t)
        if np.max(apart) - np.min(apart) > tolerances.SAME_PERIOD * np.mean(apart):
            low, high = np.min(apart), np.max(apart)
            what = f"'{formula.text}' has no period: from {low:.6g} to {high:.6g} s between upward passages of its mean"
            raise DerivationError(what, fix="choose a quantity that repeats, or a run after it has settled")
        return float(np.mean(apart)), ()

    # -- at events -----------------------------------------------------------------------------------

    def _at_events(self, output: Output) -> RunValue:
        """The value at the n-th event, or at every one."""
        if not isinstance(output.at, WrittenEquation) or output.from_ is not None:
            raise DerivationError("it is no value of a run from the start", fix="`eomgen solve` answers it")
        if requests_of(output.value, OutputSource.OF_A_RUN) or requests_of(output.value, OutputSource.SMALL_MOTIONS):
            raise DerivationError(f"'{output.value.text}' belongs to no instant", fix="leave out `at`")
        events = self.events(output.at)
        if output.event == EVERY:
            found = [self._at(output, *event) for event in events]
            return RunValue(tuple(found), tuple(t for _, t in events))
        n = 1 if output.event is None else int(output.event)
        if len(events) < n:
            count = f"is met {len(events)} times" if events else "is not met"
            return RunValue(None, (), f"'{output.at.text}' {count} in the run")
        return _valued(self._at(output, *events[n - 1]), (events[n - 1][1],))

    def _at(self, output: Output, k: int, t: float) -> float:
        """The value at an instant of a phase, or just after its end."""
        run = self.runs[k]
        if output.side == "after" and t == run.run.end and k + 1 < len(self.runs):
            run = self.runs[k + 1]
        return self._number(output.value, run, t)

    def events(self, condition: WrittenEquation) -> list[tuple[int, float]]:
        """(phase, instant) of each event after the start: where both sides come to be equal, ascending."""
        difference = condition.left - condition.right
        found: list[tuple[int, float]] = []
        before = 0.0
        for k, pieces in self._phases(difference):
            run = self.runs[k]
            start, end = run.here.t, run.run.end
            first, last = (float(pieces.g(np.array([t]))[0]) for t in (start, end))
            size = max(abs(pieces.extreme(sign)[0]) for sign in (1, -1))
            floor = tolerances.COMPUTED * max(size, tolerances.SOLVED)
            if before * first < 0 and abs(first) > floor:
                found.append((k - 1, float(self.runs[k - 1].run.end)))
            near = tolerances.COMPUTED * max(1.0, end - start)
            found += [(k, t) for t, _ in pieces.zeros() if t - start > near and end - t > near]
            if abs(last) <= floor < size:
                found.append((k, end))
            before = last if abs(last) > floor else 0.0
        return found

    # -- formulas along the run ------------------------------------------------------------------------

    def _pieces(self, formula: Expression) -> list[ChebyshevPieces]:
        """Pieces of the formula in every phase that is longer than an instant."""
        return [pieces for _, pieces in self._phases(formula)]

    def _phases(self, formula: Expression) -> list[tuple[int, ChebyshevPieces]]:
        """Pieces of the formula, by the number of the phase, for every phase that is longer than an instant.

        Raises:
            DerivationError: the formula has no value at some instant.
        """
        found = [(k, resolved_curve(self._function(formula, k), dense.edges)) for k, dense in self._dense.items()]
        if not found:
            raise DerivationError("the run is one instant", fix="a longer run")
        if not all(np.isfinite(pieces.c).all() for _, pieces in found):
            raise DerivationError(
                f"'{formula.text}' has no value at some instants of the run",
                fix="choose a formula that has a value at every instant of it",
            )
        return found

    def _function(self, formula: Expression, k: int) -> Callable[[np.ndarray], np.ndarray]:
        """Function t -> value of the formula in a phase."""
        run, columns = self.runs[k], self._columns(formula, self.runs[k])
        return lambda t: columns.along(t, self._states(run, t))["asked"]

    def _number(self, formula: Expression, run: PhaseRun, t: float) -> float:
        """The formula at one instant of a phase; at its ends by the states that were integrated."""
        if t == run.run.end:
            x = run.run.last
        else:
            x = run.phase.state(run.here.values) if t == run.here.t else self._states(run, np.array([t]))[0]
        return float(self._columns(formula, run).along(np.array([t]), x[None, :])["asked"][0])

    def _columns(self, formula: Expression, run: PhaseRun) -> OutputColumns:
        """Column of one formula along a phase.

        Raises:
            DerivationError: the formula has no value there.
        """
        key = (formula, id(run.phase))
        if key not in self._made:
            columns = OutputColumns(run.phase, {"asked": formula})
            if columns.refused:
                raise DerivationError(
                    columns.refused["asked"], fix="choose a formula that has a value at every instant of the run"
                )
            self._made[key] = columns
        return self._made[key]

    def _states(self, run: PhaseRun, t: np.ndarray) -> np.ndarray:
        return self._dense[next(k for k, each in enumerate(self.runs) if each is run)].at(t)

    @cached_property
    def _dense(self) -> dict[int, DenseMotion]:
        ends = [self.plan.end] * len(self.runs) if self.ends is None else self.ends
        plans = [replace(self.plan, end=end) for end in ends]
        return {k: DenseMotion.of(run, plans[k]) for k, run in enumerate(self.runs) if run.run.end > run.here.t}

    @cached_property
    def _made(self) -> dict[tuple[Expression, int], OutputColumns]:
        return {}

    @property
    def _duration(self) -> float:
        return float(self.runs[-1].run.end - self.runs[0].here.t)


_FUNCTIONS: dict[str, Callable[[WholeRun, Expression], tuple[float, tuple[float, ...]]]] = {
    "max": lambda run, formula: run.extreme(formula, 1),
    "min": lambda run, formula: run.extreme(formula, -1),
    "time_of_max": lambda run, formula: run.when(formula, 1),
    "time_of_min": lambda run, formula: run.when(formula, -1),
    "mean": WholeRun.mean,
    "rms": WholeRun.rms,
    "last": WholeRun.last,
    "period": WholeRun.period,
}


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


def is_of_a_run(output: Output) -> bool:
    """True if an output is a function of a whole run: extremes, means, or values at the n-th event."""
    return output.event is not None or requests_of(output.value, OutputSource.OF_A_RUN)


def _valued(value: float, t: tuple[float, ...]) -> RunValue:
    return RunValue(value + 0.0, t) if math.isfinite(value) else RunValue(None, t, "it has no finite value")


def _edges(pieces: ChebyshevPieces) -> np.ndarray:
    return np.append(pieces.a, pieces.b[-1:])


def _squared(pieces: ChebyshevPieces) -> Callable[[np.ndarray], np.ndarray]:
    return lambda t: pieces.g(t) ** 2


def _less(pieces: ChebyshevPieces, level: float) -> Callable[[np.ndarray], np.ndarray]:
    return lambda t: pieces.g(t) - level


# -- requests as they are typed --------------------------------------------------------------------------------


def requested_typed(model: Model, text: str) -> tuple[str, tuple[Taken, ...]]:
    """Request whose plain numbers of the instant have the units of the model file, and these readings.

    Raises:
        UsageError: the instant cannot be read, or a unit does not fit.
    """
    formula, at, rest = text.partition(" at ")
    condition, comma, event = rest.partition(", event")
    if text in model.outputs or not at or condition.strip() == AtRest.text:
        return text, ()
    try:
        sides = parse_typed_equation(condition)
        _, taken = equation_typed(model, condition, declared=True)
    except ExpressionError as error:
        raise UsageError(f"'{text}': {error.what}", fix=error.fix) from error
    units = {each.typed: each.unit for each in taken}
    written = (f"{side.text} {units.get(side.text, '') if unit is None else unit.text}".strip() for side, unit in sides)
    return f"{formula} at {' = '.join(written)}{comma}{event}", taken


def requested_of(model: Model, text: str) -> Output:
    """Output requested by a text: an output's name, a formula, or "FORMULA at EQUATION" with ", event 2" or "every".

    In a formula the name of an output without an instant stands for its formula.

    Raises:
        UsageError: the text cannot be read, or a name in it is unknown.
    """
    if text in model.outputs:
        return model.outputs[text]
    formula, at, condition = text.partition(" at ")
    condition, comma, event = condition.partition(", event")
    try:
        output = Output(value=parse(_in_full(model, formula.strip()), references=True))
        if at:
            when: Any = AtRest() if condition.strip() == AtRest.text else equation_in(model, condition.strip())
            output = replace(output, at=when)
        if comma:
            output = replace(output, event=EVERY if event.strip() == EVERY else int(event))
        replace(model, outputs=Table({"asked": output}))
    except ValueError as error:
        raise UsageError(f"'{text}': '{event.strip()}' is no number of an event", fix=f"2, or {EVERY}") from error
    except ExpressionError as error:
        raise UsageError(f"'{text}': {error.what}", fix=error.fix) from error
    except ModelError as error:
        raise UsageError(f"'{text}': {error.problems[0].what}", fix=error.problems[0].fix) from error
    return output


def _in_full(model: Model, formula: str) -> str:
    """Formula in which names of outputs without an instant are replaced by their formulas."""
    tables = [*model.trusses.values(), model]
    others = {
        name
        for part in tables
        for what, x in vars(part).items()
        if isinstance(x, Table) and what != "outputs"
        for name in x
    }
    plain = {name: f"({output.value})" for name, output in model.outputs.items() if output.at is None}
    names = "|".join(map(re.escape, plain.keys() - others))
    return re.sub(rf"(?<![\w.])({names})(?![\w.'(])", lambda found: plain[found[0]], formula) if names else formula
