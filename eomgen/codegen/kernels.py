"""The algorithms with loops that emitted code calls, written once: every language prints them, Python runs them.

A function here is made of the statements of emitted programs: a name for a value that stays, arrays that change (a
number that changes is an array of one), `for` over range, `if`, calls, `return`. The kinds of its arguments are named;
sizes and lists are constants of each program; arithmetic is + - * /, so that it runs over any scalar.
"""

from __future__ import annotations

from collections.abc import Sequence

from eomgen.symbolic.numeric import tolerances

Int = int
Real = float
Ints = Sequence[int]
Reals = Sequence[float]  # that are read
Work = list[float]  # that are changed
Places = list[int]

nan = float("nan")

# Of one solve: N accelerations, K multipliers; what may not be zero in the factors of M (w = 0) and of M + J^T W J
# (w = 1): in column j of L the rows PARTNER[e], e from FIRST[w*(N + 1) + j] to the next one's; in row m of L^-1 J^T the
# places REACH[e], e from START[w*(K + 1) + m]; at place j its rows ROW[e], e from FROM[w*(N + 1) + j]; in column m of
# the factor of Y^T D^-1 Y the rows LATER[e], e from NEXT[w*(K + 1) + m].
N = K = 0
PARTNER: Ints = ()
FIRST: Ints = ()
REACH: Ints = ()
START: Ints = ()
ROW: Ints = ()
FROM: Ints = ()
LATER: Ints = ()
NEXT: Ints = ()
ALIKE: Ints = ()  # of each row of J those that share what they hold have one number


def zeros(n: int) -> Work:
    """An array of n numbers."""
    return [0.0] * n


def room(n: int) -> Work:
    """An array of n numbers that are written before they are read."""
    return [0.0] * n


def places(n: int) -> Places:
    """An array of n indices."""
    return [0] * n


def solve(M: Reals, J: Reals, f: Work, g: Work) -> None:
    """Solve M a - J^T lam = f, J a = g in place: a stands in f then, lam in g; nan where there is no solution.

    Of the symmetric M the upper triangle is read.
    """
    L = room(N * N)
    weight = room(K)
    mobility = room(N)
    Y = room(K * N)
    S = room(K * K)
    order = places(K + 3)
    solve_factors(M, J, L, weight, mobility, Y, S, order)
    solve_by(M, J, L, weight, mobility, Y, S, order, f, g)


def solve_factors(M: Reals, J: Reals, L: Work, weight: Work, mobility: Work, Y: Work, S: Work, order: Places) -> None:
    """Factors by which the system is solved for any f, g.

    M = L D L^T,  Y = L^-1 J^T,  S = Y^T D^-1 Y

    Where M is no more positive, M + J^T W J stands in its place. In order: rows of J as they are eliminated; at K how
    many of them are sure, then the rank, then which M it is (0, 1; -1 of neither).
    """
    for m in range(K):
        weight[m] = 0.0
    w = chosen(M, J, L, weight)
    order[K + 2] = w
    if w < 0:
        return
    flexibility(w, L, J, mobility, Y, S)
    rank = eliminated(w, S, order)
    order[K + 1] = rank


def solve_by(
    M: Reals,
    J: Reals,
    L: Reals,
    weight: Reals,
    mobility: Reals,
    Y: Reals,
    S: Reals,
    order: Places,
    f: Work,
    g: Work,
) -> None:
    """f, g become a, lam by the factors.

    (Y^T D^-1 Y) lam = g - Y^T D^-1 L^-1 f,  a = L^-T D^-1 (L^-1 f + Y lam)

    Rows that depend on others have lam 0. Where M is no more positive, f + J^T W g stands in the place of f. All is
    done once more for the residual of rounding.
    """
    w = order[K + 2]
    if w < 0:
        spoil(f, g)
        return
    a = zeros(N)
    lam = zeros(K)
    for again in range(2):
        left = room(N)
        gap = room(K)
        for i in range(N):
            left[i] = f[i]
        for m in range(K):
            gap[m] = g[m]
        if again > 0:
            subtract(M, J, a, lam, left, gap)
        push(J, weight, gap, left)
        for j in range(N):
            forward(w, L, j, left)
        for m in range(K):
            for e in range(START[w * (K + 1) + m], START[w * (K + 1) + m + 1]):
                j = REACH[e]
                gap[m] -= Y[m * N + j] * (left[j] * mobility[j])
        multipliers(w, S, order, order[K + 1], gap)
        for m in range(K):
            pull = gap[m]
            for e in range(START[w * (K + 1) + m], START[w * (K + 1) + m + 1]):
                j = REACH[e]
                left[j] += Y[m * N + j] * pull
        backward(w, L, left)
        for i in range(N):
            a[i] += left[i]
        for m in range(K):
            lam[m] += gap[m]
    for i in range(N):
        f[i] = a[i]
    for m in range(K):
        g[m] = lam[m]


