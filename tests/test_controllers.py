"""Feedback: by an expression of the state, sampled and held, by a Python function; each against what is known of it."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from scipy.linalg import expm, solve_continuous_are

import eomgen
from eomgen.errors import NotYet, UsageError
from eomgen.model.replaced import Requests

MODELS = Path(__file__).parents[1] / "models"
SLIDE = """
eomgen = 1
space = "plane"
parameters = { m = 2, k = 18 }
coordinates = { x = 0.3 }
inputs = { F = 0, G = 0 }
bodies.mass.shape = { kind = "particle", mass = "m" }
bodies.mass.joint = { kind = "prismatic", axis = [1, 0], displacement = "x", stiffness = "k", force = "F + G" }
outputs.push = "F + G"
outputs.acceleration = "x''"
"""


@pytest.fixture(scope="module")
def pole():
    return eomgen.load(MODELS / "cart_pole.toml")


@pytest.fixture(scope="module")
def gains(pole):
    """Of the linear quadratic regulator: F = -K (x, theta, x', theta')."""
    small = eomgen.linearize(pole)
    return (small.B.T @ solve_continuous_are(small.A, small.B, np.eye(4), np.eye(1)))[0]


def law_of_gains(gains) -> str:
    return "0" + "".join(f" - ({k:.12g})*{name}" for k, name in zip(gains, ("x", "theta", "x'", "theta'"), strict=True))


@pytest.mark.slow
def test_a_law_of_the_state_is_part_of_the_equations(pole, gains):
    """A_closed = A - B K; the pole stands; the run is proven, reactions and outputs follow the law."""
    law = law_of_gains(gains)
    small = eomgen.linearize(pole)
    closed = eomgen.linearize(Requests(pole).with_inputs({"F": law}))
    wanted = np.linalg.eigvals(small.A - small.B @ gains[None, :])
    assert np.sort_complex(np.linalg.eigvals(closed.A)) == pytest.approx(np.sort_complex(wanted), rel=1e-8)
    run = eomgen.simulate(pole, time=12, samples=25, inputs={"F": law})
    assert abs(run["theta"][-1]) < 1e-4 and run.certify().ok
    assert run["hinge_x"][0] == pytest.approx(eomgen.solve(Requests(pole).with_inputs({"F": law}))["hinge_x"].value)


@pytest.mark.slow
def test_a_python_function_gives_what_the_expression_gives(pole, gains):
    """The same motion, reactions and outputs, and that it is slow and unproven is said."""
    known = eomgen.simulate(pole, time=2, samples=21, inputs={"F": law_of_gains(gains)})
    with pytest.warns(RuntimeWarning, match="set by Python functions: stepped by scipy"):
        run = eomgen.simulate(pole, time=2, samples=21, inputs={"F": lambda t, x: -gains @ x})
    assert run.x == pytest.approx(known.x, abs=1e-8)
    assert run["hinge_x"] == pytest.approx(known["hinge_x"], abs=1e-7)
    proof = run.certify()
    assert proof.ok and [check.status for check in proof.checks if "follows" in check.name] == ["unchecked"]


@pytest.mark.slow
def test_what_is_sampled_and_held_is_the_discrete_system():
    """x_(k+1) = A_d x_k + B_d u_k, u_k = -K x_k, A_d, B_d by the matrix exponential; two controllers, two periods."""
    model, h, K = eomgen.loads(SLIDE), 0.05, np.array([7.0, 3.0])
    A, B = np.array([[0.0, 1.0], [-9.0, 0.0]]), np.array([[0.0], [0.5]])
    block = expm(np.block([[A, B], [np.zeros((1, 3))]]) * h)
    state, states, pushes = np.array([0.3, 0.0]), [], []
    slow = 0.0
    for k in range(40):
        slow = -2 * state[0] if k % 4 == 0 else slow
        u = float(-K @ state) + slow
        states.append(state)
        pushes.append(u)
        state = block[:2, :2] @ state + block[:2, 2] * u
    inputs = {"F": {"value": "-7*x - 3*x'", "every": h}, "G": {"value": lambda t, x: -2 * x[0], "every": 4 * h}}
    run = eomgen.simulate(model, time=2, inputs=inputs, samples=41, rtol=1e-11, atol=1e-11)
    assert run.x[:-1] == pytest.approx(np.array(states), abs=1e-9) and run.x[-1] == pytest.approx(state, abs=1e-9)
    assert len(run.t) == 41 and run["push"][:-1] == pytest.approx(pushes, abs=1e-8)
    assert run["acceleration"][:-1] == pytest.approx(
        [u / 2 - 9 * x[0] for u, x in zip(pushes, states, strict=True)], abs=1e-7
    )
    assert run.ok and run.certify().ok
    assert run.ask("max(x)").value == pytest.approx(0.3, abs=1e-9)


@pytest.mark.slow
def test_a_controller_that_samples_faster_comes_nearer_to_the_law():
    """The difference to the continuous law falls as the period does."""
    model, law = eomgen.loads(SLIDE), "-7*x - 3*x'"
    known = eomgen.simulate(model, time=1, samples=11, inputs={"F": law}).x
    errors = []
    for every in (0.04, 0.02, 0.01):
        run = eomgen.simulate(model, time=1, samples=11, inputs={"F": {"value": law, "every": every}})
        errors.append(float(np.abs(run.x - known).max()))
    assert errors[0] / errors[1] == pytest.approx(2, rel=0.15) and errors[1] / errors[2] == pytest.approx(2, rel=0.15)


@pytest.mark.slow
def test_an_arm_under_proportional_and_differential_control_reaches_its_place():
    """tau = Kp (q_d - q) - Kd q' + G leaves nothing at rest; without the weight's share q_d - q = -G/Kp."""
    arm = eomgen.load(MODELS / "arm3.toml")
    wanted = {"q1": 1.0, "q2": 0.5, "q3": -0.4}
    laws = {f"tau{k}": f"200*({q_d} - {q}) - 40*{q}'" for k, (q, q_d) in enumerate(wanted.items(), start=1)}
    run = eomgen.simulate(arm, time=12, samples=5, inputs=laws)
    inverse = eomgen.inverse_dynamics(arm).function("numpy")
    end = np.concatenate([run.x[-1, :3], np.zeros(3)])
    p = [float(part.value.literal) for part in arm.parameters.values()]
    held = inverse(0.0, end, np.zeros(3), p)
    for k, (q, q_d) in enumerate(wanted.items()):
        assert 200 * (q_d - run[q][-1]) == pytest.approx(held[k], abs=1e-5)


@pytest.mark.parametrize(
    ("inputs", "message"),
    [
        ({"H": "-x"}, "no input 'H'"),
        ({"H": lambda t, x: 0.0}, "no input 'H'"),
        ({"F": "-y"}, "'y'"),
        ({"F": "-x - G", "G": "-x"}, "'G' cannot stand in it"),
        ({"F": {"value": "-x", "every": 0}}, "makes no sense"),
        ({"F": {"value": "-x", "every": 0.1, "delay": 1}}, "is no controller"),
        ({"F": {"value": "-x", "every": 1e-9}}, "samples of controllers"),
    ],
)
def test_what_is_no_controller_is_refused(inputs, message):
    with pytest.raises((UsageError, eomgen.EomgenError), match=message):
        eomgen.simulate(eomgen.loads(SLIDE), time=1, inputs=inputs)


@pytest.mark.slow
def test_contacts_end_under_a_controller_and_a_function_is_refused_by_name():
    """Held at 0 the ladder leaves the wall when it does without one; a Python function of a model with contacts: no."""
    text = (MODELS / "sliding_ladder.toml").read_text(encoding="utf-8")
    text = text.replace("[coordinates]", "[inputs]\npush = 0\n[coordinates]", 1)
    text += '\n[forces.pushed]\nkind = "force"\npoint = "ladder.center"\nforce = ["push", 0]\n'
    model = eomgen.loads(text)
    with pytest.raises(NotYet, match="contacts change"):
        eomgen.simulate(model, time=0.1, inputs={"push": lambda t, x: 0.0})
    held = eomgen.simulate(model, time=1, samples=5, inputs={"push": {"value": lambda t, x: 0.0, "every": 0.25}})
    free = eomgen.simulate(model, time=1, samples=5)
    assert held.x == pytest.approx(free.x[np.isin(free.t, held.t)], abs=1e-7)
    left = free.phases[0].end
    assert min(abs(phase.end - left) for phase in held.phases) < 1e-8
    pushed = eomgen.simulate(model, time=1, samples=5, inputs={"push": {"value": "-5*abs(theta')", "every": 0.25}})
    assert pushed.ok and pushed.certify().ok


RUBBING = """
eomgen = 1
space = "plane"
parameters = { m = 2, mu = 0.3, g = 9.81 }
coordinates = { x = { start = 0, speed = 1 } }
inputs = { F = 0 }
bodies.mass = { shape = { kind = "particle", mass = "m" }, joint = { kind = "placed", at = ["x", 0] } }
constraints.floor = { kind = "support", point = "mass.center", normal = [0, 1], friction = "mu" }
forces.weight = { kind = "gravity", acceleration = [0, "-g"] }
forces.push = { kind = "force", point = "mass.center", force = ["F", 0] }
"""


def pushed_by_hand(law, every, time):
    """x, v after pushes that are held: m a = F - sign(v) mu m g piece by piece, at rest where |F| <= mu m g."""
    x, v, m, rubs = 0.0, 1.0, 2.0, 0.3 * 2.0 * 9.81
    for k in range(round(time / every)):
        F, left = law(k * every), every
        while left > 1e-14 and (v or abs(F) > rubs):
            a = (F - np.sign(v or F) * rubs) / m
            stops = v and a * v < 0 and -v / a < left
            dt = -v / a if stops else left
            x, v, left = x + v * dt + a * dt**2 / 2, 0.0 if stops else v + a * dt, left - dt
    return x, v


@pytest.mark.slow
@pytest.mark.parametrize("every", [0.1, 0.25])
def test_where_a_held_force_jumps_it_is_seen_anew_what_sticks_and_slides(every):
    """8 sin(3 t), sampled, on a mass that rubs: no phase begins in a grip that its first instant denies."""
    model = eomgen.loads(RUBBING)
    run = eomgen.simulate(model, time=2, samples=3, inputs={"F": {"value": "8*sin(3*t)", "every": every}})
    assert run.x[-1] == pytest.approx(pushed_by_hand(lambda t: 8 * np.sin(3 * t), every, 2), abs=1e-8)
    assert all(phase.end > phase.start for phase in run.phases) and run.certify().ok
