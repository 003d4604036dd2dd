"""codegen --integrator and --float32: C that compiles without a warning, and moves as simulate does."""

from __future__ import annotations

import csv
import ctypes
import shutil
import subprocess
from pathlib import Path

import numpy as np
import pytest
from click.testing import CliRunner
from closed_motions import DRAGGED, STEP, off
from hand_made import symbols
from motions_with_phases import NAMES, duration, model_with_phases
from slow_run import usual

import eomgen
from eomgen.cli import main
from eomgen.codegen.program import Program
from eomgen.codegen.targets.base import Description, Role, SingleWords
from eomgen.codegen.targets.c import SINGLE, TARGET
from eomgen.errors import UsageError

MODELS = Path(__file__).parent.parent / "models"
CC = shutil.which("gcc") or shutil.which("cc") or shutil.which("clang")
STRICT = ["-std=c99", "-Wall", "-Wextra", "-pedantic", "-Werror", "-O1"]
needs_compiler = pytest.mark.skipif(CC is None, reason="no C compiler")


ANY_ORDER = """
#include <stdio.h>
#include "dragged_run.h"
int main(void)
{
    const double start[] = {0.03, 0, 0, 0.8}, p[] = {1, 0.001, 2000, 1.44}, parts[] = {0.9, 0.1, 0.5, 0.55, 0.3, 0.999};
    static dragged_run run;
    dragged_begin(&run, 0, start, p, 1e-8, 1e-8);
    while (run.t < 0.2 && dragged_step(&run, 0.2))
        for (int i = 0; i < 6; i++) {
            double t = run.t_old + parts[i]*(run.t - run.t_old), x[4];
            dragged_at(&run, t, x);
            printf("%.17g %.17g %.17g %.17g %.17g\\n", t, x[0], x[1], x[2], x[3]);
        }
    return 0;
}
"""


def program(tmp_path: Path, name: str, **how) -> Path:
    eomgen.generate(MODELS / f"{name}.toml", name=name, integrator=True, **how).write(tmp_path)
    files = [f"{name}_run.c", f"{name}_rhs.c"]
    made = subprocess.run(
        [CC, *STRICT, f"-D{name}_MAIN", *files, "-lm", "-o", "run"], cwd=tmp_path, capture_output=True, text=True
    )
    assert made.returncode == 0, made.stderr
    return tmp_path / "run"


def table(path: Path, *words: str) -> tuple[list[str], np.ndarray]:
    found = subprocess.run([path, *words], capture_output=True, text=True, check=True)
    head, *rows = csv.reader(found.stdout.splitlines())
    return head, np.array(rows, dtype=float)


@pytest.mark.slow
@needs_compiler
@pytest.mark.parametrize("name", usual(["double_pendulum", "tumbling_body", "four_bar", "arm3", "car_axis"], 2, 1))
def test_it_moves_as_simulate_does(name, tmp_path):
    head, rows = table(program(tmp_path, name), "--time=2", "--samples=9", "--rtol=1e-10", "--atol=1e-10")
    run = eomgen.simulate(MODELS / f"{name}.toml", time=2, samples=9)
    assert head == ["t", *run.coordinates, *run.speeds[: len(head) - 1 - len(run.coordinates)]]
    expected = np.column_stack([run.t, *(run[column] for column in head[1:])])
    assert rows == pytest.approx(expected, abs=2e-7 * (1 + np.max(np.abs(expected))))


@needs_compiler
def test_its_states_between_the_steps_are_as_accurate_as_the_steps(tmp_path):
    """In any order of the instants: see the same law of runs."""
    (tmp_path / "dragged.toml").write_text(DRAGGED)
    eomgen.generate(tmp_path / "dragged.toml", name="dragged", integrator=True).write(tmp_path)
    (tmp_path / "any_order.c").write_text(ANY_ORDER)
    files = ["any_order.c", "dragged_run.c", "dragged_rhs.c"]
    made = subprocess.run([CC, *STRICT, *files, "-lm", "-o", "run"], cwd=tmp_path, capture_output=True, text=True)
    assert made.returncode == 0, made.stderr
    printed = subprocess.run([tmp_path / "run"], capture_output=True, text=True, check=True).stdout
    rows = np.array([line.split() for line in printed.splitlines()], dtype=float)
    assert len(rows) > 300 and off(rows[:, 1:], rows[:, 0]) < STEP


