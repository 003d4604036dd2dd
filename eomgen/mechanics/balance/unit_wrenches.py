"""Motion -> Effects: what forces, couples, joints and ties do to each body, in the axes of its equations.

The axes are the ground's in the plane, the body's own in space.
"""

from __future__ import annotations

from collections.abc import Sequence
from functools import cached_property

from eomgen.mechanics.bodies.inertia import mass_properties
from eomgen.mechanics.bodies.kinematics import GROUND, BodyLink, Motion
from eomgen.mechanics.bodies.loads import JointEffort, in_ground_axes
from eomgen.mechanics.equations.system import System
from eomgen.model.forces.load import Couple, PointForce
from eomgen.model.shapes import MassProperties
from eomgen.records import dataclass
from eomgen.symbolic.expression.functions import over
from eomgen.symbolic.expression.graph import Scalar, is_zero
from eomgen.symbolic.expression.spatial import (
    IDENTITY,
    ZERO,
    Matrix,
    Vector,
    apply,
    cross,
    dot,
    in_turned_axes,
    minus,
    plus,
    times,
    transposed,
)

PLANE_ROWS, SPACE_ROWS = (0, 1, 5), (0, 1, 2, 3, 4, 5)  # of (force, moment) about the mass centre


@dataclass(frozen=True)
class Effect:
    """What a unit of a reaction does to one body: force and couple at a place, in the axes of the body's equations.

    Args:
        link: index of the body.
        force, couple: on it.
        arm: from its mass centre to the place [m].
        place: the same place in body axes [m]; None of a couple that acts on the body as a whole.
        beyond: how far from there it really acts, body axes; of a couple, of the force whose moment it is.
    """

    link: int
    force: Vector
    couple: Vector
    arm: Vector
    place: Vector | None = None
    beyond: Vector | None = None

    @cached_property
    def six(self) -> tuple[Scalar, ...]:
        """Force, and moment about the mass centre."""
        return (*self.force, *plus(self.couple, cross(self.arm, self.force)))

    def times(self, k: Scalar) -> Effect:
        """k units of it."""
        return Effect(self.link, times(k, self.force), times(k, self.couple), self.arm, self.place, self.beyond)


@dataclass(frozen=True)
class Axes:
    """The axes of each body's equations: the ground's in the plane, the body's own in space."""

    motion: Motion

    @property
    def plane(self) -> bool:
        return self.motion.scope.model.space == "plane"

    @property
    def rows(self) -> tuple[int, ...]:
        return PLANE_ROWS if self.plane else SPACE_ROWS

    def of_body(self, link: BodyLink) -> Matrix:
        """From body axes to those of the equations."""
        return link.pose.R if self.plane else IDENTITY

    def of_ground(self, link: BodyLink, vector: Vector) -> Vector:
        """A vector of ground axes."""
        return vector if self.plane else apply(transposed(link.pose.R), vector)

    @cached_property
    def masses(self) -> tuple[MassProperties, ...]:
        return tuple(mass_properties(self.motion.scope, link.name) for link in self.motion.links)

    def arm(self, i: int, place: Vector) -> Vector:
        """From the mass centre to a place given in body axes."""
        link = self.motion.links[i]
        return in_turned_axes(self.of_body(link), minus(place, self.masses[i].com))


def effects_at_joint(axes: Axes, link: BodyLink, force: Vector, couple: Vector) -> list[Effect]:
    """Force and couple (child's axes) at a joint, on the child and opposite on the parent."""
    i = axes.motion.index[link.name]
    R = axes.of_body(link)
    effects = [Effect(i, in_turned_axes(R, force), in_turned_axes(R, couple), axes.arm(i, link.point), link.point)]
    if link.parent != GROUND:
        to_parent = R if axes.plane else link.local.R
        f, n = times(-1, in_turned_axes(to_parent, force)), times(-1, in_turned_axes(to_parent, couple))
        effects.append(Effect(link.parent, f, n, axes.arm(link.parent, link.local.p), link.local.p))
    return effects


def joint_effects(system: System) -> list[Effect]:
    """What drives, springs, dampers and rotors of all joints do, on both bodies of each."""
    return [effect for link in system.motion.links for effect in efforts_of(system, link.name)]


def efforts_of(system: System, body: str) -> list[Effect]:
    """What drive, spring, damper and rotor of a body's joint do, on the body first; a tie has none."""
    if body not in system.motion.index:
        return []
    axes = Axes(system.motion)
    effects = [e for effort in system.loads.efforts if effort.body == body for e in _effort_effects(axes, effort)]
    link = axes.motion.link(body)
    for k, armature in _armatures(axes.motion, link):
        rate = axes.motion.scope.with_accelerations((link.s_rate[k],))[0]
        effects += effects_at_joint(axes, link, *scaled_axes(axes, body, k, -armature * rate))
    return effects


def _effort_effects(axes: Axes, effort: JointEffort) -> list[Effect]:
    link = axes.motion.link(effort.body)
    return effects_at_joint(axes, link, *scaled_axes(axes, effort.body, effort.variable, effort.effort))


def _armatures(motion: Motion, link: BodyLink) -> list[tuple[int, Scalar]]:
    efforts = () if link.joint is None else link.joint.efforts()
    return [(k, motion.scope.value(e.armature)) for k, e in enumerate(efforts) if e is not None and e.armature]


def scaled_axes(axes: Axes, body: str, variable: int, magnitude: Scalar) -> tuple[Vector, Vector]:
    """(force, couple) along a joint's variable that do the work magnitude * s', child's axes, and none on its others.

    They lie in the span of the joint's axes: d_k . S_j = 1 of j = k, else 0.
    """
    w, v = axes.motion.link(body).S[variable]
    turning = not all(is_zero(x) for x in w)
    others = [
        column[0 if turning else 1]
        for j, column in enumerate(axes.motion.link(body).S)
        if j != variable and turning != all(is_zero(x) for x in column[0])
    ]
    push = _without_work(magnitude, w if turning else v, others)
    return (ZERO, push) if turning else (push, ZERO)


def _without_work(magnitude: Scalar, n: Vector, others: Sequence[Vector]) -> Vector:
    """The vector d in the span of n and the others with d . n = magnitude that is normal to the others."""
    if all(is_zero(dot(n, other)) for other in others):
        return times(_over(magnitude, dot(n, n)), n)
    if len(others) == 1:
        (other,) = others
        d = minus(times(dot(other, other), n), times(dot(n, other), other))
    else:
        d = cross(others[0], others[1])
    return times(_over(magnitude, dot(n, d)), d)


def _over(magnitude: Scalar, square: Scalar) -> Scalar:
    return magnitude if type(square) is int and square == 1 else over(magnitude, square)


def effects_of_load(axes: Axes, load: PointForce | Couple) -> tuple[Effect, ...]:
    """A load on its body; none on the ground."""
    body = load.body if isinstance(load, Couple) else load.place[0]
    if body is None:
        return ()
    i = axes.motion.index[body]
    link = axes.motion.links[i]
    given = load.couple if isinstance(load, Couple) else load.force
    vector = (
        given
        if load.axes == body and not axes.plane
        else axes.of_ground(link, in_ground_axes(axes.motion, given, load.axes))
    )
    beyond = None if load.beyond is None else apply(transposed(link.pose.R), load.beyond)
    if isinstance(load, Couple):
        return (Effect(i, ZERO, vector, ZERO, None if load.place is None else load.place[1], beyond),)
    return (Effect(i, vector, ZERO, axes.arm(i, load.place[1]), load.place[1], beyond),)
