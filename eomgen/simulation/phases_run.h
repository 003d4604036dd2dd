#ifndef @UPPER@_RUN_H
#define @UPPER@_RUN_H

#include <stddef.h>

/* The memory of a motion; as many may run at once as one likes. t: where it is, or where it stopped. */
typedef struct {
    double t;
    union {
        double aligned;
        void *pointer;
        char room[8*@MEMORY@];
    } memory;
} NAME_run;

/* What happens at an instant: the modes of the contacts before and after, of an impact the impulses and the energy lost. */
typedef struct {
    double t, loss, impulses[@CONTACTS@];
    unsigned long long before, after;
    int is_impact;
} NAME_event;

/* The motion from x at t on: n rows of @STATES@ states at instants that ascend. `rows` has room for n x @ROOM@ numbers;
   `events`, or NULL, for `most_events`; n_events, or NULL: how many there were. 1; 0 where it stopped at run->t, because what
   follows is not decided by this code: a singular position, contacts that jam, impacts with friction or of more contacts
   than have single impulses. */
int NAME_motion(NAME_run *run, double t, const double *x, const double *p, double rtol, double atol, size_t n,
                const double *instants, double *rows, NAME_event *events, size_t most_events, size_t *n_events);

/* The mode of a contact in words: open, closed, sticks, slides on, slides back. */
const char *NAME_mode(unsigned long long modes, int contact);

#endif
