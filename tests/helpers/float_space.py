"""Trees of bodies in space in floating point, from the textbook: poses, M, c, weights. Nothing of eomgen.

T = 1/2 sum m v.v + w.I w with v and w from the joints' axes; c_i = sum (dM_ij/dq_k - 1/2 dM_jk/dq_i) u_j u_k, the
derivatives by complex steps (q + i h), which lose no digits.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field

import numpy as np

STEP = 1e-30
O = np.zeros(3)


def turn(axis: Sequence[float], angle) -> np.ndarray:
    """Rodrigues: R = 1 + sin K + (1 - cos) K^2."""
    x, y, z = np.asarray(axis, float) / np.linalg.norm(axis)
    K = np.array([[0, -z, y], [z, 0, -x], [-y, x, 0]])
    return np.eye(3) + np.sin(angle) * K + (1 - np.cos(angle)) * K @ K


def of_quaternion(e: Sequence[float]) -> np.ndarray:
    """R = (e0^2 - v.v) 1 + 2 v v^T + 2 e0 [v x]."""
    e0, v = e[0], np.asarray(e[1:])
    cross = np.array([[0, -v[2], v[1]], [v[2], 0, -v[0]], [-v[1], v[0], 0]])
    return (e0**2 - v @ v) * np.eye(3) + 2 * np.outer(v, v) + 2 * e0 * cross


@dataclass(frozen=True)
class Joint:
    """A body on a joint of one freedom, q its angle or its way along the axis.

    Args:
        on: number of the joint that carries it, -1 the ground.
        axis: in the axes `turned` against the parent's.
        at: of the joint in the parent; where the body's origin is.
        mass, center, inertia: of the body, its axes, about the mass centre.
    """

    on: int
    axis: Sequence[float]
    at: Sequence[float] = (0, 0, 0)
    turned: np.ndarray = field(default_factory=lambda: np.eye(3))
    slides: bool = False
    mass: float = 0
    center: Sequence[float] = (0, 0, 0)
    inertia: Sequence[float] = (0, 0, 0)
    armature: float = 0


class Tree:
    """A tree of joints under a weight of acceleration g downwards (z)."""

    def __init__(self, joints: Sequence[Joint], g: float = 0):
        self.joints, self.g = joints, g

    def frames(self, q: np.ndarray) -> list[tuple[np.ndarray, np.ndarray]]:
        """(R, p) of every body."""
        found: list[tuple[np.ndarray, np.ndarray]] = []
        for joint, s in zip(self.joints, q, strict=True):
            R, p = found[joint.on] if joint.on >= 0 else (np.eye(3), O)
            R, p = R @ joint.turned, p + R @ np.asarray(joint.at)
            unit = np.asarray(joint.axis, float) / np.linalg.norm(joint.axis)
            found.append((R, p + R @ unit * s) if joint.slides else (R @ turn(joint.axis, s), p))
        return found

    def jacobian(self, q: np.ndarray, body: int, point: Sequence[float]) -> tuple[np.ndarray, np.ndarray]:
        """(dv/du of a point given in the body's axes, dw/du), ground axes."""
        frames = self.frames(q)
        R, p = frames[body]
        place = p + R @ np.asarray(point)
        v, w = np.zeros((3, len(q)), dtype=place.dtype), np.zeros((3, len(q)), dtype=place.dtype)
        k = body
        while k >= 0:
            joint = self.joints[k]
            axis = frames[k][0] @ (np.asarray(joint.axis, float) / np.linalg.norm(joint.axis))
            v[:, k] = axis if joint.slides else np.cross(axis, place - frames[k][1])
            w[:, k] = 0 if joint.slides else axis
            k = joint.on
        return v, w

    def M(self, q: np.ndarray) -> np.ndarray:
        total = np.diag([joint.armature for joint in self.joints]).astype(np.asarray(q).dtype)
        for k, joint in enumerate(self.joints):
            v, w = self.jacobian(q, k, joint.center)
            R = self.frames(q)[k][0]
            I = np.diag(joint.inertia)
            total = total + joint.mass * v.T @ v + w.T @ R @ I @ R.T @ w
        return total

    def slopes(self, f: Callable[[np.ndarray], np.ndarray], q: np.ndarray) -> list[np.ndarray]:
        """df/dq_k, k by k."""
        return [np.imag(f(q + 1j * STEP * e)) / STEP for e in np.eye(len(q))]

    def c(self, q: np.ndarray, u: np.ndarray) -> np.ndarray:
        D = self.slopes(self.M, q)
        moving = sum(uk * dM for uk, dM in zip(u, D, strict=True))
        return moving @ u - np.array([u @ dM @ u for dM in D]) / 2

    def weight(self, q: np.ndarray) -> np.ndarray:
        down = np.array([0, 0, -self.g])
        return sum(joint.mass * self.jacobian(q, k, joint.center)[0].T @ down for k, joint in enumerate(self.joints))

    def accelerations(self, q, u, Q=0, *, driven: Sequence[int] = ()) -> np.ndarray:
        """a of M a + c = weight + Q; of the driven ones 0."""
        free = [k for k in range(len(self.joints)) if k not in driven]
        right = (self.weight(q) + Q - self.c(q, u))[free]
        a = np.zeros(len(q))
        a[free] = np.linalg.solve(self.M(q)[np.ix_(free, free)], right)
        return a

    def held(self, q, u, J: Callable[[np.ndarray], np.ndarray], Q=0) -> np.ndarray:
        """a of M a + c = weight + Q + J^T lam, J a + J' u = 0, J a function of q."""
        rows, n = J(q), len(q)
        rate = sum(uk * dJ for uk, dJ in zip(u, self.slopes(J, q), strict=True))
        A = np.block([[self.M(q), -rows.T], [rows, np.zeros((len(rows), len(rows)))]])
        right = np.concatenate([self.weight(q) + Q - self.c(q, u), -rate @ u])
        return np.linalg.lstsq(A, right, rcond=None)[0][:n]


def limits_of_nutation(A: float, C: float, mgd: float, theta: float, spin: float) -> np.ndarray:
    """Angles between which a top let go at theta with spin alone nutates, ascending (Goldstein, section 5.7).

    u'^2 = (1 - u^2)(alpha - beta u) - (b - a u)^2, u = cos(theta).
    """
    a, b = C * spin / A, C * spin * np.cos(theta) / A
    beta = 2 * mgd / A
    alpha = beta * np.cos(theta)
    P = np.polynomial.Polynomial
    f = P([1, 0, -1]) * P([alpha, -beta]) - P([b, -a]) ** 2
    roots = np.sort(np.real(f.roots()))
    return np.sort(np.arccos(roots[:2]))


def jacobi(I: Sequence[float], w: Sequence[float], t: float) -> np.ndarray:
    """w(t) of a free body, I_1 > I_2 > I_3, from w_3 = 0 with L^2 > 2 T I_2 (Landau & Lifshitz, section 37)."""
    from scipy.special import ellipj, ellipk

    c, b, a = I
    T2, L2 = np.dot(I, np.square(w)), np.sum(np.square(np.multiply(I, w)))
    p = np.sqrt((c - b) * (L2 - T2 * a) / (a * b * c))
    k2 = (b - a) * (T2 * c - L2) / ((c - b) * (L2 - T2 * a))
    sn, cn, dn, _ = ellipj(p * t - ellipk(k2), k2)
    return np.array(
        [
            np.sqrt((L2 - T2 * a) / (c * (c - a))) * dn,
            -np.sqrt((T2 * c - L2) / (b * (c - b))) * sn,
            np.sqrt((T2 * c - L2) / (a * (c - a))) * cn,
        ]
    )


def platform_of_delta(motors: Sequence[float], out: float, L: float, l: float, u_P: float) -> np.ndarray:
    """Centre of the platform: the lower point at the distance l from the three elbows, each shifted by u_P inwards."""
    centres = []
    for direction, theta in zip((-np.pi / 2, np.pi / 6, 5 * np.pi / 6), motors, strict=True):
        r = out + L * np.cos(theta) - u_P
        centres.append([r * np.cos(direction), r * np.sin(direction), -L * np.sin(theta)])
    first, *others = np.array(centres)
    normal = np.cross(others[0] - first, others[1] - first)
    normal *= -np.sign(normal[2]) / np.linalg.norm(normal)
    A = np.array([*(2 * (p - first) for p in others), normal])
    foot = np.linalg.solve(A, [*(p @ p - first @ first for p in others), normal @ first])
    return foot + normal * np.sqrt(l**2 - (foot - first) @ (foot - first))
