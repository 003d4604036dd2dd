"""Structure -> its reactions by the principle of virtual work: one released at a time, no balance of bodies used.

With one reaction R released the bodies have one motion. In it all other reactions do no work, so that

    R delta_R + sum of F . delta_P + sum of M delta_theta + sum of integrals of q . delta ds = 0
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace

from eomgen.mechanics.balance.named_reactions import NamedReaction, named_reactions
from eomgen.mechanics.balance.unit_wrenches import Effect, efforts_of
from eomgen.mechanics.bodies.system_scene import SystemScene
from eomgen.mechanics.structures.blocks import turning_by_one
from eomgen.mechanics.structures.structure import Structure
from eomgen.mechanics.structures.velocity_plan import VelocityPlan
from eomgen.model.forces.load import Couple, PointForce, SpreadLoad, UniformField
from eomgen.model.outputs import FUNCTIONS
from eomgen.records import dataclass
from eomgen.symbolic.expression.derivative import depends_on, substituted
from eomgen.symbolic.expression.functions import over
from eomgen.symbolic.expression.graph import Node, Scalar
from eomgen.symbolic.expression.spatial import times

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
                found += [Acting(force.name, PointForce(place, times(m, load.acceleration))) for place, m in masses]
    for link in system.motion.links:
        effects = tuple(efforts_of(system, link.name))
        if effects:
            found.append(Acting(link.name, None, effects))
    return tuple(found)


def asked_reactions(structure: Structure) -> dict[str, NamedReaction]:
    """The reactions that have a name in outputs."""
    named = named_reactions(structure.balance)
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
    along = turning_by_one(plan)
    plan = plan.scaled(along)
    still = dict.fromkeys(structure.unknowns, 0)  # they do no work in this motion, or are what is asked
    loads = loads_at_rest(structure)
    works = substituted(tuple(load.work(plan) for load in loads), still)
    parts = [substituted(substituted(load.parts, structure.at), still) for load in loads]
    plan.numbers([x for x in (*works, *(x for own in parts for x in own)) if type(x) is Node])  # all in one go
    working = [not plan.vanishes((work,), beside=own) for work, own in zip(works, parts, strict=True)]
    terms = tuple(WorkTerm(load, plan.simple(w)) for load, w, does in zip(loads, works, working, strict=True) if does)
    total = sum((term.work for term in terms), start=0)
    return WorkEquation(name, plan, along, terms, given, plan.simple(over(-total, along) + given))
