"""Model with contacts that change -> Trajectory: phase after phase, each with the equations of its own stage."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np

from eomgen.errors import DerivationError
from eomgen.mechanics.contacts import Mode
from eomgen.mechanics.start import start_state
from eomgen.model.parts import Model
from eomgen.model.table import Table
from eomgen.simulation.contacts import Configuration, changed, contacts_of, on_pieces, paths_of
from eomgen.simulation.events import Events
from eomgen.simulation.impact import Loose, loose
from eomgen.simulation.integrate import drift_of, instants_of
from eomgen.simulation.settling import settled
from eomgen.simulation.stage import GAP, RATE, Stage, Stages, Values
from eomgen.simulation.stepping import Run, Stepping, march
from eomgen.simulation.trajectory import Phase, Status, Trajectory

MOST_PHASES = 1000
MOST_AT_ONCE = 20  # phases that end as soon as they begin, one after the other
AT_ONCE = 1e-9  # s


@dataclass(frozen=True)
class Situation:
    """Where the motion is, and how it goes on.

    Args:
        values: coordinates and rates by name.
        configuration: of the contacts from here on; None where none agrees with the forces.
        impact: the ties that close with a jump of the velocities.
    """

    t: float
    values: Values
    configuration: Configuration | None
    impact: tuple[str, ...] = ()


@dataclass(frozen=True)
class Stretch:
    """One phase as it was run."""

    stage: Stage
    run: Run
    ended_by: str


@dataclass(frozen=True)
class Course:
    """What stays the same through all phases."""

    model: Model
    stages: Stages
    loose: Loose


def course_of(model: Model, p: np.ndarray, target: str | None = None) -> Course:
    return Course(model, Stages(model, p, target), loose(model, p))


def run_phases(
    model: Model, *, time: float | tuple[float, float], p: np.ndarray, parameters: Mapping[str, float] | None = None,
    start: Mapping[str, float] | None = None, target: str | None = None, how: Stepping | None = None,
    samples: int | Sequence[float] | None = None,
) -> Trajectory:  # fmt: skip
    """The motion from the start values, through every change of its contacts.

    Args:
        p: the parameters' values; parameters: those of them that replace the model's.
        start: start values and speeds that replace the model's.
        samples: as of `integrate`; evenly spaced ones are given beside the beginning and the end of every phase.
    Raises:
        DerivationError: the ties do not hold at the start; the reaction of a contact is indeterminate.
    """
    begin, end = (0.0, float(time)) if isinstance(time, (int, float)) else map(float, time)
    instants = instants_of(samples, begin, end)
    course = course_of(model, p, target)
    here = _at_start(course, begin, parameters, start)
    stretches: list[Stretch] = []
    ended: frozenset[Configuration] = frozenset()
    hasty = 0
    while here.configuration is not None and len(stretches) < MOST_PHASES and hasty < MOST_AT_ONCE:
        stage = course.stages.of(here.configuration)
        run = _run(stage, here, end, how or Stepping(), instants)
        if run.crossing is None:
            stretches.append(Stretch(stage, run, run.message))
            return _trajectory(course, stretches, samples, run.status, run.message)
        soon = run.end - here.t <= AT_ONCE
        hasty = hasty + 1 if soon else 0
        ended = frozenset({*(ended if soon else ()), here.configuration})
        after = _next(course, stage, run, ended)
        stretches.append(Stretch(stage, run, _words(course.model, here, after)))
        here = after
    return _trajectory(course, stretches, samples, "contact", _stopped(course, here, len(stretches), hasty), here)


def _run(stage: Stage, here: Situation, end: float, how: Stepping, instants: np.ndarray | None) -> Run:
    """One phase: to the end, or to the first of its bounds."""
    x = stage.state(here.values)
    wanted = None if instants is None else np.concatenate([[here.t], instants[instants > here.t]])
    events = Events(stage.watched, stage.floors(here.t, x)) if stage.bounds else None
    return march(lambda t, x: stage.rhs(t, x, stage.p), (here.t, end), x, how=how, instants=wanted, events=events)


# -- from one phase to the next --------------------------------------------------------------------


def _at_start(
    course: Course, t: float, parameters: Mapping[str, float] | None, start: Mapping[str, float] | None
) -> Situation:
    """The state at the start; a contact that can end may be open there."""
    pieces = {body: 0 for body in paths_of(course.model)}
    ends = course.loose.contacts
    values = _start_values(course, (), pieces, parameters, start)
    if values is None:
        free = _start_values(course, ends, pieces, parameters, start, required=True)
        away = [name for name, (gap, rate) in course.loose.gaps(t, free).items() if _apart(gap, rate, free)]
        values = _start_values(course, away, pieces, parameters, start, required=True)
    _refuse_overlap(course, t, values)
    pieces = {body: _piece_at(course, body, t, values) for body in pieces}
    return _decided(course, t, values, pieces, before=None, ended=frozenset())


def _start_values(
    course: Course, away: Sequence[str], pieces: Mapping[str, int], parameters: Mapping[str, float] | None,
    start: Mapping[str, float] | None, *, required: bool = False,
) -> dict[str, float] | None:  # fmt: skip
    """Coordinates and rates at the start with some contacts open; None where the others do not hold there."""
    stage = course.stages.of(_plain(course.model, pieces, away))
    try:
        found = start_state(stage.system, parameters, start)
    except DerivationError:
        if required or not course.loose.contacts:
            raise
        return None
    return stage.values(0.0, stage.state(found))


def _plain(model: Model, pieces: Mapping[str, int], away: Sequence[str]) -> Configuration:
    """Some contacts open, all others closed, sliding without a sense yet."""
    contacts = contacts_of(on_pieces(model, pieces))
    return Configuration(Table({c.name: Mode(closed=c.name not in away) for c in contacts}), Table(pieces))


def _apart(gap: float, rate: float, values: Values) -> bool:
    return gap > _length(values) or abs(rate) > _speed(values)


def _length(values: Values) -> float:
    return 1e2 * GAP * max([1.0, *(abs(v) for name, v in values.items() if not name.endswith("'"))])


def _speed(values: Values) -> float:
    return RATE * max([1.0, *(abs(v) for name, v in values.items() if name.endswith("'"))])


def _refuse_overlap(course: Course, t: float, values: Values) -> None:
    contacts = {contact.name: contact for contact in contacts_of(course.model)}
    for name, (gap, _) in course.loose.gaps(t, values).items():
        if gap < -_length(values):
            what = "is too short" if contacts[name].pulls else "is passed through"
            raise DerivationError(f"{contacts[name].words} {what} at the start, by {-gap:.3g} m", f"constraints.{name}",
                                  "change the start values")  # fmt: skip


def _piece_at(course: Course, body: str, t: float, values: Values) -> int:
    """The piece on which a body is; between two of them the one into which it moves."""
    stage = course.stages.of(_plain(course.model, {b: 0 for b in paths_of(course.model)}, course.loose.contacts))
    x = stage.state(values)
    s, rate = stage.look(t, x)[body, "along"], stage.look(t, x)[body, "along'"]
    ends = [stage.evaluated(np.array([t]), x[None, :], (stage.system.scope.value(end),))[0, 0]
            for _, end in course.model.bodies[body].joint.bounds()[:-1]]  # fmt: skip
    close = _length(values)
    return sum(s > end - close if rate > 0 else s > end + close for end in ends)


def _next(course: Course, stage: Stage, run: Run, ended: frozenset[Configuration]) -> Situation:
    """What follows the event that ended a phase."""
    assert run.crossing is not None
    bound = stage.bounds[run.crossing.index]
    pieces = dict(stage.configuration.pieces)
    if bound.step:
        pieces[bound.owner] += bound.step
    values = stage.values(run.end, run.last)
    return _decided(course, run.end, values, pieces, before=stage.configuration, ended=ended)


def _decided(
    course: Course, t: float, values: Values, pieces: Mapping[str, int], *, before: Configuration | None,
    ended: frozenset[Configuration],
) -> Situation:  # fmt: skip
    """Velocities after an impact where there is one, and the configuration that then holds."""
    touching = _touching(course, t, values, before)
    rates = {name: course.loose.gaps(t, values)[name][1] for name in touching}
    hit = tuple(name for name, rate in rates.items() if rate < -_speed(values) and _was_open(name, before))
    if hit:
        values = course.loose.after_impact(t, values, touching)
    gaps = course.loose.gaps(t, values)
    apart = frozenset(name for name in gaps if name not in touching or gaps[name][1] > _speed(values))
    configuration = settled(course.stages, t, values, pieces=pieces, apart=apart, ended=ended, before=before)
    return Situation(t, values, configuration, hit)


def _touching(course: Course, t: float, values: Values, before: Configuration | None) -> tuple[str, ...]:
    """The contacts that can end and hold until now, or have no gap."""
    gaps = course.loose.gaps(t, values)
    return tuple(name for name, (gap, _) in gaps.items() if not _was_open(name, before) or gap <= _length(values))


def _was_open(name: str, before: Configuration | None) -> bool:
    return before is None or not before.modes[name].closed


# -- in words --------------------------------------------------------------------------------------


def _words(model: Model, here: Situation, after: Situation) -> str:
    """What ended a phase, and when."""
    assert here.configuration is not None
    when = f"at t = {after.t:.6g} s"
    if after.configuration is None:
        return f"Stopped {when}."
    phrases = changed(model, here.configuration, after.configuration)
    text = ", ".join(phrases) or "the contacts change and return"
    jolt = ", without rebound" if after.impact else ""
    return f"{text} {when}{jolt}"


def _stopped(course: Course, here: Situation, phases: int, hasty: int) -> str:
    names = ", ".join(f"'{contact}'" for contact in _names(course, here))
    when = f"Stopped at t = {here.t:.6g} s: "
    if here.configuration is None:
        return when + f"no forces of the contacts {names} agree with their state; rigid bodies with so much friction jam."
    if hasty >= MOST_AT_ONCE:
        return when + f"the contacts {names} change without end at one instant."
    return when + f"after {phases} phases the contacts {names} still change."


def _names(course: Course, here: Situation) -> tuple[str, ...]:
    pieces = here.configuration.pieces if here.configuration is not None else {b: 0 for b in paths_of(course.model)}
    return tuple(contact.name for contact in contacts_of(on_pieces(course.model, pieces)))


# -- the trajectory --------------------------------------------------------------------------------


def _trajectory(
    course: Course, stretches: Sequence[Stretch], samples: int | Sequence[float] | None, status: Status, message: str,
    here: Situation | None = None,
) -> Trajectory:  # fmt: skip
    """All phases in one table."""
    if not stretches:
        assert here is not None
        stretches = [_standing(course, here, message)]
    coordinates, speeds = _union(course, stretches)
    columns = [stretch.stage.columns(stretch.run.t, stretch.run.x) for stretch in stretches]
    tables = [
        np.column_stack([found.get(name, np.zeros(len(stretch.run.t))) for name in (*coordinates, *speeds)])
        for stretch, found in zip(stretches, columns, strict=True)
    ]  # fmt: skip
    energies = [stretch.stage.energies(stretch.run.t, stretch.run.x) for stretch in stretches]
    ends = np.cumsum([0, *(len(stretch.run.t) for stretch in stretches)])
    full = Trajectory(
        t=np.concatenate([stretch.run.t for stretch in stretches]),
        x=np.concatenate(tables),
        coordinates=coordinates,
        speeds=speeds,
        energy=np.concatenate([T + V for T, V in energies]),
        drift=_drift(stretches, energies),
        gap=_gap(stretches),
        phases=tuple(Phase(float(s.run.t[0]), s.run.end, s.ended_by, (int(first), int(last)), s.stage)
                     for s, first, last in zip(stretches, ends[:-1], ends[1:], strict=True)),
        status=status,
        message=message,
        steps=sum(stretch.run.steps for stretch in stretches),
        evaluations=sum(stretch.run.evaluations for stretch in stretches),
    )  # fmt: skip
    return full if samples is None or isinstance(samples, (int, np.integer)) else _at(full, np.asarray(samples))


def _standing(course: Course, here: Situation, message: str) -> Stretch:
    """The start alone, where nothing can follow it."""
    stage = course.stages.of(_plain(course.model, {b: 0 for b in paths_of(course.model)}, course.loose.contacts))
    x = stage.state(here.values)
    run = Run(np.array([here.t]), x[None, :], here.t, x, "contact", message, 0, 0)
    return Stretch(stage, run, message)


def _union(course: Course, stretches: Sequence[Stretch]) -> tuple[tuple[str, ...], tuple[str, ...]]:
    """Coordinates and speeds of all phases, each in the order in which it comes."""
    coordinates = dict.fromkeys(name for stretch in stretches for name in stretch.stage.coordinates)
    speeds = dict.fromkeys(name for stretch in stretches for name in stretch.stage.speeds)
    return tuple(coordinates), tuple(speeds)


def _drift(stretches: Sequence[Stretch], energies: Sequence[np.ndarray]) -> float | None:
    """The largest of the phases in which energy should stay."""
    kept = [drift_of(T, V) for s, (T, V) in zip(stretches, energies, strict=True) if s.stage.conservative]
    return max(kept, default=None)


def _gap(stretches: Sequence[Stretch]) -> float | None:
    found = [s.stage.gaps(s.run.t, s.run.x) for s in stretches if s.stage.system.ties.closing]
    return max(found, default=None)


def _at(full: Trajectory, instants: np.ndarray) -> Trajectory:
    """The rows at the instants asked for, and where the run ended early also its last."""
    kept = np.isin(full.t, instants) | (np.arange(len(full.t)) == len(full.t) - 1 if not full.ok else False)
    before = np.concatenate([[0], np.cumsum(kept)])
    phases = tuple(replace(p, rows=(int(before[p.rows[0]]), int(before[p.rows[1]]))) for p in full.phases)
    energy = None if full.energy is None else full.energy[kept]
    return replace(full, t=full.t[kept], x=full.x[kept], energy=energy, phases=phases)
