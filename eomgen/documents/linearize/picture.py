"""Modes -> a picture: the system swung out in each mode over its reference, or the shapes as bars."""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import Any

from eomgen.documents.drawing import Sketch, draw_model
from eomgen.documents.figures import Picture, mathtext
from eomgen.documents.latex_names import notation_of
from eomgen.documents.scene_drawing import artist_of, limits
from eomgen.errors import RunFailed
from eomgen.mechanics.equations.system import System
from eomgen.mechanics.small_motions.modes import Modes
from eomgen.mechanics.small_motions.spectrum import Mode
from eomgen.symbolic.expression.graph import Node
from eomgen.symbolic.numeric.tolerances import WIDE_STEP

MOST = 9  # modes that are drawn
SIDE, TITLE = 3.4, 0.4  # of one panel, of what is written over it [inches]
BODIES = ("body", "inertia", "hole")  # roles that are drawn of the reference
PART = 0.12  # of the drawing's extent, by which the point that moves most is swung out
AT_REST, BAR = "#c4c4c4", "#336699"


def modes_picture(modes: Modes) -> Picture:
    """The modes, the slowest first: plane systems swung out, others as bars.

    Raises:
        RunFailed: parameters have no values.
    """
    reference = modes.small.reference
    if not reference.valued:
        raise RunFailed("a picture needs values of all parameters", mend="give them values in [parameters]")
    drawn = modes.spectrum.modes[:MOST]
    columns = math.ceil(math.sqrt(len(drawn)))
    rows = math.ceil(len(drawn) / columns)
    plane = reference.system.scope.model.space == "plane"
    height = SIDE
    if plane:
        low, high = limits(_at_rest(modes).drawing)
        height = min(SIDE, TITLE + SIDE * float(high[1] - low[1]) / float(high[0] - low[0]))

    def fill(figure: Any) -> None:
        for k, mode in enumerate(drawn, start=1):
            panel = figure.add_subplot(rows, columns, k)
            (_swung if plane else _bars)(panel, modes, mode)
            panel.set_title(_title(k, mode), fontsize=10)

    return Picture((SIDE * columns, height * rows + TITLE), fill, reference.system.scope.model.name)


def _title(k: int, mode: Mode) -> str:
    if mode.frequency is None:
        return f"{k}: {mode.kind}, {mode.eigenvalue.real:.4g} 1/s"
    return f"{k}: {mode.frequency:.4g} rad/s"


def _swung(panel: Any, modes: Modes, mode: Mode) -> None:
    """The bodies of the reference in grey, the system swung out over them."""
    system = modes.small.reference.system
    here = _at_rest(modes)
    values = here.values
    grey = dict.fromkeys(system.motion.index, AT_REST)
    for stroke in here.drawing.strokes:
        if stroke.role in BODIES:
            artist_of(panel, stroke, 0, grey, 0.5)
    size = _size(system, values, mode, here)
    moved = {q: values[q] + size * mode.shape[q].real for q in mode.shape}
    draw_model(panel, Sketch(system, {**values, **moved}), names=False)


def _at_rest(modes: Modes) -> Sketch:
    """The reference in numbers."""
    reference = modes.small.reference
    return Sketch(reference.system, {x: float(v) for x, v in reference.numbers.items()})


def _size(system: System, values: Mapping[Node, float], mode: Mode, here: Sketch) -> float:
    """How far it is swung out: so that no point of the drawing moves by more than a part of the drawing."""
    aside = {**values, **{q: values[q] + WIDE_STEP * x.real for q, x in mode.shape.items()}}
    there = Sketch(system, aside)
    moved = [
        abs(b - a).max()
        for link in system.motion.links
        for a, b in zip(here.lines(link), there.lines(link), strict=True)
    ]
    largest = max(moved, default=0.0)
    return PART * here.extent * WIDE_STEP / largest if largest > 0 else 0.0


def _bars(panel: Any, modes: Modes, mode: Mode) -> None:
    """The shape, a bar for each coordinate."""
    notation = notation_of(modes.small.reference.system.scope.model)
    names = [f"${mathtext(q.name, notation)}$" for q in mode.shape]
    panel.bar(names, [x.real for x in mode.shape.values()], color=BAR)
    panel.axhline(0, color="#808080", linewidth=0.8)
    panel.set_ylim(-1.1, 1.1)
