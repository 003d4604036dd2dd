"""Equations of motion -> Program: a right-hand side as a list of statements, which every language prints.

Equations of motion -> Program: a right-hand side as a list of statements, which every target can write down.

Equations that need a linear solve carry it as one statement, `Solve`; an inverse is never formed.
"""

from __future__ import annotations

import re
import unicodedata
from collections.abc import Callable, Container, Iterable, Mapping, Sequence, Set
from functools import cached_property
from heapq import heapify, heappop, heappush
from typing import Any, Literal

import numpy as np

from eomgen.codegen.statements import INT, Table
from eomgen.errors import DerivationError
from eomgen.frozen import dataclass
from eomgen.mechanics.dynamics import EquationsOfMotion
from eomgen.symbolic.exact import Zeros, factorization
from eomgen.symbolic.expression import Count, Node, Scalar, ScalarRow, Symbols, order, substituted

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
        """Kind of the system: "kkt" with constraint rows, "dense" without; a small one without them is no `Solve`."""
        return "kkt" if self.border else "dense"

    @property
    def entries(self) -> ScalarRow:
        """The lower triangle of the matrix, row after row; the border, row after row; the right side."""
        lower = [self.matrix[i][j] for i in range(len(self.matrix)) for j in range(i + 1)]
        return (*lower, *(entry for row in self.border for entry in row), *self.right)

    @cached_property
    def plain(self) -> Zeros:
        """Entries that may not be zero in the factors of the matrix."""
        return Zeros.of(self.matrix, self.border)

    @property
    def zeros(self) -> tuple[Zeros, Zeros]:
        """The same of the matrix, and of matrix + border^T W border."""
        return self.plain, Zeros.with_constraints(self.matrix, self.border)

    @property
    def places(self) -> tuple[frozenset[int], frozenset[int]]:
        """Places at which the kernels read the matrix, n x n, and the border, k x n: those not zero in its factors."""
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

    @classmethod
    def bordered(cls, equations: EquationsOfMotion) -> Solve:
        """Accelerations and multipliers from one system: M a - J^T lam = forcing, J a = -gamma."""
        symbols = equations.symbols
        right = (*equations.forcing, *(-g for g in equations.gamma))
        return _ordered(equations.M, equations.J, right, symbols.a + symbols.lam, equations.alike)


