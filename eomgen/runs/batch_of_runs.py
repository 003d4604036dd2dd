"""Simulator, values of many runs -> Runs: in lanes of vectors or in marches where the model allows it, else one by one.

A run that is stiff, comes near a singular position, or has equations or a start of its own is run alone.
"""

from __future__ import annotations

import contextvars
from collections.abc import Iterable, Mapping, Sequence
from concurrent.futures import ThreadPoolExecutor
from dataclasses import replace
from functools import partial
from typing import Any

import numpy as np

from eomgen.codegen import RightHandSide
from eomgen.errors import EomgenError, ExpressionError, UsageError
from eomgen.frozen import dataclass, with_fields
from eomgen.mechanics.start import Start
from eomgen.model import (
    Model,
    Parameter,
    Requests,
    Table,
    Typed,
    TypedNumbers,
    Valued,
    are_several,
    nearest,
    seconds,
    typed_values,
)
from eomgen.proof import Promise
from eomgen.resources import check_patience, doing
from eomgen.runs.simulator import SAMPLES, KnownEquations, Runs, Simulator
from eomgen.simulation import FoundRuns, ManyRuns, PhaseModel, PhaseModels, instants_of
from eomgen.symbolic.expression import Expression

OfRuns = Mapping[str, Any]
"""Values by name: arrays, one number a run, or what all runs share."""


@dataclass(frozen=True)
class _Plan:
    """Values that differ from run to run, and what all runs share.

    Args:
        simulator: of the model with all that the runs share.
        parameters, start: an array for each name.
        time, instants: of all runs.
    """

    simulator: Simulator
    runs: int
    parameters: Mapping[str, np.ndarray]
    start: Mapping[str, np.ndarray]
    time: float
    instants: np.ndarray

    @property
    def model(self) -> Model:
        return self.simulator.model

    def of(self, i: int) -> tuple[dict[str, float], dict[str, float]]:
        """(parameters, start) of one run."""
        parameters, start = ({n: float(v[i]) for n, v in each.items()} for each in (self.parameters, self.start))
        return parameters, start


@doing("the runs")
def many_runs(
    simulator: Simulator,
    *,
    time: Typed,
    parameters: OfRuns | None = None,
    start: OfRuns | None = None,
    inputs: OfRuns | None = None,
    samples: int | Sequence[float] = SAMPLES,
    threads: int = 1,
) -> Runs:
    """The runs, each as `simulator(time, parameters, start)` gives it; a run that fails does not stop the rest.

    Raises:
        UsageError: an unknown name, arrays of several lengths, values that are not finite numbers.
    """
    how = simulator.how
    time = seconds(time)
    how.refuse_bad_run(0.0, time)
    if threads < 1:
        raise UsageError(f"{threads} threads make no sense", fix="give 1 or more")
    plan = _planned(simulator, time, parameters or {}, start or {}, inputs or {}, samples)
    found = _in_lanes(plan, threads) or _in_marches(plan, threads) or _in_phases(plan, threads)
    found = found or _one_by_one(plan, range(plan.runs), threads)
    names, status, message, x, steps = found
    x[status != "finished"] = np.nan
    equations, phase = _known(plan.simulator)
    if not plan.model.has_phases and names == phase.moving:
        why = _contradictions(plan, phase, x, steps)
        status = np.where(why != "", "contradicted", status)
        message = np.where(why != "", why, message)
        x[why != ""] = np.nan
    given = {**plan.parameters, **plan.start}
    drifts = _runs_of(plan, phase, threads).drifts if phase.conservative and not plan.model.has_phases else None
    return Runs(plan.instants, x, names, status, message, steps, given, equations.certify, drifts)


