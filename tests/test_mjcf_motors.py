"""Motors, rotors, constraints of MJCF: M and forces as MuJoCo computes them, or a line that names what was left out."""

from __future__ import annotations

import importlib
from typing import Any

import numpy as np
import pytest
from slow_run import sampled

import eomgen
from eomgen.errors import ModelError
from eomgen.symbolic.numeric.evaluation import FLOAT, evaluate
from tests.helpers.tools import needs
from tests.test_robots import robot

pytestmark = [pytest.mark.slow, needs(".mujoco", what="mujoco")]

BODIES = """<mujoco>{top}<worldbody>
<body name="a" pos="0 0 1"><joint name="h" axis="0 1 0"/><geom size=".1" pos=".3 0 0" mass="1"/>
  <site name="s" pos=".1 .2 .3" euler="10 20 30"/>
  <body name="b" pos=".5 0 0"><joint name="p" type="slide" axis="1 0 .5"/><geom size=".1" mass="2"/>
    <body name="c" pos=".1 0 .2" euler="20 0 40"><joint name="b" type="ball" {ball}/>
      <geom type="box" size=".1 .2 .3" mass="1"/><site name="s2" pos=".1 0 0"/></body></body></body>
<body name="f" pos="1 1 1"><joint name="fr" type="free" {free}/>
  <geom type="box" size=".1 .2 .3" pos=".1 .2 0" mass="1"/>
</body>
<body name="e" pos="1 0 1"><joint name="x" type="slide" axis="1 0 0"/><geom size=".1" mass="1"/></body>
<site name="g" pos="0 0 3"/></worldbody>
<tendon><fixed name="t1"><joint joint="h" coef="2"/></fixed>
  <fixed name="t2" {tendon}><joint joint="h" coef="2"/><joint joint="p" coef="-3"/><joint joint="x" coef="1"/></fixed>
  <spatial name="sp"><site site="g"/><site site="s2"/></spatial></tendon>{rest}</mujoco>"""
NAMES = {0: ("x", "y", "z", "e0", "e1", "e2", "e3"), 1: ("e0", "e1", "e2", "e3")}
RATES = {0: ("x'", "y'", "z'", "wx", "wy", "wz"), 1: ("wx", "wy", "wz")}


def text_of(rest: str = "", **given: str) -> str:
    return BODIES.format(**{"top": "", "ball": "", "free": "", "tendon": "", **given}, rest=rest)


def at_random(model: Any, text: str, w: float = 0.7, seed: int = 1) -> tuple[Any, ...]:
    """(M, Q - c) of a model and of MuJoCo at a random state, inputs w."""
    mujoco: Any = importlib.import_module("mujoco")
    m = mujoco.MjModel.from_xml_string(text)
    m.opt.disableflags |= mujoco.mjtDisableBit.mjDSBL_CONTACT
    d, rng = mujoco.MjData(m), np.random.default_rng(seed)
    d.qpos[:], d.qvel[:], d.ctrl[:] = rng.normal(size=m.nq), rng.normal(size=m.nv), w
    mujoco.mj_normalizeQuat(m, d.qpos)
    mujoco.mj_forward(m, d)
    columns = []
    for column in np.eye(m.nv):
        found = np.zeros(m.nv)
        mujoco.mj_mulM(m, d, found, column)
        columns.append(found)
    state: dict[str, float] = {}
    order: list[str] = []
    for j in range(m.njnt):
        name, kind = m.joint(j).name, int(m.jnt_type[j])
        q = [f"{name}_{x}" for x in NAMES[kind]] if kind in NAMES else [name]
        u = [f"{name}_{x}" for x in RATES[kind]] if kind in RATES else [f"{name}'"]
        state |= dict(zip(q, d.qpos[m.jnt_qposadr[j] :], strict=False))
        state |= dict(zip(u, d.qvel[m.jnt_dofadr[j] :], strict=False))
        order += u
    graph = eomgen.derive(model).graph
    s = graph.symbols
    known: dict[Any, Any] = {s.t: 0.0} | {x: float(state[x.name]) for x in (*s.q, *s.u)}
    known |= {x: w for x in s.inputs.values()} | {x: 9.81 for x in s.parameters.values()}
    flat = [*(x for row in graph.M for x in row), *(y - x for x, y in zip(graph.c, graph.Q, strict=True))]
    numbers = np.array(evaluate(flat, known, FLOAT), dtype=float)
    n, at = len(order), [[x.name for x in s.u].index(u) for u in order]
    forces = d.qfrc_actuator + d.qfrc_passive - d.qfrc_bias
    return numbers[: n * n].reshape(n, n)[np.ix_(at, at)], numbers[n * n :][at], np.array(columns), forces


