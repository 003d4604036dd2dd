"""Loops that no model of models/ shows, against formulas of one freedom: T = I(q) q'^2/2, I q'' + I'/2 q'^2 = Q."""

from __future__ import annotations

import json
import math
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import mpmath as mp
import numpy as np
import pytest
from scipy.integrate import solve_ivp
from slow_run import in_slow_run

import eomgen
from eomgen.errors import EomgenError
from eomgen.mechanics.dynamics.system import System
from eomgen.mechanics.start.assembly_modes import Branches
from eomgen.mechanics.start.state import Start

pytestmark = [
    pytest.mark.slow,
    pytest.mark.filterwarnings("ignore:.*(Statically indeterminate|No single value):RuntimeWarning"),
]

CRANK = """
eomgen = 1
name = "Slider-crank, every joint a hinge of space"
space = "space"
[parameters]
m = 1.5
r = 0.2
l = 0.6
g = 9.81
[coordinates]
phi = { start = 0.7, speed = 6 }
psi = {}
s = { near = 0.7 }
[bodies.crank]
shape = { kind = "rod", mass = "m", length = "r" }
joint = { kind = "revolute", axis = [0, 0, 1], angle = "phi" }
[bodies.rod]
shape = { kind = "rod", mass = "2*m", length = "l" }
joint = { kind = "revolute", on = "crank.end", axis = [0, 0, 2], angle = "psi" }
[bodies.slider]
mass = "m"
inertia = [0.01, 0.02, 0.03]
joint = { kind = "prismatic", axis = [1, 0, 0], displacement = "s" }
[constraints.wrist]
kind = "pin"
points = ["rod.end", "slider.origin"]
axis = [0, 0, 1]
[forces.weight]
kind = "gravity"
acceleration = [0, "-g", 0]
"""

UMBRELLA = (
    """
eomgen = 1
name = "Umbrella"
space = "space"
[parameters]
m = 0.2
L = 0.5
l = 0.25
g = 9.81
k = 60
c = 2
[coordinates]
s = { start = 0.35, speed = 0.4 }
"""
    + "".join(f"a{i} = {{ near = 0.8 }}\nb{i} = {{ near = 0.8 }}\n" for i in (1, 2, 3))
    + """
[bodies.runner]
mass = "m"
inertia = [0.001, 0.001, 0.001]
joint = { kind = "prismatic", axis = [0, 0, -1], displacement = "s", stiffness = "k", rest = 0.2, damping = "c" }
"""
    + "".join(
        f"""
[bodies.rib{i}]
mass = "m"
center = ["L/2", 0, 0]
inertia = [0, "m*L^2/12", "m*L^2/12"]
points = {{ mid = ["l", 0, 0] }}
joint = {{ kind = "revolute", turned = {{ angle = "2*{i}*pi/3" }}, axis = [0, 1, 0], angle = "a{i}" }}
[bodies.strut{i}]
mass = "m"
center = ["l/2", 0, 0]
inertia = [0, "m*l^2/12", "m*l^2/12"]
points = {{ end = ["l", 0, 0] }}
joint = {{ kind = "revolute", on = "runner", turned = {{ angle = "2*{i}*pi/3" }}, axis = [0, -1, 0], angle = "b{i}" }}
[constraints.P{i}]
kind = "pin"
points = ["strut{i}.end", "rib{i}.mid"]
axis = ["-sin(2*{i}*pi/3)", "cos(2*{i}*pi/3)", 0]
"""
        for i in (1, 2, 3)
    )
    + """
[forces.weight]
kind = "gravity"
acceleration = [0, 0, "-g"]
"""
)

