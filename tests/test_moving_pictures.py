"""Moving pictures: what a frame shows is where the motion has it."""

from __future__ import annotations

import html
import io
import json
import math
import subprocess
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from click.testing import CliRunner
from forked import needs_sh
from matplotlib.figure import Figure
from PIL import Image
from slow_run import sampled

import eomgen
from eomgen.cli import main
from eomgen.codegen.program import Program
from eomgen.codegen.rhs import RightHandSide
from eomgen.documents.scene_pictures import SpacePicture, sight
from eomgen.mechanics.dynamics.system import System
from eomgen.page import animation as animate
from eomgen.page import moving_picture
from eomgen.page.animation import released
from eomgen.page.moving_picture import FINE, frame_times, mode_movies, movie_of
from eomgen.results.small_motions.result import linearize
from eomgen.scene.bodies import parameters_as_drawn
from eomgen.scene.forms import ArrowForm, CoupleForm
from eomgen.scene.frames_of_phases import phase_frames
from eomgen.scene.making import SWING, VirtualDisplacement, scene_of_system
from eomgen.scene.scene import frames_along, scalars_of
from eomgen.scene.space_strokes import drawing_of
from eomgen.scene.strokes import SceneNumbers
from eomgen.symbolic.numeric.evaluation import FLOAT, evaluate

pytestmark = pytest.mark.slow
MODELS = Path(__file__).parent.parent / "models"
PENDULUM = MODELS / "double_pendulum.toml"


@pytest.fixture(scope="module")
def run() -> eomgen.Trajectory:
    return eomgen.simulate(eomgen.load(PENDULUM), time=1, samples=101)


def test_frames_stand_as_far_apart_as_speed_over_rate():
    """dt = speed / fps, the last one not after the end; too many are refused before any work."""
    assert np.allclose(frame_times(1.0, 25, 1), np.arange(26) / 25)
    assert np.allclose(frame_times(1.0, 10, 2), [0, 0.2, 0.4, 0.6, 0.8, 1.0])
    with pytest.raises(eomgen.UsageError, match="frames are more than"):
        frame_times(1e6, 25, 1)
    for fps, speed in ((0, 1), (math.nan, 1), (math.inf, 1), ("25", 1), (25, 0), (25, math.inf), (25, None)):
        with pytest.raises(eomgen.UsageError, match=r"make no moving picture|makes no sense"):
            frame_times(1.0, fps, speed)
    with pytest.raises(eomgen.UsageError, match="before a second frame comes"):
        frame_times(0.02, 25, 1)


@pytest.mark.parametrize("fps", (7, 25, 30, 40, 50))
def test_a_gif_of_any_rate_takes_as_long_as_its_motion(run, fps):
    """The sum of n delays is n/fps to a hundredth of a second, though a GIF counts in these."""
    data = moving_picture.gif([movie_of(run, frame_times(1.0, fps, 1))], fps)
    with Image.open(io.BytesIO(data)) as picture:
        delays = []
        for frame in range(picture.n_frames):
            picture.seek(frame)
            delays.append(picture.info["duration"])
    assert sum(delays) == pytest.approx(1000 * len(delays) / fps, abs=5)


def test_a_motion_in_which_nothing_moves_is_said(tmp_path):
    """x(t) = x(0): in a file of any kind, on the command line and in Python; not of what swings."""
    still = tmp_path / "still.toml"
    still.write_text((MODELS / "simple_pendulum.toml").read_text().replace("start = 1.0", "start = 0"))
    for model, ending in ((still, "gif"), (still, "png"), (still, "html"), (MODELS / "simple_pendulum.toml", "png")):
        words = ["animate", str(model), "-o", str(tmp_path / f"m.{ending}"), "--time", "0.2"]
        done = CliRunner().invoke(main, words)
        assert (done.exit_code, "nothing moves" in done.stderr) == (0, model is still), done.output
    with pytest.warns(RuntimeWarning, match="nothing moves"):
        eomgen.simulate(still, time=0.2).animate(tmp_path / "m.png")


