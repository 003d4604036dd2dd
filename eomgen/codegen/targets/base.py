"""What a target gives: the text of a program in its language, and that text made callable."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

from eomgen.codegen.expressions import CallText, used_once
from eomgen.codegen.names import identifiers
from eomgen.codegen.program import Assign, Program, Solve
from eomgen.symbolic.expression.graph import Node, Scalar
from eomgen.symbolic.expression.traversal import order


@dataclass(frozen=True)
class Functions:
    """A program in memory.

    Args:
        constants: p, an array -> what the parameters determine, p included, in a form that only `one` reads.
        one: (t, x, constants, inputs or None) -> a new array of the outputs; x with a after it, where a is an argument.
        many: the same of n instants at once: t n, x n x states, p, inputs None or n x inputs -> n x outputs.
        address: constants -> where all of it lies in memory, for other compiled functions; None where that is nowhere.
    """

    constants: Callable[[Any], Any]
    one: Callable[..., Any]
    many: Callable[..., Any]
    address: Callable[[Any], Any] | None = None


@dataclass(frozen=True)
class TestVector:
    """A right answer: the result at (t, x, p), and a where it is an argument, by the model's own inputs or given ones.

    Args:
        result: in the order of the program's outputs.
        tolerance: of |result - given| / max(1, largest |result|).
    """

    t: float
    x: tuple[float, ...]
    p: tuple[float, ...]
    inputs: tuple[float, ...] | None
    result: tuple[float, ...]
    tolerance: float
    a: tuple[float, ...] = ()


@dataclass(frozen=True)
class Role:
    """What a program is for, and what its text is called.

    Args:
        name: of the files and the main function: NAME_rhs.
        prefix: of the other functions: NAME + prefix + _many.
        result: the array of the outputs.
        about: what it computes, one line.
    """

    name: str
    prefix: str
    result: str
    about: str

    def main(self, stem: str) -> str:
        return f"{stem}_{self.name}"

    def others(self, stem: str) -> str:
        return f"{stem}{self.prefix}"


RHS = Role("rhs", "", "dx", "dx = f(t, x, p), the equations of motion solved for the accelerations")
INVERSE = Role("inverse", "_inverse", "tau", "tau = f(t, x, a, p), the forces and torques that accelerations a take")
REACTIONS = Role("reactions", "_reactions", "out", "out = f(t, x, p), the reactions of joints and ties in the motion")


@dataclass(frozen=True)
class Description:
    """What emitted files say about themselves.

    Args:
        title: the model's name.
        origin: who made the file from what, one line.
        remarks: of the name of an argument or output: its unit and what it is.
        vectors: right answers, for the self-test.
        role: what the program is for.
        outputs: names of the outputs, () where they are in the order of x.
    """

    title: str
    origin: str
    remarks: Mapping[str, str]
    vectors: tuple[TestVector, ...] = ()
    role: Role = RHS
    outputs: tuple[str, ...] = ()


Called = Callable[[float, Sequence[float], Sequence[float], Sequence[float], Sequence[float] | None], Sequence[float]]
"""(t, x, a, p, inputs or None) -> the outputs; a is () where it is no argument."""


@dataclass(frozen=True)
class Target:
    """A language that programs are written in.

    Args:
        name: as the user says it.
        about: the language, and what its files need.
        text: (program, stem, role) -> its functions in the language.
        files: (program, stem, description) -> {file name: text}, ready to be used by others.
        load: the program, callable.
        run: (those files, program, stem, role) -> (t, x, a, p, inputs or None) -> outputs: the very text that others
            get, run here; None where nothing here runs the language.
    """

    name: str
    about: str
    text: Callable[[Program, str, Role], str]
    files: Callable[[Program, str, Description], dict[str, str]]
    load: Callable[[Program], Functions]
    run: Callable[[Mapping[str, str], Program, str, Role], Called] | None = None


@dataclass(frozen=True)
class Layout:
    """A program cut into function bodies, with the names that its text uses.

    Args:
        names: identifier of each symbol.
        kept: hoisted nodes that the later bodies read, in the order of the array of constants.
        once: nodes written where they are used.
        before, solve, after: the statements around the solve (None: everything is in `before`).
        sampled: the functions through samples that are called, samples1 first, by their number in the graph.
        ops: the operations that the text takes.
    """

    program: Program
    names: dict[Node, str]
    kept: tuple[Node, ...]
    once: frozenset[Node]
    before: tuple[Node, ...]
    solve: Solve | None
    after: tuple[Node, ...]
    sampled: dict[int, str]
    ops: frozenset[str]

    def calls(self, call: CallText) -> CallText:
        """How functions are called, those through samples by their names here."""
        return lambda op, arguments: call(*self._called(op, arguments))

    def _called(self, op: str, arguments: list[str]) -> tuple[str, list[str]]:
        return (self.sampled[int(float(arguments[1]))], arguments[:1]) if op == "sampled" else (op, arguments)

    def loads(self, symbols: Sequence[Node], used: frozenset[Node]) -> list[tuple[int, Node]]:
        """(place, symbol) of those arguments that are used."""
        return [(place, symbol) for place, symbol in enumerate(symbols) if symbol in used]


def layout(program: Program) -> Layout:
    """The bodies of a program: constants from parameters, the inputs' own values, and the rest."""
    symbols = program.symbols
    arguments = [*program.moving, *symbols.parameters.values(), *symbols.inputs.values()]
    solve = next((s for s in program.statements if type(s) is Solve), None)
    unknowns = [x for x in (solve.unknowns if solve else ()) if x not in arguments]
    arrays = ("a", "tau") if program.accelerations else ()
    words = identifiers([x.name for x in [*arguments, *unknowns]], arrays)
    names = {x: words[x.name] for x in [*arguments, *unknowns]} | {symbols.t: "t"}
    cut = program.statements.index(solve) if solve else len(program.statements)
    before, after = _nodes(program.statements[:cut]), _nodes(program.statements[cut + 1 :])
    written = (*(solve.entries if solve else ()), *program.outputs)
    preamble, hoisted = _nodes(program.preamble), _nodes(program.hoisted)
    read = _read([*before, *after, *preamble], [*written, *program.defaults])
    kept = tuple(x for x in hoisted if x in read)
    once = used_once([(hoisted, ()), (before + after, written), (preamble, program.defaults)])
    once |= frozenset(kept) - _read(hoisted, ())  # stored where they are computed
    acts = any(x in used_symbols(written, kept) for x in symbols.inputs.values())
    computed = (*hoisted, *(preamble if acts else ()), *before, *after)
    numbers = dict.fromkeys(x.args[1] for x in computed if x.op == "sampled")
    sampled = {number: f"samples{place}" for place, number in enumerate(numbers, start=1)}
    ops = frozenset(x.op for x in computed)
    return Layout(program, names, kept, once, before, solve, after, sampled, ops)


