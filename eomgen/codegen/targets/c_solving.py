"""The solve statement in C: the functions of codegen/solving.py, over arrays and along lists of what is not zero."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import accumulate, chain

from eomgen.codegen import solving
from eomgen.codegen.sparsity import PlaceLists, Zeros
from eomgen.symbolic.numeric import tolerances

HEAD_TEXT = """\
#include <string.h>

enum {{ N = {n}, K = {k} }}; /* accelerations, multipliers */

/* Shares below which a pivot is rounding, a diagonal entry is not relied on, a row depends on those before it. */
{limits}

/* What may not be zero in the factors of M, and in those of M + J^T W J: in column j of L the rows from
   partner[first[j]] up to partner[first[j + 1] - 1]; in row m of Y the places reach[start[m]], ...; at place j the
   rows row[from[j]], ... of Y. */
struct zeros {{ const int *partner, *first, *reach, *start, *row, *from; }};

static const struct zeros ways[2] = {{
{ways}
}};
"""

SOLVE_TEXT = """\
/* M = L D L^T in place, by rows of L^T; 0 where a pivot is no more than its least part of the diagonal */
static int factored(const struct zeros *z, double *M, double least)
{
    double whole[N];
    for (int j = 0; j < N; j++) whole[j] = M[j*N + j];
    for (int j = 0; j < N; j++) {
        double *row = M + j*N;
        const double d = row[j];
        if (!(d > least*whole[j])) return 0;
        for (int a = z->first[j]; a < z->first[j + 1]; a++) {
            const int i = z->partner[a];
            const double factor = row[i]/d;
            for (int b = a; b < z->first[j + 1]; b++) M[i*N + z->partner[b]] -= factor*row[z->partner[b]];
            row[i] = factor;
        }
    }
    return 1;
}

/* y becomes the solution of D L^T y = y */
static void backward(const struct zeros *z, const double *L, double *y)
{
    for (int j = N - 1; j >= 0; j--) {
        y[j] /= L[j*N + j];
        for (int a = z->first[j]; a < z->first[j + 1]; a++) y[j] -= L[j*N + z->partner[a]]*y[z->partner[a]];
    }
}

/* y becomes the solution of L y = y; this is column j's part of it */
static void forward(const struct zeros *z, const double *L, int j, double *y)
{
    for (int a = z->first[j]; a < z->first[j + 1]; a++) y[z->partner[a]] -= L[j*N + z->partner[a]]*y[j];
}
"""

DENSE_TEXT = """\
/* f becomes a of M a = f (upper triangle of M); all NAN where M is not positive definite */
static void solve(double *M, double *f)
{
    if (factored(&ways[0], M, ROUNDING)) {
        for (int j = 0; j < N; j++) forward(&ways[0], M, j, f);
        backward(&ways[0], M, f);
        return;
    }
    for (int i = 0; i < N; i++) f[i] = NAN;
}
"""

BORDER_TEXT = """\
struct factors { double L[N*N], mobility[N], Y[K*N], S[K*K], weight[K]; int order[K], rank; }; /* mobility: D^-1 */

/* each becomes 1/size; 0 of rows that are rounding */
static void inverted(double *size)
{
    double nothing = 0;
    for (int m = 0; m < K; m++) if (size[m] > nothing) nothing = size[m];
    nothing *= ROUNDING_SQUARED;
    for (int m = 0; m < K; m++) size[m] = size[m] > nothing ? 1/size[m] : 0;
}

/* with it M + J^T W J is positive definite where M is so on J a = 0 only */
static void weigh(const double *M, const double *J, double *weight)
{
    double mean = 0;
    for (int i = 0; i < N; i++) mean += M[i*N + i]/N;
    if (!(mean > 0)) mean = 1;
    for (int m = 0; m < K; m++) {
        weight[m] = 0;
        for (int i = 0; i < N; i++) {
            const double mass = M[i*N + i] > 0 ? M[i*N + i] : mean;
            weight[m] += J[m*N + i]*J[m*N + i]/mass;
        }
    }
    inverted(weight);
}

