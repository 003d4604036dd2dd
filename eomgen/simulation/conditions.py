"""Text of an equation -> Condition: where a run is to end, as a function of a phase's state and accelerations."""

from __future__ import annotations

import dataclasses
from collections.abc import Callable

from eomgen.errors import ExpressionError, ModelError, UsageError
from eomgen.mechanics.equations.system import System
from eomgen.mechanics.instant.outputs import Quantities
from eomgen.model.fields import WrittenEquation
from eomgen.model.parts import Model, Output
from eomgen.model.table import Table
from eomgen.symbolic.expression.expressions import parse, parse_equation
from eomgen.symbolic.expression.graph import Scalar

SystemCondition = Callable[[System], Scalar]
"""What is asked to become 0, over the symbols, accelerations and multipliers of a system."""


def condition_of(model: Model, text: str) -> SystemCondition:
    """Left side minus right side of an equation such as "theta = pi/2" or "reaction_n(wall) = 0".

    Raises:
        UsageError: it is no equation, or names what the model does not have.
    """
    try:
        equation = WrittenEquation(*parse_equation(text), text=text)
        dataclasses.replace(model, outputs=Table({"until": Output(value=parse("t"), at=equation)}))
    except ExpressionError as error:
        raise UsageError(f"until '{text}': {error.what}", mend=error.mend or 'write "theta = pi/2"') from error
    except ModelError as error:
        raise UsageError(f"until '{text}': {error.problems[0].what}", mend=error.problems[0].mend) from error

    def difference(system: System) -> Scalar:
        names, value = system.scope.names, Quantities(system).value
        return equation.left.evaluate(names, value) - equation.right.evaluate(names, value)

    return difference
