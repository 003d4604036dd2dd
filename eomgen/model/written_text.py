"""Text of a model file -> what stands where in it, also while it is being typed and is no model yet.

Rules say what may stand at a path; keys declare names; expressions and fields use them. What cannot be read is passed
over.
"""

import re
from collections.abc import Iterator
from functools import cached_property
from typing import Any

from eomgen.errors import ModelError, UsageError
from eomgen.frozen import dataclass
from eomgen.model.fields import (
    CONFIGURATION,
    FLOWING,
    MOTION,
    PARAMETERS,
    RATES,
    SPEEDS,
    STATE,
    TIME,
    AxialRule,
    EitherRule,
    FlagRule,
    FormulaRule,
    ListRule,
    NameRule,
    ParsedTextRule,
    TableRule,
    TextRule,
    VectorRule,
    WholeRule,
)
from eomgen.model.model import Model
from eomgen.model.outputs import FUNCTIONS
from eomgen.model.part import PartRule, SeamRule, Slot
from eomgen.model.positions import DocumentPath, Index, Span, index_of
from eomgen.model.quantities import UNITS, Unit
from eomgen.model.reader import loads
from eomgen.symbolic.expression import NAMES

SYMBOLS = ("parameters", "coordinates", "speeds", "states", "inputs", "unknowns")
OBJECTS = ("bodies", "points", "constraints", "trusses", "forces")
NAMED = (*SYMBOLS, *OBJECTS, "outputs")
_CONSTANT = ("parameters", "unknowns")
SCOPES = {
    PARAMETERS: _CONSTANT,
    TIME: _CONSTANT,
    FLOWING: (*_CONSTANT, "states"),
    CONFIGURATION: (*_CONSTANT, "coordinates"),
    RATES: (*_CONSTANT, "coordinates"),
    SPEEDS: (*_CONSTANT, "coordinates", "speeds"),
    MOTION: SYMBOLS,
    STATE: SYMBOLS,
}
"""Tables whose names may stand in an expression of a scope."""
_TOKEN = re.compile(r"[^\W\d]\w*(?:\.[^\W\d]\w*)*|[()]")
_WORD = re.compile(r"[^\W\d][\w.]*'*$|$")
_BARE = re.compile(r"[A-Za-z0-9_-]+")
_NAME = re.compile(r"[^\W\d]\w*")
_IS_MODEL = re.compile(r"^\s*eomgen\s*=", re.M)


@dataclass(frozen=True)
class Cursor:
    """Place at which something is being written.

    Args:
        path: of the table whose key, or of the value that is written; of a header what stands before the last dot.
        mode: "header", "key", "text" (inside quotes), "value", or "" in a remark.
        word: what stands before the place of it.
    """

    path: DocumentPath
    mode: str
    word: str = ""


@dataclass(frozen=True)
class Mention:
    """A name in the text.

    Args:
        declared: the path of its declaration.
    """

    span: Span
    declared: DocumentPath


@dataclass(frozen=True)
class Fitting:
    """Words, names and functions that fit at a place inside quotes.

    Args:
        words: of a few that may stand there, units among them.
        names: as they are written there, each with the path of its declaration; () of points that a shape has.
        functions: that an expression may call.
    """

    words: tuple[str, ...] = ()
    names: tuple[tuple[str, DocumentPath], ...] = ()
    functions: tuple[str, ...] = ()


