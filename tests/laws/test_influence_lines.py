"""An influence line is what the balance gives for a unit load at each place, found from the released mechanism."""

from __future__ import annotations

from fractions import Fraction
from random import Random

import pytest
from each import each

import eomgen
from eomgen.mechanics.dynamics.system import System
from eomgen.mechanics.free_bodies.structure import Structure
from eomgen.mechanics.statics.influence import InfluenceLine
from eomgen.symbolic.numeric.evaluation import FLOAT, evaluate
from eomgen.symbolic.print.text import to_text

pytestmark = pytest.mark.slow

HEAD = 'eomgen = 1\nname = "structure"\nspace = "plane"\n'

GERBER = (
    HEAD
    + """
[bodies.I]
points = { A = [0, 0], B = [4, 0], C = [10, 0] }
[bodies.II]
points = { C = [10, 0], D = [16, 0] }
[bodies.III]
points = { D = [16, 0], E = [20, 0] }
[constraints]
A = { kind = "support", point = "I.A", normal = [0, 1] }
B = { kind = "support", point = "I.B", normal = [0, 1] }
C = { kind = "pin", points = ["I.C", "II.C"] }
D = { kind = "pin", points = ["II.D", "III.D"] }
E = { kind = "clamp", point = "III.E" }
"""
)

FRAME = (
    HEAD
    + """
[bodies.I]
points = { A = [0, 0], K = [0, 4], C = [4, 5] }
[bodies.II]
points = { C = [4, 5], K = [10, 4], B = [11, 1] }
[constraints]
A = { kind = "pin", points = ["I.A"] }
B = { kind = "pin", points = ["II.B"] }
C = { kind = "pin", points = ["I.C", "II.C"] }
"""
)

TRUSS = (
    HEAD
    + """
[trusses.T]
nodes = { b0 = [0, 0], b1 = [3, 0], b2 = [6, 0], b3 = [9, 0], t1 = [3, 4], t2 = [6, 3] }
members = ["b0-b1", "b1-b2", "b2-b3", "t1-t2", "b0-t1", "b1-t1", "b1-t2", "b2-t2", "b3-t2"]
[constraints]
A = { kind = "pin", points = ["T.b0"] }
B = { kind = "support", point = "T.b3", normal = [0, 1] }
"""
)


def line(text: str, requested: str) -> InfluenceLine:
    return InfluenceLine.of(Structure.of(System.of(eomgen.loads(text))), requested)


def numbers(*scalars) -> list[float]:
    return [float(x) for x in evaluate(scalars, {}, FLOAT)]


def by_balance(text: str, requested: str, body: str, place: tuple[str, str]) -> float:
    """The same force, solved for a unit load at the place."""
    head, _, tail = text.partition(f"[bodies.{body}]\n")
    points, _, rest = tail.partition(" }\n")
    text = f'{head}[bodies.{body}]\n{points}, load = ["{place[0]}", "{place[1]}"] }}\n{rest}'
    text += f'[forces.unit]\nkind = "force"\nforce = [0, -1]\npoint = "{body}.load"\n[outputs]\no = "{requested}"\n'
    (answer,) = eomgen.solve(eomgen.loads(text)).values()
    assert answer.value is not None, answer.message
    return answer.value


GERBER_REQUESTED = [
    "reaction_n(A)",
    "reaction_n(B)",
    "reaction_y(E)",
    "reaction_couple(E)",
    "reaction_y(C)",
    "bending_moment(I, 2)",
    "shear_force(I, 2)",
    "bending_moment(I, 7)",
    "shear_force(I, 7)",
    "bending_moment(II, 2)",
    "shear_force(III, 1)",
    "bending_moment(III, 4)",
    "shear_force(I, 4, before)",
    "shear_force(I, 4, after)",
]
FRAME_REQUESTED = [
    "reaction_x(A)",
    "reaction_y(B)",
    "reaction_x(C)",
    "bending_moment(I, 4)",
    "shear_force(I, 1)",
    "axial_force(I, 1)",
    "axial_force(II, 3)",
    "bending_moment(II, 5)",
    "shear_force(II, 5)",
]


@each("text, requested", [*((GERBER, a) for a in GERBER_REQUESTED), *((FRAME, a) for a in FRAME_REQUESTED)])
def test_it_is_the_balance_with_a_unit_load_at_any_place(text, requested):
    """At a random place of every straight part, of the body that is cut on both sides of the section."""
    rng = Random(requested)
    for span in line(text, requested).spans:
        share = Fraction(rng.randint(1, 9), 10)
        x, y = (to_text(a + share * (b - a)) for a, b in zip(span.start[:2], span.end[:2], strict=True))
        (value,) = numbers(span.at_start + share * (span.at_end - span.at_start))
        assert value == pytest.approx(by_balance(text, requested, span.name, (x, y)), abs=1e-9), (span.name, x, y)


