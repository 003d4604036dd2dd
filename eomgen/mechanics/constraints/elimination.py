"""Constraints -> Elimination: the rates of dependent coordinates, by the rows that determine them.

    J_d u_d + J_i u_i + sigma = 0   ->   u_d = A u_i + b,   N = [1; A],   nu = [0; b]

Linear even where positions are not. A and b have the determinant of J_d as denominator: where it vanishes (a dead
centre, a change point) the independent coordinates do not determine the dependent ones.
"""

from __future__ import annotations

from collections.abc import Sequence
from contextlib import suppress
from dataclasses import replace
from typing import Any

import numpy as np

from eomgen.errors import DerivationError, MissingValues
from eomgen.frozen import dataclass
from eomgen.mechanics.constraints.closure import Closure
from eomgen.mechanics.constraints.rows import Constraints, holds_identically
from eomgen.mechanics.kinematics import Scope, shorter
from eomgen.mechanics.state import Split
from eomgen.symbolic.exact import cramer
from eomgen.symbolic.expression import Node, Scalar, depends_on, inner, is_zero, operations
from eomgen.symbolic.numeric import NoValue, dense, rank, tolerances

Label = tuple[str, int]
FAR = (3.0, 1.0, 0.3)  # distances from the start at which chosen rows are tested
FAR_STATES = 8
LEAN = 0.02  # of the largest share of the chosen rows in the determinant of all
SHAKEN = (2, 3)  # seeds of states with parameters of their own


@dataclass(frozen=True)
class DependentBlock:
    """Dependent coordinates that some rows determine together.

    Args:
        coordinates, constraints: their names.
        determinant: of the rows' coefficients of these rates; where it vanishes they are not determined.
    """

    PLACE = "a dead centre or a change point"

    coordinates: tuple[str, ...]
    constraints: tuple[str, ...]
    determinant: Scalar

    def __str__(self) -> str:
        constraints, names = (", ".join(f"'{name}'" for name in each) for each in (self.constraints, self.coordinates))
        return f"{constraints} {'does' if len(self.constraints) == 1 else 'do'} not determine {names}"


@dataclass(frozen=True)
class Elimination:
    """Result of the elimination of dependent coordinates.

    Args:
        scope: the symbols and kinematic equations with the independent speeds alone.
        used: the rows satisfied by it: for a row that determines dependent rates, the coordinate that would be free
            without it; for a row that follows from these, "".
        blocks: the matrices J_d that must stay regular.
    """

    scope: Scope
    used: dict[Label, str]
    blocks: tuple[DependentBlock, ...]

    @staticmethod
    def of(constraints: Constraints) -> Elimination:
        """The dependent coordinates of a model eliminated through its constraints.

        Args:
            constraints: all of them, over the scope in which dependent coordinates are free.
        Raises:
            DerivationError: a dependent coordinate that no constraint determines.
        """
        scope = constraints.motion.scope
        names = scope.dependent
        dependent = tuple(k for k, u in enumerate(scope.symbols.u) if u.name[:-1] in names)
        kept = tuple(k for k in range(len(scope.symbols.u)) if k not in dependent)
        J = _numbers(constraints)
        rows = _determining_rows(constraints, J[:, dependent])
        if len(rows) < len(dependent):
            raise _undetermined(names, J[np.ix_(rows, dependent)], constraints)
        follow = _following(J, rows, dependent, kept)
        sharing = [i for i in follow if np.any(J[i, dependent])]
        system = _LinearRows(constraints, J, rows, dependent, kept)
        if sharing and system.lean(sharing):
            system = system.where_closed().joined(sharing)
        A, b, blocks = system.solved()
        scope = _reduced(scope, dependent, kept, A, b)
        own = [names[j] for j in _released_by(J[np.ix_(rows, dependent)])]
        found = dict(zip(rows, own, strict=True)) | dict.fromkeys(follow, "")
        used = {(constraints.closing[i].constraint, constraints.closing[i].number): name for i, name in found.items()}
        return Elimination(scope, used, tuple(_named(constraints, names, system.rows, block) for block in blocks))


# -- which rows --------------------------------------------------------------------------------------