@pytest.mark.slow
@needs_compiler
def test_values_and_starts_are_given_by_name(tmp_path):
    made = program(tmp_path, "double_pendulum")
    _, rows = table(made, "g=1.62", "theta1=0.3", "theta2'=1", "--time=3", "--samples=4")
    run = eomgen.simulate(
        MODELS / "double_pendulum.toml", time=3, samples=4, parameters={"g": 1.62}, start={"theta1": 0.3, "theta2'": 1}
    )
    assert rows[:, 1:] == pytest.approx(run.x, abs=1e-6)
    for words, message in ((["q=1"], "unknown: q=1"), (["g=x"], "x is no number"), (["--time=-1"], "make no sense")):
        found = subprocess.run([made, *words], capture_output=True, text=True)
        assert found.returncode == 2 and message in found.stderr


@pytest.mark.slow
@needs_compiler
def test_the_line_of_the_readme_makes_a_motion(tmp_path):
    """As it stands there: compiled, run, a row for each instant."""
    eomgen.generate(MODELS / "double_pendulum.toml", name="it", integrator=True).write(tmp_path)
    line = next(x.strip() for x in (tmp_path / "README.md").read_text().splitlines() if "_run.c" in x)
    subprocess.run(line, shell=True, cwd=tmp_path, check=True)
    rows = (tmp_path / "motion.csv").read_text().splitlines()
    assert len(rows) == 102 and rows[-1].startswith("10,")


@pytest.mark.slow
@needs_compiler
def test_two_runs_at_once_do_not_know_of_one_another(tmp_path):
    """Interleaved step by step they give what each gives alone; nothing is allocated."""
    eomgen.generate(MODELS / "double_pendulum.toml", name="it", integrator=True).write(tmp_path)
    text = (tmp_path / "it_run.c").read_text()
    assert "malloc" not in text and "static double" not in text
    subprocess.run(
        [CC, "-O1", "-shared", "-fPIC", "it_run.c", "it_rhs.c", "-lm", "-o", "it.so"], cwd=tmp_path, check=True
    )
    made = ctypes.CDLL(str(tmp_path / "it.so"))
    made.it_begin.argtypes = [ctypes.c_void_p, ctypes.c_double, *[ctypes.c_void_p] * 2, *[ctypes.c_double] * 2]
    made.it_step.argtypes = [ctypes.c_void_p, ctypes.c_double]
    made.it_at.argtypes = [ctypes.c_void_p, ctypes.c_double, ctypes.c_void_p]
    p = (ctypes.c_double * 5)(*eomgen.derive(MODELS / "double_pendulum.toml").rhs("numpy").p0)

    def ends(starts: list[list[float]]) -> list[list[float]]:
        runs = [(ctypes.c_double * 1000)() for _ in starts]
        for run, x in zip(runs, starts, strict=True):
            made.it_begin(run, 0.0, (ctypes.c_double * 4)(*x), p, 1e-9, 1e-9)
        while not all(run[0] >= 1.0 for run in runs):
            for run in runs:
                if run[0] < 1.0:
                    assert made.it_step(run, 1.0) == 1
        found = [(ctypes.c_double * 4)() for _ in runs]
        for run, x in zip(runs, found, strict=True):
            made.it_at(run, 1.0, x)
        return [list(x) for x in found]

    one, other = [2.0, 0.5, 0.0, 0.0], [0.1, 0.2, 3.0, -1.0]
    assert ends([one, other]) == [*ends([one]), *ends([other])]


