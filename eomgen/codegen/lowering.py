"""Program, Language -> a program's functions in the small language, its scalars in the language's own text.

Program, Language -> Lowered: a program's functions as statements, its scalars in the text of the language.

constants(p) -> c            what the parameters alone determine, and the reciprocals that are multiplied by
evaluate(t, x, p, c, inputs) -> the outputs
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import field
from functools import cached_property
from itertools import accumulate, chain, pairwise
from typing import Any

from eomgen.codegen.kernel_reader import kernel
from eomgen.codegen.program import Assign, Program, Solve, identifiers, scheduled
from eomgen.codegen.statements import (
    CHANGED,
    GIVEN,
    PLACES,
    READ,
    REAL,
    ROOM,
    Array,
    Call,
    ExpressionWriter,
    Function,
    If,
    Language,
    Let,
    Put,
    Return,
    Statement,
    Table,
    used_once,
)
from eomgen.frozen import dataclass
from eomgen.symbolic.expression import Node, Sampled, Scalar


@dataclass(frozen=True)
class Statements:
    """A program in the small language.

    Args:
        constants: the number of results of the first function.
        ops: the operations that the text takes.
        tables, kernels: functions with loops that the bodies call, and the numbers that these read.
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

    def texts(self, language: Language) -> list[str]:
        """Texts of the operations that the language lacks and of the tables, in one; then of each function."""
        heads = [language.defined[op] for op in sorted(self.ops & language.defined.keys())]
        heads += map(language.holds, self.tables)
        functions = ["\n".join(language.defines(f)) for f in (*self.kernels, *self.bodies)]
        return [*(["\n".join(heads)] if heads else []), *functions]


def statements(
    program: Program, language: Language, result: str, prefix: str = "", remarks: Mapping[str, str] | None = None
) -> Statements:
    """The functions of a program.

    Args:
        result: the name of the array of the outputs.
        prefix: of the functions' names.
        remarks: of an argument's name: its unit and what it is.
    """
    layout = Layout(program, language, result, prefix, remarks or {})
    tables, kernels = _kernels(layout)
    constants = len(layout.kept) + len(layout.inverted)
    return Statements(program, constants, layout.ops, tables, kernels, layout.kernels, tuple(_functions(layout)))


def _functions(layout: Layout) -> list[Function]:
    takes, size = (*layout.arguments, ("c", READ)), len(layout.kept) + len(layout.inverted)
    constants = Function(f"{layout.prefix}constants", (("p", READ),), _constants(layout), out=("c", size))
    pieces = range(len(layout.parts.nodes))
    cut = [
        Function(f"{layout.prefix}part{i}", (*takes, ("between", CHANGED)), _part(layout, i), apart=True)
        for i in pieces
    ]
    given, out = (*takes, ("inputs", GIVEN)), (layout.result, len(layout.program.outputs))
    return [constants, *cut, Function(f"{layout.prefix}evaluate", given, _evaluate(layout), out=out)]


def _constants(layout: Layout) -> tuple[Statement, ...]:
    """Statements for the constants that the parameters alone determine."""
    writer = ExpressionWriter(layout.called, layout.language.number, layout.names, {}, "v")
    read = stripped([*(a for x in layout.hoisted for a in x.args), *layout.inverted])
    lines: list[Statement] = [*_loads(layout, read), *_lets(writer, layout.hoisted, layout.once)]
    lines += [Put("c", str(k), writer.value(x)) for k, x in enumerate(layout.kept)]
    one = writer.value(1)
    lines += [Put("c", str(len(layout.kept) + k), f"{one}/{writer.factor(x)}") for k, x in enumerate(layout.inverted)]
    return tuple(lines)


