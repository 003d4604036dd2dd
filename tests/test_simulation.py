"""Integration: order of convergence, what is kept, how a run ends, and what is written of it."""

from __future__ import annotations

import csv
import io
import math
import re
from pathlib import Path

import numpy as np
import pytest
from hand_made import cart_pole, pendulum, symbols, tied_pendulum

import eomgen
from eomgen.codegen.program import program_of, right_hand_side
from eomgen.codegen.rhs import compiled
from eomgen.errors import RunFailed, UsageError
from eomgen.report.figures import mathtext
from eomgen.report.plots import plot_trajectory
from eomgen.simulation.integrate import METHODS, drift_of, integrate
from eomgen.simulation.trajectory import Trajectory

MODELS = Path(__file__).parent.parent / "models"
PENDULUM = {"x0": [1.0, 0.0], "p": [1.0, 1.0, 9.81]}


def rhs_of(assembly, inputs=None):
    return compiled(right_hand_side(assembly, inputs), "numpy")


def energy_of(assembly, p):
    function = compiled(program_of((assembly.T, assembly.V), assembly.symbols, inputs={"F": 0}), "numpy")
    return lambda t, x: function.many(t, x, p).T


def flow(rate, x0, **options) -> Trajectory:
    """One state y with y' = rate(graph, y, t)."""
    s = symbols("", "y")
    g, y = s.graph, s.graph.symbol("y")
    s = type(s)(g, s.t, {}, {}, (y,), (), ())
    return integrate(compiled(program_of([rate(g, y, s.t)], s), "numpy"), x0=[x0], p=[], **options)


def run(**options) -> Trajectory:
    assembly = pendulum()
    known = PENDULUM | {"time": 3.0, "energy": energy_of(assembly, PENDULUM["p"])} | options
    return integrate(rhs_of(assembly), **known)


def test_a_small_swing_has_the_period_of_the_textbook():
    """T = 2 pi sqrt(l/g) (1 + theta0^2/16 + ...): after one period the pendulum is back."""
    angle = 1e-3
    period = 2 * math.pi / math.sqrt(9.81) * (1 + angle**2 / 16)
    end = run(x0=[angle, 0.0], time=period, atol=1e-14).x[-1]
    assert end == pytest.approx([angle, 0.0], abs=1e-9)


@pytest.mark.parametrize("method", METHODS)
def test_the_error_falls_with_the_tolerance(method):
    """Against y' = -y, y(2) = e^-2: the error stays near the tolerance for every method."""
    errors = [
        abs(flow(lambda g, y, t: -y, 1.0, time=2.0, rtol=tol, atol=tol, method=method).x[-1, 0] - math.exp(-2))
        for tol in (1e-4, 1e-7)
    ]
    assert errors[1] < errors[0] / 30 and errors[1] < 1e-5


def test_the_integrator_is_of_the_eighth_order():
    """Measured: the error of DOP853 goes as h^8, that is tolerance^1, over six decades of tolerance."""
    exact = run(rtol=1e-13, atol=1e-13).x[-1]
    tolerances = [1e-5, 1e-7, 1e-9, 1e-11]
    runs = [run(rtol=tol, atol=tol, samples=None) for tol in tolerances]
    errors = [np.abs(r.x[-1] - exact).max() for r in runs]
    order = -np.polyfit(np.log([r.steps for r in runs]), np.log(errors), 1)[0]
    assert 6.5 < order < 10


def test_energy_is_kept_as_well_as_the_tolerance_says():
    """T + V of the pendulum is constant; its drift falls with the tolerance."""
    coarse, fine = run(rtol=1e-5, atol=1e-5), run()
    assert fine.drift < 1e-7 and coarse.drift > 10 * fine.drift
    assert fine.energy[0] == pytest.approx(-9.81 * math.cos(1.0))


def test_drift_is_measured_by_the_energy_that_moves():
    """max |E - E(0)| / max(T, |V - V(0)|): a constant in V, however large, does not hide a drift."""
    T, V = np.array([0.0, 1.0]), np.array([1e6, 1e6 - 0.5])
    assert drift_of(T, V) == pytest.approx(0.5)
    assert drift_of(np.zeros(2), np.ones(2)) == 0


def test_no_drift_is_claimed_where_energy_need_not_stay():
    """A driven or damped system: energy is given, drift is not."""
    result = run(conservative=False)
    assert result.drift is None and result.energy is not None
    assert run(energy=None).energy is None


