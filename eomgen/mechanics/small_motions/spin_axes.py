"""LinearEquations of a body that spins, by quaternion -> the same over small turns about axes.

In a steady spin the quaternion e moves on, and equations in de have coefficients that change with it. The small turn
dtheta about the body's axes, de = N dtheta with e' = N w, goes with the body:

    de_c = T dtheta,  T = N_c of the three of e that stay;      T dtheta' + T' dtheta = F T dtheta + E du
    K -> K T,   P -> P T,   F -> T^-1 (F T - T'),   E -> T^-1 E

Where something acts on it in directions that stand still, as friction on a ball that spins on a table, the equations
stay the same about axes that stand still, R dtheta with T R^T in the place of T, and R dw in that of dw:

    dw = U v,  U = R^T:      M -> U^T M U,   C -> U^T (C U + M U'),   K, B -> U^T K, U^T B,   E -> E U
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from typing import Any

from eomgen.mechanics.equations.system import System
from eomgen.mechanics.small_motions.field import (
    Entries,
    NumberField,
    at,
    matrix_product,
    matrix_solution,
    matrix_sum,
    matrix_transposed,
    negative,
)
from eomgen.mechanics.small_motions.first_order import Choice
from eomgen.mechanics.small_motions.reduction import LinearEquations
from eomgen.mechanics.small_motions.reference import ReferenceMotion
from eomgen.model.joints.orientation import rotation_of
from eomgen.model.quaternions import quaternions_of
from eomgen.records import dataclass
from eomgen.symbolic.expression.graph import Node
from eomgen.symbolic.expression.spatial import Matrix, apply, vector_of
from eomgen.symbolic.numeric.evaluation import fifty_digits

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
        """What the small turns are called."""
        if self.standing:
            return tuple(f"{NAME}{axis}_{self.body}" for axis in "xyz")
        return tuple(NAME + w.name for w in self.speeds)

    @property
    def R(self) -> Matrix:
        """The body's axes in those of what carries it."""
        return rotation_of("quaternion", self.four)


def spinning(reference: ReferenceMotion, choice: Choice) -> tuple[SpinAxis, ...]:
    """The quaternions that move in the reference, three of each independent."""
    system, found = reference.system, []
    speeds = {u.name: u for u in system.symbols.u}
    names = quaternions_of(system.scope.model)
    for four, part in zip(system.scope.quaternions, names, strict=True):
        carriers = tuple(j for j, k in enumerate(choice.q) if system.symbols.q[k] in four)
        moves = any(e in reference.moving for e in four)
        if moves and len(carriers) == len(part.speeds) and all(w in speeds for w in part.speeds):
            own = tuple(speeds[w] for w in part.speeds)
            free = {system.symbols.u[k] for k in choice.u}
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
    block, rate = (at(field, [x[k : k + 3] for k in (0, 3, 6)]) for x in (flat, system.scope.time_derivative(flat)))
    U, moved = [[int(i == j) for j in range(n)] for i in range(n)], [[0] * n for _ in range(n)]
    for i, k in enumerate(own):
        U[k], moved[k] = _spread(block[i], tuple(own), n), _spread(rate[i], tuple(own), n)
    front, MU = matrix_transposed(U, n), matrix_product(field, e.M, U)
    C = matrix_sum(field, matrix_product(field, e.C, U), matrix_product(field, e.M, moved))
    labels = dict(zip(own, turn.labels, strict=True))
    return replace(
        e,
        speeds=tuple(system.scope.graph.symbol(labels[k] + "'") if k in labels else u for k, u in enumerate(e.speeds)),
        M=matrix_product(field, front, MU),
        C=matrix_product(field, front, C),
        K=matrix_product(field, front, e.K),
        B=matrix_product(field, front, e.B),
        E=matrix_product(field, e.E, U),
    )


def _over_turn(field: NumberField, system: System, e: LinearEquations, turn: SpinAxis) -> LinearEquations:
    n, graph = len(e.coordinates), system.scope.graph
    T, rate = _by_turn(field, system, e, turn, n)
    one = [[int(i == j) for j in range(n)] for i in range(n)]
    T_inverse = matrix_solution(field, T, one)
    F = matrix_product(field, T_inverse, matrix_sum(field, matrix_product(field, e.F, T), negative(rate)))
    names = dict(zip(turn.carriers, turn.labels, strict=True))
    labels = tuple(graph.symbol(names[j]) if j in names else q for j, q in enumerate(e.coordinates))
    return replace(
        e,
        coordinates=labels,
        K=matrix_product(field, e.K, T),
        P=matrix_product(field, e.P, T),
        F=F,
        E=matrix_product(field, T_inverse, e.E),
    )


def _by_turn(field: NumberField, system: System, e: LinearEquations, turn: SpinAxis, n: int) -> tuple[Entries, Entries]:
    """(T, T') of all coordinates: 1 and 0 for those that are no part of the quaternion."""
    scope = system.scope
    places = [scope.symbols.q.index(e.coordinates[j]) for j in turn.carriers]
    columns = [scope.symbols.u.index(w) for w in turn.speeds]
    rows = [tuple(scope.N[i][k] for k in columns) for i in places]
    if turn.standing:
        rows = [apply(turn.R, vector_of(row)) for row in rows]  # N R^T
    flat = scope.time_derivative(tuple(x for row in rows for x in row))
    size = len(columns)
    block, moved = at(field, rows), at(field, [flat[size * i : size * i + size] for i in range(len(rows))])
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
