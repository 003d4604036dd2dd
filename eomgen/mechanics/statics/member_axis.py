"""Motion, body -> MemberAxis: the line of straight legs along which a body is a beam, with distances along it.

It is the body's `line` where it has one; else the line through its points where they all lie on one, from left to
right in the body's axes, or upwards; else from point to point in the order of their declaration, without those that
lie on the way.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import field
from itertools import pairwise
from typing import Any

from eomgen.errors import DerivationError
from eomgen.frozen import dataclass
from eomgen.mechanics.kinematics import Motion
from eomgen.symbolic.exact import readable, readable_all, sign_of_terms, simplest, vanishes
from eomgen.symbolic.expression import Graph, Node, Scalar, Vector, is_zero, over, sqrt, substituted, symbols_of
from eomgen.symbolic.numeric import Work, evaluate, fifty_digits, tolerances


@dataclass(frozen=True)
class Sizes:
    """Comparison of scalars: for all positive parameters where possible, else at the model's values.

    Args:
        positive: parameters that stand for positive numbers.
        values: those that have a value, with 50 digits.
        at: values put in for coordinates.
        graph: of the system.
    """

    graph: Graph
    positive: frozenset[Node]
    values: Mapping[Node, Any]
    at: Mapping[Node, Scalar] = field(default_factory=dict)

    def simple(self, x: Scalar) -> Scalar:
        """A scalar multiplied out, with the known values of coordinates put in."""
        if type(x) is not Node:
            return x
        return readable(substituted((x,), self.at)[0] if self.at else x, Work.VALUE, self.positive)

    def shortest(self, x: Scalar) -> Scalar:
        """A scalar as a person writes it."""
        return simplest(x, Work.VALUE, self.positive)

    def sign(self, x: Scalar) -> int:
        """1, 0 or -1.

        Raises:
            DerivationError: it depends on parameters without a value.
        """
        if type(x) is not Node:
            return (x > 0) - (x < 0)
        x = self.simple(x)
        found = sign_of_terms(x, self.positive)
        if found is not None:
            return found
        names = sorted(node.name for node in symbols_of((x,)) if node not in self.values)
        if names:
            fix = "give them values, or call them positive where that decides it"
            raise DerivationError(f"what comes first along the line depends on {', '.join(names)}", "parameters", fix)
        value = evaluate((x,), self.values, fifty_digits())[0]
        return 0 if abs(value) < tolerances.CERTAIN_AT_50 else 1 if value > 0 else -1


def sizes_of(motion: Motion, at: Mapping[Node, Scalar] | None = None) -> Sizes:
    """Sizes at the model's values."""
    scope = motion.scope
    return Sizes(scope.graph, scope.positive, scope.values_of_parameters(None), at or {})


@dataclass(frozen=True)
class Leg:
    """A straight part of the axis.

    Args:
        start: where it begins, body axes [m].
        along: its direction, of unit length.
        length: of it [m].
        x: of its start, along the axis [m].
    """

    start: Vector
    along: Vector
    length: Scalar
    x: Scalar

    @property
    def left(self) -> Vector:
        """The normal to the left of it."""
        return Vector((-self.along[1], self.along[0], 0))

    def place(self, x: Scalar) -> Vector:
        """Position at the distance x along the axis, body axes."""
        return self.start + (x - self.x) * self.along


@dataclass(frozen=True)
class MemberAxis:
    """The axis of a body.

    Args:
        body: its name.
        legs: one after the other; x of the first start is 0.
        ends: (x of the first place of the body on the axis, of the last): before 0 what stands out behind the start.
    """

    body: str
    legs: tuple[Leg, ...]
    ends: tuple[Scalar, Scalar]
    sizes: Sizes

    @property
    def is_straight(self) -> bool:
        return len(self.legs) == 1

    def distance(self, place: Vector) -> Scalar | None:
        """x of a place, None where it is not on the axis."""
        for k, leg in enumerate(self.legs):
            r = place - leg.start
            if not _is_along(leg.along, r, self.sizes):
                continue
            s = self.sizes.simple(leg.along @ r)
            before = self.sizes.sign(s) >= 0 or (k == 0 and self.is_straight)
            if before and (self.is_straight or self.sizes.sign(leg.length - s) >= 0):
                return self.sizes.simple(leg.x + s)
        return None


