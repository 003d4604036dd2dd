"""Poses of bodies and contacts from the declaration alone.

Model at random values of its coordinates -> poses and weights of its bodies, in doubles.

    T = (R, p) of a body in the axes of the ground

The proofs of imported robots share this; they read a robot by another reader, with the names of the robot's file.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping, Sequence
from contextlib import suppress
from functools import cached_property
from typing import Any

import numpy as np

from eomgen.errors import DerivationError
from eomgen.frozen import dataclass
from eomgen.mechanics.dynamics import System
from eomgen.mechanics.kinematics import (
    BodyLink,
    Motion,
    Scope,
    SystemScene,
)
from eomgen.mechanics.start import Branches
from eomgen.model import Meeting, Model
from eomgen.proof.states import InNumbers, Pushes, direction_at, pushes_of, refuse_open
from eomgen.study import Checked
from eomgen.symbolic.expression import Matrix, Node, Scalar, State, Vector
from eomgen.symbolic.numeric import evaluate, fifty_digits, tolerances

FIRST, STEP = 0.3, 0.17  # values of the coordinates, one after the other
REMARKED = ("link", "joint", "body")  # "link upper arm, from ...": name in the other file
FloatPose = tuple[np.ndarray, np.ndarray]


class PosedModel:
    """Model and values of its coordinates, quaternions of norm 1; some may be set to other values."""

    def __init__(self, model: Model, values: Mapping[str, float] | None = None) -> None:
        self.model, self.motion = model, Motion.of(Scope.of(model))
        self.values = {q: FIRST + STEP * k for k, q in enumerate(model.coordinates)} | dict(values or {})
        for turn in map(self.quaternion, model.bodies):
            size = math.hypot(*(self.values[e] for e in turn))
            self.values |= {e: self.values[e] / size for e in turn}
        self.bodies = _by_remark(model.bodies)
        self.coordinates = _by_remark(model.coordinates)

    @property
    def known(self) -> Mapping[Node, float]:
        return self.values_in(self.motion)

    def values_in(self, motion: Motion) -> dict[Node, float]:
        """Parameters, coordinates and the time as symbols of a motion of the model, with their numbers."""
        known, symbols = self.model.exact_parameters(), motion.scope.symbols
        return {
            **{node: float(known[name]) for name, node in symbols.parameters.items() if name in known},
            **{node: self.values[node.name] for node in symbols.q},
            symbols.t: 0.0,
        }

    def at(self, scalars: tuple[Scalar, ...]) -> np.ndarray:
        return np.array([float(x) for x in evaluate(scalars, self.known)])

    def number(self, expression: Any) -> float:
        """Value of a field of the model; 0 for a missing one."""
        return 0.0 if expression is None else float(self.at((self.motion.scope.value(expression),))[0])

    def pose(self, body: str | None) -> FloatPose:
        """Pose of a body in the ground; for None, that of the ground itself."""
        if body is None:
            return np.eye(3), np.zeros(3)
        pose = self.motion.link(body).pose
        return self.at(tuple(x for row in pose.R for x in row)).reshape(3, 3), self.at(tuple(pose.p))

    def between(self, above: str | None, body: str) -> FloatPose:
        """Pose of a body in the axes of another."""
        (R, p), (R0, p0) = self.pose(body), self.pose(above)
        return R0.T @ R, R0.T @ (p - p0)

    def weight(self, body: str) -> np.ndarray:
        """m, m c, the inertia about the mass centre in body axes: 13 numbers."""
        own = self.motion.scope.mass_properties(body)
        found = self.at((own.m, *own.com, *(x for row in own.I for x in row)))
        found[1:4] *= found[0]
        return found

    def quaternion(self, body: str) -> tuple[str, ...]:
        """The names of the quaternion of a body's joint, scalar first; () of other joints."""
        return tuple(getattr(self.model.bodies[body].joint, "quaternion", None) or ())

    def variables(self, body: str, *fields: str) -> tuple[str, ...]:
        """The names in these fields of a body's joint: "angle", "displacement", or the three of a "position"."""
        given = (getattr(self.model.bodies[body].joint, field, None) for field in fields)
        parts = (x for each in given for x in (each if isinstance(each, tuple) else (each,)))
        return tuple(str(getattr(x, "text", x)) for x in parts if x is not None)

    def stops(self, body: str) -> tuple[float, float]:
        """The least and the largest value of the one variable of a body's joint, infinite where there is none."""
        stops: list[Any] = [x for x in self.model.constraints.values() if x.about_joint]
        ends = {x.upper: x.bound for x in stops if x.body == body}
        joint: Any = self.model.bodies[body].joint
        if getattr(joint, "stop", None) is not None:
            ends = {False: joint.limits.low, True: joint.limits.high}
        low, high = (ends.get(upper) for upper in (False, True))
        return -math.inf if low is None else self.number(low), math.inf if high is None else self.number(high)

    def follows(self) -> Iterator[str]:
        """Messages of equations between coordinates, from `mimic` of an import, that do not hold."""
        for name, constraint in self.model.constraints.items():
            gap = getattr(constraint, "gap", None)
            if gap is not None and not gap.calls and name.startswith("mimic"):
                left = self.number(gap)
                yield f"'{name}' leaves {left:.3g}" if abs(left) > tolerances.COMPUTED * 10 else ""


