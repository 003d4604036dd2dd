/*
 * Double pendulum: out = f(t, x, p), the reactions of joints and constraints in the motion
 *
 * made by eomgen
 *
 *     x[0]  theta1
 *     x[1]  theta2
 *     x[2]  theta1'
 *     x[3]  theta2'
 *     p[0]  m1
 *     p[1]  m2
 *     p[2]  l1
 *     p[3]  l2
 *     p[4]  g
 *     out[0]  reaction_x(arm1)  [N]
 *     out[1]  reaction_y(arm1)  [N]
 *     out[2]  reaction_x(arm2)  [N]
 *     out[3]  reaction_y(arm2)  [N]
 */
#include "double_pendulum_reactions.h"

#include <math.h>
#include <stddef.h>

void double_pendulum_reactions_constants(const double *p, double *c)
{
    const double m1 = p[0];
    const double m2 = p[1];
    const double l1 = p[2];
    const double l2 = p[3];
    const double g = p[4];
    const double v1 = m1*l1;
    const double v2 = m2*l2;
    const double v3 = l2*v2;
    const double v4 = m2*l1;
    c[0] = v2;
    c[1] = 1.0/3.0*v3;
    c[2] = 0.5*v1 + v4;
    c[3] = 1.0/3.0*(l1*v1) + l1*v4;
    c[4] = m2*g;
    c[5] = m1*g;
    c[6] = 1.0/v3;
}

void double_pendulum_reactions_evaluate(double t, const double *x, const double *p, const double *c, const double *inputs, double *out)
{
    (void)t;
    (void)inputs;
    const double theta1 = x[0];
    const double theta2 = x[1];
    const double theta1_dot = x[2]; /* theta1' */
    const double theta2_dot = x[3]; /* theta2' */
    const double m1 = p[0];
    const double m2 = p[1];
    const double l1 = p[2];
    const double l2 = p[3];
    const double g = p[4];
    const double v1 = sin(theta1);
    const double v2 = cos(theta1);
    const double v3 = sin(theta2);
    const double v4 = cos(theta2);
    const double v5 = v4*c[0];
    const double v6 = v3*c[0];
    const double v7 = l1*v2;
    const double v8 = v7*v5;
    const double v9 = l1*v1;
    const double v10 = v9*v6;
    const double v11 = 0.5*v10 + 0.5*v8;
    const double v12 = v11*c[6];
    const double v13 = c[3] + (c[1] + v10 + v8) + c[1] - 2.0*(c[1] + v11) - 3.0*(v11*v12);
    const double v14 = theta1_dot*theta1_dot;
    const double v15 = 0.5*(v6*(g + v7*v14)) - 0.5*(v5*(v9*v14));
    const double v16 = theta2_dot*theta2_dot;
    const double v17 = g*(v1*c[2]) + (v15 + (0.5*(v9*(v5*v16)) - 0.5*(v7*(v6*v16))));
    const double v18 = (3.0*(v15*v12) - (v17 - v15))/v13;
    const double v19 = 3.0*(v15*c[6]) + 3.0*(v12*v18);
    const double v20 = l1*(v2*v18 - theta1_dot*(theta1_dot*v1));
    const double v21 = m2*(v20 - 0.5*(l2*(v4*v19 + theta2_dot*(theta2_dot*v3))));
    const double v22 = l1*(v1*v18 + theta1_dot*(theta1_dot*v2));
    const double v23 = m2*(v22 + 0.5*(l2*(theta2_dot*(theta2_dot*v4) - v3*v19))) + c[4];
    out[0] = 0.5*(m1*v20) + v21;
    out[1] = 0.5*(m1*v22) + c[5] + v23;
    out[2] = v21;
    out[3] = v23;
}

void double_pendulum_reactions(double t, const double *x, const double *p, const double *inputs, double *out)
{
    double c[7];
    double_pendulum_reactions_constants(p, c);
    double_pendulum_reactions_evaluate(t, x, p, c, inputs, out);
}

void double_pendulum_reactions_many(size_t n, const double *t, const double *x, const double *p, const double *inputs, double *out)
{
    double c[7];
    double_pendulum_reactions_constants(p, c);
    for (size_t i = 0; i < n; i++)
        double_pendulum_reactions_evaluate(t[i], x + i*4, p, c, inputs ? inputs + i*0 : NULL,
            out + i*4);
}

#ifdef EOMGEN_SELFTEST
#include <stdio.h>

static const struct {
    double t, x[4], p[5];
    int given;
    double inputs[1], out[4], tolerance;
} vectors[] = {
    {0.057, {-0.731, 0.695, 0.528, -0.49}, {1.243, 1.174, 1.477, 1.683, 0.641}, 0, {0}, {0.6622763768424343, 0.9181378881865646, 0.16516995889240665, 0.2234076671917474}, 1e-12},
    {0.061, {0.672, -0.134, 0.525, -0.996}, {1.168, 1.582, 0.843, 1.918, 1.852}, 0, {0}, {-2.0889403984417685, 2.8325612082212164, -0.7257140658154257, 1.5804988610546216}, 1e-12},
    {0.992, {-0.949, 0.083, 0.878, -0.238}, {0.825, 1.133, 0.544, 0.833, 1.157}, 0, {0}, {0.7973470726727533, 0.8093817775314783, 0.3168619073174404, 0.22836654983460294}, 1e-12},
    {0.372, {-0.534, -0.538, -0.562, -0.081}, {0.935, 0.532, 1.756, 1.335, 1.463}, 0, {0}, {1.0581973461915488, 2.16767514252973, 0.524189752482085, 0.8143077411941775}, 1e-12},
    {1.341, {0.985, 0.72, -0.758, -0.335}, {1.582, 1.567, 1.905, 1.133, 1.745}, 0, {0}, {-4.095993732249489, 3.314590596672319, -2.291949670575888, 1.7070435717074064}, 1e-12},
    {0.829, {-0.393, 0.175, 0.765, 0.692}, {1.258, 1.384, 0.552, 0.864, 1.696}, 0, {0}, {1.4725012266392457, 3.6570438592993124, 0.37408890345054757, 1.758876535842833}, 1e-12},
    {0.0, {0.0, 0.0, 0.0, 0.0}, {1.243, 1.174, 1.477, 1.683, 0.641}, 0, {0}, {0.0, 1.5492970000000001, 0.0, 0.7525339999999999}, 1e-12},
};

int main(void)
{
    int wrong = 0;
    for (size_t i = 0; i < sizeof vectors/sizeof *vectors; i++) {
        double out[4], largest = 1;
        double_pendulum_reactions(vectors[i].t, vectors[i].x, vectors[i].p, vectors[i].given ? vectors[i].inputs : NULL, out);
        for (int j = 0; j < 4; j++)
            if (fabs(vectors[i].out[j]) > largest) largest = fabs(vectors[i].out[j]);
        for (int j = 0; j < 4; j++)
            if (isnan(vectors[i].out[j]) ? !isnan(out[j])
                : !(fabs(out[j] - vectors[i].out[j]) <= vectors[i].tolerance*largest)) {
                fprintf(stderr, "vector %d: out[%d] is %.17g, not %.17g\n", (int)i, j, (double)out[j], (double)vectors[i].out[j]);
                wrong = 1;
            }
    }
    return wrong;
}
#endif
