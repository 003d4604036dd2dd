"""System, velocities -> Mechanism: centres of rotation of every body and of every pair in the plane.

Every body has the homogeneous centre c = (-v_0y : v_0x : w) of its velocity field (`centers`); a pair has
c_ij = c_j - c_i. Bodies that move as one are one block; those at rest belong to the ground's.
"""

from __future__ import annotations

from collections.abc import Container, Iterable, Iterator, Mapping
from functools import cached_property
from itertools import combinations

from eomgen.frozen import dataclass
from eomgen.mechanics.constraints import holds_identically
from eomgen.mechanics.dynamics import System
from eomgen.mechanics.free_bodies import Axes, Component
from eomgen.mechanics.instant.motion_kind import Homogeneous, homogeneous_center
from eomgen.mechanics.start import ScalarValues
from eomgen.model import is_node
from eomgen.symbolic.exact import Legibly
from eomgen.symbolic.expression import Node, Scalar, Vector, is_zero, over, substituted
from eomgen.symbolic.numeric import Work


@dataclass(frozen=True)
class RotationCenter:
    """The centre of rotation of a pair of blocks.

    Args:
        pair: the names of the blocks; the first is "0" for an absolute centre.
        point: homogeneous: (x, y, 1), or (dx, dy, 0) at infinity in this direction.
    """

    pair: tuple[str, str]
    point: Homogeneous

    @property
    def at_infinity(self) -> bool:
        return type(self.point[2]) is int and self.point[2] == 0

    @property
    def name(self) -> str:
        return f"({self.pair[0]}, {self.pair[1]})"


@dataclass(frozen=True)
class Mechanism:
    """Rigid bodies in motion in the plane, at one configuration.

    Args:
        system: the system of the bodies.
        moving: values of coordinates, speeds, time and inputs.
        values: values of scalars at the model's parameters.
    """

    FIXED = "0"
    """Name of the ground among the bodies."""

    system: System
    moving: Mapping[Node, Scalar]
    values: ScalarValues

    # -- bodies that move as one -------------------------------------------------------------------

    @cached_property
    def blocks(self) -> dict[str, tuple[str, ...]]:
        """The bodies by the block in which they move, the ground's first; a block has the name of its first body."""
        found: dict[str, list[str]] = {Mechanism.FIXED: []}
        for body in self.fields:
            home = next((block for block in found if self.is_zero(self._apart(block, body))), None)
            found.setdefault(body if home is None else home, []).append(body)
        return {name: tuple(bodies) for name, bodies in found.items()}

    @cached_property
    def fields(self) -> dict[str, Homogeneous]:
        """The homogeneous centre of every body; nodes of trusses left out."""
        motion = self.system.motion
        bodies = [link for link in motion.links if not is_node(link.name)]
        return {
            link.name: self._simple.vector(homogeneous_center(motion.field(link.name).at(self.moving)))
            for link in bodies
        }

    def _apart(self, block: str, body: str) -> Homogeneous:
        return self.fields[body] - (Vector.ZERO if block == Mechanism.FIXED else self.fields[block])

    def block_of(self, body: str | None) -> str:
        """The block of a body; of the ground (None), and of a point, its own name or "0"."""
        if body is None:
            return Mechanism.FIXED
        return next((name for name, bodies in self.blocks.items() if body in bodies), body)

    @property
    def moved(self) -> tuple[str, ...]:
        """The blocks that move."""
        return tuple(name for name in self.blocks if name != Mechanism.FIXED)

    # -- centres -----------------------------------------------------------------------------------

    @cached_property
    def centers(self) -> dict[tuple[str, str], RotationCenter]:
        """Centre of rotation of every pair of blocks; absolute ones first."""
        return {pair: self._center(pair) for pair in combinations(self.blocks, 2)}

    def _center(self, pair: tuple[str, str]) -> RotationCenter:
        return RotationCenter(pair, self.normal(self._simple.vector(self._apart(pair[0], pair[1]))))

    def normal(self, c: Homogeneous) -> Homogeneous:
        """A homogeneous point as (x, y, 1), or as (1, dy, 0) or (0, 1, 0) at infinity."""
        k = next(k for k in (2, 0, 1) if not self.is_zero((c[k],)))
        x, y = (self._simple(over(c[i], c[k])) for i in (0, 1))
        return Vector((x, y, 1) if k == 2 else (1, y, 0) if k == 0 else (0, 1, 0))

    # -- helpers -----------------------------------------------------------------------------------

    def is_zero(self, scalars: Iterable[Scalar]) -> bool:
        """True if all scalars are zero at this configuration."""
        return self.values.vanish(scalars)

    @cached_property
    def _simple(self) -> Legibly:
        return Legibly(Work.ANSWER, self.system.scope.positive)


