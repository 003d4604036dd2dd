"""System, values -> a drawing of it in one configuration, with matplotlib.

System, values -> a drawing of a plane model in one configuration, from its scene; arrows are added by the caller.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import replace
from functools import cached_property
from itertools import pairwise
from typing import Any

import numpy as np

from eomgen.documents.document import notation_of
from eomgen.documents.figures import mathtext
from eomgen.documents.letters import PlacedName
from eomgen.frozen import dataclass
from eomgen.mechanics.dynamics import System
from eomgen.mechanics.kinematics import BodyLink
from eomgen.scene import Drawing, Letter, SceneNumbers, Stroke, plane_drawing, scene_of_system
from eomgen.symbolic.expression import Node, Scalar, Vector
from eomgen.symbolic.numeric import numbers_of
from eomgen.symbolic.print import Notation

__all__ = [
    "ARROW",
    "LOAD",
    "REACTION",
    "PagePoint",
    "Sketch",
    "arrow",
    "distributed",
    "draw_model",
    "is_freer_outward",
    "moment_arc",
    "name_along",
    "name_beside",
]


PagePoint = tuple[float, float]
ARROW = 0.13  # length of the longest arrow, of the extent
LOADS = ("force", "axes", "dimension")  # roles that a picture with arrows of its own leaves out


@dataclass(frozen=True)
class Sketch:
    """A plane system in one configuration, in numbers.

    Args:
        system: the system.
        values: of t, the coordinates and the parameters.
        dimensions: lengths are drawn.
    """

    system: System
    values: Mapping[Node, float]
    dimensions: bool = False

    def numbers(self, scalars: Iterable[Scalar]) -> list[float]:
        """Values of scalars in this configuration."""
        return numbers_of(scalars, self.values)

    def place(self, point: Vector) -> PagePoint:
        """A place of the ground's axes."""
        x, y = self.numbers(point[:2])
        return x, y

    def position(self, place: tuple[str | None, Vector]) -> PagePoint:
        """Position on the page of a place of a body."""
        return self.place(self.system.motion.position(place))

    @cached_property
    def drawing(self) -> Drawing:
        """Its scene there, loads and sizes left out."""
        scene = scene_of_system(self.system)
        left = LOADS[:-1] if self.dimensions else LOADS
        scene = replace(scene, marks=tuple(mark for mark in scene.marks if mark.role not in left))
        numbers = SceneNumbers(scene, np.array([self.numbers(scene.values)], dtype=float))
        return plane_drawing(numbers, dimensions=self.dimensions)

    def lines(self, link: BodyLink) -> list[np.ndarray]:
        """Lines of the drawing of a body."""
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
    panel.autoscale(True)  # what is drawn outside of it is included
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
    _names(panel).add(name)


def _kept_off(panel: Any, line: Any) -> None:
    """One more line, k x 2, that no name should cover."""
    names = _names(panel)
    names.lines = [*names.lines, np.array(line, dtype=float)]


def _names(panel: Any) -> Any:
    """The names of a panel, which it has from now on."""
    from eomgen.documents.letters import NamesArtist

    shown = [artist for artist in panel.artists if isinstance(artist, NamesArtist)]
    return shown[0] if shown else panel.add_artist(NamesArtist([], []))


# -------- scene drawing ---------------------------------------------------------------------------------------
# Drawing -> matplotlib: the strokes and names of a scene on a panel, in the colours of their roles.


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
FILLS: Mapping[str, str] = {"body": TINT, "inertia": "#e3ebf3", "rim": TINT, "joint": PAPER, "support": PAPER}
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
        from eomgen.documents.letters import NamesArtist

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
    own = colors.get(stroke.of) if stroke.role in ("body", "inertia", "hole", "rim") else None
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
    """A name as matplotlib sets it: of bodies and forces as it is, of points and lengths as mathematics.

    A body that declares its symbol is called by that, a force that has one too.
    """
    if letter.role == "label" and letter.of in notation.indices:
        return f"${notation.indices[letter.of]}$"
    if letter.role in ("force", "reaction") and letter.text in notation.symbols:
        return f"${mathtext(letter.text, notation)}$"
    if letter.role in ("label", "force", "reaction"):
        return letter.text.replace("$", r"\$")
    return f"${mathtext(letter.text, notation)}$"


# -------- arrows ----------------------------------------------------------------------------------------------
# Arrows of a drawing: forces that end at their point, couples as arcs, loads that are spread along a line.


STEEP = 0.25  # sine of the angle below which two lines run along one another
CLEAR = 0.15  # of an arrow: nearer to a line it is on it; so much of it is at its own place


