"""Robot files of other programs: what they mean, what they lack, what is left out."""

from __future__ import annotations

import json
from typing import Any

import numpy as np
import pytest
from click.testing import CliRunner

import eomgen
from eomgen.cli import main
from eomgen.errors import ModelError
from eomgen.robots.importing import imported
from eomgen.symbolic.numeric.evaluation import FLOAT, evaluate
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
    """Legal names beside the file's own, parts of pi, inertia in body axes, limits as remarks, motors as inputs."""
    found = robot(tmp_path, ARM)
    arm, elbow = found.model.bodies["upper_arm"], found.model.bodies["fore"].joint
    assert arm.about == "link upper arm" and arm.joint.turned[0].angle.text == "pi/2"
    assert [x.text for x in arm.inertia] == ["0.02", "0.03", "0.01"] and arm.joint.torque.text == "tau_shoulder"
    assert [x.text for x in elbow.axis] == [
        "1",
        "0",
        "0",
    ] and elbow.torque is None  # the default
    assert found.model.coordinates["shoulder"].about == "from -1.5 to 2 rad, at most 30 N*m, at most 4 rad/s"
    assert found.model.constraints["mimic_elbow"].gap.text == "elbow + 2*shoulder - 0.25"
    assert found.model.bodies["tool"].mass is None and arm.joint.damping.text == "0.3"


def test_what_has_no_counterpart_is_listed_and_never_dropped_silently(tmp_path):
    """Every element and attribute that nobody read: in `left_out`, on stderr, at the end of the file."""
    strange = ARM.replace("</robot>", '<magnet strength="3"/></robot>').replace('upper="2"', 'upper="2" soft="1"')
    found = robot(tmp_path, strange)
    assert {each.what for each in found.left_out} == {"visual", "friction", "magnet", "soft of <limit>"}
    assert found.text.rstrip().splitlines()[-1].startswith("# left out: magnet")
    path = tmp_path / "out.toml"
    result = CliRunner().invoke(main, ["import", str(tmp_path / "robot.urdf"), "-o", str(path), "--json"])
    listed = json.loads(result.stdout)["left_out"]
    assert [each["what"] for each in listed] == [each.what for each in found.left_out]
    assert result.stderr.count("left out: ") == 4 and path.read_text() == found.text
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
            "names a link that there is not: 'for'\nmend: did you mean 'fore'?",
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
    """file:line:column, what is wrong, how to mend it."""
    with pytest.raises(ModelError) as caught:
        robot(tmp_path, ARM.replace(*change, 1))
    assert what in str(caught.value) and "robot.urdf:" in str(caught.value) and "mend: " in str(caught.value)


def test_a_file_that_is_no_robot_is_refused(tmp_path):
    """xacro is to be expanded first; other XML, and files that are not there, are named."""
    with pytest.raises(ModelError, match="no <link>"):
        robot(tmp_path, '<robot xmlns:xacro="x"><xacro:include filename="a"/></robot>')
    with pytest.raises(ModelError, match="the root is <svg>"):
        robot(tmp_path, "<svg/>")
    with pytest.raises(ModelError, match="cannot be read"):
        eomgen.import_robot(tmp_path / "nothing.urdf")
