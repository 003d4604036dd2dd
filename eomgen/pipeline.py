"""Model, contact modes -> Study -> Equations -> code -> Trajectory: all on one screen."""

from __future__ import annotations

import warnings
from collections.abc import Mapping, Sequence
from threading import get_ident
from typing import TYPE_CHECKING, Any

from eomgen.equations import Equations
from eomgen.errors import UsageError
from eomgen.frozen import recalled
from eomgen.mechanics.dynamics import METHODS
from eomgen.mechanics.kinematics import ContactModes
from eomgen.model import ModelOrPath, Requests, Typed, Values, WrittenEquation
from eomgen.resources import doing, growing
from eomgen.study import InverseDynamics, Study, model_to_study, study_of, study_of_modes
from eomgen.symbolic.numeric import tolerances

if TYPE_CHECKING:  # what moves is loaded where something moves
    from eomgen.model import Model
    from eomgen.runs import Runs, Simulator
    from eomgen.simulation import Trajectory


@growing()
@doing("the equations of motion")
def derive(
    model: ModelOrPath,
    method: str = "lagrange",
    contacts: ContactModes | None = None,
    *,
    parameters: Values | None = None,
    start: Values | None = None,
) -> Equations:
    """The equations of motion of a model; no certificate is made. Of one model they are derived once.

    Args:
        method: by which way they are derived, one of METHODS: energies, wrenches along the motions that are free, or
            these with every body cut free first.
        contacts: how the contacts are that can end, slide or stick, by constraint or body on a path, what is not named
            closed; None: as they are at the start. Assumptions about them are the equations' `assumptions`.
        parameters, start: values that replace the model's, each as `model_at` takes it.
    Raises:
        UsageError: an unknown method.
        NotYet: a kind that this version does not derive.
        DerivationError: the model has no equations of motion, or a force in it is unknown; by "kinetostatic", a body is
            unsupported, or a force has no point of application.
    """
    model = model_to_study(model, parameters, start)
    if method not in METHODS:
        raise UsageError(f"unknown method '{method}'", fix=f"one of {', '.join(METHODS)}")
    model.refuse_motion()
    if contacts is not None:
        return _derived(model, method, study_of_modes(model, contacts))
    return recalled(model, method, lambda: _derived(model, method, study_of(model)))


def _derived(model: Model, method: str, study: Study) -> Equations:
    if method == "kinetostatic":
        _ = study.reactions  # refuses joints and constraints that cannot carry the motion
    _ = study.derived  # what cannot be derived is refused here, not where a matrix is first read
    return Equations(model, method, study)


def inverse_dynamics(
    model: ModelOrPath,
    actuated: Sequence[str] = (),
    *,
    parameters: Values | None = None,
    start: Values | None = None,
) -> InverseDynamics:
    """The forces and torques that given accelerations take; see `Equations.inverse_dynamics`."""
    return derive(model, parameters=parameters, start=start).inverse_dynamics(actuated)


def simulator(
    model: ModelOrPath,
    *,
    rtol: float = tolerances.RUN,
    atol: float = tolerances.RUN,
    target: str | None = None,
    method: str = "auto",
    stabilization: str = "projection",
) -> Simulator:
    """`simulator(time=10, parameters=None, start=None, samples=101, columns=())` -> Trajectory: derived, compiled once.

    Args:
        rtol, atol, target, method, stabilization: as of `simulate`.
    """
    from eomgen.runs import Simulator
    from eomgen.simulation import Stepping

    how = Stepping(method=method, rtol=rtol, atol=atol, stabilization=stabilization)
    return Simulator(model_to_study(model), derive, how, target)


