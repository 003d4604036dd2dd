"""System -> accelerations at one state, in numbers, from the free bodies: the oracle that uses no B.

Every body has its own acceleration A_i = (wd, acc) of its origin, its own Newton-Euler equations and an
unknown wrench F_i from its joint; the joints say how A_i may differ from that of the parent:

    I_i A_i + p_i = W_i + F_i - sum over children X^T F_c + sum over constraint rows W lam
    A_i = X A_parent + b_i + C_i a
    C_i^T F_i summed over joints + rotors = what acts on joints and coordinates at no place
    J a + gamma = 0

One linear system in (A, F, a, lam); what depends on velocity is found by differences of numbers along
the motion, not by derivatives of expressions. Dependent coordinates are free here, and every constraint that closes
them has
its lam: so the elimination is checked too.
"""

from __future__ import annotations

import numpy as np

from eomgen.mechanics.dynamics.system import System
from eomgen.mechanics.free_bodies.equilibrium import BodyNumbers
from eomgen.mechanics.kinematics.inertia import SystemInertia
from eomgen.mechanics.kinematics.motion import BodyLink
from eomgen.symbolic.expression.derivatives import gradient
from eomgen.symbolic.expression.node import State
from eomgen.symbolic.expression.spatial import Vector
from eomgen.symbolic.numeric import tolerances
from eomgen.symbolic.numeric.dense import balanced, independent, without_rounding
from eomgen.symbolic.numeric.evaluation import NoValue, evaluate, fifty_digits


def free_body_accelerations(system: System, state: State) -> np.ndarray:
    """a at a state, from the free bodies.

    Args:
        state: values of all symbols, at 50 digits.
    Raises:
        NoValue: a free coordinate moves no mass at the state.
    """
    if system.free is None:
        return _accelerations(system, state)
    free = system.free.scope
    state = state | free_speeds(system, system.free, state)
    found = _accelerations(system.free, state)
    state |= {a: fifty_digits().number(1) * float(x) for a, x in zip(free.symbols.a, found, strict=True)}
    own = evaluate(tuple(free.names[a.name] for a in system.scope.symbols.a), state, fifty_digits())
    return np.array([float(x) for x in own])


def free_speeds(system: System, free: System, state: State) -> State:
    """The speeds of the free system, the dependent ones as they follow."""
    rates = evaluate(system.free_rates(free), state, fifty_digits())
    return dict(zip(free.scope.symbols.u, rates, strict=True))


def _accelerations(system: System, state: State) -> np.ndarray:
    """a of a system in which every constraint that closes has its multiplier."""
    numbers = BodyNumbers(system, state)
    n, nu = len(system.motion.links), len(system.scope.symbols.u)
    k = len(system.constraints.closing) + len(system.scope.quaternions)
    size = 12 * n + nu + k
    A, right = np.zeros((size, size)), np.zeros(size)
    speeds, multipliers = slice(12 * n, 12 * n + nu), slice(12 * n + nu, size)
    _put_bodies(numbers, A, right, speeds)
    direct = [a + b for a, b in zip(system.loads.joint_forces, system.loads.placeless_forces, strict=True)]
    rotors = SystemInertia(system.motion).added_bias
    right[speeds] = numbers.array(tuple(a - b for a, b in zip(direct, rotors, strict=True))) if nu else 0
    for i, j, value in SystemInertia(system.motion).added_mass:
        A[12 * n + i, 12 * n + j] += numbers.array((value,))[0]
    _close(numbers, A, right, multipliers)
    J = without_rounding(A[multipliers, speeds])
    A[:, multipliers] *= np.any(J, axis=1)  # what says nothing pushes nothing
    A[multipliers, speeds] = J
    regular = independent(J, smallest=tolerances.LEAST_CHANGE)
    return dense_solution(A, right, regular=regular, smallest=tolerances.LEAST_CHANGE)[speeds]


def _put_bodies(numbers: BodyNumbers, A: np.ndarray, right: np.ndarray, speeds: slice) -> None:
    """Into A and the right side: Newton and Euler for every body, and what its joint says of its motion."""
    links = numbers.system.motion.links
    n = len(links)
    for i, link in enumerate(links):
        column, bias = _joint(numbers, link)
        motion, wrench = slice(6 * i, 6 * i + 6), slice(6 * (n + i), 6 * (n + i) + 6)
        inertia, push = _body(numbers, link)
        A[motion, motion], A[motion, wrench], right[motion] = inertia, -np.eye(6), push
        A[wrench, motion], A[wrench, speeds], right[wrench] = np.eye(6), -column, bias
        if link.parent >= 0:
            X = _transfer(numbers, link)
            A[wrench, 6 * link.parent : 6 * link.parent + 6] = -X
            A[6 * link.parent : 6 * link.parent + 6, wrench] = X.T
        A[speeds, wrench] = column.T


