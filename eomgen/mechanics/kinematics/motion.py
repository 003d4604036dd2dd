"""Scope -> Motion: pose and twist of every body, over the scalars of the graph."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import replace
from functools import cached_property
from typing import Any

from eomgen.errors import DerivationError, NotYet
from eomgen.frozen import dataclass
from eomgen.mechanics.kinematics.symbols import Scope, shorter
from eomgen.model import Couple, PointForce
from eomgen.symbolic.exact import vanishes
from eomgen.symbolic.expression import (
    Fraction,
    Matrix,
    Node,
    Pose,
    Scalar,
    Twist,
    Vector,
    Wrench,
    collected,
    cos,
    depends_on,
    derivative,
    function,
    is_zero,
    jacobian,
    over,
    sin,
    sqrt,
    substituted,
    symbols_of,
)

# -------- kinematics ------------------------------------------------------------------------------------------
# Scope -> Motion: where every body is and how it moves, over the scalars of the graph.
#
# Bodies hang in a tree. The joint of body i gives its variables s(q, t), the pose X(s) of the child's joint frame and
# the subspace S, so that the twist of the child at its own origin, in its own axes, is
#
#     xi_i = Ad(parent -> i) xi_parent + S s',      s' = D u + d.
#
# Two descriptions of velocity stay separate on purpose: the twists of this recursion, and the time derivatives of the
# poses. The certificate compares them.


GROUND = -1


@dataclass(frozen=True)
class BodyLink:
    """One body in the tree.

    Args:
        name: the body's name.
        parent: index of the parent link, GROUND for the ground.
        joint: the model's joint (None: the ground's frame).
        before: where the joint sits in the parent's frame (`at`, `turned`).
        point: where the joint sits in this body, body axes, 3 [m].
        s, s_rate: the joint's variables and s' = D u + d; of a quaternion the angular velocity in place of its rates.
        relative: the joint's pose at s.
        S: columns of the subspace, each (w, v), at the joint point, child's axes.
        pose: of the body's frame in the ground.
        angle: against the ground's axes (plane only) [rad].
        twist: at the body's origin, body axes.
    """

    name: str
    parent: int
    joint: Any
    before: Pose
    point: Vector
    s: tuple[Scalar, ...]
    s_rate: tuple[Scalar, ...]
    relative: Pose
    S: tuple[tuple[Vector, Vector], ...]
    pose: Pose
    angle: Scalar | None
    twist: Twist

    @property
    def local(self) -> Pose:
        """Pose of the child's axes and of the joint point, in the parent."""
        return self.before.then(self.relative)

    @property
    def orientation(self) -> tuple[Scalar, ...]:
        """Orientation of a body: its angle in the plane, the entries of its rotation matrix in space."""
        return (self.angle,) if self.angle is not None else tuple(x for row in self.pose.R for x in row)

    def spin(self, rates: list[Scalar]) -> Vector:
        """Angular velocity in body axes from the rates of the orientation [rad/s]."""
        if self.angle is not None:
            return Vector((0, 0, rates[0]))
        return spin_between(self.pose.R, Matrix.of((rates[0:3], rates[3:6], rates[6:9])))

    def pushed_along(self, variable: int, magnitude: Scalar) -> tuple[Vector, Vector]:
        """(force, couple) along a joint's variable that do the work magnitude * s', child's axes, and none on others.

        They lie in the span of the joint's axes: d_k . S_j = 1 of j = k, else 0.
        """
        w, v = self.S[variable]
        turning = not all(is_zero(x) for x in w)
        others = [
            column[0 if turning else 1]
            for j, column in enumerate(self.S)
            if j != variable and turning != all(is_zero(x) for x in column[0])
        ]
        push = _without_work(magnitude, w if turning else v, others)
        return (Vector.ZERO, push) if turning else (push, Vector.ZERO)

    @property
    def is_placed(self) -> bool:
        """True if a body stands where the model places it, without a joint that carries a reaction."""
        return self.joint is None or not self.joint.carries_reaction


def _without_work(magnitude: Scalar, n: Vector, others: Sequence[Vector]) -> Vector:
    """The vector d in the span of n and the others with d . n = magnitude that is normal to the others."""
    if all(is_zero(n @ other) for other in others):
        return _over(magnitude, n @ n) * n
    if len(others) == 1:
        (other,) = others
        d = other @ other * n - n @ other * other
    else:
        d = others[0].cross(others[1])
    found: Vector = _over(magnitude, n @ d) * d
    return found


