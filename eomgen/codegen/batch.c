/* Many runs of x' = f(t, x, p) by DOP853, LANES at a time, each with its own parameters, time and steps: a lane whose
   run is over takes the next one. What a run gives does not depend on the lane that it runs in, nor on its neighbours.

   It stands behind codegen/batching.py, which fills the struct; eomgen_constants and eomgen_evaluate stand before it. */

enum { RUNS, FINISHED, NOT_FINITE, TOO_SMALL, TOO_MANY, STIFF }; /* of a run */

struct batch {
    size_t n, parameters, constants, samples, next, last; /* next: the run that comes; last: the one after the last */
    double start, end, rtol, atol;
    size_t most_steps;
    const double *instants, *x0, *p; /* samples, runs x n, runs x parameters */
    double *x, *reached;             /* runs x samples x n; the instant at which each run ended */
    int *status;
    size_t *steps;
    const double *stops; /* instants across which no step goes */
    size_t n_stops;
    const int *spheres; /* the places of quaternions, 4 each */
    size_t n_spheres;
    size_t begun;
    REAL *work; /* (29 n + parameters + constants + 2) numbers for every lane */
    size_t run[LANES], sample[LANES], stop[LANES], taken[LANES], stiff[LANES], easy[LANES];
    double h[LANES];
    int is_new[LANES], is_over[LANES], rejected[LANES];
};

struct lanes {
    REAL *t, *h, *x, *f, *y, *K, *F, *p, *c;
};

static struct lanes lanes_of(const struct batch *b)
{
    size_t n = b->n;
    REAL *x = b->work + 2, *f = x + n, *y = f + n, *K = y + 3*n, *F = K + 16*n, *p = F + 7*n;
    struct lanes found = {b->work, b->work + 1, x, f, y, K, F, p, p + b->parameters};
    return found;
}

static void lanes_on_spheres(const struct batch *b, REAL *x)
{
    for (size_t i = 0; i < b->n_spheres; i++)
        EACH_LANE {
            double sum = 0;
            for (int j = 0; j < 4; j++)
                sum += LANE(x[b->spheres[4*i + j]], l)*LANE(x[b->spheres[4*i + j]], l);
            for (int j = 0; j < 4 && sum > 0; j++)
                LANE(x[b->spheres[4*i + j]], l) /= sqrt(sum);
        }
}

static void lane_gives(const struct batch *b, int l, size_t sample, const REAL *x)
{
    double *row = b->x + (b->run[l]*b->samples + sample)*b->n;
    for (size_t k = 0; k < b->n; k++)
        row[k] = LANE(x[k], l);
}

/* the run in a lane is over: the next one, or the same state for ever */
static void next_run(struct batch *b, const struct lanes *v, int l)
{
    if (b->next == b->last) {
        b->is_over[l] = 1;
        b->run[l] = b->last;
        return;
    }
    size_t run = b->run[l] = b->next++;
    b->sample[l] = b->stop[l] = b->taken[l] = b->stiff[l] = b->easy[l] = 0;
    b->is_new[l] = 1, b->rejected[l] = 0;
    LANE(*v->t, l) = b->start;
    for (size_t k = 0; k < b->n; k++)
        LANE(v->x[k], l) = b->x0[run*b->n + k];
    for (size_t k = 0; k < b->parameters; k++)
        LANE(v->p[k], l) = b->p[run*b->parameters + k];
}

static void ends(struct batch *b, const struct lanes *v, int l, int status)
{
    b->status[b->run[l]] = status;
    b->steps[b->run[l]] = b->taken[l];
    b->reached[b->run[l]] = LANE(*v->t, l);
    next_run(b, v, l);
}

