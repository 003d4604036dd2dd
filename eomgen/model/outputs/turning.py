"""Orientation and rotation of bodies, centres of rotation, and motion of points relative to moving bodies.

angle, omega, epsilon: orientation and rotation of a body, relative to the ground or another body.

By the second way from the rotation alone: with R from the body's axes to those of `frame`, omega~ = R' R^T and
epsilon~ = R'' R^T + R' R'^T, R' and R'' by differences.
"""

from __future__ import annotations

from collections.abc import Callable
from functools import partial
from typing import Any

from eomgen.errors import DerivationError
from eomgen.model.outputs.base import GROUND, OutputContext, OutputFunction, PartsOfMotion, SecondOf, Trial, component
from eomgen.model.outputs.points import (
    SeenVector,
    VectorOf,
    axes_at,
    components,
    differences,
    length,
    magnitude,
    seen_from,
    turned,
)
from eomgen.symbolic.expression import Call, Matrix, Scalar, Vector, sqrt
from eomgen.symbolic.numeric import fifty_digits

BODY = ("body", "body")


def _angle(scene: OutputContext, body: str, frame: str = GROUND) -> Scalar:
    """phi_body - phi_frame, in the plane [rad]."""
    for name in (body, frame):
        if not scene.is_plane:
            raise DerivationError(
                f"body '{name}' has no single angle in space", fix="ask for omega_x, omega_y, omega_z of it"
            )
    return scene.angle(body) - scene.angle(frame)


def _angle_of_axes(trial: Trial, body: str, frame: str = GROUND) -> Any:
    """The angle between the x axes of both, with as many whole turns as coordinates count."""
    scene, x, y = trial.scene, 0, 1
    own, sides = (axes_at(trial, name).T if name in scene.bodies else Matrix.IDENTITY for name in (body, frame))
    sine, cosine = own[x] @ sides[y], own[x] @ sides[x]
    (counted,), _, _ = trial.along((scene.angle(body) - scene.angle(frame),))
    angle = fifty_digits().functions["atan2"](sine, cosine)
    turn = 2 * fifty_digits().functions["pi"]()
    return angle + turn * round((counted - angle) / turn)


def _spin(scene: OutputContext, body: str, frame: str = GROUND, *, order: int) -> Vector:
    """omega (order 1) or epsilon (2), ground axes or those of `frame`."""
    w = scene.spin(body)
    if frame in scene.bodies:
        w = scene.axes(frame).T @ (w - scene.spin(frame))
    return w if order == 1 else scene.acceleration(w)


def _turned(trial: Trial, body: str, frame: str = GROUND, *, order: int) -> Vector:
    """The same by differences of the rotation."""
    R, R1, R2 = _rotations(trial, body, frame)
    W = R1 @ R.T if order == 1 else R2 @ R.T + R1 @ R1.T
    return Vector((W[2][1], W[0][2], W[1][0]))


def _rotations(trial: Trial, body: str, frame: str) -> list[Matrix]:
    """R from the axes of the body to those of the frame, and its first and second rate."""
    scene = trial.scene
    rows = scene.axes(frame).T @ scene.axes(body)
    return [Matrix.of((x[0:3], x[3:6], x[6:9])) for x in trial.along([x for row in rows for x in row])]


def _own_axis(call: Call) -> int:
    return int(call.name[-1]) - 1


def _one(name: str, unit: str, gives: str, order: int) -> OutputFunction:
    """The output function of a rate of rotation: in the plane counter-clockwise positive; in space the magnitude."""

    def value(scene: OutputContext, call: Call) -> Scalar:
        w = _spin(scene, *call.names, order=order)
        return w[2] if scene.is_plane else sqrt(w @ w)

    def second(trial: Trial, call: Call) -> Any:
        w = _turned(trial, *call.names, order=order)
        return w[2] if trial.scene.is_plane else length(trial, w)

    return OutputFunction(
        names=(name,), kinds=BODY, least=1, unit=unit, gives=gives, value=value, second=second, moves=True
    )


def _components(names: str, unit: str, order: int) -> OutputFunction:
    gives = "its components, ground axes; against a body: its axes"
    return components(names, unit, gives, partial(_spin, order=order), partial(_turned, order=order), BODY, least=1)


def _about_own_axes(name: str, unit: str, order: int) -> OutputFunction:
    """The components of R^T w along the axes of the body itself, 1, 2 and 3, as Euler's equations have them."""

    def value(scene: OutputContext, call: Call) -> Scalar:
        (body,) = call.names
        found: Scalar = (scene.axes(body).T @ _spin(scene, body, order=order))[_own_axis(call)]
        return found

    def second(trial: Trial, call: Call) -> Any:
        (body,) = call.names
        R, *_ = _rotations(trial, body, GROUND)
        return (R.T @ _turned(trial, body, order=order))[_own_axis(call)]

    return OutputFunction(
        names=tuple(f"{name}_{k}" for k in (1, 2, 3)),
        kinds=BODY[:1],
        least=1,
        unit=unit,
        gives="its components along the body's own axes",
        value=value,
        second=second,
        moves=True,
    )


