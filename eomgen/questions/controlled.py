"""Equations, controllers -> Trajectory: inputs by a law of the state that is sampled and held, or by a Python function.

What a controller sets is a parameter of the equations: held, it changes at the controller's instants alone, and between
two of them the motion goes on in the compiled march with another value of it. A Python function of (t, x) is called at
every evaluation: scipy steps, and no step is compiled.
"""

from __future__ import annotations

import inspect
import math
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import replace
from typing import Any

import numpy as np

from eomgen.codegen.rhs import parameter_vector
from eomgen.equations import Equations
from eomgen.errors import NotYet, RunFailed, UsageError
from eomgen.model.feedback import law_of
from eomgen.model.findings import nearest
from eomgen.model.part import altered, part_of_values
from eomgen.model.parts import Model, Parameter
from eomgen.model.table import Table
from eomgen.questions.of_a_run import WholeRun
from eomgen.questions.run import finished_run, phase_models
from eomgen.records import dataclass
from eomgen.simulation.configuration import has_phases
from eomgen.simulation.integrate import instants_of, refuse_bad_run
from eomgen.simulation.integrator import Stepping
from eomgen.simulation.motion import Plan, through
from eomgen.simulation.phase_change import PhaseStart, after_jump, at_start
from eomgen.simulation.phase_models import PhaseModels
from eomgen.simulation.phase_run import PhaseRun
from eomgen.simulation.result import Trajectory
from eomgen.simulation.solvers import breakpoints_of
from eomgen.symbolic.expression.expressions import Expression, as_expression
from eomgen.symbolic.expression.typed import Typed, seconds
from eomgen.symbolic.numeric.tolerances import SOLVED

ControlLaw = Callable[[float, np.ndarray], float]
"""(t, x) -> the input, x = (q, u)"""
MOST_SAMPLES = 1_000_000  # of a controller in a run


@dataclass(frozen=True)
class Controller:
    """What sets one input.

    Args:
        law: (t, x) -> value, or an expression of the state.
        every: it is sampled so often, and held [s]; None: a function that is called at every evaluation.
    """

    law: ControlLaw | Expression
    every: float | None

    def value(self, t: float, state: Mapping[str, float], x: np.ndarray) -> float:
        """What it sets at a state; by name, and as (q, u).

        Raises:
            RunFailed: no number.
        """
        law = self.law
        found = law.evaluate({**state, "t": t, "pi": math.pi}) if isinstance(law, Expression) else law(t, x)
        value = float(np.asarray(found, dtype=float).reshape(()))
        if not math.isfinite(value):
            raise RunFailed(f"a controller gives {value} at t = {t:.6g} s", mend="return a finite number")
        return value


def controllers_of(model: Model, inputs: Mapping[str, Any]) -> dict[str, Controller]:
    """Those among the inputs: functions, and tables {"value": law, "every": time}.

    Raises:
        UsageError: no input of that name; a table with other keys; a time that makes no sense; a function of other
            arguments.
    """
    found: dict[str, Controller] = {}
    for name, value in inputs.items():
        held = isinstance(value, Mapping) and "every" in value
        if not held and not callable(value):
            continue
        if name not in model.inputs:
            raise UsageError(f"there is no input '{name}'", mend=nearest(name, model.inputs))
        if not held:
            _refuse_other_arguments(name, value)
            found[name] = Controller(value, None)
            continue
        if set(value) != {"value", "every"}:
            raise UsageError(f"input '{name}' is no controller", mend='write {"value": "-k*x", "every": 0.01}')
        every, law = seconds(value["every"]), value["value"]
        if not every > 0:
            raise UsageError(f"input '{name}': every {every:g} s makes no sense", mend="give a time above 0")
        if callable(law):
            _refuse_other_arguments(name, law)
        found[name] = Controller(law if callable(law) else law_of(model, law) or as_expression(law), every)
    return found


def _refuse_other_arguments(name: str, law: Callable[..., Any]) -> None:
    """Before the run, where Python can tell what a function takes."""
    try:
        takes = inspect.signature(law)
    except (TypeError, ValueError):
        return
    try:
        takes.bind(0.0, np.zeros(0))
    except TypeError:
        what = f"input '{name}' is given by a Python function of {takes}, and is called with (t, x)"
        raise UsageError(what, mend="a function of the time and the state x = (q, u)") from None


def with_controlled(model: Model, names: Sequence[str]) -> Model:
    """The model in which what controllers set are parameters."""
    left = {name: part for name, part in model.inputs.items() if name not in names}
    zero = Expression.number(0)
    more = {name: part_of_values(Parameter, {"value": zero, "unit": model.inputs[name].unit}) for name in names}
    return altered(model, inputs=Table(left), parameters=Table({**model.parameters, **more}))


