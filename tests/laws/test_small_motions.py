"""Small motions: the equations to first order about an equilibrium or a steady motion, against what is known."""

from __future__ import annotations

import math
from functools import cache
from typing import Any

import mpmath
import numpy as np
import pytest
from known_answers import MODELS
from scipy.optimize import brentq

import eomgen
from eomgen.mechanics.linearization.linearization import SmallMotions
from eomgen.symbolic.expression.derivatives import derivative, substituted
from eomgen.symbolic.expression.text import parse
from eomgen.symbolic.numeric.evaluation import evaluate, fifty_digits
from eomgen.symbolic.print.text import text_size, to_text

pytestmark = pytest.mark.slow

HEAD = 'eomgen = 1\nname = "small"\nspace = "plane"\n'
WEIGHT = '[forces.weight]\nkind = "gravity"\nacceleration = [0, "-g"]\n'


@cache
def linearized(text: str, *about: str) -> eomgen.Linearization:
    return eomgen.linearize(eomgen.loads(HEAD + text), *about)


def nonzero(values: Any) -> np.ndarray:
    """The eigenvalues that are not 0, in order."""
    values = np.asarray(values, dtype=complex)
    kept = values[abs(values) > 1e-5 * max(abs(values).max(initial=0), 1e-300)]
    return np.array(sorted(kept, key=lambda x: (round(x.real, 7), round(x.imag, 7))))


def own_state_matrix(small: SmallMotions) -> np.ndarray:
    """d(q', a)/d(q, u) of the model's own equations, M a = forcing + J^T lam, by differences of 1e-20 at 50 digits."""
    equations = eomgen.derive(small.reference.system.scope.model)
    graph, symbols = equations.graph, equations.graph.symbols
    named = {x.name: value for x, value in small.reference.numbers.items()}
    x0 = [named[x.name] for x in symbols.x]
    others = {x: named[x.name] for x in (symbols.t, *symbols.parameters.values(), *symbols.inputs.values())}
    n, k = len(symbols.u), len(graph.J)
    wanted = (
        *equations.system.scope.rates,
        *(x for row in graph.M for x in row),
        *(x for row in graph.J for x in row),
        *graph.forcing,
        *graph.gamma,
    )

    def f(x: list[Any]) -> list[Any]:
        state = {**others, **dict(zip(symbols.x, x, strict=True))}
        flat = iter(evaluate(wanted, state, fifty_digits()))
        rates = [next(flat) for _ in symbols.q]
        M = [[next(flat) for _ in range(n)] for _ in range(n)]
        J = [[next(flat) for _ in range(n)] for _ in range(k)]
        right = [next(flat) for _ in range(n)] + [-next(flat) for _ in range(k)]
        A = [[*M[i], *(-J[m][i] for m in range(k))] for i in range(n)]
        A += [[*J[m], *[mpmath.mpf(0)] * k] for m in range(k)]
        a = mpmath.lu_solve(mpmath.matrix(A), mpmath.matrix(right))
        return [*rates, *list(a)[:n]]

    with mpmath.workdps(50):
        h = mpmath.mpf(10) ** -20
        columns = []
        for j in range(len(x0)):
            up, down = ([x + s * h * (i == j) for i, x in enumerate(x0)] for s in (1, -1))
            columns.append([float((a - b) / (2 * h)) for a, b in zip(f(up), f(down), strict=True)])
    return np.array(columns).T


def assert_same_eigenvalues(small: SmallMotions, tolerance: float = 1e-7) -> None:
    ours, own = nonzero(np.linalg.eigvals(small.state_matrix)), nonzero(np.linalg.eigvals(own_state_matrix(small)))
    assert len(ours) == len(own), (ours, own)
    assert np.allclose(ours, own, rtol=tolerance, atol=tolerance * abs(own).max()), (ours, own)


