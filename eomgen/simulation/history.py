"""Model, start, condition -> the phases that a motion passes until the condition holds."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from eomgen.model.parts import Model
from eomgen.simulation.integrator import Stepping
from eomgen.simulation.joined import phase_text
from eomgen.simulation.motion import Plan, passed
from eomgen.simulation.phase_change import Course, at_start, course_of
from eomgen.simulation.phase_model import PhaseModel, Values
from eomgen.simulation.phase_run import PhaseCondition, PhaseRun, met
from eomgen.symbolic.expression.graph import Scalar
from eomgen.symbolic.numeric.tolerances import FINE_RUN

FINE = Stepping(rtol=FINE_RUN, atol=FINE_RUN)


@dataclass(frozen=True)
class PassedPhase:
    """One phase of a motion.

    Args:
        phase: its equations.
        start, end: coordinates and rates by name, at its beginning and at its end.
        t_0, t_1: its times [s].
        kind: what ended it: "condition", "time", "failure", or as of EventFunction: "ends", "turns", "closes", "stops",
            "slips", "piece".
        owner: the contact, or the body on a path, whose bound ended it; "" where none did.
        value: what became zero, over the symbols of the phase; None for "time", "failure", a slack without a formula.
        message: in words.
        after: of the last one, where the condition holds just as the phase ends: the phase and the values that follow.
    """

    phase: PhaseModel
    start: Values
    end: Values
    t_0: float
    t_1: float
    kind: str
    owner: str
    value: Scalar | None
    message: str
    after: tuple[PhaseModel, Values] | None = None


def history(
    model: Model,
    p: np.ndarray,
    start: Mapping[str, float] | None = None,
    *,
    until: PhaseCondition | None,
    time: float,
    parameters: Mapping[str, float] | None = None,
    how: Stepping = FINE,
) -> tuple[PassedPhase, ...]:
    """The phases from the start to the first time after it at which the condition is 0, or to the end of the time.

    Args:
        p: the parameters' values; parameters: those of them that replace the model's.
        start: start values and speeds that replace the model's.
        until: of a phase, what becomes 0.
    Raises:
        DerivationError: the ties do not hold at the start; the reaction of a contact is indeterminate.
    """
    course = course_of(model, p, "numpy")
    plan = Plan(time, how, None, until)
    found = []
    for stretch in passed(course, at_start(course, 0.0, parameters, start), plan):
        holds = until is not None and stretch.bound is not None and met(stretch, until)
        found.append(_passage(course, stretch, until, holds))
        if holds:
            break
    return tuple(found)


def _passage(course: Course, stretch: PhaseRun, until: PhaseCondition | None, holds: bool) -> PassedPhase:
    here, phase, run, bound = stretch.here, stretch.phase, stretch.run, stretch.bound
    after, follows = stretch.after, None
    value: Scalar | None
    if holds or (bound is None and run.crossing is not None):
        assert until is not None
        follows = None if after is None else (course.phase_models.of(after.configuration), after.values)
        kind, owner, value = "condition", "", until(phase)
    elif bound is not None:
        kind, owner, value = bound.kind, bound.owner, bound.value
    else:
        kind, owner, value = "time" if run.status == "finished" else "failure", "", None
    values = phase.values(run.end, run.last)
    return PassedPhase(
        phase, here.values, values, here.t, run.end, kind, owner, value, phase_text(course, stretch), follows
    )
