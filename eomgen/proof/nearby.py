"""Equations, a state -> states beside it that the ties allow, and how the system moves on from each, at 50 digits.

    phi(q) = 0,   J u + sigma = 0               dependent coordinates and speeds follow the independent ones
    M a - J^T lam = forcing,   J a + gamma = 0

Everything is taken from the nonlinear equations: derivatives of them serve as slopes of a Newton iteration alone,
whose end does not depend on them.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from functools import cached_property
from typing import Any

from eomgen.mechanics.equations.equations_of_motion import EquationsOfMotion
from eomgen.records import dataclass
from eomgen.symbolic.expression.derivative import jacobian, symbols_of
from eomgen.symbolic.expression.graph import Node, Scalar
from eomgen.symbolic.numeric.dense import follows_in_digits
from eomgen.symbolic.numeric.evaluation import NoValue, evaluate, fifty_digits, solved_quickly
from eomgen.symbolic.numeric.tolerances import MET_AT_50, ZERO_AT_50

STEPS = 12  # of Newton's method with the slope of the start; from doubles two or three are taken

State = Mapping[Node, Any]
DigitRow = list[Any]


def solved_nearby(rows: Sequence[Sequence[Any]]) -> DigitRow | None:
    """x of consistent rows [A | b] by elimination with full pivots; None where A leaves an x open.

    Rows that follow from others are not looked at.
    """
    found = solved_quickly(rows)
    if found is not None:
        return found
    left = [_of_one_size(row) for row in rows]
    unknowns = len(rows[0]) - 1 if rows else 0
    chosen: list[tuple[int, Sequence[Any]]] = []
    columns = set(range(unknowns))
    while columns and left:
        i, k = max(((i, k) for i in range(len(left)) for k in columns), key=lambda at: abs(left[at[0]][at[1]]))
        row = left.pop(i)
        if abs(row[k]) < ZERO_AT_50:
            return None
        columns.remove(k)
        chosen.append((k, row))
        left = [_without(other, row, k) for other in left]
    if columns:
        return None
    x: DigitRow = [0] * unknowns
    for k, row in reversed(chosen):
        x[k] = (row[-1] - sum(row[j] * x[j] for j in range(unknowns) if j != k and row[j])) / row[k]
    return x


def _of_one_size(row: Sequence[Any]) -> Sequence[Any]:
    size = max(map(abs, row[:-1]), default=0)
    return [x / size for x in row] if size else row


def _without(row: Sequence[Any], pivot: Sequence[Any], k: int) -> Sequence[Any]:
    if not row[k]:
        return row
    factor = row[k] / pivot[k]
    return [0 if j == k else x - factor * y if y else x for j, (x, y) in enumerate(zip(row, pivot, strict=True))]


@dataclass(frozen=True)
class Going:
    """How a system moves on from a state.

    Args:
        state: q, u, t, inputs and parameters.
        q1, q2: q' and q''.
        a: u'.
    """

    state: State
    q1: Mapping[Node, Any]
    q2: Mapping[Node, Any]
    a: Mapping[Node, Any]


@dataclass(frozen=True)
class Nearby:
    """The states beside one of them.

    Args:
        equations: of motion.
        relations: what vanishes between positions.
        numbers: the state, all symbols with 50 digits.
        q, u: the coordinates and speeds that stay independent; driven coordinates are neither these nor sought.
    """

    equations: EquationsOfMotion
    relations: tuple[Scalar, ...]
    numbers: State
    q: tuple[Node, ...]
    u: tuple[Node, ...]

    def at(self, scalars: Sequence[Scalar], state: State) -> DigitRow:
        return evaluate(tuple(scalars), state, fifty_digits())

    def state(self, given: Mapping[Node, Any]) -> State:
        """The state in which some are as `given`, the dependent ones as the ties say.

        Raises:
            NoValue: the ties do not close there, or leave a coordinate or speed open.
        """
        state = self._closed({**self.numbers, **given})
        if not self._dependent_u:
            return state
        J, sigma = self._rows(state, self.equations.sigma)
        u, index = self.equations.symbols.u, {u: k for k, u in enumerate(self.equations.symbols.u)}
        columns = [index[x] for x in self._dependent_u]
        known = [k for k, x in enumerate(u) if x not in self._dependent_u]
        rows = [
            [*(row[k] for k in columns), -s - sum(row[k] * state[u[k]] for k in known)]
            for row, s in zip(J, sigma, strict=True)
        ]
        found = solved_nearby(rows)
        if found is None:
            raise NoValue("the ties do not determine the dependent speeds")
        return {**state, **dict(zip(self._dependent_u, found, strict=True))}

    def going(self, state: State) -> Going:
        """Accelerations by M a - J^T lam = forcing, J a + gamma = 0, and the rates of the coordinates.

        Raises:
            NoValue: the equations do not determine them.
        """
        symbols, graph = self.equations.symbols, self.equations
        n, k = len(graph.M), len(graph.J)
        flat = self.at([*(x for row in graph.M for x in row), *graph.forcing], state)
        J, gamma = self._rows(state, graph.gamma)
        rows = [[*flat[n * i : n * i + n], *(-J[r][i] for r in range(k)), flat[n * n + i]] for i in range(n)]
        rows += [[*row, *([0] * k), -g] for row, g in zip(J, gamma, strict=True)]
        a = _first(rows, n)
        if a is None:
            raise NoValue("the equations of motion are singular")
        moving = {**state, **dict(zip(symbols.a, a, strict=True))}
        rates = self.equations.system.scope.rates
        q1, q2 = self.at(rates, state), self.at(self.equations.system.scope.with_accelerations(rates), moving)
        return Going(
            state,
            dict(zip(symbols.q, q1, strict=True)),
            dict(zip(symbols.q, q2, strict=True)),
            dict(zip(symbols.u, a, strict=True)),
        )

    # -- the ties --------------------------------------------------------------------------------------------

    def _rows(self, state: State, bias: Sequence[Scalar]) -> tuple[list[DigitRow], DigitRow]:
        """(J, a bias of it) at a state."""
        J, n = self.equations.J, len(self.equations.M)
        flat = self.at([*(x for row in J for x in row), *bias], state)
        return [flat[n * i : n * i + n] for i in range(len(J))], flat[n * len(J) :]

    @cached_property
    def _dependent_u(self) -> tuple[Node, ...]:
        return tuple(x for x in self.equations.symbols.u if x not in self.u)

    @cached_property
    def _dependent_q(self) -> tuple[Node, ...]:
        """Those that stand in what is known between positions; others stay where they are."""
        coordinates, bound = self.equations.system.scope.model.coordinates, {*symbols_of(self.relations)}
        return tuple(q for q in self.equations.symbols.q if q in bound - {*self.q} and not coordinates[q.name].driven)

    @cached_property
    def _slopes(self) -> list[DigitRow]:
        """d relations/d dependent coordinates, at the state."""
        rows = jacobian(self.relations, self._dependent_q)
        flat, n = self.at([x for row in rows for x in row], self.numbers), len(self._dependent_q)
        return [flat[n * i : n * i + n] for i in range(len(rows))]

    def _closed(self, state: State) -> State:
        """The dependent coordinates by phi(q) = 0."""
        if not self._dependent_q:
            return state
        for _ in range(STEPS):
            open_ = self.at(self.relations, state)
            step = solved_nearby([[*row, -x] for row, x in zip(self._slopes, open_, strict=True)])
            if step is None:
                raise NoValue("the ties do not determine the dependent coordinates")
            state = {**state, **{q: state[q] + d for q, d in zip(self._dependent_q, step, strict=True)}}
            if all(abs(d) < MET_AT_50 * (1 + abs(state[q])) for q, d in zip(self._dependent_q, step, strict=True)):
                return state
        raise NoValue("the ties do not close beside the state")


def _first(rows: Sequence[Sequence[Any]], n: int) -> DigitRow | None:
    """The first n unknowns, the multipliers of rows that follow from others at 0; None where they are open."""
    found = solved_nearby(rows)
    if found is not None:
        return found[:n]
    kept, independent = list(range(n)), list[Sequence[Any]]()
    for r, row in enumerate(rows[n:], start=n):
        if not follows_in_digits(independent, row[:n]):
            independent.append(row[:n])
            kept.append(r)
    found = solved_nearby([[*(rows[i][j] for j in kept), rows[i][-1]] for i in kept]) if len(kept) < len(rows) else None
    return None if found is None else found[:n]
