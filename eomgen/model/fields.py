"""Rules for the values of a model: one rule for each concept, and rules made of rules.

A rule says what a value may be; it stands once, in a field's type.

A part of the model is a frozen dataclass whose fields are annotated `Annotated[type, rule]`. From
these rules alone come the reading of texts and numbers (`read`), the walk that every check makes
(`leaves`) and the JSON Schema (`schema`). Nothing is computed here.
"""

import re
from collections.abc import Callable, Iterable, Iterator, Mapping
from math import isfinite
from typing import Any, Generic, TypeVar

from eomgen.errors import ExpressionError
from eomgen.frozen import dataclass
from eomgen.model.diagnostics import Decimal, Diagnostic, article, nearest, shown, unknown_keys, whereabouts
from eomgen.model.positions import DocumentPath
from eomgen.model.quantities import Unit, parse_typed_equation
from eomgen.symbolic.expression import Expression, as_expression, is_exact

PARAMETERS = "parameters"  # what names may stand in an expression: parameters only
TIME = "parameters and time"
FLOWING = "parameters, states and time"
CONFIGURATION = "parameters, coordinates and time"
RATES = "parameters, coordinates, their rates and time"
SPEEDS = "parameters, coordinates, their rates, speeds and time"
MOTION = "parameters, coordinates, rates, speeds, states, inputs and time"
STATE = "parameters, coordinates, rates, speeds, accelerations, states, inputs and time"
EVERY = "every"  # event of a run
EVERYTHING = "all names, accelerations and functions of the motion"

Parsed = TypeVar("Parsed")


@dataclass(frozen=True)
class Leaf:
    """A value that a rule reads at once (an expression, a vector, a name), and where it stands."""

    path: DocumentPath
    rule: Any
    value: Any
    part: Any = None

    @property
    def whereabouts(self) -> str:
        """Its place in words: "'mass' of body 'rod'"."""
        return whereabouts(self.path)


class Alternatives(list[Any]):
    """References of which the first that is declared is meant where one is expected; elsewhere they are a list.

    Args:
        chosen: it.
        is_place: it is a point, and no component of a vector.
    """

    def __init__(self, items: Iterable[Any], chosen: Any = None, *, is_place: bool = False) -> None:
        super().__init__(items)
        self.chosen, self.is_place = chosen, is_place


def _as_one(raw: Any) -> Any:
    """The reference that is meant where one is expected."""
    return raw.chosen if isinstance(raw, Alternatives) else raw


class WholeRule:
    """A rule whose value has no parts of its own."""

    def leaves(self, value: Any, path: DocumentPath, part: Any) -> Iterator[Leaf]:
        yield Leaf(path, self, value, part)


def read_text(parse: Callable[[], Parsed], raw: Any, path: DocumentPath, found: list[Diagnostic]) -> Parsed | None:
    """The result of a grammar's parser on a text; None, and a diagnostic at its column, where the text is wrong."""
    try:
        return parse()
    except ExpressionError as error:
        found.append(Diagnostic(path, error.what, error.fix, error.column, error.length, raw=raw))
        return None


def read_items(rule: Any, raw: Iterable[Any], path: DocumentPath, found: list[Diagnostic]) -> tuple[Any, ...] | None:
    """Every item by one rule; None where one of them is wrong."""
    items = [rule.read(x, (*path, i), found) for i, x in enumerate(raw)]
    return None if None in items else tuple(items)


