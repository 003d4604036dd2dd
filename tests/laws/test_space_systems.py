"""The systems of space in models/ against published numbers, closed forms and a float solution from the textbook."""

from __future__ import annotations

from collections.abc import Mapping
from functools import cache
from pathlib import Path

import numpy as np
import pytest
from float_space import Joint, Tree, jacobi, limits_of_nutation, of_quaternion, platform_of_delta, turn
from slow_run import in_slow_run, usual

import eomgen
from eomgen.equations import Equations

pytestmark = pytest.mark.slow

MODELS = Path(__file__).parents[2] / "models"
RANDOM = np.random.default_rng(7)


@cache
def model(name: str) -> eomgen.Model:
    return eomgen.load(MODELS / f"{name}.toml")


@cache
def equations(name: str) -> Equations:
    return eomgen.derive(model(name))


@cache
def parameters(name: str) -> Mapping[str, float]:
    rhs = equations(name).rhs("numpy")
    return dict(zip(rhs.parameters, map(float, rhs.p0), strict=True))


@cache
def answers(name: str) -> Mapping[str, eomgen.Answer]:
    return eomgen.solve(model(name))


def value(name: str, output: str) -> float:
    found = answers(name)[output].value
    assert found is not None, answers(name)[output].message
    return found


def slope(name: str, x, *, t: float = 0.0, inputs=()) -> np.ndarray:
    """(q', u') at a state."""
    rhs = equations(name).rhs("numpy")
    return rhs(t, np.asarray(x, float), rhs.p0, inputs)


SYSTEMS = (
    "heavy_top",
    "sleeping_top",
    "tumbling_body",
    "gimbal_gyroscope",
    "gyrocompass",
    "dual_spin_satellite",
    "satellite_wheels",
    "space_manipulator",
    "quadrotor",
    "balancing_robot",
    "half_car",
    "furuta_pendulum",
    "foucault_pendulum",
    "trifilar_pendulum",
    "tower_crane",
    "cardan_shaft",
    "flyball_governor",
    "delta_robot",
    "puma560",
)


@pytest.mark.parametrize("name", usual([*SYSTEMS], 3))
def test_every_output_is_answered(name):
    """A user who runs solve gets a number for all that the file asks."""
    missing = {output: answer.message for output, answer in answers(name).items() if answer.value is None}
    assert not missing


# -- tops and gyroscopes ---------------------------------------------------------------------------------


def test_a_top_let_go_nutates_between_the_roots_of_the_cubic():
    """(1 - u^2)(alpha - beta u) = (b - a u)^2, u = cos(theta); there phi' = 2 m g d/(I_3 w_3)."""
    p = parameters("heavy_top")
    mgd = p["m"] * p["g"] * p["d"]
    low, high = limits_of_nutation(p["I_t"], p["I_3"], mgd, p["theta_0"], p["w_3"])
    assert low == pytest.approx(p["theta_0"])
    assert np.radians(value("heavy_top", "theta_2")) == pytest.approx(high, rel=1e-9)
    assert value("heavy_top", "phi_d_2") == pytest.approx(2 * mgd / (p["I_3"] * p["w_3"]), rel=1e-9)
    run = eomgen.simulate(model("heavy_top"), time=1, rtol=1e-10)
    assert np.max(run["theta"]) == pytest.approx(high, abs=1e-4)
    assert np.min(run["theta"]) == pytest.approx(low, abs=1e-4)


@pytest.mark.parametrize("rate", ["slow", "fast"])
def test_a_top_precesses_steadily_at_two_rates(rate):
    """I_t cos(theta) phi'^2 - I_3 w_3 phi' + m g d = 0: no nutation from there."""
    p, precession = parameters("heavy_top"), value("heavy_top", rate)
    spin = p["w_3"] - precession * np.cos(p["theta_0"])
    run = eomgen.simulate(model("heavy_top"), time=1, start={"phi'": precession, "psi'": spin}, rtol=1e-10)
    assert np.ptp(run["theta"]) < 1e-7
    assert run["phi"][-1] == pytest.approx(precession, rel=1e-7)


