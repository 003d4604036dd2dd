"""Newton-Euler of every body, projected on the motions that the joints allow.

M = sum B^T I B,   c = sum B^T (I alpha + xi x* (I xi)),   Q = sum B^T W
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence

from eomgen.mechanics.bodies.armature import armature_bias, armature_mass
from eomgen.mechanics.bodies.inertia import kinetic_energy, mass_properties
from eomgen.mechanics.bodies.kinematics import Motion
from eomgen.mechanics.bodies.loads import Loads, body_wrench, joint_wrenches, weights
from eomgen.mechanics.equations.equations_of_motion import EquationsOfMotion, assembled
from eomgen.mechanics.equations.system import System
from eomgen.mechanics.equations.work import placeless_forces
from eomgen.symbolic.expression.derivative import pullback, tangent
from eomgen.symbolic.expression.graph import Node, Scalar, is_zero
from eomgen.symbolic.expression.node import ScalarRow
from eomgen.symbolic.expression.spatial import ZERO, SpatialInertia, Twist, Wrench, cross, plus, vector_of


def assembled_by_wrenches(system: System) -> EquationsOfMotion:
    """The equations of motion from wrenches and twists; closing rows by multipliers."""
    M, c = inertia_by_twists(system.motion)
    return assembled(system, M=M, c=c, Q=force_side(system.loads), T=kinetic_energy(system.motion))


def wrenches_along(system: System) -> tuple[ScalarRow, ScalarRow, ScalarRow]:
    """(M a, c, Q) by the wrenches of one motion, B^T applied in one sweep: O(n), no entry of M is formed."""
    motion, a = system.motion, system.symbols.a
    u = motion.scope.symbols.u
    twists = tuple(x for link in motion.links for x in (*link.twist.w, *link.twist.v))
    pushed = tangent(twists, dict(zip(u, a, strict=True)))
    inertia, bias = [], []
    for i, link in enumerate(motion.links):
        mass = mass_properties(motion.scope, link.name)
        body = SpatialInertia.about_center(mass.m, mass.com, mass.I)
        inertia.append(body.momentum(_twist(pushed[6 * i : 6 * i + 6])))
        bias.append(_bias(body, link.twist, _twist(motion.alpha[i])))
    Ma = list(_projected(twists, inertia, u))
    for i, j, value in armature_mass(motion):
        Ma[i] = Ma[i] + value * a[j]
    rotors = armature_bias(motion, len(u))
    c = tuple(x + y for x, y in zip(_projected(twists, bias, u), rotors, strict=True))
    applied = applied_to_bodies(system.loads)
    none = Wrench(ZERO, ZERO)
    Q = _projected(twists, [applied.get(link.name, none) for link in motion.links], u)
    return tuple(Ma), c, tuple(x + y for x, y in zip(Q, placeless_forces(system.loads), strict=True))


def _projected(twists: ScalarRow, wrenches: Iterable[Wrench], u: Sequence[Node]) -> ScalarRow:
    """sum B^T W"""
    return pullback(twists, [x for wrench in wrenches for x in (*wrench.tau, *wrench.f)], u)


def inertia_by_twists(motion: Motion) -> tuple[tuple[ScalarRow, ...], ScalarRow]:
    """(M, c) from the twists of the bodies."""
    size = len(motion.scope.symbols.u)
    M: list[list[Scalar]] = [[0] * size for _ in range(size)]
    c: list[Scalar] = [0] * size
    for i, link in enumerate(motion.links):
        mass = mass_properties(motion.scope, link.name)
        inertia = SpatialInertia.about_center(mass.m, mass.com, mass.I)
        columns = [column for column in zip(*motion.B[i], strict=True)]
        touched = [k for k, column in enumerate(columns) if not all(is_zero(x) for x in column)]
        bias = _bias(inertia, link.twist, _twist(motion.alpha[i]))
        for k in touched:
            c[k] = c[k] + _twist(columns[k]).power(bias)
            momentum = inertia.momentum(_twist(columns[k]))
            for j in touched:
                if j >= k:
                    M[k][j] = M[k][j] + _twist(columns[j]).power(momentum)
    for k in range(size):
        for j in range(k):
            M[k][j] = M[j][k]
    return _with_armatures(motion, M, c)


def _bias(inertia: SpatialInertia, xi: Twist, alpha: Twist) -> Wrench:
    """I alpha + xi x* (I xi): the wrench that the motion takes at a = 0, body axes, at the origin."""
    momentum = inertia.momentum(xi)
    turning = Wrench(plus(cross(xi.w, momentum.tau), cross(xi.v, momentum.f)), cross(xi.w, momentum.f))
    return inertia.momentum(alpha).plus(turning)


def _twist(entries: Sequence[Scalar]) -> Twist:
    return Twist(vector_of(entries[:3]), vector_of(entries[3:]))


def _with_armatures(motion: Motion, M: list[list[Scalar]], c: list[Scalar]) -> tuple[tuple[ScalarRow, ...], ScalarRow]:
    for i, j, value in armature_mass(motion):
        M[i][j] = M[i][j] + value
    added = armature_bias(motion, len(c))
    return tuple(tuple(row) for row in M), tuple(a + b for a, b in zip(c, added, strict=True))


def force_side(loads: Loads) -> ScalarRow:
    """Q = sum B^T W of every wrench, and what acts at no place."""
    motion = loads.motion
    Q = list(placeless_forces(loads))
    for body, wrench in applied_to_bodies(loads).items():
        rows = motion.B[motion.index[body]]
        for k in range(len(Q)):
            Q[k] = Q[k] + _twist([row[k] for row in rows]).power(wrench)
    return tuple(Q)


def applied_to_bodies(loads: Loads) -> dict[str, Wrench]:
    """What is applied to each body, efforts of joints included: at its origin, in its axes."""
    motion = loads.motion
    wrenches = [body_wrench(motion, load) for load in (*loads.placed, *weights(loads))]
    wrenches += [pair for effort in loads.efforts for pair in joint_wrenches(motion, effort)]
    total: dict[str, Wrench] = {}
    for found in wrenches:
        if found is not None:
            body, wrench = found
            total[body] = total[body].plus(wrench) if body in total else wrench
    return total
