"""Robot files of other programs: what they mean, what they lack, what is left out."""

from __future__ import annotations

import importlib
import json
import os
import re
import sys
import threading
from typing import Any

import numpy as np
import pytest
from click.testing import CliRunner

import eomgen
from eomgen.cli import main
from eomgen.errors import DerivationError, ModelError, ToolMissing
from eomgen.exported import urdf_of
from eomgen.proof import imported as importing
from eomgen.proof.imported import imported_otherwise, sdf_otherwise, unsaid_otherwise, without_units
from eomgen.proof.imported_mjcf import OTHER_THINGS, mjcf_otherwise
from eomgen.robots.importing import imported
from eomgen.symbolic.numeric.evaluation import FLOAT, evaluate
from tests.helpers.sdf_of_urdf import sdf_of_urdf
from tests.helpers.tools import needs
from tests.helpers.urdf_by_hand import ByHand, random_robot

ARM = """<?xml version="1.0"?>
<robot name="two links">
  <link name="base"/>
  <link name="upper arm">
    <visual><geometry><mesh filename="arm.stl"/></geometry></visual>
    <inertial>
      <origin xyz="0 0 0.2" rpy="0 0 1.5707963267948966"/>
      <mass value="2.0"/>
      <inertia ixx="0.03" iyy="0.02" izz="0.01" ixy="0" ixz="0" iyz="0"/>
    </inertial>
  </link>
  <link name="fore">
    <inertial><mass value="1"/><inertia ixx=".01" iyy=".01" izz=".01" ixy="0" ixz="0" iyz="0"/></inertial>
  </link>
  <link name="tool"/>
  <joint name="shoulder" type="revolute">
    <parent link="base"/><child link="upper arm"/>
    <origin xyz="0 0 1" rpy="0 1.5707963267948966 0"/>
    <axis xyz="0 0 1"/>
    <limit lower="-1.5" upper="2" effort="30" velocity="4"/>
    <dynamics damping="0.3" friction="0.1"/>
  </joint>
  <joint name="elbow" type="continuous">
    <parent link="upper arm"/><child link="fore"/><origin xyz="0 0 0.4"/>
    <mimic joint="shoulder" multiplier="-2" offset="0.25"/>
  </joint>
  <joint name="wrist" type="fixed"><parent link="fore"/><child link="tool"/><origin xyz="0.3 0 0"/></joint>
</robot>
"""


def robot(tmp_path: Any, text: str, ending: str = "urdf", **options: Any) -> Any:
    path = tmp_path / f"robot.{ending}"
    path.write_text(text)
    return imported(path, **options)


def dynamics(model: Any, q: dict[str, float], u: dict[str, float]) -> tuple[np.ndarray, np.ndarray]:
    """(M, c - Q) at a state, by the names of coordinates and speeds; inputs are 0."""
    graph = eomgen.derive(model).graph
    s = graph.symbols
    known: dict[Any, Any] = {s.t: 0.0, **{x: 0.0 for x in s.inputs.values()}}
    known |= {node: float(evaluate((graph.system.scope.value(model.parameters[name].value),), {}, FLOAT)[0])
              for name, node in s.parameters.items()}  # fmt: skip
    known |= {x: q[x.name] for x in s.q} | {x: u[x.name] for x in s.u}
    n = len(s.u)
    found = np.array(evaluate((*(x for row in graph.M for x in row), *graph.c, *graph.Q), known, FLOAT), dtype=float)
    return found[: n * n].reshape(n, n), found[n * n : n * n + n] - found[n * n + n :]


@pytest.mark.slow
@pytest.mark.parametrize("seed", range(4))
def test_mass_matrix_and_bias_of_a_urdf_are_those_of_its_words(seed, tmp_path):
    """M and c - Q of the imported model are those by poses, complex steps and sums over the links."""
    text = random_robot(seed)
    by_hand, model = ByHand(text), robot(tmp_path, text).model
    rng = np.random.default_rng(seed)
    q, v = rng.uniform(-2, 2, (2, len(by_hand.moving)))
    names = [name.replace("-", "_") for name in by_hand.moving]
    order = [list(model.coordinates).index(name) for name in names]
    M, h = dynamics(model, dict(zip(names, q, strict=True)), {f"{k}'": x for k, x in zip(names, v, strict=True)})
    M0, h0 = by_hand.dynamics(q, v)
    assert np.allclose(M[np.ix_(order, order)], M0, rtol=0, atol=1e-10 * np.abs(M0).max())
    assert np.allclose(h[order], h0, rtol=0, atol=1e-9 * np.abs(h0).max())


def test_a_urdf_reads_as_a_person_would_write_it(tmp_path):
    """Legal names beside the file's own, parts of pi, inertia in body axes, limits as stops, motors as inputs."""
    found = robot(tmp_path, ARM)
    arm, elbow = found.model.bodies["upper_arm"], found.model.bodies["fore"].joint
    assert arm.about == "link upper arm" and arm.joint.turned[0].angle.text == "pi/2"
    assert [x.text for x in arm.inertia] == ["0.02", "0.03", "0.01"] and arm.joint.torque.text == "tau_shoulder"
    assert [x.text for x in elbow.axis] == [
        "1",
        "0",
        "0",
    ] and elbow.torque is None  # the default
    assert found.model.coordinates["shoulder"].about == "at most 30 N*m, at most 4 rad/s"
    assert [arm.joint.limits.low.text, arm.joint.limits.high.text] == ["-1.5", "2"]
    assert found.model.constraints["mimic_elbow"].gap.text == "elbow + 2*shoulder - 0.25"
    assert found.model.bodies["tool"].mass is None and arm.joint.damping.text == "0.3"


def test_what_has_no_counterpart_is_listed_and_never_dropped_silently(tmp_path):
    """Every element and attribute that nobody read: in `left_out`, on stderr, at the end of the file."""
    strange = ARM.replace("</robot>", '<magnet strength="3"/></robot>').replace('upper="2"', 'upper="2" soft="1"')
    found = robot(tmp_path, strange)
    assert {each.what for each in found.left_out} == {"visual", "magnet", "soft of <limit>"}
    assert found.model.bodies["upper_arm"].joint.friction.torque.text == "0.1"
    assert found.text.rstrip().splitlines()[-1].startswith("# left out: magnet")
    path = tmp_path / "out.toml"
    result = CliRunner().invoke(main, ["import", str(tmp_path / "robot.urdf"), "-o", str(path), "--json"])
    listed = json.loads(result.stdout)["left_out"]
    assert [each["what"] for each in listed] == [each.what for each in found.left_out]
    assert result.stderr.count("left out: ") == 3 and path.read_text() == found.text
    assert eomgen.load(path).bodies == found.model.bodies == eomgen.import_robot(tmp_path / "robot.urdf").bodies


