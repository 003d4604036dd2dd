"""Laws of mechanisms at one configuration: velocities under constraints, centres of rotation, what is left open."""

from __future__ import annotations

import json
from fractions import Fraction
from itertools import combinations
from random import Random

import mpmath
import numpy as np
import pytest
from click.testing import CliRunner
from each import each
from float_linkages import ALL, HEAD, Linkage, four_bar, slider_crank

import eomgen
from eomgen.cli import main
from eomgen.mechanics.instant.kinematic_state import KinematicState
from eomgen.mechanics.instant.mechanism import Mechanism
from eomgen.study import kinematic_state

pytestmark = pytest.mark.slow

SEEDS = range(3)
BODIES = "[bodies.I]\npoints = { O = [0, 0], A = [0, 2] }\n"


def solved(text: str) -> dict[str, eomgen.Answer]:
    return eomgen.solve(eomgen.loads(text))


def worth(text: str) -> dict[str, float | None]:
    return {name: answer.value for name, answer in solved(text).items()}


def message(text: str, name: str = "w") -> str:
    answer = solved(text)[name]
    assert not answer.answered
    return answer.message or ""


def mechanism_in(text: str) -> tuple[KinematicState, Mechanism]:
    state = kinematic_state(eomgen.loads(text))
    assert state.mechanism is not None and state.mechanism.moved
    return state, state.mechanism


def given(w: object, e: object = 0) -> str:
    return f'[given]\nvelocity = "omega(I) = {w}"\nacceleration = "epsilon(I) = {e}"\n'


# -- velocities and accelerations ----------------------------------------------------------------------


@each("kind", ALL)
@each("seed", SEEDS)
def test_linkages_move_as_their_ties_allow(kind, seed):
    """J u = 0 and J a + gamma = 0 with the given rate, against the same equations written for floats."""
    rng = Random(seed)
    linkage: Linkage = kind(rng)
    points = [f"{body}.{point}" for body, own in linkage.bodies.items() for point in own]
    requested = {f"w_{b}": f"omega({b})" for b in linkage.bodies} | {f"e_{b}": f"epsilon({b})" for b in linkage.bodies}
    for k, point in enumerate(points):
        requested |= {f"{f}_{k}": f"{f}({point})" for f in ("vx", "vy", "ax", "ay")}
    outputs = "[outputs]\n" + "".join(f'{name} = "{value}"\n' for name, value in requested.items())
    w, e = 2.0, -0.75
    answers = solved(linkage.text(given("2", "-3/4") + outputs, rng))
    assert all(answer.exact is not None for answer in answers.values())
    motion, turning = linkage.velocities(w), linkage.accelerations(w, e)
    expected = {f"w_{b}": motion[b][2] for b in linkage.bodies} | {f"e_{b}": turning[b][2] for b in linkage.bodies}
    for k, point in enumerate(points):
        expected |= dict(zip((f"vx_{k}", f"vy_{k}"), linkage.velocity(motion, point), strict=True))
        expected |= dict(zip((f"ax_{k}", f"ay_{k}"), linkage.acceleration(w, e, point), strict=True))
    assert {n: a.value for n, a in answers.items()} == pytest.approx(expected, rel=1e-9, abs=1e-9)


def test_velocities_and_accelerations_are_the_differences_of_assembled_places():
    """Of a four-bar at crank angles -h, 0, h with 50 digits: v = (p_+ - p_-)/2h, a = (p_+ - 2p_0 + p_-)/h^2."""
    linkage = four_bar(Random(5))
    O, A, B, C = (
        (mpmath.mpf(x.numerator) / x.denominator, mpmath.mpf(y.numerator) / y.denominator)
        for x, y in (
            linkage.bodies["I"]["O"],
            linkage.bodies["I"]["A"],
            linkage.bodies["III"]["B"],
            linkage.bodies["III"]["C"],
        )
    )

    def end_at(turn):
        """B after the crank has turned, at its distances from A and C."""
        x, y = A[0] - O[0], A[1] - O[1]
        c, s = mpmath.cos(turn), mpmath.sin(turn)
        ax, ay = O[0] + c * x - s * y, O[1] + s * x + c * y
        square = [(B[0] - p[0]) ** 2 + (B[1] - p[1]) ** 2 for p in (A, C)]
        return mpmath.findroot(
            lambda x, y: [(x - ax) ** 2 + (y - ay) ** 2 - square[0], (x - C[0]) ** 2 + (y - C[1]) ** 2 - square[1]], B
        )

    with mpmath.workdps(50):
        h = mpmath.mpf(10) ** -12
        before, here, after = end_at(-h), end_at(mpmath.mpf(0)), end_at(h)
        v = [(after[k] - before[k]) / (2 * h) for k in range(2)]
        a = [(after[k] - 2 * here[k] + before[k]) / h**2 for k in range(2)]
    outputs = '[outputs]\nvx = "vx(II.B)"\nvy = "vy(III.B)"\nax = "ax(III.B)"\nay = "ay(II.B)"\n'
    found = worth(linkage.text(given(1) + outputs))
    assert [found[n] for n in ("vx", "vy", "ax", "ay")] == pytest.approx([float(x) for x in (*v, *a)], rel=1e-10)