def _over(magnitude: Scalar, square: Scalar) -> Scalar:
    return magnitude if type(square) is int and square == 1 else over(magnitude, square)


@dataclass(frozen=True)
class Motion:
    """Poses and twists of all bodies, parents before children."""

    scope: Scope
    links: tuple[BodyLink, ...]

    @cached_property
    def index(self) -> dict[str, int]:
        """The place of each body in `links`."""
        return {link.name: i for i, link in enumerate(self.links)}

    def link(self, body: str) -> BodyLink:
        return self.links[self.index[body]]

    @cached_property
    def decided(self) -> dict[Node, None]:
        """Scalars by whose values at the start loads and constraints chose between two formulas (`value_at_start`).

        Keys of a table; they are added while the loads and constraints are derived.
        """
        return {}

    @cached_property
    def points(self) -> dict[str, dict[str, Vector]]:
        """Points of each body, body axes [m]."""
        return {link.name: body_points(self.scope, link.name) for link in self.links}

    def carrier_of(self, first: str | None, second: str | None) -> str | None:
        """The nearest body that carries both, itself among those that carry it; None: only the ground does."""
        carriers = self._carriers(second)
        return next((body for body in self._carriers(first) if body in carriers), None)

    def _carriers(self, body: str | None) -> list[str]:
        """The body, and those it hangs on, the nearest first."""
        found: list[str] = []
        place = GROUND if body is None else self.index[body]
        while place != GROUND:
            found.append(self.links[place].name)
            place = self.links[place].parent
        return found

    def seen_from(self, body: str) -> Motion:
        """Poses and twists of what a body carries, against that body; others stay as the ground sees them."""
        if body not in self._seen:
            self._seen[body] = _seen_from(self, self.index[body])
        return self._seen[body]

    @cached_property
    def _seen(self) -> dict[str, Motion]:
        return {}

    def moves(self, scalars: tuple[Scalar, ...]) -> bool:
        """True if any of the scalars depends on coordinates or time."""
        moving = {*self.scope.symbols.q, self.scope.symbols.t}
        return any(symbol in moving for symbol in symbols_of(scalars))

    def place(self, point: str) -> tuple[str | None, Vector]:
        """(body, position in its axes) of a named point; (None, position) for a point of the ground."""
        body, name = self.scope.model.resolve_point(point)
        if body is None:
            return None, self.scope.vector(self.scope.model.points[name])
        return body, self.points[body][name]

    def position(self, place: tuple[str | None, Vector]) -> Vector:
        """The place seen from the ground, 3 [m]."""
        body, r = place
        return r if body is None else self.link(body).pose.point(r)

    @cached_property
    def B(self) -> tuple[tuple[tuple[Scalar, ...], ...], ...]:
        """The 6 rows of B of each body, xi = B u + beta (angular first, body origin, body axes)."""
        twists = [x for link in self.links for x in (*link.twist.w, *link.twist.v)]
        rows = jacobian(tuple(twists), self.scope.symbols.u)
        return tuple(tuple(rows[6 * i : 6 * i + 6]) for i in range(len(self.links)))

    @cached_property
    def alpha(self) -> tuple[tuple[Scalar, ...], ...]:
        """The 6 entries of alpha of each body, xi' = B a + alpha."""
        twists = [x for link in self.links for x in (*link.twist.w, *link.twist.v)]
        rates = self.scope.time_derivative(tuple(twists))
        return tuple(tuple(rates[6 * i : 6 * i + 6]) for i in range(len(self.links)))

    def field(self, body: str) -> VelocityField:
        """The field of a body of the model; of the ground it is zero."""
        if body not in self.index:
            return VelocityField()
        link, scope = self.link(body), self.scope
        v = scope.rate_of(link.pose.p)
        w = link.twist.w if link.angle is not None else link.pose.R @ link.twist.w
        rates = scope.with_accelerations((*v, *w))
        return VelocityField(link.pose.p, v, Vector(rates[:3]), w, Vector(rates[3:]))

    def velocity(self, place: tuple[str | None, Vector]) -> Vector:
        """Velocity of a place of a body in ground axes, from the twist: R (v + w x r + r') [m/s]."""
        body, r = place
        if body is None:
            return Vector.ZERO
        link = self.link(body)
        carried = link.pose.R @ (link.twist.v + link.twist.w.cross(r))
        return carried + self.slide(place) if self.moves(r) else carried

    def slide(self, place: tuple[str | None, Vector]) -> Vector:
        """Velocity of a place against its own body, ground axes: R r', 0 where it is fixed in the body [m/s]."""
        body, r = place
        if body is None or not self.moves(r):
            return Vector.ZERO
        return self.link(body).pose.R @ self.scope.rate_of(r)

    @property
    def locks(self) -> tuple[Lock, ...]:
        """Gimbal locks of the bodies that turn by three angles, at least one of them free to change."""
        found = []
        for link in self.links:
            sequence = getattr(link.joint, "orientation", None)
            if sequence is None or sequence == "quaternion":
                continue
            angles = link.s[-3:]
            if any(depends_on(rate, self.scope.symbols.u) for rate in link.s_rate[-3:]):
                found.append(Lock(link.name, sin(angles[1]) if sequence[0] == sequence[2] else cos(angles[1])))
        return tuple(found)

    # -- vectors and wrenches ----------------------------------------------------------------------

    def in_ground_axes(self, vector: Vector, axes: str | None) -> Vector:
        """A vector given in the axes of a body, in the ground's."""
        return vector if axes is None else self.link(axes).pose.R @ vector

    def in_body_axes(self, body: str, vector: Vector, axes: str | None) -> Vector:
        """A vector given in the axes of the ground (None) or of a body, in the axes of `body`."""
        if axes == body:
            return vector
        return self.link(body).pose.R.T @ self.in_ground_axes(vector, axes)

    def body_wrench(self, load: PointForce | Couple) -> tuple[str, Wrench] | None:
        """A load as a wrench at its body's origin in body axes (None: it acts on the ground)."""
        if isinstance(load, Couple):
            return load.body, Wrench(self.in_body_axes(load.body, load.couple, load.axes), Vector.ZERO)
        body, r = load.place
        if body is None:
            return None
        f = self.in_body_axes(body, load.force, load.axes)
        return body, Wrench(r.cross(f), f)

    def spin(self, link: BodyLink) -> Vector:
        """Angular velocity of one body in body axes, from the derivative of its pose [rad/s]."""
        return link.spin(list(self.scope.time_derivative(link.orientation)))

    def joint_row(self, body: str, variable: int) -> dict[int, Scalar]:
        """Row of D: how the joint's rate depends on each speed."""
        rate = self.link(body).s_rate[variable]
        speeds = {u: k for k, u in enumerate(self.scope.symbols.u)}
        return {speeds[s]: derivative(rate, s) for s in symbols_of((rate,)) if s in speeds}

    def slide_power(self, push: PointForce) -> Scalar:
        """Power of a push on a point that moves in its body: F . R r'."""
        return self.in_ground_axes(push.force, push.axes) @ self.slide(push.place)

    def power(self, pushes: Iterable[PointForce | Couple], *, material: bool = True) -> Scalar:
        """Power of pushes, that on points which move in their bodies among it unless they act on the material."""
        total: Scalar = 0
        for push in pushes:
            found = self.body_wrench(push)
            total = total if found is None else total + self.link(found[0]).twist.power(found[1])
            if not material and isinstance(push, PointForce):
                total = total + self.slide_power(push)
        return total

    def is_particle(self, link: BodyLink) -> bool:
        """A point mass that its joint does not turn."""
        shape = self.scope.model.bodies[link.name].shape
        turns = any(not is_zero(x) for w, _ in self.joint_columns(link) for x in w)
        return shape is not None and shape.is_point and (link.is_placed or not turns)

    def joint_columns(self, link: BodyLink) -> tuple[tuple[Vector, Vector], ...]:
        """The columns of S along which the joint moves."""
        if len(link.S) != len(link.s):  # of a quaternion
            return link.S
        return tuple(column for column, s in zip(link.S, link.s, strict=True) if self.moves((s,)))

    @staticmethod
    def of(scope: Scope) -> Motion:
        """Poses and twists of every body of the model.

        Raises:
            DerivationError: a joint whose place depends on an input.
            NotYet: a joint kind that this version does not derive.
        """
        links: list[BodyLink] = []
        index: dict[str, int] = {}
        for name in parents_first(scope.model):
            link = _link(scope, name, links, index)
            index[name] = len(links)
            links.append(link)
        return Motion(scope, tuple(links))


