"""generalized_force, momentum: along a coordinate that is free.

By the second way p = dT/du is (T(u + 1) - T(u - 1))/2 over particles, exact as T is quadratic in u; of an
energy that the file gives in any form it is 4/3 of that difference over h less 1/3 of that over 2 h. Q has none here:
the certificate compares it by the projection of every load.
"""

from __future__ import annotations

from typing import Any

from eomgen.model.outputs.base import OutputFunction, name_at
from eomgen.model.outputs.context import Trial
from eomgen.symbolic.expression.spatial import dot
from eomgen.symbolic.numeric.evaluation import NoValue

SMALL = 2.0**-10  # [m/s, rad/s] of a speed, in the differences of an energy that is no square of it


def _slope_of_energy(trial: Trial, name: str) -> Any:
    more, less = (
        sum(m * dot(v, v) for body in t.scene.bodies for m, _, v in t.particles(body)) for t in _faster(trial, name, 1)
    )
    slopes = []
    for by in (SMALL, 2 * SMALL):
        above, below = (t.given_energy() for t in _faster(trial, name, by))
        slopes.append((above - below) / (2 * by))
    return (more - less) / 4 + (4 * slopes[0] - slopes[1]) / 3


def _faster(trial: Trial, name: str, by: float) -> list[Trial]:
    """With the speed larger, and smaller, by that much."""
    try:
        return [trial.faster(f"{name}'", sign * by) for sign in (1, -1)]
    except NoValue:
        return [trial.faster(name, sign * by) for sign in (1, -1)]


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
