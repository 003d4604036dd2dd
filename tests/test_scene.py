"""Scenes: what can be drawn, where mechanics has it."""

from __future__ import annotations

import json
import math
from collections.abc import Callable
from dataclasses import MISSING, fields
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure
from slow_run import beside, sampled, usual, usual_models

import eomgen
from eomgen.documents.drawing import NamesArtist, PageBox, dots_along, room_for
from eomgen.documents.figures import Picture
from eomgen.documents.scene_pictures import drawing_at_rest, rest_picture, sight
from eomgen.mechanics.dynamics.system import System
from eomgen.scene import forms, plane_strokes, space_strokes
from eomgen.scene.bodies import parameters_as_drawn
from eomgen.scene.making import scene_of_system
from eomgen.scene.scene import ROLES, Mark, Scene, frame_at, plain_number
from eomgen.scene.space_strokes import drawing_of
from eomgen.scene.strokes import PictureSizes, SceneNumbers
from eomgen.study import StateInNumbers
from eomgen.symbolic.numeric.evaluation import FLOAT, evaluate
from eomgen.symbolic.print.names import COMMANDS, SIGNS, Symbol

MODELS = Path(__file__).parent.parent / "models"
ALL = [str(path.relative_to(MODELS))[:-5] for path in sorted((*MODELS.glob("*.toml"), *MODELS.glob("seeds/*.toml")))]
SOME = ("double_pendulum", "four_bar", "puma560", "whipple_bicycle")
HOLDING = usual_models(MODELS / f"{name}.toml" for name in ALL)
REQUESTED = sorted({*SOME, *(path.relative_to(MODELS).with_suffix("").as_posix() for path in HOLDING)})


class Reader:
    """A scene as a drawer reads it: from its JSON and the numbers of one frame."""

    def __init__(self, scene: Scene, shift: float = 0.0) -> None:
        state = StateInNumbers.at_start(scene.system)
        unit = {e for four in scene.system.scope.quaternions for e in four}
        free = [node not in unit for node in scene.system.symbols.q] + [False] * len(
            scene.system.symbols.x[len(scene.system.symbols.q) :]
        )
        x = state.x + shift * np.sin(1 + np.arange(len(state.x))) * free
        self.data: dict[str, Any] = json.loads(json.dumps(scene.to_json()))
        self.state = type(state)(0.3 * shift, x, state.p)
        self.frame = frame_at(scene, self.state)
        self.plane = self.data["space"] == "plane"

    def value(self, x: Any) -> float:
        return self.frame[x[0]] if isinstance(x, list) else x

    def spot(self, at: Any) -> np.ndarray:
        return np.array([self.value(x) for x in at], dtype=float)

    def pose(self, frame: int) -> tuple[np.ndarray, np.ndarray]:
        """(R, p) in the ground."""
        entry = self.data["frames"][frame]
        size = 2 if self.plane else 3
        if entry["pose"] is None:
            return np.eye(size), np.zeros(size)
        numbers = self.spot(entry["pose"])
        if self.plane:
            x, y, c, s = numbers
            R, p = np.array([[c, -s], [s, c]]), np.array([x, y])
        else:
            R, p = numbers[3:].reshape(3, 3), numbers[:3]
        if entry["parent"] >= 0:
            above, origin = self.pose(entry["parent"])
            return above @ R, origin + above @ p
        return R, p

    def in_ground(self, mark: dict[str, Any], field: str) -> np.ndarray:
        R, p = self.pose(mark["frame"])
        return p + R @ self.spot(mark[field])


def scene_named(name: str) -> Scene:
    return eomgen.load(MODELS / f"{name}.toml").scene()


@sampled(3)
@pytest.mark.parametrize("name", [pytest.param(n, marks=() if n in SOME else pytest.mark.slow) for n in REQUESTED])
def test_a_scene_shows_bodies_where_mechanics_has_them(name):
    """R^T R = 1, det R = 1; p + R r of a body's named points, by the data, is the position that mechanics has.

    And every mark is one that drawers know.
    """
    scene = scene_named(name)
    reader, system = Reader(scene, shift=0.2), scene.system
    symbols, motion = system.symbols, system.motion
    numbers = dict(zip(symbols.x, reader.state.x, strict=True)) | {symbols.t: reader.state.t}
    numbers |= dict(zip(symbols.parameters.values(), reader.state.p, strict=True))
    place = {each["name"]: reader.spot(each["at"]) for each in reader.data["points"]}
    assert all(each["parent"] < k for k, each in enumerate(reader.data["frames"]))
    for k, (R, p) in enumerate(SceneNumbers(scene, reader.frame[None, :]).poses):  # as the drawers in Python have them
        assert np.allclose(R[0], reader.pose(k)[0]) and np.allclose(p[0], reader.pose(k)[1])
    for k, link in enumerate(motion.links, start=1):
        R, p = reader.pose(k)
        assert np.allclose(R.T @ R, np.eye(len(R))) and math.isclose(np.linalg.det(R), 1)
        for point, r in motion.points[link.name].items():
            own = np.array(evaluate(r, numbers, FLOAT))[: len(R)]
            if f"{link.name}.{point}" in place:
                assert np.allclose(p + R @ own, place[f"{link.name}.{point}"]), point
    refuse_what_drawers_do_not_know(reader, scene)