def test_the_gap_of_a_tie_is_reported():
    """max |phi| of the pendulum whose rod is a closing tie."""
    assembly = tied_pendulum()
    p = [1.0, 1.0, 9.81]
    gaps = compiled(program_of(assembly.phi, assembly.symbols), "numpy")
    result = integrate(
        rhs_of(assembly), time=2.0, x0=[0.6, -0.8, 0, 0], p=p, gaps=lambda t, x: gaps.many(t, x, p),
        energy=energy_of(assembly, p),
    )  # fmt: skip
    assert result.ok and 0 < result.gap < 1e-7 and result.drift < 1e-7
    assert "Ties open by at most" in result.summary()


def test_a_given_input_replaces_the_models_own():
    """x'' = F/(M + m) for a cart whose pendulum has no weight to swing by: F = 0 in the model, 3 from the caller."""
    rhs = rhs_of(cart_pole(), {"F": 0})
    options = {"time": 1.0, "x0": [0, 0, 0, 0], "p": [1.0, 1e-12, 1.0, 9.81]}
    assert integrate(rhs, **options).x[-1, 0] == 0
    assert integrate(rhs, inputs=lambda t: [3.0], **options).x[-1, 0] == pytest.approx(1.5)


def test_samples_are_where_they_were_asked_for():
    """Evenly spaced by number; at given instants; or the integrator's own steps."""
    assert np.allclose(run(samples=7).t, np.linspace(0, 3, 7))
    at = [0.5, 0.75, 2.999]
    result = run(samples=at)
    assert list(result.t) == at and len(result.x) == 3
    own = run(samples=None)
    assert len(own.t) == own.steps + 1 and own.t[-1] == 3.0
    assert result.x[-1] == pytest.approx(run(time=2.999).x[-1], abs=1e-8)


ENDS = {
    "a pole": (lambda g, y, t: y * y, 1.0, 1.0),  # y = 1/(1 - t)
    "a root's end": (lambda g, y, t: g.sqrt(1 - t), 0.0, 1.0),
    "a root of the state": (lambda g, y, t: -1 / g.sqrt(y), 1.0, 2 / 3),  # y^(3/2) = 1 - 3 t/2
}


@pytest.mark.parametrize("name", ENDS)
@pytest.mark.parametrize("method", ["DOP853", "Radau", "LSODA"])
def test_a_run_that_cannot_go_on_ends_with_what_there_is(name, method):
    """An outcome with a message that names the time, not an exception."""
    rate, x0, end = ENDS[name]
    result = flow(rate, x0, time=2.0, method=method)
    assert not result.ok and result.status in ("not finite", "step too small")
    assert result.t[-1] == pytest.approx(end, abs=1e-3) and np.isfinite(result.x).all()
    assert result.message.startswith("Stopped at t = ") and result.phases[-1].end == result.t[-1]


def test_a_start_without_accelerations_ends_at_once():
    """nan at the start is said, and nothing is integrated."""
    result = flow(lambda g, y, t: g.sqrt(y), -1.0, time=1.0)
    assert result.status == "not finite" and len(result) == 1 and result.t[0] == 0


def test_a_run_without_end_is_given_up():
    """most_steps bounds the work."""
    result = run(most_steps=3)
    assert result.status == "too many steps" and result.steps == 3 and 0 < result.t[-1] < 3


def test_a_run_of_no_time_and_one_of_no_states_are_their_starts():
    """time = 0: the start; nq = nu = 0: nothing moves."""
    assert run(time=0).x.tolist() == [[1.0, 0.0]]
    still = integrate(compiled(program_of((), symbols("")), "numpy"), time=1.0, x0=[], p=[])
    assert still.ok and still.x.shape == (1001, 0) and still.t[-1] == 1.0


BAD = {
    "x has 1 entries, not 2": {"x0": [1.0]},
    "p has 2 entries, not 3": {"p": [1.0, 2.0]},
    "no p": {"p": None},
    "x0 must be finite": {"x0": [math.nan, 0.0]},
    "makes no sense": {"time": -1.0},
    "tolerances must be positive": {"rtol": 0.0},
    "unknown method 'euler'": {"method": "euler"},
    "1 samples": {"samples": 1},
    "samples must be instants": {"samples": [2.0, 1.0]},
}


@pytest.mark.parametrize("message", BAD)
def test_senseless_questions_are_refused(message):
    """What is wrong, said before anything is integrated."""
    with pytest.raises(UsageError, match=message):
        run(**BAD[message])


# -- ties that come to depend on one another ------------------------------------------------------------


