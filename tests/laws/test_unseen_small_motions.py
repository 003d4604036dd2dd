"""Small motions of systems from textbooks, against matrices written by hand: stiff, tiny, gyroscopic, rolling."""

from fractions import Fraction
from pathlib import Path

import numpy as np
import pytest
import sympy

import eomgen
from eomgen.symbolic.text import to_text

MODELS = Path(__file__).parents[2] / "models"
PARTICLE = 'shape = { kind = "particle", mass = "m" }'


def small(text: str, space: str = "plane", about: str | None = None):
    return eomgen.linearize(eomgen.loads(f'eomgen = 1\nspace = "{space}"\n{text}'), about)


def eigenvalues(M, C, K) -> np.ndarray:
    M, C, K = (np.array(x, dtype=float) for x in (M, C, K))
    n = len(M)
    A = np.block([[np.zeros((n, n)), np.eye(n)], [-np.linalg.solve(M, K), -np.linalg.solve(M, C)]])
    return np.linalg.eigvals(A)


def assert_same(found, expected, rel=1e-9) -> None:
    """The same eigenvalues in any order, each to its own size."""
    left = [complex(x) for x in expected]
    assert len(found) == len(left)
    for x in found:
        nearest = min(left, key=lambda y: abs(x - y))
        assert abs(x - nearest) <= rel * abs(x) + 1e-300
        left.remove(nearest)


def as_sympy(found):
    return sympy.sympify(to_text(found).replace("^", "**"))


def formula(text: str, found) -> bool:
    """Whether an exact scalar is the formula, in parameters that are positive."""
    mine, book = as_sympy(found), sympy.sympify(text)
    names = sorted(mine.free_symbols | book.free_symbols, key=str)
    values = {x: sympy.Rational(7 + 3 * k, 5) for k, x in enumerate(names)}
    return abs(sympy.N((mine - book).subs(values), 30)) < 1e-25


# -- sizes ---------------------------------------------------------------------------------------------------------

TWO_MASSES = """[coordinates]
x = 0
y = 0
[bodies.a]
shape = {{ kind = "particle", mass = 1 }}
joint = {{ kind = "prismatic", axis = [1, 0], displacement = "x", stiffness = {k}, damping = {c} }}
[bodies.b]
shape = {{ kind = "particle", mass = 1e-3 }}
joint = {{ kind = "prismatic", on = "a", axis = [1, 0], displacement = "y", stiffness = 1e9 }}
"""


def test_a_slow_motion_beside_a_stiff_one_is_not_taken_as_none():
    """lambda = -k/c = -1e-4 beside 1e6"""
    found = small(TWO_MASSES.format(k=1, c=1e4)).spectrum
    by_hand = eigenvalues([[1.001, 1e-3], [1e-3, 1e-3]], [[1e4, 0], [0, 0]], [[1, 0], [0, 1e9]])
    assert_same(found.eigenvalues, by_hand, 1e-6)
    assert found.stability == "asymptotically stable"
    found = small(TWO_MASSES.format(k=1e-3, c=0)).spectrum
    assert found.modes[0].frequency == pytest.approx(np.sqrt(1e-3 / 1.001), rel=1e-9) and found.stability == "stable"


def test_a_slow_flutter_beside_a_stiff_spring_is_seen():
    """x'' + x = p y, y'' + y = -p x: lambda^2 = -1 +- i p"""
    found = small("""[coordinates]
x = 0
y = 0
z = 0
[bodies.a]
joint = { kind = "prismatic", axis = [1, 0], displacement = "x", stiffness = 1, force = "0.05*y" }
[bodies.b]
shape = { kind = "particle", mass = 1 }
joint = { kind = "prismatic", on = "a", axis = [0, 1], displacement = "y", stiffness = 1, force = "-0.05*x" }
[bodies.c]
shape = { kind = "particle", mass = 1 }
joint = { kind = "prismatic", axis = [0, 1], displacement = "z", stiffness = 1e10 }
""").spectrum
    assert_same(found.eigenvalues, [s * np.sqrt(-1 + t * 0.05j) for s in (1, -1) for t in (1, -1)] + [1e5j, -1e5j])
    assert found.stability == "unstable"


