// Scene, frame -> a picture in space, by three.js; z up. A drag turns it, the wheel or + and - bring it nearer.

import { barrel, longestWays, onwards, scaleOf } from "./plane.mjs";

const UNIT = 0.028;  // a symbol's unit, of the extent of what moves
const FLATTEST = 0.12;  // the shortest half-axis of an ellipsoid that one sees, of its longest
const FAR = 6;  // times its size at the start: what goes farther is followed
const LONGEST_ARROW = 0.3;  // of the same: the arrow that 98 % of a run's are shorter than
const ARROWS = ["force", "reaction", "velocity"];
const AT_REST = ["dimension", "angle", "axes", "label"];
const COLOURS = {
    body: "--c0", inertia: "--c0", member: "--c7", ground: "--soft", track: "--soft", string: "--c4", spring: "--c2", damper: "--c3", cylinder: "--c3", rim: "--c0",
    joint: "--c7", support: "--c7", contact: "--soft", point: "--ink", center: "--ink", force: "--c1", reaction: "--c6", velocity: "--c5", axes: "--soft",
};

let library = null;

/** three.js, from its text: gzip, then base64; once in a page. */
async function threeOf(packed) {
    const bytes = Uint8Array.from(atob(packed), c => c.charCodeAt(0));
    const text = await new Response(new Blob([bytes]).stream().pipeThrough(new DecompressionStream("gzip"))).text();
    const module = { exports: {} };
    new Function("exports", "module", text)(module.exports, module);
    return module.exports;
}

/** The rotation of z to what is against the weight; x stays as far to the right as it can. */
function upright(three, scene, frame) {
    const field = scene.marks.find(mark => mark.kind === "field"), z = new three.Vector3(0, 0, 1);
    if (field) z.set(...field.vector.map(v => -(typeof v === "number" ? v : frame?.[v[0]])));
    if (!(z.length() > 0)) z.set(0, 0, 1);
    z.normalize();
    const x = new three.Vector3(...(Math.abs(z.x) < 0.9 ? [1, 0, 0] : [0, 1, 0]));
    x.addScaledVector(z, -x.dot(z)).normalize();
    return new three.Matrix4().makeBasis(x, new three.Vector3().crossVectors(z, x), z);
}

export class SpaceView {
    constructor(root, scene, packed) {
        Object.assign(this, { root, scene, turn: -0.9, lift: 0.45, near: 1, frame: null, frames: null, points: [] });
        library ??= threeOf(packed);
        library.then(three => this._built(three)).catch(error => {
            root.textContent = `No picture in space: this browser has no WebGL (${error.message}).`;
        });
    }

    fit(frames) {
        this.frames = frames;
        longestWays(this.scene, frames);
        if (!this.three) return;
        this.extent = 0;
        this.away = null;
        this.floors = [];
        for (const part of this.parts) part.key = null;
        const box = new this.three.Box3(), first = new this.three.Box3(), sizes = {};
        for (const frame of frames) {
            this._drawn(frame);
            this.world.updateMatrixWorld(true);
            for (const part of this.parts) {
                if (ARROWS.includes(part.mark.role)) {
                    if (part.mark.kind !== "arrow") continue;
                    const size = Math.hypot(...part.mark.vector.map(v => typeof v === "number" ? v : frame[v[0]]));
                    if (size === size) (sizes[scaleOf(part.mark)] ??= []).push(size);
                } else if (part.holder.visible && part.mark.kind !== "track") {
                    const own = new this.three.Box3().setFromObject(part.holder);
                    if (Number.isFinite(own.min.x + own.max.x)) box.union(own);
                }
            }
            if (first.isEmpty()) first.copy(box);
        }
        if (box.isEmpty()) box.set(new this.three.Vector3(-1, -1, -1), new this.three.Vector3(1, 1, 1));
        const size = box.getSize(new this.three.Vector3());
        this.extent = Math.max(size.x, size.y, size.z, 1e-6);
        first.getSize(size);
        this.solid = Math.max(size.x, size.y, size.z) || this.extent;
        this.away = this.extent > FAR*this.solid ? this._middle(frames[0]) : null;
        this.radius = this.away ? 1.2*this.solid : 0.62*this.extent;
        this.center = (this.away ? first : box).getCenter(new this.three.Vector3());
        for (const [key, values] of Object.entries(sizes)) {
            const most = values.sort((a, b) => a - b)[Math.floor(0.98*(values.length - 1))];
            this.scales[key] = most > 0 ? LONGEST_ARROW*this.solid/most : 0;
        }
        for (const part of this.parts) part.key = null;
        this.floors = [];
        if (this.frame) this._drawn(this.frame);
        this.resized();
    }

