"""Drawing -> matplotlib: the strokes of a scene in the plane on a panel, in the colours of their roles; its names."""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping, Sequence
from itertools import pairwise
from typing import Any

import numpy as np
from matplotlib.artist import Artist
from matplotlib.text import Text

from eomgen.documents.figures import halo, mathtext
from eomgen.frozen import dataclass
from eomgen.scene import Drawing, Letter, Stroke
from eomgen.symbolic.print import Notation

INK, GREY, PAPER = "#2b2b2b", "#6a6a6a", "#ffffff"
BODY, TINT, LOAD, REACTION, VELOCITY = "#2f5d8a", "#c9d8e8", "#b03a2e", "#2e7d4f", "#2e7d4f"
LINES: Mapping[str, tuple[str, float]] = {  # colour and width [points]
    "ground": (GREY, 1.2),
    "track": (GREY, 1.2),
    "axes": ("#707070", 1.0),
    "member": ("#44627f", 1.8),
    "string": (INK, 1.3),
    "spring": (INK, 1.2),
    "damper": (INK, 1.2),
    "cylinder": (INK, 1.2),
    "body": (BODY, 1.5),
    "hole": (BODY, 1.5),
    "inertia": (BODY, 1.0),
    "rim": (BODY, 1.2),
    "joint": (GREY, 1.2),
    "solid": (GREY, 1.0),
    "support": (GREY, 1.2),
    "contact": (GREY, 1.0),
    "point": (INK, 1.0),
    "dimension": ("#7a5c3e", 0.9),
    "center": ("#8e44ad", 1.2),
    "velocity": (VELOCITY, 1.5),
    "drive": (VELOCITY, 1.3),
    "force": (LOAD, 1.5),
    "reaction": (REACTION, 1.5),
}
METAL = "#b4c0cc"
FILLS: Mapping[str, str] = {
    "body": TINT,
    "inertia": "#e3ebf3",
    "rim": TINT,
    "joint": PAPER,
    "support": PAPER,
    "cylinder": METAL,
}
OWN_COLORS = ("body", "inertia", "hole", "rim", "member")
"""Roles of what may have a colour of its own."""
OPEN, FINE = 2.6, 0.9  # widths of a body that is a line, and of marks on something [points]
RANKS: Mapping[str, int] = {"reaction": 0, "force": 1, "dimension": 2, "label": 3, "axes": 5}
MARGIN, NARROWEST = 3.5, 0.4  # around what is drawn [symbol units]; the shorter side, of the longer
SMALLEST = 22.0  # side of a picture [symbol units]


def draw(
    panel: Any,
    drawing: Drawing,
    notation: Notation,
    *,
    names: bool = True,
    colors: Mapping[str, str] | None = None,
) -> list[tuple[Any, Stroke]]:
    """A scene in the plane at its first frame, on matplotlib axes with equal scales and no frame.

    Args:
        notation: typesetting of the names of the model.
        names: bodies and points are named.
        colors: of bodies that have one of their own.
    Returns:
        Each artist with the stroke that it shows.
    """
    panel.set_aspect("equal")
    panel.axis("off")
    strokes = [stroke for stroke in drawing.strokes if stroke.path.size]
    shown = [(artist_of(panel, s, 0, colors or {}, 1 + k / len(strokes)), s) for k, s in enumerate(strokes)]
    low, high = limits(drawing)
    panel.set_xlim(low[0], high[0])
    panel.set_ylim(low[1], high[1])
    if names:
        from eomgen.documents.drawing import NamesArtist

        lines = [stroke.path[0] for stroke in drawing.strokes if stroke.role != "label"]
        panel.add_artist(NamesArtist(tuple(letter_names(drawing.letters, colors or {}, notation)), lines))
    return shown


@dataclass(frozen=True)
class StrokeLook:
    """Look of a stroke.

    Args:
        fill: the colour inside, None where it is a line.
        edge: the colour of the line.
        width: of the line; of a dot its diameter [points].
    """

    fill: str | None
    edge: str
    width: float


def look_of(stroke: Stroke, colors: Mapping[str, str]) -> StrokeLook:
    """The look of a stroke of the plane.

    Args:
        colors: of bodies that have one of their own.
    """
    color, width = LINES[stroke.role]
    own = colors.get(stroke.of) if stroke.role in OWN_COLORS else None
    color = own or color
    if stroke.dot:
        return StrokeLook(color, color, 3.5 if stroke.role == "center" else 7)
    if stroke.filled:
        solid = stroke.role not in FILLS and not stroke.hole
        fill = color if solid else PAPER if stroke.hole else _tinted(own) if own else FILLS[stroke.role]
        return StrokeLook(fill, color, 0.4 if solid else width)
    return StrokeLook(None, color, FINE if stroke.fine else OPEN if stroke.role == "body" else width)


