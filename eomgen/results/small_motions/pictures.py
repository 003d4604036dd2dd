"""Pictures of small motions: modes, Bode's diagrams, roots over a parameter."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np

from eomgen.documents import Picture, Sketch, artist_of, mathtext, notation_of
from eomgen.errors import RunFailed
from eomgen.mechanics.dynamics import System
from eomgen.mechanics.linearization import Modes, SmallMotions
from eomgen.model import Range
from eomgen.symbolic.expression import Node
from eomgen.symbolic.numeric import tolerances

# -------- picture ---------------------------------------------------------------------------------------------
# Modes -> a picture: the system swung out in each mode over its reference, or the shapes as bars.


MOST = 9  # modes that are drawn
SIDE, TITLE = 3.4, 0.4  # of one panel, of what is written over it [inches]
BODIES = ("body", "inertia", "hole")  # roles that are drawn of the reference
PART = 0.12  # of the drawing's extent, by which the point that moves most is swung out
AT_REST, BAR = "#c4c4c4", "#336699"


def modes_picture(modes: Modes) -> Picture:
    """The modes, the slowest first: plane systems swung out, others as bars.

    Raises:
        RunFailed: parameters have no values.
    """
    reference = modes.small.reference
    if not reference.valued:
        raise RunFailed("a picture needs values of all parameters", fix="give them values in [parameters]")
    drawn = modes.spectrum.modes[:MOST]
    columns = math.ceil(math.sqrt(len(drawn)))
    rows = math.ceil(len(drawn) / columns)
    plane = reference.system.scope.model.space == "plane"
    height = SIDE
    if plane:
        low, high = _at_rest(modes).corners
        height = min(SIDE, TITLE + SIDE * float(high[1] - low[1]) / float(high[0] - low[0]))

    def fill(figure: Any) -> None:
        for k in range(len(drawn)):
            panel = figure.add_subplot(rows, columns, k + 1)
            (_swung if plane else _bars)(panel, modes, k)
            panel.set_title(_title(modes, k), fontsize=10)

    return Picture((SIDE * columns, height * rows + TITLE), fill, reference.system.scope.model.name)


def _title(modes: Modes, k: int) -> str:
    mode = modes.spectrum.modes[k]
    if mode.frequency is None:
        return f"{k + 1}: {mode.kind}, {mode.eigenvalue.real:.4g} 1/s"
    return f"{k + 1}: {mode.frequency:.4g} rad/s"


def _swung(panel: Any, modes: Modes, k: int) -> None:
    """The bodies of the reference in grey, the system swung out over them."""
    system, shape = modes.small.reference.system, modes.spectrum.modes[k].shape
    here = _at_rest(modes)
    values = here.values
    grey = dict.fromkeys(system.motion.index, AT_REST)
    for stroke in here.drawing.strokes:
        if stroke.role in BODIES:
            artist_of(panel, stroke, 0, grey, 0.5)
    size = _size(system, values, shape, here)
    moved = {q: values[q] + size * x.real for q, x in shape.items()}
    Sketch(system, {**values, **moved}).draw(panel, names=False)


def _at_rest(modes: Modes) -> Sketch:
    """The reference in numbers."""
    reference = modes.small.reference
    return Sketch(reference.system, {x: float(v) for x, v in reference.numbers.items()})


def _size(system: System, values: Mapping[Node, float], shape: Mapping[Node, complex], here: Sketch) -> float:
    """Amplitude of a mode's picture: no point of the drawing moves by more than PART of its extent."""
    aside = {**values, **{q: values[q] + tolerances.WIDE_STEP * x.real for q, x in shape.items()}}
    there = Sketch(system, aside)
    moved = [
        abs(b - a).max()
        for link in system.motion.links
        for a, b in zip(here.lines(BODIES, link.name), there.lines(BODIES, link.name), strict=True)
    ]
    largest = max(moved, default=0.0)
    return PART * here.extent * tolerances.WIDE_STEP / largest if largest > 0 else 0.0


def _bars(panel: Any, modes: Modes, k: int) -> None:
    """The shape, a bar for each coordinate."""
    shape = modes.spectrum.modes[k].shape
    notation = notation_of(modes.small.reference.system.scope.model)
    names = [f"${mathtext(q.name, notation)}$" for q in shape]
    panel.bar(names, [x.real for x in shape.values()], color=BAR)
    panel.axhline(0, color="#808080", linewidth=0.8)
    panel.set_ylim(-1.1, 1.1)


# -------- response pictures -----------------------------------------------------------------------------------
# Small motions -> Bode's diagrams of their transfer functions, and the roots over a parameter.


MOST_INPUTS = 8  # curves of one diagram
DECADES = 1.5  # of frequency, below the slowest and above the fastest mode
FINE = 600  # frequencies of a curve
DASH = 8.0  # of each of several curves that are one [points]
NARROWEST = 0.15  # of the plane of roots, its shorter side: less is rounding, of roots on an axis


