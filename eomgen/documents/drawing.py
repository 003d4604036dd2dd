"""System, values -> a drawing of a plane model in one configuration, from its scene; arrows stand beside it."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import replace
from functools import cached_property
from typing import Any

import numpy as np

from eomgen.documents.latex_names import notation_of
from eomgen.documents.letters import PlacedName
from eomgen.documents.scene_drawing import LOAD, REACTION, draw, limits
from eomgen.mechanics.bodies.kinematics import BodyLink
from eomgen.mechanics.equations.system import System
from eomgen.records import dataclass
from eomgen.scene.making import scene_of_system
from eomgen.scene.plane_strokes import plane_drawing
from eomgen.scene.strokes import Drawing, SceneNumbers
from eomgen.symbolic.expression.graph import Node, Scalar
from eomgen.symbolic.expression.spatial import Vector
from eomgen.symbolic.numeric.sure_numbers import numbers_of

__all__ = ["ARROW", "LOAD", "REACTION", "PagePoint", "Sketch", "draw_model", "name_along", "name_beside"]

PagePoint = tuple[float, float]
ARROW = 0.13  # length of the longest arrow, of the extent
LOADS = ("force", "axes", "dimension")  # roles that a picture with arrows of its own leaves out


@dataclass(frozen=True)
class Sketch:
    """A plane system in one configuration, in numbers.

    Args:
        system: the system.
        values: of t, the coordinates and the parameters.
    """

    system: System
    values: Mapping[Node, float]

    def numbers(self, scalars: Iterable[Scalar]) -> list[float]:
        """What scalars are worth there."""
        return numbers_of(scalars, self.values)

    def place(self, point: Vector) -> PagePoint:
        """A place of the ground's axes."""
        x, y = self.numbers(point[:2])
        return x, y

    def position(self, place: tuple[str | None, Vector]) -> PagePoint:
        """Where a place of a body is."""
        return self.place(self.system.motion.position(place))

    @cached_property
    def drawing(self) -> Drawing:
        """Its scene there, loads and sizes left out."""
        scene = scene_of_system(self.system)
        scene = replace(scene, marks=tuple(mark for mark in scene.marks if mark.role not in LOADS))
        return plane_drawing(SceneNumbers(scene, np.array([self.numbers(scene.values)], dtype=float)))

    def lines(self, link: BodyLink) -> list[np.ndarray]:
        """What is drawn of a body."""
        return [s.path[0] for s in self.drawing.strokes if s.of == link.name and s.role in ("body", "hole")]

    @property
    def extent(self) -> float:
        """The larger side of the box around all bodies [m]."""
        return self.drawing.sizes.extent

    @cached_property
    def points(self) -> dict[str, PagePoint]:
        """Every named point of the bodies and of the ground by its whole name."""
        points = scene_of_system(self.system).points
        return {name: self.place(at) for name, at in points}

    @property
    def symbol(self) -> float:
        """The size of hinges and supports [m]."""
        return self.drawing.sizes.unit


def draw_model(panel: Any, sketch: Sketch, *, names: bool = True, colors: Mapping[str, str] | None = None) -> None:
    """Bodies, wires, hinges and supports on matplotlib axes; the axes have equal scales and no frame.

    Args:
        names: bodies and points are named.
        colors: of bodies, where they have one of their own.
    """
    before = panel.dataLim.get_points() if panel.has_data() else None
    draw(panel, sketch.drawing, notation_of(sketch.system.scope.model), names=names, colors=colors)
    corners = np.array(limits(sketch.drawing))
    panel.dataLim.set_points(corners)
    if before is not None:
        panel.dataLim.update_from_data_xy(before, ignore=False)
    panel.autoscale(True)  # what is drawn beside it is held, too
    panel.margins(0.0)


def name_beside(panel: Any, text: str, at: PagePoint, color: str) -> None:
    """One more name of a model that is drawn: it is placed where it covers no other one."""
    panel.plot(*at, alpha=0)  # so that the axes hold it
    _named(panel, PlacedName(text, at, color))


def name_along(panel: Any, text: str, ends: Sequence[Any], color: str) -> None:
    """A name written along a line; the others keep off it."""
    (x, y), (u, v) = ends
    if text:
        _named(panel, PlacedName(text, (float(x), float(y)), color, 8.0, -1, (float(u), float(v))))


def _named(panel: Any, name: PlacedName) -> None:
    from eomgen.documents.letters_artist import NamesArtist

    shown = [artist for artist in panel.artists if isinstance(artist, NamesArtist)]
    if shown:
        shown[0].add(name)
    else:
        panel.add_artist(NamesArtist([name], []))
