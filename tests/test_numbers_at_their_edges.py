"""Numbers that are too large, that divide by nothing or that are none are refused where they stand."""

from __future__ import annotations

import json
import math
from pathlib import Path

import numpy as np
import pytest
from click.testing import CliRunner

import eomgen
from eomgen.cli import main
from eomgen.errors import DerivationError, ExpressionError, ModelError
from eomgen.files import json_text
from eomgen.model.shapes import MassProperties
from eomgen.model.shapes.base import diagonal
from eomgen.model.shapes.solids import Cone
from eomgen.symbolic.expression.graph import Graph
from eomgen.symbolic.expression.rational import Fraction
from eomgen.symbolic.expression.text import parse
from eomgen.symbolic.numeric.arithmetic import INTERVALS, number_of
from eomgen.symbolic.numeric.dense import independent, lengths_of
from eomgen.symbolic.numeric.evaluation import ARRAYS, FLOAT, evaluate

MODELS = Path(__file__).parent.parent / "models"
SPRING = """
eomgen = 1
space = "plane"
[coordinates]
x = 0.3
[bodies.b]
shape = {{ kind = "particle", mass = "{mass}" }}
joint = {{ kind = "prismatic", axis = [1, 0], displacement = "x", {law} }}
[outputs]
o = "{output}"
"""


def block(mass="1", law="stiffness = 2", output="x"):
    return SPRING.format(mass=mass, law=law, output=output)


@pytest.mark.parametrize("text", ["1" * 320, "1" * 320 + "^(1/3)", "2*" + "9" * 310])
def test_a_number_beyond_all_doubles_is_refused_where_it_stands(text):
    """10^320 is too large for a number: said by line and caret, as the model is read."""
    with pytest.raises(ModelError, match="too large for a number") as caught:
        eomgen.loads(block(mass=text))
    assert "<text>:7:" in str(caught.value) and "^^^" in str(caught.value)


def test_the_largest_numbers_that_fit_are_taken():
    """1e300 is a number."""
    assert parse("1e300").evaluate({}) == 10**300


@pytest.mark.parametrize("power", ["0^(-1/3)", "0^(-1/2)", "0^(-2)"])
def test_a_negative_power_of_nothing_is_a_division_by_zero(power):
    with pytest.raises(ExpressionError, match="division by zero"):
        parse(power)
    with pytest.raises(ExpressionError, match="division by zero"):
        parse("x^y").evaluate({"x": 0, "y": Fraction(-1, 3), "pi": Graph().pi})


def test_what_is_no_number_is_refused_where_it_stands():
    """frequency(nan) is a mistake of the model, with its place."""
    with pytest.raises(ModelError, match="'nan' is not a number") as caught:
        eomgen.loads(block(output="frequency(nan)"))
    assert "<text>:10:16" in str(caught.value)


def test_a_block_pushed_by_a_power_of_two_oscillates_with_the_root_of_its_logarithm():
    """x'' = 1 - 2^x rests at x = 0, and there x'' = -ln 2 x."""
    model = eomgen.loads(block(law='force = "1 - 2^x"', output="frequency(1)"))
    answer = eomgen.solve(model)["o"]
    assert answer.value == pytest.approx(math.sqrt(math.log(2)), rel=1e-12)


@pytest.mark.parametrize("base", [(0.5, 2.0), (2.0, 2.0), (1.5, 1.5), (0.1, 0.9)])
@pytest.mark.parametrize("exponent", [(-2.0, 3.0), (0.5, 0.75), (-1.0, -0.5)])
def test_the_interval_of_a_power_holds_all_its_values(base, exponent):
    """a^n for a and n each in an interval."""
    ends = [np.array([[low], [high]]) for low, high in (base, exponent)]
    low, high = INTERVALS.functions["pow"](*ends)
    values = [a**n for a in np.linspace(*base, 9) for n in np.linspace(*exponent, 9)]
    assert low[0] <= min(values) and max(values) <= high[0]
    assert max(values) == pytest.approx(high[0]) and min(values) == pytest.approx(low[0])


def test_exact_numbers_beyond_all_doubles_are_infinite_in_doubles_and_right_in_their_ratio():
    """10^400 x / 10^399 is 10 x; in doubles 10^400 is inf, in intervals it is beyond the largest double."""
    x = Graph().symbol("x")
    big = (10**400 + x) / (10**399 + x)
    assert number_of(big, {x: 1}) == pytest.approx(10, rel=1e-14)
    assert evaluate((x * 10**400,), {x: 1.0}, FLOAT) == [math.inf]
    assert np.all(np.isinf(evaluate((x * 10**400,), {x: np.ones(2)}, ARRAYS)[0]))
    low, high = INTERVALS.number(-(10**400))
    assert low == -math.inf and high < -1e308


