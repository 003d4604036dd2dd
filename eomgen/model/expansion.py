"""Tables of a model file in which things repeat -> the tables that they stand for.

`[repeat]` gives indices: `i = 20` counts from 1, `[first, last]` from end to end, `"n"` to an integer parameter. What
has `{i}` in its name is made for each i, and so is an entry of a list; in every text of it arithmetic of the indices in
braces is replaced by its value: `{i-1}`, `{2*i}`. Where one reference is expected a list means the first that is
declared. `[parts.NAME]` puts the things of another file in, under names that begin with `NAME_`.

Everything made is counted while it is made: a short text cannot ask for a million bodies.
"""

from __future__ import annotations

import re
import tomllib
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import field, replace
from decimal import Decimal as exact_decimal
from functools import partial
from itertools import product
from math import prod
from pathlib import Path as FilePath
from typing import Any

from eomgen.errors import ExpressionError, ModelError, Problem
from eomgen.frozen import dataclass
from eomgen.model.diagnostics import TABLES, Decimal, Diagnostic, nearest, shown
from eomgen.model.fields import Alternatives, Leaf, Table
from eomgen.model.inserted_parts import (
    COUNTED,
    KEYS,
    PARTS,
    Drafting,
    Expanded,
    ModelFile,
    Refused,
    WrittenAt,
    counts_set,
    is_one,
    part_file,
    put_in,
    refused_at,
    table_of,
)
from eomgen.model.making import diagnostics_of, draft_of, resolved
from eomgen.model.positions import DocumentPath
from eomgen.symbolic.expression import parse

MOST = 2_000  # things by one name
MOST_ENTRIES = 100_000  # of all tables together
DEEPEST = 8  # files within files
REPEAT = "repeat"

_BRACES = re.compile(r"\{([^{}]*)\}")
_ARITHMETIC = re.compile(r"[\w\s+*/()-]+")
_NAME = re.compile(r"[^\W\d]\w*")
_INDEX = re.compile(r"[^\W\d]\w*$")


@dataclass(frozen=True)
class Repetition:
    """The text from which a model with repeated things was read, so that it can be read with other counts.

    Args:
        text, name, title: of the file, as of `loads`.
        counts: the integer parameters by which something is counted.
        parts: the files of parts, by their names in messages, and their content.
    """

    text: str
    name: str
    title: str
    counts: tuple[str, ...] = ()
    parts: tuple[tuple[str, str], ...] = ()


def tables_of(text: str) -> dict[str, Any]:
    """The tables of a TOML text, decimals as they are written.

    Raises:
        ValueError, RecursionError: it is none.
    """
    return tomllib.loads(text, parse_float=lambda word: Decimal(word.replace("_", "").lstrip("+")))


def counted_anew(model: Any, counts: Mapping[str, int]) -> Any:
    """The model with other counts; what was changed of it since it was read is changed of the new one, too.

    Raises:
        ModelError: with these counts it is wrong.
    """
    before, after = _made_again(model, {}), _made_again(model, counts)
    changes = {}
    for slot in type(model).slots():
        own, old, new = (getattr(each, slot.name) for each in (model, before, after))
        if own == old:
            continue
        if isinstance(own, Table) and isinstance(new, Table):
            changed = {key: x for key, x in own.items() if old.get(key) != x and (key in new or key not in old)}
            own = Table({**new, **changed})
        changes[slot.name] = own
    return after.altered(**changes)


def tables_read(model: Any) -> dict[str, Any]:
    """The tables of a model with repeated things as they are read, with the counts that it has."""
    values = {name: model.parameters[name].value for name in model.counts}
    made = _tables_again(model, {name: int(x.literal) for name, x in values.items()})
    return as_read(made, _draft(type(model), made, []))


