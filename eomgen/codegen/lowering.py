"""Program, Language -> Lowered: a program's functions in the small language, its scalars in the language's words.

    constants(p) -> c            what the parameters alone determine, and the reciprocals that are multiplied by
    evaluate(t, x, p, c, inputs) -> the outputs

A long program is cut into parts where the language asks for it: a compiler's time grows faster than the length of one
function. What one part computes and another reads stands in an array between them.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field
from functools import cached_property
from typing import Any

from eomgen.codegen.expressions import ExpressionWriter, used_once
from eomgen.codegen.kernel_reader import kernel
from eomgen.codegen.lowered import (
    CHANGED,
    READ,
    REAL,
    Array,
    Call,
    Function,
    If,
    Language,
    Let,
    Put,
    Return,
    Statement,
    Table,
)
from eomgen.codegen.names import identifiers
from eomgen.codegen.program import Assign, Program, Solve
from eomgen.symbolic.expression.graph import Node, Scalar
from eomgen.symbolic.expression.splines import Sampled, sampled_of

LENGTH = 600  # operations of a part
Arguments = tuple[tuple[str, str], ...]


@dataclass(frozen=True)
class Lowered:
    """A program in the small language.

    Args:
        constants: how many numbers the first function gives.
        ops: the operations that the text takes.
        tables, kernels: what the bodies need: functions with loops, and the numbers that these read.
        called: the functions among them that the bodies themselves call.
        bodies: constants, parts, evaluate.
    """

    program: Program
    constants: int
    ops: frozenset[str]
    tables: tuple[Table, ...]
    kernels: tuple[Function, ...]
    called: tuple[str, ...]
    bodies: tuple[Function, ...]


def lowered(
    program: Program, language: Language, result: str, prefix: str = "", remarks: Mapping[str, str] | None = None
) -> Lowered:
    """The functions of a program.

    Args:
        result: the name of the array of the outputs.
        prefix: of the functions' names.
        remarks: of an argument's name: its unit and what it is.
    """
    layout = Layout(program, language, result, prefix, remarks or {})
    tables, kernels = _kernels(layout)
    constants = len(layout.kept) + len(layout.inverted)
    return Lowered(program, constants, layout.ops, tables, kernels, layout.kernels, tuple(layout.functions()))


@dataclass(frozen=True)
class Layout:
    """A program cut into function bodies, with the names that its text uses."""

    program: Program
    language: Language
    result: str
    prefix: str
    remarks: Mapping[str, str]

    # -- what is read where -----------------------------------------------------------------------

    @cached_property
    def solve(self) -> Solve | None:
        return next((s for s in self.program.statements if type(s) is Solve), None)

    @cached_property
    def before(self) -> tuple[Node, ...]:
        """What is computed at every call before the solve; without one, all."""
        statements = self.program.statements
        return _nodes(statements[: statements.index(self.solve)] if self.solve else statements)

    @cached_property
    def moving(self) -> tuple[Node, ...]:
        return _nodes(self.program.statements)

    @cached_property
    def written(self) -> tuple[Scalar, ...]:
        return (*(self.solve.entries if self.solve else ()), *self.program.outputs)

    @cached_property
    def inputs(self) -> dict[Node, int]:
        """The inputs that are read, and their places."""
        read = _stripped([*(a for x in self.moving for a in x.args), *self.written])
        return {x: place for place, x in enumerate(self.program.symbols.inputs.values()) if x in read}

    @cached_property
    def defaults(self) -> tuple[Scalar, ...]:
        """The inputs' own expressions, of those that are read."""
        return tuple(self.program.defaults[place] for place in self.inputs.values())

    @cached_property
    def preamble(self) -> tuple[Node, ...]:
        return _nodes(self.program.preamble) if self.inputs else ()

    @cached_property
    def hoisted(self) -> tuple[Node, ...]:
        return _nodes(self.program.hoisted)

    @cached_property
    def inverted(self) -> dict[Node, None]:
        """The constants that something is divided by at every call: their reciprocals are stored."""
        fixed = {*self.hoisted, *self.program.symbols.parameters.values()}
        divided = (x.args[1] for x in (*self.moving, *self.preamble) if x.op == "div")
        return dict.fromkeys(x for x in divided if x in fixed)

    def reads(self, nodes: Iterable[Node]) -> list[Scalar]:
        """What the text of nodes reads, computed at every call: a reciprocal is multiplied by."""
        return [a for x in nodes for a in (x.args[:1] if x.op == "div" and x.args[1] in self.inverted else x.args)]

    @cached_property
    def kept(self) -> tuple[Node, ...]:
        """The constants that are read at every call, in their order in the array; the reciprocals follow."""
        read = _stripped([*self.reads((*self.moving, *self.preamble)), *self.written, *self.defaults])
        return tuple(x for x in self.hoisted if x in read)

    @cached_property
    def once(self) -> frozenset[Node]:
        """Nodes written where they are used; a constant that only its place reads, there."""
        first = [*(a for x in self.hoisted for a in x.args), *self.inverted]
        moving, own = [*self.reads(self.moving), *self.written], [*self.reads(self.preamble), *self.defaults]
        single = used_once([(self.hoisted, first), (self.moving, moving), (self.preamble, own)])
        return single | (frozenset(self.kept) - _stripped(first))

    @cached_property
    def ops(self) -> frozenset[str]:
        return frozenset((*(x.op for x in (*self.hoisted, *self.preamble, *self.moving)), *self.kernels))

    @cached_property
    def kernels(self) -> tuple[str, ...]:
        return (*((_entry(self.solve),) if self.solve else ()), *self.sampled.values())

    @cached_property
    def sampled(self) -> dict[int, str]:
        """The functions through samples that are called, samples1 first, by their number in the graph."""
        nodes = (*self.hoisted, *self.preamble, *self.moving)
        numbers = dict.fromkeys(x.args[1] for x in nodes if x.op == "sampled")
        return {number: f"samples{place}" for place, number in enumerate(numbers, start=1)}

    # -- names ------------------------------------------------------------------------------------

    @cached_property
    def names(self) -> dict[Node, str]:
        """An identifier for every argument and unknown."""
        program, symbols = self.program, self.program.symbols
        known = [*program.moving, *symbols.parameters.values(), *symbols.inputs.values()]
        known += [x for x in (self.solve.unknowns if self.solve else ()) if x not in known]
        taken = {*self.language.reserved, *(name for name, _ in self.arguments), self.result}
        words = identifiers([x.name for x in known], taken)
        return {x: words[x.name] for x in known} | {symbols.t: "t"}

    @cached_property
    def arguments(self) -> Arguments:
        a = [("a", READ)] if self.program.accelerations else []
        return (("t", REAL), ("x", READ), *a, ("p", READ))

    def writer(self, more: Mapping[Node, str] | None = None, letter: str = "v") -> ExpressionWriter:
        """For a body that reads the array of constants."""
        kept = {x: self.language.place("c", k) for k, x in enumerate(self.kept)}
        inverse = {x: self.language.place("c", len(kept) + k) for k, x in enumerate(self.inverted)}
        return ExpressionWriter(
            self.called, self.language.number, {**self.names, **kept, **(more or {})}, inverse, letter
        )

    def called(self, op: str, arguments: list[str]) -> str:
        if op == "sampled":
            return f"{self.sampled[int(float(arguments[1]))]}({arguments[0]})"
        return self.language.called(op, arguments)

    # -- bodies -----------------------------------------------------------------------------------

    def functions(self) -> list[Function]:
        takes, size = (*self.arguments, ("c", READ)), len(self.kept) + len(self.inverted)
        constants = Function(f"{self.prefix}constants", (("p", READ),), self._constants(), out=("c", size))
        pieces = range(len(self.parts.nodes))
        cut = [
            Function(f"{self.prefix}part{i}", (*takes, ("between", CHANGED)), self._part(i), apart=True) for i in pieces
        ]
        given, out = (*takes, ("inputs", READ)), (self.result, len(self.program.outputs))
        return [constants, *cut, Function(f"{self.prefix}evaluate", given, self._evaluate(), out=out)]

    def _constants(self) -> tuple[Statement, ...]:
        """What the parameters alone determine."""
        writer = ExpressionWriter(self.called, self.language.number, self.names, {}, "v")
        read = _stripped([*(a for x in self.hoisted for a in x.args), *self.inverted])
        lines: list[Statement] = [*self._loads(read, "p"), *_lets(writer, self.hoisted, self.once)]
        lines += [Put("c", str(k), writer.value(x)) for k, x in enumerate(self.kept)]
        one = writer.value(1)
        lines += [Put("c", str(len(self.kept) + k), f"{one}/{writer.factor(x)}") for k, x in enumerate(self.inverted)]
        return tuple(lines)

    def _evaluate(self) -> tuple[Statement, ...]:
        """Everything else."""
        parts = self.parts
        writer = self.writer({x: self._between(x) for x in parts.places})
        nodes = self.preamble if parts.nodes else (*self.moving, *self.preamble)
        read = _stripped([*self.reads(nodes), *self.written, *self.defaults])
        lines: list[Statement] = self._loads(read)
        lines += [Array("between", str(len(parts.places)))] if parts.nodes else []
        lines += self._inputs()
        cut = len(self.before)
        lines += self._run(range(parts.first)) if parts.nodes else _lets(writer, self.moving[:cut], self.once)
        lines += self._solved(writer) if self.solve else []
        lines += (
            self._run(range(parts.first, len(parts.nodes)))
            if parts.nodes
            else _lets(writer, self.moving[cut:], self.once)
        )
        return (*lines, *(Put(self.result, str(k), writer.value(x)) for k, x in enumerate(self.program.outputs)))

    def _loads(self, read: Iterable[Node], only: str = "") -> list[Statement]:
        """A name for each argument that is read."""
        program = self.program
        arrays = {"x": program.states, "a": program.accelerations, "p": tuple(program.symbols.parameters.values())}
        wanted = frozenset(read)
        return [
            Let(self.names[x], self.language.place(array, place), remark=self._remark(x))
            for array, symbols in arrays.items()
            for place, x in enumerate(symbols)
            if x in wanted and only in ("", array)
        ]

    def _remark(self, x: Node) -> str:
        text, word = self.remarks.get(x.name, ""), self.names[x]
        return f"{x.name}: {text}" if text and x.name != word else text or (x.name if x.name != word else "")

    def _inputs(self) -> list[Statement]:
        """Each input from the caller, or by the model's own expression."""
        if not self.inputs:
            return []
        place, own = self.language.place, self.writer(letter="i")
        given = tuple(Put("acting", str(k), place("inputs", at)) for k, at in enumerate(self.inputs.values()))
        lets = _lets(own, self.preamble, self.once)
        missing = (Put("acting", str(k), own.value(x)) for k, x in enumerate(self.defaults))
        lines: list[Statement] = [Array("acting", str(len(self.inputs)))]
        lines += [If(self.language.words["given"], given, (*lets, *missing))]
        for k, x in enumerate(self.inputs):
            if x in self.parts.places:
                lines += [self._stored(x, place("acting", k))]
            else:
                lines += [Let(self.names[x], place("acting", k), remark=self._remark(x))]
        return lines

    def _solved(self, writer: ExpressionWriter) -> list[Statement]:
        """Fill the arrays, solve, name the unknowns, and leave them where other functions read them."""
        solve = self.solve
        assert solve is not None
        n, k = len(solve.matrix), len(solve.border)
        filled = {
            "solve_M": {j * n + i: solve.matrix[i][j] for i in range(n) for j in range(i + 1)},
            "solve_J": {m * n + i: solve.border[m][i] for m in range(k) for i in range(n)},
            "solve_f": dict(enumerate(solve.right[:n])),
            "solve_g": dict(enumerate(solve.right[n:])),
        }
        sizes = {"solve_M": n * n, "solve_J": k * n, "solve_f": n, "solve_g": k}
        arrays = [name for name, size in sizes.items() if size]
        lines: list[Statement] = [Array(name, str(sizes[name])) for name in arrays]
        for name in arrays:
            held_there = {place: x for place, x in filled[name].items() if type(x) is Node or x != 0}
            lines += [Put(name, str(place), writer.value(x)) for place, x in held_there.items()]
        lines += [Call(_entry(solve), tuple(arrays))]
        for place, x in enumerate(solve.unknowns):
            text = self.language.place(*(("solve_f", place) if place < n else ("solve_g", place - n)))
            lines += [self._stored(x, text)] if x in self.parts.places else []
            writer.define(x, text)
        return lines

    # -- parts ------------------------------------------------------------------------------------

    @cached_property
    def parts(self) -> Parts:
        """The pieces of a long program."""
        if self.language.longest is None or len(self.moving) <= self.language.longest:
            return Parts()
        cut = len(self.before)
        before, after = _cut(self.moving[:cut]), _cut(self.moving[cut:])
        home = {x: i for i, part in enumerate(before + after) for x in part}
        home |= dict.fromkeys([*self.inputs, *(self.solve.unknowns if self.solve else ())], -1)
        reads = [(i, a) for i, part in enumerate(before + after) for a in self.reads(part)]
        reads += [(-2, x) for x in self.written]
        across = {x for i, a in reads for x in _stripped([a]) if home.get(x, i) != i}
        return Parts(before + after, len(before), {x: k for k, x in enumerate(x for x in home if x in across)})

    def _between(self, x: Node) -> str:
        return self.language.place("between", self.parts.places[x])

    def _stored(self, x: Node, value: str) -> Put:
        """A value into its place in the array between parts."""
        return Put("between", str(self.parts.places[x]), value)

    def _run(self, parts: range) -> list[Statement]:
        arguments = (*(name for name, _ in self.arguments), "c", "between")
        return [Call(f"{self.prefix}part{i}", arguments) for i in parts]

    def _part(self, i: int) -> tuple[Statement, ...]:
        """What one part computes; what is read elsewhere goes into the array."""
        nodes, places = self.parts.nodes[i], self.parts.places
        own = frozenset(nodes)
        writer = self.writer({x: self._between(x) for x in places if x not in own})
        stored = [x for x in nodes if x in places]
        lines = self._loads(_stripped(self.reads(nodes)) - places.keys())
        lines += _lets(writer, nodes, self.once - frozenset(stored))
        return (*lines, *(self._stored(x, writer.value(x)) for x in stored))


