"""Small motions of systems from textbooks, against matrices written by hand: stiff, tiny, gyroscopic, rolling."""

from fractions import Fraction
from pathlib import Path

import numpy as np
import pytest
import sympy
from slow_run import beside

import eomgen
from eomgen.symbolic.print.text import to_text

pytestmark = pytest.mark.slow

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
    found = small(
        """[coordinates]
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
""",
        "space",
        "steady",
    ).as_dict()["state"]
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


@pytest.mark.parametrize("force", ["cos(10*t)", "sin(10*t)", "3*t", "exp(-t)"])
def test_a_force_of_time_alone_leaves_the_modes_as_they_are(force):
    """m x'' + k x = f(t)"""
    found = small(SLIDER.format(rest=f'stiffness = "k", force = "{force}"'))
    assert_same(np.linalg.eigvals(found.A), [10j, -10j])
    assert found.certify().ok
    assert "stands on the right side" in " ".join(found.render().split())


def test_a_force_of_time_that_turns_with_a_body_has_no_modes():
    """F(t) across a pendulum: K = m g l + F(t) l sin(theta0), another at every instant."""
    text = """[parameters]
m = 1
g = 10
[coordinates]
theta = 0
[bodies.b]
shape = { kind = "rod", mass = "m", length = 1 }
joint = { kind = "revolute", angle = "theta - pi/2" }
[forces]
weight = { kind = "gravity", acceleration = [0, "-g"] }
push = { kind = "force", point = "b.end", force = ["2*cos(t)", 0] }
"""
    with pytest.raises(eomgen.DerivationError, match="change with time"):
        small(text)


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
    rotor = small(
        """[parameters]
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
""",
        "space",
        "start",
    )
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


@pytest.mark.parametrize(("mu", "stability"), [*beside(("0.01", "stable to first order")), ("0.05", "unstable")])
def test_the_triangular_points_are_stable_below_the_mass_ratio_of_routh(mu, stability):
    """s^4 + s^2 + 27/4 mu (1 - mu) = 0, stable where 1 - 27 mu (1 - mu) > 0

    Slow: places of rest between two centres of attraction are sought in many boxes, twice.
    """
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
    found = small(
        """[parameters]
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
""",
        "space",
    )
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


# -- constraints of velocity
# ------------------------------------------------------------------------------------------------


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
    found = small(
        """[coordinates]
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
""",
        "space",
    )
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


# -- families of steady motions --------------------------------------------------------------------------------------

GOVERNOR = """[parameters]
m = {m}
M = 3
l = 0.4
g = 9.81
W = {W}
[coordinates]
psi = {{ speed = "W" }}
a = {{ near = 0.9 }}
[bodies.shaft]
joint = {{ kind = "revolute", angle = "psi" }}
[bodies.b1]
shape = {{ kind = "particle", mass = "m" }}
joint = {{ kind = "placed", on = "shaft", at = ["l*sin(a)", 0, "-l*cos(a)"] }}
[bodies.b2]
shape = {{ kind = "particle", mass = "m" }}
joint = {{ kind = "placed", on = "shaft", at = ["-l*sin(a)", 0, "-l*cos(a)"] }}
[bodies.sleeve]
shape = {{ kind = "particle", mass = "M" }}
joint = {{ kind = "placed", on = "shaft", at = [0, 0, "-2*l*cos(a)"] }}
[forces.weight]
kind = "gravity"
acceleration = [0, 0, "-g"]
"""