@pytest.mark.parametrize(("spin", "stable"), [(126, True), (124, False)])
def test_a_top_sleeps_above_the_critical_spin(spin, stable):
    """s^2 + i I_3 w/I_t s - m g d/I_t = 0, stable for (I_3 w)^2 > 4 I_t m g d (w > 125.28 rad/s)."""
    p = parameters("sleeping_top")
    C, A, mgd = p["I_3"], p["I_t"], p["m"] * p["g"] * p["d"]
    text = (MODELS / "sleeping_top.toml").read_text().replace("w = { value = 150", f"w = {{ value = {spin}")
    small = eomgen.linearize(eomgen.loads(text))
    found = np.linalg.eigvals(small.small.state_matrix)
    expected = np.roots([1, 1j * C * spin / A, -mgd / A])
    for s in expected:
        assert np.min(abs(found - s)) == pytest.approx(0, abs=1e-5)
    assert bool(np.max(found.real) < 1e-5) is stable


def test_the_frequencies_of_a_sleeping_top():
    """omega = (I_3 w -+ sqrt((I_3 w)^2 - 4 I_t m g d))/(2 I_t)."""
    p = parameters("sleeping_top")
    H = p["I_3"] * p["w"]
    root = np.sqrt(H**2 - 4 * p["I_t"] * p["m"] * p["g"] * p["d"])
    expected = [(H - root) / (2 * p["I_t"]), (H + root) / (2 * p["I_t"])]
    assert [value("sleeping_top", f"omega_{k}") for k in (1, 2)] == pytest.approx(expected)


def test_a_tumbling_body_follows_the_elliptic_functions():
    """w_1 = dn, w_2 = sn, w_3 = cn of p (t - t_0); through w_2 = 0 after K/p."""
    from scipy.special import ellipk

    p = parameters("tumbling_body")
    I, w = [p["I_1"], p["I_2"], p["I_3"]], [p["eps"], p["w_0"], 0]
    found = [value("tumbling_body", f"w{k}_later") for k in (1, 2, 3)]
    assert found == pytest.approx(jacobi(I, w, 5), abs=1e-6)
    c, b, a = I
    T2, L2 = np.dot(I, np.square(w)), np.sum(np.square(np.multiply(I, w)))
    k2 = (b - a) * (T2 * c - L2) / ((c - b) * (L2 - T2 * a))
    assert value("tumbling_body", "quarter") == pytest.approx(
        ellipk(k2) / np.sqrt((c - b) * (L2 - T2 * a) / (a * b * c)), rel=1e-7
    )
    run = eomgen.simulate(model("tumbling_body"), time=30, rtol=1e-10, atol=1e-12)
    exact = np.array([jacobi(I, w, t) for t in run.t])
    assert run.x[:, -3:] == pytest.approx(exact, abs=1e-5)


def test_a_gyroscope_in_gimbals_has_the_equations_of_its_rings():
    """d/dt((A_o + (A_i + A) cos^2 + C_i sin^2) alpha' + H sin) = tau, H = C (phi' + alpha' sin) = const."""
    p = parameters("gimbal_gyroscope")
    A_o, across, C_i, C = p["A_o"], p["A_i"] + p["A"], p["C_i"], p["C"]
    for _ in range(10):
        alpha, beta, phi, wa, wb, wf, tau = RANDOM.uniform(-2, 2, 7)
        *_, aa, ab, af = slope("gimbal_gyroscope", [alpha, beta, phi, wa, wb, wf], inputs=[tau])
        s, c = np.sin(beta), np.cos(beta)
        H = C * (wf + wa * s)
        outer = (A_o + across * c**2 + C_i * s**2) * aa + 2 * (C_i - across) * s * c * wa * wb + H * c * wb
        assert outer == pytest.approx(tau, rel=1e-9)
        assert (p["B_i"] + p["A"]) * ab == pytest.approx(wa**2 * s * c * (C_i - across) + H * c * wa, rel=1e-9)
        assert C * (af + aa * s + wa * wb * c) == pytest.approx(0, abs=1e-12)
    nutation = C * p["n"] / np.sqrt((A_o + across) * (p["B_i"] + p["A"]))
    assert value("gimbal_gyroscope", "nutation") == pytest.approx(nutation)


