"""simulate_many: each run is what `simulate` gives, whatever lane it runs in; those that fail stop no other."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from slow_run import beside, sampled

import eomgen
from eomgen.codegen.build import compiler
from eomgen.codegen.rhs import RightHandSide
from eomgen.errors import DerivationError, UsageError
from eomgen.runs import batch_of_runs as many_runs

MODELS = Path(__file__).parent.parent / "models"
needs_compiler = pytest.mark.skipif(compiler() is None, reason="no C compiler")


def alone(name: str, i: int, time: float, given: dict, samples: int) -> eomgen.Trajectory:
    own = {kind: {key: float(values[i]) for key, values in each.items()} for kind, each in given.items()}
    instants = np.linspace(0, time, samples).tolist()
    return eomgen.simulate(MODELS / f"{name}.toml", time=time, samples=instants, **own)


@sampled(2)
@pytest.mark.slow
@pytest.mark.parametrize("target", [None, "numpy"])
@pytest.mark.parametrize(
    ("name", "given"),
    [
        (
            "double_pendulum",
            {"parameters": {"l1": np.linspace(0.5, 2, 21)}, "start": {"theta1": np.linspace(0, 3, 21)}},
        ),
        ("cart_pole", {"inputs": {"F": np.linspace(-1, 1, 5)}, "start": {"theta'": np.linspace(-1, 1, 5)}}),
        ("tumbling_body", {"start": {"w1": np.linspace(0, 1, 3)}}),
        *beside(
            ("chain20", {"start": {"q1": np.linspace(0, 1, 3)}}),
            ("four_bar", {"parameters": {"g": np.array([1.0, 9.81])}}),
        ),
        ("four_bar", {"parameters": {"b": np.linspace(0.9, 1.1, 9)}, "start": {"alpha": np.linspace(0.8, 1.2, 9)}}),
        *beside(("spatial_slider_crank", {"parameters": {"g": np.linspace(1, 9.81, 3)}})),
        ("balancing_robot", {"parameters": {"g": np.linspace(9, 10, 5)}}),
        ("cardan_shaft", {"parameters": {"J": np.linspace(0.02, 0.03, 3)}}),
        ("sliding_ladder", {"start": {"theta": np.array([0.5, 0.6])}}),
    ],
)
def test_each_run_is_what_simulate_gives(name, given, target):
    """Within the tolerance of a run, a few seconds long."""
    runs = eomgen.simulate_many(MODELS / f"{name}.toml", time=1, samples=11, target=target, **given)
    n = len(next(iter(next(iter(given.values())).values())))
    assert runs.x.shape == (n, 11, len(runs.names)) and runs.t.tolist() == np.linspace(0, 1, 11).tolist()
    assert set(runs.status) == {"finished"} and set(runs.message) == {"Reached t = 1 s."}
    for i in (0, n // 2, n - 1):
        other = alone(name, i, 1, given, 11)
        assert runs.names == other.coordinates + other.speeds
        assert runs.x[i] == pytest.approx(other.x, abs=1e-7 * (1 + np.max(np.abs(other.x))))


@pytest.mark.slow
@needs_compiler
def test_what_a_run_gives_does_not_depend_on_its_neighbours_nor_on_threads():
    """Bit for bit: among nine others in one thread, in two, backwards, and alone."""
    angles = np.linspace(-2, 2, 37)
    requested = {"time": 3, "samples": 31}
    model = MODELS / "double_pendulum.toml"
    whole = eomgen.simulate_many(model, start={"theta1": angles}, **requested)
    others = [
        eomgen.simulate_many(model, start={"theta1": angles}, threads=2, **requested).x,
        eomgen.simulate_many(model, start={"theta1": angles[::-1]}, **requested).x[::-1],
    ]
    assert all(np.array_equal(whole.x, x) for x in others)
    assert np.array_equal(eomgen.simulate_many(model, start={"theta1": angles[5:6]}, **requested).x[0], whole.x[5])
    assert np.max(whole.drift) < 1e-8


@pytest.mark.slow
@needs_compiler
def test_a_run_that_fails_is_recorded_and_the_rest_go_on():
    """x' = sqrt(a - t) has no value after t = a."""
    text = """
        eomgen = 1
        space = "plane"
        parameters.a = {}
        coordinates = { x = { rate = "sqrt(a - t)" }, y = 0.1 }
        bodies.frame = { joint = { kind = "prismatic", axis = [1, 0], displacement = "x" } }
        [bodies.load]
        mass = 1
        inertia = 1
        joint = { kind = "prismatic", on = "frame", axis = [0, 1], displacement = "y" }
    """
    runs = eomgen.simulate_many(eomgen.loads(text), time=2, parameters={"a": np.array([3.0, 1.0, 5.0])}, samples=5)
    assert (runs.status == "finished").tolist() == [True, False, True]
    assert runs.message[1].startswith("Stopped at t = 1 s") and np.isnan(runs.x[1]).all()
    assert runs["x"][0] == pytest.approx((3**1.5 - (3 - runs.t) ** 1.5) * 2 / 3, abs=1e-8)


