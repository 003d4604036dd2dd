"""A URDF file's text, the model made of it -> whether bodies stand, weigh and follow as the file says, in doubles.

    T = (R_z(yaw) R_y(pitch) R_x(roll), xyz) (turn by s about, or slide along, the axis),    q = multiplier q' + offset

The file is read once more, by another program, and each joint is taken by itself: the child's pose in its parent's.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping
from typing import TYPE_CHECKING

import numpy as np

from eomgen.mechanics.bodies.inertia import mass_properties
from eomgen.mechanics.bodies.kinematics import motion_of
from eomgen.mechanics.bodies.scope import scope_of
from eomgen.model.parts import Model
from eomgen.model.values import exact_parameters
from eomgen.proof.check import first_wrong
from eomgen.symbolic.expression.graph import Node, Scalar
from eomgen.symbolic.numeric.evaluation import FLOAT, evaluate
from eomgen.symbolic.numeric.tolerances import COMPUTED

if TYPE_CHECKING:
    from xml.etree.ElementTree import Element

TURNING, SLIDING = ("revolute", "continuous"), ("prismatic",)
FIRST, STEP = 0.3, 0.17  # values of the coordinates, one after the other


def imported_otherwise(text: str | bytes, model: Model) -> str:
    """Which body is not as the file has it; "" where all are that are called alike in both."""
    from xml.etree import ElementTree

    try:
        root = ElementTree.fromstring(text.strip())
    except ElementTree.ParseError:  # what our reader forgives
        return ""
    joints = [joint for joint in root.iter("joint") if joint.find("child") is not None]
    proof = _Imported(model, joints)
    weights = (proof.weighs(link) for link in root.iter("link"))
    return first_wrong((*map(proof.stands, joints), *weights, *proof.follows()))


class _Imported:
    """The model at values of its coordinates that are nothing special, those that follow others set by these."""

    def __init__(self, model: Model, joints: list[Element]) -> None:
        self.model, self.motion = model, motion_of(scope_of(model))
        self.hung = {_named(joint, "child") for joint in joints}
        own = {str(joint.get("name")): q for joint in joints if (q := self.coordinate(joint)) is not None}
        values = {q: FIRST + STEP * k for k, q in enumerate(model.coordinates)}
        for joint in joints:
            mimic, q = joint.find("mimic"), own.get(str(joint.get("name")))
            leader = None if mimic is None else own.get(str(mimic.get("joint")))
            if mimic is not None and q is not None and leader is not None:
                values[q] = float(mimic.get("multiplier", 1)) * values[leader] + float(mimic.get("offset", 0))
        known, symbols = exact_parameters(model), self.motion.scope.symbols
        self.known: Mapping[Node, float] = {
            **{node: float(known[name]) for name, node in symbols.parameters.items() if name in known},
            **{node: values[node.name] for node in symbols.q},
            symbols.t: 0.0,
        }
        self.values = values

    def at(self, scalars: tuple[Scalar, ...]) -> np.ndarray:
        return np.array([float(x) for x in evaluate(scalars, self.known, FLOAT)])

    def coordinate(self, joint: Element) -> str | None:
        """By which the child of a hinge or slide moves; None of others, and of one that is called otherwise."""
        part = self.model.bodies.get(_named(joint, "child"))
        if joint.get("type") not in (*TURNING, *SLIDING) or part is None or part.joint is None:
            return None
        (variable,) = part.joint.variables(self.model.space)[:1] or (None,)
        return variable.text if variable is not None and variable.text in self.model.coordinates else None

    def stands(self, joint: Element) -> str:
        """Child against parent."""
        child, parent, kind = _named(joint, "child"), _named(joint, "parent"), joint.get("type")
        if child not in self.model.bodies or kind not in (*TURNING, *SLIDING, "fixed"):
            return ""
        own = self.model.bodies[child].joint
        above = None if own is None else own.parent
        if above != parent and (above is not None or parent in self.model.bodies or parent in self.hung):
            return ""  # hung elsewhere, as on what its parent is fixed to
        R, p = _origin(joint)
        q = self.coordinate(joint)
        if kind != "fixed":
            if q is None:
                return ""
            axis = joint.find("axis")
            n = np.array([1.0, 0, 0]) if axis is None else _numbers(axis.get("xyz", "1 0 0"))
            n = n / np.linalg.norm(n)
            R, p = (R @ _turn(n, self.values[q]), p) if kind in TURNING else (R, p + R @ n * self.values[q])
        R_here, p_here = self._pose(child)
        R_above, p_above = (np.eye(3), np.zeros(3)) if above is None else self._pose(above)
        away = max(abs(R_above.T @ R_here - R).max(), abs(R_above.T @ (p_here - p_above) - p).max())
        return (
            f"'{child}' does not stand on '{parent}' as its joint says" if away > COMPUTED * (1 + abs(p).max()) else ""
        )

    def _pose(self, body: str) -> tuple[np.ndarray, np.ndarray]:
        pose = self.motion.link(body).pose
        return self.at(tuple(x for row in pose.R for x in row)).reshape(3, 3), self.at(tuple(pose.p))

    def weighs(self, link: Element) -> str:
        """Mass, mass centre, inertia."""
        name, inertial = str(link.get("name")), link.find("inertial")
        if inertial is None or name not in self.model.bodies or self._carries(name):
            return ""
        (R, p), mass, tensor = _origin(inertial), inertial.find("mass"), inertial.find("inertia")
        m = 0.0 if mass is None else float(mass.get("value", 0))
        keys = (("ixx", "ixy", "ixz"), ("ixy", "iyy", "iyz"), ("ixz", "iyz", "izz"))
        I = np.array([[0.0 if tensor is None else float(tensor.get(key, 0)) for key in row] for row in keys])
        own = mass_properties(self.motion.scope, name)
        due = np.array([m, *(m * p), *(R @ I @ R.T).ravel()])
        found = self.at((own.m, *own.com, *(x for row in own.I for x in row)))
        found[1:4] *= found[0]
        return f"'{name}' weighs otherwise" if abs(found - due).max() > COMPUTED * (1 + abs(due).max()) else ""

    def _carries(self, name: str) -> bool:
        """Whether other links may have gone into it."""
        return self.model.bodies[name].parts is not None

    def follows(self) -> Iterator[str]:
        """Equations between coordinates hold where those that mimic others are set by these."""
        for name, tie in self.model.constraints.items():
            gap = getattr(tie, "gap", None)
            if gap is not None and not gap.calls and name.startswith("mimic"):
                left = float(self.at((self.motion.scope.value(gap),))[0])
                yield f"'{name}' leaves {left:.3g}" if abs(left) > COMPUTED * 10 else ""


def _named(joint: Element, end: str) -> str:
    found = joint.find(end)
    return "" if found is None else str(found.get("link"))


def _numbers(text: str) -> np.ndarray:
    return np.array([float(x) for x in text.split()])


def _origin(element: Element) -> tuple[np.ndarray, np.ndarray]:
    origin = element.find("origin")
    if origin is None:
        return np.eye(3), np.zeros(3)
    roll, pitch, yaw = _numbers(origin.get("rpy", "0 0 0"))
    X, Y, Z = np.eye(3)
    return _turn(Z, yaw) @ _turn(Y, pitch) @ _turn(X, roll), _numbers(origin.get("xyz", "0 0 0"))


def _turn(n: np.ndarray, angle: float) -> np.ndarray:
    """1 + sin K + (1 - cos) K^2, K v = n x v."""
    K = np.array([[0, -n[2], n[1]], [n[2], 0, -n[0]], [-n[1], n[0], 0]])
    found: np.ndarray = np.eye(3) + math.sin(angle) * K + (1 - math.cos(angle)) * K @ K
    return found
