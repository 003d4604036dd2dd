"""Impacts with restitution: the jump of the speeds, in numbers and through the phases of a run."""

from __future__ import annotations

import functools
import math
from dataclasses import replace
from itertools import pairwise

import numpy as np
import pytest
import sympy
from scipy.integrate import solve_ivp
from scipy.optimize import nnls

import eomgen
from eomgen.errors import DerivationError, EomgenError, ModelError, UsageError
from eomgen.judge.case import Case
from eomgen.judge.judge import Judge
from eomgen.judge.printed_answers import OF_CASES
from eomgen.mechanics.impacts import Hit, ImpactLaw, Jump
from eomgen.mechanics.impacts.friction import Rubbing, alone, leaving
from eomgen.mechanics.impacts.law import lemke
from eomgen.proof.impacts import Touched, after_impact, stepped_impact
from eomgen.results import impact
from eomgen.simulation.result import Trajectory
from eomgen.study.checked import Checked
from eomgen.symbolic.expression import parse

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
        after = Jump.of(M, held, hits, u)
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
        after = Jump.of(M, np.zeros((0, len(u) + 1)), still, u)
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
    after = Jump.of(np.eye(3), np.zeros((0, 4)), hits, np.array([1.0, 0, 0]))
    assert after.u == pytest.approx(np.array([-1, 2, 2]) / 3)
    assert [after.impulses[name][0] for name in "ab"] == pytest.approx([4 / 3, 2 / 3])


def test_of_four_feet_the_speeds_after_are_sure_and_single_impulses_are_not():
    """A table that lands flat: v+ = 0, four impulses share 3 balances and are given as nan."""
    feet = [(1, 1), (1, -1), (-1, 1), (-1, -1)]
    hits = [Hit(f"foot{k}", np.array([[1.0, y, -x, 0]])) for k, (x, y) in enumerate(feet)]
    after = Jump.of(np.diag([4.0, 1, 1]), np.zeros((0, 4)), hits, np.array([-2.0, 0.1, 0]))
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


def test_two_balls_that_touch_share_the_impact_or_take_it_one_after_the_other():
    """At once both leave with e v; ground first v2 = 1.43 v and v1 = 0.008 v."""
    text = TWO_BALLS.replace("d = 1e-6", "d = 0").replace('radius = "1e-9"', "radius = 0.001")
    text = text.replace('start = "h + d"', 'start = "h + d + 0.001"')
    for rules, due in (("", (0.8, 0.8)), ('[impact]\norder = "sequential"\n', (0.008, 1.43))):
        result = run(text + rules, 0.455)
        later = result.t[-1] - result.impacts[0].t
        after = [(result[f"{name}'"][-1] + G * later) / math.sqrt(2 * G) for name in ("y1", "y2")]
        assert after == pytest.approx(due, abs=1e-9) and result.certify().ok


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
    after = Jump.of(M, np.zeros((0, 4)), [Hit("left", rows[-b]), Hit("right", rows[b])], u)
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
    after = Jump.of(np.diag([1.0, 1, 1 / 3]), np.zeros((0, 4)), [Hit("left", rows[-b]), Hit("right", rows[b])], u)
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


# -- friction, other laws, one after the other -----------------------------------------------------


def random_rod(rng: np.random.Generator) -> tuple[np.ndarray, np.ndarray, float, float]:
    """D of the end of a rod m = l = 1 at a random angle, (v_n, v_t), mu, e."""
    phi = rng.uniform(0, 2 * math.pi)
    x, y = math.cos(phi) / 2, math.sin(phi) / 2
    D = np.array([[1 + 12 * x * x, -12 * x * y], [-12 * x * y, 1 + 12 * y * y]])
    return D, np.array([-rng.uniform(0, 1), rng.uniform(-1, 1)]), rng.uniform(0, 1.2), rng.uniform(0, 1)


def test_with_friction_newton_can_gain_energy_and_poisson_and_stronge_never_do():
    """dT = v^T p + p^T D p/2; |p_t| <= mu p_n and v_n >= 0 after it."""
    rng, gained = np.random.default_rng(3), {"newton": 0, "poisson": 0, "energetic": 0}
    for _ in range(2000):
        D, v, mu, e = random_rod(rng)
        for law in gained:
            p = alone(D, v, Rubbing("tip", mu, e), law)
            gained[law] += bool(v @ p + p @ D @ p / 2 > 1e-12)
            assert abs(p[1]) <= mu * p[0] + 1e-12 and (v + D @ p)[0] >= -1e-12
    assert gained["newton"] > 10 and gained["poisson"] == gained["energetic"] == 0


def test_all_laws_are_one_where_nothing_slides_the_other_way_or_sticks():
    """Without friction v_n+ = -e v_n; the work of Stronge's restitution is e^2 times that of the compression."""
    rng = np.random.default_rng(4)
    for _ in range(100):
        D, v, _, e = random_rod(rng)
        p = [alone(D, v, Rubbing("tip", 0.0, e), law)[0] for law in ("newton", "poisson", "energetic")]
        assert p == pytest.approx([-(1 + e) * v[0] / D[0, 0]] * 3)


def test_the_impulses_grow_as_small_steps_of_coulombs_law_say():
    """(v_n, v_t) after it within 1 % of an explicit integration by the normal impulse."""
    rng = np.random.default_rng(5)
    for _ in range(60):
        D, v, mu, e = random_rod(rng)
        for law in ("newton", "poisson", "energetic"):
            after = v + D @ alone(D, v, Rubbing("tip", mu, e), law)
            assert after == pytest.approx(stepped_impact(D, v, mu, e, law), abs=0.01 * (abs(v[0]) + abs(v[1])))


def random_tip(rng: np.random.Generator) -> tuple[np.ndarray, np.ndarray]:
    """(D of a point r of a random body in space, M^-1 - [r] I^-1 [r], its velocity)."""
    x, y, z = rng.normal(size=3) / 2
    r = np.array([[0, -z, y], [z, 0, -x], [-y, x, 0]])
    Q = np.linalg.qr(rng.normal(size=(3, 3)))[0]
    D = np.eye(3) - r @ Q @ np.diag(1 / rng.uniform(0.05, 0.3, size=3)) @ Q.T @ r
    return D, np.array([-rng.uniform(0.1, 1), *rng.normal(size=2)])


def test_in_space_the_impulses_grow_as_small_steps_of_coulombs_law_say():
    """|p_t| <= mu p_n, v_n >= 0, no energy gained; the speeds within 1 % of small steps."""
    rng = np.random.default_rng(12)
    for k in range(120):
        D, v = random_tip(rng)
        mu, e, law = rng.uniform(0, 1), rng.uniform(0, 1), ("poisson", "energetic")[k % 2]
        p = alone(D, v, Rubbing("tip", mu, e, 3), law)
        assert np.linalg.norm(p[1:]) <= mu * p[0] + 1e-12 and (v + D @ p)[0] >= -1e-12
        assert v @ p + p @ D @ p / 2 <= 1e-12
        if k < 12:
            assert v + D @ p == pytest.approx(stepped_impact(D, v, mu, e, law), abs=0.01 * np.abs(v).sum())


