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

from functools import cached_property

from eomgen.mechanics.small_motions.field import (
    Entries,
    MatrixEntry,
    NumberField,
    at,
    matrix_product,
    matrix_solution,
    matrix_sum,
    matrix_transposed,
    negative,
)
from eomgen.mechanics.small_motions.first_order import Choice, FirstOrder
from eomgen.records import dataclass
from eomgen.symbolic.expression.functions import inner
from eomgen.symbolic.expression.graph import Node
from eomgen.symbolic.numeric.tolerances import SOLVED


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
    M: Entries
    C: Entries
    K: Entries
    B: Entries
    F: Entries
    E: Entries
    P: Entries


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
    field: NumberField

    @cached_property
    def J(self) -> Entries:
        """The closing rows that are looked at; the others follow from them."""
        return at(self.field, [self.first.equations.J[i] for i in self.choice.ties])

    @cached_property
    def M(self) -> Entries:
        return at(self.field, self.first.equations.M)

    def following(self, right: Entries) -> Entries:
        """x of all speeds with x_i = 0 and J x + right = 0."""
        choice = self.choice
        J_d = [[row[k] for k in choice.du] for row in self.J]
        found = matrix_solution(self.field, J_d, negative(right)) if choice.du else []
        width = len(right[0]) if right else 0
        by_speed = dict(zip(choice.du, found, strict=True))
        return [by_speed.get(k, [0] * width) for k in range(len(self.first.system.symbols.u))]

    @cached_property
    def a(self) -> list[MatrixEntry]:
        """Accelerations, the independent ones 0: J a + gamma = 0."""
        if not self.choice.ties:
            return [0] * len(self.first.system.symbols.u)
        gamma = self.field.of([self.first.equations.gamma[i] for i in self.choice.ties])
        return [row[0] for row in self.following([[x] for x in gamma])]

    @cached_property
    def forces(self) -> list[MatrixEntry]:
        """M a - forcing: what the ties must push."""
        forcing = self.field.of(self.first.equations.forcing)
        return [self.field.tidy(inner(row, self.a) - x) for row, x in zip(self.M, forcing, strict=True)]

    @cached_property
    def lam(self) -> list[MatrixEntry]:
        """Multipliers by J_d^T lam = M a - forcing; 0 of rows that follow from others."""
        choice = self.choice
        J_d = [[row[k] for row in self.J] for k in choice.du]
        found = matrix_solution(self.field, J_d, [[self.forces[k]] for k in choice.du]) if choice.du else []
        by_row = dict(zip(choice.ties, (row[0] for row in found), strict=True))
        return [by_row.get(i, 0) for i in range(len(self.first.equations.J))]

    @cached_property
    def unbalanced(self) -> list[MatrixEntry]:
        """Z^T (M a - forcing): what accelerates the independent speeds."""
        return [self.field.tidy(inner(column, self.forces)) for column in matrix_transposed(self.Z, len(self.choice.u))]

    # -- to first order ------------------------------------------------------------------------------------

    @cached_property
    def _whole(self) -> NumberField:
        """The state with accelerations and multipliers."""
        symbols = self.first.system.symbols
        known = dict(zip(symbols.a, self.a, strict=True)) | dict(zip(symbols.lam, self.lam, strict=True))
        return self.field.with_values(known)

    def derivative(self, name: str) -> Entries:
        return at(self._whole, self.first.derivatives[name])

    def _closing(self, name: str) -> Entries:
        rows = self.first.derivatives[name]
        return at(self._whole, [rows[i] for i in self.choice.ties])

    @cached_property
    def Z(self) -> Entries:
        """du = Z du_i: J Z = 0."""
        n, kept = len(self.first.system.symbols.u), self.choice.u
        found = self.following([[row[k] for k in kept] for row in self.J]) if self.choice.ties else []
        place = {k: j for j, k in enumerate(kept)}
        return [[int(place[k] == j) for j in range(len(kept))] if k in place else found[k] for k in range(n)]

    @cached_property
    def P(self) -> Entries:
        """dq = P dq_i: G P = 0."""
        choice, n = self.choice, len(self.first.system.symbols.q)
        G = [self.first.derivatives["G"][i] for i in choice.relations]
        entries = at(self._whole, G)
        G_d = [[row[k] for k in choice.dq] for row in entries]
        G_i = [[-row[k] for k in choice.q] for row in entries]
        found = dict(zip(choice.dq, matrix_solution(self.field, G_d, G_i), strict=True)) if choice.dq else {}
        place = {k: j for j, k in enumerate(choice.q)}
        return [[int(place[k] == j) for j in range(len(choice.q))] if k in place else found[k] for k in range(n)]

    @cached_property
    def equations(self) -> LinearEquations:
        """The equations of small motions."""
        field, choice, symbols = self.field, self.choice, self.first.system.symbols
        Z, P, n = self.Z, self.P, len(symbols.u)
        R_q, R_u = self.derivative("R_q"), self.derivative("R_u")
        Y = [[0] * len(choice.q)] * n
        X_q, X_u = Y, [[0] * len(choice.u)] * n
        if choice.ties:
            A_u = self._closing("A_u")
            Y = self.following(matrix_product(field, self._closing("V_q"), P))
            X_q = self.following(
                matrix_sum(field, matrix_product(field, self._closing("A_q"), P), matrix_product(field, A_u, Y))
            )
            X_u = self.following(matrix_product(field, A_u, Z))
        Z_T = matrix_transposed(Z, len(choice.u))
        K = matrix_sum(
            field, matrix_product(field, R_q, P), matrix_product(field, R_u, Y), matrix_product(field, self.M, X_q)
        )
        C = matrix_sum(field, matrix_product(field, R_u, Z), matrix_product(field, self.M, X_u))
        N = at(field, self.first.system.scope.N)
        rates = matrix_sum(field, matrix_product(field, self.derivative("S_q"), P), matrix_product(field, N, Y))
        return LinearEquations(
            tuple(symbols.q[k] for k in choice.q),
            tuple(symbols.u[k] for k in choice.u),
            tuple(symbols.inputs.values()),
            symbols.q,
            matrix_product(field, Z_T, matrix_product(field, self.M, Z)),
            matrix_product(field, Z_T, C),
            matrix_product(field, Z_T, K),
            matrix_product(field, Z_T, self.derivative("W")),
            [rates[k] for k in choice.q],
            matrix_product(field, [N[k] for k in choice.q], Z),
            P,
        )


