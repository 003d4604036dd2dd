"""Trajectory -> what its player is told: scene, recorded run, units, sliders; how the page moves it where it can."""

from __future__ import annotations

import base64
from collections.abc import Mapping, Sequence
from dataclasses import field, replace
from functools import cached_property
from typing import Any

import numpy as np

from eomgen.codegen.targets.base import TestVector
from eomgen.codegen.vectors import vectors
from eomgen.documents.latex_names import notation_of
from eomgen.errors import ToolMissing, UsageError
from eomgen.model.own_units import units_of
from eomgen.model.parts import Model
from eomgen.page.columns import packed_columns
from eomgen.page.live import Live, single_reactions
from eomgen.page.mathml import mathml
from eomgen.records import dataclass
from eomgen.scene.applied import reaction_marks
from eomgen.scene.making import scene_of_system
from eomgen.scene.phase_frames import phase_frames
from eomgen.scene.scene import Scene
from eomgen.simulation.configuration import Configuration
from eomgen.simulation.phase_model import PhaseModel
from eomgen.simulation.result import Trajectory
from eomgen.symbolic.numeric.tolerances import CARRIED

VECTORS = 3  # of each program in the page
CHECKED = (0.02, 0.05)  # of the time: where the page's own motion is held against the recorded one
MOST_CHECKED = 0.5  # s
STATES, DRAWN = 12, 7  # digits of the recorded states, and of what is only drawn
PLOTTED = 3  # coordinates, from the start
ROUND = 4.0  # m, rad: how far a start value that is 0 may be moved
SliderRange = tuple[float, float]


@dataclass(frozen=True)
class PlayerOptions:
    """What is asked of a player.

    Args:
        sliders: parameters and starts that have one, with its range in SI, or None: the default; () for all.
        moves: whether the model lives in the page, where it can; else the recorded run is played.
        trail: a point that leaves a trail from the start, "" for none.
        forces: whether arrows are shown from the start.
        speed: of the time.
    """

    sliders: Mapping[str, SliderRange | None] = field(default_factory=dict)
    moves: bool = False
    trail: str = ""
    forces: bool = False
    speed: float = 1.0


