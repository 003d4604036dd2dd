"""Laws of structures at rest: virtual work, equilibrium and a solution in floats agree; what is loose or redundant."""

from __future__ import annotations

from pathlib import Path
from random import Random

import numpy as np
import pytest
from random_structures import RandomStructure, determinate

import eomgen
from eomgen.errors import DerivationError
from eomgen.mechanics.dynamics.system import System
from eomgen.mechanics.free_bodies.structure import Structure
from eomgen.mechanics.statics.virtual_work import (
    StaticReactions,
    by_virtual_work,
    loads_at_rest,
    requested_reactions,
)
from eomgen.symbolic.numeric.evaluation import FLOAT, evaluate
from eomgen.symbolic.print.text import to_text

pytestmark = pytest.mark.slow

MODELS = Path(__file__).parent.parent.parent / "models"

DEPENDENT = 1e-9  # of the largest singular value


def solved(text: str) -> StaticReactions:
    return StaticReactions.of(System.of(eomgen.loads(text)))


def values(found: StaticReactions) -> dict[str, float]:
    """Every reaction by virtual work, all parameters 1."""
    ones = {node: 1.0 for node in found.system.symbols.parameters.values()}
    scalars = [r.work.value for r in found.reactions if r.work is not None]
    names = [r.name for r in found.reactions if r.work is not None]
    return dict(zip(names, evaluate(scalars, ones, FLOAT), strict=True))


def as_named(name: str) -> str:
    """reaction_x(h0), tension(s1) -> h0_x, s1"""
    kind, _, owner = name.removesuffix(")").partition("(")
    what = kind.removeprefix("reaction_")
    return owner if what in ("n", "tension") else f"{owner}_{what}"


@pytest.mark.parametrize(
    ("seed", "bodies", "space"),
    [(1, 1, False), (2, 2, False), (3, 3, False), (4, 4, False), (5, 3, False), (6, 1, True), (7, 2, True)],
)
def test_virtual_work_equals_equilibrium_equals_floats(seed, bodies, space):
    """R delta_R + sum of works = 0 and G rho + F = 0 give one rho, that of the equations in floats."""
    structure = determinate(seed, bodies=bodies, space=space)
    found = solved(structure.text)
    assert not found.disagreeing and not found.open
    expected = structure.floats.solved()
    for name, value in values(found).items():
        assert value == pytest.approx(expected[as_named(name)], rel=1e-8, abs=1e-8), (name, structure.text)


@pytest.mark.parametrize("spare", [-1, 0, 1, 2])
def test_mobility_and_indeterminacy_are_those_of_the_rank_in_floats(spare):
    """mobility = rows - rank G, indeterminacy = columns - rank G."""
    for seed in range(6):
        structure = RandomStructure(Random(100 * spare + seed), bodies=2, spare=spare)
        names, _, _ = structure.floats.equations()
        sizes = structure.singular_values
        rank = int(np.sum(sizes > DEPENDENT * sizes[0]))
        found = Structure.of(System.of(eomgen.loads(structure.text)))
        assert (found.rank, found.mobility, found.indeterminacy) == (rank, 6 - rank, len(names) - rank)
        assert len(found.loose) == found.mobility and len(found.stresses) == found.indeterminacy


def test_loose_motions_are_forbidden_by_nothing_and_self_stresses_are_in_balance():
    """G^T xi = 0 for every loose motion, G rho = 0 for every self-stress, exactly."""
    structure = RandomStructure(Random(3), bodies=3, spare=-2)
    loose = Structure.of(System.of(eomgen.loads(structure.text)))
    for plan in loose.loose:
        for component in loose.components:
            assert plan.vanishes((plan.work_of_effects(component.effects),))
    tight = Structure.of(System.of(eomgen.loads(RandomStructure(Random(4), bodies=2, spare=2).text)))
    for stress in tight.stresses:
        for k in range(len(tight.columns)):
            total = sum((share * tight.rows[j].get(k, 0) for j, share in stress.items()), start=0)
            assert abs(evaluate((total,), {n: 1.0 for n in tight.system.symbols.parameters.values()}, FLOAT)[0]) < 1e-12


def test_released_mechanism_moves_along_its_reaction_alone():
    """W_k . xi = 1 for the released reaction, 0 for every other."""
    structure = Structure.of(System.of(eomgen.loads(determinate(11, bodies=3).text)))
    for released in range(len(structure.components)):
        plan = structure.released(released)
        for j, component in enumerate(structure.components):
            assert plan.vanishes((plan.work_of_effects(component.effects) - (j == released),))


