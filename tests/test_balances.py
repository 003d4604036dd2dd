"""Balances of bodies that are cut free: each of them holds, and one wrong item in it is told by its name."""

from __future__ import annotations

from pathlib import Path

import pytest
from slow_run import usual

import eomgen
from eomgen.judge.balances import Balances
from eomgen.judge.case import Case
from eomgen.judge.decision import is_zero_everywhere
from eomgen.judge.diagnosis import Samples
from eomgen.symbolic.expression.derivatives import substituted

MODELS = Path(__file__).parent.parent / "models"
MISTAKES = Path(__file__).parent / "helpers" / "cut_mistakes"


def balances(path: Path, equation: str) -> Balances:
    case = Case(eomgen.load(path))
    return Balances(case, case.reading.read(equation))


@pytest.mark.parametrize(
    ("model", "equation"),
    [
        ("three_hinged_arch", "reaction_x(A) + reaction_y(A) = 0"),
        ("gerber_frame", "reaction_x(A) + reaction_y(A) = 0"),
        ("strut_frame", "reaction_x(A) + reaction_y(A) = 0"),
        ("beam_with_overhang", "bending_moment(beam, L/2) + shear_force(beam, L/2) = 0"),
        ("beam_with_overhang", "bending_moment(beam, L/3) = reaction_y(A)*L/3"),
        ("atwood", "tension(string, 1) + tension(string, 2) = 0"),
        ("block_on_wedge", "reaction_n(block) = 0"),
        ("double_pendulum", "reaction_x(arm1) + reaction_y(arm2) = 0"),
    ],
)
def test_every_balance_of_what_is_cut_free_holds(model, equation):
    """sum of F . e = 0 and sum of M = 0, inertia forces among them, with what the model says of all reactions."""
    judged = balances(MODELS / f"{model}.toml", equation)
    cuts = list(judged._free.cuts(judged._requested[0]))
    assert len(cuts) > 3
    for cut in cuts:
        pushes = [push for each in judged._free.acting for push in each.on(cut.parts)]
        (total,) = substituted((sum(map(cut.value, pushes), start=0),), judged._values)
        assert is_zero_everywhere(judged.case.system, judged.case.phase.eliminated(total)).holds, cut.name


@pytest.mark.slow
@pytest.mark.parametrize("model", ["fink_truss", "k_truss"])
def test_every_balance_of_a_part_of_a_truss_holds(model):
    """Nodes, and what straight cuts through three members separate; about nodes beyond the cut, too."""
    case = Case(eomgen.load(MODELS / f"{model}.toml"))
    for name in [c.name for c in case.quantities.reactions.components][::5]:
        test_every_balance_of_what_is_cut_free_holds(model, f"{name} = 0")


