"""Degrees of freedom: by rank at a generic configuration, beside the count by formula; redundant constraints by
name."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import pytest

import eomgen
from eomgen.documents import rendered
from eomgen.mechanics.constraints.rank import Freedom
from eomgen.proof.degrees_of_freedom import counted_otherwise, lines_otherwise, standing_otherwise
from eomgen.results.declared import check_document
from eomgen.study.checked import Checked

HEAD = """
eomgen = 1
name = "linkage"
space = "plane"
[parameters]
l = 1.0
d = 2.0
m = 1.0
"""


def crank(name: str, at: str, q: str) -> str:
    """A rod of length l that turns about a point of the ground by the angle q."""
    return f"""
[bodies.{name}]
shape = {{ kind = "rod", mass = "m", length = "l" }}
joint = {{ kind = "revolute", at = {at}, point = "start", angle = "{q}" }}
"""


COUPLER = """
[bodies.coupler]
shape = { kind = "rod", mass = "m", length = "d" }
joint = { kind = "revolute", on = "left.end", point = "start", angle = "q2 - q1" }
"""
FOUR_BAR = crank("left", "[0, 0]", "q1") + COUPLER + crank("right", '["d", 0]', "q3")
HINGE = '[constraints.right_hinge]\nkind = "pin"\npoints = ["coupler.end", "right.end"]\n'
MIDDLE = crank("third", '["d/2", 0]', "q4") + (
    '[constraints.middle_hinge]\nkind = "pin"\npoints = ["coupler.center", "third.end"]\n'
)


def coordinates(**starts: float) -> str:
    return "[coordinates]\n" + "".join(f"{name} = {value}\n" for name, value in starts.items())


def freedom(text: str):
    return eomgen.freedom_of(eomgen.loads(HEAD + text))


def test_a_four_bar_linkage_has_one_degree_of_freedom():
    """f = nu - rank J = 3 - 2 = 1;  3*3 - 6 - 2 = 1"""
    found = freedom(coordinates(q1=1.0, q2=0.0, q3=1.0) + FOUR_BAR + HINGE)
    assert (found.by_rank, found.by_formula, found.redundant) == (1, 1, ())
    assert found.closing == ("right_hinge",)


def test_a_third_equal_crank_is_redundant_and_is_named():
    """A parallelogram with three cranks: 3*4 - 8 - 4 = 0 by the formula, and yet it moves: f = 4 - 3 = 1."""
    found = freedom(coordinates(q1=1.0, q2=0.0, q3=1.0, q4=1.0) + FOUR_BAR + HINGE + MIDDLE)
    assert (found.by_rank, found.by_formula) == (1, 0)
    assert [(row.constraint, row.others) for row in found.redundant] == [("middle_hinge", ("right_hinge",))]


@pytest.mark.parametrize("angle", [0.0, 1.5707963267948966])
def test_a_special_position_at_the_start_is_not_taken_for_a_redundant_tie(angle):
    """With all hinges in line J loses a rank there, and only there."""
    found = freedom(coordinates(q1=angle, q2=0.0, q3=angle) + FOUR_BAR + HINGE)
    assert (found.by_rank, found.redundant) == (1, ())


def test_the_same_support_twice_is_redundant_once():
    """Two equal rows have rank 1."""
    support = '[constraints.{}]\nkind = "support"\npoint = "left.end"\nnormal = [1, {}]\nat = ["l/2", 0]\n'
    text = coordinates(q1=1.0, q2=0.3) + crank("left", "[0, 0]", "q1") + COUPLER
    found = freedom(text + support.format("wall", 0) + support.format("again", 0))
    assert found.by_rank == 1
    assert [(row.constraint, row.number, row.others) for row in found.redundant] == [("again", 1, ("wall",))]


def test_a_tie_that_the_coordinates_satisfy_only_reacts():
    """The coupler stays level by its angle -q1, so its second hinge closes nothing: f = 1."""
    text = coordinates(q1=1.0) + FOUR_BAR.replace("q2 - q1", "-q1").replace("q3", "q1") + HINGE
    found = freedom(text)
    assert (found.by_rank, found.by_formula) == (1, 1)
    assert (found.identical, found.closing) == (("right_hinge",), ())


def test_a_driven_coordinate_is_no_freedom():
    """f = 3*2 - 4 - 1 = 1"""
    text = coordinates(q2=0.3) + 'q1 = { motion = "sin(t)" }\n' + crank("left", "[0, 0]", "q1") + COUPLER
    found = freedom(text)
    assert (found.by_rank, found.by_formula) == (1, 1)


def test_particles_count_two_in_the_plane_and_three_in_space():
    """2 Np, 3 Np: a free particle keeps all of them."""
    body = '[bodies.p]\nshape = {{ kind = "particle", mass = "m" }}\njoint = {{ kind = "placed", at = {} }}\n'
    unused = HEAD.replace("l = 1.0\nd = 2.0\n", "")
    plane = eomgen.loads(unused + coordinates(x=0, y=0) + body.format('["x", "y"]'))
    space = eomgen.loads(unused.replace("plane", "space") + coordinates(x=0, y=0, z=0) + body.format('["x", "y", "z"]'))
    assert [(f.by_rank, f.by_formula) for f in map(eomgen.freedom_of, (plane, space))] == [(2, 2), (3, 3)]


def test_a_rate_equation_takes_a_freedom():
    """q2' = 3 q1' is one row."""
    constraint = '[constraints.gear]\nkind = "equation"\nrate = "q2\' - 3*q1\'"\n'
    found = freedom(coordinates(q1=0.0, q2=0.0) + crank("left", "[0, 0]", "q1") + COUPLER + constraint)
    assert (found.by_rank, found.by_formula) == (1, 1)


def test_ties_that_cannot_close_are_not_counted():
    """No configuration has phi = 0 where the hinge is out of reach."""
    far = FOUR_BAR.replace('["d", 0]', '["9*d", 0]')
    found = freedom(coordinates(q1=1.0, q2=0.0, q3=1.0) + far + HINGE)
    assert found.by_rank is None
    assert "do not close near the start values: right_hinge" in found.not_counted


def test_nodes_of_a_truss_are_particles_and_members_are_ties():
    """1 = 3*1 (bodies) + 2*2 (particles) - 2 (joints) - 5 (constraints)"""
    truss = '[trusses.T]\nnodes = { A = [0, 0], B = [1, 0] }\nmembers = ["A-B"]\n'
    pins = '[constraints]\na = { kind = "pin", points = ["T.A"] }\nb = { kind = "pin", points = ["T.B"] }\n'
    found = freedom(coordinates(q1=1.0) + crank("left", "[0, 0]", "q1") + truss + pins)
    assert (found.by_rank, found.by_formula, found.not_counted) == (1, 0, "")
    assert found.formula == "3*1 (bodies) + 2*2 (particles) - 2 (joints) - 5 (constraints)"


DEPENDENT = "[coordinates]\nq1 = 1.0\nq2 = { dependent = true, near = 0.1 }\nq3 = { dependent = true, near = 1.1 }\n"


def test_dependent_coordinates_leave_the_count_as_it_is():
    """nu - rank J counts the same degrees of freedom before and after the elimination: 3 - 2 = 1 - 0."""
    found = freedom(DEPENDENT + FOUR_BAR + HINGE)
    assert found == freedom(coordinates(q1=1.0, q2=0.0, q3=1.0) + FOUR_BAR + HINGE)
    assert (found.by_rank, found.by_formula, found.closing) == (1, 1, ("right_hinge",))


def test_redundant_ties_are_named_where_coordinates_are_dependent():
    """A third crank, all but the first dependent: 0 by the formula, 1 by rank."""
    text = DEPENDENT + "q4 = { dependent = true, near = 1 }\n" + FOUR_BAR + HINGE + MIDDLE
    found = freedom(text)
    assert (found.by_rank, found.by_formula) == (1, 0)
    assert [(row.constraint, row.others) for row in found.redundant] == [("middle_hinge", ("right_hinge",))]


def test_a_model_without_values_is_counted_all_the_same():
    """The rank of a tree's rows does not wait for numbers."""
    text = HEAD.replace("l = 1.0", "l = {}").replace("d = 2.0", "d = {}")
    support = '[constraints.floor]\nkind = "support"\npoint = "coupler.end"\nnormal = [0, 1]\n'
    tree = coordinates(q1=1.0, q2=0.3) + crank("left", "[0, 0]", "q1") + COUPLER + support
    assert eomgen.freedom_of(eomgen.loads(text + tree)).by_rank == 1


