"""Model -> Equations -> RightHandSide -> Trajectory: the whole journey on one screen."""

from __future__ import annotations

import warnings
from collections.abc import Callable, Mapping
from typing import Any

import numpy as np

from eomgen.codegen.program import program_of
from eomgen.codegen.rhs import RightHandSide, compiled, parameter_vector
from eomgen.equations import Equations
from eomgen.errors import UsageError
from eomgen.mechanics.closure import gaps_of
from eomgen.mechanics.formulations import recursive
from eomgen.mechanics.freedom import rank_of_ties
from eomgen.mechanics.friction import with_friction
from eomgen.mechanics.gimbal import locks_of
from eomgen.mechanics.reactions import reactions_of
from eomgen.mechanics.system import system_of
from eomgen.mechanics.wellposed import is_conservative
from eomgen.model.parts import Model
from eomgen.model.unknowns import refuse_motion
from eomgen.simulation.contacts import has_phases
from eomgen.simulation.course import modes_at_start
from eomgen.simulation.independence import Independence
from eomgen.simulation.integrate import SAMPLES, integrate
from eomgen.simulation.phases import run_phases
from eomgen.simulation.reaction_columns import with_reactions
from eomgen.simulation.singular import ended_where_singular
from eomgen.simulation.stepping import Stepping
from eomgen.simulation.trajectory import Trajectory

METHODS = ("lagrange", "projection", "kinetostatic")
CHOOSE = "declare other speeds"
LOCKED = "gimbal lock: choose another `orientation`, or a quaternion"


def derive(model: Model, method: str = "lagrange") -> Equations:
    """The equations of motion of a model; no certificate is made.

    Contacts that can end are closed, but those that are open at the start; what rubs pushes as it does at the start.

    Args:
        method: by which the derivation is written, one of METHODS.
    Raises:
        UsageError: an unknown method.
        NotYet: a kind that this version does not derive.
        DerivationError: the model has no equations of motion, or a force in it is unknown; by "kinetostatic", a body is
            held by nothing, or a force acts at no place.
    """
    if method not in METHODS:
        raise UsageError(f"unknown method '{method}'", mend=f"one of {', '.join(METHODS)}")
    refuse_motion(model)
    system = system_of(model, modes_at_start(model))
    if method == "kinetostatic":
        reactions_of(system)  # refuses joints and ties that cannot carry the motion
    return Equations(model, method, system, with_friction(system, recursive.assemble(system)))


def simulate(
    model: Model,
    *,
    time: float,
    parameters: Mapping[str, float] | None = None,
    start: Mapping[str, float] | None = None,
    rtol: float = 1e-9,
    atol: float = 1e-9,
    target: str | None = None,
    samples: int | None = None,
) -> Trajectory:
    """The motion from the start values of the model.

    Args:
        time: how long [s].
        parameters: values that replace the model's.
        start: start values and speeds (`theta`, `theta'`) that replace the model's.
        rtol, atol: tolerances of the integration.
        target: of the emitted code: "numpy", "c", or None for the fastest there is.
    Raises:
        MissingValues: parameters without a value, all named.
    """
    run = simulated(
        derive(model), time=time, parameters=parameters, start=start, target=target, samples=samples,
        tolerances=(rtol, atol),
    )  # fmt: skip
    if run.reactions and run.remark:
        warnings.warn(f"{model.name}: {run.remark}", RuntimeWarning, stacklevel=2)
    return run


def simulated(
    equations: Equations,
    *,
    time: float,
    parameters: Mapping[str, float] | None = None,
    start: Mapping[str, float] | None = None,
    target: str | None = None,
    samples: int | None = None,
    tolerances: tuple[float, float] = (1e-9, 1e-9),
) -> Trajectory:
    """The motion by equations that are derived already; see `simulate`. The tolerances are (rtol, atol)."""
    p = parameter_vector(equations.model, parameters)
    if has_phases(equations.model):
        run = run_phases(
            equations.model, time=time, p=p, parameters=parameters, start=start, target=target,
            samples=SAMPLES if samples is None else samples, how=Stepping(rtol=tolerances[0], atol=tolerances[1]),
        )  # fmt: skip
        return with_reactions(run, lambda: equations.reactions, equations.rhs(target), p)
    assembly = equations.graph
    energies = _along(equations, (assembly.T, assembly.V), p)
    gaps = gaps_of(equations.system.ties)
    rhs = equations.rhs(target)
    run = integrate(
        rhs,
        time=time,
        x0=equations.start(parameters, start),
        p=p,
        energy=lambda t, x: energies(t, x).T,
        conservative=is_conservative(equations.system, assembly),
        gaps=_along(equations, gaps, p) if gaps else None,
        samples=SAMPLES if samples is None else samples,
        rtol=tolerances[0],
        atol=tolerances[1],
    )
    run = _watched(equations, run, rhs, p, tolerances)
    return with_reactions(run, lambda: equations.reactions, rhs, p)


def _watched(
    equations: Equations, run: Trajectory, rhs: RightHandSide, p: np.ndarray, tolerances: tuple[float, float]
) -> Trajectory:
    """The run, ended where dependent coordinates or closing ties do not say how it goes on, and it went astray."""
    system = equations.system
    rtol, atol = (max(tolerance / 1000, 1e-13) for tolerance in tolerances)

    def again(start: float, x: np.ndarray, end: float) -> np.ndarray:
        finer = integrate(rhs, time=(start, end), x0=x, p=p, rtol=rtol, atol=atol, samples=2)
        return finer.x[-1] if finer.ok else np.full_like(x, np.nan)

    if system.elimination is not None:
        blocks = system.elimination.blocks
        determinants = _along(equations, tuple(block.determinant for block in blocks), p)
        run = ended_where_singular(run, determinants, [str(block) for block in blocks], again, rtol=tolerances[0])
    if system.declared:
        determinants = _along(equations, tuple(solved.determinant for solved in system.declared), p)
        what = list(map(str, system.declared))
        run = ended_where_singular(run, determinants, what, again, rtol=tolerances[0], place=CHOOSE)
    locks = locks_of(system.motion)
    if locks:
        determinants = _along(equations, tuple(lock.determinant for lock in locks), p)
        run = ended_where_singular(run, determinants, list(map(str, locks)), again, rtol=tolerances[0], place=LOCKED)
    rank = rank_of_ties(system.ties)
    if rank and len(run.t):
        J = _along(equations, tuple(x for row in equations.graph.J for x in row), p)
        rows = Independence(J, tuple(row.tie for row in system.ties.closing), rank)
        run = ended_where_singular(run, rows, [rows.words(run.t, run.x)], again, rtol=tolerances[0])
    return run


def _along(equations: Equations, outputs: tuple[Any, ...], p: np.ndarray) -> Callable[[Any, Any], np.ndarray]:
    """(t n, x n x states) -> the outputs at each state, n x outputs."""
    function = compiled(program_of(outputs, equations.graph.symbols, inputs=equations.system.inputs), "numpy")
    return lambda t, x: function.many(t, x, p)
