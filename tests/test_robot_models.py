"""Robot files of several models, of masses by density, of rotors behind gears, of numbers beyond all bounds."""

from __future__ import annotations

import json
from typing import Any

import numpy as np
import pytest
from click.testing import CliRunner

from eomgen.cli import main
from eomgen.errors import ModelError, UsageError
from eomgen.robots.importing import imported
from tests.test_robots import dynamics

MASS = "<inertial><mass>2</mass><inertia><ixx>.1</ixx><iyy>.2</iyy><izz>.25</izz></inertia></inertial>"
PENDULUM = f"""<model name="pendulum"><link name="bob"><pose>0 0 -1 0 0 0</pose>{MASS}</link>
<joint name="hinge" type="revolute"><parent>world</parent><child>bob</child><pose>0 0 1 0 0 0</pose>
<axis><xyz>1 0 0</xyz></axis></joint></model>"""
GROUND = '<model name="ground"><static>true</static><link name="plane"/></model>'
SLIDER = f"""<model name="slider"><link name="block">{MASS}</link><joint name="rail" type="prismatic">
<parent>world</parent><child>block</child><axis><xyz>1 0 0</xyz></axis></joint></model>"""


def robot(folder: Any, text: str, ending: str = "sdf", **options: Any) -> Any:
    path = folder / f"robot.{ending}"
    path.write_text(text)
    return imported(path, **options)


def sdf(*models: str, version: str = "1.11", world: bool = True) -> str:
    inner = "".join(models)
    whole = f'<world name="w">{inner}</world>' if world else inner
    return f'<sdf version="{version}">{whole}</sdf>'


def reported(found: Any) -> dict[str, tuple[str, ...]]:
    return {each.what: each.where for each in found.left_out}


# -- several models ------------------------------------------------------------------------------------------------


def test_of_several_models_the_first_that_moves_or_the_named_one_comes(tmp_path):
    """The others are listed by their names, with the way to get them."""
    world = sdf("<include><uri>model://sun</uri></include>", GROUND, PENDULUM, SLIDER)
    first = robot(tmp_path, world)
    assert first.model.name == "pendulum" and list(first.model.coordinates) == ["hinge"]
    assert reported(first)["model"] == ("sun", "ground", "slider")
    entry = next(each for each in first.left_out if each.what == "model")
    assert entry.as_dict()["nearest"] == "eomgen import FILE --model NAME" and "nearest: eomgen import" in str(entry)
    for name, coordinates in (("slider", ["rail"]), ("ground", [])):
        found = robot(tmp_path, world, model=name)
        assert found.model.name == name and list(found.model.coordinates) == coordinates
        assert name not in reported(found)["model"] and len(reported(found)["model"]) == 3
    with pytest.raises(ModelError, match=r"no model is called 'slide'\nfix: did you mean 'slider'"):
        robot(tmp_path, world, model="slide")
    with pytest.raises(UsageError, match="only SDF files"):
        robot(tmp_path, '<robot name="r"><link name="a"/></robot>', "urdf", model="r")
    still = robot(tmp_path, sdf(GROUND, GROUND.replace("ground", "wall")))
    assert still.model.name == "ground" and reported(still)["model"] == ("wall",)
    path = tmp_path / "robot.sdf"
    path.write_text(world)
    requested = CliRunner().invoke(main, ["import", str(path), "--model", "slider", "--json"])
    listed = {each["what"]: each for each in json.loads(requested.stdout)["left_out"]}
    assert requested.exit_code == 0 and listed["model"]["where"] == ["sun", "ground", "pendulum"]
    assert all(set(each) == {"what", "where", "why", "nearest"} for each in listed.values())


def test_a_world_s_include_is_found_by_its_file_s_model_too(tmp_path):
    """--model of an <include>: by its <name>, or by the name in the file that it includes."""
    (tmp_path / "slider.sdf").write_text(sdf(SLIDER, world=False))
    world = sdf(PENDULUM, "<include><uri>model://slider.sdf</uri></include>")
    assert list(robot(tmp_path, world, model="slider").model.coordinates) == ["rail"]
    named = world.replace("</uri>", "</uri><name>other</name>")
    assert robot(tmp_path, named, model="other").model.name == "other"
    alone = sdf(GROUND, "<include><uri>model://slider.sdf</uri></include>")
    assert list(robot(tmp_path, alone).model.coordinates) == ["rail"]


# -- models within models ------------------------------------------------------------------------------------------

