"""Drawing -> matplotlib: the strokes and names of a scene in the plane on a panel, in the colours of their roles."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from typing import Any

import numpy as np

from eomgen.documents.figures import mathtext
from eomgen.documents.letters import PlacedName
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