@dataclass(frozen=True)
class WrittenText:
    """A text, and where what stands in it."""

    text: str

    @property
    def is_model(self) -> bool:
        """True if it says that it is a model file."""
        return _IS_MODEL.search(self.text) is not None

    @property
    def index(self) -> Index:
        """Places of keys and values; lines that are no TOML are passed over."""
        return self._read[0]

    @cached_property
    def _typed(self) -> dict[DocumentPath, str]:
        """Texts in the lines that were passed over."""
        found: dict[DocumentPath, str] = {}
        for span in self._read[1]:
            _typed_in_line(self.text[span.start : span.end], self._table_above(span.start), found)
        return found

    @cached_property
    def _read(self) -> tuple[Index, tuple[Span, ...]]:
        """Places of keys and values, and the lines that are no TOML."""
        text, broken = self.text, list[Span]()
        while (found := index_of(text)).end < len(text):
            start = text.rfind("\n", 0, found.end) + 1
            end = text.find("\n", found.end)
            end = len(text) if end < 0 else end
            if not text[start:end].strip():
                break
            broken.append(Span(start, end))
            text = text[:start] + " " * (end - start) + text[end:]
        return found, tuple(broken)

    def value(self, path: DocumentPath) -> str:
        """Source of a value; "" where there is none."""
        span = self.index.values.get(path)
        return "" if span is None else self.text[span.start : span.end]

    def plain(self, path: DocumentPath) -> str:
        """A value without quotes."""
        return self.value(path).strip("\"'") or self._typed.get(path, "")

    # -- rules -------------------------------------------------------------------------------------

    def rule_at(self, path: DocumentPath) -> Any:
        """The rule of the value at a path; None where nothing may stand."""
        rule: Any = PartRule(Model)
        for k, step in enumerate(path):
            rule = self._inside(rule, step, path[:k])
        return rule

    def slots_at(self, path: DocumentPath) -> dict[str, tuple[type[Any], Slot]]:
        """{key: (the class that has it, its field)} of what may stand in the table at a path."""
        return {slot.key: (cls, slot) for cls in self.classes_at(path) for slot in cls.slots() if not slot.inline}

    def classes_at(self, path: DocumentPath) -> tuple[type[Any], ...]:
        """The classes whose fields the table at a path has; of a kind that is not known yet all."""
        return tuple(self._classes(self.rule_at(path), path))

    def holds_a_table(self, path: DocumentPath) -> bool:
        """True if a table may stand at a path."""
        rules = self._alternatives(self.rule_at(path))
        return any(isinstance(rule, (TableRule, PartRule, SeamRule)) for rule in rules)

    def seam_at(self, path: DocumentPath) -> SeamRule | None:
        """The seam of the table at a path: its `kind` names one of several classes."""
        rules = self._alternatives(self.rule_at(path))
        inline = (slot.rule for rule in rules if isinstance(rule, PartRule) for slot in rule.cls.slots() if slot.inline)
        return next((rule for rule in (*rules, *inline) if isinstance(rule, SeamRule)), None)

    def _classes(self, rule: Any, path: DocumentPath) -> Iterator[type[Any]]:
        for each in self._alternatives(rule):
            if isinstance(each, SeamRule):
                kind = self.plain((*path, "kind"))
                known = [member for member in each.members if member.kind == kind]
                yield from known or each.members
            elif isinstance(each, PartRule):
                yield each.cls
                for slot in each.cls.slots():
                    if slot.inline:
                        yield from self._classes(slot.rule, path)

    def _alternatives(self, rule: Any) -> list[Any]:
        """The rule, and those of which it is one."""
        if isinstance(rule, EitherRule):
            return [*self._alternatives(rule.text), *self._alternatives(rule.other)]
        if isinstance(rule, ListRule) and rule.single:
            return [rule, *self._alternatives(rule.item)]
        return [] if rule is None else [rule]

    def _inside(self, rule: Any, step: str | int, path: DocumentPath) -> Any:
        """The rule of what stands under a key or at an index of what a rule is for."""
        for each in self._alternatives(rule):
            if isinstance(each, TableRule):
                return each.item
            if isinstance(each, (ListRule, VectorRule, AxialRule)) and isinstance(step, int):
                return each.item
            for cls in self._classes(each, path):
                for slot in cls.slots():
                    if slot.key == step and not slot.inline:
                        return slot.rule
        return None

    def rules_of_text(self, path: DocumentPath) -> list[Any]:
        """The rules by which a text at a path may be read: of a part the field that it stands for."""
        found = []
        for rule in self._alternatives(self.rule_at(path)):
            if isinstance(rule, PartRule) and rule.cls.shorthand:
                slot = next(slot for slot in rule.cls.slots() if slot.name == rule.cls.shorthand)
                found += self._alternatives(slot.rule)
            elif isinstance(rule, (WholeRule, VectorRule, AxialRule)):
                found.append(rule.item if isinstance(rule, AxialRule) else rule)
        return found

    # -- names -------------------------------------------------------------------------------------

    @cached_property
    def declarations(self) -> dict[DocumentPath, Span]:
        """Path and place of every name that is declared: of tables, and points of bodies."""
        found: dict[DocumentPath, Span] = {}
        for path, span in self.index.pieces:
            own = len(path) == 2 and path[0] in NAMED
            own_point = len(path) == 4 and path[0] == "bodies" and path[2] == "points"
            if own or own_point:
                found.setdefault(path, span)
        return found

    @cached_property
    def mentions(self) -> tuple[Mention, ...]:
        """Every place of every declared name, that of its declaration too."""
        keys = [Mention(span, path) for path, span in self.index.pieces if path in self.declarations]
        return (*keys, *(found for path in self.index.values for found in self._used(path)))

    def mention_at(self, offset: int) -> Mention | None:
        """The name at a place."""
        return next((each for each in self.mentions if each.span.start <= offset <= each.span.end), None)

    def _used(self, path: DocumentPath) -> Iterator[Mention]:
        """Names in the text that is the value at a path."""
        source, span = self.value(path), self.index.values[path]
        if not source or source[0] not in "\"'":
            return
        for rule in self.rules_of_text(path):
            if isinstance(rule, NameRule) or (isinstance(rule, VectorRule) and (rule.point or rule.own_point)):
                of = rule.of if isinstance(rule, NameRule) else "own point" if rule.own_point else "point"
                first = len(source) - len(source.lstrip("\"'"))
                yield from self._objects(source.strip("\"'"), span.start + first, path, of)
                return
            if not isinstance(rule, TextRule) and isinstance(rule, WholeRule) and hasattr(rule, "scope"):
                yield from self._in_expression(source, span.start, path)
                return

    def _objects(self, word: str, start: int, path: DocumentPath, of: str = "") -> Iterator[Mention]:
        """A body, a point, "arm.end": each declared piece of it."""
        owner, dot, name = word.partition(".")
        if of == "own point" and not dot:
            tables: tuple[DocumentPath, ...] = ((*self._owner(path), "points"),)
        else:
            tables = tuple(
                (table,) for table in (OBJECTS if of not in ("coordinate", "speed", "free speed") else SYMBOLS)
            )
        for table in tables:
            if (declared := (*table, owner)) in self.declarations:
                yield Mention(Span(start, start + len(owner)), declared)
                break
        if dot and (point := ("bodies", owner, "points", name)) in self.declarations:
            first = start + len(owner) + 1
            yield Mention(Span(first, first + len(name)), point)

    def _owner(self, path: DocumentPath) -> DocumentPath:
        """The body whose points a field names: the one that it is in, or that its force is on."""
        return path[:2] if path[0] == "bodies" else ("bodies", self.plain((*path[:2], "body")))

    def _in_expression(self, source: str, start: int, path: DocumentPath) -> Iterator[Mention]:
        """Names of an expression: symbols; among the arguments of functions of the motion first what they are of."""
        calls, before, of_truss = list[str](), "", False
        for found in _TOKEN.finditer(source):
            token = found[0]
            if token == "(":
                calls.append(before)
            elif token == ")":
                del calls[-1:]
                of_truss = False
            elif not of_truss and not source[found.end() :].lstrip().startswith("("):
                of_motion = any(call in FUNCTIONS for call in calls)
                own = list(self._objects(token, start + found.start(), path)) if of_motion else []
                yield from own or self._symbol(token, start + found.start())
                of_truss = of_motion and ("trusses", token) in self.declarations  # nodes follow
            before = token

    def _symbol(self, token: str, start: int) -> Iterator[Mention]:
        for table in SYMBOLS:
            if (table, token) in self.declarations:
                yield Mention(Span(start, start + len(token)), (table, token))
                return

    def fitting(self, path: DocumentPath) -> Fitting:
        """Everything that fits as the text at a path."""
        words, names, functions = list[str](), list[tuple[str, DocumentPath]](), list[str]()
        for rule in self.rules_of_text(path):
            if isinstance(rule, TextRule):
                words += rule.options
            elif isinstance(rule, ParsedTextRule) and rule.of is Unit:
                words += UNITS
            elif isinstance(rule, FlagRule):
                words += ("true", "false")
            elif isinstance(rule, NameRule):
                names += self._of_kind(rule.of, path)
            elif isinstance(rule, VectorRule):
                names += self._of_kind("own point" if rule.own_point else "point", path) if rule.length != 1 else []
            elif hasattr(rule, "scope"):
                of_motion = not isinstance(rule, FormulaRule)
                names += self._symbols(rule.scope)
                functions += (*NAMES, *(FUNCTIONS if of_motion else getattr(rule, "functions", ())))
                names += [*self._of_kind("body", path), *self._of_kind("point", path)] if of_motion else []
        return Fitting(tuple(words), tuple(dict.fromkeys(names)), tuple(functions))

    def _symbols(self, scope: str) -> Iterator[tuple[str, DocumentPath]]:
        """The symbols that an expression of a scope may hold, with their rates."""
        tables = SCOPES.get(scope, SYMBOLS)
        primes = {RATES: 1, SPEEDS: 1, MOTION: 1, STATE: 2}.get(scope, 0 if scope in SCOPES else 2)
        dots = {"coordinates": primes, "states": int(tables is SYMBOLS)}
        for declared in self.declarations:
            if declared[0] in tables and len(declared) == 2:
                for k in range(dots.get(str(declared[0]), 0) + 1):
                    yield str(declared[1]) + "'" * k, declared

    def _of_kind(self, of: str, path: DocumentPath) -> list[tuple[str, DocumentPath]]:
        """The names to which a field may refer."""
        declared = list(self.declarations)

        def table(*names: str) -> list[tuple[str, DocumentPath]]:
            return [(str(each[1]), each) for each in declared if len(each) == 2 and each[0] in names]

        if of in ("coordinate", "speed", "free speed"):
            return table("coordinates", "speeds")
        bodies = [each for each in declared if len(each) == 2 and each[0] == "bodies"]
        if of == "own point":
            return list(self._points(self._owner(path)))
        if of in ("point", "seat"):
            own = [(f"{body[1]}.{point}", at) for body in bodies for point, at in self._points(body)]
            return [*table("points"), *own, *(table("bodies") if of == "seat" else [])]
        return [*table("bodies"), *([("ground", ())] if of == "axes" else [])]

    def _points(self, body: DocumentPath) -> Iterator[tuple[str, DocumentPath]]:
        """Points of a body: those that its shape has, and its own."""
        rod = self.plain((*body, "shape", "kind")) == "rod"
        for name in ("origin", "center", *(("start", "end") if rod else ())):
            yield name, ()
        for each in self.declarations:
            if each[:-1] == (*body, "points"):
                yield str(each[-1]), each

    # -- renaming ----------------------------------------------------------------------------------

    def renamed(self, mention: Mention, name: str) -> list[Span]:
        """The places at which a name is replaced by another one.

        Raises:
            UsageError: it is no name, it is taken, or the text would mean something else.
        """
        if not _NAME.fullmatch(name):
            raise UsageError(f"'{name}' is no name", fix="letters, digits and _, a letter first")
        if (*mention.declared[:-1], name) in self.declarations:
            raise UsageError(f"'{name}' is there already", fix="take another name")
        spans = sorted(
            {each.span for each in self.mentions if each.declared == mention.declared}, key=lambda s: s.start
        )
        other = WrittenText(_replaced(self.text, spans, name))
        back = (*mention.declared[:-1], name)
        again = {each.span for each in other.mentions if each.declared == back}
        if len(again) != len(spans):
            raise UsageError(f"'{name}' means something here already", fix="take another name")
        refused = _refused(self.text)
        if not refused and (why := _refused(other.text)):
            raise UsageError(f"with '{name}' it would be no model: {why}", fix="take another name")
        return spans

    # -- typing ------------------------------------------------------------------------------------

    def cursor(self, offset: int) -> Cursor:
        """The path and the word that are being written at a place."""
        start = self.text.rfind("\n", 0, offset) + 1
        line = self.text[start:offset]
        if line.lstrip().startswith("[") and "=" not in line:
            typed = line.lstrip().lstrip("[")
            if "]" in typed:
                return Cursor((), "")
            *above, word = (piece.strip() for piece in typed.split("."))
            return Cursor(tuple(above), "header", word)
        return _typed_in_line(line, self._table_above(start))

    def _table_above(self, offset: int) -> DocumentPath:
        """The table whose header is the last one before a place."""
        headers = [
            (span.start, path)
            for path, span in self.index.values.items()
            if span.start < offset and _is_header(self.text, span)
        ]
        return max(headers, key=lambda each: (each[0], len(each[1])), default=(0, ()))[1]


