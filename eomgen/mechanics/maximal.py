"""System -> accelerations at one state, in numbers, from the free bodies: the check that uses no B.

Every body has its own acceleration A_i = (wd, acc) of its joint point, its own Newton-Euler equations and an
unknown wrench F_i from its joint; the joints say how A_i may differ from that of the parent:

    I_i A_i + p_i = W_i + F_i - sum over children X^T F_c + sum over closing rows W lam
    A_i = X A_parent + b_i + S_i (D a)
    (S_i D_k)^T F_i summed over joints + rotors = what acts on joints and coordinates at no place
    J a + gamma = 0

One linear system in (A, F, a, lam); what depends on velocity is found by differences of numbers along
the motion, not by derivatives of expressions.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

from eomgen.mechanics.armature import armature_bias, armature_mass
from eomgen.mechanics.inertia import mass_properties
from eomgen.mechanics.kinematics import Link
from eomgen.mechanics.loads import body_wrench, weights
from eomgen.mechanics.system import System
from eomgen.mechanics.work import joint_forces, placeless_forces
from eomgen.symbolic.derivative import gradient
from eomgen.symbolic.evaluation import evaluate, fifty_digits
from eomgen.symbolic.graph import Node, Scalar

State = dict[Node, Any]


@dataclass(frozen=True)
class Numbers:
    """Values of expressions at a state, and along the motion through it."""

    system: System
    state: State

    def at(self, scalars: tuple[Scalar, ...], shift: int = 0) -> list[Any]:
        """Values at the state, or a step of 1e-15 later (shift = 1) or earlier (-1) on the path with constant u."""
        values = dict(self.state)
        if shift:
            arithmetic = fifty_digits()
            rates = evaluate(self.system.scope.rates, self.state, arithmetic)
            h = arithmetic.number(1) * shift * _step(arithmetic)
            for q, rate in zip(self.system.scope.symbols.q, rates, strict=True):
                values[q] = values[q] + h * rate
            t = self.system.scope.symbols.t
            values[t] = values[t] + h
        return evaluate(scalars, values, fifty_digits())

    def array(self, scalars: Any) -> np.ndarray:
        """Values as floats, in the shape of the nested tuples."""
        flat, shape = _flattened(scalars)
        return np.array([float(x) for x in self.at(flat)]).reshape(shape)

    def rate(self, scalars: Any) -> np.ndarray:
        """Time derivative at a = 0 by central differences."""
        flat, shape = _flattened(scalars)
        after, before = self.at(flat, 1), self.at(flat, -1)
        step = _step(fifty_digits())
        return np.array([float((x - y) / (2 * step)) for x, y in zip(after, before, strict=True)]).reshape(shape)


def free_body_accelerations(system: System, state: State) -> np.ndarray:
    """a at a state, from the free bodies.

    Args:
        state: values of all symbols, at 50 digits.
    """
    numbers = Numbers(system, state)
    links = system.motion.links
    n, nu, k = len(links), len(system.scope.symbols.u), len(system.ties.closing)
    size = 12 * n + nu + k
    A, right = np.zeros((size, size)), np.zeros(size)
    speeds, multipliers = slice(12 * n, 12 * n + nu), slice(12 * n + nu, size)
    columns, biases = [], []
    for i, link in enumerate(links):
        column, bias = _joint(numbers, link)
        columns.append(column)
        biases.append(bias)
        motion, wrench = slice(6 * i, 6 * i + 6), slice(6 * (n + i), 6 * (n + i) + 6)
        inertia, push = _body(numbers, link)
        A[motion, motion], A[motion, wrench], right[motion] = inertia, -np.eye(6), push
        A[wrench, motion], A[wrench, speeds], right[wrench] = np.eye(6), -column, bias
        if link.parent >= 0:
            X = _transfer(numbers, link, links[link.parent])
            A[wrench, 6 * link.parent : 6 * link.parent + 6] = -X
            A[6 * link.parent : 6 * link.parent + 6, wrench] = X.T
        A[speeds, wrench] = column.T
    direct = [a + b for a, b in zip(joint_forces(system.loads), placeless_forces(system.loads), strict=True)]
    rotors = armature_bias(system.motion, nu)
    right[speeds] = numbers.array(tuple(a - b for a, b in zip(direct, rotors, strict=True))) if nu else 0
    for i, j, value in armature_mass(system.motion):
        A[12 * n + i, 12 * n + j] += numbers.array((value,))[0]
    _close(numbers, A, right, multipliers)
    return np.linalg.lstsq(A, right, rcond=1e-13)[0][speeds]


def _body(numbers: Numbers, link: Link) -> tuple[np.ndarray, np.ndarray]:
    """(I, W - p) of a free body about its joint point, body axes: W the applied wrench, p what velocity takes."""
    system = numbers.system
    mass = mass_properties(system.scope, link.name)
    m, com, I_com = float(numbers.array((mass.m,))[0]), numbers.array(mass.com), numbers.array(mass.I)
    w = numbers.array(link.twist.w)
    c = com - numbers.array(link.point)
    C = _tilde(c)
    inertia = np.block([[I_com - m * C @ C, m * C], [-m * C, m * np.eye(3)]])
    centripetal = m * np.cross(w, np.cross(w, c))
    p = np.concatenate([np.cross(w, I_com @ w) + np.cross(c, centripetal), centripetal])
    applied = np.zeros(6)
    for load in (*system.loads.placed, *weights(system.loads)):
        found = body_wrench(system.motion, load)
        if found is not None and found[0] == link.name:
            applied += _about_joint(numbers, link, found[1])
    return inertia, applied - p


def _about_joint(numbers: Numbers, link: Link, wrench: Any) -> np.ndarray:
    tau, f = numbers.array(wrench.tau), numbers.array(wrench.f)
    return np.concatenate([tau - np.cross(numbers.array(link.point), f), f])


def _joint(numbers: Numbers, link: Link) -> tuple[np.ndarray, np.ndarray]:
    """(S D, b): the joint's columns per speed, and the acceleration of the child against the parent at a = 0."""
    u = numbers.system.scope.symbols.u
    if link.joint is None:
        return np.zeros((6, len(u))), np.zeros(6)
    S = np.array([[*numbers.array(w), *numbers.array(v)] for w, v in link.S]).reshape(len(link.S), 6).T
    D = np.array([numbers.array(gradient(rate, u)) for rate in link.s_rate]).reshape(len(link.s_rate), len(u))
    local = link.before.then(link.relative)
    R_CP = numbers.array(local.R).T
    offset = numbers.array(local.p)
    w_child = numbers.array(link.twist.w)
    parent = numbers.system.motion.links[link.parent] if link.parent >= 0 else None
    if parent is None:
        w_p = np.zeros(3)
    else:
        w_p, offset = numbers.array(parent.twist.w), offset - numbers.array(parent.point)
    first, second = _path_rates(numbers, local.p, parent)
    turning = R_CP @ w_p
    spin_rate = _relative_spin_rate(numbers, link)
    acc = np.cross(w_p, np.cross(w_p, offset)) + 2 * np.cross(w_p, first) + second
    return S @ D, np.concatenate([spin_rate + np.cross(turning, w_child - turning), R_CP @ acc])


