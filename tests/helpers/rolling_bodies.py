"""A round body on a plane by Newton and Euler in vectors, with numpy alone: what rolling is held against."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np


def skew(v) -> np.ndarray:
    """v x, as a matrix."""
    return np.array([[0, -v[2], v[1]], [v[2], 0, -v[0]], [-v[1], v[0], 0]])


def rotation_of(e) -> np.ndarray:
    """R of a unit quaternion, scalar first."""
    v = np.array(e[1:])
    return (e[0] ** 2 - v @ v) * np.eye(3) + 2 * np.outer(v, v) + 2 * e[0] * skew(v)


@dataclass(frozen=True)
class RoundBody:
    """Mass m, centre com and inertia I about it (body axes); its surface: "ball", "wheel" (axis, tube) or "egg"."""

    m: float
    com: np.ndarray
    I: np.ndarray
    surface: str
    size: tuple[float, ...]
    axis: tuple[float, ...] = (0.0, 0.0, 1.0)
    tube: float = 0.0

    def reach(self, R, w, n, n_rate) -> tuple[np.ndarray, np.ndarray]:
        """From the centre to the lowest place, and its rate, ground axes."""
        if self.surface == "ball":
            return -self.size[0] * n, -self.size[0] * n_rate
        if self.surface == "wheel":
            a = R @ np.array(self.axis)
            a_rate = np.cross(w, a)
            p, k = n - (n @ a) * a, n @ a
            p_rate = n_rate - (n_rate @ a + n @ a_rate) * a - k * a_rate
            size = np.sqrt(p @ p)
            down, down_rate = p / size, p_rate / size - p * (p @ p_rate) / size**3
            return -self.size[0] * down - self.tube * n, -self.size[0] * down_rate - self.tube * n_rate
        A = R @ np.diag(np.square(self.size)) @ R.T
        A_rate = skew(w) @ A - A @ skew(w)
        h = np.sqrt(n @ A @ n)
        h_rate = (n @ A_rate @ n + 2 * n_rate @ A @ n) / (2 * h)
        return -A @ n / h, -(A_rate @ n + A @ n_rate) / h + A @ n * h_rate / h**2

    def accelerations(self, R, w, v, n, turning, g) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """(a of the centre, w' in body axes, force of the plane) where it rolls on a plane that turns steadily.

        m (a + w' x c + w x (w x c)) = F + m g,  I w' + w x I w = (r - c) x F,
        a + w' x r + w x r' = Omega x (v + r').
        """
        r, r_rate = self.reach(R, w, n, np.cross(turning, n))
        c, inertia = R @ self.com, R @ self.I @ R.T
        zero, one = np.zeros((3, 3)), np.eye(3)
        left = np.block([[self.m * one, -self.m * skew(c), -one], [zero, inertia, -skew(r - c)], [one, -skew(r), zero]])
        right = np.concatenate(
            [
                self.m * (g - np.cross(w, np.cross(w, c))),
                -np.cross(w, inertia @ w),
                np.cross(turning, v + r_rate) - np.cross(w, r_rate),
            ]
        )
        found = np.linalg.solve(left, right)
        return found[:3], R.T @ found[3:6], found[6:]