def _joined(name: str, begin: str, ways: Sequence[tuple[tuple[int, ...], ...]]) -> tuple[Table, Table]:
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
        symbols: the symbols of the outputs: x = (q, u, z), p, inputs and t are in symbols.
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
        """x = (q, u, z)"""
        return self.symbols.x

    @property
    def moving(self) -> tuple[Node, ...]:
        """Arguments that change at every call in addition to t and inputs: x, and a where it is an argument."""
        return self.states + self.accelerations

    @property
    def unit_quaternions(self) -> QuaternionPlaces:
        """Places of the four numbers of every quaternion among the states."""
        place = {node: k for k, node in enumerate(self.states)}
        unit_quaternions = self.symbols.graph.unit_quaternions
        return QuaternionPlaces(
            tuple(place[x] for x in symbols) for symbols in unit_quaternions if all(x in place for x in symbols)
        )

    @classmethod
    def of(
        cls,
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
        hoisted = [x for x in needed if depth[x] == _FIXED and x.op not in Count.FREE]
        moving = [x for x in needed if depth[x] == _MOVING and x.op not in Count.FREE]
        known = frozenset(hoisted)
        return cls(
            symbols=symbols,
            defaults=defaults,
            preamble=tuple(Assign(x) for x in own if _is_computed(x, depth) and x not in known),
            hoisted=tuple(map(Assign, hoisted)),
            statements=_scheduled(moving, (solves[:1], solves[1:])),
            outputs=outputs,
            count=Count(len(moving) + _solving(solves), len(hoisted)),
            accelerations=accelerations,
        )

    @classmethod
    def right_hand_side(cls, equations: EquationsOfMotion) -> Program:
        """The right-hand side dx = (N u + nu, a, z'), by the way that takes the fewest operations.

        M a = forcing, or with constraint rows  [[M, -J^T], [J, 0]] [a; lam] = [forcing; -gamma].

        Raises:
            DerivationError: the mass matrix is singular at all states.
        """
        outputs = (*equations.kinematic_rates, *equations.symbols.a, *equations.state_rates)
        return Program.in_motion(outputs, equations)

    @classmethod
    def in_motion(cls, outputs: ScalarRow, equations: EquationsOfMotion) -> Program:
        """Outputs that hold accelerations, those of the motion, by the way that takes the fewest operations.

        Args:
            outputs: expressions in the symbols of the equations, accelerations among them.
        Raises:
            DerivationError: the mass matrix is singular at all states.
        """
        if equations.J and not equations.friction:
            return _program(outputs, equations, Solve.bordered(equations))
        candidates = [_explicit(outputs, equations, a) for a in _explicit_accelerations(equations)]
        if not candidates or not (equations.friction or Program.unrolls(equations)):
            solve = _ordered(equations.M, (), equations.forcing, equations.symbols.a)
            if all(solve.operations < program.count.total for program in candidates):
                candidates.append(_program(outputs, equations, solve))
        return min(candidates, key=lambda program: program.count.total)

    @staticmethod
    def unrolls(equations: EquationsOfMotion) -> bool:
        """True if M is factored by operations that are written out."""
        return factorization.operation_count(equations.M) <= UNROLLED_AT_MOST


def _explicit_accelerations(equations: EquationsOfMotion) -> list[ScalarRow]:
    """a written out: as the formulation gives them, and by a factorization that is not too long."""
    found = [] if equations.accelerations is None else [equations.accelerations]
    if not equations.friction and Program.unrolls(equations):
        found.append(factorization.factor_solution(equations.M, equations.forcing))
    return found


def _explicit(outputs: ScalarRow, equations: EquationsOfMotion, a: ScalarRow) -> Program:
    return _program(substituted(outputs, dict(zip(equations.symbols.a, a, strict=True))), equations)


def _program(outputs: ScalarRow, equations: EquationsOfMotion, solve: Solve | None = None) -> Program:
    return Program.of(outputs, equations.symbols, inputs=equations.inputs, solve=solve)


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
    reach = [frozenset(places) for places in Zeros.of(matrix, border).reach]
    rows = factorization.elimination_order([[int(not one.isdisjoint(other)) for other in reach] for one in reach])
    places = [*order, *(len(M) + m for m in rows)]
    return Solve(
        matrix,
        tuple(border[m] for m in rows),
        tuple(right[i] for i in places),
        tuple(unknowns[i] for i in places),
        tuple(alike[m] for m in rows) if alike else (),
    )


def _solving(solves: Sequence[Solve]) -> int:
    """Operations of all: the one matrix is factored once."""
    return sum(solve.plain.more if k else solve.operations for k, solve in enumerate(solves))


def _defaults(needed: Sequence[Node], symbols: Symbols, inputs: Mapping[str, Scalar]) -> ScalarRow:
    """The inputs' own expressions; an input that nothing needs may do without."""
    used = {x.name for x in needed if x.op == "symbol"}
    silent = [name for name in symbols.inputs if name in used and name not in inputs]
    if silent:
        raise DerivationError(f"no expression for input {', '.join(map(repr, silent))}", fix="give it one in [inputs]")
    return tuple(inputs.get(name, 0) for name in symbols.inputs)


_CONSTANT, _FIXED, _MOVING = 0, 1, 2  # what a node depends on at most: exact numbers, parameters, anything


def _depths(nodes: Iterable[Node], parameters: frozenset[Node]) -> dict[Node, int]:
    """Depth of each node: constant, of parameters alone, or moving; the nodes come arguments first."""
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
    return x.op not in Count.FREE and depth[x] != _CONSTANT


def _scheduled(moving: Sequence[Node], rounds: Sequence[Sequence[Solve]]) -> tuple[ProgramStatement, ...]:
    """Statements in index order, but for each round of solves the nodes that it needs come first; the rest last."""
    statements: list[ProgramStatement] = []
    done: set[Node] = set()
    for solves in rounds:
        first = frozenset(order([x for solve in solves for x in solve.entries])) - done
        statements += [*(Assign(x) for x in moving if x in first), *solves]
        done |= first
    return (*statements, *(Assign(x) for x in moving if x not in done))


def _refuse_strangers(needed: Sequence[Node], symbols: Symbols, others: Sequence[Node]) -> None:
    arguments = {symbols.t, *symbols.x, *symbols.parameters.values(), *symbols.inputs.values(), *others}
    strangers = [x.name for x in needed if x.op == "symbol" and x not in arguments]
    if strangers:
        raise DerivationError(
            f"not an argument of the program: {', '.join(map(repr, strangers))}",
            fix="name a coordinate, speed, parameter or input",
        )


# -------- scheduling ------------------------------------------------------------------------------------------
# Statements in the order of their making -> the same in one in which fewer values leave the registers.
#
# A long straight program has far more values that wait than a machine has registers: most are stored and loaded
# again. Here a statement comes soon after the newest of its arguments; before them comes what calls functions, with
# what these need, for no value stays in a register across a call. How much the place of the arguments weighs against
# the order of making is tried, and how often values go to memory and back is counted: of all orders the best is
# taken, that of making among them. What is computed is the same, bit for bit.


REGISTERS = 14  # of sixteen, two for what is under way
WEIGHTS = (0.0, 0.25, 0.5)  # of the order of making
INSTRUCTIONS = frozenset("symbol add sub mul div sqrt abs min max less less_equal select".split())  # others are calls

Needs = Mapping[Node, Set[Node]]


def scheduled(needs: Needs, later: Set[Node]) -> Sequence[Node]:
    """The statements in the order that takes the fewest loads and stores.

    Args:
        needs: of each statement the statements and symbols that it reads, in the order of their making.
        later: nodes that are read after them.
    """
    symbols = {a for needed in needs.values() for a in needed if a.op == "symbol"}
    made = {x: set[Node]() for x in sorted(symbols, key=lambda x: x.index)} | {
        x: {a for a in needed if a in needs or a in symbols} for x, needed in needs.items()
    }
    orders = [list(made), *(_close_together(made, of, weight) for of in (_mean, max) for weight in WEIGHTS)]
    best = min(orders, key=lambda order: traffic(order, made, later))
    return [x for x in best if x in needs]


def _users(needs: Needs) -> dict[Node, list[Node]]:
    """{statement: the statements that read it}."""
    found: dict[Node, list[Node]] = {x: [] for x in needs}
    for x, needed in needs.items():
        for a in needed:
            found[a].append(x)
    return found


def _mean(places: Sequence[int]) -> float:
    return sum(places) / len(places)


def _close_together(needs: Needs, of: Callable[[Sequence[int]], float], weight: float) -> list[Node]:
    """Order of the statements: arguments of calls first, then each soon after the newest of its arguments.

    Args:
        of: places of the arguments -> one place that stands for them.
    """
    rank, early = {x: k for k, x in enumerate(needs)}, set[Node]()
    for x in reversed(list(needs)):
        if x in early or x.op not in INSTRUCTIONS:
            early |= {x, *needs[x]}
    users, place = _users(needs), dict[Node, int]()
    left = {x: len(needed) for x, needed in needs.items()}

    def lateness(x: Node) -> tuple[bool, float, int]:
        if x in early:
            return False, 0.0, rank[x]
        newest = of([place[a] + 1 for a in needs[x]] or [0])
        return True, weight * rank[x] - (1 - weight) * newest, rank[x]

    ready = [(*lateness(x), x) for x, count in left.items() if not count]
    heapify(ready)
    while ready:
        x = heappop(ready)[-1]
        place[x] = len(place)
        for user in users[x]:
            left[user] -= 1
            if not left[user]:
                heappush(ready, (*lateness(user), user))
    return list(place)


def traffic(order: Sequence[Node], needs: Needs, later: Set[Node]) -> int:
    """Number of loads and stores, if the value whose next use is farthest leaves the registers (Belady's rule)."""
    place = {x: k for k, x in enumerate(order)}
    again = {x: sorted((place[u] for u in users), reverse=True) for x, users in _users(needs).items()}
    for x in later & again.keys():
        again[x].insert(0, len(order))
    kept, stored, moves = set[Node](), {x for x in order if x.op == "symbol"}, 0
    for x in order:
        moves += len(needs[x] - kept)
        for a in needs[x]:
            again[a].pop()
        kept = {a for a in kept | needs[x] if again[a]}
        waiting = sorted(kept, key=lambda a: (again[a][-1], a.index))
        lost = set(waiting if x.op not in INSTRUCTIONS else waiting[REGISTERS:])
        moves += len(lost - stored)
        stored |= lost
        kept -= lost
        if again[x]:
            kept.add(x)
    return moves


# -------- names -----------------------------------------------------------------------------------------------
# The user's names -> identifiers of a language, no two alike.


MATH_WORDS = frozenset(
    "acos asin atan atan2 cos sin tan acosh asinh atanh cosh sinh tanh exp exp2 expm1 frexp ilogb ldexp log log10 "
    "log1p log2 logb modf cbrt fabs hypot pow sqrt erf erfc lgamma tgamma gamma ceil floor nearbyint rint lrint round "
    "lround trunc fmod remainder remquo copysign nan nextafter fdim fmax fmin fma abs sign j0 j1 jn y0 y1 yn min max "
    "select less less_equal pi np math signgam isnan isinf isfinite signbit div printf size_t".split()
)
OWN_WORDS = frozenset(
    "between acting t x p c inputs dx out given n constants evaluate math float SIZE "
    "rhs reactions inverse outputs matrices jacobian".split()
)
RESERVED = MATH_WORDS | OWN_WORDS
# our own variables, functions and macros, and reserved names of C
LOCAL = re.compile(
    r"[vi][0-9]+|samples[0-9]+|.*part[0-9]+|solve.*|.*_(rhs|reactions|inverse|outputs|matrices|jacobian).*|.*_(STATES|PARAMETERS|INPUTS|CONSTANTS|OUTPUTS)|_.*"
)


LONGEST = 31  # what is no longer every language takes
LONGEST_STEM = 48  # Fortran and MATLAB take 63, `_regressor_test` after it


def identifiers(
    names: Iterable[str], taken: Container[str], folded: Callable[[str], str] = lambda word: word
) -> dict[str, str]:
    """An identifier for every name, by the name's own letters where that can be: theta' -> theta_dot.

    Args:
        taken: words of the language, and names in use.
        folded: key in which no two identifiers may agree: in a language without capitals, the small letters.
    """
    chosen: dict[str, str] = {}
    used: set[str] = set()
    for name in names:
        word = identifier(name)[:LONGEST]
        word = word if word[0].isalpha() else f"n{word}"
        if {word, folded(word)} & RESERVED or word in taken or folded(word) in taken or LOCAL.fullmatch(word):
            word += "_"
        unique, number = word, 2
        while folded(unique) in used:
            unique, number = f"{word}_{number}", number + 1
        chosen[name] = unique
        used.add(folded(unique))
    return chosen


def identifier(name: str) -> str:
    """The letters, digits and underscores nearest to a name: 'ω₁' -> 'omega1', 'arm-7' -> 'arm_7'."""
    word = "".join(_plain(letter) for letter in unicodedata.normalize("NFKC", name))
    return f"n{word}" if not word or word[0].isdigit() else word


def stem_of(name: str) -> str:
    """Stem of the names of a model's files and functions; `_rhs` and the like follow it."""
    return identifier(name)[:LONGEST_STEM]


def _plain(letter: str) -> str:
    if letter == "'":
        return "_dot"
    if letter.isascii():
        return letter if letter.isalnum() or letter == "_" else "_"
    spelled = unicodedata.name(letter, "")
    greek = re.fullmatch(r"GREEK (SMALL|CAPITAL) LETTER (?:FINAL )?(\w+)(?: WITH .*)?", spelled)
    if greek:
        word = greek[2].replace("LAMDA", "LAMBDA")
        return word.lower() if greek[1] == "SMALL" else word.capitalize()
    bare = unicodedata.normalize("NFKD", letter)[0]
    return bare if bare.isascii() and bare.isalnum() else f"u{ord(letter):04x}"


# -------- unit quaternions ------------------------------------------------------------------------------------
# Program -> the places in its state of quaternions, and states in which these have norm 1.


class QuaternionPlaces(tuple[tuple[int, ...], ...]):
    """The places in a state of the four numbers of every quaternion."""

    __slots__ = ()

    def at_unit_norms(self, x: Any) -> Any:
        """The state, or one state a row, with every quaternion over its norm; 0 stays."""
        found = np.array(x, dtype=float)
        for places in self:
            four = found[..., list(places)]
            norm = np.sqrt(np.sum(four * four, axis=-1, keepdims=True))
            found[..., list(places)] = four / np.where(norm > 0, norm, 1)
        return found
