"""Chapters 9 and 10 and the turntable: positions written down by hand, differentiated in 50 digits; nothing of eomgen.

Each function takes the numbers of its statement [SI] and gives what the exercise asks, in SI: where a point is at the
time t follows from triangles and circles, its velocity and acceleration are the derivatives of that by mpmath. Only
the plate of ch9-p11, of which no motion is given, is solved from Euler's v_B = v_A + omega x r and its rate.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Any

import mpmath
from mpmath import acos, atan2, cos, mpf, pi, sin, sqrt

DIGITS = 50

Numbers = Mapping[str, Any]
Answers = dict[str, Any]
Place = Callable[[Any], tuple[Any, Any]]
ORACLES: dict[str, Callable[[Numbers], Answers]] = {}

STATEMENT: dict[str, dict[str, str]] = {
    "ch9_p1": {"R": "0.5", "l": "1.3", "k": "0.03", "t1": "3"},
    "ch9_p2": {"l": "0.3", "v_E": "0.6", "t1": "0.5"},
    "ch9_p3": {"a_A": "0.3", "b": "0.4", "h": "0.3", "t1": "1"},
    "ch9_s9_p1": {"R": "0.4", "omega": "0.5"},
    "ch9_p6": {"b": "0.4", "h": "0.3", "t1": "1"},
    "ch9_p7": {"l": "0.5", "epsilon": "1", "v_B0": "1", "t1": "1"},
    "ch9_p8": {"l": "0.5", "v_A": "0.8", "t1": "0.2"},
    "ch9_p9": {"l": "1.5", "h": "0.5", "v_A": "0.5", "t1": "1"},
    "ch9_p10": {"l": "1.2", "R": "0.5", "v_A": "1"},
    "ch9_p11": {"l": "0.8", "v": "2"},
    "ch10_p1": {"v_t": "2", "a_t": "1", "v_r": "2", "a_r": "2", "alpha": "pi/6"},
    "ch10_p2": {"l": "1", "k": "pi/3", "c": "0.125"},
    "ch10_p3": {"R": "0.25", "a_0": "0.1", "t1": "2"},
    "ch10_p4": {"R": "0.3", "omega": "1", "u": "0.25"},
    "s1_rotating_frame": {"m": "0.2", "Omega": "2", "alpha": "0.5", "a": "0.3", "t1": "1"},
}
"""The numbers of the statements in SI; where the statement leaves one open, the file's."""

OTHER: dict[str, dict[str, str]] = {
    "ch9_p1": {"R": "0.7", "l": "0.9", "k": "0.11", "t1": "1.3"},
    "ch9_p2": {"l": "0.4", "v_E": "0.5", "t1": "0.7"},
    "ch9_p3": {"a_A": "0.7", "b": "0.2", "h": "0.9", "t1": "1.7"},
    "ch9_s9_p1": {"R": "0.15", "omega": "3.5"},
    "ch9_p6": {"b": "0.7", "h": "0.2", "t1": "1.4"},
    "ch9_p7": {"l": "0.8", "epsilon": "0.6", "v_B0": "1.7", "t1": "2.3"},
    "ch9_p8": {"l": "0.7", "v_A": "0.3", "t1": "1.6"},
    "ch9_p9": {"l": "2.1", "h": "0.8", "v_A": "0.7", "t1": "1.9"},
    "ch9_p10": {"l": "1.9", "R": "0.6", "v_A": "0.7"},
    "ch9_p11": {"l": "1.1", "v": "0.7"},
    "ch10_p1": {"v_t": "1.3", "a_t": "2.1", "v_r": "0.7", "a_r": "1.6", "alpha": "0.7"},
    "ch10_p2": {"l": "1.3", "k": "0.8", "c": "0.21"},
    "ch10_p3": {"R": "0.4", "a_0": "0.07", "t1": "1.3"},
    "ch10_p4": {"R": "0.2", "omega": "1.7", "u": "0.6"},
    "s1_rotating_frame": {"m": "0.7", "Omega": "1.3", "alpha": "0.9", "a": "0.4", "t1": "1.7"},
}
"""Every number another one."""


def oracle(function: Callable[[Numbers], Answers]) -> Callable[[Numbers], Answers]:
    """Puts a system into ORACLES under the name of its model file."""
    ORACLES[function.__name__] = function
    return function


# -- derivatives and vectors of the plane --------------------------------------------------------------------------


def rate(f: Callable[[Any], Any], t: Any, order: int = 1) -> Any:
    return mpmath.diff(f, t, order)


def motion(place: Place, t: Any) -> tuple[tuple[Any, Any], tuple[Any, Any]]:
    """Velocity and acceleration of a point whose place is known at every time."""
    v, a = ((rate(lambda s: place(s)[0], t, n), rate(lambda s: place(s)[1], t, n)) for n in (1, 2))
    return v, a


