"""System -> StaticReactions: every reaction of a structure at rest in two independent ways, compared.

One way is the balance of every body, solved for all reactions together; the other releases one reaction at a time and
writes the virtual work of the mechanism that is left. They share what a unit of a reaction does to the bodies, and
nothing else: the loads' works are those of their own points, line loads by the integral of q . v.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property

from eomgen.mechanics.freedom import counted
from eomgen.mechanics.named_reactions import NamedReaction
from eomgen.mechanics.reactions import Indeterminate, Reactions, reactions_of
from eomgen.mechanics.statics.loose_motion import refuse_loose
from eomgen.mechanics.statics.structure import Structure, structure_of
from eomgen.mechanics.statics.virtual_work import (
    WorkEquation,
    asked_reactions,
    by_virtual_work,
    unknown_by_virtual_work,
)
from eomgen.mechanics.system import System
from eomgen.symbolic.derivative import substituted
from eomgen.symbolic.graph import Node, Scalar
from eomgen.symbolic.normal_form import equal, simplest

WORK = 50_000  # products of terms for one value


@dataclass(frozen=True)
class StaticReaction:
    """One reaction, or one unknown of the loads.

    Args:
        name: as outputs ask for it.
        unit: N, N*m; "" for an unknown.
        named: the reaction; None for an unknown.
        balanced: its value by the balance of the bodies; None where that leaves it open.
        work: the equation of virtual work; None where it is indeterminate, or was not asked.
        agree: the two values are the same function of the parameters.
    """

    name: str
    unit: str
    named: NamedReaction | None
    balanced: Scalar | None
    work: WorkEquation | None
    agree: bool

    @property
    def value(self) -> Scalar | None:
        """None where it is statically indeterminate."""
        return self.balanced if self.work is None else self.work.value


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

    @property
    def disagreeing(self) -> tuple[StaticReaction, ...]:
        """Those of which the two ways differ: then the result is wrong."""
        return tuple(reaction for reaction in self.reactions if not reaction.agree)

    @property
    def count(self) -> tuple[int, str]:
        """3 Nb + 2 Np - components, and as text."""
        return counted(self.system.ties)


def static_reactions_of(system: System, at: Mapping[Node, Scalar] | None = None, *, only: str = "") -> StaticReactions:
    """Every reaction of a structure at a configuration.

    Args:
        at: exact places of coordinates; None: the start.
        only: the one reaction that is found by virtual work too; "" all.
    Raises:
        DerivationError: bodies can move; a force acts at no place.
    """
    structure = structure_of(system, at)
    refuse_loose(structure)
    return reactions_in(structure, only=only)


def reactions_in(structure: Structure, *, only: str = "") -> StaticReactions:
    """Every reaction of a structure in which nothing can move; `only` as of `static_reactions_of`."""
    system = structure.system
    balance = reactions_of(system, structure.at)
    found = []
    for named in asked_reactions(structure).values():
        work = by_virtual_work(structure, named) if only in ("", named.name) else None
        found.append(_compared(named.name, named.unit, named, _balanced(balance, structure, named), work))
    for unknown in structure.unknowns:
        work = unknown_by_virtual_work(structure, unknown) if only in ("", unknown.name) else None
        value = balance.unknowns.get(unknown)
        found.append(_compared(unknown.name, "", None, None if value is None else _simple(structure, value), work))
    return StaticReactions(structure, tuple(found), balance)


def _compared(
    name: str, unit: str, named: NamedReaction | None, balanced: Scalar | None, work: WorkEquation | None
) -> StaticReaction:
    """Both ways, and whether they agree; what only one of them leaves open is a difference too."""
    agree = work is None or (balanced is not None and equal(balanced, work.value))
    return StaticReaction(name, unit, named, balanced, work, agree)


def _balanced(balance: Reactions, structure: Structure, named: NamedReaction) -> Scalar | None:
    """A reaction by the balance of the bodies; None where that leaves it open."""
    *factors, given = substituted((*named.combination.values(), named.given), structure.at)
    try:
        value = balance.combined(dict(zip(named.combination, factors, strict=True)), named.name)
    except Indeterminate:
        return None
    (given,) = substituted((given,), balance.unknowns)
    return _simple(structure, value + given)


def _simple(structure: Structure, value: Scalar) -> Scalar:
    return simplest(value, WORK, structure.positive)


