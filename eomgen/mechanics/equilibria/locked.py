"""A place where three angles lock -> whether the body is in balance there, about the axis that they have lost too.

Where two of the axes are one, the forces along the three angles vanish although a moment about a third direction may be
left: their balance says nothing of it. Beside that place the angles turn the body about that direction n as well,

    tau . n = f . dq,   dq = D^-1 W^-1 n     at q + d,   d -> 0

W: the axes of the angles, D: the angles' derivatives by the coordinates, f: what is to vanish along these.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from eomgen.mechanics.bodies.gimbal import Lock, locks_of
from eomgen.mechanics.bodies.kinematics import Motion
from eomgen.mechanics.equilibria.static_equations import StaticEquations
from eomgen.symbolic.expression.derivative import jacobian
from eomgen.symbolic.expression.graph import Node
from eomgen.symbolic.expression.node import State
from eomgen.symbolic.numeric.evaluation import FLOAT, evaluate
from eomgen.symbolic.numeric.tolerances import ASIDE_STEP, DEGENERATE

LEFT = 1e-3  # of the largest force nearby: a moment that is left


def is_balanced_in_locked(statics: StaticEquations, place: State) -> bool:
    """Whether no moment is left where angles lock; True where none do.

    Args:
        statics: of all coordinates.
        place: of these, of the multipliers and the parameters.
    """
    motion = (statics.system.free or statics.system).motion
    given = [(node, x) for node, x in statics.given.items() if node not in place]
    state = dict(place) | dict(zip((node for node, _ in given), _numbers([x for _, x in given], place), strict=True))
    return all(
        _is_free(statics, motion, lock, state)
        for lock in locks_of(motion)
        if abs(_numbers([lock.determinant], state)[0]) < DEGENERATE
    )


def _is_free(statics: StaticEquations, motion: Motion, lock: Lock, state: dict[Node, float]) -> bool:
    """Whether no moment is left about the axis that a body's angles have lost."""
    link = motion.link(lock.body)
    axes = [x for w, _ in link.S[-3:] for x in w]
    slopes = [x for row in jacobian(link.s[-3:], statics.q) for x in row]
    lost = np.linalg.svd(_numbers(axes, state).reshape(3, 3).T)[0][:, 2]
    rng = np.random.default_rng(1)
    left, largest = np.inf, 0.0
    for _ in range(3):
        aside = rng.uniform(0.5, 1, len(statics.q))
        beside = _shifted(statics, state, ASIDE_STEP * aside)
        W, D = _numbers(axes, beside).reshape(3, 3).T, _numbers(slopes, beside).reshape(3, -1)
        if np.linalg.matrix_rank(D) < 3:  # the angles are not free each: it cannot turn about n
            return True
        dq = np.linalg.pinv(D) @ np.linalg.solve(W, lost)
        left = min(left, abs(_numbers(statics.forces, beside) @ dq))
        largest = max(largest, np.max(np.abs(_numbers(statics.forces, _shifted(statics, state, aside)))))
    return bool(left <= LEFT * largest)


def _shifted(statics: StaticEquations, state: dict[Node, float], by: np.ndarray) -> dict[Node, float]:
    return state | {q: state[q] + d for q, d in zip(statics.q, by.tolist(), strict=True)}


def _numbers(scalars: Any, state: State) -> np.ndarray:
    return np.array([float(x) for x in evaluate(tuple(scalars), state, FLOAT)])