def artist_of(panel: Any, stroke: Stroke, frame: int, colors: Mapping[str, str], layer: float) -> Any:
    """One stroke, in its layer."""
    look = look_of(stroke, colors)
    x, y = stroke.path[frame].T
    if stroke.dot:
        dot = {"marker": "o", "markersize": look.width, "linestyle": "none"}
        return panel.plot(x, y, color=look.edge, zorder=layer, **dot)[0]
    if look.fill is not None:
        return panel.fill(x, y, facecolor=look.fill, edgecolor=look.edge, linewidth=look.width, zorder=layer)[0]
    ends = {"solid_capstyle": "round", "solid_joinstyle": "round"}
    return panel.plot(x, y, color=look.edge, linewidth=look.width, zorder=layer, **ends)[0]


def _tinted(color: str) -> str:
    """A colour, three quarters of it paper."""
    from matplotlib.colors import to_hex, to_rgb

    r, g, b = (0.72 + 0.28 * x for x in to_rgb(color))
    return to_hex((r, g, b))


def limits(drawing: Drawing) -> tuple[np.ndarray, np.ndarray]:
    """The corners of the picture: all that is drawn, but for tracks, which go on."""
    shown = [s for s in drawing.strokes if s.role != "track" and not drawing.followed]
    clouds = [s.path.reshape(-1, s.path.shape[-1]) for s in shown]
    cloud = np.vstack([*clouds, drawing.sizes.low[None, :], drawing.sizes.high[None, :]])
    cloud = cloud[np.isfinite(cloud).all(axis=1)]
    margin = MARGIN * (drawing.sizes.unit or 0.03)
    low, high = cloud.min(axis=0) - margin, cloud.max(axis=0) + margin
    size, middle = high - low, 0.5 * (low + high)
    size = np.maximum(size, max(NARROWEST * size.max(), SMALLEST * drawing.sizes.unit))
    return middle - 0.5 * size, middle + 0.5 * size


def letter_names(letters: Sequence[Letter], colors: Mapping[str, str], notation: Notation) -> Iterable[PlacedName]:
    """The names of a picture; of several points at one place the first, of a length or coordinate the first time."""
    there: set[tuple[str, int, int] | str] = set()
    for letter in letters:
        x, y = (float(v) for v in letter.at[0])
        if not np.isfinite([x, y]).all():
            continue
        key = (letter.role, round(x * 1e6), round(y * 1e6))
        if (letter.role == "point" and key in there) or (letter.role == "dimension" and letter.text in there):
            continue
        there |= {key, letter.text} if letter.role == "dimension" else {key}
        color = colors.get(letter.of, BODY) if letter.role == "label" else LINES.get(letter.role, (INK, 1.0))[0]
        yield PlacedName(written(letter, notation), (x, y), color, 9.0, RANKS.get(letter.role, 4))


def written(letter: Letter, notation: Notation) -> str:
    """A name as matplotlib sets it: of bodies, forces and centres as it is, of points and lengths as mathematics.

    A body that declares its symbol is called by that, a force that has one too.
    """
    if letter.role == "label" and letter.of in notation.indices:
        return f"${notation.indices[letter.of]}$"
    if letter.role in ("force", "reaction") and letter.text in notation.symbols:
        return f"${mathtext(letter.text, notation)}$"
    if letter.role in ("label", "force", "reaction", "center"):
        return letter.text.replace("$", r"\$")
    return f"${mathtext(letter.text, notation)}$"


# -------- letters ----------------------------------------------------------------------------------------------
# Names of a picture, each next to its place where it covers no other name and as little as may be of what is drawn.
#
# Where they stand is found when the picture is drawn: only then is it known how many dots a metre has.

RINGS = (5.0, 9.0, 14.0, 20.0, 28.0, 38.0, 50.0)  # from the place to the name [points]
TURNS = tuple(math.pi * k / 8 for k in (2, 1, 14, 6, 3, 13, 10, 5, 0, 4, 12, 8, 15, 7, 11, 9))  # where one looks first
APART = 1.0  # between two names [points]
SHARES = (0.5, 0.4, 0.6, 0.3, 0.7, 0.22, 0.78)  # of a line, where the middle of what is written along it may stand
BESIDE = 1.5  # of that from the line [points]
NOWHERE = np.zeros((0, 2))
STRANGE = 5.0  # cost of a name nearer to another's place, in rings
COVERED = 4.0  # cost of a covered dot, in rings
STEP = 3.0  # of the dots that stand for a line that should not be covered [points]


