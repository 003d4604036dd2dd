/* x' = f(t, x) for many steps in one call, as long as all is calm: what keeps the ties, what ends a run.

   It stands behind codegen/marching.py, which fills the struct, and goes on here where a call has ended. Python looks at
   a step itself where an event may lie in it, where it may come near a singular position, or where a tie does not close;
   then nothing of what is watched has been changed by that step. */

#include <float.h>
#include <math.h>
#include <stddef.h>
#include <string.h>

struct rows { /* M, J, N at a state, one after the other: k rows over n speeds, N of `coordinates` rows */
    struct rate f;
    size_t k, n;
};

struct march {
    size_t n;
    struct rate rate;
    double t, t_old, h, h_old, end, rtol, atol;
    double *x, *x_old, *f, *K, *F, *room; /* n, n, n, 16 n, 7 n, 3 n */
    const double *stops;                  /* instants across which no step goes */
    size_t n_stops;
    size_t evaluations, is_dense;
    const double *instants; /* where states are wanted */
    size_t n_instants, next;
    double *rows;                       /* n_instants x n */
    double *track_t, *track_x;          /* the ends of steps */
    size_t tracked;
    const int *spheres; /* the places of quaternions, 4 each */
    size_t n_spheres;
    size_t holds; /* whether states are put back onto ties */
    struct rate gaps;
    size_t n_gaps, placed, coordinates, speeds;
    struct rows places, rates;
    double *work;
    size_t n_events, is_blind; /* blind: Python looks at every step */
    struct rate events;
    const double *floors;
    const int *either;
    double *signs, *largest, *looks; /* LOOKS x n_events */
    int *armed;
    size_t is_near_watched;
    struct rate determinants, ties;
    size_t n_determinants, n_rows, n_columns, rank;
    double near, before, slopes[4];
    size_t n_slopes, is_armed;
    double *lengths, *sizes; /* of the rows; of the determinants and of what vanishes with the rank */
    size_t is_implicit, is_auto, dense_of; /* dense_of: whether F is that of an implicit step */
    size_t stiff_seen, easy_seen, most_seen, implicit_steps;
    struct rate slope;
    size_t has_slope, slope_speeds, slope_rows, slope_states, has_slope_values, is_fresh, has_lu;
    double fastest, h_older, error_old;
    double *jac, *real, *both, *Z; /* n n, n n, 4 n n, 7 n */
    int *pivots;                   /* 3 n, or as many as speeds and rows */
    struct rate energies;          /* T, V */
    size_t keeps_energy;
    double energy, most_kinetic;
    size_t order; /* of series; 0 where steps are others */
    void (*series)(double t, const double *x, const double *p, const double *c, double *X, double *W);
    void (*along)(const double *X, double h, double *x, double *slope);
    double *X, *X_old, *W; /* order + 1 rows of n, from t and from t_old on; work */
    size_t has_series;     /* whether X is that of x */
    size_t pieces;         /* of the last step, each with a polynomial of its own */
    double *piece, *along_pieces; /* DOP853_PIECES x (x and F, 8 n); K and two states of one on its way, 18 n */
};

static int stepped_implicitly(struct march *m);

enum { BY_STAGES, BY_COLLOCATION, BY_SERIES }; /* what dense_of tells */

enum { PARTS = 8, LOOKS = PARTS + 3 }; /* of a step */
enum { GOES_ON, LOOK, REACHED, TOO_SMALL, STIFF };

/* -- dense algebra ---------------------------------------------------------------------------------------------- */

/* A = L U in its place, with pivots; whether every pivot is more than that part of the largest entry */
static int factored(size_t n, double *A, int *pivots, double smallest)
{
    double largest = 0;
    for (size_t i = 0; i < n*n; i++)
        largest = fabs(A[i]) > largest ? fabs(A[i]) : largest;
    for (size_t j = 0; j < n; j++) {
        size_t best = j;
        for (size_t i = j + 1; i < n; i++)
            if (fabs(A[i*n + j]) > fabs(A[best*n + j]))
                best = i;
        if (!(fabs(A[best*n + j]) > smallest*largest))
            return 0;
        pivots[j] = (int)best;
        for (size_t k = 0; best != j && k < n; k++) {
            double kept = A[j*n + k];
            A[j*n + k] = A[best*n + k], A[best*n + k] = kept;
        }
        for (size_t i = j + 1; i < n; i++) {
            double factor = A[i*n + j] /= A[j*n + j];
            for (size_t k = j + 1; factor != 0 && k < n; k++)
                A[i*n + k] -= factor*A[j*n + k];
        }
    }
    return 1;
}

