"""Small motions -> Bode's diagrams of their transfer functions, and the roots over a parameter."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import fields, replace
from typing import Any

import numpy as np

from eomgen.documents.figures import Picture, mathtext
from eomgen.documents.latex_names import notation_of
from eomgen.errors import RunFailed
from eomgen.mechanics.small_motions.linearization import SmallMotions, state_matrix_of
from eomgen.mechanics.small_motions.reduction import LinearEquations
from eomgen.model.ranges import Range
from eomgen.model.values import exact_parameters
from eomgen.symbolic.numeric.evaluation import FLOAT, NoValue, evaluate
from eomgen.symbolic.numeric.tolerances import COMPUTED, ITERATED

MOST = 8  # curves of one diagram
DECADES = 1.5  # of frequency, beside the slowest and the fastest mode
FINE = 600  # frequencies of a curve
DASH = 8.0  # of each of several curves that are one [points]
NARROWEST = 0.15  # of the plane of roots, its shorter side: less is rounding, of roots on an axis

MatrixOf = Callable[[float], np.ndarray]


def bode_picture(small: SmallMotions) -> Picture:
    """|W| and its phase over the frequency, of every coordinate and input.

    W(i w) = C_y (i w - A)^-1 B

    Raises:
        RunFailed: the system has no inputs; parameters have no values.
    """
    e = small.numbers
    if not e.inputs:
        raise RunFailed("without inputs there is no transfer function", mend="declare one in [inputs]")
    _refuse_unvalued(small)
    A, B = small.state_matrix, small.input_matrix
    omega = _frequencies(A)
    notation = notation_of(small.reference.system.scope.model)
    n = len(A)
    response = np.array([np.linalg.solve(1j * w * np.eye(n) - A, B) for w in omega])
    pairs = [(j, k) for j in range(len(e.coordinates)) for k in range(len(e.inputs))]
    pairs = [(j, k) for j, k in pairs if np.abs(response[:, j, k]).max() > 0][:MOST]
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
            if np.allclose(other, own, rtol=COMPUTED, atol=COMPUTED * np.abs(own).max())
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
    """From below the slowest to above the fastest mode."""
    sizes = np.abs(np.linalg.eigvals(A))
    moving = sizes[sizes > ITERATED * sizes.max()] if sizes.max() > 0 else np.ones(1)
    low, high = np.log10(moving.min()) - DECADES, np.log10(moving.max()) + DECADES
    found: np.ndarray = np.logspace(low, high, FINE)
    return found


def locus_picture(small: SmallMotions, over: Range) -> Picture:
    """The eigenvalues in their plane while a parameter changes, its value by colour; crosses where it begins.

    Raises:
        RunFailed: parameters have no values; the equations are only known at those.
    """
    roots = roots_over(small, over.name, over.values)
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


def roots_over(small: SmallMotions, parameter: str, values: Sequence[float]) -> np.ndarray:
    """The eigenvalues at each value of a parameter, a row each; nan where the reference has none.

    Raises:
        RunFailed: as `locus_picture`.
    """
    _refuse_unvalued(small)
    matrix = _matrix_over(small, parameter)
    rows = []
    for value in values:
        try:
            rows.append(np.sort_complex(np.linalg.eigvals(matrix(value))))
        except (NoValue, ZeroDivisionError, np.linalg.LinAlgError):
            rows.append(np.full(len(small.state_matrix), np.nan, dtype=complex))
    return np.array(rows)


def _matrix_over(small: SmallMotions, parameter: str) -> MatrixOf:
    """A as a function of the parameter, by the exact equations."""
    exact = small.exact
    if exact is None:
        what = "the small motions are known in numbers only, at the values of the parameters"
        raise RunFailed(f"{what}: there are no roots over '{parameter}'", mend="take a place in closed form")
    scope = small.reference.system.scope
    names = [f.name for f in fields(LinearEquations) if f.name in ("M", "C", "K", "B", "F", "E")]
    shapes = {name: [len(row) for row in getattr(exact, name)] for name in names}
    flat = [x for name in names for row in getattr(exact, name) for x in row]

    def at(value: float) -> np.ndarray:
        known = exact_parameters(scope.model, {parameter: value})  # and those that are expressions of it
        state = {scope.symbols.parameters[name]: float(x) for name, x in known.items()}
        numbers = iter(evaluate(flat, state, FLOAT))
        found: dict[str, Any] = {
            name: [[float(next(numbers)) for _ in range(width)] for width in shapes[name]] for name in names
        }
        return state_matrix_of(replace(exact, **found))

    return at


def _refuse_unvalued(small: SmallMotions) -> None:
    if not small.reference.valued:
        raise RunFailed("a picture needs values of all parameters", mend="give them values in [parameters]")