def branches_otherwise(checked: Checked) -> str:
    """Message that names a pin which is on the other side of its links' hinges than reported; "".

    A hinge is where a body stays beside its parent, whatever its coordinates are. Where places depend on inputs nothing
    is decided.
    """
    begun, branches = checked.start.begun, checked.start.branches
    if begun is None or branches is None:
        return ""
    with suppress(DerivationError):
        return _sides_otherwise(checked.model, begun.values, branches)
    return ""


def _sides_otherwise(model: Model, start: Mapping[str, float], branches: Branches) -> str:
    for way in (branches.here, *branches.others):
        here = PosedModel(model, {**start, **way.values})
        for side in way.sides:
            left = _is_left(here, side.constraint, (side.first, side.second))
            if left is not None and left != side.left:
                found = f"'{side.constraint}' is on the {'left' if left else 'right'} of its links' hinges"
                return f"{found} where {way.words}" if way.words else found
    return ""


def _is_left(here: PosedModel, pin: str, links: Sequence[str]) -> bool | None:
    """True if the pin is on the left of the way from one hinge to the other; None in line, and where one is unknown."""
    aside = PosedModel(here.model, {q: x + STEP * (k + 1) for k, (q, x) in enumerate(here.values.items())})
    P, Q = (_hinge(here, aside, body) for body in links)
    body, _, name = str(getattr(here.model.constraints[pin], "points", ("",))[0]).partition(".")
    place = here.motion.points.get(body, {}).get(name)
    if P is None or Q is None or place is None:
        return None
    R, p = here.pose(body)
    to_hinge, to_pin = (Q - P)[:2], (p + R @ here.at(place) - P)[:2]
    area = float(to_hinge[0] * to_pin[1] - to_hinge[1] * to_pin[0])
    size = float(np.linalg.norm(to_hinge) * np.linalg.norm(to_pin))
    return None if abs(area) <= tolerances.COMPUTED * size else area > 0


def _hinge(here: PosedModel, aside: PosedModel, body: str) -> np.ndarray | None:
    """The place of a body's hinge in the ground: that which two poses beside its parent share; None without one."""
    above = here.motion.link(body).parent
    parent = None if above < 0 else here.motion.links[above].name
    (R, p), (R1, p1) = (posed.between(parent, body) for posed in (here, aside))
    turn, moved = (R1 @ R.T)[:2, :2], (p1 - R1 @ R.T @ p)[:2]
    if abs(np.linalg.det(np.eye(2) - turn)) < tolerances.NEARLY_SINGULAR:
        return None
    inside = np.array([*np.linalg.solve(np.eye(2) - turn, moved), 0.0])
    R0, p0 = here.pose(parent)
    found: np.ndarray = p0 + R0 @ inside
    return found


def posed_further(pose: FloatPose, *further: FloatPose) -> FloatPose:
    """T T' ..., each in the axes of the one before."""
    R, p = pose
    for R1, p1 in further:
        R, p = R @ R1, p + R @ p1
    return R, p


def pose_back(pose: FloatPose) -> FloatPose:
    """T^-1."""
    R, p = pose
    return R.T, -R.T @ p


