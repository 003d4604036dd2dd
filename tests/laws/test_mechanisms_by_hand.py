"""Mechanisms of other textbooks: what `solve` answers against positions by hand, differentiated in 50 digits."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Any

import mpmath
import pytest
from mpmath import asin, atan2, cos, mpf, pi, sin, sqrt
from oracle_of_chapters_9_10 import DIGITS, length, motion, rate, slowest, turned
from slow_run import sampled, usual

import eomgen

pytestmark = pytest.mark.slow

MODELS = Path(__file__).parents[2] / "models"
HEAD = 'eomgen = 1\nname = "mechanism"\nspace = "plane"\n'
Found = dict[str, Any]


def close(answers: dict[str, Any], expected: Found) -> None:
    values = {name: answers[name].value for name in expected}
    assert values == pytest.approx({name: float(x) for name, x in expected.items()}, rel=1e-10, abs=1e-10)


def numbers(text: str) -> list[Any]:
    return [mpf(x) for x in text.split()]


# -- models of the folder ----------------------------------------------------------------------------------------


def quick_return() -> Found:
    """The lever points from C = (0, -d) to the pin; its end B is b from the ram at the height h."""
    r, d, L, b, h, n = *numbers("0.15 0.4 0.7 0.3 0.25"), 2 * pi

    def pin(t: Any) -> tuple[Any, Any]:
        return r * cos(pi / 6 + n * t), r * sin(pi / 6 + n * t)

    def lever(t: Any) -> Any:
        return atan2(pin(t)[1] + d, pin(t)[0])

    def in_slot(t: Any) -> Any:
        return mpmath.hypot(pin(t)[0], pin(t)[1] + d)

    def ram(t: Any) -> Any:
        rise = h + d - L * sin(lever(t))
        return L * cos(lever(t)) - sqrt(b**2 - rise**2)

    omega, v = rate(lever, 0), rate(in_slot, 0)
    return {
        "omega_lever": omega,
        "epsilon_lever": rate(lever, 0, 2),
        "v_in_slot": v,
        "a_in_slot": rate(in_slot, 0, 2),
        "a_coriolis": 2 * abs(omega * v),
        "v_ram": rate(ram, 0),
        "a_ram": rate(ram, 0, 2),
        "omega_upright": n * r / (d + r),
        "c_x": 0,
        "c_y": omega * d / (n - omega),  # n y = omega (y + d)
    }


def epicyclic_gear() -> Found:
    """Where wheels touch they have one velocity.

    (a + b) w_arm - b w = a w_sun,  (a + b) w_arm + b w = (a + 2 b) w_ring
    """
    a, b, w_sun, w_arm = numbers("0.08 0.05 5 -2")
    w = ((a + b) * w_arm - a * w_sun) / b

    def Q(t: Any) -> tuple[Any, Any]:
        return tuple((a + b) * f(w_arm * t) + b * f(w * t) for f in (cos, sin))

    v, acceleration = motion(Q, mpf(0))
    return {
        "omega_planet": w,
        "omega_ring": ((a + b) * w_arm + b * w) / (a + 2 * b),
        "v_Q": length(v),
        "a_Q": length(acceleration),
        "c_planet": (a + b) * (1 - w_arm / w),
        "c_planet_sun": a,
        "c_planet_ring": a + 2 * b,
    }


def slewing_crane() -> Found:
    """Tip s (cos theta cos psi, cos theta sin psi, sin theta); omega = W e_z - V e_y of the tower."""
    W, V, u, l0 = numbers("0.3 0.2 0.5 10")

    def place(t: Any) -> list[Any]:
        s, theta = l0 + u * t, pi / 6 + V * t
        return [s * cos(theta) * cos(W * t), s * cos(theta) * sin(W * t), s * sin(theta)]

    def derivative(t: Any, order: int) -> list[Any]:
        return [rate(lambda x, i=i: place(x)[i], t, order) for i in range(3)]

    theta = pi / 6
    v = derivative(0, 1)
    return {
        "omega": mpmath.hypot(W, V),
        "epsilon": W * V,
        **dict(zip(("v_x", "v_y", "v_z"), v, strict=True)),
        "a": mpmath.norm(derivative(0, 2)),
        "v_t": l0 * sqrt((W * cos(theta)) ** 2 + V**2),
        "a_coriolis": 2 * u * sqrt((W * cos(theta)) ** 2 + V**2),
        "a_coriolis_tower": 2 * W * abs(u * cos(theta) - l0 * V * sin(theta)),
        "a_later": mpmath.norm(derivative(2, 2)),
    }


@sampled(3)
@pytest.mark.parametrize("book", [quick_return, epicyclic_gear, slewing_crane])
def test_a_model_of_the_folder_moves_as_drawn_by_hand(book):
    with mpmath.workdps(DIGITS):
        expected = book()
    answers = eomgen.solve(eomgen.load(MODELS / f"{book.__name__}.toml"))
    assert answers.keys() == expected.keys()
    assert all(answer.exact for answer in answers.values())
    close(answers, expected)


# -- short ones --------------------------------------------------------------------------------------------------

GENEVA = """
parameters = { r = 0.1, w = 10 }
[coordinates]
theta = { start = "3*pi/4 + 0.3", rate = "w" }
phi = { dependent = true, near = -0.5 }
[bodies.driver]
points = { pin = ["r", 0] }
joint = { kind = "revolute", at = ["sqrt(2)*r", 0], angle = "theta" }
[bodies.wheel]
points = { O = [0, 0], S = ["r", 0] }
line = ["O", "S"]
joint = { kind = "revolute", angle = "phi" }
[constraints]
slot = { kind = "slider", point = "driver.pin", on = "wheel" }
[outputs]
omega = "omega(wheel)"
epsilon = "epsilon(wheel)"
omega_mid = { value = "omega(wheel)", at = "theta = pi" }
coriolis = { value = "coriolis_acceleration(driver.pin, wheel)", at = "theta = pi - 1/5" }
t_mid = { value = "t", at = "theta = pi" }
"""


def geneva() -> Found:
    """The slot points from the wheel's hinge to the pin at (sqrt 2 r + r cos, r sin)."""
    r, w = numbers("0.1 10")

    def pin(t: Any) -> tuple[Any, Any]:
        return sqrt(mpf(2)) * r + r * cos(3 * pi / 4 + mpf("0.3") + w * t), r * sin(3 * pi / 4 + mpf("0.3") + w * t)

    def slot(t: Any) -> Any:
        return atan2(*reversed(pin(t)))

    middle = (pi / 4 - mpf("0.3")) / w
    near = middle - mpf("0.2") / w
    coriolis = 2 * abs(rate(slot, near) * rate(lambda t: mpmath.hypot(*pin(t)), near))
    turning = {"omega": rate(slot, 0), "epsilon": rate(slot, 0, 2), "omega_mid": rate(slot, middle)}
    return {**turning, "coriolis": coriolis, "t_mid": middle}


