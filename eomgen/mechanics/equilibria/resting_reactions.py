"""A place of rest -> every reaction there, by the balance of the bodies."""

from __future__ import annotations

from eomgen.errors import DerivationError
from eomgen.mechanics.balance.balance_solution import Indeterminate
from eomgen.mechanics.balance.named_reactions import NamedReaction, named_reactions
from eomgen.mechanics.equations.system import System
from eomgen.mechanics.equilibria.search import Equilibrium
from eomgen.mechanics.equilibria.standing import standing_system
from eomgen.mechanics.reactions.reactions import Reactions, reactions_of
from eomgen.records import dataclass
from eomgen.symbolic.exact.normal_form import simplest
from eomgen.symbolic.expression.derivative import substituted
from eomgen.symbolic.expression.graph import Node, Scalar
from eomgen.symbolic.expression.rational import Fraction
from eomgen.symbolic.numeric.work import Work


@dataclass(frozen=True)
class RestingReaction:
    """One reaction at a place of rest.

    Args:
        named: what it is.
        value: a scalar of the parameters, None where it is statically indeterminate.
    """

    named: NamedReaction
    value: Scalar | None


def system_at_rest(place: Equilibrium) -> System:
    """The system as it stands there: at rest declared speeds do not matter, nor whether they determine the rates."""
    system = place.statics.system
    return standing_system(system if system.free is None or system.elimination is not None else system.free)


def state_at_rest(place: Equilibrium) -> dict[Node, Scalar]:
    """Everything that moves, at rest there: exact, or the exact numbers that its floats are."""
    system = system_at_rest(place)
    symbols = system.symbols
    still: dict[Node, Scalar] = {symbols.t: 0, **dict.fromkeys((*symbols.u, *symbols.a), 0)}
    inputs = {x: place.statics.given[x] for x in symbols.inputs.values()}
    at = place.exact if place.is_exact else {q: Fraction(place.numbers[q]) for q in symbols.q}
    return {**still, **inputs, **{q: at[q] for q in symbols.q}}


def reactions_at(place: Equilibrium) -> tuple[Reactions, tuple[RestingReaction, ...]]:
    """Every reaction of joints and ties.

    Raises:
        DerivationError: a force acts at no place, so that reactions do not follow.
    """
    system, state = system_at_rest(place), state_at_rest(place)
    reactions = reactions_of(system, state, work=Work.ANSWER if place.is_exact else Work.PART)
    positive = system.scope.positive
    found = []
    for named in named_reactions(reactions.balance):
        *factors, given = substituted((*named.combination.values(), named.given), state)
        try:
            sum_ = reactions.combined(dict(zip(named.combination, factors, strict=True)), named.name)
            value = sum_ + given
            found.append(RestingReaction(named, simplest(value, Work.VALUE, positive) if place.is_exact else value))
        except Indeterminate:
            found.append(RestingReaction(named, None))
    return reactions, tuple(found)


ReactionsOrWhy = tuple[Reactions | None, tuple[RestingReaction, ...], str]


def reactions_or_why(place: Equilibrium) -> ReactionsOrWhy:
    """(reactions, each of them, why there are none)."""
    try:
        return *reactions_at(place), ""
    except DerivationError as error:
        return None, (), f"{error.what}; {error.mend}" if error.mend else error.what