def _tables_again(model: Any, counts: Mapping[str, int]) -> dict[str, Any]:
    repetition: Repetition = model.repeat
    texts = dict(repetition.parts)

    def read(path: str, beside: str) -> ModelFile:
        name = beside_file(path, beside)
        return ModelFile(name, texts[name], tables_of(texts[name]))

    source = ModelFile(repetition.name, repetition.text, tables_of(repetition.text))
    try:
        return repetition_of(source, partial(_draft, type(model)), read, counts).tables
    except Refused as error:
        raise ModelError(error.found.what, repetition.name, error.found.fix) from error


def _made_again(model: Any, counts: Mapping[str, int]) -> Any:
    """The model as it is read with some counts."""
    found: list[Diagnostic] = []
    tables = {**_tables_again(model, counts), REPEAT: model.repeat}
    draft = draft_of(type(model), tables, model.repeat.title, found)
    found += diagnostics_of(draft, found)
    if found:
        raise ModelError(tuple(Problem(".".join(map(str, x.path)), x.what, fix=x.fix) for x in found))
    return resolved(draft)


def _draft(cls: Any, tables: Mapping[str, Any], found: list[Diagnostic]) -> Any:
    return draft_of(cls, tables, "part", found)


def beside_file(path: str, beside: str) -> str:
    """A path that is written in a file, from the folder of that file."""
    return str(FilePath(beside).parent / path)


class RepetitionRule:
    """The repetition of a model; a file alone can say it."""

    def read(self, raw: Any, path: DocumentPath, found: list[Diagnostic]) -> Repetition | None:
        if isinstance(raw, Repetition):
            return raw
        found.append(Diagnostic(path, f"[{path[0]}] is read in a text", "in Python make the parts in a loop"))
        return None

    def leaves(self, value: Any, path: DocumentPath, part: Any) -> Iterator[Leaf]:
        yield from ()

    def schema(self, definitions: dict[str, Any]) -> dict[str, Any]:
        count = {"anyOf": [{"type": "integer"}, {"type": "string", "minLength": 1}]}
        ends = {"type": "array", "items": count, "minItems": 2, "maxItems": 2}
        return {"type": "object", "additionalProperties": {"anyOf": [*count["anyOf"], ends]}}


class PartsRule(RepetitionRule):
    """Parts from other files; a file alone can name them."""

    def schema(self, definitions: dict[str, Any]) -> dict[str, Any]:
        properties: dict[str, Any] = {key: {} for key in KEYS} | {"file": {"type": "string"}, "set": {"type": "object"}}
        part = {"type": "object", "properties": properties, "required": ["file"], "additionalProperties": False}
        return {"type": "object", "additionalProperties": part}


def is_repeated(raw: Mapping[str, Any]) -> bool:
    """True if a file has things that stand for several."""
    return REPEAT in raw or PARTS in raw


def repetition_of(
    source: ModelFile,
    draft: Drafting,
    read: Callable[[str, str], ModelFile],
    counted: Mapping[str, Any],
    depth: int = 0,
) -> Expanded:
    """The tables that those of a file stand for.

    Args:
        draft: reads tables as a model, unchecked.
        read: the file at a path that is written in the file with this name.
        counted: other values of integer parameters.
    Raises:
        Refused: something cannot be expanded.
    """
    try:
        return _expanded(source, draft, read, counted, depth)
    except Refused as error:
        error.source = error.source or source
        raise


