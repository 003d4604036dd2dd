"""What touches what in a tie, as it is declared: fields and names alone, no formulas. Proofs look at them."""

from typing import Any

from eomgen.records import dataclass


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
