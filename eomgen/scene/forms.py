"""Forms of which pictures are made: `ALL` is the table that drawers follow; symbols of joints and supports in them.

The forms of shapes are in the modules of the shapes; here are those of joints, forces, labels and dimensions.
"""

from __future__ import annotations

import math
from collections.abc import Iterable
from typing import Any, ClassVar

from eomgen.frozen import dataclass
from eomgen.model import (
    ArcForm,
    BoxForm,
    EllipsoidForm,
    Form,
    LineForm,
    PolygonForm,
    PolyhedronForm,
    PrismForm,
    RevolutionForm,
)
from eomgen.symbolic.expression import Fraction, Vector


@dataclass(frozen=True)
class SpringForm(Form):
    """A zigzag from a to b; `side`: that far to the left of the straight line [symbol units]."""

    kind: ClassVar[str] = "spring"
    spots: ClassVar[tuple[str, ...]] = ("a", "b")
    a: Vector
    b: Vector
    side: int = 0


@dataclass(frozen=True)
class DamperForm(SpringForm):
    """A dashpot from a to b."""

    kind: ClassVar[str] = "damper"


@dataclass(frozen=True)
class CylinderForm(SpringForm):
    """A hydraulic cylinder at a, its rod ends at b."""

    kind: ClassVar[str] = "cylinder"


@dataclass(frozen=True)
class RodForm(SpringForm):
    """A thin round bar from a to b, in the plane a thick line."""

    kind: ClassVar[str] = "rod"


@dataclass(frozen=True)
class WheelForm(Form):
    """A thin wheel with two spokes, `axis` of any length but 0."""

    kind: ClassVar[str] = "wheel"
    spots: ClassVar[tuple[str, ...]] = ("at", "axis")
    at: Vector
    axis: Vector
    radius: Any


@dataclass(frozen=True)
class TrackForm(Form):
    """A straight line through a place, as long as the picture; with a normal it is the edge of the body below.

    In space with a normal, and no direction, a plane. `below`: so far against the normal it is drawn [symbol units].
    """

    kind: ClassVar[str] = "track"
    spots: ClassVar[tuple[str, ...]] = ("at", "along", "normal")
    at: Vector
    along: Vector | None
    normal: Vector | None = None
    below: Any = 0


@dataclass(frozen=True)
class SymbolForm(Form):
    """A symbol by its name, of one size in every picture; its x axis, in space its z axis, is along `along`.

    Args:
        along: any length but 0; None: the ground's axes.
    """

    kind: ClassVar[str] = "symbol"
    spots: ClassVar[tuple[str, ...]] = ("at", "along")
    symbol: str
    at: Vector
    along: Vector | None = None


@dataclass(frozen=True)
class PointForm(Form):
    """A dot."""

    kind: ClassVar[str] = "point"
    spots: ClassVar[tuple[str, ...]] = ("at",)
    at: Vector


@dataclass(frozen=True)
class LabelForm(Form):
    """A name next to a place."""

    kind: ClassVar[str] = "label"
    spots: ClassVar[tuple[str, ...]] = ("at",)
    text: str
    at: Vector


@dataclass(frozen=True)
class ArrowForm(Form):
    """An arrow to scale whose tip is at a place; `outward`: that begins there.

    Args:
        vector: in `unit`; all of one role and unit have one scale.
    """

    kind: ClassVar[str] = "arrow"
    spots: ClassVar[tuple[str, ...]] = ("at", "vector")
    at: Vector
    vector: Vector
    unit: str
    outward: bool = False
    text: str = ""


@dataclass(frozen=True)
class CoupleForm(Form):
    """A couple at a place: in the plane an arc, counter-clockwise where z is positive; in space a double arrow."""

    kind: ClassVar[str] = "couple"
    spots: ClassVar[tuple[str, ...]] = ("at",)
    at: Vector
    vector: Vector
    text: str = ""


@dataclass(frozen=True)
class LoadForm(Form):
    """A force per length along the line from a to b, linear [N/m]."""

    kind: ClassVar[str] = "load"
    spots: ClassVar[tuple[str, ...]] = ("a", "b", "at_a", "at_b")
    a: Vector
    b: Vector
    at_a: Vector
    at_b: Vector
    text: str = ""


@dataclass(frozen=True)
class DimensionForm(Form):
    """A dimension line parallel to the line from a to b, with the name of the length.

    Args:
        tier: distance from the line [symbol units].
    """

    kind: ClassVar[str] = "dimension"
    spots: ClassVar[tuple[str, ...]] = ("a", "b")
    a: Vector
    b: Vector
    text: str
    tier: int = 3


