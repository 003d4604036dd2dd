/* Phases of a motion, one after the other in one call: where one ends, what the contacts do from there on, the next one.

   It stands behind march.c, and goes the way of `passed` of motion.py, of phase_change.py, impacts.py and of
   event_location.py. A phase is known by the modes of its contacts; of which there are no functions yet is asked for. What is
   not decided here is left to who called: of a phase in which that happens nothing is given. */

typedef unsigned long long bits; /* one for each contact; a digit to the base MODES for each contact */

enum { MODES = 9, OPEN = 0, PLAIN = 1, STICKS = 3, SLIDES_ON = 5, SLIDES_BACK = 7 }; /* + 1 where N is negative */
enum { MOST_CONTACTS = 16, MOST_ENDED = 32, MOST_STRUCK = 4, MOST_EVENTS = 64, MINIMUM_STEPS = 60, ROOT_STEPS = 100 };
enum { RAN_OUT, LEFT, NEEDS_PHASE, NEEDS_SLIDES, IS_FULL, IS_TIRED, KNOWN };
enum { DECIDES, BEGINS, MARCHES }; /* the stage of a motion */
enum { MUST_PUSH, MUST_GROW, MUST_HOLD, MUST_STAY };
enum { ENDS, TURNS, CLOSES, STOPS, SLIPS };
enum { OF_FORCES, OF_RATES, OF_PLACES, OF_REBOUNDS };
enum { IS_MADE, IS_REFUSED, IS_UNDETERMINED, IS_OUTSIDE };

struct contact {
    int is_unilateral, has_law, is_dry, holds_both_ways, has_size, of_joint, rebounds, is_rough, rows; /* of_joint: 2: static */
};

/* what must not be negative: a signal with a sign; grip |N| - |hold| of first, second (-1: N is 1), third; -|first| */
struct test {
    int contact, kind, only_at_rest, sign, first, second, third;
};

struct bound {
    int contact, kind, unit;
};

struct known { /* functions that the parameters determine, and for which parameters they are */
    struct rate **functions;
    void (**constants)(const double *p, double *c);
    size_t n, generation;
};

struct phase {
    bits code;
    size_t is_refused;
    struct march *m;
    const int *places; /* of each state, among the values */
    struct rate more, judged; /* rates that are no states; signals, forces, accelerations */
    const int *more_places, *is_force;
    const struct test *tests;
    const struct bound *bounds; /* as many as the march has events */
    const int *gaps;            /* of each contact: where among the signals gap' stands, before gap''; -1 */
    size_t coordinates, n_more, n_signals, n_forces, n_accelerations, n_tests;
    struct known known;
};

struct slides { /* the sliding velocities where these contacts are apart */
    bits apart;
    size_t n, count;
    struct rate f;
    const int *places, *contacts;
    struct known known;
};

struct released { /* the model without contacts that can end */
    size_t n, coordinates, speeds, held, rows, endings;
    const int *places, *rate_places, *contacts, *first_rows, *rebounding;
    size_t n_rebounding;
    struct rate gaps, matrices, energy, rates, restitutions;
    struct known known;
};

struct done { /* a phase that is over */
    bits code;
    size_t steps, evaluations, rows, tracks, hit, approached, touching;
    long bound;
    double start, end, limit, loss;
};

struct machine {
    size_t n_contacts, n_values, n_phases, n_slides, any_dry, alone, rubs; /* alone: contacts that close at once are not decided here */
    const struct contact *contacts;
    struct phase **phases;
    struct slides **slides;
    struct released *released;
    const int *is_rate;
    const double *p;
    size_t generation;
    double end, t, limit, phase_t;
    double *values, *begun, *after, *x, *work, *impulses, *e; /* of impulses: of each contact, then of the held rows */
    size_t by_gauss; /* whether the way on of joints at rest was asked for */
    size_t stage, hasty, n_ended, most_steps, steps, evaluations, taken, events, passed, most_passed, is_logged;
    bits before, ended[MOST_ENDED], together, needed;
    long bound;
    struct phase *now;
    const double *instants, *stops;
    size_t n_instants, next, n_stops;
    double *sampled; /* n_instants x states */
    size_t hit, approached, touching;
    double loss, next_limit;
    struct done own; /* the phase that is over, or will be */
    double *last;    /* its last state */
    /* what is given: phases that are over, their numbers (begun, last state, impulses), rows and tracks (t, x) */
    struct done *done;
    double *numbers, *rows, *tracks;
    size_t n_done, most_done, n_rows, most_rows, n_tracks, most_tracks, rows_of_phase, tracks_of_phase; /* in numbers */
    /* many runs */
    double *out; /* samples x columns of a run */
    const int *columns; /* of each value; -1 */
    size_t n_columns;
    void (*told)(struct machine *); /* of each change of contacts; NULL */
    void *of_run;                   /* what who is told knows */
};

static int mode_of(bits code, size_t contact)
{
    while (contact--)
        code /= MODES;
    return (int)(code%MODES);
}

static int is_in(bits set, size_t contact) { return (int)(set >> contact & 1); }

static void know(const struct machine *k, struct known *known)
{
    if (known->generation == k->generation)
        return;
    for (size_t i = 0; i < known->n; i++) {
        known->functions[i]->p = k->p;
        known->constants[i](k->p, (double *)known->functions[i]->c);
    }
    known->generation = k->generation;
}

static void gather(size_t n, const int *places, const double *values, double *x)
{
    EACH x[k] = places[k] < 0 ? 0 : values[places[k]];
}

