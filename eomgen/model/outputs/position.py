"""x, y, z: the place of a point; poses are what all else is built on."""

from eomgen.model.outputs.base import OutputFunction, along, component, names_of
from eomgen.model.outputs.scene import GROUND, Scene
from eomgen.model.outputs.seen import seen_from, turned
from eomgen.symbolic.expression.spatial import Vector


def _place(scene: Scene, point: str, frame: str = GROUND, axes: str = "") -> Vector:
    return turned(scene, seen_from(scene, point, frame), frame, axes)


POSITION = OutputFunction(
    names=along("*"),
    kinds=("point", "body", "body"),
    least=1,
    unit="m",
    gives="position; from a body: in its frame and axes, or in those of the second",
    value=lambda scene, call: _place(scene, *names_of(call))[component(call)],
)
