"""Chapters 16 and 17 of the textbook, derived from Newton and Euler in sympy: nothing of eomgen is used here.

Each function gives what its exercise asks, as sympy expressions. The speed that belongs to a place comes twice: from
the energy, and as the solution of d(q'^2)/dq = 2 q'' with q'' from Newton and Euler; `speed_squared` insists that the
two agree. Friction and the pieces of a path are treated piece by piece, as one does by hand.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import sympy
from sympy import Matrix, Rational, acos, cos, exp, log, pi, sign, sin, sqrt

M, m, l, g, v0, H, R, L, k = sympy.symbols("M m l g v0 H R L k", positive=True)
alpha, mu, omega0, t1, x1, v_A, v_B = sympy.symbols("alpha mu omega0 t1 x1 v_A v_B", positive=True)
theta, x, rho, t = sympy.symbols("theta x rho t", real=True)
y = sympy.Symbol("y", real=True)  # the square of the rate of the one coordinate

ORACLES: dict[str, Callable[[], dict[str, Any]]] = {}


def oracle(function: Callable[[], dict[str, Any]]) -> Callable[[], dict[str, Any]]:
    """Puts a system into ORACLES under the name of its model file."""
    ORACLES[function.__name__] = function
    return function


# -- the laws ------------------------------------------------------------------------------------------------------


def second_derivative(f: Any, q: sympy.Symbol, acceleration: Any) -> Any:
    """f'' = f_qq q'^2 + f_q q'', with y = q'^2."""
    return sympy.diff(f, q, 2) * y + sympy.diff(f, q) * acceleration


def newton_euler(q, mass, inertia, centre, angle, forces, unknowns) -> dict[Any, Any]:
    """q'' and the reactions of one body with one coordinate, as functions of q and y = q'^2.

    m r'' = sum F,  J phi'' = sum (p - r) x F

    Args:
        forces: (place, force) of the weight and of every reaction.
        unknowns: the symbols of the reactions in `forces`.
    """
    a = sympy.Symbol("a")
    moments = [(p[0] - centre[0]) * F[1] - (p[1] - centre[1]) * F[0] for p, F in forces]
    equations = [
        mass * second_derivative(centre[0], q, a) - sum(F[0] for _, F in forces),
        mass * second_derivative(centre[1], q, a) - sum(F[1] for _, F in forces),
        inertia * second_derivative(sympy.sympify(angle), q, a) - sum(moments),
    ]
    (found,) = sympy.solve([e for e in map(sympy.expand, equations) if e != 0], [a, *unknowns], dict=True)
    return {"acceleration": sympy.trigsimp(found.pop(a)), **found}


def speed_squared(q, energy, potential, acceleration, start, start_speed=0):
    """y = q'^2 at q, from T(q, y) + V = its value at the start.

    Raises:
        AssertionError: dy/dq = 2 q'' of Newton and Euler does not hold.
    """
    total = energy.subs({q: start, y: start_speed**2}) + potential.subs(q, start)
    (found,) = sympy.solve(energy + potential - total, y)
    assert sympy.simplify(sympy.diff(found, q) - 2 * acceleration.subs(y, found)) == 0
    assert sympy.simplify(found.subs(q, start) - start_speed**2) == 0
    return sympy.factor(found)


# -- particles -----------------------------------------------------------------------------------------------------


@oracle
def ch16_p1() -> dict[str, Any]:
    """x'' = 0, y'' = -g, integrated twice; the impact is the positive root of y = 0."""
    height = H - g * t**2 / 2
    (t_B,) = (root for root in sympy.solve(height, t) if root.is_positive)
    fall = sympy.diff(height, t).subs(t, t_B)
    return {"t_B": t_B, "x_B": v0 * t_B, "v_Bx": v0, "v_By": fall, "v_B": sqrt(v0**2 + fall**2)}


@oracle
def ch16_p2() -> dict[str, Any]:
    """v' = -k v - g e_y: v = (v(0) + g/k e_y) exp(-k t) - g/k e_y; at the landing A (1 - exp(-tau)) = tau, tau = k t.

    With A = 1 + k v0 sin(alpha)/g the root tau > 0 is A + W(-A exp(-A)), W the principal branch.
    """
    vx, vy = v0 * cos(alpha) * exp(-k * t), (v0 * sin(alpha) + g / k) * exp(-k * t) - g / k
    way_x, way_y = (sympy.integrate(v, (t, 0, t)) for v in (vx, vy))
    A = 1 + k * v0 * sin(alpha) / g
    top, landing = log(A) / k, (A + sympy.LambertW(-A * exp(-A))) / k
    assert sympy.simplify(vy.subs(t, top)) == 0
    found = {name: value.subs(t, landing) for name, value in (("x_B", way_x), ("v_Bx", vx), ("v_By", vy))}
    return {"t_max": top, "h_max": sympy.simplify(way_y.subs(t, top)), "k_t_B": k * landing, **found}


@oracle
def ch16_p3() -> dict[str, Any]:
    """Energy and moment of momentum, at the greatest distance, where the velocity v is across the radius.

    v rho = v0 R cos(alpha),  v^2/2 - g R^2/rho = v0^2/2 - g R
    """
    across = v0 * R * cos(alpha) / rho
    bracket = sympy.expand((across**2 / 2 - g * R**2 / rho - v0**2 / 2 + g * R) * rho**2)
    a, b, c = sympy.Poly(bracket, rho).all_coeffs()
    far = (-b + sqrt(b**2 - 4 * a * c)) / (2 * a)  # a > 0, as v0^2 < 2 g R: the larger root
    return {"h_max": far - R}


@oracle
def ch16_p4() -> dict[str, Any]:
    """Across the wire m l theta'' = -m g sin(theta); along it T - m g cos(theta) = m l theta'^2."""
    acceleration = -g / l * sin(theta)
    squared = speed_squared(theta, m * l**2 * y / 2, -m * g * l * cos(theta), acceleration, 0, v0 / l)
    T = m * g * cos(theta) + m * l * squared
    (full,) = sympy.solve(T.subs(theta, pi), v0)
    (slack,) = sympy.solve(T.subs(cos(theta), x), x)
    return {
        "T": T,
        "theta_d_squared": squared,
        "v_60": l * sqrt(squared.subs(theta, pi / 3)),
        "T_60": T.subs(theta, pi / 3),
        "v0_full_circle": full,
        "cos_theta_slack": slack,
        "theta_dd": acceleration,
    }


