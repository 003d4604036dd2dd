"""Path: a point on pieces of lines and arcs."""

from collections.abc import Callable, Iterator, Sequence
from typing import Annotated, Any, ClassVar

from eomgen.frozen import dataclass
from eomgen.model.catalog import Catalog
from eomgen.model.diagnostics import Diagnostic
from eomgen.model.fields import ListRule
from eomgen.model.joints.base import (
    Column,
    Effort,
    Joint,
    Move,
    Scalars,
    X,
    Y,
    Z,
    angular,
    linear,
)
from eomgen.model.kinds import ConstantAngle, Displacement, FrictionLaw, Length, MovingPlace, Text, Turn, ValueOf
from eomgen.model.part import Part, PartRule
from eomgen.model.positions import DocumentPath as FilePath
from eomgen.model.shapes.forms import ArcForm, Form, LineForm
from eomgen.symbolic.expression import Expression, Pose, Vector, cos, function, over, selected, sin


@dataclass(frozen=True, kw_only=True)
class PathPiece(Part):
    """A straight piece (`line`: its length) or an arc (`arc`: its radius, `turn`, `angle`: how far).

    Args:
        name: as messages call it.
        line: the length of a straight piece [m].
        arc: the radius of an arc [m].
        turn: of an arc: to the left is "ccw".
        angle: of an arc: through which [rad].
        friction: on this piece.
    """

    title: ClassVar[str] = "a piece of the path"
    name: Text | None = None
    line: Length | None = None
    arc: Length | None = None
    turn: Turn | None = None
    angle: ConstantAngle | None = None
    friction: FrictionLaw | None = None


@dataclass(frozen=True)
class Stretch:
    """A piece and where it begins, over any scalar.

    Args:
        begin: its first point, from the path's seat [m].
        heading: of travel there, from x [rad].
        start: the arc length s there [m].
        length: of the piece [m].
        bend: radius of an arc to the left, minus that of one to the right, None of a line [m].
    """

    begin: Vector
    heading: Any
    start: Any
    length: Any
    bend: Any

    @property
    def end(self) -> Any:
        return self.start + self.length

    def turned(self, s: Any) -> Any:
        """The heading at s: heading + (s - start) / bend [rad]."""
        return self.heading if self.bend is None else self.heading + over(s - self.start, self.bend)

    def direction(self, s: Any) -> Vector:
        """The unit direction of travel."""
        angle = self.turned(s)
        return Vector((cos(angle), sin(angle), 0))

    def place(self, s: Any) -> Vector:
        """The point at s."""
        return self.reached(s - self.start, self.turned(s))

    def reached(self, way: Any, h: Any) -> Vector:
        """The point at `way` behind the beginning with heading h.

        Of a line begin + way (cos h, sin h), of an arc begin + bend (sin h - sin h_0, cos h_0 - cos h).
        """
        h_0, bend = self.heading, self.bend
        if bend is None:
            return self.begin + Vector((way * cos(h), way * sin(h), 0))
        return self.begin + Vector((bend * (sin(h) - sin(h_0)), bend * (cos(h_0) - cos(h)), 0))


PathPieces = Annotated[tuple[PathPiece, ...], ListRule(PartRule(PathPiece))]


