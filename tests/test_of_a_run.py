"""What is asked of a whole run: extremes, means, periods and events are those of the motion, not of its samples."""

from __future__ import annotations

import json
import math
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from click.testing import CliRunner
from scipy.special import ellipj, ellipk

import eomgen
from eomgen.cli import main
from eomgen.errors import UsageError
from eomgen.model import Requests
from eomgen.model.fields import Table
from eomgen.proof.runs import SamplesOfRun
from eomgen.simulation.event_location import ChebyshevPieces, resolved_curve

pytestmark = pytest.mark.slow

MODELS = Path(__file__).parents[1] / "models"

OSCILLATOR = """
eomgen = 1
space = "plane"
parameters = { m = 2, k = 50, F = 3 }
coordinates = { x = 0.3 }
points = { O = [0, 0] }
inputs = { drive = "F*cos(2*t)" }
bodies.mass.shape = { kind = "particle", mass = "m" }
bodies.mass.joint = { kind = "prismatic", axis = [1, 0], displacement = "x" }
forces.spring = { kind = "spring", points = ["O", "mass.origin"], stiffness = "k", length = 0 }
forces.push = { kind = "force", point = "mass.origin", force = ["drive", 0] }
"""

PENDULUM = """
eomgen = 1
space = "plane"
parameters = { m = 1, l = 1, g = 9.81 }
coordinates = { q = { start = 2, unit = "rad" } }
bodies.rod.joint = { kind = "revolute", angle = "q - pi/2" }
bodies.rod.points = { end = ["l", 0] }
bodies.bob.shape = { kind = "particle", mass = "m" }
bodies.bob.joint = { kind = "fixed", on = "rod.end" }
forces.weight = { kind = "gravity", acceleration = [0, "-g"] }
"""


@pytest.fixture(scope="module")
def swing():
    """A pendulum let go at 2 rad: q = 2 asin(k sn), k = sin 1; few samples."""
    return eomgen.simulate(eomgen.loads(PENDULUM), time=11.3, samples=7, rtol=1e-12, atol=1e-12)


def test_an_extreme_lies_between_the_samples(swing):
    """q'^2 = 2 g/l (cos q - cos 2): the fastest at q = 0; the string pulls with m g (3 - 2 cos 2) there."""
    k = math.sin(1)
    fastest = 2 * k * math.sqrt(9.81)
    assert swing.ask("max(q')").value == pytest.approx(fastest, rel=1e-9)
    assert swing.ask("max(q')").value > 1.0001 * np.max(swing["q'"])
    assert swing.ask("max(abs(q'))").value == pytest.approx(fastest, rel=1e-9)
    assert swing.ask("min(q)").value == pytest.approx(-2, rel=1e-9)
    force = "sqrt(reaction_x(rod)^2 + reaction_y(rod)^2)"
    assert swing.ask(f"max({force})/(m*g)").value == pytest.approx(3 - 2 * math.cos(2), rel=1e-9)


def test_period_and_passages_are_those_of_the_elliptic_integral(swing):
    """T = 4 K(sin 1) sqrt(l/g); q = 0 at T/4, 3T/4, ...; q' = 0 at T/2, T, ..."""
    T = 4 * ellipk(math.sin(1) ** 2) / math.sqrt(9.81)
    assert swing.ask("period(q)").value == pytest.approx(T, rel=1e-9)
    passages = swing.ask("t at q = 0, event every")
    assert passages.t == pytest.approx([(n + 0.5) * T / 2 for n in range(len(passages.t))], rel=1e-9)
    assert passages.value == pytest.approx(passages.t) and len(passages.t) == math.floor(11.3 / T * 2 + 0.5)
    assert swing.ask("t at q' = 0").value == pytest.approx(T / 2, rel=1e-8)
    assert swing.ask("t at q' = 0, event 3").value == pytest.approx(1.5 * T, rel=1e-8)
    assert swing.ask("q' at q = 0, event 2").value == pytest.approx(2 * math.sin(1) * math.sqrt(9.81), rel=1e-9)
    late = swing.ask("q at q' = 0, event 99")
    assert late.value is None and "is met" in late.message
    assert swing.ask("time_of_min(q)").value in [pytest.approx((n + 0.5) * T, rel=1e-6) for n in range(6)]


