"""Scene -> its picture: in space by matplotlib, faces and lines seen from far away; on a page for whoever draws it."""

from __future__ import annotations

import math
from abc import ABC, abstractmethod
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import field, replace
from functools import cache, cached_property
from itertools import groupby, product
from typing import Any

import numpy as np

from eomgen.documents.document import notation_of
from eomgen.documents.drawing import (
    BODY,
    FILLS,
    FINE,
    INK,
    LINES,
    MARGIN,
    NARROWEST,
    OWN_COLORS,
    RANKS,
    SMALLEST,
    NamesArtist,
    PageBox,
    PlacedName,
    StrokeLook,
    dots_along,
    draw,
    letter_names,
    limits,
    look_of,
    room_for,
    written,
)
from eomgen.documents.figures import Picture
from eomgen.frozen import dataclass
from eomgen.mechanics.dynamics import System
from eomgen.model import Model
from eomgen.scene import (
    ARROW,
    Drawing,
    Mark,
    Scene,
    SceneNumbers,
    Stroke,
    corners_of,
    drawing_of,
    scene_of,
    scene_of_system,
    scene_with,
)
from eomgen.study import StateInNumbers
from eomgen.symbolic.expression import Node, Scalar, Vector
from eomgen.symbolic.numeric import numbers_of
from eomgen.symbolic.print import Notation, Symbol

# -------- space drawing ----------------------------------------------------------------------------------------
# Drawing in space -> matplotlib: faces and lines seen from far away, the farthest drawn first.

AZIMUTH, ELEVATION = math.radians(-58), math.radians(22)
ALONG_X = 0.9  # cosine of what is upright to x: more, and y goes to the right
SHADES = 24  # of a colour
PADDED = 12  # corners; where a facet has more they are drawn one by one
LIGHT = np.array([0.35, -0.5, 0.79])
CLEAR = {"inertia": 0.35, "track": 0.12, "hole": 0.2}  # how much of what is behind these hide
THIN = ("cylinder",)  # roles of faces that no name should cover
TOWARDS = 0.02  # lines lie so much nearer than the faces around them, of the extent


def sight(up: np.ndarray) -> np.ndarray:
    """The rotation from the ground to the page: right, up, towards the eye.

    Args:
        up: of the ground, upright on the page; where it is z, x goes to the right and y away.
    """
    c, s, ce, se = math.cos(AZIMUTH), math.sin(AZIMUTH), math.cos(ELEVATION), math.sin(ELEVATION)
    across = np.eye(3)[0 if abs(up[0]) < ALONG_X else 1]
    first = across - (across @ up) * up
    first /= np.linalg.norm(first)
    upright = np.array([first, np.cross(up, first), up])
    found: np.ndarray = np.array([[-s, c, 0.0], [-se * c, -se * s, ce], [ce * c, ce * s, se]]) @ upright
    return found


@dataclass(frozen=True)
class _Facets:
    """Faces, or pieces of a line, of one stroke on the page.

    Args:
        depth: n, larger is nearer.
        corners: n x k x 2.
        inks: n x (fill 4, edge 4, width).
    """

    depth: np.ndarray
    corners: np.ndarray
    inks: np.ndarray


@dataclass(frozen=True)
class _Layer(ABC):
    """Strokes that are put onto the page together.

    Args:
        inks: of each stroke, as those of facets; of a face in full light.
        nearer: so much it lies before its place.
    """

    strokes: tuple[Stroke, ...]
    inks: np.ndarray
    nearer: np.ndarray

    @abstractmethod
    def at(self, frame: int, view: np.ndarray) -> _Facets:
        """Visible facets of the strokes at a frame."""

    @cached_property
    def counts(self) -> np.ndarray:
        """Number of faces, or points, of each stroke."""
        return np.array([stroke.path.shape[1] for stroke in self.strokes])

    @cached_property
    def owner(self) -> np.ndarray:
        """Index of the stroke to which each face, or point, belongs."""
        return np.repeat(np.arange(len(self.strokes)), self.counts)

    def _places(self, frame: int) -> np.ndarray:
        found: np.ndarray = np.concatenate([stroke.path[frame] for stroke in self.strokes])
        return found


