"""Systems as the documentation and the tests of sympy.physics.mechanics build them, and what sympy says of them."""

from __future__ import annotations

from typing import Any

import numpy as np
import sympy as sm
from sympy.physics.mechanics import (
    CylindricalJoint,
    Force,
    ForceActuator,
    KanesMethod,
    LagrangesMethod,
    LinearDamper,
    LinearPathway,
    LinearSpring,
    Particle,
    PinJoint,
    PlanarJoint,
    Point,
    PrismaticJoint,
    ReferenceFrame,
    RigidBody,
    SphericalJoint,
    System,
    Torque,
    TorqueActuator,
    WeldJoint,
    dynamicsymbols,
    find_dynamicsymbols,
    inertia,
)

t = dynamicsymbols._t


def pendulum() -> Any:
    q, u = dynamicsymbols("q u")
    m, l, g = sm.symbols("m l g")
    N = ReferenceFrame("N")
    A = N.orientnew("A", "Axis", [q, N.z])
    A.set_ang_vel(N, u * N.z)
    O = Point("O")
    O.set_vel(N, 0)
    P = O.locatenew("P", l * A.x)
    P.v2pt_theory(O, N, A)
    return KanesMethod(N, [q], [u], [q.diff(t) - u], forcelist=[(P, m * g * N.x)], bodies=[Particle("Pa", P, m)])


def rolling_disc() -> Any:
    """Speeds are the components of omega in axes that do not spin; that it rolls is in the velocities alone."""
    q1, q2, q3, u1, u2, u3 = dynamicsymbols("q1 q2 q3 u1 u2 u3")
    r, m, g = sm.symbols("r m g")
    N = ReferenceFrame("N")
    Y = N.orientnew("Y", "Axis", [q1, N.z])
    L = Y.orientnew("L", "Axis", [q2, Y.x])
    R = L.orientnew("R", "Axis", [q3, L.y])
    w = R.ang_vel_in(N)
    R.set_ang_vel(N, u1 * L.x + u2 * L.y + u3 * L.z)
    C = Point("C")
    C.set_vel(N, 0)
    D = C.locatenew("D", r * L.z)
    D.v2pt_theory(C, N, R)
    body = RigidBody("B", D, R, m, (inertia(L, m / 4 * r**2, m / 2 * r**2, m / 4 * r**2), D))
    kd = [(w - R.ang_vel_in(N)).dot(axis) for axis in L]
    return KanesMethod(N, [q1, q2, q3], [u1, u2, u3], kd, forcelist=[(D, -m * g * Y.z)], bodies=[body])


def sliding_particle_with_dependent_speed() -> Any:
    """A knife edge: x' sin(th) = y' cos(th), one speed dependent."""
    x, y, th, ux, uy, w = dynamicsymbols("x y th ux uy w")
    m, J, F = sm.symbols("m J F")
    N = ReferenceFrame("N")
    A = N.orientnew("A", "Axis", [th, N.z])
    A.set_ang_vel(N, w * N.z)
    O, C = Point("O"), Point("C")
    O.set_vel(N, 0)
    C.set_pos(O, x * N.x + y * N.y)
    C.set_vel(N, ux * N.x + uy * N.y)
    body = RigidBody("B", C, A, m, (inertia(A, 0, 0, J), C))
    return KanesMethod(
        N, [x, y, th], [ux, w], [x.diff(t) - ux, y.diff(t) - uy, th.diff(t) - w], u_dependent=[uy],
        velocity_constraints=[uy * sm.cos(th) - ux * sm.sin(th)], bodies=[body],
        forcelist=[(C, F * A.x), (A, 2 * F * A.z)],
    )  # fmt: skip


def double_pendulum_by_lagrange() -> Any:
    q1, q2, f = dynamicsymbols("q1 q2 f")
    m, l, g, c = sm.symbols("m l g c", positive=True)
    N = ReferenceFrame("N")
    A = N.orientnew("A", "Axis", [q1, N.z])
    B = N.orientnew("B", "Axis", [q2, N.z])
    O = Point("O")
    O.set_vel(N, 0)
    P = O.locatenew("P", l * A.x)
    R = P.locatenew("R", l * B.x)
    P.v2pt_theory(O, N, A)
    R.v2pt_theory(P, N, B)
    T = m * P.vel(N).dot(P.vel(N)) / 2 + m * R.vel(N).dot(R.vel(N)) / 2
    V = -m * g * l * (2 * sm.cos(q1) + sm.cos(q2))
    return LagrangesMethod(T - V, [q1, q2], forcelist=[(P, f * N.y - c * P.vel(N))], frame=N)


