"""Model, condition -> StateAtInstant: the state at which a motion first meets a condition, exact where possible.

A motion may pass through several phases: contacts end, slide, stick, a path goes over from one piece to the next. Each
phase is followed in numbers; the instants between are then sought in closed form, which is used where both agree.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping, Sequence
from contextlib import suppress
from dataclasses import replace
from functools import cached_property
from random import Random
from typing import TYPE_CHECKING, Any

import numpy as np

from eomgen.codegen import Program, RightHandSide
from eomgen.errors import DerivationError, EomgenError, MissingValues, RunFailed
from eomgen.frozen import dataclass
from eomgen.mechanics.constraints import holds_identically
from eomgen.mechanics.dynamics import Extent
from eomgen.mechanics.kinematics import Located
from eomgen.mechanics.start import ExactStart, Start
from eomgen.model import Model, WrittenEquation
from eomgen.simulation import FirstTime, PhaseRun, Stepping, Trajectory, integrate_one_phase
from eomgen.study.study import Study, study_at_rest, study_of
from eomgen.symbolic.expression import Node, Scalar, depends_on, substituted
from eomgen.symbolic.numeric import FLOAT, evaluate, number_of, tolerances

if TYPE_CHECKING:
    from eomgen.simulation import PhaseModel, PhaseModels, PhaseStart

from eomgen.mechanics.dynamics import System
from eomgen.mechanics.integrals import ClosedInstant
from eomgen.symbolic.expression import State
from eomgen.symbolic.numeric import transplanted


@dataclass(frozen=True)
class StateInNumbers:
    """A state as it is drawn.

    Args:
        x: coordinates, speeds, then further states.
        p: parameters in the model's order.
        assumed: the parameters without a value, taken as 1.
    """

    t: float
    x: np.ndarray
    p: np.ndarray
    assumed: tuple[str, ...] = ()

    @classmethod
    def of(cls, system: System, numbers: Mapping[Node, Any], assumed: Iterable[str] = ()) -> StateInNumbers:
        """The state of which these are the numbers; without one t and x are 0, parameters 1."""
        symbols = system.symbols
        x = [float(numbers.get(node, 0.0)) for node in symbols.x]
        p = [float(numbers.get(node, 1.0)) for node in symbols.parameters.values()]
        return cls(float(numbers.get(symbols.t, 0.0)), np.array(x), np.array(p), tuple(assumed))

    @classmethod
    def at_start(cls, system: System) -> StateInNumbers:
        """State at which a model starts; constraints that do not close with what is assumed stay open."""
        model, symbols = system.scope.model, system.symbols
        known = model.exact_parameters()
        assumed = {name: 1 for name in model.parameters if name not in known}
        try:
            values = Start.of(system, assumed).values
        except DerivationError:
            q, u = model.start_values(assumed)
            values = {**q, **u}
        begun = {x: values[x.name] for x in symbols.x}
        return cls.of(system, {**begun, **{symbols.parameters[name]: value for name, value in known.items()}}, assumed)


@dataclass(frozen=True)
class StateAtInstant:
    """State of a motion at one instant.

    Args:
        phase: the equations of the phase.
        exact: t, q and u as scalars of the parameters, as far as they have a closed form.
        numbers: t, q and u as numbers; {} where parameters have no values.
        method: name of the method by which the instant was found.
    """

    phase: Study
    exact: Mapping[Node, Scalar]
    numbers: Mapping[Node, float]
    method: str

    @classmethod
    def resting(cls, study: Study) -> StateAtInstant:
        """Equilibrium that is nearest to the start; with unknowns in the loads, the start itself.

        Args:
            study: of the contacts as they are at rest.
        Raises:
            DerivationError: there is no equilibrium, or a contact would have to pull there.
        """

        if study.statics.loaded:
            return _held(study.system)
        place = study.equilibria.nearest()
        system = place.statics.still
        place.refuse_contradicted()
        held = f", {', '.join(place.statics.held)} held" if place.statics.held else ""
        exact = {**place.exact, **_still(system)}
        numbers = (
            {**place.numbers, **dict.fromkeys((system.symbols.t, *system.symbols.u), 0.0)} if place.numbers else {}
        )
        return StateAtInstant(Study(system), exact, numbers, f"balance of all forces at rest{held}")


def carried(moment: StateAtInstant, phase: Study) -> dict[Node, Scalar]:
    """Exact end of a phase as the start of the next; {} where it is not exact.

    A displacement that the phase before did not have is 0.
    """
    symbols = phase.system.symbols
    known = {node.name: x for node, x in moment.exact.items()}
    old = {x.name for x in moment.phase.system.symbols.x}
    wanted = [symbols.t, *symbols.x]
    if any(node.name not in known and (node.name in old or node is symbols.t) for node in wanted):
        known = _with_rates(moment, known)
    if any(node.name not in known and (node.name in old or node is symbols.t) for node in wanted):
        return {}
    meanings = dict(symbols.parameters)
    values = transplanted([known.get(node.name, 0) for node in wanted], symbols.graph, meanings)
    return dict(zip(wanted, values, strict=True))


def _with_rates(moment: StateAtInstant, known: dict[str, Scalar]) -> dict[str, Scalar]:
    """The rates of coordinates that were dependent, too."""
    scope = moment.phase.system.scope
    rates = substituted(scope.rates, dict(moment.exact))
    return {f"{q.name}'": rate for q, rate in zip(scope.symbols.q, rates, strict=True)} | known


def placed(phase: Study, known: Mapping[Node, Scalar], numbers: Mapping[Node, float]) -> dict[Node, Scalar]:
    """Known values of a state, with the coordinates that the constraints then fix, where they have a closed form.

    Args:
        numbers: the same state in numbers, by which one of several positions is chosen; {}: nothing is added.
    """
    system = phase.system
    unknown = [q for q in system.symbols.q if q not in known]
    gaps = [row.gap for row in system.constraints.rows if row.gap is not None and not row.identical]
    if not unknown or not gaps or not numbers or len(gaps) < len(unknown) == len(system.symbols.q):
        return dict(known)  # nothing to begin with
    located = Located({**phase.numeric_parameters, **numbers}, phase.system.scope.positive)
    equations = [x for x in substituted(tuple(gaps), known) if depends_on(x, unknown)]
    return {**known, **located.places(equations, unknown)}


def _held(system: System) -> StateAtInstant:
    """The start, held by the unknowns of the loads."""
    from eomgen.mechanics.equilibrium import holding_of

    holding = holding_of(system)
    system = holding.statics.system
    return StateAtInstant(Study(system), {**holding.place, **holding.unknowns, **_still(system)}, {}, "virtual work")


def _still(system: System) -> dict[Node, Scalar]:
    return {system.symbols.t: 0, **dict.fromkeys(system.symbols.u, 0)}


# -------- first instant ---------------------------------------------------------------------------------------
# Phase, condition, start -> the state at the first time after the start at which the condition holds.
#
# It is located in numbers first, then sought in closed form; a closed form is used where it agrees with the numbers.


TRIALS = (1.3, 3, 8, 20)  # how far from 1 values are tried for parameters that have none


def reached(
    phase: Study, condition: Scalar, start: Mapping[Node, Scalar], numbers: Mapping[Node, float]
) -> StateAtInstant:
    """State at the first instant after the start at which the condition is 0; the start itself does not count.

    Args:
        condition: function of q, u, t and parameters.
        start: q and u at the start as scalars of the parameters, t where it is not 0; {} without a closed form.
        numbers: the same as numbers; {} where parameters have no values.
    Raises:
        RunFailed: the condition is not met.
    """
    search, values = _search(phase, condition, start), _values(phase)
    return search.first(dict(numbers), values) if numbers else search.with_trial_values(values)


def closed_form(
    phase: Study, condition: Scalar, start: Mapping[Node, Scalar], numbers: Mapping[Node, float]
) -> tuple[State, str]:
    """State in closed form where the condition holds, and the name of the method.

    t, q and u are given as far as they have a closed form.
    Args:
        start: q and u at the start of the phase.
        numbers: t, q and u at the instant.
    """
    return _search(phase, condition, start).closed(dict(numbers), _values(phase))


def _search(phase: Study, condition: Scalar, start: Mapping[Node, Scalar]) -> _Search:
    own = {node: phase.system.inputs[name] for name, node in phase.system.symbols.inputs.items()}
    *accelerations, condition = substituted((*phase.accelerations, condition), own)
    return _Search(phase, tuple(accelerations), condition, dict(start))


def _values(phase: Study) -> State:
    parameters, known = phase.system.symbols.parameters, phase.model.exact_parameters()
    return {node: float(known[name]) for name, node in parameters.items() if name in known}


@dataclass(frozen=True)
class _Search:
    """Search for an instant; arguments as of `reached`, inputs replaced by their own functions of time."""

    phase: Study
    accelerations: tuple[Scalar, ...]
    condition: Scalar
    start: State

    def first(self, start: State, values: State) -> StateAtInstant:
        """The instant at the parameters' values."""
        equations = (self.phase.equations, self.accelerations)
        numbers, method = FirstTime(*equations, self.condition, self.start, start, values).located()
        exact, way = self.closed(numbers, values)
        return StateAtInstant(self.phase, exact, numbers, way or method)

    def with_trial_values(self, known: State) -> StateAtInstant:
        """State at the instant in closed form alone; its branch is chosen at trial values of the parameters.

        Raises:
            RunFailed: the condition is met at none of the trials.
        """
        symbols, rng = self.phase.system.symbols, Random(1)
        if not {*symbols.x} <= self.start.keys():
            raise RunFailed("the start has no closed form, and no numbers", fix="give the parameters values")
        reason: EomgenError = RunFailed("no trial was made")
        parameters = symbols.parameters.values()
        for spread in TRIALS:
            values = {node: spread ** rng.uniform(-1, 1) for node in parameters} | known
            try:
                numbers = evaluate(tuple(self.start.values()), values, FLOAT)
                start = {symbols.t: 0.0, **dict(zip(self.start, map(float, numbers), strict=True))}
                return replace(self.first(start, values), numbers={})
            except (RunFailed, DerivationError) as error:
                reason = error
        tried = "at the values tried for parameters without one"
        raise RunFailed(f"{reason.what} ({tried})", fix="give the parameters values")

    def closed(self, numbers: State, values: State) -> tuple[State, str]:
        """State in closed form, and the name of the method; "" where the method of the numbers describes it better."""
        symbols = self.phase.system.symbols
        moving = {*symbols.x}
        if not moving <= self.start.keys():
            return {}, ""
        positive = self.phase.system.scope.positive | {q for q in symbols.q if numbers[q] > 0}
        located = Located({**values, **numbers}, positive)
        equations = (self.phase.equations, self.accelerations)
        closed = ClosedInstant(*equations, self.condition, self.start, located)
        by_time = closed.by_laws()
        if moving <= by_time.keys() or not depends_on(self.condition, moving):
            return by_time, "law of motion" if by_time.keys() & self._own else ""
        by_energy = closed.by_integrals()
        way = "energy theorem" if by_energy.keys() & {*symbols.u} else "law of motion" if by_time else ""
        return {**by_energy, **by_time}, way

    @property
    def _own(self) -> set[Node]:
        """Speeds, and the coordinates that are not given as functions of time."""
        symbols, table = self.phase.system.symbols, self.phase.model.coordinates
        return {*symbols.u, *(q for q in symbols.q if not table[q.name].driven)}


