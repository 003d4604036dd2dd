"""How a part is called in formulas, where it says so: LaTeX, checked when it is read."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import Annotated, Any

from eomgen.model.fields import Leaf, ParsedTextRule
from eomgen.model.findings import Finding, unknown_keys
from eomgen.model.positions import DocumentPath
from eomgen.model.table import Table
from eomgen.records import dataclass
from eomgen.symbolic.print.declared_symbol import LONGEST, parse_symbol
from eomgen.symbolic.print.symbols import Symbol

REACTIONS = ("x", "y", "z", "n", "t", "s", "couple", "tension", "drive")
SYMBOL = ParsedTextRule(
    Symbol,
    parse_symbol,
    "a symbol",
    r"like '\theta_A' or 'J_C', in single quotes",
    (("minLength", 1), ("maxLength", LONGEST)),
)


@dataclass(frozen=True)
class ReactionSymbols:
    """What the reactions of a joint or a tie are called.

    Args:
        letter: of all of them: A gives A_x, A_y, M_A; of one that is alone its symbol.
        each: the symbol of a component by its label: {x: H, n: N_1}.
    """

    letter: Symbol | None = None
    each: Table[Symbol] = Table()


@dataclass(frozen=True)
class ReactionSymbolsRule:
    """One symbol for all reactions, or a table with one for each: { x = 'H', y = 'V' }."""

    def read(self, raw: Any, path: DocumentPath, found: list[Finding]) -> ReactionSymbols | None:
        if isinstance(raw, ReactionSymbols):
            return raw
        if not isinstance(raw, Mapping):
            letter = SYMBOL.read(raw, path, found)
            return None if letter is None else ReactionSymbols(letter)
        unknown_keys(raw, REACTIONS, path, found, "the symbols of reactions")
        read = {label: SYMBOL.read(raw[label], (*path, label), found) for label in REACTIONS if label in raw}
        return ReactionSymbols(None, Table({label: symbol for label, symbol in read.items() if symbol is not None}))

    def leaves(self, value: Any, path: DocumentPath, part: Any) -> Iterator[Leaf]:
        if value.letter is not None:
            yield Leaf(path, self, value.letter, part)
        for label, symbol in value.each.items():
            yield Leaf((*path, label), self, symbol, part)

    def schema(self, definitions: dict[str, Any]) -> dict[str, Any]:
        one = SYMBOL.schema(definitions)
        table = {"type": "object", "properties": dict.fromkeys(REACTIONS, one), "additionalProperties": False}
        return {"anyOf": [one, table]}


SymbolField = Annotated[Symbol, SYMBOL]
ReactionSymbolsField = Annotated[ReactionSymbols, ReactionSymbolsRule()]
