"""Nodes without mass, which follow from their balance; refusals that name the way: ropes that are hauled in."""

from __future__ import annotations

import pytest
from scipy.integrate import solve_ivp

import eomgen
from eomgen.errors import ModelError
from eomgen.questions.reactions import reactions

NODE = """
eomgen = 1
space = "plane"
parameters = { m = 1, k1 = 100, k2 = 300, c = 7 }
coordinates = { n = START, x = 0.3 }
bodies.node.joint = { kind = "prismatic", axis = [1, 0], displacement = "n", HELD }
bodies.block.shape = { kind = "particle", mass = "m" }
bodies.block.joint = { kind = "prismatic", axis = [1, 0], displacement = "x" }
forces.s = { kind = "spring", points = ["node.origin", "block.origin"], stiffness = "k2", length = 0, along = [1, 0] }
"""
CRANE = """
eomgen = 1
space = "plane"
coordinates = { l = { motion = "2 - 0.3*t" }, phi = 0.2 }
points.O = [0, 0]
bodies.load.shape = { kind = "particle", mass = 1 }
bodies.load.joint = { kind = "placed", at = ["l*sin(phi)", "-l*cos(phi)"] }
constraints.rope = { kind = "link", points = ["O", "load.center"], length = "l" }
"""


@pytest.mark.parametrize(
    ("held", "roots"),
    [
        ('stiffness = "k1"', [1j * (300 / 4) ** 0.5, -1j * (300 / 4) ** 0.5]),
        ('damping = "c"', [0, *(-300 / 14 + s * ((300 / 14) ** 2 - 300) ** 0.5 for s in (1, -1))]),
    ],
)
def test_a_node_without_mass_follows_from_its_balance(held, roots):
    """k1 n = k2 (x - n), or c n' = k2 (x - n); m x'' = -k2 (x - n)"""
    model = eomgen.loads(NODE.replace("HELD", held).replace("START", "0"))
    found = eomgen.linearize(model)
    assert sorted(found.modes.spectrum.eigenvalues, key=lambda x: (x.real, x.imag)) == pytest.approx(
        sorted(map(complex, roots), key=lambda x: (x.real, x.imag)), abs=1e-9
    )
    assert found.certify().ok
    equations = eomgen.derive(model)
    assert equations.certify().ok and "n moves no mass" in equations.assumptions[0]
    reported = reactions(model)
    assert reported["reaction_n(node)"].value == 0 and reported.certify().ok


@pytest.mark.parametrize(
    ("held", "node", "rate"),
    [
        ('stiffness = "k1"', lambda t, x: 3 * x / 4, None),
        ('stiffness = "k1", force = "10*t"', lambda t, x: (300 * x + 10 * t) / 400, None),
        ('damping = "c"', None, lambda n, x: 300 * (x - n) / 7),
    ],
)
def test_a_run_of_a_node_without_mass_is_that_of_its_balance(held, node, rate):
    """(k1 + k2) n = k2 x + f(t), or n' = k2 (x - n)/c;  m x'' = -k2 (x - n): integrated apart, from x = 0.3."""

    def motion(t, z):
        n = z[2] if node is None else node(t, z[0])
        return [z[1], -300 * (z[0] - n), 0.0 if rate is None else rate(n, z[0])]

    apart = solve_ivp(motion, (0, 0.5), [0.3, 0.0, 0.0], rtol=1e-10, atol=1e-12).y[:, -1]
    model = eomgen.loads(NODE.replace("HELD", held).replace("START", "0"))
    run = eomgen.simulate(model, time=0.5, target="numpy")
    assert run.ok and run.columns()["x"][-1] == pytest.approx(apart[0], abs=1e-7)
    n = apart[2] if node is None else node(0.5, apart[0])
    assert run.columns()["n"][-1] == pytest.approx(n, abs=1e-7)


def test_a_node_that_a_nonlinear_damper_holds_is_refused_by_name():
    """c n' |n'| = k2 (x - n) is not linear in n': no constraint says so."""
    text = NODE.replace("HELD", "force = \"-c*n'*abs(n')\"").replace("START", "0")
    with pytest.raises(ModelError, match="the free coordinate 'n' moves no mass"):
        eomgen.simulate(eomgen.loads(text), time=1, target="numpy")


def test_a_rope_that_is_hauled_in_is_a_driven_joint():
    """the length of a link is no coordinate"""
    with pytest.raises(ModelError, match='driven joint: kind = "prismatic", displacement = "l"'):
        eomgen.loads(CRANE)
