// Scene, frame -> a picture in the plane: SVG, y up.

const SVG = "http://www.w3.org/2000/svg";
const SIZE = 1000;  // of the larger side of what moves, in units of the picture
const UNIT = 0.028;  // a symbol's unit, of the same
const LONGEST_ARROW = 0.24;  // the arrow that 98 % of a run's are shorter than, of the same
const FAR = 6;  // times its size: what goes farther is followed
const ARROWS = ["force", "reaction", "velocity"];
const AT_REST = ["dimension", "angle", "axes"];  // what only the picture at rest has

/** What arrows of one scale share: what is applied and what joints do have the same. */
export const scaleOf = mark => (mark.role === "reaction" ? "force" : mark.role) + mark.unit;

export function element(name, attributes = {}, parent = null) {
    const made = document.createElementNS(SVG, name);
    for (const [key, value] of Object.entries(attributes)) made.setAttribute(key, value);
    if (parent) parent.append(made);
    return made;
}

const numberIn = (frame, v) => typeof v === "number" ? v : frame[v[0]];
const spotIn = (frame, at) => at.map(v => numberIn(frame, v));
const hasSlots = mark => Object.values(mark).some(function slotted(v) {
    return Array.isArray(v) && (v.length === 1 && Number.isInteger(v[0]) || v.some(slotted));
});

/** The part of its way that the cylinder of a drive takes: it has one length along the motion. */
export const barrel = (mark, size) => Math.min(0.55*(mark.longest ?? size)/(size || 1), 0.9);

/** The longest way of each cylinder in some frames. */
export function longestWays(scene, frames) {
    for (const mark of scene.marks) if (mark.kind === "cylinder") {
        const sizes = frames.map(frame => Math.hypot(...spotIn(frame, mark.a).map((v, i) => v - numberIn(frame, mark.b[i]))));
        mark.longest = Math.max(0, ...sizes.filter(Number.isFinite));
    }
}

/** The place in the ground of a point of a frame, in the plane or in space. */
export function inGround(scene, frame, k, point) {
    for (; k > 0; k = scene.frames[k].parent) {
        const pose = spotIn(frame, scene.frames[k].pose), d = point.length, [c, s] = pose.slice(2);
        const R = d === 2 ? [c, -s, s, c] : pose.slice(3);
        point = point.map((_, i) => pose[i] + point.reduce((sum, v, j) => sum + R[d*i + j]*v, 0));
    }
    return point;
}

/** The points of a mark that a picture has to hold, in its own frame. */
function extremes(mark, value) {
    const spot = at => at.map(value);
    switch (mark.kind) {
        case "line": case "polygon": return mark.points.map(spot);
        case "arc": {
            const [x, y] = spot(mark.at), a = value(mark.radius), b = value(mark.radius_y);
            return [[x - a, y - b], [x + a, y - b], [x + a, y + b], [x - a, y + b]];
        }
        case "spring": case "damper": case "cylinder": case "rod": case "load": return [spot(mark.a), spot(mark.b)];
        case "point": case "symbol": return [spot(mark.at)];
        default: return [];
    }
}

export class PlaneView {
    constructor(svg, scene) {
        this.svg = svg;
        this.scene = scene;
        this.world = element("g", {}, svg);
        this.trail = element("polyline", { class: "trail" }, this.world);
        this.layers = [];
        scene.marks.filter(mark => !AT_REST.includes(mark.kind)).forEach(mark => this._added(mark));
        this.text = 14;
        this.scales = {};
    }