def test_a_run_led_astray_at_a_change_point_ends_with_time_and_tie():
    """Four equal cranks in line with their coupler: the closing rows lose rank, and the motion may branch."""
    with pytest.warns(RuntimeWarning, match="Statically indeterminate"):
        result = eomgen.simulate(eomgen.load(MODELS / "four_cranks.toml"), time=0.3, target="numpy")
    assert result.status == "singular" and result.drift < 1e-6
    where = r"Stopped at t = 0\.24\d* s: 'P', 'Q', 'R' do not determine the motion there "
    assert re.fullmatch(where + r"\(a dead centre or a change point\)\.", result.message)
    assert result["a"][-1] == pytest.approx(0, abs=0.02)


def test_ties_that_stay_independent_end_no_run():
    """The same cranks, started so slowly that they swing back before the change point."""
    hanging = {name: -math.pi / 2 + 0.3 for name in "abce"}
    with pytest.warns(RuntimeWarning, match="Statically indeterminate"):
        result = eomgen.simulate(eomgen.load(MODELS / "four_cranks.toml"), time=2, target="numpy", start=hanging)
    assert result.ok and result.drift < 1e-6


# -- what is written ------------------------------------------------------------------------------


def test_csv_holds_every_digit():
    """Header t, coordinates, speeds, energy; read back it is the same doubles."""
    result, text = run(samples=5), io.StringIO()
    result.to_csv(text)
    head, *rows = csv.reader(io.StringIO(text.getvalue()))
    assert head == ["t", "theta", "theta'", "energy"]
    numbers = np.array(rows, dtype=float)
    assert (numbers == np.column_stack([result.t, result.x, result.energy])).all()


def test_npz_holds_the_same(tmp_path):
    """t, x, names, energy, status."""
    result = run(samples=5)
    result.to_npz(tmp_path / "run.npz")
    with np.load(tmp_path / "run.npz") as found:
        assert (found["x"] == result.x).all() and (found["energy"] == result.energy).all()
        assert list(found["coordinates"]) == ["theta"] and list(found["speeds"]) == ["theta'"]
        assert str(found["status"]) == "finished"


@pytest.mark.parametrize("write", ["to_csv", "to_npz"])
def test_a_file_that_cannot_be_written_leaves_nothing(write, tmp_path):
    """No folder: an error that names the path; a folder in the file's place: the same, and no remains."""
    result = run(samples=3)
    with pytest.raises(RunFailed, match="cannot be written"):
        getattr(result, write)(tmp_path / "nowhere" / "run")
    (tmp_path / "run").mkdir()
    with pytest.raises(RunFailed, match="cannot be written"):
        getattr(result, write)(tmp_path / "run")
    assert [path.name for path in tmp_path.iterdir()] == ["run"]


def test_columns_are_found_by_name():
    """trajectory["theta'"]; a wrong name is answered with the right ones."""
    result = run(samples=5)
    assert (result["theta'"] == result.x[:, 1]).all()
    with pytest.raises(KeyError, match="theta, theta', energy"):
        result["phi"]


def test_a_trajectory_shows_itself_in_a_notebook():
    """A summary and a table with escaped names."""
    shown = run(samples=50)._repr_html_()
    assert "Reached t = 3 s." in shown and shown.count("<tr>") == 7 and "theta&#x27;" in shown


@pytest.mark.parametrize("ending", ["png", "svg"])
def test_a_plot_has_a_panel_for_each_unit_and_one_for_the_energy(ending, tmp_path):
    """The file is a picture of its kind and is the same when drawn again."""
    path, result = tmp_path / f"run.{ending}", run(samples=50)
    plot_trajectory(result, path, title="Pendulum", units={"theta": "rad"})
    first = path.read_bytes()
    assert first.startswith(b"\x89PNG") if ending == "png" else first.count(b'id="axes_') == 2
    plot_trajectory(result, path, title="Pendulum", units={"theta": "rad"})
    assert path.read_bytes() == first
    with pytest.raises(UsageError, match=r"run\.txt"):
        plot_trajectory(result, tmp_path / "run.txt")
    with pytest.raises(RunFailed, match="cannot be written"):
        plot_trajectory(result, tmp_path / "nowhere" / f"run.{ending}")


NAMES = {
    "theta1'": r"\dot{\theta}_{1}",
    "x": "x",
    "x_left''": r"\ddot{x}_{\mathrm{left}}",
    "ω2": "ω_{2}",
    "slider": r"\mathrm{slider}",
    "q_a_1": r"q_{\mathrm{a\,1}}",
}


@pytest.mark.parametrize("name", NAMES)
def test_names_are_set_as_mathematics(name):
    """Dots for primes, subscripts for numbers."""
    assert mathtext(name) == NAMES[name]