def test_line_loads_do_the_work_of_the_integral():
    """L/6 (2 q_A.v_A + q_A.v_B + q_B.v_A + 2 q_B.v_B) = sum of Gauss points, not of the ends' forces."""
    text = BEAM.replace(
        "[forces]",
        '[forces]\nq = { kind = "distributed", body = "AB", between = ["A", "B"], '
        'intensities = [[0, "-p"], ["p", "-4*p"]] }',
    )
    structure = Structure.of(System.of(eomgen.loads(text)))
    load = next(x for x in loads_at_rest(structure) if x.name == "q")
    plan = structure.released(structure.index("reaction_n(B)"))
    ones = {node: 1.0 for node in structure.system.symbols.parameters.values()}
    a, b = (np.array(evaluate(plan.velocity(place), ones, FLOAT)) for place in (load.load.start, load.load.end))
    q_A, q_B, length = np.array([0, -1, 0]), np.array([1, -4, 0]), 4
    gauss = ((1 - 3**-0.5) / 2, (1 + 3**-0.5) / 2)
    expected = sum(length / 2 * (q_A + s * (q_B - q_A)) @ (a + s * (b - a)) for s in gauss)
    assert evaluate((load.work(plan),), ones, FLOAT)[0] == pytest.approx(expected, rel=1e-12)


BEAM = """
eomgen = 1
name = "beam"
space = "plane"
[parameters]
a = { positive = true }
p = {}
[bodies.AB]
points = { A = [0, 0], B = ["4*a", 0] }
[constraints]
A = { kind = "pin", points = ["AB.A"] }
B = { kind = "support", point = "AB.B", normal = [0, 1] }
[forces]
"""


def test_gerber_beam_by_virtual_work():
    """The centres of the mechanism without A are B and D: -4 a V_A - 36 p a^2 = 0."""
    found = StaticReactions.of(System.of(eomgen.load("models/gerber_beam.toml")))
    exact = {name: to_text(reaction.work.value) for name, reaction in found.by_name.items()}
    assert exact["reaction_n(A)"] == "-9*p*a" and exact["reaction_n(B)"] == "18*p*a"
    assert exact["reaction_y(E)"] == "7*p*a" and exact["reaction_couple(E)"] == "-20*p*a^2"
    work = found.by_name["reaction_n(A)"].work
    centers = [tuple(to_text(x) for x in block.center(work.plan).place[:2]) for block in work.plan.blocks]
    assert centers == [("4*a", "0"), ("16*a", "0")]
    assert to_text(work.along) == "-4*a"


def test_virtual_work_does_not_use_the_solution_of_the_balance(monkeypatch):
    """Nothing of the bodies' equations is solved for the reactions."""
    structure = Structure.of(System.of(eomgen.load("models/gerber_beam.toml")))

    def refused(*_, **__):
        raise AssertionError("the balance was solved")

    monkeypatch.setattr("eomgen.mechanics.free_bodies.reactions.solution_of_balance", refused)
    named = requested_reactions(structure)["reaction_couple(E)"]
    assert to_text(by_virtual_work(structure, named).value) == "-20*p*a^2"


LOOSE = {
    "support along the beam": (
        'B = { kind = "support", point = "AB.B", normal = [1, 0] }',
        "infinitesimally movable: body 'AB' can turn about (0, 0)",
    ),
    "no second support": ("", "unstable: body 'AB' can turn about (0, 0)"),
}


@pytest.mark.parametrize("case", LOOSE)
def test_loose_bodies_are_named_with_their_motion(case):
    """Also where the loads happen to balance, here where there are none."""
    support, expected = LOOSE[case]
    text = BEAM.replace('B = { kind = "support", point = "AB.B", normal = [0, 1] }', support)
    with pytest.raises(DerivationError) as error:
        solved(text)
    assert expected in error.value.what
    assert error.value.where == "bodies.AB"


def test_three_supports_that_meet_are_refused_at_these_values_alone():
    """Exact rank at the model's values: a = b makes the lines meet, other values do not."""
    text = """
eomgen = 1
name = "plate"
space = "plane"
[parameters]
a = 1
b = 1
[bodies.plate]
points = { A = [0, 0], B = ["2*a", 0], C = ["b", "a"] }
[constraints]
A = { kind = "support", point = "plate.A", normal = [1, 1] }
B = { kind = "support", point = "plate.B", normal = [-1, 1] }
C = { kind = "support", point = "plate.C", normal = ["a - b", 1] }
"""
    with pytest.raises(DerivationError, match=r"can turn about \(a, a\)|can turn about \(b, a\)"):
        solved(text)
    assert not solved(text.replace("b = 1", "b = 2")).disagreeing


def test_indeterminate_reactions_are_named_and_the_others_given():
    """A beam on three rollers and a pin: x is determinate, the four vertical ones have two self-stresses."""
    text = BEAM.replace(
        "[forces]",
        'C = { kind = "support", point = "AB.C", normal = [0, 1] }\n[forces]\n'
        'f = { kind = "force", point = "AB.C", force = ["p", "-p"] }',
    )
    found = solved(text.replace('B = ["4*a", 0]', 'B = ["4*a", 0], C = ["2*a", 0]'))
    assert [r.name for r in found.open] == ["reaction_y(A)", "reaction_n(B)", "reaction_n(C)"]
    assert to_text(found.by_name["reaction_x(A)"].work.value) == "-p"
    (stress,) = found.structure.stresses
    shares = [stress.get(found.structure.index(r.name), 0) for r in found.open]
    assert shares[0] == shares[1] and shares[2] == -2 * shares[0]