def test_a_base_that_floats_has_the_joints_own_block_and_the_whole_mass(tmp_path):
    """M of the joints is that of the fixed base; of the base's place it is the whole mass times 1."""
    text = random_robot(5)
    fixed, free = robot(tmp_path, text).model, robot(tmp_path, text, floating=True).model
    rng = np.random.default_rng(1)
    q = {name: x for name, x in zip(fixed.coordinates, rng.uniform(-1, 1, 9), strict=False)}
    still = {f"{name}'": 0.0 for name in fixed.coordinates}
    base = {f"base_{x}": 0.3 for x in "xyz"} | {f"base_e{k}": 0.5 for k in range(4)}
    spins = {f"base_{x}'": 0.0 for x in "xyz"} | {f"base_w{x}": 0.0 for x in "xyz"}
    M0, _ = dynamics(fixed, q, still)
    M, h = dynamics(free, q | base, still | spins)
    names = [u.name for u in eomgen.derive(free).graph.symbols.u]
    joints, places = ([names.index(name) for name in group] for group in (still, [f"base_{x}'" for x in "xyz"]))
    mass = sum(float(body.mass.text) for body in free.bodies.values() if body.mass is not None)
    assert np.allclose(M[np.ix_(joints, joints)], M0, rtol=0, atol=1e-11)
    assert np.allclose(M[np.ix_(places, places)], mass * np.eye(3), atol=1e-11)
    assert np.allclose(h[places], [0, 0, 9.81 * mass], atol=1e-10)


def test_floating_and_planar_joints_have_six_and_three_freedoms(tmp_path):
    """A planar joint moves across its axis, and turns about it; a floating one does all."""
    text = """<robot name="r"><link name="a"/><link name="b"><inertial><mass value="1"/><inertia ixx="1" iyy="1"
    izz="1" ixy="0" ixz="0" iyz="0"/></inertial></link><joint name="j" type="{}"><parent link="a"/><child link="b"/>
    <origin rpy="0.3 0.2 0.1"/><axis xyz="1 2 2"/></joint></robot>"""
    planar = robot(tmp_path, text.format("planar")).model
    axes = [[float(x.text) for x in body.joint.axis] for body in planar.bodies.values() if body.joint.kind != "fixed"]
    assert [body.joint.kind for body in planar.bodies.values()] == ["fixed", "prismatic", "prismatic", "revolute"]
    assert np.allclose(np.array(axes[:2]) @ axes[2], 0) and abs(np.dot(axes[0], axes[1])) < 1e-15
    floating = robot(tmp_path, text.format("floating")).model
    assert floating.bodies["b"].joint.kind == "free" and eomgen.derive(floating).certify().ok
    assert eomgen.derive(planar).certify().ok and eomgen.freedom_of(planar).by_rank == 3


@pytest.mark.parametrize(
    ("change", "what"),
    [
        (("<robot", "<!DOCTYPE r [<!ENTITY a 'b'>]><robot"), "document type"),
        (("</robot>", ""), "no well-formed XML"),
        (("<robot", "<model"), "no well-formed XML"),
        (('type="fixed"', 'type="welded"'), "unknown type of a joint: 'welded'"),
        (
            ('child link="fore"', 'child link="for"'),
            "names a link that there is not: 'for'\nfix: did you mean 'fore'?",
        ),
        (('child link="tool"', 'child link="fore"'), "hangs on two joints"),
        (('parent link="base"', 'parent link="tool"'), "ring of joints"),
        (('value="2.0"', 'value="-2.0"'), "a negative mass: -2.0"),
        (('value="2.0"', 'value="heavy"'), "a number is needed in 'value' of <mass>, not 'heavy'"),
        (('xyz="0 0 0.2"', 'xyz="0 0.2"'), "3 numbers are needed in 'xyz' of <origin>"),
        (('<axis xyz="0 0 1"/>', '<axis xyz="0 0 0"/>'), "has no direction"),
        (('name="tool"', 'name="fore"'), "two <link> are called 'fore'"),
        (('izz="0.01"', 'izz="-0.01"'), "a negative moment of inertia"),
    ],
)
def test_a_wrong_urdf_is_refused_at_its_place(change, what, tmp_path):
    """file:line:column, what is wrong, how to fix it."""
    with pytest.raises(ModelError) as caught:
        robot(tmp_path, ARM.replace(*change, 1))
    assert what in str(caught.value) and "robot.urdf:" in str(caught.value) and "fix: " in str(caught.value)


def test_a_file_that_is_no_robot_is_refused(tmp_path):
    """xacro is to be expanded first; other XML, and files that are not there, are named."""
    with pytest.raises(ModelError, match="no <link>"):
        robot(tmp_path, '<robot xmlns:xacro="x"><xacro:include filename="a"/></robot>')
    with pytest.raises(ModelError, match="the root is <svg>"):
        robot(tmp_path, "<svg/>")
    with pytest.raises(ModelError, match="cannot be read"):
        eomgen.import_robot(tmp_path / "nothing.urdf")


MJCF = """<mujoco model="tester">
  <compiler angle="degree"/>
  <option gravity="0.3 0 -9.81"/>
  <default><joint damping="0.2" armature="0.01"/><geom density="500"/></default>
  <worldbody>
    <body name="cart/one" pos="0.1 0 1" euler="20 0 30">
      <joint name="slide" type="slide" axis="1 2 0" pos="0.3 0 0" stiffness="3" springref="0.2"/>
      <joint name="turn" axis="0 1 1" pos="0.1 0.2 0.3" ref="15"/>
      <joint name="lean" axis="1 0 0" pos="0 0.1 0" range="-40 50"/>
      <geom type="box" size="0.1 0.2 0.3" pos="0.1 0.1 0" euler="10 20 30"/>
      <body name="ball" pos="0 0.5 0" quat="0.8 0.6 0 0">
        <joint name="socket" type="ball" pos="0.1 0 -0.2" armature="0"/>
        <geom type="capsule" fromto="0 0 0 0.1 0.2 0.3" size="0.05"/>
        <body name="last" pos="0 0 0.4"><joint name="wrist" axis="0 0 1"/><geom size="0.1" pos="0.2 0 0"/>
          <site name="nozzle" pos="0.1 0 0" euler="0 40 0"/></body>
      </body>
    </body>
    <body name="bird" pos="1 2 3" euler="0 90 0"><freejoint name="fly"/>
      <geom type="ellipsoid" size="0.1 0.2 0.3"/></body>
  </worldbody>
  <tendon><fixed name="cable" stiffness="7" damping="0.3" springlength="0.1 0.4">
    <joint joint="slide" coef="2"/><joint joint="wrist" coef="-0.5"/></fixed></tendon>
  <equality><joint joint1="lean" joint2="wrist" polycoef="0.1 2 0.5 0 0"/></equality>
  <actuator>
    <motor name="push" joint="slide" gear="3"/>
    <position name="hold" joint="turn" kp="20" kv="2"/>
    <motor name="pull" tendon="cable" gear="2"/>
    <motor name="jet" site="nozzle" gear="1 0 2 0 0.5 0"/>
    <general name="muscle" joint="lean" dyntype="filter" gainprm="4"/>
  </actuator>
</mujoco>"""


