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
#ifndef CART_POLE_RHS_H
#define CART_POLE_RHS_H

#include <stddef.h>

#ifdef __cplusplus
extern "C" {
#endif

#define CART_POLE_STATES 4
#define CART_POLE_PARAMETERS 4
#define CART_POLE_INPUTS 1
#define CART_POLE_CONSTANTS 4
#define CART_POLE_OUTPUTS 4

/* dx at (t, x, p); inputs NULL: the model's own. */
void cart_pole_rhs(double t, const double *x, const double *p, const double *inputs, double *dx);

/* The same in two steps: c once for given p, then as often as one likes. */
void cart_pole_constants(const double *p, double *c);
void cart_pole_evaluate(double t, const double *x, const double *p, const double *c, const double *inputs, double *dx);

/* n instants at once: t n, x n x states, inputs NULL or n x inputs, dx n x outputs. */
void cart_pole_many(size_t n, const double *t, const double *x, const double *p, const double *inputs, double *dx);

#ifdef __cplusplus
}
#endif

#endif
