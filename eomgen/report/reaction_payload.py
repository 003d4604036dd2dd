"""System -> the reactions in `derive --json`: each by the name by which an output asks for it."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from eomgen.errors import DerivationError
from eomgen.mechanics.balance.balance_solution import Indeterminate
from eomgen.mechanics.balance.named_reactions import NamedReaction, named_reactions
from eomgen.mechanics.equations.assembly import Assembly
from eomgen.mechanics.equations.system import System
from eomgen.report.reaction_values import Readings, readings_of
from eomgen.report.reading import Reader, readable_value, without_cases
from eomgen.symbolic.expression.graph import Scalar, is_zero
from eomgen.symbolic.print.text import text_size, to_text, with_definitions

LARGEST = 2_000_000  # characters of all reactions together that are written out in full
NAMED_PART = 200  # characters of a text in which long parts have names


def reactions_payload(system: System, assembly: Assembly, taken: frozenset[str]) -> dict[str, Any]:
    """`reactions` {name: text, null where it is indeterminate}, `reaction_null_space` [{name: coefficient}, ...].

    Texts hold q, u, and accelerations as `theta''`. Long ones share parts, under `reaction_definitions`; where there
    are no reactions, `reactions_message` says why.

    Args:
        taken: names that no shared part may have.
    """
    try:
        readings = readings_of(system, Reader(), assembly)
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


def null_space(system: System, assembly: Assembly) -> list[dict[str, str]]:
    """What may be added to indeterminate reactions without a trace: for each free one {name: coefficient}."""
    readings = readings_of(system, Reader(), assembly)
    spaces = _null_space(readings, named_reactions(readings.ways[0].balance))
    texts = iter(_texts(readings, [x for space in spaces for x in space.values()], frozenset())[1])
    return [{name: next(texts) for name in space} for space in spaces]


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
        total = readable_value(readings.reader, total, readings.positive)
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
