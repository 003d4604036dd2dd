"""Bodies in a fluid: against terminal velocities, glides, released spheres, Kirchhoff's and Munk's closed forms."""

from __future__ import annotations

import math
import textwrap

import numpy as np
import pytest

import eomgen
from eomgen.errors import ModelError
from eomgen.results import free_bodies

pytestmark = pytest.mark.slow

PARTICLE = """
eomgen = 1
space = "plane"
parameters = { m = 0.8, rho = 1.2, A = 0.3, c = 0.9, g = 9.81 }
coordinates = { x = 0, y = 0 }
bodies.b = { shape = { kind = "particle", mass = "m" }, joint = { kind = "placed", at = ["x", "y"] } }
forces.weight = { kind = "gravity", acceleration = [0, "-g"] }
"""
FREE = """
eomgen = 1
space = "plane"
parameters = { m = 4, J = 0.5, a = 0.7, d = 5, j = 0.2 }
coordinates = { x = { speed = 2 }, y = 0, th = 0.3 }
bodies.b = { mass = "m", inertia = "J", joint = { kind = "free", x = "x", y = "y", angle = "th" } }
forces.water = { kind = "added_mass", point = "b.origin", diagonal = ["a", "d", "j"] }
"""


def end_of(text: str, time: float, *names: str) -> list[float]:
    run = eomgen.simulate(eomgen.loads(text), time=time, target="numpy", rtol=1e-11, atol=1e-11)
    assert run.ok
    return [float(run[name][-1]) for name in names]


def begun(text: str) -> dict[str, float]:
    """{name of a speed: its rate at the start}"""
    rhs = eomgen.derive(eomgen.loads(text)).rhs("numpy")
    dx = rhs(0.0, rhs.x0, rhs.p0)
    return dict(zip(rhs.speeds, dx[len(rhs.coordinates) :], strict=False))


def test_a_falling_body_comes_to_its_terminal_velocity():
    """v = v_t tanh(g t/v_t), v_t^2 = 2 m g/(rho c A)."""
    air = 'forces.air = { kind = "drag", point = "b.center", density = "rho", area = "A", coefficient = "c" }'
    v_t = math.sqrt(2 * 0.8 * 9.81 / (1.2 * 0.9 * 0.3))
    assert end_of(PARTICLE + air, 0.9, "y'")[0] == pytest.approx(-v_t * math.tanh(9.81 * 0.9 / v_t), rel=1e-9)


def test_a_body_drifts_with_the_wind_that_carries_it():
    """w' = - k w^2 of the velocity against the wind: w = w_0/(1 + k w_0 t)."""
    air = 'forces.air = { kind = "drag", point = "b.center", density = "rho", area = "A", coefficient = "c", '
    text = PARTICLE.replace("g = 9.81", "g = 0") + air + "medium = [6, 0] }"
    k = 1.2 * 0.9 * 0.3 / (2 * 0.8)
    assert end_of(text, 2, "x'")[0] == pytest.approx(6 - 6 / (1 + k * 6 * 2), rel=1e-9)


@pytest.mark.parametrize("more", ["", ', chord = [3, 0], drag = "0.2*cos(0*alpha)"'])
def test_a_glide_goes_down_by_drag_over_lift(more):
    """tan gamma = c_D/c_L, u^2 = 2 m g/(rho A sqrt(c_L^2 + c_D^2)): steady from the start."""
    drag = more or ', drag = "0.2"'
    u = math.sqrt(2 * 0.8 * 9.81 / (1.2 * 0.3 * math.hypot(1.1, 0.2)))
    gamma = math.atan2(0.2, 1.1)
    wing = f'forces.wing = {{ kind = "plate", point = "b.center", density = "rho", area = "A", lift = "1.1"{drag} }}'
    start = f"x = {{ speed = {u * math.cos(gamma)!r} }}, y = {{ speed = {-u * math.sin(gamma)!r} }}"
    assert list(begun((PARTICLE + wing).replace("x = 0, y = 0", start)).values()) == pytest.approx([0, 0], abs=1e-12)


