"""Lagrange's equations of the second kind, by derivatives of the energies.

    d/dt dT/du_k - dT/dq_k = Q_k,   M = d2T/du du,   c = (d/dt dT/du at a = 0) - dT/dq
"""

from __future__ import annotations

from eomgen.mechanics.assembly import Assembly, Row, assembled
from eomgen.mechanics.inertia import kinetic_energy
from eomgen.mechanics.kinematics import Motion
from eomgen.mechanics.system import System
from eomgen.mechanics.work import generalized_forces, per_speed
from eomgen.symbolic.derivative import gradient, jacobian
from eomgen.symbolic.graph import Scalar

name = "lagrange"
title = "Lagrange's equations"


def applies(system: System) -> bool:
    """Every speed is the rate of a coordinate."""
    return True


def assemble(system: System) -> Assembly:
    """The equations of motion from the energies; closing rows by multipliers."""
    T = kinetic_energy(system.motion)
    M, c = inertia_side(system.motion, T)
    return assembled(system, M=M, c=c, Q=generalized_forces(system.loads), T=T)


def inertia_side(motion: Motion, T: Scalar) -> tuple[tuple[Row, ...], Row]:
    """(M, c) by derivatives of the kinetic energy."""
    scope = motion.scope
    momenta = gradient(T, scope.symbols.u)
    M = jacobian(momenta, scope.symbols.u)
    held = per_speed(motion, gradient(T, scope.symbols.q))
    c = tuple(p - k for p, k in zip(scope.time_derivative(momenta), held, strict=True))
    return M, c