def test_a_strip_has_as_many_frames_as_are_asked_from_the_start_to_the_end(tmp_path):
    """n frames at k T/(n - 1)."""
    for frames in (1, 4, 9):
        words = ["animate", str(PENDULUM), "-o", str(tmp_path / "m.png"), "--time", "0.2", "--frames", str(frames)]
        assert json.loads(CliRunner().invoke(main, [*words, "--json"]).stdout)["frames"] == frames
    assert CliRunner().invoke(main, [*words[:-1], "1000"]).exit_code == 2
    assert CliRunner().invoke(main, ["animate", str(PENDULUM), "-o", "m.png", "--modes", "2"]).exit_code == 2


def test_a_strip_of_a_drive_that_is_back_at_each_of_its_frames_shows_one_round(tmp_path, monkeypatch):
    """w = pi: a turn takes 2 s, as long as it is from frame to frame of 10 s; shown are sixths of a turn"""
    shown = []
    monkeypatch.setattr(animate, "strip", lambda movie: shown.append(movie) or b"")
    path = str(tmp_path / "yoke.png")
    args = ["animate", str(MODELS / "scotch_yoke.toml"), "--set", "w=pi", "-o", path]
    assert CliRunner().invoke(main, args).exit_code == 0
    assert shown[0].times == pytest.approx(np.arange(6) / 3) and shown[0].as_at_first.tolist() == [True] + 5 * [False]


def test_the_times_of_a_flat_strip_are_seen_whole(tmp_path):
    """What is written over a frame keeps its height however low the frame is: its top row is paper."""
    from PIL import Image

    place = tmp_path / "m.png"
    text = """eomgen = 1
space = "space"
[coordinates]
x = { speed = 1 }
[bodies.puck]
shape = { kind = "rod", mass = 1, length = 1 }
joint = { kind = "prismatic", axis = [1, 0, 0], displacement = "x" }
"""
    eomgen.simulate(eomgen.loads(text), time=5).animate(place)
    page = np.asarray(Image.open(place).convert("L"))
    assert page.shape[0] < 0.09 * page.shape[1] and page[0].min() == 255 and page[:40].min() < 100


def test_a_trail_is_the_way_of_its_point(run):
    """x = l1 cos(a1) + l2 cos(a2), y likewise, with the angles of the run's own rows: by hand."""
    times = frame_times(1.0, 20, 1)
    movie = movie_of(run, times, trail=("arm2.end",))
    way = movie.trails["arm2.end"]
    assert len(way) == FINE * (len(times) - 1) + 1
    model = eomgen.load(PENDULUM)
    known = {name: float(part.value.evaluate({})) for name, part in model.parameters.items()}
    row = 50
    q = dict(zip(run.coordinates, run.x[row], strict=False))
    at, turned = np.zeros(2), 0.0
    for body in ("arm1", "arm2"):
        joint = model.bodies[body].joint
        turned = joint.angle.evaluate({**q, "pi": np.pi}) + (turned if joint.on else 0.0)
        at = at + model.bodies[body].shape.length.evaluate(known) * np.array([np.cos(turned), np.sin(turned)])
    assert np.allclose(way[round(run.t[row] * 20 * FINE)], at, atol=2e-3)
    with pytest.raises(eomgen.UsageError, match="no point"):
        movie_of(run, times, trail=("arm2.ende",))


def test_the_arrow_of_a_reaction_is_the_column_of_the_run(run):
    """tip - tail = scale (R_x, R_y), one scale in the whole run, at the joint."""
    times = frame_times(1.0, 20, 1)
    drawing = movie_of(run, times, forces=True).drawing
    scale = drawing.sizes.scales["reaction", "N"]
    force = np.column_stack([np.interp(times, run.t, run[f"reaction_{axis}(arm1)"]) for axis in "xy"])
    shaft, head = (s for s in drawing.strokes if s.role == "reaction" and s.of == "arm1")
    arrow = head.path[:, 0] - shaft.path[:, 0]
    assert np.allclose(arrow, scale * force) and np.allclose(head.path[:, 0], 0.0)


