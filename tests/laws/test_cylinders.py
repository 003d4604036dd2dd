"""Hydraulic and pneumatic cylinders: against closed forms of oscillations, steady motions, leakage and gas springs."""

from __future__ import annotations

import math

import numpy as np
import pytest
from each import each

import eomgen
from eomgen.errors import ModelError
from eomgen.study import Checked

pytestmark = pytest.mark.slow

RAM = """
eomgen = 1
space = "plane"
parameters = { m = 40, A = 2e-3, a = 1e-3, V = 4e-4, E = 9e8, h = 0.6, Q = 0 }
coordinates = { x = { start = 0.6, unit = "m" } }
points = { O = [0, 0] }
[bodies.mass]
shape = { kind = "particle", mass = "m" }
joint = { kind = "prismatic", axis = [1, 0], displacement = "x", at = [0, 0] }
[forces.ram]
kind = "hydraulic_cylinder"
points = ["O", "mass.center"]
areas = ["A", "A"]
volumes = ["V", "V"]
retracted = 0.3
stroke = "h"
bulk = "E"
"""


def frequency(text: str) -> float:
    """Largest imaginary part of the eigenvalues of small motions [rad/s]."""
    A = eomgen.linearize(eomgen.loads(text)).state_space().A
    return float(np.abs(np.linalg.eigvals(np.array(A, dtype=float)).imag).max())


def test_a_closed_cylinder_is_the_spring_of_its_fluid():
    """omega^2 = 4 E A^2/(V_0 m), V_0 the volume of both chambers, its piston in the middle."""
    volume = 2 * (4e-4 + 2e-3 * 0.3)
    assert frequency(RAM + "[linearize]\nabout = 'start'\n") == pytest.approx(
        math.sqrt(4 * 9e8 * 2e-3**2 / (volume * 40)), rel=1e-9
    )


def test_a_given_flow_moves_the_piston_by_its_area():
    """x' = Q/A where what comes into one chamber leaves the other; the pressures do not change."""
    flows = 'flows = ["Q", "-Q"]\npressures = [3e5, 3e5]'
    text = (RAM + flows).replace("Q = 0", "Q = 1e-4").replace("start = 0.6", 'start = 0.6, speed = "Q/A"')
    run = eomgen.simulate(eomgen.loads(text), time=1, target="numpy")
    assert run.ok and run["x"][-1] == pytest.approx(0.65, abs=1e-9)
    assert run["ram_p_1"][-1] == pytest.approx(3e5, rel=1e-6)


@pytest.mark.parametrize(("y", "load"), [(0.4, 8e3), (-0.4, 8e3), (0.4, -5e3)])
def test_a_valve_moves_a_load_as_its_edges_let_through(y, load):
    """x' = (Q_N y/A) sqrt((p_S -+ F/A)/(2 p_N)) of a cylinder with equal areas against a force F."""
    valve = f"valve = {{ opening = {y}, flow = 1e-3, drop = 3.5e6, supply = 2e7 }}\npressures = [1e7, 1e7]\n"
    held = f'[forces.load]\nkind = "force"\npoint = "mass.center"\nforce = ["-{load} - 4000*x\'", 0]\n'
    text = (RAM + valve + held).replace("h = 0.6", "h = 0.9").replace("start = 0.6", "start = 0.75")
    run = eomgen.simulate(eomgen.loads(text), time=0.2, target="numpy")
    v, side = float(run["x'"][-1]), math.copysign(1, y)
    against = side * (load + 4000 * v) / 2e-3
    assert run.ok and v == pytest.approx(side * 1e-3 * abs(y) / 2e-3 * math.sqrt((2e7 - against) / 7e6), rel=1e-3)


def test_what_leaks_out_of_a_held_cylinder_fades():
    """p = p_0 exp(-E k t/V) where nothing moves, and between two chambers the difference fades twice as fast."""
    fixed = RAM.replace('start = 0.6, unit = "m"', 'motion = "0.6"')
    k, rate = 3e-13, 9e8 * 3e-13 / 1e-3
    both = fixed + f"leakage = {k}\npressures = [4e6, 1e6]"
    run = eomgen.simulate(eomgen.loads(both), time=5, target="numpy")
    assert run["ram_p_1"][-1] - run["ram_p_2"][-1] == pytest.approx(3e6 * math.exp(-2 * rate * 5), rel=1e-7)
    one = both.replace('["A", "A"]', '"A"').replace('["V", "V"]', '"V"').replace("[4e6, 1e6]", "4e6")
    run = eomgen.simulate(
        eomgen.loads(one.replace('stroke = "h"\n', "").replace("h = 0.6, ", "")), time=5, target="numpy"
    )
    assert run["ram_p_1"][-1] == pytest.approx(4e6 * math.exp(-rate * 5), rel=1e-7)