def is_formula(found: Any, text: str, small: SmallMotions) -> bool:
    """Whether a scalar of the parameters is the formula."""
    scope = small.reference.system.scope
    expected = parse(text).evaluate(scope.names, lambda call: pytest.fail(str(call)))
    values = small.reference.trial
    a, b = evaluate((found, expected), values, fifty_digits())
    shaken = {x: v * fifty_digits().number(k + 7) / 9 for k, (x, v) in enumerate(values.items())}
    c, d = evaluate((found, expected), shaken, fifty_digits())
    return abs(a - b) < 1e-30 * (1 + abs(b)) and abs(c - d) < 1e-30 * (1 + abs(d))


# -- equilibria --------------------------------------------------------------------------------------------


def pendulums(n: int) -> str:
    """n equal mathematical pendulums below one another."""
    q = [f"q{i}" for i in range(1, n + 1)]
    bodies = "".join(
        f'[bodies.b{i}]\nmass = "m"\ncenter = ["l", 0]\ninertia = 0\npoints = {{ end = ["l", 0] }}\n'
        f'joint = {{ kind = "revolute", {"on = " + chr(34) + f"b{i - 1}.end" + chr(34) + ", " if i > 1 else ""}'
        f'angle = "q{i}{" - q" + str(i - 1) if i > 1 else " - pi/2"}" }}\n'
        for i in range(1, n + 1)
    )
    coordinates = "".join(f"{x} = {{ start = 0.1, near = 0 }}\n" for x in q)
    return f"[parameters]\nm = 2\nl = 0.7\ng = 9.81\n[coordinates]\n{coordinates}{bodies}{WEIGHT}"


def test_a_double_pendulum_has_its_two_exact_frequencies():
    """w^2 = (2 -+ sqrt(2)) g/l"""
    found = linearized(pendulums(2))
    for frequency, text in zip(found.frequencies, ("2 - sqrt(2)", "2 + sqrt(2)"), strict=True):
        assert frequency.exact is not None
        assert is_formula(frequency.exact * frequency.exact, f"({text})*g/l", found.small)
    assert_same_eigenvalues(found.small)


def test_a_triple_pendulum_has_the_roots_of_a_laguerre_polynomial():
    """w^2 l/g are the roots of L_3(x): 6 - 18 x + 9 x^2 - x^3 = 0"""
    found = linearized(pendulums(3))
    roots = sorted(np.roots([-1, 9, -18, 6]).real)
    assert [f.mode.frequency for f in found.frequencies] == pytest.approx([math.sqrt(x * 9.81 / 0.7) for x in roots])


def chain(n: int) -> str:
    """n equal masses on a line between two walls, springs between them."""
    bodies, forces = "", ""
    for i in range(1, n + 1):
        joint = f'{{ kind = "prismatic", axis = [1, 0], displacement = "{i} + x{i}" }}'
        bodies += f'[bodies.b{i}]\nmass = "m"\njoint = {joint}\n'
    for i in range(n + 1):
        ends = [f"b{j}.origin" if 1 <= j <= n else ("left" if j == 0 else "right") for j in (i, i + 1)]
        forces += f'[forces.s{i}]\nkind = "spring"\npoints = {ends}\nstiffness = "k"\nlength = 1\nalong = [1, 0]\n'
    coordinates = "".join(f"x{i} = 0\n" for i in range(1, n + 1))
    walls = f"[points]\nleft = [0, 0]\nright = [{n + 1}, 0]\n"
    return f"[parameters]\nm = 2\nk = 30\n[coordinates]\n{coordinates}{walls}{bodies}{forces}".replace("'", '"')


@pytest.mark.parametrize("n", [1, 3, 12])
def test_a_chain_of_springs_follows_the_law_of_sines(n):
    """w_j = 2 sqrt(k/m) sin(j pi/(2 (n + 1))), shape sin(i j pi/(n + 1))"""
    found = linearized(chain(n))
    expected = [2 * math.sqrt(15) * math.sin(j * math.pi / (2 * (n + 1))) for j in range(1, n + 1)]
    assert [f.mode.frequency for f in found.frequencies] == pytest.approx(expected, rel=1e-12)
    for j, mode in enumerate(found.spectrum.modes, start=1):
        sines = np.array([math.sin(i * j * math.pi / (n + 1)) for i in range(1, n + 1)])
        shape = np.array([x.real for x in mode.shape.values()])
        assert abs(abs(sines @ shape) - np.linalg.norm(sines) * np.linalg.norm(shape)) < 1e-9


