"""Structure, a reaction or inner force -> InfluenceLine: its value for a unit load that travels along the bodies.

The constraint that belongs to the force X is released; in the motion that is left, with a displacement 1 along X,

    X * 1 + e . v(P) = 0,   X(P) = -e . v(P)

for a unit load e at P: the influence line is the velocity plan of the mechanism, straight on every straight part of a
body. For the force in a section the section is released (`section_release`).
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from itertools import pairwise
from typing import TypeVar

from eomgen.errors import DerivationError, ExpressionError, UsageError
from eomgen.frozen import dataclass
from eomgen.mechanics.free_bodies import Effect, NamedReaction, Structure, VelocityPlan
from eomgen.mechanics.statics.forces_in_sections import SectionForces, place_of
from eomgen.mechanics.statics.member_axis import MemberAxis, Sizes, axis_of, sizes_of
from eomgen.mechanics.statics.virtual_work import argument_name, name_of
from eomgen.model import is_node, nearest
from eomgen.symbolic.exact import vanishes
from eomgen.symbolic.expression import Call, Reference, Scalar, Vector, is_zero, parse, substituted
from eomgen.symbolic.print import to_text

Thing = TypeVar("Thing")
LoadPoint = tuple[str, Vector]
DOWN: Vector = Vector((0, -1, 0))


@dataclass(frozen=True)
class InfluenceSpan:
    """A straight part of the way of the load, on which the influence line is straight.

    Args:
        name: of the body, or of the two nodes: "T.n1-n2"; "T.n5-U.n1" of two trusses.
        start, end: ground axes [m].
        at_start, at_end: of the influence line.
    """

    name: str
    start: Vector
    end: Vector
    at_start: Scalar
    at_end: Scalar


@dataclass(frozen=True)
class InfluenceLine:
    """X for a unit load that travels along the spans.

    Args:
        name: of X, as an output writes it.
        load: the unit load.
        plan: the motion of the released structure; of a cut body, that of the part behind the section.
        cut: the section, None for a reaction.
        spans: one after the other; where one ends and the next begins at the same place the line may jump.
    """

    name: str
    load: Vector
    plan: VelocityPlan
    cut: Cut | None
    spans: tuple[InfluenceSpan, ...]

    @staticmethod
    def of(structure: Structure, requested: str, load: Vector = DOWN) -> InfluenceLine:
        """The influence line of a reaction, a member force or a section force.

        Args:
            requested: as an output writes it: "reaction_y(A)", "tension(T, n1-n2)", "bending_moment(beam, a)". After a
                colon the bodies or nodes that the load passes: "reaction_y(A): I, II"; without them all horizontal
                bodies, else all that are not vertical; of a truss the lowest nodes.
            load: the unit load, ground axes.
        Raises:
            UsageError: there is no such force, or no way for the load.
            DerivationError: it is statically indeterminate.
        """
        if structure.system.scope.model.space != "plane":
            raise UsageError("influence lines are found in the plane", fix="put the load at each place, as a force")
        requested, along = _way(requested)
        call = _call(requested)
        sizes = sizes_of(structure.system.motion, structure.at)
        if call.name in SectionForces.KINDS:
            cut = cut_of(structure, call, sizes)
            plan = structure.released(left_powers(structure, cut))
        else:
            cut, plan = None, structure.released(_combination(structure, call))
        line = _Travelling(structure, plan, cut, load, sizes)
        spans = tuple(line.spans(along))
        return InfluenceLine(str(call), load, plan, cut, spans)


def _way(text: str) -> tuple[str, tuple[str, ...]]:
    """(the requested force, the bodies or nodes that the load passes), of "reaction_y(A): I, II"."""
    requested, _, way = text.partition(":")
    return requested.strip(), tuple(name.strip() for name in way.split(",") if name.strip())


def _call(requested: str) -> Call:
    try:
        call = parse(requested, references=True).call
    except ExpressionError as error:
        raise UsageError(f"influence line: '{requested}': {error.what}", fix=error.fix) from error
    if call is None:
        raise UsageError(f"influence line: '{requested}' is not one force", fix='write, for example, "reaction_y(A)"')
    return call


def _combination(structure: Structure, call: Call) -> dict[int, Scalar]:
    """The reaction as a sum of components."""
    table = {n.name: n for n in NamedReaction.all_of(structure.balance)}
    name = name_of(call, table)
    if name not in table:
        listed = nearest(name, table) or f"there are {', '.join(table)}"
        raise UsageError(f"influence line: there is no reaction '{name}'", fix=listed)
    combination = table[name].combination
    factors = substituted(tuple(combination.values()), structure.at)
    return dict(zip(combination, factors, strict=True))


# -- the way of the load -----------------------------------------------------------------------------


@dataclass(frozen=True)
class _Travelling:
    """A unit load on its way over the moving bodies."""

    structure: Structure
    plan: VelocityPlan
    cut: Cut | None
    load: Vector
    sizes: Sizes

    def spans(self, along: Sequence[str]) -> Iterable[InfluenceSpan]:
        """Spans that the load passes, one after the other."""
        motion = self.structure.system.motion
        unknown = [name for name in along if name not in motion.index]
        if unknown:
            what = f"influence line: there is no body or node '{unknown[0]}' for the load"
            raise UsageError(what, fix=nearest(unknown[0], motion.index))
        if along and all(is_node(name) for name in along):
            return self._over_nodes(along)
        spans = list(self._over_bodies(along)) if along else self._chosen()
        if not spans:
            raise UsageError(
                "influence line: there is no way for the load",
                fix='name the bodies or nodes that it passes: "reaction_y(A): I, II"',
            )
        return spans

    def _chosen(self) -> Sequence[InfluenceSpan]:
        """Spans that the load passes: the horizontal ones, else those not vertical; of a truss the lowest nodes."""
        links = self.structure.system.motion.links
        spans = list(self._over_bodies([link.name for link in links if not is_node(link.name)], skip=True))
        level = [s for s in spans if self._is_zero(s.end[1] - s.start[1])]
        across = level or [s for s in spans if not self._is_zero(s.end[0] - s.start[0])]
        if across:
            return self._in_order(across, lambda span: self.sizes.simple(span.start[0] + span.end[0]))
        nodes = [link.name for link in links if is_node(link.name)]
        return list(self._over_nodes(self._lowest(nodes))) if nodes else []

    def _lowest(self, nodes: Sequence[str]) -> list[str]:
        positions = {node: self._position((node, Vector.ZERO)) for node in nodes}
        floor = positions[nodes[0]][1]
        for x in positions.values():
            floor = x[1] if self.sizes.sign(x[1] - floor) < 0 else floor
        lowest = [node for node in nodes if self.sizes.sign(positions[node][1] - floor) == 0]
        return self._in_order(lowest, lambda node: positions[node][0])

    def _in_order(self, things: Sequence[Thing], key: Callable[[Thing], Scalar]) -> list[Thing]:
        found: list[Thing] = []
        for thing in things:
            k = len(found)
            while k and self.sizes.sign(key(found[k - 1]) - key(thing)) > 0:
                k -= 1
            found.insert(k, thing)
        return found

    def _over_nodes(self, nodes: Sequence[str]) -> Iterable[InfluenceSpan]:
        for a, b in pairwise(nodes):
            truss, _, node = b.partition(".")
            yield self._span(f"{a}-{node if a.startswith(f'{truss}.') else b}", (a, Vector.ZERO), (b, Vector.ZERO))

    def _over_bodies(self, bodies: Sequence[str], *, skip: bool = False) -> Iterable[InfluenceSpan]:
        for body in bodies:
            try:
                axis = loaded_axis(self.structure, body, self.sizes)
            except DerivationError:
                if skip:
                    continue
                raise
            yield from self._over(axis)

    def _over(self, axis: MemberAxis) -> Iterable[InfluenceSpan]:
        """The legs of one body, that with the section in two."""
        cut = None if self.cut is None or self.cut.axis.body != axis.body else self.cut
        for k, leg in enumerate(axis.legs):
            first = axis.ends[0] if k == 0 else leg.x
            last = axis.ends[1] if k == len(axis.legs) - 1 else self.sizes.simple(leg.x + leg.length)
            stops = [first, last]
            if cut is not None and self.sizes.sign(cut.x - first) > 0 and self.sizes.sign(last - cut.x) > 0:
                stops = [first, cut.x, last]
            for a, b in pairwise(stops):
                before = cut is not None and self.sizes.sign(cut.x - b) >= 0
                yield self._span(axis.body, (axis.body, leg.place(a)), (axis.body, leg.place(b)), before=before)

    def _span(self, name: str, a: LoadPoint, b: LoadPoint, *, before: bool = False) -> InfluenceSpan:
        return InfluenceSpan(name, self._position(a), self._position(b), self._value(a, before), self._value(b, before))

    def _value(self, place: LoadPoint, before: bool) -> Scalar:
        """-e . v(P)"""
        v = self.plan.velocity(place)
        if before and self.cut is not None:
            v = v + self.cut.velocity(self._position(place))
        return self.sizes.shortest(-(self.load @ v))

    def _position(self, place: LoadPoint) -> Vector:
        found = substituted(self.structure.system.motion.position(place), self.structure.at)
        return Vector(self.sizes.simple(x) for x in found)

    def _is_zero(self, x: Scalar) -> bool:
        return vanishes(self.sizes.simple(x))


# -------- section release -------------------------------------------------------------------------------------
# Structure, a section of a body -> Cut: how the two parts move against each other when the section is released.
#
# N shifts them along the axis, V across it, M turns them about the section. With w on the part before the section all
# other reactions do no work, so that the motion v of the bodies follows from
#
#     G^T v = -(power of each reaction on the part before the section in the motion w)
#
# and the part before it moves by v + w.


@dataclass(frozen=True)
class Cut:
    """A section that was released.

    Args:
        axis: of the body.
        x: where it is.
        before: whether the place of an effect, x along the axis, belongs to the part before it.
        shift: velocity of the part before the section against the part behind, at the section, ground axes.
        spin: angular velocity of the one part against the other, counter-clockwise.
        place: of the section, ground axes.
    """

    axis: MemberAxis
    x: Scalar
    before: Callable[[Scalar], bool]
    shift: Vector
    spin: Scalar
    place: Vector

    def velocity(self, position: Vector) -> Vector:
        """w of a place of the part before the section."""
        return self.shift + Vector((0, 0, self.spin)).cross(position - self.place)


def cut_of(structure: Structure, call: Call, sizes: Sizes) -> Cut:
    """The released section: N shifts along t, V across, -n, M turns by 1."""
    if not 2 <= len(call.args) <= 3:
        raise UsageError(
            f"influence line: {call}: a body and a place along it are needed", fix=f'write "{call.name}(body, x)"'
        )
    body, where, *side = call.args
    motion, names = structure.system.motion, structure.system.scope.names
    name = argument_name(body)
    if name not in motion.index or is_node(name):
        raise UsageError(f"influence line: {call}: there is no body '{name}'", fix=nearest(name, motion.index))
    axis = loaded_axis(structure, name, sizes)
    x = sizes.simple((parse(where.name) if isinstance(where, Reference) else where).evaluate(names))
    leg = next((leg for leg in reversed(axis.legs) if sizes.sign(x - leg.x) >= 0), axis.legs[0])
    if sizes.sign(x - axis.ends[0]) < 0 or sizes.sign(axis.ends[1] - x) < 0:
        raise UsageError(
            f"influence line: {call}: the section is beyond the ends of the body", fix="ask at a place of the body"
        )
    R = motion.link(name).pose.R
    t, n = (Vector(substituted(R @ v, structure.at)) for v in (leg.along, leg.left))
    place = Vector(substituted(motion.position((name, leg.place(x))), structure.at))
    shift = {"axial_force": t, "shear_force": -n, "bending_moment": Vector.ZERO}[call.name]
    at_end = sizes.sign(axis.ends[1] - x) == 0
    here = 1 if (argument_name(side[0]) if side else "before" if at_end else "after") == "before" else 0
    inside = not at_end and sizes.sign(x - axis.ends[0]) != 0
    if inside and not side and call.name != "bending_moment" and _is_pushed(structure, axis, x, name):
        requested = f"{call.name}({name}, {to_text(x)}"
        raise UsageError(
            f"influence line: {requested}) jumps there", fix=f"write {requested}, before) or {requested}, after)"
        )
    return Cut(axis, x, lambda s: sizes.sign(x - s) >= here, shift, int(call.name == "bending_moment"), place)


def _is_pushed(structure: Structure, axis: MemberAxis, x: Scalar, body: str) -> bool:
    """True if a reaction acts at the section."""
    link = structure.system.motion.index[body]
    places = (e.place for _, effects in structure.pushes for e in effects if e.link == link and e.place is not None)
    distances = (axis.distance(place) for place in places)
    return any(s is not None and axis.sizes.sign(x - s) == 0 for s in distances)


def left_powers(structure: Structure, cut: Cut) -> dict[int, Scalar]:
    """Minus the power of each reaction and unknown load on the part before the section in the motion w."""
    found: dict[int, Scalar] = {}
    link = structure.system.motion.index[cut.axis.body]
    for j, (owner, effects) in enumerate(structure.pushes):
        power = sum((_power(structure, cut, e, owner) for e in effects if e.link == link), start=0)
        if not is_zero(power):
            found[j] = -power
    return found


def _power(structure: Structure, cut: Cut, effect: Effect, owner: str) -> Scalar:
    place = place_of(structure.components, effect, owner)
    s = None if place is None else cut.axis.distance(place)
    if place is None or s is None:
        raise DerivationError(
            f"'{owner}' acts on '{cut.axis.body}' off its axis: it has no section forces",
            f"bodies.{cut.axis.body}",
            fix="let it act at a point of the axis",
        )
    if not cut.before(s):
        return 0
    position = structure.system.motion.position((cut.axis.body, place))
    power = effect.force @ cut.velocity(position) + effect.couple[2] * cut.spin
    return cut.axis.sizes.simple(substituted((power,), structure.at)[0])


def loaded_axis(structure: Structure, body: str, sizes: Sizes) -> MemberAxis:
    """The axis of a body, as far as reactions act on it."""
    motion = structure.system.motion
    link = motion.index[body]
    acting = [e.place for _, effects in structure.pushes for e in effects if e.link == link and e.place is not None]
    return axis_of(motion, body, acting, sizes)
