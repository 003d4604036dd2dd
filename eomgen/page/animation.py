"""eomgen animate: the motion, or small motions, as a moving picture."""

from __future__ import annotations

import warnings
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import replace
from pathlib import Path

import numpy as np

from eomgen import files, pipeline
from eomgen.documents import Document, plain_document, prose, with_start_reported
from eomgen.equations import Equations
from eomgen.errors import UsageError
from eomgen.frozen import dataclass
from eomgen.mechanics.dynamics import System
from eomgen.mechanics.free_bodies import Structure
from eomgen.mechanics.statics import ContactsAtStart, StaticReaction
from eomgen.model import Model, ModelOrPath, Typed, Values
from eomgen.page.moving_picture import (
    FINE,
    PERIOD,
    Movie,
    Progress,
    frame_times,
    gif,
    mode_movies,
    movie_of,
    mp4,
    on_stderr,
    refuse_rates,
    strip,
    virtual_movie,
)
from eomgen.page.player import PlayedRun, PlayerOptions, player_page_of, player_read_back
from eomgen.proof import Check, pictures_reported, states_shown
from eomgen.results import virtual_work_step
from eomgen.runs import PAGE_TIME, page_stepping, page_time
from eomgen.runs import run as simulated
from eomgen.scene import VirtualDisplacement, picture_reported
from eomgen.simulation import Stepping, Trajectory
from eomgen.study import model_to_study
from eomgen.symbolic.numeric import tolerances

ENDINGS = (".gif", ".mp4", ".png", ".html")
STILL = (".png", ".html")  # of which --fps says nothing
GIF_FPS = 50  # faster frames are shown at 10 a second by some
MOST_IN_STRIP = 60
ROUNDS = 60  # between two frames of a strip, at most
NOTHING_MOVES = "nothing moves: all frames show the same"


@dataclass(frozen=True, repr=False)
class PlayerFrame:
    """A run's player, which shows itself in a notebook: a page of its own that loads nothing from elsewhere."""

    page: str

    def __repr__(self) -> str:
        return f"<page of a motion, {len(self.page) // 1024} KB>"

    def _repr_html_(self) -> str:
        from eomgen.page.contents import framed

        return framed(self.page)


@dataclass(frozen=True)
class Showing:
    """Options of a moving picture.

    Args:
        fps: frames a second.
        speed: seconds of the motion in a second.
        trail: points that leave a trail.
        forces: forces and reactions are arrows.
        frames: of a strip.
    """

    fps: float = 25.0
    speed: float = 1.0
    trail: tuple[str, ...] = ()
    forces: bool = False
    frames: int = 6

    def times(self, end: float, output: str) -> np.ndarray:
        """The instants that a file shows of a motion from 0: of a strip and of a page so many, evenly spaced.

        Raises:
            UsageError: a number, a rate or a speed that no picture has; of a .gif, more than it can show.
        """
        self._refuse(output)
        if _ending(output) in STILL:
            return np.linspace(0.0, end, self.frames)
        return frame_times(end, self.fps, self.speed)

    def of_a_swing(self, output: str) -> int:
        """Number of frames in one period of a small motion.

        Raises:
            UsageError: as of `times`.
        """
        self._refuse(output)
        return self.frames if _ending(output) in STILL else int(PERIOD * self.fps)

    def _refuse(self, output: str) -> None:
        refuse_rates(self.fps, self.speed)
        if _ending(output) == ".gif" and self.fps > GIF_FPS:
            what = f"a .gif shows at most {GIF_FPS} frames a second, not {self.fps:g}"
            raise UsageError(what, fix=f"take --fps {GIF_FPS}, or write an .mp4")
        if not 1 <= self.frames <= MOST_IN_STRIP:
            raise UsageError(f"a strip of {self.frames} frames", fix=f"from 1 to {MOST_IN_STRIP}")