def test_the_arrows_of_supports_and_rolling_contacts_are_what_moves_the_whole():
    """F_wall + F_floor + sum m g = sum m a_C, of a bar 4M, 3R on a disc 2M, R: the arrows at both, by one scale."""
    model = eomgen.load(MODELS / "seeds" / "ch22_p1.toml")
    run = eomgen.simulate(model, time=1, samples=11)
    drawing = movie_of(run, run.t, forces=True).drawing
    M, R, g = 1.0, 0.5, 9.81
    q, u = run.x.T
    a = (9 * R * np.cos(q) * u**2 + 2 * g) * np.sin(q) / (R * (4 + 9 * np.cos(q) ** 2))
    rates = 12 * (np.cos(q) * a - np.sin(q) * u**2), 6 * (-np.sin(q) * a - np.cos(q) * u**2) + 6 * g / R
    strokes = {"wall": [], "floor": []}
    for stroke in drawing.strokes:
        if stroke.role == "reaction" and stroke.of in strokes:
            strokes[stroke.of].append(stroke.path)
    arrows = {of: head[:, 0] - shaft[:, 0] for of, (shaft, head) in strokes.items()}
    scale = drawing.sizes.scales["reaction", "N"]
    assert np.allclose(arrows["wall"] + arrows["floor"], scale * M * R * np.column_stack(rates), atol=1e-6)
    assert np.allclose(strokes["floor"][1][:, 0], np.column_stack([3 * R * np.sin(q), 0 * q]), atol=1e-9)


@pytest.mark.parametrize(("name", "body"), (("sliding_ladder", "ladder"), ("loop_the_loop", "bead")))
def test_each_phase_of_a_moving_picture_is_drawn_by_its_own_system(name, body):
    """A trail is where each phase's own equations have the point, at the states that its integrator went through."""
    run = eomgen.simulate(MODELS / f"{name}.toml", time=3, samples=1201)
    assert len(run.phases) > 1
    point = next(p for p, _ in phase_frames(run, run.t).scene.points if p.startswith(f"{body}."))
    times = frame_times(float(run.t[-1]), 100, 1)
    way = movie_of(run, times, trail=(point,)).trails[point]
    for phase in run.phases:
        (t, x), system = phase.track, phase.model.system
        own = Program.of(system.motion.position(system.motion.place(point))[:2], system.symbols, inputs=system.inputs)
        here = (t > phase.start) & (t < min(phase.end, times[-1]))
        if here.any():
            right = RightHandSide.of(own, "numpy").many(t[here], x[here], phase.model.p)
            found = [np.interp(t[here], np.linspace(0, times[-1], len(way)), column) for column in way.T]
            assert np.abs(np.column_stack(found) - right).max() < 2e-3


STRUCTURES = ("gerber_beam", "fink_truss", "three_hinged_arch", "strut_frame", "tripod", "cantilever", "k_truss")


@sampled(3)
@pytest.mark.parametrize("name", STRUCTURES)
def test_the_drawn_virtual_displacement_gives_the_reaction_that_the_balance_of_bodies_gives(name):
    """R u_R + sum of F u + sum of M phi = 0 over the arrows of the picture, u and phi as far as the picture moves them.

    R is taken from the balance of the bodies, which knows of no displacement.
    """
    found = eomgen.statics(MODELS / f"{name}.toml").found
    looked = 0
    for reaction in found.reactions:
        if reaction.work is None or not reaction.work.plan.moving:
            continue
        displaced = VirtualDisplacement(found.structure, reaction)
        numbers = displaced.along(np.array([0.0, 0.5 * np.pi]))
        known = parameters_as_drawn(found.system)
        R = float(evaluate((reaction.balanced,), known, FLOAT)[0])
        held = displaced.effects[0].link
        works = [_work(numbers, mark, held) * (R if mark.role == "reaction" else 1) for mark in numbers.scene.marks]
        assert abs(sum(works)) <= 1e-9 * max(map(abs, works)), reaction.name
        looked += R != 0
    assert looked > 2


