"""Chapters 18, 20 and 22 of the seeds by Newton and Euler, body by body; nothing of eomgen is used here.

The place of every body is a function of the coordinates; the forces on it stand beside it, unknown ones as symbols.
m a_C = sum F and I alpha = sum M_C of all bodies are then linear in the accelerations and the unknown forces, and are
solved at a state in 60 digits: more equations than unknowns, so what is left over must vanish too. The energy theorem
gives the rates; that the two agree (dE/dt = 0 with the accelerations of Newton and Euler) is the second check.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field
from typing import Any

import mpmath
import sympy
from sympy import Expr, Matrix, Symbol, cos, pi, sin, sqrt, symbols

DIGITS = 60
TINY = mpmath.mpf(10) ** -30

PARAMETERS = M, l, R, g, k, l0, a, h, t1 = symbols("M l R g k l0 a h t1", positive=True)
theta, phi, x, y, z, r, s = symbols("theta phi x y z r s")
Place = tuple[Any, Any]
Force = tuple[Place, Place]


@dataclass(frozen=True)
class Body:
    """A rigid body: mass, inertia about its centre, place of the centre, angle (ccw), and forces (place, components).

    Its weight (0, -m g) is understood.
    """

    mass: Any
    inertia: Any
    centre: Place
    angle: Any = 0
    forces: tuple[Force, ...] = ()


@dataclass(frozen=True)
class Requested:
    """An output: a function of q, q', q'' and the unknown forces; at which place, and with which rates.

    Args:
        place: the coordinates at the instant (None: any).
        from_rest: the rate of the single coordinate is that of the energy theorem, from rest at the start.
    """

    value: Any
    place: dict[Symbol, Any] = field(default_factory=dict)
    from_rest: bool = False


@dataclass(frozen=True)
class System:
    """Bodies, the unknown forces on them, what is asked.

    Args:
        start: coordinates at the start, from rest.
        work: of the forces besides the weights, as a function of the coordinates.
    """

    q: tuple[Symbol, ...]
    bodies: tuple[Body, ...]
    unknowns: tuple[Symbol, ...]
    requested: dict[str, Requested]
    start: dict[Symbol, Any] = field(default_factory=dict)
    work: Any = 0

    @property
    def kinetic_energy(self) -> Expr:
        """T = sum (m v^2 + I w^2)/2."""
        terms = [
            body.mass * sum(rate(c, self.q) ** 2 for c in body.centre) + body.inertia * rate(body.angle, self.q) ** 2
            for body in self.bodies
        ]
        return sum(terms) / 2

    @property
    def potential_energy(self) -> Expr:
        """V = sum m g y - work."""
        return sum(body.mass * g * body.centre[1] for body in self.bodies) - self.work

    def residuals(self) -> list[Expr]:
        """m a_C - sum F and I alpha - sum M_C of every body."""
        return [expression for body in self.bodies for expression in _newton_euler(body, self.q)]


def u(q: Symbol) -> Symbol:
    """The rate of a coordinate."""
    return Symbol(f"{q.name}'")


def acc(q: Symbol) -> Symbol:
    """The acceleration of a coordinate."""
    return Symbol(f"{q.name}''")


def rate(expression: Any, q: tuple[Symbol, ...]) -> Expr:
    """d/dt of a function of q and q'."""
    e = sympy.sympify(expression)
    return sum((e.diff(c) * u(c) + e.diff(u(c)) * acc(c) for c in q), start=sympy.Integer(0))


def second(expression: Any, *q: Symbol) -> Expr:
    """d2/dt2 of a function of q."""
    return rate(rate(expression, q), q)


def _newton_euler(body: Body, q: tuple[Symbol, ...]) -> list[Expr]:
    """(m x'' - sum F_x, m y'' - sum F_y, I alpha - sum (r - r_C) x F)."""
    (cx, cy), forces = body.centre, [*body.forces, (body.centre, (0, -body.mass * g))]
    moment = sum((px - cx) * fy - (py - cy) * fx for (px, py), (fx, fy) in forces)
    return [
        body.mass * second(cx, *q) - sum(f[0] for _, f in forces),
        body.mass * second(cy, *q) - sum(f[1] for _, f in forces),
        body.inertia * second(body.angle, *q) - moment,
    ]


# -- evaluation in 60 digits -----------------------------------------------------------------------