def test_the_governor_of_watt_stands_at_its_angle_as_a_formula():
    """cos a = (m + M) g/(m l W^2); four motions in a turn; omega^2 of the free one by the momentum m l^2 sin^2 a W"""
    found = small(GOVERNOR.format(m=1, W=15), "space", "steady")
    data = found.as_dict()
    assert formula("acos(g*(m + M)/(l*m*W**2))", found.small.reference.exact[found.equations.coordinates[1]])
    assert data["family"]["held"] == ["psi'"] and data["family"]["complete"]
    a = np.arccos(4 * 9.81 / (0.4 * 225))
    angles = sorted(x["state"]["a"]["value"] for x in data["family"]["motions"])
    assert angles == pytest.approx([-a, 0, a, np.pi])
    inertia = 2 * 0.4**2 * (1 + 2 * 3 * np.sin(a) ** 2)
    stiffness = 2 * 0.4**2 * 225 * np.sin(a) ** 2 * (1 + 4 / np.tan(a) ** 2)
    assert found.frequencies[0].mode.frequency == pytest.approx(np.sqrt(stiffness / inertia))
    assert found.frequencies[0].exact is not None


def test_a_top_has_both_its_precessions_as_formulas():
    """(I_t - I_3) cos(theta) phi'^2 - I_3 psi' phi' + m g d = 0"""
    found = eomgen.linearize(eomgen.load(MODELS / "heavy_top.toml"), "steady")
    family = found.small.reference.family
    values = {"theta": np.pi / 6, "psi'": 250.0}
    rates = np.roots([2e-4 * np.cos(np.pi / 6), -5e-5 * 250, 0.1 * 9.81 * 0.04])
    assert [x.name for x in family.held] == list(values)
    assert sorted(x["phi'"] for x in ({n.name: v for n, v in at.items()} for at in family.others)) == pytest.approx(
        sorted(rates)
    )
    assert len(family.closed) == 2 and all(family.closed) and found.modes.beside == ("stable to first order",) * 2


def test_a_disc_rolls_in_a_circle_by_a_formula():
    """phi' = -5/6 W cos(theta) - 2/3 g cot(theta)/(r W); 5/4 theta'' = W^2 sin(2 theta)/8 - 3/2 W w sin(theta)
    - g/r cos(theta), with
    W' sin(theta) = 2 (w - W cos(theta)) theta', 3/2 w' = W sin(theta) theta'

    Source: O'Reilly, The dynamics of rolling disks and sliding disks, Nonlinear Dynamics 10 (1996) 287-305.
    """
    found = small(
        """[parameters]
m = 2
r = 0.3
g = 9.81
theta_0 = 1.3
W = 2
[coordinates]
x = {}
y = {}
z = { near = "r" }
psi = { speed = "W" }
theta = "theta_0"
phi = { near = 0, speed = -4 }
[bodies.disc]
shape = { kind = "disc", mass = "m", radius = "r" }
joint = { kind = "free", position = ["x", "y", "z"], orientation = "zxz", angles = ["psi", "theta", "phi"] }
[constraints.floor]
kind = "rolling"
body = "disc"
axis = [0, 0, 1]
plane = { at = [0, 0, 0], normal = [0, 0, 1] }
[forces.weight]
kind = "gravity"
acceleration = [0, 0, "-g"]
""",
        "space",
        "steady",
    )
    state = {x.name: value for x, value in found.small.reference.exact.items()}
    assert formula("-5*W*cos(theta_0)/6 - 2*g*cos(theta_0)/(3*r*W*sin(theta_0))", state["phi'"])
    assert formula("r*sin(theta_0)", state["z"])
    theta, W, r, g = 1.3, 2, 0.3, 9.81
    sine, cosine = np.sin(theta), np.cos(theta)
    spin = -2 / 3 * g * cosine / (r * W * sine) + W * cosine / 6
    dW, ds = 2 * (spin - W * cosine) / sine, 2 / 3 * W * sine  # with the lean, by the two integrals
    K = -(W**2) * np.cos(2 * theta) / 4 + 1.5 * W * spin * cosine - g / r * sine
    K += (-0.5 * W * sine * cosine + 1.5 * spin * sine) * dW + 1.5 * W * sine * ds
    assert found.frequencies[0].mode.frequency == pytest.approx(np.sqrt(K / 1.25), rel=1e-9)
    assert found.frequencies[0].exact is not None


