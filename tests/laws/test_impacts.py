"""Impacts with restitution: the jump of the speeds, in numbers and through the phases of a run."""

from __future__ import annotations

import math
from itertools import pairwise

import numpy as np
import pytest
from scipy.optimize import nnls

import eomgen
from eomgen.errors import DerivationError, EomgenError, ModelError
from eomgen.mechanics.impacts import Hit, jump
from eomgen.mechanics.impacts.law import lemke
from eomgen.simulation.result import Trajectory

G = 9.81
HEAD = """
eomgen = 1
space = "plane"
forces.weight = { kind = "gravity", acceleration = [0, "-g"] }
"""
BALL = """
parameters = { m = 1, g = 9.81, h = 1, e = 0.6 }
coordinates = { x = { speed = 1 }, y = { start = "h" } }
bodies.ball = { shape = { kind = "particle", mass = "m" }, joint = { kind = "placed", at = ["x", "y"] } }
[constraints.floor]
kind = "support"
point = "ball.origin"
normal = [0, 1]
at = [0, 0]
unilateral = true
restitution = "e"
"""


def run(text: str, time: float, **options) -> Trajectory:
    return eomgen.simulate(eomgen.loads(HEAD + text), time=time, target="numpy", **options)


# -- the law alone ---------------------------------------------------------------------------------


def random_impact(rng: np.random.Generator) -> tuple[np.ndarray, np.ndarray, list[Hit], np.ndarray]:
    """(M, rows of the constraints, contacts, speeds): two coordinates more than constraints, contacts approached."""
    k, n = int(rng.integers(0, 3)), int(rng.integers(3, 7))
    A = rng.normal(size=(n, n))
    held = rng.normal(size=(k, n + 1))
    u = rng.normal(size=n)
    if k:
        u -= np.linalg.lstsq(held[:, :-1], held[:, :-1] @ u + held[:, -1], rcond=None)[0]
    e, hits = float(rng.uniform(0, 1)), []
    for number in range(int(rng.integers(1, n - k + 1))):
        row = rng.normal(size=n + 1)
        row[-1] = -row[:-1] @ u - (0.0 if number % 2 else float(rng.uniform(0.1, 2)))
        hits.append(Hit(f"c{number}", row[None, :], e))
    return A @ A.T + np.eye(n), held, hits, u


def test_random_impacts_obey_momentum_restitution_and_complementarity():
    """M (u+ - u-) = J^T Lam, J_b u+ + sigma_b = 0, 0 <= Lam, v+ + e min(v-, 0) >= 0, one of the two is 0."""
    rng = np.random.default_rng(7)
    for _ in range(1000):
        M, held, hits, u = random_impact(rng)
        after = jump(M, held, hits, u)
        lam = np.array([after.impulses[hit.name][0] for hit in hits])
        J = np.array([hit.rows[0, :-1] for hit in hits])
        assert M @ (after.u - u) == pytest.approx(J.T @ lam + held[:, :-1].T @ after.held, abs=1e-8, rel=1e-9)
        assert held[:, :-1] @ after.u + held[:, -1] == pytest.approx(np.zeros(len(held)), abs=1e-9)
        left = np.array([hit.speed(after.u) + hit.e * min(hit.speed(u), 0.0) for hit in hits])
        size = max(1.0, lam.max())
        assert lam.min() >= -1e-9 and left.min() >= -1e-9 * size and abs(lam @ left) <= 1e-9 * size


def test_no_impact_against_what_is_at_rest_gains_energy():
    """T+ <= T- where sigma = 0 and one e, 0 <= e <= 1; T+ = T- where e = 1."""
    rng = np.random.default_rng(8)
    for number in range(500):
        M, _, hits, u = random_impact(rng)
        e = 1.0 if number % 5 == 0 else hits[0].e
        still = [
            Hit(hit.name, np.append(-hit.rows[0, :-1] * np.sign(hit.rows[0, :-1] @ u), 0)[None], e) for hit in hits
        ]
        after = jump(M, np.zeros((0, len(u) + 1)), still, u)
        before, later = u @ M @ u / 2, after.u @ M @ after.u / 2
        assert later == pytest.approx(before, rel=1e-9) if e == 1 else later <= before * (1 + 1e-9)