@pytest.mark.slow
@needs_compiler
@pytest.mark.parametrize("threads", [*beside(1), 2])
def test_runs_with_ties_are_marched_and_those_that_cannot_start_are_told(threads, monkeypatch):
    """Four-bars with couplers of 0.9 to 5 m: what closes is stepped in C, the rest is refused as `simulate` does."""
    alone = []
    one_by_one = many_runs._one_by_one
    monkeypatch.setattr(
        many_runs, "_one_by_one", lambda plan, which, n: alone.extend(which) or one_by_one(plan, which, n)
    )
    lengths = np.array([0.9, 5.0, 1.0, 1.1, 0.1, 1.05])
    requested = {"time": 0.5, "samples": 6, "threads": threads}
    runs = eomgen.simulate_many(MODELS / "four_bar.toml", parameters={"b": lengths}, **requested)
    assert alone == [1, 4] and (runs.status == "refused").tolist() == [False, True, False, False, True, False]
    with pytest.raises(DerivationError) as refused:
        eomgen.simulate(MODELS / "four_bar.toml", time=0.5, parameters={"b": 5.0})
    assert (
        runs.message[1] == str(refused.value) and np.isnan(runs.x[1]).all() and np.isfinite(runs.x[[0, 2, 3, 5]]).all()
    )


@pytest.mark.slow
@needs_compiler
def test_a_run_through_a_change_point_leaves_its_march():
    """A parallelogram of four equal links passes its change point; lanes beside it do not."""
    given = {"parameters": {"b": np.array([1.0, 1.1, 1.2])}}
    model = eomgen.loads((MODELS / "four_bar.toml").read_text().replace("value = 0.4", "value = 0.8"))
    runs = eomgen.simulate_many(model, time=1.0, samples=11, **given)
    for i, b in enumerate(given["parameters"]["b"]):
        try:
            other = eomgen.simulate(model, time=1.0, samples=runs.t.tolist(), parameters={"b": float(b)})
        except DerivationError as error:
            assert runs.message[i] == str(error)
            continue
        assert (runs.status[i], runs.message[i]) == (other.status, other.message)
        if other.status == "finished":
            assert runs.x[i] == pytest.approx(other.x, abs=1e-7)


@pytest.mark.slow
@needs_compiler
def test_what_is_stiff_leaves_its_lane():
    """x'' + d x' + d x = 0 with d from 1 to 1e5, by the closed solution."""
    text = """
        eomgen = 1
        space = "plane"
        parameters.d = {}
        coordinates.x = 1
        bodies.load = { mass = 1, inertia = 1, joint = { kind = "prismatic", axis = [1, 0], displacement = "x" } }
        forces.push = { kind = "force", point = "load.origin", force = ["-d*x - d*x'", 0] }
    """
    d = np.array([1.0, 100.0, 1e5])
    runs = eomgen.simulate_many(eomgen.loads(text), time=3, parameters={"d": d}, samples=7, rtol=1e-7)
    assert "Stiff from" in runs.message[2] and runs.steps[2] < 2000
    for row, each in zip(runs["x"], d, strict=True):
        a, b = np.roots([1, each, each]).astype(complex)
        exact = ((a * np.exp(b * runs.t) - b * np.exp(a * runs.t)) / (a - b)).real
        assert row == pytest.approx(exact, abs=1e-6)