/* the rate and a first step of the lanes that begin, as scipy's */
static void begin_lanes(struct batch *b, const struct lanes *v, const struct rate *f)
{
    size_t n = b->n;
    REAL *x = v->y, *rate = x + n, *first = rate + n;
    eomgen_constants(v->p, v->c);
    CALL(f, *v->t, v->x, first);
    double h[LANES], d1[LANES];
    EACH_LANE {
        double d0 = 0, span = b->end - b->start;
        d1[l] = 0;
        for (size_t k = 0; k < n; k++) {
            double scale = b->atol + fabs(LANE(v->x[k], l))*b->rtol;
            d0 += pow(LANE(v->x[k], l)/scale, 2)/(double)n, d1[l] += pow(LANE(first[k], l)/scale, 2)/(double)n;
        }
        d0 = sqrt(d0), d1[l] = sqrt(d1[l]);
        h[l] = fmin(d0 < 1e-5 || d1[l] < 1e-5 ? 1e-6 : 0.01*d0/d1[l], span);
        for (size_t k = 0; k < n; k++)
            LANE(x[k], l) = LANE(v->x[k], l) + h[l]*LANE(first[k], l);
        LANE(*v->h, l) = h[l];
    }
    CALL(f, *v->t + *v->h, x, rate);
    EACH_LANE if (b->is_new[l]) {
        double d2 = 0;
        for (size_t k = 0; k < n; k++)
            d2 += pow((LANE(rate[k], l) - LANE(first[k], l))/(b->atol + fabs(LANE(v->x[k], l))*b->rtol), 2)/(double)n;
        d2 = sqrt(d2)/h[l];
        double next = d1[l] <= 1e-15 && d2 <= 1e-15 ? fmax(1e-6, h[l]*1e-3) : pow(0.01/fmax(d1[l], d2), 1.0/8);
        b->h[l] = fmin(fmin(100*h[l], next), b->end - b->start);
        for (size_t k = 0; k < n; k++)
            LANE(v->f[k], l) = LANE(first[k], l);
        b->is_new[l] = 0;
        while (b->sample[l] < b->samples && b->instants[b->sample[l]] <= b->start)
            lane_gives(b, l, b->sample[l]++, v->x);
    }
}

/* the samples in the step of the lanes that have accepted it */
static void give_samples(struct batch *b, const struct lanes *v, const struct rate *f, const int *accepted)
{
    size_t n = b->n;
    REAL part = {0};
    REAL *y = v->y + 2*n;
    for (int is_dense = 0;;) {
        int any = 0;
        EACH_LANE {
            double t = LANE(*v->t, l), h = LANE(*v->h, l);
            int has = accepted[l] && b->sample[l] < b->samples && b->instants[b->sample[l]] <= t + h;
            any |= has;
            LANE(part, l) = has ? (b->instants[b->sample[l]] - t)/h : 0;
        }
        if (!any)
            return;
        if (!is_dense)
            dop853_dense(f, n, *v->t, *v->h, v->x, v->y, y, v->K, v->F);
        is_dense = 1;
        dop853_between(n, part, v->x, v->F, y);
        lanes_on_spheres(b, y);
        EACH_LANE {
            if (accepted[l] && b->sample[l] < b->samples && b->instants[b->sample[l]] <= LANE(*v->t, l) + LANE(*v->h, l))
                lane_gives(b, l, b->sample[l]++, y);
        }
    }
}

/* whether stability alone holds the steps of a lane short, as `is_to_change` of march.c */
static int is_stiff(struct batch *b, const struct lanes *v, int l)
{
    static const double APART[12] = {DOP853_APART};
    double rates = 0, states = 0;
    for (size_t k = 0; k < b->n; k++) {
        double change = LANE(v->K[12*b->n + k], l) - LANE(v->K[11*b->n + k], l), moved = 0;
        for (size_t j = 0; j < 12; j++)
            moved += APART[j]*LANE(v->K[j*b->n + k], l);
        rates += change*change, states += moved*moved;
    }
    if (states > 0 && sqrt(rates/states) > HELD_SHORT)
        b->stiff[l]++, b->easy[l] = 0;
    else if (++b->easy[l] == FORGOTTEN)
        b->stiff[l] = b->easy[l] = 0;
    return b->stiff[l] >= SEEN;
}