@each("member", ["b0-b1", "t1-t2", "b1-t2", "b2-t2", "t2-b1"])
def test_of_a_member_it_runs_from_node_to_node(member):
    """A unit load at each of the lowest nodes gives the vertices."""
    found = line(TRUSS, f"tension(T, {member})").spans
    assert [span.name for span in found] == ["T.b0-b1", "T.b1-b2", "T.b2-b3"]
    vertices = [found[0].at_start, *(span.at_end for span in found)]
    for node, value in zip(("b0", "b1", "b2", "b3"), numbers(*vertices), strict=True):
        text = TRUSS + f'[forces.unit]\nkind = "force"\nforce = [0, -1]\npoint = "T.{node}"\n'
        (answer,) = eomgen.solve(eomgen.loads(text + f'[outputs]\no = "tension(T, {member})"\n')).values()
        assert value == pytest.approx(answer.value, abs=1e-12)


def test_the_shear_force_jumps_by_one_at_its_section():
    """The two lines beside the section are parallel and 1 apart."""
    before, after = (span for span in line(GERBER, "shear_force(I, 3/2)").spans if span.name == "I")
    (v0, v1, w0, w1, x0, x, x1) = numbers(
        before.at_start, before.at_end, after.at_start, after.at_end, before.start[0], before.end[0], after.end[0]
    )
    assert w0 - v1 == pytest.approx(1) and (v1 - v0) / (x - x0) == pytest.approx((w1 - w0) / (x1 - x))


def test_the_vertices_are_exact():
    """A simple beam of span l, section at l/3: M = 2/9 l; the support beyond leaves it."""
    text = HEAD + '[parameters]\nl = { positive = true }\n[bodies.I]\npoints = { A = [0, 0], B = ["l", 0] }\n'
    text += '[constraints]\nA = { kind = "pin", points = ["I.A"] }\n'
    text += 'B = { kind = "support", point = "I.B", normal = [0, 1] }\n'
    spans = line(text, "bending_moment(I, l/3)").spans
    assert [(to_text(s.at_start), to_text(s.at_end)) for s in spans] == [("0", "2/9*l"), ("2/9*l", "0")]


def test_the_way_of_the_load_can_be_named():
    """After a colon: bodies or nodes, in the order in which the load passes them."""
    found = line(GERBER, "reaction_n(B): III, II")
    assert [span.name for span in found.spans] == ["III", "II"]
    found = line(TRUSS, "reaction_n(B): T.b0, T.t1, T.t2")
    assert [span.name for span in found.spans] == ["T.b0-t1", "T.t1-t2"]
    assert numbers(found.spans[-1].at_end) == pytest.approx([6 / 9])


WRONG = {
    "reaction_n(X)": (eomgen.UsageError, "there is no reaction"),
    "2*reaction_n(A)": (eomgen.UsageError, "is not one force"),
    "shear_force(I, 4)": (eomgen.UsageError, "jumps there"),
    "bending_moment(I, 11)": (eomgen.UsageError, "beyond the ends"),
    "bending_moment(IV, 1)": (eomgen.UsageError, "there is no body 'IV'"),
    "reaction_n(A): IV": (eomgen.UsageError, "no body or node 'IV'"),
}


@each("requested, error, reported", [(a, *rest) for a, rest in WRONG.items()])
def test_what_has_no_influence_line_is_said(requested, error, reported):
    """By name."""
    with pytest.raises(error, match=reported):
        line(GERBER, requested)


def test_an_indeterminate_reaction_has_none():
    """A third support on the first beam: released, nothing can move."""
    text = GERBER + 'M = { kind = "support", point = "I.C", normal = [0, 1] }\n'
    with pytest.raises(eomgen.DerivationError, match="nothing can move"):
        line(text, "reaction_n(A)")


BESIDE_UNKNOWNS = (
    HEAD
    + """
unknowns = { X = "holds it", F = "holds it too" }
bodies.I = { shape = { kind = "rod", mass = 4, length = 6 }, points = { Q = [2, 0] } }
constraints.A = { kind = "support", point = "I.start", normal = [1, 0] }
forces.couple = { kind = "couple", body = "I", couple = "2*X", point = "end" }
forces.force = { kind = "force", point = "I.Q", force = [0, "F"] }
"""
)


@each("x", [1, 3])
def test_unknown_loads_hold_a_beam_as_reactions_do(x):
    """F = 1, couple s - 2 of a unit load at s:  M(x) = couple - [s > x] (s - x) + [2 > x] (2 - x)"""
    found = eomgen.statics(eomgen.loads(BESIDE_UNKNOWNS), influence=f"bending_moment(I, {x})")
    assert found.certify().ok
    for span in found.influence.spans:
        for place, value in ((span.start, span.at_start), (span.end, span.at_end)):
            s, M = float(place[0]), float(value)
            after = s > x or (s == x and span.start[0] == x)
            assert M == pytest.approx((s - 2) - (s - x) * after + max(2 - x, 0))
