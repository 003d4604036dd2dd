/* The functions of FMI 3.0 over a model's own: model exchange, and co-simulation by DOP853 with steps of its own choice.

   Values: reference 0 is time; then states, their rates, parameters, inputs, outputs. Until one input is set the model's
   own laws act; from then on those that are not set stay as they start. */

#include <math.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#ifdef _WIN32
#define EXPORT __declspec(dllexport)
#else
#define EXPORT __attribute__((visibility("default")))
#endif

typedef void *fmi3Instance;
typedef enum { fmi3OK, fmi3Warning, fmi3Discard, fmi3Error, fmi3Fatal } fmi3Status;
typedef uint32_t fmi3ValueReference;
typedef const char *fmi3String;

#define ROOM(n) ((n) > 0 ? (n) : 1)

struct instance {
    double t, x[ROOM(STATES)], dx[ROOM(STATES)], p[ROOM(PARAMETERS)], inputs[ROOM(INPUTS)], out[ROOM(OUTPUTS)];
    double c[ROOM(CONSTANTS)], step;
    bool acted, known, computed; /* inputs were set; c belongs to p; dx and out belong to all */
};

static const double first_x[ROOM(STATES)] = FIRST_X, first_p[ROOM(PARAMETERS)] = FIRST_P;
static const double first_inputs[ROOM(INPUTS)] = FIRST_INPUTS;

static void begin(struct instance *m)
{
    memset(m, 0, sizeof *m);
    memcpy(m->x, first_x, sizeof m->x);
    memcpy(m->p, first_p, sizeof m->p);
    memcpy(m->inputs, first_inputs, sizeof m->inputs);
}

static const double *acting(const struct instance *m) { return m->acted ? m->inputs : NULL; }

static void know(struct instance *m)
{
    if (!m->known)
        MAKE_CONSTANTS(m->p, m->c);
    m->known = true;
}

static void compute(struct instance *m)
{
    if (m->computed)
        return;
    know(m);
    EVALUATE(m->t, m->x, m->p, m->c, acting(m), m->dx);
    MAKE_OUTPUTS(m->t, m->x, m->p, acting(m), m->out);
    m->computed = true;
}

/* where a value lies; NULL of what there is none */
static double *place(struct instance *m, fmi3ValueReference v)
{
    if (v == 0) return &m->t;
    if ((v -= 1) < STATES) return m->x + v;
    if ((v -= STATES) < STATES) return m->dx + v;
    if ((v -= STATES) < PARAMETERS) return m->p + v;
    if ((v -= PARAMETERS) < INPUTS) return m->inputs + v;
    if ((v -= INPUTS) < OUTPUTS) return m->out + v;
    return NULL;
}

/* to the instant `end` by steps of errors below 1e-9; false where they become too small, or a state has no value */
static bool integrated(struct instance *m, double end)
{
    enum { N = ROOM(STATES) };
    static const double tolerance = TOLERANCE;
    double K[DOP853_STAGES*N], y[N], errors[2];
    know(m);
    const struct rate f = { EVALUATE, m->p, m->c, acting(m) };
    double h = m->step > 0 ? m->step : 0.01*(end - m->t);
    EVALUATE(m->t, m->x, m->p, m->c, acting(m), K);
    while (m->t < end) {
        const bool last = m->t + h >= end;
        const double taken = last ? end - m->t : h;
        if (!(taken > SMALLEST*(fabs(m->t) + fabs(end)) ) && !last)
            return false;
        dop853_step(&f, STATES, m->t, taken, m->x, y, K);
        dop853_errors(STATES, m->x, y, K, tolerance, tolerance, errors);
        const double below = errors[0] + 0.01*errors[1];
        const double error = STATES == 0 || !(below > 0) ? (below == 0 ? 0 : below)
                                                         : fabs(taken)*errors[0]/sqrt(below*STATES);
        if (error < 1) {
            m->t = last ? end : m->t + taken;
            memcpy(m->x, y, sizeof(double)*STATES);
            memcpy(K, K + 12*STATES, sizeof(double)*STATES);
        } else if (!(taken > SMALLEST*(fabs(m->t) + fabs(end))))
            return false;
        const double change = error > 0 ? 0.9*pow(error, -0.125) : error == 0 ? 10 : 0.2;
        const double next = taken*fmin(error < 1 ? 10 : 1, fmax(0.2, change));
        if (!last || error >= 1 || next < h) h = next;
    }
    m->step = h;
    m->computed = false;
    return true;
}

