"""Model -> whether its functions through samples go as the samples are declared, by other programs' interpolation.

scipy's cubics, found in doubles from the samples and not from our pieces; a straight line by numpy; steps by search.
Beyond the ends a cubic goes straight on, anything else stays.
"""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from eomgen.model.part import leaves_of
from eomgen.model.parts import Model
from eomgen.proof.check import Check, checked, first_wrong
from eomgen.symbolic.expression.expressions import Expression
from eomgen.symbolic.expression.rational import Fraction
from eomgen.symbolic.expression.splines import DeclaredSamples, Sampled
from eomgen.symbolic.numeric.tolerances import COMPUTED

CONDITIONS = {"not-a-knot": "not-a-knot", "natural": "natural", "rest": "clamped"}  # our ends, by scipy's names
MOST = 50  # gaps between samples in which a function is looked at, evenly spread
PARTS = (Fraction(0), Fraction(3, 10), Fraction(4, 5))  # of a gap


def other_functions(model: Model) -> Iterator[Check]:
    """Whether they go through their samples; none where there are none."""
    laws = [found for found in map(_sampled, _expressions(model)) if found is not None]
    if laws:
        name = "functions through samples go through them, and between them as they are declared"
        yield checked(name, first_wrong(map(_wrong, laws)), "floating point")


def _expressions(model: Model) -> Iterator[Expression]:
    parts = (*model.coordinates.values(), *model.inputs.values())
    for part in parts:
        leaves = (part,) if isinstance(part, Expression) else (leaf.value for leaf in leaves_of(part, ()))
        yield from (value for value in leaves if isinstance(value, Expression))


def _sampled(law: Expression) -> tuple[Sampled, DeclaredSamples] | None:
    found = law.sampled
    return None if found is None or found.declared is None else (found, found.declared)


def _wrong(law: tuple[Sampled, DeclaredSamples]) -> str:
    """Where the function is another one, or ""."""
    function, given = law
    times = given.times
    gaps = np.unique(np.linspace(0, len(times) - 2, MOST).astype(int))
    places = [times[k] + part * (times[k + 1] - times[k]) for k in gaps for part in PARTS]
    span = times[-1] - times[0]
    places += [times[-1], times[0] - span / 5, times[-1] + span / 5]
    due = _interpolated(given, np.array([float(t) for t in places])) * float(given.factor)
    found = np.array([float(function.spline.at(t)) for t in places])
    away = abs(found - due)
    k = int(np.argmax(away))
    if away[k] <= COMPUTED * (1 + abs(due).max()):
        return ""
    return f"{found[k]:.10g} at t = {float(places[k]):.6g} s for {due[k]:.10g}"


def _interpolated(given: DeclaredSamples, t: np.ndarray) -> np.ndarray:
    from scipy.interpolate import CubicSpline, PchipInterpolator

    times, values = (np.array([float(x) for x in row]) for row in (given.times, given.values))
    inside = np.clip(t, times[0], times[-1])
    if given.way == "linear":
        found: np.ndarray = np.interp(t, times, values)
    elif given.way == "steps":
        found = values[np.maximum(np.searchsorted(times, t, side="right") - 1, 0)]
    else:
        monotone = given.way == "pchip"
        spline = (
            PchipInterpolator(times, values) if monotone else CubicSpline(times, values, bc_type=CONDITIONS[given.ends])
        )
        found = spline(inside) + spline(inside, 1) * (t - inside)
    return found