/* A X = B, m columns, X in B */
static void back(size_t n, const double *A, const int *pivots, size_t m, double *B)
{
    for (size_t j = 0; j < n; j++)
        for (size_t k = 0; k < m; k++) {
            double kept = B[j*m + k];
            B[j*m + k] = B[(size_t)pivots[j]*m + k], B[(size_t)pivots[j]*m + k] = kept;
        }
    for (size_t j = 0; j < n; j++)
        for (size_t i = j + 1; i < n; i++)
            for (size_t k = 0; A[i*n + j] != 0 && k < m; k++)
                B[i*m + k] -= A[i*n + j]*B[j*m + k];
    for (size_t i = n; i-- > 0;)
        for (size_t k = 0; k < m; k++) {
            for (size_t j = i + 1; j < n; j++)
                B[i*m + k] -= A[i*n + j]*B[j*m + k];
            B[i*m + k] /= A[i*n + i];
        }
}

static int solved(size_t n, double *A, int *pivots, size_t m, double *B)
{
    int regular = factored(n, A, pivots, 0);
    if (regular)
        back(n, A, pivots, m, B);
    return regular;
}

static double length(size_t n, const double *row)
{
    double sum = 0;
    for (size_t k = 0; k < n; k++)
        sum += row[k]*row[k];
    return sqrt(sum);
}

/* the singular value number `rank` of k rows, the largest being 1, by turning pairs of rows until they are square */
static double singular_value(size_t k, size_t n, double *J, size_t rank)
{
    for (int sweep = 0; sweep < MOST_SWEEPS; sweep++) {
        int turned = 0;
        for (size_t i = 0; i + 1 < k; i++)
            for (size_t j = i + 1; j < k; j++) {
                double a = 0, b = 0, d = 0;
                for (size_t m = 0; m < n; m++) {
                    a += J[i*n + m]*J[i*n + m];
                    b += J[j*n + m]*J[j*n + m];
                    d += J[i*n + m]*J[j*n + m];
                }
                if (!(fabs(d) > SQUARE*sqrt(a*b)))
                    continue;
                double z = (b - a)/(2*d), s = (z < 0 ? -1 : 1)/(fabs(z) + sqrt(1 + z*z)), c = 1/sqrt(1 + s*s);
                s *= c;
                turned = 1;
                for (size_t m = 0; m < n; m++) {
                    double one = J[i*n + m], other = J[j*n + m];
                    J[i*n + m] = c*one - s*other;
                    J[j*n + m] = s*one + c*other;
                }
            }
        if (!turned)
            break;
    }
    double found = INFINITY;
    for (size_t taken = 0; taken < rank; taken++) {
        size_t best = 0;
        double largest = -1;
        for (size_t i = 0; i < k; i++) {
            double size = length(n, J + i*n);
            if (size > largest)
                largest = size, best = i;
        }
        found = largest;
        for (size_t m = 0; m < n; m++)
            J[best*n + m] = 0;
    }
    return found;
}

/* -- quaternions and ties --------------------------------------------------------------------------------------- */

static void on_spheres(const struct march *m, double *x)
{
    for (size_t i = 0; i < m->n_spheres; i++) {
        const int *at = m->spheres + 4*i;
        double norm = sqrt(x[at[0]]*x[at[0]] + x[at[1]]*x[at[1]] + x[at[2]]*x[at[2]] + x[at[3]]*x[at[3]]);
        for (int j = 0; j < 4 && norm > 0; j++)
            x[at[j]] /= norm;
    }
}

/* the largest of the gaps from `first` to `last`; NaN where one is */
static double largest_gap(const struct march *m, double t, const double *x, size_t first, size_t last, double *gaps)
{
    double largest = 0;
    CALL(&m->gaps, t, x, gaps);
    for (size_t i = first; i < last; i++)
        if (!(fabs(gaps[i]) <= largest))
            largest = fabs(gaps[i]);
    return largest;
}

static double rounding_of(const struct march *m, const double *x)
{
    double largest = 1;
    for (size_t k = 0; k < m->n; k++)
        largest = fabs(x[k]) > largest ? fabs(x[k]) : largest;
    return GAP_ROUNDING*largest;
}

