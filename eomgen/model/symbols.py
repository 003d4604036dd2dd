"""How a part is called in formulas, where it says so: LaTeX, checked when it is read."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from typing import Annotated, Any

from eomgen.errors import ExpressionError
from eomgen.model.fields import Leaf
from eomgen.model.findings import Decimal, Finding, shown, unknown_keys
from eomgen.model.positions import DocumentPath
from eomgen.model.table import Table
from eomgen.symbolic.print.declared_symbol import LONGEST, parse_symbol
from eomgen.symbolic.print.symbols import Symbol

REACTIONS = ("x", "y", "z", "n", "t", "s", "couple", "tension", "drive")
LIKE = r"like '\theta_A' or 'J_C', in single quotes"


@dataclass(frozen=True)
class SymbolRule:
    r"""LaTeX of one symbol: 'J_C', '\dot\gamma'."""

    def read(self, raw: Any, path: DocumentPath, found: list[Finding]) -> Symbol | None:
        if isinstance(raw, Symbol):
            return raw
        if not isinstance(raw, str) or isinstance(raw, Decimal):
            found.append(Finding(path, f"a symbol is needed here, not {shown(raw)}", LIKE))
            return None
        try:
            return parse_symbol(raw)
        except ExpressionError as error:
            found.append(Finding(path, error.what, error.mend, error.column, error.length, raw=raw))
            return None

    def leaves(self, value: Any, path: DocumentPath, part: Any) -> Iterator[Leaf]:
        yield Leaf(path, self, value, part)

    def schema(self, definitions: dict[str, Any]) -> dict[str, Any]:
        return {"type": "string", "description": "a symbol in LaTeX", "minLength": 1, "maxLength": LONGEST}


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
            letter = SymbolRule().read(raw, path, found)
            return None if letter is None else ReactionSymbols(letter)
        unknown_keys(raw, REACTIONS, path, found, "the symbols of reactions")
        read = {label: SymbolRule().read(raw[label], (*path, label), found) for label in REACTIONS if label in raw}
        return ReactionSymbols(None, Table({label: symbol for label, symbol in read.items() if symbol is not None}))

    def leaves(self, value: Any, path: DocumentPath, part: Any) -> Iterator[Leaf]:
        if value.letter is not None:
            yield Leaf(path, self, value.letter, part)
        for label, symbol in value.each.items():
            yield Leaf((*path, label), self, symbol, part)

    def schema(self, definitions: dict[str, Any]) -> dict[str, Any]:
        one = SymbolRule().schema(definitions)
        table = {"type": "object", "properties": dict.fromkeys(REACTIONS, one), "additionalProperties": False}
        return {"anyOf": [one, table]}


SymbolField = Annotated[Symbol, SymbolRule()]
ReactionSymbolsField = Annotated[ReactionSymbols, ReactionSymbolsRule()]
