"""Inverse dynamics: the forces that given accelerations take are those that give these accelerations."""

from __future__ import annotations

import importlib.util
import json
import subprocess
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from click.testing import CliRunner
from random_systems import random_model
from slow_run import sampled, usual

import eomgen
from eomgen.cli import main
from eomgen.codegen.build import compiler
from eomgen.codegen.program import Program
from eomgen.codegen.rhs import RightHandSide
from eomgen.codegen.written_files import vectors
from eomgen.errors import DerivationError, UsageError
from eomgen.mechanics.dynamics import formulations as projection
from eomgen.model.fields import Table

pytestmark = pytest.mark.slow

MODELS = Path(__file__).parent.parent.parent / "models"
TREES = (
    "arm3 arm7 cart_pole chain20 double_pendulum elastic_pendulum gyrostat quadrotor simple_pendulum spherical_pendulum"
)


def load(name: str) -> eomgen.Model:
    return eomgen.load(MODELS / f"{name}.toml")


def pushed(model: eomgen.Model, coordinates: list[str]) -> eomgen.Model:
    """The model with an input for the force along each of the coordinates."""
    inputs = {f"push_{q}": eomgen.Input(value=0) for q in coordinates}
    forces = {f"push_{q}": eomgen.forces.Generalized(coordinate=q, value=f"push_{q}") for q in coordinates}
    return model.altered(inputs=Table({**model.inputs, **inputs}), forces=Table({**model.forces, **forces}))


# -- trees ----------------------------------------------------------------------------------------


def test_two_links_take_the_torques_of_the_textbook():
    """tau = D(q) q'' + C(q, q') q' + g(q) of the planar elbow arm.

    Source: Spong, Hutchinson & Vidyasagar, Robot Modeling and Control (2006), section 7.3, eq. 7.87.
    """
    model = eomgen.loads("""
        eomgen = 1
        space = "plane"
        parameters = { m1 = 1.3, m2 = 0.7, l1 = 0.6, l2 = 0.5, c1 = 0.25, c2 = 0.2, I1 = 0.05, I2 = 0.02, g = 9.81 }
        coordinates = { q1 = 0, q2 = 0 }
        [bodies.upper]
        mass = "m1"
        center = ["c1", 0]
        inertia = "I1"
        points = { elbow = ["l1", 0] }
        joint = { kind = "revolute", angle = "q1" }
        [bodies.fore]
        mass = "m2"
        center = ["c2", 0]
        inertia = "I2"
        joint = { kind = "revolute", on = "upper.elbow", angle = "q2" }
        [forces]
        weight = { kind = "gravity", acceleration = [0, "-g"] }
    """)
    inverse = eomgen.inverse_dynamics(model)
    function = inverse.function()
    p = eomgen.derive(model).rhs().p0
    m1, m2, l1, _, c1, c2, I1, I2, g = p
    rng = np.random.default_rng(1)
    for q1, q2, u1, u2, a1, a2 in rng.uniform(-2, 2, (20, 6)):
        d11 = m1 * c1**2 + m2 * (l1**2 + c2**2 + 2 * l1 * c2 * np.cos(q2)) + I1 + I2
        d12, d22 = m2 * (c2**2 + l1 * c2 * np.cos(q2)) + I2, m2 * c2**2 + I2
        h = -m2 * l1 * c2 * np.sin(q2)
        phi1 = (m1 * c1 + m2 * l1) * g * np.cos(q1) + m2 * c2 * g * np.cos(q1 + q2)
        first = d11 * a1 + d12 * a2 + 2 * h * u1 * u2 + h * u2**2 + phi1
        second = d12 * a1 + d22 * a2 - h * u1**2 + m2 * c2 * g * np.cos(q1 + q2)
        assert function(0, [q1, q2, u1, u2], [a1, a2], p) == pytest.approx([first, second], rel=1e-12, abs=1e-12)
    assert inverse.names == ("q1", "q2")
    assert {symbol.name for symbol in inverse.tau["q2"].free_symbols} >= {"q1''", "q2''", "q1'"}


