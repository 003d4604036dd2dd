"""Pictures in files, and of runs over time.

A picture in a file: its look, its formats, names as matplotlib sets them.
"""

from __future__ import annotations

import io
import math
import warnings
from collections.abc import Callable, Iterable, Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np

from eomgen import files
from eomgen.documents.document import notation_of
from eomgen.documents.languages import OURS, Catalogue
from eomgen.errors import RunFailed, UsageError, visible
from eomgen.frozen import dataclass
from eomgen.model import OUTPUT, Model, Unit
from eomgen.proof import DrawnPanel, panels_of
from eomgen.simulation import Trajectory
from eomgen.symbolic.numeric import tolerances
from eomgen.symbolic.print import Notation

FORMATS = (".png", ".svg", ".pdf")
STYLE: dict[Any, Any] = {
    "axes.spines.top": False,
    "axes.spines.right": False,
    "axes.grid": True,
    "grid.color": "#e6e6e6",
    "grid.linewidth": 0.8,
    "axes.edgecolor": "#808080",
    "xtick.color": "#505050",
    "ytick.color": "#505050",
    "font.size": 10,
    "mathtext.fontset": "cm",
    "legend.frameon": False,
    "svg.hashsalt": "eomgen",
}


@dataclass(frozen=True)
class Picture:
    """A picture that is drawn when it is saved, or shown in a notebook.

    Args:
        size: width and height [inches].
        fill: puts panels into the matplotlib figure.
        title: above the picture, the model's name.
        language: of the words in it.
    """

    size: tuple[float, float]
    fill: Callable[[Any], None]
    title: str = ""
    language: Catalogue = OURS

    def save(self, path: str | Path) -> None:
        """Draw it into a PNG, SVG or PDF file; the ending says which.

        Raises:
            UsageError: another ending.
            WriteFailed: the file cannot be written; the old file is then unchanged.
        """
        self.saved(path)

    def saved(self, path: str | Path) -> tuple[DrawnPanel, ...]:
        """`save`, and the content of the panels of the figure in the file."""
        path = Path(path)
        if path.suffix.lower() not in FORMATS:
            raise UsageError(f"no picture can be written as '{path.name}'", fix=f"endings are {', '.join(FORMATS)}")
        form = path.suffix.lower()
        undated = {".svg": {"Date": None}, ".pdf": {"CreationDate": None}}.get(form, {})
        page = io.BytesIO()
        panels: list[DrawnPanel] = []

        def keep(figure: Any) -> None:
            figure.savefig(page, format=form[1:], dpi=150, metadata=undated)
            panels.extend(panels_of(figure))

        self._drawn(keep)
        files.write(path, page.getvalue())
        return tuple(panels)

    def _drawn(self, keep: Callable[[Any], object]) -> None:
        """Draw it, and keep it while the style of its numbers and letters holds."""
        from matplotlib import rc_context
        from matplotlib.backends.backend_agg import FigureCanvasAgg
        from matplotlib.figure import Figure

        with rc_context(STYLE), warnings.catch_warnings():
            warnings.filterwarnings("ignore", "Glyph")  # of a letter that the font lacks: it is drawn as a box
            figure = Figure(figsize=self.size, layout="constrained")
            FigureCanvasAgg(figure)
            self.fill(figure)
            if self.language is not OURS:
                _say_in(self.language, figure)
            if self.title:
                title = visible(self.title).replace("$", r"\$")
                figure.suptitle(title, fontsize=12, fontweight="bold", x=0.01, ha="left", wrap=True)
            keep(figure)

    def __repr__(self) -> str:
        width, height = self.size
        return f"<picture{f' of {self.title!r}' if self.title else ''}, {width:.3g} x {height:.3g} inches>"

    @property
    def svg(self) -> str:
        """The picture as the text of an SVG file."""
        page = io.BytesIO()
        self._drawn(lambda figure: figure.savefig(page, format="svg", metadata={"Date": None}))
        return page.getvalue().decode()

    def _repr_png_(self) -> bytes:
        page = io.BytesIO()
        self._drawn(lambda figure: figure.savefig(page, format="png", dpi=100))
        return page.getvalue()