WHEEL_IN_RING = """
parameters = { R = 0.6, r = 0.25, w = 2 }
[coordinates]
psi = { rate = "w" }
phi = { dependent = true, start = 0.4 }
[bodies.wheel]
shape = { kind = "disc", mass = 0, radius = "r" }
points = { P = ["r", 0] }
joint = { kind = "planar", x = "(R - r)*cos(psi)", y = "(R - r)*sin(psi)", angle = "phi" }
[constraints]
track = { kind = "rolling", body = "wheel", circle = { at = [0, 0], radius = "R", inside = true } }
[outputs]
omega = "omega(wheel)"
v = { value = "speed(wheel.P)", at = "t = 0.7" }
a = { value = "acceleration(wheel.P)", at = "t = 0.7" }
rho = "curvature_radius(wheel.P)"
c_x = "rotation_center_x(wheel)"
pole_x = "acceleration_pole_x(wheel)"
"""


def wheel_in_ring() -> Found:
    """The touching point rests: (R - r) w + r omega = 0."""
    R, r, w = numbers("0.6 0.25 2")
    omega = -(R - r) * w / r

    def P(t: Any) -> tuple[Any, Any]:
        return tuple((R - r) * f(w * t) + r * f(mpf("0.4") + omega * t) for f in (cos, sin))

    (v, a), (v0, a0) = motion(P, mpf("0.7")), motion(P, mpf(0))
    rho = length(v0) ** 3 / abs(v0[0] * a0[1] - v0[1] * a0[0])
    pole = (R - r) * (1 - w**2 / omega**2)
    return {"omega": omega, "v": length(v), "a": length(a), "rho": rho, "c_x": R, "pole_x": pole}


