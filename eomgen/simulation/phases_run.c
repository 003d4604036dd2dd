/* ---- a motion whose contacts change: nothing is allocated, all that it knows stands in the run ---- */

struct own { /* what a NAME_run holds */
    struct machine k;
    struct released released;
    struct rate begun; /* the rates of all coordinates at the start */
    struct known known;
    struct march marches[NAME_PHASES];
    struct phase phases[NAME_PHASES], *list[NAME_PHASES];
    struct slides slides[NAME_SLIDES + 1], *slid[NAME_SLIDES + 1];
    struct rate *functions[NAME_FUNCTIONS];
    NAME_event *events;
    size_t most_events, n_events;
    double constants[NAME_CONSTANTS + 1], values[4*NAME_WIDTH], gathered[2*NAME_WIDTH], impulses[NAME_CONTACTS + NAME_HELD];
    double e[NAME_CONTACTS], x[3*NAME_WIDTH], K[16*NAME_WIDTH], F[7*NAME_WIDTH], room[3*NAME_WIDTH];
    double track_t[MOST_AT_ONCE], track_x[MOST_AT_ONCE*NAME_WIDTH], piece[8*DOP853_PIECES*NAME_WIDTH];
    double along[18*NAME_WIDTH], floors[3*MOST_EVENTS], looks[(LOOKS + 1)*MOST_EVENTS], lengths[NAME_ROWS + 1];
    double sizes[NAME_ROWS + 1], march_work[NAME_MARCH_WORK], work[NAME_WORK];
    int armed[2*MOST_EVENTS], pivots[NAME_PIVOTS];
};

typedef char NAME_fits[sizeof(struct own) <= 8*NAME_MEMORY ? 1 : -1];

static void NAME_set(struct own *o);

/* a function of the run, with a place for what the parameters determine */
static void NAME_function(struct own *o, size_t number, struct rate *at,
                          void (*f)(double, const double *, const double *, const double *, const double *, double *),
                          size_t constants)
{
    struct rate found = {f, o->k.p, o->constants + constants, NULL};
    *at = found, o->functions[number] = at;
}

/* the arrays of all marches: one of them is on its way at a time */
static void NAME_share(struct own *o, double rtol, double atol)
{
    for (size_t i = 0; i < NAME_PHASES; i++) {
        struct march *m = o->marches + i;
        m->rtol = rtol, m->atol = atol, m->x = o->x, m->x_old = o->x + NAME_WIDTH, m->f = o->x + 2*NAME_WIDTH;
        m->K = o->K, m->F = o->F, m->room = o->room, m->track_t = o->track_t, m->track_x = o->track_x;
        m->piece = o->piece, m->along_pieces = o->along, m->floors = o->floors, m->signs = o->floors + MOST_EVENTS;
        m->largest = o->floors + 2*MOST_EVENTS, m->looks = o->looks, m->armed = o->armed;
        m->either = o->armed + MOST_EVENTS, m->lengths = o->lengths, m->sizes = o->sizes;
        m->work = o->march_work, m->pivots = o->pivots, m->most_seen = SEEN;
        o->list[i] = o->phases + i;
    }
    for (size_t i = 0; i + 1 < NAME_SLIDES + 1; i++)
        o->slid[i] = o->slides + i;
}

static void NAME_told(struct machine *k)
{
    struct own *o = k->of_run;
    if (o->n_events < o->most_events) {
        NAME_event *event = o->events + o->n_events;
        event->t = k->t, event->before = k->before, event->after = k->now->code, event->is_impact = (int)k->hit;
        event->loss = k->hit ? k->loss : 0;
        for (size_t i = 0; i < NAME_CONTACTS; i++)
            event->impulses[i] = k->hit ? k->impulses[i] : 0;
    }
    o->n_events++;
}

int NAME_motion(NAME_run *run, double t, const double *x, const double *p, double rtol, double atol, size_t n,
                const double *instants, double *rows, NAME_event *events, size_t most_events, size_t *n_events)
{
    struct own *o = (void *)run->memory.room;
    struct machine *k = &o->k;
    double length, still;
    int answer;
    memset(o, 0, sizeof *o);
    k->p = p, k->generation = 1, k->n_contacts = NAME_CONTACTS, k->n_values = NAME_WIDTH;
    k->values = o->values, k->begun = o->values + NAME_WIDTH, k->after = o->values + 2*NAME_WIDTH;
    k->last = o->values + 3*NAME_WIDTH, k->x = o->gathered, k->work = o->work, k->impulses = o->impulses, k->e = o->e;
    k->released = &o->released, k->phases = o->list, k->slides = o->slid;
    k->n_phases = NAME_PHASES, k->n_slides = NAME_SLIDES, k->sampled = rows + n*NAME_STATES; /* beyond the rows */
    k->told = NAME_told, k->of_run = o, o->events = events, o->most_events = most_events;
    NAME_share(o, rtol, atol);
    NAME_set(o);
    for (size_t i = 0; i < NAME_STATES; i++)
        k->values[NAME_columns_of[i]] = x[i];
    k->columns = NAME_columns, k->n_columns = NAME_STATES;
    k->t = t, k->end = n ? instants[n - 1] : t, k->instants = instants, k->n_instants = n, k->out = rows;
    k->most_steps = (size_t)-1 >> 1, k->most_passed = (size_t)-1 >> 1;
    know(k, &o->known);
    CALL(&o->begun, t, x, k->work);
    for (size_t i = 0; i < NAME_COORDINATES; i++)
        k->values[NAME_rates_of[i]] = k->work[i];
    know(k, &o->released.known);
    gather(o->released.n, o->released.places, k->values, k->x);
    CALL(&o->released.gaps, t, k->x, k->work);
    length = 1e2*COMPUTED*largest_value(k, k->values, 0), still = smallest_speed(k, k->values);
    k->before = NAME_CLOSED;
    for (size_t i = 0; i < o->released.endings; i++) {
        double gap = k->work[2*i], rate = k->work[2*i + 1];
        bits digit = 1;
        for (int j = 0; j < o->released.contacts[i]; j++)
            digit *= MODES;
        if (gap < -length)
            return 0;
        if (gap > length || fabs(rate) > still)
            k->before -= digit; /* open, not closed */
    }
    k->stage = DECIDES;
    do
        answer = machine_run(k, (size_t)-1 >> 1);
    while (answer == IS_TIRED);
    run->t = k->t;
    if (n_events)
        *n_events = o->n_events ? o->n_events - 1 : 0;
    for (size_t i = 0; i + 1 < o->n_events && i + 1 < most_events; i++)
        events[i] = events[i + 1]; /* the first is the start */
    return answer == RAN_OUT;
}