def test_three_masses_of_a_chain_are_exact():
    """The cubic splits: w^2 = 2 k/m, (2 -+ sqrt(2)) k/m"""
    found = linearized(chain(3))
    for f, text in zip(found.frequencies, ("2 - sqrt(2)", "2", "2 + sqrt(2)"), strict=True):
        assert is_formula(f.exact * f.exact, f"({text})*k/m", found.small)


INVERTED = f"""[parameters]
m = 1.5
l = 0.8
g = 9.81
k = 40
c = 0.3
h = 2
[coordinates]
theta = {{ start = 0.05, near = 0 }}
[points]
O = [0, 0]
P = [0, "h"]
[bodies.rod]
shape = {{ kind = "rod", mass = "m", length = "l" }}
joint = {{ kind = "revolute", angle = "theta + pi/2", damping = "c" }}
[forces.spring]
kind = "spring"
points = ["P", "rod.end"]
stiffness = "k"
length = "h - l - 1/10"
{WEIGHT}"""


def test_a_vertical_spring_holds_an_upright_rod_by_its_tension():
    """K = T h l/(h - l) - m g l/2, T = k/10 the tension of a spring of length h - l at rest: the geometric stiffness"""
    found = linearized(INVERTED)
    ((K,),) = found.equations.K
    assert is_formula(K, "k/10*h*l/(h - l) - m*g*l/2", found.small)
    assert_same_eigenvalues(found.small)


def test_a_damped_oscillator_has_its_frequency_ratio_and_condition():
    """x'' + 2 zeta w x' + w^2 x = 0: Im lambda = sqrt(k/m - c^2/(4 m^2)); stable where c > 0 and k > 0"""
    text = """[parameters]
m = {}
k = {}
c = {}
[coordinates]
x = 0
[inputs]
F = 0
[bodies.b]
mass = "m"
joint = { kind = "prismatic", axis = [1, 0], displacement = "x", stiffness = "k", damping = "c", force = "F" }
"""
    values = text.replace("m = {}", "m = 2").replace("k = {}", "k = 50").replace("c = {}", "c = 3")
    found = linearized(values)
    (frequency,) = found.frequencies
    assert is_formula(frequency.exact, "sqrt(k/m - c^2/(4*m^2))", found.small)
    assert frequency.mode.damping_ratio == pytest.approx(3 / (2 * math.sqrt(100)))
    assert found.spectrum.stability == "asymptotically stable"
    symbolic = linearized(text)
    assert [to_text(x) for x in symbolic.modes.conditions.expressions] == ["k", "c"]
    (transfer,) = symbolic.modes.transfers
    assert [to_text(x) for x in transfer.below.coefficients] == ["k", "c", "m"]
    assert found.B.ravel() == pytest.approx([0, 1 / 2])
    with pytest.raises(eomgen.DerivationError, match="values of all parameters"):
        _ = symbolic.A


FOLLOWER = """[parameters]
m = 1
l = 1
k = 1
P = 1
[coordinates]
q1 = 0
q2 = 0
[bodies.one]
mass = "2*m"
center = ["l", 0]
inertia = 0
points = { end = ["l", 0] }
joint = { kind = "revolute", angle = "q1 + pi/2", stiffness = "k", rest = "pi/2" }
[bodies.two]
mass = "m"
center = ["l", 0]
inertia = 0
points = { end = ["l", 0] }
joint = { kind = "revolute", on = "one.end", angle = "q2 - q1", stiffness = "k" }
[forces.follower]
kind = "force"
point = "two.end"
axes = "two"
force = ["-P", 0]
"""