@pytest.mark.slow
@needs_compiler
@pytest.mark.parametrize("name", usual(["double_pendulum", "tumbling_body", "four_bar"], 2, 1))
def test_single_precision_keeps_what_it_says(name, tmp_path):
    """The self-test with its measured tolerances, a proof that holds, and a motion to five digits."""
    if name == "four_bar":  # its loop is closed by dependent coordinates
        assert not eomgen.derive(MODELS / "four_bar.toml").graph.J
    made = program(tmp_path, name, float32=True)
    subprocess.run(
        [CC, *STRICT, "-DEOMGEN_SELFTEST", f"{name}_rhs.c", "-lm", "-o", "selftest"], cwd=tmp_path, check=True
    )
    subprocess.run([tmp_path / "selftest"], check=True)
    assert "double t" not in (tmp_path / f"{name}_run.h").read_text()
    _, rows = table(made, "--time=1", "--samples=3")
    expected = eomgen.simulate(MODELS / f"{name}.toml", time=1, samples=3)
    x = np.column_stack([expected[column] for column in (*expected.coordinates, *expected.speeds)])
    assert rows[:, 1:] == pytest.approx(x[:, : rows.shape[1] - 1], abs=1e-3 * np.max(np.abs(x)))
    assert eomgen.generate(MODELS / f"{name}.toml", name=name, float32=True).certify().ok


@pytest.mark.slow
@needs_compiler
@pytest.mark.parametrize("wrong", ["2.0002f*", "2.0ff*"])
def test_what_single_precision_cannot_do_is_seen(wrong, monkeypatch):
    """A constant that is wrong by 1e-4 is outside of the measured tolerances; what does not compile is wrong, too."""
    right = SingleWords.text
    monkeypatch.setattr(SingleWords, "text", lambda self, text: right(self, text).replace("2.0f*", wrong))
    certificate = eomgen.generate(MODELS / "double_pendulum.toml", name="it", float32=True).certify()
    assert certificate.ok is False


@pytest.mark.slow
@needs_compiler
def test_names_of_single_precision_are_harmless():
    """A parameter sinf beside the function."""
    s = symbols("float", "sinf double")
    program = Program.of([s.graph.call("sin", s.q[0]) * s.parameters["sinf"] + s.parameters["double"]], s)
    texts = TARGET.single.files(TARGET.files("odd", [(program, Description("Odd", "", {}))]))
    assert TARGET.single.run(texts, program, "odd", Role.RHS)(0, [0.5, 0], (), [2, 1], None) == pytest.approx(
        [2 * np.sin(0.5) + 1], rel=1e-6
    )


def test_the_text_of_numbers_types_and_functions():
    text = 'double x = 2.0*sin(1e-3) + 3*v1; /* 2.0 double */ printf("%.17g double 1.0", pow(x, .5), DBL_EPSILON);'
    assert SINGLE.text(text) == (
        'float x = 2.0f*sinf(1e-3f) + 3*v1; /* 2.0 double */ printf("%.17g double 1.0", powf(x, .5f), FLT_EPSILON);'
    )


@pytest.mark.parametrize(
    ("name", "how", "message"),
    [
        ("loop_the_loop", {"integrator": True}, "'bead', on paths of pieces"),
        ("spinning_ball", {"integrator": True}, "the rolling 'floor', which rubs in its impacts"),
        ("bouncing_ball", {"integrator": True, "float32": True}, "no integrator in single precision"),
        ("double_pendulum", {"integrator": True, "targets": ("numpy",)}, "written in C"),
        ("double_pendulum", {"float32": True, "targets": ("c", "numpy", "fmu")}, "no single precision in numpy, fmu"),
        ("bricard", {"float32": True}, "constraints that multipliers close"),
    ],
)
def test_what_has_none_is_refused_by_name(name, how, message):
    with pytest.raises(UsageError, match=message):
        eomgen.generate(MODELS / f"{name}.toml", **how)


def through_phases(tmp_path: Path, name: str) -> Path:
    """The folder with the program of a model whose contacts change, and its own test."""
    eomgen.generate(model_with_phases(name), name=name, integrator=True).write(tmp_path)
    subprocess.run([CC, *STRICT, "-c", f"{name}_rhs.c"], cwd=tmp_path, check=True)  # once for all programs
    for word, made in (("MAIN", "run"), ("RUN_SELFTEST", "selftest")):
        files = [f"{name}_run.c", f"{name}_rhs.o", "-lm", "-o", made]
        assert f" -D{name}_{word} {name}_run.c" in (tmp_path / "README.md").read_text()
        found = subprocess.run([CC, *STRICT, f"-D{name}_{word}", *files], cwd=tmp_path, capture_output=True, text=True)
        assert found.returncode == 0, found.stderr
    return tmp_path


