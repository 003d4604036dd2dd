"""eomgen: from a mechanical system to its equations of motion, with proof."""

from __future__ import annotations

from importlib import import_module
from typing import Any

_PLACES = {
    "load": "eomgen.model.reader",
    "loads": "eomgen.model.reader",
    "derive": "eomgen.pipeline",
    "simulate": "eomgen.pipeline",
    "Equations": "eomgen.pipeline",
}


def __getattr__(name: str) -> Any:
    if name in _PLACES:
        return getattr(import_module(_PLACES[name]), name)
    raise AttributeError(f"module 'eomgen' has no attribute '{name}'")
