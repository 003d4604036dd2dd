"""SectionForces, InfluenceLine -> panels of a picture: N, V and M over the axis of a body, X over the way of a load."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from typing import Any

import numpy as np

from eomgen.documents.figures import Scale, figures
from eomgen.documents.letters import PlacedName
from eomgen.documents.scene_drawing import INK
from eomgen.mechanics.statics.influence import InfluenceLine
from eomgen.mechanics.statics.section_forces import KINDS, Extreme, SectionForces, SectionPiece
from eomgen.symbolic.expression.graph import Node, Scalar
from eomgen.symbolic.numeric.evaluation import FLOAT, evaluate
from eomgen.symbolic.numeric.tolerances import COMPUTED, SAME_PLACE

COLORS = {"axial_force": "#2457a6", "shear_force": "#2e7d4f", "bending_moment": "#b03a2e"}
UNITS = {"axial_force": "N", "shear_force": "N", "bending_moment": "N m"}
NAMES = {"axial_force": "N", "shear_force": "V", "bending_moment": "M"}
FINE = 40  # points of a curve within one piece
SI = Scale()


def diagram_panels(
    panels: Sequence[Any], forces: SectionForces, values: Mapping[Node, float], scale: Scale = SI
) -> None:
    """N, V and M along one body, one panel each; M is drawn on the side of the stretched fibre: downward.

    Args:
        panels: three matplotlib axes.
        values: of the parameters.
        scale: of the forces and couples.
    """
    for panel, kind in zip(panels, KINDS, strict=True):
        curves = [_curve(piece, kind, values, scale) for piece in forces.pieces]
        _filled(panel, curves, COLORS[kind])
        ends = [(x[k], y[k]) for x, y in curves for k in (0, -1)]
        extremes = [_extreme(e, values, scale) for e in forces.extremes] if kind == "bending_moment" else []
        if kind == "bending_moment":
            panel.invert_yaxis()
        _labels(panel, [*ends, *extremes])
        panel.set_ylabel(f"{NAMES[kind]} of {forces.axis.body} [{scale.unit(UNITS[kind])}]")
    panels[-1].set_xlabel("x [m]")


def influence_panel(panel: Any, line: InfluenceLine, values: Mapping[Node, float]) -> None:
    """An influence line over the way of the load: over x where that always grows, else over the length of the way."""
    curves = []
    way = 0.0
    for span in line.spans:
        (x0, y0), (x1, y1) = (_numbers(place[:2], values) for place in (span.start, span.end))
        length = float(np.hypot(x1 - x0, y1 - y0))
        begin = x0 if _is_level(line, values) else way
        curves.append((np.array([begin, begin + length]), np.array(_numbers((span.at_start, span.at_end), values))))
        way += length
    _filled(panel, curves, "#7a4ea3")
    _labels(panel, [(x[k], y[k]) for x, y in curves for k in (0, -1)])
    panel.set_ylabel(line.name)
    panel.set_xlabel("x [m]" if _is_level(line, values) else "way of the load [m]")


def _is_level(line: InfluenceLine, values: Mapping[Node, float]) -> bool:
    heights = [_numbers((span.start[1], span.end[1]), values) for span in line.spans]
    starts = [_numbers((span.start[0], span.end[0]), values) for span in line.spans]
    return bool(np.ptp(heights) < COMPUTED * max(1.0, np.abs(heights).max())) and all(b >= a for a, b in starts)


def _extreme(extreme: Extreme, values: Mapping[Node, float], scale: Scale) -> tuple[float, float]:
    x, M = _numbers((extreme.x, extreme.M), values)
    return x, scale(M)


def _curve(piece: SectionPiece, kind: str, values: Mapping[Node, float], scale: Scale) -> tuple[np.ndarray, np.ndarray]:
    """Points of one piece."""
    start, end = _numbers((piece.start, piece.end), values)
    s = np.linspace(0.0, end - start, FINE)
    coefficients = [scale(c) for c in _numbers(piece.coefficients(kind), values)]
    return start + s, sum(c * s**k for k, c in enumerate(coefficients))  # type: ignore[return-value]


def _filled(panel: Any, curves: Iterable[tuple[np.ndarray, np.ndarray]], color: str) -> None:
    panel.axhline(0, color="#505050", linewidth=1.2)
    for x, y in curves:
        panel.fill_between(x, y, 0, color=color, alpha=0.18, linewidth=0)
        panel.plot(np.concatenate([[x[0]], x, [x[-1]]]), np.concatenate([[0], y, [0]]), color=color, linewidth=1.4)


def _labels(panel: Any, points: Iterable[tuple[float, ...]]) -> None:
    """The values, each once at a place; zeros left out."""
    from eomgen.documents.letters_artist import NamesArtist

    points = list(points)
    largest = max((abs(y) for _, y in points), default=0.0)
    width = max((abs(x) for x, _ in points), default=1.0) or 1.0
    shown: list[tuple[float, ...]] = []
    for x, y in sorted(points, key=lambda point: -abs(point[1])):  # the largest choose their places first
        twin = any(abs(x - a) < SAME_PLACE * width and abs(y - b) <= COMPUTED * largest for a, b in shown)
        if abs(y) > COMPUTED * largest and not twin:
            shown.append((x, y))
    names = [PlacedName(figures(y), (x, y), INK, 8.0, rank) for rank, (x, y) in enumerate(shown)]
    panel.add_artist(NamesArtist(names, [np.column_stack(line.get_data()) for line in panel.lines[1:]]))
    panel.margins(x=0.03, y=0.22)
    if not largest:
        panel.set_yticks([0])


def _numbers(scalars: Sequence[Scalar], values: Mapping[Node, float]) -> list[float]:
    return [float(x) for x in evaluate(tuple(scalars), values, FLOAT)]
