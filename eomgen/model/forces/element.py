"""What a force is, as it is declared: fields and names alone, no formulas and no loads.

Proofs look at it, and at nothing else of a force.
"""

from eomgen.records import dataclass
from eomgen.symbolic.expression.formula import Expression


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
