"""Rare features of robot files: each means what its own program computes, or is listed among what was left out."""

from __future__ import annotations

import importlib
import math
from typing import Any

import numpy as np
import pytest

import eomgen
from eomgen.errors import DerivationError, ModelError
from eomgen.exported import urdf_of
from eomgen.robots.mjcf_acting import CompiledRobot
from eomgen.robots.tables import LegalNames
from eomgen.symbolic.numeric.evaluation import FLOAT, evaluate
from tests.helpers.tools import needs
from tests.test_robots import dynamics, robot

BODIES = """<mujoco>{top}<worldbody>
<body name="a" pos="0 0 1"><joint name="h" axis="0 1 0" ref="20"/><geom size="0.1" pos="0.3 0 0"/>
  <site name="s" pos=".1 .2 .3" euler="10 20 30"/>
  <body name="b" pos="0.5 0 0"><joint name="p" type="slide" axis="1 0 .5" ref=".1"/><geom type="box" size=".1 .2 .3"/>
  </body></body>
<body name="c" pos="1 0 1"><joint name="x" type="slide" axis="1 0 0"/><joint name="z" type="slide" axis="0 0 1"/>
  <joint name="k" axis="0 1 0"/><geom type="box" size=".1 .2 .3"/></body>
</worldbody>
<tendon><fixed name="ten"><joint joint="h" coef="2"/><joint joint="p" coef="1"/></fixed>
  <fixed name="sum"><joint joint="x" coef="1"/><joint joint="z" coef="-1"/></fixed></tendon>{rest}</mujoco>"""
COORDINATES = ["h", "p", "x", "z", "k"]
MOTORS = {
    "a gear and a gain of one number": '<general name="w" tendon="ten" gear="2" gainprm="2"/>',
    "a gain that ends in the gear": '<general name="w" tendon="ten" gear="3" gainprm="13"/>',
    "a servo by gears": '<position tendon="ten" gear="2" kp="12" kv="2"/><velocity joint="h" gear="-3" kv="3"/>',
    "a site that pushes by itself": '<general name="w" site="s" biastype="affine" biasprm="5 0 0" gear="1 2 0 0 0 1"/>',
    "no gain": '<general name="w" joint="h" gainprm="0" biastype="affine" biasprm="1 -2 -3"/>',
    "no gear": '<motor name="w" tendon="ten" gear="0"/><motor site="s" gear="0 0 0 0 0 0"/><motor joint="p"/>',
    "a group that is off": '<motor name="w" joint="h" group="1"/><motor joint="p" group="2"/>',
}


def compiled(text: str) -> tuple[Any, Any, Any]:
    """(mujoco, the compiled model, its data)."""
    mujoco: Any = importlib.import_module("mujoco")
    model = mujoco.MjModel.from_xml_string(text)
    model.opt.jacobian = 0
    return mujoco, model, mujoco.MjData(model)


def values(graph: Any, expressions: Any, q: Any, u: Any, w: float) -> np.ndarray:
    """Numbers at a state; all inputs are w."""
    s = graph.symbols
    state = dict(zip(COORDINATES, q, strict=True)) | {f"{n}'": x for n, x in zip(COORDINATES, u, strict=True)}
    known: dict[Any, Any] = {s.t: 0.0} | {x: state[x.name] for x in (*s.q, *s.u)}
    known |= {x: w for x in s.inputs.values()} | {x: 9.81 for x in s.parameters.values()}
    return np.array(evaluate(list(expressions), known, FLOAT), dtype=float)


