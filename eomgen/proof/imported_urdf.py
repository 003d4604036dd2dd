"""A URDF file's text, the model made of it -> whether bodies stand, weigh, follow, yield as the file says, in doubles.

    T = (R_z(yaw) R_y(pitch) R_x(roll), xyz) (turn by s about, or slide along, the axis),    q = multiplier q' + offset

The file is read once more, by another program, and each joint is taken by itself: the child's pose in its parent's.
"""

from __future__ import annotations

import re
from collections.abc import Collection, Iterator, Mapping
from typing import TYPE_CHECKING, Any

import numpy as np

from eomgen.model.forces.element import PushOfMass
from eomgen.model.parts import Model
from eomgen.proof.check import first_wrong
from eomgen.proof.posed_model import FloatPose, PosedModel, figures_in, poses_differ, turn_about, turn_by_three
from eomgen.symbolic.numeric.tolerances import COMPUTED

if TYPE_CHECKING:
    from xml.etree.ElementTree import Element

UNLIMITED = 1e9  # what is written where a format wants a limit and there is none
LIMITS = {  # as the remark of a coordinate tells them
    "lower": re.compile(r"from (\S+) to "),
    "upper": re.compile(r"from \S+ to (\S+) "),
    "effort": re.compile(r"at most (\S+) N(?:\*m)?(?=,|$)"),
    "velocity": re.compile(r"at most (\S+) (?:rad|m)/s"),
}
G = (0.0, 0.0, -9.81)  # of what reads URDF [m/s^2]
EXACT = ("forces", "stiffness", "armature", "given motions")  # of which nothing else is told to be left out
TURNING, SLIDING = ("revolute", "continuous"), ("prismatic",)


def imported_otherwise(text: str | bytes, model: Model) -> str:
    """Which body is not as the file has it; "" where all are that are called alike in both."""
    from xml.etree import ElementTree

    try:
        root = ElementTree.fromstring(text.strip())
    except ElementTree.ParseError:  # what our reader forgives
        return ""
    joints = [joint for joint in root.iter("joint") if joint.find("child") is not None]
    proof = _Imported(model, joints)
    moving = (y for joint in joints for y in (proof.stands(joint), proof.yields(joint), proof.bounded(joint)))
    weights = (proof.weighs(link) for link in root.iter("link"))
    return first_wrong((*moving, *weights, *proof.posed.follows()))


def unsaid_otherwise(text: str, model: Model, left_out: Mapping[str, Collection[str]]) -> str:
    """What of a model its URDF neither says nor is told to leave out, by what is declared; "" where all is told.

    Args:
        left_out: {what URDF cannot say: where it is}.
    """
    from xml.etree import ElementTree

    root, posed = ElementTree.fromstring(text), PosedModel(model)
    acts = {name: force.acts for name, force in model.forces.items()}
    uniform = {name: [y for y in x if isinstance(y, PushOfMass) and not y.bodies] for name, x in acts.items()}
    fields = [name for name, x in acts.items() if x and len(uniform[name]) == len(x)]
    g = [[posed.number(c) for c in (*y.acceleration, None)[:3]] for name in fields for y in uniform[name]]
    usual = np.allclose(np.sum(g, axis=0) if g else np.zeros(3), G, 0, COMPUTED)
    pushes = {name: part.joint.pushes() for name, part in model.bodies.items() if part.joint is not None}
    q = model.coordinates
    due: dict[str, list[str]] = {
        "forces": [name for name in acts if name not in fields or not usual],
        "stiffness": [name for name, each in pushes.items() if any(x.stiffness is not None for x in each)],
        "armature": [name for name, each in pushes.items() if any(x.armature is not None for x in each)],
        "values of inputs": [name for name, part in model.inputs.items() if _given(posed, part.value)],
        "start values": [x for x, part in q.items() if _given(posed, part.start) or _given(posed, part.speed)],
        "given motions": [x for x, part in q.items() if part.driven],
    }
    drives = [name for name, each in pushes.items() if any(x.push is not None for x in each)]
    said = {
        "constraints": ([*model.constraints], sum(1 for _ in root.iter("mimic"))),
        "drives that are no input alone": (drives, sum(1 for _ in root.iter("transmission"))),
    }
    for what, names in due.items():
        if missing := [name for name in names if name not in left_out.get(what, ())]:
            return f"{what} of '{missing[0]}' are not said, and not told to be left out"
        if what in EXACT and (more := [name for name in left_out.get(what, ()) if name not in names]):
            return f"{what} of '{more[0]}' are told to be left out, and are said, or are not there"
    for what, (names, there) in said.items():
        if len(names) - there != len({*left_out.get(what, ())} & {*names}):
            return f"{what}: {len(names)}, of which {there} are said and {len(left_out.get(what, ()))} are left out"
    return ""