def test_of_a_family_as_few_values_change_as_the_equations_need():
    """A conical pendulum with angle and rate stated: one of both stays; cos(theta) psi'^2 = g/l"""
    found = small(
        """[parameters]
l = 1
g = 9.81
[coordinates]
psi = { speed = 3 }
theta = 0.5
[bodies.bob]
shape = { kind = "particle", mass = 1 }
joint = { kind = "placed", at = ["l*sin(theta)*cos(psi)", "l*sin(theta)*sin(psi)", "-l*cos(theta)"] }
[forces.weight]
kind = "gravity"
acceleration = [0, 0, "-g"]
""",
        "space",
        "steady",
    )
    state = {name: x["value"] for name, x in found.as_dict()["state"].items()}
    assert np.cos(state["theta"]) * state["psi'"] ** 2 == pytest.approx(9.81)
    assert (state["theta"] == 0.5) != (state["psi'"] == 3) and found.is_exact


def _rattleback_rates(y: np.ndarray) -> np.ndarray:
    """(gamma', w') of a half ellipsoid that rolls: gamma the vertical, w, both in body axes; no-slip v = -w x r."""
    m, g, squares = 1, 9.81, np.array([0.2, 0.03, 0.02]) ** 2
    inertia = np.array([[0.0002, -0.00002, 0], [-0.00002, 0.0016, 0], [0, 0, 0.0017]])
    up, w = y[:3], y[3:]
    turned = np.cross(up, w)
    size = np.sqrt(up @ (squares * up))
    r = -squares * up / size + np.array([0, 0, 0.01])
    moved = -squares * turned / size + squares * up * (up @ (squares * turned)) / size**3
    v = -np.cross(w, r)
    cross = np.array([[0, -r[2], r[1]], [r[2], 0, -r[0]], [-r[1], r[0], 0]])
    push = m * (-np.cross(w, moved) + np.cross(w, v) + g * up)  # F = push + m r x w'
    right = np.cross(r, push) - np.cross(w, inertia @ w)
    return np.array([*turned, *np.linalg.solve(inertia - m * cross @ cross, right)])


@pytest.mark.parametrize("spin", [-12, 12])
def test_a_rattleback_is_unstable_in_one_sense_of_its_spin(spin):
    """Upright spin, against the slopes of the equations of Euler in plain numbers"""
    text = (MODELS / "rattleback.toml").read_text()
    for old, new in (("{ start = 0.01 }", "{}"), ("{ start = -0.02 }", "{}"), ("start = -2", f"start = {spin}")):
        text = text.replace(old, new)
    found = eomgen.linearize(eomgen.loads(text), "start").spectrum
    at = np.array([0, 0, 1, 0, 0, spin])
    steps = 1e-5 * np.eye(6)
    A = np.array([(_rattleback_rates(at + d) - _rattleback_rates(at - d)) / 2e-5 for d in steps]).T
    mine = sorted((x for x in found.eigenvalues if abs(x) > 1e-3), key=lambda x: (x.real, x.imag))
    book = sorted((x for x in np.linalg.eigvals(A) if abs(x) > 1e-3), key=lambda x: (x.real, x.imag))
    assert np.allclose(mine, book, rtol=1e-6) and found.stability == "unstable"


def test_all_places_of_a_bead_on_a_driven_hoop():
    """theta = 0, pi, and +-acos(g/(R omega^2)) beyond omega^2 = g/R, where the lowest place has become unstable"""
    found = eomgen.linearize(eomgen.load(MODELS / "bead_on_turning_hoop.toml"), "equilibrium").as_dict()["family"]
    places = {x["state"]["theta"]["exact"]: x["stability"] for x in found["motions"]}
    aside = "acos(g/(omega^2*R))"
    assert places == {"0": "unstable", aside: "stable", f"-{aside}": "stable", "pi": "unstable"} and found["complete"]


