"""System, state -> whether every body stands against its parent as its joint is declared, in numbers.

Moves one after another, each in the axes that those before left. A turn by an angle a about n is the quaternion
(cos a/2, n sin a/2); it takes v to v + 2 e x (e x v + e_0 v). An arc of angle a and radius r is its chord 2 r sin a/2,
at half of a from where it begins.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from eomgen.mechanics.bodies.kinematics import BodyLink, ground_place
from eomgen.mechanics.equations.system import System
from eomgen.model.joints.moves import Move, QuaternionTurn, SlideAlong, TurnAbout, WayAlongPieces
from eomgen.proof.in_numbers import InNumbers, direction_at
from eomgen.records import dataclass
from eomgen.symbolic.expression.graph import Scalar
from eomgen.symbolic.expression.node import State
from eomgen.symbolic.expression.spatial import IDENTITY, ZERO, Numbers, cross, dot, minus, plus, times, vector_of
from eomgen.symbolic.numeric.evaluation import evaluate, fifty_digits
from eomgen.symbolic.numeric.tolerances import ZERO_AT_50

Quaternion = tuple[Any, Numbers]


def misplaced(system: System, state: State) -> str:
    """Which body does not stand as its joint is declared at a state; "" where none does.

    Raises:
        NoValue: something has no value there.
    """
    links = system.motion.links
    flat = [x for link in links for x in (*link.pose.p, *(x for row in link.pose.R for x in row), _angle(link))]
    values = evaluate(flat, state, fifty_digits())
    bodies = (values[k : k + 13] for k in range(0, len(values), 13))
    stands = [_stand(own) for own in bodies]
    for link, here in zip(links, stands, strict=True):
        above = stands[link.parent] if link.parent >= 0 else _Stand(ZERO, *IDENTITY, 0)
        if wrong := _Seated(system, state, link).wrong(above, here):
            return f"'{link.name}' {wrong}"
    return ""


@dataclass(frozen=True)
class _Stand:
    """A body in numbers: its place, the rows of its axes, in the plane its angle."""

    p: Numbers
    x: Numbers
    y: Numbers
    z: Numbers
    angle: Any

    def from_above(self, v: Numbers) -> Numbers:
        """A vector of the ground in the axes of the body: R^T v."""
        return plus(plus(times(v[0], self.x), times(v[1], self.y)), times(v[2], self.z))

    def column(self, k: int) -> Numbers:
        return vector_of((self.x[k], self.y[k], self.z[k]))


def _angle(link: BodyLink) -> Scalar:
    return 0 if link.angle is None else link.angle


def _stand(own: Sequence[Any]) -> _Stand:
    p, x, y, z = (vector_of(own[k : k + 3]) for k in (0, 3, 6, 9))
    return _Stand(p, x, y, z, own[12])


@dataclass(frozen=True)
class _Seated(InNumbers):
    """One body at one state."""

    link: BodyLink

    def wrong(self, above: _Stand, here: _Stand) -> str:
        joint = self.link.joint
        moves = () if joint is None else (*(TurnAbout(t.axis, t.angle) for t in joint.turned or ()), *joint.moves())
        place, e = self._seat, (self.one(1), ZERO)
        for move in moves:
            way, turn = self._moved(move)
            place, e = plus(place, _turned(e, way)), _after(e, turn)
        place = minus(place, _turned(e, self.vector(self._own_point)))
        stated: Numbers = above.from_above(minus(here.p, above.p))
        if _apart(stated, place):
            return "is not where its joint says"
        if any(_apart(above.from_above(here.column(k)), _turned(e, axis)) for k, axis in enumerate(IDENTITY)):
            return "is not turned as its joint says"
        functions = fifty_digits().functions
        heading: Numbers = (functions["cos"](here.angle), functions["sin"](here.angle), 0)
        flat = self.link.angle is not None
        return "has another angle than its axes" if flat and _apart(heading, here.column(0)) else ""

    # -- as it is declared -----------------------------------------------------------------------------------

    @property
    def _seat(self) -> Numbers:
        """Where the joint sits: a point of the parent, or `at`."""
        joint = self.link.joint
        if joint is None:
            return ZERO
        if joint.on is not None and "." in joint.on:
            return self.vector(self.motion.place(joint.on)[1])
        return self.vector(ground_place(self.motion.scope, joint.at)) if joint.seated else ZERO

    @property
    def _own_point(self) -> Sequence[Scalar]:
        joint = self.link.joint
        named = joint is not None and joint.point is not None
        return self.motion.points[self.link.name][joint.point.rpartition(".")[2]] if named else ZERO

    def _moved(self, move: Move) -> tuple[Numbers, Quaternion]:
        """(how far, how it turns)"""
        still = (self.one(1), ZERO)
        if isinstance(move, SlideAlong):
            return times(self._typed(move.way), self._unit(move.axis)), still
        if isinstance(move, TurnAbout):
            half, functions = self._typed(move.angle) / 2, fifty_digits().functions
            return ZERO, (functions["cos"](half), times(functions["sin"](half), self._unit(move.axis)))
        if isinstance(move, QuaternionTurn):
            e0, e1, e2, e3 = self.at([self.motion.scope.names[name] for name in move.quaternion])
            return ZERO, (e0, (e1, e2, e3))
        return self._walked(move), still

    def _walked(self, route: WayAlongPieces) -> Numbers:
        left, heading, functions = self._typed(route.way), self._typed(route.heading), fifty_digits().functions
        place: Numbers = ZERO
        for piece in route.pieces:
            length = self._typed(piece.line) if piece.arc is None else self._typed(piece.arc) * self._typed(piece.angle)
            way = left if piece is route.pieces[-1] else min(left, length)
            turn = 0 * way
            if piece.arc is not None:
                turn = way / self._typed(piece.arc) * (1 if piece.turn == "ccw" else -1)
                way = 2 * self._typed(piece.arc) * functions["sin"](abs(turn) / 2) * (1 if way >= 0 else -1)
            across = heading + turn / 2
            place = plus(place, times(way, (functions["cos"](across), functions["sin"](across), 0)))
            left, heading = left - length, heading + turn
            if left <= 0:
                break
        return place

    # -- numbers ---------------------------------------------------------------------------------------------

    def _typed(self, expression: Any) -> Any:
        """What is declared; nothing is 0."""
        return self.one(0 if expression is None else self.motion.scope.value(expression))

    def _unit(self, axis: Any) -> Numbers:
        """A declared direction, of length 1; None: z."""
        entries = (0, 0, 1) if axis is None else axis
        given = [x if isinstance(x, int) else self.motion.scope.value(x) for x in entries]
        return direction_at(self.vector((*given, *[0] * (3 - len(given)))))


def _after(first: Quaternion, second: Quaternion) -> Quaternion:
    """The turn that is the second in the axes that the first one left."""
    (a, u), (b, v) = first, second
    real: Any = a * b - dot(u, v)
    return real, plus(plus(times(a, v), times(b, u)), cross(u, v))


def _turned(e: Quaternion, v: Numbers) -> Numbers:
    e0, u = e
    return plus(v, times(2, cross(u, plus(cross(u, v), times(e0, v)))))


def _apart(a: Numbers, b: Numbers) -> bool:
    gap: Sequence[Any] = minus(a, b)
    most: Any = max(map(abs, b))
    return any(abs(x) > ZERO_AT_50 * (1 + most) for x in gap)