def agrees(found: Any, text: str) -> bool:
    for seed in (1, 2):
        M, Q, M0, Q0 = at_random(found.model, text, seed=seed)
        assert np.allclose(M, M0, rtol=0, atol=1e-12 * abs(M0).max())
        assert np.allclose(Q, Q0, rtol=0, atol=1e-11 * abs(Q0).max())
    return True


def reported(found: Any) -> dict[str, tuple[str, ...]]:
    return {each.what: each.where for each in found.left_out if each.what != "geoms that touch"}


BOTH = 'armature=".5" damping=".3"'
MOTORS = {
    "on a hinge, by a gear": f'<motor name="w" joint="h" gear="2" {BOTH}/>',
    "on a tendon of one joint": f'<motor name="w" tendon="t1" gear="2" {BOTH}/>',
    "on a tendon of several joints, in two trees": f'<motor name="w" tendon="t2" gear="2" {BOTH}/>',
    "two on one": f'<motor name="w" joint="p" {BOTH}/><motor name="v" joint="p" gear="3" {BOTH}/>',
    "on a ball": f'<motor name="w" joint="b" gear="2 -1 3" {BOTH}/>',
    "on a ball, in the parent": f'<motor name="w" jointinparent="b" gear="2 -1 3" {BOTH}/>',
    "of the rate of a ball": '<velocity name="w" joint="b" gear="2 -1 3" kv="2"/>',
    "on a free body": f'<motor name="w" joint="fr" gear="1 2 3 4 5 6" {BOTH}/>',
    "on a free body, in the world": '<motor name="w" jointinparent="fr" gear="1 2 3 4 5 6"/>',
    "of the rate of a free body": '<general name="w" joint="fr" gear="1 0 3 0 5 6" '
    'biastype="affine" biasprm="1 0 -2"/>',
    "between two places": '<motor name="w" tendon="sp" gear="2" damping=".3"/>',
    "a servo between two places": '<position name="w" tendon="sp" gear="-2" kp="5" kv="2"/>',
}


@pytest.mark.parametrize("name", MOTORS)
def test_a_motor_weighs_and_resists_as_in_mujoco(name, tmp_path):
    """M and Q - c: gear^2 of its rotor and damper on whatever it acts, its push."""
    text = text_of(f"<actuator>{MOTORS[name]}</actuator>")
    found = robot(tmp_path, text, "xml")
    assert agrees(found, text) and not reported(found)


@pytest.mark.parametrize(
    ("motor", "what"),
    [
        (f'<motor name="w" joint="h" gear="2" group="1" {BOTH}/>', "motors that are switched off"),
        (f'<motor name="w" tendon="t2" group="1" {BOTH}/>', "motors that are switched off"),
        (f'<motor name="w" joint="b" group="1" gear="2 1 1" {BOTH}/>', "motors that are switched off"),
        (f'<muscle name="w" joint="h" gear="2" lengthrange="-1 1" {BOTH}/>', "motors that are no linear laws"),
        (f'<muscle name="w" tendon="t2" lengthrange="-1 1" {BOTH}/>', "motors that are no linear laws"),
        (f'<position name="w" joint="b" gear="2 1 1" kp="3" {BOTH}/>', "motors that are no linear laws"),
    ],
)
def test_a_motor_that_pushes_nothing_here_still_weighs_and_resists(motor, what, tmp_path):
    """Switched off by its group, or of a law that has no counterpart: M is MuJoCo's, so are the forces at ctrl 0."""
    text = text_of(f"<actuator>{motor}</actuator>", top='<option actuatorgroupdisable="1"/>')
    found = robot(tmp_path, text, "xml")
    M, Q, M0, Q0 = at_random(found.model, text)
    assert reported(found) == {what: ("w",)} and np.allclose(M, M0, rtol=0, atol=1e-12 * abs(M0).max())
    assert "off" not in what or np.allclose(Q, Q0, rtol=0, atol=1e-11 * abs(Q0).max())


