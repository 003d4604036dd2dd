"""Pictures of structures: loads, reactions, diagrams of N, V and M, influence lines; in the plane and in space."""

from __future__ import annotations

import math
import re
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import replace
from functools import cached_property
from itertools import pairwise
from typing import Any

import numpy as np

from eomgen.documents import (
    Picture,
    Scale,
    Sketch,
    add_names,
    four_figures,
    notation_of,
    own_symbol,
)
from eomgen.frozen import dataclass
from eomgen.mechanics.free_bodies import Axes, Component, Effect
from eomgen.mechanics.statics import InfluenceLine, SectionForces, StaticReactions
from eomgen.model import Couple, Model, PointForce, SpreadLoad
from eomgen.proof import Check, DrawnPanel, ReportedPush, structure_pictured
from eomgen.results.at_rest.section_steps import LETTERS, Sections, sections_in_space
from eomgen.results.at_rest.steps import letter_of_load, letter_of_reaction
from eomgen.scene import DrawnArrow, Mark, arrow_marks, pushes_reported, spread_mark
from eomgen.symbolic.expression import Node, Scalar, Vector
from eomgen.symbolic.numeric import numbers_of, tolerances
from eomgen.symbolic.print import Setter, Symbol, text_size, to_text

WIDTH = 9.0  # of the picture [inches]
COLUMN, DIAGRAM = 3.4, 1.5  # width and height of a diagram [inches]
MOST_COLUMNS = 8  # bodies with diagrams
LOWEST, HIGHEST = 2.4, 8.0  # height of the structure [inches]
TITLE_ROOM = 0.4  # above the structure [inches]


def statics_picture(found: StaticReactions, sections: Sections, influence: InfluenceLine | None) -> Picture:
    """The structure with loads and reactions; below it N, V and M of its beams, and an influence line.

    Beams that lie in a row have their diagrams exactly below them. Without values all is drawn for a stated ratio, and
    formulas stand for numbers.
    """
    model = found.system.scope.model
    missing = missing_values(model)
    scene = StaticScene(found, not missing)
    beams = list(sections.found.values())[:MOST_COLUMNS]
    bodies = beams or list(sections_in_space(found).values())[:MOST_COLUMNS]
    rows = len(LETTERS if beams else IN_SPACE) if bodies else 0
    line = influence if not missing else None
    heights = [
        float(np.clip(WIDTH * scene.proportion, LOWEST, HIGHEST)),
        *([DIAGRAM] * rows),
        *([1.5 * DIAGRAM] if line else []),
    ]
    words = f"drawn with {', '.join(missing)} = 1" if missing else ""
    spans = spans_in_a_row(scene, beams) if line is None else []
    width = max(WIDTH, COLUMN * len(bodies)) if not spans else WIDTH

    def fill(figure: Any) -> None:
        if spans:
            _in_one_column(figure, scene, list(zip(beams, spans, strict=True)), heights)
        else:
            _in_a_grid(figure, scene, bodies, line, heights)
        if words:
            figure.text(0.99, 0.99, words, fontsize=9, ha="right", va="top", color="#505050")

    return Picture((width, sum(heights) + (ROOM if spans else 0.0)), fill, model.name)


def picture_checks(
    found: StaticReactions, sections: Sections, influence: InfluenceLine | None, panels: Sequence[DrawnPanel]
) -> Iterator[Check]:
    """Checks of the picture: its diagrams and its influence line by their panels, the arrows by their strokes."""
    in_space = {} if missing_values(found.system.scope.model) else sections_in_space(found)
    yield from structure_pictured(found, {**sections.found, **in_space}, influence, panels, pushes_on(found))


def pushes_on(found: StaticReactions) -> Iterable[ReportedPush]:
    """All that the picture shows to act on the structure; () where its sizes are not all known."""
    scene = StaticScene(found, not missing_values(found.system.scope.model))
    return pushes_reported(scene.sketch.drawing, scene.sketch.frame) if scene.balanced else ()


