"""Reference -> LinearEquations: the equations of motion to first order, constraints eliminated."""

from __future__ import annotations

from collections.abc import Collection, Mapping, Sequence
from dataclasses import field as dataclass_field
from dataclasses import replace
from functools import cached_property
from itertools import accumulate, pairwise
from typing import Any

import numpy as np

from eomgen.errors import DerivationError
from eomgen.frozen import dataclass
from eomgen.mechanics.dynamics import System
from eomgen.mechanics.linearization.reference import (
    Choice,
    FirstOrder,
    ReferenceMotion,
)
from eomgen.mechanics.state import At, Entries, NumberField
from eomgen.model import UnitQuaternion
from eomgen.symbolic.exact import Polynomial, cramer
from eomgen.symbolic.expression import Matrix, Node, Vector, is_zero, symbols_of
from eomgen.symbolic.numeric import fifty_digits, tolerances, without_noise

# -------- reduction -------------------------------------------------------------------------------------------
# Reference -> LinearEquations: the equations of motion to first order, constraints and dependent speeds eliminated.
#
# With a' the accelerations and lam the multipliers of the reference, small motions satisfy
#
#     M da + R_q dq + R_u du = J^T dlam + W dw,        R = M a - forcing - J^T lam
#     dq' = S_q dq + N du,                             q' = N u + nu
#     J du + V_q dq = 0,                               J u + sigma = 0
#     J da + A_q dq + A_u du = 0,                      J a + gamma = 0
#     G dq = 0,                                        relations between positions
#
# R_q holds M_q a and the curvature of the constraints, -lam d2phi. With independent dq_i and du_i
#
#     dq = P dq_i,   du = Z du_i + Y dq_i,   da = Z da_i + X_q dq_i + X_u du_i,   J Z = 0
#
# and Z^T in front, by which dlam goes:
#
#     M_r da_i + C du_i + K dq_i = B dw,     dq_i' = F dq_i + E du_i
#     M_r = Z^T M Z,   C = Z^T (R_u Z + M X_u),   K = Z^T (R_q P + R_u Y + M X_q)


LARGEST_PENCIL = 6  # rows of a determinant that is written out