@pytest.mark.parametrize("space", ["plane", "space"])
def test_the_angle_of_attack_is_that_of_the_chord_against_the_way(space):
    """A plate that is turned up by 0.2 and moves along x has alpha = 0.2: F = rho/2 A u^2 c_L(0.2) upwards."""
    text = PARTICLE.replace("g = 9.81", "g = 0").replace("x = 0, y = 0", "x = { speed = 5 }, y = 0")
    text = text.replace('{ shape = { kind = "particle", mass = "m" }', '{ mass = "m", inertia = 1')
    text = text.replace('"placed", at = ["x", "y"]', '"placed", at = ["x", "y"], angle = 0.2')
    if space == "space":
        text = (
            text.replace('"plane"', '"space"')
            .replace('[0, "-g"]', '[0, "-g", 0]')
            .replace("inertia = 1", "inertia = [1, 1, 1]")
        )
        text = text.replace('at = ["x", "y"]', 'at = ["x", "y", 0], axis = [0, 0, 1]')
    wing = 'forces.wing = { kind = "plate", point = "b.center", density = "rho", area = "A", lift = "3*alpha + alpha^2"'
    wing += ", normal = [0, 2, 0] }" if space == "space" else " }"
    x, y = begun(text + wing).values()
    assert y == pytest.approx(0.6 * 0.3 * 25 * (0.6 + 0.04) / 0.8, rel=1e-12) and x == pytest.approx(0, abs=1e-12)


def test_a_light_sphere_rises_by_its_own_and_half_the_mass_of_water():
    """a = (rho V - m) g/(m + rho V/2)."""
    water = """
    forces.lift = { kind = "buoyancy", point = "b.center", density = 1000, volume = 2e-3, acceleration = [0, "-g"] }
    forces.water = { kind = "added_mass", point = "b.center", diagonal = [1, 1, 0] }
    """
    assert begun(PARTICLE + water)["y'"] == pytest.approx((2 - 0.8) * 9.81 / (0.8 + 1), rel=1e-12)


def test_a_sphere_of_the_density_of_water_moves_with_it():
    """(m + m_a) a = (m_a + rho V) U': with m = rho V it follows any unsteady stream."""
    G = 'acceleration = [0, "-g"]'
    stream = 'medium = ["3*sin(2*t)", "t^2"]'
    water = f"""
    forces.lift = {{ kind = "buoyancy", point = "b.center", density = 1000, volume = 8e-4, {stream}, {G} }}
    forces.water = {{ kind = "added_mass", point = "b.center", diagonal = [0.4, 0.4, 0], {stream} }}
    """
    vx, y = end_of(PARTICLE + water, 1.3, "x'", "y")
    assert vx == pytest.approx(3 * math.sin(2.6), rel=1e-9) and y == pytest.approx(1.3**3 / 3, rel=1e-9)


def test_a_hull_is_turned_across_its_way():
    """Munk: (J + j) theta'' = (m_x - m_y) u v in its axes, u = U cos(theta), v = - U sin(theta); none at 0."""
    due = (0.7 - 5) * (2 * math.cos(0.3)) * (-2 * math.sin(0.3)) / 0.7
    assert begun(FREE)["th'"] == pytest.approx(due, rel=1e-12)
    assert begun(FREE.replace("th = 0.3", "th = 0"))["th'"] == 0


def test_impulse_and_energy_of_a_body_in_an_ideal_fluid_are_kept():
    """Kirchhoff: the impulse in ground axes, R ((m + m_x) u, (m + m_y) v), and T stay constant."""
    run = eomgen.simulate(eomgen.loads(FREE), time=4, target="numpy", rtol=1e-11, atol=1e-11)
    th, vx, vy = run["th"], run["x'"], run["y'"]
    u, v = np.cos(th) * vx + np.sin(th) * vy, np.cos(th) * vy - np.sin(th) * vx
    P = np.cos(th) * 4.7 * u - np.sin(th) * 9 * v
    assert run.ok and np.ptp(run.energy) < 1e-8 and np.ptp(P) < 1e-8 and np.ptp(th) > 0.5