/* change = N ds with the least ds^T M ds for which J ds = right, as `least_change` of constraint_drift.py */
static int least_change(const struct march *m, const struct rows *rows, const double *values, const double *right,
                        double *change, double *work)
{
    size_t n = rows->n, k = rows->k, moves = rows == &m->places ? m->coordinates : m->speeds;
    const double *M = values, *given = M + n*n, *N = given + k*n;
    double *J = work, *A = J + k*n, *moved = A + n*n, *S = moved + n*k, *d = S + k*k, *lam = d + k, *ds = lam + k;
    double longest = 0, mean = 0;
    for (size_t i = 0; i < k; i++) {
        d[i] = length(n, given + i*n);
        longest = d[i] > longest ? d[i] : longest;
    }
    for (size_t i = 0; i < n; i++)
        mean += M[i*n + i]/(double)n;
    memcpy(A, M, n*n*sizeof *A);
    for (size_t i = 0; i < k; i++) {
        int counts = d[i] > ROW_ROUNDING*longest;
        for (size_t j = 0; j < n; j++) {
            J[i*n + j] = counts ? given[i*n + j] : 0;
            moved[j*k + i] = J[i*n + j];
        }
        for (size_t j = 0; j < n && counts; j++)
            for (size_t l = 0; l < n; l++)
                A[j*n + l] += mean*(J[i*n + j]/d[i])*(J[i*n + l]/d[i]);
    }
    if (!solved(n, A, m->pivots, k, moved))
        for (size_t i = 0; i < k; i++)
            for (size_t j = 0; j < n; j++)
                moved[j*k + i] = J[i*n + j];
    for (size_t i = 0; i < k; i++)
        for (size_t j = 0; j < k; j++) {
            S[i*k + j] = 0;
            for (size_t l = 0; l < n; l++)
                S[i*k + j] += J[i*n + l]*moved[l*k + j];
        }
    for (size_t i = 0; i < k; i++)
        d[i] = 1/sqrt(S[i*k + i] > 0 ? S[i*k + i] : 1);
    for (size_t i = 0; i < k; i++) {
        lam[i] = d[i]*right[i];
        for (size_t j = 0; j < k; j++)
            S[i*k + j] = d[i]*S[i*k + j]*d[j] + (i == j ? DAMPING : 0);
    }
    if (!solved(k, S, m->pivots, 1, lam))
        return 0;
    for (size_t j = 0; j < n; j++) {
        ds[j] = 0;
        for (size_t i = 0; i < k; i++)
            ds[j] += moved[j*k + i]*d[i]*lam[i];
    }
    for (size_t i = 0; i < moves; i++) {
        change[i] = 0;
        for (size_t j = 0; j < n; j++)
            change[i] += N[i*n + j]*ds[j];
    }
    return 1;
}

/* Newton's method: x with its places or its speeds on the ties, as `closed` of constraint_drift.py */
static void put_back(const struct march *m, const struct rows *rows, double t, double *x, double enough)
{
    size_t places = rows == &m->places, q = m->coordinates, n = m->n;
    size_t first = places ? 0 : m->placed, last = places ? m->placed : m->n_gaps, moves = places ? q : m->speeds;
    double *gaps = m->work, *best = gaps + m->n_gaps, *before = best + n, *right = before + n, *state = right + rows->k,
           *change = state + q + (rows->n > m->speeds ? rows->n : m->speeds), *values = change + q + m->speeds,
           *work = values + rows->n*rows->n + rows->k*rows->n + moves*rows->n;
    double begun = largest_gap(m, t, x, first, last, gaps), left = INFINITY;
    memcpy(best, x, n*sizeof *x);
    memcpy(before, x, n*sizeof *x);
    for (int step = 0; step < PUT_BACK_STEPS; step++) {
        double size = largest_gap(m, t, x, first, last, gaps);
        if (size <= enough)
            break;
        if (!(size < left)) {
            memcpy(x, before, n*sizeof *x);
            break;
        }
        memcpy(state, x, (q + m->speeds)*sizeof *x);
        if (places)
            for (size_t k = 0; k < rows->n; k++)
                state[q + k] = 0;
        CALL(&rows->f, t, state, values);
        for (size_t i = 0; i < rows->k; i++)
            right[i] = i < last - first ? -gaps[first + i] : 0;
        memcpy(before, x, n*sizeof *x);
        left = size;
        if (!least_change(m, rows, values, right, change, work))
            break;
        for (size_t k = 0; k < moves; k++)
            x[(places ? 0 : q) + k] += change[k];
        on_spheres(m, x);
    }
    if (!(largest_gap(m, t, x, first, last, gaps) < begun))
        memcpy(x, best, n*sizeof *x);
}

enum { STAYS, MOVED, STAYS_OPEN };

static int on_ties(const struct march *m, double t, double *x, double allowed)
{
    if (m->holds) {
        double rounding = rounding_of(m, x), most = allowed > rounding ? allowed : rounding;
        if (!(largest_gap(m, t, x, 0, m->n_gaps, m->work) <= most)) {
            double enough = PUT_BACK_FAR*m->atol;
            on_spheres(m, x);
            rounding = rounding_of(m, x);
            enough = enough > rounding ? enough : rounding;
            if (m->places.k)
                put_back(m, &m->places, t, x, enough);
            if (m->rates.k)
                put_back(m, &m->rates, t, x, enough);
            rounding = rounding_of(m, x);
            most = LOST*m->atol > rounding ? LOST*m->atol : rounding;
            return largest_gap(m, t, x, 0, m->n_gaps, m->work) <= most ? MOVED : STAYS_OPEN;
        }
    }
    on_spheres(m, x);
    return m->n_spheres ? MOVED : STAYS;
}