/* M, or where that is not positive definite M + J^T W J, factored: which of the two, NULL of neither */
static const struct zeros *chosen(const double *M, const double *J, struct factors *F)
{
    const struct zeros *z = &ways[1];
    memcpy(F->L, M, sizeof F->L);
    for (int m = 0; m < K; m++) F->weight[m] = 0;
    if (factored(&ways[0], F->L, DEGENERATE)) return &ways[0];
    memcpy(F->L, M, sizeof F->L);
    weigh(M, J, F->weight);
    for (int m = 0; m < K; m++)
        for (int a = z->start[m]; a < z->start[m + 1]; a++)
            for (int b = a; b < z->start[m + 1]; b++) {
                const int i = z->reach[a], j = z->reach[b];
                F->L[i*N + j] += F->weight[m]*J[m*N + i]*J[m*N + j];
            }
    return factored(z, F->L, ROUNDING) ? z : NULL;
}

static void exchange(double *a, double *b) { const double kept = *a; *a = *b; *b = kept; }

/* rows and columns c < p of S (lower triangle), and what belongs to them */
static void exchanged(struct factors *F, double *whole, int c, int p)
{
    double *S = F->S;
    const int kept = F->order[c];
    F->order[c] = F->order[p];
    F->order[p] = kept;
    exchange(whole + c, whole + p);
    exchange(S + c*K + c, S + p*K + p);
    for (int j = 0; j < c; j++) exchange(S + c*K + j, S + p*K + j);
    for (int i = c + 1; i < p; i++) exchange(S + i*K + c, S + p*K + i);
    for (int i = p + 1; i < K; i++) exchange(S + i*K + c, S + i*K + p);
}

/* S, of the multipliers, factored in place: largest pivot first, dependent rows passed over */
static void eliminated(struct factors *F)
{
    double *S = F->S, whole[K], column[K];
    for (int m = 0; m < K; m++) {
        F->order[m] = m;
        whole[m] = S[m*K + m];
    }
    inverted(whole);
    for (F->rank = 0; F->rank < K; F->rank++) {
        const int c = F->rank;
        int pivot = -1;
        double best = PIVOT;
        for (int m = c; m < K; m++)
            if (S[m*K + m]*whole[m] > best) { best = S[m*K + m]*whole[m]; pivot = m; }
        if (pivot < 0) break;
        if (pivot > c) exchanged(F, whole, c, pivot);
        for (int i = c + 1; i < K; i++) column[i] = S[i*K + c];
        for (int i = c + 1; i < K; i++) {
            double *row = S + i*K;
            const double factor = column[i]/S[c*K + c];
            if (factor == 0) continue;
            for (int j = c + 1; j <= i; j++) row[j] -= factor*column[j];
            row[c] = factor;
        }
    }
}

/* Y = L^-1 J^T and S = Y^T D^-1 Y = J M^-1 J^T */
static void bordered(const struct zeros *z, const double *J, struct factors *F)
{
    memcpy(F->Y, J, sizeof F->Y);
    memset(F->S, 0, sizeof F->S);
    for (int m = 0; m < K; m++)
        for (int a = z->start[m]; a < z->start[m + 1]; a++) forward(z, F->L, z->reach[a], F->Y + m*N);
    for (int j = 0; j < N; j++) {
        const int *row = z->row + z->from[j], count = z->from[j + 1] - z->from[j];
        double column[K];
        F->mobility[j] = 1/F->L[j*N + j];
        for (int a = 0; a < count; a++) {
            double *S = F->S + row[a]*K;
            column[a] = F->Y[row[a]*N + j];
            const double part = column[a]*F->mobility[j];
            for (int b = 0; b <= a; b++) S[row[b]] += part*column[b];
        }
    }
    eliminated(F);
}

