"""Pictures are read again: bodies, springs and arrows are drawn where the model says, and as long."""

from __future__ import annotations

import json
from dataclasses import replace
from functools import cache
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from slow_run import sampled, usual

import eomgen
from eomgen.documents.scene_pictures import drawing_at_rest
from eomgen.page.animation import movie_read_back
from eomgen.page.moving_picture import Movie, movie_of
from eomgen.page.player import (
    PlayedRun,
    PlayerOptions,
    _named_otherwise,
    player_page_of,
    player_read_back,
    player_reported,
)
from eomgen.proof.reported_pictures import pictures_reported, states_shown
from eomgen.scene.frames_of_phases import picture_reported
from eomgen.scene.making import scene_of
from eomgen.simulation.result import Trajectory
from tests.test_shapes import EXAMPLES as SHAPES

MODELS = sorted((Path(__file__).parent.parent / "models").rglob("*.toml"))
CART = """
eomgen = 1
name = "A rod on a cart"
space = "plane"

[parameters]
l = { value = 0.8, unit = "m" }
k = { value = 50, unit = "N/m" }
F = { value = 3, unit = "N" }
n = { value = 1, unit = "1" }

[coordinates]
x = { start = 0.2, unit = "m" }
phi = { start = 40, unit = "deg" }

[points]
wall = [-1, 0]

[bodies.cart]
shape = { kind = "rectangle", width = 0.4, height = 0.2, mass = 2 }
joint = { kind = "prismatic", axis = [1, 0], displacement = "x" }

[bodies.rod]
shape = { kind = "rod", length = "l", mass = 1 }
joint = { kind = "revolute", on = "cart", at = [0, 0], angle = "phi" }

[forces.spring]
kind = "spring"
points = ["wall", "cart.origin"]
stiffness = "k"
length = 1

[forces.push]
kind = "force"
point = "rod.end"
force = ["n*F", "2*F"]

[forces.weight]
kind = "gravity"
acceleration = [0, -9.81]
"""


@cache
def run() -> Trajectory:
    return eomgen.simulate(eomgen.loads(CART), time=0.4, samples=9, target="numpy")


@cache
def movie() -> Movie:
    return movie_of(run(), run().t[[0, 4, 8]], forces=True)


def wrong(shown: Movie) -> str:
    return "; ".join(check.detail for check in movie_read_back(run(), shown) if check.ok is False)


def moved(role: str, change: Any) -> Movie:
    """The movie with the paths of one role changed."""
    strokes = (
        replace(stroke, path=change(stroke.path)) if stroke.role == role else stroke
        for stroke in movie().drawing.strokes
    )
    return replace(movie(), drawing=replace(movie().drawing, strokes=tuple(strokes)))


def test_the_arrow_of_a_contact_that_points_elsewhere_is_seen():
    """Turned by a quarter about its tip, of a support and of what rolls; as drawn they hold."""
    ran = eomgen.simulate(MODELS[0].parent / "seeds" / "ch22_p1.toml", time=0.4, samples=3, target="numpy")
    shown = movie_of(ran, ran.t, forces=True)
    assert all(check.ok for check in movie_read_back(ran, shown))
    for owner in ("wall", "floor"):
        tip = [s.path[:, :1] for s in shown.drawing.strokes if (s.role, s.of) == ("reaction", owner)][1]
        strokes = [
            replace(stroke, path=tip + (stroke.path - tip) @ np.array([[0, 1], [-1, 0]]))
            if (stroke.role, stroke.of) == ("reaction", owner)
            else stroke
            for stroke in shown.drawing.strokes
        ]
        turned = replace(shown, drawing=replace(shown.drawing, strokes=tuple(strokes)))
        assert any(owner in check.detail for check in movie_read_back(ran, turned) if check.ok is False)


def test_a_movie_shows_the_run():
    """R^T (r - p) fills the shape; a spring joins its points; an arrow is k F at its point."""
    assert wrong(movie()) == ""


@pytest.mark.parametrize("role", ["body", "spring", "force", "reaction"])
def test_what_is_drawn_elsewhere_is_seen(role: str):
    """r + (0.1, 0) m"""
    assert wrong(moved(role, lambda path: path + np.array([0.1, 0.0])))


@pytest.mark.parametrize("role", ["body", "spring", "force"])
def test_what_is_drawn_too_large_is_seen(role: str):
    """1.2 r about the middle of what is drawn"""
    assert wrong(moved(role, lambda path: path * 1.2))


def test_a_symbol_that_has_no_place_or_is_too_large_is_seen():
    """0 < its size < half of the picture"""
    assert wrong(moved("joint", lambda path: path + np.nan))
    assert wrong(moved("joint", lambda path: path * 50))


def test_a_body_that_is_not_drawn_is_seen():
    """Each body has its strokes."""
    kept = tuple(stroke for stroke in movie().drawing.strokes if stroke.of != "rod")
    assert "is not drawn" in wrong(replace(movie(), drawing=replace(movie().drawing, strokes=kept)))


