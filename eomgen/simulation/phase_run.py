"""One phase of a motion as it was run, its states at any instant, and all phases in one table.

One phase of a motion as it was run; where a run is to end, within a phase and where phases change.

Within a phase the integrator finds the instant. That a phase ends, or another begins, in a state in which the condition
holds is seen here: sliding contacts come to rest and stick, landing ones lose their speed.
"""

from __future__ import annotations

from collections.abc import Callable, Collection, Iterable, Iterator, Mapping, Sequence
from dataclasses import replace
from functools import cache, cached_property
from itertools import accumulate
from types import MappingProxyType

import numpy as np

from eomgen.errors import DerivationError
from eomgen.frozen import dataclass
from eomgen.mechanics.dynamics import System
from eomgen.simulation.columns import OutputColumns
from eomgen.simulation.contacts import EventFunction
from eomgen.simulation.integration import drift_of
from eomgen.simulation.integrator import Run, measured
from eomgen.simulation.phase_change import PhaseStart
from eomgen.simulation.phase_model import PhaseModel, Values
from eomgen.simulation.phase_models import PhaseModels
from eomgen.simulation.reaction_columns import ReactionColumns, begun
from eomgen.simulation.result import Impact, Kept, OnDemand, Phase, Trajectory
from eomgen.symbolic.expression import Expression, Scalar
from eomgen.symbolic.numeric import tolerances

SystemCondition = Callable[[System], Scalar]
"""A function that is to become 0, over the symbols, accelerations and multipliers of a system."""


@dataclass(frozen=True)
class PhaseRun:
    """One phase as it was run.

    Args:
        here: its start.
        phase: its equations.
        run: the result of the integrator.
        bound: the bound that ended it; None where the time, a condition or a failure did.
        after: the start of the next phase; of a condition, the one that would follow if it holds just at its end.
    """

    here: PhaseStart
    phase: PhaseModel
    run: Run
    bound: EventFunction | None
    after: PhaseStart | None

    @cached_property
    def end(self) -> Values:
        """Coordinates, rates and speeds at its end."""
        return self.phase.values(self.run.end, self.run.last)

    @cached_property
    def measured(self) -> tuple[np.ndarray, np.ndarray]:
        """(instants, states) as requested and at the integrator's steps, in the order of time."""
        return measured(self.run.t, self.run.x, self.run.tracks)

    def tracked(self) -> tuple[np.ndarray, np.ndarray]:
        """The same."""
        return self.measured

    @property
    def is_met(self) -> bool:
        """True if a condition ended it."""
        return self.bound is None and self.run.status == "event"

    @staticmethod
    def joined(
        models: PhaseModels,
        runs: Sequence[PhaseRun],
        *,
        until: str | None = None,
        reactions: bool = False,
        outputs: Mapping[str, Expression] = MappingProxyType({}),
    ) -> Trajectory:
        """The motion through all phases, with the beginning and the end of each; a coordinate it lacks is 0 in it.

        Args:
            until: the condition that should end it, for its message.
            reactions: True if these are among the columns.
            outputs: formulas of further columns, by name.
        """
        found = _reported(_joined(models, runs), until)
        found = _with_reactions(found, runs) if reactions else found
        return _with_outputs(found, runs, outputs)


PhaseCondition = Callable[[PhaseModel], Scalar]
"""A function that is to become 0, over the symbols, accelerations and multipliers of a phase."""


def met(phase_run: PhaseRun, until: PhaseCondition) -> bool:
    """True if the condition holds where a phase ends, and did not hold all along."""
    sizes = _sizes(phase_run, until)
    largest = float(np.max(sizes))
    return bool(sizes[-1] <= tolerances.COMPUTED * max(1.0, largest) < largest)