# -- centres of rotation ---------------------------------------------------------------------------------


@each("kind", ALL)
@each("seed", SEEDS)
def test_at_a_relative_centre_both_bodies_have_one_velocity(kind, seed):
    """v_j - v_i = 0 at c_ij, in the velocities of the float linkage."""
    linkage: Linkage = kind(Random(seed))
    _, mechanism = mechanism_in(linkage.text(rng=Random(seed)))
    motion = {**linkage.velocities(1.0), "0": np.zeros(3)}
    for center in mechanism.centers.values():
        x, y, _ = map(float, mechanism.values.of(center.point))
        vx, vy, w = motion[center.pair[1]] - motion[center.pair[0]]
        assert not center.at_infinity
        assert (vx - w * y, vy + w * x) == pytest.approx((0, 0), abs=1e-9 * (1 + abs(w)) * (1 + abs(x) + abs(y)))


@each("kind", ALL)
@each("seed", SEEDS)
def test_three_bodies_have_their_centres_in_one_line(kind, seed):
    """det(c_ij, c_jk, c_ik) = 0, exactly (Aronhold, Kennedy)."""
    _, mechanism = mechanism_in(kind(Random(seed)).text())
    for i, j, k in combinations(mechanism.blocks, 3):
        a, b, c = (mechanism.centers[pair].point for pair in ((i, j), (j, k), (i, k)))
        assert mechanism.is_zero(
            [
                a[0] * (b[1] * c[2] - b[2] * c[1])
                - a[1] * (b[0] * c[2] - b[2] * c[0])
                + a[2] * (b[0] * c[1] - b[1] * c[0])
            ]
        )


@each("kind", ALL)
def test_the_drawing_finds_the_centres_of_the_velocities(kind):
    """Two lines meet where the velocities have their centre; linkages with a four-bar in them have all found so."""
    for seed in SEEDS:
        state, mechanism = mechanism_in(kind(Random(seed)).text())
        assert all(found.agrees for found in state.found.values())
        assert state.found.keys() == mechanism.centers.keys()


def parallelogram(more: str) -> str:
    corners = {"A": (0, 0), "B": (0, 3), "C": (4, 3), "D": (4, 0)}
    at = {name: (Fraction(x), Fraction(y)) for name, (x, y) in corners.items()}
    bodies = {name: {p: at[p] for p in points} for name, points in (("I", "AB"), ("II", "BC"), ("III", "CD"))}
    return Linkage(bodies, [("I.B", "II.B"), ("II.C", "III.C")], ["I.A", "III.D"]).text(more)


def test_a_parallelogram_has_centres_at_infinity():
    """The coupler translates along x: its centre is at infinity along y; the cranks' relative centre along x."""
    state, mechanism = mechanism_in(parallelogram(""))
    assert mechanism.centers["0", "II"].point == (0, 1, 0)
    assert mechanism.centers["I", "III"].point == (1, 0, 0)
    assert {("0", "II"), ("I", "III")} <= state.found.keys()
    found = solved(parallelogram('[outputs]\nw = "rotation_center_x(II)"\nr = "omega(III)/omega(I)"\n'))
    assert "translates along x" in (found["w"].message or "") and "at infinity" in (found["w"].message or "")
    assert found["r"].exact == "1"


