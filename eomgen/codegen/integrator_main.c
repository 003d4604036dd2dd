
/* ---- a program: NAME_run [name=value ...] writes the motion as CSV ---- */

#ifdef NAME_MAIN
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

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

int main(int words, char **word)
{
    double x[NAME_STATES] = NAME_START, p[NAME_PARAMETERS + 1] = NAME_VALUES, y[NAME_STATES];
    double time = 10, samples = 101, rtol = RTOL, atol = RTOL;
    static NAME_run run;
    for (int i = 1; i < words; i++) {
        int known = given(word[i], "--time", &time) || given(word[i], "--samples", &samples)
                    || given(word[i], "--rtol", &rtol) || given(word[i], "--atol", &atol);
        for (size_t k = 0; !known && k < NAME_PARAMETERS; k++)
            known = given(word[i], NAME_parameters[k], &p[k]);
        for (size_t k = 0; !known && k < NAME_STATES; k++)
            known = given(word[i], NAME_states[k], &x[k]);
        if (!known) {
            fprintf(stderr, "unknown: %s; write name=value of a parameter or state, --time=10, --samples=101, "
                            "--rtol=1e-9 or --atol=1e-9\n", word[i]);
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
    printf("t");
    for (size_t k = 0; k < NAME_STATES; k++)
        printf(",%s", NAME_states[k]);
    printf("\n");
    NAME_begin(&run, 0, x, p, rtol, atol);
    for (long i = 0; i < (long)samples; i++) {
        double t = i == (long)samples - 1 ? time : time*i/(samples - 1);
        while (run.t < t)
            if (!NAME_step(&run, time)) {
                fprintf(stderr, "stopped at t = %g: the step size went to zero\n", (double)run.t);
                return 3;
            }
        NAME_at(&run, t, y);
        printf("%.17g", (double)t);
        for (size_t k = 0; k < NAME_STATES; k++)
            printf(",%.17g", (double)y[k]);
        printf("\n");
    }
    return 0;
}
#endif
