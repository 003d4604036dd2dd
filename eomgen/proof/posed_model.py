"""A model at values of its coordinates that are nothing special -> poses and weights of its bodies, in doubles.

    T = (R, p) of a body in the axes of the ground

What proofs of imported robots share, which know a robot by another reading: names as they are in the robot's file.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping
from typing import Any

import numpy as np

from eomgen.mechanics.bodies.inertia import mass_properties
from eomgen.mechanics.bodies.kinematics import motion_of
from eomgen.mechanics.bodies.scope import scope_of
from eomgen.model.joints.base import Joint
from eomgen.model.parts import Model
from eomgen.model.values import exact_parameters
from eomgen.symbolic.expression.graph import Node, Scalar
from eomgen.symbolic.expression.symbols import Symbols
from eomgen.symbolic.numeric.evaluation import FLOAT, evaluate
from eomgen.symbolic.numeric.tolerances import COMPUTED

FIRST, STEP = 0.3, 0.17  # values of the coordinates, one after the other
REMARKED = ("link", "joint", "body")  # "link upper arm, from ...": what something was called
FloatPose = tuple[np.ndarray, np.ndarray]


class PosedModel:
    """A model and values of its coordinates, quaternions of norm 1; some may be set otherwise."""

    def __init__(self, model: Model, values: Mapping[str, float] | None = None) -> None:
        self.model, self.motion = model, motion_of(scope_of(model))
        self.values = {q: FIRST + STEP * k for k, q in enumerate(model.coordinates)} | dict(values or {})
        for turn in map(quaternion_names, every_joint(model)):
            size = math.hypot(*(self.values[e] for e in turn))
            self.values |= {e: self.values[e] / size for e in turn}
        self.bodies = _by_remark(model.bodies)
        self.coordinates = _by_remark(model.coordinates)

    @property
    def known(self) -> Mapping[Node, float]:
        return self.values_of(self.motion.scope.symbols)

    def values_of(self, symbols: Symbols) -> dict[Node, float]:
        """Parameters, coordinates and the time as symbols of a graph, with their numbers."""
        known = exact_parameters(self.model)
        return {
            **{node: float(known[name]) for name, node in symbols.parameters.items() if name in known},
            **{node: self.values[node.name] for node in symbols.q},
            symbols.t: 0.0,
        }

    def at(self, scalars: tuple[Scalar, ...]) -> np.ndarray:
        return np.array([float(x) for x in evaluate(scalars, self.known, FLOAT)])

    def number(self, expression: Any) -> float:
        """What a field of the model is worth; 0 of none."""
        return 0.0 if expression is None else float(self.at((self.motion.scope.value(expression),))[0])

    def pose(self, body: str | None) -> FloatPose:
        """Of a body in the ground; of the ground itself."""
        if body is None:
            return np.eye(3), np.zeros(3)
        pose = self.motion.link(body).pose
        return self.at(tuple(x for row in pose.R for x in row)).reshape(3, 3), self.at(tuple(pose.p))

    def between(self, above: str | None, body: str) -> FloatPose:
        """Of a body in the axes of another."""
        (R, p), (R0, p0) = self.pose(body), self.pose(above)
        return R0.T @ R, R0.T @ (p - p0)

    def weight(self, body: str) -> np.ndarray:
        """m, m c, the inertia about the mass centre in body axes: 13 numbers."""
        own = mass_properties(self.motion.scope, body)
        found = self.at((own.m, *own.com, *(x for row in own.I for x in row)))
        found[1:4] *= found[0]
        return found

    def follows(self) -> Iterator[str]:
        """What equations between coordinates leave that are there because one mimics another."""
        for name, tie in self.model.constraints.items():
            gap = getattr(tie, "gap", None)
            if gap is not None and not gap.calls and name.startswith("mimic"):
                left = self.number(gap)
                yield f"'{name}' leaves {left:.3g}" if abs(left) > COMPUTED * 10 else ""


def quaternion_names(joint: Joint) -> tuple[str, ...]:
    """The names of its quaternion, scalar first; () of other joints."""
    return tuple(getattr(joint, "quaternion", None) or ())


def every_joint(model: Model) -> Iterator[Joint]:
    return (body.joint for body in model.bodies.values() if body.joint is not None)


def posed_further(pose: FloatPose, *further: FloatPose) -> FloatPose:
    """T T' ..., each in the axes of the one before."""
    R, p = pose
    for R1, p1 in further:
        R, p = R @ R1, p + R @ p1
    return R, p


def pose_back(pose: FloatPose) -> FloatPose:
    """T^-1."""
    R, p = pose
    return R.T, -R.T @ p


def poses_differ(found: FloatPose, due: FloatPose) -> bool:
    """Whether two poses differ."""
    away = max(abs(found[0] - due[0]).max(), abs(found[1] - due[1]).max())
    return bool(away > COMPUTED * (1 + abs(due[1]).max()))


def figures_in(text: str) -> np.ndarray:
    return np.array([float(x) for x in text.split()])


def turn_by_three(angles: np.ndarray) -> np.ndarray:
    X, Y, Z = np.eye(3)
    roll, pitch, yaw = angles
    found: np.ndarray = turn_about(Z, yaw) @ turn_about(Y, pitch) @ turn_about(X, roll)
    return found


def turn_about(n: np.ndarray, angle: float) -> np.ndarray:
    """1 + sin K + (1 - cos) K^2, K v = n x v."""
    K = np.array([[0, -n[2], n[1]], [n[2], 0, -n[0]], [-n[1], n[0], 0]])
    found: np.ndarray = np.eye(3) + math.sin(angle) * K + (1 - math.cos(angle)) * K @ K
    return found


def _by_remark(parts: Mapping[str, Any]) -> dict[str, str]:
    """What something was called in another program's file -> its name here."""
    found: dict[str, str] = {}
    for name, part in parts.items():
        kind, _, rest = (part.about or "").partition(" ")
        other = rest.partition(", from ")[0].partition(", at most ")[0]
        found.setdefault(other if kind in REMARKED and other else name, name)
    return found