def without_units(model: Model) -> str:
    """Which parameter of the weight, or coordinate along which a joint pushes, an import left without a unit; ""."""
    acts = (act for force in model.forces.values() for act in force.acts)
    weights = (x for act in acts if isinstance(act, PushOfMass) for x in act.acceleration)
    joints = (part.joint for part in model.bodies.values() if part.joint is not None)
    ways = (each.way for joint in joints for each in joint.pushes() if each.way is not None)
    used = {name for x in (*weights, *ways) for name in x.names}
    parts: dict[str, Any] = {**model.parameters, **model.coordinates}
    bare = [name for name in parts if name in used and (parts[name] is None or parts[name].unit is None)]
    return f"'{bare[0]}' has no unit" if bare else ""


def _given(posed: PosedModel, value: Any) -> bool:
    """Whether a value is told, and is another than 0."""
    return value is not None and (bool(value.names) or posed.number(value) != 0)


class _Imported:
    """The model at values of its coordinates, those that follow others set by these."""

    def __init__(self, model: Model, joints: list[Element]) -> None:
        self.model, self.posed = model, PosedModel(model)
        self.hung = {_named(joint, "child") for joint in joints}
        own = {str(joint.get("name")): q for joint in joints if (q := self.coordinate(joint)) is not None}
        for joint, leader in _mimics(joints):
            q, other, mimic = own.get(str(joint.get("name"))), own.get(leader), joint.find("mimic")
            if q is not None and other is not None and mimic is not None:
                factor, offset = float(mimic.get("multiplier", 1)), float(mimic.get("offset", 0))
                self.posed.values[q] = factor * self.posed.values[other] + offset

    def body(self, link: str) -> str | None:
        return self.posed.bodies.get(link)

    def coordinate(self, joint: Element) -> str | None:
        """By which the child of a hinge or slide moves; None of others."""
        part = self.model.bodies.get(self.body(_named(joint, "child")) or "")
        if joint.get("type") not in (*TURNING, *SLIDING) or part is None or part.joint is None:
            return None
        (variable,) = part.joint.variables(self.model.space)[:1] or (None,)
        return variable.text if variable is not None and variable.text in self.model.coordinates else None

    def stands(self, joint: Element) -> str:
        """Child against parent."""
        child, kind = self.body(_named(joint, "child")), joint.get("type")
        parent = self.body(_named(joint, "parent"))
        own = None if child is None else self.model.bodies[child].joint
        if kind == "floating" and own is not None and own.kind != "free":
            return f"'{child}' is held"
        if child is None or kind not in (*TURNING, *SLIDING, "fixed"):
            return ""
        above = None if own is None else own.parent
        if above != parent and parent is not None:
            return f"'{child}' hangs on '{above}', not on '{parent}'"
        if above != parent and (above is not None or _named(joint, "parent") in self.hung):
            return ""  # hung elsewhere, as on what its parent is fixed to
        R, p = _origin(joint)
        q = self.coordinate(joint)
        if kind != "fixed":
            if q is None:
                return ""
            axis, s = joint.find("axis"), self.posed.values[q]
            n = np.array([1.0, 0, 0]) if axis is None else figures_in(axis.get("xyz", "1 0 0"))
            n = n / np.linalg.norm(n)
            R, p = (R @ turn_about(n, s), p) if kind in TURNING else (R, p + R @ n * s)
        return f"'{child}' does not stand on '{parent}' as its joint says" if self._away(above, child, (R, p)) else ""

    def _away(self, above: str | None, child: str, due: FloatPose) -> bool:
        return poses_differ(self.posed.between(above, child), due)

    def yields(self, joint: Element) -> str:
        """The damping of a hinge or slide."""
        child, dynamics = self.body(_named(joint, "child")), joint.find("dynamics")
        if child is None or self.coordinate(joint) is None:
            return ""
        due = 0.0 if dynamics is None else float(dynamics.get("damping", 0))
        found = self.posed.number(getattr(self.model.bodies[child].joint, "damping", None))
        return "" if abs(found - due) <= COMPUTED * (1 + abs(due)) else f"the joint of '{child}' is damped otherwise"

    def bounded(self, joint: Element) -> str:
        """The limits of a hinge or slide, as the remark of its coordinate tells them."""
        q, limit = self.coordinate(joint), joint.find("limit")
        if q is None:
            return ""
        about = self.model.coordinates[q].about or ""
        told = {key: x.findall(about) for key, x in LIMITS.items()}
        due: dict[str, float] = {}
        if limit is not None:
            ends = [] if joint.get("type") == "continuous" else [key for key in ("lower", "upper") if limit.get(key)]
            due = {key: float(limit.get(key, 0)) for key in ("lower", "upper")} if ends else {}
            due = {} if due.get("upper", 0) >= UNLIMITED else due
            due |= {key: float(x) for key in ("effort", "velocity") if (x := limit.get(key)) is not None}
        else_none = {"lower": -UNLIMITED, "upper": UNLIMITED, "effort": UNLIMITED, "velocity": UNLIMITED}
        for key, none in else_none.items():
            found, wanted = float(told[key][0]) if told[key] else none, due.get(key, none)
            if abs(found - wanted) > COMPUTED * abs(wanted) and not (key not in due and not told[key]):
                return f"the limits of '{q}' are told otherwise"
        return ""

    def weighs(self, link: Element) -> str:
        """Mass, mass centre, inertia."""
        name, inertial = self.body(str(link.get("name"))), link.find("inertial")
        if (
            inertial is None or name is None or self.model.bodies[name].parts is not None
        ):  # others may have gone into it
            return ""
        (R, p), mass, tensor = _origin(inertial), inertial.find("mass"), inertial.find("inertia")
        m = 0.0 if mass is None else float(mass.get("value", 0))
        keys = (("ixx", "ixy", "ixz"), ("ixy", "iyy", "iyz"), ("ixz", "iyz", "izz"))
        I = np.array([[0.0 if tensor is None else float(tensor.get(key, 0)) for key in row] for row in keys])
        due = np.array([m, *(m * p), *(R @ I @ R.T).ravel()])
        off = abs(self.posed.weight(name) - due).max()
        return f"'{name}' weighs otherwise" if off > COMPUTED * (1 + abs(due).max()) else ""


def _mimics(joints: list[Element]) -> Iterator[tuple[Element, str]]:
    """Joints that follow others, after these, with the names of these."""
    waiting = {str(x.get("name")): (x, str(m.get("joint"))) for x in joints if (m := x.find("mimic")) is not None}
    while ready := [name for name, (_, leader) in waiting.items() if leader not in waiting]:
        yield from (waiting.pop(name) for name in ready)


def _named(joint: Element, end: str) -> str:
    found = joint.find(end)
    return "" if found is None else str(found.get("link"))


def _origin(element: Element) -> FloatPose:
    origin = element.find("origin")
    if origin is None:
        return np.eye(3), np.zeros(3)
    return turn_by_three(figures_in(origin.get("rpy", "0 0 0"))), figures_in(origin.get("xyz", "0 0 0"))