@dataclass(frozen=True)
class FormulaRule(WholeRule):
    """A number or the text of an expression.

    Args:
        unit: the SI unit that the value has (None: not known from the field alone).
        sign: "" any, "nonnegative", or "positive".
        scope: which names may stand in it.
        words: texts that stand for themselves (`length = "start"`).
        also: names that mean something here only (`r` of `between`), rates with a prime, and in which unit.
        functions: of the motion, that may be called: x(bead.center).
        usually: effect of a value below zero that is hardly intended.
        in_own_unit: a plain number is in the unit that a coordinate declares.
        like: fields of the part, of which one is given: the value is in its unit.
        same_as, works_on: the field of the part that names a coordinate: the value is one of it, or does work on it.
    """

    unit: str | None = None
    sign: str = ""
    scope: str = PARAMETERS
    words: tuple[str, ...] = ()
    also: tuple[str, ...] = ()
    also_in: str = "1"
    functions: tuple[str, ...] = ()
    usually: str = ""
    same_as: str = ""
    works_on: str = ""
    in_own_unit: bool = False
    like: tuple[str, ...] = ()

    def read(self, raw: Any, path: DocumentPath, found: list[Diagnostic]) -> Any:
        if isinstance(raw, Mapping):
            return self._quantity(raw, path, found)
        if isinstance(raw, str) and raw in self.words:
            return str(raw)
        return _expression(raw, path, found, references=bool(self.functions))

    def _quantity(self, raw: Mapping[str, Any], path: DocumentPath, found: list[Diagnostic]) -> Expression | None:
        unknown_keys(raw, ("value", "unit"), path, found, "a quantity")
        if "value" not in raw:
            found.append(Diagnostic(path, "a quantity without 'value'", 'write { value = 40, unit = "cm" }'))
            return None
        unit = UNIT.read(raw["unit"], (*path, "unit"), found) if "unit" in raw else None
        if unit is not None and self.unit is not None and not unit.fits(Unit.parse(self.unit)):
            what = f"the unit '{unit.text}' does not fit: this is in {named(self.unit)}"
            found.append(Diagnostic((*path, "unit"), what))
        value = _expression(raw["value"], (*path, "value"), found)
        if value is not None and unit is not None and is_mixed(value, unit):
            found.append(mixed(value, unit, (*path, "value")))
        return in_si(value, unit)

    def schema(self, definitions: dict[str, Any]) -> dict[str, Any]:
        return {"$ref": "#/$defs/quantity"}


def named(unit: str) -> str:
    """A unit in a message."""
    return "radians or a pure number" if unit in ("", "1", "rad") else unit


def in_si(value: Expression | None, unit: Unit | None) -> Expression | None:
    """A value given in a unit, exactly in SI; with names in it, it is in SI already and stays (`is_mixed`)."""
    if value is None or unit is None or is_mixed(value, unit):
        return value
    return unit.expression_in_si(value)


def is_in_si(raw: Any) -> bool:
    """True of a raw value that is in SI once it is read: a quantity with a unit of its own, or an Expression."""
    return isinstance(raw, Expression) or (isinstance(raw, Mapping) and "unit" in raw)


def is_mixed(value: Expression, unit: Unit) -> bool:
    """True if a value contains parameters, which are in SI, and has a unit that is not: it may mean two things."""
    return bool(value.names - {"pi", "t"}) and (unit.factor != 1 or unit.pi_power != 0)


def mixed(value: Expression, unit: Unit, path: DocumentPath) -> Diagnostic:
    """The diagnostic of a value that is_mixed."""
    what = f"'{value.text}' has names in it, which are in SI, but the unit '{unit.text}' is not"
    return Diagnostic(path, what, "leave the unit out, or give it to the numbers")


def _expression(raw: Any, path: DocumentPath, found: list[Diagnostic], references: bool = False) -> Expression | None:
    if isinstance(raw, bool) or not (is_exact(raw) or isinstance(raw, (float, str, Expression))):
        found.append(Diagnostic(path, f"a number or an expression is needed here, not {shown(raw)}"))
        return None
    return read_text(lambda: as_expression(raw, references=references), raw, path, found)


@dataclass(frozen=True)
class OutputRule(WholeRule):
    """An expression that may call functions of the motion: `speed(bar.end)`."""

    scope: str = EVERYTHING

    def read(self, raw: Any, path: DocumentPath, found: list[Diagnostic]) -> Expression | None:
        return _expression(raw, path, found, references=True)

    def schema(self, definitions: dict[str, Any]) -> dict[str, Any]:
        return {"$ref": "#/$defs/expression"}


@dataclass(frozen=True)
class WrittenEquation:
    """left = right, as it was written.

    Args:
        units: those that were typed behind the sides, of which plain numbers are not in SI yet; None: all is in SI.
    """

    left: Expression
    right: Expression
    text: str
    units: tuple[Unit | None, Unit | None] | None = None


