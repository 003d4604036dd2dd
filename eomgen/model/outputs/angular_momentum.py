"""angular_momentum_x, _y, _z: L_P = sum (R I_C R^T w + m d x v_C). By the second way sum m r x v over particles."""

from __future__ import annotations

from typing import Any

from eomgen.model.outputs.base import MASSES, OutputFunction, along, component, name_at
from eomgen.model.outputs.bodies_meant import bodies_from, refuse_unknown
from eomgen.model.outputs.context import OutputContext, Trial
from eomgen.symbolic.expression.expressions import Call
from eomgen.symbolic.expression.graph import is_zero
from eomgen.symbolic.expression.spatial import AnyScalar, cross, minus, vector_of


def _momentum(scene: OutputContext, call: Call) -> AnyScalar:
    bodies, axis = bodies_from(scene, call, 1), component(call)
    turning = [b for b in bodies if any(not is_zero(w) for w in scene.spin(b))]
    refuse_unknown(scene, call, turning, about_z=axis == 2)
    return scene.angular_momentum(scene.position(name_at(call, 0)), bodies)[axis]


def _sum(trial: Trial, call: Call) -> Any:
    point = vector_of(trial.along(trial.scene.position(name_at(call, 0)))[0])
    bodies, axis = bodies_from(trial.scene, call, 1), component(call)
    return sum(m * cross(minus(r, point), v)[axis] for body in bodies for m, r, v in trial.particles(body, still=True))


ANGULAR_MOMENTUM = OutputFunction(
    names=along("angular_momentum_*"),
    kinds=("point",),
    least=1,
    more="body",
    unit="kg*m^2/s",
    gives="sum of r x m v and I w about the point, ground axes, of the velocities against the ground",
    value=_momentum,
    second=_sum,
    source=MASSES,
    moves=True,
)
