"""Reactions, equations of motion -> Program: every reaction that has a single value, along the motion."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np

from eomgen.codegen.program import Program, program_in_motion
from eomgen.codegen.rhs import RightHandSide
from eomgen.mechanics.balance.balance_solution import Indeterminate
from eomgen.mechanics.balance.named_reactions import named_reactions
from eomgen.mechanics.equations.equations_of_motion import EquationsOfMotion
from eomgen.mechanics.reactions.reactions import Reactions
from eomgen.records import dataclass
from eomgen.symbolic.expression.graph import Scalar


@dataclass(frozen=True)
class ReactionFunction:
    """`reactions(t, x, p, inputs=())` -> the reactions of the motion through a state, in the order of `names`.

    Args:
        names: as outputs ask for them.
        function: the program in memory.
    """

    names: tuple[str, ...]
    function: RightHandSide

    def __call__(self, t: float, x: Any, p: Any, inputs: Sequence[float] = ()) -> np.ndarray:
        """At one state [N, N m]."""
        return self.function(t, x, p, inputs)

    def many(self, t: Any, x: Any, p: Any, inputs: Any = ()) -> np.ndarray:
        """At n states at once: n x names."""
        return self.function.many(t, x, p, inputs)


def determinate(reactions: Reactions) -> dict[str, Scalar]:
    """{name as an output asks for it: value in q, u and the accelerations}; what has no single value is left out."""
    found: dict[str, Scalar] = {}
    for named in named_reactions(reactions.balance):
        try:
            found[named.name] = reactions.combined(named.combination, named.name) + named.given
        except Indeterminate:
            continue
    return found


def reactions_program(values: Mapping[str, Scalar], equations: EquationsOfMotion) -> tuple[tuple[str, ...], Program]:
    """(names, the program of their values), the accelerations from the same equations as in the right-hand side.

    Args:
        values: as of `determinate`.
    """
    return tuple(values), program_in_motion(tuple(values.values()), equations)