@dataclass(frozen=True)
class EquationRule(WholeRule):
    """An equation between expressions that may call functions of the motion: `theta = pi/2`."""

    scope: str = EVERYTHING

    def read(self, raw: Any, path: DocumentPath, found: list[Diagnostic]) -> WrittenEquation | None:
        if isinstance(raw, WrittenEquation):
            return raw
        if not isinstance(raw, str) or isinstance(raw, Decimal):
            found.append(Diagnostic(path, f"an equation is needed here, not {shown(raw)}", 'like "theta = pi/2"'))
            return None
        sides = read_text(lambda: parse_typed_equation(raw), raw, path, found)
        if sides is None:
            return None
        (left, one), (right, other) = sides
        return WrittenEquation(left, right, raw, (one, other))

    def schema(self, definitions: dict[str, Any]) -> dict[str, Any]:
        return {"type": "string", "description": "an equation, like theta = pi/2"}


@dataclass(frozen=True)
class AtRest:
    """The place at which all forces balance, instead of an instant."""

    text: str = "equilibrium"


@dataclass(frozen=True)
class InstantRule(EquationRule):
    """An equation that defines an instant, or the word "equilibrium"."""

    def read(self, raw: Any, path: DocumentPath, found: list[Diagnostic]) -> Any:
        if isinstance(raw, AtRest) or raw == AtRest.text:
            return AtRest()
        return EquationRule.read(self, raw, path, found)

    def schema(self, definitions: dict[str, Any]) -> dict[str, Any]:
        return {"type": "string", "description": "an equation, like theta = pi/2, or equilibrium"}


@dataclass(frozen=True)
class VectorRule:
    """A list of expressions, two in the plane and three in space (or always `length`).

    Args:
        item: the rule of a component.
        length: how many (None: as the space says).
        point, own_point: a name may stand for it, of a point of the ground, or of the body whose table this is.
        nonzero: a direction, so not all of it may be 0.
        downward: its last component, where it is the only one, is hardly above zero.
    """

    item: FormulaRule = FormulaRule()
    length: int | None = None
    point: bool = False
    own_point: bool = False
    nonzero: bool = False
    downward: bool = False

    def read(self, raw: Any, path: DocumentPath, found: list[Diagnostic]) -> Any:
        raw = _as_one(raw) if (self.point or self.own_point) and getattr(raw, "is_place", True) else raw
        if (self.point or self.own_point) and isinstance(raw, str) and not isinstance(raw, Decimal):
            return str(raw)
        if not isinstance(raw, (list, tuple)):
            of = "ground" if self.point else "body"
            also = f" or the name of a point of the {of}" if self.point or self.own_point else ""
            what = f"a list of components{also} is needed here, not {shown(raw)}"
            found.append(Diagnostic(path, what, 'write one for each axis: [1, 0], [0, "-g"]'))
            return None
        return read_items(self.item, raw, path, found)

    def leaves(self, value: Any, path: DocumentPath, part: Any) -> Iterator[Leaf]:
        yield Leaf(path, self, value, part)
        if not isinstance(value, str):
            for i, x in enumerate(value):
                yield from self.item.leaves(x, (*path, i), part)

    def schema(self, definitions: dict[str, Any]) -> dict[str, Any]:
        low, high = (self.length, self.length) if self.length else (2, 3)
        vector = {"type": "array", "items": self.item.schema(definitions), "minItems": low, "maxItems": high}
        return {"anyOf": [{"type": "string"}, vector]} if self.point or self.own_point else vector


