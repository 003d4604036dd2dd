"""Equations of motion -> Program: a right-hand side as a list of statements, which every target can write down.

Equations that need a linear solve carry it as one statement, `Solve`; an inverse is never formed.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from functools import cached_property
from typing import Literal

from eomgen.codegen.lowered import INT, Table
from eomgen.errors import DerivationError
from eomgen.mechanics.equations.equations_of_motion import EquationsOfMotion
from eomgen.records import dataclass
from eomgen.symbolic.expression.derivative import substituted
from eomgen.symbolic.expression.graph import Node, Scalar, is_zero
from eomgen.symbolic.expression.node import ScalarRow
from eomgen.symbolic.expression.symbols import Symbols
from eomgen.symbolic.expression.traversal import FREE, Count, order
from eomgen.symbolic.solve import factorization
from eomgen.symbolic.solve.sparsity import PlaceLists, Zeros, zeros_of, zeros_with_ties

UNROLLED_AT_MOST = 1000  # operations of a factorization written out; a dense one of n = 12 takes 914


@dataclass(frozen=True)
class Assign:
    """One node, computed from its arguments."""

    node: Node


@dataclass(frozen=True)
class Solve:
    """A linear system in the midst of a program.

    matrix a - border^T lam = right[:n],  border a = right[n:]

    Args:
        matrix: symmetric, n rows of n; positive definite where border a = 0.
        border: k rows of n; of rows that depend on others the unknowns lam are 0, and a is right all the same.
        right: n + k.
        unknowns: the symbols that stand for (a, lam) in later statements, n + k.
        alike: of each row of the border a number that those have together which share what they hold; () where none do.
    """

    matrix: tuple[ScalarRow, ...]
    border: tuple[ScalarRow, ...]
    right: ScalarRow
    unknowns: tuple[Node, ...]
    alike: tuple[int, ...] = ()

    @property
    def kind(self) -> Literal["dense", "kkt"]:
        """With closing rows "kkt", without "dense"; a small system without them is written out and is no `Solve`."""
        return "kkt" if self.border else "dense"

    @property
    def entries(self) -> ScalarRow:
        """The lower triangle of the matrix, row after row; the border, row after row; the right side."""
        lower = [self.matrix[i][j] for i in range(len(self.matrix)) for j in range(i + 1)]
        return (*lower, *(entry for row in self.border for entry in row), *self.right)

    @cached_property
    def plain(self) -> Zeros:
        """What may not be zero in the factors of the matrix."""
        return zeros_of(self.matrix, self.border)

    @property
    def zeros(self) -> tuple[Zeros, Zeros]:
        """The same of the matrix, and of matrix + border^T W border."""
        return self.plain, zeros_with_ties(self.matrix, self.border)

    @property
    def places(self) -> tuple[frozenset[int], frozenset[int]]:
        """Where the kernels read the matrix, n x n, and the border, k x n: what may not be zero in its factors."""
        n, own = len(self.matrix), self.plain
        M = {j * n + i for j, rows in enumerate(own.partners) for i in (j, *rows)}
        return frozenset(M), frozenset(m * n + i for m, row in enumerate(own.reach) for i in row)

    @property
    def tables(self) -> list[Table]:
        """The same as lists, each with where its parts begin, as codegen/kernels.py reads them."""
        ways = self.zeros
        return [
            Table("N", (len(self.matrix),), INT),
            Table("K", (len(self.border),), INT),
            *_joined("PARTNER", "FIRST", [way.partners for way in ways]),
            *_joined("REACH", "START", [way.reach for way in ways]),
            *_joined("ROW", "FROM", [way.rows for way in ways]),
            *_joined("LATER", "NEXT", [way.later for way in ways]),
            Table("ALIKE", self.alike or tuple(range(len(self.border)))),
        ]

    @property
    def operations(self) -> int:
        """L D L^T, and with a border the system of the multipliers, made and solved, and all solved once more."""
        return self.plain.operations


def _joined(name: str, begin: str, ways: Sequence[PlaceLists]) -> tuple[Table, Table]:
    """The lists of both ways as one, and where each begins; of each way where its last one ends too."""
    found: list[int] = []
    starts: list[int] = []
    for places in ways:
        for part in places:
            starts.append(len(found))
            found += part
        starts.append(len(found))
    return Table(name, found), Table(begin, starts)


ProgramStatement = Assign | Solve


@dataclass(frozen=True)
class Program:
    """A function of (t, x, p, inputs), its statements in the order in which they are run.

    Args:
        symbols: what the outputs are written in: x = (q, u), p, inputs and t are in symbols.
        defaults: the inputs' own expressions in t and parameters, used where the caller gives none.
        preamble: statements that only `defaults` need.
        hoisted: statements that depend on the parameters alone.
        statements: all others; where there are several `Solve`s, they have one matrix and one border.
        outputs: the values that the function returns.
        count: operations at every call, and hoisted (once for given parameters) apart; `defaults` are not counted.
        accelerations: a, where the caller gives them too, as to inverse dynamics.
    """

    symbols: Symbols
    defaults: ScalarRow
    preamble: tuple[Assign, ...]
    hoisted: tuple[Assign, ...]
    statements: tuple[ProgramStatement, ...]
    outputs: ScalarRow
    count: Count
    accelerations: tuple[Node, ...] = ()

    def __repr__(self) -> str:
        return f"<program: {len(self.statements)} statements>"

    @property
    def states(self) -> tuple[Node, ...]:
        """x = (q, u)"""
        return self.symbols.q + self.symbols.u

    @property
    def moving(self) -> tuple[Node, ...]:
        """What a caller gives anew at every call beside t and inputs: x, and a where it is an argument."""
        return self.states + self.accelerations


def right_hand_side(equations: EquationsOfMotion) -> Program:
    """The right-hand side dx = (N u + nu, a), by the way that takes the fewest operations.

    M a = forcing, or with closing rows  [[M, -J^T], [J, 0]] [a; lam] = [forcing; -gamma].

    Raises:
        DerivationError: the mass matrix is singular whatever the state.
    """
    return program_in_motion((*kinematic_rates(equations), *equations.symbols.a), equations)


def program_in_motion(outputs: ScalarRow, equations: EquationsOfMotion) -> Program:
    """Outputs that hold accelerations, those of the motion, by the way that takes the fewest operations.

    Args:
        outputs: expressions in the symbols of the equations, accelerations among them.
    Raises:
        DerivationError: the mass matrix is singular whatever the state.
    """
    if equations.J and not equations.friction:
        return _program(outputs, equations, bordered(equations))
    candidates = [_explicit(outputs, equations, a) for a in _explicit_accelerations(equations)]
    if not candidates or not (equations.friction or is_short(equations)):
        solve = _ordered(equations.M, (), equations.forcing, equations.symbols.a)
        if all(solve.operations < program.count.total for program in candidates):
            candidates.append(_program(outputs, equations, solve))
    return min(candidates, key=lambda program: program.count.total)


def _explicit_accelerations(equations: EquationsOfMotion) -> list[ScalarRow]:
    """a written out: as the formulation gives them, and by a factorization that is not too long."""
    found = [] if equations.accelerations is None else [equations.accelerations]
    if not equations.friction and is_short(equations):
        found.append(factorization.factor_solution(equations.M, equations.forcing))
    return found


def is_short(equations: EquationsOfMotion) -> bool:
    """Whether M is factored by operations that are written out."""
    return factorization.operation_count(equations.M) <= UNROLLED_AT_MOST


def _explicit(outputs: ScalarRow, equations: EquationsOfMotion, a: ScalarRow) -> Program:
    return _program(substituted(outputs, dict(zip(equations.symbols.a, a, strict=True))), equations)


def _program(outputs: ScalarRow, equations: EquationsOfMotion, solve: Solve | None = None) -> Program:
    return program_of(outputs, equations.symbols, inputs=equations.inputs, solve=solve)


def kinematic_rates(equations: EquationsOfMotion) -> ScalarRow:
    """q' = N u + nu"""
    u = equations.symbols.u
    rates = []
    for row, value in zip(equations.N, equations.nu, strict=True):
        for entry, speed in zip(row, u, strict=True):
            if not is_zero(entry):
                value = value + entry * speed
        rates.append(value)
    return tuple(rates)


