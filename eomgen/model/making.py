"""Declared parts -> a finished Model: fields read, checks made, names of places resolved."""

from collections.abc import Mapping
from dataclasses import replace
from typing import Any

from eomgen.errors import ModelError, Problem
from eomgen.model.fields import Finding
from eomgen.model.part import made, read_part, slots_of
from eomgen.model.table import Table


def draft_of(raw: Mapping[str, Any], title: str, found: list[Finding]) -> Any:
    """A model from the tables of a file, unchecked; what could not be read is None and among the findings."""
    from eomgen.model.parts import Model

    draft = read_part(Model, raw, (), found, known=("eomgen",))
    if draft.name is None:
        object.__setattr__(draft, "name", title)
    _resolve(draft)
    return draft


def finish(model: Any) -> None:
    """Reads the fields of a model made in Python and checks it as a whole.

    Raises:
        ModelError: every problem at once, by path ("bodies.arm.joint.on").
    """
    found: list[Finding] = []
    for slot in slots_of(type(model)):
        value = slot.rule.read(getattr(model, slot.name), (slot.key,), found) if _given(model, slot) else slot.default
        object.__setattr__(model, slot.name, value)
    _resolve(model)
    found += findings_of(model, found)
    if found:
        raise ModelError(tuple(Problem(".".join(map(str, f.path)), f.what, mend=f.mend) for f in found))


def findings_of(model: Any, found: list[Finding]) -> list[Finding]:
    """What is wrong with a model that was read, beyond what reading found already."""
    return []