    /** Where the bodies are on the whole. */
    _middle(frame) {
        const mean = new this.three.Vector3(), free = this.scene.frames.filter(({ parent }, k) => k && parent < 1);
        for (const { pose } of free) mean.add(new this.three.Vector3(...pose.slice(0, 3).map(v => typeof v === "number" ? v : frame[v[0]])));
        return mean.divideScalar(free.length || 1);
    }

    resized() {
        if (!this.three) return;
        const { width, height } = this.root.getBoundingClientRect();
        if (!width || !height) return;
        this.renderer.setPixelRatio(Math.min(devicePixelRatio, 2));
        this.renderer.setSize(width, height, false);
        this.camera.aspect = width/height;
        this._coloured();
        this._seen();
    }

    update(frame) {
        this.frame = frame;
        if (!this.three || !this.extent) return;
        this._drawn(frame);
        this._seen();
    }

    trailed(points) {
        this.points = points;
        if (!this.three) return;
        this.trail.geometry.dispose();
        this.trail.geometry = new this.three.BufferGeometry().setFromPoints(points.map(p => new this.three.Vector3(...p)));
        this._seen();
    }

    _built(three) {
        const { root } = this;
        this.renderer = new three.WebGLRenderer({ antialias: true, alpha: true });
        Object.assign(this, { three, scales: {}, materials: {} });
        this.renderer.domElement.style.cssText = "width: 100%; height: 100%";
        root.append(this.renderer.domElement);
        root.tabIndex = 0;
        this.world = new three.Scene();
        this.world.add(new three.HemisphereLight(0xffffff, 0x888888, 0.85));
        const sun = new three.DirectionalLight(0xffffff, 0.55);
        sun.position.set(2, -3, 5);
        this.world.add(sun);
        this.camera = new three.PerspectiveCamera(32, 1, 0.01, 100);
        this.upright = upright(three, this.scene, this.frame ?? this.frames?.[0]);
        this.camera.up.set(0, 0, 1).applyMatrix4(this.upright);
        this.groups = this.scene.frames.map(() => new three.Group());
        this.groups.forEach((group, k) => {
            group.matrixAutoUpdate = false;
            const { parent } = this.scene.frames[k];
            (k && parent > 0 ? this.groups[parent] : this.world).add(group);
        });
        this.parts = this.scene.marks.filter(mark => !AT_REST.includes(mark.kind)).map(mark => this._part(mark));
        this.words = this.scene.marks.filter(mark => mark.text && ["label", "arrow", "couple"].includes(mark.kind)).map(mark => {
            const word = document.createElement("span");
            word.className = `word ${mark.role}`;
            word.textContent = mark.text;
            root.append(word);
            return { mark, word };
        });
        this.trail = new three.Line(new three.BufferGeometry(), this._material("force", true));
        this.world.add(this.trail);
        this._handled();
        if (this.frames) this.fit(this.frames);
        this.trailed(this.points);
    }

    // -- what is drawn ------------------------------------------------------------------------------

    _material(role, line = false) {
        const key = role + line;
        if (!this.materials[key]) {
            const { three } = this, translucent = role === "inertia" ? { transparent: true, opacity: 0.35, depthWrite: false } : {};
            const above = ARROWS.includes(role) ? { depthTest: false, transparent: true } : {};
            this.materials[key] = line ? new three.LineBasicMaterial(above)
                : new three.MeshLambertMaterial({ side: three.DoubleSide, ...translucent, ...above });
            this.materials[key].userData.role = role;
        }
        return this.materials[key];
    }

