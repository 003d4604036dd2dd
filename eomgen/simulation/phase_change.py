"""Model, start -> PhaseStart: the beginning of a motion, and its continuation after each event.

An event that closes a contact is an impact (`impacts`). Then the configuration is sought that agrees with the forces
(`settling`).
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import replace
from itertools import chain, islice, product
from typing import Any

import numpy as np

from eomgen.errors import DerivationError
from eomgen.frozen import dataclass
from eomgen.mechanics.free_bodies import Indeterminate
from eomgen.mechanics.kinematics import ContactMode
from eomgen.mechanics.start import Start
from eomgen.model import Contact, JointFriction, Model, Table
from eomgen.simulation.contacts import Configuration, bounds_of, on_pieces, stopped_below
from eomgen.simulation.event_location import Crossing
from eomgen.simulation.phase_model import PhaseModel, Values, size_of_places, smallest_speed
from eomgen.simulation.phase_models import OPEN, PhaseModels
from eomgen.simulation.result import Impact
from eomgen.symbolic.expression import gradient
from eomgen.symbolic.numeric import tolerances


@dataclass(frozen=True)
class PhaseStart:
    """State in which a phase begins, and the configuration of its contacts.

    Args:
        values: coordinates and rates by name.
        configuration: of the contacts from here on.
        impact: what happened where velocities jump here; else None.
        limit: of an impact after which contacts do not rebound any more, how long these would go on [s]; else None.
        failure: the reason why it cannot go on, or "".
        begun: of the first, the values to which the start values were changed.
    """

    t: float
    values: Values
    configuration: Configuration
    impact: Impact | None = None
    limit: float | None = None
    failure: str = ""
    begun: Start | None = None

    @staticmethod
    def of(
        models: PhaseModels, t: float, parameters: Mapping[str, Any] | None, start: Mapping[str, float] | None
    ) -> PhaseStart:
        """The state at the start; a contact that can end may be open there. It is found once for the same values.

        Raises:
            DerivationError: the constraints do not hold at the start.
        """
        key = t, tuple((parameters or {}).items()), tuple((start or {}).items())
        starts = models.known["starts"]
        if key not in starts:
            if len(starts) >= MOST_STARTS:
                starts.clear()
            starts[key] = _at_start(models, t, parameters, start)
        found: PhaseStart = starts[key]
        return found

    def after_jump(self, models: PhaseModels) -> PhaseStart:
        """The same state where forces have jumped, with the contact modes from here on."""
        if not models.model.has_phases:
            return self
        pieces = self.configuration.pieces
        found = _decided(models, self.t, self.values, pieces, before=self.configuration, ended=frozenset())
        return replace(found, begun=self.begun)


def next_start(
    models: PhaseModels, phase: PhaseModel, crossing: Crossing, ended: frozenset[Configuration]
) -> PhaseStart:
    """Start of the phase that follows the event which ended a phase.

    Args:
        ended: the configurations that ended at this instant.
    """
    bound = phase.bounds[crossing.index]
    pieces = dict(phase.configuration.pieces)
    if bound.step:
        pieces[bound.owner] += bound.step
    values = phase.values(crossing.t, crossing.x)
    if bound.row:
        what = f"strand {bound.row} of the string '{bound.owner}' goes slack alone, and what follows is not derived"
        return PhaseStart(crossing.t, values, phase.configuration, failure=what)
    if bound.kind == "stops" and phase.watch.contact(bound.owner).surface:
        values = _at_rest_on_surface(models, phase, bound.owner, crossing.t, values)
    together = _ending_together(phase, crossing)
    return _decided(models, crossing.t, values, pieces, before=phase.configuration, ended=ended, together=together)


def _ending_together(phase: PhaseModel, crossing: Crossing) -> frozenset[str]:
    """The contacts that end with the one that ended the phase: N = 0 in them too, and falls; () where it ends alone."""
    bounds, t, x = phase.bounds, crossing.t, crossing.x
    if bounds[crossing.index].kind != "ends" or sum(bound.kind == "ends" for bound in bounds) < 2:
        return frozenset()
    later = np.array([t, t + tolerances.SOON])
    margins = phase.signals.watched(later, np.vstack([x, x + tolerances.SOON * phase.rate(t, x)]))
    at_zero, falls = margins[0] <= phase.signals.floors(t, x), margins[0] - margins[1]
    found = [
        bound.owner
        for bound, ends, fall in zip(bounds, at_zero, falls, strict=True)
        if bound.kind == "ends" and ends and 0 < tolerances.SHARE * falls[crossing.index] < fall
    ]
    return frozenset(found if len(found) > 1 else ())


def _at_rest_on_surface(
    models: PhaseModels, phase: PhaseModel, name: str, t: float, values: dict[str, float]
) -> dict[str, float]:
    """The state in which a contact does not slide: on a surface a speed comes near to 0, and stops there."""
    modes = Table({**phase.configuration.modes, name: ContactMode(sense=0)})
    try:
        held = models.of(replace(phase.configuration, modes=modes))
    except DerivationError:  # nothing can hold it: the next phase says so
        return values
    if held.projection is None:
        return values
    return {**values, **held.values(t, held.projection.closed(t, held.state(values), 0.0)[0])}


LOW = 10 * tolerances.COMPUTED  # [of the coordinates] a flight of what has no restitution
MOST_STARTS = 16  # that are cached


def _at_start(
    models: PhaseModels, t: float, parameters: Mapping[str, Any] | None, start: Mapping[str, float] | None
) -> PhaseStart:
    pieces = {body: 0 for body in models.model.on_paths}
    (begun, values), away = _closed_or_open(models, t, pieces, parameters, start)
    if not models.model.has_phases:
        return PhaseStart(t, values, Configuration(), begun=begun)
    pieces = {body: _piece_at(models, body, t, values) for body in pieces}
    here = _decided(
        models, t, values, pieces, before=plain_configuration(models.model, pieces, away), ended=frozenset()
    )
    return replace(here, begun=begun)


def _closed_or_open(
    models: PhaseModels,
    t: float,
    pieces: Mapping[str, int],
    parameters: Mapping[str, Any] | None,
    start: Mapping[str, float] | None,
) -> tuple[tuple[Start, dict[str, float]], tuple[str, ...]]:
    """((the start, coordinates and rates there), the contacts open there): none, where the values allow it."""

    def values(away: Sequence[str]) -> tuple[Start, dict[str, float]]:
        return models.of(plain_configuration(models.model, pieces, away)).begun(t, parameters, start)

    rebounding = {c.name for c in models.model.contacts if c.restitution is not None}
    try:
        closed = values(())
        if rebounding.isdisjoint(closed[0].hit):
            return closed, ()
    except DerivationError:
        if not models.ends:
            raise
    _, free = values(models.ends)
    _refuse_overlap(models, t, free)
    away = tuple(
        name for name, (gap, rate) in models.without_contacts.gaps(t, free).items() if _apart(models, gap, rate, free)
    )
    return values(away), away


def contacts_away(models: PhaseModels, t: float, start: Mapping[str, float]) -> tuple[str, ...]:
    """The contacts that are open at a start.

    Raises:
        DerivationError: the constraints do not hold there.
    """
    return _closed_or_open(models, t, {}, None, start)[1]


def plain_configuration(model: Model, pieces: Mapping[str, int], away: Sequence[str]) -> Configuration:
    """Some contacts open, all others closed, sliding without a sense yet."""
    contacts = on_pieces(model, pieces).contacts
    return Configuration(Table({c.name: ContactMode(closed=c.name not in away) for c in contacts}), Table(pieces))


def _apart(models: PhaseModels, gap: float, rate: float, values: Values) -> bool:
    return gap > _length(models, values) or abs(rate) > smallest_speed(values)


def _length(models: PhaseModels, values: Values) -> float:
    return 1e2 * tolerances.COMPUTED * size_of_places(values, models.model)


def _refuse_overlap(models: PhaseModels, t: float, values: Values) -> None:
    contacts = {contact.name: contact for contact in models.model.contacts}
    for name, (gap, _) in models.without_contacts.gaps(t, values).items():
        if gap < -_length(models, values):
            unit = models.model.constraints[name].gap_unit(models.model.bodies)
            raise DerivationError(
                f"{contacts[name].is_passed}, by {-gap:.3g} {unit}",
                f"constraints.{name}",
                "change the start values",
            )


def _piece_at(models: PhaseModels, body: str, t: float, values: Values) -> int:
    """The piece on which a body is; between two of them the one into which it moves."""
    phase = models.of(plain_configuration(models.model, {b: 0 for b in models.model.on_paths}, ()))
    link, value = phase.system.motion.link(body), phase.system.scope.value
    requested = (link.s[0], link.s_rate[0], *(value(end) for _, end in bounds_of(models.model, body)[:-1]))
    s, rate, *ends = phase.functions.evaluated(np.array([t]), phase.state(values)[None, :], requested)[0]
    close = _length(models, values)
    return sum(s > end - close if rate > 0 else s > end + close for end in ends)


def _decided(
    models: PhaseModels,
    t: float,
    values: Values,
    pieces: Mapping[str, int],
    *,
    before: Configuration,
    ended: frozenset[Configuration],
    together: frozenset[str] = frozenset(),
) -> PhaseStart:
    """Velocities after an impact where there is one, and the configuration that then holds."""

    def following(resting: frozenset[str] = frozenset()) -> PhaseStart:
        after, apart, hit = _contact(models, t, values, before, resting)
        try:
            found = settled(models, t, after, pieces=pieces, apart=apart, ended=ended, before=before, together=together)
        except DerivationError as error:  # a contact ends that nothing can leave
            return PhaseStart(t, after, before, hit, failure=error.what)
        if found is not None:
            return PhaseStart(t, after, found, hit)
        standing = plain_configuration(models.model, pieces, tuple(apart))
        return PhaseStart(t, after, standing, hit, failure=_jammed(standing))

    try:
        found = following()
        resting: dict[str, float] = {}
        while lowest := _lowest_flights(models, found, without=resting):
            resting |= lowest
            found = replace(following(frozenset(resting)), limit=max(resting.values()) or None)
    except DerivationError as error:  # no law of impact is satisfied
        return PhaseStart(t, values, before, failure=error.what)
    return found


def _lowest_flights(models: PhaseModels, here: PhaseStart, without: Mapping[str, float]) -> dict[str, float]:
    """The contacts that leave an impact no higher than can be told from rounding, and how long they would bounce on.

    The flight is v^2/(2 g_n) high; of all flights 2 v/(g_n (1 - e)) is left. Where something else than its restitution
    lets it leave (a block that rocks from corner to corner) that is not known: 0.
    """
    if here.impact is None or here.failure:
        return {}
    e = models.without_contacts.restitutions
    touched = [name for name in here.impact.impulses if name in models.ends and name in here.configuration.open]
    leaving = [name for name in touched if name not in without]
    if not leaving:
        return {}
    phase, scale = models.of(here.configuration), size_of_places(here.values, models.model)
    seen = phase.signals.look(here.t, phase.state(here.values))
    found = {}
    for name in leaving:
        v, g = (seen.get((name, what), 0.0) for what in ("gap'", "gap''"))
        lowest = tolerances.LOWEST_FLIGHT if e.get(name) else LOW
        if v > 0 > g and v * v <= -2 * g * lowest * scale:
            rebounds = name in here.impact.contact.split(", ") and 0 < e.get(name, 0.0) < 1
            found[name] = 2 * v / (-g * (1 - e[name])) if rebounds else 0.0
    return found


def _contact(
    models: PhaseModels, t: float, values: Values, before: Configuration, resting: frozenset[str]
) -> tuple[Values, frozenset[str], Impact | None]:
    """(values after an impact of the closing contacts, the contacts that are apart, what jumped or None).

    Args:
        resting: contacts that do not rebound any more.
    Raises:
        DerivationError: no impulses satisfy the law of impact.
    """
    if not before.open:
        return values, frozenset(), None
    gaps, rebounding = models.without_contacts.gaps(t, values), models.without_contacts.restitutions
    close = dict.fromkeys(gaps, _length(models, values))
    close |= dict.fromkeys(rebounding, tolerances.LOWEST_FLIGHT * size_of_places(values, models.model))
    touching = [name for name, (gap, _) in gaps.items() if name not in before.open or gap <= close[name]]
    hit: Impact | None = None
    if any(gaps[name][1] < -smallest_speed(values) for name in touching if name in before.open):
        values, hit = models.without_contacts.after_impact(t, values, touching, resting)
        gaps = models.without_contacts.gaps(t, values)
    apart = (name for name, (_, rate) in gaps.items() if name not in touching or rate > smallest_speed(values))
    return values, frozenset(apart), hit


def _jammed(standing: Configuration) -> str:
    names = ", ".join(f"'{name}'" for name in standing.modes)
    return f"no forces of the contacts {names} agree with their state (rigid bodies with so much friction jam)"


# -------- contact decision ------------------------------------------------------------------------------------
# State -> Configuration: which contacts hold, and which of them slide, stick or open, from this instant on.
#
# Of all configurations that the positions and velocities allow, the first whose forces and accelerations agree with
# it:
#
#     closed   N >= 0              sticks   |F| <= mu |N|, and F can hold it: v' = 0
#     open     gap'' >= 0          slides from rest along its sense   sense v' >= 0


MOST_TRIED = 2000  # configurations at one instant
STICKS = ContactMode(sense=0)


def settled(
    phase_models: PhaseModels,
    t: float,
    values: Values,
    *,
    pieces: Mapping[str, int],
    apart: frozenset[str],
    ended: frozenset[Configuration] = frozenset(),
    before: Configuration | None = None,
    together: frozenset[str] = frozenset(),
) -> Configuration | None:
    """The configuration from here on; None where no forces agree with any.

    Args:
        pieces: of the paths, on which bodies are.
        apart: contacts that are open for certain: they do not touch, or move apart.
        ended: configurations that have just ended: taken only where there is no other.
        before: the configuration so far; contacts keep their modes where possible.
        together: contacts that end at this instant together: all of them open, where forces agree with that.
    Raises:
        Indeterminate: something moves, and the balance does not determine how the contacts share the load.
    """
    contacts = on_pieces(phase_models.model, pieces).contacts
    sliding = _sliding(phase_models, contacts, t, values, pieces=pieces, apart=apart)
    last: Configuration | None = None
    apart_one_by_one: Configuration | None = None
    refused: list[DerivationError] = []
    resting = [c for c in contacts if c.size is not None and not sliding[c.name]]
    first = next(_choices(contacts, apart, sliding, before))
    gauss = by_gauss(phase_models, t, values, Configuration(Table(first), Table(pieces)), resting)
    tries = chain(gauss, islice(_choices(contacts, apart, sliding, before), MOST_TRIED))
    rivals: list[Configuration] = []
    static = [c for c in contacts if isinstance(c.friction, JointFriction) and not sliding[c.name]]
    several_static = len(static) > 1 and any(getattr(c.friction, "static", None) is not None for c in static)
    for k, modes in enumerate(tries):
        tried = Configuration(Table(modes), Table(pieces))
        phase = _made(phase_models, tried, refused)
        if phase is None or not agrees(phase, t, values, sliding=sliding, apart=apart):
            continue
        standing = _standing(phase, t, values, sliding=sliding, apart=apart)
        if standing and (undetermined := _indeterminate(refused)) is not None:
            held = {c.name: _closed(c) for c in contacts if c.name in standing}
            at_rest = Configuration(Table({**modes, **held}), Table(pieces))
            if phase_models.of(at_rest).rests(t, values):
                tried = at_rest
            elif not _moves_by_one_law([c for c in contacts if c.name in standing], resting):
                raise undetermined
        if tried not in ended and not any(modes[name].closed for name in together):
            if k < len(gauss) or not several_static:
                return tried
            rivals.append(tried)
        last = last or tried
        apart_one_by_one = apart_one_by_one or (None if tried in ended else tried)
    if len(rivals) > 1:
        raise _contradiction(rivals, static)
    if last is None and refused:
        raise _indeterminate(refused) or refused[0]
    return apart_one_by_one or last


# -------- joints at rest --------------------------------------------------------------------------------------
# Several joints with friction of constant size that rest at once: Gauss's principle.
#
#     tau = arg min of s''(tau) . tau / 2 over |tau_k| <= T_k,    s'' = b + G tau,    G = D M^-1 D^T, closed rows held
#
# has one solution where static friction is kinetic. Where it is above, what breaks loose by its static friction has
# the kinetic one from then on, and the rest is solved again; what stuck sticks. The result may contradict itself: then
# the combinations that agree are counted, and several are named.


def by_gauss(
    phase_models: PhaseModels, t: float, values: Values, near: Configuration, resting: Sequence[Contact]
) -> list[dict[str, ContactMode]]:
    """The modes of all contacts with those of several resting joints by Gauss's principle; [] where fewer rest."""
    if len(resting) < 2:
        return []
    modes = {**near.modes, **{c.name: ContactMode(sense=1) for c in resting}}
    phase = phase_models.of(replace(near, modes=Table(modes)))
    system = phase.system
    rates = [system.sliding_velocity(c) for c in resting]
    u, n, k = system.symbols.u, len(resting), len(phase.equations.J)
    declared = [x for c in resting for x in (c.size, c.grip) if x is not None]
    sizes = tuple(ContactMode.size_of(system.scope, x) for x in declared)
    rows = (*phase.equations.M, *phase.equations.J, *(gradient(rate, u) for rate in rates))
    scalars = (*sizes, *system.scope.with_accelerations(tuple(rates)), *(x for row in rows for x in row))
    found = phase.functions.evaluated(np.array([t]), phase.state(values)[None, :], scalars)[0]
    if not np.all(np.isfinite(found)):
        return []
    kinetic, static = found[: 2 * n].reshape(n, 2).T
    M, J, D = np.split(found[3 * n :].reshape(-1, len(u)), [len(u), len(u) + k])
    matrix = np.block([[M, -J.T], [J, np.zeros((k, k))]])
    G = D @ np.linalg.lstsq(matrix, np.vstack([D.T, np.zeros((k, n))]), rcond=None)[0][: len(u)]
    b = found[2 * n : 3 * n] + G @ kinetic
    senses = senses_from_rest(G, b, kinetic, static)
    return [{**near.modes, **{c.name: ContactMode(sense=s) for c, s in zip(resting, senses, strict=True)}}]


