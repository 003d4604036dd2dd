"""Model -> URDF, for what URDF can say: a tree of links on hinges, slides and free joints; the rest is listed.

A link's frame sits where its joint does, in the axes of its body, and its joint's origin is where that frame is when
every coordinate is 0; so import gives the same equations again. Names and limits come from a remark of the model,
as import writes it, where there is one: "joint a.b, from -1 to 2 rad, at most 5 N*m, at most 3 rad/s".
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import replace
from typing import Any
from xml.sax.saxutils import quoteattr

from eomgen import files
from eomgen.codegen import RightHandSide
from eomgen.documents import Document, Lines, plain_document
from eomgen.errors import DerivationError, visible
from eomgen.frozen import dataclass
from eomgen.mechanics.dynamics import System
from eomgen.mechanics.kinematics import GROUND, BodyLink
from eomgen.model import Model, ModelOrPath
from eomgen.pipeline import derive
from eomgen.proof import imported_otherwise, unsaid_otherwise
from eomgen.robots import UNLIMITED, LeftOut, LegalNames, remarked
from eomgen.symbolic.expression import (
    Matrix,
    Pose,
    Scalar,
    Vector,
    depends_on,
    gradient,
    substituted,
    symbols_of,
)
from eomgen.symbolic.numeric import FLOAT, evaluate, tolerances

STANDING = [0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0]  # p, R of the ground
G = 9.81  # of what reads URDF, downward along z [m/s^2]


@dataclass(frozen=True)
class Exported:
    """A robot's file.

    Args:
        text: the URDF.
        left_out: what of the model URDF cannot say.
    """

    text: str
    left_out: tuple[LeftOut, ...]


def urdf_of(model: ModelOrPath) -> Exported:
    """The URDF of a model.

    Raises:
        DerivationError: a joint that URDF does not have, a seat that moves, a joint variable that is no coordinate.
        MissingValues: parameters without values.
    """
    return _Writing(derive(model).system).exported()


class _Writing:
    """The links and joints of a system, in numbers."""

    def __init__(self, system: System) -> None:
        self.system = system
        p = RightHandSide.parameter_values(system.scope.model)
        self.known: dict[Any, Any] = dict(zip(system.symbols.parameters.values(), map(float, p), strict=True))
        self.known |= {system.symbols.t: 0.0}
        self.left: dict[str, list[str]] = {}
        model = system.scope.model
        self.remarks = {q: remarked(part.about) for q, part in model.coordinates.items()}
        self.link_names = _apart({name: remarked(body.about).get("name", name) for name, body in model.bodies.items()})
        self.joint_names = _apart({q: remark.get("name", q) for q, remark in self.remarks.items()})
        self.world = LegalNames(set(self.link_names.values())).new("world")
        self.joints = LegalNames(set(self.joint_names.values()))
        self.followed = self._followed()

    def exported(self) -> Exported:
        motion, model = self.system.motion, self.system.scope.model
        bases = [link for link in motion.links if link.parent == GROUND]
        joints = {link.name: self._joint(link) for link in motion.links}
        if len(bases) == 1 and self._stands(bases[0]):
            joints[bases[0].name] = []  # the base of a URDF is fixed
        world = [f"  <link name={quoteattr(self.world)}/>"] * any(joints[link.name] for link in bases)
        lines = [f"<robot name={quoteattr(visible(model.name))}>", *world]
        for link in motion.links:
            lines += [*self._link(link), *joints[link.name]]
        lines += self._transmissions()
        self._forces()
        self._values()
        text = "\n".join([*lines, "</robot>", ""])
        return Exported(
            text, tuple(LeftOut(what, tuple(where), "URDF cannot say it") for what, where in self.left.items())
        )

    def numbers(self, scalars: Sequence[Scalar], where: str) -> list[float]:
        """Constants.

        Raises:
            DerivationError: they move.
        """
        if any(symbol not in self.known for symbol in symbols_of(scalars)):
            raise DerivationError(
                "URDF has no seat, mass centre or axis that moves", where, "let a joint carry the motion"
            )
        return [float(x) for x in evaluate(tuple(scalars), self.known, FLOAT)]

    def _link(self, link: BodyLink) -> list[str]:
        mass = self.system.scope.mass_properties(link.name)
        where = f"bodies.{link.name}"
        if self.system.scope.mass_rates(link.name) is not None:
            raise DerivationError(
                f"URDF has no mass that changes, as that of body '{link.name}' does", where, "give it a constant mass"
            )
        m, *com = self.numbers((mass.m, *(mass.com - link.point)), where)
        tensor = self.numbers([x for row in mass.I for x in row], where)
        name = f"  <link name={quoteattr(self.link_names[link.name])}"
        if not m and not any(tensor):
            return [f"{name}/>"]
        keys = zip(("ixx", "ixy", "ixz", "iyy", "iyz", "izz"), (0, 1, 2, 4, 5, 8), strict=True)
        inertia = " ".join(f'{key}="{tensor[k]!r}"' for key, k in keys)
        return [
            f"{name}>",
            f'    <inertial><origin xyz="{_words(com)}"/><mass value="{m!r}"/><inertia {inertia}/></inertial>',
            "  </link>",
        ]

    def _joint(self, link: BodyLink) -> list[str]:
        where = f"bodies.{link.name}.joint"
        motion, symbols = self.system.motion, self.system.symbols
        parent = None if link.parent == GROUND else motion.links[link.parent]
        own = [x for x in symbols.q if x in symbols_of(link.s)]
        kind, axis = self._shape(link, own, where)
        place, inner = link.before, ""
        if kind != "floating":
            relative = (*(x for row in link.relative.R for x in row), *link.relative.p)
            relative = substituted(relative, dict.fromkeys(symbols.q, 0))
            R = Matrix.of(relative[3 * i : 3 * i + 3] for i in range(3))
            place = place.then(Pose(R, Vector((relative[9], relative[10], relative[11]))))
        if axis:
            limits = {key: x for key, x in self.remarks[own[0].name].items() if key != "name"}
            limits |= self._stops(link, own[0])
            kind = "revolute" if kind == "continuous" and "upper" in limits else kind
            inner = f'<axis xyz="{_words(axis)}"/>{_limit(kind, limits)}{self._effort(link)}{self._mimic(own[0].name)}'
        shift = Vector.ZERO if parent is None else parent.point
        at = self.numbers(place.p - shift, where)
        R_numbers = self.numbers([x for row in place.R for x in row], where)
        name = self.joint_names[own[0].name] if len(own) == 1 else self.joints.new(f"{link.name}_joint")
        above = self.world if parent is None else self.link_names[parent.name]
        return [
            f'  <joint name={quoteattr(name)} type="{kind}"><parent link={quoteattr(above)}/>'
            f"<child link={quoteattr(self.link_names[link.name])}/>"
            f'<origin xyz="{_words(at)}" rpy="{_words(_angles(R_numbers))}"/>{inner}</joint>'
        ]

    def _stands(self, link: BodyLink) -> bool:
        """True if a link of the ground is fixed to it with the ground's own origin and axes."""
        R, p = (place := link.before.then(link.relative)).R, place.p
        held = all(symbol in self.known for symbol in symbols_of((*link.s, *p, *(x for row in R for x in row))))
        return held and self.numbers((*(p - Vector((0, 0, 0))), *(x for row in R for x in row)), link.name) == STANDING

    def _shape(self, link: BodyLink, own: list[Any], where: str) -> tuple[str, list[float]]:
        """(type, axis in the child's axes along which the coordinate grows).

        Raises:
            DerivationError: URDF has no such joint.
        """
        if not own and not any(depends_on(x, [self.system.symbols.t]) for x in link.s):
            return "fixed", []
        if len(link.S) == 6 and not any(depends_on(x, self.system.symbols.q) for x in link.before.p):
            return "floating", []
        if len(link.S) != 1 or len(own) != 1:
            raise DerivationError(
                "URDF has hinges, slides and free joints of a coordinate each", where, "take other joints"
            )
        (factor,) = self.numbers(gradient(link.s[0], (own[0],)), where)
        uses = [each.name for each in self.system.motion.links if depends_on(each.s, own[:1])]
        if abs(abs(factor) - 1) > tolerances.ROUNDING:
            what = f"URDF has no joint that goes {factor:g} times its coordinate: '{own[0].name}'"
            raise DerivationError(what, where, "give it a coordinate of its own, and an `equation` between the two")
        if len(uses) > 1:
            raise DerivationError(f"URDF has one joint for a coordinate: '{own[0].name}'", where, "give each its own")
        (w, v) = link.S[0]
        turning, sliding = self.numbers(w, where), self.numbers(v, where)
        if any(turning) and any(sliding):
            raise DerivationError("URDF has no screw", where, "take other joints")
        axis = turning if any(turning) else sliding
        return ("continuous" if any(turning) else "prismatic"), [factor * x for x in axis]

    def _stops(self, link: BodyLink, q: Any) -> dict[str, str]:
        """The limits of its coordinate, s = a + b q; restitution and stops that yield are left out."""
        joint: Any = link.joint
        given = getattr(joint, "limits", None)
        if given is None:
            return {}
        for key in ("restitution", "stop"):
            if getattr(joint, key) is not None:
                self.left.setdefault(key, []).append(link.name)
        made: dict[str, Any] = {k: x for k, x in self.system.scope.model.constraints.items() if x.about_joint}
        own = {name: stop for name, stop in made.items() if stop.body == link.name}
        ends = {stop.upper: stop.bound for stop in own.values()}
        ends = ends or {upper: x for upper, x in ((False, given.low), (True, given.high)) if x is not None}
        self.left.setdefault("", []).extend(own)
        scalars = (substituted(link.s, {q: 0})[0], gradient(link.s[0], (q,))[0])
        a, b, *bounds = self.numbers(
            (*scalars, *map(self.system.scope.value, ends.values())), f"bodies.{link.name}.joint"
        )
        values = {upper != (b < 0): repr((x - a) / b + 0.0) for upper, x in zip(ends, bounds, strict=True)}
        return {("upper" if upper else "lower"): x for upper, x in values.items()}

    def _effort(self, link: BodyLink) -> str:
        """Its damper and its dry friction of constant size; springs, rotors and other friction are left out."""
        (effort,) = (link.joint.efforts() or (None,))[:1]
        if effort is None:
            return ""
        for key in ("stiffness", "armature"):
            if getattr(effort, key) is not None:
                self.left.setdefault(key, []).append(link.name)
        found = {} if effort.damping is None else {"damping": effort.damping}
        for _, _, law in link.joint.frictions[:1]:
            if law.size is None or law.smooth is not None or law.static is not None:
                self.left.setdefault("friction", []).append(link.name)
            else:
                found["friction"] = law.size
        value = self.system.scope.value
        numbers = self.numbers(tuple(map(value, found.values())), f"bodies.{link.name}.joint")
        said = " ".join(f'{key}="{x!r}"' for key, x in zip(found, numbers, strict=True))
        return f"<dynamics {said}/>" if found else ""

    def _followed(self) -> dict[str, tuple[str, str]]:
        """{coordinate that a constraint couples to another one: (the constraint, its <mimic> element)}.

        Of the two coordinates the later one is the follower, or the one that no motor drives.
        """
        found: dict[str, tuple[str, str]] = {}
        driven = {name for name, _ in self._driven()}
        for row in self.system.constraints.closing:
            if row.gap is None:
                continue
            own = [x for x in self.system.symbols.q if depends_on(row.gap, (x,))]
            slopes = gradient(row.gap, own) if len(own) == 2 else ()
            if not slopes or any(symbol not in self.known for symbol in symbols_of(slopes)):
                continue
            *factors, c = self.numbers((*slopes, *substituted((row.gap,), dict.fromkeys(own, 0))), "constraints")
            order = sorted((1, 0), key=lambda k: own[k].name in driven)
            k = next((k for k in order if factors[k] and own[k].name not in found), None)
            if k is not None:
                a, b, other = factors[k], factors[1 - k], quoteattr(self.joint_names[own[1 - k].name])
                how = f'<mimic joint={other} multiplier="{-b / a!r}" offset="{-c / a!r}"/>'
                found[own[k].name] = row.constraint, how
        return found

    def _mimic(self, q: str) -> str:
        """The <mimic> element of a coordinate; "" if it follows no other."""
        constraint, how = self.followed.get(q, ("", ""))
        if constraint:
            self.left.setdefault("", []).append(constraint)
        return how

    def _driven(self) -> list[tuple[str, str]]:
        """(coordinate, body) of each joint that an input alone drives; another drive has the coordinate ""."""
        found, scope = [], self.system.scope
        for link in self.system.motion.links:
            efforts = () if link.joint is None else link.joint.efforts()
            drives = [scope.value(each.drive) for each in efforts if each is not None and each.drive is not None]
            own = [x for x in self.system.symbols.q if depends_on(link.s, (x,))]
            alone = len(own) == len(drives) == 1 and drives[0] in self.system.symbols.inputs.values()
            found += [(own[0].name if alone else "", link.name)] * bool(drives)
        return found

    def _transmissions(self) -> list[str]:
        """A motor for each joint that an input drives; another drive is left out."""
        driven = self._driven()
        if others := [body for q, body in driven if not q]:
            self.left["drives that are no input alone"] = others
        names = [quoteattr(self.joint_names[q]) for q, _ in driven if q]
        return [f"  <transmission name={name}><joint name={name}/></transmission>" for name in names]

    def _values(self) -> None:
        """Lists the inputs' values, start values and given motions, which URDF cannot express."""
        model = self.system.scope.model
        acting = [name for name, part in model.inputs.items() if _is_given(part.value)]
        starts = [name for name, part in model.coordinates.items() if _is_given(part.start) or _is_given(part.speed)]
        given = [name for name, part in model.coordinates.items() if part.driven]
        for what, names in (("values of inputs", acting), ("start values", starts), ("given motions", given)):
            if names:
                self.left.setdefault(what, []).extend(names)

    def _forces(self) -> None:
        """Lists the forces and constraints that URDF cannot express."""
        said = set(self.left.pop("", []))
        constraints = [name for name in self.system.scope.model.constraints if name not in said]
        fields = self.numbers(self.system.loads.fields, "forces")
        applied = self.system.loads.applied
        weight = [x.name for x in applied if x.is_field]
        usual = fields[:2] == [0.0, 0.0] and abs(fields[2] + G) < tolerances.ROUNDING
        forces = [name for name in self.system.scope.model.forces if name not in weight or not usual]
        for what, names in (("forces", forces), ("constraints", constraints)):
            if names:
                self.left.setdefault(what, []).extend(names)