def used_symbols(values: Sequence[Scalar], stop: Sequence[Node]) -> frozenset[Node]:
    """The symbols from which values are computed; what is in `stop` was computed elsewhere."""
    return frozenset(x for x in order(values, frozenset(stop)) if x.op == "symbol")


def _nodes(statements: Sequence[Any]) -> tuple[Node, ...]:
    return tuple(s.node for s in statements if type(s) is Assign)


def _read(nodes: Sequence[Node], values: Sequence[Scalar]) -> frozenset[Node]:
    """What is read by the nodes and values themselves, signs looked through."""
    found = [*(a for node in nodes for a in node.args), *values]
    return frozenset(x.args[0] if x.op == "neg" else x for x in found if type(x) is Node)


def header(program: Program, description: Description) -> list[str]:
    """Title, origin, and the order of x, p, inputs and named outputs, a line each."""
    symbols, result = program.symbols, description.role.result
    lines = [f"{description.title}: {description.role.about}", ""]
    lines += [description.origin, ""]
    groups = {
        "x": program.states,
        "a": program.accelerations,
        "p": symbols.parameters.values(),
        "inputs": symbols.inputs.values(),
    }
    for array, members in groups.items():
        for place, x in enumerate(members):
            remark = description.remarks.get(x.name, "")
            lines.append(f"    {array}[{place}]  {x.name}{'  ' + remark if remark else ''}")
    for place, name in enumerate(description.outputs):
        lines.append(f"    {result}[{place}]  {name}  {description.remarks.get(name, '')}".rstrip())
    if not description.outputs:
        lines.append(f"    {result}  {len(program.outputs)} values, in the order of x")
    return [" ".join(line.split("\n")) for line in lines]
