"""Model -> Equations -> RightHandSide -> Trajectory: the whole journey on one screen."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Any

import numpy as np

from eomgen.codegen.program import program_of
from eomgen.codegen.rhs import compiled
from eomgen.equations import Equations
from eomgen.errors import UsageError
from eomgen.mechanics.closure import gaps_of
from eomgen.mechanics.formulations import recursive
from eomgen.mechanics.friction import with_friction
from eomgen.mechanics.system import system_of
from eomgen.mechanics.wellposed import is_conservative
from eomgen.model.parts import Model
from eomgen.model.values import numeric_parameters
from eomgen.simulation.integrate import SAMPLES, integrate
from eomgen.simulation.singular import ended_where_singular
from eomgen.simulation.trajectory import Trajectory

METHODS = ("lagrange", "projection")


def derive(model: Model, method: str = "lagrange") -> Equations:
    """The equations of motion of a model; no certificate is made.

    Args:
        method: by which the derivation is written, one of METHODS.
    Raises:
        UsageError: an unknown method.
        NotYet: a kind that this version does not derive.
        DerivationError: the model has no equations of motion.
    """
    if method not in METHODS:
        raise UsageError(f"unknown method '{method}'", mend=f"one of {', '.join(METHODS)}")
    system = system_of(model)
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
    return simulated(
        derive(model), time=time, parameters=parameters, start=start, target=target, samples=samples,
        tolerances=(rtol, atol),
    )  # fmt: skip


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
    assembly = equations.graph
    p = np.array(list(numeric_parameters(equations.model, parameters).values()), dtype=float)
    energies = _along(equations, (assembly.T, assembly.V), p)
    gaps = gaps_of(equations.system.ties)
    run = integrate(
        equations.rhs(target),
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
    blocks = () if equations.system.elimination is None else equations.system.elimination.blocks
    determinants = _along(equations, tuple(block.determinant for block in blocks), p)
    return ended_where_singular(run, determinants, [str(block) for block in blocks], rtol=tolerances[0])


def _along(equations: Equations, outputs: tuple[Any, ...], p: np.ndarray) -> Callable[[Any, Any], np.ndarray]:
    """(t n, x n x states) -> the outputs at each state, n x outputs."""
    function = compiled(program_of(outputs, equations.graph.symbols, inputs=equations.system.inputs), "numpy")
    return lambda t, x: function.many(t, x, p)
