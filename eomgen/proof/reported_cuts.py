"""Forces on bodies that were cut free -> checks: as they leave, in numbers, by another way than they were found.

sum of forces = 0,   sum of moments about the ground's origin = 0   of every body, its inertia force included
f = -m a_C, n = -dL/dt by differences along the motion;   loads as their fields declare them
what joins two bodies pushes both with opposite wrenches
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from functools import cached_property, partial
from typing import Any

import numpy as np

from eomgen.frozen import dataclass
from eomgen.mechanics.dynamics import EquationsOfMotion, System, exact_accelerations
from eomgen.proof.check import Check, Tally
from eomgen.proof.declared_loads import declared_pushes
from eomgen.proof.in_numbers import SECOND_STEP, InNumbers, way_through, with_inputs
from eomgen.symbolic.expression import Node
from eomgen.symbolic.numeric import fifty_digits, tolerances

HOW = "wrenches about the ground's origin from the numbers that leave; loads as declared, accelerations by differences"
INERTIA = "inertia"


@dataclass(frozen=True)
class ReportedForce:
    """A force, or a couple, as it leaves, ground axes.

    Args:
        body, name, kind: as reported.
        at: its place, 3 [m].
        force, couple: 3 each, one of them 0; None where it has no single value.
    """

    body: str
    name: str
    kind: str
    at: np.ndarray
    force: np.ndarray | None
    couple: np.ndarray | None

    @property
    def wrench(self) -> np.ndarray | None:
        """(moment about the ground's origin, force)."""
        if self.force is None or self.couple is None:
            return None
        return np.concatenate([self.couple + np.cross(self.at, self.force), self.force])


def cuts_reported(
    system: System, equations: EquationsOfMotion | None, numbers: Mapping[Node, float], pushes: Sequence[ReportedForce]
) -> Iterator[Check]:
    """Checks of the forces on all bodies at a state.

    Args:
        equations: of motion; None where nothing moves.
        numbers: t, q, u, the parameters and the unknowns of loads.
    """
    known = with_inputs(system, {x: fifty_digits().number(float(v)) for x, v in numbers.items()})
    proof = _Cut(system, known, equations, tuple(pushes))
    return iter((*proof.equilibrium(), *proof.opposites(), *proof.loads(), *proof.inertia()))


@dataclass(frozen=True)
class _Cut(InNumbers):
    """Reported forces at their state."""

    equations: EquationsOfMotion | None
    pushes: tuple[ReportedForce, ...]

    def _on(self, body: str, pushes: Iterable[ReportedForce] | None = None) -> list[ReportedForce]:
        return [push for push in (self.pushes if pushes is None else pushes) if push.body == body]

    @cached_property
    def size(self) -> float:
        """Size of the forces and of their moments."""
        wrenches = [abs(w).max() for push in self.pushes if (w := push.wrench) is not None]
        return max(wrenches, default=0.0) or 1.0

    def _apart(self, pushes: Iterable[ReportedForce], due: Any = 0.0) -> str:
        """Message if wrenches do not add up to one that is due; "" where they do, or one has no value."""
        wrenches = [push.wrench for push in pushes]
        known = [wrench for wrench in wrenches if wrench is not None]
        if len(known) < len(wrenches):
            return ""
        left = float(np.abs(np.sum(known, axis=0) - due).max()) if known else float(np.abs(due).max(initial=0.0))
        return "" if left <= tolerances.COMPUTED * self.size + tolerances.SOLVED else f"{left:.3g} is left over"

    def equilibrium(self) -> Iterator[Check]:
        tally = Tally("each body that is cut free is in equilibrium", HOW)
        for body in dict.fromkeys(push.body for push in self.pushes):
            tally.add(f"'{body}'", partial(self._apart, self._on(body)))
        return tally.checks()

    def opposites(self) -> Iterator[Check]:
        tally = Tally("action and reaction are opposite", HOW)
        joints = {link.name for link in self.motion.links if link.parent >= 0}
        names = {push.name: push for push in self.pushes}
        for name in names:
            owner = name.partition("(")[2].rstrip(")").partition(",")[0]
            mine = [push for push in self.pushes if push.name == name and push.kind != INERTIA]
            if owner in joints and {push.body for push in mine} > {owner}:
                tally.add(name, partial(self._apart, mine))
        return tally.checks()

    def loads(self) -> Iterator[Check]:
        tally = Tally("loads push as their fields declare", HOW)
        for name in self.system.scope.model.forces:
            mine = [push for push in self.pushes if name in push.name.split(" + ")]
            if any(" + " in push.name for push in mine) or self.system.scope.model.forces[name].placeless:
                continue
            tally.add(f"'{name}'", partial(self._load, name, mine))
        return tally.checks()

    def _load(self, name: str, mine: Sequence[ReportedForce]) -> str:
        due = declared_pushes(self.system, self.state, name)
        for body in dict.fromkeys((*due, *(push.body for push in mine))):
            moment, force = due.get(body, ((0, 0, 0), (0, 0, 0)))
            wrong = self._apart(self._on(body, mine), np.array([float(x) for x in (*moment, *force)]))
            if wrong:
                return f"on '{body}' {wrong}"
        return ""

    def inertia(self) -> Iterator[Check]:
        tally = Tally("inertia forces are those of the motion", HOW)
        if self.equations is not None:
            for link in self.motion.links:
                tally.add(f"'{link.name}'", partial(self._inertia, link.name))
        return tally.checks()

    def _inertia(self, body: str) -> str:
        """-m a_C and -dL/dt by differences of the mass centre's places and of L = R I w."""
        link, mass = self.motion.link(body), self.system.scope.mass_properties(body)
        own = (f"inertia({body})", f"inertia_couple({body})")
        mine = [push for push in self.pushes if push.name in own]
        place = link.pose.point(mass.com)
        R, w = link.pose.R, link.twist.w
        L = R @ (mass.I @ w)
        way = way_through(self.system, self._moving, SECOND_STEP, order=2)
        at, _, a = way.along(place)
        rates = way.rates(L)
        m = self.one(mass.m)
        force = -np.array([float(m * x) for x in a])
        moment = -np.array([float(x) for x in rates]) + np.cross([float(x) for x in at], force)
        flat = self.system.scope.model.space == "plane"
        due = np.concatenate([moment * ([0, 0, 1] if flat else [1, 1, 1]), force])
        return self._apart(mine, due)

    @cached_property
    def _moving(self) -> dict[Node, Any]:
        assert self.equations is not None
        a = exact_accelerations(self.equations, self.state)
        return {**self.state, **dict(zip(self.equations.symbols.a, a, strict=True))}
