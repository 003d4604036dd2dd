"""Integration: order of convergence, what is kept, how a run ends, and what is written of it."""

from __future__ import annotations

import csv
import io
import math
from pathlib import Path

import numpy as np
import pytest
from click.testing import CliRunner
from each import each
from hand_made import cart_pole, pendulum, symbols, tied_pendulum

import eomgen
from eomgen.cli import main
from eomgen.codegen.program import Program
from eomgen.codegen.rhs import RightHandSide
from eomgen.documents.figures import heads_in_symbols, mathtext, over_time, range_without_noise
from eomgen.errors import UsageError, WriteFailed
from eomgen.mechanics.dynamics import formulations as recursive
from eomgen.model.quantities import Unit
from eomgen.page.animation import Showing, animate_document
from eomgen.proof.reported_run import ReportedRun, run_reported
from eomgen.runs.single_run import page_time, run_of_a_page
from eomgen.runs.single_run import run as run_equations
from eomgen.simulation.integration import drift_of, integrate
from eomgen.simulation.integrator import Stepping
from eomgen.simulation.phase_model import slope_of
from eomgen.simulation.result import Trajectory
from eomgen.simulation.solvers import METHODS

pytestmark = pytest.mark.slow

MODELS = Path(__file__).parent.parent / "models"
PENDULUM = {"x0": [1.0, 0.0], "p": [1.0, 1.0, 9.81]}


def rhs_of(equations):
    return RightHandSide.of(Program.right_hand_side(equations), "numpy")


def energy_of(equations, p):
    function = RightHandSide.of(Program.of((equations.T, equations.V), equations.symbols, inputs={"F": 0}), "numpy")
    return lambda t, x: function.many(t, x, p).T


def flow(rate, x0, **options) -> Trajectory:
    """One state y with y' = rate(graph, y, t)."""
    s = symbols("", "y")
    g, y = s.graph, s.graph.symbol("y")
    s = type(s)(g, s.t, {}, {}, (y,), (), ())
    return integrate(RightHandSide.of(Program.of([rate(g, y, s.t)], s), "numpy"), x0=[x0], p=[], **options)


def run(**options) -> Trajectory:
    equations = pendulum()
    known = PENDULUM | {"time": 3.0, "energy": energy_of(equations, PENDULUM["p"])} | options
    return integrate(rhs_of(equations), **known)


def test_a_small_swing_has_the_period_of_the_textbook():
    """T = 2 pi sqrt(l/g) (1 + theta0^2/16 + ...): after one period the pendulum is back."""
    angle = 1e-3
    period = 2 * math.pi / math.sqrt(9.81) * (1 + angle**2 / 16)
    end = run(x0=[angle, 0.0], time=period, atol=1e-14).x[-1]
    assert end == pytest.approx([angle, 0.0], abs=1e-9)


@each("method", METHODS)
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
    """max |phi| of the pendulum whose rod is a closing constraint."""
    equations = tied_pendulum()
    p = [1.0, 1.0, 9.81]
    gaps = RightHandSide.of(Program.of(equations.phi, equations.symbols), "numpy")
    result = integrate(
        rhs_of(equations),
        time=2.0,
        x0=[0.6, -0.8, 0, 0],
        p=p,
        gaps=lambda t, x: gaps.many(t, x, p),
        energy=energy_of(equations, p),
    )
    assert result.ok and 0 < result.gap < 1e-7 and result.drift < 1e-7
    assert "Constraints open by at most" in result.summary()


def test_a_given_input_replaces_the_models_own():
    """x'' = F/(M + m) for a cart whose pendulum has no weight to swing by: F = 0 in the model, 3 from the caller."""
    rhs = rhs_of(cart_pole(F=0))
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


def test_a_start_at_rest_says_that_nothing_moves():
    """x(t) = x(0) is said of a rest, stable or not; not of what moves, were it little, nor of what moves by a law."""
    text = """
    eomgen = 1
    space = "plane"
    parameters = {{ m = 1, l = 1, g = 9.81 }}
    coordinates.q = {coordinate}
    bodies.bob.shape = {{ kind = "particle", mass = "m" }}
    bodies.bob.joint = {{ kind = "placed", at = ["l*sin(q)", "l*cos(q)"] }}
    forces.weight = {{ kind = "gravity", acceleration = [0, "-g"] }}
    """
    for coordinate, still in (("0", True), ("1e-9", False), ('{ motion = "1e-6*t" }', False)):
        run = eomgen.simulate(eomgen.loads(text.format(coordinate=coordinate)), time=1)
        assert bool(run.still) == still
    assert "--start q=" in eomgen.simulate(eomgen.loads(text.format(coordinate="0")), time=1).still


