"""Systems of sympy.physics.mechanics as models, and equations as sympy's objects."""

from __future__ import annotations

from pathlib import Path
from random import Random
from typing import Any

import numpy as np
import pytest
import sympy as sm
from each import each
from hand_made import symbols
from slow_run import in_slow_run, sampled, usual
from sympy.physics.mechanics import (
    KanesMethod,
    LagrangesMethod,
    Particle,
    PinJoint,
    Point,
    ReferenceFrame,
    RigidBody,
    System,
    dynamicsymbols,
    inertia,
)

import eomgen
from eomgen.errors import DerivationError, UsageError
from eomgen.robots import sympy_joints as sympy_words
from eomgen.robots.sympy_joints import file_texts
from tests.helpers.sympy_systems import SYSTEMS, accelerations_by_kane, accelerations_by_sympy, bicycle

pytestmark = pytest.mark.slow

MODELS = Path(__file__).parent.parent / "models"

CLOSES = {"l1": 2.0, "l2": 1.0, "l3": 2.1, "l4": 1.9}, {"q1": 1.1, "q2": -0.613, "q3": -2.222}  # of the four-bar


def random_state(model: Any, seed: int) -> tuple[dict[str, float], dict[str, float]]:
    """(numbers by name: parameters, inputs, q, q'; accelerations by name) at a random state in which the constraints
    hold."""
    rng = Random(seed)
    parameters = {name: rng.uniform(0.6, 1.4) for name in model.parameters}
    speeds = [u.name for u in eomgen.derive(model).graph.symbols.u]
    start = {q: rng.uniform(0.3, 1.1) for q in model.coordinates} | {u: rng.uniform(-1, 1) for u in speeds}
    if "l1" in parameters:
        parameters, start = parameters | CLOSES[0], start | CLOSES[1]
    equations = eomgen.derive(model, parameters=parameters, start=start)
    inputs = {name: rng.uniform(-1, 1) for name in model.inputs}
    x = equations.start()
    dx = equations.rhs("numpy")(0.0, x, list(parameters.values()), list(inputs.values()))
    q, symbols = equations.coordinates, equations.graph.symbols
    numbers = parameters | inputs | dict(zip(q, x, strict=False)) | dict(zip([f"{n}'" for n in q], dx, strict=False))
    return numbers, dict(zip((a.name for a in symbols.a), dx[len(q) :], strict=True))


@pytest.mark.parametrize("name", usual([*SYSTEMS], 3, 2))
def test_accelerations_are_those_of_sympy(name):
    """u' at random states that keep the constraints, against sympy's own full M and forcing: 1e-10."""
    system = SYSTEMS[name]()
    model = eomgen.from_sympy(system, name=name)
    for seed in (1, 2):
        numbers, found = random_state(model, seed)
        expected = accelerations_by_sympy(system, numbers)
        shared = [u for u in found if u in expected]
        assert len(shared) == min(len(found), len(expected))
        size = max(map(abs, expected.values()))
        assert [found[u] for u in shared] == pytest.approx([expected[u] for u in shared], rel=1e-10, abs=1e-10 * size)


@sampled(3)
@pytest.mark.parametrize("name", SYSTEMS)
def test_a_model_of_sympy_is_proven_and_written(name, tmp_path):
    """Its certificate holds; the file that is written reads as the same model."""
    model = eomgen.from_sympy(SYSTEMS[name](), name=name, path=tmp_path / "model.toml")
    assert eomgen.derive(model).certify().ok is not False
    assert eomgen.load(tmp_path / "model.toml") == model


def test_bodies_on_joints_are_bodies_on_joints():
    """Of a System with joints the model has its bodies, hinges, springs, weight and motors; no energies."""
    model = eomgen.from_sympy(SYSTEMS["cart_and_pendulum_on_joints"]())
    assert [body.joint.kind for body in model.bodies.values()] == ["prismatic", "revolute"]
    assert [force.kind for force in model.forces.values()] == ["gravity", "spring", "damper", "force", "force"]
    assert model.bodies["rod"].joint.torque.text == "tau - l*c*q_p'" and set(model.inputs) == {"F", "tau"}


