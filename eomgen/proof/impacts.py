"""The equations of an impact -> checks, at random exact states, by the momenta of the bodies and by their energies.

sum_b m dv . dv/du_k + I dw . dw/du_k = sum of the impulses' wrenches . d(twists)/du_k
v+ = - e v- of what closes, 0 of what holds;   T- - T+ is the loss
the same jump by the law in numbers (complementarity) where it pushes
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from functools import partial
from random import Random
from typing import Any

import numpy as np

from eomgen.mechanics.impacts import Hit, ImpactEquations, jump
from eomgen.mechanics.kinematics import SystemInertia
from eomgen.proof.check import Check, Tally
from eomgen.proof.states import real_state
from eomgen.symbolic.expression import Node, Scalar, State, jacobian
from eomgen.symbolic.numeric import NoValue, evaluate, fifty_digits, tolerances

SEEDS = (5, 6, 7)


def impact_checks(found: ImpactEquations) -> Iterator[Check]:
    """Check impulses, speeds and loss of an impact."""
    momenta = Tally("impulses change the momenta of the bodies to those of the speeds after it", "momenta, 50 digits")
    speeds = Tally("what closes leaves with e times its approach, what holds is at rest", "velocities, 50 digits")
    energies = Tally("the loss is the kinetic energy before less that after", "energies by the poses, 50 digits")
    numbers = Tally("the law of impact in numbers gives the same jump", "complementarity in doubles")
    for seed in SEEDS:
        state = real_state(found.system, Random(seed))
        after = _solved(found, state)
        momenta.add(f"state {seed}", partial(_unbalanced, found, state, after))
        speeds.add(f"state {seed}", partial(_leaves_otherwise, found, state, after))
        energies.add(f"state {seed}", partial(_lost_otherwise, found, state, after))
        numbers.add(f"state {seed}", partial(_jumps_otherwise, found, state))
    for tally in (momenta, speeds, energies, numbers):
        yield from tally.checks()


def _solved(found: ImpactEquations, state: State) -> dict[Node, Any]:
    """The speeds after it and the impulses at a state."""
    unknowns = tuple(found.solution)
    return dict(zip(unknowns, evaluate(tuple(found.solution.values()), state, fifty_digits()), strict=True))


def _later(found: ImpactEquations, after: Mapping[Node, Any]) -> dict[Node, Any]:
    """The speeds of the state after it."""
    return {u: after[x] for u, x in zip(found.u, found.after, strict=True)}


def _unbalanced(found: ImpactEquations, state: State, after: Mapping[Node, Any]) -> str:
    """Message that names a speed along which momentum and impulses differ; "".

    P_k = sum_b m v . dv/du_k + I w . dw/du_k + armature s' ds'/du_k
    """
    motion, u = found.system.motion, found.u
    moved: list[Scalar] = []
    momenta: list[Scalar] = []
    for link in motion.links:
        mass = found.system.scope.mass_properties(link.name)
        v = motion.velocity((link.name, mass.com))
        moved += [*v, *link.twist.w]
        momenta += [*(mass.m * x for x in v), *(mass.I @ link.twist.w)]
    inertia = SystemInertia(motion)
    for link, k, armature in inertia.rotors:
        moved.append(link.s_rate[k])
        momenta.append(armature * link.s_rate[k])
    moved += found.system.scope.rates
    momenta += inertia.given_momenta
    slopes = _numbers(tuple(x for row in jacobian(tuple(moved), u) for x in row), state)
    before, later = (_numbers(tuple(momenta), {**state, **more}) for more in ({}, _later(found, after)))
    pushed = _pushed(found, state, after)
    for k, node in enumerate(u):
        change = sum((b - a) * slopes[m * len(u) + k] for m, (a, b) in enumerate(zip(before, later, strict=True)))
        if abs(change - pushed[k]) > tolerances.ZERO_AT_50 * (1 + abs(change)):
            given = f"the impulses give {float(pushed[k]):.10g}"
            return f"along {node.name} the momentum changes by {float(change):.10g}, {given}"
    return ""


def _pushed(found: ImpactEquations, state: State, after: Mapping[Node, Any]) -> list[Any]:
    """Generalized impulses: of each row by its wrenches on the bodies, of a row of coordinates by its own slopes."""
    u, motion = found.u, found.system.motion
    total: list[Any] = [0] * len(u)
    for row in found.rows:
        along: list[Any] = [0] * len(u)
        for body, wrench in row.row.wrenches:
            twist = motion.link(body).twist
            slopes = _numbers(tuple(x for r in jacobian((*twist.w, *twist.v), u) for x in r), state)
            W = _numbers((*wrench.tau, *wrench.f), state)
            along = [a + sum(W[m] * slopes[m * len(u) + k] for m in range(6)) for k, a in enumerate(along)]
        if not row.row.wrenches:
            along = _numbers(row.J, state)
        total = [a + after[row.impulse] * b for a, b in zip(total, along, strict=True)]
    return total


def _numbers(scalars: tuple[Scalar, ...], state: State) -> list[Any]:
    return list(evaluate(scalars, state, fifty_digits()))


def _leaves_otherwise(found: ImpactEquations, state: State, after: Mapping[Node, Any]) -> str:
    """Message that names a row which leaves with another velocity than its law says; "".

    The velocities are those of the rows themselves, not J u + sigma.
    """
    for row in found.rows:
        before, later = (_numbers((row.row.velocity,), {**state, **x})[0] for x in ({}, _later(found, after)))
        due = 0 if row.e is None else -_numbers((row.e,), state)[0] * before
        if abs(later - due) > tolerances.ZERO_AT_50 * (1 + abs(before)):
            return f"'{row.name}' leaves with {float(later):.10g}, its law says {float(due):.10g}"
    return ""


def _lost_otherwise(found: ImpactEquations, state: State, after: Mapping[Node, Any]) -> str:
    T = SystemInertia(found.system.motion).kinetic_energy
    before, later = (_numbers((T,), {**state, **x})[0] for x in ({}, _later(found, after)))
    (loss,) = _numbers((found.loss,), state)
    wrong = abs(before - later - loss) > tolerances.ZERO_AT_50 * (1 + abs(before))
    return f"{float(before - later):.10g} J are lost, the formula says {float(loss):.10g} J" if wrong else ""


def _jumps_otherwise(found: ImpactEquations, state: State) -> str:
    """Message if the law in numbers gives other speeds.

    Raises:
        NoValue: at this state an impulse would pull, or something is not approached: the law says another thing.
    """
    n = len(found.u)
    rows = [[*row.J, row.sigma] for row in found.rows]
    values = _numbers((*(x for row in found.M for x in row), *(x for row in rows for x in row)), state)
    M = np.array([float(x) for x in values[: n * n]]).reshape(n, n)
    at = np.array([float(x) for x in values[n * n :]]).reshape(-1, n + 1)
    held = at[[k for k, row in enumerate(found.rows) if row.e is None]]
    closes = [(k, row) for k, row in enumerate(found.rows) if row.e is not None]
    hits = [Hit(row.name, at[k][None], float(_numbers((row.e,), state)[0])) for k, row in closes if row.e is not None]
    drawn = np.array([float(state[x]) for x in found.u])
    for u in (drawn, -drawn):
        if len(held):
            u = u - np.linalg.lstsq(held[:, :-1], held[:, :-1] @ u + held[:, -1], rcond=None)[0]
        moved = {**state, **dict(zip(found.u, map(fifty_digits().number, u.tolist()), strict=True))}
        there = _solved(found, moved)
        if any(hit.speed(u) >= 0 for hit in hits) or any(there[row.impulse] < 0 for _, row in closes):
            continue
        due = np.array([float(there[x]) for x in found.after])
        jumped = jump(M, held, hits, u).u
        wrong = np.max(np.abs(jumped - due)) > tolerances.CARRIED * (1 + np.max(np.abs(due)))
        return f"the law in numbers gives {jumped}, the formulas {due}" if wrong else ""
    raise NoValue("nothing is approached, or an impulse would pull")
