"""Capstan: a rope laid about a rough drum."""

from collections.abc import Iterator
from typing import Any, ClassVar

from eomgen.frozen import dataclass
from eomgen.model.catalog import Catalog
from eomgen.model.constraints.base import Constraint, Thread
from eomgen.model.constraints.row import ConstraintRow
from eomgen.model.constraints.strand import Strand, rope_row
from eomgen.model.constraints.string import String
from eomgen.model.diagnostics import Diagnostic
from eomgen.model.forces.load import LoadContext
from eomgen.model.kinds import Flag, Friction, Opening, Resistance, Route, Wrap
from eomgen.model.positions import DocumentPath
from eomgen.symbolic.expression import Expression, Fraction, as_expression


@dataclass(frozen=True, kw_only=True)
class Capstan(Constraint):
    """A rope of constant length about a rough drum, fixed or turning: T_1 e^(-mu phi) <= T_2 <= T_1 e^(mu phi).

    While it sticks to the drum the tensions T_1 and T_2 of its two sides are anything between these limits; where it
    slips the side towards which it moves on the drum has the larger one, T_1 = T_2 e^(mu phi). With the mean T of both
    and F = T_2 - T_1 that is Coulomb's friction, |F| <= 2 T tanh(mu phi/2). A band brake is a turning drum.

    Args:
        path: a point, the wrap about the drum, a point; at the ends also wraps, on which it is wound.
        coefficient: mu.
        angle: phi, the whole angle on which it lies, several turns too [rad].
        unilateral: it can only pull.
    """

    kind: ClassVar[str] = "capstan"
    pulls: ClassVar[bool] = True
    path: Route
    coefficient: Friction
    angle: Opening
    unilateral: Flag = False

    @property
    def exponent(self) -> Expression:
        return self.coefficient * self.angle

    @property
    def friction(self) -> Resistance:
        """Law of F for a unit of T."""
        return Resistance(coulomb=as_expression(f"2*tanh({self.exponent.text}/2)"))

    def strand_rows(self) -> tuple[int, ...]:
        return (1, 1)

    def thread(self) -> Thread:
        return Thread(self._string.path)

    @property
    def _string(self) -> String:
        """The rope, which slides on its drum."""
        first, drum, last = self.path
        assert isinstance(drum, Wrap), "checked when the model was read"
        return String(path=(first, drum.altered(slip=True), last))

    def strands_at(self, scene: LoadContext) -> tuple[Strand, ...]:
        return self._string.strands_at(scene)

    def diagnostics(self, path: DocumentPath, catalog: Catalog) -> Iterator[Diagnostic]:
        """Diagnostics of a path that is not about one drum, and those of a string."""
        stops: tuple[Any, ...] = self.path or ()
        if len(stops) != 3 or isinstance(stops[1], str):
            what = f"the capstan '{path[1]}' goes from a point about one drum to a point"
            fix = 'path = ["A.end", { body = "drum", turn = "cw" }, "B.end"]'
            yield Diagnostic((*path, "path"), what, fix)
            return
        yield from self._string.diagnostics(path, catalog)

    def stays(self, component: str) -> bool:
        return component == "tension"

    def rows(self, scene: LoadContext) -> tuple[ConstraintRow, ...]:
        """The row of the mean tension; friction adds half of it to the second side, and takes it from the first."""
        first, second = self.strands_at(scene)
        row = rope_row(scene, (first, second))
        half = Fraction(1, 2)
        tangent = (*(push.times(-half) for push in first.pulls), *(push.times(half) for push in second.pulls))
        return (ConstraintRow(row.pushes, row.gap, row.rate, component="tension", tangent=tangent),)