def tied_by_lagrange() -> Any:
    """A particle on a circle, by its two places and one gap, and a knife edge that moves with time."""
    x, y, z = dynamicsymbols("x y z")
    m, l, g = sm.symbols("m l g")
    L = m * (x.diff(t) ** 2 + y.diff(t) ** 2 + z.diff(t) ** 2) / 2 - m * g * y + m * x.diff(t) * z / 10
    gap = x**2 + y**2 - l**2
    blade = z.diff(t) - x * y.diff(t)
    return LagrangesMethod(L, [x, y, z], hol_coneqs=[gap], nonhol_coneqs=[blade])


def cart_and_pendulum_on_joints() -> Any:
    """sympy's first example of a System, with a spring, a damper, a push and a motor."""
    F, tau, qc, qp, uc, up = dynamicsymbols("F tau q_c q_p u_c u_p")
    g, l, mc, mp, k, c, l0 = sm.symbols("g l m_c m_p k c l_0", positive=True)
    rail = RigidBody("rail")
    system = System.from_newtonian(rail)
    cart = RigidBody("cart", mass=mc)
    cart.central_inertia = inertia(cart.frame, 1, 2, 2)
    rod = RigidBody("rod", mass=mp)
    rod.central_inertia = inertia(rod.frame, 0, 0, mp * l**2 / 12)
    slide = PrismaticJoint("slide", rail, cart, qc, uc, joint_axis=rail.x)
    hinge = PinJoint("hinge", cart, rod, qp, up, joint_axis=cart.z, child_point=l * rod.y / 2)
    system.add_joints(slide, hinge)
    system.apply_uniform_gravity(-g * system.y)
    tip = rod.masscenter.locatenew("tip", -l * rod.y / 2)
    tip.v2pt_theory(rod.masscenter, system.frame, rod.frame)
    system.add_loads(Force(cart, F * rail.x), Force(tip, F * rod.x))
    peg = system.fixed_point.locatenew("peg", 2 * l * rail.x + l * rail.y)
    peg.set_vel(system.frame, 0)
    system.add_actuators(
        LinearSpring(k, LinearPathway(cart.masscenter, peg), l0),
        LinearDamper(c, LinearPathway(tip, peg)),
        TorqueActuator.at_pin_joint(tau - c * l * up, hinge),
    )
    return system


def oblique_joints() -> Any:
    """A pin whose axis frames between align, then a plane; a force in axes of a body, a torque."""
    q, u, a, b = dynamicsymbols("q0:4"), dynamicsymbols("u0:4"), *sm.symbols("a b")
    system, wall, one, two = _with_bodies("one", "two")
    system.add_joints(
        PinJoint("j1", wall, one, q[0], u[0], joint_axis=wall.x + wall.y, parent_point=a * wall.x,
                 child_point=b * one.y, child_interframe=one.x - one.z),
        PlanarJoint("j2", one, two, q[1], q[2:], u[1], u[2:], child_point=a * two.z),
    )  # fmt: skip
    system.apply_uniform_gravity(-9.81 * system.z)
    system.add_loads(Torque(two, a * b * two.x), Force(two.masscenter, 3 * one.y))
    return system


def cylinder_and_ball() -> Any:
    """A cylinder, then a ball whose turns are about the parent's axes, in axes turned by a right angle, and a weld."""
    q, u, a, b = dynamicsymbols("q0:5"), dynamicsymbols("u0:5"), *sm.symbols("a b")
    system, wall, one, two, three = _with_bodies("one", "two", "three")
    system.add_joints(
        CylindricalJoint("j1", wall, one, q[0], q[1], u[0], u[1], joint_axis=wall.z, parent_point=b * wall.x),
        SphericalJoint(
            "j2", one, two, list(q[2:]), list(u[2:]), rot_type="space", rot_order=213, parent_interframe=one.y
        ),
        WeldJoint("j3", two, three, parent_point=a * two.x, child_interframe=three.z),
    )
    system.apply_uniform_gravity(-9.81 * system.x)
    return system


