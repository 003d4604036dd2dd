"""Plane linkages in floating point: velocities, accelerations, and their model as text. Nothing of eomgen.

A body moves by (v_x, v_y, w) of its point at the ground's origin: v(P) = (v_x - w y, v_y + w x), and
a(P) = (a_x - e y - w^2 x, a_y + e x - w^2 y) with the part of the place's own motion in w^2 counted by velocities:
d/dt (w z x p) = e z x p + w z x v.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from fractions import Fraction
from random import Random

import numpy as np

Place = tuple[Fraction, Fraction]
HEAD = 'eomgen = 1\nspace = "plane"\n'


@dataclass(frozen=True)
class Linkage:
    """Bars with points in ground axes.

    Args:
        bodies: {body: {point: place}}.
        hinges: pairs of points "body.point".
        pins: points held to the ground.
        rollers: (point, normal).
        driver: the body whose angular velocity and acceleration are given.
    """

    bodies: Mapping[str, Mapping[str, Place]]
    hinges: Sequence[tuple[str, str]]
    pins: Sequence[str]
    rollers: Sequence[tuple[str, Place]] = ()
    driver: str = "I"

    def place(self, point: str) -> np.ndarray:
        body, name = point.split(".")
        return np.array([float(x) for x in self.bodies[body][name]])

    # -- in numbers ------------------------------------------------------------------------------------

    def _rows(self) -> list[tuple[list[tuple[str, float]], np.ndarray]]:
        """(points with signs, direction): sum of sign * direction . v(point) = 0."""
        axes = (np.array([1.0, 0.0]), np.array([0.0, 1.0]))
        rows = [([(a, 1.0), (b, -1.0)], e) for a, b in self.hinges for e in axes]
        rows += [([(a, 1.0)], e) for a in self.pins for e in axes]
        return rows + [([(a, 1.0)], np.array([float(x) for x in n])) for a, n in self.rollers]

    def _solved(self, given: float, right: Sequence[float]) -> dict[str, np.ndarray]:
        index = {name: 3 * k for k, name in enumerate(self.bodies)}
        rows = self._rows()
        A = np.zeros((len(rows) + 1, 3 * len(index)))
        for i, (terms, n) in enumerate(rows):
            for point, sign in terms:
                k = index[point.split(".")[0]]
                x, y = self.place(point)
                A[i, k : k + 3] += sign * np.array([n[0], n[1], n[1] * x - n[0] * y])
        A[-1, index[self.driver] + 2] = 1
        found = np.linalg.solve(A, [*right, given])
        return {name: found[k : k + 3] for name, k in index.items()}

    def velocities(self, w: float) -> dict[str, np.ndarray]:
        """(v_x, v_y, w) of every body."""
        return self._solved(w, [0.0] * len(self._rows()))

    def velocity(self, motion: Mapping[str, np.ndarray], point: str) -> np.ndarray:
        vx, vy, w = motion[point.split(".")[0]]
        x, y = self.place(point)
        return np.array([vx - w * y, vy + w * x])

    def accelerations(self, w: float, e: float) -> dict[str, np.ndarray]:
        """(a_x, a_y, e) of every body, the parts w z x v of its points left to `acceleration`."""
        motion = self.velocities(w)
        right = [-sum(sign * n @ self._turned(motion, point) for point, sign in terms) for terms, n in self._rows()]
        return self._solved(e, right)

    def _turned(self, motion: Mapping[str, np.ndarray], point: str) -> np.ndarray:
        """w z x v of a point."""
        vx, vy = self.velocity(motion, point)
        w = motion[point.split(".")[0]][2]
        return np.array([-w * vy, w * vx])

    def acceleration(self, w: float, e: float, point: str) -> np.ndarray:
        ax, ay, epsilon = self.accelerations(w, e)[point.split(".")[0]]
        x, y = self.place(point)
        return np.array([ax - epsilon * y, ay + epsilon * x]) + self._turned(self.velocities(w), point)

    # -- as text -----------------------------------------------------------------------------------------

    def text(self, more: str = "", rng: Random | None = None) -> str:
        """The model; with `rng` each body in axes of its own, moved and turned by right angles."""
        lines = [HEAD]
        for name, points in self.bodies.items():
            turns = 0 if rng is None else rng.randrange(4)
            at = (0, 0) if rng is None else (rng.randint(-3, 3), rng.randint(-3, 3))
            joint = f'joint = {{ kind = "placed", at = [{at[0]}, {at[1]}], angle = "{turns}*pi/2" }}\n' if rng else ""
            places = {p: _into(place, at, turns) for p, place in points.items()}
            own = (f'{p} = ["{x}", "{y}"]' for p, (x, y) in places.items())
            lines.append(f"[bodies.{name}]\n{joint}points = {{ {', '.join(own)} }}\n")
        lines.append("[constraints]\n")
        lines += [f'H{k} = {{ kind = "pin", points = ["{a}", "{b}"] }}\n' for k, (a, b) in enumerate(self.hinges)]
        lines += [f'P{k} = {{ kind = "pin", points = ["{a}"] }}\n' for k, a in enumerate(self.pins)]
        lines += [
            f'R{k} = {{ kind = "support", point = "{a}", normal = ["{n[0]}", "{n[1]}"] }}\n'
            for k, (a, n) in enumerate(self.rollers)
        ]
        return "".join(lines) + more


def _into(place: Place, at: tuple[int, int], turns: int) -> Place:
    """A place of the ground in axes that stand at `at`, turned by quarters."""
    x, y = place[0] - at[0], place[1] - at[1]
    for _ in range(turns):
        x, y = y, -x
    return x, y


def somewhere(rng: Random) -> Place:
    return Fraction(rng.randint(-40, 40), 8), Fraction(rng.randint(-40, 40), 8)


def four_bar(rng: Random) -> Linkage:
    O, A, B, C, M = (somewhere(rng) for _ in range(5))
    bodies = {"I": {"O": O, "A": A}, "II": {"A": A, "B": B, "M": M}, "III": {"B": B, "C": C}}
    return Linkage(bodies, [("I.A", "II.A"), ("II.B", "III.B")], ["I.O", "III.C"])


def slider_crank(rng: Random) -> Linkage:
    O, A, B, M = (somewhere(rng) for _ in range(4))
    bodies = {"I": {"O": O, "A": A}, "II": {"A": A, "B": B, "M": M}}
    normal = (Fraction(3, 5), Fraction(4, 5)) if rng.random() < 0.5 else (Fraction(0), Fraction(1))
    return Linkage(bodies, [("I.A", "II.A")], ["I.O"], [("II.B", normal)])


def watt(rng: Random) -> Linkage:
    """A six-bar: a four-bar whose coupler carries a dyad to the ground."""
    first, (D, E, M) = four_bar(rng), (somewhere(rng) for _ in range(3))
    coupler = first.bodies["II"]
    bodies = {**first.bodies, "IV": {"M": coupler["M"], "D": D, "Q": M}, "V": {"D": D, "E": E}}
    return Linkage(bodies, [*first.hinges, ("II.M", "IV.M"), ("IV.D", "V.D")], [*first.pins, "V.E"])


def stephenson(rng: Random) -> Linkage:
    """A six-bar without a four-bar at the driver: its centres are not all found by lines of three."""
    O, A, B, C, D, E, F, G = (somewhere(rng) for _ in range(8))
    bodies = {
        "I": {"O": O, "A": A},
        "II": {"A": A, "B": B, "C": C},
        "III": {"B": B, "D": D},
        "IV": {"C": C, "E": E},
        "V": {"D": D, "E": E, "F": F, "G": G},
    }
    hinges = [("I.A", "II.A"), ("II.B", "III.B"), ("II.C", "IV.C"), ("III.D", "V.D"), ("IV.E", "V.E")]
    return Linkage(bodies, hinges, ["I.O", "V.F"])


ALL = (four_bar, slider_crank, watt, stephenson)
