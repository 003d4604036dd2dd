"""Trajectory -> pictures of it beside those over time: phase portraits, resultants of reactions, their polar curves."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from typing import Any

import numpy as np

from eomgen.documents.figures import Picture, mathtext
from eomgen.documents.plots import kinds_of_lines, notation_of_run, outputs_over_time, over_time
from eomgen.errors import RunFailed, UsageError
from eomgen.simulation.result import Trajectory
from eomgen.symbolic.expression.units import Unit

SIDE = 3.6  # of one panel [inches]
MOST = 9  # panels
LINE, START = "#336699", "#b03a2e"
ACROSS = frozenset(("x", "y", "z", "n", "t", "s"))  # components of a force: along axes that are square to one another


def run_picture(
    run: Trajectory, view: str = "time", *, title: str = "", units: Mapping[str, Unit] | None = None
) -> Picture:
    """One of the pictures of a run.

    Args:
        view: one of VIEWS.
        title: above it, the model's name.
        units: of the coordinates by name, in which they are drawn; absent: SI.
    Raises:
        UsageError: no such view.
        RunFailed: the run has nothing of the kind.
    """
    if view not in VIEWS:
        raise UsageError(f"no view '{view}' of a run", mend=f"one of {', '.join(VIEWS)}")
    return VIEWS[view](run, title, units or {})


# -- phase portraits -----------------------------------------------------------------------------------------


def _phase(run: Trajectory, title: str, units: Mapping[str, Unit]) -> Picture:
    """q' over q, a panel for each coordinate whose rate is a speed."""
    names = [q for q in run.coordinates if f"{q}'" in run.speeds][:MOST]
    if not names:
        raise RunFailed(
            "no coordinate has its rate among the speeds: there is no phase portrait", mend="draw over the time"
        )

    notation = notation_of_run(run)

    def draw(panel: Any, name: str) -> None:
        unit = units.get(name)
        size, text = (1.0, "") if unit is None else (unit.size, unit.text)
        x, y = run[name] / size, run[f"{name}'"] / size
        for phase in run.phases or ():
            rows = slice(phase.rows[0], phase.rows[1])
            panel.plot(x[rows], y[rows], color=LINE, linewidth=1.2)
        panel.plot(x[:1], y[:1], "o", color=START, markersize=4)
        panel.set_xlabel(f"${mathtext(name, notation)}$" + (f" [{text}]" if text else ""))
        panel.set_ylabel(f"${mathtext(name + chr(39), notation)}$" + (f" [{text}/s]" if text else ""))

    return _panels(names, draw, title)


# -- reactions -------------------------------------------------------------------------------------------------


def resultants(run: Trajectory) -> dict[str, np.ndarray]:
    """{joint or tie: |F|} of the forces of the run, sqrt(F_x^2 + F_y^2 + ...), where it has several components."""
    found: dict[str, list[str]] = {}
    for name in run.reactions:
        label, _, owner = name.removeprefix("reaction_").partition("(")
        if label in ACROSS and name.startswith("reaction_"):
            found.setdefault(owner.removesuffix(")"), []).append(name)
    several = {owner: names for owner, names in found.items() if len(names) > 1}
    return {owner: np.sqrt(sum(run[name] ** 2 for name in names)) for owner, names in several.items()}


def _resultants(run: Trajectory, title: str, units: Mapping[str, Unit]) -> Picture:
    """The size of each force over time."""
    curves = {owner: size for owner, size in resultants(run).items() if not np.isnan(size).all()}
    if not curves:
        raise RunFailed("no joint and no tie of the run carries a force of several components", mend="draw the outputs")

    def fill(figure: Any) -> None:
        panel = figure.subplots()
        for owner, (color, kind) in kinds_of_lines([[owner] for owner in curves], 10).items():
            look = {"color": f"C{color}", "linestyle": kind}
            panel.plot(run.t, curves[owner], label=owner.replace("$", r"\$"), linewidth=1.4, **look)
        panel.set_xlabel("$t$ [s]")
        panel.set_ylabel("size of the force [N]")
        panel.set_ylim(bottom=0)
        panel.legend(loc="center left", bbox_to_anchor=(1.0, 0.5), fontsize=8)

    return Picture((8, 3.6), fill, title)


def _polar(run: Trajectory, title: str, units: Mapping[str, Unit]) -> Picture:
    """The force of each hinge by size and direction, a curve over the run: what its bearing has to take."""
    reactions = [name.removeprefix("reaction_x(").removesuffix(")") for name in run.reactions if "reaction_x(" in name]
    hinges = [owner for owner in reactions if f"reaction_y({owner})" in run.reactions]
    hinges = [owner for owner in hinges if f"reaction_z({owner})" not in run.reactions]
    hinges = [owner for owner in hinges if not np.isnan(run[f"reaction_x({owner})"]).all()][:MOST]
    if not hinges:
        raise RunFailed("no hinge of the run carries a force in the plane", mend="draw the outputs")

    def draw(panel: Any, owner: str) -> None:
        x, y = run[f"reaction_x({owner})"], run[f"reaction_y({owner})"]
        panel.plot(np.arctan2(y, x), np.hypot(x, y), color=LINE, linewidth=1.2)
        panel.plot(np.arctan2(y[:1], x[:1]), np.hypot(x[:1], y[:1]), "o", color=START, markersize=4)
        panel.set_title(owner.replace("$", r"\$") + " [N]", fontsize=10)
        panel.set_rlabel_position(112)
        panel.tick_params(labelsize=7)

    return _panels(hinges, draw, title, projection="polar")


def _panels(names: list[str], draw: Callable[[Any, str], None], title: str, projection: str | None = None) -> Picture:
    """A panel for each name, side by side."""
    columns = math.ceil(math.sqrt(len(names)))
    rows = math.ceil(len(names) / columns)

    def fill(figure: Any) -> None:
        for k, name in enumerate(names, start=1):
            draw(figure.add_subplot(rows, columns, k, projection=projection), name)

    return Picture((SIDE * columns + 0.4, SIDE * rows + 0.3), fill, title)


VIEWS: dict[str, Callable[[Trajectory, str, Mapping[str, Unit]], Picture]] = {
    "time": over_time,
    "outputs": outputs_over_time,
    "phase": _phase,
    "resultants": _resultants,
    "polar": _polar,
}
"""what can be seen of a run, by name"""