def test_a_car_turns_steadily_by_its_understeer():
    """r = V d/(L + K V^2), K = m (b C_r - a C_f)/(L C_f C_r), and the two eigenvalues of the bicycle model

    Source: Pacejka, Tyre and Vehicle Dynamics, section 1.3.
    """
    m, J, a, b, C_f, C_r, V, d = 1500, 2500, 1.1, 1.6, 55000, 60000, 25, 0.02
    found = small(
        f"""[parameters]
V = {V}
[coordinates]
x = {{}}
y = {{}}
psi = {{}}
[speeds]
u = {{ rate = "x'*cos(psi) + y'*sin(psi)", start = "V" }}
v = {{ rate = "-x'*sin(psi) + y'*cos(psi)" }}
r = {{ rate = "psi'" }}
[bodies.car]
mass = {m}
inertia = {J}
points = {{ F = [{a}, 0], R = [-{b}, 0] }}
joint = {{ kind = "planar", x = "x", y = "y", angle = "psi" }}
[constraints.cruise]
kind = "equation"
rate = "u - V"
[forces.front]
kind = "force"
point = "car.F"
axes = "car"
force = [0, "{C_f}*({d} - (v + {a}*r)/V)"]
[forces.rear]
kind = "force"
point = "car.R"
axes = "car"
force = [0, "-{C_r}*(v - {b}*r)/V"]
""",
        about="steady",
    )
    state = found.as_dict()["state"]
    K = m * (b * C_r - a * C_f) / ((a + b) * C_f * C_r)
    assert state["r"]["value"] == pytest.approx(V * d / (a + b + K * V * V)) and state["r"]["exact"]
    A = -np.array(
        [
            [(C_f + C_r) / (m * V), V + (a * C_f - b * C_r) / (m * V)],
            [(a * C_f - b * C_r) / (J * V), (a * a * C_f + b * b * C_r) / (J * V)],
        ]
    )
    assert_same(found.spectrum.eigenvalues, [*np.linalg.eigvals(A), 0])


def test_two_masses_on_a_rod_in_orbit_librate_by_the_root_of_three():
    """n' = n sqrt(3) beside n of the orbit itself, of a rod much shorter than its orbit; metres beside 7000 km"""
    n = 0.0011
    found = small(
        f"""[coordinates]
nu = {{ speed = {n} }}
r = {{ near = 7e6 }}
th = 0
[bodies.orbit]
joint = {{ kind = "revolute", angle = "nu" }}
[bodies.hub]
joint = {{ kind = "placed", on = "orbit", at = ["r", 0], angle = "th" }}
[bodies.a]
shape = {{ kind = "particle", mass = 100 }}
joint = {{ kind = "placed", on = "hub", at = [50, 0] }}
[bodies.b]
shape = {{ kind = "particle", mass = 100 }}
joint = {{ kind = "placed", on = "hub", at = [-50, 0] }}
[points]
E = [0, 0]
[forces.a]
kind = "between"
points = ["E", "a.center"]
pull = "4e16/r^2"
[forces.b]
kind = "between"
points = ["E", "b.center"]
pull = "4e16/r^2"
""",
        about="steady",
    )
    assert found.as_dict()["state"]["r"]["value"] == pytest.approx((4e14 / n**2) ** (1 / 3), rel=1e-9)
    assert [f.mode.frequency for f in found.frequencies] == pytest.approx([n, n * np.sqrt(3)], rel=1e-7)


ROLLING_TORUS = """[parameters]
m = 1
r = 0.4
a = 0.1
g = 9.81
V = 3
A = 0.05
J = 0.09
[coordinates]
x = 0
y = 0
z = { near = 0.5 }
yaw = 0
lean = 0
spin = { speed = "V/(r + a)" }
[bodies.w]
mass = "m"
inertia = ["A", "J", "A"]
joint = { kind = "free", position = ["x", "y", "z"], orientation = "zxy", angles = ["yaw", "lean", "spin"] }
[constraints.road]
kind = "rolling"
body = "w"
axis = [0, 1, 0]
radius = "r"
tube = "a"
plane = { at = [0, 0, 0], normal = [0, 0, 1] }
[forces.g]
kind = "gravity"
acceleration = [0, 0, "-g"]
"""