    _coloured() {
        const style = getComputedStyle(this.root);
        for (const material of Object.values(this.materials))
            material.color.set(style.getPropertyValue(COLOURS[material.userData.role] ?? "--ink").trim() || "#444444");
    }

    _part(mark) {
        const holder = new this.three.Group();
        this.groups[mark.frame].add(holder);
        if (ARROWS.includes(mark.role)) holder.renderOrder = 9;
        return { mark, holder, key: null };
    }

    _drawn(frame) {
        const { three } = this, value = v => typeof v === "number" ? v : frame[v[0]];
        this.scene.frames.forEach(({ pose }, k) => {
            if (!k) return;
            const [x, y, z, ...r] = pose.map(value);
            this.groups[k].visible = Number.isFinite(x + y + z);
            this.groups[k].matrix.set(r[0], r[1], r[2], x, r[3], r[4], r[5], y, r[6], r[7], r[8], z, 0, 0, 0, 1);
        });
        const arrows = this.root.closest(".eomgen-player")?.classList.contains("forces");
        for (const part of this.parts) {
            if (ARROWS.includes(part.mark.role) && part.mark.role !== "velocity" && !arrows) { part.holder.visible = false; part.key = null; continue; }
            const numbers = this._numbers(part.mark, value), key = JSON.stringify(numbers);
            part.holder.visible = !key.includes("null,") || !numbers.flat(9).some(v => typeof v === "number" && v !== v);
            if (key === part.key || !part.holder.visible) continue;
            part.key = key;
            for (const child of [...part.holder.children]) { part.holder.remove(child); child.geometry?.dispose(); }
            const made = this._made(part.mark, value);
            if (made) part.holder.add(...[made].flat());
        }
    }

    _numbers(mark, value) {
        return Object.entries(mark).filter(([key]) => !["kind", "frame", "role", "of", "faces", "symbol", "text", "unit"].includes(key))
            .map(function resolved(v) {
                if (Array.isArray(v)) return v.length === 1 && Number.isInteger(v[0]) ? value(v) : v.map(resolved);
                return v;
            });
    }

