"""Tyres: against the linear bicycle model, relaxation along the way, the magic formula, and a wheel that rolls."""

from __future__ import annotations

import math

import numpy as np
import pytest

import eomgen
from eomgen.errors import ModelError

pytestmark = pytest.mark.slow

m, J, a, b, V, C_f, C_r = 1400, 2300, 1.1, 1.6, 25, 9e4, 8e4
CAR = f"""
eomgen = 1
space = "plane"
inputs.delta = 0
coordinates = {{ x = {{ speed = {V} }}, y = 0, psi = 0 }}
[bodies.car]
mass = {m}
inertia = {J}
points = {{ front = [{a}, 0], rear = [-{b}, 0] }}
joint = {{ kind = "free", x = "x", y = "y", angle = "psi" }}
[forces.front]
kind = "tyre"
point = "car.front"
heading = ["cos(delta)", "sin(delta)"]
lateral = {{ stiffness = {C_f} }}
[forces.rear]
kind = "tyre"
point = "car.rear"
lateral = {{ stiffness = {C_r} }}
"""


def rates(text: str, *inputs: float, **start: float) -> dict[str, float]:
    """{name: its rate} at the start, from other values."""
    rhs = eomgen.derive(eomgen.loads(text)).rhs("numpy")
    names = [*rhs.coordinates, *rhs.speeds, *rhs.states]
    x = np.array([start.get(name, x) for name, x in zip(names, rhs.x0, strict=True)])
    return dict(zip(names, rhs(0.0, x, rhs.p0, inputs), strict=True))


def test_a_car_turns_steadily_by_its_understeer_gradient():
    """delta = L/R + K V^2/R, K = (m/L)(b/C_f - a/C_r): with r = V/R and its drift nothing changes, to first order."""
    L, delta = a + b, 1e-5
    K = m / L * (b / C_f - a / C_r)
    r = V * delta / (L + K * V * V)
    beta = (b - m * a * V * V / (L * C_r)) * r / V
    found = rates(CAR, delta, **{"y'": beta * V, "psi'": r})
    assert found["psi'"] == pytest.approx(0, abs=1e-7 * delta * C_f * a / J)
    assert found["y'"] == pytest.approx(V * r, rel=1e-6)


def test_a_car_drifts_as_the_linear_bicycle_model_says():
    """The eigenvalues of lateral velocity and yaw rate, from differences of the equations of motion."""
    rhs = eomgen.derive(eomgen.loads(CAR)).rhs("numpy")

    def of(v: float, r: float) -> np.ndarray:
        x = np.array(rhs.x0)
        x[4:6] = v, r
        found = rhs(0.0, x, rhs.p0, (0.0,))
        return np.array([found[4] - V * r, found[5]])

    h = 1e-5
    A = np.column_stack([(of(h, 0) - of(-h, 0)) / (2 * h), (of(0, h) - of(0, -h)) / (2 * h)])
    N = a * C_f - b * C_r
    due = [[-(C_f + C_r) / (m * V), -V - N / (m * V)], [-N / (J * V), -(a * a * C_f + b * b * C_r) / (J * V)]]
    assert pytest.approx(np.array(due), rel=1e-6) == A


WHEEL = """
eomgen = 1
space = "plane"
coordinates = { x = { motion = "7*t" }, y = { motion = "0.35*t" } }
bodies.hub = { mass = 1, inertia = 1, joint = { kind = "placed", at = ["x", "y"] } }
forces.tyre = { kind = "tyre", point = "hub.origin", lateral = { stiffness = 1e4, relaxation = 0.6 } }
"""


def test_the_slip_of_a_tyre_relaxes_along_its_way():
    """tan alpha (1 - exp(-x/l)), whatever the speed."""
    run = eomgen.simulate(eomgen.loads(WHEEL), time=0.2, target="numpy", rtol=1e-11, atol=1e-12)
    assert run["tyre_slip"] == pytest.approx(0.05 * (1 - np.exp(-7 * run.t / 0.6)), abs=1e-9)
    still = WHEEL.replace("7*t", "0").replace("0.35*t", "0")
    run = eomgen.simulate(eomgen.loads(still), time=0.2, start={"tyre_slip": 0.03}, target="numpy")
    assert run["tyre_slip"][-1] == 0.03


LOOSE = """
eomgen = 1
space = "plane"
parameters = { V = 12, v = 0.9 }
coordinates = { x = { speed = "V" }, y = { speed = "v" }, th = { motion = "0" } }
bodies.hub = { mass = 20, inertia = 1, joint = { kind = "free", x = "x", y = "y", angle = "th" } }
forces.tyre = { kind = "tyre", point = "hub.origin", lateral = { B = 9, C = 1.3, D = 4000, E = -0.4 } }
"""