def dependent_speeds(first: FirstOrder, choice: Choice, field: NumberField) -> dict[Node, MatrixEntry]:
    """The dependent speeds by J u + sigma = 0, from the independent ones of the state."""
    if not choice.ties:
        return {}
    there, u = Reducing(first, choice, field), first.system.symbols.u
    independent = [[x] for x in field.of([u[k] for k in choice.u])]
    sigma = field.of([first.equations.sigma[i] for i in choice.ties])
    pushed = matrix_product(field, [[row[k] for k in choice.u] for row in there.J], independent)
    found = there.following([[field.tidy(x[0] + s)] for x, s in zip(pushed, sigma, strict=True)])
    return {u[k]: found[k][0] for k in choice.du}


def unsettled(reducing: Reducing, share: float) -> list[int]:
    """Which of the independent speeds a force is left to accelerate: more than rounding leaves.

    Args:
        share: of the largest force, below which one is none.
    """
    found = reducing.unbalanced
    scale = max(map(abs, (*reducing.field.of(reducing.first.equations.forcing), *reducing.forces)), default=0)
    left = [i for i, x in enumerate(found) if abs(x) > share * scale]
    if not left:
        return []
    e = reducing.equations
    places, speeds = ([max(1.0, abs(x)) for x in reducing.field.of(part)] for part in (e.coordinates, e.speeds))
    rows = [_size(K, places) + _size(C, speeds) + _size(M, speeds) for K, C, M in zip(e.K, e.C, e.M, strict=True)]
    return [i for i in left if abs(found[i]) > SOLVED * rows[i]]


def _size(row: list[MatrixEntry], unit: list[float]) -> float:
    return float(sum(abs(x) * one for x, one in zip(row, unit, strict=True)))