def test_in_space_the_velocity_turns_while_it_slides():
    """dv_t/dp = D_tn - mu D_tt v_t/|v_t|, by an integration in p itself: to 1e-10 where it never stops."""
    rng, count = np.random.default_rng(13), 0
    while count < 5:
        (D, v), mu, e = random_tip(rng), 0.2, 0.5
        v[1:] *= 4
        p = alone(D, v, Rubbing("tip", mu, e, 3))
        slides = solve_ivp(
            lambda _, y, D=D, mu=mu: D @ [1, *(-mu * y[1:] / np.linalg.norm(y[1:]))],
            (0, p[0]),
            v,
            rtol=1e-12,
            atol=1e-13,
        )
        if np.min(np.linalg.norm(slides.y[1:], axis=0)) > 0.1:
            assert slides.y[:, -1] == pytest.approx(v + D @ p, abs=1e-10)
            count += 1


def test_what_cannot_stick_leaves_along_the_one_direction_that_stays():
    """D_tn - mu D_tt s = k s, k > 0, |s| = 1; of a plane in space it is that of the plane."""
    rng, found = np.random.default_rng(14), 0
    for _ in range(100):
        D, _ = random_tip(rng)
        sticks, mu = float(np.linalg.norm(np.linalg.solve(D[1:, 1:], D[1:, 0]))), 0.1
        if sticks > mu:
            s, found = leaving(D, mu), found + 1
            stays = D[1:, 0] - mu * D[1:, 1:] @ s
            assert stays == pytest.approx((stays @ s) * s, abs=1e-12) and stays @ s > 0
    assert found > 50


def random_feet(rng: np.random.Generator) -> tuple[np.ndarray, np.ndarray, list[Hit], np.ndarray]:
    """(M, no constraints, two points of a body in the plane on floor and slope, speeds that are kept apart from 0)."""
    e, hits = float(rng.uniform(0, 1)), []
    for name in ("a", "b"):
        (x, y), turned = rng.normal(size=2), rng.uniform(-0.5, 0.5)
        c, s = math.cos(turned), math.sin(turned)
        n, t = np.array([[-s, c, x * c + y * s, 0], [c, s, x * s - y * c, 0]])
        hits.append(Hit(name, n[None], e, False, float(rng.uniform(0.05, 0.5)), t[None]))
    return np.diag([1.0, 1, rng.uniform(0.1, 0.5)]), np.zeros((0, 4)), hits, rng.normal(size=3)


def test_two_feet_that_rub_leave_by_momentum_coulombs_cone_and_one_of_their_ways():
    """M (u+ - u-) = J^T Lam, |Lam_t| <= mu Lam_n, v_n+ >= 0, T+ <= T-; e = 0: friction against what slides on."""
    rng, ways = np.random.default_rng(15), []
    for k in range(150):
        M, held, hits, u = random_feet(rng)
        hits = [replace(hit, e=0.0) for hit in hits] if k % 2 else hits
        try:
            after = Jump.of(M, held, hits, u, ImpactLaw("poisson"))
        except DerivationError as error:
            ways.append(error.what)
            continue
        assert after.u @ M @ after.u <= u @ M @ u * (1 + 1e-12)
        gained = M @ (after.u - u)
        sure = np.all(np.isfinite([*after.impulses.values(), *after.friction.values()]))
        for hit in hits if sure else ():
            n, t = after.impulses[hit.name][0], after.friction[hit.name][0]
            gained = gained - hit.rows[0, :-1] * n - hit.tangents[0, :-1] * t
            slides = float(hit.tangents[0, :-1] @ after.u)
            assert n >= -1e-9 and abs(t) <= hit.mu * n + 1e-9 and hit.speed(after.u) >= -1e-9
            assert hit.e or n * hit.speed(after.u) == pytest.approx(0, abs=1e-9)
            assert hit.e or abs(slides) < 1e-9 or t == pytest.approx(-math.copysign(hit.mu * n, slides), abs=1e-9)
        assert not sure or gained == pytest.approx(np.zeros(3), abs=1e-9)
        assert all(hit.speed(after.u) >= -1e-9 for hit in hits)
    assert len(ways) < 15 and all("ways for the impact" in each or "single value" in each for each in ways)


def test_impulses_iterated_contact_by_contact_give_the_same_jump():
    """p_n and p_t of each contact in turn, until they stay: another way than trying all modes."""
    rng, compared = np.random.default_rng(19), 0
    for k in range(60):
        M, held, hits, u = random_feet(rng)
        rows = np.vstack([each[:, :-1] for hit in hits for each in (hit.rows, hit.tangents)])
        law, D = ("poisson", "newton")[k % 2], rows @ np.linalg.solve(M, rows.T)
        due = after_impact(D, rows @ u, [Touched(hit.mu, hit.e, 2) for hit in hits], law)
        try:
            after = Jump.of(M, held, hits, u, ImpactLaw(law))
        except DerivationError:
            continue
        if due is not None:
            compared += 1
            assert rows @ after.u == pytest.approx(due, abs=1e-6)
    assert compared > 40


def test_contacts_that_do_not_act_on_one_another_have_each_an_impact_of_its_own():
    """Two bodies: each leaves as it does alone, by the whole graph of Routh."""
    rng = np.random.default_rng(16)
    for _ in range(20):
        M, _, hits, u = random_feet(rng)
        law = ImpactLaw("poisson")
        single = [Jump.of(M, np.zeros((0, 4)), [hit], u, law).u for hit in hits]
        padded = []
        for k, hit in enumerate(hits):
            rows, tangents = (
                np.insert(each, 0 if k else 3, np.zeros((3, 1)), axis=1) for each in (hit.rows, hit.tangents)
            )
            padded.append(replace(hit, rows=rows, tangents=tangents))
        both = Jump.of(np.kron(np.eye(2), M), np.zeros((0, 7)), padded, np.tile(u, 2), law)
        assert both.u == pytest.approx(np.concatenate(single), abs=1e-12)


def test_friction_of_two_feet_that_stick_has_no_single_impulses_and_one_sum():
    """A block falls on both corners and sticks: u+ = 0, m v_x = sum of the two."""
    hits = [
        Hit(name, rows_of(f"0 1 {x} 0"), 0.0, False, 0.9, rows_of("1 0 0.5 0")) for name, x in (("a", -1), ("b", 1))
    ]
    after = Jump.of(np.diag([2.0, 2, 1]), np.zeros((0, 4)), hits, np.array([0.3, -1, 0]))
    assert after.u == pytest.approx(np.zeros(3), abs=1e-12)
    assert np.isnan(after.friction["a"][0]) and after.impulses["a"][0] + after.impulses["b"][0] == pytest.approx(2)


def in_space(hit: Hit) -> Hit:
    """A contact of a body in the plane as one of a body (x, y, z, three turns) that could leave it."""
    n, t = hit.rows[0], hit.tangents[0]
    c, s = n[1], -n[0]
    x, y = c * n[2] + s * t[2], s * n[2] - c * t[2]
    rows, tangents = ([each[0], each[1], 0, 0, 0, each[2], 0] for each in (n, t))
    return replace(hit, rows=np.array([rows]), tangents=np.array([tangents, [0, 0, 1, y, -x, 0, 0]], dtype=float))


def test_two_feet_in_the_plane_leave_it_in_no_way_where_they_may():
    """A body in space whose contacts lie in one plane, as in the plane: u+ alike, nothing across it."""
    rng, compared = np.random.default_rng(22), 0
    for k in range(16):
        M, held, hits, u = random_feet(rng)
        law = ImpactLaw(("poisson", "newton")[k % 2])
        free = np.diag([1.0, 1, 1, 0.3, 0.4, M[2, 2]])
        try:
            flat = Jump.of(M, held, hits, u, law).u
            after = Jump.of(
                free, np.zeros((0, 7)), [in_space(hit) for hit in hits], np.array([*u[:2], 0, 0, 0, u[2]]), law
            )
        except DerivationError:
            continue
        assert after.u == pytest.approx([*flat[:2], 0, 0, 0, flat[2]], abs=1e-9)
        compared += 1
    assert compared > 10


