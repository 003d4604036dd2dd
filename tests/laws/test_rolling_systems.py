"""The rolling systems of models/ against closed forms and published numbers."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from slow_run import in_slow_run

import eomgen

pytestmark = pytest.mark.slow

MODELS = Path(__file__).parents[2] / "models"


def model(name: str) -> eomgen.Model:
    return eomgen.load(MODELS / f"{name}.toml")


def turn(k: int, angle: float) -> np.ndarray:
    """The matrix of a turn about axis k."""
    i, j = (k + 1) % 3, (k + 2) % 3
    R = np.eye(3)
    R[[i, j], [i, j]] = np.cos(angle)
    R[j, i], R[i, j] = np.sin(angle), -np.sin(angle)
    return R


@pytest.mark.parametrize(
    "name",
    [
        "golf_ball_in_cup",
        "rolling_cone",
        "skate_on_slope",
        "tippe_top",
        "snakeboard",
        "roller_racer",
        "robot_with_trailer",
    ],
)
def test_a_rolling_system_is_certified(name):
    assert eomgen.derive(model(name)).certify().ok


# -- the bicycle far from straight running -----------------------------------------------------------

# Basu-Mandal, Chatterjee & Papadopoulos, Hands-free circular motions of a benchmark bicycle, Proc. R. Soc. A 463 (2007)
# 1983-2003: a state with its accelerations. Axes of the rear frame: x forwards, y down, z to the left; ground: z up;
# x, y, z of the rear wheel's centre, angles of the sequence zxz, steer, turns of the rear and the front wheel.
PLACE = (0, 0, 0.2440472102925, 0, 0.9501292851472, 3.1257073014894, 0.2311385135743, 0, 0)
RATES = (
    -2.8069345714545,
    -0.1480982396001,
    0.1058778746261,
    0.7830033527065,
    0.6068425835418,
    -0.0119185528069,
    0.4859824687093,
    8.9129896614890,
    8.0133620584155,
)
ACCELERATIONS = (
    -0.5041626315047,
    -0.3449706619454,
    -1.4604528332980,
    0.8353281706379,
    -7.8555281128244,
    0.1205543897884,
    -4.6198904039403,
    1.8472554144217,
    2.4548072904550,
)


def zxz(theta: float, psi: float, phi: float) -> np.ndarray:
    return turn(2, theta) @ turn(0, psi) @ turn(2, phi)


def test_the_nonlinear_bicycle_has_the_published_accelerations():
    """The table of Basu-Mandal et al. (2007), written for the model's own axes: x forwards, y right, z down."""
    G, P = np.diag([1.0, -1, -1]), np.array([[1.0, 0, 0], [0, 0, 1], [0, -1, 0]])  # ground; frame: v_there = P v_here
    R = G @ zxz(*PLACE[3:6]) @ P
    phi, (psi, theta) = np.arcsin(R[2, 1]), (np.arctan2(-R[0, 1], R[1, 1]), np.arctan2(-R[2, 0], R[2, 2]))
    assert turn(2, psi) @ turn(0, phi) @ turn(1, theta) == pytest.approx(R)
    h = 1e-6
    q, u = np.array(PLACE[3:6]), np.array(RATES[3:6])
    skew = R.T @ G @ (zxz(*(q + h * u)) - zxz(*(q - h * u))) @ P / (2 * h)
    w = np.array([skew[2, 1], skew[0, 2], skew[1, 0]])  # of the frame, its own axes
    own = np.array(
        [
            [-np.sin(theta) * np.cos(phi), np.cos(theta), 0],
            [np.sin(phi), 0, 1],
            [np.cos(theta) * np.cos(phi), np.sin(theta), 0],
        ]
    )
    found = (-PLACE[6], -PLACE[7], -PLACE[8])  # steer and turns count about axes that point the other way
    x = [*(G @ PLACE[:3]), psi, phi, theta, *found, *(G @ RATES[:3]), *np.linalg.solve(own, w), *(-np.array(RATES[6:]))]
    rhs = eomgen.derive(model("whipple_bicycle")).rhs("numpy")
    assert rhs.coordinates == ("x", "y", "z", "psi", "phi", "theta", "delta", "theta_R", "theta_F")
    a = rhs(0.0, np.array(x), rhs.p0)[9:]
    assert G @ a[:3] == pytest.approx(ACCELERATIONS[:3], rel=1e-8)
    assert -a[6:] == pytest.approx(ACCELERATIONS[6:], rel=1e-8)