@pytest.mark.slow
@needs(".mujoco", what="mujoco")
@pytest.mark.parametrize("name", MOTORS)
def test_what_motors_push_is_what_mujoco_computes(name, tmp_path):
    """Q - c, inputs pushing: gain and gear of a tendon's motor, laws without an input, groups that are off."""
    top = '<option actuatorgroupdisable="1"/>' if "off" in name else ""
    text = BODIES.format(top=top, rest=f"<actuator>{MOTORS[name]}</actuator>")
    found, (mujoco, model, data) = robot(tmp_path, text, "xml"), compiled(text)
    graph, rng = eomgen.derive(found.model).graph, np.random.default_rng(1)
    for _ in range(2):
        data.qpos[:], data.qvel[:], data.ctrl[:] = rng.normal(size=5), rng.normal(size=5), 0.7
        mujoco.mj_forward(model, data)
        force = values(graph, [y - x for x, y in zip(graph.c, graph.Q, strict=True)], data.qpos, data.qvel, 0.7)
        expected = data.qfrc_actuator + data.qfrc_passive - data.qfrc_bias
        assert np.allclose(force, expected, rtol=0, atol=1e-12 * np.abs(expected).max())
    reported = {each.what: each.where for each in found.left_out}
    assert ("off" in name) == ("motors that are switched off" in reported)
    assert ("no" in name.split()) == ("inputs of motors" in reported)


@pytest.mark.slow
@needs(".mujoco", what="mujoco")
@pytest.mark.parametrize(
    "constraint",
    [
        '<joint joint1="h" joint2="p" polycoef="0 1 0 0 0"/>',  # 1 rad/m
        '<joint joint1="x" joint2="z" polycoef="0.1 2 1 -1 0"/>',
        '<tendon tendon1="ten" tendon2="sum" polycoef="0 1 0.2 0 0"/><tendon tendon1="sum"/>',
        '<weld body1="b" body2="c" torquescale="0"/>',  # a point alone
    ],
)
def test_ties_of_mixed_units_are_mujoco_s_rows(constraint, tmp_path):
    """J spans the rows of MuJoCo's, and phi are their gaps where each row is of one constraint of coordinates."""
    text = BODIES.format(top="", rest=f"<equality>{constraint}</equality>")
    found, (mujoco, model, data) = robot(tmp_path, text, "xml"), compiled(text)
    graph = eomgen.derive(found.model).graph
    data.qpos[:] = np.add(model.qpos0, [0.1, 0.2, -0.3, 0.4, 0.5])
    mujoco.mj_forward(model, data)
    every = data.efc_J.reshape(-1, 5)
    of_constraints = (data.efc_type == 0) & np.any(every, axis=1)  # contacts stand there too
    rows = every[of_constraints]
    J = values(graph, [x for row in graph.J for x in row], data.qpos, np.zeros(5), 0).reshape(-1, 5)
    assert np.linalg.matrix_rank(np.vstack([J, rows]), 1e-9) == len(J) == np.linalg.matrix_rank(rows, 1e-9)
    gaps = data.efc_pos[of_constraints]
    assert "weld" in constraint or np.allclose(values(graph, graph.phi, data.qpos, np.zeros(5), 0), gaps, atol=1e-12)


@pytest.mark.slow
@needs(".mujoco", what="mujoco")
def test_what_mujoco_has_beyond_a_model_is_listed(tmp_path):
    """Ranges of forces, of joints' motors and of balls, springs that yield, servos of sites, pairs of geoms."""
    text = """<mujoco><worldbody>
      <body name="a" gravcomp="1"><joint name="h" axis="0 1 0" actuatorfrcrange="-1 1" stiffness="3" springyield="1"/>
        <geom name="g1" size="0.1" contype="0" conaffinity="0" pos="1 0 0"/><site name="s"/>
        <body name="f" gravcomp="1"><body name="q"><joint name="b" type="ball" range="0 30"/>
        <geom size=".1" pos="1 0 0"/></body></body></body><geom name="g2" type="plane" size="1 1 1"/></worldbody>
      <contact><pair geom1="g1" geom2="g2"/></contact>
      <actuator><motor name="w" joint="h" forcerange="-2 2" ctrlrange="-1 1"/><velocity name="v" site="s" kv="2"/>
      </actuator></mujoco>"""
    reported = {each.what: each.where for each in robot(tmp_path, text, "xml").left_out}
    assert reported["limits of motors"] == ("w (ctrl -1 to 1, force -2 to 2)", "all at h (-1 to 1)")
    assert reported["limits of free and ball joints"] == ("b",) and reported["motors that are no linear laws"] == ("v",)
    assert reported["springs that yield"] == ("h",)
    ratio = '<general name="n" tendon="ten" gear="2" gainprm="-1" biastype="affine" biasprm="0 1 1"/>'  # MuJoCo: nan
    found = robot(tmp_path, BODIES.format(top="", rest=f"<actuator>{ratio}</actuator>"), "xml").left_out
    assert {each.what: each.where for each in found}["motors that are no linear laws"] == ("n",)
    assert reported["pairs of geoms that touch"] == ("g2 and g1",)