FLAT = f"""<model name="r"><link name="base">{MASS}</link>
<link name="arm_up"><pose>1 2 3.5 0 0 1.5707963267948966</pose>{MASS}</link>
<link name="arm_fore"><pose>0.6 2 4 0 0 1.5707963267948966</pose>{MASS}</link>
<joint name="fix" type="fixed"><parent>world</parent><child>base</child></joint>
<joint name="root" type="revolute"><parent>base</parent><child>arm_up</child><axis><xyz>0 1 0</xyz></axis></joint>
<joint name="arm_elbow" type="revolute"><parent>arm_up</parent><child>arm_fore</child>
<axis><xyz>1 0 0</xyz></axis></joint>
<joint name="arm_hand" type="prismatic"><parent>arm_fore</parent><child>arm_tool</child>
<axis><xyz>0 0 1</xyz><mimic joint="arm_elbow"><multiplier>2</multiplier></mimic></axis></joint>
<link name="arm_tool"><pose relative_to="arm_fore">0 0 .2 0 0 0</pose>{MASS}</link></model>"""
ARM = f"""<link name="up"><pose>0 0 .5 0 0 0</pose>{MASS}</link>
<link name="fore"><pose relative_to="up">0 0.4 0.5 0 0 0</pose>{MASS}</link>
<joint name="elbow" type="revolute"><parent>up</parent><child>fore</child><axis><xyz>1 0 0</xyz></axis></joint>
<link name="tool"><pose relative_to="fore">0 0 .2 0 0 0</pose>{MASS}</link>
<joint name="hand" type="prismatic"><parent>fore</parent><child>tool</child><axis><xyz>0 0 1</xyz>
<mimic joint="elbow"><multiplier>2</multiplier></mimic></axis></joint>"""
ROOT = f"""<model name="r"><link name="base">{MASS}</link>{{arm}}
<joint name="fix" type="fixed"><parent>world</parent><child>base</child></joint>
<joint name="root" type="revolute"><parent>base</parent><child>{{end}}</child><axis><xyz>0 1 0</xyz></axis></joint>
</model>"""
POSE = "<pose>1 2 3 0 0 1.5707963267948966</pose>"
WAYS = {
    "named by its link": (f'<model name="arm">{POSE}{ARM}</model>', "arm::up"),
    "named by its model": (f'<model name="arm">{POSE}{ARM}</model>', "arm"),
    "named by a frame of it": (f'<model name="arm">{POSE}{ARM}<frame name="f" attached_to="up"/></model>', "arm::f"),
    "placed by another frame": (
        f'<model name="arm" placement_frame="up"><pose>1 2 3.5 0 0 1.5707963267948966</pose>{ARM}</model>',
        "arm::up",
    ),
    "included": (f"<include><uri>model://arm.sdf</uri><name>arm</name>{POSE}</include>", "arm::up"),
    "placed by a frame of the whole": (
        f'<frame name="at"><pose>1 2 0 0 0 1.5707963267948966</pose></frame>'
        f'<model name="arm"><pose relative_to="at">0 0 3 0 0 0</pose>{ARM}</model>',
        "arm::up",
    ),
}


def at_a_state(model: Any) -> Any:
    """(M, c - Q) in numbers at one state of coordinates of these names."""
    names = sorted(model.coordinates)
    q = {name: 0.3 + 0.2 * k for k, name in enumerate(names)}
    return dynamics(model, q, {f"{name}'": 0.5 - 0.3 * k for k, name in enumerate(names)})


def same_motion(one: Any, other: Any) -> bool:
    return all(np.allclose(x, y, rtol=0, atol=1e-12) for x, y in zip(at_a_state(one), at_a_state(other), strict=True))


@pytest.mark.parametrize("way", WAYS)
def test_a_model_within_a_model_is_as_if_its_links_stood_in_the_whole(way, tmp_path):
    """M and c - Q of nested models are those of the flat file; joints may end in `arm::up`, `arm`, `arm::frame`."""
    arm, end = WAYS[way]
    (tmp_path / "arm.sdf").write_text(sdf(f'<model name="x">{ARM}</model>', world=False))
    found = robot(tmp_path, sdf(ROOT.format(arm=arm, end=end), world=False))
    assert set(found.model.coordinates) == {"root", "arm_elbow", "arm_hand"} and not reported(found)
    assert found.model.constraints["mimic_arm_hand"].gap.text == "arm_hand - 2*arm_elbow"
    flat = FLAT
    if end == "arm":  # where a joint ends in a frame, it sits in the frame
        flat = FLAT.replace("<child>arm_up</child>", "<child>arm_up</child><pose>0 0 -.5 0 0 0</pose>")
    assert same_motion(found.model, robot(tmp_path, sdf(flat, world=False)).model)
    assert found.model.bodies["arm_up"].about == "link arm::up"