def _work(numbers, mark, held):
    """Of an arrow of force on the way from the first frame to the second; of a couple on the body that it holds."""
    form = mark.form
    if mark.role not in ("force", "reaction"):
        return 0.0
    if isinstance(form, ArrowForm):
        return float(numbers.way(form.vector, mark)[0] @ np.diff(numbers.spot(form.at, mark), axis=0)[0])
    if isinstance(form, CoupleForm):
        system = numbers.scene.system
        loads = [load for force in system.loads.applied if force.name == mark.of for load in force.loads]
        link = system.motion.index[loads[0].body] if loads else held
        before, after = numbers.poses[link + 1][0][:, :, 0]
        return float(numbers.value(form.vector[2])[0] * (before[0] * after[1] - before[1] * after[0]))
    a, b = (numbers.spot(place, mark) for place in (form.a, form.b))
    p, q = (numbers.way(v, mark)[0] for v in (form.at_a, form.at_b))
    (da,), (db,) = np.diff(a, axis=0), np.diff(b, axis=0)
    return float(np.linalg.norm((b - a)[0]) / 6 * (2 * p @ da + p @ db + q @ da + 2 * q @ db))


def test_a_gif_has_a_picture_for_each_frame_and_one_palette(run):
    """n frames of 1/fps; the same bytes every time; its white is white."""
    movies = [movie_of(run, frame_times(1.0, 25, 1))]
    data = moving_picture.gif(movies, 25)
    assert data == moving_picture.gif(movies, 25) and len(data) < 150_000
    with Image.open(io.BytesIO(data)) as picture:
        assert picture.n_frames == 26 and picture.info["duration"] == 40 and picture.info["loop"] == 0
        assert picture.convert("RGB").getpixel((1, 1)) == (255, 255, 255)
        first = np.array(picture.convert("RGB"))
        picture.seek(20)
        assert np.any(first != np.array(picture.convert("RGB")))


def test_modes_of_particles_move_and_come_back():
    """Of the picture's extent the largest deflection is SWING; after a period a mode is where it began."""
    model = eomgen.load(MODELS / "two_mass_oscillator.toml")
    movies = mode_movies(linearize(model).modes, 2, 50)
    assert len(movies) == 2
    for movie in movies:
        paths = [s.path.reshape(len(movie.times), -1) for s in movie.drawing.strokes if s.role == "body"]
        moved = max(float(np.nanmax(np.abs(path - path.mean(axis=0)))) for path in paths)
        assert 0.5 * SWING < moved / movie.drawing.sizes.extent < 1.5 * SWING
        step = max(float(np.nanmax(np.abs(path[0] - path[-1]))) for path in paths)
        assert step < 0.3 * moved


@pytest.mark.parametrize("ending", ("gif", "png"))
@pytest.mark.parametrize("model", ("double_pendulum", "arm3"))
def test_the_verb_writes_what_its_ending_says(model, ending, tmp_path):
    """In the plane and in space; only what was written is said."""
    target = tmp_path / f"motion.{ending}"
    done = CliRunner().invoke(main, ["animate", str(MODELS / f"{model}.toml"), "-o", str(target), "--time", "0.2"])
    assert done.exit_code == 0, done.output
    with Image.open(target) as picture:
        assert getattr(picture, "n_frames", 1) == (6 if ending == "gif" else 1)


def test_what_cannot_be_written_is_said_before_any_work(tmp_path, monkeypatch, run):
    """Another ending is exit 2; .mp4 without ffmpeg is exit 4, with the package that has it."""
    done = CliRunner().invoke(main, ["animate", str(PENDULUM), "-o", str(tmp_path / "motion.avi")])
    assert done.exit_code == 2 and "endings are" in done.output
    monkeypatch.setattr(moving_picture.shutil, "which", lambda name: None)
    monkeypatch.setitem(__import__("sys").modules, "imageio_ffmpeg", None)
    with pytest.raises(eomgen.ToolMissing, match="ffmpeg") as missing:
        run.animate(tmp_path / "motion.mp4")
    assert missing.value.exit_code == 4 and not (tmp_path / "motion.mp4").exists()


