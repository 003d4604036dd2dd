"""Plan -> Blocks: the bodies and truss members that move as one rigid body, as a textbook numbers them."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from functools import cache, partial
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
    groups: list[list[_Part]] = []
    for part in (*_bodies(plan), *_members(plan)):
        group = next((g for g in groups if _agree(g[0].numbers, part.numbers)), None)
        if group is None:
            groups.append([part])
        else:
            group.append(part)
    blocks = [_joined(plan, group) for group in groups]
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


def members_of(system: System) -> list[tuple[str, str, tuple[str, str]]]:
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
    fields = [(plan.raw_spin(name), plan.raw_velocity_at(name, ZERO)) for name in names]
    flat = iter(plan.numbers([x for field in fields for three in field for x in three]))
    for name, field in zip(names, fields, strict=True):
        yield _Part((name,), (), [next(flat) for _ in range(6)], partial(tuple, field))


def _members(plan: VelocityPlan) -> Iterable[_Part]:
    """The moving members in the plane that keep their length: w = r x (v_2 - v_1) / r.r"""
    if plan.system.scope.model.space != "plane":
        return
    moving = {*plan.moving}
    members = [each for each in members_of(plan.system) if not moving.isdisjoint(each[2])]
    known = cache(lambda node: plan.numbers(_of_node(plan, node)))
    for truss, member, ends in members:
        (vx, vy, x, y), (wx, wy, x_2, y_2) = map(known, ends)
        ax, ay, dx, dy = wx - vx, wy - vy, x_2 - x, y_2 - y
        if abs(ax * dx + ay * dy) <= ZERO_AT_50:
            w = (dx * ay - dy * ax) / (dx * dx + dy * dy) if ax or ay else 0
            numbers = (0, 0, w, vx + w * y, vy - w * x, 0)
            yield _Part((), ((truss, member),), numbers, partial(_of_ends, plan, ends))


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