GAS = """
eomgen = 1
space = "plane"
parameters = { m = 40, A = 2e-3, V = 4e-4, n = 1.4, p_0 = 1e5, g = 9.81 }
coordinates = { y = { start = 0.5, unit = "m" } }
points = { O = [0, 0] }
forces.weight = { kind = "gravity", acceleration = [0, "-g"] }
[bodies.mass]
shape = { kind = "particle", mass = "m" }
joint = { kind = "prismatic", axis = [0, 1], displacement = "y", at = [0, 0] }
[forces.gas]
kind = "pneumatic_cylinder"
points = ["O", "mass.center"]
areas = "A"
volumes = "V"
retracted = 0.3
exponent = "n"
pressures = "p_0 + m*g/A"
outside = "p_0"
"""
HEIGHT = (4e-4 + 2e-3 * 0.2) / 2e-3


@pytest.mark.parametrize("n", [1, 1.4])
def test_a_closed_gas_is_a_spring_about_its_equilibrium(n):
    """omega^2 = n p A^2/(m V), isothermal with n = 1, and its energy is kept."""
    text = GAS.replace("n = 1.4", f"n = {n}")
    p = 1e5 + 40 * 9.81 / 2e-3
    assert frequency(text) == pytest.approx(math.sqrt(n * p * 2e-3 / (40 * HEIGHT)), rel=1e-9)
    run = eomgen.simulate(eomgen.loads(text.replace("start = 0.5", "start = 0.5, speed = 0.4")), time=3, target="numpy")
    assert run.ok and np.ptp(run.energy) < 1e-5 and np.ptp(run["y"]) > 0.1


def test_gas_that_flows_raises_a_load_at_its_pressure():
    """y' = n R T m'/(n p A): at a constant pressure the volume that the gas takes."""
    flow = "flows = 2e-4\ngas = 287\ntemperature = 293\n"
    p = 1e5 + 40 * 9.81 / 2e-3
    v = 287 * 293 * 2e-4 / (p * 2e-3)
    text = (GAS + flow).replace("start = 0.5", f"start = 0.5, speed = {v!r}").replace("p_0 + m*g/A", "1e5 + m*g/A")
    run = eomgen.simulate(eomgen.loads(text), time=0.5, target="numpy")
    assert run.ok and run["y'"][-1] == pytest.approx(v, rel=1e-6)
    assert run["gas_p_1"][-1] == pytest.approx(p, rel=1e-6)


HELD = GAS.replace('{ start = 0.5, unit = "m" }', '{ motion = "0.5" }').replace("p_0 + m*g/A", "P")
VALVE = """gas = 287
temperature = 320
valve = { opening = Y, conductance = 2e-8, critical = 0.3, supply = 8e5, exhaust = 1e5 }
"""
PUSHES = 1.4 * 287 * 320 * 2e-8 * 1.185 * math.sqrt(293.15 / 320) / (4e-4 + 2e-3 * 0.2)


def filled(Y: float, P: float, time: float) -> float:
    """Pressure in the chamber after a time, its piston held."""
    text = (HELD + VALVE).replace("Y", str(Y)).replace('"P"', repr(P))
    run = eomgen.simulate(eomgen.loads(text), time=time, target="numpy", rtol=1e-11, atol=1e-6)
    assert run.ok
    return float(run["gas_p_1"][-1])


def test_a_choked_valve_fills_a_chamber_at_a_steady_rate():
    """p' = (n R T/V) y C rho_0 sqrt(T_0/T) p_s, whatever the pressure in the chamber, below b p_s."""
    p, rate = filled(0.5, 1e5, 0.08), 0.5 * PUSHES * 8e5
    assert p < 0.3 * 8e5 and p == pytest.approx(1e5 + rate * 0.08, rel=1e-9)


def test_a_chamber_empties_through_a_choked_valve_as_an_exponential():
    """p' = - (n R T/V) y C rho_0 sqrt(T_0/T) p as long as p_e < b p."""
    p = filled(-0.5, 7e5, 0.2)
    assert 1e5 < 0.3 * p and p == pytest.approx(7e5 * math.exp(-0.5 * PUSHES * 0.2), rel=1e-9)


