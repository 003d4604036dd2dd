"""The solve statement over any scalar: floats at run time, 50 digits for test vectors.

The numpy target writes these functions' own text into the files that it emits; targets/c_solving.py says the
same in C. Both walk along lists of what is not zero (codegen/sparsity.py).
"""

from __future__ import annotations

from eomgen.symbolic.numeric.tolerances import DEGENERATE, PIVOT, ROUNDING, ROUNDING_SQUARED

TOLERANCES = ("PIVOT", "ROUNDING", "DEGENERATE", "ROUNDING_SQUARED")  # that these functions name


def solve_bordered(M, J, f, g, zeros=None):
    """(a, lam) of  M a - J^T lam = f,  J a = g.

    M = L D L^T,  Y = L^-1 J^T,  (Y^T D^-1 Y) lam = g - Y^T D^-1 L^-1 f,  a = L^-T D^-1 (L^-1 f + Y lam)

    Args:
        M: lower triangle of the symmetric matrix, n rows of i + 1 entries; positive definite where J a = 0.
        J: k rows of n; of rows that depend on others lam is 0.
        f, g: n; k.
        zeros: what may not be zero in the factors of M, and in those of M + J^T W J: (partners, reach, rows) of
            codegen/sparsity.py; None: everything.
    Returns:
        n + k values, all nan where a is not determined.
    """
    n, k = len(f), len(g)
    found = _factors(M, J, zeros or 2 * (_everywhere(n, k),))
    if found is None:
        return [float("nan")] * (n + k)
    a, lam = _corrections(found, J, f, g)
    if k:  # once more for what rounding left
        da, dlam = _corrections(found, J, *_left(M, J, found[0], (f, g), (a, lam)))
        a, lam = [x + d for x, d in zip(a, da, strict=True)], [x + d for x, d in zip(lam, dlam, strict=True)]
    return [*a, *lam]


def _everywhere(n, k):
    """(partners, reach, rows) where nothing is known to be zero."""
    return [range(j + 1, n) for j in range(n)], [range(n)] * k, [range(k)] * n


def _factors(M, J, zeros):
    """(where, W, L and D, Y, S, its order) of M, or where that is no more positive of M + J^T W J; None of neither.

    With f + J^T W g in the place of f the solution is the same.
    """
    for where, least in zip(zeros, (DEGENERATE, ROUNDING), strict=True):
        partners, reach, rows = where
        weights = [0] * len(J) if least == DEGENERATE else _weights(M, J)
        L = _weighted(M, J, weights, reach)
        if _factored(L, partners, least):
            Y = [_forward(L, row, partners, places) for row, places in zip(J, reach, strict=True)]
            return (where, weights, L, Y, *_multiplier_factors(_flexibility(L, Y, rows)))
    return None


def _corrections(found, J, f, g):
    """(a, lam) from the factors."""
    (partners, reach, _), weights, L, Y, S, order = found
    pushed = list(f)
    for weight, row, places, gap in zip(weights, J, reach, g, strict=True):
        if weight:
            for j in places:
                pushed[j] += weight * row[j] * gap
    w = _forward(L, pushed, partners, range(len(f)))
    right = [gap - sum(y[j] * w[j] / L[j][j] for j in places) for y, places, gap in zip(Y, reach, g, strict=True)]
    lam = _multipliers(S, order, right)
    for y, places, push in zip(Y, reach, lam, strict=True):
        for j in places:
            w[j] += y[j] * push
    return _backward(L, w, partners), lam


def _left(M, J, where, right, solution):
    """What a solution leaves of the right side: f - M a + J^T lam, g - J a."""
    (partners, reach, _), (a, lam) = where, solution
    f, g = [x - M[j][j] * a[j] for j, x in enumerate(right[0])], list(right[1])
    for j, below in enumerate(partners):
        for i in below:
            f[i] -= M[i][j] * a[j]
            f[j] -= M[i][j] * a[i]
    for m, places in enumerate(reach):
        for j in places:
            f[j] += J[m][j] * lam[m]
            g[m] -= J[m][j] * a[j]
    return f, g


def _weights(M, J):
    """W: M + J^T W J is positive definite where M is so on J a = 0 only."""
    masses = [M[i][i] for i in range(len(M))]
    mean = sum(masses) / len(M) if J and sum(masses) > 0 else 1
    sizes = [sum(c * c / (m if m > 0 else mean) for c, m in zip(row, masses, strict=True)) for row in J]
    nothing = ROUNDING_SQUARED * max(sizes, default=0)
    return [1 / size if size > nothing else 0 for size in sizes]


def _weighted(M, J, weights, reach):
    """M + J^T W J, lower triangle."""
    rows = [list(line) for line in M]
    for weight, row, places in zip(weights, J, reach, strict=True):
        if weight:
            for i in places:
                for j in places:
                    if j <= i:
                        rows[i][j] += weight * row[i] * row[j]
    return rows


def _factored(M, partners, least):
    """M = L D L^T in place, D on the diagonal; False where a pivot is no more than its least part of the diagonal."""
    diagonal = [line[-1] for line in M]
    for j, below in enumerate(partners):
        if not M[j][j] > least * diagonal[j]:
            return False
        for i in reversed(below):
            factor = M[i][j] / M[j][j]
            for m in below:
                if m <= i:
                    M[i][m] -= factor * M[m][j]
            M[i][j] = factor
    return True


def _forward(L, right, partners, places):
    """y of  L y = right, which is not zero at these places."""
    y = list(right)
    for j in places:
        for i in partners[j]:
            y[i] -= L[i][j] * y[j]
    return y


def _backward(L, w, partners):
    """y of  D L^T y = w."""
    y = [value / L[j][j] for j, value in enumerate(w)]
    for j in reversed(range(len(y))):
        for i in partners[j]:
            y[j] -= L[i][j] * y[i]
    return y


def _flexibility(L, Y, rows):
    """S = Y^T D^-1 Y = J M^-1 J^T: the accelerations along the rows for unit pushes along them."""
    S = [[0] * len(Y) for _ in Y]
    for j, touching in enumerate(rows):
        for m in touching:
            part = Y[m][j] / L[j][j]
            for i in touching:
                S[m][i] += part * Y[i][j]
    return S


def _multiplier_factors(S):
    """(S factored in place, its rows in the order of elimination): largest pivot first, dependent rows passed over."""
    first, order = [S[m][m] for m in range(len(S))], []
    nothing = ROUNDING_SQUARED * max(first, default=0)
    left = [m for m in range(len(S)) if first[m] > nothing]
    while left:
        pivot = max(left, key=lambda m: S[m][m] / first[m])
        if not S[pivot][pivot] > PIVOT * first[pivot]:
            break
        left.remove(pivot)
        order.append(pivot)
        for i in left:
            factor = S[i][pivot] / S[pivot][pivot]
            if factor:
                for j in left:
                    S[i][j] -= factor * S[pivot][j]
    return S, order


def _multipliers(S, order, r):
    """lam of  S lam = r  from the factors, 0 of rows that were passed over."""
    lam = [0 * value for value in r]
    for place, pivot in enumerate(order):
        for i in order[place + 1 :]:
            r[i] -= S[i][pivot] / S[pivot][pivot] * r[pivot]
    for place in reversed(range(len(order))):
        pivot = order[place]
        lam[pivot] = (r[pivot] - sum(S[pivot][j] * lam[j] for j in order[place + 1 :])) / S[pivot][pivot]
    return lam
