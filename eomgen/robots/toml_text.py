"""Tables of a model file -> its text, as a person lays it out."""

from __future__ import annotations

import json
import re
import textwrap
from collections.abc import Mapping, Sequence
from decimal import Decimal
from typing import Any

from eomgen.errors import HIDDEN, visible

BARE = re.compile(r"[A-Za-z0-9_-]+")
WIDTH = 118  # of a remark
SHORT = ("parameters", "coordinates", "speeds", "inputs", "points", "outputs")  # tables of one line an entry


def toml_text(tables: Mapping[str, Any], before: Sequence[str] = (), after: Sequence[str] = ()) -> str:
    """The text of a model file; remarks stand before and after it."""
    lines = [*_remarks(before), *(f"{_key(k)} = {_value(v)}" for k, v in tables.items() if not isinstance(v, Mapping))]
    for name, table in tables.items():
        if not isinstance(table, Mapping):
            continue
        if name in SHORT:
            lines += ["", f"[{_key(name)}]", *(f"{_key(key)} = {_entry(value)}" for key, value in table.items())]
            continue
        for key, part in table.items():
            lines += ["", f"[{_key(name)}.{_key(key)}]", *(f"{_key(k)} = {_value(v)}" for k, v in part.items())]
    return "\n".join([*lines, *([""] if after else []), *_remarks(after), ""])


def _remarks(remarks: Sequence[str]) -> list[str]:
    return [
        line
        for remark in remarks
        for line in textwrap.wrap(
            visible(remark), WIDTH, initial_indent="# ", subsequent_indent="#   ", break_on_hyphens=False
        )
    ]


def _key(name: str) -> str:
    return name if BARE.fullmatch(name) else _text(name)


def _entry(value: Any) -> str:
    """An entry of a short table: a table of one start or value is that alone."""
    if isinstance(value, Mapping) and len(value) == 1 and next(iter(value)) in ("start", "value"):
        return _value(next(iter(value.values())))
    return _value(value)


def _value(value: Any) -> str:
    if isinstance(value, bool):
        return "true" if value else "false"
    if isinstance(value, Mapping):
        return "{ " + ", ".join(f"{_key(k)} = {_value(v)}" for k, v in value.items()) + " }" if value else "{}"
    if isinstance(value, (list, tuple)):
        return f"[{', '.join(map(_value, value))}]"
    if isinstance(value, Decimal):
        return decimal_text(value)
    return str(value) if isinstance(value, int) else _text(value)


def _text(text: str) -> str:
    """In quotes; what steers a terminal, and what TOML has only so, by its number."""
    return HIDDEN.sub(lambda found: f"\\U{ord(found[0]):08X}", json.dumps(text, ensure_ascii=False))


def decimal_text(value: Decimal) -> str:
    """As written by people: no zeros at its end, a power of ten only where it is short."""
    value = value.normalize() if value else Decimal(0)
    exponent = value.adjusted()
    if -6 < exponent < 12:
        return f"{value:f}"
    sign, digits, power = value.as_tuple()
    assert isinstance(power, int)
    mantissa = "".join(map(str, digits))
    point = f"{mantissa[0]}.{mantissa[1:]}" if len(mantissa) > 1 else mantissa
    return f"{'-' if sign else ''}{point}e{exponent}"