def senses_from_rest(G: np.ndarray, b: np.ndarray, kinetic: np.ndarray, static: np.ndarray) -> list[int]:
    """The sense in which each joint begins to move, 0 of those that stick: s'' = b + G tau of joints at rest.

    Args:
        G, b: n x n, n; symmetric, positive where nothing is redundant.
        kinetic, static: the friction while it slides, and the largest at rest, n.
    """
    from scipy.optimize import lsq_linear

    found, V = np.linalg.eigh((G + G.T) / 2)
    kept = found > tolerances.SUMMED * max(float(np.max(np.abs(found), initial=0.0)), tolerances.TINIEST)
    root = np.sqrt(found[kept])
    A, right = root[:, None] * V[:, kept].T, (V[:, kept].T @ b) / root
    senses = np.zeros(len(b), dtype=int)
    for _ in range(len(b)):
        stuck = senses == 0
        due = right - A[:, ~stuck] @ (senses * kinetic)[~stuck]
        if not np.any(stuck) or not len(A):
            break
        bound = np.maximum(static[stuck], np.finfo(float).tiny)
        tau = lsq_linear(A[:, stuck], -due, (-bound, bound), method="bvls").x
        loose = np.abs(tau) >= (1 - tolerances.COMPUTED) * bound
        if not np.any(loose):
            break
        senses[np.flatnonzero(stuck)[loose]] = -np.sign(tau[loose]).astype(int)
    return senses.tolist()


