"""Equations of motion -> accelerations and multipliers, by articulated bodies or at a state with many digits."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np

from eomgen.frozen import dataclass
from eomgen.mechanics.dynamics.system import EquationsOfMotion
from eomgen.mechanics.dynamics.tree import Branch, applied_wrenches, branches_of, inertia_wrench, rate_matrix
from eomgen.mechanics.kinematics import GROUND, Loads, Motion, SystemInertia
from eomgen.symbolic.expression import Matrix, Scalar, State, Vector, is_zero, over
from eomgen.symbolic.numeric import NoValue, dense, evaluate, fifty_digits, tolerances

# -------- accelerations ---------------------------------------------------------------------------------------
# Equations of motion, state -> accelerations with more digits than doubles have.


SINGULAR = 1e13  # condition number from which a mass matrix counts as singular in double precision
BITS = 200  # of whole numbers that stand for numbers of 50 digits
REFINEMENTS = 40  # each adds the digits that the condition number leaves of 16


def exact_accelerations(equations: EquationsOfMotion, state: State) -> list[Any]:
    """Accelerations with more digits than doubles have: the residual of each solution is solved for again.

    Raises:
        NoValue: some motion that the constraints allow moves no mass at the state.
    """
    n, k = len(equations.M), len(equations.J)
    if n == 0:
        return []
    entries = [x for row in (*equations.M, *equations.J) for x in row]
    values = evaluate((*entries, *equations.forcing, *equations.gamma), state, fifty_digits())
    wide = np.array(values[: n * (n + k)], dtype=object).reshape(n + k, n)
    M, J = wide[:n].astype(float), dense.closed_entries(wide[n:].astype(float))
    if dense.scaled_condition(dense.weighted(M, J)) > SINGULAR:  # what no mass measures the constraints may say
        raise NoValue("the mass matrix is singular")
    wide[n:] *= J != 0
    regular = k == 0 or dense.rank(J, smallest=tolerances.LEAST_CHANGE) == k
    inverse = _inverse(np.block([[M, -J.T], [J, np.zeros((k, k))]]), regular=regular)
    right = np.array([*values[n * (n + k) : len(values) - k], *(-y for y in values[len(values) - k :])], dtype=object)
    return _refined(wide, n, right, inverse)


def _inverse(A: np.ndarray, *, regular: bool) -> np.ndarray:
    """Its inverse in doubles, scaled first; where rows follow from others that which leaves least."""
    scaled, rows, columns = dense.balanced(A)
    try:
        found = np.linalg.inv(scaled) if regular else np.linalg.pinv(scaled, rcond=tolerances.LEAST_CHANGE)
    except np.linalg.LinAlgError as error:
        raise NoValue("the equations of motion are singular") from error
    return np.asarray(columns[:, None] * found * rows)


def _refined(wide: np.ndarray, n: int, right: np.ndarray, inverse: np.ndarray) -> list[Any]:
    """a of M a - J^T lam = b, J a = -gamma, `wide` M over J: each correction adds the digits that doubles are sure of.

    Raises:
        NoValue: they add none.
    """
    A, x, left = Whole.of(wide), np.zeros(len(right), dtype=object), right
    for _ in range(REFINEMENTS):
        size = max(map(abs, left))
        if size == 0:
            return list(x[:n])
        step = (inverse @ (left / size).astype(float)).astype(object) * size
        x = x + step
        below, pushes = A.times(x[:n]), A.transposed_times(np.concatenate([np.zeros(n, dtype=object), x[n:]]))
        left = right - below + np.concatenate([pushes, np.zeros(len(x) - n, dtype=object)])
        if max(map(abs, step[:n])) <= tolerances.REFINED_AT_50 * max(map(abs, x[:n])):
            return list(x[:n])
    raise NoValue("the accelerations are not determined to the digits of doubles")


@dataclass(frozen=True)
class Whole:
    """A matrix or vector as whole numbers times a unit: its products take a tenth of the time of those of 50 digits."""

    entries: np.ndarray
    unit: Any

    @staticmethod
    def of(values: np.ndarray) -> Whole:
        unit = fifty_digits().number(1) * (max(map(abs, values.ravel()), default=1) or 1) / 2**BITS
        return Whole(np.frompyfunc(int, 1, 1)(values / unit), unit)

    def times(self, x: np.ndarray) -> np.ndarray:
        """A x"""
        other = Whole.of(x)
        return np.asarray((self.entries @ other.entries) * (self.unit * other.unit))

    def transposed_times(self, x: np.ndarray) -> np.ndarray:
        """A^T x"""
        return Whole(self.entries.T, self.unit).times(x)


# -------- articulated -----------------------------------------------------------------------------------------
# Branches -> accelerations by articulated bodies: O(n) operations for a tree of n bodies.
#
# Inward, for each branch with column s:   d = s^T I s,  r = tau - s^T p,
#     I' = I - I s s^T I / d,   p' = p + I s r / d + I' b,   both carried to the parent;
# outward:   A' = X A_parent + b,   a = (r - (I s)^T A') / d,   A = A' + s a. Accelerations are (wd, acc of the joint
# point), working axes; b is what the joint adds at a = 0. Source: Featherstone, Rigid Body Dynamics Algorithms
# (2008), §7.3.


Six = list[Scalar]
Matrix6 = list[list[Scalar]]


@dataclass(frozen=True)
class JointElimination:
    """Quantities of one eliminated column for the back substitution: speed index k, column s, I s, d and r."""

    k: int
    s: Six
    Is: Six
    d: Scalar
    r: Scalar


def is_articulated(motion: Motion, branches: tuple[Branch, ...]) -> bool:
    """Every speed belongs to one joint alone, and no rotor couples two of them."""
    size = len(motion.scope.symbols.u)
    owned = [k for branch in branches for k in branch.columns]
    coupled = any(i != j for i, j, _ in SystemInertia(motion).added_mass)
    return sorted(owned) == list(range(size)) and size > 0 and not coupled


def with_accelerations(equations: EquationsOfMotion) -> EquationsOfMotion:
    """The equations with explicit accelerations, where articulated bodies give them."""
    system = equations.system
    branches = branches_of(system.motion)
    if equations.J or equations.friction or not is_articulated(system.motion, branches):
        return equations
    return replace(equations, accelerations=accelerations(system.loads, branches))


def accelerations(loads: Loads, branches: tuple[Branch, ...]) -> tuple[Scalar, ...]:
    """a of the tree under its loads, constraint rows left out."""
    motion = loads.motion
    size = len(motion.scope.symbols.u)
    direct = zip(loads.joint_forces, loads.placeless_forces, SystemInertia(motion).added_bias, strict=True)
    effort = [a + b - rotor for a, b, rotor in direct]
    rotors: list[Scalar] = [0] * size
    for k, _, value in SystemInertia(motion).added_mass:
        rotors[k] = rotors[k] + value
    base = (*Vector.ZERO, *(-loads.fields))
    biases, p = _velocity_terms(branches)
    for i, wrench in applied_wrenches(loads, branches).items():
        p[i] = [a - b for a, b in zip(p[i], (*wrench.tau, *wrench.f), strict=True)]
    eliminated = _inward(branches, (effort, rotors), biases, p)
    return _outward(branches, eliminated, biases, list(base), size)


def _velocity_terms(branches: tuple[Branch, ...]) -> tuple[list[Six], list[Six]]:
    """(b, p) of every branch: the joint's velocity-product acceleration, and the wrench of w x w x."""
    spins: list[Vector] = []
    biases, wrenches = [], []
    for branch in branches:
        w_p = Vector.ZERO if branch.parent == GROUND else spins[branch.parent]
        carried_w = _turn(branch, w_p)
        w = carried_w + branch.w
        U_p = rate_matrix(w_p, Vector.ZERO)
        seat = U_p @ branch.p + branch.p_bias
        if any(not is_zero(x) for x in branch.p_rate):
            seat = seat + 2 * w_p.cross(branch.p_rate)
        biases.append([*(branch.w_bias + carried_w.cross(branch.w)), *_turn(branch, seat)])
        wrench = inertia_wrench(branch.moments, Vector.ZERO, rate_matrix(w, Vector.ZERO))
        wrenches.append([*wrench.tau, *wrench.f])
        spins.append(w)
    return biases, wrenches