def test_unknown_load_is_found_by_the_motion_that_it_alone_forbids():
    """A toggle: P dx = Q dy with dx/dy of the mechanism, P = a Q / (2 b)."""
    text = """
eomgen = 1
name = "toggle"
space = "plane"
[parameters]
a = {}
b = {}
Q = {}
[unknowns]
P = "holds it"
[bodies.I]
points = { A = [0, 0], C = ["a", "b"] }
[bodies.II]
points = { C = ["a", "b"], B = ["2*a", 0] }
[constraints]
A = { kind = "pin", points = ["I.A"] }
B = { kind = "support", point = "II.B", normal = [0, 1] }
C = { kind = "pin", points = ["I.C", "II.C"] }
[forces]
f = { kind = "force", point = "I.C", force = [0, "-Q"] }
p = { kind = "force", point = "II.B", force = ["-P", 0] }
"""
    found = solved(text)
    assert not found.disagreeing
    assert to_text(found.by_name["P"].work.value) == "a*Q/(2*b)"


def test_a_straight_boom_may_turn_about_its_own_line():
    """A ball joint and two wires: five reactions, the sixth motion displaces no point and no load works in it."""
    text = """
eomgen = 1
name = "boom"
space = "space"
[parameters]
P = {}
a = { positive = true }
[points]
C = [0, "2*a", "3*a"]
D = [0, "-2*a", "3*a"]
[bodies.boom]
points = { O = [0, 0, 0], A = ["3*a", 0, 0], B = ["2*a", 0, 0] }
[constraints]
O = { kind = "pin", points = ["boom.O"] }
AC = { kind = "link", points = ["boom.A", "C"] }
BD = { kind = "link", points = ["boom.B", "D"] }
[forces]
f = { kind = "force", point = "boom.A", force = [0, 0, "-P"] }
"""
    found = solved(text)
    assert not found.disagreeing and not found.open
    assert to_text(found.by_name["tension(AC)"].work.value) == "1/6*sqrt(22)*P"
    with pytest.raises(DerivationError, match="along x"):
        solved(text + 'c = { kind = "couple", body = "boom", couple = ["P*a", 0, 0] }\n')


def test_a_ladder_stands_by_friction_or_slides():
    """F = m g / (2 tan 60) <= mu m g: mu >= sqrt(3)/6."""
    text = """
eomgen = 1
name = "ladder"
space = "plane"
[parameters]
mu = 0.3
[bodies.ladder]
shape = { kind = "rod", mass = 20, length = 4 }
joint = { kind = "placed", at = [0, 0], angle = "pi/3" }
[constraints]
floor = { kind = "support", point = "ladder.start", normal = [0, 1], friction = "mu", unilateral = true }
wall = { kind = "support", point = "ladder.end", normal = [-1, 0], unilateral = true }
[forces]
gravity = { kind = "gravity", acceleration = [0, -10] }
"""
    standing = eomgen.statics(eomgen.loads(text))
    assert standing.values["reaction_t(floor)"] == pytest.approx(200 * 3**0.5 / 6) and not standing.broken
    assert eomgen.statics(eomgen.loads(text.replace("mu = 0.3", "mu = 0.28"))).broken


def test_the_released_mechanism_stands_in_the_answer_for_machines():
    """ch21-p1 without its clamp's couple: CD turns about (10 a, 0) by 1, DE about E by -3/2."""
    found = eomgen.statics(eomgen.load(MODELS / "gerber_beam.toml"), reaction="reaction_couple(E)")
    first, second = found.as_dict()["reactions"]["reaction_couple(E)"]["work"]["mechanism"]
    assert (first["parts"], first["center"], first["rotation"]) == (["CD"], ["10*a", "0"], ["0", "0", "1"])
    assert (second["parts"], second["center"], second["rotation"]) == (["DE"], ["20*a", "0"], ["0", "0", "-3/2"])


def test_statics_holds_what_the_model_drives_where_it_starts():
    """A bar that is turned at a rate carries at rest its weight alone: no centrifugal force, and both ways agree."""
    text = """
    eomgen = 1
    space = "plane"
    parameters = { m = 0.5, g = 9.81, W = 3, l = 2 }
    coordinates.psi = { motion = "W*t" }
    bodies.bar.shape = { kind = "rod", mass = "m", length = "l" }
    bodies.bar.joint = { kind = "revolute", angle = "psi" }
    forces.weight = { kind = "gravity", acceleration = [0, "-g"] }
    """
    found = eomgen.statics(eomgen.loads(text))
    assert found.ok and found.exact["reaction_x(bar)"] == "0" and found.exact["reaction_y(bar)"] == "m*g"
