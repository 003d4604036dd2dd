"""Functions through samples: what they are between their samples, and that every verb knows them."""

from __future__ import annotations

import json
import subprocess
import warnings
from fractions import Fraction
from random import Random

import numpy as np
import pytest
from click.testing import CliRunner
from each import each
from scipy.interpolate import CubicSpline, PchipInterpolator
from slow_run import sampled

import eomgen
from eomgen.cli import main
from eomgen.codegen.build import compiler
from eomgen.errors import ModelError, UsageError
from eomgen.model.checks.plausible import warnings_of
from eomgen.model.replaced import Requests
from eomgen.model.sampled_laws import samples
from eomgen.simulation.solvers import METHODS
from eomgen.symbolic.expression.graph import Graph
from eomgen.symbolic.expression.splines import Sampled, number_of_sampled, spline_of
from eomgen.symbolic.numeric.evaluation import FLOAT, evaluate, fifty_digits
from eomgen.symbolic.print.sympy_form import to_sympy
from eomgen.symbolic.print.text import to_text

pytestmark = pytest.mark.slow

ARM = """
[parameters]
m = 1.5
l = 0.8
g = 9.81
[coordinates]
theta = {law}
[bodies.arm]
shape = {{ kind = "rod", mass = "m", length = "l" }}
joint = {{ kind = "revolute", angle = "theta" }}
[forces]
weight = {{ kind = "gravity", acceleration = [0, "-g"] }}
{more}
"""


def arm(law: str, more: str = "") -> eomgen.Model:
    return eomgen.loads('eomgen = 1\nname = "arm"\nspace = "plane"\n' + ARM.format(law=law, more=more))


def random_samples(n: int, seed: int = 1) -> tuple[list[Fraction], list[Fraction]]:
    rng = Random(seed)
    times = [Fraction(rng.randint(-20, 5), 10)]
    while len(times) < n:
        times.append(times[-1] + Fraction(rng.randint(1, 20), 10))
    return times, [Fraction(rng.randint(-50, 50), 10) for _ in times]


# -- between the samples --------------------------------------------------------------------------


@each("ends, theirs", [("not-a-knot",) * 2, ("natural",) * 2, ("rest", "clamped")])
@each("n", [2, 3, 4, 5, 30])
def test_a_cubic_through_samples_is_that_of_scipy(ends, theirs, n):
    """f, f', f'' and the integral of scipy.interpolate.CubicSpline."""
    times, values = random_samples(n)
    own, other = spline_of(times, values, "cubic", ends), CubicSpline(times, values, bc_type=theirs)
    integral = own.integral()
    at = np.linspace(float(times[0]), float(times[-1]), 97)
    for function, order in ((own, 0), (own.derivative(), 1), (own.derivative().derivative(), 2)):
        assert np.allclose([function.at(t, float) for t in at.tolist()], other(at, order), rtol=1e-10, atol=1e-10)
    found = [integral.at(t, float) for t in at.tolist()]
    assert np.allclose(np.array(found) - found[0], [other.integrate(at[0], t) for t in at], rtol=1e-10, atol=1e-10)
    assert integral.at(Fraction(0)) == 0


def test_a_cubic_is_smooth_exactly_and_goes_on_straight():
    """f, f' and f'' have one value at every inner knot; beyond the ends f'' = 0 and f' stays."""
    times, values = random_samples(40)
    spline = spline_of(times, values)
    for function in (spline, spline.derivative(), spline.derivative().derivative()):
        for k in range(1, len(times) - 1):
            before, after = (_polynomial(function, j, times[k]) for j in (k, k + 1))
            assert before == after
    assert all(spline.at(t) == y for t, y in zip(times, values, strict=True))
    rate = spline.derivative()
    for end, beyond in ((times[0], times[0] - 3), (times[-1], times[-1] + 5)):
        assert rate.at(beyond) == rate.at(end)
        assert spline.at(beyond) == spline.at(end) + rate.at(end) * (beyond - end)


def _polynomial(spline, piece, t):
    return sum(c * (t - spline.origins[piece]) ** k for k, c in enumerate(spline.pieces[piece]))


