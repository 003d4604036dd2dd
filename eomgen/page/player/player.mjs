// What is told of a motion -> its player: picture, time, plots, and where the model lives here, its sliders.

import { unpackedRows } from "./columns.mjs";
import { Motion } from "./motion.mjs";
import { PlaneView, inGround } from "./plane.mjs";
import { SpaceView } from "./space.mjs";
import { solved } from "./ties.mjs";
import { decimal, say, speak } from "./words.mjs";

const FRAMES_TO_FIT = 60;
const POINTS = 400;  // of a curve
const NEAR = 1e-6;  // of a state against the recorded one

const DIGITS = "\u2070\u00b9\u00b2\u00b3\u2074\u2075\u2076\u2077\u2078\u2079";
const written = unit => unit.replaceAll("*", "\u00b7").replace(/\^(-?)(\d)/g, (_, sign, digit) => (sign && "\u207b") + DIGITS[digit]);
const rounded = v => v === 0 ? "0" : Number.isFinite(v) ? String(+v.toPrecision(5)) : "none";
const shown = v => (Number.isFinite(v) ? decimal(rounded(v)) : say("none"));

/** <name ...attributes>children</name> */
function made(name, attributes = {}, ...children) {
    const node = document.createElement(name);
    for (const [key, value] of Object.entries(attributes)) {
        if (key.startsWith("on")) node.addEventListener(key.slice(2), value);
        else if (value === true) node.setAttribute(key, "");
        else if (value !== false && value !== null) node.setAttribute(key, value);
    }
    node.append(...children.filter(child => child !== null));
    return node;
}

/** A name as formulas have it, where the page was given that. */
function sign(told, name) {
    const node = made("span", { class: "sign" }, name);
    if (told.signs[name]) node.innerHTML = told.signs[name];  // of our own making
    return node;
}

/** A run as it was recorded: rows of states, between them by Hermite's cubic; or rows of frames, between them straight. */
class Recorded {
    constructor(told, rate) {
        this.t = unpackedRows(told.t);
        this.n = told.x.columns.length;
        this.x = unpackedRows(told.x);
        this.end = this.t[this.t.length - 1];
        this.message = told.message;
        this.rate = rate;
        if (told.frames) { this.frames = unpackedRows(told.frames); this.slots = told.frames.columns.length; }
    }

    row(k) { return this.x.subarray(k*this.n, (k + 1)*this.n); }

    place(t) {
        let low = 0, high = this.t.length - 2;
        while (low < high) { const middle = (low + high + 1) >> 1; if (this.t[middle] <= t) low = middle; else high = middle - 1; }
        const h = this.t[low + 1] - this.t[low];
        return [low, h > 0 ? Math.min(Math.max((t - this.t[low])/h, 0), 1) : 0, h];
    }

    at(t, out = new Float64Array(this.n)) {
        if (this.t.length < 2) return out.set(this.row(0)), out;
        const [k, s, h] = this.place(t), a = this.row(k), b = this.row(k + 1);
        if (s === 0 || s === 1 || !this.rate) {
            for (let i = 0; i < this.n; i++) out[i] = s === 1 ? b[i] : a[i] + s*(b[i] - a[i]);
            return out;
        }
        const da = this.rate(this.t[k], a), db = this.rate(this.t[k + 1], b), left = 1 - s;
        for (let i = 0; i < this.n; i++)
            out[i] = left*left*(1 + 2*s)*a[i] + s*s*(1 + 2*left)*b[i] + h*s*left*(left*da[i] - s*db[i]);
        return out;
    }

    frame(t) {
        if (this.t.length < 2) return this.frames.slice(0, this.slots);
        const [k, s] = this.place(t), a = k*this.slots, b = a + this.slots, out = new Float64Array(this.slots);
        for (let i = 0; i < this.slots; i++) out[i] = this.frames[a + i] + s*(this.frames[b + i] - this.frames[a + i]);
        return out;
    }
}

export class Player {
    constructor(root, told, programs) {
        Object.assign(this, { root, told, given: {}, t: 0, playing: false, speed: 1, trail: [] });
        if (told.live) this.motion = new Motion(told.live, programs, told.parameters.map(p => p.value));
        this.recorded = new Recorded(told.run, this.motion ? (t, x) => this.motion.of.rate(t, x) : null);
        this.run = this.recorded;
        this._built();
        this._fitted();
        this.seek(0);
    }

    // -- the motion ------------------------------------------------------------------------------

