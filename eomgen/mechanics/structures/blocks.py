"""Plan -> Blocks: the bodies and truss members that move as one rigid body, as a textbook numbers them."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
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
    parts = [*_bodies(plan), *_members(plan)]
    flat = iter(plan.numbers([x for part in parts for x in (*part.spin, *part.velocity)]))
    fields = [[next(flat) for _ in range(6)] for _ in parts]
    groups: list[list[int]] = []
    for i, field in enumerate(fields):
        group = next((g for g in groups if _agree(fields[g[0]], field)), None)
        if group is None:
            groups.append([i])
        else:
            group.append(i)
    blocks = [_joined(plan, [parts[i] for i in group]) for group in groups]
    return (*blocks, *_single_nodes(plan, blocks))


def turning_by_one(plan: VelocityPlan) -> Scalar:
    """1/w of the first block that turns about one axis; 1 where none does."""
    for part in (*_bodies(plan), *_members(plan)):
        spins = [w for w in part.spin if not plan.vanishes((w,))]
        if len(spins) == 1:
            return plan.simple(over(1, spins[0]))
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


def _bodies(plan: VelocityPlan) -> Iterable[RigidBlock]:
    """The bodies that are no nodes, each by itself."""
    for name in plan.moving:
        if not is_node(name):
            yield RigidBlock((name,), (), (), plan.raw_spin(name), plan.raw_velocity_at(name, ZERO))


def _members(plan: VelocityPlan) -> Iterable[RigidBlock]:
    """The moving members in the plane that keep their length, each by itself: w = r x (v_2 - v_1) / r.r"""
    if plan.system.scope.model.space != "plane":
        return
    moving = {*plan.moving}
    members = [each for each in members_of(plan.system) if not moving.isdisjoint(each[2])]
    nodes = dict.fromkeys(node for _, _, ends in members for node in ends)
    flat = iter(plan.numbers([x for n in nodes for x in (*plan.raw_velocity((n, ZERO)), *plan.position((n, ZERO)))]))
    known = {n: [next(flat) for _ in range(6)] for n in nodes}
    for truss, member, (first, second) in members:
        change = [x - y for x, y in zip(known[second], known[first], strict=True)]
        if abs(sum(v * r for v, r in zip(change[:3], change[3:], strict=True))) <= ZERO_AT_50:
            v, position = plan.raw_velocity((first, ZERO)), plan.position((first, ZERO))
            apart = minus(plan.raw_velocity((second, ZERO)), v)
            along = minus(plan.position((second, ZERO)), position)
            spin: Vector = (0, 0, over(cross(along, apart)[2], dot(along, along)))
            moved = plus(v, cross(spin, minus(ZERO, position)))
            yield RigidBlock((), ((truss, member),), (), spin, (moved[0], moved[1], 0))


def _agree(one: Sequence[Any], other: Sequence[Any]) -> bool:
    return all(abs(x - y) < ZERO_AT_50 for x, y in zip(one, other, strict=True))


def _joined(plan: VelocityPlan, group: list[RigidBlock]) -> RigidBlock:
    bodies = tuple(name for part in group for name in part.bodies)
    members = tuple(member for part in group for member in part.members)
    spin, velocity = (vector_of(map(plan.simple, x)) for x in (group[0].spin, group[0].velocity))
    return RigidBlock(bodies, members, (), spin, velocity)


def _single_nodes(plan: VelocityPlan, blocks: list[RigidBlock]) -> list[RigidBlock]:
    """Moving nodes at the end of no moving member that keeps its length."""
    ends = {(truss, member): pair for truss, member, pair in members_of(plan.system)}
    carried = {node for block in blocks for member in block.members for node in ends[member]}
    alone = [name for name in plan.moving if is_node(name) and name not in carried]
    return [RigidBlock((), (), (name,), ZERO, plan.raw_velocity((name, ZERO))) for name in alone]