    /** How large the picture is, for frames of a run, and how long its arrows are. */
    fit(frames) {
        const { scene } = this, sizes = {};
        longestWays(scene, frames);
        for (const frame of frames) for (const mark of scene.marks) {
            if (mark.kind !== "arrow" || !ARROWS.includes(mark.role)) continue;
            const size = Math.hypot(...mark.vector.map(v => numberIn(frame, v)));
            if (size === size) (sizes[scaleOf(mark)] ??= []).push(size);
        }
        let [low, high] = this._corners(frames);
        const side = ([a, b]) => Math.max(b[0] - a[0], b[1] - a[1]);
        const whole = Math.max(side([low, high]), 1e-9), first = side(this._corners(frames.slice(0, 1)));
        const solid = Math.max(first, ...frames.map(frame => this._spread(frame)));
        this.away = solid > 0 && whole > FAR*solid ? this._middle(frames[0]) : null;
        if (this.away) [low, high] = this._corners(frames, frame => this._middle(frame).map((v, i) => v - this.away[i]), FAR*solid/2);
        const extent = this.away ? Math.max(side([low, high]), first) : whole, size = Number.isFinite(extent) ? extent : 1;
        this.k = SIZE/size;
        this.reach = 1.6*SIZE*Math.max(1, Number.isFinite(whole) ? whole/size : 1);
        this.unit = UNIT*SIZE;
        for (const [key, values] of Object.entries(sizes)) {
            const most = values.sort((a, b) => a - b)[Math.floor(0.98*(values.length - 1))];
            this.scales[key] = most > 0 ? LONGEST_ARROW*size/most : 0;
        }
        const pad = 0.09*SIZE, wide = Math.max(this.k*(high[0] - low[0]), 0.5*SIZE), tall = Math.max(this.k*(high[1] - low[1]), 0.4*SIZE);
        const middle = [this.k*(low[0] + high[0])/2, -this.k*(low[1] + high[1])/2];
        this.box = [middle[0] - wide/2 - pad, middle[1] - tall/2 - pad, wide + 2*pad, tall + 2*pad];
        this._looked(frames[0]);
        this.resized();
        for (const layer of this.layers) layer.drawn = false;
    }

    /** The corners of all that is drawn in some frames; of what has gone `gone(frame)` and stays within a reach, of that. */
    _corners(frames, gone = () => [0, 0], reach = Infinity) {
        const low = [Infinity, Infinity], high = [-Infinity, -Infinity];
        for (const frame of frames) {
            const off = gone(frame), value = v => numberIn(frame, v);
            for (const mark of this.scene.marks) if (!ARROWS.includes(mark.role)) for (const point of extremes(mark, value)) {
                const at = inGround(this.scene, frame, mark.frame, point).map((v, i) => v - off[i]);
                if (reach < Infinity && at.some((v, i) => Math.abs(v - this.away[i]) > reach)) continue;
                for (let i = 0; i < 2; i++) if (Number.isFinite(at[i])) {
                    low[i] = Math.min(low[i], at[i]);
                    high[i] = Math.max(high[i], at[i]);
                }
            }
        }
        return [low, high];
    }

    /** Where the bodies are, each its own place. */
    _places(frame) {
        return this.scene.frames.filter(({ parent }, k) => k && parent < 1).map(({ pose }) => spotIn(frame, pose.slice(0, 2)));
    }

    /** Where the bodies are on the whole. */
    _middle(frame) {
        const places = this._places(frame);
        return [0, 1].map(i => places.reduce((sum, at) => sum + at[i], 0)/(places.length || 1));
    }

    /** How far apart the bodies are. */
    _spread(frame) {
        const places = this._places(frame);
        return places.length ? Math.max(...[0, 1].map(i => Math.max(...places.map(at => at[i])) - Math.min(...places.map(at => at[i])))) : 0;
    }

    /** Puts the picture where it is looked at: one goes with what goes far. */
    _looked(frame) {
        const off = this.away && frame ? this._middle(frame).map((v, i) => v - this.away[i]) : [0, 0];
        if (!off.every(Number.isFinite)) return;
        const box = [this.box[0] + this.k*off[0], this.box[1] - this.k*off[1], ...this.box.slice(2)];
        this.svg.setAttribute("viewBox", box.map(v => v.toFixed(1)).join(" "));
    }

    /** Text keeps its size on the screen. */
    resized() {
        if (!this.box) return;
        const { width, height } = this.svg.getBoundingClientRect();
        const scale = Math.min(width/this.box[2], height/this.box[3]) || 1;
        this.text = 13/scale;
        this.svg.style.setProperty("--text", `${this.text.toFixed(2)}px`);
        for (const layer of this.layers) layer.drawn = false;
    }