    /** The state as it is integrated. */
    inner(t) { return this.run === this.recorded ? this.recorded.at(t) : this.motion.at(this.run, t); }

    /** The numbers of the picture at an instant. */
    frame(t) {
        if (!this.motion) return this.run.frame(t);
        return this.motion.of.frame(t, this.inner(t));
    }

    /** The column of that name at an instant, by the state and the frame there. */
    value(name, t, x = this.inner(t), frame = null) {
        if (!this.motion) return name in this.told.columns ? x[this.told.columns[name][1]] : NaN;
        if (name === "E") { frame ??= this.motion.of.frame(t, x); return this.value("T", t, x, frame) + this.value("V", t, x, frame); }
        const [where, k] = this.told.columns[name];
        return where === "x" ? x[k] : (frame ?? this.motion.of.frame(t, x))[k];
    }

    /** States and pictures of the run at instants as far apart as curves need them; computed once. */
    sampled() {
        if (this.samples?.run === this.run) return this.samples;
        const times = this._times(POINTS), states = times.map(t => Float64Array.from(this.inner(t)));
        const frames = times.map((t, i) => this.motion ? this.motion.of.frame(t, states[i]) : this.run.frame(t));
        return this.samples = { run: this.run, times, states, frames };
    }

    /** Coordinates, then speeds, in the order of `names`. */
    state(t) {
        const x = this.inner(t), frame = this.motion ? this.motion.of.frame(t, x) : null;
        return this.told.names.map(name => this.value(name, t, x, frame));
    }

    /** The column of that name at the recorded instants. */
    column(name) {
        if (name === "t") return this.recorded.t;
        this.rows ??= Array.from(this.recorded.t, (t, k) => [t, this.recorded.row(k), this.motion.of.frame(t, this.recorded.row(k))]);
        return this.rows.map(row => this.value(name === "energy" ? "E" : name, ...row));
    }

    seek(t) {
        this.t = Math.min(Math.max(t, 0), this.run.end);
        const frame = this.frame(this.t);
        this.view.update(frame);
        if (this.trail.length) {
            const passed = this.trail.filter(([s]) => s <= this.t).map(([, at]) => at);
            this.view.trailed([...passed, this._point(frame)]);
        }
        this.scrub.value = this.t;
        const clock = decimal(`${this.t.toFixed(2)} s`);
        this.scrub.setAttribute("aria-valuetext", clock);
        this.clock.textContent = clock;
        const said = (this.told.captions ?? []).findLast(([from]) => from <= this.t)?.[1] ?? "";
        if (this.caption.textContent !== said) this.caption.textContent = said;
        for (const plot of this.plots) plot.cursor(this.t);
    }

    /** A parameter or start value, SI; the motion from there. */
    set(name, value) {
        this._refuseUnlessLive();
        if (![...this.told.live.parameters, ...this.told.live.coordinates, ...this.told.live.speeds].includes(name)) throw new RangeError(say("there is no '{1}'", name));
        this.given[name] = value;
        this._rerun();
    }

    reset() {
        this.given = {};
        if (this.motion) this.motion.parametersSet(Object.fromEntries(this.told.parameters.map(p => [p.name, p.value])));
        this.run = this.recorded;
        this._shown();
    }

    _refuseUnlessLive() { if (!this.told.moves) throw new Error(this.told.rests || say("this page plays a run as it was computed")); }

    _rerun() {
        const began = performance.now();
        this.motion.parametersSet({ ...Object.fromEntries(this.told.parameters.map(p => [p.name, p.value])), ...this.given });
        this.run = this.motion.run(this.given, { time: this.told.time, rtol: this.told.rtol });
        this.took = performance.now() - began;
        this._shown();
    }

    /** All that depends on the run, after it has changed. */
    _shown() {
        this.scrub.max = this.run.end;
        const bad = this.run.impossible || this.run.message && this.run !== this.recorded;
        this.note.textContent = bad ? this.run.message : "";
        this.note.hidden = !bad;
        for (const slider of this.sliders) slider.shown(this._current(slider.told));
        this._energy();
        this._trail();
        for (const plot of this.plots) plot.draw();
        this.seek(Math.min(this.t, this.run.end));
        this._remembered();
    }

    _current(told) {
        if (told.name in this.given) return this.given[told.name];
        return told.value;
    }

    _times(n) { return Array.from({ length: n }, (_, i) => this.run.end*i/Math.max(n - 1, 1)); }

    _fitted() { this.view.fit(this._times(FRAMES_TO_FIT).map(t => this.frame(t))); }

