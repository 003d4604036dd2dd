"""Model -> its contacts: what can end, or has friction; and what moves as a function of time."""

from __future__ import annotations

from collections.abc import Iterator

from eomgen.frozen import dataclass
from eomgen.model.constraints import Constraint
from eomgen.model.fields import Table
from eomgen.model.kinds import Resistance
from eomgen.model.parts import Body, Coordinate
from eomgen.symbolic.expression import Expression


@dataclass(frozen=True)
class Contact:
    """A constraint, or the joint of a body on a path.

    Args:
        name: of the constraint, or of the body.
        kind: as the model file says it: "support", "link", "path".
        of_joint: the contact of a body with its path.
        pulls: a wire or string, which goes slack; anything else opens.
        unilateral: it can end.
        friction: its law, or None.
        surface: it slides on a surface in space, in any direction: what slides has a speed, and no sense.
        round: a bilateral contact on a line in space: N has two components, and no sign.
        restitution: its coefficient; None: it does not rebound.
    """

    name: str
    kind: str
    unilateral: bool
    friction: Resistance | None
    of_joint: bool = False
    pulls: bool = False
    surface: bool = False
    round: bool = False
    restitution: Expression | None = None

    @property
    def words(self) -> str:
        return f"the body '{self.name}'" if self.of_joint else f"the {self.kind} '{self.name}'"

    @property
    def declared_at(self) -> str:
        """Path of its declaration: constraints.wall, bodies.bead.joint."""
        return f"bodies.{self.name}.joint" if self.of_joint else f"constraints.{self.name}"

    @property
    def mu(self) -> Expression | None:
        """The coefficient of Coulomb friction."""
        return None if self.friction is None else self.friction.coulomb


class Connections:
    """Contacts of a model, and coordinates that move as functions of time: a base of `Model`."""

    space: str
    coordinates: Table[Coordinate]
    bodies: Table[Body]
    constraints: Table[Constraint]

    @property
    def contacts(self) -> tuple[Contact, ...]:
        """Every constraint that can end or has friction, and every body with friction on its path."""
        laws = ((name, getattr(body.joint, "friction", None)) for name, body in self.bodies.items())
        return (*self._touching(), *(self._on_path(name, law) for name, law in laws if law is not None))

    @property
    def rough_contacts(self) -> tuple[Contact, ...]:
        """Every constraint with dry friction, and every body on a path of which a piece has it."""
        pieces = (
            self._on_path(name, piece.friction) for name, body in self.bodies.items() for piece in body.path_pieces
        )
        return tuple(contact for contact in (*self._touching(), *pieces) if contact.mu is not None)

    def _touching(self) -> Iterator[Contact]:
        for name, constraint in self.constraints.items():
            friction, unilateral = getattr(constraint, "friction", None), bool(getattr(constraint, "unilateral", False))
            if unilateral or friction is not None:
                rough = self.space == "space" and friction is not None
                yield Contact(
                    name,
                    constraint.kind,
                    unilateral,
                    friction,
                    pulls=constraint.pulls,
                    surface=rough and not constraint.on_line,
                    round=rough and constraint.on_line,
                    restitution=getattr(constraint, "restitution", None),
                )

    def _on_path(self, body: str, law: Resistance | None) -> Contact:
        return Contact(body, "path", False, law, of_joint=True, round=self.space == "space")

    @property
    def driving_constraints(self) -> dict[str, tuple[str, ...]]:
        """{coordinate: the constraints that give it as a function of time}, of those that have one."""
        found: dict[str, tuple[str, ...]] = {}
        for name, constraint in self.constraints.items():
            if coordinate := constraint.drives():
                found[coordinate] = (*found.get(coordinate, ()), name)
        return found

    @property
    def driven_coordinates(self) -> frozenset[str]:
        """The names of all coordinates that move as given functions of time."""
        own = (name for name, part in self.coordinates.items() if part.driven)
        return frozenset((*own, *self.driving_constraints))