TIED = """<mujoco><compiler angle="radian"/><default><default class="leg"><joint stiffness="2" springref="0.1"/>
  <default class="knee"><joint axis="0 1 0" damping="0.3"/></default></default></default>
  <worldbody><site name="wall" pos="0.3 0 1"/>
    <body name="thigh" childclass="leg" pos="0.1 0 1"><joint name="hip" axis="1 0 0" pos="0 0 0.1"/>
      <geom type="capsule" size="0.03 0.1"/><site name="hook" pos="0 0.1 0.2"/>
      <body name="shin" pos="0 0 -0.2"><joint name="knee" class="knee"/><geom type="capsule" size="0.02 0.1"/></body>
    </body>
    <body name="slider" pos="1 0 0"><joint name="slide" type="slide" axis="1 0 0" pos="0.2 0 0"/>
      <geom size="0.1"/></body>
    <body name="other" pos="1 0 2"><joint name="lift" type="slide" axis="0 0 1"/><geom size="0.1"/></body>
  </worldbody>
  <tendon><spatial name="cable" stiffness="20" damping="0.5" springlength="0.2">
      <site site="wall"/><site site="hook"/></spatial>
    <spatial name="slack" stiffness="30" springlength="0.1 0.15"><site site="hook"/><site site="wall"/></spatial>
    <spatial name="bent" stiffness="1"><site site="wall"/><site site="hook"/><site site="wall"/></spatial></tendon>
  <equality><connect body1="slider" body2="other" anchor="0 0 0.5"/><connect body1="shin" anchor="0 0 -0.1"/></equality>
</mujoco>"""


@pytest.mark.slow
@needs(".mujoco", what="mujoco")
def test_ties_of_bodies_without_places_and_straight_tendons_mean_what_mujoco_computes(tmp_path):
    """Points that constraints alone ask for are those of their bodies, pivots beside them; T and Q with tendons
    between two
    places, slack ones too; a bent tendon is listed."""
    mujoco: Any = importlib.import_module("mujoco")
    found = robot(tmp_path, TIED, "xml")
    compiled = mujoco.MjModel.from_xml_string(TIED)
    compiled.opt.disableflags = int(mujoco.mjtDisableBit.mjDSBL_CONSTRAINT)
    compiled.tendon_stiffness[2] = 0
    data, rng = mujoco.MjData(compiled), np.random.default_rng(5)
    graph = eomgen.derive(found.model).graph
    names = ["hip", "knee", "slide", "lift"]
    for _ in range(3):
        data.qpos[:], data.qvel[:] = rng.normal(size=4), rng.normal(size=4)
        mujoco.mj_forward(compiled, data)
        q, u = dict(zip(names, data.qpos, strict=True)), {f"{n}'": v for n, v in zip(names, data.qvel, strict=True)}
        known = {x: (q | u)[x.name] for x in graph.symbols.x} | {graph.symbols.t: 0.0}
        known |= {x: 9.81 for x in graph.symbols.parameters.values()}
        Q = np.array(evaluate([y - x for x, y in zip(graph.c, graph.Q, strict=True)], known, FLOAT), dtype=float)
        assert np.allclose(Q, data.qfrc_passive - data.qfrc_bias, atol=1e-10)
    assert {"tie0", "tie1"} <= set(found.model.constraints) and found.model.bodies["slider"].points.keys() >= {"tie0"}
    assert {each.what: each.where for each in found.left_out}["tendons through places"] == ("bent",)


@pytest.mark.slow
@needs(".mujoco", what="mujoco")
def test_mjcf_means_what_mujoco_computes(tmp_path):
    """M, all forces at random states and controls, and the rows of constraints, against MuJoCo; several joints in a
    body, off
    its origin, ball and free joints, springs with slack, motors on joints, tendons and sites."""
    mujoco: Any = importlib.import_module("mujoco")
    found = robot(tmp_path, MJCF, "xml")
    model = found.model
    compiled = mujoco.MjModel.from_xml_string(MJCF)
    compiled.opt.jacobian = 0
    data, rng = mujoco.MjData(compiled), np.random.default_rng(3)
    equations = eomgen.derive(model)
    graph, s = equations.graph, equations.graph.symbols
    for _ in range(3):
        data.qpos[:], data.qvel[:] = rng.normal(size=compiled.nq), rng.normal(size=compiled.nv)
        mujoco.mj_normalizeQuat(compiled, data.qpos)
        data.ctrl[:4], data.act[:] = rng.normal(size=4), 0.7
        mujoco.mj_forward(compiled, data)
        slides = ["slide", "turn", "lean", "socket_e0", "socket_e1", "socket_e2", "socket_e3", "wrist"]
        q = dict(zip([*slides, *(f"fly_{x}" for x in ("x", "y", "z", "e0", "e1", "e2", "e3"))], data.qpos, strict=True))
        rates = ["slide'", "turn'", "lean'", "socket_wx", "socket_wy", "socket_wz", "wrist'"]
        rates += [*(f"fly_{x}'" for x in "xyz"), *(f"fly_w{x}" for x in "xyz")]
        u = dict(zip(rates, data.qvel, strict=True))
        w = dict(zip(("push", "hold", "pull", "jet"), data.ctrl, strict=False)) | {"muscle": 0.7}
        known: dict[Any, Any] = {s.t: 0.0} | {x: q[x.name] for x in s.q} | {x: u[x.name] for x in s.u}
        known |= {x: w[x.name] for x in s.inputs.values()}
        n, order = len(s.u), [rates.index(x.name) for x in s.u]
        entries = [*(x for row in graph.M for x in row), *graph.c, *graph.Q, *(x for row in graph.J for x in row)]
        numbers = np.array(evaluate(entries, known, FLOAT), dtype=float)
        full = np.zeros((n, n))
        for k in range(n):
            mujoco.mj_mulM(compiled, data, full[k], np.eye(n)[k])
        forces = data.qfrc_passive + data.qfrc_actuator - data.qfrc_bias
        M, Q = numbers[: n * n].reshape(n, n), numbers[n * n + n : n * n + 2 * n] - numbers[n * n : n * n + n]
        assert np.allclose(M, full[np.ix_(order, order)], atol=1e-11) and np.allclose(Q, forces[order], atol=1e-9)
        J, constraint = numbers[n * n + 2 * n :].reshape(-1, n), data.efc_J.reshape(-1, n)[0][order]
        assert len(J) == 1 and abs(abs(J[0] @ constraint) - np.linalg.norm(J[0]) * np.linalg.norm(constraint)) < 1e-10
    assert equations.certify().ok
    left = {"geoms that touch", "filters of motors", "softness of equalities", "softness of limits"}
    assert {each.what for each in found.left_out} == left