@dataclass(frozen=True)
class LinearEquations:
    """M du_i' + C du_i + K dq_i = B dw,  dq_i' = F dq_i + E du_i + D dw.

    Args:
        coordinates: q_i, and after them the states of first order.
        speeds: u_i.
        inputs: w.
        all: every coordinate and state, dq = P dq_i.
        D: of the states, on whose rates inputs act; a row of each of q_i, 0 of a coordinate.
        states: of first order, among the coordinates.
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
    D: Entries = dataclass_field(default_factory=list)
    states: tuple[Node, ...] = ()

    @property
    def order(self) -> tuple[int, ...]:
        """Places of x = (q_i, u_i, z) among the coordinates, states and speeds as they stand here."""
        n = len(self.coordinates)
        own = [k for k, q in enumerate(self.coordinates) if q not in self.states]
        states = [k for k, q in enumerate(self.coordinates) if q in self.states]
        return (*own, *range(n, n + len(self.speeds)), *states)

    @property
    def moving(self) -> tuple[Node, ...]:
        """x = (q_i, u_i, z)."""
        every = (*self.coordinates, *self.speeds)
        return tuple(every[k] for k in self.order)

    def matrix(self, function: str) -> Entries:
        """The matrix of an output function: M of mass, C of damping, K of stiffness."""
        return {"mass": self.M, "damping": self.C, "stiffness": self.K}[function]

    @property
    def laplace_variable(self) -> Node:
        """A symbol s that neither the entries nor the coordinates have."""
        entries = [x for A in (self.M, self.C, self.K, self.B, self.F, self.E, self.D) for row in A for x in row]
        taken = {x.name for x in (*symbols_of(entries), *self.all, *self.inputs)}
        return self.speeds[0].graph.symbol(next(name for name in ("s", "s_", "s__", "s___") if name not in taken))

    def characteristic_polynomial(self, positive: Collection[Node], *, in_full: bool = True) -> Polynomial | None:
        """p(s), common factors of its coefficients kept; None where it is too much work.

        p(s) = det [ s 1 - F,  -E ;  K,  s M + C ],      of second order  p(s) = det(s^2 M + s C + K)

        Args:
            in_full: whether it is brought into its shortest form however long it is.
        """
        s = self.laplace_variable
        pencil = self.pencil(s)
        return None if pencil is None else Polynomial.of(cramer.determinant(pencil), s, positive, in_full=in_full)

    def pencil(self, s: Node) -> Entries | None:
        """The matrix whose determinant is p(s); None where it is too large."""
        n = len(self.speeds)
        if is_second_order(self):
            if n > LARGEST_PENCIL:
                return None
            rows = zip(self.M, self.C, self.K, strict=True)
            return [[s * s * m + s * c + k for m, c, k in zip(*row, strict=True)] for row in rows]
        if n + len(self.coordinates) > LARGEST_PENCIL:
            return None
        F, E = self.F, self.E
        upper = [[s * int(i == j) - x for j, x in enumerate(row)] + [-x for x in E[i]] for i, row in enumerate(F)]
        return upper + [[*self.K[i], *(s * m + c for m, c in zip(self.M[i], self.C[i], strict=True))] for i in range(n)]

    @property
    def state_matrix(self) -> np.ndarray:
        """A of x' = A x, x = (q_i, u_i)."""
        M, C, K = (floats(x) for x in (self.M, self.C, self.K))
        return np.block([[floats(self.F), floats(self.E)], [-np.linalg.solve(M, K), -np.linalg.solve(M, C)]])


# -- accelerations and multipliers of the reference -------------------------------------------------------


