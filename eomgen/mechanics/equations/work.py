"""Loads -> generalized forces by virtual work on positions and by derivatives of the potential energy."""

from __future__ import annotations

from collections.abc import Callable

from eomgen.mechanics.bodies.inertia import spin_of
from eomgen.mechanics.bodies.kinematics import Motion, slide_of
from eomgen.mechanics.bodies.loads import Applied, JointEffort, Loads, in_body_axes, in_ground_axes, weights
from eomgen.model.forces.load import Couple, GeneralizedForce, Load, PointForce, UniformField
from eomgen.symbolic.expression.derivative import gradient, jacobian
from eomgen.symbolic.expression.graph import Scalar
from eomgen.symbolic.expression.node import ScalarRow, ScalarRows
from eomgen.symbolic.expression.spatial import ZERO, Vector, dot, vector_of


def generalized_forces(loads: Loads) -> ScalarRow:
    """Q_k of everything applied: -dV/dq_k where there is a potential, else the virtual work per unit of q_k."""
    rows = [force_row(loads, force) for force in loads.applied] + [effort_row(loads.motion, e) for e in loads.efforts]
    return summed(rows, len(loads.motion.scope.symbols.u))


def powered_forces(loads: Loads) -> ScalarRow:
    """Q_nc: the part of Q that comes from no potential, by virtual work."""
    motion = loads.motion
    rows = [force_row(loads, force) for force in loads.applied if force.potential is None]
    rows += [drive_row(motion, effort) for effort in loads.efforts]
    return summed(rows, len(motion.scope.symbols.u))


def acting(loads: Loads, holds: Callable[[ScalarRow], bool]) -> str:
    """What acts with generalized forces of which something holds, by its name: "the force 'd' and the joint of 'x'"."""
    found = [f"the force '{force.name}'" for force in loads.applied if holds(force_row(loads, force))]
    found += [f"the joint of '{effort.body}'" for effort in loads.efforts if holds(effort_row(loads.motion, effort))]
    return " and ".join(dict.fromkeys(found))


def summed(rows: list[ScalarRow], size: int) -> ScalarRow:
    """The sum of rows, entry by entry."""
    sums: list[Scalar] = [0] * size
    for row in rows:
        sums = [a + b for a, b in zip(sums, row, strict=True)]
    return tuple(sums)


def force_row(loads: Loads, force: Applied) -> ScalarRow:
    """Q of one named force."""
    if force.potential is not None:
        return from_potential(loads.motion, force.potential)
    size = len(loads.motion.scope.symbols.u)
    return summed([load_row(loads, load) for load in force.loads], size)


def effort_row(motion: Motion, effort: JointEffort) -> ScalarRow:
    """Q of a joint's drive, spring and damper: drive ds/dq - dV/dq."""
    elastic = from_potential(motion, effort.potential)
    return tuple(d + e for d, e in zip(drive_row(motion, effort), elastic, strict=True))


def drive_row(motion: Motion, effort: JointEffort) -> ScalarRow:
    """Q of what a joint's drive and damper do: drive ds/dq."""
    s = motion.link(effort.body).s[effort.variable]
    return tuple(effort.drive * d for d in per_speed(motion, gradient(s, motion.scope.symbols.q)))


def from_potential(motion: Motion, V: Scalar) -> ScalarRow:
    """-N^T dV/dq."""
    return tuple(-x for x in per_speed(motion, gradient(V, motion.scope.symbols.q)))


def per_speed(motion: Motion, row: ScalarRow) -> ScalarRow:
    """N^T applied to a row over the coordinates."""
    N = motion.scope.N
    size = len(motion.scope.symbols.u)
    return tuple(sum((N[i][k] * x for i, x in enumerate(row)), start=0) for k in range(size))


def load_row(loads: Loads, load: Load) -> ScalarRow:
    """Q of one load by virtual work."""
    motion = loads.motion
    symbols = motion.scope.symbols
    if isinstance(load, GeneralizedForce):
        row = tuple(load.value if q.name == load.coordinate else 0 for q in symbols.q)
        return per_speed(motion, row)
    if isinstance(load, UniformField):
        return summed([load_row(loads, weight) for weight in weights(loads)], len(symbols.u))
    if isinstance(load, Couple):
        spin = jacobian(spin_of(motion, motion.link(load.body)), symbols.u)
        couple = in_body_axes(motion, load.body, load.couple, load.axes)
        return _weighted(couple, spin, len(symbols.u))
    position = jacobian(motion.position(load.place), symbols.q)
    force = in_ground_axes(motion, load.force, load.axes)
    return per_speed(motion, _weighted(force, position, len(symbols.q)))


def _weighted(force: Vector, rows: ScalarRows, size: int) -> ScalarRow:
    """force . d(position)/dq_k for each k."""
    return tuple(dot(force, vector_of(row[k] for row in rows)) for k in range(size))


def placeless_forces(loads: Loads) -> ScalarRow:
    """Q of what no twist sees: generalized forces, energies of coordinates, forces along the slide of their points."""
    size = len(loads.motion.scope.symbols.u)
    rows = [load_row(loads, load) for load in loads.generalized]
    energies = [force.potential for force in loads.applied if force.placeless]
    rows += [from_potential(loads.motion, V) for V in energies if V is not None]
    rows += [_sliding_row(loads.motion, load) for load in loads.placed if isinstance(load, PointForce)]
    return summed(rows, size)


def _sliding_row(motion: Motion, force: PointForce) -> ScalarRow:
    """Q of a force whose point moves in its body: F . d(R r')/du."""
    u = motion.scope.symbols.u
    slide = slide_of(motion, force.place)
    if slide == ZERO:
        return (0,) * len(u)
    return _weighted(in_ground_axes(motion, force.force, force.axes), jacobian(slide, u), len(u))


def joint_forces(loads: Loads) -> ScalarRow:
    """Q of the joints' efforts on the joint variables: D^T effort."""
    motion = loads.motion
    size = len(motion.scope.symbols.u)
    rows = []
    for effort in loads.efforts:
        rate = motion.link(effort.body).s_rate[effort.variable]
        rows.append(tuple(effort.effort * d for d in gradient(rate, motion.scope.symbols.u)))
    return summed(rows, size)
