"""System -> Components: every scalar reaction of joints and ties, and what a unit of it does to the bodies."""

from __future__ import annotations

from collections.abc import Sequence
from functools import cached_property

from eomgen.errors import DerivationError
from eomgen.mechanics.balance.unit_wrenches import (
    Axes,
    Effect,
    effects_at_joint,
    effects_of_load,
    scaled_axes,
)
from eomgen.mechanics.bodies.contact_modes import CLOSED, friction_factor
from eomgen.mechanics.bodies.kinematics import BodyLink, Motion
from eomgen.mechanics.constraints.ties import Row
from eomgen.mechanics.equations.system import System
from eomgen.model.driven import driven_coordinates
from eomgen.model.forces.load import Couple, PointForce
from eomgen.records import dataclass
from eomgen.symbolic.expression.derivative import depends_on
from eomgen.symbolic.expression.graph import Node, Scalar, is_zero
from eomgen.symbolic.expression.spatial import ZERO, Vector, in_turned_axes, transposed, vector_of

EACH_AXIS: tuple[Vector, Vector, Vector] = ((1, 0, 0), (0, 1, 0), (0, 0, 1))


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
        owner: the tie, or the body whose joint it is.
        kind: "tie", "joint", or "drive": what moves a driven coordinate at a joint.
        label: "x", "y", "z", "n", "t", "couple", "couple x", "wrench 1", "tension", "drive"; "" of a row of no place.
        number: its row in the tie, or its place among the joint's components, from 1.
        effects: of a unit of it, on the child or the first-named body first.
        friction: along each direction in which its contact slides.
        side: the body on which it is the force of a hinge of several, the coordinate of a drive, the member of a
            truss, or "".
        bilateral_friction: of the friction of a bilateral contact, which is a component of its own: its factor for a
            unit of |N| = sqrt(N_1^2 + N_2^2); None of all else.
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
        """Whether it is friction, or there is friction by it."""
        return bool(self.friction) or self.bilateral_friction is not None

    @property
    def is_wrench(self) -> bool:
        """Whether it is a force and a couple together: one of a screw, or of what is placed."""
        return self.label.startswith("wrench")

    @property
    def name(self) -> str:
        """As an output asks for it: reaction_x(B), tension(rope, 2)."""
        if self.label == "tension":
            which = self.side or (self.number if self.number > 1 else "")
            return f"tension({self.owner}, {which})" if which else f"tension({self.owner})"
        if self.label == "drive":
            return f"drive({self.side or self.owner})"
        owner = f"{self.owner}.{self.side}" if self.side else self.owner
        return f"reaction_{self.label.replace(' ', '_')}({owner})"


def components_of(system: System, axes: Axes) -> tuple[Component, ...]:
    """All of them: those of the joints, what drives given motions, those of the ties."""
    return (*_joint_components(system, axes), *_tie_components(system, axes))


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
        along = () if factor is None else tuple(effects_at_joint(axes, link, *scaled_axes(axes, link.name, 0, 1)))
        for number, (label, force, couple) in enumerate(pushes, start=1):
            effects = tuple(effects_at_joint(axes, link, force, couple))
            friction = (FrictionShare("t", factor, along),) if label == "n" and factor is not None else ()
            found.append(Component(link.name, "joint", label, number, effects, friction))
        if factor is not None and not axes.plane:
            found.append(Component(link.name, "joint", "t", len(pushes) + 1, along, bilateral_friction=factor))
        for k in range(len(link.s)):
            if (driver := driven.get((link.name, k))) is not None:
                effects = tuple(effects_at_joint(axes, link, *scaled_axes(axes, link.name, k, 1)))
                found.append(Component(link.name, "drive", "drive", k + 1, effects, (), driver))
    return found


