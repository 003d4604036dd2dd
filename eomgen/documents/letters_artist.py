"""Names of a picture as one matplotlib artist, which finds room for them when it is drawn."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Any

import numpy as np
from matplotlib.artist import Artist
from matplotlib.text import Text

from eomgen.documents.figures import halo
from eomgen.documents.letters import STEP, PageBox, PlacedName, dots_along, place_along, room_for


class NamesArtist(Artist):
    """The names of one panel.

    Args:
        names: each is drawn once.
        lines: what they should not cover, k x 2 each, data coordinates; nan breaks.
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
        taken = self._others(renderer)
        for name in self.names:
            text = Text(0, 0, name.text, color=name.color, fontsize=name.size, path_effects=halo())
            text.set_figure(figure)
            size = text.get_window_extent(renderer)
            (x, y), wide = page(name.at), (size.width, size.height)
            if name.along is not None:
                found = self._along(text, page(np.array([name.at, name.along])), wide, taken, point)
                self.areas.append((name.text, found))
                taken += found
                text.draw(renderer)
            elif (box := room_for((x, y), wide, taken, dots, inside, point)) is not None:
                self.areas.append((name.text, (box,)))
                taken.append(box)
                text.set_position((box.left - size.x0, box.bottom - size.y0))
                text.draw(renderer)

    def _others(self, renderer: Any) -> list[PageBox]:
        """The boxes of what else is written on the panel."""
        texts = [text for text in self.axes.texts if text.get_visible() and text.get_text()] if self.axes else []
        return [PageBox(*text.get_window_extent(renderer).extents) for text in texts]

    @staticmethod
    def _along(
        text: Text, ends: np.ndarray, size: tuple[float, float], taken: list[PageBox], point: float
    ) -> tuple[PageBox, ...]:
        """A text turned along a line, readable from below or from the right, and its boxes."""
        a, b = ends if ends[1, 0] - ends[0, 0] > -0.5 * point else ends[::-1]
        share, away, boxes = place_along(a, b, size, taken, point)
        e = (b - a) / (float(np.hypot(*(b - a))) or 1.0)
        text.set_position(tuple(a + share * (b - a) + away * np.array([-e[1], e[0]])))
        text.set(ha="center", va="center", rotation=math.degrees(math.atan2(e[1], e[0])), rotation_mode="anchor")
        return tuple(boxes)