def test_a_gyrocompass_swings_about_the_north():
    """A theta'' = -(H Omega cos(lat) - A Omega^2 cos(lat)^2 cos(theta)) sin(theta)."""
    p = parameters("gyrocompass")
    along = p["Omega"] * np.cos(p["lat"])
    for theta, wt, wf in RANDOM.uniform(-1, 1, (5, 3)):
        found = slope("gyrocompass", [0, theta, 0, wt, 2000 * wf])
        H = p["C"] * (2000 * wf + along * np.cos(theta))
        torque = -(H - p["A"] * along * np.cos(theta)) * along * np.sin(theta)
        assert found[3] == pytest.approx(torque / p["A"], rel=1e-9, abs=1e-15)


def test_a_dual_spin_satellite_nutates_by_its_angular_momentum():
    """omega^2 = (h - A w)(h - B w)/(A B), h = (C + J) w + J n."""
    p = parameters("dual_spin_satellite")
    h = (p["C"] + p["J"]) * p["w"] + p["J"] * p["n"]
    nutation = np.sqrt((h - p["A"] * p["w"]) * (h - p["B"] * p["w"]) / (p["A"] * p["B"]))
    assert sorted([nutation, p["w"]])[1] == pytest.approx(value("dual_spin_satellite", "nutation"))


# -- vehicles --------------------------------------------------------------------------------------------


def test_a_quadrotor_obeys_newton_and_euler():
    """m v' = R (0, 0, F) - m g e_z;  I w' + w x I w = sum r x f + drag;  it hovers with m g/4 on each rotor."""
    p = parameters("quadrotor")
    I, l = np.array([p["Ix"], p["Iy"], p["Iz"]]), p["l"]
    rhs = equations("quadrotor").rhs("numpy")
    assert rhs(0, rhs.x0, rhs.p0) == pytest.approx(np.zeros(13), abs=1e-12)
    rotors = [(l, -l), (-l, -l), (-l, l), (l, l)]
    for _ in range(10):
        e = RANDOM.normal(size=4)
        e /= np.linalg.norm(e)
        v, w, f = RANDOM.normal(size=3), RANDOM.normal(size=3), RANDOM.uniform(0, 0.2, 4)
        found = slope("quadrotor", [0, 0, 0, *e, *v, *w], inputs=f)
        torque = sum(np.cross([*place, 0], [0, 0, thrust]) for place, thrust in zip(rotors, f, strict=True))
        torque += np.array([0, 0, p["c"] * (-f[0] + f[1] - f[2] + f[3])])
        assert found[7:10] == pytest.approx(of_quaternion(e) @ [0, 0, sum(f)] / p["m"] - [0, 0, p["g"]])
        assert found[10:] == pytest.approx((torque - np.cross(w, I * w)) / I)
        turned = np.array([-e[1:] @ w, *(e[0] * w + np.cross(e[1:], w))]) / 2
        assert found[3:7] == pytest.approx(turned)


def test_reaction_wheels_turn_a_satellite():
    """tau T/J3 and tau T^2/J3 for the manoeuvre; J w' + w x (J w + h) = -u, J_w (s'' + w') = u at any state."""
    p = parameters("satellite_wheels")
    J = np.array([p["J1"], p["J2"], p["J3"]])
    assert value("satellite_wheels", "w3_half") == pytest.approx(p["tau"] * p["T"] / p["J3"], rel=1e-6)
    assert np.radians(value("satellite_wheels", "turned")) == pytest.approx(p["tau"] * p["T"] ** 2 / p["J3"], rel=1e-6)
    assert value("satellite_wheels", "H_z") == pytest.approx(0, abs=1e-9)
    e = np.array([1, 2, -1, 0.5]) / 2.5
    for rates, w, u in RANDOM.normal(size=(5, 3, 3)):
        names = equations("satellite_wheels").speeds
        speeds = dict(zip((*(f"s{k}'" for k in (1, 2, 3)), *(f"w{k}" for k in (1, 2, 3))), (*rates, *w), strict=True))
        found = slope("satellite_wheels", [*e, 0, 0, 0, *(speeds[x] for x in names)], inputs=u)[7:]
        found = dict(zip(names, found, strict=True))
        w_d = np.array([found[f"w{k}"] for k in (1, 2, 3)])
        s_dd = np.array([found[f"s{k}'"] for k in (1, 2, 3)])
        h = p["J_w"] * (rates + w)
        assert J * w_d == pytest.approx(-np.cross(w, J * w + h) - u)
        assert p["J_w"] * (s_dd + w_d) == pytest.approx(u)