@pytest.mark.slow
@needs_compiler
@pytest.mark.parametrize("name", ["double_pendulum", "arm3", "tippe_top", "car_axis", "half_car"])
def test_a_program_in_lanes_is_the_program(name):
    """At random states and parameters, a row each, one call by one: vectors, kernels, friction, springs, samples."""
    rhs = eomgen.derive(MODELS / f"{name}.toml").rhs("c")
    rng = np.random.default_rng(1)
    x = rhs.x0 + rng.normal(0, 0.1, (19, len(rhs.x0)))
    t, p = rng.uniform(0, 2, 19), rhs.p0 * rng.uniform(0.9, 1.1, (19, len(rhs.p0)))
    expected = np.array([rhs(float(a), b, c) for a, b, c in zip(t, x, p, strict=True)])
    for function in (rhs, RightHandSide.of(rhs.program, "numpy")):
        assert function.many(t, x, p) == pytest.approx(expected, rel=1e-9, abs=1e-9 * np.max(np.abs(expected)))


@pytest.mark.slow
@needs_compiler
def test_functions_of_vectors_are_those_of_the_library():
    """Every function of the grammar, sines of large and of negative arguments too."""
    names = ["sin(x)", "cos(x)", "tan(x)", "sqrt(1 + x*x)", "exp(-x*x)", "log(2 + sin(x))", "abs(x)", "sign(x)"]
    names += ["atan2(x, 2)", "min(x, y)", "max(x, y)", "tanh(x)", "asin(x/1e9)", "sin(1e5*x)", "cos(-1e7*x)"]
    pushed = " + ".join(f"{k + 1}*{name}" for k, name in enumerate(names))
    text = f"""
        eomgen = 1
        space = "plane"
        coordinates = {{ x = 0, y = 0.5, z = 0 }}
        bodies.load = {{ mass = 1, inertia = 1, joint = {{ kind = "planar", x = "x", y = "y", angle = "z" }} }}
        forces.push = {{ kind = "force", point = "load.origin", force = ["{pushed}", 0] }}
    """
    rhs = eomgen.derive(eomgen.loads(text)).rhs("c")
    x = np.zeros((64, 6))
    x[:, 0] = np.concatenate([np.linspace(-40, 40, 60), [1e6, -3e5, 0.0, -1e-9]])
    p = np.zeros((64, 0))
    expected = np.array([rhs(0.0, row, p[0]) for row in x])
    assert rhs.many(0.0, x, p) == pytest.approx(expected, rel=1e-12, abs=1e-11)


def test_what_makes_no_sense_is_refused():
    model = MODELS / "double_pendulum.toml"
    for requested, message in (
        ({"parameters": {"l1": [1.0, 2.0]}, "start": {"theta1": [1.0]}}, "several lengths"),
        ({"parameters": {"q": [1.0, 2.0]}}, "no parameter 'q'"),
        ({"start": {"theta1": [1.0, np.nan]}}, "finite numbers"),
        ({"threads": 0}, "0 threads"),
    ):
        with pytest.raises(UsageError, match=message):
            eomgen.simulate_many(model, time=1, **requested)


@pytest.mark.slow
def test_runs_as_tables():
    runs = eomgen.simulate_many(MODELS / "double_pendulum.toml", time=1, samples=3, parameters={"l1": [1.0, 2.0]})
    frame = runs.to_pandas()
    assert frame.shape == (6, 4) and frame.loc[(1, 1.0), "theta1"] == runs["theta1"][1, 2]
    xarray = pytest.importorskip("xarray")
    found = runs.to_xarray()
    assert isinstance(found, xarray.Dataset) and dict(found.sizes) == {"run": 2, "time": 3}
    assert found["l1"].values.tolist() == [1.0, 2.0] and found["status"].values.tolist() == ["finished"] * 2


@pytest.mark.slow
def test_a_run_without_numbers_is_not_finished():
    """status = "finished" where x is finite at all instants, and there alone."""
    found = eomgen.simulate_many(MODELS / "simple_pendulum.toml", time=0.1, parameters={"l": [1, 2]})
    x = found.x.copy()
    x[1, -1] = np.nan
    failing = [each.name for each in replace(found, x=x).certify().checks if each.status == "fails"]
    assert found.certify().ok and failing == ["runs that are finished have numbers at all instants"]
