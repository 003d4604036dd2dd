"""System, state -> whether what touches touches: the nearest points of both surfaces coincide, and move as one.

The surfaces are taken as they are declared (`Meeting`), the places from the poses, velocities from the twists.

    ball on a plane      P = C - R n                          P on the plane
    wheel on a plane     P = C - R d/|d| - tube n,  d = n - a (a . n),  a its axis
    ellipsoid            P = C + R_B S x,  the ball |x| = 1 stretched by S:  x = - S R_B^T n / |S R_B^T n|
    ball on a ball       P = C - R o,  o from the other's centre to C;  P = A + r o   (inside: C + R o)
    wheel on a ball      the same, of the tyre's section about the place of its centre line nearest to A
    point on a line      P, and its foot on the line

What such a contact does it does there: a unit lam pushes with 1 N along the normal, what holds or brakes across it with
1 N across it, both at P and opposite on both bodies. That the rows' wrenches are such is looked at too.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from functools import cached_property
from typing import Any

from eomgen.mechanics.bodies.loads import body_wrench
from eomgen.mechanics.bodies.system_scene import SystemScene
from eomgen.mechanics.equations.system import System
from eomgen.model.constraints.meeting import (
    BodyLine,
    FlatSurface,
    Groove,
    Meeting,
    RoundSurface,
    TouchingPoint,
)
from eomgen.model.forces.load import Push
from eomgen.proof.in_numbers import InNumbers, direction_at
from eomgen.proof.states import refuse_open
from eomgen.records import dataclass
from eomgen.symbolic.expression.node import State
from eomgen.symbolic.expression.spatial import (
    ZERO,
    Numbers,
    cross,
    dot,
    minus,
    plus,
    times,
    vector_of,
)
from eomgen.symbolic.numeric.tolerances import COMPUTED

Y, Z = (0, 1, 0), (0, 0, 1)


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


@dataclass(frozen=True)
class _Form:
    """What touches, in numbers: a ball, a wheel about an axis (ground axes) with a tyre, or an ellipsoid."""

    radius: Any
    tube: Any = 0
    axis: Numbers | None = None
    semiaxes: Numbers | None = None


def meetings_of(system: System) -> dict[str, Meeting]:
    """What touches what in every tie that is closed."""
    closed = {row.tie for row in system.ties.rows}
    ties = system.scope.model.constraints
    found = {name: ties[name].meeting() for name in ties if name in closed}
    return {name: x for name, x in found.items() if x is not None}


def apart(system: System, state: State) -> str:
    """Which contact does not touch, or parts, at a state; "" where none does.

    Raises:
        NoValue: something has no value there, or the ties do not hold.
    """
    refuse_open(system, state)
    for name, meeting in meetings_of(system).items():
        wrong = _Contact(system, state, name, meeting).wrong
        if wrong:
            return f"'{name}': {wrong}"
    return ""


@dataclass(frozen=True)
class _Contact(InNumbers):
    """One contact at one state, in numbers."""

    name: str
    meeting: Meeting

    @property
    def wrong(self) -> str:
        touch = self._touch
        distance: Numbers = minus(touch.first, touch.second)
        size = 1 + max(map(abs, touch.first))
        if max(map(abs, distance)) > COMPUTED * size:
            return "its two points of contact are apart"
        slip = minus(self.velocity(self._body, touch.first), self.velocity(self.meeting.surface.on, touch.first))
        held = (slip,) if self.meeting.sticks else tuple(times(dot(slip, e), e) for e in touch.held)
        if self._rigid and any(abs(x) > COMPUTED * (1 + size) for part in held for x in part):
            return "its two points of contact part or slip"
        return self._wrong_force(touch)

    def _wrong_force(self, touch: Touch) -> str:
        """Which force of the contact is no unit force at its point, along the normal or across it, or ""."""
        for row in self.system.ties.rows:
            if row.tie != self.name:
                continue
            for label, pushes in ((row.component, row.pushes), ("t", row.tangent), ("s", row.cross_tangent)):
                if pushes and label and self._misplaced(touch, label, pushes):
                    return f"its force '{label}' is not of 1 N at the contact, in its direction"
        return ""

    def _misplaced(self, touch: Touch, label: str, pushes: Sequence[Push]) -> bool:
        """Whether pushes do not come to a unit force at the contact on its body, and its opposite on the other."""
        found: dict[str, tuple[Numbers, Numbers]] = {}
        for push in pushes:
            wrench = body_wrench(self.motion, push)
            if wrench is not None:
                body, W = wrench
                f, tau = found.get(body, (ZERO, ZERO))
                found[body] = plus(f, self.vector(W.f)), plus(tau, self.vector(W.tau))
        forces = []
        for body, (own_force, own_couple) in found.items():
            f, tau = (self.carried(body, x, direction=True) for x in (own_force, own_couple))
            about_contact: Numbers = minus(tau, cross(minus(touch.first, self.carried(body, ZERO)), f))
            if max(map(abs, about_contact)) > COMPUTED * (1 + max(map(abs, touch.first))):
                return True
            forces.append(f if body == self._body else times(-1, f))
        return any(self._misdirected(touch, label, f) for f in forces)

    def _misdirected(self, touch: Touch, label: str, f: Numbers) -> bool:
        """Whether a force on the first body is not of length 1, or not in its direction."""
        along = sum(dot(f, e) ** 2 for e in touch.held)
        wrong: list[Any] = [dot(f, f) - 1, along - 1 if label[0] == "n" else along]
        if not isinstance(self.meeting.surface, BodyLine):
            n = touch.held[0]
            wrong += [dot(f, n) - 1] if label == "n" else []
            if not self._space and label == "t":
                wrong += minus(f, (n[1], -n[0], 0))
        return any(abs(x) > COMPUTED for x in wrong)

    @cached_property
    def _scene(self) -> SystemScene:
        return SystemScene(self.motion, f"constraints.{self.name}")

    @property
    def _body(self) -> str | None:
        what = self.meeting.what
        return self._scene.place(what.point)[0] if isinstance(what, TouchingPoint) else what.body

    @property
    def _rigid(self) -> bool:
        """Whether point and surface are fixed in their bodies: else velocities of material points are others."""
        what, surface = self.meeting.what, self.meeting.surface
        own = self._scene.place(what.point)[1] if isinstance(what, TouchingPoint) else ZERO
        seats = [own] if isinstance(surface, (BodyLine, Groove)) else [own, self._anchor]
        return not any(self.motion.moves(tuple(seat)) for seat in seats)

    @cached_property
    def _anchor(self) -> Numbers:
        """`at` of the surface in its body's axes, over the graph; where it is not given, where the point stands."""
        surface = self.meeting.surface
        assert not isinstance(surface, (BodyLine, Groove))
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
        return self.carried(place[0], self.vector(place[1]))

    @cached_property
    def _form(self) -> _Form:
        """What touches; sizes that are left out are those of the shape."""
        what, scene = self.meeting.what, self._scene
        if isinstance(what, TouchingPoint):
            return _Form(0)
        shape = scene.shape(what.body)
        semiaxes, radius, axis, tube = what.semiaxes, what.radius, what.axis, what.tube
        if radius is None and axis is None and semiaxes is None:
            semiaxes = getattr(shape, "semiaxes", None)
        if semiaxes is not None:
            return _Form(0, semiaxes=self.vector(scene.vector(semiaxes)))
        if radius is None and self._space and shape is not None and shape.is_tyre:
            radius, tube = shape.major, shape.minor if tube is None else tube
            axis = Z if axis is None else axis
        R = scene.radius(what.body) if radius is None else scene.value(radius)
        R, section = self.at([R, 0 if tube is None else scene.value(tube)])
        if axis is None:
            return _Form(R)
        own = axis if axis is Z else scene.vector(axis)
        return _Form(R, section, direction_at(self.carried(what.body, self.vector(own), direction=True)))

    @property
    def _touch(self) -> Touch:
        surface, C = self.meeting.surface, self._center
        if isinstance(surface, Groove):
            normal = Z if surface.normal is None else self.vector(self._scene.vector(surface.normal))
            edge = self.carried(surface.on, self.vector(self._scene.vector(surface.along)), direction=True)
            return Touch(C, C, (direction_at(cross(normal, edge)),))
        if isinstance(surface, BodyLine):
            a, b = (self.carried(surface.on, self.vector(r)) for _, r in self._scene.line(surface.on))
            along = direction_at(minus(b, a))
            foot = plus(a, times(dot(along, minus(C, a)), along))
            return Touch(C, foot, tuple(_across(along)) if self._space else (_turned(along),))
        A = self.carried(surface.on, self.vector(self._anchor))
        if isinstance(surface, FlatSurface):
            normal = self.vector(self._scene.vector(surface.normal))
            n = direction_at(self.carried(surface.on, normal, direction=True))
            P = self._lowest(C, n)
            return Touch(P, minus(P, times(dot(n, minus(P, A)), n)), (n,))
        return self._on_round(surface, C, A)

    def _on_round(self, surface: RoundSurface, C: Numbers, A: Numbers) -> Touch:
        """A ball, or the section of a tyre where its centre line is nearest, on a ball or pipe about A."""
        form, side = self._form, -1 if surface.inside else 1
        if form.axis is not None:
            h = minus(minus(C, A), times(dot(minus(C, A), form.axis), form.axis))
            C = minus(C, times(side * form.radius, direction_at(h)))
        if surface.axis is not None:
            axis = self.vector(self._scene.vector(surface.axis))
            a = direction_at(self.carried(surface.on, axis, direction=True))
            A = plus(A, times(dot(minus(C, A), a), a))
        out = direction_at(minus(C, A))
        r = self._scene.radius(str(surface.on)) if surface.radius is None else self._scene.value(surface.radius)
        section = form.radius if form.axis is None else form.tube
        first, second = minus(C, times(side * section, out)), plus(A, times(self.one(r), out))
        return Touch(first, second, (times(side, out),))

    def _lowest(self, C: Numbers, n: Numbers) -> Numbers:
        """The point of a round body that is farthest along -n."""
        form, body = self._form, getattr(self.meeting.what, "body", None)
        if form.semiaxes is not None:
            axes = [self.carried(body, e, direction=True) for e in ((1, 0, 0), Y, Z)]
            x = direction_at(vector_of(-s * dot(n, e) for s, e in zip(form.semiaxes, axes, strict=True)))
            for s, k, e in zip(form.semiaxes, x, axes, strict=True):
                C = plus(C, times(s * k, e))
            return C
        d = n if form.axis is None else direction_at(minus(n, times(dot(form.axis, n), form.axis)))
        return minus(minus(C, times(form.radius, d)), times(form.tube, n))

    @property
    def _space(self) -> bool:
        return self.system.scope.model.space == "space"


def _turned(a: Numbers) -> Numbers:
    return (-a[1], a[0], 0)


def _across(a: Numbers) -> Iterator[Numbers]:
    """Two unit vectors across a unit vector."""
    k = min(range(3), key=lambda i: abs(a[i]))
    first = direction_at(cross(a, vector_of(int(i == k) for i in range(3))))
    yield first
    yield cross(a, first)
