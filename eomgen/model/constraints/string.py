"""String: over pulleys and pegs. Read and checked; not derived yet."""

from dataclasses import dataclass
from typing import Annotated, ClassVar

from eomgen.model.constraints.base import Constraint
from eomgen.model.containers import EitherRule, ListRule
from eomgen.model.fields import NameRule, TextRule, VectorRule
from eomgen.model.kinds import BodyName, Flag, GroundPlace, Radius, Turn
from eomgen.model.part import Part, PartRule
from eomgen.symbolic.expressions import Expression


@dataclass(frozen=True, kw_only=True)
class Wrap(Part):
    """A round thing that the string lies on.

    Args:
        body: a pulley (about its origin); or `at`, a place on the ground: a peg.
        radius: None: the shape's [m].
        turn: the sense in which one travels round it.
        slip: the string slides on it: one tension through.
    """

    title: ClassVar[str] = "a wrap of the string"
    body: BodyName | None = None
    at: GroundPlace | None = None
    radius: Radius | None = None
    turn: Turn | None = None
    slip: Flag = False


DIRECTIONS = ("up", "down", "left", "right")
StrandRule = EitherRule(TextRule(DIRECTIONS), VectorRule(nonzero=True))
Route = Annotated[tuple[str | Wrap, ...], ListRule(EitherRule(NameRule("point"), PartRule(Wrap)), least=2)]
Strands = Annotated[tuple[str | tuple[Expression, ...], ...], ListRule(StrandRule)]


@dataclass(frozen=True, kw_only=True)
class String(Constraint):
    """A string of constant length from end to end.

    Args:
        path: points and wraps, in the order of travel.
        strands: directions that stay so, one a strand; None: computed.
        unilateral: it can only pull.
    """

    kind: ClassVar[str] = "string"
    path: Route
    strands: Strands | None = None
    unilateral: Flag = False