def test_a_wheel_with_a_tyre_rolls_upright_by_a_formula():
    """(A + m R^2) w^2 = (J + m R^2) J W^2/A - m g r, R = r + a, W = V/R: what the constraints say of speeds is exact"""
    found = small(ROLLING_TORUS, "space", "start")
    book = "sqrt(((J + m*(r + a)**2)*J*V**2/(A*(r + a)**2) - m*g*r)/(A + m*(r + a)**2))"
    assert formula(book, found.frequencies[0].exact)


def test_numbers_at_values_that_nobody_gave_are_refused():
    """cos(theta) has no root in closed form, and W no value"""
    text = """[parameters]
W = {}
[coordinates]
psi = { speed = "W" }
theta = { near = 1 }
[bodies.bob]
shape = { kind = "particle", mass = 1 }
joint = { kind = "placed", at = ["sin(theta)*cos(psi)", "sin(theta)*sin(psi)", "-cos(theta) - theta^3/9"] }
[forces.weight]
kind = "gravity"
acceleration = [0, 0, -9.81]
"""
    with pytest.raises(eomgen.DerivationError, match="no closed form: 'W' need values"):
        small(text, "space", "steady")


def test_the_governed_engine_of_vyshnegradskii():
    """cos(phi) = F/k, w^2 = g k/F; it settles where b J/m > 2 F/w

    Source: Pontryagin, Ordinary Differential Equations, section 27.
    """
    g, F, k, m, J = 9.81, 10, 30, 1, 4
    critical = 2 * F * m / (J * np.sqrt(g * k / F))
    for b, stability in ((0.99 * critical, "unstable"), (1.01 * critical, "stable to first order")):
        found = small(
            f"""[parameters]
b = {float(b)}
F = {F}
k = {k}
g = {g}
[coordinates]
psi = {{}}
phi = {{ near = 1 }}
[speeds]
w = {{ rate = "psi'", start = 5 }}
[bodies.engine]
mass = 1
inertia = [3, 3, {J}]
joint = {{ kind = "revolute", angle = "psi", torque = "k*cos(phi) - F" }}
[forces.a]
kind = "generalized"
coordinate = "phi"
value = "{m}*(w^2*sin(phi)*cos(phi) - g*sin(phi)) - b*phi'"
[bodies.b]
mass = {m}
joint = {{ kind = "prismatic", axis = [1, 0, 0], displacement = "phi", at = [10, 0, 0] }}
""",
            "space",
            "steady",
        )
        state = {x.name: value for x, value in found.small.reference.exact.items()}
        assert formula("acos(F/k)", state["phi"]) and formula("sqrt(g*k/F)", state["w"])
        assert found.spectrum.stability == stability
        assert len(found.small.reference.family.others) == 4


def test_a_spinning_satellite_leans_in_its_orbit():
    """The conical equilibria: cos a = C s'/((A - C) n), and the two upright places, by b = 0

    Source: Likins, Stability of a symmetrical satellite in attitudes fixed in an orbiting reference frame,
    J. Astronautical Sciences 12 (1965).
    """
    found = small(
        """[parameters]
A = 10
C = 14
n = 0.001
[coordinates]
nu = { motion = "n*t" }
a = { near = 1.2 }
b = 0
s = { speed = -0.0001 }
[bodies.orbit]
joint = { kind = "revolute", angle = "nu" }
[bodies.sat]
mass = 1
inertia = ["A", "A", "C"]
joint = { kind = "spherical", on = "orbit", orientation = "xyz", angles = ["a", "b", "s"] }
[forces.gradient]
kind = "potential"
energy = "3/2*n^2*(C - A)*sin(b)^2"
""",
        "space",
        "steady",
    )
    family = found.as_dict()["family"]
    a = np.arccos(14 * -0.0001 / (-4 * 0.001))
    assert sorted(x["state"]["a"]["value"] for x in family["motions"]) == pytest.approx([-a, 0, a, np.pi])
    assert family["held"] == ["b", "s'"] and family["formulas"] and found.is_exact
    A, C, n, s = 10, 14, 0.001, -0.0001  # to second order of Routh's function: h stays
    h = C * (s + n * np.cos(a))
    K = [
        [h * n * np.cos(a) - A * n**2 * np.cos(2 * a), 0],
        [0, h * n * np.cos(a) - A * n**2 * np.cos(a) ** 2 + 3 * n**2 * (C - A)],
    ]
    G = h - 2 * A * n * np.cos(a)
    across = eigenvalues([[A, 0], [0, A]], [[0, G], [-G, 0]], K)
    assert_same([x for x in found.spectrum.eigenvalues if x], across, 1e-6)


