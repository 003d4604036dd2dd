/* A program at many states, LANES at a time; eomgen_constants and eomgen_evaluate stand before it. */

/* outputs of n states at once: t n, x n x states, p of all or n x parameters, inputs NULL or n x inputs */
void lanes_many(size_t n, const size_t *sizes, const double *t, const double *x, const double *p, size_t per_state,
                const double *inputs, double *out, REAL *work)
{
    size_t states = sizes[0], parameters = sizes[1], given = sizes[2], outputs = sizes[3];
    REAL *of_x = work, *of_p = of_x + states, *of_inputs = of_p + parameters, *of_out = of_inputs + given,
         *c = of_out + outputs, when;
    for (size_t first = 0; first < n; first += LANES) {
        EACH_LANE {
            size_t i = first + (size_t)l < n ? first + (size_t)l : n - 1;
            LANE(when, l) = t[i];
            for (size_t k = 0; k < states; k++)
                LANE(of_x[k], l) = x[i*states + k];
            for (size_t k = 0; k < parameters && (per_state || !first); k++)
                LANE(of_p[k], l) = p[(per_state ? i*parameters : 0) + k];
            for (size_t k = 0; k < given && inputs; k++)
                LANE(of_inputs[k], l) = inputs[i*given + k];
        }
        if (per_state || !first)
            eomgen_constants(of_p, c);
        eomgen_evaluate(when, of_x, of_p, c, inputs ? of_inputs : NULL, of_out);
        EACH_LANE for (size_t k = 0; k < outputs && first + (size_t)l < n; k++)
            out[(first + (size_t)l)*outputs + k] = LANE(of_out[k], l);
    }
}