ROD_IN_BOWL = """
parameters = { R = 0.2, l = 0.6, v = 0.1 }
[coordinates]
x = { dependent = true, near = -0.1 }
y = { dependent = true, near = -0.17 }
theta = { start = "pi/6", rate = "-v/R" }
[points]
O = [0, 0]
C = ["R", 0]
[bodies.rod]
shape = { kind = "rod", mass = 0, length = "l" }
line = ["start", "end"]
joint = { kind = "planar", x = "x", y = "y", angle = "theta" }
[constraints]
bowl = { kind = "link", points = ["O", "rod.start"], length = "R" }
rim = { kind = "slider", point = "C", on = "rod" }
[outputs]
v_A = "speed(rod.start)"
a_A = "acceleration(rod.start)"
v_B = "speed(rod.end)"
a_B = "acceleration(rod.end)"
v_C = "transport_speed(C, rod)"
v_min = "least_speed(rod.start, rod.end)"
c_x = "rotation_center_x(rod)"
c_y = "rotation_center_y(rod)"
"""


def rod_in_bowl() -> Found:
    """A chord from C = (R, 0) with the slope theta ends in A = -R (cos 2 theta, sin 2 theta)."""
    R, l, v = numbers("0.2 0.6 0.1")
    omega = -v / R

    def theta(t: Any) -> Any:
        return pi / 6 + omega * t

    def at(distance: Any) -> Callable[[Any], tuple[Any, Any]]:
        return lambda t: tuple(-R * f(2 * theta(t)) + distance * f(theta(t)) for f in (cos, sin))

    (v_A, a_A), (v_B, a_B), (v_C, _) = (motion(at(s), mpf(0)) for s in (mpf(0), l, 2 * R * cos(pi / 6)))
    A = at(mpf(0))(mpf(0))
    center = {"c_x": A[0] - v_A[1] / omega, "c_y": A[1] + v_A[0] / omega}
    speeds = {"v_A": length(v_A), "v_B": length(v_B), "v_C": length(v_C), "v_min": slowest(v_A, v_B)}
    return {**speeds, "a_A": length(a_A), "a_B": length(a_B), **center}


BED = """
parameters = { d = 1.5, b = 1.2, l0 = 1.0, u = 0.2 }
[coordinates]
s = { start = "l0", rate = "u" }
alpha = { dependent = true, near = 1 }
theta = { dependent = true, near = 0.7 }
[bodies.bed]
points = { B = ["b", 0], E = ["2*b", 0] }
joint = { kind = "revolute", angle = "theta" }
[bodies.cylinder]
joint = { kind = "revolute", at = ["d", 0], angle = "alpha" }
[bodies.piston]
joint = { kind = "prismatic", on = "cylinder", axis = [1, 0], displacement = "s" }
[constraints]
B = { kind = "pin", points = ["bed.B", "piston.origin"] }
[outputs]
omega = "omega(bed)"
epsilon = "epsilon(bed)"
v_E = "speed(bed.E)"
a_E = "acceleration(bed.E)"
omega_1 = { value = "omega(bed)", at = "t = 1" }
epsilon_1 = { value = "epsilon(bed)", at = "s = 1.3" }
"""


def bed() -> Found:
    """cos(theta) = (d^2 + b^2 - s^2)/(2 d b)."""
    d, b, l0, u = numbers("1.5 1.2 1 0.2")

    def theta(t: Any) -> Any:
        return mpmath.acos((d**2 + b**2 - (l0 + u * t) ** 2) / (2 * d * b))

    v, a = motion(lambda t: turned(theta(t), 2 * b, 0), mpf(0))
    later = {"omega_1": rate(theta, 1), "epsilon_1": rate(theta, mpf("1.5"), 2)}
    return {"omega": rate(theta, 0), "epsilon": rate(theta, 0, 2), "v_E": length(v), "a_E": length(a), **later}


ENGINE = """
parameters = { r = 0.05, l = 0.2, w = 100 }
[coordinates]
theta = { start = "pi/3", rate = "w" }
phi = { dependent = true, near = -0.2 }
x = { dependent = true, near = 0.2 }
[bodies.crank]
points = { A = ["r", 0] }
joint = { kind = "revolute", angle = "theta" }
[bodies.rod]
points = { B = ["l", 0], G = ["l/3", 0] }
joint = { kind = "revolute", on = "crank.A", angle = "phi - theta" }
[bodies.piston]
joint = { kind = "prismatic", axis = [1, 0], displacement = "x" }
[constraints]
wrist = { kind = "pin", points = ["rod.B", "piston.origin"] }
[outputs]
v = "x'"
a = "ax(piston.origin)"
epsilon = "epsilon(rod)"
a_G = "acceleration(rod.G)"
c_y = "rotation_center_y(rod)"
v_across = { value = "x'", at = "theta = pi/2" }
a_dead = { value = "x''", at = "theta = pi" }
"""


