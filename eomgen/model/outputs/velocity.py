"""vx, vy, vz, speed: v = dr/dt of a point. By the second way the difference of its places."""

from functools import partial

from eomgen.model.outputs.context import GROUND, OutputContext
from eomgen.model.outputs.seen import components, differences, magnitude, seen_from, turned
from eomgen.symbolic.expression.spatial import Vector

SEEN = "velocity; seen from the first body, in the axes of the second"


def velocity(scene: OutputContext, point: str, frame: str = GROUND, axes: str = "") -> Vector:
    """v = dr/dt [m/s]"""
    return turned(scene, scene.rate(seen_from(scene, point, frame)), frame, axes)


_seen = partial(differences, order=1)
VELOCITY = components("v*", "m/s", SEEN, velocity, _seen, least=1)
SPEED = magnitude("speed", "m/s", "magnitude of the velocity", velocity, _seen, least=1)