@pytest.mark.parametrize(("load", "stability"), [(2.0, "stable to first order"), (2.2, "unstable")])
def test_a_column_under_a_follower_force_flutters_beyond_its_critical_load(load, stability):
    """Ziegler's column with masses 2 m and m: P_cr = (7/2 - sqrt(2)) k/l = 2.086 k/l; K is not symmetric"""
    found = linearized(FOLLOWER.replace("P = 1", f"P = {load}"))
    assert found.spectrum.stability == stability
    assert ("flutter" in found.spectrum.why) == (load > 2.086)
    H = found.modes.symmetric_parts["H"]
    assert is_formula(H[0][1], "P*l/2", found.small) or is_formula(H[1][0], "P*l/2", found.small)
    assert_same_eigenvalues(found.small)


# -- constraints ------------------------------------------------------------------------------------------------------

FOUR_BAR = """[parameters]
m = 1.1
g = 9.81
[coordinates]
alpha = {{ start = -1.2, near = -1.2 }}
beta = {{ start = 0.0, near = 0.0 {0} }}
gamma = {{ start = -1.2, near = -1.2 {0} }}
[bodies.crank]
shape = {{ kind = "rod", mass = "m", length = 1 }}
joint = {{ kind = "revolute", angle = "alpha" }}
[bodies.coupler]
shape = {{ kind = "rod", mass = "2*m", length = 2 }}
joint = {{ kind = "revolute", on = "crank.end", angle = "beta - alpha" }}
[bodies.rocker]
shape = {{ kind = "rod", mass = "m", length = "7/5" }}
joint = {{ kind = "revolute", at = [2.2, 0], angle = "gamma" }}
[constraints.close]
kind = "pin"
points = ["coupler.end", "rocker.end"]
[forces.weight]
kind = "gravity"
acceleration = [0, "-g"]
[forces.damp]
kind = "torsion_damper"
bodies = ["crank", "coupler"]
damping = 0.4
"""


def test_a_four_bar_moves_alike_with_multipliers_and_with_dependent_coordinates():
    """M, C and K along the constraints do not depend on how these are taken out; nor do the shapes."""
    free, bound = (linearized(FOUR_BAR.format(x)) for x in ("", ", dependent = true"))
    assert free.coordinates == bound.coordinates == ("alpha",)
    for letter in "MCK":
        assert getattr(free, letter) == pytest.approx(getattr(bound, letter), rel=1e-9)
    (one,), (other,) = free.spectrum.modes, bound.spectrum.modes
    for x, y in zip(one.shape.values(), other.shape.values(), strict=True):
        assert x == pytest.approx(y, abs=1e-9)
    assert_same_eigenvalues(free.small)
    other = linearized(FOUR_BAR.format(""), "equilibrium", ("gamma",))
    assert other.coordinates == ("gamma",)
    assert nonzero(other.spectrum.eigenvalues) == pytest.approx(nonzero(free.spectrum.eigenvalues), rel=1e-9)


THREE_CRANKS = """[parameters]
m = 1.0
g = 9.81
[coordinates]
a = { start = -1.5, near = -1.5 }
b = { start = 0, near = 0 }
c = { start = -1.5, near = -1.5 }
d = { start = -1.5, near = -1.5 }
[bodies.A]
shape = { kind = "rod", mass = "m", length = 1 }
joint = { kind = "revolute", angle = "a" }
[bodies.B]
shape = { kind = "rod", mass = "m", length = 2 }
joint = { kind = "revolute", on = "A.end", angle = "b - a" }
[bodies.C]
shape = { kind = "rod", mass = "m", length = 1 }
joint = { kind = "revolute", at = [2, 0], angle = "c" }
[bodies.D]
shape = { kind = "rod", mass = "m", length = 1 }
joint = { kind = "revolute", at = [1, 0], angle = "d" }
[constraints.p]
kind = "pin"
points = ["B.end", "C.end"]
[constraints.r]
kind = "pin"
points = ["B.center", "D.end"]
[forces.w]
kind = "gravity"
acceleration = [0, "-g"]
"""


