"""Steps in C against scipy's own: the same instants, states and events, whatever is watched."""

from __future__ import annotations

import re
from importlib import resources
from pathlib import Path

import numpy as np
import pytest
from slow_run import usual

import eomgen
from eomgen.codegen.build import compiler
from eomgen.simulation import solvers
from eomgen.simulation.compiled_steps import CompiledSteps
from eomgen.simulation.contacts import ContactSignals, divisors
from eomgen.simulation.integrator import Stepping, march
from eomgen.simulation.many_runs import March
from eomgen.symbolic.expression.graph import Graph

MODELS = Path(__file__).parent.parent / "models"

pytestmark = [pytest.mark.slow, pytest.mark.skipif(compiler() is None, reason="no C compiler")]


def rates(name: str):
    """(the right-hand side in C, the same without its address, the start)."""
    rhs = eomgen.derive(eomgen.load(MODELS / f"{name}.toml")).rhs("c")
    f = rhs.at(rhs.p0)
    return f, lambda t, x: f(t, x), rhs.x0, rhs.unit_quaternions


@pytest.mark.parametrize("name", ["double_pendulum", "spherical_pendulum", "arm3", "tumbling_body"])
def test_steps_in_c_are_those_of_scipy(name):
    """The same instants and states to rounding, between the steps too, and as many evaluations."""
    f, plain, x0, unit_quaternions = rates(name)
    how, instants = Stepping(rtol=1e-7, atol=1e-9), np.linspace(0.0, 0.5, 38)
    own, other = (
        march(rate, (0.0, 0.5), x0, how=how, instants=instants, unit_quaternions=unit_quaternions)
        for rate in (f, plain)
    )
    assert (own.steps, own.status, own.message) == (other.steps, other.status, other.message) and own.steps > 3
    steps, expected = (run.tracks[0].all[0] for run in (own, other))
    assert steps == pytest.approx(expected, rel=1e-6)
    size = np.max(np.abs(other.x))
    assert own.t.tolist() == other.t.tolist() and own.x == pytest.approx(other.x, rel=1e-6, abs=1e-7 * size)


def test_it_is_c_that_steps(monkeypatch):
    """A plain motion takes a few calls, not one a step."""
    calls = []
    advance = CompiledSteps.advance
    monkeypatch.setattr(CompiledSteps, "advance", lambda self, most: calls.append(1) or advance(self, most))
    f, _, x0, _ = rates("double_pendulum")
    run = march(f, (0.0, 10.0), x0, how=Stepping())
    assert run.steps > 200 and 0 < len(calls) < 20


def test_a_step_shrinks_until_it_goes_no_further():
    """x' = sqrt(1 - t) has no value after t = 1."""
    text = """
        eomgen = 1
        space = "plane"
        coordinates = { x = { rate = "sqrt(1 - t)" }, y = 0.1 }
        bodies.frame = { joint = { kind = "prismatic", axis = [1, 0], displacement = "x" } }
        [bodies.load]
        mass = 1
        inertia = 1
        joint = { kind = "prismatic", on = "frame", axis = [0, 1], displacement = "y" }
    """
    run = eomgen.simulate(eomgen.loads(text), time=2, target="c")
    assert run.status in ("not finite", "step too small") and run.t[-1] == pytest.approx(1, abs=1e-6)


RUNS = [  # contacts that change, constraints in all forms, change points, quaternions, samples
    ("sliding_ladder", 2.0),
    ("rough_incline", 2.0),
    ("four_bar", 3.0),
    ("n_four_bar", 3.0),
    ("bricard", 1.0),
    ("flyball_governor", 0.3),
]