def _say_in(language: Catalogue, figure: Any) -> None:
    """Put the words of a figure into a language, and decimal commas behind its digits where it has them."""
    from matplotlib.text import Text
    from matplotlib.ticker import Formatter

    for text in figure.findobj(Text):
        text.set_text(language.say(text.get_text()))
    for panel in figure.axes if language.comma else ():
        for axis in (panel.xaxis, panel.yaxis):
            axis.get_major_formatter().fix_minus = lambda number: Formatter.fix_minus(number).replace(".", ",")


def mathtext(name: str, notation: Notation | None = None) -> str:
    r"""A name as matplotlib sets it: theta1' -> \dot{\theta}_{1}, x_left -> x_{\mathrm{left}}."""
    return (notation or Notation()).latex(name).replace(r"\_", r"\ ")


def halo() -> list[Any]:
    """A white edge round letters, so that they can be read over lines: `path_effects` of a text."""
    from matplotlib.patheffects import withStroke

    return [withStroke(linewidth=2.5, foreground="white")]


PREFIXES = ((1e9, "G"), (1e6, "M"), (1e3, "k"), (1.0, ""), (1e-3, "m"))
ROOMY = 10.0  # a prefix is used from so many of its units on
FIGURES = 4


@dataclass(frozen=True)
class Scale:
    """The unit in which the forces of a picture are written, and those of couples with it.

    Args:
        factor: of the prefix.
        prefix: "k" of kN.
    """

    factor: float = 1.0
    prefix: str = ""

    @staticmethod
    def of(values: Iterable[float]) -> Scale:
        """The scale for the largest of some values: kN from 10 kN on; units without prefix where all are 0."""
        largest = max((abs(value) for value in values), default=0.0)
        if not largest or ROOMY > largest >= 0.1:
            return Scale()
        return next((Scale(*pair) for pair in PREFIXES if largest >= ROOMY * pair[0]), Scale(*PREFIXES[-1]))

    def __call__(self, value: float) -> float:
        """A value in SI, in these units."""
        return value / self.factor

    def unit(self, unit: str) -> str:
        """kN of N, kN m of N m."""
        return self.prefix + unit

    def number(self, value: float) -> str:
        """A value in SI as its number in these units."""
        return four_figures(self(value))

    def text(self, value: float, unit: str) -> str:
        """A value in SI as "41.93 kN"."""
        return f"{self.number(value)} {self.unit(unit)}"


def four_figures(value: float) -> str:
    """A number with four figures, without a power of ten where it has less than eight digits: 12340, 0.05."""
    text = f"{value:.{FIGURES}g}"
    return f"{float(text):.10f}".rstrip("0").rstrip(".") if tolerances.SMALLEST_PLAIN <= abs(value) < 1e8 else text


# -------- plots -----------------------------------------------------------------------------------------------
# Trajectory -> a picture of it: coordinates and states over time, one panel a unit, the error of the energy, reactions.


PLAIN = Unit("")
MOST_IN_LEGEND = 12
MOST_REACTIONS = 10  # lines in one panel
UNITS_OF_REACTIONS = {"N": "N", "N*m": r"N$\,$m"}
KINDS = ("-", "--", ":", "-.")  # of lines of one colour
DASHES = {"x": "-", "y": "--", "z": ":", "n": "-", "t": "-.", "s": ":", "tension": "-", "couple": "--", "drive": ":"}


def over_time(trajectory: Trajectory, title: str, units: Mapping[str, Unit]) -> Picture:
    """Coordinates over time, one panel a unit, states of first order alike, the error of the energy, reactions.

    Args:
        title: above the picture, the model's name.
        units: of coordinates and states by name, in which they are drawn; absent: SI, and none is printed.
    """
    groups = [*by_unit(trajectory.coordinates, units).items(), *by_unit(trajectory.states, units).items()]
    reactions = reactions_by_unit(trajectory)
    count = len(groups) + (trajectory.energy is not None) + len(reactions)

    def fill(figure: Any) -> None:
        panels = figure.subplots(max(count, 1), 1, sharex=True, squeeze=False)[:, 0]
        for panel, (unit, names) in zip(panels, groups, strict=False):
            _of_state(panel, trajectory, names, unit)
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
            "the run has no outputs: the model requests none that is a function of the state",
            fix="ask for one in [outputs], or draw coordinates",
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
            _curves(panel, trajectory.t, curves, unit, notation_of_run(trajectory))
        panels[-1].set_xlabel("$t$ [s]")
        panels[-1].margins(x=0.01)
        figure.align_ylabels(panels)

    return Picture((8, 1.0 + 2.1 * len(groups)), fill, title)


