"""Sweeps: each run by its number alone, in the table once, whoever is killed; what is asked is what verbs give."""

from __future__ import annotations

import csv
import json
import math
import multiprocessing
import os
import re
import signal
import sqlite3
import subprocess
import sys
import time
from concurrent.futures import Future, ProcessPoolExecutor, ThreadPoolExecutor
from dataclasses import replace
from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pytest
from click.testing import CliRunner
from forked import needs_sh
from scipy import stats
from slow_run import beside, in_slow_run

import eomgen
from eomgen import resources
from eomgen.cli import main
from eomgen.errors import UsageError
from eomgen.proof.drawn import drawn_otherwise, reported_of_all
from eomgen.resources import check_patience
from eomgen.simulation import WholeRun
from eomgen.sweeps import workers
from eomgen.sweeps import workers as kernel
from eomgen.sweeps.design import DESIGNS, Design, DrawnValues, spread_of
from eomgen.sweeps.documents import _answers_proven
from eomgen.sweeps.runs_of_a_plan import sweep_at
from eomgen.sweeps.workers import SweepKernel

ROOT = Path(__file__).parents[1]
MODELS = ROOT / "models"
SPRING = """
eomgen = 1
name = "spring"
space = "plane"
[parameters]
m = { value = 2, unit = "kg" }
k = { value = 50, unit = "N/m" }
M = 1
[coordinates]
x = { start = 10, unit = "cm" }
[bodies.mass]
shape = { kind = "particle", mass = "m*M" }
joint = { kind = "prismatic", axis = [1, 0], displacement = "x", stiffness = "k" }
[outputs]
amplitude = { value = "max(x)", unit = "cm" }
"""


@pytest.fixture
def spring(tmp_path):
    path = tmp_path / "spring.toml"
    path.write_text(SPRING)
    return str(path)


def swept(*words: str) -> subprocess.Popen:
    """The command in a process of its own."""
    environment = {**os.environ, "PYTHONPATH": str(ROOT)}
    return subprocess.Popen(
        [sys.executable, "-m", "eomgen", "sweep", *words],
        env=environment,
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
    )


def table_at(folder: Path) -> list[dict[str, str]]:
    with (folder / "table.csv").open() as file:
        return list(csv.DictReader(file))


# -- the design ------------------------------------------------------------------------------------------------


@pytest.mark.parametrize("kind", DESIGNS)
def test_a_run_is_drawn_by_its_number_alone(kind):
    """All runs at once, one by one, in any order: the same values; another seed gives others."""
    laws = (DrawnValues("a", "normal", (1.0, 0.1)), DrawnValues("b", "uniform", (2.0, 3.0)))
    design = Design({"k": (1.0, 2.0, 4.0)}, laws, 7, kind, 5)
    seeds, values = design.runs(0, design.count)
    apart = [design.runs(k, k + 1) for k in reversed(range(design.count))][::-1]
    assert [seed for (seed,), _ in apart] == seeds and len(set(seeds)) == 21
    assert np.array_equal(np.vstack([found for _, found in apart]), values)
    assert values[:, 0].tolist() == [1.0] * 7 + [2.0] * 7 + [4.0] * 7
    assert not np.array_equal(Design({"k": (1.0, 2.0, 4.0)}, laws, 7, kind, 6).runs(0, 21)[1], values)
    same = kind != "random"
    assert np.array_equal(values[:7, 1:], values[7:14, 1:]) == same


@pytest.mark.parametrize(
    ("text", "law"),
    [
        ("m=normal(3, 0.5)", stats.norm(3, 0.5)),
        ("m=uniform(1, 4)", stats.uniform(1, 3)),
        ("m=loguniform(1, 100)", stats.loguniform(1, 100)),
        ("m=lognormal(2, 0.3)", stats.lognorm(0.3, scale=2)),
        ("m=triangular(1, 2, 5)", stats.triang(0.25, 1, 4)),
    ],
)
@pytest.mark.parametrize("kind", DESIGNS)
def test_draws_have_their_distribution(text, law, kind):
    """Kolmogorov and Smirnov, against scipy's laws; quasi-random points are far nearer than chance."""
    model = eomgen.loads(SPRING)
    values = Design({}, (spread_of(model, text)[0],), 2048, kind, 3).runs(0, 2048)[1][:, 0]
    test = stats.kstest(values, law.cdf)
    assert test.pvalue > 1e-3 and np.isfinite(values).all()
    if kind != "random":
        assert test.statistic < 2e-3


