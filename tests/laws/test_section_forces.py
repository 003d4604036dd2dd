"""N, V and M along a body: dV/dx = q_n, dM/dx = V, jumps at forces and couples, ends free of what nothing holds.

N is tension, V turns the piece on which it acts clockwise, M stretches the right-hand fibre.
"""

from __future__ import annotations

from fractions import Fraction
from math import cos, pi, sin
from random import Random

import numpy as np
import pytest

import eomgen
from eomgen.mechanics.dynamics.system import System
from eomgen.mechanics.free_bodies.reactions import Reactions
from eomgen.mechanics.statics.forces_in_sections import SectionForces
from eomgen.symbolic.exact.solving import vanishes
from eomgen.symbolic.expression.derivatives import derivative, symbols_of
from eomgen.symbolic.numeric.evaluation import FLOAT, evaluate
from eomgen.symbolic.print.text import to_text

HEAD = 'eomgen = 1\nname = "beam"\nspace = "plane"\n'

OVERHANG = (
    HEAD
    + """
[parameters]
q = { positive = true }
F = { positive = true }
L = { positive = true }
c = { positive = true }
[bodies.beam]
points = { A = [0, 0], B = ["L", 0], D = ["L + c", 0] }
[constraints]
A = { kind = "pin", points = ["beam.A"] }
B = { kind = "support", point = "beam.B", normal = [0, 1] }
[forces]
grows = { kind = "distributed", body = "beam", between = ["A", "B"], intensities = [[0, 0], [0, "-q"]] }
tip = { kind = "force", point = "beam.D", force = [0, "-F"] }
"""
)


def along(text: str, body: str) -> SectionForces:
    return SectionForces.of(Reactions.of(System.of(eomgen.loads(text))), body)


def exact(text: str, *requested: str) -> list[str | None]:
    outputs = "[outputs]\n" + "".join(f'o{k} = "{each}"\n' for k, each in enumerate(requested))
    return [answer.exact for answer in eomgen.solve(eomgen.loads(text + outputs)).values()]


def test_the_moment_is_the_integral_of_the_shear_force_and_that_of_the_load():
    """dM/dx = V, dV/dx = q_n = -q x/L between the supports, 0 beyond; exact in q, F, L, c."""
    forces = along(OVERHANG, "beam")
    graph = forces.sizes.graph
    x = graph.symbol("x")
    q, L = graph.symbol("q"), graph.symbol("L")
    assert len(forces.pieces) == 2
    for piece, load in zip(forces.pieces, (-q * x / L, 0), strict=True):
        V, M = piece.value("shear_force", x), piece.value("bending_moment", x)
        assert vanishes(derivative(M, x) - V) and vanishes(derivative(V, x) - load)


def test_values_at_jumps_are_asked_by_their_side():
    """V jumps by the roller's force q L/3 + F + F c/L; M does not, and is -F c there."""
    before, after, moment, end = exact(
        OVERHANG,
        "shear_force(beam, L, before)",
        "shear_force(beam, L, after)",
        "bending_moment(beam, L)",
        "bending_moment(beam, L + c)",
    )
    assert (before, after, moment, end) == ("-(q*L^2 + 3*F*c)/(3*L)", "F", "-F*c", "0")
    (answer,) = eomgen.solve(eomgen.loads(OVERHANG + '[outputs]\nV = "shear_force(beam, L)"\n')).values()
    assert answer.exact is None and "jumps there from -1/3*q*L - F*c/L to F" in answer.message


def test_the_greatest_moment_lies_where_the_shear_force_vanishes():
    """A line load p on a span l: M = p l^2/8 in the middle."""
    text = HEAD + "[parameters]\np = {}\nl = { positive = true }\n"
    text += '[bodies.beam]\npoints = { A = [0, 0], B = ["l", 0] }\n'
    text += '[constraints]\nA = { kind = "pin", points = ["beam.A"] }\n'
    text += 'B = { kind = "support", point = "beam.B", normal = [0, 1] }\n[forces.p]\nkind = "distributed"\n'
    text += 'body = "beam"\nbetween = ["A", "B"]\nintensity = [0, "-p"]\n'
    (extreme,) = along(text, "beam").extremes
    assert (to_text(extreme.x), to_text(extreme.M)) == ("1/2*l", "1/8*p*l^2")