CONE = """
eomgen = 1
space = "space"
parameters = {{ m = "{m}", r = "{r}", h = 0.4 }}
[bodies.b]
shape = {{ kind = "cone", mass = "m", radius = "r", height = "h" }}
joint = {{ kind = "fixed" }}
"""


def _run(tmp_path, text, *words):
    path = tmp_path / "cone.toml"
    path.write_text(text)
    return CliRunner().invoke(main, [words[0], str(path), *words[1:]])


@pytest.mark.parametrize("form", ["text", "json", "latex", "markdown"])
@pytest.mark.parametrize("certify", [(), ("--no-certify",)], ids=["certified", "not certified"])
def test_a_result_beyond_doubles_has_failed_in_every_form_and_is_named(tmp_path, form, certify):
    """m r^2 at m = 1e300 kg, r = 1e10 m is 1e320 kg m^2: no result, so exit 3; never an internal error."""
    done = _run(tmp_path, CONE.format(m="1e300", r="1e10"), "inertia", "--format", form, *certify)
    assert done.exit_code == 3
    assert "no finite number: " in done.stderr and "I_xx" in done.stderr
    if form == "json":
        found = json.loads(done.stdout, parse_constant=pytest.fail)["results"]["I_xx(b)"]
        assert found["value"] is None and "no finite number" in found["message"]


def test_a_formula_that_makes_a_moment_of_inertia_negative_is_contradicted_in_json(tmp_path, monkeypatch):
    """k = sqrt(I/m) of I < 0 is no number: exit 3, the shape's check fails, and null stands for k."""

    def of_mass(self, m, value):
        r, h = value(self.radius), value(self.height)
        across = Fraction(3, 80) * m * h * h - 2 * m * r * r
        return MassProperties(m, (0, 0, 0), diagonal(across, across, Fraction(3, 10) * m * r * r))

    monkeypatch.setattr(Cone, "of_mass", of_mass)
    done = _run(tmp_path, CONE.format(m="2", r="0.3"), "inertia", "--json")
    assert done.exit_code == 3
    assert "the certificate FAILS" in done.stderr and "no finite number: results.k_1(b)" in done.stderr
    found = json.loads(done.stdout, parse_constant=pytest.fail)
    assert found["results"]["k_1(b)"]["value"] is None
    assert "fails" in {check["status"] for check in found["certificate"]["checks"]}


@pytest.mark.parametrize("beyond", [math.nan, math.inf, -math.inf])
def test_json_never_holds_what_is_no_number(beyond):
    """JSON has no word for nan and inf: what would be written with one is refused, however deep it stands."""
    with pytest.raises(DerivationError, match="no finite number"):
        json_text({"a": [1.0, {"b": beyond}]})
    assert json_text({"a": [1.0, None]}) == '{"a": [1.0, null]}'


@pytest.mark.parametrize("size", [1e-300, 1e-200, 1.0, 1e200, 1e300])
def test_lengths_of_rows_and_columns_are_right_at_any_size(size):
    """|s (3, 4)| = 5 s, although (3 s)^2 is beyond doubles, or below."""
    A = size * np.array([[3.0, 4.0], [0.0, 0.0]])
    assert lengths_of(A, 1) == pytest.approx([5 * size, 0], rel=1e-15, abs=0)
    assert lengths_of(A, 0) == pytest.approx([3 * size, 4 * size], rel=1e-15, abs=0)
    assert lengths_of(A) == pytest.approx(5 * size, rel=1e-15, abs=0)
    assert independent(size * np.array([[1.0, 2.0], [2.0, 1.0]]), smallest=1e-9)


@pytest.mark.slow
@pytest.mark.parametrize("x", ["1e-300", "1e-160", "1e200*a"])
def test_the_reactions_of_a_truss_are_proven_wherever_its_nodes_stand(tmp_path, x):
    """A node 1e-300 m aside makes numbers of 300 digits in the exact directions of members: the proof holds."""
    text = (MODELS / "seeds" / "ch21_p6.toml").read_text().replace("n1 = [0, 0]", f'n1 = ["{x}", 0]')
    done = _run(tmp_path, text, "solve", "--json")
    found = json.loads(done.stdout)
    assert done.exit_code == 0 and found["certificate"]["ok"], done.stderr
    if x != "1e200*a":
        assert found["outputs"]["R1_y"]["value"] == pytest.approx(8)