@pytest.mark.slow
def test_values_are_typed_in_the_units_of_the_file_and_in_python_in_si(spring, tmp_path):
    """--over x=5:15:3 of a start in cm; "0.2 m" brings its unit; over={"x": [0.05]} is SI."""
    done = CliRunner().invoke(
        main, ["sweep", spring, "--over", "x=5:15:3", "--ask", "amplitude", "--time", "2", "-o", str(tmp_path / "a")]
    )
    assert done.exit_code == 0, done.output
    rows = table_at(tmp_path / "a")
    assert [float(row["x"]) for row in rows] == pytest.approx([0.05, 0.1, 0.15])
    assert [float(row["amplitude"]) for row in rows] == pytest.approx([0.05, 0.1, 0.15], rel=1e-8)
    other = CliRunner().invoke(
        main,
        [
            "sweep",
            spring,
            "--over",
            "x=0.2 m,7",
            "--ask",
            "amplitude",
            "--time",
            "2",
            "--units",
            "-o",
            str(tmp_path / "b"),
        ],
    )
    rows = table_at(tmp_path / "b")
    assert [float(row["x [cm]"]) for row in rows] == pytest.approx([20, 7]), other.output
    assert [float(row["amplitude [cm]"]) for row in rows] == pytest.approx([20, 7], rel=1e-8)
    found = eomgen.sweep(spring, over={"x": [0.05, "7 cm"]}, ask="amplitude", time=2)
    assert found["x"] == pytest.approx([0.05, 0.07]) and found["amplitude"] == pytest.approx([0.05, 0.07], rel=1e-8)


# -- what is asked ---------------------------------------------------------------------------------------------


@pytest.mark.slow
def test_what_is_asked_is_what_the_verbs_give(spring):
    """Frequency, period, equilibria and reactions of each run: closed forms, and eomgen.simulate at its values."""
    found = eomgen.sweep(
        spring,
        over={"k": "10:90:3", "m": [1, 2]},
        ask=[
            "frequency(1)",
            "period(x)",
            "last(x)",
            "max(x')",
            "x at equilibrium",
            "x' at x = 0",
            "max(reaction_n(mass))",
        ],
        time=12,
    )
    table = found.table
    w = np.sqrt(table["k"] / table["m"])
    assert list(table) == ["run", "seed", "status", "message", "k", "m", *found.plan.requested]
    assert table["frequency(1)"] == pytest.approx(w, rel=1e-12)
    assert table["period(x)"] == pytest.approx(2 * math.pi / w, rel=1e-8)
    assert table["last(x)"] == pytest.approx(0.1 * np.cos(12 * w), abs=1e-7)
    assert table["max(x')"] == pytest.approx(0.1 * w, rel=1e-7)
    assert table["x' at x = 0"] == pytest.approx(-0.1 * w, rel=1e-7)
    assert np.all(table["x at equilibrium"] == 0) and set(table["status"]) == {"finished"}
    run = eomgen.simulate(spring, time=12, parameters={"k": 50, "m": 1}, samples=5)
    assert table["last(x)"][2] == pytest.approx(run["x"][-1], abs=1e-9)
    assert found.to_pandas().loc[2, "k"] == 50


