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

async function read(url) {
    if (url.protocol !== "file:") return (await fetch(url)).arrayBuffer();
    return (await import("node:fs/promises")).readFile(url);
}

const bytes = await read(new URL("./cart_pole_rhs.wasm", import.meta.url));
const { exports } = (await WebAssembly.instantiate(bytes, {})).instance;
exports._initialize();
const block = new Float64Array(exports.memory.buffer, exports.block(), 17);

export function constants(p, c = new Float64Array(4)) {
    block.set(p, 4);
    exports.constants();
    c.set(block.subarray(8, 8 + 4));
    return c;
}

export function evaluate(t, x, p, c, inputs, dx = new Float64Array(4)) {
    block.set(x, 0);
    block.set(p, 4);
    block.set(c, 8);
    if (inputs !== null) block.set(inputs, 12);
    exports.evaluate(t, inputs !== null);
    dx.set(block.subarray(13, 13 + 4));
    return dx;
}

/** dx: 4 numbers; inputs null: the model's own. */
export function rhs(t, x, p, inputs = null) {
    return evaluate(t, x, p, constants(p), inputs);
}
