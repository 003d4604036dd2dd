"""Every way by which a value with a unit gets in: each verb by each of its options, and the functions of Python.

PYTHONPATH=tests/helpers python tests/test_unit_paths.py > docs/unit_paths.md        writes the table
"""

from __future__ import annotations

import json
import math
from pathlib import Path

import pytest
from click.testing import CliRunner
from slow_run import sampled, usual

import eomgen
from eomgen.cli import main
from eomgen.cli_common import Lasting
from eomgen.errors import ModelError, UsageError
from eomgen.verbs import typed as valued
from eomgen.verbs.assignments import OPTIONS

pytestmark = pytest.mark.slow

PENDULUM = """
eomgen = 1
name = "Pendulum"
space = "plane"
[parameters]
l = { value = 50, unit = "cm" }
m = { value = 2, unit = "kg" }
g = { value = 9.81, unit = "m/s^2" }
[coordinates]
theta = { start = 40, unit = "deg" }
[bodies.bob]
shape = { kind = "rod", mass = "m", length = "l" }
joint = { kind = "revolute", angle = "theta - pi/2" }
[forces.weight]
kind = "gravity"
acceleration = [0, "-g"]
[outputs]
T = "kinetic_energy()"
"""
TAKEN = {
    "--set": {
        "l=80": ("l", 80, "cm"),
        "l=0.8 m": ("l", 80, "cm"),
        "l=160*l/m": None,
        "l=2*pi": ("l", 2 * math.pi, "cm"),
    },
    "--start": {"theta=30": ("theta", 30, "deg"), "theta'=15 rpm": ("theta'", 90, "deg/s"), "theta=pi/6": None},
    "--from-rest": {"theta=30": ("theta", 30, "deg"), "theta=0.1 rad": ("theta", 18 / math.pi, "deg"), "theta=l": None},
    "--at": {"theta=-10": ("theta", -10, "deg"), "theta=-0.1 rad": ("theta", -18 / math.pi, "deg"), "theta=pi/6": None},
    "--until": {"theta=10": ("theta", 10, "deg"), "theta'=-10 rpm": ("theta'", -60, "deg/s"), "theta=5 m": None},
    "--given": {
        "omega(bob)=2": ("omega(bob)", 2, "1/s"),
        "omega(bob)=30 rpm": ("omega(bob)", 30, "rpm"),
        "omega(bob)=5 m": None,
    },
    "--over": {
        "l=40:0.8 m:2": ("l", [40, 80], "cm", "40 cm to 80 cm, 2 values equally apart"),
        "log:l=40:0.9 m:3": ("l", [40, 90], "cm", "40 cm to 90 cm, 3 values each by one factor"),
        "l=40,600 mm": ("l", [40, 60], "cm", "40 cm, 60 cm"),
        "l=40:5 kg:2": None,
    },
    "--random": {
        "theta=normal(10, 0.1 rad)": ("theta", [10, 18 / math.pi], "deg", "normal(10 deg, 5.729577951 deg)"),
        "m=lognormal(500 g, 0.1)": ("m", [0.5, 0.1], "kg", "lognormal(0.5 kg, 0.1)"),
        "theta=uniform(0, pi)": None,
    },
    "--ask": {
        "theta' at theta = 10": ("theta", 10, "deg"),
        "theta' at theta = 0.1 rad": ("theta", 18 / math.pi, "deg"),
        "theta' at theta = pi/6": None,
    },
    "--critical": {"theta' at theta = 10": ("theta", 10, "deg"), "theta' at theta = pi/6": None},
    "--slider": {
        "l=0.3 m:90": ("l", [30, 90], "cm", "30 cm to 90 cm"),
        "theta'=-15 rpm:90": ("theta'", [-90, 90], "deg/s", "-90 deg/s to 90 deg/s"),
        "theta=0:pi": None,
    },
    "--time": {"0.2": 0.2, "200 ms": 0.2, "1/5": 0.2, "5 m": None, "soon": None},
}
"""of each option: what is typed, and under which name, as which value and in which unit it is taken, how that is said;
a number: in s, with nothing said; None: refused"""
TYPED = OPTIONS | {"over": "--over", "random": "--random", "ask": "--ask", "critical": "--critical"}
TYPED |= {"sliders": "--slider", "time": "--time"}
BESIDE = {
    "animate": ["-o", "OUT.gif", "--fps", "10"],
    "codegen": ["-o", "OUT"],
    "export": ["-o", "OUT.urdf"],
    "identify": ["--data", "OUT.csv"],
    "play": ["-o", "OUT.html"],
    "reactions": ["--plot", "OUT.svg"],
    "report": ["-o", "OUT.html", "--without", "figure,plots,motion,downloads"],
    "simulate": ["--target", "numpy"],
    "sweep": ["--over", "g=9,10", "--ask", "max(theta)"],
    ("linearize", "--over"): ["--view", "locus", "--plot", "OUT.svg"],
    "verify": ["T = m*l^2*theta'^2/6"],
}
"""what else a verb needs, or one of its options"""
STILL = ("new", "schema", "doctor", "examples", "import", "live", "lsp")
"""verbs that compute nothing of a model that one types values for; import makes one"""


