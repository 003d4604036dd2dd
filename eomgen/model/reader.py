"""Text of a model file -> Model, or every problem at once with its place in the text."""

from __future__ import annotations

import codecs
import os
import re
from collections.abc import Mapping
from contextlib import suppress
from dataclasses import replace
from pathlib import Path as FilePath
from typing import Any

from eomgen.errors import ModelError, Problem, UsageError
from eomgen.files import read, read_stdin
from eomgen.frozen import dataclass
from eomgen.model.diagnostics import TABLES, Diagnostic, shown
from eomgen.model.expansion import REPEAT, Repetition, beside_file, is_repeated, repetition_of, tables_of
from eomgen.model.inserted_parts import PARTS, Expanded, ModelFile, Refused
from eomgen.model.making import MOST_DIAGNOSTICS, diagnostics_of, draft_of, resolved
from eomgen.model.model import Model
from eomgen.model.positions import DocumentPath, Index, Span, index_of
from eomgen.model.replaced import Valued, Values
from eomgen.symbolic.expression import invisible

LARGEST = 1_000_000  # bytes
WIDEST = 100  # characters of a source line that an error shows
VERSION = 1
UTF_16 = (codecs.BOM_UTF16_LE, codecs.BOM_UTF16_BE)
ModelOrPath = Model | str | FilePath


def load(path: str | FilePath) -> Model:
    """The model that a file declares.

    Raises:
        ModelError: the file cannot be read, or the model is wrong; every problem at once.
    """
    return loads(bytes_at(path), str(path), FilePath(path).stem)


def bytes_at(path: str | FilePath) -> bytes:
    """The content of a file (- is stdin), up to the length that a model may have.

    Raises:
        ModelError: it cannot be read.
        UsageError: no path is given.
    """
    if not isinstance(path, (str, os.PathLike)):
        raise UsageError(f"{path!r} is neither a model nor a path to one", fix='give eomgen.load("crane.toml")')
    try:
        return read_stdin(LARGEST) if path == "-" else read(path, LARGEST)
    except OSError as error:
        if "\n" in str(path):
            raise ModelError("this is no path but the text of a model", "", "read it by eomgen.loads") from error
        name, fix = ("<stdin>", "check what writes it") if path == "-" else (str(path), "check the path")
        raise ModelError(f"cannot be read: {error.strerror or error}", name, fix) from error


def model_at(model: ModelOrPath, parameters: Values | None = None, start: Values | None = None) -> Model:
    """A model, or the one in the file at a path; with other values of parameters and starts.

    Args:
        parameters, start: numbers in SI, "45 deg", (45, "deg"), quantities of pint, or expressions in SI.
    Raises:
        ModelError: as `load`.
        UsageError: a name that there is not, a value that cannot be, a unit that does not fit.
    """
    return Valued.of(model if isinstance(model, Model) else load(model), parameters, start).model


def loads(text: str | bytes, name: str = "<text>", title: str = "model") -> Model:
    """The model that a text declares.

    Args:
        name: stands for the file in error messages.
        title: the name of a model that gives itself none.
    Raises:
        ModelError: the model is wrong; every problem at once.
    """
    try:
        data = text.encode() if isinstance(text, str) else text
    except UnicodeEncodeError as error:
        raise ModelError("the text is not UTF-8", name, "save it as UTF-8") from error
    return _loads(data, name, title)


def located(problem: Problem, data: bytes, name: str, *, by_name: bool = False) -> Problem:
    """A problem that names a part of the model by its path ("bodies.arm.joint"), at that part's place in the text.

    Args:
        by_name: one without a path is at the place of the first thing that it names: "'x' leaves all bounds".
    """
    path = tuple(problem.where.split("."))
    if path[0] not in TABLES and (problem.where or not by_name):
        return problem
    files = _Files.of(data, name)
    path = path if problem.where else _named(problem.what, files)
    if not path:
        return problem
    if not files.has(path[:2]):
        path = _brought_by(path, files)
    key = path if files.has(path) else path[:2]
    number, found = files.as_written(Diagnostic(path, problem.what, problem.fix))
    index, where = files.indices[number], files.as_written(Diagnostic(key, ""))[1].path
    return _problem(found, index.nearest(where, key=True), index, files.names[number])


_QUOTED = re.compile(r"'([^\W\d]\w*)'*'")


def _named(what: str, files: _Files) -> tuple[str, ...]:
    """The path of the first thing that a message names in quotes; () where there is none, or are several so called."""
    for name in _QUOTED.findall(what):
        found = [(table, name) for table in TABLES if files.has((table, name))]
        if found:
            return found[0] if len(found) == 1 else ()
    return ()


def warned(model: Model, data: bytes, name: str) -> tuple[Problem, ...]:
    """The warnings of a model, each at its place in the text that the model was read from."""
    return _Files.of(data, name).problems(list(model.warnings))