def solve_plain(M: Work, f: Work) -> None:
    """f becomes a of M a = f (upper triangle), M its factors; all nan where it is not positive definite."""
    done = factored(0, tolerances.ROUNDING, M)
    if done == 0:
        for i in range(N):
            M[i * N + i] = nan
    solve_plain_by(M, f)


def solve_plain_by(M: Reals, f: Work) -> None:
    """The same of another f, by what M became."""
    for j in range(N):
        forward(0, M, j, f)
    backward(0, M, f)


def factored(w: Int, least: Real, M: Work) -> Int:
    """M = L D L^T in place, by rows of L^T; 0 where a pivot is no more than its least part of the diagonal."""
    whole = room(N)
    for j in range(N):
        whole[j] = M[j * N + j]
    for j in range(N):
        row = j * N
        d = M[row + j]
        if not d > least * whole[j]:
            return 0
        last = FIRST[w * (N + 1) + j + 1]
        for e in range(FIRST[w * (N + 1) + j], last):
            i = PARTNER[e]
            factor = M[row + i] / d
            for h in range(e, last):
                k = PARTNER[h]
                M[i * N + k] -= factor * M[row + k]
            M[row + i] = factor
    return 1


def forward(w: Int, L: Reals, j: Int, y: Work) -> None:
    """Column j's part of y = L^-1 y."""
    row = j * N
    push = y[j]
    for e in range(FIRST[w * (N + 1) + j], FIRST[w * (N + 1) + j + 1]):
        i = PARTNER[e]
        y[i] -= L[row + i] * push


def backward(w: Int, L: Reals, y: Work) -> None:
    """y = (D L^T)^-1 y."""
    for j in reversed(range(0, N)):
        row = j * N
        y[j] = y[j] / L[row + j]
        for e in range(FIRST[w * (N + 1) + j], FIRST[w * (N + 1) + j + 1]):
            i = PARTNER[e]
            y[j] -= L[row + i] * y[i]


def chosen(M: Reals, J: Reals, L: Work, weight: Work) -> Int:
    """L and D of M (0), or where M is not relied on without the rows, of M + J^T W J (1); -1 of neither."""
    laid(M, L)
    done = factored(0, tolerances.DEGENERATE, L)
    if done == 1:
        return 0
    for j in range(N):
        for e in range(FIRST[N + 1 + j], FIRST[N + 1 + j + 1]):
            L[j * N + PARTNER[e]] = 0.0
    laid(M, L)
    weigh(M, J, weight)
    for m in range(K):
        last = START[m + 1]
        for e in range(START[m], last):
            for h in range(e, last):
                L[REACH[e] * N + REACH[h]] += weight[m] * J[m * N + REACH[e]] * J[m * N + REACH[h]]
    with_constraints = factored(1, tolerances.ROUNDING, L)
    if with_constraints == 1:
        return 1
    return -1


def laid(M: Reals, L: Work) -> None:
    """Copies to L the entries of M that may not be zero in its factors: nothing else of M is read."""
    for j in range(N):
        row = j * N
        L[row + j] = M[row + j]
        for e in range(FIRST[j], FIRST[j + 1]):
            L[row + PARTNER[e]] = M[row + PARTNER[e]]


def weigh(M: Reals, J: Reals, weight: Work) -> None:
    """W: with it M + J^T W J is positive definite where M is so on J a = 0 only."""
    mean = zeros(1)
    count = zeros(1)
    for i in range(N):
        mean[0] += M[i * N + i]
        count[0] += 1.0
    mean[0] = mean[0] / count[0]
    if not mean[0] > 0:
        mean[0] = 1.0
    for m in range(K):
        for e in range(START[m], START[m + 1]):
            i = REACH[e]
            mass = M[i * N + i]
            if mass > 0:
                weight[m] += J[m * N + i] * J[m * N + i] / mass
            else:
                weight[m] += J[m * N + i] * J[m * N + i] / mean[0]
    invert(weight)