# -- balls -------------------------------------------------------------------------------------------


def test_a_golf_ball_comes_up_again_out_of_the_cup():
    """z = -5/2 g/Omega^2 (1 - cos(sqrt(2/7) Omega t)), whatever the radii: Gualtieri et al. (2006)."""
    run = eomgen.simulate(model("golf_ball_in_cup"), time=2, samples=50)
    Omega, g = 30, 9.81
    assert run["z"] == pytest.approx(-2.5 * g / Omega**2 * (1 - np.cos(np.sqrt(2 / 7) * Omega * run.t)), abs=1e-8)
    assert run["phi"] == pytest.approx(Omega * run.t)


def test_jelletts_quantity_of_a_tippe_top_stays_while_it_turns_over():
    """d/dt (L.r) = 0 with r from the mass centre to the contact, whatever the friction; energy falls: Or (1994)."""
    run = eomgen.simulate(model("tippe_top"), time=1.5, samples=100)
    m, R, e = 0.015, 0.025, 0.003
    A, C = 0.4 * m * R**2, 0.44 * m * R**2
    theta, psi_rate, phi_rate = run["theta"], run["psi'"], run["phi'"]
    spin = C * (phi_rate + psi_rate * np.cos(theta))  # L about its axis; about the vertical A psi' sin^2 + spin cos
    jellett = R * (A * psi_rate * np.sin(theta) ** 2 + spin * np.cos(theta)) - e * spin
    assert jellett == pytest.approx(np.full(len(run.t), jellett[0]), rel=1e-7)
    assert np.max(np.diff(run.energy)) < 1e-12 and run.energy[-1] < run.energy[0]
    assert theta[-1] > 2.5


# -- edges, cones, vehicles --------------------------------------------------------------------------


def test_a_rolling_cone_swings_as_landau_and_lifshitz_say():
    """T = 3/40 m h^2 phi'^2 (1 + 5 cos^2 alpha), omega^2 = 5 g cos(alpha) sin(slope)/(h (1 + 5 cos^2 alpha))."""
    answers = eomgen.solve(model("rolling_cone"))
    assert answers["T"].exact == "3/40*m*h^2*(1 + 5*cos(alpha)^2)*phi'^2"
    alpha, slope = np.deg2rad(25), np.deg2rad(20)
    square = 5 * 9.81 * np.cos(alpha) * np.sin(slope) / (0.3 * (1 + 5 * np.cos(alpha) ** 2))
    assert answers["omega_1"].value == pytest.approx(np.sqrt(square))


def test_a_skate_on_a_slope_runs_along_a_cycloid():
    """x = g sin(alpha)/(2 omega^2) sin^2(omega t), y = g sin(alpha)/(2 omega^2) (omega t - sin(2 omega t)/2)."""
    run = eomgen.simulate(model("skate_on_slope"), time=3, samples=40)
    m, omega, pull = 0.7, 2, 9.81 * np.sin(np.deg2rad(15))
    turned, size = omega * run.t, pull / (2 * omega**2)
    assert run["x"] == pytest.approx(size * np.sin(turned) ** 2, abs=1e-8)
    assert run["y"] == pytest.approx(size * (turned - np.sin(2 * turned) / 2), abs=1e-8)
    assert run["reaction_n(edge)"] == pytest.approx(2 * m * pull * np.sin(turned), abs=1e-7)


def test_a_trailer_folds_out_along_the_tractrix():
    """On a straight way tan(gamma/2) = tan(gamma_0/2) exp(-x/l); rows that say the same twice do no harm."""
    with pytest.warns(RuntimeWarning, match="indeterminate"):  # which wheel of an axle holds it sideways
        run = eomgen.simulate(model("robot_with_trailer"), time=4, samples=30)
    assert np.tan(run["gamma"] / 2) == pytest.approx(np.tan(0.5) * np.exp(-run["x"] / 0.8), rel=1e-7)
    assert run["theta"] == pytest.approx(np.zeros(30), abs=1e-9)


