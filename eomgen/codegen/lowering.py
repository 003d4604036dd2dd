"""Program, Language -> Lowered: a program's functions in the small language, its scalars in the language's words.

constants(p) -> c            what the parameters alone determine, and the reciprocals that are multiplied by
evaluate(t, x, p, c, inputs) -> the outputs
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping, Sequence
from itertools import accumulate

from eomgen.codegen.expressions import ExpressionWriter
from eomgen.codegen.kernel_reader import kernel
from eomgen.codegen.layout import Layout, stripped
from eomgen.codegen.lowered import (
    CHANGED,
    GIVEN,
    PLACES,
    READ,
    REAL,
    ROOM,
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
from eomgen.codegen.program import Program
from eomgen.records import dataclass
from eomgen.symbolic.expression.graph import Node
from eomgen.symbolic.expression.splines import Sampled, sampled_of


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

    def texts(self, language: Language) -> list[str]:
        """What the language lacks and the tables, as one text; then each function."""
        heads = [language.defined[op] for op in sorted(self.ops & language.defined.keys())]
        heads += map(language.holds, self.tables)
        functions = ["\n".join(language.defines(f)) for f in (*self.kernels, *self.bodies)]
        return [*(["\n".join(heads)] if heads else []), *functions]


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
    return Lowered(program, constants, layout.ops, tables, kernels, layout.kernels, tuple(_functions(layout)))


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
    """What the parameters alone determine."""
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
    """The kernels that solve: of several systems with ties the first is preceded by the factors."""
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
    """What one part computes; what is read elsewhere goes into the array."""
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
        own, function = _samples(sampled_of(number), name)
        own_way = "through_samples" in layout.language.defined
        called = [] if own_way else kernel("through_samples", (), layout.language)[1]
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


def _lets(writer: ExpressionWriter, nodes: Iterable[Node], once: frozenset[Node]) -> list[Statement]:
    return [Let(variable, text) for variable, text in writer.assignments(nodes, once)]
