"""Derivatives by parameters and starts: closed forms, differences with 50 digits, laws that they keep."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import mpmath
import numpy as np
import pytest
from slow_run import beside, in_slow_run, sampled

import eomgen
from eomgen.errors import EomgenError
from eomgen.sensitivities.derivatives import slope_requested

MODELS = Path(__file__).parents[2] / "models"
DIGITS = 50
HANGING = {"theta1": 0.1, "theta2": 0.1}

SWING = """
eomgen = 1
space = "plane"
[parameters]
m = { value = 2, unit = "kg" }
k = { value = 50, unit = "N/m" }
c = { value = 3, unit = "N*s/m" }
L = { value = 40, unit = "cm" }
g = { value = 9.81, unit = "m/s^2" }
twice = "2*m"
[coordinates]
x = { start = "L/4" }
[points]
O = [0, 0]
[bodies.block]
shape = { kind = "particle", mass = "twice/2" }
joint = { kind = "prismatic", axis = [0, -1], displacement = "x" }
[forces.weight]
kind = "gravity"
acceleration = [0, "-g"]
[forces.spring]
kind = "spring"
points = ["O", "block.center"]
stiffness = "k"
length = 0
[forces.damper]
kind = "damper"
points = ["O", "block.center"]
damping = "c"
"""
UNDAMPED = SWING.replace('damping = "c"', "damping = 0")


def second(f, at: float) -> float:
    """f' by a central difference with 50 digits, right to 30."""
    with mpmath.workdps(DIGITS):
        h = mpmath.mpf(10) ** -15
        return float((f(mpmath.mpf(at) + h) - f(mpmath.mpf(at) - h)) / (2 * h))


# -- closed forms --------------------------------------------------------------------------------------------


def test_a_block_on_a_spring_sinks_by_its_weight():
    """x = m g/k at rest: dx/dm = g/k, dx/dk = -m g/k^2; a parameter that is made of another follows it."""
    found = eomgen.sensitivity(eomgen.loads(SWING), "equilibrium", ("m", "k"))
    assert found["x at equilibrium", "m"].exact == "g/k"
    assert found["x at equilibrium", "k"].exact == "-g*twice/(2*k^2)"
    assert found.matrix[0] == pytest.approx([9.81 / 50, -2 * 9.81 / 50**2], rel=1e-14)


def test_a_damped_frequency_changes_as_its_closed_form_does():
    """w = sqrt(k/m - (c/2m)^2), by differences with 50 digits."""
    p = {"m": 2.0, "k": 50.0, "c": 3.0}

    def w(**p):
        return mpmath.sqrt(p["k"] / p["m"] - (p["c"] / (2 * p["m"])) ** 2)

    found = eomgen.sensitivity(eomgen.loads(SWING), "frequency(1)", tuple(p))
    for name, slope in zip(found.to, found.matrix[0], strict=True):
        assert slope == pytest.approx(second(lambda x, name=name: w(**{**p, name: x}), p[name]), rel=1e-12)


@in_slow_run
@pytest.mark.slow
def test_frequencies_of_the_double_pendulum_by_fifty_digits():
    """det(K - w^2 M) = 0 of two rods, solved by hand."""
    p = {"m1": 1.0, "m2": 1.0, "l1": 1.0, "l2": 0.5, "g": 9.81}

    def w(k, m1, m2, l1, l2, g):
        M = (m1 * l1**2 / 3 + m2 * l1**2, m2 * l1 * l2 / 2, m2 * l2**2 / 3)
        K = ((m1 / 2 + m2) * g * l1, m2 * g * l2 / 2)
        a, b, c = M[0] * M[2] - M[1] ** 2, -(K[0] * M[2] + K[1] * M[0]), K[0] * K[1]
        root = mpmath.sqrt(b * b - 4 * a * c)
        return mpmath.sqrt((-b + (root if k else -root)) / (2 * a))

    found = eomgen.sensitivity(MODELS / "double_pendulum.toml", "frequencies", tuple(p), start=HANGING)
    right = [[second(lambda x, k=k, n=n: w(k, **{**p, n: x}), p[n]) for n in p] for k in (0, 1)]
    assert found.matrix == pytest.approx(np.array(right), rel=1e-12, abs=1e-12)