def refuse_what_drawers_do_not_know(reader: Reader, scene: Scene) -> None:
    """Kinds of `forms.ALL`, roles of `ROLES`, frames that are there, one slot a value, symbols that are given."""
    kinds = {form.kind: form for form in forms.ALL}
    assert len(kinds) == len(forms.ALL) and reader.data["slots"] == len(scene.values) == len(reader.frame)
    order = [ROLES.index(mark["role"]) for mark in reader.data["marks"]]
    assert order == sorted(order)
    for mark in reader.data["marks"]:
        assert mark["frame"] < len(reader.data["frames"])
        assert set(mark) == {"kind", "frame", "role", "of", *(f.name for f in fields(kinds[mark["kind"]]))}
        if mark["kind"] == "symbol":
            assert mark["symbol"] in reader.data["symbols"]


@pytest.mark.parametrize("name", ("double_pendulum", "four_bar", "slider_crank", "arm3", "chain20", "spatial_four_bar"))
def test_the_symbol_of_a_joint_is_where_both_bodies_have_it(name):
    """p_A + R_A (the joint's place in the parent) = p_B + R_B (its place in the child), wherever it is drawn."""
    scene = scene_named(name)
    reader, motion = Reader(scene), scene.system.motion
    joints = [m for m in reader.data["marks"] if m["kind"] == "symbol" and m["of"] in motion.index]
    assert joints
    symbols = scene.system.symbols
    numbers = dict(zip(symbols.x, reader.state.x, strict=True)) | {symbols.t: 0.0}
    numbers |= dict(zip(symbols.parameters.values(), reader.state.p, strict=True))
    for mark in joints:
        link = motion.link(mark["of"])
        R, p = reader.pose(motion.index[link.name] + 1)
        own = np.array(evaluate(link.point, numbers, FLOAT))[: len(R)]
        assert np.allclose(reader.in_ground(mark, "at"), p + R @ own)


def test_the_ends_of_a_double_pendulum_are_where_trigonometry_puts_them():
    """x_1 = l1 sin th1, y_1 = -l1 cos th1; the tip adds l2 (sin th2, -cos th2): by hand, lengths as parameters."""
    scene = scene_named("double_pendulum")
    reader, q = Reader(scene, shift=0.4), [node.name for node in scene.system.symbols.q]
    angles = dict(zip(q, reader.state.x, strict=False))
    lengths = dict(zip(scene.system.symbols.parameters, reader.state.p, strict=True))
    place = {each["name"]: reader.spot(each["at"]) for each in reader.data["points"]}
    model = scene.system.scope.model
    absolute = 0.0
    at = np.zeros(2)
    for body in ("arm1", "arm2"):
        joint = model.bodies[body].joint
        turn = joint.angle.evaluate({**angles, **lengths, "pi": math.pi})
        absolute = turn + (absolute if joint.on else 0.0)
        length = model.bodies[body].shape.length.evaluate(lengths)
        at = at + length * np.array([math.cos(absolute), math.sin(absolute)])
        assert np.allclose(place[f"{body}.end"], at)
    assert {"l1", "l2"} <= {str(name) for name in lengths}


def test_a_parameter_moves_lengths():
    """The slots of a frame are functions of the parameters: a longer arm ends elsewhere."""
    scene = scene_named("double_pendulum")
    state = StateInNumbers.at_start(scene.system)
    longer = type(state)(state.t, state.x, 2 * state.p)
    assert not np.allclose(frame_at(scene, state), frame_at(scene, longer))


def test_every_kind_has_its_drawers():
    """The tables of the plane and of space hold all of `forms.ALL`; the plane has no solids."""
    assert {form.kind for form in forms.ALL} == {form.kind for form in space_strokes.TABLE}
    in_the_plane = {form.kind for form in plane_strokes.TABLE}
    assert in_the_plane | plane_strokes.SOLIDS == {form.kind for form in forms.ALL}
    assert not in_the_plane & plane_strokes.SOLIDS


