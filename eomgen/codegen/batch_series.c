/* Steps along power series in lanes, as `stepped_by_series` of march.c; behind batch.c and taylor.c. */

/* log2 and 2^a to a hundredth, for the length of a step; of 0 and of what is not finite something far off */
static double rough_log2(double a)
{
    unsigned long long bits;
    memcpy(&bits, &a, sizeof bits);
    double exponent = (double)((long long)(bits >> 52 & 2047) - 1023), m;
    bits = (bits & 0xfffffffffffffULL) | 1023ULL << 52;
    memcpy(&m, &bits, sizeof m);
    return exponent - 5.0/3 + m*(2 - m/3);
}

static double rough_exp2(double a)
{
    double whole = floor(a), rest = a - whole, power;
    unsigned long long bits = (unsigned long long)(1023 + (long long)whole) << 52;
    memcpy(&power, &bits, sizeof power);
    return power*(1 + rest*(0.6565 + 0.3435*rest));
}

/* the largest of sizes against the tolerance, in every lane; NaN where one is */
static REAL largest_of(const struct batch *b, const REAL *sizes, const REAL *x, const REAL *y)
{
    REAL largest = {0}, all = {0}, atol = largest + b->atol;
    for (size_t k = 0; k < b->n; k++) {
        REAL one = SIZE(x[k]), other = SIZE(y[k]), size = SIZE(sizes[k])/(atol + b->rtol*LARGER(one, other));
        largest = LARGER(size, largest), all += size;
    }
    return largest + (all - all);
}

/* the samples in the step of the lanes that have accepted it */
static void give_samples(struct batch *b, const struct lanes *v, const int *accepted)
{
    REAL part = {0}, *y = v->y + 2*b->n;
    for (;;) {
        int any = 0, has[LANES];
        EACH_LANE {
            any |= has[l] = accepted[l] && has_sample(b, v, l);
            LANE(part, l) = has[l] ? b->instants[b->sample[l]] - LANE(*v->t, l) : 0;
        }
        if (!any)
            return;
        eomgen_along(v->room, part, y, NULL);
        lanes_on_spheres(b, y);
        EACH_LANE if (has[l])
            lane_gives(b, l, b->sample[l]++, y);
    }
}

/* so many rounds of one step in each lane; whether runs are left */
int batch(struct batch *b, size_t rounds)
{
    size_t n = b->n;
    struct lanes v = lanes_of(b);
    REAL *X = v.room, *W = X + (SERIES_ORDER + 1)*n, *slope = v.y + n, *f = v.y + 3*n;
    if (!b->begun)
        EACH_LANE next_run(b, &v, l);
    b->begun = 1;
    for (; rounds; rounds--) {
        int accepted[LANES], any_new = 0, all_over = 1;
        EACH_LANE any_new |= b->is_new[l], all_over &= b->is_over[l];
        if (all_over)
            return 0;
        if (any_new)
            eomgen_constants(v.p, v.c);
        EACH_LANE if (b->is_new[l])
            while (b->sample[l] < b->samples && b->instants[b->sample[l]] <= b->start)
                lane_gives(b, l, b->sample[l]++, v.x);
        eomgen_series(*v.t, v.x, v.p, v.c, X, W);
        REAL last_but_one = largest_of(b, X + (SERIES_ORDER - 1)*n, v.x, v.x), last = largest_of(b, X + SERIES_ORDER*n, v.x, v.x);
        EACH_LANE {
            double t = LANE(*v.t, l), stop = lane_stop(b, l, t);
            double before = rough_log2(LANE(last_but_one, l))/(SERIES_ORDER - 1), end = rough_log2(LANE(last, l))/SERIES_ORDER;
            double h = rough_exp2(before > end ? -before : -end);
            b->h[l] = b->rejected[l] && b->h[l] < h ? b->h[l] : h;
            LANE(*v.h, l) = t + b->h[l] < stop ? b->h[l] : stop - t;
            b->is_new[l] = 0;
        }
        eomgen_along(X, *v.h, v.y, slope);
        eomgen_evaluate(*v.t + *v.h, v.y, v.p, v.c, NULL, f);
        for (size_t k = 0; k < n; k++)
            slope[k] = *v.h*(slope[k] - f[k]);
        REAL off = largest_of(b, slope, v.x, v.y);
        EACH_LANE {
            accepted[l] = LANE(off, l) <= SERIES_ORDER && b->h[l] >= shortest(LANE(*v.t, l)) && !b->is_over[l];
            b->taken[l] += (size_t)accepted[l], b->rejected[l] = !accepted[l];
            b->h[l] = accepted[l] ? b->h[l] : LANE(*v.h, l)/2;
        }
        give_samples(b, &v, accepted);
        lanes_on_spheres(b, v.y);
        EACH_LANE {
            if (b->is_over[l])
                continue;
            if (accepted[l])
                moves_on(b, &v, l);
            else if (!(b->h[l] >= shortest(LANE(*v.t, l)))) {
                int finite = 1;
                for (size_t k = 0; k < n; k++)
                    finite &= isfinite(LANE(X[n + k], l)) && isfinite(LANE(f[k], l));
                ends(b, &v, l, finite ? TOO_SMALL : NOT_FINITE);
            }
        }
    }
    return 1;
}
