"""Reactions -> all quantities that outputs can name: reaction_x(B), reaction_n(wall), tension(rope, 2).

In the plane these are the components themselves; in space, and at hinges of several bodies, sums of them in the
ground's axes. Each contact with friction also has its friction along the contact's tangent, reaction_t(wall), on a
surface along both tangents.
"""

from __future__ import annotations

from collections.abc import Callable, Container, Iterable, Iterator, Mapping, Sequence
from dataclasses import replace

from eomgen.frozen import dataclass
from eomgen.mechanics.constraints import Row, holds_identically
from eomgen.mechanics.free_bodies.balance import Balance
from eomgen.mechanics.free_bodies.wrenches import COUPLE, FORCE, Axes, Component, Effect
from eomgen.mechanics.kinematics import BodyLink, Motion
from eomgen.model import PointForce
from eomgen.symbolic.expression import Fraction, Node, Scalar, Vector, depends_on, derivative, is_zero

OWN = frozenset(("n", "t", "s", "tension", "friction", ""))  # components that outputs name as they are, in space too

WrenchPart = Callable[[Effect], Vector]


@dataclass(frozen=True)
class NamedReaction:
    """sum of combination * components + given.

    Args:
        name: as an output writes it.
        owner: the constraint, or the body whose joint it is.
        unit: FORCE or COUPLE.
        combination: {index of the component: factor}.
        given: what drive, spring, damper and rotor of the joint do; of a drive, less what forces do on points that
            it moves in their bodies.
    """

    name: str
    owner: str
    unit: str
    combination: dict[int, Scalar]
    given: Scalar = 0

    @staticmethod
    def all_of(balance: Balance) -> tuple[NamedReaction, ...]:
        """Every reaction by its name, in the order of the components."""
        owners = dict.fromkeys(c.owner for c in balance.components)
        found = [named for owner in owners for named in _of_owner(balance, owner)]
        return (*found, *_of_sliding_joints(balance, {named.name for named in found}))


def _of_sliding_joints(balance: Balance, found: Container[str]) -> Iterator[NamedReaction]:
    """The dry friction of a given size in joints and forces: friction(rod), where it does not stick."""
    model = balance.system.scope.model
    for applied in balance.system.loads.applied:
        law = model.forces[applied.name].friction
        if law is not None and f"friction({applied.name})" not in found:
            unit = COUPLE if law.amount == "torque" else FORCE
            yield NamedReaction(f"friction({applied.name})", applied.name, unit, {}, applied.friction)
    for effort in balance.system.loads.efforts:
        link = balance.system.motion.link(effort.body)
        for k, field, law in link.joint.frictions:
            name = link.joint.named_contact(link.name, field)
            if k == effort.variable and law.size is not None and f"friction({name})" not in found:
                turns = not all(is_zero(x) for x in link.S[k][0])
                yield NamedReaction(f"friction({name})", name, COUPLE if turns else FORCE, {}, effort.friction)


def is_named_alone(balance: Balance, c: Component) -> bool:
    """True if outputs name a component as it is, in space too: of a hinge's stop the couple about its axis."""
    constraint = balance.system.scope.model.constraints.get(c.owner) if c.kind == "constraint" else None
    return c.label in OWN or (constraint is not None and constraint.about_joint)


def _of_owner(balance: Balance, owner: str) -> Iterable[NamedReaction]:
    mine = [(j, c) for j, c in enumerate(balance.components) if c.owner == owner]
    constraints = [(j, c) for j, c in mine if c.kind != "drive"]
    plane = balance.system.scope.model.space == "plane"
    wrenches = any(c.is_wrench for _, c in constraints)
    apart = [
        (j, c)
        for j, c in constraints
        if is_named_alone(balance, c) or (plane and c.label not in ("x", "y") and not c.is_wrench)
    ]
    if len(apart) < len(constraints):
        along = (0, 1) if plane else (0, 1, 2)
        for side in dict.fromkeys(("", *(c.side for _, c in constraints))):
            yield from _vector(balance, owner, side, "", FORCE, along)
        if not plane and any(_has_couple(c) for _, c in constraints):
            yield from _vector(balance, owner, "", "couple_", COUPLE, along)
        if plane and wrenches:
            (about_z,) = _vector(balance, owner, "", "couple_", COUPLE, (2,))
            yield replace(about_z, name=f"reaction_couple({owner})")
    for j, c in apart:
        yield NamedReaction(_name(balance, c), owner, c.unit, {j: 1})
        for share in c.friction:
            name = f"friction({owner})" if share.label == "friction" else f"reaction_{share.label}({owner})"
            yield NamedReaction(name, owner, FORCE, {j: share.factor})
    constraint = balance.system.scope.model.constraints.get(owner)
    if constraint is not None and constraint.exponent is not None:
        yield from _sides(owner, dict(apart))
    for j, c in mine:
        if c.kind == "drive" and j == min(drives := _drives(balance, j, c)):  # once, at the first of its joints
            yield NamedReaction(c.name, owner, c.unit, drives, _less_inside(balance, c))