def test_what_sympy_derives_is_judged_against_the_model_and_simulates():
    """verify of an equation of sympy, right and with a wrong sign; T + V of a run stays, frequencies by hand."""
    model = eomgen.from_sympy(SYSTEMS["pendulum"]())
    assert eomgen.verify(model, "l*q'' + g*sin(q) = 0").verdict == "right"
    assert eomgen.verify(model, "l*q'' - g*sin(q) = 0").verdict == "wrong"
    values = {"m": 2, "l": 1, "g": 9.81, "c": 0}
    double = eomgen.from_sympy(SYSTEMS["double_pendulum_by_lagrange"]())
    run = eomgen.simulate(double, time=3, parameters=values, start={"q1": 1})
    assert run.status == "finished" and np.ptp(run.energy) < 1e-6 * np.ptp(run["q1'"]) ** 2
    A = eomgen.linearize(double, parameters=values).state_space().A
    found = np.linalg.eigvals(A)
    assert np.allclose(np.unique(np.abs(found.imag).round(9)), np.sqrt(9.81 * (2 + np.sqrt(2) * np.array([-1, 1]))))


def test_what_is_none_of_sympys_systems_is_refused():
    """What it is, and how to fix it."""
    with pytest.raises(UsageError, match="a System, KanesMethod or LagrangesMethod"):
        eomgen.from_sympy(sm.Symbol("x"))
    q, u, f = dynamicsymbols("q u f")
    pendulum = SYSTEMS["pendulum"]()
    with pytest.raises(DerivationError, match="has no bodies"):
        eomgen.from_sympy(KanesMethod(pendulum._inertial, [q], [u], [q.diff() - u]))
    with pytest.raises(DerivationError, match="of a given function of time"):
        eomgen.from_sympy(LagrangesMethod(q.diff() ** 2 / 2 + f.diff() * q.diff(), [q]))
    with pytest.raises(DerivationError, match="does not know"):
        eomgen.from_sympy(LagrangesMethod(q.diff() ** 2 / 2 - sm.Function("V")(q), [q]))


@pytest.mark.parametrize("name", ["double_pendulum", "four_bar", "gyrostat", "cart_pole", "whipple_bicycle"])
def test_equations_go_to_sympy_as_they_are(name):
    """M x' = right of the SymbolicSystem at the start, moved a little: q' and u' are the right-hand side's."""
    equations = eomgen.derive(MODELS / f"{name}.toml")
    rhs, system = equations.rhs("numpy"), equations.to_sympy_system()
    x, rng = equations.start(), np.random.default_rng(2)
    n, nu = len(equations.coordinates), len(equations.speeds)
    x[n:] += 0 if len(equations.graph.J) else rng.normal(size=nu)
    p, given = rhs.p0, rng.normal(size=len(equations.inputs))
    known = dict(zip([*system.coordinates, *system.speeds[:nu]], x, strict=True))
    known |= {f: v for f, v in zip([sm.Function(w)(dynamicsymbols._t) for w in equations.inputs], given, strict=True)}
    known |= dict(zip((equations.symbols[name] for name in equations.parameters), p, strict=True))
    numbers = [np.array(part.xreplace(known).xreplace({dynamicsymbols._t: 0}).evalf(), dtype=float)
               for part in (system.dyn_implicit_mat, system.dyn_implicit_rhs, system.kin_explicit_rhs)]  # fmt: skip
    expected = rhs(0.0, x, p, given)
    assert np.allclose(numbers[2].ravel(), expected[:n], rtol=1e-12, atol=1e-12)
    solved = np.linalg.lstsq(numbers[0], numbers[1].ravel(), rcond=None)[0][:nu]
    assert np.allclose(solved, expected[n:], rtol=1e-9, atol=1e-9)


def test_a_rate_that_stands_in_another_speed_is_a_declared_speed_too():
    """u1 = q1', u2 = q1' + q2' (Kane & Levinson, 4.7, forces in rates): u' of two rods as sympy has them, 1e-12."""
    q1, q2, u1, u2 = dynamicsymbols("q1 q2 u1 u2")
    l, m, sigma, delta = sm.symbols("l m sigma delta")
    N, P, Q = ReferenceFrame("N"), Point("P"), Point("Q")
    A, B = (N.orientnew(name, "Axis", (q, N.z)) for name, q in (("A", q1), ("B", q2)))
    P.set_vel(N, l * q1.diff() * A.y)
    Q.set_vel(N, l * q1.diff() * A.y + l * q2.diff() * B.y)
    bodies = [Particle("p", P, m), Particle("q", Q, m)]
    couple = (sigma * q2 + delta * q2.diff()) * N.z
    kinematic = [u1 - q1.diff(), u2 - (q1.diff() + q2.diff())]
    method = KanesMethod(N, [q1, q2], [u1, u2], kd_eqs=kinematic, bodies=bodies, forcelist=[(A, couple), (B, -couple)])
    model = eomgen.from_sympy(method)
    assert {name: speed.rate.text for name, speed in model.speeds.items()} == {"u1": "q1'", "u2": "q1' + q2'"}
    numbers, found = random_state(model, 3)
    expected = accelerations_by_sympy(method, numbers)
    assert [found[u] for u in ("u1'", "u2'")] == pytest.approx([expected[x] for x in ("q1''", "u2'")], rel=1e-12)


