"""Phases of a run -> WholeRun: its outputs as a whole, extremes and their times, means, periods, values at events.

A formula is approximated by Chebyshev polynomials between the integrator's steps, so that an extreme, a zero and an
integral are those of the motion and not of its samples.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace
from functools import cached_property

import numpy as np

from eomgen.errors import DerivationError, ExpressionError, RunFailed
from eomgen.frozen import dataclass
from eomgen.mechanics.instant import Quantities
from eomgen.model import Model, Output, OutputSource, Requests, WrittenEquation, formula_at
from eomgen.simulation.columns import OutputColumns
from eomgen.simulation.event_location import ChebyshevPieces, resolved_curve
from eomgen.simulation.motion import DenseMotion, Plan
from eomgen.simulation.phase_run import PhaseRun
from eomgen.symbolic.expression import Call, Expression
from eomgen.symbolic.numeric import tolerances


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
        return self.of(Requests(self.model).output(requested) if isinstance(requested, str) else requested)

    def of(self, output: Output) -> RunValue:
        """Value of one output; an error becomes its message."""
        try:
            if output.at is not None:
                return self._at_events(output)
            if Quantities.requested_by(output.value, OutputSource.OF_A_RUN):
                return self._of_whole(output.value)
            start = float(self.runs[0].here.t)
            return _valued(self._number(output.value, self.runs[0], start), (start,))
        except (DerivationError, ExpressionError, RunFailed) as error:
            return RunValue(None, (), f"{error.what}; {error.fix}" if error.fix else error.what)

    def outputs(self) -> dict[str, RunValue]:
        """Values of the model's outputs that are functions of a whole run, or belong to its events."""
        requested = {name: output for name, output in self.model.outputs.items() if WholeRun.answers(output)}
        return {name: self.of(output) for name, output in requested.items()}

    def sampled(self, formula: Expression) -> list[tuple[np.ndarray, np.ndarray]]:
        """(t, values of the formula) of each phase, at its requested states and at the integrator's steps."""
        states = [(run, *run.measured) for run in self.runs]
        return [(t, self._columns(formula, run).along(t, x)["asked"]) for run, t, x in states]

    def curves(self, call: Call) -> list[tuple[np.ndarray, np.ndarray]]:
        """The same of the formula in a function of the run."""
        return self.sampled(formula_at(call, 0))

    def functions_in(self, output: Output) -> list[Call]:
        """The functions of the whole run in an output."""
        return [call for call in output.value.calls if call.name in _FUNCTIONS]

    # -- functions of the whole run -----------------------------------------------------------------

    def _of_whole(self, formula: Expression) -> RunValue:
        """Value of a formula of functions of the run, and of parameters."""
        when: list[float] = []

        def value(call: Call) -> float:
            found, t = self.called(call)
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

    def called(self, call: Call) -> tuple[float, tuple[float, ...]]:
        """Value of a function of the run, and the instant of this value."""
        if not Quantities.requested_by(Expression(str(call), (("call", call),), (0,)), OutputSource.OF_A_RUN):
            what = f"'{call}' is a function of a state, next to functions of a whole run"
            raise DerivationError(what, fix=f"last({call})")
        formula = formula_at(call, 0)
        if Quantities.requested_by(formula, OutputSource.OF_A_RUN):
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
        return sum(pieces.integral() for pieces in self._pieces(formula)) / self.duration, ()

    def rms(self, formula: Expression) -> tuple[float, tuple[float, ...]]:
        """The root of the mean square."""
        squares = (resolved_curve(_squared(pieces), _edges(pieces)) for pieces in self._pieces(formula))
        return math.sqrt(sum(square.integral() for square in squares) / self.duration), ()

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
        condition = output.condition
        if condition is None or output.from_ is not None:
            raise DerivationError("it is no value of a run from the start", fix="`eomgen solve` answers it")
        if Quantities.requested_by(output.value, OutputSource.OF_A_RUN) or Quantities.requested_by(
            output.value, OutputSource.SMALL_MOTIONS
        ):
            raise DerivationError(f"'{output.value.text}' belongs to no instant", fix="leave out `at`")
        events = self.events(condition)
        if output.of_every_event:
            found = [self._at(output, *event) for event in events]
            return RunValue(tuple(found), tuple(t for _, t in events))
        n = 1 if output.event is None else int(output.event)
        if len(events) < n:
            count = f"is met {len(events)} times" if events else "is not met"
            return RunValue(None, (), f"'{condition.text}' {count} in the run")
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
    def duration(self) -> float:
        """Time from the start to the end [s]."""
        return float(self.runs[-1].run.end - self.runs[0].here.t)

    @staticmethod
    def answers(output: Output) -> bool:
        """True if an output is a function of a whole run: extremes, means, or values at the n-th event."""
        return output.event is not None or Quantities.requested_by(output.value, OutputSource.OF_A_RUN)


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


def _valued(value: float, t: tuple[float, ...]) -> RunValue:
    return RunValue(value + 0.0, t) if math.isfinite(value) else RunValue(None, t, "it has no finite value")


def _edges(pieces: ChebyshevPieces) -> np.ndarray:
    return np.append(pieces.a, pieces.b[-1:])


def _squared(pieces: ChebyshevPieces) -> Callable[[np.ndarray], np.ndarray]:
    return lambda t: pieces.g(t) ** 2


def _less(pieces: ChebyshevPieces, level: float) -> Callable[[np.ndarray], np.ndarray]:
    return lambda t: pieces.g(t) - level
