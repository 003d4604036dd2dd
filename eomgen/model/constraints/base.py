"""Base class of constraints, the declared contacts of each, and the rows that its law gives.

A constraint is declared by fields that say what touches what.
"""

from abc import ABC, abstractmethod
from collections.abc import Iterator, Mapping
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
from eomgen.symbolic.expression import Expression, Scalar

# -------- meeting ---------------------------------------------------------------------------------------------
# What touches what in a constraint, as it is declared: fields and names alone, no formulas. Proofs look at them.


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
    """The groove that a skate's edge cuts along `along` of the body `on`, in ice of a normal (ground axes; None: z)."""

    on: str | None
    along: Any
    normal: Any


@dataclass(frozen=True)
class Thread:
    """A thread, straight from stop to stop: a string or a link.

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
    """Two things that touch.

    Args:
        point, ball: what touches: a point of a body, "rod.end"; or, where that is "", a round body.
        flat, round, groove, line: what is touched, one of them: a surface, a groove, or the line of this body.
        sticks: they do not slide on one another.
    """

    point: str = ""
    ball: TouchingRound | None = None
    flat: FlatSurface | None = None
    round: RoundSurface | None = None
    groove: Groove | None = None
    line: str | None = None
    sticks: bool = False

    @property
    def on(self) -> str | None:
        """The body that is touched; None: the ground."""
        surface = self.flat or self.round or self.groove
        return self.line if surface is None else surface.on


# -------- base ------------------------------------------------------------------------------------------------


@dataclass(frozen=True, kw_only=True)
class Constraint(Part, ABC):
    """A constraint between bodies, or between coordinates.

    `table` is where a user declares it. `spaces` are those in which this version states its rows; elsewhere it is read,
    checked and not derived yet.

    Args:
        symbol: letter of its reactions in formulas, in LaTeX.
    """

    kind: ClassVar[str]
    table: ClassVar[str] = "constraints"
    spaces: ClassVar[tuple[str, ...]] = ("plane", "space")
    one_of: ClassVar[tuple[str, ...]] = ()  # of these fields exactly one is given
    holds_ground: ClassVar[bool] = False  # its point may be one of the ground
    about_joint: ClassVar[bool] = False  # it pushes along a joint's variable
    pulls: ClassVar[bool] = False  # a wire, which goes slack; anything else opens
    by_squares: ClassVar[bool] = False  # its gap, of squares, is a length to first order only
    on_line: ClassVar[bool] = False  # in space it holds its point from all sides of a line
    symbol: ReactionSymbolsField | None = None

    def diagnostics(self, path: DocumentPath, catalog: Catalog) -> Iterator[Diagnostic]:
        """Diagnostics of fields that do not fit together; each field alone is checked by its rule."""
        yield from self.never_rebounds(path)

    def never_rebounds(self, path: DocumentPath) -> Iterator[Diagnostic]:
        """Diagnostics of a restitution of what cannot end, and so never closes again."""
        if getattr(self, "restitution", None) is not None and not getattr(self, "unilateral", False):
            what = f"'{path[1]}' has a restitution and cannot end, so that it never closes again"
            yield Diagnostic((*path, "restitution"), what, "unilateral = true, or leave it out", key=True)

    def assumption(self, name: str) -> str:
        """The sentence that states what is assumed by the constraint of this name; "" where nothing is."""
        return ""

    @property
    def only_pulls(self) -> bool:
        """True if its tension is never a push: a string, or a member that may go slack."""
        return bool(self.strand_rows()) or bool(getattr(self, "unilateral", False))

    @classmethod
    def works_in(cls, space: str) -> bool:
        """True if this version derives the constraint in this space."""
        return space in cls.spaces

    def wheels(self) -> tuple[str, str, Any] | None:
        """(first, second, ratio) of two bodies that turn at a ratio, omega_1 = ratio * omega_2; None of all others."""
        return None

    @property
    def exponent(self) -> Expression | None:
        """mu phi of a rope, whose friction is the difference of the tensions of its sides; None of all others."""
        return None

    def strand_rows(self) -> tuple[int, ...]:
        """Row, from 1, with the tension of each strand of a string; () where it is no string."""
        return ()

    def strands_at(self, scene: LoadContext) -> tuple[Strand, ...]:
        """The straight pieces of a string; () where it is no string."""
        return ()

    def turned(self) -> Iterator[tuple[str, Any]]:
        """(how it is written, the same constraint) with a direction in the axes of a body, where it stands in the
        ground's."""
        yield from ()

    def misplaced(self, scene: LoadContext) -> tuple[str, str]:
        """(what is unlikely about the start, how to confirm it); ("", "") if nothing is."""
        return "", ""

    def leans_on_ground(self) -> bool:
        """True if the ground guides the constrained body, though no force acts at a point of the ground."""
        return False

    def impulse_unit(self, catalog: Catalog) -> str:
        """The unit of its impulse, where it can close; "" elsewhere."""
        return "N*s" if getattr(self, "unilateral", False) else ""

    def gap_unit(self, bodies: Mapping[str, Any]) -> str:
        """The unit of its gap: what an angle stops is measured in rad."""
        return "m"

    def edges(self, scene: LoadContext) -> tuple[Edge, ...]:
        """Quantities that must not vanish, or else the point of contact is undefined; () where there are none."""
        return ()

    def limits(self, scene: LoadContext) -> tuple[Edge, ...]:
        """Quantities that are positive at the start and must remain so for the rows to hold; () where there is none."""
        return ()

    def meeting(self) -> Meeting | None:
        """The declared contact: what touches what; None where nothing does, or where it is not declared."""
        return None

    def thread(self) -> Thread | None:
        """The declared thread, where it is straight from point to point; None for anything else."""
        return None

    def drives(self) -> str:
        """The coordinate that it prescribes as a function of time; "" if there is none."""
        return ""

    def stays(self, component: str) -> bool:
        """True if this row keeps a quantity at its start value, and so is satisfied at any start."""
        return False

    @property
    def lies_by_start(self) -> bool:
        """True if its place or length follows from the start positions of its points."""
        return False

    def agreeing(self, scene: LoadContext) -> tuple[Scalar, ...]:
        """Quantities that are 1 where directions of two bodies agree, -1 where one is reversed (rows allow both)."""
        return ()

    @abstractmethod
    def rows(self, scene: LoadContext) -> tuple[ConstraintRow, ...]:
        """The rows of the constraint; called only in a space in which it is derived.

        Raises:
            ModelError: it cannot hold as it is said.
        """
