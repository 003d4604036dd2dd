// Constraints, a state -> the nearest state in which they hold: phi(q) = 0 and J u + sigma = 0, by Newton's method.

export const CLOSED = 1e-11;  // [m or rad] a gap that an iteration in doubles has closed
export const STALLS = 1e-9;  // so far closed, no further is asked where steps help no more
const DAMPED = 1e-10;  // of rows of length 1: dependent ones do no harm

/**
 * d with A d = b where that can be, and with the least d^T W^-1 d.
 *
 * spread: row -> W row, W positive. largest: of the rows, against which one is rounding.
 */
export function leastChange(A, b, spread, largest = 0) {
    const moved = A.map(spread), size = A.map((row, m) => Math.sqrt(Math.max(0, dot(row, moved[m]))));
    const least = 1e-14*Math.max(...size, 0) + 1e-9*largest;
    const over = size.map(s => s > least ? 1/s : 0);
    const S = A.map((row, i) => moved.map((other, j) => over[i]*over[j]*dot(row, other) + (i === j ? DAMPED : 0)));
    const change = new Array(A.length ? A[0].length : 0).fill(0);
    for (let again = 0; again < 3; again++) {
        const left = A.map((row, m) => over[m]*(b[m] - dot(row, change)));
        const lam = solved(S.map(row => row.slice()), left);
        for (let m = 0; m < A.length; m++) for (let j = 0; j < change.length; j++) change[j] += over[m]*lam[m]*moved[m][j];
    }
    return change;
}

/** W of independent changes: each coordinate by its weight. */
export const weighted = weights => row => row.map((a, j) => a*weights[j]*weights[j]);

/** x of S x = r, S positive definite; both are changed. */
export function solved(S, r) {
    const n = r.length;
    for (let c = 0; c < n; c++) for (let i = c + 1; i < n; i++) {
        const factor = S[i][c]/S[c][c];
        if (factor === 0) continue;
        for (let j = c; j < n; j++) S[i][j] -= factor*S[c][j];
        r[i] -= factor*r[c];
    }
    for (let i = n - 1; i >= 0; i--) {
        for (let j = i + 1; j < n; j++) r[i] -= S[i][j]*r[j];
        r[i] /= S[i][i];
    }
    return r;
}

export function dot(a, b) {
    let sum = 0;
    for (let i = 0; i < a.length; i++) sum += a[i]*b[i];
    return sum;
}

/**
 * The ties of one set of equations.
 *
 * told: {coordinates, speeds, gaps, rates, positionSlopes: [[row, column]...], speedSlopes: the same, fixed: [column...],
 * spheres: [[place...]...]}; values(t, x, out): phi, J u + sigma, then the slopes that are not 0, in those orders.
 * fixed: coordinates that are given at every instant.
 */
export class Ties {
    constructor(told, values) {
        this.told = told;
        this.values = values;
        const { gaps, rates, positionSlopes, speedSlopes } = told;
        this.found = new Float64Array(gaps + rates + positionSlopes.length + speedSlopes.length);
        this.J = new Float64Array(rates*told.speeds);
        this.G = new Float64Array(rates*rates);
        this.movable = Array.from({ length: told.coordinates }, (_, j) => told.fixed.includes(j) ? 0 : 1);
    }

    /** The largest |phi| and |J u + sigma|. */
    open(t, x) {
        const { gaps, rates } = this.told;
        if (gaps + rates === 0) return [0, 0];
        const found = this.values(t, x, this.found);
        let phi = 0, rate = 0;
        for (let i = 0; i < gaps; i++) phi = larger(phi, found[i]);
        for (let i = gaps; i < gaps + rates; i++) rate = larger(rate, found[i]);
        return [phi, rate];
    }

    /** x with quaternions of norm 1; whether anything changed. */
    normed(x) {
        for (const places of this.told.spheres) {
            const norm = Math.hypot(...places.map(k => x[k]));
            if (norm > 0) for (const k of places) x[k] /= norm;
        }
        return this.told.spheres.length > 0;
    }

    /** Puts x back onto the constraints where it is further off than allowed; says whether it did. */
    kept(t, x, allowed) {
        let moved = this.normed(x);
        const [phi, rate] = this.open(t, x);
        if (phi > allowed) moved = this.positionsClosed(t, x, this.movable, allowed/1000) || moved;
        if (phi > allowed || rate > allowed) { this.speedsClosed(t, x); moved = true; }
        return moved;
    }

