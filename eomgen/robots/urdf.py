"""URDF -> tables of a model file. http://wiki.ros.org/urdf/XML

A link is a body whose axes are those of its joint; R = Rz(yaw) Ry(pitch) Rx(roll) of `rpy`; an axis that is not given
is x. A joint that mimics another is one of its own, with the equation between the two.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import field
from decimal import Decimal
from functools import partial
from typing import Any

from eomgen.errors import ModelError
from eomgen.frozen import dataclass
from eomgen.model import InertiaMatrix, nearest
from eomgen.robots.tables import (
    NO_COUNTERPART,
    ORIGIN,
    UNLIMITED,
    ZERO,
    Entries,
    Imported,
    LeftOut,
    LegalNames,
    Mimic,
    Moved,
    Range,
    Seat,
    add_left_out,
    computed,
    decimals,
    gap,
    hung,
    in_file,
    inertia_in,
    reported_left,
    roll_pitch_yaw,
    six,
    started_within,
    without_empty,
)
from eomgen.robots.xml_tree import XmlElement, xml_tree
from eomgen.symbolic.expression import Matrix, Vector
from eomgen.symbolic.numeric import tolerances

ONE_AXIS = {"revolute": "rad", "continuous": "rad", "prismatic": "m"}
KINDS = (*ONE_AXIS, "fixed", "floating", "planar")
LEFT_OUT = {  # elements without a counterpart, and why
    "visual": "pictures only",
    "material": "pictures only",
    "collision": "no contact is declared by a shape: see [constraints]",
    "gazebo": "settings of a simulator",
    "sensor": "not mechanics; outputs request measured quantities",
    "joint of <mimic>": "no joint about or along one axis is called so",
    "name of <joint>": "no joint that moves by one axis is called so",
    "calibration": "not mechanics",
    "safety_controller": "limits of a controller",
    "ros2_control": "settings of a controller",
    "mechanicalReduction": "the input acts at the joint",
    "hardwareInterface": "settings of a controller",
    "drake:rotor_inertia": "no joint about or along one axis is driven by it",
    "drake:gear_ratio": "no joint about or along one axis is driven by it",
    "friction": "below zero: it would drive",
}
LEFT_OUT |= {f"{key} of <inertia>": "below zero by rounding: 0" for key in ("ixx", "iyy", "izz")}
SPEAKING = ("include", "joint")  # elements that are reported by their own names, not by those of their parents
WORLD = "world"  # a parent that is no link is the ground
GRAVITY = {"kind": "gravity", "acceleration": [0, 0, "-g"]}


def urdf(data: bytes, name: str, *, floating: bool) -> Imported:
    """The tables of a robot.

    Args:
        name: stands for the file in messages.
        floating: nothing holds the base; else it is fixed to the ground.
    Raises:
        ModelError: no robot, or one that is not a tree.
    """
    root = xml_tree(data, name)
    if root.tag != "robot":
        raise ModelError(f"the root is <{root.tag}>, of a URDF file it is <robot>", root.where, "name a URDF file")
    return _Reading.of(root).tables(floating)


def origin_of(element: XmlElement | None) -> tuple[Vector, Matrix, list[Entries]]:
    """(place, rotation, its turns) of an <origin>."""
    if element is None:
        return ORIGIN, Matrix.IDENTITY, []
    R, turns = roll_pitch_yaw(element.vector("rpy", "0 0 0"))
    return element.vector("xyz", "0 0 0"), R, turns


def massive(inertial: XmlElement | None) -> Entries:
    """Mass, mass centre and inertia of a body: the axes of the inertia are turned into the body's."""
    if inertial is None:
        return {}
    center, R, _ = origin_of(inertial.one("origin"))
    mass = inertial.one("mass")
    kilograms = ZERO if mass is None else mass.number("value")
    if mass is not None and kilograms < 0:
        raise ModelError(f"a negative mass: {kilograms}", mass.where, "give a mass of 0 or more")
    tensor, found = inertial.one("inertia"), {"mass": kilograms}
    moments = [ZERO] * 3
    if tensor is not None:
        entries = [tensor.number(key, "0") for key in ("ixx", "iyy", "izz", "ixy", "iyz", "ixz")]
        for k, key in enumerate(("ixx", "iyy", "izz")):
            if entries[k] < -tolerances.NOT_NEGATIVE:
                raise ModelError(
                    f"a negative moment of inertia: {entries[k]}", tensor.where, f"give {key} of 0 or more"
                )
            if entries[k] < 0:
                tensor.read.discard(key)
                entries[k] = ZERO
        moments = six(
            inertia_in(R, InertiaMatrix.of_moments(*entries))
            if R != Matrix.IDENTITY
            else InertiaMatrix.of_moments(*entries)
        )
    return with_mass(found, center, moments)


