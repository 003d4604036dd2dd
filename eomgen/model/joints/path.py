"""Path: a point on pieces of lines and arcs. Read and checked; not derived yet."""

from dataclasses import dataclass
from typing import Annotated, ClassVar

from eomgen.model.containers import ListRule
from eomgen.model.friction import FrictionLaw
from eomgen.model.joints.base import Joint
from eomgen.model.kinds import ConstantAngle, Displacement, Length, Text, Turn
from eomgen.model.part import Part, PartRule
from eomgen.symbolic.expressions import Expression


@dataclass(frozen=True, kw_only=True)
class PathPiece(Part):
    """A straight piece (`line`: its length) or an arc (`arc`: its radius, `turn`, `angle`: how far)."""

    title: ClassVar[str] = "a piece of the path"
    name: Text | None = None
    line: Length | None = None
    arc: Length | None = None
    turn: Turn | None = None
    angle: ConstantAngle | None = None
    friction: FrictionLaw | None = None


Pieces = Annotated[tuple[PathPiece, ...], ListRule(PartRule(PathPiece))]


@dataclass(frozen=True, kw_only=True)
class Path(Joint):
    """A point that moves along pieces, `along` from the first one's beginning at `at`.

    Args:
        along: the arc length s [m].
        heading: direction of the path at its beginning, from x [rad].
        pieces: lines and arcs, end to end.
    """

    kind: ClassVar[str] = "path"
    works: ClassVar[bool] = False
    along: Displacement
    heading: ConstantAngle | None = None
    pieces: Pieces

    def turns(self) -> tuple[Expression, ...]:
        return ()