def body_with_feet(rng: np.random.Generator, count: int) -> tuple[np.ndarray, list[Hit], np.ndarray]:
    """(M, contacts, speeds) of a random body in space with points on planes that are nearly level."""
    Q = np.linalg.qr(rng.normal(size=(3, 3)))[0]
    M, hits, e = np.eye(6), [], float(rng.uniform(0, 1))
    M[3:, 3:] = Q @ np.diag(rng.uniform(0.1, 0.4, 3)) @ Q.T
    for name in "abcd"[:count]:
        r, n = rng.normal(size=3), np.array([0, 0, 1]) + 0.6 * rng.normal(size=3)
        n = n / np.linalg.norm(n)
        first = np.cross(n, [1, 0, 0]) / np.linalg.norm(np.cross(n, [1, 0, 0]))
        rows = np.array([[*d, *np.cross(r, d), 0] for d in (n, first, np.cross(n, first))])
        hits.append(Hit(name, rows[:1], e, False, float(rng.uniform(0.05, 0.6)), rows[1:]))
    return M, hits, rng.normal(size=6)


def test_contacts_of_a_body_in_space_that_rub_at_once_keep_to_coulombs_cone_and_gain_no_energy():
    """M (u+ - u) = J^T Lam, |Lam_t| <= mu Lam_n, v_n+ >= 0, T+ <= T; sweeps over the contacts come to the same speeds.

    With e = 0 Lam_n v_n+ = 0, and what slides is pushed against its velocity: Lam_t = -mu Lam_n v_t+/|v_t+|.
    """
    rng, swept = np.random.default_rng(23), 0
    for k in range(12):
        M, hits, u = body_with_feet(rng, 2)
        hits = [replace(hit, e=0.0) for hit in hits] if k % 2 else hits
        try:
            after = Jump.of(M, np.zeros((0, 7)), hits, u, ImpactLaw("poisson"))
        except DerivationError as error:
            assert "ways for the impact" in error.what
            continue
        rows = np.vstack([each[:, :-1] for hit in hits for each in (hit.rows, hit.tangents)])
        p = np.concatenate([np.append(after.impulses[hit.name], after.friction[hit.name]) for hit in hits])
        assert M @ (after.u - u) == pytest.approx(rows.T @ p, abs=1e-9)
        assert after.u @ M @ after.u <= u @ M @ u * (1 + 1e-12)
        for hit, own, v in zip(hits, p.reshape(-1, 3), (rows @ after.u).reshape(-1, 3), strict=True):
            assert own[0] >= -1e-9 and v[0] >= -1e-9 and np.linalg.norm(own[1:]) <= hit.mu * own[0] + 1e-9
            if not hit.e:
                assert own[0] * v[0] == pytest.approx(0, abs=1e-8)
                assert own[1:] * np.linalg.norm(v[1:]) == pytest.approx(-hit.mu * own[0] * v[1:], abs=1e-8)
        D = rows @ np.linalg.solve(M, rows.T)
        due = after_impact(D, rows @ u, [Touched(hit.mu, hit.e, 3) for hit in hits], "poisson")
        if due is not None:
            swept += 1
            assert rows @ after.u == pytest.approx(due, abs=1e-6)
    assert swept > 6


def four_feet(mu: float, e: float) -> tuple[np.ndarray, list[Hit]]:
    """(M, contacts) of a table m = 2 with feet at (+-1, +-1) below its mass centre by 0.2."""
    hits = []
    for name, x, y in (("a", 1, 1), ("b", -1, 1), ("c", 1, -1), ("d", -1, -1)):
        rows = np.array([[*d, *np.cross([x, y, -0.2], d), 0] for d in np.roll(np.eye(3), 1, axis=0)])
        hits.append(Hit(name, rows[:1], e, False, mu, rows[1:]))
    return np.diag([2.0, 2, 2, 0.7, 0.8, 0.9]), hits


def test_a_table_that_lands_on_four_rough_feet_slides_on_or_stops():
    """e = 0: v+ = v_t (1 - mu |v_n|/|v_t|), all else 0; single impulses are none. It stops where mu |v_n| >= |v_t|."""
    u = np.array([0.6, 0.8, -1.5, 0, 0, 0])
    for mu in (0.2, 0.9):
        M, hits = four_feet(mu, 0.0)
        after = Jump.of(M, np.zeros((0, 7)), hits, u)
        share = max(0.0, 1 - mu * 1.5)
        assert after.u == pytest.approx([0.6 * share, 0.8 * share, 0, 0, 0, 0], abs=1e-9)
        assert np.isnan(after.impulses["a"][0])


def test_a_ball_in_a_corner_of_two_rough_walls_leaves_as_the_nearest_point_of_its_cones_says():
    """e = 0, the corner that is found by convex steps: min p^T D p/2 + p^T (v + mu |v_t+| n), |p_t| <= mu p_n.

    The speed |v_t+| that stands in it is that of the step before (de Saxce; Acary, Cadoux, Lemarechal & Malick 2011).
    """
    from scipy.optimize import minimize

    walls = [
        ([[-0.3, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]], "x"),
        ([[0, -0.3, 0], [0, 1, 0], [1, 0, 0], [0, 0, 1]], "y"),
    ]
    M, u, mu = np.diag([1.0, 1, 1, 0.036, 0.036, 0.036]), np.array([-1.0, -0.7, 0.6, 2, -1, 3]), 0.1
    hits = []
    for (r, *axes), name in walls:
        rows = np.array([[*d, *np.cross(r, d), 0] for d in axes])
        hits.append(Hit(name, rows[:1], 0.0, False, mu, rows[1:]))
    J = np.vstack([each[:, :-1] for hit in hits for each in (hit.rows, hit.tangents)])
    D, v, p, slip = J @ np.linalg.solve(M, J.T), J @ u, np.array([1.0, 0, 0, 1, 0, 0]), np.zeros(2)
    inside = [{"type": "ineq", "fun": lambda p, k=k: (mu * p[k]) ** 2 - p[k + 1] ** 2 - p[k + 2] ** 2} for k in (0, 3)]
    for _ in range(30):
        raised = v + np.array([mu * slip[0], 0, 0, mu * slip[1], 0, 0])
        p = minimize(
            lambda p, raised=raised: p @ D @ p / 2 + p @ raised,
            p,
            jac=lambda p, raised=raised: D @ p + raised,
            bounds=[(0, None), (None, None), (None, None)] * 2,
            constraints=inside,
            method="SLSQP",
            options={"ftol": 1e-14, "maxiter": 200},
        ).x
        after = v + D @ p
        slip = np.array([math.hypot(*after[1:3]), math.hypot(*after[4:6])])
    found = Jump.of(M, np.zeros((0, 7)), hits, u)
    assert J @ found.u == pytest.approx(after, abs=1e-5)
    assert max(slip) > 0.1 and found.u @ M @ found.u < u @ M @ u


def test_where_friction_leaves_several_ways_they_are_named():
    """A body between two walls that rub so much that it may wedge, or not."""
    rng = np.random.default_rng(17)
    for _ in range(400):
        M, held, hits, u = random_feet(rng)
        try:
            Jump.of(M, held, [replace(hit, mu=0.8) for hit in hits], u, ImpactLaw("poisson"))
        except DerivationError as error:
            if "ways for the impact" in error.what:
                assert "'a' sticks" in error.what and "; or " in error.what
                return
    raise AssertionError("none of them has several ways")