GEARED = """
eomgen = 1
name = "Geared five-bar"
space = "plane"
[parameters]
m = 1
a = 0.3
b = 0.8
d = 0.7
n = -2
J = 0.05
g = 9.81
[coordinates]
al = { start = 1.2, speed = 3 }
de = { start = 2 }
be = { near = 0.5 }
ga = { near = 2.2 }
[bodies.c1]
mass = "m"
inertia = "J"
points = { end = ["a", 0] }
joint = { kind = "revolute", angle = "al" }
[bodies.c2]
mass = "m"
inertia = "J"
points = { end = ["a", 0] }
joint = { kind = "revolute", at = ["d", 0], angle = "de" }
[bodies.r1]
shape = { kind = "rod", mass = "m", length = "b" }
joint = { kind = "revolute", on = "c1.end", angle = "be - al" }
[bodies.r2]
shape = { kind = "rod", mass = "m", length = "b" }
joint = { kind = "revolute", on = "c2.end", angle = "ga - de" }
[constraints.P]
kind = "pin"
points = ["r1.end", "r2.end"]
[constraints.G]
kind = "gear"
bodies = ["c1", "c2"]
ratio = "n"
[forces.weight]
kind = "gravity"
acceleration = [0, "-g"]
"""

VICE = """
eomgen = 1
name = "Vice: the jaw turns neither with the spindle nor at all"
space = "space"
[parameters]
m = 2
J = 0.003
p = 0.005
T = 0.4
[coordinates]
ph = { start = 0.3, speed = 5 }
ps = -0.3
[bodies.spindle]
mass = 0.5
inertia = ["J", 0.01, 0.01]
joint = { kind = "revolute", axis = [1, 0, 0], angle = "ph", torque = "T" }
[bodies.jaw]
mass = "m"
inertia = [0.01, 0.02, 0.02]
joint = { kind = "screw", on = "spindle", axis = [1, 0, 0], angle = "ps", pitch = "p" }
[constraints.rail]
kind = "guide"
point = "jaw.origin"
along = [1, 0, 0]
"""

DIFFERENTIAL = """
eomgen = 1
name = "Differential with two planets, both axles on a road"
space = "space"
[parameters]
J = 0.1
Jp = 0.02
M = 500
R = 0.3
T = 50
[coordinates]
c = { start = 0, speed = 1 }
l = {}
r = {}
p1 = {}
p2 = {}
s = {}
[bodies.car]
mass = "M"
inertia = [1, 1, 1]
joint = { kind = "prismatic", axis = [0, 1, 0], displacement = "s" }
[bodies.cage]
mass = 2
inertia = ["J", "J", "J"]
joint = { kind = "revolute", on = "car", axis = [1, 0, 0], angle = "c", torque = "T" }
[bodies.left]
mass = 1
inertia = ["J", "J/2", "J/2"]
joint = { kind = "revolute", on = "cage", axis = [1, 0, 0], angle = "l" }
[bodies.right]
mass = 1
inertia = ["J", "J/2", "J/2"]
joint = { kind = "revolute", on = "cage", axis = [1, 0, 0], angle = "r" }
[bodies.planet1]
mass = 0.1
inertia = ["Jp", "Jp", "Jp"]
joint = { kind = "revolute", on = "cage", axis = [0, 1, 0], angle = "p1" }
[bodies.planet2]
mass = 0.1
inertia = ["Jp", "Jp", "Jp"]
joint = { kind = "revolute", on = "cage", axis = [0, -1, 0], angle = "p2" }
[constraints]
g1 = { kind = "gear", bodies = ["left", "planet1"], ratio = 0.5 }
g2 = { kind = "gear", bodies = ["right", "planet1"], ratio = -0.5 }
g3 = { kind = "gear", bodies = ["left", "planet2"], ratio = -0.5 }
g4 = { kind = "gear", bodies = ["right", "planet2"], ratio = 0.5 }
roadL = { kind = "equation", gap = "s - R*(c + l)" }
roadR = { kind = "equation", gap = "s - R*(c + r)" }
[outputs]
a = "s''"
"""

