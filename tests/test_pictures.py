"""Pictures of structures: one unit for all forces, arrows on the free side, and a display in notebooks."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from slow_run import sampled

import eomgen
from eomgen.documents.drawing import limits
from eomgen.documents.figures import Scale, four_figures
from eomgen.documents.scene_pictures import drawing_at_rest
from eomgen.model.reader import loads
from eomgen.results.mass_properties.result import values_at_start
from eomgen.scene import forms, plane_strokes
from eomgen.scene.making import DrawnArrow, scene_of, scene_of_inertia
from eomgen.scene.scene import Mark
from eomgen.scene.strokes import PictureSizes, SceneNumbers
from eomgen.study import StateInNumbers

pytestmark = pytest.mark.slow

MODELS = Path(__file__).parent.parent / "models"

CHORD = np.array([[0.0, 0.0], [4.0, 0.0]])
UPPER = np.array([[0.0, 0.5], [4.0, 0.5]])
POST = np.array([[2.0, 0.0], [2.0, 3.0]])


@pytest.mark.parametrize(
    ("values", "texts"),
    [
        ((41_930.0, -6_000.0), ("41.93 kN", "-6 kN")),
        ((2_500_000.0, 12_340.0), ("2500 kN", "12.34 kN")),
        ((1_500.0, 0.5), ("1500 N", "0.5 N")),
        ((7.0, 1 / 3), ("7 N", "0.3333 N")),
        ((0.02, 0.0005), ("20 mN", "0.5 mN")),
        ((0.0, 0.0), ("0 N", "0 N")),
    ],
)
def test_all_forces_of_a_picture_are_in_one_unit_with_four_figures(values, texts):
    """41930 N and 6000 N are 41.93 kN and 6 kN: the prefix is that of the largest."""
    scale = Scale.of(values)
    assert tuple(scale.text(value, "N") for value in values) == texts


@pytest.mark.parametrize(("value", "text"), [(41_934.6, "41930"), (1e-5, "0.00001"), (-2.0, "-2"), (0.0, "0")])
def test_a_label_has_no_power_of_ten_where_it_is_short_without(value, text):
    """4.193e+04 is 41930."""
    assert four_figures(value) == text


def test_an_arrow_is_drawn_on_the_side_where_it_meets_fewer_lines():
    """A load at the lower chord under a post hangs below it; a push on the chord's end stays outside."""
    lines = [CHORD, POST]
    assert DrawnArrow.is_freer_outward(lines, (2.0, 0.0), (0.0, -1.0))  # down, else it would run up along the post
    assert not DrawnArrow.is_freer_outward(lines, (2.0, 0.0), (0.0, 1.0))  # up, from below
    assert DrawnArrow.is_freer_outward(lines, (0.0, 0.0), (-1.0, 0.0))  # to the left, else it would lie in the chord
    assert not DrawnArrow.is_freer_outward(lines, (0.0, 0.0), (1.0, 0.0))
    assert not DrawnArrow.is_freer_outward([CHORD], (2.0, 0.0), (0.0, -1.0))  # a free beam carries its load on top
    assert DrawnArrow.is_freer_outward([CHORD, UPPER], (2.0, 0.0), (0.0, -1.0))  # else it would cross the upper chord


def test_a_spring_is_a_zigzag_from_end_to_end():
    """It begins and ends at its points, and swings by its width to both sides of the line between them."""
    scene = eomgen.load(MODELS / "simple_pendulum.toml").scene()
    numbers = SceneNumbers.at(scene, StateInNumbers.at_start(scene.system))
    form = forms.SpringForm((1, 1, 0), (4, 5, 0))
    sizes = PictureSizes(0.3 / 0.55, np.zeros(2), np.ones(2))
    (stroke,), _ = plane_strokes.TABLE[forms.SpringForm](form, Mark(form), numbers, sizes)
    line = stroke.path[0]
    away = (line - line[0]) @ np.array([-0.8, 0.6])
    assert np.allclose(line[[0, -1]], [[1, 1], [4, 5]])
    assert np.allclose([away.min(), away.max()], [-0.3, 0.3])
    assert np.all(np.diff(line @ np.array([0.6, 0.8])) > 0)


@sampled(2)
@pytest.mark.parametrize(
    "made",
    [
        lambda: eomgen.statics(eomgen.load(MODELS / "beam_with_overhang.toml")),
        lambda: eomgen.statics(eomgen.load(MODELS / "elastic_pendulum.toml")),
        lambda: eomgen.kinematics(eomgen.load(MODELS / "seeds" / "ch11_p4.toml")),
        lambda: eomgen.inertia(eomgen.load(MODELS / "seeds" / "ch13_p2.toml")),
    ],
    ids=["structure", "equilibria", "mechanism", "inertia"],
)
def test_results_show_themselves_and_their_pictures_in_a_notebook(made, tmp_path):
    """`_repr_markdown_` of the steps, `_repr_png_` of the picture, and the same as a file."""
    found = made()
    assert found._repr_markdown_().startswith("### ") and found.render("markdown").startswith("# ")
    assert found.picture._repr_png_().startswith(b"\x89PNG")
    found.plot(tmp_path / "it.svg")
    assert "<svg" in (tmp_path / "it.svg").read_text()


SKEW = """eomgen = 1
name = "Skew body"
space = "space"
[coordinates]
a = 0.7
b = 0.2
[bodies.ball]
shape = { kind = "sphere", mass = 2, radius = 0.3 }
joint = { kind = "revolute", axis = [0, 1, 1], angle = "a" }
[bodies.skew]
mass = 3
center = [0.1, 0.2, 0]
inertia = [0.9, 0.7, 0.6, -0.1, 0.2, 0.05]
joint = { kind = "revolute", at = [1, 0, 0], axis = [1, 0, 0], angle = "b" }
"""


