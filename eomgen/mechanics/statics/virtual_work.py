"""Structure -> its reactions by the principle of virtual work, released one by one, and by the balance of its bodies.

With one reaction R released the bodies have one motion. In it all other reactions do no work, so that

    R delta_R + sum of F . delta_P + sum of M delta_theta + sum of integrals of q . delta ds = 0
"""

from __future__ import annotations

import math
from collections.abc import Callable, Container, Iterator, Mapping, Sequence
from dataclasses import replace
from functools import cached_property, partial
from itertools import pairwise
from typing import Literal

from eomgen.errors import DerivationError, ExpressionError, UsageError
from eomgen.frozen import dataclass
from eomgen.mechanics.constraints import Rank
from eomgen.mechanics.dynamics import System
from eomgen.mechanics.free_bodies import Effect, Indeterminate, NamedReaction, Reactions, Structure, VelocityPlan
from eomgen.mechanics.kinematics import ContactMode, SystemScene
from eomgen.model import (
    FUNCTIONS,
    Contact,
    Couple,
    JointFriction,
    PointForce,
    SpreadLoad,
    UniformField,
    Unit,
    ends_requested,
    nearest,
)
from eomgen.symbolic.exact import equal_at_random_states, simplest
from eomgen.symbolic.expression import (
    Call,
    Expression,
    Node,
    Reference,
    Scalar,
    depends_on,
    function,
    over,
    parse,
    sqrt,
    substituted,
)
from eomgen.symbolic.numeric import FLOAT, NoValue, Work, evaluate, tolerances
from eomgen.symbolic.print import text_size, to_text

StaticLoad = PointForce | Couple | SpreadLoad


@dataclass(frozen=True)
class Acting:
    """One load of the structure.

    Args:
        name: of the force, or of the body whose joint has a drive or spring.
        load: at its place; None where `effects` hold it.
        effects: of a joint's drive or spring, on both bodies.
    """

    name: str
    load: StaticLoad | None
    effects: tuple[Effect, ...] = ()

    def work(self, plan: VelocityPlan) -> Scalar:
        """Its virtual work in a motion, not written out."""
        return plan.work_of_effects(self.effects) if self.load is None else plan.work(self.load)

    @property
    def parts(self) -> tuple[Scalar, ...]:
        """The components of its forces and couples."""
        match self.load:
            case None:
                return tuple(x for effect in self.effects for x in effect.six)
            case Couple(couple=couple):
                return couple
            case PointForce(force=force):
                return force
            case SpreadLoad():
                return (*self.load.at_start, *self.load.at_end)


@dataclass(frozen=True)
class WorkTerm:
    """The virtual work of one load, not 0."""

    acting: Acting
    work: Scalar


@dataclass(frozen=True)
class WorkEquation:
    """along * R + sum of works = 0.

    Args:
        name: of the reaction, member force or unknown.
        plan: the motion of the released structure; its first block that turns does so by 1, else it moves by 1.
        along: the displacement along the reaction.
        terms: of the loads that do work.
        given: what drive and spring of the joint add to its reaction.
        value: of the reaction.
    """

    name: str
    plan: VelocityPlan
    along: Scalar
    terms: tuple[WorkTerm, ...]
    given: Scalar
    value: Scalar


def loads_at_rest(structure: Structure) -> tuple[Acting, ...]:
    """Every load: forces, couples, line loads, weights at the mass centres, drives and springs of joints."""
    system = structure.system
    found = [
        Acting(force.name, load)
        for force in system.loads.applied
        for load in force.spread or force.loads
        if isinstance(load, (PointForce, Couple, SpreadLoad))
    ]
    for force in system.loads.applied:
        for load in force.loads:
            if isinstance(load, UniformField):
                masses = SystemScene(system.motion).masses(None)
                found += [Acting(force.name, PointForce(place, m * load.acceleration)) for place, m in masses]
    for link in system.motion.links:
        effects = tuple(Effect.of_joint(system, link.name))
        if effects:
            found.append(Acting(link.name, None, effects))
    return tuple(found)