def test_redundant_loops_are_named_and_leave_the_freedom_that_there_is():
    """A coupler on four equal cranks: the formula says -1, the rank 1, and two rows follow from the first pin."""
    found = eomgen.freedom_of(eomgen.load(Path(__file__).parents[1] / "models" / "four_cranks.toml"))
    assert (found.by_rank, found.by_formula) == (1, -1)
    assert [(row.constraint, row.number) for row in found.redundant] == [("Q", 2), ("R", 2)]


def test_a_tie_that_closes_in_some_rows_and_reacts_in_others_says_which():
    """A cone that rolls on its plane: n holds by itself, and both other rows keep phi - psi sin(alpha) = 1/5, once."""
    model = eomgen.load(Path(__file__).parent.parent / "models" / "rolling_cone.toml")
    lines = rendered(check_document(model)).splitlines()
    assert (
        "constraints that close: plane (rows 2 and 3)" in lines
        and "constraints that only react: plane (row 1)" in lines
    )
    kept = [line for line in lines if line.startswith("integrable")]
    assert kept == ["integrable (holonomic): rows 2 and 3 of constraint 'plane': phi - psi*sin(alpha) - 1/5 = 0"]
    freedom = eomgen.freedom_of(model)
    assert (freedom.closing, freedom.identical) == (("plane",), ("plane",))


