"""Bumpers between two points."""

from collections.abc import Iterator
from typing import Annotated, Any, ClassVar

from eomgen.frozen import dataclass
from eomgen.model.catalog import Catalog
from eomgen.model.diagnostics import Diagnostic
from eomgen.model.fields import FormulaRule
from eomgen.model.forces.base import Element
from eomgen.model.forces.elements import Reach, Straight
from eomgen.model.forces.load import LoadContext
from eomgen.model.kinds import RESISTS, TAKES, Direction, LinearDamping, Radius
from eomgen.model.positions import DocumentPath
from eomgen.symbolic.expression import Expression, Scalar, function, over

Hardness = Annotated[Expression, FormulaRule(None, "nonnegative", usually=RESISTS)]
Exponent = Annotated[Expression, FormulaRule("1", "positive")]
Dissipation = Annotated[Expression, FormulaRule("s/m", "nonnegative", usually=TAKES)]


@dataclass(frozen=True, kw_only=True)
class Bumper(Straight):
    """A bumper, which only pushes: k x + d x' where it is compressed by x > 0, and never below 0; else nothing.

    With an exponent the law of Hertz, k x^n; with a dissipation that of Hunt and Crossley, k x^n (1 + a x'), which
    begins and ends at 0.

    Args:
        points: its two ends.
        stiffness: k [N/m; with an exponent n N/m^n].
        length: without compression: the distance of its points at which they touch, along a direction 0, too [m].
        damping: d [N s/m].
        exponent: n (None: 1).
        dissipation: a, in place of the damping [s/m].
        along: a fixed direction along which the distance is measured instead, ground axes, 2 or 3: a wall.
    """

    kind: ClassVar[str] = "bumper"
    stiffness: Hardness
    length: Radius
    damping: LinearDamping | None = None
    exponent: Exponent | None = None
    dissipation: Dissipation | None = None
    along: Direction | None = None

    def diagnostics(self, path: DocumentPath, catalog: Catalog) -> Iterator[Diagnostic]:
        """Diagnostics of a damping beside a dissipation, and of points that would have to pass through one another."""
        if self.along is None and self.length is not None and self.length.literal == 0:
            what = f"the bumper '{path[1]}' of length 0 never touches: a distance is not below 0"
            yield Diagnostic((*path, "length"), what, "give `along`, or a length")
        if self.damping is not None and self.dissipation is not None:
            what = f"the bumper '{path[1]}' has a damping and a dissipation"
            yield Diagnostic((*path, "dissipation"), what, "leave one of them out", key=True)

    @property
    def element(self) -> Element:
        return Element(
            points=self.points,
            along=self.along,
            stiffness=self.stiffness,
            damping=self.damping,
            slack=self.length,
            pushes=True,
            power=self.exponent,
            dissipation=self.dissipation,
        )

    def law(self, scene: LoadContext, line: Reach) -> Scalar:
        """- (k x^n (1 + a x') + d x') where x > 0"""
        x = scene.value(self.length) - line.length
        push = scene.value(self.stiffness) * self._raised(scene, function("max", 0, x), 0)
        if self.dissipation is not None:
            return -push * function("max", 0, 1 - scene.value(self.dissipation) * line.rate)
        if self.damping is None:
            return -push
        whole = function("max", 0, push - scene.value(self.damping) * line.rate)
        return -whole * function("max", 0, function("sign", x))

    def potential(self, scene: LoadContext) -> Scalar | None:
        """V = k x^(n + 1)/(n + 1) where x > 0; None where it takes energy."""
        if self.damping is not None or self.dissipation is not None:
            return None
        x = function("max", 0, scene.value(self.length) - self.line(scene).length)
        return over(scene.value(self.stiffness) * self._raised(scene, x, 1), self._power(scene) + 1)

    def _raised(self, scene: LoadContext, x: Any, more: int) -> Scalar:
        """x^(n + more)"""
        found: Scalar = x ** (self._power(scene) + more)
        return found

    def _power(self, scene: LoadContext) -> Scalar:
        return 1 if self.exponent is None else scene.value(self.exponent)
