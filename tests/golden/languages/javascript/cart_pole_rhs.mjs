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

export const names = {
    x: ["x", "theta", "x'", "theta'"],
    p: ["M", "m", "l", "g"],
    inputs: ["F"],
};

export function constants(p, c = new Float64Array(4)) {
    const M = p[0];
    const m = p[1];
    const l = p[2]; // [m]
    const g = p[3];
    c[0] = M + m;
    c[1] = m*l;
    c[2] = l*(m*g);
    c[3] = 1.0/(m*(l*l));
    return c;
}

const acting_of_evaluate = new Float64Array(1);
export function evaluate(t, x, p, c, inputs, dx = new Float64Array(4)) {
    const theta = x[1];
    const x_dot = x[2]; // x'
    const theta_dot = x[3]; // theta'
    const acting = acting_of_evaluate;
    for (let i = 0; i < 1; i++) acting[i] = 0;
    if (inputs !== null) {
        acting[0] = inputs[0];
    } else {
        acting[0] = 0.0;
    }
    const F = acting[0];
    const v1 = Math.sin(theta);
    const v2 = c[2]*v1;
    const v3 = Math.cos(theta)*c[1];
    const v4 = v3*c[3];
    const v5 = (F + theta_dot*theta_dot*(c[1]*v1) + v2*v4)/(c[0] - v3*v4);
    dx[0] = x_dot;
    dx[1] = theta_dot;
    dx[2] = v5;
    dx[3] = -(v2*c[3] + v4*v5);
    return dx;
}

/** dx: 4 numbers; inputs null: the model's own. */
export function rhs(t, x, p, inputs = null) {
    return evaluate(t, x, p, constants(p), inputs);
}
