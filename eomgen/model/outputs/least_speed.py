"""least_speed: of the points between two points of one body.

By the second way the velocities of both ends are differences of their places; between them v = v_A + s (v_B - v_A) is
shortest at s = -v_A.(v_B - v_A)/|v_B - v_A|^2, or at an end.
"""

from __future__ import annotations

from typing import Any

from eomgen.errors import DerivationError
from eomgen.model.outputs.base import OutputFunction, names_of
from eomgen.model.outputs.context import OutputContext, Trial
from eomgen.model.outputs.seen import differences, length
from eomgen.symbolic.expression.spatial import AnyScalar, dot, minus, plus, times


def _least_speed(scene: OutputContext, start: str, end: str) -> AnyScalar:
    body, other = scene.body_of(start), scene.body_of(end)
    if body != other:
        what = f"least_speed({start}, {end}): '{start}' and '{end}' are points of two bodies"
        raise DerivationError(what, mend="name two points of one body")
    return scene.least_speed(body, *scene.here(scene.position(start), scene.position(end)))


def _second(trial: Trial, start: str, end: str) -> Any:
    first = differences(trial, start, order=1)
    change = minus(differences(trial, end, order=1), first)
    square: Any = dot(change, change)
    s: Any = min(1, max(0, -dot(first, change) / square)) if square else 0
    return length(trial, plus(first, times(s, change)))


LEAST_SPEED = OutputFunction(
    names=("least_speed",),
    kinds=("point", "point"),
    least=2,
    unit="m/s",
    gives="of the points between two points of one body",
    value=lambda scene, call: _least_speed(scene, *names_of(call)),
    second=lambda trial, call: _second(trial, *names_of(call)),
    moves=True,
)