def parents_first(model: Any) -> list[str]:
    """The bodies, every one after the one it hangs on, else in the model's order."""
    done: dict[str, None] = {}
    waiting = list(model.bodies)
    while waiting:
        ready = [name for name in waiting if parent_of(model, name) in (None, *done)]
        if not ready:
            raise DerivationError(
                f"bodies hang on one another in a ring: {', '.join(waiting)}",
                fix="hang one of them on the ground, and close the loop by a constraint",
            )
        for name in ready:
            done[name] = None
        waiting = [name for name in waiting if name not in done]
    return list(done)


def parent_of(model: Any, body: str) -> str | None:
    """The body on which this one hangs (None: the ground)."""
    joint = model.bodies[body].joint
    return None if joint is None else joint.parent


def body_points(scope: Scope, body: str) -> dict[str, Vector]:
    """Points of one body: its own, its shape's, `origin`, and `center` where it has mass; body axes [m]."""
    part = scope.model.bodies[body]
    points: dict[str, Vector] = {"origin": Vector.ZERO}
    if part.parts is not None:
        points["center"] = scope.made_of(body).whole.com
    elif part.center is not None or part.mass is not None:
        points["center"] = scope.vector(part.center)
    if part.shape is not None:
        points |= part.shape.points(scope.value)
    points |= {name: scope.vector(place) for name, place in part.points.items()}
    return points