@pytest.mark.slow
@needs(".mujoco", what="mujoco")
def test_a_damper_in_space_is_of_its_own_rates_whatever_else_is_called_so(tmp_path):
    """A hinge called like a coordinate or a speed of a free joint: the drag is of the free joint's."""
    text = """<mujoco><worldbody><body name="q"><joint name="fly" type="free" damping="2"/><geom size=".1"/></body>
      <body><joint name="fly_x" axis="0 1 0"/><joint name="fly_wx" axis="1 1 0"/><geom size=".2" pos=".1 .2 .3"/></body>
      </worldbody></mujoco>"""
    model = robot(tmp_path, text, "xml").model
    joint, drag, couple = model.bodies["q"].joint, model.forces["fly_drag"], model.forces["fly_damper"]
    assert [x.text for x in drag.force] == [f"-2*{x.text}'" for x in joint.position]
    assert [x.text for x in couple.couple] == [f"-2*{x}" for x in joint.omega]
    assert model.bodies["body2"].joint.angle.text == "fly_wx" and joint.omega[0] != "fly_wx"


@pytest.mark.slow
@needs(".mujoco", what="mujoco")
def test_files_of_pictures_need_not_be_there(tmp_path):
    """Textures, and meshes on bodies that say their mass; where a mesh gives the mass its file is asked for."""
    text = """<mujoco><asset><texture name="t" type="2d" file="no.png"/><material name="m" texture="t"/>
      <mesh name="n" file="no.stl"/></asset><worldbody><body><joint/>{inertial}<geom name="g" type="mesh" mesh="n"/>
      <geom size=".1" material="m"/></body></worldbody></mujoco>"""
    given = '<inertial pos=".1 0 0" mass="2" diaginertia="1 1.5 1"/>'
    found = robot(tmp_path, text.format(inertial=given), "xml")
    assert found.model.bodies["body1"].mass.text == "2" and "g" in found.left_out[0].where
    with pytest.raises(ModelError, match=r"Error opening file.*no\.stl"):
        robot(tmp_path, text.format(inertial=""), "xml")


def test_what_an_older_mujoco_does_not_have_is_not_there():
    """`numbers` of a field that a compiled model lacks are none, not an error."""
    compiled_once = type("Model", (), {"dof_damping": np.array([1.0, 2.0]), "poly": np.array([[3.0, 4.0]])})()
    r = CompiledRobot(compiled_once, "r")
    assert r.numbers(["dof_damping", "springyield"], 1) == [2.0] and r.numbers(["poly"], 0) == [3.0, 4.0]
    assert r.numbers(["springyield"], slice(0, 2)) == [] and isinstance(r.names, LegalNames)


URDF = """<robot name="r"><link name="a"/>{links}
<joint name="k" type="revolute"><parent link="a"/><child link="b"/><axis xyz="0 0 1"/>{knee}</joint>
<joint name="f" type="prismatic"><parent link="b"/><child link="c"/><axis xyz="0 0 1"/>
  <mimic joint="k" multiplier="{factor}" offset="0.2"/></joint>{more}</robot>"""
LINK = """<link name="{}"><inertial><mass value="1"/>
<inertia ixx="1" iyy="1" izz="1" ixy="0" ixz="0" iyz="0"/></inertial></link>"""


def urdf(factor: str = "1", knee: str = "", more: str = "") -> str:
    return URDF.format(links=LINK.format("b") + LINK.format("c"), factor=factor, knee=knee, more=more)