ANGLE = OutputFunction(
    names=("angle",),
    kinds=BODY,
    least=1,
    unit="rad",
    gives="angle, in the plane",
    value=lambda scene, call: _angle(scene, *call.names),
    second=lambda trial, call: _angle_of_axes(trial, *call.names),
)
OMEGA = _one("omega", "rad/s", "angular velocity; in space its magnitude", 1)
ANGULAR_VELOCITY = _components("omega_*", "rad/s", 1)
OWN_ANGULAR_VELOCITY = _about_own_axes("omega", "rad/s", 1)
EPSILON = _one("epsilon", "rad/s^2", "angular acceleration; in space its magnitude", 2)
ANGULAR_ACCELERATION = _components("epsilon_*", "rad/s^2", 2)
OWN_ANGULAR_ACCELERATION = _about_own_axes("epsilon", "rad/s^2", 2)


# -------- centers ---------------------------------------------------------------------------------------------
# rotation_center, acceleration_pole: the points of a body that have no velocity, or no acceleration, in the plane.
#
# By the second way from three points A, B, C of the body, not on a line: their velocities, or accelerations, are
# linear in the place, and c = A + x (B - A) + y (C - A) is where they vanish.


CORNERS: tuple[Vector, ...] = (Vector.ZERO, Vector((1, 0, 0)), Vector((0, 1, 0)))  # of a triangle in the body [m]


def _in_plane(scene: OutputContext, what: str, body: str) -> None:
    if not scene.is_plane:
        raise DerivationError(
            f"{what}({body}): it is defined in plane motion only", fix="ask for omega and v of a point in space"
        )


def _center(scene: OutputContext, body: str, other: str = GROUND) -> Vector:
    _in_plane(scene, "rotation_center", body)
    return scene.rotation_center(body, other)


def _pole(scene: OutputContext, body: str) -> Vector:
    _in_plane(scene, "acceleration_pole", body)
    return scene.acceleration_pole(body)


def _still_point(trial: Trial, order: int, body: str, other: str = GROUND) -> Vector:
    """Place at which the rate of a place in the other body's frame vanishes, ground axes."""
    scene = trial.scene
    places: list[Any] = []
    rates: list[Any] = []
    for corner in CORNERS:
        place = scene.origin(body) + scene.axes(body) @ corner
        seen = scene.axes(other).T @ (place - scene.origin(other))
        places.append(Vector(trial.along(place)[0]))
        rates.append(axes_at(trial, other) @ Vector(trial.along(seen)[order]))
    a: Any
    b: Any
    c: Any
    a, b, c = rates[0], rates[1] - rates[0], rates[2] - rates[0]
    area = b[0] * c[1] - b[1] * c[0]
    x, y = (a[1] * c[0] - a[0] * c[1]) / area, (a[0] * b[1] - a[1] * b[0]) / area
    first, second = (there - places[0] for there in places[1:])
    at: Vector = places[0] + (first * x + second * y)
    return at


def _center_by_poses(order: int) -> SecondOf:
    return lambda trial, call: _still_point(trial, order, *call.names)[component(call)]


ROTATION_CENTER = OutputFunction(
    names=("rotation_center_x", "rotation_center_y"),
    kinds=("body", "body"),
    least=1,
    unit="m",
    gives="in the plane, the point about which a body turns, against the ground or another body",
    value=lambda scene, call: _center(scene, *call.names)[component(call)],
    second=_center_by_poses(1),
    moves=True,
)
ACCELERATION_POLE = OutputFunction(
    names=("acceleration_pole_x", "acceleration_pole_y"),
    kinds=("body",),
    least=1,
    unit="m",
    gives="the point of the body that has no acceleration, in the plane",
    value=lambda scene, call: _pole(scene, *call.names)[component(call)],
    second=_center_by_poses(2),
    moves=True,
)


# -------- least speed -----------------------------------------------------------------------------------------
# least_speed: of the points between two points of one body.
#
# By the second way the velocities of both ends are differences of their places; between them v = v_A + s (v_B - v_A)
# is shortest at s = -v_A.(v_B - v_A)/|v_B - v_A|^2, or at an end.


def _least_speed(scene: OutputContext, start: str, end: str) -> Scalar:
    body, other = scene.body_of(start), scene.body_of(end)
    if body != other:
        what = f"least_speed({start}, {end}): '{start}' and '{end}' are points of two bodies"
        raise DerivationError(what, fix="name two points of one body")
    return scene.least_speed(body, *scene.here(scene.position(start), scene.position(end)))