@dataclass(frozen=True)
class AngleForm(Form):
    """The arc of an angle, from one direction to another, with its name [rad from x]; `tier`: its radius."""

    kind: ClassVar[str] = "angle"
    spots: ClassVar[tuple[str, ...]] = ("at",)
    at: Vector
    start: Any
    end: Any
    text: str
    tier: int = 4


@dataclass(frozen=True)
class FieldForm(Form):
    """A uniform field of accelerations: an arrow in the corner of the picture, of one length."""

    kind: ClassVar[str] = "field"
    spots: ClassVar[tuple[str, ...]] = ("vector",)
    vector: Vector
    text: str


@dataclass(frozen=True)
class AxesForm(Form):
    """The axes x, y, in space z."""

    kind: ClassVar[str] = "axes"
    spots: ClassVar[tuple[str, ...]] = ("at",)
    at: Vector


ALL: tuple[type[Form], ...] = (
    LineForm,
    PolygonForm,
    ArcForm,
    BoxForm,
    EllipsoidForm,
    RevolutionForm,
    PrismForm,
    PolyhedronForm,
    RodForm,
    SpringForm,
    DamperForm,
    CylinderForm,
    WheelForm,
    TrackForm,
    SymbolForm,
    PointForm,
    LabelForm,
    ArrowForm,
    CoupleForm,
    LoadForm,
    DimensionForm,
    AngleForm,
    FieldForm,
    AxesForm,
)


# -------- symbols ----------------------------------------------------------------------------------------------
# Symbols of joints and supports, as the field draws them: forms in symbol units.
#
# In the plane x is to the right and y up; what lies under a support is its ground. In space z is the joint's axis.

TEETH = 8  # of a spring

SymbolParts = tuple[tuple[str, Form], ...]
"""(role, form): "joint" is filled with paper, "solid" with ink, "ground" is a thin line, "drive" is green."""


def _exact(x: float) -> Fraction:
    """A number of a symbol, to three places."""
    return Fraction(round(1000 * x), 1000)


def _line(*points: tuple[float, float]) -> Form:
    return LineForm(_spots(points))


def _spots(points: Iterable[tuple[float, float]]) -> tuple[Vector, ...]:
    return tuple(Vector((_exact(x), _exact(y), 0)) for x, y in points)


def _polygon(*points: tuple[float, float]) -> Form:
    return PolygonForm(_spots(points))


def _circle(x: float, y: float, radius: float) -> Form:
    r = _exact(radius)
    return ArcForm(Vector((_exact(x), _exact(y), 0)), r, r, close="chord")


def _square(half: float) -> Form:
    return _polygon((-half, -half), (half, -half), (half, half), (-half, half))


def hatched(y: float, half: float = 1.7, sense: int = -1) -> SymbolParts:
    """A line with hatching on its far side."""
    strokes = [round(-half + 0.2 + 0.6 * k, 3) for k in range(int((2 * half - 0.2) / 0.6) + 1)]
    lines = [_line((x, y), (round(x - 0.5, 3), round(y + sense * 0.6, 3))) for x in strokes]
    return (("ground", _line((-half, y), (half, y))), *(("ground", line) for line in lines))


def _spiral() -> Form:
    """Two turns."""
    angles = [math.tau * k / 16 for k in range(33)]
    return _line(*((round(r * math.cos(a), 3), round(r * math.sin(a), 3)) for a in angles for r in (0.5 + 0.09 * a,)))


def _bow(radius: float) -> Form:
    """An arc above the place."""
    angles = [math.radians(30 + 5 * k) for k in range(23)]
    return _line(*((radius * math.cos(a), radius * math.sin(a)) for a in angles))


def _head(radius: float, angle: float) -> Form:
    """Head of an arrow that runs counter-clockwise round the place, its tip at an angle."""
    back = angle - 0.6 / radius
    ends = [(r * math.cos(back), r * math.sin(back)) for r in (radius + 0.35, radius - 0.35)]
    tip = (radius * math.cos(angle + 0.25), radius * math.sin(angle + 0.25))
    return _polygon(tip, *ends)


