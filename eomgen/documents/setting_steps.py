"""System -> the first steps of a derivation: data, degrees of freedom, coordinates."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from typing import Any

from eomgen.documents.statements import Formula, Meaning, Piece, Rate, Statement, Step, Table, prose
from eomgen.errors import DerivationError, MissingValues
from eomgen.mechanics.bodies.scope import Scope
from eomgen.mechanics.constraints.elimination import dependent_coordinates
from eomgen.mechanics.constraints.integrability import integrability_of
from eomgen.mechanics.equations.system import System
from eomgen.mechanics.initial_state.exact_start import ExactStart
from eomgen.model.parts import Coordinate, Input, Parameter
from eomgen.model.values import exact_parameters
from eomgen.symbolic.expression.expressions import Expression
from eomgen.symbolic.expression.graph import Node, Scalar
from eomgen.symbolic.print.text import to_text

PARAMETERS = ("parameter", "meaning", "unit", "value")
COORDINATES = ("coordinate", "meaning", "unit", "start")
Quantified = Parameter | Coordinate | Input | None
INPUTS = ("input", "meaning", "unit", "value")


def setting_steps(system: System) -> tuple[Step, ...]:
    """Data, degrees of freedom, coordinates."""
    return (data_step(system), _freedom(system), _coordinates(system))


def assumption_steps(assumptions: Sequence[str]) -> tuple[Step, ...]:
    """What had to be assumed, as a first step; none where nothing was."""
    told = tuple(prose(f"{what}.") for what in assumptions)
    return (Step("assumptions", "Assumptions", told),) if told else ()


def listed_symbols(symbols: tuple[Node, ...]) -> tuple[Piece, ...]:
    """The symbols, with commas between."""
    pieces: list[Piece] = []
    for symbol in symbols:
        pieces += [", ", symbol] if pieces else [symbol]
    return tuple(pieces)


def count(number: int, noun: str, plural: str = "") -> str:
    """1 coordinate, 2 coordinates."""
    return f"{number} {noun}" if number == 1 else f"{number} {plural or noun + 's'}"


def data_step(system: System) -> Step:
    """What is given."""
    model, symbols = system.scope.model, system.symbols
    values = exact_parameters(model)
    rows = []
    for name, symbol in symbols.parameters.items():
        part = model.parameters[name]
        rows.append(Meaning(symbol, part.about or "", _unit(part), _in_unit(values.get(name), part)))
    statements: list[Statement] = [Table(PARAMETERS, tuple(rows))] if rows else [prose("No parameters.")]
    inputs = tuple(
        Meaning(
            symbol,
            model.inputs[name].about or "a known function of time",
            _unit(model.inputs[name]),
            model.inputs[name].value.text,
        )
        for name, symbol in symbols.inputs.items()
    )
    if inputs:
        statements.append(Table(INPUTS, inputs))
    return Step("data", "Data", tuple(statements))


def _unit(part: Quantified) -> str:
    return "" if part is None or part.unit is None else str(part.unit)


def _in_unit(value: Any, part: Quantified) -> str:
    """A value in the unit in which the user gave it."""
    if value is None:
        return ""
    return f"{float(value if part is None or part.unit is None else part.unit.from_si(value, math.pi)):.10g}"


def _freedom(system: System) -> Step:
    """How many coordinates, how many of them are driven, how many rows close."""
    symbols, closing = system.symbols, system.ties.closing
    dependent = len(dependent_coordinates(system.scope))
    driven = sum(part.driven for part in system.scope.model.coordinates.values())
    others = [f"{number} of them {kind}" for number, kind in ((driven, "driven"), (dependent, "dependent")) if number]
    statements: list[Statement] = [
        prose(
            f"{count(len(system.motion.links), 'body', 'bodies')}, {count(len(symbols.q), 'coordinate')}",
            "".join(f", {other}" for other in others),
            ".",
        )
    ]
    identical = [row for row in system.ties.rows if row.identical]
    if identical:
        ties = ", ".join(dict.fromkeys(row.tie for row in identical))
        statements.append(
            prose(
                f"The coordinates satisfy {count(len(identical), 'equation')} of the constraints by themselves "
                f"({ties}): they carry reactions and take no freedom."
            )
        )
    eliminated = [row for row in system.ties.rows if row.status == "eliminated"]
    if eliminated:
        ties = ", ".join(dict.fromkeys(row.tie for row in eliminated))
        statements.append(
            prose(
                f"{count(len(eliminated), 'equation')} of the constraints ",
                "gives" if len(eliminated) == 1 else "give",
                " the rate of the dependent coordinate"
                if dependent == 1
                else " the rates of the dependent coordinates",
                f" ({ties}).",
            )
        )
    if closing:
        statements.append(
            prose(
                f"{count(len(closing), 'equation')} of the constraints ",
                "remains to be satisfied by the motion"
                if len(closing) == 1
                else "remain to be satisfied by the motion",
                " and brings a multiplier." if len(closing) == 1 else " and bring a multiplier each.",
            )
        )
    statements += _velocities(system)
    freedom = len(symbols.u) - len(closing)
    independent = ", where the constraints' equations are independent" if closing else ""
    statements.append(prose(f"{count(freedom, 'degree')} of freedom{independent}."))
    return Step("freedom", "Degrees of freedom", tuple(statements))


def _velocities(system: System) -> list[Statement]:
    """Which conditions on velocities are holonomic, and what these keep at zero."""
    try:
        found = integrability_of((system.free or system).ties)
    except (DerivationError, MissingValues):  # the ties do not close near the start: whoever needs a state says so
        return []
    statements: list[Statement] = []
    for row in () if found is None else found.rows:
        condition = f"The condition on velocities of '{row.tie}' (row {row.number}) "
        if not row.integrable:
            statements.append(prose(condition, "cannot be integrated: it restricts no position (Frobenius)."))
        elif row.integral is None:
            statements.append(prose(condition, "can be integrated (Frobenius): it is holonomic."))
        else:
            statements.append(prose(condition, "can be integrated, it is holonomic; with the constant of the start"))
            statements.append(Formula((row.integral, 0)))
    return statements


def _coordinates(system: System) -> Step:
    """Coordinates, their rates and accelerations, and what moves as the model says."""
    model, symbols, scope = system.scope.model, system.symbols, system.scope
    values = exact_parameters(model)
    begun = _begun(system)
    whole = (system.free or system).symbols
    free = {u.name.removesuffix("'"): (u, a) for u, a in zip(whole.u, whole.a, strict=True)}
    rows: list[Meaning] = []
    for q in symbols.q:
        part = model.coordinates[q.name]
        unit = _unit(part)
        kind = "dependent coordinate" if part.dependent else "coordinate"
        guessed = part.dependent and part.near is not None
        start = f"near {_start(part, part.near, values)}" if guessed else _start(part, part.start, values)
        start = begun.get(q.name, start)
        rows.append(Meaning(q, part.about or kind, unit, start))
        if q.name in free:
            u, a = free[q.name]
            speed = "" if part.dependent else _start(part, part.speed, values)
            rows.append(Meaning(u, "its rate", _per(unit, "s"), begun.get(u.name, speed)))
            if part.dependent or u in symbols.u:
                rows.append(Meaning(a, "its acceleration", _per(unit, "s^2")))
        for x in (x for x in scope.laws if x.name.rstrip("'") == q.name):
            second = x.name.endswith("''")
            what = "its acceleration, as given" if second else "its rate, as given"
            rows.append(Meaning(x, what, _per(unit, "s^2" if second else "s")))
    rows += _speeds(system, begun)
    rows.append(Meaning(symbols.t, "time", "s"))
    statements: list[Statement] = [Table(COORDINATES, tuple(rows))]
    driven: list[Statement] = []
    for q, rate in zip(symbols.q, scope.rates, strict=True):
        if q.name not in free:
            driven += _as_given(scope, q, rate)
    if driven:
        statements += [prose("Driven coordinates move as given:"), *driven]
    return Step("coordinates", "Coordinates", tuple(statements))


def _as_given(scope: Scope, q: Node, rate: Scalar) -> list[Statement]:
    """How a driven coordinate moves: formulas, or through how many samples."""
    part = scope.model.coordinates[q.name]
    of = {"": part.motion, "The rate of ": part.rate, "The acceleration of ": part.acceleration}
    for what, law in of.items():
        if law is not None and law.sampled is not None:
            return [prose(what, q, f" is {law.text}.")]
    motion = [] if part.motion is None else [Formula((q, scope.value(part.motion)))]
    laws = {x.name: law for x, law in scope.laws.items()}
    second = [Formula((scope.names[name], laws[name]))] if (name := f"{q.name}''") in laws else []
    return [*motion, Formula((Rate(q), laws.get(f"{q.name}'", rate))), *second]


def _begun(system: System) -> dict[str, str]:
    """Of each coordinate and speed that does not start as it is written where it does, so that the ties hold."""
    start = ExactStart(system)
    try:
        moved = start.moved
    except (DerivationError, MissingValues):  # the ties do not close there: whoever needs a state says so
        return {}
    coordinates, told = system.scope.model.coordinates, dict[str, str]()
    for x in (x for x in (*system.symbols.q, *system.symbols.u) if x.name in moved):
        part = coordinates.get(x.name.removesuffix("'"))
        if start.numbers:
            told[x.name] = _in_unit(start.numbers[x], part)
        elif x in start.exact:
            told[x.name] = to_text(start.exact[x])
    return told


def _speeds(system: System, begun: Mapping[str, str]) -> list[Meaning]:
    """The speeds that are no rates, and their derivatives."""
    model, symbols = system.scope.model, system.symbols
    values = exact_parameters(model)
    rows: list[Meaning] = []
    for u, a in zip(symbols.u, symbols.a, strict=True):
        if u.name in model.speeds:
            part = model.speeds[u.name]
            start = begun.get(u.name, "" if part.start is None else _shown_value(part.start, values, None))
            rows += [Meaning(u, part.about or "speed", "", start), Meaning(a, "its derivative", "")]
    return rows


def _per(unit: str, time: str) -> str:
    """A unit per second: rad/s."""
    return "" if not unit else f"{unit}/{time}" if "/" not in unit else f"({unit})/{time}"


def _start(part: Coordinate, expression: Expression | None, values: Mapping[str, Any]) -> str:
    """A start value in the user's unit, "0" where none is given."""
    if expression is None:
        return "" if part.driven else "0"
    return _shown_value(expression, values, part)


def _shown_value(expression: Expression, values: Mapping[str, Any], part: Coordinate | None) -> str:
    """A value in the unit of a coordinate, else in SI; an expression of parameters without values as text."""
    if expression.names <= values.keys() | {"pi"}:
        return _in_unit(expression.evaluate({**values, "pi": math.pi}), part)
    return expression.text


def moved_coordinates(system: System) -> tuple[Node, ...]:
    """The coordinate of each speed; of a speed that is no rate the speed itself."""
    rates = {f"{q.name}'": q for q in system.symbols.q}
    return tuple(rates.get(u.name, u) for u in system.symbols.u)