@pytest.mark.slow
def test_critical_values_are_where_the_sign_changes(spring):
    """cos(sqrt(k/m) T) = 0: every place where the mass ends in the middle, for each m."""
    found = eomgen.sweep(spring, over={"k": "10:90:30", "m": [1, 2]}, critical="last(x)", time=1)
    values = [(row["at"]["m"], row["value"]) for row in found.critical]
    wanted = [(m, m * (math.pi * (n + 0.5)) ** 2) for m in (1, 2) for n in range(5)]
    wanted = [(m, k) for m, k in wanted if 10 < k < 90]
    assert sorted(values) == [(m, pytest.approx(k, rel=1e-8)) for m, k in sorted(wanted)] and values
    jump = eomgen.sweep(spring, over={"k": "10:90:30"}, critical="sign(last(x))", time=1)
    assert {row["message"] for row in jump.critical} == {"it jumps there"}


@pytest.mark.slow
def test_a_zero_at_an_end_of_a_range_is_critical_and_a_zero_everywhere_is_not(spring):
    """f(k) = k - a for a at the first, an inner and the last value; f = 0."""
    for a in (10, 20, 30):
        found = eomgen.sweep(spring, over={"k": [10, 20, 30]}, critical=f"k - {a}", time=1)
        assert [row["value"] for row in found.critical] == [a] and not found.remarks
    flat = eomgen.sweep(spring, over={"k": [10, 20, 30]}, critical="0*k", time=1)
    assert not flat.critical and "is 0 in all runs" in flat.remarks[0]


@pytest.mark.slow
def test_what_nothing_in_a_sweep_changes_is_said(spring):
    """df/dk = 0 of what is asked, of what is to be critical; and what has one sign has no critical value."""
    found = eomgen.sweep(spring, over={"k": [10, 20, 30]}, ask=("m", "k"), critical="m - 5", time=1)
    reported = (found["m"][0], found["m - 5"][0])
    assert found.remarks == (
        f"'m' is {reported[0]:g} in all runs: none of the values set changes it",
        f"'m - 5' changes its sign nowhere along k: 'm - 5' is {reported[1]:g} in all runs: "
        "none of the values set changes it",
    )
    (one,) = eomgen.sweep(spring, over={"k": [10, 20]}, critical="k + 1", time=1).remarks
    assert one == "'k + 1' changes its sign nowhere along k: it goes from 11 to 21"


@pytest.mark.slow
def test_a_run_that_fails_is_a_row_with_its_message(spring):
    """A negative mass is no model; a run that ends early has its status; the others have their values."""
    found = eomgen.sweep(spring, over={"m": [-1, 1, 2]}, ask="last(x)", time=1)
    table = found.table
    assert list(table["status"]) == ["failed", "finished", "finished"] and found.failed == 1
    assert "mass" in table["message"][0] and math.isnan(table["last(x)"][0])
    assert np.isfinite(table["last(x)"][1:]).all()
    ladder = eomgen.sweep(MODELS / "simple_pendulum.toml", over={"theta": [1, 2]}, ask="t at theta = 3", time=1)
    assert np.isnan(ladder["t at theta = 3"]).all() and "is not met" in ladder["message"][0]


# -- once, whoever is killed -----------------------------------------------------------------------------------


SWEEP = ["--over", "k=10:90:12", "--random", "x=normal(10, 1)", "--runs", "25", "--ask", "last(x)", "--time", "3"]


def same_rows(folder: Path, spring: str) -> None:
    """Every run once, with the bits of a sweep that nobody disturbed."""
    rows = table_at(folder)
    assert [int(row["run"]) for row in rows] == list(range(300))
    calm = eomgen.sweep(
        spring, over={"k": "10:90:12"}, random={"x": "normal(0.1, 0.01)"}, runs=25, ask="last(x)", time=3
    )
    assert [float(row["last(x)"]) for row in rows] == calm["last(x)"].tolist()
    assert [int(row["seed"]) for row in rows] == calm["seed"].tolist()


def done_runs(folder: Path) -> int:
    try:
        with sqlite3.connect(f"file:{folder / 'ledger.sqlite'}?mode=ro", uri=True) as ledger:
            return int(ledger.execute("SELECT COUNT(*) FROM runs").fetchone()[0])
    except sqlite3.OperationalError:
        return 0