@pytest.mark.parametrize(("first", "last", "extremes"), [(0, 0, 0), (6, 6, 1), (0, 6, 1), (6, -6, 2)])
def test_a_line_load_may_be_constant_or_nothing_at_the_values_of_its_parameters(first, last, extremes):
    """V = R - q1 x - (q2 - q1) x^2/(2 L): of the second degree, of the first, or 0, as the values have it."""
    text = HEAD + f"[parameters]\nq1 = {first}\nq2 = {last}\n[bodies.b]\npoints = {{ A = [0, 0], B = [6, 0] }}\n"
    text += '[constraints]\nA = { kind = "pin", points = ["b.A"] }\n'
    text += 'B = { kind = "support", point = "b.B", normal = [0, 1] }\n[forces.q]\nkind = "distributed"\n'
    text += 'body = "b"\nbetween = ["A", "B"]\nintensities = [[0, "-q1"], [0, "-q2"]]\n'
    found = along(text, "b").extremes
    values = {x.name: x for e in found for x in symbols_of((e.x, e.M))}
    numbers = {values[name]: float(q) for name, q in (("q1", first), ("q2", last)) if name in values}
    assert len(found) == extremes
    for each in found:
        x, M = (float(v) for v in evaluate((each.x, each.M), numbers, FLOAT))
        R = first * 2 + last
        assert R - first * x - (last - first) * x**2 / 12 == pytest.approx(0, abs=1e-12) and 0 < x < 6
        assert M == pytest.approx(R * x - first * x**2 / 2 - (last - first) * x**3 / 36, rel=1e-12)


def test_a_falling_rod_bends_most_at_a_third_of_its_length():
    """Hinged at its lower end: V = 0 and M = m g l cos(theta)/27 at l/3, whatever the speed: there chimneys break."""
    text = HEAD + "[parameters]\nm = {}\ng = {}\nl = { positive = true }\n[coordinates]\ntheta = 1\n"
    text += '[bodies.rod]\nshape = { kind = "rod", mass = "m", length = "l" }\n'
    text += 'joint = { kind = "revolute", angle = "theta" }\n'
    text += '[forces.gravity]\nkind = "gravity"\nacceleration = [0, "-g"]\n'
    V, M, N, tip = exact(
        text, "shear_force(rod, l/3)", "bending_moment(rod, l/3)", "axial_force(rod, l/3)", "bending_moment(rod, l)"
    )
    assert (V, M, tip) == ("0", "1/27*m*g*l*cos(theta)", "0")
    assert N == "2/9*m*(2*l*theta'^2 - 3*g*sin(theta))"


# -- random beams against sums of all that acts before the section --------------------------------------------------


Loads = list[tuple[float, np.ndarray, float]]
Spreads = list[tuple[float, float, np.ndarray]]