def test_a_count_that_is_another_one_is_contradicted_by_the_rank_of_differences():
    """f = nu - rank J of (phi+ - phi-)/2h; the rows that are not redundant are as many as the rank."""
    model = eomgen.loads(HEAD + FOUR_BAR + HINGE + MIDDLE + coordinates(q1=1.0, q2=0.1, q3=1.0, q4=1.0))
    checked = Checked.of(model)
    found = checked.freedom
    assert counted_otherwise(checked) == ""
    first = found.redundant[0]
    wrong = (
        replace(found, by_rank=(found.by_rank or 0) + 1),
        replace(found, redundant=()),
        replace(found, redundant=(replace(first, others=()), *found.redundant[1:])),
        replace(found, by_formula=7),
    )
    assert all(counted_otherwise(replace(checked, freedom=each)) for each in wrong)


def test_components_that_are_held_twice_are_named():
    """f by rank - f by components = rows that hold what others do: a door on two hinges has 1 + 4 = 5."""
    door = eomgen.loads("""
eomgen = 1
space = "space"
coordinates = { psi = 0.3 }
[bodies.door]
shape = { kind = "box", mass = 20, size = [0.8, 0.04, 2] }
points = { low = [-0.4, 0, -0.5], high = [-0.4, 0, 0.5] }
joint = { kind = "placed", at = ["0.4*cos(psi)", "0.4*sin(psi)", 1], angle = "psi" }
[constraints]
low = { kind = "pin", points = ["door.low"], axis = [0, 0, 1] }
high = { kind = "pin", points = ["door.high"], axis = [0, 0, 1] }
""")
    checked = Checked.of(door)
    found = checked.freedom
    assert len(found.redundant) == 5 and counted_otherwise(checked) == ""
    fewer = replace(checked, freedom=replace(found, redundant=found.redundant[1:]))
    assert "5 components are held twice, and 4 named" in counted_otherwise(fewer)


def test_a_count_that_is_printed_or_told_otherwise_is_seen():
    """Lines and entries of `check` say the degrees of freedom, the rows and their constraints that were found"""
    found = Checked.of(eomgen.loads(HEAD + FOUR_BAR + HINGE + MIDDLE + coordinates(q1=1.0, q2=0.1, q3=1.0, q4=1.0)))
    document = check_document(found.model)
    lines, reported = document.steps[0].statements[0].lines, document.entries()
    assert reported["ok"] and lines_otherwise(lines, reported, found) == ""
    redundant = next(line for line in lines if line.startswith("redundant"))
    others = (
        [line.replace(": ", ": 7") if line.startswith("degrees") else line for line in lines],
        [line for line in lines if line != redundant],
        [line.replace("row 1", "row 9").replace("row 2", "row 9") for line in lines],
        [line.replace("constraints that close: ", "constraints that close: and ") for line in lines],
    )
    assert all(lines_otherwise([*each], reported, found) for each in others)
    for name in ("degrees_of_freedom", "by_formula", "redundant", "closing"):
        assert lines_otherwise(lines, reported | {name: None}, found), name


def test_what_the_rank_contradicts_is_not_ok_for_machines(monkeypatch):
    """`check --json`: ok is false, and the problem stands there, where the count is not that of the differences"""
    from eomgen.results import declared as check

    monkeypatch.setattr(check, "counted_otherwise", lambda *_: "another count")
    reported = check_document(eomgen.load(Path(__file__).parent.parent / "models" / "four_bar.toml")).entries()
    assert reported["ok"] is False and [each["what"] for each in reported["problems"]] == ["another count"]