def arrow(panel: Any, tip: PagePoint, vector: PagePoint, *, color: str, label: str = "", outward: bool = False) -> None:
    """An arrow whose tip is at a place; `outward`: that begins there (velocities, displacements).

    Args:
        vector: direction and length, in the drawing's units.
        label: at its free end.
    """
    (x, y), (dx, dy) = tip, vector
    length = math.hypot(dx, dy)
    if not length:
        return
    begin, end = ((x, y), (x + dx, y + dy)) if outward else ((x - dx, y - dy), (x, y))
    panel.annotate(
        "",
        end,
        xytext=begin,
        zorder=7,
        arrowprops={"arrowstyle": "-|>", "color": color, "linewidth": 1.5, "shrinkA": 0, "shrinkB": 0},
    )
    free = end if outward else begin
    panel.plot(*free, alpha=0)  # so that the axes hold it
    _kept_off(panel, (begin, end))
    if label:
        name_beside(panel, label, free, color)


def is_freer_outward(lines: Iterable[np.ndarray], at: PagePoint, vector: PagePoint) -> bool:
    """True if an arrow that begins at its place meets fewer lines than one that ends there."""
    pieces = [piece for line in lines for piece in pairwise(line)]
    place, stroke = np.array(at), np.array(vector)
    begun, ended = (sum(_meets(a, b, place, s) for a, b in pieces) for s in (stroke, -stroke))
    return begun < ended


def _meets(a: np.ndarray, b: np.ndarray, at: np.ndarray, stroke: np.ndarray) -> bool:
    """True if a stroke from a place runs along the piece a b, or crosses it further on."""
    along, away = b - a, at - a
    turn = along[0] * stroke[1] - along[1] * stroke[0]
    sizes = float(np.hypot(*along) * np.hypot(*stroke))
    if not sizes:
        return False
    if abs(turn) < STEEP * sizes:
        middle = away + stroke / 2
        share = float(np.clip(middle @ along / (along @ along), 0, 1))
        return bool(np.hypot(*(middle - share * along)) < CLEAR * np.hypot(*stroke))
    on_piece = (away[0] * stroke[1] - away[1] * stroke[0]) / turn
    on_stroke = (away[0] * along[1] - away[1] * along[0]) / turn
    return bool(0 <= on_piece <= 1 and CLEAR < on_stroke <= 1)


def moment_arc(panel: Any, sketch: Sketch, at: PagePoint, sense: float, *, color: str, label: str = "") -> None:
    """A couple: three quarters of a circle with an arrow, counter-clockwise for a positive sense."""
    r = 1.9 * sketch.symbol
    turns = np.linspace(-0.25 * math.pi, 1.25 * math.pi, 40)
    turns = turns if sense > 0 else turns[::-1]
    x, y = at[0] + r * np.cos(turns), at[1] + r * np.sin(turns)
    panel.plot(x[:-2], y[:-2], color=color, linewidth=1.5, zorder=7)
    panel.annotate(
        "",
        (x[-1], y[-1]),
        xytext=(x[-4], y[-4]),
        zorder=7,
        arrowprops={"arrowstyle": "-|>", "color": color, "linewidth": 1.5, "shrinkA": 0, "shrinkB": 0},
    )
    _kept_off(panel, np.column_stack([x, y]))
    if label:
        name_beside(panel, label, (at[0], at[1] + r), color)


def distributed(
    panel: Any,
    ends: tuple[PagePoint, PagePoint],
    vectors: tuple[PagePoint, PagePoint],
    *,
    color: str = LOAD,
    label: str = "",
) -> None:
    """A load along a line: arrows whose tips are on it, their tails joined.

    Args:
        ends: of the line.
        vectors: of the load there, in the drawing's units.
    """
    (a, b), (p, q) = (np.array(ends), np.array(vectors))
    highest = max(float(np.linalg.norm(p)), float(np.linalg.norm(q)))
    count = 3 + int(min(8.0, 3 * float(np.linalg.norm(b - a)) / (highest or 1.0)))
    tails = []
    for share in np.linspace(0, 1, count):
        tip, vector = a + share * (b - a), p + share * (q - p)
        tails.append(tip - vector)
        arrow(panel, (tip[0], tip[1]), (vector[0], vector[1]), color=color)
    panel.plot(*np.array(tails).T, color=color, linewidth=1.2, zorder=6)
    _kept_off(panel, tails)
    if label:
        x, y = np.mean(tails, axis=0)
        name_beside(panel, label, (float(x), float(y)), color)