def _with_bodies(*names: str) -> list[Any]:
    wall = RigidBody("wall")
    bodies = [RigidBody(name, mass=sm.Symbol("m") * k) for k, name in enumerate(names, 1)]
    for k, body in enumerate(bodies, 1):
        body.central_inertia = inertia(body.frame, k, 2 * k, 2 * k + 1, sm.Rational(1, 10))
    return [System.from_newtonian(wall), wall, *bodies]


def four_bar() -> Any:
    """sympy's four-bar linkage: three pins and a gap."""
    q1, q2, q3, u1, u2, u3 = dynamicsymbols("q1:4 u1:4")
    l1, l2, l3, l4, rho = sm.symbols("l1:5 rho")
    N = RigidBody("N")
    links = [RigidBody(f"L{k}", mass=rho * l) for k, l in enumerate((l2, l3, l4), 2)]
    for body, l in zip(links, (l2, l3, l4), strict=True):
        body.central_inertia = inertia(body.frame, 0, 0, rho * l**3 / 12)
    A, B, C = links
    system = System.from_newtonian(N)
    system.add_joints(
        PinJoint("J1", N, A, q1, u1, parent_point=-l1 / 2 * N.x, child_point=-l2 / 2 * A.x, joint_axis=N.z),
        PinJoint("J2", A, B, q2, u2, parent_point=l2 / 2 * A.x, child_point=-l3 / 2 * B.x, joint_axis=A.z),
        PinJoint("J3", B, C, q3, u3, parent_point=l3 / 2 * B.x, child_point=-l4 / 2 * C.x, joint_axis=B.z),
    )
    end = C.masscenter.locatenew("end", l4 / 2 * C.x)
    start = N.masscenter.locatenew("start", l1 / 2 * N.x)
    loop = end.pos_from(start).express(N.frame)
    system.add_holonomic_constraints(loop.dot(N.x), loop.dot(N.y))
    system.u_ind, system.q_ind = [u1], [q1]
    system.u_dep, system.q_dep = [u2, u3], [q2, q3]
    system.apply_uniform_gravity(-9.8 * N.y)
    return system


def particle_by_hand() -> Any:
    """A System without joints: a mass on a spring whose bodies nobody hung."""
    q, u, f = dynamicsymbols("q u f")
    m, k, c = sm.symbols("m k c")
    system = System()
    P = Point("P")
    P.set_pos(system.fixed_point, q * system.x)
    P.set_vel(system.frame, u * system.x)
    system.add_bodies(Particle("mass", P, m))
    system.add_coordinates(q)
    system.add_speeds(u)
    system.add_kdes(u - q.diff(t))
    way = LinearPathway(system.fixed_point, P)
    system.add_actuators(LinearSpring(k, way), LinearDamper(c, way), ForceActuator(f, way))
    return system


def speeds_of_omega() -> Any:
    """A free body in the plane of its own axes: speeds along the body's axes, and one that turns no coordinate."""
    x, y, th, v1, v2, w, s = dynamicsymbols("x y th v1 v2 w s")
    m, J, c = sm.symbols("m J c")
    N = ReferenceFrame("N")
    A = N.orientnew("A", "Axis", [th, N.z])
    B = A.orientnew("B", "Axis", [0, A.z])
    A.set_ang_vel(N, w * N.z)
    B.set_ang_vel(A, s * A.z)
    O, C = Point("O"), Point("C")
    O.set_vel(N, 0)
    C.set_vel(N, v1 * A.x + v2 * A.y)
    plate = RigidBody("plate", C, A, m, (inertia(A, 0, 0, J), C))
    wheel = RigidBody("wheel", C, B, m / 3, (inertia(A, 0, 0, J / 5), C))
    kd = [
        x.diff(t) - (v1 * sm.cos(th) - v2 * sm.sin(th)),
        y.diff(t) - (v1 * sm.sin(th) + v2 * sm.cos(th)),
        th.diff(t) - w,
    ]
    method = KanesMethod(
        N, [x, y, th], [v1, v2, w, s], kd, forcelist=[(C, -c * v1 * A.x), (B, c * A.z)], bodies=[plate, wheel]
    )
    return method


