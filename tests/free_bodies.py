"""Reactions of a model from its text alone, in plain floats: Newton and Euler for every body, nothing of eomgen's laws.

The text is read by tomllib, its formulas by eomgen's parser. Motion goes outward along the tree in ground axes, every
body gets its own six equations about the ground's origin, and all of them are solved at once for accelerations and
reactions; what the null space touches is indeterminate.
"""

from __future__ import annotations

import math
import tomllib
from collections.abc import Iterator
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np

from eomgen.symbolic.expressions import parse

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
                acc + np.cross(alpha, d) + np.cross(w, np.cross(w, d)) + 2 * np.cross(w, rate)
                + R @ axis * self._value(s, a),
            )  # fmt: skip
            p = p + d
        angle = joint.get("angle", 0)
        axis = self.vector(joint["axis"]) if "axis" in joint and joint["kind"] != "prismatic" else Z
        z = R @ axis / np.linalg.norm(axis)
        rate = z * self._value(angle, u)
        alpha = alpha + z * self._value(angle, a) + np.cross(w, rate)
        w = w + rate
        turn = self.number(angle) if angle not in self.q else self.q[angle]
        R = R @ rotation(axis, turn)
        point = -self.own_point(body, joint.get("point", "origin"))
        child = Place(R, p, w, v, alpha, acc)
        return Place(R, *(child.point(point)[k] if k == 0 else x for k, x in ((0, None), (1, w))),
                     child.point(point)[1], alpha, child.point(point)[2])  # fmt: skip

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