def test_half_a_car_bounces_and_pitches_as_published():
    """Rao, Mechanical Vibrations: 5.8593 and 9.4341 rad/s; X/Theta = 2.6461 and 0.3061, of opposite sign."""
    small = eomgen.linearize(model("half_car"))
    found, shapes = np.linalg.eig(small.small.state_matrix)
    order = [k for k in np.argsort(found.imag) if found[k].imag > 0]
    assert found[order].imag == pytest.approx([5.8593, 9.4341], abs=5e-5)
    ratios = np.real(shapes[0, order] / shapes[1, order])
    assert ratios == pytest.approx([2.6461, -0.3061], abs=5e-5)


def robot() -> Tree:
    """x, y, heading, lean, wheels: each wheel turns by itself, rolling is a constraint."""
    p = parameters("balancing_robot")
    wheel = {"axis": (0, 1, 0), "mass": p["m_w"], "inertia": (p["K"], p["J"], p["K"])}
    body = Joint(2, (0, 1, 0), mass=p["m_b"], center=(0, 0, p["l"]), inertia=(p["I_x"], p["I_y"], p["I_z"]))
    return Tree(
        [
            Joint(-1, (1, 0, 0), slides=True),
            Joint(0, (0, 1, 0), slides=True),
            Joint(1, (0, 0, 1)),
            body,
            Joint(2, at=(0, p["b"], 0), **wheel),
            Joint(2, at=(0, -p["b"], 0), **wheel),
        ],
        p["g"],
    )


def test_a_balancing_robot_moves_as_its_free_parts_with_rolling_wheels():
    """Newton and Euler of body and wheels with the rows of rolling as constraints: s'', theta'', psi''."""
    p, tree = parameters("balancing_robot"), robot()
    r, b = p["r"], p["b"]

    def rolling(q):
        s, c = np.sin(q[2]), np.cos(q[2])
        return np.array([[-s, c, 0, 0, 0, 0], [c, s, -b, 0, -r, 0], [c, s, b, 0, 0, -r]])

    for psi, theta, s, dpsi, dtheta, ds, left, right in RANDOM.uniform(-1, 1, (10, 8)):
        q = np.array([0, 0, psi, theta, (s - b * psi) / r, (s + b * psi) / r])
        u = np.array([ds * np.cos(psi), ds * np.sin(psi), dpsi, dtheta, (ds - b * dpsi) / r, (ds + b * dpsi) / r])
        a = tree.held(q, u, rolling, np.array([0, 0, 0, -left - right, left, right]))
        names = equations("balancing_robot").coordinates
        values = {"psi": psi, "theta": theta, "s": s, "x": 0, "y": 0}
        x = [*(values[n] for n in names), dpsi, dtheta, ds]
        assert equations("balancing_robot").speeds == ("psi'", "theta'", "s'")
        along = np.cos(psi) * a[0] + np.sin(psi) * a[1]
        assert slope("balancing_robot", x, inputs=[left, right])[5:] == pytest.approx([a[2], a[3], along], rel=1e-9)


# -- pendulums -------------------------------------------------------------------------------------------


