"""Motion -> Edges: where a tie no longer says at which place it holds its bodies (a wheel that lies flat)."""

from __future__ import annotations

from eomgen.mechanics.kinematics import Motion
from eomgen.mechanics.loads import SystemScene
from eomgen.model.constraints.row import Edge


def edges_of(motion: Motion) -> tuple[Edge, ...]:
    """Of all ties of the model."""
    ties = motion.scope.model.constraints.items()
    return tuple(edge for name, tie in ties for edge in tie.edges(SystemScene(motion, f"{tie.table}.{name}")))