PARALLELOGRAM = """
eomgen = 1
name = "Parallelogram in line"
space = "plane"
[parameters]
m = 1
L = 1
d = 2
g = 9.81
[coordinates]
a = { start = 0, speed = 2 }
b = {}
c = {}
[bodies.left]
shape = { kind = "rod", mass = "m", length = "L" }
joint = { kind = "revolute", angle = "a" }
[bodies.coupler]
shape = { kind = "rod", mass = "m", length = "d" }
joint = { kind = "revolute", on = "left.end", angle = "b - a" }
[bodies.right]
shape = { kind = "rod", mass = "5*m", length = "L" }
joint = { kind = "revolute", at = ["d", 0], angle = "c" }
[constraints.P]
kind = "pin"
points = ["coupler.end", "right.end"]
[forces.weight]
kind = "gravity"
acceleration = [0, "-g"]
"""

PEAUCELLIER = (
    """
eomgen = 1
name = "Peaucellier's inversor"
space = "plane"
[parameters]
m = 1
L = 0.9
b = 0.4
c = 0.35
g = 9.81
[coordinates]
phi = { start = 0.3, speed = 1 }
al = { near = 0.7 }
be = { near = -0.3 }
ga = { near = 1.3 }
de = { near = -1.2 }
q1 = { near = -0.4 }
q2 = { near = 0.8 }
"""
    + "".join(
        f"""
[bodies.{name}]
shape = {{ kind = "rod", mass = "m", length = "{length}" }}
joint = {{ kind = "revolute", {place}, angle = "{angle}" }}
"""
        for name, length, place, angle in (
            ("crank", "c", 'at = ["c", 0]', "phi"),
            ("up", "L", "at = [0, 0]", "al"),
            ("down", "L", "at = [0, 0]", "be"),
            ("p1", "b", 'on = "crank.end"', "ga - phi"),
            ("p2", "b", 'on = "crank.end"', "de - phi"),
            ("q1", "b", 'on = "up.end"', "q1 - al"),
            ("q2", "b", 'on = "down.end"', "q2 - be"),
        )
    )
    + """
[constraints]
A = { kind = "pin", points = ["up.end", "p1.end"] }
B = { kind = "pin", points = ["down.end", "p2.end"] }
C = { kind = "pin", points = ["q1.end", "q2.end"] }
[forces.weight]
kind = "gravity"
acceleration = [0, "-g"]
[outputs]
x = "x(q1.end)"
v = "vx(q1.end)"
a = "ax(q1.end)"
"""
)


@dataclass(frozen=True)
class Piece:
    """A rigid body of a plane machine: where its mass centre is and how it is turned at q."""

    mass: float
    inertia: float
    place: Callable[[Any], tuple[Any, Any]]
    turn: Callable[[Any], Any] = lambda q: 0 * q


def rod(mass: float, length: float, start: Callable, turn: Callable) -> Piece:
    """A uniform rod that starts at a place."""

    def middle(q: Any) -> tuple[Any, Any]:
        return start(q)[0] + length / 2 * mp.cos(turn(q)), start(q)[1] + length / 2 * mp.sin(turn(q))

    return Piece(mass, mass * length**2 / 12, middle, turn)


def origin(q: Any) -> tuple[Any, Any]:
    return 0 * q, 0 * q


def acceleration(pieces: list[Piece], q: float, u: float, force: Callable = lambda q, u: 0) -> float:
    """q'' of I q'' + I'/2 q'^2 = Q - sum m g y', with I = sum m (x'^2 + y'^2) + J theta'^2 (Eksergian)."""
    with mp.workdps(40):
        q = mp.mpf(q)

        def slope(piece: Piece, at: Any) -> tuple[Any, Any, Any]:
            return (
                mp.diff(lambda s: piece.place(s)[0], at),
                mp.diff(lambda s: piece.place(s)[1], at),
                mp.diff(piece.turn, at),
            )

        def inertia(at: Any) -> Any:
            slopes = [(piece, *slope(piece, at)) for piece in pieces]
            return sum(piece.mass * (x**2 + y**2) + piece.inertia * w**2 for piece, x, y, w in slopes)

        Q = force(q, u) - sum(9.81 * piece.mass * slope(piece, q)[1] for piece in pieces)
        return float((Q - mp.diff(inertia, q) * u**2 / 2) / inertia(q))