def length(vector: tuple[Any, Any]) -> Any:
    return mpmath.hypot(*vector)


def turned(angle: Any, x: Any, y: Any) -> tuple[Any, Any]:
    """(x, y) in axes turned by the angle, seen from those that did not turn."""
    return x * cos(angle) - y * sin(angle), x * sin(angle) + y * cos(angle)


def named(name: str, vector: tuple[Any, Any]) -> Answers:
    """A vector's magnitude and components, as the outputs call them."""
    return {name: length(vector), f"{name}_x": vector[0], f"{name}_y": vector[1]}


def slowest(at_A: tuple[Any, Any], at_B: tuple[Any, Any]) -> Any:
    """The least speed between A and B, whose velocities are known: velocities along a segment lie on a segment.

    |v_A + s (v_B - v_A)|, 0 <= s <= 1.
    """
    change = (at_B[0] - at_A[0], at_B[1] - at_A[1])
    s = -(at_A[0] * change[0] + at_A[1] * change[1]) / (change[0] ** 2 + change[1] ** 2)
    s = min(max(s, mpf(0)), mpf(1))
    return length((at_A[0] + s * change[0], at_A[1] + s * change[1]))


# -- chapter 9 -----------------------------------------------------------------------------------------------------


@oracle
def ch9_p1(p: Numbers) -> Answers:
    """C = (k t^3/3, R); A is behind it on the floor, so the rod falls by R over its length, always."""
    t = p["t1"]

    def centre(t: Any) -> Any:
        return p["k"] * t**3 / 3

    def angle_of_rod(t: Any) -> Any:
        return atan2(-p["R"], sqrt(p["l"] ** 2 - p["R"] ** 2))

    v, a = motion(lambda t: (centre(t) + p["l"] * cos(angle_of_rod(t)), mpf(0)), t)
    wheel = rate(lambda t: centre(t) / p["R"], t)
    return {"v": length(v), "a": length(a), "omega_rod": rate(angle_of_rod, t), "omega_wheel": wheel}


@oracle
def ch9_p2(p: Numbers) -> Answers:
    """E on its circle about O1, F on an equal one about O2, EF = O1O2: the plate stays level."""
    t = p["t1"]

    def corner(t: Any) -> tuple[Any, Any]:
        turn = p["v_E"] * t / p["l"]
        return p["l"] * sin(turn) + 5 * p["l"] / 2, -p["l"] * cos(turn) - p["l"]

    v, a = motion(corner, t)
    return {"theta1": p["v_E"] * t / p["l"], **named("v", v), **named("a", a)}


@oracle
def ch9_p3(p: Numbers) -> Answers:
    v, a = motion(lambda t: (p["a_A"] * t**2 / 2, p["h"]), p["t1"])
    return {"v": length(v), "a": length(a), "displacement": p["a_A"] * p["t1"] ** 2 / 2}


@oracle
def ch9_s9_p1(p: Numbers) -> Answers:
    """|v'| along v is the rate of the speed."""
    v, a = motion(lambda t: turned(p["omega"] * t, p["R"], 0), mpf("0.3"))
    return {"v": length(v), "a": length(a), "a_t": (v[0] * a[0] + v[1] * a[1]) / length(v)}


@oracle
def ch9_p6(p: Numbers) -> Answers:
    t = p["t1"]
    points = {"A": (p["b"], 0), "B": (p["b"], p["h"]), "C": (0, p["h"])}
    found = {"theta1": sin(t), "omega1": rate(sin, t), "epsilon1": rate(sin, t, 2)}
    for name, (x, y) in points.items():
        v, a = motion(lambda s, x=x, y=y: turned(sin(s), x, y), t)
        found |= {f"v_{name}": length(v), f"a_{name}": length(a)}
        if name == "A":
            along = abs(v[0] * a[0] + v[1] * a[1]) / length(v)
            found |= {"a_A_t": along, "a_A_n": abs(v[0] * a[1] - v[1] * a[0]) / length(v)}
    return found


@oracle
def ch9_p7(p: Numbers) -> Answers:
    """B is sqrt(2) l from O: omega(0) = v_B0/(sqrt(2) l)."""
    t, l = p["t1"], p["l"]

    def angle(t: Any) -> Any:
        return p["v_B0"] / (sqrt(mpf(2)) * l) * t + p["epsilon"] * t**2 / 2

    found = {"omega0": rate(angle, mpf(0)), "omega1": rate(angle, t), "theta1": angle(t)}
    for name, x, y in (("A", l, 0), ("B", l, l), ("C", 0, l)):
        v, a = motion(lambda s, x=x, y=y: turned(angle(s), x, y), t)
        found |= {f"v_{name}": length(v), f"a_{name}": length(a)}
    return found


