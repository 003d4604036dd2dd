"""Derivatives along a run and at a state, and their check by differences."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace
from functools import cached_property
from typing import Any

import numpy as np

from eomgen.codegen import Program, RightHandSide
from eomgen.errors import DerivationError, EomgenError, NotYet
from eomgen.frozen import dataclass
from eomgen.mechanics.dynamics import System
from eomgen.mechanics.linearization import CORNERS
from eomgen.mechanics.start import Seeds
from eomgen.mechanics.state import Numbers
from eomgen.model import Model, Requests, model_at
from eomgen.pipeline import simulator
from eomgen.proof import Certificate, Check, checked, unchecked
from eomgen.questions import solve
from eomgen.simulation import states_along
from eomgen.study import Study
from eomgen.symbolic.expression import Expression, Node, Scalar, depends_on, order, substituted, tangent
from eomgen.symbolic.numeric import evaluate, fifty_digits, floats_of, tolerances

# -------- along a run -----------------------------------------------------------------------------------------
# Equations, changes of parameters and start -> change along a motion: the variational equations, integrated with it.
#
#     x' = f(t, x, p),   s' = f_x s + f_p,   s(0) = dx(0)/dp
#
# One program gives both; where constraints close, f is the right-hand side with the multipliers eliminated.


JUMPS = ("sign", "less", "less_equal", "select")


@dataclass(frozen=True)
class ChangingRun:
    """A motion, and how it changes.

    Args:
        t: instants, k [s].
        values: of each formula along them, k.
        slopes: of each formula and each name its derivative, k.
    """

    t: np.ndarray
    values: Mapping[str, np.ndarray]
    slopes: Mapping[tuple[str, str], np.ndarray]


def changing_run(
    phase: Study,
    start: tuple[np.ndarray, Mapping[str, np.ndarray]],
    changes: Mapping[str, Seeds],
    formulas: Mapping[str, Expression],
    instants: np.ndarray,
) -> ChangingRun:
    """Formulas and their derivatives along a motion.

    Args:
        start: x = (q, u, z) at the start, and how it changes with each name.
        changes: how the parameters change with each name.
        formulas: by name.
        instants: ascending from 0 [s].
    Raises:
        NotYet: contacts change along the way, or forces jump.
        RunFailed: the motion ends before.
    """
    system = phase.system
    rates = _rates(phase)
    _refuse_jumps(system, rates)
    symbols, graph = system.symbols, system.scope.graph
    x = symbols.x
    s = {name: tuple(graph.symbol(f"d({node.name})/d({name})") for node in x) for name in changes}
    along = {name: {**seeds, **dict(zip(x, s[name], strict=True))} for name, seeds in changes.items()}
    extended = replace(symbols, z=(*symbols.z, *(node for own in s.values() for node in own)))
    rows = [*rates, *(d for seeds in along.values() for d in tangent(rates, seeds))]
    f, p = RightHandSide.of(Program.of(rows, extended)), RightHandSide.parameter_values(system.scope.model)
    x0 = np.concatenate([start[0], *(start[1][name] for name in changes)])
    states = states_along(f.at(p), x0, instants, system.scope.model.breakpoints)
    inputs = _own_inputs(system)
    closed = substituted([phase.of_state(formula) for formula in formulas.values()], inputs)
    requested = [*closed, *(d for seeds in along.values() for d in tangent(closed, seeds))]
    columns = RightHandSide.of(Program.of(requested, extended), "numpy").many(instants, states, p).T + 0.0
    keys = [(of, name) for name in changes for of in formulas]
    slopes = dict(zip(keys, columns[len(formulas) :], strict=True))
    return ChangingRun(instants, dict(zip(formulas, columns, strict=False)), slopes)


def _rates(phase: Study) -> tuple[Scalar, ...]:
    """x' as functions of t, x and the parameters."""
    equations, a = phase.equations, phase.system.symbols.a
    known = equations.accelerations if not equations.J and equations.accelerations else phase.accelerations
    outputs = (*equations.kinematic_rates, *a, *equations.state_rates)
    rates = substituted(outputs, dict(zip(a, known, strict=True)))
    return substituted(rates, _own_inputs(phase.system))


def _own_inputs(system: System) -> dict[Node, Scalar]:
    return {node: system.inputs[name] for name, node in system.symbols.inputs.items()}


def _refuse_jumps(system: System, rates: Sequence[Scalar]) -> None:
    if system.scope.model.has_phases:
        names = ", ".join(f"'{x}'" for x in system.scope.model.changing)
        what = f"{names} may change along the way (open, stick, slide): a motion in phases has no derivative here"
        raise NotYet(what, fix="differences of two runs, or a stretch of one phase as a model of its own")
    moving = (*system.symbols.x, *system.symbols.parameters.values())
    if any(node.op in JUMPS and depends_on(node, moving) for node in order(rates)):
        raise NotYet(
            "a force jumps along the way: the variational equations do not hold across it",
            fix="take differences of two runs: a sweep over the parameter",
        )


