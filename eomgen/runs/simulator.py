"""Equations -> Simulator: one motion after another, from other values and starts, with controllers.

The model is derived and compiled once. Many runs are given as arrays.
"""

from __future__ import annotations

import inspect
import math
from collections import OrderedDict
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import field, replace
from functools import cached_property
from typing import Any

import numpy as np

from eomgen.codegen import RightHandSide
from eomgen.equations import Equations
from eomgen.errors import DerivationError, ExpressionError, NotYet, RunFailed, UsageError
from eomgen.frozen import dataclass
from eomgen.model import (
    FUNCTIONS,
    Model,
    OutputSource,
    Parameter,
    Requests,
    Table,
    Typed,
    Valued,
    Values,
    WrittenEquation,
    nearest,
    seconds,
)
from eomgen.proof import Certificate, checked, rows_that_stay
from eomgen.runs.single_run import finished_run, phase_models, run
from eomgen.simulation import (
    DerivedAt,
    PhaseModels,
    PhaseRun,
    PhaseStart,
    Plan,
    Stepping,
    Trajectory,
    WholeRun,
    formulas_of,
    instants_of,
)
from eomgen.symbolic.expression import Expression, as_expression, parse
from eomgen.symbolic.numeric import tolerances

SAMPLES = 101
MOST_BASES = 4  # derivations that are tried first at other values, before the model is derived again
MOST_KEPT = 16  # models whose constraints or contacts were derived at other values of the parameters
REACTIONS, OUTPUTS = "reactions", "outputs"


@dataclass(frozen=True)
class Simulator:
    """simulator(time=10) -> Trajectory, again and again.

    A model is derived once for all values of its parameters at which the derivation is the same (see `DerivedAt`).
    Which constraints depend on one another may depend on the values; then the model is derived anew.

    Args:
        model: whose values hold where none are given.
        derive: model -> its equations.
        how: the integrator's way; its tolerances are those of the run.
        target: of the emitted code.
        known: equations and phases that were derived, by the values that they depend on.
        bases: derivations that may hold at other values.
    """

    model: Model
    derive: Callable[[Model], Equations] = field(repr=False)
    how: Stepping = Stepping()
    target: str | None = None
    known: OrderedDict[object, tuple[Equations, PhaseModels]] = field(default_factory=OrderedDict, repr=False)
    bases: list[KnownEquations] = field(default_factory=list, repr=False)

    def __call__(
        self,
        time: Typed = 10.0,
        parameters: Values | None = None,
        start: Values | None = None,
        samples: int | Sequence[Typed] | None = SAMPLES,
        columns: Sequence[str] = (),
        *,
        until: WrittenEquation | str | None = None,
    ) -> Trajectory:
        """The motion from the start values of the model.

        Args:
            time: how long, as `eomgen.simulate` takes it.
            parameters, start: values that replace the model's, as `eomgen.simulate` takes them.
            samples: how many instants are given, or the instants themselves, in SI or with a unit.
            columns: columns in addition to the states: names of reactions, "reactions" for all, names of outputs or
                formulas like them, "outputs" for all of the model.
            until: an equation: the end, where it first holds.
        Raises:
            MissingValues: parameters without a value, all named.
            UsageError: the request makes no sense.
        """
        valued = Valued.of(self.model, parameters, start)
        equations, models = self._at(valued)
        own = {} if equations.model is valued.model else given_parameters(valued.model)
        requested = (columns,) if isinstance(columns, str) else tuple(columns)
        formulas = _formulas(valued.model, requested)
        reactions = any(name not in formulas for name in requested if name != OUTPUTS)
        found = run(
            equations,
            time=seconds(time),
            parameters=own,
            start=valued.start,
            samples=samples,
            how=self.how,
            until=until,
            models=models,
            reactions=reactions,
            outputs=None if OUTPUTS in requested and formulas == formulas_of(valued.model) else formulas,
        )
        return found if not reactions or REACTIONS in requested else _with_columns(found, requested, formulas)

    def prepared(self, parameters: Values, start: Values) -> None:
        """Derives and compiles what a run from these values needs."""
        self._at(Valued.of(self.model, parameters, start))

    def _at(self, valued: Valued) -> tuple[Equations, PhaseModels]:
        """The equations, and their phases, at the values of a model."""
        if valued.model is self.model:
            return self._own
        if self.keeps_start:
            return self._found(valued)
        return self._found(replace(valued, model=self.model.altered(parameters=valued.model.parameters)))

    @cached_property
    def _own(self) -> tuple[Equations, PhaseModels]:
        """Equations and phases at the model's own values."""
        return self._found(Valued(self.model))

    def _found(self, valued: Valued) -> tuple[Equations, PhaseModels]:
        model, known = valued.model, self.known
        key = (model.parameters, model.coordinates, model.speeds, model.states)
        if key not in known:
            known[key] = self._shared(valued) or self._derived(model)
            if len(known) > MOST_KEPT:
                known.popitem(last=False)
        return known[key]

    def _shared(self, valued: Valued) -> tuple[Equations, PhaseModels] | None:
        """Equations that were derived at other values, where these are the same; None where there are none."""
        p = RightHandSide.parameter_values(valued.model)
        for base in self.bases:
            models = base.models.at(p)
            if base.holds(models, valued):
                return base.equations, models
        return None

    def _derived(self, model: Model) -> tuple[Equations, PhaseModels]:
        """The equations of a model, derived at its values."""
        anew = self.is_constrained or self.keeps_start
        equations = self.derive(model) if anew else self.equations
        models = phase_models(equations, RightHandSide.parameter_values(model), self.how, self.target)
        if len(self.bases) < MOST_BASES:
            self.bases.append(KnownEquations(equations, models, self.keeps_start and self._follows_start))
        return equations, models

    @cached_property
    def _follows_start(self) -> bool:
        """True if the equations depend on the start: a slack length, or the value of a constraint, is taken from it."""
        elements = (force.element for force in self.model.forces.values())
        if any(each.slack == "start" for each in elements if each is not None):
            return True
        return bool(rows_that_stay(self.equations.graph.system))

    @cached_property
    def equations(self) -> Equations:
        """Equations of the model at its own values."""
        return self.derive(self.model)

    @property
    def is_constrained(self) -> bool:
        """True if the derivation may depend on the values of parameters: the model has constraints or contacts."""
        return self.model.has_phases or bool(self.equations.graph.system.constraints.rows)

    @property
    def keeps_start(self) -> bool:
        """True if the derivation depends on the start: contacts, constraints and springs that keep a length."""
        return self.model.has_phases or self._follows_start


