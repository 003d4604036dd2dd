"""System -> Components: every scalar reaction, with the forces and couples of a unit of it on the bodies."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from functools import cached_property

import numpy as np

from eomgen.errors import DerivationError
from eomgen.frozen import dataclass
from eomgen.mechanics.constraints import Closure, Row
from eomgen.mechanics.dynamics import System
from eomgen.mechanics.kinematics import (
    GROUND,
    BodyLink,
    ContactMode,
    JointEffort,
    Motion,
    SystemInertia,
)
from eomgen.model import BodyPoint, Couple, MassProperties, PointForce
from eomgen.symbolic.expression import (
    Fraction,
    Matrix,
    Node,
    Scalar,
    SparseRow,
    State,
    Twist,
    Vector,
    Wrench,
    depends_on,
    derivative,
    function,
    is_zero,
    over,
    sqrt,
)
from eomgen.symbolic.numeric import evaluate, fifty_digits, floats_of, rank, tolerances

# -------- unit wrenches ---------------------------------------------------------------------------------------
# Motion -> Effects: what forces, couples, joints and constraints do to each body, in the axes of its equations.
#
# The axes are the ground's in the plane, the body's own in space.


PLANE_ROWS, SPACE_ROWS = (0, 1, 5), (0, 1, 2, 3, 4, 5)  # of (force, moment) about the mass centre


@dataclass(frozen=True)
class Effect:
    """Force and couple of a unit of a reaction on one body, at a place, in the axes of the body's equations.

    Args:
        link: index of the body.
        force, couple: on it.
        arm: from its mass centre to the place [m].
        place: the same place in body axes [m]; None of a couple that acts on the body as a whole.
        beyond: vector from there to where it really acts, body axes; of a couple, of the force whose moment it is.
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
        return (*self.force, *(self.couple + self.arm.cross(self.force)))

    def times(self, k: Scalar) -> Effect:
        """k units of it."""
        return Effect(self.link, k * self.force, k * self.couple, self.arm, self.place, self.beyond)

    @staticmethod
    def of_joint(system: System, body: str) -> list[Effect]:
        """Effects of drive, spring, damper and rotor of a body's joint, on the body first; () for a constraint."""
        if body not in system.motion.index:
            return []
        axes = Axes(system.motion)
        effects = [e for effort in system.loads.efforts if effort.body == body for e in _effort_effects(axes, effort)]
        return [*effects, *rotors_of(axes, axes.motion.link(body))]

    @staticmethod
    def of_fluids(system: System) -> dict[str, Effect]:
        """Effect of each fluid that moves with a body, by the name of the force, at its place (Kirchhoff).

        f = -(p' + w x p),   n = -(L' + w x L + v x p)
        """
        if "fluids" not in system.found:
            axes = Axes(system.motion)
            fluids = SystemInertia(system.motion).fluids
            system.found["fluids"] = {name: _of_fluid(axes, at, v, p) for name, at, v, p in fluids}
        found: dict[str, Effect] = system.found["fluids"]
        return found

    @staticmethod
    def of_joints(system: System) -> list[Effect]:
        """Effects of drives, springs, dampers and rotors of all joints, on both bodies of each."""
        return [effect for link in system.motion.links for effect in Effect.of_joint(system, link.name)]


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
        """Rotation matrix from body axes to those of the equations."""
        return link.pose.R if self.plane else Matrix.IDENTITY

    def of_ground(self, link: BodyLink, vector: Vector) -> Vector:
        """A vector of ground axes."""
        return vector if self.plane else link.pose.R.T @ vector

    @cached_property
    def masses(self) -> tuple[MassProperties, ...]:
        return tuple(self.motion.scope.mass_properties(link.name) for link in self.motion.links)

    def arm(self, i: int, place: Vector) -> Vector:
        """Vector from the mass centre to a place given in body axes."""
        link = self.motion.links[i]
        return self.of_body(link) @ (place - self.masses[i].com)

    def effects_of(self, load: PointForce | Couple) -> tuple[Effect, ...]:
        """A load on its body; none on the ground."""
        body = load.body if isinstance(load, Couple) else load.place[0]
        if body is None:
            return ()
        i = self.motion.index[body]
        link = self.motion.links[i]
        given = load.couple if isinstance(load, Couple) else load.force
        vector = (
            given
            if load.axes == body and not self.plane
            else self.of_ground(link, self.motion.in_ground_axes(given, load.axes))
        )
        beyond = None if load.beyond is None else link.pose.R.T @ load.beyond
        if isinstance(load, Couple):
            return (Effect(i, Vector.ZERO, vector, Vector.ZERO, None if load.place is None else load.place[1], beyond),)
        return (Effect(i, vector, Vector.ZERO, self.arm(i, load.place[1]), load.place[1], beyond),)

    def components_of(self, system: System) -> tuple[Component, ...]:
        """All components: those of the joints, of the drives of given motions, and of the constraints."""
        return (*_joint_components(system, self), *_constraint_components(system, self))


