"""What the readers of robot files share: legal names, joints in a row, what was left out; tables of a model file."""

from __future__ import annotations

import re
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import field
from decimal import Decimal
from typing import Any

from eomgen.records import dataclass
from eomgen.robots.numbers import ORIGIN, ZERO, Nine, Triple, computed
from eomgen.robots.toml_text import decimal_text
from eomgen.symbolic.expression.spatial import IDENTITY, apply, plus
from eomgen.symbolic.numeric.work import check_patience

RESERVED = ("t", "pi", "nan", "inf", "infinity", "ground")
ILLEGAL = re.compile(r"[^A-Za-z0-9_]+")
UNLIMITED = "1e9"  # what an export writes where a format wants a limit and there is none
_FIGURE = r"([-+]?[0-9.]+(?:[eE][-+]?[0-9]+)?)"
REMARKS = {  # what an import tells in a coordinate's or a body's remark, and an export reads there
    "name": r"^(?:joint|link) (.+?)(?=, from |, at most |$)",
    "lower": rf"\bfrom {_FIGURE} to \S+ (?:rad|m)\b",
    "upper": rf"\bfrom \S+ to {_FIGURE} (?:rad|m)\b",
    "effort": rf"\bat most {_FIGURE} N(?:\*m)?(?=,|$)",
    "velocity": rf"\bat most {_FIGURE} (?:rad|m)/s",
}
Entries = dict[str, Any]
NO_COUNTERPART = "eomgen has no counterpart"
SLIDING = 'torque or force of the joint, with "- f*tanh(rate/small)": it slides, and creeps where it would stick'
IN_SPACE = "a [forces] `couple` in axes of the body, by its quaternion and `omega`"
LAW = "a formula with max and min in the motor's force"
NEAREST = {  # what of a model comes nearest to a thing that changes the motion and has no counterpart
    "collision": "`rolling` or `support` in [constraints]; a push by max(0, depth) in [forces]",
    "geoms that touch": "`rolling` or `support` in [constraints]; a push by max(0, depth) in [forces]",
    "pairs of geoms that touch": "`rolling` or `support` in [constraints]; a push by max(0, depth) in [forces]",
    "friction": SLIDING,
    "frictionloss": SLIDING,
    "motion of a mocap body": "a `motion` of coordinates of a joint",
    "springs and dampers that are not linear": "the law as the joint's torque or force",
    "yielding springs of free and ball joints": IN_SPACE,
    "springs that yield": "the law as the joint's torque or force",
    "friction of free and ball joints": IN_SPACE,
    "limits of free and ball joints": IN_SPACE,
    "dampers that are not linear of free and ball joints": IN_SPACE,
    "limits of motors": LAW,
    "limits of tendons": "a `potential` of max(0, length - limit)^2",
    "limits of joints": "a `potential` of max(0, q - limit)^2, or a one-sided tie",
    "limit": "a `potential` of max(0, q - limit)^2, or a one-sided tie",
    "filters of motors": "an activation that the caller computes; a coordinate with its own rate",
    "delays of motors": "an input that comes later",
    "inputs of motors": "none is needed",
    "motors that are no linear laws": "the law as a force in [forces], with an input of [inputs]",
    "motors by plugins": "the law as a force in [forces], with an input of [inputs]",
    "tendons through places": "`spring`, `link`, `string` between points",
    "fluid": "a `force` by the velocities of points, a `kinetic` energy of added mass",
    "softness of equalities": "a `spring` and a `damper` in place of the tie",
    "welds that cannot close": "a `clamp` from a start at which the bodies stand as they are welded",
    "start where ties gape": "--start; a `spring` and a `damper` in place of the tie",
    "motors that are switched off": "none is needed",
    "motors on other things than joints, tendons between two places, and sites": "a `force` or `couple` in [forces]",
    "motors on the ground": "none is needed",
    "armature of tendons between places": "a `kinetic` energy by the coordinates in [forces]",
    "friction, bent springs and dampers of tendons": "a `between` law of r and r' in [forces]",
    "equalities that are switched off": "none is needed",
    "equalities of other kinds": "an `equation` between coordinates and places in [constraints]",
    "flexible bodies": "bodies on joints with stiffness",
    "plugin": "the law as a force in [forces]",
    "plugins": "the law as a force in [forces]",
    "model": "eomgen import FILE --model NAME",
    "include": "put the file beside this one, and import again",
    "joint": "both models within one <model>",
    "fluid_added_mass": "a `kinetic` energy in [forces]",
    "drake:rotor_inertia": "the `armature` of a joint, ratio^2*J",
    "joint of <mimic>": "an `equation` in [constraints]",
    "drake:joint": "a joint in the body's table",
    "mimic": "an `equation` in [constraints]",
    "transmission": "the joint's `armature` and input",
}


@dataclass(frozen=True)
class LeftOut:
    """Things of one sort in a file that a model has no counterpart for.

    Args:
        what: their sort: "collision".
        where: each of them.
        why: why there is none, or how a model says it.
        nearest: what of a model comes nearest to it; None where no motion depends on it.
    """

    what: str
    where: tuple[str, ...]
    why: str
    nearest: str | None = None

    def __str__(self) -> str:
        listed = ", ".join(dict.fromkeys(self.where))
        told = f"{self.what} ({self.why}): {listed}" if listed else f"{self.what} ({self.why})"
        return f"{told}; nearest: {self.nearest}" if self.nearest else told

    def as_dict(self) -> dict[str, Any]:
        return {"what": self.what, "where": list(self.where), "why": self.why, "nearest": self.nearest}


