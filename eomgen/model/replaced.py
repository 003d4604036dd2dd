"""Model, other functions of time -> the model whose inputs are these."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from typing import Any

from eomgen.errors import UsageError
from eomgen.model.findings import nearest
from eomgen.model.parts import Model
from eomgen.model.table import Table


def with_inputs(model: Model, inputs: Mapping[str, Any]) -> Model:
    """The model with other values of inputs: numbers, expressions of t and the parameters, or `samples(...)`.

    Raises:
        UsageError: no input of that name, or a Python function, which nothing can differentiate or emit.
        ModelError: an expression that cannot be read.
    """
    for name, value in inputs.items():
        if name not in model.inputs:
            raise UsageError(f"there is no input '{name}'", mend=nearest(name, model.inputs))
        if callable(value):
            what = f"input '{name}' is given by a Python function"
            raise UsageError(what, mend="give an expression of t, as '5*sin(2*t)', or eomgen.samples(times, values)")
    changed = {name: replace(model.inputs[name], value=value) for name, value in inputs.items()}
    return replace(model, inputs=Table({**model.inputs, **changed})) if changed else model
