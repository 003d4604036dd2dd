"""A run carries its proof: each of its checks holds on the run, and sees an error that is planted for it."""

from __future__ import annotations

import json
import os
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from click.testing import CliRunner
from forked import needs_sh
from slow_run import in_slow_run, usual

import eomgen
from eomgen.cli import main
from eomgen.codegen import build
from eomgen.mechanics.kinematics.loads import Loads
from eomgen.proof import motion

pytestmark = pytest.mark.slow

MODELS = Path(__file__).parent.parent.parent / "models"
needs_cc = pytest.mark.skipif(build.compiler() is None, reason="no C compiler")


def run_of(name: str, **requested):
    return eomgen.simulate(eomgen.load(MODELS / f"{name}.toml"), time=1, target="numpy", **requested)


def bent(run, phase: int, change):
    """The run, the states of one of its phases changed: (t, x) -> x."""
    old = run.phases[phase]
    t, x = old.track
    phases = list(run.phases)
    changed = t, change(t, x.copy())
    phases[phase] = replace(old, tracked=lambda: changed)
    return replace(run, phases=tuple(phases))


def failing(run) -> set[str]:
    return {check.name for check in run.certify().checks if check.status == "fails"}


@pytest.mark.parametrize("name", usual(["simple_pendulum", "four_bar", "sliding_ladder", "gyrostat", "car_axis"], 2, 1))
def test_a_run_keeps_its_promises(name):
    """E - E0 is the integral of the power for pendulums, loops, contacts, quaternions and moving axes alike."""
    certificate = run_of(name).certify()
    assert certificate.ok, str(certificate)
    (energy,) = (check for check in certificate.checks if check.name == ENERGY)
    assert energy.status == "holds" and "|E - E0 - W| <= " in energy.detail


ENERGY = "E - E0 is the integral of the power"
STEPS = "steps repeated from states of the run end at its next states"


def test_a_run_that_loses_energy_is_seen():
    """A speed that is a part in 1e5 too slow in the end, energy T + V of the pendulum."""
    run = run_of("simple_pendulum")

    def slower(t, x):
        x[len(t) // 2 :, 1] *= 1 - 1e-5
        return x

    assert {ENERGY, STEPS} <= failing(bent(run, 0, slower))


def test_a_single_wrong_row_between_the_steps_is_seen():
    """One state of the run a millionth aside: no neighbour leads there."""
    run = run_of("simple_pendulum", samples=31)

    def aside(t, x):
        x[20, 0] += 1e-6
        return x

    assert STEPS in failing(bent(run, 0, aside))


@pytest.mark.parametrize("left_out", [0, 500, 1000])
def test_a_row_that_is_left_out_is_seen(left_out):
    """Every instant that was asked has a row: the first, one between, the last."""
    run = run_of("simple_pendulum")
    assert len(run.t) == 1001
    cut = replace(run, t=np.delete(run.t, left_out), x=np.delete(run.x, left_out, axis=0), reactions={}, outputs={})
    assert "a run has a row at every requested instant" in failing(cut)


def test_a_damper_that_is_forgotten_in_the_power_is_seen(monkeypatch):
    """E - E0 = integral of Q_nc . u: without Q_nc of the damper nothing accounts for what is lost."""
    assert eomgen.simulate(eomgen.loads(DAMPED), time=1, target="numpy").certify().ok
    monkeypatch.setattr(Loads, "powered_forces", (0,))
    run = eomgen.simulate(eomgen.loads(DAMPED), time=1, target="numpy")
    assert ENERGY in failing(run) and not run.ok


DAMPED = """
eomgen = 1
space = "plane"
[parameters]
m = 2
k = 30
c = 0.5
[coordinates]
x = { start = 0.3 }
[points]
O = [-1, 0]
[bodies.block]
shape = { kind = "particle", mass = "m" }
joint = { kind = "prismatic", axis = [1, 0], displacement = "x" }
[forces]
spring = { kind = "spring", points = ["O", "block.center"], stiffness = "k", length = 1 }
damper = { kind = "damper", points = ["O", "block.center"], damping = "c" }
"""


def test_a_jump_without_impulse_is_seen():
    """The ladder leaves the wall a thousandth faster than it came there: dP is no impulse of floor and wall."""

    def faster(t, x):
        x[:, 2:] *= 1.001
        return x

    assert "changes of contact follow impulses that only push" in failing(bent(run_of("sliding_ladder"), 1, faster))


def test_a_loop_that_opens_is_seen():
    """The dependent angle of the coupler 1e-5 aside: the eliminated rows open."""

    def aside(t, x):
        x[-1, 1] += 1e-5
        return x

    assert "the constraints are satisfied" in failing(bent(run_of("four_bar"), 0, aside))


def test_a_quaternion_that_loses_its_norm_is_seen():
    """e . e = 1"""
    run = run_of("gyrostat")
    (four, *_) = eomgen.derive(eomgen.load(MODELS / "gyrostat.toml")).system.scope.quaternions
    places = [run.coordinates.index(e.name) for e in four]

    def longer(t, x):
        x[-1, places] *= 1 + 1e-5
        return x

    assert "quaternions keep their norm" in failing(bent(run, 0, longer))


@needs_cc
@needs_sh
def test_a_compiler_that_bends_sine_is_seen(monkeypatch, tmp_path):
    """C's numbers are put into the equations with 50 digits: exit 3, the result is shown and marked."""
    script = tmp_path / "cc"
    script.write_text(f'#!/bin/sh\nexec {build.compiler()} -Dsin=tanh "$@"\n')
    script.chmod(0o755)
    monkeypatch.setenv("CC", str(script))
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path))
    words = ["simulate", str(MODELS / "simple_pendulum.toml"), "--target", "c", "--time", "1", "--json"]
    found = CliRunner().invoke(main, words)
    assert found.exit_code == 3
    certificate = json.loads(found.stdout)["certificate"]
    assert certificate["ok"] is False
    assert "the code that ran (c) gives the symbols' numbers" in wrong_of(certificate)
    assert json.loads(CliRunner().invoke(main, [*words, "--no-certify"]).stdout)["certificate"] is None
    assert os.environ["CC"] == str(script)