def _in_a_grid(
    figure: Any,
    scene: StaticScene,
    bodies: Sequence[SectionForces],
    line: InfluenceLine | None,
    heights: list[float],
) -> None:
    """The structure above, a column of diagrams for each body, the influence line below."""
    grid = figure.add_gridspec(len(heights), max(1, len(bodies)), height_ratios=heights)
    draw_structure(figure.add_subplot(grid[0, :]), scene)
    for column, forces in enumerate(bodies):
        plane = set(forces.kinds) == set(LETTERS)
        panels = [figure.add_subplot(grid[1 + k, column]) for k in range(len(LETTERS if plane else IN_SPACE))]
        (diagram_panels if plane else in_space)(panels, forces, scene.bare.values, scene.scale, scene.written)
    if line is not None:
        influence_panel(figure.add_subplot(grid[-1, :]), line, scene.bare.values)


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
        (x, y), (u, v) = (scene.bare.position((forces.axis.body, end)) for end in ends)
        if more or u <= x or abs(v - y) > tolerances.SAME_PLACE * (u - x):
            return []
        found.append((x, u))
    near = tolerances.SAME_PLACE * scene.bare.extent
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
        diagram_panels(panels, forces, scene.bare.values, scene.scale, scene.written)
        length = numbers_of((forces.pieces[0].start, forces.pieces[-1].end), scene.bare.values)
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


def missing_values(model: Model) -> list[str]:
    """The parameters without a value."""
    values = model.exact_parameters()
    return [name for name in model.parameters if name not in values]


# -------- diagrams --------------------------------------------------------------------------------------------
# SectionForces, InfluenceLine -> panels of a picture: N, V and M over the axis of a body, X over the way of a load.


COLORS = {"axial_force": "#2457a6", "shear_force": "#2e7d4f", "bending_moment": "#b03a2e"}
UNITS = {"axial_force": "N", "shear_force": "N", "bending_moment": "N m"}
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
    places = numbers_of(stations, values)
    for panel, kind in zip(panels, forces.kinds, strict=True):
        curves = _curves(forces, kind, values, scale)
        _filled(panel, curves, COLORS[kind])
        upright = panel.get_xaxis_transform()
        panel.vlines(places, 0, 1, transform=upright, color="#b0b0b0", linewidth=0.6, linestyle=":", zorder=0.5)
        if kind == "bending_moment":
            panel.invert_yaxis()
        if written is None:
            ends = [(x[k], y[k]) for x, y in curves for k in (0, -1)]
            extremes = (numbers_of((e.x, e.M), values) for e in forces.extremes if kind == "bending_moment")
            _labels(panel, [*ends, *((x, scale(M)) for x, M in extremes)])
            panel.set_ylabel(f"{LETTERS[kind]} of {forces.axis.body} [{scale.unit(UNITS[kind])}]")
        else:
            _labels(panel, _formulas(forces, kind, values, written))
            panel.set(ylabel=f"{LETTERS[kind]}, {forces.axis.body}", yticks=[0])
            panel.set_xticks(places, [_formula(written, forces, x) for x in stations])
    panels[-1].set_xlabel("x [m]" if written is None else "x")


IN_SPACE = (("N",), ("V_y", "V_z"), ("T",), ("M_y", "M_z"))
"""Components of the section forces in space that one panel shows."""
COLORS_IN_SPACE = ("#2457a6", "#c77c11")
COUPLES = ("T", "M_y", "M_z")


