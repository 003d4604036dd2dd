"""A section force that is asked -> the beam cut there: what acts on the part before it and on the part after.

Line loads are cut, too: of each part the resultant of what stands on it.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import replace

from eomgen.errors import DerivationError
from eomgen.judge.acting import ActingForce, PlacedPush, resultant
from eomgen.judge.free_bodies import CutBalance
from eomgen.mechanics.bodies.kinematics import BodyLink
from eomgen.mechanics.instant.outputs import Quantities
from eomgen.mechanics.statics.member_axis import MemberAxis
from eomgen.mechanics.statics.section_forces import KINDS
from eomgen.model.forces.load import SpreadLoad
from eomgen.model.outputs.base import name_at
from eomgen.model.outputs.section_forces import distance_of
from eomgen.records import dataclass
from eomgen.symbolic.expression.expressions import Call
from eomgen.symbolic.expression.functions import over
from eomgen.symbolic.expression.graph import Node, Scalar
from eomgen.symbolic.expression.rational import Fraction
from eomgen.symbolic.expression.spatial import (
    ZERO,
    Vector,
    apply,
    minus,
    plus,
    times,
    transposed,
)

SIXTH = Fraction(1, 6)


@dataclass(frozen=True)
class CutBeam:
    """A beam, cut.

    Args:
        acting: the section forces, and all that acts, on the two parts as well.
        cuts: the balances of both.
        true: what the section forces are.
    """

    acting: tuple[ActingForce, ...]
    cuts: tuple[CutBalance, ...]
    true: dict[Node, Scalar]


def cut_beam(quantities: Quantities, call: Call, acting: Sequence[ActingForce], part: int) -> CutBeam:
    """The beam cut where a section force is asked.

    Args:
        part: the index of the part before the section; that after it has the next one.
    Raises:
        DerivationError: something acts off its axis or at no place, or what it weighs is spread along it.
    """
    body, side = name_at(call, 0), name_at(call, 2) if len(call.args) > 2 else ""
    section, x = quantities.section(body), distance_of(call).evaluate(quantities.names)
    axis, motion = section.axis, quantities.system.motion
    i, link = motion.index[body], motion.link(body)
    leg = [leg for leg in axis.legs if leg.x == 0 or axis.sizes.sign(x - leg.x) >= 0][-1]
    place, t, n = link.pose.point(leg.place(x)), apply(link.pose.R, leg.along), apply(link.pose.R, leg.left)
    found, true = list[ActingForce](), dict[Node, Scalar]()
    for kind, e in zip(KINDS, (t, times(-1, n), ZERO), strict=True):
        name = str(replace(call, name=kind))
        symbol = quantities.system.scope.graph.symbol(name)
        true[symbol] = section.value(kind, x, side or ("before" if kind != "bending_moment" else ""))
        couple = symbol if kind == "bending_moment" else 0
        pushes = (
            PlacedPush(i, times(k, times(symbol, e)), k * couple, place, times(k, e), p)
            for k, p in ((1, part), (-1, part + 1))
        )
        found.append(ActingForce(f"the {kind.replace('_', ' ')} {name}", tuple(pushes), body, symbol, kind="reaction"))
    cutting = _Cutting(link, axis, x, side, part)
    for each in acting:
        found.append(replace(each, pushes=(*each.pushes, *cutting.pushes(each, i))))
    ways = (
        ("forces along the beam at the section", t, None),
        ("forces across the beam at the section", n, None),
        ("moments about the section", None, place),
    )
    cuts = tuple(
        CutBalance(frozenset((p,)), f"the balance of {told} of {body} (the part {of} it)", along, about)
        for p, of in ((part, "before"), (part + 1, "after"))
        for told, along, about in ways
    )
    return CutBeam(tuple(found), cuts, true)


@dataclass(frozen=True)
class _Cutting:
    """On which part of a beam something acts."""

    link: BodyLink
    axis: MemberAxis
    x: Scalar
    side: str
    part: int

    def pushes(self, acting: ActingForce, body: int) -> Iterator[PlacedPush]:
        """What it does to the parts."""
        mine = [push for push in acting.pushes if push.part == body]
        if mine and (acting.kind == "inertia" or acting.name.startswith("the weight")):
            raise DerivationError("what a beam weighs is spread along it")
        if mine and acting.spread:
            for part in (self.part, self.part + 1):
                lines = [push for line in acting.spread for push in self._of_line(line, body, part)]
                yield from resultant(tuple(lines)) if lines else ()
            return
        for push in mine:
            if push.place is None:
                raise DerivationError("a couple acts at no place")
            where = apply(transposed(self.link.pose.R), minus(push.place, self.link.pose.p))
            after = self.axis.sizes.sign(self._far(where) - self.x) >= (1 if self.side == "after" else 0)
            yield replace(push, part=self.part + after)

    def _far(self, where: Vector) -> Scalar:
        """Where a place of the body is along the beam."""
        far = self.axis.distance(where)
        if far is None:
            raise DerivationError("something acts off the axis")
        return far

    def _of_line(self, line: SpreadLoad, body: int, part: int) -> Iterator[PlacedPush]:
        """A line load on one part, as forces at the ends of what stands there: L (2 q_1 + q_2)/6, L (q_1 + 2 q_2)/6."""
        sizes, wanted = self.axis.sizes, 1 if part == self.part else -1
        ends = [(self._far(r), r, q) for (_, r), q in ((line.start, line.at_start), (line.end, line.at_end))]
        sides = [sizes.sign(self.x - far) for far, _, _ in ends]
        if wanted not in sides:
            return
        if -wanted in sides:
            (x_1, a, q_1), (x_2, b, q_2) = ends
            f = over(self.x - x_1, x_2 - x_1)
            between = (plus(times(1 - f, u), times(f, v)) for u, v in ((a, b), (q_1, q_2)))
            ends[sides.index(-wanted)] = (self.x, next(between), next(between))
        length = sizes.simple(ends[1][0] - ends[0][0])
        for (_, r, q), (_, _, other) in (ends, ends[::-1]):
            force = times(sizes.sign(length) * length * SIXTH, plus(times(2, q), other))
            yield PlacedPush(body, force, 0, self.link.pose.point(r), None, part)