def _inward(
    branches: tuple[Branch, ...], joints: tuple[list[Scalar], list[Scalar]], biases: list[Six], p: list[Six]
) -> list[list[JointElimination]]:
    """Eliminate every column, leaves first; joints: (effort, rotor inertia) of each speed."""
    effort, rotors = joints
    inertia = [_matrix(branch) for branch in branches]
    eliminated: list[list[JointElimination]] = [[] for _ in branches]
    for i in reversed(range(len(branches))):
        branch, I, force = branches[i], inertia[i], p[i]
        shifted = list(force)
        for k, (w, v) in branch.columns.items():
            s = [*w, *v]
            Is = _times(I, s)
            d = _dot(s, Is) + rotors[k]
            r = effort[k] - _dot(s, shifted)
            g = over(1, d)
            scaled = [g * x for x in Is]
            eliminated[i].append(JointElimination(k, s, Is, d, r))
            I = _downdated(I, Is, scaled)
            shifted = [x + y * r for x, y in zip(shifted, scaled, strict=True)]
        if branch.parent != GROUND:
            shifted = [x + y for x, y in zip(shifted, _times(I, biases[i]), strict=True)]
            _carry(branch, I, shifted, inertia[branch.parent], p[branch.parent])
    return eliminated


def _outward(
    branches: tuple[Branch, ...], eliminated: list[list[JointElimination]], biases: list[Six], base: Six, size: int
) -> tuple[Scalar, ...]:
    """a, root first."""
    a: list[Scalar] = [0] * size
    reached: list[Six] = []
    for i, branch in enumerate(branches):
        A_p = base if branch.parent == GROUND else reached[branch.parent]
        wd, acc = Vector(A_p[:3]), Vector(A_p[3:])
        A = [*_turn(branch, wd), *_turn(branch, acc + wd.cross(branch.p))]
        solved = [x + y for x, y in zip(A, biases[i], strict=True)]
        for e in reversed(eliminated[i]):
            a[e.k] = (e.r - _dot(e.Is, solved)) * over(1, e.d)
            solved = [x + y * a[e.k] for x, y in zip(solved, e.s, strict=True)]
        reached.append(solved)
    return tuple(a)


