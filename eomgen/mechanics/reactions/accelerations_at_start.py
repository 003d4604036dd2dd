"""Equations of motion -> accelerations and multipliers by the independent accelerations: few freedoms, many ties.

    a = Z a_i + X,   Z^T M Z a_i = Z^T (F - M X),   J_d^T lam = (M a - F)_d

J = (J_i, J_d) with J_d regular; Z = (1, A), X = (0, b) with J_d A = -J_i, J_d b = -gamma.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from contextlib import suppress

import numpy as np

from eomgen.errors import DerivationError, ModelError
from eomgen.mechanics.constraints.closure import generic_state
from eomgen.mechanics.equations.equations_of_motion import EquationsOfMotion
from eomgen.mechanics.equations.system import System
from eomgen.mechanics.initial_state.initial_state import begun_state
from eomgen.symbolic.expression.functions import inner
from eomgen.symbolic.expression.graph import Node, Scalar, is_zero
from eomgen.symbolic.expression.node import State
from eomgen.symbolic.numeric.dense import independent_rows
from eomgen.symbolic.numeric.evaluation import evaluate, fifty_digits
from eomgen.symbolic.numeric.tolerances import RANK_NEARBY
from eomgen.symbolic.solve import cramer

FEW = 3  # freedoms


def by_independent(equations: EquationsOfMotion, kept: Sequence[int]) -> dict[Node, Scalar]:
    """a and lam, where the ties leave few freedoms; redundant rows are left out, their lam 0.

    Args:
        kept: the closing rows that do not follow from others.
    Raises:
        DerivationError: too many unknowns hang together.
        MissingValues: the ties do not close without values.
    """
    symbols, n = equations.symbols, len(equations.M)
    J = [equations.J[m] for m in kept]
    d = _dependent(equations.system, J)
    i = [k for k in range(n) if k not in d]
    right = [(*(-row[k] for k in i), -equations.gamma[m]) for m, row in zip(kept, J, strict=True)]
    columns, _ = cramer.solution_by_minors([_entries([row[k] for k in d]) for row in J], right)
    follows = dict(zip(d, columns, strict=True))
    Z = [follows[k][:-1] if k in follows else tuple(int(k == j) for j in i) for k in range(n)]
    X = [follows[k][-1] if k in follows else 0 for k in range(n)]
    a = _moved(equations, Z, X)
    pull = [inner(equations.M[k], a) - equations.forcing[k] for k in d]
    lam, _ = cramer.solution_by_minors([_entries([row[k] for row in J]) for k in d], [(x,) for x in pull])
    multipliers = {symbols.lam[m]: x for m, (x,) in zip(kept, lam, strict=True)}
    return dict(zip(symbols.a, a, strict=True)) | {x: multipliers.get(x, 0) for x in symbols.lam}


def _moved(equations: EquationsOfMotion, Z: Sequence[Sequence[Scalar]], X: Sequence[Scalar]) -> list[Scalar]:
    """a = Z a_i + X of the independent accelerations that the forces make."""
    freedoms = range(len(Z[0]))
    columns = [[row[j] for row in Z] for j in freedoms]
    moved = [[inner(row, column) for row in equations.M] for column in columns]
    left = [force - inner(row, X) for force, row in zip(equations.forcing, equations.M, strict=True)]
    reduced = [_entries([inner(column, each) for each in moved]) for column in columns]
    found, _ = cramer.solution_by_minors(reduced, [(inner(column, left),) for column in columns])
    return [inner(row, [x for (x,) in found]) + x for row, x in zip(Z, X, strict=True)]


def _dependent(system: System, J: Sequence[Sequence[Scalar]]) -> list[int]:
    """The speeds that follow from the others at the start, if it is not special; the last ones rather."""
    entries = [x for row in J for x in row]
    many = len(system.symbols.u)
    for state in _states(system):
        columns = np.array([float(x) for x in evaluate(entries, state, fifty_digits())]).reshape(len(J), many).T
        found = sorted(many - 1 - k for k in independent_rows(columns[::-1], RANK_NEARBY))
        if len(found) == len(J):
            break
    return found


def _states(system: System) -> Iterator[State]:
    """The start where it has values, then a configuration that is not special."""
    with suppress(DerivationError, ModelError):
        yield begun_state(system)
    yield generic_state(system.ties)


def _entries(row: Sequence[Scalar]) -> dict[int, Scalar]:
    return {j: x for j, x in enumerate(row) if not is_zero(x)}