def test_beyond_the_critical_ratio_a_chamber_fills_as_a_sine():
    """r = b + (1 - b) sin(k t/(1 - b)), k = (n R T/V) y C rho_0 sqrt(T_0/T): the ellipse of ISO 6358, from r = b on."""
    k, t = PUSHES, 0.15
    assert filled(1, 0.3 * 8e5, t) == pytest.approx(8e5 * (0.3 + 0.7 * math.sin(k * t / 0.7)), rel=1e-8)
    assert 0.5 < k * t / 0.7 < math.pi / 2


def test_a_chamber_above_the_supply_flows_back_into_it():
    """The sense of an edge is that of the difference of pressure: r = p_s/p there."""
    rhs = eomgen.derive(eomgen.loads((HELD + VALVE).replace("Y", "1").replace('"P"', "1e6"))).rhs("numpy")
    w = math.sqrt(1 - ((0.8 - 0.3) / 0.7) ** 2)
    assert rhs(0.0, rhs.x0, rhs.p0)[-1] == pytest.approx(-PUSHES * 1e6 * w, rel=1e-12)


def test_states_of_forces_go_where_declared_states_go():
    """Names, starts, typed starts, C, equilibria, JSON, and a run of many: as of [states]."""
    text = RAM + 'leakage = 1e-11\nflows = ["Q - 1e-11*ram_p_1", 0]\npressures = [4e6, "1e6"]\n'
    model = eomgen.loads(text.replace("Q = 0", "Q = 1e-5"))
    equations = eomgen.derive(model)
    assert equations.states == ("ram_p_1", "ram_p_2")
    assert list(equations.rhs("numpy").x0[-2:]) == [4e6, 1e6]
    begun = eomgen.simulate(model, time=0.01, start={"ram_p_2": "25 bar"}, target="numpy")
    assert begun["ram_p_2"][0] == 2.5e6
    many = eomgen.simulate_many(model, time=0.01, start={"ram_p_2": [1e6, 2.5e6]}, target="numpy", samples=2)
    assert many["x"][1, -1] == pytest.approx(begun["x"][-1], rel=1e-9)


BAD = [
    (('stroke = "h"', ""), "has two chambers and no stroke"),
    (('volumes = ["V", "V"]', 'volumes = "V"'), "has 2 areas and 1 volumes"),
    (("x = {", "ram_p_1 = 1\nx = {"), "'ram_p_1' is declared as a"),
    (('bulk = "E"', 'bulk = "E"\nflows = ["i\'", 0]'), "their rates cannot hold i'"),
    (('bulk = "E"', 'bulk = "E"\nvalve = { opening = 1, flow = 1, drop = 1 }'), "has no 'supply'"),
    (('bulk = "E"', 'bulk = { value = 1, unit = "m" }'), "Pa"),
]


@pytest.mark.parametrize(("change", "message"), BAD)
def test_what_cannot_be_a_cylinder_is_refused_by_name(change, message):
    """What, where, and how to mend it."""
    text = RAM.replace("coordinates = { x =", "coordinates.x =").replace(', unit = "m" } }', ', unit = "m" }')
    text = text.replace("points = {", 'states.i = { rate = "ram_p_1\' - i" }\npoints = {', 1)
    if change[0] == "x = {":
        text, change = text.replace("Q = 0", "Q = 0, ram_p_1 = 1"), ("E = 9e8", "E = 9e8")
    with pytest.raises(ModelError, match=message):
        eomgen.loads(text.replace(*change))


def test_a_valve_of_gas_is_refused_where_it_cannot_be():
    """No constants of the gas; a critical ratio of 1; the valve of a fluid."""
    bad = [
        ("gas = 287\n", "", "'gas' is not given"),
        ("0.3, supply", "1, supply", "critical ratio"),
        ("critical", "drop", "critical"),
    ]
    for old, new, message in bad:
        with pytest.raises(ModelError, match=message):
            eomgen.loads((HELD + VALVE).replace("Y", "1").replace('"P"', "1e6").replace(old, new, 1))


STROKES = [
    (0.3, 0.4, ""),
    (0.6, 0.4, "'gas' starts at x = -0.1 m, below 0"),
    (0.3, 0.1, "above the stroke of 0.1 m"),
    (0.5, 0.4, ""),
]


@each("retracted, stroke, words", STROKES)
def test_check_warns_of_a_piston_that_starts_beyond_its_stroke(retracted, stroke, words):
    """x = distance - retracted lies between 0 and h."""
    two = GAS.replace('"A"', '["A", "A"]').replace('"V"', '["V", "V"]').replace('"p_0 + m*g/A"', '["p_0", "p_0"]')
    text = two.replace("retracted = 0.3", f"retracted = {retracted}\nstroke = {stroke}")
    found = [problem.what for problem in Checked.of(eomgen.loads(text)).cautions]
    assert any(words in what for what in found) if words else not found