def _evaluate(layout: Layout) -> tuple[Statement, ...]:
    """Everything else."""
    parts = layout.parts
    writer = layout.writer({x: layout.between(x) for x in parts.places})
    nodes = layout.preamble if parts.nodes else (*layout.moving, *layout.preamble)
    read = stripped([*layout.reads(nodes), *layout.written, *layout.defaults])
    lines: list[Statement] = _loads(layout, read)
    lines += [Array("between", str(len(parts.places)))] if parts.nodes else []
    lines += _inputs(layout)
    ends = [0, *accumulate(parts.counts or [0] * len(layout.stretches))]
    for k, nodes in enumerate(layout.stretches):
        lines += _solved(layout, writer, k - 1) if k else []
        lines += _computed(layout, writer, nodes, range(ends[k], ends[k + 1]))
    return (*lines, *(Put(layout.result, str(k), writer.value(x)) for k, x in enumerate(layout.program.outputs)))


def _loads(layout: Layout, read: set[Node]) -> list[Statement]:
    """A name for each argument that is read."""
    program = layout.program
    arrays = {"x": program.states, "a": program.accelerations, "p": tuple(program.symbols.parameters.values())}
    return [
        Let(layout.names[x], layout.language.place(array, place), remark=_remark(layout, x))
        for array, symbols in arrays.items()
        for place, x in enumerate(symbols)
        if x in read
    ]


def _remark(layout: Layout, x: Node) -> str:
    text, word = layout.remarks.get(x.name, ""), layout.names[x]
    return f"{x.name}: {text}" if text and x.name != word else text or (x.name if x.name != word else "")


def _inputs(layout: Layout) -> list[Statement]:
    """Each input from the caller, or by the model's own expression."""
    if not layout.inputs:
        return []
    place, own = layout.language.place, layout.writer(letter="i")
    given = tuple(Put("acting", str(k), place("inputs", at)) for k, at in enumerate(layout.inputs.values()))
    lets = _lets(own, layout.preamble, layout.once)
    missing = (Put("acting", str(k), own.value(x)) for k, x in enumerate(layout.defaults))
    lines: list[Statement] = [Array("acting", str(len(layout.inputs)))]
    lines += [If(layout.language.words["given"], given, (*lets, *missing))]
    for k, x in enumerate(layout.inputs):
        if x in layout.parts.places:
            lines += [layout.stored(x, place("acting", k))]
        else:
            lines += [Let(layout.names[x], place("acting", k), remark=_remark(layout, x))]
    return lines


def _solved(layout: Layout, writer: ExpressionWriter, number: int) -> list[Statement]:
    """Fill the arrays, solve, name the unknowns, and leave them where other functions read them.

    Matrix and border are filled, and factored, once.
    """
    solve, later = layout.solves[number], str(number) * (number > 0)
    n, k = len(solve.matrix), len(solve.border)
    f, g = f"solve_f{later}", f"solve_g{later}"
    filled = {
        "solve_M": {j * n + i: solve.matrix[i][j] for i in range(n) for j in range(i + 1)},
        "solve_J": {m * n + i: solve.border[m][i] for m in range(k) for i in range(n)},
        f: dict(enumerate(solve.right[:n])),
        g: dict(enumerate(solve.right[n:])),
    }
    sizes = {"solve_M": n * n, "solve_J": k * n, f: n, g: k}
    arrays = [name for name, size in sizes.items() if size]
    new = [name for name in arrays if not number or name in (f, g)]
    own_way = layout.solvers[0] in layout.language.defined
    read = {} if own_way else dict(zip(("solve_M", "solve_J"), solve.places, strict=True))
    lines: list[Statement] = [Array(name, str(sizes[name]), ROOM if name in read else CHANGED) for name in new]
    for name in new:
        said = {at: x for at, x in filled[name].items() if type(x) is Node or x != 0 or at in read.get(name, ())}
        lines += [Put(name, str(place), writer.value(x)) for place, x in said.items()]
    lines += _calls(layout, arrays, number, n, k)
    for place, x in enumerate(solve.unknowns):
        text = layout.language.place(*((f, place) if place < n else (g, place - n)))
        lines += [layout.stored(x, text)] if x in layout.parts.places else []
        writer.define(x, text)
    return lines


