"""Chains of hinged rigid bodies in space that close, in floating point: accelerations by maximal coordinates.

Of every body the mass centre's a and the angular acceleration e; of every hinge at P with the axis n, carried by A:

    a_A + e_A x r_A + w_A x (w_A x r_A) = the same of B
    d . (e_B - e_A) + (w_A x d) . (w_B - w_A) = 0      for two directions d of A across n

Newton's and Euler's equations with the forces of the hinges make it square; redundant rows are left to least squares.
Nothing of eomgen.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

Vector = Sequence[float]


@dataclass(frozen=True)
class Link:
    """A body on the one before it; the axes of all agree where every angle is 0.

    Args:
        hinge: from the hinge of the body before, in its axes; of the first from the ground's origin.
        axis: of the hinge.
        com: from the hinge, body axes.
        m, inertia: about the mass centre, body axes, 3 or 3 x 3.
    """

    hinge: Vector
    axis: Vector
    com: Vector
    m: float
    inertia: Sequence[float]


@dataclass(frozen=True)
class Closing:
    """A point of the last body is held to where it stands when all angles are 0; with an axis it is a hinge."""

    point: Vector
    axis: Vector | None = None


@dataclass(frozen=True)
class Chain:
    links: Sequence[Link]
    closing: Closing
    gravity: Vector

    def accelerations(self, q: np.ndarray, u: np.ndarray) -> np.ndarray:
        """q'' at a state at which the loop is closed."""
        frames, n = self._frames(q, u), len(self.links)
        rows, right = [], []
        for k in range(n + 1):
            for row, value in self._rows(frames, k):
                rows.append(row)
                right.append(value)
        C, g = np.array(rows), np.array(right)
        mass, force = self._newton(frames)
        K = np.block([[mass, C.T], [C, np.zeros((len(C), len(C)))]])
        x = np.linalg.lstsq(K, np.concatenate([force, g]), rcond=1e-10)[0]
        found = []
        for k, frame in enumerate(frames):
            before = x[6 * k - 3 : 6 * k] if k else np.zeros(3)
            found.append(frame["n"] @ (x[6 * k + 3 : 6 * k + 6] - before))
        return np.array(found)

    def _frames(self, q: np.ndarray, u: np.ndarray) -> list[dict[str, np.ndarray]]:
        R, p, w, found = np.eye(3), np.zeros(3), np.zeros(3), []
        for link, angle, rate in zip(self.links, q, u, strict=True):
            p, n = p + R @ np.array(link.hinge), R @ unit(link.axis)
            before, R = R, R @ turn(unit(link.axis), angle)
            w = w + rate * n
            found.append({"R": R, "before": before, "P": p, "n": n, "w": w, "c": p + R @ np.array(link.com)})
        return found

    def _rows(self, frames: list[dict[str, np.ndarray]], k: int) -> list[tuple[np.ndarray, float]]:
        """The rows of the k-th hinge; the last is the one that closes."""
        n = len(frames)
        A, B = frames[k - 1] if k else None, frames[k] if k < n else None
        if B is not None:
            P, axis, before = B["P"], unit(self.links[k].axis), B["before"]
        else:
            assert A is not None
            P, before = A["P"] + A["R"] @ np.array(self.closing.point), A["R"]
            axis = None if self.closing.axis is None else unit(self.closing.axis)
        found = []
        for e in np.eye(3):
            row, value = np.zeros(6 * n), 0.0
            for body, frame, sign in ((k - 1, A, 1.0), (k, B, -1.0)):
                if frame is not None:
                    r = P - frame["c"]
                    row[6 * body : 6 * body + 3] = sign * e
                    row[6 * body + 3 : 6 * body + 6] = sign * np.cross(r, e)
                    value -= sign * e @ np.cross(frame["w"], np.cross(frame["w"], r))
            found.append((row, value))
        if axis is not None:
            wA, wB = (np.zeros(3) if frame is None else frame["w"] for frame in (A, B))
            for d in across(axis):
                d = before @ d
                row = np.zeros(6 * n)
                for body, frame, sign in ((k - 1, A, -1.0), (k, B, 1.0)):
                    if frame is not None:
                        row[6 * body + 3 : 6 * body + 6] = sign * d
                found.append((row, -np.cross(wA, d) @ (wB - wA)))
        return found

    def _newton(self, frames: list[dict[str, np.ndarray]]) -> tuple[np.ndarray, np.ndarray]:
        n = len(frames)
        mass, force = np.zeros((6 * n, 6 * n)), np.zeros(6 * n)
        for k, (link, frame) in enumerate(zip(self.links, frames, strict=True)):
            I = frame["R"] @ np.diag(link.inertia) @ frame["R"].T
            mass[6 * k : 6 * k + 3, 6 * k : 6 * k + 3] = link.m * np.eye(3)
            mass[6 * k + 3 : 6 * k + 6, 6 * k + 3 : 6 * k + 6] = I
            force[6 * k : 6 * k + 3] = link.m * np.array(self.gravity)
            force[6 * k + 3 : 6 * k + 6] = -np.cross(frame["w"], I @ frame["w"])
        return mass, force


def unit(v: Vector) -> np.ndarray:
    return np.array(v, dtype=float) / np.linalg.norm(v)


def across(n: np.ndarray) -> list[np.ndarray]:
    """Two directions across n."""
    d = unit(np.cross(n, np.eye(3)[int(np.argmin(np.abs(n)))]))
    return [d, np.cross(n, d)]


def turn(n: np.ndarray, angle: float) -> np.ndarray:
    """The rotation about n."""
    K = np.array([[0, -n[2], n[1]], [n[2], 0, -n[0]], [-n[1], n[0], 0]])
    return np.eye(3) + np.sin(angle) * K + (1 - np.cos(angle)) * K @ K


def bricard() -> Chain:
    """Five rods of 1 kg along edges of a cube of 1 m, the last hinged to the ground; weight along -y."""
    rod = {(1, 0, 0): (0, 1, 1), (0, 1, 0): (1, 0, 1), (0, 0, 1): (1, 1, 0)}
    along = [(1, 0, 0), (0, -1, 0), (0, 0, 1), (-1, 0, 0), (0, 1, 0)]
    axes = [(0, 1, 0), (0, 0, 1), (1, 0, 0), (0, 1, 0), (0, 0, 1)]
    hinges = [(0, 0, 0), *along[:-1]]
    links = [
        Link(hinge, axis, np.array(d) / 2, 1.0, np.array(rod[tuple(map(abs, d))]) / 12)
        for hinge, axis, d in zip(hinges, axes, along, strict=True)
    ]
    return Chain(links, Closing(along[-1], (1, 0, 0)), (0, -9.81, 0))