def test_two_motions_that_have_become_one_are_not_called_stable():
    """x'' + x = y, y'' + y = 0: y = cos t makes x grow as t sin t"""
    found = small("""[coordinates]
x = 0
y = 0
[bodies.a]
joint = { kind = "prismatic", axis = [1, 0], displacement = "x", stiffness = 1, force = "y" }
[bodies.b]
shape = { kind = "particle", mass = 1 }
joint = { kind = "prismatic", on = "a", axis = [0, 1], displacement = "y", stiffness = 1 }
""").spectrum
    assert_same(found.eigenvalues, [1j, 1j, -1j, -1j])
    assert found.stability == "undecided" and "grow with the time" in found.why


def test_a_pendulum_of_micrometres_is_not_at_rest_where_it_is_not():
    """The torque m g l/2 sin(theta) = 4e-18 N m is no rounding"""
    text = """[coordinates]
theta = 1
[bodies.rod]
shape = { kind = "rod", mass = 1e-13, length = 1e-5 }
joint = { kind = "revolute", angle = "theta - pi/2" }
[forces.weight]
kind = "gravity"
acceleration = [0, -9.81]
"""
    with pytest.raises(eomgen.DerivationError, match="'theta'' is accelerated"):
        small(text, about="start")
    assert small(text).frequencies[0].mode.frequency == pytest.approx(np.sqrt(3 * 9.81 / 2e-5))


def test_a_top_of_micrometres_precesses_as_a_large_one():
    """(I_t - I_3) cos(theta) phi'^2 - I_3 psi' phi' + m g d = 0"""
    found = small("""[coordinates]
phi = {}
theta = 0.5
psi = { speed = 20000 }
[bodies.top]
mass = 1e-13
center = [0, 0, 4e-6]
inertia = [2.5e-23, 2.5e-23, 4e-23]
joint = { kind = "spherical", orientation = "zxz", angles = ["phi", "theta", "psi"] }
[forces.weight]
kind = "gravity"
acceleration = [0, 0, -9.81]
""", "space", "steady").as_dict()["state"]  # fmt: skip
    I_t, I_3 = 2.5e-23 + 1e-13 * 16e-12, 4e-23
    rates = np.roots([(I_t - I_3) * np.cos(0.5), -I_3 * 20000, 1e-13 * 9.81 * 4e-6])
    assert found["phi'"]["value"] == pytest.approx(min(rates, key=abs), rel=1e-10)


# -- what has no first order -----------------------------------------------------------------------------------------

SLIDER = """[parameters]
m = 1
k = 100
[coordinates]
x = 0
[bodies.b]
shape = {{ kind = "particle", mass = "m" }}
joint = {{ kind = "prismatic", axis = [1, 0], displacement = "x", {rest} }}
"""


@pytest.mark.parametrize("k", ["k*(1 + 0.1*cos(200*pi*t))", "k*(1 + max(0, t - 5))", "k*exp(-t)"])
def test_a_stiffness_that_changes_has_no_modes_at_whatever_rate(k):
    with pytest.raises(eomgen.DerivationError, match="change with time"):
        small(SLIDER.format(rest=f'stiffness = "{k}"'))


@pytest.mark.parametrize("force", ["-4*max(0, x) - min(0, x)", "-sign(x)", "-k*abs(x)", "-k*x - 3*abs(x')"])
def test_a_corner_of_a_force_is_named(force):
    with pytest.raises(eomgen.DerivationError, match="corner or a jump"):
        small(SLIDER.format(rest=f'force = "{force}"'))


def test_forces_that_are_smooth_to_first_order_have_one():
    """k x + c x' |x'|: no damping of first order; x^(1/3) has no slope at 0"""
    found = small(SLIDER.format(rest="force = \"-k*x - 5*x'*abs(x')\""))
    assert_same(found.spectrum.eigenvalues, [10j, -10j])
    with pytest.raises(eomgen.DerivationError, match="no value"):
        small(SLIDER.format(rest='force = "-k*x^(1/3)"'))


# -- gyroscopic ----------------------------------------------------------------------------------------------------

