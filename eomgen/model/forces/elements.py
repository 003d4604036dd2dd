"""Springs, dampers and pulls along the line between two points."""

from typing import ClassVar

from eomgen.errors import DerivationError
from eomgen.frozen import dataclass
from eomgen.model.forces.base import Element, Force
from eomgen.model.forces.load import BodyPoint, Load, LoadContext, PointForce
from eomgen.model.kinds import Direction, LinearDamping, LinearStiffness, NaturalLength, Pull, TwoPoints
from eomgen.symbolic.expression import Expression, Fraction, Scalar, Vector, is_zero, over, sqrt

# -------- reach -----------------------------------------------------------------------------------------------
# From one point to another: distance, direction and rate, for whatever acts along a line.


@dataclass(frozen=True)
class Reach:
    """The line from one point to another.

    Args:
        ends: the two points.
        gap: from the first to the second, ground axes [m].
        length: their distance, or the component along a fixed direction [m].
        direction: unit vector from the first to the second, ground axes.
        rate: of the length [m/s].
    """

    ends: tuple[BodyPoint, BodyPoint]
    gap: Vector
    length: Scalar
    direction: Vector
    rate: Scalar

    def pulled(self, tension: Scalar) -> tuple[Load, ...]:
        """Equal and opposite forces that draw the ends together [N]."""
        return self._opposite(tension * self.direction)

    def pulled_by_length(self, stiffness: Scalar) -> tuple[Load, ...]:
        """The same for a tension k l, which has a value where the ends meet too: k times the gap."""
        return self._opposite(stiffness * self.gap)

    def _opposite(self, pull: Vector) -> tuple[Load, ...]:
        return (PointForce(self.ends[0], pull), PointForce(self.ends[1], -pull))


def reach(scene: LoadContext, points: tuple[str, ...], along: tuple[Expression, ...] | None = None) -> Reach:
    """The line between two points: l = |p2 - p1|, or n . (p2 - p1) along a fixed direction n."""
    ends = (scene.place(points[0]), scene.place(points[1]))
    gap = scene.position(ends[1]) - scene.position(ends[0])
    rate = scene.velocity(ends[1]) - scene.velocity(ends[0])
    if along is None:
        length = sqrt(gap @ gap)
        if is_zero(length):
            raise DerivationError(
                f"'{points[0]}' and '{points[1]}' are always at one place: there is no line between them",
                fix="let the force act between points that part, or give its direction by `along`",
            )
        direction = Vector(over(x, length) for x in gap)
    else:
        n = scene.vector(along)
        size = sqrt(n @ n)
        direction = Vector(over(x, size) for x in n)
        length = gap @ direction
    return Reach(ends, gap, length, direction, rate @ direction)


# -------- straight --------------------------------------------------------------------------------------------
# Attraction of two points by a law of the line between them: springs, dampers, pulls.


@dataclass(frozen=True, kw_only=True)
class Straight(Force):
    """A force between two points along the line between them, or along a fixed direction."""

    points: TwoPoints

    def law(self, scene: LoadContext, line: Reach) -> Scalar:
        """The law, attraction positive [N]."""
        raise NotImplementedError

    def by_length(self, scene: LoadContext, line: Reach) -> Scalar | None:
        """k of a law k l along the line between the points, which has no direction where these meet; else None."""
        return None

    def effort(self, scene: LoadContext) -> Scalar | None:
        """The pull [N]."""
        return self.law(scene, self.line(scene))

    def loads(self, scene: LoadContext) -> tuple[Load, ...]:
        """The pull on the first point, its opposite on the second."""
        line = self.line(scene)
        k = self.by_length(scene, line)
        return line.pulled(self.law(scene, line)) if k is None else line.pulled_by_length(k)

    def line(self, scene: LoadContext) -> Reach:
        """The line between the points."""
        assert self.element is not None, "a law of this kind acts between two points"
        return reach(scene, self.points, self.element.along)


# -------- spring ----------------------------------------------------------------------------------------------
# Spring: between two points.


@dataclass(frozen=True, kw_only=True)
class Spring(Straight):
    """A straight spring: V = k (l - l0)^2 / 2, l the distance of its points.

    Args:
        points: its two ends.
        stiffness: k [N/m].
        length: natural length l0 [m], or "start": the distance at the start at which all constraints hold.
        along: a fixed direction along which the stretch is measured instead, ground axes, 2 or 3.
    """

    kind: ClassVar[str] = "spring"
    elastic: ClassVar[bool] = True
    stiffness: LinearStiffness
    length: NaturalLength
    along: Direction | None = None

    @property
    def element(self) -> Element:
        return Element(points=self.points, along=self.along, stiffness=self.stiffness, slack=self.length)

    def law(self, scene: LoadContext, line: Reach) -> Scalar:
        """k (l - l0)"""
        return scene.value(self.stiffness) * self._stretch(scene, line.length)

    def by_length(self, scene: LoadContext, line: Reach) -> Scalar | None:
        """k where l0 = 0"""
        free = self.along is None and is_zero(self._natural(scene, line.length))
        return scene.value(self.stiffness) if free else None

    def potential(self, scene: LoadContext) -> Scalar | None:
        """V = k (l - l0)^2 / 2"""
        stretch = self._stretch(scene, self.line(scene).length)
        return Fraction(1, 2) * scene.value(self.stiffness) * stretch * stretch

    def _stretch(self, scene: LoadContext, length: Scalar) -> Scalar:
        return length - self._natural(scene, length)

    def _natural(self, scene: LoadContext, length: Scalar) -> Scalar:
        return scene.start(length) if self.length == "start" else scene.value(self.length)


# -------- damper ----------------------------------------------------------------------------------------------
# Damper: between two points.


@dataclass(frozen=True, kw_only=True)
class Damper(Straight):
    """A straight damper: pull c l', l the distance of its points.

    Args:
        points: its two ends.
        damping: c [N s/m].
        along: a fixed direction along which the rate is measured instead, ground axes, 2 or 3.
    """

    kind: ClassVar[str] = "damper"
    damping: LinearDamping
    along: Direction | None = None

    @property
    def element(self) -> Element:
        return Element(points=self.points, along=self.along, damping=self.damping)

    def law(self, scene: LoadContext, line: Reach) -> Scalar:
        """c l'"""
        return scene.value(self.damping) * line.rate


# -------- between ---------------------------------------------------------------------------------------------
# Between: a pull between two points as a law of their distance.


@dataclass(frozen=True, kw_only=True)
class Between(Straight):
    """A force between two points by a law f(r, r') of their distance r; attraction positive [N].

    Args:
        points: the two points.
        pull: the law; `r` and `r'` mean the distance and its rate here.
    """

    kind: ClassVar[str] = "between"
    pull: Pull

    @property
    def element(self) -> Element:
        return Element(points=self.points, pull=self.pull)

    def law(self, scene: LoadContext, line: Reach) -> Scalar:
        """f(r, r')"""
        return scene.value_at(self.pull, {"r": line.length, "r'": line.rate})

    def potential(self, scene: LoadContext) -> Scalar | None:
        """V = integral of f dr where f holds r and parameters only; None where it has no closed form."""
        return scene.primitive(self.pull, "r", self.line(scene).length)
