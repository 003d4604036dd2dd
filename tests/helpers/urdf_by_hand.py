"""A URDF file's M and bias in floats, from the file's own words: no recursion, no code of eomgen.

Poses are products of transforms; J_v and J_w are their derivatives by a complex step; then

    M = sum m J_v^T J_v + J_w^T I J_w,    c + g = sum m J_v^T (J_v' v - g) + J_w^T (I J_w' v + w x I w)
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any
from xml.etree import ElementTree

import numpy as np

STEP = 1e-30
WIDE = 2e-3  # of the eighth order differences along the motion
GRAVITY = np.array([0, 0, -9.81])


def numbers(text: str) -> np.ndarray:
    return np.array([float(x) for x in text.split()])


def turned(axis: Any, angle: Any) -> np.ndarray:
    n = np.asarray(axis, dtype=float)
    n = n / np.sqrt(n @ n)
    K = np.array([[0, -n[2], n[1]], [n[2], 0, -n[0]], [-n[1], n[0], 0]])
    return np.eye(3) + np.sin(angle) * K + (1 - np.cos(angle)) * K @ K


def fixed_turn(rpy: Any) -> np.ndarray:
    return turned([0, 0, 1], rpy[2]) @ turned([0, 1, 0], rpy[1]) @ turned([1, 0, 0], rpy[0])


def origin(element: Any) -> tuple[np.ndarray, np.ndarray]:
    found = None if element is None else element.find("origin")
    if found is None:
        return np.eye(3), np.zeros(3)
    return fixed_turn(numbers(found.get("rpy", "0 0 0"))), numbers(found.get("xyz", "0 0 0"))


@dataclass
class ByHand:
    """The joints that move, in the file's order, and M and bias at a state."""

    text: str

    def __post_init__(self) -> None:
        robot = ElementTree.fromstring(self.text)
        self.links = {link.get("name"): link for link in robot.findall("link")}
        self.above = {joint.find("child").get("link"): joint for joint in robot.findall("joint")}
        self.moving = [j.get("name") for j in robot.findall("joint") if j.get("type") != "fixed"]

    def pose(self, link: str, q: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """(R, p) of a link's axes against the root's."""
        joint = self.above.get(link)
        if joint is None:
            return np.eye(3), np.zeros(3)
        R, p = self.pose(joint.find("parent").get("link"), q)
        R0, p0 = origin(joint)
        R, p = R @ R0, p + R @ p0
        kind, name = joint.get("type"), joint.get("name")
        if kind == "fixed":
            return R, p
        axis = np.array([1.0, 0, 0]) if joint.find("axis") is None else numbers(joint.find("axis").get("xyz"))
        s = q[self.moving.index(name)]
        if kind == "prismatic":
            return R, p + R @ (axis / np.sqrt(axis @ axis)) * s
        return R @ turned(axis, s), p

    def bodies(self) -> list[tuple[float, np.ndarray, Callable[[np.ndarray], tuple[np.ndarray, np.ndarray]]]]:
        """(m, I, q -> (R, p) of the principal frame of the file) of each link with mass."""
        found = []
        for name, link in self.links.items():
            inertial = link.find("inertial")
            if inertial is None:
                continue
            R_BI, center = origin(inertial)
            xx, xy, xz, yy, yz, zz = (float(inertial.find("inertia").get(f"i{k}")) for k in "xx xy xz yy yz zz".split())
            tensor = np.array([[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]])

            def frame(q: np.ndarray, name: Any = name, R_BI: Any = R_BI, center: Any = center) -> Any:
                R, p = self.pose(name, q)
                return R @ R_BI, p + R @ center

            found.append((float(inertial.find("mass").get("value")), tensor, frame))
        return found

    def jacobians(self, frame: Any, q: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """J_v in the root's axes, J_w in the frame's own."""
        R0 = np.real(frame(q.astype(complex))[0])
        columns = []
        for k in range(len(q)):
            step = q.astype(complex)
            step[k] += 1j * STEP
            R, p = frame(step)
            spin = R0.T @ np.imag(R) / STEP
            columns.append([*(np.imag(p) / STEP), spin[2, 1], spin[0, 2], spin[1, 0]])
        found = np.array(columns).T
        return found[:3], found[3:]

    def dynamics(self, q: np.ndarray, v: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """(M, c + g)."""
        n = len(q)
        M, h = np.zeros((n, n)), np.zeros(n)
        weights = ((1, 4 / 5), (2, -1 / 5), (3, 4 / 105), (4, -1 / 280))
        for m, tensor, frame in self.bodies():
            Jv, Jw = self.jacobians(frame, q)
            rates = np.zeros((6, n))
            for k, weight in weights:
                ahead, behind = (np.vstack(self.jacobians(frame, q + side * k * WIDE * v)) for side in (1, -1))
                rates += weight * (ahead - behind) / WIDE
            w = Jw @ v
            M += m * Jv.T @ Jv + Jw.T @ tensor @ Jw
            h += m * Jv.T @ (rates[:3] @ v - GRAVITY) + Jw.T @ (tensor @ rates[3:] @ v + np.cross(w, tensor @ w))
        return M, h


def random_robot(seed: int, links: int = 7) -> str:
    """A tree of links on hinges and slides of any axes, some welded, inertias in frames of their own."""
    rng = np.random.default_rng(seed)

    def three(low: float = -1, high: float = 1) -> str:
        return " ".join(f"{x:.4f}" for x in rng.uniform(low, high, 3))

    parts = ['<robot name="random one">', '<link name="base"/>']
    for k in range(links):
        a, b, c = rng.uniform(0.1, 1, 3)
        parts.append(
            f'<link name="link {k}"><inertial><origin xyz="{three()}" rpy="{three(-3, 3)}"/>'
            f'<mass value="{rng.uniform(0.1, 3):.3f}"/><inertia ixx="{b + c:.4f}" iyy="{a + c:.4f}" izz="{a + b:.4f}" '
            f'ixy="{0.05 * a:.4f}" ixz="-0.01" iyz="0.02"/></inertial></link>'
        )
        kind = str(rng.choice(["revolute", "continuous", "prismatic", "fixed"], p=[0.4, 0.2, 0.25, 0.15]))
        parent = "base" if k == 0 else f"link {rng.integers(0, k)}"
        axis = f'<axis xyz="{three()}"/>' if rng.random() < 0.8 else ""
        turn = three(-3, 3) if rng.random() < 0.6 else "1.5707963267948966 0 -1.5707963267948966"
        parts.append(
            f'<joint name="joint-{k}" type="{kind}"><parent link="{parent}"/><child link="link {k}"/>'
            f'<origin xyz="{three()}" rpy="{turn}"/>{axis}<limit lower="-1" upper="2" effort="9" velocity="3"/></joint>'
        )
    return "\n".join([*parts, "</robot>"])