class _Faces(_Layer):
    def at(self, frame: int, view: np.ndarray) -> _Facets:
        corners = self._places(frame)
        middle = corners.mean(axis=1)
        normal = _normals(corners)
        seen = np.isfinite(middle).all(axis=1) & (self._towards_the_eye(middle, normal, view[2]) | ~self._solid)
        of, page = self.owner[seen], corners[seen] @ view.T
        inks = self.inks[of]
        inks[:, :3] *= 0.62 + 0.38 * np.round(SHADES * np.abs(normal[seen] @ LIGHT))[:, None] / SHADES
        return _Facets(page[:, :, 2].mean(axis=1) + self.nearer[of], page[:, :, :2], inks)

    @cached_property
    def _solid(self) -> np.ndarray:
        found: np.ndarray = np.array([stroke.solid for stroke in self.strokes])[self.owner]
        return found

    def _towards_the_eye(self, middle: np.ndarray, normal: np.ndarray, eye: np.ndarray) -> np.ndarray:
        """True for each face whose outer side, away from the middle of its stroke's faces, looks to the eye."""
        first = np.concatenate([[0], np.cumsum(self.counts)[:-1]])
        inside = np.add.reduceat(middle, first) / self.counts[:, None]
        found: np.ndarray = np.einsum("fi,fi->f", normal, middle - inside[self.owner]) * (normal @ eye) >= 0
        return found


class _Lines(_Layer):
    def at(self, frame: int, view: np.ndarray) -> _Facets:
        page = self._places(frame) @ view.T
        joined = np.stack([page[:-1], page[1:]], axis=1)
        kept = (self.owner[:-1] == self.owner[1:]) & np.isfinite(joined).all(axis=(1, 2))
        of, joined = self.owner[:-1][kept], joined[kept]
        return _Facets(joined[:, :, 2].mean(axis=1) + self.nearer[of], joined[:, :, :2], self.inks[of])


@dataclass(frozen=True)
class _Dots(_Layer):
    radius: float

    def at(self, frame: int, view: np.ndarray) -> _Facets:
        page = self._places(frame) @ view.T
        kept = np.isfinite(page).all(axis=1)
        of, page = self.owner[kept], page[kept]
        turn = np.linspace(0, math.tau, 13)[:-1]
        discs = page[:, None, :2] + self.radius * np.column_stack([np.cos(turn), np.sin(turn)])
        return _Facets(page[:, 2] + self.nearer[of], discs, self.inks[of])


def _normals(corners: np.ndarray) -> np.ndarray:
    """Unit normals of faces f x c x 3; 0 for those without an area."""
    found = _cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 1])
    flat = ~found.any(axis=1)
    if corners.shape[1] > 3 and flat.any():
        found[flat] = _cross(corners[flat, 2] - corners[flat, 1], corners[flat, 3] - corners[flat, 2])
    lengths = np.sqrt(np.einsum("fi,fi->f", found, found))[:, None]
    found /= np.where(lengths > 0, lengths, 1.0)
    return found


def _sorted_corners(groups: list[np.ndarray], order: np.ndarray) -> Any:
    """The corners of all facets in an order: as one array, those with fewer corners end in the same one often."""
    most = max((group.shape[1] for group in groups), default=2)
    if most > PADDED:
        every = [facet for group in groups for facet in group]
        return [every[k] for k in order]
    padded = [np.concatenate([g, np.repeat(g[:, -1:], most - g.shape[1], axis=1)], axis=1) for g in groups]
    return np.concatenate(padded)[order] if padded else np.zeros((0, 2, 2))