def _least_by_places(trial: Trial, start: str, end: str) -> Any:
    first = differences(trial, start, order=1)
    change = differences(trial, end, order=1) - first
    square: Any = change @ change
    s: Any = min(1, max(0, -(first @ change) / square)) if square else 0
    return length(trial, first + s * change)


LEAST_SPEED = OutputFunction(
    names=("least_speed",),
    kinds=("point", "point"),
    least=2,
    unit="m/s",
    gives="of the points between two points of one body",
    value=lambda scene, call: _least_speed(scene, *call.names),
    second=lambda trial, call: _least_by_places(trial, *call.names),
    moves=True,
)


# -------- relative motion -------------------------------------------------------------------------------------
# The motion of a point on a moving body in its parts: transport, Coriolis, and what the transport consists of.
#
#     v_t = v_O + omega x r,   a_t = a_O + epsilon x r + omega x (omega x r),   a_C = 2 omega x v_r
#
# By the second way nothing turns but R: a point that stays in the body at r' = R^T r goes from p + R r' to p(t + h) +
# R(t + h) r', hence v_t and a_t; W = R' R^T gives W W r and (R'' R^T - W W) r; what is left of a is 2 W v_r.


PartOf = Callable[[PartsOfMotion], Vector]
SeenPart = Callable[[Trial, str, str], Vector]


def _carried(order: int) -> SeenPart:
    """Velocity (order 1) or acceleration (2) of the point of the body that the point passes."""

    def found(trial: Trial, point: str, body: str) -> Vector:
        held = Vector(trial.along(seen_from(trial.scene, point, body))[0])
        origin = trial.along(trial.scene.origin(body))[order]
        return Vector(origin) + axes_at(trial, body, order) @ held

    return found


def _turning(trial: Trial, point: str, body: str) -> tuple[Vector, Matrix]:
    """(r from the body's origin, W = R' R^T)."""
    R = axes_at(trial, body)
    held = Vector(trial.along(seen_from(trial.scene, point, body))[0])
    return R @ held, axes_at(trial, body, 1) @ R.T


def _centripetal(trial: Trial, point: str, body: str) -> Vector:
    r, W = _turning(trial, point, body)
    return W @ (W @ r)


def _euler(trial: Trial, point: str, body: str) -> Vector:
    r, _ = _turning(trial, point, body)
    whole = axes_at(trial, body, 2) @ axes_at(trial, body).T
    return whole @ r - _centripetal(trial, point, body)


def _coriolis(trial: Trial, point: str, body: str) -> Vector:
    """a - a_t - a_r"""
    relative = axes_at(trial, body) @ differences(trial, point, body, order=2)
    return differences(trial, point, order=2) - _carried(2)(trial, point, body) - relative


def _of(part: PartOf) -> VectorOf:
    """The part, ground axes or those of a body."""

    def law(scene: OutputContext, point: str, body: str, axes: str = "") -> Vector:
        return turned(scene, part(scene.parts_of_motion(point, body)), GROUND, axes)

    return law


def _seen(part: SeenPart) -> SeenVector:
    def second(trial: Trial, point: str, body: str, axes: str = "") -> Vector:
        found = part(trial, point, body)
        return axes_at(trial, axes).T @ found if axes else found

    return second


def _both(
    star: str, size: str, unit: str, gives: str, part: PartOf, seen: SeenPart
) -> tuple[OutputFunction, OutputFunction]:
    """The components of a part of the motion, and its magnitude."""
    law, second = _of(part), _seen(seen)
    return (
        components(star, unit, gives, law, second, least=2),
        magnitude(size, unit, "its magnitude", law, second, least=2),
    )


PARTS_OF_MOTION = (
    *_both(
        "transport_v*",
        "transport_speed",
        "m/s",
        "[motion on a moving body](#motion-on-a-moving-body): velocity of the point of the body that is passed; in the "
        "axes of the second",
        lambda parts: parts.transport_velocity,
        _carried(1),
    ),
    *_both(
        "transport_a*",
        "transport_acceleration",
        "m/s^2",
        "its acceleration",
        lambda parts: parts.transport_acceleration,
        _carried(2),
    ),
    *_both("coriolis_a*", "coriolis_acceleration", "m/s^2", "2 omega x v_r", lambda parts: parts.coriolis, _coriolis),
    *_both(
        "euler_a*",
        "euler_acceleration",
        "m/s^2",
        "epsilon x r, a part of the transport acceleration",
        lambda parts: parts.euler,
        _euler,
    ),
    *_both(
        "centripetal_a*",
        "centripetal_acceleration",
        "m/s^2",
        "omega x (omega x r), the other part that is due to the turning",
        lambda parts: parts.centripetal,
        _centripetal,
    ),
)
"""Motion of a point as if it stayed in the body, and what is added by its motion relative to the body."""
