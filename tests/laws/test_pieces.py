"""What has pieces is decided in every one; no coincidence becomes a formula; states are found from the start."""

from __future__ import annotations

from pathlib import Path

import pytest
from slow_run import in_slow_run, sampled

import eomgen
from eomgen.documents.text import render
from eomgen.errors import UsageError
from eomgen.mechanics.dynamics import pieces, wellposed
from eomgen.mechanics.dynamics.wellposed import WellPosed
from eomgen.mechanics.integrals.first_integrals import FirstIntegrals
from eomgen.mechanics.integrals.laws import laws_of_motion
from eomgen.mechanics.start.exact import declared_start
from eomgen.proof.trials import Trials
from eomgen.study import study_of
from eomgen.symbolic.numeric import tolerances
from eomgen.symbolic.numeric.evaluation import evaluate, fifty_digits

BALL = """
eomgen = 1
space = "plane"
[parameters]
m = 0.5
k = 20000
c = 20
F0 = 3
t0 = 2
L = 1.5
g = 9.81
[coordinates]
y = { start = 1 }
[bodies.ball]
shape = { kind = "particle", mass = "m" }
joint = { kind = "prismatic", axis = [0, 1], displacement = "y" }
[forces.weight]
kind = "gravity"
acceleration = [0, "-g"]
"""
FLOOR = '[forces.floor]\nkind = "force"\npoint = "ball.center"\nforce = [0, "max(0, -k*y)"]\n'
CEILING = '[forces.ceiling]\nkind = "force"\npoint = "ball.center"\nforce = [0, "min(0, k*(L - y))"]\n'
ONE_WAY = '[forces.damper]\nkind = "force"\npoint = "ball.center"\nforce = [0, "c*max(0, -y\')"]\n'
MOTOR = '[forces.motor]\nkind = "force"\npoint = "ball.center"\nforce = [0, "F0*max(0, t - t0)"]\n'
BUNGEE = """
eomgen = 1
space = "plane"
[parameters]
m = 70
k = 150
L0 = 10
g = 9.81
[coordinates]
y = { start = -1 }
[points]
O = [0, 0]
[bodies.man]
shape = { kind = "particle", mass = "m" }
joint = { kind = "prismatic", axis = [0, 1], displacement = "y" }
[forces.bungee]
kind = "between"
points = ["O", "man.center"]
pull = "k*max(0, r - L0)"
[forces.w]
kind = "gravity"
acceleration = [0, "-g"]
[outputs]
v2 = { value = "y'^2", from = "rest" }
"""
IN_SPACE = """
eomgen = 1
space = "space"
parameters = { m = 2, k = 500, d = 0.4, g = 9.81 }
coordinates = { x = 0, y = 0, z = 1 }
bodies.p.shape = { kind = "particle", mass = "m" }
bodies.p.joint = { kind = "placed", at = ["x", "y", "z"] }
forces.w = { kind = "gravity", acceleration = [0, 0, "-g"] }
forces.floor = { kind = "force", point = "p.center", force = [0, 0, "max(0, -k*z)"] }
forces.wall = { kind = "force", point = "p.center", force = ["min(0, k*(d - x))", 0, 0] }
"""
IN_A_LOOP = """
eomgen = 1
space = "plane"
parameters = { m = 2, l = 0.5, k = 500, g = 9.81 }
coordinates = { a = 0.4, b = { dependent = true, near = -0.8 }, s = { dependent = true, near = 0.9 } }
bodies.crank.shape = { kind = "rod", mass = "m", length = "l" }
bodies.crank.joint = { kind = "revolute", angle = "a" }
bodies.rod.shape = { kind = "rod", mass = "m", length = "l" }
bodies.rod.joint = { kind = "revolute", on = "crank.end", angle = "b" }
bodies.slide.shape = { kind = "particle", mass = "m" }
bodies.slide.joint = { kind = "prismatic", axis = [1, 0], displacement = "s" }
constraints.pin = { kind = "pin", points = ["rod.end", "slide.center"] }
forces.stop = { kind = "force", point = "slide.center", force = ["min(0, k*(l - s))", 0] }
"""


def at(text: str, tmp_path: Path) -> Path:
    path = tmp_path / "model.toml"
    path.write_text(text)
    return path


STEP = """
eomgen = 1
space = "plane"
parameters = { m = 2, c = 3 }
coordinates = { x = { start = 1, speed = -1 } }
bodies.p.shape = { kind = "particle", mass = "m" }
bodies.p.joint = { kind = "prismatic", axis = [1, 0], displacement = "x" }
forces.step = { kind = "potential", energy = "c*sign(x)" }  # jumps, and pushes nowhere
"""


