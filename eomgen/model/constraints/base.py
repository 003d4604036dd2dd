"""What every constraint is, what touches what in it, and the rows that its law gives.

What every constraint is: fields that say what touches what.
"""

from abc import ABC, abstractmethod
from collections.abc import Iterator
from typing import Any, ClassVar

from eomgen.frozen import dataclass
from eomgen.model.catalog import Catalog
from eomgen.model.constraints.row import ConstraintRow, Edge
from eomgen.model.constraints.strand import Strand
from eomgen.model.diagnostics import Diagnostic
from eomgen.model.forces.load import LoadContext
from eomgen.model.kinds import ReactionSymbolsField
from eomgen.model.part import Part
from eomgen.model.positions import DocumentPath
from eomgen.symbolic.expression.node import Scalar

# -------- meeting ---------------------------------------------------------------------------------------------
# What touches what in a constraint, as it is declared: fields and names alone, no formulas. Proofs look at them.


@dataclass(frozen=True)
class TouchingPoint:
    """A point of a body: "rod.end"."""

    point: str


@dataclass(frozen=True)
class TouchingRound:
    """A ball, in the plane a disc; with an axis a thin wheel, with a tube the tyre about its rim; an ellipsoid.

    Args:
        body, center: about which point of which body it is round; None: its origin.
        radius: None: that of the body's shape.
        axis: body axes; None: it is round all about.
        tube: None: 0.
        semiaxes: of an ellipsoid, body axes.
    """

    body: str
    center: str | None
    radius: Any
    axis: Any = None
    tube: Any = None
    semiaxes: Any = None


@dataclass(frozen=True)
class FlatSurface:
    """A line of the plane, or a plane: through `at`, in the axes of `on`; at None: where the point stands first."""

    on: str | None
    at: Any
    normal: Any


@dataclass(frozen=True)
class RoundSurface:
    """A circle or ball about `at`, in the axes of `on`; radius None: that of the shape of `on`, about its origin.

    With an axis a pipe.
    """

    on: str | None
    at: Any
    radius: Any
    inside: bool = False
    axis: Any = None


@dataclass(frozen=True)
class Groove:
    """What the edge of a skate cuts, along `along` of the body `on`, in ice of a normal (ground axes; None: z)."""

    on: str | None
    along: Any
    normal: Any


@dataclass(frozen=True)
class BodyLine:
    """The line of a body, on which a point stays."""

    on: str


@dataclass(frozen=True)
class Thread:
    """What is straight from stop to stop: a string or a link.

    Args:
        stops: points by name, and wraps as a string has them.
        ways: the direction of each strand that keeps one; None: they follow.
        length: of what has one strand [m]; None: that at the start.
    """

    stops: Any
    ways: Any = None
    length: Any = None


@dataclass(frozen=True)
class Meeting:
    """Two things that touch; `sticks`: they do not slide on one another."""

    what: TouchingPoint | TouchingRound
    surface: FlatSurface | RoundSurface | BodyLine | Groove
    sticks: bool = False


# -------- base ------------------------------------------------------------------------------------------------


@dataclass(frozen=True, kw_only=True)
class Constraint(Part, ABC):
    """A constraint between bodies, or between coordinates.

    `table` is where a user declares it. `spaces` are those in which this version states its rows; elsewhere it is read,
    checked and not derived yet.

    Args:
        symbol: what its reactions are called in formulas, in LaTeX.
    """

    kind: ClassVar[str]
    table: ClassVar[str] = "constraints"
    spaces: ClassVar[tuple[str, ...]] = ("plane", "space")
    one_of: ClassVar[tuple[str, ...]] = ()  # of these fields exactly one is given
    holds_ground: ClassVar[bool] = False  # its point may be one of the ground
    pulls: ClassVar[bool] = False  # a wire, which goes slack; anything else opens
    by_squares: ClassVar[bool] = False  # its gap, of squares, is a length to first order only
    on_line: ClassVar[bool] = False  # in space it holds its point from all sides of a line
    symbol: ReactionSymbolsField | None = None

    def diagnostics(self, path: DocumentPath, catalog: Catalog) -> Iterator[Diagnostic]:
        """What is wrong with its fields together; one alone its rule has looked at."""
        yield from ()

    @classmethod
    def works_in(cls, space: str) -> bool:
        """Whether this version derives the constraint in this space."""
        return space in cls.spaces

    def strand_rows(self) -> tuple[int, ...]:
        """Of each strand of a string the row that holds its tension, from 1; () where it is no string."""
        return ()

    def strands_at(self, scene: LoadContext) -> tuple[Strand, ...]:
        """The straight pieces of a string; () where it is no string."""
        return ()

    def turned(self) -> Iterator[tuple[str, Any]]:
        """(how it is written, the same constraint) with a direction in the axes of a body, where it stands in the
        ground's."""
        yield from ()

    def misplaced(self, scene: LoadContext) -> tuple[str, str]:
        """(where the start lies that hardly was meant, what says so otherwise), ("", "") as it should be."""
        return "", ""

    def leans_on_ground(self) -> bool:
        """Whether the ground guides what the constraint holds, though it pushes on no place of the ground."""
        return False

    def edges(self, scene: LoadContext) -> tuple[Edge, ...]:
        """What must not vanish, else nobody can say where the constraint holds its bodies; () where there is no such
        thing."""
        return ()

    def limits(self, scene: LoadContext) -> tuple[Edge, ...]:
        """What is positive at the start, and has to be for its rows to be what it says; () where they always are."""
        return ()

    def meeting(self) -> Meeting | None:
        """What touches what, as it is declared; None where nothing does, or where it is not told."""
        return None

    def thread(self) -> Thread | None:
        """How it runs, as it is declared, where it is straight from point to point."""
        return None

    def drives(self) -> str:
        """The coordinate that it gives as a function of time; "" where it does no such thing."""
        return ""

    def stays(self, component: str) -> bool:
        """Whether this row keeps something as it is at the start, and so is closed there, wherever that is."""
        return False

    @property
    def lies_by_start(self) -> bool:
        """True if where, or how long, it is follows from where its points start."""
        return False

    def agreeing(self, scene: LoadContext) -> tuple[Scalar, ...]:
        """What is 1 where directions of two bodies agree, -1 where one is turned over, which the rows allow too."""
        return ()

    @abstractmethod
    def rows(self, scene: LoadContext) -> tuple[ConstraintRow, ...]:
        """The rows of the constraint, asked only where it works.

        Raises:
            ModelError: it cannot hold as it is said.
        """
