"""angle, omega, epsilon: how a body is turned and turns, against the ground or another body.

By the second way from the rotation alone: with R from the body's axes to those of `frame`, omega~ = R' R^T and
epsilon~ = R'' R^T + R' R'^T, R' and R'' by differences.
"""

from __future__ import annotations

from functools import partial
from typing import Any

from eomgen.errors import DerivationError
from eomgen.model.outputs.base import OutputFunction, names_of
from eomgen.model.outputs.context import GROUND, OutputContext, Trial
from eomgen.model.outputs.seen import axes_at, components, length
from eomgen.symbolic.expression.expressions import Call
from eomgen.symbolic.expression.functions import sqrt
from eomgen.symbolic.expression.spatial import (
    IDENTITY,
    AnyScalar,
    Numbers,
    Vector,
    added,
    apply,
    dot,
    matrix_of,
    minus,
    product,
    transposed,
)

BODY = ("body", "body")


def _angle(scene: OutputContext, body: str, frame: str = GROUND) -> AnyScalar:
    """phi_body - phi_frame, in the plane [rad]."""
    for name in (body, frame):
        if not scene.is_plane:
            raise DerivationError(
                f"body '{name}' has no single angle in space", mend="ask for omega_x, omega_y, omega_z of it"
            )
    return scene.angle(body) - scene.angle(frame)


def _angle_of_axes(trial: Trial, body: str, frame: str = GROUND) -> Any:
    """That between the x axes of both, and as many whole turns as coordinates count."""
    scene, x, y = trial.scene, 0, 1
    own, sides = (transposed(axes_at(trial, name)) if name in scene.bodies else IDENTITY for name in (body, frame))
    sine, cosine = dot(own[x], sides[y]), dot(own[x], sides[x])
    (counted,), _, _ = trial.along((scene.angle(body) - scene.angle(frame),))
    angle = counted.context.atan2(sine, cosine)
    turn = 2 * counted.context.pi
    return angle + turn * round((counted - angle) / turn)


def _spin(scene: OutputContext, body: str, frame: str = GROUND, *, order: int) -> Vector:
    """omega (order 1) or epsilon (2), ground axes or those of `frame`."""
    w = scene.spin(body)
    if frame in scene.bodies:
        w = apply(transposed(scene.axes(frame)), minus(w, scene.spin(frame)))
    return w if order == 1 else scene.acceleration(w)


def _turned(trial: Trial, body: str, frame: str = GROUND, *, order: int) -> Numbers:
    """The same by differences of the rotation."""
    scene = trial.scene
    rows = product(transposed(scene.axes(frame)), scene.axes(body))
    R, R1, R2 = (matrix_of((x[0:3], x[3:6], x[6:9])) for x in trial.along([x for row in rows for x in row]))
    W = product(R1, transposed(R)) if order == 1 else added(product(R2, transposed(R)), product(R1, transposed(R1)))
    return (W[2][1], W[0][2], W[1][0])


def _one(name: str, unit: str, gives: str, order: int) -> OutputFunction:
    """In the plane counter-clockwise positive; in space the magnitude."""

    def value(scene: OutputContext, call: Call) -> AnyScalar:
        w = _spin(scene, *names_of(call), order=order)
        return w[2] if scene.is_plane else sqrt(dot(w, w))

    def second(trial: Trial, call: Call) -> Any:
        w = _turned(trial, *names_of(call), order=order)
        return w[2] if trial.scene.is_plane else length(trial, w)

    return OutputFunction(
        names=(name,), kinds=BODY, least=1, unit=unit, gives=gives, value=value, second=second, moves=True
    )


def _components(names: str, unit: str, order: int) -> OutputFunction:
    gives = "its components, ground axes; against a body: its axes"
    return components(names, unit, gives, partial(_spin, order=order), partial(_turned, order=order), BODY, least=1)


ANGLE = OutputFunction(
    names=("angle",),
    kinds=BODY,
    least=1,
    unit="rad",
    gives="angle, in the plane",
    value=lambda scene, call: _angle(scene, *names_of(call)),
    second=lambda trial, call: _angle_of_axes(trial, *names_of(call)),
)
OMEGA = _one("omega", "rad/s", "angular velocity; in space its magnitude", 1)
ANGULAR_VELOCITY = _components("omega_*", "rad/s", 1)
EPSILON = _one("epsilon", "rad/s^2", "angular acceleration; in space its magnitude", 2)
ANGULAR_ACCELERATION = _components("epsilon_*", "rad/s^2", 2)