def _driven_variables(motion: Motion) -> dict[tuple[str, int], str]:
    """{(body, number of its joint's variable): coordinate} where somebody drives a given motion ("": time alone).

    They follow it alone. Where there is none, and what follows holds a free coordinate of no other joint, nothing has
    to push: the equation of that coordinate says so.

    Raises:
        DerivationError: that coordinate moves other joints too, so that the drive has no one place.
    """
    symbols, given = motion.scope.symbols, driven_coordinates(motion.scope.model)
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
    """Refuse what follows a driver and a free coordinate that moves other joints too."""
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
    """(label, force, couple) of each reaction of a joint, child's axes: the complement of its freedom."""
    columns = link.joint.complement(link.s, axes.motion.scope.value)
    forces = [vector_of(c[3:]) for c in columns if _vanishes(c[:3])]
    couples = [vector_of(c[:3]) for c in columns if _vanishes(c[3:])]
    if axes.plane:
        forces = [f for f in forces if not _vanishes(f[:2])]
        found = [("couple", ZERO, c) for c in couples if not is_zero(c[2])]
        return [*_forces(axes, link, forces, 2), *([] if is_idle(axes, link, system) else found)]
    mixed = [c for c in columns if not _vanishes(c[:3]) and not _vanishes(c[3:])]
    names = [f"couple {axis}" for axis in "xyz"] if len(couples) == 3 else _numbered("couple", len(couples))
    held = [(name, ZERO, c) for name, c in zip(names, EACH_AXIS if len(couples) == 3 else couples, strict=True)]
    wrenches = [(f"wrench {k}", vector_of(c[3:]), vector_of(c[:3])) for k, c in enumerate(mixed, start=1)]
    return [*_forces(axes, link, forces, 3), *held, *wrenches]


def _vanishes(entries: Sequence[Scalar]) -> bool:
    return all(is_zero(x) for x in entries)


def _numbered(name: str, count: int) -> list[str]:
    return [name] if count == 1 else [f"{name} {k}" for k in range(1, count + 1)]


def _forces(axes: Axes, link: BodyLink, forces: list[Vector], most: int) -> list[tuple[str, Vector, Vector]]:
    """The forces of a joint: along the equations' axes where it can carry any, else normal to its motion."""
    if len(forces) == most:
        R_CE = transposed(axes.of_body(link))
        return [("xyz"[k], in_turned_axes(R_CE, EACH_AXIS[k]), ZERO) for k in range(most)]
    return [(label, f, ZERO) for label, f in _normals(axes, link, forces)]


def is_idle(axes: Axes, link: BodyLink, system: System) -> bool:
    """Whether nothing can turn the body against its joint: a particle with all that acts on it at its mass."""
    motion = axes.motion
    shape = motion.scope.model.bodies[link.name].shape
    carries = any(other.parent == motion.index[link.name] for other in motion.links)
    if shape is None or not shape.is_point or carries or link.point != ZERO:
        return False
    loads = (*system.loads.placed, *(push for row in system.ties.rows for push in (*row.pushes, *row.tangent)))
    mine = [load for load in loads if link.name == (load.body if isinstance(load, Couple) else load.place[0])]
    return all(is_zero(effect.six[5]) for load in mine for effect in effects_of_load(axes, load))


def _normals(axes: Axes, link: BodyLink, forces: list[Vector]) -> list[tuple[str, Vector]]:
    """The forces that a guide can carry; in the plane the one along the left normal of its motion."""
    sliding = [v for w, v in link.S if all(is_zero(x) for x in w)]
    if axes.plane and len(forces) == 1 and len(sliding) == 1:
        v = sliding[0]
        return [("n", (-v[1], v[0], 0))]
    return list(zip(_numbered("n", len(forces)), forces, strict=True))


def joint_friction(system: System, link: BodyLink) -> Scalar | None:
    """The friction of a path along it for a unit of its normal reaction; None without friction, and elsewhere."""
    pieces = getattr(link.joint, "pieces", ())
    value, mode = system.scope.value, system.modes.get(link.name, CLOSED)
    factors = [friction_factor(piece.friction, value, link.s_rate[0], mode) for piece in pieces]
    if all(factor is None for factor in factors):
        return None
    friction: Scalar = link.joint.of_its_piece(
        link.s[0], value, [0 if factor is None else factor for factor in factors]
    )
    return friction


