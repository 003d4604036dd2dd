"""Motion, a state -> the twists of every body for each way in which the joints alone let it move, in numbers.

    xi_i = Ad(parent -> i) xi_parent + S_i w_i,   w_i free;   of a body that is placed, all six of xi_i free

Coordinates that move several joints together, and ties, are left out of it: a row of a tie whose wrenches do no work
on any of these ways is held by joints alone.
"""

from __future__ import annotations

from collections.abc import Container, Sequence

import numpy as np

from eomgen.mechanics.bodies.kinematics import GROUND, BodyLink, Motion
from eomgen.mechanics.constraints.ties import Row
from eomgen.symbolic.expression.derivative import depends_on
from eomgen.symbolic.expression.graph import Scalar
from eomgen.symbolic.expression.node import State
from eomgen.symbolic.numeric.evaluation import evaluate, fifty_digits, floats_of


def powers_of_rows(motion: Motion, rows: Sequence[Row], state: State, loose: Container[str]) -> np.ndarray:
    """The power of a unit of each row on each way, rows x ways.

    Args:
        loose: bodies whose joints are counted with the variables that are constants in them.
    """
    B = _twists(motion, state, loose)
    found = np.zeros((len(rows), B.shape[2]))
    for i, row in enumerate(rows):
        for body, W in row.wrenches:
            found[i] += _numbers((*W.tau, *W.f), state) @ B[motion.index[body]]
    return found


def _twists(motion: Motion, state: State, loose: Container[str]) -> np.ndarray:
    """Bodies x 6 x ways: (w, v) of each body's origin, body axes."""
    own = [_own_ways(motion, link, state, loose) for link in motion.links]
    total, first = sum(columns.shape[1] for columns in own), 0
    B = np.zeros((len(own), 6, total))
    for i, (link, columns) in enumerate(zip(motion.links, own, strict=True)):
        if link.parent != GROUND:
            B[i] = _carried(link, state) @ B[link.parent]
        B[i, :, first : first + columns.shape[1]] += columns
        first += columns.shape[1]
    return B


def _own_ways(motion: Motion, link: BodyLink, state: State, loose: Container[str]) -> np.ndarray:
    if is_placed(link):
        return np.eye(6) if motion.scope.model.space == "space" else np.eye(6)[:, 2:5]
    driven = [q for q in motion.scope.symbols.q if motion.scope.model.coordinates[q.name].driven]
    free = [q for q in motion.scope.symbols.q if q not in driven]
    moving = len(link.S) != len(link.s) or None
    kept = [
        column
        for k, column in enumerate(link.S)
        if moving or depends_on(link.s[k], free) or (link.name in loose and not motion.moves((link.s[k],)))
    ]
    S = _numbers([x for w, v in kept for x in (*w, *v)], state).reshape(-1, 6).T
    return _shifted(-_numbers(link.point, state)) @ S if kept else np.zeros((6, 0))


def is_placed(link: BodyLink) -> bool:
    """Whether it stands where it is said to, and no joint holds it there."""
    return link.joint is None or not link.joint.carries_reaction


def _carried(link: BodyLink, state: State) -> np.ndarray:
    """From the parent's twist to the child's that moves with it, at the child's origin."""
    R = _numbers([x for row in link.local.R for x in row], state).reshape(3, 3).T
    turned = np.block([[R, np.zeros((3, 3))], [np.zeros((3, 3)), R]])
    found: np.ndarray = _shifted(-_numbers(link.point, state)) @ turned @ _shifted(_numbers(link.local.p, state))
    return found


def _shifted(r: np.ndarray) -> np.ndarray:
    """(w, v) -> (w, v + w x r)"""
    x, y, z = r
    return np.block([[np.eye(3), np.zeros((3, 3))], [np.array([[0, z, -y], [-z, 0, x], [y, -x, 0]]), np.eye(3)]])


def _numbers(scalars: Sequence[Scalar], state: State) -> np.ndarray:
    return np.array(floats_of(evaluate(tuple(scalars), state, fifty_digits())))
