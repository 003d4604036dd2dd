"""Forces, a state -> whether a force jumps there: dry friction that is written as -c*sign(x'), where nothing slides.

At rest such a force may have any value in between, and whether it holds is not said by the equations of motion.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from eomgen.errors import DerivationError
from eomgen.mechanics.equations.system import System
from eomgen.mechanics.equations.work import generalized_forces
from eomgen.model.values import exact_parameters
from eomgen.symbolic.expression.derivative import depends_on, substituted
from eomgen.symbolic.expression.graph import Node, Scalar, is_zero
from eomgen.symbolic.expression.rational import Fraction
from eomgen.symbolic.expression.traversal import order
from eomgen.symbolic.print.text import to_text
from eomgen.symbolic.solve.solving import vanishes

SMOOTH = "tanh(w/eps) in place of sign(w) runs, and creeps where dry friction sticks: the slower, the smaller eps is"


def signs_of_rates(system: System) -> tuple[Scalar, ...]:
    """What stands in sign(...) in the forces, and changes with a rate."""
    if signs_of_rates not in system.found:
        forces = generalized_forces(system.loads)
        given = [node.args[0] for node in order(forces) if node.op == "sign"]
        system.found[signs_of_rates] = tuple(x for x in given if depends_on(x, system.symbols.u))
    found: tuple[Scalar, ...] = system.found[signs_of_rates]
    return found


def refuse_jump(system: System, state: Mapping[Node, Any]) -> None:
    """Refuse a state at which a force jumps with the sign of a rate.

    Raises:
        DerivationError: the rate is 0 there, with the values that parameters and inputs have.
    """
    signs = signs_of_rates(system)
    known = exact_parameters(system.scope.model) if signs else {}
    inputs = {node: system.inputs[name] for name, node in system.symbols.inputs.items()}
    values = {system.symbols.parameters[name]: Fraction(x) for name, x in known.items()}
    for x in signs:
        (there,) = substituted(substituted(substituted((x,), inputs), state), values)
        if is_zero(there) or vanishes(there):
            what = f"a force jumps with the sign of {to_text(x)}, which is 0 there: dry friction may hold it or not"
            raise DerivationError(what, mend=SMOOTH)
