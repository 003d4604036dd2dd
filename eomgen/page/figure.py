"""Pictures of a page: a model at rest, curves over time, files next to it; a scene as SVG, drawn by no library."""

from __future__ import annotations

import math
import re
import tempfile
from collections import Counter
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import field, replace
from functools import partial
from itertools import groupby
from pathlib import Path
from typing import Any

import numpy as np

from eomgen.documents import (
    KINDS,
    OURS,
    Catalogue,
    Code,
    FlatName,
    FlatShape,
    Picture,
    Piece,
    by_unit,
    drawing_at_rest,
    flat_drawing,
    kinds_of_lines,
    largest_reaction,
    largest_reactions,
    mathtext,
    notation_of_run,
    owner_of,
    prose,
    range_without_noise,
    reactions_by_unit,
    rest_picture,
)
from eomgen.frozen import dataclass
from eomgen.model import Model, Unit
from eomgen.page.contents import INKS, LegendEntry, ReportFigure
from eomgen.page.markup import Html, curve_path, element, in_a_row, stepped
from eomgen.page.paper import GREEK, UPRIGHT
from eomgen.results import missing_values
from eomgen.scene import Drawing, Scene, scene_of
from eomgen.simulation import Trajectory
from eomgen.symbolic.expression import Graph, Node
from eomgen.symbolic.numeric import tolerances
from eomgen.symbolic.print import Notation

OFTEN = 4  # times that a look is said before it has a name
_SVG = re.compile(r'<svg[^>]*viewBox="0 0 ([\d.]+) ([\d.]+)"[^>]*>(.*)</svg>', re.DOTALL)

_PATH = re.compile(r' d="([^"]*)"')
_CURVED = re.compile("[CQ]")
_ID = re.compile(r'( id="|href="#|url\(#)')
_STYLE = re.compile(r' style="([^"]*)"')
_FILL = re.compile(r' style="fill: (#\w+); (stroke: [^"]*; stroke-linecap: round)"')
"""A face: its shade, and an edge that it shares with others."""
_HALO = re.compile(
    r'<path d="([^"]*)" style="fill: (#\w+); stroke: #ffffff; stroke-width: ([\d.]+)"/>\s*'
    r'<path d="\1" style="fill: \2"/>'
)
"""A letter with its white edge, and the same letter again."""


def rest_figure(model: Model, language: Catalogue = OURS) -> ReportFigure:
    """A model where it starts, with its coordinates and lengths.

    Args:
        language: of the words in it.
    """
    missing = missing_values(model)
    assumed = f"; drawn with {', '.join(missing)} = 1" if missing else ""
    where = "at the start" if model.coordinates else "as it stands"
    picture = replace(rest_picture(model), title="", language=language)
    return figure_of(picture, "figure", f"{model.name} {where}{assumed}.")


def figure_of(picture: Picture, key: str, caption: str) -> ReportFigure:
    """A picture as a figure: SVG of its own colours."""
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "picture.svg"
        picture.save(path)
        found = _SVG.search(path.read_text(encoding="utf-8"))
    assert found is not None
    size = float(found[1]), float(found[2])
    return ReportFigure(key, caption, size, Html(_lean(found[3], key)), save=picture.save, fixed=True)


def _lean(marks: str, key: str) -> str:
    """SVG without what a browser does not need: metadata, comments, invisible digits, repeated styles.

    Args:
        key: the prefix of the names in it: no two figures of a page have the same.
    """
    marks = re.sub(r"<metadata>.*?</metadata>|<!--.*?-->", "", marks, flags=re.DOTALL)
    marks = _ID.sub(rf"\1{key}-", re.sub(r'<g id="[^"]*"', "<g", marks))
    marks = _PATH.sub(lambda found: f' d="{stepped(found[1], digits=2 if _CURVED.search(found[1]) else 1)}"', marks)
    marks = _HALO.sub(r'<path d="\1" style="fill: \2; stroke: #ffffff; stroke-width: \3; paint-order: stroke"/>', marks)
    marks = _FILL.sub(r' fill="\1" style="\2"', marks)
    looks = [look for look, times in Counter(_STYLE.findall(marks)).items() if times > OFTEN]
    names = {look: f"{key}-{k}" for k, look in enumerate(looks)}
    marks = _STYLE.sub(lambda found: f' class="{names[found[1]]}"' if found[1] in names else found[0], marks)
    rules = "".join(f".{name}{{{look}}}" for look, name in names.items())
    return (f"<style>{rules}</style>" if rules else "") + re.sub(r"\n\s*", "\n", marks)