@pytest.mark.parametrize("ending", ("gif", "png", "html"))
def test_the_verb_shows_what_moves_when_a_reaction_is_released(ending, tmp_path):
    """Its equation of work is said; a reaction that there is not, or that is indeterminate, has no picture."""
    target, beam = tmp_path / f"virtual.{ending}", str(MODELS / "gerber_beam.toml")
    done = CliRunner().invoke(main, ["animate", beam, "--virtual", "reaction_y(E)", "-o", str(target)])
    assert done.exit_code == 0 and "reaction_y(E) = 7*p*a" in done.output and target.stat().st_size
    wrong = CliRunner().invoke(main, ["animate", beam, "--virtual", "reaction_y(F)", "-o", str(target)])
    assert wrong.exit_code == 2 and "there is no reaction" in wrong.output
    both = CliRunner().invoke(main, ["animate", beam, "--virtual", "reaction_y(E)", "--modes", "1", "-o", str(target)])
    assert both.exit_code == 2
    before = target.read_bytes()
    eomgen.virtual_displacement(beam, "reaction_y(E)", target)
    assert target.read_bytes() == before


def test_a_virtual_displacement_shows_itself_in_a_notebook():
    """A page of its own in a frame; of what is held without it nothing moves, and that is said."""
    shown = eomgen.virtual_displacement(MODELS / "gerber_beam.toml", "reaction_y(E)")._repr_html_()
    assert shown.startswith("<iframe") and "reaction_y(E) released" in html.unescape(shown)
    with pytest.raises(eomgen.DerivationError, match="statically indeterminate"):
        eomgen.virtual_displacement(MODELS / "spatial_four_bar.toml", "reaction_x(crank)")


HELD_BY_SPRINGS = """
eomgen = 1
space = "plane"
bodies.beam.points = { A = [0, 0], B = [2, 0] }
points.up = [4, 3]
points.left = [-1, 2]
constraints.A = { kind = "pin", points = ["beam.A"] }
constraints.B = { kind = "support", point = "beam.B", normal = [0, 1] }
forces.pull = { kind = "spring", points = ["up", "beam.B"], stiffness = 5, length = 1 }
forces.other = { kind = "damper", points = ["beam.B", "left"], damping = 1 }
"""


@pytest.mark.parametrize("ending", [".png", ".html"])
def test_a_structure_with_springs_at_the_ground_is_shown_displaced(tmp_path, ending):
    """The wall behind a spring lies as it does where nothing is displaced: share 0"""
    eomgen.virtual_displacement(eomgen.loads(HELD_BY_SPRINGS), "reaction_n(B)", tmp_path / f"a{ending}")
    eomgen.report(eomgen.loads(HELD_BY_SPRINGS), tmp_path / "r.html")
    assert (tmp_path / f"a{ending}").stat().st_size > 1000


def test_of_a_mechanism_other_freedoms_stand_still_where_a_reaction_is_released():
    """The crank's pin gives way along x alone: its displacement is 1 along x, 0 along y."""
    found, stands = released(eomgen.load(MODELS / "four_bar.toml"), "reaction_x(crank)")
    v = [
        float(x)
        for x in evaluate(
            found.equation.plan.velocity(("crank", (0, 0, 0))), parameters_as_drawn(found.structure.system), FLOAT
        )
    ]
    assert not stands and v[0] and v[1:] == [0, 0]


@needs_sh
def test_an_mp4_is_what_ffmpeg_makes_of_all_frames(tmp_path, monkeypatch, run):
    """Every frame goes into it, 3 bytes a dot."""
    fake = tmp_path / "ffmpeg"
    fake.write_text('#!/bin/sh\nfor last; do :; done\nwc -c > "$last"\n')
    fake.chmod(0o755)
    monkeypatch.setattr(moving_picture, "ffmpeg", lambda: str(fake))
    run.animate(tmp_path / "motion.mp4", fps=10)
    (size,) = {image.size for image in moving_picture.images([movie_of(run, frame_times(1.0, 10, 1))])}
    assert int((tmp_path / "motion.mp4").read_text()) == 11 * 3 * size[0] * size[1]
    assert subprocess.run([fake, tmp_path / "none"], input=b"", check=True).returncode == 0


