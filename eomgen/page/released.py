"""VirtualDisplacements -> what a player is told: one released reaction after the other, each to and fro."""

from __future__ import annotations

from typing import Any

import numpy as np

from eomgen.model.parts import Model
from eomgen.page.player_data import DRAWN, rows_told
from eomgen.records import dataclass
from eomgen.scene.phase_frames import joined
from eomgen.scene.virtual import VirtualDisplacement

PERIOD = 2.0  # of one displacement [s]
STEPS = 12  # of a period


@dataclass(frozen=True)
class PlayedDisplacements:
    """Virtual displacements of one structure, to be played.

    Args:
        found: one or several.
    """

    found: tuple[VirtualDisplacement, ...]
    live: None = None
    moves: bool = False

    @property
    def model(self) -> Model:
        return self.found[0].structure.system.scope.model

    def told(self) -> dict[str, Any]:
        """What the player is told."""
        share = np.arange(STEPS + 1) / STEPS
        size = len(share)
        pieces = [
            (found.along(2 * np.pi * share), np.arange(k * size, (k + 1) * size)) for k, found in enumerate(self.found)
        ]
        numbers = joined(pieces)
        t = PERIOD * np.concatenate([k + share for k in range(len(pieces))])
        states = rows_told(np.empty((len(t), 0)))
        run = {"t": rows_told(t[:, None]), "message": "", "x": states, "frames": rows_told(numbers.frames, DRAWN)}
        return {
            "name": self.model.name,
            "time": float(t[-1]),
            "scene": numbers.scene.to_json(),
            "names": [],
            "columns": {},
            "energy": False,
            "run": run,
            "live": None,
            "moves": False,
            "parameters": [],
            "sliders": [],
            "rests": "",
            "plotted": [],
            "signs": {},
            "plots": [],
            "vectors": {},
            "check": [],
            "forces": True,
            "captions": [[k * PERIOD, f"{found.reaction.name} released"] for k, found in enumerate(self.found)],
        }