STOPS = """<robot name="stops"><link name="base"/><link name="a"/><link name="b"/><link name="c"/>
<joint name="knee" type="revolute"><parent link="base"/><child link="a"/><limit lower="0" upper="2.5"/></joint>
<joint name="shin" type="revolute"><parent link="a"/><child link="b"/><limit lower="-6" upper="1"/>
  <mimic joint="knee" multiplier="-2" offset="0.5"/></joint>
<joint name="lock" type="prismatic"><parent link="b"/><child link="c"/><limit lower="0" upper="0"/></joint></robot>"""


def test_a_start_at_a_stop_is_moved_between_the_stops_and_what_follows_has_none_of_its_own(tmp_path):
    """0 is no start between 0 and 2.5: 1.25, -2*1.25 + 0.5 of what follows; -2*[0, 2.5] + 0.5 is within [-6, 1]."""
    found = robot(tmp_path, STOPS)
    knee, shin, lock = (found.model.bodies[name].joint for name in "abc")
    assert [x.text for x in (knee.limits.low, knee.limits.high)] == ["0", "2.5"] and shin.limits is lock.limits is None
    starts = {q: part.start.text for q, part in found.model.coordinates.items() if part.start is not None}
    assert starts == {"knee": "1.25", "shin": "-2"}
    told = {each.what: each.where for each in found.left_out}
    assert told == {"start beyond limits": ("knee",), "limits that leave no range": ("lock",)}
    tighter = robot(tmp_path, STOPS.replace('lower="-6"', 'lower="-4"'))
    assert ("shin",) in [each.where for each in tighter.left_out if each.what == "limits of joints that follow others"]
    (tmp_path / "first.toml").write_text(found.text)
    assert '"-6"' in urdf_of(tmp_path / "first.toml").text


RUBBING = """<mujoco><worldbody><body><joint name="h" axis="0 1 0" ref="10" range="-20 90" frictionloss="0.4"/>
<geom size="0.1" pos="0.3 0 0"/><body><joint name="p" type="slide" range="0.1 0.4"/><geom size="0.1"/></body></body>
</worldbody></mujoco>"""


@pytest.mark.slow
@needs(".mujoco", what="mujoco")
def test_stops_and_friction_losses_of_mujoco_are_those_of_joints(tmp_path):
    """`range` less `ref`, `frictionloss`; what starts beyond is a remark, what yields is told; another one is seen."""
    found = robot(tmp_path, RUBBING, "xml")
    turn, slide = (body.joint for body in found.model.bodies.values())
    assert [float(x.text) for x in (turn.limits.low, turn.limits.high)] == pytest.approx(
        [np.radians(-30), np.radians(80)]
    )
    assert turn.friction.torque.text == "0.4" and slide.limits is None
    assert found.model.coordinates["p"].about == "from 0.1 to 0.4 m"
    told = {each.what: each.where for each in found.left_out}
    assert told["softness of limits"] == told["softness of frictionloss"] == ("h",) and told["start beyond limits"] == (
        "p",
    )
    path, left = str(tmp_path / "robot.xml"), [("start beyond limits", ("p",))]
    assert mjcf_otherwise(path, RUBBING.encode(), found.model, None, left) == ""
    assert "rubs with 0.4, not 0.5" in seen_in(tmp_path, "0.4", "0.5", found, left)
    assert "stops" in seen_in(tmp_path, "-20", "-25", found, left)


def seen_in(tmp_path: Any, old: str, new: str, found: Any, left: Any) -> str:
    """Message of the second reading of a file about the model of another one."""
    other = tmp_path / "other.xml"
    other.write_text(RUBBING.replace(old, new))
    return mjcf_otherwise(str(other), other.read_bytes(), found.model, None, left)


SOFT = """<sdf version="1.9"><model name="m"><link name="base"/><link name="a"/>
<joint name="stand" type="fixed"><parent>world</parent><child>base</child></joint>
<joint name="j" type="revolute"><parent>base</parent><child>a</child><axis><xyz>0 1 0</xyz>
<limit><lower>-1</lower><upper>1e16</upper><stiffness>500</stiffness><dissipation>3</dissipation></limit></axis></joint>
</model></sdf>"""


def test_stops_of_sdf_yield_where_it_gives_a_stiffness(tmp_path):
    """<lower>, and no <upper>; <stiffness>, <dissipation>: `stop`; without them rigid."""
    joint = robot(tmp_path, SOFT, "sdf").model.bodies["a"].joint
    assert (joint.limits.low.text, joint.limits.high) == ("-1", None)
    assert (joint.stop.stiffness.text, joint.stop.damping.text) == ("500", "3")
    rigid = robot(tmp_path, SOFT.replace("<stiffness>500</stiffness><dissipation>3</dissipation>", ""), "sdf")
    assert rigid.model.bodies["a"].joint.stop is None and list(rigid.model.constraints) == ["a_low"]


ONES = """<mujoco><worldbody><body><freejoint name="fly"/><geom size="0.1"/>
<body><joint name="hinge" axis="0 1 0"/><geom size="0.1" pos="1 0 0"/></body></body></worldbody>
<actuator><position name="servo" joint="hinge" kp="1" kv="1"/></actuator></mujoco>"""


@pytest.mark.slow
@needs(".mujoco", what="mujoco")
def test_a_damper_and_a_gain_of_one_have_their_units(tmp_path):
    """-1*x' is a force where -x' would be a velocity, and refused."""
    model = robot(tmp_path, ONES.replace("<freejoint", '<joint type="free" damping="1"'), "xml").model
    assert model.forces["fly_drag"].force[0].text == "-1*fly_x'"
    assert model.bodies["body2"].joint.torque.text == "servo - 1*hinge - 1*hinge'"


def test_mjcf_without_mujoco_names_the_wheel(tmp_path, monkeypatch):
    """Exit 4: which tool is missing, and how to get it."""
    monkeypatch.setitem(sys.modules, "mujoco", None)
    with pytest.raises(ToolMissing, match="pip install mujoco"):
        robot(tmp_path, MJCF, "xml")


