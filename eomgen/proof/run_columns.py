"""A run -> checks: its columns of reactions and outputs are those of balance, formulas and second definitions."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from functools import partial

import numpy as np

from eomgen.codegen.reactions import determinate
from eomgen.model.outputs import FUNCTIONS
from eomgen.proof.at_a_state import NumericState, off_by
from eomgen.proof.check import Check, Tally, checked, differing
from eomgen.proof.emitted_code import WORK
from eomgen.proof.second_definitions import second_definition
from eomgen.simulation.result import Phase, Trajectory
from eomgen.symbolic.expression.expressions import Expression
from eomgen.symbolic.expression.graph import Scalar
from eomgen.symbolic.expression.rational import Fraction
from eomgen.symbolic.expression.traversal import order
from eomgen.symbolic.numeric.evaluation import NoValue
from eomgen.symbolic.numeric.tolerances import COMPUTED

ROWS, EXACTLY = "a run has a row at every instant that was asked", "floating point"
MOST = 4  # phases that are looked at, each in its middle


def rows_left_out(run: Trajectory, instants: np.ndarray | None) -> Iterator[Check]:
    """A contradiction where an instant that was asked, and passed, has no row, or rows do not go on; else nothing.

    Args:
        instants: that were asked; None: none in particular.
    """
    if instants is None or not len(run.t):
        return
    end = run.phases[-1].end if run.status == "finished" and run.phases else run.t[-1]
    passed = instants[instants <= end]
    missing = passed[~np.isin(passed, run.t)]
    if len(missing):
        yield checked(ROWS, f"none at t = {missing[0]:.6g} s", EXACTLY)
    elif (np.diff(run.t) <= 0).any():
        yield checked(ROWS, "they do not go on in time", EXACTLY)


def _middles(run: Trajectory) -> Iterator[tuple[Phase, int]]:
    """(phase, its middle row) of some phases spread over the run."""
    for phase in run.phases[:: max(1, len(run.phases) // MOST)]:
        first, last = phase.rows
        if phase.model is not None and phase.track is not None and last - first >= 3:
            yield phase, (first + last) // 2


def reaction_columns_hold(run: Trajectory) -> Iterator[Check]:
    """A(q) rho = b solved by rank in doubles, against its solution in symbols with 50 digits; () where none reacts.

    Both share A and b, which the balance of every body proves at other states.
    """
    tally = Tally("columns of reactions are those of the balance", "symbols with 50 digits")
    work = 0
    if not run.reactions:
        return iter(())
    for phase, row in _middles(run):
        formulas = determinate(phase.model.reactions)
        work += len(order(tuple(formulas.values())))
        if work > WORK:
            tally.left[f"from {phase.start:.6g} s"] = "its formulas are too long to be evaluated with 50 digits"
            continue
        tally.add(f"t = {run.t[row]:.6g} s", partial(_wrong_reaction, run, phase, row, formulas))
    return tally.checks()


def _wrong_reaction(run: Trajectory, phase: Phase, row: int, formulas: Mapping[str, Scalar]) -> str:
    """Which column is not that of the symbols in a row, or ""."""
    state = state_of_row(run, phase, row)
    columns = {name: float(run.reactions[name][row]) for name in formulas if name in run.reactions}
    known = {name: x for name, x in columns.items() if np.isfinite(x)}
    if not known:
        raise NoValue("no reaction has a single value there")
    size = max(map(abs, known.values()))
    for name, found in known.items():
        right = state.number(formulas[name])
        if abs(found - right) > COMPUTED * (1 + size):
            wrong = off_by(found, right, [near.number(formulas[name]) for near in state.beside()])
            if wrong:
                return f"{name}: {wrong}"
    return ""


def state_of_row(run: Trajectory, phase: Phase, row: int) -> NumericState:
    """The state of a row, in the coordinates and speeds of its phase."""
    assert phase.track is not None
    t, x = phase.track
    equations = phase.model.equations
    symbols, here = equations.symbols, x[int(np.argmin(np.abs(t - run.t[row])))]
    parameters = {
        node: Fraction(float(value)) for node, value in zip(symbols.parameters.values(), phase.model.p, strict=True)
    }
    numbers = {node: float(value) for node, value in zip((*symbols.q, *symbols.u), here, strict=False)}
    return NumericState(equations, parameters, {symbols.t: float(run.t[row]), **numbers})


def output_columns_hold(run: Trajectory, formulas: Mapping[str, Expression]) -> Iterator[Check]:
    """Compiled programs over all rows, against the formulas with 50 digits and the second definitions at single rows.

    Accelerations come from dense equations with 50 digits, functions of motion from differences of poses and from
    particles.
    """
    values = Tally("columns of outputs are those of the formulas", "50 digits, reactions in doubles")
    meanings = Tally("functions of the motion hold by their second definitions", "differences of poses, particles")
    for phase, row in _middles(run):
        if phase.model.declared is not phase.model.system:
            continue
        state = state_of_row(run, phase, row)
        for name in run.outputs:
            found, when = float(run.outputs[name][row]), f"{name} at t = {run.t[row]:.6g} s"
            if not np.isfinite(found):
                continue
            values.add(when, partial(_wrong_output, state, found, formulas[name]))
            for call in formulas[name].calls:
                if FUNCTIONS[call.name].second is not None:
                    meanings.add(f"{call} at t = {run.t[row]:.6g} s", partial(second_definition, state, call))
    return iter((*values.checks(), *meanings.checks()))


def _wrong_output(state: NumericState, found: float, formula: Expression) -> str:
    right = state.worth(formula)
    if not differing(found, right):
        return ""
    return off_by(found, right, [near.worth(formula) for near in state.beside()])