def test_means_are_integrals_over_time(swing):
    """Against sn and cn on a fine grid; the mean of q'' is (q'(T) - q'(0))/T."""
    t = np.linspace(0, 11.3, 400_001)
    k, w = math.sin(1), math.sqrt(9.81)
    sn, cn, dn, _ = ellipj(w * t + ellipk(k**2), k**2)
    q, rate = 2 * np.arcsin(k * sn), 2 * k * w * cn
    assert dn.min() > 0
    assert swing.ask("mean(q)").value == pytest.approx(np.trapezoid(q, t) / 11.3, abs=1e-9)
    assert swing.ask("rms(q')").value == pytest.approx(math.sqrt(np.trapezoid(rate**2, t) / 11.3), rel=1e-9)
    assert swing.ask("mean(q'')").value == pytest.approx(swing["q'"][-1] / 11.3, abs=1e-9)
    assert swing.ask("last(q)").value == swing["q"][-1]


def test_a_driven_oscillator_has_its_amplitude_and_power():
    """x = x0 cos w t + F/m/(w^2 - 4) (cos 2 t - cos w t): m x'' + k x = F cos 2 t."""
    model = eomgen.loads(OSCILLATOR)
    run = eomgen.simulate(model, time=9, samples=11, rtol=1e-12, atol=1e-12)
    t = np.linspace(0, 9, 900_001)
    x = 0.3 * np.cos(5 * t) + 1.5 / 21 * (np.cos(2 * t) - np.cos(5 * t))
    assert run.ask("max(x)").value == pytest.approx(x.max(), abs=1e-9)
    assert run.ask("min(x)").value == pytest.approx(x.min(), abs=1e-9)
    assert run.ask("rms(x)").value == pytest.approx(math.sqrt(np.trapezoid(x**2, t) / 9), rel=1e-8)
    assert "no period" in run.ask("period(x)").message


def test_events_where_phases_change_are_found():
    """The wall lets the ladder go where its reaction falls to 0, and only there."""
    run = eomgen.simulate(eomgen.load(MODELS / "sliding_ladder.toml"), time=1, samples=3)
    left = run.ask("t at reaction_n(wall) = 0, event every")
    assert left.t == pytest.approx([run.phases[0].end], abs=1e-9)
    assert run.ask("min(reaction_n(wall))").value == pytest.approx(0, abs=1e-7)
    jump = run.ask("t at theta'' = 3, event every")
    inside = eomgen.simulate(eomgen.load(MODELS / "sliding_ladder.toml"), time=1, until="theta'' = 3")
    assert jump.t[0] == pytest.approx(inside.t[-1], rel=1e-8)


def test_the_n_th_event_agrees_with_a_run_that_ends_there():
    """Instants by polynomials between steps, against the event location of the integrator."""
    model = eomgen.load(MODELS / "double_pendulum.toml")
    first, second = list(model.coordinates)[:2]
    run = eomgen.simulate(model, time=3, samples=5, rtol=1e-11, atol=1e-11)
    until = eomgen.simulate(model, time=3, until=f"{second} = 0", rtol=1e-11, atol=1e-11)
    found = run.ask(f"{first}' at {second} = 0")
    assert found.t[0] == pytest.approx(until.t[-1], rel=1e-9)
    assert found.value == pytest.approx(until[f"{first}'"][-1], rel=1e-8)


def test_a_kink_and_a_jump_are_enclosed():
    """max of |sin|-like and stepped functions; integrals across both."""
    edges = np.linspace(0, 10, 8)
    kink = resolved_curve(lambda t: np.abs(np.sin(5 * t) - 0.3), edges)
    assert kink.extreme(1)[0] == pytest.approx(1.3, abs=1e-10)
    assert kink.extreme(-1)[0] == pytest.approx(0, abs=1e-8)
    step = resolved_curve(lambda t: np.where(t < np.pi, 1.0, -1.0), edges)
    assert step.integral() == pytest.approx(2 * np.pi - 10, abs=1e-9)
    assert [t for t, _ in step.zeros()] == pytest.approx([np.pi], abs=1e-9)
    wild = resolved_curve(lambda t: np.sin(200 * t), np.array([0.0, 10.0]))
    assert len(wild.zeros()) == math.floor(2000 / math.pi) and wild.extreme(1)[0] == pytest.approx(1, rel=1e-12)


