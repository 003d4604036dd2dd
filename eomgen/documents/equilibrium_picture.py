"""Model -> a picture of it where it starts, with its coordinates and lengths."""

from __future__ import annotations

from typing import Any

from eomgen.documents.document import notation_of
from eomgen.documents.drawing import draw, limits
from eomgen.documents.figures import Picture
from eomgen.documents.space_drawing import draw_space, page_limits
from eomgen.model import Model
from eomgen.scene import Drawing, Scene, SceneNumbers, drawn_start, frame_at, plane_drawing, scene_of, space_drawing

WIDTHS, HEIGHT, TITLE = (3.4, 8.0), 4.2, 0.4  # [inches]


def rest_picture(model: Model) -> Picture:
    """The scene of a model at its start; a parameter without a value is drawn as 1.

    Raises:
        DerivationError, NotYet: what cannot be derived is not drawn either.
    """
    return picture_of_scene(scene_of(model))


def drawing_at_rest(scene: Scene) -> Drawing:
    """A scene at the start of its model, with its dimensions."""
    numbers = SceneNumbers(scene, frame_at(scene, drawn_start(scene.system))[None, :])
    return (plane_drawing if scene.plane else space_drawing)(numbers, dimensions=True)


def picture_of_scene(scene: Scene) -> Picture:
    """A scene at the start of its model."""
    drawing = drawing_at_rest(scene)
    low, high = limits(drawing) if scene.plane else page_limits(drawing)
    ratio = float(high[0] - low[0]) / float(high[1] - low[1])
    width = min(max(HEIGHT * ratio, WIDTHS[0]), WIDTHS[1])
    height = min(HEIGHT, width / ratio + TITLE)

    def fill(figure: Any) -> None:
        (draw if scene.plane else draw_space)(figure.subplots(), drawing, notation_of(scene.system.scope.model))

    return Picture((width, height), fill, scene.name)