@pytest.mark.slow
@pytest.mark.parametrize(("seed", "in_model"), [(0, True), (1, False), (2, False)])
def test_sdf_and_urdf_of_one_robot_have_one_mass_matrix_and_one_bias(seed, in_model, tmp_path):
    """Poses in the model's axes, joints off the child's origin in axes of their own: M and c - Q are the URDF's."""
    text = random_robot(seed)
    first = robot(tmp_path, text).model
    second = robot(tmp_path, sdf_of_urdf(text, in_model=in_model), "sdf").model
    rng = np.random.default_rng(seed)
    q = {name: float(rng.uniform(-2, 2)) for name in first.coordinates}
    u = {f"{name}'": float(rng.uniform(-1, 1)) for name in q}
    still = dict.fromkeys(u, 0.0)
    (M, h), (M0, h0) = dynamics(second, q, u), dynamics(first, q, u)
    (_, g), (_, g0) = dynamics(second, q, still), dynamics(first, q, still)
    order = [list(first.coordinates).index(name) for name in second.coordinates]
    assert np.allclose(M, M0[np.ix_(order, order)], atol=1e-10)
    assert np.allclose(h - g, (h0 - g0)[order], atol=1e-9)
    assert np.allclose(g / 9.8, g0[order] / 9.81, atol=1e-10)


SDF = """<sdf version="1.9"><world name="w"><gravity>0 0 -3.7</gravity><light name="sun"/><model name="rover">
  <link name="hull"><pose>1 2 3 0 0 1.5707963267948966</pose><inertial><mass>5</mass>
    <inertia><ixx>1</ixx><iyy>1.5</iyy><izz>2</izz></inertia></inertial></link>
  <link name="mast"><pose relative_to="hull">0 0 0.5 0 0 0</pose><inertial><mass>2</mass></inertial></link>
  <link name="eye"><pose relative_to="top">0 0.1 0 0 0 0</pose><inertial><mass>1</mass></inertial></link>
  <frame name="top" attached_to="mast"><pose>0 0 1 0 0 0</pose></frame>
  <joint name="tilt" type="universal"><parent>hull</parent><child>mast</child>
    <axis><xyz>1 0 0</xyz><dynamics><damping>0.1</damping><friction>0</friction><spring_stiffness>4</spring_stiffness>
      <spring_reference>0.2</spring_reference></dynamics><limit><lower>-1</lower><upper>1e16</upper></limit></axis>
    <axis2><xyz>0 1 0</xyz></axis2></joint>
  <joint name="screwed" type="screw"><screw_thread_pitch>0.02</screw_thread_pitch>
    <parent>mast</parent><child>eye</child>
    <axis><xyz>0 0 1</xyz><mimic joint="tilt"><multiplier>2</multiplier><offset>0.5</offset></mimic></axis></joint>
  <plugin name="driver" filename="x.so"/>
</model></world></sdf>"""


def test_sdf_has_frames_springs_screws_and_links_that_nothing_holds(tmp_path):
    """Poses by frames, a universal joint as two hinges, a free hull where it stands, gravity of the world."""
    found = robot(tmp_path, SDF, "sdf")
    bodies, model = found.model.bodies, found.model
    assert [body.joint.kind for body in bodies.values()] == ["free", "revolute", "revolute", "screw"]
    assert [model.coordinates[f"hull_{x}"].start.text for x in "xyz"] == ["1", "2", "3"]
    assert [x.text for x in bodies["eye"].joint.at] == ["0", "0.1", "1"]
    assert bodies["eye"].joint.pitch.text == "0.02/(2*pi)" and model.parameters["g"].value.text == "3.7"
    hinge = bodies["mast_tilt"].joint
    assert (hinge.stiffness.text, hinge.rest.text, hinge.damping.text) == ("4", "0.2", "0.1")
    assert model.constraints["mimic_screwed"].gap.text == "screwed - 2*tilt - 0.5"
    assert {each.what for each in found.left_out} == {"light", "plugin"}
    assert eomgen.derive(model).certify().ok
    for change, what in [
        (("<child>eye", "<child>mast"), "two joints"),
        (('"top">0 0.1', '"to">0 0.1'), "there is not"),
    ]:
        with pytest.raises(ModelError, match=what):
            robot(tmp_path, SDF.replace(*change), "sdf")


def test_sdf_takes_the_models_that_a_world_includes_and_a_model_merges(tmp_path):
    """The same tables as with everything in one file, under the name that is included; a cycle and no file are told."""
    whole = robot(tmp_path, SDF, "sdf")
    inner = SDF[SDF.index("<link") : SDF.index("</model>")]
    eye = inner[inner.index('  <link name="eye"') : inner.index('  <frame name="top"')]
    (tmp_path / "eye").mkdir()
    (tmp_path / "eye" / "model.sdf").write_text(
        f'<sdf version="1.9"><model name="e">{eye}<plugin name="p"/></model></sdf>'
    )
    merged = inner.replace(eye, '<include merge="true"><uri>model://eye</uri></include>')
    (tmp_path / "rover.sdf").write_text(f'<sdf version="1.9"><model name="x">{merged}</model></sdf>')
    world = "<include><uri>file://rover.sdf</uri><name>rover</name></include></world></sdf>"
    found = robot(tmp_path, SDF[: SDF.index("<model")] + world, "sdf")
    assert found.model.bodies == whole.model.bodies and found.model.name == whole.model.name == "rover"
    assert found.model.constraints == whole.model.constraints and found.model.inputs == whole.model.inputs
    plugins, own = ([each.where for each in x.left_out if each.what == "plugin"] for x in (found, whole))
    assert [len(each) for each in plugins] == [2] and [len(each) for each in own] == [1]
    with pytest.raises(ModelError, match="no file is there for 'rove"):
        robot(tmp_path, SDF[: SDF.index("<model")] + world.replace("rover.sdf", "rove.sdf"), "sdf")
    circle = '<include merge="true"><uri>rover.sdf</uri></include>'
    (tmp_path / "rover.sdf").write_text(f'<sdf version="1.9"><model name="x">{merged}{circle}</model></sdf>')
    with pytest.raises(ModelError, match="includes itself"):
        robot(tmp_path, SDF[: SDF.index("<model")] + world, "sdf")


@pytest.mark.slow
@pytest.mark.parametrize("seed", [0, 3])
def test_what_is_exported_is_imported_with_the_same_equations(seed, tmp_path):
    """M and c - Q of import(export(import(F))) are those of import(F); nothing is left out."""
    first = robot(tmp_path, random_robot(seed)).model
    path = tmp_path / "again.urdf"
    text = toml_of_random(seed, tmp_path)
    result = CliRunner().invoke(main, ["export", text, "-o", str(path), "--json"])
    assert result.exit_code == 0 and json.loads(result.stdout)["left_out"] == []
    second = eomgen.import_robot(path)
    rng = np.random.default_rng(seed)
    q = {name: float(rng.uniform(-2, 2)) for name in first.coordinates}
    u = {f"{name}'": float(rng.uniform(-1, 1)) for name in q}
    (M, h), (M0, h0) = dynamics(second, q, u), dynamics(first, q, u)
    order = [list(first.coordinates).index(name) for name in second.coordinates]
    assert np.allclose(M, M0[np.ix_(order, order)], atol=1e-10) and np.allclose(h, h0[order], atol=1e-9)
    assert set(second.inputs) == set(first.inputs)


