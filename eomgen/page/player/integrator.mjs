// x' = f(t, x), start -> a run with a state at every instant.
//
// The method of Dormand and Prince of order 5 with its dense output of order 4.
// Source: Hairer, Norsett & Wanner, Solving Ordinary Differential Equations I, 2nd ed., II.4 and II.6.

import { say } from "./words.mjs";

const C = [0, 1/5, 3/10, 4/5, 8/9, 1, 1];
const A = [
    [],
    [1/5],
    [3/40, 9/40],
    [44/45, -56/15, 32/9],
    [19372/6561, -25360/2187, 64448/6561, -212/729],
    [9017/3168, -355/33, 46732/5247, 49/176, -5103/18656],
    [35/384, 0, 500/1113, 125/192, -2187/6784, 11/84],
];
const ERROR = [71/57600, 0, -71/16695, 71/1920, -17253/339200, 22/525, -1/40];
const DENSE = [
    -12715105075/11282082432, 0, 87487479700/32700410799, -10690763975/1880347072,
    701980252875/199316789632, -1453857185/822651844, 69997945/29380423,
];
const SAFETY = 0.9, SMALLEST = 0.2, LARGEST = 10;

/** A motion: steps one after the other, each with its polynomial. */
export class Run {
    constructor(n) {
        this.n = n;
        this.t = [];  // of the beginning of each step, and of the end
        this.rows = new Float64Array(640*n);  // of a step five rows of n: of y(s) = r0 + s (r1 + (1 - s) (r2 + s (r3 + (1 - s) r4)))
        this.message = "";
        this.evaluations = 0;
    }

    /** How many steps there are. */
    get steps() { return this.t.length - 1; }

    get end() { return this.t[this.t.length - 1]; }

    /** The state at an instant, into `out`. */
    at(t, out = new Float64Array(this.n)) {
        const n = this.n;
        if (this.steps < 1) { out.set(this.first); return out; }
        let low = 0, high = this.steps - 1;
        while (low < high) {
            const middle = (low + high + 1) >> 1;
            if (this.t[middle] <= t) low = middle; else high = middle - 1;
        }
        const r = this.rows, first = 5*n*low, begin = this.t[low];
        const s = Math.min(Math.max((t - begin)/(this.t[low + 1] - begin), 0), 1), left = 1 - s;
        for (let i = 0; i < n; i++) {
            const at = first + i;
            out[i] = r[at] + s*(r[at + n] + left*(r[at + 2*n] + s*(r[at + 3*n] + left*r[at + 4*n])));
        }
        return out;
    }

    /** The step to t, from x to y with the slopes k. */
    stepped(t, x, y, k) {
        const n = this.n, h = t - this.end, first = 5*n*this.steps;
        if (first + 5*n > this.rows.length) {
            const more = new Float64Array(2*this.rows.length);
            more.set(this.rows);
            this.rows = more;
        }
        const r = this.rows;
        for (let i = 0; i < n; i++) {
            const at = first + i, whole = y[i] - x[i], bend = h*k[0][i] - whole;
            let sum = 0;
            for (let j = 0; j < 7; j++) sum += DENSE[j]*k[j][i];
            r[at] = x[i];
            r[at + n] = whole;
            r[at + 2*n] = bend;
            r[at + 3*n] = whole - h*k[6][i] - bend;
            r[at + 4*n] = h*sum;
        }
        this.t.push(t);
    }
}

/**
 * The run from x0 at t = 0 to the end, or to where it goes no further, which its message says.
 *
 * rate(t, x, dx): f. kept(t, x): puts x where it belongs and says whether it did. stopped(t, x, run): why it ends there, or "".
 * breaks: instants across which no step goes.
 */
export function integrated(rate, x0, end, { rtol, atol, kept = () => false, stopped = () => "", breaks = [], most = 200000 }) {
    const n = x0.length, run = new Run(n);
    const k = A.map(() => new Float64Array(n)), x = Float64Array.from(x0), y = new Float64Array(n);
    const finite = row => row.every(Number.isFinite);
    let t = 0;
    kept(t, x);
    run.first = Float64Array.from(x);
    run.t.push(t);
    run.message = stopped(t, x, run);
    rate(t, x, k[0]);
    if (!finite(k[0])) run.message = say("The motion has no finite value where it starts.");
    if (run.message || !n) { if (!n) run.t.push(end); return run; }
    let h = firstStep(rate, x, k, y, end, rtol, atol), grows = LARGEST;
    while (t < end) {
        const stop = Math.min(end, ...breaks.filter(b => b > t + 1e-12*Math.max(1, t)));
        const least = 10*Number.EPSILON*Math.max(t, Number.MIN_VALUE);
        if (!(h >= least)) { run.message = say("The step went to zero at t = {1} s.", t.toPrecision(6)); break; }
        if (run.steps === most) { run.message = say("Gave up after {1} steps at t = {2} s.", most, t.toPrecision(6)); break; }
        const last = t + h*1.0000001 >= stop, step = last ? stop - t : h;
        for (let stage = 1; stage < 7; stage++) {
            const a = A[stage];
            for (let i = 0; i < n; i++) {
                let sum = 0;
                for (let j = 0; j < stage; j++) sum += a[j]*k[j][i];
                y[i] = x[i] + step*sum;
            }
            rate(t + C[stage]*step, y, k[stage]);
        }
        run.evaluations += 6;
        let error = 0;
        for (let i = 0; i < n; i++) {
            let sum = 0;
            for (let j = 0; j < 7; j++) sum += ERROR[j]*k[j][i];
            const part = step*sum/(atol + rtol*Math.max(Math.abs(x[i]), Math.abs(y[i])));
            error += part*part;
        }
        error = Math.sqrt(error/n);
        if (!(error < 1)) {
            h = step*(error === error ? Math.max(SMALLEST, SAFETY*error**-0.2) : SMALLEST);
            grows = 1;
            continue;
        }
        t = last ? stop : t + step;
        run.stepped(t, x, y, k);
        const factor = Math.min(grows, error === 0 ? LARGEST : SAFETY*error**-0.2);
        h = last && h > step ? Math.max(h, step*factor) : step*factor;
        grows = LARGEST;
        x.set(y);
        run.message = stopped(t, x, run);
        if (run.message) break;
        if (kept(t, x)) rate(t, x, k[0]);
        else { const first = k[0]; k[0] = k[6]; k[6] = first; }
    }
    return run;
}

function firstStep(rate, x, k, y, end, rtol, atol) {
    const n = x.length;
    const norm = row => Math.sqrt(row.reduce((sum, v, i) => sum + (v/(atol + rtol*Math.abs(x[i])))**2, 0)/n);
    const d0 = norm(x), d1 = norm(k[0]);
    const small = d0 < 1e-5 || d1 < 1e-5 ? 1e-6 : 0.01*d0/d1;
    for (let i = 0; i < n; i++) y[i] = x[i] + small*k[0][i];
    rate(small, y, k[1]);
    const d2 = norm(k[1].map((v, i) => v - k[0][i]))/small;
    const next = Math.max(d1, d2) <= 1e-15 ? Math.max(1e-6, small*1e-3) : (0.01/Math.max(d1, d2))**0.2;
    return Math.min(100*small, next || small, end);
}