def paths() -> list[tuple[str, str]]:
    """(verb, option) of every option whose value has a unit."""
    return [
        (verb, TYPED[parameter.name])
        for verb, command in main.commands.items()
        for parameter in command.params
        if TYPED.get(parameter.name) in parameter.opts
    ]


def said(taken: tuple | float) -> str:
    """What was taken, in words."""
    if isinstance(taken, float):
        return f"{taken:g} s"
    return f"{taken[0]} = {taken[3]}" if len(taken) > 3 else f"{taken[0]} = {taken[1]:.10g} {taken[2]}"


def table() -> str:
    """The ways in, as a page."""
    head = "# By which way a value with a unit gets in\n\n"
    head += "Each verb by its options, what is typed and what is taken of it; written by\n"
    head += "`PYTHONPATH=tests/helpers python tests/test_unit_paths.py`, whose tests run each row.\n"
    head += "The model: lengths in cm, angles in deg.\n\n"
    rows = ["| verb | option | typed | taken |", "|---|---|---|---|"]
    for verb, option in paths():
        for typed, taken in TAKEN[option].items():
            reported = "refused" if taken is None else said(taken)
            rows.append(f"| {verb} | `{option}` | `{typed}` | {reported} |")
    return head + "\n".join(rows) + "\n"


@pytest.fixture
def pendulum(tmp_path: Path) -> Path:
    path = tmp_path / "pendulum.toml"
    path.write_text(PENDULUM)
    rows = ["t,theta,theta',theta''"]
    rows += [f"{t},{math.sin(t)},{math.cos(t)},{-math.sin(t)}" for t in (k / 10 for k in range(20))]
    (tmp_path / "out.csv").write_text("\n".join(rows))
    return path


def test_what_is_typed_for_a_verb_that_lasts_is_taken_in_the_same_way():
    """`live` shows its page until it is ended: its values are those of `typed`, which all verbs use."""
    model = eomgen.loads(PENDULUM)
    for option, parameter in (("--set", "set_"), ("--start", "start")):
        for written, expected in TAKEN[option].items():
            if expected is None:
                with pytest.raises(UsageError):
                    valued(model, {parameter: (written,)})
                continue
            (taken,) = valued(model, {parameter: (written,)})[0].taken
            assert (taken.name, taken.value, taken.unit) == (expected[0], pytest.approx(expected[1]), expected[2])


ENDING = [(verb, option) for verb, option in paths() if not isinstance(main.commands[verb], Lasting)]


@sampled(2)
@pytest.mark.parametrize(("verb", "option"), usual(ENDING, 3, 1))
def test_what_is_typed_is_in_the_unit_of_the_file_or_in_its_own_and_what_was_taken_is_said(verb, option, pendulum):
    """45 of an angle in deg is 45 deg; 0.8 m of a length in cm is 80 cm; on stderr and in `taken`."""
    if verb == "identify":  # which asks for a force that is known
        pendulum.write_text(PENDULUM.replace('angle = "theta - pi/2"', 'angle = "theta - pi/2", torque = 1'))
    for typed, expected in TAKEN[option].items():
        takes_time = any("--time" in parameter.opts for parameter in main.commands[verb].params)
        words = [
            verb,
            str(pendulum),
            *(["--time", "0.2"] if takes_time else []),
            *BESIDE.get(verb, []),
            *BESIDE.get((verb, option), []),
            option,
            typed,
            "--json",
        ]
        words = [word.replace("OUT", str(pendulum.parent / "out")) for word in words]
        words += ["--no-certify"] if any("--no-certify" in p.opts for p in main.commands[verb].params) else []
        result = CliRunner().invoke(main, words)
        if expected is None:
            assert result.exit_code == 2, typed
            continue
        assert result.exit_code == 0, result.output
        if isinstance(expected, float):
            reported = json.loads(result.stdout)
            ended = next((reported[key] for key in ("time", "end") if key in reported), None)
            assert ended in (None, expected) or ended["t"] == expected
            continue
        name, value, unit, *_ = expected
        reported = json.loads(result.stdout)["taken"][name]
        assert reported["value"] == pytest.approx(value, rel=1e-12)
        assert reported["unit"] == unit
        assert f"taken: {said(expected)}" in result.stderr


