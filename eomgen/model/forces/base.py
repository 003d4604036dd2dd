"""Base class of forces, and what each declares: where it acts and by which law.

A force is declared by fields that say where it acts and by which law.
"""

from collections.abc import Iterator
from typing import Any, ClassVar

from eomgen.frozen import dataclass
from eomgen.model.catalog import Catalog
from eomgen.model.diagnostics import Diagnostic
from eomgen.model.forces.load import Load, LoadContext, SpreadLoad
from eomgen.model.part import Part
from eomgen.model.positions import DocumentPath
from eomgen.symbolic.expression import Expression, Scalar

# -------- element ---------------------------------------------------------------------------------------------
# Actions of forces, as they are declared: fields and names alone, no formulas and no loads.
#
# Proofs look at it, and at nothing else of a force.


@dataclass(frozen=True)
class Element:
    """Action between two points, or a couple that turns two bodies relative to one another.

    Args:
        points: its ends; () for what turns bodies.
        bodies: the first and the second; None: the ground.
        along: a fixed direction along which its length is measured; None: from end to end.
        stiffness, damping: of length and its rate, of angle and its rate; None: 0.
        slack: the length, or angle, at which a spring is slack, or "start"; None: 0.
        pushes: beyond the slack, where it is shorter, it pushes and never pulls, elsewhere it does nothing.
        power: n of the law k x^n that it then has (None: 1).
        dissipation: a share of it per speed of compression: k x^n (1 + a x') (None: 0).
        pull: a law of the length `r` and its rate `r'`; None: 0.
    """

    points: tuple[str, ...] = ()
    bodies: tuple[str | None, ...] = ()
    along: tuple[Expression, ...] | None = None
    stiffness: Expression | None = None
    damping: Expression | None = None
    slack: Expression | str | None = None
    pull: Expression | None = None
    pushes: bool = False
    power: Expression | None = None
    dissipation: Expression | None = None


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
    """A generalized force on a coordinate, without a point of application [N or N m]."""

    coordinate: str
    value: Expression


@dataclass(frozen=True)
class GivenEnergy:
    """A potential energy, or a kinetic one, without a point of application [J]."""

    potential: Expression | None = None
    kinetic: Expression | None = None


@dataclass(frozen=True)
class FlowOfMass:
    """Mass that enters a body at a point per second, with a velocity relative to the body, or against the ground.

    Args:
        rate: None: what the other flows leave of the rate of the body's mass [kg/s].
    """

    point: str
    velocity: tuple[Expression, ...]
    axes: str = "ground"
    rate: Expression | None = None
    absolute: bool = False


@dataclass(frozen=True)
class ElasticThread:
    """One tension along the way of a rope, k s + c s' of its stretch s where that is above 0, and never below 0.

    Args:
        stops: points by name, and wraps as a rope has them.
        slack: its length without tension [m], or "start".
    """

    stops: tuple[Any, ...]
    stiffness: Expression
    slack: Expression | str
    damping: Expression | None = None


@dataclass(frozen=True)
class Meshing:
    """Couples of two wheels by x = theta_1 - ratio theta_2 beyond their play, of which the driven one has a share.

    Args:
        stiffness, damping: of x and its rate, at the first wheel.
        play: the whole of it in x; None: 0.
        efficiency: the share of the driven one; None: 1.
        smooth: the speed of the first over which the driven side changes; None: at once.
    """

    bodies: tuple[str, ...]
    ratio: Expression
    stiffness: Expression
    damping: Expression | None = None
    play: Expression | None = None
    efficiency: Expression | None = None
    smooth: Expression | None = None


Act = (
    FlowOfMass
    | Meshing
    | ElasticThread
    | Element
    | PushAt
    | CoupleOn
    | PushAlongLine
    | PushOfMass
    | PushOnCoordinate
    | GivenEnergy
)


# -------- base ------------------------------------------------------------------------------------------------


@dataclass(frozen=True, kw_only=True)
class Force(Part):
    """An action on the system; `by_mass` marks one that acts on every particle of a body in proportion to its mass.

    A law gives `loads`, with or without a `potential`: the two ways to its generalized forces.
    `works` is False for a kind that is read and checked but not derived yet.
    """

    kind: ClassVar[str]
    works: ClassVar[bool] = True
    by_mass: ClassVar[bool] = False
    one_of: ClassVar[tuple[str, ...]] = ()  # of these fields exactly one is given
    elastic: ClassVar[bool] = False  # a spring
    tight: ClassVar[bool] = False  # one tension along its way
    placeless: ClassVar[bool] = False  # an energy of coordinates, without a point of application

    def diagnostics(self, path: DocumentPath, catalog: Catalog) -> Iterator[Diagnostic]:
        """Diagnostics of fields that do not fit together; each field alone is checked by its rule."""
        yield from ()

    @property
    def element(self) -> Element | None:
        """The action between two points or two bodies; None for what acts otherwise."""
        return None

    @property
    def flow(self) -> tuple[str, Expression | None] | None:
        """(body, mass that enters it per second, None: what others leave of the rate of its mass); None of others."""
        return None

    @property
    def of_the_start(self) -> bool:
        """True if it is slack at the length that it has where the motion starts."""
        return self.element is not None and self.element.slack == "start"

    @property
    def acts(self) -> tuple[Act, ...]:
        """The declared actions of the force, which the proof uses instead of `loads`."""
        return () if self.element is None else (self.element,)

    @property
    def kinetic(self) -> Expression | None:
        """T [J] of what moves and is no body; None of a force that has none."""
        return None

    def strands_at(self, scene: LoadContext) -> tuple[Any, ...]:
        """The straight pieces of what pulls along its way; () of others."""
        return ()

    def effort(self, scene: LoadContext) -> Scalar | None:
        """Attraction of its two points [N], or couple on its (second) body [N m]; None of others."""
        return None

    def loads(self, scene: LoadContext) -> tuple[Load, ...]:
        """Forces and couples on bodies, and forces along coordinates."""
        return ()

    def spread(self, scene: LoadContext) -> tuple[SpreadLoad, ...]:
        """Loads distributed along lines, of which `loads` gives the resultants."""
        return ()

    def potential(self, scene: LoadContext) -> Scalar | None:
        """V [J], or None where the force has none."""
        return None