@pytest.mark.slow
def test_models_three_deep_and_merged_ones_with_a_pose_stand_where_they_are_put(tmp_path):
    """`a::b::link`, poses one after the other; <include merge="true"> with a <pose> moves what it merges."""
    deep = f"""<model name="r"><model name="a"><pose>0 0 1 0 0 0</pose><model name="b"><pose>1 0 0 0 0 0</pose>
    <link name="l"><pose>0 .5 0 0 0 0</pose>{MASS}</link></model></model>
    <joint name="j" type="revolute"><parent>world</parent><child>a::b::l</child><axis><xyz>1 0 0</xyz></axis></joint>
    </model>"""
    found = robot(tmp_path, sdf(deep, world=False)).model
    assert [x.text for x in found.bodies["a_b_l"].joint.at] == ["1", "0.5", "1"]
    (tmp_path / "arm.sdf").write_text(sdf(f'<model name="x">{ARM}</model>', world=False))
    merged = f'<include merge="true"><uri>arm.sdf</uri>{POSE}</include>'
    found = robot(tmp_path, sdf(ROOT.format(arm=merged, end="up"), world=False))
    assert [*found.model.bodies] == ["base", "up", "fore", "tool"]
    flat = robot(tmp_path, sdf(FLAT.replace("arm_", ""), world=False))
    assert same_motion(found.model, flat.model)


def test_a_model_whose_file_is_not_there_is_told_and_a_joint_to_it_refused(tmp_path):
    """The include by its name in `left_out`; a joint to a link that is not there names it."""
    text = PENDULUM.replace("<link", "<include><uri>model://hand</uri></include><link", 1)
    found = robot(tmp_path, sdf(text, world=False))
    assert reported(found)["include"] == ("include model://hand",) and list(found.model.coordinates) == ["hinge"]
    with pytest.raises(ModelError, match="names a link that there is not: 'hand::l'"):
        robot(tmp_path, sdf(text.replace("<child>bob", "<child>hand::l"), world=False))


# -- masses by density ---------------------------------------------------------------------------------------------

N = 60
SOLIDS = {  # the size, and whether a place (in halves of the box round it) is inside
    "box": ("<size>.4 .6 1</size>", (0.4, 0.6, 1), lambda x, y, z: x == x),
    "sphere": ("<radius>.3</radius>", (0.6, 0.6, 0.6), lambda x, y, z: x**2 + y**2 + z**2 < 0.09),
    "cylinder": ("<radius>.3</radius><length>1</length>", (0.6, 0.6, 1), lambda x, y, z: x**2 + y**2 < 0.09),
    "ellipsoid": (
        "<radii>.2 .3 .5</radii>",
        (0.4, 0.6, 1),
        lambda x, y, z: (x / 0.2) ** 2 + (y / 0.3) ** 2 + (z / 0.5) ** 2 < 1,
    ),
    "capsule": (
        "<radius>.3</radius><length>.4</length>",
        (0.6, 0.6, 1),
        lambda x, y, z: x**2 + y**2 + np.maximum(abs(z) - 0.2, 0) ** 2 < 0.09,
    ),
    "cone": (
        "<radius>.3</radius><length>1</length>",
        (0.6, 0.6, 1),
        lambda x, y, z: x**2 + y**2 < (0.3 * (0.5 - z)) ** 2,
    ),
}


def by_cubes(sizes: Any, inside: Any, density: float) -> tuple[float, np.ndarray, np.ndarray]:
    """Mass, centre, inertia about the centre of what fills a box, by N^3 small cubes."""
    axes = [(np.arange(N) + 0.5) / N * s - s / 2 for s in sizes]
    places = np.stack(np.meshgrid(*axes, indexing="ij"), axis=-1).reshape(-1, 3)
    kept = places[inside(*places.T)]
    each = density * np.prod(sizes) / N**3
    center = kept.mean(axis=0)
    d = kept - center
    return each * len(kept), center, each * (np.sum(d * d) * np.eye(3) - d.T @ d)