def effects_at_joint(axes: Axes, link: BodyLink, force: Vector, couple: Vector) -> list[Effect]:
    """Force and couple (child's axes) at a joint, on the child and opposite on the parent."""
    i = axes.motion.index[link.name]
    R = axes.of_body(link)
    effects = [Effect(i, R @ force, R @ couple, axes.arm(i, link.point), link.point)]
    if link.parent != GROUND:
        to_parent = R if axes.plane else link.local.R
        f, n = -(to_parent @ force), -(to_parent @ couple)
        effects.append(Effect(link.parent, f, n, axes.arm(link.parent, link.local.p), link.local.p))
    return effects


def _of_fluid(axes: Axes, at: BodyPoint, moving: Twist, momentum: Wrench) -> Effect:
    (body, place), w, p, L = at, moving.w, momentum.f, momentum.tau
    link = axes.motion.link(body or "")
    rates = axes.motion.scope.with_accelerations((*p, *L))
    f = Vector(rates[:3]) + w.cross(p)
    n = Vector(rates[3:]) + w.cross(L) + moving.v.cross(p)
    i, R = axes.motion.index[link.name], axes.of_body(link)
    return Effect(i, -(R @ f), -(R @ n), axes.arm(i, place), place)


def rotors_of(axes: Axes, link: BodyLink) -> list[Effect]:
    """Effects of the rotors in a body's joint, which turn faster than the joint."""
    effects: list[Effect] = []
    for k, armature in _armatures(axes.motion, link):
        rate = axes.motion.scope.with_accelerations((link.s_rate[k],))[0]
        effects += effects_at_joint(axes, link, *link.pushed_along(k, -armature * rate))
    return effects


def _effort_effects(axes: Axes, effort: JointEffort) -> list[Effect]:
    link = axes.motion.link(effort.body)
    return effects_at_joint(axes, link, *link.pushed_along(effort.variable, effort.effort))


def _armatures(motion: Motion, link: BodyLink) -> list[tuple[int, Scalar]]:
    efforts = () if link.joint is None else link.joint.efforts()
    return [(k, motion.scope.value(e.armature)) for k, e in enumerate(efforts) if e is not None and e.armature]


# -------- components ------------------------------------------------------------------------------------------
# System -> Components: every scalar reaction of joints and constraints, and what a unit of it does to the bodies.


FORCE, COUPLE = "N", "N*m"
Ends = tuple[tuple[tuple[tuple[int, Scalar], ...], ...], ...]
"""Forces, each by its parts along directions at right angles, each part a sum of (component, share)."""


@dataclass(frozen=True)
class FrictionShare:
    """Friction of a contact along one direction.

    Args:
        label: "t" or, of a contact on a surface, "s".
        factor: what it is for a unit of the normal reaction.
        effects: of a unit of it.
    """

    label: str
    factor: Scalar
    effects: tuple[Effect, ...]