@pytest.mark.slow
@pytest.mark.parametrize("count", [*beside(1), 2])
def test_a_sweep_that_is_killed_goes_on_and_has_each_run_once(spring, tmp_path, count):
    """SIGKILL of the parent again and again, at whatever instant; its workers end by themselves; the bits are those
    of a sweep that nobody disturbed.

    Slow: parents and their workers are started again and again.
    """
    folder, kills = tmp_path / "out", 0
    words = (spring, *SWEEP, "--workers", str(count), "-o", str(folder), "--no-certify")
    for wait in (1, *beside(30), 90, *beside(170, 260)):
        process = swept(*words)
        while process.poll() is None and done_runs(folder) < wait:
            time.sleep(0.02)
        if process.poll() is None:
            process.send_signal(signal.SIGKILL)
            kills += 1
        process.wait()
        process.communicate()
    last = swept(*words)
    out, err = last.communicate(timeout=300)
    assert last.returncode == 0, err
    assert kills >= 2 and "300 runs: 300 finished" in out
    same_rows(folder, spring)


@pytest.mark.slow
@pytest.mark.parametrize(("status", "code"), [("interrupted", 130), ("out of patience", 3)])
def test_a_run_that_is_cut_ends_the_sweep_and_is_no_row(status, code, spring, tmp_path, monkeypatch):
    """What was done is kept, and says so; the same command makes the run that was cut, with the bits of the others."""
    words = ["sweep", spring, "--over", "k=10:90:9", "--ask", "last(x)", "--time", "1", "-o", str(tmp_path / "out")]
    words += ["--patience", "100"]
    whole, made = SweepKernel.motion, []

    def cut(self, *given):
        made.append(given)
        return replace(whole(self, *given), ended=status if len(made) == 5 else "finished")

    with monkeypatch.context() as disturbed:
        disturbed.setattr(SweepKernel, "motion", cut)
        ended = CliRunner().invoke(main, [*words, "--no-certify"])
    kept = [row["run"] for row in table_at(tmp_path / "out")]
    assert ended.exit_code == code, ended.stderr
    assert len(kept) in (3, 4)  # what was done before the chunk in which it was cut
    assert f"{len(kept)} runs are kept in {tmp_path / 'out'}, the same command goes on" in ended.stderr
    assert CliRunner().invoke(main, [*words, "--no-certify"]).exit_code == 0
    calm = eomgen.sweep(spring, over={"k": "10:90:9"}, ask="last(x)", time=1)
    assert [float(row["last(x)"]) for row in table_at(tmp_path / "out")] == calm["last(x)"].tolist()


@pytest.mark.slow
def test_patience_is_for_each_step_of_a_sweep(spring, tmp_path, monkeypatch):
    """Many runs take longer than one may; one that takes longer ends the sweep, with those before it kept."""
    folder, whole = tmp_path / "out", SweepKernel.rows
    waits = iter([0, 0, 0, 60])

    def slow(self, first, last):
        resources._CLOCK.get().end -= next(waits) + 20  # as if so long had gone by
        check_patience()
        return whole(self, first, last)

    monkeypatch.setattr(SweepKernel, "rows", slow)
    words = ["sweep", spring, "--over", "k=10:90:100", "--ask", "last(x)", "--time", "1", "-o", str(folder)]
    ended = CliRunner().invoke(main, [*words, "--no-certify", "--patience", "40"])
    reported = re.search(r"given up after 40 s, (\d+) runs are kept in", ended.stderr)
    assert ended.exit_code == 3 and reported is not None and len(table_at(folder)) == int(reported[1]) >= 3


@in_slow_run
@needs_sh
@pytest.mark.slow
def test_workers_that_are_killed_are_replaced(spring, tmp_path):
    """SIGKILL of the workers of a running sweep: a new pool does what the ledger lacks.

    Slow: processes are started, killed and started again, each importing numpy and scipy.
    """
    folder = tmp_path / "out"
    process = swept(spring, *SWEEP, "--workers", "2", "-o", str(folder), "--no-certify")
    for wait in (20, 120):
        while process.poll() is None and done_runs(folder) < wait:
            time.sleep(0.02)
        children = Path(f"/proc/{process.pid}/task/{process.pid}/children")
        for child in children.read_text().split() if children.exists() else []:
            os.kill(int(child), signal.SIGKILL)
    out, err = process.communicate(timeout=300)
    assert process.returncode == 0, err
    assert "300 runs: 300 finished" in out
    same_rows(folder, spring)


