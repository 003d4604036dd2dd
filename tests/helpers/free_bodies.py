"""Reactions of a model from its text alone, in plain floats: Newton and Euler for every body, nothing of eomgen's laws.

The text is read by tomllib, its formulas by eomgen's parser. Motion goes outward along the tree in ground axes, every
body gets its own six equations about the ground's origin, and all of them are solved at once for accelerations and
reactions; what the null space touches is indeterminate.
"""

from __future__ import annotations

import math
import tomllib
from collections.abc import Iterator
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Any

import numpy as np

from eomgen.symbolic.expression.text import parse

Z = np.array([0.0, 0.0, 1.0])
Rates = dict[str, float]
Wrench = tuple[int, np.ndarray, np.ndarray, np.ndarray]  # on a body (-1: ground): force, couple, place [ground axes]


def rotation(axis: np.ndarray, angle: float) -> np.ndarray:
    """Rodrigues: R = 1 + sin(angle) K + (1 - cos(angle)) K^2, K = axis x."""
    x, y, z = np.asarray(axis, float) / np.linalg.norm(axis)
    K = np.array([[0, -z, y], [z, 0, -x], [-y, x, 0]])
    return np.eye(3) + math.sin(angle) * K + (1 - math.cos(angle)) * K @ K


@dataclass(frozen=True)
class Place:
    """A body in motion: its axes R and origin p, and w, v, alpha, a of them, in ground axes."""

    R: np.ndarray
    p: np.ndarray
    w: np.ndarray
    v: np.ndarray
    alpha: np.ndarray
    a: np.ndarray

    def point(self, r: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Position, velocity and acceleration of the point r of the body."""
        d = self.R @ r
        spin = np.cross(self.w, d)
        return self.p + d, self.v + spin, self.a + np.cross(self.alpha, d) + np.cross(self.w, spin)


AT_REST = Place(np.eye(3), *(np.zeros(3) for _ in range(5)))


@dataclass(frozen=True)
class Tree:
    """A model's table at one state: coordinates q and rates u of all of them, driven ones included, and time t."""

    table: dict[str, Any]
    q: Rates
    u: Rates
    t: float

    # -- reading -----------------------------------------------------------------------------------

    @cached_property
    def names(self) -> list[str]:
        return list(self.table["bodies"])

    @cached_property
    def free(self) -> list[str]:
        return [q for q, value in self.table["coordinates"].items() if not isinstance(value, dict)]

    @cached_property
    def given(self) -> Rates:
        """Accelerations of the driven coordinates."""
        found = {}
        for q, law in self.table["coordinates"].items():
            if isinstance(law, dict):
                A, w, t = self.number("A"), self.number("w"), self.t
                found[q] = {"motion": -A * w * w * math.sin(w * t), "rate": w, "acceleration": A * math.cos(w * t)}[
                    next(iter(law))
                ]
        return found

    def number(self, value: Any) -> float:
        if not isinstance(value, str):
            return float(value)
        known = {name: float(x) for name, x in self.table["parameters"].items()}
        known |= self.q | {f"{q}'": x for q, x in self.u.items()} | {"pi": math.pi, "t": self.t}
        known["tau"] = known["A"] * math.sin(self.t)
        return float(parse(value).evaluate(known))

    def vector(self, entries: Any) -> np.ndarray:
        found = [self.number(x) for x in entries]
        return np.array(found + [0.0] * (3 - len(found)))

    def own_point(self, body: str, name: str) -> np.ndarray:
        table = self.table["bodies"][body]
        if name == "center":
            return self.vector(table.get("center", [0]))
        return np.zeros(3) if name == "origin" else self.vector(table["points"][name])

    def place(self, point: str) -> tuple[int, np.ndarray]:
        """Body and place on it; the ground is -1."""
        body, _, name = point.partition(".")
        if not name:
            return -1, self.vector(self.table["points"][point])
        return self.names.index(body), self.own_point(body, name)

    @cached_property
    def parents(self) -> list[int]:
        seats = [self.table["bodies"][body]["joint"].get("on", "").partition(".")[0] for body in self.names]
        return [self.names.index(seat) if seat else -1 for seat in seats]

    # -- outward: places, rates, accelerations -------------------------------------------------------

    def moved(self, u: Rates, a: Rates) -> list[Place]:
        """Every body, with the rates u and the accelerations a of the coordinates (0 where not named)."""
        found: list[Place] = []
        for body, parent in zip(self.names, self.parents, strict=True):
            found.append(self._hung(body, AT_REST if parent < 0 else found[parent], u, a))
        return found

    def _hung(self, body: str, parent: Place, u: Rates, a: Rates) -> Place:
        joint = self.table["bodies"][body]["joint"]
        on, _, name = joint.get("on", "").partition(".")
        seat = self.own_point(on, name) if name else self.vector(joint.get("at", [0]))
        R = parent.R @ self._turned(joint)
        p, v, acc = parent.point(seat)
        w, alpha = parent.w, parent.alpha
        for axis, s in self._slides(joint):
            d, rate = R @ axis * self._value(s, self.q), R @ axis * self._value(s, u)
            v, acc = (
                v + np.cross(w, d) + rate,
                acc
                + np.cross(alpha, d)
                + np.cross(w, np.cross(w, d))
                + 2 * np.cross(w, rate)
                + R @ axis * self._value(s, a),
            )
            p = p + d
        angle = joint.get("angle", 0)
        axis = self.vector(joint["axis"]) if "axis" in joint and joint["kind"] != "prismatic" else Z
        z = R @ axis / np.linalg.norm(axis)
        rate = z * self._value(angle, u)
        alpha = alpha + z * self._value(angle, a) + np.cross(w, rate)
        w = w + rate
        R = R @ rotation(axis, self.q[angle] if angle in self.q else self.number(angle))
        origin = Place(R, p, w, v, alpha, acc).point(-self.own_point(body, joint.get("point", "origin")))
        return Place(R, origin[0], w, origin[1], alpha, origin[2])

    def _value(self, s: Any, values: Rates) -> float:
        return values.get(s, 0.0) if isinstance(s, str) else 0.0

    def _turned(self, joint: dict[str, Any]) -> np.ndarray:
        turned = joint.get("turned")
        return np.eye(3) if turned is None else rotation(turned.get("axis", Z), self.number(turned["angle"]))

    def _slides(self, joint: dict[str, Any]) -> list[tuple[np.ndarray, str]]:
        if joint["kind"] == "prismatic":
            axis = self.vector(joint["axis"])
            return [(axis / np.linalg.norm(axis), joint["displacement"])]
        if joint["kind"] in ("planar", "free"):
            return [(np.array([1.0, 0, 0]), joint["x"]), (np.array([0, 1.0, 0]), joint["y"])]
        return []

    # -- forces ------------------------------------------------------------------------------------

    @cached_property
    def here(self) -> list[Place]:
        return self.moved(self.u, self.given)

    def at(self, spot: tuple[int, np.ndarray]) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Position, velocity and acceleration (free accelerations 0) of a place."""
        body, r = spot
        return (AT_REST if body < 0 else self.here[body]).point(r)

    def applied(self) -> Iterator[Wrench]:
        """Every given force and couple, what acts in joints left out."""
        for force in self.table["forces"].values():
            yield from getattr(self, f"_{force['kind']}")(force)

    def _gravity(self, force: dict[str, Any]) -> Iterator[Wrench]:
        for i, body in enumerate(self.names):
            spot = (i, self.own_point(body, "center"))
            weight = self.number(self.table["bodies"][body]["mass"]) * self.vector(force["acceleration"])
            yield i, weight, np.zeros(3), self.at(spot)[0]

    def _force(self, force: dict[str, Any]) -> Iterator[Wrench]:
        spot = self.place(force["point"])
        yield spot[0], self._along(force) @ self.vector(force["force"]), np.zeros(3), self.at(spot)[0]

    def _couple(self, force: dict[str, Any]) -> Iterator[Wrench]:
        given = force["couple"]
        couple = self.vector(given) if isinstance(given, list) else self.number(given) * Z
        yield self.names.index(force["body"]), np.zeros(3), self._along(force) @ couple, np.zeros(3)

    def _along(self, force: dict[str, Any]) -> np.ndarray:
        axes = force.get("axes", "ground")
        return np.eye(3) if axes == "ground" else self.here[self.names.index(axes)].R

    def _between_points(self, force: dict[str, Any]) -> tuple[Any, Any, np.ndarray, float, float]:
        """Both spots, the unit vector between them (or `along`), the distance along it and its rate."""
        first, second = (self.place(point) for point in force["points"])
        (p, v, _), (p2, v2, _) = self.at(first), self.at(second)
        d, rate = p2 - p, v2 - v
        n = self.vector(force["along"]) if "along" in force else d
        n = n / np.linalg.norm(n)
        return first, second, n, float(n @ d), float(n @ rate)

    def _pulled(self, force: dict[str, Any], pull: float) -> Iterator[Wrench]:
        first, second, n, _, _ = self._between_points(force)
        yield first[0], pull * n, np.zeros(3), self.at(first)[0]
        yield second[0], -pull * n, np.zeros(3), self.at(second)[0]

    def _spring(self, force: dict[str, Any]) -> Iterator[Wrench]:
        stretch = self._between_points(force)[3] - self.number(force["length"])
        yield from self._pulled(force, self.number(force["stiffness"]) * stretch)

    def _damper(self, force: dict[str, Any]) -> Iterator[Wrench]:
        yield from self._pulled(force, self.number(force["damping"]) * self._between_points(force)[4])

    def _between(self, force: dict[str, Any]) -> Iterator[Wrench]:
        _, _, _, r, rate = self._between_points(force)
        pull = force["pull"].replace("r'", f"({rate!r})").replace("/r^2", f"/({r!r})^2")
        yield from self._pulled(force, self.number(pull))

    def _torsion_spring(self, force: dict[str, Any]) -> Iterator[Wrench]:
        body = self.names.index(force["body"])
        angle = 0.0
        for k in self._up(body):
            joint = self.table["bodies"][self.names[k]]["joint"]
            own = joint.get("angle", 0)
            angle += self.q[own] if own in self.q else self.number(own)
            angle += self.number(joint.get("turned", {"angle": 0})["angle"])
        couple = -self.number(force["stiffness"]) * (angle - self.number(force["rest"]))
        yield body, np.zeros(3), couple * Z, np.zeros(3)

    def _torsion_damper(self, force: dict[str, Any]) -> Iterator[Wrench]:
        body = self.names.index(force["body"])
        yield body, np.zeros(3), -self.number(force["damping"]) * self.here[body].w, np.zeros(3)

    def _up(self, body: int) -> Iterator[int]:
        while body >= 0:
            yield body
            body = self.parents[body]

    def effort(self, body: str) -> tuple[float, float]:
        """(torque of drive, spring and damper, rotor's inertia) of a body's joint."""
        joint = self.table["bodies"][body]["joint"]
        if joint["kind"] != "revolute":
            return 0.0, 0.0
        s, rate = self.q[joint["angle"]], self.u[joint["angle"]]
        torque = self.number(joint.get("torque", 0)) - self.number(joint.get("damping", 0)) * rate
        torque -= self.number(joint.get("stiffness", 0)) * (s - self.number(joint.get("rest", 0)))
        return torque, self.number(joint.get("armature", 0))

    # -- constraints --------------------------------------------------------------------------------------

    def constraints(self) -> Iterator[tuple[str, list[Wrench], float]]:
        """(constraint, its pushes, the rate of the row's velocity where the free accelerations are 0) of every row."""
        for name, constraint in self.table.get("constraints", {}).items():
            for pushes, bias in getattr(self, f"_{constraint['kind']}")(constraint):
                yield name, pushes, bias

    def _support(self, constraint: dict[str, Any]) -> Iterator[tuple[list[Wrench], float]]:
        n = self.vector(constraint["normal"])
        n = n / np.linalg.norm(n)
        spot = self.place(constraint["point"])
        p, _, a = self.at(spot)
        yield [(spot[0], n, np.zeros(3), p)], float(n @ a)

    def _pin(self, constraint: dict[str, Any]) -> Iterator[tuple[list[Wrench], float]]:
        """Of one point."""
        spot = self.place(constraint["points"][0])
        p, _, a = self.at(spot)
        for e in np.eye(3)[: 2 if self.plane else 3]:
            yield [(spot[0], e, np.zeros(3), p)], float(e @ a)

    def _link(self, constraint: dict[str, Any]) -> Iterator[tuple[list[Wrench], float]]:
        """n . (v2 - v) = 0 with n along the rod, which turns: n' . (v2 - v) = (v2 - v)^2 / l there."""
        first, second = (self.place(point) for point in constraint["points"])
        (p, v, a), (p2, v2, a2) = self.at(first), self.at(second)
        length = float(np.linalg.norm(p2 - p))
        n = (p2 - p) / length
        pushes = [(first[0], n, np.zeros(3), p), (second[0], -n, np.zeros(3), p2)]
        yield pushes, -float(n @ (a2 - a) + (v2 - v) @ (v2 - v) / length)

    @cached_property
    def rows_of_constraints(self) -> tuple[np.ndarray, np.ndarray]:
        """(J, J u + sigma)."""
        units = [self.moved({q: 1.0}, {}) for q in self.free]
        J = [[self._velocity(pushes, places) for places in units] for _, pushes, _ in self.constraints()]
        open_ = [self._velocity(pushes, self.here) for _, pushes, _ in self.constraints()]
        return np.array(J).reshape(-1, len(self.free)), np.array(open_)

    def constrained(self) -> Tree:
        """The same with rates next to these that the constraints allow."""
        J, open_ = self.rows_of_constraints
        du = np.linalg.lstsq(J, -open_, rcond=1e-11)[0] if len(J) else np.zeros(len(self.free))
        return replace(self, u=self.u | {q: self.u[q] + float(x) for q, x in zip(self.free, du, strict=True)})

    @property
    def holds(self) -> bool:
        """Whether the constraints hold, and something free moves each or nothing at all does."""
        J, open_ = self.rows_of_constraints
        stuck = [rate for row, (_, _, rate) in zip(J, self.constraints(), strict=True) if np.max(np.abs(row)) < 1e-9]
        return bool(
            np.max(np.abs(open_), initial=0) < 1e-9
            and np.max(np.abs(stuck), initial=0) < 1e-9
            and self.balance.residual < 1e-8 * np.max(np.abs(self.balance.right), initial=1)
        )

    def _velocity(self, pushes: list[Wrench], places: list[Place]) -> float:
        """Power of the pushes."""
        total = 0.0
        for body, f, n, place in pushes:
            if body >= 0:
                moving = places[body]
                total += float(f @ (moving.v + np.cross(moving.w, place - moving.p)) + n @ moving.w)
        return total

    # -- all equations of all bodies ---------------------------------------------------------------

    @property
    def plane(self) -> bool:
        return self.table["space"] == "plane"

    def six(self, f: np.ndarray, n: np.ndarray, place: np.ndarray) -> np.ndarray:
        """Force and moment about the ground's origin: the rows that a body has."""
        whole = np.concatenate([f, n + np.cross(place, f)])
        return whole[[0, 1, 5]] if self.plane else whole

    @property
    def rows(self) -> int:
        return 3 if self.plane else 6

    def column(self, wrenches: list[Wrench]) -> np.ndarray:
        """What they do to all bodies, one below the other."""
        found = np.zeros((len(self.names), self.rows))
        for body, f, n, place in wrenches:
            if body >= 0:
                found[body] += self.six(f, n, place)
        return found.ravel()

    def inertia(self, places: list[Place], *, turning: bool = True) -> np.ndarray:
        """m a_C and I alpha + w x I w of all bodies (without turning: the part linear in the accelerations)."""
        found = []
        for body, place in zip(self.names, places, strict=True):
            table = self.table["bodies"][body]
            c, _, a = place.point(self.own_point(body, "center"))
            I = place.R @ self._inertia(table["inertia"]) @ place.R.T
            n = I @ place.alpha + (np.cross(place.w, I @ place.w) if turning else 0)
            found.append(self.six(self.number(table["mass"]) * a, n, c))
        return np.concatenate(found)

    def _inertia(self, given: Any) -> np.ndarray:
        if self.plane:
            return np.diag([0, 0, self.number(given)])
        xx, yy, zz, xy, yz, xz = (self.number(x) for x in given)
        return np.array([[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]])

    def joint_place(self, body: str) -> np.ndarray:
        point = self.own_point(body, self.table["bodies"][body]["joint"].get("point", "origin"))
        return self.here[self.names.index(body)].point(point)[0]

    def joint_wrenches(self, body: str) -> list[tuple[np.ndarray, np.ndarray]]:
        """(force, couple) of each reaction that the joint can carry, drives of given motions included, ground axes."""
        joint = self.table["bodies"][body]["joint"]
        R = self.parent(self.names.index(body)).R @ self._turned(joint)
        free = [(R @ axis, np.zeros(3)) for axis, _ in self._slides(joint)]
        free = [f for f, (_, s) in zip(free, self._slides(joint), strict=True) if s in self.free]
        if joint["kind"] != "prismatic" and joint.get("angle") in self.free:
            axis = self.vector(joint.get("axis", Z))
            free.append((np.zeros(3), R @ axis / np.linalg.norm(axis)))
        twists = np.array([np.concatenate(f) for f in free]).reshape(-1, 6)
        used = [0, 1, 5] if self.plane else list(range(6))
        _, sizes, V = np.linalg.svd(twists[:, used])
        held = np.zeros((len(used) - len(sizes), 6))
        held[:, used] = V[len(sizes) :]
        return [(row[:3], row[3:]) for row in held]

    def parent(self, i: int) -> Place:
        return AT_REST if self.parents[i] < 0 else self.here[self.parents[i]]

    def carried(self, what: str, k: int) -> bool:
        """Whether forces (couples) along the ground's axis k belong to the model's space."""
        return not self.plane or (k < 2) == (what == "force")

    def axis(self, body: str) -> np.ndarray:
        """Of a hinge."""
        joint = self.table["bodies"][body]["joint"]
        axis = self.vector(joint["axis"]) if joint["kind"] == "revolute" and "axis" in joint else Z
        return self.parent(self.names.index(body)).R @ self._turned(joint) @ axis / np.linalg.norm(axis)

    def on_both(self, body: str, force: np.ndarray, couple: np.ndarray) -> list[Wrench]:
        """Force and couple of a joint, on the body and opposite on its parent."""
        i, place = self.names.index(body), self.joint_place(body)
        return [(i, force, couple, place), (self.parents[i], -force, -couple, place)]

    @cached_property
    def balance(self) -> Balance:
        """inertia(a) = applied + efforts + G x,   J a + gamma = 0,   solved for a and x together."""
        applied = self.column(list(self.applied()))
        units = [self.moved({}, {q: 1.0}) for q in self.free]
        inertia = [self.inertia(places, turning=False) for places in units]
        for body in self.names:
            (torque, rotor), angle = self.effort(body), self.table["bodies"][body]["joint"].get("angle")
            unit = self.column(self.on_both(body, np.zeros(3), self.axis(body)))
            applied = applied + unit * (torque - rotor * self.given.get(angle, 0.0))
            if rotor and angle in self.free:
                inertia[self.free.index(angle)] = inertia[self.free.index(angle)] + rotor * unit
        owners: list[tuple[str, tuple[np.ndarray, np.ndarray]]] = []
        columns = []
        for body in self.names:
            for force, couple in self.joint_wrenches(body):
                owners.append((body, (force, couple)))
                columns.append(self.column(self.on_both(body, force, couple)))
        J, bias = [], []
        for name, pushes, rate in self.constraints():
            owners.append((name, (pushes[0][1], pushes[0][2])))
            columns.append(self.column(pushes))
            J.append([self._power(pushes, places) for places in units])
            bias.append(rate)
        n = len(self.free)
        G = np.array(columns).T.reshape(len(applied), -1)
        A = np.block(
            [[np.array(inertia).T.reshape(-1, n), -G], [np.array(J).reshape(-1, n), np.zeros((len(J), G.shape[1]))]]
        )
        right = np.concatenate([applied - self.inertia(self.here), -np.array(bias)])
        found, _, _, _ = np.linalg.lstsq(A, right, rcond=1e-11)
        return Balance(tuple(owners), A, right, found, n)

    def reaction(self, owner: str, what: str, k: int) -> float | None:
        """Component k of the "force" or "couple" of a joint or constraint; None where it is indeterminate."""
        row = self.balance.weights(owner, ("force", "couple").index(what), k)
        given = 0.0
        if what == "couple" and owner in self.names:
            (torque, rotor), angle = self.effort(owner), self.table["bodies"][owner]["joint"].get("angle")
            axis = self.axis(owner)[k]
            given = axis * (torque - rotor * self.given.get(angle, 0.0))
            if angle in self.free:
                row[self.free.index(angle)] -= axis * rotor
        value = self.balance.value(row)
        return None if value is None else value + given

    def _power(self, pushes: list[Wrench], unit: list[Place]) -> float:
        """Virtual power of pushes at a unit acceleration of one coordinate: accelerations in place of rates."""
        total = 0.0
        for body, f, n, place in pushes:
            if body >= 0:
                a = unit[body].a + np.cross(unit[body].alpha, place - self.here[body].p)
                total += float(f @ a + n @ unit[body].alpha)
        return total


@dataclass(frozen=True)
class Balance:
    """All equations solved: the accelerations, then one number for each reaction."""

    owners: tuple[tuple[str, tuple[np.ndarray, np.ndarray]], ...]
    A: np.ndarray
    right: np.ndarray
    found: np.ndarray
    speeds: int

    @property
    def accelerations(self) -> np.ndarray:
        return self.found[: self.speeds]

    @property
    def residual(self) -> float:
        return float(np.max(np.abs(self.A @ self.found - self.right)))

    @cached_property
    def null_space(self) -> np.ndarray:
        _, sizes, V = np.linalg.svd(self.A)
        return V[int(np.sum(sizes > 1e-9 * sizes[0])) :]

    def weights(self, owner: str, what: int, k: int) -> np.ndarray:
        """Factors of all unknowns in component k of the force (0) or couple (1) of a joint."""
        row = np.zeros(len(self.found))
        for j, (name, wrench) in enumerate(self.owners):
            if name == owner:
                row[self.speeds + j] = wrench[what][k]
        return row

    def value(self, weights: np.ndarray) -> float | None:
        """What the weights make of the unknowns; None where the equations leave it open."""
        if self.null_space.size and np.max(np.abs(self.null_space @ weights)) > 1e-8:
            return None
        return float(weights @ self.found)


def read(text: str) -> dict[str, Any]:
    return tomllib.loads(text)
