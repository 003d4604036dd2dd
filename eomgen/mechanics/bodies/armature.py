"""Inertia that belongs to no body, added to M and c: rotors behind gears, and kinetic energies that are given.

Of a rotor T = armature s'^2 / 2. Of a given T(q, q', t), with p = dT/dq' and q' = N u + nu,

    M = N^T (dp/dq') N,   c = N^T (dp/dt at a = 0 - dT/dq)
"""

from __future__ import annotations

from collections.abc import Iterator

from eomgen.mechanics.bodies.kinematics import BodyLink, Motion
from eomgen.mechanics.bodies.scope import Scope
from eomgen.symbolic.expression.derivative import derivative, gradient, jacobian, substituted, symbols_of, tangent
from eomgen.symbolic.expression.functions import inner
from eomgen.symbolic.expression.graph import Scalar, is_zero
from eomgen.symbolic.expression.node import ScalarRow


def joint_row(motion: Motion, body: str, variable: int) -> dict[int, Scalar]:
    """Row of D: how the joint's rate depends on each speed."""
    rate = motion.link(body).s_rate[variable]
    speeds = {u: k for k, u in enumerate(motion.scope.symbols.u)}
    return {speeds[s]: derivative(rate, s) for s in symbols_of((rate,)) if s in speeds}


def armature_mass(motion: Motion) -> list[tuple[int, int, Scalar]]:
    """Entries (k, l, value) that are added to M: armature D_k D_l, and those of given energies."""
    rows = []
    for link, k, armature in armatures(motion):
        row = joint_row(motion, link.name, k)
        rows += [(i, j, armature * a * b) for i, a in row.items() for j, b in row.items()]
    return [*rows, *_given_mass(motion.scope)]


def armature_bias(motion: Motion, size: int) -> list[Scalar]:
    """What is added to c: armature D_k (d/dt s' at a = 0), and what given energies take at a = 0."""
    c: list[Scalar] = [0] * size
    for link, k, armature in armatures(motion):
        bias = motion.scope.time_derivative((link.s_rate[k],))[0]
        for i, factor in joint_row(motion, link.name, k).items():
            c[i] = c[i] + armature * factor * bias
    return [x + y for x, y in zip(c, _given_bias(motion.scope), strict=True)]


def armatures(motion: Motion) -> Iterator[tuple[BodyLink, int, Scalar]]:
    for link in motion.links:
        if link.joint is None:
            continue
        for k, effort in enumerate(link.joint.efforts()):
            if effort is not None and effort.armature is not None:
                yield link, k, motion.scope.value(effort.armature)


def given_energy(scope: Scope) -> Scalar:
    """T of the energies that are given, in the speeds [J]."""
    w, T = scope.given_kinetic
    return substituted((T,), dict(zip(w, scope.rates, strict=True)))[0]


def given_momenta(scope: Scope) -> ScalarRow:
    """p = dT/dq' of the energies that are given, one for each coordinate."""
    w, T = scope.given_kinetic
    return substituted(gradient(T, w), dict(zip(w, scope.rates, strict=True)))


def given_inertia(scope: Scope) -> ScalarRow:
    """What given energies take along each speed: their share of M a + c."""
    taken = list(_given_bias(scope))
    for i, j, value in _given_mass(scope):
        taken[i] = taken[i] + value * scope.symbols.a[j]
    return tuple(taken)


def _given_mass(scope: Scope) -> list[tuple[int, int, Scalar]]:
    w, T = scope.given_kinetic
    if is_zero(T):
        return []
    flat = [x for row in jacobian(gradient(T, w), w) for x in row]
    flat = list(substituted(flat, dict(zip(w, scope.rates, strict=True))))
    H = [flat[k : k + len(w)] for k in range(0, len(flat), len(w))]
    columns = list(zip(*scope.N, strict=True))
    pushed = [[inner(row, column) for row in H] for column in columns]
    entries = ((i, j, inner(a, b)) for i, a in enumerate(columns) for j, b in enumerate(pushed))
    return [entry for entry in entries if not is_zero(entry[2])]


def _given_bias(scope: Scope) -> ScalarRow:
    w, T = scope.given_kinetic
    if is_zero(T):
        return (0,) * len(scope.symbols.u)
    bias = scope.time_derivative(scope.rates)
    momenta = tangent(gradient(T, w), {**scope.flow, **dict(zip(w, bias, strict=True))})
    held = gradient(T, scope.symbols.q)
    rows = [p - x for p, x in zip(momenta, held, strict=True)]
    rows = list(substituted(rows, dict(zip(w, scope.rates, strict=True))))
    return tuple(inner(column, rows) for column in zip(*scope.N, strict=True))