def number(expression: Any, values: dict[Symbol, Any]) -> Any:
    """The value of an expression, 60 digits."""
    names = list(values)
    with mpmath.workdps(DIGITS):
        return mpmath.mpf(sympy.lambdify(names, sympy.sympify(expression), "mpmath")(*values.values()))


def solved(system: System, values: dict[Symbol, Any]) -> dict[Symbol, Any]:
    """The state with its accelerations and unknown forces; every equation of every body must hold."""
    unknown = [*(acc(c) for c in system.q), *system.unknowns]
    A, right = sympy.linear_eq_to_matrix(system.residuals(), unknown)
    with mpmath.workdps(DIGITS):
        rows, column = _matrix(A, values), _matrix(right, values)
        solution = mpmath.lu_solve(rows, column)  # of more equations than unknowns the least squares
        left_over = mpmath.norm(rows * solution - column)
    assert left_over < TINY * mpmath.norm(column), "the equations contradict one another"
    return values | dict(zip(unknown, solution, strict=True))


def _matrix(matrix: Matrix, values: dict[Symbol, Any]) -> mpmath.matrix:
    return mpmath.matrix(sympy.lambdify(list(values), matrix, "mpmath")(*values.values()))


def speed_from_rest(system: System, values: dict[Symbol, Any]) -> Any:
    """u of the single coordinate: T = A u^2/2 = V(start) - V."""
    (c,) = system.q
    A = system.kinetic_energy.diff(u(c), 2)
    V = system.potential_energy
    with mpmath.workdps(DIGITS):
        return mpmath.sqrt(number(2 * (V.subs(system.start) - V) / A, values))


def answers(system: System, values: dict[Symbol, Any]) -> dict[str, Any]:
    """Every output at the values of parameters, coordinates and rates."""
    return {name: _answer(system, requested, values) for name, requested in system.requested.items()}


def _answer(system: System, requested: Requested, values: dict[Symbol, Any]) -> Any:
    state = values | {c: number(value, values) for c, value in requested.place.items()}
    if requested.from_rest:
        state[u(system.q[0])] = speed_from_rest(system, state)
    return number(requested.value, solved(system, state))


def energy_rate(system: System, values: dict[Symbol, Any]) -> Any:
    """d/dt (T + V) with the accelerations of Newton and Euler, relative to d/dt of V."""
    state = solved(system, values)
    change = rate(system.kinetic_energy + system.potential_energy, system.q)
    return number(change, state) / (1 + abs(number(rate(system.potential_energy, system.q), state)))


def at(value: Any, place: dict[Symbol, Any]) -> Requested:
    """Asked at a place that is reached from rest."""
    return Requested(value, place, True)


def law(value: Any) -> Requested:
    """Asked at every place that is reached from rest."""
    return Requested(value, from_rest=True)


def rod(mass: Any, length: Any) -> Any:
    """I = m l^2/12."""
    return mass * length**2 / 12


def disc(mass: Any) -> Any:
    """I = m R^2/2."""
    return mass * R**2 / 2


# -- chapter 18 ------------------------------------------------------------------------------------


def ch18_p1() -> System:
    """P (left) descends while the pulley turns by theta, ccw."""
    T1, T2, X, Y = symbols("T1 T2 X Y")
    a_P = -second(-R * theta, theta)
    return System(
        (theta,),
        (
            Body(2 * M, 0, (-R, -R * theta), 0, (((-R, -R * theta), (0, T1)),)),
            Body(M, 0, (R, R * theta), 0, (((R, R * theta), (0, T2)),)),
            Body(6 * M, disc(6 * M), (0, 0), theta, (((-R, 0), (0, -T1)), ((R, 0), (0, -T2)), ((0, 0), (X, Y)))),
        ),
        (T1, T2, X, Y),
        {
            "theta_dd": Requested(acc(theta)),
            "a_P": Requested(a_P),
            "v_P_2s": Requested(2 * a_P),  # a_P is constant
            "y_P_2s": Requested(2 * a_P),  # a_P 2^2/2
            "T1": Requested(T1),
            "T2": Requested(T2),
            "V_O": Requested(Y),
            "H_O": Requested(X),
        },
    )


