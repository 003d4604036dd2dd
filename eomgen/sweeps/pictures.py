"""Sweep -> pictures: results over a range, a heat map over two ranges, scatter plots of all drawn values."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Any, Protocol

import numpy as np

from eomgen.documents import Picture
from eomgen.errors import RunFailed, UsageError
from eomgen.sweeps.design import SweepPlan

MOST_LINES = 12  # in one panel
MOST_PANELS = 9
MOST_NAMES = 6  # on a side of a scatter matrix
SIDE = 3.4  # of one panel [inches]


class Drawable(Protocol):
    """Sweep as far as its pictures need it."""

    @property
    def plan(self) -> SweepPlan: ...

    @property
    def table(self) -> Mapping[str, np.ndarray]: ...

    @property
    def critical(self) -> list[dict[str, Any]]: ...

    def in_units(self) -> tuple[Mapping[str, float], Mapping[str, str]]: ...


def sweep_picture(sweep: Drawable, view: str = "") -> Picture:
    """One of the pictures of a sweep; "" is a heat map of a grid of two or more, lines of one, else the scatter matrix.

    Raises:
        UsageError: no such view.
        RunFailed: the sweep has nothing of the kind.
    """
    if not view:
        ranges = len([x for x in sweep.plan.over.values() if len(x) > 1])
        view = "scatter" if sweep.plan.random or not ranges else "lines" if ranges == 1 else "heat"
    if view not in VIEWS:
        raise UsageError(f"no view '{view}' of a sweep", fix=f"one of {', '.join(VIEWS)}")
    sizes, heads = sweep.in_units()
    table = {name: x / sizes.get(name, 1.0) if x.dtype == float else x for name, x in sweep.table.items()}
    return VIEWS[view](sweep, table, {name: _plain(heads.get(name, name)) for name in table})


def _plain(text: str) -> str:
    return text.replace("$", r"\$")


_Columns = Mapping[str, np.ndarray]


def _lines(sweep: Drawable, table: _Columns, heads: Mapping[str, str]) -> Picture:
    """Results over the first range; a line for each choice of the other ranges, draws as their mean and spread."""
    if not sweep.plan.over:
        raise RunFailed("no range is swept over: there is nothing to draw lines over", fix='--over "NAME=1:2:20"')
    names, requested, draws = list(sweep.plan.over), _requested(sweep), sweep.plan.draws
    x, *others = names

    def draw(panel: Any, name: str) -> None:
        rest = list(dict.fromkeys(zip(*(table[other].tolist() for other in others), strict=True))) if others else [()]
        for k, staying in enumerate(rest[:MOST_LINES]):
            rows = np.ones(len(table[x]), dtype=bool)
            for other, value in zip(others, staying, strict=True):
                rows &= table[other] == value
            label = ", ".join(f"{heads[other]} = {value:.4g}" for other, value in zip(others, staying, strict=True))
            _line(panel, table[x][rows], table[name][rows], draws, label, f"C{k % 10}")
        for found in sweep.critical if name == sweep.plan.critical else []:
            panel.axvline(found["value"] / (sweep.in_units()[0].get(x, 1.0)), color="#b03a2e", linewidth=0.8)
        if len(table[x]) and min(table[x]) > 0 and _is_logarithmic(sweep.plan.over[x]):
            panel.set_xscale("log")
        panel.set_xlabel(heads[x])
        panel.set_ylabel(heads[name])
        if others:
            panel.legend(fontsize=7)

    return _panels(requested, draw)


def _line(panel: Any, x: np.ndarray, y: np.ndarray, draws: int, label: str, color: str) -> None:
    if draws == 1:
        panel.plot(x, y, ".-", label=label, color=color, linewidth=1.2, markersize=3)
        return
    places = np.unique(x)
    groups = [y[(x == place) & np.isfinite(y)] for place in places]
    middle = [np.mean(each) if len(each) else np.nan for each in groups]
    low, high = ([np.quantile(each, q) if len(each) else np.nan for each in groups] for q in (0.05, 0.95))
    panel.plot(places, middle, label=label, color=color, linewidth=1.2)
    panel.fill_between(places, low, high, color=color, alpha=0.2, linewidth=0)


def _is_logarithmic(values: tuple[float, ...]) -> bool:
    """True if the steps have one ratio."""
    if len(values) < 3 or min(values) <= 0:
        return False
    ratios = np.diff(np.log(values))
    return bool(np.ptp(ratios) < 1e-3 * abs(ratios[0]) and max(values) > 3 * min(values))


def _heat(sweep: Drawable, table: _Columns, heads: Mapping[str, str]) -> Picture:
    """Each result over the first two ranges; the mean over everything else."""
    names = [name for name, values in sweep.plan.over.items() if len(values) > 1]
    if len(names) < 2:
        raise RunFailed("a heat map needs two ranges: --over twice", fix='--over "A=1:2:20" --over "B=1:2:20"')
    x, y = names[:2]

    def draw(panel: Any, name: str) -> None:
        places = [np.unique(table[axis], return_inverse=True) for axis in (x, y)]
        (columns, i), (rows, j) = places
        good = np.isfinite(table[name])
        total, count = np.zeros((len(rows), len(columns))), np.zeros((len(rows), len(columns)))
        np.add.at(total, (j[good], i[good]), table[name][good])
        np.add.at(count, (j[good], i[good]), 1)
        with np.errstate(invalid="ignore"):
            mesh = panel.pcolormesh(columns, rows, total / count, shading="nearest", cmap="viridis")
        panel.figure.colorbar(mesh, ax=panel)
        panel.grid(visible=False)
        panel.set_title(heads[name], fontsize=9)
        panel.set_xlabel(heads[x])
        panel.set_ylabel(heads[y])

    return _panels(_requested(sweep), draw)


def _scatter(sweep: Drawable, table: _Columns, heads: Mapping[str, str]) -> Picture:
    """Scatter plots of all set and requested values, their distributions on the diagonal."""
    names = [*sweep.plan.runs.names, *_requested(sweep)][:MOST_NAMES]

    def fill(figure: Any) -> None:
        panels = figure.subplots(len(names), len(names), squeeze=False)
        for i, row in enumerate(names):
            for j, column in enumerate(names):
                panel = panels[i][j]
                good = np.isfinite(table[row]) & np.isfinite(table[column])
                if i == j:
                    panel.hist(table[row][good], bins=20, color="#336699")
                else:
                    panel.plot(table[column][good], table[row][good], ".", markersize=2, color="#336699")
                panel.tick_params(labelsize=6)
                if i == len(names) - 1:
                    panel.set_xlabel(heads[column], fontsize=7)
                if j == 0:
                    panel.set_ylabel(heads[row], fontsize=7)

    return Picture((1.9 * len(names) + 0.5, 1.9 * len(names) + 0.3), fill)


def _requested(sweep: Drawable) -> list[str]:
    return list(sweep.plan.columns[-len(sweep.plan.requested) :])[:MOST_PANELS]


def _panels(names: list[str], draw: Callable[[Any, str], None]) -> Picture:
    """A panel for each name, side by side."""
    columns = int(np.ceil(np.sqrt(len(names))))
    rows = int(np.ceil(len(names) / columns))

    def fill(figure: Any) -> None:
        for k, name in enumerate(names, start=1):
            draw(figure.add_subplot(rows, columns, k), name)

    return Picture((SIDE * columns + 1.0, SIDE * rows + 0.3), fill)


VIEWS: dict[str, Callable[[Drawable, _Columns, Mapping[str, str]], Picture]] = {
    "lines": _lines,
    "heat": _heat,
    "scatter": _scatter,
}
"""views of a sweep, by name"""