/* the values of a state: what has no value in this phase is 0 */
static void spread(const struct machine *k, const struct phase *phase, double t, const double *x, double *values)
{
    for (size_t i = 0; i < k->n_values; i++)
        values[i] = 0;
    for (size_t i = 0; i < phase->m->n; i++)
        values[phase->places[i]] = x[i];
    if (phase->n_more) {
        CALL(&phase->more, t, x, k->work);
        for (size_t i = 0; i < phase->n_more; i++)
            values[phase->more_places[i]] = k->work[i];
    }
}

static double largest_value(const struct machine *k, const double *values, int of_rates)
{
    double found = 1;
    for (size_t i = 0; i < k->n_values; i++)
        if (k->is_rate[i] == of_rates && fabs(values[i]) > found)
            found = fabs(values[i]);
    return found;
}

static double smallest_speed(const struct machine *k, const double *values) { return COMPUTED*largest_value(k, values, 1); }

static struct phase *phase_of(const struct machine *k, bits code)
{
    for (size_t i = 0; i < k->n_phases; i++)
        if (k->phases[i]->code == code)
            return k->phases[i];
    return NULL;
}

static int has_ended(const struct machine *k, bits code)
{
    for (size_t i = 0; i < k->n_ended; i++)
        if (k->ended[i] == code)
            return 1;
    return 0;
}

/* -- which contacts hold from here on, as `settled` --------------------------------------------------------------- */

/* the modes that position and velocity of a contact allow, as `_modes`; how many */
static size_t choices_of(const struct contact *c, int sense, int old, int is_apart, int *found)
{
    size_t n = 0, pushes = c->holds_both_ways ? 2 : 1;
    int first = c->holds_both_ways && old != OPEN && old%2 == 0; /* the push that there was, then the other */
    if (is_apart) {
        found[n++] = OPEN;
        return n;
    }
    if (!c->has_law) {
        found[n++] = PLAIN, found[n++] = OPEN;
        return n;
    }
    if (c->is_dry && !sense)
        found[n++] = STICKS;
    for (int way = c->is_dry && sense < 0; way <= (c->is_dry && sense <= 0); way++)
        for (size_t j = 0; j < pushes; j++)
            found[n++] = (!c->is_dry ? PLAIN : way ? SLIDES_BACK : SLIDES_ON) + (first ^ (int)j);
    if (c->is_unilateral)
        found[n++] = OPEN;
    return n;
}

static double with_sign(double x, int sign) { return sign < 0 ? -x : x; }

/* the largest force, and the largest acceleration, at least 1, of what a phase is judged by */
static void sizes_of(const struct phase *phase, const double *judged, double *force, double *acceleration)
{
    *force = 0, *acceleration = 1;
    for (size_t i = 0; i < phase->n_signals; i++)
        if (phase->is_force[i] && isfinite(judged[i]))
            *force = fmax(*force, fabs(judged[i]));
    judged += phase->n_signals;
    for (size_t i = 0; i < phase->n_forces; i++)
        *force = fmax(*force, fabs(judged[i]));
    judged += phase->n_forces;
    for (size_t i = 0; i < phase->n_accelerations; i++)
        *acceleration = fmax(*acceleration, fabs(judged[i]));
}

static double *judged_at(struct machine *k, struct phase *phase, double t, const double *values)
{
    know(k, &phase->known);
    gather(phase->m->n, phase->places, values, k->x);
    CALL(&phase->judged, t, k->x, k->work);
    return k->work;
}

/* whether forces and accelerations agree with a phase */
static int agrees(struct machine *k, struct phase *phase, double t, const double *values, const int *senses, bits apart)
{
    double force, acceleration, *s = judged_at(k, phase, t, values);
    sizes_of(phase, s, &force, &acceleration);
    for (size_t i = 0; i < phase->n_tests; i++) {
        const struct test *test = phase->tests + i;
        double left, size = acceleration;
        if (is_in(apart, (size_t)test->contact) || (test->only_at_rest && senses[test->contact]))
            continue;
        left = with_sign(s[test->first], test->sign);
        if (test->kind == MUST_PUSH)
            size = force;
        else if (test->kind == MUST_STAY)
            left = -fabs(left);
        else if (test->kind == MUST_HOLD) {
            size = force, left = s[test->first]*(test->second < 0 ? 1 : fabs(s[test->second])) - fabs(s[test->third]);
            if (!isfinite(s[test->third]))
                return 0;
        }
        if (left < -COMPUTED*size)
            return 0;
    }
    return 1;
}

/* the sense in which each contact slides, 0 where it does not */
static int sliding(struct machine *k, double t, const double *values, bits apart, int *senses)
{
    double still = smallest_speed(k, values);
    for (size_t i = 0; i < k->n_contacts; i++)
        senses[i] = 0;
    if (!k->any_dry)
        return KNOWN;
    for (size_t i = 0; i < k->n_slides; i++) {
        struct slides *s = k->slides[i];
        if (s->apart != apart)
            continue;
        know(k, &s->known);
        gather(s->n, s->places, values, k->x);
        CALL(&s->f, t, k->x, k->work);
        for (size_t j = 0; j < s->count; j++)
            senses[s->contacts[j]] = fabs(k->work[j]) <= still ? 0 : k->work[j] > 0 ? 1 : -1;
        return KNOWN;
    }
    k->needed = apart;
    return NEEDS_SLIDES;
}

