"""`[tables] M = { at = [...], values = [...] }` -> a function of any variable through values: M(n) in expressions."""

import re
from collections.abc import Iterator, Mapping
from itertools import pairwise
from typing import Annotated, Any, ClassVar

from eomgen.frozen import dataclass
from eomgen.model.diagnostics import Decimal, Diagnostic, shown
from eomgen.model.fields import UNIT, Alternatives, TextRule, WholeRule, WrittenEquation, read_text
from eomgen.model.kinds import Text
from eomgen.model.part import Part, PartRule
from eomgen.model.positions import DocumentPath
from eomgen.model.quantities import Unit
from eomgen.model.sampled_laws import MOST, number_given
from eomgen.symbolic.expression import (
    DeclaredSamples,
    Fraction,
    Sampled,
    TableFunction,
    parse,
    parse_equation,
    spline_of,
)

TABLES = "tables"
WAYS = ("pchip", "linear", "cubic")
"""of a table, the usual one first"""
_NOT_TEXT = ("kind", "unit", "at_unit", "about", "symbol", "text", "questions", "name", "source", "language")


@dataclass(frozen=True)
class NumbersRow(WholeRule):
    """Numbers in a row, as they are written."""

    def read(self, raw: Any, path: DocumentPath, found: list[Diagnostic]) -> tuple[Fraction, ...] | None:
        if not isinstance(raw, (list, tuple)) or not 2 <= len(raw) <= MOST:
            given = f"{len(raw)}" if isinstance(raw, (list, tuple)) else shown(raw)
            what = f"a list of 2 to {MOST} numbers is needed here, not {given}"
            found.append(Diagnostic(path, what, "at = [0, 1, 3], values = [2, 5, 4]"))
            return None
        numbers = [number_given(x, (*path, k), found) for k, x in enumerate(raw)]
        return None if None in numbers else tuple(x for x in numbers if x is not None)

    def schema(self, definitions: dict[str, Any]) -> dict[str, Any]:
        return {"type": "array", "items": {"type": "number"}, "minItems": 2, "maxItems": MOST}


@dataclass(frozen=True, kw_only=True)
class ValueTable(Part):
    """A function of any variable through values, monotone between them: a motor's curve, a spring's, a cam.

    Beyond the ends it goes on straight.

    Args:
        at: places, ascending, in `at_unit`.
        values: there, in `unit`.
        between: "pchip" (cubics, monotone where the values are), "linear" or "cubic" (f'' continuous; the first two
            pieces are one cubic, and so are the last two).
        unit: of the values.
        at_unit: of the places.
        about: a remark.
    """

    title: ClassVar[str] = "table"
    at: Annotated[tuple[Fraction, ...], NumbersRow()]
    values: Annotated[tuple[Fraction, ...], NumbersRow()]
    between: Annotated[str, TextRule(WAYS)] = WAYS[0]
    unit: Annotated[Unit, UNIT] | None = None
    at_unit: Annotated[Unit, UNIT] | None = None
    about: Text | None = None

    def diagnostics(self, path: DocumentPath) -> Iterator[Diagnostic]:
        """Diagnostics of places that do not ascend, or are not as many as the values."""
        if len(self.at) != len(self.values):
            what = f"{len(self.at)} places and {len(self.values)} values"
            yield Diagnostic((*path, "values"), what, "give each place its value")
        for k, (a, b) in enumerate(pairwise(self.at), start=1):
            if a >= b:
                yield Diagnostic((*path, "at", k), "the places do not ascend", "order them from the least on")
                return

    def function(self, name: str) -> TableFunction:
        """The function, of an argument and with values in SI."""
        at, units, measure = self.at, (_si(self.at_unit), _si(self.unit)), (Fraction(1), 0)
        if self.at_unit is not None and self.at_unit.pi_power:  # its places are no rational numbers in SI
            measure = (1 / Fraction(self.at_unit.factor), -self.at_unit.pi_power)
        elif self.at_unit is not None:
            at = tuple(x * self.at_unit.factor for x in at)
        function = spline_of(at, self.values, self.between)
        declared = DeclaredSamples(at, self.values, self.between, Sampled.ENDS[0])
        sampled = Sampled(name, function, 0, declared, True, units, measure)
        if self.unit is not None:
            sampled = sampled.scaled(self.unit.factor, self.unit.pi_power)
        return TableFunction(sampled)


def _si(unit: Unit | None) -> str:
    return "" if unit is None else unit.si


def functions_of_tables(raw: Any, found: list[Diagnostic]) -> dict[str, TableFunction]:
    """The functions that tables of a file declare, those of wrong ones left out: their own reading reports them."""
    functions = {}
    for name, entry in raw.items() if isinstance(raw, Mapping) else ():
        wrong: list[Diagnostic] = []
        table = PartRule(ValueTable).read(entry, (TABLES, str(name)), wrong)
        if not wrong and table is not None and None not in (table.at, table.values):
            wrong += table.diagnostics((TABLES, str(name)))
            found += wrong
            if not wrong:
                functions[str(name)] = table.function(str(name))
    return functions


def with_functions(raw: Any, functions: Mapping[str, TableFunction], found: list[Diagnostic]) -> Any:
    """The tables of a file, the texts that call a table read already."""
    calls = re.compile(rf"(?<![\w.])(?:{'|'.join(map(re.escape, functions))})'*\s*\(")
    rates = {f"{name}'": each.rate for name, each in functions.items()}
    known = {**functions, **rates, **{f"{name}'": each.rate for name, each in rates.items()}}

    def read(value: Any, path: DocumentPath) -> Any:
        if isinstance(value, Mapping):
            kept = (TABLES, *_NOT_TEXT) if not path else _NOT_TEXT
            return {key: x if key in kept else read(x, (*path, key)) for key, x in value.items()}
        if isinstance(value, Alternatives) and not any(map(calls.search, value)):  # references call nothing
            return value
        if isinstance(value, (list, tuple)):
            return (list if isinstance(value, list) else tuple)(read(x, (*path, k)) for k, x in enumerate(value))
        if not isinstance(value, str) or isinstance(value, Decimal) or not calls.search(value):
            return value
        if "=" in value:
            sides = read_text(lambda: parse_equation(value, tables=known), value, path, found)
            return value if sides is None else WrittenEquation(*sides, value, (None, None))
        made = read_text(lambda: parse(value, references=True, tables=known), value, path, found)
        return value if made is None else made

    return read(raw, ()) if functions else raw