def poses_differ(found: FloatPose, due: FloatPose) -> bool:
    """True if two poses differ."""
    away = max(abs(found[0] - due[0]).max(), abs(found[1] - due[1]).max())
    return bool(away > tolerances.COMPUTED * (1 + abs(due[1]).max()))


def figures_in(text: str) -> np.ndarray:
    return np.array([float(x) for x in text.split()])


def turn_by_three(angles: np.ndarray) -> np.ndarray:
    X, Y, Z = np.eye(3)
    roll, pitch, yaw = angles
    found: np.ndarray = turn_about(Z, yaw) @ turn_about(Y, pitch) @ turn_about(X, roll)
    return found


def turn_about(n: np.ndarray, angle: float) -> np.ndarray:
    """1 + sin K + (1 - cos) K^2, K v = n x v."""
    K = np.array([[0, -n[2], n[1]], [n[2], 0, -n[0]], [-n[1], n[0], 0]])
    found: np.ndarray = np.eye(3) + math.sin(angle) * K + (1 - math.cos(angle)) * K @ K
    return found


def _by_remark(parts: Mapping[str, Any]) -> dict[str, str]:
    """Names here by the names that parts had in another program's file."""
    found: dict[str, str] = {}
    for name, part in parts.items():
        kind, _, rest = (part.about or "").partition(" ")
        other = rest.partition(", from ")[0].partition(", at most ")[0]
        found.setdefault(other if kind in REMARKED and other else name, name)
    return found


# -------- joint places ----------------------------------------------------------------------------------------
# System, state -> whether every body stands against its parent as its joint is declared, in numbers.
#
# Moves one after another, each in the axes that those before left. A turn by an angle a about n is the quaternion
# (cos a/2, n sin a/2); it takes v to v + 2 e x (e x v + e_0 v). An arc of angle a and radius r is its chord 2 r sin
# a/2, at half of a from where it begins.


Quaternion = tuple[Any, Vector]


def misplaced(system: System, state: State) -> str:
    """Message that names a body which does not stand as its joint is declared, at a state; "".

    Raises:
        NoValue: something has no value there.
    """
    links = system.motion.links
    flat = [x for link in links for x in (*link.pose.p, *(x for row in link.pose.R for x in row), _angle(link))]
    values = evaluate(flat, state, fifty_digits())
    bodies = (values[k : k + 13] for k in range(0, len(values), 13))
    stands = [_stand(own) for own in bodies]
    for link, here in zip(links, stands, strict=True):
        above = stands[link.parent] if link.parent >= 0 else _Stand(Vector.ZERO, *Matrix.IDENTITY, 0)
        if wrong := _Seated(system, state, link).wrong(above, here):
            return f"'{link.name}' {wrong}"
    return ""


@dataclass(frozen=True)
class _Stand:
    """A body in numbers: its place, the rows of its axes, in the plane its angle."""

    p: Vector
    x: Vector
    y: Vector
    z: Vector
    angle: Any

    def from_above(self, v: Vector) -> Vector:
        """A vector of the ground in the axes of the body: R^T v."""
        turned: Vector = self.x * v[0] + self.y * v[1] + self.z * v[2]
        return turned

    def column(self, k: int) -> Vector:
        return Vector((self.x[k], self.y[k], self.z[k]))


def _angle(link: BodyLink) -> Scalar:
    return 0 if link.angle is None else link.angle


def _stand(own: Sequence[Any]) -> _Stand:
    p, x, y, z = (Vector(own[k : k + 3]) for k in (0, 3, 6, 9))
    return _Stand(p, x, y, z, own[12])


