"""kinetic_energy, potential_energy, power: of the whole, of one body, or of one force.

By the second way T = sum m v.v/2 over particles, what the file gives as an energy beside it, and the power of a force
whose potential does not see time is -dV/dt.
"""

from __future__ import annotations

from typing import Any

from eomgen.model.outputs.base import OutputFunction, names_of
from eomgen.model.outputs.context import Trial
from eomgen.symbolic.expression.derivative import depends_on
from eomgen.symbolic.expression.expressions import Call
from eomgen.symbolic.expression.graph import Node
from eomgen.symbolic.expression.spatial import dot
from eomgen.symbolic.numeric.evaluation import NoValue


def _of_particles(trial: Trial, call: Call) -> Any:
    asked = names_of(call)
    of_bodies = sum(m * dot(v, v) / 2 for body in asked or trial.scene.bodies for m, _, v in trial.particles(body))
    return of_bodies if asked else of_bodies + trial.given_energy()


def _lost(trial: Trial, call: Call) -> Any:
    """-dV/dt of one force, by differences."""
    force = names_of(call)
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
    value=lambda scene, call: scene.kinetic_energy(*names_of(call)),
    second=_of_particles,
    moves=True,
)
POTENTIAL_ENERGY = OutputFunction(
    names=("potential_energy",),
    kinds=("body or force",),
    least=0,
    unit="J",
    gives="of the whole, of one force, or of what belongs to one body alone",
    value=lambda scene, call: scene.potential_energy(*names_of(call)),
)
POWER = OutputFunction(
    names=("power",),
    kinds=("body or force",),
    least=0,
    unit="W",
    gives="of everything applied, of all that acts on one body, or of one force",
    value=lambda scene, call: scene.power(*names_of(call)),
    second=_lost,
    moves=True,
)