def ended(runs: Iterable[PhaseRun], until: PhaseCondition) -> Iterator[PhaseRun]:
    """The phases, the last of them cut off where the condition first holds."""
    before: PhaseRun | None = None
    for phase_run in runs:
        if before is not None and _begins(before, phase_run, until):
            yield _only_begun(phase_run)
            return
        if phase_run.bound is not None and met(phase_run, until):
            yield _by_condition(phase_run)
            return
        yield phase_run
        before = phase_run


def _begins(before: PhaseRun, phase_run: PhaseRun, until: PhaseCondition) -> bool:
    """True if the condition holds where a phase begins, and did not at the end of the one before."""
    last, largest = (float(find(_sizes(before, until))) for find in (lambda sizes: sizes[-1], np.max))
    enough = tolerances.COMPUTED * max(1.0, largest)
    return last > enough and bool(_sizes(phase_run, until)[0] <= enough)


def _sizes(phase_run: PhaseRun, until: PhaseCondition) -> np.ndarray:
    """The absolute values of the function that should become 0, at the instants of a phase and at its end."""
    run, phase = phase_run.run, phase_run.phase
    stops, after = phase_run.bound is not None and phase_run.bound.kind == "stops", phase_run.after
    last = phase.state(after.values) if stops and after is not None else run.last  # on a surface near to 0, then 0
    t, x = np.append(run.t, run.end), np.vstack([run.x, last])
    return np.asarray(np.abs(phase.functions.evaluated(t, x, (until(phase),))[:, 0]))


def _only_begun(phase_run: PhaseRun) -> PhaseRun:
    run = phase_run.run
    first = replace(run, t=run.t[:1], x=run.x[:1], end=float(run.t[0]), last=run.x[0], steps=0, evaluations=0)
    return _by_condition(replace(phase_run, run=first, after=None))


def _by_condition(phase_run: PhaseRun) -> PhaseRun:
    message = f"Stopped by an event at t = {phase_run.run.end:.6g} s."
    return replace(phase_run, run=replace(phase_run.run, status="event", message=message), bound=None)


# -------- joined ----------------------------------------------------------------------------------------------
# The phases of a motion as they were run -> Trajectory: all in one table, reactions too.


def _reported(found: Trajectory, until: str | None) -> Trajectory:
    """Run whose message names the condition `until`."""
    if until is None or found.ended not in ("event", "finished"):
        return found
    end = found.phases[-1].end
    met = f"{until} at t = {end:.6g} s." if found.ended == "event" else f"{found.words} '{until}' did not come."
    return replace(found, words=met, phases=(*found.phases[:-1], replace(found.phases[-1], ended_by=met)))


def _joined(models: PhaseModels, runs: Sequence[PhaseRun]) -> Trajectory:
    coordinates, speeds = _union(runs)
    states = runs[0].phase.states  # those of every phase alike
    names = (*coordinates, *speeds, *states)
    phases = {id(phase_run.phase): phase_run.phase for phase_run in runs}
    as_they_are = {key for key, phase in phases.items() if phase.moving == names and not phase.loose}
    tables = [s.run.x if id(s.phase) in as_they_are else _table(s, names) for s in runs]
    ends = [0, *accumulate(len(phase_run.run.t) for phase_run in runs)]
    return Trajectory(
        t=np.concatenate([phase_run.run.t for phase_run in runs]),
        x=np.concatenate(tables),
        coordinates=coordinates,
        speeds=speeds,
        states=states,
        energies=lambda: np.concatenate([sum(s.phase.energies(s.run.t, s.run.x)) for s in runs]),
        measure=lambda: Kept(_drift(runs), *_open(runs)),
        phases=tuple(
            Phase(s.here.t, s.run.end, phase_text(models, s), (first, last), s.phase, s.tracked)
            for s, first, last in zip(runs, ends[:-1], ends[1:], strict=True)
        ),
        ended=runs[-1].run.status,
        words=runs[-1].run.message,
        steps=sum(phase_run.run.steps for phase_run in runs),
        evaluations=sum(phase_run.run.evaluations for phase_run in runs),
        carried=tuple(span for phase_run in runs for span in phase_run.run.carried),
        impacts=tuple(s.here.impact for s in runs if s.here.impact is not None),
    )