@oracle
def ch9_p8(p: Numbers) -> Answers:
    """A = (v_A t, 0), B above O; across and along the rod a_B - a_A is what a turn about A alone would give."""
    t, l = p["t1"], p["l"]

    def angle(t: Any) -> Any:
        return acos(-p["v_A"] * t / l)

    (v_A, a_A), (v_B, a_B) = (
        motion(lambda s: (p["v_A"] * s, mpf(0)), t),
        motion(lambda s: (mpf(0), sqrt(l**2 - (p["v_A"] * s) ** 2)), t),
    )
    along, across = turned(-angle(t), a_B[0] - a_A[0], a_B[1] - a_A[1])
    return {
        "x_A": p["v_A"] * t,
        "omega1": rate(angle, t),
        "epsilon1": rate(angle, t, 2),
        "v_B_y": -v_B[1],
        "a_A": length(a_A),
        "a_B_y": -a_B[1],
        "a_B_t": abs(across),
        "a_B_n": abs(along),
        "v_min": slowest(v_A, v_B),
    }


@oracle
def ch9_p9(p: Numbers) -> Answers:
    """The bar points from A = (v_A t, 0) to C = (0, h)."""
    t = p["t1"]

    def angle(t: Any) -> Any:
        return atan2(p["h"], -p["v_A"] * t)

    v_B, a_B = motion(lambda s: (p["v_A"] * s + p["l"] * cos(angle(s)), p["l"] * sin(angle(s))), t)
    turning = {"omega": rate(angle, t), "epsilon": rate(angle, t, 2)}
    return {**turning, **named("v_B", v_B), **named("a_B", a_B), "v_min": slowest((p["v_A"], mpf(0)), v_B)}


@oracle
def ch9_p10(p: Numbers) -> Answers:
    """A = R (cos phi, sin phi), phi = -pi/2 - v_A t/R, the rod from A to C = (R, 0)."""
    R, now = p["R"], mpf(0)

    def A(t: Any) -> tuple[Any, Any]:
        phi = -pi / 2 - p["v_A"] * t / R
        return R * cos(phi), R * sin(phi)

    def angle(t: Any) -> Any:
        return atan2(-A(t)[1], R - A(t)[0])

    def on_rod(distance: Any) -> Place:
        return lambda t: (A(t)[0] + distance * cos(angle(t)), A(t)[1] + distance * sin(angle(t)))

    v_C, _ = motion(on_rod(sqrt(mpf(2)) * R), now)
    v_B, a_B = motion(on_rod(p["l"]), now)
    _, a_A = motion(A, now)
    turning = {"omega": -rate(angle, now), "epsilon": rate(angle, now, 2)}
    return {**turning, "v_C": length(v_C), **named("v_B", v_B), "a_A": length(a_A), **named("a_B", a_B)}


@oracle
def ch9_p11(p: Numbers) -> Answers:
    """v_C = v_A + omega e_z x AC fixes omega; a_C - a_B = epsilon e_z x BC - omega^2 BC with BC = (0, l) the rest.

    -k = -epsilon l,  0 - k = -omega^2 l
    """
    l, v = p["l"], p["v"]
    omega = mpmath.lu_solve(mpmath.matrix([[-l], [l]]), mpmath.matrix([0 - v, v - 0]))[0]
    k = omega**2 * l
    epsilon = k / l
    points = {"A": (0, 0), "B": (l, 0), "D": (0, l), "M": (l / 2, l / 2)}
    found = {"omega": omega, "epsilon": epsilon, "a_B": k}
    for name, (x, y) in points.items():
        velocity = (v - omega * y, omega * x)
        dx, dy = x - l, y - mpf(0)
        acceleration = (-epsilon * dy - omega**2 * dx, k + epsilon * dx - omega**2 * dy)
        if name != "A":
            found |= {f"v_{name}_x": velocity[0], f"v_{name}_y": velocity[1]}
        if name != "B":
            found |= {f"a_{name}_x": acceleration[0], f"a_{name}_y": acceleration[1]}
    return found


# -- chapter 10 ----------------------------------------------------------------------------------------------------


@oracle
def ch10_p1(p: Numbers) -> Answers:
    """Coriolis: what the acceleration has beyond the prism's and the one along the face."""

    def place(t: Any) -> tuple[Any, Any]:
        way = p["v_r"] * t + p["a_r"] * t**2 / 2
        return p["v_t"] * t + p["a_t"] * t**2 / 2 - way * cos(p["alpha"]), -way * sin(p["alpha"])

    v, a = motion(place, mpf(0))
    rest = (a[0] - p["a_t"] + p["a_r"] * cos(p["alpha"]), a[1] + p["a_r"] * sin(p["alpha"]))
    return {**named("v", v), **named("a", a), "a_coriolis": length(rest)}


