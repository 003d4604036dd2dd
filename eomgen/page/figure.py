"""Pictures of a report: a model at rest, curves over time, files next to it.

Pictures of matplotlib as figures of a report: a model at rest with its dimensions, and those of results.
"""

from __future__ import annotations

import math
import re
import tempfile
from collections import Counter
from collections.abc import Mapping, Sequence
from dataclasses import field, replace
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np

from eomgen.documents import (
    KINDS,
    OURS,
    Catalogue,
    Code,
    Picture,
    Piece,
    by_unit,
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
from eomgen.results import missing_values
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
# Trajectory -> drawings of it over time, SVG: coordinates by unit, energy, reactions; small, in the page's colours.


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
    """Coordinates over time, one drawing a unit; the energy, or its error; reactions.

    Args:
        units: of the coordinates by name, in which they are drawn; absent: SI.
    """
    found = []
    for number, (unit, names) in enumerate(by_unit(run, units).items(), start=1):
        found.append(_coordinates(run, names, unit, f"motion{number}"))
    if run.energy is not None:
        found.append(_energy(run))
    found += [
        _reactions(run, names, unit, k) for k, (unit, names) in enumerate(reactions_by_unit(run).items(), start=1)
    ]
    return tuple(found)


def _coordinates(run: Trajectory, names: Sequence[str], unit: Unit, key: str) -> ReportFigure:
    graph = Graph()
    lines = [
        Line(run[name] / unit.size, f"curve c{k % COLORS}{' d1' if k >= COLORS else ''}", (graph.symbol(name),))
        for k, name in enumerate(names[: 2 * COLORS])
    ]
    more = f"; {len(names) - len(lines)} more are not drawn" if len(names) > len(lines) else ""
    measured = f" [{unit}]" if unit.text else ""
    return panel(run, lines, key, f"Coordinates{measured} over time [s]{more}")


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