def test_a_redundant_crank_changes_nothing_but_the_masses():
    """Three parallel cranks and a coupler, one hinge too many: M = 3 m/3 + m, K = 3 m g/2 + m g"""
    found = linearized(THREE_CRANKS)
    ((M,),), ((K,),) = found.equations.M, found.equations.K
    assert is_formula(M, "2*m", found.small) and is_formula(K, "5/2*m*g", found.small)


def test_a_disc_rolls_in_a_bowl_as_a_pendulum_of_three_halves():
    """w^2 = 2 g/(3 (R - r)): with the no-slip row by a multiplier, and with the angle of the disc dependent"""
    text = """[parameters]
m = 2
r = 0.1
R = 0.6
g = 9.81
[coordinates]
phi = { start = 0.1, near = 0 }
psi = { start = 0 DEP }
[bodies.arm]
joint = { kind = "revolute", angle = "phi - pi/2" }
points = { end = ["R - r", 0] }
[bodies.disc]
shape = { kind = "disc", mass = "m", radius = "r" }
joint = { kind = "revolute", on = "arm.end", angle = "psi - phi" }
[constraints.roll]
kind = "equation"
rate = "(R - r)*phi' + r*psi'"
[forces.weight]
kind = "gravity"
acceleration = [0, "-g"]
"""
    for dependent in ("", ", dependent = true"):
        found = linearized(text.replace(" DEP", dependent))
        (frequency,) = found.frequencies
        assert is_formula(frequency.exact * frequency.exact, "2*g/(3*(R - r))", found.small)
        shape = {q.name: x for q, x in frequency.mode.shape.items()}
        assert shape["phi"] / shape["psi"] == pytest.approx(-0.1 / 0.5)


# -- steady motions --------------------------------------------------------------------------------------------

ROTATING = """[parameters]
m = 0.5
l = 0.4
g = 9.81
theta_0 = {{ value = 60, unit = "deg" }}
[coordinates]
psi = {0}
theta = {{ start = "theta_0" }}
[bodies.frame]
inertia = [0, 0, {1}]
mass = 0
joint = {{ kind = "revolute", axis = [0, 0, 1], angle = "psi" }}
[bodies.bob]
mass = "m"
center = [0, 0, "-l"]
inertia = [0, 0, 0]
joint = {{ kind = "revolute", on = "frame", axis = [0, 1, 0], angle = "-theta" }}
[forces.weight]
kind = "gravity"
acceleration = [0, 0, "-g"]
"""
SPEED = '"sqrt(g/(l*cos(theta_0)))"'


@cache
def rotating(psi: str, *about: Any) -> eomgen.Linearization:
    text = ROTATING.format(psi, 0).replace("inertia = [0, 0, 0]\nmass = 0\n", "")
    return eomgen.linearize(eomgen.loads('eomgen = 1\nname = "spin"\nspace = "space"\n' + text), *about)


def test_a_pendulum_on_a_frame_that_turns_steadily_swings_about_its_angle():
    """Driven with W^2 = g/(l cos theta_0): w = W sin(theta_0)"""
    found = rotating('{ motion = "sqrt(g/(l*cos(theta_0)))*t" }', "start")
    (frequency,) = found.frequencies
    assert is_formula(frequency.exact, "sqrt(g/(l*cos(theta_0)))*sin(theta_0)", found.small)


def test_a_bead_on_a_turning_hoop_rests_beside_it():
    """About "equilibrium" the place is found: cos(theta) = g/(R W^2), w = W sin(theta); stable"""
    model = eomgen.load(MODELS / "bead_on_turning_hoop.toml")
    found = eomgen.linearize(model)
    (frequency,) = found.frequencies
    assert is_formula(frequency.exact, "omega*sqrt(1 - (g/(R*omega^2))^2)", found.small)
    assert found.spectrum.stability == "stable" and "centrifugal" in found.spectrum.why


