"""Scene -> numbers: the frame at one state, and where a model stands before anything moves."""

from __future__ import annotations

import numpy as np

from eomgen.codegen.rhs import compiled
from eomgen.errors import DerivationError
from eomgen.mechanics.equations.system import System
from eomgen.mechanics.initial_state.initial_state import start_state
from eomgen.model.values import exact_parameters, start_values
from eomgen.records import dataclass
from eomgen.scene.scene import Scene


@dataclass(frozen=True)
class DrawnState:
    """A state in numbers.

    Args:
        x: coordinates then speeds.
        p: parameters in the model's order.
        assumed: the parameters without a value, drawn as 1.
    """

    t: float
    x: np.ndarray
    p: np.ndarray
    assumed: tuple[str, ...] = ()


def drawn_start(system: System) -> DrawnState:
    """Where the model starts; a parameter without a value is 1, and where the ties do not close so they stay open."""
    model, symbols = system.scope.model, system.symbols
    known = exact_parameters(model)
    assumed = {name: 1 for name in model.parameters if name not in known}
    try:
        values = start_state(system, assumed)
    except DerivationError:
        q, u = start_values(model, assumed)
        values = {**q, **u}
    x = [float(values[node.name]) for node in (*symbols.q, *symbols.u)]
    p = [float(known.get(name, 1)) for name in symbols.parameters]
    return DrawnState(0.0, np.array(x), np.array(p), tuple(assumed))


def frame_at(scene: Scene, state: DrawnState) -> np.ndarray:
    """The numbers of the scene's frame at a state: slot i is that of `scene.values[i]`; nan where there is none."""
    found: np.ndarray = frames_along(scene, np.array([state.t]), state.x[None, :], state.p)[0]
    return found


def frames_along(scene: Scene, t: np.ndarray, x: np.ndarray, p: np.ndarray, target: str | None = "numpy") -> np.ndarray:
    """The same along a motion: n x slots.

    Args:
        t, x: n instants and their states.
        target: as of `Equations.rhs`.
    """
    if not scene.values:
        return np.zeros((len(t), 0))
    with np.errstate(all="ignore"):
        return compiled(scene.program, target).many(t, x, p)
