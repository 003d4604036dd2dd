"""System -> StaticReactions: every reaction of a structure at rest in two independent ways, compared.

One way is the balance of every body, solved for all reactions together; the other releases one reaction at a time and
writes the virtual work of the mechanism that is left. They share what a unit of a reaction does to the bodies, and
nothing else: the loads' works are those of their own points, line loads by the integral of q . v.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from functools import cached_property

from eomgen.errors import DerivationError, ExpressionError, UsageError
from eomgen.mechanics.balance.balance_solution import Indeterminate
from eomgen.mechanics.balance.named_reactions import NamedReaction, name_of
from eomgen.mechanics.constraints.freedom import counted
from eomgen.mechanics.equations.system import System
from eomgen.mechanics.reactions.reactions import Reactions, determinate_sums, reactions_of
from eomgen.mechanics.statics.virtual_work import (
    WorkEquation,
    asked_reactions,
    by_virtual_work,
    unknown_by_virtual_work,
)
from eomgen.mechanics.structures.loose_motion import refuse_loose
from eomgen.mechanics.structures.structure import Structure, structure_of
from eomgen.model.findings import nearest
from eomgen.records import dataclass
from eomgen.symbolic.exact.equality import equal_at_random_states
from eomgen.symbolic.exact.normal_form import simplest
from eomgen.symbolic.expression.derivative import substituted
from eomgen.symbolic.expression.expressions import single_call
from eomgen.symbolic.expression.graph import Node, Scalar
from eomgen.symbolic.numeric.work import Work
from eomgen.symbolic.print.text import text_size

UNITS = {(1, 1, -2): "N", (2, 1, -2): "N*m", (0, 1, -2): "N/m"}
"""By the exponents of m, kg, s."""
LONGEST_FACTOR = 60  # characters of a factor in a sum that is told


@dataclass(frozen=True)
class StaticReaction:
    """One reaction, or one unknown of the loads.

    Args:
        name: as outputs ask for it.
        unit: N, N*m; of an unknown "" where the model does not say what it is.
        named: the reaction; None for an unknown.
        solved: its value as the balance of the bodies gives it; None where that leaves it open.
        positive: parameters that stand for positive numbers.
        work: the equation of virtual work; None where it is indeterminate, or was not asked.
    """

    name: str
    unit: str
    named: NamedReaction | None
    solved: Scalar | None
    positive: frozenset[Node]
    work: WorkEquation | None

    @cached_property
    def balanced(self) -> Scalar | None:
        """Its value by the balance of the bodies, as a person writes it."""
        return None if self.solved is None else simplest(self.solved, Work.ANSWER, self.positive)

    @cached_property
    def agree(self) -> bool:
        """Whether the two values are the same function of the parameters.

        What only one of the ways leaves open is a difference too.
        """
        if self.work is None:
            return True
        return self.solved is not None and equal_at_random_states([(self.solved, self.work.value)]).equal

    @property
    def value(self) -> Scalar | None:
        """None where it is statically indeterminate."""
        return self.balanced if self.work is None else self.work.value


@dataclass(frozen=True)
class StaticSum:
    """A sum of indeterminate reactions that is determinate.

    Args:
        combination: {row of the structure: factor}.
        value: by the balance of the bodies.
        unit: that of its first.
    """

    combination: dict[int, Scalar]
    value: Scalar
    unit: str


@dataclass(frozen=True)
class StaticReactions:
    """A structure at rest.

    Args:
        structure: bodies and what holds them.
        reactions: every one, unknowns of the loads last.
        balance: the solution of the bodies' equations.
    """

    structure: Structure
    reactions: tuple[StaticReaction, ...]
    balance: Reactions

    @property
    def system(self) -> System:
        return self.structure.system

    @cached_property
    def by_name(self) -> dict[str, StaticReaction]:
        return {reaction.name: reaction for reaction in self.reactions}

    @property
    def open(self) -> tuple[StaticReaction, ...]:
        """The reactions that are statically indeterminate."""
        return tuple(reaction for reaction in self.reactions if reaction.value is None)

    @cached_property
    def sums(self) -> tuple[StaticSum, ...]:
        """Sums of those that have one value, as far as they are short."""
        found = []
        for combination in determinate_sums(self.structure.stresses):
            factors = {j: simplest(k, Work.ANSWER, self.system.scope.positive) for j, k in combination.items()}
            if max(map(text_size, factors.values())) <= LONGEST_FACTOR:
                value = self.balance.combined(factors, "their sum")
                unit = next((r.unit for r in self.reactions if r.name == self.structure.names[next(iter(factors))]), "")
                found.append(StaticSum(factors, simplest(value, Work.ANSWER, self.system.scope.positive), unit))
        return tuple(found)

    @property
    def disagreeing(self) -> tuple[StaticReaction, ...]:
        """Those of which the two ways differ: then the result is wrong."""
        return tuple(reaction for reaction in self.reactions if not reaction.agree)

    @property
    def count(self) -> tuple[int, str]:
        """3 Nb + 2 Np - components - unknown loads, and as text."""
        number, text = counted(self.system.ties)
        loads = len(self.structure.unknowns)
        return (number - loads, f"{text} - {loads} (unknown loads)") if loads else (number, text)


def static_reactions_of(
    system: System, at: Mapping[Node, Scalar] | None = None, *, only: str | None = None
) -> StaticReactions:
    """Every reaction of a structure at a configuration.

    Args:
        at: exact places of coordinates; None: the start.
        only: the one reaction that is found by virtual work too; None: all.
    Raises:
        UsageError: there is no such reaction.
        DerivationError: bodies can move; a force acts at no place.
    """
    structure = structure_of(system, at)
    refuse_loose(structure)
    return reactions_in(structure, only=only)


def reactions_in(structure: Structure, *, only: str | None = None) -> StaticReactions:
    """Every reaction of a structure in which nothing can move; `only` as of `static_reactions_of`."""
    system = structure.system
    balance = reactions_of(system, structure.at)
    asked, positive = asked_reactions(structure), structure.system.scope.positive
    one = None if only is None else _one_of((*asked, *(unknown.name for unknown in structure.unknowns)), only)
    found = []
    for named in asked.values():
        work = by_virtual_work(structure, named) if one in (None, named.name) else None
        solved = _balanced(balance, structure, named)
        found.append(StaticReaction(named.name, named.unit, named, solved, positive, work))
    for unknown in structure.unknowns:
        work = unknown_by_virtual_work(structure, unknown) if one in (None, unknown.name) else None
        solved, unit = balance.unknowns.get(unknown), unit_of_unknown(structure, unknown)
        found.append(StaticReaction(unknown.name, unit, None, solved, positive, work))
    return StaticReactions(structure, tuple(found), balance)


def released_in(structure: Structure, name: str) -> StaticReaction:
    """One reaction, or unknown of the loads, by its virtual work alone; other freedoms of the bodies stand still.

    Raises:
        UsageError: there is no such reaction.
        DerivationError: released, nothing can move.
    """
    asked, unknowns = asked_reactions(structure), {unknown.name: unknown for unknown in structure.unknowns}
    one = _one_of((*asked, *unknowns), name)
    named = asked.get(one)
    unit = unit_of_unknown(structure, unknowns[one]) if named is None else named.unit
    work = unknown_by_virtual_work(structure, unknowns[one]) if named is None else by_virtual_work(structure, named)
    if work is None:
        what = f"{one} is statically indeterminate: released, the other reactions hold the bodies without it"
        raise DerivationError(what, mend="take a redundant tie away")
    if not work.plan.moving:
        raise DerivationError(f"{one} holds nothing: its tie leaves this motion free", mend="take the constraint away")
    return StaticReaction(one, unit, named, None, structure.system.scope.positive, work)


def unit_of_unknown(structure: Structure, unknown: Node) -> str:
    """The unit of SI of an unknown force, couple or line load, where the model says what it is."""
    unit = structure.system.scope.model.unknowns[unknown.name].unit
    return "" if unit is None else UNITS.get(unit.dimension, "")


def _one_of(names: Sequence[str], asked: str) -> str:
    """The name of the reaction, or of the unknown, that is asked for.

    Raises:
        UsageError: there is none.
    """
    try:
        call = single_call(asked)
    except ExpressionError:
        call = None
    name = asked if call is None else name_of(call, names)
    if name not in names:
        listed = nearest(name, names) or f"there are {', '.join(names)}"
        raise UsageError(f"there is no reaction '{name}'", mend=listed)
    return name


def _balanced(balance: Reactions, structure: Structure, named: NamedReaction) -> Scalar | None:
    """A reaction by the balance of the bodies; None where that leaves it open."""
    *factors, given = substituted((*named.combination.values(), named.given), structure.at)
    try:
        value = balance.combined(dict(zip(named.combination, factors, strict=True)), named.name)
    except Indeterminate:
        return None
    (given,) = substituted((given,), balance.unknowns)
    return value + given
