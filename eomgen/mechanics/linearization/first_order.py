"""System -> FirstOrder: its equations of motion with their first derivatives, exact or as numbers."""

from __future__ import annotations

from collections.abc import Collection, Iterable, Mapping, Sequence
from dataclasses import field as dataclass_field
from dataclasses import replace
from functools import cached_property
from random import Random
from typing import Any, Protocol

import numpy as np

from eomgen.errors import DerivationError
from eomgen.frozen import dataclass
from eomgen.mechanics.dynamics.system import EquationsOfMotion, System
from eomgen.mechanics.dynamics.wellposed import refuse_massless
from eomgen.mechanics.free_bodies.friction import equations_of_motion
from eomgen.mechanics.integrals.laws import position_equations
from eomgen.mechanics.kinematics.scene import start_values
from eomgen.mechanics.linearization.reference import ReferenceMotion
from eomgen.symbolic.exact.normal_form import simplest
from eomgen.symbolic.expression.derivative import depends_on, jacobian, substituted, symbols_of
from eomgen.symbolic.expression.formula import inner, over
from eomgen.symbolic.expression.node import Node, Scalar, ScalarRows, is_zero
from eomgen.symbolic.numeric import dense
from eomgen.symbolic.numeric.evaluation import FLOAT, evaluate, fifty_digits, floats_of
from eomgen.symbolic.numeric.tolerances import RANK, ROUNDING, SOLVED
from eomgen.symbolic.numeric.work import Work
from eomgen.symbolic.solve.solving import vanishes

# -------- first order -----------------------------------------------------------------------------------------
# System -> FirstOrder: its equations of motion with their first derivatives, and what may stay independent.


OWN = 0.2  # of what a column adds to those chosen, against the best


@dataclass(frozen=True)
class Choice:
    """The independent coordinates and speeds, and the rows that are solved for the dependent ones.

    Args:
        q, dq: independent coordinates, and the dependent ones, given by the rows `relations`.
        u, du: independent speeds, and the dependent ones, given by the velocity rows `constraints`.
        standing: True if small turns of spinning bodies are about axes fixed in space; else about body axes.
    """

    q: tuple[int, ...]
    dq: tuple[int, ...]
    relations: tuple[int, ...]
    u: tuple[int, ...]
    du: tuple[int, ...]
    constraints: tuple[int, ...]
    standing: bool = False


@dataclass(frozen=True)
class FirstOrder:
    """The equations of motion of a system, and their first derivatives, as graph scalars.

    Args:
        system: the system.
        relations: what is known between positions: they vanish.
        at_rest: whether it is looked at where all speeds are 0 alone: what holds none of them is far shorter.
    """

    system: System
    relations: tuple[Scalar, ...]
    at_rest: bool = False

    @cached_property
    def equations(self) -> EquationsOfMotion:
        equations = equations_of_motion(self.system)
        refuse_massless(equations)
        return equations

    def looked_at(self, *, at_rest: bool) -> FirstOrder:
        """The same equations for states at rest, or for moving ones, without a new derivation."""
        if at_rest == self.at_rest:
            return self
        found = replace(self, at_rest=at_rest)
        found.__dict__["equations"] = self.equations
        return found

    @cached_property
    def residual(self) -> tuple[Scalar, ...]:
        """M a - forcing - J^T lam."""
        return self.equations.residual[0]

    @cached_property
    def seen(self) -> frozenset[str]:
        """The names of symbols in the equations of motion."""
        e = self.equations
        rows = (*e.M, e.forcing, *e.J, e.sigma, e.gamma)
        return frozenset(x.name for x in symbols_of(x for row in rows for x in row))

    @cached_property
    def held(self) -> frozenset[Node]:
        """Symbols that occur in the equations of motion, in the rates and in the relations."""
        scope, rows = self.system.scope, (*self.equations.M, *self.equations.J, *self.rows)
        entries = (x for row in (*rows, *scope.N) for x in row)
        return frozenset(symbols_of((*entries, *self.residual, *scope.rates, *self.relations)))

    @cached_property
    def rows(self) -> tuple[tuple[Scalar, ...], tuple[Scalar, ...]]:
        """(J u + sigma, J a + gamma)."""
        graph, symbols = self.equations, self.system.symbols
        velocities = tuple(inner(row, symbols.u) + bias for row, bias in zip(graph.J, graph.sigma, strict=True))
        return velocities, self.equations.residual[1]

    @cached_property
    def derivatives(self) -> Mapping[str, ScalarRows]:
        """R_q, R_u, S_q, V_q, A_q, A_u, G, W by name."""
        symbols = self.system.symbols
        q, u, w = symbols.q, symbols.u, tuple(symbols.inputs.values())
        velocities, accelerations = self.rows
        unmoved, still = self._unmoved, dict.fromkeys(u, 0) if self.at_rest else {}

        def by_places(rows: Sequence[Scalar]) -> ScalarRows:
            return jacobian(substituted(rows, unmoved | still), q)

        return {
            "R_q": by_places(self.residual),
            "R_u": jacobian(substituted(self.residual, unmoved), u),
            "S_q": by_places(self.system.scope.rates),
            "V_q": by_places(velocities),
            "A_q": by_places(accelerations),
            "A_u": jacobian(substituted(accelerations, unmoved), u),
            "G": (*jacobian(self.relations, q), *_held(self.system)),
            "W": [[-x for x in row] for row in jacobian(self.residual, w)],
        }

    @cached_property
    def _unmoved(self) -> dict[Node, Scalar]:
        """Accelerations that are 0 in every state considered: all of them at rest, if no constraint needs one."""
        e, s = self.equations, self.system.symbols
        requested = substituted(e.gamma, dict.fromkeys(s.u, 0))
        return dict.fromkeys(s.a, 0) if self.at_rest and all(map(is_zero, requested)) else {}