def _body(numbers: BodyNumbers, link: BodyLink) -> tuple[np.ndarray, np.ndarray]:
    """(I, W - p) of a free body about its origin, body axes: W the applied wrench, p what velocity takes."""
    system = numbers.system
    mass = system.scope.mass_properties(link.name)
    m, com, I_com = float(numbers.array((mass.m,))[0]), numbers.array(mass.com), numbers.array(mass.I)
    w = numbers.array(link.twist.w)
    C = _tilde(com)
    inertia = np.block([[I_com - m * C @ C, m * C], [-m * C, m * np.eye(3)]])
    centripetal = m * np.cross(w, np.cross(w, com))
    p = np.concatenate([np.cross(w, I_com @ w) + np.cross(com, centripetal), centripetal])
    applied = np.zeros(6)
    for load in (*system.loads.placed, *system.loads.weights):
        found = system.motion.body_wrench(load)
        if found is not None and found[0] == link.name:
            applied += numbers.array((*found[1].tau, *found[1].f))
    return inertia, applied - p


def _joint(numbers: BodyNumbers, link: BodyLink) -> tuple[np.ndarray, np.ndarray]:
    """(columns, b): the child's acceleration against its parent per unit of a, and at a = 0."""
    scope = numbers.system.scope
    parent = numbers.system.motion.links[link.parent] if link.parent >= 0 else None
    R_CP = numbers.array(link.local.R).T
    offset = _origin(link)
    first = scope.time_derivative(offset)
    spin = _relative_spin(link)
    w_p = np.zeros(3) if parent is None else numbers.array(parent.twist.w)
    velocity, w = numbers.rate(offset), numbers.array(spin)
    acc = np.cross(w_p, np.cross(w_p, numbers.array(offset))) + 2 * np.cross(w_p, velocity) + numbers.rate(first)
    bias = np.concatenate([numbers.rate(spin) + np.cross(R_CP @ w_p, w), R_CP @ acc])
    columns = [[*numbers.array(gradient(x, scope.symbols.u))] for x in (*spin, *first)]
    turned = np.array(columns).reshape(6, len(scope.symbols.u))
    return np.vstack([turned[:3], R_CP @ turned[3:]]), bias


def _origin(link: BodyLink) -> Vector:
    """The child's origin in the parent's axes."""
    return link.local.point(-link.point)


def _relative_spin(link: BodyLink) -> Vector:
    """Angular velocity of the child against its parent, child's axes."""
    spin = Vector.ZERO
    for rate, (w, _) in zip(link.s_rate, link.S, strict=True):
        spin = spin + rate * w
    return spin


def _transfer(numbers: BodyNumbers, link: BodyLink) -> np.ndarray:
    """X: acceleration of the parent's origin, parent's axes -> of the child's origin if it were fixed in the parent."""
    R_CP = numbers.array(link.local.R).T
    return np.block([[R_CP, np.zeros((3, 3))], [-R_CP @ _tilde(numbers.array(_origin(link))), R_CP]])


def _close(numbers: BodyNumbers, A: np.ndarray, right: np.ndarray, multipliers: slice) -> None:
    """Columns of the constraint rows' wrenches, and the rows W^T A + d/dt(W^T) xi ... = 0 as J a + gamma = 0."""
    system = numbers.system
    n = len(system.motion.links)
    for j, row in enumerate(system.constraints.closing):
        place = multipliers.start + j
        for body, wrench in row.wrenches:
            i = system.motion.index[body]
            A[6 * i : 6 * i + 6, place] -= numbers.array((*wrench.tau, *wrench.f))
        J = gradient(row.velocity, system.scope.symbols.u)
        A[place, 12 * n : 12 * n + len(J)] = numbers.array(J)
        A[12 * n : 12 * n + len(J), place] = -numbers.array(gradient(row.direct, system.scope.symbols.u))
        right[place] = -float(numbers.rate((row.velocity,))[0])
    _hold_norms(numbers, A, right, multipliers.start + len(system.constraints.closing))


def _hold_norms(numbers: BodyNumbers, A: np.ndarray, right: np.ndarray, place: int) -> None:
    """e . e'' + e' . e' = 0 of every quaternion, with a multiplier of its own."""
    scope, n = numbers.system.scope, len(numbers.system.motion.links)
    speeds = [u.name for u in scope.symbols.u]
    for j, four in enumerate(scope.quaternions, start=place):
        for e in four:
            k = 12 * n + speeds.index(f"{e.name}'")
            A[j, k] = A[k, j] = float(numbers.at((e,))[0])
            right[j] -= float(numbers.at((scope.names[f"{e.name}'"],))[0]) ** 2


def _tilde(a: np.ndarray) -> np.ndarray:
    return np.array([[0, -a[2], a[1]], [a[2], 0, -a[0]], [-a[1], a[0], 0]])


def dense_solution(A: np.ndarray, right: np.ndarray, *, regular: bool, smallest: float) -> np.ndarray:
    """A x = right: by elimination, whose error knows no units; where A is not regular, the least squares' x.

    Args:
        regular: whether A is (an x of least squares mixes units: milligrams beside tonnes would count as 0).
        smallest: singular values of the scaled A below this part of the largest count as 0.
    Raises:
        NoValue: A was called regular and is not.
    """
    scaled, rows, columns = balanced(A)
    if not regular:
        return np.asarray(columns * np.linalg.lstsq(scaled, rows * right, rcond=smallest)[0])
    try:
        return columns * np.linalg.solve(scaled, rows * right)
    except np.linalg.LinAlgError as error:
        raise NoValue("the equations of motion are singular") from error
