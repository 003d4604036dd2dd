"""Work is bounded in every verb: counted where a run or an expression has no end in sight, by the clock in the end."""

from __future__ import annotations

import json
import threading
import time
from collections.abc import Sequence
from pathlib import Path

import numpy as np
import pytest
from click.testing import CliRunner
from slow_run import in_slow_run

import eomgen
from eomgen import resources
from eomgen.cli import main
from eomgen.cli_common import Lasting
from eomgen.errors import EomgenError
from eomgen.mechanics.constraints import closure
from eomgen.mechanics.dynamics.system import System
from eomgen.mechanics.kinematics import places
from eomgen.mechanics.start.exact import ExactStart
from eomgen.questions import outputs_answered as answers
from eomgen.resources import OutOfPatience, PatienceEnded, check_patience, doing, keep_what_there_is, patience
from eomgen.runs.single_run import run
from eomgen.simulation import integrator as pace
from eomgen.simulation import motion as simulation_motion
from eomgen.simulation.integrator import Stepping, march
from eomgen.symbolic.exact.expansion import expanded
from eomgen.symbolic.exact.linear import LinearSystem
from eomgen.symbolic.expression.graph import Graph
from eomgen.symbolic.expression.node import Node
from eomgen.symbolic.numeric.evaluation import FLOAT, evaluate
from eomgen.symbolic.numeric.roots import Newton
from eomgen.symbolic.print.text import text_size

MODELS = Path(__file__).parents[2] / "models"
HEAD = """
eomgen = 1
space = "plane"
[bodies.b]
shape = { kind = "particle", mass = "m" }
joint = { kind = "prismatic", axis = [1, 0], displacement = "x", stiffness = "k", damping = "c" }
"""
FAST = HEAD + "[parameters]\nm = 1e-12\nk = 1e9\nc = 0\n[coordinates]\nx = 0.1\n"
STIFF = HEAD + "[parameters]\nm = 1\nk = 1e8\nc = 1e6\n[coordinates]\nx = 1\n"


# -- the clock --------------------------------------------------------------------------------------


def requests() -> None:
    while True:
        check_patience()


def requests_never() -> None:
    while True:
        sum(range(1000))


@pytest.mark.slow
@pytest.mark.parametrize("endless", [requests, requests_never])
def test_what_takes_too_long_ends_and_says_what_was_done_and_what_was_given_up(endless):
    """Loops that ask end at once; those of a library within a second more."""
    began = time.monotonic()
    with pytest.raises(OutOfPatience) as caught, patience(0.1):
        with doing("the first"):
            pass
        with doing("the second"):
            endless()
    assert caught.value.what == "given up after 0.1 s, nothing is kept: the second (done before: the first)"
    assert "--patience" in caught.value.fix and caught.value.exit_code == 3
    assert time.monotonic() - began < 30


def test_what_was_done_several_times_is_said_once():
    with pytest.raises(OutOfPatience) as caught, patience(1e-9):
        for what in ("the verdict", "the verdict", "a page"):
            with doing(what):
                pass
        with doing("the second"):
            check_patience()
    assert caught.value.what.endswith("the second (done before: the verdict (2 times), a page)")


def test_nobody_who_tries_another_way_catches_the_end_of_patience():
    """The clock ends; it never chooses what is printed."""
    tries = []
    with pytest.raises(OutOfPatience), patience(1e-9):
        for k in range(3):
            try:
                check_patience()
            except EomgenError:
                tries.append(k)
    assert not tries and not issubclass(PatienceEnded, EomgenError)


def test_what_is_given_up_for_another_way_is_not_told_as_done():
    """The innermost of what is being done stands in the message, what failed before does not."""
    with pytest.raises(OutOfPatience) as caught, patience(0.01), doing("all"):
        try:
            with doing("one way"):
                raise EomgenError("no")
        except EomgenError:
            pass
        with doing("the other way"):
            requests()
    assert caught.value.what == "given up after 0.01 s, nothing is kept: all, the other way"


def test_patience_that_suffices_leaves_nothing_behind():
    """No thread stays, nothing is thrown later, and outside nothing is asked."""
    threads = threading.active_count()
    with patience(0.05):
        pass
    check_patience()
    time.sleep(0.2)
    assert threading.active_count() <= threads
    with patience(0.01):
        keep_what_there_is()
        time.sleep(0.05)
        check_patience()


