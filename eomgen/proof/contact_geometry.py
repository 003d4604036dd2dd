"""System, state -> whether what touches touches: the nearest points of both surfaces coincide, and move as one.

The surfaces are taken as they are declared (`Meeting`), the places from the poses, velocities from the twists: of the
tie itself only its gap and its rows are used, to say that it holds at the state.

    ball on a plane      P = C - R n                          P on the plane
    wheel on a plane     P = C - R d/|d| - tube n,  d = n - a (a . n),  a its axis
    ball on a ball       P = C - R o,  o from the other's centre to C;  P = A + r o   (inside: C + R o)
    point on a line      P, and its foot on the line
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Any

from eomgen.mechanics.bodies.loads import SystemScene
from eomgen.mechanics.equations.system import System
from eomgen.model.constraints.meeting import (
    BodyLine,
    FlatSurface,
    Meeting,
    RoundSurface,
    TouchingPoint,
    TouchingRound,
)
from eomgen.symbolic.expression.graph import Scalar
from eomgen.symbolic.expression.node import State
from eomgen.symbolic.expression.spatial import (
    ZERO,
    Numbers,
    apply,
    cross,
    dot,
    matrix_of,
    minus,
    plus,
    times,
    transposed,
    vector_of,
)
from eomgen.symbolic.numeric.evaluation import NoValue, evaluate, fifty_digits
from eomgen.symbolic.numeric.tolerances import COMPUTED

NUMBERS = 18  # of a body: R, p, w, v


@dataclass(frozen=True)
class Touch:
    """Where two things touch at a state.

    Args:
        first, second: the nearest points of both, ground axes.
        held: directions in which they cannot part, ground axes.
    """

    first: Numbers
    second: Numbers
    held: tuple[Numbers, ...]


def meetings_of(system: System) -> dict[str, Meeting]:
    """What touches what in every tie that is closed."""
    closed = {row.tie for row in system.ties.rows}
    ties = system.scope.model.constraints
    found = {name: ties[name].meeting() for name in ties if name in closed}
    return {name: x for name, x in found.items() if x is not None and _is_told(system, x.what)}


def _is_told(system: System, what: TouchingPoint | TouchingRound) -> bool:
    """Whether its radius is known: its own, or that of a round shape (no tyre, no ellipsoid)."""
    if isinstance(what, TouchingPoint) or what.radius is not None:
        return True
    return getattr(system.scope.model.bodies[what.body].shape, "radius", None) is not None


def apart(system: System, state: State) -> str:
    """Which contact does not touch, or parts, at a state; "" where none does.

    Raises:
        NoValue: something has no value there, or the ties do not hold.
    """
    _refuse_open(system, state)
    for name, meeting in meetings_of(system).items():
        wrong = _Contact(system, state, name, meeting).wrong
        if wrong:
            return f"'{name}': {wrong}"
    return ""


def _refuse_open(system: System, state: State) -> None:
    """Nothing, where the gaps and the rates of all rows are 0."""
    rows = [row for row in system.ties.rows if not row.identical]
    asked = [*(row.velocity for row in rows), *(row.gap for row in rows if row.gap is not None)]
    if any(abs(x) > COMPUTED for x in evaluate(asked, state, fifty_digits())):
        raise NoValue("the ties are open")


@dataclass(frozen=True)
class _Contact:
    """One contact at one state, in numbers."""

    system: System
    state: State
    name: str
    meeting: Meeting

    @property
    def wrong(self) -> str:
        touch = self._touch
        distance: Numbers = minus(touch.first, touch.second)
        size = 1 + max(map(abs, touch.first))
        if max(map(abs, distance)) > COMPUTED * size:
            return "its two points of contact are apart"
        slip = minus(self._velocity(self._body, touch.first), self._velocity(self.meeting.surface.on, touch.first))
        held = (slip,) if self.meeting.sticks else tuple(times(dot(slip, e), e) for e in touch.held)
        if self._rigid and any(abs(x) > COMPUTED * (1 + size) for part in held for x in part):
            return "its two points of contact part or slip"
        return ""

    @cached_property
    def _scene(self) -> SystemScene:
        return SystemScene(self.system.motion, f"constraints.{self.name}")

    def _numbers(self, scalars: Sequence[Scalar]) -> list[Any]:
        return evaluate(tuple(scalars), self.state, fifty_digits())

    def _vector(self, vector: Sequence[Scalar]) -> Numbers:
        return vector_of(self._numbers(vector))

    @property
    def _body(self) -> str | None:
        what = self.meeting.what
        return self._scene.place(what.point)[0] if isinstance(what, TouchingPoint) else what.body

    @property
    def _rigid(self) -> bool:
        """Whether point and surface are fixed in their bodies: else velocities of material points are others."""
        what, surface = self.meeting.what, self.meeting.surface
        own = self._scene.place(what.point)[1] if isinstance(what, TouchingPoint) else ZERO
        seats = [own] if isinstance(surface, BodyLine) else [own, self._anchor]
        return not any(self.system.motion.moves(tuple(seat)) for seat in seats)

    def _pose(self, body: str | None) -> list[Any] | None:
        if body is None:
            return None
        link = self.system.motion.link(body)
        return self._numbers([*(x for row in link.pose.R for x in row), *link.pose.p, *link.twist.w, *link.twist.v])

    def _carried(self, body: str | None, place: Numbers, *, direction: bool = False) -> Numbers:
        """A place or direction of a body, ground axes."""
        pose = self._pose(body)
        if pose is None:
            return place
        turned = apply(matrix_of((pose[0:3], pose[3:6], pose[6:9])), place)
        return turned if direction else plus(vector_of(pose[9:12]), turned)

    def _velocity(self, body: str | None, P: Numbers) -> Numbers:
        """Of the material point of a body at P, ground axes: R (v + w x R^T (P - p))."""
        pose = self._pose(body)
        if pose is None:
            return ZERO
        R, p = matrix_of((pose[0:3], pose[3:6], pose[6:9])), vector_of(pose[9:12])
        arm = apply(transposed(R), minus(P, p))
        return apply(R, plus(vector_of(pose[15:18]), cross(vector_of(pose[12:15]), arm)))

    @cached_property
    def _anchor(self) -> Numbers:
        """`at` of the surface in its body's axes, over the graph; where it is not given, where the point stands."""
        surface = self.meeting.surface
        assert not isinstance(surface, BodyLine)
        if surface.at is not None:
            return self._scene.ground_place(surface.at)
        if isinstance(surface, RoundSurface):
            return ZERO
        what = self.meeting.what
        assert isinstance(what, TouchingPoint)
        return vector_of(map(self._scene.start, self._scene.position(self._scene.place(what.point))))

    @property
    def _center(self) -> Numbers:
        """The point, or the centre of what is round, ground axes."""
        what, scene = self.meeting.what, self._scene
        place = scene.place(what.point) if isinstance(what, TouchingPoint) else scene.own_place(what.body, what.center)
        return self._carried(place[0], self._vector(place[1]))

    @property
    def _radius(self) -> Any:
        what, scene = self.meeting.what, self._scene
        if isinstance(what, TouchingPoint):
            return 0
        return self._numbers([scene.radius(what.body) if what.radius is None else scene.value(what.radius)])[0]

    @property
    def _touch(self) -> Touch:
        surface, C = self.meeting.surface, self._center
        if isinstance(surface, BodyLine):
            a, b = (self._carried(surface.on, self._vector(r)) for _, r in self._scene.line(surface.on))
            along = _unit(minus(b, a))
            foot = plus(a, times(dot(along, minus(C, a)), along))
            return Touch(C, foot, tuple(_across(along)) if self._space else (_turned(along),))
        A = self._carried(surface.on, self._vector(self._anchor))
        if isinstance(surface, FlatSurface):
            normal = self._vector(self._scene.vector(surface.normal))
            n = _unit(self._carried(surface.on, normal, direction=True))
            P = self._lowest(C, n)
            return Touch(P, minus(P, times(dot(n, minus(P, A)), n)), (n,))
        out = _unit(minus(C, A))
        r = self._scene.radius(str(surface.on)) if surface.radius is None else self._scene.value(surface.radius)
        side = 1 if surface.inside else -1
        return Touch(plus(C, times(side * self._radius, out)), plus(A, times(self._numbers([r])[0], out)), (out,))

    def _lowest(self, C: Numbers, n: Numbers) -> Numbers:
        """The point of a round body that is farthest along -n."""
        what = self.meeting.what
        if isinstance(what, TouchingPoint):
            return C
        d, tube = n, 0
        if what.axis is not None:
            axis = self._vector(self._scene.vector(what.axis))
            a = _unit(self._carried(what.body, axis, direction=True))
            d = _unit(minus(n, times(dot(a, n), a)))
            tube = 0 if what.tube is None else self._numbers([self._scene.value(what.tube)])[0]
        return minus(minus(C, times(self._radius, d)), times(tube, n))

    @property
    def _space(self) -> bool:
        return self.system.scope.model.space == "space"


def _unit(a: Numbers) -> Numbers:
    size = fifty_digits().functions["sqrt"](dot(a, a))
    if size == 0:
        raise NoValue("a direction of length 0")
    return times(1 / size, a)


def _turned(a: Numbers) -> Numbers:
    return (-a[1], a[0], 0)


def _across(a: Numbers) -> Iterator[Numbers]:
    """Two unit vectors across a unit vector."""
    k = min(range(3), key=lambda i: abs(a[i]))
    first = _unit(cross(a, vector_of(int(i == k) for i in range(3))))
    yield first
    yield cross(a, first)