def test_the_furuta_pendulum_is_that_of_cazzolato_and_prime():
    """Their equations 33 and 34 with J0 = J1 + m1 l1^2 + m2 L1^2, J2^ = J2 + m2 l2^2, and damping."""
    p = parameters("furuta_pendulum")
    m2, L1, l2 = p["m2"], p["L1"], p["l2"]
    J0, Jh = p["J1"] + p["m1"] * p["l1"] ** 2 + m2 * L1**2, p["J2"] + m2 * l2**2
    for t1, t2, w1, w2, tau in RANDOM.uniform(-3, 3, (10, 5)):
        a1, a2 = slope("furuta_pendulum", [t1, t2, w1, w2], inputs=[tau])[2:]
        s, c = np.sin(t2), np.cos(t2)
        arm = a1 * (J0 + Jh * s**2) + m2 * L1 * l2 * (a2 * c - w2**2 * s) + w1 * w2 * Jh * 2 * s * c + p["b1"] * w1
        bob = a1 * m2 * L1 * l2 * c + a2 * Jh - w1**2 * Jh * s * c + p["b2"] * w2 + m2 * p["g"] * l2 * s
        assert [arm, bob] == pytest.approx([tau, 0], abs=1e-9)
    assert value("furuta_pendulum", "K22") == pytest.approx(-m2 * p["g"] * l2)


def test_the_swing_of_foucault_turns_with_the_sine_of_the_latitude():
    """About where it rests its swing turns by -Omega sin(lat) t; the equations are those of a driven tree."""
    from scipy.optimize import brentq

    p = parameters("foucault_pendulum")
    axis = (0, np.cos(p["lat"]), np.sin(p["lat"]))
    tree = Tree([Joint(-1, axis), Joint(0, (0, -1, 0)), Joint(1, (1, 0, 0), mass=p["m"], center=(0, 0, -p["l"]))])

    def accelerations(alpha, beta, wa, wb, t):
        pull = p["m"] * p["g"] * p["l"]
        Q = -pull * np.array([0, np.sin(alpha) * np.cos(beta), np.cos(alpha) * np.sin(beta)])
        q, u = np.array([p["Omega"] * t, alpha, beta]), np.array([p["Omega"], wa, wb])
        return tree.accelerations(q, u, Q, driven=[0])[1:]

    for alpha, beta, wa, wb, t in RANDOM.uniform(-0.8, 0.8, (5, 5)):
        found = slope("foucault_pendulum", [p["Omega"] * t, alpha, beta, wa, wb], t=t)[3:]
        assert found == pytest.approx(accelerations(alpha, beta, wa, wb, t))
    rest = brentq(lambda beta: accelerations(0, beta, 0, 0, 0)[1], -0.1, 0.1)
    period = 2 * np.pi * np.sqrt(p["l"] / p["g"])
    run = eomgen.simulate(model("foucault_pendulum"), time=10 * period, start={"beta": rest})
    last = run.t > 9 * period
    swing = np.cov(run["alpha"][last], run["beta"][last])
    direction = np.arctan2(2 * swing[0, 1], swing[0, 0] - swing[1, 1]) / 2
    assert direction == pytest.approx(-p["Omega"] * np.sin(p["lat"]) * np.mean(run.t[last]), rel=0.01)


def test_three_wires_measure_a_moment_of_inertia():
    """sqrt(g/l) twice, and R sqrt(m g/(I_z l)), exact; at rest each wire carries a third of the weight."""
    found = answers("trifilar_pendulum")
    assert [found[f"omega_{k}"].exact for k in (1, 3)] == ["sqrt(g/l)", "R*sqrt(m*g/(I_z*l))"]
    assert found["T_A"].value == pytest.approx(5 * 9.81 / 3)


def crane() -> Tree:
    p = parameters("tower_crane")
    load = {"mass": p["m"], "center": (0, 0, -p["l"])}
    return Tree([Joint(-1, (0, 0, 1)), Joint(0, (0, -1, 0), at=(p["r"], 0, 0)), Joint(1, (1, 0, 0), **load)], p["g"])