def invert(size: Work) -> None:
    """Replaces each by 1/size; by 0 if it is rounding: the sizes are squares of lengths."""
    nothing = zeros(1)
    for m in range(K):
        if size[m] > nothing[0]:
            nothing[0] = size[m]
    for m in range(K):
        if size[m] > tolerances.ROUNDING_SQUARED * nothing[0]:
            size[m] = 1.0 / size[m]
        else:
            size[m] = 0.0


def flexibility(w: Int, L: Reals, J: Reals, mobility: Work, Y: Work, S: Work) -> None:
    """D^-1, Y = L^-1 J^T and S = Y^T D^-1 Y = J M^-1 J^T (lower triangle)."""
    column = room(K)
    for m in range(K):
        row = m * N
        S[m * K + m] = 0.0
        for e in range(NEXT[w * (K + 1) + m], NEXT[w * (K + 1) + m + 1]):
            S[LATER[e] * K + m] = 0.0
        if w == 1:
            for e in range(START[K + 1 + m], START[K + 1 + m + 1]):
                Y[row + REACH[e]] = 0.0
        for e in range(START[m], START[m + 1]):
            Y[row + REACH[e]] = J[row + REACH[e]]
        for e in range(START[w * (K + 1) + m], START[w * (K + 1) + m + 1]):
            j = REACH[e]
            push = Y[row + j]
            for h in range(FIRST[w * (N + 1) + j], FIRST[w * (N + 1) + j + 1]):
                i = PARTNER[h]
                Y[row + i] -= L[j * N + i] * push
    for j in range(N):
        mobility[j] = 1.0 / L[j * N + j]
        first = FROM[w * (N + 1) + j]
        last = FROM[w * (N + 1) + j + 1]
        for e in range(first, last):
            column[e - first] = Y[ROW[e] * N + j]
        for e in range(first, last):
            row = ROW[e] * K
            part = column[e - first] * mobility[j]
            for h in range(first, e + 1):
                S[row + ROW[h]] += part * column[h - first]


def eliminated(w: Int, S: Work, order: Places) -> Int:
    """S factored in place along what is not zero, dependent rows passed over; the rank; order[K] rows of it are sure.

    A row depends on those before it where its pivot, the squared sine of its angle to them, is no more than PIVOT: of
    rows that share what they hold against the longest of them, for one may vanish where others hold, but for rounding.
    What is no more than SURE_PIVOT waits for all others, and is then taken largest first.
    """
    whole = room(K)
    column = room(K)
    late = places(K)
    rest = places(K)
    count = places(3)
    best = zeros(1)
    for m in range(K):
        whole[m] = S[m * K + m]
        for h in range(K):
            if ALIKE[h] == ALIKE[m]:
                size = S[h * K + h]
                if size > whole[m]:
                    whole[m] = size
    invert(whole)
    for c in range(K):
        share = S[c * K + c] * whole[c]
        if share > tolerances.SURE_PIVOT:
            first = NEXT[w * (K + 1) + c]
            last = NEXT[w * (K + 1) + c + 1]
            for e in range(count[1]):
                rest[e] = late[e]
            for e in range(first, last):
                rest[count[1] + e - first] = LATER[e]
            struck(S, c, rest, count[1] + last - first, column)
            order[count[0]] = c
            count[0] += 1
        else:
            if share > tolerances.PIVOT:
                late[count[1]] = c
                count[1] += 1
                cleared(w, c, S, column)
    order[K] = count[0]
    for k in range(count[0], K):
        count[2] = -1
        best[0] = tolerances.PIVOT
        for e in range(count[1]):
            m = late[e]
            if S[m * K + m] * whole[m] > best[0]:
                best[0] = S[m * K + m] * whole[m]
                count[2] = e
        if count[2] < 0:
            return k
        c = late[count[2]]
        count[1] -= 1
        for e in range(count[2], count[1]):
            late[e] = late[e + 1]
        struck(S, c, late, count[1], column)
        order[k] = c
    return K


def cleared(w: Int, c: Int, S: Work, column: Work) -> None:
    """Sets to 0 the entries of column c of S below the diagonal that are not in its pattern.

    A row that waits for its pivot meets all rows that come after it, so that others may have been filled.
    """
    first = NEXT[w * (K + 1) + c]
    last = NEXT[w * (K + 1) + c + 1]
    for e in range(first, last):
        column[e - first] = S[LATER[e] * K + c]
    for i in range(c + 1, K):
        S[i * K + c] = 0.0
    for e in range(first, last):
        S[LATER[e] * K + c] = column[e - first]


