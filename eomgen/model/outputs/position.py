"""x, y, z: the place of a point.

Poses are what all else is built on: by the second way a place is seen from another body, side by side, in numbers.
"""

from eomgen.model.outputs.base import OutputFunction, along, component, names_of
from eomgen.model.outputs.context import GROUND, OutputContext, Trial
from eomgen.model.outputs.seen import axes_at, seen_around, seen_from, turned
from eomgen.symbolic.expression.spatial import Numbers, Vector, apply, transposed


def _place(scene: OutputContext, point: str, frame: str = GROUND, axes: str = "") -> Vector:
    return turned(scene, seen_from(scene, point, frame), frame, axes)


def _seen(trial: Trial, point: str, frame: str = GROUND, axes: str = "") -> Numbers:
    _, place, _ = seen_around(trial, point, frame)
    if axes in ("", frame):
        return place
    return apply(transposed(axes_at(trial, axes)), apply(axes_at(trial, frame), place))


POSITION = OutputFunction(
    names=along("*"),
    kinds=("point", "body", "body"),
    least=1,
    unit="m",
    gives="position; from a body: in its frame and axes, or in those of the second",
    value=lambda scene, call: _place(scene, *names_of(call))[component(call)],
    second=lambda trial, call: _seen(trial, *names_of(call))[component(call)],
)
