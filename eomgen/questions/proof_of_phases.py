"""An instant behind several phases -> whether the motion leads to it: the run that was followed, looked at as a run.

In each phase steps are taken again by another method, energy, ties and contacts are what the phase takes them for, and
between phases only impulses that push give momentum. The state is that at the end, and the condition holds not before.
"""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np

from eomgen.errors import DerivationError
from eomgen.model.fields import AtRest
from eomgen.model.parts import Output
from eomgen.questions.at_instant import StateAtInstant
from eomgen.questions.in_phase import PhaseEquations
from eomgen.questions.motion_from_start import MotionFromStart, difference_of, fine_stepping
from eomgen.questions.run import RunProof
from eomgen.simulation.joined import joined
from eomgen.simulation.phase_run import PhaseRun
from eomgen.symbolic.expression.graph import Node
from eomgen.symbolic.numeric.tolerances import CARRIED, RUNS_AGREE


def wrong_way(motion: MotionFromStart, output: Output, moment: StateAtInstant) -> str:
    """What contradicts an instant of a motion with phases, in words; "".

    Raises:
        DerivationError: nothing of the motion can be looked at.
    """
    assert output.at is not None and not isinstance(output.at, AtRest) and motion.models is not None
    t = moment.numbers.get(moment.phase.system.symbols.t, math.nan)
    if t == 0:
        return ""
    runs = motion.runs_to(output.at)
    found = RunProof(None, motion.models.p, fine_stepping(), motion.models)(joined(motion.models, runs))
    if found.ok is None:
        raise DerivationError(
            "the motion has phases of which nothing could be checked",
            mend="give every parameter a value in [parameters]",
        )
    failing = [f"{check.name}: {check.detail}" for check in found.checks if check.ok is False]
    return next(iter(failing), "") or _elsewhere(runs, output, moment) or _met_before(runs, output)


def _elsewhere(runs: Sequence[PhaseRun], output: Output, moment: StateAtInstant) -> str:
    """That the state is not that at the end of the runs, or after what ended them."""
    last = runs[-1]
    end = last.after.values if output.side == "after" and last.after is not None else last.end
    symbols, numbers = moment.phase.system.symbols, moment.numbers
    wrong = [node for node in (*symbols.q, *symbols.u) if _apart(numbers[node], end.get(node.name, 0.0))]
    wrong += [symbols.t] if _apart(numbers[symbols.t], last.run.end) else []
    return "".join(f"{node.name} is {numbers[node]:.10g} there" for node in wrong[:1])


def _apart(x: float, y: float) -> bool:
    return not abs(x - y) <= RUNS_AGREE * (1 + abs(y))


def _met_before(runs: Sequence[PhaseRun], output: Output) -> str:
    """That left - right changes its sign within a phase, at the integrator's steps."""
    condition = output.at
    assert condition is not None and not isinstance(condition, AtRest)
    for run in runs:
        phase = run.phase
        scalar = difference_of(PhaseEquations(phase.system), condition)
        if type(scalar) is not Node:
            continue
        track = run.run.tracks[0] if run.run.tracks else None
        t, x = (run.run.t, run.run.x) if track is None else track.all
        with np.errstate(all="ignore"):
            values = phase.functions.function((scalar,)).many(t, phase.functions.inner(x), phase.p)[:, 0]
        sure = values[np.abs(values) > CARRIED * np.max(np.abs(values), initial=0.0)]
        if np.any(sure > 0) and np.any(sure < 0):
            return f"'{condition.text}' holds before t = {run.run.end:.10g} s"
    return ""
