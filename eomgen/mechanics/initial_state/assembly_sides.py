"""System, a place -> on which side of the line between their own hinges two links of the plane are pinned together.

The pin R of two links that turn about P and Q lies to the left or to the right of the line from P to Q. That tells the
two ways in which such a pair closes (open and crossed, elbow up and down). In line, the pair is in a dead centre.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from eomgen.mechanics.bodies.kinematics import BodyLink
from eomgen.mechanics.equations.system import System
from eomgen.model.forces.load import PointForce
from eomgen.records import dataclass
from eomgen.symbolic.expression.graph import Node, Scalar, is_zero
from eomgen.symbolic.numeric.evaluation import FLOAT, evaluate
from eomgen.symbolic.numeric.tolerances import COMPUTED


@dataclass(frozen=True)
class AssemblySide:
    """Where a pin lies.

    Args:
        tie: the pin.
        first, second: the bodies whose hinges P and Q are.
        left: whether R is to the left of the way from P to Q.
    """

    tie: str
    first: str
    second: str
    left: bool


def assembly_sides(system: System, state: Mapping[Node, Any]) -> tuple[AssemblySide, ...]:
    """Of each tie that pins two turning bodies of a plane system together; () in space."""
    if system.scope.model.space != "plane":
        return ()
    found: dict[str, AssemblySide] = {}
    for row in system.ties.rows:
        pushes = [push for push in row.pushes if isinstance(push, PointForce)]
        links = _joined(system, pushes)
        if row.identical or row.tie in found or len(links) != 2 or not all(map(_turns, links)):
            continue
        left = _is_left(system, state, links, pushes)
        found |= {} if left is None else {row.tie: AssemblySide(row.tie, links[0].name, links[1].name, left)}
    return tuple(found.values())


def _joined(system: System, pushes: list[PointForce]) -> list[BodyLink]:
    """The bodies that a row pushes, the ground left out."""
    names = dict.fromkeys(push.place[0] for push in pushes)
    return [system.motion.link(name) for name in names if name is not None]


def _turns(link: BodyLink) -> bool:
    return len(link.S) == 1 and not is_zero(link.S[0][0][2])


def _is_left(system: System, state: Mapping[Node, Any], links: list[BodyLink], pushes: list[PointForce]) -> bool | None:
    """Whether R is on the left; None in line, and where the bodies are not pinned at one point."""
    ends = [link.pose.point(push.place[1]) for link in links for push in pushes if push.place[0] == link.name]
    hinges = [link.pose.point(link.point) for link in links]
    flat: tuple[Scalar, ...] = tuple(x for point in (*hinges, *ends) for x in point[:2])
    numbers = [float(x) for x in evaluate(flat, state, FLOAT)]
    P, Q, R, *others = [complex(*numbers[k : k + 2]) for k in range(0, len(numbers), 2)]
    area = ((Q - P).conjugate() * (R - P)).imag
    size = max(abs(Q - P), abs(R - P)) ** 2
    if any(abs(other - R) ** 2 > COMPUTED * size for other in others):
        return None
    return None if abs(area) <= COMPUTED * size else area > 0
