"""The oracle's laws, each kind of joint, constraint and force for itself: tables of functions in which a test plants
errors.

Imports nothing of eomgen.
"""

from __future__ import annotations

import itertools
import re
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np
import taylor as ty
from taylor import Jet, component, cross, dot, jet, matmul, transpose, vector

Z = [0.0, 0.0, 1.0]
Rows = list[tuple[Jet, bool, str]]  # (gap or rate, is it a rate, what its multiplier is called)


def _unit(now: Any, declared: Any) -> np.ndarray:
    v = now.model.numbers(declared)
    return v / np.linalg.norm(v)


# joints: (rotation, displacement) of the child against the turned axes of the seat


def _fixed(now: Any, j: dict) -> tuple[Jet, Jet]:
    return ty.turn(_axis(now, j), now.value(j.get("angle", 0))), vector([0, 0, 0])


def _axis(now: Any, j: dict) -> np.ndarray:
    return _unit(now, j["axis"]) if "axis" in j else np.array(Z)


def _revolute(now: Any, j: dict) -> tuple[Jet, Jet]:
    return ty.turn(_axis(now, j), now.value(j["angle"])), vector([0, 0, 0])


def _along(axis: np.ndarray, s: Any) -> Jet:
    return vector([float(x) * jet(s) for x in axis])


def _prismatic(now: Any, j: dict) -> tuple[Jet, Jet]:
    return ty.turn(Z, now.value(j.get("angle", 0))), _along(_axis(now, j), now.value(j["displacement"]))


def _planar(now: Any, j: dict) -> tuple[Jet, Jet]:
    return ty.turn(Z, now.value(j.get("angle", 0))), vector([now.value(j["x"]), now.value(j["y"]), 0.0])


def _free(now: Any, j: dict) -> tuple[Jet, Jet]:
    if "position" in j:
        return _orientation(now, j), now.vector(j["position"])
    return _planar(now, j)


def _placed(now: Any, j: dict) -> tuple[Jet, Jet]:
    if "orientation" in j:
        return _orientation(now, j), vector([0, 0, 0])
    return ty.turn(_axis(now, j), now.value(j.get("angle", 0))), vector([0, 0, 0])


def _cylindrical(now: Any, j: dict) -> tuple[Jet, Jet]:
    return ty.turn(_axis(now, j), now.value(j["angle"])), _along(_axis(now, j), now.value(j["displacement"]))


def _screw(now: Any, j: dict) -> tuple[Jet, Jet]:
    s = now.value(j["angle"])
    return ty.turn(_axis(now, j), s), _along(_axis(now, j), now.value(j["pitch"]) * jet(s))


def _universal(now: Any, j: dict) -> tuple[Jet, Jet]:
    one, two = (ty.turn(_unit(now, e), now.value(x)) for e, x in zip(j["axes"], j["angles"], strict=True))
    return matmul(one, two), vector([0, 0, 0])


def _spherical(now: Any, j: dict) -> tuple[Jet, Jet]:
    return _orientation(now, j), vector([0, 0, 0])


def _path(now: Any, j: dict) -> tuple[Jet, Jet]:
    """Lines and arcs, one after another; before the first and after the last these go on."""
    s = jet(now.value(j["along"]))
    heading, begin = now.model.number(j.get("heading", 0)), 0.0
    at = vector([0, 0, 0])
    for k, piece in enumerate(j["pieces"]):
        arc = "arc" in piece
        radius = now.model.number(piece["arc"]) if arc else 0.0
        left = 1.0 if piece.get("turn") == "ccw" else -1.0
        length = radius * now.model.number(piece["angle"]) if arc else now.model.number(piece["line"])
        here = s - begin
        if here.value <= length or k == len(j["pieces"]) - 1:
            return jet(np.eye(3)), at + _on_piece(heading, here, radius, left, arc)
        end = _on_piece(heading, jet(length), radius, left, arc)
        at, begin = at + end, begin + length
        heading += left * length / radius if arc else 0.0
    raise ValueError("a path without pieces")


def _on_piece(heading: float, s: Jet, radius: float, left: float, arc: bool) -> Jet:
    if not arc:
        return vector([s * float(np.cos(heading)), s * float(np.sin(heading)), 0.0])
    turned = s * (left / radius) + heading
    x = (ty.sin(turned) - float(np.sin(heading))) * (left * radius)
    y = (float(np.cos(heading)) - ty.cos(turned)) * (left * radius)
    return vector([x, y, 0.0])


def _orientation(now: Any, j: dict) -> Jet:
    if j.get("orientation") is None:
        return jet(np.eye(3))
    if j["orientation"] == "quaternion":
        return _of_quaternion([now.q[e] for e in j["quaternion"]])
    R = jet(np.eye(3))
    for axis, angle in zip(j["orientation"], j["angles"], strict=True):
        R = matmul(R, ty.turn(np.eye(3)["xyz".index(axis)], now.value(angle)))
    return R


def _of_quaternion(e: list[Jet]) -> Jet:
    a, b, c, d = e
    rows = [
        [a * a + b * b - c * c - d * d, 2 * (b * c - a * d), 2 * (b * d + a * c)],
        [2 * (b * c + a * d), a * a - b * b + c * c - d * d, 2 * (c * d - a * b)],
        [2 * (b * d - a * c), 2 * (c * d + a * b), a * a - b * b - c * c + d * d],
    ]
    n = max(x.c.shape[-1] for x in e)
    c_ = np.array([[np.broadcast_to(x.c, (3, n)) for x in row] for row in rows])
    return Jet(np.moveaxis(c_, 2, 0))


JOINTS: dict[str, Callable] = {
    "fixed": _fixed, "revolute": _revolute, "prismatic": _prismatic, "planar": _planar, "free": _free,
    "placed": _placed, "cylindrical": _cylindrical, "screw": _screw, "universal": _universal,
    "spherical": _spherical, "path": _path,
}  # fmt: skip


def seat(now: Any, body: dict) -> tuple[Jet, Jet]:
    """(place, turned axes) of the seat of a body's joint, on the ground or its parent."""
    j = body["joint"]
    on, _, point = (j.get("on") or "").partition(".")
    p, R = now.frame(on or "ground")
    at = now.of_body(on, point) if point else now.vector(j["at"]) if "at" in j else vector([0, 0, 0])
    turned = j.get("turned", [])
    axes = R
    for one in turned if isinstance(turned, list) else [turned]:
        axes = matmul(axes, ty.turn(_axis(now, one), now.model.number(one["angle"])))
    return p + matmul(axes if j["kind"] == "placed" else R, at), axes  # of what is placed `at` is the joint's own


def pose(now: Any, body: dict) -> tuple[Jet, Jet]:
    """(place of the origin, axes) of a body as its joint says."""
    j = body.get("joint")
    if j is None:
        return vector([0, 0, 0]), jet(np.eye(3))
    place, axes = seat(now, body)
    R, d = JOINTS[j["kind"]](now, j)
    R = matmul(axes, R)
    point = now.of_body(body["name"], j["point"]) if "point" in j else vector([0, 0, 0])
    return place + matmul(axes, d) - matmul(R, point), R


# constraints


def _left(v: Jet) -> Jet:
    return vector([-component(v, 1), component(v, 0), jet(0.0)])


def _split(now: Any, point: str) -> str | None:
    body = point.rpartition(".")[0]
    return body or (point if point in now.model.bodies else None)