def simulate_many(
    model: ModelOrPath,
    *,
    time: Typed,
    parameters: Mapping[str, Any] | None = None,
    start: Mapping[str, Any] | None = None,
    inputs: Mapping[str, Any] | None = None,
    samples: int | Sequence[Typed] = 101,
    rtol: float = tolerances.RUN,
    atol: float = tolerances.RUN,
    method: str = "auto",
    target: str | None = None,
    threads: int = 1,
) -> Runs:
    """Many motions of one model, derived and compiled once; a run that fails is recorded, and the rest go on.

    A model without constraints and contacts is stepped in the lanes of vectors, each with its own steps; one with
    constraints by marches in C, a run after the other; where contacts change, and where a step needs a look, one by
    one.

    Args:
        time: how long, as of `simulate`.
        parameters, start, inputs: arrays, one number a run in SI, or what all runs share, as `simulate` takes it.
        samples, rtol, atol, method, target: as of `simulate`.
        threads: among which the runs are divided.
    """
    from eomgen.runs import many_runs

    run = simulator(model, rtol=rtol, atol=atol, target=target, method=method)
    requested = {"parameters": parameters, "start": start, "inputs": inputs}
    return many_runs(run, time=time, samples=samples, threads=threads, **requested)


def simulate(
    model: ModelOrPath,
    *,
    time: Typed,
    parameters: Values | None = None,
    start: Values | None = None,
    inputs: Mapping[str, Any] | None = None,
    rtol: float = tolerances.RUN,
    atol: float = tolerances.RUN,
    target: str | None = None,
    samples: int | Sequence[Typed] | None = None,
    method: str = "auto",
    stabilization: str = "projection",
    until: WrittenEquation | str | None = None,
) -> Trajectory:
    """The motion from the start values of the model. Of one model it is derived and compiled once in a thread.

    Args:
        time: how long: 5 s, "500 ms", (500, "ms") or a quantity of pint.
        parameters, start: values that replace the model's, each as `model_at` takes it.
        inputs: values that replace the model's: numbers, expressions of t, `eomgen.samples(times, values)`; feedback by
            an expression of the state ("-k*x - c*x'"), by {"value": law, "every": 0.01}, sampled and held, or by a
            Python function of (t, x), x = (q, u), which scipy steps.
        rtol, atol: tolerances of the integration; constraints are kept closed to a tenth of atol.
        target: of the emitted code: "numpy", "c", or None for the fastest there is.
        samples: how many instants are given, or the instants themselves, in SI or with a unit.
        method: "auto" is DOP853, and Radau where a motion is stiff; DOP853, RK45, RK23; Radau, BDF, LSODA; "taylor"
            goes by power series of the equations, which kinks do not have.
        stabilization: what keeps constraints closed: "projection", "baumgarte" or "none"; "energy" keeps the energy
            too.
        until: an equation such as "theta = 90 deg" or "reaction_n(wall) = 0": the end, where it first holds.
    Raises:
        MissingValues: parameters without a value, all named.
    """
    from eomgen.runs import OUTPUTS, REACTIONS, controlled_run, controllers_of, with_controlled

    model = model_to_study(model, parameters, start)
    controllers = controllers_of(model, inputs or {})
    model = Requests(model).with_inputs(
        {name: value for name, value in (inputs or {}).items() if name not in controllers}
    )
    if controllers:
        from eomgen.simulation import Stepping

        if until is not None:
            raise UsageError("a run with controllers ends with its time", fix="leave `until` out")
        equations = derive(with_controlled(model, tuple(controllers)))
        how = Stepping(method=method, rtol=rtol, atol=atol, stabilization=stabilization)
        found = controlled_run(equations, controllers, time=time, samples=samples, how=how, target=target)
        return _warned(model, found)
    run = recalled(
        model,
        (get_ident(), rtol, atol, target, method, stabilization),
        lambda: simulator(model, rtol=rtol, atol=atol, target=target, method=method, stabilization=stabilization),
    )
    found = run(time, samples=samples, columns=(REACTIONS, OUTPUTS), until=until)
    return _warned(model, found)


def _warned(model: Model, found: Trajectory) -> Trajectory:
    """The run; what is missing of it is a warning to the caller."""
    from eomgen.runs import cautions_of

    for problem in cautions_of(model, found):
        warnings.warn(f"{model.name}: {problem.where}: {problem.what}", RuntimeWarning, stacklevel=3)
    missing = found.known_remark
    if missing and (found.reactions or found.outputs):
        warnings.warn(f"{model.name}: {missing}", RuntimeWarning, stacklevel=3)
    return found