def test_the_ellipsoid_of_inertia_is_drawn_in_space(tmp_path):
    """x I x = c: R diag(1/a^2) R^T goes as the tensor; that of a ball is the ball"""
    found = eomgen.inertia(eomgen.loads(SKEW))
    scene = scene_of_inertia(found.system, values_at_start(found.system), found.axes, found.moments)
    drawn = {mark.of: mark for mark in scene.marks_of_kind("ellipsoid") if mark.role == "inertia"}
    assert list(map(float, drawn["ball"].form.size)) == pytest.approx([0.3, 0.3, 0.3])
    R = np.array([[float(x) for x in row] for row in scene.frames[drawn["skew"].frame].pose.R])
    shape = R @ np.diag([1 / float(a) ** 2 for a in drawn["skew"].form.size]) @ R.T
    tensor = np.array([[0.9, -0.1, 0.05], [-0.1, 0.7, 0.2], [0.05, 0.2, 0.6]])
    assert np.allclose(shape / np.trace(shape), tensor / np.trace(tensor))
    found.plot(tmp_path / "it.png")
    assert (tmp_path / "it.png").read_bytes().startswith(b"\x89PNG")


def test_the_python_name_gives_places_of_rest_where_the_verb_does():
    """`eomgen.statics` of a system that is free to move: its equilibria; a single reaction is then refused."""
    pendulum = eomgen.load(MODELS / "simple_pendulum.toml")
    assert len(eomgen.statics(pendulum).places) == 2
    with pytest.raises(eomgen.UsageError, match="free to move"):
        eomgen.statics(pendulum, reaction="reaction_y(bar)")


def test_the_centrodes_of_a_ladder_are_drawn_as_cardan_circles():
    """The fixed one about the corner with the ladder's length as radius, the moving one half as large."""
    from matplotlib.figure import Figure

    text = """eomgen = 1
space = "plane"
[parameters]
l = 2.0
[coordinates]
phi = { start = 0.6, speed = 1.0 }
[bodies.ladder]
shape = { kind = "rod", mass = 1, length = "l" }
joint = { kind = "placed", at = ["l*sin(phi)", 0], angle = "pi/2 + phi" }
"""
    figure = Figure(layout="constrained")
    eomgen.kinematics(eomgen.loads(text)).picture.fill(figure)
    (panel,) = (axes for part in figure.subfigs for axes in part.axes if axes.get_title() == "centrodes of ladder")
    fixed, moving = (np.array(line.get_data()).T for line in panel.lines[:2])
    assert np.allclose(np.linalg.norm(fixed, axis=1), 2.0)
    middle = np.array([np.sin(0.6), np.cos(0.6)])
    assert np.allclose(np.linalg.norm(moving - middle, axis=1), 1.0)


def test_a_body_that_is_a_point_has_a_dot_in_the_diagrams_of_velocities():
    """A prism slides with v_x = 2 m/s and has no height: its piece over y is the dot (2, 0)."""
    from matplotlib.figure import Figure

    figure = Figure(layout="constrained")
    state = eomgen.kinematics(MODELS / "seeds" / "ch10_p1.toml")
    state.picture.fill(figure)
    (panel,) = (axes for axes in figure.axes if axes.get_xlabel() == "$v_x$ [m/s]")
    dots = [line.get_xydata()[0] for line in panel.lines if line.get_marker() == "o"]
    assert np.allclose(dots[0], [2.0, 0.0]) and len(dots) == 2


def test_of_the_reference_only_bodies_stand_behind_a_mode():
    """Each spring of two masses between walls is drawn once, swung out; the two masses twice."""
    from matplotlib.colors import to_hex
    from matplotlib.figure import Figure

    figure = Figure(layout="constrained")
    eomgen.linearize(MODELS / "two_mass_oscillator.toml").picture.fill(figure)
    for panel in figure.axes:
        teeth = [line for line in panel.lines if len(line.get_xdata()) == 12]
        masses = [patch for patch in panel.patches if to_hex(patch.get_edgecolor()) in ("#c4c4c4", "#2f5d8a")]
        assert (len(teeth), len(masses)) == (3, 4)


BOWL = """
eomgen = 1
space = "plane"
parameters = { m = 1, r = 0.05, R = 0.4, g = 9.81 }
coordinates = { phi = 1 }
[bodies.ball]
mass = "m"
inertia = "2/5*m*r^2"
joint = { kind = "placed", at = ["(R - r)*sin(phi)", "-(R - r)*cos(phi)"], angle = "-(R - r)*phi/r" }
[constraints.bowl]
kind = "rolling"
body = "ball"
radius = "r"
circle = { at = [0, 0], radius = "R", inside = true }
"""


def test_a_picture_holds_the_bowl_of_its_ball_and_the_angle_by_which_the_ball_is_placed():
    """The whole circle |x| = R is in sight; phi runs from the lowest place about the centre of the bowl, by phi."""
    drawing = drawing_at_rest(scene_of(loads(BOWL)))
    low, high = limits(drawing)
    assert (low < -0.4).all() and (high > 0.4).all()
    (letter,) = (each for each in drawing.letters if each.text == "phi")
    angle = np.arctan2(letter.at[0, 0], -letter.at[0, 1])
    assert angle == pytest.approx(0.5)