def animate_document(
    model: Model,
    *,
    output: str,
    time: float | None,
    showing: Showing,
    modes: int | None = None,
    virtual: str | None = None,
) -> Document:
    """Writes the picture; the document describes its content.

    Args:
        time: the duration of the motion [s]; None: as `page_time` has it.
    """
    run: Trajectory | None = None
    shorter = ""
    if virtual is not None:
        if modes is not None:
            raise UsageError("--modes and --virtual are two pictures", fix="leave one of them out")
        return _virtual_document(model, virtual, output, showing)
    if modes is not None:
        movies = _modes(model, modes, output, showing)
        summary = f"{len(movies)} mode{'s' * (len(movies) > 1)}"
    else:
        if time is not None and not time > 0:
            raise UsageError(f"a motion of {time:g} s has nothing to show", fix="give a --time above 0")
        if _ending(output) == ".html" and len(showing.trail) > 1:
            raise UsageError("a page begins with one trail", fix="give one --trail; others are chosen in the page")
        run, shorter = _followed(pipeline.derive(model), time, showing, output)
        times = showing.times(float(run.t[-1]) if shorter else PAGE_TIME if time is None else time, output)
        movies, summary = [_shown(run, times, showing, _ending(output) == ".png")], run.summary()
    checks: Iterable[Check] = ()
    if _ending(output) == ".html" and run is not None:
        played = _played(run, showing)
        page = player_page_of(played)
        files.write(output, page)
        checks = player_read_back(played, page)
    else:
        write_movies(movies, output, showing, on_stderr)
        checks = () if run is None else movie_read_back(run, movies[0])
    reported = _reported(model, summary, movies, output, showing, run)
    reported = replace(reported, notes=(*reported.notes, *filter(None, (shorter,))))
    wrong = "; ".join(f"{check.name}: {check.detail}" for check in checks if check.ok is False)
    return replace(reported, failed="; ".join(filter(None, (reported.failed, wrong))))


def _followed(equations: Equations, time: float | None, showing: Showing, output: str) -> tuple[Trajectory, str]:
    """(the motion, with rows between its frames; why it is shorter than others)."""

    def lasting(time: float, how: Stepping) -> Trajectory:
        samples = FINE * max(len(showing.times(time, output)) - 1, 1) + 1
        return simulated(equations, time=time, samples=samples, how=how)

    if time is not None:
        return lasting(time, Stepping()), ""
    found = lasting(PAGE_TIME, page_stepping())
    time, words = page_time(found)
    return (lasting(time, Stepping()), words) if words else (found, "")


def movie_read_back(run: Trajectory, movie: Movie) -> Iterator[Check]:
    """Checks that the frames of a moving picture show the states of its run."""
    if movie.scene is None:
        return iter(())
    return pictures_reported(
        (state, picture_reported(movie.drawing, movie.scene, frame)) for frame, state in states_shown(run, movie.times)
    )


def _virtual_document(model: Model, reaction: str, output: str, showing: Showing) -> Document:
    """The displacement that gives a reaction is written; of a structure its equation of work is said."""
    found, stands = released(model, reaction)
    count = _write_displacement(found, output, showing, on_stderr)
    name = found.reaction.name
    payload = {"name": model.name, "files": [output], "frames": count, "fps": showing.fps, "virtual": name}
    summary = f"{model.name}: the virtual displacement that gives {name}"
    said = prose(summary if stands else f"{summary}; degrees of freedom besides it stand still")
    symbol = found.structure.system.symbols.graph.symbol(name)
    steps = virtual_work_step(name, found.equation, symbol).statements if stands else ()
    return plain_document(model, lambda: payload, said, *steps, prose(_written(output, count)))