def one_of_each(kind: type[forms.Form]) -> forms.Form:
    """A form of a kind, made of constants."""
    known = {
        "text": "a",
        "symbol": "hinge",
        "unit": "N",
        "faces": ((0, 1, 2),),
        "close": "chord",
        "start": 0,
        "tier": 2,
    }
    known |= {"points": ((0, 0, 0), (1, 0, 0), (0, 1, 1)), "profile": ((0, 0), (1, 0), (1, 1)), "rims": (1,)}
    places = {"along": (0, 2, 0), "normal": (1, 0, 0), "b": (2, 1, 0), "size": (1, 2, 3), "vector": (0, 3, 1)}
    found: dict[str, Any] = {}
    for field in fields(kind):
        if field.name in known:
            found[field.name] = known[field.name]
        elif field.name in kind.spots:
            found[field.name] = places.get(field.name, (0, 1, 0))
        elif field.default is MISSING:
            found[field.name] = places["vector"] if field.name == "vector" else 1
    if kind.kind == "prism":
        found["points"], found["high"] = ((0, 0), (1, 0), (0, 1)), 2
    return kind(**found)


@pytest.mark.parametrize("kind", forms.ALL, ids=lambda form: form.kind)
@pytest.mark.parametrize("space", ("plane", "space"))
def test_each_kind_is_drawn_by_each_drawer(kind, space):
    """A form alone gives strokes or letters with finite places, and they move with its frame: R r + p."""
    table = plane_strokes.TABLE if space == "plane" else space_strokes.TABLE
    if kind not in table:
        return
    name = "double_pendulum" if space == "plane" else "arm3"
    scene = scene_named(name)
    numbers = SceneNumbers.at(scene, StateInNumbers.at_start(scene.system))
    d = numbers.dimension
    sizes = PictureSizes(0.1, -np.ones(d), np.ones(d), {("body", "N"): 1.0}, True)
    form = one_of_each(kind)
    at_home, moved = (table[kind](form, Mark(form, frame), numbers, sizes) for frame in (0, 2))
    places = [*(stroke.path.reshape(-1, d) for stroke in at_home[0]), *(letter.at for letter in at_home[1])]
    if kind.kind in ("dimension", "angle", "track") and space == "space":
        return
    assert places and all(np.isfinite(p).any() for p in places)
    if kind.kind in ("line", "polygon", "arc", "box", "ellipsoid", "revolution", "prism", "polyhedron", "rod", "point"):
        R, p = numbers.poses[2]
        for one, other in zip(at_home[0], moved[0], strict=True):
            assert np.allclose(one.path.reshape(-1, d) @ R[0].T + p[0], other.path.reshape(-1, d), equal_nan=True)


Areas = list[tuple[str, tuple[PageBox, ...]]]
"""Every name of a picture, and where it stands."""


def areas_of(fill: Callable[[Figure], None], size: tuple[float, float]) -> list[Areas]:
    """Of each panel of a picture that names what it shows; none leaves the picture."""
    figure = Figure(figsize=size, layout="constrained")
    FigureCanvasAgg(figure)
    fill(figure)
    figure.draw_without_rendering()
    panels = figure.axes
    named = [[artist for artist in panel.get_children() if isinstance(artist, NamesArtist)] for panel in panels]
    for panel, artists in zip(panels, named, strict=True):
        assert not artists or not any(text.get_text() for text in panel.texts), "what is written without a look"
    found = [artists[0].areas for artists in named if artists]
    page = PageBox(*figure.bbox.extents)
    assert all(page.holds(box) for areas in found for _, boxes in areas for box in boxes)
    return found


def covering(areas: Areas) -> list[tuple[str, str]]:
    """The pairs of names of which one covers the other."""
    pairs = ((one, other) for k, one in enumerate(areas) for other in areas[:k])
    return [(a, b) for (a, p), (b, q) in pairs if any(box.meets(there) for box in p for there in q)]


