"""State kernel: the equations of a system at one state, in one field of numbers.

    J x + b = 0,   x = (x_f, x_d):      x_d = -J_d^-1 (J_f x_f + b),   J Z = 0
    M a = forcing + J^T lam,  J a + gamma = 0:      what Z^T (M a - forcing) leaves is not balanced

A field is a state together with the kind of numbers in which it is looked at: doubles (`Doubles`), numbers of 50 digits
that become doubles (`Numbers`), scalars of the parameters (`Exact`). Rank and independence are decided by doubles, of
rows and columns that were brought to one size; what follows from the choice holds in every field.
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Collection, Iterable, Mapping, Sequence
from dataclasses import field as dataclass_field
from dataclasses import replace
from functools import cached_property
from typing import Any

import numpy as np

from eomgen.errors import DerivationError
from eomgen.frozen import dataclass
from eomgen.symbolic.exact import simplest, vanishes
from eomgen.symbolic.expression import Node, Scalar, inner, is_zero, over, substituted
from eomgen.symbolic.numeric import FLOAT, Work, dense, evaluate, fifty_digits, floats_of, tolerances

# -------- fields ----------------------------------------------------------------------------------------------
# Graph scalars at one state, and the little algebra of matrices that holds in every field.


MOST_TERMS = 60  # of an entry that is multiplied out however short it came: more fill more than a formula's lines
Entries = list[list[Any]]  # of exact scalars, or of floats
ScalarMatrix = Sequence[Sequence[Scalar]]


class NumberField(ABC):
    """A state in one kind of numbers: source of the entries of matrices, which are sums and products of these."""

    @abstractmethod
    def of(self, scalars: Iterable[Scalar]) -> list[Any]:
        """The scalars at the state."""

    @abstractmethod
    def with_values(self, more: Mapping[Node, Any]) -> NumberField:
        """The same with more symbols known."""

    def tidy(self, x: Any) -> Any:
        """An entry in the form in which it is used further; 0 where it vanishes."""
        return x

    def size(self, x: Any) -> float:
        """|x|, by which a pivot is chosen."""
        return abs(float(x))

    def matrix(self, rows: ScalarMatrix) -> Entries:
        """A matrix of graph scalars at the state."""
        flat = iter(self.of([x for row in rows for x in row]))
        return [[next(flat) for _ in row] for row in rows]

    def array(self, rows: ScalarMatrix, columns: int) -> np.ndarray:
        """The same in doubles, rows x columns, where there may be no rows."""
        return np.array(self.of([x for row in rows for x in row]), dtype=float).reshape(len(rows), columns)

    def product(self, A: Entries, B: Entries) -> Entries:
        """A B."""
        if _is_one(A) or _is_one(B):
            return [[0 if is_zero(x) else self.tidy(x) for x in row] for row in (B if _is_one(A) else A)]
        columns = [[None if is_zero(y) else y for y in column] for column in zip(*B, strict=True)]
        rows = [[(k, x) for k, x in enumerate(row) if not is_zero(x)] for row in A]
        return [[self.tidy(_inner(row, column)) for column in columns] for row in rows]

    def total(self, *matrices: Entries) -> Entries:
        """A + B + ..."""
        rows = zip(*matrices, strict=True)
        return [[self.tidy(sum(x, start=0)) for x in zip(*row, strict=True)] for row in rows]

    def negative(self, A: Entries) -> Entries:
        """-A."""
        return [[-x for x in row] for row in A]

    def transposed(self, A: Entries, columns: int) -> Entries:
        """A transposed; `columns` of A, where it may have no rows."""
        return [[row[j] for row in A] for j in range(columns)]

    def solution(self, A: Entries, B: Entries) -> Entries:
        """X of A X = B. A has full column rank; rows beyond that follow from the others, and are not looked at.

        Raises:
            DerivationError: the rank is less.
        """
        rows = [[*a, *b] for a, b in zip(A, B, strict=True)]
        unknowns = len(A[0]) if A else 0
        for k in range(unknowns):
            pivot = max(range(k, len(rows)), key=lambda i: (self.size(rows[i][k]), -i))
            rows[k], rows[pivot] = rows[pivot], rows[k]
            if is_zero(rows[k][k]):
                what = (
                    "linearize: something moves no mass at the place of reference: its accelerations are not determined"
                )
                raise DerivationError(what, fix="take coordinates that are regular there, or another place")
            rows[k] = [self.tidy(over(x, rows[k][k])) for x in rows[k]]
            for i, row in enumerate(rows):
                if i != k and not is_zero(row[k]):
                    rows[i] = [self.tidy(x - row[k] * y) for x, y in zip(row, rows[k], strict=True)]
        return [row[unknowns:] for row in rows[:unknowns]]


def _inner(row: list[tuple[int, Any]], column: list[Any | None]) -> Any:
    """The sum of what is not 0 in the row, each by its place, times what is not in the column."""
    return sum([x * column[k] for k, x in row if column[k] is not None], start=0)


def _is_one(A: Entries) -> bool:
    """True for the unit matrix, written so."""
    n = len(A)
    return n > 0 and all(
        len(row) == n and all(type(x) is int and x == (i == j) for j, x in enumerate(row)) for i, row in enumerate(A)
    )


@dataclass(frozen=True)
class Numbers(NumberField):
    """Doubles of what was found with 50 digits.

    Args:
        state: values of all symbols, with 50 digits.
    """

    state: Mapping[Node, Any]

    def of(self, scalars: Iterable[Scalar]) -> list[Any]:
        """The scalars at the state.

        Raises:
            NoValue: one has none there, or none among doubles.
        """
        return floats_of(evaluate(tuple(scalars), self.state, fifty_digits()))

    def on_manifold(self, rows: ScalarMatrix, columns: int) -> np.ndarray:
        """The rows where the constraints hold: entries that vanish there are 0, not what is left of them."""
        return dense.closed_entries(self.array(rows, columns))

    def with_values(self, more: Mapping[Node, Any]) -> Numbers:
        number = fifty_digits().number
        return Numbers({**self.state, **{node: number(x) for node, x in more.items()}})


@dataclass(frozen=True)
class Doubles(NumberField):
    """Doubles; nan where a scalar has no value.

    Args:
        state: values of all symbols, as floats.
    """

    state: Mapping[Node, Any]

    def of(self, scalars: Iterable[Scalar]) -> list[Any]:
        return evaluate(tuple(scalars), self.state, FLOAT)

    def with_values(self, more: Mapping[Node, Any]) -> Doubles:
        return Doubles({**self.state, **more})


@dataclass(frozen=True)
class Exact(NumberField):
    """Scalars of the parameters.

    Args:
        state: everything but the parameters, as scalars of them.
        positive: parameters that are positive numbers.
        trial: values of the parameters, with 50 digits, by which pivots are chosen.
        known: the forms of entries that were tidied before.
    """

    state: Mapping[Node, Scalar]
    positive: Collection[Node]
    trial: Mapping[Node, Any]
    known: dict[Scalar, Scalar] = dataclass_field(default_factory=dict, compare=False, repr=False)

    def of(self, scalars: Iterable[Scalar]) -> list[Any]:
        return [self.tidy(x) for x in substituted(tuple(scalars), self.state)]

    def tidy(self, x: Any) -> Any:
        if type(x) is not Node or x.op == "symbol":
            return x
        if x not in self.known:
            found = simplest(x, Work.VALUE, self.positive, MOST_TERMS)
            self.known[x] = self.known[found] = 0 if is_zero(found) or vanishes(found) else found
        return self.known[x]

    def size(self, x: Any) -> float:
        return abs(float(evaluate((x,), self.trial, fifty_digits())[0]))

    def with_values(self, more: Mapping[Node, Any]) -> Exact:
        return replace(self, state={**self.state, **more})


# -------- independence ----------------------------------------------------------------------------------------
# Rows of numbers -> the rows that are independent, and the columns that they determine.


OWN = 0.2  # of what a column adds to those chosen, against the best


@dataclass(frozen=True)
class Split:
    """Columns of J that stay free, and those that follow.

    Args:
        free: columns that stay.
        following: columns that the rows determine, as many as rows.
        rows: rows that are independent, and are solved for these.
    """

    free: tuple[int, ...]
    following: tuple[int, ...]
    rows: tuple[int, ...]

    @classmethod
    def of(cls, A: np.ndarray, late: Sequence[Any] | None = None, smallest: float = tolerances.RANK) -> Split:
        """The independent rows, and the columns that they determine: the latest first, of those as late the last.

        A column that the others nearly make up, against the best of those as late, waits for these.

        Args:
            late: of each column how late it is; those that are later follow rather (None: all alike).
            smallest: part of a scaled row or column below which it follows from others.
        """
        late = [0] * A.shape[1] if late is None else late
        rows, following = _determined(A, late, smallest) if len(A) else ((), ())
        return cls(tuple(k for k in range(A.shape[1]) if k not in following), following, rows)

    @classmethod
    def in_order(cls, A: np.ndarray, order: Sequence[int], smallest: float = tolerances.RANK) -> Split:
        """The same where columns follow in this order, the first one first."""
        return cls.of(A, [-order.index(k) for k in range(A.shape[1])], smallest)

    def null_basis(self, field: NumberField, J: Entries) -> Entries:
        """Z of x = Z x_f with J Z = 0, columns of J x free columns; J of the rows that are solved."""
        found = self.followed(field, J, [[row[k] for k in self.free] for row in J]) if self.rows else []
        place = {k: j for j, k in enumerate(self.free)}
        return [[int(place[k] == j) for j in place.values()] if k in place else found[k] for k in self._columns]

    def followed(self, field: NumberField, J: Entries, right: Entries) -> Entries:
        """x of all columns with x_f = 0 and J x + right = 0."""
        J_d = [[row[k] for k in self.following] for row in J]
        found = field.solution(J_d, field.negative(right)) if self.following else []
        width = len(right[0]) if right else 0
        by_column = dict(zip(self.following, found, strict=True))
        return [by_column.get(k, [0] * width) for k in self._columns]

    @property
    def _columns(self) -> range:
        return range(len(self.free) + len(self.following))


def _determined(A: np.ndarray, late: Sequence[Any], smallest: float) -> tuple[tuple[int, ...], tuple[int, ...]]:
    """(independent rows, columns that they determine)."""
    scaled = dense.balanced(dense.without_noise(A, tolerances.ROUNDING, axis=1))[0]
    rows = dense.independent_rows(scaled, smallest)
    left = scaled[rows].copy()
    chosen: list[int] = []
    for rank in sorted({*late}, reverse=True):
        waiting = [k for k in reversed(range(A.shape[1])) if late[k] == rank]
        while waiting and len(chosen) < len(rows):
            sizes = np.linalg.norm(left[:, waiting], axis=0)
            if max(sizes) <= smallest:
                break
            k = next(k for k, size in zip(waiting, sizes, strict=True) if size >= OWN * max(sizes))
            waiting.remove(k)
            chosen.append(k)
            direction = left[:, k] / np.linalg.norm(left[:, k])
            left -= np.outer(direction, direction @ left)
    return tuple(rows), tuple(sorted(chosen))


# -------- at a state ------------------------------------------------------------------------------------------


# Equations, a field, a choice -> what follows at that state.


@dataclass(frozen=True)
class At:
    """Equations at one state.

    Args:
        equations: what has rows J, and where they are asked for M, forcing, sigma and gamma, as graph scalars.
        field: the state.
        split: which columns of J stay free, and which follow.
    """

    equations: Any
    field: NumberField
    split: Split

    @cached_property
    def J(self) -> Entries:
        """The rows that are looked at; the others follow from them."""
        return self.field.matrix([self.equations.J[i] for i in self.split.rows])

    @cached_property
    def M(self) -> Entries:
        """The mass matrix."""
        return self.field.matrix(self.equations.M)

    def following(self, right: Entries) -> Entries:
        """x of all columns with x_f = 0 and J x + right = 0."""
        return self.split.followed(self.field, self.J, right)

    @cached_property
    def Z(self) -> Entries:
        """x = Z x_f with J Z = 0."""
        return self.split.null_basis(self.field, self.J)

    def along(self, A: Entries) -> Entries:
        """Z^T A: rows of all columns as they act along the free ones."""
        return self.field.product(self.field.transposed(self.Z, len(self.split.free)), A)

    def dependent(self, free: Sequence[Scalar]) -> list[Any]:
        """All speeds with J u + sigma = 0, from the free ones of the state.

        Args:
            free: their symbols.
        """
        independent = [[x] for x in self.field.of(free)]
        sigma = self.field.of([self.equations.sigma[i] for i in self.split.rows])
        pushed = self.field.product([[row[k] for k in self.split.free] for row in self.J], independent)
        found = self.following([[self.field.tidy(x[0] + s)] for x, s in zip(pushed, sigma, strict=True)])
        return [row[0] for row in found]

    @cached_property
    def a(self) -> list[Any]:
        """Accelerations, the free ones 0: J a + gamma = 0."""
        if not self.split.rows:
            return [0] * (len(self.split.free) + len(self.split.following))
        gamma = self.field.of([self.equations.gamma[i] for i in self.split.rows])
        return [row[0] for row in self.following([[x] for x in gamma])]

    @cached_property
    def forces(self) -> list[Any]:
        """M a - forcing: what the constraints must push."""
        forcing = self.field.of(self.equations.forcing)
        return [self.field.tidy(inner(row, self.a) - x) for row, x in zip(self.M, forcing, strict=True)]

    @cached_property
    def lam(self) -> list[Any]:
        """Multipliers by J_d^T lam = M a - forcing; 0 of rows that follow from others."""
        split = self.split
        J_d = [[row[k] for row in self.J] for k in split.following]
        pushes = [[self.forces[k]] for k in split.following]
        found = self.field.solution(J_d, pushes) if split.following else []
        by_row = dict(zip(split.rows, (row[0] for row in found), strict=True))
        return [by_row.get(i, 0) for i in range(len(self.equations.J))]

    @cached_property
    def unbalanced(self) -> list[Any]:
        """Z^T (M a - forcing): what accelerates the free speeds."""
        columns = self.field.transposed(self.Z, len(self.split.free))
        return [self.field.tidy(inner(column, self.forces)) for column in columns]