FOUCAULT = """[parameters]
W = { positive = true }
k = { positive = true }
m = { positive = true }
[coordinates]
theta = { motion = "W*t" }
x = 0
y = 0
[bodies.frame]
joint = { kind = "revolute", angle = "theta" }
[bodies.b]
shape = { kind = "particle", mass = "m" }
joint = { kind = "placed", on = "frame", at = ["x", "y"] }
[forces.spring]
kind = "potential"
energy = "(k + m*W^2)*(x^2 + y^2)/2"
"""


def test_roots_of_a_gyroscopic_pair_do_not_stand_in_one_another():
    """w = sqrt(k/m + W^2) -+ W; of a rotor J_t w^2 -+ J_p W w - k = 0"""
    low, high = (f.exact for f in small(FOUCAULT).frequencies)
    assert formula("sqrt(k/m + W**2) - W", low) and formula("sqrt(k/m + W**2) + W", high)
    assert to_text(low).count("sqrt") == 1
    rotor = small("""[parameters]
J_t = 0.02
J_p = 0.04
k = 50
W = 300
[coordinates]
a = 0
b = 0
phi = { speed = "W" }
[bodies.disc]
mass = 1
inertia = ["J_t", "J_t", "J_p"]
joint = { kind = "spherical", orientation = "xyz", angles = ["a", "b", "phi"] }
[forces.shaft]
kind = "potential"
energy = "k*(a^2 + b^2)/2"
""", "space", "start")  # fmt: skip
    low = rotor.frequencies[0]
    assert formula("(sqrt(J_p**2*W**2 + 4*J_t*k) - J_p*W)/(2*J_t)", low.exact)
    assert low.mode.frequency == pytest.approx(max(np.roots([0.02, 0.04 * 300, -50]).real))


LIBRATION = """[parameters]
mu = {mu}
m = 1
[coordinates]
theta = {{ motion = "t" }}
x = "1/2 - mu"
y = "sqrt(3)/2"
[bodies.frame]
joint = {{ kind = "revolute", angle = "theta" }}
points = {{ S = ["-mu", 0], J = ["1 - mu", 0] }}
[bodies.b]
shape = {{ kind = "particle", mass = "m" }}
joint = {{ kind = "placed", on = "frame", at = ["x", "y"] }}
[forces.sun]
kind = "between"
points = ["b.center", "frame.S"]
pull = "m*(1 - mu)/r^2"
[forces.planet]
kind = "between"
points = ["b.center", "frame.J"]
pull = "m*mu/r^2"
"""


@pytest.mark.parametrize(("mu", "stability"), [("0.01", "stable to first order"), ("0.05", "unstable")])
def test_the_triangular_points_are_stable_below_the_mass_ratio_of_routh(mu, stability):
    """s^4 + s^2 + 27/4 mu (1 - mu) = 0, stable where 1 - 27 mu (1 - mu) > 0"""
    found = small(LIBRATION.format(mu=mu))
    value = float(mu)
    assert_same(found.spectrum.eigenvalues, np.roots([1, 0, 1, 0, 27 / 4 * value * (1 - value)]), 1e-7)
    assert found.spectrum.stability == stability
    assert found.as_dict()["conditions_for"] == "oscillate"
    assert any(formula("1 - 27*mu*(1 - mu)", x) for x in found.modes.conditions.expressions)


def test_a_satellite_librates_in_the_gradient_of_gravity():
    """Pitch n sqrt(3 (I_x - I_z)/I_y) apart from roll and yaw, and its condition I_x > I_z apart from theirs

    Source: Hughes, Spacecraft Attitude Dynamics, chapter 9.
    """
    found = small("""[parameters]
I_x = 30
I_y = 40
I_z = 15
n = 0.0011
[coordinates]
nu = { motion = "n*t" }
roll = 0
pitch = 0
yaw = 0
[bodies.orbit]
joint = { kind = "revolute", axis = [0, -1, 0], angle = "nu" }
[bodies.satellite]
mass = 1
inertia = ["I_x", "I_y", "I_z"]
joint = { kind = "spherical", on = "orbit", orientation = "zyx", angles = ["yaw", "pitch", "roll"] }
[forces.gradient]
kind = "potential"
energy = "3/2*n^2*(I_x*sin(pitch)^2 + I_y*(cos(pitch)*sin(roll))^2 + I_z*(cos(pitch)*cos(roll))^2)"
""", "space")  # fmt: skip
    I_x, I_y, I_z, n = 30, 40, 15, 0.0011
    h = n * (I_x - I_y + I_z)
    K = [[4 * n * n * (I_y - I_z), 0], [0, n * n * (I_y - I_x)]]
    across = eigenvalues([[I_x, 0], [0, I_z]], [[0, -h], [h, 0]], K)
    pitch = 1j * n * np.sqrt(3 * (I_x - I_z) / I_y)
    assert_same(found.spectrum.eigenvalues, [*across, pitch, -pitch], 1e-8)
    assert any(formula("n**2*(I_x - I_z)", x) for x in found.modes.conditions.expressions)