# -------- the motion from the start ---------------------------------------------------------------------------


HORIZONS = (10.0, 100.0, 1000.0)  # s, for conditions that are met late
MOST_STEPS = 4000
STEPS = 2000  # of a run in time that one instant is compared with
WATCHED, INSTANTS = 100.0, 8001  # s of a motion, and instants of it, at which it is checked that it stays in its piece
WATCHED_BRIEFLY = 10.0  # s, where 100 s take too many steps
WATCHED_STEPS = 20_000


@dataclass(frozen=True)
class MotionFromStart:
    """The motion of a model from its start.

    Args:
        model: the model.
        at_rest: all speeds are 0 at the start, whatever the model says.
    """

    model: Model
    at_rest: bool

    # -- the start -------------------------------------------------------------------------------

    @cached_property
    def models(self) -> PhaseModels | None:
        """The phases of a model that has any, and values for its parameters; else None."""
        if not self.model.has_phases:
            return None
        from eomgen.simulation import PhaseModels

        try:
            return PhaseModels(self.model, RightHandSide.parameter_values(self.model), "numpy")
        except MissingValues:
            return None

    @cached_property
    def _first(self) -> PhaseStart:
        """Start of the first phase."""
        from eomgen.simulation import PhaseStart

        assert self.models is not None
        return PhaseStart.of(self.models, 0.0, None, self._start_rates)

    @property
    def _start_rates(self) -> dict[str, float] | None:
        """The speeds at the start that replace the model's."""
        if self.at_rest and self.model.speeds:
            return {u.name: 0.0 for u in System.of(self.model).symbols.u}
        free = (q for q, part in self.model.coordinates.items() if not part.driven and not part.dependent)
        return {f"{q}'": 0.0 for q in free} if self.at_rest else None

    @cached_property
    def phase(self) -> Study:
        """The first phase: contacts as they are at the start; bodies without coordinates rest on theirs."""
        if not self.model.coordinates:
            return study_at_rest(self.model)
        if self.models is None:
            return study_of(self.model)
        return Study(self.models.of(self._first.configuration.by_the_law(self.model)).system)

    @property
    def failure(self) -> str:
        """Reason why no phase begins at the start; "" where one does."""
        return "" if self.models is None or not self.model.coordinates else self._first.failure

    @property
    def numbers(self) -> dict[Node, float]:
        """t, q and u at the start; {} where parameters are missing."""
        return self.begun.numbers

    @property
    def begun(self) -> ExactStart:
        """The start at which the constraints hold."""
        return self.phase.start_of(at_rest=self.at_rest)

    @property
    def start(self) -> dict[Node, Scalar]:
        """t, q and u at the start as scalars of the parameters; {} where one has no closed form there."""
        return dict(self.begun.exact) if self.begun.is_exact else {}

    @property
    def at_start(self) -> StateAtInstant:
        """The start as an instant."""
        return StateAtInstant(self.phase, self.start, self.numbers, "at the start")

    def at_rest_on(self) -> str:
        """Names of the contacts on surfaces that are at rest at the start, with friction."""
        phase = self.phase
        values = {**phase.system.scope.known_parameters, **self.numbers}
        rows = [row for row in phase.system.constraints.rows if row.shares and row.friction is not None]
        return ", ".join(f"'{row.constraint}'" for row in rows if evaluate((row.sliding,), values, FLOAT)[0] == 0)

    # -- on the way ------------------------------------------------------------------------------

    def until(self, condition: WrittenEquation, side: str | None = None) -> StateAtInstant:
        """The first time after the start at which the condition holds.

        Args:
            side: "before" or "after", where a phase ends at that very instant.
        Raises:
            RunFailed: it is never met.
        """
        requested = (condition.text, side or "")
        if requested not in self._moments:
            try:
                self._moments[requested] = self._until(condition, side)
            except (RunFailed, DerivationError) as error:
                self._moments[requested] = error
        found = self._moments[requested]
        if isinstance(found, EomgenError):
            raise found
        return found

    @cached_property
    def _moments(self) -> dict[tuple[str, str], StateAtInstant | EomgenError]:
        """Cache of instants sought, and of the errors of those that are never reached."""
        return {}

    def _until(self, condition: WrittenEquation, side: str | None) -> StateAtInstant:
        if self._is_start(condition):
            return self.at_start
        if not self.goes_through_phases:
            return self._within(self.phase, condition, self.start, self.numbers)
        return self._through(self.runs_to(condition), condition, side)

    @property
    def stepping(self) -> Stepping:
        """Fine tolerances: instants of the motion are then sought in closed form."""
        return Stepping.fine(MOST_STEPS)

    @cached_property
    def goes_through_phases(self) -> bool:
        """True if the motion is followed in numbers from phase to phase."""
        return self.models is not None and not self._starts_in_balance(self.phase)

    def _is_start(self, condition: WrittenEquation) -> bool:
        """True if the condition holds at t = 0 by time alone: it contains no coordinate and no speed.

        Raises:
            RunFailed: the condition contains nothing that moves.
        """
        symbols = self.phase.system.symbols
        scalar = self.phase.difference(condition)
        if depends_on(scalar, symbols.x):
            return False
        if not depends_on(scalar, (symbols.t, *symbols.inputs.values())):
            raise RunFailed(
                f"'{condition.text}' names no instant: nothing in it moves",
                fix="write an equation in coordinates, rates or t",
            )
        return holds_identically(substituted((scalar,), {symbols.t: 0})[0])

    def _within(
        self,
        phase: Study,
        condition: WrittenEquation,
        start: Mapping[Node, Scalar],
        numbers: Mapping[Node, float],
    ) -> StateAtInstant:
        """State at the first time in one phase at which the condition holds."""
        moment = reached(phase, phase.difference(condition), start, numbers)
        moment = replace(moment, exact=placed(phase, moment.exact, moment.numbers))
        if self.models is not None:
            self._refuse_ended(moment)
        return moment

    def _starts_in_balance(self, phase: Study) -> bool:
        """True if the motion stays at the start: it is at rest there, and in equilibrium."""
        symbols = phase.system.symbols
        first = self._numeric_first
        if any(self.numbers[u] != 0 for u in symbols.u) or _is_moved_by_time(first, phase):
            return False
        x = first.state({node.name: value for node, value in self.numbers.items()})
        with np.errstate(all="ignore"):
            rates = first.rate(0.0, x)[len(symbols.q) : len(symbols.q) + len(symbols.u)]
        return not np.all(np.isfinite(rates)) or float(np.max(np.abs(rates), initial=0.0)) < tolerances.COMPUTED

    @property
    def _numeric_first(self) -> PhaseModel:
        assert self.models is not None
        return self.models.of(self._first.configuration)

    def _refuse_ended(self, moment: StateAtInstant) -> None:
        """Refuses an instant before which, on the way from an unstable equilibrium, a contact has ended.

        Raises:
            RunFailed: a contact has ended; the error names it.
        """
        values = {**moment.phase.numeric_parameters, **moment.numbers}
        for bound in self._numeric_first.bounds:
            if bound.value is None or bound.kind not in ("ends", "turns", "closes"):
                continue
            scalar = moment.phase.eliminated(bound.value)
            there = evaluate((scalar,), values, FLOAT)[0]
            size = abs(evaluate((scalar,), {**values, **self.numbers}, FLOAT)[0])
            if math.isfinite(there) and there < -tolerances.CARRIED * max(1.0, size):
                raise RunFailed(
                    f"'{bound.owner}' ends before the instant, on the way from an unstable equilibrium",
                    fix="start from an equilibrium that is stable, or ask earlier",
                )

    # -- through several phases -------------------------------------------------------------------

    def runs_to(self, condition: WrittenEquation) -> list[PhaseRun]:
        """The phases up to the one in which the condition is met, as they were run.

        Raises:
            RunFailed: it is not met.
        """
        if condition.text not in self._runs:
            self._runs[condition.text] = self._run_to(condition)
        return self._runs[condition.text]

    def run_to(self, condition: WrittenEquation) -> Trajectory:
        """The motion through these phases.

        Raises:
            RunFailed: it is not met.
        """
        assert self.models is not None
        return PhaseRun.joined(self.models, self.runs_to(condition))

    @cached_property
    def _runs(self) -> dict[str, list[PhaseRun]]:
        return {}

    def _run_to(self, condition: WrittenEquation) -> list[PhaseRun]:
        from eomgen.simulation import Plan

        assert self.models is not None

        def until(phase: PhaseModel) -> Scalar:
            return Study(phase.system).difference(condition)

        for horizon in HORIZONS:
            runs = list(Plan(horizon, self.stepping, None, until).through(self.models, self._first))
            if runs[-1].is_met:
                return runs
            if runs[-1].run.status != "finished":
                raise RunFailed(
                    f"'{condition.text}' is not met before the run ended: {runs[-1].run.message}",
                    fix="ask for what the motion reaches",
                )
        raise RunFailed(
            f"'{condition.text}' is not met within {HORIZONS[-1]:g} s", fix="ask for what the motion reaches"
        )

    def _through(self, runs: Sequence[PhaseRun], condition: WrittenEquation, side: str | None) -> StateAtInstant:
        """State at the end of the last phase; the end of every phase is sought in closed form."""
        moment = StateAtInstant(self.phase, self.start, {}, "")
        for k, run in enumerate(runs):
            phase = Study(run.phase.system)
            exact = {} if k and _jumps(runs[k - 1].end, run.here.values) else carried(moment, phase)
            met = run.bound is None and run is runs[-1]
            ended_by = phase.difference(condition) if met else None if run.bound is None else run.bound.value
            moment = _end_of(phase, run, ended_by, exact)
        after = runs[-1].after
        if side != "after" or after is None:
            return moment
        assert self.models is not None
        phase = Study(self.models.of(after.configuration).system)
        exact = {} if _jumps(runs[-1].end, after.values) else carried(moment, phase)
        return StateAtInstant(phase, exact, _numbers(phase, after.t, after.values), moment.method)

    def before_closing(self, contact: str) -> dict[str, float]:
        """Coordinates and speeds by name just before a contact is hit first, the start included; {} where none is.

        None is where parameters have no values, the motion cannot be followed so far, or it is not hit soon.
        """
        from eomgen.simulation import Plan

        if self.models is None:
            return {}
        apart = self.models.without_contacts
        start = StateInNumbers.at_start(apart.system)
        names = [node.name for node in apart.system.symbols.x]
        begun = dict(zip(names, start.x.tolist(), strict=True))

        def is_hit(t: float, values: Mapping[str, float]) -> bool:
            gap, rate = apart.gaps(t, values)[contact]
            size = max(1.0, *map(abs, values.values()))
            return abs(gap) <= tolerances.OPEN_GAP * size and rate < -tolerances.COMPUTED * size

        if is_hit(0.0, begun):
            return begun
        with suppress(RunFailed, DerivationError):
            for each in Plan(HORIZONS[0], self.stepping).through(self.models, self._first):
                if is_hit(each.run.end, each.end):
                    return {**each.end, "t": each.run.end}
        return {}

    # -- in one phase ----------------------------------------------------------------------------

    def run(self, time: float, samples: int | None = None, steps: int = STEPS) -> Trajectory:
        """The motion from the start, in one phase, by emitted code.

        Raises:
            RunFailed: the run ends before that time.
        """
        phase, p = self.phase, self.p
        system, symbols = phase.system, phase.system.symbols
        x0 = np.array([self.numbers[node] for node in symbols.x])
        rhs = RightHandSide.of(Program.right_hand_side(phase.explicit_while_sliding), "numpy")
        run = integrate_one_phase(rhs, phase.equations, system, Stepping.fine(steps), x0, p, time, samples)
        if not run.ok:
            raise RunFailed(f"the run does not get there: {run.message}", fix="choose an earlier instant")
        return run

    @property
    def p(self) -> np.ndarray:
        """Parameters of the phase; nan for those without a value."""
        known = self.phase.parameters
        symbols = self.phase.system.symbols
        return np.array([number_of(known[node]) if node in known else math.nan for node in symbols.parameters.values()])

    def refuse_leaving(self, held: Extent) -> None:
        """Refuses integrals of the motion that hold only in pieces which the motion leaves.

        Raises:
            DerivationError: it leaves them, or that is not known.
        """
        if held.everywhere:
            return
        what = f"the integrals of the motion give the rates only while {held.text}"
        if not self.numbers:
            raise DerivationError(
                f"{what}, and without values of all parameters it is not known whether the motion stays there",
                fix="give the parameters values",
            )
        left = self._leaves_at(held)
        if left is not None:
            raise DerivationError(
                f"{what}, and the motion leaves that at t = {left:.4g} s", fix="request it at an instant: `at`"
            )

    def _leaves_at(self, held: Extent) -> float | None:
        """Time at which the motion first leaves the pieces of an extent [s]; None: not within the time followed.

        Raises:
            RunFailed: the motion cannot be followed.
        """
        try:
            run = self.run(WATCHED, INSTANTS, WATCHED_STEPS)
        except RunFailed:
            run = self.run(WATCHED_BRIEFLY, INSTANTS, WATCHED_STEPS)
        system = self.phase.system
        function = RightHandSide.of(Program.of(held.limits, system.symbols, inputs=system.inputs), "numpy")
        with np.errstate(all="ignore"):
            over = function.many(run.t, run.x, self.p)
        worst = np.max(over, axis=1)
        out = worst > tolerances.COMPUTED * (1 + np.max(np.abs(over), initial=0.0))
        if not out.any():
            return None
        k = max(int(np.argmax(out)), 1)
        share = (
            -worst[k - 1] / (worst[k] - worst[k - 1]) if worst[k - 1] < 0 else 0.0
        )  # of the way between two instants
        return float(run.t[k - 1] + share * (run.t[k] - run.t[k - 1]))


