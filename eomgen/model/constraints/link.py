"""Links and two-force members of a truss.

Link: a massless rod or wire of constant length.
"""

from collections.abc import Mapping
from dataclasses import replace
from typing import Annotated, ClassVar

from eomgen.errors import ModelError
from eomgen.frozen import dataclass
from eomgen.model.constraints.base import Constraint, Thread
from eomgen.model.constraints.row import ConstraintRow
from eomgen.model.fields import ListRule, NameRule
from eomgen.model.forces.load import LoadContext, PointForce
from eomgen.model.kinds import Flag, MovingLength, Restitution, Text, TwoPoints
from eomgen.symbolic.expression import Call, Fraction, Node, Reference, Scalar, Vector, order, over, sqrt


@dataclass(frozen=True, kw_only=True)
class Link(Constraint):
    """A massless rod or wire between two points, which keeps their distance, or pays it out; tension positive.

    One row: the tension. Its gap is (L^2 - r^2) / (2 L), to first order L - r.

    Args:
        points: the two ends.
        length: their distance, also as a function of time: a winch (None: the one at the start) [m].
        unilateral: a wire, which can only pull.
        restitution: where it is taut again it rebounds with this share of its speed, 0 to 1 (None: not at all).
    """

    kind: ClassVar[str] = "link"
    pulls: ClassVar[bool] = True
    by_squares: ClassVar[bool] = True
    points: TwoPoints
    length: MovingLength | None = None
    unilateral: Flag = False
    restitution: Restitution | None = None

    def thread(self) -> Thread:
        return Thread(self.points, length=self.length)

    def stays(self, component: str) -> bool:
        return self.length is None

    @property
    def lies_by_start(self) -> bool:
        return self.length is None

    def rows(self, scene: LoadContext) -> tuple[ConstraintRow, ...]:
        """(L - r . r / L) / 2 = 0, r from the first point to the second; a tension 1 pulls the first along r / L.

        It is L - |r| to first order, without a root.
        """
        first, second = (scene.place(point) for point in self.points)
        r = scene.position(second) - scene.position(first)
        L = self._length(scene, r)
        d = Vector(over(x, L) for x in r)
        pulls = (PointForce(first, d), PointForce(second, -d))
        half = Fraction(1, 2)
        rate = None
        if self.length is not None and scene.moves((L,)):  # of the gap, where the ends stay
            rate = half * scene.held_rate(self.length, {}) * (1 + over(r @ r, L * L))
        return (ConstraintRow(pulls, half * (L - r @ d), rate, component="tension"),)

    def _length(self, scene: LoadContext, r: Vector) -> Scalar:
        if self.length is not None:
            return scene.value(self.length)
        square = scene.start(r @ r)
        if scene.value_at_start(square) == 0 or scene.vanishes(square):
            ends = " and ".join(f"'{point}'" for point in self.points)
            raise ModelError(
                f"{ends} are at one place at the start: the link has no length there",
                scene.where,
                "give its 'length', or use a pin",
            )
        return sqrt(square)


# -------- members ---------------------------------------------------------------------------------------------
# Members: the two-force bars of a truss. A model holds them once its trusses are taken apart; no file names them.


def ends_requested(call: Call) -> tuple[str, str] | None:
    """The two nodes of tension(T, n1-n2) or tension(T, n1, n2); None where it names no two."""
    _, *rest = call.args
    texts = [a.name if isinstance(a, Reference) else a.text for a in rest]
    ends = [end.strip() for text in texts for end in text.split("-")]
    return (ends[0], ends[1]) if len(ends) == 2 else None


@dataclass(frozen=True, kw_only=True)
class Members(Constraint):
    """Massless bars between the nodes of one truss, each keeps its length; tension positive.

    Args:
        truss: its name.
        members: "n1-n2", in the order of the rows.
    """

    kind: ClassVar[str] = "truss"
    table: ClassVar[str] = "trusses"
    truss: Text
    members: Annotated[tuple[str, ...], ListRule(NameRule("member"))]

    def ends(self, member: str) -> tuple[str, str]:
        """The points that a member joins."""
        first, second = member.split("-")
        return f"{self.truss}.{first}", f"{self.truss}.{second}"

    def stays(self, component: str) -> bool:
        return True

    def rows(self, scene: LoadContext) -> tuple[ConstraintRow, ...]:
        """The row of a link, for each member."""
        return tuple(self._row(scene, member) for member in self.members)

    def _row(self, scene: LoadContext, member: str) -> ConstraintRow:
        ends = self.ends(member)
        first, second = (scene.position(scene.place(point)) for point in ends)
        r = second - first
        if all(scene.vanishes(x) or scene.value_at_start(x) == 0 for x in r):
            raise ModelError(
                f"member '{member}' of truss '{self.truss}' has no length",
                scene.where,
                "its two nodes are at one place: move one of them, or make them one",
            )
        (row,) = Link(points=ends).rows(scene)
        if scene.moves(r):
            return replace(row, part=member)
        x, y, z = _direction(scene, r)
        pulls = (
            PointForce(scene.place(ends[0]), Vector((x, y, z))),
            PointForce(scene.place(ends[1]), -Vector((x, y, z))),
        )
        return replace(row, part=member, pushes=pulls)


def trusses_of(constraints: Mapping[str, Constraint]) -> dict[str, Members]:
    """The trusses of a model in parts, by name."""
    return {name: constraint for name, constraint in constraints.items() if isinstance(constraint, Members)}


def _direction(scene: LoadContext, r: Vector) -> tuple[Scalar, ...]:
    """r over its length: in plain numbers and roots of them where all components are multiples of one parameter."""
    (square,) = scene.readable((r @ r,))
    (length,) = scene.readable((sqrt(square),))
    direction = tuple(over(x, length) for x in r)
    return direction if _has_root_of_sum(length) else scene.readable(direction)


def _has_root_of_sum(x: Scalar) -> bool:
    """True if a length contains a root of something other than a number."""
    return type(x) is Node and any(y.op == "sqrt" and type(y.args[0]) is Node for y in order((x,)))