def _path_rates(numbers: Numbers, p: Any, parent: Link | None) -> tuple[np.ndarray, np.ndarray]:
    """First and second time derivative (at a = 0) of the seat in the parent, by differences."""
    flat = tuple(p) if parent is None else tuple(x - y for x, y in zip(p, parent.point, strict=True))
    scope = numbers.system.scope
    first = scope.time_derivative(flat)
    return numbers.rate(flat), numbers.rate(first)


def _relative_spin_rate(numbers: Numbers, link: Link) -> np.ndarray:
    """Apparent rate, in the child's axes, of its angular velocity against the parent, at a = 0."""
    spin = tuple(
        sum((rate * w[j] for rate, (w, _) in zip(link.s_rate, link.S, strict=True)), start=0) for j in range(3)
    )
    return numbers.rate(spin)


def _transfer(numbers: Numbers, link: Link, parent: Link) -> np.ndarray:
    """X: acceleration of the parent's joint point, parent's axes -> that of the child's seat, child's axes."""
    local = link.before.then(link.relative)
    R_CP = numbers.array(local.R).T
    r = numbers.array(local.p) - numbers.array(parent.point)
    return np.block([[R_CP, np.zeros((3, 3))], [-R_CP @ _tilde(r), R_CP]])


def _close(numbers: Numbers, A: np.ndarray, right: np.ndarray, multipliers: slice) -> None:
    """Columns of the closing rows' wrenches, and the rows W^T A + d/dt(W^T) xi ... = 0 as J a + gamma = 0."""
    system = numbers.system
    n = len(system.motion.links)
    for j, row in enumerate(system.ties.closing):
        place = multipliers.start + j
        for body, wrench in row.wrenches:
            i = system.motion.index[body]
            A[6 * i : 6 * i + 6, place] -= _about_joint(numbers, system.motion.links[i], wrench)
        J = gradient(row.velocity, system.scope.symbols.u)
        A[place, 12 * n : 12 * n + len(J)] = numbers.array(J)
        if not row.wrenches:
            A[12 * n : 12 * n + len(J), place] = -numbers.array(J)
        right[place] = -float(numbers.rate((row.velocity,))[0])


def _tilde(a: np.ndarray) -> np.ndarray:
    return np.array([[0, -a[2], a[1]], [a[2], 0, -a[0]], [-a[1], a[0], 0]])


def _step(arithmetic: Any) -> Any:
    return arithmetic.number(1) / arithmetic.number(10**15)


def _flattened(scalars: Any) -> tuple[tuple[Scalar, ...], tuple[int, ...]]:
    """A scalar tuple or a tuple of rows, flat, and its shape."""
    if scalars and isinstance(scalars[0], tuple):
        return tuple(x for row in scalars for x in row), (len(scalars), len(scalars[0]))
    return tuple(scalars), (len(scalars),)