@dataclass(frozen=True)
class Parts:
    """A program cut into pieces; none where it is short.

    Args:
        nodes: of each piece.
        first: how many of them come before the solve.
        places: of what a piece reads that it does not compute, inputs and unknowns among it, its place in the array.
    """

    nodes: tuple[tuple[Node, ...], ...] = ()
    first: int = 0
    places: Mapping[Node, int] = field(default_factory=dict)


def _kernels(layout: Layout) -> tuple[tuple[Table, ...], tuple[Function, ...]]:
    """The kernels that a program calls, and the numbers that these read."""
    tables: dict[str, Table] = {}
    functions: dict[str, Function] = {}
    if layout.solve and _entry(layout.solve) not in layout.language.defined:
        read, called = kernel(_entry(layout.solve), layout.solve.tables, layout.language)
        tables |= {t.name: t for t in read}
        functions |= {f.name: f for f in called}
    for number, name in layout.sampled.items():
        own, function = _samples(sampled_of(number), name)
        _, called = kernel("through_samples", (), layout.language)
        tables |= {t.name: t for t in own}
        functions |= {f.name: f for f in (*called, function)}
    return tuple(tables.values()), tuple(functions.values())


def _samples(sampled: Sampled, name: str) -> tuple[tuple[Table, ...], Function]:
    """The tables of a function through samples, and it."""
    spline, scale = sampled.spline, math.pi**sampled.pi_power
    columns = list(zip(*spline.pieces, strict=True))
    values = [float(c) * scale for column in reversed(columns) for c in column]
    bounds, steps = list(map(float, spline.bounds)), [2**k for k in reversed(range(len(spline.bounds).bit_length()))]
    tables = (
        Table(f"{name}_steps", steps),
        Table(f"{name}_bounds", bounds, READ, sampled.name),
        Table(f"{name}_v", [*values, *map(float, spline.origins)], READ),
    )
    sizes = [str(size) for size in (len(bounds), int(spline.closed), len(steps), len(columns) - 1)]
    given = ", ".join(["t", sizes[0], sizes[1], tables[0].name, sizes[2], tables[1].name, sizes[3], tables[2].name])
    return tables, Function(name, (("t", REAL),), (Return(f"through_samples({given})"),), REAL)


def _entry(solve: Solve) -> str:
    return "solve" if solve.border else "solve_plain"


def _lets(writer: ExpressionWriter, nodes: Iterable[Node], once: frozenset[Node]) -> list[Statement]:
    return [Let(variable, text) for variable, text in writer.assignments(nodes, once)]


def _cut(nodes: tuple[Node, ...]) -> tuple[tuple[Node, ...], ...]:
    return tuple(nodes[i : i + LENGTH] for i in range(0, len(nodes), LENGTH))


def _nodes(statements: Iterable[Any]) -> tuple[Node, ...]:
    return tuple(s.node for s in statements if type(s) is Assign)


def _stripped(values: Iterable[Scalar]) -> set[Node]:
    """The nodes among values, without their signs."""
    return {x.args[0] if x.op == "neg" else x for x in values if type(x) is Node}