def with_mass(found: Entries, center: Vector, moments: list[Decimal]) -> Entries:
    """A body with its centre and its inertia; a body that has neither mass nor inertia is a frame."""
    if found["mass"] == 0 and not any(moments):
        return {}
    if any(center):
        found["center"] = in_file(center)
    found["inertia"] = moments
    if not InertiaMatrix.of_moments(*map(float, moments)).is_possible():
        found["measured"] = True
    return found


@dataclass(frozen=True)
class _Reading:
    """A robot's elements, by name.

    Args:
        above: of each link the joint by which it hangs.
        coordinates, bodies: the legal names, of joints and of links.
        rotors: inertia that motors behind gears add, by joint.
        ranges: between the limits of each coordinate.
        follows: the coordinates that follow others.
    """

    robot: XmlElement
    links: Mapping[str, XmlElement]
    joints: Mapping[str, XmlElement]
    above: Mapping[str, str]
    names: LegalNames
    bodies: LegalNames
    body: Mapping[str, str]
    coordinate: Mapping[str, str]
    rotors: dict[str, Decimal] = field(default_factory=dict)
    ranges: dict[str, Range] = field(default_factory=dict)
    follows: dict[str, Mimic] = field(default_factory=dict)

    @classmethod
    def of(cls, robot: XmlElement) -> _Reading:
        links, joints = by_name(robot, "link"), by_name(robot, "joint")
        if not links:
            fix = "expand it by xacro first" if robot.children else "name a URDF file"
            raise ModelError("the robot has no <link>", robot.where, fix)
        above: dict[str, str] = {}
        for name, joint in joints.items():
            for end in ("parent", "child"):
                link = _need(joint, end).need("link")
                if link not in links and not (end == "parent" and link == WORLD):
                    fix = nearest(link, links) or f"one of {', '.join(links)}"
                    raise ModelError(f"joint '{name}' names a link that there is not: '{link}'", joint.where, fix)
            child = _need(joint, "child").need("link")
            if child in above:
                what = f"link '{child}' hangs on two joints, '{above[child]}' and '{name}'"
                raise ModelError(what, joint.where, "URDF is of trees")
            above[child] = name
        names, bodies = LegalNames(), LegalNames()
        body = {link: bodies.new(link, "link") for link in links}
        coordinate = {name: names.new(name, "q") for name in joints if _need_kind(joints[name]) != "fixed"}
        return cls(robot, links, joints, above, names, bodies, body, coordinate)

    def tables(self, floating: bool) -> Imported:
        title = self.robot.get("name") or "robot"
        roots = [link for link in self.links if link not in self.above]
        grounds = [WORLD] if WORLD not in self.links else []
        ordered = [link for root in (*grounds, *roots) for link in self._below(root) if link in self.links]
        if len(ordered) != len(self.links):
            lost = next(link for link in self.links if link not in ordered)
            raise ModelError(f"link '{lost}' hangs in a ring of joints", self.links[lost].where, "URDF is of trees")
        found: Entries = {key: {} for key in ("coordinates", "speeds", "inputs", "bodies", "constraints")}
        driven = self._driven()
        for link in ordered:
            self._add(found, link, floating and link in roots, driven)
        reported: list[LeftOut] = []
        started_within(found["coordinates"], partial(add_left_out, reported), self.ranges, self.follows)
        g = self.names.new("g")
        weight = {**GRAVITY, "acceleration": [0, 0, f"-{g}"]}
        head = {"eomgen": 1, "name": title, "space": "space"}
        parameters = {g: {"value": Decimal("9.81"), "unit": "m/s^2"}}
        tables = {**head, "parameters": parameters, **without_empty(found), "forces": {"weight": weight}}
        return Imported(tables, (*left_out(self.robot, LEFT_OUT), *reported))

    def _below(self, root: str) -> list[str]:
        """Reads a link and all links below it, each after its parent."""
        order, waiting = [], [root]
        children: dict[str, list[str]] = {}
        for child, joint in self.above.items():
            children.setdefault(_need(self.joints[joint], "parent").need("link"), []).append(child)
        while waiting:
            link = waiting.pop()
            order.append(link)
            waiting += reversed(children.get(link, []))
        return order

    def _driven(self) -> set[str]:
        """The joints that have a motor: those of the transmissions, without any each joint that mimics no other."""
        named = set()
        for transmission in self.robot.all("transmission"):
            transmission.get("name")
            transmission.get("type"), transmission.one("type")  # whatever the transmission, the input acts at the joint
            for joint in transmission.all("joint"):
                raw = joint.get("name") or ""
                named.add(raw)
                if raw not in self.coordinate:
                    joint.read.discard("name")
            for actuator in transmission.all("actuator"):
                actuator.get("name")
                self._rotor(transmission, actuator)
        own = {name for name, joint in self.joints.items() if joint.one("mimic") is None}
        return (named & own) or own

    def _rotor(self, transmission: XmlElement, actuator: XmlElement) -> None:
        """Adds the rotor behind a gear, ratio^2 J, where one joint of one axis is driven; else reported as left out."""
        raw = [joint.get("name") or "" for joint in transmission.all("joint")]
        if len(raw) == 1 and raw[0] in self.coordinate and _need_kind(self.joints[raw[0]]) in ONE_AXIS:
            inertia, ratio = (actuator.one(f"drake:{tag}") for tag in ("rotor_inertia", "gear_ratio"))
            turns = Decimal(1) if ratio is None else ratio.number("value")
            own = ZERO if inertia is None else inertia.number("value")
            self.rotors[raw[0]] = self.rotors.get(raw[0], ZERO) + turns * turns * own

    def _add(self, found: Entries, link: str, free: bool, driven: set[str]) -> None:
        """Reads a link and its joint, with damper, spring and remarks."""
        element = self.links[link]
        element.get("type")
        name = self.body[link]
        body = {"about": f"link {link}"} if name != link else {}
        body |= massive(element.one("inertial"))
        if link not in self.above:
            joints = [self._floating(found, name)] if free else []
            found["bodies"] |= hung(name, body, Seat(None), joints, self.bodies)
            return
        raw = self.above[link]
        joint = self.joints[raw]
        at, R, turns = origin_of(joint.one("origin"))
        seat = Seat(self.body.get(_need(joint, "parent").need("link")), at, R, turns)
        found["bodies"] |= hung(name, body, seat, self._joints(found, raw, joint, raw in driven), self.bodies)

    def _joints(self, found: Entries, raw: str, joint: XmlElement, driven: bool) -> list[Moved]:
        kind = _need_kind(joint)
        if kind == "fixed":
            for extra in ("axis", "limit", "dynamics"):  # mean nothing here
                if (element := joint.one(extra)) is not None:
                    element.read |= set(element.attributes)
            return []
        if kind == "floating":
            return [self._floating(found, self.coordinate[raw])]
        element = joint.one("axis")
        axis = decimals([1, 0, 0]) if element is None else element.vector("xyz", "1 0 0")
        if not any(axis):
            raise ModelError(
                f"the axis of joint '{raw}' has no direction", joint.where, "give three numbers, not all 0"
            )
        if kind == "planar":
            return self._planar(found, raw, axis)
        return [self._one_axis(found, raw, joint, axis, driven)]

    def _one_axis(self, found: Entries, raw: str, joint: XmlElement, axis: Vector, driven: bool) -> Moved:
        """A hinge or a slide, its coordinate, its limits, its motor and its damper."""
        q, kind = self.coordinate[raw], _need_kind(joint)
        unit = ONE_AXIS[kind]
        turns = unit == "rad"
        slides = "revolute" if turns else "prismatic"
        found["coordinates"][q] = {"unit": unit}
        keys: Entries = {"kind": slides, "axis": list(axis), "angle" if turns else "displacement": q}
        own = self.ranges[q] = _range(joint)
        mimic = joint.one("mimic")
        follows = mimic is not None and self._mimic(found, raw, mimic)
        keys |= {} if follows else own.limits()
        found["coordinates"][q] |= _about(raw, q, joint, unit, own.remark(unit) if follows or own.empty else [])
        if mimic is None and driven:
            effort = self.names.new(f"{'tau' if turns else 'F'}_{q}")
            found["inputs"][effort] = {"value": 0, "unit": "N*m" if turns else "N"}
            keys["torque" if turns else "force"] = effort
        if rotor := self.rotors.get(raw):
            keys["armature"] = computed(rotor)
        if (dynamics := joint.one("dynamics")) is not None:
            if (damping := dynamics.number("damping", "0")) != 0:
                keys["damping"] = damping
            if (friction := dynamics.number("friction", "0")) > 0:
                keys["friction"] = {"torque" if turns else "force": friction}
            elif friction < 0:
                dynamics.read.discard("friction")
        return Moved(keys, name=q)

    def _mimic(self, found: Entries, raw: str, mimic: XmlElement) -> bool:
        """Reads the equation q = multiplier q' + offset; True if the other coordinate exists."""
        q, other = self.coordinate[raw], mimic.need("joint")
        leader = self.joints.get(other)
        unit = None if leader is None else ONE_AXIS.get(_need_kind(leader))
        if unit is None:  # some files have it so: reported among the parts left out
            mimic.read.discard("joint")
            return False
        factor, offset = mimic.number("multiplier", "1"), mimic.number("offset", "0")
        self.follows[q] = Mimic(self.coordinate[other], factor, offset)
        same = unit == found["coordinates"][q]["unit"]
        follows = gap(q, [(-factor, self.coordinate[other])], -offset, weighed=not same)
        found["constraints"][self.bodies.new(f"mimic_{q}")] = {"kind": "equation", "gap": follows}
        return True

    def _planar(self, found: Entries, raw: str, normal: Vector) -> list[Moved]:
        """Two slides across the normal and a turn about it."""
        k = min(range(3), key=lambda i: abs(normal[i]))
        e = decimals(int(i == k) for i in range(3))
        first = e.cross(normal)
        across = [first, normal.cross(first)]
        if normal[0] == normal[1] == 0:
            across = [decimals([1, 0, 0]), decimals([0, 1, 0])]
        q = self.coordinate[raw]
        joints = []
        for letter, axis in zip("xy", across, strict=True):
            name = self.names.new(f"{q}_{letter}")
            found["coordinates"][name] = {"unit": "m"}
            joints.append(Moved({"kind": "prismatic", "axis": in_file(axis), "displacement": name}, name=letter))
        found["coordinates"][q] = {"unit": "rad", "about": f"the turn of joint {raw}"}
        return [*joints, Moved({"kind": "revolute", "axis": list(normal), "angle": q})]

    def _floating(self, found: Entries, stem: str) -> Moved:
        return free_joint(found, stem, self.names)


