"""Where constraints do not hold at the start asked for, every verb begins at the same one; what was typed moves
last."""

from __future__ import annotations

import json
import math
from pathlib import Path

import pytest
from click.testing import CliRunner
from slow_run import sampled, usual

import eomgen
from eomgen.cli import main
from eomgen.page.player import PlayedRun, PlayerOptions

pytestmark = pytest.mark.slow

MODELS = Path(__file__).parents[2] / "models"
ROD = """
[bodies.{0}]
shape = {{ kind = "rod", mass = {2}, length = {3} }}
joint = {{ kind = "revolute", {1}, angle = "{4}" }}
"""
HEAD = 'eomgen = 1\nspace = "plane"\n'
WEIGHT = '[forces.weight]\nkind = "gravity"\nacceleration = [0, -9.81]\n'
FOUR_BAR = (
    HEAD
    + """[coordinates]
a = { start = 60, unit = "deg" }
b = { start = 5, unit = "deg" }
c = { start = 70, unit = "deg" }
"""
    + ROD.format("crank", "at = [0, 0]", 1, 0.5, "a")
    + ROD.format("coupler", 'on = "crank.end"', 2, 1.1, "b - a")
    + ROD.format("rocker", "at = [1, 0]", 1, 0.8, "c")
    + '[constraints.pin]\nkind = "pin"\npoints = ["coupler.end", "rocker.end"]\n'
    + WEIGHT
)
CRANK = (
    HEAD
    + """[coordinates]
a = { start = 30, unit = "deg" }
b = -0.3
s = { start = 150, unit = "cm" }
"""
    + ROD.format("crank", "at = [0, 0]", 1, 0.5, "a")
    + ROD.format("rod", 'on = "crank.end"', 2, 1.2, "b - a")
    + """[bodies.piston]
shape = { kind = "particle", mass = 3 }
joint = { kind = "prismatic", axis = [1, 0], displacement = "s" }
[constraints.pin]
kind = "pin"
points = ["rod.end", "piston.center"]
"""
    + WEIGHT
)
TURNED = CRANK.replace("b = -0.3", "b = {}").replace(
    "[bodies.crank]", "[speeds]\nw = \"2*a' + b'\"\nv = \"a' - b'\"\n[bodies.crank]"
)
"""loops of which all starts, some, or none that the constraints allow are given; with a declared speed too"""
LOOPS = {
    "four_bar": (FOUR_BAR, ["a=40"], ["a=40", "b=0.1 rad"], ["c=100", "c'=2"], ["a'=3"]),
    "crank": (CRANK, ["a=50"], ["s=160"], ["s=1.55 m", "s'=20"], ["b=-0.2"]),
    "turned": (TURNED, ["a=50"], ["s=160", "w=1"], ["b=-0.2", "w=1"]),
}
CASES = [(name, tuple(start)) for name, (_, *starts) in LOOPS.items() for start in starts]


@pytest.fixture(params=usual(CASES, 3), ids=lambda case: f"{case[0]} {' '.join(case[1])}")
def typed(request, tmp_path):
    """(path, what is typed, the start of the run in SI) of a loop that does not close as it is typed."""
    name, starts = request.param
    text, names = LOOPS[name][0], LOOPS[name][0].partition("[coordinates]")[2].partition("[")[0]
    bodies = [line[8:-1] for line in text.splitlines() if line.startswith("[bodies.")]
    requested = [line.split(" =")[0] for line in names.splitlines() if " =" in line]
    text += "[outputs]\n" + "".join(f'out_{q} = "{q}"\nrate_{q} = "{q}\'"\n' for q in requested)
    text += "".join(f'x_{body} = "x({body}.center)"\n' for body in bodies)
    path = tmp_path / "loop.toml"
    path.write_text(text)
    words = [word for start in starts for word in ("--start", start)]
    run = reported("simulate", path, words, "--time", "0", "--target", "numpy")
    return path, words, run | {"start": with_rates(run["start"])}


def with_rates(start: dict[str, float]) -> dict[str, float]:
    """The rates too, where w = 2 a' + b' and v = a' - b' stand in their place."""
    if "w" not in start:
        return start
    return start | {"a'": (start["w"] + start["v"]) / 3, "b'": (start["w"] - 2 * start["v"]) / 3}


