"""What `statics` is asked and cannot give is said with the culprit; what it can, in whatever way it is asked."""

from __future__ import annotations

import pytest

import eomgen
from eomgen.errors import EomgenError

pytestmark = pytest.mark.slow

HEAD = 'eomgen = 1\nname = "structure"\nspace = "plane"\n'

BEAM = (
    HEAD
    + """
[parameters]
P = 10
[bodies.b]
points = { A = [0, 0], C = [2, 0], B = [4, 0] }
[constraints]
A = { kind = "pin", points = ["b.A"] }
B = { kind = "support", point = "b.B", normal = [0, 1] }
[forces.P]
kind = "force"
point = "b.C"
force = [1, "-P"]
"""
)
LEVER = (
    HEAD
    + """
[unknowns]
F = "what holds it"
[bodies.b]
points = { A = [0, 0], B = [4, 0] }
[constraints]
A = { kind = "pin", points = ["b.A"] }
[forces.F]
kind = "force"
point = "b.B"
force = LOAD
"""
)
TRUSS = (
    HEAD
    + """
[trusses.T]
nodes = { A = [0, 0], B = [2, 0], C = [1, 1] }
members = ["A-B", "A-C", "B-C"]
[constraints]
A = { kind = "pin", points = ["T.A"] }
B = { kind = "support", point = "T.B", normal = [0, 1] }
[forces.P]
kind = "force"
point = "T.C"
force = [0, -1]
"""
)
BARROW = (
    HEAD
    + """
[parameters]
W = 600
r = 0.2
[unknowns]
F = "at the handles"
[bodies.barrow]
points = { axle = [0, 0.2], G = [0.5, 0.5], handle = [1.5, 0.6] }
[bodies.wheel]
shape = { kind = "disc", radius = "r", mass = 0 }
joint = { kind = "placed", at = [0, "r"] }
[constraints]
axle = { kind = "pin", points = ["barrow.axle", "wheel.center"] }
ground = { kind = "rolling", body = "wheel", line = { at = [0, 0], normal = [0, 1] } }
stone = { kind = "support", point = "barrow.axle", normal = [1, 0] }
[forces]
W = { kind = "force", point = "barrow.G", force = [0, "-W"] }
F = { kind = "force", point = "barrow.handle", force = [0, "F"] }
"""
)
SPRUNG = (
    HEAD
    + """
[parameters]
R = 1
k = 15
[points]
top = [0, 1]
[coordinates]
theta = 0.5
[bodies.arm]
shape = { kind = "rod", length = "R", mass = 1 }
joint = { kind = "revolute", angle = "theta - pi/2" }
[forces]
g = { kind = "gravity", acceleration = [0, -9.81] }
s = { kind = "spring", points = ["arm.end", "top"], stiffness = "k", length = 1 }
"""
)

HOIST = (
    HEAD
    + """
[parameters]
W = 500
r = 0.2
[points]
wall = [0, "r"]
foot = [0, -1.5]
[bodies.beam]
points = { A = [0, 0], C = [1.5, 0], B = [3, 0] }
[bodies.pulley]
shape = { kind = "disc", mass = 0, radius = "r" }
joint = { kind = "placed", at = [3, 0] }
[bodies.load]
shape = { kind = "particle", mass = 0 }
joint = { kind = "placed", at = ["3 + r", -1] }
[constraints]
A = { kind = "pin", points = ["beam.A"] }
B = { kind = "pin", points = ["beam.B", "pulley.center"] }
strut = { kind = "link", points = ["beam.C", "foot"] }
[constraints.rope]
kind = "string"
path = ["wall", { body = "pulley", turn = "cw" }, "load.center"]
[forces]
W = { kind = "force", point = "load.center", force = [SIDE, "-W"] }
"""
)
FOUR_BAR = (
    HEAD
    + """
[bodies.a]
points = { A = [0, 0], B = [0, 1] }
[bodies.c]
points = { B = [0, 1], C = [1, 1] }
[bodies.d]
points = { C = [1, 1], D = [1, 0] }
[constraints]
A = { kind = "pin", points = ["a.A"] }
B = { kind = "pin", points = ["a.B", "c.B"] }
C = { kind = "pin", points = ["c.C", "d.C"] }
D = { kind = "pin", points = ["d.D"] }
[forces.down]
kind = "force"
point = "a.B"
force = [0, -3]
"""
)

SHORT = '[forces.q]\nkind = "distributed"\nbody = "b"\nbetween = ["A", "A"]\nintensity = [0, -1]\n'