def test_nobody_is_stopped_in_the_middle_of_an_import(tmp_path, monkeypatch):
    """Half a module would stay behind: it comes to its end, and then what imports it is stopped."""
    (tmp_path / "slow_to_import.py").write_text("import time\nfor _ in range(50): time.sleep(0.01)\nwhole = True\n")
    monkeypatch.syspath_prepend(tmp_path)
    monkeypatch.setattr(resources, "LATE", 0.05)
    with pytest.raises(OutOfPatience), patience(0.05):
        import slow_to_import

        requests_never()
    assert slow_to_import.whole


def integration() -> None:
    march(lambda t, x: -x, (0.0, 1.0), np.ones(1), how=Stepping())


def expansion() -> None:
    x, y = symbols()
    expanded(((x + y) * (x - y),), 1000)


def elimination() -> None:
    x, y = symbols()
    values = {x: 2.0, y: 3.0}
    system = LinearSystem([{0: x, 1: y}, {0: y, 1: x}], [1, 1], 2, lambda scalars: [values[each] for each in scalars])
    system.solution()


def evaluation() -> None:
    x, _ = symbols()
    evaluate((x * x,), {x: 2.0}, FLOAT)


class _Square:
    """x^2 = 2"""

    def left(self, x: np.ndarray) -> np.ndarray:
        return x * x - 2

    def slopes(self, x: np.ndarray) -> np.ndarray:
        return np.diag(2 * x)

    def moved(self, x: np.ndarray, step: Sequence[float]) -> np.ndarray:
        return x + np.array(step)


def iteration() -> None:
    Newton().root(_Square(), np.ones(1))


def symbols() -> tuple[Node, Node]:
    graph = Graph()
    return graph.symbol("x"), graph.symbol("y")


@pytest.mark.parametrize("loop", [integration, expansion, elimination, evaluation, iteration])
def test_hot_loops_ask(loop, monkeypatch):
    """Without the thread that stops what does not; and outside of patience they come to their end."""
    monkeypatch.setattr(resources, "LATE", 1e6)
    with pytest.raises(OutOfPatience), patience(1e-9):
        loop()
    loop()


# -- every verb ---------------------------------------------------------------------------------------

ALONE = [  # what a verb is tried with that takes more, or another model, than a double pendulum
    ("check", "n_four_bar.toml"),
    ("solve", "seeds/ch22_p1.toml"),
    ("statics", "cantilever.toml"),
    ("kinematics", "n_four_bar.toml", "--at", "a1 = 1"),
    ("animate", "double_pendulum.toml", "-o", "DIR/motion.gif"),
    ("codegen", "double_pendulum.toml", "-o", "DIR"),
    ("export", "double_pendulum.toml", "-o", "DIR/robot.urdf"),
    ("import", "DIR/robot.urdf"),
    ("identify", "double_pendulum.toml", "--data", "DIR/motion.csv"),
    ("play", "double_pendulum.toml", "-o", "DIR/page.html"),
    ("report", "double_pendulum.toml", "-o", "DIR/report.html"),
    ("sweep", "double_pendulum.toml", "--over", "g=9:10:2", "--ask", "max(theta1)"),
    ("verify", "double_pendulum.toml", "T = 0"),
]
ASKING = [
    verb
    for verb, command in main.commands.items()
    if any(each.name == "patience" for each in command.params) and not isinstance(command, Lasting)
]
VERBS = [next((words for words in ALONE if words[0] == verb), (verb, "double_pendulum.toml")) for verb in ASKING]


@pytest.mark.parametrize("words", VERBS, ids=lambda words: words[0])
def test_every_verb_ends_when_patience_does(words, tmp_path):
    """Exit 3, and a sentence in place of a result."""
    verb, model, *more = words
    rows = "".join(f"{k},{k},0,1,0,0,0\n" for k in range(5))
    (tmp_path / "motion.csv").write_text(f"t,theta1,theta2,theta1',theta2',theta1'',theta2''\n{rows}")
    (tmp_path / "robot.urdf").write_text('<robot name="r"><link name="base"/></robot>')
    model, *more = (each.replace("DIR", str(tmp_path)) for each in (model, *more))
    found = CliRunner().invoke(main, [verb, str(MODELS / model), *more, "--patience", "1e-6"])
    assert found.exit_code == 3 and "given up after 1e-06 s" in found.output and "--patience none" in found.output


@pytest.mark.parametrize("text", ["0", "-1", "nan", "inf", "soon"])
def test_patience_is_a_positive_number_of_seconds_or_none(text):
    """All else is a wrong usage."""
    found = CliRunner().invoke(main, ["derive", str(MODELS / "simple_pendulum.toml"), "--patience", text])
    assert found.exit_code == 2 and "a positive number of seconds is needed, or none" in found.output


def test_only_verbs_that_work_on_a_model_ask_for_patience():
    """What needs words of its own asks for it; what makes no result of a model does not."""
    assert {verb for verb, *_ in ALONE} <= {*ASKING}
    assert not {"new", "examples", "schema", "doctor"} & {*ASKING}


