"""Thrust of mass that leaves a body or enters it."""

from collections.abc import Iterator
from typing import ClassVar

from eomgen.errors import DerivationError
from eomgen.frozen import dataclass
from eomgen.model.catalog import Catalog, owner_of
from eomgen.model.diagnostics import Diagnostic
from eomgen.model.forces import load
from eomgen.model.forces.base import Act, Force, ForceTrial
from eomgen.model.kinds import AxesName, FlowRate, FlowVelocity, PointName
from eomgen.model.positions import DocumentPath
from eomgen.symbolic.expression import Expression, Scalar, is_zero


@dataclass(frozen=True, kw_only=True)
class MassFlow(Force):
    """Mass that leaves a body at a point, or enters there: the force m' w, w its velocity relative to the body.

    The mass of the body may be an expression of t or of states. Its equations hold the mass as it is at the instant,
    m a = F + sum m' w: mass of which no flow tells leaves and enters with the velocity that the body has there. What
    flows inside the body has no inertia of its own.

    Args:
        point: of the body, where it leaves or enters.
        velocity: of that mass relative to the body, 2 or 3 [m/s].
        absolute: instead, its velocity against the ground: sand that falls on a belt has none along it.
        axes: "ground", or the body whose axes the components are in.
        rate: mass that enters per second, below 0 what leaves (None: what the other flows leave of the rate of the
            body's mass) [kg/s].
    """

    kind: ClassVar[str] = "mass_flow"
    one_of: ClassVar[tuple[str, ...]] = ("velocity", "absolute")
    point: PointName
    velocity: FlowVelocity | None = None
    absolute: FlowVelocity | None = None
    axes: AxesName = "ground"
    rate: FlowRate | None = None

    @property
    def body(self) -> str:
        """The body that gains or loses the mass."""
        return owner_of(self.point)

    def diagnostics(self, path: DocumentPath, catalog: Catalog) -> Iterator[Diagnostic]:
        """Diagnostics of a point of the ground, and of two flows that both take the rest of a body's mass."""
        if self.point is None:
            return
        if not self.body:
            what = f"the mass of '{path[1]}' flows at '{self.point}', which is no point of a body"
            yield Diagnostic((*path, "point"), what, 'name a point of the body: point = "rocket.nozzle"')
            return
        for name, other in catalog.table("forces").items() if self.rate is None else ():
            if name == path[1]:
                return
            if isinstance(other, MassFlow) and other.point and other.rate is None and other.body == self.body:
                what = f"'{name}' and '{path[1]}' both take what is left of the rate of the mass of '{self.body}'"
                yield Diagnostic((*path, "rate"), what, "give the `rate` of all of them but one", key=True)

    @property
    def pushed_points(self) -> tuple[str, ...]:
        return (self.point,)

    def acts(self, here: ForceTrial) -> Iterator[Act]:
        """m' w, w less the velocity of the point where it is given against the ground."""
        given = self.velocity if self.absolute is None else self.absolute
        assert given is not None, "one of both is given"
        w = here.directed(given, self.axes)
        w = w if self.absolute is None else w - here.velocity_of(self.point)
        yield Act(*here.place(self.point), here.mass_that_enters(self.body, self.rate) * w)

    def loads(self, scene: load.LoadContext) -> tuple[load.Load, ...]:
        """m' w at the point; m' (v - v_P) where v is the velocity against the ground.

        Raises:
            DerivationError: no mass flows.
        """
        place, mu = scene.place(self.point), self._rate(scene)
        if is_zero(mu):
            raise DerivationError(
                f"the mass of '{self.body}' does not change, and no `rate` says how much flows",
                scene.where,
                'give the body a mass that changes, mass = "m_0 - mu*t", or the flow a `rate`',
            )
        axes = None if self.axes == "ground" else self.axes
        flow = scene.vector(self.velocity if self.absolute is None else self.absolute)
        if self.absolute is None:
            return (load.PointForce(place, mu * flow, axes),)
        flow = flow if axes is None else scene.orientation(axes) @ flow
        return (load.PointForce(place, mu * (flow - scene.velocity(place))),)

    def _rate(self, scene: load.LoadContext) -> Scalar:
        """Mass that enters per second."""
        if self.rate is not None:
            return scene.value(self.rate)
        return scene.unsaid_rate(self.body)

    @property
    def flow(self) -> tuple[str, Expression | None]:
        """(body, rate of what enters it; None: what the others leave)."""
        return self.body, self.rate
