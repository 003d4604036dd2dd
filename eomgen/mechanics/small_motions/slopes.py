"""EquationsOfMotion -> A, B of dx' = A dx + B dw at any state, in numbers.

K [da; dlam] = -[R_q dq + R_u du - W dw; A_q dq + A_u du],   K = [M, -J^T; J, 0],   dq' = S_q dq + N du
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np

from eomgen.mechanics.small_motions.first_order import FirstOrder
from eomgen.symbolic.expression.graph import Node, Scalar
from eomgen.symbolic.numeric.evaluation import FLOAT, evaluate
from eomgen.symbolic.numeric.tolerances import RANK


def slopes_at(first: FirstOrder, state: Mapping[Node, Any], *, single: bool = False) -> tuple[np.ndarray, np.ndarray]:
    """(d x'/d x, d x'/d w) at a state, x = (q, u); where ties follow from others their multipliers are the least.

    Args:
        state: t, parameters, inputs, q and u as floats.
        single: nan where a change opens ties that follow from others: no acceleration then closes them all.
    """
    e, s = first.equations, first.system.symbols
    nq, nu, k, w = len(s.q), len(s.u), len(e.J), len(s.inputs)
    M, J, N = _matrix(state, e.M, nu), _matrix(state, e.J, nu), _matrix(state, e.N, nu)
    K = np.block([[M, -J.T], [J, np.zeros((k, k))]])
    right = np.concatenate([_matrix(state, (e.forcing,), nu)[0], -_matrix(state, (e.gamma,), k)[0]])
    found = _solved(K, right, k)
    state = {**state, **dict(zip((*s.a, *s.lam), found.tolist(), strict=True))}
    columns = {"R_q": nq, "R_u": nu, "W": w, "A_q": nq, "A_u": nu, "S_q": nq}
    at = {name: _matrix(state, first.derivatives[name], n) for name, n in columns.items()}
    slopes = np.block([[at["R_q"], at["R_u"], -at["W"]], [at["A_q"], at["A_u"], np.zeros((k, w))]])
    changes = _solved(K, slopes, k)
    below = 0.0 - changes[:nu]
    if single:
        left = abs(K @ changes - slopes).max(axis=0, initial=0.0)
        below[:, left > RANK * (1.0 + abs(slopes).max(axis=0, initial=0.0))] = np.nan
    both = np.vstack([np.hstack([at["S_q"], N, np.zeros((nq, w))]), below])
    return both[:, : nq + nu], both[:, nq + nu :]


def _solved(K: np.ndarray, right: np.ndarray, ties: int) -> np.ndarray:
    found: np.ndarray = np.linalg.lstsq(K, right, rcond=None)[0] if ties else np.linalg.solve(K, right)
    return found


def _matrix(state: Mapping[Node, Any], rows: Sequence[Sequence[Scalar]], columns: int) -> np.ndarray:
    flat = evaluate([x for row in rows for x in row], state, FLOAT)
    return np.array(flat, dtype=float).reshape(len(rows), columns)
