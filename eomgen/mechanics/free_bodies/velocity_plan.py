"""Velocities of bodies -> Plan: velocities, spins and centres of rotation of the bodies that move as one."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import field, replace
from dataclasses import field as dataclass_field
from functools import cached_property, partial
from itertools import chain
from random import Random
from typing import Any

from eomgen.frozen import dataclass
from eomgen.mechanics.dynamics import System
from eomgen.mechanics.free_bodies.wrenches import Effect
from eomgen.mechanics.kinematics import VelocityField
from eomgen.model import BodyPoint, Couple, PointForce, SpreadLoad, is_node
from eomgen.symbolic.exact import Legibly, readable_all
from eomgen.symbolic.expression import Fraction, Matrix, Node, Scalar, Vector, is_zero, over, sqrt, substituted
from eomgen.symbolic.numeric import PiecewiseNodes, Work, evaluate, fifty_digits, has_pieces, tolerances
from eomgen.symbolic.print import to_text

# -------- velocity plan ---------------------------------------------------------------------------------------
# Velocities of all bodies at one configuration -> Plan: velocities of points, spins, centres of rotation, work.
#
# v(P) = v_C + w x r_CP,   power of a force F at P: F . v(P),   of a couple M: M . w, of a line load q: the integral
# of q(s) . v(s) ds


SIXTH = Fraction(1, 6)
_Displaced = tuple[str, Vector | None, Vector | None]
"""(where a load acts, displacement of that point, rotation of the body): of what it works on."""


@dataclass(frozen=True)
class PlanCenter:
    """The centre of rotation of a body in the plane.

    Args:
        place: its position; None: at infinity, the body translates, or everywhere, it is at rest.
        direction: of a translation, the velocity of all points; (0, 0, 0) at rest; None for a centre in sight.
    """

    place: Vector | None
    direction: Vector | None = None


@dataclass(frozen=True)
class VelocityPlan:
    """A field of velocities of rigid bodies, a velocity plan.

    Args:
        system: the system of the bodies.
        at: the configuration.
        parameters: values of 50 digits at which scalars are tested: generic ones, or the requested ones.
        velocities: of each body (velocity of the mass centre, spin) in the axes of its equations, 6.
        places: cache of the positions of points; plans of one structure share it.
        known: cache of the values of scalars; shared too.
    """

    system: System
    at: Mapping[Node, Scalar]
    parameters: Mapping[Node, Any]
    velocities: tuple[tuple[Scalar, ...], ...]
    places: dict[BodyPoint, Vector] = dataclass_field(default_factory=dict, compare=False, repr=False)
    known: dict[Scalar, Any] = dataclass_field(default_factory=dict, compare=False, repr=False)

    def scaled(self, k: Scalar) -> VelocityPlan:
        """The plan, k times as fast."""
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
        """Velocity of the mass centre, ground axes."""
        return self.simple.vector(self.field(body).v)

    def velocity(self, place: BodyPoint) -> Vector:
        """Velocity of a point of a body, ground axes; of the ground 0."""
        return self.simple.vector(self.raw_velocity(place))

    def raw_spin(self, body: str | None) -> Vector:
        """`spin`, not written out."""
        return Vector.ZERO if body is None else self.field(body).w

    def raw_velocity(self, place: BodyPoint) -> Vector:
        """`velocity`, not written out."""
        body, _ = place
        return Vector.ZERO if body is None else self.raw_velocity_at(body, self.position(place))

    def raw_velocity_at(self, body: str, position: Vector) -> Vector:
        """Velocity of the point of a body that is at a position in space, ground axes, not written out."""
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
        """Position of a point of a body in this configuration, ground axes."""
        if place not in self.places:
            self.places[place] = Vector(substituted(self.system.motion.position(place), self.at))
        return self.places[place]

    def mass_center(self, body: str) -> Vector:
        return self.position((body, self.system.scope.mass_properties(body).com))

    def center(self, field: VelocityField) -> PlanCenter:
        """The centre of rotation of a plane motion."""
        if self.vanishes(field.w):
            return PlanCenter(None, Vector.ZERO if self.vanishes(field.v) else self.simple.vector(field.v))
        return PlanCenter(self.simple.vector(field.rotation_center()))

    # -- work ----------------------------------------------------------------------------------------

    def work(self, load: PointForce | Couple | SpreadLoad) -> Scalar:
        """Power of a load on the bodies in this motion, its virtual work, not written out."""
        if isinstance(load, Couple):
            return self.force(load.couple, load.axes) @ self.raw_spin(load.body)
        if isinstance(load, PointForce):
            return self.force(load.force, load.axes) @ self.raw_velocity(load.place)
        return self._work_along(load)

    def _work_along(self, load: SpreadLoad) -> Scalar:
        """L/6 (2 q_A.v_A + q_A.v_B + q_B.v_A + 2 q_B.v_B): the integral of two linear functions of s."""
        a, b = self.raw_velocity(load.start), self.raw_velocity(load.end)
        along = self.position(load.end) - self.position(load.start)
        q_A, q_B = self.force(load.at_start), self.force(load.at_end)
        total = 2 * (q_A @ a) + q_A @ b + q_B @ a + 2 * (q_B @ b)
        return SIXTH * self.simple(sqrt(self.simple(along @ along))) * total

    def work_of_effects(self, effects: Sequence[Effect]) -> Scalar:
        """Power of forces and couples in the form of the bodies' equations, not written out."""
        total: Scalar = 0
        for effect in effects:
            pairs = zip(substituted(effect.six, self.at), self.velocities[effect.link], strict=True)
            total = total + sum((f * v for f, v in pairs), start=0)
        return total

    def displaced(self, load: PointForce | Couple | SpreadLoad) -> list[_Displaced]:
        """Points on which a load works: of a uniform line load the middle, where its resultant acts, else both ends."""
        if isinstance(load, Couple):
            return [(load.body, None, self.spin(load.body))]
        if isinstance(load, PointForce):
            return [(self.point_name(load.place), self.velocity(load.place), None)]
        a, b = (self.point_name(place) for place in (load.start, load.end))
        v, w = (self.velocity(place) for place in (load.start, load.end))
        if not _same(load.at_start, load.at_end):
            return [(a, v, None), (b, w, None)]
        return [(f"middle of {a}, {b}", Vector(map(self.simple, Fraction(1, 2) * (v + w))), None)]

    def point_name(self, place: BodyPoint) -> str:
        """A place by the name of the point of the body that is there."""
        body, r = place
        if body is None:
            return "the ground"
        if is_node(body):
            return body
        named = [name for name, at in self.system.motion.points[body].items() if _same(at, r)]
        given = [name for name in named if name not in ("origin", "center")]
        if given:
            return f"{body}.{given[0]}"
        return f"mass centre of {body}" if _same(self.system.scope.mass_properties(body).com, r) else body

    def force(self, vector: Vector, axes: str | None = None) -> Vector:
        """A vector of a load in this configuration, ground axes."""
        return Vector(substituted(self.system.motion.in_ground_axes(vector, axes), self.at))

    def vanishes(self, scalars: Sequence[Scalar], beside: Sequence[Scalar] = (1,)) -> bool:
        """True if all scalars are 0, compared with the largest of `beside`.

        A law in pieces may be 0 here and not elsewhere: any number stands for it, so that only what it does counts.
        """
        nodes = [x for x in scalars if type(x) is Node]
        if len(nodes) < len(scalars) and not all(is_zero(x) for x in scalars if type(x) is not Node):
            return False
        if not nodes:
            return True
        known = beside if not any(type(x) is Node for x in beside) else self.numbers(beside)
        size = max(map(abs, known), default=0)
        if any(abs(x) > tolerances.ZERO_AT_50 * size for x in self.numbers(nodes)):
            return False
        return not any(map(has_pieces, nodes)) or self._vanish_for_any_law(nodes, beside)

    def _vanish_for_any_law(self, nodes: Sequence[Node], beside: Sequence[Scalar]) -> bool:
        """True if scalars are 0 whatever the values of the functions in pieces that stand in them."""
        laws = PiecewiseNodes.all_of((*nodes, *beside))
        graph, number = self.system.scope.graph, fifty_digits().number
        any_value = {law: graph.symbol(f"(law {k})") for k, law in enumerate(laws)}
        rng = Random(1)
        parameters = dict(self.parameters) | {x: number(Fraction(rng.uniform(0.5, 2))) for x in any_value.values()}
        opaque = substituted((*nodes, *beside), any_value)
        values = evaluate(opaque, parameters, fifty_digits())
        size = max(map(abs, values[len(nodes) :]), default=0)
        return all(abs(x) <= tolerances.ZERO_AT_50 * size for x in values[: len(nodes)])

    def numbers(self, scalars: Sequence[Scalar]) -> list[Any]:
        """Values of scalars at these parameters, with 50 digits."""
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

    def _six(self, body: str) -> tuple[Scalar, ...]:
        return self.velocities[self.system.motion.index[body]]

    def _in_ground(self, body: str, components: Sequence[Scalar]) -> Vector:
        """Vector in ground axes of components in the axes of the body's equations."""
        vector = Vector(components)
        if self.system.scope.model.space == "plane":
            return vector
        R = substituted([x for row in self.system.motion.link(body).pose.R for x in row], self.at)
        rotation = (Vector(R[0:3]), Vector(R[3:6]), Vector(R[6:9]))
        return Matrix.of(rotation) @ vector

    @cached_property
    def blocks(self) -> tuple[RigidBlock, ...]:
        """The blocks that move, in the order of the model; what is in none of them stays at rest."""
        groups: list[_Group] = []
        for part in _bodies(self):
            group = next((g for g in groups if _agree(g.parts[0].numbers, part.numbers)), None)
            if group is None:
                groups.append(_Group([part]))
            else:
                group.parts.append(part)
        members = _moving_members(self)
        nodes = _nodes_of(self, members)
        for member in members:
            group = next((g for g in groups if all(g.carries(node, nodes(node)) for node in member[2])), None)
            if group is not None:
                group.parts.append(_member(self, member, ()))
            elif numbers := _numbers_of(*map(nodes, member[2])):
                groups.append(_Group([_member(self, member, numbers)]))
        blocks = [_joined(self, group.parts) for group in groups]
        return (*blocks, *_single_nodes(self, blocks))

    @property
    def numbered_blocks(self) -> dict[str, RigidBlock]:
        """{I: the first block that moves, II: the next, ...}, by the numerals of textbooks."""
        return {_numeral(k): block for k, block in enumerate(self.blocks, start=1)}

    @property
    def turning_by_one(self) -> Scalar:
        """1/w of the first block that turns about one axis; 1 where none does."""
        for part in chain(_bodies(self), _members(self)):
            turning = [k for k, w in enumerate(part.numbers[:3]) if abs(w) > tolerances.ZERO_AT_50]
            if len(turning) == 1:
                return self.simple(over(1, part.motion()[0][turning[0]]))
        return 1

    @property
    def resting_blocks(self) -> tuple[str, ...]:
        """Names of the bodies and trusses that are at rest."""
        links = self.system.motion.links
        bodies = tuple(link.name for link in links if link.name not in self.moving and not is_node(link.name))
        trusses = dict.fromkeys(link.name.partition(".")[0] for link in links if is_node(link.name))
        awake = {name.partition(".")[0] for name in self.moving if is_node(name)}
        return (*bodies, *(name for name in trusses if name not in awake))

    @property
    def in_words(self) -> str:
        """body 'AC' can turn about (4*a, 0), with it body 'CD' about (16*a, 0)"""
        (name, (verb, _, how)), *others = [(_named(block), _motion(self, block)) for block in self.blocks]
        following = [f"{other} {doing} {how}" for other, (_, doing, how) in others[:MOST_MOTIONS]]
        following += [f"{len(others) - MOST_MOTIONS} more blocks"] if len(others) > MOST_MOTIONS else []
        return f"{name} can {verb} {how}" + (f", with it {' and '.join(following)}" if following else "")


