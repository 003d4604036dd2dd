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
    weights = _weights(M, J)
    factors = [[x + sum(w * row[i] * row[j] for w, row in zip(weights, J, strict=True)) for j, x in enumerate(line)]
               for i, line in enumerate(M)]  # fmt: skip
    if not _factored(factors):
        return [float("nan")] * (n + k)
    columns = [_substituted(factors, row) for row in J]
    a, lam = _bordered(factors, J, columns, weights, f, g)
    if k:  # once more for what rounding left
        f = [f[i] - sum(M[max(i, j)][min(i, j)] * a[j] for j in range(n)) for i in range(n)]
        f = [f[i] + sum(J[m][i] * lam[m] for m in range(k)) for i in range(n)]
        g = [g[m] - sum(J[m][i] * a[i] for i in range(n)) for m in range(k)]
        da, dlam = _bordered(factors, J, columns, weights, f, g)
        a, lam = [x + d for x, d in zip(a, da, strict=True)], [x + d for x, d in zip(lam, dlam, strict=True)]
    return [*a, *lam]


def _bordered(factors, J, columns, weights, f, g):
    """(a, lam) from the factors of M + J^T W J and the columns that they give for J^T."""
    n, k = len(f), len(g)
    pushed = [f[i] + sum(w * row[i] * y for w, row, y in zip(weights, J, g, strict=True)) for i in range(n)]
    free = _substituted(factors, pushed)
    S = [[sum(row[i] * column[i] for i in range(n)) for column in columns] for row in J]
    lam = _multipliers(S, [g[m] - sum(J[m][i] * free[i] for i in range(n)) for m in range(k)])
    return [free[i] + sum(columns[m][i] * lam[m] for m in range(k)) for i in range(n)], lam


def _weights(M, J):
    """W: M + J^T W J with f + J^T W g has the same solution, and is positive definite where M is so on J a = 0 only."""
    masses = [M[i][i] for i in range(len(M))]
    mean = sum(masses) / len(M) if J and sum(masses) > 0 else 1
    sizes = [sum(c * c / (m if m > 0 else mean) for c, m in zip(row, masses, strict=True)) for row in J]
    return [1 / size if size > 0 else 0 for size in sizes]


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
