"""Robot file, model -> check that bodies stand, weigh and move as the file says."""

from __future__ import annotations

import math
import re
from collections.abc import Callable, Collection, Iterator, Mapping
from typing import TYPE_CHECKING, Any

import numpy as np

from eomgen.mechanics.dynamics import EquationsOfMotion
from eomgen.model import Model
from eomgen.proof.check import first_wrong
from eomgen.proof.imported_mjcf import mjcf_otherwise
from eomgen.proof.posed_model import (
    FloatPose,
    PosedModel,
    figures_in,
    pose_back,
    posed_further,
    poses_differ,
    turn_about,
    turn_by_three,
)
from eomgen.robots import ImportedRobot
from eomgen.symbolic.numeric import tolerances

if TYPE_CHECKING:
    from xml.etree.ElementTree import Element


# -------- imported sdf ----------------------------------------------------------------------------------------
# An SDF file's text, the model made of it -> whether bodies stand, weigh, move and yield as the file says, in
# doubles.
#
#     T_child = T_parent (T_parent^-1 T_child at 0) T_joint (turn by s about, slide by s along, or both) T_joint^-1
#
# T_joint of the joint in its child; where all coordinates are 0 each link stands where the file has it. The file is
# read once more, by another program: one model that holds no other; of others nothing is said.


AXES = {"revolute": 1, "continuous": 1, "prismatic": 1, "screw": 1, "universal": 2, "revolute2": 2}
FELT = (("damping", "damping"), ("spring_stiffness", "stiffness"))
SHAPES = ("box", "cylinder", "sphere")
WATER, YES = 1000.0, ("true", "1")  # kg/m^3, the density of SDF where none is given
FIXED: FloatPose = (np.eye(3), np.zeros(3))


MOST_COMPARED = 20  # coordinates of a robot whose forces are derived to be compared


def robot_otherwise(file: str, robot: ImportedRobot, equations: Callable[[], EquationsOfMotion]) -> str:
    """First difference between a robot's file, read in another way, and the model; "" if there is none.

    Args:
        equations: derives those of the model, where few bodies move.
    """
    model, root = robot.model, robot.root
    if bare := without_units(model):
        return bare
    if root == "mujoco":
        small = 0 < len(model.coordinates) <= MOST_COMPARED
        left = [(each.what, each.where) for each in robot.left_out if each.nearest is not None]
        return mjcf_otherwise(file, robot.source, model, equations() if small else None, left)
    if root == "robot":
        return imported_otherwise(robot.source, model)
    return sdf_otherwise(robot.source, model) if root == "sdf" else ""


def sdf_otherwise(text: str | bytes, model: Model) -> str:
    """Message that names a body which differs from the SDF file; "" too for what is not read.

    Bodies are compared that have the same name in both.
    """
    from xml.etree import ElementTree

    try:
        root = ElementTree.fromstring(text.strip())
    except ElementTree.ParseError:  # our reader accepts more
        return ""
    chosen = next((x for x in root.iter("model") if x.get("name") == model.name), None)
    if chosen is None or _nested(chosen) or _old(root):
        return ""
    proof = _Imported(model, chosen)
    joints = chosen.findall("joint")
    links = (y for link in chosen.findall("link") for y in (proof.stands(link), proof.weighs(link)))
    moving = (y for joint in joints for y in (proof.moves(joint), *proof.yields(joint)))
    return first_wrong((*links, *moving, *proof.follows()))


def _nested(model: Element) -> bool:
    return any(model.find(tag) is not None for tag in ("model", "include")) or model.get("placement_frame") is not None


def _old(root: Element) -> bool:
    """True if axes may stand in other frames than those of today's SDF."""
    version = [int(x) for x in root.get("version", "1.7").split(".")[:2]]
    return version < [1, 7] or next(root.iter("use_parent_model_frame"), None) is not None


