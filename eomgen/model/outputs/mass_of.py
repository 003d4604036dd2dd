"""mass_of: of a body, or of one of its parts (of a hole: what it takes away)."""

from __future__ import annotations

from eomgen.errors import DerivationError
from eomgen.model.outputs.base import MASSES, OutputFunction, name_at, number_at
from eomgen.model.outputs.context import OutputContext
from eomgen.symbolic.expression.expressions import Call
from eomgen.symbolic.expression.spatial import AnyScalar


def _mass(scene: OutputContext, call: Call) -> AnyScalar:
    body = name_at(call, 0)
    if body == "ground":
        raise DerivationError(f"'{call}': the ground has no mass", mend="name a body")
    if len(call.args) == 1:
        whole: AnyScalar = scene.mass(body).m
        return whole
    parts = scene.parts(body)
    if parts is None:
        raise DerivationError(f"'{call}': body '{body}' is not made of parts", mend=f"write mass_of({body})")
    return scene.mass_of_part(body, number_at(call, 1, parts))


MASS_OF = OutputFunction(
    names=("mass_of",),
    kinds=("body", "number"),
    least=1,
    unit="kg",
    gives="of a body, or of one of its parts (of a hole: what it takes away)",
    value=_mass,
    source=MASSES,
)