def toml_of_random(seed: int, tmp_path: Any) -> str:
    path = tmp_path / "first.toml"
    path.write_text(robot(tmp_path, random_robot(seed)).text)
    return str(path)


def test_export_says_what_urdf_can_and_lists_the_rest(tmp_path):
    """Points off the origin, angles with an offset, plane models; springs are listed, ball joints refused."""
    arm = tmp_path / "arm.toml"
    arm.write_text("""
eomgen = 1
space = "plane"
parameters = { g = 9.81, l = 0.4 }
coordinates = { x = 0, q = 0.3 }
forces.weight = { kind = "gravity", acceleration = [0, "-g"] }
[bodies.cart]
mass = 2
joint = { kind = "prismatic", axis = [1, 0], displacement = "x", stiffness = 3 }
[bodies.rod]
mass = 0.5
inertia = 0.02
points = { hinge = ["-l/2", 0] }
[bodies.rod.joint]
kind = "revolute"
on = "cart"
at = [0, 0.1]
point = "hinge"
angle = "pi/6 - q"
damping = 0.2
torque = "2*T - 0.1*sign(q')"
[inputs]
T = "sin(t)"
""")
    found = urdf_of(arm)
    listed = {"stiffness": ("cart",), "forces": ("weight",), "values of inputs": ("T",), "start values": ("q",)}
    assert {each.what: each.where for each in found.left_out} == listed | {"drives that are no input alone": ("rod",)}
    assert "<transmission" not in found.text
    path = tmp_path / "arm.urdf"
    path.write_text(found.text)
    again, first = eomgen.import_robot(path), eomgen.load(arm)
    q, u = {"x": 0.2, "q": 0.7}, {"x'": -0.4, "q'": 1.1}
    assert np.allclose(dynamics(again, q, u)[0], dynamics(first, q, u)[0], atol=1e-12)
    with pytest.raises(DerivationError, match="hinges, slides and free joints"):
        urdf_of("models/spatial_slider_crank.toml")


@pytest.mark.parametrize(("up", "away"), [(1, 0), (1, 3e-12), (-1, 1e-8), (1, 3e-5), (-1, 0.1), (1, -1e-8)])
def test_frames_of_export_are_those_of_the_model(up, away, tmp_path):
    """R = Rz(yaw) Ry(pitch) Rx(roll) to 1e-15, near a pitch of 90 degrees too, where roll and yaw are one: M, c - Q."""
    seat = f'<origin xyz="0.1 0.2 0.3" rpy="0.7 {up * (np.pi / 2 - away)!r} -1.9"/>'
    first = robot(tmp_path, ARM.replace('<origin xyz="0 0 0.4"/>', seat))
    (tmp_path / "first.toml").write_text(first.text)
    (tmp_path / "again.urdf").write_text(urdf_of(tmp_path / "first.toml").text)
    q, u = {"shoulder": 0.4, "elbow": 1.3}, {"shoulder'": -0.8, "elbow'": 1.1}
    found, expected = (dynamics(x, q, u) for x in (eomgen.import_robot(tmp_path / "again.urdf"), first.model))
    assert np.allclose(found[0], expected[0], rtol=0, atol=1e-14) and np.allclose(found[1], expected[1], atol=1e-13)


def test_names_of_the_exported_links_and_joints_are_each_their_own(tmp_path):
    """A body called world beside the world of URDF; a coordinate called as a fixed joint is."""
    named = (
        ARM.replace('"tool"', '"elbow"')
        .replace('"fore"', '"world"')
        .replace('joint name="elbow"', 'joint name="elbow_joint"')
    )
    first = robot(tmp_path, named)
    (tmp_path / "first.toml").write_text(first.text)
    (tmp_path / "again.urdf").write_text(urdf_of(tmp_path / "first.toml").text)
    again = eomgen.import_robot(tmp_path / "again.urdf")
    assert {"world", "elbow", "upper_arm"} <= set(again.bodies) and set(again.coordinates) == set(
        first.model.coordinates
    )


FOLLOWING = """<robot name="constraint"><link name="base"/>
<link name="upper arm"><inertial><origin xyz="0 0 0.2"/><mass value="2.5"/>
  <inertia ixx="0.03" iyy="0.02" izz="0.015" ixy="0" ixz="0" iyz="0"/></inertial></link>
<link name="hand"><inertial><mass value="1"/>
  <inertia ixx="1" iyy="1" izz="1" ixy="0" ixz="0" iyz="0"/></inertial></link>
<joint name="s.0" type="continuous"><parent link="base"/><child link="upper arm"/><axis xyz="0 0 1"/>
  <mimic joint="s.1" multiplier="2" offset="0.5"/></joint>
<joint name="s.1" type="revolute"><parent link="upper arm"/><child link="hand"/><origin xyz="0 0 0.4"/>
  <axis xyz="1 0 0"/><limit lower="-1" upper="1e-1" effort="3.5" velocity="2"/></joint></robot>"""


def test_names_limits_motors_and_a_base_that_stands_come_back(tmp_path):
    """URDF -> TOML -> URDF -> TOML: the same text, its names in remarks, limits as stops, and no world more; of two
    coordinates in a constraint the one without a motor follows, though it comes first."""
    first = robot(tmp_path, FOLLOWING)
    (tmp_path / "first.toml").write_text(first.text)
    (tmp_path / "again.urdf").write_text(urdf_of(tmp_path / "first.toml").text)
    second = imported(tmp_path / "again.urdf")
    assert 'about = "joint s.1, at most 3.5 N*m, at most 2 rad/s"' in first.text and "limits = [-1, 0.1]" in first.text
    assert second.text.partition("\n")[2] == first.text.partition("\n")[2] and not second.left_out


def test_coordinates_that_follow_one_another_come_back(tmp_path):
    """mimic -> equation -> mimic: the same gap."""
    first = robot(tmp_path, ARM)
    model = tmp_path / "arm.toml"
    model.write_text(first.text)
    (tmp_path / "robot.urdf").write_text(urdf_of(model).text)
    second = eomgen.import_robot(tmp_path / "robot.urdf")
    assert second.constraints["mimic_elbow"].gap == first.model.constraints["mimic_elbow"].gap