def test_a_slewing_crane_throws_its_load_out():
    """g tan(alpha) = n^2 (r + l sin(alpha)); at any state the accelerations of the driven tree."""
    from scipy.optimize import brentq

    p = parameters("tower_crane")
    for alpha, beta, wa, wb in RANDOM.uniform(-1, 1, (10, 4)):
        a = crane().accelerations(np.array([0, alpha, beta]), np.array([p["n"], wa, wb]), driven=[0])
        assert slope("tower_crane", [0, alpha, beta, wa, wb])[3:] == pytest.approx(a[1:])
    rest = brentq(lambda x: p["g"] * np.tan(x) - p["n"] ** 2 * (p["r"] + p["l"] * np.sin(x)), 0, 1)
    run = eomgen.simulate(model("tower_crane"), time=20, start={"alpha": rest})
    assert np.ptp(run["alpha"]) < 1e-7
    assert np.ptp(run["beta"]) < 1e-7


# -- loops, chains, arms ---------------------------------------------------------------------------------


def test_a_cardan_shaft_turns_unevenly():
    """w2/w1 = cos(delta)/(1 - sin(delta)^2 sin(phi)^2), tan(psi) = cos(delta) tan(phi) (Poisson)."""
    p = parameters("cardan_shaft")
    assert value("cardan_shaft", "ratio") == pytest.approx(np.cos(p["delta"]))
    run = eomgen.simulate(model("cardan_shaft"), time=1)
    phi, psi = run["phi"], run["psi"]
    expected = np.arctan2(np.sin(phi) * np.cos(p["delta"]), np.cos(phi))
    assert np.cos(psi - expected) == pytest.approx(np.ones(len(phi)), abs=1e-9)
    ratio = np.cos(p["delta"]) / (1 - np.sin(p["delta"]) ** 2 * np.sin(p["n"] * 0.1) ** 2)
    assert value("cardan_shaft", "w_quarter") == pytest.approx(p["n"] * ratio, rel=1e-7)


def governor() -> Tree:
    """Shaft, slider, rods with balls at their ends."""
    p = parameters("flyball_governor")
    m, M, a, b, L = p["m_r"], p["m_b"], p["a"], p["b"], p["L"]
    center = (m / 2 + M) * L / (m + M)
    across = m * (L**2 + a**2) / 12 + m * (L / 2 - center) ** 2 + M * (L - center) ** 2
    rod = {"mass": m + M, "inertia": (m * a**2 / 6, across, across)}
    return Tree(
        [
            Joint(-1, (0, 0, 1), mass=m, inertia=(m * (L**2 + a**2) / 12, m * (L**2 + a**2) / 12, m * a**2 / 6)),
            Joint(0, (0, 0, 1), slides=True, mass=p["m_s"], inertia=(p["m_s"] * b**2 / 6,) * 3),
            Joint(0, (0, 1, 0), at=(b / 2, 0, L), center=(center, 0, 0), **rod),
            Joint(0, (0, -1, 0), at=(-b / 2, 0, L), center=(-center, 0, 0), **rod),
        ],
        p["g"],
    )


def governed(tree: Tree, x: np.ndarray) -> np.ndarray:
    """(q', u') with springs and dampers from the slider to the middles of the rods."""
    p, (q, u) = parameters("flyball_governor"), np.split(x, 2)
    Q = np.zeros(4)
    for rod, side in ((2, 1), (3, -1)):
        ends = ((1, (side * p["b"] / 2, 0, 0)), (rod, (side * p["L"] / 2, 0, 0)))
        (R1, p1), (R2, p2) = (tree.frames(q)[body] for body, _ in ends)
        d = p2 + R2 @ ends[1][1] - p1 - R1 @ ends[0][1]
        J = tree.jacobian(q, *ends[1])[0] - tree.jacobian(q, *ends[0])[0]
        r = np.linalg.norm(d)
        Q -= (p["k"] * (r - p["l_0"]) + p["c"] * (d @ J @ u) / r) * (J.T @ d) / r
    return np.concatenate([u, tree.accelerations(q, u, Q)])