# -------- pictures --------------------------------------------------------------------------------------------
# Pictures of a report as files next to it.


@dataclass(frozen=True)
class Pictures:
    """Picture files next to the report's file.

    Args:
        beside: the name of the report's file.
        ending: ".pdf", ".svg".
        drawn: content by name, of those that were named.
    """

    beside: str
    ending: str
    drawn: dict[str, str | bytes] = field(default_factory=dict)

    def name(self, drawing: ReportFigure) -> str:
        """The file of a drawing, which is made; "" where it cannot be a file."""
        if drawing.save is None:
            return ""
        name = f"{Path(self.beside).stem}-{drawing.key}{self.ending}"
        with tempfile.TemporaryDirectory() as folder:
            path = Path(folder) / name
            drawing.save(path)
            self.drawn[name] = path.read_bytes()
        return name


# -------- curves ----------------------------------------------------------------------------------------------
# Trajectory -> drawings over time, SVG: coordinates and states by unit, energy, reactions; in the page's colours.


WIDTH, HEIGHT = 720.0, 186.0
LEFT, RIGHT, TOP, BOTTOM = 58.0, 8.0, 8.0, 28.0  # margins, in which the numbers stand
TICKS = 5  # about so many numbers on an axis
PLAIN = 4  # digits before or behind the point, beyond which a power of ten is written
COLORS = 8
DASHED = dict(zip(KINDS, ("", " d1", " d2", " d3"), strict=True))  # classes of the kinds of lines


@dataclass(frozen=True)
class Axis:
    """Numbers along a line.

    Args:
        low, high: its ends.
        ticks: the numbers that are written.
        power: of ten, that of their distance.
    """

    low: float
    high: float
    ticks: tuple[float, ...]
    power: int

    def text(self, value: float) -> str:
        """A number as it is written, with as many digits as distinguish it from the next: plainly where few do."""
        largest = max(map(abs, self.ticks))
        if self.power < -PLAIN or largest >= 10**PLAIN:
            if not value:
                return "0"
            count = max(2, math.floor(math.log10(largest)) - self.power)  # neighbouring ticks differ
            digits, _, power = f"{value:.{count}e}".partition("e")
            return f"{digits.rstrip('0').rstrip('.')}e{int(power)}".replace("-", "\N{MINUS SIGN}")
        return f"{value:.{max(0, -self.power)}f}".replace("-", "\N{MINUS SIGN}")


def number_axis(low: float, high: float) -> Axis:
    """An axis from low to high with round numbers: 1, 2 or 5 times a power of ten apart."""
    if not high > low:
        room = abs(low) or 1.0
        low, high = low - room / 2, high + room / 2
    raw = (high - low) / TICKS
    power = math.floor(math.log10(raw))
    step = 10.0**power * next(factor for factor in (1, 2, 5, 10) if factor * 10.0**power >= raw)
    power += step >= 10.0 ** (power + 1)
    first, last = math.ceil(low / step), math.floor(high / step)
    return Axis(low, high, tuple(k * step for k in range(first, last + 1)), power)


@dataclass(frozen=True)
class Line:
    """A curve: its values, its look, its name."""

    values: np.ndarray
    style: str
    name: tuple[Piece, ...]