/* a state on the ties, spheres and the level of the energy, as `DriftCorrection.at` */
static int held(struct march *m, double t, double *x, double allowed)
{
    int found = on_ties(m, t, x, allowed);
    double parts[2]; /* T, V */
    if (!m->keeps_energy)
        return found;
    CALL(&m->energies, t, x, parts);
    m->most_kinetic = parts[0] > m->most_kinetic ? parts[0] : m->most_kinetic;
    if (!(parts[0] > SLOW*m->most_kinetic && m->energy > parts[1]))
        return found;
    for (size_t k = 0; k < m->speeds; k++)
        x[m->coordinates + k] *= sqrt((m->energy - parts[1])/parts[0]);
    return found == STAYS_OPEN ? STAYS_OPEN : MOVED;
}

/* -- one step ----------------------------------------------------------------------------------------------------- */

/* the rate at the start and a first step, as scipy's */
void march_begin(struct march *m)
{
    size_t n = m->n;
    double d0 = 0, d1 = 0, d2 = 0, span = m->end - m->t, h, *x = m->room, *f = x + n;
    CALL(&m->rate, m->t, m->x, m->f);
    EACH {
        double scale = m->atol + fabs(m->x[k])*m->rtol;
        d0 += pow(m->x[k]/scale, 2)/(double)n;
        d1 += pow(m->f[k]/scale, 2)/(double)n;
    }
    d0 = sqrt(d0), d1 = sqrt(d1);
    h = d0 < 1e-5 || d1 < 1e-5 ? 1e-6 : 0.01*d0/d1;
    h = h < span ? h : span;
    EACH x[k] = m->x[k] + h*m->f[k];
    CALL(&m->rate, m->t + h, x, f);
    EACH d2 += pow((f[k] - m->f[k])/(m->atol + fabs(m->x[k])*m->rtol), 2)/(double)n;
    d2 = sqrt(d2)/h;
    double order = m->is_implicit ? 4 : 8;
    double next = d1 <= 1e-15 && d2 <= 1e-15 ? fmax(1e-6, h*1e-3) : pow(0.01/fmax(d1, d2), 1/order);
    m->h = fmin(fmin(100*h, next), span);
    m->evaluations += 2;
}

/* the instant that the next step does not pass */
static double next_stop(struct march *m)
{
    while (m->n_stops && m->stops[0] <= m->t + SAME_INSTANT*fmax(1, fabs(m->t)))
        m->stops++, m->n_stops--;
    return m->n_stops && m->stops[0] < m->end ? m->stops[0] : m->end;
}

/* h |lambda| of the eigenvalue that the last step has met: the change of the rate over that of the state, where two
   stages look at one instant. Source: Hairer & Wanner, IV.2. */
static double met_rate(const struct march *m)
{
    static const double APART[12] = {DOP853_APART};
    size_t n = m->n;
    double rates = 0, states = 0;
    for (size_t k = 0; k < n; k++) {
        double change = m->K[12*n + k] - m->K[11*n + k], moved = 0;
        for (size_t j = 0; j < 12; j++)
            moved += APART[j]*m->K[j*n + k];
        rates += change*change, states += moved*moved;
    }
    return states > 0 ? sqrt(rates/states) : 0;
}

/* whether the way of stepping is to change */
static int is_to_change(struct march *m)
{
    int held_short = m->is_implicit ? !(m->h_old*m->fastest < EASY) : met_rate(m) > HELD_SHORT;
    if (held_short != (int)m->is_implicit)
        m->stiff_seen++, m->easy_seen = 0;
    else if (++m->easy_seen == FORGOTTEN)
        m->stiff_seen = m->easy_seen = 0;
    if (m->stiff_seen < m->most_seen)
        return 0;
    m->stiff_seen = m->easy_seen = 0;
    return 1;
}