@pytest.mark.parametrize(("W", "stable"), [(14.9, True), (15.1, False)])
def test_inner_damping_makes_a_shaft_whirl_beyond_its_critical_speed(W, stable):
    """Stable below sqrt(k/m) (1 + c_e/c_i) = 15; the conditions say the same

    Source: Genta, Dynamics of Rotating Systems, section 4.
    """
    found = small(f"""[parameters]
m = 1
k = 100
c_e = 0.5
c_i = 1
W = {W}
[coordinates]
x = 0
y = 0
[bodies.disc]
{PARTICLE}
joint = {{ kind = "free", x = "x", y = "y", angle = 0 }}
[forces.shaft]
kind = "force"
point = "disc.center"
force = ["-k*x - c_e*x' - c_i*(x' + W*y)", "-k*y - c_e*y' - c_i*(y' - W*x)"]
""")
    assert (found.spectrum.stability == "asymptotically stable") == stable
    values = {"m": 1, "k": 100, "c_e": Fraction(1, 2), "c_i": 1, "W": Fraction(str(W))}
    signs = [as_sympy(x).subs(values) > 0 for x in found.modes.conditions.expressions]
    assert all(signs) == stable
    assert found.as_dict()["circulatory"]["value"] == [[0, W], [-W, 0]]


# -- ties of velocity ------------------------------------------------------------------------------------------------


def test_a_trailing_wheel_shimmies_and_answers_a_force():
    """m_0 y'' + k y = lam + F, ..., y' - a theta' - v theta = 0: three eigenvalues, and y/F, of the pencil of 5 rows

    Source: Pacejka, Tyre and Vehicle Dynamics, section 6.2 (without the string's deflection).
    """
    m, M0, a, b, J, k, v = 10, 4, 0.1, 0.25, 0.3, 3000, 8
    found = small(f"""[inputs]
F = 0
[coordinates]
x = {{ motion = "{v}*t" }}
y = 0
theta = 0
[bodies.pin]
mass = {M0}
inertia = 1
joint = {{ kind = "placed", at = ["x", "y"] }}
[bodies.wheel]
mass = {m}
center = [-{b}, 0]
inertia = {J}
points = {{ contact = [-{a}, 0] }}
joint = {{ kind = "revolute", on = "pin", angle = "theta" }}
[constraints.tyre]
kind = "skate"
point = "wheel.contact"
along = [1, 0]
[forces.spring]
kind = "generalized"
coordinate = "y"
value = "-{k}*y + F"
""")
    import scipy.linalg

    E, A = np.zeros((5, 5)), np.zeros((5, 5))  # y, theta, y', theta', lam
    E[0, 0] = E[1, 1] = A[0, 2] = A[1, 3] = 1
    E[2, 2:4], E[3, 2:4] = (M0 + m, -m * b), (-m * b, J + m * b * b)
    A[2, 0], A[2, 4], A[3, 4], A[4, 1:4] = -k, 1, -a, (-v, 1, -a)
    values = scipy.linalg.eigvals(A, E)
    assert_same(found.spectrum.eigenvalues, values[np.isfinite(values) & (abs(values) < 1e6)], 1e-7)
    s = 0.3 + 0.7j
    answer = np.linalg.solve(s * E - A, [0, 0, 1, 0, 0])
    for f, expected in zip(found.modes.transfers, answer, strict=False):
        above, below = (sum(float(c) * s**n for n, c in enumerate(p.coefficients)) for p in (f.above, f.below))
        assert above / below == pytest.approx(expected, rel=1e-9)