def test_by_newtons_law_what_would_gain_energy_is_refused():
    rng, refused = np.random.default_rng(18), 0
    for _ in range(200):
        M, held, hits, u = random_feet(rng)
        try:
            after = Jump.of(M, held, [replace(hit, e=0.9) for hit in hits[:1]], u, ImpactLaw("newton"))
            assert after.u @ M @ after.u <= u @ M @ u * (1 + 1e-7)
        except DerivationError as error:
            assert "by Newton's law with friction the impact of 'a' gains" in error.what
            refused += 1
    assert refused


def test_an_impact_with_much_friction_jams_and_is_named():
    """Painleve: 1/m + (x^2 - mu |x y|)/I < 0, and v_t grows: no impulse ends the approach."""
    D = np.array([[1.0, -0.9], [-0.9, 1.0]])
    with pytest.raises(DerivationError, match="'tip' jams in its impact"):
        alone(np.array([[1.0, 2.0], [2.0, 1.0]]), np.array([-1.0, 1.0]), Rubbing("tip", 0.6, 0.5))
    assert alone(D, np.array([-1.0, 0.0]), Rubbing("tip", 0.2, 0.0))[0] > 0


@pytest.mark.slow
@pytest.mark.parametrize("law", ["newton", "poisson", "energetic"])
def test_a_rough_dumbbell_leaves_the_floor_as_each_law_says(law):
    """The run's impact is that of the graph, and the proof's small steps agree."""
    text = DUMBBELL.replace('restitution = "e"', 'restitution = "e"\nfriction = 0.3') + f'[impact]\nlaw = "{law}"\n'
    result = run(text.replace("x = {}", "x = { speed = -1 }"), 0.46)
    x, y = -math.cos(0.5) / 2, -math.sin(0.5) / 2
    D = np.array([[0.5 + x * x / 0.5, -x * y / 0.5], [-x * y / 0.5, 0.5 + y * y / 0.5]])
    p = alone(D, np.array([-math.sqrt(2 * G), -1.0]), Rubbing("tip", 0.3, 0.5), law)
    impulses = result.impacts[0].impulses
    assert (impulses["floor"], impulses["floor t"]) == pytest.approx(p, rel=1e-8)
    assert result.certify().ok


def test_a_ball_that_spins_comes_to_roll_in_its_impacts():
    """x' - r phi' ... sticks in the second impact: p_t = -(x' + r phi')/(1/m + r^2/I), from then on it rolls."""
    text = BALL.replace('kind = "particle", mass = "m"', 'kind = "disc", mass = "m", radius = 0.1')
    text = text.replace('kind = "placed", at = ["x", "y"]', 'kind = "planar", x = "x", y = "y", angle = "phi"')
    text = text.replace('y = { start = "h" }', 'y = { start = "h" }, phi = { speed = 40 }')
    text = text.replace('kind = "support"\npoint = "ball.origin"\nnormal = [0, 1]\nat = [0, 0]', ROLLING)
    result = run(text, 2.0)
    first, second = result.impacts[:2]
    v = math.sqrt(2 * G * 0.9)
    assert first.impulses["floor t"] == pytest.approx(-0.2 * 1.6 * v, rel=1e-9)
    slides = 1 + 4 - 3 * 0.2 * 1.6 * v
    assert second.impulses["floor t"] == pytest.approx(-slides / 3, rel=1e-8)
    assert result["x'"][-1] == pytest.approx(-0.1 * result["phi'"][-1], abs=1e-9)


ROLLING = """kind = "rolling"
body = "ball"
line = { at = [0, 0], normal = [0, 1] }
slip = true
friction = 0.2"""


def test_a_cradle_hit_one_after_the_other_passes_the_speed_on():
    """e = 1: (0, 0, v)."""
    hits = [Hit("a", np.array([[-1.0, 1, 0, 0]]), 1.0), Hit("b", np.array([[0, -1.0, 1, 0]]), 1.0)]
    law = ImpactLaw(order="sequential")
    after = Jump.of(np.eye(3), np.zeros((0, 4)), hits, np.array([1.0, 0, 0]), law)
    assert after.u == pytest.approx(np.array([0, 0, 1]), abs=1e-12)


def test_where_the_order_of_equal_impacts_decides_that_is_said():
    """A heavy ball between two light ones that meet it equally fast, e = 1/2."""
    hits = [Hit("a", np.array([[-1.0, 1, 0, 0]]), 0.5), Hit("b", np.array([[0, -1.0, 1, 0]]), 0.5)]
    with pytest.raises(DerivationError, match="the order of their impacts decides"):
        Jump.of(np.diag([1.0, 3, 1]), np.zeros((0, 4)), hits, np.array([1.0, 0, -1]), ImpactLaw(order="sequential"))


def test_poissons_law_of_a_cradle_is_newtons():
    """One e: (-e - 2/3 ...): compression to v/3, then e times its impulses."""
    hits = [Hit("a", np.array([[-1.0, 1, 0, 0]]), 0.7), Hit("b", np.array([[0, -1.0, 1, 0]]), 0.7)]
    u, held = np.array([1.0, 0, 0]), np.zeros((0, 4))
    assert Jump.of(np.eye(3), held, hits, u, ImpactLaw("poisson")).u == pytest.approx(
        Jump.of(np.eye(3), held, hits, u).u
    )


# -- the impact as equations -----------------------------------------------------------------------


def derived(text: str, contacts: str = "") -> dict:
    """The entry `impact` of derive --impact, whose certificate holds."""
    found = impact(eomgen.loads(HEAD + text), [name for name in contacts.split(",") if name])
    assert found.certify().ok
    return found.entries()["impact"]


def test_the_impact_of_a_dumbbell_in_formulas():
    """Lam = -(1 + e) v/(1/2m + x^2/I), x = -(l/2) cos phi; the loss is (1 - e^2) v^2/2 over the same."""
    found = derived(DUMBBELL)
    m, l, e, phi, vx, vy, w = sympy.symbols("m l e phi vx vy w")
    place = {"x'": "vx", "y'": "vy", "phi'": "w"}

    def read(text: str) -> sympy.Expr:
        text = functools.reduce(lambda s, name: s.replace(name, place[name]), place, text)
        return sympy.sympify(text.replace("^", "**"), locals={x.name: x for x in (m, l, e, phi, vx, vy, w)})

    x, inertia = -l * sympy.cos(phi) / 2, m * l**2 / 2
    effective, v = 1 / (1 / (2 * m) + x**2 / inertia), vy + x * w
    assert sympy.simplify(read(found["impulses"]["floor"]) + (1 + e) * v * effective) == 0
    assert sympy.simplify(read(found["loss"]) - (1 - e**2) * v**2 * effective / 2) == 0
    assert sympy.simplify(read(found["after"]["phi'"]) - (w - x * (1 + e) * v * effective / inertia)) == 0
    assert found["unknowns"] == ["x_after'", "y_after'", "phi_after'", "Lambda_floor"]


def test_the_impact_of_two_balls_at_once_and_of_one_of_them():
    """floor alone: -(1 + e) m1 y1'; both: each impulse stops and returns what is above it."""
    alone, both = derived(TWO_BALLS, "floor"), derived(TWO_BALLS, "floor,between")
    assert alone["impulses"] == {"floor": "-m1*(1 + e)*y1'"} and alone["after"]["y2'"] == "y2'"
    assert both["impulses"]["floor"] == "-(1 + e)*(m1*y1' + m2*y2')"
    assert both["impulses"]["between"] == "-m2*(1 + e)*y2'"


