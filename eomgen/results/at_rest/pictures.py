"""Pictures of structures: loads, reactions, diagrams of N, V and M, influence lines."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from itertools import pairwise
from typing import Any

import numpy as np

from eomgen.documents import INK, Picture, PlacedName, Scale, four_figures
from eomgen.mechanics.statics import InfluenceLine, SectionForces, StaticReactions
from eomgen.model import Model
from eomgen.proof import Check, DrawnPanel, ReportedPush, structure_pictured
from eomgen.results.at_rest.section_steps import LETTERS, Sections, sections_in_space
from eomgen.results.at_rest.structure import StaticScene, draw_structure, label_of
from eomgen.scene import pushes_reported
from eomgen.symbolic.expression import Node, Scalar
from eomgen.symbolic.numeric import numbers_of, tolerances
from eomgen.symbolic.print import Setter

# -------- picture ---------------------------------------------------------------------------------------------
# StaticReactions -> a picture: the structure with its loads and its reactions, the diagrams of its beams below it.


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
    bodies = beams or list(sections_in_space(found.balance).values())[:MOST_COLUMNS]
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
    in_space = {} if missing_values(found.system.scope.model) else sections_in_space(found.balance)
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
        length = _numbers((forces.pieces[0].start, forces.pieces[-1].end), scene.bare.values)
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
    places = _numbers(stations, values)
    for panel, kind in zip(panels, forces.kinds, strict=True):
        curves = _curves(forces, kind, values, scale)
        _filled(panel, curves, COLORS[kind])
        upright = panel.get_xaxis_transform()
        panel.vlines(places, 0, 1, transform=upright, color="#b0b0b0", linewidth=0.6, linestyle=":", zorder=0.5)
        if kind == "bending_moment":
            panel.invert_yaxis()
        if written is None:
            ends = [(x[k], y[k]) for x, y in curves for k in (0, -1)]
            extremes = (_numbers((e.x, e.M), values) for e in forces.extremes if kind == "bending_moment")
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
    places = _numbers([forces.pieces[0].start, *(piece.end for piece in forces.pieces)], values)
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
    numbers = _numbers([x for pair in found for x in pair], values)
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
    return numbers_of(scalars, values)
