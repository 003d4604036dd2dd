// Double pendulum: out = f(t, x, p), the reactions of joints and constraints in the motion
//
// made by eomgen
//
//     x[0]  theta1
//     x[1]  theta2
//     x[2]  theta1'
//     x[3]  theta2'
//     p[0]  m1
//     p[1]  m2
//     p[2]  l1
//     p[3]  l2
//     p[4]  g
//     out[0]  reaction_x(arm1)  [N]
//     out[1]  reaction_y(arm1)  [N]
//     out[2]  reaction_x(arm2)  [N]
//     out[3]  reaction_y(arm2)  [N]

export const names = {
    x: ["theta1", "theta2", "theta1'", "theta2'"],
    p: ["m1", "m2", "l1", "l2", "g"],
    inputs: [],
};

export function constants(p, c = new Float64Array(7)) {
    const m1 = p[0];
    const m2 = p[1];
    const l1 = p[2];
    const l2 = p[3];
    const g = p[4];
    const v1 = m1*l1;
    const v2 = m2*l2;
    const v3 = l2*v2;
    const v4 = m2*l1;
    c[0] = v2;
    c[1] = 1.0/3.0*v3;
    c[2] = 0.5*v1 + v4;
    c[3] = 1.0/3.0*(l1*v1) + l1*v4;
    c[4] = m2*g;
    c[5] = m1*g;
    c[6] = 1.0/v3;
    return c;
}

export function evaluate(t, x, p, c, inputs, out = new Float64Array(4)) {
    const theta1 = x[0];
    const theta2 = x[1];
    const theta1_dot = x[2]; // theta1'
    const theta2_dot = x[3]; // theta2'
    const m1 = p[0];
    const m2 = p[1];
    const l1 = p[2];
    const l2 = p[3];
    const g = p[4];
    const v1 = Math.sin(theta1);
    const v2 = Math.cos(theta1);
    const v3 = Math.sin(theta2);
    const v4 = Math.cos(theta2);
    const v5 = v4*c[0];
    const v6 = v3*c[0];
    const v7 = l1*v2;
    const v8 = v7*v5;
    const v9 = l1*v1;
    const v10 = v9*v6;
    const v11 = 0.5*v10 + 0.5*v8;
    const v12 = v11*c[6];
    const v13 = c[3] + (c[1] + v10 + v8) + c[1] - 2.0*(c[1] + v11) - 3.0*(v11*v12);
    const v14 = theta1_dot*theta1_dot;
    const v15 = 0.5*(v6*(g + v7*v14)) - 0.5*(v5*(v9*v14));
    const v16 = theta2_dot*theta2_dot;
    const v17 = g*(v1*c[2]) + (v15 + (0.5*(v9*(v5*v16)) - 0.5*(v7*(v6*v16))));
    const v18 = (3.0*(v15*v12) - (v17 - v15))/v13;
    const v19 = 3.0*(v15*c[6]) + 3.0*(v12*v18);
    const v20 = l1*(v2*v18 - theta1_dot*(theta1_dot*v1));
    const v21 = m2*(v20 - 0.5*(l2*(v4*v19 + theta2_dot*(theta2_dot*v3))));
    const v22 = l1*(v1*v18 + theta1_dot*(theta1_dot*v2));
    const v23 = m2*(v22 + 0.5*(l2*(theta2_dot*(theta2_dot*v4) - v3*v19))) + c[4];
    out[0] = 0.5*(m1*v20) + v21;
    out[1] = 0.5*(m1*v22) + c[5] + v23;
    out[2] = v21;
    out[3] = v23;
    return out;
}

/** out: 4 numbers; inputs null: the model's own. */
export function reactions(t, x, p, inputs = null) {
    return evaluate(t, x, p, constants(p), inputs);
}