def test_a_run_shows_its_player_in_a_notebook_and_as_a_page(run, tmp_path):
    """The page stands in a sandboxed <iframe>, and is the file that .html gives."""
    shown = run.animate()._repr_html_()
    assert shown.startswith('<iframe sandbox="allow-scripts"')
    run.animate(tmp_path / "motion.html")
    page = (tmp_path / "motion.html").read_text(encoding="utf-8")
    assert html.unescape(shown.partition('srcdoc="')[2].removesuffix('"></iframe>')) == page


def test_of_a_solid_the_faces_towards_the_eye_are_drawn():
    """Of a box three of six; what is drawn of it covers what all six cover; a shell, which is open, is drawn whole."""
    text = """
    eomgen = 1
    space = "space"
    parameters = { m = 1 }
    coordinates = { q = 0.3 }
    bodies.b.shape = { kind = "SHAPE }
    bodies.b.joint = { kind = "revolute", axis = [0, 0, 1], angle = "q" }
    """
    shapes = {3: 'box", mass = "m", size = [1, 2, 3]', 20: 'cylindrical_shell", mass = "m", radius = 1, length = 2'}
    for count, shape in shapes.items():
        system = System.of(eomgen.loads(text.replace("SHAPE", shape)))
        scene = scene_of_system(system)
        x = np.array([[0.3, 0.0]])
        numbers = SceneNumbers(scene, frames_along(scene, np.zeros(1), x, np.array([1.0])))
        drawing = drawing_of(numbers)
        (whole,) = (stroke for stroke in drawing.strokes if stroke.faces and stroke.role == "body")
        picture = SpacePicture(Figure().subplots(), replace(drawing, strokes=(whole,)))
        picture.show(0)
        seen = [path.vertices for path in picture.pieces.get_paths()]
        assert len(seen) == count
        across = sight(drawing.sizes.up).T[:, :2]
        corners = whole.path[0].reshape(-1, 3) @ across
        drawn = np.concatenate(seen)
        assert np.allclose(drawn.min(axis=0), corners.min(axis=0)) and np.allclose(
            drawn.max(axis=0), corners.max(axis=0)
        )


def test_what_lies_on_the_ground_is_drawn_in_every_phase():
    """Slope, loop and exit of a wire are each seen all the time: no number of a track is missing, or moves."""
    run = eomgen.simulate(eomgen.load(MODELS / "loop_the_loop.toml"), time=2, samples=41)
    assert len(run.phases) == 3
    numbers = phase_frames(run, run.t)
    tracks = [mark for mark in numbers.scene.marks if mark.role == "track"]
    assert [mark.form.kind for mark in tracks] == ["line", "line", "arc"]
    for mark in tracks:
        for x in scalars_of(mark.form):
            column = numbers.value(x)
            assert np.isfinite(column).all() and (column == column[0]).all()


@pytest.mark.parametrize(
    ("name", "start"),
    [("cart_pole", {"x'": 20.0}), ("rolling_disc", {}), ("cart_pole", {})],
    ids=["plane", "space", "near"],
)
def test_a_picture_goes_with_what_goes_far(name, start):
    """Of 80 m the machine is no dot: the drawing moves back by the way of the bodies' middle; near, nothing does."""
    run = eomgen.simulate(eomgen.load(MODELS / f"{name}.toml"), time=4 if start else 10, samples=201, start=start)
    movie = movie_of(run, np.linspace(0, run.t[-1], 9))
    if name == "cart_pole" and not start:
        assert movie.shown is movie.drawing
        return
    sizes = movie.shown.sizes
    assert 0.5 * sizes.at_first < sizes.extent < 6 * sizes.at_first < movie.drawing.sizes.extent
    for one, other in zip(movie.drawing.strokes, movie.shown.strokes, strict=True):
        if one.role == "body":
            back = (one.path - other.path).reshape(9, -1, len(sizes.low))
            assert np.abs(back - movie.gone[:, None]).max() < 1e-9
            inside = other.path.reshape(-1, len(sizes.low))
            assert ((inside > sizes.low - 1e-9) & (inside < sizes.high + 1e-9)).all()
    assert np.abs(movie.gone).max() > 6
    assert moving_picture._tallness(movie) > 0.3