def requested_reactions(structure: Structure) -> dict[str, NamedReaction]:
    """The reactions that have a name in outputs."""
    named = NamedReaction.all_of(structure.balance)
    return {n.name: n for n in named if n.name.partition("(")[0] in FUNCTIONS}


def by_virtual_work(structure: Structure, named: NamedReaction) -> WorkEquation | None:
    """One reaction; None where it is statically indeterminate.

    A drive of its joint that is sought is what its own virtual work says.
    """
    at = structure.at
    factors = substituted(tuple(named.combination.values()), at)
    combination = dict(zip(named.combination, factors, strict=True))
    (given,) = substituted((named.given,), at)
    held = {}
    for unknown in structure.unknowns:
        if depends_on(given, (unknown,)):
            sought = unknown_by_virtual_work(structure, unknown)
            if sought is None:
                return None
            held[unknown] = sought.value
    found = _equation(structure, named.name, combination, given)
    if found is None or not held:
        return found
    return replace(found, value=found.plan.simple(substituted((found.value,), held)[0]))


def unknown_by_virtual_work(structure: Structure, unknown: Node) -> WorkEquation | None:
    """The unknown of a load, from the motion that it alone forbids; None where it is indeterminate."""
    return _equation(structure, unknown.name, {structure.index(unknown.name): 1}, 0)


def _equation(structure: Structure, name: str, combination: Mapping[int, Scalar], given: Scalar) -> WorkEquation | None:
    if not structure.determines(combination):
        return None
    plan = structure.released(combination)
    along = plan.turning_by_one
    plan = plan.scaled(along)
    still = dict.fromkeys(structure.unknowns, 0)  # they do no work in this motion, or one is the requested force
    loads = loads_at_rest(structure)
    works = substituted(tuple(load.work(plan) for load in loads), still)
    parts = [substituted(substituted(load.parts, structure.at), still) for load in loads]
    plan.numbers([x for x in (*works, *(x for own in parts for x in own)) if type(x) is Node])  # all in one go
    working = [not plan.vanishes((work,), beside=own) for work, own in zip(works, parts, strict=True)]
    terms = tuple(WorkTerm(load, plan.simple(w)) for load, w, does in zip(loads, works, working, strict=True) if does)
    total = sum((term.work for term in terms), start=0)
    return WorkEquation(name, plan, along, terms, given, plan.simple(over(-total, along) + given))


# -------- two ways --------------------------------------------------------------------------------------------
# System -> StaticReactions: every reaction of a structure at rest in two independent ways, compared.
#
# One way is the balance of every body, solved for all reactions together; the other releases one reaction at a time
# and writes the virtual work of the mechanism that is left. They share what a unit of a reaction does to the bodies,
# and nothing else: the loads' works are those of their own points, line loads by the integral of q . v.


UNITS = {Unit.parse(unit).dimension: unit for unit in ("N", "N*m", "N/m")}
"""Units by their dimension."""
LONGEST_FACTOR = 60  # characters of a factor in a sum that is printed