def link_of(model: Any) -> tuple[float, np.ndarray, np.ndarray]:
    body = next(iter(model.bodies.values()))
    number = [float(x.text) for x in body.inertia]
    xx, yy, zz, xy, yz, zx = [*number, 0, 0, 0][:6]
    center = [0, 0, 0] if body.center is None else [float(x.text) for x in body.center]
    return float(body.mass.text), np.array(center), np.array([[xx, xy, zx], [xy, yy, yz], [zx, yz, zz]])


def auto(collisions: str, given: str = "") -> str:
    return sdf(
        f'<model name="m"><link name="l"><inertial auto="true">{given}</inertial>{collisions}</link></model>',
        world=False,
    )


def collision(shape: str, more: str = "") -> str:
    return f'<collision name="c">{more}<geometry>{shape}</geometry></collision>'


@pytest.mark.parametrize("kind", SOLIDS)
def test_a_mass_by_density_is_that_of_the_space_that_a_shape_fills(kind, tmp_path):
    """m = rho V, the centre and I = rho int (r^2 1 - r r^T) dV, by small cubes, to 1 %."""
    size, sizes, inside = SOLIDS[kind]
    found = robot(tmp_path, auto(collision(f"<{kind}>{size}</{kind}>"), "<density>500</density>")).model
    mass, center, I = link_of(found)
    m, c, J = by_cubes(sizes, inside, 500)
    assert mass == pytest.approx(m, rel=0.01) and center == pytest.approx(c, abs=0.005)
    assert pytest.approx(J, abs=0.01 * J.max()) == I


def test_shapes_add_up_where_they_stand_and_a_mass_that_is_given_scales_them(tmp_path):
    """A dumbbell of two boxes along y, one denser, one turned: m, centre and I by hand; density of water by default."""
    box = "<box><size>.1 .2 .3</size></box>"
    two = collision(box, "<density>500</density>") + collision(
        box, "<pose>0 1 0 1.5707963267948966 0 0</pose>"
    ).replace('"c"', '"d"')
    mass, center, I = link_of(robot(tmp_path, auto(two)).model)
    assert mass == 9 and center == pytest.approx([0, 2 / 3, 0])  # 3 kg at 0, 6 kg (of water) at 1
    xx = 3 * (0.04 + 0.09) / 12 + 6 * (0.04 + 0.09) / 12 + 2
    yy, zz = 3 * 0.1 / 12 + 6 * 0.05 / 12, 3 * 0.05 / 12 + 6 * 0.1 / 12 + 2
    assert pytest.approx(np.diag([xx, yy, zz]), abs=1e-14) == I
    scaled = link_of(robot(tmp_path, auto(two, "<mass>18</mass>")).model)
    assert scaled[0] == 18 and pytest.approx(2 * I, rel=1e-14) == scaled[2] and scaled[1] == pytest.approx(center)


def cube_of_triangles() -> list[list[list[float]]]:
    """A cube of edge 2 with one corner in the origin, normals outward."""
    faces = [
        [(0, 0, 0), (0, 1, 0), (1, 1, 0), (1, 0, 0)],
        [(0, 0, 1), (1, 0, 1), (1, 1, 1), (0, 1, 1)],
        [(0, 0, 0), (1, 0, 0), (1, 0, 1), (0, 0, 1)],
        [(0, 1, 0), (0, 1, 1), (1, 1, 1), (1, 1, 0)],
        [(0, 0, 0), (0, 0, 1), (0, 1, 1), (0, 1, 0)],
        [(1, 0, 0), (1, 1, 0), (1, 1, 1), (1, 0, 1)],
    ]
    return [[[2.0 * x for x in face[k]] for k in three] for face in faces for three in ((0, 1, 2), (0, 2, 3))]