def bordered(equations: EquationsOfMotion) -> Solve:
    """Accelerations and multipliers from one system: M a - J^T lam = forcing, J a = -gamma."""
    symbols = equations.symbols
    right = (*equations.forcing, *(-g for g in equations.gamma))
    return _ordered(equations.M, equations.J, right, symbols.a + symbols.lam, equations.alike)


def _ordered(
    M: Sequence[ScalarRow],
    J: Sequence[ScalarRow],
    right: ScalarRow,
    unknowns: tuple[Node, ...],
    alike: Sequence[int] = (),
) -> Solve:
    """The system with the accelerations in the order in which elimination fills in least: in a tree leaves first.

    The rows in that of J M^-1 J^T: loops that touch but their neighbours one after the other.
    """
    order = factorization.elimination_order(M)
    matrix = tuple(tuple(M[max(i, j)][min(i, j)] for j in order) for i in order)
    border = [tuple(row[j] for j in order) for row in J]
    reach = [frozenset(places) for places in zeros_of(matrix, border).reach]
    rows = factorization.elimination_order([[int(not one.isdisjoint(other)) for other in reach] for one in reach])
    places = [*order, *(len(M) + m for m in rows)]
    return Solve(
        matrix,
        tuple(border[m] for m in rows),
        tuple(right[i] for i in places),
        tuple(unknowns[i] for i in places),
        tuple(alike[m] for m in rows) if alike else (),
    )


