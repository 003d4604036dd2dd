"""The motion of a point on a moving body in its parts: transport, Coriolis, and what the transport consists of.

    v_t = v_O + omega x r,   a_t = a_O + epsilon x r + omega x (omega x r),   a_C = 2 omega x v_r

By the second way nothing turns but R: a point that stays in the body at r' = R^T r goes from p + R r' to
p(t + h) + R(t + h) r', hence v_t and a_t; W = R' R^T gives W W r and (R'' R^T - W W) r; what is left of a is 2 W v_r.
"""

from __future__ import annotations

from collections.abc import Callable

from eomgen.model.outputs.base import OutputFunction
from eomgen.model.outputs.context import GROUND, OutputContext, PartsOfMotion, Trial
from eomgen.model.outputs.seen import (
    SeenVector,
    VectorOf,
    axes_at,
    components,
    differences,
    magnitude,
    seen_from,
    turned,
)
from eomgen.symbolic.expression.spatial import (
    Matrix,
    Numbers,
    Vector,
    apply,
    minus,
    plus,
    product,
    transposed,
    vector_of,
)

PartOf = Callable[[PartsOfMotion], Vector]
SeenPart = Callable[[Trial, str, str], Numbers]


def _carried(order: int) -> SeenPart:
    """Velocity (order 1) or acceleration (2) of the point of the body that the point passes."""

    def found(trial: Trial, point: str, body: str) -> Numbers:
        held = vector_of(trial.along(seen_from(trial.scene, point, body))[0])
        origin = trial.along(trial.scene.origin(body))[order]
        return plus(vector_of(origin), apply(axes_at(trial, body, order), held))

    return found


def _turning(trial: Trial, point: str, body: str) -> tuple[Numbers, Matrix]:
    """(r from the body's origin, W = R' R^T)."""
    R = axes_at(trial, body)
    held = vector_of(trial.along(seen_from(trial.scene, point, body))[0])
    return apply(R, held), product(axes_at(trial, body, 1), transposed(R))


def _centripetal(trial: Trial, point: str, body: str) -> Numbers:
    r, W = _turning(trial, point, body)
    return apply(W, apply(W, r))


def _euler(trial: Trial, point: str, body: str) -> Numbers:
    r, _ = _turning(trial, point, body)
    whole = product(axes_at(trial, body, 2), transposed(axes_at(trial, body)))
    return minus(apply(whole, r), _centripetal(trial, point, body))


def _coriolis(trial: Trial, point: str, body: str) -> Numbers:
    """a - a_t - a_r"""
    relative = apply(axes_at(trial, body), differences(trial, point, body, order=2))
    return minus(minus(differences(trial, point, order=2), _carried(2)(trial, point, body)), relative)


def _of(part: PartOf) -> VectorOf:
    """The part, ground axes or those of a body."""

    def law(scene: OutputContext, point: str, body: str, axes: str = "") -> Vector:
        return turned(scene, part(scene.parts_of_motion(point, body)), GROUND, axes)

    return law


def _seen(part: SeenPart) -> SeenVector:
    def second(trial: Trial, point: str, body: str, axes: str = "") -> Numbers:
        found = part(trial, point, body)
        return apply(transposed(axes_at(trial, axes)), found) if axes else found

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
"""What a point would have if it stayed in the body, and what is added by its moving there."""
