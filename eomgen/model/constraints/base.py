"""What every tie is: fields that say what touches what."""

from dataclasses import dataclass
from typing import ClassVar

from eomgen.errors import NotYet
from eomgen.model.constraints.row import TieRow
from eomgen.model.forces.load import Scene
from eomgen.model.part import Part


@dataclass(frozen=True, kw_only=True)
class Constraint(Part):
    """A tie between bodies, or between coordinates.

    `works` is False for a kind that is read and checked but whose rows are not built yet.
    """

    kind: ClassVar[str]
    works: ClassVar[bool] = False

    def rows(self, scene: Scene) -> tuple[TieRow, ...]:
        """The rows of the tie.

        Raises:
            NotYet: a kind whose rows are not built yet.
        """
        raise NotYet(f"the rows of '{self.kind}' are not built yet")
