"""Rates and accelerations of what is driven, as names with their laws stated once."""

from __future__ import annotations

import math
import re

import pytest
from each import each
from slow_run import usual

import eomgen
from eomgen.documents.statements import Formula
from eomgen.documents.text import side_text
from eomgen.proof.at_a_state import read_back
from eomgen.symbolic.exact.equality import equal_at_random_states
from eomgen.symbolic.print.text import to_text

pytestmark = pytest.mark.slow

ARM = """
eomgen = 1
name = "Rod on a crank"
space = "plane"
[parameters]
m1 = {{ value = 2 }}
m2 = {{ value = 1 }}
l = {{ value = 0.7 }}
b = {{ value = 0.1 }}
A = {{ value = 0.1 }}
W = {{ value = 3 }}
g = {{ value = 9.81 }}
[coordinates]
psi = {{ {law} }}
phi = {{ start = 0.3 }}
[bodies.crank]
shape = {{ kind = "rod", mass = "m1", length = "l" }}
joint = {{ kind = "revolute", angle = "psi" }}
[bodies.rod]
shape = {{ kind = "rod", mass = "m2", length = "b" }}
joint = {{ kind = "revolute", on = "crank.end", angle = "phi" }}
[forces.weight]
kind = "gravity"
acceleration = [0, "-g"]
"""
LAWS = ['motion = "A*sin(W*t)"', 'rate = "W + A*t^2"', 'acceleration = "A*exp(-W*t)", speed = "W"']
CONSTANT = ['rate = "W"', 'motion = "W*t"']


def arm(law: str) -> eomgen.Equations:
    return eomgen.derive(eomgen.loads(ARM.format(law=law)))


@each("law", LAWS)
def test_equations_with_names_are_those_with_the_laws_put_in(law: str) -> None:
    """M, c, Q at psi' = f(t), psi'' = f'(t)"""
    equations = arm(law)
    named, plain = equations.in_print, equations.graph
    assert [x.name for x in named.system.scope.laws] == ["psi'", "psi''"]
    for ours, theirs in (
        (named.c, plain.c),
        (named.Q, plain.Q),
        (named.M[0], plain.M[0]),
        (named.forcing, plain.forcing),
    ):
        read = [read_back(equations.system, to_text(x)) for x in ours]
        assert equal_at_random_states(zip(read, theirs, strict=True)).equal


@pytest.mark.parametrize("law", usual([*LAWS], 2, 1))
def test_laws_stand_once_and_formulas_hold_the_names(law: str) -> None:
    """The law is a formula of the coordinates; W stands in no reaction and no equation."""
    equations = arm(law)
    steps = {step.key: [s for s in step.statements if isinstance(s, Formula)] for step in equations.derivation.steps}
    stated = [side_text(formula.sides[0]) for formula in steps["coordinates"]]
    assert stated[-2:] == ["psi'", "psi''"]
    printed = [side_text(side) for key in ("equations", "solved", "reactions") for f in steps[key] for side in f.sides]
    printed += [found.exact for found in eomgen.reactions(equations.model).values()]
    assert not any(re.search(r"\b[AW]\b|\bt\b", text) for text in printed)
    assert any("psi''" in text for text in printed)
    proof = equations.proven(equations.derivation).certificate
    assert proof is not None and proof.ok
    assert eomgen.reactions(equations.model).certify().ok


@each("law", CONSTANT)
def test_a_rate_that_is_one_letter_stands_for_itself(law: str) -> None:
    """psi' = W: W^2, as an author writes it"""
    equations = arm(law)
    assert equations.in_print is equations.graph
    assert "W^2" in side_text(equations.derivation.equations[0].left)


@each("W", [3, 0])
def test_what_holds_for_one_value_of_a_parameter_alone_is_not_printed(W: int) -> None:
    """psi' = A/W - A*exp(-W*t)/W + W, as an author writes it; where W is 0 the motion is that of A t all the same."""
    text = ARM.format(law=LAWS[-1])
    model = eomgen.loads(re.sub("W = {.*}", f"W = {{ value = {W} }}", text))
    assert not any(word in eomgen.derive(model).render() for word in ("less_equal", "select", "otherwise"))
    run = eomgen.simulate(model, time=1)
    assert run.certify().ok
    gained = 0.1 * (1 - (1 - math.exp(-W)) / W) / W if W else 0.1 / 2
    assert run["psi"][-1] - run["psi"][0] == pytest.approx(W + gained, rel=1e-6)


@each("k, V", [(0.0, 3 * 1.5), (0.5, -3 * math.exp(-0.5 * 1.5) / 0.5)])
def test_a_potential_has_its_number_where_a_parameter_is_0_too(k: float, V: float) -> None:
    """Of the pull F exp(-k r) it is F r at k = 0, and -F exp(-k r)/k else; the second alone is printed."""
    found = eomgen.solve(eomgen.loads(PULLED.replace("k = 0", f"k = {k}")))
    assert found["V"].value == pytest.approx(V, rel=1e-12)
    assert found["V"].exact == "-F*exp(-k*abs(x))/k"
    assert found.certify().ok


PULLED = """
eomgen = 1
space = "plane"
parameters = { m = 2, k = 0, F = 3 }
coordinates = { x = 1.5 }
points = { O = [0, 0] }
[bodies.b]
shape = { kind = "particle", mass = "m" }
joint = { kind = "prismatic", axis = [1, 0], displacement = "x" }
[forces]
pull = { kind = "between", points = ["O", "b.center"], pull = "F*exp(-k*r)" }
[outputs]
V = "potential_energy(pull)"
"""
