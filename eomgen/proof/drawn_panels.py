"""A figure as it is saved -> content of its panels: curves, points and names by their data, axes by their words.

The drawn artists of matplotlib are read, not the dots that it makes of them.
"""

from __future__ import annotations

import re
from collections.abc import Iterator
from typing import Any

import numpy as np

from eomgen.frozen import dataclass

_LABEL = re.compile(r"(?P<what>.*?)(?: \[(?P<unit>[^\]]*)\])?")


@dataclass(frozen=True)
class DrawnCurve:
    """A line or marks.

    Args:
        label: in the legend, "" of none.
        color: by which it is known in other panels.
        places: n x 2, in the units of the axes.
    """

    label: str
    color: str
    places: np.ndarray


@dataclass(frozen=True)
class ColouredPoints:
    """Points that show a value by their colour.

    Args:
        places: n x 2.
        values: of each.
        label: of the bar of colours.
    """

    places: np.ndarray
    values: np.ndarray
    label: str


@dataclass(frozen=True)
class DrawnPanel:
    """Content of one panel of a diagram.

    Args:
        title: text above it.
        x, y: texts at its axes.
        scales: of both, "linear" or "log".
        is_turned: whether y grows downward.
        curves: in their order, lines across the whole panel left out.
        points: those that have colours.
        bars: (name, height) of each.
        names: texts next to places: (text, place).
        hidden: whether a curve leaves the panel.
    """

    title: str
    x: str
    y: str
    scales: tuple[str, str]
    is_turned: bool
    curves: tuple[DrawnCurve, ...]
    points: tuple[ColouredPoints, ...]
    bars: tuple[tuple[str, float], ...]
    names: tuple[tuple[str, np.ndarray], ...]
    hidden: bool


def panels_of(figure: Any) -> tuple[DrawnPanel, ...]:
    """Its panels, bars of colours left out."""
    bars = {id(bar.ax) for axes in figure.axes for bar in _bars(axes)}
    return tuple(_panel(axes) for axes in figure.axes if id(axes) not in bars)


def _bars(axes: Any) -> Iterator[Any]:
    return (each.colorbar for each in axes.collections if getattr(each, "colorbar", None) is not None)


def _panel(axes: Any) -> DrawnPanel:
    from matplotlib.colors import to_hex

    curves = tuple(
        DrawnCurve(_named(line.get_label()), to_hex(line.get_color()), np.column_stack(line.get_data()).astype(float))
        for line in axes.get_lines()
        if line.get_visible() and line.get_alpha() != 0 and all(_of_data(line, axes))
    )
    points = tuple(
        ColouredPoints(np.asarray(each.get_offsets()), np.asarray(each.get_array()), each.colorbar.ax.get_ylabel())
        for each in axes.collections
        if getattr(each, "colorbar", None) is not None
    )
    names = tuple((name.text, np.array(name.at)) for artist in axes.artists for name in getattr(artist, "names", ()))
    low, high = np.sort(np.array([axes.get_xlim(), axes.get_ylim()]), axis=1).T
    shown = [*(x.places for x in curves), *(x.places for x in points)]
    hidden = any(np.any(each < low) or np.any(each > high) for each in shown)
    heights = [float(bar.get_height()) for bars in axes.containers for bar in bars]
    return DrawnPanel(
        axes.get_title(),
        axes.get_xlabel(),
        axes.get_ylabel(),
        (axes.get_xscale(), axes.get_yscale()),
        axes.yaxis_inverted(),
        curves,
        points,
        tuple(zip((text.get_text() for text in axes.get_xticklabels()), heights, strict=False)),
        names,
        hidden,
    )


def _of_data(line: Any, axes: Any) -> tuple[bool, bool]:
    found: tuple[bool, bool] = line.get_transform().contains_branch_seperately(axes.transData)
    return found


def _named(label: str) -> str:
    return "" if label.startswith("_") else label


def said_of(label: str) -> tuple[str, str]:
    """Quantity and unit of the text at an axis, "M of beam [kN m]"."""
    found = _LABEL.fullmatch(label)
    assert found is not None
    return found["what"], found["unit"] or ""