@dataclass(frozen=True)
class Reducing:
    """The equations at one state of the reference, to first order.

    Args:
        first: the equations.
        choice: what stays independent.
        field: q, u, t, inputs and parameters at the state.
    """

    first: FirstOrder
    choice: Choice
    field: NumberField

    @cached_property
    def at(self) -> At:
        """Constraints, accelerations and multipliers at the state."""
        return At(self.first.equations, self.field, self.choice.speeds)

    @cached_property
    def _whole(self) -> NumberField:
        """The state with accelerations and multipliers."""
        symbols = self.first.system.symbols
        known = dict(zip(symbols.a, self.at.a, strict=True)) | dict(zip(symbols.lam, self.at.lam, strict=True))
        return self.field.with_values(known)

    def derivative(self, name: str) -> Entries:
        """A matrix of first derivatives, by its name."""
        return self._whole.matrix(self.first.derivatives[name])

    def _closing(self, name: str) -> Entries:
        rows = self.first.derivatives[name]
        return self._whole.matrix([rows[i] for i in self.choice.speeds.rows])

    @cached_property
    def P(self) -> Entries:
        """dq = P dq_i: G P = 0."""
        places = self.choice.places
        G = self._whole.matrix([self.first.derivatives["G"][i] for i in places.rows])
        return places.null_basis(self._whole, G)

    @cached_property
    def equations(self) -> LinearEquations:
        """The equations of small motions."""
        field, choice, symbols = self.field, self.choice, self.first.system.symbols
        at, P, n, z = self.at, self.P, len(symbols.u), symbols.z
        R_q, R_u = self.derivative("R_q"), self.derivative("R_u")
        Y = [[0] * len(choice.places.free)] * n
        X_q, X_u = Y, [[0] * len(choice.speeds.free)] * n
        if choice.speeds.rows:
            A_u = self._closing("A_u")
            Y = at.following(field.product(self._closing("V_q"), P))
            X_q = at.following(field.total(field.product(self._closing("A_q"), P), field.product(A_u, Y)))
            X_u = at.following(field.product(A_u, at.Z))
        K = field.total(field.product(R_q, P), field.product(R_u, Y), field.product(at.M, X_q))
        C = field.total(field.product(R_u, at.Z), field.product(at.M, X_u))
        N = field.matrix(self.first.system.scope.N)
        rates = field.total(field.product(self.derivative("S_q"), P), field.product(N, Y))
        found = LinearEquations(
            tuple(symbols.q[k] for k in choice.places.free),
            tuple(symbols.u[k] for k in choice.speeds.free),
            tuple(symbols.inputs.values()),
            symbols.q,
            at.along(field.product(at.M, at.Z)),
            at.along(C),
            at.along(K),
            at.along(self.derivative("W")),
            [rates[k] for k in choice.places.free],
            field.product([N[k] for k in choice.places.free], at.Z),
            P,
            [[0] * len(symbols.inputs) for _ in choice.places.free],
        )
        return self._with_states(found, (Y, X_q, X_u)) if z else found

    def _with_states(self, e: LinearEquations, follow: tuple[Entries, Entries, Entries]) -> LinearEquations:
        """The equations with the states of first order behind the coordinates.

        dz' = (Z_q P + Z_u Y + Z_a X_q) dq_i + (Z_u Z + Z_a X_u) du_i + Z_z dz + Z_a Z da_i + Z_w dw,

        da_i by M da_i + C du_i + K dq_i + Z^T R_z dz = B dw where the rates hold accelerations.

        Args:
            follow: Y, X_q, X_u of what follows: du = Z du_i + Y dq_i, da = Z da_i + X_u du_i + X_q dq_i.
        """
        field, at, z = self.field, self.at, self.first.system.symbols.z
        (Y, X_q, X_u), n, m = follow, len(e.coordinates), len(z)
        Z_q, Z_u, Z_z, Z_a, Z_w = (self.derivative(f"Z_{x}") for x in "quzaw")
        by_places = field.total(field.product(Z_q, self.P), field.product(Z_u, Y), field.product(Z_a, X_q))
        E = field.total(field.product(Z_u, at.Z), field.product(Z_a, X_u))
        K = _beside(e.K, at.along(self.derivative("R_z")))
        F, D, A = _beside(by_places, Z_z), Z_w, field.product(Z_a, at.Z)
        if not all(is_zero(x) for row in A for x in row):
            solved = field.solution(e.M, _beside(_beside(K, e.C), e.B))
            K_a, C_a, B_a = (_columns(solved, part) for part in _parts(n + m, len(e.speeds), len(e.inputs)))
            F = field.total(F, field.negative(field.product(A, K_a)))
            E = field.total(E, field.negative(field.product(A, C_a)))
            D = field.total(D, field.product(A, B_a)) if e.inputs else D
        return replace(
            e,
            coordinates=(*e.coordinates, *z),
            all=(*e.all, *z),
            K=K,
            F=[*([*row, *[0] * m] for row in e.F), *F],
            E=[*e.E, *E],
            P=[*([*row, *[0] * m] for row in e.P), *([0] * n + [int(i == j) for j in range(m)] for i in range(m))],
            D=[*e.D, *D],
            states=z,
        )


def _beside(left: Entries, right: Entries) -> Entries:
    """(left, right), row by row."""
    return [[*a, *b] for a, b in zip(left, right, strict=True)]


def _parts(*sizes: int) -> list[range]:
    """The columns of each of several matrices that stand side by side."""
    ends = [0, *accumulate(sizes)]
    return [range(a, b) for a, b in pairwise(ends)]


def dependent_speeds(first: FirstOrder, choice: Choice, field: NumberField) -> dict[Node, Any]:
    """The dependent speeds by J u + sigma = 0, from the independent ones of the state."""
    if not choice.speeds.rows:
        return {}
    u = first.system.symbols.u
    found = At(first.equations, field, choice.speeds).dependent([u[k] for k in choice.speeds.free])
    return {u[k]: found[k] for k in choice.speeds.following}


