"""Lagrange's equations of the second kind, by derivatives of the energies.

    d/dt dT/du_k - dT/dq_k = Q_k,   M = d2T/du du,   c = (d/dt dT/du at a = 0) - dT/dq

Where coordinates were eliminated, u_free = N u + nu, the equations of the free system are reduced:

    M_r = N^T M N,   c_r = N^T (c + M (N' u + nu')),   Q_r = N^T Q
"""

from __future__ import annotations

from eomgen.mechanics.bodies.inertia import kinetic_energy
from eomgen.mechanics.bodies.kinematics import Motion
from eomgen.mechanics.equations.equations_of_motion import EquationsOfMotion, assembled
from eomgen.mechanics.equations.system import System
from eomgen.mechanics.equations.work import generalized_forces, per_speed
from eomgen.symbolic.expression.derivative import gradient, jacobian, pullback, substituted, tangent
from eomgen.symbolic.expression.functions import inner
from eomgen.symbolic.expression.graph import Scalar
from eomgen.symbolic.expression.node import ScalarRow


def assembled_by_energies(system: System) -> EquationsOfMotion:
    """The equations of motion from the energies; closing rows by multipliers."""
    if system.free is not None:
        return _reduced(system, system.free)
    T = kinetic_energy(system.motion)
    M, c = inertia_by_energies(system.motion, T)
    return assembled(system, M=M, c=c, Q=generalized_forces(system.loads), T=T)


def _reduced(system: System, free: System) -> EquationsOfMotion:
    """The free system's M, c and Q along the motions that are left, its speeds in terms of the independent ones."""
    whole = assembled_by_energies(free)
    rates = free_rates(system, free)
    known = dict(zip(free.scope.symbols.u, rates, strict=True))
    N = jacobian(rates, system.scope.symbols.u)
    bias = system.scope.time_derivative(rates)
    n, entries = len(whole.M), [x for row in whole.M for x in row]
    (T, *rest) = substituted((whole.T, *whole.c, *whole.Q, *entries), known)  # at once: they share nearly everything
    c, Q, M = rest[:n], rest[n : 2 * n], [rest[k : k + n] for k in range(2 * n, len(rest), n)]
    carried = [inertia + inner(row, bias) for inertia, row in zip(c, M, strict=True)]
    columns = tuple(zip(*N, strict=True))
    columned = [[inner(row, column) for row in M] for column in columns]
    return assembled(
        system,
        M=tuple(tuple(inner(column, momentum) for momentum in columned) for column in columns),
        c=tuple(inner(column, carried) for column in columns),
        Q=tuple(inner(column, Q) for column in columns),
        T=T,
    )


def energies_along(system: System) -> tuple[ScalarRow, ScalarRow, ScalarRow]:
    """(M a, c, Q) by derivatives of the energies along one motion: O(n), no entry of M is formed."""
    if system.free is None:
        return _along(system, system.symbols.a)
    u, free = system.scope.symbols.u, system.free
    rates = free_rates(system, free)
    bias = system.scope.time_derivative(rates)
    rows = (*_along(free, tangent(rates, dict(zip(u, system.symbols.a, strict=True)))), _along(free, bias)[0])
    known = dict(zip(free.scope.symbols.u, rates, strict=True))
    found = substituted([x for row in rows for x in row], known)
    Ma, c, Q, carried = (found[k : k + len(rates)] for k in range(0, len(found), len(rates) or 1))
    inertia = tuple(x + y for x, y in zip(c, carried, strict=True))
    return pullback(rates, Ma, u), pullback(rates, inertia, u), pullback(rates, Q, u)


def _along(system: System, a: ScalarRow) -> tuple[ScalarRow, ScalarRow, ScalarRow]:
    """The same for given accelerations of a system whose speeds are rates."""
    scope, u = system.scope, system.scope.symbols.u
    T = kinetic_energy(system.motion)
    momenta = gradient(T, u)
    held = per_speed(system.motion, gradient(T, scope.symbols.q))
    c = tuple(p - k for p, k in zip(scope.time_derivative(momenta), held, strict=True))
    return tangent(momenta, dict(zip(u, a, strict=True))), c, generalized_forces(system.loads)


def free_rates(system: System, free: System) -> ScalarRow:
    """The speeds of the free system by those that are left: N u + nu without the driven coordinates."""
    rates = {q.name: rate for q, rate in zip(system.scope.symbols.q, system.scope.rates, strict=True)}
    return tuple(rates[u.name[:-1]] for u in free.scope.symbols.u)


def inertia_by_energies(motion: Motion, T: Scalar) -> tuple[tuple[ScalarRow, ...], ScalarRow]:
    """(M, c) by derivatives of the kinetic energy."""
    scope = motion.scope
    momenta = gradient(T, scope.symbols.u)
    M = jacobian(momenta, scope.symbols.u)
    held = per_speed(motion, gradient(T, scope.symbols.q))
    c = tuple(p - k for p, k in zip(scope.time_derivative(momenta), held, strict=True))
    return M, c