def first_order_of(system: System) -> FirstOrder:
    """The equations of a system to first order."""
    scope = system.scope
    relations = [x for x in position_equations(system, start_values(scope)) if depends_on(x, scope.symbols.q)]
    relations += [sum((e * e for e in four), start=-1) for four in scope.quaternions]
    return FirstOrder(system, tuple(relations))


def _held(system: System) -> list[list[Scalar]]:
    """A row for each driven coordinate: it moves as given, and not otherwise."""
    q, coordinates = system.symbols.q, system.scope.model.coordinates
    return [[int(x is y) for y in q] for x in q if coordinates[x.name].driven]


# -- what stays independent --------------------------------------------------------------------------------


def choice_of(first: FirstOrder, reference: ReferenceMotion, wanted: Sequence[str]) -> Choice:
    """Coordinates and speeds that stay: those wanted, then the model's own, then the others.

    Args:
        wanted: names of coordinates that are to stay where they can.
    """
    field = Numbers(reference.numbers)
    symbols, coordinates = first.system.symbols, reference.system.scope.model.coordinates
    dependent = {name for name, part in coordinates.items() if part.dependent}

    turning = {e.name: abs(float(reference.numbers[e])) for four in first.system.scope.quaternions for e in four}

    def late(name: str, stays: bool) -> tuple[int, float]:
        """Rank of a variable: those of the highest rank become dependent first.

        First the model's dependent ones; of the others those with constant coefficients, then those of coordinates on
        which nothing depends, such as the position of a wheel, whose velocity turns with it. Of a quaternion the
        largest of its four components.
        """
        usual = float(stays) + 0.5 * (name in coordinates and name not in first.seen)
        return 0 if name in wanted else 2 if name in dependent else 1, turning.get(name, usual)

    G, J = (_floats(at(field, rows), len(columns)) for rows, columns in _rows(first))
    elsewhere = Numbers(_elsewhere(reference))
    G_there, J_there = (_floats(at(elsewhere, rows), len(columns)) for rows, columns in _rows(first))
    relations, dq = determined(G, [late(q.name, stays) for q, stays in zip(symbols.q, _same(G, G_there), strict=True)])
    constraints, du = determined(
        J, [late(u.name.removesuffix("'"), stays) for u, stays in zip(symbols.u, _same(J, J_there), strict=True)]
    )
    q = tuple(k for k in range(len(symbols.q)) if k not in dq)
    u = tuple(k for k in range(len(symbols.u)) if k not in du)
    return Choice(q, dq, relations, u, du, constraints)


def _rows(first: FirstOrder) -> tuple[tuple[ScalarRows, Sequence[Node]], ...]:
    """The rows between positions, and those between speeds, with what their columns stand for."""
    symbols = first.system.symbols
    return (first.derivatives["G"], symbols.q), (first.equations.J, symbols.u)


def _elsewhere(reference: ReferenceMotion) -> dict[Node, Any]:
    """The state with other coordinates."""
    rng, number = Random(4), fifty_digits().number(1)
    return {
        **reference.numbers,
        **{q: reference.numbers[q] + number * rng.uniform(0.01, 0.1) for q in reference.system.symbols.q},
    }


def _same(A: np.ndarray, B: np.ndarray) -> np.ndarray:
    """True for each column that is the same in both matrices, up to rounding."""
    return np.asarray(np.all(abs(A - B) <= SOLVED * abs(A).max(initial=0), axis=0))


def _floats(A: Entries, columns: int) -> np.ndarray:
    return np.array(A, dtype=float).reshape(len(A), columns)