def ch18_p2() -> System:
    """theta: crank below the horizontal; the triangle OAB is isosceles, so the rod rises by theta towards B."""
    X, Y, X1, Y1, X2, Y2, N = symbols("X Y X1 Y1 X2 Y2 N")
    c, s = cos(theta), sin(theta)
    A, B = (2 * l * c, -2 * l * s), (4 * l * c, 0)
    end, v_B = {theta: pi / 3}, -rate(B[0], (theta,))
    return System(
        (theta,),
        (
            Body(3 * M, rod(3 * M, 2 * l), (l * c, -l * s), -theta, (((0, 0), (X, Y)), (A, (X1, Y1)))),
            Body(3 * M, rod(3 * M, 2 * l), (3 * l * c, -l * s), theta, ((A, (-X1, -Y1)), (B, (X2, Y2)))),
            Body(2 * M, 0, B, 0, ((B, (-X2 - 4 * M * g, N - Y2)),)),
        ),
        (X, Y, X1, Y1, X2, Y2, N),
        {
            "v_B": at(v_B, end),
            "v_B_squared": at(v_B**2, end),
            "theta": at(theta, end),  # 4 l cos(theta) = 2 l
            "theta_d_squared": at(u(theta) ** 2, end),
            "theta_d_squared_general": law(u(theta) ** 2),
        },
        {theta: 0},
        4 * M * g * (4 * l - B[0]),
    )


def ch18_p3() -> System:
    """s: descent of P; the disc O turns by s/R, the disc C rises by s/2 and turns by s/(2R)."""
    T1, T2, T3, X, Y = symbols("T1 T2 T3 X Y")
    P, C = (R, -s), (-2 * R, s / 2)
    return System(
        (s,),
        (
            Body(4 * M, 0, P, 0, ((P, (0, T1)),)),
            Body(2 * M, disc(2 * M), (0, 0), -s / R, (((R, 0), (0, -T1)), ((-R, 0), (0, -T2)), ((0, 0), (X, Y)))),
            Body(2 * M, disc(2 * M), C, s / (2 * R), ((_right(C, R), (0, T2)), (_right(C, -R), (0, T3)))),
        ),
        (T1, T2, T3, X, Y),
        {"a_P": Requested(acc(s)), "T1": Requested(T1), "T2": Requested(T2), "T3": Requested(T3), "V_O": Requested(Y)},
    )


def ch18_p4() -> System:
    """x: length of the spring, phi: bar from the downward vertical."""
    X1, Y1, N = symbols("X1 Y1 N")
    P, centre = (x, 0), (x + l * sin(phi), -l * cos(phi))
    bodies = (
        Body(2 * M, 0, P, 0, ((P, (-k * (x - l0) - X1, N - Y1)),)),
        Body(6 * M, rod(6 * M, 2 * l), centre, phi, ((P, (X1, Y1)),)),
    )
    plain = System((x, phi), bodies, (X1, Y1, N), {}, {}, -k * (x - l0) ** 2 / 2)
    requested = {
        "kinetic_energy": Requested(plain.kinetic_energy),
        "x_dd": Requested(acc(x)),
        "phi_dd": Requested(acc(phi)),
    }
    return System(plain.q, bodies, plain.unknowns, requested, {}, plain.work)


def ch18_p5() -> System:
    """theta: bar below the horizontal; the strand from A to O2 has the length 2 l sqrt(2 + 2 sin(theta))."""
    X, Y, T = symbols("X Y T")
    A, strand = (2 * l * cos(theta), -2 * l * sin(theta)), 2 * l * sqrt(2 + 2 * sin(theta))
    pull = (-T * A[0] / strand, T * (2 * l - A[1]) / strand)
    Q, end = (0, strand), {theta: pi / 2}
    v_A = 2 * l * u(theta)
    return System(
        (theta,),
        (
            Body(3 * M, rod(3 * M, 2 * l), (A[0] / 2, A[1] / 2), -theta, (((0, 0), (X, Y)), (A, pull))),
            Body(M, 0, Q, 0, ((Q, (0, T)),)),
        ),
        (X, Y, T),
        {"v_A": at(v_A, end), "v_A_squared": at(v_A**2, end), "v_Q": at(rate(strand, (theta,)), end)},
        {theta: 0},
    )


# -- chapter 20 ------------------------------------------------------------------------------------


def ch20_p1() -> System:
    """theta: ccw, the wire at the disc's right."""
    T, C = Symbol("T"), (0, -R * theta)
    return System(
        (theta,),
        (Body(M, disc(M), C, theta, ((_right(C, R), (0, T)),)),),
        (T,),
        {"theta_dd": Requested(acc(theta)), "a_C": Requested(R * acc(theta)), "T": Requested(T)},
    )


