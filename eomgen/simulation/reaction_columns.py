"""Reactions, RightHandSide -> the reactions along a motion: the bodies' equations solved at every state, with rank.

    A(q) rho = b(q, u, a),   a of the right-hand side,   requested = C(q) rho + d(q, u)

Where the columns of A are independent, A = Q R gives rho, body by body. Where they are not (a singular position), the
null space of A says which of the requested reactions have a single value all the same; the others are nan there.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from dataclasses import replace
from functools import cached_property

import numpy as np

from eomgen.codegen import Program, RightHandSide
from eomgen.frozen import dataclass
from eomgen.mechanics.constraints import Row
from eomgen.mechanics.free_bodies import BodyEquation, NamedReaction, Reactions
from eomgen.symbolic.expression import Scalar
from eomgen.symbolic.numeric import balanced, tolerances

AT_ONCE = 2_000_000  # entries of C that are held in memory at once


@dataclass(frozen=True)
class ReactionColumns:
    """The reactions of one system along its motion.

    Args:
        reactions: of the system.
        rhs: its right-hand side.
        given: the reactions of the columns; None: every reaction by its name.
    """

    reactions: Reactions
    rhs: RightHandSide
    given: tuple[NamedReaction, ...] | None = None

    @cached_property
    def requested(self) -> tuple[NamedReaction, ...]:
        """The reactions of the columns, in their order."""
        return NamedReaction.all_of(self.reactions.balance) if self.given is None else self.given

    @property
    def names(self) -> tuple[str, ...]:
        return tuple(named.name for named in self.requested)

    @cached_property
    def indeterminate(self) -> tuple[str, ...]:
        """Names of those that have no single value at any state."""
        if self.given is not None:
            return ()
        known = self.reactions.determinate()
        return tuple(name for name in self.names if name not in known)

    def along(self, t: np.ndarray, x: np.ndarray, p: np.ndarray) -> np.ndarray:
        """The reactions at n states, n x names; nan where one has no single value [N, N m].

        Args:
            t, x: n instants, and the states there, n x states.
            p: parameters.
        """
        rates = self.rhs.many(t, x, p)
        first = len(self.rhs.coordinates)
        a = rates[:, first : first + len(self.rhs.speeds)]
        numbers = self._numbers.many(t, np.hstack([x, a]), p)
        few = max(1, AT_ONCE // (1 + len(self.requested) * len(self._columns)))
        pieces = (self._cut(numbers[i : i + few]) for i in range(0, len(numbers), few))
        solutions = [_solutions(A, b, C, self._steps) + d for A, b, C, d in pieces]
        found = np.concatenate([np.zeros((0, len(self.names))), *solutions])
        found[:, [name in self.indeterminate for name in self.names]] = np.nan
        return found

    @cached_property
    def _columns(self) -> list[int]:
        """The components solved for: those free at all states are taken as 0, which changes no other."""
        return [j for j in range(len(self.reactions.components)) if j not in self.reactions.solution.free]

    @property
    def _places(self) -> tuple[list[tuple[int, int, Scalar]], list[Scalar], list[tuple[int, int, Scalar]]]:
        """(entries of A, b, entries of C), an entry with its row and column."""
        column, equations = {j: k for k, j in enumerate(self._columns)}, self._equations
        A = [(i, column[j], x) for i, e in enumerate(equations) for j, x in e.coefficients.items() if j in column]
        b = [e.needed for e in equations]
        for j, x in self.reactions.balance.given.items():
            A.append((len(b), column[j], 1))
            b.append(x)
        C = [(i, column[j], x) for i, n in enumerate(self.requested) for j, x in n.combination.items() if j in column]
        return A, b, C

    @cached_property
    def _equations(self) -> list[BodyEquation]:
        """The equations in which something is solved for."""
        columns = set(self._columns)
        return [e for e in self.reactions.balance.equations if not columns.isdisjoint(e.coefficients)]

    @property
    def _groups(self) -> list[list[int]]:
        """The rows of A of each body, then each that gives one component."""
        rows: dict[str, list[int]] = {}
        for i, equation in enumerate(self._equations):
            rows.setdefault(equation.body, []).append(i)
        return [*rows.values(), *([i] for i in range(len(self._equations), len(self._places[1])))]

    def _steps(self, A: np.ndarray) -> tuple[BodyBalance, ...]:
        """The order in which the bodies are solved, for all states that of the first one."""
        if not self._found:
            stands = np.zeros(A.shape[1:], dtype=bool)
            stands[tuple(np.array([(i, j) for i, j, _ in self._places[0]], dtype=int).reshape(-1, 2).T)] = True
            self._found.append(steps_of(A[0], stands, self._groups))
        return self._found[0]

    @cached_property
    def _found(self) -> list[tuple[BodyBalance, ...]]:
        return []

    @cached_property
    def _numbers(self) -> RightHandSide:
        """All entries as a function of t, (q, u, z, a) and p."""
        A, b, C = self._places
        system = self.reactions.balance.system
        symbols = replace(system.symbols, z=system.symbols.z + system.symbols.a)
        outputs = (*(x for _, _, x in A), *b, *(x for _, _, x in C), *(named.given for named in self.requested))
        return RightHandSide.of(Program.of(outputs, symbols, inputs=system.inputs), "numpy")

    def _cut(self, numbers: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray]:
        """(A, b, C, d) at every state."""
        places, b, combined = self._places
        ends = np.cumsum([len(places), len(b), len(combined)])
        of_A, of_b, of_C, d = np.split(numbers, ends, axis=1)
        A = np.zeros((len(numbers), len(b), len(self._columns)))
        C = np.zeros((len(numbers), len(self.requested), len(self._columns)))
        A[:, [i for i, _, _ in places], [j for _, j, _ in places]] = of_A
        C[:, [i for i, _, _ in combined], [j for _, j, _ in combined]] = of_C
        return A, of_b, C, d


def _solutions(
    A: np.ndarray, b: np.ndarray, C: np.ndarray, order: Callable[[np.ndarray], tuple[BodyBalance, ...]]
) -> np.ndarray:
    """C rho at every state, A rho = b; rows and columns of A are brought to one size first, for their units.

    Args:
        order: of some states, in which the bodies are solved.
    """
    found = np.full(C.shape[:2], np.nan)
    sound = np.isfinite(A).all(axis=(1, 2)) & np.isfinite(b).all(axis=1)
    if not A.shape[2] or not sound.any():
        found[sound] = 0.0
        return found
    A = np.where(np.abs(A) > tolerances.SUMMED * np.abs(A).max(axis=1, keepdims=True), A, 0.0)
    _, rows, columns = balanced(np.abs(A[sound]).max(axis=0))
    A, b, C = A * rows[:, None] * columns, b * rows, C * columns
    rho, regular = balanced_from_leaves(A[sound], b[sound], order(A[sound]))
    at = np.flatnonzero(sound)
    found[at[regular]] = (C[at[regular]] @ rho[regular, :, None])[:, :, 0]
    for i in at[~regular]:
        found[i] = _where_singular(A[i], b[i], C[i])
    return found


def _where_singular(A: np.ndarray, b: np.ndarray, C: np.ndarray) -> np.ndarray:
    """C rho, nan where the null space of A has a part in it; all nan where no finite rho holds the balance."""
    U, sizes, V = np.linalg.svd(A)
    rank = int(np.sum(sizes > tolerances.RANK_NEARBY * max(sizes, default=0.0)))
    rho = V[:rank].T @ ((U[:, :rank].T @ b) / sizes[:rank])
    if np.linalg.norm(A @ rho - b) > tolerances.UNBALANCED * np.linalg.norm(b):
        return np.full(len(C), np.nan)
    traces = np.abs(C @ V[rank:].T).max(axis=1, initial=0.0)
    return np.where(traces > tolerances.SHARE * np.linalg.norm(C, axis=1), np.nan, C @ rho)


SLIDES = 1e2 * float(Row.STILL)  # |v|, at which friction is all but along it [m/s]
BRIEF = 1e-2  # of the phase, the longest time that is waited for it
TRIES = 30  # each twice as long as the one before


def begun(
    t: np.ndarray,
    x: np.ndarray,
    rate: Callable[[float, np.ndarray], np.ndarray],
    sliding: Callable[[float, np.ndarray], float],
) -> np.ndarray:
    """n states, n x states, the first of them a little later where a contact begins to slide.

    Args:
        t: their instants.
        rate: (t, x) -> x'.
        sliding: (t, x) -> the least speed with which anything slides on a surface [m/s].
    """
    if len(t) < 2 or sliding(t[0], x[0]) >= SLIDES:
        return x
    later, h = x[0], BRIEF * (t[-1] - t[0]) / 2 ** (TRIES + 1)
    for _ in range(TRIES):
        later, h = later + h * rate(t[0], later), 2 * h
        if sliding(t[0], later) >= SLIDES:
            return np.vstack([later, x[1:]])
    return x


# -------- leaf to root balance --------------------------------------------------------------------------------
# Equations of bodies -> an order in which they give the unknowns: body by body from the leaves inwards.
#
# A body on which few enough reactions are still unknown gives these from its own rows; what loops leave is solved as
# one.
#
#     A_gk rho_k = b_g - A_gl rho_l      rows g of one body, columns k still open there, l known already


@dataclass(frozen=True)
class BodyBalance:
    """Rows that give columns, once `known` columns are.

    Args:
        rows, columns, known: indices.
    """

    rows: np.ndarray
    columns: np.ndarray
    known: np.ndarray


def steps_of(A: np.ndarray, stands: np.ndarray, groups: Iterable[Sequence[int]]) -> tuple[BodyBalance, ...]:
    """The order for matrices of one pattern.

    Args:
        A: one of them, rows x columns, which decides the regular blocks.
        stands: True where an entry can be other than zero, rows x columns.
        groups: the rows of each body.
    """
    left, open_ = [np.array(group) for group in groups], np.ones(A.shape[1], dtype=bool)
    steps: list[BodyBalance] = []
    while (k := next((k for k, group in enumerate(left) if _gives(A, stands, group, open_)), None)) is not None:
        steps.append(_step(stands, left.pop(k), open_))
        open_[steps[-1].columns] = False
    core = np.concatenate([np.zeros(0, dtype=int), *left])
    return (*steps, BodyBalance(core, np.flatnonzero(open_), np.flatnonzero(stands[core].any(axis=0) & ~open_)))


def _gives(A: np.ndarray, stands: np.ndarray, group: np.ndarray, open_: np.ndarray) -> bool:
    """True if the rows determine the unknowns that are open in them."""
    columns = np.flatnonzero(stands[group].any(axis=0) & open_)
    if not 0 < len(columns) <= len(group):
        return False
    block = A[np.ix_(group, columns)]
    return bool(_regular(np.asarray(np.linalg.qr(block, mode="r"))[None], block[None])[0])


def _step(stands: np.ndarray, rows: np.ndarray, open_: np.ndarray) -> BodyBalance:
    touched = stands[rows].any(axis=0)
    return BodyBalance(rows, np.flatnonzero(touched & open_), np.flatnonzero(touched & ~open_))


def balanced_from_leaves(A: np.ndarray, b: np.ndarray, steps: Iterable[BodyBalance]) -> tuple[np.ndarray, np.ndarray]:
    """(rho, whether every block was regular) of m systems A rho = b."""
    rho, regular = np.zeros((len(A), A.shape[2])), np.ones(len(A), dtype=bool)
    for step in steps:
        block = A[:, step.rows][:, :, step.columns]
        right = b[:, step.rows] - (A[:, step.rows][:, :, step.known] @ rho[:, step.known, None])[:, :, 0]
        R = np.asarray(np.linalg.qr(np.concatenate([block, right[:, :, None]], axis=2), mode="r"))
        size = len(step.columns)
        regular &= _regular(R, block)
        upper = np.where(regular[:, None, None], R[:, :size, :size], np.eye(size))
        rho[:, step.columns] = np.linalg.solve(upper, R[:, :size, size:])[:, :, 0]
    return rho, regular


def _regular(R: np.ndarray, block: np.ndarray) -> np.ndarray:
    """True for each system in which no column follows from those before it."""
    size = block.shape[2]
    pivots = np.abs(np.diagonal(R[:, :size, :size], axis1=1, axis2=2))
    if pivots.shape[1] < size:
        return np.zeros(len(R), dtype=bool)
    found: np.ndarray = (pivots > tolerances.RANK_NEARBY * np.linalg.norm(block, axis=1)).all(axis=1)
    return found
