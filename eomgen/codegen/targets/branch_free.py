"""The Solve of a program where loops with pivots cannot run: matrices, for languages that trace their functions.

A = M + J^T J with rows and columns of one size, S = J A^-1 J^T + ease, then what is left is solved for once more, and
again: where rows follow from others their multipliers share the force, and a is right all the same. Each round takes
(s/(s + ease))^POWER of what is left along an eigenvector of J A^-1 J^T, s its eigenvalue: nearly nothing of rows that
follow from others but for rounding or an open gap, nearly all of a row that is barely one of its own.
"""

from eomgen.symbolic.numeric.tolerances import DEPENDENT_EASE, TINIEST

ROUNDS = 6  # after each (POWER*ease/s) of lam is left
POWER = 3

FACTORS = f'''
def solve_factors(M, J, L, weight, mobility, Y, S, order):
    """What any f, g are solved by, into the list L (upper triangle of M)."""
    k, n = len(weight), len(mobility)
    rows = [[M[min(i, j)*n + max(i, j)] for j in range(n)] for i in range(n)]
    mean = sum((rows[i][i] for i in range(n)), 0.0)/n
    d = [1/sqrt(_where_positive(rows[i][i], rows[i][i], mean)) for i in range(n)]
    J = [[J[m*n + i]*d[i] for i in range(n)] for m in range(k)]
    sizes = [1/sqrt(sum((x*x for x in row), {TINIEST!r})) for row in J]
    J = _matrix([[x*size for x in row] for row, size in zip(J, sizes)], k, n)
    M = _matrix([[rows[i][j]*d[i]*d[j] for j in range(n)] for i in range(n)], n, n)
    A = _factors(M + J.T @ J)
    L[:] = M, J, A, _factors(J @ _solved(A, J.T) + {DEPENDENT_EASE!r}*_one(k)), d, sizes


'''
BY = f'''
def solve_by(M, J, L, weight, mobility, Y, S, order, f, g):
    """f, g become a, lam of M a - J^T lam = f, J a = g; of dependent rows lam is the least."""
    n, k, (M, J, A, S, d, sizes) = len(f), len(g), L
    right, gap = _matrix([[x*y] for x, y in zip(f, d)], n, 1), _matrix([[x*y] for x, y in zip(g, sizes)], k, 1)
    a, lam = 0*right, 0*gap
    for _ in range({ROUNDS}):
        left, open_ = right - M @ a + J.T @ lam, gap - J @ a
        more = _solved(A, left + J.T @ open_)
        pull = open_ - J @ more
        for _ in range({POWER - 1}):
            pull = pull - {DEPENDENT_EASE!r}*_solved(S, pull)
        pull = _solved(S, pull)
        a, lam = a + more + _solved(A, J.T @ pull), lam + pull + open_
    f[:] = [a[i, 0]*d[i] for i in range(n)]
    g[:] = [lam[m, 0]*sizes[m] for m in range(k)]


'''
WHOLE = '''
def solve(M, J, f, g):
    """f, g become a, lam."""
    kept = [], g, f, [], [], []
    solve_factors(M, J, *kept)
    solve_by(M, J, *kept, f, g)


'''
PLAIN = '''
def solve_plain(M, f):
    """f becomes a of M a = f (upper triangle of M), M its factors."""
    n = len(f)
    M[:] = [_factors(_matrix([[M[min(i, j)*n + max(i, j)] for j in range(n)] for i in range(n)], n, n))]
    solve_plain_by(M, f)


'''
PLAIN_BY = '''
def solve_plain_by(M, f):
    """The same of another f, by the factors."""
    a = _solved(M[0], _matrix([[x] for x in f], len(f), 1))
    f[:] = [a[i, 0] for i in range(len(f))]


'''
SOLVERS = {
    **{"solve": FACTORS + BY + WHOLE, "solve_factors": FACTORS, "solve_by": BY},
    **{"solve_plain": PLAIN + PLAIN_BY, "solve_plain_by": ""},
}
"""What stands for each of the kernels that solve."""