@pytest.mark.parametrize(
    "given",
    [
        {"ball": 'armature=".5"'},
        {"free": 'armature=".5" damping=".2"'},
        {"ball": 'armature=".5" damping="2"', "free": 'armature="1"', "tendon": 'armature=".5" damping=".2"'},
        {"ball": 'damping="2"', "tendon": 'damping=".2"', "top": '<option><flag damper="disable"/></option>'},
    ],
)
def test_rotors_of_balls_free_bodies_and_tendons_are_in_m(given, tmp_path):
    """a |w|^2/2, a (|v|^2 + |w|^2)/2, a L'^2/2: M and Q - c as MuJoCo has them; dampers may be switched off."""
    text = text_of(f'<actuator><motor joint="h" {BOTH}/></actuator>', **given)
    found = robot(tmp_path, text, "xml")
    assert agrees(found, text) and not reported(found)


def test_limits_springs_and_plugins_are_told_by_name(tmp_path):
    """A tendon's limit of force, motors of plugins; each with what comes nearest."""
    limited = 'actuatorfrcrange="-.05 .05" actuatorfrclimited="true"'
    text = text_of('<actuator><motor name="w" tendon="t2" forcerange="-2 3"/></actuator>', tendon=limited)
    found = robot(tmp_path, text, "xml")
    listed = {each.what: each for each in found.left_out}
    assert reported(found)["limits of motors"] == ("w (-2 to 3)", "all at t2 (-0.05 to 0.05)")
    assert "max" in listed["limits of motors"].nearest
    plugin = """<mujoco><extension><plugin plugin="mujoco.pid"><instance name="p">
      <config key="kp" value="40"/></instance></plugin></extension>
      <worldbody><body><joint name="j" type="slide" axis="1 0 0"/><geom size=".1"/></body></worldbody>
      <actuator><plugin name="servo" joint="j" plugin="mujoco.pid" instance="p"/></actuator></mujoco>"""
    found = robot(tmp_path, plugin, "xml")
    assert reported(found) == {"motors by plugins": ("servo",)} and not found.model.inputs


@sampled(2)
@pytest.mark.parametrize("by", ["body1='b' body2='f' relpose='.2 .3 .1 .9 .1 .2 .3'", "site1='s2' site2='sf'"])
def test_bodies_that_are_welded_start_where_they_are(by, tmp_path):
    """A weld that gapes at the start: the start is moved to where phi = 0, and J spans MuJoCo's rows there."""
    text = text_of(f"<equality><weld name='w' {by}/></equality>").replace(
        'pos="1 1 1"><joint', 'pos="1 1 1"><site name="sf" pos=".1 .2 .3" euler="10 20 30"/><joint'
    )
    found = robot(tmp_path, text, "xml")
    assert found.model.constraints["w"].kind == "clamp" and "fr" in reported(found)["start where constraints gape"]
    equations = eomgen.derive(found.model)
    assert equations.certify().ok
    mujoco: Any = importlib.import_module("mujoco")
    m = mujoco.MjModel.from_xml_string(text)
    m.opt.jacobian = 0
    d, x = mujoco.MjData(m), dict(zip(equations.coordinates, equations.start(), strict=False))
    for j in range(m.njnt):
        name, kind = m.joint(j).name, int(m.jnt_type[j])
        names = [f"{name}_{part}" for part in NAMES[kind]] if kind in NAMES else [name]
        d.qpos[m.jnt_qposadr[j] : m.jnt_qposadr[j] + len(names)] = [x[one] for one in names]
    mujoco.mj_forward(m, d)
    assert abs(d.efc_pos[d.efc_type == 0]).max() < 1e-12