def test_every_verb_that_computes_takes_values_and_starts():
    """--set and --start on each."""
    found = {verb: {option for v, option in paths() if v == verb} for verb in main.commands if verb not in STILL}
    assert all({"--set", "--start"} <= options for options in found.values()), found


def test_the_page_of_ways_is_that_of_the_verbs():
    """docs/unit_paths.md = table()."""
    page = (Path(__file__).parent.parent / "docs" / "unit_paths.md").read_text(encoding="utf-8")
    assert page == table(), "PYTHONPATH=tests/helpers python tests/test_unit_paths.py > docs/unit_paths.md"


class OfPint:
    """A quantity as pint has it."""

    def __init__(self, magnitude: float, dimensionality: dict[str, int]) -> None:
        self.magnitude, self.dimensionality = magnitude, dimensionality

    def to_base_units(self) -> OfPint:
        return self


@pytest.mark.parametrize(
    "typed", [0.8, (80, "cm"), "80 cm", "0.8 m", "4/5", OfPint(0.8, {"[length]": 1.0}), "0.4*k/k*2"]
)
def test_in_python_a_plain_number_is_si_and_others_bring_their_unit(typed, pendulum):
    """l = 0.8 m however it is said; with names in it in SI."""
    pendulum.write_text(PENDULUM.replace("[coordinates]", "k = 3\n[coordinates]"))
    found = eomgen.derive(pendulum, parameters={"l": typed}).model.parameters["l"].value
    assert found.evaluate({"k": 3}) * 5 == 4


FUNCTIONS = (
    eomgen.derive,
    eomgen.solve,
    eomgen.reactions,
    eomgen.statics,
    eomgen.kinematics,
    eomgen.inertia,
    eomgen.linearize,
    eomgen.generate,
    eomgen.freedom_of,
    eomgen.inverse_dynamics,
    lambda model, **values: eomgen.simulate(model, time=0.1, target="numpy", **values),
)


@pytest.mark.parametrize("function", FUNCTIONS)
def test_every_function_takes_values_and_refuses_a_unit_that_does_not_fit(function, pendulum):
    """parameters= and start=."""
    function(pendulum, parameters={"l": (80, "cm")}, start={"theta": "30 deg"})
    with pytest.raises(UsageError, match="does not fit"):
        function(pendulum, parameters={"l": "30 deg"})
    with pytest.raises(UsageError, match="no coordinate or speed"):
        function(pendulum, start={"thet": 1})


def test_a_start_in_python_is_where_the_motion_starts(pendulum):
    """theta(0) = 30 deg = pi/6, theta'(0) = 15 rpm = pi/2 rad/s."""
    run = eomgen.simulate(pendulum, time=0.1, target="numpy", start={"theta": (30, "deg"), "theta'": "15 rpm"})
    assert list(run.x[0]) == pytest.approx([math.pi / 6, math.pi / 2], rel=1e-15)


def test_a_rate_that_is_typed_is_the_rate_of_every_verb(pendulum):
    """T = m l^2 theta'^2/6 at the start, theta' = 15 rpm = pi/2 rad/s."""
    found = eomgen.solve(pendulum, start={"theta'": "15 rpm"})["T"]
    assert found.value == pytest.approx(2 * 0.25 / 6 * (math.pi / 2) ** 2, rel=1e-14)


