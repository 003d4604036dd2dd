"""System -> what its model asks in [outputs] as functions of the state, for emitted code."""

from __future__ import annotations

from dataclasses import field

from eomgen.errors import DerivationError, ExpressionError, MissingValues
from eomgen.mechanics.equations.system import System
from eomgen.mechanics.instant.outputs import Quantities, asks_of
from eomgen.model.outputs.base import OF_A_RUN, SMALL_MOTIONS
from eomgen.model.parts import Output
from eomgen.records import dataclass
from eomgen.symbolic.expression.derivative import depends_on
from eomgen.symbolic.expression.graph import Scalar


@dataclass(frozen=True)
class AskedOutputs:
    """Outputs in q, u, a, t, parameters and inputs [SI], and why the others are none.

    Args:
        values: by name.
        left: name -> why it is no function of the state.
    """

    values: dict[str, Scalar] = field(default_factory=dict)
    left: dict[str, str] = field(default_factory=dict)


def outputs_of_state(system: System) -> AskedOutputs:
    """The outputs of the model."""
    found, quantities, symbols = AskedOutputs(), Quantities(system), system.symbols
    unknown = (*symbols.lam, *symbols.unknowns.values())
    for name, output in system.scope.model.outputs.items():
        why = _of_an_instant(output)
        if not why:
            try:
                scalar = quantities.of(output.value)
                why = "it holds a multiplier or an unknown load" if depends_on(scalar, unknown) else ""
            except (DerivationError, ExpressionError, MissingValues) as error:
                why = error.what
        if why:
            found.left[name] = why
        else:
            found.values[name] = scalar
    return found


def _of_an_instant(output: Output) -> str:
    """Why an output is no function of the state, "" where it may be one."""
    if output.at is not None or output.from_ is not None or output.side is not None or output.event is not None:
        return "it is asked at an instant"
    if asks_of(output.value, SMALL_MOTIONS):
        return "it is of the linearized system"
    return "it is of a whole run" if asks_of(output.value, OF_A_RUN) else ""