    // -- what is told ------------------------------------------------------------------------------

    _energy() {
        this.energy.hidden = !this.told.energy;
        if (!this.told.energy) return;
        const every = Math.ceil(this.run.t.length/POINTS), times = Array.from(this.run.t).filter((_, k) => k % every === 0);
        const rows = times.map(t => { const x = this.inner(t), frame = this.motion.of.frame(t, x); return [this.value("T", t, x, frame), this.value("V", t, x, frame)]; });
        const [T, V] = rows[0], first = T + V;
        let drift = 0, moves = 0;
        for (const [kinetic, potential] of rows) {
            drift = Math.max(drift, Math.abs(kinetic + potential - first));
            moves = Math.max(moves, kinetic, Math.abs(potential - V));
        }
        this.energy.textContent = this.told.conservative && moves > 0
            ? say("Energy {1} J at the start, drift {2} of what moves.", rounded(first), (drift/moves).toExponential(1))
            : say("Energy {1} J at the start.", rounded(first));
    }

    _trail() {
        const at = this.told.scene.points.find(point => point.name === this.trailed)?.at;
        const { times, frames } = at ? this.sampled() : {};
        this.trail = at ? times.map((t, i) => [t, this._point(frames[i])]) : [];
        if (!at) this.view.trailed([]);
    }

    /** Where the point with the trail is. */
    _point(frame) {
        const { at } = this.told.scene.points.find(point => point.name === this.trailed);
        return at.map(v => typeof v === "number" ? v : frame[v[0]]);
    }

    // -- the page ------------------------------------------------------------------------------------

    _built() {
        const { told, root } = this, id = name => `${root.id}-${name}`, space = told.scene.space === "space";
        this.stage = space ? made("div", { class: "stage space" }) : document.createElementNS("http://www.w3.org/2000/svg", "svg");
        if (!space) this.stage.setAttribute("class", "stage");
        this.stage.setAttribute("role", "img");
        this.stage.setAttribute("aria-label", space ? say("{1} in motion; arrow keys turn it, plus and minus bring it nearer", told.name) : say("{1} in motion", told.name));
        this.view = space ? new SpaceView(this.stage, told.scene, told.three) : new PlaneView(this.stage, told.scene);
        this.button = made("button", { type: "button", class: "play", "aria-label": say("Play"), onclick: () => this.play(!this.playing) }, "\u25b6");
        this.scrub = made("input", { type: "range", id: id("time"), min: 0, max: this.run.end, step: "any", value: 0, "aria-label": say("Time"),
            oninput: () => { this.play(false); this.seek(+this.scrub.value); } });
        this.clock = made("output", { for: id("time"), class: "clock" }, decimal("0.00 s"));
        const speeds = made("select", { "aria-label": say("Speed"), onchange: event => { this.speed = +event.target.value; } },
            ...[0.1, 0.25, 0.5, 1, 2, 4].map(v => made("option", { value: v, selected: v === (told.speed ?? 1) }, decimal(`${v} \u00d7`))));
        this.speed = told.speed ?? 1;
        const box = (text, name, on) => {
            const input = made("input", { type: "checkbox", onchange: event => { root.classList.toggle(name, event.target.checked); this.seek(this.t); } });
            input.checked = on;
            root.classList.toggle(name, on);
            return made("label", {}, input, ` ${text}`);
        };
        const roles = new Set(told.scene.marks.map(mark => mark.role));
        this.trailed = told.trail ?? "";
        const trails = made("select", { "aria-label": say("Trail"), onchange: event => { this.trailed = event.target.value; this._trail(); this.seek(this.t); } },
            made("option", { value: "" }, say("no trail")), ...told.scene.points.filter(p => p.at.some(v => typeof v !== "number")).map(p => made("option", { value: p.name, selected: p.name === this.trailed }, say("trail of {1}", p.name))));
        const options = made("div", { class: "options" }, speeds, trails,
            roles.has("force") || roles.has("reaction") ? box(say("forces"), "forces", told.forces ?? false) : null,
            told.scene.marks.some(mark => mark.kind === "label") ? box(say("names"), "names", false) : null);
        this.note = made("p", { class: "note", role: "status", hidden: true });
        this.energy = made("p", { class: "energy" });
        this.caption = made("p", { class: "caption", hidden: !told.captions });
        this.plots = [];
        this.plotting = made("div", { class: "plots" });
        const seen = [this.stage, made("div", { class: "controls" }, this.button, this.scrub, this.clock), this.caption, options, this.note, this.energy];
        const sliders = this._sliders(), plots = this._plotted();
        root.append(made("div", { class: "seen" }, ...seen, ...(plots ? [plots] : [])), ...(sliders ? [made("div", { class: "beside" }, sliders)] : []));
        root.tabIndex = -1;
        this._energy();
        this._trail();
        if (told.moves && told.sliders.some(each => each.kind === "coordinate")) this._draggable();
        new ResizeObserver(() => { this.view.resized(); this.view.update(this.frame(this.t)); }).observe(this.stage);
        matchMedia("(prefers-color-scheme: dark)").addEventListener("change", () => this.view.resized());
    }

