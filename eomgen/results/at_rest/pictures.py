"""Pictures of structures: loads, reactions, diagrams of N, V and M, influence lines."""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping, Sequence
from functools import cached_property
from typing import Any

import numpy as np

from eomgen.documents import (
    ARROW,
    INK,
    LOAD,
    REACTION,
    PagePoint,
    Picture,
    PlacedName,
    Scale,
    Sketch,
    arrow,
    distributed,
    draw_model,
    four_figures,
    is_freer_outward,
    moment_arc,
    name_along,
    scale_of,
)
from eomgen.errors import RunFailed
from eomgen.frozen import dataclass
from eomgen.mechanics.free_bodies import Axes, Component, Effect
from eomgen.mechanics.statics import (
    KINDS,
    Extreme,
    InfluenceLine,
    SectionForces,
    SectionPiece,
    StaticReactions,
)
from eomgen.model import Couple, Model, PointForce, SpreadLoad
from eomgen.results.at_rest.section_steps import Sections
from eomgen.symbolic.expression import Node, Scalar, Vector
from eomgen.symbolic.numeric import FLOAT, evaluate, tolerances
from eomgen.symbolic.print import to_text

# -------- picture ---------------------------------------------------------------------------------------------
# StaticReactions -> a picture: the structure with its loads and its reactions; forces of truss members next to them.


TENSION, COMPRESSION = "#2457a6", "#b03a2e"
SHORTEST = 0.45  # of the longest arrow
WIDTH = 9.0  # of the picture [inches]
COLUMN, DIAGRAM = 3.4, 1.5  # width and height of a diagram [inches]
MOST_COLUMNS = 8  # bodies with diagrams
LONGEST_LABEL = 24  # characters of a formula next to an arrow