@pytest.mark.parametrize(
    ("text", "message"),
    [
        (
            "max(q) + q",
            "'q' is a function of a state, next to functions of a whole run",
        ),
        ("max(q) + speed(rod.end)", "last(speed(rod.end))"),
        ("max(mean(q))", "a function of a whole run has no value along it"),
        ("max(q) at q = 0", "belongs to no instant"),
        ("q at equilibrium", "`eomgen solve` answers it"),
        ("period(q^0)", "passes its mean upward 0 times"),
    ],
)
def test_what_has_no_meaning_says_why(swing, text, message):
    found = swing.ask(text)
    assert found.value is None and message in found.message


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("max(qq)", "unknown name 'qq'"),
        ("maxx(q)", "unknown function 'maxx'"),
        ("q at q = 0, event 0", "event is needed"),
    ],
)
def test_what_cannot_be_read_is_an_error(swing, text, message):
    with pytest.raises(UsageError, match=message):
        swing.ask(text)


def test_outputs_of_a_run_stand_in_text_and_json_and_solve_leaves_them(tmp_path):
    path = tmp_path / "swing.toml"
    requested = [
        "[outputs]",
        'peak = { value = "max(q)", unit = "deg" }',
        'T = "period(q)"',
        'w = { value = "q\'", at = "q = 0", event = 2 }',
        "a = \"q''\"",
    ]
    path.write_text(PENDULUM + "\n".join(requested))
    found = CliRunner().invoke(main, ["simulate", str(path), "--time", "6", "--json"])
    reported = json.loads(found.output)["quantities"]
    assert reported["peak"]["value"] == pytest.approx(math.degrees(2)) and reported["peak"]["unit"] == "deg"
    assert reported["w"]["t"] == pytest.approx([0.75 * reported["T"]["value"]], rel=1e-7)
    text = CliRunner().invoke(main, ["simulate", str(path), "--time", "6", "--certificate"]).output
    assert "peak [deg]" in text and "outputs of the whole run agree with its samples" in text
    solved = CliRunner().invoke(main, ["solve", str(path), "--json"])
    answers = json.loads(solved.output)["outputs"]
    assert solved.exit_code == 0 and answers["a"]["value"] is not None
    assert answers["w"]["value"] is None and "of a whole run" in answers["w"]["message"]


def test_an_extreme_that_falls_between_few_samples_is_no_contradiction():
    """Swings after a blow, written once a period at x = A sin 0.25: the integrator's own steps saw A."""
    text = OSCILLATOR.replace(
        '"F*cos(2*t)"', '{ value = { samples = [[0, 0], [0.05, 400], [0.1, 0], [4, 0]], between = "linear" } }'
    )
    text = (
        text.replace("x = 0.3", "x = 0").replace("length = 0", "length = 0, along = [1, 0]")
        + 'outputs.push = "max(abs(x))"\n'
    )
    run = eomgen.simulate(eomgen.loads(text), time=2 * math.pi, samples=6)
    assert run.quantities["push"].value > 2 * np.max(np.abs(run["x"]))
    assert [check.status for check in SamplesOfRun(run.proof.whole).checks()] == ["holds"]


def test_a_wrong_extreme_fails_the_proof(monkeypatch):
    """A sample above the maximum contradicts it."""
    model = replace(eomgen.loads(PENDULUM), outputs=Table({"peak": eomgen.Output(value="max(q')")}))
    run = eomgen.simulate(model, time=4, samples=101)
    whole = SamplesOfRun(run.proof.whole)
    assert [check.status for check in whole.checks()] == ["holds"]
    monkeypatch.setattr(ChebyshevPieces, "extreme", lambda self, sign: (0.9 * max(self.c[:, 0]), 0.0))
    assert [check.status for check in whole.checks()] == ["fails"]


def test_what_is_told_of_a_run_is_held_against_its_samples(swing):
    """Another value at an instant, none where it is met, one of a later event: each differs from the samples."""
    found, samples = swing.proof.whole, SamplesOfRun(swing.proof.whole)
    model = eomgen.loads(PENDULUM)
    for text in ("q at t = 1", "q' at q = 0, event 2", "max(q')", "q + 1", "q at t = 20", "q' at q = 0, event 40"):
        requested = Requests(model).output(text)
        assert samples.answered_otherwise(requested, found.of(requested).value) == ""
    at = Requests(model).output("q at t = 1")
    assert "it is not 1.9" in samples.answered_otherwise(at, 1.9)
    assert "no value, and it is met near t = 1" in samples.answered_otherwise(at, None)
    assert "2" in samples.answered_otherwise(Requests(model).output("q"), 2.1)
    later = replace(found.of(Requests(model).output("q' at q = 0, event 3")))
    assert samples.answered_otherwise(Requests(model).output("q' at q = 0, event 2"), later.value)
