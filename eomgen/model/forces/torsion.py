"""Torsion springs and dampers between two bodies."""

from collections.abc import Callable
from typing import ClassVar

from eomgen.frozen import dataclass
from eomgen.model.forces.base import Element, Force
from eomgen.model.forces.load import Couple, Load, LoadContext
from eomgen.model.kinds import AngularDamping, AngularStiffness, BodyName, RestAngle, TwoBodies
from eomgen.symbolic.expression import Fraction, Scalar, Vector

# -------- turning ---------------------------------------------------------------------------------------------
# Couples between two bodies, or a body and the ground: torsion springs and dampers.


@dataclass(frozen=True, kw_only=True)
class Turning(Force):
    """A couple about z by a law of the angle between two bodies, or between a body and the ground's axes."""

    one_of: ClassVar[tuple[str, ...]] = ("bodies", "body")
    bodies: TwoBodies | None = None
    body: BodyName | None = None

    def couple(self, scene: LoadContext) -> Scalar:
        """The law, on the second body, or on `body` [N m]."""
        raise NotImplementedError

    def effort(self, scene: LoadContext) -> Scalar | None:
        """The couple [N m]."""
        return self.couple(scene)

    def loads(self, scene: LoadContext) -> tuple[Load, ...]:
        """The couple on the second body, its opposite on the first."""
        first, second = self._both
        couple = self.couple(scene)
        on_first = () if first is None else (Couple(first, Vector((0, 0, -couple))),)
        return (Couple(second, Vector((0, 0, couple))), *on_first)

    def relative(self, of: Callable[[str], Scalar]) -> Scalar:
        """An angle, or its rate, of the second body against the first."""
        first, second = self._both
        return of(second) if first is None else of(second) - of(first)

    @property
    def _both(self) -> tuple[str | None, str]:
        """The first body, None of the ground, and the second."""
        if self.bodies is not None:
            return self.bodies[0], self.bodies[1]
        assert self.body is not None, "one of both is given"
        return None, self.body


# -------- torsion spring --------------------------------------------------------------------------------------
# Torsion spring: between two bodies, or a body and the ground.


@dataclass(frozen=True, kw_only=True)
class TorsionSpring(Turning):
    """A torsion spring: V = k (theta - rest)^2 / 2; in space put it into the joint.

    Args:
        bodies: theta is the angle of the second against the first.
        body: alone: theta is its angle against the ground's axes.
        stiffness: k [N m].
        rest: the angle at which it is slack (None: 0) [rad].
    """

    kind: ClassVar[str] = "torsion_spring"
    elastic: ClassVar[bool] = True
    stiffness: AngularStiffness
    rest: RestAngle | None = None

    @property
    def element(self) -> Element:
        return Element(bodies=self.bodies or (None, self.body), stiffness=self.stiffness, slack=self.rest)

    def couple(self, scene: LoadContext) -> Scalar:
        """- k (theta - rest)"""
        return -scene.value(self.stiffness) * self._twist(scene)

    def potential(self, scene: LoadContext) -> Scalar | None:
        """V = k (theta - rest)^2 / 2"""
        twist = self._twist(scene)
        return Fraction(1, 2) * scene.value(self.stiffness) * twist * twist

    def _twist(self, scene: LoadContext) -> Scalar:
        return self.relative(scene.angle) - scene.value(self.rest)


# -------- torsion damper --------------------------------------------------------------------------------------
# Torsion damper: between two bodies, or a body and the ground.


@dataclass(frozen=True, kw_only=True)
class TorsionDamper(Turning):
    """A torsion damper: couple - c theta'; in space put it into the joint.

    Args:
        bodies: theta is the angle of the second against the first.
        body: alone: theta is its angle against the ground's axes.
        damping: c [N m s].
    """

    kind: ClassVar[str] = "torsion_damper"
    damping: AngularDamping

    @property
    def element(self) -> Element:
        return Element(bodies=self.bodies or (None, self.body), damping=self.damping)

    def couple(self, scene: LoadContext) -> Scalar:
        """- c theta'"""
        return -scene.value(self.damping) * self.relative(scene.angle_rate)