def _table(phase_run: PhaseRun, names: tuple[str, ...]) -> np.ndarray:
    """States of a phase over the names of all, n x names."""
    phase, t, x = phase_run.phase, phase_run.run.t, phase_run.run.x
    found = phase.columns(t, x)
    none = np.zeros(len(t))
    return np.array([found.get(name, none) for name in names]).reshape(-1, len(t)).T


def _union(runs: Sequence[PhaseRun]) -> tuple[tuple[str, ...], tuple[str, ...]]:
    """Coordinates and speeds of all phases, each in the order in which it comes."""
    phases = {id(phase_run.phase): phase_run.phase for phase_run in runs}.values()
    coordinates = dict.fromkeys(name for phase in phases for name in phase.coordinates)
    speeds = dict.fromkeys(name for phase in phases for name in phase.shown)
    return tuple(coordinates), tuple(speeds)


def _drift(runs: Sequence[PhaseRun]) -> float | None:
    """The largest of the phases in which energy should stay."""
    return max((drift_of(*s.phase.energies(*s.measured)) for s in runs if s.phase.conservative), default=None)


def _open(runs: Sequence[PhaseRun]) -> tuple[float | None, float | None]:
    """The largest |phi| and |J u + sigma| of the constraints that hold; None where none closes."""
    found = [s.phase.projection.open(*s.measured) for s in runs if s.phase.projection is not None]
    if not found:
        return None, None
    gap, gap_rate = np.max(np.concatenate(found), axis=0, initial=0.0)
    holds = any(s.phase.projection is not None and s.phase.projection.speeds for s in runs)
    return float(gap), float(gap_rate) if holds else None


def _with_reactions(full: Trajectory, runs: Sequence[PhaseRun]) -> Trajectory:
    """The trajectory with its reactions as columns; its remark names those without a column and the reason.

    In each phase they are those of the phase's own equations; a contact that is open has the reaction 0. Where nothing
    but joints holds the bodies each has a value at every state: nothing is missing, and they wait to be read.
    """
    try:
        made = [_reaction_columns(s.phase) for s in runs]
    except DerivationError as error:
        return replace(full, reported=f"No reactions: {error.what}.")
    t, rows = full.t, [phase.rows for phase in full.phases]

    @cache
    def columns() -> dict[str, np.ndarray]:
        found: dict[str, np.ndarray] = {}
        for s, own, where in zip(runs, made, rows, strict=True):
            for name, column in _of_phase(s, own):
                found.setdefault(name, np.zeros(len(t)))[slice(*where)] = column
        return found

    always = tuple(dict.fromkeys(name for own in made for name in own.indeterminate))
    reported = f"Statically indeterminate: {_few(always)}." if always else ""
    names = tuple(dict.fromkeys(name for own in made for name in own.names))
    waits = all(s.phase.projection is None and not s.phase.equations.system.constraints.rows for s in runs)
    reactions = OnDemand(names, columns) if waits else columns()
    return replace(
        full, reactions=reactions, units=_units(made), reported=reported, gaps=lambda: _gaps(t, columns(), always)
    )


def _of_phase(s: PhaseRun, columns: ReactionColumns) -> Iterator[tuple[str, np.ndarray]]:
    """(name, column) of every reaction in a phase."""
    model, t = s.phase, s.run.t
    x = begun(t, model.functions.inner(s.run.x), model.functions.rhs.at(model.p), model.slowest)
    found = columns.along(t, x, model.parameters_along(t, s.run.x))
    return zip(columns.names, found.T, strict=True)


def _reaction_columns(phase: PhaseModel) -> ReactionColumns:
    """Reaction columns of a phase, made once for all values of the parameters."""
    if "reactions" not in phase.known:
        phase.known["reactions"] = ReactionColumns(phase.reactions, phase.functions.rhs)
    found: ReactionColumns = phase.known["reactions"]
    return found


