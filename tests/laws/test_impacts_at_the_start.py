"""Speeds that lead into a floor or against a taut rope: one impact without rebound, in every verb, in any speeds."""

from __future__ import annotations

import pytest

import eomgen
from eomgen.results.declared import check_document

ROD = """
eomgen = 1
space = "plane"
parameters = { m = 2, l = 0.6, v = 3, g = 9.81 }
coordinates = { y = { start = 0, speed = "-v" }, theta = { start = 0, speed = 0 } }
bodies.rod.shape = { kind = "rod", mass = "m", length = "l" }
bodies.rod.joint = { kind = "placed", point = "center", at = [0, "y"], angle = "theta" }
constraints.floor = { kind = "support", point = "rod.start", normal = [0, 1], unilateral = true }
forces.weight = { kind = "gravity", acceleration = [0, "-g"] }
[outputs]
omega = "omega(rod)"
N = "reaction_n(floor)"
T = "kinetic_energy()"
"""
ROPE = """
eomgen = 1
space = "plane"
parameters = { L = 2, w = 1.5, g = 9.81 }
points.O = [0, 0]
coordinates = { x = { start = 0, speed = "w" }, y = { start = "-L", speed = -4 } }
bodies.ball.shape = { kind = "particle", mass = 1 }
bodies.ball.joint = { kind = "placed", at = ["x", "y"] }
constraints.rope = { kind = "link", points = ["O", "ball.origin"], length = "L", unilateral = true }
forces.weight = { kind = "gravity", acceleration = [0, "-g"] }
[outputs]
S = "tension(rope)"
"""


@pytest.fixture(scope="module")
def rod() -> eomgen.Model:
    return eomgen.loads(ROD)


def test_a_rod_thrown_on_its_end_begins_after_the_impact_in_every_verb(rod):
    """m (y+ + v) = Lam, m l^2/12 theta+ = -l/2 Lam, y+ = l/2 theta+: y+ = -3/4 v, theta+ = -3/2 v/l, T = 3/8 m v^2"""
    y, theta = -9 / 4, -7.5
    answers = eomgen.solve(rod)
    assert answers["omega"].value == pytest.approx(theta) and answers["T"].value == pytest.approx(3 / 8 * 2 * 9)
    assert answers.certify().ok
    equations = eomgen.derive(rod)
    assert equations.rhs("numpy").x0[2:] == pytest.approx([y, theta])
    run = eomgen.simulate(rod, time=0.01, target="numpy").columns()
    assert (run["y'"][0], run["theta'"][0]) == pytest.approx((y, theta))
    assert run["N"][0] == pytest.approx(answers["N"].value)


def test_what_was_changed_at_the_start_is_told(rod):
    """An impact without rebound, the constraint, the speeds before and after."""
    reported = str(eomgen.documents.rendered(check_document(rod)))
    assert "changed by an impact without rebound on 'floor': y' = -2.25 (not -3), theta' = -7.5 (not 0)" in reported
    assert "no problems found" in reported


def test_a_rope_that_tautens_at_the_start_takes_the_speed_along_it():
    """x' = w stays, y' = 0: S = m g + m w^2/L."""
    answer = eomgen.solve(eomgen.loads(ROPE))["S"]
    assert answer.value == pytest.approx(9.81 + 1.5**2 / 2)


def test_speeds_that_lead_away_make_no_impact():
    """Thrown up the floor lets it go: y' = v stays, N = 0."""
    answers = eomgen.solve(eomgen.loads(ROD.replace('"-v"', '"v"')))
    assert answers["N"].value == 0 and answers["omega"].value == 0


def test_an_impact_is_the_same_in_declared_speeds():
    """A ball flies until its rope is taut: by its rates or by z' and two combinations of the others."""
    flying = ROPE.replace('start = "-L", speed = -4 }', 'start = "-L/2" }, z = { start = 0.1, speed = 2 }')
    flying = flying.replace("L = 2", "L = 1.2").replace('"plane"', '"space"').replace("O = [0, 0]", "O = [0, 0, 0]")
    flying = flying.replace('at = ["x", "y"]', 'at = ["x", "y", "z"]').replace('[0, "-g"]', '[0, "-g", 0]')
    speeds = """speeds = { u = { rate = "2*x' + y'", start = "2*w" }, v = { rate = "y' - x'/2", start = "-w/2" } }\n"""
    named = flying.replace(', speed = "w"', "").replace("coordinates =", f"{speeds}coordinates =")
    runs = [eomgen.simulate(eomgen.loads(x), time=1, samples=5, target="numpy") for x in (flying, named)]
    assert [len(run.phases) for run in runs] == [2, 2]
    assert runs[1].x[:, :3] == pytest.approx(runs[0].x[:, :3], abs=1e-7)
    assert all(run.certify().ok for run in runs)
