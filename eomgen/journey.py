"""Model, condition -> Moment: the state at which a motion first meets a condition, exactly where it can be.

A motion may pass through several phases: contacts end, rub, stick, a path goes over from one piece to the next. Each
phase is followed in numbers; the instants between are then sought in closed form, and taken where both agree.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from eomgen.errors import EomgenError, MissingValues, RunFailed
from eomgen.instants import Instant, reached
from eomgen.mechanics.places import Located, places_of
from eomgen.mechanics.start import start_state
from eomgen.mechanics.ties import holds_identically
from eomgen.model.fields import Equation
from eomgen.model.parts import Model
from eomgen.model.values import numeric_parameters
from eomgen.simulation.contacts import has_phases
from eomgen.simulation.course import Course, at_start, course_of
from eomgen.simulation.phases import Plan, passed
from eomgen.simulation.stage import Stage
from eomgen.simulation.stepping import Stepping
from eomgen.simulation.stretch import Stretch
from eomgen.situation import Situation, situation_of, start_of
from eomgen.symbolic.derivative import depends_on, substituted
from eomgen.symbolic.evaluation import FLOAT, evaluate
from eomgen.symbolic.graph import Node, Scalar
from eomgen.symbolic.transplant import transplanted

HORIZONS = (10.0, 100.0, 1000.0, 10000.0)  # s, for conditions that are met late
FINE = Stepping(rtol=1e-12, atol=1e-12, most_steps=4000)
HOLDS = 1e-8  # of a condition against its change along the phase
SAME_TIME = 1e-8  # of instants, relative to them and 1 s


@dataclass(frozen=True)
class Moment:
    """One instant of a motion.

    Args:
        situation: the equations of the phase.
        exact: t, q and u as scalars of the parameters, those that are known so.
        numbers: t, q and u as numbers; {} where parameters are missing.
        method: how it was found.
    """

    situation: Situation
    exact: Mapping[Node, Scalar]
    numbers: Mapping[Node, float]
    method: str


@dataclass(frozen=True)
class Journey:
    """The motion of a model from its start.

    Args:
        model: the model.
        at_rest: all speeds are 0 at the start, whatever the model says.
    """

    model: Model
    at_rest: bool

    # -- the start -------------------------------------------------------------------------------

    @cached_property
    def course(self) -> Course | None:
        """The phases of a model that has any, and values for its parameters; else None."""
        if not has_phases(self.model):
            return None
        try:
            return course_of(self.model, np.array(list(numeric_parameters(self.model).values()), dtype=float))
        except MissingValues:
            return None

    @cached_property
    def _first(self):
        """Where the phases begin."""
        assert self.course is not None
        rates = {f"{q}'": 0.0 for q, part in self.model.coordinates.items() if not part.driven and not part.dependent}
        return at_start(self.course, 0.0, None, rates if self.at_rest else None)

    @cached_property
    def situation(self) -> Situation:
        """The first phase: contacts as they are at the start."""
        if self.course is None:
            return situation_of(self.model)
        return Situation(self.course.stages.of(self._first.configuration).system)

    @cached_property
    def numbers(self) -> dict[Node, float]:
        """t, q and u at the start; {} where parameters are missing."""
        symbols = self.situation.system.symbols
        try:
            numeric_parameters(self.model)
            values = start_state(self.situation.system, start={u.name: 0.0 for u in symbols.u} if self.at_rest else {})
        except MissingValues:
            return {}
        return {symbols.t: 0.0} | {node: values[node.name] for node in (*symbols.q, *symbols.u)}

    @cached_property
    def start(self) -> dict[Node, Scalar]:
        """t, q and u at the start as scalars of the parameters; {} where a coordinate has no closed form there."""
        known = placed(self.situation, start_of(self.situation, at_rest=self.at_rest), self.numbers)
        return known if all(q in known for q in self.situation.system.symbols.q) else {}

    @property
    def sense(self) -> int:
        """The sign of the first speed that is not 0 at the start."""
        moving = [self.numbers[u] for u in self.situation.system.symbols.u if self.numbers.get(u, 0.0) != 0]
        return -1 if moving and moving[0] < 0 else 1

    # -- on the way ------------------------------------------------------------------------------

    def until(self, condition: Equation, side: str | None = None) -> Moment:
        """The first time after the start at which the condition holds.

        Args:
            side: "before" or "after", where a phase ends at that very instant.
        Raises:
            RunFailed: it is never met.
        """
        asked = (condition.text, side or "")
        if asked not in self._moments:
            self._moments[asked] = self._until(condition, side)
        return self._moments[asked]

    @cached_property
    def _moments(self) -> dict[tuple[str, str], Moment]:
        """Those that were sought already."""
        return {}

    def _until(self, condition: Equation, side: str | None) -> Moment:
        if self._is_start(condition):
            return Moment(self.situation, self.start, self.numbers, "at the start")
        if self.course is None or self._starts_in_balance(self.situation):
            return self._within(self.situation, condition, self.start, self.numbers)
        stretches = self._stretches(condition)
        moment = self._exactly(stretches, condition)
        return self._after(moment, stretches) if side == "after" else moment

    def _is_start(self, condition: Equation) -> bool:
        """Whether an instant is asked for by the time t = 0."""
        symbols = self.situation.system.symbols
        scalar = _difference(self.situation, condition)
        if depends_on(scalar, (*symbols.q, *symbols.u)):
            return False
        return depends_on(scalar, (symbols.t,)) and holds_identically(substituted((scalar,), {symbols.t: 0})[0])

    def _within(
        self, situation: Situation, condition: Equation, start: Mapping[Node, Scalar], numbers: Mapping[Node, float]
    ) -> Moment:
        """In one phase."""
        instant = _reached(situation, _difference(situation, condition), start, numbers)
        moment = Moment(situation, placed(situation, instant.exact, instant.numbers), instant.numbers, instant.method)
        if self.course is not None:
            self._refuse_ended(moment)
        return moment

    def _starts_in_balance(self, situation: Situation) -> bool:
        """Whether time does not lead away from the start."""
        symbols = situation.system.symbols
        if any(self.numbers[u] != 0 for u in symbols.u):
            return False
        stage = self._stage_of_first
        x = stage.state({node.name: value for node, value in self.numbers.items()})
        with np.errstate(all="ignore"):
            rates = stage.rate(0.0, x)[len(symbols.q) : len(symbols.q) + len(symbols.u)]
        return not np.all(np.isfinite(rates)) or float(np.max(np.abs(rates), initial=0.0)) < 1e-9

    @property
    def _stage_of_first(self) -> Stage:
        assert self.course is not None
        return self.course.stages.of(self._first.configuration)

    def _refuse_ended(self, moment: Moment) -> None:
        """Refuse an instant that a motion from an unstable rest would reach with contacts that have ended before.

        Raises:
            DerivationError: a contact is named.
        """
        stage = self._stage_of_first
        values = {**_parameters(moment.situation), **moment.numbers}
        for bound in stage.bounds:
            if bound.value is None or bound.kind not in ("ends", "turns", "closes"):
                continue
            scalar = moment.situation.eliminated(bound.value)
            there = evaluate((scalar,), values, FLOAT)[0]
            size = abs(evaluate((scalar,), {**values, **self.numbers}, FLOAT)[0])
            if math.isfinite(there) and there < -HOLDS * max(1.0, size):
                raise RunFailed(f"'{bound.owner}' ends before the instant, on the way from an unstable rest")

    # -- through several phases -------------------------------------------------------------------

    def _stretches(self, condition: Equation) -> list[Stretch]:
        """The phases up to the one in which the condition is met."""
        assert self.course is not None

        def until(stage: Stage) -> Scalar:
            situation = Situation(stage.system)
            return _difference(situation, condition)

        for horizon in HORIZONS:
            found: list[Stretch] = []
            for stretch in passed(self.course, self._first, Plan(horizon, FINE, until=until)):
                found.append(stretch)
                crossing = stretch.run.crossing
                if crossing is not None and crossing.index == len(stretch.stage.bounds):
                    return found
                if stretch.bound is not None and self._holds_at_end(stretch, until(stretch.stage)):
                    return found
            if found[-1].run.status != "finished":
                raise RunFailed(f"'{condition.text}' is not met before the run ended: {found[-1].run.message}")
        raise RunFailed(f"'{condition.text}' is not met within {HORIZONS[-1]:g} s")

    def _holds_at_end(self, stretch: Stretch, scalar: Scalar) -> bool:
        """Whether the condition is met at the very instant at which a phase ends."""
        run = stretch.run
        if run.end <= stretch.here.t:
            return False
        t, x = np.append(run.t, run.end), np.vstack([run.x, run.last])
        size = np.abs(stretch.stage.evaluated(t, x, (scalar,))[:, 0])
        return bool(size[-1] <= HOLDS * max(np.max(size), 1e-12))

    def _exactly(self, stretches: list[Stretch], condition: Equation) -> Moment:
        """The end of the last phase, every end before it sought in closed form."""
        moment: Moment | None = None
        for stretch in stretches:
            situation = Situation(stretch.stage.system)
            start = self._carried_start(situation) if moment is None else _carried(moment, situation)
            last = stretch is stretches[-1]
            scalar = _difference(situation, condition) if last else stretch.bound.value if stretch.bound else None
            moment = self._end_of(situation, stretch, scalar, start)
            if stretch.after is not None and stretch.after.impact:
                moment = replace(moment, exact={})
        assert moment is not None, "there is at least one phase"
        return moment

    def _carried_start(self, situation: Situation) -> dict[Node, Scalar]:
        """The exact start in the symbols of the first phase."""
        return _carried(Moment(self.situation, self.start, {}, ""), situation) if self.start else {}

    def _end_of(
        self, situation: Situation, stretch: Stretch, scalar: Scalar | None, start: Mapping[Node, Scalar]
    ) -> Moment:
        """The end of a phase: in numbers as it was run, exact where that agrees."""
        symbols = situation.system.symbols
        values = stretch.stage.values(stretch.run.end, stretch.run.last)
        numbers = {symbols.t: stretch.run.end} | {node: values[node.name] for node in (*symbols.q, *symbols.u)}
        if not start or scalar is None:
            return Moment(situation, {}, numbers, "integration in time")
        begin = {symbols.t: stretch.here.t}
        begin |= {node: stretch.here.values.get(node.name, 0.0) for node in (*symbols.q, *symbols.u)}
        try:
            instant = _reached(situation, situation.eliminated(scalar), start, begin)
        except EomgenError:
            return Moment(situation, {}, numbers, "integration in time")
        located = Located({**_parameters(situation), **numbers}, situation.positive)
        exact = {node: x for node, x in instant.exact.items() if located.agrees(x, node)}
        return Moment(situation, placed(situation, exact, numbers), numbers, instant.method)

    def _after(self, moment: Moment, stretches: list[Stretch]) -> Moment:
        """The same instant in the phase that begins there, if one does."""
        assert self.course is not None
        end = stretches[-1].run.end
        within = SAME_TIME * (1 + end)
        for stretch in passed(self.course, self._first, Plan(end + 100 * within, FINE)):
            after = stretch.after
            if after is not None and abs(after.t - end) <= within and not after.failure:
                situation = Situation(self.course.stages.of(after.configuration).system)
                symbols = situation.system.symbols
                numbers = {symbols.t: end} | {x: after.values.get(x.name, 0.0) for x in (*symbols.q, *symbols.u)}
                exact = {} if after.impact else _carried(moment, situation)
                moment = Moment(situation, exact, numbers, moment.method)
        return moment


def _difference(situation: Situation, condition: Equation) -> Scalar:
    """Left side minus right side as a function of q, u and t."""
    return situation.of_state(condition.left) - situation.of_state(condition.right)


def _reached(
    situation: Situation, condition: Scalar, start: Mapping[Node, Scalar], numbers: Mapping[Node, float]
) -> Instant:
    return reached(situation.system, situation.assembly, situation.accelerations, condition, start, numbers)


def _carried(moment: Moment, situation: Situation) -> dict[Node, Scalar]:
    """The exact end of a phase as the start of the next; a displacement that did not exist is 0. {}: not exact."""
    symbols = situation.system.symbols
    known = {node.name: x for node, x in moment.exact.items()}
    old = {x.name for x in (*moment.situation.system.symbols.q, *moment.situation.system.symbols.u)}
    wanted = [symbols.t, *symbols.q, *symbols.u]
    if any(node.name not in known and (node.name in old or node is symbols.t) for node in wanted):
        known = _with_rates(moment, known)
    if any(node.name not in known and (node.name in old or node is symbols.t) for node in wanted):
        return {}
    meanings = dict(symbols.parameters)
    values = transplanted([known.get(node.name, 0) for node in wanted], symbols.graph, meanings)
    return dict(zip(wanted, values, strict=True))


def _with_rates(moment: Moment, known: dict[str, Scalar]) -> dict[str, Scalar]:
    """The rates of coordinates that were dependent, too."""
    scope = moment.situation.system.scope
    rates = substituted(scope.rates, dict(moment.exact))
    return {f"{q.name}'": rate for q, rate in zip(scope.symbols.q, rates, strict=True)} | known


def placed(situation: Situation, known: Mapping[Node, Scalar], numbers: Mapping[Node, float]) -> dict[Node, Scalar]:
    """What is known of a state, and the coordinates that the ties then fix, where they have a closed form.

    Args:
        numbers: the same state in numbers, by which one of several places is chosen; {}: nothing is added.
    """
    system = situation.system
    unknown = [q for q in system.symbols.q if q not in known]
    gaps = [row.gap for row in system.ties.rows if row.gap is not None and not row.identical]
    if not unknown or not gaps or not numbers:
        return dict(known)
    located = Located({**_parameters(situation), **numbers}, situation.positive)
    equations = [x for x in substituted(tuple(gaps), known) if depends_on(x, unknown)]
    return {**known, **places_of(equations, unknown, located)}


def _parameters(situation: Situation) -> dict[Node, float]:
    values = numeric_parameters(situation.model)
    return {situation.system.symbols.parameters[name]: float(x) for name, x in values.items()}