def _contradiction(rivals: Sequence[Configuration], resting: Sequence[Contact]) -> DerivationError:
    """Error: static friction above kinetic leaves several ways in which joints at rest go on."""
    words = {-1: "slips back", 0: "sticks", 1: "slips on"}
    ways = [", ".join(f"'{c.name}' {words[way.modes[c.name].sense or 0]}" for c in resting) for way in rivals]
    what = f"static friction above kinetic leaves {len(ways)} ways to go on from rest: {'; or '.join(ways)}"
    return DerivationError(what, resting[0].declared_at, "leave out `static`, or start with a speed")


def _moves_by_one_law(standing: Sequence[Contact], joints: Sequence[Contact]) -> bool:
    """True if the motion is single though forces are not: friction at rest in joints, of a size of its own.

    What a stop and the dry friction of its joint share at rest is open; when it leaves the stop is not.
    """
    rough = (contact for contact in standing if contact.grip is not None)
    return bool(joints) and all(contact.size is not None for contact in rough)


def _closed(contact: Contact) -> ContactMode:
    return STICKS if contact.dry else ContactMode()


def _made(phase_models: PhaseModels, tried: Configuration, refused: list[DerivationError]) -> PhaseModel | None:
    """The phase of a configuration; where there is none, or its forces are not determined, why is noted."""
    try:
        phase = phase_models.of(tried)
    except DerivationError as error:  # nothing can leave a contact that is open in it, or hold one that sticks
        refused.append(error)
        return None
    if phase.watch.undetermined is not None:
        refused.append(phase.watch.undetermined)
    return phase if phase.watch.undetermined is None else None