@pytest.mark.slow
def test_a_run_that_kills_its_worker_is_a_row(spring, monkeypatch):
    """The pool breaks at one run, whichever chunk holds it: that run fails with a message, all others are done."""

    class Deadly:
        """An executor that runs here, and breaks at run 13."""

        def submit(self, function, payload, first, last):
            future: Future = Future()
            if first <= 13 < last:
                future.set_exception(workers.BrokenExecutor())
            else:
                future.set_result(function(payload, first, last))
            return future

    monkeypatch.setattr(workers.Pool, "renew", lambda self: None)
    found = eomgen.sweep(spring, over={"k": "10:90:40"}, ask="last(x)", time=0.5, executor=Deadly())
    assert len(found) == 40 and found["run"].tolist() == list(range(40))
    assert [run for run, status in enumerate(found["status"]) if status != "finished"] == [13]
    assert "died 3 times" in found["message"][13] and found["k"][13] == pytest.approx(10 + 13 * 80 / 39)


@in_slow_run
@pytest.mark.slow
def test_any_executor_with_submit_gives_the_same_bits(spring):
    """Threads, a pool of processes of the user, futures that only say `done`: what one process gives."""

    class Polled:
        def __init__(self, value):
            self.value = value

        def done(self):
            return True

        def result(self):
            return self.value

    class Plain:
        def submit(self, function, *arguments):
            return Polled(function(*arguments))

    requested = {"over": {"k": "10:90:9"}, "ask": ["last(x)", "max(x)"], "time": 1}
    alone = eomgen.sweep(spring, **requested)
    spawn = multiprocessing.get_context("spawn")  # as on every system but Linux
    for make in (lambda: ThreadPoolExecutor(1), lambda: ProcessPoolExecutor(2, mp_context=spawn)):
        with make() as executor:
            found = eomgen.sweep(spring, executor=executor, **requested)
        assert list(found.ledger.rows()) == list(alone.ledger.rows())
    assert list(eomgen.sweep(spring, executor=Plain(), **requested).ledger.rows()) == list(alone.ledger.rows())
    made = eomgen.sweep(eomgen.load(spring), workers=2, **requested)
    assert list(made.ledger.rows()) == list(alone.ledger.rows())


@in_slow_run
@pytest.mark.slow
def test_dask_gives_the_same_bits(spring):
    """A cluster of processes of dask.distributed on this machine.

    Slow: dask starts a scheduler and two processes.
    """
    distributed = pytest.importorskip("distributed")
    requested = {"over": {"k": "10:90:9"}, "ask": ["last(x)"], "time": 1}
    alone = eomgen.sweep(spring, **requested)
    with distributed.Client(n_workers=2, threads_per_worker=1, processes=True, dashboard_address=None) as client:
        found = eomgen.sweep(spring, executor=client, **requested)
    assert list(found.ledger.rows()) == list(alone.ledger.rows())


@in_slow_run
@pytest.mark.slow
def test_loky_gives_the_same_bits(spring):
    loky = pytest.importorskip("loky")
    requested = {"over": {"k": "10:90:9"}, "ask": ["last(x)"], "time": 1}
    found = eomgen.sweep(spring, executor=loky.get_reusable_executor(2), **requested)
    assert list(found.ledger.rows()) == list(eomgen.sweep(spring, **requested).ledger.rows())


# -- files -----------------------------------------------------------------------------------------------------