@dataclass(frozen=True)
class AxialRule:
    """A value with one component in the plane (about z) and several in space: a couple, an inertia.

    Args:
        item: the rule of a component.
        lengths: how many components it may have in space.
    """

    item: FormulaRule
    lengths: tuple[int, ...] = (3,)

    def read(self, raw: Any, path: DocumentPath, found: list[Diagnostic]) -> Any:
        if not isinstance(raw, (list, tuple)):
            value = self.item.read(raw, path, found)
            return None if value is None else (value,)
        return read_items(self.item, raw, path, found)

    def leaves(self, value: Any, path: DocumentPath, part: Any) -> Iterator[Leaf]:
        yield Leaf(path, self, value, part)
        for i, x in enumerate(value):
            yield from self.item.leaves(x, path if len(value) == 1 else (*path, i), part)

    def schema(self, definitions: dict[str, Any]) -> dict[str, Any]:
        one = self.item.schema(definitions)
        low, high = min(self.lengths), max(self.lengths)
        return {"anyOf": [one, {"type": "array", "items": one, "minItems": low, "maxItems": high}]}


@dataclass(frozen=True)
class NameRule(WholeRule):
    """The name of something declared elsewhere.

    Args:
        of: "body", "point" (`O`, `arm.end`), "own point" (of the body whose table this is), "seat" (a body or a
            body's point), "coordinate", "speed", "free speed" or "axes" ("ground" or a body).
    """

    of: str

    def read(self, raw: Any, path: DocumentPath, found: list[Diagnostic]) -> str | None:
        raw = _as_one(raw)
        if isinstance(raw, str) and not isinstance(raw, Decimal) and raw:
            return str(raw)
        fix = 'give it a name in [points], like P = [0, 3], and write "P"' if isinstance(raw, list) else ""
        what = f"the name of {article(self.of)} is needed here, not {shown(raw)}"
        found.append(Diagnostic(path, what, fix if self.of == "point" else ""))
        return None

    def schema(self, definitions: dict[str, Any]) -> dict[str, Any]:
        one = {"type": "string", "description": f"the name of {article(self.of)}"}
        first = {"type": "array", "items": {"type": "string"}, "minItems": 2, "description": "the first that there is"}
        return {"anyOf": [one, first]}


@dataclass(frozen=True)
class TextRule(WholeRule):
    """A text, or one of a few words (`options`)."""

    options: tuple[str, ...] = ()

    def read(self, raw: Any, path: DocumentPath, found: list[Diagnostic]) -> str | None:
        if not isinstance(raw, str) or isinstance(raw, Decimal):
            fix = "write " + " or ".join(f'"{word}"' for word in self.options) if self.options else ""
            found.append(Diagnostic(path, f"a text is needed here, not {shown(raw)}", fix))
            return None
        if self.options and raw not in self.options:
            listed = ", ".join(f"'{word}'" for word in self.options)
            fix = nearest(raw, self.options) or f"use one of {listed}"
            found.append(Diagnostic(path, f"unknown word {shown(raw)}", fix))
            return None
        return str(raw)

    def schema(self, definitions: dict[str, Any]) -> dict[str, Any]:
        return {"enum": list(self.options)} if self.options else {"type": "string"}


STATEMENT = re.compile(r"\$(?P<math>[^$]*)\$|\{(?P<name>[^{}]*)\}|(?P<open>\$)|\\(?P<plain>[$\\{}])")
"""Parts of a statement of a problem that are no words: $formula$, {name}, a dollar alone, and signs behind a bar."""


@dataclass(frozen=True)
class StatementRule(TextRule):
    """Words of a problem: `$\\varphi_0$` is a formula in LaTeX, `{m}` a declared name with its value and unit."""

    def read(self, raw: Any, path: DocumentPath, found: list[Diagnostic]) -> str | None:
        text = TextRule.read(self, raw, path, found)
        for each in STATEMENT.finditer(text or ""):
            if each["open"]:
                fix = "write \\\\$ for a dollar in double quotes, \\$ in single quotes"
                found.append(Diagnostic(path, "a formula begins at $ and does not end", fix, each.start(), 1))
        return text