def _across(axis: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    other = np.eye(3)[int(np.argmin(np.abs(axis)))]
    one = np.cross(axis, other)
    one = one / np.linalg.norm(one)
    return one, np.cross(axis, one)


def _turned_since(now: Any, start: Any, body: str | None) -> Jet:
    """R(t) R(0)^T of a body."""
    if body is None:
        return jet(np.eye(3))
    R0 = start.poses[body][1].c[0][..., 0]
    return matmul(now.poses[body][1], R0.T)


def _pin(name: str, constraint: dict, now: Any, o: Any) -> Rows:
    points, plane = constraint["points"], now.model.plane
    places = [now.point(p) for p in points]
    if len(points) == 1:
        places.append(vector(o.start.point(points[0]).c[0][:, 0]))
    rows: Rows = []
    for other in places[1:]:
        gap = places[0] - other
        rows += [(component(gap, k), False, "xyz"[k]) for k in range(2 if plane else 3)]
    if "axis" in constraint:
        axis = _unit(now, constraint["axis"])
        first = matmul(_turned_since(now, o.start, _split(now, points[0])), vector(axis))
        others = [_split(now, p) for p in points[1:]] or [None]
        for body in others:
            R = _turned_since(now, o.start, body)
            rows += [(dot(matmul(R, vector(e)), first), False, "couple") for e in _across(axis)]
    return rows


def _support(name: str, constraint: dict, now: Any, o: Any) -> Rows:
    n = _unit(now, constraint["normal"])
    at = now.model.numbers(constraint["at"]) if "at" in constraint else o.start.point(constraint["point"]).c[0][:, 0]
    return [(dot(vector(n), now.point(constraint["point"]) - vector(at)), False, "n")]


def _clamp(name: str, constraint: dict, now: Any, o: Any) -> Rows:
    points = constraint.get("points") or [constraint["point"]]
    rows = _pin(name, {"points": points}, now, o)
    first = _turned_since(now, o.start, _split(now, points[0]))
    for body in [_split(now, p) for p in points[1:]] or [None]:
        turn = ty.vee(matmul(transpose(_turned_since(now, o.start, body)), first))
        rows += [(component(turn, k), False, "couple") for k in ([2] if now.model.plane else range(3))]
    return rows


def _guide(name: str, constraint: dict, now: Any, o: Any) -> Rows:
    along = _unit(now, constraint["along"])
    gap = now.point(constraint["point"]) - vector(o.start.point(constraint["point"]).c[0][:, 0])
    across = [np.array([-along[1], along[0], 0])] if now.model.plane else list(_across(along))
    rows: Rows = [(dot(vector(e), gap), False, "n") for e in across]
    turn = ty.vee(_turned_since(now, o.start, _split(now, constraint["point"])))
    return rows + [(component(turn, k), False, "couple") for k in ([2] if now.model.plane else range(3))]


def _slider(name: str, constraint: dict, now: Any, o: Any) -> Rows:
    a, b = now.model.bodies[constraint["on"]].get("line", ["start", "end"])
    A, B = (now.of_body(constraint["on"], x) for x in (a, b))
    d = (B - A).c[0][:, 0]
    d = d / np.linalg.norm(d)
    across = [np.array([-d[1], d[0], 0])] if now.model.plane else list(_across(d))
    p, R = now.poses[constraint["on"]]
    gap = now.point(constraint["point"]) - (p + matmul(R, A))
    return [(dot(matmul(R, vector(e)), gap), False, "n") for e in across]


def _link(name: str, constraint: dict, now: Any, o: Any) -> Rows:
    a, b = (now.point(p) for p in constraint["points"])
    if "length" in constraint:
        length = now.model.number(constraint["length"])
    else:
        length = float(ty.norm(o.start.point(constraint["points"][0]) - o.start.point(constraint["points"][1])).value)
    d = a - b
    return [((length**2 - dot(d, d)) / (2 * length), False, "n")]


def _radius(now: Any, body: str, constraint: dict) -> Any:
    declared = constraint.get("radius", now.model.bodies[body].get("shape", {}).get("radius"))
    return None if declared is None else now.model.number(declared)


def _meeting(constraint: dict, now: Any) -> tuple[Jet, Jet, Jet, str | None]:
    """(gap, unit normal towards the rolling body, place of contact, body of the track)."""
    body, r = constraint["body"], _radius(now, constraint["body"], constraint)
    center = now.of_body(body, constraint["center"]) if "center" in constraint else vector([0, 0, 0])
    p, R = now.poses[body]
    c = p + matmul(R, center)
    on = constraint.get("on")
    o, axes = now.frame(on or "ground")
    if "line" in constraint or "plane" in constraint:
        track = constraint.get("line") or constraint.get("plane")
        n = matmul(axes, vector(_unit(now, track["normal"])))
        at = o + matmul(axes, now.vector(track["at"]))
        gap = dot(n, c - at) - r
        if "axis" in constraint:
            return _wheel(constraint, now, R, c, n, at, r, on)
        if r is None:
            return _ellipsoid(constraint, now, R, c, n, at, on)
        return gap, n, c - _times(n, r), on
    circle = constraint.get("circle")
    middle = o + matmul(axes, now.vector(circle["at"]) if circle else vector([0, 0, 0]))
    size = now.model.number(circle["radius"]) if circle else _radius(now, on, {})
    inside = bool(circle and circle.get("inside"))
    d = c - middle
    if circle and "axis" in circle:
        e = matmul(axes, vector(_unit(now, circle["axis"])))
        d = d - _times(e, dot(e, d))
    away = _times(d, 1.0 / ty.norm(d))
    n = -away if inside else away
    gap = size - r - ty.norm(d) if inside else ty.norm(d) - size - r
    return gap, n, c - _times(n, r), on


def _wheel(constraint: dict, now: Any, R: Jet, c: Jet, n: Jet, at: Jet, r: float, on: str | None) -> tuple:
    """A thin wheel on a plane: its rim's lowest point."""
    axle = matmul(R, vector(_unit(now, constraint["axis"])))
    down = -(n - _times(axle, dot(axle, n)))
    down = _times(down, 1.0 / ty.norm(down))
    place = c + _times(down, r) - _times(n, now.model.number(constraint.get("tube", 0)))
    return dot(n, place - at), n, place, on


def _ellipsoid(constraint: dict, now: Any, R: Jet, c: Jet, n: Jet, at: Jet, on: str | None) -> tuple:
    """The place of an ellipsoid whose normal is -n."""
    declared = constraint.get("ellipsoid") or now.model.bodies[constraint["body"]]["shape"]["semiaxes"]
    square = vector(now.model.numbers(declared) ** 2)
    own = matmul(transpose(R), n)
    scaled = square * own
    place = c - matmul(R, _times(scaled, 1.0 / ty.sqrt(dot(scaled, own))))
    return dot(n, place - at), n, place, on


def _times(v: Jet, x: Any) -> Jet:
    return Jet(v.c * x) if isinstance(x, (int, float)) else Jet(jet(x).c[:, None, :]) * v


def _rolling(name: str, constraint: dict, now: Any, o: Any) -> Rows:
    gap, n, place, on = _meeting(constraint, now)
    rows: Rows = [(gap, False, "n")]
    if constraint.get("slip"):
        return rows
    v = now.velocity_at(constraint["body"], place) - now.velocity_at(on, place)
    return rows + [(dot(e, v), True, role) for e, role in _tangents(now, n, constraint, on)]


def _tangents(now: Any, n: Jet, constraint: dict, on: str | None) -> list[tuple[Jet, str]]:
    if now.model.plane:
        return [(-_left(n), "t")]
    axes = now.frame(on or "ground")[1]
    if "axis" in constraint.get("circle", {}):
        t = matmul(axes, vector(_unit(now, constraint["circle"]["axis"])))
        return [(t, "t"), (cross(n, t), "s")]
    x = component(transpose(axes), 0)
    along = x - _times(n, dot(n, x))
    if float(ty.norm(along).value) < 1e-6:
        x = component(transpose(axes), 1)
        along = x - _times(n, dot(n, x))
    t = _times(along, 1.0 / ty.norm(along))
    return [(t, "t"), (cross(n, t), "s")]


def _skate(name: str, constraint: dict, now: Any, o: Any) -> Rows:
    body = _split(now, constraint["point"])
    along = matmul(now.poses[body][1], vector(_unit(now, constraint["along"])))
    v = now.velocity_at(body, now.point(constraint["point"]))
    n = cross(vector(_unit(now, constraint["normal"]) if "normal" in constraint else Z), along)
    return [(dot(_times(n, 1.0 / ty.norm(n)), v), True, "n")]


def _beside(now: Any, items: list) -> Callable[[Jet], Jet]:
    """The left of a direction of a strand: seen along the axis of the wrap at one of its ends."""
    wrap = next((x for x in items if not isinstance(x, str)), {})
    axis = _unit(now, wrap["axis"]) if "axis" in wrap else np.array(Z)
    R = jet(np.eye(3)) if now.model.plane or "body" not in wrap else now.frame(wrap["body"])[1]
    return lambda d: cross(matmul(R, vector(axis)), d)


def _touch(now: Any, item: Any) -> tuple[Jet, str | None, float]:
    """(centre, body, signed radius) of an item of a string's path; cw is positive."""
    if isinstance(item, str):
        return now.point(item), _split(now, item), 0.0
    body = item.get("body")
    center = now.frame(body)[0] if body else now.vector(item["at"])
    r = item.get("radius")
    if r is None:
        r = now.model.bodies[body]["shape"]["radius"]
    return center, body, now.model.number(r) * (1 if item.get("turn") == "cw" else -1)


DIRECTIONS = {"up": [0, 1, 0], "down": [0, -1, 0], "left": [-1, 0, 0], "right": [1, 0, 0]}


class NoStrand(Exception):
    """What a string is said to do beyond its end."""


def _tangent(now: Any, one: Any, two: Any) -> Jet:
    """The direction of the strand that touches both."""
    (A, _, s_a), (B, _, s_b) = _touch(now, one), _touch(now, two)
    D, left = B - A, _beside(now, [one, two])
    length = ty.norm(D)
    d = _times(D, 1.0 / length)
    if not (s_a or s_b):
        return d
    sine = (s_a - s_b) / length
    return _times(d, ty.sqrt(1.0 - sine * sine)) - _times(left(d), sine)


def _string(name: str, constraint: dict, now: Any, o: Any) -> Rows:
    items, tensions, keeping = constraint["path"], [], []
    for k, (one, two) in enumerate(itertools.pairwise(items)):
        (A, body_a, s_a), (B, body_b, s_b) = _touch(now, one), _touch(now, two)
        left = _beside(now, [one, two])
        if "strands" in constraint:
            given = constraint["strands"][k]
            way = np.array(DIRECTIONS[given]) if isinstance(given, str) else _unit(now, given)
            d = vector(way)
        else:
            d = _tangent(now, one, two)
            begun = None if o.start is None else _tangent(o.start, one, two).c[0][:, 0]
            if begun is not None and max(abs(begun)) > 1 - 1e-12 and begun @ (B - A).c[0][:, 0] < 0:
                raise NoStrand(f"a strand of '{name}' that lay along an axis has run out: the product leads it on")
        a, b = A + _times(left(d), s_a), B + _times(left(d), s_b)
        v = now.velocity_at(body_b, b) if not isinstance(two, str) else now.point(two).rate()
        w = now.velocity_at(body_a, a) if not isinstance(one, str) else now.point(one).rate()
        tensions.append(-dot(d, v - w))
        if "strands" in constraint:
            keeping.append(dot(left(d), b - a))
    joined: Rows = []
    for k, (item, row) in enumerate(zip(items[:-1], tensions, strict=True)):
        through = k > 0 and (isinstance(item, str) or item.get("slip"))
        if through:
            joined[-1] = (joined[-1][0] + row, True, "n")
        else:
            joined.append((row, True, "n"))
    for row in keeping:
        if row.c.shape[-1] > 1 and np.max(np.abs(row.c[1][2:])) > 1e-12 and _moves(o, now, constraint):
            joined.append((row, False, "side"))
    return joined


def _capstan(name: str, constraint: dict, now: Any, o: Any) -> Rows:
    """One row of the mean tension: the rope slides on its drum."""
    first, drum, last = constraint["path"]
    return _string(name, {**constraint, "path": [first, {**drum, "slip": True}, last]}, now, o)


def _moves(o: Any, now: Any, constraint: dict) -> bool:
    return True


def _gear(name: str, constraint: dict, now: Any, o: Any) -> Rows:
    ratio = now.model.number(constraint["ratio"])
    if now.model.plane:
        one, two = (component(now.spin(b), 2) for b in constraint["bodies"])
        return [(one - ratio * two, True, "couple")]
    rates = []
    for b in constraint["bodies"]:
        body = now.model.bodies[b]
        axes = seat(now, body)[1]
        e = matmul(axes, vector(_axis(now, body["joint"])))
        rates.append(dot(e, now.spin(b) - now.spin(now.model.parent(body))))
    return [(rates[0] - ratio * rates[1], True, "couple")]


def _equation(name: str, constraint: dict, now: Any, o: Any) -> Rows:
    return [(jet(now.value(constraint.get("gap", constraint.get("rate")))), "rate" in constraint, "n")]


def _motion(name: str, constraint: dict, now: Any, o: Any) -> Rows:
    value = constraint["value"]
    if isinstance(value, dict) and "samples" in value:
        f = now.model.law(value, now.t.value)
        n = now.t.c.shape[-1]
        c = np.zeros((3, n))
        c[0], c[1, 0], c[2, 0] = f[0], f[1], f[2] / 2
        return [(now.q[constraint["coordinate"]] - Jet(c), False, "drive")]
    return [(now.q[constraint["coordinate"]] - now.value(value), False, "drive")]


CONSTRAINTS: dict[str, Callable] = {
    "pin": _pin, "support": _support, "clamp": _clamp, "guide": _guide, "slider": _slider, "link": _link,
    "rolling": _rolling, "skate": _skate, "string": _string, "capstan": _capstan, "gear": _gear,
    "equation": _equation, "motion": _motion,
}  # fmt: skip


def constraint_rows(name: str, constraint: dict, now: Any, o: Any) -> Rows:
    return CONSTRAINTS[constraint["kind"]](name, constraint, now, o)


# loads


@dataclass
class Load:
    """What acts: on a body at a place (ground axes), or on coordinates; a place may move in its body (`moving`)."""

    name: str
    body: str | None = None
    place: np.ndarray | None = None
    force: np.ndarray | None = None
    torque: np.ndarray | None = None
    along: dict[str, float] | None = None
    moving: Jet | None = None

    def on(self, o: Any, now: Any) -> np.ndarray:
        """Its part of F."""
        F = np.zeros(6 * len(o.bodies) + len(o.names))
        for q, x in (self.along or {}).items():
            F[6 * len(o.bodies) + o.names.index(q)] += x
        if self.body is None:
            return F
        i = o.bodies.index(self.body)
        p, R = (x.c[0][..., 0] for x in now.poses[self.body])
        center = p + R @ now.model.mass[self.body][1]
        f = np.zeros(3) if self.force is None else self.force
        torque = (np.zeros(3) if self.torque is None else self.torque) + (
            0 if self.place is None else np.cross(self.place - center, f)
        )
        F[6 * i : 6 * i + 3] += f
        F[6 * i + 3 : 6 * i + 6] += R.T @ torque
        first = 6 * len(o.bodies)
        if self.moving is not None and self.moving.c.shape[-1] == 2 + len(F):
            F[first:] += MOVING["point"](f, self.moving.c[1][:, 2 + first :])
        return F


MOVING: dict[str, Callable] = {"point": lambda f, slopes: f @ slopes}  # along coordinates that move a point in its body


def _now(x: Jet) -> np.ndarray:
    return x.c[0][..., 0]


def _number(x: Any) -> float:
    return jet(x).value


def _pair(name: str, now: Any, points: list[str], pull: Callable, along: Any = None) -> list[Load]:
    """Both ends of something between two points that draws them together with pull(distance, its rate)."""
    a, b = (now.point(p) for p in points)
    d = b - a
    if along is not None:
        e = _unit(now, along)
        r = dot(vector(e), d)
    else:
        r = ty.norm(d)
        e = _now(d) / r.value
    strength = pull(float(r.c[0][0]), float(r.c[1][0]))
    found = []
    for p, place, sense in ((points[0], a, 1), (points[1], b, -1)):
        body = _split(now, p)
        if body is not None:
            found.append(Load(name, body, _now(place), sense * strength * e, moving=place))
    return found


def _gravity(name: str, f: dict, now: Any, o: Any, s: Any) -> list[Load]:
    g = _now(now.vector(f["acceleration"]))
    found = []
    for body in f.get("bodies", o.bodies):
        m, com, _ = now.model.mass[body]
        p, R = now.poses[body]
        found.append(Load(name, body, _now(p + matmul(R, vector(com))), m * g))
    return found


def _force(name: str, f: dict, now: Any, o: Any, s: Any) -> list[Load]:
    body = _split(now, f["point"])
    force = _now(now.vector(f["force"]))
    if f.get("axes", "ground") != "ground":
        force = _now(now.poses[f["axes"]][1]) @ force
    place = now.point(f["point"])
    return [Load(name, body, _now(place), force, moving=place)] if body else []


def _bumper(name: str, f: dict, now: Any, o: Any, s: Any) -> list[Load]:
    """k x^n (1 + a x') + d x' against a compression by x > 0, and never below 0."""
    k, l0, n, a, d = (
        now.model.number(f.get(x, y))
        for x, y in (("stiffness", 0), ("length", 0), ("exponent", 1), ("dissipation", 0), ("damping", 0))
    )

    def pull(r: float, rate: float) -> float:
        x = l0 - r
        return -max(0.0, k * x**n * (1 - a * rate) - d * rate) if x > 0 else 0.0

    return _pair(name, now, f["points"], pull, f.get("along"))


def _volumes(f: dict, now: Any, r: float) -> list[float]:
    """Those of the chambers of a cylinder that is r long."""
    x = r - now.model.number(f["retracted"])
    ways = (x, now.model.number(f.get("stroke", 0)) - x)
    A, V = ([now.model.number(y) for y in f[key]] for key in ("areas", "volumes"))
    return [v + a * way for v, a, way in zip(V, A, ways, strict=False)]


def _cylinder(name: str, f: dict, now: Any, o: Any, s: Any) -> list[Load]:
    """p_1 A_1 - p_2 A_2 apart, against the pressure outside; of closed gas p = p_0 (V_0/V)^n."""
    A = [now.model.number(y) for y in f["areas"]]
    outside = now.model.number(f.get("outside", 0))
    own = [now.states.get(f"{name}_p_{k + 1}") for k in range(len(A))]

    def pull(r: float, rate: float) -> float:
        p = own
        if p[0] is None:
            begun = _volumes(f, now, _rest_length({"length": "start", **f}, now, o))
            ratios = [a / b for a, b in zip(begun, _volumes(f, now, r), strict=True)]
            n = now.model.number(f["exponent"])
            p = [now.model.number(y) * x**n for y, x in zip(f["pressures"], ratios, strict=True)]
        return -sum(sign * a * (x - outside) for sign, a, x in zip((1, -1), A, p, strict=False))

    return _pair(name, now, f["points"], pull)


def _chamber(now: Any, declared: dict) -> float:
    """p' of one chamber: E/V (Q - V') of a fluid, n/V (R T m' - p V') of a gas."""
    name, k = declared["of"], declared["chamber"]
    f, side = now.model.forces[name], (1, -1)[k]
    d = ty.norm(now.point(f["points"][1]) - now.point(f["points"][0])).c
    p = [now.states[f"{name}_p_{i + 1}"] for i in range(len(f["areas"]))]
    V, grows = _volumes(f, now, float(d[0][0]))[k], side * now.model.number(f["areas"][k]) * float(d[1][0])
    flow = _number(now.value(f["flows"][k])) if "flows" in f else 0.0
    if f["kind"] == "pneumatic_cylinder":
        n, R, T = (now.model.number(f[key]) for key in ("exponent", "gas", "temperature"))
        flow += _through_gas_valve(f["valve"], side, p[k], T, now) if "valve" in f else 0.0
        return n / V * (R * T * flow - p[k] * grows)
    flow -= side * now.model.number(f.get("leakage", 0)) * (p[0] - sum(p[1:]))
    if "valve" in f:
        v = f["valve"]
        y = side * _number(now.value(v["opening"]))
        dp = (_number(now.value(v["supply"])) - p[k]) if y > 0 else p[k] - _number(now.value(v.get("tank", 0)))
        smooth = now.model.number(v.get("smooth", 0))
        root = dp / (dp * dp + smooth * smooth) ** 0.25 if dp else 0.0
        flow += y * now.model.number(v["flow"]) * root / np.sqrt(now.model.number(v["drop"]))
    return now.model.number(f["bulk"]) / V * (flow - grows)


def _through_gas_valve(v: dict, side: int, p: float, T: float, now: Any) -> float:
    """C p_u rho_0 sqrt(T_0/T), choked up to the ratio b of pressures, beyond a quarter of an ellipse (ISO 6358)."""
    y = side * _number(now.value(v["opening"]))
    start, end = (now.model.number(v["supply"]), p) if y > 0 else (p, now.model.number(v["exhaust"]))
    high, low = max(start, end), min(start, end)
    b, smooth = now.model.number(v["critical"]), now.model.number(v.get("smooth", 0))
    ratio = low / high
    w = 1.0 if ratio <= b else np.sqrt(1 - ((ratio - b) / (1 - b)) ** 2)
    dp = min(high - low, high * (1 - b))
    w *= np.sqrt(dp / np.hypot(dp, smooth)) if dp else 0.0
    return float(y * now.model.number(v["conductance"]) * 1.185 * np.sqrt(293.15 / T) * high * w * np.sign(start - end))


def _rope(name: str, f: dict, now: Any, o: Any, s: Any) -> list[Load]:
    """k s + c s' of a rope between two points where its stretch s > 0, and never below 0."""
    k, c = (_number(now.value(f.get(x, 0))) for x in ("stiffness", "damping"))
    if f["length"] == "start":
        begun = _rest_length(f | {"points": f["path"]}, now, o)
        return _pair(name, now, f["path"], lambda r, v: max(0.0, k * (r - begun) + c * v) if r > begun else 0.0)
    slack = jet(now.value(f["length"])).c
    l0, paid = float(slack[0][0]), float(slack[1][0]) if slack.shape[-1] > 1 or len(slack) > 1 else 0.0
    return _pair(name, now, f["path"], lambda r, v: max(0.0, k * (r - l0) + c * (v - paid)) if r > l0 else 0.0)


def _stream(f: dict, now: Any) -> Jet:
    return now.vector(f["medium"]) if "medium" in f else vector([0, 0, 0])


def _at(name: str, f: dict, now: Any, force: np.ndarray) -> list[Load]:
    """A force at the point of a body."""
    body, place = _split(now, f["point"]), now.point(f["point"])
    return [Load(name, body, _now(place), force, moving=place)] if body else []


def _against(f: dict, now: Any) -> np.ndarray:
    """Velocity of the point against the fluid."""
    return _now(now.point(f["point"]).rate() - _stream(f, now))


def _drag(name: str, f: dict, now: Any, o: Any, s: Any) -> list[Load]:
    w = _against(f, now)
    rho, c, A, v = (now.model.number(f.get(x, 0)) for x in ("density", "coefficient", "area", "smooth"))
    return _at(name, f, now, -rho * c * A / 2 * np.sqrt(w @ w + v * v) * w)


def _plate(name: str, f: dict, now: Any, o: Any, s: Any) -> list[Load]:
    """Lift across the way in the plane of chord and normal, drag against it."""
    R = _now(now.poses[_split(now, f["point"])][1])
    e = R @ _unit(now, [*f.get("chord", [1, 0, 0]), 0][:3])
    n = np.cross([0, 0, 1], e) if now.model.plane else R @ _unit(now, f.get("normal", [0, 0, 1]))
    w = _against(f, now)
    a, b = w @ e, w @ n
    now.local["alpha"] = Jet(np.array([[np.arctan2(-b, a)], [0.0], [0.0]]))
    try:
        lift, drag = (_number(now.value(f.get(x, 0))) for x in ("lift", "drag"))
    finally:
        del now.local["alpha"]
    q = now.model.number(f["density"]) * now.model.number(f["area"]) / 2 * np.hypot(a, b)
    return _at(name, f, now, q * (lift * (a * n - b * e) - drag * (a * e + b * n)))


def _buoyancy(name: str, f: dict, now: Any, o: Any, s: Any) -> list[Load]:
    rho, V = (now.model.number(f[x]) for x in ("density", "volume"))
    return _at(name, f, now, rho * V * (_now(_stream(f, now).rate()) - _now(now.vector(f["acceleration"]))))


def _rolling(f: dict, now: Any) -> tuple[np.ndarray, np.ndarray, np.ndarray, float, float, float]:
    """(ahead, left, arm to the contact, |v_x|, v_y, r omega - v_x) of a wheel."""
    body = _split(now, f["point"])
    R, v = _now(now.poses[body][1]), _now(now.point(f["point"]).rate())
    flat = now.model.plane and "radius" in f
    up = _unit(now, [*f["up"], 0][:3]) if "up" in f else np.array([0.0, 1, 0] if flat else [0.0, 0, 1])
    arm, faster = np.zeros(3), 0.0
    if "radius" in f:
        axle = np.array([0.0, 0, -1]) if flat else R @ _unit(now, f.get("axle", [0, 1, 0]))
        ahead = np.cross(axle, up)
        ahead /= np.linalg.norm(ahead)
        arm = -now.model.number(f["radius"]) * np.cross(ahead, axle)
        tread = v + np.cross(_now(now.spin(body)), arm)
        faster = -tread @ ahead
    else:
        nose = R @ _unit(now, [*f.get("heading", [1, 0, 0]), 0][:3])
        ahead = nose - (nose @ up) * up
        ahead, tread = ahead / np.linalg.norm(ahead), v
        faster = _number(now.value(f.get("rolling", 0))) - v @ ahead
    left = np.cross(up, ahead)
    return ahead, left, arm, float(np.hypot(v @ ahead, now.model.number(f.get("smooth", 0)))), tread @ left, faster


def _of_slip(law: dict, s: float, now: Any) -> float:
    """c s, mu F_z (1 - (1 - x)^3) of a brush, or the magic formula."""
    if "stiffness" in law:
        c = now.model.number(law["stiffness"])
        if "grip" not in law:
            return c * s
        most = now.model.number(law["grip"])
        return float(np.sign(s)) * most * (1 - max(0.0, 1 - c * abs(s) / (3 * most)) ** 3)
    B, C, D, E = (now.model.number(law.get(x, 0)) for x in "BCDE")
    return D * np.sin(C * np.arctan(B * s - E * (B * s - np.arctan(B * s))))


def _tyre(name: str, f: dict, now: Any, o: Any, s: Any) -> list[Load]:
    if _split(now, f["point"]) is None:
        return []
    ahead, left, arm, speed, drift, faster = _rolling(f, now)
    F = np.zeros(3)
    if "combined" in f:
        aside, forward = f.get("lateral", f.get("longitudinal")), f.get("longitudinal", f.get("lateral"))
        slip = np.array(
            [now.states.get(f"{name}_kappa", faster / speed), now.states.get(f"{name}_slip", drift / speed)]
        )
        s = float(np.sqrt(slip @ slip + now.model.number(f["combined"]) ** 2))
        F = _of_slip(forward, s, now) * slip[0] / s * ahead - _of_slip(aside, s, now) * slip[1] / s * left
    elif "lateral" in f:
        F -= _of_slip(f["lateral"], np.arctan(now.states.get(f"{name}_slip", drift / speed)), now) * left
    if "longitudinal" in f and "combined" not in f:
        F += _of_slip(f["longitudinal"], now.states.get(f"{name}_kappa", faster / speed), now) * ahead
    found = _at(name, f, now, F)
    return [*found, Load(name, found[0].body, torque=np.cross(arm, F))]


def _slip(now: Any, declared: dict) -> float:
    """s' of a slip that relaxes along the way of the wheel."""
    f, own = now.model.forces[declared["of"]], declared["slip"]
    _, _, _, speed, drift, faster = _rolling(f, now)
    law = f.get("lateral" if own == "slip" else "longitudinal") or f["longitudinal" if own == "slip" else "lateral"]
    s = now.states[f"{declared['of']}_{own}"]
    return ((drift if own == "slip" else faster) - speed * s) / now.model.number(law["relaxation"])


def _gear_mesh(name: str, f: dict, now: Any, o: Any, s: Any) -> list[Load]:
    """Teeth push beyond half the play, - M on the first and ratio M on the second; the driven one gets its share."""
    first, second = f["bodies"]
    ratio, k, c, play, eta, v = (
        now.model.number(f.get(x, y))
        for x, y in (
            ("ratio", 0), ("stiffness", 0), ("damping", 0), ("backlash", 0), ("efficiency", 1), ("smooth", 1)
        )
    )  # fmt: skip
    angles = [_absolute_angle(now, b) - _absolute_angle(o.start, b) for b in (first, second)]
    rates = [float(component(now.spin(b), 2).c[0][0]) for b in (first, second)]
    x, rate = angles[0] - ratio * angles[1], rates[0] - ratio * rates[1]
    side = np.sign(x)
    M = side * max(0.0, k * (abs(x) - play / 2) + side * c * rate) if abs(x) > play / 2 else 0.0
    M = M if "backlash" in f else k * x + c * rate
    drives = np.sign(M) * np.tanh(rates[0] / v)
    shares = (1 - (1 - eta) * (1 - drives) / 2, 1 - (1 - eta) * (1 + drives) / 2)
    couples = ((first, -M * shares[0]), (second, ratio * M * shares[1]))
    return [Load(name, b, torque=np.array([0, 0, x])) for b, x in couples]


def _clutch(name: str, f: dict, now: Any, o: Any, s: Any) -> list[Load]:
    """M tanh(w/w_0) against w = omega_2 - omega_1, M = n mu N r, and none where it is not pressed."""
    first, second = f["bodies"]
    w = [float(component(now.spin(b), 2).c[0][0]) for b in (first, second)]
    parts = [f[key] for key in ("torque", "normal", "coefficient", "radius", "faces") if key in f]
    size = max(0.0, float(np.prod([_number(now.value(x)) for x in parts])))
    M = size * np.tanh((w[1] - w[0]) / now.model.number(f["smooth"]))
    return [Load(name, b, torque=np.array([0, 0, x])) for b, x in ((first, M), (second, -M))]


def _brake(name: str, f: dict, now: Any, o: Any, s: Any) -> list[Load]:
    """What friction of the joint itself would do: M tanh(s'/v) against the rate of its variable."""
    law = {key: f[key] for key in ("torque", "force", "smooth") if key in f}
    size = max(0.0, _number(now.value(f.get("torque", f.get("force")))))
    law["torque" if "torque" in law else "force"] = size
    body = now.model.bodies[f["body"]]
    kept = ("kind", "on", "at", "point", "turned", "axis", "angle", "displacement", "pitch")
    alone = {key: x for key, x in body["joint"].items() if key in kept}
    return [
        Load(name, load.body, load.place, load.force, load.torque)
        for load in _in_joint({**body, "joint": {**alone, "friction": law}}, now, o, s)
    ]


def _belt(name: str, f: dict, now: Any, o: Any, s: Any) -> list[Load]:
    """T_0 +- F/2 along its strands, F by the slip of the material: 2 T_0 (e^(mu phi) - 1)/(e^(mu phi) + 1) at most."""
    (one, two), (r, R) = f["bodies"], f["radii"]
    other = "ccw" if f.get("crossed") else "cw"
    wraps = [{"body": one, "radius": r, "turn": "cw"}, {"body": two, "radius": R, "turn": other}]
    ends, slips = [], []
    for first, second in (wraps, wraps[::-1]):
        d = _tangent(now, first, second)
        (A, a, s_a), (B, b, s_b) = _touch(now, first), _touch(now, second)
        left = _beside(now, [first, second])
        p, q = A + _times(left(d), s_a), B + _times(left(d), s_b)
        slips.append(float(dot(d, now.velocity_at(a, p) - now.velocity_at(b, q)).c[0][0]))
        ends.append((a, _now(p), b, _now(q), _now(d)))
    ratio = np.exp(now.model.number(f["coefficient"]) * now.model.number(f["wrap"]))
    T = max(0.0, _number(now.value(f["tension"])))
    F = -2 * T * (ratio - 1) / (ratio + 1) * np.tanh((slips[0] - slips[1]) / 2 / now.model.number(f["smooth"]))
    found = []
    for (a, p, b, q, d), tension in zip(ends, (T + F / 2, T - F / 2), strict=True):
        found += [Load(name, a, p, tension * d), Load(name, b, q, -tension * d)]
    return found


def _mass_flow(name: str, f: dict, now: Any, o: Any, s: Any) -> list[Load]:
    """What enters per second, times its velocity less that of the point where it was not given against the body."""
    body, place = _split(now, f["point"]), now.point(f["point"])
    flow = _now(now.vector(f["velocity"] if "velocity" in f else f["absolute"]))
    if f.get("axes", "ground") != "ground":
        flow = _now(now.poses[f["axes"]][1]) @ flow
    if "absolute" in f:
        flow = flow - place.c[1][:, 0]
    return [Load(name, body, _now(place), _number(now.value(f["rate"])) * flow, moving=place)]


def _couple(name: str, f: dict, now: Any, o: Any, s: Any) -> list[Load]:
    if isinstance(f["couple"], list):
        torque = _now(now.vector(f["couple"]))
    else:
        torque = np.array([0, 0, _number(now.value(f["couple"]))])
    if f.get("axes", "ground") != "ground":
        torque = _now(now.poses[f["axes"]][1]) @ torque
    return [Load(name, f["body"], torque=torque)]


def _distributed(name: str, f: dict, now: Any, o: Any, s: Any) -> list[Load]:
    a, b = (_now(now.point(f"{f['body']}.{x}")) for x in f["between"])
    ends = f.get("intensities") or [f["intensity"]] * 2
    p, q = (_now(now.vector(x)) for x in ends)
    x, w = np.polynomial.legendre.leggauss(3)
    length = np.linalg.norm(b - a)
    return [
        Load(name, f["body"], a + (b - a) * (1 + xi) / 2, (p + (q - p) * (1 + xi) / 2) * length * wi / 2)
        for xi, wi in zip(x, w, strict=True)
    ]


def _rest_length(f: dict, now: Any, o: Any) -> float:
    if f["length"] != "start":
        return _number(now.value(f["length"]))
    d = o.start.point(f["points"][1]) - o.start.point(f["points"][0])
    return float(np.dot(_unit(now, f["along"]), _now(d))) if "along" in f else ty.norm(d).value


def _spring(name: str, f: dict, now: Any, o: Any, s: Any) -> list[Load]:
    k, l0 = _number(now.value(f["stiffness"])), _rest_length(f, now, o)
    return _pair(name, now, f["points"], lambda r, _: k * (r - l0), f.get("along"))


def _damper(name: str, f: dict, now: Any, o: Any, s: Any) -> list[Load]:
    c = _number(now.value(f["damping"]))
    return _pair(name, now, f["points"], lambda _, rate: c * rate, f.get("along"))


def _between(name: str, f: dict, now: Any, o: Any, s: Any) -> list[Load]:
    def pull(r: float, rate: float) -> float:
        c = np.array([[r], [rate], [0.0]])
        now.local["r"] = Jet(c)
        try:
            return _number(now.value(f["pull"]))
        finally:
            del now.local["r"]

    return _pair(name, now, f["points"], pull)


def _twisted(f: dict, now: Any) -> tuple[list, float, float]:
    """([(body, sense)], angle, its rate) of a torsion element in the plane."""
    first, second = f["bodies"] if "bodies" in f else (None, f["body"])
    angles = [0.0, 0.0]
    rates = [0.0, 0.0]
    for i, b in enumerate((first, second)):
        if b is not None and b != "ground":
            angles[i] = _absolute_angle(now, b)
            rates[i] = float(component(now.spin(b), 2).c[0][0])
    pairs = [(b, sense) for b, sense in ((second, 1), (first, -1)) if b is not None and b != "ground"]
    return pairs, angles[1] - angles[0], rates[1] - rates[0]


def _absolute_angle(now: Any, body: str) -> float:
    """The angle of a body in the plane, turns counted: the sum of what the joints declare."""
    total = 0.0
    while body is not None:
        declared = now.model.bodies[body]
        j = declared.get("joint", {})
        total += _number(now.value(j.get("angle", 0)))
        turned = j.get("turned", [])
        for one in turned if isinstance(turned, list) else [turned]:
            total += now.model.number(one["angle"])
        body = now.model.parent(declared)
    return total


def _torsion_spring(name: str, f: dict, now: Any, o: Any, s: Any) -> list[Load]:
    pairs, angle, _ = _twisted(f, now)
    M = -_number(now.value(f["stiffness"])) * (angle - _number(now.value(f.get("rest", 0))))
    return [Load(name, b, torque=np.array([0, 0, sense * M])) for b, sense in pairs]


def _torsion_damper(name: str, f: dict, now: Any, o: Any, s: Any) -> list[Load]:
    pairs, _, rate = _twisted(f, now)
    M = -_number(now.value(f["damping"])) * rate
    return [Load(name, b, torque=np.array([0, 0, sense * M])) for b, sense in pairs]


def _potential(name: str, f: dict, now: Any, o: Any, s: Any) -> list[Load]:
    V = jet(now.value(f["energy"])).c
    if V.shape[-1] == 1:
        return []
    slopes = V[1][2 + 6 * len(o.bodies) :]
    return [Load(name, along={q: -float(x) for q, x in zip(o.names, slopes, strict=True)})]


def _generalized(name: str, f: dict, now: Any, o: Any, s: Any) -> list[Load]:
    return [Load(name, along={f["coordinate"]: _number(now.value(f["value"]))})]


FORCES: dict[str, Callable] = {
    "gravity": _gravity, "force": _force, "couple": _couple, "distributed": _distributed, "spring": _spring,
    "damper": _damper, "between": _between, "torsion_spring": _torsion_spring, "torsion_damper": _torsion_damper,
    "potential": _potential, "generalized": _generalized, "kinetic": lambda *_: [], "mass_flow": _mass_flow,
    "bumper": _bumper, "rope": _rope, "gear_mesh": _gear_mesh, "clutch": _clutch, "brake": _brake,
    "belt": _belt, "hydraulic_cylinder": _cylinder,
    "pneumatic_cylinder": _cylinder, "drag": _drag, "plate": _plate, "buoyancy": _buoyancy,
    "added_mass": lambda *_: [], "tyre": _tyre,
}  # fmt: skip


def _in_joint(body: dict, now: Any, o: Any, s: Any) -> list[Load]:
    """Drive, spring and damper in a joint: on the child, the opposite on the parent."""
    j = body["joint"]
    name, parent = body["name"], now.model.parent(body)
    variable = j.get("angle") if j["kind"] in ("revolute", "screw") else j.get("displacement")
    x = jet(now.value(variable)) if variable is not None else jet(0.0)
    value, rate = float(x.c[0][0]), float(x.c[1][0])
    elastic = EFFORTS["spring"](j, now, value) + EFFORTS["damper"](j, now, rate) + EFFORTS["rubbing"](j, now, rate)
    turning, pushing = EFFORTS["torque"](j, now), EFFORTS["force"](j, now)
    if j["kind"] in ("revolute", "screw"):
        turning += elastic
    elif j["kind"] == "prismatic":
        pushing += elastic
    if turning == 0 and pushing == 0:
        return []
    _place, axes = seat(now, body)
    e = _now(axes) @ _axis(now, j)
    p, R = now.poses[name]
    point = _now(p + matmul(R, now.of_body(name, j["point"]))) if "point" in j else _now(p)
    both = [(name, 1), (parent, -1)] if parent else [(name, 1)]
    return [Load(f"joint {name}", b, point, sign * pushing * e, sign * turning * e) for b, sign in both]


def _smooth(law: dict, now: Any, rate: float) -> float:
    """T tanh(s'/v) of dry friction of a given size in a joint."""
    size = law.get("torque", law.get("force"))
    return 0.0 if size is None else _number(now.value(size)) * float(np.tanh(rate / _number(now.value(law["smooth"]))))


EFFORTS: dict[str, Callable] = {
    "spring": lambda j, now, s: -_number(now.value(j.get("stiffness", 0))) * (s - _number(now.value(j.get("rest", 0)))),
    "damper": lambda j, now, rate: -_number(now.value(j.get("damping", 0))) * rate,
    "rubbing": lambda j, now, rate: -_smooth(j.get("friction", {}), now, rate),
    "torque": lambda j, now: _number(now.value(j.get("torque", 0))),
    "force": lambda j, now: _number(now.value(j.get("force", 0))),
}


def loads(o: Any, now: Any, s: Any) -> list[Load]:
    """Everything applied, at the first curve."""
    found = []
    for body in now.model.bodies.values():
        if "joint" in body:
            found += _in_joint(body, now, o, s)
    for name, f in now.model.forces.items():
        found += FORCES[f["kind"]](name, f, now, o, s)
    return found


# inertia beyond the bodies': armature, kinetic energies


def inertias(o: Any, now: Any, s: Any) -> list[tuple[np.ndarray, np.ndarray]]:
    """(M, bias) of rotors behind gears and of declared kinetic energies."""
    n, first = 6 * len(o.bodies) + len(o.names), 6 * len(o.bodies)
    found = []
    for body in now.model.bodies.values():
        j = body.get("joint", {})
        if "armature" in j:
            x = jet(now.value(j["angle"] if j["kind"] in ("revolute", "screw") else j["displacement"])).c
            if x.shape[-1] > 1:
                own = ARMATURE["armature"](now.model.number(j["armature"]))
                slope = x[1][2:]
                found.append((own * np.outer(slope, slope), own * slope * float(2 * x[2][0])))
    for f in now.model.forces.values():
        if f["kind"] in ("kinetic", "added_mass"):
            M, bias = ARMATURE[f["kind"]](o, now, s, f)
            whole, part = np.zeros((n, n)), np.zeros(n)
            i = 6 * o.bodies.index(_split(now, f["point"])) if "point" in f else first
            here = slice(i, i + len(bias))
            whole[here, here], part[here] = M, bias
            found.append((whole, part))
    return found


def _of_fluid(now: Any, f: dict) -> float:
    """xi.A xi/2 of a body in a fluid, its own axes."""
    R, A = _now(now.poses[_split(now, f["point"])][1]), _around(now, f)
    xi = np.concatenate([R.T @ _against(f, now), R.T @ _now(now.spin(_split(now, f["point"])))])
    return float(xi @ A @ xi / 2)


def _around(now: Any, f: dict) -> np.ndarray:
    """A, 6 x 6."""
    given = f.get("matrix") or f["diagonal"]
    rows = np.diag([now.model.number(x) for x in given]) if "diagonal" in f else None
    A = np.array([[now.model.number(x) for x in row] for row in given]) if rows is None else rows
    if len(A) == 6:
        return A
    whole, own = np.zeros((6, 6)), [0, 1, 5]
    whole[np.ix_(own, own)] = A
    return whole


def _added(o: Any, now: Any, s: Any, f: dict) -> tuple[np.ndarray, np.ndarray]:
    """(M, bias) in the rows of the body, its centre in ground axes and its spin in its own.

    p' + w x p and L' + w x L + v x p with (p, L) = A (v, w), v = R^T (v_C - U) + w x d.
    """
    body, A = _split(now, f["point"]), _around(now, f)
    p, R = now.poses[body]
    C, U = p + ty.matmul(R, ty.vector(now.model.mass[body][1])), _stream(f, now)
    U, U_rate = _now(U), _now(U.rate())
    turned, w = _now(R), _now(R).T @ _now(now.spin(body))
    d, past = turned.T @ (_now(now.point(f["point"])) - _now(C)), turned.T @ (_now(C.rate()) - U)
    crossed = np.array([[0, -d[2], d[1]], [d[2], 0, -d[0]], [-d[1], d[0], 0]])
    S = np.block([[turned.T, -crossed], [np.zeros((3, 3)), np.eye(3)]])
    v = past + np.cross(w, d)
    momenta = A @ np.concatenate([v, w])
    P, L = momenta[:3], momenta[3:]
    still = A @ np.concatenate([-turned.T @ U_rate - np.cross(w, past), np.zeros(3)])
    return S.T @ A @ S, S.T @ (still + np.concatenate([np.cross(w, P), np.cross(w, L) + np.cross(v, P)]))


def _kinetic(o: Any, now: Any, s: Any, f: dict) -> tuple[np.ndarray, np.ndarray]:
    """d/dt dT/dq' - dT/dq of a T that is of second degree in the rates: differences in the rates are exact."""
    n = len(o.names)
    rates = np.eye(n)

    def T(q: np.ndarray, v: np.ndarray, t: float) -> float:
        known = {name: Jet(np.array([[a], [b], [0.0]])) for name, a, b in zip(o.names, q, v, strict=True)}
        there = type(now)(now.model, Jet(np.array([[t], [1.0], [0.0]])), known)
        return _number(there.value(f["energy"]))

    def momentum(q: np.ndarray, t: float) -> np.ndarray:
        return np.array([(T(q, s.v + e, t) - T(q, s.v - e, t)) / 2 for e in rates])

    base = T(s.q, s.v, s.t)
    M = np.array(
        [[T(s.q, s.v + a + b, s.t) - T(s.q, s.v + a, s.t) - T(s.q, s.v + b, s.t) + base for b in rates] for a in rates]
    )
    h = 1e-5
    along = (momentum(s.q + h * s.v, s.t + h) - momentum(s.q - h * s.v, s.t - h)) / (2 * h)
    slope = np.array([(T(s.q + h * e, s.v, s.t) - T(s.q - h * e, s.v, s.t)) / (2 * h) for e in rates])
    return M, along - slope


ARMATURE: dict[str, Callable] = {"armature": lambda x: x, "kinetic": _kinetic, "added_mass": _added}


def own_kinetic(o: Any, now: Any) -> float:
    total = 0.0
    for body in now.model.bodies.values():
        j = body.get("joint", {})
        if "armature" in j:
            x = jet(now.value(j["angle"] if j["kind"] in ("revolute", "screw") else j["displacement"])).c
            total += now.model.number(j["armature"]) * float(x[1][0]) ** 2 / 2
    forces = now.model.forces.values()
    total += sum(_number(now.value(f["energy"])) for f in forces if f["kind"] == "kinetic")
    return total + sum(_of_fluid(now, f) for f in forces if f["kind"] == "added_mass")


def potential(o: Any, now: Any) -> float | None:
    """V of weights, springs and declared potentials; None where something else might have one."""
    V = 0.0
    for _name, f in now.model.forces.items():
        kind = f["kind"]
        if kind == "gravity":
            g = _now(now.vector(f["acceleration"]))
            for body in f.get("bodies", o.bodies):
                m, com, _ = now.model.mass[body]
                p, R = now.poses[body]
                V -= m * g @ _now(p + matmul(R, vector(com)))
        elif kind == "spring":
            a, b = (now.point(p) for p in f["points"])
            r = float(_unit(now, f["along"]) @ _now(b - a)) if "along" in f else ty.norm(b - a).value
            V += _number(now.value(f["stiffness"])) * (r - _rest_length(f, now, o)) ** 2 / 2
        elif kind == "torsion_spring":
            angle = _twisted(f, now)[1] - _number(now.value(f.get("rest", 0)))
            V += _number(now.value(f["stiffness"])) * angle**2 / 2
        elif kind == "potential":
            V += _number(now.value(f["energy"]))
        elif kind == "buoyancy":
            push = _now(_stream(f, now).rate()) - _now(now.vector(f["acceleration"]))
            V -= now.model.number(f["density"]) * now.model.number(f["volume"]) * push @ _now(now.point(f["point"]))
        elif kind not in (
            "damper",
            "torsion_damper",
            "clutch",
            "brake",
            "belt",
            "kinetic",
            "mass_flow",
            "drag",
            "plate",
            "added_mass",
        ):
            return None
    for body in now.model.bodies.values():
        j = body.get("joint", {})
        if "stiffness" in j:
            x = _number(now.value(j["angle"] if j["kind"] in ("revolute", "screw") else j["displacement"]))
            V += _number(now.value(j["stiffness"])) * (x - _number(now.value(j.get("rest", 0)))) ** 2 / 2
        if "torque" in j or "force" in j:
            return None
    return V


# states of first order


def _rate(now: Any, declared: dict) -> float:
    """z' along the motion, whose curves hold the accelerations."""
    return float(jet(now.value(declared["rate"])).c[0][0])


STATES: dict[str, Callable] = {"rate": _rate, "chamber": _chamber, "slip": _slip}


# friction, contacts, reactions


def frictions(o: Any, now: Any, rows: list) -> list[tuple[int, np.ndarray]]:
    """(row, force per unit of |N|) of each contact that rubs; one that sticks has rows of its own instead."""
    found, stuck = [], {row.owner for row in rows if row.role in ("stick t", "stick s")}
    for i, row in enumerate(rows):
        constraint = now.model.constraints.get(row.owner)
        if constraint is not None and constraint["kind"] == "capstan":
            found.append((i, _by_euler(o, now, constraint, type(row))))
            continue
        if constraint is None or row.role != "n" or "friction" not in constraint or row.owner in stuck:
            continue
        if constraint["kind"] == "rolling" and not constraint.get("slip"):
            continue
        found.append((i, rubbing(o, now, constraint)))
    return found


def at_ends(o: Any, now: Any, s: Any) -> list[tuple[tuple[str, int], np.ndarray]]:
    """((body, which end), force per unit of |N| there) of each guide with a length, both ends alike along the way."""
    found = []
    for name in o.bodies:
        law = now.model.bodies[name].get("joint", {}).get("friction")
        if isinstance(law, dict) and "length" in law:
            column = sum(load.on(o, now) for load in _along_guide(now.model.bodies[name], now))
            found += [((name, 1), column), ((name, -1), column)]
    return found


def _along_guide(body: dict, now: Any) -> list[Load]:
    """What friction does for a unit of |N|: - mu tanh(s'/v) along the way, the opposite on the parent."""
    j, name = body["joint"], body["name"]
    law, parent = j["friction"], now.model.parent(body)
    rate = float(jet(now.value(j["displacement"])).c[1][0])
    push = -_number(now.value(law["coefficient"])) * float(np.tanh(rate / _number(now.value(law["smooth"]))))
    e = _now(seat(now, body)[1]) @ _axis(now, j)
    p, R = now.poses[name]
    point = _now(p + matmul(R, now.of_body(name, j["point"]))) if "point" in j else _now(p)
    both = [(name, 1), (parent, -1)] if parent else [(name, 1)]
    return [Load(f"guide {name}", b, point, sign * push * e, np.zeros(3)) for b, sign in both]


def end_of_guide(o: Any, solved: Any, s: Any, name: str, end: int, kept: list[int], lam: np.ndarray) -> float:
    """N/2 + M/L or N/2 - M/L."""
    columns = np.zeros((6 * len(o.bodies) + len(o.names), len(kept)))
    for k, i in enumerate(kept):
        if solved.rows[i].owner == name:
            columns[:, k] = solved.J[i]
    own = _of_joint(name, o, solved.now, s, columns)
    N, M = (float(own[f"reaction_{x}({name})"][0] @ lam) for x in ("n", "couple"))
    return N / 2 + end * M / solved.now.model.number(solved.now.model.bodies[name]["joint"]["friction"]["length"])


def _by_euler(o: Any, now: Any, constraint: dict, row: Any) -> np.ndarray:
    """Force for a unit of (T_1 + T_2)/2 with T_1 = e^(mu phi) T_2: half of T_2 - T_1 on each side, along the slip."""
    one, two = (rate for rate, *_ in _string("", constraint, now, o))
    slip = 0.5 * (two - one)
    v = float(slip.c[0][0])
    if abs(v) < 1e-9:
        raise NoSliding(constraint)
    ratio = np.exp(now.model.number(constraint["coefficient"]) * now.model.number(constraint["angle"]))
    return -2 * (ratio - 1) / (ratio + 1) * np.sign(v) * np.array(row("", slip, True).parts()[0])


def sticking(o: Any, now: Any, rows: list) -> list[tuple[str, bool, Any]]:
    """(constraint, its row of rates, mu) of each closed contact with dry friction at rest: nothing slides there."""
    found = []
    for name in dict.fromkeys(row.owner for row in rows if row.role == "n"):
        constraint = now.model.constraints.get(name, {})
        if not isinstance(constraint.get("friction", {}), (int, float, str)) or (
            constraint["kind"] == "rolling" and not constraint.get("slip")
        ):
            continue
        along = slips(now, constraint)
        if max(abs(float(x.c[0][0])) for x in along) < 1e-9:
            found += [(name, x, role) for x, role in zip(along, "ts", strict=False)]
    return found


def slips(now: Any, constraint: dict) -> list[Jet]:
    """The sliding velocities of a contact along its tangents."""
    place, body, on, tangents = _sliding(now, constraint)
    v = now.velocity_at(body, place) - now.velocity_at(on, place)
    return [dot(e, v) for e in tangents]


def rubbing(o: Any, now: Any, constraint: dict) -> np.ndarray:
    place, body, on, tangents = _sliding(now, constraint)
    push = _push(now, constraint, place, body, on, tangents)
    F = Load("", body, _now(place), push).on(o, now)
    return F + Load("", on, _now(place), -push).on(o, now) if on is not None else F


def _push(now: Any, constraint: dict, place: Jet, body: Any, on: Any, tangents: list[Jet]) -> np.ndarray:
    """Force on the body for |N| = 1."""
    v = now.velocity_at(body, place) - now.velocity_at(on, place)
    slip = sum((float(dot(e, v).c[0][0]) * _now(e) for e in tangents), np.zeros(3))
    if isinstance(constraint["friction"], dict):
        return FRICTION["viscous"](now.model.number(constraint["friction"]["viscous"]), slip)
    if np.linalg.norm(slip) < 1e-9:
        raise NoSliding(constraint)
    return FRICTION["coulomb"](now.model.number(constraint["friction"]), slip)


FRICTION: dict[str, Callable] = {
    "coulomb": lambda mu, slip: -mu * slip / np.linalg.norm(slip),
    "viscous": lambda c, slip: -c * slip,
}


class NoSliding(Exception):
    """Friction at rest: no law gives its value."""


def _sliding(now: Any, constraint: dict) -> tuple[Jet, str | None, str | None, list[Jet]]:
    if constraint["kind"] == "rolling":
        _, n, place, on = _meeting(constraint, now)
        return place, constraint["body"], on, [e for e, _ in _tangents(now, n, constraint, on)]
    place = now.point(constraint["point"])
    body = _split(now, constraint["point"])
    if constraint["kind"] == "slider":
        a, b = now.model.bodies[constraint["on"]].get("line", ["start", "end"])
        d = now.of_body(constraint["on"], b) - now.of_body(constraint["on"], a)
        d = matmul(now.poses[constraint["on"]][1], _times(d, 1.0 / ty.norm(d)))
        return place, body, constraint["on"], [d]
    return place, body, None, [e for e, _ in _tangents(now, vector(_unit(now, constraint["normal"])), constraint, None)]


def _gap(name: str, o: Any, s: Any) -> Jet:
    now = o.reduced(s)
    return next(jet_ for jet_, rate, role in constraint_rows(name, o.model.constraints[name], now, o) if role == "n")


def touches(name: str, o: Any, s: Any) -> bool:
    c = _gap(name, o, s).c
    return abs(c[0][0]) < 1e-6 and abs(c[1][0]) < 1e-6


def agrees(name: str, o: Any, s: Any, solved: Any) -> bool:
    """A closed contact pushes (a string pulls); an open one opens."""
    if solved.closed[name]:
        kept, lam, _ = holding(o, solved)
        found = {solved.rows[i].owner: x for i, x in zip(kept, lam, strict=True) if solved.rows[i].role == "n"}
        return found[name] >= -1e-9
    now = o.reduced(s, solved.a)
    c = next(j for j, rate, role in constraint_rows(name, o.model.constraints[name], now, o) if role == "n").c
    return float(c[2][0]) >= -1e-9


def modes_at_start(o: Any, x0: np.ndarray, e: Any) -> dict[str, bool]:
    """Which contacts are closed at the start: those that touch and are pressed."""
    if not o.modes:
        return {}
    n = len(o.names)
    o.modes = {name: abs(_gap(name, o, o.consistent_or_not(x0[:n])).c[0][0]) < 1e-6 for name in o.modes}
    s = o.of_speeds(0.0, x0[:n], e.speeds, x0[n:])
    return o.contacts(s).closed


UNHELD = ("placed", "free")


def holding(o: Any, solved: Any) -> tuple[list[int], np.ndarray, np.ndarray]:
    """(rows that hold, their multipliers, what may be added to them) by the balance of all bodies.

    What only says where a body is (`placed`, `free`) holds nothing; the rows of the balance along coordinates on which
    such a saying depends are left out with it.
    """
    now, first = solved.now, 6 * len(o.bodies)
    unheld = UNHELD + (("planar",) if now.model.plane else ())
    loose = {
        name
        for name, b in now.model.bodies.items()
        if b.get("joint", {"kind": "fixed"})["kind"] in unheld and not _carried_by_drives(solved, name, o)
    }
    kept = [i for i, row in enumerate(solved.rows) if row.owner not in loose]
    shut = np.ones(first + len(o.names), bool)
    for i, row in enumerate(solved.rows):
        if row.owner in loose:
            shut[first:] &= np.abs(solved.J[i][first:]) < 1e-12
    need = (solved.M @ solved.z - solved.F)[shut]
    from oracle import least_squares

    push = solved.J.T[:, kept][shut]
    lam, null = np.zeros(len(kept)), [np.zeros((0, len(kept)))]
    for rows, columns in _parts(push):
        part = push[np.ix_(rows, columns)]
        x, free = least_squares(part, need[rows])
        lam[columns] = x
        if np.max(np.abs(part @ x - need[rows]), initial=0.0) > 1e-6 * (1 + np.max(np.abs(need))):
            free = np.eye(len(columns))  # something holds these bodies that has no name
        own = np.zeros((len(free), len(kept)))
        own[:, columns] = free
        null.append(own)
    return kept, lam, np.vstack(null)


def _carried_by_drives(solved: Any, name: str, o: Any) -> bool:
    """Whether all that a joint moves with is driven: its drives then hold the body against what carries it.

    What is placed, and moves with anything that is driven or with time, is held as it is placed: without work on what
    is free.
    """
    first = 6 * len(o.bodies)
    rows = [solved.J[i][first:] for i, row in enumerate(solved.rows) if row.owner == name]
    used = [q for k, q in enumerate(o.names) if any(abs(row[k]) > 1e-12 for row in rows)]
    joint = solved.now.model.bodies[name]["joint"]
    if joint["kind"] == "placed":
        return bool(set(used) & set(solved.now.model.driven)) or re.search(r"\bt\b", str(joint)) is not None
    return bool(used) and set(used) <= set(solved.now.model.driven)


def _parts(A: np.ndarray) -> list[tuple[np.ndarray, np.ndarray]]:
    """(rows, columns) of the parts of a matrix that have nothing to do with one another."""
    full, left, found = np.abs(A) > 1e-12, set(range(A.shape[1])), []
    while left:
        columns = {min(left)}
        while True:
            rows = np.flatnonzero(full[:, sorted(columns)].any(axis=1))
            more = set(np.flatnonzero(full[rows].any(axis=0))) | columns
            if more == columns:
                break
            columns = more
        left -= columns
        found.append((rows, np.array(sorted(columns))))
    return found


def reactions(o: Any, solved: Any, s: Any) -> dict[str, float]:
    """Reactions that have one value, by the product's names: force and couple of joints on the child, those of
    constraints."""
    now = solved.now
    kept, lam, null = holding(o, solved)
    size = float(np.max(np.abs(lam), initial=1.0))

    def sure(parts: dict[str, np.ndarray]) -> dict[str, float]:
        """Of combinations of the multipliers those that have one value."""
        kind = {key: g for key, g in parts.items() if not null.size or np.max(np.abs(null @ g)) < 1e-6}
        return {key: float(g @ lam) for key, g in kind.items()}

    found: dict[str, float] = {}
    for name in o.bodies:
        mine = [k for k, i in enumerate(kept) if solved.rows[i].owner == name]
        if mine and "joint" in now.model.bodies[name]:
            columns = np.zeros((6 * len(o.bodies) + len(o.names), len(kept)))
            for k in mine:
                columns[:, k] = solved.J[kept[k]]
            own = _of_joint(name, o, now, s, columns)
            for key, x in sure({key: g for key, (g, _) in own.items()}).items():
                found[key] = x + own[key][1] + _rubbed_along(name, key, solved)
    for name, constraint in now.model.constraints.items():
        mine = [k for k, i in enumerate(kept) if solved.rows[i].owner == name]
        units = np.eye(len(kept))
        found |= sure(_of_constraint(name, constraint, now, [(solved.rows[kept[k]].role, units[k]) for k in mine]))
        if not solved.closed.get(name, True):
            found |= {key: 0.0 for key in _of_constraint(name, constraint, now, [("n", None)])}
        if name in solved.pressed and constraint["kind"] != "capstan":
            found |= _rubbed(name, constraint, now, solved.pressed[name])
    for k, i in enumerate(kept):
        row = solved.rows[i]
        if row.role == "drive":
            q = row.owner[6:] if row.owner.startswith("drive ") else now.model.constraints[row.owner]["coordinate"]
            found |= sure({f"drive({q})": np.eye(len(kept))[k]})
    return {key: x for key, x in found.items() if abs(x) < 1e9 * size}


def _rubbed_along(name: str, key: str, solved: Any) -> float:
    """What the friction of a guide adds to the force of its joint along an axis."""
    P, axis = solved.pressed.get(f"guide {name}", 0.0), key.partition("(")[0].removeprefix("reaction_")
    if not P or axis not in ("x", "y", "z"):
        return 0.0
    return P * float(_along_guide(solved.now.model.bodies[name], solved.now)[0].force["xyz".index(axis)])


def _rubbed(name: str, constraint: dict, now: Any, pressed: float) -> dict[str, float]:
    place, body, on, tangents = _sliding(now, constraint)
    push = _push(now, constraint, place, body, on, tangents) * pressed
    if constraint["kind"] == "slider":
        return {}
    return {f"reaction_{role}({name})": float(_now(e) @ push) for e, role in zip(tangents, "ts", strict=False)}


def _of_joint(name: str, o: Any, now: Any, s: Any, columns: np.ndarray) -> dict[str, tuple[np.ndarray, float]]:
    """{name: (combination of the multipliers, what drives and springs add)}."""
    i = o.bodies.index(name)
    W = columns[6 * i : 6 * i + 6]
    p, R = (_now(x) for x in now.poses[name])
    center = p + R @ now.model.mass[name][1]
    j = now.model.bodies[name]["joint"]
    point = p + R @ _now(now.of_body(name, j["point"])) if "point" in j else p
    lever = point - center
    cross = np.array([[0, -lever[2], lever[1]], [lever[2], 0, -lever[0]], [-lever[1], lever[0], 0]])
    own = np.zeros(6)
    for load in _in_joint(now.model.bodies[name], now, o, s):
        if load.body == name:
            own += load.on(o, now)[6 * i : 6 * i + 6]
    f, torque = W[:3], R @ W[3:] - cross @ W[:3]
    f_own, torque_own = own[:3], R @ own[3:] - cross @ own[:3]
    found = {f"reaction_{'xyz'[k]}({name})": (f[k], float(f_own[k])) for k in range(2 if now.model.plane else 3)}
    found |= {key: (g @ f, 0.0) for key, g in _guiding(name, now).items()}
    if now.model.plane:
        return found | {f"reaction_couple({name})": (torque[2], float(torque_own[2]))}
    return found | {f"reaction_couple_{'xyz'[k]}({name})": (torque[k], float(torque_own[k])) for k in range(3)}


def _guiding(name: str, now: Any) -> dict[str, np.ndarray]:
    """The normal force of a guide or path in the plane: to the left of the way that it leaves."""
    body = now.model.bodies[name]
    j = body["joint"]
    if j["kind"] not in ("prismatic", "path") or not now.model.plane:
        return {}
    axes = seat(now, body)[1]
    if j["kind"] == "prismatic":
        way = _now(axes) @ _axis(now, j)
    else:
        one, two = (_path(now, j | {"along": f"({j['along']}) + {h}"})[1] for h in (1e-6, -1e-6))
        way = _now(axes) @ (_now(one) - _now(two)) / 2e-6
    return {f"reaction_n({name})": np.array([-way[1], way[0], 0])}


def holds(o: Any, solved: Any) -> bool:
    """Whether every contact that sticks is held by less than mu N."""
    kept, lam, _ = holding(o, solved)
    by_role = {(solved.rows[i].owner, solved.rows[i].role): x for i, x in zip(kept, lam, strict=True)}
    for name in {owner for owner, role in by_role if role.startswith("stick")}:
        mu = solved.now.model.number(solved.now.model.constraints[name]["friction"])
        along = [x for (owner, role), x in by_role.items() if owner == name and role.startswith("stick")]
        if np.linalg.norm(along) > STICKING["least"](mu, abs(by_role[name, "n"])):
            return False
    return True


STICKING: dict[str, Callable] = {"least": lambda mu, N: mu * N * (1 + 1e-9)}
IMPACTS: dict[str, Callable] = {"cone": lambda mu: mu}  # the impulse of friction over the normal one, at most


def _of_constraint(name: str, constraint: dict, now: Any, rows: list[tuple[str, Any]]) -> dict[str, Any]:
    kind = constraint["kind"]
    rows = [(role.removeprefix("stick "), x) for role, x in rows]
    plane = now.model.plane
    if not rows:
        return {}
    if kind == "pin" and len(constraint["points"]) <= 2:
        return {f"reaction_{role}({name})": x for role, x in rows if role in ("x", "y", "z")}
    if kind in ("support", "slider", "rolling", "skate") and (plane or kind != "slider"):
        return {f"reaction_{role}({name})": x for role, x in rows}
    if kind == "guide" and plane:
        return {f"reaction_{'couple' if role == 'couple' else 'n'}({name})": x for role, x in rows}
    if kind == "clamp" and plane and len(constraint.get("points", [0])) <= 2:
        return {f"reaction_{role}({name})": x for role, x in rows}
    if kind == "link":
        return {f"tension({name})": rows[0][1]}
    if kind == "capstan":
        return {f"tension({name})": rows[0][1]}
    if kind == "string":
        strands = [x for role, x in rows if role == "n"]
        return {f"tension({name}, {k + 1})" if k else f"tension({name})": x for k, x in enumerate(strands)}
    if kind == "equation":
        return {f"multiplier({name})": rows[0][1]}
    if kind == "gear" and plane:
        return {f"reaction_couple({name})": rows[0][1]}
    return {}