@dataclass(frozen=True)
class KnownEquations:
    """Equations and phases as they were derived at values of a model.

    Args:
        follows_start: True if another start has other equations.
    """

    equations: Equations
    models: PhaseModels
    follows_start: bool

    def holds(self, models: PhaseModels, valued: Valued) -> bool:
        """True if the derivation holds at other values too.

        Args:
            models: these phases at the other values of the parameters.
            valued: the model with the other values and start.
        """
        system, own = self.equations.graph.system, self.equations.model
        model, p = valued.model, models.p[None, :]
        given = () if self.follows_start else {name.rstrip("'") for name in valued.start}
        tables = tuple((getattr(model, key), getattr(own, key)) for key in ("coordinates", "speeds", "states"))
        if any(part != there[name] for here, there in tables for name, part in here.items() if name not in given):
            return False
        derived = self.derived
        places = derived.declared.many(0.0, np.zeros((1, len(system.symbols.x))), p)
        for k, q in enumerate(system.symbols.q):
            places[0, k] = valued.start.get(q.name, places[0, k])
        if not derived.holds(p, places)[0]:
            return False
        if not derived.requests(p)[0]:
            return True
        try:
            here = PhaseStart.of(models, 0.0, given_parameters(model), valued.start)
        except DerivationError:
            return False
        return bool(derived.is_regular(p, models.of(here.configuration).state(here.values)[None, :])[0])

    @cached_property
    def derived(self) -> DerivedAt:
        return DerivedAt(self.equations.graph.system, self.models.p, self.equations.model.has_phases)


def given_parameters(model: Model) -> dict[str, Expression]:
    """Values of all parameters that have one, which replace those of the derived model."""
    return {name: part.value for name, part in model.parameters.items() if part.value is not None}


