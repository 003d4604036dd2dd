"""Steps along power series: every operation has its own, and the motion is that of DOP853 and of thirty digits."""

from __future__ import annotations

import ctypes
import math
from pathlib import Path

import numpy as np
import pytest
from slow_run import sampled, usual

import eomgen
from eomgen.codegen.build import compiler
from eomgen.codegen.taylor import ALONE, LEAST, MOST, cheapest_order

MODELS = Path(__file__).parent.parent / "models"

pytestmark = [pytest.mark.slow, pytest.mark.skipif(compiler() is None, reason="no C compiler")]

FUNCTIONS = """
eomgen = 1
space = "plane"
parameters = { k = 2, d = 0.3 }
inputs.F = "cos(2*t) - sqrt(1 + t^2)"
coordinates = { x = { start = 0.4, speed = 0.2 }, y = { start = 0.7, speed = -0.3 } }
bodies.frame = { joint = { kind = "prismatic", axis = [1, 0], displacement = "x" }, mass = 1, inertia = 1 }
[bodies.load]
mass = 2
inertia = 1
joint = { kind = "prismatic", on = "frame", axis = [0, 1], displacement = "y" }
[forces.push]
kind = "force"
point = "load.origin"
force = ["FORCE", "F - k*y - d*y'"]
"""
FORCES = [
    "tan(x)",
    "tanh(x + y)",
    "sinh(x)*cosh(y)",
    "exp(-x*y)",
    "log(2 + x)",
    "atan(2*x - y)",
    "sqrt(1 + x*y)",
    "(1 + x^2)^(3/2)",
    "(1 + x*y)^0.3",
    "(2 + x)^(-1.7)",
    "k/(1 + y)^3",
    "x^2*y'^2 - x*(3*x)",
    "1/(2 - x - F)",
    "sin(-x)*cos(x)",
    "d - x",
    "cos(k)*exp(d)",
]


def along(model: eomgen.Model, order: int):
    """(f, the start, h -> (x, x') by the series of that order from the start on)."""
    rhs = eomgen.derive(model).rhs("c")
    f, x0, series = rhs.at(rhs.p0), rhs.x0, rhs.series(order)
    X, W = np.zeros((order + 1, len(x0))), np.zeros(max(series.size, 1))
    reals = ctypes.POINTER(ctypes.c_double)
    at = lambda array: array.ctypes.data_as(reals)  # noqa: E731
    make = ctypes.CFUNCTYPE(None, ctypes.c_double, *[ctypes.c_void_p] * 5)(series.address)
    make(0.0, x0.ctypes.data, f.address.p, f.address.c, X.ctypes.data, W.ctypes.data)
    give = ctypes.CFUNCTYPE(None, reals, ctypes.c_double, reals, reals)(series.along)

    def found(h: float) -> tuple[np.ndarray, np.ndarray]:
        x, slope = np.zeros_like(x0), np.zeros_like(x0)
        give(at(X), h, at(x), at(slope))
        return x, slope

    return f, x0, found


@pytest.mark.parametrize("force", FORCES)
def test_the_rate_of_a_series_is_that_of_the_equations_to_its_order(force):
    """P(t)' - f(t, P(t)) = O(t^p), measured; every operation of the graph."""
    f, _, found = along(eomgen.loads(FUNCTIONS.replace("FORCE", force)), order := 7)
    off = []
    for h in (0.08, 0.04):
        x, slope = found(h)
        off.append(np.max(np.abs(slope - f(h, x))))
    assert np.log2(off[0] / off[1]) > order - 0.7 and off[1] > 1e-15


SYSTEMS = ["double_pendulum", "n_four_bar", "four_bar", "tumbling_body", "arm3", "car_axis", "bricard"]


@pytest.mark.parametrize("name", usual([*SYSTEMS], 3, 1))
def test_a_motion_by_series_is_that_of_dop853(name):
    """The same states between the steps, energy and constraints kept; with multipliers, quaternions and given
    motions."""
    model = eomgen.load(MODELS / f"{name}.toml")
    how = {"time": 0.7, "samples": 51, "rtol": 1e-10, "atol": 1e-10}
    own, other = (eomgen.simulate(model, method=method, **how) for method in ("taylor", "DOP853"))
    assert own.status == other.status == "finished" and "series" not in own.message and own.steps < other.steps
    assert own.x == pytest.approx(other.x, abs=2e-8 * (1 + np.max(np.abs(other.x))))
    assert own.gap is None or own.gap < 1e-9


