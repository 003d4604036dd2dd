"""The solve statement over any scalar: floats at run time, 50 digits for test vectors.

The numpy target writes these functions' own text into the files that it emits; targets/c_solving.py says the
same in C.
"""

from __future__ import annotations

DEPENDENT = 1e-11  # of a row's pivot: the squared sine of its angle to the rows before it
SINGULAR = 1e-14  # of a diagonal entry


def solve_bordered(M, J, f, g):
    """(a, lam) of  M a - J^T lam = f,  J a = g.

    a = M^-1 (f + J^T lam),  J M^-1 J^T lam = g - J M^-1 f

    Args:
        M: lower triangle of the symmetric matrix, n rows of i + 1 entries; positive definite where J a = 0.
        J: k rows of n; of rows that depend on others lam is 0.
        f, g: n; k.
    Returns:
        n + k values, all nan where a is not determined.
    """
    n, k = len(f), len(g)
    M, f = _augmented(M, J, f, g)
    if not _factored(M):
        return [float("nan")] * (n + k)
    free, *columns = [_substituted(M, right) for right in [f, *J]]
    S = [[sum(row[i] * column[i] for i in range(n)) for column in columns] for row in J]
    lam = _multipliers(S, [g[m] - sum(J[m][i] * free[i] for i in range(n)) for m in range(k)])
    a = [free[i] + sum(columns[m][i] * lam[m] for m in range(k)) for i in range(n)]
    return [*a, *lam]


def _augmented(M, J, f, g):
    """M + J^T W J and f + J^T W g: the same solution, and positive definite where M is so on J a = 0 only."""
    M, f = [list(row) for row in M], list(f)
    masses = [M[i][i] for i in range(len(f))]
    mean = sum(masses) / len(f) if J and sum(masses) > 0 else 1
    for row, value in zip(J, g, strict=True):
        size = sum(c * c / (m if m > 0 else mean) for c, m in zip(row, masses, strict=True))
        weight = 1 / size if size > 0 else 0
        for i in range(len(f)):
            for j in range(i + 1):
                M[i][j] += weight * row[i] * row[j]
            f[i] += weight * row[i] * value
    return M, f


def _factored(M):
    """M = L D L^T in place, D on the diagonal; False where M is not positive definite."""
    n = len(M)
    diagonal = [M[j][j] for j in range(n)]
    for j in range(n):
        if not M[j][j] > SINGULAR * diagonal[j]:
            return False
        for i in range(j + 1, n):
            factor = M[i][j] / M[j][j]
            for m in range(j + 1, i + 1):
                M[i][m] -= factor * M[m][j]
        for i in range(j + 1, n):
            M[i][j] /= M[j][j]
    return True


def _substituted(M, right):
    """y of  L D L^T y = right."""
    n, y = len(M), list(right)
    for i in range(n):
        for j in range(i):
            y[i] -= M[i][j] * y[j]
    for i in range(n):
        y[i] /= M[i][i]
    for i in reversed(range(n)):
        for j in range(i + 1, n):
            y[i] -= M[j][i] * y[j]
    return y


def _multipliers(S, r):
    """lam of  S lam = r, S positive semidefinite: the largest pivot first, dependent rows passed over."""
    first, left, used = [S[m][m] for m in range(len(r))], list(range(len(r))), []
    while left:
        pivot = max(left, key=lambda m: S[m][m] / first[m] if first[m] > 0 else 0)
        if not S[pivot][pivot] > DEPENDENT * first[pivot]:
            break
        left.remove(pivot)
        used.append(pivot)
        for i in left:
            factor = S[i][pivot] / S[pivot][pivot]
            r[i] -= factor * r[pivot]
            for j in left:
                S[i][j] -= factor * S[pivot][j]
    lam = [0 * value for value in r]
    for m in reversed(used):
        after = used[used.index(m) + 1 :]
        lam[m] = (r[m] - sum(S[m][j] * lam[j] for j in after)) / S[m][m]
    return lam