def test_a_ball_rolls_in_a_bowl_in_every_direction():
    """w^2 = 5/7 g/(R - r), twice; its spin stays"""
    found = small("""[coordinates]
x = 0
y = 0
z = -0.9
e0 = 1
e1 = 0
e2 = 0
e3 = 0
[speeds]
w1 = {}
w2 = {}
w3 = {}
[bodies.ball]
shape = { kind = "sphere", mass = 1, radius = 0.1 }
[bodies.ball.joint]
kind = "free"
position = ["x", "y", "z"]
orientation = "quaternion"
quaternion = ["e0", "e1", "e2", "e3"]
omega = ["w1", "w2", "w3"]
[constraints.bowl]
kind = "rolling"
body = "ball"
circle = { at = [0, 0, 0], radius = 1, inside = true }
[forces.weight]
kind = "gravity"
acceleration = [0, 0, -9.81]
""", "space")  # fmt: skip
    w = np.sqrt(5 / 7 * 9.81 / 0.9)
    assert [f.mode.frequency for f in found.frequencies] == pytest.approx([w, w])
    assert sum(x == 0 for x in found.spectrum.eigenvalues) == 2


def test_rest_is_sought_beside_coordinates_that_wheels_leave_free():
    """From a lean of 0.05 the balancing robot's upright place: forces of the wheels balance along the floor"""
    text = (MODELS / "balancing_robot.toml").read_text()
    (line,) = [x for x in text.splitlines() if x.startswith("theta =")]
    leaning = eomgen.linearize(eomgen.loads(text.replace(line, "theta = { start = 0.05, near = 0 }")), "equilibrium")
    upright = eomgen.linearize(eomgen.loads(text), "equilibrium")
    assert leaning.as_dict()["state"]["theta"]["value"] == 0
    assert_same(leaning.spectrum.eigenvalues, upright.spectrum.eigenvalues)
    assert len(eomgen.statics(eomgen.load(MODELS / "chaplygin_sleigh.toml")).places) == 1


# -- asked ---------------------------------------------------------------------------------------------------------


def test_transfer_functions_stand_in_numbers_about_a_place_known_in_numbers():
    """W(s) = e_q^T (s - A)^-1 b"""
    found = small("""[inputs]
F = 0.3
[coordinates]
a = 0.4
b = 0
[bodies.i]
shape = { kind = "rod", mass = 1, length = 1 }
joint = { kind = "revolute", angle = "a - pi/2", torque = "F*cos(a)", damping = 0.1 }
[bodies.ii]
shape = { kind = "rod", mass = 1, length = 1 }
joint = { kind = "revolute", on = "i.end", angle = "b", stiffness = 2, rest = 0.3 }
[forces.weight]
kind = "gravity"
acceleration = [0, -9.81]
""")
    s = 0.2 - 1.3j
    answers = np.linalg.solve(s * np.eye(4) - found.A, found.B)
    assert not found.is_exact and len(found.modes.transfers) == 2
    for f, expected in zip(found.modes.transfers, answers, strict=False):
        above, below = (sum(c * s**n for n, c in enumerate(p.coefficients)) for p in (f.above, f.below))
        assert above / below == pytest.approx(expected[0], rel=1e-9)
    assert "W[a, F]" in found.render("text")


def test_a_coordinate_called_s_is_not_the_variable_of_laplace():
    text = """[parameters]
m = 1
k = 2
[inputs]
F = 0
[coordinates]
s = 0
[bodies.b]
shape = { kind = "particle", mass = "m" }
joint = { kind = "prismatic", axis = [1, 0], displacement = "s", stiffness = "k", force = "F" }
"""
    shown = small(text).render("text")
    assert "det(s_^2*M + s_*C + K) = m*s_^2 + k" in shown and "W[s, F] = 1/(m*s_^2 + k)" in shown
    twice = eomgen.linearize(eomgen.loads(f'eomgen = 1\nspace = "plane"\n{text}'), coordinates=["s", "s"])
    assert twice.coordinates == ("s",)