def in_space(
    panels: Sequence[Any],
    forces: SectionForces,
    values: Mapping[Node, float],
    scale: Scale = SI,
    written: Setter | None = None,
) -> None:
    """N, V_y and V_z, T, M_y and M_z along one body in space, a panel for each group; arguments as `diagram_panels`."""
    places = numbers_of([forces.pieces[0].start, *(piece.end for piece in forces.pieces)], values)
    for panel, kinds in zip(panels, IN_SPACE, strict=True):
        points: list[tuple[Any, ...]] = []
        for color, kind in zip(COLORS_IN_SPACE, kinds, strict=False):
            curves = _curves(forces, kind, values, scale)
            _filled(panel, curves, color, f"${kind}$" if len(kinds) > 1 else "")
            points += _at_the_ends(forces, kind, curves, written)
        upright = panel.get_xaxis_transform()
        panel.vlines(places, 0, 1, transform=upright, color="#b0b0b0", linewidth=0.6, linestyle=":", zorder=0.5)
        _labels(panel, points)
        unit = "" if written is not None else f" [{scale.unit('N m' if kinds[0] in COUPLES else 'N')}]"
        panel.set_ylabel(f"{', '.join(kinds)} of {forces.axis.body}{unit}", fontsize=8)
        if written is not None:
            panel.set_yticks([0])
        if len(kinds) > 1:
            panel.legend(loc="upper right", bbox_to_anchor=(1.0, 1.16), fontsize=7, ncols=2)
    panels[-1].set_xlabel("x [m]" if written is None else "x")


def _at_the_ends(
    forces: SectionForces, kind: str, curves: Sequence[tuple[np.ndarray, np.ndarray]], written: Setter | None
) -> Iterable[tuple[Any, ...]]:
    """(x, value) at the ends of each piece, and the formula where formulas stand for numbers."""
    for piece, (x, y) in zip(forces.pieces, curves, strict=True):
        for k, end in ((0, piece.start), (-1, piece.end)):
            if written is None:
                yield x[k], y[k]
            else:
                yield x[k], y[k], _formula(written, forces, piece.value(kind, end))


def _formulas(
    forces: SectionForces, kind: str, values: Mapping[Node, float], written: Setter
) -> list[tuple[float, float, str]]:
    """(x, value, formula) at the ends of the pieces, and of the extremes of M."""
    found = [(x, piece.value(kind, x)) for piece in forces.pieces for x in (piece.start, piece.end)]
    found += [(extreme.x, extreme.M) for extreme in forces.extremes] if kind == "bending_moment" else []
    numbers = numbers_of([x for pair in found for x in pair], values)
    pairs = zip(numbers[::2], numbers[1::2], found, strict=True)
    return [(x, y, _formula(written, forces, value)) for x, y, (_, value) in pairs]


def _formula(written: Setter, forces: SectionForces, value: Scalar) -> str:
    """A formula between dollars; "" of a long one."""
    short = forces.sizes.shortest(value)
    return label_of(written, short)


def influence_panel(panel: Any, line: InfluenceLine, values: Mapping[Node, float]) -> None:
    """An influence line over the way of the load: over x where that always grows, else over the length of the way."""
    curves = []
    way = 0.0
    for span in line.spans:
        (x0, y0), (x1, y1) = (numbers_of(place[:2], values) for place in (span.start, span.end))
        length = float(np.hypot(x1 - x0, y1 - y0))
        begin = x0 if _is_level(line, values) else way
        curves.append((np.array([begin, begin + length]), np.array(numbers_of((span.at_start, span.at_end), values))))
        way += length
    _filled(panel, curves, "#7a4ea3")
    _labels(panel, [(x[k], y[k]) for x, y in curves for k in (0, -1)])
    panel.set_ylabel(line.name)
    panel.set_xlabel("x [m]" if _is_level(line, values) else "way of the load [m]")


def _is_level(line: InfluenceLine, values: Mapping[Node, float]) -> bool:
    heights = [numbers_of((span.start[1], span.end[1]), values) for span in line.spans]
    starts = [numbers_of((span.start[0], span.end[0]), values) for span in line.spans]
    return bool(np.ptp(heights) < tolerances.COMPUTED * max(1.0, np.abs(heights).max())) and all(
        b >= a for a, b in starts
    )


def _curves(
    forces: SectionForces, kind: str, values: Mapping[Node, float], scale: Scale
) -> list[tuple[np.ndarray, np.ndarray]]:
    """Points of each piece."""
    sampled = (piece.points(kind, values, FINE) for piece in forces.pieces)
    return [(x, y / scale.factor) for x, y in sampled]