def axis_of(motion: Motion, body: str, acting: Sequence[Vector], sizes: Sizes) -> MemberAxis:
    """The axis of a body.

    Args:
        acting: the places at which forces act on it, body axes.
    Raises:
        DerivationError: it has no two places.
    """
    part, points = motion.scope.model.bodies[body], motion.points[body]
    named = [points[name.rpartition(".")[2]] for name in part.line or _own_points(part)]
    places = _distinct(named if part.line else [*named, *_at_origin(acting), *acting], sizes)
    if len(places) < 2:
        raise DerivationError(
            f"body '{body}' has no line along which it could be a beam",
            f"bodies.{body}",
            'give it points, or line = ["A", "B"]',
        )
    vertices = _distinct(named, sizes)
    if part.line or not _on_one_line(places, sizes):
        vertices = _corners(vertices if part.line else _distinct([*_at_origin(acting), *named], sizes), sizes)
    else:
        vertices = _extremes(places, vertices, sizes)
    return _with_ends(body, _legs(vertices, sizes), acting, sizes)


def _own_points(part: Any) -> list[str]:
    """The points by which a body is laid out: those declared, or the ends of its rod."""
    shape = [] if part.shape is None else [name for name in part.shape.point_names if name in ("start", "end")]
    return [*shape, *part.points]


def _at_origin(acting: Sequence[Vector]) -> list[Vector]:
    """The origin, where something acts there."""
    return [Vector.ZERO] if any(all(is_zero(x) for x in place) for place in acting) else []


def _distinct(places: Sequence[Vector], sizes: Sizes) -> list[Vector]:
    found: list[Vector] = []
    for place in places:
        if not any(all(vanishes(sizes.simple(x)) for x in place - other) for other in found):
            found.append(place)
    return found


def _is_along(along: Vector, r: Vector, sizes: Sizes) -> bool:
    """True if a vector is parallel to a direction."""
    return all(vanishes(sizes.simple(x)) for x in along.cross(r))


def _on_one_line(places: Sequence[Vector], sizes: Sizes) -> bool:
    along = places[1] - places[0]
    return all(_is_along(along, p - places[0], sizes) for p in places[2:])


def _extremes(places: Sequence[Vector], named: Sequence[Vector], sizes: Sizes) -> list[Vector]:
    """The first and the last place along the line, from left to right in the body's axes, else upwards."""
    first, last = (named[0], named[-1]) if len(named) > 1 else (places[0], places[1])
    along = last - first
    if (sizes.sign(along[0]) or sizes.sign(along[1]) or sizes.sign(along[2])) < 0:
        along = -along
    lowest = highest = first
    for place in places:
        if sizes.sign(along @ (place - lowest)) < 0:
            lowest = place
        if sizes.sign(along @ (place - highest)) > 0:
            highest = place
    return [lowest, highest]


def _corners(places: Sequence[Vector], sizes: Sizes) -> list[Vector]:
    """The places in their order, those left out that lie on the way, or on a leg before."""
    corners = list(places[:2])
    for place in places[2:]:
        if any(_lies_between(place, a, b, sizes) for a, b in pairwise(corners)):
            continue
        if _lies_between(corners[-1], corners[-2], place, sizes):
            corners[-1] = place
        else:
            corners.append(place)
    return corners


def _lies_between(place: Vector, a: Vector, b: Vector, sizes: Sizes) -> bool:
    along, r = b - a, place - a
    if not _is_along(along, r, sizes):
        return False
    s = along @ r
    return sizes.sign(s) >= 0 and sizes.sign(along @ along - s) >= 0


def _legs(corners: Sequence[Vector], sizes: Sizes) -> tuple[Leg, ...]:
    legs: list[Leg] = []
    x: Scalar = 0
    for a, b in pairwise(corners):
        r = readable_all(b - a, Work.VALUE, sizes.positive)
        length = sizes.simple(sqrt(sizes.simple(Vector(r) @ Vector(r))))
        along = Vector(sizes.simple(over(component, length)) for component in r)
        legs.append(Leg(a, along, length, x))
        x = sizes.simple(x + length)
    return tuple(legs)


def _with_ends(body: str, legs: tuple[Leg, ...], acting: Sequence[Vector], sizes: Sizes) -> MemberAxis:
    """The axis, lengthened on both sides to all that acts on it where it is straight."""
    last = legs[-1]
    axis = MemberAxis(body, legs, (0, sizes.simple(last.x + last.length)), sizes)
    first, end = axis.ends
    for place in acting if axis.is_straight else ():
        x = axis.distance(place)
        if x is not None:
            first = x if sizes.sign(x - first) < 0 else first
            end = x if sizes.sign(x - end) > 0 else end
    return MemberAxis(body, legs, (first, end), sizes)
