/* Many runs of x' = f(t, x, p), LANES at a time, each with its own parameters, time and steps: a lane whose
   run is over takes the next one. What a run gives does not depend on the lane that it runs in, nor on its neighbours.

   It stands behind codegen/rhs.py, which fills the struct; eomgen_constants and eomgen_evaluate stand before it. */

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
    REAL *work; /* (6 n + room + parameters + constants + 2) numbers for every lane */
    size_t room; /* of one step */
    size_t run[LANES], sample[LANES], stop[LANES], taken[LANES], stiff[LANES], easy[LANES];
    double h[LANES];
    int is_new[LANES], is_over[LANES], rejected[LANES];
};

struct lanes {
    REAL *t, *h, *x, *f, *y, *room, *p, *c; /* y: 4 n */
};

static struct lanes lanes_of(const struct batch *b)
{
    size_t n = b->n;
    REAL *x = b->work + 2, *f = x + n, *y = f + n, *room = y + 4*n, *p = room + b->room;
    struct lanes found = {b->work, b->work + 1, x, f, y, room, p, p + b->parameters};
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

/* the next instant of a lane across which no step goes */
static double lane_stop(struct batch *b, int l, double t)
{
    while (b->stop[l] < b->n_stops && b->stops[b->stop[l]] <= t + SAME_INSTANT*fmax(1, fabs(t)))
        b->stop[l]++;
    return b->stop[l] < b->n_stops && b->stops[b->stop[l]] < b->end ? b->stops[b->stop[l]] : b->end;
}

/* the shortest step from an instant on */
static double shortest(double t)
{
    return 10*fabs(nextafter(t, INFINITY) - t);
}

static int has_sample(const struct batch *b, const struct lanes *v, int l)
{
    return b->sample[l] < b->samples && b->instants[b->sample[l]] <= LANE(*v->t, l) + LANE(*v->h, l);
}

/* a lane is where its step ended; the run in it may be over */
static void moves_on(struct batch *b, const struct lanes *v, int l)
{
    double reached = LANE(*v->t, l) + LANE(*v->h, l);
    double stop = b->stop[l] < b->n_stops && b->stops[b->stop[l]] < b->end ? b->stops[b->stop[l]] : b->end;
    LANE(*v->t, l) = fabs(reached - stop) <= 2*fabs(nextafter(stop, INFINITY) - stop) ? stop : reached;
    for (size_t k = 0; k < b->n; k++)
        LANE(v->x[k], l) = LANE(v->y[k], l);
    if (LANE(*v->t, l) >= b->end) {
        for (; b->sample[l] < b->samples; b->sample[l]++)
            lane_gives(b, l, b->sample[l], v->x);
        ends(b, v, l, FINISHED);
    } else if (b->taken[l] >= b->most_steps)
        ends(b, v, l, TOO_MANY);
}
