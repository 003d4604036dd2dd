"""Equations of motion -> Programs of their matrices, and of the slopes of the right-hand side."""

from __future__ import annotations

from collections.abc import Mapping

from eomgen.codegen.program import Program, kinematic_rates, program_of
from eomgen.codegen.solved_equations import accelerations_and_multipliers
from eomgen.mechanics.equations.equations_of_motion import EquationsOfMotion
from eomgen.symbolic.expression.derivative import jacobian, substituted
from eomgen.symbolic.expression.graph import Scalar
from eomgen.symbolic.expression.node import ScalarRows

Blocks = Mapping[str, ScalarRows]
"""Matrices by name, one after the other, each row after row."""


def matrices_of(equations: EquationsOfMotion) -> dict[str, ScalarRows]:
    """M and forcing of M a = forcing + J^T lam, and where ties close J and gamma of J a + gamma = 0; by name."""
    blocks: dict[str, ScalarRows] = {"M": equations.M, "forcing": tuple((x,) for x in equations.forcing)}
    if equations.J:
        blocks |= {"J": equations.J, "gamma": tuple((x,) for x in equations.gamma)}
    return blocks


def slopes_of(equations: EquationsOfMotion) -> dict[str, ScalarRows]:
    """A = d x'/d x and, where there are inputs, B = d x'/d inputs, written out; without a value where a pivot vanishes.

    Where ties close they are the slopes of a and lam by the elimination of the rows that are independent elsewhere.

    Raises:
        DerivationError: the mass matrix is singular whatever the state.
    """
    symbols = equations.symbols
    if equations.J or equations.accelerations is None:
        known = accelerations_and_multipliers(equations)
        a = tuple(known[x] for x in symbols.a)
    else:
        a = equations.accelerations
    rates = substituted((*kinematic_rates(equations), *symbols.a), dict(zip(symbols.a, a, strict=True)))
    blocks: dict[str, ScalarRows] = {"A": jacobian(rates, (*symbols.q, *symbols.u))}
    if symbols.inputs:
        blocks["B"] = jacobian(rates, tuple(symbols.inputs.values()))
    return blocks


def program_of_blocks(blocks: Blocks, equations: EquationsOfMotion) -> Program:
    """The entries as one program."""
    return program_of(entries_of(blocks), equations.symbols, inputs=equations.inputs)


def entries_of(blocks: Blocks) -> tuple[Scalar, ...]:
    return tuple(x for rows in blocks.values() for row in rows for x in row)