def engine() -> Found:
    """sin(phi) = -r/l sin(theta)."""
    r, l, w = numbers("0.05 0.2 100")

    def theta(t: Any) -> Any:
        return pi / 3 + w * t

    def phi(t: Any) -> Any:
        return -asin(r / l * sin(theta(t)))

    def on_rod(distance: Any) -> Callable[[Any], tuple[Any, Any]]:
        return lambda t: tuple(r * f(theta(t)) + distance * f(phi(t)) for f in (cos, sin))

    (v, a), (_, a_G) = motion(on_rod(l), mpf(0)), motion(on_rod(l / 3), mpf(0))
    across, dead = motion(on_rod(l), pi / 6 / w)[0], motion(on_rod(l), 2 * pi / 3 / w)[1]
    c_y = on_rod(l)(0)[0] * mpmath.tan(pi / 3)  # on the crank's line, above the piston
    found = {"v": v[0], "a": a[0], "epsilon": rate(phi, 0, 2), "a_G": length(a_G), "c_y": c_y}
    return {**found, "v_across": across[0], "a_dead": dead[0]}


SHORT = [
    (GENEVA, geneva),
    (WHEEL_IN_RING, wheel_in_ring),
    (ROD_IN_BOWL, rod_in_bowl),
    (BED, bed),
    (ENGINE, engine),
]


@pytest.mark.parametrize(("text", "book"), usual([*SHORT], 2, 1), ids=lambda x: getattr(x, "__name__", ""))
def test_a_mechanism_moves_as_drawn_by_hand(text, book):
    with mpmath.workdps(DIGITS):
        expected = book()
    answers = eomgen.solve(eomgen.loads(HEAD + text))
    assert answers.keys() == expected.keys()
    close(answers, expected)


def test_a_rod_between_collars_on_skew_rods():
    """x^2 + (3 s/5)^2 + (0.3 + 4 s/5)^2 = l^2 with x = 0.2 + v t, along (0, 3, 4)/5."""
    text = """
    eomgen = 1
    space = "space"
    parameters = { l = 0.7, v = 0.3 }
    [coordinates]
    x = { start = 0.2, rate = "v" }
    s = { dependent = true, near = 0.5 }
    [bodies]
    A.joint = { kind = "prismatic", axis = [1, 0, 0], displacement = "x" }
    B.joint = { kind = "prismatic", at = [0, 0, 0.3], axis = [0, 3, 4], displacement = "s" }
    [constraints]
    rod = { kind = "link", points = ["A.origin", "B.origin"], length = "l" }
    [outputs]
    v = "speed(B.origin)"
    a = "acceleration(B.origin)"
    v_1 = { value = "vy(B.origin)", at = "t = 1/2" }
    """
    with mpmath.workdps(DIGITS):
        l, v = numbers("0.7 0.3")

        def s(t: Any) -> Any:
            return -mpf("0.24") + sqrt(mpf("0.24") ** 2 - mpf("0.09") - (mpf("0.2") + v * t) ** 2 + l**2)

        expected = {"v": abs(rate(s, 0)), "a": abs(rate(s, 0, 2)), "v_1": mpf("0.6") * rate(s, mpf("0.5"))}
    close(eomgen.solve(eomgen.loads(text)), expected)


def test_a_spool_is_wound_along_by_its_own_thread():
    """Pulled below its centre by v: it rolls after the hand, faster than it: R v/(R - r), R being its flange."""
    text = (
        HEAD
        + """
    parameters = { R = 0.3, r = 0.2, v = 0.6 }
    coordinates = { x = { dependent = true }, phi = { dependent = true }, s = { start = 2, rate = "v" } }
    [bodies.spool]
    shape = { kind = "disc", mass = 0, radius = "R" }
    joint = { kind = "planar", x = "x", y = "R", angle = "phi" }
    [bodies.hand]
    joint = { kind = "prismatic", at = [0, "R - r"], axis = [1, 0], displacement = "s" }
    [constraints]
    floor = { kind = "rolling", body = "spool", line = { at = [0, 0], normal = [0, 1] } }
    [constraints.thread]
    kind = "string"
    path = [{ body = "spool", radius = "r", turn = "ccw" }, "hand.origin"]
    strands = ["right"]
    [outputs]
    v = "vx(spool.center)"
    omega = "omega(spool)"
    c_y = "rotation_center_y(spool)"
    """
    )
    answers = eomgen.solve(eomgen.loads(text))
    assert {name: answer.exact for name, answer in answers.items()} == {
        "v": "R*v/(R - r)",
        "omega": "v/(r - R)",
        "c_y": "0",
    }


