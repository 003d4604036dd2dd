"""Statements that every language has, over text of scalars -> lines of a language.

A name for a value that stays, an array and assignments to it, a table, `for` over a range, `if`, a call, `return`:
no more. A number that changes is an array of one. Indices count from 0.
"""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import field, replace

from eomgen.errors import DerivationError
from eomgen.frozen import dataclass
from eomgen.symbolic.expression import Fraction, Node, Number, Scalar
from eomgen.symbolic.numeric import number_of

# -------- text of assignments ---------------------------------------------------------------------------------
# Statements of a Program -> text of assignments, in the grammar that languages share.
#
# Signs and constants are written in place, and so are short parts that are used once; everything else
# gets a variable. The order of operations is the graph's: the text rounds as the graph does.


SUM, PRODUCT, ATOM = 1, 2, 3  # how strongly a text holds together
LONGEST_INLINE = 60
LARGEST_WHOLE = 2**53  # up to here every whole number is a double

RankedText = tuple[str, int]
CallText = Callable[[str, list[str]], str]


class ExpressionWriter:
    """Texts of the nodes of one function body; grows while the body is written.

    Args:
        call: a function's text from its op and its arguments' texts, in the language.
        number: the text of an exact number, in the language.
        names: the identifier of each symbol, and the text of values computed elsewhere.
        inverse: of divisors the text of their reciprocals.
        prefix: of our variables, v1, v2, ...
    """

    def __init__(
        self,
        call: CallText,
        number: Callable[[Number], RankedText],
        names: Mapping[Node, str],
        inverse: Mapping[Node, str],
        prefix: str,
    ) -> None:
        self._call, self._number, self._inverse, self._prefix = call, number, inverse, prefix
        self._texts: dict[Node, RankedText] = {node: (text, ATOM) for node, text in names.items()}
        self._count = 0

    def assignments(self, nodes: Iterable[Node], once: frozenset[Node]) -> list[tuple[str, str]]:
        """(variable, text) for the nodes in their order; those in `once` may go where they are used."""
        lines = []
        for node in nodes:
            text, strength = self._operation(node)
            if node in once and len(text) <= LONGEST_INLINE:
                self._texts[node] = text, strength
                continue
            self._count += 1
            variable = f"{self._prefix}{self._count}"
            self._texts[node] = variable, ATOM
            lines.append((variable, text))
        return lines

    def define(self, node: Node, text: str) -> None:
        """Give a node a text of its own: the unknown of a solve."""
        self._texts[node] = text, ATOM

    def value(self, x: Scalar) -> str:
        """The text of a scalar whose node was assigned."""
        return self._text(x)[0]

    def factor(self, x: Scalar) -> str:
        """The same, to be divided by."""
        return held(self._text(x), ATOM)

    def _text(self, x: Scalar) -> RankedText:
        if not isinstance(x, Node):
            return self._number(x)
        known = self._texts.get(x)
        if known is None:
            if x.op == "neg":
                known = f"-{held(self._text(x.args[0]), PRODUCT)}", SUM
            else:  # an exact constant: sqrt(2), pi/2
                known = self._number(Fraction(number_of(x)))
            self._texts[x] = known
        return known

    def _operation(self, x: Node) -> RankedText:
        if x.op == "div" and x.args[1] in self._inverse:
            inverse = self._inverse[x.args[1]]
            return (inverse, ATOM) if x.args[0] == 1 else (f"{held(self._text(x.args[0]), PRODUCT)}*{inverse}", PRODUCT)
        if x.op == "sampled":
            return self._call(x.op, [self._text(x.args[0])[0], str(x.args[1])]), ATOM
        arguments = [self._text(a) for a in x.args]
        if x.op in ("add", "sub"):
            a, b = arguments
            return f"{a[0]} {'+' if x.op == 'add' else '-'} {held(b, PRODUCT)}", SUM
        if x.op in ("mul", "div"):
            a, b = arguments
            return f"{held(a, PRODUCT)}{'*' if x.op == 'mul' else '/'}{held(b, ATOM)}", PRODUCT
        return self._call(x.op, [text for text, _ in arguments]), ATOM