@pytest.mark.parametrize(
    ("text", "requested", "reported"),
    [
        (BEAM, {"reaction": "nonsense"}, "there is no reaction 'nonsense'"),
        (BEAM, {"reaction": "nonsense"}, "there are reaction_x(A), reaction_y(A), reaction_n(B)"),
        (BEAM, {"reaction": ""}, "there is no reaction ''"),
        (BEAM, {"influence": "bending_moment(b)"}, "a body and a place along it are needed"),
        (BEAM + SHORT, {}, "'A' and 'A' are at one place: a load along a line needs a length"),
        (HEAD, {}, "the model has no body"),
        (LEVER.replace("LOAD", '[0, "F^2 - 3"]'), {}, "the loads on 'b' are not linear in the unknown 'F'"),
        (LEVER.replace("LOAD", '["cos(F)", "sin(F)"]'), {}, "the loads on 'b' are not linear in the unknown 'F'"),
        (TRUSS.replace('"T.C"', '"T.K"'), {}, "its nodes are A, B, C"),
        (BEAM.replace('["b.A"]', '["b.A", [0, 0]]'), {}, "give it a name in [points]"),
        (HOIST.replace("SIDE", "1"), {}, "body 'load' can slide along x"),
        (LEVER.replace("LOAD", '["F", "-3"]'), {}, "body 'b' can turn about (0, 0)"),
        (FOUR_BAR, {}, "body 'a' can turn about (0, 0)"),
        (
            FOUR_BAR + '[forces.s]\nkind = "spring"\npoints = ["a.B", "d.D"]\nstiffness = 1\nlength = 1\n',
            {},
            "a spring holds only what a coordinate moves",
        ),
        (BARROW.replace("[0, 0.2]", "[0, 0.3]"), {}, "cannot hold: no free coordinate moves it (it is 3/10 - r off)"),
    ],
)
def test_it_is_said_what_is_wrong(text, requested, reported):
    with pytest.raises(EomgenError) as error:
        eomgen.statics(eomgen.loads(text), **requested)
    assert reported in str(error.value)


def test_a_member_is_named_from_either_end():
    """tension(T, n1-n2) = tension(T, n2-n1), spaces or not."""
    for requested in ("tension(T, B-C)", "tension(T,C-B)", "tension(T, C, B)"):
        found = eomgen.statics(eomgen.loads(TRUSS), reaction=requested).found
        assert [r.name for r in found.reactions if r.work is not None] == ["tension(T, B-C)"]


def test_points_meet_that_do_so_at_the_models_values():
    """The axle at 0.2 and the wheel's centre at r with r = 0.2: F (1.5) = W (0.5)."""
    found = eomgen.statics(eomgen.loads(BARROW))
    assert found.ok and found.values["F"] == pytest.approx(200) and found.values["reaction_n(ground)"] == 400


def test_what_hangs_on_a_rope_hangs_still():
    """Nothing holds the load sideways, and nothing pushes it there: strut -2 sqrt(2) W; pushed it is refused."""
    found = eomgen.statics(eomgen.loads(HOIST.replace("SIDE", "0")))
    assert found.exact["tension(strut)"] == "-2*sqrt(2)*W" and found.exact["tension(rope, 2)"] == "W" and found.ok
    assert "Body 'load' can slide along x: nothing resists it, but no load does any work" in " ".join(
        found.render("text").split()
    )


def test_a_machine_rolls_freely_where_nothing_pushes_it():
    """The wheelbarrow without the stone: the hands still carry W/3."""
    text = "\n".join(line for line in BARROW.splitlines() if not line.startswith("stone"))
    found = eomgen.statics(eomgen.loads(text))
    assert found.exact["F"] == "1/3*W" and found.found.structure.mobility == 1 and found.ok


def test_an_indeterminate_structure_is_a_failure_that_names_what_stays_open():
    """A third support: A_x is still given, and the rest is said to be open."""
    found = eomgen.statics(eomgen.loads(BEAM + '[constraints.C]\nkind = "support"\npoint = "b.C"\nnormal = [0, 1]\n'))
    assert found.exact["reaction_x(A)"] == "-1"
    assert "to the degree 1" in found.failed
    assert "reaction_y(A), reaction_n(B), reaction_n(C) open" in found.failed
    assert eomgen.statics(eomgen.loads(BEAM)).failed == ""


def test_the_length_of_a_spring_has_a_name_in_the_equations_at_rest():
    """No symbol of our own making is printed: r1 = sqrt(...)."""
    text = eomgen.statics(eomgen.loads(SPRUNG)).render("text")
    assert "r1 = sqrt(" in text and "(root" not in text


