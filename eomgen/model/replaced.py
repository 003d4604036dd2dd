"""Model -> the model with what a person typed: values of parameters, starts and inputs; and what was taken."""

from __future__ import annotations

import math
import warnings
from collections.abc import Iterable, Mapping
from contextlib import suppress
from dataclasses import replace
from typing import Any

from eomgen.errors import ExpressionError, ModelError, UsageError
from eomgen.model.arithmetic import value_of
from eomgen.model.feedback import law_of, with_feedback
from eomgen.model.fields import WrittenEquation, is_mixed
from eomgen.model.findings import Finding, nearest
from eomgen.model.part import altered
from eomgen.model.parts import Model
from eomgen.model.samples import TimeLawRule
from eomgen.model.table import Table
from eomgen.model.typed import Settled, Typing, shown
from eomgen.model.values import exact_parameters
from eomgen.records import dataclass
from eomgen.symbolic.expression.expressions import Expression
from eomgen.symbolic.expression.typed import Typed, parse_typed_equation
from eomgen.symbolic.expression.units import parse_unit

Values = Mapping[str, Typed]


@dataclass(frozen=True)
class Taken:
    """What was made of something that was typed.

    Args:
        value: in the unit; None where it needs parameters without one; of a range, a slider or a law what it is made
            of, each.
        told: how these are said.
    """

    name: str
    typed: str
    value: float | tuple[float, ...] | None
    unit: str
    told: str = ""

    def __str__(self) -> str:
        if self.told or self.value is None:
            return f"{self.name} = {self.told or self.typed}"
        return f"{self.name} = {self.value:.10g} {self.unit}".rstrip()

    def as_dict(self) -> dict[str, Any]:
        return {"typed": self.typed, "value": self.value, "unit": self.unit}


@dataclass(frozen=True)
class Valued:
    """A model with what was typed in it.

    Args:
        taken: of each value.
        start: the starts among them, in numbers; those that need parameters without a value left out.
    """

    model: Model
    taken: tuple[Taken, ...] = ()
    start: Mapping[str, float] = Table()


def with_values(
    model: Model,
    parameters: Values | None = None,
    start: Values | None = None,
    *,
    options: tuple[str, str] = ("parameters", "start"),
    declared: bool = False,
) -> Valued:
    """The model with other values of parameters and starts.

    Args:
        parameters, start: by name; of the start also rates (`theta'`) and declared speeds.
        options: what messages call the two.
        declared: as of Typing.
    Raises:
        UsageError: a name that there is not, a value that cannot be.
    """
    if not parameters and not start:
        return Valued(model)
    changed, settled = {}, []
    typing = Typing(model, declared)
    for name, typed in (parameters or {}).items():
        if name not in model.parameters:
            what = f"{options[0]}: there is no parameter '{name}'"
            is_start = name.rstrip("'") in model.coordinates or name in model.speeds
            near = _near(name, model.parameters)
            raise UsageError(what, mend=f"its start is given by {options[1]}" if is_start else near)
        found = _settled(typing, name, typed, options[0])
        changed[name] = _with_value(model.parameters[name], "value", found.value)
        settled.append(found)
    made = altered(model, parameters=Table({**model.parameters, **changed}))
    coordinates, speeds = dict(model.coordinates), dict(model.speeds)
    typing = Typing(made, declared)
    for name, typed in (start or {}).items():
        _refuse_given(model, name, options[1])
        found = _settled(typing, name, typed, options[1])
        settled.append(found)
        if not declared:
            _warn_of_turns(name, typed, found)
        base, value = name.rstrip("'"), replace(found.value, typed=True)
        if name in speeds:
            speeds[name] = altered(speeds[name], start=value)
        elif name == base:
            coordinates[name] = altered(_with_value(coordinates[name], "start", value), near=None)
        else:
            coordinates[base] = _with_value(coordinates[base], "speed", value)
    changes: dict[str, Any] = {
        "parameters": made.parameters,
        "coordinates": Table(coordinates),
        "speeds": Table(speeds),
    }
    try:
        replace(model, **changes)  # what is wrong with a model is wrong with this one
    except ModelError as error:
        names = ", ".join(option for option, given in zip(options, (parameters, start), strict=True) if given)
        raise UsageError(f"{names}: {error.problems[0].what}", mend=error.problems[0].mend) from error
    valued = altered(model, **changes)
    taken = tuple(taken_of(valued, each) for each in settled)
    numbers = {**exact_parameters(valued), "pi": math.pi}
    starts = {each.name: value_of(each.value, numbers) for each in settled if each.name in (start or {})}
    return Valued(valued, taken, Table({name: float(x) for name, x in starts.items() if x is not None}))