def _matrix(branch: Branch) -> Matrix6:
    """The 6 x 6 inertia of a branch about its joint point: rows of the wrench per unit of (wd, acc)."""
    columns = []
    for j in range(6):
        unit = [int(i == j) for i in range(6)]
        wrench = inertia_wrench(branch.moments, Vector(unit[3:]), rate_matrix(Vector.ZERO, Vector(unit[:3])))
        columns.append([*wrench.tau, *wrench.f])
    return [[columns[j][i] for j in range(6)] for i in range(6)]


def _downdated(I: Matrix6, u: Six, scaled: Six) -> Matrix6:
    """I - u u^T / d, symmetric: its upper half is computed once."""
    new = [row[:] for row in I]
    for i in range(6):
        if is_zero(u[i]):
            continue
        for j in range(i, 6):
            new[i][j] = new[j][i] = I[i][j] - u[i] * scaled[j]
    return new


def _carry(branch: Branch, I: Matrix6, p: Six, parent_I: Matrix6, parent_p: Six) -> None:
    """Add X^T I X and X^T p to the parent, X = (E, 0; -E p~, E)."""
    if branch.E is not Matrix.IDENTITY:
        R = branch.E.T
        blocks = [[_congruent(R, _block(I, r, c)) for c in (0, 3)] for r in (0, 3)]
        I = [[blocks[r // 3][c // 3][r % 3][c % 3] for c in range(6)] for r in range(6)]
        p = [*(R @ Vector(p[:3])), *(R @ Vector(p[3:]))]
    moved = _moved(I, branch.p)
    for i in range(6):
        for j in range(i, 6):
            parent_I[i][j] = parent_I[j][i] = parent_I[i][j] + moved[i][j]
    torque = Vector(p[:3]) + branch.p.cross(Vector(p[3:]))
    for i, x in enumerate((*torque, *p[3:])):
        parent_p[i] = parent_p[i] + x


def _moved(I: Matrix6, r: Vector) -> Matrix6:
    """(1, r~; 0, 1) I (1, 0; -r~, 1): the same inertia about the point from which the present one is at r."""
    shift = [[0, -r[2], r[1]], [r[2], 0, -r[0]], [-r[1], r[0], 0]]
    new = [row[:] for row in I]
    for j in range(6):  # rows: torque += r x f
        for i in range(3):
            new[i][j] = I[i][j] + sum((shift[i][k] * I[3 + k][j] for k in range(3)), start=0)
    out = [row[:] for row in new]
    for i in range(3):  # columns: acc += wd x r
        for j in range(i, 3):
            out[i][j] = out[j][i] = new[i][j] + sum((new[i][3 + k] * shift[j][k] for k in range(3)), start=0)
        for j in range(3, 6):
            out[j][i] = new[i][j]
            out[i][j] = new[i][j]
    return out


def _block(I: Matrix6, r: int, c: int) -> Matrix:
    return Matrix.of((I[r + i][c + j] for j in range(3)) for i in range(3))


def _congruent(R: Matrix, block: Matrix) -> Matrix:
    """R block R^T"""
    return R @ block @ R.T


def _times(I: Matrix6, x: Six) -> Six:
    return [_dot(row, x) for row in I]


def _dot(a: Six, b: Six) -> Scalar:
    total: Scalar = 0
    for x, y in zip(a, b, strict=True):
        if not is_zero(x) and not is_zero(y):
            total = total + x * y
    return total


def _turn(branch: Branch, a: Vector) -> Vector:
    return a if branch.E is Matrix.IDENTITY else branch.E @ a


# -------- stabilization ---------------------------------------------------------------------------------------
# Equations of motion, rates -> the same with constraint rows that pull back what has opened, after Baumgarte.
#
#     J a + gamma + 2 alpha (J u + sigma) + beta^2 phi = 0
#
# so that phi'' + 2 alpha phi' + beta^2 phi = 0: a gap decays as a damped oscillation does, critically for alpha =
# beta. Of a row that is given as a velocity alone the speed decays, with the rate 2 alpha. Source: Baumgarte,
# Stabilization of constraints and integrals of motion in dynamical systems, Computer Methods in Applied Mechanics and
# Engineering 1 (1972).
