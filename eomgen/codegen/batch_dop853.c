/* Steps of DOP853 in lanes; behind batch.c and dop853.c. */

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
}/* the samples of lanes that lie in piece j of their step, by its polynomial from x on; of a lane with one piece, or more */
static void give_between(struct batch *b, const struct lanes *v, const int *accepted, const size_t *pieces, size_t j,
                         const REAL *x, const REAL *F, REAL *y)
{
    for (;;) {
        int any = 0, is_here[LANES];
        REAL part = {0};
        EACH_LANE {
            double at = 0;
            is_here[l] = accepted[l] && j < pieces[l] && (pieces[l] > 1) == (x != v->x) && has_sample(b, v, l);
            if (is_here[l])
                at = (b->instants[b->sample[l]] - LANE(*v->t, l))/LANE(*v->h, l)*(double)pieces[l] - (double)j;
            is_here[l] &= at <= 1 || j + 1 == pieces[l];
            LANE(part, l) = is_here[l] ? at : 0;
            any |= is_here[l];
        }
        if (!any)
            return;
        dop853_between(b->n, part, x, F, y);
        lanes_on_spheres(b, y);
        EACH_LANE if (is_here[l])
            lane_gives(b, l, b->sample[l]++, y);
    }
}

/* the samples in the step of the lanes that have accepted it: by its polynomial, or by shorter ones where a lane needs
   them; what a lane gives does not depend on the pieces of others */
static void give_samples(struct batch *b, const struct lanes *v, const struct rate *f, const int *accepted)
{
    size_t n = b->n, any = 0, most = 1, pieces[LANES];
    REAL rtol, atol, t = *v->t, h = *v->h, *y = v->y + 2*n, *F = v->room + 16*n;
    REAL *x = v->room + 23*n, *x_new = x + n, *K = x_new + n; /* of a piece */
    EACH_LANE LANE(rtol, l) = b->rtol, LANE(atol, l) = b->atol, any |= accepted[l] && has_sample(b, v, l);
    if (!any)
        return;
    dop853_dense(f, n, t, h, v->x, v->y, y, v->room, F);
    REAL missed = dop853_missed(f, n, t, h, v->x, v->y, F, rtol, atol, y, x);
    EACH_LANE {
        pieces[l] = accepted[l] && has_sample(b, v, l) ? dop853_pieces(LANE(missed, l)) : 1;
        most = pieces[l] > most ? pieces[l] : most;
        LANE(h, l) /= (double)pieces[l];
    }
    give_between(b, v, accepted, pieces, 0, v->x, F, y);
    memcpy(x, v->x, n*sizeof *x);
    memcpy(K, v->room, n*sizeof *x);
    for (size_t j = 0; most > 1 && j < most; j++, t += h) {
        dop853_piece(f, n, t, h, x, x_new, y, K, F);
        give_between(b, v, accepted, pieces, j, x, F, y);
        memcpy(x, x_new, n*sizeof *x);
    }
}

/* whether stability alone holds the steps of a lane short, as `is_to_change` of march.c */
static int is_stiff(struct batch *b, const struct lanes *v, int l)
{
    static const double APART[12] = {DOP853_APART};
    double rates = 0, states = 0;
    for (size_t k = 0; k < b->n; k++) {
        double change = LANE(v->room[12*b->n + k], l) - LANE(v->room[11*b->n + k], l), moved = 0;
        for (size_t j = 0; j < 12; j++)
            moved += APART[j]*LANE(v->room[j*b->n + k], l);
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
            double t = LANE(*v.t, l), stop = lane_stop(b, l, t), least = shortest(t);
            b->h[l] = b->h[l] < least && !b->rejected[l] ? least : b->h[l];
            LANE(*v.h, l) = t + b->h[l] < stop ? b->h[l] : stop - t;
        }
        memcpy(v.room, v.f, n*sizeof *v.f);
        dop853_step(&f, n, *v.t, *v.h, v.x, v.y, v.room);
        REAL errors[2];
        dop853_errors(n, v.x, v.y, v.room, rtol, atol, errors);
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
            CALL(&f, *v.t + *v.h, v.y, v.room + 12*n);
        }
        EACH_LANE {
            if (b->is_over[l])
                continue;
            if (!accepted[l]) {
                if (!(b->h[l] >= shortest(LANE(*v.t, l)))) {
                    int finite = 1;
                    for (size_t k = 0; k < n; k++)
                        finite &= isfinite(LANE(v.f[k], l)) && isfinite(LANE(v.room[12*n + k], l));
                    ends(b, &v, l, finite ? TOO_SMALL : NOT_FINITE);
                }
                continue;
            }
            if (stiff[l]) {
                ends(b, &v, l, STIFF);
                continue;
            }
            for (size_t k = 0; k < n; k++)
                LANE(v.f[k], l) = LANE(v.room[12*n + k], l);
            moves_on(b, &v, l);
        }
    }
    return 1;
}