def _formulas(model: Model, requested: tuple[str, ...]) -> dict[str, Expression]:
    """Formulas by requested name: outputs of the model, and formulas that are not one reaction alone."""
    found = formulas_of(model) if OUTPUTS in requested else {}
    for name in requested:
        if name in model.outputs:
            found[name] = model.outputs[name].value
        elif name not in (OUTPUTS, REACTIONS) and not _is_reaction(name):
            try:
                found[name] = Requests(model).output(name).value
            except UsageError as error:
                raise UsageError(
                    f"no column {error.what}", fix=f"a reaction, an output, a formula, '{REACTIONS}'"
                ) from error
    return found


def _is_reaction(text: str) -> bool:
    """True if the text is one function of reactions; its column stands among the reactions by this name."""
    try:
        call = parse(text, references=True).call
    except ExpressionError:
        return False
    return call is not None and call.name in FUNCTIONS and FUNCTIONS[call.name].source == OutputSource.BALANCE


def _with_columns(found: Trajectory, requested: tuple[str, ...], formulas: Mapping[str, Expression]) -> Trajectory:
    """The run with these reactions alone."""
    names = [name for name in requested if name not in formulas and name != OUTPUTS]
    for name in names:
        if name not in found.reactions:
            raise UsageError(f"no column '{name}'", fix=nearest(name, found.reactions) or f"ask for '{REACTIONS}'")
    return replace(found, reactions={name: found.reactions[name] for name in names})


# -------- controlled ------------------------------------------------------------------------------------------
# Equations, controllers -> Trajectory: inputs by a law of the state that is sampled and held, or by a Python
# function.
#
# What a controller sets is a parameter of the equations: held, it changes at the controller's instants alone, and
# between two of them the motion goes on in the compiled march with another value of it. A Python function of (t, x)
# is called at every evaluation: scipy steps, and no step is compiled.


ControlLaw = Callable[[float, np.ndarray], float]
"""(t, x) -> the input, x = (q, u)"""
MOST_SAMPLES = 1_000_000  # of a controller in a run


@dataclass(frozen=True)
class Controller:
    """Controller of one input.

    Args:
        law: (t, x) -> value, or an expression of the state.
        every: it is sampled so often, and held [s]; None: a function that is called at every evaluation.
    """

    law: ControlLaw | Expression
    every: float | None

    def value(self, t: float, state: Mapping[str, float], x: np.ndarray) -> float:
        """Value of the input at a state.

        Args:
            state: values by name, for an expression.
            x: the same state as (q, u), for a function.
        Raises:
            RunFailed: no number.
        """
        law = self.law
        found = law.evaluate({**state, "t": t, "pi": math.pi}) if isinstance(law, Expression) else law(t, x)
        value = float(np.asarray(found, dtype=float).reshape(()))
        if not math.isfinite(value):
            raise RunFailed(f"a controller gives {value} at t = {t:.6g} s", fix="return a finite number")
        return value