def test_how_a_structure_stands_is_the_rank_of_its_reactions_in_doubles():
    """mobility = columns - rank, indeterminacy = reactions - rank"""
    from types import SimpleNamespace

    beam = f"{HEAD}[bodies.b]\npoints = {{ A = [0, 0], B = [2, 0] }}\n[constraints]\n"
    pins = "".join(f'{x} = {{ kind = "pin", points = ["b.{x}"] }}\n' for x in "AB")
    checked = Checked.of(eomgen.loads(beam + pins))
    structure = checked.structure
    assert structure is not None and structure.indeterminacy == 1 and standing_otherwise(checked) == ""
    names = ("system", "at", "unknowns", "pushes", "columns", "mobility", "rank")
    other = SimpleNamespace(**{name: getattr(structure, name) for name in names}, indeterminacy=0)
    assert standing_otherwise(replace(checked, structure=other))


HINGED = """
eomgen = 1
space = "space"
coordinates = { a = { start = 0.7, speed = 1 }, b = 0.4 }
bodies.arm.shape = { kind = "box", mass = 1, size = [0.5, 0.1, 0.1] }
bodies.arm.points.tip = [0.25, 0, 0]
bodies.arm.joint = { kind = "revolute", axis = [0, 0, 1], angle = "a" }
bodies.door.shape = { kind = "box", mass = 2, size = [0.5, 0.1, 0.3] }
bodies.door.points.side = [-0.25, 0, 0]
bodies.door.joint = { kind = "revolute", on = "arm.tip", point = "side", axis = [0, 1, 0], angle = "b" }
constraints.hinge = { kind = "pin", points = ["door.side", "arm.tip"], axis = AXIS }
"""


def test_a_hinge_with_its_axis_in_a_body_turns_with_it():
    """Along y of the door it is the joint's own axis, at any start: 2 degrees of freedom and the same accelerations;
    in the
    ground's axes it is another line where the arm is turned: 1 freedom, of which `check` warns."""
    fixed = eomgen.loads(HINGED.replace("AXIS", "[0, 1, 0]"))
    own = eomgen.loads(HINGED.replace("AXIS", '[0, 1, 0], axes = "door"'))
    assert (Freedom.of(fixed).by_rank, Freedom.of(own).by_rank) == (1, 2)
    (warning,) = Checked.of(fixed).cautions
    assert "leaves 1 degree of freedom" in warning.what and warning.fix.endswith('it leaves 2: axes = "door"')
    assert Checked.of(own).cautions == ()
    without = eomgen.loads(HINGED.partition("constraints.")[0])
    rates = [eomgen.derive(m).rhs("numpy")(0, [0.7, 0.4, 1, 0.3], []) for m in (own, without)]
    assert rates[0] == pytest.approx(rates[1])


def test_axes_of_a_hinge_are_those_of_its_bodies():
    """A body that it does not hold, axes without an axis."""
    with pytest.raises(eomgen.ModelError, match="'hinge' does not hold body 'third'"):
        eomgen.loads(HINGED.replace("AXIS", '[0, 1, 0], axes = "third"') + "[bodies.third]\njoint.kind = 'fixed'\n")
    with pytest.raises(eomgen.ModelError, match="'hinge' has no axis"):
        eomgen.loads(HINGED.replace("axis = AXIS", 'axes = "door"'))


BOWL = """
eomgen = 1
space = "plane"
points.C = [0, 1]
coordinates = { x = 0, y = 0.15, phi = 0 }
bodies.ball.shape = { kind = "disc", mass = 1, radius = 0.1 }
bodies.ball.joint = { kind = "free", x = "x", y = "y", angle = "phi" }
constraints.bowl = { kind = "rolling", body = "ball", circle = { at = "C", radius = 1, inside = false } }
"""


def test_a_bowl_without_inside_is_warned_of():
    """|c - C| = 0.85 < R: it would come to lie below the bowl; with `inside`, or on a hill, nothing is said."""
    (warning,) = Checked.of(eomgen.loads(BOWL)).cautions
    assert "'ball' starts within the circle of 'bowl'" in warning.what and "inside = true" in warning.fix
    assert Checked.of(eomgen.loads(BOWL.replace("false", "true"))).cautions == ()
    assert Checked.of(eomgen.loads(BOWL.replace("y = 0.15", "y = -0.15"))).cautions == ()