@pytest.mark.parametrize("form", ["binary", "text", "obj", "inward"])
def test_a_surface_in_a_file_gives_the_mass_that_it_encloses(form, tmp_path):
    """A cube of edge 2, scaled by (1, 1, 2): 2 x 2 x 4, of 16 m^3, its centre in the middle; I = m (a^2 + b^2)/12."""
    triangles = cube_of_triangles()
    if form == "obj":
        corners = sorted({tuple(x) for each in triangles for x in each})
        lines = [f"v {x} {y} {z}" for x, y, z in corners]
        lines += ["f " + " ".join(f"{corners.index(tuple(x)) + 1}//1" for x in each) for each in triangles]
        name, data = "cube.obj", "\n".join(lines).encode()
    elif form == "binary":
        rows = b"".join(np.array([[0, 0, 0], *each], dtype="<f4").tobytes() + b"\0\0" for each in triangles)
        name, data = "cube.stl", b" " * 80 + len(triangles).to_bytes(4, "little") + rows
    else:
        each = [x[::-1] if form == "inward" else x for x in triangles]
        text = "".join("facet\n" + "".join(f"vertex {a} {b} {c}\n" for a, b, c in x) + "endfacet\n" for x in each)
        name, data = "cube.stl", f"solid\n{text}endsolid".encode()
    (tmp_path / "meshes").mkdir()
    (tmp_path / "meshes" / name).write_bytes(data)
    mesh = f"<mesh><uri>model://meshes/{name}</uri><scale>1 1 2</scale></mesh>"
    mass, center, I = link_of(robot(tmp_path, auto(collision(mesh), "<density>3</density>")).model)
    assert mass == pytest.approx(48) and center == pytest.approx([1, 1, 2])
    assert pytest.approx(np.diag([48 * 20 / 12, 48 * 20 / 12, 48 * 8 / 12]), abs=1e-12) == I


@pytest.mark.parametrize(
    ("text", "what"),
    [
        (auto(""), "has no <collision> that determines its mass"),
        (auto(collision("<plane/>")), "<plane> gives no mass by its density"),
        (auto(collision("<mesh><uri>no.stl</uri></mesh>")), "no file is there for 'no.stl', which determines the mass"),
        (auto(collision("<mesh><uri>a.dae</uri></mesh>")), "a surface that is not read"),
        (auto(collision("<mesh><uri>open.stl</uri></mesh>")), "the surface is not closed"),
        (auto(collision("<sphere/>")), "<sphere> has no <radius>"),
        (auto(collision("<sphere><radius>0</radius></sphere>")), "have no mass"),
    ],
)
def test_a_mass_by_density_that_nobody_knows_is_refused(text, what, tmp_path):
    """Never made up: what is missing, where, and how to fix it."""
    (tmp_path / "a.dae").write_text("x")
    (tmp_path / "open.stl").write_text("solid\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\nendsolid")
    with pytest.raises(ModelError) as caught:
        robot(tmp_path, text)
    assert what in str(caught.value)


def test_of_a_static_model_no_mass_is_asked(tmp_path):
    """A ground plane of `auto` inertia stands in a world without a word."""
    plane = collision("<plane/>")
    ground = f'<model name="g"><static>1</static><link name="l"><inertial auto="1"/>{plane}</link></model>'
    assert robot(tmp_path, sdf(ground, PENDULUM)).model.name == "pendulum"


# -- rotors behind gears -------------------------------------------------------------------------------------------

ROTOR = "<drake:rotor_inertia{}/>", "<drake:gear_ratio{}/>"
ARM_URDF = """{before}<robot name="r" xmlns:drake="http://drake.mit.edu"><link name="base"/>
<link name="arm"><inertial><mass value="1"/><inertia ixx="1" iyy="1" izz="1" ixy="0" ixz="0" iyz="0"/></inertial></link>
<joint name="j" type="{kind}"><parent link="{parent}"/><child link="arm"/><axis xyz="0 0 1"/>
<limit lower="-1" upper="1" effort="1" velocity="1"/></joint>
<transmission name="t"><type>SimpleTransmission</type><joint name="j"/><actuator name="m">{rotor}</actuator>
</transmission></robot>"""


def urdf(kind: str = "revolute", rotor: str = "", before: str = "", parent: str = "base") -> str:
    return ARM_URDF.format(kind=kind, rotor=rotor, before=before, parent=parent)


@pytest.mark.parametrize(("kind", "M"), [("revolute", 11.0), ("prismatic", 11.0)])
def test_a_rotor_behind_a_gear_weighs_by_the_square_of_its_ratio(kind, M, tmp_path):
    """M = 1 + n^2 J = 1 + 100^2 * 1e-3 on a hinge and on a slide, of URDF and SDF; without a ratio it is 1."""
    both = '<drake:gear_ratio value="100"/><drake:rotor_inertia value="1e-3"/>'
    found = robot(tmp_path, urdf(kind, both), "urdf")
    assert dynamics(found.model, {"j": 0.2}, {"j'": 0.1})[0] == pytest.approx(M) and not reported(found)
    alone = robot(tmp_path, urdf(kind, '<drake:rotor_inertia value="2"/>'), "urdf").model
    assert dynamics(alone, {"j": 0.2}, {"j'": 0.1})[0] == pytest.approx(3)
    text = PENDULUM.replace(
        "</axis>", "</axis><drake:rotor_inertia>1e-3</drake:rotor_inertia><drake:gear_ratio>-100</drake:gear_ratio>"
    ).replace('type="revolute"', f'type="{kind}"')
    text = sdf(text, world=False).replace("<sdf", '<sdf xmlns:drake="http://drake.mit.edu"')
    with_it, without = robot(tmp_path, text), robot(tmp_path, sdf(PENDULUM.replace("revolute", kind), world=False))
    added = [dynamics(x.model, {"hinge": 0.2}, {"hinge'": 0.1})[0].item() for x in (with_it, without)]
    assert added[0] - added[1] == pytest.approx(10) and not reported(with_it)