def test_velocities_need_no_mass_and_accelerations_say_that_they_do():
    """A crank with a speed that nothing drives: omega_rod/omega_crank = -r cos(theta)/(l cos(phi)); x'' is open."""
    text = HEAD + ENGINE.replace('rate = "w"', 'speed = "w"').partition("[outputs]")[0]
    answers = eomgen.solve(eomgen.loads(text + '[outputs]\nratio = "omega(rod)/omega(crank)"\na = "x\'\'"\n'))
    assert answers["ratio"].exact == "-r*cos(theta)/(l*cos(phi))"
    assert answers["a"].exact is None and "'theta' moves no mass" in answers["a"].message
    with pytest.raises(eomgen.ModelError, match="moves no mass"):
        eomgen.solve(eomgen.loads(text + "[outputs]\na = \"x''\"\n"))


def test_parallel_cranks_hand_on_the_angle_itself():
    """A coupler between equal parallel cranks translates: exactly, with every length and angle a symbol."""
    text = (
        HEAD
        + """
    parameters = { r = 0.3, l = 0.8, w = 2, t1 = 0.4, a0 = 0.6 }
    coordinates = { a = { start = "a0", rate = "w" }, b = { dependent = true }, c = { dependent = true, near = 1 } }
    bodies.crank = { points = { E = ["r", 0] }, joint = { kind = "revolute", angle = "a" } }
    bodies.bar = { points = { F = ["l", 0] }, joint = { kind = "revolute", on = "crank.E", angle = "b - a" } }
    bodies.rocker = { points = { F = ["r", 0] }, joint = { kind = "revolute", at = ["l", 0], angle = "c" } }
    constraints.F = { kind = "pin", points = ["bar.F", "rocker.F"] }
    outputs.turn = { value = "angle(bar)", at = "t = t1" }
    outputs.c = { value = "c", at = "t = t1" }
    outputs.v_x = { value = "vx(bar.F)", at = "t = t1" }
    outputs.a = { value = "acceleration(bar.F)", at = "t = t1" }
    """
    )
    answers = eomgen.solve(eomgen.loads(text))
    assert {name: answer.exact for name, answer in answers.items()} == {
        "turn": "0",
        "c": "w*t1 + a0",
        "v_x": "-r*w*sin(w*t1 + a0)",
        "a": "r*w^2",
    }


def test_a_four_bar_linkage_is_placed_in_closed_form():
    """Each angle by the loop without the other, so that neither formula holds the other's; against a float solve."""
    text = (
        HEAD
        + """
    parameters = { a = 0.4, b = 1.0, c = 0.8, d = 1.1, w = 2, t1 = 0.3 }
    [coordinates]
    alpha = { start = 1.0, rate = "w" }
    beta = { dependent = true, near = 0.5 }
    gamma = { dependent = true, near = 1.5 }
    [bodies]
    crank = { points = { E = ["a", 0] }, joint = { kind = "revolute", angle = "alpha" } }
    coupler = { points = { E = ["b", 0] }, joint = { kind = "revolute", on = "crank.E", angle = "beta - alpha" } }
    rocker = { points = { E = ["c", 0] }, joint = { kind = "revolute", at = ["d", 0], angle = "gamma" } }
    [constraints]
    B = { kind = "pin", points = ["coupler.E", "rocker.E"] }
    [outputs]
    beta = { value = "beta", at = "t = t1" }
    gamma = { value = "gamma", at = "t = t1" }
    omega = { value = "omega(rocker)", at = "t = t1" }
    """
    )
    with mpmath.workdps(DIGITS):
        a, b, c, d = numbers("0.4 1 0.8 1.1")

        def angles(t: Any) -> Any:
            x, y = a * cos(1 + 2 * t), a * sin(1 + 2 * t)
            gaps = (lambda p, q: x + b * cos(p) - c * cos(q) - d, lambda p, q: y + b * sin(p) - c * sin(q))
            return mpmath.findroot(lambda p, q: [gap(p, q) for gap in gaps], (0.5, 1.5))

        now = mpf("0.3")
        step = mpf(10) ** -12
        slope = (angles(now + step)[1] - angles(now - step)[1]) / (2 * step)
        expected = {"beta": angles(now)[0], "gamma": angles(now)[1], "omega": slope}
    answers = eomgen.solve(eomgen.loads(text))
    close(answers, expected)
    assert all(answers[name].exact and len(answers[name].exact) < 400 for name in ("beta", "gamma"))