@dataclass(frozen=True)
class PlacedName:
    """A name and its place.

    Args:
        at: data coordinates.
        rank: those with a smaller one choose first; names without room are left out.
        along: the other end of the line along which it is written, from `at`; None: it is upright, next to its place.
    """

    text: str
    at: tuple[float, float]
    color: str = "#202020"
    size: float = 9.0
    rank: int = 0
    along: tuple[float, float] | None = None


@dataclass(frozen=True)
class PageBox:
    """An upright box of a picture [dots]."""

    left: float
    bottom: float
    right: float
    top: float

    def meets(self, other: PageBox) -> bool:
        return (
            self.left < other.right and other.left < self.right and self.bottom < other.top and other.bottom < self.top
        )

    def holds(self, other: PageBox) -> bool:
        return (
            self.left <= other.left
            and other.right <= self.right
            and self.bottom <= other.bottom
            and other.top <= self.top
        )

    def grown(self, by: float) -> PageBox:
        return PageBox(self.left - by, self.bottom - by, self.right + by, self.top + by)

    def covered(self, dots: np.ndarray) -> int:
        """Number of the dots that lie in the box."""
        x, y = dots.T
        return int(np.count_nonzero((x > self.left) & (x < self.right) & (y > self.bottom) & (y < self.top)))

    def away(self, places: np.ndarray) -> np.ndarray:
        """Distances of places from the box [dots]."""
        x, y = places.T
        dx, dy = np.maximum(self.left - x, x - self.right), np.maximum(self.bottom - y, y - self.top)
        found: np.ndarray = np.hypot(np.maximum(dx, 0), np.maximum(dy, 0))
        return found


def _beside(at: tuple[float, float], size: tuple[float, float], away: float, turn: float) -> PageBox:
    """A box of a size next to a place, so far away in a direction that its edge or corner is turned to it."""
    c, s = math.cos(turn), math.sin(turn)
    x = at[0] + away * c + 0.5 * size[0] * max(-1.0, min(1.0, 1.6 * c))
    y = at[1] + away * s + 0.5 * size[1] * max(-1.0, min(1.0, 1.6 * s))
    return PageBox(x - 0.5 * size[0], y - 0.5 * size[1], x + 0.5 * size[0], y + 0.5 * size[1])


def room_for(
    at: tuple[float, float],
    size: tuple[float, float],
    taken: Sequence[PageBox],
    dots: np.ndarray,
    inside: tuple[PageBox, PageBox],
    point: float,
    *,
    others: np.ndarray = NOWHERE,
) -> PageBox | None:
    """The best box of a size next to a place, which meets none that is taken; None where there is no room.

    Args:
        dots: points that should not be covered.
        inside: the panel, which it should not leave, and the picture, which it never does.
        point: a point in dots.
        others: places of other names, to which it should not be nearer than to its own.
    """
    best: tuple[float, PageBox | None] = (math.inf, None)
    kept = [box.grown(APART * point) for box in taken]
    for number, ring in enumerate(RINGS):
        for order, turn in enumerate(TURNS):
            box = _beside(at, size, ring * point, turn)
            if not inside[1].holds(box) or any(box.meets(other) for other in kept):
                continue
            cost = number + 0.05 * order + COVERED * box.covered(dots) + (0 if inside[0].holds(box) else 30)
            cost += STRANGE * bool((box.away(others) < box.away(np.array([at])) - point).any())
            if cost < best[0]:
                best = (cost, box)
    return best[1]


def slices_along(a: np.ndarray, b: np.ndarray, size: tuple[float, float], share: float, away: float) -> list[PageBox]:
    """A text of a size written along the line from a to b: the boxes of its pieces, as long as it is high.

    Args:
        share: of the line, where its middle is.
        away: of its middle, to the left of the line.
    """
    e = (b - a) / (float(np.hypot(*(b - a))) or 1.0)
    middle = a + share * (b - a) + away * np.array([-e[1], e[0]])
    count = max(1, math.ceil(size[0] / size[1]))
    half = 0.5 * (abs(e) * size[0] / count + abs(e[::-1]) * size[1])
    places = (middle + ((k + 0.5) / count - 0.5) * size[0] * e for k in range(count))
    return [PageBox(x - half[0], y - half[1], x + half[0], y + half[1]) for x, y in places]


def place_along(
    a: np.ndarray, b: np.ndarray, size: tuple[float, float], taken: Sequence[PageBox], dots: np.ndarray, point: float
) -> tuple[float, float, list[PageBox]]:
    """(share, away, boxes) of the best place of a text along a line: at its middle, else nearer to an end, or below.

    Args:
        dots: points that should not be covered; those of the line itself are not meant.
    """
    found = []
    (x, y), (u, v) = (b - a) / (float(np.hypot(*(b - a))) or 1.0), (dots - a).T
    crossing = dots[abs(x * v - y * u) > point]
    for side in (1, -1):
        for order, share in enumerate(SHARES):
            away = side * (0.5 * size[1] + BESIDE * point)
            boxes = slices_along(a, b, size, share, away)
            met = sum(box.meets(other) for box in boxes for other in taken)
            covered = sum(box.covered(crossing) for box in boxes)
            found.append((met, covered, side < 0, order, share, away, boxes))
    *_, share, away, boxes = min(found, key=lambda each: each[:4])
    return share, away, boxes