def page_limits(drawing: Drawing) -> tuple[np.ndarray, np.ndarray]:
    """The corners of the page: all that is drawn over all frames, but for lines that go on."""
    view, unit = sight(drawing.sizes.up), drawing.sizes.unit
    box = np.array(list(product(*zip(drawing.sizes.low, drawing.sizes.high, strict=True))))
    paths = [s.path for s in drawing.strokes if s.role != "track" or s.faces]
    found = corners_of((path @ view.T[:, :2] for path in ([box] if drawing.followed else [*paths, box[[0, -1]]])), 2)
    low, high = found or (np.zeros(2), np.ones(2))
    low, high = low - MARGIN * unit, high + MARGIN * unit
    size, middle = high - low, 0.5 * (low + high)
    size = np.maximum(size, max(NARROWEST * size.max(), SMALLEST * unit))
    return middle - 0.5 * size, middle + 0.5 * size


@dataclass(frozen=True)
class SpaceView:
    """A scene in space as it is seen: faces, lines and names on the page.

    Args:
        colors: of bodies that have one of their own.
    """

    drawing: Drawing
    colors: Mapping[str, str] = field(default_factory=dict)

    @cached_property
    def view(self) -> np.ndarray:
        """The rotation from the ground to the page."""
        return sight(self.drawing.sizes.up)

    def seen(self, frame: int) -> tuple[Any, np.ndarray]:
        """(corners on the page, inks) of all that is seen at a frame, the farthest first."""
        parts = [layer.at(frame, self.view) for layer in self.layers]
        order = np.argsort(np.concatenate([[], *(part.depth for part in parts)]), kind="stable")
        inks = np.concatenate([np.zeros((0, 9)), *(part.inks for part in parts)])[order]
        return _sorted_corners([part.corners for part in parts], order), inks

    def _color(self, stroke: Stroke) -> str:
        own = self.colors.get(stroke.of) if stroke.role in OWN_COLORS else None
        return own or LINES[stroke.role][0]

    @cached_property
    def layers(self) -> list[_Layer]:
        """The strokes, those together that have as many corners a face, or points, in the order of the drawing."""
        alike: dict[tuple[int, int], list[Stroke]] = {}
        for stroke in self.drawing.strokes:
            key = (2, stroke.path.shape[2]) if stroke.faces else (int(stroke.dot), 0)
            alike.setdefault(key, []).append(stroke)
        kinds = {2: self._faces, 1: self._dots, 0: self._lines}
        return [kinds[kind](strokes) for (kind, _), strokes in alike.items()]

    def _faces(self, strokes: list[Stroke]) -> _Faces:
        inks, back = [], []
        for stroke in strokes:
            color, alpha = self._color(stroke), CLEAR.get(stroke.role, 1.0)
            base = color if stroke.of in self.colors else FILLS.get(stroke.role, color)
            edge = 0.25 if stroke.path.shape[1] > 12 else 0.8 * max(alpha, 0.4)
            inks.append([*_rgb(base), alpha, *_rgb(color), edge, 0.4])
            back.append(-math.inf if stroke.role == "track" else 0.0)
        return _Faces(tuple(strokes), np.array(inks), np.array(back))

    def _near(self, strokes: list[Stroke]) -> np.ndarray:
        nearer = TOWARDS * self.drawing.sizes.extent
        return np.array([math.inf if stroke.role == "axes" else nearer for stroke in strokes])

    def _dots(self, strokes: list[Stroke]) -> _Dots:
        inks = [[*(ink := (*_rgb(self._color(stroke)), 1.0)), *ink, 0.5] for stroke in strokes]
        return _Dots(tuple(strokes), np.array(inks), self._near(strokes), 0.55 * self.drawing.sizes.unit)

    def _lines(self, strokes: list[Stroke]) -> _Lines:
        inks = []
        for stroke in strokes:
            thin = FINE if stroke.fine else 3.0 if stroke.role == "body" else LINES[stroke.role][1]
            inks.append([0.0, 0.0, 0.0, 0.0, *_rgb(self._color(stroke)), 1.0, thin])
        return _Lines(tuple(strokes), np.array(inks), self._near(strokes))

    def names(self, frame: int, notation: Notation) -> list[PlacedName]:
        """The names next to their places on the page, as a notation has them."""
        found: dict[tuple[str, str, int, int], PlacedName] = {}
        for letter in self.drawing.letters:
            at = letter.at[frame] @ self.view.T
            if np.isfinite(at).all():
                color = (
                    self.colors.get(letter.of, BODY) if letter.role == "label" else LINES.get(letter.role, (INK, 1))[0]
                )
                name = PlacedName(
                    written(letter, notation), (float(at[0]), float(at[1])), color, 9.0, RANKS.get(letter.role, 4)
                )
                of = letter.of if letter.role == "label" else ""  # bodies may have their centres at one place
                found.setdefault((letter.role, of, round(at[0] * 1e6), round(at[1] * 1e6)), name)
        return list(found.values())

    def lines(self, frame: int) -> list[np.ndarray]:
        """Lines that names should not cover."""
        shown = [s for s in self.drawing.strokes if not s.faces or s.role in THIN]
        return [s.path[frame].reshape(-1, 3) @ self.view.T[:, :2] for s in shown]