    update(frame) {
        if (this.away) this._looked(frame);
        const where = this._placed(frame);
        for (const layer of this.layers) {
            if (layer.frame) layer.holder.setAttribute("transform", where[layer.frame]);
            if (layer.drawn && !layer.moves) continue;
            layer.drawn = true;
            layer.draw(frame, v => numberIn(frame, v));
        }
    }

    /** The transformation of each frame; nothing is seen where it has none. */
    _placed(frame) {
        const found = [[1, 0, 0, 0]];
        for (const { parent, pose } of this.scene.frames.slice(1)) {
            const [x, y, c, s] = spotIn(frame, pose), [pc, ps, px, py] = found[Math.max(parent, 0)];
            found.push([pc*c - ps*s, ps*c + pc*s, px + pc*x - ps*y, py + ps*x + pc*y]);
        }
        return found.map(([c, s, x, y]) => Number.isFinite(c + s + x + y) ? `matrix(${c} ${-s} ${s} ${c} ${this.k*x} ${-this.k*y})` : "scale(0)");
    }

    /** The way of a point: [x, y] in the ground, or none. */
    trailed(points) {
        this.trail.setAttribute("points", points.map(([x, y]) => `${(this.k*x).toFixed(1)},${(-this.k*y).toFixed(1)}`).join(" "));
    }

    /** The body under the pointer, by its frame, and where it is taken; or null. */
    picked(event) {
        const k = +(event.target.closest?.("[data-frame]")?.dataset.frame ?? 0);
        return k ? { k, place: this.placeOf(event) } : null;
    }

    /** Where the pointer is, in the ground's axes. */
    placeOf(event) {
        const at = new DOMPoint(event.clientX, event.clientY).matrixTransform(this.svg.getScreenCTM().inverse());
        return [at.x/this.k, -at.y/this.k];
    }

    _added(mark) {
        const holder = element("g", { class: `mark ${mark.role} ${mark.kind}${mark.fine ? " fine" : ""}${mark.hole ? " hole" : ""}${mark.close === "none" ? " open" : ""}` }, this.world);
        if (mark.frame) holder.dataset.frame = mark.frame;
        this.layers.push({ frame: mark.frame, holder, moves: hasSlots(mark), drawn: false, draw: this._drawer(mark, holder) });
    }