/* so many rounds of one step in each lane; whether runs are left */
int batch(struct batch *b, size_t rounds)
{
    size_t n = b->n;
    struct lanes v = lanes_of(b);
    struct rate f = {eomgen_evaluate, v.p, v.c, NULL};
    if (!b->begun)
        EACH_LANE next_run(b, &v, l);
    b->begun = 1;
    REAL rtol, atol;
    EACH_LANE LANE(rtol, l) = b->rtol, LANE(atol, l) = b->atol;
    for (; rounds; rounds--) {
        int accepted[LANES], any_new = 0, all_over = 1;
        EACH_LANE any_new |= b->is_new[l], all_over &= b->is_over[l];
        if (all_over)
            return 0;
        if (any_new)
            begin_lanes(b, &v, &f);
        EACH_LANE {
            double t = LANE(*v.t, l), stop = b->end;
            while (b->stop[l] < b->n_stops && b->stops[b->stop[l]] <= t + SAME_INSTANT*fmax(1, fabs(t)))
                b->stop[l]++;
            if (b->stop[l] < b->n_stops && b->stops[b->stop[l]] < stop)
                stop = b->stops[b->stop[l]];
            double least = 10*fabs(nextafter(t, INFINITY) - t);
            b->h[l] = b->h[l] < least && !b->rejected[l] ? least : b->h[l];
            LANE(*v.h, l) = t + b->h[l] < stop ? b->h[l] : stop - t;
        }
        memcpy(v.K, v.f, n*sizeof *v.f);
        dop853_step(&f, n, *v.t, *v.h, v.x, v.y, v.K);
        REAL errors[2];
        dop853_errors(n, v.x, v.y, v.K, rtol, atol, errors);
        int look = rounds % LOOKED_AT == 0, stiff[LANES];
        EACH_LANE {
            double whole = LANE(errors[0], l) + 0.01*LANE(errors[1], l), h = LANE(*v.h, l);
            double error = whole == 0 ? 0 : h*LANE(errors[0], l)/sqrt(whole*(double)n);
            double factor = error == 0 ? LARGEST_GROWTH : SAFETY*pow(error, -1.0/8);
            accepted[l] = error < 1 && !b->is_over[l];
            if (accepted[l])
                b->h[l] = h*fmin(b->rejected[l] ? 1 : LARGEST_GROWTH, factor);
            else
                b->h[l] = h*(factor > SMALLEST_GROWTH ? factor : SMALLEST_GROWTH);
            b->taken[l] += (size_t)accepted[l], b->rejected[l] = !accepted[l];
            stiff[l] = accepted[l] && (look || b->stiff[l]) && is_stiff(b, &v, l);
        }
        give_samples(b, &v, &f, accepted);
        if (b->n_spheres) {
            lanes_on_spheres(b, v.y);
            CALL(&f, *v.t + *v.h, v.y, v.K + 12*n);
        }
        EACH_LANE {
            double t = LANE(*v.t, l), reached = t + LANE(*v.h, l);
            if (b->is_over[l])
                continue;
            if (!accepted[l]) {
                if (!(b->h[l] >= 10*fabs(nextafter(t, INFINITY) - t))) {
                    int finite = 1;
                    for (size_t k = 0; k < n; k++)
                        finite &= isfinite(LANE(v.f[k], l)) && isfinite(LANE(v.K[12*n + k], l));
                    ends(b, &v, l, finite ? TOO_SMALL : NOT_FINITE);
                }
                continue;
            }
            if (stiff[l]) {
                ends(b, &v, l, STIFF);
                continue;
            }
            double stop = b->stop[l] < b->n_stops && b->stops[b->stop[l]] < b->end ? b->stops[b->stop[l]] : b->end;
            LANE(*v.t, l) = fabs(reached - stop) <= 2*fabs(nextafter(stop, INFINITY) - stop) ? stop : reached;
            for (size_t k = 0; k < n; k++) {
                LANE(v.x[k], l) = LANE(v.y[k], l);
                LANE(v.f[k], l) = LANE(v.K[12*n + k], l);
            }
            if (LANE(*v.t, l) >= b->end) {
                for (; b->sample[l] < b->samples; b->sample[l]++)
                    lane_gives(b, l, b->sample[l], v.x);
                ends(b, &v, l, FINISHED);
            } else if (b->taken[l] >= b->most_steps)
                ends(b, &v, l, TOO_MANY);
        }
    }
    return 1;
}