def _planned(
    simulator: Simulator, time: float, parameters: OfRuns, start: OfRuns, inputs: OfRuns, samples: int | Sequence[float]
) -> _Plan:
    """Plan of the runs: the model with the values that all share, and the arrays of the others."""
    arrays = {kind: {name: _array(simulator.model, name, v) for name, v in given.items() if are_several(v)}
        for kind, given in (("parameters", parameters), ("start", start), ("inputs", inputs))}  # fmt: skip
    sizes = {name: len(values) for each in arrays.values() for name, values in each.items()}
    if len(set(sizes.values())) > 1:
        reported = ", ".join(f"'{name}' {size}" for name, size in sizes.items())
        raise UsageError(f"arrays of several lengths: {reported}", fix="give one value a run to each")
    shared = [{n: v for n, v in given.items() if n not in arrays[kind]} for kind, given in (
        ("parameters", parameters), ("start", start))]  # fmt: skip
    model = Requests(simulator.model).with_inputs({n: v for n, v in inputs.items() if n not in arrays["inputs"]})
    model = Valued.of(model, *shared).model
    first = {kind: {n: float(v[0]) for n, v in each.items()} for kind, each in arrays.items() if kind != "inputs"}
    Valued.of(model, first["parameters"], first["start"])  # refuses what there is not
    model, of_inputs = _inputs_as_parameters(model, arrays["inputs"])
    instants = instants_of(samples, 0.0, time)
    changed = replace(simulator, model=model, known=type(simulator.known)())
    own = changed if shared[0] or shared[1] or inputs else simulator
    runs = next(iter(sizes.values()), 1)
    return _Plan(own, runs, {**arrays["parameters"], **of_inputs}, arrays["start"], time, instants)


def _array(model: Model, name: str, value: Any) -> np.ndarray:
    """Values of one name, one a run, in SI units."""
    typed = TypedNumbers(model, name, declared=False)
    try:
        plain = isinstance(value, np.ndarray) and value.dtype.kind in "fiu"
        found = np.asarray(value, dtype=float) if plain else np.array([typed.number(x) for x in typed_values(value)])
    except (ValueError, TypeError, ExpressionError) as error:
        what, fix = (error.what, error.fix) if isinstance(error, ExpressionError) else ("they are no numbers", "")
        raise UsageError(f"the values of '{name}': {what}", fix=fix) from error
    if not len(found) or not np.all(np.isfinite(found)):
        raise UsageError(f"the values of '{name}' must be finite numbers, one a run", fix="leave out what is not")
    return found


def _inputs_as_parameters(model: Model, inputs: Mapping[str, np.ndarray]) -> tuple[Model, dict[str, np.ndarray]]:
    """Model in which each input that differs from run to run is a parameter, and the values of these parameters."""
    found, added = {}, {}
    for name, values in inputs.items():
        if name not in model.inputs:
            raise UsageError(f"there is no input '{name}'", fix=nearest(name, model.inputs))
        own = f"{name}_given"
        while own in model.parameters:
            own += "_"
        added[own], found[own] = Parameter(), values
    if not added:
        return model, found
    model = model.altered(parameters=Table({**model.parameters, **added}))
    return Requests(model).with_inputs(dict(zip(inputs, added, strict=True))), found


# -- in lanes ------------------------------------------------------------------------------------------


Reported = tuple[tuple[str, ...], np.ndarray, np.ndarray, np.ndarray, np.ndarray]
"""names, status, message, x, steps."""


def _known(simulator: Simulator) -> tuple[Any, PhaseModel]:
    """Equations, and the phase that has the coordinates and speeds of the start."""
    equations = simulator.equations
    p = np.zeros(len(equations.graph.symbols.parameters))
    return equations, PhaseModels.one_phase(equations.graph.system, equations.graph, p, simulator.target)


def _in_lanes(plan: _Plan, threads: int) -> Reported | None:
    """All runs in lanes; None where the model, the method or the machine does not allow it."""
    simulator = plan.simulator
    if simulator.is_constrained or simulator.keeps_start or simulator.target == "numpy":
        return None
    if not simulator.how.is_in_lanes:
        return None
    equations, phase = _known(simulator)
    runs, required = _runs_of(plan, phase, threads), simulator.target == "c"
    found = runs.in_lanes(lambda: _starts(plan, phase, equations), required=required)
    return None if found is None else _completed(plan, found, threads)