def unsettled(reducing: Reducing, share: float) -> list[int]:
    """Indices of the independent speeds with an unbalanced force larger than rounding errors.

    Args:
        share: of the largest force, below which a force counts as 0.
    """
    found = reducing.at.unbalanced
    scale = max(map(abs, (*reducing.field.of(reducing.first.equations.forcing), *reducing.at.forces)), default=0)
    left = [i for i, x in enumerate(found) if abs(x) > share * scale]
    if not left:
        return []
    e = reducing.equations
    places, speeds = ([max(1.0, abs(x)) for x in reducing.field.of(part)] for part in (e.coordinates, e.speeds))
    rows = [_size(K, places) + _size(C, speeds) + _size(M, speeds) for K, C, M in zip(e.K, e.C, e.M, strict=True)]
    return [i for i in left if abs(found[i]) > tolerances.SOLVED * rows[i]]


def _size(row: list[Any], unit: list[float]) -> float:
    return float(sum(abs(x) * one for x, one in zip(row, unit, strict=True)))


# -------- forms -----------------------------------------------------------------------------------------------
# LinearEquations -> the same over fewer coordinates: as many as speeds where that can be, and the requested ones.
#
# Of second order are equations with q_i' = u_i. Coordinates on which nothing depends and that have no speed of their
# own (the track of a wheel) are left out. Where the user requests some coordinates alone, the others are eliminated by
# what they conserve: nothing of them acts on the requested ones, or their momenta are constant (Routh):
#
#     M_oo u_o + M_oc u_c + C_oc q_c = 0
#     M = M_cc - M_co M_oo^-1 M_oc,  C = C_cc - M_co M_oo^-1 C_oc - C_co M_oo^-1 M_oc,  K = K_cc - C_co M_oo^-1 C_oc


Indices = Sequence[int]


def floats(A: Entries) -> np.ndarray:
    """The entries as floats, rows x columns."""
    return np.array(A, dtype=float).reshape(len(A), -1)


# -- which coordinates carry the motion ----------------------------------------------------------------------


def carrying(equations: LinearEquations, wanted: Sequence[str], dependent: Collection[str] = ()) -> tuple[int, ...]:
    """The coordinates that stay with the speeds, as many as these where possible; decided by numbers.

    Args:
        wanted: names of the coordinates that are left out last.
        dependent: names of those that are left out first.
    """
    kept = list(range(len(equations.coordinates)))
    K, F, E = (floats(x) for x in (equations.K, equations.F, equations.E))
    K, F = without_noise(K, tolerances.COMPUTED), without_noise(F, tolerances.COMPUTED)
    states = [equations.coordinates.index(z) for z in equations.states]
    while len(kept) > len(equations.speeds) + len(states):
        own = [j for j in kept if j not in states]
        unseen = [j for j in own if not np.any(K[:, j]) and not np.any(F[kept, j])]
        still = [j for j in own if not np.any(E[j]) and not np.any(F[j, kept])]
        idle = [*unseen, *still]
        if not idle:
            break
        names = {j: equations.coordinates[j].name for j in idle}
        kept.remove(max(idle, key=lambda j: (names[j] not in wanted, names[j] in dependent, _strangeness(E[j]), j)))
    return tuple(kept)


def seen_beside_own(equations: LinearEquations, kept: Indices) -> tuple[int, ...]:
    """Indices among `kept` of coordinates on which the motion depends, or that have a speed of their own."""
    K, F, E = (without_noise(floats(x), tolerances.COMPUTED) for x in (equations.K, equations.F, equations.E))
    states = [equations.coordinates.index(z) for z in equations.states]
    own = [j for j in kept if j in states or (not _strangeness(E[j]) and not np.any(F[j]))]
    seen = {j for j in kept if np.any(K[:, j])} | {*own}
    while more := {j for j in kept if np.any(F[[*seen], j])} - seen:
        seen |= more
    return tuple(sorted(seen))


