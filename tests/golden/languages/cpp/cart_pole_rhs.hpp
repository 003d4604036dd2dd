// Cart-pole: dx = f(t, x, p), the equations of motion solved for the accelerations
//
// made by eomgen from models/cart_pole.toml
//
//     x[0]  x  [m] place of the cart * / / * ? ?/
//     x[1]  theta
//     x[2]  x'
//     x[3]  theta'
//     p[0]  M
//     p[1]  m
//     p[2]  l  [m]
//     p[3]  g
//     inputs[0]  F
//     dx  4 values, in the order of x
#ifndef CART_POLE_RHS_HPP
#define CART_POLE_RHS_HPP

#include <math.h>
#include <cstddef>
#include <limits>

template <class Real>
struct cart_pole_rhs {
    static constexpr std::size_t states_size = 4;
    static constexpr std::size_t parameters_size = 4;
    static constexpr std::size_t inputs_size = 1;
    static constexpr std::size_t constants_size = 4;
    static constexpr const char *x_names[] = {"x", "theta", "x'", "theta'"};
    static constexpr const char *p_names[] = {"M", "m", "l", "g"};
    static constexpr const char *input_names[] = {"F"};

    static void constants(const Real *p, Real *c)
    {
        const Real M = p[0];
        const Real m = p[1];
        const Real l = p[2]; // [m]
        const Real g = p[3];
        c[0] = M + m;
        c[1] = m*l;
        c[2] = l*(m*g);
        c[3] = Real(1.0)/(m*(l*l));
    }

    static void evaluate(Real t, const Real *x, const Real *p, const Real *c, const Real *inputs, Real *dx)
    {
        (void)t;
        (void)p;
        const Real theta = x[1];
        const Real x_dot = x[2]; // x'
        const Real theta_dot = x[3]; // theta'
        Real acting[1] = {};
        if (inputs != nullptr) {
            acting[0] = inputs[0];
        } else {
            acting[0] = Real(0.0);
        }
        const Real F = acting[0];
        const Real v1 = sin(theta);
        const Real v2 = c[2]*v1;
        const Real v3 = cos(theta)*c[1];
        const Real v4 = v3*c[3];
        const Real v5 = (F + theta_dot*theta_dot*(c[1]*v1) + v2*v4)/(c[0] - v3*v4);
        dx[0] = x_dot;
        dx[1] = theta_dot;
        dx[2] = v5;
        dx[3] = -(v2*c[3] + v4*v5);
    }

    // dx has 4 places; inputs nullptr: the model's own
    static void rhs(Real t, const Real *x, const Real *p, const Real *inputs, Real *dx)
    {
        Real c[4];
        constants(p, c);
        evaluate(t, x, p, c, inputs, dx);
    }
};

#endif