def test_a_name_finds_its_place_inside_the_picture_or_none():
    """At a corner it goes inwards; where the picture is smaller than the name it is left out; it is not nearer to the
    place of another name than to its own."""
    page, none = PageBox(0, 0, 100, 100), np.zeros((0, 2))
    for at in ((0.0, 0.0), (100.0, 0.0), (0.0, 100.0), (99.0, 50.0)):
        box = room_for(at, (40, 10), (), none, (page, page), 1.0)
        assert box is not None and page.holds(box)
    crowd = np.stack(np.meshgrid(np.arange(100.0), np.arange(100.0)), -1).reshape(-1, 2)
    assert room_for((50, 99), (40, 10), (), crowd, (page, page), 1.0) is not None
    assert room_for((50, 50), (140, 10), (), none, (page, page), 1.0) is None
    own, other = np.array([[50.0, 50.0]]), np.array([[50.0, 62.0]])
    alone, beside = (room_for((50, 50), (20, 8), (), none, (page, page), 1.0, others=x) for x in (none, other))
    assert alone is not None and beside is not None
    assert alone.away(other) < alone.away(own) and beside.away(own) < beside.away(other)


@sampled(3)
@pytest.mark.parametrize("name", [pytest.param(n, marks=() if n in SOME else pytest.mark.slow) for n in REQUESTED])
def test_names_do_not_cover_one_another(name):
    """Of the boxes of all names in a model's picture no two meet, none leaves the picture, and there are names."""
    picture = rest_picture(eomgen.load(MODELS / f"{name}.toml"))
    (areas,) = areas_of(picture.fill, (6, 5))
    assert areas and covering(areas) == []


RESULTS = {
    "statics": "a_frame bolt_cutter fink_truss gerber_beam gerber_frame k_truss strut_frame three_hinged_arch".split(),
    "kinematics": "four_bar quick_return slider_crank seeds/ch11_p4".split(),
    "inertia": "atwood chain20 double_pendulum seeds/ch13_p2".split(),
}


@sampled(2)
@pytest.mark.slow
@pytest.mark.parametrize(
    ("verb", "name"), usual([(verb, name) for verb, names in RESULTS.items() for name in names], 2)
)
def test_names_of_a_result_do_not_cover_one_another(verb, name):
    """Forces of members along them, reactions, centres of rotation, axes: no two meet either."""
    picture = getattr(eomgen, verb)(MODELS / f"{name}.toml").picture
    panels = areas_of(picture.fill, picture.size)
    assert panels[0] and not any(map(covering, panels))


LINED = (
    "a_frame andrews_squeezer atwood bolt_cutter car_axis cart_pole double_atwood epicyclic_gear flyball_governor "
    "four_bar heavy_top quick_return scotch_yoke slider_crank snakeboard stewart_platform tower_crane whipple_bicycle "
    "seeds/ch9_p7 seeds/ch22_p4"
).split()


def lined(picture: Picture) -> list[str]:
    """The names of a picture in its own size that lie over a line of what is drawn, but for the one along which they
    are written; a point at the rim of a name counts for nothing."""
    figure = Figure(figsize=picture.size, layout="constrained")
    FigureCanvasAgg(figure)
    picture.fill(figure)
    figure.draw_without_rendering()
    found, point = [], figure.dpi / 72
    for panel in figure.axes:
        for artist in (artist for artist in panel.get_children() if isinstance(artist, NamesArtist)):
            page = panel.transData.transform
            dots = dots_along([page(line) for line in artist.lines], point)
            areas = iter(artist.areas)
            for (text, boxes), name in ((next(areas), name) for name in artist.names):
                assert text == name.text, "every name has room"
                seen = dots
                if name.along is not None:
                    start, end = page(np.array([name.at, name.along]))
                    (x, y), (u, v) = (end - start) / np.hypot(*(end - start)), (dots - start).T
                    seen = dots[abs(x * v - y * u) > point]
                found += [text] if any(box.grown(-point).covered(seen) for box in boxes) else []
    return found


@pytest.mark.slow
@pytest.mark.parametrize("name", [*usual(LINED, 3), *beside(*(name for name in ALL if name not in LINED))])
def test_names_cover_no_line(name):
    """Of no picture a name lies over an edge, a spring, a dimension line or an arrow; all names are there."""
    assert lined(rest_picture(eomgen.load(MODELS / f"{name}.toml"))) == []


LOADED = [
    *(
        ("statics", name)
        for name in ("fink_truss", "gerber_frame", "k_truss", "three_hinged_arch", "tripod", "trapdoor")
    ),
    ("kinematics", "quick_return"),
]


@pytest.mark.slow
@pytest.mark.parametrize(("verb", "name"), usual(LOADED, 2))
def test_names_of_a_result_cover_no_line(verb, name):
    """Values beside bars, loads and reactions cover no bar but their own and no arrow, of a truss, a frame, an arch."""
    assert lined(getattr(eomgen, verb)(MODELS / f"{name}.toml").picture) == []


