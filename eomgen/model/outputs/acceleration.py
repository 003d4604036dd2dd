"""ax, ay, az, acceleration: a = dv/dt of a point. By the second way the second difference of its places."""

from functools import partial

from eomgen.model.outputs.context import GROUND, OutputContext
from eomgen.model.outputs.seen import components, differences, magnitude, seen_from, turned
from eomgen.symbolic.expression.spatial import Vector

SEEN = "acceleration; seen from the first body, in the axes of the second"


def acceleration(scene: OutputContext, point: str, frame: str = GROUND, axes: str = "") -> Vector:
    """a = dv/dt [m/s^2]"""
    return turned(scene, scene.acceleration(scene.rate(seen_from(scene, point, frame))), frame, axes)


_seen = partial(differences, order=2)
ACCELERATION = components("a*", "m/s^2", SEEN, acceleration, _seen, least=1)
MAGNITUDE_OF_ACCELERATION = magnitude(
    "acceleration", "m/s^2", "magnitude of the acceleration", acceleration, _seen, least=1
)