class _Imported:
    """The file's frames and the model, at values of coordinates and where all of them are 0."""

    def __init__(self, model: Model, chosen: Element) -> None:
        self.model, self.chosen = model, chosen
        self.named = {str(x.get("name")): x for tag in ("frame", "joint", "link") for x in chosen.findall(tag)}
        self.posed, self.rest = PosedModel(model), PosedModel(model, self._rest())

    def _rest(self) -> dict[str, float]:
        """Every coordinate 0; a free body stands where it starts."""
        first, bodies = PosedModel(self.model), self.model.bodies
        free = [name for name, part in bodies.items() if part.joint is not None and part.joint.kind == "free"]
        names = [x for name in free for x in (*first.variables(name, "position"), *first.quaternion(name))]
        starts = {q: first.number(self.model.coordinates[q].start) for q in names}
        balls = {e: float(k == 0) for name in bodies for k, e in enumerate(first.quaternion(name))}
        return {q: 0.0 for q in self.model.coordinates} | balls | starts

    def body(self, link: str) -> str | None:
        return self.posed.bodies.get(link)

    def frame(self, name: str, below: tuple[str, ...] = ()) -> FloatPose:
        """Pose of a link, joint or frame in the model."""
        if name in ("", "__model__"):
            return FIXED
        if name == "world":
            return pose_back(_pose(self.chosen.find("pose")))
        element = self.named[name]
        assert name not in below
        base = {"joint": _text(element, "child"), "frame": element.get("attached_to", "")}.get(element.tag, "")
        pose = element.find("pose")
        base = base if pose is None else pose.get("relative_to", base)
        return posed_further(self.frame(base, (*below, name)), _pose(pose))

    def stands(self, link: Element) -> str:
        """Message if a link, with all coordinates 0, stands elsewhere in the world; ""."""
        name = self.body(str(link.get("name")))
        if name is None:
            return ""
        due = posed_further(_pose(self.chosen.find("pose")), self.frame(str(link.get("name"))))
        return f"'{name}' does not stand where its link does" if poses_differ(self.rest.pose(name), due) else ""

    def moves(self, joint: Element) -> str:
        """The child against the parent, away from 0."""
        child, kind = self.body(self._link(_text(joint, "child"))), str(joint.get("type"))
        if child is None or kind not in AXES:
            return ""
        parent = self._link(_text(joint, "parent"))
        above = self.body(parent)
        at = self.frame(str(joint.get("name")))
        steps = [self._step(joint, tag, at, kind) for tag in ("axis", "axis2")[: AXES[kind]]]
        if None in [q for q, _ in steps]:
            return ""
        R, p = posed_further(pose_back(self.frame(parent)), at, *(step for _, step in steps), pose_back(at))
        due = posed_further((R, p), self.frame(self._link(_text(joint, "child"))))
        found = self.posed.between(above, child)
        return f"'{child}' does not move as its joint '{joint.get('name')}' says" if poses_differ(found, due) else ""

    def _step(self, joint: Element, tag: str, at: FloatPose, kind: str) -> tuple[str | None, FloatPose]:
        axis, q = joint.find(tag), self._coordinate(joint, tag)
        xyz = None if axis is None else axis.find("xyz")
        n = np.array([0.0, 0, 1]) if xyz is None else figures_in(str(xyz.text))
        other = None if xyz is None else xyz.get("expressed_in")
        if other:
            n = at[0].T @ self.frame(other)[0] @ n
        n, s = n / np.linalg.norm(n), self.posed.values.get(q or "", 0.0)
        if kind == "prismatic":
            return q, (np.eye(3), n * s)
        pitch = _float(joint, "screw_thread_pitch", 0.0) if kind == "screw" else 0.0
        return q, (turn_about(n, s), n * s * pitch / (2 * math.pi))

    def _coordinate(self, joint: Element, tag: str) -> str | None:
        q = self.posed.coordinates.get(str(joint.get("name")))
        return q if tag == "axis" or q is None else next((x for x in (f"{q}_2",) if x in self.model.coordinates), None)

    def _link(self, name: str) -> str:
        """The link with which a frame moves."""
        element = self.named.get(name)
        if element is None or element.tag == "link":
            return name
        above = _text(element, "child") if element.tag == "joint" else element.get("attached_to")
        return self._link(above or next(str(x.get("name")) for x in self.chosen.findall("link")))

    def yields(self, joint: Element) -> Iterator[str]:
        """Dampers and springs of hinges and slides."""
        bodies = self.model.bodies
        own = {q: bodies[x].joint for x in bodies for q in self.posed.variables(x, "angle", "displacement")}
        for tag in ("axis", "axis2")[: AXES.get(str(joint.get("type")), 0)]:
            q, dynamics = self._coordinate(joint, tag), joint.find(f"{tag}/dynamics")
            if q is None or q not in own or dynamics is None:
                continue
            for theirs, ours in FELT:
                due, found = _float(dynamics, theirs, 0.0), self.posed.number(getattr(own[q], ours, None))
                yield (
                    ""
                    if abs(found - due) <= tolerances.COMPUTED * (1 + abs(due))
                    else f"{ours} of '{q}' is {found:.9g}"
                )
            due, found = max(0.0, _float(dynamics, "friction", 0.0)), self.posed.number(dry_friction_of(own[q]))
            yield "" if abs(found - due) <= tolerances.COMPUTED * (1 + due) else f"friction of '{q}' is {found:.9g}"
            rest = _float(dynamics, "spring_reference", 0.0)
            if _float(dynamics, "spring_stiffness", 0.0):
                found = self.posed.number(getattr(own[q], "rest", None))
                yield (
                    ""
                    if abs(found - rest) <= tolerances.COMPUTED * (1 + abs(rest))
                    else f"rest of '{q}' is {found:.9g}"
                )

    def follows(self) -> Iterator[str]:
        """q = multiplier (leader - reference) + offset leaves nothing."""
        posed = PosedModel(self.model)
        for joint in self.chosen.findall("joint"):
            for tag in ("axis", "axis2"):
                mimic, q = joint.find(f"{tag}/mimic"), self._coordinate(joint, tag)
                other = None if mimic is None else self.named.get(str(mimic.get("joint")))
                if mimic is None or other is None or q is None:
                    continue
                leader = self._coordinate(other, mimic.get("axis", "axis"))
                if leader is None:
                    continue
                factor, offset, reference = (_float(mimic, name, 0.0) for name in ("multiplier", "offset", "reference"))
                posed.values[q] = factor * (posed.values[leader] - reference) + offset
        yield from posed.follows()

    def weighs(self, link: Element) -> str:
        """Mass, mass centre, inertia; by the shapes and their densities where the file requests that."""
        name, inertial = self.body(str(link.get("name"))), link.find("inertial")
        if name is None or inertial is None or (inertial.get("auto") in YES and not _all_solid(link)):
            return ""
        due = _by_density(link, inertial) if inertial.get("auto") in YES else _as_said(inertial)
        off = abs(self.posed.weight(name) - due).max()
        return (
            f"'{name}' has another mass, mass centre or inertia"
            if off > tolerances.COMPUTED * (1 + abs(due).max())
            else ""
        )