def test_no_ellipsoid_of_inertia_hides_what_shows_its_body():
    """Arms and wheels are drawn without it, a satellite by it; one plane is drawn once, whoever rolls on it."""
    kinds = {"arm3": set(), "robot_with_trailer": set(), "whipple_bicycle": set(), "satellite_wheels": {"satellite"}}
    for name, veiled in kinds.items():
        marks = eomgen.load(MODELS / f"{name}.toml").scene().marks
        assert {mark.of for mark in marks if mark.role == "inertia"} == veiled
        tracks = [(mark.form, mark.frame) for mark in marks if mark.role == "track"]
        assert len(tracks) == len(set(tracks))


def test_of_a_long_chain_no_lengths_are_written():
    """Twenty rods have no room for twenty dimension lines and arcs; a four-bar has them all."""
    for name, kinds in (("chain20", set()), ("four_bar", {"dimension", "angle"})):
        marks = eomgen.load(MODELS / f"{name}.toml").scene().marks
        assert {mark.form.kind for mark in marks if mark.role == "dimension"} == kinds


def test_a_way_along_a_curve_has_no_dimension_line():
    """A straight line from the beginning of a path to the bead is shorter than the way that its name says."""
    marks = eomgen.load(MODELS / "loop_the_loop.toml").scene().marks
    assert "s" not in {mark.of for mark in marks if mark.role == "dimension"}


def test_a_long_name_stays_in_its_picture():
    """The title of a narrow picture goes on in a second line."""
    found: list[bool] = []
    named = Picture((3.4, 4.2), lambda figure: figure.subplots(), "Load over a disc, two loads over a heavy pulley")

    def look(figure):
        figure.draw_without_rendering()
        title = figure.texts[0] if figure.texts else figure._suptitle
        found.append(title.get_window_extent().x1 <= figure.bbox.x1)

    named._drawn(look)
    assert found == [True]


def test_every_symbol_that_can_be_declared_can_be_drawn():
    """matplotlib's mathematics knows each sign, accent and style of the grammar of symbols."""
    from matplotlib.mathtext import MathTextParser

    parser = MathTextParser("agg")
    for command in COMMANDS:
        text = command if command in SIGNS else rf"{command}{{x}}"
        assert parser.parse(f"${Symbol.parsed(text).tex}$").width > 0


def test_a_picture_has_the_symbols_that_a_model_declares():
    """A coordinate, a length, a body: by what stands in `symbol`, not by their names."""
    text = (MODELS / "simple_pendulum.toml").read_text()
    model = eomgen.loads(text)
    before = {name for name, _ in areas_of(rest_picture(model).fill, (6, 5))[0]}
    assert r"$\theta$" in before
    declared = text.replace("theta = { start", "theta = { symbol = '\\hat\\varphi', start")
    assert declared != text
    after = {name for name, _ in areas_of(rest_picture(eomgen.loads(declared)).fill, (6, 5))[0]}
    assert r"$\theta$" not in after and any("varphi" in name for name in after)


def test_a_scene_leaves_the_interpreter_as_it_was():
    """b"\\0" is zero: a number made of one character of text would have been written over it."""
    scene_named("double_pendulum")
    assert bytes([0])[0] == 0


def test_a_ring_lies_in_the_plane_of_its_hinges_and_a_rotor_turns_about_its_axis():
    """Gimbals have no lengths: of outer about x, inner about y, rotor about z the axes of the symbols are z, x, z."""
    scene = eomgen.load(MODELS / "gimbal_gyroscope.toml").scene()
    found = {
        mark.of: (mark.form.symbol, [abs(float(plain_number(x))) for x in mark.form.along])
        for mark in scene.marks_of_kind("symbol")
        if not mark.form.symbol.endswith("pins")
    }
    assert found == {"outer": ("outer_ring", [0, 0, 1]), "inner": ("ring", [1, 0, 0]), "rotor": ("rotor", [0, 0, 1])}


@pytest.mark.parametrize("gravity", [(0, 0, -1), (0, -2, 0), (0, 0, 3), (-1, 0, 0), (1, 2, 2)])
def test_what_falls_in_space_falls_down_the_page(gravity):
    """The view is a rotation that takes -g to the page's up, whatever axis that is."""
    g = np.array(gravity, float)
    up = -g / np.linalg.norm(g)
    view = sight(up)
    assert np.allclose(view @ view.T, np.eye(3)) and np.linalg.det(view) > 0
    right, upright, _ = view @ up
    assert abs(right) < 1e-12 and upright > 0.9
    text = f"""eomgen = 1
space = "space"
[coordinates]
x = 0
[bodies.stone]
shape = {{ kind = "sphere", mass = 1, radius = 0.1 }}
joint = {{ kind = "prismatic", axis = [1, 2, 3], displacement = "x" }}
[forces.weight]
kind = "gravity"
acceleration = {list(gravity)}
"""
    scene = eomgen.loads(text).scene()
    numbers = SceneNumbers.at(scene, StateInNumbers.at_start(scene.system))
    assert np.allclose(drawing_of(numbers).sizes.up, up)