def test_a_robot_that_is_read_otherwise_is_contradicted(tmp_path):
    """T = (R_z R_y R_x, xyz): angles in another order, a multiplier of the other sign, a centre that is lost."""
    text = ARM.replace("upper arm", "upper").replace('rpy="0 1.5707963267948966 0"', 'rpy="0.3 -0.5 0.7"')
    made = robot(tmp_path, text).model
    assert imported_otherwise(text, made) == ""
    for old, new, what in (
        ('rpy="0.3 -0.5 0.7"', 'rpy="0.7 -0.5 0.3"', "does not stand on"),
        ('multiplier="-2"', 'multiplier="2"', "leaves"),
        ('xyz="0 0 0.2"', 'xyz="0 0 0.1"', "has another mass, mass centre or inertia"),
        ('<axis xyz="0 0 1"/>', '<axis xyz="0 0 -1"/>', "does not stand on"),
    ):
        assert what in imported_otherwise(text.replace(old, new), made)


def test_the_inertia_of_a_turned_link_stands_as_it_was_written_or_as_a_number(tmp_path):
    """R I R^T by rpy: decimals in T, no fractions of 18 digits; principal moments in numbers, no roots of such."""
    path = tmp_path / "turned.urdf"
    path.write_text(
        '<robot name="turned"><link name="base"/><link name="c"><inertial><origin xyz="0.1 0 0" rpy="0.3 0.2 0.1"/>'
        '<mass value="2"/><inertia ixx="0.1" iyy="0.2" izz="0.25" ixy="0.01" ixz="0.02" iyz="0"/></inertial></link>'
        '<joint name="j" type="continuous"><parent link="base"/><child link="c"/><axis xyz="0 1 0"/></joint></robot>'
    )
    model = eomgen.import_robot(path)
    found = eomgen.inertia(model)
    energy = [line for line in eomgen.derive(model).render("text").splitlines() if line.startswith("    T")]
    text = "\n".join([found.render("text"), *energy])
    assert re.search(r"\d{10,}/\d{6,}|sqrt\(\d{10,}", text) is None
    assert re.search(r"I_1 = 0\.\d+\n", text) and found.certify().ok


def test_a_base_that_floats_and_links_of_other_names_are_no_contradiction(tmp_path):
    """|e| = 1 of the quaternion at which a robot is looked at; "link upper arm" is upper_arm."""
    text = ARM.replace('"upper arm"', '"upper-arm"')
    assert imported_otherwise(text, robot(tmp_path, text, floating=True).model) == ""
    assert imported_otherwise(FOLLOWING, robot(tmp_path, FOLLOWING).model) == ""
    made = robot(tmp_path, FOLLOWING).model
    for old, new, what in (
        ('multiplier="2"', 'multiplier="3"', "leaves"),
        ('upper="1e-1"', 'upper="1"', "limits"),
        ('<parent link="upper arm"/>', '<parent link="base"/>', "hangs on"),
    ):
        assert what in imported_otherwise(FOLLOWING.replace(old, new), made)


SDF_ARM = """<sdf version="1.9"><model name="arm"><pose>0.1 0 0.2 0 0 0.3</pose>
  <link name="base"><inertial><mass>3</mass></inertial></link>
  <link name="upper"><pose relative_to="hinge">0 0 0 0.1 0.2 0.3</pose>
    <inertial><pose>.1 0 .2 .1 .2 .3</pose><mass>2</mass>
    <inertia><ixx>.1</ixx><iyy>.2</iyy><izz>.25</izz><ixy>.01</ixy><ixz>.02</ixz><iyz>.03</iyz></inertia></inertial>
  </link>
  <link name="fore"><pose relative_to="slide"/><inertial auto="true"><density>700</density></inertial>
    <collision name="c"><pose>0.1 0 0 0 0 0.4</pose><geometry><box><size>0.2 0.1 0.3</size></box></geometry></collision>
    <collision name="d"><geometry><cylinder><radius>0.1</radius><length>0.3</length></cylinder></geometry></collision>
  </link>
  <joint name="stand" type="fixed"><parent>world</parent><child>base</child></joint>
  <joint name="hinge" type="revolute"><pose relative_to="base">0 0.1 0.5 0.2 0 0</pose><parent>base</parent>
    <child>upper</child><axis><xyz>0 0.6 0.8</xyz><dynamics><damping>0.2</damping><spring_stiffness>3</spring_stiffness>
    <spring_reference>0.1</spring_reference></dynamics></axis></joint>
  <joint name="slide" type="prismatic"><pose relative_to="upper">0 0 0.7 0 0.3 0</pose><parent>upper</parent>
    <child>fore</child><axis><xyz>1 0 0</xyz></axis></joint></model></sdf>"""


def test_an_sdf_robot_that_is_read_otherwise_is_contradicted(tmp_path):
    """T_child = T_parent T_joint (turn, slide) T_joint^-1; masses by density; springs and dampers; the rest at 0."""
    for text in (SDF_ARM, SDF):
        assert sdf_otherwise(text, robot(tmp_path, text, "sdf").model) == ""
    made = robot(tmp_path, SDF_ARM, "sdf").model
    for old, new, what in (
        ("0 0.1 0.5 0.2 0 0", "0 0.1 0.5 0 0.2 0", "stand"),
        ("0 0.6 0.8", "0 0.8 0.6", "does not move"),
        ("<density>700", "<density>800", "another mass"),
        ("<ixz>.02", "<ixz>-.02", "another mass"),
        ("<damping>0.2", "<damping>0.4", "damping"),
        ("<spring_reference>0.1", "<spring_reference>-0.1", "rest"),
        ("0.1 0 0.2 0 0 0.3</pose>\n  <link", "0.1 0 0.2 0 0.3 0</pose>\n  <link", "stand"),
    ):
        assert what in sdf_otherwise(SDF_ARM.replace(old, new), made)
    rover = robot(tmp_path, SDF, "sdf").model
    assert "leaves" in sdf_otherwise(SDF.replace("<offset>0.5", "<offset>0.6"), rover)
    assert "does not move" in sdf_otherwise(SDF.replace("0.02</screw", "0.03</screw"), rover)


@pytest.mark.slow
@needs(".mujoco", what="mujoco")
def test_an_mjcf_robot_that_is_read_otherwise_is_contradicted(tmp_path):
    """T, M and Q - c are MuJoCo's; what is left out is there."""
    found = robot(tmp_path, MJCF_ARM, "xml")
    equations, path = eomgen.derive(found.model).graph, tmp_path / "other.xml"

    def wrong(old: str, new: str, left: tuple[tuple[str, tuple[str, ...]], ...] = ()) -> str:
        path.write_text(MJCF_ARM.replace(old, new))
        return mjcf_otherwise(str(path), b"", found.model, equations, left)

    assert wrong("", "") == ""
    for old, new, what in (
        ('axis="0 1 0"', 'axis="0 0 1"', "does not stand"),
        ('pos="0.3 0 0"', 'pos="0.2 0 0"', "another mass"),
        ('armature="0.1"', 'armature="0.2"', "inertia"),
        ('damping="0.3"', 'damping="0.4"', "pushed"),
        ('gear="3"', 'gear="-3"', "pushed"),
        ('stiffness="5"', 'stiffness="6"', "pushed"),
    ):
        assert what in wrong(old, new), old
    assert "there are none" in wrong("", "", (("motors by plugins", ("w",)),))
    for what in (OTHER_THINGS, "motors that are no linear laws", "motors on the ground"):
        assert "is left out, and is none" in wrong("", "", ((what, ("w",)),)), what
    motor, muscle = '<motor name="w" joint="p" gear="3"/>', '<muscle name="v" joint="h" lengthrange="-1 1"/>'
    laws = (("motors that are no linear laws", ("v",)),)
    assert wrong(motor, motor + muscle, laws) == ""  # what cannot be said pushes nothing, and all others do
    assert "pushed" in wrong(motor, motor.replace("3", "4") + muscle, laws)


