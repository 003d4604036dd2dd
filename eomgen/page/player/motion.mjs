// A model that moves in the page: parameters and start values -> a start at which the constraints hold -> a run.

import { Run, integrated } from "./integrator.mjs";
import { STALLS, Ties, dot, leastChange, solved, weighted } from "./ties.mjs";
import { say } from "./words.mjs";

const OF_A_STEP = 0.1;  // of the tolerances of a run: errors of many steps add up
const INDEPENDENT = 1e-6;  // squared sine of a row's angle to those before it: more, and it counts
const SINGULAR = 1e-4;  // of the same: less, and the constraints soon do not say how the motion goes on
const NEAR_SINGULAR = 0.05;  // of the same: less at the end of a step, and one looks into it
const LOOKS = 16;  // there
const EASY = 1e3;  // times farther a guess may move than a given value, for the same
const ROUNDS = 12;  // of walking along the constraints towards the values given

export class Motion {
    /** told, programs: as eomgen/page/live.py writes them; values: of the parameters. */
    constructor(told, programs, values) {
        this.told = told;
        this.programs = programs;
        this.p = Float64Array.from(values);
        this.c = {};
        const of = name => (t, x, out) => programs[name].evaluate(t, x, this.p, this.c[name], null, out);
        this.of = Object.fromEntries(Object.keys(programs).map(name => [name, of(name)]));
        const none = (t, x, out) => out;
        this.start = new Ties(told.start, this.of.start ?? none);
        this.ties = new Ties(told.ties, this.of.ties ?? this.of.start ?? none);
        this.parametersSet({});
    }

    /** Parameters by name; those that are expressions of others follow. */
    parametersSet(given) {
        const { parameters, derived } = this.told;
        parameters.forEach((name, k) => { if (name in given) this.p[k] = given[name]; });
        this.c.begin = this.programs.begin.constants(this.p);
        const { coordinates, speeds } = this.told;
        this.begun = this.of.begin(0, new Float64Array(coordinates.length + speeds.length));
        derived.forEach((name, k) => { this.p[parameters.indexOf(name)] = this.begun[k]; });
        for (const name of Object.keys(this.programs)) this.c[name] = this.programs[name].constants(this.p);
    }

    /** The values of coordinates and declared speeds at the start, and why there is none, or "". */
    startFor(given) {
        const { coordinates, speeds, derived, sought, near } = this.told;
        const nq = coordinates.length, nu = speeds.length, x = new Float64Array(nq + nu), d = derived.length;
        for (let k = 0; k < nq; k++) x[k] = this.begun[d + (near.includes(k) ? nq : 0) + k];
        coordinates.forEach((name, k) => { if (name in given) x[k] = given[name]; });
        this.start.normed(x);
        const all = this.of.begin(0, x);
        speeds.forEach((name, k) => { x[nq + k] = name in given ? given[name] : all[d + 2*nq + k]; });
        let open = this.start.open(0, x)[0];
        if (open > STALLS && sought.length) {
            const tried = Float64Array.from(x);
            if (this.start.positionsClosed(0, tried, this._weights(sought))) x.set(tried);
            open = this.start.open(0, x)[0];
        }
        if (!(open <= STALLS)) {
            const found = this._nearest(x, given);
            if (found === null) return { x, why: this._open(x) };
            x.set(found);
        }
        if (this.start.open(0, x)[1] > STALLS) this._nearestSpeeds(x, given);
        const rate = this.start.open(0, x)[1];
        return { x, why: rate <= 1e-6 ? "" : say("No start speeds near the ones given satisfy the constraints.") };
    }

