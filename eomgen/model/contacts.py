"""Model -> its contacts: what can end, or has friction; and what moves as a function of time."""

from __future__ import annotations

from collections.abc import Iterator
from functools import cached_property

from eomgen.frozen import dataclass
from eomgen.model.constraints import Constraint
from eomgen.model.fields import Table
from eomgen.model.forces import Force
from eomgen.model.kinds import JointFriction, Resistance
from eomgen.model.parts import Body, Coordinate
from eomgen.symbolic.expression import Expression


@dataclass(frozen=True)
class Contact:
    """A constraint, the joint of a body on a path, or what has dry friction: a joint, a force such as a brake.

    Args:
        name: of the constraint, or of the body, of a joint of several variables arm_angle.
        kind: as the model file says it: "support", "link", "path", "revolute", "clutch".
        of_joint: the contact of a body with its path, or its joint with friction.
        of_force: a force of dry friction.
        body, variable: of a joint the body, and the number of the variable along which its friction acts.
        pulls: a wire or string, which goes slack; anything else opens.
        unilateral: it can end.
        friction: its law, or None.
        surface: it slides on a surface in space, in any direction: what slides has a speed, and no sense.
        round: a bilateral contact on a line in space, or a joint with friction by its force: N has no sign.
        restitution: its coefficient; None: it does not rebound.
    """

    name: str
    kind: str
    unilateral: bool
    friction: Resistance | JointFriction | None
    of_joint: bool = False
    of_force: bool = False
    body: str = ""
    variable: int = 0
    pulls: bool = False
    surface: bool = False
    round: bool = False
    restitution: Expression | None = None

    @property
    def words(self) -> str:
        if self.of_force:
            return f"the {self.kind} '{self.name}'"
        if isinstance(self.friction, JointFriction):
            return f"the joint '{self.name}'"
        return f"the body '{self.name}'" if self.of_joint else f"the {self.kind} '{self.name}'"

    @property
    def is_passed(self) -> str:
        """Sentence of a start at which its gap is negative."""
        return f"{self.words} is {'too short' if self.pulls else 'passed through'} at the start"

    @property
    def declared_at(self) -> str:
        """Path of its declaration: constraints.wall, bodies.bead.joint, forces.brake."""
        if self.of_force:
            return f"forces.{self.name}"
        return f"bodies.{self.body}.joint" if self.of_joint else f"constraints.{self.name}"

    @property
    def mu(self) -> Expression | None:
        """The coefficient of Coulomb friction: the friction of a unit of the normal force, of a hinge mu r."""
        return None if self.friction is None else self.friction.coulomb

    @property
    def size(self) -> Expression | None:
        """The dry friction that does not depend on a reaction: a torque or force."""
        return self.friction.size if isinstance(self.friction, JointFriction) else None

    @property
    def grip(self) -> Expression | None:
        """The largest friction at rest, of `mu` for a unit of the normal force."""
        return self.friction.grip if isinstance(self.friction, JointFriction) else self.mu

    @property
    def guide(self) -> Expression | None:
        """Length of the guide whose ends carry its load; None of all else."""
        return self.friction.guide if isinstance(self.friction, JointFriction) else None

    @property
    def dry(self) -> bool:
        """True if it can stick."""
        return self.mu is not None or self.size is not None

    @property
    def holds_both_ways(self) -> bool:
        """True if its normal force, on which its friction depends, can have either sign."""
        return self.friction is not None and self.size is None and not (self.unilateral or self.round)


class Connections:
    """Contacts of a model, and coordinates that move as functions of time: a base of `Model`."""

    space: str
    coordinates: Table[Coordinate]
    bodies: Table[Body]
    constraints: Table[Constraint]
    forces: Table[Force]

    @cached_property
    def contacts(self) -> tuple[Contact, ...]:
        """Every constraint that can end or has friction, bodies on rough paths, joints and forces that can stick."""
        laws = ((name, getattr(body.joint, "friction", None)) for name, body in self.bodies.items())
        on_paths = (self._on_path(name, law) for name, law in laws if isinstance(law, Resistance))
        return (*self._touching(), *on_paths, *self._in_joints(), *self._of_forces())

    @property
    def rough_contacts(self) -> tuple[Contact, ...]:
        """All that has dry friction, and every body on a path of which a piece has it."""
        pieces = (
            self._on_path(name, piece.friction) for name, body in self.bodies.items() for piece in body.path_pieces
        )
        found = (*self._touching(), *pieces, *self._in_joints(), *self._of_forces())
        return tuple(contact for contact in found if contact.dry)

    def _in_joints(self) -> Iterator[Contact]:
        """Joints with dry friction that can stick: smooth friction never holds, and what is driven moves as given."""
        given = self.driven_coordinates
        for body, part in self.bodies.items():
            joint = part.joint
            if joint is None:
                continue
            for k, field, law in joint.frictions:
                free = joint.variable_of(field).names & self.coordinates.keys() - given
                if law.smooth is None and free:
                    name = joint.named_contact(body, field)
                    loaded = law.coulomb is not None
                    yield Contact(name, joint.kind, False, law, of_joint=True, body=body, variable=k, round=loaded)

    def _of_forces(self) -> Iterator[Contact]:
        """Forces of dry friction that can stick."""
        for name, force in self.forces.items():
            if force.friction is not None and force.friction.smooth is None:
                yield Contact(name, force.kind, False, force.friction, of_force=True)

    def _touching(self) -> Iterator[Contact]:
        for name, constraint in self.constraints.items():
            friction, unilateral = getattr(constraint, "friction", None), bool(getattr(constraint, "unilateral", False))
            if unilateral or friction is not None:
                rough = self.space == "space" and friction is not None and not constraint.pulls
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
        return Contact(body, "path", False, law, of_joint=True, body=body, round=self.space == "space")

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