def _link(scope: Scope, name: str, links: list[BodyLink], index: dict[str, int]) -> BodyLink:
    joint = scope.model.bodies[name].joint
    if joint is not None and not joint.works_in(scope.model.space):
        raise NotYet(
            f"the joint '{joint.kind}' is not derived yet",
            f"bodies.{name}.joint",
            fix="declare it by joints that are: see eomgen schema",
        )
    plane = scope.model.space == "plane"
    if joint is None:
        return BodyLink(
            name, GROUND, None, Pose(), Vector.ZERO, (), (), Pose(), (), Pose(), 0 if plane else None, Twist()
        )
    parent_name = parent_of(scope.model, name)
    parent = GROUND if parent_name is None else index[parent_name]
    above = None if parent == GROUND else links[parent]
    before = Pose(joint.orientation_before(scope.value), _seat(scope, joint))
    point = Vector.ZERO if joint.point is None else body_points(scope, name)[joint.point]
    s = tuple(scope.value(e) for e in joint.variables(scope.model.space))
    s_rate = (*scope.time_derivative(s[: -4 if joint.spins else None]), *(scope.names[w] for w in joint.spins))
    relative = joint.pose(s, scope.value)
    S = tuple((Vector(column[:3]), Vector(column[3:])) for column in joint.subspace(s, scope.value))
    local = before.then(relative)
    angle = None
    if plane:
        turned = _turned_angle(scope, joint) + joint.turn(s, scope.value)
        angle = collected((above.angle if above else 0) + turned)
    pose = _pose(above, local, angle, point)
    twist = _twist(scope, above, before, local, s_rate, S, point)
    return BodyLink(name, parent, joint, before, point, s, s_rate, relative, S, pose, angle, twist)


def _seen_from(motion: Motion, carrier: int) -> Motion:
    """The motion with a body in the place of the ground, of all that hangs on it."""
    links, scope = list(motion.links), motion.scope
    turned = links[carrier].angle
    links[carrier] = replace(links[carrier], pose=Pose(), angle=None if turned is None else 0, twist=Twist())
    carried = {carrier}
    for i, link in enumerate(motion.links):
        if link.parent not in carried:
            continue
        carried.add(i)
        above = links[link.parent]
        angle = None if link.angle is None or turned is None else collected(link.angle - turned)
        twist = _twist(scope, above, link.before, link.local, link.s_rate, link.S, link.point)
        links[i] = replace(link, pose=_pose(above, link.local, angle, link.point), angle=angle, twist=twist)
    return Motion(scope, tuple(links))