def test_what_is_too_fast_to_be_looked_at_is_followed_for_a_shorter_time():
    """A turn takes 1e-6 s: of 10 s a page shows a round part, and says so; a time that is asked for stays."""
    text = """
    eomgen = 1
    space = "plane"
    parameters = { m = 1, k = 3.948e13 }
    coordinates = { x = 1 }
    points = { O = [0, 0] }
    bodies.b.shape = { kind = "particle", mass = "m" }
    bodies.b.joint = { kind = "prismatic", axis = [1, 0], displacement = "x" }
    forces.s = { kind = "spring", points = ["O", "b.origin"], stiffness = "k", length = 0 }
    """
    equations = eomgen.derive(eomgen.loads(text))
    run, words = run_of_a_page(equations, None, 11)
    assert run.ok and 1e-6 < run.t[-1] < 1 and run.t[-1] == float(f"{run.t[-1]:.0e}") and f"{run.t[-1]:g} s" in words
    requested, words = run_of_a_page(equations, 2e-6, 11)
    assert requested.t[-1] == 2e-6 and not words


@each(
    "stiffness, damping, time, words",
    [
        (1000, 0, 0.6, "three periods"),  # T = 2 pi/sqrt(1000) = 0.199 s
        (0.09, 0, 10, ""),  # T = 20.9 s: nobody sees in 10 s that it swings
        (0.5, 0, 30, "three periods"),  # T = 8.9 s
        (1000, 40, 0.4, "until it rests"),  # exp(-20 t) with a swing in it
        (4, 0, 10, ""),  # T = 3.1 s
        (0, 0, 10, ""),  # it goes on
    ],
)
def test_a_page_lasts_as_its_motion_wants(stiffness, damping, time, words):
    text = f"""
    eomgen = 1
    space = "plane"
    parameters = {{ m = 1, k = {stiffness}, c = {damping} }}
    coordinates.x = {{ start = 1, speed = 1 }}
    points = {{ O = [0, 0] }}
    bodies.b.shape = {{ kind = "particle", mass = "m" }}
    bodies.b.joint = {{ kind = "prismatic", axis = [1, 0], displacement = "x" }}
    forces.s = {{ kind = "spring", points = ["O", "b.origin"], stiffness = "k", length = 0 }}
    forces.d = {{ kind = "damper", points = ["O", "b.origin"], damping = "c" }}
    """
    run, why = run_of_a_page(eomgen.derive(eomgen.loads(text)), None, 11)
    assert run.ok and run.t[-1] == pytest.approx(time) and (words in why if words else not why)


def test_pages_of_a_motion_that_cannot_go_on_show_it_so_far(tmp_path):
    """x = 0.8 t and cos(alpha) = -x/0.5 end at t = 0.625 s; where a time is asked for the run has failed."""
    text = """
    eomgen = 1
    space = "plane"
    coordinates.x = { motion = "0.8*t" }
    coordinates.alpha = { dependent = true, near = "pi/2" }
    bodies.rod.shape = { kind = "rod", mass = 1, length = 0.5 }
    bodies.rod.joint = { kind = "planar", x = "x", y = 0, angle = "alpha" }
    constraints.wall = { kind = "support", point = "rod.end", normal = [1, 0], at = [0, 0] }
    """
    model = eomgen.loads(text)
    equations = eomgen.derive(model)
    run, words = run_of_a_page(equations, None, 11)
    assert run.ok and run.t[-1] == 0.5 and "Followed for 0.5 s. Stopped at t = 0.625 s: 'wall'" in words
    requested, words = run_of_a_page(equations, 1.0, 11)
    assert requested.ended == "singular" and not requested.ok and not words
    strip = animate_document(model, output=str(tmp_path / "x.png"), time=None, showing=Showing(frames=2))
    assert not strip.failed and "Followed for 0.5 s" in str(strip.notes)


