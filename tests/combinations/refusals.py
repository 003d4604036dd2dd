"""What a refusal must say: what of the model (or which feature) does not go, where, and what to do about it."""

from __future__ import annotations

import re
import tomllib
from collections.abc import Sequence
from typing import Any

from features import FACTORS

NAMED = (
    "parameters",
    "coordinates",
    "speeds",
    "states",
    "inputs",
    "points",
    "bodies",
    "constraints",
    "forces",
    "outputs",
)
FEATURES = {level for levels in FACTORS.values() for level in levels} | {
    "energy", "equilibrium", "rest", "steady", "start", "friction", "contact", "reactions", "speeds", "urdf",
    "sensitivity", "stabilization", "regressor", "method", "unit", "statics",
}  # fmt: skip
AT = re.compile(
    r":\d+:\d+$|^[a-z_]+\.[\w.]+|^(parameters|coordinates|states|outputs|forces|constraints|bodies|inputs)\b"
)


def names_of(text: str) -> set[str]:
    """Every name that a model gives: of its entries, of the points of its bodies."""
    model = tomllib.loads(text)
    found = {name for table in NAMED for name in model.get(table, {})}
    return found | {point for body in model.get("bodies", {}).values() for point in body.get("points", {})}


def lacking(problems: Sequence[Any], text: str) -> str:
    """What a refusal leaves unsaid, "" where it says all: an object of the model or a feature, a place, what to do."""
    if not problems:
        return "says nothing"
    left = []
    names = names_of(text)
    for problem in problems:
        said = f"{problem.where} {problem.what} {problem.excerpt}"
        own = set(re.findall(r"\w+", said)) & names
        if not own and not set(re.findall(r"[a-z_]+", said.lower())) & FEATURES:
            left.append("names nothing of the model")
        elif not own and not AT.search(problem.where) and not re.search(r"'[^']+'|--\w+|\bt = ", said):
            left.append("says no place")
        if not problem.fix:
            left.append("says not what to do")
    return ", ".join(dict.fromkeys(left))