COLLAR = """
space = "plane"
parameters = { m = 2, mu = 0.2, L = 0.3, e = 0.1, k = 300 }
coordinates = { x = { start = 0.2 } }
states = { W = { start = 0, unit = "J", rate = "abs(friction(collar)*x')" } }
points = { A = [0, "e"] }
[bodies.collar]
mass = "m"
inertia = 0.02
points = { H = [0, "e"] }
[bodies.collar.joint]
kind = "prismatic"
axis = [1, 0]
displacement = "x"
friction = { coefficient = "mu", length = "L" }
limits = [-0.15, 0.3]
[forces]
weight = { kind = "gravity", acceleration = [0, -9.81] }
spring = { kind = "spring", points = ["A", "collar.H"], stiffness = "k", length = 0 }
"""


@needs_compiler
@pytest.mark.slow
def test_its_own_test_ends_before_an_impact_that_it_does_not_decide(tmp_path):
    """A collar that rubs by its force comes to its stop; both stops at once close nowhere, and are no phase."""
    eomgen.generate(eomgen.loads("eomgen = 1" + COLLAR), name="collar", integrator=True).write(tmp_path)
    files = [CC, *STRICT, "-Dcollar_RUN_SELFTEST", "collar_run.c", "collar_rhs.c", "-lm", "-o", "own"]
    subprocess.run(files, cwd=tmp_path, check=True)
    assert subprocess.run([tmp_path / "own"], check=False).returncode == 0
    assert "collar_RUN_SELFTEST" in (tmp_path / "collar_run.c").read_text()


@pytest.mark.slow
@needs_compiler
@pytest.mark.parametrize(
    "name", usual([*dict.fromkeys(("stick_slip", "crank", "funnel", "arm", "sliding_ladder", *NAMES))], 4)
)
def test_it_goes_through_phases_as_simulate_does(name, tmp_path):
    """Its own test holds; its states are those of `simulate`, contacts change at the same instants."""
    folder, time = through_phases(tmp_path, name), duration(name)
    subprocess.run([folder / "selftest"], check=True)
    words = (f"--time={time}", "--samples=11", "--rtol=1e-10", "--atol=1e-10")
    head, rows = table(folder / "run", *words)
    run = eomgen.simulate(model_with_phases(name), time=time, samples=np.linspace(0, time, 11).tolist())
    assert {*run.coordinates, *run.speeds} <= {*head}
    for column in (*run.coordinates, *run.speeds):
        assert rows[:, head.index(column)] == pytest.approx(run[column], abs=1e-8)
    found = subprocess.run([folder / "run", "--events=1", *words], capture_output=True, text=True, check=True)
    instants = {float(line.split(",")[0]) for line in found.stdout.splitlines()[1:]}
    assert sorted(instants) == pytest.approx([phase.end for phase in run.phases[:-1]], abs=1e-8)


@pytest.mark.slow
@needs_compiler
def test_its_own_test_sees_another_motion(tmp_path):
    """With a restitution that is a little larger its instants are others; where a contact has none, it says so."""
    folder = through_phases(tmp_path, "bouncing_ball")
    text = (folder / "bouncing_ball_run.c").read_text()
    assert text.count("BOUNCING_BALL_VALUES {0.5, 1.0, 0.6,") == 1
    (folder / "bouncing_ball_run.c").write_text(text.replace("VALUES {0.5, 1.0, 0.6,", "VALUES {0.5, 1.0, 0.60001,"))
    files = ["bouncing_ball_run.c", "bouncing_ball_rhs.o", "-lm", "-o", "wrong"]
    subprocess.run([CC, "-O1", "-Dbouncing_ball_RUN_SELFTEST", *files], cwd=folder, check=True)
    found = subprocess.run([folder / "wrong"], capture_output=True, text=True)
    assert found.returncode == 1 and "change" in found.stderr


@pytest.mark.slow
def test_the_command_writes_them(tmp_path):
    words = ["codegen", str(MODELS / "double_pendulum.toml"), "--integrator", "--float32", "-o", str(tmp_path)]
    found = CliRunner().invoke(main, words)
    assert found.exit_code == 0 and {"double_pendulum_run.c", "double_pendulum_run.h"} <= {
        p.name for p in tmp_path.iterdir()
    }