def _brought_by(path: tuple[str, ...], files: _Files) -> tuple[str, ...]:
    """The path of the part that brings another along: of bodies.arm for constraints.arm_low; else the path itself."""
    pieces = path[1].split("_") if len(path) > 1 else []
    names = ("_".join(pieces[:k]) for k in range(len(pieces) - 1, 0, -1))
    owners = ((table, name) for name in names for table in ("bodies", "forces") if files.has((table, name)))
    return next(owners, path)


@dataclass(frozen=True)
class _Files:
    """The texts of a model: its own, and those of its parts.

    Args:
        names: of the files.
        indices: of their texts.
        made: the tables that they stand for; None where nothing repeats.
    """

    names: tuple[str, ...]
    indices: tuple[Index, ...]
    made: Expanded | None = None

    @staticmethod
    def of(data: bytes, name: str) -> _Files:
        text = _text(data, name)
        index, made = index_of(text), None
        if (REPEAT,) in index.values or (PARTS,) in index.values:
            with suppress(Refused, ValueError, RecursionError):
                made = _expanded(text, name, tables_of(text))
        return _Files((name,), (index,)) if made is None else _Files._with_parts(made)

    @staticmethod
    def _with_parts(made: Expanded) -> _Files:
        names, texts = ([getattr(source, key) for source in made.sources] for key in ("name", "text"))
        return _Files(tuple(names), tuple(map(index_of, texts)), made)

    def has(self, path: DocumentPath) -> bool:
        """True if something is written at a path."""
        return path in self.indices[0].keys or (self.made is not None and path in self.made.places)

    def as_written(self, found: Diagnostic) -> tuple[int, Diagnostic]:
        return (0, found) if self.made is None else self.made.as_written(found)

    def problems(self, found: list[Diagnostic]) -> tuple[Problem, ...]:
        """Each diagnostic at its place, in the order of the files."""
        if self.made is None:
            return _problems(found, self.indices[0], self.names[0])
        by_file: dict[int, list[Diagnostic]] = {}
        first: dict[tuple[int, DocumentPath], str] = {}
        for each in found:
            number, told = self.made.as_written(each)
            where = self.made.origin(each.path).where
            if first.setdefault((number, told.path), where) == where:  # of what repeats one is told
                by_file.setdefault(number, []).append(told)
        return tuple(x for k, each in sorted(by_file.items()) for x in _problems(each, self.indices[k], self.names[k]))


def _expanded(text: str, name: str, raw: dict[str, Any]) -> Expanded:
    """The tables that those of a text stand for."""

    def draft(tables: Mapping[str, Any], found: list[Diagnostic]) -> Any:
        return draft_of(Model, tables, "part", found)

    def read_part(path: str, beside: str) -> ModelFile:
        other = beside_file(path, beside)
        content = _text(read(other, LARGEST), other)
        return ModelFile(other, content, _table(content, index_of(content), other)[0])

    return repetition_of(ModelFile(name, text, raw), draft, read_part, {})


def _loads(data: bytes, name: str, title: str) -> Model:
    text = _text(data, name)
    index = index_of(text)
    if index.deep is not None:
        deep = Diagnostic((), "a key with too many pieces", "a model needs at most bodies.arm.joint")
        raise ModelError((_problem(deep, index.deep, index, name),))
    raw, twice = _table(text, index, name)
    found, files = _version(raw), _Files((name,), (index,))
    if is_repeated(raw):
        try:
            files = _Files._with_parts(_expanded(text, name, raw))
        except Refused as error:
            source = error.source or ModelFile(name, text, raw)
            raise ModelError((*twice, *_problems([error.found], index_of(source.text), source.name))) from error
        raw = _repeated(files.made, title)
    draft: Model = draft_of(Model, raw, title, found)
    found += diagnostics_of(draft, found)
    if found or twice:
        raise ModelError((*twice, *files.problems(found)))
    return resolved(draft)


def _repeated(made: Expanded | None, title: str) -> dict[str, Any]:
    """The tables that are made, with what is needed to make them again."""
    assert made is not None
    own, *parts = made.sources
    texts = tuple({source.name: source.text for source in parts}.items())
    return {**made.tables, REPEAT: Repetition(own.text, own.name, title, made.counts, texts)}


def _text(data: bytes, name: str) -> str:
    if len(data) > LARGEST:
        raise ModelError("the file is over 1 MB", f"{name}:1:1", "say it in Python: a model is the same value there")
    try:
        return data.decode("utf-8-sig").replace("\r\n", "\n")
    except UnicodeDecodeError as error:
        before = data[: error.start].decode("utf-8-sig", "replace")
        line, column = before.count("\n") + 1, len(before) - before.rfind("\n")
        what, binary = f"not UTF-8: byte 0x{data[error.start]:02x}", b"\0" in data and not data.startswith(UTF_16)
        fix = "it is no text: give the model, a file .toml" if binary else "save it as UTF-8"
        raise ModelError(what, f"{name}:{line}:{column}", fix) from error