    _made(mark, value, unit = UNIT*(this.solid ?? 0)) {
        const { three } = this, spot = at => new three.Vector3(...at.map(value)), role = mark.role ?? "joint";
        const mesh = geometry => new three.Mesh(geometry, this._material(role));
        const line = points => new three.Line(new three.BufferGeometry().setFromPoints(points), this._material(role, true));
        const at = (object, place) => { object.position.copy(place); return object; };
        const flat = outline => mesh(new three.ShapeGeometry(new three.Shape(outline)));
        switch (mark.kind) {
            case "line": return mark.fine || mark.role === "ground" ? line(mark.points.map(spot))
                : mark.points.slice(1).map((p, i) => this._bar(spot(mark.points[i]), spot(p), 0.28*unit, role));
            case "polygon": {
                if (mark.hole) return null;
                return this._faces(mark.points.map(spot), [mark.points.map((_, i) => i)], role);
            }
            case "arc": {
                if (mark.hole) return null;
                const a = value(mark.radius), b = value(mark.radius_y), whole = mark.start === null;
                const from = whole ? 0 : value(mark.start), to = whole ? 2*Math.PI : onwards(from, value(mark.end));
                const curve = new three.EllipseCurve(0, 0, a, b, from, to, false).getPoints(48);
                if (mark.close === "none") return at(line(curve.map(p => new three.Vector3(p.x, p.y, 0))), spot(mark.at));
                return at(flat(mark.close === "center" && !whole ? [new three.Vector2(0, 0), ...curve] : curve), spot(mark.at));
            }
            case "box": { const made = mesh(new three.BoxGeometry(...mark.size.map(v => Math.abs(value(v)) || 1e-6))); return at(made, spot(mark.at)); }
            case "ellipsoid": {
                const made = mesh(new three.SphereGeometry(1, 40, 24));
                const half = mark.size.map(v => Math.abs(value(v)) || 1e-6), least = FLATTEST*Math.max(...half);
                made.scale.set(...half.map(a => Math.max(a, least)));
                const rim = new three.Line(new three.BufferGeometry().setFromPoints(new three.EllipseCurve(0, 0, 1.002, 1.002, 0, 2*Math.PI).getPoints(64).map(p => new three.Vector3(p.x, 0, p.y))), this._material("ground", true));
                rim.scale.copy(made.scale);
                return mark.role === "inertia" ? [at(made, spot(mark.at))] : [at(made, spot(mark.at)), at(rim, spot(mark.at))];
            }
            case "revolution": {
                const profile = mark.profile.map(([r, z]) => new three.Vector2(Math.max(value(r), 0), value(z)));
                const made = mesh(new three.LatheGeometry(profile, 48));
                made.rotation.x = Math.PI/2;  // three turns about y
                made.scale.z = 1;
                const spoke = Math.max(...profile.map(p => p.x)), top = Math.max(...profile.map(p => p.y)), low = Math.min(...profile.map(p => p.y));
                const marks = [top, low].map(z => line([new three.Vector3(0.55*spoke, 0, z*1.002), new three.Vector3(spoke, 0, z*1.002)]));
                for (const each of marks) each.material = this._material("point", true);
                return [made, ...marks].map(each => at(each, spot(mark.at)));
            }
            case "prism": {
                const low = value(mark.low), high = value(mark.high), shape = new three.Shape(mark.points.map(p => new three.Vector2(...p.map(value))));
                const made = mesh(new three.ExtrudeGeometry(shape, { depth: high - low, bevelEnabled: false }));
                made.position.z = low;
                return made;
            }
            case "polyhedron": return this._faces(mark.points.map(spot), mark.faces, role);
            case "rod": return this._bar(spot(mark.a), spot(mark.b), 0.35*unit, role);
            case "wheel": {
                const [r, at_, n] = [value(mark.radius), spot(mark.at), spot(mark.axis).normalize()], whole = new three.Group();
                whole.add(mesh(new three.TorusGeometry(r, 0.3*unit, 8, 48)));
                for (const v of [new three.Vector3(r, 0, 0), new three.Vector3(0, r, 0)]) whole.add(...[this._bar(v.clone().negate(), v, 0.12*unit, role)].flat());
                whole.quaternion.setFromUnitVectors(new three.Vector3(0, 0, 1), n);
                return at(whole, at_);
            }
            case "spring": return this._spring(spot(mark.a), spot(mark.b), 0.6*unit, role);
            case "damper": case "cylinder": {
                const a = spot(mark.a), b = spot(mark.b), size = a.distanceTo(b);
                const half = a.clone().lerp(b, mark.kind === "cylinder" ? barrel(mark, size) : 0.6);
                return [this._bar(a, half, 0.55*unit, role), this._bar(half, b, 0.2*unit, role)];
            }
            case "track": return this._track(mark, spot, role);
            case "symbol": return this._symbol(mark, value, unit);
            case "point": return at(mesh(new three.SphereGeometry(0.35*unit, 20, 12)), spot(mark.at));
            case "arrow": {
                const scale = this.scales[scaleOf(mark)] ?? 0, v = spot(mark.vector).multiplyScalar(scale), tip = spot(mark.at);
                return v.length() < 0.15*unit ? null : this._arrow(mark.outward ? tip : tip.clone().sub(v), v, unit, role);
            }
            case "load": {
                const a = spot(mark.a), b = spot(mark.b), p = spot(mark.at_a), q = spot(mark.at_b), most = Math.max(p.length(), q.length()) || 1;
                return [...Array(8).keys()].flatMap(i => {
                    const v = p.clone().lerp(q, i/7).multiplyScalar(2.5*unit/most), tip = a.clone().lerp(b, i/7);
                    return v.length() < 0.15*unit ? [] : this._arrow(tip.sub(v), v, 0.6*unit, role);
                });
            }
            case "couple": {
                const v = spot(mark.vector), size = v.length();
                if (!(size > 0)) return null;
                v.multiplyScalar(4*unit/size);
                return [...this._arrow(spot(mark.at), v, unit, role), ...this._arrow(spot(mark.at), v.clone().multiplyScalar(0.75), unit, role)];
            }
            default: return null;
        }
    }