def free_joint(found: Entries, stem: str, names: LegalNames, start: Vector = ORIGIN, turn: Any = (1, 0, 0, 0)) -> Moved:
    """A joint in which nothing is held, its turn by a quaternion."""
    places = [names.new(f"{stem}_{letter}") for letter in "xyz"]
    found["coordinates"] |= {
        name: {"start": x, "unit": "m"} if x else {"unit": "m"} for name, x in zip(places, start, strict=True)
    }
    return Moved({"kind": "free", "position": places, **turned_freely(found, stem, names, turn)}, name=stem)


def turned_freely(found: Entries, stem: str, names: LegalNames, turn: Any = (1, 0, 0, 0)) -> Entries:
    """A quaternion and the speeds that go with it."""
    parts = [names.new(f"{stem}_e{k}") for k in range(4)]
    spins = [names.new(f"{stem}_w{letter}") for letter in "xyz"]
    found["coordinates"] |= {name: {"start": x} for name, x in zip(parts, turn, strict=True)}
    found["speeds"] |= {name: {} for name in spins}
    return {"orientation": "quaternion", "quaternion": parts, "omega": spins}


def left_out(root: XmlElement, why: Mapping[str, str]) -> tuple[LeftOut, ...]:
    """Elements that were not read, in groups of one kind."""
    groups: dict[str, list[str]] = {}

    def named(element: XmlElement) -> str:
        within = next((child.text for tag in ("name", "uri") for child in element.children if child.tag == tag), "")
        name = element.attributes.get("name") or element.attributes.get("reference") or within
        return f"{element.tag} {name}" if name else f"{element.tag} (line {element.where.split(':')[-2]})"

    def walk(element: XmlElement, above: str) -> None:
        if not element.seen:
            own = element.tag in SPEAKING or element.tag not in why or not above
            groups.setdefault(element.tag, []).append(named(element) if own else above)
            return
        for key in element.attributes:
            if key not in element.read and not key.startswith("xmlns"):
                label = key if key in why else f"{key} of <{element.tag}>"
                groups.setdefault(label, []).append(above if "name" not in element.attributes else named(element))
        for child in element.children:
            walk(child, named(element) if element.attributes.get("name") and element is not root else above)

    walk(root, "")
    return tuple(reported_left(what, where, why.get(what, NO_COUNTERPART)) for what, where in groups.items())


