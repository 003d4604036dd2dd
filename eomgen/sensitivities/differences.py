"""Model, derivatives -> checks: each against central differences of the whole computation, made anew at other values.

    f' = (8 (f(h) - f(-h)) - (f(2h) - f(-2h)))/12h + O(h^4)

What the coarse and the fine difference differ by says how far they are to be trusted.
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
from eomgen.sensitivities.along_a_run import ChangingRun
from eomgen.symbolic.numeric.tolerances import CARRIED, COMPUTED, FINE_RUN, PARAMETER_STEP

HOW = "differences of the whole computation"
SlopesInSI = Mapping[tuple[str, str], float]


def checks_of(model: Model, slopes: SlopesInSI, run: ChangingRun | None) -> Certificate:
    """The proof of derivatives [SI]."""
    by_name: dict[str, list[str]] = {}
    for of, to in slopes:
        by_name.setdefault(to, []).append(of)
    return Certificate(tuple(check for to, of in by_name.items() for check in _by_one(model, of, to, slopes, run)))


def _by_one(model: Model, of: Sequence[str], to: str, slopes: SlopesInSI, run: ChangingRun | None) -> list[Check]:
    """Those by one name."""
    value = _value(model, to)
    h = PARAMETER_STEP * (abs(value) or 1.0)
    computed = _computed(model, of, to) if run is None else _run(model, of, to, run)
    names = [f"d({text})/d({to})" for text in of]
    try:
        f = [computed(value + k * h) for k in (-2, -1, 1, 2)]
    except (EomgenError, ArithmeticError, ValueError) as error:
        return [unchecked(name, f"without a value beside: {error}", HOW) for name in names]
    found = []
    for k, (text, name) in enumerate(zip(of, names, strict=True)):
        low2, low, high, high2 = (each[k] for each in f)
        coarse, fine = (high2 - low2) / (4 * h), (8 * (high - low) - (high2 - low2)) / (12 * h)
        own = np.atleast_1d(slopes[text, to] if run is None else run.slopes[text, to])
        noise = (COMPUTED if run is None else CARRIED) * np.max(np.abs(high), initial=0.0) / h
        trust = np.abs(fine - coarse) + noise + COMPUTED * np.max(np.abs(own))
        if not np.all(np.isfinite(fine)):
            found.append(unchecked(name, "without a value beside", HOW))
            continue
        worst = int(np.argmax(np.abs(own - fine) - trust))
        wrong = "" if abs(own[worst] - fine[worst]) <= trust[worst] else f"{own[worst]:.9g}, not {fine[worst]:.9g}"
        found.append(checked(name, wrong, HOW))
    return found


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