def _calls(layout: Layout, arrays: list[str], number: int, n: int, k: int) -> list[Statement]:
    """The kernels that solve: of several systems with constraints the first is preceded by the factors."""
    matrix, right = arrays[: 1 + bool(k)], arrays[1 + bool(k) :]
    if layout.solvers[0] != "solve_factors":
        entry = layout.solvers[min(number, len(layout.solvers) - 1)]
        return [Call(entry, tuple(arrays), tuple(arrays if entry == "solve_plain" else right))]
    sizes = {"L": n * n, "weight": k, "mobility": n, "Y": k * n, "S": k * k, "order": k + 3}
    factors = [f"solve_{name}" for name in sizes]
    lines: list[Statement] = []
    if not number:
        kinds = [*[ROOM] * (len(sizes) - 1), PLACES]
        lines += [Array(name, str(size), kind) for name, size, kind in zip(factors, sizes.values(), kinds, strict=True)]
        lines += [Call("solve_factors", (*matrix, *factors), tuple(factors))]
    return [*lines, Call("solve_by", (*matrix, *factors, *right), ("solve_order", *right))]


def _computed(layout: Layout, writer: ExpressionWriter, nodes: tuple[Node, ...], parts: range) -> Sequence[Statement]:
    """Nodes one after the other, or by the parts that they were cut into."""
    if not layout.parts.nodes:
        return _lets(writer, nodes, layout.once)
    arguments = (*(name for name, _ in layout.arguments), "c", "between")
    return [Call(f"{layout.prefix}part{i}", arguments, ("between",)) for i in parts]


def _part(layout: Layout, i: int) -> tuple[Statement, ...]:
    """Statements of one part; values that other parts read go into the array."""
    nodes, places = layout.parts.nodes[i], layout.parts.places
    own = frozenset(nodes)
    writer = layout.writer({x: layout.between(x) for x in places if x not in own})
    stored = [x for x in nodes if x in places]
    lines = _loads(layout, stripped(layout.reads(nodes)) - places.keys())
    lines += _lets(writer, nodes, layout.once - frozenset(stored))
    return (*lines, *(layout.stored(x, writer.value(x)) for x in stored))


def _kernels(layout: Layout) -> tuple[tuple[Table, ...], tuple[Function, ...]]:
    """The kernels that a program calls, and the numbers that these read."""
    tables: dict[str, Table] = {}
    functions: dict[str, Function] = {}
    for entry in layout.solvers:
        if entry in layout.language.defined:
            continue
        read, called = kernel(entry, layout.solves[0].tables, layout.language)
        tables |= {t.name: t for t in read}
        functions |= {f.name: f for f in called}
    for number, name in layout.sampled.items():
        own, function = _samples(Sampled.of(number), name)
        own_way = "through_samples" in layout.language.defined
        called = [] if own_way else kernel("through_samples", (), layout.language)[1]
        tables |= {t.name: t for t in own}
        functions |= {f.name: f for f in (*called, function)}
    return tuple(tables.values()), tuple(functions.values())


def _samples(sampled: Sampled, name: str) -> tuple[tuple[Table, ...], Function]:
    """The tables of a function through samples, and it."""
    spline, scale = sampled.spline, math.pi**sampled.pi_power
    columns = list(zip(*spline.pieces, strict=True))
    measure = float(sampled.measured(1.0, math.pi, float))
    values = [float(c) * measure**k * scale for k, column in reversed([*enumerate(columns)]) for c in column]
    bounds = list(sampled.ends(math.pi, float))
    steps = [2**k for k in reversed(range(len(spline.bounds).bit_length()))]
    tables = (
        Table(f"{name}_steps", steps),
        Table(f"{name}_bounds", bounds, READ, sampled.name),
        Table(f"{name}_v", [*values, *(float(x) / measure for x in spline.origins)], READ),
    )
    sizes = [str(size) for size in (len(bounds), int(spline.closed), len(steps), len(columns) - 1)]
    given = ", ".join(["t", sizes[0], sizes[1], tables[0].name, sizes[2], tables[1].name, sizes[3], tables[2].name])
    return tables, Function(name, (("t", REAL),), (Return(f"through_samples({given})"),), REAL)