def _expanded(
    source: ModelFile,
    draft: Drafting,
    read: Callable[[str, str], ModelFile],
    counted: Mapping[str, Any],
    depth: int,
) -> Expanded:
    raw = _with_counts(source.raw, counted)
    indices, counts = _indices(raw)
    walk = _Walk(indices, _integers(raw, {*counts, *indices}))
    tables = {key: value for key, value in raw.items() if key not in (REPEAT, PARTS)}
    made = Expanded(walk.table(tables, {}, (), ()), walk.places, [source], counts)
    parts = walk.table({PARTS: raw.get(PARTS, {})}, {}, (), ())[PARTS]
    if not isinstance(parts, Mapping):
        raise Refused(Diagnostic((PARTS,), f"a table of parts is needed here, not {shown(parts)}", "[parts.leg]"))
    for name, spec in parts.items():
        file = part_file(made, name, spec)
        if depth >= DEEPEST:
            told = Diagnostic(
                (PARTS, name, "file"), f"parts within parts, more than {DEEPEST} deep", "does it hold itself?"
            )
            raise refused_at(made, told)
        try:
            other = read(file, source.name)
        except OSError as error:
            what = f"'{file}' cannot be read: {error.strerror or error}"
            raise refused_at(
                made, Diagnostic((PARTS, name, "file"), what, "a path from the folder of this file")
            ) from error
        part = repetition_of(other, draft, read, counts_set(made, name, spec, other), depth + 1)
        put_in(made, name, spec, part, draft)
    return replace(made, tables=_settled(made.tables, _declared(made.tables)))


# -------- indices ---------------------------------------------------------------------------------------------


def _with_counts(raw: Mapping[str, Any], counted: Mapping[str, Any]) -> dict[str, Any]:
    """The tables with other values of some parameters."""
    table = raw.get(COUNTED)
    if not counted or not isinstance(table, Mapping):
        return dict(raw)
    new = dict(table)
    for name, value in counted.items():
        new[name] = {**new[name], "value": value} if isinstance(new.get(name), Mapping) else value
    return {**raw, COUNTED: new}


def _indices(raw: Mapping[str, Any]) -> tuple[dict[str, range], tuple[str, ...]]:
    """(the values of each index, the parameters by which something is counted)."""
    table: Any = raw.get(REPEAT, {})
    found, counts = dict[str, range](), list[str]()
    if not isinstance(table, Mapping):
        what = f"a table of indices is needed here, not {shown(table)}"
        raise Refused(Diagnostic((REPEAT,), what, "[repeat] and below it i = 20"))
    taken = {str(name) for key in TABLES for name in table_of(raw, key)}
    for name, given in table.items():
        path: DocumentPath = (REPEAT, name)
        if _INDEX.match(name) is None or name in taken:
            what = f"'{name}' is no index: a thing of the model has that name" if name in taken else f"'{name}' no name"
            raise Refused(Diagnostic(path, what, "choose another letter", key=True))
        ends = given if isinstance(given, list) else [1, given]
        if len(ends) != 2:
            raise Refused(Diagnostic(path, f"two ends are needed here, not {len(ends)}", f"{name} = [0, 5]"))
        low, high = (_end(raw, x, path, counts) for x in ends)
        if high - low >= MOST:
            raise Refused(Diagnostic(path, f"{high - low + 1} of one kind are more than {MOST}", "make fewer"))
        found[name] = range(low, high + 1)
    return found, tuple(dict.fromkeys(counts))


def _end(raw: Mapping[str, Any], given: Any, path: DocumentPath, counts: list[str]) -> int:
    """An end of an index: a whole number, or arithmetic of integer parameters."""
    if isinstance(given, int) and not isinstance(given, bool):
        return given
    if not isinstance(given, str) or isinstance(given, Decimal):
        fix = 'i = 20, i = [0, 5], or i = "n" with an integer parameter n'
        raise Refused(Diagnostic(path, f"a count is needed here, not {shown(given)}", fix))
    names = _NAME.findall(given)
    integers = _integers(raw, names)
    for name in names:
        if name not in integers:
            declared = name in table_of(raw, COUNTED)
            what = f"parameter '{name}' is no whole number" if declared else f"unknown parameter '{name}'"
            fix = f"give it one: {name} = 5" if declared else nearest(name, table_of(raw, COUNTED))
            raise Refused(Diagnostic(path, what, fix or f"declare it: {name} = 5 in [parameters]"))
        drawn = table_of(raw, COUNTED)[name]
        if isinstance(drawn, Mapping) and "range" in drawn:
            what = f"'{name}' counts things of the model: it is not drawn at random"
            raise Refused(Diagnostic((COUNTED, name, "range"), what, "leave its range out", key=True))
    counts += names
    return _whole(given, integers, path)


