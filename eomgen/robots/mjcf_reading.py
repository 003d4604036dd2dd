"""A compiled model of MuJoCo, and what is made of it: what the readers of bodies and of what acts on them share."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import field
from decimal import Decimal
from typing import Any

from eomgen.model.joints.orientation import rotation_of
from eomgen.records import dataclass
from eomgen.robots.drawn_up import (
    Entries,
    LegalNames,
    in_file,
)
from eomgen.robots.numbers import (
    ZERO,
    Nine,
    decimal_of_double,
    turn_of,
)
from eomgen.symbolic.expression.spatial import IDENTITY

FREE, BALL, SLIDE, HINGE = range(4)  # the numbers of MuJoCo: of joints,
JOINT_WRAP = 1  # of what a tendon is of


@dataclass
class CompiledRobot:
    """A compiled model of MuJoCo, and what is made of it."""

    m: Any
    title: str
    names: LegalNames = field(default_factory=LegalNames)
    bodies: LegalNames = field(default_factory=LegalNames)
    found: Entries = field(default_factory=dict)
    left: dict[tuple[str, str], list[str]] = field(default_factory=dict)
    forces: LegalNames = field(default_factory=lambda: LegalNames({"weight"}))
    body: dict[int, str | None] = field(default_factory=dict)
    joint: dict[int, str] = field(default_factory=dict)
    sites: dict[int, str] = field(default_factory=dict)
    drives: dict[int, list[str]] = field(default_factory=dict)
    rotors: dict[int, Decimal] = field(default_factory=dict)
    points: dict[int, Entries] = field(default_factory=dict)

    def leave(self, what: str, where: Iterable[str], why: str = "eomgen has no counterpart") -> None:
        if where := list(where):
            self.left.setdefault((what, why), []).extend(where)

    def point(self, k: int, wanted: str, place: Iterable[float]) -> str:
        """A point of a body (0: of the ground), its whole name."""
        names = LegalNames({"origin", "center", "joint", "pivot", *self.points.get(k, {})})
        own = names.new(wanted, "point")
        self.points.setdefault(k, {})[own] = in_file(decimal_of_double(x) for x in place)
        return own if k == 0 else f"{self.body[k]}.{own}"

    def push(self, name: str, q: str, value: str) -> None:
        """A generalized force along a coordinate."""
        law = {"kind": "generalized", "coordinate": q, "value": value}
        self.found["forces"][self.forces.new(name, "push")] = law

    def length(self, t: int) -> list[tuple[Decimal, str]] | None:
        """The length of a tendon that is a sum of joints'; None of one through places."""
        m = self.m
        wraps = range(m.tendon_adr[t], m.tendon_adr[t] + m.tendon_num[t])
        if any(m.wrap_type[i] != JOINT_WRAP for i in wraps):
            return None
        return [(decimal_of_double(m.wrap_prm[i]), self.joint[int(m.wrap_objid[i])]) for i in wraps]


def turn_by(quaternion: Any) -> tuple[Nine, list[Entries]]:
    """A quaternion as a rotation and as turns of a model file."""
    e = [Decimal(float(x)) for x in quaternion]
    length = sum((x * x for x in e), ZERO).sqrt()
    unit = tuple(x / length for x in e)
    turns = turn_of(unit)
    return (rotation_of("quaternion", unit) if turns else IDENTITY), turns
