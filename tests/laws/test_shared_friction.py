"""Dry friction that several things at rest share: how is open, only its sum is known, and so is the motion."""

from __future__ import annotations

import math

import numpy as np
import pytest

import eomgen

PARALLELOGRAM = """
eomgen = 1
space = "plane"
parameters = { m = 1, M = 2, l = 0.5, d = 1, g = 9.81 }
forces.weight = { kind = "gravity", acceleration = [0, "-g"] }
coordinates = { a = { start = 1 }, b = { dependent = true, near = 1 }, c = { dependent = true, near = 0 } }
outputs = { one = "friction(left)", two = "friction(right)", pin = "reaction_x(pin)", up = "reaction_y(pin)" }
points = { P = ["d", 0] }
constraints.pin = { kind = "pin", points = ["bar.end", "right.end"] }
[bodies.left]
shape = { kind = "rod", mass = "m", length = "l" }
joint = { kind = "revolute", angle = "a - pi/2", point = "start", friction = { torque = 30 } }
[bodies.bar]
shape = { kind = "rod", mass = "M", length = "d" }
joint = { kind = "revolute", on = "left.end", angle = "c - a + pi/2", point = "start" }
[bodies.right]
shape = { kind = "rod", mass = "m", length = "l" }
joint = { kind = "revolute", at = "P", angle = "b - pi/2", point = "start", friction = { torque = RIGHT } }
"""


@pytest.mark.parametrize("right", [2, 20])
def test_two_cranks_that_both_hold_a_loop_share_it_in_any_way(right):
    """Both together hold (m + M) g l sin a; what each of them holds is open, also where one alone is too weak."""
    with pytest.warns(RuntimeWarning, match="Statically indeterminate"):
        run = eomgen.simulate(eomgen.loads(PARALLELOGRAM.replace("RIGHT", str(right))), time=0.05, target="numpy")
    assert run["a"] == pytest.approx(np.ones(len(run.t))) and np.all(np.isnan(run["friction(right)"]))
    found = eomgen.solve(eomgen.loads(PARALLELOGRAM.replace("RIGHT", str(right))))
    assert [found[name].value for name in ("one", "two", "pin")] == [None, None, None]
    assert float(found["up"].value) == pytest.approx(9.81)


def test_one_crank_alone_holds_what_balance_says():
    """Without friction in the right one the left one holds all: (m + M) g l sin a."""
    alone = PARALLELOGRAM.replace(", friction = { torque = RIGHT }", "").replace('two = "friction(right)", ', "")
    assert float(eomgen.solve(eomgen.loads(alone))["one"].value) == pytest.approx(3 * 9.81 * 0.5 * math.sin(1))


def test_a_clutch_beside_a_hinge_lets_go_when_both_are_at_their_limits():
    """M = 3 + 5 t against 1 in the hinge and 2.5 in the clutch: they share M till 3.5 at 0.1 s, then each is known."""
    model = eomgen.loads("""
eomgen = 1
space = "plane"
coordinates = { q = 0, p = 0 }
outputs = { one = "friction(rod)", two = "friction(clutch)", three = "friction(wheel)" }
inputs.M = "3 + 5*t"
bodies.rod = { inertia = 2, joint = { kind = "revolute", angle = "q", torque = "M", friction = { torque = 1 } } }
bodies.wheel = { inertia = 1, joint = { kind = "revolute", angle = "p", friction = { torque = 4 } } }
forces.clutch = { kind = "clutch", bodies = ["rod", "wheel"], torque = 2.5 }
""")
    with pytest.warns(RuntimeWarning, match="statically indeterminate"):
        run = eomgen.simulate(model, time=1, target="numpy")
    assert run.phases[0].end == pytest.approx(0.1)
    assert all(np.isnan(run[name][0]) for name in ("one", "two", "three"))
    assert [run[name][-1] for name in ("one", "two", "three")] == pytest.approx([-1, 2.5, -2.5])
    assert run["q"][-1] == pytest.approx(5 * 0.9**3 / 6 / 2)
    assert run.certify().ok
