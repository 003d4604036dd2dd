"""Reference -> LinearEquations: the equations of motion to first order, ties and dependent speeds taken out.

With a' the accelerations and lam the multipliers of the reference, small motions satisfy

    M da + R_q dq + R_u du = J^T dlam + W dw,        R = M a - forcing - J^T lam
    dq' = S_q dq + N du,                             q' = N u + nu
    J du + V_q dq = 0,                               J u + sigma = 0
    J da + A_q dq + A_u du = 0,                      J a + gamma = 0
    G dq = 0,                                        relations between positions

R_q holds M_q a and the curvature of the ties, -lam d2phi. With independent dq_i and du_i

    dq = P dq_i,   du = Z du_i + Y dq_i,   da = Z da_i + X_q dq_i + X_u du_i,   J Z = 0

and Z^T in front, by which dlam goes:

    M_r da_i + C du_i + K dq_i = B dw,     dq_i' = F dq_i + E du_i
    M_r = Z^T M Z,   C = Z^T (R_u Z + M X_u),   K = Z^T (R_q P + R_u Y + M X_q)
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from eomgen.mechanics.assembly import Assembly
from eomgen.mechanics.closed_instant import position_equations
from eomgen.mechanics.formulations import recursive
from eomgen.mechanics.friction import with_friction
from eomgen.mechanics.loads import start_value
from eomgen.mechanics.small_motions.field import (
    Entry,
    Field,
    Matrix,
    Numbers,
    at,
    negative,
    product,
    solved,
    total,
    turned,
)
from eomgen.mechanics.small_motions.reference import Reference
from eomgen.mechanics.system import System
from eomgen.mechanics.wellposed import refuse_massless
from eomgen.symbolic import dense
from eomgen.symbolic.derivative import depends_on, jacobian
from eomgen.symbolic.functions import inner
from eomgen.symbolic.graph import Node, Scalar

RANK = 1e-9  # of balanced rows, below which one follows from others
REST = 1e-9  # of a force that nothing balances, against the largest

Rows = Sequence[Sequence[Scalar]]


@dataclass(frozen=True)
class LinearEquations:
    """M du_i' + C du_i + K dq_i = B dw,  dq_i' = F dq_i + E du_i.

    Args:
        coordinates: q_i.
        speeds: u_i.
        inputs: w.
        all: every coordinate, dq = P dq_i.
    """

    coordinates: tuple[Node, ...]
    speeds: tuple[Node, ...]
    inputs: tuple[Node, ...]
    all: tuple[Node, ...]
    M: Matrix
    C: Matrix
    K: Matrix
    B: Matrix
    F: Matrix
    E: Matrix
    P: Matrix


@dataclass(frozen=True)
class Choice:
    """What stays independent, and which rows are solved for the rest.

    Args:
        q, dq: coordinates that stay, and those that follow by the rows `relations`.
        u, du: speeds that stay, and those that follow by the closing rows `ties`.
    """

    q: tuple[int, ...]
    dq: tuple[int, ...]
    relations: tuple[int, ...]
    u: tuple[int, ...]
    du: tuple[int, ...]
    ties: tuple[int, ...]


@dataclass(frozen=True)
class FirstOrder:
    """The equations of motion of a system, and their first derivatives, as graph scalars.

    Args:
        system: the system.
        relations: what is known between positions: they vanish.
    """

    system: System
    relations: tuple[Scalar, ...]

    @cached_property
    def assembly(self) -> Assembly:
        assembly = with_friction(self.system, recursive.assemble(self.system))
        refuse_massless(assembly)
        return assembly

    @cached_property
    def residual(self) -> tuple[Scalar, ...]:
        """M a - forcing - J^T lam."""
        graph, symbols = self.assembly, self.system.symbols
        pushes = list(zip(*graph.J, strict=True)) if graph.J else [()] * len(graph.M)
        return tuple(
            inner(row, symbols.a) - force - inner(push, symbols.lam)
            for row, force, push in zip(graph.M, graph.forcing, pushes, strict=True)
        )

    @cached_property
    def rows(self) -> tuple[tuple[Scalar, ...], tuple[Scalar, ...]]:
        """(J u + sigma, J a + gamma)."""
        graph, symbols = self.assembly, self.system.symbols
        velocities = tuple(inner(row, symbols.u) + bias for row, bias in zip(graph.J, graph.sigma, strict=True))
        return velocities, tuple(inner(row, symbols.a) + bias for row, bias in zip(graph.J, graph.gamma, strict=True))

    @cached_property
    def derivatives(self) -> Mapping[str, Rows]:
        """R_q, R_u, S_q, V_q, A_q, A_u, G, W by name."""
        symbols = self.system.symbols
        q, u, w = symbols.q, symbols.u, tuple(symbols.inputs.values())
        velocities, accelerations = self.rows
        return {
            "R_q": jacobian(self.residual, q), "R_u": jacobian(self.residual, u),
            "S_q": jacobian(self.system.scope.rates, q), "V_q": jacobian(velocities, q),
            "A_q": jacobian(accelerations, q), "A_u": jacobian(accelerations, u),
            "G": (*jacobian(self.relations, q), *_held(self.system)),
            "W": [[-x for x in row] for row in jacobian(self.residual, w)],
        }  # fmt: skip


def first_order_of(system: System) -> FirstOrder:
    """The equations of a system to first order."""
    scope = system.scope
    start = {q: start_value(scope, scope.model.coordinates[q.name]) for q in scope.symbols.q}
    relations = [x for x in position_equations(system, start) if depends_on(x, scope.symbols.q)]
    return FirstOrder(system, tuple(relations))


def _held(system: System) -> list[list[Scalar]]:
    """A row for each driven coordinate: it moves as given, and not otherwise."""
    q, coordinates = system.symbols.q, system.scope.model.coordinates
    return [[int(x is y) for y in q] for x in q if coordinates[x.name].driven]


# -- accelerations and multipliers of the reference -------------------------------------------------------


@dataclass(frozen=True)
class Reducing:
    """The equations at one state of the reference.

    Args:
        first: the equations.
        choice: what stays independent.
        field: q, u, t, inputs and parameters at the state.
    """

    first: FirstOrder
    choice: Choice
    field: Field

    @cached_property
    def J(self) -> Matrix:
        """The closing rows that are looked at; the others follow from them."""
        return at(self.field, [self.first.assembly.J[i] for i in self.choice.ties])

    @cached_property
    def M(self) -> Matrix:
        return at(self.field, self.first.assembly.M)

    def following(self, right: Matrix) -> Matrix:
        """x of all speeds with x_i = 0 and J x + right = 0."""
        choice = self.choice
        J_d = [[row[k] for k in choice.du] for row in self.J]
        found = solved(self.field, J_d, negative(right)) if choice.du else []
        width = len(right[0]) if right else 0
        by_speed = dict(zip(choice.du, found, strict=True))
        return [by_speed.get(k, [0] * width) for k in range(len(self.first.system.symbols.u))]

    @cached_property
    def a(self) -> list[Entry]:
        """Accelerations, the independent ones 0: J a + gamma = 0."""
        if not self.choice.ties:
            return [0] * len(self.first.system.symbols.u)
        gamma = self.field.of([self.first.assembly.gamma[i] for i in self.choice.ties])
        return [row[0] for row in self.following([[x] for x in gamma])]

    @cached_property
    def forces(self) -> list[Entry]:
        """M a - forcing: what the ties must push."""
        forcing = self.field.of(self.first.assembly.forcing)
        return [self.field.tidy(inner(row, self.a) - x) for row, x in zip(self.M, forcing, strict=True)]

    @cached_property
    def lam(self) -> list[Entry]:
        """Multipliers by J_d^T lam = M a - forcing; 0 of rows that follow from others."""
        choice = self.choice
        J_d = [[row[k] for row in self.J] for k in choice.du]
        found = solved(self.field, J_d, [[self.forces[k]] for k in choice.du]) if choice.du else []
        by_row = dict(zip(choice.ties, (row[0] for row in found), strict=True))
        return [by_row.get(i, 0) for i in range(len(self.first.assembly.J))]

    @cached_property
    def unbalanced(self) -> list[Entry]:
        """Z^T (M a - forcing): what accelerates the independent speeds."""
        return [self.field.tidy(inner(column, self.forces)) for column in turned(self.Z, len(self.choice.u))]

    # -- to first order ------------------------------------------------------------------------------------

    @cached_property
    def _whole(self) -> Field:
        """The state with accelerations and multipliers."""
        symbols = self.first.system.symbols
        known = dict(zip(symbols.a, self.a, strict=True)) | dict(zip(symbols.lam, self.lam, strict=True))
        return self.field.with_values(known)

    def derivative(self, name: str) -> Matrix:
        return at(self._whole, self.first.derivatives[name])

    def _closing(self, name: str) -> Matrix:
        rows = self.first.derivatives[name]
        return at(self._whole, [rows[i] for i in self.choice.ties])

    @cached_property
    def Z(self) -> Matrix:
        """du = Z du_i: J Z = 0."""
        n, kept = len(self.first.system.symbols.u), self.choice.u
        found = self.following([[row[k] for k in kept] for row in self.J]) if self.choice.ties else []
        place = {k: j for j, k in enumerate(kept)}
        return [[int(place[k] == j) for j in range(len(kept))] if k in place else found[k] for k in range(n)]

    @cached_property
    def P(self) -> Matrix:
        """dq = P dq_i: G P = 0."""
        choice, n = self.choice, len(self.first.system.symbols.q)
        G = [self.first.derivatives["G"][i] for i in choice.relations]
        entries = at(self._whole, G)
        G_d = [[row[k] for k in choice.dq] for row in entries]
        G_i = [[-row[k] for k in choice.q] for row in entries]
        found = dict(zip(choice.dq, solved(self.field, G_d, G_i), strict=True)) if choice.dq else {}
        place = {k: j for j, k in enumerate(choice.q)}
        return [[int(place[k] == j) for j in range(len(choice.q))] if k in place else found[k] for k in range(n)]

    def equations(self) -> LinearEquations:
        """The equations of small motions."""
        field, choice, symbols = self.field, self.choice, self.first.system.symbols
        Z, P, n = self.Z, self.P, len(symbols.u)
        R_q, R_u = self.derivative("R_q"), self.derivative("R_u")
        Y = [[0] * len(choice.q)] * n
        X_q, X_u = Y, [[0] * len(choice.u)] * n
        if choice.ties:
            A_u = self._closing("A_u")
            Y = self.following(product(field, self._closing("V_q"), P))
            X_q = self.following(total(field, product(field, self._closing("A_q"), P), product(field, A_u, Y)))
            X_u = self.following(product(field, A_u, Z))
        Z_T = turned(Z, len(choice.u))
        K = total(field, product(field, R_q, P), product(field, R_u, Y), product(field, self.M, X_q))
        C = total(field, product(field, R_u, Z), product(field, self.M, X_u))
        N = at(field, self.first.system.scope.N)
        rates = total(field, product(field, self.derivative("S_q"), P), product(field, N, Y))
        return LinearEquations(
            tuple(symbols.q[k] for k in choice.q), tuple(symbols.u[k] for k in choice.u),
            tuple(symbols.inputs.values()), symbols.q,
            product(field, Z_T, product(field, self.M, Z)), product(field, Z_T, C), product(field, Z_T, K),
            product(field, Z_T, self.derivative("W")),
            [rates[k] for k in choice.q], product(field, [N[k] for k in choice.q], Z), P,
        )  # fmt: skip


# -- what stays independent --------------------------------------------------------------------------------


def choice_of(first: FirstOrder, reference: Reference, wanted: Sequence[str]) -> Choice:
    """Coordinates and speeds that stay: those wanted, then the model's own, then the others.

    Args:
        wanted: names of coordinates that are to stay where they can.
    """
    field = Numbers(reference.numbers)
    symbols, coordinates = first.system.symbols, reference.system.scope.model.coordinates
    dependent = {name for name, part in coordinates.items() if part.dependent}

    def late(name: str, rows: Rows, k: int) -> tuple[int, bool]:
        """Of what is solved first: of the model's dependent ones; of others those with coefficients that stay."""
        stays = not any(depends_on(row[k], symbols.q) for row in rows)
        return 0 if name in wanted else 2 if name in dependent else 1, stays

    G, J = first.derivatives["G"], first.assembly.J
    relations, dq = _determined(_floats(at(field, G), len(symbols.q)),
                                [late(q.name, G, k) for k, q in enumerate(symbols.q)])  # fmt: skip
    ties, du = _determined(_floats(at(field, J), len(symbols.u)),
                           [late(u.name.removesuffix("'"), J, k) for k, u in enumerate(symbols.u)])  # fmt: skip
    q = tuple(k for k in range(len(symbols.q)) if k not in dq)
    u = tuple(k for k in range(len(symbols.u)) if k not in du)
    return Choice(q, dq, relations, u, du, ties)


def _floats(A: Matrix, columns: int) -> np.ndarray:
    return np.array(A, dtype=float).reshape(len(A), columns)


def _determined(A: np.ndarray, late: Sequence[tuple[int, bool]]) -> tuple[tuple[int, ...], tuple[int, ...]]:
    """(independent rows, columns that they determine): of those first that are late, the last of them first."""
    if not len(A):
        return (), ()
    scaled = dense.balanced(A)[0]
    rows = dense.independent_rows(scaled, RANK)
    chosen: list[int] = []
    for k in sorted(range(A.shape[1]), key=lambda k: (late[k], k), reverse=True):
        if len(chosen) < len(rows) and dense.rank(scaled[rows][:, [*chosen, k]].T, smallest=RANK) > len(chosen):
            chosen.append(k)
    return tuple(rows), tuple(sorted(chosen))
