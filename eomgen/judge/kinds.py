"""An equation -> what it is about: an equation of motion, an energy, a reaction, ... by what stands in it."""

from __future__ import annotations

from eomgen.judge.reading import MULTIPLIER, HandEquation
from eomgen.model.outputs import ALL
from eomgen.model.outputs.acceleration import ACCELERATION, MAGNITUDE_OF_ACCELERATION
from eomgen.model.outputs.along_coordinates import GENERALIZED_FORCE
from eomgen.model.outputs.base import BALANCE, MASSES, SMALL_MOTIONS
from eomgen.model.outputs.energies import KINETIC_ENERGY, POTENTIAL_ENERGY, POWER
from eomgen.model.outputs.path import CURVATURE_RADIUS, NORMAL_ACCELERATION, TANGENTIAL_ACCELERATION
from eomgen.model.outputs.turning import ANGULAR_ACCELERATION, EPSILON
from eomgen.model.parts import Model

KINDS = (
    "motion",
    "energy",
    "force",
    "reaction",
    "velocity",
    "acceleration",
    "inertia",
    "frequency",
    "equilibrium",
    "statics",
    "law",
)
_OF = {
    KINETIC_ENERGY: "energy",
    POTENTIAL_ENERGY: "energy",
    POWER: "energy",
    GENERALIZED_FORCE: "force",
    **dict.fromkeys((ACCELERATION, MAGNITUDE_OF_ACCELERATION, TANGENTIAL_ACCELERATION), "acceleration"),
    **dict.fromkeys((NORMAL_ACCELERATION, CURVATURE_RADIUS, EPSILON, ANGULAR_ACCELERATION), "acceleration"),
}
_BY_SOURCE = {BALANCE: "reaction", MASSES: "inertia", SMALL_MOTIONS: "frequency"}
FUNCTION_KINDS = {
    name: _OF.get(function) or _BY_SOURCE.get(function.source) or "velocity"
    for function in ALL
    for name in function.names
}


def kind_of_equation(written: HandEquation, model: Model) -> str:
    """What an equation is about."""
    names = written.names
    speeds = {f"{name}'" for name in model.speeds}
    accelerated = written.takes_rates or any(name.endswith("''") or name in speeds for name in names)
    alone = written.left.code[0] if len(written.left.code) == 1 else None
    if alone is not None and alone[0] == "call":
        return _of_call(alone[1].name, model)
    if accelerated:
        return "motion"
    for call in written.calls:
        if call.name == MULTIPLIER:
            return "motion"
        return _of_call(call.name, model)
    if not model.coordinates or names & model.unknowns.keys():
        return "statics"
    moving = any(name.endswith("'") or name in model.speeds for name in names)
    if moving or "t" in names:
        return "law"
    return "equilibrium"


def _of_call(name: str, model: Model) -> str:
    kind = FUNCTION_KINDS.get(name, "velocity")
    return "statics" if kind == "reaction" and not model.coordinates else kind