def ch20_p2() -> System:
    """theta: cranks below the horizontal; R1, R2 (and R3, R4 at C) towards the hinge and towards increasing theta."""
    R1, R2, R3, R4, X1, Y1, X2, Y2 = unknowns = symbols("R1 R2 R3 R4 X1 Y1 X2 Y2")
    c, s = cos(theta), sin(theta)
    end, v_A = {theta: pi / 2}, 2 * l * u(theta)
    A, B, C = (2 * l * c, -2 * l * s), (3 * l + 2 * l * c, -2 * l * s), (3 * l, 0)
    first, second_ = (-R1 * c - R2 * s, R1 * s - R2 * c), (-R3 * c - R4 * s, R3 * s - R4 * c)
    bar = rod(3 * M, 2 * l)
    return System(
        (theta,),
        (
            Body(3 * M, bar, (l * c, -l * s), -theta, (((0, 0), first), (A, (X1, Y1)))),
            Body(3 * M, bar, (3 * l + l * c, -l * s), -theta, ((C, second_), (B, (X2, Y2)))),
            Body(4 * M, rod(4 * M, 3 * l), ((A[0] + B[0]) / 2, A[1]), 0, ((A, (-X1, -Y1)), (B, (-X2, -Y2)))),
        ),
        unknowns,
        {
            "theta_d_squared": law(u(theta) ** 2),
            "v_A": at(v_A, end),
            "R1": law(R1),
            "R2": law(R2),
            "R1_vertical": at(R1, end),
            "R3_vertical": at(R3, end),
            "R2_vertical": at(R2, end),
            "R4_vertical": at(R4, end),
        },
        {theta: 0},
    )


def ch20_p3() -> System:
    """theta: disc O, ccw, P descends; phi: moving disc, cw."""
    T1, T2, X, Y = symbols("T1 T2 X Y")
    P, C = (-2 * R, -2 * R * theta), (3 * R, 2 * R * theta - R * phi)
    large = 6 * M * (2 * R) ** 2 / 2
    a_P, a_C = -second(P[1], theta), -second(C[1], theta, phi)
    return System(
        (theta, phi),
        (
            Body(M, 0, P, 0, ((P, (0, T1)),)),
            Body(6 * M, large, (0, 0), theta, (((-2 * R, 0), (0, -T1)), ((2 * R, 0), (0, -T2)), ((0, 0), (X, Y)))),
            Body(2 * M, disc(2 * M), C, -phi, ((_right(C, -R), (0, T2)),)),
        ),
        (T1, T2, X, Y),
        {
            "theta_dd": Requested(acc(theta)),
            "phi_dd": Requested(acc(phi)),
            "a_P": Requested(a_P),
            "D": Requested(2 * a_P),  # a_P 2^2/2
            "a_C": Requested(a_C),
            "T1": Requested(T1),
            "T2": Requested(T2),
            "V_O": Requested(Y),
        },
    )


def ch20_p4() -> System:
    """theta: OA from the upward vertical, cw; OA = AB = R, so B is at 2 R sin(theta)."""
    X, Y, X1, Y1, X2, Y2, N = symbols("X Y X1 Y1 X2 Y2 N")
    A, B = (R * sin(theta), R * cos(theta)), (2 * R * sin(theta), 0)
    centre, end = ((A[0] + B[0]) / 2, A[1] / 2), {theta: pi / 2}
    return System(
        (theta,),
        (
            Body(4 * M, disc(4 * M), (0, 0), -theta, (((0, 0), (X, Y)), (A, (X1, Y1)))),
            Body(3 * M, rod(3 * M, R), centre, theta, ((A, (-X1, -Y1)), (B, (X2, Y2)))),
            Body(M, 0, B, 0, ((B, (-X2, N - Y2)),)),
        ),
        (X, Y, X1, Y1, X2, Y2, N),
        {
            "theta_d_squared": law(u(theta) ** 2),
            "v_B": at(rate(B[0], (theta,)), end),
            "omega_disc_end": at(u(theta), end),
            "H_O": at(X, end),
            "V_O": at(Y, end),
            "N_B": at(N, end),
        },
        {theta: 0},
    )