def multiplier_motion(mass, force, rows, x0, T):
    """q(T) of M(q, t) a = force(q, u, t) + J^T lam, J u = 0, by a fine Runge-Kutta method in plain numpy."""

    def rate(t, x):
        n = len(x) // 2
        q, u = x[:n], x[n:]
        J, gamma = rows(q, u, t)
        k = len(J)
        KKT = np.block([[mass(q, t), -J.T], [J, np.zeros((k, k))]])
        return np.concatenate([u, np.linalg.solve(KKT, np.concatenate([force(q, u, t), -gamma]))[:n]])

    x, steps = np.array(x0, dtype=float), 4000
    h = T / steps
    for i in range(steps):
        t = i * h
        k1 = rate(t, x)
        k2 = rate(t + h / 2, x + h / 2 * k1)
        k3 = rate(t + h / 2, x + h / 2 * k2)
        k4 = rate(t + h, x + h * k3)
        x = x + h / 6 * (k1 + 2 * k2 + 2 * k3 + k4)
    return x


@in_slow_run
def test_a_snakeboard_is_moved_by_its_rider():
    """Maximal equations of board, flywheel and wheels in x, y, theta with two knife edges, by plain numpy."""
    m, J, J_r, J_w, reach = 6, 0.016, 0.072, 0.0013, 0.2

    def rows(q, u, t):
        phi, phi_rate = 0.5 + 0.3 * np.sin(3 * t), 0.9 * np.cos(3 * t)
        found, gamma = [], []
        for side in (1, -1):
            arm = side * reach * np.array([-np.sin(q[2]), np.cos(q[2])])  # d(place)/d theta
            arm_rate = -side * reach * np.array([np.cos(q[2]), np.sin(q[2])]) * u[2]
            heading, turning = q[2] + side * phi, u[2] + side * phi_rate
            n, d = np.array([-np.sin(heading), np.cos(heading)]), np.array([np.cos(heading), np.sin(heading)])
            v = u[:2] + arm * u[2]
            found.append([*n, n @ arm])
            gamma.append(n @ arm_rate * u[2] - turning * (d @ v))
        return np.array(found), np.array(gamma)

    inertia = np.diag([m, m, J + J_r + 2 * J_w])

    def force(q, u, t):  # the flywheel's psi''; the wheels turn against each other
        return np.array([0, 0, 6.3 * J_r * np.sin(3 * t)])

    end = multiplier_motion(lambda q, t: inertia, force, rows, np.zeros(6), 2.0)
    run = eomgen.simulate(model("snakeboard"), time=2, samples=2)
    assert [run[name][-1] for name in ("x", "y", "theta", "theta'")] == pytest.approx([*end[:3], end[5]], rel=1e-7)


@in_slow_run
def test_a_roller_racer_is_moved_by_its_handlebar():
    """Seat with mass, handlebar with a moment of inertia alone, two knife edges; phi(t) given; by plain numpy."""
    m, I_1, I_2, l_1, l_2 = 40, 2, 0.3, 0.5, 0.2

    def given(t):
        return np.pi / 4 * np.sin(4 * t), np.pi * np.cos(4 * t), -4 * np.pi * np.sin(4 * t)

    def rows(q, u, t):
        phi, phi_rate, phi_acceleration = given(t)
        heading, turning = q[2] + phi, u[2] + phi_rate
        n_0, d_0 = np.array([-np.sin(q[2]), np.cos(q[2])]), np.array([np.cos(q[2]), np.sin(q[2])])
        n, d = np.array([-np.sin(heading), np.cos(heading)]), np.array([np.cos(heading), np.sin(heading)])
        v = u[:2] + l_1 * n_0 * u[2] + l_2 * n * turning
        J = np.array([[*n_0, 0], [*n, n @ n_0 * l_1 + l_2]])
        at_rest = -l_1 * d_0 * u[2] ** 2 - l_2 * d * turning**2 + l_2 * n * phi_acceleration
        return J, np.array([-u[2] * (d_0 @ u[:2]), n @ at_rest - turning * (d @ v)])

    inertia = np.diag([m, m, I_1 + I_2])

    def force(q, u, t):
        return np.array([0, 0, -I_2 * given(t)[2]])

    start = [0, 0, 0, 0, 0, -np.pi * l_2 / (l_1 + l_2)]
    end = multiplier_motion(lambda q, t: inertia, force, rows, start, 2.0)
    run = eomgen.simulate(model("roller_racer"), time=2, samples=2)
    found = [run[name][-1] for name in ("x", "y", "theta", "x'", "y'", "theta'")]
    assert found == pytest.approx(end, rel=1e-6, abs=1e-8)
