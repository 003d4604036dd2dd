// Cart-pole: dx = f(t, x, p), the equations of motion solved for the accelerations
//
// made by eomgen from models/cart_pole.toml
//
//     x[0]  x  [m] place of the cart */ /* ??/
//     x[1]  theta
//     x[2]  x'
//     x[3]  theta'
//     p[0]  M
//     p[1]  m
//     p[2]  l  [m]
//     p[3]  g
//     inputs[0]  F
//     dx  4 values, in the order of x
#![allow(non_snake_case, non_upper_case_globals, clippy::needless_range_loop, clippy::needless_return, clippy::too_many_arguments, clippy::neg_cmp_op_on_partial_ord, clippy::identity_op, clippy::erasing_op, clippy::approx_constant, clippy::excessive_precision, clippy::manual_range_contains, clippy::manual_memcpy, clippy::manual_swap, clippy::collapsible_if, clippy::many_single_char_names, clippy::assign_op_pattern)]
use crate::math;

pub static STATES: [&str; 4] = ["x", "theta", "x'", "theta'"];
pub static PARAMETERS: [&str; 4] = ["M", "m", "l", "g"];
pub static INPUTS: [&str; 1] = ["F"];

pub fn constants(p: &[f64], c: &mut [f64]) {
    let M: f64 = p[0];
    let m: f64 = p[1];
    let l: f64 = p[2]; // [m]
    let g: f64 = p[3];
    c[0] = M + m;
    c[1] = m*l;
    c[2] = l*(m*g);
    c[3] = 1.0/(m*(l*l));
}

pub fn evaluate(t: f64, x: &[f64], p: &[f64], c: &[f64], inputs: &[f64], dx: &mut [f64]) {
    let _ = t;
    let _ = p;
    let theta: f64 = x[1];
    let x_dot: f64 = x[2]; // x'
    let theta_dot: f64 = x[3]; // theta'
    let acting: &mut [f64] = &mut [0.0; 1];
    if !inputs.is_empty() {
        acting[0] = inputs[0];
    } else {
        acting[0] = 0.0;
    }
    let F: f64 = acting[0];
    let v1: f64 = math::sin(theta);
    let v2: f64 = c[2]*v1;
    let v3: f64 = math::cos(theta)*c[1];
    let v4: f64 = v3*c[3];
    let v5: f64 = (F + theta_dot*theta_dot*(c[1]*v1) + v2*v4)/(c[0] - v3*v4);
    dx[0] = x_dot;
    dx[1] = theta_dot;
    dx[2] = v5;
    dx[3] = -(v2*c[3] + v4*v5);
}

/// dx of 4 places; `inputs` none: the model's own.
pub fn rhs(t: f64, x: &[f64], p: &[f64], inputs: Option<&[f64]>, dx: &mut [f64]) {
    let c = &mut [0.0; 4];
    constants(p, c);
    evaluate(t, x, p, c, inputs.unwrap_or(&[]), dx);
}
