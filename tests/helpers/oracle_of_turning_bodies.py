"""The bodies of the notes that turn in space, in numbers; nothing of eomgen is used here.

Every body is a vector of angular momentum and a matrix R of its axes in space:

    dL/dt = torque,   R' = R w~,   w = I^-1 R^T L

so that no term is written that could have a wrong sign: w x I w comes out of a constant L by itself.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from scipy.integrate import solve_ivp
from scipy.spatial.transform import Rotation

Numbers = dict[str, float]
Vector = np.ndarray

ORACLES: dict[str, Callable[[Numbers], Numbers]] = {}
TOLERANCE = 1e-12


def oracle(function: Callable[[Numbers], Numbers]) -> Callable[[Numbers], Numbers]:
    """Puts a system into ORACLES under the name of its model file."""
    ORACLES[function.__name__] = function
    return function


def across(w: Vector) -> Vector:
    """w~ with w~ v = w x v."""
    return np.cross(np.eye(3), w)


@dataclass(frozen=True)
class Body:
    """A body about a fixed point or its mass centre.

    Args:
        inertia: its tensor there, body axes.
        torque: at R and w, axes of the ground.
    """

    inertia: Vector
    torque: Callable[[Vector, Vector], Vector] = lambda R, w: np.zeros(3)

    def spin(self, R: Vector, L: Vector) -> Vector:
        """w in body axes."""
        return np.linalg.solve(self.inertia, R.T @ L)

    def rates(self, R: Vector, w: Vector) -> Vector:
        """w' = I^-1 (R^T torque - w x I w), from d/dt (R I w) = torque."""
        turned = R @ across(w) @ self.inertia @ w
        return np.linalg.solve(self.inertia, R.T @ (self.torque(R, w) - turned))

    def after(self, time: float, w: Vector) -> tuple[Vector, Vector]:
        """(w, L) after that time, from R = 1."""

        def slope(_t: float, x: Vector) -> Vector:
            R, L = x[:9].reshape(3, 3), x[9:]
            w = self.spin(R, L)
            return np.concatenate([(R @ across(w)).ravel(), self.torque(R, w)])

        start = np.concatenate([np.eye(3).ravel(), self.inertia @ w])
        x = solve_ivp(slope, (0, time), start, method="DOP853", rtol=TOLERANCE, atol=TOLERANCE).y[:, -1]
        R, L = x[:9].reshape(3, 3), x[9:]
        return self.spin(R, L), L


def principal(n: Numbers) -> Vector:
    return np.diag([n["I1"], n["I2"], n["I3"]])


@oracle
def s1_euler(n: Numbers) -> Numbers:
    N = np.array([n["N1"], n["N2"], n["N3"]])
    rates = Body(principal(n), lambda R, w: R @ N).rates(np.eye(3), np.array([1.0, 0.0, 1.0]))
    return dict(zip(("omega1_d", "omega2_d", "omega3_d"), rates, strict=True))


@oracle
def s1_torque_free(n: Numbers) -> Numbers:
    body, w = Body(principal(n)), np.array([1.0, 0.0, 1.0])
    L = body.inertia @ w
    later, L_later = body.after(5, w)
    T = w @ body.inertia @ w / 2
    return {
        "L_squared": L @ L,
        "T": T,
        "L_squared_case": L @ L,
        "T_case": T,
        "omega_at_5s": float(np.linalg.norm(later)),
        "omega1_at_5s": later[0],
        "omega2_at_5s": later[1],
        "omega3_at_5s": later[2],
        "L_x_at_5s": L_later[0],
        "L_z_at_5s": L_later[2],
        "omega2_d_at_0": body.rates(np.eye(3), w)[1],
    }


@oracle
def s1_symmetric_top(n: Numbers) -> Numbers:
    body = Body(np.diag([n["I_t"], n["I_t"], n["I_3"]]))
    w = np.array([n["w_t"], 0.0, n["w_3"]])
    later, _ = body.after(n["t1"], w)
    L = body.inertia @ w
    axis = np.array([0.0, 0.0, 1.0])
    n_hat = L / np.linalg.norm(L)
    turned = np.cross(w, axis)  # how the axis moves in space: Omega n x axis
    precession = np.linalg.norm(turned) / np.linalg.norm(np.cross(n_hat, axis))
    return {
        "Omega_body": body.rates(np.eye(3), w)[1] / w[0],
        "precession_space": precession,
        "omega1": later[0],
        "omega2": later[1],
        "omega3": later[2],
    }


@oracle
def s1_dominant_spin(n: Numbers) -> Numbers:
    body, w = Body(principal(n)), np.array([10.0, 0.01, 0.01])
    rates = body.rates(np.eye(3), w)
    return {"omega1_d": rates[0], "frequency_squared": -(rates[1] / w[2]) * (rates[2] / w[1])}


@oracle
def s1_lagrange_top(n: Numbers) -> Numbers:
    phi, theta, psi = 0.0, 0.5, 0.0
    up, across_axis = np.array([0.0, 0.0, 1.0]), np.array([1.0, 0.0, 0.0])
    R = Rotation.from_euler("ZXZ", [phi, theta, psi]).as_matrix()
    inertia = np.diag([n["I_t"], n["I_t"], n["I_3"]])
    nodes = Rotation.from_euler("Z", phi).apply(across_axis)  # the axis of theta'
    spin_axis = R @ up  # the axis of psi'
    w = R.T @ (2 * up + 0 * nodes + 120 * spin_axis)
    body = Body(inertia, lambda R, w: np.cross(n["d"] * R @ up, -n["M"] * n["g"] * up))
    L = R @ inertia @ w
    moved = R @ (np.cross(body.rates(R, w), up) + np.cross(w, np.cross(w, up)))  # acceleration of the axis' tip
    p_psi = float(L @ spin_axis)
    return {
        "p_phi": float(L @ up),
        "p_psi": p_psi,
        "p_psi_later": p_psi,
        "omega3": float(w[2]),
        "energy": float(w @ inertia @ w / 2 + n["M"] * n["g"] * n["d"] * spin_axis[2]),
        "theta_dd": float(-moved[2] / np.sin(theta)),  # theta' = 0
    }
