/* ---- DOP853 with step control; nothing is allocated, all that it knows stands in the run ---- */

void NAME_begin(NAME_run *run, double t, const double *x, const double *p, double rtol, double atol)
{
    struct rate f = {NAME_evaluate, p, run->c, NULL};
    size_t n = NAME_STATES;
    double d0 = 0, d1 = 0, d2 = 0, *later = run->x_old, *rate = run->f_old;
    NAME_constants(p, run->c);
    run->p = p, run->t = run->t_old = t, run->rtol = rtol, run->atol = atol, run->steps = 0, run->is_dense = 0;
    EACH run->x[k] = x[k];
    NAME_hold(run->x);
    CALL(&f, t, run->x, run->f);
    EACH {
        double scale = atol + rtol*fabs(run->x[k]);
        d0 += run->x[k]/scale*(run->x[k]/scale), d1 += run->f[k]/scale*(run->f[k]/scale);
    }
    d0 = sqrt(d0/NAME_STATES), d1 = sqrt(d1/NAME_STATES);
    run->h = d0 < 1e-5 || d1 < 1e-5 ? 1e-6 : 0.01*d0/d1;
    EACH later[k] = run->x[k] + run->h*run->f[k];
    CALL(&f, t + run->h, later, rate);
    EACH {
        double change = (rate[k] - run->f[k])/(atol + rtol*fabs(run->x[k]));
        d2 += change*change;
    }
    d2 = sqrt(d2/NAME_STATES)/run->h;
    d1 = d1 > d2 ? d1 : d2;
    d2 = d1 <= 1e-15 ? (run->h*1e-3 > 1e-6 ? run->h*1e-3 : 1e-6) : pow(0.01/d1, 0.125);
    run->h = 100*run->h < d2 ? 100*run->h : d2;
}

int NAME_step(NAME_run *run, double end)
{
    struct rate f = {NAME_evaluate, run->p, run->c, NULL};
    size_t n = NAME_STATES;
    double growth = LARGEST_GROWTH, errors[2], y[NAME_STATES];
    for (double size = run->h;;) {
        double t = run->t + size < end ? run->t + size : end, h = t - run->t;
        if (!(h > 4*EPSILON*(fabs(run->t) + h)))
            return run->t >= end;
        EACH run->K[k] = run->f[k];
        dop853_step(&f, n, run->t, h, run->x, y, run->K);
        dop853_errors(n, run->x, y, run->K, run->rtol, run->atol, errors);
        double whole = errors[0] + 0.01*errors[1], error = whole == 0 ? 0 : h*errors[0]/sqrt(whole*NAME_STATES);
        double factor = error == 0 ? LARGEST_GROWTH : SAFETY*pow(error, -0.125);
        if (error < 1) {
            EACH run->x_old[k] = run->x[k], run->f_old[k] = run->f[k], run->x[k] = y[k], run->f[k] = run->K[12*n + k];
            run->t_old = run->t, run->t = t, run->h = h*(factor < growth ? factor : growth), run->is_dense = 0;
            run->steps++;
            EACH run->x_new[k] = run->x[k];
            if (NAME_hold(run->x))
                CALL(&f, run->t, run->x, run->f);
            return 1;
        }
        size = h*(factor > SMALLEST_GROWTH ? factor : SMALLEST_GROWTH), growth = 1;
    }
}

void NAME_at(NAME_run *run, double t, double *x)
{
    struct rate f = {NAME_evaluate, run->p, run->c, NULL};
    size_t n = NAME_STATES;
    double h = run->t - run->t_old;
    if (!(h > 0)) {
        EACH x[k] = run->x[k];
        return;
    }
    if (!run->is_dense) {
        double rate[NAME_STATES];
        dop853_dense(&f, n, run->t_old, h, run->x_old, run->x_new, x, run->K, run->F);
        run->pieces = dop853_pieces(dop853_missed(&f, n, run->t_old, h, run->x_old, run->x_new, run->F, run->rtol,
                                                  run->atol, x, rate));
        run->piece = 0, run->is_dense = 1;
        EACH run->x_piece[k] = run->x_old[k];
    }
    double pieces = (double)run->pieces, part = (t - run->t_old)/h*pieces;
    if (run->pieces > 1) {
        size_t piece = part > 0 ? (size_t)part : 0;
        piece = 1 + (piece < run->pieces ? piece : run->pieces - 1);
        if (piece < run->piece)
            run->piece = 0;
        for (; run->piece < piece; run->piece++) {
            double *from = run->piece ? run->x_next : run->x_old, *rates = run->piece ? run->K : run->f_old;
            EACH run->x_piece[k] = from[k], run->K[k] = rates[k];
            dop853_piece(&f, n, run->t_old + (double)run->piece*(h/pieces), h/pieces, run->x_piece, run->x_next, x,
                         run->K, run->F);
        }
        part -= (double)(piece - 1);
    }
    dop853_between(n, part, run->x_piece, run->F, x);
    NAME_hold(x);
}
