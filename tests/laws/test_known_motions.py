"""Simulated motions of the systems in models/ against closed forms and first integrals."""

from __future__ import annotations

import numpy as np
import pytest
from known_answers import MODELS
from scipy.linalg import eigh

import eomgen

pytestmark = pytest.mark.slow


def motion(name: str, time: float, **options):
    """States by name along a simulation, n each, and the parameters' values."""
    model = eomgen.load(MODELS / f"{name}.toml")
    trajectory = eomgen.simulate(model, time=time, **options)
    assert trajectory.status == "finished", trajectory.message
    named = dict(zip((*trajectory.coordinates, *trajectory.speeds), trajectory.x.T, strict=True))
    return trajectory.t, named, model.numeric_parameters()


def test_a_thrown_particle_follows_its_parabola():
    """ch16-p1: x = v0 t, y = H - g t^2/2."""
    t, x, p = motion("seeds/ch16_p1", 2.0)
    assert x["x"] == pytest.approx(p["v0"] * t)
    assert x["y"] == pytest.approx(p["H"] - p["g"] * t**2 / 2)


def test_linear_drag_slows_a_throw_exponentially():
    """ch16-p2: x = v0 cos(alpha) (1 - e)/k;  y = (v0 sin(alpha) + g/k)(1 - e)/k - g t/k, with e = exp(-k t)."""
    t, x, p = motion("seeds/ch16_p2", 3.0)
    k, g, v0, alpha = (p[name] for name in ("k", "g", "v0", "alpha"))
    faded = (1 - np.exp(-k * t)) / k
    assert alpha == pytest.approx(np.pi / 4)
    assert x["x"] == pytest.approx(v0 * np.cos(alpha) * faded, abs=1e-7)
    assert x["y"] == pytest.approx((v0 * np.sin(alpha) + g / k) * faded - g * t / k, abs=1e-7)


def test_a_throw_from_a_round_earth_keeps_energy_and_sweeps_equal_areas():
    """ch16-p3: (rho'^2 + rho^2 psi'^2)/2 - g R^2/rho and rho^2 psi' are constant."""
    _, x, p = motion("seeds/ch16_p3", 500.0)
    swept = x["rho"] ** 2 * x["psi'"]
    energy = (x["rho'"] ** 2 + x["rho"] ** 2 * x["psi'"] ** 2) / 2 - p["g"] * p["R"] ** 2 / x["rho"]
    assert swept == pytest.approx(swept[0], rel=1e-8)
    assert energy == pytest.approx(energy[0], rel=1e-8)
    assert x["rho"].max() > 1.1 * p["R"]


@pytest.mark.parametrize("start", [0.3, 1.5])
def test_a_particle_on_a_wire_obeys_the_energy_theorem(start):
    """ch16-p4: theta'^2 = 2 g/l (cos(theta) - cos(theta_0)); below the horizontal the wire stays taut."""
    _, x, p = motion("seeds/ch16_p4", 2.0, start={"theta": start, "theta'": 0.0})
    known = 2 * p["g"] / p["l"] * (np.cos(x["theta"]) - np.cos(start))
    assert x["theta'"] ** 2 == pytest.approx(known, abs=1e-6)


def test_a_launched_disc_turns_clockwise_at_its_own_rate():
    """ch17-p1: y = R + x tan(alpha) - g x^2/(2 v0^2 cos(alpha)^2), theta = omega0 t."""
    t, x, p = motion("seeds/ch17_p1", 1.0)
    slope, fall = np.tan(p["alpha"]), p["g"] / (2 * p["v0"] ** 2 * np.cos(p["alpha"]) ** 2)
    assert x["y"] == pytest.approx(p["R"] + x["x"] * slope - fall * x["x"] ** 2)
    assert x["theta"] == pytest.approx(p["omega0"] * t)


def test_the_end_of_a_thrown_rod_moves_with_its_centre_and_its_turning():
    """ch17-p2 after 2 s: v_B = (-2 sin 8, -7.62 - 2 cos 8) m/s, from omega = -4 rad/s and v_C = -7.62 m/s."""
    _, x, p = motion("seeds/ch17_p2", 2.0)
    theta, omega = x["theta"][-1], x["theta'"][-1]
    v_B = np.array([-p["l"] * np.sin(theta) * omega, x["y'"][-1] + p["l"] * np.cos(theta) * omega])
    assert omega == pytest.approx(-4)
    assert v_B == pytest.approx([-2 * np.sin(8), -7.62 - 2 * np.cos(8)])


def test_a_falling_bar_obeys_the_energy_theorem():
    """ch17-p3: theta'^2 = 3 g/l sin(theta)."""
    _, x, p = motion("seeds/ch17_p3", 1.0)
    assert x["theta'"] ** 2 == pytest.approx(3 * p["g"] / p["l"] * np.sin(x["theta"]), abs=1e-6)


