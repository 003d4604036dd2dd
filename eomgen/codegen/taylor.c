/* Power series in time: what the recurrences of codegen/taylor.py are made of. REAL as in dop853.c. */

#include <stddef.h>
#include <string.h>

#ifndef REAL
#define REAL double
#endif

/* Before it: SERIES_STATES, SERIES_ORDER; SERIES_SUMS, how many sums over products of coefficients there are, in whole
   vectors; SERIES_UNROLL and SERIES_INLINE, with which a compiler may know how long the sums are.

   The sum over 0 < i < j of a[i] b[j - i] takes nothing of order j: numbers keep both series of all sums side by side
   and begin with all sums at once, in vectors; of a row they keep its first coefficient. What REAL is several numbers has
   its vectors already, and keeps rows whole. */

#ifdef LANES
#define SERIES_BEGIN(at, j)
#define SERIES_END(at, j, k, a, b)
#define SERIES_ROW(row) (W + (row)*(SERIES_ORDER + 1))
#define SERIES_PUT(row, j, value) SERIES_ROW(row)[j] = value;
#define SERIES_NOW(row, j) SERIES_ROW(row)[j]
#define SERIES_FIRST(row) SERIES_ROW(row)[0]
#define SERIES_SUM(k, a, b, j) series_dot(SERIES_ROW(a) + 1, SERIES_ROW(b) + j - 1, j - 1)
#define SERIES_SQUARE(k, a, j) series_pairs(SERIES_ROW(a), j)

/* a[0] b[0] + a[1] b[-1] + ..., so many products */
SERIES_INLINE REAL series_dot(const REAL *a, const REAL *b, size_t count)
{
    REAL sum = {0};
    SERIES_UNROLL
    for (size_t i = 0; i < count; i++)
        sum += a[i]*b[-(ptrdiff_t)i];
    return sum;
}

/* the same of a and a, by pairs */
SERIES_INLINE REAL series_pairs(const REAL *a, size_t j)
{
    REAL pairs = series_dot(a + 1, a + j - 1, (j - 1)/2);
    return j % 2 ? pairs + pairs : pairs + pairs + a[j/2]*a[j/2];
}
#else
enum { SERIES_WIDTH = 8, SERIES_HALF = SERIES_SUMS*(SERIES_ORDER - 1) };
typedef double series_wide __attribute__((vector_size(8*SERIES_WIDTH), aligned(8), may_alias));

#define SERIES_BEGIN(at, j) REAL sums[SERIES_SUMS]; (void)sums; series_sums(at, j, sums);
#define SERIES_END(at, j, k, a, b) \
    (at)[(j - 1)*SERIES_SUMS + k] = row_##a, (at)[SERIES_HALF + (j - 1)*SERIES_SUMS + k] = row_##b;
#define SERIES_PUT(row, j, value) const REAL row_##row = value; (void)row_##row;
#define SERIES_NOW(row, j) row_##row
#define SERIES_FIRST(row) W[row]
#define SERIES_SUM(k, a, b, j) sums[k]
#define SERIES_SQUARE(k, a, j) sums[k]

#define SERIES_PRODUCTS(i) \
    *(const series_wide *)(a + ((i) - 1)*SERIES_SUMS + k)*(*(const series_wide *)(b + (j - (i) - 1)*SERIES_SUMS + k))

/* all sums; what has come last is added last, so that nothing waits for it */
SERIES_INLINE void series_sums(const REAL *a, size_t j, REAL *sums)
{
    const REAL *b = a + SERIES_HALF;
    for (size_t k = 0; k < SERIES_SUMS; k += SERIES_WIDTH) {
        series_wide sum = {0};
        SERIES_UNROLL
        for (size_t i = 2; i + 1 < j; i++)
            sum += SERIES_PRODUCTS(i);
        if (j > 1)
            sum += SERIES_PRODUCTS(1);
        if (j > 2)
            sum += SERIES_PRODUCTS(j - 1);
        *(series_wide *)(sums + k) = sum;
    }
}
#endif

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
