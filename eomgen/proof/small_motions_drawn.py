"""What is drawn of small motions -> checks: curves, roots and bars are those of the matrices that machines get.

Curves are read from their picture; W and the roots s by M, C and K as they are told, not by A:

    [s 1 - F, -E; K, s M + C] (q, u) = (0, B w),    det = 0,    sum s = tr A,    sum s^2 = tr A^2
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence
from functools import cached_property
from typing import Any

import numpy as np

from eomgen.model.parts import Model
from eomgen.model.values import exact_parameters
from eomgen.proof.check import Check, attempted
from eomgen.proof.drawn_panels import ColouredPoints, DrawnPanel, said_of
from eomgen.proof.small_motions_told import PrintedModes, ToldMotions
from eomgen.records import dataclass
from eomgen.symbolic.expression.expressions import LONGEST, Expression, parse
from eomgen.symbolic.expression.units import parse_unit
from eomgen.symbolic.numeric.evaluation import NoValue
from eomgen.symbolic.numeric.tolerances import (
    CARRIED,
    COMPUTED,
    FOUR_DIGITS,
    ITERATED,
)

DRAWN, BY_PENCIL = "what is drawn of small motions is what they are", "by M, C, K and B at what is drawn"
MOST_CURVES, MOST_MODES = 8, 9  # pairs of which Bode's diagrams are drawn, modes that are drawn
MOST_VALUES = 60  # of a parameter at which its roots are looked at


def modes_drawn(entries: Mapping[str, Any], panels: Sequence[DrawnPanel]) -> Check:
    """What stands above each mode, and the bars of those that are not swung out."""
    return attempted(DRAWN, "modes as machines get them", lambda: _wrong_modes(entries["modes"], panels))


def _wrong_modes(modes: Sequence[Mapping[str, Any]], panels: Sequence[DrawnPanel]) -> str:
    if len(panels) != min(len(modes), MOST_MODES):
        return f"{len(panels)} of {len(modes)} modes"
    for k, (mode, panel) in enumerate(zip(modes, panels, strict=False), start=1):
        frequency = getattr(mode["frequency"], "value", mode["frequency"])
        said = f"{k}: " if frequency is not None else f"{k}: {mode['kind']}, "
        number, _, unit = panel.title.removeprefix(said).partition(" ")
        right = mode["eigenvalue"][0] if frequency is None else frequency
        known = panel.title.startswith(said) and unit == ("1/s" if frequency is None else "rad/s")
        if not known or abs(float(number) - right) > FOUR_DIGITS * abs(right):
            return f"'{panel.title}' stands above mode {k}, {right:.6g} {unit}"
        heights = [height for _, height in panel.bars]
        if heights and not np.allclose(heights, [x for x, _ in mode["shape"].values()], rtol=0, atol=COMPUTED):
            return f"the bars of mode {k} are not its shape"
    return ""


def responses_drawn(entries: Mapping[str, Any], panels: Sequence[DrawnPanel], letters: Mapping[str, str]) -> Check:
    """Bode's diagrams: |W| and the phase of W at every frequency that is drawn.

    Args:
        letters: how the names of coordinates and inputs are set.
    """
    drawn = _Drawn(ToldMotions(entries, PrintedModes({}), {}), letters)
    return attempted(DRAWN, BY_PENCIL, lambda: drawn.wrong_responses(panels))


def roots_drawn(
    entries: Mapping[str, Any], panels: Sequence[DrawnPanel], letters: Mapping[str, str], model: Model
) -> Check:
    """The roots over a parameter: each of those drawn at the value that its colour tells, and no other.

    Args:
        letters: how the names of parameters are set.
    """
    drawn = _Drawn(ToldMotions(entries, PrintedModes({}), {}), letters)
    return attempted(DRAWN, BY_PENCIL, lambda: drawn.wrong_roots(panels, model))


@dataclass(frozen=True)
class Pencil:
    """s P - Q, of the states (q, u): P = [1 0; 0 M], Q = [F E; -K -C]."""

    P: np.ndarray
    Q: np.ndarray

    def at(self, s: complex) -> np.ndarray:
        found: np.ndarray = s * self.P - self.Q
        return found

    @property
    def A(self) -> np.ndarray:
        """Of x' = A x."""
        return np.linalg.solve(self.P, self.Q)

    def answers(self, omega: np.ndarray, right: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """(x of (i w P - Q) x = right at each frequency, what rounding makes of it: by how much it differs by A)."""
        A, forced = self.A, np.linalg.solve(self.P, right)
        found = np.array([np.linalg.solve(self.at(1j * w), right) for w in omega])
        by_A = np.array([np.linalg.solve(1j * w * np.eye(len(A)) - A, forced) for w in omega])
        return found, np.abs(found - by_A)


@dataclass(frozen=True)
class _Drawn:
    told: ToldMotions
    letters: Mapping[str, str]

    def pencil(self, matrix: Callable[[str], np.ndarray]) -> Pencil:
        """By matrices as they are named."""
        M, C, K, E, F = map(matrix, ("mass", "rates", "stiffness", "kinematic_rates", "kinematic_places"))
        if self.told.entries["second_order"]:
            if F.any():
                raise NoValue("rates have parts along the places")
            C = C @ E
        n, m = len(M), len(F)
        zero = np.zeros((m, n))
        return Pencil(np.block([[np.eye(m), zero], [zero.T, M]]), np.block([[F, E], [-K, -C]]))

    # -- Bode's diagrams -----------------------------------------------------------------------------------

    def wrong_responses(self, panels: Sequence[DrawnPanel]) -> str:
        entries = self.told.entries
        sizes, phases = panels
        if (sizes.scales, phases.scales) != (("log", "log"), ("log", "linear")) or sizes.hidden or phases.hidden:
            return "the axes are not those of the curves"
        names = {
            f"${self.letters[q]}/{self.letters[w]}$": (j, k)
            for j, q in enumerate(entries["coordinates"])
            for k, w in enumerate(entries["inputs"])
        }
        omega = sizes.curves[0].places[:, 0] if sizes.curves else np.ones(1)
        pencil, B = self.pencil(self.told.matrix), self.told.matrix("input")
        right = np.concatenate([np.zeros((self.told.m, B.shape[1])), B])
        answers, rounding = pencil.answers(omega, right)
        of_colour = {curve.color: curve.places for curve in phases.curves}
        for curve in sizes.curves:
            if curve.label not in names:
                return f"nobody knows {curve.label}"
            j, k = names.pop(curve.label)
            turned = of_colour.get(curve.color, np.zeros((0, 2)))
            if not np.array_equal(curve.places[:, 0], omega) or not np.array_equal(turned[:, 0], omega):
                return f"{curve.label} is drawn at other frequencies than its phase"
            W, size = answers[:, j, k], np.abs(answers[:, :, k]).max(axis=1)
            near = CARRIED * np.abs(W) + ITERATED * size + 10 * rounding[:, j, k]
            for what, found in (
                ("|W|", curve.places[:, 1] * np.exp(1j * np.angle(W))),
                ("phase", np.abs(W) * np.exp(1j * np.radians(turned[:, 1]))),
            ):
                if np.any(off := np.abs(found - W) > near):
                    i = int(np.argmax(off))
                    return f"{what} of {curve.label} at {omega[i]:.4g} rad/s: {found[i]:.6g} for {W[i]:.6g}"
        left = [label for label, (j, k) in names.items() if np.abs(answers[:, j, k]).max() > CARRIED]
        if left and len(sizes.curves) < MOST_CURVES:
            return f"{left[0]} is not drawn"
        rates = np.abs([complex(*x) for x in entries["eigenvalues"]])
        moving = rates[rates > ITERATED * rates.max(initial=0.0)]
        outside = moving[(moving < omega[0]) | (moving > omega[-1])]
        return f"the mode of {outside[0]:.4g} 1/s is not within the frequencies" if len(outside) else ""

    # -- roots over a parameter ----------------------------------------------------------------------------

    def wrong_roots(self, panels: Sequence[DrawnPanel], model: Model) -> str:
        (panel,) = panels
        (points,) = panel.points
        what, unit = said_of(points.label)
        name = next((x for x in model.parameters if what == f"${self.letters[x]}$"), None)
        if name is None or panel.scales != ("linear", "linear") or panel.hidden:
            return f"nobody knows {what}" if name is None else "the axes are not those of the points"
        begun = {complex(*x) for curve in panel.curves for x in curve.places}
        values = list(dict.fromkeys(points.values.tolist()))
        for value in values[:: 1 + (len(values) - 1) // MOST_VALUES]:
            known = exact_parameters(model, {name: value * (parse_unit(unit).size if unit else 1.0)})
            roots = _roots(points, value)
            found = self.pencil(lambda x, known=known: self._exact(x, known))  # type: ignore[misc]
            if wrong := _no_roots(found, roots):
                return f"at {name} = {value:.6g} {unit}: {wrong}"
            if value == values[0] and set(roots) != begun:
                return f"the crosses are not at {name} = {value:.6g} {unit}"
        return ""

    def _exact(self, name: str, known: Mapping[str, Any]) -> np.ndarray:
        """A matrix at other values of the parameters."""
        values = {x: float(value) for x, value in known.items()} | {"pi": math.pi}
        rows = [[float(x.evaluate(values)) for x in row] for row in self._read(name)]
        return self.told.shaped(name, np.array(rows, dtype=float))

    def _read(self, name: str) -> list[list[Expression]]:
        if name not in self._expressions:
            exact = self.told.entries[name]["exact"]
            texts = [text for row in exact for text in row]
            if sum(map(len, texts)) > 10 * LONGEST:
                raise NoValue("too long to be read back")
            self._expressions[name] = [[parse(text, longest=len(text)) for text in row] for row in exact]
        return self._expressions[name]

    @cached_property
    def _expressions(self) -> dict[str, list[list[Expression]]]:
        return {}


def _roots(points: ColouredPoints, value: float) -> list[complex]:
    return [complex(*x) for x in points.places[points.values == value] if np.isfinite(x).all()]


def _no_roots(pencil: Pencil, roots: Sequence[complex]) -> str:
    """That these are not all the roots of det(s P - Q), each as often as it is one."""
    A = pencil.A
    if not np.isfinite(A).all():
        return ""
    if len(roots) != len(A):
        return f"{len(roots)} roots for {len(A)}"
    size = max(map(abs, roots), default=0.0) or 1.0
    for s in roots:
        rows = A - s * np.eye(len(A))
        if np.linalg.svd(rows, compute_uv=False)[-1] > CARRIED * max(size, 1.0):
            return f"{s:.6g} is no root"
    found, sums = np.array(roots), (np.trace(A), np.sum(A * A.T))
    if any(abs(np.sum(found**k) - right) > CARRIED * len(A) * size**k for k, right in enumerate(sums, start=1)):
        return "a root is drawn in place of another"
    return ""
