"""A picture in a file: its look, its formats, names as matplotlib sets them."""

from __future__ import annotations

import io
import warnings
from collections.abc import Callable, Iterable
from pathlib import Path
from typing import Any

from eomgen import files
from eomgen.documents.latex_names import Notation
from eomgen.errors import UsageError, visible
from eomgen.proof.drawn_panels import DrawnPanel, panels_of
from eomgen.records import dataclass
from eomgen.symbolic.numeric.tolerances import SMALLEST_PLAIN

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
    """

    size: tuple[float, float]
    fill: Callable[[Any], None]
    title: str = ""

    def save(self, path: str | Path) -> None:
        """Draw it into a PNG, SVG or PDF file; the ending says which.

        Raises:
            UsageError: another ending.
            WriteFailed: the file cannot be written; what was there before is then still there.
        """
        self.saved(path)

    def saved(self, path: str | Path) -> tuple[DrawnPanel, ...]:
        """`save`, and what the panels of the figure in the file show."""
        path = Path(path)
        if path.suffix.lower() not in FORMATS:
            raise UsageError(f"no picture can be written as '{path.name}'", mend=f"endings are {', '.join(FORMATS)}")
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
            if self.title:
                title = visible(self.title).replace("$", r"\$")
                figure.suptitle(title, fontsize=12, fontweight="bold", x=0.01, ha="left", wrap=True)
            keep(figure)

    def _repr_png_(self) -> bytes:
        page = io.BytesIO()
        self._drawn(lambda figure: figure.savefig(page, format="png", dpi=100))
        return page.getvalue()


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

    def __call__(self, value: float) -> float:
        """A value in SI, in these units."""
        return value / self.factor

    def unit(self, unit: str) -> str:
        """kN of N, kN m of N m."""
        return self.prefix + unit

    def number(self, value: float) -> str:
        """A value in SI as its number in these units."""
        return figures(self(value))

    def text(self, value: float, unit: str) -> str:
        """A value in SI as "41.93 kN"."""
        return f"{self.number(value)} {self.unit(unit)}"


def scale_of(values: Iterable[float]) -> Scale:
    """The scale that the largest of some values asks for: kN from 10 kN on; units without prefix where all are 0."""
    largest = max((abs(value) for value in values), default=0.0)
    if not largest or ROOMY > largest >= 0.1:
        return Scale()
    return next((Scale(*pair) for pair in PREFIXES if largest >= ROOMY * pair[0]), Scale(*PREFIXES[-1]))


def figures(value: float) -> str:
    """A number with four figures, without a power of ten where it has less than eight digits: 12340, 0.05."""
    text = f"{value:.{FIGURES}g}"
    return f"{float(text):.10f}".rstrip("0").rstrip(".") if SMALLEST_PLAIN <= abs(value) < 1e8 else text
