"""Motion -> Edges: where a tie no longer says at which place it holds its bodies (a wheel that lies flat).

Beyond its limits a tie goes on as it was, though what it stands for does not: a run that passes them is told of it.
"""

from __future__ import annotations

from collections.abc import Container

import numpy as np

from eomgen.errors import Problem
from eomgen.mechanics.bodies.kinematics import Motion, motion_of
from eomgen.mechanics.bodies.scope import scope_of
from eomgen.mechanics.bodies.system_scene import SystemScene
from eomgen.model.constraints.row import Edge
from eomgen.model.parts import Model
from eomgen.model.values import exact_parameters
from eomgen.symbolic.expression.graph import Scalar
from eomgen.symbolic.expression.rational import Fraction
from eomgen.symbolic.numeric.evaluation import FLOAT, evaluate
from eomgen.symbolic.numeric.tolerances import AT_AN_EDGE

LOOKED = 200  # rows of a run at which limits are looked at


def edges_of(motion: Motion, open: Container[str] = ()) -> tuple[Edge, ...]:
    """Of all ties of the model but those that are open."""
    ties = [(name, tie) for name, tie in motion.scope.model.constraints.items() if name not in open]
    return tuple(edge for name, tie in ties for edge in tie.edges(SystemScene(motion, f"{tie.table}.{name}")))


def left_of(edges: tuple[Edge, ...]) -> tuple[Scalar, ...]:
    """What is left until a motion ends at each of them."""
    return tuple(edge.vanishes - Fraction(AT_AN_EDGE) for edge in edges)


def limits_passed(model: Model, t: np.ndarray, q: np.ndarray) -> tuple[Problem, ...]:
    """The limits of ties beyond which a run goes, with the first instant that is seen, of LOOKED rows.

    Args:
        t, q: instants, n; coordinates in the model's order, n x nq.
    """
    if not len(t) or not any(tie.thread() for tie in model.constraints.values()):
        return ()
    motion, found = motion_of(scope_of(model)), []
    symbols, known = motion.scope.symbols, exact_parameters(model)
    p = {node: float(known[name]) for name, node in symbols.parameters.items() if name in known}
    looked = np.unique(np.linspace(0, len(t) - 1, LOOKED).round().astype(int))
    for name, tie in model.constraints.items():
        for limit in tie.limits(SystemScene(motion, f"{tie.table}.{name}")):
            for k in looked:
                state = p | {symbols.t: float(t[k])} | dict(zip(symbols.q, map(float, q[k]), strict=True))
                if evaluate((limit.vanishes,), state, FLOAT)[0] < 0:
                    what = (
                        f"{limit.words} at t = {t[k]:.4g} s: from there on it is led straight on, which it would not be"
                    )
                    found.append(Problem(f"{tie.table}.{name}", what, mend="end the run before"))
                    break
    return tuple(found)


def stopped_at(edge: Edge, t: float) -> str:
    """Why a motion ends there."""
    return f"Stopped at t = {t:.6g} s: {edge.words}, and how it goes on is not determined."