def test_a_conical_pendulum_swings_at_constant_moment_of_momentum():
    """psi is ignorable: w = W sqrt(1 + 3 cos^2 theta_0); C is gyroscopic; Routh's K for theta alone gives the same"""
    free = rotating(f"{{ start = 0, speed = {SPEED} }}", "start")
    assert free.G[0, 1] == pytest.approx(-free.G[1, 0]) and abs(free.G[0, 1]) > 0.1
    assert np.allclose(free.D, 0, atol=1e-14)
    (frequency,) = free.frequencies
    expected = math.sqrt(9.81 / (0.4 * 0.5)) * math.sqrt(1 + 3 * 0.25)
    assert frequency.mode.frequency == pytest.approx(expected, rel=1e-9)
    alone = rotating(f"{{ start = 0, speed = {SPEED} }}", "start", ("theta",))
    assert alone.coordinates == ("theta",)
    (frequency,) = alone.frequencies
    assert is_formula(frequency.exact, "sqrt(g/(l*cos(theta_0))*(1 + 3*cos(theta_0)^2))", alone.small)
    assert_same_eigenvalues(free.small, 1e-6)


def test_a_start_that_is_no_steady_motion_is_refused_far_from_one():
    """A conical pendulum that is too fast, cos(theta) = g/(l psi'^2); one that swings through its lowest point."""
    near = rotating("{ start = 0, speed = 9 }", "start").small.reference
    state = {x.name: float(value) for x, value in near.numbers.items()}
    assert near.beside is not None and any(state[x.name] != value for x, value in near.beside.items())
    assert math.cos(state["theta"]) == pytest.approx(state["g"] / (state["l"] * state["psi'"] ** 2))
    with pytest.raises(eomgen.DerivationError, match="'theta'' is accelerated there; the steady motion nearest to it"):
        rotating("{ start = 0, speed = 30 }", "start")
    with pytest.raises(eomgen.DerivationError, match="'q1' moves, and the equations depend on it"):
        text = pendulums(1).replace("start = 0.1", "start = 0, speed = 1")
        linearized(text, "start")


# -- velocity constraints ---------------------------------------------------------------------------------------------

SLEIGH = """[parameters]
m = 2
J = 0.3
a = {1}
v = {0}
[coordinates]
x = {{ start = 0, speed = "v" }}
y = {{ start = 0 }}
psi = {{ start = 0 }}
[bodies.sled]
mass = "m"
center = ["a", 0]
inertia = "J"
joint = {{ kind = "planar", x = "x", y = "y", angle = "psi" }}
[constraints.knife]
kind = "skate"
point = "sled.origin"
along = [1, 0]
"""


@pytest.mark.parametrize(("v", "a", "stability"), [(3, 0.2, "stable to first order"), (3, -0.2, "unstable")])
def test_a_sleigh_runs_straight_with_its_mass_before_the_knife_edge(v, a, stability):
    """psi'' = -m a v/(J + m a^2) psi': lambda = that, all others 0; K alone would know nothing of it"""
    found = linearized(SLEIGH.format(v, a), "start")
    expected = -2 * a * v / (0.3 + 2 * a * a)
    assert nonzero(found.spectrum.eigenvalues) == pytest.approx([expected])
    assert found.spectrum.stability == stability
    assert_same_eigenvalues(found.small)


def test_a_sleigh_between_springs_has_a_state_that_no_speed_belongs_to():
    """y' = v psi, (J + m a^2) psi'' + m a v psi' + k a (y + a psi) = 0: three states beside the speed along"""
    spring = """[points]
O = [0, 0]
[forces.s]
kind = "spring"
points = ["O", "sled.center"]
stiffness = 5
length = 0
along = [0, 1]
"""
    found = linearized(SLEIGH.format(3, 0.2) + spring, "start")
    assert (found.coordinates, found.speeds, found.small.is_second_order) == (("y", "psi"), ("x'", "psi'"), False)
    m, J, a, v, k = 2, 0.3, 0.2, 3, 5
    expected = np.roots([J + m * a * a, m * a * v, k * a * a, k * a * v])
    assert nonzero(found.spectrum.eigenvalues) == pytest.approx(nonzero(expected))
    assert_same_eigenvalues(found.small)