def drawn_at_start(name: str) -> tuple[Scene, SceneNumbers]:
    scene = eomgen.load(MODELS / f"{name}.toml").scene()
    return scene, SceneNumbers.at(scene, StateInNumbers.at_start(scene.system))


def test_what_is_fixed_on_a_block_leaves_it_a_block():
    """Only what slides makes a wedge: a box that stands on a block has no line along which it goes."""
    text = """
    eomgen = 1
    space = "plane"
    coordinates = { x = 0.2 }
    bodies.block = { mass = 2, joint = { kind = "prismatic", axis = [1, 0], displacement = "x" } }
    [bodies.box]
    mass = 1
    inertia = 1
    joint = { kind = "fixed", on = "block", at = [0, 1] }
    """
    assert not [mark for mark in eomgen.scene_of(eomgen.loads(text)).marks_of_kind("polygon") if mark.of == "wedge"]


def test_what_slides_down_a_block_makes_it_a_wedge():
    """The toe where the face meets the ground, the seat on the face, the back upright; no guide across the picture."""
    scene, numbers = drawn_at_start("block_on_wedge")
    (mark,) = [mark for mark in scene.marks_of_kind("polygon") if mark.of == "wedge"]
    toe, heel, top = numbers.spots(mark.form.points, mark)[0]
    assert toe[1] == pytest.approx(0) and heel[1] == pytest.approx(0) and top[0] == pytest.approx(heel[0])
    assert math.degrees(math.atan2(top[1] - toe[1], toe[0] - top[0])) == pytest.approx(30)
    seat = np.array([0.0, 1.0])
    assert np.linalg.norm(seat - toe) + np.linalg.norm(top - seat) == pytest.approx(np.linalg.norm(top - toe))
    assert [mark.of for mark in scene.marks_of_kind("track")] == ["wedge"]


def test_two_shafts_that_meet_go_apart():
    """Of a body without lengths that turns on the ground: the first against its axis, the second along it"""
    scene, numbers = drawn_at_start("cardan_shaft")
    ways = {
        mark.of: numbers.way(mark.form.along, mark)[0]
        for mark in scene.marks_of_kind("symbol")
        if mark.form.symbol == "shaft"
    }
    assert ways["driving"] == pytest.approx([-1, 0, 0])
    assert ways["driven"] == pytest.approx([math.cos(math.pi / 6), math.sin(math.pi / 6), 0])


@pytest.mark.parametrize("name", ["gimbal_gyroscope", "gyrocompass", "satellite_wheels", "epicyclic_gear"])
def test_bodies_with_one_middle_have_their_names_at_their_rims(name: str):
    """Each at a place of its own; of bodies apart the names stay at their middles"""
    _, numbers = drawn_at_start(name)
    drawing = drawing_of(numbers)
    places = {letter.of: letter.at[0] for letter in drawing.letters if letter.role == "label"}
    apart = [np.linalg.norm(a - b) for one, a in places.items() for other, b in places.items() if one < other]
    assert min(apart) > drawing.sizes.unit
    pendulum, at = drawn_at_start("double_pendulum")
    kept = {letter.of: letter.at[0] for letter in drawing_of(at).letters if letter.role == "label"}
    middles = {
        mark.of: at.spot(mark.form.at, mark)[0] for mark in pendulum.marks_of_kind("label") if mark.role == "label"
    }
    assert all(np.array_equal(kept[of], middles[of]) for of in kept)


HUNG = """
eomgen = 1
space = "plane"
parameters = { m = 2, k = 50, c = 3, g = 9.81 }
coordinates = { y = 0 }
points = { O = [0, 0] }
[bodies.load]
mass = "m"
joint = { kind = "prismatic", at = [0, -1], axis = [0, 1], displacement = "y" }
[forces]
weight = { kind = "gravity", acceleration = [0, "-g"] }
spring = { kind = "spring", points = ["O", "load.origin"], stiffness = "k", length = 0.6 }
damper = { kind = "damper", points = ["load.origin", "O"], damping = "c" }
"""