@pytest.mark.slow
def test_a_swinging_block_along_its_way():
    """x = x_0 + (s - x_0) cos(w t) with x_0 = m g/k: dx/dk, dx/dm, dx/ds at every instant."""
    model = eomgen.loads(UNDAMPED)
    found = eomgen.sensitivity(model, to=("m", "k", "x", "L"), time=3.0, samples=13)
    p = {"m": 2.0, "k": 50.0, "x": 0.1}

    def x(t, m, k, x):
        rest = m * mpmath.mpf("9.81") / k
        return rest + (x - rest) * mpmath.cos(mpmath.sqrt(k / m) * t)

    assert found.run is not None
    for name in p:
        right = [second(lambda y, t=t, name=name: x(t, **{**p, name: y}), p[name]) for t in found.run.t]
        assert found.run.slopes["x", name] == pytest.approx(right, rel=1e-9, abs=1e-9)
    assert found.run.slopes["x", "L"] == pytest.approx(found.run.slopes["x", "x"] / 4, rel=1e-12, abs=1e-12)


@pytest.mark.slow
def test_a_right_hand_side_has_its_slopes_in_closed_form():
    """theta'' = -g sin(theta)/l: its derivatives are those that a person writes."""
    found = eomgen.sensitivity(MODELS / "simple_pendulum.toml", "rhs", ("l", "g"))
    assert found["theta''", "l"].exact == "g*sin(theta)/l^2"
    assert found["theta''", "g"].exact == "-sin(theta)/l"


# -- laws ----------------------------------------------------------------------------------------------------


@sampled(2)
@pytest.mark.slow
@pytest.mark.parametrize(
    ("name", "of", "to"),
    [
        ("four_bar", "rhs", ("a", "b", "m")),
        ("rolling_disc", ("rhs", "reaction_n(floor)"), ("m", "R")),
        *beside(("flyball_governor", ("frequency(2)", "equilibrium", "stiffness(s, s)"), "a")),
        *beside(("whipple_bicycle", "frequencies", "w")),
        ("slider_crank", (), ("r", "P")),
        ("two_mass_oscillator", ("frequency(2)/frequency(1)", "mass(x1, x1)"), ()),
    ],
)
def test_derivatives_are_those_of_the_whole_computation(name, of, to):
    """The certificate: central differences of everything made anew at other values."""
    found = eomgen.sensitivity(MODELS / f"{name}.toml", of, to)
    certificate = found.certify()
    assert certificate.ok, str(certificate)
    slopes = [check for check in certificate.checks if check.name.startswith("d(")]
    assert len(slopes) == len(found.slopes) and not found.failed


@sampled(2)
@pytest.mark.slow
@pytest.mark.parametrize(
    ("name", "to", "time"),
    [
        ("double_pendulum", ("m1", "l2", "theta1", "theta1'"), 2.0),
        ("four_bar", ("a", "b"), 1.0),
        ("heavy_top", (), 0.5),
        ("cart_pole", (), 1.0),
    ],
)
def test_derivatives_along_a_run_are_those_of_neighbouring_runs(name, to, time):
    """The variational equations against differences of runs, where constraints close too, at every instant."""
    certificate = eomgen.sensitivity(MODELS / f"{name}.toml", to=to, time=time, samples=11).certify()
    assert certificate.ok, str(certificate)


@pytest.mark.slow
def test_the_flow_keeps_phase_space():
    """Liouville: det d(theta, p)/d(theta_0, p_0) = 1, p = M(theta) u, of the double pendulum."""
    model = eomgen.load(MODELS / "double_pendulum.toml")
    x = ("theta1", "theta2", "theta1'", "theta2'")
    flow = eomgen.sensitivity(model, x, x, time=1.0, samples=2)
    equations = eomgen.derive(model)
    ends = [[column[k] for column in flow.run.values.values()] for k in (0, -1)]
    M = [np.array(equations.subs(dict(zip(x, end, strict=True))).M.subs(VALUES), dtype=float) for end in ends]
    assert np.linalg.det(flow.matrix) == pytest.approx(np.linalg.det(M[0]) / np.linalg.det(M[1]), rel=1e-9)


