"""SDF -> tables of a model file. http://sdformat.org/spec

A link is a body. Poses are of links, joints and frames, each relative to another (`relative_to`), a link's to the
model, a joint's to its child. A joint sits at its own place in the child; where nothing joins a link to the world it
is free, unless the model is static.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import field
from decimal import Decimal
from functools import partial
from typing import Any

from eomgen.errors import ModelError
from eomgen.frozen import dataclass
from eomgen.model import nearest
from eomgen.robots.sdf_models import YES, FlatModel, SdfChoice, choice_named, choices, link_masses, own_pose
from eomgen.robots.tables import (
    ORIGIN,
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
    quaternion_of,
    reported_left,
    started_within,
    turn_of,
    without_empty,
)
from eomgen.robots.urdf import LEFT_OUT, by_name, free_joint, left_out, turned_freely
from eomgen.robots.xml_tree import XmlElement, xml_tree
from eomgen.symbolic.expression import Matrix, Pose, Vector

ONE_AXIS = {"revolute": "rad", "continuous": "rad", "prismatic": "m", "screw": "rad"}
TWO_AXES = ("universal", "revolute2")
KINDS = (*ONE_AXIS, *TWO_AXES, "fixed", "ball")
SOFT = {"stiffness": "stiffness", "dissipation": "damping"}  # of the stops of a joint
ENDLESS = Decimal(10) ** 15  # a limit beyond it is none
STANDARD = "0 0 -9.8"  # gravity, where the file says nothing
WHY = LEFT_OUT | {
    "plugin": "code of a simulator",
    "physics": "settings of a simulator",
    "self_collide": "no contact is declared by a shape: see [constraints]",
    "include": "a model whose file is not there",
    "joint": "between models of a world",
}


def sdf(data: bytes, name: str, wanted: str | None = None) -> Imported:
    """The tables of a model: of the only one of a file, of the one that is wanted, else of the first that moves.

    Args:
        name: stands for the file in messages.
        wanted: the model's name.
    Raises:
        ModelError: no model, none of the name, or one whose links are no tree.
    """
    root = xml_tree(data, name)
    every = choices(root, name)
    if not every:
        raise ModelError("the file holds no <model>", root.where, "name an SDF file with one")
    choice, found = _first_that_moves(every) if wanted is None else _tables(choice_named(every, wanted, root))
    others = [each for each in every if each is not choice]
    names = [each.name for each in others]
    for each in others:
        each.element.seen = True
        each.element.children, each.element.read = [], {*each.element.attributes}
    reported = [reported_left("model", names, "another of the file's models")] if others else []
    return Imported(found.tables, (*reported, *left_out(root, WHY), *found.left_out))


def _first_that_moves(every: list[SdfChoice]) -> tuple[SdfChoice, Imported]:
    """First model that is not static, else the first one; an include of a missing file is skipped.

    Raises:
        ModelError: of the first one, where nothing can be read.
    """
    first: tuple[SdfChoice, Imported] | None = None
    missing: ModelError | None = None
    for choice in every:
        try:
            found = _tables(choice)
        except ModelError as error:
            if choice.element.tag == "model":
                raise
            missing = missing or error
            continue
        if found[1].tables.get("coordinates"):
            return found
        first = first or found
    if first is None:
        assert missing is not None
        raise missing
    return first


def _tables(choice: SdfChoice) -> tuple[SdfChoice, Imported]:
    gravity = choice.gravity
    acceleration = gravity.value(3) if gravity is not None else decimals(STANDARD.split())
    return choice, _Reading.of(choice.flat()).tables(acceleration)


@dataclass
class _Reading:
    """Elements of a model by name, and the tables that are made of them.

    Args:
        above: of each link the joint by which it hangs.
        coordinate, second: of each joint the name of its coordinate, and of that of a second axis.
        ranges: between the limits of each coordinate.
        follows: the coordinates that follow others.
        weightless: bodies on which gravity does not act.
    """

    flat: FlatModel
    links: Mapping[str, XmlElement]
    joints: Mapping[str, XmlElement]
    frames: Mapping[str, XmlElement]
    above: dict[str, str] = field(default_factory=dict)
    names: LegalNames = field(default_factory=LegalNames)
    bodies: LegalNames = field(default_factory=LegalNames)
    body: dict[str, str] = field(default_factory=dict)
    coordinate: dict[str, str] = field(default_factory=dict)
    second: dict[str, str] = field(default_factory=dict)
    weightless: set[str] = field(default_factory=set)
    found: Entries = field(default_factory=dict)
    ranges: dict[str, Range] = field(default_factory=dict)
    follows: dict[str, Mimic] = field(default_factory=dict)

    @classmethod
    def of(cls, flat: FlatModel) -> _Reading:
        links, joints, frames = (by_name(flat.model, tag) for tag in ("link", "joint", "frame"))
        made = cls(flat, links, joints, {**flat.nested, **frames})
        for name, joint in made.joints.items():
            parent, child = made._end(joint, "parent"), made._end(joint, "child")
            if child == "world":
                raise ModelError(f"the world hangs on joint '{name}'", joint.where, "let it be the parent")
            if child in made.above:
                what = f"link '{child}' hangs on two joints, '{made.above[child]}' and '{name}'"
                raise ModelError(what, joint.where, "take one out and say it by a constraint")
            made.above[child] = name
            for link in (parent, child):
                if link not in made.links and link != "world":
                    fix = nearest(link, made.links) or f"one of {', '.join(made.links)}"
                    raise ModelError(f"joint '{name}' names a link that there is not: '{link}'", joint.where, fix)
        made.body = {link: made.bodies.new(link, "link") for link in made.links}
        made.coordinate = {name: made.names.new(name, "q") for name in made.joints}
        made.second = {
            name: made.names.new(f"{made.coordinate[name]}_2")
            for name, joint in joints.items()
            if joint.attributes.get("type") in TWO_AXES
        }
        return made

    @property
    def model(self) -> XmlElement:
        return self.flat.model

    def tables(self, gravity: Any) -> Imported:
        keys = ("coordinates", "speeds", "inputs", "bodies", "constraints")
        self.found = {key: {} for key in keys}
        static = self.model.one("static")
        fixed = static is not None and static.text in YES
        for link in self._ordered():
            self._link(link, fixed)
        reported: list[LeftOut] = []
        started_within(self.found["coordinates"], partial(add_left_out, reported), self.ranges, self.follows)
        g = self.names.new("g")
        weight: Entries = {"kind": "gravity", "acceleration": [0, 0, f"-{g}"]}
        parameters: Entries = {g: {"value": -gravity[2], "unit": "m/s^2"}}
        if any(gravity[:2]) or gravity[2] >= 0:
            weight["acceleration"], parameters = list(gravity), {}
        name = self.model.get("name") or "robot"
        head = {"eomgen": 1, "name": name, "space": "space"}
        if self.weightless:
            weight["bodies"] = [
                x for x, body in self.found["bodies"].items() if "mass" in body and x not in self.weightless
            ]
        forces = {"forces": {"weight": weight}} if any(gravity) and weight.get("bodies") != [] else {}
        tables = {**head, **without_empty({"parameters": parameters, **self.found}), **forces}
        return Imported(tables, tuple(reported))

    def _end(self, joint: XmlElement, tag: str) -> str:
        """The link that a joint names, or that a frame is attached to which it names."""
        return self._link_of(self._named(joint, tag))

    def _named(self, joint: XmlElement, tag: str) -> str:
        found = joint.one(tag)
        if found is None:
            raise ModelError(f"<joint> has no <{tag}>", joint.where, "give one")
        return found.text

    def _link_of(self, name: str, below: tuple[str, ...] = ()) -> str:
        """Link with which a frame moves: a link itself, a joint's child, the link to which a frame is attached."""
        if name in below:
            raise ModelError(f"frame '{name}' is attached to itself", self.model.where, "fix attached_to")
        if name == "__model__" and self.links:
            return self.model.get("canonical_link") or next(iter(self.links))
        if name in self.flat.canonical and name not in self.links:
            return self.flat.canonical[name]
        if name in self.frames and name not in self.links:
            frame = self.frames[name]
            return self._link_of(frame.get("attached_to") or self.flat.scope_of(frame).frame, (*below, name))
        if name in self.joints and name not in self.links and below:
            return self._link_of(self._named(self.joints[name], "child"), (*below, name))
        return name

    def _ordered(self) -> list[str]:
        """Links in an order in which each follows its parent."""
        order: list[str] = []

        def add(link: str, below: tuple[str, ...]) -> None:
            if link in below:
                raise ModelError(f"link '{link}' hangs in a ring of joints", self.links[link].where, "cut it")
            if link in order or link == "world":
                return
            if link in self.above:
                add(self._end(self.joints[self.above[link]], "parent"), (*below, link))
            order.append(link)

        for link in self.links:
            add(link, ())
        return order

    # poses

    def _pose(self, name: str, below: tuple[str, ...] = (), stop: str = "__model__") -> Pose:
        """Pose of a link, joint or frame in the model's axes, or in those of a frame to which it counts."""
        if name in ("__model__", "", stop):
            return Pose(Matrix.IDENTITY, Vector(ORIGIN))
        if name == "world":
            return self._placed().inverse()
        element = self.links.get(name) or self.joints.get(name) or self.frames.get(name)
        if element is None or name in below:
            what = "is relative to itself" if name in below else "there is not"
            raise ModelError(f"a pose names a frame that {what}: '{name}'", self.model.where, "fix relative_to")
        pose = element.one("pose")
        base = self.flat.scope_of(element).frame
        if element.tag == "joint":
            base = self._named(element, "child")
        elif element.tag == "frame":
            base = element.get("attached_to") or base
        if pose is not None:
            base = pose.get("relative_to") or base
        found = self._pose(base, (*below, name), stop).then(own_pose(pose))
        if element.tag == "model" and (placed := element.get("placement_frame")):
            return found.then(self._pose(placed, (name,), name).inverse())
        return found

    def _in_link(self, collision: XmlElement, link: str) -> Pose:
        """Pose of a collision in its link."""
        pose = next((child for child in collision.children if child.tag == "pose"), None)
        other = None if pose is None else pose.attributes.get("relative_to")
        if not other or other == link:
            return own_pose(pose)
        return self._pose(link).inverse().then(self._pose(other)).then(own_pose(pose))

    def _placed(self) -> Pose:
        """Pose of the model in the world: of its own frame, or of the one by which it is placed."""
        pose = next((child for child in self.model.children if child.tag == "pose"), None)
        if pose is not None and pose.attributes.get("relative_to", "world") != "world":
            pose.seen = False  # relative to a thing that is not imported: reported among the parts left out
            return Pose(Matrix.IDENTITY, Vector(ORIGIN))
        frame = self.model.get("placement_frame") or "__model__"
        if pose is not None:
            pose.seen = True
        return own_pose(pose).then(self._pose(frame).inverse())

    # links and joints

    def _link(self, raw: str, fixed: bool) -> None:
        name, element = self.body[raw], self.links[raw]
        body: Entries = {"about": f"link {raw}"} if name != raw else {}
        files = self.flat.scope_of(element).files
        inertial = element.one("inertial")
        if not (
            fixed and inertial is not None and inertial.get("auto") in YES
        ):  # a link that stands still needs no mass
            body |= link_masses(element, lambda shape: self._in_link(shape, raw), files)
        gravity = element.one("gravity")
        if gravity is not None and gravity.text in ("false", "0"):
            self.weightless.add(name)
        joint = self.joints.get(self.above.get(raw, ""))
        parent = "world" if joint is None else self._end(joint, "parent")
        apart = self._pose(parent).inverse().then(self._pose(raw))
        turn = quaternion_of(apart.R)
        if joint is None and not fixed:
            moved = [free_joint(self.found, name, self.names, apart.p, in_file(turn))]
            self.found["bodies"] |= hung(name, body, Seat(None), moved, self.bodies)
            return
        seat = Seat(None if parent == "world" else self.body[parent], apart.p, apart.R, turn_of(turn))
        moved = [] if joint is None else self._joints(self.above[raw], joint, raw)
        self.found["bodies"] |= hung(name, body, seat, moved, self.bodies)

    def _joints(self, raw: str, joint: XmlElement, child: str) -> list[Moved]:
        kind = joint.need("type")
        if kind not in KINDS:
            fix = nearest(kind, KINDS) or f"one of {', '.join(KINDS)}"
            raise ModelError(f"a joint of a type that is not imported: '{kind}'", joint.where, fix)
        at = self._pose(child).inverse().then(self._pose(raw))
        q = self.coordinate[raw]
        if kind == "fixed":
            return []
        if kind == "ball":
            return [Moved({"kind": "spherical", **turned_freely(self.found, q, self.names)}, at.p, q)]
        tags = ("axis", "axis2") if kind in TWO_AXES else ("axis",)
        return [self._one_axis(raw, joint, tag, at, child, kind) for tag in tags]

    def _one_axis(self, raw: str, joint: XmlElement, tag: str, at: Pose, child: str, kind: str) -> Moved:
        element = joint.one(tag)
        if element is None:
            raise ModelError(f"joint '{raw}' has no <{tag}>", joint.where, "give one")
        q = self.coordinate[raw] if tag == "axis" else self.second[raw]
        unit = ONE_AXIS.get(kind, "rad")
        about = [f"joint {raw}"] if q != raw else []
        keys: Entries = {"kind": {"m": "prismatic"}.get(unit, "screw" if kind == "screw" else "revolute")}
        keys["axis"] = self._axis(element, joint, at, child)
        keys["displacement" if unit == "m" else "angle"] = q
        if kind == "screw":
            pitch = joint.one("screw_thread_pitch")
            if pitch is None:
                raise ModelError(f"screw '{raw}' has no <screw_thread_pitch>", joint.where, "give it in m a turn")
            keys["pitch"] = f"{pitch.value()[0]}/(2*pi)"
        self.found["coordinates"][q] = {"unit": unit}
        mimic = element.one("mimic")
        follows = mimic is not None and self._mimic(q, mimic)
        stops, said = self._limit(element.one("limit"), unit, q, follows)
        about += said
        self.found["coordinates"][q] |= {"about": ", ".join(about)} if about else {}
        keys |= stops
        if not follows:
            effort = self.names.new(f"{'F' if unit == 'm' else 'tau'}_{q}")
            self.found["inputs"][effort] = {"value": 0, "unit": "N" if unit == "m" else "N*m"}
            keys["force" if unit == "m" else "torque"] = effort
        keys |= self._dynamics(element.one("dynamics"), "force" if unit == "m" else "torque")
        if kind in ONE_AXIS and (rotor := self._rotor(joint, element)):
            keys["armature"] = rotor
        return Moved(keys, at.p, q)

    def _rotor(self, joint: XmlElement, axis: XmlElement) -> Decimal:
        """Inertia ratio^2 J of the rotor behind a gear; for a joint without a motor it is reported as left out."""
        limit = axis.one("limit")
        effort = None if limit is None else limit.one("effort")
        if effort is not None and _finite(effort) == 0:
            return ZERO
        inertia, ratio = (joint.one(f"drake:{tag}") for tag in ("rotor_inertia", "gear_ratio"))
        turns = Decimal(1) if ratio is None else ratio.value()[0]
        return ZERO if inertia is None else computed(turns * turns * inertia.value()[0])

    def _axis(self, element: XmlElement, joint: XmlElement, at: Pose, child: str) -> list[Decimal]:
        """The axis in the child's axes."""
        xyz = element.one("xyz")
        axis: Any = decimals([0, 0, 1]) if xyz is None else xyz.value(3)
        if not any(axis):
            raise ModelError("an axis has no direction", element.where, "give three numbers, not all 0")
        frame = None if xyz is None else xyz.get("expressed_in")
        flag = element.one("use_parent_model_frame")
        own = self.flat.scope_of(joint)
        if flag is not None and flag.text in YES:
            frame = own.frame
        if frame is None and own.old and flag is None:
            frame = own.frame
        if frame is None:
            return in_file(at.R @ axis)
        R = self._pose(child).inverse().then(self._pose(frame)).R
        return in_file(R @ axis)

    def _limit(self, limit: XmlElement | None, unit: str, q: str, follows: bool) -> tuple[Entries, list[str]]:
        """(stops of a joint, remarks): rigid ones, or with the stiffness and damping that the file gives."""
        self.ranges[q] = Range()
        if limit is None:
            return {}, []
        found = {tag: limit.one(tag) for tag in ("lower", "upper", "effort", "velocity")}
        values = {tag: _finite(element) for tag, element in found.items() if element is not None}
        own = self.ranges[q] = Range(values.get("lower"), values.get("upper"))
        stops = {} if follows else own.limits()
        said = own.remark(unit) if not stops else []
        soft = {key: limit.one(tag) for tag, key in SOFT.items()} if stops else {}
        if soft and soft["stiffness"] is not None:
            stops["stop"] = {key: x.value()[0] for key, x in soft.items() if x is not None and x.value()[0]}
        force = "N" if unit == "m" else "N*m"
        for tag, of in (("effort", force), ("velocity", f"{unit}/s")):
            if (most := values.get(tag)) is not None and most >= 0:
                said.append(f"at most {most} {of}")
        return stops, said

    def _dynamics(self, dynamics: XmlElement | None, effort: str) -> Entries:
        """Dampers, springs and dry friction."""
        keys: Entries = {}
        if dynamics is None:
            return keys
        tags = {"spring_stiffness": "stiffness", "spring_reference": "rest", "damping": "damping"}
        for tag, key in tags.items():
            if (element := dynamics.one(tag)) is not None and (value := element.value()[0]):
                keys[key] = value
        if "stiffness" not in keys:
            keys.pop("rest", None)
        friction = next((child for child in dynamics.children if child.tag == "friction"), None)
        if friction is not None and (size := friction.value()[0]) >= 0:
            friction.seen = True
            keys |= {"friction": {effort: size}} if size else {}
        return keys

    def _mimic(self, q: str, mimic: XmlElement) -> bool:
        """Equation q = multiplier (other - reference) + offset; True if the other coordinate exists."""
        leader = mimic.attributes.get("joint", "")
        known = self.second if mimic.attributes.get("axis") == "axis2" else self.coordinate
        kind = self.joints[leader].get("type") if leader in known else None
        other = known.get(leader)
        if other is None or kind not in (*ONE_AXIS, *TWO_AXES):
            return False
        mimic.get("joint"), mimic.get("axis")
        tags = {tag: mimic.one(tag) for tag in ("multiplier", "offset", "reference")}
        factor, offset, reference = (Decimal(0) if x is None else x.value()[0] for x in tags.values())
        constant = offset - factor * reference
        same = ONE_AXIS.get(str(kind), "rad") == self.found["coordinates"][q]["unit"]
        self.follows[q] = Mimic(other, factor, constant)
        self.found["constraints"][self.bodies.new(f"mimic_{q}")] = {
            "kind": "equation",
            "gap": gap(q, [(-factor, other)], -constant, weighed=not same),
        }
        return True


def _finite(element: XmlElement) -> Decimal | None:
    """A limit; None where it is none."""
    if element.text.lstrip("+-").lower() in ("inf", "infinity"):
        return None
    value = element.value()[0]
    return value if abs(value) < ENDLESS else None