@dataclass(frozen=True, kw_only=True)
class Path(Joint):
    """A point on a path of lines and arcs: `along` is the arc length from its start at `at`; its axes do not turn.

    X = (p(s), 1), S = (0, t), t the direction of travel; W: the force along its left normal, every torque and the force
    out of the plane, in space that of x and y of the joint's seat. Before its beginning and after its end the first and
    the last piece go on.

    Args:
        along: the arc length s [m].
        heading: direction of the path at its beginning, from x [rad].
        pieces: lines and arcs, end to end.
    """

    kind: ClassVar[str] = "path"
    straight: ClassVar[bool] = False
    along: Displacement
    heading: ConstantAngle | None = None
    pieces: PathPieces

    @property
    def friction(self) -> FrictionLaw | None:
        """The friction of its piece, where it has only one."""
        pieces = self.pieces or ()
        return pieces[0].friction if len(pieces) == 1 else None

    def diagnostics(self, path: FilePath, catalog: Catalog) -> Iterator[Diagnostic]:
        """Diagnostics of pieces that are neither a line nor an arc, or both."""
        name = path[1]
        for k, piece in enumerate(self.pieces or ()):
            where = (*path, "pieces", k)
            if (piece.line is None) == (piece.arc is None):
                yield Diagnostic(
                    where,
                    f"a piece of the path of body '{name}' needs one of 'line' and 'arc'",
                    "line = 2, or arc = 0.5, turn, angle",
                )
            elif piece.arc is not None and (piece.turn is None or piece.angle is None):
                what = f"an arc of the path of body '{name}' needs 'turn' and 'angle'"
                yield Diagnostic(where, what, 'turn = "ccw", angle = "pi/2"')
            elif piece.line is not None and (piece.turn is not None or piece.angle is not None):
                what = f"a line of the path of body '{name}' has no 'turn' and no 'angle'"
                yield Diagnostic(where, what, "leave them out; the next piece begins in the direction of the line")

    def turns(self) -> tuple[Expression, ...]:
        return ()

    def moves(self) -> tuple[Move, ...]:
        return (Move(way=self.along, heading=self.heading, pieces=self.pieces),)

    def variables(self, space: str) -> tuple[Expression, ...]:
        return (self.along,)

    def pose(self, s: Scalars, value: ValueOf) -> Pose:
        return Pose(p=self._along(s[0], value, Stretch.place))

    def subspace(self, s: Scalars, value: ValueOf) -> tuple[Column, ...]:
        return (linear(self._along(s[0], value, Stretch.direction)),)

    def complement(self, s: Scalars, value: ValueOf) -> tuple[Column, ...]:
        x, y, _ = self._along(s[0], value, Stretch.direction)
        return (linear(Vector((-y, x, 0))), angular(Z), angular(X), angular(Y), linear(Z))

    def efforts(self) -> tuple[Effort | None, ...]:
        return (None,)

    def stretches(self, value: ValueOf) -> tuple[Stretch, ...]:
        """The pieces, each from where the one before ends."""
        found: list[Stretch] = []
        heading = 0 if self.heading is None else value(self.heading)
        begin, start = self._begin(value), 0
        for piece in self.pieces:
            bend, turn, length = _bend(piece, value)
            stretch = Stretch(begin, heading, start, length, bend)
            found.append(stretch)
            heading = heading + turn
            begin, start = stretch.reached(length, heading), stretch.end
        return tuple(found)

    def guides(self, value: ValueOf, seat: Pose) -> tuple[Form, ...]:
        pieces = zip(self.stretches(value), self.pieces, strict=True)
        return tuple(_drawn(stretch, piece, value, seat) for stretch, piece in pieces)

    def bounds(self) -> tuple[tuple[Expression, Expression], ...]:
        """The arc lengths between which each piece is."""
        return tuple((_expression(x.start), _expression(x.end)) for x in self.stretches(_itself))

    def piece(self, number: int) -> "OnePiece":
        """The same path with one of its pieces alone (from 0), which goes on before its beginning and after its end."""
        stretch = self.stretches(_itself)[number]
        kept = {slot.name: getattr(self, slot.name) for slot in type(self).slots()}
        return OnePiece.of_values(
            kept
            | {
                "along": _expression(self.along - stretch.start),
                "heading": _expression(stretch.heading),
                "pieces": (self.pieces[number],),
                "begin": tuple(_expression(x) for x in stretch.begin[:2]),
            },
        )

    def _begin(self, value: ValueOf) -> Vector:
        return Vector((0, 0, 0))

    def _along(self, s: Any, value: ValueOf, what: Callable[[Stretch, Any], Vector]) -> Vector:
        """Place or direction at s, of the piece on which s is."""
        there = [what(stretch, s) for stretch in self.stretches(value)]
        x, y, z = (self.of_its_piece(s, value, entries) for entries in zip(*there, strict=True))
        return Vector((x, y, z))

    def of_its_piece(self, s: Any, value: ValueOf, values: Sequence[Any]) -> Any:
        """The value, out of one for each piece, of the piece on which s is."""
        *before, here = values
        for stretch, there in zip(reversed(self.stretches(value)[:-1]), reversed(before), strict=True):
            here = selected(s, stretch.end, there, here)
        return here


@dataclass(frozen=True, kw_only=True)
class OnePiece(Path):
    """One piece of a path, as a path of its own.

    Args:
        begin: where it begins, from the seat of the whole path [m].
    """

    begin: MovingPlace

    def moves(self) -> tuple[Move, ...]:
        return (Move(X, self.begin[0]), Move(Y, self.begin[1]), *super().moves())

    def _begin(self, value: ValueOf) -> Vector:
        return Vector((value(self.begin[0]), value(self.begin[1]), 0))


def _bend(piece: PathPiece, value: ValueOf) -> tuple[Any, Any, Any]:
    """(signed radius or None, angle turned, length) of a piece."""
    if piece.line is not None:
        return None, 0, value(piece.line)
    assert piece.arc is not None and piece.angle is not None, "an arc has a radius and an angle"
    radius, angle = value(piece.arc), value(piece.angle)
    sense = 1 if piece.turn == "ccw" else -1
    return sense * radius, sense * angle, radius * angle


def _drawn(stretch: Stretch, piece: PathPiece, value: ValueOf, seat: Pose) -> Form:
    """A piece as it is drawn: a line, or an arc counter-clockwise from its beginning or from its end."""
    h, bend = stretch.heading, stretch.bend
    if bend is None:
        return LineForm((seat.point(stretch.begin), seat.point(stretch.place(stretch.end))))
    first = h if piece.turn == "ccw" else stretch.turned(stretch.end)
    x, y, _ = seat.R @ Vector((bend * sin(first), -bend * cos(first), 0))
    center = seat.point(stretch.begin + Vector((-bend * sin(h), bend * cos(h), 0)))
    r, start = function("abs", bend), function("atan2", y, x)
    return ArcForm(center, r, r, start, start + over(stretch.length, r))


def _itself(expression: Expression) -> Expression:
    """The value of an expression where formulas are the scalars."""
    return expression


def _expression(x: Any) -> Expression:
    return x if isinstance(x, Expression) else Expression.number(x)