    /** The run from that start; its message says where it ended early. */
    run(given, { time, rtol = 1e-9, atol = rtol }) {
        const { x, why } = this.startFor(given);
        const first = this.phaseState(x);
        if (why) return Object.assign(new Run(first.length), { message: why, first, t: [0], impossible: true });
        const allowed = OF_A_STEP*atol;
        let lost = "";
        const kept = (t, y) => {
            const moved = this.ties.kept(t, y, allowed);
            if (moved && !lost && this.ties.open(t, y)[0] > 100*atol) lost = say("From t = {1} s on the constraints stay violated.", t.toPrecision(6));
            return moved;
        };
        const sizes = [], pivots = this.ties.pivots(0, first, sizes), rank = pivots.filter(v => v > INDEPENDENT).length;
        const least = rank ? Math.min(SINGULAR, pivots[rank - 1]/100) : 0;
        let singular = false;
        const astray = (t, y, run) => {
            if (!rank || !run.steps || this.ties.pivots(t, y, sizes)[rank - 1] > NEAR_SINGULAR) return "";
            const begun = run.t[run.t.length - 2];
            const within = Array.from({ length: LOOKS }, (_, k) => begun + (t - begun)*(k + 1)/LOOKS);
            singular = within.some(s => this.ties.pivots(s, run.at(s), sizes)[rank - 1] < least);
            return singular ? say("Stopped at t = {1} s: before a singular position, which this page does not cross.", begun.toPrecision(6)) : "";
        };
        const found = integrated(this.of.rate, first, time, {
            rtol: Math.max(OF_A_STEP*rtol, 1e-13), atol: allowed, kept, breaks: this.told.breaks,
            stopped: (t, y, run) => lost || this._stopped(t, y) || astray(t, y, run),
        });
        if (singular) found.t.pop();
        return found;
    }

    /** x as it is integrated, of a state in declared coordinates and speeds. */
    phaseState(x) {
        const { coordinates, speeds, phase } = this.told, nq = coordinates.length;
        if (!this.of.turned) return Float64Array.from(x);
        const found = new Float64Array(nq + phase.speeds.length);
        found.set(x.subarray(0, nq));
        phase.speeds.forEach((name, k) => { const j = speeds.indexOf(name); if (j >= 0) found[nq + k] = x[nq + j]; });
        const rates = this.of.turned(0, found);
        coordinates.forEach((name, k) => { const j = phase.speeds.indexOf(`${name}'`); if (j >= 0) found[nq + j] = rates[k]; });
        return found;
    }

    /** The state of a run at an instant, on the constraints. */
    at(run, t, out) {
        const x = run.at(t, out);
        this.ties.kept(t, x, STALLS);
        return x;
    }

    _stopped(t, x) {
        if (!this.of.edges) return "";
        const k = this.of.edges(t, x).findIndex(left => left < 0);
        return k < 0 ? "" : say("Stopped at t = {1} s: {2}, and how it goes on is not determined.", t.toPrecision(6), this.told.edges[k]);
    }

    _open(x) {
        const found = this.start.values(0, x, this.start.found), open = [];
        this.told.gapTies.forEach((name, k) => { if (!(Math.abs(found[k]) <= STALLS) && !open.includes(name)) open.push(name); });
        const names = open.map(name => `'${name}'`).join(", ");
        return names ? say("With these values {1} cannot be closed: no place of the bodies fits.", names) : say("With these values the loop cannot be closed: no place of the bodies fits.");
    }

    _weights(columns, sizes = null) {
        return Array.from({ length: this.told.coordinates.length }, (_, j) => columns.includes(j) ? (sizes ? sizes[j] : 1) : 0);
    }

    /** Whether a start was typed, here or for the page. */
    _called(name, given) {
        return name in given || this.told.typed.includes(name);
    }

    /** The nearest place at which the constraints hold: guesses move first, then what the model gives, at last what was called. */
    _nearest(x, given) {
        const { coordinates, sought, own, guesses } = this.told;
        const called = own.filter(k => this._called(coordinates[k], given));
        const silent = own.filter(k => !called.includes(k) && guesses.includes(coordinates[k]));
        const guessed = [...sought, ...silent];
        const free = [];
        for (const tier of [guessed, own.filter(k => !called.includes(k) && !silent.includes(k)), called]) {
            if (!tier.length) continue;
            free.push(...tier);
            const found = this._walked(x, free, guessed);
            if (found) return found;
        }
        return null;
    }