CRANK = """
coordinates.a = { start = 0.5, speed = 5 }
coordinates.b = { dependent = true, near = -0.2 }
coordinates.s = { dependent = true, near = 1 }
[parameters]
m = 1
r = 0.3
l = 1
e = 0.4
g = 0
[bodies.crank]
shape = { kind = "rod", mass = "m", length = "r" }
joint = { kind = "revolute", point = "start", angle = "a" }
[bodies.rod]
shape = { kind = "rod", mass = "m", length = "l" }
joint = { kind = "revolute", on = "crank.end", point = "start", angle = "b" }
[bodies.piston]
shape = { kind = "particle", mass = "m" }
joint = { kind = "prismatic", axis = [1, 0], displacement = "s", limits = [0.9, "inf"], restitution = "e" }
[constraints.pin]
kind = "pin"
points = ["rod.end", "piston.origin"]
"""


@pytest.mark.slow
def test_the_impact_of_a_closed_chain_is_that_of_its_run():
    """a' -> -e a'; the formula of the impulse at the state of the run's impact gives its number."""
    found, result = derived(CRANK), run(CRANK, 0.5)
    hit, last = result.impacts[0], result.phases[0].last
    values = {"m": 1, "r": 0.3, "l": 1, "e": 0.4, "a": last["a"], "b": last["b"]}
    formula = parse(found["impulses"]["piston_low"].replace("a'", "v"))
    assert formula.value_at({**values, "v": last["a'"]}) == pytest.approx(hit.impulses["piston_low"], rel=1e-6)
    loss = parse(found["loss"].replace("a'", "v"))
    assert loss.value_at({**values, "v": last["a'"]}) == pytest.approx(hit.loss, rel=1e-6)


def test_a_stop_that_is_open_at_the_start_is_none_of_the_loops_that_close_there():
    """`check` closes the pin alone, and says nothing of the stop but that it is open."""
    found = Checked.of(eomgen.loads(HEAD + CRANK))
    assert found.start.refused == "" and found.open == ("piston_low",)


# -- what is refused -------------------------------------------------------------------------------


def test_a_restitution_of_what_cannot_end_is_refused():
    with pytest.raises(ModelError, match="has a restitution and cannot end"):
        eomgen.loads(HEAD + BALL.replace("unilateral = true\n", ""))


def test_a_restitution_that_gains_energy_is_refused():
    with pytest.raises(EomgenError, match=r"the restitution of 'floor' is 1\.2"):
        result = run(BALL.replace("e = 0.6", "e = 1.2"), 1)
        if not result.ok:
            raise DerivationError(result.message)


def rows_of(text: str) -> np.ndarray:
    """Rows of numbers, one a line."""
    return np.array([[float(x) for x in line.split()] for line in text.split(";")])


def test_impacts_that_rub_where_no_law_is_sure_are_refused():
    """Five in space, three that rub by Stronge's law, one that rolls beside one that slides."""
    e, flat = 0.5, np.zeros((0, 4))
    a = Hit("a", rows_of("0 0 1 0"), e, False, 0.3, rows_of("1 0 0 0; 0 1 0 0"))
    with pytest.raises(DerivationError, match="several contacts at once of more than 4 in space"):
        Jump.of(np.eye(3), flat, [replace(a, name=name) for name in "abcde"], np.array([-1.0, 0.5, -1]))
    c, d = (Hit(name, rows_of(f"0 1 {x} 0"), e, False, 0.3, rows_of("1 0 0.5 0")) for name, x in (("c", 1), ("d", -1)))
    with pytest.raises(DerivationError, match="the energetic law is one of single contacts"):
        Jump.of(np.eye(3), flat, [c, d], -np.ones(3), ImpactLaw("energetic"))
    with pytest.raises(DerivationError, match="'d' rolls, and friction has a part"):
        Jump.of(np.eye(3), flat, [c, Hit("d", rows_of("0 1 1 0; 1 0 0 0"), e)], -np.ones(3))
    both = [Hit("c", c.rows, e), Hit("d", d.rows, e)]
    with pytest.raises(DerivationError, match="the energetic law is one of single contacts"):
        Jump.of(np.eye(3), flat, both, -np.ones(3), ImpactLaw("energetic"))


def test_an_impact_is_asked_of_a_contact_that_can_close():
    with pytest.raises(UsageError, match="several contacts can close: floor, between"):
        derived(TWO_BALLS)
    with pytest.raises(UsageError, match="'wall' is no contact that can close"):
        derived(TWO_BALLS, "wall")
    with pytest.raises(DerivationError, match="friction has a part in the impact of 'floor'"):
        impact(eomgen.loads('eomgen = 1\nspace = "space"\n' + ROUGH_BALL), [])


# -- machines with several contacts ----------------------------------------------------------------

BOX = """
parameters = { m = 1, g = 9.81, e = 0.3, b = 0.3, h = 0.2 }
coordinates = { x = {}, y = { start = 0.6 }, phi = { start = 0.3, speed = 0.5 } }
[bodies.box]
shape = { kind = "rectangle", mass = "m", width = "2*b", height = "2*h" }
points = { left = ["-b", "-h"], right = ["b", "-h"] }
joint = { kind = "planar", x = "x", y = "y", angle = "phi" }
[constraints.left]
kind = "support"
point = "box.left"
normal = [0, 1]
at = [0, 0]
unilateral = true
restitution = "e"
[constraints.right]
kind = "support"
point = "box.right"
normal = [0, 1]
at = [0, 0]
unilateral = true
restitution = "e"
"""
FUNNEL = """
parameters = { m = 1, g = 9.81, e = 0.7 }
coordinates = { x = { start = 0.13 }, y = { start = 1 } }
bodies.ball = { shape = { kind = "particle", mass = "m" }, joint = { kind = "placed", at = ["x", "y"] } }
[constraints.left]
kind = "support"
point = "ball.origin"
normal = [1, 1]
at = [0, 0]
unilateral = true
restitution = "e"
[constraints.right]
kind = "support"
point = "ball.origin"
normal = [-1, 1]
at = [0, 0]
unilateral = true
restitution = "e"
"""


@pytest.mark.slow
@pytest.mark.parametrize("text", [BOX, FUNNEL])
def test_what_falls_on_two_contacts_loses_what_its_impacts_say(text):
    """E at the start less E at the end is the sum of the losses; every impact is that of momenta and restitution."""
    result = run(text, 1.5)
    lost = sum(impact.loss for impact in result.impacts)
    assert result.energy[0] - result.energy[-1] == pytest.approx(lost, rel=1e-7)
    assert len(result.impacts) >= 5 and result.certify().ok


def test_a_box_comes_to_rest_on_both_corners():
    """After bounces without end on each: y = h, phi = 0."""
    result = run(BOX, 1.0)
    assert (result["y"][-1], result["phi"][-1]) == pytest.approx((0.2, 0), abs=1e-8)
    assert result.phases[-1].model.configuration.open == ()


# -- stops of joints with several angles -----------------------------------------------------------

CARDAN = """
eomgen = 1
space = "space"
parameters = { e = 0.5, I = 2 }
coordinates = { a = { speed = 0.3 }, b = { start = 5, speed = 40, unit = "deg" } }
[bodies.ball]
mass = 1
inertia = ["I", "I", "I"]
joint = { kind = "universal", axes = [[1, 0, 0], [1, 1, 0]], angles = ["a", "b"], LIMITS, restitution = "e" }
"""
ONE_END = 'limits = { angles = [["-inf", "inf"], [-10, 30]] }'


