"""Motion -> Locks: where three angles do not say how a body turns (gimbal lock).

The columns of S of three angles have the determinant sin(b) (zxz and its like) or cos(b) (xyz and its like), b the
second angle. Where it vanishes two of the axes are one, and the rates of the angles are not determined.
"""

from __future__ import annotations

from eomgen.mechanics.bodies.kinematics import Motion
from eomgen.records import dataclass
from eomgen.symbolic.expression.derivative import depends_on
from eomgen.symbolic.expression.functions import cos, sin
from eomgen.symbolic.expression.graph import Scalar


@dataclass(frozen=True)
class Lock:
    """Where the angles of one body are locked: the determinant of their axes is zero."""

    body: str
    determinant: Scalar

    def __str__(self) -> str:
        return f"the three angles of '{self.body}' do not determine how it turns"


def locks_of(motion: Motion) -> tuple[Lock, ...]:
    """Of each body that turns by three angles, one of them at least free to change, where they lock."""
    found = []
    for link in motion.links:
        sequence = getattr(link.joint, "orientation", None)
        if sequence is None or sequence == "quaternion":
            continue
        angles = link.s[-3:]
        if any(depends_on(rate, motion.scope.symbols.u) for rate in link.s_rate[-3:]):
            found.append(Lock(link.name, sin(angles[1]) if sequence[0] == sequence[2] else cos(angles[1])))
    return tuple(found)