def _indeterminate(refused: list[DerivationError]) -> Indeterminate | None:
    return next((error for error in refused if isinstance(error, Indeterminate)), None)


def _sliding(
    phase_models: PhaseModels,
    contacts: tuple[Contact, ...],
    t: float,
    values: Values,
    *,
    pieces: Mapping[str, int],
    apart: frozenset[str],
) -> dict[str, int]:
    """The sense of sliding of every contact with Coulomb friction; 0 where it does not slide."""
    if not any(contact.dry for contact in contacts):
        return {}
    closed = Configuration(Table({c.name: OPEN if c.name in apart else ContactMode() for c in contacts}), Table(pieces))
    found, still = phase_models.slides(closed).at(t, values), smallest_speed(values)
    least = {c.name: max(still, 2 * stopped_below(c)) for c in contacts}
    return {name: 0 if abs(v) <= least[name] else 1 if v > 0 else -1 for name, v in found.items()}


def _choices(
    contacts: tuple[Contact, ...], apart: frozenset[str], sliding: Mapping[str, int], before: Configuration | None
) -> Iterator[dict[str, ContactMode]]:
    """The modes that positions and velocities allow, those that hold before those that let go."""
    offered = []
    for contact in contacts:
        modes = [OPEN] if contact.name in apart else _modes(contact, sliding.get(contact.name, 0), before)
        offered.append([(contact.name, mode) for mode in modes])
    for choice in product(*offered):
        yield dict(choice)