def test_the_magic_formula_is_that_of_the_books():
    """D sin(C atan(B s - E (B s - atan(B s)))), to the side of alpha, ahead of kappa with its own numbers."""

    def formula(s: float, B: float, C: float, D: float, E: float) -> float:
        return D * math.sin(C * math.atan(B * s - E * (B * s - math.atan(B * s))))

    alpha = math.atan(0.9 / 12)
    assert rates(LOOSE)["y'"] == pytest.approx(-formula(alpha, 9, 1.3, 4000, -0.4) / 20, rel=1e-12)
    ahead = ", longitudinal = { B = 11, C = 1.6, D = 4400 }, rolling = 12.6 }"
    text = LOOSE.replace("E = -0.4 } }", "E = -0.4 }" + ahead)
    assert rates(text)["x'"] == pytest.approx(formula(0.6 / 12, 11, 1.6, 4400, 0) / 20, rel=1e-12)


BRUSH = "{ stiffness = 50000, grip = 3000 }"
ALONE = LOOSE.replace("{ B = 9, C = 1.3, D = 4000, E = -0.4 }", BRUSH)
TOGETHER = ALONE.replace(BRUSH, BRUSH + ", rolling = ROLLING, combined = 1e-7")


def brush(s: float, c: float, most: float) -> float:
    """Pacejka's brush, bristles pressed as a parabola: mu F_z (3 x - 3 x^2 + x^3), x = c s/(3 mu F_z) <= 1."""
    x = min(c * s / (3 * most), 1)
    return most * (3 * x - 3 * x**2 + x**3)


@pytest.mark.parametrize("v", [0.3, 0.9, 4])
def test_a_brush_slides_at_its_grip(v):
    """In its adhesion and beyond, to the side alone, against the integral of its bristles."""
    s = math.atan(v / 12)
    assert -20 * rates(ALONE, **{"y'": v})["y'"] == pytest.approx(brush(s, 50000, 3000), rel=1e-12)
    x = np.linspace(0, 1, 200001)  # of bristles along the contact, from its front
    held = np.minimum(2 * 50000 * s * x, 6 * 3000 * x * (1 - x))
    assert brush(s, 50000, 3000) == pytest.approx(np.mean(held), rel=1e-4)


@pytest.mark.parametrize(("rolling", "v"), [(12.6, 0.9), (0, 0.9), (0, -3), (13, 0.0), (12, 2), (20, 5)])
def test_combined_slip_pushes_against_the_slip_of_the_tread(rolling, v):
    """F = f(|s|) s/|s|, s = (r omega - v_x, - v_y)/v_x: never above mu F_z; a locked wheel slides along its way."""
    found = rates(TOGETHER.replace("ROLLING", str(rolling)), **{"y'": v})
    F, slip = 20 * np.array([found["x'"], found["y'"]]), np.array([rolling - 12, -v])
    size = float(np.linalg.norm(slip)) / 12
    assert pytest.approx(brush(size, 50000, 3000) * slip / (12 * size), rel=1e-9, abs=1e-6) == F
    assert np.linalg.norm(F) <= 3000 * (1 + 1e-12)


def test_combined_slip_of_one_way_alone_is_that_of_its_law():
    """Ahead the law of kappa, to the side that of tan alpha, each with its own numbers, as without `combined`."""
    laws = "longitudinal = { B = 11, C = 1.6, D = 4400 }, rolling = ROLLING }"
    text = LOOSE.replace("E = -0.4 } }", f"E = -0.4 }}, {laws}")
    both = text.replace("rolling", "combined = 1e-8, rolling")
    alone, together = (rates(x.replace("ROLLING", "12.6"), **{"y'": 0}) for x in (text, both))
    assert together["x'"] == pytest.approx(alone["x'"], rel=1e-9) and together["y'"] == 0
    gentle = 1e-3 * 12
    alone, together = (rates(x.replace("ROLLING", "12"), **{"y'": gentle}) for x in (text, both))
    assert together["y'"] == pytest.approx(alone["y'"], rel=1e-5) and abs(together["x'"]) < 1e-9


def test_two_laws_of_combined_slip_stay_in_an_ellipse():
    """(F_x/D_x)^2 + (F_y/D_y)^2 = 1 where both slide fully: C = 1, s very large."""
    laws = "lateral = { B = 1e9, C = 1, D = 3000 }, longitudinal = { B = 1e9, C = 1, D = 5000 }, combined = 1e-6"
    text = LOOSE.replace("lateral = { B = 9, C = 1.3, D = 4000, E = -0.4 }", laws + ", rolling = 10")
    found = rates(text, **{"y'": 3})
    assert (20 * found["x'"] / 5000) ** 2 + (20 * found["y'"] / 3000) ** 2 == pytest.approx(1, rel=1e-6)