def test_a_slider_crank_at_its_dead_centre():
    """Crank and rod in line: the slider stands still, the rod turns about its own end."""
    text = HEAD + (
        "[bodies.I]\npoints = { O = [0, 0], A = [2, 0] }\n[bodies.II]\npoints = { A = [2, 0], B = [7, 0] }\n"
        '[bodies.III]\npoints = { B = [7, 0], C = [8, 0] }\n[constraints]\nO = { kind = "pin", points = ["I.O"] }\n'
        'A = { kind = "pin", points = ["I.A", "II.A"] }\nB = { kind = "pin", points = ["II.B", "III.B"] }\n'
        'G = { kind = "guide", point = "III.B", along = [1, 0] }\n[given]\nvelocity = "omega(I) = 3"\n'
        'acceleration = "epsilon(I) = 0"\n'
    )
    _, mechanism = mechanism_in(text)
    assert mechanism.blocks["0"] == ("III",)
    assert mechanism.centers["0", "II"].point == (7, 0, 1)
    found = worth(text + '[outputs]\nv = "vx(III.B)"\nw = "omega(II)"\na = "ax(III.B)"\n')
    assert found == {"v": 0, "w": pytest.approx(-1.2), "a": pytest.approx(-18 - 5 * 1.2**2)}
    assert "At rest: III" in eomgen.kinematics(eomgen.loads(text)).render()


def test_bodies_that_move_as_one_are_one_block():
    """A bar welded to the crank by a clamp turns with it; a tripod of constraints holds a third body still."""
    text = (
        HEAD
        + BODIES
        + (
            "[bodies.II]\npoints = { A = [0, 2], B = [3, 2] }\n[bodies.III]\npoints = { C = [5, 0], D = [6, 1] }\n"
            '[constraints]\nO = { kind = "pin", points = ["I.O"] }\nW = { kind = "clamp", points = ["I.A", "II.A"] }\n'
            'C = { kind = "clamp", point = "III.C" }\n'
        )
    )
    _, mechanism = mechanism_in(text)
    assert mechanism.blocks == {"0": ("III",), "I": ("I", "II")}


def test_symbols_stay_symbols():
    """The coupler of a four-bar with cranks a, b on one line: omega_2 = omega (a - b)/..., exact in a, b, l."""
    text = HEAD + (
        "[parameters]\na = { positive = true }\nb = { positive = true }\nl = { positive = true }\nw = {}\n"
        '[bodies.I]\npoints = { O = [0, 0], A = [0, "a"] }\n[bodies.II]\npoints = { A = [0, "a"], B = ["l", "b"] }\n'
        '[bodies.III]\npoints = { B = ["l", "b"], C = ["l", 0] }\n'
        '[constraints]\nO = { kind = "pin", points = ["I.O"] }\n'
        'A = { kind = "pin", points = ["I.A", "II.A"] }\nB = { kind = "pin", points = ["II.B", "III.B"] }\n'
        'C = { kind = "pin", points = ["III.C"] }\n[given]\nvelocity = "omega(I) = w"\n'
        '[outputs]\nw3 = "omega(III)"\nw2 = "omega(II)"\nv = "speed(II.B)"\n'
    )
    found = solved(text)
    assert (found["w2"].exact, found["w3"].exact, found["v"].exact) == ("0", "a*w/b", "a*abs(w)")


# -- what is given ----------------------------------------------------------------------------------------

PLATE = HEAD + "[bodies.plate]\npoints = { A = [0, 0], B = [3, 0], C = [3, 2] }\n"


def test_a_field_is_recovered_from_partial_data_with_unknown_magnitudes():
    """Directions of the accelerations of two points, of one unknown size k: omega^2 l = k, epsilon l = k."""
    text = (
        HEAD + '[parameters]\nl = { positive = true }\nv = { positive = true }\n[unknowns]\nk = "the common size"\n'
        '[bodies.plate]\npoints = { A = [0, 0], B = ["l", 0], C = ["l", "l"] }\n[given]\n'
        'velocity = ["vx(plate.A) = v", "vy(plate.A) = 0", "vx(plate.C) = 0", "vy(plate.C) = v"]\n'
        'acceleration = ["ax(plate.B) = 0", "ay(plate.B) = k", "ax(plate.C) = -k", "ay(plate.C) = 0"]\n'
        '[outputs]\nw = "omega(plate)"\ne = "epsilon(plate)"\nk = "k"\n'
    )
    found = {name: answer.exact for name, answer in solved(text).items()}
    assert found == {"w": "v/l", "e": "v^2/l^2", "k": "v^2/l"}