def test_a_stop_of_one_angle_of_a_cardan_joint_turns_the_other_where_the_axes_are_not_square():
    """T = I/2 (a'^2 + b'^2 + 2 c a' b'), c = n1 . n2: Lam = (1 + e) I (1 - c^2) b', a' -> a' + c (1 + e) b'."""
    model = eomgen.loads(CARDAN.replace("LIMITS", ONE_END))
    c, v = math.sqrt(0.5), math.radians(40)
    result = eomgen.simulate(model, time=1, target="numpy")
    (hit,) = result.impacts
    assert hit.t == pytest.approx(25 / 40, abs=1e-12) and hit.contact == "ball_angles2_high"
    assert hit.impulses["ball_angles2_high"] == pytest.approx(1.5 * 2 * (1 - c * c) * v, rel=1e-12)
    assert result["b'"][-1] == pytest.approx(-0.5 * v) and result["a'"][-1] == pytest.approx(0.3 + c * 1.5 * v)
    assert hit.loss == pytest.approx(2 * (1 - c * c) * v * v * 0.75 / 2) and result.certify().ok
    found = impact(model, ["ball_angles2_high"]).entries()["impact"]
    assert found["impulses"]["ball_angles2_high"] == "1/2*(1 + e)*I*b'" and "-b_after' = e*b'" in found["equations"]


def test_a_stop_of_the_third_turn_of_a_ball_joint_throws_the_first():
    """ "xyz", one moment of inertia I: Lam = (1 + e) I cos(b)^2 c', a' -> a' + (1 + e) sin(b) c'."""
    text = CARDAN.replace(
        'kind = "universal", axes = [[1, 0, 0], [1, 1, 0]]', 'kind = "spherical", orientation = "xyz"'
    )
    text = text.replace('angles = ["a", "b"]', 'angles = ["a", "b", "c"]').replace(
        'unit = "deg" }', 'unit = "deg" }, c = {}'
    )
    free = '["-inf", "inf"]'
    model = eomgen.loads(text.replace("LIMITS", f'limits = {{ angles = [{free}, {free}, [-10, "inf"]] }}'))
    found = impact(model, ["ball_angles3_low"])
    assert found.certify().ok and found.entries()["impact"]["after"] == {
        "a'": "a' + (1 + e)*sin(b)*c'",
        "b'": "b'",
        "c'": "-e*c'",
    }


@pytest.mark.parametrize(
    "limits, said",
    [
        ("limits = { angles = [[-1, 1]] }", "at least 2 entries"),
        ("limits = { angles = [[-1, 1], [-1, 1], [0, 1]] }", "limits of 3 angles, and the joint has 2"),
        ("limits = { angles = [[1, -1], [-1, 1]] }", "leave nothing between"),
        ("limits = [-1, 1]", "limits"),
    ],
)
def test_limits_that_do_not_fit_the_angles_are_told(limits, said):
    with pytest.raises(ModelError, match=said):
        eomgen.loads(CARDAN.replace("LIMITS", limits))


# -- verdicts on equations of impacts --------------------------------------------------------------


def lines_of(text: str, contacts: str) -> list[str]:
    """Every line that `derive --impact` prints."""
    found = derived(text, contacts)
    after = [f"{u.rstrip(chr(39))}_after{chr(39)} = {x}" for u, x in found["after"].items()]
    impulses = [f"Lambda_{name.replace(' ', '_')} = {x}" for name, x in found["impulses"].items()]
    joints = [
        f"impulse_{a}({name}) = {x}"
        for name, each in found["joints"].items()
        for a, x in zip("xyz", each, strict=False)
    ]
    cases, lines = found["cases"], [*found["equations"], *after, *impulses, *joints]
    lines += [f"{name} = {x}" for name, x in cases.get("letters", {}).items() if OF_CASES.search(f"{name} {x}")]
    for each in cases.get("others", ()):
        lines += [f"Lambda_{name.replace(' ', '_')} = {x}" for name, x in each["impulses"].items()]
        lines += [f"{u.rstrip(chr(39))}_after{chr(39)} = {x}" for u, x in each["after"].items()]
        lines += [f"T_before - T_after = {each['loss']}"] if "loss" in each else []
    return [*dict.fromkeys(lines), f"T_before - T_after = {found['loss']}"]


ROUGH_DISC = """
parameters = { m = 2, r = 0.3, e = 0.5, mu = 0.2, g = 9.81 }
coordinates = { x = { speed = 1 }, y = { start = 0.5 }, phi = { speed = 3 } }
bodies.disc.shape = { kind = "sphere", mass = "m", radius = "r" }
bodies.disc.joint = { kind = "planar", x = "x", y = "y", angle = "phi" }
[constraints.floor]
kind = "rolling"
body = "disc"
line = { at = [0, 0], normal = [0, 1] }
slip = true
unilateral = true
friction = "mu"
restitution = "e"
"""
ROUGH_ROD = """
parameters = { m = 1, l = 1, g = 9.81, e = 0.5, mu = 0.3 }
coordinates = { x = { speed = 0.2 }, y = { start = 1 }, phi = { start = 0.9 } }
bodies.rod.shape = { kind = "rod", mass = "m", length = "l" }
bodies.rod.joint = { kind = "planar", point = "center", x = "x", y = "y", angle = "phi" }
[constraints.floor]
kind = "support"
point = "rod.origin"
normal = [0, 1]
at = [0, 0]
unilateral = true
restitution = "e"
friction = "mu"
[impact]
law = "LAW"
"""


IMPACTS = [
    pytest.param(DUMBBELL, "floor", id="dumbbell"),
    pytest.param(TWO_BALLS, "floor", id="one of two"),
    pytest.param(TWO_BALLS, "floor,between", id="both"),
    pytest.param(CRANK, "piston_low", id="closed chain", marks=pytest.mark.slow),
    pytest.param(ROUGH_DISC, "floor", id="a disc that rubs"),
]


@pytest.mark.parametrize("text, contacts", IMPACTS)
def test_every_line_of_an_impact_is_judged_right_and_one_with_another_sign_wrong(text, contacts):
    """left = right; left = -(right), where neither is 0."""
    judge = Judge(Case(eomgen.loads(HEAD + text)))
    for line in lines_of(text, contacts):
        assert judge.verdict(line).verdict == "right", line
        left, right = line.split(" = ")
        if right != "0" and not left.startswith("impulse_"):
            wrong = judge.verdict(f"{left} = -({right})")
            assert wrong.verdict == "wrong" and wrong.kind == "impact", line


@pytest.mark.parametrize(
    "wrong, kind, said",
    [
        ("2*m*(y_after' - y') = -Lambda_floor", "sign", "Lambda_floor has the other sign"),
        ("m*(y_after' - y') = Lambda_floor", "factor", "Lambda_floor lacks the factor 1/2"),
        ("Lambda_floor = m*(1 - e)*(l*cos(phi)*phi' - 2*y')/(1 + cos(phi)^2)", "sign", "e has the other sign"),
        ("Lambda_floor = m*(l*cos(phi)*phi' - 2*y')/(1 + cos(phi)^2)", "missing_term", "restitution is missing"),
        ("x_after' = -x'", "sign", "the right side has the other sign"),
        ("x_after' = 0", "other", "it is x_after' = x'"),
        ("y_after' = y_after'", "other", "it holds whatever impulses and speeds are"),
    ],
)
def test_what_is_wrong_in_an_impact_is_said(wrong, kind, said):
    (cause,) = eomgen.verify(eomgen.loads(HEAD + DUMBBELL), wrong).causes
    assert cause.kind == kind and said in cause.text