def _model_of(run: Trajectory) -> Model | None:
    """The model whose motion it is; None where the run has none."""
    known = run.phases[0].model if run.phases else None
    return None if known is None else known.declared.scope.model


def notation_of_run(run: Trajectory) -> Notation:
    """Notation that the model of a run declares, for its outputs too; the default where the run has no model."""
    model = _model_of(run)
    if model is None:
        return Notation()
    tables = (model.parameters, model.coordinates, model.speeds, model.states, model.inputs)
    others = {name for table in tables for name in table}
    own = {name: each.symbol for name, each in model.outputs.items() if each.symbol and name not in others}
    return notation_of(model).with_symbols(own)


def heads_in_symbols(run: Trajectory) -> dict[str, str]:
    r"""{column of a run: its name as formulas have it, "$\varphi$"}; energy and reactions keep their names."""
    notation, named = notation_of_run(run), ("t", *run.coordinates, *run.speeds, *run.states, *run.outputs)
    return {name: f"${notation.latex(name)}$" for name in run.columns() if name in named}


def by_unit(names: Iterable[str], units: Mapping[str, Unit]) -> dict[Unit, list[str]]:
    """Names that have each unit."""
    groups: dict[Unit, list[str]] = {}
    for name in names:
        groups.setdefault(units.get(name, PLAIN), []).append(name)
    return groups


def _of_state(panel: Any, trajectory: Trajectory, names: list[str], unit: Unit) -> None:
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
    _without_noise(panel, curves.values())
    shown = ", ".join(labels) if len(labels) <= 3 else f"{labels[0]}, …, {labels[-1]}"
    panel.set_ylabel(f"{shown} [{unit}]" if unit.text else shown)
    if len(names) > 1 and few:
        panel.legend(loc="center left", bbox_to_anchor=(1.0, 0.5))


LEAST = 1e-3  # m, rad: noise is what is small beside so much, where a coordinate is smaller


def range_without_noise(curves: Iterable[np.ndarray], size: float | None = None) -> tuple[float, float] | None:
    """Range of an axis in which the noise of curves that stay constant is not seen; None: one of them changes.

    Args:
        size: what is large beside them, in their unit; None: a thousandth of it.
    """
    finite = [x[np.isfinite(x)] for x in curves]
    spans = [(float(x.min()), float(x.max())) for x in finite if len(x)]
    size = LEAST if size is None else size
    size = max(size, *(abs(end) for span in spans for end in span)) if spans else size
    if not spans or any(high - low > tolerances.RUN * size for low, high in spans):
        return None
    return min(low for low, _ in spans) - size / 2, max(high for _, high in spans) + size / 2


def _without_noise(panel: Any, curves: Iterable[np.ndarray], size: float | None = None) -> None:
    if (ends := range_without_noise(curves, size)) is not None:
        panel.set_ylim(*ends)


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
    """{unit: reactions that have a value at some instant}; units whose reactions are all 0 but for rounding are left
    out."""
    groups: dict[str, list[str]] = {}
    for name, column in trajectory.reactions.items():
        if not np.isnan(column).all():
            groups.setdefault(trajectory.units.get(name, ""), []).append(name)
    seen = tolerances.RUN * largest_reaction(trajectory)
    return {unit: names for unit, names in groups.items() if any(_size(trajectory, name) > seen for name in names)}


