"""Model, laws of inputs over the state -> the model in which they stand in place of the inputs: feedback."""

from __future__ import annotations

import re
from collections.abc import Mapping
from dataclasses import replace
from typing import Any

from eomgen.errors import ExpressionError, UsageError
from eomgen.model.catalog import Catalog
from eomgen.model.diagnostics import nearest
from eomgen.model.fields import MOTION, Table, WrittenEquation
from eomgen.model.model import Model
from eomgen.model.part import Part
from eomgen.symbolic.expression import Call, Expression, Instruction, Reference, as_expression

# What is put in so is derived, proven and emitted with everything else.


Laws = Mapping[str, Expression]


def law_of(model: Model, value: Any) -> Expression | None:
    """A law of the state: an expression with coordinates, rates or speeds in it; None for everything else."""
    if not isinstance(value, (str, Expression)):
        return None
    try:
        law = as_expression(value)
    except ExpressionError:
        return None  # reported where it is read as an input
    moving = {*model.coordinates, *(f"{q}'" for q in model.coordinates), *model.speeds, *model.states}
    return law if law.names & moving else None


def with_feedback(model: Model, laws: Laws) -> Model:
    """The model with laws in place of inputs; their gains may be plain numbers, whatever their dimensions.

    Raises:
        UsageError: a law names what there is not, or what may not stand where its input stood.
    """
    if not laws:
        return model
    allowed = Catalog(model, ()).allowed[MOTION] - laws.keys()
    for name, law in laws.items():
        strangers = [other for other, _ in law.occurrences if other not in allowed]
        if strangers:
            what = f"inputs: {name} = {law.text}: '{strangers[0]}' cannot stand in it"
            raise UsageError(
                what, fix=nearest(strangers[0], allowed) or "coordinates, rates, t, parameters, other inputs"
            )
    left = {name: part for name, part in model.inputs.items() if name not in laws}
    fields = {slot.name: getattr(model, slot.name) for slot in Model.slots() if slot.name != "inputs"}
    return model.altered(**{name: _put(value, laws) for name, value in fields.items()}, inputs=Table(left))


def _put(value: Any, laws: Laws) -> Any:
    """A value of the model with the laws in it."""
    if isinstance(value, Expression):
        return _expression(value, laws)
    if isinstance(value, WrittenEquation):
        return replace(value, left=_expression(value.left, laws), right=_expression(value.right, laws))
    if isinstance(value, Part):
        fields = {slot.name: getattr(value, slot.name) for slot in type(value).slots()}
        return type(value).of_values({name: _put(x, laws) for name, x in fields.items()})
    if isinstance(value, tuple):
        return tuple(_put(x, laws) for x in value)
    return Table({name: _put(x, laws) for name, x in value.items()}) if isinstance(value, Table) else value


def _expression(formula: Expression, laws: Laws) -> Expression:
    """A formula in which a law stands for each of its names."""
    if laws.keys().isdisjoint(formula.names):
        return formula
    code: list[Instruction] = []
    columns: list[int] = []
    for (kind, what), column in zip(formula.code, formula.columns, strict=True):
        law = laws.get(what) if kind == "name" else None
        if law is not None:
            code += law.code
            columns += [-1] * len(law.code)
            continue
        code.append((kind, _called(what, laws) if kind == "call" else what))
        columns.append(column)
    text = formula.text
    for name, law in laws.items():
        text = f"({law.text})".join(re.split(rf"(?<![\w.']){re.escape(name)}(?![\w'(])", text))
    return Expression(text, tuple(code), tuple(columns))


def _called(call: Call, laws: Laws) -> Call:
    return replace(call, args=tuple(x if isinstance(x, Reference) else _expression(x, laws) for x in call.args))