def particles_on_joints() -> Any:
    """A block on a rail, a bob on the block, as in sympy's tutorial: particles have no axes of their own."""
    q, u, q1, u1 = dynamicsymbols("q u q1 u1")
    m, M, l, g = sm.symbols("m M l g")
    wall, block, bob = RigidBody("N"), Particle("A", mass=M), Particle("C", mass=m)
    system = System.from_newtonian(wall)
    system.add_bodies(block, bob)
    fa, fc = ReferenceFrame("A"), ReferenceFrame("C")
    block.masscenter.set_vel(fa, 0)
    bob.masscenter.set_vel(fc, 0)
    rail = PrismaticJoint("J1", wall, block, coordinates=q1, speeds=u1, child_interframe=fa)
    pin = PinJoint("J2", block, bob, coordinates=q, speeds=u, joint_axis=fa.z, parent_interframe=fa,
                   child_interframe=fc, child_point=l * fc.y)  # fmt: skip
    system.add_joints(rail, pin)
    system.apply_uniform_gravity(-g * wall.y)
    return system


def bicycle() -> tuple[Any, dict[str, float]]:
    """Whipple's bicycle with its wheels' turns unmeasured, as sympy's own test builds it; and numbers for it."""
    q1, q2, q4, q5 = q = dynamicsymbols("q1 q2 q4 q5")
    u1, u2, u3, u4, u5, u6 = dynamicsymbols("u1:7")
    rf, rr, tilt, offset, fork, frame, a1, a3, b1, b3, g = sm.symbols("rf rr tilt offset fork frame a1 a3 b1 b3 g")
    masses = sm.symbols("m1:5")
    I, J, K, L = sm.symbols("I1:5"), sm.symbols("J1:5"), sm.symbols("K1:3"), sm.symbols("L1:3")
    N, WR, WF = ReferenceFrame("N"), ReferenceFrame("WR"), ReferenceFrame("WF")
    Y = N.orientnew("Y", "Axis", [q1, N.z])
    R = Y.orientnew("R", "Axis", [q2, Y.x])
    A = R.orientnew("A", "Axis", [q4 + tilt, R.y])
    TA = A.orientnew("TA", "Axis", [-tilt, A.y])
    B = A.orientnew("B", "Axis", [q5, A.x])
    TB = B.orientnew("TB", "Axis", [-tilt, B.y])
    rear = Point("rear")
    hub = rear.locatenew("hub", rr * R.z)
    steer = hub.locatenew("steer", frame * A.z)
    center = hub.locatenew("center", -a1 * A.x + a3 * A.z)
    of_fork = steer.locatenew("of_fork", -b1 * B.x + b3 * B.z)
    front_hub = steer.locatenew("front_hub", fork * B.x + offset * B.z)
    front = front_hub.locatenew("front", rf * (B.y.dot(Y.z) * B.y - Y.z).normalize())
    for own, other, w in ((Y, N, u1 * Y.z), (R, Y, u2 * R.x), (WR, A, u3 * A.y), (A, R, u4 * A.y), (B, A, u5 * B.x),
                          (WF, B, u6 * B.y)):  # fmt: skip
        own.set_ang_vel(other, w)
    rear.set_vel(N, 0)
    for point, other, own in ((hub, rear, WR), (steer, hub, A), (center, hub, A), (of_fork, steer, B),
                              (front_hub, steer, B), (front, front_hub, WF)):  # fmt: skip
        point.v2pt_theory(other, N, own)
    parts = ((center, A, (inertia(TA, *I[:3], 0, 0, I[3]), center)),
             (of_fork, B, (inertia(TB, *J[:3], 0, 0, J[3]), of_fork)),
             (hub, WR, (inertia(A, K[0], K[1], K[0]), hub)),
             (front_hub, WF, (inertia(B, L[0], L[1], L[0]), front_hub)))  # fmt: skip
    bodies = [RigidBody(f"b{k}", at, own, m, I) for k, (m, (at, own, I)) in enumerate(zip(masses, parts, strict=True))]
    method = KanesMethod(
        N, [q1, q2, q5], [u2, u3, u5], [x.diff(t) - u for x, u in zip(q, (u1, u2, u4, u5), strict=True)],
        q_dependent=[q4], configuration_constraints=[front.pos_from(rear).dot(Y.z)], u_dependent=[u1, u4, u6],
        velocity_constraints=[front.vel(N).dot(axis) for axis in Y], constraint_solver="CRAMER", bodies=bodies,
        forcelist=[(body.masscenter, -body.mass * g * Y.z) for body in bodies],
    )  # fmt: skip
    names = "rf rr tilt offset fork frame a1 a3 b1 b3 g m1 m2 m3 m4 I1 I2 I3 I4 J1 J2 J3 J4 K1 K2 L1 L2".split()
    numbers = [0.35, 0.3, 1.2566, 0.03, 0.27, 0.95, 0.5, 0.3, 0.05, -0.02, 9.81, 85, 4, 2, 3, 7, 11, 4, 1, 0.05, 0.06,
               0.02, 0.003, 0.06, 0.12, 0.14, 0.28]  # fmt: skip
    return method, dict(zip(names, map(float, numbers), strict=True))