def agrees_with_projection(model: eomgen.Model) -> None:
    """tau = M a + c - Q, the latter from the twists of the bodies."""
    equations = eomgen.derive(model)
    inverse = equations.inverse_dynamics()
    system, assembly = equations.system, projection.assembled_by_wrenches(equations.system)
    needed = (
        sum((m * a for m, a in zip(row, system.symbols.a, strict=True)), start=-Q)
        for row, Q in zip(assembly.M, assembly.forcing, strict=True)
    )
    other = RightHandSide.of(
        Program.of(tuple(needed), system.symbols, inputs=system.inputs, accelerations=system.symbols.a), "numpy"
    )
    function = inverse.function("numpy")
    for vector in vectors(inverse.program):
        tau = function(vector.t, vector.x, vector.a, vector.p, vector.inputs or ())
        right = other(vector.t, [*vector.x, *vector.a], vector.p, vector.inputs or ())
        assert np.abs(tau - right).max() <= 1e-10 * max(1, np.abs(right).max())


@pytest.mark.parametrize("name", TREES.split())
def test_the_recursion_gives_what_the_twists_of_the_bodies_give(name):
    agrees_with_projection(load(name))


@sampled(3)
@pytest.mark.parametrize("seed", range(12))
@pytest.mark.parametrize("space", ["plane", "space"])
def test_the_recursion_gives_the_same_for_random_trees(space, seed):
    """Armatures, springs, driven joints, moving seats, inputs."""
    agrees_with_projection(eomgen.loads(random_model(space, 500 + seed)))


@pytest.mark.parametrize("name", ["arm3", "arm7", "cart_pole", "double_pendulum", "gyrostat", "spherical_pendulum"])
def test_computed_torques_give_back_the_accelerations(name):
    """rhs(t, x, p, inputs = tau(a)) = a."""
    model = load(name)
    equations = eomgen.derive(model)
    rated = [q for q in equations.coordinates if f"{q}'" in equations.speeds]
    rhs = eomgen.derive(pushed(model, rated)).rhs()
    function = equations.inverse_dynamics().function()
    rng = np.random.default_rng(2)
    own = [0.5] * len(model.inputs)
    for _ in range(5):
        x = rhs.x0 + rng.uniform(-0.3, 0.3, len(rhs.x0))
        free = rhs(0, x, rhs.p0)[len(equations.coordinates) :]
        requested = [u in {f"{q}'" for q in rated} for u in equations.speeds]
        tau_free = function(0, x, free, rhs.p0)
        assert np.abs(tau_free).max() < 1e-8 * max(1, np.abs(free).max())
        if all(requested):
            a = rng.uniform(-3, 3, len(free))
            tau = function(0, x, a, rhs.p0, own)
            found = rhs(0, x, rhs.p0, [*own, *tau])[len(equations.coordinates) :]
            assert found == pytest.approx(a, rel=1e-7, abs=1e-7)


def test_the_arm_of_seven_axes_takes_no_more_than_the_recursion_of_newton_and_euler():
    """779 operations are the figure of a plain recursion over this arm; M alone is not formed."""
    equations = eomgen.derive(load("arm7"))
    assert equations.inverse_dynamics().program.count.total <= 620
    assert equations.inverse_dynamics().program.count.total < 0.55 * equations.program.count.total


def test_inverse_dynamics_of_a_chain_grows_with_its_length_only():
    """O(n): 20 links take at most 2.2 times what 10 links take."""
    counts = []
    for n in (10, 20):
        links = "\n".join(
            f'[bodies.b{k}]\nshape = {{ kind = "rod", mass = "m", length = "l" }}\n'
            f'joint = {{ kind = "revolute"{f", on = {chr(34)}b{k - 1}.end{chr(34)}" if k else ""}, angle = "q{k}" }}'
            for k in range(n)
        )
        angles = "\n".join(f"q{k} = 0" for k in range(n))
        text = f'eomgen = 1\nspace = "plane"\nparameters = {{ m = 1, l = 1 }}\n[coordinates]\n{angles}\n{links}'
        counts.append(eomgen.inverse_dynamics(eomgen.loads(text)).program.count.total)
    assert counts[1] <= 2.2 * counts[0]


