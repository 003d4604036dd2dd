"""Inverse dynamics of a serial arm in plain floats, from the model file's numbers alone: Newton and Euler, by links.

Nothing of eomgen's mechanics is used; the file is read by tomllib.
"""

from __future__ import annotations

import math
import tomllib
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from eomgen.symbolic.expression.text import parse


@dataclass(frozen=True)
class Link:
    """One link of a serial arm, its joint's axis and place in the axes of the link before it.

    Args:
        R: fixed rotation of the joint against the link before, 3 x 3.
        p: place of the joint on the link before, 3 [m].
        axis: of the joint, in the axes turned by R, 3.
        m, com, I: mass [kg]; mass centre [m] and inertia about it [kg m^2] in the link's axes.
    """

    R: np.ndarray
    p: np.ndarray
    axis: np.ndarray
    m: float
    com: np.ndarray
    I: np.ndarray


def rotation(axis: np.ndarray, angle: float) -> np.ndarray:
    """Rodrigues: R = 1 + sin(angle) K + (1 - cos(angle)) K^2, K = axis x."""
    x, y, z = np.asarray(axis, float) / np.linalg.norm(axis)
    K = np.array([[0, -z, y], [z, 0, -x], [-y, x, 0]])
    return np.eye(3) + math.sin(angle) * K + (1 - math.cos(angle)) * K @ K


def read_arm(path: Path) -> tuple[list[Link], float]:
    """The links of a serial arm of revolute joints in a model file, and g."""
    table = tomllib.loads(path.read_text())
    values = {name: float(value) for name, value in table["parameters"].items()} | {"pi": math.pi}

    def number(value) -> float:
        return float(parse(value).evaluate(values)) if isinstance(value, str) else float(value)

    def vector(entries) -> np.ndarray:
        return np.array([number(entry) for entry in entries])

    links = []
    for body in table["bodies"].values():
        joint = body["joint"]
        parent, _, point = joint.get("on", "").partition(".")
        place = table["bodies"][parent]["points"][point] if point else joint.get("at", [0, 0, 0])
        turned = joint.get("turned", {"axis": [0, 0, 1], "angle": 0})
        inertia = vector(body["inertia"])
        xx, yy, zz, xy, yz, xz = inertia if len(inertia) == 6 else (*inertia, 0, 0, 0)
        links.append(
            Link(
                R=rotation(vector(turned["axis"]), number(turned["angle"])),
                p=vector(place),
                axis=vector(joint["axis"]),
                m=number(body["mass"]),
                com=vector(body.get("center", [0, 0, 0])),
                I=np.array([[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]]),
            )
        )
    return links, values["g"]


def inverse_dynamics(links: list[Link], g: float, q, u, a) -> np.ndarray:
    """The joint torques [N m] that give the accelerations a at the state (q, u), gravity -g along z.

    Outward, all in ground axes: w = w_p + z u;  alpha = alpha_p + z a + w_p x z u;
    acc = acc_p + alpha_p x r + w_p x (w_p x r). Inward: f = m acc_C + f_child;
    n = I alpha + w x I w + c x m acc_C + n_child + r_child x f_child;  tau = z . n
    """
    R, w, alpha = np.eye(3), np.zeros(3), np.zeros(3)
    acc = np.array([0, 0, g])  # an upward acceleration of the ground stands for the weight
    outward = []
    for link, angle, rate, second in zip(links, q, u, a, strict=True):
        r = R @ link.p
        acc = acc + np.cross(alpha, r) + np.cross(w, np.cross(w, r))
        z = R @ link.R @ (link.axis / np.linalg.norm(link.axis))
        alpha = alpha + z * second + np.cross(w, z * rate)
        w = w + z * rate
        R = R @ link.R @ rotation(link.axis, angle)
        c = R @ link.com
        inertia = R @ link.I @ R.T
        force = link.m * (acc + np.cross(alpha, c) + np.cross(w, np.cross(w, c)))
        moment = inertia @ alpha + np.cross(w, inertia @ w) + np.cross(c, force)
        outward.append((r, z, force, moment))
    torques, f, n = [], np.zeros(3), np.zeros(3)
    for r, z, force, moment in reversed(outward):
        f, n = f + force, n + moment
        torques.append(z @ n)
        n = n + np.cross(r, f)  # about the joint before
    return np.array(torques[::-1])
