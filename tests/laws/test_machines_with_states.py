"""Machines with states of first order, each against an oracle that shares nothing: closed forms, expm, scipy."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from scipy.integrate import solve_ivp
from scipy.linalg import expm
from scipy.optimize import brentq

import eomgen
from eomgen.model import Unit
from eomgen.page.figure import motion_drawings

MODELS = Path(__file__).parents[2] / "models"
FINE = {"rtol": 1e-11, "atol": 1e-12, "target": "numpy"}


def run_of(model: str, time: float, **more: object) -> eomgen.Trajectory:
    model = eomgen.loads(model) if "\n" in model else eomgen.load(MODELS / f"{model}.toml")
    return eomgen.simulate(model, time=time, samples=11, **FINE, **more)


def test_a_motor_lifts_a_load_through_its_gear():
    """(J_d + m r^2 + n^2 J_m) w' = n k i - n^2 b w - m g r,  L i' = U - R i - n k w."""
    Jm, Jd, m, r, n, R, L, k, b, g, U = 4e-5, 6e-3, 8, 0.04, 25, 1.4, 2.1e-3, 0.052, 2e-5, 9.81, 24
    J = Jd + m * r**2 + n**2 * Jm
    A = np.zeros((4, 4))
    A[:3] = [[0, 1, 0, 0], [0, -(n**2) * b / J, n * k / J, -m * g * r / J], [0, -n * k / L, -R / L, U / L]]
    run = run_of("dc_motor", 0.5)
    assert [run[x][-1] for x in ("theta", "theta'", "i")] == pytest.approx(expm(A / 2)[:3, 3], rel=1e-9)
    assert run["reaction_couple(gear)"][-1] == pytest.approx(Jm * (n * A[1, :] @ [*run.x[-1, [0, 2, 3]], 1]) * 1
        + b * n * run["theta'"][-1] - k * run["i"][-1], rel=1e-7)  # fmt: skip


def test_a_current_is_drawn_in_its_own_unit(tmp_path):
    """Picture of a run and page: a state of first order has a curve, in a panel beside those of the coordinates."""
    run = run_of("dc_motor", 0.5)
    run.plot(tmp_path / "run.svg")
    assert "i [A]" in (tmp_path / "run.svg").read_text().replace("$", "")
    units = {"theta": Unit.parse("rad"), "phi": Unit.parse("rad"), "i": Unit.parse("mA")}
    captions = [drawing.caption for drawing in motion_drawings(run, units)]
    assert captions[:2] == ["Coordinates [rad] over time [s]", "States of first order [mA] over time [s]"]


def test_a_servo_holds_its_arm_where_the_current_carries_it():
    """At rest N k i = m g l cos(r), k_I z = R i: rank 1 of 2 in z alone, 3 of 3 together; it gets there in time."""
    model = eomgen.load(MODELS / "position_servo.toml")
    i = 1.5 * 9.81 * 0.3 * np.cos(0.6) / (30 * 0.05)
    found = eomgen.linearize(model).entries()["state"]
    assert [found[x].value for x in ("theta", "i", "z")] == pytest.approx([0.6, i, 2 * i / 60])
    run = run_of("position_servo", 20)
    assert run.x[-1] == pytest.approx([0.6, 0, i, 2 * i / 60], abs=1e-6)


def test_energy_and_what_the_source_gives_close():
    """d(T + V + L i^2/2)/dt = U i - R i^2 - losses: power through the state counts as applied power."""
    run = run_of("dc_motor", 0.3)
    rhs = eomgen.derive(eomgen.load(MODELS / "dc_motor.toml")).rhs("numpy")
    for x in run.x[1:]:
        dx = rhs(0, x, rhs.p0)
        w, i, n = x[2], x[3], 25
        J = 6e-3 + 8 * 0.04**2 + n**2 * 4e-5
        stored = J * w * dx[2] + 8 * 9.81 * 0.04 * w + 2.1e-3 * i * dx[3]
        assert stored == pytest.approx(24 * i - 1.4 * i**2 - 2e-5 * (n * w) ** 2, rel=1e-9)


def test_oil_in_a_cylinder_pushes_as_scipy_says():
    """p' = E (Q - A x')/V on both sides, Q = y Q_n sqrt(dp/p_n): Radau of scipy at rtol 1e-12."""
    m, c, k, A1, A2, V1, V2 = 120, 80, 6e4, 1.2e-3, 0.8e-3, 0.15e-3, 0.4e-3
    E, ps, p0, Qn, pn, y = 1.2e9, 160e5, 2e5, 40e-3 / 60, 35e5, 0.4

    def rate(t: float, s: np.ndarray) -> list[float]:
        x, v, p1, p2 = s
        Q1, Q2 = y * Qn * np.sqrt((ps - p1) / pn), y * Qn * np.sqrt((p2 - p0) / pn)
        return [
            v,
            (A1 * p1 - A2 * p2 - c * v - k * x) / m,
            E * (Q1 - A1 * v - 2e-12 * (p1 - p2)) / (V1 + A1 * x),
            E * (A2 * v + 2e-12 * (p1 - p2) - Q2) / (V2 - A2 * x),
        ]

    due = solve_ivp(rate, (0, 0.3), [0, 0, 20e5, 30e5], method="Radau", rtol=1e-11, atol=1e-9).y[:, -1]
    assert run_of("hydraulic_cylinder", 0.3).x[-1] == pytest.approx(due, rel=1e-6)


def test_oil_at_rest_leaks_past_the_piston_as_much_as_the_valve_lets_through():
    """p_1 + p_2 = p_s + p_0 of two equal openings; Q((p_s - p_1)) = c_L (p_1 - p_2); A_1 p_1 - A_2 p_2 = k x."""
    total, through = 162e5, 0.4 * 40e-3 / 60
    across = brentq(lambda d: through * np.sqrt(((total - d) / 2 - 2e5) / 35e5) - 2e-12 * d, 0, 158e5, xtol=1e-6)
    p1, p2 = (total + across) / 2, (total - across) / 2
    (place,) = eomgen.statics(eomgen.load(MODELS / "hydraulic_cylinder.toml")).entries()["equilibria"]
    found = [x.value for x in (*place["coordinates"].values(), *place["states"].values())]
    assert found == pytest.approx([(1.2e-3 * p1 - 0.8e-3 * p2) / 6e4, p1, p2], rel=1e-9)


def test_a_brake_turns_all_its_work_into_heat():
    """Without cooling C (T - T_0) = J (w_0^2 - w^2)/2, whatever the friction does with the temperature."""
    model = eomgen.load(MODELS / "thermal_brake.toml")
    run = eomgen.simulate(model, time=1.5, parameters={"h": 0}, samples=11, **FINE)
    heat = 1.8 * (150**2 - run["phi'"] ** 2) / 2
    assert 700 * (run["temp"] - 293) == pytest.approx(heat, rel=1e-9)
    cooled = run_of("thermal_brake", 1.5)
    assert np.all(cooled["temp"][1:] < run["temp"][1:]) and np.all(cooled["phi'"][1:] < run["phi'"][1:])


ONE = """
eomgen = 1
space = "plane"
[parameters]
m = { value = 2, unit = "kg" }
PARAMETERS
[coordinates]
x = { start = 0.1, speed = 0.3, unit = "m" }
[states]
STATES
[bodies.b]
mass = "m"
joint = { kind = "prismatic", displacement = "x", axis = [1, 0], force = "FORCE" }
"""


def one(parameters: str, states: str, force: str) -> str:
    text = ONE.replace("PARAMETERS", parameters).replace("STATES", states)
    return text.replace("FORCE", force)


def test_a_maxwell_element_relaxes():
    """f' = k x' - k f/d beside a spring: three eigenvalues of s^2 m + k_0 + k s/(s + k/d), all in expm."""
    text = one(
        'k = { value = 80, unit = "N/m" }\nd = { value = 5, unit = "N*s/m" }\nc = { value = 40, unit = "N/m" }',
        """f = { unit = "N", start = 3, rate = "k*x' - k/d*f" }""",
        "-c*x - f",
    )
    A = np.array([[0, 1, 0], [-20, 0, -0.5], [0, 80, -16]])
    assert run_of(text, 2).x[-1] == pytest.approx(expm(2 * A) @ [0.1, 0.3, 3], rel=1e-8)
    small = eomgen.linearize(eomgen.loads(text.replace("start = 3, ", "")))
    assert sorted(small.spectrum.eigenvalues, key=abs) == pytest.approx(sorted(np.linalg.eigvals(A), key=abs))


def test_a_pneumatic_spring_keeps_its_adiabat():
    """p' = -kappa p V'/V: p V^kappa stays, so the run is that of a conservative force, whose energy stays."""
    text = one(
        'A = { value = 0.01, unit = "m^2" }\nh = { value = 0.3, unit = "m" }\np_a = { value = 1, unit = "bar" }',
        """p = { unit = "bar", start = 1.5, rate = "-1.4*p*x'/(h + x)" }""",
        "(p - p_a)*A",
    )
    run = run_of(text, 1)
    invariant = run["p"] * (0.3 + run["x"]) ** 1.4
    assert invariant == pytest.approx(np.full(11, invariant[0]), rel=1e-9)
    stored = run["p"] * 0.01 * (0.3 + run["x"]) / 0.4 + 1e5 * 0.01 * run["x"] + run["x'"] ** 2
    assert stored == pytest.approx(np.full(11, stored[0]), rel=1e-9)


def test_a_tyre_builds_up_its_side_force_over_a_length():
    """sigma F' + v F = -C x' at a constant speed v: linear, in expm; at v = 0 a spring of C/sigma."""
    text = one(
        'v = { value = 12, unit = "m/s" }\ns = { value = 0.4, unit = "m" }\nC = { value = 300, unit = "N" }',
        """F = { unit = "N", rate = "(-C*x' - v*F)/s" }""",
        "F",
    )
    A = np.array([[0, 1, 0], [0, 0, 0.5], [0, -750, -30]])
    assert run_of(text, 0.5).x[-1] == pytest.approx(expm(A / 2) @ [0.1, 0.3, 0], rel=1e-8)
    still = run_of(text.replace("value = 12", "value = 0"), 0.5)
    w = np.sqrt(375)
    assert still["x"] == pytest.approx(0.1 + 0.3 * np.sin(w * still.t) / w, rel=1e-8)


BOUNCING = """
eomgen = 1
space = "plane"
[parameters]
m = 0.5
e = 0.6
g = 9.81
[coordinates]
y = 1
[states]
c = { start = 0.2, rate = "y' - 3*c", about = "what is left of the speed" }
p = { rate = "20*(y - p)", about = "the place, late" }
[bodies.ball]
shape = { kind = "particle", mass = "m" }
joint = { kind = "prismatic", axis = [0, 1], displacement = "y" }
[constraints.floor]
kind = "support"
point = "ball.origin"
normal = [0, 1]
at = [0, 0]
unilateral = true
restitution = "e"
[forces.weight]
kind = "gravity"
acceleration = [0, "-g"]
[forces.jet]
kind = "force"
point = "ball.origin"
force = [0, "0.1*c - 0.2*p"]
"""


def test_states_go_on_through_impacts_as_they_are():
    """An impact turns the speed, u+ = -e u-, and leaves z: against scipy with events, over three impacts."""

    def motion(_, x):
        y, v, c, p = x
        return v, -9.81 + (0.1 * c - 0.2 * p) / 0.5, v - 3 * c, 20 * (y - p)

    def falls(_, x):
        return x[0]

    falls.terminal, falls.direction = True, -1
    t, x, impacts = 0.0, np.array([1.0, 0.0, 0.2, 0.0]), 0
    while t < 1.4:
        found = solve_ivp(motion, (t, 1.4), x, events=falls, rtol=1e-11, atol=1e-13)
        t, x = found.t[-1], found.y[:, -1].copy()
        if found.status == 1:
            x[:2] = 1e-15, -0.6 * x[1]
            impacts += 1
    run = eomgen.simulate(eomgen.loads(BOUNCING), time=1.4, **FINE)
    assert impacts == 3
    assert run.x[-1] == pytest.approx(x, rel=1e-7, abs=1e-8)
    assert run.certify().ok
