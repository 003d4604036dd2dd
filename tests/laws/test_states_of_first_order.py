"""States of first order, z' = Z(q, u, a, z, t): motors, controllers, pressures, against closed forms and scipy."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from scipy.linalg import expm

import eomgen
from eomgen.errors import DerivationError, ModelError

MODELS = Path(__file__).parents[2] / "models"

MOTOR = """
eomgen = 1
space = "plane"
[parameters]
J = 0.02
R = { value = 1.2, unit = "ohm" }
L = { value = 3, unit = "mH" }
k = { value = 0.08, unit = "N*m/A" }
b = { value = 1e-3, unit = "N*m*s" }
[inputs]
U = { value = 24, unit = "V" }
[coordinates]
theta = { unit = "rad" }
[states]
i = { unit = "A", rate = "(U - R*i - k*theta')/L", about = "current of the armature" }
[bodies.rotor]
mass = 1
inertia = "J"
joint = { kind = "revolute", angle = "theta" }
[forces.motor]
kind = "couple"
body = "rotor"
couple = "k*i - b*theta'"
[outputs]
slope = { value = "i'", unit = "A/s" }
late = { value = "i", at = "t = 0.05" }
"""


def motor_at(t: float, U: float = 24.0) -> np.ndarray:
    """(theta, theta', i) from rest: x' = A x + b, by the matrix exponential."""
    J, R, L, k, b = 0.02, 1.2, 3e-3, 0.08, 1e-3
    M = np.zeros((4, 4))
    M[:3] = [[0, 1, 0, 0], [0, -b / J, k / J, 0], [0, -k / L, -R / L, U / L]]
    return np.asarray(expm(M * t)[:3, 3])


def test_a_motor_with_inductance_runs_up_as_its_matrix_exponential_says():
    """x = (q, u, z); columns, names, drift of nothing else."""
    run = eomgen.simulate(eomgen.loads(MOTOR), time=0.5, target="numpy", rtol=1e-11, atol=1e-11)
    assert run.states == ("i",) and run.columns().keys() >= {"theta", "theta'", "i", "slope"}
    assert run.x[-1] == pytest.approx(motor_at(0.5), rel=1e-8)
    assert run["slope"][0] == pytest.approx(24 / 3e-3)


def test_equations_and_their_json_say_the_states_and_rates():
    """`states`, `state_rates` {name: text}; `equations.states`, `rhs.states`; dx has z' last."""
    equations = eomgen.derive(eomgen.loads(MOTOR))
    entries = equations.entries()
    assert equations.states == ("i",) and entries["states"] == ["i"]
    assert entries["state_rates"].keys() == {"i"} and "theta'" in entries["state_rates"]["i"]
    rhs = equations.rhs("numpy")
    assert rhs.states == ("i",)
    assert rhs(0, [0, 1, 2], rhs.p0) == pytest.approx([1, (0.08 * 2 - 1e-3) / 0.02, (24 - 2.4 - 0.08) / 3e-3])


def test_the_certificate_compares_each_rate_with_the_text_of_the_file():
    """By numbers of 50 digits put into the text; the code that is emitted, too."""
    certificate = eomgen.derive(eomgen.loads(MOTOR)).certify()
    assert certificate.ok and "rates of states are those declared" in {check.name for check in certificate.checks}


@pytest.mark.slow
def test_an_instant_of_a_state_is_answered():
    assert eomgen.solve(eomgen.loads(MOTOR))["late"].value == pytest.approx(motor_at(0.05)[2], rel=1e-7)


def test_slopes_of_the_right_hand_side_hold_the_states():
    """A = dx'/dx of x = (q, u, z), B by the inputs."""
    A, B = eomgen.derive(eomgen.loads(MOTOR)).rhs_jacobian()
    J, R, L, k, b = 0.02, 1.2, 3e-3, 0.08, 1e-3
    assert A == pytest.approx(np.array([[0, 1, 0], [0, -b / J, k / J], [0, -k / L, -R / L]]))
    assert B == pytest.approx(np.array([[0], [0], [1 / L]]))


def test_what_pushes_by_a_rate_that_follows_from_the_push_is_refused_by_name():
    """force <- z' <- a is an algebraic loop; a rate without accelerations is none."""
    text = MOTOR.replace("k*i - b", "k*(i + L/R*i') - b")
    assert eomgen.derive(eomgen.loads(text)).certify().ok
    looped = text.replace("k*theta')/L", "k*theta' - k*(L/R)*theta'')/L")
    with pytest.raises(DerivationError, match="algebraic loop: it pushes by i'"):
        eomgen.derive(eomgen.loads(looped))


@pytest.mark.parametrize(
    "change, words",
    [
        (('/L", about', '", about'), "is in V"),
        (("R*i -", "R*z -"), "unknown name 'z'"),
        (("U - R*i", "U - R*i - L*i'"), "needs itself"),
        (('i = { unit = "A", rate', 'i = { unit = "A", rote'), "rote"),
    ],
)
def test_mistakes_in_a_state_are_reported(change, words):
    with pytest.raises(ModelError, match=words):
        eomgen.loads(MOTOR.replace(*change))


def test_units_of_electricity_and_temperature_are_checked():
    """V = ohm A = Wb/s = J/C, F = A s/V, H = V s/A; W/K."""
    from eomgen.model.quantities import Unit

    for one, other in (("V", "ohm*A"), ("Wb", "V*s"), ("F", "A*s/V"), ("H", "V*s/A"), ("T", "Wb/m^2"), ("C", "A*s")):
        assert Unit.parse(one).fits(Unit.parse(other)) and Unit.parse(one).factor == 1
    assert Unit.parse("N*m/A").fits(Unit.parse("V*s/rad")) and not Unit.parse("W/K").fits(Unit.parse("W"))
    assert Unit.parse("l/min").to_si(60_000, 1) == 1 and Unit.parse("bar").to_si(1, 1) == 100_000


SERVO = """
eomgen = 1
space = "plane"
[parameters]
R = { value = 1.2, unit = "ohm" }
L = { value = 3, unit = "mH" }
k = { value = 0.8, unit = "N*m/A" }
r = 0.5
[coordinates]
theta = { start = 0.2, unit = "rad" }
[states]
i = { unit = "A", rate = "(20*(r - theta) + 30*z - 0.5*theta' - R*i - k/10*theta')/L" }
z = { unit = "s", rate = "r - theta", about = "integral of the error" }
[bodies.rotor]
mass = 0.5
center = [0.2, 0]
inertia = 0.02
joint = { kind = "revolute", angle = "theta", torque = "k*i" }
[forces.weight]
kind = "gravity"
acceleration = [0, -9.81]
[outputs]
i_rest = { value = "i", at = "equilibrium" }
z_rest = { value = "z", at = "equilibrium" }
"""


def test_a_servo_with_integral_part_rests_where_all_vanish_together():
    """dZ/dz has rank 1 of 2: i = m g l cos(r)/k and z follow from the balance and the rates at once."""
    found = eomgen.solve(eomgen.loads(SERVO))
    i = 0.5 * 9.81 * 0.2 * np.cos(0.5) / 0.8
    assert found["i_rest"].value == pytest.approx(i) and found["z_rest"].value == pytest.approx(1.2 * i / 30)


def test_small_motions_hold_the_states_and_modes_say_what_takes_part():
    """A over x = (q, u, z), eigenvalues, |V o V^-T|; certificate by differences of the texts."""
    found = eomgen.linearize(eomgen.loads(SERVO))
    I, i = 0.02 + 0.5 * 0.2**2, 0.5 * 9.81 * 0.2 * np.cos(0.5) / 0.8
    fall = 0.5 * 9.81 * 0.2 * np.sin(0.5)
    A = np.array(
        [[0, 1, 0, 0], [fall / I, 0, 0.8 / I, 0], [-20 / 3e-3, -0.58 / 3e-3, -1.2 / 3e-3, 30 / 3e-3], [-1, 0, 0, 0]]
    )
    assert found.state_space().states == ("theta", "theta'", "i", "z") and i > 0
    assert found.A == pytest.approx(A)
    values = sorted(np.linalg.eigvals(A), key=lambda x: (x.real, x.imag))
    assert sorted(found.spectrum.eigenvalues, key=lambda x: (x.real, x.imag)) == pytest.approx(values)
    fast = found.entries()["modes"][-1]["participation"]
    assert max(fast, key=fast.get) == "i" and sum(fast.values()) == pytest.approx(1)
    assert found.certify().ok


def test_a_transfer_function_goes_from_the_voltage_to_the_angle():
    """theta/U = k/(J L s^3 + (J R + b L) s^2 + (R b + k^2) s), in closed form; inputs act on rates."""
    text = MOTOR.replace("value = 24", "value = 0").replace("late = ", "# ")
    small = eomgen.linearize(eomgen.loads(text))
    entry = next(x for x in small.entries()["transfer_functions"] if x["coordinate"] == "theta")
    assert [entry["numerator"], entry["denominator"]] == [["k"], ["0", "R*b + k^2", "J*R + L*b", "J*L"]]
    assert small.B == pytest.approx(np.array([[0], [0], [1 / 3e-3]])) and small.certify().ok


LAG = """
eomgen = 1
space = "plane"
[parameters]
m = { value = 2, unit = "kg" }
k = { value = 50, unit = "N/m" }
c = { value = 0.1, unit = "N*s/m" }
T = { value = 0.1, unit = "s" }
[inputs]
w = { value = 0.1, unit = "m/s^2" }
[coordinates]
x = { start = 0.1, unit = "m" }
[states]
f = { unit = "m/s^2", rate = "(x'' - f + w)/T", start = 0.2 }
h = { unit = "m/s^2", rate = "f' - h/T" }
[bodies.b]
mass = "m"
joint = { kind = "prismatic", displacement = "x", axis = [1, 0], stiffness = "k", damping = "c", force = "-m/5*h" }
"""


def test_rates_that_hold_accelerations_and_other_rates_linearize():
    """A filter of the acceleration, whose rate another state follows: dz' = Z_a da with da of the equations."""
    found, equations = eomgen.linearize(eomgen.loads(LAG)), eomgen.derive(eomgen.loads(LAG))
    m, k, c, T = 2, 50, 0.1, 0.1
    a = np.array([-k / m, -c / m, 0, -1 / 5])
    f = a / T + [0, 0, -1 / T, 0]
    A = np.array([[0, 1, 0, 0], a, f, f - np.array([0, 0, 0, 1 / T])])
    assert found.A == pytest.approx(A) and equations.rhs_jacobian()[0] == pytest.approx(A)
    assert found.certify().ok and equations.certify().ok


@pytest.mark.parametrize(
    "equation, kind, term",
    [
        ("i' = (U - R*i + k*theta')/L", "sign", "-k*theta'/L"),
        ("i' = (U - R*i)/L", "missing_term", "-k*theta'/L"),
        ("L*i' + 2*R*i + k*theta' = U", "factor", "-R*i/L"),
        ("L*i' + R*i + k*theta' = U + b*theta'", "extra_term", "b*theta'/L"),
        ("L*i' + R*i + k*theta' = U", "", ""),
    ],
)
def test_an_equation_for_the_rate_of_a_state_is_judged_by_its_terms(equation, kind, term):
    """Right in any form; what is wrong is named by the terms of the declared rate, not by forces."""
    verdict = eomgen.verify(eomgen.loads(MOTOR), equation)
    assert bool(verdict) == (not kind)
    assert [(x.kind, x.term) for x in verdict.causes] == ([(kind, term)] if kind else [])


@pytest.mark.parametrize(
    ("equation", "causes"),
    [
        ("R*i = U - k*theta'", [("missing_term", "L*i'")]),
        ("i = U/R", [("missing_term", "L*i'/R"), ("missing_term", "-k*theta'/L")]),
        ("R*i = U + k*theta'", [("missing_term", "L*i'"), ("sign", "-k*theta'/L")]),
    ],
)
def test_an_equation_of_a_state_without_its_rate_lacks_it(equation, causes):
    """L i' + R i + k theta' = U without L i' holds only where i does not change; it is about no force."""
    verdict = eomgen.verify(eomgen.loads(MOTOR), equation)
    assert [(x.kind, x.term) for x in verdict.causes] == causes and not verdict
    assert "holds only where i does not change" in verdict.causes[0].text


SENSOR = """
eomgen = 1
space = "plane"
parameters = { k = 30, w = 4 }
coordinates = { x = 0.1 }
states.y = { rate = "x'' - w*y" }
[bodies.b]
mass = 2
joint = { kind = "prismatic", axis = [1, 0], displacement = "x", stiffness = "k" }
"""


@pytest.mark.parametrize(
    ("equation", "right"),
    [
        ("y' = x'' - w*y", True),
        ("y' + w*y = x''", True),
        ("y' = -k*x/2 - w*y", True),
        ("y' = x'' + w*y", False),
        ("y' = k*x/2 - w*y", False),
    ],
)
def test_a_rate_that_follows_an_acceleration_is_judged_with_it_and_without(equation, right):
    """As it is declared it says what the file says, which is right; with 2 x'' = -k x put in, too."""
    assert bool(eomgen.verify(eomgen.loads(SENSOR), equation)) == right


BLOCKED = """
eomgen = 1
space = "plane"
[parameters]
R = 2
L = 0.1
U = 5
k = 0.3
m = 1
[coordinates]
x = 0
[states]
i = { rate = "(U - R*i)/L", symbol = 'I_c', about = "current of a coil" }
[bodies.cart]
mass = "m"
joint = { kind = "prismatic", axis = [1, 0], displacement = "x", force = "k*i" }
"""


@pytest.mark.parametrize(
    ("equation", "verdict", "words"),
    [
        ("i = U/R*(1 - exp(-R*t/L))", "right", "the motion from the start"),
        ("i' = U/L*exp(-R*t/L)", "right", "the motion from the start"),
        ("i = U/R + C*exp(-R*t/L)", "right", "any start, with C constant"),
        ("i = U/R*(1 + exp(-R*t/L))", "wrong", "at the start i is 2*U/R, and not 0"),
        ("i = U/R*(1 - exp(-2*R*t/L))", "wrong", "the rate of i does not hold with it"),
        ("i' = 2*U/L*exp(-R*t/L)", "wrong", "at the start it is another"),
        ("x' = k*U/(m*R)*(t - L/R*(1 - exp(-R*t/L)))", "undecided", "do not decide it alone"),
    ],
)
def test_a_state_as_a_function_of_time_is_put_into_its_rate(equation, verdict, words):
    """z = f(t): f' = z'(f), f(0) = z(0); the certificate compares along runs besides."""
    found = eomgen.verify(eomgen.loads(BLOCKED), equation)
    assert found.verdict == verdict
    assert words in " ".join([found.up_to, found.reason, *(cause.text for cause in found.causes)])


@pytest.mark.parametrize(
    ("equation", "right"), [("theta = r", True), ("i = m*g*l*cos(r)/(N*k)", True), ("i = m*g*l*sin(r)/(N*k)", False)]
)
def test_rest_of_a_machine_is_judged_with_its_states(equation, right):
    """f(q, 0, z) = 0 and z' = 0 together give theta = r, which the balance of forces alone does not."""
    assert bool(eomgen.verify(eomgen.load(MODELS / "position_servo.toml"), equation)) == right


def test_the_symbol_and_the_remark_of_a_state_stand_wherever_its_name_does():
    """In LaTeX by its symbol, with a dot for the rate; in code with unit and remark."""
    equations = eomgen.derive(eomgen.loads(BLOCKED))
    assert r"\dot{I}_{c} &=" in equations.render("latex")
    assert "current of a coil" in "".join(map(str, eomgen.generate(equations.model, ("c",)).texts.values()))


def test_sensitivities_follow_states_through_a_run_and_at_rest():
    """s' = f_x s + f_p with z among x; of rest with z' = 0 beside the balance; checked by differences."""
    at_start = eomgen.sensitivity(eomgen.loads(MOTOR), of="i'", to="i")
    assert at_start.matrix[0, 0] == pytest.approx(-1.2 / 3e-3)
    rest = eomgen.sensitivity(eomgen.loads(SERVO), of="equilibrium", to="r")
    i = -0.5 * 9.81 * 0.2 * np.sin(0.5) / 0.8
    assert rest.matrix[:, 0] == pytest.approx([1, i, 1.2 * i / 30])


FOLLOWER = """
eomgen = 1
space = "plane"
[parameters]
k = 3
w = 1.7
[coordinates]
x = 0
[states]
z = { rate = "w*(x - z)", about = "the place, late" }
[bodies.cart]
mass = 1
joint = { kind = "prismatic", axis = [1, 0], displacement = "x", force = "1.1 - k*x" }
"""


def test_what_follows_a_place_rests_there():
    """z' = w (x - z) vanishes where z = x; moved along with x it would not change, which is no measure of it."""
    found = eomgen.statics(eomgen.loads(FOLLOWER))
    (place,) = found.entries()["equilibria"]
    assert place["states"]["z"].value == place["coordinates"]["x"].value == pytest.approx(1.1 / 3)
    assert found.certify().ok


def test_a_state_that_follows_what_nothing_holds_rests_anywhere():
    """Without a force on x every place is one of rest, with z = x there: the place that is found says so."""
    (place,) = eomgen.statics(eomgen.loads(FOLLOWER.replace("1.1 - k*x", "0*k*x"))).entries()["equilibria"]
    assert place["states"]["z"].value == pytest.approx(place["coordinates"]["x"].value)
    assert "places beside it are at rest, too" in place["stability"]["why"]


HEATED = """
eomgen = 1
space = "plane"
[parameters]
m = { value = 2, unit = "kg" }
g = { value = 9.81, unit = "m/s^2" }
mu = 0.2
C = { value = 5, unit = "J/K" }
k = { value = 1e-9, unit = "m^2/N" }
[coordinates]
x = { speed = 3, unit = "m" }
[states]
T = { unit = "K", rate = "mu*reaction_n(block)*abs(x')/C", about = "temperature above the room's" }
W = { unit = "m^3", rate = "k*reaction_n(block)*abs(x')", about = "worn volume by Archard's law" }
[bodies.block]
mass = "m"
joint = { kind = "prismatic", displacement = "x", axis = [1, 0], friction = { coefficient = "mu" } }
[forces.weight]
kind = "gravity"
acceleration = [0, "-g"]
"""


def test_a_block_that_rubs_to_a_standstill_heats_by_all_its_energy():
    """C T = m v^2/2, W = k N v^2/(2 mu g) of the reaction's own N = m g; both stay while it sticks; batches too."""
    model = eomgen.loads(HEATED)
    run = eomgen.simulate(model, time=3, target="numpy", rtol=1e-10, atol=1e-13)
    assert len(run.phases) == 2 and run["T"][-1] == pytest.approx(2 * 9 / 2 / 5, rel=1e-8)
    assert run["W"][-1] == pytest.approx(1e-9 * 2 * 9 / (2 * 0.2), rel=1e-8)
    many = eomgen.simulate_many(model, time=3, start={"x'": [1, 2]}, target="numpy")
    assert many["T"][:, -1] == pytest.approx([0.2, 0.8], rel=1e-6)
    assert eomgen.derive(model).certify().ok


CELL = """
eomgen = 1
space = "plane"
parameters = { m = 2, l = 0.5, g = 9.81, tau = 0.1, k = 30, c = 0.2, I = 0.05 }
coordinates.theta = { start = 0.3, unit = "rad" }
states.F = { unit = "N", rate = "(reaction_y(rod) - F)/tau", start = 1, about = "force that a load cell shows" }
bodies.rod.mass = "m"
bodies.rod.center = ["l", 0]
bodies.rod.inertia = "I"
bodies.rod.joint = { kind = "revolute", angle = "theta", stiffness = "k", damping = "c" }
forces.weight = { kind = "gravity", acceleration = [0, "-g"] }
outputs.F_rest = { value = "F", at = "equilibrium" }
"""


def cell(x: np.ndarray) -> np.ndarray:
    """(theta', theta'', F') by the motion of the mass centre: R_y = m (g + (l sin theta)'')."""
    theta, w, F = x
    a = (-30 * theta - 0.2 * w - 2 * 9.81 * 0.5 * np.cos(theta)) / (0.05 + 2 * 0.25)
    R = 2 * (9.81 + 0.5 * (np.cos(theta) * a - np.sin(theta) * w**2))
    return np.array([w, a, (R - F) / 0.1])


def test_a_load_cell_follows_the_reaction_of_its_hinge():
    """A rate that holds a reaction is one that holds accelerations: run, slopes, rest and its sensitivity."""
    from scipy.integrate import solve_ivp

    model = eomgen.loads(CELL)
    run = eomgen.simulate(model, time=0.4, target="numpy", rtol=1e-11, atol=1e-11)
    right = solve_ivp(lambda t, x: cell(x), (0, 0.4), [0.3, 0, 1], rtol=1e-12, atol=1e-12).y[:, -1]
    assert run.x[-1] == pytest.approx(right, rel=1e-8)
    equations, at = eomgen.derive(model), np.array([0.3, 0.0, 1.0])
    slopes = [(cell(at + d) - cell(at - d)) / 2e-6 for d in 1e-6 * np.eye(3)]
    assert equations.rhs_jacobian()[0] == pytest.approx(np.array(slopes).T, rel=1e-6, abs=1e-6)
    assert eomgen.solve(model)["F_rest"].value == pytest.approx(2 * 9.81)
    assert eomgen.sensitivity(model, of="equilibrium", to="m").matrix[1, 0] == pytest.approx(9.81)
    assert equations.certify().ok and "F' = (R_rod_y - F)/tau" in equations.render("text")


def test_small_motions_follow_a_reaction():
    """dF' = (m l cos(theta) da - dF)/tau with da of the equations: formula 8 with the reaction of z."""
    found = eomgen.linearize(eomgen.loads(CELL))
    theta = found.entries()["state"]["theta"].value
    at = np.array([theta, 0.0, 2 * 9.81])
    assert cell(at) == pytest.approx(np.zeros(3), abs=1e-9)
    slopes = [(cell(at + d) - cell(at - d)) / 2e-6 for d in 1e-6 * np.eye(3)]
    assert found.A == pytest.approx(np.array(slopes).T, rel=1e-6, abs=1e-6) and found.certify().ok


@pytest.mark.parametrize(
    ("equation", "right"),
    [
        ("F' = (reaction_y(rod) - F)/tau", True),
        ("tau*F' + F = m*g + m*l*cos(theta)*theta'' - m*l*sin(theta)*theta'^2", True),
        ("F' = (m*g - F)/tau", False),
        ("F = m*g", True),
        ("F = m*g*cos(theta)", False),
    ],
)
def test_an_equation_of_a_rate_with_a_reaction_is_judged(equation, right):
    """By the reaction's name, or by what the balance of the body gives for it; at rest by the weight."""
    assert bool(eomgen.verify(eomgen.loads(CELL), equation)) == right


def test_a_rate_follows_reactions_where_coordinates_are_dependent():
    """A crank at a dead centre is integrated over all rates: there the reaction is that of the whole, too."""
    text = (MODELS.parent / "docs" / "examples" / "slider.toml").read_text(encoding="utf-8")
    model = eomgen.loads(text + '\n[states.z]\nrate = "reaction_x(crank) - 2*z"\n[outputs]\nR = "reaction_x(crank)"\n')
    run = eomgen.simulate(model, time=0.2, target="numpy", rtol=1e-10, atol=1e-10, samples=2001)
    t, R = run.t, run["R"]
    z = np.exp(-2 * t[-1]) * np.trapezoid(R * np.exp(2 * t), t)
    assert run["z"][-1] == pytest.approx(z, rel=1e-5) and eomgen.derive(model).certify().ok


@pytest.mark.parametrize(
    ("old", "new", "words"),
    [
        ('damping = "c"', "torque = \"-c*theta' + l*F'\"", "algebraic loop: it pushes by F', which follows from the"),
        ('mass = "m"', 'mass = "m + tau*F"', "depends on an acceleration or a reaction"),
        ("reaction_y(rod)", "reaction_n(rod)", "states.F.rate: 'reaction_n(rod)' in the rate of a state"),
        ("reaction_y(rod)", "speed(rod.origin)", "cannot stand in the rate of state 'F'"),
        ("reaction_y(rod)", "reaction_couple(rod)", "have no sum"),
        ("reaction_y(rod)", "reaction_y(rud)", "did you mean 'rod'"),
    ],
)
def test_a_reaction_that_cannot_stand_in_a_rate_is_refused_by_name(old, new, words):
    """A loop, a mass, what the part does not have; other functions, other units, other names."""
    with pytest.raises((DerivationError, ModelError)) as refused:
        eomgen.derive(eomgen.loads(CELL.replace(old, new))).certify()
    assert words in str(refused.value)


def test_an_indeterminate_reaction_in_a_rate_is_refused_by_name():
    """A bar between two pins has no single force along itself; across it has one."""
    text = """
eomgen = 1
space = "plane"
coordinates.x = { speed = 1 }
states.z = { rate = "reaction_x(A) - z" }
points.P = [1, 0]
bodies.bar = { mass = 1, inertia = 1, joint = { kind = "fixed" }, points = { end = [1, 0] } }
bodies.cart = { mass = 1, joint = { kind = "prismatic", axis = [1, 0], displacement = "x" } }
constraints.A = { kind = "pin", points = ["bar.end", "P"] }
"""
    with pytest.raises(DerivationError, match=r"reaction_x.A. is statically indeterminate"):
        eomgen.derive(eomgen.loads(text))


def test_a_motor_that_turns_steadily_is_linearized_about_its_speed_and_current():
    """theta' = k U/(R b + k^2), i = b U/(R b + k^2); eigenvalues of [[-R/L, -k/L], [k/J, -b/J]], and 0 of theta."""
    found = eomgen.linearize(eomgen.loads(MOTOR), about="steady")
    J, R, L, k, b, U = 0.02, 1.2, 3e-3, 0.08, 1e-3, 24
    at = {name: x.value for name, x in found.entries()["state"].items()}
    assert at["theta'"] == pytest.approx(k * U / (R * b + k**2)) and at["i"] == pytest.approx(b * U / (R * b + k**2))
    right = [*np.linalg.eigvals([[-R / L, -k / L], [k / J, -b / J]]), 0.0]
    assert sorted(np.real(found.spectrum.eigenvalues)) == pytest.approx(sorted(np.real(right)), abs=1e-9)
    assert found.certify().ok


def test_a_motor_that_never_rests_is_sent_to_its_steady_motion():
    """Without a voltage to hold it at 0 the motor has no equilibrium: what would work is named."""
    for about in ("equilibrium", "start"):
        with pytest.raises(DerivationError) as refused:
            eomgen.linearize(eomgen.loads(MOTOR), about=about)
        assert 'let a steady motion be sought: about = "steady"' in str(refused.value)


STEADY = """
eomgen = 1
space = "plane"
parameters = { m = 1000, c = 0.8, P0 = 20000, T = 0.5, mu = 0.01, g = 9.81, C = 500, h = 3 }
coordinates.x = { speed = 10 }
states.P = { rate = "(P0 - P)/T", unit = "W", about = "power of the engine" }
states.H = { rate = "mu*abs(reaction_n(wagon)*x')", unit = "J", about = "heat, on which nothing depends" }
states.D = { rate = "(mu*reaction_n(wagon)*abs(x') - h*D)/C", about = "temperature of the bearings" }
bodies.wagon.mass = "m"
bodies.wagon.joint = { kind = "prismatic", axis = [1, 0], displacement = "x", force = "P/x' - c*x'^2" }
forces.w = { kind = "gravity", acceleration = [0, "-g"] }
"""


def test_a_wagon_under_the_power_of_its_engine_goes_steadily():
    """v = (P0/c)^(1/3), D = mu m g v/h; -1/T, -3 c v/m, -h/C; the place, and the heat that grows: 0."""
    found = eomgen.linearize(eomgen.loads(STEADY), about="steady")
    v = (20000 / 0.8) ** (1 / 3)
    at = {name: x.value for name, x in found.entries()["state"].items()}
    assert at["x'"] == pytest.approx(v) and at["D"] == pytest.approx(0.01 * 1000 * 9.81 * v / 3)
    right = sorted([-2, -3 * 0.8 * v / 1000, -3 / 500, 0, 0])
    assert sorted(np.real(found.spectrum.eigenvalues)) == pytest.approx(right, abs=1e-9) and found.certify().ok


def test_a_speed_controller_with_integral_part_holds_its_speed():
    """theta' = w, i = b w/k, z = (R i + k w)/K: the integral finds what no error may leave."""
    rate = "(2*(w - theta') + 8*z + 0*U - R*i - k*theta')/L"
    text = MOTOR.replace("(U - R*i - k*theta')/L", rate).replace("[inputs]", "w = 50\n[inputs]")
    text = text.replace("[states]", '[states]\nz = { rate = "w - theta\'" }')
    found = eomgen.linearize(eomgen.loads(text), about="steady")
    at = {name: x.value for name, x in found.entries()["state"].items()}
    i = 1e-3 * 50 / 0.08
    assert [at["theta'"], at["i"], at["z"]] == pytest.approx([50, i, (1.2 * i + 0.08 * 50) / 8])
    A = np.array([[-0.05, 0.08 / 0.02, 0], [-2.08 / 3e-3, -400, 8 / 3e-3], [-1, 0, 0]])
    right = sorted([*np.linalg.eigvals(A), 0], key=lambda x: (x.real, x.imag))
    got = sorted(found.spectrum.eigenvalues, key=lambda x: (round(x.real, 6), x.imag))
    assert got == pytest.approx(right, abs=1e-6)


HOOP = """
eomgen = 1
space = "space"
parameters = { m = 1, R = 0.5, g = 9.81, W = 6, T = 0.2, c = 0.3, k = 0.6 }
coordinates.phi = { rate = "W" }
coordinates.theta = { near = 0.8 }
states.F = { rate = "(k*theta - F)/T", about = "torque of a slow spring" }
bodies.hoop.joint = { kind = "revolute", axis = [0, 0, 1], angle = "phi" }
[bodies.bead]
mass = "m"
center = [0, 0, "-R"]
inertia = [0, 0, 0]
joint = { kind = "revolute", on = "hoop.origin", axis = [0, 1, 0], angle = "theta", torque = "-F - c*theta'" }
[forces.w]
kind = "gravity"
acceleration = [0, 0, "-g"]
"""


def test_a_bead_on_a_turning_hoop_rests_on_it_with_its_state():
    """m R^2 W^2 sin cos - m g R sin - F = 0 with F = k theta: rest that only the turning frame has, two ways to it."""
    A = np.array([[0, 1, 0], [0, -0.3 / 0.25, -1 / 0.25], [3, 0, -5]])
    for about, theta in (("equilibrium", 0.0), ("steady", 0.9000168332264661)):
        found = eomgen.linearize(eomgen.loads(HOOP), about=about)
        at = {name: x.value for name, x in found.entries()["state"].items()}
        left = 0.25 * 36 * np.sin(theta) * np.cos(theta) - 9.81 * 0.5 * np.sin(theta) - 0.6 * theta
        assert abs(left) < 1e-9 and at["theta"] == pytest.approx(theta) and at["F"] == pytest.approx(0.6 * theta)
        A[1, 0] = 36 * np.cos(2 * theta) - 9.81 / 0.5 * np.cos(theta)
        right = sorted(np.linalg.eigvals(A), key=lambda x: (round(x.real, 6), x.imag))
        got = sorted(found.spectrum.eigenvalues, key=lambda x: (round(x.real, 6), x.imag))
        assert got == pytest.approx(right, rel=1e-6) and found.certify().ok


BISTABLE = """
eomgen = 1
space = "plane"
parameters = { m = 1, k = 4, T = 0.3, c = 0.5 }
coordinates.x = 0.3
states.F = { rate = "(k*x - F)/T", about = "a force that follows late" }
[bodies.cart]
mass = "m"
joint = { kind = "prismatic", axis = [1, 0], displacement = "x", force = "2*k*x - 8*x^3 - F - c*x'" }
"""


@pytest.mark.parametrize(("T", "kind"), [(0.3, "unstable"), (0.05, "stable")])
def test_the_eigenvalues_of_full_order_decide_whether_rest_with_states_is_stable(T, kind):
    """s^2 + c s + 24 x^2 - 8 + k/(T s + 1) = 0: T s^3 + (1 + T c) s^2 + (c + 4 T) s + 8 = 0 at x^2 = 1/2; at x = 0 it
    has a positive root. What follows late makes an oscillation grow where T is long, which no potential shows."""
    found = eomgen.statics(eomgen.loads(BISTABLE.replace("T = 0.3", f"T = {T}")))
    places = found.entries()["equilibria"]
    assert [round(x["coordinates"]["x"].value ** 2, 9) for x in places] == [0, 0.5, 0.5] and found.certify().ok
    fast = [max(np.roots([T, 1 + T * 0.5, 0.5 + 4 * T, 8]).real), max(np.roots([T, 1 + T * 0.5, 0.5 - 8 * T, -4]).real)]
    assert [
        (x["stability"]["kind"], f"exp({y:.6g} t)" in x["stability"]["why"])
        for x, y in zip(places, [fast[1], fast[0], fast[0]], strict=True)
    ] == [("unstable", True), (kind, True), (kind, True)]
