"""Gear wheels whose teeth yield, have play, and lose power."""

from collections.abc import Iterator
from typing import Annotated, Any, ClassVar

from eomgen.errors import DerivationError
from eomgen.frozen import dataclass
from eomgen.model.catalog import Catalog
from eomgen.model.diagnostics import Diagnostic
from eomgen.model.fields import FormulaRule
from eomgen.model.forces.base import Act, Force, ForceTrial
from eomgen.model.forces.load import Couple, Load, LoadContext
from eomgen.model.kinds import AngularDamping, AngularStiffness, Pure, TurningSpeed, TwoBodies
from eomgen.model.positions import DocumentPath
from eomgen.symbolic.expression import Expression, Fraction, Scalar, Vector, function, over

Play = Annotated[Expression, FormulaRule("rad", "nonnegative")]
Efficiency = Annotated[Expression, FormulaRule("1", "positive")]


@dataclass(frozen=True, kw_only=True)
class GearMesh(Force):
    """Two gear wheels that mesh with play: omega of the first is about ratio * omega of the second.

    With x = theta_1 - ratio theta_2, 0 at the start, the teeth touch where |x| is above half the backlash, and push the
    second wheel by ratio M, the first by - M: M = k (|x| - b/2) + c |x|', never below 0, with the sign of x; without
    backlash they always touch, M = k x + c x'. Of the
    power M omega_1 the wheel that is driven gets the share of the efficiency: - eta M on the first where M omega_1 is
    below 0, else eta ratio M on the second. Angles are those against the ground's axes, in the plane.

    Args:
        bodies: the two wheels.
        ratio: of their rates, negative where they turn against one another.
        stiffness: k of the teeth, as it is felt at the first wheel [N m].
        damping: c [N m s].
        backlash: b, the whole play of the first wheel while the second stands (None: none) [rad].
        efficiency: eta of the power that goes through, up to 1 (None: 1).
        smooth: v, where the driven side changes by tanh(omega_1/v) and not at once [rad/s].
    """

    kind: ClassVar[str] = "gear_mesh"
    bodies: TwoBodies
    ratio: Pure
    stiffness: AngularStiffness
    damping: AngularDamping | None = None
    backlash: Play | None = None
    efficiency: Efficiency | None = None
    smooth: TurningSpeed | None = None

    def diagnostics(self, path: DocumentPath, catalog: Catalog) -> Iterator[Diagnostic]:
        """Diagnostics of an efficiency above 1, and of what smooths none."""
        eta = None if self.efficiency is None else self.efficiency.literal
        if eta is not None and eta > 1:
            yield Diagnostic((*path, "efficiency"), f"the efficiency of '{path[1]}' is {eta}", "at most 1", key=True)
        if self.smooth is not None and self.efficiency is None:
            what = f"'{path[1]}' has no efficiency that 'smooth' could smooth"
            yield Diagnostic((*path, "smooth"), what, "leave it out", key=True)

    @property
    def of_the_start(self) -> bool:
        """True: its teeth stand in the middle of their play where the motion starts."""
        return True

    def acts(self, here: ForceTrial) -> Iterator[Act]:
        """The teeth push where x is beyond the play; the driven wheel gets its share."""
        (first, second), ratio = self.bodies, here.value(self.ratio)
        (_, w_1), M = here.turned(first), self._pushed(here)
        if self.smooth is None:
            drives = (M * w_1 > 0) - (M * w_1 < 0)
        else:
            drives = here.function("tanh", w_1 / here.value(self.smooth)) * ((M > 0) - (M < 0))
        lost = 0 if self.efficiency is None else (1 - here.value(self.efficiency)) / 2
        yield Act(first, couple=Vector((0, 0, -M * (1 - lost * (1 - drives)))))
        yield Act(second, couple=Vector((0, 0, ratio * M * (1 - lost * (1 + drives)))))

    def _pushed(self, here: ForceTrial) -> Any:
        """M at a state, in numbers."""
        first, second = self.bodies
        ratio, k, c, play = map(here.value, (self.ratio, self.stiffness, self.damping, self.backlash))
        (begun,) = here.at_start((here.angle(first) - here.scalar(self.ratio) * here.angle(second),))
        (theta_1, w_1), (theta_2, w_2) = map(here.turned, self.bodies)
        x, rate = theta_1 - ratio * theta_2 - begun, w_1 - ratio * w_2
        if self.backlash is None:
            return k * x + c * rate
        side = 1 if x > 0 else -1
        beyond = side * x - play / 2
        return side * max(k * beyond + side * c * rate, 0) if beyond > 0 else 0 * x

    def loads(self, scene: LoadContext) -> tuple[Load, ...]:
        """- M on the first, ratio M on the second, the driven one by its share.

        Raises:
            DerivationError: in space.
        """
        if not scene.plane:
            raise DerivationError(
                "wheels that mesh with play turn in one plane",
                scene.where,
                "in space let the constraint `gear` hold them, or model the plane of the wheels",
            )
        first, second = self.bodies
        M, ratio = self._tooth_couple(scene), scene.value(self.ratio)
        of_first, of_second = self._shares(scene, M if self.backlash is None else self._offset(scene))
        return (
            Couple(first, Vector((0, 0, -of_first * M))),
            Couple(second, Vector((0, 0, of_second * ratio * M))),
        )

    def potential(self, scene: LoadContext) -> Scalar | None:
        """V = k (|x| - b/2)^2/2 where the teeth touch; None where it takes energy."""
        if self.damping is not None or self.efficiency is not None or not scene.plane:
            return None
        x, half = self._offset(scene), self._half(scene)
        if self.backlash is None:
            return Fraction(1, 2) * scene.value(self.stiffness) * x * x
        over_play, under = function("max", 0, x - half), function("max", 0, -x - half)
        return Fraction(1, 2) * scene.value(self.stiffness) * (over_play * over_play + under * under)

    def _offset(self, scene: LoadContext) -> Scalar:
        first, second = self.bodies
        x = scene.angle(first) - scene.value(self.ratio) * scene.angle(second)
        return x - scene.start(x)

    def _half(self, scene: LoadContext) -> Scalar:
        return Fraction(1, 2) * scene.value(self.backlash)

    def _tooth_couple(self, scene: LoadContext) -> Scalar:
        """M [N m]."""
        x, half, k = self._offset(scene), self._half(scene), scene.value(self.stiffness)
        if self.backlash is None:
            return k * x + scene.value(self.damping) * scene.rate(x)
        if self.damping is None:
            return k * (function("max", 0, x - half) - function("max", 0, -x - half))
        push = scene.value(self.damping) * scene.rate(x)
        ahead = function("max", 0, k * (x - half) + push) * function("max", 0, function("sign", x - half))
        behind = function("max", 0, k * (-x - half) - push) * function("max", 0, function("sign", -x - half))
        return ahead - behind

    def _shares(self, scene: LoadContext, side: Scalar) -> tuple[Scalar, Scalar]:
        """(of M on the first, of ratio M on the second), the driven one eta, the other 1; side has the sign of M."""
        if self.efficiency is None:
            return 1, 1
        rate = scene.angle_rate(self.bodies[0])
        way = function("sign", rate) if self.smooth is None else function("tanh", over(rate, scene.value(self.smooth)))
        first_drives = way * function("sign", side)
        lost = Fraction(1, 2) * (1 - scene.value(self.efficiency))
        return 1 - lost * (1 - first_drives), 1 - lost * (1 + first_drives)