def _modes(contact: Contact, sense: int, before: Configuration | None) -> list[ContactMode]:
    if contact.friction is None:
        return [ContactMode(), OPEN]
    old = None if before is None else before.modes.get(contact.name)
    first = 1 if old is None else old.push
    pushes = (first, -first) if contact.holds_both_ways else (1,)
    if not contact.dry:
        modes = [ContactMode(push=push) for push in pushes]
    elif sense:
        modes = [ContactMode(sense=sense, push=push) for push in pushes]
    else:
        senses = (1,) if contact.surface else (1, -1)
        modes = [STICKS, *(ContactMode(sense=s, push=push) for s in senses for push in pushes)]
    return [*modes, OPEN] if contact.unilateral else modes


def agrees(phase: PhaseModel, t: float, values: Values, *, sliding: Mapping[str, int], apart: frozenset[str]) -> bool:
    """True if forces and accelerations agree with the configuration; an N without a single value contradicts none."""
    x = phase.state(values)
    found = phase.signals.look(t, x)
    forces, accelerations = phase.signals.sizes(t, x)
    sticks = any(phase.watch.mode(contact) == STICKS for contact in phase.contacts)
    if sticks and not phase.signals.rows_hold(t, x):
        return False
    requested = [contact for contact in phase.contacts if contact.name not in apart]
    signs = [_signs(phase.watch.mode(contact), contact, found, sliding.get(contact.name, 0)) for contact in requested]
    return not any(
        force < -tolerances.COMPUTED * forces or acceleration < -tolerances.COMPUTED * accelerations
        for pairs in signs
        for force, acceleration in pairs
    )


