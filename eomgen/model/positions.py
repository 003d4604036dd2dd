"""TOML text -> where every key and value stands in it (tomllib gives the values but not their places)."""

import re
from bisect import bisect_right
from contextlib import suppress
from dataclasses import field

from eomgen.frozen import dataclass

DocumentPath = tuple[str | int, ...]

DEEPEST = 16  # pieces of a dotted key
MOST_DOTS = 5000

_BLANK = re.compile(r"(?:[ \t\r\n]|#[^\n]*)*")
_SPACE = re.compile(r"[ \t]*")
_KEY = re.compile(r"""[A-Za-z0-9_-]+|"(?:[^"\\\n]|\\.)*"|'[^'\n]*'""")
_STRING = re.compile(
    r'"""(?:[^"\\]|\\[\s\S]|"(?!""))*"{3,5}'
    r"|'''(?:[^']|'(?!''))*'{3,5}"
    r'|"(?:[^"\\\n]|\\.)*"'
    r"|'[^'\n]*'"
)
_BARE = re.compile(r"[^,\]}#\n]+")
_ESCAPE = re.compile(r"\\(?:u[0-9A-Fa-f]{4}|U[0-9A-Fa-f]{8}|\s*\n\s*|[\s\S])")


@dataclass(frozen=True)
class Span:
    """A stretch of the text, from `start` up to `end`."""

    start: int
    end: int


@dataclass
class Index:
    """Places of the keys and values of a text.

    Args:
        text: the text.
        keys, values: the span of each key, and of each value (a table's header stands for its value), by path.
        twice: path, span, and whole statement (None: a header or a key within a line) of every key given before.
        deep: the first key with more pieces than DEEPEST, where the scan ended.
        pieces: path and span of every piece of every key and header, as often as it stands there.
        end: the place up to which the text was read.
    """

    text: str
    keys: dict[DocumentPath, Span] = field(default_factory=dict)
    values: dict[DocumentPath, Span] = field(default_factory=dict)
    twice: list[tuple[DocumentPath, Span, Span | None]] = field(default_factory=list)
    deep: Span | None = None
    pieces: list[tuple[DocumentPath, Span]] = field(default_factory=list)
    end: int = 0
    _lines: list[int] = field(default_factory=list)

    def line_and_column(self, offset: int) -> tuple[int, int]:
        """Line and column of an offset, both from 1."""
        if not self._lines:
            self._lines = [0, *(m.end() for m in re.finditer("\n", self.text))]
        line = bisect_right(self._lines, offset)
        return line, offset - self._lines[line - 1] + 1

    def line(self, number: int) -> str:
        """The text of a line, from 1."""
        self.line_and_column(0)
        start = self._lines[number - 1]
        end = self.text.find("\n", start)
        return self.text[start : end if end >= 0 else len(self.text)]

    def nearest(self, path: DocumentPath, key: bool = False) -> Span:
        """The span of the value at a path (or of its key), else of what it is in."""
        if key and path in self.keys:
            return self.keys[path]
        while path:
            if path in self.values:
                return self.values[path]
            path = path[:-1]
        first = _BLANK.match(self.text)
        start = first.end() if first is not None and first.end() < len(self.text) else 0
        return Span(start, start)

    def within(self, path: DocumentPath, column: int, length: int) -> Span:
        """The span of some characters of the string that is the value at a path."""
        whole = self.nearest(path)
        offsets = _offsets(self.text[whole.start : whole.end])
        if offsets is None:
            return whole
        last = len(offsets) - 1
        first, after = min(column, last), min(column + max(1, length), last)
        return Span(whole.start + offsets[first], whole.start + max(offsets[after], offsets[first] + 1))


def index_of(text: str) -> Index:
    """The places of all keys and values of a TOML text; of a text that is none, those up to where that shows."""
    scanner = _Scanner(text)
    with suppress(_Lost, RecursionError):
        scanner.document()
    scanner.index.end = scanner.at
    if scanner.at < len(text) and scanner.index.deep is None:
        scanner.index.deep = _dotted_line(text, scanner.at)
    return scanner.index


def _dotted_line(text: str, start: int) -> Span | None:
    """The first line from here on with more dots than any model has (tomllib's memory grows with their square)."""
    for line in text[start:].split("\n"):
        if line.count(".") > MOST_DOTS:
            return Span(start, start + 1)
        start += len(line) + 1
    return None


class _Lost(Exception):
    """The text is not TOML from here on."""