def told_left(what: str, where: Iterable[str], why: str = NO_COUNTERPART) -> LeftOut:
    """A thing of a robot's file that is left out, with what comes nearest to it."""
    return LeftOut(what, tuple(where), why, NEAREST.get(what))


@dataclass(frozen=True)
class Imported:
    """A robot file as the tables of a model file.

    Args:
        tables: what a TOML reader would give.
        left_out: what has no counterpart.
    """

    tables: Entries
    left_out: tuple[LeftOut, ...] = ()


@dataclass
class LegalNames:
    """Legal names, each given once, like those that the file uses."""

    given: set[str] = field(default_factory=lambda: set(RESERVED))

    def new(self, wanted: str, otherwise: str = "x") -> str:
        """The name nearest to the one wanted that is legal and free."""
        plain = ILLEGAL.sub("_", wanted).strip("_") or otherwise
        if not plain[0].isalpha():
            plain = f"{otherwise}_{plain}"
        name, k = plain, 1
        while name in self.given:
            k += 1
            name = f"{plain}_{k}"
        self.given.add(name)
        return name


@dataclass(frozen=True)
class Seat:
    """Where something hangs: on a body, at a place and in axes of it.

    Args:
        turns: the rotation R as turns of a model file.
    """

    on: str | None
    at: Triple = ORIGIN
    R: Nine = IDENTITY
    turns: Sequence[Entries] = ()

    def fields(self, beyond: Triple = ORIGIN) -> Entries:
        """The keys of a joint there, `beyond` further on in the turned axes."""
        at = plus(self.at, apply(self.R, beyond)) if any(beyond) else self.at
        found: Entries = {} if self.on is None else {"on": self.on}
        if any(at):
            found["at"] = in_file(at)
        if self.turns:
            found["turned"] = self.turns[0] if len(self.turns) == 1 else list(self.turns)
        return found


@dataclass(frozen=True)
class Moved:
    """One joint: its keys beside those of its seat, and the point of the body at which it sits, body axes."""

    keys: Entries
    pivot: Triple = ORIGIN
    name: str = ""


def hung(name: str, body: Entries, seat: Seat, joints: Sequence[Moved], names: LegalNames) -> dict[str, Entries]:
    """A body on its joints, one after the other; between them frames without mass.

    Each but the first sits at its pivot in the axes of the frame before, which are the body's own where it is at rest.
    """
    check_patience()
    if not joints:
        return {name: {**body, "joint": {"kind": "fixed", **seat.fields()}}}
    found: dict[str, Entries] = {}
    for k, joint in enumerate(joints):
        last = k == len(joints) - 1
        own: Entries = dict(body) if last else {"about": f"between the joints of {name}"}
        where = seat.fields(joint.pivot)
        if any(joint.pivot):
            pivot = "pivot" if last and "pivot" not in own.get("points", {}) else "joint"
            own["points"] = {**own.get("points", {}), pivot: in_file(joint.pivot)}
            where["point"] = pivot
        own["joint"] = {"kind": joint.keys["kind"], **where, **joint.keys}
        frame = name if last else names.new(f"{name}_{joint.name}")
        found[frame] = own
        seat = Seat(frame)
    return found


def remarked(about: str | None) -> dict[str, str]:
    """What an import has told in a remark: another program's name, limits."""
    found = {key: re.search(pattern, about or "") for key, pattern in REMARKS.items()}
    return {key: match[1] for key, match in found.items() if match}


def in_file(v: Iterable[Any]) -> list[Decimal]:
    """A vector as it stands in a model file."""
    return [computed(x) for x in v]


def signed_sum(terms: Iterable[tuple[Decimal, str]], constant: Decimal = ZERO, *, weighed: bool = False) -> str:
    """The sum of numbers times names, and a constant, as a person writes it; 1*name where the numbers have a unit."""
    pieces: list[str] = []
    for factor, name in (*terms, (constant, "")):
        if factor == 0 and (name or pieces):
            continue
        size = decimal_text(abs(factor))
        shown = name if name and abs(factor) == 1 and not weighed else f"{size}*{name}" if name else size
        sign = "-" if factor < 0 else "+"
        pieces.append(f"{sign} {shown}" if pieces else f"-{shown}" if sign == "-" else shown)
    return " ".join(pieces) or "0"


def gap(one: str, terms: Iterable[tuple[Decimal, str]], constant: Decimal = ZERO, *, weighed: bool = False) -> str:
    """one + terms + constant, which a tie holds at 0; `weighed` where not all have one unit: q - 1*s for 1 rad/m."""
    rest = signed_sum(terms, constant, weighed=weighed)
    return one if rest == "0" else f"{one} - {rest[1:]}" if rest[0] == "-" else f"{one} + {rest}"


def without_empty(tables: Mapping[str, Any]) -> Entries:
    """The tables that hold something."""
    return {key: value for key, value in tables.items() if value not in ({}, None, [])}