THIRTY_DIGITS = [-1.4401629538417988, -5.9839823765164500, -2.4713251372556812, 8.8253136271604716]
"""Of the double pendulum at 10 s: benchmarks/integration.py --reference."""


def test_series_and_dop853_come_to_the_end_that_thirty_digits_give():
    for method, error in (("taylor", 1e-8), ("DOP853", 1e-7)):
        simulate = eomgen.simulator(MODELS / "double_pendulum.toml", method=method, rtol=1e-12, atol=1e-12)
        assert np.max(np.abs(simulate(10.0, samples=2).x[-1] - THIRTY_DIGITS)) < error


def test_the_error_goes_with_the_tolerance_and_the_order_with_its_logarithm():
    """As many steps whatever is asked, each of more terms: as many for each digit."""
    found = []
    for tolerance in (1e-5, 1e-8, 1e-11):
        run = eomgen.simulate(MODELS / "double_pendulum.toml", time=3, method="taylor", rtol=tolerance, atol=tolerance)
        finest = eomgen.simulate(MODELS / "double_pendulum.toml", time=3, rtol=1e-13, atol=1e-13)
        found.append((run.steps, run.evaluations / run.steps, np.max(np.abs(run.x - finest.x))))
    steps, terms, errors = np.array(found).T
    assert max(steps) < 1.5 * min(steps) and np.diff(terms) == pytest.approx([3.5, 3.5], abs=1.6)
    assert all(errors < np.array([1e-3, 1e-6, 1e-9])) and all(errors[1:] < errors[:-1] / 50)


@pytest.mark.parametrize("beside", [0.0, 5.0, ALONE, 100.0])
@pytest.mark.parametrize("rtol", [1e-3, 1e-7, 1e-10])
def test_the_order_is_that_which_costs_least(rtol, beside):
    """p (p + beside)/h, h = exp(ln(rtol)/p), one more than the best p; p = 1 - ln(rtol)/2 where sums are all."""
    cost = {p: p * (p + beside) * rtol ** (-1 / p) for p in range(1, 60)}
    best = min(cost, key=cost.__getitem__)
    assert cheapest_order(rtol, beside) == pytest.approx(min(MOST, max(LEAST, best + 1)), abs=1)
    assert cheapest_order(rtol, 0.0) == min(MOST, max(LEAST, math.ceil(1 - math.log(rtol) / 2)))


def test_a_step_ends_where_the_equations_no_longer_agree_with_the_series():
    """2 x'' = t^25, x = t^27/(2 26 27): the first terms, whatever the order, are those of x'' = 0."""
    run = eomgen.simulate(eomgen.loads(FUNCTIONS.replace("FORCE", "3*t^25")), time=1.5, samples=4, method="taylor")
    x = 0.4 + 0.2 * run.t + run.t**27 / (26 * 27)
    assert run["x"] == pytest.approx(x, rel=1e-8) and run.steps > 5


@pytest.mark.parametrize("until", ["theta1 = 0", "theta2' = 3", "theta1' = 0"])
def test_an_event_is_found_in_the_steps_of_series(until):
    how = {"time": 10, "samples": 11, "until": until, "rtol": 1e-10, "atol": 1e-10}
    own, other = (eomgen.simulate(MODELS / "double_pendulum.toml", method=m, **how) for m in ("taylor", "DOP853"))
    assert own.status == other.status == "event" and own.t[-1] == pytest.approx(other.t[-1], abs=1e-9)
    assert own.x[-1] == pytest.approx(other.x[-1], abs=1e-8)


PUSHED = """
[forces.wave]
kind = "force"
point = "box.center"
force = ["80*sin(3*t)", 0]
"""


