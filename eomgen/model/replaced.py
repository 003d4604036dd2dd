"""Model -> the model with what a person typed: values of parameters, starts and inputs; and what was taken.

Requests are typed too: a range, an equation, an output of a text, "max(reaction_x(A))", "theta' at theta = 0, event 2".
"""

from __future__ import annotations

import csv
import errno
import io
import math
import re
import warnings
from collections.abc import Callable, Iterable, Mapping, Sequence
from contextlib import suppress
from dataclasses import replace
from functools import cached_property
from typing import Any

import numpy as np

from eomgen.errors import ExpressionError, ModelError, UsageError
from eomgen.files import read
from eomgen.frozen import dataclass
from eomgen.model.diagnostics import Diagnostic, nearest
from eomgen.model.expansion import counted_anew
from eomgen.model.fields import EVERY, AtRest, Table, WrittenEquation, is_mixed
from eomgen.model.model import Model
from eomgen.model.parts import Coordinate, Output
from eomgen.model.quantities import Typed, Unit, parse_typed_equation
from eomgen.model.restated import with_feedback
from eomgen.model.sampled_laws import TimeLawRule, samples
from eomgen.model.units import Settled, Typing, shown
from eomgen.symbolic.expression import Expression, as_expression, parse

Values = Mapping[str, Typed]