@dataclass(frozen=True)
class Component:
    """One scalar reaction.

    Args:
        owner: the constraint, or the body whose joint it is.
        kind: "constraint", "joint", or "drive": what moves a driven coordinate at a joint.
        label: "x", "y", "z", "n", "t", "couple", "couple x", "wrench 1", "tension", "drive", "friction" (of a joint);
            "" of a row of no place.
        number: its row in the constraint, or its place among the joint's components, from 1.
        effects: of a unit of it, on the child or the first-named body first.
        friction: along each direction in which its contact slides.
        side: the body on which it is the force of a hinge of several, the coordinate of a drive, the member of a
            truss, or "".
        bilateral_friction: of the friction of a bilateral contact, which is a component of its own: its factor for a
            unit of |N| = sqrt(N_1^2 + N_2^2), of a guide with a length of both its ends; None of all else.
    """

    owner: str
    kind: str
    label: str
    number: int
    effects: tuple[Effect, ...]
    friction: tuple[FrictionShare, ...] = ()
    side: str = ""
    bilateral_friction: Scalar | None = None

    @cached_property
    def friction_effects(self) -> tuple[Effect, ...]:
        """Its friction for a unit of it, on the same bodies."""
        return tuple(effect.times(along.factor) for along in self.friction for effect in along.effects)

    @property
    def frictional(self) -> bool:
        """True if the component is friction, or has friction due to it."""
        return bool(self.friction) or self.bilateral_friction is not None

    @property
    def is_wrench(self) -> bool:
        """True if the component is a force and a couple together: that of a screw, or of a placed body."""
        return self.label.startswith("wrench")

    @property
    def name(self) -> str:
        """Name that an output uses: reaction_x(B), tension(rope, 2)."""
        if self.label == "tension":
            which = self.side or (self.number if self.number > 1 else "")
            return f"tension({self.owner}, {which})" if which else f"tension({self.owner})"
        if self.label == "drive":
            return f"drive({self.side or self.owner})"
        if self.label == "friction":
            return f"friction({self.owner})"
        owner = f"{self.owner}.{self.side}" if self.side else self.owner
        return f"reaction_{self.label.replace(' ', '_')}({owner})"

    @property
    def unit(self) -> str:
        """Unit of a component: FORCE, or COUPLE if it has no force on any body."""
        forces = any(not is_zero(x) for effect in self.effects for x in effect.force)
        couples = any(not is_zero(x) for effect in self.effects for x in effect.couple)
        along_angle = self.label == "friction" and couples  # of a thread both
        return FORCE if forces and not along_angle else COUPLE


# -- of joints -------------------------------------------------------------------------------------


def _joint_components(system: System, axes: Axes) -> list[Component]:
    found = []
    driven = _driven_variables(axes.motion)
    for link in axes.motion.links:
        joint = link.joint
        if joint is None or not joint.carries_reaction:
            continue
        pushes = _basis(axes, link, system)
        factor = joint_friction(system, link)
        along = (
            ()
            if factor is None
            else tuple(effects_at_joint(axes, link, *ContactMode.rubbed_along(axes.motion, link, 0)))
        )
        whole = factor is not None and is_of_whole_force(axes.motion, link)
        for number, (label, force, couple) in enumerate(pushes, start=1):
            effects = tuple(effects_at_joint(axes, link, force, couple))
            signed = label == "n" and factor is not None and not whole
            friction = (FrictionShare("t", factor, along),) if signed and factor is not None else ()
            found.append(Component(link.name, "joint", label, number, effects, friction))
        if whole:
            label = "friction" if link.joint.frictions else "t"
            found.append(Component(link.name, "joint", label, len(pushes) + 1, along, bilateral_friction=factor))
        for k in range(len(link.s)):
            if (driver := driven.get((link.name, k))) is not None:
                effects = tuple(effects_at_joint(axes, link, *link.pushed_along(k, 1)))
                found.append(Component(link.name, "drive", "drive", k + 1, effects, (), driver))
    return found


def _driven_variables(motion: Motion) -> dict[tuple[str, int], str]:
    """{(body, number of its joint's variable): coordinate} where somebody drives a given motion ("": time alone).

    They follow it alone. Where there is none, and what follows holds a free coordinate of no other joint, nothing has
    to push: the equation of that coordinate says so.

    Raises:
        DerivationError: that coordinate moves other joints too, so that the drive has no one place.
    """
    symbols, given = motion.scope.symbols, motion.scope.model.driven_coordinates
    free = [q for q in symbols.q if q.name not in given]
    joints = [link for link in motion.links if link.joint is not None and link.joint.carries_reaction]
    found: dict[tuple[str, int], str] = {}
    for driver in (*(q for q in symbols.q if q.name in given), symbols.t):
        moved = [(link.name, k, s) for link in joints for k, s in enumerate(link.s) if depends_on(s, (driver,))]
        alone = [(name, k) for name, k, s in moved if not depends_on(s, free)]
        found |= dict.fromkeys(alone, "" if driver is symbols.t else driver.name)
        if not alone:
            _refuse_spread(joints, [s for _, _, s in moved], free, driver)
    return found