    /** Closed from there, then along the constraints to the point that is nearest to the values wanted. */
    _walked(wanted, free, guessed) {
        const [rows] = this.start.positionRows(0, wanted);
        const slope = Array.from({ length: this.told.coordinates.length }, (_, j) => Math.hypot(...rows.map(row => row[j])));
        const largest = Math.max(...slope) || 1;
        const sizes = slope.map((s, j) => (guessed.includes(j) ? EASY : 1)/Math.max(s, 1e-6*largest));
        const weights = this._weights(free, sizes);
        let x = Float64Array.from(wanted);
        if (!this.start.positionsClosed(0, x, weights)) return null;
        for (let round = 0; round < ROUNDS; round++) {
            const [J] = this.start.positionRows(0, x);
            const left = weights.map((w, j) => w ? wanted[j] - x[j] : 0);
            const across = leastChange(J, J.map(row => dot(row, left)), weighted(weights));
            const along = left.map((v, j) => v - across[j]);
            if (Math.max(...along.map((v, j) => weights[j] ? Math.abs(v/weights[j]) : 0)) < 1e-12) break;
            const moved = Float64Array.from(x, (v, j) => j < along.length ? v + along[j] : v);
            if (!this.start.positionsClosed(0, moved, weights)) break;
            x = moved;
        }
        return x;
    }

    /** The nearest speeds that agree with the constraints; of each tier no more than what those before it cannot close. */
    _nearestSpeeds(x, given) {
        const { coordinates, guesses } = this.told, nq = coordinates.length;
        const speeds = this.told.speeds.slice(0, this.told.start.speeds), n = speeds.length;
        const [J, left] = this.start.speedRows(0, x);
        const M = this.of.inertia(0, x);
        const kind = speeds.map(name => this._called(name, given) ? 2 : guesses.includes(name) ? 0 : 1);
        for (const tier of [2, 1, 0]) {
            const columns = speeds.map((_, j) => j).filter(j => kind[j] === tier);
            if (!columns.length) continue;
            const apart = complement(J, speeds.map((_, j) => j).filter(j => kind[j] < tier));
            const A = columns.map(j => apart(J.map(row => row[j])));  // by columns
            const rows = J.map((_, m) => A.map(column => column[m]));
            const size = Math.max(...J.flat().map(Math.abs));
            const slope = columns.map(j => Math.max(Math.hypot(...J.map(row => row[j])), 1e-6*size));
            const block = columns.map(i => columns.map(j => M[i*n + j]));
            const spread = tier ? row => solved(block.map(line => line.slice()), row.slice()) : weighted(slope.map(s => 1/s));
            const change = leastChange(rows, apart(left).map(v => -v), spread, tier ? 0 : size*Math.max(...slope.map(s => 1/s)));
            columns.forEach((j, k) => {
                x[nq + j] += change[k];
                for (let m = 0; m < left.length; m++) left[m] += J[m][j]*change[k];
            });
        }
    }
}

/** v -> v without what these columns of J reach. */
function complement(J, columns) {
    const basis = [];
    for (const j of columns) {
        const v = J.map(row => row[j]), size = Math.hypot(...v);
        for (let again = 0; again < 2; again++) for (const b of basis) {
            const part = dot(b, v);
            for (let m = 0; m < v.length; m++) v[m] -= part*b[m];
        }
        const left = Math.hypot(...v);
        if (left > 1e-9*size && size > 0) basis.push(v.map(a => a/left));
    }
    return v => basis.reduce((found, b) => { const part = dot(b, found); return found.map((a, m) => a - part*b[m]); }, v);
}