def _table(text: str, index: Index, name: str) -> tuple[dict[str, Any], list[Problem]]:
    """The values of a text, and its keys that are there twice (of which the first one counts)."""
    try:
        return tables_of(text), []
    except (ValueError, RecursionError) as error:
        failure = error
    repeated = index.twice[:MOST_DIAGNOSTICS]
    twice = [_problem(_again(path, index), span, index, name) for path, span, _ in repeated]
    if not twice:
        raise ModelError((_not_toml(failure, index, name),)) from failure
    try:
        return tables_of(_without(text, [s for _, _, s in repeated if s])), twice
    except (ValueError, RecursionError):
        raise ModelError(tuple(twice)) from failure


def _without(text: str, spans: list[Span]) -> str:
    """The text with blanks in place of some statements."""
    for span in spans:
        blank = "".join("\n" if c == "\n" else " " for c in text[span.start : span.end])
        text = text[: span.start] + blank + text[span.end :]
    return text


def _again(path: DocumentPath, index: Index) -> Diagnostic:
    line = index.line_and_column(index.keys[path].start)[0]
    return Diagnostic(path, f"'{path[-1]}' is given twice", f"first given in line {line}")


def _not_toml(error: Exception, index: Index, name: str) -> Problem:
    """The problem that tomllib reports, at the place that it reports."""
    message = str(error)
    place = re.search(r"\(at (?:line (\d+), column (\d+)|end of document)\)", message)
    what = re.sub(r"\s*\(at .*\)$", "", message)
    if isinstance(error, RecursionError):
        what = "tables or lists too deep inside one another"
    elif place is None:
        what = "a number with too many digits"
    if place is not None and place.group(1):
        lines = index.text.split("\n")
        offset = sum(len(line) + 1 for line in lines[: int(place.group(1)) - 1]) + int(place.group(2)) - 1
    else:
        offset = max(0, len(index.text.rstrip()) - 1) if place is not None else 0
    what, fix = reported_of_toml(what, index.text, offset)
    return _problem(Diagnostic((), f"not TOML: {what}", fix), Span(offset, offset + 1), index, name)


def _version(raw: dict[str, Any]) -> list[Diagnostic]:
    """Diagnostics of the first key, `eomgen = 1`."""
    if "eomgen" not in raw:
        return [Diagnostic((), "the file does not say that it is a model", "begin it with the line: eomgen = 1")]
    version = raw["eomgen"]
    if type(version) is not int or version != VERSION:
        what = f"version {shown(version)} of the model file is not known here, only version {VERSION}"
        return [Diagnostic(("eomgen",), what, "write eomgen = 1")]
    return []


def _problems(found: list[Diagnostic], index: Index, name: str) -> tuple[Problem, ...]:
    """Each diagnostic at its place, in the order of the file."""
    found = _as_written(found)
    placed = sorted(((_span(diagnostic, index), diagnostic) for diagnostic in found), key=lambda pair: pair[0].start)
    problems = tuple(
        dict.fromkeys(_problem(diagnostic, span, index, name) for span, diagnostic in placed[:MOST_DIAGNOSTICS])
    )
    more = len(placed) - MOST_DIAGNOSTICS
    return (*problems, Problem(name, f"and {more} more problems")) if more > 0 else problems


def _as_written(found: list[Diagnostic]) -> list[Diagnostic]:
    """The diagnostics, with the keys that stand in the file in their paths, where some were read for others."""
    written = {(*f.path[:-1], f.instead): f.path for f in found if f.instead}
    return [replace(f, path=_through(f.path, written)) for f in found] if written else found


def _through(path: DocumentPath, written: Mapping[DocumentPath, DocumentPath]) -> DocumentPath:
    for k in range(1, len(path) + 1):
        path = (*written.get(path[:k], path[:k]), *path[k:])
    return path


def _span(diagnostic: Diagnostic, index: Index) -> Span:
    if diagnostic.column is not None:
        return index.within(diagnostic.path, diagnostic.column, diagnostic.length or 1)
    return index.nearest(diagnostic.path, diagnostic.key)


def _problem(diagnostic: Diagnostic, span: Span, index: Index, name: str) -> Problem:
    line, column = index.line_and_column(span.start)
    beside = None if diagnostic.beside is None else index.within(diagnostic.path, *diagnostic.beside)
    excerpt = _excerpt(index, span, beside)
    return Problem(f"{name}:{line}:{column}", diagnostic.what, excerpt, diagnostic.fix)