static int settled(struct machine *k, double t, const double *values, bits apart, struct phase **found)
{
    int senses[MOST_CONTACTS], modes[MOST_CONTACTS][6], answer = sliding(k, t, values, apart, senses), skipped = 0, open = 0;
    size_t counts[MOST_CONTACTS], at[MOST_CONTACTS] = {0}, resting = 0, joints = 0, is_static = 0;
    struct phase *last = NULL, *other = NULL;
    int is_undetermined = 0, is_other = 0;
    if (answer != KNOWN)
        return answer;
    for (size_t i = 0; i < k->n_contacts; i++) {
        const struct contact *c = k->contacts + i;
        int rests = c->has_size && !senses[i];
        counts[i] = choices_of(c, senses[i], mode_of(k->before, i), is_in(apart, i), modes[i]);
        resting += (size_t)rests, joints += (size_t)(c->of_joint && !senses[i]);
        is_static |= (size_t)(c->of_joint > 1 && !senses[i]), open |= counts[i] > 1 && !rests;
    }
    if (joints > 1 && is_static) /* several ways may agree */
        return LEFT;
    for (size_t tried = 0; tried < MOST_TRIED; tried++) {
        bits code = 0;
        int closed = 0;
        for (size_t i = k->n_contacts; i-- > 0;) {
            code = code*MODES + (bits)modes[i][at[i]];
            closed |= modes[i][at[i]] != OPEN && is_in(k->together, i);
        }
        struct phase *phase = phase_of(k, code);
        if (!phase && resting < 2) {
            k->needed = code;
            return NEEDS_PHASE;
        }
        if (!phase)
            skipped = 1; /* of joints at rest one way alone agrees: it may be another */
        else if (phase->is_refused == IS_OUTSIDE)
            return LEFT;
        else if (phase->is_refused)
            is_undetermined |= phase->is_refused == IS_UNDETERMINED;
        else if (agrees(k, phase, t, values, senses, apart)) {
            if (is_undetermined || (skipped && open))
                return LEFT;
            int returns = has_ended(k, code);
            if (!returns && !closed) {
                *found = phase;
                return KNOWN;
            }
            last = last ? last : phase;
            if (!is_other && !returns)
                other = phase, is_other = 1;
        }
        size_t i = k->n_contacts;
        while (i-- > 0 && ++at[i] == counts[i])
            at[i] = 0;
        if (i + 1 == 0)
            break;
    }
    *found = other ? other : last;
    if (!*found && skipped && !open && !k->by_gauss) { /* by Gauss's principle it is made */
        k->by_gauss = 1, k->needed = 0;
        for (size_t i = k->n_contacts; i-- > 0;)
            k->needed = k->needed*MODES + (bits)modes[i][0];
        return NEEDS_PHASE;
    }
    return *found && !skipped ? KNOWN : LEFT;
}

/* -- impacts, as `WithoutContacts` ---------------------------------------------------------------------------------- */

static double product(size_t n, const double *a, const double *b)
{
    double sum = 0;
    EACH sum += a[k]*b[k];
    return sum;
}

/* z >= 0, w = G z + q >= 0, z w = 0 of few rows: the first set of pushing contacts with which all that holds; 0: there is
   none, or impulses may have no single value */
static int complementary(size_t n, const double *G, const double *q, double *z)
{
    double A[MOST_STRUCK*MOST_STRUCK], size = 1;
    int pivots[MOST_STRUCK];
    EACH size = fmax(size, fabs(q[k]));
    for (size_t set = 0; set < (size_t)1 << n; set++) {
        size_t chosen[MOST_STRUCK], m = 0;
        double right[MOST_STRUCK];
        EACH if (set >> k & 1) chosen[m++] = k;
        for (size_t i = 0; i < m; i++) {
            right[i] = -q[chosen[i]];
            for (size_t j = 0; j < m; j++)
                A[i*m + j] = G[chosen[i]*n + chosen[j]];
        }
        if (m && !factored(m, A, pivots, REGULAR_PIVOT))
            return 0;
        if (m)
            back(m, A, pivots, 1, right);
        int is_right = 1;
        EACH z[k] = 0;
        for (size_t i = 0; i < m; i++)
            z[chosen[i]] = right[i], is_right &= right[i] >= 0;
        int is_single = 1;
        for (size_t i = 0; i < n; i++) {
            double w = q[i] + product(n, G + i*n, z);
            is_right &= (set >> i & 1) || w >= -COMPUTED*size;
            is_single &= n < 2 || (set >> i & 1) || w > COMPUTED*size;
        }
        if (is_right)
            return is_single;
    }
    return 0;
}