def _strangeness(row: np.ndarray) -> int:
    """0 of a rate that is a speed, 1 of one that is a multiple of it, else 2."""
    return 2 if np.count_nonzero(row) != 1 else int(row.max() != 1)


def equations_without_rounding(e: LinearEquations, nearby: np.ndarray) -> LinearEquations:
    """The equations in numbers; an entry of the size of rounding errors, against its row and column or all, is 0.

    Entries of C are also compared with the damping unit made of inertia and stiffness, sqrt(M K).

    Args:
        nearby: sizes of the entries of K at states near the place, where what vanishes there does not.
    """
    M, C, K, B = (floats(x) for x in (e.M, e.C, e.K, e.B))
    usual = np.sqrt(abs(M).max(initial=0)) * np.sqrt(abs(K).max(initial=0))
    masses = np.sqrt(abs(np.diagonal(M)))  # an entry of M counts against those of its own two speeds, however light
    M = np.where(abs(M) > tolerances.SOLVED * np.outer(masses, masses), M, 0.0)
    K = np.where(abs(K) > tolerances.COMPUTED * nearby, K, 0.0)
    return replace(e, M=[[*row] for row in M.tolist()], C=_rounded(C, usual), K=_rounded(K), B=_rounded(B))


def _rounded(A: np.ndarray, usual: float = 0) -> Entries:
    if not A.size:
        return [[*row] for row in A.tolist()]
    sizes = abs(A)
    near = np.minimum(sizes.max(axis=1)[:, None], sizes.max(axis=0)[None, :])
    least = np.maximum(tolerances.SOLVED * near, tolerances.ROUNDING * max(usual, sizes.max()))
    return [[*row] for row in np.where(sizes > least, A, 0.0).tolist()]


def over_coordinates(field: NumberField, equations: LinearEquations, kept: Indices) -> LinearEquations:
    """The equations over these of the coordinates; of second order where they are as many as the speeds."""
    chosen = replace(
        equations,
        coordinates=tuple(equations.coordinates[j] for j in kept),
        K=_columns(equations.K, kept),
        P=_columns(equations.P, kept),
        F=[[equations.F[i][j] for j in kept] for i in kept],
        E=[equations.E[i] for i in kept],
        D=[equations.D[i] for i in kept],
    )
    return _second_order(field, chosen) if _can_be_of_second_order(field, chosen) else chosen


def _can_be_of_second_order(field: NumberField, equations: LinearEquations) -> bool:
    n = len(equations.speeds)
    if len(equations.coordinates) != n or equations.states:
        return False
    E = np.array([[field.size(x) for x in row] for row in equations.E])
    return is_second_order(equations) or (n > 0 and bool(np.linalg.matrix_rank(E, tol=tolerances.RANK) == n))


def is_second_order(equations: LinearEquations) -> bool:
    """True if q_i' = u_i for all coordinates: E is the unit matrix and F is 0."""
    n = len(equations.speeds)
    return (
        len(equations.coordinates) == n
        and not equations.states
        and all(x == int(i == j) for i, row in enumerate(equations.E) for j, x in enumerate(row))
        and all(x == 0 for row in equations.F for x in row)
    )


def _second_order(field: NumberField, e: LinearEquations) -> LinearEquations:
    """The equations in q_i, q_i', q_i'': u_i = E^-1 (q_i' - F q_i), premultiplied by E^-T."""
    if is_second_order(e):
        return e
    n = len(e.speeds)
    one = [[int(i == j) for j in range(n)] for i in range(n)]
    inverse = field.solution(e.E, one)
    front = field.transposed(inverse, n)
    M, C = field.product(e.M, inverse), field.product(e.C, inverse)
    K = field.total(e.K, field.negative(field.product(C, e.F)))
    C = field.total(C, field.negative(field.product(M, e.F)))
    M, C, K, B = (field.product(front, x) for x in (M, C, K, e.B))
    return replace(e, M=M, C=C, K=K, B=B, E=one, F=[[0] * n for _ in range(n)])