@dataclass(frozen=True)
class StaticReaction:
    """One reaction, or one unknown of the loads.

    Args:
        name: as outputs ask for it.
        unit: N, N*m; of an unknown "" where the model does not say what it is.
        named: the reaction; None for an unknown.
        solved: its value as the balance of the bodies gives it; None where that leaves it open.
        positive: parameters that stand for positive numbers.
        work: the equation of virtual work; None where it is indeterminate, or was not requested.
    """

    name: str
    unit: str
    named: NamedReaction | None
    solved: Scalar | None
    positive: frozenset[Node]
    work: WorkEquation | None

    @cached_property
    def balanced(self) -> Scalar | None:
        """Its value by the balance of the bodies, as a person writes it."""
        return None if self.solved is None else simplest(self.solved, Work.ANSWER, self.positive)

    @cached_property
    def agree(self) -> bool:
        """True if both values are the same function of the parameters; a value that one way lacks is a difference."""
        if self.work is None:
            return True
        return self.solved is not None and equal_at_random_states([(self.solved, self.work.value)]).equal

    @property
    def value(self) -> Scalar | None:
        """Value of the reaction; None where it is statically indeterminate."""
        return self.balanced if self.work is None else self.work.value

    @staticmethod
    def released(structure: Structure, name: str) -> StaticReaction:
        """One reaction, or unknown of the loads, by its virtual work alone; the other degrees of freedom are at rest.

        Raises:
            UsageError: there is no such reaction.
            DerivationError: released, nothing can move.
        """
        requested, unknowns = requested_reactions(structure), {unknown.name: unknown for unknown in structure.unknowns}
        one = _one_of((*requested, *unknowns), name)
        named = requested.get(one)
        unit = unit_of_unknown(structure, unknowns[one]) if named is None else named.unit
        work = unknown_by_virtual_work(structure, unknowns[one]) if named is None else by_virtual_work(structure, named)
        if work is None:
            what = f"{one} is statically indeterminate: released, the other reactions hold the bodies without it"
            raise DerivationError(what, fix="take a redundant constraint away")
        if not work.plan.moving:
            raise DerivationError(
                f"{one} holds nothing: its constraint leaves this motion free", fix="take the constraint away"
            )
        return StaticReaction(one, unit, named, None, structure.system.scope.positive, work)


@dataclass(frozen=True)
class StaticSum:
    """A sum of indeterminate reactions that is determinate.

    Args:
        combination: {row of the structure: factor}.
        value: by the balance of the bodies.
        unit: that of its first.
    """

    combination: dict[int, Scalar]
    value: Scalar
    unit: str


