"""Trajectory -> a picture of it: coordinates over time, one panel a unit, how well the energy was kept, reactions."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np

from eomgen.documents.figures import Picture, mathtext
from eomgen.documents.latex_names import Notation, notation_of
from eomgen.errors import RunFailed
from eomgen.model.own_units import OUTPUT
from eomgen.simulation.result import Trajectory
from eomgen.symbolic.expression.units import Unit

PLAIN = Unit("")
MOST_IN_LEGEND = 12
MOST_REACTIONS = 10  # lines in one panel
UNITS_OF_REACTIONS = {"N": "N", "N*m": r"N$\,$m"}
KINDS = ("-", "--", ":", "-.")  # of lines of one colour
DASHES = {"x": "-", "y": "--", "z": ":", "n": "-", "t": "-.", "s": ":", "tension": "-", "couple": "--", "drive": ":"}


def over_time(trajectory: Trajectory, title: str, units: Mapping[str, Unit]) -> Picture:
    """Coordinates over time, one panel a unit, how well the energy was kept, reactions.

    Args:
        title: above the picture, the model's name.
        units: of the coordinates by name, in which they are drawn; absent: SI, and none is printed.
    """
    groups = by_unit(trajectory, units)
    reactions = reactions_by_unit(trajectory)
    count = len(groups) + (trajectory.energy is not None) + len(reactions)

    def fill(figure: Any) -> None:
        panels = figure.subplots(max(count, 1), 1, sharex=True, squeeze=False)[:, 0]
        for panel, (unit, names) in zip(panels, groups.items(), strict=False):
            _coordinates(panel, trajectory, names, unit)
        if trajectory.energy is not None:
            _energy(panels[len(groups)], trajectory)
        for panel, (kind, alike) in zip(panels[count - len(reactions) :], reactions.items(), strict=False):
            _reactions(panel, trajectory, alike, kind)
        panels[-1].set_xlabel("$t$ [s]")
        panels[-1].margins(x=0.01)
        figure.align_ylabels(panels)

    return Picture((8, 1.0 + 2.1 * max(count, 1)), fill, title)


def outputs_over_time(trajectory: Trajectory, title: str, units: Mapping[str, Unit]) -> Picture:
    """Outputs over time, one panel a unit.

    Raises:
        RunFailed: the run has none.
    """
    if not trajectory.outputs:
        raise RunFailed(
            "the run has no outputs: the model asks none that is a function of the state",
            mend="ask for one in [outputs], or draw coordinates",
        )
    columns = trajectory.columns()
    named = {
        name: name if name in columns and columns[name] is y else f"{name}{OUTPUT}"
        for name, y in trajectory.outputs.items()
    }
    groups: dict[Unit, list[str]] = {}
    for name, column in named.items():
        groups.setdefault(units.get(column, PLAIN), []).append(name)

    def fill(figure: Any) -> None:
        panels = figure.subplots(len(groups), 1, sharex=True, squeeze=False)[:, 0]
        for panel, (unit, names) in zip(panels, groups.items(), strict=True):
            curves = {name: trajectory.outputs[name] / unit.size for name in names}
            _curves(panel, trajectory.t, curves, unit, Notation())
        panels[-1].set_xlabel("$t$ [s]")
        panels[-1].margins(x=0.01)
        figure.align_ylabels(panels)

    return Picture((8, 1.0 + 2.1 * len(groups)), fill, title)


def notation_of_run(run: Trajectory) -> Notation:
    """What the model of a run declares of its names; nothing where nobody knows it."""
    known = run.phases[0].model if run.phases else None
    return Notation() if known is None else notation_of(known.declared.scope.model)


def by_unit(trajectory: Trajectory, units: Mapping[str, Unit]) -> dict[Unit, list[str]]:
    """The coordinates of each unit."""
    groups: dict[Unit, list[str]] = {}
    for name in trajectory.coordinates:
        groups.setdefault(units.get(name, PLAIN), []).append(name)
    return groups


def _coordinates(panel: Any, trajectory: Trajectory, names: list[str], unit: Unit) -> None:
    curves = {name: trajectory[name] / unit.size for name in names}
    _curves(panel, trajectory.t, curves, unit, notation_of_run(trajectory))


def _curves(panel: Any, t: np.ndarray, curves: Mapping[str, np.ndarray], unit: Unit, notation: Notation) -> None:
    from matplotlib import colormaps

    names = list(curves)
    few = len(names) <= MOST_IN_LEGEND
    colors = (
        colormaps["tab10"](np.arange(10))
        if len(names) <= 10
        else colormaps["viridis"](np.linspace(0, 0.92, len(names)))
    )
    labels = [f"${mathtext(name, notation)}$" for name in names]
    for name, label, color in zip(names, labels, colors, strict=False):
        panel.plot(t, curves[name], label=label, color=color, linewidth=1.6 if few else 1.0)
    shown = ", ".join(labels) if len(labels) <= 3 else f"{labels[0]}, …, {labels[-1]}"
    panel.set_ylabel(f"{shown} [{unit}]" if unit.text else shown)
    if len(names) > 1 and few:
        panel.legend(loc="center left", bbox_to_anchor=(1.0, 0.5))


def _energy(panel: Any, trajectory: Trajectory) -> None:
    """E - E(0) where energy should stay, else E."""
    energy = trajectory.energy
    assert energy is not None
    if trajectory.drift is None:
        panel.plot(trajectory.t, energy, color="#444444", linewidth=1.4)
        panel.set_ylabel("$E$ [J]")
        return
    panel.plot(trajectory.t, energy - energy[:1], color="#b03a2e", linewidth=1.2)
    panel.axhline(0, color="#808080", linewidth=0.8)
    panel.ticklabel_format(axis="y", style="sci", scilimits=(-2, 2))
    panel.set_ylabel("$E - E(0)$ [J]")
    within = " in each phase" if len(trajectory.phases) > 1 else ""
    panel.annotate(
        f"relative drift {trajectory.drift:.1e}{within}",
        (1.0, 1.02),
        xycoords="axes fraction",
        ha="right",
        va="bottom",
        fontsize=9,
        color="#505050",
    )


def reactions_by_unit(trajectory: Trajectory) -> dict[str, list[str]]:
    """Those that have a value at some instant; of a unit of which all are 0, none."""
    groups: dict[str, list[str]] = {}
    for name, column in trajectory.reactions.items():
        if not np.isnan(column).all():
            groups.setdefault(trajectory.units.get(name, ""), []).append(name)
    return {unit: names for unit, names in groups.items() if any(_size(trajectory, name) > 0 for name in names)}


def _size(trajectory: Trajectory, name: str) -> float:
    return float(np.nanmax(np.abs(trajectory.reactions[name])))


def _reactions(panel: Any, trajectory: Trajectory, names: list[str], unit: str) -> None:
    """One colour a joint or tie, one kind of line a component; of many the largest."""
    from matplotlib import colormaps

    owners: dict[str, list[str]] = {}
    for name in names:
        owners.setdefault(owner_of(name), []).append(name)
    shown = largest_reactions(trajectory, owners)
    colors = colormaps["tab10"](np.arange(10))
    for name, (color, kind) in kinds_of_lines([owners[owner] for owner in shown], len(colors)).items():
        panel.plot(
            trajectory.t,
            trajectory.reactions[name],
            label=f"{owner_of(name)}: {component_of(name)}".replace("$", r"\$"),
            color=colors[color],
            linewidth=1.4,
            linestyle=kind,
        )
    panel.set_ylabel(f"reactions [{UNITS_OF_REACTIONS.get(unit, unit)}]")
    panel.legend(loc="center left", bbox_to_anchor=(1.0, 0.5), fontsize=8)
    if len(shown) < len(owners):
        words = f"the largest, at {len(shown)} of {len(owners)} joints and ties"
        panel.annotate(
            words, (1.0, 1.02), xycoords="axes fraction", ha="right", va="bottom", fontsize=9, color="#505050"
        )


def largest_reactions(trajectory: Trajectory, owners: Mapping[str, list[str]]) -> list[str]:
    """The joints and ties with the largest reactions, as many as have their lines in one panel; in their order."""
    size = {owner: max(_size(trajectory, name) for name in names) for owner, names in owners.items()}
    falling = sorted(owners, key=lambda owner: -size[owner])
    lines = np.cumsum([len(owners[owner]) for owner in falling])
    kept = falling[: max(1, int(np.searchsorted(lines, MOST_REACTIONS, side="right")))]
    return [owner for owner in owners if owner in kept]


def kinds_of_lines(owned: Sequence[Sequence[str]], colors: int) -> dict[str, tuple[int, str]]:
    """{reaction: (number of its colour, kind of its line)}: a colour an owner, a kind a component, no two alike.

    Where that look is taken, by the other string of one tie, say, it is the owner's next kind, then that of a colour
    which nobody has.

    Args:
        owned: the reactions of each joint or tie.
        colors: how many there are.
    """
    found: dict[str, tuple[int, str]] = {}
    for k, names in enumerate(owned):
        for name in names:
            words = reversed(component_of(name).split(" "))
            usual = next((DASHES[word] for word in words if word in DASHES), KINDS[0])
            those = [k % colors, *range(len(owned), colors), *range(colors)]
            looks = [(color, kind) for color in those for kind in (usual, *KINDS)]
            found[name] = next((look for look in looks if look not in found.values()), looks[0])
    return found


def owner_of(name: str) -> str:
    """reaction_x(B.II) -> B.II; tension(rope, 2) -> rope."""
    return name.partition("(")[2].rstrip(")").partition(",")[0]


def component_of(name: str) -> str:
    """reaction_couple_x(B) -> couple x; tension(rope, 2) -> tension 2."""
    head, _, arguments = name.partition("(")
    number = arguments.rstrip(")").partition(",")[2].strip()
    return " ".join(word for word in (head.removeprefix("reaction_").replace("_", " "), number) if word)
