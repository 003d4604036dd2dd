"""System, values by name -> where places of rest are sought first: as asked, else `near`, else the start.

And in what unit lengths are measured while they are sought: one of the model's own size.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from functools import cached_property
from typing import Any

import numpy as np

from eomgen.errors import UsageError
from eomgen.mechanics.bodies.kinematics import Motion
from eomgen.mechanics.bodies.system_scene import start_value
from eomgen.mechanics.equations.system import System
from eomgen.model.values import first_guesses, start_values
from eomgen.records import dataclass
from eomgen.symbolic.expression.graph import Node, Scalar
from eomgen.symbolic.expression.rational import Fraction
from eomgen.symbolic.numeric.evaluation import FLOAT, NoValue, evaluate, fifty_digits


@dataclass(frozen=True)
class Guess:
    """Where to begin.

    Args:
        system: whose coordinates they are.
        values: of the parameters, with 50 digits.
        asked: coordinates by name, in place of `near` and `start`.
    """

    system: System
    values: Mapping[Node, Any]
    asked: Mapping[str, float]

    def of(self, coordinates: Sequence[Node]) -> np.ndarray:
        """Numbers of coordinates.

        Raises:
            UsageError: a name is asked that is no coordinate.
        """
        return np.array([float(self._numbers[q.name]) for q in coordinates])

    def exact(self, q: Node) -> Scalar:
        """One as a scalar of the parameters."""
        scope = self.system.scope
        near = scope.model.coordinates[q.name].near
        if q.name in self.asked:
            return Fraction(self.asked[q.name])
        return start_value(scope, q) if near is None else scope.value(near)

    @cached_property
    def _numbers(self) -> dict[str, float]:
        model = self.system.scope.model
        unknown = [name for name in self.asked if name not in model.coordinates]
        if unknown:
            raise UsageError(f"no coordinate '{unknown[0]}'", mend=f"one of {', '.join(model.coordinates)}")
        trial = {name: float(self.values[x]) for name, x in self.system.symbols.parameters.items()}
        return {**start_values(model, trial)[0], **first_guesses(model, trial), **self._near, **self.asked}

    @property
    def _near(self) -> dict[str, float]:
        """The first guesses of coordinates that are not dependent."""
        scope, found = self.system.scope, {}
        for name, part in scope.model.coordinates.items():
            if part.near is not None:
                found[name] = float(evaluate((scope.value(part.near),), self.values, fifty_digits())[0])
        return found


def unit_of_length(motion: Motion, state: Mapping[Node, float]) -> Fraction:
    """A length of the model's own size [m]: the largest distance of two of its points along an axis, to one digit.

    1 where there are no two such points.
    """
    scope, symbols = motion.scope, motion.scope.symbols
    places = [motion.position((body, r)) for body, points in motion.points.items() for r in points.values()]
    places += [scope.vector(r) for r in scope.model.points.values()]
    try:
        x = evaluate([x for p in places for x in p], dict.fromkeys((*symbols.q, symbols.t), 0.0) | {**state}, FLOAT)
    except NoValue:
        return Fraction(1)
    largest = float(np.max(np.ptp(np.array(x, dtype=float).reshape(-1, 3), axis=0), initial=0.0)) if places else 0.0
    return Fraction(f"{largest:.0e}" if 0 < largest < math.inf else 1)
