"""An equilibrium -> every reaction there, and the unknown loads that hold it."""

from __future__ import annotations

from collections.abc import Mapping
from functools import partial
from random import Random
from typing import NamedTuple

from eomgen.errors import DerivationError
from eomgen.frozen import dataclass
from eomgen.mechanics.dynamics import System
from eomgen.mechanics.equilibrium.equations import StaticEquations
from eomgen.mechanics.equilibrium.search import Equilibrium
from eomgen.mechanics.free_bodies import Indeterminate, NamedReaction, Reactions
from eomgen.mechanics.start import ExactStart
from eomgen.symbolic.exact import LinearSystem, Solution, readable_all, simplest, vanishes
from eomgen.symbolic.expression import Fraction, Node, Scalar, depends_on, is_zero, jacobian, substituted
from eomgen.symbolic.numeric import Work, evaluate, fifty_digits

# -------- resting reactions -----------------------------------------------------------------------------------
# An equilibrium -> every reaction there, by the balance of the bodies.


@dataclass(frozen=True)
class RestingReaction:
    """One reaction at an equilibrium.

    Args:
        named: what it is.
        value: a scalar of the parameters, None where it is statically indeterminate.
    """

    named: NamedReaction
    value: Scalar | None


def system_at_rest(place: Equilibrium) -> System:
    """The system at the equilibrium, over its rates where declared speeds are not 0 at rest."""
    system = place.statics.system
    return StaticEquations.standing(system if system.free is None or system.elimination is not None else system.free)


def state_at_rest(place: Equilibrium) -> dict[Node, Scalar]:
    """All coordinates, speeds, inputs and time at rest there: exact, or the exact rational values of the floats."""
    system = system_at_rest(place)
    symbols = system.symbols
    still: dict[Node, Scalar] = {symbols.t: 0, **dict.fromkeys((*symbols.u, *symbols.a), 0)}
    inputs = {x: place.statics.given[x] for x in symbols.inputs.values()}
    at = place.exact if place.is_exact else {q: Fraction(place.numbers[q]) for q in symbols.places}
    return {**still, **inputs, **{q: at[q] for q in symbols.places}}


class RestingReactions(NamedTuple):
    """Reactions at an equilibrium: their law, each of them, and why they do not follow ("": they do)."""

    reactions: Reactions | None
    each: tuple[RestingReaction, ...]
    why: str

    @classmethod
    def of(cls, place: Equilibrium) -> RestingReactions:
        """Every reaction of joints and constraints; none where a force acts at no place."""
        try:
            return cls(*_reactions_at(place), "")
        except DerivationError as error:
            return cls(None, (), f"{error.what}; {error.fix}" if error.fix else error.what)


def _reactions_at(place: Equilibrium) -> tuple[Reactions, tuple[RestingReaction, ...]]:
    system, state = system_at_rest(place), state_at_rest(place)
    reactions = Reactions.of(system, state, work=Work.ANSWER if place.is_exact else Work.PART)
    positive = system.scope.positive
    found = []
    for named in NamedReaction.all_of(reactions.balance):
        *factors, given = substituted((*named.combination.values(), named.given), state)
        try:
            sum_ = reactions.combined(dict(zip(named.combination, factors, strict=True)), named.name)
            value = sum_ + given
            found.append(RestingReaction(named, simplest(value, Work.VALUE, positive) if place.is_exact else value))
        except Indeterminate:
            found.append(RestingReaction(named, None))
    return reactions, tuple(found)


# -------- loads at rest ---------------------------------------------------------------------------------------
# System at the start, with unknowns in its loads -> the unknowns for which it is in equilibrium there, by virtual work.
#
# Q_k + (J^T lam)_k = 0        linear in the unknowns and the multipliers


@dataclass(frozen=True)
class Holding:
    """Unknown loads and multipliers for which a system is in equilibrium where it starts.

    Args:
        statics: the equations of rest.
        place: every coordinate at the start, exact.
        unknowns: the value of each unknown of the loads.
        lam: the multipliers of closing constraints that have a single value.
    """

    statics: StaticEquations
    place: Mapping[Node, Scalar]
    unknowns: Mapping[Node, Scalar]
    lam: Mapping[Node, Scalar]


def holding_of(system: System) -> Holding:
    """The unknowns of the loads for which the system is at rest where it starts.

    Raises:
        DerivationError: no unknown of the loads does work; they are not determined, or cannot hold it; the start has no
            closed form.
    """
    statics = StaticEquations.of(system)
    if not statics.loaded:
        raise DerivationError(
            "no unknown load does work when the system moves: none can hold it",
            fix="write one of [unknowns] into a force on what moves",
        )
    state = ExactStart.values_at_rest(statics.system)
    place = {q: state[q] for q in statics.system.symbols.q}
    solution = _solved(statics, place)
    _refuse_undetermined(statics, solution)
    positive = statics.system.scope.positive
    found = {
        node: simplest(solution.constants[j], Work.VALUE, positive)
        for j, node in enumerate((*statics.loaded, *statics.lam))
        if solution.determined(j)
    }
    return Holding(
        statics, place, {p: found[p] for p in statics.loaded}, {lam: found[lam] for lam in statics.lam if lam in found}
    )


def _solved(statics: StaticEquations, place: Mapping[Node, Scalar]) -> Solution:
    """The balance along every coordinate, for the unknowns and the multipliers."""
    sought = (*statics.loaded, *statics.lam)
    slopes = jacobian(statics.forces, sought)
    for row in slopes:
        for p, slope in zip(sought, row, strict=True):
            if depends_on(slope, statics.loaded):
                raise DerivationError(
                    f"the balance is not linear in the unknown '{p.name}'",
                    f"unknowns.{p.name}",
                    "let it stand alone, times what is known",
                )
    right = [-x for x in substituted(substituted(statics.forces, dict.fromkeys(sought, 0)), place)]
    flat = iter(readable_all(substituted([x for row in slopes for x in row], place), Work.VALUE))
    rows = [{j: next(flat) for j in range(len(sought))} for _ in slopes]
    readable_right = readable_all(right, Work.VALUE)
    own, shaken = (
        LinearSystem(
            rows, readable_right, len(sought), partial(evaluate, values=values, arithmetic=fifty_digits())
        ).solution()
        for values in (statics.system.scope.values_of_parameters(Random(3), shaken=each) for each in (False, True))
    )
    return shaken if len(shaken.free) == len(own.free) else own  # m1 - m2 is 0 at m1 = m2 alone


def _refuse_undetermined(statics: StaticEquations, solution: Solution) -> None:
    open_ = [p.name for j, p in enumerate(statics.loaded) if not solution.determined(j)]
    if open_:
        raise DerivationError(
            f"equilibrium does not determine '{open_[0]}': there are more unknowns than degrees of freedom",
            f"unknowns.{open_[0]}",
            "give a value to some of them",
        )
    if not all(is_zero(x) or vanishes(x) for x in solution.left):
        names = ", ".join(f"'{p.name}'" for p in statics.loaded)
        degrees_of_freedom = ", ".join(u.name.removesuffix("'") for u in statics.system.symbols.u)
        raise DerivationError(
            f"{names} alone cannot hold the system in equilibrium where it starts",
            fix=f"the degrees of freedom are {degrees_of_freedom}; let an unknown act on each",
        )