@pytest.mark.slow
def test_a_folder_resumes_its_own_plan_alone_and_replays_bit_for_bit(spring, tmp_path):
    folder = str(tmp_path / "out")
    words = ["sweep", spring, "--over", "k=10:90:4", "--ask", "last(x)", "--time", "2", "-o", folder]
    first = CliRunner().invoke(main, words)
    assert first.exit_code == 0 and "4 runs: 4 finished" in first.output
    plan = json.loads((tmp_path / "out" / "plan.json").read_text())
    assert plan["text"] == SPRING and plan["versions"]["eomgen"] and plan["seed"] == 0 and plan["runs"] == 4
    table = (tmp_path / "out" / "table.csv").read_bytes()
    with sqlite3.connect(tmp_path / "out" / "ledger.sqlite") as ledger:
        ledger.execute("DELETE FROM runs WHERE run IN (1, 3)")
    again = CliRunner().invoke(main, [*words, "--json"])
    assert json.loads(again.stdout)["runs"] == 4 and (tmp_path / "out" / "table.csv").read_bytes() == table
    other = CliRunner().invoke(main, [*words[:3], "k=10:90:5", *words[4:]])
    assert other.exit_code == 2 and "another plan: over" in other.output
    replay = CliRunner().invoke(main, ["sweep", "--replay", "2", folder, "-o", str(tmp_path / "run.csv"), "--json"])
    reported = json.loads(replay.output)
    assert replay.exit_code == 0 and reported["in_table"] and reported["differ"] == []
    with (tmp_path / "run.csv").open() as file:
        rows = list(csv.reader(file))
    assert float(rows[-1][rows[0].index("x")]) == pytest.approx(reported["row"]["last(x)"], abs=1e-12)
    assert sweep_at(folder).again(2) == sweep_at(folder).ledger.row(2)
    with sqlite3.connect(tmp_path / "out" / "ledger.sqlite") as ledger:
        ledger.execute('UPDATE runs SET "last(x)" = "last(x)" + 1e-15 WHERE run = 2')
    changed = CliRunner().invoke(main, ["sweep", "--replay", "2", folder])
    assert changed.exit_code == 3 and "differs from the table in last(x)" in changed.output
    assert CliRunner().invoke(main, ["sweep", "--replay", "9", folder]).exit_code == 2
    valued = CliRunner().invoke(main, ["sweep", "--replay", "2", folder, "--set", "m=5", "--time", "3"])
    assert valued.exit_code == 2 and "--replay takes no --time, --set" in valued.output


@pytest.mark.slow
def test_names_that_sqlite_takes_for_one_are_two_columns(spring, tmp_path):
    """m and M; what is asked under the name of what is set."""
    found = eomgen.sweep(spring, over={"m": [1, 2], "M": [3.0]}, ask=["m", "k"], time=0.1, out=tmp_path / "out")
    assert found.columns[4:] == ("m", "M", "m (asked)", "k")
    assert found["m (asked)"].tolist() == [1, 2] and found["M"].tolist() == [3, 3]


@pytest.mark.slow
def test_of_nothing_all_outputs_are_asked_and_the_ledger_is_one_file(spring, tmp_path):
    """No --ask: the [outputs] of the model, in SI as ever. What sqlite keeps beside a ledger is gone at the end."""
    found = eomgen.sweep(spring, over={"k": [40, 50]}, time=2, out=tmp_path / "out")
    assert found.columns[4:] == ("k", "amplitude") and found["amplitude"] == pytest.approx([0.1, 0.1])
    assert {x.name for x in (tmp_path / "out").iterdir()} >= {"ledger.sqlite", "table.csv", "plan.json"}
    assert not list((tmp_path / "out").glob("ledger.sqlite-*"))
    model = eomgen.loads(SPRING.partition("[outputs]")[0])
    with pytest.raises(UsageError, match="nothing is requested of the runs"):
        eomgen.sweep(model, over={"k": [40, 50]}, time=2)