def _refuse_spread(joints: Sequence[BodyLink], follow: Sequence[Scalar], free: Sequence[Node], driver: Node) -> None:
    """Refuse a joint that follows a drive and also a free coordinate that moves other joints."""
    for q in free:
        moved = [link.name for link in joints for s in link.s if depends_on(s, (q,))]
        if len(moved) > 1 and any(depends_on(s, (q,)) for s in follow):
            which = " and ".join(f"'{name}'" for name in moved)
            raise DerivationError(
                f"what drives '{driver.name}' has no one place: with '{q.name}' it moves the "
                f"joints of {which}, and reactions do not follow",
                f"bodies.{moved[0]}.joint",
                f"let one joint follow '{driver.name}' alone",
            )


def _basis(axes: Axes, link: BodyLink, system: System) -> list[tuple[str, Vector, Vector]]:
    """(label, force, couple) of each reaction of a joint, child's axes: the complement of its motion subspace."""
    columns = link.joint.complement(link.s, axes.motion.scope.value)
    forces = [Vector(c[3:]) for c in columns if _vanishes(c[:3])]
    couples = [Vector(c[:3]) for c in columns if _vanishes(c[3:])]
    if axes.plane:
        forces = [f for f in forces if not _vanishes(f[:2])]
        found = [("couple", Vector.ZERO, c) for c in couples if not is_zero(c[2])]
        return [*_forces(axes, link, forces, 2), *([] if is_idle(axes, link, system) else found)]
    mixed = [c for c in columns if not _vanishes(c[:3]) and not _vanishes(c[3:])]
    names = [f"couple {axis}" for axis in "xyz"] if len(couples) == 3 else _numbered("couple", len(couples))
    held = [
        (name, Vector.ZERO, c) for name, c in zip(names, Matrix.IDENTITY if len(couples) == 3 else couples, strict=True)
    ]
    wrenches = [(f"wrench {k}", Vector(c[3:]), Vector(c[:3])) for k, c in enumerate(mixed, start=1)]
    return [*_forces(axes, link, forces, 3), *held, *wrenches]


def _vanishes(entries: Sequence[Scalar]) -> bool:
    return all(is_zero(x) for x in entries)


def _numbered(name: str, count: int) -> list[str]:
    return [name] if count == 1 else [f"{name} {k}" for k in range(1, count + 1)]


def _forces(axes: Axes, link: BodyLink, forces: list[Vector], most: int) -> list[tuple[str, Vector, Vector]]:
    """The forces of a joint: along the equations' axes where it can carry any, else normal to its motion."""
    if len(forces) == most:
        R_CE = axes.of_body(link).T
        return [("xyz"[k], R_CE @ Matrix.IDENTITY[k], Vector.ZERO) for k in range(most)]
    return [(label, f, Vector.ZERO) for label, f in _normals(axes, link, forces)]


def is_idle(axes: Axes, link: BodyLink, system: System) -> bool:
    """True if nothing can turn the body against its joint: a particle with all forces through its mass."""
    motion = axes.motion
    shape = motion.scope.model.bodies[link.name].shape
    carries = any(other.parent == motion.index[link.name] for other in motion.links)
    if shape is None or not shape.is_point or carries or link.point != Vector.ZERO:
        return False
    loads = (*system.loads.placed, *(push for row in system.constraints.rows for push in (*row.pushes, *row.tangent)))
    mine = [load for load in loads if link.name == (load.body if isinstance(load, Couple) else load.place[0])]
    return all(is_zero(effect.six[5]) for load in mine for effect in axes.effects_of(load))


def _normals(axes: Axes, link: BodyLink, forces: list[Vector]) -> list[tuple[str, Vector]]:
    """The forces that a guide can carry; in the plane the one along the left normal of its motion."""
    sliding = [v for w, v in link.S if all(is_zero(x) for x in w)]
    if axes.plane and len(forces) == 1 and len(sliding) == 1:
        v = sliding[0]
        return [("n", Vector((-v[1], v[0], 0)))]
    return list(zip(_numbered("n", len(forces)), forces, strict=True))


