"""System whose contacts and joints with dry friction stick -> RestRange: how far it stays at rest.

    abs(F)/N <= mu_s of a contact or slide, mu_s r of a hinge;   abs(F) <= F_s of a joint with friction of constant size

F is the friction that holds at rest, a function of the coordinates. The limits of a coordinate are where a condition
ends, the others as they stand: from there on motion begins.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Mapping, Sequence

from eomgen.errors import DerivationError
from eomgen.frozen import dataclass
from eomgen.mechanics.dynamics import System
from eomgen.mechanics.free_bodies import Reactions
from eomgen.model import Contact
from eomgen.symbolic.exact import simplest
from eomgen.symbolic.expression import Node, Scalar, depends_on, function, over, sqrt, substituted
from eomgen.symbolic.numeric import FLOAT, NoValue, Work, evaluate, tolerances
from eomgen.symbolic.print import to_text

STEPS = 400  # of the search to each side
FURTHEST = 1e4  # of a displacement [m]


@dataclass(frozen=True)
class StickCondition:
    """Condition under which a contact or a joint sticks: ratio between - most and most.

    Args:
        contact: its name.
        ratio: F/N, or F.
        most: the coefficient at rest, or the largest friction.
        force: the largest friction [N, N m].
    """

    contact: str
    ratio: Scalar
    most: Scalar
    force: Scalar


@dataclass(frozen=True)
class RestRange:
    """The range in which something rests.

    Args:
        name: of a coordinate; of a contact, in a structure without coordinates.
        low, high: of the coordinate, in SI; of the contact's friction. None: no limit, or no values.
        condition: as formulas.
        nowhere: True if no place of the coordinate is one of rest while the others stand as they do.
    """

    name: str
    low: float | None
    high: float | None
    condition: str
    nowhere: bool = False


def ranges_of_rest(system: System) -> tuple[RestRange, ...]:
    """The range of rest of each coordinate, or of the friction of each contact where there are none; () without any."""
    found = tuple(_conditions(system))
    if not found:
        return ()
    words = {each.contact: _in_formulas(system, each) for each in found}
    places = [q for q in system.symbols.q if not system.scope.model.coordinates[q.name].driven]
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
    value, positive = system.scope.value, system.scope.positive
    for contact in rough:
        try:
            F, N = _held(reactions, contact), _pressed(reactions, contact)
        except DerivationError:  # it has no single value
            continue
        assert contact.grip is not None, "what is rough can stick"
        most = value(contact.grip)
        ratio = simplest(F if N is None else over(F, N), Work.ANSWER, positive)
        yield StickCondition(contact.name, ratio, most, most if N is None else most * function("abs", N))


def _held(reactions: Reactions, contact: Contact) -> Scalar:
    """The friction that holds a contact or joint; on a surface its magnitude."""
    if contact.of_joint and contact.kind != "path":
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
        return _magnitude([reactions.value(j) for j in reactions.of_joint(contact.body)])
    return reactions.normal(contact.name)


def _magnitude(parts: Sequence[Scalar]) -> Scalar:
    return parts[0] if len(parts) == 1 else sqrt(sum((x * x for x in parts), start=0))


# -- in words ----------------------------------------------------------------------------------------


def _in_formulas(system: System, condition: StickCondition) -> str:
    """tan(alpha) <= mu, abs(m*g*l*sin(q)/2) <= T_s"""
    ratio = condition.ratio
    here = None if depends_on(ratio, system.symbols.q) else _number(system, ratio, {})
    text = to_text(function("abs", ratio) if here is None or here == 0 else ratio if here > 0 else -ratio)
    return f"{text} <= {to_text(condition.most)}"


# -- in numbers --------------------------------------------------------------------------------------


def _number(system: System, scalar: Scalar, places: Mapping[Node, float]) -> float | None:
    """A scalar at rest in numbers; None where a parameter has no value, or it has none."""
    (given,) = substituted((scalar,), system.scope.known_exactly)
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
    if q not in here:
        return RestRange(q.name, None, None, said)
    margins = tuple(c.most - function("abs", c.ratio) for c in mine)

    def margin(x: float) -> float:
        found = [_number(system, each, {**here, q: x}) for each in margins]
        return math.nan if any(each is None for each in found) else min(each for each in found if each is not None)

    if math.isnan(margin(here[q])):
        return RestRange(q.name, None, None, said)
    joints = (body.joint for body in system.scope.model.bodies.values() if body.joint is not None)
    ways = _ways(turns=any(q.name in angle.names for joint in joints for angle in joint.turns()))
    outwards = (here[q] + sense * way for way in (0.0, *ways) for sense in (-1, 1))
    inside = next((x for x in outwards if margin(x) >= -tolerances.COMPUTED), None)
    if inside is None:
        return RestRange(q.name, None, None, said, nowhere=True)
    ends = [_end(margin, inside, [sense * way for way in ways]) for sense in (-1, 1)]
    return RestRange(q.name, ends[0], ends[1], said)


def _ways(*, turns: bool) -> list[float]:
    """Distances at which places are tried, ascending: of an angle up to half a turn."""
    if turns:
        return [math.pi * k / STEPS for k in range(1, STEPS + 1)]
    return [FURTHEST ** (2 * k / STEPS - 1) for k in range(STEPS + 1)]


def _end(margin: Callable[[float], float], start: float, ways: Sequence[float]) -> float | None:
    """The place where the margin becomes negative on the way from the start; None where it stays."""
    inside = start
    for way in ways:
        outside = start + way
        if margin(outside) < 0:
            for _ in range(100):
                middle = (inside + outside) / 2
                inside, outside = (middle, outside) if margin(middle) >= 0 else (inside, middle)
            return inside
        inside = outside
    return None
