"""Names of a picture as one matplotlib artist, which finds room for them when it is drawn."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
from matplotlib.artist import Artist
from matplotlib.text import Text

from eomgen.documents.figures import halo
from eomgen.documents.letters import STEP, PageBox, PlacedName, dots_along, room_for


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
        self.boxes: list[tuple[str, PageBox]] = []
        """(text, box in dots) of every name as it was drawn last."""

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
        inside = PageBox(window.x0, window.y0, window.x1, window.y1)
        self.boxes = []
        for name in self.names:
            text = Text(0, 0, name.text, color=name.color, fontsize=name.size, path_effects=halo())
            text.set_figure(figure)
            size = text.get_window_extent(renderer)
            x, y = page(name.at)
            box = room_for((x, y), (size.width, size.height), [b for _, b in self.boxes], dots, inside, point)
            if box is not None:
                self.boxes.append((name.text, box))
                text.set_position((box.left - size.x0, box.bottom - size.y0))
                text.draw(renderer)