def test_lines_and_steps_between_samples():
    times, values = [Fraction(k) for k in (0, 1, 3)], [Fraction(k) for k in (2, 4, -2)]
    linear, steps = spline_of(times, values, "linear"), spline_of(times, values, "steps")
    assert [linear.at(Fraction(t)) for t in (-1, 0, 0.5, 1, 2, 3, 9)] == [2, 2, 3, 4, 1, -2, -2]
    assert [steps.at(Fraction(t)) for t in (-1, 0, 0.5, 1, 2, 3, 9)] == [2, 2, 2, 4, 4, -2, -2]
    assert [linear.derivative().at(Fraction(t)) for t in (-1, 0, 1, 3, 9)] == [0, 2, -3, -3, 0]


def test_many_samples_stay_short_and_right():
    """2000 irregular samples: numbers of bounded length, the values of the samples, f'' continuous to 1e-60."""
    rng = Random(3)
    times = [Fraction(repr(x)) for x in sorted({rng.uniform(0, 50) for _ in range(2000)})]
    spline = spline_of(times, [Fraction(repr(rng.gauss(0, 1))) for _ in times])
    assert max(c.denominator.bit_length() for piece in spline.pieces for c in piece) < 2000
    bend = spline.derivative().derivative()
    size = max(abs(bend.at(t)) for t in times)
    assert all(
        abs(_polynomial(bend, k, times[k]) - _polynomial(bend, k + 1, times[k])) < size / 10**60
        for k in range(1, len(times) - 1)
    )


@each("pi_power", [0, 1, -1])
def test_every_scalar_gives_the_same_value(pi_power):
    """Graph in floats and 50 digits, sympy, and the derivative of the graph; printed by its name."""
    sampled = Sampled("f", spline_of(*random_samples(7)), pi_power)
    graph = Graph()
    t = graph.symbol("t")
    x = graph.call("sampled", t, number_of_sampled(sampled))
    assert to_text(x) == "f"
    form = to_sympy([x])[0]
    for at in (-3, Fraction(1, 3), 2, 40):
        exact = sampled.at(Fraction(at), Fraction, Fraction(np.pi))
        assert evaluate((x,), {t: float(at)}, FLOAT)[0] == pytest.approx(float(exact), rel=1e-12)
        digits = fifty_digits()
        assert float(evaluate((x,), {t: digits.number(at)}, digits)[0]) == pytest.approx(float(exact), rel=1e-12)
        assert float(
            form.subs("t", at) if not form.free_symbols else form.subs({symbol: at for symbol in form.free_symbols})
        ) == pytest.approx(float(exact), rel=1e-12)


# -- in models ------------------------------------------------------------------------------------


def test_the_drive_of_a_sampled_motion_is_that_of_the_motion():
    """Samples of sin(2 t): drive = m l^2/3 theta'' + m g l/2 cos(theta), to the error of a cubic."""
    times = np.arange(0, 2.01, 0.05)
    listed = json.dumps([[float(t), float(np.sin(2 * t))] for t in times])
    run = eomgen.simulate(arm(f"{{ motion = {{ samples = {listed} }} }}"), time=2, samples=101)
    t, theta = run.t, np.sin(2 * run.t)
    assert np.allclose(run["theta"], theta, atol=2e-6)
    drive = 1.5 * 0.64 / 3 * -4 * theta + 1.5 * 9.81 * 0.4 * np.cos(theta)
    assert np.abs(run["drive(theta)"] - drive)[(t > 0.2) & (t < 1.8)].max() < 2e-3


LAWS = {
    "motion": '{ motion = { samples = [[0, 10], [0.5, 20], [1, 15], [2, 40]] }, unit = "deg" }',
    "rate": '{ rate = { samples = [[0, 1], [0.5, 2], [2, -1]], between = "linear" }, start = 0.2 }',
    "acceleration": '{ acceleration = { samples = [[0, 1], [0.5, 2], [2, -1]], between = "steps" }, speed = 0.3 }',
    "degrees": '{ acceleration = { samples = [[0, 90], [2, 30]] }, start = 30, speed = 60, unit = "deg" }',
}


@each("law", LAWS)
def test_motions_rates_and_accelerations_by_samples_are_certified(law):
    equations = eomgen.derive(arm(LAWS[law]))
    assert equations.certify().ok