@dataclass(frozen=True)
class PlayedRun:
    """A run and its player's options."""

    run: Trajectory
    options: PlayerOptions

    @property
    def phase(self) -> PhaseModel:
        """The first phase: what a run without others has."""
        found: PhaseModel = self.run.phases[0].model
        return found

    @property
    def model(self) -> Model:
        return self.phase.declared.scope.model

    @property
    def changes(self) -> bool:
        """Whether contacts change in it, or could."""
        return self.phase.configuration != Configuration()

    @cached_property
    def rests(self) -> str:
        """Why the sliders rest: the page cannot move the model by itself; "" where it can."""
        if self.changes:
            return "The contacts of this model change from phase to phase: the page plays the run as it was computed."
        if self.run.carried:
            return "This run crosses a singular position, which the page cannot: it plays the run as it was computed."
        return ""

    @cached_property
    def live(self) -> Live | None:
        """The model as the page evaluates it; None of contacts that change."""
        return None if self.changes else Live(self.phase, self.scene)

    @cached_property
    def drawn(self) -> tuple[dict[str, Any], np.ndarray | None]:
        """(the scene as data, its numbers at the instants of the run where no program in the page gives them)."""
        if not self.changes:
            return self.scene.to_json(), None
        numbers = phase_frames(self.run, self.run.t)
        return numbers.scene.to_json(), numbers.frames

    @cached_property
    def scene(self) -> Scene:
        """Of a model whose contacts do not change."""
        scene = scene_of_system(self.phase.system, self.phase.equations)
        arrows = reaction_marks(self.phase.system, single_reactions(self.phase))
        return replace(scene, marks=(*scene.marks, *arrows))

    @property
    def computed(self) -> frozenset[str]:
        """The columns of the run that the page computes."""
        return frozenset() if self.live is None else frozenset((*self.live.columns, "t", "energy")) - {"T", "V"}

    @property
    def moves(self) -> bool:
        """Whether the model lives in the page."""
        return self.options.moves and not self.rests

    def told(self) -> dict[str, Any]:
        """What the player is told."""
        run, names = self.run, (*self.run.coordinates, *self.run.speeds)
        moves = self.moves
        columns = self.live.columns if self.live else {name: ("x", k) for k, name in enumerate(names)}
        plotted = [name for name in columns if not name.endswith("'") or name in names]
        units = units_of(self.model, [*plotted, "energy"])
        energy = self.live is not None
        shown = [
            {"name": name, **_unit(units.get("energy" if name in ("T", "V", "E") else name))}
            for name in [*(("E",) if energy else ()), *plotted]
        ]
        return {
            "name": self.model.name,
            "time": float(run.phases[-1].end),
            "rtol": CARRIED,
            "scene": self.drawn[0],
            "names": names,
            "columns": columns,
            "conservative": run.drift is not None,
            "energy": energy,
            "run": self._recorded(),
            "live": self.live.told() if self.live else None,
            "moves": moves,
            "parameters": self._parameters(),
            "sliders": self._sliders() if self.options.moves else [],
            "rests": self.rests if self.options.moves else "",
            "plotted": shown,
            "signs": self._signs(plotted),
            "plots": [*run.coordinates[:PLOTTED], *(("E",) if energy and run.drift is None else ())],
            "vectors": {name: list(map(_vector, rows)) for name, rows in self.vectors.items()} if moves else {},
            "check": self._checked() if moves else [],
            "trail": self.options.trail,
            "forces": self.options.forces,
            "speed": self.options.speed,
        }

    def _signs(self, plotted: Sequence[str]) -> dict[str, str]:
        """The names as formulas have them, MathML; {} where nothing sets them: then they stand as they are spelt."""
        names = dict.fromkeys((*self.run.coordinates, *self.run.speeds, *self.model.parameters))
        notation = notation_of(self.model).told_apart(names)
        try:
            return {name: mathml(notation.latex(name)) for name in names if name in plotted or self.options.moves}
        except ToolMissing:
            return {}

    def _recorded(self) -> dict[str, Any]:
        """The run: states as they are integrated, or of contacts that change as they are named, with frames."""
        run = self.run
        told = {"t": rows_told(run.t[:, None]), "message": "" if run.ok else run.message}
        if self.live is not None:
            assert run.phases[0].track is not None
            times, states = run.phases[0].track
            x = states[np.searchsorted(times, run.t)]
            return {**told, "x": rows_told(x)}
        frames = self.drawn[1]
        assert frames is not None
        return {**told, "x": rows_told(run.x), "frames": rows_told(frames, DRAWN)}

    def _parameters(self) -> list[dict[str, Any]]:
        names = self.phase.declared.symbols.parameters
        return [{"name": name, "value": float(value)} for name, value in zip(names, self.phase.p, strict=True)]

    @cached_property
    def vectors(self) -> dict[str, tuple[TestVector, ...]]:
        """Right answers of the programs that give the motion and the picture; {} where the page has none."""
        if self.live is None:
            return {}
        assert self.run.phases[0].track is not None
        x0, p0 = self.run.phases[0].track[1][0], self.phase.p
        programs = {name: self.live.programs[name] for name in ("rate", "frame")}
        return {name: vectors(program, x0=x0, p0=p0, count=VECTORS) for name, program in programs.items()}

    def _checked(self) -> list[float]:
        """Instants of the recorded run."""
        t = self.run.t
        wanted = [min(share * float(t[-1]), MOST_CHECKED) for share in CHECKED]
        return sorted({float(t[min(int(np.searchsorted(t, each)), len(t) - 1)]) for each in wanted if each > 0})

    # -- sliders -----------------------------------------------------------------------------------

    def _sliders(self) -> list[dict[str, Any]]:
        """Of parameters that are numbers, and of what may start otherwise; those asked for alone, where any are."""
        parts = self.model.parameters
        derived = self.live.derived if self.live else ()
        values = {
            name: (float(value), "parameter", getattr(parts[name], "about", None) or "")
            for name, value in zip(self.phase.declared.symbols.parameters, self.phase.p, strict=True)
            if name not in derived
        }
        first = dict(zip((*self.run.coordinates, *self.run.speeds), self.run.x[0].tolist(), strict=True))
        spheres = {e.name for four in self.phase.declared.scope.quaternions for e in four}
        for name, part in self.model.coordinates.items():
            if name in first and not part.driven and not part.dependent and name not in spheres:
                values[name] = (first[name], "coordinate", part.about or "")
        values |= {name: (first[name], "speed", "") for name in self.run.speeds if name.rstrip("'") not in spheres}
        asked = self.options.sliders
        unknown = [name for name in asked if name not in values]
        if unknown:
            raise UsageError(f"there is no slider for '{unknown[0]}'", mend=f"there are {', '.join(values)}")
        units = units_of(self.model, values)
        chosen = {name: values[name] for name in asked} if asked else values
        return [self._slider(name, *told, units.get(name), asked.get(name)) for name, told in chosen.items()]

    def _slider(
        self, name: str, value: float, kind: str, about: str, unit: Any, range_: SliderRange | None
    ) -> dict[str, Any]:
        low, high = range_ or _default_range(
            value, kind, angular=unit is not None and bool(unit.angle) and not unit.time
        )
        return {
            "name": name,
            "kind": kind,
            "value": value,
            "min": low,
            "max": high,
            "about": about,
            **_unit(unit),
        }


def _default_range(value: float, kind: str, *, angular: bool) -> SliderRange:
    """A parameter keeps its sign, from a fifth to three times of it; an angle goes once around."""
    if kind == "parameter" and value:
        return (0.2 * value, 3 * value) if value > 0 else (3 * value, 0.2 * value)
    if kind == "coordinate" and angular:
        return value - np.pi, value + np.pi
    reach = 2 * abs(value) or ROUND
    return value - reach, value + reach


def _vector(v: TestVector) -> dict[str, Any]:
    result = [value if value == value else None for value in v.result]
    return {"t": v.t, "x": v.x, "p": v.p, "inputs": v.inputs, "result": result, "tolerance": max(v.tolerance, CARRIED)}


def _unit(unit: Any) -> dict[str, Any]:
    return {"unit": "" if unit is None else unit.text, "size": 1.0 if unit is None else float(unit.size)}


def rows_told(rows: np.ndarray, digits: int = STATES) -> dict[str, Any]:
    """Numbers as a page reads them.

    Args:
        rows: n x columns.
        digits: of the largest of a column.
    """
    packed = packed_columns(rows.T, digits)
    return packed.head(content=base64.b64encode(packed.content).decode("ascii"))
