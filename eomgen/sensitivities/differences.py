"""Model, derivatives -> checks: each against central differences of the whole computation, made anew at other values.

    f' = (8 (f(h) - f(-h)) - (f(2h) - f(-2h)))/12h + O(h^4)

What the coarse and the fine difference differ by says how far they are to be trusted. The value itself is

    f = (4 (f(h) + f(-h)) - (f(2h) + f(-2h)))/6 + O(h^4)
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace

import numpy as np

from eomgen.errors import EomgenError
from eomgen.model.parts import Model, Output
from eomgen.model.reader import model_at
from eomgen.model.table import Table
from eomgen.model.values import numeric_parameters, start_values
from eomgen.pipeline import simulator
from eomgen.proof.check import Certificate, Check, checked, unchecked
from eomgen.questions.answers import solve
from eomgen.questions.of_a_run import asked_of
from eomgen.records import dataclass
from eomgen.sensitivities.along_a_run import ChangingRun
from eomgen.symbolic.numeric.tolerances import CARRIED, COMPUTED, FINE_RUN, PARAMETER_STEP

HOW = "differences of the whole computation"


@dataclass(frozen=True)
class Derivatives:
    """What is found [SI].

    Args:
        values: of each formula what it is, those that have one.
        slopes: by (formula, name).
        run: the same along a motion; None where none was asked.
    """

    values: Mapping[str, float]
    slopes: Mapping[tuple[str, str], float]
    run: ChangingRun | None = None

    def slope(self, of: str, to: str) -> np.ndarray:
        return np.atleast_1d(self.slopes[of, to] if self.run is None else self.run.slopes[of, to])

    def value(self, of: str) -> np.ndarray | None:
        if self.run is not None:
            return np.atleast_1d(self.run.values[of])
        return np.atleast_1d(self.values[of]) if of in self.values else None


def checks_of(model: Model, found: Derivatives) -> Certificate:
    """The proof of derivatives, and of what they are of."""
    by_name: dict[str, list[str]] = {}
    for of, to in found.slopes:
        by_name.setdefault(to, []).append(of)
    return Certificate(tuple(check for to, of in by_name.items() for check in _by_one(model, of, to, found)))


def _by_one(model: Model, of: Sequence[str], to: str, told: Derivatives) -> list[Check]:
    """Those by one name."""
    value = _value(model, to)
    h = PARAMETER_STEP * (abs(value) or 1.0)
    computed = _computed(model, of, to) if told.run is None else _run(model, of, to, told.run)
    names = [f"d({text})/d({to})" for text in of]
    try:
        f = [computed(value + k * h) for k in (-2, -1, 1, 2)]
    except (EomgenError, ArithmeticError, ValueError) as error:
        return [unchecked(name, f"without a value beside: {error}", HOW) for name in names]
    found = []
    for k, (text, name) in enumerate(zip(of, names, strict=True)):
        low2, low, high, high2 = (each[k] for each in f)
        coarse, fine = (high2 - low2) / (4 * h), (8 * (high - low) - (high2 - low2)) / (12 * h)
        share = COMPUTED if told.run is None else CARRIED
        own, noise = told.slope(text, to), share * np.max(np.abs(high), initial=0.0)
        trust = np.abs(fine - coarse) + noise / h + COMPUTED * np.max(np.abs(own))
        if not np.all(np.isfinite(fine)):
            found.append(unchecked(name, "without a value beside", HOW))
            continue
        wrong = _worst(own, fine, trust)
        here = told.value(text)
        if here is not None and not wrong:
            middle = (4 * (high + low) - (high2 + low2)) / 6
            wrong = _worst(here, middle, noise + np.abs(middle - (high + low) / 2))
            wrong = f"its value is {wrong}" if wrong else ""
        found.append(checked(name, wrong, HOW))
    return found


def _worst(own: np.ndarray, right: np.ndarray, trust: np.ndarray) -> str:
    """What is furthest off, beyond what is to be trusted; ""."""
    worst = int(np.argmax(np.abs(own - right) - trust))
    return "" if abs(own[worst] - right[worst]) <= trust[worst] else f"{own[worst]:.9g}, not {right[worst]:.9g}"


def _value(model: Model, name: str) -> float:
    """What a name is worth [SI]."""
    if name in model.parameters:
        return numeric_parameters(model)[name]
    places, speeds = start_values(model)
    return {**places, **speeds}[name]


def _computed(model: Model, of: Sequence[str], to: str) -> Callable[[float], list[np.ndarray]]:
    """value -> each formula, as `solve` answers it."""
    asked = {f"asked{k}": replace(asked_of(model, text), unit=None) for k, text in enumerate(of)}

    def found(value: float) -> list[np.ndarray]:
        answers = solve(_with(replace(model, outputs=Table[Output](asked)), to, value))
        return [np.array([np.nan if x.value is None else x.value]) for x in answers.values()]

    return found


def _run(model: Model, of: Sequence[str], to: str, run: ChangingRun) -> Callable[[float], list[np.ndarray]]:
    """value -> each formula along the motion."""
    asked = {f"asked{k}": replace(asked_of(model, text), unit=None) for k, text in enumerate(of)}
    again = simulator(replace(model, outputs=Table[Output](asked)), rtol=FINE_RUN, atol=FINE_RUN)

    def found(value: float) -> list[np.ndarray]:
        parameters = {to: value} if to in model.parameters else None
        start = None if to in model.parameters else {to: value}
        made = again(float(run.t[-1]), parameters, start, run.t.tolist(), ("outputs",))
        return [made.outputs[name] for name in asked]

    return found


def _with(model: Model, name: str, value: float) -> Model:
    return model_at(model, **{"parameters" if name in model.parameters else "start": {name: value}})