def _as_said(inertial: Element) -> np.ndarray:
    """m, m c, the inertia about the mass centre in the link's axes."""
    (R, p), m = _pose(inertial.find("pose")), _float(inertial, "mass", 1.0)
    rows = (("ixx", "ixy", "ixz"), ("ixy", "iyy", "iyz"), ("ixz", "iyz", "izz"))
    I = np.array([[_float(inertial, f"inertia/{key}", float(key[1] == key[2])) for key in row] for row in rows])
    return np.array([m, *(m * p), *(R @ I @ R.T).ravel()])


def _all_solid(link: Element) -> bool:
    """True if each collision of a link has a shape that is measured here, in axes of the link."""
    shapes = link.findall("collision")
    poses = [shape.find("pose") for shape in shapes]
    known = all(any(shape.find(f"geometry/{tag}") is not None for tag in SHAPES) for shape in shapes)
    return known and not any(pose is not None and pose.get("relative_to") for pose in poses)


def _by_density(link: Element, inertial: Element) -> np.ndarray:
    """The same, of boxes, cylinders and spheres by volume; a mass that is given too scales it."""
    parts = []
    for shape in link.findall("collision"):
        (R, p), (volume, squares) = _pose(shape.find("pose")), _solid(shape)
        m = volume * _float(shape, "density", _float(inertial, "density", WATER))
        I = R @ (m * (np.eye(3) * squares.sum() - np.diag(squares))) @ R.T
        parts.append((m, p, I))
    m = sum(each for each, _, _ in parts)
    c: np.ndarray = np.sum([each * p for each, p, _ in parts], axis=0) / m
    total = np.zeros((3, 3))
    for each, p, I in parts:
        total = total + I + each * ((p - c) @ (p - c) * np.eye(3) - np.outer(p - c, p - c))
    wanted = _float(inertial, "mass", m)
    return np.array([wanted, *(wanted * c), *(total * wanted / m).ravel()])


def _solid(shape: Element) -> tuple[float, np.ndarray]:
    """(volume, mean of x^2, y^2, z^2 over it)."""
    found = {tag: shape.find(f"geometry/{tag}") for tag in SHAPES}
    if (box := found["box"]) is not None:
        size = figures_in(_text(box, "size"))
        return float(np.prod(size)), size**2 / 12
    if (cylinder := found["cylinder"]) is not None:
        r, length = _float(cylinder, "radius", 0), _float(cylinder, "length", 0)
        return math.pi * r * r * length, np.array([r * r / 4, r * r / 4, length**2 / 12])
    sphere = found["sphere"]
    assert sphere is not None
    r = _float(sphere, "radius", 0)
    return 4 / 3 * math.pi * r**3, np.full(3, r * r / 5)