def test_what_joins_the_same_places_stands_side_by_side():
    """A spring and a damper that is named from its other end; one more; of one alone the line itself."""
    both = eomgen.loads(HUNG)
    assert _sides(both) == {"spring": -1, "damper": -1}  # the damper's line runs the other way: to its left is right
    third = HUNG + 'more = { kind = "spring", points = ["O", "load.origin"], stiffness = "k", length = 0.5 }\n'
    assert _sides(eomgen.loads(third)) == {"spring": -2, "damper": 0, "more": 2}
    assert _sides(eomgen.loads(HUNG.partition("damper =")[0])) == {"spring": 0}


def test_what_hangs_on_a_spring_has_no_guide():
    """Its way is that of its weight; without the weight, or without the spring, the guide is drawn."""
    kinds = [{mark.role for mark in eomgen.loads(text).scene().marks} for text in (
        HUNG, HUNG.replace("weight = {", "#"), HUNG.partition("spring =")[0])]  # fmt: skip
    assert ["track" in roles for roles in kinds] == [False, True, True]


def _sides(model):
    marks = model.scene().marks
    return {mark.of: mark.form.side for mark in marks if mark.role in ("spring", "damper")}


SPOOL = """
eomgen = 1
space = "plane"
parameters = { R = 0.5, r = 0.2, F = 10 }
[points]
A = [1, 3]
[coordinates]
x = 0
[bodies.spool]
SHAPE
joint = { kind = "placed", at = ["x", "R"], angle = "-x/R" }
[bodies.load]
mass = 2
joint = { kind = "placed", at = ["2 + x*(1 + r/R)", "R + r"] }
[constraints.rope]
kind = "string"
path = [{ body = "spool", radius = "r", turn = "cw" }, "load.origin"]
[forces]
push = { kind = "between", points = ["A", "load.origin"], pull = "-F" }
pulled = { kind = "between", points = ["A", "spool.origin"], pull = "F/r^2" }
"""


@pytest.mark.parametrize(
    ("shape", "rims"),
    [
        ("mass = 3\ninertia = 1", {("chord", 0.2)}),
        ('shape = { kind = "disc", mass = 3, radius = "R" }', {("none", 0.2)}),
        ('shape = { kind = "disc", mass = 3, radius = "r" }', set()),
    ],
    ids=["drum", "hub", "shown"],
)
def test_a_drum_or_hub_is_drawn_where_no_shape_shows_it_and_turns_with_its_body(shape, rims):
    """A circle of the radius on which the rope lies, about the body's own centre, in its axes; a hub is no disc."""
    system = System.of(eomgen.loads(SPOOL.replace("SHAPE", shape)))
    known = parameters_as_drawn(system)
    arcs = [m for m in scene_of_system(system).marks if m.role == "rim" and m.form.kind == "arc"]
    found = {(m.form.close, float(evaluate((m.form.radius,), known, FLOAT)[0])) for m in arcs}
    assert found == rims and {(m.of, m.frame) for m in arcs} <= {("spool", 1)}


def test_a_pull_that_is_no_law_of_the_distance_is_a_cylinder_between_its_ends():
    """Between a pin on the ground and a hinge on the body; F/r^2 is a thin line, for nothing is there."""
    system = System.of(eomgen.loads(SPOOL.replace("SHAPE", "mass = 3\ninertia = 1")))
    marks = scene_of_system(system).marks
    kinds = {
        of: [m.form.kind for m in marks if m.of == of and m.role in ("cylinder", "spring")] for of in ("push", "pulled")
    }
    assert kinds == {"push": ["cylinder"], "pulled": ["line"]}
    assert [m.form.symbol for m in marks if m.of == "push" and m.role == "support"] == ["pin", "hinge"]
    (stroke,) = (s for s in drawing_at_rest(scene_of_system(system)).strokes if s.role == "cylinder")
    assert np.allclose(stroke.path[0, [0, -1]], [[1, 3], [2, 0.7]])


BELT = """
eomgen = 1
space = "plane"
parameters = { r = 0.1, R = 0.3, a = 1 }
[coordinates]
phi = 0
psi = { dependent = true, near = 0 }
[bodies.motor]
shape = { kind = "disc", mass = 1, radius = "r" }
joint = { kind = "revolute", angle = "phi" }
[bodies.fan]
shape = { kind = "disc", mass = 4, radius = "R" }
joint = { kind = "revolute", at = ["a", 0], angle = "psi" }
[constraints.belt]
kind = "gear"
bodies = ["motor", "fan"]
ratio = "RATIO"
"""