def _numbers(constraints: Constraints) -> np.ndarray:
    """J of the constraint rows at a generic state in which they hold, or where none is near at any state.

    Raises:
        DerivationError: it has no finite value there.
    """
    try:
        state = Closure(constraints).generic()
    except (DerivationError, MissingValues):
        state = Closure(constraints).scattered()
    try:
        return Closure(constraints).rows_at(state)
    except (NoValue, ZeroDivisionError):
        what = "the velocities of the constraints have no finite value near the start"
        raise DerivationError(what, "constraints", "look at what grows in the joints that they hold") from None


def _determining_rows(constraints: Constraints, J_d: np.ndarray) -> list[int]:
    """The simplest constraint rows that are independent in the dependent speeds, in their order."""
    speeds = _dependent_speeds(constraints)
    order = sorted(range(len(constraints.closing)), key=lambda i: (*_difficulty(constraints, i, speeds), i))
    return [*Split.in_order(J_d.T, order).following]


def _dependent_speeds(constraints: Constraints) -> list[int]:
    model = constraints.motion.scope.model
    return [k for k, u in enumerate(constraints.motion.scope.symbols.u) if model.coordinates[u.name[:-1]].dependent]


def _difficulty(constraints: Constraints, i: int, dependent: Sequence[int]) -> tuple[int, int, int]:
    """Sort key of a row by its cost: constant entries before parameters before variables, then few, then short ones."""
    scope = constraints.motion.scope
    moving = (*scope.symbols.q, scope.symbols.t)
    entries = [constraints.J[i][k] for k in dependent if not is_zero(constraints.J[i][k])]
    kinds = [0 if type(x) is not Node else 2 if depends_on(x, moving) else 1 for x in entries]
    return max(kinds, default=0), len(entries), operations(constraints.J[i]).total


def _following(J: np.ndarray, rows: list[int], dependent: tuple[int, ...], kept: tuple[int, ...]) -> list[int]:
    """The rows that hold wherever the chosen ones do: J_i - J_d (J_d of the chosen)^-1 J_i of the chosen = 0."""
    columns = [*dependent, *kept]
    return [i for i in range(len(J)) if i not in rows and rank(J[[*rows, i]][:, columns]) <= len(rows)]


def _released_by(J_d: np.ndarray) -> list[int]:
    """Dependent speed of each row, all different, that becomes free without that row: its entry of J_d^-1 is not 0."""
    moved = abs(np.linalg.inv(J_d)).T
    found = cramer.matching([np.flatnonzero(row > tolerances.RANK * max(row)).tolist() for row in moved])
    return [found[i] for i in range(len(J_d))]


def _undetermined(names: tuple[str, ...], J_d: np.ndarray, constraints: Constraints) -> DerivationError:
    """Names the coordinates that the rows leave free."""
    left = [names[k] for k in Split.in_order(J_d, range(len(names))).free]
    what = f"'{left[0]}' is dependent, but " + _why(constraints, len(left))
    return DerivationError(what, f"coordinates.{left[0]}", "add the constraint that moves it, or leave out `dependent`")


def _why(constraints: Constraints, left: int) -> str:
    if not constraints.closing:
        return "the coordinates satisfy all constraints by themselves" if constraints.rows else "there is no constraint"
    together = "" if left == 1 else f", and {left - 1} more dependent coordinate{'s' * (left > 2)} with it"
    return f"the constraints leave it free{together}"


# -- the rates ---------------------------------------------------------------------------------------


