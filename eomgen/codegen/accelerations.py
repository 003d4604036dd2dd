"""Equations, a state -> the accelerations and multipliers there, those that have a single value.

    M a - J^T lam = forcing,   J a = -gamma

lam_i has one value where no combination of rows that vanishes holds it: n_i = 0 for every n with n^T J = 0.
"""

from __future__ import annotations

import numpy as np

from eomgen.codegen.program import bordered, program_of
from eomgen.codegen.rhs import compiled
from eomgen.mechanics.constraints.freedom import rank_of_ties
from eomgen.mechanics.equations.equations_of_motion import EquationsOfMotion
from eomgen.records import dataclass
from eomgen.symbolic.numeric.dense import of_one_length
from eomgen.symbolic.numeric.tolerances import RANK, SHARE


@dataclass(frozen=True)
class Accelerations:
    """a and lam at one state by name, "theta''" and "lam(pin, 1)"; None where there is no single value."""

    a: dict[str, float | None]
    lam: dict[str, float | None]


def closing_accelerations(equations: EquationsOfMotion, t: float, x: np.ndarray, p: np.ndarray) -> Accelerations:
    """The accelerations and multipliers at one state; none has a single value where branches meet.

    Args:
        p: the parameters' values.
    """
    system = equations.system
    symbols, rows = system.symbols, [row.label for row in system.ties.closing]
    names = [f"{u.name}'" for u in symbols.u]
    if not names:
        return Accelerations({}, {})
    outputs = (*symbols.a, *symbols.lam, *(entry for row in equations.J for entry in row))
    program = program_of(outputs, symbols, inputs=system.inputs, solve=bordered(equations))
    values = compiled(program, "numpy")(t, x, p)
    a, lam, J = np.split(values, [len(names), len(names) + len(rows)])
    left = _left(J.reshape(len(rows), len(names)))
    if len(left) and len(rows) - len(left) < rank_of_ties(system.ties):
        return Accelerations(dict.fromkeys(names), dict.fromkeys(rows))
    single = np.max(np.abs(left), axis=0, initial=0.0) < SHARE
    return Accelerations(
        {name: _number(value) for name, value in zip(names, a, strict=True)},
        {name: _number(value) if one else None for name, value, one in zip(rows, lam, single, strict=True)},
    )


def _left(J: np.ndarray) -> np.ndarray:
    """n with n^T J = 0, one a row; all where J has no value."""
    if not J.size or not np.all(np.isfinite(J)):
        return np.eye(len(J))
    U, sizes, _ = np.linalg.svd(of_one_length(J))
    left: np.ndarray = U[:, int(np.sum(sizes > RANK)) :].T
    return left


def _number(x: float) -> float | None:
    return float(x) if np.isfinite(x) else None