def down_into_an_arc(friction: Any) -> dict[str, Any]:
    """v dv/ds = g sin(fall) - mu N/m on each piece, N - m g cos(fall) = m v^2 / (radius of the piece).

    The fall of the path is alpha on the plane, and alpha - s/R on the arc, s from B.
    """
    s = sympy.Symbol("s", positive=True)
    on_plane = g * sin(alpha) - friction * g * cos(alpha)
    squared_B = v0**2 + 2 * on_plane * L
    gain = sympy.integrate(2 * g * sin(alpha - s / R), (s, 0, s))
    squared = squared_B + gain
    N = m * g * cos(alpha - s / R) + m * squared / R
    C, D = R * alpha, R * (alpha + pi / 2)
    return {
        "v_B": sqrt(squared_B),
        "v_C": sqrt(squared.subs(s, C)),
        "v_D": sqrt(squared.subs(s, D)),
        "N_B_before": m * g * cos(alpha),
        "N_B_after": N.subs(s, 0),
        "N_C": N.subs(s, C),
        "N_D": N.subs(s, D),
    }


@oracle
def ch16_p5() -> dict[str, Any]:
    """Without friction."""
    return down_into_an_arc(0)


@oracle
def ch16_p7() -> dict[str, Any]:
    """With friction on the plane."""
    return down_into_an_arc(mu)


@oracle
def ch16_p6() -> dict[str, Any]:
    """Across the plane N = m g cos(alpha); along it m x'' = -m g sin(alpha) - mu N up, + mu N down.

    The way back is the work theorem: m v^2/2 = (m g sin(alpha) - mu N) x_stop.
    """
    N, weight = m * g * cos(alpha), m * g * sin(alpha)
    up, down = -(weight + mu * N) / m, (weight - mu * N) / m
    t_stop = -v0 / up
    x_stop = v0 * t_stop + up * t_stop**2 / 2
    return {
        "x_dd_up": up,
        "t_stop": t_stop,
        "x_stop": x_stop,
        "F_f_max": mu * N,
        "weight_component": weight,
        "stays": 1 - sympy.Max(0, sign(weight - mu * N)),
        "s_dd_down": down,
        "v_return_to_A": sqrt(2 * down * x_stop),
    }


# -- rigid bodies --------------------------------------------------------------------------------------------------


@oracle
def ch17_p1() -> dict[str, Any]:
    """The centre as a thrown particle, the spin unchanged."""
    way, height = v0 * cos(alpha) * t, R + v0 * sin(alpha) * t - g * t**2 / 2
    return {
        "x_C": way.subs(t, t1),
        "y_C": height.subs(t, t1),
        "theta": omega0 * t1,
        "trajectory_y": height.subs(t, x1 / (v0 * cos(alpha))),
    }


@oracle
def ch17_p2() -> dict[str, Any]:
    """Both ends from v_C and omega of the start, v = v_C + omega x r; after 2 s v_C has lost 2 g, omega nothing."""
    omega = (v_B - v_A) / (2 * l)
    v_C, turned = (v_A + v_B) / 2 - 2 * g, 2 * omega
    v_x, v_y = -omega * l * sin(turned), v_C + omega * l * cos(turned)
    return {"omega": omega, "v_C_y": v_C, "v_B_x": v_x, "v_B_y": v_y, "v_B": sqrt(v_x**2 + v_y**2)}