def slider_crank(m: float = 1.5, r: float = 0.2, length: float = 0.6) -> list[Piece]:
    def slider(q: Any) -> tuple[Any, Any]:
        return r * mp.cos(q) + mp.sqrt(length**2 - (r * mp.sin(q)) ** 2), 0 * q

    crank = rod(m, r, origin, lambda q: q)
    coupler = rod(2 * m, length, lambda q: (r * mp.cos(q), r * mp.sin(q)), lambda q: -mp.asin(r * mp.sin(q) / length))
    return [crank, coupler, Piece(m, 0, slider)]


def umbrella(m: float = 0.2, L: float = 0.5, length: float = 0.25) -> list[Piece]:
    def angle(s: Any) -> Any:
        return mp.asin(s / (2 * length))

    rib, strut = rod(3 * m, L, origin, lambda s: -angle(s)), rod(3 * m, length, lambda s: (0 * s, -s), angle)
    return [Piece(m, 0, lambda s: (0 * s, -s)), rib, strut]


def geared(m: float = 1, a: float = 0.3, b: float = 0.8, d: float = 0.7, J: float = 0.05) -> list[Piece]:
    def left(q: Any) -> tuple[Any, Any]:
        return a * mp.cos(q), a * mp.sin(q)

    def other(q: Any) -> Any:
        return 2 - (q - mp.mpf("1.2")) / 2

    def right(q: Any) -> tuple[Any, Any]:
        return d + a * mp.cos(other(q)), a * mp.sin(other(q))

    def towards(end: Callable) -> Callable:
        return lambda q: mp.atan2(top(q)[1] - end(q)[1], top(q)[0] - end(q)[0])

    def top(q: Any) -> tuple[Any, Any]:
        (x1, y1), (x2, y2) = left(q), right(q)
        dx, dy = x2 - x1, y2 - y1
        h = mp.sqrt(b**2 / (dx**2 + dy**2) - mp.mpf(1) / 4)
        return (x1 + x2) / 2 - h * dy, (y1 + y2) / 2 + h * dx

    wheels = [Piece(0, J, origin, lambda q: q), Piece(0, J, origin, other)]
    return [*wheels, rod(m, b, left, towards(left)), rod(m, b, right, towards(right))]


MACHINES = {
    "slider-crank": (CRANK, lambda: acceleration(slider_crank(), 0.7, 6)),
    "umbrella": (UMBRELLA, lambda: acceleration(umbrella(), 0.35, 0.4, lambda s, u: -60 * (s - mp.mpf("0.2")) - 2 * u)),
    "geared five-bar": (GEARED, lambda: acceleration(geared(), 1.2, 3)),
    "vice": (VICE, lambda: 0.4 / (0.003 + 2 * 0.005**2)),
    "differential": (DIFFERENTIAL, lambda: 50 * 0.3 / (504.2 * 0.3**2 + 3 * 0.1 + 2 * 0.02)),
}


@pytest.mark.parametrize("name", MACHINES)
def test_a_machine_of_one_freedom_accelerates_as_its_reduced_mass_says(name):
    """I(q) q'' + I'(q)/2 q'^2 = Q; the loops are closed from rough starts, with redundant rows."""
    text, truth = MACHINES[name]
    equations = eomgen.derive(eomgen.loads(text))
    rhs, x = equations.rhs("numpy"), equations.start()
    own = equations.coordinates.index("s" if name in ("umbrella", "differential") else equations.coordinates[0])
    assert rhs(0.0, x, rhs.p0)[len(equations.coordinates) + own] == pytest.approx(truth(), rel=1e-9)