VALUES = {name: value for name, value in (("m1", 1), ("m2", 1), ("l1", 1), ("l2", 0.5), ("g", 9.81))}


@pytest.mark.slow
@pytest.mark.parametrize("by", [1.001, *beside(-1.0)])
def test_a_wrong_derivative_is_seen(by):
    """A thousandth more, or another sign, fails; where it is zero there is nothing to see."""
    found = eomgen.sensitivity(MODELS / "double_pendulum.toml", ("theta1''", "frequency(1)"), "m1")
    wrong = replace(found, in_si={pair: by * slope for pair, slope in found.in_si.items()})
    assert found.certify().ok
    others = "derivatives are of the requested quantities"
    assert all(check.status == "fails" for check in wrong.certify().checks if check.name != others)


def test_units_are_those_of_the_file():
    """A coordinate in m over a length in cm, over a stiffness, over an acceleration; SI in the matrix."""
    found = eomgen.sensitivity(eomgen.loads(SWING), ("x", "x at equilibrium"), ("L", "k", "g"))
    assert found["x", "L"].unit == "m/cm" and found["x", "L"].value == pytest.approx(0.0025)
    assert found.matrix[0, 0] == pytest.approx(0.25)
    assert found["x at equilibrium", "k"].unit == "m/(N/m)"
    assert found["x at equilibrium", "g"].number.endswith("m/(m/s²)")


@pytest.mark.slow
def test_scaling_of_units_scales_derivatives():
    """Buckingham: y(s p) = s^n y(p) gives sum of n_p p dy/dp = n y: w of the double pendulum has no mass in it."""
    found = eomgen.sensitivity(MODELS / "double_pendulum.toml", "frequency(1)")
    slope = dict(zip(found.to, found.matrix[0], strict=True))
    w = found.values["frequency(1)"].value
    assert slope["m1"] + slope["m2"] == pytest.approx(0, abs=1e-12)
    assert slope["l1"] + 0.5 * slope["l2"] == pytest.approx(-w / 2, rel=1e-12)
    assert 9.81 * slope["g"] == pytest.approx(w / 2, rel=1e-12)


# -- what is refused, and what is swept ------------------------------------------------------------------------


def test_what_has_no_derivative_says_why():
    model = eomgen.load(MODELS / "double_pendulum.toml")
    with pytest.raises(eomgen.UsageError, match="no parameter, coordinate or speed 'm3'"):
        eomgen.sensitivity(model, "rhs", "m3")
    with pytest.raises(eomgen.NotYet, match="'floor', 'wall' may change along the way"):
        eomgen.sensitivity(MODELS / "sliding_ladder.toml", to="m", time=0.1)
    found = eomgen.sensitivity(model, "max(theta1)", "m1")
    assert "of a whole run" in (found["max(theta1)", "m1"].message or "") and found.failed
    with pytest.raises(eomgen.UsageError, match="no derivative"):
        found["theta1", "l1"]


@pytest.mark.parametrize(
    "name, of, to", [("stick_slip", "b", "v"), ("pendulum_on_stop", "q", "e"), ("bouncing_ball", "y", "e")]
)
def test_a_run_whose_contacts_change_has_no_derivative_and_says_so(name, of, to):
    """Stick and slip, a stop, impacts: what may change is named, and another way."""
    with pytest.raises(EomgenError, match=r"(?s)may change along the way.*fix: differences of two runs"):
        eomgen.sensitivity(eomgen.load(MODELS / f"{name}.toml"), of, to, time=1.0)


