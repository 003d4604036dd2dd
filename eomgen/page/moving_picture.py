"""Trajectory -> a movie: frames of a scene, as GIF, MP4 or a strip.

Movie -> a GIF, an MP4 or a strip of frames: still parts are drawn once, moving parts over them.
"""

from __future__ import annotations

import io
import itertools
import math
import shutil
import subprocess
import sys
import tempfile
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import replace
from functools import cached_property
from numbers import Real
from pathlib import Path
from typing import Any

import numpy as np

from eomgen import files
from eomgen.documents import (
    STYLE,
    SpacePicture,
    artist_of,
    limits,
    page_shape,
    sight,
)
from eomgen.errors import RunFailed, ToolMissing, UsageError
from eomgen.frozen import dataclass
from eomgen.mechanics.dynamics import System
from eomgen.mechanics.linearization import Modes
from eomgen.model import nearest
from eomgen.scene import (
    Drawing,
    Scene,
    SceneFrame,
    SceneNumbers,
    Stroke,
    VirtualDisplacement,
    corners_of,
    drawing_of,
    frames_along,
    named_points,
    phase_frames,
    scene_of_system,
    swing_of,
)
from eomgen.simulation import Trajectory
from eomgen.study import StateInNumbers
from eomgen.symbolic.numeric import tolerances

WIDTH, HIGHEST, DOTS = 4.8, 4.8, 100  # of a moving picture [inches, dots an inch]
SPARSE = 5  # frames of which one is looked at for the shape of the page
COLORS, NEARLY_WHITE = 64, 246  # of a GIF; what is lighter is paper
TRAILS = ("#c77c11", "#8e44ad", "#2e7d4f", "#b03a2e")
STRIP, TITLE = 2.6, 0.3  # width of a frame in a strip, height of what is written over a frame [inches]

Progress = Callable[[int, int], None]


class Stage:
    """One movie on matplotlib axes."""

    def __init__(self, panel: Any, movie: Movie) -> None:
        self.panel, self.movie = panel, movie
        self.space = None if movie.plane else SpacePicture(panel, movie.shown)
        self.moving: list[tuple[Any, np.ndarray, bool]] = []
        if self.space is None:
            self._plane_artists()
        self.trails = [
            (panel.plot([], [], color=TRAILS[k % len(TRAILS)], linewidth=1.2, zorder=3)[0], self._page(path))
            for k, path in enumerate(movie.trails.values())
        ]
        if movie.title:
            panel.set_title(movie.title, fontsize=9)

    def _plane_artists(self) -> None:
        """Makes the artists: still strokes under all moving ones are part of the ground, the rest is drawn anew."""
        self.panel.set_aspect("equal")
        self.panel.axis("off")
        low, high = limits(self.movie.shown)
        self.panel.set_xlim(low[0], high[0])
        self.panel.set_ylim(low[1], high[1])
        strokes = [stroke for stroke in self.movie.shown.strokes if stroke.path.size]
        for k, stroke in enumerate(strokes):
            artist = artist_of(self.panel, stroke, 0, {}, 1 + k / len(strokes))
            still = np.array_equal(stroke.path, np.broadcast_to(stroke.path[:1], stroke.path.shape), equal_nan=True)
            if self.moving or not still:
                self.moving.append((artist, stroke.path, stroke.filled))

    def _page(self, path: np.ndarray) -> np.ndarray:
        """A way of the ground, on the page as it is where the motion begins."""
        return path if self.space is None else path @ self.space.view.T[:, :2]

    @property
    def artists(self) -> list[Any]:
        """Artists that are drawn anew in every frame."""
        own = [artist for artist, _, _ in self.moving] if self.space is None else [self.space.pieces]
        return [*own, *(artist for artist, _ in self.trails)]

    def show(self, frame: int) -> None:
        """Everything at one frame."""
        if self.space is not None:
            self.space.show(frame)
        for artist, path, filled in self.moving:
            if filled:
                artist.set_xy(path[frame])
            else:
                artist.set_data(path[frame, :, 0], path[frame, :, 1])
        for artist, path in self.trails:
            gone = self._page(self.movie.gone[frame])
            artist.set_data(*(path[: FINE * frame + 1] - gone).T)


