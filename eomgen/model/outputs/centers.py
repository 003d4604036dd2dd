"""rotation_center, acceleration_pole: the points of a body that have no velocity, or no acceleration, in the plane.

By the second way from three points A, B, C of the body, not on a line: their velocities, or accelerations, are linear
in the place, and c = A + x (B - A) + y (C - A) is where they vanish.
"""

from __future__ import annotations

from typing import Any

from eomgen.errors import DerivationError
from eomgen.model.outputs.base import OutputFunction, SecondOf, component, names_of
from eomgen.model.outputs.context import GROUND, OutputContext, Trial
from eomgen.model.outputs.seen import axes_at
from eomgen.symbolic.expression.spatial import ZERO, Numbers, Vector, apply, minus, plus, times, transposed, vector_of

CORNERS: tuple[Vector, ...] = (ZERO, (1, 0, 0), (0, 1, 0))  # of a triangle in the body [m]


def _in_plane(scene: OutputContext, what: str, body: str) -> None:
    if not scene.is_plane:
        raise DerivationError(
            f"{what}({body}): it is asked of plane motion", mend="ask for omega and v of a point in space"
        )


def _center(scene: OutputContext, body: str, other: str = GROUND) -> Vector:
    _in_plane(scene, "rotation_center", body)
    return scene.rotation_center(body, other)


def _pole(scene: OutputContext, body: str) -> Vector:
    _in_plane(scene, "acceleration_pole", body)
    return scene.acceleration_pole(body)


def _still_point(trial: Trial, order: int, body: str, other: str = GROUND) -> Numbers:
    """Where the rate of a place in the other body's frame vanishes, ground axes."""
    scene = trial.scene
    places: list[Any] = []
    rates: list[Any] = []
    for corner in CORNERS:
        place = plus(scene.origin(body), apply(scene.axes(body), corner))
        seen = apply(transposed(scene.axes(other)), minus(place, scene.origin(other)))
        places.append(vector_of(trial.along(place)[0]))
        rates.append(apply(axes_at(trial, other), vector_of(trial.along(seen)[order])))
    a: Any
    b: Any
    c: Any
    a, b, c = rates[0], minus(rates[1], rates[0]), minus(rates[2], rates[0])
    area = b[0] * c[1] - b[1] * c[0]
    x, y = (a[1] * c[0] - a[0] * c[1]) / area, (a[0] * b[1] - a[1] * b[0]) / area
    first, second = (minus(corner, places[0]) for corner in places[1:])
    return plus(places[0], plus(times(x, first), times(y, second)))


def _second(order: int) -> SecondOf:
    return lambda trial, call: _still_point(trial, order, *names_of(call))[component(call)]


ROTATION_CENTER = OutputFunction(
    names=("rotation_center_x", "rotation_center_y"),
    kinds=("body", "body"),
    least=1,
    unit="m",
    gives="in the plane, the point about which a body turns, against the ground or another body",
    value=lambda scene, call: _center(scene, *names_of(call))[component(call)],
    second=_second(1),
    moves=True,
)
ACCELERATION_POLE = OutputFunction(
    names=("acceleration_pole_x", "acceleration_pole_y"),
    kinds=("body",),
    least=1,
    unit="m",
    gives="the point of the body that has no acceleration, in the plane",
    value=lambda scene, call: _pole(scene, *names_of(call))[component(call)],
    second=_second(2),
    moves=True,
)