/* one step, made smaller until its error is below the tolerance */
static int stepped(struct march *m)
{
    size_t n = m->n;
    double least = 10*fabs(nextafter(m->t, INFINITY) - m->t), size = fmax(m->h, least), growth = LARGEST_GROWTH;
    double stop = next_stop(m), *x = m->room, errors[2];
    memcpy(m->K, m->f, n*sizeof *x);
    while (size >= least) {
        double t = m->t + size < stop ? m->t + size : stop, h = t - m->t;
        dop853_step(&m->rate, n, m->t, h, m->x, x, m->K);
        m->evaluations += 12;
        dop853_errors(n, m->x, x, m->K, m->rtol, m->atol, errors);
        double whole = errors[0] + 0.01*errors[1], error = whole == 0 ? 0 : h*errors[0]/sqrt(whole*(double)n);
        double factor = error == 0 ? LARGEST_GROWTH : SAFETY*pow(error, -1.0/8);
        if (error < 1) {
            m->h = h*fmin(growth, factor);
            m->h_old = h, m->t_old = m->t, m->t = t, m->is_dense = m->dense_of = 0;
            memcpy(m->x_old, m->x, n*sizeof *x);
            memcpy(m->x, x, n*sizeof *x);
            memcpy(m->f, m->K + 12*n, n*sizeof *x);
            return 1;
        }
        size = h*(factor > SMALLEST_GROWTH ? factor : SMALLEST_GROWTH), growth = 1;
    }
    return 0;
}

/* how long a step is of whose series the last two terms are not above the tolerance */
static double length_by_series(const struct march *m)
{
    size_t n = m->n;
    double h = INFINITY;
    for (size_t j = m->order - 1; j <= m->order; j++) {
        double largest = 0;
        EACH {
            double size = fabs(m->X[j*n + k])/(m->atol + m->rtol*fabs(m->x[k]));
            largest = size > largest || size != size ? size : largest;
        }
        double allowed = -log(largest)/(double)j;
        h = allowed >= h ? h : allowed;
    }
    return exp(h);
}

static void expand(struct march *m)
{
    m->series(m->t, m->x, m->rate.p, m->rate.c, m->X, m->W);
    m->evaluations += m->order, m->has_series = 1;
}

/* One step along the series; half of it, and half again, where the rate at its end, with which the next series begins,
   is not that of the equations. Source: A. Jorba and M. Zou, A software package for the numerical integration of ODEs by
   means of high-order Taylor methods, Experimental Mathematics 14 (2005), 99-117. */
static int stepped_by_series(struct march *m)
{
    size_t n = m->n;
    double stop = next_stop(m), least = 10*fabs(nextafter(m->t, INFINITY) - m->t), *slope = m->room, *X;
    if (!m->has_series)
        expand(m);
    double h = length_by_series(m);
    m->t_old = m->t, m->is_dense = 1, m->dense_of = BY_SERIES;
    memcpy(m->x_old, m->x, n*sizeof *m->x);
    X = m->X, m->X = m->X_old, m->X_old = X;
    for (; h >= least; h /= 2) {
        double off = 0;
        m->t = m->t_old + h < stop ? m->t_old + h : stop;
        h = m->t - m->t_old;
        m->along(m->X_old, h, m->x, slope);
        expand(m);
        EACH {
            double size = fabs(h*(slope[k] - m->X[n + k]))/(m->atol + m->rtol*fmax(fabs(m->x_old[k]), fabs(m->x[k])));
            off = size > off || size != size ? size : off;
        }
        if (off <= (double)m->order) {
            m->h = m->h_old = h;
            memcpy(m->f, m->X + n, n*sizeof *m->f);
            return 1;
        }
    }
    m->t = m->t_old, m->has_series = 0;
    memcpy(m->x, m->x_old, n*sizeof *m->x);
    return 0;
}

/* the last step once more, in pieces, which change nothing of it: x and F of each */
static void in_pieces(struct march *m)
{
    size_t n = m->n;
    double h = m->h_old/(double)m->pieces, *K = m->along_pieces, *x_new = K + 16*n, *room = x_new + n;
    memcpy(K, m->K, n*sizeof *K);
    memcpy(m->piece, m->x_old, n*sizeof *K);
    for (size_t j = 0; j < m->pieces; j++) {
        double *x = m->piece + 8*j*n;
        dop853_piece(&m->rate, n, m->t_old + (double)j*h, h, x, x_new, room, K, x + n);
        if (j + 1 < m->pieces)
            memcpy(x + 8*n, x_new, n*sizeof *K);
    }
    m->evaluations += 15*m->pieces;
}

/* F, of the last step */
void march_dense(struct march *m)
{
    if (!m->is_dense) {
        size_t n = m->n;
        dop853_dense(&m->rate, n, m->t_old, m->h_old, m->x_old, m->x, m->room, m->K, m->F);
        m->evaluations += 4, m->is_dense = 1;
        m->pieces = dop853_pieces(dop853_missed(&m->rate, n, m->t_old, m->h_old, m->x_old, m->x, m->F, m->rtol, m->atol,
                                                m->room, m->room + 2*n));
        if (m->pieces > 1)
            in_pieces(m);
    }
}