def printed(text: str, tmp_path: Path) -> str:
    """The derivation, each statement on one line."""
    return render(eomgen.derive(at(text, tmp_path)).derivation)


def where(text: str, tmp_path: Path) -> str:
    """Where T + V stays, in words; "everywhere", "nowhere"."""
    held = WellPosed(eomgen.derive(at(text, tmp_path)).graph).where_conservative
    return "everywhere" if held.everywhere else held.text or "nowhere"


@pytest.mark.parametrize(
    ("system", "reported"),
    [
        (BALL, "everywhere"),
        (BALL + FLOOR, "y >= 0"),
        (BALL + CEILING, "y <= L"),
        (BALL + ONE_WAY, "nowhere"),
        (BALL + MOTOR, "t <= t0"),
        (BALL + FLOOR + CEILING, "y <= L and y >= 0"),
        (BALL.replace("start = 1", "start = 1, speed = 3") + FLOOR + ONE_WAY, "y' >= 0 and y >= 0"),
        (BUNGEE, "abs(y) <= L0"),
        (IN_SPACE, "x <= d and z >= 0"),
        (STEP, "x >= 0"),
    ],
)
def test_energy_stays_in_the_pieces_in_which_nothing_without_a_potential_acts(system, reported, tmp_path):
    """d(T + V)/dt = Q_nc . u, and Q_nc = max(0, -k y) is 0 while y >= 0 alone."""
    assert set(where(system, tmp_path).split(" and ")) == set(reported.split(" and "))


def test_energy_in_a_loop_stays_while_its_stop_is_free(tmp_path):
    """The slide of a crank drive leans on its stop where s > l: nothing is said where it starts so."""
    assert where(IN_A_LOOP, tmp_path) == "nowhere"
    free = (
        IN_A_LOOP.replace("a = 0.4", "a = 1.4")
        .replace("near = -0.8", "near = -2.8")
        .replace("near = 0.9", "near = 0.17")
    )
    assert where(free, tmp_path) == "s <= l"


@pytest.mark.parametrize("parts", [FLOOR, FLOOR + ONE_WAY, FLOOR + CEILING + MOTOR])
def test_derivations_of_elastic_floors_walls_dampers_and_motors_hold(parts, tmp_path):
    """What is printed to stay constant does so in the piece that is named."""
    equations = eomgen.derive(at(BALL + parts, tmp_path))
    assert equations.certify().ok, equations.certify()


def test_what_holds_in_one_piece_says_where_it_is_printed(tmp_path):
    """T + V = const while y >= 0."""
    text = printed(BALL + FLOOR, tmp_path)
    assert "The energy T + V stays constant while y >= 0:" in text


def test_where_a_force_is_one_of_the_place_alone_its_work_is_counted_in_every_piece(tmp_path):
    """y'^2 = 2 g (1 - y) - (k/m) min(0, y)^2, by the integral of the force along the way."""
    outputs = '[outputs]\nv2 = { value = "y\'^2", from = "rest" }\n'
    path = at(BALL + FLOOR + outputs, tmp_path)
    found = eomgen.solve(path)["v2"]
    assert found.exact is not None and found.method == "energy theorem"
    assert eomgen.verify(path, f"y'^2 = {found.exact}").verdict == "right"
    by_hand = eomgen.verify(path, "y'^2 = 2*g*(1 - y) - k/m*max(0, -y)^2")
    assert (by_hand.verdict, by_hand.up_to) == ("right", "the first integral from the start")


def test_an_answer_by_the_energy_of_a_bungee_is_refused_where_its_cord_is_taut(tmp_path):
    """y'^2 = -2 g (1 + y) until the cord is taut, after sqrt(2*9/9.81) s."""
    found = eomgen.solve(at(BUNGEE, tmp_path))["v2"]
    assert found.exact is None
    assert "while abs(y) <= L0" in found.message and "leaves that at t = 1.35" in found.message