@oracle
def ch17_p3() -> dict[str, Any]:
    """The hinge pulls the bar with R_rho towards O and pushes it with R_n across."""
    pull, push = sympy.symbols("pull push")
    along, across = Matrix([cos(theta), -sin(theta)]), Matrix([sin(theta), cos(theta)])
    centre = l / 2 * along
    hinge = -pull * along + push * across
    forces = [(centre, (0, -M * g)), ((0, 0), tuple(hinge))]
    found = newton_euler(theta, M, M * l**2 / 12, centre, -theta, forces, (pull, push))
    acceleration = found["acceleration"]
    squared = speed_squared(theta, M * l**2 / 6 * y, -M * g * l / 2 * sin(theta), acceleration, 0)
    R_rho, R_n = (sympy.trigsimp(found[name].subs(y, squared)) for name in (pull, push))
    return {
        "theta_d_squared": squared,
        "v_A": l * sqrt(squared.subs(theta, pi / 2)),
        "R_rho": R_rho,
        "R_n": R_n,
        "R_rho_vertical": R_rho.subs(theta, pi / 2),
        "R_n_vertical": R_n.subs(theta, pi / 2),
        "theta_dd": acceleration,
    }


@oracle
def ch17_p4() -> dict[str, Any]:
    """The floor's N is the only force beside the weight: the centre falls on a vertical, A slides back under it."""
    N = sympy.Symbol("N")
    centre, A = (sympy.S.Zero, l * cos(theta)), (-l * sin(theta), 0)
    found = newton_euler(theta, M, M * l**2 / 3, centre, -theta, [(centre, (0, -M * g)), (A, (0, N))], (N,))
    energy = M * y / 2 * sympy.diff(centre[1], theta) ** 2 + M * l**2 / 6 * y
    squared = speed_squared(theta, energy, M * g * centre[1], found["acceleration"], 0)
    at = {theta: pi / 4}
    return {
        "theta_d_squared": squared,
        "x_C": centre[0],
        "v_A_45": sqrt(squared.subs(at)) * abs(sympy.diff(A[0], theta).subs(at)),
        "N_A_45": found[N].subs(y, squared).subs(at),
        "theta_dd_45": found["acceleration"].subs(y, squared).subs(at),
        "N_A": found[N].subs(y, squared),
    }


@oracle
def ch17_p5() -> dict[str, Any]:
    """The wall's push vanishes, after the start, where 3 cos(theta) = 2."""
    floor, wall = sympy.symbols("floor wall")
    centre, A, B = (l * sin(theta), l * cos(theta)), (2 * l * sin(theta), 0), (0, 2 * l * cos(theta))
    forces = [(centre, (0, -3 * M * g)), (A, (0, floor)), (B, (wall, 0))]
    found = newton_euler(theta, 3 * M, M * l**2, centre, theta, forces, (floor, wall))
    squared = speed_squared(theta, 2 * M * l**2 * y, 3 * M * g * centre[1], found["acceleration"], 0)
    N_floor, N_wall = (sympy.factor(sympy.trigsimp(found[name].subs(y, squared))) for name in (floor, wall))
    (cosine,) = sympy.solve(sympy.cancel(N_wall / sin(theta)).subs(cos(theta), x), x)
    separation = {theta: acos(cosine)}
    return {
        "theta_sep": acos(cosine),
        "theta_d_squared": squared,
        "N_wall": N_wall,
        "N_floor": N_floor,
        "theta_d_squared_at_sep": squared.subs(separation),
        "N_floor_at_sep": N_floor.subs(separation),
    }


@oracle
def ch17_p6() -> dict[str, Any]:
    """The bar stays level; the two tensions pull its ends along the cables, which are parallel."""
    left, right = sympy.symbols("left right")
    cable = (cos(theta), -sin(theta))  # from O1 to A
    A = tuple(l * e for e in cable)
    centre, B = (A[0] + l, A[1]), (A[0] + 2 * l, A[1])
    pulls = [(p, tuple(-T * e for e in cable)) for p, T in ((A, left), (B, right))]
    forces = [(centre, (0, -2 * M * g)), *pulls]
    found = newton_euler(theta, 2 * M, Rational(2, 3) * M * l**2, centre, 0, forces, (left, right))
    squared = speed_squared(theta, M * l**2 * y, 2 * M * g * centre[1], found["acceleration"], 0)
    T1, T2 = (sympy.trigsimp(found[name].subs(y, squared)) for name in (left, right))
    assert sympy.simplify(T1 - T2) == 0
    vertical = {theta: pi / 2}
    return {
        "v_A": l * sqrt(squared.subs(vertical)),
        "T1": T1.subs(vertical),
        "T2": T2.subs(vertical),
        "T_general": T1,
        "theta_d_squared": squared,
    }