def _pose(pose: Element | None) -> FloatPose:
    """x y z roll pitch yaw, or x y z and a quaternion, scalar last."""
    if pose is None or not (pose.text or "").strip():
        return FIXED
    found = figures_in(str(pose.text))
    if pose.get("rotation_format") == "quat_xyzw":
        v = found[3:6]
        return turn_about(v / (np.linalg.norm(v) or 1.0), 2 * math.atan2(float(np.linalg.norm(v)), found[6])), found[:3]
    return turn_by_three(np.radians(found[3:]) if pose.get("degrees") in YES else found[3:]), found[:3]


def _text(element: Element, path: str) -> str:
    return (element.findtext(path) or "").strip()


def _float(element: Element, path: str, otherwise: float) -> float:
    text = _text(element, path)
    return float(text) if text else otherwise


# -------- imported urdf ---------------------------------------------------------------------------------------
# A URDF file's text, the model made of it -> whether bodies stand, weigh, follow, yield as the file says, in doubles.
#
#     T = (R_z(yaw) R_y(pitch) R_x(roll), xyz) (turn by s about, or slide along, the axis),    q = multiplier q' +
#         offset
#
# The file is read once more, by another program, and each joint is taken by itself: the child's pose in its parent's.


UNLIMITED = 1e9  # written where a format needs a limit and there is none
LIMITS = {  # as in the remark of a coordinate, which has those of joints without stops
    "lower": re.compile(r"from (\S+) to "),
    "upper": re.compile(r"from \S+ to (\S+) "),
    "effort": re.compile(r"at most (\S+) N(?:\*m)?(?=,|$)"),
    "velocity": re.compile(r"at most (\S+) (?:rad|m)/s"),
}
G = (0.0, 0.0, -9.81)  # gravity of programs that read URDF [m/s^2]
# of which nothing else is reported as left out
EXACT = ("forces", "stiffness", "armature", "restitution", "stop", "given motions")
TURNING, SLIDING = ("revolute", "continuous"), ("prismatic",)


def imported_otherwise(text: str | bytes, model: Model) -> str:
    """Message that names a body which differs from the file; "" where all that have the same name in both agree."""
    from xml.etree import ElementTree

    try:
        root = ElementTree.fromstring(text.strip())
    except ElementTree.ParseError:  # our reader accepts more
        return ""
    joints = [joint for joint in root.iter("joint") if joint.find("child") is not None]
    proof = _ImportedUrdf(model, joints)
    moving = (y for joint in joints for y in (proof.stands(joint), proof.yields(joint), proof.bounded(joint)))
    weights = (proof.weighs(link) for link in root.iter("link"))
    return first_wrong((*moving, *weights, *proof.posed.follows()))


def unsaid_otherwise(text: str, model: Model, left_out: Mapping[str, Collection[str]]) -> str:
    """Message for a declared part of a model that its URDF neither contains nor reports as left out; "".

    Args:
        left_out: {feature that URDF cannot express: where it is}.
    """
    from xml.etree import ElementTree

    root, posed = ElementTree.fromstring(text), PosedModel(model)
    uniform = {name: force.uniform for name, force in model.forces.items() if force.uniform is not None}
    g = [[posed.number(c) for c in (*of_all, None)[:3]] for of_all in uniform.values()]
    usual = np.allclose(np.sum(g, axis=0) if g else np.zeros(3), G, 0, tolerances.COMPUTED)
    pushes = {name: part.joint.pushes() for name, part in model.bodies.items() if part.joint is not None}
    q = model.coordinates
    due: dict[str, list[str]] = {
        "forces": [name for name in model.forces if name not in uniform or not usual],
        "stiffness": [name for name, each in pushes.items() if any(x.stiffness is not None for x in each)],
        "armature": [name for name, each in pushes.items() if any(x.armature is not None for x in each)],
        "restitution": [name for name, part in model.bodies.items() if getattr(part.joint, "restitution", None)],
        "stop": [name for name, part in model.bodies.items() if getattr(part.joint, "stop", None)],
        "friction": [name for name, each in pushes.items() if any(_is_beyond(x.friction) for x in each)],
        "values of inputs": [name for name, part in model.inputs.items() if _given(posed, part.value)],
        "start values": [x for x, part in q.items() if _given(posed, part.start) or _given(posed, part.speed)],
        "given motions": [x for x, part in q.items() if part.driven],
    }
    drives = [name for name, each in pushes.items() if any(x.push is not None for x in each)]
    said = {
        "constraints": (
            [name for name, x in model.constraints.items() if not x.about_joint],  # stops: `bounded`
            sum(1 for _ in root.iter("mimic")),
        ),
        "drives that are no input alone": (drives, sum(1 for _ in root.iter("transmission"))),
    }
    for what, names in due.items():
        if missing := [name for name in names if name not in left_out.get(what, ())]:
            return f"{what} of '{missing[0]}' are not in the file, and not reported as left out"
        if what in EXACT and (more := [name for name in left_out.get(what, ()) if name not in names]):
            return f"{what} of '{more[0]}' are reported as left out, and are in the file, or are not there"
    for what, (names, there) in said.items():
        if len(names) - there != len({*left_out.get(what, ())} & {*names}):
            return f"{what}: {len(names)}, {there} in the file and {len(left_out.get(what, ()))} are left out"
    return ""


