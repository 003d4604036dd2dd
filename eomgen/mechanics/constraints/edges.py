"""Motion -> Edges: where a tie no longer says at which place it holds its bodies (a wheel that lies flat)."""

from __future__ import annotations

from collections.abc import Container

from eomgen.mechanics.bodies.kinematics import Motion
from eomgen.mechanics.bodies.system_scene import SystemScene
from eomgen.model.constraints.row import Edge
from eomgen.symbolic.expression.graph import Scalar
from eomgen.symbolic.expression.rational import Fraction
from eomgen.symbolic.numeric.tolerances import AT_AN_EDGE


def edges_of(motion: Motion, open: Container[str] = ()) -> tuple[Edge, ...]:
    """Of all ties of the model but those that are open."""
    ties = [(name, tie) for name, tie in motion.scope.model.constraints.items() if name not in open]
    return tuple(edge for name, tie in ties for edge in tie.edges(SystemScene(motion, f"{tie.table}.{name}")))


def left_of(edges: tuple[Edge, ...]) -> tuple[Scalar, ...]:
    """What is left until a motion ends at each of them."""
    return tuple(edge.vanishes - Fraction(AT_AN_EDGE) for edge in edges)


def stopped_at(edge: Edge, t: float) -> str:
    """Why a motion ends there."""
    return f"Stopped at t = {t:.6g} s: {edge.words}, and how it goes on is not determined."