def test_a_rotor_of_what_is_no_joint_about_one_axis_is_told(tmp_path):
    """On a floating joint, and of a joint of SDF without a motor (effort 0), which has no rotor."""
    both = '<drake:gear_ratio value="100"/><drake:rotor_inertia value="1e-3"/>'
    found = robot(tmp_path, urdf("floating", both), "urdf")
    assert {"drake:gear_ratio", "drake:rotor_inertia"} <= set(reported(found))
    assert reported(found)["drake:rotor_inertia"] == ("actuator m",)
    text = PENDULUM.replace(
        "</axis>", "<limit><effort>0</effort></limit></axis><drake:rotor_inertia>1</drake:rotor_inertia>"
    )
    text = sdf(text, world=False).replace("<sdf", '<sdf xmlns:drake="http://drake.mit.edu"')
    assert "drake:rotor_inertia" in reported(robot(tmp_path, text))


# -- how files begin and end ---------------------------------------------------------------------------------------


@pytest.mark.parametrize("before", ["\n", "\n \n", "\ufeff\n", "  "])
def test_blank_lines_before_the_head_of_a_file_are_passed_by(before, tmp_path):
    """The same model; an error is told at the line of the file."""
    head = f'{before}<?xml version="1.0" encoding="utf-8"?>\n'
    plain = robot(tmp_path, urdf(), "urdf").model
    assert robot(tmp_path, urdf(before=head), "urdf").model.bodies == plain.bodies
    line = head.count("\n") + 3
    with pytest.raises(ModelError, match=rf"robot\.urdf:{line}:\d+: joint 'j' names a link that there is not"):
        robot(tmp_path, urdf(before=head, parent="bas"), "urdf")


def test_the_world_as_a_parent_is_the_ground_though_no_link_is_called_so(tmp_path):
    """parent link="world" without <link name="world">: the joint stands in the ground, and is not made free."""
    for floating in (False, True):
        model = robot(
            tmp_path, urdf(parent="world").replace('<link name="base"/>', ""), "urdf", floating=floating
        ).model
        assert list(model.bodies) == ["arm"] and model.bodies["arm"].joint.parent is None
        assert model.bodies["arm"].joint.kind == "revolute"


@pytest.mark.parametrize("number", ["1e999999999", "-1e999999999", "1e-999999999", "1" * 400, "1e400"])
def test_a_number_beyond_all_bounds_is_refused_at_its_place(number, tmp_path):
    """URDF and SDF: exit 1 and the place, no internal error, no memory."""
    text = urdf().replace('<mass value="1"', f'<mass value="{number}"')
    with pytest.raises(ModelError, match=r"robot\.urdf:2:\d+: a number beyond the range of computation in <mass>"):
        robot(tmp_path, text, "urdf")
    path = tmp_path / "robot.urdf"
    assert CliRunner().invoke(main, ["import", str(path)]).exit_code == 1
    with pytest.raises(ModelError, match="a number beyond the range of computation in <mass>"):
        robot(tmp_path, sdf(PENDULUM.replace("<mass>2<", f"<mass>{number}<")))


def test_what_changes_the_motion_is_left_out_with_its_nearest_counterpart(tmp_path):
    """`nearest` of friction and contacts is a way that a model has; of a picture it is null."""
    text = (
        urdf()
        .replace("</joint>", '<dynamics friction="-2"/></joint>', 1)
        .replace("<inertial>", "<visual/><collision/><inertial>")
    )
    entries = {each.what: each.as_dict() for each in robot(tmp_path, text, "urdf").left_out}
    assert set(entries) == {"visual", "collision", "friction"}
    assert entries["visual"]["nearest"] is None
    assert "tanh" in entries["friction"]["nearest"] and "[constraints]" in entries["collision"]["nearest"]
