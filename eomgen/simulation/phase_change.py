"""Model, start -> PhaseStart: where a motion begins, and how it goes on after each event.

An event that closes a contact is an impact without rebound. Then the configuration is sought that agrees with the
forces (`settling`).
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np

from eomgen.errors import DerivationError
from eomgen.mechanics.bodies.contact_modes import ContactMode
from eomgen.mechanics.equations.assembly import Assembly
from eomgen.mechanics.equations.stabilization import PullBack
from eomgen.mechanics.equations.system import System
from eomgen.mechanics.initial_state.initial_state import Start
from eomgen.model.contacts import contacts_of
from eomgen.model.parts import Model
from eomgen.model.table import Table
from eomgen.simulation.configuration import Configuration, bounds_of, has_phases, on_pieces, paths_of
from eomgen.simulation.contact_decision import settled
from eomgen.simulation.event_location import Crossing
from eomgen.simulation.impact import Loose
from eomgen.simulation.phase_model import PhaseModel, Values, smallest_speed
from eomgen.simulation.phase_models import PhaseModels
from eomgen.symbolic.numeric.tolerances import COMPUTED


@dataclass(frozen=True)
class PhaseStart:
    """Where the motion is, and how it goes on.

    Args:
        values: coordinates and rates by name.
        configuration: of the contacts from here on.
        impact: whether velocities jump here.
        failure: why it cannot go on, or "".
        begun: of the first, what the start values were changed to.
    """

    t: float
    values: Values
    configuration: Configuration
    impact: bool = False
    failure: str = ""
    begun: Start | None = None


@dataclass(frozen=True)
class Course:
    """What stays the same through all phases."""

    model: Model
    phase_models: PhaseModels

    @property
    def loose(self) -> Loose:
        """The model without the contacts that can end."""
        return self.phase_models.loose

    def after(self, phase: PhaseModel, crossing: Crossing, ended: frozenset[Configuration]) -> PhaseStart:
        """What follows the event that ended a phase."""
        bound = phase.bounds[crossing.index]
        pieces = dict(phase.configuration.pieces)
        if bound.step:
            pieces[bound.owner] += bound.step
        values = phase.values(crossing.t, crossing.x)
        if bound.row:
            what = f"strand {bound.row} of the string '{bound.owner}' goes slack alone, and what follows is not derived"
            return PhaseStart(crossing.t, values, phase.configuration, failure=what)
        if bound.kind == "stops" and phase.contact(bound.owner).surface:
            values = self._stopped(phase, bound.owner, crossing.t, values)
        return _decided(self, crossing.t, values, pieces, before=phase.configuration, ended=ended)

    def _stopped(self, phase: PhaseModel, name: str, t: float, values: dict[str, float]) -> dict[str, float]:
        """The state in which a contact does not slide: on a surface a speed comes near to 0, and stops there."""
        modes = Table({**phase.configuration.modes, name: ContactMode(sense=0)})
        try:
            held = self.phase_models.of(replace(phase.configuration, modes=modes))
        except DerivationError:  # nothing can hold it: the next phase says so
            return values
        if held.projection is None:
            return values
        return {**values, **held.values(t, held.projection.closed(t, held.state(values), 0.0)[0])}


def course_of(
    model: Model,
    p: np.ndarray,
    target: str | None = None,
    rates: PullBack | None = None,
    derived: tuple[System, Assembly] | None = None,
) -> Course:
    """The phases of a model, none of them made yet; rates, derived: as of PhaseModels."""
    return Course(model, PhaseModels(model, p, target, rates, derived))


def at_start(
    course: Course, t: float, parameters: Mapping[str, float] | None, start: Mapping[str, float] | None
) -> PhaseStart:
    """The state at the start; a contact that can end may be open there.

    Raises:
        DerivationError: the ties do not hold at the start.
    """
    pieces = {body: 0 for body in paths_of(course.model)}
    (begun, values), away = _closed_or_open(course, t, pieces, parameters, start)
    if not has_phases(course.model):
        return PhaseStart(t, values, Configuration(), begun=begun)
    pieces = {body: _piece_at(course, body, t, values) for body in pieces}
    here = _decided(course, t, values, pieces, before=plain(course.model, pieces, away), ended=frozenset())
    return replace(here, begun=begun)


def _closed_or_open(
    course: Course,
    t: float,
    pieces: Mapping[str, int],
    parameters: Mapping[str, float] | None,
    start: Mapping[str, float] | None,
) -> tuple[tuple[Start, dict[str, float]], tuple[str, ...]]:
    """((the start, coordinates and rates there), the contacts open there): none, where the values allow it."""

    def values(away: Sequence[str]) -> tuple[Start, dict[str, float]]:
        return course.phase_models.of(plain(course.model, pieces, away)).begun(t, parameters, start)

    try:
        return values(()), ()
    except DerivationError:
        if not course.phase_models.ends:
            raise
    _, free = values(course.phase_models.ends)
    _refuse_overlap(course, t, free)
    away = tuple(name for name, (gap, rate) in course.loose.gaps(t, free).items() if _apart(gap, rate, free))
    return values(away), away


def plain(model: Model, pieces: Mapping[str, int], away: Sequence[str]) -> Configuration:
    """Some contacts open, all others closed, sliding without a sense yet."""
    contacts = contacts_of(on_pieces(model, pieces))
    return Configuration(Table({c.name: ContactMode(closed=c.name not in away) for c in contacts}), Table(pieces))


def _apart(gap: float, rate: float, values: Values) -> bool:
    return gap > _length(values) or abs(rate) > smallest_speed(values)


def _length(values: Values) -> float:
    return 1e2 * COMPUTED * max([1.0, *(abs(v) for name, v in values.items() if not name.endswith("'"))])


def _refuse_overlap(course: Course, t: float, values: Values) -> None:
    contacts = {contact.name: contact for contact in contacts_of(course.model)}
    for name, (gap, _) in course.loose.gaps(t, values).items():
        if gap < -_length(values):
            what = "is too short" if contacts[name].pulls else "is passed through"
            raise DerivationError(
                f"{contacts[name].words} {what} at the start, by {-gap:.3g} m",
                f"constraints.{name}",
                "change the start values",
            )


def _piece_at(course: Course, body: str, t: float, values: Values) -> int:
    """The piece on which a body is; between two of them the one into which it moves."""
    phase = course.phase_models.of(plain(course.model, {b: 0 for b in paths_of(course.model)}, ()))
    link, value = phase.system.motion.link(body), phase.system.scope.value
    asked = (link.s[0], link.s_rate[0], *(value(end) for _, end in bounds_of(course.model, body)[:-1]))
    s, rate, *ends = phase.evaluated(np.array([t]), phase.state(values)[None, :], asked)[0]
    close = _length(values)
    return sum(s > end - close if rate > 0 else s > end + close for end in ends)


def _decided(
    course: Course,
    t: float,
    values: Values,
    pieces: Mapping[str, int],
    *,
    before: Configuration,
    ended: frozenset[Configuration],
) -> PhaseStart:
    """Velocities after an impact where there is one, and the configuration that then holds."""
    values, apart, hit = _contact(course, t, values, before) if before.open else (values, frozenset(), False)
    try:
        found = settled(course.phase_models, t, values, pieces=pieces, apart=apart, ended=ended, before=before)
    except DerivationError as error:  # a contact ends that nothing can leave
        return PhaseStart(t, values, before, hit, error.what)
    if found is not None:
        return PhaseStart(t, values, found, hit)
    standing = plain(course.model, pieces, tuple(apart))
    return PhaseStart(t, values, standing, hit, _jammed(standing))


def _contact(course: Course, t: float, values: Values, before: Configuration) -> tuple[Values, frozenset[str], bool]:
    """(values after an impact of what closes, the contacts that are apart, whether velocities jumped)."""
    gaps = course.loose.gaps(t, values)
    touching = [name for name, (gap, _) in gaps.items() if name not in before.open or gap <= _length(values)]
    hit = any(gaps[name][1] < -smallest_speed(values) for name in touching if name in before.open)
    if hit:
        values = course.loose.after_impact(t, values, touching)
        gaps = course.loose.gaps(t, values)
    apart = (name for name, (_, rate) in gaps.items() if name not in touching or rate > smallest_speed(values))
    return values, frozenset(apart), hit


def _jammed(standing: Configuration) -> str:
    names = ", ".join(f"'{name}'" for name in standing.modes)
    return f"no forces of the contacts {names} agree with their state (rigid bodies with so much friction jam)"