def _with_outputs(full: Trajectory, runs: Sequence[PhaseRun], formulas: Mapping[str, Expression]) -> Trajectory:
    """The trajectory with formulas as columns, in SI; its remark names those without a column and the reason."""
    if not formulas:
        return full
    made = {id(s.phase): OutputColumns(s.phase, formulas) for s in runs}
    found = {name: np.full(len(full.t), np.nan) for name in formulas}
    for s, phase in zip(runs, full.phases, strict=True):
        for name, column in made[id(s.phase)].along(s.run.t, s.run.x).items():
            found[name][slice(*phase.rows)] = column
    refused = {name: why for columns in made.values() for name, why in columns.refused.items()}
    nowhere = {name for name in refused if all(name in columns.refused for columns in made.values())}
    reported = [
        f"{'No column' if name in nowhere else 'In some phases no value'} of '{name}': {why}."
        for name, why in refused.items()
    ]
    given = {name: column for name, column in found.items() if name not in nowhere}
    return replace(full, outputs=given, reported=" ".join(filter(None, (full.reported, *reported))))


def phase_text(models: PhaseModels, phase_run: PhaseRun) -> str:
    """Text that says what ended a phase, and when."""
    after, resting = phase_run.after, phase_run.here.impact
    if phase_run.bound is None and after is not None and resting is not None:
        names = " and ".join(f"'{name}'" for name in resting.contact.split(", "))
        return f"{names} bounces without end until t = {after.t:.10g} s, where all flights, 2 v/(g_n (1 - e)), are over"
    if phase_run.bound is None or after is None:
        return phase_run.run.message
    when = f"at t = {after.t:.6g} s"
    if after.failure:
        return f"{after.failure} {when}"
    phrases = models.changes(phase_run.here.configuration, after.configuration)
    if after.impact is None:
        return f"{', '.join(phrases) or 'the contacts change and return'} {when}"
    away = set(phase_run.here.configuration.open) & set(after.configuration.open)
    phrases = (*_rebounds(models, after.impact, away), *phrases)
    return f"{', '.join(phrases) or 'the contacts change and return'} {when}" + _how_it_ends(models, after)


def _rebounds(models: PhaseModels, impact: Impact, away: Collection[str]) -> Iterator[str]:
    """A phrase for each contact that closes and is open again."""
    words = {contact.name: contact.words for contact in models.model.contacts}
    return (f"{words[name]} rebounds" for name in impact.contact.split(", ") if name in away)


def _how_it_ends(models: PhaseModels, after: PhaseStart) -> str:
    """Text on an impact beside its phrases: that nothing rebounds, or that flights are too low."""
    assert after.impact is not None
    if after.limit is not None:
        return ", from where its flights cannot be told from rest"
    e = models.without_contacts.restitutions
    return ", without rebound" if not any(e.get(name) for name in after.impact.contact.split(", ")) else ""


def _units(columns: Iterable[ReactionColumns]) -> dict[str, str]:
    return {named.name: named.unit for each in columns for named in each.requested}


def _gaps(t: np.ndarray, found: Mapping[str, np.ndarray], always: tuple[str, ...]) -> str:
    """Names the columns that are nan at some instants but not always, and since when; "" if there are none."""
    at_times = {name: np.isnan(column) for name, column in found.items() if name not in always}
    singular = [name for name, gone in at_times.items() if gone.any()]
    if not singular:
        return ""
    first = t[int(np.any([at_times[name] for name in singular], axis=0).argmax())]
    return f"No single value in singular positions, first at t = {first:.6g} s: {_few(singular)}."


def _few(names: Sequence[str]) -> str:
    return ", ".join(names) if len(names) <= 6 else f"{', '.join(names[:5])} and {len(names) - 5} more"