def _lets(writer: ExpressionWriter, nodes: Iterable[Node], once: frozenset[Node]) -> list[Statement]:
    return [Let(variable, text) for variable, text in writer.assignments(nodes, once)]


# -------- layout ----------------------------------------------------------------------------------------------
# Program, Language -> Layout: what is computed where, what its text reads, and by which names.
#
# A constant that is divided by at every call is stored as its reciprocal. A long program is cut into parts where the
# language sets a limit: a compiler's time grows faster than the length of one function. What one part computes and
# another reads stands in an array between them.


LENGTH = 600  # operations of a part


@dataclass(frozen=True)
class Parts:
    """A program cut into pieces; none where it is short.

    Args:
        nodes: of each piece.
        counts: the number of parts of each stretch.
        places: of what a piece reads that it does not compute, inputs and unknowns among it, its place in the array.
    """

    nodes: tuple[tuple[Node, ...], ...] = ()
    counts: tuple[int, ...] = ()
    places: Mapping[Node, int] = field(default_factory=dict)


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
    def solves(self) -> tuple[Solve, ...]:
        return tuple(s for s in self.program.statements if type(s) is Solve)

    @property
    def solvers(self) -> tuple[str, ...]:
        """The kernels that solve: all at once, or what factors the one matrix of several solves and what goes on."""
        if not self.solves:
            return ()
        first, more = ("solve_factors", "solve_by") if self.solves[0].border else ("solve_plain", "solve_plain_by")
        return (first, more) if len(self.solves) > 1 else ("solve" if self.solves[0].border else first,)

    @cached_property
    def stretches(self) -> tuple[tuple[Node, ...], ...]:
        """Nodes that are computed at every call before the first solve, from each to the next, and after the last."""
        statements = self.program.statements
        at = [-1, *(k for k, s in enumerate(statements) if type(s) is Solve), len(statements)]
        made = tuple(_nodes(statements[a + 1 : b]) for a, b in pairwise(at))
        return self._scheduled(made) if self.language.longest is not None and not self.is_long else made

    @property
    def is_long(self) -> bool:
        """True if the program is cut into parts."""
        return self.language.longest is not None and len(self.moving) > self.language.longest

    def _scheduled(self, stretches: Sequence[tuple[Node, ...]]) -> tuple[tuple[Node, ...], ...]:
        """The nodes of each so that few values leave the registers; what gets no name goes with what uses it."""
        writer, found = self.writer(), []
        for k, stretch in enumerate(stretches):
            named: dict[Node, list[Node]] = {}
            unnamed: dict[Node, list[Node]] = {}
            for x in stretch:
                own = [y for a in x.args if type(a) is Node for y in unnamed.pop(unsigned(a), ())]
                (named if writer.assignments([x], self.once) else unnamed)[x] = [*own, x]
            needs = {x: stripped(a for y in group for a in y.args) for x, group in named.items()}
            later = chain(*unnamed.values(), *stretches[k + 1 :])
            read = stripped([*self.written, *(a for y in later for a in y.args)])
            found.append((*(y for x in scheduled(needs, read) for y in named[x]), *chain(*unnamed.values())))
        return tuple(found)

    @cached_property
    def moving(self) -> tuple[Node, ...]:
        return _nodes(self.program.statements)

    @cached_property
    def written(self) -> tuple[Scalar, ...]:
        solved = (x for k, s in enumerate(self.solves) for x in (s.right if k else s.entries))
        return (*solved, *self.program.outputs)

    @property
    def unknowns(self) -> tuple[Node, ...]:
        return tuple(x for solve in self.solves for x in solve.unknowns)

    @cached_property
    def inputs(self) -> dict[Node, int]:
        """The inputs that are read, and their places."""
        read = stripped([*(a for x in self.moving for a in x.args), *self.written])
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
        """Scalars that the text of nodes reads at every call; a stored reciprocal takes the place of its divisor."""
        return [a for x in nodes for a in (x.args[:1] if x.op == "div" and x.args[1] in self.inverted else x.args)]

    @cached_property
    def kept(self) -> tuple[Node, ...]:
        """The constants that are read at every call, in their order in the array; the reciprocals follow."""
        read = stripped([*self.reads((*self.moving, *self.preamble)), *self.written, *self.defaults])
        return tuple(x for x in self.hoisted if x in read)

    @cached_property
    def once(self) -> frozenset[Node]:
        """Nodes written where they are used; a constant that only its place reads, there."""
        first = [*(a for x in self.hoisted for a in x.args), *self.inverted]
        moving, own = [*self.reads(self.moving), *self.written], [*self.reads(self.preamble), *self.defaults]
        single = used_once([(self.hoisted, first), (self.moving, moving), (self.preamble, own)])
        return single | (frozenset(self.kept) - stripped(first))

    @cached_property
    def ops(self) -> frozenset[str]:
        return frozenset((*(x.op for x in (*self.hoisted, *self.preamble, *self.moving)), *self.called_kernels))

    @cached_property
    def kernels(self) -> tuple[str, ...]:
        return (*self.solvers, *self.sampled.values())

    @cached_property
    def called_kernels(self) -> frozenset[str]:
        """The kernels among the ops, by the names that a language may define in its own way."""
        return frozenset((*self.solvers, *(["through_samples"] if self.sampled else [])))

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
        known += [x for x in self.unknowns if x not in known]
        taken = {*self.language.reserved, *(name for name, _ in self.arguments), self.result}
        words = identifiers([x.name for x in known], taken, self.language.folded)
        return {x: words[x.name] for x in known} | {symbols.t: "t"}

    @cached_property
    def arguments(self) -> tuple[tuple[str, str], ...]:
        a = [("a", READ)] if self.program.accelerations else []
        return (("t", REAL), ("x", READ), *a, ("p", READ))

    def writer(self, more: Mapping[Node, str] | None = None, letter: str = "v") -> ExpressionWriter:
        """Writer of expressions for a body that reads the array of constants."""
        kept = {x: self.language.place("c", k) for k, x in enumerate(self.kept)}
        inverse = {x: self.language.place("c", len(kept) + k) for k, x in enumerate(self.inverted)}
        return ExpressionWriter(
            self.called, self.language.number, {**self.names, **kept, **(more or {})}, inverse, letter
        )

    def called(self, op: str, arguments: list[str]) -> str:
        if op == "sampled":
            return f"{self.sampled[int(arguments[1])]}({arguments[0]})"
        return self.language.called(op, arguments)

    # -- parts ------------------------------------------------------------------------------------

    @cached_property
    def parts(self) -> Parts:
        """The pieces of a long program."""
        if not self.is_long:
            return Parts()
        cuts = [_cut(stretch) for stretch in self.stretches]
        parts = tuple(part for cut in cuts for part in cut)
        home = {x: i for i, part in enumerate(parts) for x in part}
        home |= dict.fromkeys([*self.inputs, *self.unknowns], -1)
        reads = [(i, a) for i, part in enumerate(parts) for a in self.reads(part)]
        reads += [(-2, x) for x in self.written]
        across = {x for i, a in reads for x in stripped([a]) if home.get(x, i) != i}
        return Parts(parts, tuple(map(len, cuts)), {x: k for k, x in enumerate(x for x in home if x in across)})

    def between(self, x: Node) -> str:
        return self.language.place("between", self.parts.places[x])

    def stored(self, x: Node, value: str) -> Put:
        """A value into its place in the array between parts."""
        return Put("between", str(self.parts.places[x]), value)


def _cut(nodes: tuple[Node, ...]) -> tuple[tuple[Node, ...], ...]:
    return tuple(nodes[i : i + LENGTH] for i in range(0, len(nodes), LENGTH))


def _nodes(statements: Iterable[Any]) -> tuple[Node, ...]:
    return tuple(s.node for s in statements if type(s) is Assign)


def stripped(values: Iterable[Scalar]) -> set[Node]:
    """The nodes among values, without their signs."""
    return {unsigned(x) for x in values if type(x) is Node}


def unsigned(x: Node) -> Node:
    """x of -x."""
    bare: Node = x.args[0] if x.op == "neg" else x
    return bare
