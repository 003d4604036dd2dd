"""The oracle's own reading of a model file: TOML by tomllib, numbers with units, places, laws of time.

Imports nothing of eomgen.
"""

from __future__ import annotations

import itertools
import re
import tomllib
from dataclasses import dataclass, field
from functools import cached_property
from typing import Any

import formulas
import numpy as np
import solids
import taylor as ty
from taylor import Jet, jet


class NotCovered(Exception):
    """What the oracle does not know of."""


@dataclass
class Moving:
    """Where everything is along n curves: time, coordinates, body frames, inputs, declared speeds."""

    model: Declared
    t: Jet
    q: dict[str, Jet]
    poses: dict[str, tuple[Jet, Jet]] = field(default_factory=dict)
    inputs: dict[str, float] | None = None
    local: dict[str, Any] = field(default_factory=dict)
    states: dict[str, float] = field(default_factory=dict)

    def name(self, name: str, primes: int) -> Any:
        if name in self.local:
            x = self.local[name]
        elif name in self.model.parameters:
            return self.model.parameters[name]
        elif name == "pi":
            return float(np.pi)
        elif name == "t":
            x = self.t
        elif name in self.q:
            x = self.q[name]
        elif name in self.states and not primes:
            return self.states[name]
        elif name in self.model.speeds:
            x = self.speed(name)
        elif name in self.model.inputs:
            x = self.model.input(name, self)
        else:
            raise KeyError(f"unknown name {name}")
        for _ in range(primes):
            x = jet(x).rate()
        return x

    def speed(self, name: str) -> Jet:
        rate = self.model.speeds[name].get("rate")
        if rate is not None:
            return self.value(rate)
        for body in self.model.bodies.values():
            omega = body.get("joint", {}).get("omega", ())
            if name in omega:
                return ty.component(self.spin_against_parent(body), omega.index(name))
        raise KeyError(name)

    def spin_against_parent(self, body: dict) -> Jet:
        """Angular velocity of the child against its parent, the child's axes."""
        R = self.poses[body["name"]][1]
        parent = self.model.parent(body)
        if parent is not None:
            R = ty.matmul(ty.transpose(self.poses[parent][1]), R)
        return ty.vee(ty.matmul(ty.transpose(R), R.rate()))

    def call(self, function: str, trees: tuple) -> Any:
        if function in ("min", "max"):
            values = [formulas.evaluated(x, self.name, self.call) for x in trees]
            found = values[0]
            for x in values[1:]:
                found = ty.pick(found, x, function == "min")
            return found
        if function in ty.FUNCTIONS:
            return ty.FUNCTIONS[function](*(formulas.evaluated(x, self.name, self.call) for x in trees))
        if function.rstrip("'") in self.model.tables:
            f = self.model.table(function)
            return jet(formulas.evaluated(trees[0], self.name, self.call)).of(*f)
        return self.motion(function, [x[1] for x in trees])

    def motion(self, function: str, names: list[str]) -> Any:
        """Functions of the motion: x(P), vx(P, B), angle(A), omega_z(A) and their like."""
        if function in ("angle", "omega", "epsilon") or function.startswith("omega_"):
            R = self.frame(names[0])[1]
            if len(names) > 1 and names[1] != "ground":
                R = ty.matmul(ty.transpose(self.frame(names[1])[1]), R)
            if function == "angle":
                of_axes = ty.atan2(ty.component(R, 1, 0), ty.component(R, 0, 0))
                counted = self.counted(names[0]) - sum((self.counted(x) for x in names[1:]), start=0.0)
                return of_axes + 2 * np.pi * round((counted - float(of_axes.value)) / (2 * np.pi))
            w = ty.vee(ty.matmul(R.rate(), ty.transpose(R)))
            if function == "epsilon":
                return ty.component(w.rate(), 2)
            return ty.component(w, "xyz".index(function[-1]) if "_" in function else 2)
        if function in ("speed", "acceleration"):
            v = self.point(names[0]).rate()
            return ty.norm(v if function == "speed" else v.rate())
        kind, axis = function[:-1], "xyz".index(function[-1])
        p = self.point(names[0])
        if len(names) > 1 and names[1] != "ground":
            o, R = self.frame(names[1])
            p = ty.matmul(ty.transpose(R), p - o)
        for _ in range(("", "v", "a").index(kind)):
            p = p.rate()
        return ty.component(p, axis)

    def counted(self, body: str | None) -> float:
        """The angle of a body in the plane with whole turns: the sum of those that joints declare, to the ground."""
        total = 0.0
        while body in self.model.bodies:
            joint = self.model.bodies[body].get("joint", {})
            turned = joint.get("turned", [])
            for one in [*(turned if isinstance(turned, list) else [turned]), joint]:
                total += float(jet(self.value(one.get("angle", 0))).value)
            body = self.model.parent(self.model.bodies[body])
        return total

    def value(self, declared: Any) -> Any:
        """A field: a number, a text, or {value, unit}."""
        if isinstance(declared, (int, float)):
            return float(declared)
        if isinstance(declared, dict):
            return self.value(declared["value"]) * formulas.factor(declared.get("unit", "1"))
        return formulas.evaluated(formulas.parsed(declared), self.name, self.call)

    def vector(self, declared: Any) -> Jet:
        """A vector of 2 or 3 entries; of 2, the third is 0. A name is a ground's point."""
        if isinstance(declared, str):
            declared = self.model.points[declared]
        entries = [self.value(x) for x in declared]
        return ty.vector([*entries, *[0.0] * (3 - len(entries))])

    def frame(self, body: str) -> tuple[Jet, Jet]:
        if body == "ground":
            return ty.vector([0, 0, 0]), jet(np.eye(3))
        return self.poses[body]

    def local_point(self, name: str) -> tuple[str | None, Jet]:
        """(body, place in its axes) of a point; None: of the ground."""
        body, _, point = name.rpartition(".")
        if not body:
            return (point, ty.vector([0, 0, 0])) if point in self.model.bodies else (None, self.vector(name))
        return body, self.of_body(body, point)

    def of_body(self, body: str, point: str) -> Jet:
        declared = self.model.bodies[body]
        if point in declared.get("points", {}):
            return self.vector(declared["points"][point])
        if point == "origin":
            return ty.vector([0, 0, 0])
        if point == "center":
            return ty.vector(self.model.mass[body][1])
        shape = declared["shape"]
        length = self.model.number(shape["length"])
        return ty.vector([{"start": 0.0, "end": length}[point], 0, 0])

    def point(self, name: str) -> Jet:
        body, r = self.local_point(name)
        if body is None:
            return r
        p, R = self.poses[body]
        return p + ty.matmul(R, r)

    def spin(self, body: str | None) -> Jet:
        """Angular velocity, ground axes."""
        if body is None:
            return ty.vector([0, 0, 0])
        R = self.poses[body][1]
        return ty.vee(ty.matmul(R.rate(), ty.transpose(R)))

    def velocity_at(self, body: str | None, place: Jet) -> Jet:
        """Of the material of a body at a place of the ground."""
        if body is None:
            return ty.vector([0, 0, 0])
        p, _ = self.poses[body]
        return p.rate() + ty.cross(self.spin(body), place - p)