# -- loops ----------------------------------------------------------------------------------------

FOUR_BAR = (MODELS / "four_bar.toml").read_text().replace("dependent = true, near", "start")
TWICE = FOUR_BAR + '\n[constraints.again]\nkind = "pin"\npoints = ["rocker.end", "coupler.end"]\n'
LOOPS = {
    "eliminated": ((MODELS / "four_bar.toml").read_text(), ["alpha"]),
    "eliminated, moved by what depends": ((MODELS / "four_bar.toml").read_text(), ["gamma"]),
    "multipliers": (FOUR_BAR, ["alpha"]),
    "multipliers, moved at the rocker": (FOUR_BAR, ["gamma"]),
    "a constraint said twice": (TWICE, ["beta"]),
    "slider-crank": ((MODELS / "slider_crank.toml").read_text(), ["x"]),
}


@pytest.mark.parametrize(
    "target", ["numpy", pytest.param("c", marks=pytest.mark.skipif(compiler() is None, reason="no C compiler"))]
)
@pytest.mark.parametrize("name", LOOPS)
def test_torques_come_back_from_the_accelerations_that_they_give(name, target):
    """tau -> a = rhs(tau) -> inverse(a) = tau, where constraints close and follow from one another."""
    text, actuated = LOOPS[name]
    model = eomgen.loads(text)
    rhs = eomgen.derive(pushed(model, actuated)).rhs("numpy")
    equations = eomgen.derive(model)
    inverse = equations.inverse_dynamics(actuated)
    function = inverse.function(target)
    for tau in (-7.0, 0.0, 40.0):
        a = rhs(0, rhs.x0, rhs.p0, [tau])[len(equations.coordinates) :]
        assert function(0, rhs.x0, a, rhs.p0) == pytest.approx([tau], rel=1e-9, abs=1e-8)
    if "twice" in name:
        with pytest.raises(DerivationError, match="share their forces"):
            inverse.graph.explicit()


def test_a_platform_on_six_legs_gives_back_the_forces_of_its_drives():
    """Inputs are the actuators: six drives, eighteen constraint rows."""
    model = load("stewart_platform")
    equations = eomgen.derive(model)
    inverse = equations.inverse_dynamics(list(model.inputs))
    assert inverse.inputs == ()
    rhs, function = equations.rhs(), inverse.function()
    rng = np.random.default_rng(3)
    for _ in range(3):
        forces = rng.uniform(-400, 400, len(model.inputs))
        a = rhs(0, rhs.x0, rhs.p0, forces)[len(equations.coordinates) :]
        assert function(0, rhs.x0, a, rhs.p0) == pytest.approx(forces, rel=1e-8)


def test_the_torque_in_a_joint_is_asked_by_its_body():
    """With angles against the ground, a torque in the elbow acts along both: tau_2 = M_elbow, tau_1 = -M_elbow."""
    model = load("double_pendulum")
    equations = eomgen.derive(model)
    along, joints = equations.inverse_dynamics(), equations.inverse_dynamics(["arm1", "arm2"])
    x, a, p = [0.3, 0.8, 1.0, -2.0], [2.0, 5.0], equations.rhs().p0
    first, second = along.function()(0, x, a, p)
    relative = "theta2 - theta1" in (MODELS / "double_pendulum.toml").read_text()
    expected = [first + second, second] if relative else [first, second]
    assert joints.function()(0, x, a, p) == pytest.approx(expected, rel=1e-12)


