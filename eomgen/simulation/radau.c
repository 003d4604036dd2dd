/* Radau IIA of order 5 for stiff motions: one real and one complex system a step, the latter as a real one of twice
   the size; Newton's steps from the last polynomial, error estimate of order 3, as scipy's.

   Source: Hairer & Wanner, Solving Ordinary Differential Equations II, 2nd ed., IV.8. */

static const double RADAU_C[3] = {0.15505102572168219, 0.64494897427831781, 1};
static const double RADAU_E[3] = {-10.048809399827414, 1.3821427331607484, -1.0/3};
static const double RADAU_T[3][3] = {{0.09443876248897524, -0.14125529502095421, 0.03002919410514742},
                                     {0.25021312296533332, 0.20412935229379994, -0.38294211275726192},
                                     {1, 1, 0}};
static const double RADAU_TI[3][3] = {{4.17871859155190428, 0.32768282076106237, 0.52337644549944951},
                                      {-4.17871859155190428, -0.32768282076106237, 0.47662355450055044},
                                      {0.50287263494578682, -2.57192694985560522, 0.59603920482822492}};
static const double RADAU_P[3][3] = {{10.048809399827414, -25.629591447076637, 15.580782047249223},
                                     {-1.3821427331607484, 10.296258113743304, -8.914115380582556},
                                     {1.0/3, -8.0/3, 10.0/3}};
static const double MU_REAL = 3.6378342527444957, MU_RE = 2.6810828736277523, MU_IM = -3.050430199247411;

/* d(x')/dx by differences */
static void slope_by_differences(struct march *m)
{
    size_t n = m->n;
    double *x = m->room, *dx = x + n;
    memcpy(x, m->x, n*sizeof *x);
    for (size_t j = 0; j < n; j++) {
        double step = SLOPE_STEP*(1 + fabs(m->x[j]));
        for (int side = 1; side >= -1; side -= 2) {
            x[j] = m->x[j] + side*step;
            CALL(&m->rate, m->t, x, dx);
            for (size_t i = 0; i < n; i++)
                m->jac[i*n + j] = side > 0 ? dx[i] : (m->jac[i*n + j] - dx[i])/(2*step);
        }
        x[j] = m->x[j];
    }
    m->evaluations += 2*n;
}

/* the same from the derivatives of q' and of M a - J^T lam - forcing, J a + gamma at fixed a, lam; M and J follow them */
static void slope(struct march *m)
{
    size_t n = m->n, u = m->slope_speeds, k = m->slope_rows, z = m->slope_states, q = n - u - z, s = u + k;
    double *values = m->work, *right = values + q*n, *M = right + s*n, *J = M + u*u;
    double *further = J + k*u, *by_a = further + z*n, *A = by_a + z*u;
    if (!m->has_slope) {
        slope_by_differences(m);
        return;
    }
    CALL(&m->slope, m->t, m->x, values);
    for (size_t i = 0; i < s; i++)
        for (size_t j = 0; j < s; j++)
            A[i*s + j] = i < u && j < u ? M[i*u + j] : i < u ? -J[(j - u)*u + i] : j < u ? J[(i - u)*u + j] : 0;
    for (size_t i = 0; i < s*n; i++)
        right[i] = -right[i];
    memcpy(m->jac, values, q*n*sizeof *values);
    if (!factored(s, A, m->pivots, REGULAR_PIVOT)) {
        slope_by_differences(m);
        return;
    }
    back(s, A, m->pivots, n, right);
    memcpy(m->jac + q*n, right, u*n*sizeof *right);
    for (size_t i = 0; i < z; i++)
        for (size_t j = 0; j < n; j++) {
            double sum = further[i*n + j];
            for (size_t l = 0; l < u; l++)
                sum += by_a[i*u + l]*right[l*n + j];
            m->jac[(q + u + i)*n + j] = sum;
        }
}