# -------- construction ----------------------------------------------------------------------------------------
# Mechanism -> Found: how a drawing finds its centres of rotation, one after the other, as two lines that meet.
#
# A constraint between two bodies that pushes along a line lets them turn about points of that line only: the power of a
# force (f_x, f_y) with moment tau about the origin is l . c with l = (-f_y : f_x : tau), so the centre c is on l. A
# pure couple is the line at infinity. And of three bodies the three centres are on one line (Aronhold, Kennedy). All
# is projective: lines may meet at infinity.


PointPair = tuple[str, str]
POINT = "point"
"""The kind of line of a body that is a point, and does not turn."""
PUSHES = {
    "n": "the normal through '{}'",
    "tension": "the line of '{}'",
    "t": "the line of contact of '{}'",
    "couple": "the line at infinity, as '{}' lets nothing turn",
    "point": "the line at infinity, as '{}' is a point that does not turn",
}


@dataclass(frozen=True)
class LineOf:
    """A line on which a centre is.

    Args:
        line: homogeneous.
        owner: the constraint or joint that makes it, "" where it joins two centres.
        kind: of the component: "x", "y", "n", "tension", "couple", ...
        through: the two centres that it joins.
    """

    line: Vector
    owner: str = ""
    kind: str = ""
    through: tuple[PointPair, PointPair] | None = None

    @property
    def in_words(self) -> str:
        """in line with (0, 1) and (1, 2), on the normal through 'A'"""
        if self.through is not None:
            return "in line with " + " and ".join(f"({i}, {j})" for i, j in self.through)
        return "on " + PUSHES.get(self.kind.split(" ")[0], "the line of the force of '{}'").format(self.owner)


@dataclass(frozen=True)
class FoundPoint:
    """A centre that two lines give, or two others that are at one place.

    Args:
        pair: of blocks.
        point: where it is, (x, y, 1) or (dx, dy, 0).
        lines: the two that meet there; () where it coincides with others.
        agrees: it is the one of the velocities.
        same: the two centres at this place, which the pair has with one and the same third body.
    """

    pair: PointPair
    point: Vector
    lines: tuple[LineOf, ...]
    agrees: bool
    same: tuple[PointPair, ...] = ()

    @property
    def hinge(self) -> str:
        """The one constraint or joint that holds the point; "" where two lines of different origin meet."""
        owners = {line.owner for line in self.lines}
        plain = all(line.kind != "couple" for line in self.lines)
        return owners.pop() if len(owners) == 1 and plain and self.lines[0].owner else ""

    def in_words(self, constraints: Container[str]) -> str:
        """Reason why the centre is there.

        Args:
            constraints: the names of constraints; any other owner of a line is a body, by its joint.
        """

        def called(owner: str) -> str:
            return f"'{owner}'" if owner in constraints else f"the joint of '{owner}'"

        if self.same:
            return " and ".join(f"({i}, {j})" for i, j in self.same) + " are at one point"
        if self.hinge and not is_zero(self.point[2]):
            return f"{called(self.hinge)} holds the point"
        owners = [line.owner for line in self.lines]
        if owners[0] and owners[0] == owners[1]:
            return f"{called(owners[0])} only lets slide"
        return "; ".join(line.in_words for line in self.lines)


def constructed(mechanism: Mechanism) -> tuple[FoundPoint, ...]:
    """The centres that lines give, each from those before it; those that need the velocities are left out."""
    return tuple(_Search(mechanism).run())