def images(movies: Sequence[Movie], progress: Progress | None = None) -> Iterator[Any]:
    """Every frame of movies side by side, as Pillow images of one size, both sides even."""
    from matplotlib import rc_context
    from matplotlib.backends.backend_agg import FigureCanvasAgg
    from matplotlib.figure import Figure
    from PIL import Image

    with rc_context(STYLE):
        tall = max(_tallness(movie) for movie in movies)
        side = WIDTH if len(movies) == 1 else WIDTH * 0.62
        height = min(HIGHEST, max(1.6, side * tall))
        figure = Figure(figsize=(_even(side * len(movies)), _even(height)), dpi=DOTS)
        canvas: Any = FigureCanvasAgg(figure)
        stages = []
        for k, movie in enumerate(movies):
            room = 1 - TITLE / height if movie.title else 1.0
            stages.append(Stage(figure.add_axes((k / len(movies), 0, 1 / len(movies), room)), movie))
        artists = [(stage.panel, artist) for stage in stages for artist in stage.artists]
        for _, artist in artists:
            artist.set_animated(True)
        canvas.draw()
        ground = canvas.copy_from_bbox(figure.bbox)
        count = len(movies[0].times)
        for frame in range(count):
            canvas.restore_region(ground)
            for stage in stages:
                stage.show(frame)
            for panel, artist in artists:
                panel.draw_artist(artist)
            size = canvas.get_width_height()
            yield Image.frombytes("RGB", size, bytes(canvas.buffer_rgba()), "raw", "RGBX")
            if progress is not None:
                progress(frame + 1, count)


def _tallness(movie: Movie) -> float:
    """Height over width of the drawing."""
    if movie.shown.followed:
        return min(1.4, max(0.35, page_shape(movie.shown)))
    if movie.plane:
        low, high = limits(movie.shown)
    else:
        across = sight(movie.drawing.sizes.up).T[:, :2]
        found = corners_of((s.path[::SPARSE] @ across for s in movie.drawing.strokes if s.role != "track"), 2)
        low, high = found or (np.zeros(2), np.ones(2))
    wide, high_ = (float(x) or 1.0 for x in high - low)
    return min(1.4, max(0.35, high_ / wide))


def _even(inches: float) -> float:
    """A length of an even number of dots."""
    return 2 * round(inches * DOTS / 2) / DOTS


def gif(movies: Sequence[Movie], fps: float, progress: Progress | None = None) -> bytes:
    """A GIF that runs for ever, all frames with one palette."""
    drawn = list(images(movies, progress))
    palette = _palette(drawn)
    frames = [image.quantize(palette=palette, dither=0) for image in drawn]
    page = io.BytesIO()
    ends = [10 * round(100 * k / fps) for k in range(len(frames) + 1)]  # a GIF counts in hundredths of a second
    delays = [end - start for start, end in itertools.pairwise(ends)]
    frames[0].save(page, format="GIF", save_all=True, append_images=frames[1:], duration=delays, loop=0, optimize=False)
    return page.getvalue()