/* the values after the impact of what touches; `resting` holds from here on */
static int struck(struct machine *k, double t, double *values, bits touching, bits resting)
{
    struct released *r = k->released;
    size_t u = r->speeds, width = u + 1, pushing[MOST_STRUCK], n = 0, h = 0, kept[MOST_CONTACTS];
    double *x = k->x, *M = k->work, *rows = M + u*u, *A = rows + (r->held + r->rows)*width, size = COMPUTED, lost[2];
    if (k->rubs)
        return LEFT;
    for (size_t i = 0; i < r->endings; i++) {
        const struct contact *c = k->contacts + r->contacts[i];
        if (!is_in(touching, (size_t)r->contacts[i]))
            continue;
        if (c->rows != 1 || (c->is_rough && !is_in(resting, (size_t)r->contacts[i])))
            return LEFT;
        if (is_in(resting, (size_t)r->contacts[i]))
            kept[h++] = i;
        else if (n < MOST_STRUCK)
            pushing[n++] = i;
        else
            return LEFT;
    }
    if (k->alone && n > 1)
        return LEFT;
    gather(r->n, r->places, values, x);
    CALL(&r->matrices, t, x, M);
    CALL(&r->energy, t, x, lost);
    double *speeds = x + r->coordinates, G[MOST_STRUCK*MOST_STRUCK], q[MOST_STRUCK], z[MOST_STRUCK];
    for (size_t i = 0; i < u; i++)
        size = fmax(size, COMPUTED*fabs(speeds[i]));
    size_t of_rows = r->held + h, whole = u + of_rows, columns = 1 + n;
    double *right = A + whole*whole, *own;
    int *pivots = (int *)(right + whole*columns);
    for (size_t i = 0; i < whole*whole + whole*columns; i++)
        A[i] = 0;
    for (size_t i = 0; i < u; i++) {
        for (size_t j = 0; j < u; j++)
            A[i*whole + j] = M[i*u + j];
        right[i*columns] = product(u, M + i*u, speeds);
    }
    for (size_t i = 0; i < of_rows; i++) {
        own = rows + (i < r->held ? i : r->held + (size_t)r->first_rows[kept[i - r->held]])*width;
        for (size_t j = 0; j < u; j++)
            A[j*whole + u + i] = -own[j], A[(u + i)*whole + j] = own[j];
        right[(u + i)*columns] = -own[u];
    }
    k->approached = 0, k->touching = touching;
    for (size_t i = 0; i < n + h; i++) {
        size_t ending = i < n ? pushing[i] : kept[i - n];
        own = rows + (r->held + (size_t)r->first_rows[ending])*width;
        if (product(u, own, speeds) + own[u] < -size)
            k->approached |= (size_t)1 << r->contacts[ending];
        for (size_t j = 0; i < n && j < u; j++)
            right[j*columns + 1 + i] = own[j];
    }
    if (!factored(whole, A, pivots, REGULAR_PIVOT))
        return LEFT;
    back(whole, A, pivots, columns, right);
    for (size_t i = 0; i < n; i++) {
        own = rows + (r->held + (size_t)r->first_rows[pushing[i]])*width;
        double v = product(u, own, speeds) + own[u];
        q[i] = own[u] + k->e[r->contacts[pushing[i]]]*fmin(v, 0);
        for (size_t j = 0; j < columns; j++) {
            double sum = 0;
            for (size_t l = 0; l < u; l++)
                sum += own[l]*right[l*columns + j];
            if (j)
                G[i*n + j - 1] = sum;
            else
                q[i] += sum;
        }
    }
    if (!complementary(n, G, q, z))
        return LEFT;
    for (size_t i = 0; i < whole; i++) {
        double found = right[i*columns];
        for (size_t j = 0; j < n; j++)
            found += right[i*columns + 1 + j]*z[j];
        right[i*columns] = found;
    }
    for (size_t i = 0; i < k->n_contacts + r->held; i++)
        k->impulses[i] = 0;
    for (size_t i = 0; i < n; i++)
        k->impulses[r->contacts[pushing[i]]] = z[i];
    for (size_t i = 0; i < of_rows; i++)
        k->impulses[i < r->held ? k->n_contacts + i : (size_t)r->contacts[kept[i - r->held]]] = right[(u + i)*columns];
    for (size_t i = 0; i < u; i++) {
        if (!isfinite(right[i*columns]))
            return LEFT;
        speeds[i] = right[i*columns];
    }
    CALL(&r->energy, t, x, lost + 1);
    k->loss = lost[0] - lost[1];
    CALL(&r->rates, t, x, k->work);
    for (size_t i = 0; i < r->coordinates; i++)
        values[r->rate_places[i]] = k->work[i];
    for (size_t i = 0; i < u; i++)
        values[r->places[r->coordinates + i]] = speeds[i];
    return KNOWN;
}

/* the values after an impact, where there is one, and which contacts are apart */
static int met(struct machine *k, double t, double *values, bits resting, bits *apart)
{
    struct released *r = k->released;
    bits touching = 0;
    int any_open = 0, approached = 0, answer;
    k->hit = 0, *apart = 0;
    for (size_t i = 0; i < k->n_contacts; i++)
        any_open |= mode_of(k->before, i) == OPEN;
    if (!any_open)
        return KNOWN;
    double length = 1e2*COMPUTED*largest_value(k, values, 0), low = LOWEST_FLIGHT*largest_value(k, values, 0);
    double still = smallest_speed(k, values), *found = k->work;
    gather(r->n, r->places, values, k->x);
    CALL(&r->gaps, t, k->x, found);
    for (size_t i = 0; i < r->endings; i++) {
        size_t c = (size_t)r->contacts[i];
        int was_open = mode_of(k->before, c) == OPEN;
        if (!was_open || found[2*i] <= (k->contacts[c].rebounds ? low : length)) {
            touching |= (bits)1 << c;
            approached |= was_open && found[2*i + 1] < -still;
        }
    }
    if (approached) {
        answer = struck(k, t, values, touching, resting);
        if (answer != KNOWN)
            return answer;
        k->hit = 1, still = smallest_speed(k, values);
        gather(r->n, r->places, values, k->x);
        CALL(&r->gaps, t, k->x, found);
    }
    for (size_t i = 0; i < r->endings; i++)
        if (!is_in(touching, (size_t)r->contacts[i]) || found[2*i + 1] > still)
            *apart |= (bits)1 << r->contacts[i];
    return KNOWN;
}

