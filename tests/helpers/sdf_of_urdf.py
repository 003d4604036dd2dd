"""A URDF as SDF: every pose in the model's axes, by the floats of `urdf_by_hand`; nothing of eomgen."""

from __future__ import annotations

from xml.etree import ElementTree

import numpy as np

from tests.helpers.urdf_by_hand import ByHand, numbers, origin, turned


def angles(R: np.ndarray) -> list[float]:
    """Roll, pitch, yaw of R = Rz Ry Rx."""
    return [np.arctan2(R[2, 1], R[2, 2]), -np.arcsin(np.clip(R[2, 0], -1, 1)), np.arctan2(R[1, 0], R[0, 0])]


def words(*values: object) -> str:
    return " ".join(repr(float(x)) for x in np.hstack(values))  # type: ignore[call-overload]


def sdf_of_urdf(text: str, *, in_model: bool) -> str:
    """The same robot, welded to the world.

    Args:
        in_model: axes in the model's frame; else in the joint's, which is turned and lies off the child's origin.
    """
    by_hand, robot = ByHand(text), ElementTree.fromstring(text)
    rest = np.zeros(len(by_hand.moving))
    parts = ['<sdf version="1.9"><model name="same">', '<joint name="weld" type="fixed"><parent>world</parent>']
    parts.append("<child>base</child></joint>")
    for name, link in by_hand.links.items():
        R, p = by_hand.pose(name, rest)
        parts.append(f'<link name="{name}"><pose>{words(p, angles(R))}</pose>')
        inertial = link.find("inertial")
        if inertial is not None:
            R_BI, center = origin(inertial)
            tensor = inertial.find("inertia").attrib
            entries = "".join(f"<{key}>{value}</{key}>" for key, value in tensor.items())
            mass = inertial.find("mass").get("value")
            pose = f"<pose>{words(center, angles(R_BI))}</pose>"
            parts.append(f"<inertial>{pose}<mass>{mass}</mass><inertia>{entries}</inertia></inertial>")
        parts.append("</link>")
    for joint in robot.findall("joint"):
        child = joint.find("child").get("link")  # type: ignore[union-attr]
        R, _ = by_hand.pose(child, rest)
        axis = joint.find("axis")
        n = np.array([1.0, 0, 0]) if axis is None else numbers(axis.get("xyz"))  # type: ignore[arg-type]
        tilt = turned([1, 2, 3], 0.7)  # of the joint's own axes in the child's
        away = (
            0.3 * n if joint.get("type") != "prismatic" else np.array([0.1, 0.2, 0.3])
        )  # along the axis: the same joint
        xyz = f'<xyz expressed_in="__model__">{words(R @ n)}</xyz>' if in_model else f"<xyz>{words(tilt.T @ n)}</xyz>"
        parts.append(
            f'<joint name="{joint.get("name")}" type="{joint.get("type")}"><pose>{words(away, angles(tilt))}</pose>'
            f"<parent>{joint.find('parent').get('link')}</parent><child>{child}</child><axis>{xyz}</axis></joint>"  # type: ignore[union-attr]
        )
    return "\n".join([*parts, "</model></sdf>"])