    play(on) {
        this.playing = on;
        this.button.textContent = on ? "\u275a\u275a" : "\u25b6";
        this.button.setAttribute("aria-label", on ? say("Pause") : say("Play"));
        if (!on) return;
        if (this.t >= this.run.end) this.t = 0;
        let last = null;
        const next = now => {
            if (!this.playing) return;
            if (last !== null) {
                const t = this.t + this.speed*(now - last)/1000;
                this.seek(t > this.run.end ? 0 : t);
            }
            last = now;
            requestAnimationFrame(next);
        };
        requestAnimationFrame(next);
    }

    _sliders() {
        this.sliders = [];
        const told = this.told.sliders;
        if (!told.length && !this.told.rests) return null;
        const fields = told.map(each => {
            const label = each.unit ? `${each.name} [${each.unit}]` : each.name;
            const input = name => made("input", { type: name, min: each.min/each.size, max: each.max/each.size, step: name === "range" ? (each.max - each.min)/each.size/400 : "any",
                "aria-label": name === "number" ? say("{1}, typed", label) : label, disabled: !this.told.moves });
            const range = input("range"), typed = input("number");
            typed.removeAttribute("min"), typed.removeAttribute("max");
            const typedIn = value => { range.value = value/each.size; typed.value = rounded(value/each.size); range.setAttribute("aria-valuetext", decimal(`${rounded(value/each.size)} ${each.unit}`)); };
            const changed = event => { const v = +event.target.value; if (event.target.value !== "" && Number.isFinite(v)) this._soon(each.name, v*each.size); };
            range.addEventListener("input", changed);
            range.addEventListener("change", () => this._fitted());
            typed.addEventListener("change", changed);
            this.sliders.push({ told: each, shown: typedIn });
            typedIn(each.value);
            return made("div", { class: "slider", title: each.about || null }, made("span", { class: "name" }, sign(this.told, each.name)), range, typed, made("span", { class: "unit" }, written(each.unit)));
        });
        const rests = this.told.rests ? made("p", { class: "rests" }, this.told.rests) : null;
        if (!told.length) return rests;
        const buttons = made("div", { class: "options" },
            made("button", { type: "button", onclick: () => { this.reset(); this._fitted(); this.seek(this.t); }, disabled: !this.told.moves }, say("as in the file")));
        return made("details", { class: "sliders", open: true }, made("summary", {}, say("Parameters and start")), rests, made("div", { class: "fields" }, ...fields), buttons);
    }

    /** The last of several changes before the next picture. */
    _soon(name, value) {
        const waiting = Boolean(this.waiting);
        this.waiting = { ...this.waiting, [name]: value };
        if (waiting) return;
        requestAnimationFrame(() => { Object.assign(this.given, this.waiting); this.waiting = null; this._rerun(); });
    }

    _plotted() {
        const names = this.told.plotted;
        if (!names.length) return null;
        const chosen = new Set(this.told.plots);
        const draw = () => {
            this.plotting.replaceChildren();
            this.plots = names.filter(each => chosen.has(each.name)).map((each, k) => new Plot(this, each, k));
            this.plotting.append(...this.plots.map(plot => plot.root));
            this.plots.forEach(plot => { plot.draw(); plot.cursor(this.t); });
        };
        const boxes = names.map(each => {
            const input = made("input", { type: "checkbox", "aria-label": each.name, onchange: event => { if (event.target.checked) chosen.add(each.name); else chosen.delete(each.name); draw(); } });
            input.checked = chosen.has(each.name);
            return made("label", {}, input, " ", sign(this.told, each.name));
        });
        draw();
        return made("div", { class: "plotting" }, this.plotting, made("details", {}, made("summary", {}, say("What is plotted")), made("div", { class: "options" }, ...boxes)));
    }

    // -- a body, taken by hand ------------------------------------------------------------------------