def test_given_velocities_are_in_the_units_that_the_file_declares():
    """theta' = 90 of an angle in deg is 90 deg/s; pi/2 is refused with both fixes."""
    ending = '\n[given]\nvelocity = ["{}"]\n'
    model = eomgen.loads(PENDULUM + ending.format("theta' = 90"))
    assert model.given.velocity[0].right.evaluate({"pi": 1}) * 2 == 1
    turned = eomgen.loads(PENDULUM + ending.format("omega(bob) = 300 rpm"))
    assert turned.given.velocity[0].right.evaluate({"pi": 1}) == 10
    with pytest.raises(ModelError, match=r"write 90 deg/s, or pi/2 rad/s"):
        eomgen.loads(PENDULUM + ending.format("theta' = pi/2"))
    with pytest.raises(ModelError, match="does not fit"):
        eomgen.loads(PENDULUM + ending.format("theta' = 3 m"))


@pytest.mark.parametrize(
    ("words", "reported"),
    [
        (("--set", "l=45 dge"), "did you mean 'deg'?"),
        (("--set", "l=5*m*cm"), "unknown name 'cm'"),
        (("--set", "l=5*cm"), "write 5 cm"),
        (("--set", "l=2*m cm"), "write 2*m"),
        (("--start", "theta=pi/4"), "write 45 deg, or pi/4 rad"),
        (("--set", "g=m"), "'m' is in kg, but 'g' is in m/s^2"),
        (("--set", "m=-1"), "negative"),
    ],
)
def test_what_is_typed_wrongly_is_refused_with_its_mend(words, reported, pendulum):
    """Exit 2, and the nearest right thing."""
    result = CliRunner().invoke(main, ["derive", str(pendulum), *words])
    assert (result.exit_code, reported in result.stderr) == (2, True), result.stderr


def test_a_start_that_is_typed_takes_the_place_of_the_guess_of_the_file():
    """sin theta = 0: from near = 3 the pendulum stands on its head, from the typed 0.1 it hangs."""
    path = Path(__file__).parents[1] / "models" / "simple_pendulum.toml"
    text = path.read_text(encoding="utf-8").replace("start = 1.0, ", "near = 3, ")
    found = [eomgen.linearize(eomgen.loads(text), start=start).as_dict()["state"] for start in ({}, {"theta": 0.1})]
    assert [state["theta"]["value"] for state in found] == [pytest.approx(math.pi), 0]


@pytest.mark.parametrize(
    "typed", [{"l": ([40, 80], "cm")}, {"l": ["40 cm", 0.8]}, {"l": "0.4:80 cm:2"}, {"l": [0.4, 0.8]}]
)
def test_values_of_many_runs_in_python_are_si_or_bring_their_unit(typed, pendulum):
    """The same of `sweep` and of `simulate_many`, whose values are arrays."""
    swept = eomgen.sweep(pendulum, over=typed, ask="max(theta)", time=0.1)
    assert list(swept["l"]) == [0.4, 0.8]
    if not isinstance(typed["l"], str):
        runs = eomgen.simulate_many(pendulum, time=0.1, samples=2, parameters=typed)
        assert list(runs.given["l"]) == [0.4, 0.8]
    with pytest.raises(UsageError, match="does not fit"):
        eomgen.sweep(pendulum, over={"l": (1, "kg")}, ask="max(theta)", time=0.1)
    with pytest.raises(UsageError, match="does not fit"):
        eomgen.simulate_many(pendulum, time=0.1, parameters={"l": ["1 kg"]})


@pytest.mark.parametrize("torque", [2.0, "2 N*m", (0.002, "kN*m"), "2 + 0*t"])
def test_an_input_in_python_is_si_or_brings_its_unit(torque, pendulum):
    """A torque declared in kN*m: 2 are 2 N*m, in a run, in many, beside a given motion."""
    text = PENDULUM.replace("[bodies.bob]", '[inputs]\nM = { value = 0, unit = "kN*m" }\n[bodies.bob]')
    pendulum.write_text(text.replace('"theta - pi/2" }', '"theta - pi/2", torque = "M" }'))
    known = eomgen.loads(pendulum.read_text().replace("value = 0, unit", "value = 0.002, unit"))
    run = eomgen.simulate(pendulum, time=0.2, samples=3, target="numpy", inputs={"M": torque})
    assert run.x == pytest.approx(eomgen.simulate(known, time=0.2, samples=3, target="numpy").x, rel=1e-12)
    many = eomgen.simulate_many(pendulum, time=0.2, samples=3, target="numpy", inputs={"M": torque})
    assert many.x[0] == pytest.approx(run.x, rel=1e-8)
    with pytest.raises(UsageError, match="does not fit"):
        eomgen.simulate(pendulum, time=0.2, inputs={"M": "2 kg"})


