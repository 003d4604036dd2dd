"""Equations of motion -> Programs of their matrices, and of the slopes of the right-hand side."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace

from eomgen.codegen.factorization import factor_solution
from eomgen.codegen.program import Program, Solve, bordered, kinematic_rates, program_of
from eomgen.mechanics.equations.equations_of_motion import EquationsOfMotion
from eomgen.records import dataclass
from eomgen.symbolic.expression.derivative import jacobian
from eomgen.symbolic.expression.graph import Node, Scalar, is_zero
from eomgen.symbolic.expression.node import ScalarRow, ScalarRows

Blocks = Mapping[str, ScalarRows]
"""Matrices by name, one after the other, each row after row."""


def matrices_of(equations: EquationsOfMotion) -> dict[str, ScalarRows]:
    """M and forcing of M a = forcing + J^T lam, and where ties close J and gamma of J a + gamma = 0; by name."""
    blocks: dict[str, ScalarRows] = {"M": equations.M, "forcing": tuple((x,) for x in equations.forcing)}
    if equations.J:
        blocks |= {"J": equations.J, "gamma": tuple((x,) for x in equations.gamma)}
    return blocks


@dataclass(frozen=True)
class RateSlopes:
    """Of the right-hand side.

    Args:
        blocks: A = d x'/d x and, where there are inputs, B = d x'/d inputs.
        motion: the system behind a and lam, where ties close; None where a is written out.
        solves: the systems behind their slopes, one for each column that is not zero.
    """

    blocks: Blocks
    motion: Solve | None = None
    solves: tuple[Solve, ...] = ()


def slopes_of(equations: EquationsOfMotion) -> RateSlopes:
    """The slopes of x' = (N u + nu, a) in x and inputs.

    Where ties close they come from the matrix of the motion itself, with its pivots:

        [[M, -J^T], [J, 0]] [da; dlam] = -d(M a - J^T lam - forcing, J a + gamma) at fixed a, lam

    Raises:
        DerivationError: the mass matrix is singular whatever the state.
    """
    symbols, rates = equations.symbols, kinematic_rates(equations)
    columns = {"A": (*symbols.q, *symbols.u)}
    columns |= {"B": tuple(symbols.inputs.values())} if symbols.inputs else {}
    if not equations.J or equations.friction:
        a = equations.accelerations or factor_solution(equations.M, equations.forcing)
        return RateSlopes({name: jacobian((*rates, *a), x) for name, x in columns.items()})
    motion = bordered(equations)
    left = dict(zip((*symbols.a, *symbols.lam), (x for rows in equations.residual for x in rows), strict=True))
    solves: dict[Node, Solve] = {}
    blocks: dict[str, ScalarRows] = {}
    for name, states in columns.items():
        changes = jacobian([left[y] for y in motion.unknowns], states)
        solves |= {
            x: _change(motion, x, column)
            for x, column in zip(states, zip(*changes, strict=True), strict=True)
            if not all(map(is_zero, column))
        }
        moved = {x: dict(zip(motion.unknowns, solves[x].unknowns, strict=True)) for x in states if x in solves}
        below = (tuple(moved[x][a] if x in moved else 0 for x in states) for a in symbols.a)
        blocks[name] = (*jacobian(rates, states), *below)
    return RateSlopes(blocks, motion, tuple(solves.values()))


def _change(motion: Solve, x: Node, change: ScalarRow) -> Solve:
    """The system behind d(a, lam)/dx, by what x changes in that behind (a, lam)."""
    unknowns = tuple(x.graph.symbol(f"{y.name} by {x.name}") for y in motion.unknowns)
    return replace(motion, right=tuple(-y for y in change), unknowns=unknowns)


def program_of_blocks(
    blocks: Blocks, equations: EquationsOfMotion, solve: Solve | None = None, further: Sequence[Solve] = ()
) -> Program:
    """The entries as one program; the systems behind them as of `program_of`."""
    return program_of(entries_of(blocks), equations.symbols, inputs=equations.inputs, solve=solve, further=further)


def entries_of(blocks: Blocks) -> tuple[Scalar, ...]:
    return tuple(x for rows in blocks.values() for row in rows for x in row)
