"""Rotors behind gears: T = armature s'^2 / 2, added to M and c."""

from __future__ import annotations

from collections.abc import Iterator

from eomgen.mechanics.bodies.kinematics import BodyLink, Motion
from eomgen.symbolic.expression.derivative import derivative, symbols_of
from eomgen.symbolic.expression.graph import Scalar


def joint_row(motion: Motion, body: str, variable: int) -> dict[int, Scalar]:
    """Row of D: how the joint's rate depends on each speed."""
    rate = motion.link(body).s_rate[variable]
    speeds = {u: k for k, u in enumerate(motion.scope.symbols.u)}
    return {speeds[s]: derivative(rate, s) for s in symbols_of((rate,)) if s in speeds}


def armature_mass(motion: Motion) -> list[tuple[int, int, Scalar]]:
    """Entries (k, l, value) that rotors behind gears add to M: armature D_k D_l."""
    rows = []
    for link, k, armature in armatures(motion):
        row = joint_row(motion, link.name, k)
        rows += [(i, j, armature * a * b) for i, a in row.items() for j, b in row.items()]
    return rows


def armature_bias(motion: Motion, size: int) -> list[Scalar]:
    """What rotors behind gears add to c: armature D_k (d/dt s' at a = 0)."""
    c: list[Scalar] = [0] * size
    for link, k, armature in armatures(motion):
        bias = motion.scope.time_derivative((link.s_rate[k],))[0]
        for i, factor in joint_row(motion, link.name, k).items():
            c[i] = c[i] + armature * factor * bias
    return c


def armatures(motion: Motion) -> Iterator[tuple[BodyLink, int, Scalar]]:
    for link in motion.links:
        if link.joint is None:
            continue
        for k, effort in enumerate(link.joint.efforts()):
            if effort is not None and effort.armature is not None:
                yield link, k, motion.scope.value(effort.armature)