class SpacePicture:
    """A scene in space on matplotlib axes; `show` sets it to another of its frames."""

    def __init__(self, panel: Any, drawing: Drawing, colors: Mapping[str, str] | None = None) -> None:
        from matplotlib.collections import PolyCollection

        self.drawing, self.seen = drawing, SpaceView(drawing, colors or {})
        panel.set_aspect("equal")
        panel.axis("off")
        look: dict[str, Any] = {"capstyle": "round", "joinstyle": "round", "clip_on": drawing.followed}
        self.pieces: Any = PolyCollection([], closed=False, **look)
        panel.add_collection(self.pieces, autolim=False)
        low, high = page_limits(drawing)
        panel.set_xlim(low[0], high[0])
        panel.set_ylim(low[1], high[1])

    def show(self, frame: int) -> None:
        """Everything at one frame, sorted by its distance."""
        corners, inks = self.seen.seen(frame)
        self.pieces.set_verts(corners, closed=True)
        self.pieces.set_facecolor(inks[:, :4])
        self.pieces.set_edgecolor(inks[:, 4:8])
        self.pieces.set_linewidth(inks[:, 8])

    @property
    def view(self) -> np.ndarray:
        """The rotation from the ground to the page."""
        return self.seen.view

    def names(self, frame: int, notation: Notation) -> list[PlacedName]:
        """The names next to their places on the page."""
        return self.seen.names(frame, notation)

    def lines(self, frame: int) -> list[np.ndarray]:
        """Lines that names should not cover."""
        return self.seen.lines(frame)


def _cross(a: np.ndarray, b: np.ndarray) -> np.ndarray:
    """a x b of rows; numpy's own takes three times as long for as few."""
    (ax, ay, az), (bx, by, bz) = a.T, b.T
    found: np.ndarray = np.stack([ay * bz - az * by, az * bx - ax * bz, ax * by - ay * bx], axis=1)
    return found


@cache
def _rgb(color: str) -> np.ndarray:
    from matplotlib.colors import to_rgb

    return np.array(to_rgb(color))


def draw_space(
    panel: Any, drawing: Drawing, notation: Notation, colors: Mapping[str, str] | None = None
) -> SpacePicture:
    """A scene in space at its first frame, on matplotlib axes with equal scales and no frame.

    Args:
        notation: typesetting of the names of the model.
        colors: of bodies and members that have one of their own.
    """
    from eomgen.documents.drawing import NamesArtist

    picture = SpacePicture(panel, drawing, colors)
    picture.show(0)
    panel.add_artist(NamesArtist(tuple(picture.names(0, notation)), picture.lines(0)))
    return picture


def draw_scene(panel: Any, drawing: Drawing, notation: Notation) -> None:
    """A scene at its first frame, on matplotlib axes with equal scales and no frame."""
    (draw if len(drawing.sizes.low) == 2 else draw_space)(panel, drawing, notation)