@pytest.mark.parametrize(
    "written",
    [
        r"T^{-} - T^{+} = \frac{m (1 - e) (1 + e) (2 \dot{y} - l \dot{\phi} \cos\phi)^{2}}{4 (1 + \cos^{2}\phi)}",
        r"\dot{y}_{\mathrm{after}} - \frac{1}{2} l \, \dot{\phi}_{\mathrm{after}} \cos\phi = "
        r"\frac{1}{2} l e \dot{\phi} \cos\phi - e \dot{y}",
        r"2 m (\dot{y}^+ - \dot{y}^-) = \Lambda_{\mathrm{floor}}",
        "2*m*(y'^+ - y') = impulse(floor)",
    ],
)
def test_equations_of_impacts_are_read_as_people_write_them(written):
    found = eomgen.verify(eomgen.loads(HEAD + DUMBBELL), written)
    assert found.verdict == "right" and found.given == written


@pytest.mark.slow
def test_a_number_of_an_impact_is_judged_at_its_instant():
    """Lam = (1 + e) v/(1/(2 m) + (l/2 cos phi)^2/I) = 7.507 N s where the ball touches, y = l/2 sin(phi)."""
    model = eomgen.loads(HEAD + DUMBBELL)
    assert eomgen.verify(model, "Lambda_floor = 7.507", at="y = l/2*sin(phi)")
    assert eomgen.verify(model, "Lambda_floor = 7.6", at="y = l/2*sin(phi)").verdict == "wrong"


def test_names_that_no_impact_has_and_impacts_that_rub_are_undecided():
    model = eomgen.loads(HEAD + DUMBBELL)
    assert eomgen.verify(model, "z_after' = 2").unknown == ("z_after'",)
    rough = eomgen.loads('eomgen = 1\nspace = "space"\n' + ROUGH_BALL)
    found = eomgen.verify(rough, "x_after' = x'")
    assert found.verdict == "undecided" and "friction has a part in the impact" in found.reason


ROUGH_BALL = """
coordinates = { x = { speed = 1 }, z = { start = 1 } }
bodies.ball = { shape = { kind = "particle", mass = 1 }, joint = { kind = "placed", at = ["x", 0, "z"] } }
[constraints.floor]
kind = "support"
point = "ball.origin"
normal = [0, 0, 1]
at = [0, 0, 0]
unilateral = true
restitution = 0.5
friction = 0.3
"""


def test_the_impact_of_what_slides_on_in_formulas():
    """M (u+ - u) = (n - mu sign(v_t) t) Lam; where v_t keeps its sign, Lam and u+ are those of Routh's graph."""
    text = DUMBBELL.replace('restitution = "e"', 'restitution = "e"\nfriction = 0.3')
    found = derived(text)
    names = {"m": 1, "l": 1, "e": 0.5, "phi": 0.5, "x'": 3, "y'": -4, "phi'": 0.2}

    def number(written: str) -> float:
        return float(
            sympy.sympify(written.replace("'", "_"), {f"{k.replace(chr(39), '_')}": v for k, v in names.items()})
        )

    x, y = -math.cos(0.5) / 2, -math.sin(0.5) / 2
    v = np.array([-4 + x * 0.2, 3 - y * 0.2])
    D = np.array([[0.5 + x * x / 0.5, -x * y / 0.5], [-x * y / 0.5, 0.5 + y * y / 0.5]])
    p = alone(D, v, Rubbing("floor", 0.3, 0.5))
    assert (v + D @ p)[1] * v[1] > 0
    assert number(found["impulses"]["floor"]) == pytest.approx(p[0], rel=1e-12)
    assert number(found["after"]["x'"]) == pytest.approx(3 + p[1] / 2, rel=1e-12)
    assert number(found["slides_on"]["floor"][1]) == pytest.approx((v + D @ p)[1], rel=1e-12)
    assert number(found["loss"]) == pytest.approx(-(v @ p + p @ D @ p / 2), rel=1e-12)
    model = eomgen.loads(HEAD + text)
    right = "2*m*(x_after' - x') = -0.3*sign(2*x' + l*sin(phi)*phi')*Lambda_floor"
    said = eomgen.verify(model, right)
    assert said.verdict == "right" and said.up_to.startswith("the impact of floor as long as it slides on, while ")
    assert eomgen.verify(model, right.replace("-0.3", "0.3")).verdict == "wrong"
    assert eomgen.verify(model, "x_after' = x'").verdict == "wrong"


def test_a_ball_with_spin_sticks_in_its_impact_up_to_seven_halves_of_its_friction():
    """|x' + r phi'| <= 7/2 mu (1 + e) |y'|:  x'+ = (5 x' - 2 r phi')/7, Lam_t = -2/7 m (x' + r phi').

    It comes down with y' = -sqrt(2 g (h - r)) and 1.9 m/s of sliding: 7/2 of 0.2 and 1.5 of 1.98 m/s hold that.
    """
    found = derived(ROUGH_DISC)["cases"]
    (sticks,) = found["others"]
    model = eomgen.loads(HEAD + ROUGH_DISC)
    assert found["chosen"] == sticks["name"] == "sticks" and found["slides_on"] != sticks["while"]
    m, r, e, mu, x, y, phi = 2, 0.3, 0.5, 0.2, 1.0, -1.98, 3.0
    known = {"m": m, "r": r, "e": e, "mu": mu, "x'": x, "y'": y, "phi'": phi}
    left, right = (value(side, known) for side in sticks["while"][0].split(" <= "))
    assert (left, right) == pytest.approx((abs(x + r * phi), 3.5 * mu * (1 + e) * -y))
    assert value(sticks["after"]["x'"], known) == pytest.approx((5 * x - 2 * r * phi) / 7)
    assert value(sticks["impulses"]["floor t"], known) == pytest.approx(-2 / 7 * m * (x + r * phi))
    lost = value(sticks["loss"], known)
    assert lost == pytest.approx(m * (1 - e**2) * y**2 / 2 + m * (x + r * phi) ** 2 / 7)
    said = eomgen.verify(model, "x_after' = (5*x' - 2*r*phi')/7")
    assert said.verdict == "right" and said.up_to == f"the impact of floor where it sticks, while {sticks['while'][0]}"
    assert eomgen.verify(model, "x_after' = (5*x' + 2*r*phi')/7").verdict == "wrong"
    assert eomgen.verify(model, "y_after' = -e*y'").up_to == "the impact of floor"


def value(written: str, known: dict[str, float]) -> float:
    """Number of a printed formula."""
    names = {k.replace("'", "_"): v for k, v in known.items()}
    functions = {"sqrt": math.sqrt, "sin": math.sin, "cos": math.cos, "abs": abs, "sign": np.sign}
    return float(eval(written.replace("'", "_").replace("^", "**"), functions, names))


