/* Several runs at once, one in each lane of a vector: the functions that vectors lack.

   sin and cos: the argument less a multiple of pi/2 in three parts, then polynomials on [-pi/4, pi/4]; an argument
   beyond 2^20 goes to the library. No lane knows what stands in the others.
   Source: fdlibm, k_sin.c, k_cos.c and e_rem_pio2.c (W. J. Cody and W. Waite, Software Manual, ch. 8). */

#include <math.h>
#include <stddef.h>
#include <string.h>

typedef double lanes_real __attribute__((vector_size(8*LANES)));
typedef long long MASK __attribute__((vector_size(8*LANES)));

#define REAL lanes_real
#define R(number) (number)
#define L(number) ((REAL){0} + (number))
#define LANE(vector, lane) ((vector)[lane])
#define EACH_LANE for (int l = 0; l < LANES; l++)
#define CHOSEN(mask, a, b) ((REAL)(((mask) & (MASK)(a)) | (~(mask) & (MASK)(b))))
#define SIZE(a) lanes_fabs(a)
#define LARGER(a, b) CHOSEN((a) > (b), a, b)
#define INLINE static inline __attribute__((always_inline, unused))

INLINE REAL lanes_fabs(REAL a) { return (REAL)((MASK)a & ((MASK){0} + 0x7fffffffffffffffLL)); }

#define OF_ONE(name) \
    INLINE REAL lanes_##name(REAL a) { REAL found; EACH_LANE found[l] = name(a[l]); return found; }
#define OF_TWO(name) \
    INLINE REAL lanes_##name(REAL a, REAL b) { REAL found; EACH_LANE found[l] = name(a[l], b[l]); return found; }
OF_ONE(tan) OF_ONE(asin) OF_ONE(acos) OF_ONE(atan) OF_ONE(sinh) OF_ONE(cosh) OF_ONE(tanh) OF_ONE(sqrt) OF_ONE(exp)
OF_ONE(log) OF_TWO(pow) OF_TWO(atan2)

INLINE REAL lanes_sign(REAL a) { return CHOSEN(a > 0, L(1.0), CHOSEN(a < 0, L(-1.0), a)); }
INLINE REAL lanes_min(REAL a, REAL b) { return CHOSEN((a < b) | (a != a), a, b); }
INLINE REAL lanes_max(REAL a, REAL b) { return CHOSEN((a > b) | (a != a), a, b); }
INLINE REAL lanes_less(REAL a, REAL b) { return CHOSEN(a < b, L(1.0), CHOSEN(a >= b, L(0.0), L(NAN))); }
INLINE REAL lanes_less_equal(REAL a, REAL b) { return CHOSEN(a <= b, L(1.0), CHOSEN(a > b, L(0.0), L(NAN))); }
INLINE REAL lanes_select(REAL given, REAL a, REAL b)
{
    return CHOSEN(given == 0, b, CHOSEN(given == given, a, given));
}

/* the argument less n pi/2, and n in the last bits of the second */
INLINE REAL lanes_reduced(REAL a, MASK *quarters)
{
    REAL whole = a*L(0.63661977236758134308) + L(6755399441055744.0), n = whole - L(6755399441055744.0);
    *quarters = (MASK)whole;
    return ((a - n*L(1.57079632673412561417e+00)) - n*L(6.07710050630396597660e-11)) - n*L(2.02226624879595063154e-21);
}

INLINE REAL lanes_sine(REAL a)
{
    REAL z = a*a;
    return a + a*z*(L(-1.66666666666666324348e-01) + z*(L(8.33333333332248946124e-03)
        + z*(L(-1.98412698298579493134e-04) + z*(L(2.75573137070700676789e-06)
        + z*(L(-2.50507602534068634195e-08) + z*L(1.58969099521155010221e-10))))));
}

INLINE REAL lanes_cosine(REAL a)
{
    REAL z = a*a, half = z*L(0.5), first = L(1.0) - half;
    return first + (((L(1.0) - first) - half) + z*z*(L(4.16666666666666019037e-02)
        + z*(L(-1.38888888888741095749e-03) + z*(L(2.48015872894767294178e-05)
        + z*(L(-2.75573143513906633035e-07) + z*(L(2.08757232129817482790e-09)
        + z*L(-1.13596475577881948265e-11)))))));
}

/* sin of a, or of a + pi/2 */
INLINE REAL lanes_turned(REAL a, long long more)
{
    MASK quarters, one = (MASK){0} + 1, outside = ~(lanes_fabs(a) < L(1048576.0));
    REAL rest = lanes_reduced(a, &quarters), s = lanes_sine(rest), c = lanes_cosine(rest);
    quarters += more;
    REAL found = CHOSEN((quarters & one) == one, c, s);
    found = CHOSEN((quarters & (one + one)) != 0, -found, found);
    int any = 0;
    EACH_LANE any |= outside[l] != 0;
    if (any)
        EACH_LANE if (outside[l])
            found[l] = more ? cos(a[l]) : sin(a[l]);
    return found;
}

INLINE REAL lanes_sin(REAL a) { return lanes_turned(a, 0); }
INLINE REAL lanes_cos(REAL a) { return lanes_turned(a, 1); }