def _filled(panel: Any, curves: Iterable[tuple[np.ndarray, np.ndarray]], color: str, label: str = "") -> None:
    panel.axhline(0, color="#505050", linewidth=1.2)
    for k, (x, y) in enumerate(curves):
        panel.fill_between(x, y, 0, color=color, alpha=0.18, linewidth=0)
        ends = np.concatenate([[x[0]], x, [x[-1]]]), np.concatenate([[0], y, [0]])
        panel.plot(*ends, color=color, linewidth=1.4, label=label if label and not k else None)


def _labels(panel: Any, points: Iterable[tuple[Any, ...]]) -> None:
    """The values, each once at a place; zeros left out.

    Args:
        points: (x, y), and the words for y where it is not written as a number.
    """
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
    words = [(point[2] if len(point) > 2 else four_figures(point[1]), point[:2]) for point in shown]
    add_names(panel, words, [np.column_stack(line.get_data()) for line in panel.lines[1:]])
    panel.margins(x=0.03, y=0.22)
    if not largest:
        panel.set_yticks([0])


# -------- structure --------------------------------------------------------------------------------------------
# An arrow points as its force does and is longer for a larger one, without a scale; its name has the value.

TENSION, COMPRESSION, NOTHING = "#2457a6", "#b03a2e", "#808080"
LONGEST, SHORTEST = 0.13, 0.45  # of arrows, of the extent; of the longest
LONGEST_LABEL = 24  # characters of a formula next to an arrow
MOST = 10  # times as large is not even printed
MET = ("body", "hole", "member")  # roles of lines that an arrow should not run along