@pytest.mark.parametrize("name", MACHINES)
def test_derivations_of_closed_machines_are_proved(name):
    assert eomgen.derive(eomgen.loads(MACHINES[name][0])).certify().ok


def test_a_differential_has_its_formula():
    """a = R T/((M + m) R^2 + 3 J + 2 Jp): constant rows leave a short formula, though they are redundant."""
    found = eomgen.solve(eomgen.loads(DIFFERENTIAL))["a"].exact
    assert found == "5*R*T/(15*J + 10*Jp + (21 + 5*M)*R^2)"  # m = 4.2


@pytest.mark.parametrize(("name", "body"), [("slider-crank", "crank"), ("geared five-bar", "c1"), ("vice", "spindle")])
def test_the_torque_that_a_loop_with_redundant_rows_takes(name, body):
    """Forward with a torque, and back: tau of these accelerations is that torque."""
    torque = 0.4 if name == "vice" else 1.7
    head, rest = MACHINES[name][0].replace(', torque = "T"', "").split(f"[bodies.{body}]")
    driven = rest.replace('kind = "revolute"', f'kind = "revolute", torque = {torque}', 1)
    pushed, left = (eomgen.derive(eomgen.loads(f"{head}[bodies.{body}]{each}")) for each in (driven, rest))
    rhs, x = pushed.rhs("numpy"), pushed.start()
    a = rhs(0.0, x, rhs.p0)[len(pushed.coordinates) :]
    inverse = left.inverse_dynamics((body,)).function("numpy")
    assert inverse(0.0, x, a, rhs.p0)[0] == pytest.approx(torque, rel=1e-9)


# -- where loops are put together -----------------------------------------------------------------------


def test_peaucelliers_inversor_draws_a_straight_line():
    """|OP| |OC| = L^2 - b^2, so that C stays on x = (L^2 - b^2)/(2 c); the branch nearest the guesses."""
    found = eomgen.solve(eomgen.loads(PEAUCELLIER))
    assert found["x"].value == pytest.approx((0.9**2 - 0.4**2) / 0.7, rel=1e-12)
    assert found["v"].value == pytest.approx(0, abs=1e-12)
    assert found["a"].value == pytest.approx(0, abs=1e-9)


def test_a_linkage_that_reaches_only_to_its_folded_place_does_not_start_there():
    """With L - b > |OP| the loops cannot close; where all bars lie in line they meet to second order alone."""
    model = eomgen.loads(PEAUCELLIER.replace("L = 0.9", "L = 1").replace("c = 0.35", "c = 0.3"))
    with pytest.raises(EomgenError, match="does not close at the start"):
        Start.of(System.of(model))


def test_check_says_that_a_start_does_not_close(run_verb, tmp_path):
    text = PEAUCELLIER.replace("L = 0.9", "L = 1").replace("c = 0.35", "c = 0.3")
    out, payload = run_verb(tmp_path, text, "check")
    assert "start: 'C' (row 2) does not close at the start" in out
    assert "does not close" in payload["start_refused"]


def test_hinges_and_welds_do_not_close_turned_over():
    """n_1 . n_2 = -1 satisfies the rows of a hinge too, and is another machine."""
    system = System.of(eomgen.loads(VICE))
    found = Branches.of(system, Start.of(system).values)
    turns = [(each.values["ps"] + 0.3) / math.tau for each in (found.here, *found.others)]
    assert turns[0] == pytest.approx(0)
    assert all(turn == pytest.approx(round(turn), abs=1e-9) for turn in turns)


# -- starts in change points ----------------------------------------------------------------------------


def with_start(**lines: str) -> str:
    text = PARALLELOGRAM
    for name, line in lines.items():
        text = "\n".join(f"{name} = {line}" if old.startswith(f"{name} = ") else old for old in text.split("\n"))
    return text