    _drawer(mark, holder) {
        const at = (point, value) => [this.k*value(point[0]), -this.k*value(point[1])];
        const shown = (made, d) => { if (d.includes("NaN")) made.setAttribute("display", "none"); else { made.removeAttribute("display"); made.setAttribute("d", d); } };
        const text = (name = "text") => { const made = element(name, {}, holder); made.textContent = mark.text; return made; };
        const put = (words, x, y) => {
            if (!Number.isFinite(x + y)) { words.setAttribute("display", "none"); return; }
            words.removeAttribute("display");
            words.setAttribute("x", x.toFixed(1));
            words.setAttribute("y", y.toFixed(1));
        };
        const path = () => element("path", {}, holder);
        const made = ["label"].includes(mark.kind) ? null : mark.kind === "symbol" ? element("g", {}, holder) : path();
        switch (mark.kind) {
            case "line": return (frame, value) => shown(made, outline(mark.points.map(p => at(p, value))));
            case "polygon": return (frame, value) => shown(made, `${outline(mark.points.map(p => at(p, value)))}Z`);
            case "arc": return (frame, value) => shown(made, arc(mark, value, this.k));
            case "rod": return (frame, value) => shown(made, outline([at(mark.a, value), at(mark.b, value)]));
            case "spring": return (frame, value) => shown(made, spring(at(mark.a, value), at(mark.b, value), this.unit, mark.side));
            case "damper": return (frame, value) => shown(made, damper(at(mark.a, value), at(mark.b, value), this.unit, mark.side));
            case "cylinder": return (frame, value) => shown(made, cylinder(at(mark.a, value), at(mark.b, value), this.unit, mark, this.k));
            case "point": return (frame, value) => shown(made, circle(at(mark.at, value), 0.3*this.unit));
            case "track": return (frame, value) => shown(made, this._track(mark, value, at));
            case "symbol":
                this.scene.symbols[mark.symbol].forEach(part => {
                    const d = part.kind === "arc" ? arc(part, v => v, 1) : outline(part.points.map(([x, y]) => [x, -y])) + (part.kind === "polygon" ? "Z" : "");
                    element("path", { d, class: `${part.role} ${part.kind}${part.fine ? " fine" : ""}${part.hole ? " hole" : ""}` }, made);
                });
                return (frame, value) => {
                    const [x, y] = at(mark.at, value), along = mark.along ? mark.along.map(value) : [1, 0], n = Math.hypot(...along);
                    const [c, s] = along.map(v => v/n*this.unit);
                    const where = `matrix(${c} ${-s} ${s} ${c} ${x} ${y})`;
                    if (where.includes("NaN")) made.setAttribute("display", "none");
                    else { made.removeAttribute("display"); made.setAttribute("transform", where); }
                };
            case "label": {
                const words = text();
                return (frame, value) => {
                    const [x, y] = at(mark.at, value);
                    put(words, x + 0.6*this.text, y - 0.5*this.text);
                };
            }
            case "arrow": {
                const words = mark.text ? text() : null;
                return (frame, value) => {
                    const tip = at(mark.at, value), scale = this.k*(this.scales[scaleOf(mark)] ?? 0);
                    const v = [scale*value(mark.vector[0]), -scale*value(mark.vector[1])], size = Math.hypot(...v);
                    const [from, to] = mark.outward ? [tip, [tip[0] + v[0], tip[1] + v[1]]] : [[tip[0] - v[0], tip[1] - v[1]], tip];
                    const hidden = !(size > 0.15*this.unit);
                    holder.setAttribute("display", hidden ? "none" : "inline");
                    if (hidden) return;
                    shown(made, arrow(from, to, Math.min(this.unit, size)));
                    if (words) put(words, from[0] + 0.4*this.text, from[1] - 0.3*this.text);
                };
            }
            case "couple": {
                const words = mark.text ? text() : null;
                return (frame, value) => {
                    const turn = value(mark.vector[2] ?? mark.vector[0]), [x, y] = at(mark.at, value);
                    shown(made, couple([x, y], turn, 1.5*this.unit));
                    if (words) put(words, Math.abs(turn) > 0 ? x + 1.5*this.unit : NaN, y - 1.5*this.unit);
                };
            }
            case "load": return (frame, value) => shown(made, load(mark, value, at, 2*this.unit));
            default: return () => {};
        }
    }

    _track(mark, value, at) {
        const [x, y] = at(mark.at, value), [dx, dy] = [value(mark.along[0]), -value(mark.along[1])], n = Math.hypot(dx, dy);
        const long = this.reach/n, a = [x - long*dx, y - long*dy], b = [x + long*dx, y + long*dy];
        if (!mark.normal) return outline([a, b]);
        const [nx, ny] = [value(mark.normal[0]), -value(mark.normal[1])], m = Math.hypot(nx, ny), deep = 0.6*this.unit/m;
        const below = ([px, py]) => [px - deep*nx, py - deep*ny];
        return `${outline([a, b, below(b), below(a)])}Z`;
    }
}

const spot = ([x, y]) => `${+x.toFixed(2)} ${+y.toFixed(2)}`;
const outline = points => points.map((p, i) => `${i ? "L" : "M"}${spot(p)}`).join("");
const circle = ([x, y], r) => `M${spot([x - r, y])}A${r} ${r} 0 1 0 ${spot([x + r, y])}A${r} ${r} 0 1 0 ${spot([x - r, y])}Z`;

/** The end of an arc that runs counter-clockwise from its start. */
export const onwards = (from, to) => to < from ? to + 2*Math.PI*Math.ceil((from - to)/(2*Math.PI)) : to;

function arc(mark, value, k) {
    const a = Math.abs(k*value(mark.radius)), b = Math.abs(k*value(mark.radius_y)), [x, y] = [k*value(mark.at[0]), -k*value(mark.at[1])];
    if (mark.start === null) return `M${x - a} ${y}A${a} ${b} 0 1 0 ${x + a} ${y}A${a} ${b} 0 1 0 ${x - a} ${y}Z`;
    const from = value(mark.start), to = onwards(from, value(mark.end)), place = w => `${x + a*Math.cos(w)} ${y - b*Math.sin(w)}`;
    const middle = (from + to)/2, sweep = to > from ? 0 : 1;
    const curve = `M${place(from)}A${a} ${b} 0 0 ${sweep} ${place(middle)}A${a} ${b} 0 0 ${sweep} ${place(to)}`;
    return mark.close === "center" ? `${curve}L${x} ${y}Z` : mark.close === "chord" ? `${curve}Z` : curve;
}