def page_shape(drawing: Drawing) -> float:
    """Height over width of the page of a drawing."""
    low, high = limits(drawing) if len(drawing.sizes.low) == 2 else page_limits(drawing)
    return float(high[1] - low[1]) / float(high[0] - low[0])


# -------- at rest --------------------------------------------------------------------------------------------
# Model -> a picture of it where it starts, with its coordinates and lengths.


WIDTHS_AT_REST, HEIGHT_AT_REST, TITLE_AT_REST = (3.4, 8.0), 4.2, 0.4  # [inches]


def rest_picture(model: Model) -> Picture:
    """The scene of a model at its start; a parameter without a value is drawn as 1.

    Raises:
        DerivationError, NotYet: what cannot be derived is not drawn either.
    """
    return picture_of_scene(scene_of(model))


def drawing_at_rest(scene: Scene) -> Drawing:
    """A scene at the start of its model, with its dimensions."""
    return drawing_of(SceneNumbers.at(scene, StateInNumbers.at_start(scene.system)), dimensions=True)


def picture_of_scene(scene: Scene) -> Picture:
    """A scene at the start of its model."""
    drawing = drawing_at_rest(scene)
    ratio = 1 / page_shape(drawing)
    width = min(max(HEIGHT_AT_REST * ratio, WIDTHS_AT_REST[0]), WIDTHS_AT_REST[1])
    height = min(HEIGHT_AT_REST, width / ratio + TITLE_AT_REST)

    def fill(figure: Any) -> None:
        draw_scene(figure.subplots(), drawing, notation_of(scene.system.scope.model))

    return Picture((width, height), fill, scene.name)


# -------- sketches ----------------------------------------------------------------------------------------------------
# System, values -> a drawing of it in one configuration, in the plane or in space, with the arrows of a result.


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
        return drawing_of(self.frame, dimensions=self.dimensions, arrow=self.longest)

    def lines(self, roles: Iterable[str], of: str = "") -> list[np.ndarray]:
        """Lines of the page that its strokes of some roles are; `of`: of one body alone."""
        shown = [s for s in self.drawing.strokes if s.role in roles and of in ("", s.of) and not s.faces]
        return [self.page(stroke.path[0]) for stroke in shown]

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

    @property
    def corners(self) -> tuple[np.ndarray, np.ndarray]:
        """The lower left and the upper right end of its drawing in the plane."""
        return limits(self.drawing)

    def draw(self, panel: Any, *, names: bool = True) -> None:
        """Draws it on matplotlib axes, which have equal scales and no frame.

        Args:
            names: bodies, points and arrows are named.
        """
        if not self.plane:
            draw_space(panel, self.drawing, self.notation, self.colors)
            return
        before = panel.dataLim.get_points() if panel.has_data() else None
        draw(panel, self.drawing, self.notation, names=names, colors=self.colors)
        panel.dataLim.set_points(np.array(self.corners))
        if before is not None:
            panel.dataLim.update_from_data_xy(before, ignore=False)
        panel.autoscale(True)  # what is drawn outside of it is included
        panel.margins(0.0)

    def name_along(self, panel: Any, text: str, ends: Sequence[Any], of: str) -> None:
        """Writes a name along a line of the page, in the colour of a member; the others keep off it."""
        (x, y), (u, v) = ends
        if text:
            shown = [artist for artist in panel.artists if isinstance(artist, NamesArtist)]
            names = shown[0] if shown else panel.add_artist(NamesArtist([], []))
            names.add(PlacedName(text, (float(x), float(y)), self.colors[of], 8.0, -1, (float(u), float(v))))


# -------- drawing on a page ------------------------------------------------------------------------------------
# Scene -> FlatDrawing: shapes and names of a picture on its page, for whoever draws them; in hundredths of a second.
#
# The look of a stroke and the place of a name are those of the pictures by matplotlib.

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