def _apart(wanted: dict[str, str]) -> dict[str, str]:
    """The names that are wanted, each only where no other thing has or wants it."""
    taken = [*wanted, *(name for key, name in wanted.items() if name != key)]
    return {key: name if taken.count(name) == 1 else key for key, name in wanted.items()}


def _limit(kind: str, limits: dict[str, str]) -> str:
    """The limits of a joint; a slide or hinge with ends must have all four."""
    if kind == "continuous" and not limits:
        return ""
    ends = {} if kind == "continuous" else {"lower": f"-{UNLIMITED}", "upper": UNLIMITED}
    said = {**ends, "effort": UNLIMITED, "velocity": UNLIMITED, **limits}
    return f"<limit {' '.join(f'{key}={quoteattr(value)}' for key, value in said.items())}/>"


def _words(numbers: Sequence[float]) -> str:
    return " ".join(repr(x + 0.0) for x in numbers)


def _is_given(value: Any) -> bool:
    return value is not None and value.text not in ("0", "0.0")


def _angles(R: Sequence[float]) -> list[float]:
    """Roll, pitch and yaw of R = Rz Ry Rx, given by rows.

    Near a pitch of 90 degrees roll and yaw turn about one axis: yaw is that of R Rx^T, so it makes up for the roll.
    """
    pitch, across = math.atan2(-R[6], math.hypot(R[0], R[3])), math.hypot(R[7], R[8])
    roll = math.atan2(R[7], R[8]) if across > tolerances.ROUNDING else 0.0
    s, c = math.sin(roll), math.cos(roll)
    return [roll, pitch, math.atan2(s * R[2] - c * R[1], c * R[4] - s * R[5])]


# -------- document -------------------------------------------------------------------------------------------
# eomgen export: a model as a robot's file of other programs.


def export_document(model: Model, *, output: str) -> Document:
    """The URDF, written, and read again by another program; with the features that URDF lacks.

    Raises:
        DerivationError: a joint that URDF does not have.
        WriteFailed: it cannot be written.
    """
    found = urdf_of(model)
    files.write(output, found.text)
    left_out = [each.as_dict() for each in found.left_out]
    document = plain_document(model, lambda: {"file": output, "left_out": left_out}, Lines((output,)))
    left = {each.what: each.where for each in found.left_out}
    wrong = imported_otherwise(found.text, model) or unsaid_otherwise(found.text, model, left)
    return replace(document, failed=wrong, notes=tuple(f"left out: {each}" for each in found.left_out))