def test_weights_springs_and_reactions_are_arrows_of_one_scale():
    """At rest m g = k (l - l_0), m g = R: the arrows at the hanging mass are as long, those at the rod, of half its
    mass, half as long; the spring that is slack has none."""
    text = """
    eomgen = 1
    space = "plane"
    [points]
    A = [1, 2]
    B = [2, 0.5]
    [coordinates]
    y = { start = 1 }
    phi = { start = "-pi/2" }
    [bodies.mass]
    mass = 4
    joint = { kind = "prismatic", at = [1, 0], axis = [0, 1], displacement = "y" }
    [bodies.rod]
    shape = { kind = "rod", mass = 2, length = 1 }
    joint = { kind = "revolute", at = [3, 1.5], angle = "phi" }
    [forces]
    weight = { kind = "gravity", acceleration = [0, -10] }
    hung = { kind = "spring", points = ["A", "mass.origin"], stiffness = 100, length = 0.6 }
    slack = { kind = "spring", points = ["B", "rod.end"], stiffness = 100, length = 1 }
    """
    run = eomgen.simulate(eomgen.loads(text), time=1, samples=3)
    movie = movie_of(run, run.t, forces=True)
    arrows = [s for s in movie.drawing.strokes if s.role in ("force", "reaction") and s.filled]
    tips = {(s.of, k): s.path[0, 0] for k, s in enumerate(arrows) if np.isfinite(s.path[0]).all()}
    assert sorted(of for of, _ in tips) == ["hung", "rod", "weight(mass)", "weight(rod)"]
    at = {"hung": (1, 1), "weight(mass)": (1, 1), "weight(rod)": (3, 1), "rod": (3, 1.5)}
    away = {of: tip - at[of] for (of, _), tip in tips.items()}
    long = np.linalg.norm(away["hung"])
    assert away["hung"] == pytest.approx([0, long], abs=1e-9) and long > 0.1
    assert away["weight(mass)"] == pytest.approx([0, -long])
    assert away["weight(rod)"] == pytest.approx([0, -long / 2])
    (shaft,) = (s.path[0, 0] for s in movie.drawing.strokes if (s.role, s.of, s.filled) == ("reaction", "rod", False))
    assert shaft == pytest.approx([3, 1.5 - long / 2])


def test_a_rope_pulls_with_its_tension_what_hangs_on_it():
    """T1 = m1 g (4 m2 + M)/(2 m1 + 2 m2 + M) up at the left load, down at the rim, in the scale of the weights; and
    so on the right. An arrow upside down is seen by the way that reads the picture."""
    run = eomgen.simulate(eomgen.load(MODELS / "atwood.toml"), time=0.2, samples=3)
    movie = movie_of(run, run.t, forces=True)
    strokes = [s for s in movie.drawing.strokes if s.role in ("force", "reaction")]
    ways = [
        (head.of, shaft.path[0, 0], head.path[0, 0]) for shaft, head in zip(strokes[::2], strokes[1::2], strict=True)
    ]
    weights = {of: begin[1] - tip[1] for of, begin, tip in ways if of.startswith("weight(")}
    pulls = {tuple(np.round(begin, 9)): tip - begin for of, begin, tip in ways if of == "string"}
    left, right = weights["weight(left)"] * 7 / 8, weights["weight(right)"] * 9 / 8
    due = {(-0.2, -1): left, (-0.2, 0): -left, (0.2, 0): -right, (0.2, -1): right}
    assert set(pulls) == set(due)
    for at, size in due.items():
        assert pulls[at] == pytest.approx([0, size], rel=1e-6, abs=1e-9)
    assert not [check for check in animate.movie_read_back(run, movie) if check.ok is False]
    turned = [
        s if s.of != "string" or s.role != "reaction" else replace(s, path=-s.path) for s in movie.drawing.strokes
    ]
    wrong = replace(movie, drawing=replace(movie.drawing, strokes=tuple(turned)))
    assert [check for check in animate.movie_read_back(run, wrong) if check.ok is False]
