"""System -> AskedReactions: the functions of outputs for which the balance of the bodies is needed."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property

from eomgen.errors import DerivationError
from eomgen.mechanics.balance.balance import refuse_placeless
from eomgen.mechanics.equations.system import System
from eomgen.mechanics.reactions.drive import drive, multiplier
from eomgen.mechanics.reactions.reactions import Reactions, reactions_of
from eomgen.mechanics.statics.section_forces import KINDS, SectionForces, section_forces
from eomgen.model.constraints.members import ends_asked
from eomgen.symbolic.expression.expressions import Call, Expression, Reference, parse
from eomgen.symbolic.expression.graph import Node, Scalar

_AXES = {"x": 0, "y": 1, "z": 2}
_FORCES = {f"reaction_{axis}": i for axis, i in _AXES.items()}
_COUPLES = {"reaction_couple": 2, **{f"reaction_couple_{axis}": i for axis, i in _AXES.items()}}
_ALONE = ("reaction_n", "reaction_t", "reaction_s", "tension", "multiplier", "drive")
ASKING_REACTIONS = frozenset((*_FORCES, *_COUPLES, *_ALONE, *KINDS))
"""Functions for which the balance of the bodies is needed."""


@dataclass(frozen=True)
class AskedReactions:
    """What these functions are worth in one system.

    Args:
        system: the system.
        at: exact scalars that stand in place of coordinates, speeds, accelerations and t.
    """

    system: System
    at: Mapping[Node, Scalar]

    @cached_property
    def reactions(self) -> Reactions:
        """All reactions, of generic coordinates or at the given ones."""
        return reactions_of(self.system, self.at, short=True)

    def value(self, call: Call) -> Scalar:
        """One function at its arguments.

        Raises:
            DerivationError: it has no meaning here, or no single value.
        """
        if call.name == "tension":
            return self._tension(call)
        if call.name in KINDS:
            return self._section_force(call)
        return self._reaction(call, *(output_name(call, argument) for argument in call.args))

    def _reaction(self, call: Call, owner: str, frame: str = "") -> Scalar:
        """A component of a reaction: reaction_x(B), reaction_x(B.II), reaction_y(bar, bar), reaction_n(wall)."""
        if call.name == "multiplier":
            return self._multiplier(owner)
        if call.name == "drive":
            return drive(self.system, owner)
        owner, _, side = owner.partition(".")
        if side and call.name in ("reaction_n", "reaction_t", "reaction_s"):
            mend = f"ask {call.name}({owner}), at an instant where it is meant"
            raise DerivationError(f"'{call}': normal force and friction are on the body named first", mend=mend)
        if call.name == "reaction_n":
            return self.reactions.normal(owner)
        if call.name in ("reaction_t", "reaction_s"):
            return self.reactions.friction(owner, call.name[-1])
        if call.name in _FORCES:
            return self.reactions.component("force", _FORCES[call.name], owner, side, frame)
        if call.name == "reaction_couple" and self.system.scope.model.space == "space":
            return self._couple_of_gear(call, owner)
        return self.reactions.component("couple", _COUPLES[call.name], owner, side, frame)

    def _couple_of_gear(self, call: Call, owner: str) -> Scalar:
        """In space: along the axle of the gear's first body; other couples have no one direction."""
        labels = [c.label for c in self.reactions.components if c.owner == owner]
        if labels != ["couple"] or str(call) != f"reaction_couple({owner})":
            names = ", ".join(str(call).replace("couple(", f"couple_{axis}(") for axis in _AXES)
            raise DerivationError(f"'{call}': a couple in space has three components", mend=f"ask {names}")
        return self.reactions.multiplier(owner)

    def _multiplier(self, tie: str) -> Scalar:
        """lam of a tie of one row; where it or another action has no place, as it stands in the equations of motion."""
        rows = [row for row in self.system.ties.rows if row.tie == tie]
        if any(row.pushes for row in rows) and not self._acts_at_no_place:
            return self.reactions.multiplier(tie)
        return multiplier(self.system, tie)

    @cached_property
    def _acts_at_no_place(self) -> bool:
        """Whether the bodies cannot be balanced one by one."""
        try:
            refuse_placeless(self.system)
        except DerivationError:
            return True
        return False

    def _tension(self, call: Call) -> Scalar:
        """tension(rope), tension(rope, 2), or tension(T, n1-n2) of a truss."""
        owner, *strand = call.args
        name = output_name(call, owner)
        tie = self.system.scope.model.constraints.get(name)
        if tie is not None and tie.table == "trusses":
            return self.reactions.member(name, *_ends(call))
        number = strand[0].literal if strand and isinstance(strand[0], Expression) else 1
        if not isinstance(number, int) or len(strand) > 1:
            raise DerivationError(f"'{call}': the second argument is the number of the strand, from 1")
        return self.reactions.tension(name, number)

    def _section_force(self, call: Call) -> Scalar:
        """bending_moment(beam, a), shear_force(beam, a, before)."""
        body, x, *side = call.args
        sides = [output_name(call, name) for name in side]
        if any(name not in ("before", "after") for name in sides):
            raise DerivationError(f"'{call}': the third argument is `before` or `after`")
        names = self.system.scope.names
        distance = (parse(x.name) if isinstance(x, Reference) else x).evaluate(names)  # L-c reads like a member
        return self._beam(output_name(call, body)).value(call.name, distance, *sides)

    def _beam(self, body: str) -> SectionForces:
        if body not in self.system.motion.index:
            raise DerivationError(f"'{body}' is no body with section forces")
        if body not in self._beams:
            self._beams[body] = section_forces(self.reactions, body)
        return self._beams[body]

    @cached_property
    def _beams(self) -> dict[str, SectionForces]:
        """The section forces of the bodies of which they were asked."""
        return {}


def output_name(call: Call, argument: object) -> str:
    """An argument that is a name.

    Raises:
        DerivationError: it is none.
    """
    if not isinstance(argument, Reference):
        raise DerivationError(f"'{call}': names are needed as arguments")
    return argument.name


def _ends(call: Call) -> tuple[str, str]:
    """The nodes of the member that an output asks for."""
    ends = ends_asked(call)
    if ends is None:
        raise DerivationError(f"'{call}' names no member of a truss", mend=f"write tension({call.args[0]}, n1-n2)")
    return ends