/* -- FMI ----------------------------------------------------------------------------------------------------------- */

EXPORT fmi3String fmi3GetVersion(void) { return "3.0"; }

static fmi3Instance made(fmi3String token)
{
    if (token == NULL || strcmp(token, TOKEN) != 0)
        return NULL;
    struct instance *m = malloc(sizeof *m);
    if (m != NULL)
        begin(m);
    return m;
}

EXPORT fmi3Instance fmi3InstantiateModelExchange(fmi3String name, fmi3String token, fmi3String path, bool visible,
    bool logging, void *environment, void *log)
{
    (void)name, (void)path, (void)visible, (void)logging, (void)environment, (void)log;
    return made(token);
}

EXPORT fmi3Instance fmi3InstantiateCoSimulation(fmi3String name, fmi3String token, fmi3String path, bool visible,
    bool logging, bool events, bool early, const fmi3ValueReference required[], size_t n, void *environment, void *log,
    void *update)
{
    (void)name, (void)path, (void)visible, (void)logging, (void)events, (void)early, (void)required, (void)n;
    (void)environment, (void)log, (void)update;
    return made(token);
}

EXPORT fmi3Instance fmi3InstantiateScheduledExecution(fmi3String name, fmi3String token, fmi3String path, bool visible,
    bool logging, void *environment, void *log, void *clock, void *lock, void *unlock)
{
    (void)name, (void)token, (void)path, (void)visible, (void)logging, (void)environment, (void)log, (void)clock;
    (void)lock, (void)unlock;
    return NULL;
}

EXPORT void fmi3FreeInstance(fmi3Instance m) { free(m); }

EXPORT fmi3Status fmi3Reset(fmi3Instance m)
{
    begin(m);
    return fmi3OK;
}

EXPORT fmi3Status fmi3EnterInitializationMode(fmi3Instance m, bool with_tolerance, double tolerance, double start,
    bool with_end, double end)
{
    (void)with_tolerance, (void)tolerance, (void)with_end, (void)end;
    ((struct instance *)m)->t = start;
    ((struct instance *)m)->computed = false;
    return fmi3OK;
}

EXPORT fmi3Status fmi3SetDebugLogging(fmi3Instance m, bool on, size_t n, const fmi3String categories[])
{
    (void)m, (void)on, (void)n, (void)categories;
    return fmi3OK;
}

#define NOTHING_TO_DO(name) \
    EXPORT fmi3Status name(fmi3Instance m) { (void)m; return fmi3OK; }
NOTHING_TO_DO(fmi3ExitInitializationMode)
NOTHING_TO_DO(fmi3EnterEventMode)
NOTHING_TO_DO(fmi3Terminate)
NOTHING_TO_DO(fmi3EnterStepMode)
NOTHING_TO_DO(fmi3EnterContinuousTimeMode)
NOTHING_TO_DO(fmi3EnterConfigurationMode)
NOTHING_TO_DO(fmi3ExitConfigurationMode)
NOTHING_TO_DO(fmi3EvaluateDiscreteStates)

EXPORT fmi3Status fmi3GetFloat64(fmi3Instance instance, const fmi3ValueReference v[], size_t n, double values[], size_t k)
{
    struct instance *m = instance;
    if (n != k) return fmi3Error;
    compute(m);
    for (size_t i = 0; i < n; i++) {
        const double *at = place(m, v[i]);
        if (at == NULL) return fmi3Error;
        values[i] = *at;
    }
    return fmi3OK;
}

EXPORT fmi3Status fmi3SetFloat64(fmi3Instance instance, const fmi3ValueReference v[], size_t n, const double values[],
    size_t k)
{
    struct instance *m = instance;
    if (n != k) return fmi3Error;
    for (size_t i = 0; i < n; i++) {
        double *at = place(m, v[i]);
        if (at == NULL || v[i] == 0 || (v[i] > STATES && v[i] <= 2*STATES) || v[i] > 2*STATES + PARAMETERS + INPUTS)
            return fmi3Error;
        *at = values[i];
        if (v[i] > 2*STATES + PARAMETERS) m->acted = true;
        else if (v[i] > 2*STATES) m->known = false;
        m->computed = false;
    }
    return fmi3OK;
}