def dots_along(lines: Sequence[np.ndarray], step: float) -> np.ndarray:
    """Points along lines, so close that no name passes between them; nan breaks a line."""
    found = [np.zeros((0, 2))]
    for line in lines:
        for a, b in pairwise(line):
            length = float(np.hypot(*(b - a)))
            if math.isfinite(length):
                count = min(int(length / step) + 1, 400)
                found.append(a + np.linspace(0, 1, count + 1)[:, None] * (b - a))
    return np.vstack(found)


# -------- letters artist --------------------------------------------------------------------------------------
# Names of a picture as one matplotlib artist, which finds room for them when it is drawn.


class NamesArtist(Artist):
    """The names of one panel.

    Args:
        names: each is drawn once.
        lines: those that they should not cover, k x 2 each, data coordinates; nan breaks.
    """

    zorder = 9

    def __init__(self, names: Sequence[PlacedName], lines: Sequence[np.ndarray]) -> None:
        super().__init__()
        self.names = sorted(dict.fromkeys(names), key=lambda name: name.rank)
        self.lines = lines
        self.areas: list[tuple[str, tuple[PageBox, ...]]] = []
        """(text, boxes in dots) of every name as it was drawn last; one that is turned has several, end to end."""

    def add(self, name: PlacedName) -> None:
        """One more, which chooses its place by its rank."""
        self.names = sorted(dict.fromkeys([*self.names, name]), key=lambda each: each.rank)

    def draw(self, renderer: Any) -> None:
        """Find room for each and draw it."""
        figure = self.get_figure(root=True)
        if not self.get_visible() or self.axes is None or figure is None:
            return
        point = renderer.points_to_pixels(1.0)
        page = self.axes.transData.transform
        dots = dots_along([page(line) for line in self.lines], STEP * point)
        window = self.axes.get_window_extent(renderer)
        inside = PageBox(*window.extents), PageBox(*figure.bbox.extents)
        self.areas = []
        places = page(np.array([name.at for name in self.names if name.along is None]).reshape(-1, 2))
        taken = self._others(renderer)
        for name in self.names:
            text = Text(0, 0, name.text, color=name.color, fontsize=name.size, path_effects=halo())
            text.set_figure(figure)
            size = text.get_window_extent(renderer)
            (x, y), wide = page(name.at), (size.width, size.height)
            if name.along is not None:
                found = self._along(text, page(np.array([name.at, name.along])), wide, taken, dots)
                self.areas.append((name.text, found))
                taken += found
                text.draw(renderer)
            elif (box := room_for((x, y), wide, taken, dots, inside, point, others=places)) is not None:
                self.areas.append((name.text, (box,)))
                taken.append(box)
                text.set_position((box.left - size.x0, box.bottom - size.y0))
                text.draw(renderer)

    def _others(self, renderer: Any) -> list[PageBox]:
        """The boxes of the other texts on the panel."""
        texts = [text for text in self.axes.texts if text.get_visible() and text.get_text()] if self.axes else []
        return [PageBox(*text.get_window_extent(renderer).extents) for text in texts]

    @staticmethod
    def _along(
        text: Text, ends: np.ndarray, size: tuple[float, float], taken: list[PageBox], dots: np.ndarray
    ) -> tuple[PageBox, ...]:
        """A text turned along a line, readable from below or from the right, and its boxes."""
        figure = text.get_figure(root=True)
        point = 1.0 if figure is None else figure.dpi / 72
        a, b = ends if ends[1, 0] - ends[0, 0] > -0.5 * point else ends[::-1]
        share, away, boxes = place_along(a, b, size, taken, dots, point)
        e = (b - a) / (float(np.hypot(*(b - a))) or 1.0)
        text.set_position(tuple(a + share * (b - a) + away * np.array([-e[1], e[0]])))
        text.set(ha="center", va="center", rotation=math.degrees(math.atan2(e[1], e[0])), rotation_mode="anchor")
        return tuple(boxes)


def add_names(panel: Any, words: Sequence[tuple[str, tuple[float, float]]], lines: Sequence[np.ndarray]) -> None:
    """Writes words at places of a panel, those that come first the nearest, where they cover no line and no other."""
    names = [PlacedName(text, place, INK, 8.0, rank) for rank, (text, place) in enumerate(words) if text]
    panel.add_artist(NamesArtist(names, lines))