/* what leaves an impact lower than can be told from rounding, as `_lowest_flights`; how long all flights would last */
static bits lowest_flights(struct machine *k, struct phase *phase, bits resting, double *lasting)
{
    bits found = 0;
    struct released *r = k->released;
    double scale = largest_value(k, k->after, 0), *s = NULL;
    for (size_t i = 0; k->hit && i < r->endings; i++) {
        size_t c = (size_t)r->contacts[i];
        if (!is_in(k->touching, c))
            continue;
        if (is_in(resting, c) || mode_of(phase->code, c) != OPEN || phase->gaps[c] < 0)
            continue;
        s = s ? s : judged_at(k, phase, k->t, k->after);
        double v = s[phase->gaps[c]], g = s[phase->gaps[c] + 1], e = k->e[c];
        if (!(v > 0 && 0 > g && v*v <= -2*g*(e != 0 ? LOWEST_FLIGHT : LOW)*scale))
            continue;
        found |= (bits)1 << c;
        if (is_in(k->approached, c) && 0 < e && e < 1)
            *lasting = fmax(*lasting, 2*v/(-g*(1 - e)));
    }
    return found;
}

/* the phase that follows from `values` on, and the values after an impact, as `_decided` */
static int decided(struct machine *k)
{
    bits resting = 0, apart, low;
    struct phase *found;
    k->next_limit = 0;
    know(k, &k->released->known);
    if (k->released->n_rebounding) {
        CALL(&k->released->restitutions, 0, k->values, k->work);
        for (size_t i = 0; i < k->released->n_rebounding; i++) {
            k->e[k->released->rebounding[i]] = k->work[i];
            if (!(k->work[i] >= 0 && k->work[i] <= 1))
                return LEFT;
        }
    }
    for (;;) {
        memcpy(k->after, k->values, k->n_values*sizeof *k->after);
        int answer = met(k, k->t, k->after, resting, &apart);
        if (answer == KNOWN)
            answer = settled(k, k->t, k->after, apart, &found);
        if (answer != KNOWN)
            return answer;
        low = lowest_flights(k, found, resting, &k->next_limit);
        if (!low)
            break;
        resting |= low;
    }
    k->now = found;
    return KNOWN;
}

/* -- the instant at which a phase ends, as `EventSearch` ---------------------------------------------------------- */

struct sought { /* an event function in the last step, less a level */
    struct march *m;
    size_t j;
    double level;
};

static double seen(const struct sought *of, double t)
{
    double *g = of->m->looks + LOOKS*of->m->n_events;
    march_look(of->m, 1, &t, g);
    return g[of->j] - of->level;
}

/* Brent's method, as scipy's brentq; Brent, Algorithms for Minimization Without Derivatives (1973), ch. 4 */
static double brent(const struct sought *of, double a, double b, double xtol)
{
    double fa = seen(of, a), fb = seen(of, b), previous = a, f_previous = fa, before = 0, now = 0;
    for (int i = 0; i < ROOT_STEPS; i++) {
        if (fa != 0 && fb != 0 && (fa < 0) != (fb < 0))
            previous = a, f_previous = fa, before = now = b - a;
        if (fabs(f_previous) < fabs(fb))
            a = b, b = previous, previous = a, fa = fb, fb = f_previous, f_previous = fa;
        double least = (xtol + 4*DBL_EPSILON*fabs(b))/2, half = (previous - b)/2;
        if (fb == 0 || fabs(half) < least)
            break;
        if (fabs(before) > least && fabs(fb) < fabs(fa)) {
            double step;
            if (a == previous)
                step = -fb*(b - a)/(fb - fa);
            else {
                double one = (fa - fb)/(a - b), other = (f_previous - fb)/(previous - b);
                step = -fb*(f_previous*other - fa*one)/(other*one*(f_previous - fa));
            }
            if (2*fabs(step) < fmin(fabs(before), 3*fabs(half) - least))
                before = now, now = step;
            else
                before = half, now = half;
        } else
            before = half, now = half;
        a = b, fa = fb;
        b += fabs(now) > least ? now : half > 0 ? least : -least;
        fb = seen(of, b);
    }
    return b;
}

/* where a function that falls is no longer above 0 between two instants, as `_root` */
static double fallen(const struct sought *of, double before, double after)
{
    if (!(seen(of, before) > 0))
        return before;
    if (!(seen(of, after) < 0))
        return after;
    double xtol = SAME_INSTANT*(after - before), root = brent(of, before, after, xtol), step;
    for (step = xtol + 4*DBL_EPSILON*fabs(root); root < after && seen(of, root) > 0; step *= 2)
        root = fmin(after, root + step);
    return root;
}

/* the least value between two instants, by golden sections */
static double lowest(const struct sought *of, double a, double b, double *at)
{
    double part = 0.61803398874989485, x = b - part*(b - a), y = a + part*(b - a), f = seen(of, x), g = seen(of, y);
    for (int i = 0; i < MINIMUM_STEPS && b - a > TOUCHES*(fabs(a) + fabs(b)); i++)
        if (f < g)
            b = y, y = x, g = f, x = b - part*(b - a), f = seen(of, x);
        else
            a = x, x = y, f = g, y = a + part*(b - a), g = seen(of, y);
    *at = f < g ? x : y;
    return fmin(f, g);
}