def determined(A: np.ndarray, late: Sequence[tuple[int, float]]) -> tuple[tuple[int, ...], tuple[int, ...]]:
    """(independent rows, columns that they determine): of those first that are late, the last of them first.

    A column that the others nearly make up, against the best of those as late, waits for these.
    """
    if not len(A):
        return (), ()
    scaled = dense.balanced(dense.without_noise(A, ROUNDING, axis=1))[0]
    rows = dense.independent_rows(scaled, RANK)
    left = scaled[rows].copy()
    chosen: list[int] = []
    for rank in sorted({*late}, reverse=True):
        waiting = [k for k in reversed(range(A.shape[1])) if late[k] == rank]
        while waiting and len(chosen) < len(rows):
            sizes = np.linalg.norm(left[:, waiting], axis=0)
            if max(sizes) <= RANK:
                break
            k = next(k for k, size in zip(waiting, sizes, strict=True) if size >= OWN * max(sizes))
            waiting.remove(k)
            chosen.append(k)
            direction = left[:, k] / np.linalg.norm(left[:, k])
            left -= np.outer(direction, direction @ left)
    return tuple(rows), tuple(sorted(chosen))


# -------- field -----------------------------------------------------------------------------------------------
# Graph scalars at one state, exact or as numbers, and the little algebra of matrices that holds for both.
#
# The laws of small motions are written once, over entries that are either exact scalars of the parameters or floats.


MOST_TERMS = 60  # of an entry that is multiplied out however short it came: more fill more than a formula's lines
MatrixEntry = Any  # an exact scalar, or a float
Entries = list[list[MatrixEntry]]


class NumberField(Protocol):
    """Source of the entries of the matrices: exact scalars, or numbers at one state."""

    def of(self, scalars: Iterable[Scalar]) -> list[MatrixEntry]:
        """The scalars at the state."""

    def tidy(self, x: MatrixEntry) -> MatrixEntry:
        """An entry in the form in which it is used further; 0 where it vanishes."""

    def size(self, x: MatrixEntry) -> float:
        """|x|, by which a pivot is chosen."""

    def with_values(self, more: Mapping[Node, MatrixEntry]) -> NumberField:
        """The field with more symbols known."""


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
    """True if A is written as the unit matrix, in integers."""
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
            raise DerivationError(what, fix="take coordinates that are regular there, or another place")
        rows[k] = [field.tidy(over(x, rows[k][k])) for x in rows[k]]
        for i, row in enumerate(rows):
            if i != k and not is_zero(row[k]):
                rows[i] = [field.tidy(x - row[k] * y) for x, y in zip(row, rows[k], strict=True)]
    return [row[unknowns:] for row in rows[:unknowns]]


# -------- slopes ----------------------------------------------------------------------------------------------
# EquationsOfMotion -> A, B of dx' = A dx + B dw at any state, in numbers.
#
# K [da; dlam] = -[R_q dq + R_u du - W dw; A_q dq + A_u du],   K = [M, -J^T; J, 0],   dq' = S_q dq + N du


def slopes_at(first: FirstOrder, state: Mapping[Node, Any], *, single: bool = False) -> tuple[np.ndarray, np.ndarray]:
    """(d x'/d x, d x'/d w) at a state, x = (q, u); where constraints follow from others their multipliers are the
    least.

    Args:
        state: t, parameters, inputs, q and u as floats.
        single: nan where a change opens constraints that follow from others: no acceleration then closes them all.
    """
    e, s = first.equations, first.system.symbols
    nq, nu, k, w = len(s.q), len(s.u), len(e.J), len(s.inputs)
    M, J, N = _matrix(state, e.M, nu), _matrix(state, e.J, nu), _matrix(state, e.N, nu)
    K = np.block([[M, -J.T], [J, np.zeros((k, k))]])
    right = np.concatenate([_matrix(state, (e.forcing,), nu)[0], -_matrix(state, (e.gamma,), k)[0]])
    found = _solved(K, right, k)
    state = {**state, **dict(zip((*s.a, *s.lam), found.tolist(), strict=True))}
    columns = {"R_q": nq, "R_u": nu, "W": w, "A_q": nq, "A_u": nu, "S_q": nq}
    at = {name: _matrix(state, first.derivatives[name], n) for name, n in columns.items()}
    slopes = np.block([[at["R_q"], at["R_u"], -at["W"]], [at["A_q"], at["A_u"], np.zeros((k, w))]])
    changes = _solved(K, slopes, k)
    below = 0.0 - changes[:nu]
    if single:
        left = abs(K @ changes - slopes).max(axis=0, initial=0.0)
        below[:, left > RANK * (1.0 + abs(slopes).max(axis=0, initial=0.0))] = np.nan
    both = np.vstack([np.hstack([at["S_q"], N, np.zeros((nq, w))]), below])
    return both[:, : nq + nu], both[:, nq + nu :]


def _solved(K: np.ndarray, right: np.ndarray, constraints: int) -> np.ndarray:
    found: np.ndarray = np.linalg.lstsq(K, right, rcond=None)[0] if constraints else np.linalg.solve(K, right)
    return found


def _matrix(state: Mapping[Node, Any], rows: Sequence[Sequence[Scalar]], columns: int) -> np.ndarray:
    flat = evaluate([x for row in rows for x in row], state, FLOAT)
    return np.array(flat, dtype=float).reshape(len(rows), columns)
