"""The smallest model that still shows a fault: what can be taken away is taken away, piece by piece."""

from __future__ import annotations

import copy
import tomllib
from collections.abc import Callable
from typing import Any

from drawn import toml


def smallest(text: str, shows: Callable[[str], bool], rounds: int = 4) -> str:
    """A model without every entry that the fault does not need. `shows(text)`: it is still there."""
    model = tomllib.loads(text)
    for _ in range(rounds):
        before = toml(model)
        for path in _paths(model):
            less = copy.deepcopy(model)
            if _removed(less, path) and _shows(toml(less), shows):
                model = less
        if toml(model) == before:
            break
    return toml(model)


def _shows(text: str, shows: Callable[[str], bool]) -> bool:
    try:
        return shows(text)
    except Exception:
        return False


def _paths(model: dict[str, Any]) -> list[tuple[str, ...]]:
    """Whole tables first, then their entries, then the fields of these."""
    found: list[tuple[str, ...]] = []
    for table in (
        "outputs",
        "forces",
        "constraints",
        "speeds",
        "inputs",
        "bodies",
        "coordinates",
        "points",
        "parameters",
    ):
        for name in reversed(list(model.get(table, {}))):
            found.append((table, name))
    for table in ("bodies", "constraints", "forces", "coordinates", "parameters", "inputs"):
        for name, entry in model.get(table, {}).items():
            if isinstance(entry, dict):
                found += [(table, name, key) for key in entry]
                for key, x in entry.items():
                    if isinstance(x, dict):
                        found += [(table, name, key, inner) for inner in x]
    return found


def _removed(model: dict[str, Any], path: tuple[str, ...]) -> bool:
    here: Any = model
    for key in path[:-1]:
        if not isinstance(here, dict) or key not in here:
            return False
        here = here[key]
    if path[-1] not in here:
        return False
    del here[path[-1]]
    if len(path) == 2 and path[0] == "coordinates":  # outputs of it go with it
        outputs = model.get("outputs", {})
        for name in [n for n, x in outputs.items() if path[1] in str(x)]:
            del outputs[name]
    return True