def _integers(raw: Mapping[str, Any], names: Any) -> dict[str, int]:
    """Parameters, of some, that are whole numbers."""
    found = {}
    for name in names:
        entry = table_of(raw, COUNTED).get(name)
        value = entry.get("value") if isinstance(entry, Mapping) else entry
        if isinstance(value, int) and not isinstance(value, bool):
            found[name] = value
    return found


def _whole(text: str, values: Mapping[str, int], path: DocumentPath) -> int:
    """The value of arithmetic of indices."""
    try:
        value = parse(text).evaluate(values)
    except (ExpressionError, KeyError, ZeroDivisionError) as error:
        what = error.what if isinstance(error, ExpressionError) else f"'{text}' has no value"
        raise Refused(Diagnostic(path, f"in {{{text}}}: {what}", "write arithmetic of the indices: {2*i-1}")) from error
    if value != int(value):
        raise Refused(Diagnostic(path, f"{{{text}}} is {value}, no whole number", "choose the indices otherwise"))
    return int(value)


# -------- one walk --------------------------------------------------------------------------------------------


_At = Mapping[str, int]
"""the values of the indices at some place"""


@dataclass
class _Walk:
    """The tables made, entry by entry.

    Args:
        indices: the values of each.
        integers: the parameters that count.
        places: of each entry that was made.
    """

    indices: Mapping[str, range]
    integers: Mapping[str, int]
    places: dict[DocumentPath, WrittenAt] = field(default_factory=dict)

    def table(self, raw: Mapping[str, Any], at: _At, new: DocumentPath, old: DocumentPath) -> dict[str, Any]:
        found: dict[str, Any] = {}
        for key, value in raw.items():
            for each in self.values(self.free((key,), at), at, (*old, key)):
                name = self.filled(str(key), each, (*old, key))
                if name in found:
                    what = f"'{name}' is made twice"
                    raise Refused(Diagnostic((*old, key), what, "let its name hold every index", key=True))
                found[name] = self.value(value, each, (*new, name), (*old, key))
        return found

    def values(self, free: Sequence[str], at: _At, path: DocumentPath) -> Iterator[dict[str, int]]:
        """The values of the indices, those that are free one after the other."""
        count = prod(len(self.indices[name]) for name in free)
        if count > MOST:
            raise Refused(Diagnostic(path, f"{count} of one kind are more than {MOST}", "make fewer", key=True))
        for each in product(*(self.indices[name] for name in free)):
            yield {**at, **dict(zip(free, each, strict=True))}

    def value(self, raw: Any, at: _At, new: DocumentPath, old: DocumentPath) -> Any:
        self.places[new] = WrittenAt(0, old, ", ".join(f"{name} = {k}" for name, k in at.items()))
        if len(self.places) > MOST_ENTRIES:
            raise Refused(Diagnostic(old, f"more than {MOST_ENTRIES} entries are made", "make fewer", key=True))
        if isinstance(raw, Mapping):
            return self.table(raw, at, new, old)
        if isinstance(raw, list):
            return self.listed(raw, at, new, old)
        if not isinstance(raw, str) or isinstance(raw, Decimal):
            return raw
        if free := self.free(raw, at):
            what = f"'{{{free[0]}}}' stands in a thing whose name does not hold it"
            raise Refused(Diagnostic(old, what, f"let the name hold {{{free[0]}}}, or make it an entry of a list"))
        return self.filled(raw, at, old)

    def listed(self, raw: list[Any], at: _At, new: DocumentPath, old: DocumentPath) -> list[Any]:
        found: list[Any] = []
        for k, item in enumerate(raw):
            for each in self.values(self.free(item, at), at, (*old, k)):
                found.append(self.value(item, each, (*new, len(found)), (*old, k)))
        texts = all(isinstance(item, str) and not isinstance(item, Decimal) for item in raw)
        offered = texts and len(found) == len(raw) > 1 and all(self.indexed(item) for item in raw[:-1])
        return Alternatives(found) if offered else found

    def free(self, raw: Any, at: _At) -> list[str]:
        """The indices in some text that have no value yet; of a table those in its values that no key of it binds."""
        if isinstance(raw, str):
            names = (name for text in self.indexed(raw) for name in _NAME.findall(text))
            return [name for name in dict.fromkeys(names) if name in self.indices and name not in at]
        if isinstance(raw, Mapping):
            each = (
                x
                for key, value in raw.items()
                for x in self.free(value, {**at, **dict.fromkeys(self.free(key, at), 0)})
            )
            return list(dict.fromkeys(each))
        if isinstance(raw, (list, tuple)):
            return list(dict.fromkeys(x for item in raw for x in self.free(item, at)))
        return []

    def indexed(self, text: str) -> list[str]:
        """The arithmetic in braces in a text: {m} of a parameter is none, it stands for its value in words."""
        found = []
        for inner in _BRACES.findall(text):
            names = _NAME.findall(inner)
            known = names and all(name in self.indices or name in self.integers for name in names)
            if known and _ARITHMETIC.fullmatch(inner):
                found.append(inner)
        return found

    def filled(self, text: str, at: _At, path: DocumentPath) -> str:
        """A text with the values of its indices."""
        known = set(self.indexed(text))
        if not known:
            return text

        def value(found: re.Match[str]) -> str:
            if found[1] not in known:
                return found[0]
            k = _whole(found[1], {**self.integers, **at}, path)
            before, after = text[: found.start()][-1:], text[found.end() :][:1]
            if path and path[-1] == "symbol" and before in ("_", "^"):
                return f"{{{k}}}"
            in_name = before.isalnum() or before == "_" or after.isalnum() or after in ("_", ".", "'")
            if k < 0:  # x{i-2} is then a name that nothing has, and not a difference
                return f"minus{-k}" if in_name else f"({k})"
            return str(k)

        return _BRACES.sub(value, text)