def _standing(
    phase: PhaseModel, t: float, values: Values, *, sliding: Mapping[str, int], apart: frozenset[str]
) -> tuple[str, ...]:
    """The contacts that are to begin sliding or to part, and do not: one way of many in which all of them hold."""
    x = phase.state(values)
    found, (_, size) = phase.signals.look(t, x), phase.signals.sizes(t, x)
    accelerations = {}
    for contact in phase.contacts:
        mode, name = phase.watch.mode(contact), contact.name
        if mode.closed and mode.sense and not sliding[name]:
            accelerations[name] = found[name, "slide'"]
        elif not mode.closed and name not in apart:
            accelerations[name] = found[name, "gap''"]
    return tuple(name for name, a in accelerations.items() if abs(a) <= tolerances.COMPUTED * size)


def _signs(
    mode: ContactMode, contact: Contact, found: Mapping[tuple[str, str], float], sense: int
) -> Iterator[tuple[float, float]]:
    """(force, acceleration) that must not be negative (0 where there is nothing to ask)."""
    name = contact.name
    if not mode.closed:
        yield 0.0, found[name, "gap''"]
        return
    if contact.unilateral or mode.sense != 0:
        yield from ((mode.push * N, 0.0) for (owner, what), N in found.items() if owner == name and what[0] == "N")
    if mode.sense == 0:
        grip = found[name, "grip"] * abs(found.get((name, "N"), 1.0)) - abs(found[name, "hold"])
        yield grip if np.isfinite(found[name, "hold"]) else -np.inf, -abs(found[name, "slide'"])  # at a dead centre
    elif mode.sense is not None and sense == 0 and not contact.surface:
        yield 0.0, mode.sense * found[name, "slide'"]
