"""Velocities of all bodies at one configuration -> Plan: velocities of points, spins, centres of rotation, work.

v(P) = v_C + w x r_CP,   power of a force F at P: F . v(P),   of a couple M: M . w,
of a line load q: the integral of q(s) . v(s) ds
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import field as dataclass_field
from dataclasses import replace
from functools import cached_property
from typing import Any

from eomgen.mechanics.balance.unit_wrenches import Axes, Effect
from eomgen.mechanics.bodies.loads import in_ground_axes
from eomgen.mechanics.equations.system import System
from eomgen.mechanics.fields.field import VelocityField, rotation_center
from eomgen.model.forces.load import BodyPoint, Couple, PointForce, SpreadLoad
from eomgen.records import dataclass
from eomgen.symbolic.exact.normal_form import Legibly, readable_all
from eomgen.symbolic.expression.derivative import substituted
from eomgen.symbolic.expression.functions import sqrt
from eomgen.symbolic.expression.graph import Node, Scalar, is_zero
from eomgen.symbolic.expression.rational import Fraction
from eomgen.symbolic.expression.spatial import ZERO, Vector, apply, dot, minus, vector_of
from eomgen.symbolic.numeric.evaluation import evaluate, fifty_digits
from eomgen.symbolic.numeric.tolerances import ZERO_AT_50
from eomgen.symbolic.numeric.work import Work

SIXTH = Fraction(1, 6)


@dataclass(frozen=True)
class PlanCenter:
    """The centre of rotation of a body in the plane.

    Args:
        place: where it is; None: at infinity, the body translates, or everywhere, it is at rest.
        direction: of a translation, the velocity of all points; (0, 0, 0) at rest; None for a centre in sight.
    """

    place: Vector | None
    direction: Vector | None = None


@dataclass(frozen=True)
class VelocityPlan:
    """A field of velocities of rigid bodies, a velocity plan.

    Args:
        system: whose bodies.
        at: the configuration.
        parameters: values of 50 digits at which the motion is what it is for all others, or is asked for.
        velocities: of each body (velocity of the mass centre, spin) in the axes of its equations, 6.
        places: where those points are that were asked for; plans of one structure share them.
        known: what scalars are worth that were asked for; shared too.
    """

    system: System
    at: Mapping[Node, Scalar]
    parameters: Mapping[Node, Any]
    velocities: tuple[tuple[Scalar, ...], ...]
    places: dict[BodyPoint, Vector] = dataclass_field(default_factory=dict, compare=False, repr=False)
    known: dict[Scalar, Any] = dataclass_field(default_factory=dict, compare=False, repr=False)

    def scaled(self, k: Scalar) -> VelocityPlan:
        """k times as fast."""
        if k == 1:
            return self
        flat = readable_all([k * x for six in self.velocities for x in six], Work.VALUE, self.system.scope.positive)
        return replace(self, velocities=tuple(flat[i : i + 6] for i in range(0, len(flat), 6)))

    def plus(self, other: VelocityPlan, k: Scalar = 1) -> VelocityPlan:
        """Both motions at once, the other k times as fast."""
        pairs = zip(self.velocities, other.velocities, strict=True)
        rows = tuple(tuple(self.simple(x + k * y) for x, y in zip(a, b, strict=True)) for a, b in pairs)
        return replace(self, velocities=rows)

    # -- of bodies ---------------------------------------------------------------------------------

    @cached_property
    def moving(self) -> tuple[str, ...]:
        """The bodies that do not stay at rest."""
        links = self.system.motion.links
        self.numbers([x for six in self.velocities for x in six])  # all at once
        return tuple(link.name for link, six in zip(links, self.velocities, strict=True) if not self.vanishes(six))

    def spin(self, body: str | None) -> Vector:
        """Angular velocity in ground axes; of the ground (None) 0."""
        return self.simple.vector(self.raw_spin(body))

    def center_velocity(self, body: str) -> Vector:
        """Of the mass centre, ground axes."""
        return self.simple.vector(self.field(body).v)

    def velocity(self, place: BodyPoint) -> Vector:
        """Of a place of a body, ground axes; of the ground 0."""
        return self.simple.vector(self.raw_velocity(place))

    def raw_spin(self, body: str | None) -> Vector:
        """`spin`, not written out."""
        return ZERO if body is None else self.field(body).w

    def raw_velocity(self, place: BodyPoint) -> Vector:
        """`velocity`, not written out."""
        body, _ = place
        return ZERO if body is None else self.raw_velocity_at(body, self.position(place))

    def raw_velocity_at(self, body: str, position: Vector) -> Vector:
        """Of the point of a body that is at a place of the ground, ground axes, not written out."""
        return self.field(body).velocity(position)

    def field(self, body: str) -> VelocityField:
        """Velocities of a body by that of its mass centre; of a body at rest all 0."""
        if body not in self._fields:
            self._fields[body] = self._field(body) if body in self.moving else VelocityField()
        return self._fields[body]

    def _field(self, body: str) -> VelocityField:
        six = self._six(body)
        return VelocityField(self.mass_center(body), self._in_ground(body, six[:3]), w=self._in_ground(body, six[3:]))

    def position(self, place: BodyPoint) -> Vector:
        """Of a place in this configuration, ground axes."""
        if place not in self.places:
            self.places[place] = vector_of(substituted(self.system.motion.position(place), self.at))
        return self.places[place]

    def mass_center(self, body: str) -> Vector:
        return self.position((body, self._axes.masses[self.system.motion.index[body]].com))

    def center(self, field: VelocityField) -> PlanCenter:
        """The centre of rotation of what moves so in the plane."""
        if self.vanishes(field.w):
            return PlanCenter(None, ZERO if self.vanishes(field.v) else self.simple.vector(field.v))
        return PlanCenter(self.simple.vector(rotation_center(field)))

    # -- work ----------------------------------------------------------------------------------------

    def work(self, load: PointForce | Couple | SpreadLoad) -> Scalar:
        """Power of a load on the bodies in this motion, its virtual work, not written out."""
        if isinstance(load, Couple):
            return dot(self.force(load.couple, load.axes), self.raw_spin(load.body))
        if isinstance(load, PointForce):
            return dot(self.force(load.force, load.axes), self.raw_velocity(load.place))
        return self._work_along(load)

    def _work_along(self, load: SpreadLoad) -> Scalar:
        """L/6 (2 q_A.v_A + q_A.v_B + q_B.v_A + 2 q_B.v_B): the integral of two linear functions of s."""
        a, b = self.raw_velocity(load.start), self.raw_velocity(load.end)
        along = minus(self.position(load.end), self.position(load.start))
        q_A, q_B = self.force(load.at_start), self.force(load.at_end)
        total = 2 * dot(q_A, a) + dot(q_A, b) + dot(q_B, a) + 2 * dot(q_B, b)
        return SIXTH * self.simple(sqrt(self.simple(dot(along, along)))) * total

    def work_of_effects(self, effects: Sequence[Effect]) -> Scalar:
        """Of forces and couples as the bodies' equations hold them, not written out."""
        total: Scalar = 0
        for effect in effects:
            pairs = zip(substituted(effect.six, self.at), self.velocities[effect.link], strict=True)
            total = total + sum((f * v for f, v in pairs), start=0)
        return total

    def force(self, vector: Vector, axes: str | None = None) -> Vector:
        """A vector of a load in this configuration, ground axes."""
        return vector_of(substituted(in_ground_axes(self.system.motion, vector, axes), self.at))

    def vanishes(self, scalars: Sequence[Scalar], beside: Sequence[Scalar] = (1,)) -> bool:
        """Whether all of them are 0, beside what they are multiples of."""
        nodes = [x for x in scalars if type(x) is Node]
        if len(nodes) < len(scalars) and not all(is_zero(x) for x in scalars if type(x) is not Node):
            return False
        if not nodes:
            return True
        known = beside if not any(type(x) is Node for x in beside) else self.numbers(beside)
        size = max(map(abs, known), default=0)
        return all(abs(x) <= ZERO_AT_50 * size for x in self.numbers(nodes))

    def numbers(self, scalars: Sequence[Scalar]) -> list[Any]:
        """What scalars are worth at these parameters, with 50 digits."""
        new = tuple(dict.fromkeys(x for x in scalars if x not in self.known))
        if new:
            self.known.update(zip(new, evaluate(new, self.parameters, fifty_digits()), strict=True))
        return [self.known[x] for x in scalars]

    # -- helpers -------------------------------------------------------------------------------------

    @cached_property
    def simple(self) -> Legibly:
        """Scalars as a person writes them."""
        return Legibly(Work.VALUE, self.system.scope.positive)

    @cached_property
    def _fields(self) -> dict[str, VelocityField]:
        return {}

    @cached_property
    def _axes(self) -> Axes:
        return Axes(self.system.motion)

    def _six(self, body: str) -> tuple[Scalar, ...]:
        return self.velocities[self.system.motion.index[body]]

    def _in_ground(self, body: str, components: Sequence[Scalar]) -> Vector:
        """From the axes of the body's equations."""
        vector = vector_of(components)
        if self._axes.plane:
            return vector
        R = substituted([x for row in self.system.motion.link(body).pose.R for x in row], self.at)
        rotation = (vector_of(R[0:3]), vector_of(R[3:6]), vector_of(R[6:9]))
        return apply(rotation, vector)