def program_of(
    outputs: Sequence[Scalar],
    symbols: Symbols,
    *,
    inputs: Mapping[str, Scalar] | None = None,
    solve: Solve | None = None,
    further: Sequence[Solve] = (),
    accelerations: tuple[Node, ...] = (),
) -> Program:
    """Any outputs as a program.

    Args:
        outputs: expressions in `symbols`, and in the unknowns of `solve`.
        symbols: the arguments' names.
        inputs: the model's own expression of each input, in t and parameters.
        solve: the linear system behind a and lam, where the outputs hold these.
        further: others with its matrix and border, whose right sides may hold a and lam.
        accelerations: a, where it is an argument.
    Raises:
        DerivationError: an output holds a symbol that is none of the arguments, or an input has no expression.
    """
    outputs, solves = tuple(outputs), (*([solve] if solve else []), *further)
    needed = order([*outputs, *(x for each in solves for x in each.entries)])
    defaults = _defaults(needed, symbols, inputs or {})
    own = order(defaults)
    _refuse_strangers([*needed, *own], symbols, (*accelerations, *(x for each in solves for x in each.unknowns)))
    depth = _depths([*needed, *own], frozenset(symbols.parameters.values()))
    hoisted = [x for x in needed if depth[x] == _FIXED and x.op not in FREE]
    moving = [x for x in needed if depth[x] == _MOVING and x.op not in FREE]
    known = frozenset(hoisted)
    return Program(
        symbols=symbols,
        defaults=defaults,
        preamble=tuple(Assign(x) for x in own if _is_computed(x, depth) and x not in known),
        hoisted=tuple(map(Assign, hoisted)),
        statements=_scheduled(moving, (solves[:1], solves[1:])),
        outputs=outputs,
        count=Count(len(moving) + _solving(solves), len(hoisted)),
        accelerations=accelerations,
    )


def _solving(solves: Sequence[Solve]) -> int:
    """Operations of all: the one matrix is factored once."""
    return sum(solve.plain.more if k else solve.operations for k, solve in enumerate(solves))


def _defaults(needed: Sequence[Node], symbols: Symbols, inputs: Mapping[str, Scalar]) -> ScalarRow:
    """The inputs' own expressions; an input that nothing needs may do without."""
    used = {x.name for x in needed if x.op == "symbol"}
    silent = [name for name in symbols.inputs if name in used and name not in inputs]
    if silent:
        raise DerivationError(f"no expression for input {', '.join(map(repr, silent))}", mend="give it one in [inputs]")
    return tuple(inputs.get(name, 0) for name in symbols.inputs)


_CONSTANT, _FIXED, _MOVING = 0, 1, 2  # what a node depends on at most: exact numbers, parameters, anything


def _depths(nodes: Iterable[Node], parameters: frozenset[Node]) -> dict[Node, int]:
    """What each node depends on at most; the nodes come arguments first."""
    depth: dict[Node, int] = {}
    for x in nodes:
        if x.op == "symbol":
            depth[x] = _FIXED if x in parameters else _MOVING
            continue
        deepest = _CONSTANT
        for a in x.args:
            if type(a) is Node and depth[a] > deepest:
                deepest = depth[a]
        depth[x] = deepest
    return depth


def _is_computed(x: Node, depth: Mapping[Node, int]) -> bool:
    return x.op not in FREE and depth[x] != _CONSTANT


def _scheduled(moving: Sequence[Node], rounds: Sequence[Sequence[Solve]]) -> tuple[ProgramStatement, ...]:
    """In index order, but what the solves of a round need, then these, then the next; the rest last."""
    statements: list[ProgramStatement] = []
    done: set[Node] = set()
    for solves in rounds:
        first = frozenset(order([x for solve in solves for x in solve.entries])) - done
        statements += [*(Assign(x) for x in moving if x in first), *solves]
        done |= first
    return (*statements, *(Assign(x) for x in moving if x not in done))


def _refuse_strangers(needed: Sequence[Node], symbols: Symbols, others: Sequence[Node]) -> None:
    arguments = {symbols.t, *symbols.q, *symbols.u, *symbols.parameters.values(), *symbols.inputs.values(), *others}
    strangers = [x.name for x in needed if x.op == "symbol" and x not in arguments]
    if strangers:
        raise DerivationError(
            f"not an argument of the program: {', '.join(map(repr, strangers))}",
            mend="name a coordinate, speed, parameter or input",
        )
