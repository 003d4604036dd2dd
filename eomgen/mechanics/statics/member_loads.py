"""Reactions, body -> MemberLoads: what acts along a beam, forces and couples at places, loads per length.

Reactions with their values, loads, drives and springs of joints; the weight and inertia of a rod, m/L (g - a), which is
a linear function of the place. All in the axes of the body.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import replace
from functools import cached_property

from eomgen.errors import DerivationError
from eomgen.mechanics.balance.components import Component
from eomgen.mechanics.balance.unit_wrenches import Axes, Effect, effects_of_load, joint_effects
from eomgen.mechanics.bodies.inertia import mass_properties
from eomgen.mechanics.equations.system import System
from eomgen.mechanics.fields.field import field_of
from eomgen.mechanics.reactions.reactions import Reactions
from eomgen.mechanics.statics.member_axis import Sizes
from eomgen.model.forces.load import Couple, PointForce
from eomgen.records import dataclass
from eomgen.symbolic.expression.functions import over, sqrt
from eomgen.symbolic.expression.graph import Scalar, is_zero
from eomgen.symbolic.expression.spatial import ZERO, Vector, apply, dot, minus, plus, times, transposed, vector_of
from eomgen.symbolic.solve.solving import vanishes


def place_of(components: Sequence[Component], effect: Effect, owner: str) -> Vector | None:
    """Where a reaction acts, body axes: a couple where the forces of the same tie do, None where it has none."""
    if effect.place is not None:
        return effect.place
    mine = (e for c in components if c.owner == owner for e in c.effects if e.link == effect.link)
    return next((e.place for e in mine if e.place is not None), None)


At = tuple[Vector, Vector, Scalar]
"""(place, force, couple), body axes."""
MemberLoad = tuple[Vector, Vector, Vector, Vector]
"""(start, end, load per length at the start, at the end), body axes."""


@dataclass(frozen=True)
class MemberLoads:
    """Everything that acts on one body, in its own axes, with the values of the reactions."""

    reactions: Reactions
    body: str
    sizes: Sizes

    @cached_property
    def actions(self) -> list[At]:
        """Forces and couples at places; those at one place together."""
        found: list[At] = []
        for place, force, couple in (self._at(effect) for effect in self._effects()):
            same = next((k for k, (p, _, _) in enumerate(found) if self._is_zero(minus(p, place))), None)
            if same is None:
                found.append((place, force, couple))
            else:
                _, f, c = found[same]
                found[same] = (place, plus(f, force), c + couple)
        return [(place, self._simple(f), self.sizes.simple(c)) for place, f, c in found]

    @cached_property
    def spreads(self) -> list[MemberLoad]:
        """Distributed loads, and the weight and inertia of a rod."""
        found = []
        for applied in self._system.loads.applied:
            for line in applied.spread:
                if line.start[0] == self.body:
                    found.append((line.start[1], line.end[1], self._turned(line.at_start), self._turned(line.at_end)))
        return found + self._of_mass()

    # -- forces and couples ------------------------------------------------------------------------

    def _effects(self) -> Iterable[Effect]:
        """Reactions with their values, loads, drives and springs: what acts at places of the body."""
        system, axes = self._system, Axes(self._system.motion)
        link = system.motion.index[self.body]
        for j, component in enumerate(self.reactions.components):
            for effect in (*component.effects, *component.friction_effects):
                if effect.link == link and not (effect.place is None and effect.beyond is not None):
                    place = self._place_of(effect, component.owner)
                    place = place if effect.beyond is None else plus(place, effect.beyond)
                    yield replace(effect, place=place).times(self.reactions.value(j))
        for force in system.loads.applied:
            if not force.spread and not system.scope.model.forces[force.name].by_mass:
                placed = [load for load in force.loads if isinstance(load, (PointForce, Couple))]
                effects = [e for load in placed for e in effects_of_load(axes, load) if e.link == link]
                yield from (self._placed(effect, f"the force '{force.name}'") for effect in effects)
        yield from (effect for effect in joint_effects(system) if effect.link == link)

    def _place_of(self, effect: Effect, owner: str) -> Vector:
        """Where a reaction acts: a couple where the forces of the same tie do."""
        place = place_of(self.reactions.components, effect, owner)
        return self._placed(replace(effect, place=place), f"the couple of '{owner}'").place or ZERO

    def _placed(self, effect: Effect, what: str) -> Effect:
        if effect.place is None:
            raise DerivationError(
                f"{what} acts on '{self.body}' at no point: its section forces depend on where",
                f"bodies.{self.body}",
                "give the couple its `point`",
            )
        return effect

    def _at(self, effect: Effect) -> At:
        assert effect.place is not None, "placed before"
        return effect.place, self._turned(effect.force), effect.couple[2]

    # -- mass --------------------------------------------------------------------------------------

    def _of_mass(self) -> list[MemberLoad]:
        """m/L (g - a) along a rod; a linear function of the place."""
        system = self._system
        mass = mass_properties(system.scope, self.body)
        if is_zero(mass.m):
            return []
        ends = self._ends_of_rod()
        field, motion = field_of(system.motion, self.body), system.motion
        if ends is None:
            inertia = field.acceleration(motion.position((self.body, mass.com)))
            if self._is_zero((*minus(self._weight(), inertia), field.e[2])):
                return []
            what = f"how the mass of '{self.body}' is spread along it is not known"
            raise DerivationError(
                what, f"bodies.{self.body}", 'give it the shape "rod", or no mass and a distributed load'
            )
        first, last = ends
        r = minus(last, first)
        per_length = over(mass.m, sqrt(self.sizes.simple(dot(r, r))))
        felt = [minus(self._weight(), field.acceleration(motion.position((self.body, p)))) for p in ends]
        at_first, at_last = (self._turned(times(per_length, g)) for g in felt)
        return [] if self._is_zero((*at_first, *at_last)) else [(first, last, at_first, at_last)]

    def _ends_of_rod(self) -> tuple[Vector, Vector] | None:
        points = self._system.motion.points[self.body]
        shape = self._system.scope.model.bodies[self.body].shape
        names = () if shape is None else shape.point_names
        return (points["start"], points["end"]) if {"start", "end"} <= set(names) else None

    def _weight(self) -> Vector:
        """The acceleration fields that act on the body's mass, ground axes."""
        system = self._system
        total = system.loads.fields
        m = mass_properties(system.scope, self.body).m
        for force in system.loads.applied:
            if system.scope.model.forces[force.name].by_mass:
                for load in force.loads:
                    if isinstance(load, PointForce) and load.place[0] == self.body:
                        total = plus(total, vector_of(over(x, m) for x in load.force))
        return total

    # -- axes --------------------------------------------------------------------------------------

    @property
    def _system(self) -> System:
        return self.reactions.balance.system

    def _turned(self, vector: Vector) -> Vector:
        """From ground axes to those of the body."""
        return self._simple(apply(transposed(self._system.motion.link(self.body).pose.R), vector))

    def _simple(self, vector: Vector) -> Vector:
        return vector_of(self.sizes.simple(x) for x in vector)

    def _is_zero(self, scalars: Sequence[Scalar]) -> bool:
        return all(vanishes(self.sizes.simple(x)) for x in scalars)