def test_wheels_that_turn_together_apart_have_a_belt_and_others_none():
    """Two tangents of length sqrt(a^2 - (R - r)^2) and both arcs, pi + 2 arcsin((R - r)/a) and the rest of 2 pi."""
    scene = eomgen.loads(BELT.replace("RATIO", "R/r")).scene()
    strokes = [s.path[0] for s in drawing_at_rest(scene).strokes if s.role == "string"]
    lengths = sorted(float(np.sum(np.hypot(*np.diff(path, axis=0).T))) for path in strokes)
    lean = math.asin(0.2 / 1.0)
    due = [math.sqrt(1 - 0.2**2)] * 2 + [0.1 * (math.pi - 2 * lean), 0.3 * (math.pi + 2 * lean)]
    assert lengths == pytest.approx(sorted(due), rel=1e-3)
    for ratio in ("-R/r", "2"):
        assert not [mark for mark in eomgen.loads(BELT.replace("RATIO", ratio)).scene().marks if mark.role == "string"]


def test_two_strings_round_the_same_pulleys_are_one_belt():
    """Their four ends on two pulleys are joined by an arc of each; one string alone is no belt."""
    wheel = 'mass = 1\ninertia = 0.1\njoint = { kind = "revolute", at = [AT, 0], angle = "phi*K" }'
    ends = ('{ body = "small", radius = "r", turn = "cw" }', '{ body = "large", radius = "R", turn = "cw" }')
    strings = [
        f'[constraints.s{k}]\nkind = "string"\npath = [{", ".join(ends[::way])}]\n' for k, way in ((1, 1), (2, -1))
    ]
    head = 'eomgen = 1\nspace = "plane"\nparameters = { r = 0.1, R = 0.3 }\ncoordinates = { phi = 0 }\n'
    wheels = f"[bodies.small]\n{wheel.replace('AT', '0').replace('K', '1')}\n"
    wheels += f"[bodies.large]\n{wheel.replace('AT', '1').replace('K', 'r/R')}\n"
    for count, arcs in ((1, 0), (2, 2)):
        marks = eomgen.loads(head + wheels + "".join(strings[:count])).scene().marks
        assert len([mark for mark in marks if mark.role == "string" and mark.form.kind == "arc"]) == arcs


def test_a_drive_between_two_bodies_is_a_cylinder_whose_length_stays():
    """The rod comes out by what the way grows, 0.3 m; a force on the ground's guide is none."""
    text = """eomgen = 1
space = "plane"
coordinates = { alpha = 0.3, s = 1 }
[bodies.arm]
mass = 2
inertia = 0.4
center = [0.4, 0]
joint = { kind = "revolute", angle = "alpha" }
[bodies.rod]
shape = { kind = "particle", mass = 1 }
joint = { kind = "prismatic", on = "arm", axis = [1, 0], displacement = "s", force = 30 }
"""
    scene = eomgen.loads(text).scene()
    state = StateInNumbers.at_start(scene.system)
    longer = state.x + np.array([0, 0.3, 0, 0])
    frames = np.array([frame_at(scene, type(state)(0.0, x, state.p)) for x in (state.x, longer)])
    (stroke,) = (s for s in drawing_of(SceneNumbers(scene, frames)).strokes if s.role == "cylinder")
    barrels = np.linalg.norm(stroke.path[:, 4] - stroke.path[:, 3], axis=1)
    assert barrels[0] == pytest.approx(barrels[1] * 1.0, rel=1e-2) and 0.4 < barrels[0] < 0.9
    ways = np.linalg.norm(stroke.path[:, -1] - stroke.path[:, 0], axis=1)
    assert ways == pytest.approx([1.0, 1.3])
    assert not [m for m in eomgen.load(MODELS / "cart_pole.toml").scene().marks if m.role == "cylinder"]


def test_what_turns_on_a_hinge_without_a_length_is_a_wheel():
    """A flywheel of which one knows the inertia alone; not a drum, whose rim is known."""
    text = """eomgen = 1
space = "plane"
parameters = { r = 0.2 }
coordinates = { phi = 0 }
bodies.wheel = { mass = 2, inertia = 0.1, joint = { kind = "revolute", angle = "phi" } }
"""
    rope = """[bodies.load]
mass = 1
joint = { kind = "placed", at = ["r", "-1 + r*phi"] }
[constraints.rope]
kind = "string"
path = [{ body = "wheel", radius = "r", turn = "cw" }, "load.origin"]
"""
    for more, symbols in (("", ["rotor"]), (rope, [])):
        marks = eomgen.loads(text + more).scene().marks
        assert [
            m.form.symbol for m in marks if m.of == "wheel" and m.role == "body" and m.form.kind == "symbol"
        ] == symbols
