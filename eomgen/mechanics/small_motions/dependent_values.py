"""Reference -> the same with what its ties say of coordinates and speeds that nobody stated, in closed form."""

from __future__ import annotations

from eomgen.errors import DerivationError
from eomgen.mechanics.bodies.places import Located, places_of
from eomgen.mechanics.small_motions.field import Exact
from eomgen.mechanics.small_motions.first_order import Choice, FirstOrder, choice_of
from eomgen.mechanics.small_motions.reduction import dependent_speeds
from eomgen.mechanics.small_motions.reference import ReferenceMotion, in_closed_form
from eomgen.symbolic.expression.derivative import substituted
from eomgen.symbolic.expression.graph import Node
from eomgen.symbolic.numeric.evaluation import NoValue

MOST = 8  # dependent speeds that are taken out exactly


def with_followers(first: FirstOrder, reference: ReferenceMotion) -> ReferenceMotion:
    """The reference with dependent coordinates by phi = 0 and dependent speeds by J u + sigma = 0, as far as these are
    determined by what is known in closed form; a wheel's place from its turning."""
    symbols, choice = first.system.symbols, choice_of(first, reference, ())
    guessed = _guessed(first, choice)
    if (reference.is_exact and not guessed) or len(choice.du) > MOST:
        return reference
    positive = first.system.scope.positive
    located = Located({x: float(v) for x, v in reference.numbers.items()}, positive)
    known = {x: value for x, value in reference.exact.items() if x not in guessed}
    try:
        unknown = [q for q in symbols.q if q not in known]
        exact = {**reference.exact, **places_of(substituted(first.relations, known), unknown, located)}
        if all(x in exact for x in (*symbols.q, *(symbols.u[k] for k in choice.u))):
            exact |= dependent_speeds(first, choice, Exact(exact, positive, reference.trial))
    except (DerivationError, NoValue, ZeroDivisionError):  # too large, or a pivot that is 0 as a formula
        return reference
    found = {x: value for x, value in exact.items() if x in (*symbols.q, *symbols.u) and located.agrees(value, x)}
    return in_closed_form(reference, found)


def _guessed(first: FirstOrder, choice: Choice) -> frozenset[Node]:
    """Dependent coordinates of which the model only has a guess."""
    symbols, coordinates = first.system.symbols, first.system.scope.model.coordinates
    return frozenset(q for k in choice.dq if coordinates[(q := symbols.q[k]).name].near is not None)