def random_beam(rng: Random) -> tuple[str, Loads, Spreads]:
    """(model, (x, force, couple) of the loads, (from, to, force per length)): a cantilever, turned in the plane."""
    turn = Fraction(rng.randint(-6, 6), 5)
    stations = sorted(rng.sample(range(1, 12), 4))
    points = {"A": 0, **{f"P{k}": x for k, x in enumerate(stations)}}
    loads: Loads = []
    spreads: Spreads = []
    forces = []
    for name, x in list(points.items())[1:]:
        f, couple = (rng.randint(-5, 5), rng.randint(-5, 5)), rng.randint(-4, 4)
        loads.append((float(x), np.array(f, dtype=float), float(couple)))
        forces.append(f'f_{name} = {{ kind = "force", point = "beam.{name}", force = [{f[0]}, {f[1]}] }}')
        forces.append(f'c_{name} = {{ kind = "couple", body = "beam", couple = {couple}, point = "{name}" }}')
    q = (rng.randint(-3, 3), rng.randint(-3, 3))
    spreads.append((float(stations[0]), float(stations[2]), np.array(q, dtype=float)))
    forces.append(f'q = {{ kind = "distributed", body = "beam", between = ["P2", "P0"], intensity = {list(q)} }}')
    rng.shuffle(forces)
    places = ", ".join(f"{name} = [{x}, 0]" for name, x in points.items())
    text = HEAD + f'[bodies.beam]\npoints = {{ {places} }}\njoint = {{ kind = "fixed", angle = "{turn}" }}\n'
    return text + "[forces]\n" + "\n".join(forces) + "\n", loads, spreads


@pytest.mark.parametrize("seed", range(3))
def test_a_cantilever_carries_what_acts_beyond_the_section(seed):
    """N = F_t, V = -F_n, M = moment of all that acts beyond, about the section; t, n turn with the beam."""
    rng = Random(seed)
    text, loads, spreads = random_beam(rng)
    forces = along(text, "beam")
    turn = float(Fraction(text.partition('angle = "')[2].partition('"')[0]))
    t, n = np.array([cos(turn), sin(turn)]), np.array([-sin(turn), cos(turn)])
    for k in range(6):
        x = Fraction(rng.randint(1, int(10 * loads[-1][0]) - 1), 10) + Fraction(1, 17)
        beyond = [(s - float(x), f, c) for s, f, c in loads if s > x]
        for a, b, q in spreads:
            a = max(a, float(x))
            if b > a:
                beyond.append(((a + b) / 2 - float(x), (b - a) * q, 0.0))
        expected = [
            sum(f @ t for _, f, _ in beyond),
            -sum(f @ n for _, f, _ in beyond),
            sum(c + arm * (f @ n) for arm, f, c in beyond),
        ]
        found = [float(evaluate((forces.value(kind, x),), {}, FLOAT)[0]) for kind in SectionForces.KINDS]
        assert found == pytest.approx(expected, abs=1e-9), k


def test_a_bent_body_is_followed_around_its_corner():
    """An L of legs 2 and 3, clamped at its foot, F at its tip: N = -F, then 0; M = -3 F in the upright."""
    text = HEAD + "[parameters]\nF = {}\n[bodies.L]\npoints = { foot = [0, 0], corner = [0, 2], tip = [3, 2] }\n"
    text += '[constraints.foot]\nkind = "clamp"\npoint = "L.foot"\n'
    text += '[forces.F]\nkind = "force"\npoint = "L.tip"\nforce = [0, "-F"]\n'
    assert exact(
        text,
        "axial_force(L, 1)",
        "bending_moment(L, 1)",
        "axial_force(L, 3)",
        "bending_moment(L, 3)",
        "shear_force(L, 3)",
    ) == ["-F", "-3*F", "0", "-2*F", "F"]


def test_a_line_of_the_body_says_where_x_begins():
    """line = ["B", "A"]: x runs from B; what stands out behind B has x < 0."""
    text = OVERHANG.replace("[constraints]", 'line = ["B", "A"]\n[constraints]', 1)
    assert exact(text, "bending_moment(beam, 0)", "bending_moment(beam, -c)") == ["F*c", "0"]


WRONG = {
    "couple without a point": (
        "tip = {",
        'turn = { kind = "couple", body = "beam", couple = "F" }\ntip = {',
        "bending_moment(beam, L/2)",
        "the force 'turn' acts on 'beam' at no point",
    ),
    "off the line": (
        'D = ["L + c", 0] }',
        'D = ["L + c", 1] }\nline = ["A", "B"]',
        "bending_moment(beam, L/2)",
        "something acts on 'beam' at (L + c, 1), off the line",
    ),
    "beyond the end": (
        "F = { positive = true }",
        "F = { positive = true }",
        "bending_moment(beam, 2*L + 2*c)",
        "the body goes from x = 0 to L + c",
    ),
    "unsigned": ("L = { positive = true }", "L = {}", "bending_moment(beam, L/2)", "depends on L"),
}