@in_slow_run
@pytest.mark.slow
def test_an_answer_by_the_energy_is_given_only_if_the_motion_stays_in_its_piece(tmp_path):
    """A pendulum on a cart between two buffers: p_x stays while the cart touches neither, and it comes to one."""
    text = """
    eomgen = 1
    space = "plane"
    parameters = { m = 2, M = 3, l = 0.5, k = 500, d = 0.3, g = 9.81 }
    coordinates = { x = { start = 0, speed = 1 }, th = 0.4 }
    bodies.cart.shape = { kind = "particle", mass = "M" }
    bodies.cart.joint = { kind = "prismatic", axis = [1, 0], displacement = "x" }
    bodies.rod.shape = { kind = "rod", mass = "m", length = "l" }
    bodies.rod.joint = { kind = "revolute", on = "cart.center", angle = "th - pi/2" }
    forces.w = { kind = "gravity", acceleration = [0, "-g"] }
    forces.left = { kind = "force", point = "cart.center", force = ["max(0, -k*(d + x))", 0] }
    forces.right = { kind = "force", point = "cart.center", force = ["min(0, k*(d - x))", 0] }
    outputs.w2 = { value = "th'^2", from = "start" }
    """
    found = eomgen.solve(at(text, tmp_path))["w2"]
    assert found.exact is None and "only while" in found.message and "the motion leaves that at t" in found.message
    assert "x >= -d" in found.message and "x <= d" in found.message


def test_an_answer_by_the_energy_of_one_piece_is_given_where_the_motion_stays_there(tmp_path):
    """A pendulum that never leans on its stop: theta'^2 = (2 g/l)(cos theta - cos theta_0)."""
    text = """
    eomgen = 1
    space = "plane"
    parameters = { m = 2, l = 0.5, k = 500, g = 9.81 }
    coordinates = { theta = 0.4 }
    bodies.bob.shape = { kind = "particle", mass = "m" }
    bodies.bob.joint = { kind = "placed", at = ["l*sin(theta)", "-l*cos(theta)"] }
    forces.w = { kind = "gravity", acceleration = [0, "-g"] }
    forces.stop = { kind = "generalized", coordinate = "theta", value = "k*(1 - theta)*max(0, theta - 1)" }
    outputs.w2 = { value = "theta'^2", from = "rest" }
    """
    found = eomgen.solve(at(text, tmp_path))["w2"]
    assert found.method == "energy theorem, while theta <= 1" and found.exact is not None


@pytest.mark.parametrize("requested", [BALL + FLOOR + '[outputs]\nv2 = { value = "y\'^2", from = "rest" }\n', BUNGEE])
def test_the_proof_of_answers_sees_an_energy_that_stays_in_one_piece_alone(requested, tmp_path, monkeypatch):
    """Planted: what stays in the piece of the start stays; y'^2 = 2 g (1 - y) fails where the floor is touched."""
    where_holds = wellposed.where_holds

    def at_the_start(equations, scalars, decide):
        return pieces.Extent(bool(where_holds(equations, scalars, decide)))

    monkeypatch.setattr(wellposed, "where_holds", at_the_start)
    found = eomgen.solve(at(requested, tmp_path))
    assert found["v2"].exact is not None and found.certify().ok is False


def test_stabilization_by_energy_is_refused_where_it_does_not_stay(tmp_path):
    """The message names the piece, or what acts without a potential."""
    with pytest.raises(UsageError, match="T \\+ V stays constant only while y >= 0"):
        eomgen.simulate(at(BALL + FLOOR, tmp_path), time=1, stabilization="energy")
    with pytest.raises(UsageError, match="'damper' has no potential"):
        eomgen.simulate(at(BALL + ONE_WAY, tmp_path), time=1, stabilization="energy")


def test_a_momentum_stays_while_nothing_pushes_along_it(tmp_path):
    """dp_x/dt = min(0, k (d - x)) is 0 while x <= d."""
    found = {
        each.coordinate: each.held for each in FirstIntegrals(eomgen.derive(at(IN_SPACE, tmp_path)).graph).of_momentum
    }
    assert found["y"].everywhere and found["x"].text == "x <= d" and found["z"].text == "z >= 0"


def test_what_fails_where_the_motion_starts_is_asked_in_no_other_piece(tmp_path):
    """Whatever holds somewhere holds at the start; the pieces of F are those of 2 F + 1, looked for once."""
    equations = eomgen.derive(at(BALL + FLOOR, tmp_path)).graph
    (F,) = equations.forcing
    division = pieces.division_of(equations, (F,))
    assert division is pieces.division_of(equations, (2 * F + 1,))
    requested = []
    assert division.where(lambda piece: requested.append(piece) is not None) == pieces.Extent(False)
    assert requested == [division.start]
    assert division.where(lambda piece: requested.append(piece) is None) == pieces.Extent(True)
    assert set(requested) == set(division.found) and len(division.found) == 2


def test_what_begins_later_has_no_law_of_motion_in_closed_form(tmp_path):
    """x'' = -w^2 x + f max(0, t - t0): after t0 a vibration is added that no particular solution by pieces has."""
    spring = 'joint = { kind = "prismatic", axis = [0, 1], displacement = "y", stiffness = "k" }'
    text = BALL.replace('joint = { kind = "prismatic", axis = [0, 1], displacement = "y" }', spring) + MOTOR
    phase = study_of(eomgen.load(at(text, tmp_path)))
    assert laws_of_motion(phase.system, phase.accelerations, declared_start(phase.system)) == {}


