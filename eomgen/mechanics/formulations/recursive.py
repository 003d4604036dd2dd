"""The recursive forms: bias forces body by body, mass matrix by composite bodies. For trees."""

from __future__ import annotations

from eomgen.mechanics.bodies.armature import armature_bias, armature_mass
from eomgen.mechanics.bodies.inertia import kinetic_energy
from eomgen.mechanics.bodies.kinematics import Motion
from eomgen.mechanics.bodies.loads import Loads
from eomgen.mechanics.bodies.recursion import applied_wrenches, bias_forces, composite_mass_matrix
from eomgen.mechanics.bodies.tree import Branch, branches_of
from eomgen.mechanics.equations.equations_of_motion import EquationsOfMotion, assembled
from eomgen.mechanics.equations.system import System
from eomgen.mechanics.equations.work import generalized_forces, joint_forces, placeless_forces
from eomgen.symbolic.expression.node import ScalarRow
from eomgen.symbolic.expression.spatial import ZERO, times


def assembled_by_recursion(system: System) -> EquationsOfMotion:
    """The equations of motion by recursion over the tree; closing rows by multipliers."""
    motion = system.motion
    branches = branches_of(motion)
    return assembled(
        system,
        M=mass(motion, branches),
        c=inertia_terms(motion, branches),
        Q=generalized_forces(system.loads),
        T=kinetic_energy(motion),
        forcing=forcing(system.loads, branches),
    )


def inertia_terms(motion: Motion, branches: tuple[Branch, ...]) -> ScalarRow:
    """c: what inertia takes at a = 0, armatures included."""
    size = len(motion.scope.symbols.u)
    bias = bias_forces(branches, size, base_acceleration=ZERO, applied={})
    return tuple(a + b for a, b in zip(bias, armature_bias(motion, size), strict=True))


def forcing(loads: Loads, branches: tuple[Branch, ...]) -> ScalarRow:
    """Q - c in one sweep, weight as an upward acceleration of the ground."""
    motion = loads.motion
    size = len(motion.scope.symbols.u)
    bias = bias_forces(
        branches,
        size,
        base_acceleration=times(-1, loads.fields),
        applied=applied_wrenches(loads, branches),
    )
    direct = [a + b for a, b in zip(joint_forces(loads), placeless_forces(loads), strict=True)]
    armature = armature_bias(motion, size)
    return tuple(q - b - r for q, b, r in zip(direct, bias, armature, strict=True))


def mass(motion: Motion, branches: tuple[Branch, ...]) -> tuple[ScalarRow, ...]:
    """M by composite bodies, armatures included."""
    M = composite_mass_matrix(branches, len(motion.scope.symbols.u))
    for i, j, value in armature_mass(motion):
        M[i][j] = M[i][j] + value
    return tuple(tuple(row) for row in M)