@dataclass(frozen=True)
class _Seated(InNumbers):
    """One body at one state."""

    link: BodyLink

    def wrong(self, above: _Stand, here: _Stand) -> str:
        joint = self.link.joint
        moves = () if joint is None else joint.moves_from_parent
        place, e = self._seat, (self.one(1), Vector.ZERO)
        for move in moves:
            if move.pieces:
                way = self._walked(move.pieces, self._typed(move.way), self._typed(move.heading))
            else:
                way = self._typed(move.way) * self._unit(move.axis)
            turn = self._turn(move.axis, move.angle) if move.quaternion is None else self._four(move.quaternion)
            place, e = place + _turned(e, way), _after(e, turn)
        place = place - _turned(e, self.vector(self._own_point))
        stated: Vector = above.from_above(here.p - above.p)
        if _apart(stated, place):
            return "is not where its joint says"
        if any(_apart(above.from_above(here.column(k)), _turned(e, axis)) for k, axis in enumerate(Matrix.IDENTITY)):
            return "is not turned as its joint says"
        functions = fifty_digits().functions
        heading = Vector((functions["cos"](here.angle), functions["sin"](here.angle), 0))
        flat = self.link.angle is not None
        return "has another angle than its axes" if flat and _apart(heading, here.column(0)) else ""

    # -- as it is declared -----------------------------------------------------------------------------------

    @property
    def _seat(self) -> Vector:
        """Place of the joint: a point of the parent, or `at`."""
        joint = self.link.joint
        if joint is None:
            return Vector.ZERO
        if joint.on is not None and "." in joint.on:
            return self.vector(self.motion.place(joint.on)[1])
        return self.vector(self.motion.scope.ground_place(joint.at)) if joint.seated else Vector.ZERO

    @property
    def _own_point(self) -> Sequence[Scalar]:
        joint = self.link.joint
        named = joint is not None and joint.point is not None
        return self.motion.points[self.link.name][joint.point.rpartition(".")[2]] if named else Vector.ZERO

    def _turn(self, axis: Any, angle: Any) -> Quaternion:
        half, functions = self._typed(angle) / 2, fifty_digits().functions
        return functions["cos"](half), functions["sin"](half) * self._unit(axis)

    def _four(self, names: Sequence[str]) -> Quaternion:
        e0, e1, e2, e3 = self.at([self.motion.scope.names[name] for name in names])
        return e0, Vector((e1, e2, e3))

    def _walked(self, pieces: Sequence[Any], left: Any, heading: Any) -> Vector:
        """Place that is so far along lines and arcs, of which the first begins at the origin, with a heading."""
        place, functions = Vector.ZERO, fifty_digits().functions
        for piece in pieces:
            length = self._typed(piece.line) if piece.arc is None else self._typed(piece.arc) * self._typed(piece.angle)
            way = left if piece is pieces[-1] else min(left, length)
            turn = 0 * way
            if piece.arc is not None:
                turn = way / self._typed(piece.arc) * (1 if piece.turn == "ccw" else -1)
                way = 2 * self._typed(piece.arc) * functions["sin"](abs(turn) / 2) * (1 if way >= 0 else -1)
            across = heading + turn / 2
            place = place + way * Vector((functions["cos"](across), functions["sin"](across), 0))
            left, heading = left - length, heading + turn
            if left <= 0:
                break
        return place

    # -- numbers ---------------------------------------------------------------------------------------------

    def _typed(self, expression: Any) -> Any:
        """Value of a declared expression; 0 for a missing one."""
        return self.one(0 if expression is None else self.motion.scope.value(expression))

    def _unit(self, axis: Any) -> Vector:
        """A declared direction, of length 1; None: z."""
        entries = (0, 0, 1) if axis is None else axis
        given = [x if isinstance(x, int) else self.motion.scope.value(x) for x in entries]
        return direction_at(self.vector((*given, *[0] * (3 - len(given)))))


def _after(first: Quaternion, second: Quaternion) -> Quaternion:
    """The turn that is the second in the axes that the first one left."""
    (a, u), (b, v) = first, second
    real: Any = a * b - u @ v
    return real, a * v + b * u + u.cross(v)


def _turned(e: Quaternion, v: Vector) -> Vector:
    e0, u = e
    return v + 2 * u.cross(u.cross(v) + e0 * v)


def _apart(a: Vector, b: Vector) -> bool:
    gap: Sequence[Any] = a - b
    most = b.largest
    return any(abs(x) > tolerances.ZERO_AT_50 * (1 + most) for x in gap)


# -------- contact geometry ------------------------------------------------------------------------------------
# System, state -> check of contacts: the nearest points of both surfaces coincide, and move as one.
#
# The surfaces are taken as they are declared (`Meeting`), the places from the poses, velocities from the twists.
#
#     ball on a plane      P = C - R n                          P on the plane
#     wheel on a plane     P = C - R d/|d| - tube n,  d = n - a (a . n),  a its axis
#     ellipsoid            P = C + R_B S x,  the ball |x| = 1 stretched by S:  x = - S R_B^T n / |S R_B^T n|
#     ball on a ball       P = C - R o,  o from the other's centre to C;  P = A + r o   (inside: C + R o)
#     wheel on a ball      the same, of the tyre's section about the place of its centre line nearest to A
#     point on a line      P, and its foot on the line
#
# The contact acts there: a unit lam pushes with 1 N along the normal, rows that hold or brake act across it
# with 1 N across it, both at P and opposite on both bodies. That the rows' wrenches are such is looked at too.