@in_slow_run
def test_the_stiff_governor_moves_as_a_stiff_solver_says():
    """The data of A05, no reference solution of it: the state after 0.1 s by Radau on the textbook's equations."""
    from scipy.integrate import solve_ivp

    tree = governor()
    rhs = equations("flyball_governor").rhs("numpy")
    shift = rhs.x0 + np.array([0.3, 0.01, 0.02, -0.01, 0.5, 0.2, -0.3, 0.1])
    for x in (rhs.x0, shift):
        assert rhs(0, x, rhs.p0) == pytest.approx(governed(tree, x), rel=1e-8, abs=1e-8)
    oracle = solve_ivp(lambda t, x: governed(tree, x), (0, 0.1), rhs.x0, method="Radau", rtol=1e-7, atol=1e-9)
    run = eomgen.simulate(model("flyball_governor"), time=0.1)
    assert run.x[-1] == pytest.approx(oracle.y[:, -1], abs=1e-5)


def test_a_space_manipulator_keeps_its_momenta():
    """H = 0 and P = 0 for good; at the start the accelerations are those of the tree with a base of six joints."""
    assert [value("space_manipulator", x) for x in ("H_z", "P_x")] == pytest.approx([0, 0], abs=1e-6)
    p = parameters("space_manipulator")
    m, size = p["m_0"], np.array([1, 1.2, 0.8])
    base = m / 12 * (size @ size - size**2)

    def link(on, at, mass, l, along):
        across = mass * l**2 / 12
        return Joint(on, (0, -1, 0), at, mass=mass, center=(l / 2, 0, 0), inertia=(along, across, across))

    links = [link(6, (0, 0, 0), p["m_1"], p["l_1"], 0.02), link(7, (p["l_1"], 0, 0), p["m_2"], p["l_2"], 0.01)]
    turning = [Joint(k + 2, axis) for k, axis in enumerate([(1, 0, 0), (0, 1, 0)])]
    tree = Tree(
        [
            *(Joint(k - 1, axis, slides=True) for k, axis in enumerate(np.eye(3))),
            *turning,
            Joint(4, (0, 0, 1), mass=m, inertia=base),
            Joint(5, (0, 0, 1), at=(0.5, 0, 0.4)),
            *links,
        ]
    )
    state = equations("space_manipulator").rhs("numpy")
    speeds = equations("space_manipulator").speeds
    for t, torques in ((0.0, (0.3, -0.2)), (0.0, (-1.0, 2.0))):
        q = np.array([0] * 7 + [0.4, -0.8])
        Q = np.array([0] * 7 + [*torques])
        a = tree.accelerations(q, np.zeros(9), Q, driven=[6])
        found = dict(zip(speeds, state(t, state.x0, state.p0, torques)[10:], strict=True))
        names = ("x'", "y'", "z'", "w1", "w2", "w3", "q2'", "q3'")
        assert [found[n] for n in names] == pytest.approx([*a[:6], *a[7:]], rel=1e-9, abs=1e-12)


@pytest.mark.parametrize(
    ("motors", "place"),
    [
        ((0, 0, 0), (0, 0, -1.065)),
        ((-20.5, -20.5, -20.5), (0, 0, -0.9)),
        ((47.5, -11.6, 21.4), (0.3, 0.5, -1.1)),
    ],
)
def test_the_platform_of_a_delta_robot_is_where_published(motors, place):
    """R. L. Williams II, The Delta Parallel Robot, to the digits given; to 1e-9 where three spheres meet below."""
    p = parameters("delta_robot")
    text = (MODELS / "delta_robot.toml").read_text()
    for k, (old, angle) in enumerate(zip((0, 10, 20), motors, strict=True), start=1):
        written = f"theta{k} = {{ start = {old}, unit"
        assert written in text
        text = text.replace(written, f"theta{k} = {{ start = {angle}, unit")
    for name, x in zip("xyz", place, strict=True):
        text = text.replace(
            f"{name} = {{ dependent = true, near = {0 if name != 'z' else -1.1} }}",
            f"{name} = {{ dependent = true, near = {x} }}",
        )
    rhs = eomgen.derive(eomgen.loads(text)).rhs("numpy")
    start = dict(zip(rhs.coordinates, rhs.x0, strict=False))
    found = [start[name] for name in "xyz"]
    assert found == pytest.approx(place, abs=2e-3)
    assert found == pytest.approx(platform_of_delta(np.radians(motors), p["w_B"], p["L"], p["l"], p["u_P"]), abs=1e-9)