    _bar(a, b, radius, role) {
        const { three } = this, along = b.clone().sub(a), long = along.length();
        if (!(long > 0)) return [];
        const made = new three.Mesh(new three.CylinderGeometry(radius, radius, long, 14), this._material(role));
        made.position.copy(a).addScaledVector(along, 0.5);
        made.quaternion.setFromUnitVectors(new three.Vector3(0, 1, 0), along.multiplyScalar(1/long));
        return made;
    }

    _arrow(from, v, unit, role) {
        const { three } = this, long = v.length(), head = Math.min(1.2*unit, 0.6*long), e = v.clone().multiplyScalar(1/long);
        const tip = from.clone().add(v), cone = new three.Mesh(new three.ConeGeometry(0.38*head, head, 16), this._material(role));
        cone.position.copy(tip).addScaledVector(e, -head/2);
        cone.quaternion.setFromUnitVectors(new three.Vector3(0, 1, 0), e);
        return [this._bar(from, tip.addScaledVector(e, -head), 0.13*unit, role), cone].flat();
    }

    _spring(a, b, radius, role) {
        const { three } = this, along = b.clone().sub(a), long = along.length(), points = [], turns = 9;
        if (!(long > 0)) return [];
        for (let i = 0; i <= 160; i++) {
            const s = i/160, in_ = Math.min(1, Math.max(0, (s - 0.1)/0.8)), r = s < 0.1 || s > 0.9 ? 0 : radius, w = 2*Math.PI*turns*in_;
            points.push(new three.Vector3(r*Math.cos(w), s*long, r*Math.sin(w)));
        }
        const made = new three.Mesh(new three.TubeGeometry(new three.CatmullRomCurve3(points), 220, 0.14*radius, 6), this._material(role));
        made.position.copy(a);
        made.quaternion.setFromUnitVectors(new three.Vector3(0, 1, 0), along.multiplyScalar(1/long));
        return made;
    }

    _faces(points, faces, role) {
        const { three } = this, corners = [];
        for (const face of faces) for (let i = 1; i + 1 < face.length; i++) corners.push(points[face[0]], points[face[i]], points[face[i + 1]]);
        const geometry = new three.BufferGeometry().setFromPoints(corners);
        geometry.computeVertexNormals();
        return new three.Mesh(geometry, this._material(role));
    }

    _track(mark, spot, role) {
        const { three } = this, long = 2*(this.extent || 1), place = spot(mark.at);
        if (mark.along) {
            const e = spot(mark.along).normalize().multiplyScalar(long);
            return new three.Line(new three.BufferGeometry().setFromPoints([place.clone().sub(e), place.clone().add(e)]), this._material(role, true));
        }
        const own = this.away ? 12*this.solid : long, grid = new three.GridHelper(own, 16), normal = spot(mark.normal).normalize();
        grid.material = this._material(role, true);
        grid.position.copy(place);
        grid.quaternion.setFromUnitVectors(new three.Vector3(0, 1, 0), normal);
        if (this.away && !mark.frame) this.floors.push({ grid, place, cell: own/16 });
        return grid;
    }

    _symbol(mark, value, unit) {
        const { three } = this, group = new three.Group();
        for (const part of this.scene.symbols[mark.symbol]) group.add(...[this._made(part, v => v, 1)].flat().filter(Boolean));
        group.scale.setScalar(unit);
        group.position.set(...mark.at.map(value));
        if (mark.along) group.quaternion.setFromUnitVectors(new three.Vector3(0, 0, 1), new three.Vector3(...mark.along.map(value)).normalize());
        return group;
    }

    // -- how it is looked at ------------------------------------------------------------------------

