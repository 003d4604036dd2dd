"""A run -> checks: its columns of outputs are what the formulas are worth, and what the functions mean."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from functools import partial

import numpy as np

from eomgen.model.outputs import FUNCTIONS
from eomgen.proof.at_a_state import NumericState, differing, off_by
from eomgen.proof.check import Check
from eomgen.proof.run_reactions import MOST, state_of_row
from eomgen.proof.second_definitions import second_definition
from eomgen.proof.tally import Tally
from eomgen.simulation.result import Trajectory
from eomgen.symbolic.expression.expressions import Expression


def output_columns_hold(run: Trajectory, formulas: Mapping[str, Expression]) -> Iterator[Check]:
    """Compiled programs over all rows, against the formulas with 50 digits and the second definitions at single rows.

    Accelerations come from dense equations with 50 digits, functions of motion from differences of poses and from
    particles.
    """
    values = Tally("columns of outputs are those of the formulas", "50 digits, reactions in doubles")
    meanings = Tally("functions of the motion hold by their second definitions", "differences of poses, particles")
    for phase in run.phases[:: max(1, len(run.phases) // MOST)]:
        first, last = phase.rows
        if (
            phase.model is None
            or phase.track is None
            or last - first < 3
            or phase.model.declared is not phase.model.system
        ):
            continue
        row = (first + last) // 2
        state = state_of_row(run, phase, row)
        for name in run.outputs:
            found, when = float(run.outputs[name][row]), f"{name} at t = {run.t[row]:.6g} s"
            if not np.isfinite(found):
                continue
            values.add(when, partial(_differs, state, found, formulas[name]))
            for call in formulas[name].calls:
                if FUNCTIONS[call.name].second is not None:
                    meanings.add(f"{call} at t = {run.t[row]:.6g} s", partial(second_definition, state, call))
    return iter((*values.checks(), *meanings.checks()))


def _differs(state: NumericState, found: float, formula: Expression) -> str:
    right = state.worth(formula)
    if not differing(found, right):
        return ""
    return off_by(found, right, [near.worth(formula) for near in state.beside()])
