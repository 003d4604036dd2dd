"""Equations, what changes -> how a motion changes along its way: the variational equations, integrated with it.

    x' = f(t, x, p),   s' = f_x s + f_p,   s(0) = dx(0)/dp

One program gives both; where ties close, f is what the elimination of the multipliers leaves.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace

import numpy as np

from eomgen.codegen.program import kinematic_rates, program_of
from eomgen.codegen.rhs import compiled, parameter_vector
from eomgen.errors import NotYet, RunFailed
from eomgen.mechanics.equations.system import System
from eomgen.mechanics.initial_state.start_slopes import Seeds
from eomgen.questions.in_phase import PhaseEquations
from eomgen.records import dataclass
from eomgen.simulation.configuration import changing, has_phases
from eomgen.simulation.solvers import breakpoints_of, solver_of, step
from eomgen.symbolic.expression.derivative import depends_on, substituted, tangent
from eomgen.symbolic.expression.expressions import Expression
from eomgen.symbolic.expression.graph import Node, Scalar
from eomgen.symbolic.expression.traversal import order
from eomgen.symbolic.numeric.tolerances import FINE_RUN
from eomgen.symbolic.numeric.work import check_patience

JUMPS = ("sign", "less", "less_equal", "select")


@dataclass(frozen=True)
class ChangingRun:
    """A motion, and how it changes.

    Args:
        t: instants, k [s].
        values: of each formula along them, k.
        slopes: of each formula and each name its derivative, k.
    """

    t: np.ndarray
    values: Mapping[str, np.ndarray]
    slopes: Mapping[tuple[str, str], np.ndarray]


def changing_run(
    phase: PhaseEquations,
    start: tuple[np.ndarray, Mapping[str, np.ndarray]],
    changes: Mapping[str, Seeds],
    formulas: Mapping[str, Expression],
    instants: np.ndarray,
) -> ChangingRun:
    """Formulas and their derivatives along a motion.

    Args:
        start: x = (q, u) at the start, and how it changes with each name.
        changes: how the parameters change with each name.
        formulas: by name.
        instants: ascending from 0 [s].
    Raises:
        NotYet: contacts change along the way, or forces jump.
        RunFailed: the motion ends before.
    """
    system = phase.system
    rates = _rates(phase)
    _refuse_jumps(system, rates)
    symbols, graph = system.symbols, system.scope.graph
    x = (*symbols.q, *symbols.u)
    s = {name: tuple(graph.symbol(f"d({node.name})/d({name})") for node in x) for name in changes}
    along = {name: {**seeds, **dict(zip(x, s[name], strict=True))} for name, seeds in changes.items()}
    extended = replace(symbols, u=(*symbols.u, *(node for own in s.values() for node in own)))
    rows = [*rates, *(d for seeds in along.values() for d in tangent(rates, seeds))]
    f, p = compiled(program_of(rows, extended)), parameter_vector(system.scope.model)
    x0 = np.concatenate([start[0], *(start[1][name] for name in changes)])
    states = _integrated(f.at(p), x0, instants, breakpoints_of(system.scope.model))
    inputs = _own_inputs(system)
    closed = substituted([phase.of_state(formula) for formula in formulas.values()], inputs)
    asked = [*closed, *(d for seeds in along.values() for d in tangent(closed, seeds))]
    columns = compiled(program_of(asked, extended), "numpy").many(instants, states, p).T + 0.0
    keys = [(of, name) for name in changes for of in formulas]
    slopes = dict(zip(keys, columns[len(formulas) :], strict=True))
    return ChangingRun(instants, dict(zip(formulas, columns, strict=False)), slopes)


def _rates(phase: PhaseEquations) -> tuple[Scalar, ...]:
    """x' as functions of t, x and the parameters."""
    equations, a = phase.equations, phase.system.symbols.a
    known = equations.accelerations if not equations.J and equations.accelerations else phase.accelerations
    rates = substituted((*kinematic_rates(equations), *a), dict(zip(a, known, strict=True)))
    return substituted(rates, _own_inputs(phase.system))


def _own_inputs(system: System) -> dict[Node, Scalar]:
    return {node: system.inputs[name] for name, node in system.symbols.inputs.items()}


def _refuse_jumps(system: System, rates: Sequence[Scalar]) -> None:
    if has_phases(system.scope.model):
        names = ", ".join(f"'{x}'" for x in changing(system.scope.model))
        what = f"{names} may change along the way (open, stick, slide): a motion in phases has no derivative here"
        raise NotYet(what, mend="differences of two runs, or a stretch of one phase as a model of its own")
    moving = (*system.symbols.q, *system.symbols.u, *system.symbols.parameters.values())
    if any(node.op in JUMPS and depends_on(node, moving) for node in order(rates)):
        raise NotYet(
            "a force jumps along the way: the variational equations do not hold across it",
            mend="take differences of two runs: a sweep over the parameter",
        )


def _integrated(f, x0: np.ndarray, instants: np.ndarray, breakpoints: Sequence[float]) -> np.ndarray:  # type: ignore[no-untyped-def]
    """The states at the instants, k x n.

    Raises:
        RunFailed: the motion ends before.
    """
    end = float(instants[-1])
    found = [x0 for t in instants if t <= 0]
    solver = solver_of("DOP853", f, (0.0, end), x0, rtol=FINE_RUN, atol=FINE_RUN)
    while len(found) < len(instants):
        check_patience()
        step(solver, breakpoints, end)
        if solver.status == "failed":
            raise RunFailed(f"the motion cannot be followed beyond t = {solver.t:.6g} s", mend="a shorter run")
        dense = solver.dense_output()
        while len(found) < len(instants) and instants[len(found)] <= solver.t:
            found.append(dense(instants[len(found)]))
    return np.array(found)