@pytest.mark.slow
def test_a_run_keeps_what_it_has_when_patience_ends():
    """The states so far, as of a run that was interrupted."""
    equations = eomgen.derive(MODELS / "double_pendulum.toml")
    with patience(3):
        found = run(equations, time=1e4, target="numpy", samples=11)
    assert found.status == "out of patience" and not found.ok and found.phases[-1].end > 0
    assert "--patience" in found.message and "steps" in found.message


# -- counted ----------------------------------------------------------------------------------------


@pytest.fixture
def soon(monkeypatch) -> int:
    """Looks come after fewer steps than they do, for short tests."""
    monkeypatch.setattr(pace, "LOOK", 400)
    return 400


@pytest.mark.slow
def test_a_stiff_run_says_so_after_a_count_of_steps(soon):
    """x'' = -1e8 x - 1e6 x': stability holds steps near 6e-6 s. Radau takes longer ones."""
    found = eomgen.simulate(eomgen.loads(STIFF), time=10, target="numpy", method="DOP853")
    assert found.status == "too many steps" and found.steps == soon
    assert "stiff, motions die out at 1.0e+06 1/s" in found.message and "use --method Radau" in found.message
    assert all(eomgen.simulate(eomgen.loads(STIFF), time=0.1, target="numpy", method=m).ok for m in ("Radau", "auto"))


def test_a_fast_run_says_how_often_it_would_turn(soon):
    """x = 0.1 cos(w t), w = 3.2e10 1/s: w/(2 pi) = 5.0e9 turns in a second; no other method helps."""
    found = eomgen.simulate(eomgen.loads(FAST), time=1, target="numpy")
    assert found.status == "too many steps" and found.steps == soon
    assert "fast, 5.0e+09 turns" in found.message and "Radau" not in found.message


def test_a_state_that_grows_beyond_doubles_is_said_to(soon):
    """A force of 1e300 N turns a bar at 1e85 rad/s after 1e-135 s."""
    text = """
eomgen = 1
space = "plane"
[coordinates]
y = 0.05
theta = 0
[bodies.bar]
mass = 1000
inertia = 810
points.front = [1, 0]
joint = { kind = "planar", x = 0, y = "y", angle = "theta" }
[forces.front]
kind = "force"
point = "bar.front"
force = [1e300, "-18000*(y + sin(theta))"]
"""
    found = eomgen.simulate(eomgen.loads(text), time=1, target="numpy")
    assert found.steps == soon and "beyond what doubles can follow" in found.message
    assert "force 'front' is of the size 1e+300" in found.message


@in_slow_run
@pytest.mark.slow
def test_a_long_run_that_comes_on_is_not_stopped():
    """Where the steps that are left can be taken, they are: 20 000 turns."""
    found = march(
        lambda t, x: np.array([x[1], -x[0]]),
        (0.0, 40_000.0),
        np.array([1.0, 0.0]),
        how=Stepping(rtol=1e-6, atol=1e-6),
    )
    assert found.status == "finished" and found.steps > 2 * pace.LOOK


PUSHED = """
eomgen = 1
space = "plane"
parameters = { mu = 0.5, g = 9.81 }
coordinates = { s = { start = 0 } }
[bodies.block]
shape = { kind = "particle", mass = 2 }
joint = { kind = "placed", at = ["s", 0] }
[constraints]
floor = { kind = "support", point = "block.center", normal = [0, 1], friction = "mu" }
[forces]
weight = { kind = "gravity", acceleration = [0, "-g"] }
push = { kind = "force", point = "block.center", force = ["11.772*sin(2*pi*t)", 0] }
"""
"""it slips and sticks four times a second, as long as it is followed"""


@pytest.mark.slow
def test_a_run_of_many_phases_goes_on_where_its_end_is_in_reach_and_keeps_what_it_has_where_it_is_not(monkeypatch):
    """Four phases a second: 60 of them are followed; 4e6 are not begun, and those that were stay."""
    monkeypatch.setattr(simulation_motion, "LOOK_PHASES", 20)
    model = eomgen.loads(PUSHED)
    assert len(eomgen.simulate(model, time=10, target="numpy").phases) > 40
    found = eomgen.simulate(model, time=1e6, target="numpy", samples=[0.0, 1.0, 1e6])
    assert not found.ok and "after 20 phases the contacts 'floor' still change" in found.message
    assert "4.0e+06 more of them are left to t = 1e+06 s" in found.message and 4.5 < found.phases[-1].end < 5.5


