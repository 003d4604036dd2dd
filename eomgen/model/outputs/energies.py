"""Energies, powers, generalized forces and momenta.

kinetic_energy, potential_energy, power: of the whole, of one body, or of one force.

By the second way T = sum m v.v/2 over particles, with the energies that the file gives, and the power of a force
whose potential does not see time is -dV/dt.
"""

from __future__ import annotations

from typing import Any

from eomgen.model.outputs.base import OutputFunction, Trial
from eomgen.symbolic.expression import Call, Node, depends_on
from eomgen.symbolic.numeric import NoValue


def _of_particles(trial: Trial, call: Call) -> Any:
    requested = call.names
    of_bodies = sum(m * (v @ v) / 2 for body in requested or trial.scene.bodies for m, _, v in trial.particles(body))
    return of_bodies if requested else of_bodies + trial.given_energy()


def _lost(trial: Trial, call: Call) -> Any:
    """-dV/dt of one force, by differences."""
    force = call.names
    if not force or force[0] in trial.scene.bodies:
        return trial.worked(*force)
    V = trial.scene.potential_energy(force[0])
    t = trial.scene.names["t"]
    if isinstance(t, Node) and depends_on(V, (t,)):
        raise NoValue("the potential depends on time")
    return -trial.along((V,))[1][0]


KINETIC_ENERGY = OutputFunction(
    names=("kinetic_energy",),
    kinds=("body",),
    least=0,
    unit="J",
    gives="of the whole, or of one body",
    value=lambda scene, call: scene.kinetic_energy(*call.names),
    second=_of_particles,
    moves=True,
)
POTENTIAL_ENERGY = OutputFunction(
    names=("potential_energy",),
    kinds=("body or force",),
    least=0,
    unit="J",
    gives="of the whole, of one force, or of what belongs to one body alone",
    value=lambda scene, call: scene.potential_energy(*call.names),
)
POWER = OutputFunction(
    names=("power",),
    kinds=("body or force",),
    least=0,
    unit="W",
    gives="of everything applied, of all that acts on one body, or of one force",
    value=lambda scene, call: scene.power(*call.names),
    second=_lost,
    moves=True,
)


# -------- along coordinates -----------------------------------------------------------------------------------
# generalized_force, momentum: along a coordinate that is free.
#
# By the second way p = dT/du is (T(u + 1) - T(u - 1))/2 over particles, exact as T is quadratic in u; of an energy
# that the file gives in any form it is 4/3 of that difference over h less 1/3 of that over 2 h. Q has none here: the
# certificate compares it by the projection of every load.


SMALL = 2.0**-10  # [m/s, rad/s] of a speed, in the differences of an energy that is no square of it


def _slope_of_energy(trial: Trial, name: str) -> Any:
    more, less = (
        sum(m * (v @ v) for body in t.scene.bodies for m, _, v in t.particles(body)) for t in _faster(trial, name, 1)
    )
    slopes = []
    for by in (SMALL, 2 * SMALL):
        above, below = (t.given_energy() for t in _faster(trial, name, by))
        slopes.append((above - below) / (2 * by))
    return (more - less) / 4 + (4 * slopes[0] - slopes[1]) / 3


def _faster(trial: Trial, name: str, by: float) -> list[Trial]:
    """The trials with the speed larger, and smaller, by that much."""
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
    value=lambda scene, call: scene.generalized_force(call.name_at(0)),
)
MOMENTUM = OutputFunction(
    names=("momentum",),
    kinds=("coordinate or speed",),
    least=1,
    unit="J",
    per=(0,),
    gives="dT/dq' of a coordinate that is free, dT/du of a declared speed",
    value=lambda scene, call: scene.momentum(call.name_at(0)),
    second=lambda trial, call: _slope_of_energy(trial, call.name_at(0)),
)
