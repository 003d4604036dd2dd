"""Model -> its contacts: what can end, or has friction."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

from eomgen.frozen import dataclass
from eomgen.model.kinds import Resistance
from eomgen.model.parts import Body, Model
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
    """

    name: str
    kind: str
    unilateral: bool
    friction: Resistance | None
    of_joint: bool = False
    pulls: bool = False
    surface: bool = False
    round: bool = False

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


def contacts_of(model: Model) -> tuple[Contact, ...]:
    """Every constraint that can end or has friction, and every body with friction on its path."""
    laws = ((name, getattr(body.joint, "friction", None)) for name, body in model.bodies.items())
    return (*_constraints(model), *(_on_path(model, name, law) for name, law in laws if law is not None))


def rough_contacts(model: Model) -> tuple[Contact, ...]:
    """Every constraint with dry friction, and every body on a path of which a piece has it."""
    pieces = (_on_path(model, name, piece.friction) for name, body in model.bodies.items() for piece in pieces_of(body))
    return tuple(contact for contact in (*_constraints(model), *pieces) if contact.mu is not None)


def pieces_of(body: Body) -> tuple[Any, ...]:
    """The pieces of the path on which a body is; () where it is on none."""
    return getattr(body.joint, "pieces", None) or ()


def _on_path(model: Model, body: str, law: Resistance | None) -> Contact:
    return Contact(body, "path", False, law, of_joint=True, round=model.space == "space")


def _constraints(model: Model) -> Iterator[Contact]:
    for name, constraint in model.constraints.items():
        friction, unilateral = getattr(constraint, "friction", None), bool(getattr(constraint, "unilateral", False))
        if unilateral or friction is not None:
            rough = model.space == "space" and friction is not None
            yield Contact(
                name,
                constraint.kind,
                unilateral,
                friction,
                pulls=constraint.pulls,
                surface=rough and not constraint.on_line,
                round=rough and constraint.on_line,
            )