# -- only the requested coordinates ------------------------------------------------------------------------------


def restricted(
    field: NumberField, equations: LinearEquations, wanted: Sequence[str], decided: LinearEquations
) -> LinearEquations:
    """The equations of the requested coordinates alone.

    Args:
        decided: the same equations in numbers, which show what acts on what.
    Raises:
        DerivationError: the others act on them, and their momenta are not constant.
    """
    names = [q.name for q in equations.coordinates]
    if not wanted or list(wanted) == names:
        return equations
    if equations.states:
        what = f"{', '.join(wanted)} cannot move alone: states of first order move with them"
        raise DerivationError(what, "linearize.coordinates", "leave the list out: all move")
    if not is_second_order(equations) or set(wanted) - set(names):
        strange = [name for name in wanted if name not in names]
        what = f"'{strange[0]}' is not free to move by itself" if strange else "coordinates without a speed are left"
        raise DerivationError(
            f"{what}: the free ones are {', '.join(names)}", "linearize.coordinates", fix="take those"
        )
    c = [names.index(name) for name in wanted]
    o = [j for j in range(len(names)) if j not in c]
    if not o:
        return _taken(equations, c)
    M, C, K = (without_noise(floats(x), tolerances.COMPUTED) for x in (decided.M, decided.C, decided.K))
    if not any(np.any(x[np.ix_(c, o)]) for x in (M, C, K)):
        return _taken(equations, c)
    if np.any(K[o]) or np.any(K[:, o]) or np.any(C[np.ix_(o, o)]) or _drives(decided, C, c, o):
        what = f"{', '.join(wanted)} cannot move alone: coupled with {', '.join(names[j] for j in o)}"
        raise DerivationError(what, "linearize.coordinates", "name these coordinates too")
    return _with_momenta_kept(field, equations, c, o)


def _drives(decided: LinearEquations, C: np.ndarray, c: Indices, o: Indices) -> bool:
    """True if inputs change momenta that act, through their rates, on the requested coordinates."""
    B = floats(decided.B)
    return bool(B.size and np.any(B[o]) and np.any(C[np.ix_(c, o)]))


def _taken(e: LinearEquations, c: Indices) -> LinearEquations:
    def part(A: Entries) -> Entries:
        return _columns([A[i] for i in c], c)

    return replace(
        e,
        coordinates=tuple(e.coordinates[j] for j in c),
        speeds=tuple(e.speeds[j] for j in c),
        M=part(e.M),
        C=part(e.C),
        K=part(e.K),
        E=part(e.E),
        F=part(e.F),
        B=[e.B[i] for i in c],
        P=_columns(e.P, c),
        D=[e.D[i] for i in c],
    )


def _with_momenta_kept(field: NumberField, e: LinearEquations, c: Indices, o: Indices) -> LinearEquations:
    """Routh's reduction."""
    M_oo, M_co = (_columns([e.M[i] for i in rows], o) for rows in (o, c))
    C_co = _columns([e.C[i] for i in c], o)
    M_oc, C_oc = (_columns([A[i] for i in o], c) for A in (e.M, e.C))
    by_rates, by_places = field.solution(M_oo, M_oc), field.solution(M_oo, C_oc)
    by_inputs = field.solution(M_oo, [e.B[i] for i in o])
    whole = _taken(e, c)

    def less(A: Entries, *parts: tuple[Entries, Entries]) -> Entries:
        return field.total(A, *(field.negative(field.product(X, Y)) for X, Y in parts))

    return replace(
        whole,
        M=less(whole.M, (M_co, by_rates)),
        C=less(whole.C, (M_co, by_places), (C_co, by_rates)),
        K=less(whole.K, (C_co, by_places)),
        B=less(whole.B, (M_co, by_inputs)),
    )