class _Scanner:
    """One pass over a text that tomllib has accepted, or refused for a key that is there twice."""

    def __init__(self, text: str) -> None:
        self.text, self.at, self.index = text, 0, Index(text)
        self.counts: dict[DocumentPath, int] = {}
        self.headers: set[DocumentPath] = set()

    def document(self) -> None:
        table: DocumentPath = ()
        self.match(_BLANK)
        while self.at < len(self.text):
            if self.text.startswith("[", self.at):
                table = self.header()
            else:
                self.pair(table, whole_line=True)
            self.match(_BLANK)

    def match(self, pattern: re.Pattern[str]) -> str:
        found = pattern.match(self.text, self.at)
        if found is None:
            raise _Lost
        self.at = found.end()
        return found.group()

    def take(self, sign: str) -> None:
        if not self.text.startswith(sign, self.at):
            raise _Lost
        self.at += len(sign)

    def header(self) -> DocumentPath:
        start, many = self.at, self.text.startswith("[[", self.at)
        self.take("[[" if many else "[")
        keys = self.dotted()
        self.take("]]" if many else "]")
        path: DocumentPath = ()
        for k, (name, piece) in enumerate(keys):
            path = (*path, name)
            self.index.pieces.append((path, piece))
            if many and k == len(keys) - 1:
                self.counts[path] = self.counts.get(path, -1) + 1
            if path in self.counts:
                path = (*path, self.counts[path])
        span = keys[-1][1]
        if path in self.headers:
            self.index.twice.append((path, span, None))
        self.headers.add(path)
        self.index.keys.setdefault(path, span)
        self.index.values.setdefault(path, Span(start, self.at))
        for k in range(1, len(keys)):
            self.index.values.setdefault(tuple(name for name, _ in keys[:k]), Span(start, self.at))
        return path

    def dotted(self) -> list[tuple[str, Span]]:
        """A key, dotted or not: its pieces and where they stand."""
        pieces = []
        while True:
            self.match(_SPACE)
            start = self.at
            word = self.match(_KEY)
            pieces.append((_decoded(word), Span(start, self.at)))
            self.match(_SPACE)
            if not self.text.startswith(".", self.at):
                return pieces
            if len(pieces) == DEEPEST:
                self.index.deep = pieces[0][1]
                raise _Lost
            self.at += 1

    def pair(self, table: DocumentPath, whole_line: bool = False) -> None:
        start, keys = self.at, self.dotted()
        self.take("=")
        self.match(_SPACE)
        path = table
        for name, span in keys[:-1]:
            path = (*path, name)
            self.index.pieces.append((path, span))
            self.index.keys.setdefault(path, span)
            self.index.values.setdefault(path, span)
        name, span = keys[-1]
        path = (*path, name)
        self.index.pieces.append((path, span))
        again = path in self.index.keys
        self.index.keys.setdefault(path, span)
        self.value(path)
        if again:
            self.index.twice.append((path, span, Span(start, self.at) if whole_line else None))

    def value(self, path: DocumentPath) -> None:
        start = self.at
        sign = self.text[self.at : self.at + 1]
        if sign == "{":
            self.inline_table(path)
        elif sign == "[":
            self.array(path)
        elif sign in ("'", '"'):
            self.match(_STRING)
        else:
            word = self.match(_BARE)
            self.at -= len(word) - len(word.rstrip())
        self.index.values.setdefault(path, Span(start, self.at))

    def inline_table(self, path: DocumentPath) -> None:
        self.take("{")
        self.match(_BLANK)
        while not self.text.startswith("}", self.at):
            self.pair(path)
            self.match(_BLANK)
            if self.text.startswith(",", self.at):
                self.at += 1
                self.match(_BLANK)
            elif not self.text.startswith("}", self.at):
                raise _Lost
        self.take("}")

    def array(self, path: DocumentPath) -> None:
        self.take("[")
        self.match(_BLANK)
        count = 0
        while not self.text.startswith("]", self.at):
            self.value((*path, count))
            count += 1
            self.match(_BLANK)
            if self.text.startswith(",", self.at):
                self.at += 1
                self.match(_BLANK)
            elif not self.text.startswith("]", self.at):
                raise _Lost
        self.take("]")


def _decoded(word: str) -> str:
    if word[0] == "'":
        return word[1:-1]
    if word[0] == '"':
        import tomllib

        try:
            return next(iter(tomllib.loads(f"{word}=0")))
        except tomllib.TOMLDecodeError as error:
            raise _Lost from error
    return word


def _offsets(source: str) -> list[int] | None:
    """Place of each character of a string's value in the string's source; one more for its end."""
    if not source or source[0] not in "'\"":
        return None
    quote = source[:3] if source[:3] in ('"""', "'''") else source[0]
    at, end = len(quote), len(source) - len(quote)
    if len(quote) == 3 and source[at : at + 1] == "\n":
        at += 1
    offsets = []
    while at < end:
        escape = _ESCAPE.match(source, at) if source[0] == '"' else None
        if escape is None:
            offsets.append(at)
            at += 1
        else:
            if "\n" not in escape.group():
                offsets.append(at)
            at = escape.end()
    return [*offsets, end]
