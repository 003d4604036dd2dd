"""Trajectory -> one picture over all its phases: each phase is drawn by its own system, whose coordinates mean its own.

Bodies, points and marks of the first phase are found again by their names in the others. A number that differs from
phase to phase, or moves in one of them, gets a slot of its own; what another phase has not is nan there, and hidden.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator, Mapping
from typing import Any

import numpy as np

from eomgen.scene.instant import frames_along
from eomgen.scene.making import scene_of_system
from eomgen.simulation.result import Phase, Trajectory

Way = tuple[Any, ...]
WORD_FIELDS = ("name", "kind", "frame", "parent", "role", "of", "text", "symbol", "unit", "close", "faces", "side")


def phase_frames(run: Trajectory) -> tuple[dict[str, Any], np.ndarray]:
    """(the scene as `Scene.to_json` tells it, its slots at the instants of the run, n x slots)."""
    scenes = [(phase, scene_of_system(phase.model.declared)) for phase in run.phases]
    told = scenes[0][1].to_json()
    tables = [_values(run, phase, dict(_numbers(scene.to_json())), scene) for phase, scene in scenes]
    columns: list[np.ndarray] = []

    def placed(path: Way, first: Any) -> Any:
        if all(path in table and _constant(table[path]) == first for table in tables):
            return first
        column = np.full(len(run.t), np.nan)
        for phase, table in zip(run.phases, tables, strict=True):
            rows = slice(*phase.rows)
            if path in table:
                value = table[path]
                column[rows] = value[rows] if isinstance(value, np.ndarray) else value
        columns.append(column)
        return [len(columns) - 1]

    drawn = {key: _rebuilt(told[key], placed, key) for key in ("frames", "points", "marks")}
    frames = np.column_stack(columns) if columns else np.empty((len(run.t), 0))
    return {**told, **drawn, "slots": len(columns)}, frames


def _constant(value: Any) -> Any:
    return None if isinstance(value, np.ndarray) else value


def _values(run: Trajectory, phase: Phase, leaves: Mapping[Way, Any], scene: Any) -> dict[Way, Any]:
    """Each number of a phase's scene: a constant, or its column over all rows of the run."""
    named, symbols = run.columns(), scene.system.symbols
    rest = np.zeros(len(run.t))
    x = np.column_stack([rest, *(named.get(node.name, rest) for node in (*symbols.q, *symbols.u))])[:, 1:]
    frames = frames_along(scene, run.t, x, phase.model.p)
    return {path: frames[:, value[0]] if isinstance(value, list) else value for path, value in leaves.items()}


def _numbers(told: Mapping[str, Any]) -> Iterator[tuple[Way, Any]]:
    """Every number of a scene by the names on the way to it: constants, and slots [i]."""
    found: list[tuple[Way, Any]] = []

    def kept(path: Way, value: Any) -> Any:
        found.append((path, value))
        return value

    for key in ("frames", "points", "marks"):
        _rebuilt(told[key], kept, key)
    yield from found


def _rebuilt(parts: list[dict[str, Any]], change: Any, key: str) -> list[dict[str, Any]]:
    """The parts with every number replaced by change(path, number)."""
    seen: Counter[Way] = Counter()
    made = []
    for part in parts:
        who = (key, *(part.get(word) for word in ("name", "kind", "frame", "role", "of", "text", "symbol")))
        seen[who] += 1
        made.append({k: v if k in WORD_FIELDS else _changed(v, change, (*who, seen[who], k)) for k, v in part.items()})
    return made


def _changed(value: Any, change: Any, path: Way) -> Any:
    if isinstance(value, (bool, str)) or value is None:
        return value
    if isinstance(value, list) and not (len(value) == 1 and isinstance(value[0], int)):
        return [_changed(each, change, (*path, i)) for i, each in enumerate(value)]
    return change(path, value)