@sampled(2)
@pytest.mark.slow
@pytest.mark.parametrize(
    ("written", "verdict", "up_to"),
    [
        ("y'^2 = 2*g*(1 - y)", "right", "while y >= 0"),
        ("1/2*m*y'^2 + m*g*y = m*g", "right", "while y >= 0"),
        ("y'' = -g", "wrong", "while y >= 0"),
        ("m*y'' = max(0, -k*y) - m*g", "right", ""),
        ("y'^2 = 2*g*(2 - y)", "wrong", ""),
        ("1/2*m*y'^2 + m*g*y = C", "right", "while y >= 0"),
        ("y'' = -9.81", "wrong", ""),
        ("y'^2 = 2*9.81*(1 - y)", "right", "while y >= 0"),
    ],
)
def test_a_verdict_says_in_which_piece(written, verdict, up_to, tmp_path):
    """What follows from the start holds until the ball lands; an equation of motion must hold in every piece."""
    found = eomgen.verify(at(BALL + FLOOR, tmp_path), written)
    assert (found.verdict, up_to in found.up_to, bool(found.up_to)) == (verdict, True, bool(up_to))


# -- samples ---------------------------------------------------------------------------------------


@in_slow_run
@pytest.mark.slow
def test_beside_samples_neither_energy_nor_jacobi_s_integral_stays(tmp_path):
    """A bead on an arm that turns by samples: dH/dt = -dT/dt of what moves by itself, which is at no steady rate."""
    text = """
    eomgen = 1
    space = "plane"
    parameters = { m = 2 }
    coordinates = { a = { motion = { samples = [[0, 0], [1, 0.7], [2, 0.2], [3, 0.4]] } }, s = 0.3 }
    bodies.arm.joint = { kind = "revolute", angle = "a" }
    bodies.bead.shape = { kind = "particle", mass = "m" }
    bodies.bead.joint = { kind = "prismatic", on = "arm", axis = [1, 0], displacement = "s" }
    """
    equations = eomgen.derive(at(text, tmp_path))
    assert FirstIntegrals(equations.graph).of_energy == () and not WellPosed(equations.graph).is_conservative
    assert "stays constant" not in render(equations.derivation)


# -- coincidences ----------------------------------------------------------------------------------

SEA = """
eomgen = 1
space = "space"
parameters = { m = 1, k = 2.5, q = 3, A = 0.2, B = 0.15, g = 9.81 }
coordinates = { x = 0.6, y = 3.1, z = { near = 0 } }
bodies.p.shape = { kind = "particle", mass = "m" }
bodies.p.joint = { kind = "placed", at = ["x", "y", "z"] }
constraints.sea = { kind = "equation", gap = "z(p.center) - A*sin(k*x(p.center)) - B*cos(q*y(p.center))" }
forces.weight = { kind = "gravity", acceleration = [0, 0, "-g"] }
outputs = { y0 = { value = "y", at = "equilibrium" }, z0 = { value = "z", at = "equilibrium" } }
"""


@in_slow_run
@pytest.mark.slow
def test_a_place_of_rest_is_exact_only_as_a_function_of_the_parameters(tmp_path):
    """sin(q y) = 0 at y = 3 pi/q, which is pi at q = 3 alone."""
    found = eomgen.solve(at(SEA, tmp_path))
    assert (found["y0"].exact, found["z0"].exact) == ("3*pi/q", "A - B")
    other = eomgen.solve(at(SEA, tmp_path), parameters={"q": 3.1})
    assert other["y0"].value == pytest.approx(3 * 3.141592653589793 / 3.1)


def test_masses_that_are_equal_do_not_drop_out_of_speeds(tmp_path):
    """(M + m1 + m2) X' + (m1 - m2) s' = 0: X' = (m2 - m1) s'/(M + m1 + m2), which is 0 at m1 = m2 alone."""
    text = """
    eomgen = 1
    space = "plane"
    parameters = { M = 3, m1 = 1, m2 = 1, g = 9.81 }
    coordinates = { X = 0, s = 0.1 }
    bodies.cart.shape = { kind = "particle", mass = "M" }
    bodies.cart.joint = { kind = "prismatic", axis = [1, 0], displacement = "X" }
    bodies.right.shape = { kind = "particle", mass = "m1" }
    bodies.right.joint = { kind = "placed", on = "cart", at = ["s", "s"] }
    bodies.left.shape = { kind = "particle", mass = "m2" }
    bodies.left.joint = { kind = "placed", on = "cart", at = ["-s", "s"] }
    forces.w = { kind = "gravity", acceleration = [0, "-g"] }
    outputs.v = { value = "X'^2", from = "rest" }
    """
    found = eomgen.solve(at(text, tmp_path))["v"]
    assert found.exact is not None and "m1" in found.exact