def joint_friction(system: System, link: BodyLink) -> Scalar | None:
    """The friction of a path, slide or hinge along it for a unit of the force that it carries; None without, or while
    it sticks."""
    value, mode = system.scope.value, system.modes.get(link.name, ContactMode())
    for k, _, law in () if link.joint is None else link.joint.frictions:
        if law.coulomb is not None:
            return None if mode.sense == 0 else mode.joint_factor(law, value, link.s_rate[k]) * value(law.coulomb)
    pieces = getattr(link.joint, "pieces", ())
    factors = [mode.friction_factor(piece.friction, value, link.s_rate[0]) for piece in pieces]
    if all(factor is None for factor in factors):
        return None
    friction: Scalar = link.joint.of_its_piece(
        link.s[0], value, [0 if factor is None else factor for factor in factors]
    )
    return friction


def is_of_whole_force(motion: Motion, link: BodyLink) -> bool:
    """True if the friction of a joint goes by the size of its force, which has no sign."""
    return motion.scope.model.space == "space" or bool(link.joint is not None and link.joint.frictions)


def sliding_friction(system: System, component: Component) -> tuple[Scalar, Scalar]:
    """(friction along the contact for a unit of the component, the sliding velocity) of a component with friction."""
    if component.kind == "joint":
        link = system.motion.link(component.owner)
        factor, sliding = joint_friction(system, link), link.s_rate[0]
    else:
        number = component.number - 1 if component.bilateral_friction is not None else component.number
        row = next(r for r in system.constraints.rows if (r.constraint, r.number) == (component.owner, number))
        factor, sliding = row.friction, row.sliding
    assert factor is not None, "what has an effect of friction has its factor"
    return factor, sliding


# -- of constraints ---------------------------------------------------------------------------------------


def _constraint_components(system: System, axes: Axes) -> list[Component]:
    found = []
    for row in system.constraints.rows:
        effects = _constraint_effects(axes, row)
        if not effects:
            continue
        found.append(_of_constraint(system, row, effects, () if row.round else _friction(axes, row)))
        if row.round and row.friction is not None:
            along = tuple(e for push in row.tangent for e in axes.effects_of(push))
            found.append(
                Component(row.constraint, "constraint", "t", row.number + 1, along, bilateral_friction=row.friction)
            )
    return found


def seen_by_carriers(system: System) -> dict[int, tuple[str, Component]]:
    """{component: (the body that carries both bodies of its hinge, the same along that body's axes)}, in space."""
    motion = system.motion
    if motion.scope.model.space == "plane":
        return {}
    seen: dict[tuple[str, int], tuple[str, Component]] = {}
    for row in system.constraints.rows:
        if row.carrier is not None and row.component in ("x", "y", "z"):
            effects = _constraint_effects(Axes(motion.seen_from(row.carrier)), row)
            seen[row.constraint, row.number] = (row.carrier, _of_constraint(system, row, effects, ()))
    rows = [(c.owner, c.number) if c.kind == "constraint" else ("", 0) for c in Axes(motion).components_of(system)]
    return {j: seen[row] for j, row in enumerate(rows) if row in seen}


def _constraint_effects(axes: Axes, row: Row) -> tuple[Effect, ...]:
    return tuple(e for push in row.pushes for e in axes.effects_of(push))


def ends_of_round(motion: Motion, components: Sequence[Component], friction: Component) -> Ends:
    """The forces by which a bilateral contact rubs, as combinations of the components."""
    if friction.kind == "joint":
        return ends_of_joint(motion, components, friction.owner)
    mine = (friction.kind, friction.owner)
    each = (j for j, c in enumerate(components) if (c.kind, c.owner) == mine and c.label.startswith("n "))
    return (tuple(((j, 1),) for j in each),)


def ends_of_joint(motion: Motion, components: Sequence[Component], body: str) -> Ends:
    """The forces by which a joint rubs, each by its parts, as combinations of the components.

    One force: of a slide or path that across it, of a hinge all of it, of a thread that of its flanks. Of a guide with
    a length L two, at its ends: N/2 +- M x n/L, with the force N and the couple M across it.

    Source: Hibbeler, Engineering Mechanics: Statics, 8.2 (drawers and collars that bind).
    """
    own = [(j, c) for j, c in enumerate(components) if (c.kind, c.owner) == ("joint", body)]
    threaded = any(c.label == "wrench 1" for _, c in own)
    labels = ("wrench 1",) if threaded else ("n", "n 1", "n 2", "x", "y", "z")
    forces = [(j, c) for j, c in own if c.label in labels]
    link = motion.link(body)
    laws = () if link.joint is None else link.joint.frictions
    k, length = next(((k, law.guide) for k, _, law in laws if law.coulomb is not None), (0, None))
    if length is None:
        return (tuple(((j, 1),) for j, _ in forces),)
    couples = [(j, c) for j, c in own if c.label.startswith("couple")]
    n, L, found = link.S[k][1], motion.scope.value(length), []
    for end in (1, -1):
        parts = []
        for j, c in forces:
            e = c.effects[0].force
            arms = [(i, 1 if c.label == "n" else m.effects[0].couple @ n.cross(e)) for i, m in couples]
            parts.append(((j, Fraction(1, 2)), *((i, over(end * arm, L)) for i, arm in arms if not is_zero(arm))))
        found.append(tuple(parts))
    return tuple(found)