@pytest.mark.parametrize(
    ("text", "driven", "name"),
    [
        ((MODELS / "four_bar.toml").read_text(), "alpha", "eliminated"),
        (FOUR_BAR, "alpha", "multipliers"),
        ((MODELS / "slider_crank.toml").read_text(), "theta", "slider-crank"),
    ],
)
def test_the_work_of_a_drive_in_a_loop_is_the_energy_that_it_brings(text, driven, name):
    """int drive dq = change of T + V, less the work of the gas on the piston; inverse dynamics gives the same drive."""
    free = eomgen.loads(text)
    law = eomgen.Coordinate(motion="1 + 4*t + sin(3*t)/5")
    model = free.altered(coordinates=Table({**free.coordinates, driven: law}))
    run = eomgen.simulate(model, time=1, samples=2001)
    rate = 4 + 3 * np.cos(3 * run.t) / 5
    power = run[f"drive({driven})"] * rate
    if "P" in free.parameters:
        power = power - 30 * np.gradient(run["x"], run.t, edge_order=2)
    work = np.concatenate([[0], np.cumsum((power[1:] + power[:-1]) / 2 * np.diff(run.t))])
    assert np.abs(work - (run.energy - run.energy[0])).max() < 1e-5 * np.ptp(run.energy)
    equations = eomgen.derive(free)
    speeds = [np.gradient(run[q], run.t, edge_order=2) for q in equations.coordinates]
    rows = [k for k, u in enumerate(equations.coordinates) if f"{u}'" in equations.speeds]
    a = np.array([np.gradient(v, run.t, edge_order=2) for v in speeds])[rows][:, 900]
    x = [run[q][900] for q in equations.coordinates] + [speeds[k][900] for k in rows]
    tau = equations.inverse_dynamics([driven]).function()(0, x, a, equations.rhs().p0)
    assert tau == pytest.approx([run[f"drive({driven})"][900]], rel=1e-3)


# -- what cannot be answered ----------------------------------------------------------------------

WITH_FRICTION = """
eomgen = 1
space = "plane"
[coordinates]
x = { start = 0, speed = 1 }
[bodies.block]
shape = { kind = "rectangle", mass = 1, width = 1, height = 1 }
joint = { kind = "placed", at = ["x", 0.5] }
[constraints.floor]
kind = "support"
point = "block.center"
normal = [0, 1]
friction = 0.3
[forces.weight]
kind = "gravity"
acceleration = [0, -9.81]
"""


@pytest.mark.parametrize(
    ("text", "actuated", "what"),
    [
        (FOUR_BAR, [], "constraints close loops, and nothing says which coordinates are actuated"),
        (FOUR_BAR, ["alpha", "beta"], "2 actuated, and 1 degrees of freedom: the forces of the actuators are"),
        (FOUR_BAR, ["alpha", "alpha"], "the forces of the actuators are"),
        (FOUR_BAR, ["alhpa"], "there is no coordinate, speed, input or hinged body 'alhpa'"),
        ((MODELS / "cart_pole.toml").read_text(), ["x"], "1 would have no actuator"),
        ((MODELS / "quadrotor.toml").read_text(), ["f1", "f2", "f3", "f4"], "2 would have no actuator"),
        (WITH_FRICTION, [], "Coulomb friction"),
        (
            WITH_FRICTION.replace("{ start = 0, speed = 1 }", '{ motion = "t" }').replace("friction = 0.3", ""),
            [],
            "nothing is free to move",
        ),
    ],
)
def test_what_has_no_single_answer_is_refused(text, actuated, what):
    with pytest.raises((UsageError, DerivationError), match=what):
        eomgen.derive(eomgen.loads(text)).inverse_dynamics(actuated)


# -- files ----------------------------------------------------------------------------------------


@pytest.mark.skipif(compiler() is None, reason="no C compiler")
@pytest.mark.parametrize(
    ("name", "options"),
    usual([("arm7", ["--inverse"]), ("cart_pole", ["--inverse"]), ("four_bar", ["--actuated", "alpha"])], 2, 1),
)
def test_emitted_inverse_dynamics_compiles_as_it_is_and_agrees(tmp_path, name, options):
    """Every warning an error; the files' own vectors, held against the recursion in 50 digits; numpy alike."""
    for target in ("c", "numpy"):
        done = CliRunner().invoke(
            main, ["codegen", str(MODELS / f"{name}.toml"), "--target", target, "-o", str(tmp_path), *options]
        )
        assert done.exit_code == 0, done.output
    cc = ["cc", "-std=c99", "-Wall", "-Wextra", "-pedantic", "-Werror"]
    subprocess.run(
        [*cc, "-DEOMGEN_SELFTEST", "-o", str(tmp_path / "a"), str(tmp_path / f"{name}_inverse.c"), "-lm"], check=True
    )
    subprocess.run([str(tmp_path / "a")], check=True)
    both = [str(tmp_path / f"{name}_{kind}.c") for kind in ("rhs", "reactions", "inverse")]
    subprocess.run([*cc, "-shared", "-fPIC", "-o", str(tmp_path / "all.so"), *both, "-lm"], check=True)
    reported = json.loads((tmp_path / "test_vectors.json").read_text())["inverse"]
    spec = importlib.util.spec_from_file_location("emitted", tmp_path / f"{name}_inverse.py")
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    function = getattr(module, f"{name}_inverse")
    assert len(reported["vectors"]) >= 4
    for v in reported["vectors"]:
        found = function(v["t"], v["x"], v["a"], v["p"], v["inputs"])
        assert np.abs(np.array(found) - v["tau"]).max() <= v["tolerance"] * max(1, *map(abs, v["tau"]))
        assert len(v["a"]) == len(reported["accelerations"])