def test_what_is_too_long_for_a_model_file_is_said_to_be(monkeypatch):
    """How long, and what helps; no place in a file that nobody wrote. By parts with names it has room."""
    q = dynamicsymbols("q")
    long = sum(sm.Symbol(f"a{k}".ljust(80, "x")) * sm.sin(k * q) for k in range(1, 120))
    model = eomgen.from_sympy(LagrangesMethod(q.diff() ** 2 / 2 - long, [q]))
    assert "; " in model.forces["V"].energy.text and len(model.parameters) == 119
    monkeypatch.setattr("eomgen.robots.sympy_joints.LONGEST_WITH_PARTS", 10_000)
    with pytest.raises(DerivationError, match=r"characters to write, of which a model file may have 10000"):
        eomgen.from_sympy(LagrangesMethod(q.diff() ** 2 / 2 - long, [q]))


def test_a_formula_that_is_written_as_another_one_is_refused(monkeypatch):
    """read(write(f)) = f at a random state: a text of 2 f, or of f with another sign, never becomes a model."""
    s = symbols("x y")
    x, y = s.q
    scalar = x * x + 3 * y
    assert file_texts([scalar]) == ["x^2 + 3*y"]
    for text in ("2*x^2 + 6*y", "x^2 - 3*y"):
        monkeypatch.setattr(sympy_words, "to_text", lambda _, text=text: text)
        with pytest.raises(DerivationError, match="written as another one"):
            file_texts([scalar])


def test_a_parameter_that_is_called_like_a_coordinate_or_an_input_is_another_thing():
    """Symbol("q") beside q(t), Symbol("F") beside F(t): q'' = (F(t) F - q)/q of T = q q'^2/2, V = q^2/2."""
    q, F = dynamicsymbols("q F")
    N = ReferenceFrame("N")
    P = Point("P")
    P.set_vel(N, q.diff() * N.x)
    L = sm.Symbol("q") * q.diff() ** 2 / 2 - q**2 / 2
    model = eomgen.from_sympy(LagrangesMethod(L, [q], forcelist=[(P, F * sm.Symbol("F") * N.x)], frame=N))
    assert set(model.parameters) == {"q_2", "F_2"} and set(model.inputs) == {"F"}
    rhs = eomgen.derive(model).rhs("numpy")
    p = [{"q_2": 2.0, "F_2": 3.0}[name] for name in model.parameters]
    assert rhs(0.0, [0.5, 0.0], p, [7.0])[1] == pytest.approx((7 * 3 - 0.5) / 2)


def test_a_particle_hangs_on_a_joint_as_sympy_s_tutorial_has_it():
    """A block on a rail and a bob on it, both particles: u' of the joints' System against sympy's own."""
    system = SYSTEMS["particles_on_joints"]()
    model = eomgen.from_sympy(system)
    assert [body.joint.kind for body in model.bodies.values()] == ["prismatic", "revolute"]
    assert [x.text for x in model.bodies["C"].inertia] == ["0", "0", "0"] and eomgen.derive(model).certify().ok


@each("by", ["speeds that are rates", "speeds of their own", "no joints"])
def test_a_system_that_is_formed_by_lagrange_has_the_potential_energies_of_its_bodies(by):
    """(A_zz + m l^2) q'' = m g l sin q, V = m g l cos q of the body: a System with eom_method=LagrangesMethod."""
    q, (m, l, g, J) = dynamicsymbols("q"), sm.symbols("m l g J")
    wall, A = RigidBody("N"), RigidBody("A", mass=m)
    A.central_inertia = inertia(A.frame, 0, 0, J)
    system = System.from_newtonian(wall)
    if by == "no joints":
        A.frame.orient_axis(wall.frame, q, wall.z)
        A.masscenter.set_pos(wall.masscenter, -l * A.x)
        A.masscenter.set_vel(wall.frame, -l * q.diff() * A.y)
        system.add_bodies(A)
        system.q_ind = [q]
    else:
        own = {"speeds": q.diff()} if by == "speeds that are rates" else {}
        system.add_joints(PinJoint("J", wall, A, coordinates=q, child_point=l * A.x, joint_axis=wall.z, **own))
    A.potential_energy = -m * g * l * sm.cos(q)
    system.form_eoms(eom_method=LagrangesMethod)
    model = eomgen.from_sympy(system)
    values = {"m": 2.0, "l": 0.7, "g": 9.81, "J": 0.3}
    rhs = eomgen.derive(model, parameters=values).rhs("numpy")
    found = rhs(0.0, [0.4, 0.9], [values.get(name, 0.0) for name in model.parameters], [])
    assert found[1] == pytest.approx(-2 * 9.81 * 0.7 * np.sin(0.4) / (0.3 + 2 * 0.49), rel=1e-14)


