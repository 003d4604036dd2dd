"""Pictures of structures: loads, reactions, diagrams of N, V and M, influence lines."""

from __future__ import annotations

import math
import re
from collections.abc import Iterable, Mapping, Sequence
from functools import cached_property
from itertools import pairwise
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
    name_beside,
    notation_of,
    own_symbol,
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
from eomgen.results.at_rest.steps import letter_of_reaction
from eomgen.symbolic.expression import Node, Scalar, Vector
from eomgen.symbolic.numeric import FLOAT, evaluate, tolerances
from eomgen.symbolic.print import Setter, text_size, to_text

# -------- picture ---------------------------------------------------------------------------------------------
# StaticReactions -> a picture: the structure with its loads and its reactions; forces of truss members next to them.


TENSION, COMPRESSION = "#2457a6", "#b03a2e"
SHORTEST = 0.45  # of the longest arrow
WIDTH = 9.0  # of the picture [inches]
COLUMN, DIAGRAM = 3.4, 1.5  # width and height of a diagram [inches]
MOST_COLUMNS = 8  # bodies with diagrams
LOWEST = 2.4  # height of the structure [inches]
TITLE_ROOM = 0.4  # above the structure [inches]
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
        return Sketch(system, {**numbers, **found}, dimensions=True)

    @property
    def written(self) -> Setter | None:
        """Typesetting of formulas that stand for numbers; None where numbers are known."""
        return None if self.known else Setter(notation_of(self.statics.system.scope.model))

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
            number, text = self._shown(self.statics.balance.value(j) if value is None else value, unit)
            zero = abs(number) <= tolerances.COMPUTED * self.largest_value
            yield component, number, f"{self._letter(component)} = {'0' if zero else text}" if text else ""

    @cached_property
    def largest_value(self) -> float:
        """Size of the largest load and reaction."""
        loads = [acting.load for acting in self.statics.loads]
        sizes = [math.hypot(*self._vector(load.force, load.axes)) for load in loads if isinstance(load, PointForce)]
        values = self.sketch.numbers(each.value for each in self.statics.reactions if each.value is not None)
        return max(map(abs, [*sizes, *values]), default=0.0)

    def _letter(self, component: Component) -> str:
        """The letter of a reaction, typeset."""
        named = next((r.named for r in self.statics.reactions if r.name == component.name), None)
        own = None if named is None else own_symbol(self.statics.balance.balance, named)
        notation = notation_of(self.statics.system.scope.model)
        return f"${notation.latex(letter_of_reaction(component.name)) if own is None else own.tex}$"

    def _shown(self, value: Scalar, unit: str) -> tuple[float, str]:
        """(a value in the sense in which its label is positive, the label): a number, or a short formula."""
        (number,) = self.sketch.numbers((value,))
        if self.known:
            return number, self.scale.text(abs(number), unit)
        text, written = to_text(value), self.written
        turned = text.startswith("-") and not any(sign in text[1:] for sign in (" + ", " - "))
        shown = -value if turned else value
        words = "" if written is None or len(text) > LONGEST_LABEL else f"${plain_tex(written, shown)}$"
        return math.copysign(number, -1 if turned else 1), words

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

    Beams that lie in a row have their diagrams exactly below them. Without values all is drawn for a stated ratio, and
    formulas stand for numbers.

    Raises:
        RunFailed: it is in space.
    """
    model = found.system.scope.model
    if model.space != "plane":
        raise RunFailed("structures in space are not drawn", fix="leave out --plot")
    missing = missing_values(model)
    scene = StaticScene(found, not missing)
    bodies = list(sections.found.values())[:MOST_COLUMNS]
    line = influence if not missing else None
    heights = [height_of(scene), *([DIAGRAM] * (3 if bodies else 0)), *([1.5 * DIAGRAM] if line else [])]
    words = f"drawn with {', '.join(missing)} = 1" if missing else ""
    spans = spans_in_a_row(scene, bodies) if line is None else []
    width = max(WIDTH, COLUMN * len(bodies)) if not spans else WIDTH

    def fill(figure: Any) -> None:
        if spans:
            _in_one_column(figure, scene, list(zip(bodies, spans, strict=True)), heights)
        else:
            _in_a_grid(figure, scene, bodies, line, heights)
        if words:
            figure.text(0.99, 0.99, words, fontsize=9, ha="right", va="top", color="#505050")

    return Picture((width, sum(heights) + (ROOM if spans else 0.0)), fill, model.name)


def _in_a_grid(
    figure: Any, scene: StaticScene, bodies: Sequence[SectionForces], line: InfluenceLine | None, heights: list[float]
) -> None:
    """The structure above, a column of diagrams for each body, the influence line below."""
    grid = figure.add_gridspec(len(heights), max(1, len(bodies)), height_ratios=heights)
    draw_structure(figure.add_subplot(grid[0, :]), scene)
    for column, forces in enumerate(bodies):
        panels = [figure.add_subplot(grid[1 + k, column]) for k in range(3)]
        diagram_panels(panels, forces, scene.sketch.values, scene.scale, scene.written)
    if line is not None:
        influence_panel(figure.add_subplot(grid[-1, :]), line, scene.sketch.values)


def _filling(panel: Any, shape: float) -> tuple[float, float]:
    """Ends in x of a panel that holds all that is drawn, at equal scales.

    Args:
        shape: width over height of the panel.
    """
    (low, high), (bottom, top) = panel.get_xlim(), panel.get_ylim()
    places = np.vstack(
        [line.get_xydata() for line in panel.lines] + [patch.get_path().vertices for patch in panel.patches]
    )
    places = places[np.isfinite(places).all(axis=1)]
    drawn = (float(places[:, 1].min()), float(places[:, 1].max())) if len(places) else (bottom, top)
    tall = max((high - low) / shape, 1.35 * (drawn[1] - drawn[0]))
    wide, middle, level = tall * shape, 0.5 * (low + high), 0.5 * (drawn[0] + drawn[1])
    panel.set(xlim=(middle - 0.5 * wide, middle + 0.5 * wide), ylim=(level - 0.5 * tall, level + 0.5 * tall))
    return middle - 0.5 * wide, middle + 0.5 * wide


# -- in one column ---------------------------------------------------------------------------------


LEFT, RIGHT, ROOM, GAP = 0.95, 0.25, 0.85, 0.12  # margins; for the title and the lowest axis; between panels [inches]


def spans_in_a_row(scene: StaticScene, bodies: Sequence[SectionForces]) -> list[tuple[float, float]]:
    """Ends of the beams where all are straight, level and side by side, from left to right; else none."""
    found = []
    for forces in bodies:
        (leg, *more) = forces.axis.legs
        ends = (leg.start, leg.start + leg.length * leg.along)
        (x, y), (u, v) = (scene.sketch.position((forces.axis.body, end)) for end in ends)
        if more or u <= x or abs(v - y) > tolerances.SAME_PLACE * (u - x):
            return []
        found.append((x, u))
    near = tolerances.SAME_PLACE * scene.sketch.extent
    apart = all(a[1] <= b[0] + near for a, b in pairwise(sorted(found)))
    return found if apart else []


def _in_one_column(
    figure: Any,
    scene: StaticScene,
    beams: Sequence[tuple[SectionForces, tuple[float, float]]],
    heights: Sequence[float],
) -> None:
    """The structure, and below each of its beams N, V and M over the same x."""
    figure.set_layout_engine("none")  # every panel has its place
    width, height = figure.get_size_inches()
    wide = (width - LEFT - RIGHT) / width
    top = height - TITLE_ROOM - heights[0]
    main = figure.add_axes((LEFT / width, top / height, wide, heights[0] / height))
    draw_structure(main, scene)
    main.autoscale_view()
    main.set_aspect("equal", adjustable="datalim")
    low, high = _filling(main, wide * width / heights[0])
    rows: list[list[Any]] = [[], [], []]
    for number, (forces, (x, u)) in enumerate(sorted(beams, key=lambda beam: beam[1])):
        left, across = LEFT / width + wide * (x - low) / (high - low), wide * (u - x) / (high - low)
        tall = (DIAGRAM - GAP) / height
        panels = [figure.add_axes((left, (top - DIAGRAM * (k + 1)) / height, across, tall)) for k in range(3)]
        diagram_panels(panels, forces, scene.sketch.values, scene.scale, scene.written)
        length = _numbers((forces.pieces[0].start, forces.pieces[-1].end), scene.sketch.values)
        for k, panel in enumerate(panels):
            panel.set_xlim(*length)
            panel.tick_params(labelbottom=k == 2, labelleft=number == 0)
            panel.yaxis.label.set_visible(number == 0)
            if number and scene.known:
                panel.xaxis.get_major_locator().set_params(prune="lower")
            rows[k].append(panel)
        if len(beams) > 1:
            panels[0].set_title(forces.axis.body.replace("$", r"\$"), fontsize=8, pad=2)
    for row in rows:
        ends = np.array([panel.get_ylim() for panel in row])
        turned = bool(row[0].yaxis_inverted())
        reach = float(ends.min()), float(ends.max())
        for panel in row:
            panel.set_ylim(*(reach[::-1] if turned else reach))


def height_of(scene: StaticScene) -> float:
    """Height of the picture, by the proportions of the structure [inches]."""
    places = np.array([*scene.sketch.points.values(), *(tip for tip, _, _, _ in scene.forces)])
    wide, tall = np.ptp(places, axis=0) + 0.35 * scene.sketch.extent if len(places) else (1.0, 1.0)
    return float(np.clip(WIDTH * tall / wide, LOWEST, 8.0))


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
        elif label and color == REACTION:
            name_beside(panel, label, tip, color)
    for at, sense, color, label in scene.couples():
        if abs(sense) > tolerances.COMPUTED * scene.largest_value:
            moment_arc(panel, sketch, at, sense, color=color, label=label)
        elif label and color == REACTION:
            name_beside(panel, label, at, color)
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
    panels: Sequence[Any],
    forces: SectionForces,
    values: Mapping[Node, float],
    scale: Scale = SI,
    written: Setter | None = None,
) -> None:
    """N, V and M along one body, one panel each; M is drawn on the side of the stretched fibre: downward.

    Args:
        panels: three matplotlib axes.
        values: of the parameters.
        scale: of the forces and couples.
        written: typesetting of the formulas that stand for numbers; None: numbers stand there.
    """
    stations = [forces.pieces[0].start, *(piece.end for piece in forces.pieces)]
    places = _numbers(stations, values)
    for panel, kind in zip(panels, KINDS, strict=True):
        curves = [_curve(piece, kind, values, scale) for piece in forces.pieces]
        _filled(panel, curves, COLORS[kind])
        upright = panel.get_xaxis_transform()
        panel.vlines(places, 0, 1, transform=upright, color="#b0b0b0", linewidth=0.6, linestyle=":", zorder=0.5)
        if kind == "bending_moment":
            panel.invert_yaxis()
        if written is None:
            ends = [(x[k], y[k]) for x, y in curves for k in (0, -1)]
            extremes = [_extreme(e, values, scale) for e in forces.extremes] if kind == "bending_moment" else []
            _labels(panel, [*ends, *extremes])
            panel.set_ylabel(f"{NAMES[kind]} of {forces.axis.body} [{scale.unit(UNITS[kind])}]")
        else:
            _labels(panel, _formulas(forces, kind, values, written))
            panel.set(ylabel=f"{NAMES[kind]}, {forces.axis.body}", yticks=[0])
            panel.set_xticks(places, [_formula(written, forces, x) for x in stations])
    panels[-1].set_xlabel("x [m]" if written is None else "x")


def _formulas(
    forces: SectionForces, kind: str, values: Mapping[Node, float], written: Setter
) -> list[tuple[float, float, str]]:
    """(x, value, formula) at the ends of the pieces, and of the extremes of M."""
    found = [(x, piece.value(kind, x)) for piece in forces.pieces for x in (piece.start, piece.end)]
    found += [(extreme.x, extreme.M) for extreme in forces.extremes] if kind == "bending_moment" else []
    numbers = _numbers([x for pair in found for x in pair], values)
    pairs = zip(numbers[::2], numbers[1::2], found, strict=True)
    return [(x, y, _formula(written, forces, value)) for x, y, (_, value) in pairs]


def _formula(written: Setter, forces: SectionForces, value: Scalar) -> str:
    """A formula between dollars; "" of a long one."""
    short = forces.sizes.shortest(value)
    if text_size(short) > LONGEST_LABEL:
        return ""
    return f"${plain_tex(written, short)}$"


def plain_tex(written: Setter, x: Scalar) -> str:
    """A formula as matplotlib sets it, which knows one kind of fraction."""
    return re.sub(r"\\[td]frac", r"\\frac", written.set(x).tex)


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


def _labels(panel: Any, points: Iterable[tuple[Any, ...]]) -> None:
    """The values, each once at a place; zeros left out.

    Args:
        points: (x, y), and the words for y where it is not written as a number.
    """
    from eomgen.documents import NamesArtist

    points = list(points)
    largest = max((abs(point[1]) for point in points), default=0.0)
    width = max((abs(point[0]) for point in points), default=1.0) or 1.0
    shown: list[tuple[Any, ...]] = []
    for point in sorted(points, key=lambda point: -abs(point[1])):  # the largest choose their places first
        twin = any(
            abs(point[0] - other[0]) < tolerances.SAME_PLACE * width
            and abs(point[1] - other[1]) <= tolerances.COMPUTED * largest
            for other in shown
        )
        if abs(point[1]) > tolerances.COMPUTED * largest and not twin:
            shown.append(point)
    words = [(point, point[2] if len(point) > 2 else four_figures(point[1])) for point in shown]
    names = [PlacedName(text, point[:2], INK, 8.0, rank) for rank, (point, text) in enumerate(words) if text]
    panel.add_artist(NamesArtist(names, [np.column_stack(line.get_data()) for line in panel.lines[1:]]))
    panel.margins(x=0.03, y=0.22)
    if not largest:
        panel.set_yticks([0])


def _numbers(scalars: Sequence[Scalar], values: Mapping[Node, float]) -> list[float]:
    return [float(x) for x in evaluate(tuple(scalars), values, FLOAT)]