def bode_picture(small: SmallMotions) -> Picture:
    """|W| and its phase over the frequency, of every coordinate and input.

    W(i w) = C_y (i w - A)^-1 B

    Raises:
        RunFailed: the system has no inputs; parameters have no values.
    """
    e = small.numbers
    if not e.inputs:
        raise RunFailed("without inputs there is no transfer function", fix="declare one in [inputs]")
    _refuse_unvalued(small)
    A, B = small.state_matrix, small.input_matrix
    omega = _frequencies(A)
    notation = notation_of(small.reference.system.scope.model)
    n = len(A)
    response = np.array([np.linalg.solve(1j * w * np.eye(n) - A, B) for w in omega])
    pairs = [(j, k) for j in range(len(e.coordinates)) for k in range(len(e.inputs))]
    pairs = [(j, k) for j, k in pairs if np.abs(response[:, j, k]).max() > 0][:MOST_INPUTS]
    phases = {(j, k): np.degrees(np.unwrap(np.angle(response[:, j, k]))) for j, k in pairs}

    def fill(figure: Any) -> None:
        size, phase = figure.subplots(2, 1, sharex=True)
        sizes = [np.abs(response[:, j, k]) for j, k in pairs]
        styles = zip(dashes(sizes), dashes(list(phases.values())), strict=True)
        for (j, k), W, (of_size, of_phase) in zip(pairs, sizes, styles, strict=True):
            label = f"${mathtext(e.coordinates[j].name, notation)}/{mathtext(e.inputs[k].name, notation)}$"
            size.loglog(omega, W, label=label, linewidth=1.4, linestyle=of_size)
            phase.semilogx(omega, phases[j, k], linewidth=1.4, linestyle=of_phase)
        size.set_ylabel("$|W|$")
        phase.set_ylabel("phase [°]")
        phase.set_xlabel(r"$\omega$ [rad/s]")
        phase.set_yticks(_right_angles(list(phases.values())))
        for handle in size.legend(loc="center left", bbox_to_anchor=(1.0, 0.5)).get_lines():
            handle.set_linestyle("-")
        figure.align_ylabels((size, phase))

    return Picture((8, 5.2), fill, small.reference.system.scope.model.name)


def dashes(curves: Sequence[np.ndarray]) -> list[Any]:
    """The style of each line: solid, but those that lie on one another take turns."""
    alike = [
        [
            k
            for k, other in enumerate(curves)
            if np.allclose(other, own, rtol=tolerances.COMPUTED, atol=tolerances.COMPUTED * np.abs(own).max())
        ]
        for own in curves
    ]
    return [
        "-" if len(group) == 1 else (-DASH * group.index(k), (DASH, DASH * (len(group) - 1)))
        for k, group in enumerate(alike)
    ]


def _right_angles(phases: Sequence[np.ndarray]) -> np.ndarray:
    """Multiples of a right angle around all of them."""
    low = np.floor((min(each.min() for each in phases) + 1) / 90) - 1
    high = np.ceil((max(each.max() for each in phases) - 1) / 90) + 1
    found: np.ndarray = 90 * np.arange(low, high + 1)
    return found


def _frequencies(A: np.ndarray) -> np.ndarray:
    """Frequencies from below the slowest to above the fastest mode [rad/s]."""
    sizes = np.abs(np.linalg.eigvals(A))
    moving = sizes[sizes > tolerances.ITERATED * sizes.max()] if sizes.max() > 0 else np.ones(1)
    low, high = np.log10(moving.min()) - DECADES, np.log10(moving.max()) + DECADES
    found: np.ndarray = np.logspace(low, high, FINE)
    return found


def locus_picture(small: SmallMotions, over: Range) -> Picture:
    """The eigenvalues in their plane while a parameter changes, its value by colour; crosses where it begins.

    Raises:
        RunFailed: parameters have no values; the equations are only known at those.
    """
    _refuse_unvalued(small)
    roots = small.roots_over(over.name, over.values)
    named = np.array(over.values) / over.size

    notation = notation_of(small.reference.system.scope.model)

    def fill(figure: Any) -> None:
        panel = figure.subplots()
        of_all = np.repeat(named, roots.shape[1])
        points = panel.scatter(roots.real, roots.imag, c=of_all, s=9, cmap="viridis", zorder=3)
        panel.plot(roots[0].real, roots[0].imag, "x", color="#b03a2e", markersize=7, zorder=4)
        _widen(panel)
        panel.axvline(0, color="#808080", linewidth=0.9)
        panel.axhline(0, color="#808080", linewidth=0.9)
        panel.set_xlabel(r"Re $s$ [1/s]")
        panel.set_ylabel(r"Im $s$ [1/s]")
        bar = figure.colorbar(points, ax=panel)
        bar.set_label(f"${mathtext(over.name, notation)}$" + (f" [{over.unit}]" if over.unit else ""))

    return Picture((6.4, 4.8), fill, small.reference.system.scope.model.name)


def _widen(panel: Any) -> None:
    """The plane of roots, no side much shorter than the other."""
    (left, right), (low, high) = panel.get_xlim(), panel.get_ylim()
    least = NARROWEST * max(right - left, high - low)
    x, y = (max(0.0, 0.5 * (least - side)) for side in (right - left, high - low))
    panel.set_xlim(left - x, right + x)
    panel.set_ylim(low - y, high + y)


def _refuse_unvalued(small: SmallMotions) -> None:
    if not small.reference.valued:
        raise RunFailed("a picture needs values of all parameters", fix="give them values in [parameters]")