function along(a, b, side, unit) {
    const n = Math.hypot(b[0] - a[0], b[1] - a[1]) || 1, e = [(b[0] - a[0])/n, (b[1] - a[1])/n], left = [e[1], -e[0]];
    const off = (side ?? 0)*unit;
    return [n, (s, d) => [a[0] + e[0]*s + left[0]*(d + off), a[1] + e[1]*s + left[1]*(d + off)]];
}

function spring(a, b, unit, side) {
    const [n, at] = along(a, b, side, unit), turns = 7, first = 0.12*n, width = 0.55*unit;
    const points = [at(0, 0), at(first, 0)];
    for (let i = 0; i < 2*turns; i++) points.push(at(first + (i + 0.5)*(n - 2*first)/(2*turns), i % 2 ? -width : width));
    return outline([...points, at(n - first, 0), at(n, 0)]);
}

function damper(a, b, unit, side) {
    const [n, at] = along(a, b, side, unit), w = 0.5*unit, c = 0.4*n, d = 0.62*n;
    return outline([at(0, 0), at(c, 0)]) + outline([at(d, w), at(c, w), at(c, -w), at(d, -w)]) + outline([at(0.52*n, 0.8*w), at(0.52*n, -0.8*w)]) + outline([at(0.52*n, 0), at(n, 0)]);
}

function cylinder(a, b, unit, mark, k) {
    const [n, at] = along(a, b, mark.side, unit), [w, r] = [0.6*unit, 0.2*unit], d = barrel(mark, n/k)*n, c = 0.06*d;
    const shell = outline([at(c, w), at(d, w), at(d, -w), at(c, -w), at(c, w)]);
    return outline([at(0, 0), at(c, 0)]) + shell + outline([at(0.85*d, w), at(0.85*d, -w)]) + outline([at(d, r), at(n, r), at(n, -r), at(d, -r)]);
}

function arrow(from, to, head) {
    const [n, at] = along(from, to, 0, 1), w = 0.32*head;
    return `${outline([from, at(n - 0.8*head, 0)])}${outline([to, at(n - head, w), at(n - head, -w)])}Z`;
}

function couple([x, y], turn, r) {
    if (!(Math.abs(turn) > 0)) return "M0 0";
    const s = turn > 0 ? 1 : -1, place = w => [x + r*Math.cos(w), y - s*r*Math.sin(w)], tip = place(1.5*Math.PI), q = 0.35*r;
    const [there, back] = s > 0 ? [0, 1] : [1, 0];  // and back, so that nothing is inside
    return `M${spot(place(0))}A${r} ${r} 0 1 ${there} ${spot(tip)}A${r} ${r} 0 1 ${back} ${spot(place(0))}${outline([[tip[0] + q*1.4, tip[1]], [tip[0], tip[1] - q], [tip[0], tip[1] + q]])}Z`;
}

function load(mark, value, at, unit) {
    const a = at(mark.a, value), b = at(mark.b, value);
    const [fa, fb] = [mark.at_a, mark.at_b].map(v => [value(v[0]), -value(v[1])]), most = Math.max(Math.hypot(...fa), Math.hypot(...fb)) || 1;
    let d = "";
    const tails = [];
    for (let i = 0; i <= 8; i++) {
        const s = i/8, tip = [a[0] + s*(b[0] - a[0]), a[1] + s*(b[1] - a[1])], f = [fa[0] + s*(fb[0] - fa[0]), fa[1] + s*(fb[1] - fa[1])];
        const tail = [tip[0] - f[0]/most*unit, tip[1] - f[1]/most*unit];
        tails.push(tail);
        if (Math.hypot(tail[0] - tip[0], tail[1] - tip[1]) > 0.2*unit) d += arrow(tail, tip, 0.3*unit);
    }
    return d + outline(tails);
}