@dataclass(frozen=True)
class StaticReactions:
    """A structure at rest.

    Args:
        structure: bodies and what holds them.
        reactions: every one, unknowns of the loads last.
        balance: the solution of the bodies' equations.
    """

    structure: Structure
    reactions: tuple[StaticReaction, ...]
    balance: Reactions

    @property
    def system(self) -> System:
        return self.structure.system

    @property
    def by_name(self) -> dict[str, StaticReaction]:
        return {reaction.name: reaction for reaction in self.reactions}

    @property
    def open(self) -> tuple[StaticReaction, ...]:
        """The reactions that are statically indeterminate."""
        return tuple(reaction for reaction in self.reactions if reaction.value is None)

    @cached_property
    def sums(self) -> tuple[StaticSum, ...]:
        """Sums of those that have one value, as far as they are short."""
        found = []
        for combination in Reactions.determinate_sums(self.structure.stresses):
            factors = {j: simplest(k, Work.ANSWER, self.system.scope.positive) for j, k in combination.items()}
            if max(map(text_size, factors.values())) <= LONGEST_FACTOR:
                value = self.balance.combined(factors, "their sum")
                unit = next((r.unit for r in self.reactions if r.name == self.structure.names[next(iter(factors))]), "")
                found.append(StaticSum(factors, simplest(value, Work.ANSWER, self.system.scope.positive), unit))
        return tuple(found)

    @property
    def disagreeing(self) -> tuple[StaticReaction, ...]:
        """Reactions for which the two ways differ: then the result is wrong."""
        return tuple(reaction for reaction in self.reactions if not reaction.agree)

    @property
    def count(self) -> tuple[int, str]:
        """3 Nb + 2 Np - components - unknown loads, and as text."""
        number, text = Rank(self.system.constraints).counted()
        loads = len(self.structure.unknowns)
        return (number - loads, f"{text} - {loads} (unknown loads)") if loads else (number, text)

    @staticmethod
    def of(system: System, at: Mapping[Node, Scalar] | None = None, *, only: str | None = None) -> StaticReactions:
        """Every reaction of a structure at a configuration.

        Args:
            at: exact places of coordinates; None: the start.
            only: the one reaction that is found by virtual work too; None: all.
        Raises:
            UsageError: there is no such reaction.
            DerivationError: bodies can move; a force acts at no place.
        """
        structure = Structure.of(system, at)
        structure.refuse_loose()
        return reactions_in(structure, only=only)

    @property
    def conditions(self) -> tuple[RestCondition, ...]:
        """Conditions of the contacts that can end or slide, where their reactions are determinate."""
        found = []
        for contact in self.system.scope.model.contacts:
            name = contact.name
            if isinstance(contact.friction, JointFriction):
                found += self._of_joint(contact)
                continue
            normal, pull = (_value(self, f"{kind}({name})") for kind in ("reaction_n", "tension"))
            if contact.unilateral and normal is None and pull is None:  # the stop of a hinge
                normal = _value(self, f"reaction_couple({name})")
            along = _resultant([_value(self, f"reaction_{k}({name})") for k in ("ts" if contact.surface else "t")])
            if contact.round:  # of all that it carries the part across its line
                whole = _resultant([_value(self, f"reaction_{axis}({name})") for axis in "xyz"])
                normal = None if whole is None or along is None else sqrt(whole * whole - along * along)
            if contact.unilateral and normal is not None:
                found.append(RestCondition(name, "pushes", normal))
            if contact.unilateral and pull is not None:
                found.append(RestCondition(name, "pulls", pull))
            normal = pull if normal is None else normal
            if contact.mu is not None and normal is not None and along is not None:
                most = self.system.scope.value(contact.mu) * function("abs", normal)
                found.append(RestCondition(name, "sticks", most - function("abs", along)))
        return tuple(found)

    @cached_property
    def ranges(self) -> tuple[RestRange, ...]:
        """The ranges in which dry friction keeps it at rest."""
        return ranges_of_rest(self.system)

    def _of_joint(self, contact: Contact) -> list[RestCondition]:
        """Condition for a joint with dry friction to stick, where its reactions are determinate."""
        along = _value(self, f"friction({contact.name})")
        across = [_value(self, f"reaction_{k}({contact.body})") for k in ("n", "x", "y", "z")]
        N: Scalar | None = 1 if contact.size is not None else _resultant([x for x in across if x is not None] or [None])
        if contact.kind == "prismatic" and across[0] is None and N is not None and along is not None:
            N = sqrt(N * N - along * along)  # in space the force is all that the joint carries
        if along is None or N is None or contact.grip is None:
            return []
        pressed = simplest(N, Work.ANSWER, self.system.scope.positive)
        most = ContactMode.size_of(self.system.scope, contact.grip) * function("abs", pressed)
        return [RestCondition(contact.name, "holds", most - function("abs", along), contact.words)]

    @property
    def loads(self) -> tuple[Acting, ...]:
        """Every load: forces, couples, line loads, weights at the mass centres, drives and springs of joints."""
        return loads_at_rest(self.structure)


def reactions_in(structure: Structure, *, only: str | None = None) -> StaticReactions:
    """Every reaction of a structure in which nothing can move; `only` as of `static_reactions_of`."""
    system = structure.system
    balance = Reactions.of(system, structure.at)
    requested, positive = requested_reactions(structure), structure.system.scope.positive
    one = None if only is None else _one_of((*requested, *(unknown.name for unknown in structure.unknowns)), only)
    found = []
    for named in requested.values():
        work = by_virtual_work(structure, named) if one in (None, named.name) else None
        solved = _balanced(balance, structure, named)
        found.append(StaticReaction(named.name, named.unit, named, solved, positive, work))
    for unknown in structure.unknowns:
        work = unknown_by_virtual_work(structure, unknown) if one in (None, unknown.name) else None
        solved, unit = balance.unknowns.get(unknown), unit_of_unknown(structure, unknown)
        found.append(StaticReaction(unknown.name, unit, None, solved, positive, work))
    return StaticReactions(structure, tuple(found), balance)


def unit_of_unknown(structure: Structure, unknown: Node) -> str:
    """The unit of SI of an unknown force, couple or line load, where the model says what it is."""
    unit = structure.system.scope.model.unknowns[unknown.name].unit
    return "" if unit is None else UNITS.get(unit.dimension, "")


