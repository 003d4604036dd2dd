"""axial_force, shear_force, bending_moment: at a distance from the start of a body's line."""

from __future__ import annotations

from eomgen.errors import DerivationError
from eomgen.model.outputs.base import BALANCE, SIDES, OutputFunction, ValueOf, name_at
from eomgen.model.outputs.context import OutputContext
from eomgen.symbolic.expression.expressions import Call, Expression, Reference, parse
from eomgen.symbolic.expression.spatial import AnyScalar


def distance_of(call: Call) -> Expression:
    """The second argument: L-c reads like a member."""
    x = call.args[1]
    return parse(x.name) if isinstance(x, Reference) else x


def _section(scene: OutputContext, call: Call) -> AnyScalar:
    """bending_moment(beam, a), shear_force(beam, a, before)."""
    sides = [name_at(call, k) for k in range(2, len(call.args))]
    if any(name not in SIDES for name in sides):
        raise DerivationError(f"'{call}': the third argument is before or after", mend="N(body, x, before)")
    x = distance_of(call).evaluate(scene.names)
    return scene.section(name_at(call, 0)).value(call.name, x, *sides)


def _of(name: str, unit: str, gives: str, value: ValueOf) -> OutputFunction:
    return OutputFunction(
        names=(name,),
        kinds=("body", "number", "side"),
        least=2,
        shown="(body, distance[, before or after])",
        unit=unit,
        gives=gives,
        value=value,
        source=BALANCE,
    )


SECTION_FORCES = (
    _of("axial_force", "N", "[section forces](#section-forces), at a distance from the start of its line", _section),
    _of("shear_force", "N", "across it; at a jump the side is needed", _section),
    _of("bending_moment", "N*m", "the moment there", _section),
)