/* about the largest |eigenvalue|: |J^16|^(1/16) */
static double spectral_radius(struct march *m)
{
    size_t n = m->n;
    double *power = m->both, *next = power + n*n, logarithm = 0;
    memcpy(power, m->jac, n*n*sizeof *power);
    for (int square = 0; square < 5; square++) {
        double largest = 0;
        for (size_t i = 0; i < n; i++) {
            double sum = 0;
            for (size_t j = 0; j < n; j++)
                sum += fabs(power[i*n + j]);
            largest = sum > largest ? sum : largest;
        }
        if (!(largest > 0))
            return 0;
        logarithm += log(largest)/(1 << square);
        if (square == 4)
            break;
        for (size_t i = 0; i < n*n; i++)
            power[i] /= largest;
        for (size_t i = 0; i < n; i++)
            for (size_t j = 0; j < n; j++) {
                next[i*n + j] = 0;
                for (size_t l = 0; l < n; l++)
                    next[i*n + j] += power[i*n + l]*power[l*n + j];
            }
        memcpy(power, next, n*n*sizeof *power);
    }
    return exp(logarithm);
}

static void renew(struct march *m)
{
    slope(m);
    m->fastest = spectral_radius(m);
    m->is_fresh = 1, m->has_lu = 0;
}

/* both systems of a step h; whether they have a solution */
static int prepared(struct march *m, double h)
{
    size_t n = m->n, d = 2*n;
    for (size_t i = 0; i < n; i++)
        for (size_t j = 0; j < n; j++) {
            double entry = -m->jac[i*n + j];
            m->real[i*n + j] = entry + (i == j ? MU_REAL/h : 0);
            m->both[i*d + j] = m->both[(n + i)*d + n + j] = entry + (i == j ? MU_RE/h : 0);
            m->both[i*d + n + j] = i == j ? -MU_IM/h : 0;
            m->both[(n + i)*d + j] = i == j ? MU_IM/h : 0;
        }
    return m->has_lu = factored(n, m->real, m->pivots, 0) && factored(d, m->both, m->pivots + n, 0);
}

static double norm(size_t n, const double *x, const double *scale)
{
    double sum = 0;
    EACH sum += (x[k]/scale[k])*(x[k]/scale[k]);
    return sqrt(sum/(double)n);
}

/* Newton's steps; how many were taken, 0 where they do not converge; Z is found, its first guess is there before */
static int collocated(struct march *m, double h, double *Z, const double *scale, double tolerance, double *rate)
{
    size_t n = m->n;
    double *W = m->K, *F = W + 3*n, *real = F + 3*n, *both = real + n, *x = both + 2*n, before = 0;
    for (size_t i = 0; i < 3; i++)
        EACH W[i*n + k] = RADAU_TI[i][0]*Z[k] + RADAU_TI[i][1]*Z[n + k] + RADAU_TI[i][2]*Z[2*n + k];
    *rate = -1;
    for (int step = 0; step < RADAU_STEPS; step++) {
        for (size_t i = 0; i < 3; i++) {
            EACH x[k] = m->x[k] + Z[i*n + k];
            CALL(&m->rate, m->t + h*RADAU_C[i], x, F + i*n);
        }
        m->evaluations += 3;
        EACH {
            real[k] = RADAU_TI[0][0]*F[k] + RADAU_TI[0][1]*F[n + k] + RADAU_TI[0][2]*F[2*n + k] - MU_REAL/h*W[k];
            both[k] = RADAU_TI[1][0]*F[k] + RADAU_TI[1][1]*F[n + k] + RADAU_TI[1][2]*F[2*n + k]
                      - MU_RE/h*W[n + k] + MU_IM/h*W[2*n + k];
            both[n + k] = RADAU_TI[2][0]*F[k] + RADAU_TI[2][1]*F[n + k] + RADAU_TI[2][2]*F[2*n + k]
                          - MU_IM/h*W[n + k] - MU_RE/h*W[2*n + k];
        }
        back(n, m->real, m->pivots, 1, real);
        back(2*n, m->both, m->pivots + n, 1, both);
        double sum = 0;
        EACH sum += pow(real[k]/scale[k], 2) + pow(both[k]/scale[k], 2) + pow(both[n + k]/scale[k], 2);
        double size = sqrt(sum/(double)(3*n));
        if (!isfinite(size))
            return 0;
        if (step)
            *rate = size/before;
        if (step && (*rate >= 1 || pow(*rate, RADAU_STEPS - step)/(1 - *rate)*size > tolerance))
            return 0;
        EACH W[k] += real[k], W[n + k] += both[k], W[2*n + k] += both[n + k];
        for (size_t i = 0; i < 3; i++)
            EACH Z[i*n + k] = RADAU_T[i][0]*W[k] + RADAU_T[i][1]*W[n + k] + RADAU_T[i][2]*W[2*n + k];
        if (size == 0 || (step && *rate/(1 - *rate)*size < tolerance))
            return step + 1;
        before = size;
    }
    return 0;
}