def _excerpt(index: Index, span: Span, beside: Span | None = None) -> str:
    """The source line (the part of it around the culprit) and the carets under it, under both where there are two."""
    line, column = index.line_and_column(span.start)
    source = index.line(line)
    first = 0 if len(source) <= WIDEST else max(0, column - 1 - WIDEST // 2)
    shown = source[first : first + WIDEST].replace("\t", " ").rstrip()
    marks = [" "] * len(shown)
    for each in (span, *([beside] if beside is not None and index.line_and_column(beside.start)[0] == line else [])):
        at = index.line_and_column(each.start)[1] - 1 - first
        carets = max(1, min(each.end - each.start, len(shown) - at))
        marks += [" "] * (at + carets - len(marks))
        marks[max(at, 0) : at + carets] = "^" * (at + carets - max(at, 0))
    return f"    {shown}\n    {''.join(marks).rstrip()}"


# -------- not toml --------------------------------------------------------------------------------------------
# What tomllib refuses -> what is wrong and how it is fixed: other formats, other habits of writing.


_TABLES = 'write: name = "crane", and [bodies.boom] for a table'
_OTHERS = (
    (re.compile(r"(?:\s|#[^\n]*\n|---)*[A-Za-z_]\w*:(?:\s|$)"), "this looks like YAML", _TABLES),
    (re.compile(r"\s*\{"), "this looks like JSON", _TABLES),
    (re.compile(r"\s*<"), "this looks like XML", "`eomgen import` makes a model of a robot's file"),
    (re.compile(r"\s*(?:import|from) \w|\s*def \w+\("), "this looks like Python", "a model made there is run there"),
    (re.compile(r"PK\x03\x04"), "this is an archive, no text", "give the model, a file .toml"),
)
_WORDS = re.compile(r"\s*(name|about|source|space)\s*=\s*([A-Za-z][\w ]*)$")
_COMMA = re.compile(r"=\s*([-+]?\d+(?:\.\d{3})*),(\d+)\b")


def reported_of_toml(what: str, text: str, offset: int) -> tuple[str, str]:
    """(what is wrong, how to fix it) where tomllib stops.

    Args:
        what: it says.
        offset: of the place at which it stops.
    """
    for begins, looks, fix in _OTHERS:
        if begins.match(text):
            return looks, fix
    before, culprit = text[:offset], text[offset : offset + 1]
    return what, _of_character(before, culprit) or _of_line(what, text, before, culprit) or _of_words(what)


def _of_character(before: str, culprit: str) -> str:
    """The fix that follows from the character at which tomllib stops; "" if none does."""
    if culprit in ("\n", "#") and before.rfind("{") > max(before.rfind("}"), before.rfind("\n[")):
        return "a table in braces stands in one line; or write it as one with a head, like [bodies.boom.joint]"
    if culprit == ";" and before.count("[") > before.count("]"):
        return "a comma stands between two of a list: [1, 0]"
    if culprit in tuple("“”„‘’"):
        return 'quotes are straight: "'
    if culprit in tuple("−–—"):
        return "write -"
    if culprit == "\r":
        return "its lines end in CR alone: let them end in LF or CRLF"
    if culprit == "(":
        return "brackets of a list and of a head are square: [0, 1], [outputs]"
    if culprit == "}" and before.rstrip(" \t").endswith(","):
        return "leave out the comma before }"
    return invisible(culprit)


def _of_line(what: str, text: str, before: str, culprit: str) -> str:
    """The fix that follows from the line in which tomllib stops; "" if none does."""
    line = text[before.rfind("\n") + 1 :].split("\n", 1)[0]
    if found := _COMMA.search(line):
        return f"write a decimal point: {found[1].replace('.', '')}.{found[2]}"
    if words := _WORDS.match(line):
        return f'a text stands in quotes: {words[1]} = "{words[2].strip()}"'
    if culprit in ("/", ";"):
        return "a remark begins with #" if culprit == "/" else "leave it out: a line ends by itself"
    if line.lstrip().startswith("[["):
        return "a table has a name and single brackets: [bodies.boom]"
    if culprit.isalpha() and not culprit.isascii():
        return f'as a key a name with such letters stands in quotes: "{culprit}" = 1'
    if "\\" in line and ("'\\'" in what or "hex" in what):
        return r"in single quotes a backslash is one: symbol = '\theta_A'"
    if culprit == "\n" and line.count('"') % 2:
        return "a text ends with its quote, in the same line"
    return ""


def _of_words(what: str) -> str:
    """The fix that follows from tomllib's message."""
    if "digits" in what or "deep" in what:
        return "make it smaller"
    if "Expected '='" in what:
        return 'a line is NAME = VALUE: angle = "theta - pi/2"'
    return (
        'an expression stands in quotes: angle = "theta - pi/2"' if "value" in what.lower() else "see https://toml.io"
    )