def _runs_of(plan: _Plan, phase: PhaseModel, threads: int) -> ManyRuns:
    how = with_fields(plan.simulator.how.of_one_step(), breakpoints=plan.model.breakpoints)
    return ManyRuns(phase, how, plan.instants, plan.time, partial(_parameters, plan), threads)


def _completed(plan: _Plan, found: FoundRuns, threads: int, alone: Reported | None = None) -> Reported:
    """The runs, with those that are run alone.

    Args:
        alone: these, where they have been run.
    """
    x, status, message, steps = found.x, found.status, found.message, found.steps
    if len(found.alone):
        reported = alone or _one_by_one(plan, found.alone.tolist(), threads)
        _, status[found.alone], message[found.alone], x[found.alone], steps[found.alone] = reported
    return found.names, status.astype(str), message, x, steps.astype(int)


# -- in marches ----------------------------------------------------------------------------------------


def _in_marches(plan: _Plan, threads: int) -> Reported | None:
    """All runs in marches, those that are not finished so one by one; None where model or method does not allow it."""
    simulator = plan.simulator
    if not simulator.how.is_in_marches or plan.model.has_phases or simulator.target == "numpy":
        return None
    base = _base(plan)
    if base is None:
        return None
    found = _runs_of(plan, base.models.only, threads).in_marches(base.derived, plan.start)
    return None if found is None else _completed(plan, found, threads)


def _in_phases(plan: _Plan, threads: int) -> Reported | None:
    """All runs of a model whose contacts change, those that are left one by one; None where it does not go."""
    simulator = plan.simulator
    if not (simulator.how.is_in_marches and plan.model.has_phases) or simulator.target == "numpy":
        return None
    base = _base(plan)
    if base is None:
        return None
    parameters, start = plan.of(0)
    models = base.models.at(RightHandSide.parameter_values(plan.model, parameters))
    try:
        found = _runs_of(plan, _known(simulator)[1], threads).in_phases(models, start, base.derived, plan.start)
    except EomgenError:  # the first run says why
        return None
    if found is None or len(found.alone) == plan.runs:
        return None
    if not len(found.alone):
        return _completed(plan, found, threads)
    reported = _one_by_one(plan, found.alone.tolist(), threads)
    return _completed(plan, found, threads, reported) if reported[0] == found.names else None


def _base(plan: _Plan) -> KnownEquations | None:
    """The equations of the first run; None where they cannot be derived, or do not hold at other starts."""
    try:
        plan.simulator.prepared(*plan.of(0))
    except EomgenError:
        return None
    base = next(iter(plan.simulator.bases), None)
    return None if base is None or (base.follows_start and plan.start) else base


def _parameters(plan: _Plan) -> np.ndarray:
    """Parameters of every run, runs x parameters; those that are formulas of others are evaluated for each run."""
    model = plan.model
    names = list(model.parameters)
    follow = any(_names(part.value) & plan.parameters.keys() for part in model.parameters.values())
    if follow:
        return np.array([RightHandSide.parameter_values(model, plan.of(i)[0]) for i in range(plan.runs)])
    first = RightHandSide.parameter_values(model, plan.of(0)[0])
    found = np.tile(first, (plan.runs, 1))
    for name, values in plan.parameters.items():
        found[:, names.index(name)] = values
    return found


def _starts(plan: _Plan, phase: PhaseModel, equations: Any) -> np.ndarray:
    """States at the start, runs x states."""
    model, system = plan.model, phase.declared
    parts = [*model.coordinates.values()]
    written = [each for part in parts for each in (part.start, part.speed, part.rate, part.motion, part.near)]
    written += [part.start for part in model.states.values()]
    varied = plan.parameters.keys() | _following(model, plan.parameters)
    follow = any(_names(each) & varied for each in written) or bool(model.speeds or system.scope.quaternions)
    if follow:
        rows = []
        for i in range(plan.runs):
            parameters, start = plan.of(i)
            rows.append(phase.state(Start.of(system, parameters, start).values))
        return np.array(rows)
    names = [*phase.moving]
    parameters, start = plan.of(0)
    found = np.tile(phase.state(Start.of(system, parameters, start).values), (plan.runs, 1))
    for name, values in plan.start.items():
        found[:, names.index(name)] = values
    return found


