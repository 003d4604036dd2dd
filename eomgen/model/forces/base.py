"""What every force is: fields that say where it acts and by which law."""

from collections.abc import Iterator
from typing import ClassVar

from eomgen.model.catalog import Catalog
from eomgen.model.findings import Finding
from eomgen.model.forces.element import Act, Element
from eomgen.model.forces.load import Load, LoadContext, SpreadLoad
from eomgen.model.part import Part
from eomgen.model.positions import DocumentPath
from eomgen.records import dataclass
from eomgen.symbolic.expression.expressions import Expression
from eomgen.symbolic.expression.spatial import AnyScalar


@dataclass(frozen=True, kw_only=True)
class Force(Part):
    """Something applied to the system; `by_mass` is what acts on every particle of a body as its mass is spread.

    A law gives `loads`, whether or not it has a `potential`: the two ways to its generalized forces.
    `works` is False for a kind that is read and checked but not derived yet.
    """

    kind: ClassVar[str]
    works: ClassVar[bool] = True
    by_mass: ClassVar[bool] = False
    one_of: ClassVar[tuple[str, ...]] = ()  # of these fields exactly one is given
    elastic: ClassVar[bool] = False  # a spring
    placeless: ClassVar[bool] = False  # an energy of coordinates, which acts at no place

    def findings(self, path: DocumentPath, catalog: Catalog) -> Iterator[Finding]:
        """What is wrong with its fields together; one alone its rule has looked at."""
        yield from ()

    @property
    def element(self) -> Element | None:
        """What it is between two points or two bodies; None for what acts otherwise."""
        return None

    @property
    def of_the_start(self) -> bool:
        """Whether it is slack at the length that it has where the motion starts."""
        return self.element is not None and self.element.slack == "start"

    @property
    def acts(self) -> tuple[Act, ...]:
        """What it does, as it is declared: the proof's way, beside `loads`."""
        return () if self.element is None else (self.element,)

    @property
    def kinetic(self) -> Expression | None:
        """T [J] of what moves and is no body; None of a force that has none."""
        return None

    def effort(self, scene: LoadContext) -> AnyScalar | None:
        """What draws its two points together [N], or turns its (second) body [N m]; None of others."""
        return None

    def loads(self, scene: LoadContext) -> tuple[Load, ...]:
        """Forces and couples on bodies, and forces along coordinates."""
        return ()

    def spread(self, scene: LoadContext) -> tuple[SpreadLoad, ...]:
        """What is spread along lines, of which `loads` gives the resultants."""
        return ()

    def potential(self, scene: LoadContext) -> AnyScalar | None:
        """V [J], or None where the force has none."""
        return None