def test_a_weld_that_cannot_close_is_told(tmp_path):
    """Two bodies on hinges far apart."""
    text = text_of("<equality><weld name='w' body1='a' body2='e' relpose='9 9 9 1 0 0 0'/></equality>")
    found = robot(tmp_path, text, "xml")
    assert reported(found)["welds that cannot close"] == ("w",) and not found.model.constraints


@pytest.mark.parametrize(
    ("text", "what"),
    [
        (
            '<asset><hfield name="h" nrow="100000" ncol="100000" size="1 1 1 1"/></asset><worldbody/>',
            "<hfield> requests",
        ),
        ('<size nuser_body="1000000000"/><worldbody/>', "<size> requests"),
        (
            '<worldbody><replicate count="20000"><body><joint/></body></replicate></worldbody>',
            "replicas make more than",
        ),
        (
            '<worldbody><replicate count="100"><replicate count="100"><geom/></replicate></replicate></worldbody>',
            "replicas make more than",
        ),
        ('<worldbody><replicate count="2000">\n<include file="part.xml"/></replicate></worldbody>', "replicas make"),
    ],
)
def test_what_would_take_all_memory_or_time_is_refused_before_it_is_made(text, what, tmp_path):
    """Counted in the text, files that are included too: MuJoCo is not asked, which cannot be stopped."""
    (tmp_path / "part.xml").write_text("<mujocoinclude><body><joint/><geom/></body></mujocoinclude>")
    with pytest.raises(ModelError, match=what):
        robot(tmp_path, f"<mujoco>{text}</mujoco>", "xml")


def test_a_few_replicas_are_imported(tmp_path):
    """<replicate count="3">: three bodies; what stands in a comment is not counted."""
    text = """<mujoco><!-- <replicate count="20000"><body/> --><worldbody><replicate count="3" offset="1 0 0">
      <body><joint/><geom size=".1"/></body></replicate></worldbody></mujoco>"""
    assert len(robot(tmp_path, text, "xml").model.bodies) == 3


@pytest.mark.parametrize("law", ["2", "0 3", "0 0 2", "1 3 2"])
def test_springs_and_dampers_of_any_power_push_as_in_mujoco(law, tmp_path):
    """-(k + k1 x + k2 x^2) x and -(c + c1 |x'| + c2 x'^2) x' of hinges and slides; |d| of balls, free bodies."""
    text = text_of(ball=f'stiffness="{law}"', free=f'stiffness="{law}"')
    text = text.replace('name="h" axis', f'name="h" stiffness="{law}" damping="{law}" axis')
    text = text.replace('name="p" type', f'name="p" springref="0.2" stiffness="{law}" damping="{law}" type')
    text = text.replace('name="f" pos="1 1 1"', 'name="f" pos="1 1 1" euler="10 20 30"')
    found = robot(tmp_path, text, "xml")
    assert not reported(found) and agrees(found, text)


def test_the_spring_of_a_ball_rests_where_it_is_not_turned(tmp_path):
    """-k d with d = 2 v at rest: torque 0 there, and its slope is -2 k along each part of the quaternion."""
    text = """<mujoco><worldbody><body><joint name="b" type="ball" stiffness="3"/><geom size=".1" mass="1"/></body>
      </worldbody></mujoco>"""
    equations = eomgen.derive(robot(tmp_path, text, "xml").model)
    rhs = equations.rhs("numpy")
    x, I = equations.start(), 0.4 * 0.01
    assert rhs(0.0, x, rhs.p0, [])[4:] == pytest.approx([0, 0, 0], abs=1e-12)
    x[:4] = [np.cos(5e-4), 0, np.sin(5e-4), 0]
    assert rhs(0.0, x, rhs.p0, [])[4:] == pytest.approx([0, -3 * 1e-3 / I, 0], abs=1e-9)