@pytest.mark.parametrize(("old", "new", "requested", "reported"), WRONG.values(), ids=WRONG)
def test_what_cannot_be_said_is_not_said(old, new, requested, reported):
    """A message instead of a diagram of another beam."""
    text = OVERHANG.replace(old, new, 1) + f'[outputs]\no = "{requested}"\n'
    (answer,) = eomgen.solve(eomgen.loads(text)).values()
    assert answer.exact is None and reported in answer.message


def test_a_body_of_unknown_build_has_no_section_forces():
    """A mass at a centre says nothing of how it is spread: m g may be anywhere along the beam."""
    text = OVERHANG.replace("[bodies.beam]", "[bodies.beam]\nmass = 3\ncenter = [1, 0]\ninertia = 1")
    text += 'weight = { kind = "gravity", acceleration = [0, -9.81] }\n[outputs]\nM = "bending_moment(beam, L/2)"\n'
    (answer,) = eomgen.solve(eomgen.loads(text)).values()
    assert answer.exact is None and "how the mass of 'beam' is spread" in answer.message


def test_a_heavy_rod_on_two_supports_hangs_through_like_a_line_load():
    """M = m g l/8 in the middle, also of a rod that lies inclined: its weight across it is m g cos."""
    text = HEAD + "[parameters]\nm = {}\ng = {}\nl = { positive = true }\n[bodies.rod]\n"
    text += 'shape = { kind = "rod", mass = "m", length = "l" }\njoint = { kind = "fixed", angle = "pi/3" }\n'
    text += '[forces.gravity]\nkind = "gravity"\nacceleration = [0, "-g"]\n'
    root, middle, N = exact(text, "bending_moment(rod, 0)", "bending_moment(rod, l/2)", "axial_force(rod, 0)")
    assert (root, middle) == ("-1/4*m*g*l", "-1/16*m*g*l")  # -m g cos(pi/3) l/2, a quarter of that
    assert N == "-1/2*sqrt(3)*m*g" and sin(pi / 3) == pytest.approx(3**0.5 / 2)


RESTS_BY_AN_EYE = (
    HEAD
    + """
parameters = { P = 6, c = 1.5, L = 4 }
[bodies.wall]
points = { s0 = [0, 0], s3 = ["L", 0] }
line = ["s0", "s3"]
[bodies.slide]
points = { t = ["c", 0], e = ["c", 2], f = ["c + 2", 2] }
[constraints]
A = { kind = "clamp", points = ["wall.s0"] }
E = { kind = "slider", point = "slide.t", on = "wall" }
B = { kind = "pin", points = ["slide.f"] }
[forces]
load = { kind = "force", point = "slide.e", force = [0, "-P"] }
"""
)


def test_an_eye_pushes_its_rail_where_it_is():
    """V = P, M = P (x - c) before the eye at c, nothing behind it; not where the line of the rail begins."""
    system = System.of(eomgen.loads(RESTS_BY_AN_EYE))
    before, behind = SectionForces.of(Reactions.of(system), "wall").pieces
    values = {x: 6 if x.name == "P" else 1.5 if x.name == "c" else 4 for x in system.symbols.parameters.values()}
    reported = [
        [piece.value(kind, x) for kind in SectionForces.KINDS] for piece, x in ((before, Fraction(1, 2)), (behind, 3))
    ]
    assert evaluate(tuple(reported[0]), values, FLOAT) == pytest.approx([0, 6, 6 * (0.5 - 1.5)])
    assert evaluate(tuple(reported[1]), values, FLOAT) == pytest.approx([0, 0, 0])
