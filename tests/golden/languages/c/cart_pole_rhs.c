/*
 * Cart-pole: dx = f(t, x, p), the equations of motion solved for the accelerations
 *
 * made by eomgen from models/cart_pole.toml
 *
 *     x[0]  x  [m] place of the cart * / / * ? ?/
 *     x[1]  theta
 *     x[2]  x'
 *     x[3]  theta'
 *     p[0]  M
 *     p[1]  m
 *     p[2]  l  [m]
 *     p[3]  g
 *     inputs[0]  F
 *     dx  4 values, in the order of x
 */
#include "cart_pole_rhs.h"

#include <math.h>
#include <stddef.h>

void cart_pole_constants(const double *p, double *c)
{
    const double M = p[0];
    const double m = p[1];
    const double l = p[2]; /* [m] */
    const double g = p[3];
    c[0] = M + m;
    c[1] = m*l;
    c[2] = l*(m*g);
    c[3] = 1.0/(m*(l*l));
}

void cart_pole_evaluate(double t, const double *x, const double *p, const double *c, const double *inputs, double *dx)
{
    (void)t;
    (void)p;
    const double theta = x[1];
    const double x_dot = x[2]; /* x' */
    const double theta_dot = x[3]; /* theta' */
    double acting[1] = {0};
    if (inputs != NULL) {
        acting[0] = inputs[0];
    } else {
        acting[0] = 0.0;
    }
    const double F = acting[0];
    const double v1 = sin(theta);
    const double v2 = c[2]*v1;
    const double v3 = cos(theta)*c[1];
    const double v4 = v3*c[3];
    const double v5 = (F + theta_dot*theta_dot*(c[1]*v1) + v2*v4)/(c[0] - v3*v4);
    dx[0] = x_dot;
    dx[1] = theta_dot;
    dx[2] = v5;
    dx[3] = -(v2*c[3] + v4*v5);
}

void cart_pole_rhs(double t, const double *x, const double *p, const double *inputs, double *dx)
{
    double c[4];
    cart_pole_constants(p, c);
    cart_pole_evaluate(t, x, p, c, inputs, dx);
}

void cart_pole_many(size_t n, const double *t, const double *x, const double *p, const double *inputs, double *dx)
{
    double c[4];
    cart_pole_constants(p, c);
    for (size_t i = 0; i < n; i++)
        cart_pole_evaluate(t[i], x + i*4, p, c, inputs ? inputs + i*1 : NULL,
            dx + i*4);
}

#ifdef EOMGEN_SELFTEST
#include <stdio.h>

static const struct {
    double t, x[4], p[4];
    int given;
    double inputs[1], dx[4], tolerance;
} vectors[] = {
    {0.057, {-0.731, 0.695, 0.528, -0.49}, {1.243, 1.174, 1.477, 1.683}, 0, {0}, {0.528, -0.49, 0.7181607985094061, -1.1031514925578993}, 1e-12},
    {0.061, {0.672, -0.134, 0.525, -0.996}, {1.168, 1.582, 0.843, 1.918}, 1, {0.803}, {0.525, -0.996, 0.1876783302033243, 0.08333056354864529}, 1e-12},
    {0.992, {-0.949, 0.083, 0.878, -0.238}, {0.825, 1.133, 0.544, 0.833}, 0, {0}, {0.878, -0.238, 0.097107194891642, -0.3048392378332513}, 1e-12},
    {0.372, {-0.534, -0.538, -0.562, -0.081}, {0.935, 0.532, 1.756, 1.335}, 1, {0.285}, {-0.562, -0.081, -0.02852990140408754, 0.40351920678391584}, 1e-12},
    {1.341, {0.985, 0.72, -0.758, -0.335}, {1.582, 1.567, 1.905, 1.133}, 0, {0}, {-0.758, -0.335, 0.4864644658627943, -0.584152024043461}, 1e-12},
    {0.829, {-0.393, 0.175, 0.765, 0.692}, {1.258, 1.384, 0.552, 0.864}, 1, {0.595}, {0.765, 0.692, 0.6644155012006843, -1.4577844343713828}, 1e-12},
    {0.0, {0.0, 0.0, 0.0, 0.0}, {1.243, 1.174, 1.477, 1.683}, 0, {0}, {0.0, 0.0, 0.0, 0.0}, 1e-12},
};

int main(void)
{
    int wrong = 0;
    for (size_t i = 0; i < sizeof vectors/sizeof *vectors; i++) {
        double dx[4], largest = 1;
        cart_pole_rhs(vectors[i].t, vectors[i].x, vectors[i].p, vectors[i].given ? vectors[i].inputs : NULL, dx);
        for (int j = 0; j < 4; j++)
            if (fabs(vectors[i].dx[j]) > largest) largest = fabs(vectors[i].dx[j]);
        for (int j = 0; j < 4; j++)
            if (isnan(vectors[i].dx[j]) ? !isnan(dx[j])
                : !(fabs(dx[j] - vectors[i].dx[j]) <= vectors[i].tolerance*largest)) {
                fprintf(stderr, "vector %d: dx[%d] is %.17g, not %.17g\n", (int)i, j, (double)dx[j], (double)vectors[i].dx[j]);
                wrong = 1;
            }
    }
    return wrong;
}
#endif
