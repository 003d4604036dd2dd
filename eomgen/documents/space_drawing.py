"""Drawing in space -> matplotlib: faces and lines seen from far away, the farthest drawn first."""

from __future__ import annotations

import math
from collections.abc import Mapping
from functools import cache
from typing import Any

import numpy as np

from eomgen.documents.latex_names import Notation
from eomgen.documents.letters import PlacedName
from eomgen.documents.scene_drawing import BODY, FILLS, FINE, INK, LINES, MARGIN, NARROWEST, RANKS, SMALLEST, written
from eomgen.records import dataclass
from eomgen.scene.strokes import Drawing

AZIMUTH, ELEVATION = math.radians(-58), math.radians(22)
ALONG_X = 0.9  # cosine of what is upright to x: more, and y goes to the right
SHADES = 24  # of a colour
PADDED = 12  # corners; where a facet has more they are drawn one by one
LIGHT = np.array([0.35, -0.5, 0.79])
CLEAR = {"inertia": 0.35, "track": 0.12, "hole": 0.2}  # how much of what is behind these hide
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
    clouds = [s.path.reshape(-1, 3) for s in drawing.strokes if s.role != "track" or s.faces]
    cloud = np.vstack([*clouds, drawing.sizes.low[None], drawing.sizes.high[None]])
    page = cloud[np.isfinite(cloud).all(axis=1)] @ view.T[:, :2]
    low, high = page.min(axis=0) - MARGIN * unit, page.max(axis=0) + MARGIN * unit
    size, middle = high - low, 0.5 * (low + high)
    size = np.maximum(size, max(NARROWEST * size.max(), SMALLEST * unit))
    return middle - 0.5 * size, middle + 0.5 * size


class SpacePicture:
    """A scene in space on matplotlib axes; `show` sets it to another of its frames."""

    def __init__(self, panel: Any, drawing: Drawing, colors: Mapping[str, str] | None = None) -> None:
        from matplotlib.collections import PolyCollection

        self.drawing, self.colors, self.view = drawing, colors or {}, sight(drawing.sizes.up)
        panel.set_aspect("equal")
        panel.axis("off")
        self.pieces: Any = PolyCollection([], closed=False, capstyle="round", joinstyle="round", clip_on=False)
        panel.add_collection(self.pieces, autolim=False)
        low, high = page_limits(drawing)
        panel.set_xlim(low[0], high[0])
        panel.set_ylim(low[1], high[1])

    def show(self, frame: int) -> None:
        """Everything at one frame, sorted by its distance."""
        parts: list[_Facets] = []
        for stroke in self.drawing.strokes:
            color, width = LINES[stroke.role]
            if stroke.role in ("body", "inertia") and stroke.of in self.colors:
                color = self.colors[stroke.of]
            found = self._faces(stroke, frame, color) if stroke.faces else self._line(stroke, frame, color, width)
            parts += [found] if found is not None else []
        order = np.argsort(np.concatenate([[], *(part.depth for part in parts)]), kind="stable")
        inks = np.concatenate([np.zeros((0, 9)), *(part.inks for part in parts)])[order]
        self.pieces.set_verts(_sorted_corners([part.corners for part in parts], order), closed=True)
        self.pieces.set_facecolor(inks[:, :4])
        self.pieces.set_edgecolor(inks[:, 4:8])
        self.pieces.set_linewidth(inks[:, 8])

    def _faces(self, stroke: Any, frame: int, color: str) -> _Facets | None:
        corners = stroke.path[frame]
        if not np.isfinite(corners).all():
            return None
        normal = _cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 1])
        flat = ~normal.any(axis=1)
        if corners.shape[1] > 3 and flat.any():
            normal[flat] = _cross(corners[flat, 2] - corners[flat, 1], corners[flat, 3] - corners[flat, 2])
        lengths = np.sqrt(np.einsum("fi,fi->f", normal, normal))[:, None]
        normal = normal / np.where(lengths > 0, lengths, 1.0)
        page = corners @ self.view.T
        light = 0.62 + 0.38 * np.round(SHADES * np.abs(normal @ LIGHT)) / SHADES
        alpha = CLEAR.get(stroke.role, 1.0)
        base = _rgb(FILLS.get(stroke.role, color) if stroke.of not in self.colors else color)
        edge = (*_rgb(color), 0.25 if len(corners) > 12 else 0.8 * max(alpha, 0.4))
        back = -math.inf if stroke.role == "track" else 0.0
        rest = np.broadcast_to([alpha, *edge, 0.4], (len(page), 6))
        return _Facets(
            page[:, :, 2].mean(axis=1) + back, page[:, :, :2], np.column_stack([light[:, None] * base, rest])
        )

    def _line(self, stroke: Any, frame: int, color: str, width: float) -> _Facets | None:
        page = stroke.path[frame] @ self.view.T
        near = math.inf if stroke.role == "axes" else TOWARDS * self.drawing.sizes.extent
        ink = (*_rgb(color), 1.0)
        if stroke.dot:
            turn = np.linspace(0, math.tau, 13)[:-1]
            dot = page[0, :2] + 0.55 * self.drawing.sizes.unit * np.column_stack([np.cos(turn), np.sin(turn)])
            return (
                _Facets(page[:1, 2] + near, dot[None], np.array([[*ink, *ink, 0.5]]))
                if np.isfinite(page).all()
                else None
            )
        thin = FINE if stroke.fine else 3.0 if stroke.role == "body" else width
        joined = np.stack([page[:-1], page[1:]], axis=1)
        joined = joined[np.isfinite(joined).all(axis=(1, 2))]
        inks = np.tile([0.0, 0.0, 0.0, 0.0, *ink, thin], (len(joined), 1))
        return _Facets(joined[:, :, 2].mean(axis=1) + near, joined[:, :, :2], inks)

    def names(self, frame: int, notation: Notation) -> list[PlacedName]:
        """The names beside their places on the page, as a notation has them."""
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
        """What names should not cover."""
        paths = [s.path[frame].reshape(-1, 3) @ self.view.T[:, :2] for s in self.drawing.strokes if not s.faces]
        return paths


def _cross(a: np.ndarray, b: np.ndarray) -> np.ndarray:
    """a x b of rows; numpy's own takes three times as long for as few."""
    (ax, ay, az), (bx, by, bz) = a.T, b.T
    found: np.ndarray = np.stack([ay * bz - az * by, az * bx - ax * bz, ax * by - ay * bx], axis=1)
    return found


@cache
def _rgb(color: str) -> np.ndarray:
    from matplotlib.colors import to_rgb

    return np.array(to_rgb(color))


def draw_space(panel: Any, drawing: Drawing, notation: Notation) -> SpacePicture:
    """A scene in space at its first frame, on matplotlib axes with equal scales and no frame.

    Args:
        notation: how the names of the model are set.
    """
    from eomgen.documents.letters_artist import NamesArtist

    picture = SpacePicture(panel, drawing)
    picture.show(0)
    panel.add_artist(NamesArtist(tuple(picture.names(0, notation)), picture.lines(0)))
    return picture