def _following(model: Model, varied: Mapping[str, Any]) -> set[str]:
    """Parameters whose formulas contain parameters that differ from run to run."""
    return {name for name, part in model.parameters.items() if _names(part.value) & varied.keys()}


def _names(expression: Expression | None) -> frozenset[str]:
    return frozenset() if expression is None else frozenset(expression.names)


def _contradictions(plan: _Plan, phase: PhaseModel, x: np.ndarray, steps: np.ndarray) -> np.ndarray:
    """Contradiction of each run in words; "" without one.

    Energy where it is constant, constraints and norms of quaternions are compared with the limits of one run:
    10 (rtol size + atol) for each step taken; for constraints, onto which each step is projected, for one step.
    """
    how, (runs, instants) = plan.simulator.how, x.shape[:2]
    t, p = np.tile(plan.instants, runs), np.repeat(_parameters(plan), instants, axis=0)
    promises = [Promise(how.rtol, how.atol, int(n), how.stabilization == "projection") for n in steps]
    size = np.max(np.abs(x[:, :, : len(phase.coordinates + phase.speeds)]), axis=(1, 2), initial=0.0)
    found = np.full(runs, "", dtype=object)

    def judge(what: str, left: np.ndarray, limits: Iterable[float]) -> None:
        for i in np.flatnonzero((found == "") & (left > np.array([*limits]))):
            found[i] = f"Contradicted: {what} by {left[i]:.1e}."

    with np.errstate(all="ignore"):
        rows = x.reshape(runs * instants, -1)
        if phase.conservative:
            T, V = phase.functions.energies.many(t, rows, p).T.reshape(2, runs, instants)
            E, moving = T + V, np.max(np.abs(T) + np.abs(V - V[:, :1]), axis=1, initial=0.0)
            drift = np.max(np.abs(E - E[:, :1]), axis=1, initial=0.0)
            judge("the energy, which is constant, changes", drift, map(Promise.limit, promises, moving))
        if phase.projection is not None:
            gaps = phase.projection.gaps.many(t, rows[:, : phase.projection.size], p).reshape(runs, -1)
            judge("constraints are open", np.max(np.abs(gaps), axis=1, initial=0.0), map(Promise.open, promises, size))
        for four in phase.functions.rhs.unit_quaternions:
            norms = np.sum(x[:, :, list(four)] ** 2, axis=2)
            judge("a quaternion's norm changes", np.max(np.abs(norms - 1), axis=1), (q.limit(1.0) for q in promises))
    return found


# -- one by one ----------------------------------------------------------------------------------------


def _one_by_one(plan: _Plan, which: Sequence[int], threads: int) -> Reported:
    """The runs of these numbers, each by the simulator of one run."""
    context = contextvars.copy_context()

    def run(i: int) -> tuple[tuple[str, ...], str, str, np.ndarray | None, int]:
        check_patience()
        parameters, start = plan.of(i)
        try:
            found = plan.simulator(plan.time, parameters, start, samples=plan.instants.tolist())
        except EomgenError as error:
            return (), "refused", str(error), None, 0
        whole = found.status == "finished" and len(found.t) == len(plan.instants)
        names = found.moving
        return names, found.status, found.message, found.x if whole else None, found.steps

    if threads == 1 or len(which) < 2:
        reported = list(map(run, which))
    else:
        run(which[0])  # derives and compiles, once
        with ThreadPoolExecutor(threads) as pool:
            reported = list(pool.map(lambda i: context.copy().run(run, i), which))
    phase = _known(plan.simulator)[1]
    names = next((each[0] for each in reported if each[3] is not None), phase.coordinates + phase.shown + phase.states)
    x = np.full((len(reported), len(plan.instants), len(names)), np.nan)
    for row, each in zip(x, reported, strict=True):
        if each[3] is not None and each[0] == names:
            row[:] = each[3]
    status, message = (np.array([each[k] for each in reported], dtype=object) for k in (1, 2))
    return names, status.astype(str), message, x, np.array([each[4] for each in reported], dtype=int)