const char *NAME_mode(unsigned long long modes, int contact)
{
    static const char *const words[] = {"open", "closed", "closed", "sticks", "sticks", "slides on", "slides on",
                                        "slides back", "slides back"};
    return words[mode_of(modes, (size_t)contact)];
}

/* ---- a program: NAME_run [name=value ...] writes the motion as CSV, and with --events=1 what happens on the way ---- */

#if defined NAME_MAIN || defined NAME_RUN_SELFTEST
#include <stdio.h>
#include <stdlib.h>

static NAME_run NAME_memory;
#endif

#ifdef NAME_MAIN
static int given(const char *word, const char *name, double *value)
{
    size_t length = strlen(name);
    char *end;
    if (strncmp(word, name, length) || word[length] != '=' || !word[length + 1])
        return 0;
    *value = strtod(word + length + 1, &end);
    if (*end) {
        fprintf(stderr, "%s is no number\n", word + length + 1);
        exit(2);
    }
    return 1;
}

static void NAME_printed(const NAME_event *event)
{
    for (int i = 0; i < NAME_CONTACTS; i++)
        if (event->is_impact ? event->impulses[i] != 0
                             : mode_of(event->before, (size_t)i) != mode_of(event->after, (size_t)i))
            printf("%.17g,%s,%s,%s,%.17g,%.17g\n", event->t, NAME_contacts[i], NAME_mode(event->before, i),
                   NAME_mode(event->after, i), event->impulses[i], event->loss);
}

int main(int words, char **word)
{
    double x[NAME_STATES] = NAME_START, p[NAME_PARAMETERS + 1] = NAME_VALUES;
    double time = 10, samples = 101, rtol = RTOL, atol = RTOL, shows = 0, *instants, *rows;
    NAME_event *events;
    size_t n, n_events = 0, most = 100000;
    for (int i = 1; i < words; i++) {
        int known = given(word[i], "--time", &time) || given(word[i], "--samples", &samples)
                    || given(word[i], "--rtol", &rtol) || given(word[i], "--atol", &atol)
                    || given(word[i], "--events", &shows);
        for (size_t k = 0; !known && k < NAME_PARAMETERS; k++)
            known = given(word[i], NAME_parameters[k], &p[k]);
        for (size_t k = 0; !known && k < NAME_STATES; k++)
            known = given(word[i], NAME_states[k], &x[k]);
        if (!known) {
            fprintf(stderr, "unknown: %s; write name=value of a parameter or state, --time=10, --samples=101, "
                            "--events=1, --rtol=1e-9 or --atol=1e-9\n", word[i]);
            return 2;
        }
    }
    for (size_t k = 0; k < NAME_PARAMETERS; k++)
        if (p[k] != p[k]) {
            fprintf(stderr, "%s has no value: write %s=VALUE\n", NAME_parameters[k], NAME_parameters[k]);
            return 2;
        }
    if (!(time >= 0 && samples >= 2 && rtol > 0 && atol > 0)) {
        fprintf(stderr, "the time, the samples or the tolerances make no sense\n");
        return 2;
    }
    n = (size_t)samples;
    instants = malloc(n*sizeof *instants), rows = malloc((n + 1)*NAME_ROOM*sizeof *rows);
    events = malloc(most*sizeof *events);
    for (size_t i = 0; instants && i < n; i++)
        instants[i] = i + 1 == n ? time : time*(double)i/(samples - 1);
    if (!instants || !rows || !events)
        return 4;
    int is_done = NAME_motion(&NAME_memory, 0, x, p, rtol, atol, n, instants, rows, events, most, &n_events);
    printf(shows != 0 ? "t,contact,before,after,impulse,loss" : "t");
    for (size_t k = 0; shows == 0 && k < NAME_STATES; k++)
        printf(",%s", NAME_states[k]);
    printf("\n");
    for (size_t i = 0; shows != 0 && i < n_events && i < most; i++)
        NAME_printed(events + i);
    for (size_t i = 0; shows == 0 && i < n && (is_done || instants[i] <= NAME_memory.t); i++) {
        printf("%.17g", instants[i]);
        for (size_t k = 0; k < NAME_STATES; k++)
            printf(",%.17g", rows[i*NAME_STATES + k]);
        printf("\n");
    }
    if (!is_done)
        fprintf(stderr, "stopped at t = %g: what follows is not decided by this code\n", NAME_memory.t);
    free(instants), free(rows), free(events);
    return is_done ? 0 : 3;
}
#endif