def test_combined_slip_relaxes_both_ways_by_the_law_that_is_given():
    """Both slips are states; the force ahead is that of the state, not of the speeds."""
    text = ALONE.replace(
        BRUSH, "{ stiffness = 50000, grip = 3000, relaxation = 0.6 }, rolling = 12.6, combined = 0.001"
    )
    found = rates(text, tyre_slip=0.03, tyre_kappa=-0.02)
    s = math.sqrt(0.03**2 + 0.02**2 + 0.001**2)
    assert found["tyre_kappa"] == pytest.approx((0.6 + 12 * 0.02) / 0.6, rel=1e-12)
    assert 20 * found["x'"] == pytest.approx(brush(s, 50000, 3000) * -0.02 / s, rel=1e-12)
    assert 20 * found["y'"] == pytest.approx(brush(s, 50000, 3000) * -0.03 / s, rel=1e-12)


ROLLS = """
eomgen = 1
space = "SPACE"
parameters = { c = 6000, r = 0.3, w = 45, V = 12 }
coordinates = { x = { speed = "V" }, phi = { speed = "w" } }
bodies.hub = { mass = 30, inertia = ONES, joint = { kind = "prismatic", axis = AHEAD, displacement = "x" } }
bodies.wheel = { mass = 5, inertia = [0.3, 0.4, 0.3], joint = { kind = "revolute", on = "hub", angle = "phi", AXIS } }
forces.tyre = { kind = "tyre", point = "wheel.origin", radius = "r", longitudinal = { stiffness = "c" }, MORE }
"""


@pytest.mark.parametrize("space", ["plane", "space"])
def test_a_wheel_that_spins_drives_its_hub_and_is_braked(space):
    """F = c (r omega - V)/V: (M + m) x'' = F and I omega' = - r F."""
    flat = {"SPACE": "plane", "ONES": "1", "[0.3, 0.4, 0.3]": "0.4", "AHEAD": "[1, 0]", ", AXIS": "", ", MORE": ""}
    deep = {"SPACE": "space", "ONES": "[1, 1, 1]", "AHEAD": "[1, 0, 0]", "AXIS": "axis = [0, 1, 0]", ", MORE": ""}
    text = ROLLS
    for old, new in (flat if space == "plane" else deep).items():
        text = text.replace(old, new)
    if space == "plane":
        text = text.replace('angle = "phi"', 'angle = "-phi"')
    F = 6000 * (0.3 * 45 - 12) / 12
    found = rates(text)
    assert found["x'"] == pytest.approx(F / 35, rel=1e-12) and found["phi'"] == pytest.approx(-0.3 * F / 0.4, rel=1e-12)


BAD = [
    ("lateral = { B = 9, C = 1.3, D = 4000, E = -0.4 }", "smooth = 1", "has no law"),
    ("D = 4000, ", "", "B, C and D"),
    ("B = 9", "stiffness = 3, B = 9", "a stiffness and a magic formula"),
    ("E = -0.4 } }", "E = -0.4 }, longitudinal = { stiffness = 1 } }", "how fast the wheel"),
    ("E = -0.4 } }", "E = -0.4 }, radius = 1, heading = [1, 0] }", "'heading'"),
    ("D = 4000", 'D = { value = 1, unit = "m" }', "N"),
    ("D = 4000", "D = 4000, grip = 3", "a grip without a stiffness"),
    ("E = -0.4 } }", "E = -0.4 }, combined = 0.01 }", "how fast the wheel"),
    ("E = -0.4 } }", "E = -0.4 }, rolling = 3, combined = 0 }", "is zero"),
]


@pytest.mark.parametrize(("old", "new", "message"), BAD)
def test_what_cannot_be_a_tyre_is_refused_by_name(old, new, message):
    """What, where, and how to mend it."""
    with pytest.raises(ModelError, match=message):
        eomgen.loads(LOOSE.replace(old, new))


SLIDING = """
eomgen = 1
space = "plane"
coordinates = { x = { speed = 5 }, y = { speed = 1 } }
bodies.sledge = { shape = { kind = "particle", mass = 2 }, joint = { kind = "placed", at = ["x", "y"] } }
forces.blade = { kind = "tyre", point = "sledge.center", lateral = { stiffness = 40, relaxation = 0.5 } }
"""


def test_an_equation_of_a_slip_is_right_while_the_wheel_goes_ahead():
    """l s' = v_y - |v_x| s is written with v_x: right where that is above 0; twice of it is wrong."""
    drag = """forces.snow = { kind = "force", point = "sledge.center", force = ["-3*x'", 0] }"""
    model = eomgen.loads(SLIDING + drag)
    verdict = eomgen.verify(model, "blade_slip' = (y' - x'*blade_slip)/0.5")
    assert verdict.verdict == "right" and verdict.up_to.endswith("x' > 0")
    assert eomgen.verify(model, "blade_slip' = (y' - 2*x'*blade_slip)/0.5").verdict == "wrong"


def test_what_stands_on_a_tyre_may_rest_anywhere():
    """Nothing pushes at rest: places with states beside them, and no constraint, are one family."""
    assert len(eomgen.statics(eomgen.loads(SLIDING)).places) == 1
