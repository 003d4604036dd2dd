"""KinematicState -> a picture: the mechanism with velocities and centres of rotation, and the diagrams of projections.

In a plane motion v_x of the points of a body changes along y alone, v_y along x alone:

    v_x = - w (y - y_c),   v_y = w (x - x_c)

so that over the lines on which the mechanism is projected each body has a straight piece, which is zero at its centre.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np

from eomgen.documents.arrows import arrow
from eomgen.documents.drawing import ARROW, REACTION, PagePoint, Sketch, draw_model, name_beside
from eomgen.documents.figures import Picture
from eomgen.documents.kinematics.centrode_plot import centrode_panel
from eomgen.errors import MissingValues, RunFailed
from eomgen.mechanics.fields.centrodes import Centrodes
from eomgen.mechanics.instant.kinematic_state import KinematicState
from eomgen.mechanics.instant.mechanism import FIXED, Mechanism
from eomgen.symbolic.expression.derivative import substituted, symbols_of
from eomgen.symbolic.expression.graph import Node, Scalar

SIZE, BELOW = (11.0, 8.0), 4.5  # of the mechanism, and the height of a row of centrodes below it [inches]
MOST_CENTRODES = 6
COLORS = ("#2f5d8a", "#b03a2e", "#2e7d4f", "#8e5ea2", "#c77c11", "#3b8ea5", "#7a5c3e", "#5a5a5a")
CENTER = "#8e44ad"
FAR = 1.6  # how far outside the mechanism a centre is still drawn, of its extent


def mechanism_picture(state: KinematicState, centrodes: Sequence[Centrodes] = ()) -> Picture:
    """A plane mechanism; a rate that was left as a symbol is 1 there.

    Args:
        centrodes: drawn below it, a panel each.
    Raises:
        RunFailed: it is in space.
        MissingValues: parameters without a value.
    """
    if state.mechanism is None:
        raise RunFailed("only plane mechanisms are drawn", mend="ask for the pages of a run: eomgen animate, or play")
    shown = tuple(centrodes[:MOST_CENTRODES])
    size = (SIZE[0], SIZE[1] + BELOW * ((len(shown) + 1) // 2))
    return Picture(size, _Panels(state, state.mechanism, shown).fill, state.system.scope.model.name)


class _Panels:
    """The numbers of a picture, and its panels."""

    def __init__(self, state: KinematicState, mechanism: Mechanism, centrodes: Sequence[Centrodes]) -> None:
        self.state, self.mechanism, self.centrodes = state, mechanism, centrodes
        self.one: Mapping[Node, Scalar] = {} if state.symbol is None else {state.symbol: 1}
        symbols = state.system.symbols
        places = {node: self.number(state.moving.get(node, 0)) for node in (*symbols.q, symbols.t)}
        known = {node: self.number(node) for node in symbols.parameters.values()}
        self.sketch = Sketch(state.system, {**places, **known})
        self.points = [(names, self.numbers(r), self.numbers(v)) for names, r, v, _ in state.points]

    def number(self, x: Scalar) -> float:
        """A scalar as a number, the rate that was left open being 1."""
        found = self.state.number(substituted((x,), self.one)[0])
        if found is None:
            parameters = self.state.system.symbols.parameters
            known = self.state.number
            raise MissingValues(tuple(n for n, p in parameters.items() if p in symbols_of((x,)) and known(p) is None))
        return found

    def numbers(self, v: Sequence[Scalar]) -> PagePoint:
        return self.number(v[0]), self.number(v[1])

    # -- panels --------------------------------------------------------------------------------------

    def fill(self, figure: Any) -> None:
        rooms, ratios = [["mechanism", "x"], ["y", "words"]], (2.2, 1)
        if self.centrodes:
            figure, below = figure.subfigures(2, 1, height_ratios=(SIZE[1], BELOW * ((len(self.centrodes) + 1) // 2)))
            self._centrodes(below)
        panels = figure.subplot_mosaic(rooms, width_ratios=ratios, height_ratios=ratios)
        main = panels["mechanism"]
        draw_model(main, self.sketch, colors={body: color for color, _, bodies in self._blocks() for body in bodies})
        main.set_adjustable("datalim")  # the projections stand exactly below and beside it
        self._velocities(main)
        far = self._centers(main)
        figure.canvas.draw()
        self._along_x(panels["y"], main.get_xlim())
        self._along_y(panels["x"], main.get_ylim())
        self._words(panels["words"], far)

    def _centrodes(self, figure: Any) -> None:
        """The curves of the centres of rotation, two in a row."""
        system, symbols = self.state.system, self.state.system.symbols
        speeds = {node: self.number(self.state.moving.get(node, 0)) for node in symbols.u}
        panels = list(figure.subplots((len(self.centrodes) + 1) // 2, 2, squeeze=False).flat)
        for panel, centrodes in zip(panels, self.centrodes, strict=False):
            centrode_panel(panel, system, centrodes, {**self.sketch.values, **speeds})
        for panel in panels[len(self.centrodes) :]:
            panel.axis("off")

    def _velocities(self, panel: Any) -> None:
        fastest = max((float(np.hypot(*v)) for _, _, v in self.points), default=0.0)
        scale = ARROW * self.sketch.extent / fastest if fastest else 0.0
        for _, at, (x, y) in self.points:
            arrow(panel, at, (scale * x, scale * y), color=REACTION, outward=True)

    def _centers(self, panel: Any) -> list[str]:
        """Centres in sight as crosses; what is said of the others."""
        places: dict[tuple[float, float], list[str]] = {}
        far = []
        for center in self.mechanism.centers.values():
            x, y = self.numbers(center.point)
            if center.at_infinity:
                far.append(f"{center.name}: at infinity along ({x:.4g}, {y:.4g})")
            elif self._is_far((x, y)):
                far.append(f"{center.name}: ({x:.4g}, {y:.4g})")
            else:
                places.setdefault((round(x, 9), round(y, 9)), []).append(center.name)
        for place, names in places.items():
            panel.plot(*place, marker="x", markersize=8, color=CENTER, zorder=8)
            name_beside(panel, " ".join(names).replace("$", r"\$"), place, CENTER)
        return far

    def _is_far(self, place: PagePoint) -> bool:
        """Whether a place is well outside the mechanism."""
        corners = np.array([at for _, at, _ in self.points])
        low, high = corners.min(axis=0), corners.max(axis=0)
        reach = FAR * self.sketch.extent
        return bool(np.any(np.array(place) < low - reach) or np.any(np.array(place) > high + reach))

    def _along_x(self, panel: Any, limits: tuple[float, float]) -> None:
        """v_y of every body over x; thin to where it is zero."""
        for color, (start, end), slope, offset in self._pieces(axis=0):
            for ends, style in ((_to_zero(start, end, slope, offset, limits), ":"), ((start, end), "-")):
                _line(panel, ends, [slope * x + offset for x in ends], color, style)
        panel.axhline(0, color="#505050", linewidth=0.8)
        panel.set(xlim=limits, xlabel="x [m]", ylabel="$v_y$ [m/s]")

    def _along_y(self, panel: Any, limits: tuple[float, float]) -> None:
        """v_x of every body over y, y upwards; thin to where it is zero."""
        for color, (start, end), slope, offset in self._pieces(axis=1):
            for ends, style in ((_to_zero(start, end, slope, offset, limits), ":"), ((start, end), "-")):
                _line(panel, [slope * y + offset for y in ends], ends, color, style)
        panel.axvline(0, color="#505050", linewidth=0.8)
        panel.set(ylim=limits, ylabel="y [m]", xlabel="$v_x$ [m/s]")

    def _pieces(self, axis: int) -> list[tuple[str, PagePoint, float, float]]:
        """(colour, extent along the axis, slope, value at 0) of the velocity across the axis, of every moving block."""
        found = []
        for color, block, bodies in self._blocks():
            places = [
                at[axis]
                for names, at, _ in self.points
                if any(each.partition(".")[0] in bodies for each in names.split(", "))
            ]
            c = self.mechanism.fields[block]
            w = self.number(c[2])
            line = (-w, self.number(c[1])) if axis else (w, -self.number(c[0]))
            found.append((color, (min(places), max(places)), *line))
        return found

    def _blocks(self) -> list[tuple[str, str, tuple[str, ...]]]:
        """(colour, name, bodies) of what moves."""
        moved = [(name, bodies) for name, bodies in self.mechanism.blocks.items() if name != FIXED]
        return [(COLORS[k % len(COLORS)], name, bodies) for k, (name, bodies) in enumerate(moved)]

    def _words(self, panel: Any, far: list[str]) -> None:
        """The legend, centres out of sight, the unit rate."""
        panel.axis("off")
        for color, name, _ in self._blocks():
            panel.plot([], [], color=color, linewidth=2, label=name.replace("$", r"\$"))
        if self.mechanism.moved:
            panel.legend(loc="upper left", ncols=2, fontsize=9)
        rate = [] if self.state.symbol is None else [f"for {self.state.rate} = 1"]
        lines = [*rate, *(["centres out of sight:", *far] if far else [])]
        panel.text(0.02, 0.05, "\n".join(lines).replace("$", r"\$"), fontsize=8, va="bottom", transform=panel.transAxes)


def _line(panel: Any, x: Sequence[float], y: Sequence[float], color: str, style: str) -> None:
    """The velocities of a body; of one that is a point in this direction, a dot."""
    dot = "o" if style == "-" and x[0] == x[1] and y[0] == y[1] else ""
    panel.plot(x, y, color=color, linestyle=style, linewidth=1.8, marker=dot, markersize=6)


def _to_zero(start: float, end: float, slope: float, offset: float, limits: tuple[float, float]) -> tuple[float, ...]:
    """From a piece to its zero, where that is in sight; () where it is not."""
    zero = -offset / slope if slope else float("inf")
    if not limits[0] <= zero <= limits[1] or start <= zero <= end:
        return ()
    return (zero, start if zero < start else end)
