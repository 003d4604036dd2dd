"""The solve statement in C: the functions of codegen/solving.py, over arrays."""

SOLVE_TEXT = """\
/* M = L D L^T in place (lower triangle, n x n); 0 where M is not positive definite */
static int factored(int n, double *M, const double *diagonal)
{
    for (int j = 0; j < n; j++) {
        const double d = M[j*n + j];
        if (!(d > 1e-14*diagonal[j])) return 0;
        for (int i = j + 1; i < n; i++) {
            const double factor = M[i*n + j]/d;
            for (int m = j + 1; m <= i; m++) M[i*n + m] -= factor*M[m*n + j];
        }
        for (int i = j + 1; i < n; i++) M[i*n + j] /= d;
    }
    return 1;
}

/* y becomes the solution of L D L^T y = y */
static void substituted(int n, const double *M, double *y)
{
    for (int i = 0; i < n; i++)
        for (int j = 0; j < i; j++) y[i] -= M[i*n + j]*y[j];
    for (int i = 0; i < n; i++) y[i] /= M[i*n + i];
    for (int i = n - 1; i >= 0; i--)
        for (int j = i + 1; j < n; j++) y[i] -= M[j*n + i]*y[j];
}
"""

BORDER_TEXT = """\
/* M + J^T W J and f + J^T W g: the same solution, positive definite where M is so on J a = 0 only */
static void augmented(int n, int k, double *M, const double *J, double *f, const double *g)
{
    double mean = 0, size;
    for (int i = 0; i < n; i++) mean += M[i*n + i]/n;
    if (!(mean > 0)) mean = 1;
    double mass[SIZE];
    for (int i = 0; i < n; i++) mass[i] = M[i*n + i] > 0 ? M[i*n + i] : mean;
    for (int m = 0; m < k; m++) {
        const double *row = J + m*n;
        size = 0;
        for (int i = 0; i < n; i++) size += row[i]*row[i]/mass[i];
        const double weight = size > 0 ? 1/size : 0;
        for (int i = 0; i < n; i++) {
            for (int j = 0; j <= i; j++) M[i*n + j] += weight*row[i]*row[j];
            f[i] += weight*row[i]*g[m];
        }
    }
}

/* r becomes lam of S lam = r, S (k x k) positive semidefinite: largest pivot first, dependent rows passed over */
static void multipliers(int k, double *S, double *r)
{
    double first[SIZE];
    int used[SIZE], left[SIZE], count = 0;
    for (int m = 0; m < k; m++) { first[m] = S[m*k + m]; left[m] = 1; }
    for (; count < k; count++) {
        int pivot = -1;
        double best = 1e-11;
        for (int m = 0; m < k; m++)
            if (left[m] && first[m] > 0 && S[m*k + m]/first[m] > best) { best = S[m*k + m]/first[m]; pivot = m; }
        if (pivot < 0) break;
        left[pivot] = 0;
        used[count] = pivot;
        for (int i = 0; i < k; i++) {
            if (!left[i]) continue;
            const double factor = S[i*k + pivot]/S[pivot*k + pivot];
            r[i] -= factor*r[pivot];
            for (int j = 0; j < k; j++) if (left[j]) S[i*k + j] -= factor*S[pivot*k + j];
        }
    }
    for (int m = 0; m < k; m++) if (left[m]) r[m] = 0;
    for (int m = count - 1; m >= 0; m--) {
        const int i = used[m];
        for (int j = m + 1; j < count; j++) r[i] -= S[i*k + used[j]]*r[used[j]];
        r[i] /= S[i*k + i];
    }
}

/* f, g become a, lam of M a - J^T lam = f, J a = g; all NAN where a is not determined */
static void solve(int n, int k, double *M, const double *J, double *f, double *g)
{
    double columns[SIZE*SIZE], S[SIZE*SIZE], diagonal[SIZE];
    augmented(n, k, M, J, f, g);
    for (int i = 0; i < n; i++) diagonal[i] = M[i*n + i];
    if (!factored(n, M, diagonal)) {
        for (int i = 0; i < n; i++) f[i] = NAN;
        for (int m = 0; m < k; m++) g[m] = NAN;
        return;
    }
    substituted(n, M, f);
    for (int m = 0; m < k; m++) {
        for (int i = 0; i < n; i++) {
            columns[m*n + i] = J[m*n + i];
            g[m] -= J[m*n + i]*f[i];
        }
        substituted(n, M, columns + m*n);
    }
    for (int m = 0; m < k; m++)
        for (int j = 0; j < k; j++) {
            S[m*k + j] = 0;
            for (int i = 0; i < n; i++) S[m*k + j] += J[m*n + i]*columns[j*n + i];
        }
    multipliers(k, S, g);
    for (int i = 0; i < n; i++)
        for (int m = 0; m < k; m++) f[i] += columns[m*n + i]*g[m];
}
"""

DENSE_TEXT = """\
/* f becomes a of M a = f; all NAN where M is not positive definite */
static void solve(int n, double *M, double *f)
{
    double diagonal[SIZE];
    for (int i = 0; i < n; i++) diagonal[i] = M[i*n + i];
    if (factored(n, M, diagonal)) { substituted(n, M, f); return; }
    for (int i = 0; i < n; i++) f[i] = NAN;
}
"""


def solving_text(n: int, k: int) -> str:
    """The functions that a solve of n accelerations and k multipliers needs."""
    return f"#define SIZE {max(n, k, 1)}\n\n{SOLVE_TEXT}\n{BORDER_TEXT if k else DENSE_TEXT}"