def test_two_equal_frequencies_have_no_derivative():
    """A sphere on equal springs in two directions: each frequency goes its own way."""
    text = UNDAMPED.replace("[points]", "y = 0.2\n[points]").replace(
        'kind = "prismatic", axis = [0, -1], displacement = "x"', 'kind = "placed", at = ["x", "y"]'
    )
    found = eomgen.sensitivity(eomgen.loads(text), "frequency(1)", "k")
    assert "several motions" in (found["frequency(1)", "k"].message or "")


SLEIGH = """
eomgen = 1
space = "plane"
parameters = { m = 2, J = 0.3, a = 0.2 }
coordinates = { x = { speed = 1 }, y = 0, th = { start = 0.4, speed = 0.5 } }
[bodies.sled]
mass = "m"
inertia = "J"
center = ["a", 0]
joint = { kind = "planar", x = "x", y = "y", angle = "th" }
[constraints]
blade = { kind = "skate", point = "sled.origin", along = [1, 0] }
[outputs]
v = "speed(sled.center)"
"""


def test_a_start_that_ties_have_moved_has_no_slope_of_what_moved_it():
    """Rates that a knife edge does not allow become others, by M: dv/dJ is not 0, and not told; 0 where y' follows."""
    moved = eomgen.sensitivity(eomgen.loads(SLEIGH.replace("y = 0,", "y = { speed = 1 },")), "v", "J")
    assert "how the start changes" in (moved["v", "J"].message or "")
    assert eomgen.sensitivity(eomgen.loads(SLEIGH), "v", "J").matrix[0, 0] == 0


def test_a_corner_has_no_slope():
    """sign(x') and min at a start where they jump or turn; beside it they have."""
    model = eomgen.loads(UNDAMPED)
    for formula in ("sign(x')", "min(x, L/4)*k", "abs(x - 0.1)"):
        name = "x'" if "'" in formula else "x"
        assert "a corner or a jump" in (eomgen.sensitivity(model, formula, name)[formula, name].message or "")
        there = eomgen.sensitivity(model, formula, name, start={"x": 0.2, "x'": 0.3})
        assert there.matrix[0, 0] == {"sign(x')": 0, "min(x, L/4)*k": 0}.get(formula, 1)


def test_a_place_of_rest_among_others_has_no_slope_by_the_start():
    """Of a sled that rests anywhere: dx/dx is 1 and not 0, and not told; of a block on a spring it is 0."""
    found = eomgen.sensitivity(eomgen.loads(SLEIGH), "x at equilibrium", ("x", "m"))
    assert "many equilibria" in (found["x at equilibrium", "x"].message or "") and found.matrix[0, 1] == 0
    assert eomgen.sensitivity(eomgen.loads(UNDAMPED), "x at equilibrium", "x").matrix[0, 0] == 0


@pytest.mark.slow
def test_a_sweep_asks_for_derivatives():
    """ "d(frequency(1))/d(k)" and "d(last(x))/d(k)" at every run: dw/dk = w/2k, and that of a single call."""
    assert slope_requested("d(last(x))/d(k)") == ("last(x)", "k") and slope_requested("x/k") is None
    model = eomgen.loads(UNDAMPED)
    requested = ("frequency(1)", "d(frequency(1))/d(k)", "d(last(x))/d(k)")
    swept = eomgen.sweep(model, over={"k": [40.0, 50.0]}, ask=requested, time=1.0)
    table = swept.table
    assert table[requested[1]] == pytest.approx(table[requested[0]] / (2 * table["k"]), rel=1e-12)
    alone = eomgen.sensitivity(model, "x", "k", time=1.0).matrix[0, 0]
    assert table[requested[2]][1] == pytest.approx(alone, rel=1e-9)
    assert swept.in_units()[1][requested[2]] == "d(last(x))/d(k) [m/(N/m)]"
    with pytest.raises(eomgen.UsageError, match="no parameter"):
        eomgen.sweep(model, over={"k": [1.0]}, ask="d(x)/d(q)", time=1.0)


