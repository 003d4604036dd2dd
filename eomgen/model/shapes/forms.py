"""Forms that a picture shows of a shape: lines, polygons, arcs and solids, over any scalar.

A form is geometry alone, in the axes of what it belongs to; who draws it knows its `kind`.
"""

from __future__ import annotations

from dataclasses import replace
from typing import Any, ClassVar

from eomgen.frozen import dataclass
from eomgen.symbolic.expression import Fraction, Vector

HALF_OF = Fraction(1, 2)
TICK = Fraction(17, 20)  # of a hoop's radius, where the mark that shows its turn begins


@dataclass(frozen=True)
class Form:
    """One thing that can be drawn.

    Args:
        kind: by which drawers know it.
        spots: the fields that hold places or directions, 3 each; of a tuple of places all.
    """

    kind: ClassVar[str]
    spots: ClassVar[tuple[str, ...]] = ()

    def flat(self) -> tuple[Form, ...]:
        """Forms of it in the plane, seen along z."""
        return (self,)


@dataclass(frozen=True)
class LineForm(Form):
    """A line from point to point; `fine`: a mark on something, thinner than an edge."""

    kind: ClassVar[str] = "line"
    spots: ClassVar[tuple[str, ...]] = ("points",)
    points: tuple[Vector, ...]
    fine: bool = False


@dataclass(frozen=True)
class PolygonForm(Form):
    """A filled polygon; a hole shows what is behind."""

    kind: ClassVar[str] = "polygon"
    spots: ClassVar[tuple[str, ...]] = ("points",)
    points: tuple[Vector, ...]
    hole: bool = False


@dataclass(frozen=True)
class ArcForm(Form):
    """An arc of an ellipse in the plane z = 0 of its axes.

    Args:
        radius, radius_y: half-axes along x and y [m].
        start, end: angles from x; None: all of it [rad].
        close: "none": a curve; "chord", "center": filled to its chord, or as a sector.
    """

    kind: ClassVar[str] = "arc"
    spots: ClassVar[tuple[str, ...]] = ("at",)
    at: Vector
    radius: Any
    radius_y: Any
    start: Any = None
    end: Any = None
    close: str = "none"
    hole: bool = False


@dataclass(frozen=True)
class BoxForm(Form):
    """A box of edges `size` about its middle."""

    kind: ClassVar[str] = "box"
    spots: ClassVar[tuple[str, ...]] = ("at", "size")
    at: Vector
    size: Vector

    def flat(self) -> tuple[Form, ...]:
        return (box_around(self.size[0], self.size[1]),)


@dataclass(frozen=True)
class EllipsoidForm(Form):
    """An ellipsoid, `size` its half-axes; of a ball they are equal."""

    kind: ClassVar[str] = "ellipsoid"
    spots: ClassVar[tuple[str, ...]] = ("at", "size")
    at: Vector
    size: Vector

    def flat(self) -> tuple[Form, ...]:
        x, y, _ = self.size
        return (ArcForm(self.at, x, y, close="chord"), LineForm((self.at, self.at + Vector((x, 0, 0))), fine=True))


@dataclass(frozen=True)
class RevolutionForm(Form):
    """A body of revolution: the profile (r, z) swept about the axis z.

    Args:
        rims: the radii seen along the axis, the outer one first; the second one is that of a hole.
    """

    kind: ClassVar[str] = "revolution"
    spots: ClassVar[tuple[str, ...]] = ("at",)
    at: Vector
    profile: tuple[tuple[Any, Any], ...]
    rims: tuple[Any, ...]

    def flat(self) -> tuple[Form, ...]:
        return round_plate(*self.rims)


@dataclass(frozen=True)
class PrismForm(Form):
    """A polygon, raised along z from `low` to `high`."""

    kind: ClassVar[str] = "prism"
    points: tuple[tuple[Any, Any], ...]
    low: Any
    high: Any

    def flat(self) -> tuple[Form, ...]:
        return (PolygonForm(tuple(Vector((x, y, 0)) for x, y in self.points)),)


@dataclass(frozen=True)
class PolyhedronForm(Form):
    """Plane faces, each by the numbers of its corners among the points; the first is the base."""

    kind: ClassVar[str] = "polyhedron"
    spots: ClassVar[tuple[str, ...]] = ("points",)
    points: tuple[Vector, ...]
    faces: tuple[tuple[int, ...], ...]

    def flat(self) -> tuple[Form, ...]:
        return (PolygonForm(tuple(Vector((*self.points[k][:2], 0)) for k in self.faces[0])),)


def disc_of(radius: Any, at: Vector = Vector.ZERO) -> ArcForm:
    """A filled circle."""
    return ArcForm(at, radius, radius, close="chord")


def round_plate(outer: Any, inner: Any = None) -> tuple[Form, ...]:
    """A disc, or a ring around a hole, and a radius that shows how it has turned."""
    start = 0 if inner is None else inner
    hole = () if inner is None else (replace(disc_of(inner), hole=True),)
    return (disc_of(outer), *hole, LineForm((Vector((start, 0, 0)), Vector((outer, 0, 0))), fine=True))


def hoop(radius: Any) -> tuple[Form, ...]:
    """A thin ring, with a mark that shows how it has turned."""
    return (
        ArcForm(Vector.ZERO, radius, radius),
        LineForm((Vector((TICK * radius, 0, 0)), Vector((radius, 0, 0))), fine=True),
    )


def box_around(width: Any, height: Any) -> PolygonForm:
    """A rectangle about the origin."""
    x, y = HALF_OF * width, HALF_OF * height
    return PolygonForm((Vector((-x, -y, 0)), Vector((x, -y, 0)), Vector((x, y, 0)), Vector((-x, y, 0))))


def turned_profile(profile: tuple[tuple[Any, Any], ...], *rims: Any) -> RevolutionForm:
    """A body of revolution about the origin's axis z."""
    return RevolutionForm(Vector.ZERO, profile, rims)


def cylinder_form(radius: Any, length: Any, inner: Any = None) -> RevolutionForm:
    """A cylinder about the origin, with a bore where `inner` is given."""
    low, high = -HALF_OF * length, HALF_OF * length
    if inner is None:
        return turned_profile(((0, low), (radius, low), (radius, high), (0, high)), radius)
    return turned_profile(((inner, low), (radius, low), (radius, high), (inner, high), (inner, low)), radius, inner)


def circle_points(radius: Any, pieces: int, begin: Any, end: Any) -> tuple[tuple[Any, Any], ...]:
    """(r, z) along an arc about the origin, from one angle above r to another [multiples of pi]."""
    import math

    angles = [math.pi * (begin + (end - begin) * k / pieces) for k in range(pieces + 1)]
    return tuple((_exact(math.cos(a)) * radius, _exact(math.sin(a)) * radius) for a in angles)


def _exact(x: float) -> Fraction:
    """A number of a drawing, to six places."""
    return Fraction(round(x * 10**6), 10**6)