def load_of(ends: Sequence[Sequence[Scalar]]) -> Scalar:
    """The sum of the sizes of forces of such parts; of a single part as it is, with its sign."""
    if len(ends) == 1 and len(ends[0]) == 1:
        return ends[0][0]
    return sum((size_of_parts(parts) for parts in ends), start=0)


def size_of_parts(parts: Sequence[Scalar]) -> Scalar:
    """abs(N), sqrt(N_1^2 + N_2^2)"""
    return function("abs", parts[0]) if len(parts) == 1 else sqrt(sum((x * x for x in parts), start=0))


def _friction(axes: Axes, row: Row) -> tuple[FrictionShare, ...]:
    """The friction of a row along its tangent, on a surface along both."""
    if row.friction is None:
        return ()
    ways = zip("ts", row.shares or (1,), (row.tangent, row.cross_tangent), strict=False)
    return tuple(
        FrictionShare(label, row.friction * share, tuple(e for push in pushes for e in axes.effects_of(push)))
        for label, share, pushes in ways
    )


def _of_constraint(
    system: System, row: Row, effects: tuple[Effect, ...], friction: tuple[FrictionShare, ...]
) -> Component:
    """The component; of a hinge of several bodies, the force on the one that the row adds.

    Where the first-named point is the ground's, it is the force on the body.
    """
    first = row.pushes[0]
    held = row.component in ("x", "y", "z")
    from_ground = isinstance(first, PointForce) and first.place[0] is None
    points = getattr(system.scope.model.constraints.get(row.constraint), "points", None) or ()
    if held and (len(points) > 2 or from_ground):
        side = system.motion.links[effects[-1].link].name if len(points) > 2 else ""
        opposite = tuple(e.times(-1) for e in effects)
        return Component(row.constraint, "constraint", row.component, row.number, opposite, (), side)
    return Component(row.constraint, "constraint", row.component, row.number, effects, friction, row.part)


# -------- placements ------------------------------------------------------------------------------------------
# System, what else reacts -> Components: the wrenches that hold bodies which are placed by given motions.
#
# A `placed` body is geometry: where its places depend on free coordinates alone, named constraints hold it. Where they
# move with time, something moves it as given. That is a wrench which does no work along any free coordinate q,
#
#     w = sum c_k d_k,   d_k the wrench that does work on the variable s_k alone,   sum c_k ds_k/dq = 0
#
# and of these only those are unknown that no other reaction can make up for. A body of which all variables are given,
# and that nothing else holds, takes any force and any couple: its reaction in its place. What hangs on it then reacts
# as on a base that moves.


WayWithSlopes = tuple[SparseRow, list[Scalar]]  # a way, and its slopes along the free coordinates


def placements_of(system: System, axes: Axes, others: Sequence[Component]) -> tuple[Component, ...]:
    """Reactions of every body that is placed by a given motion.

    Args:
        others: the reactions of all joints and constraints.
    Raises:
        MissingValues, DerivationError: the constraints cannot be satisfied near the start.
    """
    given = {link.name: ways for link in axes.motion.links if (ways := _free_of_work(system, link))}
    if not given:
        return ()
    numbers = _Numbers(axes, Closure(system.constraints).generic())
    held = numbers.columns([(*c.effects, *c.friction_effects) for c in others])
    found: list[Component] = []
    for name, ways in given.items():
        found += _of_body(system, axes.motion.link(name), ways, numbers, held)
    return tuple(found)