/* the first instant of the last step at which function j has come down, as `_first`; INFINITY: none; NaN: it dips, and is to
   be looked for as exactly as Python does */
static double first_fall(struct march *m, size_t j, const double *times, int *armed, double *largest, int exactly)
{
    size_t n = m->n_events;
    double floor = m->floors[j], at;
    struct sought of = {m, j, 0};
    for (size_t i = 0; i < LOOKS; i++)
        *largest = fmax(*largest, fabs(m->looks[i*n + j]));
    *armed = m->armed[j] || m->looks[j] > floor;
    for (size_t i = 1; i < LOOKS; i++) {
        const double *g = m->looks + (i < 2 ? 0 : i - 2)*n + j, here = m->looks[i*n + j];
        if (!*armed && here < -floor) {
            of.level = -floor;
            return fallen(&of, times[i - 1], times[i]);
        }
        if (!*armed) {
            *armed = here > floor;
            continue;
        }
        if (i > 1 && g[0] > 0 && g[n] > 0 && here > 0 && g[n] <= g[0] && g[n] <= here) {
            double before = times[i - 1] - times[i - 2], after = times[i] - times[i - 1];
            double down = (g[n] - g[0])/before, up = (here - g[n])/after;
            double curvature = (up - down)/(before + after), slope = (down*after + up*before)/(before + after);
            int dips = curvature > 0 && g[n] - slope*slope/(4*curvature) <= 0.5*g[n];
            if (dips && exactly)
                return NAN;
            if (dips && lowest(&of, times[i - 2], times[i], &at) < 0)
                return fallen(&of, times[i - 2], at);
        }
        if (here <= 0)
            return fallen(&of, times[i - 1], times[i]);
    }
    return INFINITY;
}

/* the event of the last step; -1: there is none, and what is known of the functions is kept; -2: it is not decided */
static long event_in(struct march *m, double *instant, int exactly)
{
    double times[LOOKS];
    int armed[MOST_EVENTS];
    double largest[MOST_EVENTS];
    long found = -1;
    *instant = INFINITY;
    look_times(m, times); /* `is_calm` has looked */
    for (size_t j = 0; j < m->n_events; j++) {
        largest[j] = m->largest[j];
        double at = first_fall(m, j, times, armed + j, largest + j, exactly);
        if (isnan(at))
            return -2;
        if (at < *instant)
            *instant = at, found = (long)j;
    }
    for (size_t j = 0; found < 0 && j < m->n_events; j++)
        m->armed[j] = armed[j], m->largest[j] = largest[j];
    return found;
}

/* -- one phase ------------------------------------------------------------------------------------------------------ */

/* rounding errors of the bounds at a state, as `floors` */
static void floors_at(struct machine *k, struct phase *phase, double t, const double *x, double *floors)
{
    double force, acceleration, places = 1, rates = 1;
    const struct march *m = phase->m;
    for (size_t i = 0; i < m->n; i++)
        if (i < phase->coordinates)
            places = fmax(places, fabs(x[i]));
        else
            rates = fmax(rates, fabs(x[i]));
    CALL(&phase->judged, t, x, k->work);
    sizes_of(phase, k->work, &force, &acceleration);
    for (size_t j = 0; j < m->n_events; j++) {
        int unit = phase->bounds[j].unit;
        double size = unit == OF_FORCES ? COMPUTED*force : unit == OF_RATES ? COMPUTED*rates : COMPUTED*places;
        floors[j] = (unit == OF_REBOUNDS ? GAP_CLOSED*places : size) + SUMMED;
    }
}

static void log_row(struct machine *k, double t, const double *x)
{
    size_t n = k->now->m->n;
    double *row = k->rows + k->n_rows;
    if (!k->is_logged)
        return;
    row[0] = t;
    memcpy(row + 1, x, n*sizeof *row);
    k->n_rows += n + 1, k->rows_of_phase++;
}

static void log_track(struct machine *k, double t, const double *x)
{
    size_t n = k->now->m->n;
    double *row = k->tracks + k->n_tracks;
    if (!k->is_logged)
        return;
    row[0] = t;
    memcpy(row + 1, x, n*sizeof *row);
    k->n_tracks += n + 1, k->tracks_of_phase++;
}

static void give_row(struct machine *k, size_t instant, const double *x)
{
    struct phase *phase = k->now;
    double *row = k->out + instant*k->n_columns;
    for (size_t i = 0; i < k->n_columns; i++)
        row[i] = 0;
    for (size_t i = 0; i < phase->m->n; i++)
        if (k->columns[phase->places[i]] >= 0)
            row[k->columns[phase->places[i]]] = x[i];
}

/* the states at the instants that the march has passed */
static void take_rows(struct machine *k)
{
    struct march *m = k->now->m;
    for (size_t i = 0; i < m->next; i++, k->next++)
        if (k->is_logged)
            log_row(k, m->instants[i], m->rows + i*m->n);
        else
            give_row(k, k->next, m->rows + i*m->n);
    m->instants += m->next, m->n_instants -= m->next, m->next = 0;
}

static void take_tracks(struct machine *k)
{
    struct march *m = k->now->m;
    for (size_t i = 0; k->is_logged && i < m->tracked; i++)
        log_track(k, m->track_t[i], m->track_x + i*m->n);
}

