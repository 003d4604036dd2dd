"""Places, velocities and accelerations of points, seen from the ground or from a body."""

import math
from collections.abc import Callable
from functools import partial
from typing import Any

from eomgen.errors import DerivationError
from eomgen.model.outputs.base import GROUND, OutputContext, OutputFunction, Trial, ValueOf, along, component
from eomgen.symbolic.exact import vanishes
from eomgen.symbolic.expression import Call, Matrix, Scalar, Vector, function, over, sqrt
from eomgen.symbolic.numeric import NoValue

# -------- position --------------------------------------------------------------------------------------------
# x, y, z: the place of a point.
#
# Poses are what all else is built on: by the second way a place is seen from another body, side by side, in numbers.


def _place(scene: OutputContext, point: str, frame: str = GROUND, axes: str = "") -> Vector:
    return turned(scene, seen_from(scene, point, frame), frame, axes)


def _place_seen(trial: Trial, point: str, frame: str = GROUND, axes: str = "") -> Vector:
    _, place, _ = seen_around(trial, point, frame)
    if axes in ("", frame):
        return place
    return axes_at(trial, axes).T @ (axes_at(trial, frame) @ place)


POSITION = OutputFunction(
    names=along("*"),
    kinds=("point", "body", "body"),
    least=1,
    unit="m",
    gives="position; from a body: in its frame and axes, or in those of the second",
    value=lambda scene, call: _place(scene, *call.names)[component(call)],
    second=lambda trial, call: _place_seen(trial, *call.names)[component(call)],
)


# -------- seen ------------------------------------------------------------------------------------------------
# A point as it is seen from a body: r = R^T (p - p_body), in that body's axes or in those of another one.
#
# A vector law gives two output functions: its components, and its magnitude.


def seen_from(scene: OutputContext, point: str, frame: str = GROUND) -> Vector:
    """The place of a point in a body's frame and axes."""
    place = scene.position(point)
    if frame not in scene.bodies:
        return place
    return scene.axes(frame).T @ (place - scene.origin(frame))


def turned(scene: OutputContext, seen: Vector, frame: str, axes: str) -> Vector:
    """The vector turned from the axes of one body into those of another; "": unchanged."""
    if axes in ("", frame):
        return seen
    return scene.axes(axes).T @ (scene.axes(frame) @ seen)


def size(scene: OutputContext, v: Vector) -> Scalar:
    """|v| at the state."""
    (v,) = scene.here(v)
    return sqrt(v @ v)


def axes_at(trial: Trial, body: str, order: int = 0) -> Matrix:
    """R of a body in numbers, or its first or second rate by differences."""
    flat = trial.along([x for row in trial.scene.axes(body) for x in row])[order]
    return Matrix.of((flat[0:3], flat[3:6], flat[6:9]))


def seen_around(trial: Trial, point: str, frame: str = GROUND) -> tuple[Vector, ...]:
    """The place of a point in a body's frame and axes, a moment before, now, and a moment later."""
    places = trial.around(trial.scene.position(point))
    if frame not in trial.scene.bodies:
        return places
    origins = trial.around(trial.scene.origin(frame))
    sides = [trial.around(side) for side in trial.scene.axes(frame).T]
    arms = [place - origin for place, origin in zip(places, origins, strict=True)]
    return tuple(Vector(side[i] @ arm for side in sides) for i, arm in enumerate(arms))


def differences(trial: Trial, point: str, frame: str = GROUND, axes: str = "", *, order: int) -> Vector:
    """Velocity (order 1) or acceleration (2) of a point as differences of its place."""
    if math.isnan(trial.along(trial.scene.position(point))[order][0]):
        raise NoValue("accelerations are not determined there")
    early, now, late = seen_around(trial, point, frame)
    h = trial.step
    bend: Vector = late - now + (early - now)
    rates: Vector = 1 / (2 * h) * (late - early) if order == 1 else 1 / (h * h) * bend
    if axes in ("", frame):
        return rates
    return axes_at(trial, axes).T @ (axes_at(trial, frame) @ rates)


def length(trial: Trial, v: Vector) -> Any:
    """|v| of numbers."""
    return trial.root(v @ v)


VectorOf = Callable[..., Vector]
SeenVector = Callable[..., Vector]
POINT = ("point", "body", "body")


def components(
    names: str, unit: str, gives: str, law: VectorOf, seen: SeenVector, kinds: tuple[str, ...] = POINT, *, least: int
) -> OutputFunction:
    """The components of a vector.

    Args:
        names: with a star for the axis.
        law: of a scene and the names that stand in the call.
        seen: the same of a trial: the second way.
    """
    return OutputFunction(
        names=along(names),
        kinds=kinds,
        least=least,
        unit=unit,
        gives=gives,
        value=lambda scene, call: law(scene, *call.names)[component(call)],
        second=lambda trial, call: seen(trial, *call.names)[component(call)],
        moves=True,
    )


def magnitude(
    name: str, unit: str, gives: str, law: VectorOf, seen: SeenVector, kinds: tuple[str, ...] = POINT[:2], *, least: int
) -> OutputFunction:
    """|v| of a vector, its arguments as of `components`."""
    return OutputFunction(
        names=(name,),
        kinds=kinds,
        least=least,
        unit=unit,
        gives=gives,
        value=lambda scene, call: size(scene, law(scene, *call.names)),
        second=lambda trial, call: length(trial, seen(trial, *call.names)),
        moves=True,
    )


