"""A run in time -> checks of all of it: its code and steps, energy and constraints, rows, columns, and contacts."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import replace

import numpy as np

from eomgen.proof.check import Check, unchecked
from eomgen.proof.contact_phases import bodies_stand_as_reported, changes_follow_impulses, contacts_do_as_assumed
from eomgen.proof.motion import Leg, Promise, code_and_steps, energy_and_constraints
from eomgen.proof.reported_run import output_columns_hold, reaction_columns_hold, rows_left_out
from eomgen.simulation import Phase, PhaseModels, Stepping, Trajectory, formulas_of


def run_checks(
    found: Trajectory,
    models: PhaseModels,
    how: Stepping,
    *,
    instants: np.ndarray | None = None,
    answers: Iterable[Check] = (),
) -> tuple[Check, ...]:
    """Checks of a run; an unmade one where a Python function sets an input.

    Args:
        models: its phases.
        how: the tolerances of the run.
        instants: those at which it must have a row; None: its own.
        answers: checks of what was requested of the whole run.
    """
    if _is_fed(found):
        what = "a Python function sets an input: its values between the states are not known"
        return (unchecked("the run follows its equations", what, "the run's right-hand side"),)
    return (
        *code_and_steps(_legs(found, how), _promise(found, how)),
        *(watched_checks(found, how) if found.watch is None else found.watched),
        *answers,
        *rows_left_out(found, instants),
        *reaction_columns_hold(found),
        *output_columns_hold(found, formulas_of(models.model)),
        *_contacts(found, models),
    )


def watched_checks(found: Trajectory, how: Stepping) -> tuple[Check, ...]:
    """Checks of energy against power, of constraints and of norms, which a run makes in any case."""
    return () if _is_fed(found) else energy_and_constraints(_legs(found, how), _promise(found, how))


def _is_fed(found: Trajectory) -> bool:
    """True if a Python function sets an input."""
    return any(phase.model.fed is not None for phase in found.phases)


def _promise(found: Trajectory, how: Stepping) -> Promise:
    """Accuracy that the tolerances of a run promise."""
    projected = how.stabilization in ("projection", "energy") and how.every is None
    levelled = projected and how.stabilization == "energy"
    return Promise(how.rtol, how.atol, found.steps, projected, levelled)


def _legs(found: Trajectory, how: Stepping) -> Sequence[Leg]:
    """Leg of the states of each phase, without those after the instant at which the run was cut."""
    return [leg for phase in found.phases for leg in _leg(phase, found, how)]


def _leg(phase: Phase, found: Trajectory, how: Stepping) -> Iterator[Leg]:
    track, phased = _until(phase, found.t).track, phase.model
    if track is not None:
        t, x = track
        pulled = how.stabilization == "baumgarte"
        rhs, inner = phased.functions.rhs, phased.functions.inner(x)
        yield Leg(phased.equations, phased.p, rhs, t, inner, found.carried, pulled, phased.known)


def _until(phase: Phase, t: np.ndarray) -> Phase:
    """A phase without the states after the run was cut."""
    if phase.track is None or not len(t):
        return replace(phase, tracked=None)
    times, states = phase.track
    here = times <= max(t[-1], phase.start)
    return replace(phase, tracked=lambda: (times[here], states[here]))


def _contacts(found: Trajectory, models: PhaseModels) -> Iterator[Check]:
    """Checks of contacts in the phases of a run, and between them."""
    seen = [cut for phase in found.phases if (cut := _until(phase, found.t)).track is not None]
    yield from contacts_do_as_assumed(seen)
    if len(seen) > 1:
        yield from bodies_stand_as_reported(seen, models.without_contacts.system)
        yield from changes_follow_impulses(seen, models.without_contacts.system, models.ends)
