"""Sums of reactions that have no single value, and have one together: by the balance of the bodies alone."""

from __future__ import annotations

import math
from dataclasses import replace

import pytest

import eomgen
from eomgen.proof import structure
from eomgen.questions.reactions import reactions

TABLE = """
eomgen = 1
space = "space"
parameters = { P = { value = 10, unit = "N" }, a = { value = 2, unit = "m" } }
bodies.top.points.p1 = ["a", "a", 0]
bodies.top.points.p2 = ["-a", "a", 0]
bodies.top.points.p3 = ["-a", "-a", 0]
bodies.top.points.p4 = ["a", "-a", 0]
bodies.top.points.d = ["a/2", 0, 0]
constraints.L1 = { kind = "support", point = "top.p1", normal = [0, 0, 1] }
constraints.L2 = { kind = "support", point = "top.p2", normal = [0, 0, 1] }
constraints.L3 = { kind = "support", point = "top.p3", normal = [0, 0, 1] }
constraints.L4 = { kind = "support", point = "top.p4", normal = [0, 0, 1] }
constraints.H1 = { kind = "support", point = "top.p1", normal = [1, 0, 0] }
constraints.H2 = { kind = "support", point = "top.p1", normal = [0, 1, 0] }
constraints.H3 = { kind = "support", point = "top.p2", normal = [0, 1, 0] }
forces.P = { kind = "force", point = "top.d", force = [0, 0, "-P"] }
[outputs]
right = "reaction_n(L1) + reaction_n(L4)"
square = "(reaction_n(L2) + reaction_n(L1))*2 + reaction_n(H1)"
open = "reaction_n(L1) + reaction_n(L3)"
"""

SLED = """
eomgen = 1
space = "plane"
[parameters]
m = { value = 2, unit = "kg" }
F = { value = 10, unit = "N" }
g = { value = 9.81, unit = "m/s^2" }
l = { value = 0.6, unit = "m" }
[coordinates]
x = { start = 0, unit = "m" }
[bodies.sled]
shape = { kind = "rod", mass = "m", length = "l" }
points = { b = ["l/3", 0] }
joint = { kind = "placed", at = ["x", 0], angle = 0 }
[constraints.A]
kind = "support"
point = "sled.start"
normal = [0, 1]
[constraints.B]
kind = "support"
point = "sled.b"
normal = [0, 1]
[constraints.C]
kind = "support"
point = "sled.end"
normal = [0, 1]
[forces.push]
kind = "force"
point = "sled.end"
force = ["F", 0]
[forces.weight]
kind = "gravity"
acceleration = [0, "-g"]
[outputs]
N = "reaction_y(A) + reaction_y(B) + reaction_y(C)"
moment = { value = "l/3*reaction_y(B) + l*reaction_y(C)", unit = "N*m" }
"""


@pytest.fixture(scope="module")
def table() -> eomgen.Model:
    return eomgen.loads(TABLE)


def test_two_legs_of_four_carry_the_share_that_moments_give(table):
    """a (N1 + N4) - a (N2 + N3) = P a/2,  N1 + N2 + N3 + N4 = P:  N1 + N4 = 3/4 P, while N1 + N3 stays open."""
    answers = eomgen.solve(table)
    assert answers["right"].exact == "3/4*P" and answers["right"].value == 7.5
    assert answers["square"].exact == "P"
    assert not answers["open"].answered and "statically indeterminate" in answers["open"].message
    certificate = answers.certify()
    assert certificate.ok and all(check.status == "holds" for check in certificate.checks)


def test_reactions_and_statics_tell_the_sums_in_which_self_stress_leaves_no_trace(table):
    """sum of k_i s_i = 0 for each self-stress s: here of (1, -1, 1, -1)."""
    reported, at_rest = reactions(table), eomgen.statics(table)
    for sums in (reported.sums, at_rest.entries()["sums"]):
        assert sorted(x.value for x in sums.values()) == [-2.5, 5.0, 7.5]
        assert sorted(x.exact for x in sums.values()) == ["-1/4*P", "1/2*P", "3/4*P"]
    assert reported.certify().ok and at_rest.certify().ok
    assert any("one value, whatever the self-stress" in check.name for check in at_rest.certify().checks)


def test_a_sum_that_a_self_stress_changes_contradicts(table):
    """Reactions of least size beside what may be added to them: a told sum without its factor fails."""
    found = eomgen.statics(table).found
    wrong = found.sums[0].combination | {next(iter(found.sums[0].combination)): 2}
    assert list(structure._Proof(found).wrong_sums()) == []
    found.__dict__["sums"] = (replace(found.sums[0], combination=wrong),)
    assert len(list(structure._Proof(found).wrong_sums())) == 1


def test_sums_are_columns_of_a_run_and_outputs_of_code():
    """N_A + N_B + N_C = m g,  l/3 N_B + l N_C = m g l/2, at all times."""
    columns = eomgen.simulate(eomgen.loads(SLED), time=0.2, samples=5, target="numpy").columns()
    assert columns["N"] == pytest.approx(2 * 9.81)
    assert columns["moment"] == pytest.approx(2 * 9.81 * 0.3)
    requested = eomgen.derive(eomgen.loads(SLED)).requested_outputs
    assert {*requested.values} == {"N", "moment"} and not requested.left
    assert math.isclose(eomgen.solve(eomgen.loads(SLED))["moment"].value, 2 * 9.81 * 0.3)