def motion_drawings(run: Trajectory, units: Mapping[str, Unit]) -> tuple[ReportFigure, ...]:
    """Coordinates over time, one drawing a unit, states of first order alike; the energy, or its error; reactions.

    Args:
        units: of coordinates and states by name, in which they are drawn; absent: SI.
    """
    found: list[ReportFigure] = []
    for what, those in (("Coordinates", run.coordinates), ("States of first order", run.states)):
        for unit, names in by_unit(those, units).items():
            found.append(_of_state(run, names, unit, f"motion{len(found) + 1}", what))
    if run.energy is not None:
        found.append(_energy(run))
    found += [
        _reactions(run, names, unit, k) for k, (unit, names) in enumerate(reactions_by_unit(run).items(), start=1)
    ]
    return tuple(found)


def _of_state(run: Trajectory, names: Sequence[str], unit: Unit, key: str, what: str) -> ReportFigure:
    graph = Graph()
    lines = [
        Line(run[name] / unit.size, f"curve c{k % COLORS}{' d1' if k >= COLORS else ''}", (graph.symbol(name),))
        for k, name in enumerate(names[: 2 * COLORS])
    ]
    more = f"; {len(names) - len(lines)} more are not drawn" if len(names) > len(lines) else ""
    measured = f" [{unit}]" if unit.text else ""
    return panel(run, lines, key, f"{what}{measured} over time [s]{more}")


def _energy(run: Trajectory) -> ReportFigure:
    energy = run.energy
    assert energy is not None
    if run.drift is None:
        return panel(run, [Line(energy, "curve c7", ())], "energy", "Energy T + V [J] over time [s]")
    within = " in each phase" if len(run.phases) > 1 else ""
    caption = f"Energy: T + V less its value at the start [J] over time [s]; relative drift {run.drift:.1e}{within}"
    rounding = tolerances.ROUNDING / tolerances.RUN * float(np.nanmax(np.abs(energy), initial=0.0))
    return panel(run, [Line(energy - energy[:1], "curve c7", ())], "energy", caption, rounding)


def _reactions(run: Trajectory, names: Sequence[str], unit: str, number: int) -> ReportFigure:
    owners: dict[str, list[str]] = {}
    for name in names:
        owners.setdefault(owner_of(name), []).append(name)
    shown = largest_reactions(run, owners)
    looks = kinds_of_lines([owners[owner] for owner in shown], COLORS)
    lines = [
        Line(run.reactions[name], f"curve c{color}{DASHED[kind]}", (Code(name),))
        for name, (color, kind) in looks.items()
    ]
    few = f"; the largest, at {len(shown)} of {len(owners)} joints and constraints" if len(shown) < len(owners) else ""
    caption = f"Reactions [{unit.replace('*', '·')}] over time [s]{few}"
    return panel(run, lines, f"reactions{number}", caption, largest_reaction(run))


def panel(run: Trajectory, lines: Sequence[Line], key: str, caption: str, size: float | None = None) -> ReportFigure:
    """Curves of a run over time with their axes.

    Args:
        size: what is large beside them: what is noise beside it looks constant.
    """
    t = run.t
    values = np.concatenate([line.values for line in lines]) if lines else np.zeros(1)
    finite = values[np.isfinite(values)]
    low, high = (float(finite.min()), float(finite.max())) if len(finite) else (0.0, 0.0)
    low, high = range_without_noise([line.values for line in lines], size) or (low, high)
    across, up = number_axis(float(t[0]), float(t[-1])) if len(t) else number_axis(0, 1), number_axis(low, high)

    def x(value: np.ndarray | float) -> np.ndarray:
        return LEFT + (np.asarray(value) - across.low) / (across.high - across.low) * (WIDTH - LEFT - RIGHT)

    def y(value: np.ndarray | float) -> np.ndarray:
        return HEIGHT - BOTTOM - (np.asarray(value) - up.low) / (up.high - up.low) * (HEIGHT - TOP - BOTTOM)

    marks = [_tick(float(x(value)), None, across.text(value)) for value in across.ticks]
    marks += [_tick(None, float(y(value)), up.text(value)) for value in up.ticks]
    marks += (
        [element("path", d=f"M{LEFT:g} {y(0.0):.1f}H{WIDTH - RIGHT:g}", class_="zero")] if up.low < 0 < up.high else []
    )
    marks += [
        element("path", d=path, class_=line.style) for line in lines if (path := curve_path(x(t), y(line.values)))
    ]
    legend = tuple(LegendEntry(line.style, prose(*line.name)) for line in lines if line.name)
    return ReportFigure(
        key, caption, (WIDTH, HEIGHT), in_a_row(*marks), legend, partial(_save, t, tuple(lines), notation_of_run(run))
    )


