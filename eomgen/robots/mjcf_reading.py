"""A compiled model of MuJoCo, and what is made of it: what the readers of bodies and of what acts on them share."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import field
from decimal import Decimal
from typing import Any

import numpy as np

from eomgen.records import dataclass
from eomgen.robots.drawn_up import (
    NO_COUNTERPART,
    Entries,
    LegalNames,
    in_file,
    signed_sum,
)
from eomgen.robots.numbers import (
    ZERO,
    Nine,
    decimal_of_double,
    turn_of,
    turned_by,
)
from eomgen.symbolic.expression.spatial import IDENTITY

FREE, BALL, SLIDE, HINGE = range(4)  # the numbers of MuJoCo: of joints,
JOINT_WRAP, SITE_WRAP = 1, 3  # of what a tendon is of


@dataclass
class CompiledRobot:
    """A compiled model of MuJoCo, and what is made of it.

    Args:
        rotors, dampers: what motors add to joints and tendons, by ("joint" or "tendon", number).
        in_space: motors on free and ball joints, with their inputs.
        omega: the rates of free and ball joints: of places, about the axes of the body.
        start: the positions at which the model starts.
    """

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
    rotors: dict[tuple[str, int], Decimal] = field(default_factory=dict)
    dampers: dict[tuple[str, int], Decimal] = field(default_factory=dict)
    omega: dict[int, list[str]] = field(default_factory=dict)
    in_space: dict[int, str] = field(default_factory=dict)
    start: Any = None
    points: dict[int, Entries] = field(default_factory=dict)

    def leave(self, what: str, where: Iterable[str], why: str = NO_COUNTERPART) -> None:
        if where := list(where):
            self.left.setdefault((what, why), []).extend(where)

    def point(self, k: int, wanted: str, place: Iterable[float]) -> str:
        """A point of a body (0: of the ground), its whole name."""
        names = LegalNames({"origin", "center", "joint", "pivot", *self.points.get(k, {})})
        own = names.new(wanted, "point")
        self.points.setdefault(k, {})[own] = in_file(decimal_of_double(x) for x in place)
        return own if k == 0 else f"{self.body[k]}.{own}"

    def by_plugin(self, k: int) -> bool:
        """True if the law of a motor is code of a plugin."""
        return any(x >= 0 for x in self.numbers(["actuator_plugin"], k))

    def added(self, of: str, k: int, own: Any, motors: dict[tuple[str, int], Decimal]) -> Decimal:
        """What a joint or tendon has itself, and what its motors add."""
        return decimal_of_double(own) + motors.get((of, k), ZERO)

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

    def ends(self, t: int) -> list[str]:
        """The two places of a tendon that is straight between them; [] of another one."""
        at = range(self.m.tendon_adr[t], self.m.tendon_adr[t] + self.m.tendon_num[t])
        straight = len(at) == 2 and all(self.m.wrap_type[k] == SITE_WRAP for k in at)
        return [self.sites[int(self.m.wrap_objid[k])] for k in at] if straight else []

    def units(self, coordinates: Iterable[str]) -> set[str]:
        """What they count, once each."""
        return {self.found["coordinates"][q]["unit"] for q in coordinates}

    def sum_of(self, length: list[tuple[Decimal, str]], constant: Decimal = ZERO, *, rate: bool = False) -> str:
        """A length that is a sum of joints', or its rate."""
        terms = [(factor, f"{q}'" if rate else q) for factor, q in length]
        return signed_sum(terms, constant, weighed=len(self.units(q for _, q in length)) > 1)

    def numbers(self, fields: Iterable[str], k: int | slice) -> list[float]:
        """What fields of the compiled model say of its k-th thing; nothing of those that an older MuJoCo lacks."""
        given = (getattr(self.m, field, None) for field in fields)
        return [float(x) for values in given if values is not None for x in np.ravel(values[k])]


def turn_by(quaternion: Any) -> tuple[Nine, list[Entries]]:
    """A quaternion as a rotation and as turns of a model file."""
    e = [Decimal(float(x)) for x in quaternion]
    length = sum((x * x for x in e), ZERO).sqrt()
    turns = turn_of([x / length for x in e])
    return (turned_by(e) if turns else IDENTITY), turns