DISC = """[parameters]
m = 2
r = 0.3
g = 9.81
n = {0}
[coordinates]
X = {{ start = 0, speed = "r*n" }}
Y = {{ start = 0 }}
psi = {{ start = 0 }}
theta = {{ start = 0 }}
phi = {{ start = 0, speed = "n" }}
[bodies.a]
joint = {{ kind = "prismatic", axis = [1, 0, 0], displacement = "X + r*sin(theta)*sin(psi)" }}
[bodies.b]
joint = {{ kind = "prismatic", on = "a", axis = [0, 1, 0], displacement = "Y - r*sin(theta)*cos(psi)" }}
[bodies.c]
joint = {{ kind = "prismatic", on = "b", axis = [0, 0, 1], displacement = "r*cos(theta)" }}
[bodies.d]
joint = {{ kind = "revolute", on = "c", axis = [0, 0, 1], angle = "psi" }}
[bodies.e]
joint = {{ kind = "revolute", on = "d", axis = [1, 0, 0], angle = "theta" }}
[bodies.disc]
mass = "m"
inertia = ["m*r^2/4", "m*r^2/2", "m*r^2/4"]
joint = {{ kind = "revolute", on = "e", axis = [0, 1, 0], angle = "phi" }}
[constraints.along]
kind = "equation"
rate = "X' - r*phi'*cos(psi)"
[constraints.across]
kind = "equation"
rate = "Y' - r*phi'*sin(psi)"
[forces.weight]
kind = "gravity"
acceleration = [0, 0, "-g"]
"""


@pytest.mark.parametrize(("n", "oscillates"), [("sqrt(g/(3*r))*99/100", False), ("sqrt(g/(3*r))*101/100", True)])
def test_a_rolling_disc_is_upright_beyond_its_critical_speed(n, oscillates):
    """Upright a thin disc rolls steadily where n^2 > g/(3 r);  w^2 = (12 n^2 - 4 g/r)/5

    Source: Neimark & Fufaev, Dynamics of Nonholonomic Systems, ch. II.
    """
    head = 'eomgen = 1\nname = "disc"\nspace = "space"\n'
    found = eomgen.linearize(eomgen.loads(head + DISC.format(f'"{n}"')), "start")
    square = (12 * (9.81 / 0.9) * (1.01 if oscillates else 0.99) ** 2 - 4 * 9.81 / 0.3) / 5
    values = nonzero(found.spectrum.eigenvalues)
    assert values**2 == pytest.approx([-square, -square], rel=1e-6)
    assert bool(found.frequencies) == oscillates
    assert_same_eigenvalues(found.small, 1e-6)


def test_a_disc_that_rolls_in_a_circle_is_linearized_in_the_frame_that_turns_with_it():
    """The rates X' and Y' change along the circle, the equations of heading, lean and spin do not.

    Source: the steady spin by Neimark & Fufaev; here the one at which the model's own lean has no acceleration.
    """
    text = DISC.replace("psi = {{ start = 0 }}", "psi = {{ start = 0, speed = 1.5 }}")
    text = text.replace("theta = {{ start = 0 }}", "theta = {{ start = 0.3 }}")
    head = 'eomgen = 1\nname = "disc"\nspace = "space"\n'

    def lean(n: float) -> float:
        equations = eomgen.derive(eomgen.loads(head + text.format(n)))
        rhs = equations.rhs("numpy")
        return rhs(0.0, rhs.x0, rhs.p0)[len(equations.coordinates) + equations.speeds.index("theta'")]

    n = brentq(lean, -40, 0, xtol=1e-14)
    found = eomgen.linearize(eomgen.loads(head + text.format(repr(n))), "start")
    assert found.coordinates == ("psi", "theta", "phi") and [q.name for q in found.small.left_out] == ["X", "Y"]
    assert len(found.frequencies) == 1
    assert_same_eigenvalues(found.small, 1e-6)