def virtual_displacement(
    model: ModelOrPath,
    reaction: str,
    path: str | Path | None = None,
    *,
    fps: float = 25.0,
    frames: int = 6,
    parameters: Values | None = None,
    start: Values | None = None,
) -> PlayerFrame | None:
    """The virtual displacement of a structure that gives one of its reactions, as `animate` shows a run.

    Args:
        reaction: its name as in an output: "reaction_y(A)", "tension(T, n1-n2)".
        path: .gif, .mp4, a strip .png or a page; None: the page shows itself.
        parameters, start: values that replace the model's, each as `model_at` takes it.
    Raises:
        UsageError: another ending; there is no such reaction.
        DerivationError: released, nothing can move; bodies can move that no coordinate describes.
    """
    found, _ = released(model_to_study(model, parameters, start), reaction)
    if path is None:
        return PlayerFrame(_displacement_page(found))
    refuse_ending(str(path))
    _write_displacement(found, str(path), Showing(fps=fps, frames=frames), None)
    return None


def _displacement_page(found: VirtualDisplacement) -> str:
    from eomgen.page.player import PlayedDisplacements

    return player_page_of(PlayedDisplacements((found,)))


def _write_displacement(found: VirtualDisplacement, output: str, showing: Showing, progress: Progress | None) -> int:
    """Writes the file and returns the number of frames in a swing."""
    movie = virtual_movie(found, showing.of_a_swing(output))
    if _ending(output) == ".html":
        files.write(output, _displacement_page(found))
    else:
        write_movies([movie], output, showing, progress)
    return len(movie.times)


def released(model: Model, reaction: str) -> tuple[VirtualDisplacement, bool]:
    """(the model where it starts with one reaction released, whether it is a structure that stands).

    Raises:
        UsageError: there is no such reaction.
        DerivationError: released, nothing can move; bodies can move that no coordinate describes.
    """
    system = System.of(model, ContactsAtStart.at_rest(model))
    stands = not system.has_degrees_of_freedom
    structure = Structure.of(system.with_drives_held()[0] if stands else system)
    if stands:
        structure.refuse_loose()
    return VirtualDisplacement(structure, StaticReaction.released(structure, reaction)), stands


def _reported(
    model: Model, summary: str, movies: Sequence[Movie], output: str, showing: Showing, run: Trajectory | None
) -> Document:
    """Document that names the files written; it fails where the run stopped early, though that part of it is shown."""
    failed = "" if run is None or run.ok else run.message
    count, still = len(movies[0].times), all(movie.stands_still for movie in movies)
    reported_already = run is not None and bool(run.still)
    notes = (NOTHING_MOVES,) if count > 1 and still and not reported_already else ()
    payload = {"name": model.name, "files": [output], "frames": count, "fps": showing.fps, "speed": showing.speed}
    reported = (prose(f"{model.name}: {summary}"), prose(_written(output, count)))
    document = plain_document(model, lambda: payload, *reported, failed=failed, notes=notes)
    document = document if run is None else with_start_reported(document, model, run)
    return replace(document, interrupted=run is not None and run.status == "interrupted")


def animate(
    motion: Trajectory | ModelOrPath,
    path: str | Path | None = None,
    *,
    time: Typed | None = None,
    fps: float = 25.0,
    speed: float = 1.0,
    trail: str | Sequence[str] = (),
    forces: bool = False,
    frames: int = 6,
    parameters: Values | None = None,
    start: Values | None = None,
) -> PlayerFrame | None:
    """A motion as a moving picture: a .gif, .mp4, a strip .png or a page; without a path the page shows itself.

    Args:
        motion: a run; or a model, which is simulated.
        time: the duration of a model's motion, 10 s by default.
        parameters, start: of a model, values that replace its own, each as `model_at` takes it.
    Raises:
        UsageError: another ending, a point that is not there; of a run a time or values.
        ToolMissing: .mp4 without ffmpeg.
    """
    run = _run_of(motion, time, parameters, start)
    showing = Showing(fps, speed, (trail,) if isinstance(trail, str) else tuple(trail), forces, frames)
    if path is None:
        return PlayerFrame(player(run, showing))
    refuse_ending(str(path))
    movie = _shown(run, showing.times(float(run.t[-1]), str(path)), showing, _ending(str(path)) == ".png")
    if len(movie.times) > 1 and movie.stands_still:
        warnings.warn(NOTHING_MOVES, RuntimeWarning, stacklevel=2)
    if _ending(str(path)) == ".html":
        files.write(path, player(run, showing))
    else:
        write_movies([movie], str(path), showing, None)
    return None