    _draggable() {
        let held = null;
        this.root.classList.add("takes");
        this.stage.addEventListener("pointerdown", event => {
            const picked = this.view.picked(event);
            if (!picked) return;
            event.preventDefault();
            event.stopImmediatePropagation();  // the picture stays as it is turned
            try { this.stage.setPointerCapture(event.pointerId); } catch { /* the pointer is gone already */ }
            this.play(false);
            this.seek(0);
            held = { ...picked, local: this._local(picked.k, picked.place) };
        });
        this.stage.addEventListener("pointermove", event => { if (held) this._drawn(held, this.view.placeOf(event, held.place)); });
        const loose = () => { if (held) { held = null; this._rerun(); this._fitted(); this.seek(0); } };
        this.stage.addEventListener("pointerup", loose);
        this.stage.addEventListener("pointercancel", loose);
    }

    /** A place of the ground in a body's axes, as it stands now. */
    _local(k, place) {
        const { scene } = this.told, frame = this.frame(this.t), none = place.map(() => 0);
        const o = inGround(scene, frame, k, none), left = place.map((v, i) => v - o[i]);
        return none.map((_, j) => {
            const e = inGround(scene, frame, k, none.map((_, i) => +(i === j)));
            return left.reduce((sum, v, i) => sum + v*(e[i] - o[i]), 0);
        });
    }

    /** Start values at which the point of the body comes nearest to the place: Gauss and Newton, damped. */
    _drawn({ k, local }, wanted) {
        const names = this.told.sliders.filter(each => each.kind === "coordinate").map(each => each.name);
        const { live, scene } = this.told;
        const at = given => {
            const { x, why } = this.motion.startFor(given);
            if (why) return null;
            const inner = this.motion.phaseState(x);
            return { x, place: inGround(scene, this.motion.of.frame(0, inner), k, local) };
        };
        for (let step = 0; step < 3; step++) {
            const here = at(this.given);
            if (!here) return;
            const left = wanted.map((v, i) => v - here.place[i]);
            const values = names.map(name => here.x[live.coordinates.indexOf(name)]);
            const columns = names.map((name, i) => {
                const there = at({ ...this.given, [name]: values[i] + 1e-6 });
                return left.map((_, j) => there ? (there.place[j] - here.place[j])*1e6 : 0);
            });
            const sum = (a, b) => columns.reduce((total, c) => total + c[a]*c[b], 0);
            const damped = 1e-3*left.reduce((total, _, j) => total + sum(j, j), 0) + 1e-12;
            const lam = solved(left.map((_, a) => left.map((_, b) => sum(a, b) + (a === b ? damped : 0))), left.slice());
            const next = { ...this.given };
            names.forEach((name, i) => { next[name] = values[i] + columns[i].reduce((total, v, j) => total + v*lam[j], 0); });
            if (!at(next)) return;
            this.given = next;
        }
        const { x } = this.motion.startFor(this.given);
        for (const slider of this.sliders) {
            const place = live.coordinates.indexOf(slider.told.name);
            if (place >= 0) slider.shown(x[place]);
        }
        this.view.update(this.motion.of.frame(0, this.motion.phaseState(x)));
    }

    // -- proof, and what a link holds ------------------------------------------------------------------

    /** "" where the programs of this page give their test vectors' numbers, and its first steps the recorded run. */
    faults() {
        const { vectors, check } = this.told, found = [];
        for (const [name, rows] of Object.entries(vectors)) {
            const { constants, evaluate } = this.motion.programs[name];
            rows.forEach((v, k) => {
                const p = Float64Array.from(v.p), got = evaluate(v.t, Float64Array.from(v.x), p, constants(p), v.inputs);
                const largest = Math.max(1, ...v.result.map(Math.abs));
                const wrong = v.result.findIndex((right, i) => right === null ? got[i] === got[i] : !(Math.abs(got[i] - right) <= v.tolerance*largest));
                if (wrong >= 0) found.push(`${name}, vector ${k}, number ${wrong}: ${got[wrong]}, not ${v.result[wrong]}`);
            });
        }
        if (this.motion && check.length) {
            const run = this.motion.run({}, { time: check[check.length - 1], rtol: 1e-10 });
            for (const t of check) {
                const right = this.recorded.at(t), got = run.at(t), most = Math.max(1, ...right.map(Math.abs));
                if (!(run.end >= t) || right.some((v, i) => !(Math.abs(got[i] - v) <= NEAR*most))) { found.push(`the motion at t = ${t} s${run.message ? `: ${run.message}` : ""}`); break; }
            }
        }
        return found.join("; ");
    }

