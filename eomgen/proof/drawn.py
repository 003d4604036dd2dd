"""Figures and tables as they are saved -> checks by what stands there: of panels, structures and sweeps."""

from __future__ import annotations

import math
import re
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from functools import cached_property, partial
from itertools import product
from typing import Any

import numpy as np

from eomgen.frozen import dataclass
from eomgen.mechanics.statics import SectionForces
from eomgen.proof.check import Check, Tally, checked, first_wrong
from eomgen.symbolic.expression import Node, Scalar
from eomgen.symbolic.numeric import evaluate, fifty_digits, tolerances

# -------- drawn panels ----------------------------------------------------------------------------------------
# A figure as it is saved -> content of its panels: curves, points and names by their data, axes by their words.
#
# The drawn artists of matplotlib are read, not the dots that it makes of them.

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


# -------- drawn structure -------------------------------------------------------------------------------------
# Arrows of a structure as they are drawn, with the numbers beside them -> check: together they are in equilibrium.
#
#     sum F = 0,   sum (r x F + C) = 0        F along its arrow, of the size that is written there
#
# Of a picture nothing else is read: neither the model nor the reactions that were found.

NAME = "what is drawn on the structure holds it at rest"
HOW = "directions of the arrows and the numbers beside them"
PREFIXES = {"": 1.0, "m": 1e-3, "k": 1e3, "M": 1e6, "G": 1e9}
NUMBER = r"-?\d+(?:\.\d+)?(?:e[+-]?\d+)?"
VALUE = re.compile(rf"({NUMBER})(?: to ({NUMBER}))? ([mkMG]?)N(?: m|/m)?")


@dataclass(frozen=True)
class ReportedPush:
    """A force, a couple or a line load as it is drawn.

    Args:
        words: beside it, F = 2 kN.
        at, way: a place on its line of action and its direction, 3 each; of a line load its first arrow's, () where
            that has no length.
        turns: it is a couple.
        end: of a line load the place of its last arrow, and its direction.
    """

    words: str
    at: np.ndarray
    way: np.ndarray
    turns: bool = False
    end: tuple[np.ndarray, np.ndarray] | None = None


def structure_drawn(pushes: Iterable[ReportedPush]) -> Iterator[Check]:
    """Check of all arrows of a picture together."""
    tally, pushes = Tally(NAME, HOW), tuple(pushes)
    if pushes:
        tally.add("the structure", lambda: _unbalanced(pushes))
    return tally.checks()


def _unbalanced(pushes: Sequence[ReportedPush]) -> str:
    """Message if the forces or the couples do not vanish together; ""."""
    wrenches = [_wrench(push) for push in pushes]
    sums = np.sum([wrench for wrench, _ in wrenches], axis=0)
    sizes = np.sum([size for _, size in wrenches], axis=0)
    for what, found, size in (("forces", sums[:3], sizes[0]), ("couples", sums[3:], sizes[1])):
        if float(np.max(np.abs(found))) > tolerances.FOUR_DIGITS * size:
            return f"the {what} together are {', '.join(f'{x:.4g}' for x in found)}"
    return ""


def _wrench(push: ReportedPush) -> tuple[np.ndarray, np.ndarray]:
    """(force and moment about the origin, 6; sizes of both)"""
    first, last = _values(push.words)
    if push.end is not None:
        return _of_a_line(push, first, last)
    along = push.way / (float(np.linalg.norm(push.way)) or 1.0)
    if push.turns:
        return np.array([0, 0, 0, *(first * along)]), np.array([0, first])
    force = first * along
    return np.array([*force, *np.cross(push.at, force)]), np.array([first, first * (1 + np.linalg.norm(push.at))])