@dataclass(frozen=True)
class _LinearRows:
    """Rows that determine the dependent rates.

    Args:
        constraints: all of them.
        numbers: J at a state in which they hold.
        rows: of the constraint rows.
        dependent, kept: indices of the speeds that are solved for, and of those that are not.
        vanishing: (row, speed) of entries that vanish wherever the constraints hold.
        are_squared: whether they are taken together, J_d^T (J_d u_d + J_i u_i + sigma) = 0.
    """

    constraints: Constraints
    numbers: np.ndarray
    rows: list[int]
    dependent: tuple[int, ...]
    kept: tuple[int, ...]
    vanishing: frozenset[tuple[int, int]] = frozenset()
    are_squared: bool = False

    def where_closed(self) -> _LinearRows:
        """The same without entries that vanish wherever the constraints hold, at parameters near the model's too."""
        zero = self.numbers == 0
        try:
            for seed in SHAKEN:
                zero &= Closure(self.constraints).rows_at(Closure(self.constraints).generic(seed, shaken=True)) == 0
        except (DerivationError, MissingValues, NoValue):
            return self
        return replace(self, vanishing=frozenset((int(i), int(k)) for i, k in np.argwhere(zero)))

    def lean(self, sharing: Sequence[int]) -> bool:
        """True if the chosen rows become dependent at some states where all rows together do not.

        Measured by |J_d|^2 / |J_d^T J_d of all rows| at states far from one another that satisfy the constraints.
        """
        lengths = dense.lengths_of(self.numbers, 1, keepdims=True)
        rows, shares = [*self.rows, *sharing], []
        for seed in range(FAR_STATES):
            with suppress(DerivationError, MissingValues, NoValue, ZeroDivisionError):
                state = Closure(self.constraints).generic(seed, spreads=FAR)
                J = (Closure(self.constraints).rows_at(state) / dense.divisor(lengths))[rows]
                J_d = J[:, self.dependent]
                whole = np.linalg.det(J_d.T @ J_d)
                if whole > tolerances.RANK and rank(J) == len(self.rows):  # on another branch they need not follow
                    shares.append(np.linalg.det(J_d[: len(self.rows)]) ** 2 / whole)
        return min(shares, default=1.0) < LEAN * max(shares, default=1.0)

    def joined(self, sharing: Sequence[int]) -> _LinearRows:
        """All of them together: u_d of least squares, which is exact where the constraints hold."""
        return replace(self, rows=sorted([*self.rows, *sharing]), are_squared=True)

    def _entry(self, i: int, k: int) -> Scalar:
        return 0 if (i, k) in self.vanishing else self.constraints.J[i][k]

    def solved(self) -> Any:
        """(A, b, blocks) of u_d = A u_i + b."""
        left = [[self._entry(i, k) for k in self.dependent] for i in self.rows]
        right = [[*(-self._entry(i, k) for k in self.kept), -self.constraints.sigma[i]] for i in self.rows]
        if self.are_squared:
            columns = list(zip(*left, strict=True))
            left, right = (
                [[inner(column, other) for other in zip(*side, strict=True)] for column in columns]
                for side in (left, right)
            )
        system = [dict(enumerate(row)) for row in left]
        solution, blocks = cramer.solution_by_minors(system, right, vanishes=holds_identically, shorter=shorter)
        return [row[:-1] for row in solution], [row[-1] for row in solution], blocks


def _reduced(scope: Scope, dependent: tuple[int, ...], kept: tuple[int, ...], A: Any, b: Any) -> Scope:
    """The scope with the independent speeds, N = [1; A] and nu = [0; b] in the order of the coordinates."""
    u, a = scope.symbols.u, scope.symbols.a
    symbols = replace(scope.symbols, u=tuple(u[k] for k in kept), a=tuple(a[k] for k in kept))
    rates = {u[k].name[:-1]: (tuple(A[j]), b[j]) for j, k in enumerate(dependent)}
    N, nu = [], []
    for q, row, bias in zip(scope.symbols.q, scope.N, scope.nu, strict=True):
        own = rates.get(q.name, (tuple(row[k] for k in kept), bias))
        N.append(own[0])
        nu.append(own[1])
    reduced = replace(scope, symbols=symbols, N=tuple(N), nu=tuple(nu))
    given = {q.name: rate for q, rate in zip(symbols.q, reduced.rates, strict=True) if q.name in rates}
    second = reduced.with_accelerations(tuple(given.values()))
    names = {f"{name}'": rate for name, rate in given.items()}
    names |= {f"{name}''": acceleration for name, acceleration in zip(given, second, strict=True)}
    return replace(reduced, names={**scope.names, **names}).with_speeds_named()


def _named(constraints: Constraints, names: tuple[str, ...], rows: list[int], block: cramer.Block) -> DependentBlock:
    taken = rows if len(rows) > len(names) else [rows[i] for i in block.equations]
    owners = dict.fromkeys(constraints.closing[i].constraint for i in taken)
    return DependentBlock(tuple(names[j] for j in block.unknowns), tuple(owners), cramer.determinant(block.matrix))