@pytest.mark.slow
@pytest.mark.parametrize(
    ("model", "equation", "kind", "reported"),
    usual(
        [
            (
                "01_portal",
                "A_x = q*a^2/(4*h) + H/2",
                "missing_term",
                "the force wind in the balance of forces along x of left, H, is missing",
            ),
            (
                "01_portal",
                "A_x = 3*q*a^2/(4*h) - H/2",
                "missing_term",
                "the force load in the balance of moments about C of left",
            ),
            ("02_gerber", "M_A = P*a", "missing_term", "the reaction G_y"),
            ("02_gerber", "B_y = P/4 + 3*q*a/2", "missing_term", "the couple M_A"),
            ("02_gerber", "M_A = 2*P*a + 2*q*a^2", "wrong_point", "of first acts at G"),
            ("03_jib", "S = (G/2 + Q)*cos(alpha)", "factor", "whole distance for a lever arm"),
            ("03_jib", "A_y = G + Q + S", "extra_term", "tension S (rope)"),
            ("04_ladder", "N_B = (m*g/2 + Q)/tan(alpha)", "wrong_point", "of ladder acts at ladder.end"),
            ("05_bracket", "outer = -P", "factor", "full size in place of its component"),
            ("06_roller", "N = G*cos(alpha) + S*sin(beta)", "sign", "the tension S (rope)"),
            ("08_lorry", "N_f = m*g*a/(a + b)", "missing_term", "inertia force of lorry"),
            ("09_hoist", "S1 - S2 = M*x''", "factor", "inertia couple of disc"),
            ("09_hoist", "B = S1 + S2", "missing_term", "weight of disc"),
            (
                "10_roof",
                "S_CE = -A_y*sqrt(a^2 + h^2)/h",
                "missing_term",
                "the force F1 in the balance of moments about D of the part with A, C",
            ),
            ("13_beamM", "M_m = A_y*l/2 - q*l^2/6", "wrong_point", "beam (the part before it) acts at"),
            ("13_beamM", "V_m = A_y - q*l/3 - F", "extra_term", "(the part before it) is counted, and acts elsewhere"),
            ("22_lift", "J*phi'' = M0 - S1*r + S2*R", "wrong_quantity", "drum.origin of drum R and r are exchanged"),
            ("19_cart", "S = m1*x'' - mu*m1*g", "sign", "the friction of table"),
            ("20_gantry", "S_BD = -c*H/b - V", "wrong_point", "the force H1"),
            ("15_rod", "along = -(m + M)*g*cos(phi) - m/2*l*phi'^2", "missing_term", "inertia force of bead"),
        ],
        3,
    ),
)
def test_one_wrong_item_of_a_balance_is_told(model, equation, kind, reported):
    """All else is right: what was forgotten, turned, or taken for another component or lever arm of a part cut free."""
    (cause,) = eomgen.verify(MISTAKES / f"{model}.toml", equation).causes
    assert (cause.kind, reported in cause.text) == (kind, True), cause.text
    assert cause.body or cause.force or kind == "wrong_quantity"


def test_that_all_is_missing_explains_nothing():
    """X = 0 is what is left of any balance without all its other items; one that is missing is told."""
    (cause,) = eomgen.verify(MISTAKES / "03_jib.toml", "A_x = 0").causes
    assert "tension S (rope)" in cause.text and "missing" in cause.text
    found = eomgen.verify(MISTAKES / "04_ladder.toml", "N_A = 0")
    assert [cause.kind for cause in found.causes] != ["missing_term", "missing_term"]


PENDULUM = """
eomgen = 1
space = "plane"
parameters = { m = 1, l = 1, g = 9.81 }
coordinates.theta = { start = "pi/2", speed = 0 }
points.O = [0, 0]
bodies.bob.shape = { kind = "particle", mass = "m" }
bodies.bob.joint = { kind = "placed", at = ["l*sin(theta)", "-l*cos(theta)"] }
constraints.string = { kind = "link", points = ["bob.center", "O"] }
forces.weight = { kind = "gravity", acceleration = [0, "-g"] }
"""


@pytest.mark.slow
@pytest.mark.parametrize(
    ("equation", "reported"),
    [
        ("tension(string) = 2*m*g", "the weight of bob in the balance of forces along y of bob, -m*g, is missing"),
        ("tension(string) = m*g", "the inertia force of bob"),
    ],
)
def test_the_balance_at_an_instant_is_that_of_its_state(equation, reported):
    """N = m g + m v^2/l at the lowest place, v^2 = 2 g l; what has no value there made such an answer undecided."""
    model = eomgen.loads(PENDULUM)
    assert eomgen.verify(model, "tension(string) = 3*m*g", at="theta = 0")
    found = eomgen.verify(model, equation, at="theta = 0")
    assert found.verdict == "wrong" and reported in found.causes[0].text


def test_a_section_cuts_line_loads():
    """Both parts of a beam together bear what the beam bears: F_1 + F_2 = F, and the moments about the section."""
    case = Case(eomgen.load(MISTAKES / "13_beamM.toml"))
    (call,) = case.reading.read("bending_moment(beam, l/6) = 0").calls
    free = case.quantities.free_bodies([call], Samples({}, 1).flat)
    (load,) = (each for each in free.acting if each.force == "load")
    whole, before, after = load.pushes
    assert (whole.part, before.part, after.part) == (0, 1, 2)
    apart = whole.force[1] - before.force[1] - after.force[1], whole.moment - before.moment - after.moment
    assert is_zero_everywhere(case.system, *apart).holds