@pytest.mark.parametrize("law", ["newton", "poisson", "energetic"])
def test_each_case_of_a_rod_that_rubs_has_the_speeds_of_its_graph_in_formulas(law):
    """Of random rods exactly the bounds of one case hold: where v_t+ has its sign, is 0, or has the other one.

    The formulas as they are printed against the graph, which follows the impact from corner to corner.
    """
    found = derived(ROUGH_ROD.replace("LAW", law))["cases"]
    rng, seen = np.random.default_rng(21), set()
    for _ in range(150):
        phi, (x, y, w), mu, e = rng.uniform(0, 6.28), rng.normal(size=3), rng.uniform(0, 0.8), rng.uniform(0, 1)
        known = {"m": 1, "l": 1, "mu": mu, "e": e, "phi": phi, "x'": x, "y'": y, "phi'": w}
        rx, ry = -math.cos(phi) / 2, -math.sin(phi) / 2
        D = np.array([[1 + 12 * rx * rx, -12 * rx * ry], [-12 * rx * ry, 1 + 12 * ry * ry]])
        v = np.array([y + rx * w, x - ry * w])
        if v[0] >= 0 or mu * abs(D[0, 1]) > D[0, 0]:
            continue
        for name, text in found["letters"].items():
            known[name] = value(text, known)
        assert [known[k] for k in ("v_n", "v_t", "D_nn", "D_nt", "D_tt")] == pytest.approx([*v, *D[0], D[1, 1]])
        p = alone(D, v, Rubbing("tip", mu, e), law)
        after = v + D @ p
        within = [
            each
            for each in (None, *found["others"])
            if all(
                value(a, known) <= value(b, known)
                for a, b in (side.split(" <= ") for side in (found["slides_on"] if each is None else each["while"]))
            )
        ]
        (case,) = within
        name = "slides on" if case is None else case["name"].partition(" from")[0]
        does = "sticks" if abs(after[1]) < 1e-9 else "slides on" if after[1] * v[1] > 0 else "slides back"
        assert name == does
        if case is not None:
            known["Lambda_floor"] = value(case["impulses"]["floor"], known)
            known["Lambda_floor_t"] = value(case["impulses"]["floor t"], known)
            assert (known["Lambda_floor"], known["Lambda_floor_t"]) == pytest.approx(p, abs=1e-9)
            assert value(case["after"]["x'"], known) == pytest.approx(x + p[1])
            seen.add(case["name"])
    assert len(seen) == 4


def test_the_formulas_of_each_case_in_letters_are_judged_within_its_bounds():
    """Lambda = ... p_s ... of each of four cases; what follows from the impulses alone holds in all."""
    text = ROUGH_ROD.replace("LAW", "poisson")
    judge, found = Judge(Case(eomgen.loads(HEAD + text))), derived(text)["cases"]
    for each in found["others"]:
        said = judge.verdict(f"Lambda_floor = {each['impulses']['floor']}")
        if "restitution" not in each["name"]:
            assert said.up_to == f"the impact of floor where it {each['name']}, while {' and '.join(each['while'])}"
        assert said.verdict == "right" and each["name"] in said.up_to
    assert judge.verdict("Lambda_floor = p_s + v_s/a_b").verdict == "wrong"
    assert judge.verdict(f"D_nt = {found['letters']['D_nt']}").up_to == "the impact of floor"
    assert judge.verdict(f"x_after' = {found['others'][0]['after'][chr(120) + chr(39)]}").up_to == "the impact of floor"


# -- impulses of joints ----------------------------------------------------------------------------

LIFT = """
parameters = { m = 2, M = 3, d = 0.4, e = 0.25, g = 9.81 }
coordinates = { y = { start = 0.5 } }
bodies.lift = { mass = "M", joint = { kind = "prismatic", axis = [0, 1], displacement = "y", LIMITS } }
[bodies.load]
shape = { kind = "particle", mass = "m" }
points.foot = ["-d", 0]
joint = { kind = "fixed", on = "lift", point = "foot" }
"""
FALLS = 'limits = [0, "inf"], restitution = "e"'


def test_a_weld_takes_the_impulse_and_the_couple_of_what_it_carries():
    """A load m at d beside the slide: (m (1 + e) v, d m (1 + e) v); the slide takes the couple, the stop (M + m)."""
    result = run(LIFT.replace("LIMITS", FALLS), 0.5)
    change, found = 1.25 * math.sqrt(2 * G * 0.5), result.impacts[0].impulses
    assert found["lift_low"] == pytest.approx(5 * change) and found["impulse_x(lift)"] == pytest.approx(0, abs=1e-12)
    assert (found["impulse_x(load)"], found["impulse_y(load)"]) == pytest.approx((0, 2 * change), abs=1e-12)
    assert found["impulse_couple(load)"] == pytest.approx(0.4 * 2 * change)
    assert found["impulse_couple(lift)"] == pytest.approx(0.4 * 2 * change)


@pytest.mark.slow
def test_the_impulses_of_joints_in_a_run_are_those_of_the_formulas():
    """A loop: numbers by the momenta of what each joint carries, formulas by the balance of every body."""
    closing = CRANK.replace("{ dependent = true, near = -0.2 }", "-0.2").replace(
        "{ dependent = true, near = 1 }", "1.2"
    )
    found, result = derived(CRANK), run(closing, 0.5)
    hit, last = result.impacts[0], result.phases[0].last
    values = {"m": 1, "r": 0.3, "l": 1, "e": 0.4, "a": last["a"], "b": last["b"], "v": last["a'"]}
    assert found["joints"].keys() == {"crank", "rod", "piston"}
    for name, (x, y) in found["joints"].items():
        for axis, text in (("x", x), ("y", y)):
            formula = parse(text.replace("a'", "v"))
            due = formula.value_at({letter: values[letter] for letter in formula.names})
            assert hit.impulses[f"impulse_{axis}({name})"] == pytest.approx(due, rel=1e-6, abs=1e-9)


TAIL = """
parameters = { m = 2, l = 1, e = 0.5, g = 9.81 }
coordinates = { x = { speed = 1 }, y = 1, phi = 0.3, psi = 1 }
[bodies.bar]
mass = "m"
inertia = "m*l^2/12"
points = { a = ["-l/2", 0], b = ["l/2", 0] }
joint = { kind = "planar", x = "x", y = "y", angle = "phi" }
[bodies.tail]
shape = { kind = "rod", mass = "m", length = "l" }
joint = { kind = "revolute", on = "bar.b", point = "start", angle = "psi" }
[constraints.floor]
kind = "support"
point = "bar.a"
normal = [0, 1]
at = [0, 0]
unilateral = true
restitution = "e"
friction = 0.2
"""


def test_the_impulse_of_a_hinge_is_the_momentum_of_what_it_carries_where_the_impact_rubs():
    """d(m v) of the tail; that of the bar is what the floor and the hinge leave it."""
    result = run(TAIL, 0.6)
    hit, early, late = result.impacts[0], result.phases[0].last, result.phases[1].first

    def of_tail(state):
        w = state["phi'"] + state["psi'"]
        along, across = state["phi"], state["phi"] + state["psi"]
        x = state["x'"] - state["phi'"] * math.sin(along) / 2 - w * math.sin(across) / 2
        y = state["y'"] + state["phi'"] * math.cos(along) / 2 + w * math.cos(across) / 2
        return 2 * np.array([x, y])

    of_hinge = np.array([hit.impulses[f"impulse_{axis}(tail)"] for axis in "xy"])
    assert of_hinge == pytest.approx(of_tail(late) - of_tail(early), abs=1e-8)
    of_bar = 2 * np.array([late[q] - early[q] for q in ("x'", "y'")])
    assert of_bar + of_hinge == pytest.approx([hit.impulses["floor t"], hit.impulses["floor"]], abs=1e-8)
    assert not any("(bar)" in name for name in hit.impulses)