@each("seed", SEEDS)
def test_a_field_in_space_is_recovered_from_three_points(seed):
    """v = v_O + omega x r and a = a_O + epsilon x r + omega x (omega x r) from six components each."""
    rng = np.random.default_rng(seed)
    v, w, a, e = rng.integers(-5, 6, (4, 3))
    place = {"A": np.zeros(3), "B": np.array([1, 0, 0]), "C": np.array([0, 2, 0]), "P": np.array([1, -1, 3])}
    velocity = {name: v + np.cross(w, r) for name, r in place.items()}
    acceleration = {name: a + np.cross(e, r) + np.cross(w, np.cross(w, r)) for name, r in place.items()}
    components = [("A", 0), ("A", 1), ("A", 2), ("B", 1), ("B", 2), ("C", 2)]
    lists = [
        ", ".join(f'"{letter}{"xyz"[k]}(body.{p}) = {table[p][k]}"' for p, k in components)
        for letter, table in (("v", velocity), ("a", acceleration))
    ]
    points = ", ".join(f"{name} = {r.astype(int).tolist()}" for name, r in place.items())
    text = (
        f'eomgen = 1\nspace = "space"\n[bodies.body]\npoints = {{ {points} }}\n'
        f"[given]\nvelocity = [{lists[0]}]\nacceleration = [{lists[1]}]\n[outputs]\n"
        + "".join(f'w{x} = "omega_{x}(body)"\ne{x} = "epsilon_{x}(body)"\na{x} = "a{x}(body.P)"\n' for x in "xyz")
    )
    found = worth(text)
    for k, x in enumerate("xyz"):
        expected = (w[k], e[k], acceleration["P"][k])
        assert (found[f"w{x}"], found[f"e{x}"], found[f"a{x}"]) == pytest.approx(expected)


def test_a_rod_between_two_balls_in_space_may_spin_and_its_ends_move_all_the_same():
    """The freedom of a rod about its own axis stays open; the velocity that it passes on does not depend on it."""
    text = (
        'eomgen = 1\nspace = "space"\n[bodies.crank]\npoints = { O = [0, 0, 0], A = [0, 2, 0] }\n'
        "[bodies.rod]\npoints = { A = [0, 2, 0], B = [6, 0, 3] }\n"
        '[constraints]\nO = { kind = "pin", points = ["crank.O"], axis = [0, 0, 1] }\n'
        'A = { kind = "pin", points = ["crank.A", "rod.A"] }\n'
        'Y = { kind = "support", point = "rod.B", normal = [0, 1, 0] }\n'
        'Z = { kind = "support", point = "rod.B", normal = [0, 0, 1] }\n'
        '[given]\nvelocity = "omega_z(crank) = 3"\n[outputs]\nv = "vx(rod.B)"\nw = "omega_x(rod)"\n'
    )
    found = solved(text)
    assert found["v"].exact == "-6"  # the parts of both velocities along the rod agree
    assert "2 degrees of freedom, 1 rate given" in (found["w"].message or "")


@each(
    "equations, words",
    [
        ('"vx(plate.A) = 1", "vx(plate.B) = 2"', "'vx(plate.B) = 2' contradicts 'vx(plate.A) = 1'"),
        ('"speed(plate.A) = 1"', "'speed(plate.A) = 1' is not linear in what it gives"),
        ('"ax(plate.A) = 1"', "'ax(plate.A) = 1' holds an acceleration"),
        ('"vx(plate.A) = 1"', "3 degrees of freedom, 1 rate given"),
    ],
)
def test_what_is_given_too_much_too_little_or_wrongly_is_named(equations, words):
    assert words in message(PLATE + f'[given]\nvelocity = [{equations}]\n[outputs]\nw = "omega(plate)"\n')


def test_a_given_velocity_that_the_ties_forbid_names_them():
    text = (
        HEAD
        + BODIES
        + (
            '[constraints]\nO = { kind = "pin", points = ["I.O"] }\n'
            '[given]\nvelocity = "vy(I.A) = 1"\n[outputs]\nw = "omega(I)"\n'
        )
    )
    assert "'vy(I.A) = 1' contradicts the constraint 'O'" in message(text)


def test_points_that_do_not_meet_are_an_error():
    text = (
        HEAD
        + BODIES
        + (
            "[bodies.II]\npoints = { A = [0, 3], B = [5, 0] }\n"
            '[constraints]\nA = { kind = "pin", points = ["I.A", "II.A"] }\n'
            '[outputs]\nw = "omega(I)/omega(II)"\n'
        )
    )
    assert "'A' does not close at the start: it is open by" in message(text)


# -- the verb ---------------------------------------------------------------------------------------------


def run(path, text: str, *words: str):
    path.write_text(text)
    return CliRunner().invoke(main, ["kinematics", str(path), *words])