def test_dimension_lines_are_as_long_as_what_stands_beside_them():
    """|c - d| = l beside l, an arc of phi beside phi"""
    scene = scene_of(eomgen.loads(CART))
    reported = picture_reported(drawing_at_rest(scene), scene, 0)
    assert dict(reported.lengths)["l"] == pytest.approx(0.8)
    assert dict(reported.angles)["phi"] == pytest.approx(np.radians(40))
    (_, state), *_ = states_shown(run(), run().t[:1])
    longer = replace(reported, lengths=[(name, 1.1 * x) for name, x in reported.lengths])
    wider = replace(reported, angles=[(name, 1.1 * x) for name, x in reported.angles])
    found = [[c.detail for c in pictures_reported([(state, x)]) if c.ok is False] for x in (reported, longer, wider)]
    assert [bool(x) for x in found] == [False, True, True]


@cache
def page(model: str) -> tuple[PlayedRun, str]:
    followed = run() if model == CART else eomgen.simulate(eomgen.loads(model), time=0.1, samples=2, target="numpy")
    played = PlayedRun(followed, PlayerOptions({}, model == CART))
    return played, player_page_of(played)


def wrong_page(change: Any, model: str = CART) -> str:
    """What is contradicted of a page that is told something else."""
    played, text = page(model)
    reported = json.loads(json.dumps(player_reported(text)))
    change(reported)
    begin = text.index("{", text.index("begun(document.getElementById("))
    _, end = json.JSONDecoder().raw_decode(text[begin:])
    checks = player_read_back(played, text[:begin] + json.dumps(reported) + text[begin + end :])
    return "; ".join(check.detail for check in checks if check.ok is False)


def marks(reported: Any, kind: str) -> Any:
    return next(mark for mark in reported["scene"]["marks"] if mark["kind"] == kind)


def joint(reported: Any) -> Any:
    return next(mark for mark in reported["scene"]["marks"] if mark.get("symbol") == "hinge")


def plotted(reported: Any, name: str) -> Any:
    return next(each for each in reported["plotted"] if each["name"] == name)


CHANGES = {
    "nothing": lambda reported: None,
    "a parameter": lambda reported: reported["parameters"][0].update(value=0.9),
    "the size of a unit": lambda reported: plotted(reported, "phi").update(size=1.0),
    "a unit": lambda reported: plotted(reported, "phi").update(unit="rad"),
    "a slider that ends before its value": lambda reported: reported["sliders"][0].update(max=0.1),
    "a power of ten of a column": lambda reported: reported["run"]["x"]["columns"][0].__setitem__(0, -10),
    "a name": lambda reported: reported.update(names=reported["names"][::-1]),
    "a corner of a body": lambda reported: marks(reported, "polygon")["points"][0].__setitem__(0, 0.3),
    "where a spring begins": lambda reported: marks(reported, "spring").update(a=[-0.9, 0]),
    "the pose of a body": lambda reported: reported["scene"]["frames"][1]["pose"].__setitem__(1, 0.1),
    "the symbol of a joint": lambda reported: joint(reported).update(symbol="pin"),
    "where a joint is": lambda reported: joint(reported).update(at=[0.1, 0]),
    "where a point is": lambda reported: reported["scene"]["points"][0].update(at=[1, 0]),
    "contacts that there are not": lambda reported: reported.update(rests="The contacts of this model change."),
}


@pytest.mark.parametrize("change", CHANGES)
def test_what_a_page_is_told_is_the_run_and_the_model(change: str):
    """read(page) = (run, parameters, units, scene)"""
    assert bool(wrong_page(CHANGES[change])) == (change != "nothing")


GYROSTAT = """
eomgen = 1
name = "A platform with a rotor, beside a stone that rolls"
space = "space"

[coordinates]
gamma = { speed = 0.3 }
alpha = 0
beta = 0
sigma = { speed = 60 }
x = 1
y = 0
z = 0.2
psi = { speed = -2 }
theta = 0.1
phi = 0

[bodies.platform]
mass = 300
inertia = [120, 100, 60]
joint = { kind = "spherical", orientation = "zxy", angles = ["gamma", "alpha", "beta"] }

[bodies.rotor]
mass = 0
inertia = [0, 0, 2]
measured = true
joint = { kind = "revolute", on = "platform", axis = [0, 0, 1], angle = "sigma" }

[bodies.stone]
mass = 1
center = [0, 0, -0.01]
inertia = [0.02, 0.16, 0.17, -0.002, 0, 0]
joint = { kind = "free", position = ["x", "y", "z"], orientation = "zxy", angles = ["psi", "theta", "phi"] }

[constraints.table]
kind = "rolling"
body = "stone"
ellipsoid = [2, 0.3, 0.2]
plane = { at = [0, 0, 0], normal = [0, 0, 1] }
"""


def ellipsoid(reported: Any, name: str) -> Any:
    return next(mark for mark in reported["scene"]["marks"] if mark["of"] == name and mark["kind"] == "ellipsoid")


