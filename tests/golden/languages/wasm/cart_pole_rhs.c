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

/* The numbers: x from 0, p from 4, c from 8, inputs from 12, out from 13. */
static double block[17];

__attribute__((export_name("block"))) double *cart_pole_block(void);
double *cart_pole_block(void)
{
    return block;
}

__attribute__((export_name("constants"))) void cart_pole_constants_here(void);
void cart_pole_constants_here(void)
{
    cart_pole_constants(block + 4, block + 8);
}

__attribute__((export_name("evaluate"))) void cart_pole_evaluate_here(double t, int given);
void cart_pole_evaluate_here(double t, int given)
{
    cart_pole_evaluate(t, block + 0, block + 4, block + 8, given ? block + 12 : NULL,
        block + 13);
}