def test_an_ellipsoid_in_space_keeps_turning_about_its_axis():
    """Kirchhoff in space, 6 rows: along x, an axis of the matrix, there is no moment; askew the one of Munk about z."""
    text = """
    eomgen = 1
    space = "space"
    coordinates = { x = { speed = 2 }, y = 0, z = 0, a = { start = ANGLE }, b = 0, d = { speed = 0 } }
    [bodies.b]
    mass = 4
    inertia = [1, 2, 3]
    joint = { kind = "free", position = ["x", "y", "z"], orientation = "zyx", angles = ["a", "b", "d"] }
    [forces.water]
    kind = "added_mass"
    point = "b.center"
    matrix = ROWS
    """
    rows = np.diag([1, 5, 5, 1, 2, 2.0])
    rows[1, 5] = rows[5, 1] = 0.5
    text = text.replace("ROWS", str(rows.tolist()))
    assert begun(text.replace("ANGLE", "0"))["a'"] == pytest.approx(0, abs=1e-12)
    u, v = 2 * math.cos(0.3), -2 * math.sin(0.3)
    M, due = np.array([[9, 0.5], [0.5, 5]]), np.array([0, (1 - 5) * u * v])
    assert begun(text.replace("ANGLE", "0.3"))["a'"] == pytest.approx(np.linalg.solve(M, due)[1], rel=1e-10)


BAD = [
    ('diagonal = ["a", "d", "j"]', 'diagonal = ["a", "d"]', "3 or 6 entries"),
    ('diagonal = ["a", "d", "j"]', "matrix = [[1, 2, 0], [3, 1, 0], [0, 0, 1]]", "not symmetric"),
    ('diagonal = ["a", "d", "j"]', "diagonal = [1, 2, 3, 4, 5, 6]", "in plane it has 3"),
    ('diagonal = ["a", "d", "j"]', "diagonal = [-1, 2, 3]", "negative"),
    ('diagonal = ["a", "d", "j"]', 'diagonal = [{ value = 1, unit = "kg*m" }, 2, 3]', "kg"),
    ("b.origin", "O", "no point of a body"),
]


@pytest.mark.parametrize(("old", "new", "message"), BAD)
def test_what_cannot_be_an_added_mass_is_refused_by_name(old, new, message):
    """What, where, and how to mend it."""
    text = FREE.replace(old, new) + "points.O = [0, 0]\n"
    with pytest.raises(ModelError, match=message):
        eomgen.loads(text)


# -------- reactions -------------------------------------------------------------------------------------------


PENDULUM = """
eomgen = 1
space = "plane"
parameters = { m = 2, m_a = 1.5, l = 0.8, g = 9.81, F = 7 }
coordinates = { th = { start = 0.5, speed = 1.2 } }
bodies.bob = { mass = "m", center = ["l", 0], inertia = 0, joint = { kind = "revolute", angle = "th - pi/2" } }
forces.weight = { kind = "gravity", acceleration = [0, "-g"] }
forces.water = { kind = "added_mass", point = "bob.center", diagonal = ["m_a", "m_a", 0] }
forces.lift = { kind = "force", point = "bob.center", force = [0, "F"] }
"""


def test_the_hinge_of_a_pendulum_under_water_bears_its_added_mass():
    """Along the rod (m + m_a) l w^2 + (m g - F) cos(th), across it nothing; (m + m_a) l th'' = (F - m g) sin(th)."""
    found = eomgen.reactions(eomgen.loads(PENDULUM), at="th = 0.6")
    assert found.certify().ok
    pull, fell = 2 * 9.81 - 7, math.cos(0.6) - math.cos(0.5)
    along = 3.5 * (0.8 * 1.2**2 + 2 * pull / 3.5 * fell) + pull * math.cos(0.6)
    due = (-along * math.sin(0.6), along * math.cos(0.6))
    assert [found[f"reaction_{axis}(bob)"].value for axis in "xy"] == pytest.approx(due, rel=1e-12)


def test_a_bob_that_is_cut_free_shows_the_push_of_the_water():
    """The water pushes it by - m_a a, a force of its own at the point to which the added mass belongs."""
    found = free_bodies(eomgen.loads(PENDULUM))
    (push,) = (force for force in found.entries()["bodies"]["bob"] if force["name"] == "fluid(water)")
    th, w = 0.5, 1.2
    a = (7 - 2 * 9.81) * math.sin(th) / (3.5 * 0.8)
    due = np.array([math.cos(th), math.sin(th)]) * a * 0.8 + np.array([-math.sin(th), math.cos(th)]) * 0.8 * w * w
    assert found.certify().ok
    assert push["value"] * np.array(push["direction"])[:2] == pytest.approx(-1.5 * due, rel=1e-9)


