"""Program -> the places in its state of quaternions, and states in which these have norm 1."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np

from eomgen.codegen.program import Program

SpherePlaces = tuple[int, ...]


def spheres_of(program: Program) -> tuple[SpherePlaces, ...]:
    """Of every quaternion among the states, the places of its four numbers."""
    place = {node: k for k, node in enumerate(program.states)}
    spheres = program.symbols.graph.spheres
    return tuple(tuple(place[x] for x in symbols) for symbols in spheres if all(x in place for x in symbols))


def on_spheres(x: Any, spheres: Sequence[SpherePlaces]) -> Any:
    """The state, or one state a row, with every quaternion over its norm; 0 stays."""
    found = np.array(x, dtype=float)
    for places in spheres:
        four = found[..., list(places)]
        norm = np.sqrt(np.sum(four * four, axis=-1, keepdims=True))
        found[..., list(places)] = four / np.where(norm > 0, norm, 1)
    return found