def _is_header(text: str, span: Span) -> bool:
    """True of [bodies.arm] at the beginning of a line, and not of a list."""
    before = text[text.rfind("\n", 0, span.start) + 1 : span.start]
    return text.startswith("[", span.start) and not before.strip() and "," not in text[span.start : span.end]


def _replaced(text: str, spans: list[Span], name: str) -> str:
    for span in reversed(spans):
        text = text[: span.start] + name + text[span.end :]
    return text


def _refused(text: str) -> str:
    """Message that says why a text is no model; "" if it is one."""
    try:
        loads(text)
    except ModelError as error:
        return error.what
    return ""


def _typed_in_line(line: str, table: DocumentPath, texts: dict[DocumentPath, str] | None = None) -> Cursor:
    """The path and the word that are being written at the end of a line, in a table.

    Args:
        texts: takes the texts that stand in the line.
    """
    stack: list[tuple[DocumentPath, int]] = [(table, -1)]  # tables and lists that are open; of a list the next index
    key: list[str] = []
    at, is_key = 0, True
    while at < len(line):
        sign = line[at]
        if sign == "#":
            return Cursor((), "")
        if sign in "\"'":
            end = line.find(sign, at + 1)
            if end < 0:
                inside = line[at + 1 :]
                path = _path_of(stack, key)
                return Cursor(path, "text", _word(inside)) if not is_key else Cursor(stack[-1][0], "key", inside)
            key += [line[at + 1 : end]] if is_key else []
            if texts is not None and not is_key:
                texts[_path_of(stack, key)] = line[at + 1 : end]
            at = end + 1
            continue
        if is_key and (word := _BARE.match(line, at)):
            if word.end() == len(line):
                return Cursor((*stack[-1][0], *key), "key", word[0])
            key.append(word[0])
            at = word.end()
            continue
        if sign == "=":
            is_key = False
        elif sign == "{":
            stack.append((_path_of(stack, key), -1))
            key, is_key = [], True
        elif sign == "[":
            stack.append((_path_of(stack, key), 0))
            key = []
        elif sign in "}]" and len(stack) > 1:
            stack.pop()
            is_key = False
        elif sign == ",":
            path, count = stack[-1]
            stack[-1] = (path, count + 1 if count >= 0 else -1)
            key, is_key = [], count < 0
        at += 1
    if is_key:
        return Cursor((*stack[-1][0], *key), "key")
    return Cursor(_path_of(stack, key), "value", _word(line))


def _path_of(stack: list[tuple[DocumentPath, int]], key: list[str]) -> DocumentPath:
    """The path of the value that is written: under a key, or in a list."""
    path, count = stack[-1]
    return (*path, count) if count >= 0 else (*path, *key)


def _word(text: str) -> str:
    found = _WORD.search(text)
    return "" if found is None else found[0]
