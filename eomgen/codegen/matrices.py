"""Equations of motion -> Programs of their matrices, and of the slopes of the right-hand side."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace

from eomgen.codegen.program import Program, Solve, bordered, is_short, kinematic_rates, program_of
from eomgen.mechanics.equations.equations_of_motion import EquationsOfMotion
from eomgen.records import dataclass
from eomgen.symbolic.expression.derivative import jacobian, substituted
from eomgen.symbolic.expression.graph import Node, Scalar, is_zero
from eomgen.symbolic.expression.node import ScalarRow, ScalarRows
from eomgen.symbolic.solve.factorization import factor_solution

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
        motion: the system behind a and lam; None where a is written out.
        solves: the systems behind their slopes, one for each column that is not zero.
    """

    blocks: Blocks
    motion: Solve | None = None
    solves: tuple[Solve, ...] = ()


def slopes_of(equations: EquationsOfMotion) -> RateSlopes:
    """The slopes of x' = (N u + nu, a) in x and inputs.

    From the matrix of the motion itself, factored once, with its pivots where ties close:

        [[M, -J^T], [J, 0]] [da; dlam] = -d(M a - J^T lam - forcing, J a + gamma) at fixed a, lam

    Where no ties close and it takes fewer operations, those of the accelerations written out.

    Raises:
        DerivationError: the mass matrix is singular whatever the state.
    """
    if equations.J and not equations.friction:
        return _solved(equations)
    a = equations.accelerations or factor_solution(equations.M, equations.forcing)
    rates = (*kinematic_rates(equations), *a)
    found = [RateSlopes({name: jacobian(rates, x) for name, x in _columns(equations).items()})]
    if not equations.friction:
        found.append(_written_out(equations, a) if is_short(equations) else _solved(equations))
    return min(found, key=lambda s: program_of_blocks(s.blocks, equations, s.motion, s.solves).count.total)


def _written_out(equations: EquationsOfMotion, a: ScalarRow) -> RateSlopes:
    """M da = -d(M a - forcing) by one factorization, that of all columns."""
    rates, (left, _) = kinematic_rates(equations), equations.residual
    known, blocks = dict(zip(equations.symbols.a, a, strict=True)), {}
    for name, states in _columns(equations).items():
        changes = zip(*jacobian(left, states), strict=True)
        slopes = [factor_solution(equations.M, [-y for y in substituted(column, known)]) for column in changes]
        blocks[name] = (*jacobian(rates, states), *zip(*slopes, strict=True))
    return RateSlopes(blocks)


def _columns(equations: EquationsOfMotion) -> dict[str, tuple[Node, ...]]:
    """What A and B are slopes in."""
    symbols = equations.symbols
    columns: dict[str, tuple[Node, ...]] = {"A": (*symbols.q, *symbols.u)}
    return columns | ({"B": tuple(symbols.inputs.values())} if symbols.inputs else {})


def _solved(equations: EquationsOfMotion) -> RateSlopes:
    """By the `Solve` of the motion, and one of its right sides for each column that is not zero."""
    symbols, rates, motion = equations.symbols, kinematic_rates(equations), bordered(equations)
    left = dict(zip((*symbols.a, *symbols.lam), (x for rows in equations.residual for x in rows), strict=True))
    solves: dict[Node, Solve] = {}
    blocks: dict[str, ScalarRows] = {}
    for name, states in _columns(equations).items():
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