# -------- at a state ------------------------------------------------------------------------------------------
# A state with its change -> values of formulas there, and how they change: accelerations and multipliers with them.
#
# R = M a - forcing - J^T lam = 0,   A = J a + gamma = 0:   [M, -J^T; J, 0] [da; dlam] = -[dR; dA] at fixed a, lam


ROUNDS = 3  # of corrections with 50 digits: each gains those of a double


@dataclass(frozen=True)
class ChangingState:
    """A state of the equations of motion, and how it changes.

    Args:
        phase: the equations.
        numbers: t, parameters, inputs, q and u, with 50 digits.
        seeds: how they change.
    """

    phase: Study
    numbers: Mapping[Node, Any]
    seeds: Seeds

    def of(self, scalars: Sequence[Scalar]) -> list[tuple[float, float]]:
        """(value, slope) of scalars in q, u, a, lam, t, the inputs and the parameters.

        Raises:
            DerivationError: one of them, or a force, has a corner or a jump there.
        """
        symbols = self.phase.system.symbols
        numbers, seeds, held = self.numbers, self.seeds, tuple[Scalar, ...]()
        if any(depends_on(x, (*symbols.a, *symbols.lam)) for x in scalars):
            (numbers, seeds), held = self._moving, self._rows
        _refuse_corners((*scalars, *held), numbers, seeds)
        values = evaluate((*scalars, *tangent(tuple(scalars), seeds)), numbers, fifty_digits())
        found = [0.0 if abs(x) < tolerances.COORDINATE_AT_50 else x for x in floats_of(values)]
        return list(zip(found[: len(scalars)], found[len(scalars) :], strict=True))

    def formula(self, formula: Expression) -> tuple[float, float]:
        """(value, slope) of a formula of the model."""
        equations = self.phase.equations if self.phase.needs_equations(formula) else None
        closed = equations is not None and equations.friction
        return self.of([self.phase.of_state(formula) if closed else self.phase.raw(formula)])[0]

    @property
    def _rows(self) -> tuple[Scalar, ...]:
        """Residual that the accelerations and multipliers make 0."""
        balance, closing = self.phase.equations.residual
        return *balance, *closing

    @cached_property
    def _moving(self) -> tuple[Mapping[Node, Any], Seeds]:
        """The same with accelerations and multipliers."""
        e, symbols = self.phase.equations, self.phase.system.symbols
        n, k, graph = len(e.M), len(e.J), self.phase.system.scope.graph
        M, J = np.split(Numbers(self.numbers).array((*e.M, *e.J), n), [n])
        inverse = np.linalg.pinv(np.block([[M, -J.T], [J, np.zeros((k, k))]]), rcond=tolerances.RANK)
        unknowns, rows = (*symbols.a, *symbols.lam), self._rows
        numbers = dict(self.numbers) | dict.fromkeys(unknowns, fifty_digits().number(0))
        for _ in range(ROUNDS):
            numbers |= _corrected(numbers, unknowns, inverse, evaluate(rows, numbers, fifty_digits()))
        changes = {x: graph.symbol(f"d({x.name})") for x in unknowns}
        left = tangent(rows, {**self.seeds, **changes})
        known = numbers | dict.fromkeys(changes.values(), fifty_digits().number(0))
        for _ in range(ROUNDS):
            known |= _corrected(known, tuple(changes.values()), inverse, evaluate(left, known, fifty_digits()))
        return known, {**self.seeds, **changes}


def _corrected(
    known: Mapping[Node, Any], unknowns: Sequence[Node], inverse: np.ndarray, left: Sequence[Any]
) -> dict[Node, Any]:
    """The unknowns after one correction, which gains the digits of a double."""
    step = inverse @ np.array([float(x) for x in left])
    return {x: known[x] - d for x, d in zip(unknowns, step.tolist(), strict=True)}


def _refuse_corners(scalars: Sequence[Scalar], numbers: Mapping[Node, Any], seeds: Seeds) -> None:
    """Refuses a state near which, on both sides, scalars are not those that their derivatives predict.

    Raises:
        DerivationError: one is not.
    """
    if not any(node.op in CORNERS for node in order(scalars)):
        return
    digits = fifty_digits()
    rates = dict(zip(seeds, evaluate(tuple(seeds.values()), numbers, digits), strict=True))
    found = evaluate((*scalars, *tangent(tuple(scalars), seeds)), numbers, digits)
    for side in (-1, 1):
        step = side * digits.number(1) * tolerances.BESIDE
        nearby = evaluate(scalars, {**numbers, **{x: numbers[x] + step * rate for x, rate in rates.items()}}, digits)
        for here, there, slope in zip(found, nearby, found[len(scalars) :], strict=False):
            if abs((there - here) / step - slope) > tolerances.CARRIED * (1 + abs(slope)):
                raise DerivationError("it, or a force, has a corner or a jump there", fix="take a state near it")


