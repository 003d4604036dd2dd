"""A model file of a tree of bodies in space, read and solved a second time, at 60 digits. Nothing of eomgen.

Poses are written as functions of q and t from the words of the reference; velocities, partial velocities and
accelerations are differences of the poses along q(t) = q + q' h + q'' h^2/2 with a step of 1e-18, and
    sum dv/du . (F - m a) + dw/du . (tau - I alpha - w x I w) = 0
gives the accelerations, the sum over what a joint carries its whole force and couple.
"""

from __future__ import annotations

import re
import tomllib
from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import mpmath

mp = mpmath.MPContext()
mp.dps = 60
STEP = mp.mpf(10) ** -18
FUNCTIONS = {name: getattr(mp, name) for name in "sin cos tan sqrt exp pi".split()}
AXES = {"x": (1, 0, 0), "y": (0, 1, 0), "z": (0, 0, 1)}
Z = [0, 0, 1]
Numbers = Mapping[str, Any]


def value(formula: Any, names: Numbers) -> Any:
    """The number that a formula of the model file gives; units: deg alone."""
    if isinstance(formula, dict):
        return value(formula["value"], names) * {"deg": mp.pi / 180}.get(formula.get("unit", ""), 1)
    if not isinstance(formula, str):
        return mp.mpf(str(formula))
    text = re.sub(r"(\w)'", r"\1_rate", formula.replace("^", "**"))
    text = re.sub(r"(?<![\w.])(\d+\.?\d*(?:e-?\d+)?|\.\d+)(?!\w)", r"number('\1')", text)
    return mp.mpf(eval(text, {"__builtins__": {}}, {**FUNCTIONS, "number": mp.mpf, **names}))


def column(entries: Any, names: Numbers) -> mp.matrix:
    return mp.matrix([value(x, names) for x in entries])


def dot(a: mp.matrix, b: mp.matrix) -> Any:
    return sum(a[k] * b[k] for k in range(3))


def cross(a: mp.matrix, b: mp.matrix) -> mp.matrix:
    return mp.matrix([a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]])


def spin_of(W: mp.matrix) -> mp.matrix:
    """w of a matrix [w x]; of another its skew part."""
    return mp.matrix([W[2, 1] - W[1, 2], W[0, 2] - W[2, 0], W[1, 0] - W[0, 1]]) / 2


def turn(axis: Any, angle: Any) -> mp.matrix:
    """R = 1 + sin K + (1 - cos) K^2 (Rodrigues)."""
    x, y, z = (c / mp.sqrt(sum(c * c for c in axis)) for c in axis)
    K = mp.matrix([[0, -z, y], [z, 0, -x], [-y, x, 0]])
    return mp.eye(3) + mp.sin(angle) * K + (1 - mp.cos(angle)) * K * K


def of_quaternion(e: list[Any]) -> mp.matrix:
    """R = 1 + 2 e0 K + 2 K^2, K = [(e1, e2, e3) x], of a quaternion of norm 1."""
    K = mp.matrix([[0, -e[3], e[2]], [e[3], 0, -e[1]], [-e[2], e[1], 0]])
    return mp.eye(3) + 2 * e[0] * K + 2 * K * K