def sliding_friction(system: System, component: Component) -> tuple[Scalar, Scalar]:
    """Of a component with friction: (its friction along the contact for a unit of it, the sliding velocity)."""
    if component.kind == "joint":
        link = system.motion.link(component.owner)
        factor, sliding = joint_friction(system, link), link.s_rate[0]
    else:
        number = component.number - 1 if component.bilateral_friction is not None else component.number
        row = next(r for r in system.ties.rows if (r.tie, r.number) == (component.owner, number))
        factor, sliding = row.friction, row.sliding
    assert factor is not None, "what has an effect of friction has its factor"
    return factor, sliding


# -- of ties ---------------------------------------------------------------------------------------


def _tie_components(system: System, axes: Axes) -> list[Component]:
    found = []
    for row in system.ties.rows:
        effects = _tie_effects(axes, row)
        if not effects:
            continue
        found.append(_of_tie(system, row, effects, () if row.round else _friction(axes, row)))
        if row.round and row.friction is not None:
            along = tuple(e for push in row.tangent for e in effects_of_load(axes, push))
            found.append(Component(row.tie, "tie", "t", row.number + 1, along, bilateral_friction=row.friction))
    return found


def seen_by_carriers(system: System) -> dict[int, tuple[str, Component]]:
    """{component: (the body that carries both bodies of its hinge, the same along that body's axes)}, in space."""
    motion = system.motion
    if motion.scope.model.space == "plane":
        return {}
    seen: dict[tuple[str, int], tuple[str, Component]] = {}
    for row in system.ties.rows:
        if row.carrier is not None and row.component in ("x", "y", "z"):
            effects = _tie_effects(Axes(motion.seen_from(row.carrier)), row)
            seen[row.tie, row.number] = (row.carrier, _of_tie(system, row, effects, ()))
    rows = [(c.owner, c.number) if c.kind == "tie" else ("", 0) for c in components_of(system, Axes(motion))]
    return {j: seen[row] for j, row in enumerate(rows) if row in seen}


def _tie_effects(axes: Axes, row: Row) -> tuple[Effect, ...]:
    return tuple(e for push in row.pushes for e in effects_of_load(axes, push))


def normals_of_round(components: Sequence[Component], friction: Component) -> tuple[int, ...]:
    """Of the friction of a bilateral contact: which components its normal force has."""
    mine = (friction.kind, friction.owner)
    return tuple(j for j, c in enumerate(components) if (c.kind, c.owner) == mine and c.label.startswith("n "))


def _friction(axes: Axes, row: Row) -> tuple[FrictionShare, ...]:
    """The friction of a row along its tangent, on a surface along both."""
    if row.friction is None:
        return ()
    ways = zip("ts", row.shares or (1,), (row.tangent, row.cross_tangent), strict=False)
    return tuple(
        FrictionShare(label, row.friction * share, tuple(e for push in pushes for e in effects_of_load(axes, push)))
        for label, share, pushes in ways
    )


def _of_tie(system: System, row: Row, effects: tuple[Effect, ...], friction: tuple[FrictionShare, ...]) -> Component:
    """The component; of a hinge of several bodies, the force on the one that the row adds.

    Where the first-named point is the ground's, it is the force on the body.
    """
    first = row.pushes[0]
    held = row.component in ("x", "y", "z")
    from_ground = isinstance(first, PointForce) and first.place[0] is None
    points = getattr(system.scope.model.constraints.get(row.tie), "points", None) or ()
    if held and (len(points) > 2 or from_ground):
        side = system.motion.links[effects[-1].link].name if len(points) > 2 else ""
        opposite = tuple(e.times(-1) for e in effects)
        return Component(row.tie, "tie", row.component, row.number, opposite, (), side)
    return Component(row.tie, "tie", row.component, row.number, effects, friction, row.part)