AROUND = np.array(
    [
        [2, 0, 0, 0, 0, 0],
        [0, 7, 0.3, 0.1, 0, 0.5],
        [0, 0.3, 6, 0, -0.4, 0],
        [0, 0.1, 0, 0.2, 0.02, 0.01],
        [0, 0, -0.4, 0.02, 0.9, 0.03],
        [0, 0.5, 0, 0.01, 0.03, 1.1],
    ]
)
ARM = f"""
eomgen = 1
space = "space"
coordinates = {{ th = {{ start = 0.4, speed = 1.3 }} }}
[bodies.arm]
mass = 3
inertia = [0.2, 0.5, 0.6, 0.05, 0.03, 0.04]
center = [0.6, 0.1, 0.05]
points = {{ P = [0.7, 0.02, -0.03] }}
joint = {{ kind = "revolute", axis = [0, 0, 1], angle = "th" }}
[forces.weight]
kind = "gravity"
acceleration = [0, -9.81, 0]
[forces.water]
kind = "added_mass"
point = "arm.P"
matrix = {AROUND.tolist()}
medium = ["0.5 + 0.2*t", "0.3*t^2 - 0.4", "0.1*t - 0.6"]
[outputs]
a = "th''"
"""


def test_the_hinge_of_an_arm_under_water_bears_what_newton_and_euler_say():
    """f = -(p' + w x p), n = -(L' + w x L + v x p) at P, (p, L) = A (v, w), v that against the stream: Munk's moment in
    it; 4 s, as all formulas are long."""
    names = [f"reaction_{couple}{axis}(arm)" for couple in ("", "couple_") for axis in "xyz"]
    answers = eomgen.solve(eomgen.loads(ARM + "".join(f'o{k} = "{name}"\n' for k, name in enumerate(names))))
    th, w, wd = 0.4, np.array([0, 0, 1.3]), np.array([0, 0, answers["a"].value])
    R = np.array([[np.cos(th), -np.sin(th), 0], [np.sin(th), np.cos(th), 0], [0, 0, 1]])
    C, P, U, rate = map(np.array, ([0.6, 0.1, 0.05], [0.7, 0.02, -0.03], [0.5, -0.4, -0.6], [0.2, 0, 0.1]))
    I = np.array([[0.2, 0.05, 0.04], [0.05, 0.5, 0.03], [0.04, 0.03, 0.6]])
    v, vd = np.cross(w, P) - R.T @ U, np.cross(wd, P) - R.T @ rate + np.cross(w, R.T @ U)
    p, L, pd, Ld = *np.split(AROUND @ [*v, *w], 2), *np.split(AROUND @ [*vd, *wd], 2)
    f, n = -(pd + np.cross(w, p)), -(Ld + np.cross(w, L) + np.cross(v, p))
    push = 3 * (np.cross(wd, C) + np.cross(w, np.cross(w, C)) + R.T @ [0, 9.81, 0])
    force, couple = push - f, I @ wd + np.cross(w, I @ w) + np.cross(C, push) - n - np.cross(P, f)
    due = [*(R @ force), *(R @ couple)]
    assert due[5] == pytest.approx(0, abs=1e-12)
    assert [answers[f"o{k}"].value for k in range(6)] == pytest.approx(due, rel=1e-10, abs=1e-10)


def test_a_towed_sled_rubs_on_the_bottom_of_a_pond():
    """(m + m_a) a = F - mu m g: the friction is that of its weight, the force of the rope at rest does not know m_a."""
    text = """
    eomgen = 1
    space = "plane"
    parameters = { m = 4, m_a = 3, mu = 0.2, g = 9.81, F = 20 }
    coordinates = { x = { speed = 2 } }
    bodies.sled = { shape = { kind = "particle", mass = "m" }, joint = { kind = "placed", at = ["x", 0] } }
    forces.weight = { kind = "gravity", acceleration = [0, "-g"] }
    forces.water = { kind = "added_mass", point = "sled.center", diagonal = ["m_a", "m_a", 0] }
    forces.tow = { kind = "force", point = "sled.center", force = ["F", 0] }
    constraints.bottom = { kind = "support", point = "sled.center", normal = [0, 1], friction = "mu" }
    outputs = { a = "x''", N = "reaction_n(bottom)" }
    """
    answers = eomgen.solve(eomgen.loads(text))
    assert answers["a"].value == pytest.approx((20 - 0.2 * 4 * 9.81) / 7, rel=1e-12)
    assert abs(answers["N"].value) == pytest.approx(4 * 9.81, rel=1e-12)