# -------- velocity --------------------------------------------------------------------------------------------
# vx, vy, vz, speed: v = dr/dt of a point. By the second way the difference of its places.


VELOCITY_SEEN = "velocity; seen from the first body, in the axes of the second"


def velocity(scene: OutputContext, point: str, frame: str = GROUND, axes: str = "") -> Vector:
    """v = dr/dt [m/s]"""
    return turned(scene, scene.rate(seen_from(scene, point, frame)), frame, axes)


_velocity_seen = partial(differences, order=1)
VELOCITY = components("v*", "m/s", VELOCITY_SEEN, velocity, _velocity_seen, least=1)
SPEED = magnitude("speed", "m/s", "magnitude of the velocity", velocity, _velocity_seen, least=1)


# -------- acceleration ----------------------------------------------------------------------------------------
# ax, ay, az, acceleration: a = dv/dt of a point. By the second way the second difference of its places.


ACCELERATION_SEEN = "acceleration; seen from the first body, in the axes of the second"


def acceleration(scene: OutputContext, point: str, frame: str = GROUND, axes: str = "") -> Vector:
    """a = dv/dt [m/s^2]"""
    return turned(scene, scene.acceleration(scene.rate(seen_from(scene, point, frame))), frame, axes)


_acceleration_seen = partial(differences, order=2)
ACCELERATION = components("a*", "m/s^2", ACCELERATION_SEEN, acceleration, _acceleration_seen, least=1)
MAGNITUDE_OF_ACCELERATION = magnitude(
    "acceleration", "m/s^2", "magnitude of the acceleration", acceleration, _acceleration_seen, least=1
)


# -------- path ------------------------------------------------------------------------------------------------
# tangential_acceleration, normal_acceleration, curvature_radius: the way of a point, from its v and a.
#
#     a_t = a.v/|v|,     a_n = |v x a|/|v|,     rho = |v|^3/|v x a|
#
# By the second way from three places r-, r, r+ of the path, h apart in time: a_t = (|r+ - r| - |r - r-|)/h^2; rho is
# the radius of the circle through them, and a_n = v^2/rho.


def tangential_part(v: Vector, a: Vector) -> Scalar:
    """The rate of the speed, a.v/|v|.

    Raises:
        DerivationError: the point is at rest.
    """
    return over(a @ v, _speed(v, "acceleration along its path"))


def normal_part(v: Vector, a: Vector) -> Scalar:
    """The acceleration across the path, |v x a|/|v|.

    Raises:
        DerivationError: the point is at rest.
    """
    _speed(v, "acceleration across its path")
    n = v.cross(a)
    return sqrt(over(n @ n, v @ v))


def curvature_radius(v: Vector, a: Vector) -> Scalar:
    """rho = |v|^3/|v x a| of the point's path.

    Raises:
        DerivationError: the point is at rest, or its path is straight there.
    """
    speed, across = _speed(v, "radius of curvature"), _across(v, a)
    if vanishes(across):
        raise DerivationError(
            "the path is straight there: its radius of curvature is infinite", fix="ask where the path bends"
        )
    return over(v @ v * speed, across)


def _speed(v: Vector, what: str) -> Scalar:
    if all(vanishes(x) for x in v):
        raise DerivationError(f"the point is at rest: it has no {what}", fix="ask while it moves")
    return sqrt(v @ v)


def _across(v: Vector, a: Vector) -> Scalar:
    """|v x a|, in the plane without a root."""
    n = v.cross(a)
    return function("abs", n[2]) if vanishes(n[0]) and vanishes(n[1]) else sqrt(n @ n)


def _of_path(law: Callable[[Vector, Vector], Scalar]) -> ValueOf:
    """A law of v and a at the given state."""
    return lambda scene, call: law(*scene.here(velocity(scene, *call.names), acceleration(scene, *call.names)))


def _rate_of_speed(trial: Trial, call: Call) -> Any:
    before, now, after = trial.around(seen_from(trial.scene, *call.names))
    return (length(trial, after - now) - length(trial, now - before)) / trial.step**2


def _curvature(trial: Trial, call: Call) -> Any:
    """Curvature of the circle through three places: 2 sin(angle) of their triangle over the side across it."""
    before, now, after = trial.around(seen_from(trial.scene, *call.names))
    first, last, chord = now - before, after - now, after - before
    return 2 * length(trial, first.cross(last)) / (length(trial, first) * length(trial, last) * length(trial, chord))


def _centripetal(trial: Trial, call: Call) -> Any:
    v = differences(trial, *call.names, order=1)
    return v @ v * _curvature(trial, call)


TANGENTIAL_ACCELERATION = OutputFunction(
    names=("tangential_acceleration",),
    kinds=("point", "body"),
    least=1,
    unit="m/s^2",
    gives="rate of the speed",
    value=_of_path(tangential_part),
    second=_rate_of_speed,
    moves=True,
)
NORMAL_ACCELERATION = OutputFunction(
    names=("normal_acceleration",),
    kinds=("point", "body"),
    least=1,
    unit="m/s^2",
    gives="acceleration across the path (positive)",
    value=_of_path(normal_part),
    second=_centripetal,
    moves=True,
)
CURVATURE_RADIUS = OutputFunction(
    names=("curvature_radius",),
    kinds=("point", "body"),
    least=1,
    unit="m",
    gives="radius of the path",
    value=_of_path(curvature_radius),
    second=lambda trial, call: 1 / _curvature(trial, call),
    moves=True,
)