def test_one_freedom_needs_no_rate_and_two_need_one_each(tmp_path):
    """Everything by one symbol; of five bars in a ring the verb says what to give."""
    file = tmp_path / "model.toml"
    result = run(file, four_bar(Random(1)).text())
    assert result.exit_code == 0 and "All velocities are expressed by one: omega_I = omega(I)." in result.stdout
    O, A, B, C, D = ((Fraction(x), Fraction(y)) for x, y in ((0, 0), (1, 3), (4, 5), (7, 3), (8, 0)))
    bodies = {"I": {"O": O, "A": A}, "II": {"A": A, "B": B}, "III": {"B": B, "C": C}, "IV": {"C": C, "D": D}}
    hinges = [("I.A", "II.A"), ("II.B", "III.B"), ("III.C", "IV.C")]
    ring = Linkage(bodies, hinges, ["I.O", "IV.D"]).text()
    result = run(file, ring, "--given", "omega(I) = 1", "--json")
    assert result.exit_code == 0
    assert json.loads(result.stdout)["rate"]["of"] == "omega(II)"
    result = run(file, ring)
    assert result.exit_code == 3 and "2 degrees of freedom, 0 rates given" in result.stderr
    result = run(file, ring, "--given", "omega(I) = 1", "--given", "omega(IV) = -1")
    assert result.exit_code == 0 and "Given: omega(I) = 1, omega(IV) = -1." in result.stdout


def test_a_structure_is_no_mechanism(tmp_path):
    text = HEAD + BODIES + '[constraints]\nO = { kind = "clamp", point = "I.O" }\n'
    result = run(tmp_path / "model.toml", text)
    assert result.exit_code == 3
    assert "nothing can move" in result.stderr and "eomgen statics" in result.stderr


def test_the_verb_gives_centres_for_machines_and_a_picture(tmp_path):
    """c_02 = (9, 13.5), c_03 at infinity, omega_2 = 1.6 of crank, bar and sliding frame."""
    at = {"O": (0, 0), "A": (4, 6), "B": (9, 6), "D": (11, 0), "E": (14, 0)}
    place = {name: (Fraction(x), Fraction(y)) for name, (x, y) in at.items()}
    bodies = {name: {p: place[p] for p in points} for name, points in (("I", "OA"), ("II", "AB"), ("III", "BDE"))}
    up = (Fraction(0), Fraction(1))
    hinges, rollers = [("I.A", "II.A"), ("II.B", "III.B")], [("III.D", up), ("III.E", up)]
    text = Linkage(bodies, hinges, ["I.O"], rollers).text(given(-2))
    picture = tmp_path / "mechanism.svg"
    result = run(tmp_path / "model.toml", text, "--json", "--plot", str(picture))
    assert result.exit_code == 0
    found = json.loads(result.stdout)
    centers = {tuple(center["bodies"]): center for center in found["centers"]}
    assert [x["exact"] for x in centers["0", "II"]["place"]] == ["9", "27/2"]
    assert "(0, I) and (I, II)" in centers["0", "II"]["found"]
    assert centers["0", "III"]["kind"] == "infinite" and centers["0", "III"]["place"] is None
    assert found["angular_velocities"]["II"] == {"exact": "8/5", "value": 1.6}
    assert found["velocities"]["I.A, II.A"]["magnitude"]["exact"] == "4*sqrt(13)"
    assert found["freedoms"]["by_rank"] == found["freedoms"]["by_formula"] == 1
    assert "v_y" in picture.read_text() or picture.stat().st_size > 10_000


@pytest.mark.parametrize("form", ["latex", "markdown"])
def test_the_verb_writes_every_format(tmp_path, form):
    result = run(tmp_path / "model.toml", slider_crank(Random(2)).text(), "--format", form)
    assert result.exit_code == 0 and "Centres of rotation" in result.stdout


def test_an_instant_of_a_motion_has_its_centres(tmp_path):
    """A wheel of radius r rolls with x = t^2: at t = 3 it turns about the contact, omega = -6/r, a = 2."""
    text = HEAD + (
        '[parameters]\nr = 0.5\n[coordinates]\nx = { motion = "t^2" }\n[bodies.wheel]\n'
        'shape = { kind = "disc", mass = 1, radius = "r" }\n'
        'joint = { kind = "planar", x = "x", y = "r", angle = "-x/r" }\n'
        '[constraints.floor]\nkind = "rolling"\nbody = "wheel"\nline = { at = [0, 0], normal = [0, 1] }\n'
    )
    found = eomgen.kinematics(eomgen.loads(text), at="t = 3").as_dict()
    (center,) = found["centers"]
    assert [x["exact"] for x in center["place"]] == ["9", "0"] and "'floor' holds the point" in center["found"]
    assert found["angular_velocities"]["wheel"]["exact"] == "-6/r"
    assert found["accelerations"]["wheel.center"]["x"]["exact"] == "2"