/* r becomes lam of S lam = r, 0 of the rows that were passed over */
static void multipliers(const struct factors *F, double *r)
{
    double y[K];
    for (int i = 0; i < F->rank; i++) {
        y[i] = r[F->order[i]];
        for (int j = 0; j < i; j++) y[i] -= F->S[i*K + j]*y[j];
    }
    for (int m = 0; m < K; m++) r[m] = 0;
    for (int i = F->rank - 1; i >= 0; i--) {
        y[i] /= F->S[i*K + i];
        for (int j = i + 1; j < F->rank; j++) y[i] -= F->S[j*K + i]*y[j];
        r[F->order[i]] = y[i];
    }
}

/* f, g become a, lam by the factors */
static void corrected(const struct zeros *z, const struct factors *F, const double *J, double *f, double *g)
{
    for (int m = 0; m < K; m++)
        if (F->weight[m] != 0)
            for (int a = z->start[m]; a < z->start[m + 1]; a++)
                f[z->reach[a]] += F->weight[m]*J[m*N + z->reach[a]]*g[m];
    for (int j = 0; j < N; j++) forward(z, F->L, j, f);
    for (int m = 0; m < K; m++)
        for (int a = z->start[m]; a < z->start[m + 1]; a++) {
            const int j = z->reach[a];
            g[m] -= F->Y[m*N + j]*(f[j]*F->mobility[j]);
        }
    multipliers(F, g);
    for (int m = 0; m < K; m++)
        for (int a = z->start[m]; a < z->start[m + 1]; a++) f[z->reach[a]] += F->Y[m*N + z->reach[a]]*g[m];
    backward(z, F->L, f);
}

/* f, g become a, lam of M a - J^T lam = f, J a = g (upper triangle of M); all NAN where a is not determined */
static void solve(const double *M, const double *J, double *f, double *g)
{
    struct factors F;
    double left[N], open[K];
    memcpy(left, f, sizeof left);
    memcpy(open, g, sizeof open);
    const struct zeros *z = chosen(M, J, &F);
    if (z == NULL) {
        for (int i = 0; i < N; i++) f[i] = NAN;
        for (int m = 0; m < K; m++) g[m] = NAN;
        return;
    }
    bordered(z, J, &F);
    corrected(z, &F, J, f, g);
    for (int j = 0; j < N; j++) { /* once more for what rounding left */
        left[j] -= M[j*N + j]*f[j];
        for (int a = z->first[j]; a < z->first[j + 1]; a++) {
            const int i = z->partner[a];
            left[i] -= M[j*N + i]*f[j];
            left[j] -= M[j*N + i]*f[i];
        }
    }
    for (int m = 0; m < K; m++)
        for (int a = z->start[m]; a < z->start[m + 1]; a++) {
            const int j = z->reach[a];
            left[j] += J[m*N + j]*g[m];
            open[m] -= J[m*N + j]*f[j];
        }
    corrected(z, &F, J, left, open);
    for (int i = 0; i < N; i++) f[i] += left[i];
    for (int m = 0; m < K; m++) g[m] += open[m];
}
"""


def solving_text(ways: tuple[Zeros, Zeros]) -> str:
    """The functions that a solve with these zeros needs."""
    n, k = len(ways[0].partners), len(ways[0].reach)
    limits = "\n".join(f"#define {name} {getattr(tolerances, name)!r}" for name in solving.TOLERANCES)
    lists = ",\n".join(f"    {{ {', '.join(_lists(way))} }}" for way in ways)
    return f"{HEAD_TEXT.format(n=n, k=k, limits=limits, ways=lists)}\n{SOLVE_TEXT}\n{BORDER_TEXT if k else DENSE_TEXT}"


def _lists(way: Zeros) -> list[str]:
    """Each list of lists as one, and where each begins."""
    return [_numbers(part) for places in (way.partners, way.reach, way.rows) for part in _joined(places)]


def _joined(places: PlaceLists) -> tuple[Sequence[int], Sequence[int]]:
    return list(chain.from_iterable(places)), list(accumulate(map(len, places), initial=0))


def _numbers(values: Sequence[int]) -> str:
    """A constant array; C knows none without entries."""
    return f"(const int[]){{{', '.join(map(str, values or [0]))}}}"