def test_transfer_functions_are_without_common_factors():
    """x/F = (l s^2 + g)/(s^2 (M l s^2 + (M + m) g)) of a gantry crane, whatever its load's m l"""
    found = small("""[parameters]
M = 5
m = 2
l = 1.5
g = 9.81
[inputs]
F = 0
[coordinates]
x = 0
th = 0
[bodies.trolley]
mass = "M"
joint = { kind = "prismatic", axis = [1, 0], displacement = "x", force = "F" }
[bodies.load]
shape = { kind = "particle", mass = "m" }
joint = { kind = "placed", on = "trolley", at = ["l*sin(th)", "-l*cos(th)"] }
[forces.weight]
kind = "gravity"
acceleration = [0, "-g"]
""").render("text")
    assert "W[x, F] = (l*s^2 + g)/(M*l*s^4 + (M + m)*g*s^2)" in found
    assert "W[th, F] = -1/(M*l*s^2 + (M + m)*g)" in found


def test_a_planet_circles_at_the_radius_of_kepler():
    """r^3 = mu/n^2, without values of mu and n; beside it r swings with n"""
    found = small(
        """[parameters]
mu = { positive = true }
m = 1
n = { positive = true }
[coordinates]
th = { speed = "n" }
r = { near = 1 }
[bodies.p]
shape = { kind = "particle", mass = "m" }
joint = { kind = "placed", at = ["r*cos(th)", "r*sin(th)"] }
[points]
O = [0, 0]
[forces.sun]
kind = "between"
points = ["O", "p.center"]
pull = "mu*m/r^2"
""",
        about="steady",
    )
    radius = {x.name: value for x, value in found.small.reference.exact.items()}["r"]
    assert formula("(mu/n**2)**(1/3)", radius)
    assert formula("n", found.frequencies[0].exact)


def test_a_sleigh_that_turns_is_steady_where_it_stops_turning():
    """m a w^2 = 0 has a double root, to which Newton's method goes by halves"""
    state = eomgen.linearize(eomgen.load(MODELS / "chaplygin_sleigh.toml"), "steady").as_dict()["state"]
    assert state["omega"]["value"] == 0


def test_dependent_coordinates_are_left_out_before_those_with_a_declared_speed():
    """x, y of a skate follow from its turning, whose speed is w = 2 theta'"""
    found = small("""[coordinates]
x = { dependent = true }
y = { dependent = true }
theta = 0.3
phi = 0.5
[speeds]
w = { rate = "2*theta'" }
[bodies.board]
mass = 2
inertia = 1
points = { edge = [0.5, 0], other = [-0.5, 0] }
joint = { kind = "planar", x = "x", y = "y", angle = "theta" }
[bodies.truck]
mass = 1
inertia = 0.5
joint = { kind = "revolute", on = "board.edge", angle = "phi" }
[constraints.front]
kind = "skate"
point = "truck.origin"
along = [1, 0]
[constraints.back]
kind = "skate"
point = "board.other"
along = [1, 1]
""")
    assert found.coordinates == ("theta", "phi") and [q.name for q in found.small.left_out] == ["x", "y"]