def test_a_hinge_takes_the_impulse_of_the_water():
    """A stop in the hinge, e = 0.5: its couple (m + m_a) l^2 (1 + e) w and the force (m + m_a) l (1 + e) w."""
    text = PENDULUM.replace('"th - pi/2" }', '"th - pi/2", limits = [-9, "-pi/3"], restitution = 0.5 }')
    run = eomgen.simulate(eomgen.loads(text), time=0.05, target="numpy", rtol=1e-11, atol=1e-11)
    (hit,) = run.impacts
    w = math.sqrt(1.2**2 + 2 * (2 * 9.81 - 7) / (3.5 * 0.8) * (math.cos(math.pi / 6) - math.cos(0.5)))
    P, th = 3.5 * 0.8 * 1.5 * w, math.pi / 6
    due = {"impulse_x(bob)": -P * math.cos(th), "impulse_y(bob)": -P * math.sin(th)}
    assert {name: hit.impulses[name] for name in due} == pytest.approx(due, rel=1e-8)


STREAM = FREE.replace('kind = "free", x = "x", y = "y", angle = "th"', 'kind = "revolute", angle = "th"')
STREAM = STREAM.replace("x = { speed = 2 }, y = 0, ", "").replace('"j"]', '"j"], medium = [2, 0]')


def test_a_hull_in_a_steady_stream_rests_along_it_or_across_it():
    """Munk: (m_x - m_y) U^2 sin(th) cos(th) = 0; along the stream th'' = (m_y - m_x) U^2 th/(J + j)."""
    places = eomgen.statics(eomgen.loads(STREAM)).places
    angles = sorted(abs(float(th)) for place in places for th in place.numbers.values())
    assert angles == pytest.approx([0, math.pi / 2, math.pi / 2, math.pi], abs=1e-12)
    small = eomgen.linearize(eomgen.loads(STREAM.replace("th = 0.3", "th = 0.1")))
    grows = math.sqrt((5 - 0.7) * 4 / 0.7)
    assert max(x.real for x in np.linalg.eigvals(np.array(small.A, float))) == pytest.approx(grows, rel=1e-9)
    assert small.certify().ok


def test_the_reactions_beside_an_added_mass_at_a_point_that_moves_in_its_body_are_refused_by_name():
    """Along that way the fluid pushes no body."""
    text = PENDULUM.replace("center = ", 'points = { P = ["l*cos(s)", 0] }, center = ').replace(
        "th = {", "s = 0, th = {"
    )
    text = text.replace("bob.center", "bob.P", 1) + "outputs.A = 'reaction_x(bob)'\n"
    answer = eomgen.solve(eomgen.loads(text))["A"]
    assert answer.value is None and "water" in answer.message


def test_a_wrong_equation_names_the_fluid_whose_inertia_it_lacks():
    """Of two energies that are given the one that is missing, by its own name."""
    text = """
    eomgen = 1
    space = "plane"
    parameters = { m = 2, ma = 3, J = 1 }
    coordinates = { x = 0 }
    [bodies.hull]
    mass = "m"
    joint = { kind = "prismatic", axis = [1, 0], displacement = "x" }
    [forces]
    water = { kind = "added_mass", point = "hull.origin", diagonal = ["ma", 0, 0] }
    wheel = { kind = "kinetic", energy = "J*x'^2/2" }
    pull = { kind = "force", point = "hull.origin", force = [5, 0] }
    """
    verdict = eomgen.verify(eomgen.loads(textwrap.dedent(text)), "(m + J)*x'' = 5")
    assert any("of water" in cause.text for cause in verdict.causes)
    assert not any("of wheel" in cause.text for cause in verdict.causes)
