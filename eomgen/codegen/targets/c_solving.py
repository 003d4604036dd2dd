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
/* W: M + J^T W J and f + J^T W g have the same solution, positive definite where M is so on J a = 0 only */
static void weigh(int n, int k, const double *M, const double *J, double *weight)
{
    double mean = 0;
    for (int i = 0; i < n; i++) mean += M[i*n + i]/n;
    if (!(mean > 0)) mean = 1;
    for (int m = 0; m < k; m++) {
        double size = 0;
        for (int i = 0; i < n; i++) {
            const double mass = M[i*n + i] > 0 ? M[i*n + i] : mean;
            size += J[m*n + i]*J[m*n + i]/mass;
        }
        weight[m] = size > 0 ? 1/size : 0;
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

/* f, g become a, lam, from the factors of M + J^T W J and the columns that they give for J^T */
static void bordered(int n, int k, const double *factors, const double *J, const double *columns,
                     const double *weight, double *f, double *g)
{
    double S[SIZE*SIZE];
    for (int m = 0; m < k; m++)
        for (int i = 0; i < n; i++) f[i] += weight[m]*J[m*n + i]*g[m];
    substituted(n, factors, f);
    for (int m = 0; m < k; m++) {
        for (int i = 0; i < n; i++) g[m] -= J[m*n + i]*f[i];
        for (int j = 0; j < k; j++) {
            S[m*k + j] = 0;
            for (int i = 0; i < n; i++) S[m*k + j] += J[m*n + i]*columns[j*n + i];
        }
    }
    multipliers(k, S, g);
    for (int i = 0; i < n; i++)
        for (int m = 0; m < k; m++) f[i] += columns[m*n + i]*g[m];
}

/* f, g become a, lam of M a - J^T lam = f, J a = g; all NAN where a is not determined */
static void solve(int n, int k, double *M, const double *J, double *f, double *g)
{
    double factors[SIZE*SIZE], columns[SIZE*SIZE], diagonal[SIZE], weight[SIZE], left[SIZE], open[SIZE];
    weigh(n, k, M, J, weight);
    for (int i = 0; i < n; i++) {
        for (int j = 0; j <= i; j++) {
            factors[i*n + j] = M[i*n + j];
            for (int m = 0; m < k; m++) factors[i*n + j] += weight[m]*J[m*n + i]*J[m*n + j];
        }
        diagonal[i] = factors[i*n + i];
        left[i] = f[i];
    }
    for (int m = 0; m < k; m++) open[m] = g[m];
    if (!factored(n, factors, diagonal)) {
        for (int i = 0; i < n; i++) f[i] = NAN;
        for (int m = 0; m < k; m++) g[m] = NAN;
        return;
    }
    for (int m = 0; m < k; m++) {
        for (int i = 0; i < n; i++) columns[m*n + i] = J[m*n + i];
        substituted(n, factors, columns + m*n);
    }
    bordered(n, k, factors, J, columns, weight, f, g);
    for (int i = 0; i < n; i++) { /* once more for what rounding left */
        for (int j = 0; j < n; j++) left[i] -= M[i > j ? i*n + j : j*n + i]*f[j];
        for (int m = 0; m < k; m++) {
            left[i] += J[m*n + i]*g[m];
            open[m] -= J[m*n + i]*f[i];
        }
    }
    bordered(n, k, factors, J, columns, weight, left, open);
    for (int i = 0; i < n; i++) f[i] += left[i];
    for (int m = 0; m < k; m++) g[m] += open[m];
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