def test_pages_of_contacts_that_change_without_end_show_a_part():
    """m y'' = F cos(w t) - m g + N, N >= 0: it leaves the floor in each turn."""
    text = """
    eomgen = 1
    space = "plane"
    coordinates.y = 0
    bodies.b.shape = { kind = "particle", mass = 1 }
    bodies.b.joint = { kind = "prismatic", axis = [0, 1], displacement = "y" }
    constraints.T = { kind = "support", point = "b.origin", normal = [0, 1], unilateral = true }
    forces.w = { kind = "gravity", acceleration = [0, -9.81] }
    forces.F = { kind = "force", point = "b.origin", force = [0, "-30*cos(20*t)"] }
    """
    found = run_equations(eomgen.derive(eomgen.loads(text)), time=5, samples=11, how=Stepping(most_phases=3))
    assert found.ended == "contact" and "after 3 phases the contacts 'T' still change" in found.message
    time, words = page_time(found)
    assert time == float(f"{time:.0e}") < found.t[-1] and words == f"Followed for {time:g} s. {found.message}"


def test_a_run_of_no_time_and_one_of_no_states_are_their_starts():
    """time = 0: the start; nq = nu = 0: nothing moves."""
    assert run(time=0).x.tolist() == [[1.0, 0.0]]
    still = integrate(RightHandSide.of(Program.of((), symbols("")), "numpy"), time=1.0, x0=[], p=[])
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


@each("message", BAD)
def test_senseless_questions_are_refused(message):
    """What is wrong, said before anything is integrated."""
    with pytest.raises(UsageError, match=message):
        run(**BAD[message])


# -- constraints that come to depend on one another ------------------------------------------------------------


def test_a_run_is_carried_across_a_change_point():
    """Four equal cranks in line with their coupler: the rows lose rank, and the motion stays on its branch."""
    with pytest.warns(RuntimeWarning, match="Statically indeterminate"):
        result = eomgen.simulate(eomgen.load(MODELS / "four_cranks.toml"), time=0.3, target="numpy")
    assert result.ok and result.drift < 1e-6
    ((start, end),) = result.carried
    assert 0.24 < start < end < 0.25 and result["a"][-1] < 0
    assert result["b"] == pytest.approx(result["a"], abs=1e-7)


def test_ties_that_stay_independent_end_no_run():
    """The same cranks, started so slowly that they swing back before the change point."""
    hanging = {name: -math.pi / 2 + 0.3 for name in "abce"}
    with pytest.warns(RuntimeWarning, match="Statically indeterminate"):
        result = eomgen.simulate(eomgen.load(MODELS / "four_cranks.toml"), time=2, target="numpy", start=hanging)
    assert result.ok and result.drift < 1e-6


# -- stiff methods, Baumgarte's rows, conditions that end a run --------------------------------------


@each("name", ["double_pendulum", "four_bar", "four_cranks", "gyrostat", "spherical_pendulum"])
def test_the_derivative_of_the_right_hand_side_is_exact(name):
    """d(x')/dx against central differences: trees, dependent coordinates, redundant constraints, quaternions."""
    equations = eomgen.derive(eomgen.load(MODELS / f"{name}.toml"))
    p, rhs, x = RightHandSide.parameter_values(equations.model), equations.rhs("numpy"), equations.start()
    x = x + 0.01 * np.sin(np.arange(len(x)) + 1.0) * (name != "four_cranks")
    slope = slope_of(equations.graph, p)
    found, h = slope(0.3, x), 1e-6
    columns = [(rhs(0.3, x + h * e, p) - rhs(0.3, x - h * e, p)) / (2 * h) for e in np.eye(len(x))]
    scale = max(1.0, np.abs(found).max())
    assert found[: len(rhs.coordinates)] == pytest.approx(np.column_stack(columns)[: len(rhs.coordinates)], abs=1e-6)
    if name != "four_cranks":  # off the constraints redundant rows contradict one another
        assert found == pytest.approx(np.column_stack(columns), abs=1e-7 * scale)


TIED = """
eomgen = 1
name = "A pendulum whose rod is a tie"
space = "plane"
coordinates = { x = 0.6, y = -0.8 }
points = { O = [0, 0] }
bodies.bob = { shape = { kind = "particle", mass = 1 }, joint = { kind = "placed", at = ["x", "y"] } }
constraints.rod = { kind = "link", points = ["bob.origin", "O"], length = 1 }
forces.weight = { kind = "gravity", acceleration = [0, -9.81] }
"""


STIFF = """
eomgen = 1
name = "A light bob on a stiff damped spring, hung from a cart"
space = "plane"
coordinates = { x = 0, s = 0.01 }
[bodies.cart]
shape = { kind = "particle", mass = 1 }
joint = { kind = "prismatic", axis = [1, 0], displacement = "x" }
[bodies.bob]
shape = { kind = "particle", mass = 0.001 }
joint = { kind = "prismatic", on = "cart", axis = [1, 0], displacement = "s", stiffness = 1e4, damping = 200 }
[forces]
pull = { kind = "force", point = "cart.origin", force = ["cos(t)", 0] }
"""