Y, Z = Vector((0, 1, 0)), Vector((0, 0, 1))


@dataclass(frozen=True)
class Touch:
    """Contact of two surfaces at a state.

    Args:
        first, second: the nearest points of both, ground axes.
        held: directions in which they cannot part, ground axes.
    """

    first: Vector
    second: Vector
    held: tuple[Vector, ...]


@dataclass(frozen=True)
class _Form:
    """Surface that touches, in numbers: a ball, a wheel about an axis (ground axes) with a tyre, or an ellipsoid."""

    radius: Any
    tube: Any = 0
    axis: Vector | None = None
    semiaxes: Vector | None = None


def meetings_of(system: System) -> dict[str, Meeting]:
    """Pairs of surfaces that touch, by the name of the constraint, for every closed constraint."""
    closed = {row.constraint for row in system.constraints.rows}
    constraints = system.scope.model.constraints
    found = {name: constraints[name].meeting() for name in constraints if name in closed}
    return {name: x for name, x in found.items() if x is not None}


def apart(system: System, state: State) -> str:
    """Message that names a contact which does not touch, or opens, at a state; "".

    Raises:
        NoValue: something has no value there, or the constraints do not hold.
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
        distance = touch.first - touch.second
        size = 1 + touch.first.largest
        if distance.largest > tolerances.COMPUTED * size:
            return "its two points of contact are apart"
        slip = self.velocity(self._body, touch.first) - self.velocity(self.meeting.on, touch.first)
        held = (slip,) if self.meeting.sticks else tuple(slip @ e * e for e in touch.held)
        if self._rigid and any(abs(x) > tolerances.COMPUTED * (1 + size) for part in held for x in part):
            return "its two points of contact part or slip"
        return self._wrong_force(touch)

    def _wrong_force(self, touch: Touch) -> str:
        """Message that names a force of the contact which is no unit force at its point, normal or tangential; ""."""
        for row in self.system.constraints.rows:
            if row.constraint != self.name:
                continue
            for label, loads in ((row.component, row.pushes), ("t", row.tangent), ("s", row.cross_tangent)):
                if label and self._misplaced(touch, label, pushes_of(self.motion, self.state, loads)):
                    return f"its force '{label}' is not of 1 N at the contact, in its direction"
        return ""

    def _misplaced(self, touch: Touch, label: str, pushes: Pushes) -> bool:
        """True if pushes are not a unit force at the contact on its body, and the opposite one on the other."""
        forces = []
        for body, (moment, f) in pushes.items():
            about_contact = moment - touch.first.cross(f)
            if about_contact.largest > tolerances.COMPUTED * (1 + touch.first.largest):
                return True
            forces.append(f if body == self._body else -f)
        return any(self._misdirected(touch, label, f) for f in forces)

    def _misdirected(self, touch: Touch, label: str, f: Vector) -> bool:
        """True if a force on the first body is not of length 1, or not in its direction."""
        along = sum((f @ e) ** 2 for e in touch.held)
        wrong: list[Any] = [f @ f - 1, along - 1 if label[0] == "n" else along]
        if self.meeting.line is None:
            n = touch.held[0]
            wrong += [f @ n - 1] if label == "n" else []
            if not self._space and label == "t":
                wrong += f - Vector((n[1], -n[0], 0))
        return any(abs(x) > tolerances.COMPUTED for x in wrong)

    @property
    def _scene(self) -> SystemScene:
        return SystemScene(self.motion, f"constraints.{self.name}")

    @property
    def _body(self) -> str | None:
        ball, point = self.meeting.ball, self.meeting.point
        return self._scene.place(point)[0] if ball is None else ball.body

    @property
    def _rigid(self) -> bool:
        """True if point and surface are fixed in their bodies: else velocities of material points are others."""
        touching = self.meeting
        own = self._scene.place(touching.point)[1] if touching.ball is None else Vector.ZERO
        seats = [own, self._anchor] if touching.flat or touching.round else [own]
        return not any(self.motion.moves(tuple(seat)) for seat in seats)

    @cached_property
    def _anchor(self) -> Vector:
        """Place `at` of the surface in its body's axes, over the graph; by default the point's place at the start."""
        surface = self.meeting.flat or self.meeting.round
        assert surface is not None
        if surface.at is not None:
            return self._scene.ground_place(surface.at)
        if self.meeting.round is not None:
            return Vector.ZERO
        return Vector(map(self._scene.start, self._scene.position(self._scene.place(self.meeting.point))))

    @property
    def _center(self) -> Vector:
        """The point, or the centre of a round surface, ground axes."""
        ball, scene = self.meeting.ball, self._scene
        place = scene.place(self.meeting.point) if ball is None else scene.own_place(ball.body, ball.center)
        return self.carried(place[0], self.vector(place[1]))

    @cached_property
    def _form(self) -> _Form:
        """Surface that touches; sizes that are not declared are those of the body's shape."""
        what, scene = self.meeting.ball, self._scene
        if what is None:
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
        C, groove, line, flat = self._center, self.meeting.groove, self.meeting.line, self.meeting.flat
        if groove is not None:
            normal = Z if groove.normal is None else self.vector(self._scene.vector(groove.normal))
            edge = self.carried(groove.on, self.vector(self._scene.vector(groove.along)), direction=True)
            return Touch(C, C, (direction_at(normal.cross(edge)),))
        if line is not None:
            a, b = (self.carried(line, self.vector(r)) for _, r in self._scene.line(line))
            along = direction_at(b - a)
            foot = a + along @ (C - a) * along
            return Touch(C, foot, tuple(_across(along)) if self._space else (_quarter_turn(along),))
        A = self.carried(self.meeting.on, self.vector(self._anchor))
        if flat is not None:
            normal = self.vector(self._scene.vector(flat.normal))
            n = direction_at(self.carried(flat.on, normal, direction=True))
            P = self._lowest(C, n)
            return Touch(P, P - n @ (P - A) * n, (n,))
        return self._on_round(C, A)

    def _on_round(self, C: Vector, A: Vector) -> Touch:
        """A ball, or the section of a tyre where its centre line is nearest, on a ball or pipe about A."""
        surface = self.meeting.round
        assert surface is not None
        form, side = self._form, -1 if surface.inside else 1
        if form.axis is not None:
            h = C - A - (C - A) @ form.axis * form.axis
            C = C - side * form.radius * direction_at(h)
        if surface.axis is not None:
            axis = self.vector(self._scene.vector(surface.axis))
            a = direction_at(self.carried(surface.on, axis, direction=True))
            A = A + (C - A) @ a * a
        out = direction_at(C - A)
        r = self._scene.radius(str(surface.on)) if surface.radius is None else self._scene.value(surface.radius)
        section = form.radius if form.axis is None else form.tube
        first, second = C - side * section * out, A + self.one(r) * out
        return Touch(first, second, (side * out,))

    def _lowest(self, C: Vector, n: Vector) -> Vector:
        """The point of a round body that is farthest along -n."""
        form, body = self._form, self._body
        if form.semiaxes is not None:
            axes = [self.carried(body, e, direction=True) for e in (Vector((1, 0, 0)), Y, Z)]
            x = direction_at(Vector(-s * (n @ e) for s, e in zip(form.semiaxes, axes, strict=True)))
            for s, k, e in zip(form.semiaxes, x, axes, strict=True):
                C = C + s * k * e
            return C
        d = n if form.axis is None else direction_at(n - form.axis @ n * form.axis)
        lowest: Vector = C - d * form.radius - n * form.tube
        return lowest

    @property
    def _space(self) -> bool:
        return self.system.scope.model.space == "space"


def _quarter_turn(a: Vector) -> Vector:
    return Vector((-a[1], a[0], 0))


def _across(a: Vector) -> Iterator[Vector]:
    """Two unit vectors across a unit vector."""
    lengths: list[Any] = [abs(x) for x in a]
    k = lengths.index(min(lengths))
    first = direction_at(a.cross(Vector(int(i == k) for i in range(3))))
    yield first
    yield a.cross(first)