def _run_of(
    motion: Trajectory | ModelOrPath, time: Typed | None, parameters: Values | None, start: Values | None
) -> Trajectory:
    """The run; of a model it is made."""
    if not isinstance(motion, Trajectory):
        return pipeline.simulate(motion, time=PAGE_TIME if time is None else time, parameters=parameters, start=start)
    if time is not None or parameters or start:
        raise UsageError("a run has its time and values already", fix="give the model in its place")
    return motion


def player(run: Trajectory, showing: Showing) -> str:
    """The page with the run's player."""
    return player_page_of(_played(run, showing))


def _played(run: Trajectory, showing: Showing) -> PlayedRun:
    trail = showing.trail[0] if showing.trail else ""
    return PlayedRun(run, PlayerOptions(trail=trail, forces=showing.forces, speed=showing.speed))


def refuse_ending(path: str) -> None:
    """Refuses a file that no picture is written into.

    Raises:
        UsageError: the name has another ending.
    """
    if _ending(path) not in ENDINGS:
        raise UsageError(f"no moving picture can be written as '{path}'", fix=f"endings are {', '.join(ENDINGS)}")


def _written(output: str, count: int) -> str:
    """Names the file written and, for anything but a page, the number of its frames."""
    return output if _ending(output) == ".html" else f"{count} frame{'s' * (count > 1)}: {output}"


def _ending(path: str) -> str:
    return Path(path).suffix.lower()


def _shown(run: Trajectory, times: np.ndarray, showing: Showing, strip: bool) -> Movie:
    """The frames up to where the run ended; of a strip that shows one place over and over those of one round."""
    here = times[times <= run.t[-1] * (1 + tolerances.COMPUTED)] if len(run.t) else times[:0]
    movie = movie_of(run, here, trail=showing.trail, forces=showing.forces)
    if strip and len(here) > 1 and movie.stands_still and (one := _round(run, float(here[1] - here[0]))):
        return movie_of(run, one * np.arange(len(here)) / len(here), trail=showing.trail, forces=showing.forces)
    return movie


def _round(run: Trajectory, step: float) -> float | None:
    """Shortest time, a step or a part of it down to 1/ROUNDS, after which everything is back where it started [s].

    None if nothing has moved.
    """
    times = np.array([0.0, *(step / k for k in range(ROUNDS, 0, -1))])
    back = movie_of(run, times).as_at_first[1:]
    return None if back.all() else float(times[1:][back][0])


def _modes(model: Model, count: int, output: str, showing: Showing) -> list[Movie]:
    """The slowest small motions, as many as the file shows side by side.

    Raises:
        UsageError: it shows fewer.
    """
    from eomgen.results import linearize

    if _ending(output) == ".html":
        raise UsageError("small motions have no page", fix="write a .gif")
    if _ending(output) == ".png" and count > 1:
        raise UsageError(f"a strip shows one small motion, not {count}", fix="take --modes 1, or write a .gif")
    frames = showing.of_a_swing(output)
    return mode_movies(linearize(model).modes, count, frames)


def write_movies(movies: Sequence[Movie], path: str, showing: Showing, progress: Progress | None) -> None:
    """Writes movies side by side into a file; the ending of its name says of which kind."""
    made = {
        ".mp4": lambda: mp4(movies, showing.fps, progress),
        ".png": lambda: strip(movies[0]),
        ".gif": lambda: gif(movies, showing.fps, progress),
    }
    files.write(path, made[_ending(path)]())