@dataclass(frozen=True)
class Taken:
    """The interpretation of something that was typed.

    Args:
        value: in the unit; None where it needs parameters without one; of a range, a slider or a law all the values of
            which it consists.
        reported: the text that says it, where it is no single value.
    """

    name: str
    typed: str
    value: float | tuple[float, ...] | None
    unit: str
    reported: str = ""

    def __str__(self) -> str:
        if self.reported or self.value is None:
            return f"{self.name} = {self.reported or self.typed}"
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

    @classmethod
    def of(
        cls,
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
            return cls(model)
        changed, settled = {}, []
        model = _with_counts(model, parameters or {}, options[0])
        typing = Typing(model, declared)
        for name, typed in (parameters or {}).items():
            if name not in model.parameters:
                what = f"{options[0]}: there is no parameter '{name}'"
                is_start = name.rstrip("'") in model.coordinates or name in (*model.speeds, *model.states)
                near = _near(name, model.parameters)
                raise UsageError(what, fix=f"its start is given by {options[1]}" if is_start else near)
            found = _settled(typing, name, typed, options[0])
            changed[name] = _with_value(model.parameters[name], "value", found.value)
            settled.append(found)
        made = model.altered(parameters=Table({**model.parameters, **changed}))
        coordinates, speeds, states = dict(model.coordinates), dict(model.speeds), dict(model.states)
        typing = Typing(made, declared)
        for name, typed in (start or {}).items():
            _refuse_given(model, name, options[1])
            found = _settled(typing, name, typed, options[1])
            settled.append(found)
            if not declared:
                _warn_of_turns(name, typed, found)
            base, value = name.rstrip("'"), replace(found.value, typed=True)
            if name in speeds:
                speeds[name] = speeds[name].altered(start=value)
            elif name in states:
                states[name] = _with_value(states[name], "start", value)
            elif name == base:
                coordinates[name] = _with_value(coordinates[name], "start", value).altered(near=None)
            else:
                coordinates[base] = _with_value(coordinates[base], "speed", value)
        changes: dict[str, Any] = {
            "parameters": made.parameters,
            "coordinates": Table(coordinates),
            "speeds": Table(speeds),
            "states": Table(states),
        }
        try:
            replace(model, **changes)  # what is wrong with a model is wrong with this one
        except ModelError as error:
            names = ", ".join(option for option, given in zip(options, (parameters, start), strict=True) if given)
            raise UsageError(f"{names}: {error.problems[0].what}", fix=error.problems[0].fix) from error
        valued = model.altered(**changes)
        taken = tuple(taken_of(valued, each) for each in settled)
        numbers = {**valued.exact_parameters(), "pi": math.pi}
        starts = {each.name: each.value.value_at(numbers) for each in settled if each.name in (start or {})}
        return cls(valued, taken, Table({name: float(x) for name, x in starts.items() if x is not None}))


def _with_counts(model: Model, parameters: Values, option: str) -> Model:
    """The model made again, where parameters by which its things are counted have other values."""
    counts: dict[str, int] = {}
    for name in model.counts:
        if name in parameters:
            value = _settled(Typing(model, False), name, parameters[name], option).value
            number = value.value_at({}) if value.is_plain else None
            if number is None or number != int(number) or number < 0:
                what = f"{option} {name}={shown(parameters[name])}: '{name}' counts things of the model"
                raise UsageError(what, fix=f"give a whole number: {name}=5")
            counts[name] = int(number)
    if not counts:
        return model
    try:
        made: Model = counted_anew(model, counts)
    except ModelError as error:
        raise UsageError(f"{option}: {error.problems[0].what}", fix=error.problems[0].fix) from error
    return made


def _warn_of_turns(name: str, typed: Typed, found: Settled) -> None:
    """Warns of an angle of more than a turn, given in Python as a plain number, which is in SI, not in degrees."""
    angle = found.unit is not None and found.unit.si == "rad" and found.unit.text != "rad"
    number = math.nan
    with suppress(ValueError):
        number = float(typed) if isinstance(typed, (int, float, str)) else math.nan
    if angle and abs(number) > 2 * math.pi:
        unit = found.unit.text if found.unit is not None else ""
        reported = f"{name} = {number:g} is {number:g} rad: plain numbers are in SI; '{number:g} {unit}' has its unit"
        warnings.warn(reported, RuntimeWarning, stacklevel=5)


def _with_value(part: Any, key: str, value: Expression) -> Any:
    """A part with another value; one with names in it is in SI, and so the part is."""
    in_si = part.unit is not None and is_mixed(value, part.unit)
    return part.altered(**{key: value}, **({"unit": Unit.parse(part.unit.si)} if in_si else {}))


def _settled(typing: Typing, name: str, typed: Typed, option: str) -> Settled:
    try:
        return typing.value(name, typed)
    except ExpressionError as error:
        raise UsageError(f"{option} {name}={shown(typed)}: {error.what}", fix=error.fix) from error


def taken_of(model: Model, settled: Settled) -> Taken:
    """A settled value in the unit that is declared, else as it was typed, else in SI."""
    number, unit, dimension = None, settled.unit, settled.dimension
    try:
        number = settled.value.value_at({**model.exact_parameters(), "pi": math.pi})
    except ModelError:  # a parameter without a value: reported by whoever needs it
        number = None
    if number is not None:
        number = float(number if unit is None else unit.from_si(float(number), math.pi))
    text = unit.text if unit is not None else str(dimension) if dimension and not dimension.unknowns else ""
    return Taken(settled.name, settled.typed, number, text)


def assignments(given: Iterable[str], example: str) -> list[tuple[str, str]]:
    """(name, text) of each NAME=VALUE.

    Raises:
        UsageError: a word that is no assignment; `example` is its fix.
    """
    pairs = []
    for word in given:
        name, sign, text = word.partition("=")
        if not sign or not name.strip() or not text.strip():
            raise UsageError(f"'{word}' is no assignment", fix=f"write {example}")
        pairs.append((name.strip(), text.strip()))
    return pairs


def _refuse_given(model: Model, name: str, option: str) -> None:
    """Refuses a start of what is none, or of what the model drives.

    Raises:
        UsageError: it is named.
    """
    base = name.rstrip("'")
    rates = [f"{q}'" for q in model.coordinates]
    if name not in (known := (*model.coordinates, *rates, *model.speeds, *model.states)):
        what = f"{option}: there is no coordinate{', speed or state' if model.states else ' or speed'} '{name}'"
        near = _near(name, known)
        other = "--set" if option.startswith("--") else "parameters="
        raise UsageError(what, fix=f"a parameter is given by {other}" if name in model.parameters else near)
    part = model.coordinates.get(base)
    if part is not None and (part.motion is not None or (part.rate is not None and base != name)):
        way = "motion" if part.motion is not None else "rate"
        raise UsageError(f"{option}: '{name}' starts where its `{way}` says", fix="give no other start")


def _near(name: str, names: Iterable[str]) -> str:
    return nearest(name, names) or f"there are {', '.join(names) or 'none'}"


# -------- requests --------------------------------------------------------------------------------------------
# Texts and values that somebody typed beside a model: equations, outputs, laws of inputs, samples that are followed.


@dataclass(frozen=True)
class Requests:
    """Reader of what is requested of a model by texts, or by values in Python."""

    model: Model

    def equation(self, text: WrittenEquation | str) -> WrittenEquation:
        """The equation of a text that a person typed, in SI; one that is written already stays as it is.

        Raises:
            ExpressionError: it is none, or a unit does not fit.
        """
        return text if isinstance(text, WrittenEquation) else self.equation_taken(text)[0]

    def equation_taken(self, text: str, *, declared: bool = False) -> tuple[WrittenEquation, tuple[Taken, ...]]:
        """An equation that a person typed, in SI, and what was taken of it.

        Args:
            declared: as of Typing.
        Raises:
            ExpressionError: it is none, or a unit does not fit.
        """
        (left, one), (right, other) = parse_typed_equation(text)
        equation, settled = Typing(self.model, declared).equation(WrittenEquation(left, right, text, (one, other)))
        return equation, tuple(taken_of(self.model, each) for each in settled)

    def output(self, text: str) -> Output:
        """Output that a text requests: an output's name, a formula, "FORMULA at EQUATION" with ", event 2" or "every".

        In a formula the name of an output without an instant stands for its formula.

        Raises:
            UsageError: the text cannot be read, or a name in it is unknown.
        """
        if text in self.model.outputs:
            return self.model.outputs[text]
        formula, at, condition = text.partition(" at ")
        condition, comma, event = condition.partition(", event")
        try:
            written = _in_full(self.model, formula.strip())
            output = Output(value=parse(written, references=True, tables=self.model.functions))
            if at:
                when: Any = AtRest() if condition.strip() == AtRest.text else self.equation(condition.strip())
                output = replace(output, at=when)
            if comma:
                output = replace(output, event=EVERY if event.strip() == EVERY else int(event))
            self.model.requesting({"asked": output})
        except ValueError as error:
            raise UsageError(f"'{text}': '{event.strip()}' is no number of an event", fix=f"2, or {EVERY}") from error
        except ExpressionError as error:
            raise UsageError(f"'{text}': {error.what}", fix=error.fix) from error
        except ModelError as error:
            raise UsageError(f"'{text}': {error.problems[0].what}", fix=error.problems[0].fix) from error
        return output

    def output_taken(self, text: str) -> tuple[str, tuple[Taken, ...]]:
        """Request whose plain numbers of the instant have the units of the model file, and these readings.

        Raises:
            UsageError: the instant cannot be read, or a unit does not fit.
        """
        formula, at, rest = text.partition(" at ")
        condition, comma, event = rest.partition(", event")
        if text in self.model.outputs or not at or condition.strip() == AtRest.text:
            return text, ()
        try:
            sides = parse_typed_equation(condition)
            _, taken = self.equation_taken(condition, declared=True)
        except ExpressionError as error:
            raise UsageError(f"'{text}': {error.what}", fix=error.fix) from error
        units = {each.typed: each.unit for each in taken}
        own = ((side.text, units.get(side.text, "") if unit is None else unit.text) for side, unit in sides)
        written = (f"{number} {unit}".strip() for number, unit in own)
        return f"{formula} at {' = '.join(written)}{comma}{event}", taken

    def law(self, name: str, value: Any, option: str) -> Expression:
        """A function of time that is given in Python: a number in SI or with a unit, an expression, samples [SI].

        Args:
            name: whose value it is; option: what messages call it.
        Raises:
            UsageError: it is none, or its unit does not fit.
        """
        if isinstance(value, Mapping):
            found: list[Diagnostic] = []
            law: Expression | None = TimeLawRule().read(value, (option, name), found)
            if law is None or found:
                raise UsageError(f"{option}: {name}: {found[0].what}", fix=found[0].fix)
            return law
        if isinstance(value, Expression):
            return value
        return _settled(Typing(self.model, declared=False), name, value, option).value

    def with_inputs(self, inputs: Mapping[str, Any]) -> Model:
        """The model with other values of inputs: numbers in SI or with a unit, expressions of t and the parameters,
        `samples(...)`, or laws of the state ("-k*x - c*x'"), which then stand in place of the input.

        Raises:
            UsageError: no input of that name, a value that is none, a unit that does not fit; or a Python function,
                which nothing can differentiate or emit.
        """
        for name, value in inputs.items():
            if name not in self.model.inputs:
                raise UsageError(f"there is no input '{name}'", fix=nearest(name, self.model.inputs))
            if callable(value):
                what = f"input '{name}' is given by a Python function"
                raise UsageError(what, fix="give an expression of t or the state, or eomgen.samples(times, values)")
        laws = {name: law for name, value in inputs.items() if (law := self.feedback(value)) is not None}
        values = {name: self.law(name, value, "inputs") for name, value in inputs.items() if name not in laws}
        changed = {name: _with_value(self.model.inputs[name], "value", value) for name, value in values.items()}
        made = self.model.altered(inputs=Table({**self.model.inputs, **changed})) if changed else self.model
        if changed:
            replace(self.model, inputs=made.inputs)  # what is wrong with a model is wrong with this one
        return with_feedback(made, laws)

    def following(self, given: Sequence[str]) -> Model:
        """The model with coordinates and inputs that follow files: a coordinate as it was driven, or by `motion`.

        Args:
            given: NAME=FILE each; a CSV with the times in its first column and the values, in SI, in the column NAME,
                or in its second.
        Raises:
            UsageError: no coordinate or input of that name, one that cannot be driven, or a file without samples.
        """
        coordinates, inputs = dict(self.model.coordinates), dict(self.model.inputs)
        for name, path in assignments(given, FOLLOW):
            if name in inputs:
                inputs[name] = inputs[name].altered(value=_samples_of(path, name))
            elif name in coordinates:
                coordinates[name] = _driven(coordinates[name], name, _samples_of(path, name))
            else:
                fix = _named(name, [*coordinates, *inputs])
                raise UsageError(f"--follow: there is no coordinate or input '{name}'", fix=fix)
        changes: dict[str, Any] = {"coordinates": Table(coordinates), "inputs": Table(inputs)}
        try:
            replace(self.model, **changes)  # what is wrong with a model is wrong with this one
        except ModelError as error:
            raise UsageError(f"--follow: {error.problems[0].what}", fix=error.problems[0].fix) from error
        followed: Model = self.model.altered(**changes)
        return followed

    def refuse_what_is_not_set(self, name: str, *, starts: bool) -> None:
        """Refuses a name of what takes no values.

        Args:
            starts: coordinates, rates and speeds may, too.
        Raises:
            UsageError: it is named.
        """
        known = [*self.model.parameters, *(self._moving if starts else ())]
        if name not in known:
            what = f"no parameter '{name}'" if not starts else f"no parameter, coordinate, rate or speed '{name}'"
            raise UsageError(what, fix=nearest(name, known) or Range.LIKE)
        if name in self.model.counts:
            raise UsageError(f"'{name}' counts things of the model: it has one value", fix=f"set it: {name}=5")

    def feedback(self, value: Any) -> Expression | None:
        """A law of the state: an expression with coordinates, rates or speeds in it; None for everything else."""
        if not isinstance(value, (str, Expression)):
            return None
        try:
            law = as_expression(value)
        except ExpressionError:
            return None  # reported where it is read as an input
        return law if law.names & {*self._moving} else None

    @property
    def _moving(self) -> tuple[str, ...]:
        """Names of coordinates, rates, speeds and states."""
        model = self.model
        return (*model.coordinates, *(f"{q}'" for q in model.coordinates), *model.speeds, *model.states)


# -------- ranges ----------------------------------------------------------------------------------------------
# Text -> Range: values of a parameter or start, "k=100:1000:10" (both ends, how many), "log:k=1:9:5", "k=0.5,1".


MOST = 10_000  # values
SHOWN = 6  # of a list, when it is said what was taken


@dataclass(frozen=True)
class Range:
    """Values that a parameter or start takes one after the other.

    Args:
        values: in SI.
        unit: that the file declares, "" for SI; `size` of it in SI.
        taken: what was made of the text.
    """

    LIKE = '"k=100:1000:10", "log:k=1:100:50" or "k=0.5,1,2"'

    name: str
    values: tuple[float, ...]
    unit: str
    size: float
    taken: Taken

    @classmethod
    def of(cls, model: Model, text: str, *, starts: bool = False, declared: bool = True) -> Range:
        """The values that a text means.

        Args:
            starts: starts of coordinates, rates and speeds may take values too.
            declared: plain numbers are in the unit that the file declares; else in SI.
        Raises:
            UsageError: no parameter of that name, or no values.
        """
        logarithmic = text.startswith("log:")
        name, equals, rest = text.removeprefix("log:").partition("=")
        name = name.strip()
        if not equals:
            raise UsageError(f"'{text}' is no range", fix=Range.LIKE)
        Requests(model).refuse_what_is_not_set(name, starts=starts)
        typed = TypedNumbers(model, name, declared)
        try:
            values = _values(rest, logarithmic, text, typed.number)
        except ExpressionError as error:
            raise UsageError(f"'{text}' is no range: {error.what}", fix=error.fix or Range.LIKE) from error
        unit, size = ("", 1.0) if typed.unit is None else (typed.unit.text, typed.unit.size)
        return cls(name, tuple(values), unit, size, _taken(typed, rest, logarithmic))


@dataclass(frozen=True)
class TypedNumbers:
    """Numbers as a person types them for one name: "45", "45 deg", "pi/4 rad".

    Args:
        declared: True if plain numbers are in the unit that the file declares; else they are in SI.
    """

    model: Model
    name: str
    declared: bool = True

    @cached_property
    def unit(self) -> Unit | None:
        """The unit that the file declares; of a rate per second."""
        base = self.name.rstrip("'")
        model = self.model
        part = model.parameters.get(base) or model.coordinates.get(base) or model.states.get(base)
        unit = None if part is None else part.unit
        for _ in range(len(self.name) - len(base)):
            unit = None if unit is None else unit.rate
        return unit

    @property
    def size(self) -> float:
        """Value of a plain number 1, in SI."""
        return 1.0 if self.unit is None or not self.declared else self.unit.size

    def taken(self, typed: str, texts: Sequence[str], reported: Callable[[list[str]], str]) -> Taken:
        """The interpretation of numbers that belong together.

        Args:
            typed: all that was typed.
            texts: each number of it.
            reported: (the numbers as they were taken, each with its unit) -> how they are said.
        """
        found = [taken_of(self.model, Typing(self.model, self.declared).value(self.name, text)) for text in texts]
        values = tuple(each.value for each in found if isinstance(each.value, float))
        words = [str(each).partition(" = ")[2] for each in found]
        return Taken(self.name, typed, values, found[0].unit, reported(words))

    def number(self, text: Typed) -> float:
        """The number that was typed, in SI.

        Raises:
            ValueError: it is no number.
            ExpressionError: a unit does not fit.
        """
        try:
            return float(text) * self.size
        except (ValueError, TypeError):
            typed = text.strip() if isinstance(text, str) else text
            value = Typing(self.model, self.declared).value(self.name, typed).value
        found = value.value_at({**self.model.exact_parameters(), "pi": math.pi})
        if found is None:
            raise ValueError(text)
        return float(found)


def typed_values(given: Any) -> list[Typed]:
    """The values of what is given in Python: one, several, an array with its unit, an array of pint's."""
    if isinstance(given, tuple) and len(given) == 2 and isinstance(given[1], str) and not isinstance(given[0], str):
        return [(x, given[1]) for x in np.atleast_1d(given[0]).tolist()]
    if hasattr(given, "to_base_units"):
        return [x * given.units for x in np.atleast_1d(given.magnitude).tolist()]
    return [*given] if isinstance(given, (list, tuple)) else np.atleast_1d(given).tolist()


def are_several(given: Any) -> bool:
    """True if values given in Python are several, perhaps an array with a unit, and not one value."""
    if isinstance(given, tuple) and len(given) == 2 and isinstance(given[1], str):
        given = given[0]
    return isinstance(given, list) or np.ndim(getattr(given, "magnitude", given)) == 1


def _taken(typed: TypedNumbers, rest: str, logarithmic: bool) -> Taken:
    ends = rest.split(":")
    if len(ends) == 1:
        texts = rest.split(",")
        few = texts if len(texts) <= SHOWN else [*texts[: SHOWN - 1], texts[-1]]
        more = "" if few is texts else f", {len(texts)} values"
        return typed.taken(rest, [x.strip() for x in few], lambda x: ", ".join(x) + more)
    spread = "each by one factor" if logarithmic else "equally apart"
    reported = f", {int(ends[2])} values {spread}"
    return typed.taken(rest, [x.strip() for x in ends[:2]], lambda x: " to ".join(x) + reported)


def _values(rest: str, logarithmic: bool, text: str, number: Callable[[str], float]) -> list[float]:
    """The numbers in SI.

    Raises:
        UsageError: they are none.
    """
    try:
        if ":" not in rest:
            return _finite([number(x) for x in rest.split(",")], text)
        start, stop, count = rest.split(":")
        low, high, n = number(start), number(stop), int(count)
    except ValueError as error:
        raise UsageError(f"'{text}' is no range", fix=Range.LIKE) from error
    if not 2 <= n <= MOST or (logarithmic and min(low, high) <= 0):
        what = "a range of powers has ends above 0" if logarithmic and min(low, high) <= 0 else f"{n} values"
        raise UsageError(f"'{text}' is no range: {what}", fix=f"from 2 to {MOST} values, like {Range.LIKE}")
    _finite([low, high], text)
    shares = [k / (n - 1) for k in range(n)]
    if logarithmic:
        return [low * (high / low) ** share for share in shares]
    return [low + (high - low) * share for share in shares]


def _finite(values: list[float], text: str) -> list[float]:
    if all(math.isfinite(x) for x in values):
        return values
    raise UsageError(f"'{text}' is no range: its values are no numbers", fix=Range.LIKE)


def _in_full(model: Model, formula: str) -> str:
    """Formula in which names of outputs without an instant are replaced by their formulas."""
    tables = [*model.trusses.values(), model]
    others = {
        name
        for part in tables
        for what, x in vars(part).items()
        if isinstance(x, Table) and what != "outputs"
        for name in x
    }
    plain = {name: f"({output.value})" for name, output in model.outputs.items() if output.at is None}
    names = "|".join(map(re.escape, plain.keys() - others))
    return re.sub(rf"(?<![\w.])({names})(?![\w.'(])", lambda found: plain[found[0]], formula) if names else formula


# -------- samples of a file -----------------------------------------------------------------------------------
# `--follow theta=run.csv`: a motion or an input through the samples of a file, in place of the model's own.


FOLLOW = "--follow theta=run.csv"
LARGEST = 100_000_000  # bytes of a file
LAWS = ("motion", "rate", "acceleration")


def _driven(part: Coordinate, name: str, law: Expression) -> Coordinate:
    if part.dependent:
        raise UsageError(
            f"--follow: coordinate '{name}' is dependent, the constraints move it", fix="drive another one"
        )
    (way,) = [way for way in LAWS if getattr(part, way) is not None] or ["motion"]
    own = {} if way != "motion" else {"start": None, "speed": None}
    driven: Coordinate = part.altered(**{way: law}, **own)
    return driven


def _samples_of(path: str, name: str) -> Expression:
    """The samples of a file.

    Raises:
        UsageError: it cannot be read, or holds no samples.
    """
    try:
        data = read(path, LARGEST)
        if len(data) > LARGEST:
            raise OSError(errno.EFBIG, f"it is longer than {LARGEST // 10**6} MB")
        lines = io.StringIO(data.decode("utf-8-sig"), newline="")
        rows = [row for row in csv.reader(lines) if row and not row[0].lstrip().startswith("#")]
    except UnicodeDecodeError as error:
        what = f"--follow: not UTF-8: byte 0x{error.object[error.start]:02x}"
        raise UsageError(what, path, "write plain text: a time and a value a row") from error
    except (OSError, csv.Error) as error:
        raise UsageError(
            f"--follow: cannot be read: {getattr(error, 'strerror', None) or error}",
            path,
            "name a file that can be read",
        ) from error
    if any(mark in row[0] for row in rows for mark in ";\t"):
        raise UsageError("--follow: columns stand between commas", path, "write 0.5,1.25: decimals have points")
    heads = [word.strip() for word in rows.pop(0)] if rows and not _is_a_number(rows[0][0]) else []
    if name not in heads and len(heads) > 2:
        raise UsageError(f"--follow: there is no column '{name}'", path, _named(name, heads[1:]))
    column = heads.index(name) if name in heads else 1
    if any(len(row) <= column for row in rows):
        raise UsageError(f"--follow: a row has no column {column + 1}", path, fix="write a time and a value a row")
    try:
        return samples([row[0].strip() for row in rows], [row[column].strip() for row in rows])
    except ModelError as error:
        raise UsageError(f"--follow: {error.problems[0].what}", path, fix=error.problems[0].fix) from error


def _is_a_number(text: str) -> bool:
    try:
        float(text)
    except ValueError:
        return False
    return True


def _named(name: str, names: Sequence[str]) -> str:
    return nearest(name, names) or f"there are {', '.join(names) or 'none'}"
