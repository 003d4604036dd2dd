"""eomgen linearize: what it prints, what machines get, and what it refuses."""

from __future__ import annotations

import json
import math
from dataclasses import replace
from pathlib import Path

import pytest
from click.testing import CliRunner
from slow_run import usual

import eomgen
from eomgen.cli import main
from eomgen.documents import rendered
from eomgen.symbolic.exact.book_forms import book_form
from eomgen.symbolic.expression.text import parse
from eomgen.symbolic.numeric import tolerances
from eomgen.symbolic.numeric.evaluation import evaluate, fifty_digits
from eomgen.symbolic.print.text import text_size, to_text

pytestmark = pytest.mark.slow

MODELS = Path(__file__).parent.parent / "models"
BARS = str(MODELS / "seeds" / "ch22_p3.toml")
CART = str(MODELS / "cart_pole.toml")


def run(*words: str, text: str | None = None):
    result = CliRunner().invoke(main, ["linearize", *words], input=text)
    assert result.exception is None or isinstance(result.exception, SystemExit), result.exception
    return result


def test_the_result_for_machines_has_every_part():
    """Matrices exact and as numbers, modes with their shapes, the state matrix of x' = A x + B w."""
    result = run(CART, "--json")
    assert result.exit_code == 0, result.stderr
    found = json.loads(result.stdout)
    assert found["schema_version"] == 1 and found["second_order"] and found["exact"]
    assert found["mass"]["exact"] == [["M + m", "-1/2*m*l"], ["-1/2*m*l", "1/3*m*l^2"]]
    assert found["stiffness"]["exact"] == [["0", "0"], ["0", "-1/2*m*g*l"]]
    assert found["input"]["value"] == [[1.0], [0.0]]
    assert len(found["state_matrix"]) == 4 and len(found["input_matrix"]) == 4
    assert found["stability"] == "unstable" and "divergence" in found["why"]
    theta = next(f for f in found["transfer_functions"] if f["coordinate"] == "theta")
    assert theta["numerator"] == ["6"] and theta["denominator"] == ["-6*(M + m)*g", "0", "(4*M + m)*l"]
    steps = ["data", "reference", "equations", "characteristic", "modes", "stability", "state_space", "transfer"]
    assert [step["key"] for step in found["steps"]] == steps


@pytest.mark.parametrize(
    ("format", "word"), usual([("text", "omega_1 = "), ("latex", r"\omega_{1}"), ("markdown", "| mode |")], 2, 1)
)
def test_every_format_shows_the_frequencies(format, word):
    """Text, LaTeX, Markdown."""
    result = run(BARS, "--format", format)
    assert result.exit_code == 0, result.stderr
    assert word in result.stdout


def test_modes_are_drawn(tmp_path):
    """A panel for each mode; of systems in space bars."""
    for name in ("seeds/ch22_p3.toml", "bead_on_turning_hoop.toml"):
        path = tmp_path / "modes.png"
        eomgen.linearize(eomgen.load(MODELS / name)).plot(path)
        assert path.read_bytes().startswith(b"\x89PNG")


def test_a_coordinate_that_is_left_out_must_keep_its_momentum_or_not_act():
    """Of the cart and pole theta alone is asked: the cart keeps its momentum (Routh); of two coupled bars it is not."""
    found = eomgen.linearize(eomgen.load(CART), coordinates=("theta",))
    ((M,),), ((K,),) = found.M, found.K
    assert M == pytest.approx(0.1 / 3 - 0.1**2 / 4 / 1.1) and K == pytest.approx(-0.1 * 9.81 / 2)
    result = run(BARS, "--coordinate", "theta")
    assert result.exit_code == 3 and "theta cannot move alone: coupled with phi" in result.stderr
    result = run(BARS, "--coordinate", "thet")
    assert result.exit_code == 2 and "no coordinate 'thet'" in result.stderr


SWING = """
eomgen = 1
name = "swing"
space = "plane"
[parameters]
m = 1
l = {}
g = 9.81
[coordinates]
theta = {{ start = 0.1, near = 0 }}
[bodies.bob]
shape = {{ kind = "rod", mass = "m", length = "l" }}
joint = {{ kind = "revolute", angle = "theta - pi/2", torque = "{}" }}
[forces.weight]
kind = "gravity"
acceleration = [0, "-g"]
"""


def test_coefficients_that_change_with_time_have_no_modes():
    """K - sin(2 t): Mathieu's equation is not answered with the modes of an instant."""
    result = run("-", text=SWING.format(1, "theta*sin(2*t)"))
    assert result.exit_code == 3 and "change with time" in result.stderr


def test_a_pole_of_the_coordinates_is_named():
    """A spherical pendulum that hangs: its longitude moves nothing there."""
    result = run(str(MODELS / "spherical_pendulum.toml"))
    assert result.exit_code == 3 and "'phi' moves nothing there" in result.stderr


