"""System -> the formula of every reaction by its name: without accelerations where that is short, else with them."""

from __future__ import annotations

from dataclasses import dataclass

from eomgen.mechanics.balance.balance_solution import Indeterminate
from eomgen.mechanics.balance.named_reactions import NamedReaction, named_reactions
from eomgen.mechanics.equations.assembly import Assembly
from eomgen.mechanics.equations.system import System
from eomgen.report.reaction_values import Readings, readings_of
from eomgen.report.reading import LONGEST, Reader, length_in_print, without_cases
from eomgen.symbolic.expression.derivative import depends_on
from eomgen.symbolic.expression.graph import Scalar
from eomgen.symbolic.expression.traversal import operations
from eomgen.symbolic.print.text import text_size, to_text

SHORT = 600  # characters of a formula in which accelerations were replaced
CLEARER = 3  # times as long as with accelerations: longer ones keep them


@dataclass(frozen=True)
class ReactionFormula:
    """One reaction.

    Args:
        text: of q, u and t, of accelerations as `theta''` where these are left in it; None where it is too long, or
            has no single value.
        accelerated: whether accelerations stand in it.
        message: why there is no text, or None.
    """

    text: str | None
    accelerated: bool = False
    message: str | None = None


def reaction_formulas(system: System, assembly: Assembly) -> dict[str, ReactionFormula]:
    """The formula of every reaction.

    Raises:
        DerivationError: a body is held by nothing; a force acts at no place.
    """
    readings = readings_of(system, Reader(), assembly)
    return {named.name: _formula(readings, named) for named in named_reactions(readings.ways[0].balance)}


def _formula(readings: Readings, named: NamedReaction) -> ReactionFormula:
    try:
        readings.ways[0].combined(named.combination, named.name)
    except Indeterminate as error:
        return ReactionFormula(None, message=f"{error.what}; {error.mend}")
    with_a = readings.with_accelerations(named.combination, named.given)
    without = readings.without(named.combination, named.given)
    if without is not None and length_in_print(without) <= min(SHORT, CLEARER * length_in_print(with_a)):
        return ReactionFormula(_text(readings.reader, without))
    if text_size(with_a) <= LONGEST:
        return ReactionFormula(_text(readings.reader, with_a), depends_on(with_a, readings.system.symbols.a))
    number = operations((with_a,)).total
    return ReactionFormula(None, message=f"its formula takes {number} operations and is not printed")


def _text(reader: Reader, x: Scalar) -> str:
    return to_text(without_cases((reader.whole(x),))[0])