def _palette(drawn: Sequence[Any]) -> Any:
    """The colours of the first, the middle and the last frame."""
    from PIL import Image

    chosen = [drawn[0], drawn[len(drawn) // 2], drawn[-1]]
    width, height = drawn[0].size
    together = Image.new("RGB", (width, 3 * height))
    for k, image in enumerate(chosen):
        together.paste(image, (0, k * height))
    entries = np.array(together.quantize(colors=COLORS).getpalette()).reshape(-1, 3)[:COLORS]
    entries[entries.min(axis=1) > NEARLY_WHITE] = 255
    found = Image.new("P", (1, 1))
    found.putpalette([*entries.ravel().tolist(), *[0] * (768 - entries.size)])
    return found


def mp4(movies: Sequence[Movie], fps: float, progress: Progress | None = None) -> bytes:
    """An MP4 (H.264), made by ffmpeg.

    Raises:
        ToolMissing: there is no ffmpeg on this machine.
        RunFailed: it failed.
    """
    command = ffmpeg()
    frames = images(movies, progress)
    first = next(frames)
    width, height = first.size
    wanted = [command, "-y", "-loglevel", "error", "-f", "rawvideo", "-pix_fmt", "rgb24", "-s", f"{width}x{height}"]
    wanted += ["-r", f"{fps:g}", "-i", "-", "-an", "-vcodec", "libx264", "-pix_fmt", "yuv420p", "-f", "mp4"]
    with files.beside(Path(tempfile.gettempdir())) as place:
        made = [*wanted, str(place / "movie.mp4")]
        with subprocess.Popen(made, stdin=subprocess.PIPE, stderr=subprocess.PIPE) as running:
            _, said = running.communicate(b"".join([first.tobytes(), *(image.tobytes() for image in frames)]))
        if running.returncode:
            lines = said.decode(errors="replace").strip().splitlines()
            raise RunFailed(
                f"ffmpeg failed: {lines[-1] if lines else f'exit code {running.returncode}'}",
                fix="write a .gif or an .html",
            )
        return (place / "movie.mp4").read_bytes()


def ffmpeg() -> str:
    """The path of ffmpeg: the system's, else that of the package imageio-ffmpeg.

    Raises:
        ToolMissing: there is none.
    """
    if found := shutil.which("ffmpeg"):
        return found
    try:
        from imageio_ffmpeg import get_ffmpeg_exe
    except ImportError:
        what = "no ffmpeg is on this machine, which writes .mp4"
        raise ToolMissing(what, fix="pip install 'eomgen[video]', or write a .gif") from None
    return str(get_ffmpeg_exe())


def strip(movie: Movie) -> bytes:
    """The frames of a movie side by side, with their times, as a PNG."""
    from matplotlib import rc_context
    from matplotlib.backends.backend_agg import FigureCanvasAgg
    from matplotlib.figure import Figure

    columns = min(6, len(movie.times))
    rows = math.ceil(len(movie.times) / columns)
    height = STRIP * _tallness(movie) + TITLE
    page = io.BytesIO()
    with rc_context(STYLE):
        figure = Figure(figsize=(STRIP * columns, height * rows), dpi=150)
        FigureCanvasAgg(figure)
        for frame, t in enumerate(movie.times):
            row, column = divmod(frame, columns)
            box = (column / columns, 1 - (row + 1) / rows, 1 / columns, (1 - TITLE / height) / rows)
            stage = Stage(figure.add_axes(box), movie)
            stage.show(frame)
            if movie.timed:
                stage.panel.set_title(f"t = {t:.3g} s", fontsize=9)
        figure.savefig(page, format="png")
    return page.getvalue()


def on_stderr(done: int, count: int) -> None:
    """Progress as one line on a terminal's stderr."""
    if sys.stderr.isatty():
        end = "\n" if done == count else ""
        sys.stderr.write(f"\rframe {done} of {count}{end}")
        sys.stderr.flush()


# -------- motion frames ---------------------------------------------------------------------------------------
# Trajectory -> Movie: a run, or a mode, as frames of a scene, with its trails and its forces.


MOST_FRAMES = 5000
FPS = (1, 1000)  # the fewest and most frames in a second
FINE = 8  # places of a trail in a frame
FAR = 6.0  # times its size: what goes farther is followed
PERIOD = 2.0  # of a mode as it is shown, and how long it is [s]


@dataclass(frozen=True)
class Movie:
    """Frames of one scene.

    Args:
        drawing: over all frames.
        times: of each frame in the motion [s].
        trails: name of a point -> its places, FINE of them a frame, d each.
        title: the text above it.
        timed: the times of frames are shown.
        scene: the scene of the drawing.
        way: of the bodies on the whole, n x d [m], where they go far: the picture goes with them.
    """

    drawing: Drawing
    times: np.ndarray
    plane: bool
    trails: Mapping[str, np.ndarray]
    title: str = ""
    timed: bool = True
    scene: Scene | None = None
    way: np.ndarray | None = None

    @cached_property
    def gone(self) -> np.ndarray:
        """Way by which the picture has gone with the bodies by each frame, n x d [m]."""
        still = np.zeros((len(self.times), len(self.drawing.sizes.low)))
        return still if self.way is None else self.way - self.way[:1]

    @cached_property
    def shown(self) -> Drawing:
        """The drawing as one sees it who goes with the bodies, where they go far."""
        return self.drawing if self.way is None else _gone_with(self.drawing, self.way[0], self.gone)

    @property
    def stands_still(self) -> bool:
        """True if all frames show the same."""
        return bool(self.as_at_first.all())

    @property
    def as_at_first(self) -> np.ndarray:
        """True for each frame that shows the same as the first."""
        found = np.ones(len(self.times), dtype=bool)
        for path in (stroke.path for stroke in self.drawing.strokes if stroke.path.size):
            away = np.abs(path - path[:1]).reshape(len(path), -1)
            found &= ~(np.nan_to_num(away) > tolerances.COMPUTED * self.drawing.sizes.extent).any(axis=1)
        return found


def frame_times(end: float, fps: float, speed: float) -> np.ndarray:
    """The instants of the frames of a motion from 0: speed / fps apart [s].

    Raises:
        UsageError: a rate or speed that no picture has, too many frames, no second one.
    """
    refuse_rates(fps, speed)
    count = np.floor(end * fps / speed * (1 + tolerances.COMPUTED)) + 1
    if count > MOST_FRAMES:
        what = f"{count:g} frames are more than {MOST_FRAMES}"
        raise UsageError(what, fix="take a shorter --time, fewer frames with --fps, or a larger --speed")
    if count < 2:
        what = f"{end:g} s are over before a second frame comes, {speed / fps:g} s of the motion after the first"
        raise UsageError(what, fix="take a longer --time, more frames with --fps, or a smaller --speed")
    return np.arange(count) * speed / fps


def refuse_rates(fps: float, speed: float = 1.0) -> None:
    """Refuses frames a second, and a speed, that no moving picture has.

    Raises:
        UsageError: they are no numbers, or too small or large.
    """
    if not (isinstance(fps, Real) and FPS[0] <= fps <= FPS[1]):
        raise UsageError(f"{fps} frames a second make no moving picture", fix=f"from {FPS[0]} to {FPS[1]}")
    if not (isinstance(speed, Real) and 0 < speed < math.inf):
        raise UsageError(f"a speed of {speed} makes no sense", fix="give a positive number: 1 is as fast as it moves")


def movie_of(run: Trajectory, times: np.ndarray, *, trail: Sequence[str] = (), forces: bool = False) -> Movie:
    """A run at some instants; states between its rows are interpolated, each phase is drawn by its own system.

    Args:
        trail: points that leave a trail.
        forces: applied forces and reactions are arrows.
    Raises:
        UsageError: a point that is not there; a run without its equations.
    """
    if not run.phases or run.phases[0].model is None:
        raise UsageError("nothing is known of the bodies of this run", fix="take eomgen.simulate(model)")
    numbers = phase_frames(run, times, forces=forces)
    fine = np.interp(np.arange(FINE * (len(times) - 1) + 1) / FINE, np.arange(len(times)), times)
    return _movie(numbers, times, _trails(run, fine, trail, dict(numbers.scene.points)))


def _trails(
    run: Trajectory, times: np.ndarray, names: Sequence[str], points: Mapping[str, Any]
) -> dict[str, np.ndarray]:
    """The places of named points."""
    for name in names:
        if name not in points:
            raise UsageError(f"there is no point '{name}'", fix=nearest(name, points))
    if not names:
        return {}

    def way(system: System) -> Scene:
        return Scene(system, (SceneFrame(""),), tuple(x for x in named_points(system) if x[0] in names), ())

    numbers = phase_frames(run, times, forces=False, scene_of=way)
    return {name: numbers.vector(at) for name, at in numbers.scene.points}


def _movie(numbers: SceneNumbers, times: np.ndarray, trails: Mapping[str, np.ndarray], title: str = "") -> Movie:
    drawing, scene = drawing_of(numbers), numbers.scene
    return Movie(drawing, times, scene.plane, trails, title, scene=scene, way=_far_way(numbers, drawing))


def _far_way(numbers: SceneNumbers, drawing: Drawing) -> np.ndarray | None:
    """The way of the middle of all bodies, n x d [m], where they go farther than FAR times their size; else None.

    Their size is that of the picture where the motion begins, or how far apart they ever are.
    """
    free = [
        p for frame, (_, p) in zip(numbers.scene.frames, numbers.poses, strict=True) if frame.name and frame.parent < 1
    ]
    places = np.stack(free, axis=1) if free else np.full((1, 1, 1), np.nan)
    if not np.isfinite(places).all():
        return None
    size = max(drawing.sizes.at_first, float(np.max(np.ptp(places, axis=1))))
    return places.mean(axis=1) if drawing.sizes.extent > FAR * size else None


def _gone_with(drawing: Drawing, start: np.ndarray, gone: np.ndarray) -> Drawing:
    """A drawing from which the way of the bodies is taken; its corners are those of what stays near them."""
    size = drawing.sizes.at_first
    strokes = [
        replace(s, path=s.path - gone.reshape(len(gone), *(1,) * (s.path.ndim - 2), -1)) for s in drawing.strokes
    ]
    clouds = [s.path.reshape(-1, len(start)) for s in strokes if s.role != "track"]
    clouds = [c[(np.abs(c - start) < 0.5 * FAR * size).all(axis=1)] for c in clouds]
    low, high = corners_of(clouds, len(start)) or (start - 0.5 * size, start + 0.5 * size)
    sizes = replace(drawing.sizes, low=low, high=high)
    near = tuple(_floor_nearby(s, 0.5 * (low + high), size) if s.role == "track" and s.faces else s for s in strokes)
    return Drawing(near, drawing.letters, sizes, followed=True)


def _floor_nearby(stroke: Stroke, middle: np.ndarray, size: float) -> Stroke:
    """A plane on which something goes far: a square of twice its size, below the middle of the picture."""
    first, second, third = (stroke.path[:, 0, k] for k in range(3))
    ways = [x / np.linalg.norm(x, axis=1, keepdims=True) for x in (second - first, third - second)]
    below = first + sum(np.sum((middle - first) * x, axis=1, keepdims=True) * x for x in ways)
    corners = [below + 0.8 * size * (a * ways[0] + b * ways[1]) for a, b in ((1, 1), (-1, 1), (-1, -1), (1, -1))]
    return replace(stroke, path=np.stack(corners, axis=1)[:, None])


def mode_movies(modes: Modes, count: int, frames: int) -> list[Movie]:
    """The slowest modes about their reference, each over one period, all shown equally fast.

    Args:
        frames: of each.

    Raises:
        UsageError: there is none; parameters without values.
    """
    reference = modes.small.reference
    if not reference.valued:
        raise UsageError("modes are shown with values of all parameters", fix="give them values in [parameters]")
    shown = len(_swinging(modes)[:count])
    if not shown:
        raise UsageError("the model has no mode that swings", fix="show a run: leave the mode out")
    return [_mode_movie(modes, k, frames) for k in range(1, shown + 1)]


def _swinging(modes: Modes) -> list[Any]:
    return [mode for mode in modes.spectrum.modes if mode.frequency]


def _mode_movie(modes: Modes, number: int, count: int) -> Movie:
    """q = q_0 + a Re(shape e^(i phase)) of the mode of this number over one turn of the phase."""
    mode = _swinging(modes)[number - 1]
    system = modes.small.reference.system
    scene = scene_of_system(system)
    at = StateInNumbers.of(system, modes.small.reference.numbers)
    shape = np.array([complex(mode.shape.get(q, 0.0)) for q in system.symbols.q] + [0.0] * len(system.symbols.u))
    phase = 2 * np.pi * np.arange(count) / count
    swung = np.real(shape[None, :] * np.exp(1j * phase)[:, None])
    size = swing(scene, at, swung)
    frames = frames_along(scene, np.full(count, at.t), at.x[None, :] + size * swung, at.p)
    frequency = mode.frequency or 0.0
    return _movie(SceneNumbers(scene, frames), phase / (frequency or 1.0), {}, f"{number}: {frequency:.4g} rad/s")


def swing(scene: Scene, at: StateInNumbers, swung: np.ndarray) -> float:
    """Amplitude of a mode's picture: the body that moves most moves by a part of the picture."""
    states = np.vstack([at.x[None, :], at.x + tolerances.WIDE_STEP * swung])
    numbers = SceneNumbers(scene, frames_along(scene, np.full(len(states), at.t), states, at.p))
    return swing_of(numbers, tolerances.WIDE_STEP)


def virtual_movie(found: VirtualDisplacement, frames: int) -> Movie:
    """A virtual displacement to and fro, once."""
    times = PERIOD * np.arange(frames) / frames
    numbers = found.along(2 * np.pi * times / PERIOD)
    return replace(_movie(numbers, times, {}, f"{found.reaction.name} released"), timed=False)