def _same(a: Vector, b: Vector) -> bool:
    return all(is_zero(x - y) for x, y in zip(a, b, strict=True))


# -------- blocks ----------------------------------------------------------------------------------------------
# Plan -> Blocks: the bodies and truss members that move as one rigid body, as a textbook numbers them.


Member = tuple[str, str, tuple[str, str]]
"""(truss, member, its two nodes)"""
NodeNumbers = Sequence[Any]
"""Of a node in the plane (v_x, v_y, x, y), with 50 digits."""


@dataclass(frozen=True)
class RigidBlock:
    """Parts that move as one rigid body.

    Args:
        bodies: their names.
        members: of trusses, (truss, "n1-n2").
        nodes: nodes of trusses without a member that moves with them: points.
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
        """Names of all parts of the block."""
        return (*self.bodies, *(f"{truss} {member}" for truss, member in self.members), *self.nodes)

    def center(self, plan: VelocityPlan) -> PlanCenter:
        """Its centre of rotation in the plane."""
        return plan.center(VelocityField(v=self.velocity, w=self.spin))


def _numeral(number: int) -> str:
    """Roman numeral: I, II, III, IV, ..."""
    text = ""
    for value, letters in ((10, "X"), (9, "IX"), (5, "V"), (4, "IV"), (1, "I")):
        text += letters * (number // value)
        number %= value
    return text


@dataclass(frozen=True)
class _Part:
    """A body or a member that moves, by itself.

    Args:
        numbers: its spin, and the velocity of its point at the ground's origin, 6, with 50 digits.
        motion: both in closed form, computed on request.
    """

    bodies: tuple[str, ...]
    members: tuple[tuple[str, str], ...]
    numbers: Sequence[Any]
    motion: Callable[[], tuple[Vector, ...]]


def _bodies(plan: VelocityPlan) -> Iterable[_Part]:
    """The bodies that are no nodes."""
    names = [name for name in plan.moving if not is_node(name)]
    motions = [(plan.raw_spin(name), plan.raw_velocity_at(name, Vector.ZERO)) for name in names]
    flat = iter(plan.numbers([x for motion in motions for three in motion for x in three]))
    for name, motion in zip(names, motions, strict=True):
        yield _Part((name,), (), [next(flat) for _ in range(6)], partial(tuple, motion))


@dataclass(frozen=True)
class _Group:
    """Group of parts that move as one.

    Args:
        parts: the first has the numbers of all.
        known: cache of the nodes tested: True if they move with the group.
    """

    parts: list[_Part]
    known: dict[str, bool] = field(default_factory=dict)

    def carries(self, node: str, moving: NodeNumbers) -> bool:
        """True if a node in the plane moves with the group: v = v_0 + w x r."""
        if node not in self.known:
            _, _, w, v_x, v_y, _ = self.parts[0].numbers
            vx, vy, x, y = moving
            self.known[node] = (
                abs(vx - v_x + w * y) < tolerances.ZERO_AT_50 and abs(vy - v_y - w * x) < tolerances.ZERO_AT_50
            )
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
    return [each for each in plan.system.scope.model.truss_members if not moving.isdisjoint(each[2])]


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
    """Spin and velocity of a member from its nodes, w = r x (v_2 - v_1) / r.r; () if its length changes."""
    (vx, vy, x, y), (wx, wy, x_2, y_2) = one, other
    ax, ay, dx, dy = wx - vx, wy - vy, x_2 - x, y_2 - y
    if abs(ax * dx + ay * dy) > tolerances.ZERO_AT_50:
        return ()
    w = (dx * ay - dy * ax) / (dx * dx + dy * dy) if ax or ay else 0
    return 0, 0, w, vx + w * y, vy - w * x, 0


def _of_node(plan: VelocityPlan, name: str) -> tuple[Scalar, ...]:
    """Velocity and place of a node in the plane."""
    return (*plan.raw_velocity((name, Vector.ZERO))[:2], *plan.position((name, Vector.ZERO))[:2])


def _of_ends(plan: VelocityPlan, ends: tuple[str, str]) -> tuple[Vector, Vector]:
    """The motion of a member by its nodes, in closed form."""
    (v, place), (v_2, place_2) = ((plan.raw_velocity((n, Vector.ZERO)), plan.position((n, Vector.ZERO))) for n in ends)
    along, apart = place_2 - place, v_2 - v
    spin = Vector((0, 0, over(along.cross(apart)[2], along @ along)))
    moved = v + spin.cross(Vector.ZERO - place)
    return spin, Vector((moved[0], moved[1], 0))


def _agree(one: Sequence[Any], other: Sequence[Any]) -> bool:
    return all(abs(x - y) < tolerances.ZERO_AT_50 for x, y in zip(one, other, strict=True))


def _joined(plan: VelocityPlan, group: list[_Part]) -> RigidBlock:
    bodies = tuple(name for part in group for name in part.bodies)
    members = tuple(member for part in group for member in part.members)
    spin, velocity = (Vector(map(plan.simple, x)) for x in group[0].motion())
    return RigidBlock(bodies, members, (), spin, velocity)


def _single_nodes(plan: VelocityPlan, blocks: list[RigidBlock]) -> list[RigidBlock]:
    """Moving nodes at the end of no moving member that keeps its length."""
    ends = {(truss, member): pair for truss, member, pair in plan.system.scope.model.truss_members}
    carried = {node for block in blocks for member in block.members for node in ends[member]}
    alone = [name for name in plan.moving if is_node(name) and name not in carried]
    return [RigidBlock((), (), (name,), Vector.ZERO, plan.raw_velocity((name, Vector.ZERO))) for name in alone]


# -------- motions in words ------------------------------------------------------------------------------------
# Plan -> in words, how bodies that nothing holds can move: "body 'CD' can turn about (2*a, 0)".


MOST_MOTIONS = 3  # that are described in words
MOST_NAMES = 6  # of parts that move together


def _named(block: RigidBlock) -> str:
    """Its bodies; of trusses its members, or its nodes."""
    members = [member for _, member in block.members]
    kinds: list[tuple[str, str, Sequence[str]]] = [
        ("body", "bodies", block.bodies),
        ("member", "members", members),
        ("node", "nodes", block.nodes),
    ]
    return " and ".join(_of_kind(one, many, names) for one, many, names in kinds if names)


def _of_kind(one: str, many: str, names: Sequence[str]) -> str:
    shown = ", ".join(f"'{name}'" for name in names[:MOST_NAMES])
    more = f" and {len(names) - MOST_NAMES} more" if len(names) > MOST_NAMES else ""
    return f"{one if len(names) == 1 else many} {shown}{more}"


def _motion(plan: VelocityPlan, block: RigidBlock) -> tuple[str, str, str]:
    """(slide, sliding, along x), (turn, turning, about (a, 0))"""
    if plan.vanishes(block.spin):
        return "slide", "sliding", f"along {_direction(plan, Vector(map(plan.simple, block.velocity)))}"
    place = block.center(plan).place if plan.system.scope.model.space == "plane" else None
    return "turn", "turning", _screw(plan, block) if place is None else f"about {_tuple(place[:2])}"


def _screw(plan: VelocityPlan, block: RigidBlock) -> str:
    """Description of a screw motion in space: the axis through w x v_O / w.w along w, and the advance along it."""
    w, v = block.spin, block.velocity
    square = w @ w
    place = tuple(plan.simple(over(x, square)) for x in w.cross(v))
    turning = f"about the axis through {_tuple(place)} along {_direction(plan, w)}"
    return turning if plan.vanishes((w @ v,)) else f"{turning}, advancing along it"


def _direction(plan: VelocityPlan, vector: Vector) -> str:
    """x, y, z, or the components against the first that is not 0."""
    kept = [k for k in range(3) if not plan.vanishes((vector[k],))]
    if len(kept) == 1:
        return "xyz"[kept[0]]
    ratio = over(1, vector[kept[0]]) * vector
    size = 2 if plan.system.scope.model.space == "plane" else 3
    return _tuple([plan.simple(x) if k in kept else 0 for k, x in enumerate(ratio)][:size])


def _tuple(scalars: Iterable[Scalar]) -> str:
    return f"({', '.join(to_text(x) for x in scalars)})"
