"""What turns one body against another, or against the ground: torsion springs and dampers."""

from collections.abc import Callable
from typing import ClassVar

from eomgen.model.forces.base import Force
from eomgen.model.forces.load import Couple, Load, LoadContext
from eomgen.model.kinds import BodyName, TwoBodies
from eomgen.records import dataclass
from eomgen.symbolic.expression.spatial import AnyScalar


@dataclass(frozen=True, kw_only=True)
class Turning(Force):
    """A couple about z by a law of the angle between two bodies, or between a body and the ground's axes."""

    one_of: ClassVar[tuple[str, ...]] = ("bodies", "body")
    bodies: TwoBodies | None = None
    body: BodyName | None = None

    def couple(self, scene: LoadContext) -> AnyScalar:
        """The law, on the second body, or on `body` [N m]."""
        raise NotImplementedError

    def effort(self, scene: LoadContext) -> AnyScalar | None:
        """The couple [N m]."""
        return self.couple(scene)

    def loads(self, scene: LoadContext) -> tuple[Load, ...]:
        """The couple on the second body, its opposite on the first."""
        first, second = self._both
        couple = self.couple(scene)
        on_first = () if first is None else (Couple(first, (0, 0, -couple)),)
        return (Couple(second, (0, 0, couple)), *on_first)

    def relative(self, of: Callable[[str], AnyScalar]) -> AnyScalar:
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