@dataclass(frozen=True)
class StaticScene:
    """Content of a picture of a structure.

    Args:
        statics: the structure with its reactions.
        known: all parameters have values; else those without are drawn as 1, and formulas stand for numbers.
    """

    statics: StaticReactions
    known: bool

    @cached_property
    def sketch(self) -> Sketch:
        system, at = self.statics.system, self.statics.structure.at
        values = system.scope.model.exact_parameters()
        numbers = {node: float(values.get(name, 1)) for name, node in system.symbols.parameters.items()}
        numbers |= {p: 1.0 for p in system.symbols.unknowns.values()}
        plain = Sketch(system, numbers)
        found = dict(zip(at, plain.numbers(at.values()), strict=True))
        unknowns = self.statics.balance.unknowns
        found |= dict(zip(unknowns, plain.numbers(unknowns.values()), strict=True))
        return Sketch(system, {**numbers, **found})

    @cached_property
    def forces(self) -> list[tuple[PagePoint, PagePoint, str, str]]:
        """(tip, force, colour, label) of every single force, loads first."""
        return [*self._loads(), *self._reactions()]

    @cached_property
    def scale(self) -> Scale:
        """Scale of all forces and couples, of the loads and the reactions."""
        loads = [acting.load for acting in self.statics.loads]
        sizes = [math.hypot(*self._vector(load.force, load.axes)) for load in loads if isinstance(load, PointForce)]
        values = self.sketch.numbers(each.value for each in self.statics.reactions if each.value is not None)
        return scale_of([*sizes, *values])

    @cached_property
    def lines(self) -> list[np.ndarray]:
        """Lines of bodies and of members of trusses."""
        system = self.statics.system
        bodies = [line for link in system.motion.links for line in self.sketch.lines(link)]
        ends = [pair for _, _, pair in system.scope.model.truss_members]
        return [*bodies, *(np.array([self.sketch.position((node, Vector.ZERO)) for node in pair]) for pair in ends)]

    def length(self, force: PagePoint) -> PagePoint:
        """An arrow for a force: longer for a larger one, never very short."""
        size = math.hypot(*force)
        share = SHORTEST + (1 - SHORTEST) * size / self.largest
        scale = ARROW * self.sketch.extent * share / size
        return force[0] * scale, force[1] * scale

    @cached_property
    def largest(self) -> float:
        return max((math.hypot(*force) for _, force, _, _ in self.forces), default=0.0) or 1.0

    def _loads(self) -> Iterable[tuple[PagePoint, PagePoint, str, str]]:
        for acting in self.statics.loads:
            load = acting.load
            if isinstance(load, PointForce) and load.place[0] is not None:
                x, y = self._vector(load.force, load.axes)
                yield self.sketch.position(load.place), (x, y), LOAD, self._named(acting.name, math.hypot(x, y), "N")

    def _named(self, load: str, size: float, unit: str) -> str:
        """A load by its name, with its size."""
        return f"{load} = {self.scale.text(size, unit)}" if self.known else load

    def _vector(self, vector: Any, axes: str | None) -> PagePoint:
        numbers = np.array(self.sketch.numbers(vector[:2]))
        if axes is not None:
            R = self.statics.system.motion.link(axes).pose.R
            numbers = np.array([self.sketch.numbers(row[:2]) for row in R[:2]]) @ numbers
        return float(numbers[0]), float(numbers[1])

    def _reactions(self) -> Iterable[tuple[PagePoint, PagePoint, str, str]]:
        for component, value, label in self._outer():
            (effect,) = component.effects
            x, y = self.sketch.numbers(effect.force[:2])
            if math.hypot(x, y):
                yield self.place(effect), (x * value, y * value), REACTION, label

    def couples(self) -> Iterable[tuple[PagePoint, float, str, str]]:
        """(place, sense, colour, label) of every couple."""
        for acting in self.statics.loads:
            load = acting.load
            if isinstance(load, Couple):
                (size,) = self.sketch.numbers(load.couple[2:])
                at = self._middle(load.body) if load.place is None else self.sketch.position(load.place)
                yield at, size, LOAD, self._named(acting.name, abs(size), "N m")
        for component, value, label in self._outer():
            (effect,) = component.effects
            (couple,) = self.sketch.numbers(effect.couple[2:])
            if couple:
                yield self._seat(component), couple * value, REACTION, label

    def spreads(self) -> Iterable[tuple[SpreadLoad, str]]:
        """Line loads with their names and sizes."""
        for acting in self.statics.loads:
            if isinstance(acting.load, SpreadLoad):
                yield acting.load, self._spread_label(acting.load, acting.name)

    def _spread_label(self, load: SpreadLoad, name: str) -> str:
        """Its name, with its size: at both ends where it changes."""
        sizes = [math.hypot(*self.sketch.numbers(q[:2])) for q in (load.at_start, load.at_end)]
        texts = list(dict.fromkeys(self.scale.number(size) for size in sizes))
        return f"{name} = {' to '.join(texts)} {self.scale.unit('N/m')}" if self.known else name

    def _outer(self) -> Iterable[tuple[Component, float, str]]:
        """(component, value, label) of the determinate reactions of the ground."""
        for j, component in enumerate(self.statics.structure.components):
            if len(component.effects) != 1 or not self.statics.balance.solution.determined(j):
                continue
            reaction = self.statics.by_name.get(component.name)
            value = None if reaction is None else reaction.value
            unit = "N m" if component.label.startswith("couple") else "N"
            yield component, *self._shown(self.statics.balance.value(j) if value is None else value, unit)

    def _shown(self, value: Scalar, unit: str) -> tuple[float, str]:
        """(a value in the sense in which its label is positive, the label): a number, or a short formula."""
        (number,) = self.sketch.numbers((value,))
        if self.known:
            return number, self.scale.text(abs(number), unit)
        text = to_text(value)
        turned = text.startswith("-") and not any(sign in text[1:] for sign in (" + ", " - "))
        return math.copysign(number, -1 if turned else 1), self.label(value).removeprefix("-" if turned else "")

    def label(self, value: Scalar) -> str:
        """A value: a number without its unit, or a short formula where parameters have no values."""
        text = self.scale.number(self.sketch.numbers((value,))[0]) if self.known else to_text(value)
        return text if len(text) <= LONGEST_LABEL else ""

    def place(self, effect: Effect) -> PagePoint:
        """Place on the page where a reaction acts."""
        axes = Axes(self.statics.system.motion)
        link = axes.motion.links[effect.link]
        x, y = self.sketch.place(link.pose.point(axes.masses[effect.link].com))
        dx, dy = self.sketch.numbers(effect.arm[:2])
        return x + dx, y + dy

    def _seat(self, couple: Component) -> PagePoint:
        """Place of a drawn couple: at the forces of its constraint or joint, else in the middle of the body."""
        for other in self.statics.structure.components:
            if other.owner == couple.owner and other.label != couple.label and len(other.effects) == 1:
                return self.place(other.effects[0])
        return self._middle(self.statics.system.motion.links[couple.effects[0].link].name)

    def _middle(self, body: str) -> PagePoint:
        places = [
            self.sketch.position((body, r))
            for name, r in self.statics.system.motion.points[body].items()
            if name not in ("origin", "center")
        ]
        found = np.mean(places or [self.sketch.position((body, Vector.ZERO))], axis=0)
        return float(found[0]), float(found[1])


def statics_picture(found: StaticReactions, sections: Sections, influence: InfluenceLine | None) -> Picture:
    """The structure with loads and reactions; below it N, V and M of its beams, and an influence line.

    Raises:
        RunFailed: it is in space.
    """
    model = found.system.scope.model
    if model.space != "plane":
        raise RunFailed("structures in space are not drawn", fix="leave out --plot")
    missing = missing_values(model)
    scene = StaticScene(found, not missing)
    bodies = list(sections.found.values())[:MOST_COLUMNS] if not missing else []
    line = influence if not missing else None
    heights = [height_of(scene), *([DIAGRAM] * (3 if bodies else 0)), *([1.5 * DIAGRAM] if line else [])]

    def fill(figure: Any) -> None:
        grid = figure.add_gridspec(len(heights), max(1, len(bodies)), height_ratios=heights)
        draw_structure(figure.add_subplot(grid[0, :]), scene)
        for column, forces in enumerate(bodies):
            diagram_panels(
                [figure.add_subplot(grid[1 + k, column]) for k in range(3)], forces, scene.sketch.values, scene.scale
            )
        if line is not None:
            influence_panel(figure.add_subplot(grid[-1, :]), line, scene.sketch.values)
        if missing:
            figure.supxlabel(f"drawn with {', '.join(missing)} = 1; no diagrams without values", fontsize=9)

    return Picture((max(WIDTH, COLUMN * len(bodies)), sum(heights)), fill, model.name)