def _of_a_line(push: ReportedPush, first: float, last: float) -> tuple[np.ndarray, np.ndarray]:
    """Wrench and sizes of a load per length, linear between two places: each of its two triangles acts at its third."""
    assert push.end is not None
    (end, way), length = push.end, float(np.linalg.norm(push.end[0] - push.at))
    total, sizes = np.zeros(6), np.zeros(2)
    for value, along, share in ((first, push.way, 1 / 3), (last, way, 2 / 3)):
        size = float(np.linalg.norm(along))
        if not np.isfinite(size) or not size:
            continue
        at, force = push.at + share * (end - push.at), 0.5 * length * value / size * along
        total += np.array([*force, *np.cross(at, force)])
        sizes += np.linalg.norm(force) * np.array([1, 1 + np.linalg.norm(at)])
    return total, sizes


def _values(words: str) -> tuple[float, float]:
    """The value that is written beside an arrow, at both ends of a line load."""
    number = words.rpartition(" = ")[2]
    found = VALUE.fullmatch(number)
    if found is None:
        return 0.0, 0.0
    size = PREFIXES[found[3]]
    return size * float(found[1]), size * float(found[2] or found[1])


# -------- beams in space --------------------------------------------------------------------------------------
# Diagrams of beams in space as they are drawn -> check: each place of a curve is what acts behind the section.
#
#     N, V_y, V_z = R . (t, e_y, e_z),   T, M_y, M_z = T . (t, e_y, e_z)        R, T: of all that acts behind x, about x
#
# The forces are summed from the other end than where they were found; line loads by Simpson's rule, exact for them.


SECTIONS = "drawn section forces in space are right"
HOW_SECTIONS = "curves and numbers of the picture, from the other end"


def space_sections_drawn(
    values: Mapping[Node, Any], sections: Mapping[str, SectionForces], panels: Iterable[DrawnPanel]
) -> Iterator[Check]:
    """Check of every panel of components of a beam in space.

    Args:
        values: of all symbols, with 50 digits.
    """
    tally = Tally(SECTIONS, HOW_SECTIONS)
    for panel in panels:
        what, unit = said_of(panel.y)
        kinds, _, body = what.partition(" of ")
        names = kinds.split(", ")
        if body in sections and set(names) <= set(sections[body].kinds):
            beam = _Beam(values, sections[body])
            tally.add(what, partial(beam.wrong, names, panel, PREFIXES[unit.partition("N")[0]]))
    yield from tally.checks()