class Declared:
    """A model as the oracle reads it."""

    def __init__(self, text: str) -> None:
        d = tomllib.loads(text)
        self.plane = d["space"] == "plane"
        self.parameters: dict[str, float] = {}
        self.time = 0.0
        self._declared = d.get("parameters", {})
        for name in self._declared:
            self._parameter(name)
        self.coordinates = {
            name: x if isinstance(x, dict) else {"start": x} for name, x in d.get("coordinates", {}).items()
        }
        self.speeds = {name: {"rate": x} if isinstance(x, str) else x for name, x in d.get("speeds", {}).items()}
        self.inputs = d.get("inputs", {})
        self.tables = d.get("tables", {})
        self.forces = d.get("forces", {})
        self.states = {**d.get("states", {}), **self._of_forces()}
        self.points = d.get("points", {})
        self.bodies = {name: {**body, "name": name} for name, body in d.get("bodies", {}).items()}
        self.constraints = d.get("constraints", {})
        self.impact = d.get("impact")
        self.outputs = d.get("outputs", {})
        self.mass = {name: self._properties(body) for name, body in self.bodies.items()}
        own = {name: f"{body.get('mass', '')} {body.get('inertia', '')}" for name, body in self.bodies.items()}
        self._changing = [name for name, text in own.items() if re.search(r"\bt\b", text)]

    def _of_forces(self) -> dict[str, dict]:
        """States that forces bring along, by name: {start, law, of the force, its chamber or slip}."""
        found = {}
        for name, f in self.forces.items():
            if f["kind"] == "hydraulic_cylinder" or (
                f["kind"] == "pneumatic_cylinder" and f.keys() & {"flows", "valve"}
            ):
                for k in range(len(f["areas"])):
                    start = f["pressures"][k] if "pressures" in f else 0
                    found[f"{name}_p_{k + 1}"] = {"start": start, "law": "chamber", "of": name, "chamber": k}
            for key, other, own in (("lateral", "longitudinal", "slip"), ("longitudinal", "lateral", "kappa")):
                law = f.get(key) or (f.get(other) if "combined" in f else None) or {}
                if f["kind"] == "tyre" and "relaxation" in law:
                    found[f"{name}_{own}"] = {"start": 0, "law": "slip", "of": name, "slip": own}
        return found

    def weigh(self, t: float) -> None:
        """Sets the masses that change to those at a time, as which the equations hold them."""
        self.time = t
        self.mass |= {name: self._properties(self.bodies[name]) for name in self._changing}

    def _parameter(self, name: str) -> float:
        if name not in self.parameters:
            x = self._declared[name]
            self.parameters[name] = self.number(x)
        return self.parameters[name]

    def table(self, function: str) -> tuple[Any, Any, Any]:
        """(f, f', f'') of a table of values, with primes its derivatives, of SI and in SI."""
        from scipy.interpolate import CubicSpline, PchipInterpolator

        name = function.rstrip("'")
        declared, first = self.tables[name], len(function) - len(name)
        x = np.array(declared["at"]) * formulas.factor(declared.get("at_unit", "1"))
        y = np.array(declared["values"]) * formulas.factor(declared.get("unit", "1"))
        way = declared.get("between", "pchip")
        curve = PchipInterpolator(x, y) if way == "pchip" else CubicSpline(x, y)

        def at(t: float, k: int) -> float:
            inside = x[0] <= t <= x[-1]
            if way == "linear":
                j = min(max(int(np.searchsorted(x, t, side="right")) - 1, 0), len(x) - 2)
                slope = (y[j + 1] - y[j]) / (x[j + 1] - x[j]) if inside else 0.0
                return float(np.interp(t, x, y)) if k == 0 else slope if k == 1 else 0.0
            end = t if inside else x[0] if t < x[0] else x[-1]
            if inside or k == 1:
                return float(curve(end, k))
            return float(curve(end) + curve(end, 1) * (t - end)) if k == 0 else 0.0

        f, d, dd = (np.vectorize(lambda t, k=k: at(t, k), otypes=[float]) for k in range(first, first + 3))
        return f, d, dd

    def number(self, declared: Any) -> float:
        """A number of parameters alone, and of the time at which the masses are weighed."""

        def name(found: str, _: int) -> float:
            if found == "t" and "t" not in self._declared:
                return self.time
            return float(np.pi) if found == "pi" and "pi" not in self._declared else self._parameter(found)

        def call(function: str, trees: tuple) -> Any:
            values = [formulas.evaluated(x, name, call) for x in trees]
            if function in ("min", "max"):
                return float({"min": min, "max": max}[function](float(jet(x).value) for x in values))
            return ty.FUNCTIONS[function](*values)

        if isinstance(declared, (int, float)):
            return float(declared)
        if isinstance(declared, dict):
            return self.number(declared["value"]) * formulas.factor(declared.get("unit", "1"))
        found = formulas.evaluated(formulas.parsed(declared), name, call)
        return found if isinstance(found, float) else jet(found).value

    def numbers(self, declared: Any) -> np.ndarray:
        """A vector of parameters alone, of 3 entries."""
        if isinstance(declared, str):
            declared = self.points[declared]
        found = [self.number(x) for x in declared]
        return np.array([*found, *[0.0] * (3 - len(found))])

    def _vectors(self, declared: list) -> list:
        return [self.numbers(v) if isinstance(v, list) else self.number(v) for v in declared]

    def _properties(self, body: dict) -> solids.Properties:
        """(m, com, I about it) in body axes."""
        if "shape" in body:
            return solids.of_shape(body["shape"], self.number, self._vectors)
        if "parts" in body:
            return solids.of_parts(None, [self._part(x) for x in body["parts"]])
        m = self.number(body["mass"]) if "mass" in body else 0.0
        com = self.numbers(body["center"]) if "center" in body else np.zeros(3)
        return m, com, self._inertia(body.get("inertia", 0.0))

    def _part(self, part: dict) -> tuple:
        if "mass" not in part:
            raise NotCovered("the mass of a part by its volume")
        table = {key: x for key, x in part.items() if key not in ("at", "angle", "axis", "hole", "turned")}
        m, com, inertia = solids.of_shape(table, self.number, self._vectors)
        R = turn(part.get("axis", [0, 0, 1]), self.number(part.get("angle", 0)))
        at = self.numbers(part["at"]) if "at" in part else np.zeros(3)
        return part, (m, at + R @ com, solids.turned(R, inertia)), -1 if part.get("hole") else 1

    def _inertia(self, declared: Any) -> np.ndarray:
        if not isinstance(declared, list):
            return np.diag([0.0, 0.0, self.number(declared)])
        x = [self.number(v) for v in declared]
        if len(x) == 3:
            return np.diag(x)
        return np.array([[x[0], x[3], x[5]], [x[3], x[1], x[4]], [x[5], x[4], x[2]]])

    def parent(self, body: dict) -> str | None:
        on = body.get("joint", {}).get("on")
        return None if on is None else on.partition(".")[0]

    @cached_property
    def order(self) -> list[str]:
        """Bodies, parents first."""
        found: list[str] = []

        def add(name: str) -> None:
            parent = self.parent(self.bodies[name])
            if parent is not None and parent not in found:
                add(parent)
            if name not in found:
                found.append(name)

        for name in self.bodies:
            add(name)
        return found

    @cached_property
    def driven(self) -> list[str]:
        laws = ("motion", "rate", "acceleration")
        return [q for q, part in self.coordinates.items() if any(law in part for law in laws)]

    def law(self, declared: Any, t: float, unit: float = 1.0) -> np.ndarray:
        """(f, f', f'') of a function of time: an expression, or samples."""
        if isinstance(declared, dict) and "samples" in declared:
            return unit * sampled(declared, t)
        if isinstance(declared, dict):
            return self.law(declared["value"], t, unit * formulas.factor(declared.get("unit", "1")))
        if isinstance(declared, str):
            known = Moving(self, Jet(np.array([[t], [1.0], [0.0]])), {})
            c = jet(known.value(declared)).c[:, 0]
            return np.array([c[0], c[1], 2 * c[2]]) * (
                unit if not formulas.names_in(formulas.parsed(declared)) - {"t", "pi"} else 1
            )
        return np.array([declared * unit, 0.0, 0.0])

    def driven_at(self, q: str, t: float) -> np.ndarray:
        """(q, q', q'') of a driven coordinate; what is given by its rate is integrated by Gauss' points."""
        part = self.coordinates[q]
        unit = formulas.factor(part.get("unit", "1"))
        start, speed = (self._start(part, key, unit) for key in ("start", "speed"))
        if "motion" in part:
            return self.law(part["motion"], t, unit)
        if "rate" in part:
            f = self.law(part["rate"], t, unit)
            moved = quadrature(lambda s: self.law(part["rate"], s, unit)[0], t, knots(part["rate"]))
            return np.array([start + moved, f[0], f[1]])
        f = self.law(part["acceleration"], t, unit)
        rate = quadrature(lambda s: self.law(part["acceleration"], s, unit)[0], t, knots(part["acceleration"]))
        way = quadrature(lambda s: (t - s) * self.law(part["acceleration"], s, unit)[0], t, knots(part["acceleration"]))
        return np.array([start + speed * t + way, speed + rate, f[0]])

    def _start(self, part: dict, key: str, unit: float) -> float:
        x = part.get(key, 0.0)
        return x * unit if isinstance(x, (int, float)) else self.number(x)

    def input(self, name: str, known: Moving) -> Any:
        if known.inputs is not None and name in known.inputs:
            return known.inputs[name]
        x = self.inputs[name]
        unit = formulas.factor(x.get("unit", "1")) if isinstance(x, dict) else 1.0
        if isinstance(x, dict) and ("samples" in x or isinstance(x.get("value"), dict)):
            return float(self.law(x if "samples" in x else x["value"], known.t.value, unit)[0])
        value = x["value"] if isinstance(x, dict) else x
        return float(self.law(value, known.t.value, unit)[0])