def _end_of(phase: Study, run: PhaseRun, ended_by: Scalar | None, start: Mapping[Node, Scalar]) -> StateAtInstant:
    """State at the end of a phase: in numbers as it was run, exact where the closed form agrees with them.

    Args:
        ended_by: formula that became zero; None: the phase was ended by a condition without a formula.
    """
    numbers = _numbers(phase, run.run.end, run.end)
    by_time = StateAtInstant(phase, {}, numbers, "integration in time")
    if not start or ended_by is None:
        return by_time
    try:
        exact, way = closed_form(phase, phase.eliminated(ended_by), start, numbers)
    except (RunFailed, DerivationError):
        return by_time
    located = Located({**phase.numeric_parameters, **numbers}, phase.system.scope.positive)
    exact = {node: x for node, x in exact.items() if located.agrees(x, node)}
    return replace(by_time, exact=placed(phase, exact, numbers), method=way or by_time.method)


def _numbers(phase: Study, t: float, values: Mapping[str, float]) -> dict[Node, float]:
    """State by the symbols of a phase; a displacement that does not exist yet is 0."""
    symbols = phase.system.symbols
    return {symbols.t: t} | {node: values.get(node.name, 0.0) for node in symbols.x}


def _jumps(end: Mapping[str, float], start: Mapping[str, float]) -> bool:
    """True if a velocity jumps between two phases: an impact."""
    common = [name for name in end if name in start]
    return any(abs(end[name] - start[name]) > tolerances.CARRIED * (1 + abs(end[name])) for name in common)


def _is_moved_by_time(first: PhaseModel, phase: Study) -> bool:
    """True if a given motion, or a force that changes with time, can end a state of rest."""
    symbols, coordinates = phase.system.symbols, phase.model.coordinates
    moving = (symbols.t, *symbols.inputs.values(), *(q for q in symbols.q if coordinates[q.name].driven))
    bounds = (phase.eliminated(bound.value) for bound in first.bounds if bound.value is not None)
    return any(depends_on(scalar, moving) for scalar in (*phase.accelerations, *bounds))