def ch20_p5() -> System:
    """s: descent of P, so that C rises by s; z: descent of Q2 relative to C."""
    T1, T2, T3, T4, X, Y = unknowns = symbols("T1 T2 T3 T4 X Y")
    P, C = (-R, -s), (R, s)
    Q1, Q2 = (0, s + z), (2 * R, s - z)
    hung = ((C, (0, T2)), (_right(C, -R), (0, -T3)), (_right(C, R), (0, -T4)))
    return System(
        (s, z),
        (
            Body(4 * M, 0, P, 0, ((P, (0, T1)),)),
            Body(2 * M, disc(2 * M), (0, 0), s / R, (((-R, 0), (0, -T1)), ((R, 0), (0, -T2)), ((0, 0), (X, Y)))),
            Body(2 * M, disc(2 * M), C, -z / R, hung),
            Body(M, 0, Q1, 0, ((Q1, (0, T3)),)),
            Body(2 * M, 0, Q2, 0, ((Q2, (0, T4)),)),
        ),
        unknowns,
        {
            "a_P": Requested(acc(s)),
            "z_dd": Requested(acc(z)),
            "T1": Requested(T1),
            "T2": Requested(T2),
            "T3": Requested(T3),
            "T4": Requested(T4),
            "V_O": Requested(Y),
        },
    )


def ch20_p6() -> System:
    """y: descent of the slider; phi: bar from the downward vertical, ccw."""
    N, X1, Y1 = symbols("N X1 Y1")
    P, centre = (0, -y), (l * sin(phi), -y - l * cos(phi))
    return System(
        (y, phi),
        (
            Body(M, 0, P, 0, ((P, (N - X1, -Y1)),)),
            Body(6 * M, rod(6 * M, 2 * l), centre, phi, ((P, (X1, Y1)),)),
        ),
        (N, X1, Y1),
        {"y_dd": Requested(acc(y)), "phi_dd": Requested(acc(phi)), "N_P": Requested(N)},
    )


# -- chapter 22 ------------------------------------------------------------------------------------


def lagrangian(system: System, *coordinates: Symbol) -> System:
    """The system, asked for its kinetic energy and its generalized forces Q = -dV/dq too."""
    requested = {"kinetic_energy": Requested(system.kinetic_energy)}
    requested |= {f"Q_{c.name}": Requested(-system.potential_energy.diff(c)) for c in coordinates}
    return System(system.q, system.bodies, system.unknowns, requested | system.requested, system.start, system.work)


def ch22_p1() -> System:
    """theta: bar from the vertical; the disc's centre B is at 3 R sin(theta), and it rolls cw."""
    N_A, F, N, X, Y = symbols("N_A F N X Y")
    c, s = cos(theta), sin(theta)
    A, B = (0, R + 3 * R * c), (3 * R * s, R)
    turned = -3 * s
    return lagrangian(
        System(
            (theta,),
            (
                Body(4 * M, rod(4 * M, 3 * R), (B[0] / 2, (A[1] + R) / 2), theta, ((A, (N_A, 0)), (B, (X, Y)))),
                Body(2 * M, disc(2 * M), B, turned, ((B, (-X, -Y)), ((B[0], 0), (F, N)))),
            ),
            (N_A, F, N, X, Y),
            {
                "theta_dd": Requested(acc(theta)),
                "omega_disc": Requested(-rate(turned, (theta,))),
                "N_A": Requested(N_A),
            },
        ),
        theta,
    )


def ch22_p2() -> System:
    """theta: bar below the horizontal; the collar's N_P acts along the bar's normal, up while the bar is level."""
    X, Y, N = symbols("X Y N")
    P, push = (r * cos(theta), -r * sin(theta)), (N * sin(theta), N * cos(theta))
    centre = (l * cos(theta), -l * sin(theta))
    return lagrangian(
        System(
            (theta, r),
            (
                Body(3 * M, rod(3 * M, 2 * l), centre, -theta, (((0, 0), (X, Y)), (P, (-push[0], -push[1])))),
                Body(2 * M, 0, P, 0, ((P, push),)),
            ),
            (X, Y, N),
            {"N_P": Requested(N)},
        ),
        theta,
        r,
    )


