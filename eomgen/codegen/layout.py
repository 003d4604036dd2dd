"""Program, Language -> Layout: what is computed where, what its text reads, and by which names.

A constant that is divided by at every call is stored as its reciprocal. A long program is cut into parts where the
language asks for it: a compiler's time grows faster than the length of one function. What one part computes and another
reads stands in an array between them.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import field
from functools import cached_property
from itertools import chain, pairwise
from typing import Any

from eomgen.codegen.expressions import ExpressionWriter, used_once
from eomgen.codegen.lowered import READ, REAL, Language, Put
from eomgen.codegen.names import identifiers
from eomgen.codegen.program import Assign, Program, Solve
from eomgen.codegen.scheduling import scheduled
from eomgen.records import dataclass
from eomgen.symbolic.expression.graph import Node, Scalar

LENGTH = 600  # operations of a part


@dataclass(frozen=True)
class Parts:
    """A program cut into pieces; none where it is short.

    Args:
        nodes: of each piece.
        counts: how many of them each stretch is cut into.
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
        """What is computed at every call before the first solve, from each to the next, and after the last."""
        statements = self.program.statements
        at = [-1, *(k for k, s in enumerate(statements) if type(s) is Solve), len(statements)]
        made = tuple(_nodes(statements[a + 1 : b]) for a, b in pairwise(at))
        return self._scheduled(made) if self.language.longest is not None and not self.is_long else made

    @property
    def is_long(self) -> bool:
        """Whether it is cut into parts."""
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
        """What the text of nodes reads, computed at every call: a reciprocal is multiplied by."""
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
        """For a body that reads the array of constants."""
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
