"""Reactions, Assembly -> Program: every reaction that has a single value, as a function of (t, x, p, inputs)."""

from __future__ import annotations

from collections.abc import Mapping

from eomgen.codegen.program import Program, program_in_motion
from eomgen.mechanics.assembly import Assembly
from eomgen.mechanics.named_reactions import named_reactions
from eomgen.mechanics.reactions import Indeterminate, Reactions
from eomgen.symbolic.graph import Scalar


def determinate(reactions: Reactions) -> dict[str, Scalar]:
    """{name as an output asks for it: value in q, u and the accelerations}; what has no single value is left out."""
    found: dict[str, Scalar] = {}
    for named in named_reactions(reactions.balance):
        try:
            found[named.name] = reactions.combined(named.combination, named.name) + named.given
        except Indeterminate:
            continue
    return found


def reactions_program(
    reactions: Reactions, assembly: Assembly, inputs: Mapping[str, Scalar] | None = None
) -> tuple[tuple[str, ...], Program]:
    """(names, the program of their values): the accelerations are those of the right-hand side, from the same equations.

    Args:
        inputs: the model's own expression of each input, in t and parameters.
    """
    values = determinate(reactions)
    return tuple(values), program_in_motion(tuple(values.values()), assembly, inputs)
