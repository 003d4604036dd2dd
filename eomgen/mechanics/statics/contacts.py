"""Model -> the states of its contacts at the start and at rest, and how far dry friction keeps it at rest."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import field
from functools import cached_property, partial
from itertools import islice, pairwise, product
from random import Random
from typing import Literal

from eomgen.errors import DerivationError, MissingValues, ModelError, OpenConstraints, UsageError
from eomgen.frozen import dataclass, recalled
from eomgen.mechanics.constraints import Row
from eomgen.mechanics.dynamics import EquationsOfMotion, System, exact_accelerations
from eomgen.mechanics.free_bodies import Reactions, SystemFriction, equations_of_motion
from eomgen.mechanics.kinematics import ContactMode, ContactModes, SystemScene
from eomgen.mechanics.start import Start
from eomgen.model import Contact, JointFriction, Model
from eomgen.symbolic.exact import simplest
from eomgen.symbolic.expression import (
    Node,
    Scalar,
    State,
    depends_on,
    function,
    over,
    sqrt,
    substituted,
    symbols_of,
)
from eomgen.symbolic.numeric import FLOAT, NoValue, Work, evaluate, fifty_digits, tolerances
from eomgen.symbolic.print import to_text

# -------- contacts at start -----------------------------------------------------------------------------------
# Model -> how its contacts are at the start, by numbers of the start alone; nothing is simulated.
#
# A contact that can end is open where its gap is positive there, or where it opens with the speeds. Of those that
# touch the ones leave at once that would have to pull with the accelerations that follow: of all configurations the
# first that agrees is taken, what holds before what lets go, as a run chooses.
#
#     closed   N >= 0              open     gap'' >= 0
#
# A bilateral contact with friction pushes along its normal or against it, by the sign of N there: N with friction for
# that sign. Where a number is missing, or the start does not hold, a contact is taken as closed, pushing along its
# normal, and that is said.


ROUNDS = 4  # of signs of N, each with the friction of the one before
MOST_TRIED = 256  # configurations of contacts that touch
SEEDS = tuple(range(11, 17))  # of values for parameters that have none: they must agree on what leaves
OPEN = ContactMode(closed=False)
Numbers = Mapping[str, float]


@dataclass(frozen=True)
class ContactsAtStart:
    """States of the contacts of a model at its start.

    Args:
        modes: of those that are not closed, or push against their normals.
        assumptions: the assumptions made, in words: "floor assumed closed: h has no value".
    """

    modes: ContactModes = field(default_factory=dict)
    assumptions: tuple[str, ...] = ()

    @staticmethod
    def of(model: Model) -> ContactsAtStart:
        """The contacts that the start values leave open, and those that push against their normals there.

        Without coordinates what is rough sticks. Of one model they are found once.
        """
        if not model.contacts:
            return ContactsAtStart()
        return recalled(model, ContactsAtStart.of, lambda: _at_start(model))

    @staticmethod
    def at_rest(model: Model) -> ContactModes:
        """Every contact with dry friction sticks."""
        return {contact.name: ContactMode(sense=0) for contact in model.rough_contacts}

    @staticmethod
    def held_by_friction(model: Model) -> ContactModes:
        """Every contact with dry friction sticks where the model starts, and stops that are open there stay so.

        What moves all the same rests on its stop at the best; then the stop is taken as closed, if it is the only one.
        """
        sticking = ContactsAtStart.at_rest(model)
        stops = [contact for contact in model.contacts if contact.unilateral and contact.name not in sticking]
        found = _StartNumbers(model).open_contacts([contact.name for contact in stops]).modes
        modes = {**sticking, **{name: mode for name, mode in found.items() if not mode.closed}}
        both = len({contact.body for contact in stops}) < len(stops)  # ends of one joint's way: never held together
        return modes if both or not System.of(model, modes).has_degrees_of_freedom else sticking

    @staticmethod
    def refuse_open(held: System) -> None:
        """Refuses a structure at a start where a contact that is taken as closed is open.

        Raises:
            OpenConstraints: it is named, with where it closes.
        """
        try:
            Start.of(held)
        except OpenConstraints:
            raise
        except (DerivationError, MissingValues, ModelError, UsageError):
            return  # a start without values, or with a speed: contacts are taken as they are declared

    @staticmethod
    def resting(model: Model) -> tuple[str, ...]:
        """Contacts with dry friction that touch at the start and do not slide there, by name: friction has no sign yet.

        Whether they stick or begin to slide the first phase of the motion decides. () where parameters have no value.
        """
        if not model.coordinates or not any(c.dry for c in model.contacts):
            return ()
        start = _StartNumbers(model)
        try:
            return () if start.missing else tuple(sorted(start.still(ContactsAtStart.of(model).modes)))
        except (DerivationError, ModelError, UsageError, NoValue):
            return ()


def _at_start(model: Model) -> ContactsAtStart:
    contacts = model.contacts
    if not model.coordinates:
        return ContactsAtStart(dict(ContactsAtStart.at_rest(model)))
    start = _StartNumbers(model)
    ending = [c for c in contacts if c.unilateral]
    opened = start.open_contacts([c.name for c in ending])
    touching = [c for c in ending if opened.modes.get(c.name, ContactMode()).closed]
    if touching and not opened.assumptions:
        let_go = start.leaving(touching, opened.modes)
        opened = ContactsAtStart({**opened.modes, **let_go.modes}, let_go.assumptions)
    both_ways = [c for c in contacts if c.holds_both_ways]
    pushing = start.pushing(both_ways, opened.modes) if both_ways else ContactsAtStart()
    return ContactsAtStart({**opened.modes, **pushing.modes}, (*opened.assumptions, *pushing.assumptions))


@dataclass(frozen=True)
class _StartNumbers:
    """The start of a model in numbers; missing ones are drawn at random."""

    model: Model

    @cached_property
    def _known(self) -> dict[frozenset[tuple[str, ContactMode]], EquationsOfMotion]:
        return {}

    def _equations(self, modes: ContactModes) -> EquationsOfMotion:
        """The equations of motion under these modes, derived once: the values of parameters alone differ."""
        key = frozenset(modes.items())
        if key not in self._known:
            self._known[key] = equations_of_motion(System.of(self.model, modes))
        return self._known[key]

    @property
    def missing(self) -> tuple[str, ...]:
        known = self.model.exact_parameters()
        return tuple(name for name in self.model.parameters if name not in known)

    @cached_property
    def drawn(self) -> Numbers:
        rng = Random(11)
        return {name: rng.uniform(0.7, 1.3) for name in self.missing}

    def _far(self, seed: int) -> Numbers:
        """Values drawn for the parameters without one, between 0.1 and 10."""
        rng = Random(seed)
        return {name: 10 ** rng.uniform(-1, 1) for name in self.missing}

    def open_contacts(self, names: Sequence[str]) -> ContactsAtStart:
        """Contacts that can end and have a positive gap; none where the start leaves all of them closed."""
        if not names:
            return ContactsAtStart()
        rebounding = {c.name for c in self.model.contacts if c.restitution is not None}
        try:
            if rebounding.isdisjoint(Start.of(System.of(self.model), self.drawn).hit):
                return ContactsAtStart()
            return self._by_gaps(names)
        except DerivationError:  # as a start that leaves a contact open is refused
            return self._by_gaps(names)
        except (ModelError, UsageError) as error:
            return ContactsAtStart({}, tuple(_closed(name, error.what) for name in names))

    def _by_gaps(self, names: Sequence[str]) -> ContactsAtStart:
        try:
            free = System.of(self.model, dict.fromkeys(names, OPEN))
            gaps, rates = _gaps(free, names, self.drawn), _rates(free, names, self.drawn)
            others = {p: _gaps(free, names, {**self.drawn, p: 1.7 * self.drawn[p]}) for p in self.missing}
        except (DerivationError, ModelError, UsageError) as error:
            why = _lacking(self.missing) if self.missing else error.what
            return ContactsAtStart({}, tuple(_closed(name, why) for name in names))
        modes, assumptions = {}, []
        for name, gap in gaps.items():
            lacking = [
                p for p, found in others.items() if abs(found[name] - gap) > tolerances.COMPUTED * (1 + abs(gap))
            ]
            if lacking:
                assumptions.append(_closed(name, _lacking(lacking)))
            elif gap > tolerances.CARRIED or (gap >= -tolerances.CARRIED and self._moves(name, rates[name])):
                modes[name] = OPEN
            elif gap < -tolerances.CARRIED:
                unit = self.model.constraints[name].gap_unit(self.model.bodies)
                assumptions.append(_closed(name, f"the start passes through it, by {-gap:.3g} {unit}"))
        return ContactsAtStart(modes, tuple(assumptions))

    def _moves(self, name: str, rate: float) -> bool:
        """True if a contact that touches opens, or is hit and rebounds."""
        rebounds = any(c.name == name and c.restitution is not None for c in self.model.contacts)
        return rate > tolerances.CARRIED or (rebounds and rate < -tolerances.CARRIED)

    def leaving(self, touching: Sequence[Contact], opened: ContactModes) -> ContactsAtStart:
        """Touching contacts that would have to pull: they open at once."""
        seeds = SEEDS if self.missing else SEEDS[:1]
        try:
            found = [self._let_go(touching, opened, self._far(seed)) for seed in seeds]
        except (DerivationError, ModelError, UsageError, NoValue, ZeroDivisionError):
            return ContactsAtStart()  # no force of a contact follows there, or a speed breaks one: all stay as they are
        if any(each != found[0] for each in found):
            names = sorted(set().union(*(each or () for each in found)))
            return ContactsAtStart({}, tuple(_closed(name, _lacking(self.missing)) for name in names))
        return ContactsAtStart(dict.fromkeys(found[0] or (), OPEN))

    def _let_go(self, touching: Sequence[Contact], opened: ContactModes, drawn: Numbers) -> tuple[str, ...] | None:
        """The contacts that open by the forces; None where no configuration agrees with them."""
        still = self.still(opened) if any(c.dry for c in touching) else set()
        for away in islice(product(*((False, True) for _ in touching)), MOST_TRIED):
            free = [c for c, opens in zip(touching, away, strict=True) if opens]
            held = [c for c in touching if c not in free]
            sticking = {c.name: ContactMode(sense=0) for c in held if c.name in still}
            if self._agrees({**opened, **sticking, **{c.name: OPEN for c in free}}, held, free, drawn):
                return tuple(c.name for c in free)
        return None

    def _agrees(self, modes: ContactModes, held: Sequence[Contact], free: Sequence[Contact], drawn: Numbers) -> bool:
        """True if the held contacts push and the free ones open, with the accelerations at the start."""
        equations = self._equations(modes)
        system = equations.system
        reactions, scope = Reactions.of(system), system.scope
        forces = [x for contact in held for x in _forces(reactions, contact)]
        state = _state(system, drawn)
        state |= dict(zip(system.symbols.a, exact_accelerations(equations, state), strict=True))
        rates = tuple(Row.of_constraint(system.motion, contact.name)[0].velocity for contact in free)
        digits = fifty_digits()
        pushes = evaluate(forces, state, digits)
        opening = evaluate(scope.with_accelerations(rates), state, digits) if rates else []
        size = max(map(abs, (*pushes, *evaluate(equations.forcing, state, digits))), default=0)
        fastest = max((abs(state[a]) for a in system.symbols.a), default=0)
        return all(N >= -tolerances.CARRIED * size for N in pushes) and all(
            x >= -tolerances.CARRIED * fastest for x in opening
        )

    def pushing(self, contacts: Sequence[Contact], opened: ContactModes) -> ContactsAtStart:
        """Contacts that push against their normals: N < 0, with the friction of that same sign."""
        signs = {contact.name: 1 for contact in contacts}
        try:
            for _ in range(ROUNDS):
                found = self._signs(contacts, signs, opened)
                if found == signs:
                    break
                signs = found
        except _Lacking as lacking:
            return ContactsAtStart({}, tuple(_pushing(c.name, _lacking(lacking.names)) for c in contacts))
        except (DerivationError, ModelError, UsageError, NoValue) as error:
            why = error.what if isinstance(error, ModelError | DerivationError | UsageError) else str(error)
            return ContactsAtStart({}, tuple(_pushing(c.name, why) for c in contacts))
        return ContactsAtStart({name: ContactMode(push=-1) for name, sign in signs.items() if sign < 0})

    def _signs(self, contacts: Sequence[Contact], signs: Mapping[str, int], opened: ContactModes) -> dict[str, int]:
        """The sign of N of each contact, with the friction of given signs; what does not slide sticks."""
        still = self.still(opened)
        modes = {c.name: ContactMode(sense=0) if c.name in still else ContactMode(push=signs[c.name]) for c in contacts}
        equations = self._equations({**opened, **modes})
        system = equations.system
        reactions = Reactions.of(system)
        normals = {c.name: reactions.normal(c.name) for c in contacts}
        entries = (*normals.values(), *equations.forcing, *(x for row in equations.M for x in row))
        if lacking := [x.name for x in symbols_of(entries) if x.name in self.missing]:
            raise _Lacking(tuple(lacking))
        state = _state(system, self.drawn)
        state |= dict(zip(system.symbols.a, exact_accelerations(equations, state), strict=True))
        values = evaluate(tuple(normals.values()), state, fifty_digits())
        return {name: -1 if N < -tolerances.CARRIED else 1 for name, N in zip(normals, values, strict=True)}

    def still(self, opened: ContactModes) -> set[str]:
        """The contacts with dry friction that do not slide at the start."""
        system = System.of(self.model, opened)
        state, rough = _state(system, self.drawn), {c.name for c in self.model.contacts if c.dry}
        sliding: list[tuple[str, Scalar]] = [(name, v) for name, _, v in SystemFriction(system).named if name in rough]
        for contact in self.model.contacts:
            if contact.size is not None:
                sliding.append((contact.name, SystemScene(system.motion).slip(contact)))
        values = evaluate(tuple(v for _, v in sliding), state, fifty_digits())
        return {name for (name, _), v in zip(sliding, values, strict=True) if abs(v) <= tolerances.CARRIED}


class _Lacking(Exception):
    """Error: the result depends on parameters without values."""

    def __init__(self, names: tuple[str, ...]) -> None:
        self.names = names


def _state(system: System, drawn: Numbers) -> State:
    """Every symbol of a system at the start but a, multipliers 0."""
    symbols, values = system.symbols, Start.of(system, drawn).values
    known = {**system.scope.model.exact_parameters(drawn), **values}
    nodes = {**symbols.parameters, **{x.name: x for x in symbols.x}}
    state = {node: fifty_digits().number(float(known[name])) for name, node in nodes.items()}
    state |= {x: fifty_digits().number(0.0) for x in (symbols.t, *symbols.lam)}
    own = evaluate(tuple(system.inputs[name] for name in symbols.inputs), state, fifty_digits())
    return state | dict(zip(symbols.inputs.values(), own, strict=True))


def _gaps(free: System, names: Sequence[str], drawn: Numbers) -> dict[str, float]:
    """Gap of each contact at the start; a strand that has no gap is taut."""
    state = _state(free, drawn)
    gaps = {name: Row.of_constraint(free.motion, name)[0].gap for name in names}
    values = evaluate(tuple(0 if gap is None else gap for gap in gaps.values()), state, fifty_digits())
    return {name: float(value) for name, value in zip(gaps, values, strict=True)}


def _rates(free: System, names: Sequence[str], drawn: Numbers) -> dict[str, float]:
    """Rate at which each contact opens at the start."""
    values = evaluate(
        tuple(Row.of_constraint(free.motion, name)[0].velocity for name in names), _state(free, drawn), fifty_digits()
    )
    return {name: float(value) for name, value in zip(names, values, strict=True)}


def _forces(reactions: Reactions, contact: Contact) -> list[Scalar]:
    """Forces that must not be negative while the contact is closed: N, of a string the tension of every strand."""
    if not contact.pulls:
        return [reactions.normal(contact.name)]
    rows = reactions.balance.system.scope.model.constraints[contact.name].strand_rows()
    return [reactions.tension(contact.name, k + 1) for k in range(max(1, len(rows)))]


def _closed(name: str, why: str) -> str:
    return f"{name} assumed closed: {why}"


def _pushing(name: str, why: str) -> str:
    return f"{name} assumed to push along its normal: {why}"


def _lacking(names: Sequence[str]) -> str:
    listed = ", ".join(dict.fromkeys(names))
    return f"{listed} {'has' if len(set(names)) == 1 else 'have'} no value"


# -------- rest contacts ---------------------------------------------------------------------------------------
# Model -> the states of its contacts at rest; reactions -> conditions for these states.
#
# At rest a rough contact does not slide: its friction is a reaction like others, as long as |F| <= mu N. A contact
# that can only push, or only pull, needs N >= 0.


# -------- ranges of rest --------------------------------------------------------------------------------------
# System whose contacts and joints with dry friction stick -> RestRange: how far it stays at rest.
#
#     abs(F)/N <= mu_s of a contact or slide, mu_s r of a hinge;   abs(F) <= F_s where its size is constant
#
# F is the friction that holds at rest, a function of the coordinates. The limits of a coordinate are where a
# condition ends, the others as they stand: from there on motion begins.


STEPS_OF_SEARCH = 400  # of the search to each side
FURTHEST = 1e4  # of a displacement [m]
OfPlace = Callable[[float], float]


@dataclass(frozen=True)
class StickCondition:
    """Condition under which a contact or a joint sticks: ratio between - most and most.

    Args:
        contact: its name.
        ratio: F/N, or F.
        most: the coefficient at rest, or the largest friction.
        force: the largest friction [N, N m].
        words: as formulas, where F/N is not what is said of it: of the sides of a rope.
    """

    contact: str
    ratio: Scalar
    most: Scalar
    force: Scalar
    words: str = ""


@dataclass(frozen=True)
class RestRange:
    """The range in which something rests.

    Args:
        name: of a coordinate; of a contact, in a structure without coordinates.
        low, high: of the coordinate, in SI; of the contact's friction. None: no limit on that side, or no values.
        condition: as formulas.
        extent: of a coordinate while the others stand as they do; "unknown" where something has no value.
    """

    name: str
    low: float | None
    high: float | None
    condition: str
    extent: Literal["between", "anywhere", "nowhere", "unknown"] = "between"


def ranges_of_rest(system: System) -> tuple[RestRange, ...]:
    """The range of rest of each coordinate, or of the friction of each contact where there are none; () without any."""
    found = tuple(_conditions(system))
    if not found:
        return ()
    words = {each.contact: _in_formulas(system, each) for each in found}
    declared = system.scope.model.coordinates
    places = [q for q in system.symbols.q if not (declared[q.name].driven or declared[q.name].dependent)]
    if not places:
        return tuple(_of_contact(system, each, words[each.contact]) for each in found)
    return tuple(_of_coordinate(system, q, found, words) for q in places)


def _conditions(system: System) -> Iterator[StickCondition]:
    symbols = system.symbols
    still: dict[Node, Scalar] = {symbols.t: 0, **dict.fromkeys((*symbols.u, *symbols.a), 0)}
    rough = [c for c in system.scope.model.rough_contacts if (mode := system.modes.get(c.name)) and mode.sense == 0]
    if not rough:
        return
    try:
        reactions = Reactions.of(system, still)
    except DerivationError:  # what acts at no place has no reactions
        return
    positive = system.scope.positive
    for contact in rough:
        try:
            F, N = _held(reactions, contact), _pressed(reactions, contact)
        except DerivationError:  # it has no single value
            continue
        assert contact.grip is not None, "what is rough can stick"
        most = largest = ContactMode.size_of(system.scope, contact.grip)
        whole = F if N is None else over(F, N)
        if contact.kind == "screw" and N is not None:  # of a thread h/r <= mu
            arm = system.scope.value(getattr(contact.friction, "radius", None))
            whole, most = over(whole, arm), over(most, arm)
        ratio = simplest(whole, Work.ANSWER, positive)
        force = largest if N is None else largest * function("abs", N)
        words = _of_sides(reactions, contact) if contact.pulls else ""
        yield StickCondition(contact.name, ratio, most, force, words)


def _of_sides(reactions: Reactions, contact: Contact) -> str:
    """T_1/T_2 <= e^(mu phi) of the sides of a rope on a drum, the larger tension above where it is known."""
    system = reactions.balance.system
    constraint, positive = system.scope.model.constraints[contact.name], system.scope.positive
    first, second = (reactions.tension(contact.name, side) for side in (1, 2))
    most = to_text(function("exp", system.scope.value(constraint.exponent)))
    larger = _number(system, first - second, {})
    ratios = [to_text(simplest(over(x, y), Work.ANSWER, positive)) for x, y in ((first, second), (second, first))]
    if larger is None or larger == 0:
        return f"{ratios[0]} <= {most} and {ratios[1]} <= {most}"
    return f"{ratios[0 if larger > 0 else 1]} <= {most}"


def _held(reactions: Reactions, contact: Contact) -> Scalar:
    """The friction that holds a contact or joint; on a surface its magnitude."""
    if isinstance(contact.friction, JointFriction):
        return reactions.friction_of_joint(contact.name)
    return _magnitude([reactions.friction(contact.name, along) for along in ("ts" if contact.surface else "t")])


def _pressed(reactions: Reactions, contact: Contact) -> Scalar | None:
    """The force on which its friction depends; None of a constant size.

    Raises:
        Indeterminate: it has no single value.
    """
    if contact.size is not None:
        return None
    if contact.of_joint:
        return reactions.load(contact.body)
    return reactions.normal(contact.name)


def _magnitude(parts: Sequence[Scalar]) -> Scalar:
    return parts[0] if len(parts) == 1 else sqrt(sum((x * x for x in parts), start=0))


def _in_formulas(system: System, condition: StickCondition) -> str:
    """tan(alpha) <= mu, abs(m*g*l*sin(q)/2) <= T_s"""
    if condition.words:
        return condition.words
    ratio = condition.ratio
    here = None if depends_on(ratio, system.symbols.q) else _number(system, ratio, {})
    text = to_text(function("abs", ratio) if here is None or here == 0 else ratio if here > 0 else -ratio)
    return f"{text} <= {to_text(condition.most)}"


def _number(system: System, scalar: Scalar, places: Mapping[Node, float]) -> float | None:
    """A scalar at rest in numbers, inputs and states as they begin; None where a value is missing, or it has none."""
    scope, symbols = system.scope, system.symbols
    begun = {symbols.inputs[name]: x for name, x in system.inputs.items()} | {
        z: scope.start_value(z) for z in symbols.z
    }
    (given,) = substituted(substituted(substituted((scalar,), begun), {symbols.t: 0}), scope.known_exactly)
    try:
        found = float(evaluate((given,), dict(places), FLOAT)[0])
    except (KeyError, NoValue):
        return None
    return found if math.isfinite(found) else None


def _of_contact(system: System, condition: StickCondition, words: str) -> RestRange:
    most = _number(system, condition.force, {})
    return RestRange(condition.contact, None if most is None else -most, most, words)


def _of_coordinate(
    system: System, q: Node, conditions: Sequence[StickCondition], words: Mapping[str, str]
) -> RestRange:
    """The range of a coordinate in which the conditions hold, the others as they start.

    It is that around its start, of a start that moves off the nearest one.
    """
    mine = [c for c in conditions if depends_on(c.ratio, (q,)) or depends_on(c.most, (q,))] or list(conditions)
    said = " and ".join(dict.fromkeys(words[c.contact] for c in mine))
    starts = {node: _number(system, x, {}) for node, x in system.scope.start_values().items()}
    here = {node: x for node, x in starts.items() if x is not None}
    follows = [x for x in system.symbols.q if system.scope.model.coordinates[x.name].dependent]

    def least(scalars: Sequence[Scalar], x: float) -> float:
        found = [_number(system, each, {**here, q: x}) for each in scalars]
        return math.nan if any(each is None for each in found) else min(each for each in found if each is not None)

    margins, ratios = [c.most - function("abs", c.ratio) for c in mine], [[c.ratio] for c in mine]
    if q not in here or any(depends_on(x, follows) for x in margins) or math.isnan(least(margins, here[q])):
        return RestRange(q.name, None, None, said, "unknown")
    joints = (body.joint for body in system.scope.model.bodies.values() if body.joint is not None)
    ways = _ways(turns=any(q.name in angle.names for joint in joints for angle in joint.turns()))
    inside = _inside(partial(least, margins), [partial(least, ratio) for ratio in ratios], here[q], ways)
    if inside is None:
        return RestRange(q.name, None, None, said, "nowhere")
    low, high = (_end(partial(least, margins), inside, [sense * way for way in ways]) for sense in (-1, 1))
    return RestRange(q.name, low, high, said, "anywhere" if low is None and high is None else "between")


def _inside(margin: OfPlace, ratios: Sequence[OfPlace], start: float, ways: Sequence[float]) -> float | None:
    """The place nearest to the start where it rests; a narrow range lies about one where no friction is needed."""
    if margin(start) >= -tolerances.COMPUTED:
        return start
    found = []
    for sense in (-1, 1):
        for x, y in pairwise((start, *(start + sense * way for way in ways))):
            ends = [_last(r, x, y) for r in ratios if r(x) * r(y) < 0]
            rests = [z for z in (*ends, y) if margin(z) >= -tolerances.COMPUTED]
            if rests:
                found.append(rests[0])
                break
    return min(found, key=lambda x: abs(x - start), default=None)


def _last(function: OfPlace, inside: float, outside: float) -> float:
    """The last place on a way at which a function has the sign that it has at its beginning."""
    sign = -1 if function(inside) < -tolerances.COMPUTED else 1
    for _ in range(100):
        middle = (inside + outside) / 2
        inside, outside = (middle, outside) if sign * function(middle) >= 0 else (inside, middle)
    return inside


def _ways(*, turns: bool) -> list[float]:
    """Distances at which places are tried, ascending: of an angle up to half a turn."""
    if turns:
        return [math.pi * k / STEPS_OF_SEARCH for k in range(1, STEPS_OF_SEARCH + 1)]
    return [FURTHEST ** (2 * k / STEPS_OF_SEARCH - 1) for k in range(STEPS_OF_SEARCH + 1)]


def _end(margin: OfPlace, start: float, ways: Sequence[float]) -> float | None:
    """The place where the margin becomes negative on the way from the start; None where it stays."""
    for inside, outside in pairwise((start, *(start + way for way in ways))):
        if margin(outside) < 0:
            return _last(margin, inside, outside)
    return None
