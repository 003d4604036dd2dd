"""Structure -> its reactions by the principle of virtual work, released one by one, and by the balance of its bodies.

With one reaction R released the bodies have one motion. In it all other reactions do no work, so that

    R delta_R + sum of F . delta_P + sum of M delta_theta + sum of integrals of q . delta ds = 0
"""

from __future__ import annotations

from collections.abc import Container, Iterator, Mapping, Sequence
from dataclasses import replace
from functools import cached_property

import numpy as np

from eomgen.errors import DerivationError, ExpressionError, UsageError
from eomgen.frozen import dataclass
from eomgen.mechanics.constraints import Rank
from eomgen.mechanics.dynamics import System
from eomgen.mechanics.free_bodies import Effect, Indeterminate, NamedReaction, Reactions, Structure, VelocityPlan
from eomgen.mechanics.kinematics import ContactMode, SystemScene
from eomgen.mechanics.statics.contacts import RestRange, ranges_of_rest
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
    Vector,
    depends_on,
    function,
    over,
    parse,
    sqrt,
    substituted,
)
from eomgen.symbolic.numeric import NoValue, Work, tolerances
from eomgen.symbolic.print import text_size

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

    def displaced(self, plan: VelocityPlan) -> list[tuple[str, Vector | None, Vector | None]]:
        """(where it works, displacement of that point, rotation of the body), as far as it works on them."""
        return [(f"joint of {self.name}", None, None)] if self.load is None else plan.displaced(self.load)

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
    found += [Acting(name, None, (effect,)) for name, effect in Effect.of_fluids(system).items()]
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

    @property
    def excluded(self) -> tuple[str, ...]:
        """States of contacts, in words, that no values of the indeterminate reactions satisfy at once; () if some do.

        Sought in numbers: the largest margin that all of them have in an equilibrium. Left out is what is not linear:
        friction on surfaces, and of what is pressed from both sides.
        """
        limits, open_ = tuple(self._limits()), {reaction.name for reaction in self.open}
        if not any(limit.named.name in open_ for limit in limits):
            return ()
        try:
            shares = _largest_margin(self.structure, limits)
        except NoValue:
            return ()
        return tuple(dict.fromkeys(limit.words for limit, y in zip(limits, shares, strict=False) if y != 0))

    def _limits(self) -> Iterator[Limit]:
        """Conditions of the contacts that are linear in the reactions."""
        names = {reaction.name: reaction.named for reaction in self.reactions}
        for contact in self.system.scope.model.contacts:
            if isinstance(contact.friction, JointFriction):
                held = names.get(f"friction({contact.name})")
                if held is not None and contact.size is not None and contact.grip is not None:
                    most = ContactMode.size_of(self.system.scope, contact.grip)
                    yield from (Limit(held, sign, None, most, f"{contact.words} holds") for sign in (1, -1))
                continue
            ways = (("reaction_n", "pushes"), ("tension", "pulls"), ("reaction_couple", "pushes"))
            pressed = ((names.get(f"{kind}({contact.name})"), verb) for kind, verb in ways)
            normal, verb = next(((named, verb) for named, verb in pressed if named is not None), (None, ""))
            if normal is None or not contact.unilateral:
                continue
            yield Limit(normal, 1, None, 0, f"'{contact.name}' {verb}")
            along = names.get(f"reaction_t({contact.name})")
            if along is not None and contact.mu is not None and not contact.surface:
                mu = self.system.scope.value(contact.mu)
                yield from (Limit(along, sign, normal, mu, f"'{contact.name}' does not slide") for sign in (1, -1))

    @cached_property
    def ranges(self) -> tuple[RestRange, ...]:
        """The ranges in which dry friction keeps it at rest."""
        return ranges_of_rest(self.system)

    def _of_joint(self, contact: Contact) -> list[RestCondition]:
        """Condition for a joint with dry friction to stick, where its reactions are determinate."""
        along = _value(self, f"friction({contact.name})")
        N: Scalar | None = 1
        if contact.size is None:
            try:
                N = self.balance.load(contact.body)
            except Indeterminate:
                N = None
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
class Limit:
    """Linear condition on reactions: sign * named + share (* normal, where there is one) is not negative.

    Args:
        named: the reaction that it bounds.
        share: the largest friction, or the coefficient.
        words: what holds then.
    """

    named: NamedReaction
    sign: int
    normal: NamedReaction | None
    share: Scalar
    words: str


def _largest_margin(structure: Structure, limits: Sequence[Limit]) -> np.ndarray:
    """Shares of the limits in a contradiction; () where an equilibrium satisfies all of them.

    Raises:
        NoValue: a parameter has none.
    """
    from scipy.optimize import linprog

    scope, n = structure.system.scope, len(structure.rows)

    def numbers(scalars: Sequence[Scalar]) -> np.ndarray:
        found = scope.numbers(substituted(tuple(scalars), structure.at))
        if found is None:
            raise NoValue("a parameter of the structure has no value")
        return np.array(found, dtype=float)

    def row_of(named: NamedReaction) -> np.ndarray:
        row = np.zeros(n + 1)  # last what is given beside
        row[[*named.combination, n]] = numbers((*named.combination.values(), named.given))
        return row

    loads, A = numbers(structure.loads), np.zeros((len(structure.columns), n + 1))
    for j, entries in enumerate(structure.rows):
        A[[*entries], j] = numbers(tuple(entries.values()))
    rows = np.zeros((len(limits), n + 1))
    for row, limit, share in zip(rows, limits, numbers([limit.share for limit in limits]), strict=True):
        pressed = np.eye(n + 1)[n] if limit.normal is None else row_of(limit.normal)
        row += limit.sign * row_of(limit.named) + share * pressed
    size = 1.0 + float(np.abs(loads).max(initial=0.0))
    above = np.column_stack([-rows[:, :n], np.ones(len(rows))])  # the margin is at most each of them
    bounds = [(None, None)] * n + [(None, size)]
    aim = np.append(np.zeros(n), -1.0)
    found = linprog(aim, above, rows[:, n], A, -loads, bounds=bounds, method="highs")
    satisfied = found.status != 0 or -found.fun >= -tolerances.COMPUTED * size
    return np.zeros(0) if satisfied else np.asarray(found.ineqlin.marginals)


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