# -------- differences -----------------------------------------------------------------------------------------
# Model, derivatives -> checks: each against central differences of the whole computation, made anew at other values.
#
#     f' = (8 (f(h) - f(-h)) - (f(2h) - f(-2h)))/12h + O(h^4)
#
# The difference between the coarse and the fine one gives their accuracy. The value itself is
#
#     f = (4 (f(h) + f(-h)) - (f(2h) + f(-2h)))/6 + O(h^4)


HOW = "differences of the whole computation"


@dataclass(frozen=True)
class Derivatives:
    """Derivatives that are found [SI].

    Args:
        values: value of each formula that has one.
        slopes: derivative by (formula, name).
        run: values and derivatives along a motion; None where none was requested.
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
    """Proof of derivatives, and of the quantities that are differentiated."""
    by_name: dict[str, list[str]] = {}
    for of, to in found.slopes:
        by_name.setdefault(to, []).append(of)
    return Certificate(tuple(check for to, of in by_name.items() for check in _by_one(model, of, to, found)))


def _by_one(model: Model, of: Sequence[str], to: str, reported: Derivatives) -> list[Check]:
    """Checks of the derivatives by one name."""
    value = _value(model, to)
    h = tolerances.PARAMETER_STEP * (abs(value) or 1.0)
    computed = _computed(model, of, to) if reported.run is None else _run(model, of, to, reported.run)
    names = [f"d({text})/d({to})" for text in of]
    try:
        f = [computed(value + k * h) for k in (-2, -1, 1, 2)]
    except (EomgenError, ArithmeticError, ValueError) as error:
        return [unchecked(name, f"without a value nearby: {error}", HOW) for name in names]
    found = []
    for k, (text, name) in enumerate(zip(of, names, strict=True)):
        low2, low, high, high2 = (each[k] for each in f)
        coarse, fine = (high2 - low2) / (4 * h), (8 * (high - low) - (high2 - low2)) / (12 * h)
        share = tolerances.COMPUTED if reported.run is None else tolerances.CARRIED
        own, noise = reported.slope(text, to), share * np.max(np.abs(high), initial=0.0)
        trust = np.abs(fine - coarse) + noise / h + tolerances.COMPUTED * np.max(np.abs(own))
        if not np.all(np.isfinite(fine)):
            found.append(unchecked(name, "without a value nearby", HOW))
            continue
        wrong = _worst(own, fine, trust)
        here = reported.value(text)
        if here is not None and not wrong:
            middle = (4 * (high + low) - (high2 + low2)) / 6
            wrong = _worst(here, middle, noise + np.abs(middle - (high + low) / 2))
            wrong = f"its value is {wrong}" if wrong else ""
        found.append(checked(name, wrong, HOW))
    return found


def _worst(own: np.ndarray, right: np.ndarray, trust: np.ndarray) -> str:
    """Message for the largest difference beyond the trusted accuracy; ""."""
    worst = int(np.argmax(np.abs(own - right) - trust))
    return "" if abs(own[worst] - right[worst]) <= trust[worst] else f"{own[worst]:.9g}, not {right[worst]:.9g}"


def _value(model: Model, name: str) -> float:
    """Value of a parameter, or of a coordinate or speed at the start [SI]."""
    if name in model.parameters:
        return model.numeric_parameters()[name]
    places, speeds = model.start_values()
    return {**places, **speeds}[name]


def _computed(model: Model, of: Sequence[str], to: str) -> Callable[[float], list[np.ndarray]]:
    """value -> each formula, as `solve` answers it."""
    requested = {f"asked{k}": replace(Requests(model).output(text), unit=None) for k, text in enumerate(of)}

    def found(value: float) -> list[np.ndarray]:
        answers = solve(_with(model.requesting(requested), to, value))
        return [np.array([np.nan if x.value is None else x.value]) for x in answers.values()]

    return found


def _run(model: Model, of: Sequence[str], to: str, run: ChangingRun) -> Callable[[float], list[np.ndarray]]:
    """value -> each formula along the motion."""
    requested = {f"asked{k}": replace(Requests(model).output(text), unit=None) for k, text in enumerate(of)}
    again = simulator(model.requesting(requested), rtol=tolerances.FINE_RUN, atol=tolerances.FINE_RUN)

    def found(value: float) -> list[np.ndarray]:
        parameters = {to: value} if to in model.parameters else None
        start = None if to in model.parameters else {to: value}
        made = again(float(run.t[-1]), parameters, start, run.t.tolist(), ("outputs",))
        return [made.outputs[name] for name in requested]

    return found


def _with(model: Model, name: str, value: float) -> Model:
    return model_at(model, **{"parameters" if name in model.parameters else "start": {name: value}})