def test_a_rolling_disc_and_its_bar_obey_the_energy_theorem():
    """ch22-p1: (6 + 13.5 cos^2 theta) R theta'^2 = 6 g (cos(theta_0) - cos(theta)), from rest."""
    _, x, p = motion("seeds/ch22_p1", 0.6)
    left = (6 + 13.5 * np.cos(x["theta"]) ** 2) * p["R"] * x["theta'"] ** 2
    assert left == pytest.approx(6 * p["g"] * (np.cos(0.2) - np.cos(x["theta"])), abs=1e-6)


def test_a_stepped_drum_turns_uniformly_faster():
    """ch22-p4: theta = 2/13 g/R t^2."""
    t, x, p = motion("seeds/ch22_p4", 1.0)
    assert x["theta"] == pytest.approx(2 / 13 * p["g"] / p["R"] * t**2)


def test_the_horizontal_momentum_of_a_rolling_disc_and_its_bar_is_kept():
    """ch22-p5: x is cyclic, 6 M (x' + R cos(theta) theta') is constant (rolling resists by its spin too)."""
    _, x, p = motion("seeds/ch22_p5", 2.0)
    assert x["x'"] + p["R"] * np.cos(x["theta"]) * x["theta'"] == pytest.approx(np.zeros_like(x["x"]), abs=1e-7)


@pytest.mark.parametrize("name", ["simple_pendulum", "double_pendulum", "elastic_pendulum", "two_mass_oscillator"])
def test_a_conservative_classic_keeps_its_energy(name):
    """|E - E(0)| stays within 1e-6 of the energies that are exchanged."""
    trajectory = eomgen.simulate(eomgen.load(MODELS / f"{name}.toml"), time=5.0)
    assert trajectory.drift is not None and trajectory.drift < 1e-6


def test_a_spherical_pendulum_keeps_its_moment_about_the_vertical():
    """phi is cyclic: m l^2 sin(theta)^2 phi' is constant."""
    _, x, _ = motion("spherical_pendulum", 5.0)
    moment = np.sin(x["theta"]) ** 2 * x["phi'"]
    assert moment == pytest.approx(moment[0], rel=1e-7)


def test_an_atwood_machine_falls_uniformly_faster():
    """s = (m1 - m2) g t^2 / (2 (m1 + m2 + M/2))."""
    t, x, p = motion("atwood", 1.0)
    known = (p["m1"] - p["m2"]) * p["g"] / (p["m1"] + p["m2"] + p["M"] / 2) * t**2 / 2
    assert x["s"] == pytest.approx(known)


def test_two_masses_between_springs_move_in_their_modes():
    """x(t) = sum over modes of v (v.M x0) cos(omega t), with K v = omega^2 M v and v.M v = 1."""
    t, x, p = motion("two_mass_oscillator", 4.0)
    K = np.array([[p["k1"] + p["k2"], -p["k2"]], [-p["k2"], p["k2"] + p["k3"]]])
    M = np.diag([p["m1"], p["m2"]])
    squares, modes = eigh(K, M)
    weights = modes.T @ M @ np.array([0.1, 0.0])
    known = (modes * weights) @ np.cos(np.sqrt(squares)[:, None] * t)
    assert x["x1"] == pytest.approx(known[0], abs=1e-7)
    assert x["x2"] == pytest.approx(known[1], abs=1e-7)


def test_a_bead_leaves_the_bottom_of_a_fast_hoop():
    """theta'^2/2 - omega^2 sin(theta)^2/2 - g/R cos(theta) is constant (Jacobi's integral; the energy is not)."""
    _, x, p = motion("bead_on_turning_hoop", 3.0)
    jacobi = x["theta'"] ** 2 / 2 - p["omega"] ** 2 * np.sin(x["theta"]) ** 2 / 2 - p["g"] / p["R"] * np.cos(x["theta"])
    assert jacobi == pytest.approx(jacobi[0], rel=1e-7)
    assert x["theta"].max() > 0.5 and x["psi"][-1] == pytest.approx(p["omega"] * 3.0)


def test_a_cart_takes_the_force_of_its_input():
    """With the pole massless in effect (m = 1e-12) a cart pushed by F = 2 N moves x = F t^2/(2 M)."""
    text = (MODELS / "cart_pole.toml").read_text().replace("F = { value = 0,", "F = { value = 2,")
    trajectory = eomgen.simulate(eomgen.loads(text), time=1.0, parameters={"m": 1e-12})
    assert trajectory.x[:, 0] == pytest.approx(trajectory.t**2, abs=1e-8)