static void between(struct march *m, double t, double *x)
{
    size_t n = m->n;
    double part = (t - m->t_old)/(m->t - m->t_old);
    march_dense(m);
    if (m->dense_of == BY_SERIES)
        m->along(m->X_old, t - m->t_old, x, NULL);
    else if (m->dense_of == BY_COLLOCATION)
        EACH x[k] = m->x_old[k] + part*(m->F[k] + part*(m->F[n + k] + part*m->F[2*n + k]));
    else if (m->pieces > 1) {
        double at = part*(double)m->pieces, first = fmin(fmax(floor(at), 0), (double)m->pieces - 1);
        const double *piece = m->piece + 8*n*(size_t)first;
        dop853_between(n, at - first, piece, piece + n, x);
    } else
        dop853_between(n, part, m->x_old, m->F, x);
}

/* -- what ends a run ---------------------------------------------------------------------------------------------- */

/* whether polynomials through every second of the looks tell those between */
static int is_resolved(const double *g)
{
    static const double BETWEEN[PARTS/2][PARTS/2 + 1] = {{35, 140, -70, 28, -5}, {-5, 60, 90, -20, 3}, {3, -20, 90, 60, -5},
                                         {-5, 28, -70, 140, 35}}; /* /128 */
    double inner[PARTS + 1], largest = 0;
    for (int i = 0; i <= PARTS; i++) {
        inner[i] = g[i == 0 ? 0 : i == PARTS ? LOOKS - 1 : i + 1];
        largest = fabs(inner[i]) > largest ? fabs(inner[i]) : largest;
    }
    for (int i = 0; i < 4; i++) {
        double guess = 0;
        for (int j = 0; j < 5; j++)
            guess += BETWEEN[i][j]/128*inner[2*j];
        if (!(fabs(guess - inner[2*i + 1]) <= RESOLVED*largest))
            return 0;
    }
    return 1;
}

/* the functions of the events at instants of the last step */
void march_look(struct march *m, size_t count, const double *times, double *g)
{
    for (size_t i = 0; i < count; i++) {
        between(m, times[i], m->room + m->n);
        CALL(&m->events, times[i], m->room + m->n, g + i*m->n_events);
    }
}

static void look_times(const struct march *m, double *times)
{
    double near = EDGE*(m->t - m->t_old)/PARTS;
    times[0] = m->t_old, times[1] = m->t_old + near, times[LOOKS - 2] = m->t - near, times[LOOKS - 1] = m->t;
    for (int i = 1; i < PARTS; i++)
        times[i + 1] = m->t_old + i*((m->t - m->t_old)/PARTS);
}

/* the same at the looks into it */
static void look(struct march *m, double *times)
{
    look_times(m, times);
    march_look(m, LOOKS, times, m->looks);
}

/* whether function j does not come down to zero in the looks, as `EventSearch.step`; its memory where that is kept */
static int stays_up(struct march *m, size_t j, const double *times, int keep)
{
    size_t k = m->n_events;
    double sign = m->signs[j], floor = m->floors[j], largest = m->largest[j], g[LOOKS];
    int armed = m->armed[j];
    for (int i = 0; i < LOOKS; i++) {
        g[i] = m->looks[(size_t)i*k + j];
        largest = fabs(g[i]) > largest ? fabs(g[i]) : largest;
    }
    if (m->either[j]) {
        if (!is_resolved(g))
            return 0;
        floor = fmin(floor, TOUCHES*largest);
    }
    for (int i = 0; i < LOOKS && sign == 0; i++)
        if (fabs(g[i]) > floor)
            sign = g[i] < 0 ? -1 : 1;
    for (int i = 0; i < LOOKS; i++)
        g[i] *= sign;
    armed = armed || (g[0] > floor && sign != 0);
    for (int i = 1; i < LOOKS; i++) {
        if (!armed) {
            if (g[i] < -floor)
                return 0;
            armed = g[i] > floor;
            continue;
        }
        if (g[i] <= 0)
            return 0;
        if (i == 1 || !(g[i - 2] > 0 && g[i - 1] <= g[i - 2] && g[i - 1] <= g[i]))
            continue;
        double before = times[i - 1] - times[i - 2], after = times[i] - times[i - 1];
        double fall = (g[i - 1] - g[i - 2])/before, rise = (g[i] - g[i - 1])/after;
        double curvature = (rise - fall)/(before + after), slope = (fall*after + rise*before)/(before + after);
        double vertex = curvature > 0 ? g[i - 1] - slope*slope/(4*curvature) : g[i - 1];
        if (m->either[j] || !(vertex > 0.5*g[i - 1]))
            return 0;
    }
    if (keep)
        m->signs[j] = sign, m->armed[j] = armed, m->largest[j] = largest;
    return 1;
}