def largest_reaction(trajectory: Trajectory) -> float:
    """Size of the largest of its reactions, of any unit; 0.0 where there is none."""
    columns = [column for column in trajectory.reactions.values() if not np.isnan(column).all()]
    return max((float(np.nanmax(np.abs(column))) for column in columns), default=0.0)


def _size(trajectory: Trajectory, name: str) -> float:
    return float(np.nanmax(np.abs(trajectory.reactions[name])))


def _reactions(panel: Any, trajectory: Trajectory, names: list[str], unit: str) -> None:
    """One colour a joint or constraint, one kind of line a component; of many the largest."""
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
    _without_noise(panel, map(trajectory.reactions.__getitem__, names), largest_reaction(trajectory))
    panel.set_ylabel(f"reactions [{UNITS_OF_REACTIONS.get(unit, unit)}]")
    panel.legend(loc="center left", bbox_to_anchor=(1.0, 0.5), fontsize=8)
    if len(shown) < len(owners):
        words = f"the largest, at {len(shown)} of {len(owners)} joints and constraints"
        panel.annotate(
            words, (1.0, 1.02), xycoords="axes fraction", ha="right", va="bottom", fontsize=9, color="#505050"
        )


def largest_reactions(trajectory: Trajectory, owners: Mapping[str, list[str]]) -> list[str]:
    """The joints and constraints with the largest reactions, as many as have their lines in one panel; in their
    order."""
    size = {owner: max(_size(trajectory, name) for name in names) for owner, names in owners.items()}
    falling = sorted(owners, key=lambda owner: -size[owner])
    lines = np.cumsum([len(owners[owner]) for owner in falling])
    kept = falling[: max(1, int(np.searchsorted(lines, MOST_REACTIONS, side="right")))]
    return [owner for owner in owners if owner in kept]


def kinds_of_lines(owned: Sequence[Sequence[str]], colors: int) -> dict[str, tuple[int, str]]:
    """{reaction: (number of its colour, kind of its line)}: a colour an owner, a kind a component, no two alike.

    Where that look is taken, by the other string of one constraint, say, it is the owner's next kind, then that of a
    colour which nobody has.

    Args:
        owned: the reactions of each joint or constraint.
        colors: their number.
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


# -------- run pictures ----------------------------------------------------------------------------------------
# Trajectory -> further pictures of it: phase portraits, resultants of reactions, their polar curves.


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
        units: of its columns by name, in which they are drawn; absent: SI. None: those of its model.
    Raises:
        UsageError: no such view.
        RunFailed: the run has nothing of the kind.
    """
    if view not in VIEWS:
        raise UsageError(f"no view '{view}' of a run", fix=f"one of {', '.join(VIEWS)}")
    if units is None and (model := _model_of(run)) is not None:
        units = model.units_of(run.columns())
    return VIEWS[view](run, title, units or {})


# -- phase portraits -----------------------------------------------------------------------------------------


def _phase(run: Trajectory, title: str, units: Mapping[str, Unit]) -> Picture:
    """q' over q, a panel for each coordinate whose rate is a speed."""
    names = [q for q in run.coordinates if f"{q}'" in run.speeds][:MOST]
    if not names:
        raise RunFailed(
            "no coordinate has its rate among the speeds: there is no phase portrait", fix="draw over the time"
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
    """{joint or constraint: |F|} of the forces of the run, sqrt(F_x^2 + F_y^2 + ...), where it has several
    components."""
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
        raise RunFailed(
            "no joint and no constraint of the run carries a force of several components",
            fix="draw another view: time, outputs or phase",
        )

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
    """The force of each hinge by size and direction, a curve over the run: the load of its bearing."""
    reactions = [name.removeprefix("reaction_x(").removesuffix(")") for name in run.reactions if "reaction_x(" in name]
    hinges = [owner for owner in reactions if f"reaction_y({owner})" in run.reactions]
    hinges = [owner for owner in hinges if f"reaction_z({owner})" not in run.reactions]
    hinges = [owner for owner in hinges if not np.isnan(run[f"reaction_x({owner})"]).all()][:MOST]
    if not hinges:
        raise RunFailed("no hinge of the run carries a force in the plane", fix="draw the outputs")

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
