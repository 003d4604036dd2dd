"""System, values -> a drawing of it in one configuration, in the plane or in space, with the arrows of a result."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import field, replace
from functools import cached_property
from typing import Any

import numpy as np

from eomgen.documents.document import notation_of
from eomgen.documents.drawing import draw, limits
from eomgen.documents.letters import NamesArtist, PlacedName
from eomgen.documents.space_drawing import SpaceView, draw_space, page_shape
from eomgen.frozen import dataclass
from eomgen.mechanics.dynamics import System
from eomgen.scene import (
    ARROW,
    Drawing,
    Mark,
    Scene,
    SceneNumbers,
    plane_drawing,
    scene_of_system,
    scene_with,
    space_drawing,
)
from eomgen.symbolic.expression import Node, Scalar, Vector
from eomgen.symbolic.numeric import numbers_of
from eomgen.symbolic.print import Notation, Symbol

PagePoint = tuple[float, float]
LOADS = ("force", "axes", "dimension")  # roles that a picture with arrows of its own leaves out


@dataclass(frozen=True)
class Sketch:
    """A system in one configuration, in numbers.

    Args:
        system: the system.
        values: of t, the coordinates and the parameters.
        dimensions: lengths are drawn, of a system in the plane.
        more: what is drawn besides it: the arrows of a result.
        letters: typesetting of the texts of those.
        colors: of bodies and members, where they have one of their own.
        longest: the longest arrow, of the extent.
    """

    system: System
    values: Mapping[Node, float]
    dimensions: bool = False
    more: tuple[Mark, ...] = ()
    letters: Mapping[str, Symbol] = field(default_factory=dict)
    colors: Mapping[str, str] = field(default_factory=dict)
    longest: float = ARROW

    @property
    def plane(self) -> bool:
        return self.system.scope.model.space == "plane"

    def numbers(self, scalars: Iterable[Scalar]) -> list[float]:
        """Values of scalars in this configuration."""
        return numbers_of(scalars, self.values)

    def spot(self, point: Vector) -> np.ndarray:
        """A place or direction of the ground's axes, 2 or 3 numbers."""
        return np.array(self.numbers(point[: 2 if self.plane else 3]))

    def page(self, at: Sequence[float] | np.ndarray) -> np.ndarray:
        """A place or direction of the ground's axes as it is on the page, 2; also of many at once, ... x 2."""
        if self.plane:
            return np.asarray(at, dtype=float)
        found: np.ndarray = np.asarray(at, dtype=float) @ self._view.view.T[:, :2]
        return found

    @cached_property
    def _view(self) -> SpaceView:
        return SpaceView(self.drawing)

    def place(self, point: Vector) -> PagePoint:
        """A place of the ground's axes on the page."""
        x, y = self.page(self.spot(point))
        return float(x), float(y)

    def position(self, place: tuple[str | None, Vector]) -> PagePoint:
        """Position on the page of a place of a body."""
        return self.place(self.system.motion.position(place))

    @cached_property
    def scene(self) -> Scene:
        """Its scene, with what is drawn besides it; loads and sizes left out."""
        scene = scene_of_system(self.system)
        left = LOADS[:-1] if self.dimensions else LOADS
        own = replace(scene, marks=tuple(mark for mark in scene.marks if mark.role not in left))
        return scene_with(own, self.more)

    @cached_property
    def frame(self) -> SceneNumbers:
        """The numbers of its scene there."""
        return SceneNumbers(self.scene, np.array([self.numbers(self.scene.values)], dtype=float))

    @cached_property
    def drawing(self) -> Drawing:
        """The strokes of its scene there."""
        drawer = plane_drawing if self.plane else space_drawing
        return drawer(self.frame, dimensions=self.dimensions, arrow=self.longest)

    def lines(self, roles: Iterable[str]) -> list[np.ndarray]:
        """Lines of the page that its strokes of some roles are."""
        strokes = [s.path[0] for s in self.drawing.strokes if s.role in roles and not s.faces]
        return [self.page(path) for path in strokes]

    @property
    def extent(self) -> float:
        """The larger side of the box around all bodies [m]."""
        return self.drawing.sizes.extent

    @property
    def shape(self) -> float:
        """Height over width of its page."""
        return page_shape(self.drawing)

    @cached_property
    def points(self) -> dict[str, np.ndarray]:
        """Every named point of the bodies and of the ground by its whole name, 2 or 3 numbers."""
        return {name: self.spot(at) for name, at in scene_of_system(self.system).points}

    @property
    def notation(self) -> Notation:
        return notation_of(self.system.scope.model).with_symbols(self.letters)


def draw_model(panel: Any, sketch: Sketch, *, names: bool = True) -> None:
    """A sketch on matplotlib axes, which have equal scales and no frame.

    Args:
        names: bodies, points and arrows are named.
    """
    if not sketch.plane:
        draw_space(panel, sketch.drawing, sketch.notation, sketch.colors)
        return
    before = panel.dataLim.get_points() if panel.has_data() else None
    draw(panel, sketch.drawing, sketch.notation, names=names, colors=sketch.colors)
    corners = np.array(limits(sketch.drawing))
    panel.dataLim.set_points(corners)
    if before is not None:
        panel.dataLim.update_from_data_xy(before, ignore=False)
    panel.autoscale(True)  # what is drawn outside of it is included
    panel.margins(0.0)


def name_along(panel: Any, text: str, ends: Sequence[Any], color: str) -> None:
    """A name written along a line of the page; the others keep off it."""
    (x, y), (u, v) = ends
    if text:
        shown = [artist for artist in panel.artists if isinstance(artist, NamesArtist)]
        names = shown[0] if shown else panel.add_artist(NamesArtist([], []))
        names.add(PlacedName(text, (float(x), float(y)), color, 8.0, -1, (float(u), float(v))))