/* how far a state is from a singular position, as `Nearness`; `grew` is set where it is farther than any before */
static double nearness(struct march *m, double t, const double *x, int *grew)
{
    double least = 1, *values = m->work, found;
    if (m->n_determinants)
        CALL(&m->determinants, t, x, values);
    for (size_t i = 0; i <= m->n_determinants; i++) {
        if (i < m->n_determinants)
            found = fabs(values[i]) >= 0 ? fabs(values[i]) : 0;
        else if (m->n_rows) {
            double longest = 0;
            CALL(&m->ties, t, x, values);
            for (size_t j = 0; j < m->n_rows*m->n_columns; j++)
                values[j] = isfinite(values[j]) ? values[j] : 0;
            for (size_t j = 0; j < m->n_rows; j++) {
                double own = length(m->n_columns, values + j*m->n_columns);
                *grew |= own > m->lengths[j];
                m->lengths[j] = fmax(m->lengths[j], own);
                longest = fmax(longest, m->lengths[j]);
            }
            for (size_t j = 0; j < m->n_rows; j++)
                for (size_t k = 0; k < m->n_columns; k++)
                    values[j*m->n_columns + k] *= m->lengths[j] > ROW_ROUNDING*longest ? 1/m->lengths[j] : 0;
            found = singular_value(m->n_rows, m->n_columns, values, m->rank);
        } else
            continue;
        *grew |= found > m->sizes[i];
        m->sizes[i] = fmax(m->sizes[i], found);
        least = fmin(least, m->sizes[i] > 0 ? found/m->sizes[i] : found);
    }
    return least;
}

/* the same by looks into the last step: at none is it near, nor does it change so fast from one to the next */
static int stays_far(struct march *m)
{
    double sizes[PARTS + 1], least = INFINITY, steepest = 0;
    for (int grew = 1, pass = 0; grew && pass < 2; pass++) { /* once more against what has grown */
        grew = 0;
        for (int i = 0; i <= PARTS; i++) {
            double t = i == PARTS ? m->t : m->t_old + i*((m->t - m->t_old)/PARTS);
            between(m, t, m->room + m->n);
            sizes[i] = nearness(m, t, m->room + m->n, &grew);
        }
    }
    for (int i = 0; i <= PARTS; i++) {
        least = fmin(least, sizes[i]);
        steepest = i && fabs(sizes[i] - sizes[i - 1]) > steepest ? fabs(sizes[i] - sizes[i - 1]) : steepest;
    }
    return least > fmax(m->near, steepest);
}

/* whether the last step cannot have come near a singular position, as `RankLookout`; only then its memory
   of slopes is changed. What was measured before is measured anew against what has grown: else it would seem to stay */
static int is_far(struct march *m)
{
    int grew = 0, again = 0;
    double here = nearness(m, m->t, m->x, &grew), slope, steepest;
    if (grew)
        m->before = nearness(m, m->t_old, m->x_old, &again);
    slope = steepest = fabs(here - m->before)/(m->t - m->t_old);
    size_t n = m->n_slopes < 4 ? m->n_slopes + 1 : 4;
    for (size_t i = n == m->n_slopes ? 1 : 0; i < m->n_slopes; i++)
        steepest = fmax(steepest, m->slopes[i]);
    int is_calm = n == 4 && fmin(m->before, here) > m->near + STEEP*steepest*(m->t - m->t_old);
    if (!m->is_armed || !(is_calm || stays_far(m)))
        return 0;
    if (m->n_slopes == 4)
        memmove(m->slopes, m->slopes + 1, 3*sizeof *m->slopes);
    m->slopes[n - 1] = slope, m->n_slopes = n, m->before = here;
    return 1;
}

/* whether the last step needs no other eyes; only then the memory of what is watched is changed */
static int is_calm(struct march *m)
{
    double times[LOOKS];
    if (m->is_blind)
        return 0;
    if (m->n_events)
        look(m, times);
    for (size_t j = 0; j < m->n_events; j++)
        if (!stays_up(m, j, times, 0))
            return 0;
    if (m->is_near_watched && !is_far(m))
        return 0;
    for (size_t j = 0; j < m->n_events; j++)
        stays_up(m, j, times, 1);
    return 1;
}

/* -- all of it ---------------------------------------------------------------------------------------------------- */