@dataclass(frozen=True)
class _Beam:
    values: Mapping[Node, Any]
    sections: SectionForces

    def numbers(self, v: Sequence[Scalar]) -> np.ndarray:
        return np.array([float(x) for x in evaluate(tuple(v), self.values, fifty_digits())])

    def one(self, x: Scalar) -> float:
        return float(self.numbers((x,))[0])

    @cached_property
    def _actions(self) -> list[tuple[float, np.ndarray, np.ndarray, np.ndarray]]:
        """(x, place, force, couple) of all that acts at places."""
        axis, acting = self.sections.axis, self.sections.loads.actions
        return [(self._x(axis.distance(p)), self.numbers(p), self.numbers(f), self.numbers(c)) for p, f, c in acting]

    @cached_property
    def _spreads(self) -> list[tuple[Any, ...]]:
        """The loads per length, (start, end, at the start, at the end) each."""
        return list(self.sections.loads.spreads)

    def _x(self, x: Scalar | None) -> float:
        return 0.0 if x is None else self.one(x)

    def behind(self, x: float, section: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Resultant, and moment about the section, of all that acts beyond x."""
        R, T = np.zeros(3), np.zeros(3)
        for at, place, force, couple in self._actions:
            if at > x:
                R, T = R + force, T + couple + np.cross(place - section, force)
        for start, end, at_start, at_end in self._spreads:
            a, b = (self._x(self.sections.axis.distance(place)) for place in (start, end))
            p, q, f, g = map(self.numbers, (start, end, at_start, at_end))
            if a > b:
                a, b, p, q, f, g = b, a, q, p, g, f
            first = min(max((x - a) / (b - a), 0.0), 1.0)
            for part, weight in ((first, 1), ((first + 1) / 2, 4), (1.0, 1)):
                force = weight * (1 - first) * (b - a) / 6 * (f + part * (g - f))
                R, T = R + force, T + np.cross(p + part * (q - p) - section, force)
        return R, T

    def wrong(self, names: Sequence[str], panel: DrawnPanel, unit: float) -> str:
        """Message if a curve, or a number beside one, differs; ""."""
        pieces = self.sections.pieces
        if panel.hidden or panel.is_turned or len(panel.curves) != len(pieces) * len(names):
            return "other curves are drawn, or hidden"
        largest = max(float(np.max(np.abs(curve.places[:, 1]))) for curve in panel.curves)
        for k, curve in enumerate(panel.curves):
            piece, name = pieces[k % len(pieces)], names[k // len(pieces)]
            start, end = self.one(piece.start), self.one(piece.end)
            x, y = curve.places[1:-1].T
            if abs(x[0] - start) + abs(x[-1] - end) > tolerances.SAME_PLACE * (1 + abs(end)):
                return f"drawn from {x[0]:.6g} to {x[-1]:.6g}, not from {start:.6g} to {end:.6g}"
            origin, x0 = self.numbers(piece.leg.start), self.one(piece.leg.x)
            axes = [self.numbers(e) for e in self.sections.triad(piece)]
            near = tolerances.COMPUTED * (end - start)
            for at, value in zip(x, y, strict=True):
                inside = min(max(at, start + near), end - near)
                R, T = self.behind(inside, origin + (inside - x0) * axes[0])
                vector, axis = (
                    (T, ("T", "M_y", "M_z").index(name))
                    if name in ("T", "M_y", "M_z")
                    else (
                        R,
                        ("N", "V_y", "V_z").index(name),
                    )
                )
                right = float(vector @ axes[axis]) / unit
                if abs(value - right) > tolerances.CARRIED * (1 + abs(largest) + abs(right)):
                    return f"{name} at x = {at:.6g} {value:.6g} for {right:.6g}"
        return _misnamed(panel)


def _misnamed(panel: DrawnPanel) -> str:
    """Message if a number beside a place is another than its height; ""."""
    for text, place in panel.names:
        if abs(float(text) - place[1]) > tolerances.FOUR_DIGITS * abs(place[1]):
            return f"{text} stands at {place[1]:.6g}"
    return ""


# -------- drawn values ----------------------------------------------------------------------------------------
# Rows of a sweep, its ranges and laws -> checks of the values set, and of the statements on all runs, in doubles.
#
#     F(value) = u    u of the run's seed by SplitMix64 (random), one in each stratum (Latin hypercube), one in each of
#                     2^k intervals (the first 2^k of a Sobol sequence)
#
# F is the cumulative distribution function; ranges are counted out run after run.

EVERY_RUN = "floating point, every run"
MASK = 2**64 - 1
SHARES: Mapping[str, Callable[..., float]] = {  # of all that lie below a value
    "normal": lambda x, mean, deviation: math.erfc((mean - x) / (deviation * math.sqrt(2))) / 2,
    "uniform": lambda x, low, high: (x - low) / (high - low),
    "loguniform": lambda x, low, high: math.log(x / low) / math.log(high / low),
    "lognormal": lambda x, median, deviation: math.erfc(math.log(median / x) / (deviation * math.sqrt(2))) / 2,
    "triangular": lambda x, low, mode, high: _triangle(x, low, mode, high),
}
Law = tuple[str, str, tuple[float, ...]]  # of a name: which, its arguments


def _triangle(x: float, low: float, mode: float, high: float) -> float:
    if x < mode:
        return (x - low) ** 2 / ((high - low) * (mode - low))
    return 1 - (high - x) ** 2 / ((high - low) * (high - mode))


def drawn_otherwise(
    over: Mapping[str, Sequence[float]], laws: Sequence[Law], draws: int, design: str, rows: Sequence[Sequence[Any]]
) -> Check:
    """Check that the values set in each run are of their ranges and laws.

    Args:
        draws: at each point of the ranges.
        rows: (number, seed, what is set) of each run that is done.
    """
    wrong = (*_ranges(over, draws, rows), *_draws(len(over), laws, draws, design, rows))
    return checked("values set in each run are of their ranges and laws", first_wrong(wrong), EVERY_RUN)


def _ranges(over: Mapping[str, Sequence[float]], draws: int, rows: Sequence[Sequence[Any]]) -> Iterator[str]:
    points = list(product(*over.values()))
    for number, _, *values in rows:
        due = points[number // draws]
        same = all(abs(x - y) <= tolerances.COMPUTED * abs(y) for x, y in zip(values, due, strict=False))
        yield "" if same else f"run {number} is not at {due}"


def _draws(first: int, laws: Sequence[Law], draws: int, design: str, rows: Sequence[Sequence[Any]]) -> Iterator[str]:
    blocks: dict[int, list[Sequence[Any]]] = {}
    for row in rows:
        blocks.setdefault(row[0] // draws, []).append(row)
    for block in blocks.values():
        for k, (name, law, arguments) in enumerate(laws):
            shares = [SHARES[law](row[2 + first + k], *arguments) for row in block]
            chances = [_chance(row[1], k + 1) for row in block]
            if design == "random":
                yield from (
                    f"'{name}' of run {row[0]} is not by its seed" * (abs(u - v) > tolerances.CARRIED)
                    for row, u, v in zip(block, shares, chances, strict=True)
                )
            elif len(block) == draws:
                many = draws if design == "lhs" else 2 ** (draws.bit_length() - 1)
                strata = sorted(math.floor(u * many) for u in shares[:many])
                yield "" if strata == list(range(many)) else f"'{name}' is not spread as '{design}' says"


def _chance(seed: int, k: int) -> float:
    """The k-th number between 0 and 1 of SplitMix64 begun at a seed, by whole numbers."""
    z = (seed + k * 0x9E3779B97F4A7C15) & MASK
    z = ((z ^ (z >> 30)) * 0xBF58476D1CE4E5B9) & MASK
    z = ((z ^ (z >> 27)) * 0x94D049BB133111EB) & MASK
    return ((z ^ (z >> 31)) // 2**11 + 0.5) / 2**53


def reported_of_all(
    columns: Mapping[str, Sequence[float | None]],
    summary: Mapping[str, Sequence[float | None]],
    remarks: Sequence[str],
    critical: str,
    fine: float,
    requested: Sequence[str],
) -> Check:
    """Check of count, least, mean and largest value of each column, and of the columns reported the same in all runs.

    Args:
        columns: values set and requested, by name, one a run.
        summary: reported count, least, mean and largest value of each.
        critical: name of the column that must change its sign; "" for none.
        fine: share of the largest value that counts as no change.
        requested: columns for which it is reported where they are the same in all runs.
    """
    wrong = (
        *(_summed(name, columns[name], reported) for name, reported in summary.items()),
        *(_remarked(name, columns[name], remarks, name == critical, fine) for name in requested),
    )
    return checked("statements on all runs are those of their rows", first_wrong(wrong), EVERY_RUN)


def _summed(name: str, column: Sequence[float | None], reported: Sequence[float | None]) -> str:
    values = [x for x in column if x is not None]
    due = [len(values), *((min(values), math.fsum(values) / len(values), max(values)) if values else (None,) * 3)]
    pairs = zip(reported, due, strict=True)
    same = all(x == y if x is None or y is None else abs(x - y) <= tolerances.COMPUTED * (1 + abs(y)) for x, y in pairs)
    return "" if same else f"'{name}': {list(reported)} for {due}"


def _remarked(name: str, column: Sequence[float | None], remarks: Sequence[str], critical: bool, fine: float) -> str:
    """Message if "is ... in all runs" or "goes from" is reported of the wrong column; ""."""
    values = [x for x in column if x is not None]
    reported = any(f"'{name}' is " in x and " in all runs" in x for x in remarks)
    if len(values) < 2:
        return f"'{name}' has no value to be the same" if reported else ""
    same = max(values) - min(values) <= fine * max(map(abs, values))
    wanted = same and not (critical and min(values) < 0 < max(values))
    return "" if reported == wanted else f"'{name}' goes from {min(values):.9g} to {max(values):.9g}"