@oracle
def ch10_p2(p: Numbers) -> Answers:
    """OP = c t^2 = l/2; transport: the bar's own point there. Coriolis: a - a_t - a_r."""
    t = sqrt(p["l"] / (2 * p["c"]))

    def angle(t: Any) -> Any:
        return p["k"] * t**2 / 2

    def OP(t: Any) -> Any:
        return p["c"] * t**2

    v, a = motion(lambda s: turned(angle(s), OP(s), 0), t)
    v_t, a_t = motion(lambda s: turned(angle(s), p["l"] / 2, 0), t)
    radial, transverse = turned(-angle(t), *a)
    t_radial, t_transverse = turned(-angle(t), *a_t)
    a_r = rate(OP, t, 2)
    return {
        "t1": t,
        "theta1": angle(t),
        "v_r": rate(OP, t),
        "a_r": a_r,
        "v_t": length(v_t),
        "a_t_tangential": abs(t_transverse),
        "a_t_normal": abs(t_radial),
        "a_coriolis": length((radial - t_radial - a_r, transverse - t_transverse)),
        "v": length(v),
        "a_radial": radial,
        "a_transverse": transverse,
        "a": length(a),
    }


@oracle
def ch10_p3(p: Numbers) -> Answers:
    """The radius AP turns by the arc over R, pi t^2/12."""
    v, a = motion(lambda t: (p["a_0"] * t**2 + p["R"] * cos(pi * t**2 / 12), p["R"] * sin(pi * t**2 / 12)), p["t1"])
    return {**named("v", v), **named("a", a)}


@oracle
def ch10_p4(p: Numbers) -> Answers:
    """From O the centre is at R along OA, and P at R from it, turned from O by u t/R."""
    t = pi / (2 * p["omega"])

    def in_frame(t: Any) -> tuple[Any, Any]:
        x, y = turned(p["u"] * t / p["R"], -p["R"], 0)
        return p["R"] + x, y

    v, a = motion(lambda s: turned(p["omega"] * s - pi / 2, *in_frame(s)), t)
    held = in_frame(t)
    _, a_t = motion(lambda s: turned(p["omega"] * s - pi / 2, *held), t)
    _, a_r = motion(in_frame, t)  # OA is along +x: the axes of the frame are those of the ground
    coriolis = (a[0] - a_t[0] - a_r[0], a[1] - a_t[1] - a_r[1])
    return {"t1": t, **named("v", v), **named("a", a), "a_coriolis": length(coriolis)}


# -- the turntable -------------------------------------------------------------------------------------------------


def acceleration_on_table(turn: Callable[[Any], Any], place: Place) -> tuple[Any, Any]:
    """Absolute acceleration at t = 0 of what moves on a table, in the table's axes."""
    _, a = motion(lambda t: turned(turn(t), *place(t)), mpf(0))
    return turned(-turn(mpf(0)), *a)


@oracle
def s1_rotating_frame(p: Numbers) -> Answers:
    """Seen from the room the puck goes straight on, from (a, 0) with the velocity Omega a across.

    The parts of the absolute acceleration: that of a point at rest on a table that turns evenly; what its moving on the
    table adds; what the table's turning faster adds. The forces are minus m times them.

    Args:
        p: beside the parameters the places and speeds on the tables x, y, x', y', xi, eta.
    """
    m, Omega, t1 = p["m"], p["Omega"], p["t1"]
    x, y = turned(-Omega * t1, p["a"], p["a"] * Omega * t1)
    at_rest = acceleration_on_table(lambda t: Omega * t, lambda t: (p["x"], p["y"]))
    moving = acceleration_on_table(lambda t: Omega * t, lambda t: (p["x"] + p["x'"] * t, p["y"] + p["y'"] * t))
    second = acceleration_on_table(lambda t: Omega * t, lambda t: (p["xi"], p["eta"]))
    faster = acceleration_on_table(lambda t: Omega * t + p["alpha"] * t**2 / 2, lambda t: (p["xi"], p["eta"]))
    return {
        "x": x,
        "y": y,
        "F_coriolis_x": -m * (moving[0] - at_rest[0]),
        "F_coriolis_y": -m * (moving[1] - at_rest[1]),
        "F_centrifugal_x": -m * at_rest[0],
        "F_centrifugal_y": -m * at_rest[1],
        "euler_term_x": -m * (faster[0] - second[0]),
        "euler_term_y": -m * (faster[1] - second[1]),
        "x_dd": -moving[0],  # x'' of the puck is what cancels the rest of its absolute acceleration
        "y_dd": -moving[1],
    }