def height_of(scene: StaticScene) -> float:
    """Height of the picture, by the proportions of the structure [inches]."""
    places = np.array([*scene.sketch.points.values(), *(tip for tip, _, _, _ in scene.forces)])
    wide, tall = np.ptp(places, axis=0) + 0.35 * scene.sketch.extent if len(places) else (1.0, 1.0)
    return float(np.clip(WIDTH * tall / wide, 3.2, 8.0))


def missing_values(model: Model) -> list[str]:
    """The parameters without a value."""
    values = model.exact_parameters()
    return [name for name in model.parameters if name not in values]


def draw_structure(panel: Any, scene: StaticScene) -> None:
    """Bodies, supports, loads in red, reactions in green, member forces in blue (tension) and red (compression)."""
    sketch = scene.sketch
    draw_model(panel, sketch)
    for load, name in scene.spreads():
        _spread(panel, scene, load, name)
    for tip, force, color, label in scene.forces:
        if math.hypot(*force) > tolerances.COMPUTED * scene.largest:
            vector = scene.length(force)
            arrow(panel, tip, vector, color=color, label=label, outward=is_freer_outward(scene.lines, tip, vector))
    for at, sense, color, label in scene.couples():
        if sense:
            moment_arc(panel, sketch, at, sense, color=color, label=label)
    _members(panel, scene)


def _spread(panel: Any, scene: StaticScene, load: SpreadLoad, name: str) -> None:
    """A line load, its largest arrow half as long as the longest of a force."""
    ends = np.array([scene.sketch.numbers(q[:2]) for q in (load.at_start, load.at_end)])
    highest = float(np.max(np.linalg.norm(ends, axis=1)))
    if not highest:
        return
    (a, b), (c, d) = ends * (0.5 * ARROW * scene.sketch.extent / highest)
    places = scene.sketch.position(load.start), scene.sketch.position(load.end)
    distributed(panel, places, ((float(a), float(b)), (float(c), float(d))), label=name)


def _members(panel: Any, scene: StaticScene) -> None:
    """The force of every member of a truss, along it, and the meaning of the colours."""
    drawn = False
    for truss, member, (first, second) in scene.statics.system.scope.model.truss_members:
        reaction = scene.statics.by_name.get(f"tension({truss}, {member})")
        if reaction is None or reaction.value is None:
            continue
        (value,) = scene.sketch.numbers((reaction.value,))
        a, b = (np.array(scene.sketch.position((node, Vector.ZERO))) for node in (first, second))
        small = abs(value) < tolerances.COMPUTED * scene.largest
        color = "#808080" if small else TENSION if value > 0 else COMPRESSION
        name_along(panel, "0" if small else scene.label(reaction.value), (a, b), color)
        panel.plot(*np.array([a, b]).T, color=color, linewidth=1.8, zorder=2)
        drawn = True
    if drawn:
        unit = f" [{scene.scale.unit('N')}]" if scene.known else ""
        panel.set_title(f"members{unit}: tension blue, compression red", fontsize=9, loc="right", color="#505050")


# -------- diagrams --------------------------------------------------------------------------------------------
# SectionForces, InfluenceLine -> panels of a picture: N, V and M over the axis of a body, X over the way of a load.


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
    return bool(np.ptp(heights) < tolerances.COMPUTED * max(1.0, np.abs(heights).max())) and all(
        b >= a for a, b in starts
    )


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
    from eomgen.documents import NamesArtist

    points = list(points)
    largest = max((abs(y) for _, y in points), default=0.0)
    width = max((abs(x) for x, _ in points), default=1.0) or 1.0
    shown: list[tuple[float, ...]] = []
    for x, y in sorted(points, key=lambda point: -abs(point[1])):  # the largest choose their places first
        twin = any(
            abs(x - a) < tolerances.SAME_PLACE * width and abs(y - b) <= tolerances.COMPUTED * largest for a, b in shown
        )
        if abs(y) > tolerances.COMPUTED * largest and not twin:
            shown.append((x, y))
    names = [PlacedName(four_figures(y), (x, y), INK, 8.0, rank) for rank, (x, y) in enumerate(shown)]
    panel.add_artist(NamesArtist(names, [np.column_stack(line.get_data()) for line in panel.lines[1:]]))
    panel.margins(x=0.03, y=0.22)
    if not largest:
        panel.set_yticks([0])


def _numbers(scalars: Sequence[Scalar], values: Mapping[Node, float]) -> list[float]:
    return [float(x) for x in evaluate(tuple(scalars), values, FLOAT)]
