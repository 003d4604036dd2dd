"""Applied forces, couples, and forces along coordinates."""

from collections.abc import Iterator
from typing import ClassVar

from eomgen.frozen import dataclass
from eomgen.model.forces import load
from eomgen.model.forces.base import Act, Force, ForceTrial
from eomgen.model.forces.load import GeneralizedForce, Load, LoadContext
from eomgen.model.kinds import (
    AxesName,
    BodyName,
    CoordinateName,
    CoupleFormula,
    ForceVector,
    OwnPointName,
    PointName,
    WorkingForce,
)
from eomgen.symbolic.expression import Scalar, Vector

# -------- force -----------------------------------------------------------------------------------------------
# Force: at a point.


@dataclass(frozen=True, kw_only=True)
class PointForce(Force):
    """A force at a point of a body.

    Args:
        point: where it acts.
        force: its components, 2 or 3 [N].
        axes: "ground", or the body whose axes the components are in.
    """

    kind: ClassVar[str] = "force"
    point: PointName
    force: ForceVector
    axes: AxesName = "ground"

    @property
    def pushed_points(self) -> tuple[str, ...]:
        return (self.point,)

    def acts(self, here: ForceTrial) -> Iterator[Act]:
        yield Act(*here.place(self.point), here.directed(self.force, self.axes))

    def loads(self, scene: load.LoadContext) -> tuple[load.Load, ...]:
        axes = None if self.axes == "ground" else self.axes
        return (load.PointForce(scene.place(self.point), scene.vector(self.force), axes),)


# -------- couple ----------------------------------------------------------------------------------------------
# Couple: on a body.


@dataclass(frozen=True, kw_only=True)
class CoupleForce(Force):
    """A couple on a body.

    Args:
        body: on which it acts.
        couple: about z in the plane, 1; in space 3 components [N m].
        axes: "ground", or the body whose axes the components are in.
        point: of the body, where it acts: only what the body is strained by inside depends on it.
    """

    kind: ClassVar[str] = "couple"
    body: BodyName
    couple: CoupleFormula
    axes: AxesName = "ground"
    point: OwnPointName | None = None

    def effort(self, scene: load.LoadContext) -> Scalar | None:
        """The couple in the plane [N m]; None in space, where it has three components."""
        return scene.vector(self.couple)[0] if len(self.couple) == 1 else None

    def acts(self, here: ForceTrial) -> Iterator[Act]:
        about = self.couple if len(self.couple) == 3 else (None, None, *self.couple)
        yield Act(self.body, couple=here.directed(about, self.axes))

    def loads(self, scene: load.LoadContext) -> tuple[load.Load, ...]:
        axes = None if self.axes == "ground" else self.axes
        couple = scene.vector(self.couple)
        if len(self.couple) == 1:
            couple = Vector((0, 0, couple[0]))
        place = None if self.point is None else scene.own_place(self.body, self.point)
        return (load.Couple(self.body, couple, axes, place),)


# -------- generalized -----------------------------------------------------------------------------------------
# Generalized: a force that belongs to a coordinate and to no point.


@dataclass(frozen=True, kw_only=True)
class Generalized(Force):
    """A generalized force: virtual work value * delta q.

    Args:
        coordinate: its q.
        value: the force [N] or couple [N m] that does work on q.
    """

    kind: ClassVar[str] = "generalized"
    coordinate: CoordinateName
    value: WorkingForce

    def acts(self, here: ForceTrial) -> Iterator[Act]:
        yield Act(moving=(here.scalar(self.coordinate),), force=(here.value(self.value),))

    def loads(self, scene: LoadContext) -> tuple[Load, ...]:
        return (GeneralizedForce(self.coordinate, scene.value(self.value)),)