@dataclass(frozen=True)
class NumbersRule(WholeRule):
    """Numbers from which the values of variants are drawn: two ends, or a list of values."""

    def read(self, raw: Any, path: DocumentPath, found: list[Diagnostic]) -> tuple[Any, ...] | None:
        given = raw if isinstance(raw, (list, tuple)) else ()
        numbers = [float(x) for x in given if not isinstance(x, bool) and isinstance(x, (int, float, Decimal))]
        if len(numbers) < 2 or len(numbers) < len(given) or not all(map(isfinite, numbers)):
            fix = "write range = [0.5, 2] for all between, or a list of values: [1, 2, 5]"
            found.append(Diagnostic(path, f"two numbers or more are needed here, not {shown(raw)}", fix))
            return None
        if len(numbers) == 2 and numbers[0] >= numbers[1]:
            found.append(
                Diagnostic(path, "the first end of a range is not below the second", "give the lower one first")
            )
            return None
        return tuple(given)

    def schema(self, definitions: dict[str, Any]) -> dict[str, Any]:
        return {"type": "array", "items": {"type": "number"}, "minItems": 2}


@dataclass(frozen=True)
class CountRule(WholeRule):
    """A whole number between two others, ends included."""

    least: int
    most: int

    def read(self, raw: Any, path: DocumentPath, found: list[Diagnostic]) -> int | None:
        whole = not isinstance(raw, (bool, str)) and isinstance(raw, (int, Decimal)) and raw == int(raw)
        if whole and self.least <= int(raw) <= self.most:
            return int(raw)
        what = f"a whole number from {self.least} to {self.most} is needed here, not {shown(raw)}"
        found.append(Diagnostic(path, what))
        return None

    def schema(self, definitions: dict[str, Any]) -> dict[str, Any]:
        return {"type": "integer", "minimum": self.least, "maximum": self.most}


@dataclass(frozen=True)
class EventRule(WholeRule):
    """The number of one of several events, from 1 on, or "every"."""

    def read(self, raw: Any, path: DocumentPath, found: list[Diagnostic]) -> int | str | None:
        whole = not isinstance(raw, (bool, str)) and isinstance(raw, (int, Decimal)) and raw == int(raw)
        if raw == EVERY:
            return EVERY
        if whole and int(raw) >= 1:
            return int(raw)
        found.append(
            Diagnostic(path, f"the number of an event is needed here, not {shown(raw)}", f'like 2, or "{EVERY}"')
        )
        return None

    def schema(self, definitions: dict[str, Any]) -> dict[str, Any]:
        return {"anyOf": [{"type": "integer", "minimum": 1}, {"const": EVERY}]}


@dataclass(frozen=True)
class FlagRule(WholeRule):
    """true or false."""

    def read(self, raw: Any, path: DocumentPath, found: list[Diagnostic]) -> bool | None:
        if isinstance(raw, bool):
            return raw
        found.append(Diagnostic(path, f"true or false is needed here, not {shown(raw)}"))
        return None

    def schema(self, definitions: dict[str, Any]) -> dict[str, Any]:
        return {"type": "boolean"}


@dataclass(frozen=True)
class ParsedTextRule(WholeRule, Generic[Parsed]):
    """A text that has a grammar of its own: a unit, a symbol in LaTeX.

    Args:
        of: what it is read into.
        parse: reads it.
        needed: what a value must be, for messages.
        like: an example, as the fix of another thing.
        limits: of the text, in the words of JSON Schema.
    """

    of: type[Parsed]
    parse: Callable[[str], Parsed]
    needed: str
    like: str
    limits: tuple[tuple[str, int], ...] = ()

    def read(self, raw: Any, path: DocumentPath, found: list[Diagnostic]) -> Parsed | None:
        if isinstance(raw, self.of):
            return raw
        if not isinstance(raw, str) or isinstance(raw, Decimal):
            found.append(Diagnostic(path, f"{self.needed} is needed here, not {shown(raw)}", self.like))
            return None
        return read_text(lambda: self.parse(raw), raw, path, found)

    def schema(self, definitions: dict[str, Any]) -> dict[str, Any]:
        return {"type": "string", "description": f"{self.needed}, {self.like}", **dict(self.limits)}


UNIT = ParsedTextRule(Unit, Unit.parse, "a unit", 'like "kg*m^2"')


# -------- table -----------------------------------------------------------------------------------------------
# A mapping that stays as it was made: ordered, hashable, read-only.


Value = TypeVar("Value")


