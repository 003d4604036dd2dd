/* Power series in time: what the recurrences of codegen/taylor.py are made of. REAL as in dop853.c. */

#include <stddef.h>
#include <string.h>

#ifndef REAL
#define REAL double
#endif

/* Before it: SERIES_STATES, SERIES_ORDER; SERIES_UNROLL and SERIES_INLINE, with which a compiler may know how long the
   sums are. */

/* a[0] b[0] + a[1] b[-1] + ..., so many products */
SERIES_INLINE REAL series_dot(const REAL *a, const REAL *b, size_t count)
{
    REAL sum = {0};
    SERIES_UNROLL
    for (size_t i = 0; i < count; i++)
        sum += a[i]*b[-(ptrdiff_t)i];
    return sum;
}

/* coefficient j of a b, for j > 0; what has come last is added last, so that nothing waits for it */
SERIES_INLINE REAL series_product(const REAL *a, const REAL *b, size_t j)
{
    return a[j]*b[0] + (a[0]*b[j] + series_dot(a + 1, b + j - 1, j - 1));
}

/* coefficient j of a a */
SERIES_INLINE REAL series_square(const REAL *a, size_t j)
{
    REAL pairs = series_dot(a + 1, a + j - 1, (j - 1)/2);
    pairs = j % 2 ? pairs + pairs : pairs + pairs + a[j/2]*a[j/2];
    return pairs + (a[0] + a[0])*a[j];
}

/* x and, where it is asked for, x' by the series, h after the instant of its coefficients */
void eomgen_along(const REAL *X, REAL h, REAL *x, REAL *slope)
{
    REAL y[SERIES_STATES], dy[SERIES_STATES];
    memset(dy, 0, sizeof dy);
    for (size_t k = 0; k < SERIES_STATES; k++)
        y[k] = X[SERIES_ORDER*SERIES_STATES + k];
    for (size_t j = SERIES_ORDER; j-- > 0;)
        for (size_t k = 0; k < SERIES_STATES; k++)
            dy[k] = dy[k]*h + y[k], y[k] = y[k]*h + X[j*SERIES_STATES + k];
    memcpy(x, y, sizeof y);
    if (slope)
        memcpy(slope, dy, sizeof dy);
}