def test_lemke_and_the_nearest_point_of_a_cone_give_one_jump():
    """A^T z of a complementarity problem is unique: by pivots, and by least squares."""
    rng = np.random.default_rng(9)
    for _ in range(300):
        A = rng.normal(size=(int(rng.integers(1, 7)), int(rng.integers(2, 5))))
        y = rng.normal(size=A.shape[1])
        z = lemke(A @ A.T, A @ y)
        assert z is not None and A.T @ z == pytest.approx(A.T @ nnls(A.T, -y)[0], abs=1e-9)


def test_a_cradle_hit_from_one_side_shares_the_speed_where_all_is_at_once():
    """Three equal balls, e = 1: u+ = (-1/3, 2/3, 2/3) v, Lam = (4/3, 2/3) m v."""
    hits = [Hit("a", np.array([[-1.0, 1, 0, 0]]), 1.0), Hit("b", np.array([[0, -1.0, 1, 0]]), 1.0)]
    after = jump(np.eye(3), np.zeros((0, 4)), hits, np.array([1.0, 0, 0]))
    assert after.u == pytest.approx(np.array([-1, 2, 2]) / 3)
    assert [after.impulses[name][0] for name in "ab"] == pytest.approx([4 / 3, 2 / 3])


def test_of_four_feet_the_speeds_after_are_sure_and_single_impulses_are_not():
    """A table that lands flat: v+ = 0, four impulses share 3 balances and are given as nan."""
    feet = [(1, 1), (1, -1), (-1, 1), (-1, -1)]
    hits = [Hit(f"foot{k}", np.array([[1.0, y, -x, 0]])) for k, (x, y) in enumerate(feet)]
    after = jump(np.diag([4.0, 1, 1]), np.zeros((0, 4)), hits, np.array([-2.0, 0.1, 0]))
    assert after.u == pytest.approx(np.zeros(3), abs=1e-12)
    assert all(np.isnan(after.impulses[hit.name][0]) for hit in hits)


# -- runs ------------------------------------------------------------------------------------------


@pytest.mark.slow
def test_a_bouncing_ball_comes_to_rest_at_the_limit_of_its_bounces():
    """t = sqrt(2 h/g) (1 + e)/(1 - e); impulse m (1 + e) v, loss m v^2 (1 - e^2)/2, each e^2 times the one before."""
    result = run(BALL, 2.5)
    first, second = result.impacts[:2]
    v = math.sqrt(2 * G)
    assert first.t == pytest.approx(math.sqrt(2 / G), abs=1e-12) and first.contact == "floor"
    assert first.impulses["floor"] == pytest.approx(1.6 * v, rel=1e-10)
    assert first.loss == pytest.approx(v * v * 0.64 / 2, rel=1e-10)
    assert second["loss"] == pytest.approx(0.36 * first.loss, rel=1e-9)
    assert result.phases[-1].start == pytest.approx(math.sqrt(2 / G) * 4, abs=1e-10)
    assert "bounces without end until t = 1.806094564 s" in result.phases[-2].ended_by
    assert result.phases[0].ended_by == "the support 'floor' rebounds at t = 0.451524 s"
    assert result["x"][-1] == pytest.approx(2.5, abs=1e-9) and abs(result["y"][-1]) < 1e-9
    assert sum(impact.loss for impact in result.impacts) == pytest.approx(G, rel=1e-8)
    assert result.certify().ok


def test_a_ball_that_keeps_all_energy_bounces_to_the_same_height():
    """e = 1: impacts at (2 k + 1) sqrt(2 h/g), no loss."""
    result = run(BALL.replace("e = 0.6", "e = 1"), 5)
    t = math.sqrt(2 / G)
    assert [impact.t for impact in result.impacts] == pytest.approx([t, 3 * t, 5 * t, 7 * t, 9 * t, 11 * t], abs=1e-9)
    assert max(abs(impact.loss) for impact in result.impacts) < 1e-9