@pytest.mark.slow
@needs(".mujoco", what="mujoco")
def test_what_an_mjcf_robot_leaves_out_is_there(tmp_path):
    """Each kind of bound of a motor, and motors that are switched off: said, and exit 0."""
    motors = '<actuator><motor name="w" joint="h" {}/></actuator>'
    tendon = '<tendon><fixed name="t" {}><joint joint="h" coef="1"/></fixed></tendon>'
    for of_joint, flags, more, what in (
        ("", "", motors.format('ctrlrange="-1 1"'), "limits of motors"),
        ("", "", motors.format('forcerange="-1 1"'), "limits of motors"),
        ('actuatorfrcrange="-1 1"', "", motors.format(""), "limits of motors"),
        ("", "", tendon.format('actuatorfrcrange="-1 1"') + motors.format(""), "limits of motors"),
        ("", "", tendon.format('range="-1 1"') + motors.format(""), "limits of tendons"),
        ("", '<option><flag actuation="disable"/></option>', motors.format(""), "motors that are switched off"),
        ("", '<option actuatorgroupdisable="0"/>', motors.format('group="0"'), "motors that are switched off"),
    ):
        path = tmp_path / "left.xml"
        path.write_text(
            f'<mujoco>{flags}<worldbody><body><joint name="h" axis="0 1 0" {of_joint}/><geom size="0.1" pos="0.3 0 0"/>'
            f"</body></worldbody>{more}</mujoco>"
        )
        result = CliRunner().invoke(main, ["import", str(path)])
        assert result.exit_code == 0, result.output
        assert what in {each.what for each in imported(path).left_out}


@pytest.mark.slow
@pytest.mark.skipif(not hasattr(os, "mkfifo"), reason="needs pipes of POSIX")
@pytest.mark.parametrize("kind", ["urdf", "sdf", pytest.param("xml", marks=needs(".mujoco", what="mujoco"))])
def test_a_robot_that_comes_through_a_pipe_is_read_once_and_looked_at_as_a_file_is(tmp_path, monkeypatch, kind):
    """Message of the second reading reads is what was read."""
    text = {"urdf": ARM, "sdf": SDF_ARM, "xml": MJCF_ARM}[kind]
    pipe = tmp_path / f"robot.{kind}"
    os.mkfifo(pipe)
    looked: list[object] = []
    for name in ("imported_otherwise", "sdf_otherwise", "mjcf_otherwise"):
        real = getattr(importing, name)
        monkeypatch.setattr(importing, name, lambda *given, real=real: (looked.append(given), real(*given))[1])
    writer = threading.Thread(target=pipe.write_text, args=(text,))
    writer.start()
    result = CliRunner().invoke(main, ["import", str(pipe)])
    writer.join(5)
    assert result.exit_code == 0 and looked, result.output
    assert text.encode() in looked[0]


MJCF_ARM = """<mujoco><worldbody><body name="a" pos="0 0 1">
  <joint name="h" axis="0 1 0" stiffness="5" damping="0.3" armature="0.1"/><geom size="0.1" pos="0.3 0 0"/>
  <body name="b" pos="0.5 0 0" euler="10 20 30"><joint name="p" type="slide" axis="1 0 .5"/>
  <geom type="box" size=".1 .2 .3"/></body></body>
  <body name="c" pos="1 0 2"><freejoint name="fly"/><geom type="ellipsoid" size="0.1 0.2 0.3"/></body></worldbody>
  <actuator><motor name="w" joint="p" gear="3"/></actuator></mujoco>"""


def test_what_an_import_writes_has_units(tmp_path):
    """[g] = m/s^2, hinges in rad, slides in m: one that is left out is told by its name."""
    text = robot(tmp_path, FOLLOWING).text
    assert without_units(eomgen.loads(text)) == ""
    for old, new, name in (
        ('{ value = 9.81, unit = "m/s^2" }', "9.81", "g"),
        ('unit = "rad", about = "joint s.0', 'about = "joint s.0', "s_0"),
    ):
        assert old in text and without_units(eomgen.loads(text.replace(old, new))) == f"'{name}' has no unit"


def test_every_push_that_urdf_cannot_say_is_told(tmp_path):
    """Beside the usual weight: springs, forces, loads of a coordinate, energies; and of what is told nothing lacks."""
    first = robot(tmp_path, ARM).text
    joined = "\n".join(
        [
            first,
            "[forces.pull]",
            'kind = "spring"',
            'points = ["fore.origin", "upper_arm.center"]',
            "stiffness = 3",
            "length = 0",
            "[forces.push]",
            'kind = "force"',
            'point = "fore.origin"',
            "force = [1, 0, 0]",
            "[forces.load]",
            'kind = "generalized"',
            'coordinate = "elbow"',
            "value = 2",
        ]
    )
    (tmp_path / "first.toml").write_text(joined)
    model = eomgen.load(tmp_path / "first.toml")
    found = urdf_of(model)
    left = {each.what: each.where for each in found.left_out}
    assert left["forces"] == ("pull", "push", "load") and unsaid_otherwise(found.text, model, left) == ""
    for what, names in left.items():
        assert what in unsaid_otherwise(found.text, model, left | {what: names[1:]}), what
    assert "weight" in unsaid_otherwise(found.text, model, left | {"forces": ("weight", *left["forces"])})


def test_what_is_exported_is_read_again(tmp_path):
    """Poses, weights, limits of the URDF are those of the model that it was written of."""
    (tmp_path / "first.toml").write_text(robot(tmp_path, FOLLOWING).text)
    model = eomgen.load(tmp_path / "first.toml")
    text = urdf_of(model).text
    assert imported_otherwise(text, model) == ""
    for old, new, what in (
        ('type="revolute"', 'type="continuous"', "limits"),
        ('xyz="0.0 0.0 0.4"', 'xyz="0.0 0.0 0.3"', "stand"),
        ('mass value="2.5"', 'mass value="2"', "another mass"),
    ):
        assert old in text and what in imported_otherwise(text.replace(old, new), model)
