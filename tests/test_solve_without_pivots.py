"""M a - J^T lam = f, J a = g where no pivot may be sought: the text that JAX and CasADi get, run by numpy."""

from __future__ import annotations

from typing import Any

import mpmath
import numpy as np
import pytest

from eomgen.codegen.targets.python_files import SOLVERS

SPACE: dict[str, Any] = {
    "sqrt": np.sqrt,
    "_matrix": lambda rows, n, k: np.array([x for row in rows for x in row], dtype=float).reshape(n, k),
    "_where_positive": lambda x, a, b: a if x > 0 else b,
    "_factors": np.linalg.cholesky,
    "_solved": lambda factor, B: np.linalg.solve(factor.T, np.linalg.solve(factor, B)),
    "_one": np.eye,
}
exec(SOLVERS["solve"], SPACE)


def solved(M: np.ndarray, J: np.ndarray, f: np.ndarray, g: np.ndarray) -> np.ndarray:
    a, lam = list(f), list(g)
    SPACE["solve"](list(np.triu(M).ravel()), list(J.ravel()), a, lam)
    return np.array(a)


def exact(M: np.ndarray, J: np.ndarray, f: np.ndarray, g: np.ndarray) -> np.ndarray:
    with mpmath.workdps(60):
        K = mpmath.matrix(np.block([[M, -J.T], [J, np.zeros((len(g), len(g)))]]).tolist())
        return np.array([float(x) for x in mpmath.lu_solve(K, mpmath.matrix([*f, *g]))[: len(f)]])


def system(rng: Any, n: int = 5) -> tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray]:
    """M, two rows, f, and accelerations that the gaps come of."""
    X = rng.normal(size=(n, n))
    return X @ X.T + 0.3 * np.eye(n), rng.normal(size=(2, n)), rng.normal(size=n), rng.normal(size=n)


@pytest.mark.parametrize(("near", "error"), [(1, 1e-13), (1e-2, 1e-11), (1e-3, 1e-8)])
def test_a_row_that_nearly_follows_from_others_counts(near, error):
    """Beside a dead centre: where a third row is that far from the others, a is the exact solution's, by its size."""
    rng = np.random.default_rng(4)
    for _ in range(20):
        M, J, f, w = system(rng)
        J = np.vstack([J, J[0] + J[1] / 2 + near * rng.normal(size=5)])
        right = exact(M, J, f, J @ w)
        assert abs(solved(M, J, f, J @ w) - right).max() < error * max(1.0, abs(right).max())


@pytest.mark.parametrize("open_by", [0.0, 1e-9, 1e-7])
def test_a_row_that_follows_from_others_but_for_an_open_gap_does_not_count(open_by):
    """Where a third row differs by how far the loop is open, a is that of the two others, but for some of it."""
    rng = np.random.default_rng(5)
    for _ in range(20):
        M, J, f, w = system(rng)
        g = J @ w
        row = 2 * J[0] - J[1] + open_by * rng.normal(size=5)
        found = solved(M, np.vstack([J, row]), f, np.append(g, 2 * g[0] - g[1] + open_by * rng.normal()))
        right = exact(M, J, f, g)
        assert abs(found - right).max() < (1e-12 + 100 * open_by) * max(1.0, abs(right).max())