def _range(joint: XmlElement) -> Range:
    limit = joint.one("limit")
    if limit is None or _need_kind(joint) == "continuous":
        return Range()
    lower, upper = limit.get("lower"), limit.get("upper")
    if not (lower or upper) or upper == UNLIMITED:
        return Range()
    return Range(limit.number("lower", "0"), limit.number("upper", "0"))


def _about(raw: str, q: str, joint: XmlElement, unit: str, ends: Sequence[str]) -> Entries:
    """A remark: the joint's name where it is another, ends that are no stops here, the limits of its motor."""
    said = [*([f"joint {raw}"] if q != raw else []), *ends]
    if (limit := joint.one("limit")) is not None:
        _, _, effort, speed = (limit.get(key) for key in ("lower", "upper", "effort", "velocity"))
        if effort and effort != UNLIMITED:
            said.append(f"at most {effort} {'N*m' if unit == 'rad' else 'N'}")
        if speed and speed != UNLIMITED:
            said.append(f"at most {speed} {unit}/s")
    return {"about": ", ".join(said)} if said else {}


def by_name(robot: XmlElement, tag: str) -> dict[str, XmlElement]:
    """Elements of a name each."""
    found: dict[str, XmlElement] = {}
    for element in robot.all(tag):
        name = element.need("name")
        if name in found:
            raise ModelError(f"two <{tag}> are called '{name}'", element.where, "give each a name of its own")
        found[name] = element
    return found


def _need(element: XmlElement, tag: str) -> XmlElement:
    found = element.one(tag)
    if found is None:
        raise ModelError(f"<{element.tag}> has no <{tag}>", element.where, "give one")
    return found


def _need_kind(joint: XmlElement) -> str:
    kind = joint.need("type")
    if kind not in KINDS:
        fix = nearest(kind, KINDS) or f"one of {', '.join(KINDS)}"
        raise ModelError(f"unknown type of a joint: '{kind}'", joint.where, fix)
    return kind