def wrong_of(certificate) -> set[str]:
    return {check["name"] for check in certificate["checks"] if check["status"] == "fails"}


def test_a_drift_beyond_the_tolerances_is_exit_3(monkeypatch):
    """Angles near 1e15 rad are 0.125 apart in doubles: energy goes with them, were the start not refused before."""
    monkeypatch.setattr("eomgen.simulation.motion._refuse_coarse", lambda phase, t, x: None)
    words = ["simulate", str(MODELS / "double_pendulum.toml"), "--target", "numpy", "--time", "0.2", "--json"]
    found = CliRunner().invoke(main, [*words, "--start", "theta1=1e15", "--start", "theta2=0.5"])
    assert found.exit_code == 3 and ENERGY in wrong_of(json.loads(found.stdout)["certificate"])


def test_an_integral_that_is_not_sure_judges_nothing(monkeypatch):
    """Where the error of the quadrature is near the limit, the energy is unchecked, not wrong."""
    monkeypatch.setattr(motion, "SURE", 0.0)
    run = eomgen.simulate(eomgen.loads(DAMPED), time=1, target="numpy")
    (energy,) = (check for check in run.certify().checks if check.name == ENERGY)
    assert energy.status == "unchecked" and "not sure" in energy.detail


@pytest.mark.parametrize("name", ["four_bar", "sliding_ladder"])
def test_a_column_of_reactions_that_is_wrong_is_seen(name):
    """A thousandth too large, in one phase or another."""
    run = run_of(name)
    columns = {key: column * 1.001 for key, column in run.reactions.items()}
    assert failing(replace(run, reactions=columns)) == {"columns of reactions are those of the free bodies"}


@in_slow_run
def test_rows_that_pull_are_proven_with_their_power():
    """Baumgarte's rows take power lam . (J u + sigma) where constraints are open; the equations themselves hold as
    derived."""
    certificate = run_of("bricard", stabilization="baumgarte").certify()
    assert certificate.ok, str(certificate)


TETHER = """
eomgen = 1
space = "plane"
parameters = { GM = 3.986004418e14, m1 = 500, m2 = 100, L = 20000, r0 = 6.8e6, w = "sqrt(GM/r0)/r0" }
points.O = [0, 0]
constraints.tether = { kind = "link", points = ["a.center", "b.center"], length = "L" }
[coordinates]
x1 = { start = "r0" }
y1 = { start = 0, speed = "w*r0" }
x2 = { start = "r0 + L*cos(0.3)", speed = "-w*L*sin(0.3)" }
y2 = { start = "L*sin(0.3)", speed = "w*(r0 + L*cos(0.3))" }
"""


@pytest.mark.parametrize("target", ["numpy", pytest.param("c", marks=needs_cc)])
def test_a_tie_between_places_far_away_is_kept_as_far_as_their_digits_go(target):
    """Satellites on a tether of 20 km: places of 7e6 m have 1e-9 m, and T = m1 m2/(m1 + m2) (n (g_2 - g_1) + w^2 L)."""
    text = TETHER
    for body, m, n in (("a", "m1", 1), ("b", "m2", 2)):
        text += f"""
    [bodies.{body}]
    shape = {{ kind = "particle", mass = "{m}" }}
    joint = {{ kind = "placed", at = ["x{n}", "y{n}"] }}
    [forces.on_{body}]
    kind = "between"
    points = ["O", "{body}.center"]
    pull = "GM*{m}/r^2"
    """
    run = eomgen.simulate(eomgen.loads(text), time=3000, target=target)
    assert run.ok and "could not be closed" not in run.message and run.certify().ok, run.message
    p1, p2, v1, v2 = (np.array([run[f"{c}{n}{dot}"][-1] for c in "xy"]) for dot in ("", "'") for n in (1, 2))
    g1, g2 = (-3.986004418e14 * p / np.hypot(*p) ** 3 for p in (p1, p2))
    n = (p2 - p1) / 20000
    assert np.hypot(*(p2 - p1)) == pytest.approx(20000, abs=1e-6)
    tension = 500 * 100 / 600 * (n @ (g2 - g1) + (v2 - v1) @ (v2 - v1) / 20000)
    assert run["tension(tether)"][-1] == pytest.approx(tension, rel=1e-7)
