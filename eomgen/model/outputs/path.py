"""tangential_acceleration, normal_acceleration, curvature_radius: the way of a point, from its v and a.

    a_t = a.v/|v|,     a_n = |v x a|/|v|,     rho = |v|^3/|v x a|

By the second way from three places r-, r, r+ of the path, h apart in time: a_t = (|r+ - r| - |r - r-|)/h^2; rho is the
radius of the circle through them, and a_n = v^2/rho.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from eomgen.errors import DerivationError
from eomgen.model.outputs.acceleration import acceleration
from eomgen.model.outputs.base import OutputFunction, ValueOf, names_of
from eomgen.model.outputs.context import Trial
from eomgen.model.outputs.seen import differences, length, seen_from
from eomgen.model.outputs.velocity import velocity
from eomgen.symbolic.expression.expressions import Call
from eomgen.symbolic.expression.functions import function, over, sqrt
from eomgen.symbolic.expression.spatial import AnyScalar, Vector, cross, dot, minus
from eomgen.symbolic.solve.solving import vanishes


def tangential_part(v: Vector, a: Vector) -> AnyScalar:
    """The rate of the speed, a.v/|v|.

    Raises:
        DerivationError: the point is at rest.
    """
    return over(dot(a, v), _speed(v, "acceleration along its path"))


def normal_part(v: Vector, a: Vector) -> AnyScalar:
    """The acceleration across the path, |v x a|/|v|.

    Raises:
        DerivationError: the point is at rest.
    """
    _speed(v, "acceleration across its path")
    n = cross(v, a)
    return sqrt(over(dot(n, n), dot(v, v)))


def curvature_radius(v: Vector, a: Vector) -> AnyScalar:
    """rho = |v|^3/|v x a| of the point's path.

    Raises:
        DerivationError: the point is at rest, or its path is straight there.
    """
    speed, across = _speed(v, "radius of curvature"), _across(v, a)
    if vanishes(across):
        raise DerivationError(
            "the path is straight there: its radius of curvature is infinite", mend="ask where the path bends"
        )
    return over(dot(v, v) * speed, across)


def _speed(v: Vector, what: str) -> AnyScalar:
    if all(vanishes(x) for x in v):
        raise DerivationError(f"the point is at rest: it has no {what}", mend="ask while it moves")
    return sqrt(dot(v, v))


def _across(v: Vector, a: Vector) -> AnyScalar:
    """|v x a|, in the plane without a root."""
    n = cross(v, a)
    return function("abs", n[2]) if vanishes(n[0]) and vanishes(n[1]) else sqrt(dot(n, n))


def _of_path(law: Callable[[Vector, Vector], AnyScalar]) -> ValueOf:
    """A law of v and a at the given state."""
    return lambda scene, call: law(*scene.here(velocity(scene, *names_of(call)), acceleration(scene, *names_of(call))))


def _rate_of_speed(trial: Trial, call: Call) -> Any:
    before, now, after = trial.around(seen_from(trial.scene, *names_of(call)))
    return (length(trial, minus(after, now)) - length(trial, minus(now, before))) / trial.step**2


def _curvature(trial: Trial, call: Call) -> Any:
    """Of the circle through three places: twice the sine of an angle of their triangle over the side across it."""
    before, now, after = trial.around(seen_from(trial.scene, *names_of(call)))
    first, last, chord = minus(now, before), minus(after, now), minus(after, before)
    return 2 * length(trial, cross(first, last)) / (length(trial, first) * length(trial, last) * length(trial, chord))


def _centripetal(trial: Trial, call: Call) -> Any:
    v = differences(trial, *names_of(call), order=1)
    return dot(v, v) * _curvature(trial, call)


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