def _save(t: np.ndarray, lines: Sequence[Line], notation: Notation, path: Path, language: Catalogue = OURS) -> None:
    """The same by matplotlib, for formats that carry pictures as files."""

    def fill(figure: Any) -> None:
        panel = figure.subplots()
        for line in lines:
            words = line.style.split()
            dash = next(kind for kind in reversed(KINDS) if DASHED[kind].strip() in (*words, ""))
            label = "".join(
                f"${mathtext(p.name, notation)}$" if isinstance(p, Node) else getattr(p, "text", "") for p in line.name
            )
            color = next(INKS[int(word[1:])] for word in words if re.fullmatch(r"c\d", word))
            panel.plot(t, line.values, dash, color=color, linewidth=1.4, label=label or None)
        panel.set_xlabel("$t$ [s]")
        panel.margins(x=0.01)
        if any(line.name for line in lines):
            panel.legend(loc="center left", bbox_to_anchor=(1.0, 0.5), fontsize=8)

    Picture((8, 2.4), fill, language=language).save(path)


def _tick(x: float | None, y: float | None, text: str) -> Html:
    """A line of the grid with its number: upright at x, or level at y."""
    if x is not None:
        line = element("path", d=f"M{x:.1f} {TOP:g}V{HEIGHT - BOTTOM:g}", class_="axis")
        return in_a_row(line, element("text", text, x=f"{x:.1f}", y=f"{HEIGHT - BOTTOM + 17:g}", text_anchor="middle"))
    line = element("path", d=f"M{LEFT:g} {y:.1f}H{WIDTH - RIGHT:g}", class_="axis")
    return in_a_row(line, element("text", text, x=f"{LEFT - 7:g}", y=f"{(y or 0) + 4:.1f}", text_anchor="end"))


# -------- svg picture ------------------------------------------------------------------------------------------
# Scene -> SVG: a picture without a library that draws.
#
# Each stroke carries the class of its role, so that a page can give it another colour.

HALO = 2.5  # white edge of a name, so that it can be read over lines
WIDE, SMALL = 0.56, 0.7  # width of a letter, of its size; size of an index, of the letter's
DROP, BASE = 0.28, 0.78  # of a letter's size: how far an index stands lower; of a box: how far the base line is below
LETTERS = GREEK | {"ell": "ℓ", "prime": "′", "cdot": "·"}
COMBINED = {"dot": "\u0307", "ddot": "\u0308", "bar": "\u0304", "hat": "\u0302", "tilde": "\u0303", "vec": "\u20d7"}
FONT = "'STIX Two Math', 'Cambria Math', serif"
_MARKS = re.compile(r"\\[a-zA-Z]+|\\.|[{}_^]|.")


def model_svg(model: Model) -> Html:
    """The picture of a model where it starts, with its coordinates and lengths, as one element <svg>.

    Raises:
        DerivationError, NotYet: what cannot be derived is not drawn either.
    """
    scene = scene_of(model)
    return scene_svg(scene, drawing_at_rest(scene))


def scene_svg(scene: Scene, drawing: Drawing, label: str = "the model at its start") -> Html:
    """A scene at the first frame of its drawing as one element <svg>.

    Args:
        label: its content, in words.
    """
    found = flat_drawing(scene, drawing, lambda text: WIDE * sum(SMALL if s.level else 1.0 for s in signs_of(text)))
    marks = [mark for shape in found.shapes for mark in _shape(shape)]
    letters = element("g", *map(_name, found.names), class_="names")
    width, height = (f"{side:.0f}" for side in found.size)
    named: dict[str, Any] = {"xmlns": "http://www.w3.org/2000/svg", "role": "img", "aria_label": label}
    box = {"viewBox": f"0 0 {width} {height}", "width": width, "height": height}
    return element("svg", *marks, letters, **named, **box)


