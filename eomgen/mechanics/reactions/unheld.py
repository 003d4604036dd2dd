"""Balance, Solution -> refusal of a motion of bodies that no reaction resists and no coordinate describes.

The rows that the reactions leave over are the equations of motion: one for each freedom. Where there are more, some
virtual motion is resisted by nothing, and it is none of the coordinates'.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np

from eomgen.errors import DerivationError
from eomgen.mechanics.balance.balance import DIRECTIONS, Balance, balances_of_nodes
from eomgen.mechanics.bodies.inertia import mass_properties
from eomgen.mechanics.constraints.closure import generic_state
from eomgen.mechanics.constraints.freedom import freedoms
from eomgen.mechanics.constraints.ties import holds_identically
from eomgen.mechanics.equations.system import System
from eomgen.mechanics.structures.loose_motion import refuse_loose
from eomgen.mechanics.structures.structure import structure_of
from eomgen.model.driven import driven_coordinates
from eomgen.model.trusses import called, declared_at
from eomgen.symbolic.expression.derivative import depends_on
from eomgen.symbolic.expression.graph import Node, Scalar
from eomgen.symbolic.numeric.evaluation import evaluate, fifty_digits
from eomgen.symbolic.numeric.tolerances import RANK_NEARBY
from eomgen.symbolic.solve.linear import Solution


def refuse_unheld(balance: Balance, solution: Solution, at: Mapping[Node, Scalar]) -> None:
    """Refuse a motion of bodies that no reaction resists and no coordinate describes.

    Args:
        at: the configuration at which the solution was found, {} where it is a function of the coordinates.
    Raises:
        DerivationError: the body that moves most in it, and the direction.
    """
    system, left = balance.system, solution.left
    if at:
        if not system.symbols.u or all(map(holds_identically, left)):  # of rest what is left is looked at elsewhere
            return
    else:
        motions = freedoms(system.ties)
        if len(left) <= motions or sum(not holds_identically(x) for x in left) <= motions:
            return
        if not system.symbols.u:
            return refuse_loose(structure_of(system))
    key = (refuse_unheld, bool(at))
    if key not in system.found:
        system.found[key] = _unheld(balance, touched=bool(at))
    if system.found[key] is not None:
        raise system.found[key]


def _unheld(balance: Balance, *, touched: bool) -> DerivationError | None:
    """The body that moves most in what no reaction resists and no coordinate describes, and the direction.

    Args:
        touched: only of directions along which some reaction acts: no number follows from the others.
    """
    free, allowed = _virtual_motions(balance)
    Q = np.linalg.qr(allowed)[0] if allowed.size else np.zeros((free.shape[0], 0))
    unheld = free - Q @ (Q.T @ free)
    if touched:
        unheld[[not e.coefficients for e in balance.equations]] = 0
    worst = int(np.argmax(np.max(np.abs(unheld), axis=1)))
    if np.max(np.abs(unheld)) < RANK_NEARBY:
        return None
    equation = balance.equations[worst]
    direction = DIRECTIONS[equation.direction]
    turning = direction.startswith("moment")
    what = "kept from turning by nothing" if turning else f"held by nothing along {direction}"
    joined = _joined_by_a_coordinate(balance.system)
    mend = (
        f"{joined}, and nothing named joins them: name the constraint that does"
        if joined
        else "what is placed carries no reaction: name the constraint that holds it, or hang it by joints"
    )
    return DerivationError(f"{called(equation.body)} is {what}", declared_at(equation.body), mend)


def _joined_by_a_coordinate(system: System) -> str:
    """Where one free coordinate moves several joints, or one in two ways, the sentence that says so."""
    given = driven_coordinates(system.scope.model)
    joints = [link for link in system.motion.links if link.joint is not None and link.joint.carries_reaction]
    for q in system.symbols.q:
        moved = [link.name for link in joints for s in link.s if depends_on(s, (q,))]
        if len(moved) > 1 and q.name not in given:
            names = [f"'{name}'" for name in dict.fromkeys(moved)]
            which = "the joints of " if len(names) > 1 else "in two ways the joint of "
            return f"'{q.name}' moves {which}{' and '.join(names)}"
    return ""


def _virtual_motions(balance: Balance) -> tuple[np.ndarray, np.ndarray]:
    """Velocities along the rows: a basis of those that no reaction resists, and those of the coordinates."""
    system = balance.system
    rows, columns = len(balance.equations), len(balance.components)
    state = generic_state(system.ties)

    def numbers(scalars: Sequence[Scalar]) -> list[float]:
        return [float(x) for x in evaluate(tuple(scalars), state, fifty_digits())]

    G = np.zeros((rows, columns))
    for i, e in enumerate(balance.equations):
        if e.coefficients:
            G[i, list(e.coefficients)] = numbers(list(e.coefficients.values()))
    U, sizes, _ = np.linalg.svd(G)
    free = U[:, int(np.sum(sizes > RANK_NEARBY * max(sizes, default=1.0))) :]
    return free, _allowed(balance, numbers)


def _allowed(balance: Balance, numbers: Any) -> np.ndarray:
    """Velocity of mass centre and spin along each row of the balance, per unit of every speed that the ties allow.

    Nodes that follow from their own balance may move: the forces on them are in balance along these motions too.
    """
    free = balance.system.free or balance.system
    nodes = balances_of_nodes(free)
    system = free if nodes else balance.system
    kept = [line for row, line in zip(system.ties.closing, system.ties.J, strict=True) if row.label not in nodes]
    motion = system.motion
    plane = motion.scope.model.space == "plane"
    columns = []
    for e in balance.equations:
        i = motion.index[e.body]
        link, com = motion.links[i], mass_properties(motion.scope, e.body).com
        B = np.array(numbers([x for row in motion.B[i] for x in row])).reshape(6, -1)
        r = np.array(numbers(com))
        R = np.array(numbers([x for row in link.pose.R for x in row])).reshape(3, 3) if plane else np.eye(3)
        v = R @ (B[3:] + np.cross(B[:3].T, r).T)
        columns.append(np.vstack([v, R @ B[:3]])[e.direction])
    moved = np.array(columns)
    if not kept:
        return moved
    J = np.array(numbers([x for row in kept for x in row])).reshape(len(kept), -1)
    _, sizes, V = np.linalg.svd(J)
    return np.asarray(moved @ V[int(np.sum(sizes > RANK_NEARBY * max(sizes, default=1.0))) :].T)