def _one_of(names: Sequence[str], requested: str) -> str:
    """Name of the requested reaction or unknown.

    Raises:
        UsageError: there is none.
    """
    try:
        call = parse(requested, references=True).call
    except ExpressionError:
        call = None
    name = requested if call is None else name_of(call, names)
    if name not in names:
        listed = nearest(name, names) or f"there are {', '.join(names)}"
        raise UsageError(f"there is no reaction '{name}'", fix=listed)
    return name


def _balanced(balance: Reactions, structure: Structure, named: NamedReaction) -> Scalar | None:
    """A reaction by the balance of the bodies; None where that leaves it open."""
    *factors, given = substituted((*named.combination.values(), named.given), structure.at)
    try:
        value = balance.combined(dict(zip(named.combination, factors, strict=True)), named.name)
    except Indeterminate:
        return None
    (given,) = substituted((given,), balance.unknowns)
    return value + given


def name_of(call: Call, names: Container[str]) -> str:
    """Name in a table that a call means: the ends of a member may be in either order."""
    ends = ends_requested(call) if call.name == "tension" and call.args else None
    either = () if ends is None else (ends, ends[::-1])
    written = (f"tension({argument_name(call.args[0])}, {a}-{b})" for a, b in either)
    return next((name for name in written if name in names), str(call))


def argument_name(argument: Reference | Expression) -> str:
    """An argument of a call as it was written."""
    return argument.name if isinstance(argument, Reference) else argument.text


@dataclass(frozen=True)
class RestCondition:
    """Condition for a contact to be in the assumed state.

    Args:
        constraint: the contact, or the body on a path.
        kind: "pushes", "pulls", "sticks" or, of a joint or force, "holds".
        margin: it is not negative where the condition holds [N].
        words: of what holds: the joint 'arm', the brake 'shoe'.
    """

    constraint: str
    kind: str
    margin: Scalar
    words: str = ""

    @property
    def broken(self) -> str:
        """Consequence of a negative margin, in words."""
        return {
            "pushes": f"contact '{self.constraint}' would have to pull",
            "pulls": f"'{self.constraint}' would have to push",
            "sticks": f"contact '{self.constraint}' slides: it would need more friction than mu N",
            "holds": f"{self.words} slides: it would need more friction than it can have",
        }[self.kind]


def _resultant(components: Sequence[Scalar | None]) -> Scalar | None:
    """The magnitude; of one component with its sign; None where one is not determined."""
    known = [x for x in components if x is not None]
    if len(known) < len(components) or len(known) == 1:
        return known[0] if len(known) == len(components) else None
    return sqrt(sum((x * x for x in known), start=0))


def _value(statics: StaticReactions, name: str) -> Scalar | None:
    reaction: StaticReaction | None = statics.by_name.get(name)
    return None if reaction is None else reaction.value


# -------- ranges of rest --------------------------------------------------------------------------------------
# System whose contacts and joints with dry friction stick -> RestRange: how far it stays at rest.
#
#     abs(F)/N <= mu_s of a contact or slide, mu_s r of a hinge;   abs(F) <= F_s where its size is constant
#
# F is the friction that holds at rest, a function of the coordinates. The limits of a coordinate are where a
# condition ends, the others as they stand: from there on motion begins.


STEPS = 400  # of the search to each side
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
        most = ContactMode.size_of(system.scope, contact.grip)
        ratio = simplest(F if N is None else over(F, N), Work.ANSWER, positive)
        force = most if N is None else most * function("abs", N)
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
        return _magnitude([reactions.value(j) for j in reactions.of_joint(contact.body)])
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
        return [math.pi * k / STEPS for k in range(1, STEPS + 1)]
    return [FURTHEST ** (2 * k / STEPS - 1) for k in range(STEPS + 1)]


def _end(margin: OfPlace, start: float, ways: Sequence[float]) -> float | None:
    """The place where the margin becomes negative on the way from the start; None where it stays."""
    for inside, outside in pairwise((start, *(start + way for way in ways))):
        if margin(outside) < 0:
            return _last(margin, inside, outside)
    return None
