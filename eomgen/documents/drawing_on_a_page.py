"""Scene -> FlatDrawing: shapes and names of a picture on its page, for whoever draws them; in hundredths of a second.

The look of a stroke and the place of a name are those of the pictures by matplotlib.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from itertools import groupby

import numpy as np

from eomgen.documents.document import notation_of
from eomgen.documents.drawing import (
    PageBox,
    PlacedName,
    StrokeLook,
    dots_along,
    letter_names,
    limits,
    look_of,
    room_for,
)
from eomgen.documents.space_drawing import SpaceView, page_limits
from eomgen.frozen import dataclass
from eomgen.scene import Drawing, Scene, Stroke

WIDEST, TALLEST = 560.0, 320.0  # of a picture [points]
STEP = 4.0  # of the dots that stand for a line that no name should cover [points]
LARGER, HIGH = 1.25, 1.15  # size of a name, of that in a picture on paper; height of a letter, of its size


@dataclass(frozen=True)
class FlatShape:
    """A line, a face or a dot on the page.

    Args:
        pieces: its points, n x 2 each [points]; y down.
        opaque: how much its inside and its edge hide.
        role, of: of its stroke; "" of a facet in space.
    """

    pieces: tuple[np.ndarray, ...]
    look: StrokeLook
    opaque: tuple[float, float] = (1.0, 1.0)
    role: str = ""
    of: str = ""
    dot: bool = False


@dataclass(frozen=True)
class FlatName:
    """A name in its box.

    Args:
        text: as matplotlib sets it.
        size: of a letter [points].
    """

    text: str
    box: PageBox
    size: float
    color: str


@dataclass(frozen=True)
class FlatDrawing:
    """A picture on its page: what lies further back is drawn first.

    Args:
        size: width and height [points].
    """

    size: tuple[float, float]
    shapes: tuple[FlatShape, ...]
    names: tuple[FlatName, ...]


def flat_drawing(scene: Scene, drawing: Drawing, width: Callable[[str], float]) -> FlatDrawing:
    """A scene at the first frame of its drawing.

    Args:
        width: of a name, of the size of its letters.
    """
    notation = notation_of(scene.system.scope.model)
    if scene.plane:
        paper = _Paper(*limits(drawing))
        shapes = tuple(_flat(stroke, paper) for stroke in drawing.strokes if stroke.path.size)
        names = tuple(letter_names(drawing.letters, {}, notation))
        lines = [stroke.path[0] for stroke in drawing.strokes if stroke.role != "label"]
    else:
        paper, view = _Paper(*page_limits(drawing)), SpaceView(drawing)
        shapes = tuple(_facets(view, paper))
        names, lines = tuple(view.names(0, notation)), view.lines(0)
    return FlatDrawing(paper.size, shapes, tuple(_boxed(names, lines, paper, width)))


@dataclass(frozen=True)
class _Paper:
    """The page of a picture.

    Args:
        low, high: corners of what is shown [m].
    """

    low: np.ndarray
    high: np.ndarray

    @property
    def scale(self) -> float:
        """Points of a metre."""
        width, height = self.high - self.low
        return min(WIDEST / float(width), TALLEST / float(height))

    @property
    def size(self) -> tuple[float, float]:
        width, height = self.scale * (self.high - self.low)
        return float(width), float(height)

    def placed(self, path: np.ndarray) -> np.ndarray:
        """Points n x 2 [m] on the page."""
        x, y = path.T
        found: np.ndarray = self.scale * np.column_stack([x - self.low[0], self.high[1] - y])
        return found


def _pieces(points: np.ndarray) -> tuple[np.ndarray, ...]:
    """Points in a row; nan breaks it."""
    known = np.isfinite(points).all(axis=1)
    runs = groupby(range(len(points)), key=lambda k: bool(known[k]))
    return tuple(points[list(run)] for there, run in runs if there)


def _flat(stroke: Stroke, paper: _Paper) -> FlatShape:
    """A stroke of the plane."""
    pieces = _pieces(paper.placed(stroke.path[0]))
    return FlatShape(pieces, look_of(stroke, {}), role=stroke.role, of=stroke.of, dot=stroke.dot)


def _facets(view: SpaceView, paper: _Paper) -> Iterator[FlatShape]:
    """Faces and lines of a scene in space, the farthest first."""
    for corners, ink in zip(*view.seen(0), strict=True):
        fill = _hex(ink[:3]) if ink[3] else None
        look = StrokeLook(fill, _hex(ink[4:7]), float(ink[8]))
        yield FlatShape((paper.placed(np.asarray(corners)),), look, (float(ink[3]), float(ink[7])))


def _hex(ink: np.ndarray) -> str:
    return "#" + "".join(f"{round(255 * float(x)):02x}" for x in ink)


def _boxed(
    names: Sequence[PlacedName], lines: Sequence[np.ndarray], paper: _Paper, width: Callable[[str], float]
) -> Iterator[FlatName]:
    """The names where they cover no other, those of smaller rank first; one without room is left out."""
    inside = PageBox(0, 0, *paper.size)
    dots = dots_along([paper.placed(line) for line in lines], STEP)
    taken: list[PageBox] = []
    for name in sorted(dict.fromkeys(names), key=lambda each: each.rank):
        size = LARGER * name.size
        x, y = map(float, paper.placed(np.array([name.at]))[0])
        box = room_for((x, y), (size * width(name.text), size * HIGH), taken, dots, (inside, inside), 1.0)
        if box is not None:
            taken.append(box)
            yield FlatName(name.text, box, size, name.color)