static double growth_of(const struct march *m, double h, double error)
{
    double factor = error > 0 ? pow(error, -0.25) : LARGEST_GROWTH;
    if (m->error_old > 0 && error > 0)
        factor *= fmin(1, h/m->h_older*pow(m->error_old/error, 0.25));
    return factor;
}

/* one implicit step, made smaller until it converges and its error is below the tolerance */
static int stepped_implicitly(struct march *m)
{
    size_t n = m->n;
    double least = 10*fabs(nextafter(m->t, INFINITY) - m->t), h = m->h, stop = next_stop(m), rate;
    double *Z = m->Z, *error = Z + 3*n, *scale = error + n, *x = scale + n, *turned = x + n;
    double tolerance = fmax(10*DBL_EPSILON/m->rtol, fmin(0.03, sqrt(m->rtol)));
    int rejected = 0, taken;
    if (h < least)
        h = least, m->error_old = 0;
    if (!m->has_slope_values) {
        renew(m);
        m->has_slope_values = 1;
    }
    for (;;) {
        if (!(h >= least))
            return 0;
        double t = m->t + h;
        if (t > stop)
            t = stop, m->has_lu = 0;
        h = t - m->t;
        for (size_t i = 0; i < 3; i++)
            EACH {
                double part = m->dense_of ? (m->t + h*RADAU_C[i] - m->t_old)/(m->t - m->t_old) : 0;
                Z[i*n + k] = m->dense_of ? m->x_old[k] - m->x[k]
                                               + part*(m->F[k] + part*(m->F[n + k] + part*m->F[2*n + k])) : 0;
            }
        EACH scale[k] = m->atol + fabs(m->x[k])*m->rtol;
        for (taken = 0; !taken;) {
            if (!m->has_lu && !prepared(m, h))
                break;
            taken = collocated(m, h, Z, scale, tolerance, &rate);
            if (taken || m->is_fresh)
                break;
            renew(m);
        }
        if (!taken) {
            h *= 0.5, m->has_lu = 0;
            continue;
        }
        EACH {
            x[k] = m->x[k] + Z[2*n + k];
            scale[k] = m->atol + fmax(fabs(m->x[k]), fabs(x[k]))*m->rtol;
            turned[k] = (RADAU_E[0]*Z[k] + RADAU_E[1]*Z[n + k] + RADAU_E[2]*Z[2*n + k])/h;
            error[k] = m->f[k] + turned[k];
        }
        back(n, m->real, m->pivots, 1, error);
        double size = norm(n, error, scale);
        if (rejected && size > 1) {
            EACH m->room[k] = m->x[k] + error[k];
            CALL(&m->rate, m->t, m->room, error);
            m->evaluations++;
            EACH error[k] += turned[k];
            back(n, m->real, m->pivots, 1, error);
            size = norm(n, error, scale);
        }
        double safety = SAFETY*(2*RADAU_STEPS + 1)/(2*RADAU_STEPS + taken), factor = safety*growth_of(m, h, size);
        if (!(size <= 1)) {
            h *= factor > SMALLEST_GROWTH ? factor : SMALLEST_GROWTH;
            m->has_lu = 0, rejected = 1;
            continue;
        }
        int again = taken > 2 && rate > 1e-3;
        factor = fmin(LARGEST_GROWTH, factor);
        if (!again && factor < 1.2)
            factor = 1;
        else
            m->has_lu = 0;
        m->t_old = m->t, m->h_old = h, m->t = t, m->h_older = h, m->error_old = size, m->h = h*factor;
        memcpy(m->x_old, m->x, n*sizeof *x);
        memcpy(m->x, x, n*sizeof *x);
        for (size_t i = 0; i < 3; i++)
            EACH m->F[i*n + k] = Z[k]*RADAU_P[0][i] + Z[n + k]*RADAU_P[1][i] + Z[2*n + k]*RADAU_P[2][i];
        m->dense_of = m->is_dense = 1;
        CALL(&m->rate, m->t, m->x, m->f);
        m->evaluations++, m->implicit_steps++;
        m->is_fresh = 0;
        if (again)
            renew(m);
        return 1;
    }
}
