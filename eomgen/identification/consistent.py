"""Inertial parameters that a body can have: its masses are positive, wherever they are.

With Sigma = integral of r r^T dm and h = m c, the pseudo-inertia [[Sigma, h], [h^T, m]] = L L^T is positive for every
lower triangular L with a diagonal exp(.): so any numbers z give a body of positive density, I = tr(Sigma) 1 - Sigma.
In the plane Sigma is 2 x 2 and Izz its trace.
Source: Rucker & Wensing, Smooth parameterization of rigid-body inertia, IEEE RA-L 7 (2022).
"""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from eomgen.symbolic.numeric.tolerances import LEAST_DENSITY

ENTRIES = {"Ixy": (0, 1), "Iyz": (1, 2), "Izx": (0, 2)}
MOMENTS = ("mx", "my", "mz")


def parameters_of(z: np.ndarray, size: int) -> dict[str, float]:
    """m, m c and the inertia about the origin that the numbers z give; `size` 3 in space, 2 in the plane."""
    L = np.zeros((size + 1, size + 1))
    L[np.tril_indices(size + 1)] = z
    L[np.diag_indices(size + 1)] = np.exp(np.diag(L))
    J = L @ L.T
    Sigma, found = J[:size, :size], {"m": J[size, size]}
    found |= {name: J[k, size] for k, name in enumerate(MOMENTS[:size])}
    if size == 2:
        return found | {"Izz": float(np.trace(Sigma))}
    I = np.trace(Sigma) * np.eye(3) - Sigma
    found |= {"Ixx": I[0, 0], "Iyy": I[1, 1], "Izz": I[2, 2]}
    return found | {name: I[i, j] for name, (i, j) in ENTRIES.items()}


def numbers_of(own: Mapping[str, float], size: int) -> np.ndarray:
    """z of a body; of one without extent that of a small one."""
    m = float(max(own["m"], LEAST_DENSITY))
    h = np.array([own[name] for name in MOMENTS[:size]])
    if size == 2:
        center = h / m
        Sigma = np.eye(2) * max(float(own["Izz"] - m * center @ center), 0.0) / 2 + np.outer(h, h) / m
    else:
        I = np.diag([own["Ixx"], own["Iyy"], own["Izz"]])
        for name, (i, j) in ENTRIES.items():
            I[i, j] = I[j, i] = own[name]
        Sigma = np.trace(I) / 2 * np.eye(3) - I
    about_center = Sigma - np.outer(h, h) / m
    values, axes = np.linalg.eigh(about_center)
    least = LEAST_DENSITY * max(float(np.abs(values).max()), m * LEAST_DENSITY)
    Sigma = axes @ np.diag(np.maximum(values, least)) @ axes.T + np.outer(h, h) / m
    J = np.block([[Sigma, h[:, None]], [h[None, :], np.array([[m]])]])
    L = np.linalg.cholesky(J)
    L[np.diag_indices(size + 1)] = np.log(np.diag(L))
    z: np.ndarray = L[np.tril_indices(size + 1)]
    return z