def turn(axis: Any, angle: float) -> np.ndarray:
    return ty.turn(np.array([*axis, *[0.0] * (3 - len(axis))], dtype=float), angle).c[0][..., 0]


def knots(declared: Any) -> list[float]:
    return [s[0] for s in declared["samples"]] if isinstance(declared, dict) and "samples" in declared else []


def quadrature(f: Any, t: float, breaks: list[float]) -> float:
    """Integral from 0 to t, by Gauss' points between the breaks."""
    x, w = np.polynomial.legendre.leggauss(20)
    inner = sorted(b for b in breaks if 0 < b < t)
    total, places = 0.0, [0.0, *inner, t]
    for a, b in itertools.pairwise(places):
        n = max(1, int(np.ceil((b - a) * 2)))
        for k in range(n):
            lo, hi = a + (b - a) * k / n, a + (b - a) * (k + 1) / n
            total += (
                (hi - lo) / 2 * sum(wi * f((lo + hi) / 2 + (hi - lo) / 2 * xi) for xi, wi in zip(x, w, strict=True))
            )
    return total


def sampled(declared: dict, t: float) -> np.ndarray:
    """(f, f', f'') of samples at t; beyond the ends a cubic goes on straight, anything else stays."""
    from scipy.interpolate import CubicSpline, PchipInterpolator

    x, y = np.array(declared["samples"], dtype=float).T
    between = declared.get("between", "cubic")
    if between == "steps":
        return np.array([y[max(0, np.searchsorted(x, t, side="right") - 1)], 0.0, 0.0])
    if between == "linear":
        k = min(max(int(np.searchsorted(x, t, side="right")) - 1, 0), len(x) - 2)
        inside = x[0] <= t < x[-1]
        return np.array([np.interp(t, x, y), (y[k + 1] - y[k]) / (x[k + 1] - x[k]) if inside else 0.0, 0.0])
    if between == "pchip":
        curve = PchipInterpolator(x, y)
    else:
        ends = {"not-a-knot": "not-a-knot", "natural": "natural", "rest": "clamped"}[declared.get("ends", "not-a-knot")]
        curve = CubicSpline(x, y, bc_type=ends)
    if x[0] <= t <= x[-1]:
        return np.array([curve(t), curve(t, 1), curve(t, 2)])
    end = x[0] if t < x[0] else x[-1]
    return np.array([curve(end) + curve(end, 1) * (t - end), curve(end, 1), 0.0])