def struck(S: Work, c: Int, rest: Places, n: Int, column: Work) -> None:
    """Row c eliminated from the n rows of `rest`, which ascend: their column c of the factor, and the rest of S."""
    d = S[c * K + c]
    for e in range(n):
        i = rest[e]
        if i < c:
            column[e] = S[c * K + i]
        else:
            column[e] = S[i * K + c]
    for e in range(n):
        row = rest[e] * K
        factor = column[e] / d
        for h in range(e + 1):
            S[row + rest[h]] -= factor * column[h]
        S[row + c] = factor


def multipliers(w: Int, S: Reals, order: Places, rank: Int, r: Work) -> None:
    """Solve S lam = r in place by the factors of S; lam is 0 in redundant rows, which the factors leave out."""
    y = room(K)
    sure = order[K]
    for m in range(K):
        y[m] = r[m]
        r[m] = 0.0
    for k in range(rank):
        c = order[k]
        if k < sure:
            for e in range(NEXT[w * (K + 1) + c], NEXT[w * (K + 1) + c + 1]):
                y[LATER[e]] -= S[LATER[e] * K + c] * y[c]
            for h in range(sure, rank):
                i = order[h]
                if i < c:
                    y[i] -= S[i * K + c] * y[c]
        else:
            for h in range(k + 1, rank):
                i = order[h]
                y[i] -= S[i * K + c] * y[c]
    for k in reversed(range(0, rank)):
        c = order[k]
        y[c] = y[c] / S[c * K + c]
        if k < sure:
            for e in range(NEXT[w * (K + 1) + c], NEXT[w * (K + 1) + c + 1]):
                y[c] -= S[LATER[e] * K + c] * r[LATER[e]]
            for h in range(sure, rank):
                i = order[h]
                if i < c:
                    y[c] -= S[i * K + c] * r[i]
        else:
            for h in range(k + 1, rank):
                i = order[h]
                y[c] -= S[i * K + c] * r[i]
        r[c] = y[c]


def push(J: Reals, weight: Reals, gap: Reals, left: Work) -> None:
    """left += J^T W gap."""
    for m in range(K):
        if weight[m] != 0:
            pull = weight[m] * gap[m]
            for e in range(START[m], START[m + 1]):
                left[REACH[e]] += J[m * N + REACH[e]] * pull


def subtract(M: Reals, J: Reals, a: Reals, lam: Reals, left: Work, gap: Work) -> None:
    """left -= M a - J^T lam,  gap -= J a."""
    for j in range(N):
        row = j * N
        left[j] -= M[row + j] * a[j]
        for e in range(FIRST[j], FIRST[j + 1]):
            i = PARTNER[e]
            left[i] -= M[row + i] * a[j]
            left[j] -= M[row + i] * a[i]
    for m in range(K):
        row = m * N
        for e in range(START[m], START[m + 1]):
            i = REACH[e]
            left[i] += J[row + i] * lam[m]
            gap[m] -= J[row + i] * a[i]


def spoil(f: Work, g: Work) -> None:
    """No value anywhere."""
    for i in range(N):
        f[i] = nan
    for m in range(K):
        g[m] = nan


def through_samples(
    t: Real, n: Int, closed: Int, steps: Ints, depth: Int, bounds: Reals, degree: Int, v: Reals
) -> Real:
    """A function of time by pieces, at t on the one that has k bounds at or before t.

    ((v[0][k] s + v[1][k]) s + ...) + v[degree][k],  s = t - v[degree + 1][k]

    Args:
        n: of the bounds; one piece more.
        closed: 1 where the last bound belongs to the piece before it.
        steps: powers of two from above n/2 down to 1, depth of them: k is found bit by bit.
        v: the coefficients, of the highest power first, and the origins; n + 1 of each.
    """
    k = places(1)
    for i in range(depth):
        if k[0] + steps[i] <= n:  # noqa: SIM102 (a language may look at both at once)
            if bounds[k[0] + steps[i] - 1] <= t:
                k[0] += steps[i]
    if closed == 1:  # noqa: SIM102
        if t == bounds[n - 1]:
            k[0] = n - 1
    s = t - v[(degree + 1) * (n + 1) + k[0]]
    value = zeros(1)
    for i in range(degree + 1):
        value[0] = value[0] * s + v[i * (n + 1) + k[0]]
    return value[0]