EXPORT fmi3Status fmi3UpdateDiscreteStates(fmi3Instance m, bool *needed, bool *end, bool *nominals, bool *values,
    bool *defined, double *next)
{
    (void)m;
    *needed = *end = *nominals = *values = *defined = false;
    *next = 0;
    return fmi3OK;
}

EXPORT fmi3Status fmi3CompletedIntegratorStep(fmi3Instance m, bool no_set, bool *event, bool *end)
{
    (void)m, (void)no_set;
    *event = *end = false;
    return fmi3OK;
}

EXPORT fmi3Status fmi3SetTime(fmi3Instance m, double t)
{
    ((struct instance *)m)->t = t;
    ((struct instance *)m)->computed = false;
    return fmi3OK;
}

EXPORT fmi3Status fmi3SetContinuousStates(fmi3Instance m, const double x[], size_t n)
{
    if (n != STATES) return fmi3Error;
    memcpy(((struct instance *)m)->x, x, n*sizeof *x);
    ((struct instance *)m)->computed = false;
    return fmi3OK;
}

EXPORT fmi3Status fmi3GetContinuousStates(fmi3Instance m, double x[], size_t n)
{
    if (n != STATES) return fmi3Error;
    memcpy(x, ((struct instance *)m)->x, n*sizeof *x);
    return fmi3OK;
}

EXPORT fmi3Status fmi3GetContinuousStateDerivatives(fmi3Instance m, double dx[], size_t n)
{
    if (n != STATES) return fmi3Error;
    compute(m);
    memcpy(dx, ((struct instance *)m)->dx, n*sizeof *dx);
    return fmi3OK;
}

EXPORT fmi3Status fmi3GetNominalsOfContinuousStates(fmi3Instance m, double nominals[], size_t n)
{
    (void)m;
    for (size_t i = 0; i < n; i++) nominals[i] = 1;
    return fmi3OK;
}

EXPORT fmi3Status fmi3GetEventIndicators(fmi3Instance m, double indicators[], size_t n)
{
    (void)m, (void)indicators;
    return n == 0 ? fmi3OK : fmi3Error;
}

EXPORT fmi3Status fmi3GetNumberOfEventIndicators(fmi3Instance m, size_t *n)
{
    (void)m;
    *n = 0;
    return fmi3OK;
}

EXPORT fmi3Status fmi3GetNumberOfContinuousStates(fmi3Instance m, size_t *n)
{
    (void)m;
    *n = STATES;
    return fmi3OK;
}

EXPORT fmi3Status fmi3DoStep(fmi3Instance instance, double t, double h, bool no_set, bool *event, bool *end, bool *early,
    double *reached)
{
    struct instance *m = instance;
    (void)no_set;
    *event = *end = *early = false;
    m->t = t;
    const bool done = integrated(m, t + h);
    *reached = m->t;
    return done ? fmi3OK : fmi3Error;
}

/* what the model has not: variables of other types, clocks, saved states, derivatives by direction */
#define NONE(name) \
    EXPORT fmi3Status name(fmi3Instance m, ...) { (void)m; return fmi3Error; }
#define NONE_OF(type) NONE(fmi3Get##type) NONE(fmi3Set##type)
NONE_OF(Float32) NONE_OF(Int8) NONE_OF(UInt8) NONE_OF(Int16) NONE_OF(UInt16) NONE_OF(Int32) NONE_OF(UInt32)
NONE_OF(Int64) NONE_OF(UInt64) NONE_OF(Boolean) NONE_OF(String) NONE_OF(Binary) NONE_OF(Clock) NONE_OF(FMUState)
NONE_OF(IntervalDecimal) NONE_OF(IntervalFraction) NONE_OF(ShiftDecimal) NONE_OF(ShiftFraction)
NONE(fmi3GetNumberOfVariableDependencies) NONE(fmi3GetVariableDependencies) NONE(fmi3FreeFMUState)
NONE(fmi3SerializedFMUStateSize) NONE(fmi3SerializeFMUState) NONE(fmi3DeserializeFMUState)
NONE(fmi3GetDirectionalDerivative) NONE(fmi3GetAdjointDerivative) NONE(fmi3GetOutputDerivatives)
NONE(fmi3ActivateModelPartition)