@pytest.mark.parametrize(("factor", "gap"), [("1", "f - 1*k - 0.2"), ("-1", "f + 1*k - 0.2"), ("2", "f - 2*k - 0.2")])
def test_a_slide_may_mimic_a_hinge(factor, gap, tmp_path):
    """One metre a radian is a number with a unit, and stands there."""
    model = robot(tmp_path, urdf(factor)).model
    assert model.constraints["mimic_f"].gap.text == gap and eomgen.derive(model).certify().ok


def test_no_number_and_no_joint_are_told_at_their_places(tmp_path):
    """A friction that is no number is an error; a transmission to a joint that there is not is left out by its name."""
    with pytest.raises(ModelError, match="a number is needed in 'friction' of <dynamics>"):
        robot(tmp_path, urdf(knee='<dynamics damping="1" friction="much"/>'))
    found = robot(tmp_path, urdf(more='<transmission name="t"><joint name="no"/></transmission>'))
    assert [(each.what, each.where) for each in found.left_out] == [("name of <joint>", ("joint no",))]


INERTIAL = """<inertial><pose>.1 0 .2 .1 .2 .3</pose><mass>2</mass>
<inertia><ixx>1</ixx><iyy>1.2</iyy><izz>1.1</izz></inertia></inertial>"""
SDF = """<sdf version="1.9"><model name="r" {attributes}>{pose}<link name="a">{one}</link>
<link name="b"><pose {how}>{place}</pose>{two}</link>
<frame name="F" attached_to="b"><pose>0 .1 .5 .1 .2 0</pose></frame>
<frame name="G" attached_to="a"/><joint name="w" type="fixed"><parent>world</parent><child>a</child></joint>
<joint name="k" type="revolute"><parent>{parent}</parent><child>{child}</child>{seat}
<axis><xyz>1 0 1</xyz></axis></joint>
</model></sdf>"""


def sdf_text(**given: str) -> str:
    usual = {"attributes": "", "pose": "", "one": INERTIAL, "two": INERTIAL, "how": "", "place": "0 .3 1 .2 0 .5"}
    return SDF.format(**{**usual, "parent": "a", "child": "b", "seat": "", **given})


SAME = {
    "degrees": (
        {"how": 'degrees="true"', "place": "0 .3 1 90 0 30"},
        {"place": f"0 .3 1 {np.pi / 2!r} 0 {np.pi / 6!r}"},
    ),
    "a quaternion": (
        {"how": 'rotation_format="quat_xyzw"', "place": "0 0 1 0 0 0.6 0.8"},
        {"place": f"0 0 1 0 0 {2 * math.atan2(0.6, 0.8)!r}"},
    ),
    "frames as ends": ({"parent": "G", "child": "F"}, {"seat": '<pose relative_to="F">0 0 0 0 0 0</pose>'}),
    "no <inertial>": ({"two": ""}, {"two": "<inertial/>"}),
    "a placed frame": (
        {"attributes": 'placement_frame="b"', "pose": "<pose>0 .3 1 .2 0 .5</pose>"},
        {"pose": "<pose>0 0 0 0 0 0</pose>"},
    ),
}


@pytest.mark.parametrize("name", SAME)
def test_ways_of_sdf_to_say_one_thing_give_one_model(name, tmp_path):
    """M and c - Q: poses in degrees and by quaternions, joints between frames, defaults of masses, placed models."""
    found = [robot(tmp_path, sdf_text(**given), "sdf").model for given in SAME[name]]
    (M, h), (M0, h0) = (dynamics(model, {"k": 0.4}, {"k'": 0.7}) for model in found)
    assert abs(M - M0).max() < 1e-14 * M0.max() and abs(h - h0).max() < 1e-13 * (1 + abs(h0).max())