# -- in whole motions ------------------------------------------------------------------------------------------


def test_the_period_of_a_small_motion_is_that_of_the_simulation():
    """A spring pendulum of one mode, swung out by 1e-4: the state after a period is the state before it"""
    found = linearized(pendulums(2))
    mode = found.spectrum.modes[0]
    start = {q.name: 1e-4 * x.real for q, x in mode.shape.items()}
    run = eomgen.simulate(found.model, time=2 * math.pi / mode.frequency, start=start, samples=3)
    assert run.x[-1] == pytest.approx(run.x[0], abs=1e-9)
    assert run.x[1, :2] == pytest.approx(-run.x[0, :2], abs=1e-9)


def test_matrices_are_the_derivatives_of_the_equations():
    """K = -d(forcing)/dq, C = -d(forcing)/du at rest, and M there: entry by entry, of a system without constraints"""
    found = linearized(INVERTED)
    equations = eomgen.derive(found.model)
    x = equations.graph.symbols
    (forcing,) = equations.graph.forcing
    rest = {x.q[0]: 0, x.u[0]: 0}
    own = substituted((-derivative(forcing, x.q[0]), -derivative(forcing, x.u[0]), equations.graph.M[0][0]), rest)
    for mine, letter in zip(own, "KCM", strict=True):
        ((entry,),) = getattr(found.equations, letter)
        assert is_formula(entry, to_text(mine), found.small)


def test_entries_of_a_long_chain_stay_as_short_as_they_came() -> None:
    """M of 12 rods, each with a mass and a length of its own: multiplied out M_11 has 364 terms and 8600 letters, as it
    came 4000. With numbers in it, it is the matrix that is known in numbers."""
    parameters, coordinates, bodies = "g = 9.81\n", "", ""
    for k in range(1, 13):
        parameters += f"m{k} = 1\nl{k} = 0.5\n"
        coordinates += f"q{k} = 0.1\n"
        hung = f'on = "rod{k - 1}.end", angle = "q{k}"' if k > 1 else 'at = [0, 0], angle = "q1 - pi/2"'
        bodies += f'[bodies.rod{k}]\nshape = {{ kind = "rod", mass = "m{k}", length = "l{k}" }}\n'
        bodies += f'joint = {{ kind = "revolute", {hung} }}\n'
    text = f"{HEAD}[parameters]\n{parameters}[coordinates]\n{coordinates}{bodies}{WEIGHT}"
    found = eomgen.linearize(eomgen.loads(text))
    M = found.small.exact.M
    assert max(text_size(x) for row in M for x in row) < 5000
    there = [evaluate(tuple(row), found.small.reference.trial, fifty_digits()) for row in M]
    assert np.array(there, dtype=float) == pytest.approx(np.array(found.small.numbers.M, dtype=float), rel=1e-12)


def test_a_mass_that_is_light_beside_another_is_not_rounding() -> None:
    """w = sqrt(k/m) of each, 1e16 kg to 1 kg."""
    bodies = "".join(
        f'[bodies.{name}]\nshape = {{ kind = "particle", mass = "{mass}" }}\n'
        f'joint = {{ kind = "prismatic", axis = [1, 0], displacement = "{name}_x" }}\n'
        f'[forces.{name}_spring]\nkind = "potential"\nenergy = "{name}_x^2/2"\n'
        for name, mass in (("light", "10^(-16)"), ("heavy", "1"))
    )
    found = linearized(f"[coordinates]\nlight_x = 0\nheavy_x = 0\n{bodies}")
    assert sorted(mode.frequency for mode in found.spectrum.oscillating) == pytest.approx([1, 1e8])