HINGE: SymbolParts = (("joint", _circle(0, 0, 0.42)),)
WHEELS = tuple(("joint", _circle(x, -1.7, 0.28)) for x in (-0.55, 0.55))
PLANE: dict[str, SymbolParts] = {
    "hinge": HINGE,
    "weld": (("solid", _square(0.4)),),
    "pin": (("joint", _polygon((0, 0), (-1, -1.7), (1, -1.7))), *hatched(-1.7), *HINGE),
    "roller": (("joint", _polygon((0, 0), (-1, -1.4), (1, -1.4))), *WHEELS, *hatched(-2.0), *HINGE),
    "clamp": (("solid", _polygon((-0.9, -0.35), (0.9, -0.35), (0.9, 0.35), (-0.9, 0.35))), *hatched(-0.35)),
    "slider": (("joint", _polygon((-0.9, -0.5), (0.9, -0.5), (0.9, 0.5), (-0.9, 0.5))), *HINGE),
    "block": (("joint", _polygon((-1.1, -0.6), (1.1, -0.6), (1.1, 0.6), (-1.1, 0.6))),),
    "coil": (("ground", _spiral()),),
    "shoes": tuple(("solid", _polygon((x, -0.8), (x + 0.5, -0.8), (x + 0.5, 0.8), (x, 0.8))) for x in (-2.2, 1.7)),
    "plates": tuple(("solid", _polygon((x, 0.9), (x + 0.25, 0.9), (x + 0.25, 2.3), (x, 2.3))) for x in (-0.4, 0.15)),
    "wall": hatched(0, 1.4),
    "turned": (("drive", _bow(1.7)), ("drive", _head(1.7, math.radians(150)))),
    "shifted": (("drive", _line((-1.6, 1.5), (1.0, 1.5))), ("drive", _polygon((1.9, 1.5), (0.8, 1.85), (0.8, 1.15)))),
    "rotor": (("body", _circle(0, 0, 2.6)), ("body", _line((0.42, 0), (2.6, 0)))),
    "blade": (("joint", _polygon((-1.6, 0), (-1, 0.3), (1, 0.3), (1.6, 0), (1, -0.3), (-1, -0.3))),),
}


def _ball(radius: float) -> Form:
    r = _exact(radius)
    return EllipsoidForm(Vector.ZERO, Vector((r, r, r)))


def _drum(radius: float, half: float) -> Form:
    r, h = _exact(radius), _exact(half)
    return RevolutionForm(Vector.ZERO, ((0, -h), (r, -h), (r, h), (0, h)), (r,))


def _block(x: float, y: float, z: float) -> Form:
    return BoxForm(Vector.ZERO, Vector((_exact(x), _exact(y), _exact(z))))


def _ring(inner: float, outer: float, half: float) -> Form:
    r, R, h = map(_exact, (inner, outer, half))
    return RevolutionForm(Vector.ZERO, ((r, -h), (R, -h), (R, h), (r, h), (r, -h)), (r,))


def _pins(near: float, far: float) -> SymbolParts:
    """Both ends of a shaft along z."""
    ends = [(_exact(sign * near), _exact(sign * far)) for sign in (1, -1)]
    return tuple(("body", LineForm((Vector((0, 0, a)), Vector((0, 0, b))))) for a, b in ends)


SPACE: dict[str, SymbolParts] = {
    "hinge": (("joint", _drum(0.4, 1.1)),),
    "ball": (("joint", _ball(0.6)),),
    "weld": (("solid", _block(0.8, 0.8, 0.8)),),
    "shoes": (("solid", _block(4.2, 0.7, 0.7)),),
    "plates": (("solid", _ring(1.2, 2.2, 0.2)),),
    "slider": (("joint", _block(1.0, 1.0, 2.4)),),
    "tube": (("joint", _drum(0.6, 1.6)),),
    "coil": (("ground", _spiral()),),
    "cross": (("joint", _drum(0.25, 1.2)), ("joint", _block(2.4, 0.5, 0.5))),
    "shaft": (
        ("body", RevolutionForm(Vector.ZERO, ((0, 1), (_exact(0.5), 1), (_exact(0.5), 8), (0, 8)), (_exact(0.5),))),
    ),
    "rotor": (("body", _drum(2.6, 0.4)),),
    "ring": (("body", _ring(3.7, 4.1, 0.3)),),
    "outer_ring": (("body", _ring(5.1, 5.5, 0.3)),),
    "rotor_pins": _pins(0.4, 3.7),
    "ring_pins": _pins(4.1, 5.1),
    "outer_ring_pins": _pins(5.5, 6.5),
}


def symbols_used(marks: Iterable[Any], plane: bool) -> dict[str, SymbolParts]:
    """The symbols of marks by their names, in the order of the table."""
    names = {mark.form.symbol for mark in marks}
    return {name: parts for name, parts in (PLANE if plane else SPACE).items() if name in names}