def test_without_values_formulas_stand_and_numbers_are_missing():
    """A length without a value: K, M, the frequency; no state matrix."""
    model = eomgen.loads(SWING.format("{}", "0"))
    found = eomgen.linearize(model)
    payload = found.as_dict()
    assert payload["stiffness"]["exact"] == [["1/2*m*g*l"]] and payload["stiffness"]["value"] is None
    assert payload["state_matrix"] is None and payload["modes"] is None
    assert "omega_1 = sqrt(3*g/(2*l))" in found.render("text").replace("1/2*sqrt(6*g/l)", "sqrt(3*g/(2*l))")


def test_exact_matrices_at_the_values_are_the_numbers():
    """M, C, K, B of sympy over the parameters, and in floats"""
    model = eomgen.load(CART)
    found = eomgen.linearize(model)
    values = {name: float(part.value.evaluate({})) for name, part in model.parameters.items()}
    for letter, numbers in (("M", found.M), ("C", found.C), ("K", found.K)):
        exact = found.exact[letter]
        at_values = exact.subs({symbol: values[symbol.name] for symbol in exact.free_symbols})
        assert [float(x) for x in at_values] == pytest.approx(numbers.ravel().tolist(), rel=1e-14)
    assert list(found.exact["B"]) == [1, 0]


def test_entries_are_written_as_formulas_of_a_book():
    """As short as they get: written again they stay as they are; of C what is not there is not printed."""
    found = eomgen.linearize(eomgen.load(MODELS / "whipple_bicycle.toml"))
    graph = found.modes.small.reference.system.scope.graph
    symbols = {name: graph.constant(name) for name in found.model.parameters}
    names, payload = ("mass", "damping", "gyroscopic", "stiffness", "circulatory"), found.as_dict()
    texts = {text for name in names for row in payload[name]["exact"] for text in row}
    for text in texts:
        assert to_text(book_form(parse(text, longest=len(text)).evaluate(symbols))) == text
    assert sum(map(len, texts)) < 2100  # 3 368 characters multiplied out
    reported = found.render("text")
    assert "G[phi, delta]" in reported and "G[delta, phi]" not in reported
    assert " G = " not in eomgen.linearize(eomgen.load(MODELS / "furuta_pendulum.toml")).render("text")


def test_an_input_that_does_not_reach_a_coordinate_has_the_transfer_function_zero():
    """W[a, tau] = 0, in numbers as in formulas"""
    text = """eomgen = 1
name = "collar"
space = "space"
[coordinates]
a = 0.3
s = 0.05
[inputs]
tau = 0
[bodies.arm]
mass = 2
center = [0, 0, -0.35]
inertia = [0.08, 0.08, 0.001]
joint = { kind = "revolute", axis = [1, 0, 0], angle = "a", torque = "tau" }
[bodies.collar]
mass = 0.5
inertia = [0.001, 0.001, 0.002]
joint = { kind = "prismatic", on = "arm", axis = [0, 0, 1], displacement = "s" }
[forces.spring]
kind = "spring"
points = ["arm.origin", "collar.origin"]
stiffness = 80
length = 0.7
[forces.weight]
kind = "gravity"
acceleration = [0, 0, -9.81]
"""
    printed = rendered(eomgen.linearize(eomgen.loads(text)).derivation, "text")
    assert "W[s, tau] = 0\n" in printed and "()" not in printed


def test_what_is_too_long_to_be_printed_has_its_value_however_it_is_written():
    """Coefficients of p(s) and what must be positive, shortest and as they came, of the Whipple bicycle."""
    shortest = eomgen.linearize(MODELS / "whipple_bicycle.toml")
    modes, came = shortest.modes, replace(shortest.modes, in_full=False)
    trial = modes.small.reference.trial
    for one, other in (
        (modes.polynomial.coefficients, came.polynomial.coefficients),
        (modes.conditions.expressions, came.conditions.expressions),
    ):
        values = [evaluate(x, trial, fifty_digits()) for x in (one, other)]
        assert all(abs(a - b) < tolerances.MET_AT_50 * abs(a) for a, b in zip(*values, strict=True))
        assert sum(map(text_size, one)) < sum(map(text_size, other))
    assert rendered(replace(shortest, modes=came).document, "text") == rendered(shortest.document, "text")


def test_small_turns_of_a_quaternion_are_proven_as_far_as_they_can_be():
    """A free top about a steady spin: what grows like t is looked at along coordinates, and small turns are none."""
    top = eomgen.load(MODELS / "seeds" / "s1_symmetric_top.toml")
    assert eomgen.linearize(top, about="start").certify().ok


TILTED = """
eomgen = 1
space = "plane"
parameters = { m = 2, k = 50, alpha = { value = 25, unit = "deg" } }
coordinates = { x = 0 }
[bodies.mass]
mass = "m"
joint = { kind = "prismatic", displacement = "x", axis = [1, 0], stiffness = "k*cos(alpha)" }
"""


def test_matrices_with_an_angle_in_degrees_are_read_back_as_printed():
    """K = k cos(alpha) at alpha = 25 deg, a multiple of pi: the proof of what is printed needs its number."""
    found = eomgen.linearize(eomgen.loads(TILTED))
    assert found.certify().ok
    assert abs(found.frequencies[0].mode.eigenvalue) == pytest.approx(
        math.sqrt(25 * math.cos(math.radians(25))), rel=1e-12
    )
