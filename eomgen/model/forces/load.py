"""Loads that force laws give: forces at points, couples on bodies, and generalized forces."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any, Protocol

from eomgen.frozen import dataclass
from eomgen.symbolic.expression import Matrix, Scalar, Twist, Vector, Wrench

BodyPoint = tuple["str | None", Vector]
"""(body, position in its axes); the body None is the ground."""


@dataclass(frozen=True)
class PointForce:
    """A force on a body at a place of it; `axes` names the body in whose axes it is written, None the ground's [N].

    What touches beyond the place, by `beyond` in ground axes, has its moment as a separate couple of the same `beyond`.
    """

    place: BodyPoint
    force: Vector
    axes: str | None = None
    beyond: Vector | None = None

    def times(self, k: Scalar) -> PointForce:
        return PointForce(self.place, k * self.force, self.axes, self.beyond)


@dataclass(frozen=True)
class Couple:
    """A couple on a body; `axes` names the body in whose axes it is written, None the ground's [N m].

    The place matters inside the body alone: `place` is None where nobody said it. One that is the moment of a force
    that acts beyond its place says by how much.
    """

    body: str
    couple: Vector
    axes: str | None = None
    place: BodyPoint | None = None
    beyond: Vector | None = None

    def times(self, k: Scalar) -> Couple:
        return Couple(self.body, k * self.couple, self.axes, self.place, self.beyond)


@dataclass(frozen=True)
class GeneralizedForce:
    """A generalized force along a coordinate."""

    coordinate: str
    value: Scalar


@dataclass(frozen=True)
class UniformField:
    """An acceleration field that acts on every mass of the model: a weight m g at every mass centre [m/s^2]."""

    acceleration: Vector


@dataclass(frozen=True)
class SpreadLoad:
    """A force per length on a body along the straight line between two places of it, linear, ground axes [N/m]."""

    start: BodyPoint
    end: BodyPoint
    at_start: Vector
    at_end: Vector


Push = PointForce | Couple
Load = PointForce | Couple | GeneralizedForce | UniformField
Fluid = tuple[BodyPoint, Twist, Wrench]
"""(place, velocity v of it in the fluid and spin w, momentum p = dT/dv and L = dT/dw), in the axes of the body"""


class LoadContext(Protocol):
    """Quantities of the system that a force law may use, over any scalar."""

    def value(self, expression: Any) -> Scalar: ...
    def value_at(self, expression: Any, also: dict[str, Scalar]) -> Scalar: ...
    def primitive(self, expression: Any, name: str, at: Scalar) -> Scalar | None: ...
    def vector(self, expressions: Any) -> Vector: ...
    def place(self, point: str) -> BodyPoint: ...
    def position(self, place: BodyPoint) -> Vector: ...
    def velocity(self, place: BodyPoint) -> Vector: ...
    def orientation(self, body: str) -> Matrix: ...
    def angle(self, body: str) -> Scalar: ...
    def spin(self, body: str) -> Vector: ...
    def angle_rate(self, body: str) -> Scalar: ...
    def slopes(self, law: Any, values: Mapping[Any, Scalar | None]) -> tuple[Scalar, tuple[Scalar, ...]]: ...
    def held_rate(self, law: Any, values: Mapping[Any, Scalar]) -> Scalar: ...
    def turn_of_joint(self, body: str) -> tuple[Scalar, Vector, str | None]: ...
    def along_joint(self, body: str, variable: int) -> tuple[Scalar, Vector, Vector, BodyPoint, BodyPoint, Vector]: ...
    def masses(self, bodies: tuple[str, ...] | None) -> tuple[tuple[BodyPoint, Scalar], ...]: ...
    def strands(self, path: tuple[Any, ...]) -> tuple[Any, ...]: ...
    def rate(self, scalar: Scalar) -> Scalar: ...
    def unsaid_rate(self, body: str) -> Scalar: ...
    def start(self, scalar: Scalar) -> Scalar: ...
    def ground_place(self, at: Any) -> Vector: ...
    def own_place(self, body: str, point: str | None) -> BodyPoint: ...
    def line(self, body: str) -> tuple[BodyPoint, BodyPoint]: ...
    def radius(self, body: str) -> Scalar: ...
    def shape(self, body: str) -> Any: ...
    def moves(self, scalars: tuple[Scalar, ...]) -> bool: ...
    def vanishes(self, scalar: Scalar) -> bool: ...
    def value_at_start(self, scalar: Scalar) -> float | None: ...
    def readable(self, scalars: tuple[Scalar, ...]) -> tuple[Scalar, ...]: ...
    def carrier_of(self, first: str | None, second: str | None) -> str | None: ...
    def seen_from(self, body: str | None) -> LoadContext: ...

    @property
    def where(self) -> str: ...

    @property
    def plane(self) -> bool: ...