@dataclass(frozen=True)
class _Control:
    """The controllers of one run.

    Args:
        places: of what they set, among the parameters.
        names: of x.
        known: the parameters' values by name.
    """

    controllers: Mapping[str, Controller]
    places: Mapping[str, int]
    names: tuple[str, ...]
    known: Mapping[str, float]

    def set_(self, p: np.ndarray, t: float, values: Mapping[str, float], due: Sequence[str]) -> np.ndarray:
        """p with what some controllers set at a state."""
        found, x = p.copy(), np.array([values[name] for name in self.names])
        state = {**self.known, **values}
        for name in due:
            found[self.places[name]] = self.controllers[name].value(t, state, x)
        return found

    def fed(self, names: Sequence[str]) -> Callable[[np.ndarray, float, np.ndarray], np.ndarray] | None:
        """(p, t, x) -> p with what the functions set, x the integrated state; None without functions."""
        due = [name for name, each in self.controllers.items() if each.every is None]
        if not due:
            return None
        kept = [names.index(name) for name in self.names]

        def found(p: np.ndarray, t: float, x: np.ndarray) -> np.ndarray:
            given = p.copy()
            for name in due:
                given[self.places[name]] = self.controllers[name].value(t, {}, x[kept])
            return given

        return found


def controlled_run(
    equations: Equations,
    controllers: Mapping[str, Controller],
    *,
    time: Typed,
    samples: int | Sequence[Typed],
    how: Stepping,
    target: str | None = None,
) -> Trajectory:
    """The motion of a model in which what controllers set are parameters.

    Raises:
        NotYet: a Python function sets an input, and contacts change.
    """
    model = equations.model
    time = seconds(time)
    refuse_bad_run(0.0, time, how)
    functions = [name for name, each in controllers.items() if each.every is None]
    if functions and has_phases(model):
        raise NotYet(
            f"'{functions[0]}' is set by a Python function, and contacts change", mend="an expression, or `every`"
        )
    models = phase_models(equations, parameter_vector(model), how, target)
    here = at_start(models, 0.0, None, None)
    instants = instants_of(samples, 0.0, time)
    plan = Plan(time, replace(how.of_one_step(), breakpoints=breakpoints_of(model), keeps=True), instants)
    phases = list(_phases(_control(models, here, controllers), models, here, plan))
    values = dict(zip(model.parameters, models.p.tolist(), strict=True))
    whole = WholeRun(model, [run for run, _, _ in phases], plan, values, [end for _, end, _ in phases])
    found = finished_run(equations, phases[-1][2], whole, how, instants)
    told = f"{', '.join(functions)} set by Python functions: stepped by scipy, one call of Python an evaluation."
    return replace(found, told=" ".join(filter(None, [told if functions else "", found.told])))


def _control(models: PhaseModels, here: PhaseStart, controllers: Mapping[str, Controller]) -> _Control:
    first, names = models.of(here.configuration), list(models.model.parameters)
    places = {name: names.index(name) for name in controllers}
    known = dict(zip(names, models.p.tolist(), strict=True))
    return _Control(controllers, places, (*first.coordinates, *first.shown), known)


def _phases(
    control: _Control, models: PhaseModels, here: PhaseStart, plan: Plan
) -> Iterator[tuple[PhaseRun, float, PhaseModels]]:
    """(a phase, up to when it was planned, its equations at the values that are held in it), one after the other."""
    first = models.of(here.configuration)
    p, fed = models.p, control.fed((*first.coordinates, *first.speeds))
    for start, end, due in _stretches(control.controllers, plan.end):
        p = control.set_(p, start, here.values, due)
        models = models.at(p, fed)
        here = after_jump(models, here)
        inside = None if plan.instants is None else plan.instants[(plan.instants >= start) & (plan.instants <= end)]
        for run in through(models, here, replace(plan, end=end, instants=inside)):
            yield run, end, models
        if run.run.status != "finished":
            return
        here = PhaseStart(end, run.end, run.here.configuration, begun=here.begun)


def _stretches(controllers: Mapping[str, Controller], time: float) -> Iterator[tuple[float, float, list[str]]]:
    """(start, end, those that are sampled at the start) of the times between two samples of any controller."""
    periods = {name: each.every for name, each in controllers.items() if each.every is not None}
    if sum(time / every for every in periods.values()) > MOST_SAMPLES:
        raise UsageError(f"more than {MOST_SAMPLES} samples of controllers", mend="a shorter run, or a longer `every`")
    instants = {0.0} | {k * every for every in periods.values() for k in range(1, math.ceil(time / every - SOLVED))}
    marks: list[float] = []
    for t in sorted(instants):
        if not marks or t - marks[-1] > SOLVED * time:
            marks.append(t)
    for start, end in zip(marks, [*marks[1:], time], strict=True):
        due = [
            name
            for name, every in periods.items()
            if abs(start / every - round(start / every)) * every <= SOLVED * time
        ]
        yield start, end, due
