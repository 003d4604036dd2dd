"""The models that hold every feature which any model declares, each twice where two models have it, cheap ones first.

A law over all models is asked of these in the usual run, of all in the slow run (`slow_run`). They are found anew from
the models each time: a new model, or a model with a new feature, comes in by itself.
"""

from __future__ import annotations

import re
import tomllib
from collections import Counter
from collections.abc import Iterator
from functools import cache
from pathlib import Path
from typing import Any

NAMED = frozenset(
    "parameters coordinates speeds inputs bodies points constraints forces trusses nodes unknowns given outputs".split()
)
"""Tables in which the keys are names that the author chose."""

CALL = re.compile(r"\b([a-z][a-z_0-9]*)\(")


@cache
def declared(path: Path) -> dict[str, Any]:
    """The tables of a model file."""
    return tomllib.loads(path.read_text(encoding="utf-8"))


@cache
def features(path: Path) -> frozenset[str]:
    """What a model declares: its kind of space, each field of each kind of part, each function that it writes."""
    return frozenset(_features(declared(path), ""))


def _features(value: Any, where: str) -> Iterator[str]:
    if isinstance(value, dict):
        kind = value.get("kind")
        where += f"[{kind}]" if isinstance(kind, str) else ""
        for key, x in value.items():
            yield from _features(
                x, f"{where}.*" if where.rpartition(".")[2] in NAMED else f"{where}.{key}".removeprefix(".")
            )
    elif isinstance(value, list):
        for x in value:
            yield from _features(x, where)
    else:
        yield where
    if isinstance(value, str):
        yield from (f"{name}()" for name in CALL.findall(value))
        if where == "space":
            yield value


def cost(path: Path) -> int:
    """How long the derivation of a model takes, in no unit: it grows with its bodies, and in space more than fourfold.

    (fitted by eye to the time that the laws take of each model; only the order of the models counts)
    """
    model = declared(path)
    parts = len(model.get("bodies", ())) + len(model.get("coordinates", ())) + 2 * len(model.get("constraints", ()))
    return parts * (4 if model["space"] == "space" else 1)


@cache
def covering(models: tuple[Path, ...], times: int = 2) -> tuple[Path, ...]:
    """Of these models so many that each feature of theirs is held `times` times, or as often as they hold it at all.

    Greedy: again and again the model with most features that are still asked for, of several the cheapest; at the end
    those are left out, the dearest first, whose features the others hold often enough.
    """
    has = {path: features(path) for path in models}
    held = Counter(feature for path in models for feature in has[path])
    requested = {feature: min(times, n) for feature, n in held.items()}
    order = sorted(models, key=lambda path: (cost(path), path.stem))
    left, taken = dict(requested), []
    while left:
        best = max(order, key=lambda p: len(has[p] & left.keys()))
        order.remove(best)
        taken.append(best)
        left |= {f: left[f] - 1 for f in has[best] & left.keys()}
        left = {f: n for f, n in left.items() if n}
    often = Counter(f for path in taken for f in has[path])
    for path in sorted(taken, key=lambda p: (-cost(p), p.stem)):
        if all(often[f] > requested[f] for f in has[path]):
            taken.remove(path)
            often.subtract(has[path])
    return tuple(path for path in models if path in taken)