@pytest.mark.slow
def test_what_is_asked_may_hold_outputs_by_name():
    """An output of the state stands for its formula; other things of that name stay what they are."""
    text = SPRING + "pull = 'k*x'\nmass = 'k*x/m'\n"
    requested = ["max(pull-x*k/2)", "max(k*x - x*k/2)", "max(pull + k*x(mass.center))", "max(2*k*x)"]
    found = eomgen.sweep(eomgen.loads(text), over={"k": [40.0]}, ask=requested, time=2)
    values = [found[name][0] for name in requested]
    assert values[0] == values[1] and values[2] == values[3]


@pytest.mark.parametrize(
    ("words", "message"),
    [
        ([], "nothing changes from run to run"),
        (["--over", "q=1,2", "--ask", "k"], "no parameter, coordinate, rate or speed 'q'"),
        (["--over", "k=1:2", "--ask", "k"], "is no range"),
        (["--over", "k=1,2", "--over", "k=3", "--ask", "k"], "one name twice"),
        (["--over", "k=1,2", "--random", "k=uniform(0, 1)", "--ask", "k"], "'k' is set twice"),
        (["--random", "k=gauss(0, 1)", "--ask", "k"], "no distribution 'gauss'"),
        (["--random", "k=normal(0)", "--ask", "k"], "1 arguments"),
        (["--random", "k=normal(0, -1)", "--ask", "k"], "deviation is not above 0"),
        (["--random", "k=uniform(2, 1)", "--ask", "k"], "do not ascend"),
        (["--random", "k=normal(1, 3 kg)", "--ask", "k"], "kg"),
        (["--over", "k=1,2", "--ask", "speed(nobody)"], "nobody"),
        (["--over", "k=1,2", "--ask", "x at x = 0, event every"], "is of several instants"),
        (["--over", "k=1,2", "--runs", "5", "--ask", "k"], "5 runs of the same values"),
        (["--random", "k=uniform(1, 2)", "--critical", "k"], "along a range"),
        (["--over", "k=1,2", "--random", "m=uniform(1, 2)", "--critical", "k-1"], "--design sobol or lhs"),
        (["--over", "k=1,2", "--ask", "k", "--time", "-1"], "makes no sense"),
    ],
)
def test_what_makes_no_sense_is_refused_before_any_run(spring, words, message):
    done = CliRunner().invoke(main, ["sweep", spring, *words])
    assert done.exit_code == 2 and message in done.output, done.output


@pytest.mark.slow
def test_pictures_and_proof(spring, tmp_path):
    """Lines, a heat map and a scatter matrix; the proof is that of the first run, and that it has the same bits."""
    for over, view in ((["k=10:90:4"], "lines"), (["k=10:90:4", "m=1,2"], "heat")):
        words = [word for each in over for word in ("--over", each)]
        path = tmp_path / f"{view}.png"
        done = CliRunner().invoke(
            main, ["sweep", spring, *words, "--ask", "max(x')", "--time", "1", "--plot", str(path), "--json"]
        )
        reported = json.loads(done.stdout)
        assert path.stat().st_size > 5000 and reported["certificate"]["ok"] is True
        names = {check["name"]: check["status"] for check in reported["certificate"]["checks"]}
        assert names["a run made again has the same bits"] == "holds"
        assert names["steps repeated from states of the run end at its next states"] == "holds"
        assert names["outputs of the whole run agree with its samples"] == "holds"
    found = eomgen.sweep(spring, random={"k": "uniform(10, 20)", "m": "uniform(1, 2)"}, runs=16, ask="max(x')", time=1)
    found.plot(tmp_path / "scatter.png")
    found.plot(tmp_path / "lines.png", "scatter")
    with pytest.raises(eomgen.RunFailed, match="two ranges"):
        found.plot(tmp_path / "h.png", "heat")
    with pytest.raises(UsageError, match="no view"):
        found.plot(tmp_path / "h.png", "pie")


