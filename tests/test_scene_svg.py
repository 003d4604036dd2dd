"""Pictures of models as SVG without a library that draws: complete, named, harmless."""

from __future__ import annotations

import re
import xml.etree.ElementTree as ElementTree
from pathlib import Path

import numpy as np
import pytest

import eomgen
from eomgen.documents import drawing_at_rest
from eomgen.documents.drawing import PageBox
from eomgen.documents.scene_pictures import SpaceView, _pieces, flat_drawing, rest_picture
from eomgen.page.figure import model_svg, signs_of

MODELS = Path(__file__).parent.parent / "models"
SVG = "{http://www.w3.org/2000/svg}"


def drawn(text: str) -> ElementTree.Element:
    return ElementTree.fromstring(model_svg(eomgen.loads(text)))


PENDULUM = (MODELS / "double_pendulum.toml").read_text("utf-8")


def test_each_stroke_of_the_scene_is_drawn_in_the_picture():
    """As many elements of each role as the drawing has strokes of it, and each body under its name."""
    model = eomgen.loads(PENDULUM)
    strokes = drawing_at_rest(eomgen.scene_of(model)).strokes
    picture = drawn(PENDULUM)
    shapes = [each for each in picture if each.tag in (f"{SVG}path", f"{SVG}circle")]
    assert [each.get("class").split()[0] for each in shapes] == [stroke.role for stroke in strokes if stroke.path.size]
    assert {"arm1", "arm2"} <= {each.get("data-of") for each in shapes}


def test_names_stand_in_the_picture_as_formulas_have_them():
    """theta1 is an italic theta with an upright 1 below."""
    picture = drawn(PENDULUM)
    texts = {"".join(each.itertext()): each for each in picture.iter(f"{SVG}text")}
    assert {"θ1", "θ2", "l1", "l2", "arm1", "arm2"} <= texts.keys()
    letter, index = texts["θ1"]
    assert letter.get("font-style") == "italic" and index.get("font-style") is None
    assert index.get("dy") == "0.40em" and index.get("font-size") == "0.7em"


@pytest.mark.parametrize("name", ["double_pendulum", "four_bar", "delta_robot", "rolling_disc_and_bar", "a_frame"])
def test_no_name_covers_another_or_leaves_the_picture(name):
    """The boxes of the names do not meet, and the letters of each stand in its own."""
    scene = eomgen.scene_of(MODELS / f"{name}.toml")
    found = flat_drawing(scene, drawing_at_rest(scene), lambda text: 0.56 * len(text))
    boxes = [each.box for each in found.names]
    assert boxes and not any(a.meets(b) for k, a in enumerate(boxes) for b in boxes[:k])
    assert all(PageBox(0, 0, *found.size).holds(box) for box in boxes)


def test_a_name_cannot_become_markup():
    """A symbol "<script>" stays a text."""
    symbol = 'symbol = "\\\\mathrm{<b>}"'
    text = PENDULUM.replace("[parameters]", f'[parameters]\nh = {{ value = 1, unit = "m", {symbol} }}')
    assert eomgen.loads(text).parameters["h"].symbol is not None
    shown = drawn(text.replace('l1"', 'h"'))
    assert not list(shown.iter(f"{SVG}b"))
    assert "".join(sign.text for sign in signs_of("$\\mathrm{<b>}$")) == "<b>"


def test_a_picture_in_space_shows_the_faces_that_are_seen():
    """As many facets as matplotlib is given, the farthest first."""
    model = eomgen.load(MODELS / "delta_robot.toml")
    corners, _ = SpaceView(drawing_at_rest(eomgen.scene_of(model))).seen(0)
    paths = ElementTree.fromstring(model_svg(model)).findall(f"{SVG}path")
    assert len(paths) == len(corners) > 100


def test_a_line_is_broken_where_there_is_no_number():
    """nan between two pieces begins a new one."""
    points = np.array([[0, 0], [1, 0], [np.nan, 0], [2, 0], [3, 1]], dtype=float)
    assert [piece.tolist() for piece in _pieces(points)] == [[[0, 0], [1, 0]], [[2, 0], [3, 1]]]


def test_both_drawers_agree_on_what_a_stroke_looks_like():
    """The colours of the bodies in the file that matplotlib writes are those of this picture."""
    picture = rest_picture(eomgen.loads(PENDULUM))
    assert picture.size[0] > 0
    colors = set(re.findall(r'stroke="(#[0-9a-f]{6})"', model_svg(eomgen.loads(PENDULUM))))
    assert {"#2f5d8a", "#6a6a6a"} <= colors
