"""LinearEquations -> the same over fewer coordinates: as many as speeds where that can be, and those that are asked.

Of second order are equations with q_i' = u_i. Coordinates on which nothing depends and that have no speed of their own
(the track of a wheel) are left out. Where the user asks for some coordinates alone, the others go by what they keep:
nothing of them acts on those asked, or their momenta stay (Routh):

    M_oo u_o + M_oc u_c + C_oc q_c = 0
    M = M_cc - M_co M_oo^-1 M_oc,  C = C_cc - M_co M_oo^-1 C_oc - C_co M_oo^-1 M_oc,  K = K_cc - C_co M_oo^-1 C_oc
"""

from __future__ import annotations

from collections.abc import Collection, Sequence
from dataclasses import replace

import numpy as np

from eomgen.errors import DerivationError
from eomgen.mechanics.small_motions.field import (
    Entries,
    NumberField,
    matrix_product,
    matrix_solution,
    matrix_sum,
    matrix_transposed,
    negative,
)
from eomgen.mechanics.small_motions.reduction import LinearEquations
from eomgen.symbolic.numeric.dense import without_noise
from eomgen.symbolic.numeric.tolerances import COMPUTED, RANK, ROUNDING, SOLVED

Indices = Sequence[int]


def floats(A: Entries) -> np.ndarray:
    """The entries as floats, rows x columns."""
    return np.array(A, dtype=float).reshape(len(A), -1)


# -- which coordinates carry the motion ----------------------------------------------------------------------


def carrying(equations: LinearEquations, wanted: Sequence[str], dependent: Collection[str] = ()) -> tuple[int, ...]:
    """The coordinates that stay beside the speeds, as many as these where that can be; decided by numbers.

    Args:
        wanted: coordinates that go last.
        dependent: those that go first, by name.
    """
    kept = list(range(len(equations.coordinates)))
    K, F, E = (floats(x) for x in (equations.K, equations.F, equations.E))
    K, F = without_noise(K, COMPUTED), without_noise(F, COMPUTED)
    while len(kept) > len(equations.speeds):
        unseen = [j for j in kept if not np.any(K[:, j]) and not np.any(F[kept, j])]
        still = [j for j in kept if not np.any(E[j]) and not np.any(F[j, kept])]
        idle = [*unseen, *still]
        if not idle:
            break
        names = {j: equations.coordinates[j].name for j in idle}
        kept.remove(max(idle, key=lambda j: (names[j] not in wanted, names[j] in dependent, _strangeness(E[j]), j)))
    return tuple(kept)


def seen_beside_own(equations: LinearEquations, kept: Indices) -> tuple[int, ...]:
    """Of these coordinates those on which the motion depends, and those with a speed of their own."""
    K, F, E = (without_noise(floats(x), COMPUTED) for x in (equations.K, equations.F, equations.E))
    own = [j for j in kept if not _strangeness(E[j]) and not np.any(F[j])]
    seen = {j for j in kept if np.any(K[:, j])} | {*own}
    while more := {j for j in kept if np.any(F[[*seen], j])} - seen:
        seen |= more
    return tuple(sorted(seen))


def _strangeness(row: np.ndarray) -> int:
    """0 of a rate that is a speed, 1 of one that is a multiple of it, else 2."""
    return 2 if np.count_nonzero(row) != 1 else int(row.max() != 1)


def equations_without_rounding(e: LinearEquations, nearby: np.ndarray) -> LinearEquations:
    """The equations in numbers, 0 where an entry is what is left of it: beside its row and column, or the whole.

    Of C also beside what inertia and stiffness make of a rate: sqrt(M K).

    Args:
        nearby: how large the entries of K are beside the place, where what vanishes there does not.
    """
    M, C, K, B = (floats(x) for x in (e.M, e.C, e.K, e.B))
    usual = np.sqrt(abs(M).max(initial=0)) * np.sqrt(abs(K).max(initial=0))
    masses = np.sqrt(abs(np.diagonal(M)))  # an entry of M is none beside those of its own two speeds, however light
    M = np.where(abs(M) > SOLVED * np.outer(masses, masses), M, 0.0)
    K = np.where(abs(K) > COMPUTED * nearby, K, 0.0)
    return replace(e, M=[[*row] for row in M.tolist()], C=_rounded(C, usual), K=_rounded(K), B=_rounded(B))


def _rounded(A: np.ndarray, usual: float = 0) -> Entries:
    if not A.size:
        return [[*row] for row in A.tolist()]
    sizes = abs(A)
    near = np.minimum(sizes.max(axis=1)[:, None], sizes.max(axis=0)[None, :])
    least = np.maximum(SOLVED * near, ROUNDING * max(usual, sizes.max()))
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
    )
    return _second_order(field, chosen) if _can_be_of_second_order(field, chosen) else chosen