def ch22_p3() -> System:
    """theta: first bar, cw; phi: second bar, ccw; horizontal springs at A and between B and D, level with A and B."""
    X1, Y1, X2, Y2, d = symbols("X1 Y1 X2 Y2 d")
    A, B = (-a * sin(theta), -a * cos(theta)), (-3 * a * sin(theta), -3 * a * cos(theta))
    D = (d + 2 * a * sin(phi), -a - 2 * a * cos(phi))
    F1, F2 = -k * A[0], 2 * k * (D[0] - B[0] - d)
    middle = ((D[0] + d) / 2, (D[1] - a) / 2)
    return lagrangian(
        System(
            (theta, phi),
            (
                Body(
                    4 * M,
                    rod(4 * M, 3 * a),
                    (B[0] / 2, B[1] / 2),
                    -theta,
                    (((0, 0), (X1, Y1)), (A, (F1, 0)), (B, (F2, 0))),
                ),
                Body(3 * M, rod(3 * M, 2 * a), middle, phi, (((d, -a), (X2, Y2)), (D, (-F2, 0)))),
            ),
            (X1, Y1, X2, Y2),
            {"theta_dd": Requested(acc(theta)), "phi_dd": Requested(acc(phi))},
            {},
            -k * A[0] ** 2 / 2 - k * (D[0] - B[0] - d) ** 2,
        ),
        theta,
        phi,
    )


def ch22_p4() -> System:
    """theta: drum, cw: P descends by 2 R theta, C rises by R theta/2 and turns by theta/2."""
    T1, T2, T3, X, Y = symbols("T1 T2 T3 X Y")
    P, C = (2 * R, -2 * R * theta), (-2 * R, R * theta / 2)
    a_P = -second(P[1], theta)
    pulls = (((2 * R, 0), (0, -T1)), ((-R, 0), (0, -T2)), ((0, 0), (X, Y)))
    return lagrangian(
        System(
            (theta,),
            (
                Body(4 * M, 6 * M * R**2, (0, 0), -theta, pulls),
                Body(4 * M, 0, P, 0, ((P, (0, T1)),)),
                Body(2 * M, disc(2 * M), C, theta / 2, ((_right(C, R), (0, T2)), (_right(C, -R), (0, T3)))),
            ),
            (T1, T2, T3, X, Y),
            {
                "theta_dd": Requested(acc(theta)),
                "a_P": Requested(a_P),
                "v_P_of_h": Requested(sqrt(2 * a_P * h)),  # a_P is constant
                "v_P_of_t": Requested(a_P * t1),
                "T1": Requested(T1),
                "T2": Requested(T2),
                "T3": Requested(T3),
            },
        ),
    )


def ch22_p5() -> System:
    """x: disc's centre; theta: bar from the downward vertical, ccw."""
    X, Y, F, N = symbols("X Y F N")
    B, centre = (x, R), (x + 2 * R * sin(theta), R - 2 * R * cos(theta))
    return lagrangian(
        System(
            (x, theta),
            (
                Body(2 * M, disc(2 * M), B, -x / R, ((B, (-X, -Y)), ((x, 0), (F, N)))),
                Body(3 * M, rod(3 * M, 4 * R), centre, theta, ((B, (X, Y)),)),
            ),
            (X, Y, F, N),
            {
                "x_dd": Requested(acc(x)),
                "theta_dd": Requested(acc(theta)),
                "N_ground": Requested(N),
                "F_friction": Requested(F),
            },
        ),
    )


def ch22_p6() -> System:
    """y: centre above equilibrium, theta ccw; springs under the ends, 2k and 3k, each with half the weight at rest."""
    A, B = (-l * cos(theta), y - l * sin(theta)), (l * cos(theta), y + l * sin(theta))
    FA, FB = 3 * M * g - 2 * k * A[1], 3 * M * g - 3 * k * B[1]
    work = 3 * M * g * (A[1] + B[1]) - k * A[1] ** 2 - sympy.Rational(3, 2) * k * B[1] ** 2
    return System(
        (y, theta),
        (Body(6 * M, rod(6 * M, 2 * l), (0, y), theta, ((A, (0, FA)), (B, (0, FB)))),),
        (),
        {"y_dd": Requested(acc(y)), "theta_dd": Requested(acc(theta))},
        {},
        work,
    )


def _right(place: Place, distance: Any) -> Place:
    return (place[0] + distance, place[1])


ALL: dict[str, Callable[[], System]] = {
    make.__name__: make
    for make in (
        ch18_p1,
        ch18_p2,
        ch18_p3,
        ch18_p4,
        ch18_p5,
        ch20_p1,
        ch20_p2,
        ch20_p3,
        ch20_p4,
        ch20_p5,
        ch20_p6,
        ch22_p1,
        ch22_p2,
        ch22_p3,
        ch22_p4,
        ch22_p5,
        ch22_p6,
    )
}
"""Every system of the three chapters, by its id."""