def accelerations_by_kane(method: Any, numbers: dict[str, float]) -> dict[str, float]:
    """u' by name of sympy's M and forcing along the speeds, in doubles; `numbers` by name, speeds among them."""
    method.kanes_equations()
    symbols = [
        *method.q,
        *method.u,
        *sorted(sm.Matrix([*method.mass_matrix, *method.forcing]).free_symbols - {t}, key=str),
    ]
    formulas = sm.lambdify(symbols, [method.mass_matrix, method.forcing], cse=True)
    M, right = formulas(*(numbers[x.name if isinstance(x, sm.Symbol) else x.func.__name__] for x in symbols))
    found = np.linalg.solve(np.array(M, dtype=float), np.array(right, dtype=float).ravel())
    return {u.func.__name__: float(a) for u, a in zip(method.u, found, strict=True)}


SYSTEMS = {
    each.__name__: each
    for each in (pendulum, rolling_disc, sliding_particle_with_dependent_speed, double_pendulum_by_lagrange,
                 tied_by_lagrange, cart_and_pendulum_on_joints, oblique_joints, cylinder_and_ball,
                 four_bar, particle_by_hand, speeds_of_omega, particles_on_joints)
}  # fmt: skip


def kinematic_equations(system: Any) -> list[Any]:
    """What vanishes of q' and u."""
    if isinstance(system, LagrangesMethod):
        return []
    return list(system.kdes) if isinstance(system, System) else [rate - x for rate, x in system._qdot_u_map.items()]


def accelerations_by_sympy(system: Any, numbers: dict[str, float]) -> dict[str, float]:
    """{name of a speed's derivative in the model: value}, from sympy's own full mass matrix and forcing.

    Args:
        numbers: by name: parameters, functions of time, coordinates and their rates ("q'").
    """
    if isinstance(system, System):
        system.form_eoms()
        method = system.eom_method
    else:
        method = system
        system.kanes_equations() if isinstance(system, KanesMethod) else system.form_lagranges_equations()
    kinematic, q = kinematic_equations(system), list(method.q)
    speeds = [x.diff(t) for x in q] if isinstance(method, LagrangesMethod) else list(method.u)
    numbers = {name: sm.Float(float(x), 20) for name, x in numbers.items()}
    known = {x: numbers[x.func.__name__] for x in q} | {x.diff(t): numbers[f"{x.func.__name__}'"] for x in q}
    of_kinematics = [u for u in speeds if any(e.has(u) for e in kinematic)]
    known |= {u: numbers[f"{u.func.__name__}_0'"] for u in speeds if u not in known and u not in of_kinematics}
    formulas = sm.solve(kinematic, of_kinematics, dict=True)[0] if kinematic else {}
    known |= {u: _number(x, known, numbers) for u, x in formulas.items()}
    full, right = sm.Matrix(method.mass_matrix_full), sm.Matrix(method.forcing_full)
    n = full.shape[0]
    found = [_number(e, known, numbers) for e in (*full, *right)]
    solved = np.linalg.solve(np.array(found[: n * n], dtype=float).reshape(n, n), np.array(found[n * n :], dtype=float))
    values = {}
    for u, a in zip(speeds, solved[len(q) :], strict=False):
        of = u if isinstance(u, sm.Derivative) else formulas.get(u, dynamicsymbols(f"{u.func.__name__}_0").diff(t))
        values[f"{of.args[0].func.__name__}''" if isinstance(of, sm.Derivative) else f"{u.func.__name__}'"] = float(a)
    return values


def _number(expression: Any, known: dict[Any, Any], numbers: dict[str, Any]) -> Any:
    left = sm.sympify(expression).doit().xreplace(known)
    left = left.xreplace({x: numbers[x.func.__name__] for x in find_dynamicsymbols(left)})
    return left.xreplace({x: numbers[x.name] for x in left.free_symbols}).evalf(20)
