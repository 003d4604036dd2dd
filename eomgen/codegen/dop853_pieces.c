/* States between the ends of a step of DOP853 that are as accurate as its ends; behind dop853.c. */

#define DOP853_MISSED 10.0 /* tolerances from which on what is between is followed in shorter pieces */
#define DOP853_PIECES 8    /* at most; half as long they are 2^8 times as accurate */

/* by how many tolerances, at most, the rate of the polynomial times h misses that of the equations, at 0.3 of the step:
   about four times its largest error, which a step held short by stability alone does not know; y, dy are room for n */
static REAL dop853_missed(const struct rate *f, size_t n, REAL t, REAL h, const REAL *x, const REAL *x_new,
                          const REAL *F, REAL rtol, REAL atol, REAL *y, REAL *dy)
{
    const REAL part = (REAL){0} + R(0.3), left = (REAL){0} + R(0.7);
    REAL most = (REAL){0};
    dop853_between(n, part, x, F, y);
    CALL(f, t + part*h, y, dy);
    EACH {
        REAL six = F[6*n + k], five = F[5*n + k] + part*six, four = F[4*n + k] + left*five;
        REAL three = F[3*n + k] + part*four, two = F[2*n + k] + left*three, one = F[n + k] + part*two;
        REAL slope = left*six - five; /* of `four` along the step, and so on */
        slope = four + part*slope, slope = left*slope - three, slope = two + part*slope, slope = left*slope - one;
        slope = F[k] + left*one + part*slope;
        REAL off = SIZE(h*dy[k] - slope)/(atol + rtol*LARGER(SIZE(x[k]), SIZE(x_new[k])));
        most = LARGER(off, most);
    }
    return most;
}

/* into how many pieces of one length a step is to be taken, for states between its ends that miss so much */
static size_t dop853_pieces(double missed)
{
    size_t pieces = 1;
    for (; missed > DOP853_MISSED && pieces < DOP853_PIECES; missed /= 256)
        pieces *= 2;
    return pieces;
}

/* The next piece of a step, of length h from x on, and F of its polynomial; K0 = f(t, x) is there before, and that of
   the piece after it, x_new, is there after; y is room for n. */
static void dop853_piece(const struct rate *f, size_t n, REAL t, REAL h, const REAL *x, REAL *x_new, REAL *y, REAL *K,
                         REAL *F)
{
    dop853_step(f, n, t, h, x, x_new, K);
    dop853_dense(f, n, t, h, x, x_new, y, K, F);
    EACH K[k] = K[12*n + k];
}