DRIVEN = """
eomgen = 1
space = "plane"
parameters = { r = 0.1, b = 0.3, m = 1 }
coordinates.phi = { motion = "5*t + 1" }
coordinates.be = { dependent = true, near = 0 }
coordinates.x = { dependent = true, near = 0.3 }
bodies.crank = { shape = { kind = "rod", mass = "m", length = "r" }, joint = { kind = "revolute", angle = "phi" } }
bodies.rod.shape = { kind = "rod", mass = "m", length = "b" }
bodies.rod.joint = { kind = "revolute", on = "crank.end", angle = "be - phi" }
bodies.slide.shape = { kind = "particle", mass = "m" }
bodies.slide.joint = { kind = "prismatic", axis = [1, 0], displacement = "x" }
constraints.P = { kind = "pin", points = ["rod.end", "slide.origin"] }
"""


def test_a_driven_linkage_follows_its_parameters():
    """x = r cos(phi) + sqrt(b^2 - r^2 sin^2(phi)) of phi = 1, which nobody has to mark as dependent"""
    found = eomgen.sensitivity(eomgen.loads(DRIVEN), of="x", to=["r", "b", "m"])
    c, s, root = np.cos(1), np.sin(1), np.sqrt(0.09 - 0.01 * np.sin(1) ** 2)
    slopes = [float(found["x", to].value) for to in ("r", "b", "m")]
    assert slopes == pytest.approx([c - 0.1 * s * s / root, 0.3 / root, 0])


def test_a_derivative_that_is_told_in_another_unit_is_contradicted():
    """told value times the size of its unit = the number in SI."""
    found = eomgen.sensitivity(eomgen.loads(SWING), "x at equilibrium", "m")
    pair = ("x at equilibrium", "m")
    wrong = replace(found, slopes={pair: replace(found[pair], value=found[pair].value * 100)})
    assert found.certify().ok and [x.name for x in wrong.certify().checks if x.status == "fails"] == [
        "reported derivatives are those in SI"
    ]


def test_what_a_derivative_is_of_and_its_closed_form_are_looked_at():
    """Another value, another text, another formula than was asked: each is contradicted by its own check."""
    found = eomgen.sensitivity(eomgen.loads(SWING), "equilibrium", "m")
    of, pair = "x at equilibrium", ("x at equilibrium", "m")
    wrongs = {
        "its value is": replace(found, values={of: replace(found.values[of], value=0.3)}),
        "for": replace(found, slopes={pair: replace(found[pair], exact="2*g/k")}),
        f"{of} for rhs": replace(found, wanted=("rhs",)),
    }
    assert found.certify().ok
    for words, wrong in wrongs.items():
        (seen,) = [check for check in wrong.certify().checks if check.status == "fails"]
        assert words in seen.detail


@pytest.mark.parametrize(
    ("word", "of"),
    [
        ("rhs", ("x'", "x''")),
        ("frequencies", ("frequency(1)",)),
        ("equilibrium", ("x at equilibrium",)),
        ("x'", ("x'",)),
    ],
)
def test_words_stand_for_formulas_by_the_names_of_the_file(word, of):
    """What is asked in a word is certified to be its formulas; one more beside them is not."""
    found = eomgen.sensitivity(eomgen.loads(SWING), word, "m")
    checks = [x.certify().checks for x in (found, replace(found, of=(*of, "m")))]
    held = [next(check.ok for check in each if "requested quantities" in check.name) for each in checks]
    assert found.of == of and held == [True, False]


@pytest.mark.slow
def test_values_at_the_end_are_those_of_the_last_instant():
    """x(t) of a run: those of another instant, told as those of the end, are contradicted."""
    found = eomgen.sensitivity(MODELS / "elastic_pendulum.toml", "state", ("m",), time=0.5, samples=4)
    name = "values at the end are those of the last instant"
    assert next(check for check in found.certify().checks if check.name == name).ok
    early = {pair: float(column[1]) for pair, column in found.run.slopes.items()}
    wrong = replace(found, in_si=early)
    assert next(check for check in wrong.certify().checks if check.name == name).ok is False