def _free_of_work(system: System, link: BodyLink) -> list[SparseRow]:
    """The {k: c_k} that do no work along any free coordinate, of a body that is placed and that time moves; else none.

    They are eliminated by slopes that are numbers: what other slopes would say of a variable is left out.
    """
    if link.joint is None or not link.is_placed:
        return []
    driven, symbols = system.scope.model.driven_coordinates, system.symbols
    clocks = (symbols.t, *(q for q in symbols.q if q.name in driven))
    if not any(depends_on(s, clocks) for s in link.s):
        return []
    free = [q for q in symbols.q if q.name not in driven]
    left: list[WayWithSlopes] = [({k: 1}, [derivative(s, q) for q in free]) for k, s in enumerate(link.s)]
    for j in range(len(free)):
        pivot = next((row for row in left if type(row[1][j]) is not Node and row[1][j] != 0), None)
        if pivot is not None:
            left = [_less(row, over(row[1][j], pivot[1][j]), pivot) for row in left if row is not pivot]
    return [way for way, slopes in left if all(is_zero(x) for x in slopes)]


def _less(row: WayWithSlopes, factor: Scalar, other: WayWithSlopes) -> WayWithSlopes:
    """A row less so many times the other."""
    if is_zero(factor):
        return row
    way = dict(row[0])
    for k, x in other[0].items():
        way[k] = way.get(k, 0) - factor * x
    return way, [x - factor * y for x, y in zip(row[1], other[1], strict=True)]


@dataclass(frozen=True)
class _Numbers:
    """Forces and couples on the bodies at a state in numbers: rows of the balance."""

    axes: Axes
    state: State

    def columns(self, effects: Sequence[Sequence[Effect]]) -> np.ndarray:
        """Force, and moment about the mass centre, on every body, of each of these, rows x columns."""
        rows, several = self.axes.rows, [(j, e) for j, each in enumerate(effects) for e in each]
        flat = tuple(e.six[d] for _, e in several for d in rows)
        values = iter(floats_of(evaluate(flat, self.state, fifty_digits())))
        found = np.zeros((len(rows) * len(self.axes.motion.links), len(effects)))
        for j, e in several:
            for n in range(len(rows)):
                found[len(rows) * e.link + n, j] += next(values)
        return found

    def more(self, held: np.ndarray, effects: Sequence[Sequence[Effect]]) -> int:
        """Increase of the rank of the reactions `held` by these effects."""
        return _rank(np.hstack([held, self.columns(effects)])) - _rank(held)


def _rank(columns: np.ndarray) -> int:
    return rank(columns, smallest=tolerances.RANK_NEARBY)


def _of_body(
    system: System, link: BodyLink, ways: Sequence[SparseRow], numbers: _Numbers, held: np.ndarray
) -> Iterator[Component]:
    axes = numbers.axes
    if len(ways) == len(link.s):
        wrench = list(_any_wrench(system, axes, link))
        effects = [effects_at_joint(axes, link, force, couple) for _, force, couple in wrench]
        if numbers.more(held, effects) == len(wrench):
            yield from _components(link, [label for label, _, _ in wrench], effects)
            return
    needed = [effects for effects in (_along(axes, link, way) for way in ways) if numbers.more(held, [effects])]
    yield from _components(link, [f"wrench {k}" for k in range(1, len(needed) + 1)], needed)


def _along(axes: Axes, link: BodyLink, way: SparseRow) -> list[Effect]:
    """Effects of the wrench sum c_k d_k."""
    force, couple = Vector.ZERO, Vector.ZERO
    for k, c in way.items():
        f, n = link.pushed_along(k, c)
        force, couple = force + f, couple + n
    return effects_at_joint(axes, link, force, couple)


def _components(link: BodyLink, labels: Sequence[str], effects: Sequence[Sequence[Effect]]) -> Iterator[Component]:
    for number, (label, own) in enumerate(zip(labels, effects, strict=True), start=1):
        yield Component(link.name, "joint", label, number, tuple(own))


def _any_wrench(system: System, axes: Axes, link: BodyLink) -> Iterator[tuple[str, Vector, Vector]]:
    """(label, force, couple) along the axes of the body's equations, child's axes."""
    R_CE = axes.of_body(link).T
    for k in range(2 if axes.plane else 3):
        yield "xyz"[k], R_CE @ Matrix.IDENTITY[k], Vector.ZERO
    if not axes.plane:
        yield from ((f"couple {axis}", Vector.ZERO, e) for axis, e in zip("xyz", Matrix.IDENTITY, strict=True))
    elif not is_idle(axes, link, system):
        yield "couple", Vector.ZERO, Matrix.IDENTITY[2]
