"""Trajectory -> Movie: a run, or a mode, as frames of a scene, with its trails and its forces."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import replace
from numbers import Real
from typing import Any

import numpy as np

from eomgen.errors import UsageError
from eomgen.mechanics.equations.system import System
from eomgen.mechanics.small_motions.modes import Modes
from eomgen.mechanics.small_motions.spectrum import Mode
from eomgen.model.findings import nearest
from eomgen.records import dataclass
from eomgen.scene.instant import DrawnState, frames_along
from eomgen.scene.making import named_points, scene_of_system
from eomgen.scene.phase_frames import phase_frames
from eomgen.scene.plane_strokes import plane_drawing
from eomgen.scene.scene import Scene, SceneFrame
from eomgen.scene.space_strokes import space_drawing
from eomgen.scene.strokes import Drawing, SceneNumbers
from eomgen.scene.virtual import VirtualDisplacement, swing_of
from eomgen.simulation.result import Trajectory
from eomgen.symbolic.numeric.tolerances import COMPUTED, WIDE_STEP

MOST_FRAMES = 5000
FPS = (1, 1000)  # the fewest and most frames in a second
FINE = 8  # places of a trail in a frame
PERIOD = 2.0  # of a mode as it is shown, and how long it is [s]


@dataclass(frozen=True)
class Movie:
    """Frames of one scene.

    Args:
        drawing: over all frames.
        times: of each frame in the motion [s].
        trails: name of a point -> its places, FINE of them a frame, d each.
        title: what is said above it.
        timed: the times of frames are told.
        scene: of which it is a drawing.
    """

    drawing: Drawing
    times: np.ndarray
    plane: bool
    trails: Mapping[str, np.ndarray]
    title: str = ""
    timed: bool = True
    scene: Scene | None = None

    @property
    def stands_still(self) -> bool:
        """Whether all frames show the same."""
        return bool(self.as_at_first.all())

    @property
    def as_at_first(self) -> np.ndarray:
        """Which frames show what the first does."""
        found = np.ones(len(self.times), dtype=bool)
        for path in (stroke.path for stroke in self.drawing.strokes if stroke.path.size):
            away = np.abs(path - path[:1]).reshape(len(path), -1)
            found &= ~(np.nan_to_num(away) > COMPUTED * self.drawing.sizes.extent).any(axis=1)
        return found


def frame_times(end: float, fps: float, speed: float) -> np.ndarray:
    """The instants of the frames of a motion from 0: speed / fps apart [s].

    Raises:
        UsageError: a rate or speed that no picture has, too many frames, no second one.
    """
    refuse_rates(fps, speed)
    count = np.floor(end * fps / speed * (1 + COMPUTED)) + 1
    if count > MOST_FRAMES:
        what = f"{count:g} frames are more than {MOST_FRAMES}"
        raise UsageError(what, mend="take a shorter --time, fewer frames with --fps, or a larger --speed")
    if count < 2:
        what = f"{end:g} s are over before a second frame comes, {speed / fps:g} s of the motion after the first"
        raise UsageError(what, mend="take a longer --time, more frames with --fps, or a smaller --speed")
    return np.arange(count) * speed / fps


def refuse_rates(fps: float, speed: float = 1.0) -> None:
    """Refuses frames a second, and a speed, that no moving picture has.

    Raises:
        UsageError: they are no numbers, or too small or large.
    """
    if not (isinstance(fps, Real) and FPS[0] <= fps <= FPS[1]):
        raise UsageError(f"{fps} frames a second make no moving picture", mend=f"from {FPS[0]} to {FPS[1]}")
    if not (isinstance(speed, Real) and 0 < speed < math.inf):
        raise UsageError(f"a speed of {speed} makes no sense", mend="give a positive number: 1 is as fast as it moves")


def movie_of(run: Trajectory, times: np.ndarray, *, trail: Sequence[str] = (), forces: bool = False) -> Movie:
    """A run at some instants; states between its rows are interpolated, each phase is drawn by its own system.

    Args:
        trail: points that leave a trail.
        forces: applied forces and reactions are arrows.
    Raises:
        UsageError: a point that is not there; a run whose equations nobody knows.
    """
    if not run.phases or run.phases[0].model is None:
        raise UsageError("nothing is known of the bodies of this run", mend="take eomgen.simulate(model)")
    numbers = phase_frames(run, times, forces=forces)
    fine = np.interp(np.arange(FINE * (len(times) - 1) + 1) / FINE, np.arange(len(times)), times)
    return _movie(numbers, times, _trails(run, fine, trail, dict(numbers.scene.points)))


def _trails(
    run: Trajectory, times: np.ndarray, names: Sequence[str], points: Mapping[str, Any]
) -> dict[str, np.ndarray]:
    """The places of named points."""
    for name in names:
        if name not in points:
            raise UsageError(f"there is no point '{name}'", mend=nearest(name, points))
    if not names:
        return {}

    def way(system: System) -> Scene:
        return Scene(system, (SceneFrame(""),), tuple(x for x in named_points(system) if x[0] in names), ())

    numbers = phase_frames(run, times, forces=False, scene_of=way)
    return {name: numbers.vector(at) for name, at in numbers.scene.points}


def _movie(numbers: SceneNumbers, times: np.ndarray, trails: Mapping[str, np.ndarray], title: str = "") -> Movie:
    plane = numbers.scene.plane
    drawing = (plane_drawing if plane else space_drawing)(numbers)
    return Movie(drawing, times, plane, trails, title, scene=numbers.scene)


def mode_movies(modes: Modes, count: int, frames: int) -> list[Movie]:
    """The slowest modes about their reference, each over one period, all shown equally fast.

    Args:
        frames: of each.

    Raises:
        UsageError: there is none; parameters without values.
    """
    reference = modes.small.reference
    if not reference.valued:
        raise UsageError("modes are shown with values of all parameters", mend="give them values in [parameters]")
    shown = [mode for mode in modes.spectrum.modes if mode.frequency][:count]
    if not shown:
        raise UsageError("the model has no mode that swings", mend="show a run: leave the mode out")
    return [_mode_movie(modes, mode, k, frames) for k, mode in enumerate(shown, start=1)]


def _mode_movie(modes: Modes, mode: Mode, number: int, count: int) -> Movie:
    """q = q_0 + a Re(shape e^(i phase)) over one turn of the phase."""
    system = modes.small.reference.system
    scene = scene_of_system(system)
    at = reference_state(modes)
    shape = np.array([complex(mode.shape.get(q, 0.0)) for q in system.symbols.q] + [0.0] * len(system.symbols.u))
    phase = 2 * np.pi * np.arange(count) / count
    swung = np.real(shape[None, :] * np.exp(1j * phase)[:, None])
    size = swing(scene, at, swung)
    frames = frames_along(scene, np.full(count, at.t), at.x[None, :] + size * swung, at.p)
    frequency = mode.frequency or 0.0
    return _movie(SceneNumbers(scene, frames), phase / (frequency or 1.0), {}, f"{number}: {frequency:.4g} rad/s")


def reference_state(modes: Modes) -> DrawnState:
    """The state about which small motions are looked at."""
    system, numbers = modes.small.reference.system, modes.small.reference.numbers
    symbols = system.symbols
    x = [float(numbers.get(node, 0.0)) for node in (*symbols.q, *symbols.u)]
    p = [float(numbers[node]) for node in symbols.parameters.values()]
    return DrawnState(float(numbers.get(symbols.t, 0.0)), np.array(x), np.array(p))


def swing(scene: Scene, at: DrawnState, swung: np.ndarray) -> float:
    """How far a mode is swung out: so that what moves most moves by a part of the picture."""
    states = np.vstack([at.x[None, :], at.x + WIDE_STEP * swung])
    numbers = SceneNumbers(scene, frames_along(scene, np.full(len(states), at.t), states, at.p))
    return swing_of(numbers, WIDE_STEP)


def virtual_movie(found: VirtualDisplacement, frames: int) -> Movie:
    """A virtual displacement to and fro, once."""
    times = PERIOD * np.arange(frames) / frames
    numbers = found.along(2 * np.pi * times / PERIOD)
    return replace(_movie(numbers, times, {}, f"{found.reaction.name} released"), timed=False)
