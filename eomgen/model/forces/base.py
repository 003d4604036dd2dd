"""What every force is, as it is declared: where it acts and by which law.

What every force is: fields that say where it acts and by which law.
"""

from collections.abc import Iterator
from typing import ClassVar

from eomgen.frozen import dataclass
from eomgen.model.catalog import Catalog
from eomgen.model.diagnostics import Diagnostic
from eomgen.model.forces.load import Load, LoadContext, SpreadLoad
from eomgen.model.part import Part
from eomgen.model.positions import DocumentPath
from eomgen.symbolic.expression.formula import Expression
from eomgen.symbolic.expression.spatial import AnyScalar

# -------- element ---------------------------------------------------------------------------------------------
# What a force is, as it is declared: fields and names alone, no formulas and no loads.
#
# Proofs look at it, and at nothing else of a force.


@dataclass(frozen=True)
class Element:
    """What acts between two points, or turns two bodies against one another.

    Args:
        points: its ends; () for what turns bodies.
        bodies: the first and the second; None: the ground.
        along: a fixed direction along which its length is measured; None: from end to end.
        stiffness, damping: of length and its rate, of angle and its rate; None: 0.
        slack: the length, or angle, at which a spring pulls nothing, or "start"; None: 0.
        pull: a law of the length `r` and its rate `r'`; None: 0.
    """

    points: tuple[str, ...] = ()
    bodies: tuple[str | None, ...] = ()
    along: tuple[Expression, ...] | None = None
    stiffness: Expression | None = None
    damping: Expression | None = None
    slack: Expression | str | None = None
    pull: Expression | None = None


@dataclass(frozen=True)
class PushAt:
    """A force at a point, in the axes of the ground or of the body that `axes` names [N]."""

    point: str
    force: tuple[Expression, ...]
    axes: str = "ground"


@dataclass(frozen=True)
class CoupleOn:
    """A couple on a body, in the axes of the ground or of the body that `axes` names; one entry: about z [N m]."""

    body: str
    couple: tuple[Expression, ...]
    axes: str = "ground"


@dataclass(frozen=True)
class PushAlongLine:
    """A force per length on a body from one of its points to another, linear between, ground axes [N/m]."""

    body: str
    ends: tuple[str, ...]
    intensities: tuple[tuple[Expression, ...], ...]


@dataclass(frozen=True)
class PushOfMass:
    """An acceleration of the ground's axes that every mass of the bodies feels; None: of all bodies [m/s^2]."""

    acceleration: tuple[Expression, ...]
    bodies: tuple[str, ...] | None = None


@dataclass(frozen=True)
class PushOnCoordinate:
    """What does work on a coordinate, at no place [N or N m]."""

    coordinate: str
    value: Expression


@dataclass(frozen=True)
class GivenEnergy:
    """A potential energy, or a kinetic one, at no place [J]."""

    potential: Expression | None = None
    kinetic: Expression | None = None


Act = Element | PushAt | CoupleOn | PushAlongLine | PushOfMass | PushOnCoordinate | GivenEnergy


# -------- base ------------------------------------------------------------------------------------------------


@dataclass(frozen=True, kw_only=True)
class Force(Part):
    """Something applied to the system; `by_mass` is what acts on every particle of a body as its mass is spread.

    A law gives `loads`, whether or not it has a `potential`: the two ways to its generalized forces.
    `works` is False for a kind that is read and checked but not derived yet.
    """

    kind: ClassVar[str]
    works: ClassVar[bool] = True
    by_mass: ClassVar[bool] = False
    one_of: ClassVar[tuple[str, ...]] = ()  # of these fields exactly one is given
    elastic: ClassVar[bool] = False  # a spring
    placeless: ClassVar[bool] = False  # an energy of coordinates, which acts at no place

    def diagnostics(self, path: DocumentPath, catalog: Catalog) -> Iterator[Diagnostic]:
        """What is wrong with its fields together; one alone its rule has looked at."""
        yield from ()

    @property
    def element(self) -> Element | None:
        """What it is between two points or two bodies; None for what acts otherwise."""
        return None

    @property
    def of_the_start(self) -> bool:
        """Whether it is slack at the length that it has where the motion starts."""
        return self.element is not None and self.element.slack == "start"

    @property
    def acts(self) -> tuple[Act, ...]:
        """What it does, as it is declared: the proof's way, beside `loads`."""
        return () if self.element is None else (self.element,)

    @property
    def kinetic(self) -> Expression | None:
        """T [J] of what moves and is no body; None of a force that has none."""
        return None

    def effort(self, scene: LoadContext) -> AnyScalar | None:
        """What draws its two points together [N], or turns its (second) body [N m]; None of others."""
        return None

    def loads(self, scene: LoadContext) -> tuple[Load, ...]:
        """Forces and couples on bodies, and forces along coordinates."""
        return ()

    def spread(self, scene: LoadContext) -> tuple[SpreadLoad, ...]:
        """What is spread along lines, of which `loads` gives the resultants."""
        return ()

    def potential(self, scene: LoadContext) -> AnyScalar | None:
        """V [J], or None where the force has none."""
        return None