def _columns(A: Entries, columns: Indices) -> Entries:
    return [[row[j] for j in columns] for row in A]


# -------- spin axes -------------------------------------------------------------------------------------------
# LinearEquations of a body that spins, by quaternion -> the same over small turns about axes.
#
# In a steady spin the quaternion e moves on, and equations in de have coefficients that change with it. The small
# turn dtheta about the body's axes, de = N dtheta with e' = N w, goes with the body:
#
#     de_c = T dtheta,  T = N_c of the three of e that stay;      T dtheta' + T' dtheta = F T dtheta + E du
#     K -> K T,   P -> P T,   F -> T^-1 (F T - T'),   E -> T^-1 E
#
# Where something acts on it in directions that stand still, as friction on a ball that spins on a table, the
# equations stay the same about axes that stand still, R dtheta with T R^T in the place of T, and R dw in that of dw:
#
#     dw = U v,  U = R^T:      M -> U^T M U,   C -> U^T (C U + M U'),   K, B -> U^T K, U^T B,   E -> E U


NAME = "turn_"


@dataclass(frozen=True)
class SpinAxis:
    """A quaternion that moves in the reference.

    Args:
        four: its coordinates.
        speeds: its angular velocity, body axes.
        carriers: which columns of the equations are three of the four.
        standing: whether the turns are about axes that stand still in what carries the body; else about its own.
        body: its name.
    """

    four: tuple[Node, ...]
    speeds: tuple[Node, ...]
    carriers: tuple[int, ...]
    standing: bool = False
    body: str = ""

    @property
    def labels(self) -> tuple[str, ...]:
        """Names of the small turns."""
        if self.standing:
            return tuple(f"{NAME}{axis}_{self.body}" for axis in "xyz")
        return tuple(NAME + w.name for w in self.speeds)

    @property
    def R(self) -> Matrix:
        """The body's axes in those of what carries it."""
        return UnitQuaternion(*self.four).rotation


def spinning(reference: ReferenceMotion, choice: Choice) -> tuple[SpinAxis, ...]:
    """The quaternions that move in the reference, three of each independent."""
    system, found = reference.system, []
    speeds = {u.name: u for u in system.symbols.u}
    names = system.scope.model.quaternions
    for four, part in zip(system.scope.quaternions, names, strict=True):
        carriers = tuple(j for j, k in enumerate(choice.places.free) if system.symbols.q[k] in four)
        moves = any(e in reference.moving for e in four)
        if moves and len(carriers) == len(part.speeds) and all(w in speeds for w in part.speeds):
            own = tuple(speeds[w] for w in part.speeds)
            free = {system.symbols.u[k] for k in choice.speeds.free}
            found.append(SpinAxis(four, own, carriers, choice.standing and free >= {*own}, part.body))
    return tuple(found)


def over_turns(
    field: NumberField, system: System, equations: LinearEquations, turns: tuple[SpinAxis, ...]
) -> LinearEquations:
    """The equations with small turns in the place of quaternions that move."""
    for turn in turns:
        equations = _over_turn(field, system, equations, turn)
        if turn.standing:
            equations = _over_standing_speeds(field, system, equations, turn)
    return equations


def _over_standing_speeds(field: NumberField, system: System, e: LinearEquations, turn: SpinAxis) -> LinearEquations:
    """dw = R^T v"""
    own, n = [e.speeds.index(w) for w in turn.speeds], len(e.speeds)
    flat = tuple(x for column in zip(*turn.R, strict=True) for x in column)
    block, rate = (field.matrix([x[k : k + 3] for k in (0, 3, 6)]) for x in (flat, system.scope.time_derivative(flat)))
    U, moved = [[int(i == j) for j in range(n)] for i in range(n)], [[0] * n for _ in range(n)]
    for i, k in enumerate(own):
        U[k], moved[k] = _spread(block[i], tuple(own), n), _spread(rate[i], tuple(own), n)
    front, MU = field.transposed(U, n), field.product(e.M, U)
    C = field.total(field.product(e.C, U), field.product(e.M, moved))
    labels = dict(zip(own, turn.labels, strict=True))
    return replace(
        e,
        speeds=tuple(system.scope.graph.symbol(labels[k] + "'") if k in labels else u for k, u in enumerate(e.speeds)),
        M=field.product(front, MU),
        C=field.product(front, C),
        K=field.product(front, e.K),
        B=field.product(front, e.B),
        E=field.product(e.E, U),
    )