def test_speeds_that_lead_into_the_floor_at_the_start_rebound():
    """y = e v t - g t^2/2."""
    text = BALL.replace("h = 1,", "h = 0,").replace('start = "h"', 'start = "h", speed = -2')
    result = run(text, 0.1)
    assert result.impacts[0].t == 0 and result["y"][-1] == pytest.approx(1.2 * 0.1 - G * 0.005, abs=1e-12)


TWO_BALLS = """
parameters = { m1 = 3, m2 = 1, g = 9.81, h = 1, d = 1e-6, e = 0.8 }
coordinates = { y1 = { start = "h" }, y2 = { start = "h + d" } }
bodies.low = { shape = { kind = "particle", mass = "m1" }, joint = { kind = "placed", at = [0, "y1"] } }
bodies.high = { shape = { kind = "particle", mass = "m2" }, joint = { kind = "placed", at = [0, "y2"] } }
[constraints.floor]
kind = "support"
point = "low.origin"
normal = [0, 1]
at = [0, 0]
unilateral = true
restitution = "e"
[constraints.between]
kind = "rolling"
body = "high"
radius = "1e-9"
on = "low"
line = { at = [0, 0], normal = [0, 1] }
slip = true
unilateral = true
restitution = "e"
"""


def test_of_two_balls_that_fall_together_the_upper_one_rises_higher_than_it_fell():
    """Ground first: v2 = (m1 e (1 + e) + m1 e - m2)/(m1 + m2) v = 1.43 v."""
    result = run(TWO_BALLS, 0.46)
    assert [impact.contact for impact in result.impacts[:2]] == ["floor", "between"]
    after = result.impacts[1].t
    v2 = result["y2'"][-1] + G * (result.t[-1] - after)
    assert v2 == pytest.approx(1.43 * math.sqrt(2 * G), rel=1e-5)


BLOCK = """
parameters = { m = 2, g = 9.81, b = "sin(alpha)", h = "cos(alpha)", alpha = 0.35, w0 = -0.4 }
coordinates = { x = { start = "b" }, y = { start = "h" }, phi = { speed = "w0" } }
[bodies.block]
shape = { kind = "rectangle", mass = "m", width = "2*b", height = "2*h" }
points = { left = ["-b", "-h"], right = ["b", "-h"] }
joint = { kind = "planar", x = "x", y = "y", angle = "phi" }
[constraints.right]
kind = "rolling"
body = "block"
center = "right"
radius = "1e-9"
line = { at = [0, 0], normal = [0, 1] }
unilateral = true
[constraints.left]
kind = "rolling"
body = "block"
center = "left"
radius = "1e-9"
line = { at = [0, 0], normal = [0, 1] }
unilateral = true
"""


@pytest.mark.parametrize("alpha", [10, 20, 40, 54])
def test_a_rocking_block_keeps_the_share_of_housner(alpha):
    """w+ = (1 - 3/2 sin^2 alpha) w-: it leaves the corner on which it rocked, of the law alone."""
    a = math.radians(alpha)
    b, h = math.sin(a), math.cos(a)
    M = np.diag([1.0, 1, (b * b + h * h) / 3])
    # about the corner (b, -h) on the right, then on to (-b, -h): rows of normal and tangent at both
    rows = {x: np.array([[0, 1, x, 0], [1, 0, h, 0]]) for x in (b, -b)}
    w = -1.0
    u = np.linalg.lstsq(np.array([*rows[-b][:, :-1], [0, 0, 1]]), np.array([0, 0, w]), rcond=None)[0]
    assert rows[b][0, :-1] @ u == pytest.approx(2 * b * w)
    after = jump(M, np.zeros((0, 4)), [Hit("left", rows[-b]), Hit("right", rows[b])], u)
    assert after.u[2] / w == pytest.approx(1 - 1.5 * math.sin(a) ** 2, abs=1e-12)