@each("method", ["Radau", "BDF", "LSODA"])
def test_stiff_methods_take_few_steps_where_the_others_need_many(method):
    """Rates from 1 to 2e5 1/s: (m1 + m2) x'' = cos(t) to the tolerance, in a hundredth of the steps."""
    model = eomgen.loads(STIFF)
    stiff = eomgen.simulate(model, time=2, method=method, rtol=1e-6, atol=1e-9)
    assert stiff.ok and stiff.steps < 4000
    assert stiff["x"][-1] == pytest.approx((1 - math.cos(2)) / 1.001, abs=2e-4)
    assert eomgen.simulate(model, time=0.05, method="DOP853", rtol=1e-6, atol=1e-9).steps > 500


def test_baumgartes_rows_close_a_gap_as_a_damped_oscillation():
    """phi'' + 2 alpha phi' + beta^2 phi = 0: with alpha = beta from rest phi = phi0 (1 + beta t) exp(-beta t)."""
    system = eomgen.derive(eomgen.loads(TIED)).system
    pulling = recursive.assembled_by_recursion(system).stabilized((5.0, 5.0))
    found = integrate(
        RightHandSide.of(Program.right_hand_side(pulling), "numpy"), time=2.0, x0=[0.6, -0.85, 0, 0], p=[]
    )
    gap = (found["x"] ** 2 + found["y"] ** 2 - 1) / 2
    t, first = found.t, (0.6**2 + 0.85**2 - 1) / 2
    assert gap == pytest.approx(first * (1 + 5 * t) * np.exp(-5 * t), abs=1e-8)


GEARED = """
eomgen = 1
space = "plane"
[coordinates]
a = 0.3
b = { dependent = true }
[bodies.A]
mass = 1
inertia = 2
joint = { kind = "revolute", angle = "a", torque = 1 }
[bodies.C]
mass = 1
inertia = 2
joint = { kind = "revolute", angle = "b" }
[constraints.gear]
kind = "equation"
gap = "b - 2*a"
"""


def test_baumgartes_rows_need_multipliers():
    model = eomgen.loads(GEARED)
    with pytest.raises(UsageError, match=r"'gear' has none: it gives dependent coordinates"):
        eomgen.simulate(model, time=1, stabilization="baumgarte")


def test_baumgartes_rows_pull_where_dependent_rates_could_be_undetermined():
    """At a dead centre the rates of dependent angles are 0/0: the pin has multipliers, and pulls."""
    pulled, projected = (
        eomgen.simulate(eomgen.load(MODELS / "four_bar.toml"), time=1, samples=3, stabilization=how)
        for how in ("baumgarte", "projection")
    )
    assert pulled["alpha"] == pytest.approx(projected["alpha"], abs=1e-6)


def test_a_run_ends_where_a_condition_first_holds():
    """Any equation of the model: an angle, a time, a reaction; one that never holds is said not to have come."""
    model = eomgen.load(MODELS / "double_pendulum.toml")
    first = next(iter(model.coordinates))
    full = eomgen.simulate(model, time=3)
    level = float(np.mean([full[first][0], full[first].min()]))
    found = eomgen.simulate(model, time=3, until=f"{first} = {level!r}")
    assert found.ok and found.status == "event" and found.t[-1] < 3
    assert found[first][-1] == pytest.approx(level, abs=1e-9) and np.all(found[first][:-1] > level)
    assert found.message.startswith(f"{first} = {level!r} at t = ")
    assert eomgen.simulate(model, time=3, until="t = 1/3").t[-1] == pytest.approx(1 / 3, abs=1e-12)
    never = eomgen.simulate(model, time=1, until=f"{first} = 100")
    assert never.status == "finished" and never.message.endswith(f"'{first} = 100' did not come.")


def test_a_condition_may_ask_for_a_reaction():
    """The tension of a pendulum's rod let go from level: m l w^2 + m g cos = 3 m g cos(theta) = 2 m g."""
    found = eomgen.simulate(eomgen.loads(TIED), time=2, start={"x": 1.0, "y": 0.0}, until="tension(rod) = 2*9.81")
    assert -found["y"][-1] == pytest.approx(2 / 3, abs=1e-8)


