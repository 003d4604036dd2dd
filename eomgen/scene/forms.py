"""Every kind of thing that a picture is made of: `ALL` is the table that drawers follow.

The forms of shapes are in the modules of the shapes; here are those of joints, forces, labels and dimensions.
"""

from __future__ import annotations

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
from eomgen.symbolic.expression import Vector


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
