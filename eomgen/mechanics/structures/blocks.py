"""Plan -> Blocks: the bodies and truss members that move as one rigid body, as a textbook numbers them."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from dataclasses import field
from functools import partial
from itertools import chain
from typing import Any

from eomgen.mechanics.equations.system import System
from eomgen.mechanics.fields.field import VelocityField
from eomgen.mechanics.structures.velocity_plan import PlanCenter, VelocityPlan
from eomgen.model.constraints.members import trusses_of
from eomgen.model.trusses import is_node
from eomgen.records import dataclass
from eomgen.symbolic.expression.functions import over
from eomgen.symbolic.expression.graph import Scalar
from eomgen.symbolic.expression.spatial import ZERO, Vector, cross, dot, minus, plus, vector_of
from eomgen.symbolic.numeric.tolerances import ZERO_AT_50

Member = tuple[str, str, tuple[str, str]]
"""(truss, member, its two nodes)"""
NodeNumbers = Sequence[Any]
"""Of a node in the plane (v_x, v_y, x, y), with 50 digits."""


@dataclass(frozen=True)
class RigidBlock:
    """What moves as one rigid body.

    Args:
        bodies: their names.
        members: of trusses, (truss, "n1-n2").
        nodes: of trusses, of which no member moves along: points.
        spin: angular velocity, ground axes.
        velocity: of the point of the block at the ground's origin, ground axes.
    """

    bodies: tuple[str, ...]
    members: tuple[tuple[str, str], ...]
    nodes: tuple[str, ...]
    spin: Vector
    velocity: Vector

    @property
    def parts(self) -> tuple[str, ...]:
        """Everything in it by name."""
        return (*self.bodies, *(f"{truss} {member}" for truss, member in self.members), *self.nodes)

    def center(self, plan: VelocityPlan) -> PlanCenter:
        """Its centre of rotation in the plane."""
        return plan.center(VelocityField(v=self.velocity, w=self.spin))


def blocks_of(plan: VelocityPlan) -> tuple[RigidBlock, ...]:
    """The blocks that move, in the order of the model; what is in none of them stays at rest."""
    groups: list[_Group] = []
    for part in _bodies(plan):
        group = next((g for g in groups if _agree(g.parts[0].numbers, part.numbers)), None)
        if group is None:
            groups.append(_Group([part]))
        else:
            group.parts.append(part)
    members = _moving_members(plan)
    nodes = _nodes_of(plan, members)
    for member in members:
        group = next((g for g in groups if all(g.carries(node, nodes(node)) for node in member[2])), None)
        if group is not None:
            group.parts.append(_member(plan, member, ()))
        elif numbers := _numbers_of(*map(nodes, member[2])):
            groups.append(_Group([_member(plan, member, numbers)]))
    blocks = [_joined(plan, group.parts) for group in groups]
    return (*blocks, *_single_nodes(plan, blocks))


def turning_by_one(plan: VelocityPlan) -> Scalar:
    """1/w of the first block that turns about one axis; 1 where none does."""
    for part in chain(_bodies(plan), _members(plan)):
        turning = [k for k, w in enumerate(part.numbers[:3]) if abs(w) > ZERO_AT_50]
        if len(turning) == 1:
            return plan.simple(over(1, part.motion()[0][turning[0]]))
    return 1


def resting_blocks(plan: VelocityPlan) -> tuple[str, ...]:
    """The bodies and trusses of which nothing moves, by name."""
    links = plan.system.motion.links
    bodies = tuple(link.name for link in links if link.name not in plan.moving and not is_node(link.name))
    trusses = dict.fromkeys(link.name.partition(".")[0] for link in links if is_node(link.name))
    awake = {name.partition(".")[0] for name in plan.moving if is_node(name)}
    return (*bodies, *(name for name in trusses if name not in awake))


def numeral(number: int) -> str:
    """By which a textbook names a block: I, II, III, IV, ..."""
    text = ""
    for value, letters in ((10, "X"), (9, "IX"), (5, "V"), (4, "IV"), (1, "I")):
        text += letters * (number // value)
        number %= value
    return text


def members_of(system: System) -> list[Member]:
    """(truss, member, its two nodes) of every truss."""
    trusses = trusses_of(system.scope.model.constraints)
    return [(name, member, truss.ends(member)) for name, truss in trusses.items() for member in truss.members]


@dataclass(frozen=True)
class _Part:
    """A body or a member that moves, by itself.

    Args:
        numbers: its spin, and the velocity of its point at the ground's origin, 6, with 50 digits.
        motion: both in closed form, where they are asked for.
    """

    bodies: tuple[str, ...]
    members: tuple[tuple[str, str], ...]
    numbers: Sequence[Any]
    motion: Callable[[], tuple[Vector, ...]]


def _bodies(plan: VelocityPlan) -> Iterable[_Part]:
    """The bodies that are no nodes."""
    names = [name for name in plan.moving if not is_node(name)]
    motions = [(plan.raw_spin(name), plan.raw_velocity_at(name, ZERO)) for name in names]
    flat = iter(plan.numbers([x for motion in motions for three in motion for x in three]))
    for name, motion in zip(names, motions, strict=True):
        yield _Part((name,), (), [next(flat) for _ in range(6)], partial(tuple, motion))


@dataclass(frozen=True)
class _Group:
    """What moves as one.

    Args:
        parts: the first has the numbers of all.
        known: of the nodes that were asked, whether they move with it.
    """

    parts: list[_Part]
    known: dict[str, bool] = field(default_factory=dict)

    def carries(self, node: str, moving: NodeNumbers) -> bool:
        """Whether a node in the plane moves with it: v = v_0 + w x r."""
        if node not in self.known:
            _, _, w, v_x, v_y, _ = self.parts[0].numbers
            vx, vy, x, y = moving
            self.known[node] = abs(vx - v_x + w * y) < ZERO_AT_50 and abs(vy - v_y - w * x) < ZERO_AT_50
        return self.known[node]


def _members(plan: VelocityPlan) -> Iterable[_Part]:
    """The moving members in the plane that keep their length."""
    for member in _moving_members(plan):
        if numbers := _numbers_of(*map(_nodes_of(plan, [member]), member[2])):
            yield _member(plan, member, numbers)


def _moving_members(plan: VelocityPlan) -> list[Member]:
    if plan.system.scope.model.space != "plane":
        return []
    moving = {*plan.moving}
    return [each for each in members_of(plan.system) if not moving.isdisjoint(each[2])]


def _member(plan: VelocityPlan, member: Member, numbers: Sequence[Any]) -> _Part:
    truss, name, ends = member
    return _Part((), ((truss, name),), numbers, partial(_of_ends, plan, ends))


def _nodes_of(plan: VelocityPlan, members: Sequence[Member]) -> Callable[[str], NodeNumbers]:
    """node -> (vx, vy, x, y) with 50 digits, of the nodes of these members, all found in one go"""
    names = dict.fromkeys(node for _, _, ends in members for node in ends)
    flat = iter(plan.numbers([x for name in names for x in _of_node(plan, name)]))
    known = {name: tuple(next(flat) for _ in range(4)) for name in names}
    return known.__getitem__


def _numbers_of(one: NodeNumbers, other: NodeNumbers) -> tuple[Any, ...]:
    """Of a member by its nodes, w = r x (v_2 - v_1) / r.r; () of one that does not keep its length."""
    (vx, vy, x, y), (wx, wy, x_2, y_2) = one, other
    ax, ay, dx, dy = wx - vx, wy - vy, x_2 - x, y_2 - y
    if abs(ax * dx + ay * dy) > ZERO_AT_50:
        return ()
    w = (dx * ay - dy * ax) / (dx * dx + dy * dy) if ax or ay else 0
    return 0, 0, w, vx + w * y, vy - w * x, 0


def _of_node(plan: VelocityPlan, name: str) -> tuple[Scalar, ...]:
    """Velocity and place of a node in the plane."""
    return (*plan.raw_velocity((name, ZERO))[:2], *plan.position((name, ZERO))[:2])


def _of_ends(plan: VelocityPlan, ends: tuple[str, str]) -> tuple[Vector, Vector]:
    """The motion of a member by its nodes, in closed form."""
    (v, place), (v_2, place_2) = ((plan.raw_velocity((n, ZERO)), plan.position((n, ZERO))) for n in ends)
    along, apart = minus(place_2, place), minus(v_2, v)
    spin: Vector = (0, 0, over(cross(along, apart)[2], dot(along, along)))
    moved = plus(v, cross(spin, minus(ZERO, place)))
    return spin, (moved[0], moved[1], 0)


def _agree(one: Sequence[Any], other: Sequence[Any]) -> bool:
    return all(abs(x - y) < ZERO_AT_50 for x, y in zip(one, other, strict=True))


def _joined(plan: VelocityPlan, group: list[_Part]) -> RigidBlock:
    bodies = tuple(name for part in group for name in part.bodies)
    members = tuple(member for part in group for member in part.members)
    spin, velocity = (vector_of(map(plan.simple, x)) for x in group[0].motion())
    return RigidBlock(bodies, members, (), spin, velocity)


def _single_nodes(plan: VelocityPlan, blocks: list[RigidBlock]) -> list[RigidBlock]:
    """Moving nodes at the end of no moving member that keeps its length."""
    ends = {(truss, member): pair for truss, member, pair in members_of(plan.system)}
    carried = {node for block in blocks for member in block.members for node in ends[member]}
    alone = [name for name in plan.moving if is_node(name) and name not in carried]
    return [RigidBlock((), (), (name,), ZERO, plan.raw_velocity((name, ZERO))) for name in alone]