def _warn_of_turns(name: str, typed: Typed, found: Settled) -> None:
    """A plain number in Python is in SI; of an angle that the file has in degrees more than a turn is hardly meant."""
    angle = found.unit is not None and found.unit.si == "rad" and found.unit.text != "rad"
    number = math.nan
    with suppress(ValueError):
        number = float(typed) if isinstance(typed, (int, float, str)) else math.nan
    if angle and abs(number) > 2 * math.pi:
        unit = found.unit.text if found.unit is not None else ""
        told = f"{name} = {number:g} is {number:g} rad: plain numbers are in SI; '{number:g} {unit}' has its unit"
        warnings.warn(told, RuntimeWarning, stacklevel=5)


def _with_value(part: Any, key: str, value: Expression) -> Any:
    """A part with another value; one with names in it is in SI, and so the part is."""
    in_si = part.unit is not None and is_mixed(value, part.unit)
    return altered(part, **{key: value}, **({"unit": parse_unit(part.unit.si)} if in_si else {}))


def _settled(typing: Typing, name: str, typed: Typed, option: str) -> Settled:
    try:
        return typing.value(name, typed)
    except ExpressionError as error:
        raise UsageError(f"{option} {name}={shown(typed)}: {error.what}", mend=error.mend) from error


def taken_of(model: Model, settled: Settled) -> Taken:
    """A settled value in the unit that is declared, else as it was typed, else in SI."""
    number, unit, dimension = None, settled.unit, settled.dimension
    try:
        number = value_of(settled.value, {**exact_parameters(model), "pi": math.pi})
    except ModelError:  # a parameter without a value: told by whoever needs it
        number = None
    if number is not None:
        number = float(number if unit is None else unit.from_si(float(number), math.pi))
    text = unit.text if unit is not None else str(dimension) if dimension and not dimension.unknowns else ""
    return Taken(settled.name, settled.typed, number, text)


def equation_typed(model: Model, text: str, *, declared: bool = False) -> tuple[WrittenEquation, tuple[Taken, ...]]:
    """An equation that a person typed, in SI, and what was taken of it.

    Args:
        declared: as of Typing.
    Raises:
        ExpressionError: it is none, or a unit does not fit.
    """
    (left, one), (right, other) = parse_typed_equation(text)
    equation, settled = Typing(model, declared).equation(WrittenEquation(left, right, text, (one, other)))
    return equation, tuple(taken_of(model, each) for each in settled)


def _refuse_given(model: Model, name: str, option: str) -> None:
    """Refuses a start of what is none, or of what the model drives.

    Raises:
        UsageError: it is named.
    """
    base = name.rstrip("'")
    rates = [f"{q}'" for q in model.coordinates]
    if name not in (*model.coordinates, *rates, *model.speeds):
        what = f"{option}: there is no coordinate or speed '{name}'"
        near = _near(name, (*model.coordinates, *rates, *model.speeds))
        other = "--set" if option.startswith("--") else "parameters="
        raise UsageError(what, mend=f"a parameter is given by {other}" if name in model.parameters else near)
    part = model.coordinates.get(base)
    if part is not None and (part.motion is not None or (part.rate is not None and base != name)):
        way = "motion" if part.motion is not None else "rate"
        raise UsageError(f"{option}: '{name}' starts where its `{way}` says", mend="give no other start")


def time_law(model: Model, name: str, value: Any, option: str) -> Expression:
    """A function of time that is given in Python: a number in SI or with a unit, an expression, samples [SI].

    Args:
        name: whose value it is; option: what messages call it.
    Raises:
        UsageError: it is none, or its unit does not fit.
    """
    if isinstance(value, Mapping):
        found: list[Finding] = []
        law: Expression | None = TimeLawRule().read(value, (option, name), found)
        if law is None or found:
            raise UsageError(f"{option}: {name}: {found[0].what}", mend=found[0].mend)
        return law
    if isinstance(value, Expression):
        return value
    return _settled(Typing(model, declared=False), name, value, option).value


def _near(name: str, names: Iterable[str]) -> str:
    return nearest(name, names) or f"there are {', '.join(names) or 'none'}"


def with_inputs(model: Model, inputs: Mapping[str, Any]) -> Model:
    """The model with other values of inputs: numbers in SI or with a unit, expressions of t and the parameters,
    `samples(...)`, or laws of the state ("-k*x - c*x'"), which then stand in place of the input.

    Raises:
        UsageError: no input of that name, a value that is none, a unit that does not fit; or a Python function, which
            nothing can differentiate or emit.
    """
    for name, value in inputs.items():
        if name not in model.inputs:
            raise UsageError(f"there is no input '{name}'", mend=nearest(name, model.inputs))
        if callable(value):
            what = f"input '{name}' is given by a Python function"
            raise UsageError(what, mend="give an expression of t or the state, or eomgen.samples(times, values)")
    laws = {name: law for name, value in inputs.items() if (law := law_of(model, value)) is not None}
    values = {name: time_law(model, name, value, "inputs") for name, value in inputs.items() if name not in laws}
    changed = {name: _with_value(model.inputs[name], "value", value) for name, value in values.items()}
    made = altered(model, inputs=Table({**model.inputs, **changed})) if changed else model
    if changed:
        replace(model, inputs=made.inputs)  # what is wrong with a model is wrong with this one
    return with_feedback(made, laws)
