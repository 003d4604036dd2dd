"""What every language can say, and how one says it: statements over text of scalars -> lines of a language.

A name for a value that stays, an array and what is put into it, a table, `for` over a range, `if`, a call, `return`:
no more. A number that changes is an array of one. Indices count from 0.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass

from eomgen.codegen.expressions import RankedText, ranked_number
from eomgen.symbolic.expression.graph import Number

REAL, INT = "Real", "Int"
READ, CHANGED, INDICES, PLACES = "Reals", "Work", "Ints", "Places"  # arrays: the last two of indices, read and changed
ROOM = "Room"  # an array of numbers that are written before they are read


@dataclass(frozen=True)
class Let:
    """A name for a value that stays."""

    name: str
    value: str
    kind: str = REAL
    remark: str = ""


@dataclass(frozen=True)
class Put:
    """A place of an array gets a value."""

    array: str
    index: str
    value: str


@dataclass(frozen=True)
class Array:
    """An array of zeros, kind CHANGED or PLACES, or of anything, kind ROOM."""

    name: str
    size: str
    kind: str = CHANGED


@dataclass(frozen=True)
class For:
    """For name = first, ..., last - 1; from the end where it goes down."""

    name: str
    first: str
    last: str
    body: tuple[Statement, ...]
    down: bool = False


@dataclass(frozen=True)
class If:
    """A condition, what is done where it holds, and where it does not."""

    condition: str
    body: tuple[Statement, ...]
    otherwise: tuple[Statement, ...] = ()


@dataclass(frozen=True)
class Call:
    """A function that changes arrays."""

    function: str
    arguments: tuple[str, ...]


@dataclass(frozen=True)
class Return:
    """The end of a function, and what it gives, "" where that is nothing."""

    value: str = ""


Statement = Let | Put | Array | For | If | Call | Return


@dataclass(frozen=True)
class Table:
    """Numbers that never change: INDICES or READ; of kind INT one alone."""

    name: str
    values: Sequence[float]
    kind: str = INDICES
    remark: str = ""


@dataclass(frozen=True)
class Function:
    """A function.

    Args:
        arguments: (name, kind).
        gives: the kind of what it returns, "" where that is nothing.
        out: (name, size) of the array that the caller gets; last among the arguments where results are arguments.
        apart: it is not to become one with the function that calls it.
        about: one line.
    """

    name: str
    arguments: tuple[tuple[str, str], ...]
    body: tuple[Statement, ...]
    gives: str = ""
    out: tuple[str, int] | None = None
    about: str = ""
    apart: bool = False


def one_line(text: str) -> str:
    """Text with blanks for what is not printed."""
    return "".join(letter if letter.isprintable() else " " for letter in text)


@dataclass(frozen=True)
class Language:
    """The table of a language: its words as templates.

    Args:
        reserved: words that cannot be names.
        functions: of an op that has another name: its text, with {0}, {1} for the arguments.
        defined: of an op that the language lacks, or where it drops a NaN: its definition; of "solve" and "solve_plain"
            where loops with pivots are not its way.
        words: of "and or not nan", and "given": the condition that the caller gives inputs.
        kinds: how a value that stays, an argument and a result of each kind are declared, with {name}.
        at: a place of an {array} at an {index}.
        let, put, call, back: statements; back with {value}.
        arrays: of CHANGED, ROOM and PLACES: with {name}, {size}.
        tables: of INT, INDICES and READ: with {name}, {size}, {values}.
        listed: how the values of a table are held together.
        loop, down: (begin, end) of a loop, with {name}, {first}, {last}.
        branch: (begin, else, end), with {condition}.
        function: (begin, end), with {declared}, its name and kind, and {arguments}.
        out: the same of one that gives an array {out} of {size}, with {name}.
        hidden: what stands before a function that others do not call, as {hidden} in `function`.
        remark: of one line, with {text}; harmless: text that cannot end it.
        unused: said of an argument that a function does not need.
        number: the text of an exact number.
        longest: operations of a function, beyond which it is cut into parts; None: never.
    """

    reserved: frozenset[str]
    functions: Mapping[str, str]
    defined: Mapping[str, str]
    words: Mapping[str, str]
    kinds: Mapping[str, str]
    at: str
    let: str
    put: str
    call: str
    back: str
    arrays: Mapping[str, str]
    tables: Mapping[str, str]
    listed: tuple[str, str]
    loop: tuple[str, str]
    down: tuple[str, str]
    branch: tuple[str, str, str]
    function: tuple[str, str]
    out: tuple[str, str]
    remark: str
    unused: str = ""
    hidden: str = ""
    number: Callable[[Number], RankedText] = ranked_number
    harmless: Callable[[str], str] = one_line
    longest: int | None = None

    def called(self, op: str, arguments: Sequence[str]) -> str:
        """A function's text."""
        form = self.functions.get(op)
        return f"{op}({', '.join(arguments)})" if form is None else form.format(*arguments)

    def place(self, array: str, index: object) -> str:
        """A place of an array."""
        return self.at.format(array=array, index=index)

    def lines(self, statements: Iterable[Statement]) -> list[str]:
        """Statements, a line or a block each."""
        return [line for statement in statements for line in self._said(statement)]

    def _said(self, s: Statement) -> list[str]:
        match s:
            case Let():
                declared = self.kinds[s.kind].format(name=s.name)
                return [self.let.format(declared=declared, value=s.value) + self._remark(s.remark, " ")]
            case Put():
                return [self.put.format(place=self.place(s.array, s.index), value=s.value)]
            case Array():
                return [self.arrays[s.kind].format(name=s.name, size=s.size)]
            case For():
                begin, end = self.down if s.down else self.loop
                return _block([(begin.format(name=s.name, first=s.first, last=s.last), self.lines(s.body))], end)
            case If():
                begin, otherwise, end = self.branch
                blocks = [(begin.format(condition=s.condition), self.lines(s.body))]
                return _block([*blocks, *([(otherwise, self.lines(s.otherwise))] if s.otherwise else [])], end)
            case Call():
                return [self.call.format(function=s.function, arguments=", ".join(s.arguments))]
            case Return():
                return [self.back.format(value=s.value).replace(" ;", ";").rstrip()]  # of nothing: return;

    def defines(self, function: Function) -> list[str]:
        """A function."""
        body = self.lines(function.body)
        begin, end = self.out if function.out else self.function
        out, size = function.out or ("", 0)
        opened = begin.format(
            name=function.name,
            declared=self.kinds[function.gives].format(name=function.name),
            arguments=", ".join(self.kinds[kind].format(name=name) for name, kind in function.arguments),
            hidden="" if function.apart else self.hidden,
            out=out,
            size=size,
        )
        said = self.remark.partition("{text}")[0]
        text, names = (
            "\n".join(line.partition(said)[0] for line in body),
            [*(name for name, _ in function.arguments), *([out] if out else [])],
        )
        spare = [name for name in names if self.unused and not re.search(rf"\b{name}\b", text)]
        inner = [*map(lambda name: self.unused.format(name=name), spare), *body]
        about = [self._remark(function.about)] if function.about else []
        return [
            *about,
            *opened.split("\n"),
            *(f"    {line}" for line in inner),
            *([end.replace("{out}", out)] if end else []),
        ]

    def holds(self, table: Table) -> str:
        """A table."""
        values = table.values or (0,)  # C knows no array without entries
        listed = ", ".join(map(repr, values)).join(self.listed)
        text = self.tables[table.kind].format(name=table.name, size=len(values), values=listed, value=values[0])
        return text + self._remark(table.remark, " ")

    def _remark(self, text: str, before: str = "") -> str:
        return before + self.remark.format(text=self.harmless(text)) if text else ""


def _block(parts: Sequence[tuple[str, list[str]]], end: str) -> list[str]:
    """Begin, indented lines, ..., and the end where there is one."""
    said = [line for begin, body in parts for line in (begin, *(f"    {line}" for line in body))]
    return [*said, end] if end else said