def _over_turn(field: NumberField, system: System, e: LinearEquations, turn: SpinAxis) -> LinearEquations:
    n, graph = len(e.coordinates), system.scope.graph
    T, rate = _by_turn(field, system, e, turn, n)
    one = [[int(i == j) for j in range(n)] for i in range(n)]
    T_inverse = field.solution(T, one)
    F = field.product(T_inverse, field.total(field.product(e.F, T), field.negative(rate)))
    names = dict(zip(turn.carriers, turn.labels, strict=True))
    labels = tuple(graph.symbol(names[j]) if j in names else q for j, q in enumerate(e.coordinates))
    return replace(
        e,
        coordinates=labels,
        K=field.product(e.K, T),
        P=field.product(e.P, T),
        F=F,
        E=field.product(T_inverse, e.E),
    )


def _by_turn(field: NumberField, system: System, e: LinearEquations, turn: SpinAxis, n: int) -> tuple[Entries, Entries]:
    """(T, T') of all coordinates: 1 and 0 for those that are no part of the quaternion."""
    scope = system.scope
    places = [scope.symbols.q.index(e.coordinates[j]) for j in turn.carriers]
    columns = [scope.symbols.u.index(w) for w in turn.speeds]
    rows = [tuple(scope.N[i][k] for k in columns) for i in places]
    if turn.standing:
        rows = [turn.R @ Vector(row) for row in rows]  # N R^T
    flat = scope.time_derivative(tuple(x for row in rows for x in row))
    size = len(columns)
    block, moved = field.matrix(rows), field.matrix([flat[size * i : size * i + size] for i in range(len(rows))])
    T, rate = [[int(i == j) for j in range(n)] for i in range(n)], [[0] * n for _ in range(n)]
    for i, j in enumerate(turn.carriers):
        T[j] = _spread(block[i], turn.carriers, n)
        rate[j] = _spread(moved[i], turn.carriers, n)
    return T, rate


def _spread(row: list[Any], columns: tuple[int, ...], n: int) -> list[Any]:
    found = [0] * n
    for j, x in zip(columns, row, strict=True):
        found[j] = x
    return found


def turned_on(turns: tuple[SpinAxis, ...], numbers: Mapping[Node, Any], time: float) -> dict[Node, Any]:
    """The quaternions that long later: e o (cos(|w| t/2), sin(|w| t/2) w/|w|)."""
    found: dict[Node, Any] = {}
    for turn in turns:
        found |= _turned(turn.four, [numbers[x] for x in turn.speeds], [numbers[x] for x in turn.four], time)
    return found


def _turned(four: tuple[Node, ...], w: list[Any], e: list[Any], time: Any) -> dict[Node, Any]:
    f = fifty_digits().functions
    size = f["sqrt"](sum(x * x for x in w))
    c, s = f["cos"](size * time / 2), f["sin"](size * time / 2) / size
    x, y, z = (s * k for k in w)
    e0, e1, e2, e3 = e
    product_ = (
        e0 * c - e1 * x - e2 * y - e3 * z,
        e0 * x + e1 * c + e2 * z - e3 * y,
        e0 * y - e1 * z + e2 * c + e3 * x,
        e0 * z + e1 * y - e2 * x + e3 * c,
    )
    return dict(zip(four, product_, strict=True))