def without_units(model: Model) -> str:
    """Message that names a parameter of the weight, or a coordinate of a joint's spring, without a unit; ""."""
    weights = (x for force in model.forces.values() for x in force.uniform or ())
    joints = (part.joint for part in model.bodies.values() if part.joint is not None)
    ways = (each.way for joint in joints for each in joint.pushes() if each.way is not None)
    used = {name for x in (*weights, *ways) for name in x.names}
    parts: dict[str, Any] = {**model.parameters, **model.coordinates}
    bare = [name for name in parts if name in used and (parts[name] is None or parts[name].unit is None)]
    return f"'{bare[0]}' has no unit" if bare else ""


def _is_beyond(law: Any) -> bool:
    """True if URDF cannot say a friction of a joint: one number."""
    return law is not None and (law.size is None or law.smooth is not None or law.static is not None)


def dry_friction_of(joint: Any) -> Any:
    """The size of the dry friction of a joint of one variable; None without."""
    return next((law.size for _, _, law in joint.frictions), None)


def _given(posed: PosedModel, value: Any) -> bool:
    """True if a value is given, and is not 0."""
    return value is not None and (bool(value.names) or posed.number(value) != 0)


class _ImportedUrdf:
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
        """Coordinate by which the child of a hinge or slide moves; None of other joints."""
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
        """The damping and the dry friction of a hinge or slide."""
        child, dynamics = self.body(_named(joint, "child")), joint.find("dynamics")
        if child is None or self.coordinate(joint) is None:
            return ""
        own = self.model.bodies[child].joint
        for name, found in (("damping", getattr(own, "damping", None)), ("friction", dry_friction_of(own))):
            due, here = 0.0 if dynamics is None else float(dynamics.get(name, 0)), self.posed.number(found)
            if abs(here - max(due, 0.0 if name == "friction" else due)) > tolerances.COMPUTED * (1 + abs(due)):
                return f"the joint of '{child}' has another {name}"
        return ""

    def bounded(self, joint: Element) -> str:
        """Limits of a hinge or slide, as its stops or the remark of its coordinate say."""
        q, limit = self.coordinate(joint), joint.find("limit")
        if q is None:
            return ""
        about = self.model.coordinates[q].about or ""
        reported = {key: x.findall(about) for key, x in LIMITS.items()}
        stops = dict(zip(("lower", "upper"), self.posed.stops(self.body(_named(joint, "child")) or ""), strict=True))
        if any(map(math.isfinite, stops.values())):
            reported |= {key: [max(-UNLIMITED, min(UNLIMITED, x))] for key, x in stops.items()}
        due: dict[str, float] = {}
        if limit is not None:
            ends = [] if joint.get("type") == "continuous" else [key for key in ("lower", "upper") if limit.get(key)]
            due = {key: float(limit.get(key, 0)) for key in ("lower", "upper")} if ends else {}
            due = {} if due.get("upper", 0) >= UNLIMITED else due
            due |= {key: float(x) for key in ("effort", "velocity") if (x := limit.get(key)) is not None}
        else_none = {"lower": -UNLIMITED, "upper": UNLIMITED, "effort": UNLIMITED, "velocity": UNLIMITED}
        for key, none in else_none.items():
            found, wanted = float(reported[key][0]) if reported[key] else none, due.get(key, none)
            if abs(found - wanted) > tolerances.COMPUTED * abs(wanted) and not (key not in due and not reported[key]):
                return f"the limits of '{q}' are reported differently"
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
        return (
            f"'{name}' has another mass, mass centre or inertia"
            if off > tolerances.COMPUTED * (1 + abs(due).max())
            else ""
        )


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