@dataclass(frozen=True)
class _Search:
    """The search; points that are found are looked up in numbers first."""

    mechanism: Mechanism

    def run(self) -> Iterator[FoundPoint]:
        known: dict[PointPair, Vector] = {}
        fresh = True
        while fresh:
            fresh = False
            for pair in self.mechanism.centers:
                if pair in known:
                    continue
                found = self._meeting(pair, known)
                if found is not None:
                    known[pair] = found.point
                    fresh = True
                    yield found

    def _meeting(self, pair: PointPair, known: dict[PointPair, Vector]) -> FoundPoint | None:
        """The first two different lines on which the centre of a pair is, or two centres that coincide."""
        field = self.mechanism.centers[pair].point
        for first_pair, second_pair in self._with_a_third(pair, known):
            if self.mechanism.is_zero(known[first_pair].cross(known[second_pair])):
                point = known[first_pair]
                return FoundPoint(
                    pair, point, (), self.mechanism.is_zero(point.cross(field)), (first_pair, second_pair)
                )
        lines = [*self.own_lines.get(pair, ()), *self._in_line(pair, known)]
        for first, second in combinations(lines, 2):
            point = first.line.cross(second.line)
            if not self.mechanism.is_zero(point):
                point = self.mechanism.normal(point)
                return FoundPoint(pair, point, (first, second), self.mechanism.is_zero(point.cross(field)))
        return None

    def _in_line(self, pair: PointPair, known: dict[PointPair, Vector]) -> Iterator[LineOf]:
        """The lines through the centres that the two have with a third body."""
        for first, second in self._with_a_third(pair, known):
            line = known[first].cross(known[second])
            if not self.mechanism.is_zero(line):
                yield LineOf(line, through=(first, second))

    def _with_a_third(self, pair: PointPair, known: dict[PointPair, Vector]) -> Iterator[tuple[PointPair, PointPair]]:
        """The centres that both have with a third body, where they are known."""
        for k in self.mechanism.blocks:
            if k not in pair:
                first, second = self._ordered(pair[0], k), self._ordered(pair[1], k)
                if first in known and second in known:
                    yield first, second

    def _ordered(self, i: str, j: str) -> PointPair:
        order = list(self.mechanism.blocks)
        return (i, j) if order.index(i) < order.index(j) else (j, i)

    @cached_property
    def own_lines(self) -> dict[PointPair, list[LineOf]]:
        """The lines along which constraints and joints push two blocks."""
        found: dict[PointPair, list[LineOf]] = {}
        axes = Axes(self.mechanism.system.motion)
        for component in axes.components_of(self.mechanism.system):
            if component.kind == "drive" or self._wanders(component):
                continue
            pair, line = self._line(axes, component)
            if pair is not None:
                found.setdefault(pair, []).append(LineOf(line, component.owner, component.label))
        for name in self.mechanism.moved:
            if self._is_point(name):
                found.setdefault(("0", name), []).append(LineOf(Vector((0, 0, 1)), name, POINT))
        return found

    def _wanders(self, component: Component) -> bool:
        """True if the line of action of a component says nothing of velocities, as no point of the body is held.

        So it is where the seat of a joint, or a point that a constraint names, moves in its body as prescribed, or a
        constraint depends directly on rates of other quantities than the motion of the bodies.
        """
        motion = self.mechanism.system.motion
        if component.kind == "joint":
            link = motion.link(component.owner)
            return motion.moves((*link.before.p, *link.point))
        rows = [row for row in self.mechanism.system.constraints.rows if row.constraint == component.owner]
        if any(row.number == component.number and not holds_identically(row.direct) for row in rows):
            return True
        constraint = motion.scope.model.constraints.get(component.owner)
        if constraint is None:  # a joint that sticks
            return False
        points = (leaf.value for leaf in constraint.leaves(()) if getattr(leaf.rule, "of", "") == "point")
        return any(motion.moves(motion.place(point)[1]) for point in points)

    def _is_point(self, block: str) -> bool:
        """True for a point mass without a spin: as a body it translates."""
        link = self.mechanism.system.motion.link(block)
        return self.mechanism.system.motion.is_particle(link) and all(is_zero(x) for x in link.twist.w)

    def _line(self, axes: Axes, component: Component) -> tuple[PointPair | None, Vector]:
        """The two blocks on which it pushes with opposite wrenches, and the line; None where there are no such two."""
        wrenches: dict[str, Vector] = {}
        for effect in component.effects:
            motion = axes.motion
            place = motion.position((motion.links[effect.link].name, axes.masses[effect.link].com)) + effect.arm
            moment = (effect.couple + place.cross(effect.force))[2]
            block = self.mechanism.block_of(motion.links[effect.link].name)
            wrench = Vector((-effect.force[1], effect.force[0], moment))
            wrenches[block] = wrenches[block] + wrench if block in wrenches else wrench
        here = {block: Vector(substituted(w, self.mechanism.moving)) for block, w in wrenches.items()}
        pushed = [block for block, w in here.items() if not self.mechanism.is_zero(w) and block != "0"]
        if not pushed or any(block not in self.mechanism.blocks for block in pushed):
            return None, Vector.ZERO
        if len(pushed) == 1:
            return ("0", pushed[0]), here[pushed[0]]
        opposite = len(pushed) == 2 and self.mechanism.is_zero(here[pushed[0]] + here[pushed[1]])
        return (self._ordered(pushed[0], pushed[1]) if opposite else None), here[pushed[0]]