def used_once(bodies: Iterable[tuple[Sequence[Node], Iterable[Scalar]]]) -> frozenset[Node]:
    """Nodes with one use in all, in the function body that computes them.

    Args:
        bodies: of each function body the nodes that it computes and all that its text reads.
    """
    uses: Counter[Node] = Counter()
    for computed, read in bodies:
        own = frozenset(computed)
        for x in read:
            if type(x) is Node:
                x = x.args[0] if x.op == "neg" else x
                uses[x] += 1 if x in own else 2
    return frozenset(node for node, count in uses.items() if count == 1)


def ranked_number(a: Number) -> RankedText:
    """The nearest double of an exact number; 1/3 stays a quotient, for the reader."""
    if a < 0:
        return f"-{held(ranked_number(-a), PRODUCT)}", SUM
    a = Fraction(a)
    try:
        value = float(a)
    except OverflowError:
        raise DerivationError(
            f"the number {str(a)[:20]}... is too large for a double",
            fix="scale the parameters: other units, or numbers nearer to 1",
        ) from None
    if Fraction(value) == a or a.denominator > 10_000 or a.numerator > LARGEST_WHOLE:
        return repr(value), ATOM
    return f"{float(a.numerator)!r}/{float(a.denominator)!r}", PRODUCT


def held(text: RankedText, strength: int) -> str:
    """The text, in parentheses where it holds together less than it must."""
    return text[0] if text[1] >= strength else f"({text[0]})"


REAL, INT = "Real", "Int"
READ, CHANGED, INDICES, PLACES = "Reals", "Work", "Ints", "Places"  # arrays: the last two of indices, read and changed
ROOM = "Room"  # an array of numbers that are written before they are read
GIVEN = "Given"  # an array that is read, which the caller may leave out: the inputs
KINDS = ("", REAL, INT, READ, CHANGED, INDICES, PLACES, GIVEN)


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
    """Loop over name = first, ..., last - 1; from the end where it goes down."""

    name: str
    first: str
    last: str
    body: tuple[Statement, ...]
    down: bool = False


@dataclass(frozen=True)
class If:
    """A condition, with the statements for both cases."""

    condition: str
    body: tuple[Statement, ...]
    otherwise: tuple[Statement, ...] = ()


@dataclass(frozen=True)
class Call:
    """A function that changes arrays; where it gives a number, the name for that and its kind."""

    function: str
    arguments: tuple[str, ...]
    changed: tuple[str, ...] = ()
    name: str = ""
    kind: str = INT


@dataclass(frozen=True)
class Return:
    """The end of a function, with its result; "" without one."""

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
        gives: the kind of its result, "" without one.
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

    @property
    def changed(self) -> tuple[str, ...]:
        """The arrays among the arguments that it changes."""
        return tuple(name for name, kind in self.arguments if kind in (CHANGED, PLACES))


def itself(name: str) -> str:
    """A name as it is."""
    return name


def one_line(text: str) -> str:
    """Text with blanks for characters that are not printed."""
    return "".join(letter if letter.isprintable() else " " for letter in text)