    _remembered() {
        if (!this.told.page || location.protocol === "about:") return;  // a page in a page has no address
        const state = Object.entries(this.given).map(([name, value]) => `${encodeURIComponent(name)}=${value}`).join("&");
        history.replaceState(null, "", state ? `#${state}` : location.pathname + location.search);
    }

    /** What the link says: "#m=2&theta=0.5", SI. */
    recalled() {
        if (!this.told.moves || location.hash.length < 2) return;
        const known = [...this.told.live.parameters, ...this.told.live.coordinates, ...this.told.live.speeds];
        for (const pair of location.hash.slice(1).split("&")) {
            const [name, value] = pair.split("=").map(decodeURIComponent);
            if (known.includes(name) && value !== "" && Number.isFinite(+value)) this.given[name] = +value;
        }
        if (Object.keys(this.given).length) { this._rerun(); this._fitted(); this.seek(0); }
    }
}

/** One quantity over time. */
class Plot {
    constructor(player, told, k) {
        Object.assign(this, { player, told });
        const SVG = "http://www.w3.org/2000/svg", node = (name, attributes, parent) => { const n = document.createElementNS(SVG, name); for (const [a, v] of Object.entries(attributes)) n.setAttribute(a, v); parent.append(n); return n; };
        this.root = made("figure", { class: "plot", style: `--curve: var(--c${k % 8})` });
        this.value = made("span", { class: "value" });
        this.root.append(made("figcaption", {}, sign(player.told, told.name), `${told.unit ? ` [${written(told.unit)}]` : ""} `, this.value));
        const svg = document.createElementNS(SVG, "svg");
        svg.setAttribute("viewBox", "0 0 600 110");
        svg.setAttribute("preserveAspectRatio", "none");
        svg.setAttribute("aria-hidden", "true");
        this.zero = node("line", { class: "zero", x1: 0, x2: 600 }, svg);
        this.curve = node("polyline", { class: "curve" }, svg);
        this.line = node("line", { class: "cursor", y1: 0, y2: 110 }, svg);
        this.range = made("div", { class: "range" }, made("span", {}), made("span", {}));
        this.root.append(made("div", { class: "plotted" }, svg, this.range));
    }

    draw() {
        const { player, told } = this, { times, states, frames } = player.sampled();
        const values = times.map((t, i) => player.value(told.name, t, states[i], frames[i])/told.size);
        const finite = values.filter(Number.isFinite);
        let low = Math.min(...finite), high = Math.max(...finite);
        if (!finite.length) [low, high] = [0, 1];
        if (high - low < 1e-6*Math.max(Math.abs(low), Math.abs(high), 1e-12)) [low, high] = [low - 0.5*Math.max(Math.abs(low), 1e-3), high + 0.5*Math.max(Math.abs(high), 1e-3)];
        const y = v => 105 - 100*(v - low)/(high - low);
        this.curve.setAttribute("points", values.map((v, i) => Number.isFinite(v) ? `${(600*i/(POINTS - 1)).toFixed(1)},${y(v).toFixed(1)}` : "").join(" "));
        this.zero.setAttribute("y1", y(0)), this.zero.setAttribute("y2", y(0));
        this.range.firstChild.textContent = shown(high);
        this.range.lastChild.textContent = shown(low);
    }

    cursor(t) {
        const { player, told } = this, x = player.run.end > 0 ? 600*t/player.run.end : 0;
        this.line.setAttribute("x1", x), this.line.setAttribute("x2", x);
        const v = player.value(told.name, t)/told.size;
        this.value.textContent = `= ${shown(v)}`;
    }
}

/** A player in the page. */
export function begun(root, told, programs) {
    speak(told);
    const player = root.player = new Player(root, told, programs);
    player.recalled();
    if (!told.page) return player;
    window.eomgen = {
        get t() { return player.t; },
        get x() { return player.state(player.t); },
        get names() { return told.names; },
        get took() { return player.took; },
        state: t => player.state(t),
        seek: t => player.seek(t),
        set: (name, value) => player.set(name, value),
        selfcheck: () => player.faults(),
    };
    const faults = player.faults();
    document.body.dataset.selfcheck = faults ? "failed" : "ok";
    if (faults) root.prepend(made("p", { class: "wrong", role: "alert" }, say("The numbers of this page are wrong: {1}.", faults)));
    return player;
}
