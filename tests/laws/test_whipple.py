"""The Whipple bicycle against its linear benchmark.

Source: Meijaard, Papadopoulos, Ruina & Schwab, Linearized dynamics equations for the balance and steer of a bicycle:
a benchmark and review, Proc. R. Soc. A 463 (2007) 1955-1982: M, C1, K0, K2 of section 5(b), eigenvalues of table 2.
"""

from functools import cache
from pathlib import Path

import numpy as np
import pytest
from slow_run import in_slow_run, usual

import eomgen

pytestmark = pytest.mark.slow

MODEL = Path(__file__).parents[2] / "models" / "whipple_bicycle.toml"
TEXT = MODEL.read_text()

M = [[80.81722, 2.31941332208709], [2.31941332208709, 0.29784188199686]]
C1 = [[0, 33.86641391492494], [-0.85035641456978, 1.68540397397560]]
K0 = [[-80.95, -2.59951685249872], [-2.59951685249872, -0.80329488458618]]
K2 = [[0, 76.59734589573222], [0, 2.65431523794604]]
G = 9.81

EIGENVALUES = {  # capsize, castering, weave
    2: (-3.07158645641514, -8.67387984831735, 2.68234517512745 + 1.68066296590675j),
    5: (-0.32286642900409, -14.07838969279822, -0.77534188219585 + 4.46486771378823j),
}


@cache
def at_speed(v: float) -> eomgen.Linearization:
    return eomgen.linearize(eomgen.loads(TEXT.replace("value = 5,", f"value = {v},")))


@pytest.mark.parametrize("v", usual([0.5, 2, 5], 2, 1))
def test_the_linearized_equations_are_those_of_the_benchmark(v):
    """M q'' + v C1 q' + (g K0 + v^2 K2) q = 0 in lean and steer"""
    small = at_speed(v)
    assert small.coordinates == ("phi", "delta") and small.is_exact
    assert np.allclose(small.M, M, rtol=1e-13, atol=1e-11)
    assert np.allclose(small.C, v * np.array(C1), rtol=1e-13, atol=1e-11)
    assert np.allclose(small.K, G * np.array(K0) + v**2 * np.array(K2), rtol=1e-13, atol=1e-11)


@pytest.mark.parametrize("v", EIGENVALUES)
def test_eigenvalues_are_those_of_the_benchmark(v):
    """capsize, castering and weave"""
    capsize, castering, weave = EIGENVALUES[v]
    found = sorted(at_speed(v).spectrum.eigenvalues, key=lambda x: (x.real, x.imag))
    expected = sorted((capsize, castering, weave, weave.conjugate()), key=lambda x: (x.real, x.imag))
    assert np.allclose(found, expected, rtol=1e-11, atol=1e-11)


@pytest.mark.parametrize(("v", "stable"), usual([(4.292, False), (4.293, True), (6.02, True), (6.03, False)], 2))
def test_it_balances_by_itself_between_weave_and_capsize_speed(v, stable):
    """4.29238253634111 m/s < v < 6.02426201538837 m/s"""
    assert (at_speed(v).spectrum.stability == "asymptotically stable") == stable


def test_the_track_of_the_wheels_follows_the_modes():
    """psi' w = (v delta + c delta') cos(tilt),  y' = v psi + r_R phi': coordinates on which nothing depends move too"""
    v, w, c, tilt, r = 5, 1.02, 0.08, np.pi / 10, 0.3
    for mode in at_speed(v).spectrum.modes:
        s, q = mode.eigenvalue, {x.name: value for x, value in mode.shape.items()}
        assert s * q["psi"] * w == pytest.approx((v + c * s) * q["delta"] * np.cos(tilt), abs=1e-9)
        assert s * q["y"] == pytest.approx(v * q["psi"] + r * s * q["phi"], abs=1e-9)


@in_slow_run
def test_a_run_that_starts_straight_stays_regular():
    """zero steer divides nothing by zero: the wheels carry the weight, and energy stays"""
    model = eomgen.load(MODEL)
    answers = eomgen.solve(model)
    assert answers["weight_on_front_wheel"].value == pytest.approx(309.3035294, rel=1e-9)
    run = eomgen.simulate(model, time=2)
    assert run.status == "finished" and run.drift < 1e-9
    assert np.allclose(run.x[-1, 1], 0, atol=1e-9)


def test_a_small_push_moves_it_as_the_modes_say():
    """x(t) = sum of c_k v_k exp(s_k t) to first order in the push"""
    push, end = 1e-4, 1.5
    text = TEXT.replace('phi = { about = "lean" }', f'phi = {{ about = "lean", speed = {push} }}')
    run = eomgen.simulate(eomgen.loads(text), time=end)
    from scipy.linalg import expm

    lean, steer = (expm(at_speed(5).A * end) @ [0, 0, push, 0])[:2]
    names = list(run.coordinates)
    assert run.x[-1, names.index("phi")] == pytest.approx(lean, rel=1e-3, abs=1e-7)
    assert run.x[-1, names.index("delta")] == pytest.approx(steer, rel=1e-3, abs=1e-7)