static int begun_phase(struct machine *k)
{
    struct phase *phase = k->now;
    struct march *m = phase->m;
    size_t n = m->n;
    if (phase->is_refused)
        return LEFT;
    know(k, &phase->known);
    gather(n, phase->places, k->values, m->x);
    EACH if (!(fabs(m->x[k]) < COARSE)) return LEFT;
    m->t = m->t_old = k->t, m->stops = k->stops, m->n_stops = k->n_stops;
    m->end = k->limit > 0 && k->t + k->limit < k->end ? k->t + k->limit : k->end;
    if (!(m->end > m->t))
        return LEFT;
    m->next = m->tracked = m->is_dense = m->dense_of = m->has_series = m->n_slopes = 0;
    m->is_implicit = m->stiff_seen = m->easy_seen = m->implicit_steps = m->evaluations = 0, m->most_seen = SEEN;
    if (m->n_events)
        floors_at(k, phase, m->t, m->x, (double *)m->floors);
    if (held(m, m->t, m->x, m->atol) == STAYS_OPEN)
        return LEFT;
    memcpy(m->x_old, m->x, n*sizeof *m->x);
    march_begin(m);
    EACH if (!isfinite(m->f[k])) return LEFT;
    if (m->n_events)
        CALL(&m->events, m->t, m->x, m->looks);
    for (size_t j = 0; j < m->n_events; j++)
        m->signs[j] = 1, m->armed[j] = m->looks[j] > m->floors[j], m->largest[j] = fabs(m->looks[j]);
    if (m->is_near_watched) {
        int grew = 0;
        for (size_t i = 0; i < m->n_rows; i++)
            m->lengths[i] = 0;
        for (size_t i = 0; i <= m->n_determinants; i++)
            m->sizes[i] = 0;
        m->before = nearness(m, m->t, m->x, &grew);
        m->is_armed = m->before > ARMED*m->near;
        if (!m->is_armed)
            return LEFT;
    }
    k->phase_t = k->t, k->steps = k->evaluations = k->rows_of_phase = k->tracks_of_phase = 0;
    memcpy(k->begun, k->values, k->n_values*sizeof *k->begun);
    if (!k->is_logged && k->next && k->instants[k->next - 1] == k->t)
        give_row(k, k->next - 1, m->x);
    log_row(k, m->t, m->x);
    log_track(k, m->t, m->x);
    while (k->next < k->n_instants && k->instants[k->next] <= k->t) {
        if (!k->is_logged)
            give_row(k, k->next, m->x);
        k->next++;
    }
    m->instants = k->instants + k->next, m->n_instants = k->n_instants - k->next, m->rows = k->sampled;
    k->stage = MARCHES;
    return KNOWN;
}

/* the contacts that end together with one, as `_ending_together` */
static bits ending_together(struct machine *k, size_t bound, double t, double *x)
{
    struct phase *phase = k->now;
    struct march *m = phase->m;
    size_t n = m->n, count = 0, several = 0;
    double now[MOST_EVENTS], later[MOST_EVENTS], floors[MOST_EVENTS], *beside = m->room + 2*n;
    bits found = 0;
    for (size_t j = 0; j < m->n_events; j++)
        count += phase->bounds[j].kind == ENDS;
    if (phase->bounds[bound].kind != ENDS || count < 2)
        return 0;
    floors_at(k, phase, t, x, floors);
    CALL(&m->events, t, x, now);
    CALL(&m->rate, t, x, beside);
    EACH beside[k] = x[k] + SOON*beside[k];
    CALL(&m->events, t + SOON, beside, later);
    for (size_t j = 0; j < m->n_events; j++)
        if (phase->bounds[j].kind == ENDS && now[j] <= floors[j] && SHARE*(now[bound] - later[bound]) > 0
            && now[j] - later[j] > SHARE*(now[bound] - later[bound]))
            found |= (bits)1 << phase->bounds[j].contact, several++;
    return several > 1 ? found : 0;
}

/* a phase ends in a state: that is given as soon as it is known what follows */
static void remembered(struct machine *k, double t, const double *x, long bound)
{
    struct done own = {k->now->code, k->steps, k->now->m->evaluations, k->rows_of_phase, k->tracks_of_phase, 0, 0, 0,
                       bound, k->phase_t, t, 0, 0};
    k->own = own;
    memcpy(k->last, x, k->now->m->n*sizeof *x);
}

/* the event of a phase: the state there, and the rows before it */
static int ended_by(struct machine *k, long bound, double t)
{
    struct phase *phase = k->now;
    struct march *m = phase->m;
    size_t n = m->n;
    double *x = m->room + n;
    for (; m->n_instants && m->instants[0] <= t; m->instants++, m->n_instants--, k->next++) {
        between(m, m->instants[0], x);
        if (held(m, m->instants[0], x, m->atol) == STAYS_OPEN)
            return LEFT;
        if (!k->is_logged)
            give_row(k, k->next, x);
        else if (m->instants[0] < t)
            log_row(k, m->instants[0], x);
    }
    between(m, t, x);
    if (held(m, t, x, m->atol) == STAYS_OPEN)
        return LEFT;
    log_row(k, t, x);
    log_track(k, t, x);
    remembered(k, t, x, bound);
    k->t = t, k->bound = bound, k->before = phase->code;
    k->together = ending_together(k, (size_t)bound, t, x);
    if (t - k->phase_t > COMPUTED)
        k->n_ended = k->hasty = 0;
    else
        k->hasty++;
    if (k->n_ended == MOST_ENDED || k->hasty == MOST_AT_INSTANT || k->passed++ == k->most_passed)
        return LEFT;
    k->ended[k->n_ended++] = phase->code;
    spread(k, phase, t, x, k->values);
    k->stage = DECIDES, k->by_gauss = 0;
    return KNOWN;
}

