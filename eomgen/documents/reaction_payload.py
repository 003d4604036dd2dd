"""System -> every reaction by its name, for machines: with accelerations, without them where that is short."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from eomgen.documents.reaction_values import Readings, readings_of
from eomgen.documents.reading import LONGEST, Reader, length_in_print, readable_value, without_cases
from eomgen.errors import DerivationError
from eomgen.mechanics.balance.balance_solution import Indeterminate
from eomgen.mechanics.balance.named_reactions import NamedReaction, named_reactions
from eomgen.mechanics.equations.equations_of_motion import EquationsOfMotion
from eomgen.mechanics.reactions.reactions import determinate_sums
from eomgen.records import dataclass
from eomgen.symbolic.expression.derivative import depends_on
from eomgen.symbolic.expression.graph import Scalar, is_zero
from eomgen.symbolic.expression.traversal import operations
from eomgen.symbolic.print.text import text_size, to_text, with_definitions

LONGEST_SUM = 200  # characters of a sum of reactions that is told
LARGEST = 2_000_000  # characters of all reactions together that are written out in full
NAMED_PART = 200  # characters of a text in which long parts have names


def reactions_payload(equations: EquationsOfMotion, taken: frozenset[str]) -> dict[str, Any]:
    """`reactions` {name: text, null where it is indeterminate}, `reaction_null_space` [{name: coefficient}, ...].

    Texts hold q, u, and accelerations as `theta''`. Long ones share parts, under `reaction_definitions`; where there
    are no reactions, `reactions_message` says why.

    Args:
        taken: names that no shared part may have.
    """
    try:
        readings = readings_of(equations, Reader(positive=equations.system.scope.positive))
        names = named_reactions(readings.ways[0].balance)
    except DerivationError as error:
        message = f"{error.what}; {error.mend}" if error.mend else error.what
        return {"reactions": {}, "reaction_null_space": [], "reactions_message": message}
    values = [_value(readings, named) for named in names]
    spaces = _null_space(readings, names)
    flat = [x for x in values if x is not None] + [x for space in spaces for x in space.values()]
    definitions, texts = _texts(readings, flat, taken)
    rest = iter(texts)
    found = {
        "reactions": {n.name: None if x is None else next(rest) for n, x in zip(names, values, strict=True)},
        "reaction_null_space": [{name: next(rest) for name in space} for space in spaces],
    }
    return {**found, **({"reaction_definitions": [list(pair) for pair in definitions]} if definitions else {})}


def null_space(equations: EquationsOfMotion) -> list[dict[str, str]]:
    """What may be added to indeterminate reactions without a trace: for each free one {name: coefficient}."""
    readings = readings_of(equations, Reader(positive=equations.system.scope.positive))
    spaces = _null_space(readings, named_reactions(readings.ways[0].balance))
    texts = iter(_texts(readings, [x for space in spaces for x in space.values()], frozenset())[1])
    return [{name: next(texts) for name in space} for space in spaces]


def sums_of_open(equations: EquationsOfMotion) -> tuple[tuple[str, str], ...]:
    """(text as an output asks it, unit) of sums of indeterminate reactions that have one value, as far as short."""
    readings = readings_of(equations, Reader(positive=equations.system.scope.positive))
    names = named_reactions(readings.ways[0].balance)
    units, graph = {named.name: named.unit for named in names}, equations.system.scope.graph
    found = []
    for combination in determinate_sums(_null_space(readings, names)):
        reader, positive = readings.reader, equations.system.scope.positive
        terms = [readable_value(reader, k, positive) * graph.symbol(name) for name, k in combination.items()]
        text = to_text(sum(terms, start=0))
        if len(text) <= LONGEST_SUM:
            found.append((text, units[next(iter(combination))]))
    return tuple(found)


def _value(readings: Readings, named: NamedReaction) -> Scalar | None:
    try:
        return readings.with_accelerations(named.combination, named.given)
    except Indeterminate:
        return None


def _null_space(readings: Readings, names: Sequence[NamedReaction]) -> list[dict[str, Scalar]]:
    solution = readings.ways[0].solution
    return [_share(readings, names, f) for f in solution.free]


def _share(readings: Readings, names: Sequence[NamedReaction], free: int) -> dict[str, Scalar]:
    """What a unit of one free component adds to each reaction; those to which it adds nothing are left out."""
    shares = readings.ways[0].solution.shares
    found = {}
    for named in names:
        total: Scalar = 0
        for j, k in named.combination.items():
            if j == free:
                total = total + k
            elif free in shares.get(j, {}):
                total = total - k * shares[j][free]
        total = readable_value(readings.reader, total, readings.system.scope.positive)
        if not is_zero(total):
            found[named.name] = total
    return found


def _texts(
    readings: Readings, scalars: Sequence[Scalar], taken: frozenset[str]
) -> tuple[list[tuple[str, str]], list[str]]:
    written = without_cases([readings.reader.whole(x) for x in scalars])
    if sum(map(text_size, written)) <= LARGEST:
        return [], [to_text(x) for x in written]
    return with_definitions(written, NAMED_PART, taken)


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


def reaction_formulas(equations: EquationsOfMotion) -> dict[str, ReactionFormula]:
    """The formula of every reaction.

    Raises:
        DerivationError: a body is held by nothing; a force acts at no place.
    """
    readings = readings_of(equations, Reader(positive=equations.system.scope.positive))
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