def _can_be_of_second_order(field: NumberField, equations: LinearEquations) -> bool:
    n = len(equations.speeds)
    if len(equations.coordinates) != n:
        return False
    E = np.array([[field.size(x) for x in row] for row in equations.E])
    return is_second_order(equations) or (n > 0 and bool(np.linalg.matrix_rank(E, tol=RANK) == n))


def is_second_order(equations: LinearEquations) -> bool:
    """Whether q_i' = u_i."""
    n = len(equations.speeds)
    return (
        len(equations.coordinates) == n
        and all(x == int(i == j) for i, row in enumerate(equations.E) for j, x in enumerate(row))
        and all(x == 0 for row in equations.F for x in row)
    )


def _second_order(field: NumberField, e: LinearEquations) -> LinearEquations:
    """With u_i = E^-1 (q_i' - F q_i), and E^-T in front."""
    if is_second_order(e):
        return e
    n = len(e.speeds)
    one = [[int(i == j) for j in range(n)] for i in range(n)]
    inverse = matrix_solution(field, e.E, one)
    front = matrix_transposed(inverse, n)
    M, C = matrix_product(field, e.M, inverse), matrix_product(field, e.C, inverse)
    K = matrix_sum(field, e.K, negative(matrix_product(field, C, e.F)))
    C = matrix_sum(field, C, negative(matrix_product(field, M, e.F)))
    M, C, K, B = (matrix_product(field, front, x) for x in (M, C, K, e.B))
    return replace(e, M=M, C=C, K=K, B=B, E=one, F=[[0] * n for _ in range(n)])


# -- only those that are asked ---------------------------------------------------------------------------------


def restricted(
    field: NumberField, equations: LinearEquations, wanted: Sequence[str], decided: LinearEquations
) -> LinearEquations:
    """The equations of the coordinates that are asked, alone.

    Args:
        decided: the same equations in numbers, by which it is seen what acts on what.
    Raises:
        DerivationError: the others act on them, and keep no momenta.
    """
    names = [q.name for q in equations.coordinates]
    if not wanted or list(wanted) == names:
        return equations
    if not is_second_order(equations) or set(wanted) - set(names):
        strange = [name for name in wanted if name not in names]
        what = f"'{strange[0]}' is not free to move by itself" if strange else "coordinates without a speed are left"
        raise DerivationError(
            f"{what}: the free ones are {', '.join(names)}", "linearize.coordinates", mend="take those"
        )
    c = [names.index(name) for name in wanted]
    o = [j for j in range(len(names)) if j not in c]
    if not o:
        return _taken(equations, c)
    M, C, K = (without_noise(floats(x), COMPUTED) for x in (decided.M, decided.C, decided.K))
    if not any(np.any(x[np.ix_(c, o)]) for x in (M, C, K)):
        return _taken(equations, c)
    if np.any(K[o]) or np.any(K[:, o]) or np.any(C[np.ix_(o, o)]) or _drives(decided, C, c, o):
        what = f"{', '.join(wanted)} cannot move alone: coupled with {', '.join(names[j] for j in o)}"
        raise DerivationError(what, "linearize.coordinates", "name these coordinates too")
    return _with_momenta_kept(field, equations, c, o)


def _drives(decided: LinearEquations, C: np.ndarray, c: Indices, o: Indices) -> bool:
    """Whether inputs change momenta that act on the coordinates asked through their rates."""
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
    )


def _with_momenta_kept(field: NumberField, e: LinearEquations, c: Indices, o: Indices) -> LinearEquations:
    """Routh's reduction."""
    M_oo, M_co = (_columns([e.M[i] for i in rows], o) for rows in (o, c))
    C_co = _columns([e.C[i] for i in c], o)
    M_oc, C_oc = (_columns([A[i] for i in o], c) for A in (e.M, e.C))
    by_rates, by_places = matrix_solution(field, M_oo, M_oc), matrix_solution(field, M_oo, C_oc)
    by_inputs = matrix_solution(field, M_oo, [e.B[i] for i in o])
    whole = _taken(e, c)

    def less(A: Entries, *parts: tuple[Entries, Entries]) -> Entries:
        return matrix_sum(field, A, *(negative(matrix_product(field, X, Y)) for X, Y in parts))

    return replace(
        whole,
        M=less(whole.M, (M_co, by_rates)),
        C=less(whole.C, (M_co, by_places), (C_co, by_rates)),
        K=less(whole.K, (C_co, by_places)),
        B=less(whole.B, (M_co, by_inputs)),
    )


def _columns(A: Entries, columns: Indices) -> Entries:
    return [[row[j] for j in columns] for row in A]