def reported(verb: str, path: Path, words: list[str], *more: str) -> dict:
    found = CliRunner().invoke(main, [verb, str(path), *words, *more, "--json"])
    assert found.exit_code == 0, found.stderr
    return json.loads(found.stdout) | {"said": [line for line in found.stderr.splitlines() if "The start was" in line]}


def test_what_was_typed_is_kept_where_the_ties_allow_it(typed):
    """The values typed are those of the run, whatever the file gives; what had to change for them is said."""
    _, words, run = typed
    places = [name for name in run["taken"] if name in "abcs"]
    for name, taken in run["taken"].items():
        if len(places) > 1 and name in places:  # one freedom: of two places one has to move
            continue
        scale = {"deg": math.pi / 180, "deg/s": math.pi / 180, "cm": 0.01, "cm/s": 0.01}.get(taken["unit"], 1)
        assert run["start"][name] == pytest.approx(taken["value"] * scale, abs=1e-12), words
    assert run["assembled"] and run["said"] == [f"The start was {run['assembled']}."]


@sampled(3)
def test_every_verb_begins_at_the_same_start(typed):
    """check, solve, reactions and kinematics give of the start what the first row of a run gives, and say the same."""
    path, words, run = typed
    begun = reported("check", path, words)
    assert begun["start"] == {name: pytest.approx(run["start"][name], abs=1e-12) for name in begun["start"]}
    answers = reported("solve", path, words, "--no-certify")
    for name, answer in answers["outputs"].items():
        kind, _, of = name.partition("_")
        if kind != "x":
            expected = run["start"][of if kind == "out" else f"{of}'"]
            assert answer["value"] == pytest.approx(expected, abs=1e-9), name
    reactions = reported("reactions", path, words, "--no-certify")
    for name, reaction in reactions["reactions"].items():
        assert reaction["value"] == pytest.approx(run["start"][name], rel=1e-9, abs=1e-9), name
    moving = reported("kinematics", path, words, "--no-certify")
    rates = {"crank": "a'", "rocker": "c'", "coupler": "b'", "rod": "b'"}
    for body, rate in rates.items():
        if body in moving["angular_velocities"]:
            found = moving["angular_velocities"][body]["value"]
            assert found == pytest.approx(run["start"][rate], abs=1e-9), body
    assert answers["said"] == reactions["said"] == moving["said"] == run["said"]


def test_the_page_and_python_begin_there_too(typed):
    """eomgen.derive(model, start=...).start(), and the page's own search for a start by its three kinds of values."""
    path, _, run = typed
    start = {
        name: taken["typed"]
        if " " in taken["typed"]
        else (taken["value"], taken["unit"])
        if taken["unit"]
        else taken["value"]
        for name, taken in run["taken"].items()
    }
    equations = eomgen.derive(path, start=start)
    names = (*equations.coordinates, *equations.speeds)
    begun = dict(zip(names, equations.start().tolist(), strict=True))
    assert begun == {name: pytest.approx(run["start"][name], abs=1e-12) for name in names}
    found = eomgen.simulate(path, time=0.01, start=start, target="numpy")
    live = PlayedRun(found, PlayerOptions(moves=True)).live
    assert live is not None and set(live.reported()["typed"]) >= set(start) & set(names)


def test_a_closed_form_of_the_start_has_a_value_at_the_values_of_the_file():
    """phi = atan((d + r sin alpha)/(r cos alpha)) at alpha = pi/2 divides by 0: the number serves; w = r n/(r + d)."""
    model = eomgen.loads(
        HEAD
        + """parameters = { r = 0.2, d = 0.1, L = 0.5, n = 12, alpha = "pi/2" }
[coordinates]
theta = { motion = "alpha + n*t" }
phi = { dependent = true, near = "atan2(d + r*sin(alpha), r*cos(alpha))" }
[bodies.crank]
points = { P = ["r", 0] }
joint = { kind = "revolute", angle = "theta" }
[bodies.lever]
shape = { kind = "rod", mass = 4, length = "L" }
line = ["start", "end"]
joint = { kind = "revolute", at = [0, "-d"], angle = "phi" }
[constraints.block]
kind = "slider"
point = "crank.P"
on = "lever"
[outputs]
w = "omega(lever)"
"""
    )
    answers = eomgen.solve(model)
    assert answers["w"].value == pytest.approx(0.2 * 12 / 0.3) and answers.certify().ok
