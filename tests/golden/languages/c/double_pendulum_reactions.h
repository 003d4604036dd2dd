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
#ifndef DOUBLE_PENDULUM_REACTIONS_H
#define DOUBLE_PENDULUM_REACTIONS_H

#include <stddef.h>

#ifdef __cplusplus
extern "C" {
#endif

#define DOUBLE_PENDULUM_REACTIONS_STATES 4
#define DOUBLE_PENDULUM_REACTIONS_PARAMETERS 5
#define DOUBLE_PENDULUM_REACTIONS_INPUTS 0
#define DOUBLE_PENDULUM_REACTIONS_CONSTANTS 7
#define DOUBLE_PENDULUM_REACTIONS_OUTPUTS 4

/* out at (t, x, p); inputs NULL: the model's own. */
void double_pendulum_reactions(double t, const double *x, const double *p, const double *inputs, double *out);

/* The same in two steps: c once for given p, then as often as one likes. */
void double_pendulum_reactions_constants(const double *p, double *c);
void double_pendulum_reactions_evaluate(double t, const double *x, const double *p, const double *c, const double *inputs, double *out);

/* n instants at once: t n, x n x states, inputs NULL or n x inputs, out n x outputs. */
void double_pendulum_reactions_many(size_t n, const double *t, const double *x, const double *p, const double *inputs, double *out);

#ifdef __cplusplus
}
#endif

#endif