def _pose(above: BodyLink | None, local: Pose, angle: Scalar | None, point: Vector) -> Pose:
    """The child's frame in the ground; in the plane its rotation is that by its whole angle."""
    joint = (above.pose if above else Pose()).then(local)
    R = joint.R if angle is None else Matrix.rotation(Matrix.IDENTITY[2], cos(angle), sin(angle))
    return Pose(R, joint.p - R @ point)


def _twist(
    scope: Scope,
    above: BodyLink | None,
    before: Pose,
    local: Pose,
    s_rate: tuple[Scalar, ...],
    S: tuple[tuple[Vector, Vector], ...],
    point: Vector,
) -> Twist:
    """Twist of the child at its origin, child's axes; a seat that moves by itself adds its rate."""
    R_CP = local.R.T
    carried = (above.twist if above else Twist()).at(local.p)
    seat_rate = scope.rate_of(before.p)
    at_joint = Twist(R_CP @ carried.w, R_CP @ (carried.v + seat_rate))
    for rate, (w, v) in zip(s_rate, S, strict=True):
        at_joint = at_joint.plus(Twist(rate * w, rate * v))
    moved = at_joint.at(-point)
    drift = scope.rate_of(point)  # a joint that slides along its own body
    twist = Twist(moved.w, moved.v - drift)
    return shortened_twist(twist) if scope.combines else twist


def shortened_twist(twist: Twist) -> Twist:
    """A twist in its shorter form: declared speeds often are its components, once the rates are put in."""
    return Twist(Vector(map(shorter, twist.w)), Vector(map(shorter, twist.v)))


def _turned_angle(scope: Scope, joint: Any) -> Scalar:
    """Angle of the fixed rotations before the joint in the plane, all of them about z."""
    return sum((scope.value(turn.angle) for turn in joint.turned or ()), start=0)


def _seat(scope: Scope, joint: Any) -> Vector:
    """Position of the joint, parent's axes: `at`, or the parent's point named by `on`."""
    on = joint.on
    if on is not None and "." in on:
        body, point = on.split(".", 1)
        return body_points(scope, body)[point]
    return scope.ground_place(joint.at) if joint.seated else Vector.ZERO


def spin_between(R: Matrix, R_rate: Matrix) -> Vector:
    """Angular velocity in body axes from a rotation and its time derivative: w~ = R^T R'."""
    W = R.T @ R_rate
    return Vector((W[2][1], W[0][2], W[1][0]))


# -------- gimbal ----------------------------------------------------------------------------------------------
# Motion -> Locks: where three angles do not say how a body turns (gimbal lock).
#
# The columns of S of three angles have the determinant sin(b) (zxz and its like) or cos(b) (xyz and its like), b the
# second angle. Where it vanishes two of the axes are one, and the rates of the angles are not determined.


@dataclass(frozen=True)
class Lock:
    """Gimbal lock of the three angles of a body: the determinant of their axes is zero there."""

    body: str
    determinant: Scalar

    def __str__(self) -> str:
        return f"the three angles of '{self.body}' do not determine how it turns"


# -------- field -----------------------------------------------------------------------------------------------
# Motion -> Field: velocities and accelerations of all points of one rigid body, ground axes.
#
#     v_P = v_O + omega x r,      a_P = a_O + epsilon x r + omega x (omega x r),      r from O to P
#
# O is the origin of the body's frame. Accelerations hold the symbols a and are linear in them.


UP: Vector = Vector((0, 0, 1))


