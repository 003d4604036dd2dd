"""System, principal axes -> a picture: plane bodies with their holes, mass centres and principal axes."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np

from eomgen.documents.drawing import Sketch, draw_model, name_beside
from eomgen.documents.figures import Picture
from eomgen.errors import RunFailed
from eomgen.mechanics.equations.system import System
from eomgen.mechanics.initial_state.initial_state import start_state
from eomgen.mechanics.masses.inertia_about import in_ground
from eomgen.model.values import numeric_parameters
from eomgen.symbolic.expression.graph import Node

CENTER, AXIS = "#b03a2e", "#2e7d4f"


def inertia_picture(system: System, axes: Mapping[str, Sequence[Sequence[float]]]) -> Picture:
    """The bodies where they start, each with its mass centre and its principal axes.

    Args:
        axes: the principal axes in numbers, the rows of R, by the body's name.
    Raises:
        RunFailed: the model is in space.
        MissingValues: a parameter has none.
    """
    model = system.scope.model
    if model.space != "plane":
        raise RunFailed("bodies in space are not drawn", mend="leave out --plot")
    sketch = Sketch(system, values_at_start(system))

    def fill(figure: Any) -> None:
        panel = figure.subplots()
        draw_model(panel, sketch)
        for body, rows in axes.items():
            if body in system.motion.index:
                _body(panel, sketch, body, np.array(rows))

    return Picture((8, 6), fill, model.name)


def values_at_start(system: System) -> dict[Node, float]:
    """Parameters, coordinates and time at the start."""
    symbols, numbers = system.scope.symbols, numeric_parameters(system.scope.model)
    state = start_state(system) if symbols.q else {}
    moving = {q: state[q.name] for q in symbols.q}
    return {symbols.t: 0.0} | moving | {node: numbers[name] for name, node in symbols.parameters.items()}


def _body(panel: Any, sketch: Sketch, body: str, rows: np.ndarray) -> None:
    """The mass centre as a cross, the principal axes in the plane as dashed lines."""
    center = sketch.place(in_ground(sketch.system.motion, body).com)
    pose = sketch.system.motion.link(body).pose
    turn = np.array([sketch.numbers(row[:2]) for row in pose.R[:2]])
    for number, row in enumerate(rows, start=1):
        along = turn @ row[:2]
        if np.linalg.norm(along) > 0.5:
            ends = np.array([center - 0.45 * sketch.extent * along, center + 0.45 * sketch.extent * along])
            panel.plot(*ends.T, color=AXIS, linewidth=1.0, linestyle=(0, (6, 3)), zorder=4)
            name_beside(panel, str(number), (float(ends[1, 0]), float(ends[1, 1])), AXIS)
    panel.plot(*center, marker="x", markersize=7, markeredgewidth=2, color=CENTER, zorder=7)
    name_beside(panel, "C", center, CENTER)
