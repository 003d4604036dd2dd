"""Weights and line loads."""

from collections.abc import Iterator
from typing import ClassVar

from eomgen.errors import ModelError
from eomgen.frozen import dataclass
from eomgen.model.forces.base import Act, Force, ForceTrial
from eomgen.model.forces.load import Load, LoadContext, PointForce, SpreadLoad, UniformField
from eomgen.model.kinds import Acceleration, Bodies, BodyName, Flag, LineLoad, TwoLineLoads, TwoOwnPoints
from eomgen.symbolic.expression import Expression, Fraction, Scalar, Vector, is_zero, sqrt

# -------- gravity ---------------------------------------------------------------------------------------------
# Gravity: a weight on every body, or on some.


@dataclass(frozen=True, kw_only=True)
class Gravity(Force):
    """A weight on all bodies, or on those of the list: m g at the mass centre of each, V = - m g . r.

    Args:
        acceleration: g, ground axes, 2 or 3 [m/s^2].
        bodies: on which it acts (None: all).
        axis_down: the last axis (y, in space z) points down: else a weight along it is warned of.
    """

    kind: ClassVar[str] = "gravity"
    by_mass: ClassVar[bool] = True
    acceleration: Acceleration
    bodies: Bodies | None = None
    axis_down: Flag = False

    @property
    def uniform(self) -> tuple[Expression, ...] | None:
        return self.acceleration if self.bodies is None else None

    def acts(self, here: ForceTrial) -> Iterator[Act]:
        g = here.directed(self.acceleration)
        for body, m, center in here.masses(self.bodies):
            yield Act(body, center, m * g)

    def loads(self, scene: LoadContext) -> tuple[Load, ...]:
        """A uniform field, or m g at the mass centre of each named body."""
        g = scene.vector(self.acceleration)
        if self.bodies is None:
            return (UniformField(g),)
        return tuple(PointForce(place, m * g) for place, m in scene.masses(self.bodies))

    def potential(self, scene: LoadContext) -> Scalar | None:
        """V = - sum m g . r"""
        g = scene.vector(self.acceleration)
        V: Scalar = 0
        for place, m in scene.masses(self.bodies):
            V = V - m * (g @ scene.position(place))
        return V


# -------- distributed -----------------------------------------------------------------------------------------
# Distributed: a line load between two points of a body.


@dataclass(frozen=True, kw_only=True)
class Distributed(Force):
    """A load spread along the line from A to B, constant or linear.

    Args:
        body: on which it acts.
        between: the names of A and B, points of this body (or `body.A`).
        intensity: force per length, constant, ground axes, 2 or 3 [N/m].
        intensities: at A and at B instead.
    """

    kind: ClassVar[str] = "distributed"
    one_of: ClassVar[tuple[str, ...]] = ("intensity", "intensities")
    body: BodyName
    between: TwoOwnPoints
    intensity: LineLoad | None = None
    intensities: TwoLineLoads | None = None

    def acts(self, here: ForceTrial) -> Iterator[Act]:
        """Forces that replace it by Simpson's rule, at both ends and in the middle."""
        (_, A), (_, B) = (here.place(_own(self.body, name)) for name in self.between)
        q_A, q_B = (here.directed(q) for q in self.intensities or (self.intensity, self.intensity) if q is not None)
        way = here.vector(B) - here.vector(A)
        sixth = here.function("sqrt", way @ way) / 6
        yield Act(self.body, A, sixth * q_A)
        yield Act(self.body, Fraction(1, 2) * (A + B), sixth * 2 * (q_A + q_B))
        yield Act(self.body, B, sixth * q_B)

    def loads(self, scene: LoadContext) -> tuple[Load, ...]:
        """Forces (2 q_A + q_B) L / 6 at A and (q_A + 2 q_B) L / 6 at B: the same resultant and moment as the load."""
        (line,) = self.spread(scene)
        length = _length(line)
        return (
            PointForce(line.start, _resultant(length, line.at_start, line.at_end)),
            PointForce(line.end, _resultant(length, line.at_end, line.at_start)),
        )

    def spread(self, scene: LoadContext) -> tuple[SpreadLoad, ...]:
        """q_A at A, q_B at B, linear between.

        Raises:
            ModelError: A and B are at one place.
        """
        a, b = (scene.place(_own(self.body, name)) for name in self.between)
        q_A, q_B = (scene.vector(q) for q in self.intensities or (self.intensity, self.intensity))
        line = SpreadLoad(a, b, q_A, q_B)
        length = _length(line)
        if is_zero(length) or scene.value_at_start(length) == 0:
            ends = " and ".join(f"'{name}'" for name in self.between)
            raise ModelError(
                f"{ends} are at one place: a load along a line needs a length",
                scene.where,
                "name two points, or put a force there",
            )
        return (line,)


def _length(line: SpreadLoad) -> Scalar:
    along = line.end[1] - line.start[1]
    return sqrt(along @ along)


def _resultant(length: Scalar, near: Vector, far: Vector) -> Vector:
    """L (2 q_near + q_far) / 6"""
    return length * Fraction(1, 6) * (2 * near + far)


def _own(body: str, name: str) -> str:
    return name if "." in name else f"{body}.{name}"