# -- domains, sizes, energies that are given ------------------------------------------------------------


def test_a_domain_far_from_where_states_are_drawn_is_found_from_the_start(tmp_path):
    """y = acos((s - 20)/3) has values for 17 < s < 23 alone."""
    text = """
    eomgen = 1
    space = "plane"
    parameters = { m = 2, g = 9.81 }
    coordinates = { s = { start = 21, speed = 0.3 } }
    bodies.b.shape = { kind = "particle", mass = "m" }
    bodies.b.joint = { kind = "placed", at = ["s", "acos((s - 20)/3)"] }
    forces.w = { kind = "gravity", acceleration = [0, "-g"] }
    """
    assert eomgen.derive(at(text, tmp_path)).certify().ok


def test_states_in_which_ties_close_do_so_to_their_last_digits(tmp_path):
    """|e|^2 - 1 below 1e-30, to which sides of an identity are compared: at 3e-31 luck decided whether M a differed."""
    text = """
    eomgen = 1
    space = "space"
    coordinates = { X = 0, Y = 0, Z = 0, e0 = 0.8, e1 = 0.4, e2 = 0.4, e3 = 0.2, u = 0.16 }
    speeds = { w1 = {}, w2 = {}, w3 = {} }
    bodies.a.shape = { kind = "box", mass = 2, size = [0.8, 0.2, 0.3] }
    [bodies.a.joint]
    kind = "free"
    position = ["X", "Y", "Z"]
    orientation = "quaternion"
    quaternion = ["e0", "e1", "e2", "e3"]
    omega = ["w1", "w2", "w3"]
    [bodies.b]
    shape = { kind = "box", mass = 1, size = [0.8, 0.2, 0.3] }
    points = { Q = [0.5, -0.2, 0.1] }
    [bodies.b.joint]
    kind = "path"
    on = "a"
    along = "u"
    heading = 0.2
    pieces = [{ line = 1 }, { arc = 0.5, turn = "ccw", angle = 1.2 }]
    [constraints]
    T = { kind = "support", point = "b.Q", normal = [0, 0, 1] }
    """
    graph = eomgen.derive(at(text, tmp_path)).graph
    norms = graph.system.constraints.norms
    for _, supply in Trials(graph).states.supplies:
        for place, _ in zip(supply, range(2), strict=False):
            assert all(abs(x) < tolerances.CERTAIN_AT_50**1.2 for x in evaluate(norms, place.state, fifty_digits()))


def test_kinetic_energies_that_are_given_count_in_the_second_definitions(tmp_path):
    """T = m l^2 y'^2/6 + (1 + y^2) y'^2/5 = 0.26525 J at y = 0.2, y' = -0.7."""
    text = """
    eomgen = 1
    space = "plane"
    parameters = { m = 2 }
    coordinates = { y = { start = 0.2, speed = -0.7 } }
    bodies.b.shape = { kind = "rod", mass = "m", length = 1 }
    bodies.b.joint = { kind = "revolute", angle = "y" }
    forces.f1 = { kind = "kinetic", energy = "0.2*y'^2*(1 + y^2)" }
    outputs = { T = "kinetic_energy()", p = "momentum(y)", own = "kinetic_energy(b)" }
    """
    found = eomgen.solve(at(text, tmp_path))
    assert found["T"].value == pytest.approx(0.26525333333)
    assert found.certify().ok, found.certify()


def test_a_line_load_on_a_rod_that_moves_is_q_times_its_length(tmp_path):
    """sqrt(l^2) = l of a length l, in every line that is printed."""
    text = """
    eomgen = 1
    space = "plane"
    parameters = { m = 2, l = 0.5, w0 = 3 }
    coordinates = { th = 0.3 }
    bodies.rod.shape = { kind = "rod", mass = "m", length = "l" }
    bodies.rod.joint = { kind = "revolute", angle = "th" }
    forces.wind = { kind = "distributed", body = "rod", between = ["start", "end"], intensity = [0, "-w0"] }
    """
    for length in ("0.5", "{}"):  # without a value it is a length all the same
        reported = printed(text.replace("l = 0.5", f"l = {length}"), tmp_path)
        assert "abs(l)" not in reported and "sqrt(l^2)" not in reported and "Fy(wind 1) = -1/2*l*w0" in reported