def test_rates_and_accelerations_add_up_to_the_motion():
    """theta = theta0 + speed t + integrals of the samples."""
    run = eomgen.simulate(arm(LAWS["rate"]), time=2, samples=3)
    assert run["theta"] == pytest.approx([0.2, 0.2 + 0.75 + (2 + 1) / 4, 0.2 + 0.75 + 0.75], abs=1e-8)
    run = eomgen.simulate(arm(LAWS["acceleration"]), time=2, samples=3)
    assert run["theta"][1] == pytest.approx(0.3 + 0.125 + 0.25 + 0.25, abs=1e-8)
    run = eomgen.simulate(arm(LAWS["degrees"]), time=2, samples=3)
    t = 2.0
    assert run["theta"][-1] == pytest.approx(np.radians(30 + 60 * t + 45 * t * t - 30 * t**3 / 6), abs=1e-8)


def test_the_derivation_prints_a_sampled_motion_by_its_name():
    text = eomgen.derive(arm(LAWS["motion"])).render("text")
    assert "theta is cubic through 4 samples from 0 to 2 s." in text
    assert "T = 1/6*m*l^2*theta'^2" in text
    assert "select" not in text
    solved = eomgen.solve(arm(LAWS["motion"], '[outputs]\nM = "drive(theta)"'))
    assert solved["M"].exact == "1/6*m*l*(3*g*cos(theta) + 2*l*theta'')"


@sampled(2)
@pytest.mark.skipif(compiler() is None, reason="no C compiler")
@pytest.mark.parametrize("law", LAWS)
def test_emitted_code_follows_the_samples(tmp_path, law):
    """C and numpy give the symbols' numbers; the files pass their own test with every warning an error."""
    model = arm(LAWS[law], PULSE)
    equations = eomgen.derive(model)
    c, numpy = equations.rhs("c"), equations.rhs("numpy")
    for t in np.linspace(-1, 4, 41):
        assert c(t, c.x0, c.p0) == pytest.approx(numpy(t, c.x0, c.p0), rel=1e-13)
    t = np.linspace(-1, 4, 41)
    assert np.allclose(c.many(t, np.tile(c.x0, (41, 1)), c.p0), numpy.many(t, np.tile(c.x0, (41, 1)), c.p0))
    path = tmp_path / "arm.toml"
    path.write_text('eomgen = 1\nname = "arm"\nspace = "plane"\n' + ARM.format(law=LAWS[law], more=PULSE))
    done = CliRunner().invoke(main, ["codegen", str(path), "-o", str(tmp_path)])
    assert done.exit_code == 0, done.output
    for kind in ("rhs", "reactions"):
        compiled = ["cc", "-std=c99", "-Wall", "-Wextra", "-pedantic", "-Werror", "-DEOMGEN_SELFTEST"]
        subprocess.run([*compiled, "-o", str(tmp_path / "a"), str(tmp_path / f"arm_{kind}.c"), "-lm"], check=True)
        subprocess.run([str(tmp_path / "a")], check=True)


PULSE = """
push = { kind = "force", point = "cart.center", force = ["F", 0] }
[inputs]
F = { value = { samples = [[0, 0], [3, 0], [3.01, 50], [3.02, 0]], between = "linear" } }
[coordinates.x]
start = 0
[bodies.cart]
mass = 2
inertia = 1
joint = { kind = "prismatic", axis = [1, 0], displacement = "x" }
"""


@each("method", METHODS)
def test_a_short_pulse_after_a_long_rest_is_not_stepped_over(method):
    """Momentum is the impulse: m v = 50 N * 0.02 s / 2."""
    run = eomgen.simulate(eomgen.loads(f'eomgen = 1\nspace = "plane"\n[forces]{PULSE}'), time=10, method=method)
    assert run["x'"][-1] == pytest.approx(0.25, rel=1e-6)


def test_arrays_make_samples_in_python():
    times = np.linspace(0, 1, 11)
    law = samples(times, np.sin(times), ends="natural")
    model = eomgen.Model(
        space="plane",
        coordinates={"x": eomgen.Coordinate(motion=law)},
        bodies={"cart": eomgen.Body(mass=2, inertia=1, joint=eomgen.joints.Prismatic(axis=[1, 0], displacement="x"))},
    )
    assert eomgen.simulate(model, time=1)["x"][-1] == pytest.approx(np.sin(1), abs=1e-6)


# -- files ----------------------------------------------------------------------------------------