def controllers_of(model: Model, inputs: Mapping[str, Any]) -> dict[str, Controller]:
    """Controllers among the inputs: functions, and tables {"value": law, "every": time}.

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
            raise UsageError(f"there is no input '{name}'", fix=nearest(name, model.inputs))
        if not held:
            _refuse_other_arguments(name, value)
            found[name] = Controller(value, None)
            continue
        if set(value) != {"value", "every"}:
            raise UsageError(f"input '{name}' is no controller", fix='write {"value": "-k*x", "every": 0.01}')
        every, law = seconds(value["every"]), value["value"]
        if not every > 0:
            raise UsageError(f"input '{name}': every {every:g} s makes no sense", fix="give a time above 0")
        if callable(law):
            _refuse_other_arguments(name, law)
        found[name] = Controller(law if callable(law) else Requests(model).feedback(law) or as_expression(law), every)
    return found


def _refuse_other_arguments(name: str, law: Callable[..., Any]) -> None:
    """Refuses a function that cannot be called with (t, x), where Python knows its arguments.

    Raises:
        UsageError: the function takes other arguments.
    """
    try:
        takes = inspect.signature(law)
    except (TypeError, ValueError):
        return
    try:
        takes.bind(0.0, np.zeros(0))
    except TypeError:
        what = f"input '{name}' is given by a Python function of {takes}, and is called with (t, x)"
        raise UsageError(what, fix="a function of the time and the state x = (q, u)") from None


def with_controlled(model: Model, names: Sequence[str]) -> Model:
    """Model in which the inputs that controllers set are parameters."""
    left = {name: part for name, part in model.inputs.items() if name not in names}
    zero = Expression.number(0)
    more = {name: Parameter.of_values({"value": zero, "unit": model.inputs[name].unit}) for name in names}
    return model.altered(inputs=Table(left), parameters=Table({**model.parameters, **more}))


@dataclass(frozen=True)
class _Control:
    """The controllers of one run.

    Args:
        places: index, among the parameters, of each input that they set.
        names: of x.
        known: the parameters' values by name.
    """

    controllers: Mapping[str, Controller]
    places: Mapping[str, int]
    names: tuple[str, ...]
    known: Mapping[str, float]

    def set_(self, p: np.ndarray, t: float, values: Mapping[str, float], due: Sequence[str]) -> np.ndarray:
        """Parameters p with the values that the controllers `due` set at a state."""
        found, x = p.copy(), np.array([values[name] for name in self.names])
        state = {**self.known, **values}
        for name in due:
            found[self.places[name]] = self.controllers[name].value(t, state, x)
        return found

    def fed(self, names: Sequence[str]) -> Callable[[np.ndarray, float, np.ndarray], np.ndarray] | None:
        """Function (p, t, x) -> p with the values set by Python functions, x the integrated state; None without any."""
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
    samples: int | Sequence[Typed] | None,
    how: Stepping,
    target: str | None = None,
) -> Trajectory:
    """Motion of a model in which the inputs set by controllers are parameters.

    Raises:
        NotYet: a Python function sets an input, and contacts change.
    """
    model = equations.model
    time = seconds(time)
    how.refuse_bad_run(0.0, time)
    functions = [name for name, each in controllers.items() if each.every is None]
    if functions and model.has_phases:
        raise NotYet(
            f"'{functions[0]}' is set by a Python function, and contacts change", fix="an expression, or `every`"
        )
    models = phase_models(equations, RightHandSide.parameter_values(model), how, target)
    here = PhaseStart.of(models, 0.0, None, None)
    instants = instants_of(samples, 0.0, time)
    plan = Plan(time, replace(how.of_one_step(), breakpoints=model.breakpoints, keeps=True), instants)
    phases = list(_phases(_control(models, here, controllers), models, here, plan))
    values = dict(zip(model.parameters, models.p.tolist(), strict=True))
    whole = WholeRun(model, [run for run, _, _ in phases], plan, values, [end for _, end, _ in phases])
    found = finished_run(equations, phases[-1][2], whole, how, instants)
    reported = f"{', '.join(functions)} set by Python functions: stepped by scipy, one call of Python an evaluation."
    return replace(found, reported=" ".join(filter(None, [reported if functions else "", found.reported])))


def _control(models: PhaseModels, here: PhaseStart, controllers: Mapping[str, Controller]) -> _Control:
    first, names = models.of(here.configuration), list(models.model.parameters)
    places = {name: names.index(name) for name in controllers}
    known = dict(zip(names, models.p.tolist(), strict=True))
    return _Control(controllers, places, (*first.coordinates, *first.shown, *first.states), known)


def _phases(
    control: _Control, models: PhaseModels, here: PhaseStart, plan: Plan
) -> Iterator[tuple[PhaseRun, float, PhaseModels]]:
    """Phases in order: (phase, time up to which it was planned [s], equations at the input values held in it)."""
    first = models.of(here.configuration)
    p, fed = models.p, control.fed(first.moving)
    for start, end, due in _stretches(control.controllers, plan.end):
        p = control.set_(p, start, here.values, due)
        models = models.at(p, fed)
        here = here.after_jump(models)
        inside = None if plan.instants is None else plan.instants[(plan.instants >= start) & (plan.instants <= end)]
        for phase in replace(plan, end=end, instants=inside).through(models, here):
            yield phase, end, models
        if phase.run.status != "finished":
            return
        here = PhaseStart(end, phase.end, phase.here.configuration, begun=here.begun)


def _stretches(controllers: Mapping[str, Controller], time: float) -> Iterator[tuple[float, float, list[str]]]:
    """Intervals between two samples of any controller: (start [s], end [s], controllers sampled at the start)."""
    periods = {name: each.every for name, each in controllers.items() if each.every is not None}
    if sum(time / every for every in periods.values()) > MOST_SAMPLES:
        raise UsageError(f"more than {MOST_SAMPLES} samples of controllers", fix="a shorter run, or a longer `every`")
    instants = {0.0} | {
        k * every for every in periods.values() for k in range(1, math.ceil(time / every - tolerances.SOLVED))
    }
    marks: list[float] = []
    for t in sorted(instants):
        if not marks or t - marks[-1] > tolerances.SOLVED * time:
            marks.append(t)
    for start, end in zip(marks, [*marks[1:], time], strict=True):
        due = [
            name
            for name, every in periods.items()
            if abs(start / every - round(start / every)) * every <= tolerances.SOLVED * time
        ]
        yield start, end, due


# -------- runs ------------------------------------------------------------------------------------------------
# Results of many motions of one model, as arrays, a DataFrame or a Dataset.


@dataclass(frozen=True, eq=False, repr=False)
class Runs:
    """Many motions of one model.

    Args:
        t: the instants, k [s].
        x: states (q, u), runs x k x states; nan at all instants of a run that failed.
        names: of the coordinates and speeds.
        status: "finished", or why a run failed; message: the same as a sentence.
        steps: number of steps of each run.
        given: values that differ from run to run, by name, one a run.
        proof: -> the certificate of the equations; None after unpickling.
        drifts: (t, x) -> drift of the energy of each run; None where the energy is not conserved.
    """

    t: np.ndarray
    x: np.ndarray
    names: tuple[str, ...]
    status: np.ndarray
    message: np.ndarray
    steps: np.ndarray
    given: Mapping[str, np.ndarray]
    proof: Callable[[], Certificate] | None = field(repr=False)
    drifts: Callable[[np.ndarray, np.ndarray], np.ndarray] | None = field(default=None, repr=False)

    def __getstate__(self) -> dict[str, Any]:
        """All numbers, the drift included; the equations are not pickled."""
        own = {name: self.__dict__[name] for name in self.__dataclass_fields__}
        return own | {"drift": self.drift, "drifts": None, "proof": None}

    def __len__(self) -> int:
        return len(self.x)

    def __getitem__(self, name: str) -> np.ndarray:
        """A coordinate or speed, runs x instants."""
        if name not in self.names:
            raise KeyError(f"no column '{name}'; there are {', '.join(self.names)}")
        return np.asarray(self.x[:, :, self.names.index(name)])

    @cached_property
    def drift(self) -> np.ndarray | None:
        """Largest |E - E(0)| of each run, relative to the energy exchanged; None where energy is not conserved."""
        return None if self.drifts is None else self.drifts(self.t, self.x)

    def certify(self) -> Certificate:
        """The proof of the equations that all runs share.

        Raises:
            UsageError: the runs were unpickled, without their equations.
        """
        if self.proof is None:
            raise UsageError(Trajectory.NO_EQUATIONS, fix="take eomgen.simulate_many(model), in the process that asks")
        finished = self.status == "finished"
        whole = np.isfinite(self.x).all(axis=(1, 2))
        lost = [str(k) for k in np.flatnonzero(finished != whole)]
        wrong = f"not in run {', '.join(lost[:3])}" if lost else ""
        more = [checked("runs that are finished have numbers at all instants", wrong, "every run")]
        return self.proof() + more

    def to_pandas(self) -> Any:
        """All runs as one DataFrame over (run, t) (needs pandas)."""
        import pandas

        index = pandas.MultiIndex.from_product([range(len(self)), self.t], names=["run", "t"])
        return pandas.DataFrame(self.x.reshape(-1, len(self.names)), index=index, columns=list(self.names))

    def to_xarray(self) -> Any:
        """A Dataset over (run, time) (needs xarray)."""
        import xarray

        columns = {name: (("run", "time"), self[name]) for name in self.names}
        of_runs = {"status": self.status, "message": self.message, "steps": self.steps, **self.given}
        reported = {name: ("run", np.asarray(values)) for name, values in of_runs.items()}
        return xarray.Dataset({**columns, **reported}, coords={"run": np.arange(len(self)), "time": self.t})

    def __repr__(self) -> str:
        failed = int(np.sum(self.status != "finished"))
        return f"<{len(self)} runs of {', '.join(self.names)}: {len(self.t)} instants, {failed} failed>"