@pytest.mark.parametrize(("name", "time"), usual([*RUNS], 3, 2))
def test_a_run_in_c_is_that_of_scipy(name, time):
    """The same phases, instants of events, crossings and states; both within the tolerance of the run."""
    model = eomgen.load(MODELS / f"{name}.toml")
    with np.errstate(all="ignore"):
        own, other = (eomgen.simulate(model, time=time, samples=51, target=target) for target in ("c", "numpy"))
    assert own.status == other.status and len(own.phases) == len(other.phases)
    assert [len(own.carried), own.t.size] == [len(other.carried), other.t.size]
    for phase, expected in zip(own.phases, other.phases, strict=True):
        assert phase.end == pytest.approx(expected.end, abs=1e-8)
    assert own.x == pytest.approx(other.x, abs=1e-7 * (1 + np.max(np.abs(other.x))))
    assert own.gap is None or own.gap < 1e-9


def van_der_pol_like(stiffness: float) -> eomgen.Model:
    """m x'' = -k x - d x' with a damper that makes it stiff, driven slowly."""
    return eomgen.loads(f"""
        eomgen = 1
        space = "plane"
        inputs.F = "sin(t)"
        coordinates.x = 0
        [bodies.load]
        mass = 1
        inertia = 1
        joint = {{ kind = "prismatic", axis = [1, 0], displacement = "x" }}
        [forces.push]
        kind = "force"
        point = "load.origin"
        force = ["F - {stiffness}*x - {stiffness}*x'", 0]
    """)


@pytest.mark.parametrize("target", ["c", "numpy"])
def test_what_is_stiff_goes_over_to_radau_by_itself(target):
    """x'' + d x' + d x = sin(t), d = 1e5: few steps, told in the message, the end that of the linear equation."""
    run = eomgen.simulate(van_der_pol_like(1e5), time=5, samples=51, rtol=1e-7, atol=1e-9, target=target)
    d = 1e5
    steady = ((d - 1) * np.sin(run.t) - d * np.cos(run.t)) / ((d - 1) ** 2 + d**2)
    slow = -(d - np.sqrt(d * d - 4 * d)) / 2
    begun = d / ((d - 1) ** 2 + d**2)  # x(0) = 0; of the fast part nothing is left
    assert "Stiff from" in run.message and run.steps < 2000
    assert run["x"][1:] == pytest.approx((steady + begun * np.exp(slow * run.t))[1:], abs=2e-9)


def test_what_is_not_stiff_stays_with_dop853():
    """The same steps, whether auto or not, of pendulums and of a chain that swings."""
    for name in ("double_pendulum", "four_bar", "chain20"):
        model = eomgen.load(MODELS / f"{name}.toml")
        own, other = (eomgen.simulate(model, time=1, method=method, samples=11) for method in ("auto", "DOP853"))
        assert own.message == other.message and own.x.tolist() == other.x.tolist()


ORDERS = {"DOP853": 8, "Radau": 5}


@pytest.mark.parametrize("target", ["c", "numpy"])
@pytest.mark.parametrize("method", ORDERS)
def test_the_order_of_each_method_is_measured(method, target):
    """error ~ steps^-order, against a run of the finest tolerance; with an estimate of order q it is at least that."""
    simulator = eomgen.simulator(MODELS / "double_pendulum.toml", rtol=1e-13, atol=1e-13)
    exact = simulator(1.5).x[-1]
    tolerances = [1e-5, 1e-7, 1e-9] if method == "Radau" else [1e-5, 1e-7, 1e-9, 1e-10]
    found = []
    for tolerance in tolerances:
        how = {"method": method, "target": target, "rtol": tolerance, "atol": tolerance}
        run = eomgen.simulate(MODELS / "double_pendulum.toml", time=1.5, samples=2, **how)
        found.append((run.steps, np.max(np.abs(run.x[-1] - exact))))
    steps, errors = np.log(np.array(found)).T
    order = -np.polyfit(steps, errors, 1)[0]
    assert ORDERS[method] - 1.2 < order < ORDERS[method] + 2.5