# -------- first of several ------------------------------------------------------------------------------------


def _declared(tables: Mapping[str, Any]) -> dict[str, set[str]]:
    """The names that are declared: those of points and of what has points, and all others."""
    found = {key: {str(name) for name in table_of(tables, key)} for key in TABLES}
    return {"points": found["points"] | found["bodies"] | found["trusses"], "others": {"ground"}.union(*found.values())}


def _settled(value: Any, names: Mapping[str, set[str]]) -> Any:
    """The tables in which each list of references knows which is the first that is declared."""
    if isinstance(value, Alternatives):
        known = set().union(*names.values())
        chosen = next((x for x in value if x.partition(".")[0].rstrip("'") in known), value[-1])
        return Alternatives(value, chosen, is_place=chosen.partition(".")[0] in names["points"])
    if isinstance(value, Mapping):
        return {key: _settled(x, names) for key, x in value.items()}
    return [_settled(x, names) for x in value] if isinstance(value, list) else value


def as_read(tables: Mapping[str, Any], draft: Any) -> dict[str, Any]:
    """The tables as they are read, for a person: of references that are offered the one that is taken."""
    leaves = {leaf.path: leaf for leaf in draft.leaves(())}

    def plain(value: Any, path: DocumentPath) -> Any:
        if isinstance(value, Alternatives) and is_one(path, leaves.get(path)):
            return value.chosen
        if isinstance(value, Decimal):
            return exact_decimal(value) if exact_decimal(value).is_finite() else str(value)
        if isinstance(value, Mapping):
            return {key: plain(x, (*path, key)) for key, x in value.items()}
        return [plain(x, (*path, k)) for k, x in enumerate(value)] if isinstance(value, list) else value

    return {key: found for key, x in tables.items() if (found := plain(x, (key,))) not in ({}, None)}