@dataclass(frozen=True)
class VelocityField:
    """The motion of one rigid body at a state, ground axes.

    Args:
        p, v, a: place, velocity and acceleration of its origin, 3.
        w, e: angular velocity and acceleration, 3.
    """

    p: Vector = Vector.ZERO
    v: Vector = Vector.ZERO
    a: Vector = Vector.ZERO
    w: Vector = Vector.ZERO
    e: Vector = Vector.ZERO

    def velocity(self, place: Vector) -> Vector:
        """v = v_O + omega x r of the point of the body that is now at the place [m/s]."""
        return self.v + self.w.cross(place - self.p)

    def acceleration(self, place: Vector) -> Vector:
        """a = a_O + epsilon x r + omega x (omega x r) of the point of the body that is now at the place [m/s^2]."""
        return self.a + (self.angular(place) + self.centripetal(place))

    def angular(self, place: Vector) -> Vector:
        """epsilon x r [m/s^2]"""
        return self.e.cross(place - self.p)

    def centripetal(self, place: Vector) -> Vector:
        """omega x (omega x r) [m/s^2]"""
        return self.w.cross(self.w.cross(place - self.p))

    def at(self, state: Mapping[Node, Scalar]) -> VelocityField:
        """The field with the state's values put in."""
        if not state:
            return self
        vectors = (self.p, self.v, self.a, self.w, self.e)
        flat = iter(substituted([x for vector in vectors for x in vector], state))
        return VelocityField(*(Vector(next(flat) for _ in range(3)) for _ in vectors))

    def against(self, other: VelocityField) -> VelocityField:
        """The field of velocities that another body sees, in ground axes: v - v_other, omega - omega_other."""
        return replace(self, v=self.v - other.velocity(self.p), w=self.w - other.w)

    # -- points and lines --------------------------------------------------------------------------

    def rotation_center(self) -> Vector:
        """Instantaneous centre of rotation in the plane, the point without velocity: p_O + omega x v_O / omega^2.

        Raises:
            DerivationError: omega = 0 in every motion: the body translates or is at rest.
        """
        if vanishes(self.w[2]):
            state = "rests" if all(vanishes(x) for x in self.v) else "translates"
            raise DerivationError(
                f"the body {state}: it has no centre of rotation at a finite place",
                fix="choose a state in which the body turns",
            )
        center: Vector = self.p + UP.cross(self.v) * over(1, self.w[2])
        return center

    def acceleration_pole(self) -> Vector:
        """Acceleration pole in the plane, the point without acceleration.

        p_O + (omega^2 a_O + epsilon x a_O)/(omega^4 + epsilon^2)

        Raises:
            DerivationError: omega = epsilon = 0: all points have the same acceleration.
        """
        w, e = self.w[2], self.e[2]
        if vanishes(w) and vanishes(e):
            raise DerivationError(
                "omega = epsilon = 0: all points of the body have the same acceleration, it has no pole",
                fix="choose a state in which the body turns",
            )
        arm = w * w * self.a + self.e.cross(self.a)
        center: Vector = self.p + arm * over(1, w * w * w * w + e * e)
        return center

    def axis_point(self) -> Vector:
        """Point of the screw axis nearest to the origin of the body, p_O + omega x v_O / omega.omega, in space."""
        return self.p + over(1, self.w @ self.w) * self.w.cross(self.v)

    def least_speed(self, start: Vector, end: Vector, short: Callable[[Scalar], Scalar]) -> Scalar:
        """The least speed of the points between two points of the body.

        Along the segment only the component of v along h = omega x (end - start) changes, linearly from a to b:
            v^2 = v_0^2 + max(0, min(a, b), min(-a, -b))^2
        with v_0 the part of v across h. In the plane h is across the segment, and v_0 is the component along it:
        nothing is divided by omega.

        Args:
            start, end: the places of the two points.
            short: puts a scalar into readable form.
        Raises:
            DerivationError: they are the same.
        """
        along = end - start
        if all(vanishes(x) for x in along):
            raise DerivationError(
                "the two points are the same: they have no segment between them", fix="name two points that are apart"
            )
        v_start, v_end = self.velocity(start), self.velocity(end)
        planar = vanishes(self.w[0]) and vanishes(self.w[1]) and vanishes(along[2]) and vanishes(self.v[2])
        h = UP.cross(along) if planar else self.w.cross(along)
        if all(vanishes(x) for x in h):
            return sqrt(v_start @ v_start)
        square, a, b = short(h @ h), short(v_start @ h), short(v_end @ h)
        rest = short(v_start @ v_start - over(a * a, square))
        if vanishes(a) or vanishes(b):
            return sqrt(rest)
        either = (function("max", 0, function("min", x, y)) for x, y in ((a, b), (-a, -b)))
        nearest = short(function("max", *either))
        return sqrt(rest + over(nearest * nearest, square))

    def inflection_center(self) -> Vector:
        """The centre of the circle through the centre of rotation on which the points are whose path is straight there.

        In the plane, with r from the centre of rotation, whose acceleration is a_P:  r^2 = r . a_P / omega^2.
        """
        pole = self.rotation_center()
        center: Vector = pole + self.acceleration(pole) * over(Fraction(1, 2), self.w[2] * self.w[2])
        return center


# -- points and lines of a field -------------------------------------------------------------------