@pytest.mark.slow
def test_a_run_rocks_from_corner_to_corner_as_housner_says():
    """Every impact of BLOCK leaves 1 - 3/2 sin^2 alpha of the angular velocity."""
    phases = run(BLOCK, 0.25).phases
    shares = [b.first["phi'"] / a.last["phi'"] for a, b in pairwise(phases)]
    assert len(shares) == 4 and shares == pytest.approx([1 - 1.5 * math.sin(0.35) ** 2] * 4, abs=1e-8)


def test_beyond_the_angle_of_housner_both_corners_carry():
    """sin^2 alpha > 2/3: w+ = 0."""
    b, h = math.sin(1.0), math.cos(1.0)
    rows = {x: np.array([[0, 1, x, 0], [1, 0, h, 0]]) for x in (b, -b)}
    u = np.linalg.lstsq(np.array([*rows[-b][:, :-1], [0, 0, 1]]), np.array([0, 0, -1.0]), rcond=None)[0]
    after = jump(np.diag([1.0, 1, 1 / 3]), np.zeros((0, 4)), [Hit("left", rows[-b]), Hit("right", rows[b])], u)
    assert after.u == pytest.approx(np.zeros(3), abs=1e-12)


DUMBBELL = """
parameters = { m = 1, g = 9.81, l = 1, phi0 = 0.5, e = 0.5, h = 1 }
coordinates = { x = {}, y = { start = "h + l/2*sin(phi0)" }, phi = { start = "phi0" } }
[bodies.bell]
mass = "2*m"
inertia = "m*l^2/2"
points = { a = ["-l/2", 0], b = ["l/2", 0] }
joint = { kind = "planar", x = "x", y = "y", angle = "phi" }
[constraints.floor]
kind = "support"
point = "bell.a"
normal = [0, 1]
at = [0, 0]
unilateral = true
restitution = "e"
"""


def test_a_dumbbell_that_lands_on_one_ball_turns():
    """1/m_n = 1/(2m) + (l/2 cos phi)^2/I; Lam = (1 + e) m_n v, w+ = -(l/2) cos phi Lam/I."""
    result = run(DUMBBELL, 0.46)
    v, arm, inertia = math.sqrt(2 * G), -math.cos(0.5) / 2, 0.5
    effective = 1 / (1 / 2 + arm**2 / inertia)
    assert result.impacts[0].impulses["floor"] == pytest.approx(1.5 * effective * v, rel=1e-9)
    assert result["phi'"][-1] == pytest.approx(arm * 1.5 * effective * v / inertia, rel=1e-9)
    assert result.impacts[0].loss == pytest.approx(effective * v * v * 0.75 / 2, rel=1e-9)
    assert result.certify().ok


def test_a_wire_that_becomes_taut_rebounds():
    """A ball on a wire of length l falls freely: at r = l its radial speed turns to e times itself."""
    text = """
parameters = { m = 1, g = 9.81, l = 1, e = 0.5 }
coordinates = { x = {}, y = {} }
points.O = [0, 0]
bodies.ball = { shape = { kind = "particle", mass = "m" }, joint = { kind = "placed", at = ["x", "y"] } }
constraints.wire = { kind = "link", points = ["ball.origin", "O"], length = "l", unilateral = true, restitution = "e" }
"""
    result = run(text, 0.5)
    t = math.sqrt(2 / G)
    assert result.impacts[0].t == pytest.approx(t, abs=1e-9)
    assert result["y'"][-1] == pytest.approx(0.5 * G * t - G * (0.5 - t), abs=1e-7)


# -- what is refused -------------------------------------------------------------------------------


def test_a_restitution_of_what_cannot_end_is_refused():
    with pytest.raises(ModelError, match="has a restitution and cannot end"):
        eomgen.loads(HEAD + BALL.replace("unilateral = true\n", ""))


def test_a_restitution_that_gains_energy_is_refused():
    with pytest.raises(EomgenError, match=r"the restitution of 'floor' is 1\.2"):
        result = run(BALL.replace("e = 0.6", "e = 1.2"), 1)
        if not result.ok:
            raise DerivationError(result.message)
