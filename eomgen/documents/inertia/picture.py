"""System, principal axes -> a picture: bodies, mass centres, principal axes, in space the ellipsoid of inertia."""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import replace
from typing import Any

import numpy as np

from eomgen.documents.drawing import Sketch, draw_model, name_beside
from eomgen.documents.figures import Picture
from eomgen.documents.rest_picture import picture_of_scene
from eomgen.mechanics.bodies.inertia import mass_properties
from eomgen.mechanics.equations.system import System
from eomgen.mechanics.initial_state.initial_state import start_state
from eomgen.mechanics.masses.inertia_about import in_ground
from eomgen.mechanics.masses.principal import numbers_in
from eomgen.model.shapes.forms import EllipsoidForm, LineForm
from eomgen.model.values import numeric_parameters
from eomgen.scene.connections import ordered
from eomgen.scene.forms import LabelForm, PointForm
from eomgen.scene.making import scene_of_system
from eomgen.scene.scene import ROLES, Mark, Scene, SceneFrame
from eomgen.symbolic.expression.graph import Node
from eomgen.symbolic.expression.rational import Fraction
from eomgen.symbolic.expression.spatial import ZERO, Pose, Vector, matrix_of, minus, vector_of

CENTER, AXIS = "#b03a2e", "#2e7d4f"
LONGEST = 4.0  # half-axis of an ellipsoid of inertia, of its shortest: that of a rod has no end
BEYOND = 1.25  # times its half-axis a principal axis goes


def inertia_picture(
    system: System, axes: Mapping[str, Sequence[Sequence[float]]], moments: Mapping[str, Sequence[float]]
) -> Picture:
    """The bodies where they start, each with its mass centre and its principal axes.

    Args:
        axes: the principal axes in numbers, the rows of R, by the body's name.
        moments: the principal moments in their order [kg m^2], by the body's name.
    Raises:
        MissingValues: a parameter has none.
    """
    model = system.scope.model
    if model.space == "space":
        return picture_of_scene(inertia_scene(system, axes, moments))
    sketch = Sketch(system, values_at_start(system))

    def fill(figure: Any) -> None:
        panel = figure.subplots()
        draw_model(panel, sketch)
        for body, rows in axes.items():
            if body in system.motion.index:
                _body(panel, sketch, body, np.array(rows))

    return Picture((8, 6), fill, model.name)


def inertia_scene(
    system: System, axes: Mapping[str, Sequence[Sequence[float]]], moments: Mapping[str, Sequence[float]]
) -> Scene:
    """Bodies in space and about their mass centres x I x = c, of half-axes sqrt(c/I_k): of a ball the ball."""
    scene, known = scene_of_system(system), values_at_start(system)
    frames, marks = list(scene.frames), [mark for mark in scene.marks if mark.role != "inertia"]
    for body, rows in axes.items():
        if body not in system.motion.index or body not in moments or min(moments[body]) < 0 or not any(moments[body]):
            continue
        mass = mass_properties(system.scope, body)
        m, *com = numbers_in((mass.m, *mass.com), system.scope, known) or (0.0, 0.0, 0.0, 0.0)
        if m <= 0:
            continue
        marks += _ellipsoid(moments[body], m, len(frames), body)
        pose = Pose(matrix_of(map(_vector, zip(*rows, strict=True))), _vector(com))
        frames.append(SceneFrame(f"{body}, principal", system.motion.index[body] + 1, pose))
    return replace(scene, frames=tuple(frames), marks=ordered(marks, ROLES))


def _ellipsoid(moments: Sequence[float], m: float, frame: int, body: str) -> Iterator[Mark]:
    """The ellipsoid, its centre, and its axes with their numbers."""
    largest = max(moments)
    size = math.sqrt(5 * sum(moments) / (6 * m))  # of the shortest half-axis: of a ball its radius
    half = [size * min(math.sqrt(largest / I) if I > 0 else LONGEST, LONGEST) for I in moments]
    yield Mark(EllipsoidForm(ZERO, _vector(half)), frame, "inertia", body)
    yield Mark(PointForm(ZERO), frame, "center", body)
    for k, length in enumerate(half):
        end = _vector(BEYOND * length * (i == k) for i in range(3))
        yield Mark(LineForm((minus(ZERO, end), end), fine=True), frame, "reaction", body)
        yield Mark(LabelForm(str(k + 1), end), frame, "axes", body)


def _vector(v: Iterable[float]) -> Vector:
    return vector_of(map(Fraction, v))


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