@dataclass(frozen=True)
class ByHand:
    """One model.

    Args:
        text: of its file.
    """

    text: str

    @cached_property
    def table(self) -> dict[str, Any]:
        return tomllib.loads(self.text)

    @cached_property
    def parameters(self) -> dict[str, Any]:
        found: dict[str, Any] = {}
        for name, given in self.table.get("parameters", {}).items():
            found[name] = value(given, found)
        return found

    @cached_property
    def bodies(self) -> dict[str, dict[str, Any]]:
        return self.table["bodies"]

    @cached_property
    def driven(self) -> dict[str, str]:
        given = self.table["coordinates"]
        return {q: x["motion"] for q, x in given.items() if isinstance(x, dict) and "motion" in x}

    @cached_property
    def q(self) -> list[str]:
        return [q for q in self.table["coordinates"] if q not in self.driven]

    @cached_property
    def turns(self) -> list[tuple[list[str], list[str]]]:
        """(quaternion, its speeds) of each joint that has one."""
        joints = [body["joint"] for body in self.bodies.values()]
        return [(joint["quaternion"], joint["omega"]) for joint in joints if "quaternion" in joint]

    @cached_property
    def u(self) -> list[str]:
        """Rates by their coordinate, and the speeds of the quaternions."""
        held = [e for quaternion, _ in self.turns for e in quaternion]
        return [*(q for q in self.q if q not in held), *(w for _, omega in self.turns for w in omega)]

    def names(self, q: Numbers, t: Any) -> dict[str, Any]:
        found = {**self.parameters, "t": t, **q}
        for name, motion in self.driven.items():
            found[name] = value(motion, {**self.parameters, "t": t})
        return found

    # -- poses -------------------------------------------------------------------------------------

    def poses(self, q: Numbers, t: Any) -> dict[str, tuple[mp.matrix, mp.matrix, mp.matrix]]:
        """(R, origin, seat of the joint) of every body, parents first in the file."""
        names, found = self.names(q, t), {}
        for name, body in self.bodies.items():
            joint = body["joint"]
            parent, _, point = joint.get("on", "").partition(".")
            R, p, _ = found[parent] if parent else (mp.eye(3), mp.zeros(3, 1), None)
            at = self.bodies[parent]["points"][point] if point else joint.get("at", [0, 0, 0])
            p = p + R * column(at, names)
            turned = joint.get("turned", [])
            for fixed in [turned] if isinstance(turned, dict) else turned:
                R = R * turn(column(fixed.get("axis", Z), names), value(fixed["angle"], names))
            shift, turned_by = self._moved(joint, names)
            seat, R = p + R * shift, R * turned_by
            own = body.get("points", {}).get(joint.get("point"), [0, 0, 0])
            found[name] = (R, seat - R * column(own, names), seat)
        return found

    def _moved(self, joint: dict[str, Any], names: Numbers) -> tuple[mp.matrix, mp.matrix]:
        """(displacement, rotation) of the child against the turned axes."""
        axis = column(joint.get("axis", Z), names)
        n = axis / mp.sqrt(dot(axis, axis))
        angle = value(joint.get("angle", 0), names)
        kind, shift, R = joint["kind"], mp.zeros(3, 1), mp.eye(3)
        if kind in ("prismatic", "cylindrical"):
            shift = n * value(joint["displacement"], names)
        elif kind == "screw":
            shift = n * value(joint["pitch"], names) * angle
        elif kind == "planar":
            shift = column([joint["x"], joint["y"], 0], names)
        elif kind == "free":
            shift = column(joint["position"], names)
        if kind == "universal":
            for each, by in zip(joint["axes"], joint["angles"], strict=True):
                R = R * turn(column(each, names), value(by, names))
        elif "quaternion" in joint:
            R = of_quaternion([names[e] for e in joint["quaternion"]])
        elif "orientation" in joint:
            for each, by in zip(joint["orientation"], joint["angles"], strict=True):
                R = R * turn(AXES[each], value(by, names))
        else:
            R = turn(axis, angle)
        return shift, R

    # -- motion --------------------------------------------------------------------------------------

    def rates(self, q: Numbers, u: Numbers) -> dict[str, Any]:
        """q' = u, and e' = e o (0, w)/2 of a quaternion."""
        found = {k: u[k] for k in self.u if k in q}
        for (a, b, c, d), omega in self.turns:
            e0, e1, e2, e3, (x, y, z) = q[a], q[b], q[c], q[d], (u[w] for w in omega)
            found |= {
                a: (-e1 * x - e2 * y - e3 * z) / 2,
                b: (e0 * x + e2 * z - e3 * y) / 2,
                c: (e0 * y - e1 * z + e3 * x) / 2,
                d: (e0 * z + e1 * y - e2 * x) / 2,
            }
        return found

    def second_rates(self, q: Numbers, u: Numbers, a: Numbers) -> dict[str, Any]:
        """q'' = a, and e'' = e o (0, w')/2 - |w|^2 e/4."""
        found = self.rates(q, a)
        for quaternion, omega in self.turns:
            square = sum(u[w] ** 2 for w in omega)
            found |= {e: found[e] - square * q[e] / 4 for e in quaternion}
        return found

    def moved(self, q: Numbers, u: Numbers, a: Numbers, t: Any) -> dict[str, dict[str, mp.matrix]]:
        """R, place and velocities of every body; of its origin o, of its mass centre c."""
        first, second = self.rates(q, u), self.second_rates(q, u, a)

        def at(h: Any) -> dict[str, Any]:
            return self.poses({k: q[k] + first[k] * h + second[k] * h * h / 2 for k in q}, t + h)

        before, now, after = at(-STEP), at(0), at(STEP)
        found = {}
        for name, (R, o, seat) in now.items():
            c = column(self.bodies[name].get("center", [0, 0, 0]), self.parameters)
            places = [state[name][1] + state[name][0] * c for state in (before, now, after)]
            dR = (after[name][0] - before[name][0]) / (2 * STEP)
            ddR = (after[name][0] - 2 * R + before[name][0]) / STEP**2
            found[name] = {
                "R": R,
                "o": o,
                "seat": seat,
                "c": places[1],
                "w": spin_of(dR * R.T),
                "alpha": spin_of(ddR * R.T),
                "v": (after[name][1] - before[name][1]) / (2 * STEP),
                "a": (places[2] - 2 * places[1] + places[0]) / STEP**2,
            }
        return found

    def inertia_wrench(self, name: str, x: dict[str, mp.matrix]) -> tuple[mp.matrix, mp.matrix]:
        """(m a, I alpha + w x I w)"""
        body = self.bodies[name]
        I = [value(entry, self.parameters) for entry in body.get("inertia", [0, 0, 0])]
        xx, yy, zz, xy, yz, zx = I if len(I) == 6 else (*I, 0, 0, 0)
        tensor = x["R"] * mp.matrix([[xx, xy, zx], [xy, yy, yz], [zx, yz, zz]]) * x["R"].T
        m = value(body.get("mass", 0), self.parameters)
        return m * x["a"], tensor * x["alpha"] + cross(x["w"], tensor * x["w"])

    # -- forces --------------------------------------------------------------------------------------

    def wrenches(self, u: Numbers, states: dict[str, Any], names: dict[str, Any]) -> list[tuple[str, Any, Any]]:
        """(body, force at its mass centre, couple) of every force."""
        names = dict(u) | names | {f"{k}_rate": x for k, x in u.items()}
        found = []
        for force in self.table.get("forces", {}).values():
            if force["kind"] == "gravity":
                g = column(force["acceleration"], names)
                found += [(k, value(b.get("mass", 0), names) * g, mp.zeros(3, 1)) for k, b in self.bodies.items()]
                continue
            body = force.get("body") or force["point"].partition(".")[0]
            R = states[force["axes"]]["R"] if force.get("axes", "ground") != "ground" else mp.eye(3)
            F, C = (R * column(force.get(key, [0, 0, 0]), names) for key in ("force", "couple"))
            found.append((body, F, C))
        return found

    def efforts(self, q: Numbers, u: Numbers, t: Any) -> list[tuple[Any, str]]:
        """(force along a joint's variable, the variable), springs, dampers and drives together."""
        first = self.rates(q, u)
        names = dict(u) | self.names(q, t) | {f"{k}_rate": x for k, x in first.items()}
        found = []
        for body in self.bodies.values():
            joint = body["joint"]
            for key, variable in (("torque", "angle"), ("force", "displacement")):
                if key in joint:
                    found.append((value(joint[key], names), joint[variable]))
            variable = joint.get("displacement" if joint["kind"] == "prismatic" else "angle", 0)
            rate = self.along(variable, q, first, t, 1)
            stretch = value(variable, names) - value(joint.get("rest", 0), names)
            pull = -value(joint.get("stiffness", 0), names) * stretch - value(joint.get("damping", 0), names) * rate
            found.append((pull, variable))
        return found

    def along(self, formula: Any, q: Numbers, rates: Numbers, t: Any, speed: Any) -> Any:
        """The rate of a formula as q moves with `rates` and t with `speed`."""
        ends = (value(formula, self.names({k: q[k] + rates[k] * h for k in q}, t + speed * h)) for h in (STEP, -STEP))
        return (next(ends) - next(ends)) / (2 * STEP)

    # -- what it gives -------------------------------------------------------------------------------

    def accelerations(self, q: Numbers, u: Numbers, t: Any) -> dict[str, Any]:
        """u' of every speed: what is left of the balance along each motion is linear in them, M a + r = 0."""
        still = dict.fromkeys(self.u, mp.mpf(0))
        units = {k: still | {k: mp.mpf(1)} for k in self.u}
        rest = self.moved(q, still, still, t)
        partial = {k: self.moved(q, unit, still, t) for k, unit in units.items()}
        drives = [
            sum(effort * self.along(s, q, self.rates(q, unit), t, 0) for effort, s in self.efforts(q, u, t))
            for unit in units.values()
        ]

        def left(a: Numbers) -> mp.matrix:
            """sum dv/du . (m a - F) + dw/du . (I alpha + w x I w - C), without the drives of the joints"""
            states, found = self.moved(q, u, a, t), mp.zeros(len(self.u), 1)
            needed = self.needed(u, states, self.names(q, t))
            for i, part in enumerate(partial.values()):
                for name, (F, C) in needed.items():
                    w = part[name]["w"] - rest[name]["w"]
                    v = part[name]["v"] - rest[name]["v"] + cross(w, rest[name]["c"] - rest[name]["o"])
                    found[i] += dot(v, F) + dot(w, C)
            return found

        r = left(still)
        columns = [left(unit) - r for unit in units.values()]
        M = mp.matrix([[column[i] for column in columns] for i in range(len(self.u))])
        return dict(zip(self.u, mp.lu_solve(M, mp.matrix(drives) - r), strict=True))

    def needed(self, u: Numbers, states: dict[str, Any], names: dict[str, Any]) -> dict[str, tuple[Any, Any]]:
        """What joints have to make up of the balance of every body: (force, couple about the mass centre)."""
        found = {name: self.inertia_wrench(name, x) for name, x in states.items()}
        for body, force, couple in self.wrenches(u, states, names):
            found[body] = (found[body][0] - force, found[body][1] - couple)
        return found

    def reactions(self, q: Numbers, u: Numbers, t: Any) -> dict[str, tuple[Any, Any]]:
        """(force, couple about its point) of every joint on its body, ground axes, springs and drives with it."""
        states = self.moved(q, u, self.accelerations(q, u, t), t)
        needed = self.needed(u, states, self.names(q, t))
        found = {}
        for name, x in states.items():
            carried = [needed[other] + (states[other]["c"],) for other in self.carried(name)]
            force = sum((F for F, _, _ in carried), start=mp.zeros(3, 1))
            found[name] = force, sum((C + cross(c - x["seat"], F) for F, C, c in carried), start=mp.zeros(3, 1))
        return found

    def carried(self, name: str) -> list[str]:
        """The body and all that hang on it."""
        parents = {k: body["joint"].get("on", "").partition(".")[0] for k, body in self.bodies.items()}
        return [name, *(x for k in self.bodies if parents[k] == name for x in self.carried(k))]