LADDER = (
    HEAD
    + """
[parameters]
m = 10
mu = MU
L = 5
[bodies.ladder]
shape = { kind = "rod", mass = "m", length = "L" }
joint = { kind = "placed", at = [0, 0], angle = "atan2(4, 3)" }
[constraints]
floor = { kind = "support", point = "ladder.start", normal = [0, 1], friction = "mu", unilateral = true }
wall = { kind = "support", point = "ladder.end", normal = [-1, 0], unilateral = true }
[forces.g]
kind = "gravity"
acceleration = [0, -10]
[outputs]
wall = "reaction_n(wall)"
floor = "reaction_t(floor)"
"""
)


def test_outputs_of_a_structure_know_that_it_rests_on_friction_or_slides():
    """m g 3/8 at the wall while that is at most mu m g; below that, or where a contact would pull, no answer."""
    rests = eomgen.solve(eomgen.loads(LADDER.replace("MU", "0.5")))
    assert rests["wall"].value == pytest.approx(37.5) and rests["floor"].value == pytest.approx(37.5)
    slides = eomgen.solve(eomgen.loads(LADDER.replace("MU", "0.3")))["wall"]
    assert not slides.answered and "contact 'floor' slides" in slides.message
    pulls = 'B = { kind = "support", point = "b.B", normal = [0, -1], unilateral = true }'
    text = BEAM.replace('B = { kind = "support", point = "b.B", normal = [0, 1] }', pulls)
    held = eomgen.solve(eomgen.loads(text + '[outputs]\nB = "reaction_n(B)"\n'))["B"]
    assert not held.answered and "contact 'B' would have to pull" in held.message


BOOM = (
    HEAD
    + """
[parameters]
m = 50
g = 9.81
L = 4
[points]
K = [0, 3]
[coordinates]
theta = 0.5
[bodies.boom]
shape = { kind = "rod", mass = "m", length = "L" }
joint = { kind = "revolute", angle = "theta" }
[constraints.cable]
kind = "link"
points = ["boom.end", "K"]
[forces.g]
kind = "gravity"
acceleration = [0, "-g"]
[outputs]
x = "reaction_x(boom)"
cable = "tension(cable)"
"""
)


def test_what_the_ties_hold_has_no_rate():
    """A boom whose angle the cable holds: no theta' in its reactions, 3 X = L/2 cos(theta) m g."""
    found = eomgen.solve(eomgen.loads(BOOM))
    assert found["x"].exact == "1/6*m*g*L*cos(theta)"
    assert "theta'" not in found["cable"].exact
    values = eomgen.statics(eomgen.loads(BOOM)).values
    assert found["cable"].value == pytest.approx(values["tension(cable)"], rel=1e-12)


DRIVEN_ON_A_FLOOR = """
eomgen = 1
name = "driven on a floor"
space = "plane"
coordinates = { s = { motion = "0.4*sin(3*t)" }, h = { dependent = true, near = 0.1 } }
bodies.a.shape = { kind = "particle", mass = 2 }
bodies.a.joint = { kind = "planar", x = "s", y = "h", angle = 0 }
constraints.floor = { kind = "support", point = "a.center", at = [0, 0], normal = [0, 1], friction = 0.3 }
forces.weight = { kind = "gravity", acceleration = [0, -9.81] }
outputs = { D = "drive(s)" }
"""


def test_friction_under_what_is_all_driven_is_refused_at_rest_and_answered_where_it_slides():
    """mu m g moves it while s' > 0; at rest friction and drive share one force: the reason is named."""
    model = eomgen.loads(DRIVEN_ON_A_FLOOR)
    with pytest.raises(eomgen.EomgenError, match="'floor' cannot stick: a drive makes it slide"):
        eomgen.statics(model)
    found = eomgen.solve(model)
    assert found["D"].value == pytest.approx(0.3 * 2 * 9.81)
    assert found.certify().ok is not False


@pytest.mark.parametrize(("load", "value"), [("F(p)", 6), ("max(0, p - h)", 3), ("F(p)*max(0, p - h)", 18)])
def test_a_load_that_is_zero_only_at_these_values_keeps_its_formula(load, value):
    """Virtual work says A_y = P/2 of a law P in pieces, as equilibrium does, where P is 0 at the given values too."""
    text = BEAM.replace(
        "P = 10", 'p = 0\nh = 3\n[tables]\nF = { at = [2, 3, 4], values = [0, 5, 6], between = "linear" }'
    )
    text = text.replace("-P", f"-({load})")
    found = eomgen.statics(eomgen.loads(text))
    assert found.certify().ok and found.values["reaction_y(A)"] == 0
    other = eomgen.statics(eomgen.loads(text.replace("p = 0", "p = 4").replace("h = 3", "h = 1")))
    assert other.values["reaction_y(A)"] == value / 2 and other.exact == found.exact
