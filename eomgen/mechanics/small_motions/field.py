"""Graph scalars at one state, exact or as numbers, and the little algebra of matrices that holds for both.

The laws of small motions are written once, over entries that are either exact scalars of the parameters or floats.
"""

from __future__ import annotations

from collections.abc import Collection, Iterable, Mapping, Sequence
from dataclasses import field as dataclass_field
from dataclasses import replace
from typing import Any, Protocol

from eomgen.errors import DerivationError
from eomgen.records import dataclass
from eomgen.symbolic.exact.normal_form import simplest
from eomgen.symbolic.expression.derivative import substituted
from eomgen.symbolic.expression.functions import over
from eomgen.symbolic.expression.graph import Node, Scalar, is_zero
from eomgen.symbolic.numeric.evaluation import evaluate, fifty_digits, floats_of
from eomgen.symbolic.numeric.work import Work
from eomgen.symbolic.solve.solving import vanishes

MOST_TERMS = 60  # of an entry that is multiplied out however short it came: more fill more than a formula's lines
MatrixEntry = Any  # an exact scalar, or a float
Entries = list[list[MatrixEntry]]


class NumberField(Protocol):
    """Where entries come from."""

    def of(self, scalars: Iterable[Scalar]) -> list[MatrixEntry]:
        """The scalars at the state."""

    def tidy(self, x: MatrixEntry) -> MatrixEntry:
        """An entry in the form in which it is used further; 0 where it vanishes."""

    def size(self, x: MatrixEntry) -> float:
        """|x|, by which a pivot is chosen."""

    def with_values(self, more: Mapping[Node, MatrixEntry]) -> NumberField:
        """The same with more symbols known."""


@dataclass(frozen=True)
class Numbers:
    """Floats.

    Args:
        state: values of all symbols, with 50 digits.
    """

    state: Mapping[Node, Any]

    def of(self, scalars: Iterable[Scalar]) -> list[MatrixEntry]:
        return floats_of(evaluate(tuple(scalars), self.state, fifty_digits()))

    def tidy(self, x: MatrixEntry) -> MatrixEntry:
        return x

    def size(self, x: MatrixEntry) -> float:
        size: float = abs(x)
        return size

    def with_values(self, more: Mapping[Node, MatrixEntry]) -> Numbers:
        number = fifty_digits().number
        return Numbers({**self.state, **{node: number(1) * x for node, x in more.items()}})


@dataclass(frozen=True)
class Exact:
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

    def of(self, scalars: Iterable[Scalar]) -> list[MatrixEntry]:
        return [self.tidy(x) for x in substituted(tuple(scalars), self.state)]

    def tidy(self, x: MatrixEntry) -> MatrixEntry:
        if type(x) is not Node or x.op == "symbol":
            return x
        if x not in self.known:
            found = simplest(x, Work.VALUE, self.positive, MOST_TERMS)
            self.known[x] = self.known[found] = 0 if is_zero(found) or vanishes(found) else found
        return self.known[x]

    def size(self, x: MatrixEntry) -> float:
        return abs(float(evaluate((x,), self.trial, fifty_digits())[0]))

    def with_values(self, more: Mapping[Node, MatrixEntry]) -> Exact:
        return replace(self, state={**self.state, **more})


def at(field: NumberField, rows: Sequence[Sequence[Scalar]]) -> Entries:
    """A matrix of graph scalars at the state."""
    flat = iter(field.of([x for row in rows for x in row]))
    return [[next(flat) for _ in row] for row in rows]


def matrix_product(field: NumberField, A: Entries, B: Entries) -> Entries:
    """A B."""
    if _is_one(A) or _is_one(B):
        return [[0 if is_zero(x) else field.tidy(x) for x in row] for row in (B if _is_one(A) else A)]
    columns = [[None if is_zero(y) else y for y in column] for column in zip(*B, strict=True)]
    rows = [[(k, x) for k, x in enumerate(row) if not is_zero(x)] for row in A]
    return [[field.tidy(_inner(row, column)) for column in columns] for row in rows]


def _inner(row: list[tuple[int, MatrixEntry]], column: list[MatrixEntry | None]) -> MatrixEntry:
    """The sum of what is not 0 in the row, each by its place, times what is not in the column."""
    return sum([x * column[k] for k, x in row if column[k] is not None], start=0)


def _is_one(A: Entries) -> bool:
    """Whether A is the unit matrix, written so."""
    n = len(A)
    return n > 0 and all(
        len(row) == n and all(type(x) is int and x == (i == j) for j, x in enumerate(row)) for i, row in enumerate(A)
    )


def matrix_sum(field: NumberField, *matrices: Entries) -> Entries:
    """A + B + ..."""
    rows = zip(*matrices, strict=True)
    return [[field.tidy(sum(x, start=0)) for x in zip(*row, strict=True)] for row in rows]


def negative(A: Entries) -> Entries:
    return [[-x for x in row] for row in A]


def matrix_transposed(A: Entries, columns: int) -> Entries:
    """A transposed; `columns` of A, where it may have no rows."""
    return [[row[j] for row in A] for j in range(columns)]


def matrix_solution(field: NumberField, A: Entries, B: Entries) -> Entries:
    """X of A X = B. A has full column rank; rows beyond that follow from the others, and are not looked at.

    Raises:
        DerivationError: the rank is less.
    """
    rows = [[*a, *b] for a, b in zip(A, B, strict=True)]
    unknowns = len(A[0]) if A else 0
    for k in range(unknowns):
        pivot = max(range(k, len(rows)), key=lambda i: (field.size(rows[i][k]), -i))
        rows[k], rows[pivot] = rows[pivot], rows[k]
        if is_zero(rows[k][k]):
            what = "linearize: something moves no mass at the place of reference: its accelerations are not determined"
            raise DerivationError(what, mend="take coordinates that are regular there, or another place")
        rows[k] = [field.tidy(over(x, rows[k][k])) for x in rows[k]]
        for i, row in enumerate(rows):
            if i != k and not is_zero(row[k]):
                rows[i] = [field.tidy(x - row[k] * y) for x, y in zip(row, rows[k], strict=True)]
    return [row[unknowns:] for row in rows[:unknowns]]