def test_speeds_in_a_change_point_are_completed_along_a_branch():
    """J u = 0 leaves two speeds free there; a branch leads on only where n^T gamma(u) = 0: here c' = a', b' = 0."""
    found = Start.of(System.of(eomgen.loads(PARALLELOGRAM)))
    assert found.fork is not None
    assert found.values["c'"] == pytest.approx(2)
    assert found.values["b'"] == pytest.approx(0, abs=1e-9)


def test_from_a_change_point_a_parallelogram_moves_on_as_one():
    """a'' = -g cos a (1/2 + 1 + 5/2)/(1/3 + 1 + 5/3): three bars of masses 1, 1, 5."""
    run = eomgen.simulate(eomgen.loads(PARALLELOGRAM), time=1.0)
    truth = solve_ivp(lambda t, y: [y[1], -9.81 * math.cos(y[0]) * 4 / 3], (0, 1), [0, 2], rtol=1e-11, atol=1e-12)
    assert run.ok, run.message
    assert run["a"][-1] == pytest.approx(truth.y[0, -1], abs=1e-7)
    assert run["c"][-1] == pytest.approx(run["a"][-1], abs=1e-8)


def test_at_rest_in_a_change_point_nothing_says_which_way_it_goes():
    with pytest.raises(EomgenError, match="at rest in a change point"):
        eomgen.simulate(eomgen.loads(with_start(a="0", b="0", c="0")), time=1.0)


def test_at_rest_in_a_change_point_without_forces_it_stays():
    text = with_start(a="0", b="0", c="0").replace("g = 9.81", "g = 0")
    run = eomgen.simulate(eomgen.loads(text), time=1.0)
    assert run.ok
    assert np.all(run.x == 0)


# -- accelerations and multipliers at the start ---------------------------------------------------------


def test_simulate_tells_accelerations_and_multipliers_at_the_start(run_verb, tmp_path):
    """The pin's forces by Newton's law of the slider alone: m s'' along x; couples that are shared have no value."""
    _, payload = run_verb(tmp_path, CRANK, "simulate", "--time", "0.01")
    a, lam = payload["start_accelerations"], payload["start_multipliers"]
    assert a["phi''"] == pytest.approx(acceleration(slider_crank(), 0.7, 6), rel=1e-9)
    assert lam["lam(wrist, 1)"] == pytest.approx(-1.5 * a["s''"], rel=1e-9)
    assert run_verb(tmp_path, PARALLELOGRAM, "simulate", "--time", "0.01")[1]["start_multipliers"]["lam(P, 2)"] is None


@pytest.fixture
def run_verb(capsys):
    """Text and payload of a command on a model's text."""
    from eomgen.cli import main

    def run(folder, text, verb, *options):
        path = folder / "model.toml"
        path.write_text(text)
        found = []
        for form in ((), ("--json",)):
            with pytest.raises(SystemExit):
                main([verb, str(path), *options, *form])
            found.append(capsys.readouterr().out)
        return found[0], json.loads(found[1])

    return run


SARRUS = """
eomgen = 1
name = "Sarrus linkage: a plate on two folding pairs of rods, in planes across each other"
space = "space"
coordinates = { a = "pi/3", b = "2*pi/3", c = "-2*pi/3", d = "pi/3", e = "2*pi/3" }
[bodies.A1]
shape = { kind = "rod", mass = 1, length = 1 }
joint = { kind = "revolute", at = [1, 0, 0], axis = [0, -1, 0], angle = "a" }
[bodies.A2]
shape = { kind = "rod", mass = 1, length = 1 }
joint = { kind = "revolute", on = "A1.end", axis = [0, -1, 0], angle = "b - a" }
[bodies.plate]
shape = { kind = "box", mass = 2, size = [1, 1, 0.1] }
points = { P1 = [1, 0, 0], P2 = [0, 1, 0] }
joint = { kind = "revolute", on = "A2.end", point = "P1", axis = [0, -1, 0], angle = "c" }
[bodies.B1]
shape = { kind = "rod", mass = 1, length = 1 }
joint.kind = "revolute"
joint.at = [0, 1, 0]
joint.turned = { axis = [0, 0, 1], angle = "pi/2" }
joint.axis = [0, -1, 0]
joint.angle = "d"
[bodies.B2]
shape = { kind = "rod", mass = 1, length = 1 }
joint = { kind = "revolute", on = "B1.end", axis = [0, -1, 0], angle = "e - d" }
[constraints]
last = { kind = "pin", points = ["B2.end", "plate.P2"], axis = [1, 0, 0] }
[forces]
weight = { kind = "gravity", acceleration = [0, 0, -9.81] }
[outputs]
v = { value = "vz(plate.center)", at = "a = 0" }
later = { value = "a'", at = "a = -0.3" }
"""