def _sides(owner: str, mine: Mapping[int, Component]) -> Iterable[NamedReaction]:
    """Tensions of both sides of a rope on a drum, T -+ F/2, F sliding or sticking."""
    mean = next((j for j, c in mine.items() if c.label == "tension"), None)
    if mean is None:
        return
    sliding = sum((share.factor for share in mine[mean].friction), start=0)
    held = [j for j, c in mine.items() if c.label == "t"]
    for number, half in ((1, Fraction(-1, 2)), (2, Fraction(1, 2))):
        combination = {mean: 1 + half * sliding, **dict.fromkeys(held, half)}
        yield NamedReaction(f"tension({owner}, {number})", owner, FORCE, combination)


def _vector(
    balance: Balance, owner: str, side: str, prefix: str, unit: str, along: Sequence[int]
) -> Iterable[NamedReaction]:
    """Force or couple on the first-named body, or on `side`, in the ground's axes."""
    motion = balance.system.motion
    part: WrenchPart = (lambda e: e.couple) if unit == COUPLE else (lambda e: e.force)
    mine = [(j, c) for j, c in enumerate(balance.components) if c.owner == owner]
    on = motion.index[side] if side else next(c for _, c in mine if c.kind != "drive").effects[0].link
    units = {j: _turned(balance, on, _sum(part, on, (*c.effects, *c.friction_effects))) for j, c in mine}
    efforts = Effect.of_joint(balance.system, owner) if owner in motion.index else []
    given = _turned(balance, on, _sum(part, on, efforts))
    place = f"{owner}.{side}" if side else owner
    for k in along:
        combination = {j: vector[k] for j, vector in units.items() if not is_zero(vector[k])}
        yield NamedReaction(f"reaction_{prefix}{'xyz'[k]}({place})", owner, unit, combination, given[k])


def _sum(part: WrenchPart, on: int, effects: Sequence[Effect]) -> Vector:
    total = Vector.ZERO
    for effect in effects:
        if effect.link == on:
            total = total + part(effect)
    return total


def _turned(balance: Balance, on: int, vector: Vector) -> Vector:
    """Vector in the ground's axes of one in the axes of the body's equations."""
    plane = balance.system.scope.model.space == "plane"
    return vector if plane else balance.system.motion.links[on].pose.R @ vector


def _has_couple(component: Component) -> bool:
    return any(not is_zero(x) for effect in component.effects for x in effect.couple)


def _name(balance: Balance, component: Component) -> str:
    """Name of a component; a strand has its number in the string, and of several with one tension the first counts."""
    if component.label != "tension" or component.side:
        return component.name
    numbers = balance.system.scope.model.constraints[component.owner].strand_rows() or (1,)
    strand = numbers.index(component.number) + 1
    return f"tension({component.owner})" if strand == 1 else f"tension({component.owner}, {strand})"