def test_a_run_drives_the_next_one(tmp_path):
    """--follow theta=run.csv gives the torque that the free motion took: none."""
    run = eomgen.simulate(arm("0.3"), time=1, samples=401)
    path = tmp_path / "run.csv"
    run.to_csv(path)
    again = eomgen.simulate(Requests(arm("0.3")).following([f"theta={path}"]), time=1, samples=41)
    assert np.abs(again["theta"] - run["theta"][::10]).max() < 1e-7
    assert np.abs(again["drive(theta)"][2:-2]).max() < 1e-3


@pytest.mark.parametrize(
    ("text", "what"),
    [
        ("t,a,b\n0,1,2\n1,2,3\n", "there is no column 'theta'"),
        ("0,1\n0,2\n", "the times of samples ascend, but 0 comes after 0"),
        ("0\n1\n", "a row has no column 2"),
        ("t;theta\n0;1,5\n1;2\n", "columns stand between commas"),
        ("t\ttheta\n0\t1\n1\t2\n", "columns stand between commas"),
        ("t,theta\n0,1\n1,x\n", "samples"),
        ("", "a list of 2 to 10000 samples is needed here, not 0"),
    ],
)
def test_a_file_without_samples_is_refused(tmp_path, text, what):
    path = tmp_path / "given.csv"
    path.write_text(text)
    with pytest.raises(UsageError, match=what):
        Requests(arm("0.3")).following([f"theta={path}"])


@each(
    "law, what",
    [
        ("{ motion = { samples = [[0, 1]] } }", "a list of 2 to 10000 samples is needed here, not 1"),
        ("{ motion = { samples = [[0, 1], [0, 2]] } }", "the times of samples ascend, but 0 comes after 0"),
        ("{ motion = { samples = [[0, 1], [1]] } }", "a time and a value are needed here"),
        ('{ motion = { samples = [[0, 1], [1, "m"]] } }', "unknown name 'm'"),
        ("{ motion = { samples = [[0, 1], [1, nan]] } }", "nan"),
        ('{ motion = { samples = [[0, 1], [1, 2]], between = "linear" } }', "unknown word 'linear'"),
        ('{ rate = { samples = [[0, 1], [1, 2]], between = "steps" } }', "unknown word 'steps'"),
        ('{ rate = { samples = [[0, 1], [1, 2]], between = "linear", ends = "rest" } }', "'ends' is for 'cubic'"),
        ('{ motion = { samples = [[0, 1], [1, 2]], end = "rest" } }', "unknown key 'end'"),
        ("{ motion = { samples = 3 } }", "a list of 2 to 10000 samples is needed here, not 3"),
        ("{ start = { samples = [[0, 1], [1, 2]] } }", "unknown key 'samples'"),
    ],
)
def test_samples_that_cannot_be_meant_are_refused_where_they_stand(law, what):
    with pytest.raises(ModelError, match=what) as caught:
        arm(law)
    assert "<text>:10:" in str(caught.value)


def test_the_schema_knows_samples():
    import jsonschema

    schema = json.loads(CliRunner().invoke(main, ["schema"]).output)
    model = {"eomgen": 1, "space": "plane", "coordinates": {"x": {"motion": {"samples": [[0, 1], [1, 2]]}}}}
    jsonschema.validate(model, schema)
    model["coordinates"]["x"]["motion"]["between"] = "steps"
    with pytest.raises(jsonschema.ValidationError):
        jsonschema.validate(model, schema)


DWELLS = "[[0, 0], [1, 1.9], [3, 1.9], [4, 0.4], [4.5, 0.5]]"


@each("rows", [DWELLS, "[[0, 1], [2, 5]]", "[[0, 0], [1, 3], [1.5, 2.9], [4, 2.9]]", "[[-1, 2], [0, 1], [7, 9]]"])
def test_monotone_cubics_are_those_of_another_program(rows):
    """Fritsch and Butland's slopes: scipy's PchipInterpolator, f, f' and f'' between all samples"""
    pairs = np.array(json.loads(rows), dtype=float)
    law = eomgen.samples(pairs[:, 0], pairs[:, 1], between="pchip").sampled
    other = PchipInterpolator(*pairs.T)
    for t in np.linspace(pairs[0, 0], pairs[-1, 0], 23)[1:-1]:
        function = law
        for order in range(3):
            assert float(function.spline.at(Fraction(float(t)))) == pytest.approx(float(other(t, order)), abs=1e-9)
            function = function.derivative()