@pytest.mark.slow
def test_runs_between_the_first_and_the_last_are_proven_too(spring):
    """max(x') and the frequency of three runs: what is told otherwise of the middle one is contradicted."""
    found = eomgen.sweep(spring, over={"k": "10:30:3"}, ask=["max(x')", "frequency(1)"], time=1)
    runs = SweepKernel(found.plan)
    assert all(check.ok for check in _answers_proven(found, runs, {}))
    for k, name in enumerate(("max(x')", "frequency(1)"), start=5):
        rows = [(*row[:k], row[k] + 0.5, *row[k + 1 :]) if row[0] == 1 else row for row in found.ledger.rows()]
        other = SimpleNamespace(plan=found.plan, ledger=SimpleNamespace(rows=lambda rows=rows: rows))
        (check,) = _answers_proven(other, runs, {})
        assert check.ok is False and f"{name} of run 1" in check.detail


@pytest.mark.slow
def test_an_instant_that_is_read_wrongly_everywhere_is_no_sensitive_motion(spring, monkeypatch):
    """x at t = 0.5, read at the end: the table and the run made anew agree, and their samples contradict both."""
    found = eomgen.sweep(spring, over={"k": "10:30:2"}, ask=["x at t = 0.5", "x at t = 1"], time=1)
    rows = [(*row[:-2], row[-1], row[-1]) for row in found.ledger.rows()]
    other = SimpleNamespace(plan=found.plan, ledger=SimpleNamespace(rows=lambda: rows))
    monkeypatch.setattr(
        WholeRun, "_at", lambda self, output, k, t: self._number(output.value, self.runs[k], self.runs[k].run.end)
    )
    (check,) = _answers_proven(other, SweepKernel(found.plan), {})
    assert check.ok is False and "x at t = 0.5 of run 0" in check.detail


def test_a_million_runs_are_planned_by_their_numbers():
    """The last of 10^6 runs is drawn without the others."""
    design = Design({"k": tuple(range(1000))}, (DrawnValues("m", "normal", (0.0, 1.0)),), 1000, "sobol", 1)
    assert design.count == 10**6
    (seed,), values = design.runs(10**6 - 1, 10**6)
    assert seed > 0 and values[0, 0] == 999
    assert kernel.finite(math.nan) is None


def test_what_is_set_and_told_is_of_its_laws(tmp_path):
    """F(value) = u of the seed, one in each stratum; least, mean and largest are of the rows."""
    laws = (("a", "normal", (0.5, 0.1)), ("b", "triangular", (1.0, 1.2, 3.0)), ("c", "lognormal", (2.0, 0.1)))
    for kind in DESIGNS:
        spreads = tuple(DrawnValues(*law) for law in laws)
        seeds, values = Design({"x": (1.0, 2.0), "y": (5.0, 6.0)}, spreads, 4, kind, 7).runs(0, 16)
        rows = [(k, seed, *row) for k, (seed, row) in enumerate(zip(seeds, values.tolist(), strict=True))]
        over = {"x": (1.0, 2.0), "y": (5.0, 6.0)}
        assert drawn_otherwise(over, laws, 4, kind, rows).status == "holds"
        assert drawn_otherwise({"x": (1.0, 2.0), "y": (6.0, 5.0)}, laws, 4, kind, rows).status == "fails"
        for k in range(3):
            moved = [(*row[: 4 + k], row[4 + k] * 1.3, *row[5 + k :]) for row in rows]
            assert drawn_otherwise(over, laws, 4, kind, moved).status == "fails", (kind, k)
    columns, right = {"x": [1.0, 2.0, None], "z": [3.0, 3.0, 3.0]}, {"x": (2, 1.0, 1.5, 2.0), "z": (3, 3.0, 3.0, 3.0)}
    same = ("'z' is 3 in all runs: none of the values set changes it",)
    assert reported_of_all(columns, right, same, "", 1e-9, ["x", "z"]).status == "holds"
    assert reported_of_all(columns, right | {"x": (2, 1.0, 1.4, 2.0)}, same, "", 1e-9, ["x", "z"]).status == "fails"
    assert reported_of_all(columns, right, (), "", 1e-9, ["x", "z"]).status == "fails"
    assert reported_of_all(columns, right, ("'x' is 2 in all runs", *same), "", 1e-9, ["x", "z"]).status == "fails"