def test_a_given_motion_in_python_is_si_or_brings_its_unit(pendulum):
    """tau = m g l/2 sin theta of a rod that is held at 30 deg."""
    found = eomgen.inverse_dynamics(pendulum)
    times = [0.0, 0.5, 1.0]
    for angle in (math.pi / 6, "30 deg", (30, "deg"), [math.pi / 6] * 3, ([30] * 3, "deg")):
        held = found.along(times, {"theta": angle}, {"l": "80 cm"})
        assert held["theta"] == pytest.approx([2 * 9.81 * 0.8 / 4] * 3, rel=1e-12)


def test_an_instant_that_is_asked_of_many_runs_is_in_the_unit_of_the_file(pendulum):
    """theta' at theta = 10 of an angle in deg is theta' at 10 deg, and its column says so."""
    words = ["sweep", str(pendulum), "--over", "m=1", "--time", "1", "--no-certify", "--json"]
    reported = json.loads(CliRunner().invoke(main, [*words, "--ask", "theta' at theta = 10"]).stdout)
    requested = "theta' at theta = 10 deg"
    right = eomgen.sweep(pendulum, over={"m": 1}, ask=requested, time=1)[requested]
    assert reported["table"][requested] == pytest.approx(list(right), rel=1e-14) and abs(right[0]) > 1


@sampled(2)
@pytest.mark.parametrize("typed", ["500 ms", 0.5, (500, "ms"), "1/2", OfPint(0.5, {"[time]": 1.0})])
def test_a_time_has_its_unit_or_is_in_seconds(typed, pendulum):
    """Half a second however it is said, of a run, its instants, many runs, a sweep, slopes, pages, a controller."""
    swinging = PENDULUM.replace("[bodies.bob]", '[inputs]\nM = { value = 0, unit = "N*m" }\n[bodies.bob]')
    driven = eomgen.loads(swinging.replace('"theta - pi/2" }', '"theta - pi/2", torque = "M" }'))
    run = eomgen.simulate(pendulum, time=typed, target="numpy", samples=[0, typed])
    assert list(run.t) == [0, 0.5] == list(eomgen.simulator(pendulum, target="numpy")(typed, samples=2).t)
    assert list(eomgen.simulate_many(pendulum, time=typed, samples=2, target="numpy").t) == [0, 0.5]
    assert eomgen.sweep(pendulum, over={"m": 1}, ask="max(theta)", time=typed).plan.how.time == 0.5
    assert eomgen.sensitivity(pendulum, "theta", "l", time=typed, samples=[0, typed]).run.t[-1] == 0.5
    assert eomgen.play(pendulum, time=typed).played.run.t[-1] == 0.5
    assert eomgen.report(pendulum, time=typed, without=("figure", "plots", "motion", "downloads")).time == 0.5
    held = eomgen.simulate(driven, time=1, samples=3, target="numpy", inputs={"M": {"value": "t", "every": typed}})
    assert held.x[2] != pytest.approx(held.x[1]) and [phase.end for phase in held.phases] == [0.5, 1]


@pytest.mark.parametrize("typed", ["5 m", "soon", None, True, math.nan, math.inf, (1, "kg"), [1, 2], "2*l", b"1"])
def test_what_is_no_time_is_refused_wherever_one_is_asked(typed, pendulum):
    """The same sentence in Python as on the command line; pages have a time of their own where none is given."""
    pages = (lambda: eomgen.play(pendulum, time=typed), lambda: eomgen.report(pendulum, time=typed))
    for requested in (
        lambda: eomgen.simulate(pendulum, time=typed),
        lambda: eomgen.simulator(pendulum)(typed),
        lambda: eomgen.simulate_many(pendulum, time=typed),
        lambda: eomgen.sweep(pendulum, over={"m": 1}, ask="theta", time=typed),
        lambda: eomgen.simulate(pendulum, time=1, samples=[0, typed]),
        *(() if typed is None else pages),
    ):
        with pytest.raises(UsageError, match="is no time"):
            requested()


if __name__ == "__main__":
    print(table(), end="")