def test_names_of_parameters_do_not_meet_those_of_the_arrays(tmp_path):
    """Parameters a and tau beside the arrays a and tau."""
    text = """
        eomgen = 1
        space = "plane"
        parameters = { a = 0.3, tau = 2, m = 1 }
        coordinates = { q = 0.1 }
        [bodies.rod]
        shape = { kind = "rod", mass = "m", length = "a" }
        joint = { kind = "revolute", angle = "q", stiffness = "tau" }
    """
    model = eomgen.loads(text)
    inverse = eomgen.inverse_dynamics(model)
    for target in ("numpy", *(["c"] if compiler() else [])):
        found = inverse.function(target)(0, [0.1, 5], [3], [0.3, 2, 1])
        assert found == pytest.approx([0.09 / 3 * 3 + 0.2], rel=1e-14)


@pytest.mark.parametrize("name", ["double_pendulum", "arm3", "cart_pole", "puma560"])
def test_along_a_given_motion_it_gives_what_drives_that_motion(name):
    """tau(t) of prescribed coordinates is drive(q) of the model whose coordinates move so; by a spline nearly so."""
    model = eomgen.load(Path(__file__).parents[2] / "models" / f"{name}.toml")
    laws = {q: f"0.{k}*sin({k}*t) + 0.1*t" for k, q in enumerate(model.coordinates, start=1)}
    moved = {q: eomgen.Coordinate(motion=law) for q, law in laws.items()}
    still = {each: replace(part, value=0) for each, part in model.inputs.items()}
    requested = {f"d{k}": eomgen.Output(value=f"drive({q})") for k, q in enumerate(laws)}
    changed = {"inputs": Table(still)} if still else {}
    driven = replace(model, coordinates=Table(moved), outputs=Table(requested), linearize=None, **changed)
    t = np.linspace(0, 2, 201)
    run = eomgen.simulate(driven, time=2, samples=t)
    inverse = eomgen.inverse_dynamics(replace(model, **changed))
    tau, spline = inverse.along(t, laws), inverse.along(t, {q: run[q] for q in laws})
    for k, q in enumerate(laws):
        assert tau[q] == pytest.approx(run[f"d{k}"], rel=1e-8, abs=1e-8)
        assert spline[q][20:-20] == pytest.approx(tau[q][20:-20], rel=1e-2, abs=1e-2 * np.abs(tau[q]).max())


def test_a_motion_that_is_none_is_refused():
    model = eomgen.load(Path(__file__).parents[2] / "models" / "double_pendulum.toml")
    first, second = model.coordinates
    inverse, t = eomgen.inverse_dynamics(model), np.linspace(0, 1, 5)
    for motion, message in (
        ({first: "sin(t)"}, f"'{second}' has no motion"),
        ({first: "sin(t)", second: f"2*{first}"}, f"depends on '{first}'"),
        ({first: "sin(t)", second: [1, 2]}, "2 values at 5 instants"),
        ({first: "sin(t)", "other": "t"}, "no coordinate 'other'"),
    ):
        with pytest.raises((eomgen.UsageError, eomgen.ModelError), match=message):
            inverse.along(t, motion)
