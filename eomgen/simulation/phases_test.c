/* ---- its own test: the instants and the last state of eomgen's own run; 0 if they agree ---- */

#ifdef NAME_RUN_SELFTEST
int main(void)
{
    static const double expected[] = @INSTANTS@, last[] = @LAST@, end[] = {@END@};
    const double x[] = NAME_START, p[] = NAME_VALUES;
    static double rows[2*NAME_ROOM];
    static NAME_event events[@COUNT@ + 1];
    size_t count;
    int wrong = 0;
    if (!NAME_motion(&NAME_memory, 0, x, p, 1e-10, 1e-10, 1, end, rows, events, @COUNT@ + 1, &count)) {
        fprintf(stderr, "stopped at t = %.17g\n", NAME_memory.t);
        return 1;
    }
    if (count != @COUNT@) {
        fprintf(stderr, "%d changes of contacts, not @COUNT@\n", (int)count);
        return 1;
    }
    for (size_t i = 0; i < count; i++)
        if (!(fabs(events[i].t - expected[i]) <= 1e-7)) {
            fprintf(stderr, "change %d is at t = %.17g, not %.17g\n", (int)i, events[i].t, expected[i]);
            wrong = 1;
        }
    for (size_t i = 0; i < NAME_STATES; i++)
        if (!(fabs(rows[i] - last[i]) <= 1e-6*fmax(1, fabs(last[i])))) {
            fprintf(stderr, "state %d is %.17g at the end, not %.17g\n", (int)i, rows[i], last[i]);
            wrong = 1;
        }
    return wrong;
}
#endif