def test_a_dwell_of_monotone_cubics_stays_and_one_of_cubics_is_warned_of():
    """f = 1.9 on [1, 3], and nowhere more"""
    text = 'eomgen = 1\nspace = "plane"\n[coordinates]\nz = {{ motion = {{ samples = {}{} }} }}\n' + (
        '[bodies.b]\nshape = {{ kind = "particle", mass = 1 }}\n'
        'joint = {{ kind = "prismatic", axis = [0, 1], displacement = "z" }}\n'
    )
    smooth, monotone = (eomgen.loads(text.format(DWELLS, way)) for way in ("", ', between = "pchip"'))
    law = monotone.coordinates["z"].motion.sampled.spline
    values = [law.at(Fraction(k, 100)) for k in range(451)]
    assert max(values) == Fraction(19, 10) and {law.at(Fraction(k, 10)) for k in range(10, 31)} == {Fraction(19, 10)}
    reported = [each.what for each in warnings_of(smooth)]
    assert len(reported) == 1 and "between the equal samples at 1 and 3 s" in reported[0]
    assert warnings_of(monotone) == ()


def test_a_run_that_leaves_its_samples_is_warned_of(tmp_path):
    """Samples to 3 s, run to 5 s: a warning, exit 1 with --strict; none within, and none where `ends` is said"""
    inside = arm("{ motion = { samples = [[0, 0], [1, 0.7], [2, 0.2], [3, 0.4]] } }")
    said = arm('{ motion = { samples = [[0, 0], [1, 0.7], [2, 0.2], [3, 0.4]], ends = "natural" } }')
    for model, time, warned in ((inside, 5, True), (inside, 3, False), (said, 5, False)):
        with warnings.catch_warnings(record=True) as caught:
            warnings.simplefilter("always")
            eomgen.simulate(model, time=time)
        assert any("beyond them it goes on straight" in str(w.message) for w in caught) is warned


def test_a_motion_by_monotone_cubics_is_proven():
    """Its accelerations jump at the samples, onto which a run steps"""
    model = arm('{ motion = { samples = [[0, 0], [1, 0.7], [2, 0.7], [3, 0.4]], between = "pchip" } }')
    assert eomgen.derive(model).certify().ok
    run = eomgen.simulate(model, time=3)
    assert run.ok and run.certify().ok and {0.0, 1.0, 2.0, 3.0} <= set(run.phases[0].track[0].tolist())


def test_samples_at_instants_that_no_double_holds_are_met_by_the_proof():
    """0.3 < 3/10 and 1.2 < 6/5 as doubles: there code, symbols and declared steps take the same piece."""
    bent = arm('{ motion = { samples = [[0, 0], [0.3, 0.7], [0.9, 0.7], [2, 0.4]], between = "pchip" } }')
    run = eomgen.simulate(bent, time=0.3)
    assert run.t[-1] == 0.3
    assert run.certify().ok
    stepped = arm(
        "0.2",
        'push = { kind = "couple", body = "arm", couple = "M" }\n'
        '[inputs]\nM = { value = { samples = [[0, 0], [0.4, 3], [1.2, 0]], between = "steps" } }',
    )
    assert eomgen.derive(stepped).certify().ok


def test_second_definitions_of_outputs_hold_at_the_first_sample():
    """|v| = l theta', |a|^2 = l^2 (theta''^2 + theta'^4) by differences inside the table."""
    law = "{ motion = { samples = [[0, 0.1], [1, 0.7], [2, 0.4], [3, 0.4]] } }"
    requested = '[outputs]\nv = "speed(arm.end)"\na = "acceleration(arm.end)"\nseen = "ax(arm.center)"'
    answers = eomgen.solve(arm(law, requested))
    theta = CubicSpline([0, 1, 2, 3], [0.1, 0.7, 0.4, 0.4])
    rate, second = float(theta(0, 1)), float(theta(0, 2))
    assert answers["v"].value == pytest.approx(0.8 * abs(rate))
    assert answers["a"].value == pytest.approx(0.8 * np.hypot(second, rate**2))
    assert answers.certify().ok
