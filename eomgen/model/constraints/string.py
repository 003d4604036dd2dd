"""String: over pulleys and pegs, fastened or wound at its ends."""

from collections.abc import Iterator
from itertools import pairwise
from typing import Annotated, ClassVar

from eomgen.frozen import dataclass
from eomgen.model.catalog import Catalog, diagnostics_of_one, is_round, owner_of
from eomgen.model.constraints.base import Constraint, Thread
from eomgen.model.constraints.row import ConstraintRow, Edge, direction_of
from eomgen.model.constraints.strand import Stop, Strand, rope_row, side_rows, strand_along
from eomgen.model.diagnostics import Diagnostic
from eomgen.model.fields import EitherRule, ListRule, TextRule, VectorRule
from eomgen.model.forces.load import LoadContext
from eomgen.model.kinds import Flag, Restitution, Route
from eomgen.model.positions import DocumentPath
from eomgen.symbolic.expression import Expression, Vector
from eomgen.symbolic.numeric import tolerances

DIRECTIONS = {"up": (0, 1, 0), "down": (0, -1, 0), "left": (-1, 0, 0), "right": (1, 0, 0)}
StrandRule = EitherRule(TextRule(tuple(DIRECTIONS)), VectorRule(nonzero=True))
Strands = Annotated[tuple[str | tuple[Expression, ...], ...], ListRule(StrandRule)]


@dataclass(frozen=True, kw_only=True)
class String(Constraint):
    """A string of constant length from end to end, over pulleys, pegs and eyelets.

    Rows: the tension of each strand, by the number of its row.

    Args:
        path: points and wraps, in the order of travel.
        strands: directions that stay so, one a strand; None: computed.
        unilateral: it can only pull.
        restitution: where it is taut again it rebounds with this share of its speed, 0 to 1 (None: not at all).
    """

    kind: ClassVar[str] = "string"
    pulls: ClassVar[bool] = True
    path: Route
    strands: Strands | None = None
    unilateral: Flag = False
    restitution: Restitution | None = None

    def strand_rows(self) -> tuple[int, ...]:
        """Row, from 1, with the tension of each strand: strands joined by what slips have one row.

        In the middle a point is a smooth eyelet; a wrap lets the string through where it says `slip`.
        """
        numbers = [1]
        for item in self.path[1:-1]:
            passes = isinstance(item, str) or item.slip
            numbers.append(numbers[-1] if passes else numbers[-1] + 1)
        return tuple(numbers)

    def thread(self) -> Thread:
        return Thread(self.path, self.strands)

    def strands_at(self, scene: LoadContext) -> tuple[Strand, ...]:
        """The strands from stop to stop, along given directions or common tangents."""
        pairs = pairwise([Stop.of(scene, item) for item in self.path])
        if self.strands is None:
            return tuple(Strand.between(scene, *pair) for pair in pairs)
        ways = [_direction(scene, way) for way in self.strands]
        return tuple(strand_along(scene, *pair, d) for pair, d in zip(pairs, ways, strict=True))

    def limits(self, scene: LoadContext) -> tuple[Edge, ...]:
        """The lengths of strands that stay along a line, which must remain positive."""
        name, found = scene.where.rpartition(".")[2], []
        for k, strand in enumerate(self.strands_at(scene), 1):
            begun = None if strand.length is None else scene.value_at_start(strand.length)
            if (
                strand.length is not None
                and begun is not None
                and begun > tolerances.COMPUTED
                and scene.moves((strand.length,))
            ):
                found.append(Edge(f"nothing is left of strand {k} of '{name}'", strand.length))
        return tuple(found)

    def diagnostics(self, path: DocumentPath, catalog: Catalog) -> Iterator[Diagnostic]:
        """Diagnostics of wraps without size or sense, of a string that holds nothing, of directions of strands."""
        yield from self.never_rebounds(path)
        for k, wrap in enumerate(self.path or ()):
            where = (*path, "path", k)
            if isinstance(wrap, str):
                continue
            yield from diagnostics_of_one(catalog, where, wrap, ("body", "at"))
            if wrap.radius is None and (wrap.at is not None or not is_round(catalog, wrap.body)):
                yield Diagnostic(
                    where, "the radius of this wrap is not known", "give 'radius', or the body a round shape"
                )
            if wrap.turn is None and (*where, "turn") not in catalog.broken:
                yield Diagnostic(
                    where, "a wrap needs 'turn': the sense in which one travels round it", 'turn = "cw" or "ccw"'
                )
            if wrap.axis is not None and catalog.model.space == "plane":
                yield Diagnostic(
                    (*where, "axis"), f"'axis' of a wrap of '{path[1]}' is for space", "leave it out", key=True
                )
            if wrap.slip and k in (0, len(self.path) - 1):
                yield Diagnostic(
                    (*where, "slip"), "the string is wound on its last wrap, where it cannot slip", key=True
                )
        owners = {owner_of(stop) if isinstance(stop, str) else stop.body or "" for stop in self.path or ()}
        if len(owners) == 1:
            what = (
                f"the string '{path[1]}' has nothing on it that it could hold: all of it is on one body or the ground"
            )
            yield Diagnostic((*path, "path"), what, "fasten a body to it, or lay it over a pulley that can turn")
        for k, way in enumerate(self.strands or ()):
            if isinstance(way, str) and catalog.model.space == "space":
                what = f"'{way}' says no direction in space, where no axis is up"
                yield Diagnostic((*path, "strands", k), what, "give the direction as three components")
        pieces = len(self.path or ()) - 1
        if self.strands is not None and self.path is not None and len(self.strands) != pieces:
            what = f"the string has {pieces} strands, but {len(self.strands)} directions are given"
            yield Diagnostic((*path, "strands"), what)

    def stays(self, component: str) -> bool:
        return component == "tension"

    def rows(self, scene: LoadContext) -> tuple[ConstraintRow, ...]:
        """A row for each tension; after them the restrictions of strands that keep a direction while their ends move.

        A strand with travel direction d pulls + d on what it leaves and - d on what it reaches.
        """
        strands, numbers = self.strands_at(scene), self.strand_rows()
        ropes = [[s for s, k in zip(strands, numbers, strict=True) if k == row] for row in range(1, numbers[-1] + 1)]
        sides = [] if self.strands is None else [side for strand in strands for side in side_rows(scene, strand)]
        return (*(rope_row(scene, rope) for rope in ropes), *sides)


def _direction(scene: LoadContext, way: str | tuple[Expression, ...]) -> Vector:
    return Vector(DIRECTIONS[way] if isinstance(way, str) else direction_of(scene, scene.vector(way)))