    _seen() {
        if (!this.center) return;
        const center = this.center.clone();
        if (this.away && this.frame) center.add(this._middle(this.frame)).sub(this.away);  // it goes far: one goes with it
        for (const { grid, place, cell } of this.floors) {  // by whole cells, so that it seems to rest
            const off = center.clone().sub(place).applyQuaternion(grid.quaternion.clone().invert());
            off.set(cell*Math.round(off.x/cell), 0, cell*Math.round(off.z/cell)).applyQuaternion(grid.quaternion);
            grid.position.copy(place).add(off);
        }
        const { camera } = this, narrow = Math.min(1, camera.aspect), away = this.radius*1.08/Math.sin(camera.fov*Math.PI/360)/narrow/this.near;
        camera.position.set(Math.cos(this.lift)*Math.cos(this.turn), Math.cos(this.lift)*Math.sin(this.turn), Math.sin(this.lift)).applyMatrix4(this.upright).multiplyScalar(away).add(center);
        camera.lookAt(center);
        camera.near = away/100;
        camera.far = 20*away;
        camera.updateProjectionMatrix();
        this.renderer.render(this.world, camera);
        this._worded();
    }

    /** Names beside their places on the screen. */
    _worded() {
        if (!this.frame) return;
        const { width, height } = this.root.getBoundingClientRect();
        for (const { mark, word } of this.words) {
            const at = new this.three.Vector3(...mark.at.map(v => typeof v === "number" ? v : this.frame[v[0]]));
            at.applyMatrix4(this.groups[mark.frame].matrixWorld).project(this.camera);
            const seen = Number.isFinite(at.x + at.y);
            word.style.visibility = seen ? "visible" : "hidden";
            if (seen) word.style.transform = `translate(${(0.5*(at.x + 1)*width + 6).toFixed(1)}px, ${(0.5*(1 - at.y)*height - 18).toFixed(1)}px)`;
        }
    }

    // -- what is under the pointer --------------------------------------------------------------------

    _ray(event) {
        const { left, top, width, height } = this.root.getBoundingClientRect(), ray = new this.three.Raycaster();
        ray.setFromCamera({ x: 2*(event.clientX - left)/width - 1, y: 1 - 2*(event.clientY - top)/height }, this.camera);
        return ray;
    }

    /** The body under the pointer, by its frame, and where it is taken; or null. */
    picked(event) {
        if (!this.center) return null;
        const parts = this.parts.filter(({ mark, holder }) => mark.frame && ["body", "inertia", "member"].includes(mark.role) && holder.visible);
        const [hit] = this._ray(event).intersectObjects(parts.map(part => part.holder), true).filter(({ object }) => object.isMesh);
        if (!hit) return null;
        const { mark } = parts.find(({ holder }) => { for (let o = hit.object; o; o = o.parent) if (o === holder) return true; return false; });
        return { k: mark.frame, place: hit.point.toArray() };
    }

    /** Where the pointer is, in the ground's axes, as far away as the place that was taken. */
    placeOf(event, taken) {
        const through = new this.three.Vector3(...taken), across = this.camera.getWorldDirection(new this.three.Vector3());
        const plane = new this.three.Plane().setFromNormalAndCoplanarPoint(across, through);
        return (this._ray(event).ray.intersectPlane(plane, new this.three.Vector3()) ?? through).toArray();
    }

    _handled() {
        const { root } = this;
        const turned = (dx, dy) => { this.turn -= dx; this.lift = Math.min(1.5, Math.max(-1.5, this.lift + dy)); this._seen(); };
        const nearer = factor => { this.near = Math.min(8, Math.max(0.3, this.near*factor)); this._seen(); };
        let held = null;
        root.addEventListener("pointerdown", event => { held = [event.clientX, event.clientY]; try { root.setPointerCapture(event.pointerId); } catch { /* the pointer is gone already */ } });
        root.addEventListener("pointermove", event => {
            if (!held) return;
            turned((event.clientX - held[0])/160, (event.clientY - held[1])/160);
            held = [event.clientX, event.clientY];
        });
        for (const end of ["pointerup", "pointercancel"]) root.addEventListener(end, () => { held = null; });
        root.addEventListener("wheel", event => { event.preventDefault(); nearer(Math.exp(-event.deltaY/600)); }, { passive: false });
        root.addEventListener("keydown", event => {
            const step = { ArrowLeft: [-0.15, 0], ArrowRight: [0.15, 0], ArrowUp: [0, 0.1], ArrowDown: [0, -0.1] }[event.key];
            if (step) turned(...step); else if (event.key === "+") nearer(1.2); else if (event.key === "-") nearer(1/1.2); else return;
            event.preventDefault();
        });
    }
}