/* where the next phase begins, or the motion ends */
static void goes_on(struct machine *k)
{
    size_t impulses = k->n_contacts + k->released->held, n = k->n_values;
    double *numbers = k->numbers + k->n_done*(2*n + impulses);
    k->events++;
    if (!k->is_logged)
        return;
    struct done *done = k->done + k->n_done++;
    *done = k->own;
    done->hit = k->hit, done->approached = k->approached, done->touching = k->touching;
    done->limit = k->next_limit, done->loss = k->loss;
    memcpy(numbers, k->begun, n*sizeof *numbers);
    memcpy(numbers + n, k->last, n*sizeof *numbers);
    memcpy(numbers + 2*n, k->impulses, impulses*sizeof *numbers);
}

static int marches(struct machine *k)
{
    struct phase *phase = k->now;
    struct march *m = phase->m;
    size_t n = m->n, most = MOST_AT_ONCE < k->most_steps - k->steps ? MOST_AT_ONCE : k->most_steps - k->steps;
    double instant;
    if (k->steps >= k->most_steps)
        return LEFT;
    if (k->is_logged && (k->n_tracks + (MOST_AT_ONCE + 3)*(n + 1) > k->most_tracks
                         || k->n_rows + (m->n_instants + 3)*(n + 1) > k->most_rows))
        return IS_FULL;
    int found = march(m, &most);
    k->steps += most, k->taken += most;
    take_tracks(k);
    take_rows(k);
    if (found == TOO_SMALL || found == STIFF)
        return LEFT;
    if (found == LOOK) {
        if (m->is_blind)
            return LEFT;
        long bound = m->n_events ? event_in(m, &instant, (int)k->is_logged) : -1;
        if (bound == -2 || (m->is_near_watched && !is_far(m)))
            return LEFT;
        if (bound >= 0)
            return ended_by(k, bound, instant);
        m->tracked = 0;
        found = done_with(m);
        take_tracks(k);
        take_rows(k);
        if (found == LOOK || found == STIFF)
            return LEFT;
    }
    if (found != REACHED)
        return KNOWN;
    if (m->end >= k->end && !(k->limit > 0 && k->phase_t + k->limit < k->end)) {
        remembered(k, m->t, m->x, -1);
        k->hit = 0, k->next_limit = 0;
        goes_on(k);
        k->t = m->t;
        return RAN_OUT;
    }
    remembered(k, m->t, m->x, -1);
    k->t = m->t, k->hit = 0, k->limit = k->next_limit = 0;
    spread(k, phase, m->t, m->x, k->values);
    goes_on(k);
    k->stage = BEGINS;
    return KNOWN;
}

/* The phases from where it stands, for about so many steps: RAN_OUT at the end, LEFT where a phase is to be made by others;
   what is needed; IS_FULL, IS_TIRED: it goes on after what is given was taken, or somebody has looked whether it should. */
int machine_run(struct machine *k, size_t budget)
{
    k->taken = 0;
    for (;;) {
        int answer = KNOWN;
        if (k->stage == DECIDES) {
            if (k->is_logged && k->n_done + 1 >= k->most_done)
                return IS_FULL;
            answer = decided(k);
            if (answer == KNOWN) {
                memcpy(k->values, k->after, k->n_values*sizeof *k->values);
                k->limit = k->next_limit;
                goes_on(k);
                k->stage = BEGINS;
                if (k->told)
                    k->told(k);
            }
        } else if (k->stage == BEGINS)
            answer = begun_phase(k);
        else
            answer = marches(k);
        if (answer != KNOWN)
            return answer;
        if (k->taken + 4*k->events > budget) {
            k->events = 0;
            return IS_TIRED;
        }
    }
}

/* -- many runs ------------------------------------------------------------------------------------------------------ */

struct many { /* one after the other, each from its own values and with its own parameters */
    size_t next, last, is_begun, parameters;
    double start;
    bits before; /* of the contacts, at the start */
    const double *values, *p; /* runs x values, runs x parameters */
    double *x;                /* runs x instants x columns */
    int *is_done;             /* whether a run came to its end without a question */
    size_t *steps;
};

/* Runs from `next` on, for about so many steps: RAN_OUT after the last of them, else as `machine_run` */
int machine_runs(struct machine *k, struct many *r, size_t budget)
{
    k->taken = k->events = 0;
    while (r->next < r->last) {
        if (!r->is_begun) {
            memcpy(k->values, r->values + r->next*k->n_values, k->n_values*sizeof *k->values);
            k->p = r->p + r->next*r->parameters, k->generation++, k->t = r->start, k->limit = 0, k->before = r->before;
            k->out = r->x + r->next*k->n_instants*k->n_columns;
            k->by_gauss = k->next = k->n_ended = k->hasty = k->passed = k->together = 0, k->stage = DECIDES, r->steps[r->next] = 0;
            r->is_begun = 1;
        }
        size_t before = k->taken;
        int answer = machine_run(k, budget);
        r->steps[r->next] += k->taken;
        k->taken += before;
        if (answer == NEEDS_PHASE || answer == NEEDS_SLIDES || answer == IS_TIRED)
            return answer;
        r->is_done[r->next++] = answer == RAN_OUT, r->is_begun = 0;
        if (k->taken > budget)
            return r->next < r->last ? IS_TIRED : RAN_OUT;
    }
    return RAN_OUT;
}
