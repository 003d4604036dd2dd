"""What a joint does, as it is declared: moves one after another, each in the axes that those before left.

Fields and names alone, no formulas. Proofs look at them.
"""

from typing import Any

from eomgen.records import dataclass


@dataclass(frozen=True)
class SlideAlong:
    """A way [m] along an axis that need not have unit length."""

    axis: Any
    way: Any


@dataclass(frozen=True)
class TurnAbout:
    """A turn by an angle [rad] about an axis that need not have unit length; None: z."""

    axis: Any
    angle: Any


@dataclass(frozen=True)
class QuaternionTurn:
    """A turn by a quaternion of norm 1, scalar first."""

    quaternion: Any


@dataclass(frozen=True)
class WayAlongPieces:
    """A way along lines and arcs, end to end, the first and the last of which go on; the axes do not turn.

    Args:
        way: from the beginning of the first piece [m].
        heading: of the first piece, from x [rad].
    """

    way: Any
    heading: Any
    pieces: Any


Move = SlideAlong | TurnAbout | QuaternionTurn | WayAlongPieces


@dataclass(frozen=True)
class PushAlong:
    """What acts along a way or an angle that a joint makes, on the child and opposite on the parent; None: nothing.

    push - stiffness (way - rest) - damping way', and armature way'^2 / 2 of kinetic energy.
    """

    way: Any
    push: Any = None
    stiffness: Any = None
    damping: Any = None
    rest: Any = None
    armature: Any = None