def test_the_puma_has_the_inertias_and_weights_of_armstrong():
    """Armstrong, Khatib & Burdick 1986: a12, a13 and the weights.

    Not compared, as these data give other constants: a11 (2.69 and 1.60 for 2.57 and 1.38), a22, a23, a33 (0.02 less).
    """
    assert equations("puma560").coordinates == tuple(f"q{k}" for k in range(1, 7))
    for q in RANDOM.uniform(-3, 3, (5, 6)):
        C2, S2 = np.cos(q[1]), np.sin(q[1])
        C23, S23 = np.cos(q[1] + q[2]), np.sin(q[1] + q[2])
        M = _mass(q)
        assert M[0, 1] == pytest.approx(0.690 * S2 - 0.134 * C23 + 0.0238 * C2, abs=0.01)
        assert M[0, 2] == pytest.approx(-0.134 * C23 - 0.00397 * S23, abs=0.01)
        fore = -8.44 * S23 + 0.249 * C23 - 0.0282 * (S23 * np.cos(q[4]) + C23 * np.cos(q[3]) * np.sin(q[4]))
        assert _forces(q)[1:3] == pytest.approx([37.2 * C2 - 1.02 * S2 - fore, -fore], abs=0.05)


def _at(q: np.ndarray, entries) -> np.ndarray:
    from eomgen.symbolic.numeric.evaluation import FLOAT, evaluate

    symbols = equations("puma560").graph.symbols
    state = dict(zip(symbols.x, (*q, *np.zeros(6)), strict=True))
    state |= {node: parameters("puma560")[name] for name, node in symbols.parameters.items()}
    state |= dict.fromkeys(symbols.inputs.values(), 0.0)
    return np.array(evaluate(tuple(entries), state, FLOAT), dtype=float)


def _mass(q: np.ndarray) -> np.ndarray:
    return _at(q, (x for row in equations("puma560").graph.M for x in row)).reshape(6, 6)


def _forces(q: np.ndarray) -> np.ndarray:
    return _at(q, equations("puma560").graph.Q)


def test_the_puma_falls_as_the_tree_of_its_links():
    """All six accelerations at random states, M and c by the textbook."""
    p = parameters("puma560")
    down, up = turn((1, 0, 0), -np.pi / 2), turn((1, 0, 0), np.pi / 2)
    z = (0, 0, 1)
    tree = Tree(
        [
            Joint(-1, z, inertia=(0, 0, 0.35), armature=1.14),
            Joint(
                0,
                z,
                at=(0, p["d2"], 0),
                turned=down,
                mass=17.4,
                center=(0.068, 0.006, -0.016),
                inertia=(0.13, 0.524, 0.539),
                armature=4.71,
            ),
            Joint(
                1,
                z,
                at=(p["a2"], 0, p["d3"]),
                mass=4.8,
                center=(0, -0.07, 0.014),
                inertia=(0.066, 0.0125, 0.066),
                armature=0.83,
            ),
            Joint(
                2,
                z,
                at=(p["a3"], -p["d4"], 0),
                turned=up,
                mass=0.82,
                center=(0, 0, -0.019),
                inertia=(0.0018, 0.0018, 0.0013),
                armature=0.2,
            ),
            Joint(3, z, turned=down, mass=0.34, inertia=(0.0003, 0.0003, 0.0004), armature=0.179),
            Joint(
                4, z, turned=up, mass=0.09, center=(0, 0, 0.032), inertia=(0.00015, 0.00015, 0.00004), armature=0.193
            ),
        ],
        p["g"],
    )
    for q, u in RANDOM.uniform(-2, 2, (5, 2, 6)):
        assert slope("puma560", [*q, *u])[6:] == pytest.approx(tree.accelerations(q, u), rel=1e-8, abs=1e-8)