/* What is left to do about a step that nothing ends: the states at instants in it, ties, its track; GOES_ON, or why not. */
static int done_with(struct march *m)
{
    size_t n = m->n, next = m->next;
    for (; next < m->n_instants && m->instants[next] <= m->t; next++) {
        between(m, m->instants[next], m->rows + next*n);
        if (held(m, m->instants[next], m->rows + next*n, m->atol) == STAYS_OPEN)
            return LOOK;
    }
    memcpy(m->room, m->x, n*sizeof *m->x);
    int moved = held(m, m->t, m->room, m->atol);
    if (moved == STAYS_OPEN)
        return LOOK;
    m->next = next;
    if (moved == MOVED) {
        memcpy(m->x, m->room, n*sizeof *m->x);
        CALL(&m->rate, m->t, m->x, m->f);
        m->evaluations++, m->has_series = 0;
    }
    m->track_t[m->tracked] = m->t;
    memcpy(m->track_x + m->tracked++*n, m->x, n*sizeof *m->x);
    if (m->t >= m->end)
        return REACHED;
    if (m->is_auto && is_to_change(m)) {
        if (!m->is_implicit)
            return STIFF;
        m->is_implicit = m->has_slope_values = 0, m->most_seen *= 2;
    }
    return GOES_ON;
}

/* Steps until one is to be looked at, the end is reached, or `most` are taken; how many were taken is left in it. */
int march(struct march *m, size_t *most)
{
    size_t allowed = *most;
    m->tracked = *most = 0;
    while (*most < allowed) {
        if (!(m->is_implicit ? stepped_implicitly(m) : m->order ? stepped_by_series(m) : stepped(m)))
            return TOO_SMALL;
        ++*most;
        if (!is_calm(m))
            return LOOK;
        int found = done_with(m);
        if (found != GOES_ON)
            return found;
    }
    return GOES_ON;
}

/* -- many runs ---------------------------------------------------------------------------------------------------- */

struct runs { /* one after the other in one march, each from its own start and with its own parameters */
    size_t next, last, is_begun, functions, parameters, most_steps, most_seen, begins; /* begins: rows at the start */
    double start;
    const double *x0, *p; /* runs x n, runs x parameters */
    double *x;            /* runs x (begins + n_instants) x n */
    int *is_done;         /* whether a run came to its end without a question */
    size_t *steps;
    struct rate **rates; /* all functions of the march, and what makes their constants */
    void (**constants)(const double *p, double *c);
    const double *stops;
    size_t n_stops;
};

/* whether the next run begins as others do: on its ties, with a finite rate, far from singular positions */
static int begun(struct march *m, struct runs *r)
{
    size_t n = m->n, rows = r->begins + m->n_instants;
    const double *p = r->p + r->next*r->parameters;
    for (size_t i = 0; i < r->functions; i++) {
        r->rates[i]->p = p;
        r->constants[i](p, (double *)r->rates[i]->c);
    }
    m->t = m->t_old = r->start, m->stops = r->stops, m->n_stops = r->n_stops;
    m->next = m->tracked = m->is_dense = m->dense_of = m->has_series = m->n_slopes = 0;
    m->is_implicit = m->stiff_seen = m->easy_seen = m->implicit_steps = 0, m->most_seen = r->most_seen;
    m->rows = r->x + (r->next*rows + r->begins)*n;
    memcpy(m->x, r->x0 + r->next*n, n*sizeof *m->x);
    if (held(m, m->t, m->x, m->atol) == STAYS_OPEN)
        return 0;
    memcpy(m->x_old, m->x, n*sizeof *m->x);
    if (r->begins)
        memcpy(m->rows - n, m->x, n*sizeof *m->x);
    march_begin(m);
    EACH if (!isfinite(m->f[k])) return 0;
    if (m->is_near_watched) {
        int grew = 0;
        for (size_t i = 0; i < m->n_rows; i++)
            m->lengths[i] = 0;
        for (size_t i = 0; i <= m->n_determinants; i++)
            m->sizes[i] = 0;
        m->before = nearness(m, m->t, m->x, &grew);
        m->is_armed = m->before > ARMED*m->near;
        return (int)m->is_armed;
    }
    return 1;
}

/* Runs from `next` on, for about so many steps; whether some are left. One that needs a look is not done, and left. */
int march_runs(struct march *m, struct runs *r, size_t budget)
{
    while (r->next < r->last && budget > 0) {
        size_t *steps = r->steps + r->next, most = MOST_AT_ONCE;
        int found = LOOK;
        if (r->is_begun || begun(m, r)) {
            *steps = r->is_begun ? *steps : 0;
            r->is_begun = 1;
            most = most < r->most_steps - *steps ? most : r->most_steps - *steps;
            found = march(m, &most);
            *steps += most;
            if (found == GOES_ON && *steps < r->most_steps) {
                budget -= most < budget ? most : budget;
                continue;
            }
            budget -= most < budget ? most : budget;
        }
        r->is_done[r->next++] = found == REACHED, r->is_begun = 0;
    }
    return r->next < r->last;
}
