"""A point as it is seen from a body: r = R^T (p - p_body), in that body's axes or in those of another one.

A vector law gives two output functions: its components, and its magnitude.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any

from eomgen.model.outputs.base import OutputFunction, along, component, names_of
from eomgen.model.outputs.context import GROUND, OutputContext, Trial
from eomgen.symbolic.expression.functions import sqrt
from eomgen.symbolic.expression.spatial import (
    AnyScalar,
    Matrix,
    Numbers,
    Vector,
    apply,
    dot,
    matrix_of,
    minus,
    plus,
    times,
    transposed,
    vector_of,
)
from eomgen.symbolic.numeric.evaluation import NoValue


def seen_from(scene: OutputContext, point: str, frame: str = GROUND) -> Vector:
    """The place of a point in a body's frame and axes."""
    place = scene.position(point)
    if frame not in scene.bodies:
        return place
    return apply(transposed(scene.axes(frame)), minus(place, scene.origin(frame)))


def turned(scene: OutputContext, seen: Vector, frame: str, axes: str) -> Vector:
    """From the axes of one body into those of another; "": they stay."""
    if axes in ("", frame):
        return seen
    return apply(transposed(scene.axes(axes)), apply(scene.axes(frame), seen))


def size(scene: OutputContext, v: Vector) -> AnyScalar:
    """|v| at the state."""
    (v,) = scene.here(v)
    return sqrt(dot(v, v))


def axes_at(trial: Trial, body: str, order: int = 0) -> Matrix:
    """R of a body in numbers, or its first or second rate by differences."""
    flat = trial.along([x for row in trial.scene.axes(body) for x in row])[order]
    return matrix_of((flat[0:3], flat[3:6], flat[6:9]))


def seen_around(trial: Trial, point: str, frame: str = GROUND) -> tuple[Numbers, ...]:
    """The place of a point in a body's frame and axes, a moment before, now, and a moment later."""
    places = trial.around(trial.scene.position(point))
    if frame not in trial.scene.bodies:
        return places
    origins = trial.around(trial.scene.origin(frame))
    sides = [trial.around(side) for side in transposed(trial.scene.axes(frame))]
    arms = [minus(place, origin) for place, origin in zip(places, origins, strict=True)]
    return tuple(vector_of(dot(side[i], arm) for side in sides) for i, arm in enumerate(arms))


def differences(trial: Trial, point: str, frame: str = GROUND, axes: str = "", *, order: int) -> Numbers:
    """Velocity (order 1) or acceleration (2) of a point as differences of its place."""
    if math.isnan(trial.along(trial.scene.position(point))[order][0]):
        raise NoValue("accelerations are not determined there")
    early, now, late = seen_around(trial, point, frame)
    h = trial.step
    bend: Numbers = plus(minus(late, now), minus(early, now))
    rates: Numbers = times(1 / (2 * h), minus(late, early)) if order == 1 else times(1 / (h * h), bend)
    if axes in ("", frame):
        return rates
    return apply(transposed(axes_at(trial, axes)), apply(axes_at(trial, frame), rates))


def length(trial: Trial, v: Numbers) -> Any:
    """|v| of numbers."""
    return trial.root(dot(v, v))


VectorOf = Callable[..., Vector]
SeenVector = Callable[..., Numbers]
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
        value=lambda scene, call: law(scene, *names_of(call))[component(call)],
        second=lambda trial, call: seen(trial, *names_of(call))[component(call)],
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
        value=lambda scene, call: size(scene, law(scene, *names_of(call))),
        second=lambda trial, call: length(trial, seen(trial, *names_of(call))),
        moves=True,
    )