@dataclass(frozen=True)
class Language:
    """The table of a language: its words as templates.

    Args:
        reserved: words that cannot be names.
        functions: of an op that has another name: its text, with {0}, {1} for the arguments.
        defined: of an op that the language lacks, or where it drops a NaN: its definition; of "solve" and "solve_plain"
            where loops with pivots are not its way.
        words: of "not nan", of "==" and "!=" where they are said otherwise, and "given": the condition that the caller
            gives inputs.
        kinds: declarations of a value that stays, an argument and a result of each kind, with {name}.
        at: a place of an {array} at an {index}; `index` is what stands there for an index that is computed, first that
            of the first place; `sized` what stands for a {size} that is computed.
        let, put, call, back: statements; back with {value}.
        changes: a call where arguments cannot be changed, with the {results} that stand for them; "" where they can.
        leave: the end of a function that gives nothing.
        gives: text of {gives} in `function`, by the kind of the result.
        what: text of {what} there, of a function without a result and of one with a result.
        arrays: of CHANGED, ROOM and PLACES: with {name}, {size}, and {of}, the function.
        kept: declaration of one that is made once for all calls, before its function; "" where each call makes its own.
        tables: of INT, INDICES and READ: with {name}, {size}, {values}.
        listed: text around the values of a table.
        loop, down: (begin, end) of a loop, with {name}, {first}, {last}.
        branch: (begin, else, end), with {condition}.
        function: (begin, end), with {declared}, its name and kind, and {arguments}; {results} as in `changes`.
        out: the same of one that gives an array {out} of {size}, with {name}.
        hidden: text before a function that others do not call, as {hidden} in `function`.
        remark: of one line, with {text}; harmless: text that cannot end it.
        unused: said of an argument that a function does not need.
        number: the text of an exact number.
        longest: operations of a function, beyond which it is cut into parts; None: never.
        local: declarations of names and arrays of each kind where they stand at the head of a function, after the
            arguments; none where they are declared as they come.
        spelled: the spelling of a name of the kernels; folded: what two names may not have in common.
    """

    reserved: frozenset[str]
    functions: Mapping[str, str]
    defined: Mapping[str, str]
    words: Mapping[str, str]
    let: str
    arrays: Mapping[str, str]
    tables: Mapping[str, str]
    loop: tuple[str, str]
    down: tuple[str, str]
    function: tuple[str, str]
    out: tuple[str, str]
    kinds: Mapping[str, str] = field(default_factory=lambda: dict.fromkeys(KINDS, "{name}"))
    at: str = "{array}[{index}]"
    put: str = "{place} = {value};"
    call: str = "{function}({arguments});"
    back: str = "return {value};"
    listed: tuple[str, str] = ("[", "]")
    branch: tuple[str, str, str] = ("if ({condition}) {{", "} else {", "}")
    remark: str = "// {text}"
    unused: str = ""
    hidden: str = ""
    number: Callable[[Number], RankedText] = ranked_number
    harmless: Callable[[str], str] = one_line
    longest: int | None = None
    index: str = "{index}"
    first: int = 0
    sized: str = "{size}"
    changes: str = ""
    leave: str = "return;"
    gives: Mapping[str, str] = field(default_factory=dict)
    what: tuple[str, str] = ("", "")
    local: Mapping[str, str] = field(default_factory=dict)
    kept: str = ""
    spelled: Callable[[str], str] = itself
    folded: Callable[[str], str] = itself

    def called(self, op: str, arguments: Sequence[str]) -> str:
        """A function's text."""
        form = self.functions.get(op)
        return f"{op}({', '.join(arguments)})" if form is None else form.format(*arguments)

    def place(self, array: str, index: object) -> str:
        """A place of an array."""
        text = str(index)
        computed = self.index.format(index=text)
        computed = computed.replace(f"({text})", text) if text.isidentifier() else computed
        return self.at.format(array=array, index=str(int(text) + self.first) if text.isdigit() else computed)

    def real(self, value: float) -> str:
        """The text of a double."""
        return self.number(Fraction(value))[0]

    def lines(self, statements: Iterable[Statement]) -> list[str]:
        """Statements, a line or a block each."""
        return [line for statement in statements for line in self._said(statement)]

    def _said(self, s: Statement) -> list[str]:
        match s:
            case Let():
                return [self._let(s.name, s.kind, s.value) + self._remark(s.remark, " ")]
            case Put():
                return [self.put.format(place=self.place(s.array, s.index), value=s.value)]
            case Array():
                size = s.size if s.size.isdigit() else self.sized.format(size=s.size)
                text = self.arrays[s.kind].format(name=s.name, size=size)
                return text.split("\n") if text else []
            case For():
                begin, end = self.down if s.down else self.loop
                return _block([(begin.format(name=s.name, first=s.first, last=s.last), self.lines(s.body))], end)
            case If():
                begin, otherwise, end = self.branch
                blocks = [(begin.format(condition=s.condition), self.lines(s.body))]
                return _block([*blocks, *([(otherwise, self.lines(s.otherwise))] if s.otherwise else [])], end)
            case Call():
                return [self._called(s)]
            case Return():
                return self.back.format(value=s.value).split("\n") if s.value else [self.leave]

    def _let(self, name: str, kind: str, value: str) -> str:
        return self.let.format(declared=self.kinds[kind].format(name=name), value=value)

    def _called(self, s: Call) -> str:
        arguments = ", ".join(s.arguments)
        if self.changes:
            results = ", ".join([*([s.name] if s.name else []), *s.changed])
            return self.changes.format(results=results, function=s.function, arguments=arguments)
        if s.name:
            return self._let(s.name, s.kind, f"{s.function}({arguments})")
        return self.call.format(function=s.function, arguments=arguments)

    def defines(self, function: Function) -> list[str]:
        """A function."""
        named = {kind: text.replace("{of}", function.name) for kind, text in self.arrays.items()}
        body = replace(self, arrays=named).lines(function.body)
        begin, end = self.out if function.out else self.function
        out, size = function.out or ("", 0)
        arguments = [self._kind(kind).format(name=name) for name, kind in function.arguments]
        opened = begin.format(
            declared=self.kinds[function.gives].format(name=function.name),
            name=function.name,
            arguments=", ".join(arguments),
            results=", ".join([*(["found"] if function.gives else []), *function.changed]),
            hidden="" if function.apart else self.hidden,
            gives=self.gives.get(function.gives, ""),
            what=self.what[bool(function.gives)],
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
        arrays = {name: size for name, (_, size) in _declared(function.body) if size and self.kept}
        return [
            *(self.kept.format(name=name, size=size, of=function.name) for name, size in arrays.items()),
            *about,
            *opened.split("\n"),
            *(f"    {line}" for line in (*self._heads(function), *inner)),
            *([_ended(end, out, function.name, self.what[bool(function.gives)])] if end else []),
        ]

    def _kind(self, kind: str) -> str:
        return self.kinds.get(kind, self.kinds[READ]) if kind == GIVEN else self.kinds[kind]

    def _heads(self, function: Function) -> list[str]:
        """The declarations at the head of a function, where a language has them there."""
        if not self.local:
            return []
        named = {name: kind for name, kind in function.arguments}
        lines = [self.local[f"argument {kind}"].format(name=name) for name, kind in named.items()]
        if function.gives:
            lines.append(self.local[function.gives].format(name="found"))
        if function.out:
            lines.append(self.local["out"].format(name=function.out[0], size=function.out[1]))
        inside = {name: declared for name, declared in _declared(function.body) if name not in named}
        return [*lines, *(self.local[kind].format(name=name, size=size) for name, (kind, size) in inside.items())]

    def holds(self, table: Table) -> str:
        """A table."""
        values = table.values or (0,)  # C knows no array without entries
        texts = [self.real(x) if table.kind == READ else str(x) for x in values]
        listed, name = ", ".join(texts).join(self.listed), self.spelled(table.name)
        text = self.tables[table.kind].format(
            name=name, size=len(values), values=listed, value=values[0], last=len(values) - 1
        )
        return text + self._remark(table.remark, " ")

    def _remark(self, text: str, before: str = "") -> str:
        return before + self.remark.format(text=self.harmless(text)) if text else ""


def _ended(end: str, out: str, name: str, what: str) -> str:
    return end.replace("{out}", out).replace("{name}", name).replace("{what}", what)


def _declared(statements: Iterable[Statement]) -> Iterator[tuple[str, tuple[str, str]]]:
    """(name, (kind, size)) of the names that the statements declare; the kind of an array is that of its numbers."""
    for s in statements:
        match s:
            case Let(name=name, kind=kind):
                yield name, (kind, "")
            case Call(name=name, kind=kind) if name:
                yield name, (kind, "")
            case Array(name=name, size=size, kind=kind):
                yield name, (PLACES if kind == PLACES else CHANGED, size)
            case For(name=name, body=body):
                yield name, (INT, "")
                yield from _declared(body)
            case If(body=body, otherwise=otherwise):
                yield from _declared((*body, *otherwise))


def _block(parts: Sequence[tuple[str, list[str]]], end: str) -> list[str]:
    """Begin, indented lines, ..., and the end where there is one."""
    said = [line for begin, body in parts for line in (begin, *(f"    {line}" for line in body))]
    return [*said, end] if end else said
