"""mass, damping, stiffness, frequency: of the linearized system, which is none of a state; proven as `linearize` is."""

from __future__ import annotations

from eomgen.errors import DerivationError
from eomgen.model.outputs.base import SMALL_MOTIONS, OutputFunction
from eomgen.model.outputs.context import OutputContext
from eomgen.symbolic.expression.expressions import Call
from eomgen.symbolic.expression.spatial import AnyScalar


def _of_no_state(scene: OutputContext, call: Call) -> AnyScalar:
    raise DerivationError(f"'{call}' is of the linearized system, not of a state", mend="ask it by itself")


def _entry(name: str, unit: str, letter: str) -> OutputFunction:
    return OutputFunction(
        names=(name,),
        kinds=("coordinate", "coordinate"),
        least=2,
        unit=unit,
        per=(0, 1),
        gives=f"entry of {letter} of the [small motions](#small-motions)",
        value=_of_no_state,
        source=SMALL_MOTIONS,
    )


ENTRIES = (_entry("mass", "J*s^2", "M"), _entry("damping", "J*s", "C"), _entry("stiffness", "J", "K"))
FREQUENCY = OutputFunction(
    names=("frequency",),
    kinds=("number",),
    least=1,
    unit="rad/s",
    gives="the k-th frequency Im λ of the [small motions](#small-motions), ascending",
    value=_of_no_state,
    source=SMALL_MOTIONS,
)