    /** dphi/dq at x, and phi: rows of q columns; those that keep quaternions' norms come last. */
    positionRows(t, x) {
        const { coordinates, gaps, rates, positionSlopes, spheres } = this.told;
        const found = this.values(t, x, this.found), rows = [], left = [];
        for (let m = 0; m < gaps; m++) { rows.push(new Array(coordinates).fill(0)); left.push(found[m]); }
        positionSlopes.forEach(([m, j], k) => { rows[m][j] = found[gaps + rates + k]; });
        for (const places of spheres) {
            const row = new Array(coordinates).fill(0);
            for (const k of places) row[k] = x[k];
            rows.push(row);
            left.push(0);
        }
        return [rows, left];
    }

    /** J at x, and J u + sigma. */
    speedRows(t, x) {
        const { speeds, gaps, rates, positionSlopes, speedSlopes } = this.told;
        const found = this.values(t, x, this.found), rows = [];
        for (let m = 0; m < rates; m++) rows.push(new Array(speeds).fill(0));
        speedSlopes.forEach(([m, j], k) => { rows[m][j] = found[gaps + rates + positionSlopes.length + k]; });
        return [rows, Array.from(found.subarray(gaps, gaps + rates))];
    }

    /**
     * How far each row of J is from those before it, the most independent first: squared sines.
     *
     * sizes: of the rows where they were longest, which grow here: one that vanishes depends on the others too.
     */
    pivots(t, x, sizes) {
        const { speeds: n, gaps, rates, positionSlopes, speedSlopes } = this.told, { J, G, found } = this;
        this.values(t, x, found);
        J.fill(0);
        for (let k = 0; k < speedSlopes.length; k++)
            J[speedSlopes[k][0]*n + speedSlopes[k][1]] = found[gaps + rates + positionSlopes.length + k];
        for (let m = 0; m < rates; m++) {
            let square = 0;
            for (let j = 0; j < n; j++) square += J[m*n + j]*J[m*n + j];
            sizes[m] = Math.max(sizes[m] ?? 0, Math.sqrt(square));
        }
        for (let m = 0; m < rates; m++) for (let i = 0; i <= m; i++) {
            let sum = 0;
            for (let j = 0; j < n; j++) sum += J[m*n + j]*J[i*n + j];
            const size = sizes[m]*sizes[i];
            G[m*rates + i] = G[i*rates + m] = size > 0 ? sum/size : sum;
        }
        const pivots = [], left = Array.from({ length: rates }, (_, m) => m);
        while (left.length) {
            let best = 0;
            for (let k = 1; k < left.length; k++) if (G[left[k]*(rates + 1)] > G[left[best]*(rates + 1)]) best = k;
            const [c] = left.splice(best, 1), pivot = G[c*(rates + 1)];
            pivots.push(pivot);
            if (pivot > 0) for (const i of left) for (const j of left) G[i*rates + j] -= G[i*rates + c]*G[c*rates + j]/pivot;
        }
        return pivots;
    }

    /** phi = 0 by moving coordinates, each by its weight; whether |phi| is small then. */
    positionsClosed(t, x, weights, enough = CLOSED, steps = 60) {
        let before = Infinity, kept = null;
        for (let step = 0; step < steps; step++) {
            const phi = this.open(t, x)[0];
            if (!(phi > enough)) return phi <= enough;
            if (phi >= 0.5*before && before <= STALLS) { x.set(kept); return true; }
            const [rows, left] = this.positionRows(t, x);
            const change = dampedChange(rows, left, weights, Math.min(phi, 1));
            kept = Float64Array.from(x);
            before = phi;
            for (let j = 0; j < weights.length; j++) x[j] += change[j];
            this.normed(x);
        }
        return this.open(t, x)[0] <= STALLS;
    }

    /** J u + sigma = 0 by the least change of all speeds. */
    speedsClosed(t, x) {
        const { coordinates } = this.told;
        const [rows, left] = this.speedRows(t, x);
        if (!rows.length) return;
        const change = leastChange(rows, left.map(v => -v), row => row);
        for (let j = 0; j < change.length; j++) x[coordinates + j] += change[j];
    }
}

/** d with the least |A d + b|^2 + damping^2 |d/w|^2. */
function dampedChange(A, b, weights, damping) {
    const moved = A.map(weighted(weights));
    const S = A.map((row, i) => moved.map((other, j) => dot(row, other) + (i === j ? damping*damping + 1e-24 : 0)));
    const lam = solved(S, b.map(v => -v));
    return weights.map((_, j) => moved.reduce((sum, row, m) => sum + row[j]*lam[m], 0));
}

function larger(most, value) {
    const size = Math.abs(value);
    return size <= most ? most : size;  // a NaN wins
}