@dataclass(frozen=True)
class ActingArrow:
    """A force or couple of a structure, in numbers.

    Args:
        of: the load, or the component of a reaction, by name.
        at, vector: ground axes, 2 or 3; of a couple always 3.
        words, tex: its name and value, "" where it has none.
    """

    of: str
    role: str
    at: np.ndarray
    vector: np.ndarray
    words: str
    tex: str
    turns: bool = False

    @property
    def size(self) -> float:
        return float(np.linalg.norm(self.vector))


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
    def bare(self) -> Sketch:
        """The structure without what acts on it."""
        system, at = self.statics.system, self.statics.structure.at
        values = system.scope.model.exact_parameters()
        numbers = {node: float(values.get(name, 1)) for name, node in system.symbols.parameters.items()}
        numbers |= {p: 1.0 for p in system.symbols.unknowns.values()}
        plain = Sketch(system, numbers)
        found = dict(zip(at, plain.numbers(at.values()), strict=True))
        unknowns = self.statics.balance.unknowns
        found |= dict(zip(unknowns, plain.numbers(unknowns.values()), strict=True))
        return Sketch(system, {**numbers, **found}, dimensions=True, longest=LONGEST)

    @cached_property
    def sketch(self) -> Sketch:
        """The structure with its loads and reactions."""
        letters = {each.words: _plainly(each.words, each.tex) for each in self.acting if each.words}
        spread = [*self._spreads()]
        letters |= {words: _plainly(words, tex) for _, words, tex in spread}
        marks = (*arrow_marks(self._drawn()), *(mark for mark, _, _ in spread))
        return replace(self.bare, more=marks, letters=letters, colors=self._colors())

    @property
    def proportion(self) -> float:
        """Height over width of all that is drawn, with room for names."""
        paths = [self.bare.page(s.path[0]) for s in self.sketch.drawing.strokes if s.role != "track"]
        places = np.concatenate([path.reshape(-1, 2) for path in paths if path.size])
        wide, tall = np.ptp(places[np.isfinite(places).all(axis=1)], axis=0) + 0.2 * self.bare.extent
        return float(tall / wide)

    @property
    def balanced(self) -> bool:
        """True if all that acts is drawn, each with its size beside it."""
        components = self.statics.structure.components
        outer = [j for j, component in enumerate(components) if len(component.effects) == 1]
        solved = all(self.statics.balance.solution.determined(j) for j in outer)
        plain = not any(components[j].friction or components[j].is_wrench for j in outer)
        return self.known and solved and plain and all(acting.load is not None for acting in self.statics.loads)

    @property
    def written(self) -> Setter | None:
        """Typesetting of formulas that stand for numbers; None where numbers are known."""
        return None if self.known else Setter(notation_of(self.statics.system.scope.model))

    # -- what acts -----------------------------------------------------------------------------------------

    @cached_property
    def acting(self) -> list[ActingArrow]:
        """Every single force and couple, loads first."""
        return [*self._loads(), *self._reactions()]

    def _loads(self) -> Iterator[ActingArrow]:
        motion = self.statics.system.motion
        for acting in self.statics.loads:
            load = acting.load
            if isinstance(load, PointForce) and load.place[0] is not None:
                at = self.bare.spot(motion.position(load.place))
                force = self.bare.spot(motion.in_ground_axes(load.force, load.axes))
                size = float(np.linalg.norm(force))
                if size:
                    yield ActingArrow(acting.name, "force", at, force, *self._named(acting.name, (size,), "N"))
            elif isinstance(load, Couple):
                couple = np.array(self.bare.numbers(motion.in_ground_axes(load.couple, load.axes)))
                at = self._middle(load.body) if load.place is None else self.bare.spot(motion.position(load.place))
                size = float(np.linalg.norm(couple))
                words = self._named(acting.name, (size,), "N m")
                yield ActingArrow(acting.name, "force", at, couple, *words, turns=True)

    def _reactions(self) -> Iterator[ActingArrow]:
        """The determinate reactions of the ground."""
        motion = self.statics.system.motion
        axes, named = Axes(motion), self._named_alone()
        for j, component in enumerate(self.statics.structure.components):
            if len(component.effects) != 1 or not self.statics.balance.solution.determined(j):
                continue
            (effect,) = component.effects
            link = motion.links[effect.link]
            name, sense = named.get(j, (component.name, 1))
            reaction = self.statics.by_name.get(name)
            value = (
                sense * self.statics.balance.value(j) if reaction is None or reaction.value is None else reaction.value
            )
            for turns, own in ((False, effect.force), (True, effect.couple)):
                vector = sense * np.array(self.bare.numbers(own if axes.plane else link.pose.R @ own))
                if not vector.any():
                    continue
                number, words, tex = self._shown(name, value, "N m" if turns else "N")
                at = self._seat(component) if turns else self.place(effect)
                kept = vector if turns or not axes.plane else vector[:2]
                yield ActingArrow(name, "reaction", at, number * kept, words, tex, turns)

    def _named_alone(self) -> dict[int, tuple[str, int]]:
        """(name, sense) of the reaction that is one component alone, by the component's number."""
        found = {}
        for reaction in self.statics.reactions:
            combination = {} if reaction.named is None else reaction.named.combination
            if len(combination) == 1:
                ((j, factor),) = combination.items()
                if type(factor) is int and abs(factor) == 1:
                    found[j] = (reaction.name, factor)
        return found

    def _spreads(self) -> Iterator[tuple[Mark, str, str]]:
        """(mark, words, typeset) of line loads: the size at both ends where it changes."""
        motion = self.statics.system.motion
        for acting in self.statics.loads:
            load = acting.load
            if isinstance(load, SpreadLoad):
                sizes = [math.hypot(*self.bare.numbers(q)) for q in (load.at_start, load.at_end)]
                words, tex = self._named(acting.name, sizes, "N/m")
                yield spread_mark(motion, load, acting.name, words), words, tex

    def _drawn(self) -> list[DrawnArrow]:
        """The arrows; of a reaction that is zero the name alone."""
        largest = max((each.size for each in self.acting if not each.turns), default=0.0) or 1.0
        reach, lines = LONGEST * self.bare.extent, self.bare.lines(MET)
        drawn: list[DrawnArrow] = []
        for each in sorted(self.acting, key=lambda each: each.turns):
            zero = each.size <= tolerances.COMPUTED * (self.largest if each.turns else largest)
            if zero and each.role == "force":
                continue
            length = 0.0 if zero else 1.0 if each.turns else DrawnArrow.never_short(each.size, largest, SHORTEST)
            vector = each.vector * (length / each.size if each.size else 0.0)
            at, way = self.bare.page(each.at).tolist(), (reach * self.bare.page(vector)).tolist()
            outward = each.of.startswith("tension(") or (not each.turns and DrawnArrow.is_freer_outward(lines, at, way))
            at = each.at
            if each.turns and not self.bare.plane:
                at = at + self._beside(at, vector, drawn)
            drawn.append(DrawnArrow(each.of, at, vector, each.role, each.words, each.turns, outward))
        return drawn

    def _beside(self, at: np.ndarray, couple: np.ndarray, drawn: Sequence[DrawnArrow]) -> np.ndarray:
        """Way from the place of a couple in space to where it starts: beyond a force that is drawn along it there."""
        reach = 1.1 * LONGEST * self.bare.extent
        for force in (each for each in drawn if not each.turns and np.allclose(each.at, at)):
            taken = np.array(force.vector) * (1 if force.outward else -1)
            sizes = float(np.linalg.norm(taken) * np.linalg.norm(couple))
            if taken @ couple > (1 - tolerances.SAME_ARROW) * sizes > 0:
                beyond: np.ndarray = reach * taken
                return beyond
        return np.zeros(3)

    # -- places --------------------------------------------------------------------------------------------

    def place(self, effect: Effect) -> np.ndarray:
        """Place where a reaction acts, ground axes."""
        axes = Axes(self.statics.system.motion)
        link = axes.motion.links[effect.link]
        center = self.bare.spot(link.pose.point(axes.masses[effect.link].com))
        found: np.ndarray = center + self.bare.spot(effect.arm if axes.plane else link.pose.R @ effect.arm)
        return found

    def _seat(self, couple: Component) -> np.ndarray:
        """Place of a drawn couple: at the forces of its constraint or joint, else in the middle of the body."""
        for other in self.statics.structure.components:
            if other.owner == couple.owner and other.label != couple.label and len(other.effects) == 1:
                return self.place(other.effects[0])
        return self._middle(self.statics.system.motion.links[couple.effects[0].link].name)

    def _middle(self, body: str) -> np.ndarray:
        motion = self.statics.system.motion
        own = motion.points[body].items()
        places = [motion.position((body, r)) for name, r in own if name not in ("origin", "center")]
        spots = [self.bare.spot(place) for place in places or [motion.position((body, Vector.ZERO))]]
        found: np.ndarray = np.mean(spots, axis=0)
        return found

    # -- words ---------------------------------------------------------------------------------------------

    @property
    def scale(self) -> Scale:
        """Scale of all forces and couples, of the loads and the reactions."""
        return Scale.of(self._sizes)

    @property
    def largest(self) -> float:
        """Size of the largest load and reaction."""
        return max(map(abs, self._sizes), default=0.0)

    @cached_property
    def _sizes(self) -> list[float]:
        """Sizes of the forces among the loads, and all reactions."""
        forces = [acting.load.force for acting in self.statics.loads if isinstance(acting.load, PointForce)]
        values = self.bare.numbers(each.value for each in self.statics.reactions if each.value is not None)
        return [*(math.hypot(*self.bare.numbers(force)) for force in forces), *values]

    def _named(self, load: str, sizes: Iterable[float], unit: str) -> tuple[str, str]:
        """(words, typeset): a load by its name, with its size, or sizes."""
        tex = letter_of_load(load, notation_of(self.statics.system.scope.model))
        if not self.known:
            return load, tex
        numbers = list(dict.fromkeys(self.scale.number(size) for size in sizes))
        unit = self.scale.unit(unit)
        return f"{load} = {' to '.join(numbers)} {unit}", f"{tex} = {plain(' to '.join(numbers) + ' ' + unit)}"

    def _letter(self, name: str) -> str:
        """The letter of a reaction, typeset."""
        named = next((r.named for r in self.statics.reactions if r.name == name), None)
        own = None if named is None else own_symbol(self.statics.balance.balance, named)
        notation = notation_of(self.statics.system.scope.model)
        return notation.latex(letter_of_reaction(name)) if own is None else own.tex

    def _shown(self, name: str, value: Scalar, unit: str) -> tuple[float, str, str]:
        """(a value in the sense in which its label is positive, words, typeset): a number, or a short formula."""
        (number,) = self.bare.numbers((value,))
        letter = self._letter(name)
        if abs(number) <= tolerances.COMPUTED * self.largest:
            return 0.0, f"{name} = 0", f"{letter} = {plain('0')}"
        if self.known:
            size, unit = self.scale.number(abs(number)), self.scale.unit(unit)
            return number, f"{name} = {size} {unit}", f"{letter} = {plain(f'{size} {unit}')}"
        text, written = to_text(value), self.written
        turned = text.startswith("-") and not any(sign in text[1:] for sign in (" + ", " - "))
        shown, sign = (-value, -1) if turned else (value, 1)
        if written is None or len(text) > LONGEST_LABEL:
            return abs(number), name, letter
        words, tex = f"{name} = {to_text(shown)}", f"{letter} = {plain_tex(written, shown)}"
        return math.copysign(number, sign), words, tex

    # -- members of trusses --------------------------------------------------------------------------------

    @property
    def members(self) -> list[tuple[str, tuple[str, str], Scalar]]:
        """(name, its nodes, its force) of the members of trusses whose forces are determinate."""
        found = []
        for truss, member, ends in self.statics.system.scope.model.truss_members:
            reaction = self.statics.by_name.get(f"tension({truss}, {member})")
            if reaction is not None and reaction.value is not None:
                found.append((f"{truss}.{member}", ends, reaction.value))
        return found

    def _colors(self) -> dict[str, str]:
        """Colours of the members of trusses: pulled, pushed, or neither."""
        return {name: self._color(value) for name, _, value in self.members}

    def _color(self, value: Scalar) -> str:
        (number,) = self.bare.numbers((value,))
        return NOTHING if abs(number) < tolerances.COMPUTED * self.largest else TENSION if number > 0 else COMPRESSION

    def label(self, value: Scalar) -> str:
        """A value: a number without its unit, or a short formula where parameters have no values."""
        (number,) = self.bare.numbers((value,))
        if abs(number) < tolerances.COMPUTED * self.largest:
            return "0"
        text = self.scale.number(number) if self.known else to_text(value)
        return text if len(text) <= LONGEST_LABEL else ""