@sampled(2)
@pytest.mark.parametrize("method", ["taylor", "DOP853"])
@pytest.mark.parametrize("name", ["sliding_ladder", "rough_incline", "stick-slip"])
def test_contacts_change_at_instants_that_hold(name, method):
    """The same phases, their ends within 1e-9 s of a run with rtol 1e-13; a box that a wave pushes sticks and slips."""
    file = MODELS / f"{'rough_incline' if name == 'stick-slip' else name}.toml"
    text = file.read_text(encoding="utf-8").partition("[outputs]")[0]
    model = eomgen.loads(text + PUSHED * (name == "stick-slip"))
    own, exact = (
        eomgen.simulate(model, time=6, samples=11, method=each, rtol=tolerance, atol=tolerance)
        for each, tolerance in ((method, 1e-9), ("DOP853", 1e-13))
    )
    reported = [[phase.ended_by.split(" at t")[0] for phase in run.phases] for run in (own, exact)]
    assert reported[0] == reported[1] and len(reported[0]) > (5 if name == "stick-slip" else 1)
    assert [phase.end for phase in own.phases] == pytest.approx([phase.end for phase in exact.phases], abs=1e-9)


@pytest.mark.parametrize(("force", "what"), [("abs(x)", "abs"), ("max(x, y)", "max"), ("2^x", "power")])
def test_what_has_no_series_goes_as_it_would_have(force, what):
    """And says so."""
    model = eomgen.loads(FUNCTIONS.replace("FORCE", force))
    own, other = (eomgen.simulate(model, time=1, samples=11, method=method) for method in ("taylor", "auto"))
    assert own.x.tolist() == other.x.tolist() and "Not by power series" in own.message and what in own.message


def test_without_a_compiler_the_motion_is_the_same():
    how = {"time": 1, "samples": 11}
    own, other = (
        eomgen.simulate(MODELS / "double_pendulum.toml", target=t, method="taylor", **how) for t in ("c", "numpy")
    )
    assert "Not by power series (not in C)" in other.message and own.x == pytest.approx(other.x, abs=1e-7)


@sampled(2)
@pytest.mark.parametrize("name", usual(["double_pendulum", "tumbling_body", "arm3", "cart_pole"], 2, 1))
def test_runs_in_lanes_by_series_are_those_one_by_one(name):
    """Each with its own start, instants between the steps, quaternions; a lane does not know its neighbours."""
    model = eomgen.load(MODELS / f"{name}.toml")
    first = next(iter(model.coordinates)) if name != "tumbling_body" else next(iter(model.speeds or model.coordinates))
    rest = eomgen.simulate(model, time=0.01, samples=2)
    begun = float(rest[first][0]) + np.linspace(0, 0.2, 19)
    how = {"time": 1.3, "samples": 14, "rtol": 1e-10, "atol": 1e-10, "method": "taylor"}
    runs = eomgen.simulate_many(model, start={first: begun}, **how)
    assert all(runs.status == "finished") and np.all(runs.steps > 0)
    for i in (0, 7, 18):
        alone = eomgen.simulate(model, start={first: begun[i]}, **how)
        assert runs.x[i] == pytest.approx(alone.x, abs=1e-8 * (1 + np.max(np.abs(alone.x))))
    few = eomgen.simulate_many(model, start={first: begun[7:9]}, **how)
    assert few.x.tolist() == runs.x[7:9].tolist()


def test_a_run_in_lanes_that_has_no_value_on_its_way_does_not_stop_the_others():
    """x' = sqrt(k - t) ends at t = k."""
    model = eomgen.loads("""
        eomgen = 1
        space = "plane"
        parameters.k = 1
        coordinates = { x = { rate = "sqrt(k - t)" }, y = 0.1 }
        bodies.frame = { joint = { kind = "prismatic", axis = [1, 0], displacement = "x" } }
        [bodies.load]
        mass = 1
        inertia = 1
        joint = { kind = "prismatic", on = "frame", axis = [0, 1], displacement = "y" }
    """)
    k = np.array([3.0, 1.0, 4.0, 0.5, 2.5])
    runs = eomgen.simulate_many(model, time=2, parameters={"k": k}, samples=3, method="taylor")
    assert [status == "finished" for status in runs.status] == [True, False, True, False, True]
    done = runs.status == "finished"
    expected = 2 / 3 * (k[done] ** 1.5 - (k[done] - 2) ** 1.5)
    assert (runs["x"][done, -1] - runs["x"][done, 0]) == pytest.approx(expected, abs=1e-8)