def test_more_samples_than_fit_are_refused():
    """Before anything is made."""
    pendulum = str(MODELS / "simple_pendulum.toml")
    found = CliRunner().invoke(main, ["simulate", pendulum, "--samples", "1000000000000"])
    assert found.exit_code == 2 and "at most" in found.output


POWERS = "*".join(f"(x + {k})^{k}" for k in range(1, 201))
"""Of degree 20 100, near 1e35000 at x = 0."""


@pytest.mark.slow
@pytest.mark.parametrize("verb", ["derive", "solve", "reactions", "linearize", "simulate"])
def test_a_product_of_two_hundred_powers_ends_in_a_sentence(verb, tmp_path):
    """No value of it is a double: what it decides is not known, and nothing is called wrong that has no number."""
    path = tmp_path / "powers.toml"
    path.write_text(
        FAST.partition("[parameters]")[0].replace(', stiffness = "k", damping = "c"', "")
        + f"""
[parameters]
m = 1
[coordinates]
x = 0.1
[forces.f]
kind = "force"
point = "b.center"
force = ["-1e-300*{POWERS}", 0]
[outputs]
v = {{ value = "x'", at = "x = 0" }}
"""
    )
    found = CliRunner().invoke(main, [verb, str(path)])
    assert found.exit_code == (0 if verb in ("derive", "reactions") else 3) and "FAIL" not in found.output
    said = {
        "solve": "not answered: the motion starts where force 'f' has no finite value",
        "linearize": "no place was found at which all forces balance",
        "simulate": "no finite value",
    }
    assert said.get(verb, "") in found.output


@pytest.mark.parametrize(("stop", "code"), [(KeyboardInterrupt, 130), (PatienceEnded, 3)])
def test_answers_that_there_are_outlive_what_stops_the_search_for_the_others(stop, code, monkeypatch):
    """Of three the first is answered, the second stopped, the third not sought: JSON says so, and nothing is proven."""
    answer, requested = answers._Solver.answer, []

    def stopped(self, output):
        requested.append(output)
        if len(requested) == 2:
            raise stop
        return answer(self, output)

    monkeypatch.setattr(answers._Solver, "answer", stopped)
    found = CliRunner().invoke(main, ["solve", str(MODELS / "block_on_wedge.toml"), "--json"])
    reported = json.loads(found.stdout)
    values = [each["value"] for each in reported["outputs"].values()]
    assert found.exit_code == code and reported["certificate"] is None and len(requested) == 2
    assert values[0] is not None and values[1:] == [None, None] and "Nothing of it is proven" in found.stderr


OUT_OF_REACH = """
eomgen = 1
space = "plane"
[parameters]
m = 1
[coordinates]
s = { motion = { samples = [[0, 1.5], [1, 1.6], [2, 1.5]] } }
a = { dependent = true, near = 0.6 }
b = { dependent = true, near = 1 }
c = 0.3
[bodies]
barrel = { joint = { kind = "revolute", at = [0.2, -0.2], angle = "b" } }
[bodies.boom]
shape = { kind = "rod", mass = "m", length = 0.5 }
joint = { kind = "revolute", angle = "a" }
[bodies.piston]
shape = { kind = "particle", mass = "m" }
joint = { kind = "prismatic", on = "barrel", axis = [1, 0], displacement = "s" }
[bodies.bob]
shape = { kind = "rod", mass = "m", length = 0.4 }
joint = { kind = "revolute", on = "boom.end", angle = "c" }
[constraints]
eye = { kind = "pin", points = ["piston.center", "boom.end"] }
"""


@pytest.mark.slow
def test_ties_that_close_nowhere_near_the_start_are_not_looked_for_by_every_question(monkeypatch):
    """A strut of 1.5 m on a boom that reaches 0.8 m: each of what may stay constant draws twice, not twelve times."""
    sought, own = [], closure.Closure.closed
    monkeypatch.setattr(closure.Closure, "closed", lambda *given: sought.append(1) or own(*given))
    assert eomgen.derive(eomgen.loads(OUT_OF_REACH)).render("text")
    assert 0 < len(sought) < 60


@pytest.mark.slow
def test_no_equation_of_a_loop_is_longer_than_a_page(monkeypatch):
    """Joined again and again, equations of loops in space grow to ten pages, of which no root is taken."""
    own, sizes = places._waves, list[int]()

    def waves(equation, q):
        sizes.append(text_size(equation))
        return own(equation, q)

    monkeypatch.setattr(places, "_waves", waves)
    model = eomgen.load(Path(__file__).parents[1] / "laws" / "machines" / "double_cardan.toml")
    assert ExactStart(System.of(model)).exact
    assert max(sizes) <= places.PAGE