def test_auxiliary_speeds_are_zero_and_what_they_alone_measure_is_gone():
    """A point that could leave its place with u_aux, held by a force f: u' without either; f is no input."""
    q, u, aux, f = dynamicsymbols("q u aux f")
    m, l, g = sm.symbols("m l g")
    N = ReferenceFrame("N")
    A = N.orientnew("A", "Axis", [q, N.z])
    A.set_ang_vel(N, u * N.z)
    O, P = Point("O"), Point("P")
    O.set_vel(N, aux * N.x)
    P.set_pos(O, l * A.x)
    P.v2pt_theory(O, N, A)
    loads = [(P, m * g * N.x), (O, f * N.x)]
    method = KanesMethod(N, [q], [u], [q.diff() - u], u_auxiliary=[aux], bodies=[Particle("Pa", P, m)], forcelist=loads)
    model = eomgen.from_sympy(method)
    assert not model.inputs and set(model.parameters) == {"m", "l", "g"}
    rhs = eomgen.derive(model).rhs("numpy")
    p = [{"m": 2.0, "l": 0.5, "g": 9.81}[name] for name in model.parameters]
    assert rhs(0.0, [0.3, 1.2], p, [])[1] == pytest.approx(-9.81 / 0.5 * np.sin(0.3), rel=1e-14)


@each("explicit", [True, False])
def test_kinematic_equations_are_solved_for_the_speeds_where_sympy_has_none(explicit):
    """omega of a body by three turns as speeds, explicit or not: u = Y q'; Euler's equations without torques."""
    q, u = dynamicsymbols("q1:4"), dynamicsymbols("u1:4")
    J = sm.symbols("J1:4")
    N = ReferenceFrame("N")
    B = N.orientnew("B", "Body", q, "xyz")
    kinematic = [(B.ang_vel_in(N) - sum((x * axis for x, axis in zip(u, B, strict=True)), 0 * N.x)).dot(a) for a in B]
    B.set_ang_vel(N, sum((x * axis for x, axis in zip(u, B, strict=True)), 0 * N.x))
    O = Point("O")
    O.set_vel(N, 0)
    body = RigidBody("b", O, B, 0, (inertia(B, *J), O))
    method = KanesMethod(N, q, u, kinematic, bodies=[body], explicit_kinematics=explicit)
    model = eomgen.from_sympy(method)
    values = {"J1": 1.0, "J2": 2.0, "J3": 4.0}
    rhs = eomgen.derive(model, parameters=values).rhs("numpy")
    found = rhs(0.0, [0.3, 0.4, 0.5, 0.6, -0.7, 0.8], [values[name] for name in model.parameters], [])
    assert set(model.speeds) == {"u1", "u2", "u3"}
    assert found[3:] == pytest.approx([-0.7 * 0.8 * (2 - 4) / 1, 0.8 * 0.6 * (4 - 1) / 2, -0.6 * 0.7 * (1 - 2) / 4])


@in_slow_run
def test_a_bicycle_has_room_in_a_model_file_by_parts_with_names(tmp_path):
    """Sympy's own bicycle (743 000 characters multiplied out): u' as sympy has them, the file reads as the model.

    Slow: sympy derives its bicycle itself.
    """
    method, known = bicycle()
    model = eomgen.from_sympy(method, path=tmp_path / "bicycle.toml")
    assert eomgen.load(tmp_path / "bicycle.toml") == model and (tmp_path / "bicycle.toml").stat().st_size < 100_000
    assert any("; z2 = " in force.energy.text for force in model.forces.values() if force.kind == "kinetic")
    values = {name: known[name] for name in model.parameters}
    start = {"q1": 0.2, "q2": 0.15, "q5": 0.3, "q4": -0.05, "q2'": 0.3, "q5'": -0.4, "u3_0'": -5.0}
    equations = eomgen.derive(model, parameters=values, start=start)
    x = equations.start()
    dx = equations.rhs("numpy")(0.0, x, list(values.values()), [])
    q = equations.coordinates
    speeds = {"q1": "u1", "q2": "u2", "u3_0": "u3", "q4": "u4", "q5": "u5", "u6_0": "u6"}
    known |= dict(zip(q, x, strict=False)) | {speeds[name]: rate for name, rate in zip(q, dx, strict=False)}
    expected = accelerations_by_kane(method, known)
    found = {speeds[name]: a for name, a in zip(q, dx[len(q) :], strict=True)}
    assert found == pytest.approx(expected, rel=1e-9)