def draw_structure(panel: Any, scene: StaticScene) -> None:
    """Bodies, supports, loads in red, reactions in green, member forces in blue (tension) and red (compression)."""
    sketch = scene.sketch
    sketch.draw(panel)
    for name, ends, value in scene.members:
        places = [sketch.position((node, Vector.ZERO)) for node in ends]
        sketch.name_along(panel, scene.label(value), places, name)
    if scene.members:
        unit = f" [{scene.scale.unit('N')}]" if scene.known else ""
        panel.set_title(f"members{unit}: tension blue, compression red", fontsize=9, loc="right", color="#505050")


def label_of(written: Setter, x: Scalar) -> str:
    """A formula between dollars; "" of a long one."""
    long = text_size(x) > MOST * LONGEST_LABEL or len(to_text(x)) > LONGEST_LABEL
    return "" if long else f"${plain_tex(written, x)}$"


def plain_tex(written: Setter, x: Scalar) -> str:
    """A formula as matplotlib sets it, which knows one kind of fraction."""
    return re.sub(r"\\[td]frac", r"\\frac", written.set(x).tex)


def plain(words: str) -> str:
    """Words in a formula in the letters of all other texts, as matplotlib sets them."""
    return rf"\mathregular{{{words.replace(' ', chr(92) + ' ')}}}"


def _plainly(words: str, tex: str) -> Symbol:
    """A name whose upright words are in the letters of all other texts."""
    return Symbol(words, tex.replace(r"\mathrm{", r"\mathregular{"))