@each(
    "until, message",
    [
        ("thta = 1", "unknown name 'thta'"),
        ("theta1", "is no equation"),
        ("theta1 = = 2", "until 'theta1 = = 2'"),
    ],
)
def test_a_condition_that_makes_no_sense_is_refused(until, message):
    with pytest.raises(UsageError, match=message):
        eomgen.simulate(eomgen.load(MODELS / "double_pendulum.toml"), time=1, until=until)


# -- what is written ------------------------------------------------------------------------------


def test_csv_holds_every_digit():
    """Header t, coordinates, speeds, energy; read back it is the same doubles."""
    result, text = run(samples=5), io.StringIO()
    result.to_csv(text)
    head, *rows = csv.reader(io.StringIO(text.getvalue()))
    assert head == ["t", "theta", "theta'", "energy"]
    numbers = np.array(rows, dtype=float)
    assert (numbers == np.column_stack([result.t, result.x, result.energy])).all()


def test_a_table_of_a_run_has_the_letters_of_formulas(tmp_path):
    """`simulate --symbols`: heads in LaTeX, which the proof reads back; a head in another's place is seen."""
    path = MODELS / "conker.toml"
    found = CliRunner().invoke(main, ["simulate", str(path), "-o", str(tmp_path / "a.csv"), "--symbols", "--time", "1"])
    assert found.exit_code == 0, found.output
    head = (tmp_path / "a.csv").read_text().splitlines()[0]
    assert r"$\varphi$,$\dot{\varphi}$,energy" in head and "tension(thread)" in head
    run = eomgen.simulate(path, time=1)
    swapped = {"phi": r"$\dot{\varphi}$", "phi'": r"$\varphi$"}
    for heads, right in ((heads_in_symbols(run), True), (swapped, False)):
        page = io.StringIO()
        run.to_csv(page, heads=heads)
        first, *lines = csv.reader(io.StringIO(page.getvalue()))
        rows = [(name, repr(float(x[0])), repr(float(x[-1]))) for name, x in run.columns().items()]
        checks = run_reported(run, eomgen.load(path), ReportedRun(rows, table=(first, lines)))
        assert all(check.status == "holds" for check in checks) == right


@each(
    "curves, size, shown",
    [
        ([[0.5, 0.5 + 1e-16]], None, (0.25, 0.75)),  # a coordinate that stays where it is
        ([[0, 3e-17, -2e-17]], None, (-5e-4, 5e-4)),
        ([[0, 3e-17, -2e-17]], 100, (-50, 50)),  # a reaction beside others of 100 N
        ([[0, 1e-8], [7, 7]], None, None),  # one that changes, by little
        ([[float("nan"), 2, 2]], None, (1, 3)),
        ([], None, None),
    ],
)
def test_noise_is_not_plotted(curves, size, shown):
    found = range_without_noise(map(np.array, curves), size)
    assert found == (None if shown is None else pytest.approx(shown))


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
    """A folder in the file's place, a file in the folder's: an error that names the path, and no remains."""
    result = run(samples=3)
    (tmp_path / "run").mkdir()
    (tmp_path / "file").touch()
    for path in (tmp_path / "run", tmp_path / "file" / "run"):
        with pytest.raises(WriteFailed, match="cannot be written"):
            getattr(result, write)(path)
    assert sorted(path.name for path in tmp_path.iterdir()) == ["file", "run"]


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
    over_time(result, "Pendulum", {"theta": Unit.parse("rad")}).save(path)
    first = path.read_bytes()
    assert first.startswith(b"\x89PNG") if ending == "png" else first.count(b'id="axes_') == 2
    over_time(result, "Pendulum", {"theta": Unit.parse("rad")}).save(path)
    assert path.read_bytes() == first
    with pytest.raises(UsageError, match=r"run\.txt"):
        over_time(result, "", {}).save(tmp_path / "run.txt")
    with pytest.raises(WriteFailed, match="cannot be written"):
        over_time(result, "", {}).save(path / f"run.{ending}")


NAMES = {
    "theta1'": r"\dot{\theta}_{1}",
    "x": "x",
    "x_left''": r"\ddot{x}_{\mathrm{left}}",
    "ω2": r"\omega_{2}",
    "slider": r"\mathrm{slider}",
    "q_a_1": "q_{a,1}",
}


@each("name", NAMES)
def test_names_are_set_as_mathematics(name):
    """Dots for primes, subscripts for numbers."""
    assert mathtext(name) == NAMES[name]