def _shape(shape: FlatShape) -> Iterator[Html]:
    look, (inside, edge) = shape.look, shape.opaque
    shown: dict[str, Any] = {"class_": shape.role or None, "data_of": shape.of or None}
    if shape.dot:
        for piece in shape.pieces:
            for x, y in piece:
                yield element("circle", cx=f"{x:.1f}", cy=f"{y:.1f}", r=f"{look.width / 2:g}", fill=look.edge, **shown)
        return
    path = "".join(
        "M" + "L".join(f"{x:.1f} {y:.1f}" for x, y in piece) + ("Z" if look.fill else "") for piece in shape.pieces
    )
    shown |= {"fill": look.fill or "none", "stroke": look.edge, "stroke_width": f"{look.width:g}"}
    shown |= {"fill_opacity": f"{inside:g}"} if look.fill and inside < 1 else {}
    shown |= {"stroke_opacity": f"{edge:g}"} if edge < 1 else {}
    if path:
        yield element("path", d=path, stroke_linecap="round", stroke_linejoin="round", **shown)


# -------- names -----------------------------------------------------------------------------------------------
# Names in LaTeX as text of SVG.


@dataclass(frozen=True)
class Sign:
    """A letter of a name.

    Args:
        level: 0, -1 below, 1 above the line.
        upright: it does not slope.
    """

    text: str
    level: int
    upright: bool


def _name(name: FlatName) -> Html:
    """One name in its box."""
    box, size, level = name.box, name.size, 0
    pieces = []
    for (new, upright), run in groupby(signs_of(name.text), key=lambda sign: (sign.level, sign.upright)):
        look: dict[str, Any] = {"font_style": None if upright else "italic"}
        here = SMALL if new else 1.0
        look |= {"font_size": f"{SMALL:g}em"} if new else {}
        look |= {"dy": f"{DROP * (level - new) / here:.2f}em"} if new != level else {}
        pieces.append(element("tspan", "".join(sign.text for sign in run), **look))
        level = new
    middle, base = 0.5 * (box.left + box.right), box.bottom + BASE * (box.top - box.bottom)
    look = {"font_family": FONT, "font_size": f"{size:.1f}", "fill": name.color, "text_anchor": "middle"}
    halo: dict[str, Any] = {"stroke": "#ffffff", "stroke_width": f"{HALO:g}", "paint_order": "stroke"}
    return element("text", in_a_row(*pieces), x=f"{middle:.1f}", y=f"{base:.1f}", **look, **halo)


def signs_of(text: str) -> tuple[Sign, ...]:
    r"""The letters of a name as pictures have it: "$\theta_{1}$" in mathematics, all else as it stands."""
    if not (text.startswith("$") and text.endswith("$") and len(text) > 1):
        return tuple(Sign(letter, 0, True) for letter in text.replace(r"\$", "$"))
    return tuple(_signs(iter(_MARKS.findall(text[1:-1])), 0, False))


def _signs(marks: Iterator[str], level: int, upright: bool) -> Iterator[Sign]:
    """The letters up to the end of a group."""
    here, plain, accent = level, upright, ""
    for mark in marks:
        if mark == "}":
            return
        if mark in "_^":
            here = -1 if mark == "_" else 1
            continue
        if mark[0] == "\\" and mark[1:] in COMBINED:
            accent = COMBINED[mark[1:]]
            continue
        if mark[0] == "\\" and mark[1:] in UPRIGHT:
            plain = True
            continue
        for sign in _signs(marks, here, plain) if mark == "{" else _letter(mark, here, plain):
            yield Sign(sign.text + accent, sign.level, sign.upright)
            accent = ""
        here, plain = level, upright


def _letter(mark: str, level: int, upright: bool) -> Iterator[Sign]:
    word = mark[1:] if mark.startswith("\\") else ""
    if mark.isspace() or (word and not word.isalpha() and word in ",;:! "):
        return
    text = LETTERS.get(word, word) if word else mark
    yield Sign(text, level, upright or not text.isalpha())