def without(reported: Any, name: str) -> None:
    reported["scene"]["marks"] = [mark for mark in reported["scene"]["marks"] if mark["of"] != name]


UNLIKE = {
    "nothing": ("", lambda reported: None),
    "no platform": ("'platform': is not drawn", lambda reported: without(reported, "platform")),
    "no stone": ("'stone': is not drawn as it rolls", lambda reported: without(reported, "stone")),
    "a larger platform": ("moments", lambda reported: ellipsoid(reported, "platform").update(size=[1.4, 1.7, 2.2])),
    "a platform elsewhere": ("mass centre", lambda reported: ellipsoid(reported, "platform").update(at=[0, 0, 0.4])),
    "another stone": (
        "'stone': is not as large as it rolls",
        lambda reported: ellipsoid(reported, "stone").update(size=[2, 0.2, 0.3]),
    ),
}


@pytest.mark.slow
@pytest.mark.parametrize("change", UNLIKE)
def test_a_body_without_lengths_is_an_ellipsoid_of_its_moments_or_as_it_rolls(change: str):
    """A = m (b^2 + c^2)/5 about its mass centre; |(r - c)/h| = 1"""
    said, how = UNLIKE[change]
    found = wrong_page(how, GYROSTAT)
    assert said in found if said else not found


DISC = """
eomgen = 1
name = "A disc that rolls, and a plate in the air"
space = "plane"

[coordinates]
x = 0
y = 0.2
phi = { start = 0.3, speed = -1 }
u = 1
v = 1
psi = 0

[bodies.disc]
mass = 1
inertia = 0.02
joint = { kind = "planar", x = "x", y = "y", angle = "phi" }

[bodies.plate]
mass = 1
inertia = 0.02
points = { A = [0.3, 0], B = [0, 0.3] }
joint = { kind = "planar", x = "u", y = "v", angle = "psi" }

[constraints.floor]
kind = "rolling"
body = "disc"
radius = 0.2
line = { at = [0, 0], normal = [0, 1] }
"""


@pytest.mark.parametrize("body", ["", "disc", "plate"])
def test_what_moves_freely_in_the_plane_is_drawn(body: str):
    """|r - c| = r of a disc; a plate between its points"""
    found = wrong_page(lambda reported: without(reported, body), DISC)
    assert f"'{body}': is not drawn" in found if body else not found


@sampled(2)
@pytest.mark.slow
@pytest.mark.filterwarnings("ignore:.*reactions|.*indeterminate:RuntimeWarning")
@pytest.mark.parametrize("path", usual(MODELS, 30, 26), ids=lambda path: path.stem)
def test_pictures_of_every_model_show_what_it_says(path: Path):
    """The frames and the player of a fifth of a second; an unknown of a structure has no motion."""
    if (model := eomgen.load(path)).unknowns:
        pytest.skip("what is to be found is no number in a motion")
    followed = eomgen.simulate(model, time=0.2, samples=5, target="numpy")
    played = PlayedRun(followed, PlayerOptions())
    shown = movie_of(followed, followed.t[[0, len(followed.t) // 2, -1]], forces=True)
    checks = [*player_read_back(played, player_page_of(played)), *movie_read_back(followed, shown)]
    assert not [f"{check.name}: {check.detail}" for check in checks if check.ok is False]


@pytest.mark.slow
def test_every_shape_is_drawn_where_it_is_and_as_large():
    """The box of what is drawn of a body is the box of its places; every kind stands in a row, on a slide."""
    bodies = []
    for k, (kind, fields) in enumerate(sorted(SHAPES.items())):
        written = ", ".join(f"{key} = {json.dumps(x)}" for key, x in fields.items())
        bodies.append(f"""
            [bodies.{kind}]
            shape = {{ kind = "{kind}", {written} }}
            joint = {{ kind = "prismatic", at = [{6 * k}, 0, 0], axis = [0, 0, 1], displacement = "x" }}""")
    text = "eomgen = 1\nspace = 'space'\ncoordinates = { x = 0.2 }\n" + "".join(bodies)
    trajectory = eomgen.simulate(eomgen.loads(text), time=0.1, samples=2, target="numpy")
    shown = movie_of(trajectory, trajectory.t[:1])
    found = list(movie_read_back(trajectory, shown))
    assert found and not [check.detail for check in found if check.ok is False]


@pytest.mark.slow
def test_numbers_of_a_page_bear_their_names():
    """The state, the rates, reactions and T + V of a page's program are the run's; two names exchanged are not."""
    found = eomgen.play(MODELS[0].parent / "simple_pendulum.toml", time=0.3).played
    columns = dict(found.live.columns)
    one, other = "theta", "theta'"
    assert _named_otherwise(found, columns) == ""
    assert one in _named_otherwise(found, {**columns, one: columns[other], other: columns[one]})
    assert "no number" in _named_otherwise(found, {**columns, one: ("frame", 10_000)})
