"""generalized_force, momentum: along a coordinate that is free.

By the second way p = dT/du is (T(u + 1) - T(u - 1))/2 over particles, exact as T is quadratic in u. Q has none here:
the certificate compares it by the projection of every load.
"""

from __future__ import annotations

from typing import Any

from eomgen.model.outputs.base import OutputFunction, name_at
from eomgen.model.outputs.context import Trial
from eomgen.symbolic.expression.spatial import dot
from eomgen.symbolic.numeric.evaluation import NoValue


def _slope_of_energy(trial: Trial, name: str) -> Any:
    try:
        both = [trial.faster(f"{name}'", by) for by in (1, -1)]
    except NoValue:
        both = [trial.faster(name, by) for by in (1, -1)]
    more, less = (sum(m * dot(v, v) for body in t.scene.bodies for m, _, v in t.particles(body)) for t in both)
    return (more - less) / 4


GENERALIZED_FORCE = OutputFunction(
    names=("generalized_force",),
    kinds=("coordinate",),
    least=1,
    unit="J",
    per=(0,),
    gives="Q of everything applied, along a coordinate that is free",
    value=lambda scene, call: scene.generalized_force(name_at(call, 0)),
)
MOMENTUM = OutputFunction(
    names=("momentum",),
    kinds=("coordinate or speed",),
    least=1,
    unit="J",
    per=(0,),
    gives="dT/dq' of a coordinate that is free, dT/du of a declared speed",
    value=lambda scene, call: scene.momentum(name_at(call, 0)),
    second=lambda trial, call: _slope_of_energy(trial, name_at(call, 0)),
)