def test_gravity_is_that_of_the_model_as_it_is_placed_and_of_the_links_that_it_acts_on(tmp_path):
    """A model on its side: g(q) about the axis of the hinge is -m g times the arm that the turned place gives."""
    side = robot(tmp_path, sdf_text(pose="<pose>1 2 3 1.5707963267948966 0 0</pose>"), "sdf").model
    upright = robot(tmp_path, sdf_text(), "sdf").model
    turned = eomgen.loads(_with_gravity(tmp_path, "0 -9.8 0"))  # Rx(pi/2)^T (0, 0, -g)
    for one, other in ((side, turned), (turned, side)):
        assert np.allclose(dynamics(one, {"k": 0.4}, {"k'": 0.7})[1], dynamics(other, {"k": 0.4}, {"k'": 0.7})[1])
    assert not np.allclose(*(dynamics(model, {"k": 0.4}, {"k'": 0})[1] for model in (side, upright)))
    light = robot(tmp_path, sdf_text(two=INERTIAL + "<gravity>false</gravity>"), "sdf").model
    assert light.forces["weight"].bodies == ("a",) and abs(dynamics(light, {"k": 0.4}, {"k'": 0})[1]).max() < 1e-15


def _with_gravity(tmp_path: Any, gravity: str) -> str:
    head, model, after = sdf_text().partition("<model")
    world = f'{head}<world name="w"><gravity>{gravity}</gravity>{model}{after}'.replace("</model>", "</model></world>")
    return str(robot(tmp_path, world, "sdf").text)


def test_a_joint_may_mimic_the_second_axis_of_another(tmp_path):
    """<mimic axis="axis2">: the coordinate of that axis."""
    text = f"""<sdf version="1.11"><model name="r"><link name="a">{INERTIAL}</link><link name="b">{INERTIAL}</link>
      <link name="c">{INERTIAL}</link><joint name="p" type="prismatic"><parent>b</parent><child>c</child><axis>
      <xyz>0 0 1</xyz><mimic joint="u" axis="axis2"><multiplier>1</multiplier></mimic></axis></joint>
      <joint name="u" type="universal"><parent>a</parent><child>b</child><axis><xyz>1 0 0</xyz></axis>
      <axis2><xyz>0 1 0</xyz></axis2></joint></model></sdf>"""
    model = robot(tmp_path, text, "sdf").model
    assert model.constraints["mimic_p"].gap.text == "p - 1*u_2" and model.bodies["b"].joint.angle.text == "u_2"


def test_export_lists_motions_that_are_given_and_refuses_a_factor_by_its_name():
    """A driven hinge is a hinge that nothing drives there; one that turns twice its coordinate is none."""
    text = """eomgen = 1
space = "space"
coordinates = { q = { motion = "0.1*t" } }
bodies.a = { mass = 1, inertia = [1, 1, 1], joint = { kind = "revolute", angle = "ANGLE" } }"""
    reported = {each.what: each.where for each in urdf_of(eomgen.loads(text.replace("ANGLE", "q - 1"))).left_out}
    assert reported["given motions"] == ("q",)
    with pytest.raises(DerivationError, match="no joint that goes 2 times its coordinate: 'q'"):
        urdf_of(eomgen.loads(text.replace("ANGLE", "2*q")))


def test_what_a_world_includes_stands_where_the_include_says(tmp_path):
    """<pose> and placement_frame of an <include> as of the model itself; a pose in a frame of the world is left out."""
    (tmp_path / "m.sdf").write_text(sdf_text(pose="<pose>9 9 9 0 0 0</pose>"))
    place = "<pose>1 2 3 0 .5 0</pose>"
    head = '<sdf version="1.9"><world name="w"><include placement_frame="b"><uri>m.sdf</uri>'
    found = robot(tmp_path, f"{head}{place}</include></world></sdf>", "sdf")
    own = robot(tmp_path, sdf_text(attributes='placement_frame="b"', pose=place), "sdf")
    assert found.model.bodies == own.model.bodies
    assert not any("placement_frame" in each.what for each in found.left_out)
    there = place.replace("<pose>", "<pose relative_to='x'>")
    other = robot(tmp_path, f"{head}{there}</include></world></sdf>", "sdf")
    assert (
        "pose (line 1)" in {each.what: each.where for each in other.left_out}["pose"]
        and other.model.bodies["a"].joint.at is None
    )