def _drives(balance: Balance, j: int, component: Component) -> dict[int, Scalar]:
    """Combination of reactions that is the force of the drive of a coordinate q: their work as q alone changes.

    sum over joints of D_k ds_k/dq, s_k the variable of the joint; for joints whose seat q moves, the work on the seat;
    for placed bodies, the work of their reaction; for constraints sum f . dp/dq - dphi/dq, the work on places that q
    moves and that belong to no body.
    """
    if not component.side:
        return {j: 1}
    motion = balance.system.motion
    (q,) = (x for x in motion.scope.symbols.q if x.name == component.side)
    rows = {(row.constraint, row.number): row for row in balance.system.constraints.rows if row.gap is not None}
    found: dict[int, Scalar] = {}
    for i, c in enumerate(balance.components):
        if c.kind == "drive" and c.side == q.name:
            found[i] = derivative(motion.link(c.owner).s[c.number - 1], q)
        elif c.kind == "joint" and ((link := motion.link(c.owner)).is_placed or _moves_seat(link, q)):
            found[i] = _work(motion, c.effects, q)
        elif c.kind == "constraint" and c.bilateral_friction is None and (c.owner, c.number) in rows:
            found[i] = _left_out(balance, rows, rows[c.owner, c.number], q)
    return {i: k for i, k in found.items() if not is_zero(k)}


def _less_inside(balance: Balance, component: Component) -> Scalar:
    """-sum F . R dr/dq: what forces do on points r that a driven coordinate q moves in their bodies, q carries none."""
    motion = balance.system.motion
    scope = motion.scope
    q = next((x for x in scope.symbols.q if x.name == component.side), None)
    total: Scalar = 0
    for push in (
        load for force in balance.system.loads.applied for load in force.loads if isinstance(load, PointForce)
    ):
        body, r = push.place
        if q is not None and body is not None and any(depends_on(x, (q,)) for x in r):
            slide = motion.link(body).pose.R @ Vector(derivative(x, q) for x in r)
            total = total - motion.in_ground_axes(push.force, push.axes) @ slide
    return total


def _left_out(balance: Balance, rows: Mapping[tuple[str, int], Row], row: Row, q: Node) -> Scalar:
    """f . dp/dq - dphi/dq of a unit of a row's component: what acts on places that q moves and that no body carries.

    A force along an axis of the ground has parts R^T e along those of the carrier, from which the gaps are seen.
    """
    if row.carrier is None or row.component not in ("x", "y", "z"):
        return _left_of_row(balance, row, q)
    k, R = "xyz".index(row.component), balance.system.motion.link(row.carrier).pose.R
    beside = (
        rows.get((row.constraint, row.number - k + n))
        for n in range(2 if balance.system.scope.model.space == "plane" else 3)
    )
    parts = ((R[k][n], _left_of_row(balance, each, q)) for n, each in enumerate(beside) if each is not None)
    found: Scalar = sum((x * left for x, left in parts if not is_zero(left)), start=0)
    return found


def _left_of_row(balance: Balance, row: Row, q: Node) -> Scalar:
    """The same along the axes of the row's carrier, all seen from there."""
    assert row.gap is not None, "rows of velocities alone have no places"
    slope = derivative(row.gap, q)
    motion = balance.system.motion
    if is_zero(slope):
        return 0
    seen = motion if row.carrier is None else motion.seen_from(row.carrier)
    left = _work(seen, [e for push in row.pushes for e in Axes(seen).effects_of(push)], q) - slope
    return 0 if is_zero(left) or holds_identically(left) else left


def _moves_seat(link: BodyLink, q: Node) -> bool:
    """True if a coordinate moves the seat of a joint in its parent, or the joint's point in its body."""
    seat = (*link.before.p, *link.point, *(x for row in link.before.R for x in row))
    return any(depends_on(x, (q,)) for x in seat)


def _work(motion: Motion, effects: Iterable[Effect], q: Node) -> Scalar:
    """f . dp/dq + n . dtheta/dq: the work of effects on the bodies as q alone changes."""
    axes = Axes(motion)
    total: Scalar = 0
    for effect in effects:
        link = motion.links[effect.link]
        turn = _turn(link, q)
        if effect.place is not None:  # of the body, wherever q moves what acts there
            p = Vector(derivative(x, q) for x in link.pose.p) + turn.cross(link.pose.R @ effect.place)
            total = total + effect.force @ axes.of_ground(link, p)
        total = total + effect.couple @ axes.of_ground(link, turn)
    return total


def _turn(link: BodyLink, q: Node) -> Vector:
    """dtheta/dq of a body, ground axes: the vector of dR/dq R^T."""
    if link.angle is not None:
        return Vector((0, 0, derivative(link.angle, q)))
    R = link.pose.R
    slope = [Vector(derivative(x, q) for x in row) for row in R]
    return Vector((slope[2] @ R[1], slope[0] @ R[2], slope[1] @ R[0]))