@pytest.mark.parametrize("name", ["double_pendulum", "n_four_bar", "flyball_governor", "tumbling_body"])
def test_radau_in_c_is_that_of_scipy(name):
    """The same states within the tolerance, and as many steps but a few."""
    model = eomgen.load(MODELS / f"{name}.toml")
    how = {"time": 0.5, "samples": 11, "method": "Radau", "rtol": 1e-6, "atol": 1e-6}
    own, other = (eomgen.simulate(model, target=target, **how) for target in ("c", "numpy"))
    assert own.status == other.status and abs(own.steps - other.steps) <= 2 + other.steps // 50
    assert own.x == pytest.approx(other.x, abs=2e-5 * (1 + np.max(np.abs(other.x))))


@pytest.mark.parametrize("until", ["theta1 = 0", "theta2' = 3", "theta1' = 0", "x(arm2.end) = 1"])
def test_an_event_is_seen_in_c_and_found_as_by_scipy(until, monkeypatch):
    """The same instant to 1e-9 and state, after steps that are not looked at one by one."""
    calls = []
    advance = CompiledSteps.advance
    monkeypatch.setattr(CompiledSteps, "advance", lambda self, most: calls.append(1) or advance(self, most))
    how = {"time": 10, "samples": 11, "until": until, "rtol": 1e-10, "atol": 1e-10}
    own, other = (eomgen.simulate(MODELS / "double_pendulum.toml", target=target, **how) for target in ("c", "numpy"))
    assert own.status == other.status == "event" and own.t[-1] == pytest.approx(other.t[-1], abs=1e-9)
    assert own.x[-1] == pytest.approx(other.x[-1], abs=1e-8) and len(calls) < own.steps / 2


@pytest.mark.parametrize("name", ["sliding_ladder", "rough_incline", "bowling_ball", "disc_leaves_cylinder"])
def test_what_a_contact_says_by_its_formula_is_what_the_balance_solved_with_rank_says(name):
    """The force of a contact along a run: its formula, by which C finds events, and A rho = b of the bodies."""
    run, seen = eomgen.simulate(MODELS / f"{name}.toml", time=0.3, samples=9), 0
    for phase in run.phases:
        t, x = phase.track
        own = phase.model.signals
        other = ContactSignals(own.watch, own.functions)
        other.__dict__["with_rank"] = frozenset(signal.column for signal in own.watch.signals if signal.column)
        seen += len(other.with_rank - own.with_rank)
        assert own.watched(t, x) == pytest.approx(other.watched(t, x), rel=1e-9, abs=1e-9)
    assert seen


def test_events_of_contacts_are_found_in_c(monkeypatch):
    """Python asks what the contacts say a few times a phase, not at each look into a step."""
    calls = []
    watched = ContactSignals.watched
    monkeypatch.setattr(ContactSignals, "watched", lambda self, t, x: calls.append(len(t)) or watched(self, t, x))
    run = eomgen.simulate(MODELS / "rough_incline.toml", time=2, samples=3, target="c")
    assert len(run.phases) > 1 and sum(calls) <= 2 * len(run.phases)


def test_a_formula_divides_by_what_its_quotients_and_roots_have_below():
    """a/b + c^2 + 1/(1 + d): b and 1 + d."""
    graph = Graph()
    a, b, c, d = (graph.symbol(name) for name in "abcd")
    assert set(divisors(a / b + c**2 + 1 / (1 + d))) == {b, 1 + d}


def test_a_name_that_the_march_does_not_have_is_no_field_of_it():
    """A struct of C takes what stands in it, and refuses the rest: a value that C never reads would be lost."""
    with pytest.raises(AttributeError):
        March().n_spheres = 1  # type: ignore[attr-defined]


def test_steps_are_followed_in_as_many_pieces_in_c_and_in_python():
    text = resources.files("eomgen.codegen").joinpath("dop853_pieces.c").read_text(encoding="utf-8")
    constants = dict(re.findall(r"#define DOP853_(MISSED|PIECES) +([\d.]+)", text))
    assert {name: float(x) for name, x in constants.items()} == {
        "MISSED": solvers.MISSED,
        "PIECES": solvers.MOST_PIECES,
    }
