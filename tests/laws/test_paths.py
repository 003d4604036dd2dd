"""Paths of lines and arcs: where they lead, and the force of the curve."""

from __future__ import annotations

from math import cos, pi, sin

import numpy as np
import pytest
from constrained import GIVEN, R, l, system_with
from moving import at

from eomgen.symbolic.numeric.evaluation import fifty_digits

PATH = """
[bodies.P]
shape = { kind = "particle", mass = "m" }
joint = { kind = "path", along = "s", at = [1, 2], heading = "-pi/6", pieces = [{ name = "plane", line = 5 },
    { arc = "R", turn = "ccw", angle = "2*pi/3" }, { arc = "l", turn = "cw", angle = 1 }] }
"""


def position(joint, s: float) -> np.ndarray:
    """Where a path is at s, in floats."""
    value = {**GIVEN, "pi": pi}
    return np.array(joint.pose((s,), lambda e: e.evaluate(value)).p, dtype=float)


def test_a_path_goes_on_without_corner_and_with_unit_speed():
    """p and the heading are continuous where pieces meet; |dp/ds| = 1."""
    joint = system_with(PATH, s=0).scope.model.bodies["P"].joint
    ends = [float(end.evaluate({**GIVEN, "pi": pi})) for _, end in joint.bounds()]
    assert ends == pytest.approx([5, 5 + R * 2 * pi / 3, 5 + R * 2 * pi / 3 + l])
    for s in (*ends, 1.0, 5.3):
        before, here, after = (position(joint, s + d) for d in (-1e-6, 0, 1e-6))
        assert np.linalg.norm(after - here) == pytest.approx(1e-6, rel=1e-6)
        assert (after - here) @ (here - before) == pytest.approx(1e-12, rel=1e-5)
    assert position(joint, ends[1])[:2] == pytest.approx(  # down 30 degrees, then to the left until it goes up
        [5 * cos(pi / 6) + R * (sin(pi / 2) + sin(pi / 6)), -5 * sin(pi / 6) + R * cos(pi / 6)]
    )


@pytest.mark.parametrize("number", [0, 1, 2])
def test_one_piece_of_a_path_is_the_path_there(number):
    """piece(k) has the whole path's place and direction between its bounds, with `along` counted from its beginning."""
    joint = system_with(PATH, s=0).scope.model.bodies["P"].joint
    value = {**GIVEN, "pi": pi}
    low, high = (float(x.evaluate(value)) for x in joint.bounds()[number])
    piece = joint.piece(number)
    for s in (low + 1e-9, (low + high) / 2, high - 1e-9):
        own = float(piece.along.evaluate({**value, "s": s}))
        assert own == pytest.approx(s - low)
        assert position(piece, own) == pytest.approx(position(joint, s))


def test_a_bead_on_an_arc_is_pushed_to_its_centre():
    """At the lowest point of an arc to the left the acceleration is v^2/R upward, and so is the first wrench of W."""
    arc = 'kind = "path", along = "s", heading = "-pi/2", pieces = [{ arc = "R", turn = "ccw", angle = "2*pi/3" }]'
    system = system_with(f'[bodies.P]\nshape = {{ kind = "particle", mass = "m" }}\njoint = {{ {arc} }}\n', s=0)
    one, quarter = fifty_digits().number(1), fifty_digits().functions["pi"]() / 2 * R
    state = {system.symbols.parameters[name]: one * value for name, value in GIVEN.items()}
    state |= {system.symbols.q[0]: quarter, system.symbols.u[0]: 3 * one, system.symbols.t: 0 * one}
    motion = system.scope.time_derivative(system.scope.time_derivative(system.motion.link("P").pose.p))
    assert at(motion, state) == pytest.approx([0, 9 / R, 0], abs=1e-12)
    W = system.motion.link("P").joint.complement(system.motion.link("P").s, system.scope.value)
    assert at(W[0], state) == pytest.approx([0, 0, 0, 0, 1, 0], abs=1e-12)