class Table(Mapping[str, Value], Generic[Value]):
    """A read-only mapping that keeps its order; two in another order are not equal (the order of q is a fact)."""

    __slots__ = ("_items",)

    def __init__(self, items: Mapping[str, Value] | None = None) -> None:
        self._items = dict(items or {})

    def __getitem__(self, name: str) -> Value:
        return self._items[name]

    def __iter__(self) -> Iterator[str]:
        return iter(self._items)

    def __len__(self) -> int:
        return len(self._items)

    def __hash__(self) -> int:
        return hash(tuple(self._items.items()))

    def __eq__(self, other: object) -> bool:
        if not isinstance(other, Mapping):
            return NotImplemented
        return list(self.items()) == list(other.items())

    def __repr__(self) -> str:
        return f"Table({', '.join(self._items)})"


# -------- containers ------------------------------------------------------------------------------------------
# Rules made of rules: a list of things, a table of named things, one thing or another.


@dataclass(frozen=True)
class ListRule:
    """A list of things of one rule (`single`: one of them may stand for itself)."""

    item: Any
    least: int = 1
    most: int | None = None
    single: bool = False

    def read(self, raw: Any, path: DocumentPath, found: list[Diagnostic]) -> tuple[Any, ...] | None:
        if self.single and not isinstance(raw, (list, tuple)):
            one = self.item.read(raw, path, found)
            return None if one is None else (one,)
        if not isinstance(raw, (list, tuple)):
            found.append(Diagnostic(path, f"a list is needed here, not {shown(raw)}"))
            return None
        if len(raw) < self.least or (self.most is not None and len(raw) > self.most):
            count = str(self.least) if self.least == self.most else f"at least {self.least}"
            count = f"at most {self.most}" if self.most is not None and len(raw) > self.most > self.least else count
            found.append(Diagnostic(path, f"{count} entries are needed here, not {len(raw)}"))
            return None
        return read_items(self.item, raw, path, found)

    def leaves(self, value: Any, path: DocumentPath, part: Any) -> Iterator[Leaf]:
        for i, x in enumerate(value):
            yield from self.item.leaves(x, path if self.single and len(value) == 1 else (*path, i), part)

    def schema(self, definitions: dict[str, Any]) -> dict[str, Any]:
        many: dict[str, Any] = {"type": "array", "items": self.item.schema(definitions), "minItems": self.least}
        if self.most is not None:
            many["maxItems"] = self.most
        return {"anyOf": [self.item.schema(definitions), many]} if self.single else many


@dataclass(frozen=True)
class TableRule:
    """A table of named things of one rule; `what` names one of them in messages."""

    item: Any
    what: str

    def read(self, raw: Any, path: DocumentPath, found: list[Diagnostic]) -> Table[Any] | None:
        if not isinstance(raw, Mapping):
            found.append(Diagnostic(path, f"a table of {self.what}s is needed here, not {shown(raw)}"))
            return None
        return Table({str(name): self.item.read(x, (*path, name), found) for name, x in raw.items()})

    def leaves(self, value: Any, path: DocumentPath, part: Any) -> Iterator[Leaf]:
        for name, x in value.items():
            if x is not None:
                yield from self.item.leaves(x, (*path, name), part)

    def schema(self, definitions: dict[str, Any]) -> dict[str, Any]:
        return {"type": "object", "additionalProperties": self.item.schema(definitions)}


@dataclass(frozen=True)
class EitherRule:
    """A text is read by one rule, anything else by another."""

    text: Any
    other: Any

    def _rule(self, value: Any) -> Any:
        value = _as_one(value) if isinstance(self.text, NameRule) else value
        return self.text if isinstance(value, str) and not isinstance(value, Decimal) else self.other

    def read(self, raw: Any, path: DocumentPath, found: list[Diagnostic]) -> Any:
        return self._rule(raw).read(raw, path, found)

    def leaves(self, value: Any, path: DocumentPath, part: Any) -> Iterator[Leaf]:
        yield from self._rule(value).leaves(value, path, part)

    def schema(self, definitions: dict[str, Any]) -> dict[str, Any]:
        return {"anyOf": [self.text.schema(definitions), self.other.schema(definitions)]}