@in_slow_run
def test_an_answer_in_a_change_point_is_that_of_the_branch_which_the_motion_is_on():
    """Folded flat, a pair could spin with the plate at rest. z = 2 sin(a), V = 8 g sin(a).

    T = (4 cos^2 a + 1/3 + 1/12 + (9 cos^2 a + sin^2 a)/4) a'^2: plate, two pairs of rods.
    """

    def rate(a: float) -> float:
        share = 4 * np.cos(a) ** 2 + 5 / 12 + (9 * np.cos(a) ** 2 + np.sin(a) ** 2) / 4
        return -np.sqrt(8 * 9.81 * (np.sin(np.pi / 3) - np.sin(a)) / share)

    found = eomgen.solve(eomgen.loads(SARRUS.replace('later = { value = "a\'", at = "a = -0.3" }', "")))
    assert found["v"].value == pytest.approx(2 * rate(0), rel=1e-7)
    nears = zip("bcde", (2.1, -2.1, 1, 2.1), strict=True)
    listed = ", ".join(f"{name} = {{ dependent = true, near = {near} }}" for name, near in nears)
    dependent = SARRUS.replace('b = "2*pi/3", c = "-2*pi/3", d = "pi/3", e = "2*pi/3"', listed)
    found = eomgen.solve(eomgen.loads(dependent))
    assert found["v"].value is None and "does not determine 'b', 'c', 'd', 'e' at that instant" in found["v"].message
    assert found["later"].value == pytest.approx(rate(-0.3), rel=1e-7)


OBLIQUE = """
eomgen = 1
name = "Four-bar in an oblique plane"
space = "space"
[coordinates]
a = { start = 1, speed = 4 }
b = 0.48
c = 1.57
[bodies.base]
joint = { kind = "fixed", turned = [{ axis = [1, 2, 3], angle = 0.7 }, { axis = [0, 1, 0], angle = 0.4 }], angle = 0 }
points = { C = [1.1, 0, 0] }
[bodies.crank]
shape = { kind = "rod", mass = 1, length = 0.4 }
joint = { kind = "revolute", on = "base", angle = "a" }
[bodies.coupler]
shape = { kind = "rod", mass = 2, length = 1 }
joint = { kind = "revolute", on = "crank.end", angle = "b - a" }
[bodies.rocker]
shape = { kind = "rod", mass = 1, length = 0.8 }
joint = { kind = "revolute", on = "base.C", angle = "c" }
[constraints.B]
kind = "pin"
points = ["coupler.end", "rocker.end"]
axis = [0.667964062264835, 0.14846889357813756, 0.7292331582987319]
[forces.w]
kind = "gravity"
acceleration = [0, -9.81, 0]
"""


def test_a_hinge_whose_axis_is_written_in_decimals_moves_as_one_without():
    """The axis is the plane's normal to 16 digits: its rows close to rounding, and say nothing."""
    without = "\n".join(line for line in OBLIQUE.split("\n") if not line.startswith("axis = "))
    hinged, pinned = (eomgen.simulate(eomgen.loads(text), time=1.0, rtol=1e-10) for text in (OBLIQUE, without))
    assert hinged["a"][-1] == pytest.approx(pinned["a"][-1], rel=1e-7)
