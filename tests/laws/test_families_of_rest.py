"""Places of rest that make up a curve are one family, told once; places that are degenerate and alone stay apart."""

from __future__ import annotations

import math

import numpy as np
import pytest

import eomgen
from eomgen.proof.certificate import balance_check

COLUMN = """
eomgen = 1
space = "plane"
parameters.L = { value = 1200, unit = "mm" }
parameters.k = { value = 300, unit = "N*m/rad" }
parameters.P = { value = 500, unit = "N" }
coordinates.th = { start = 0, unit = "deg" }
coordinates.u = { dependent = true, near = 1200, unit = "mm" }
coordinates.th2 = { dependent = true, near = 0, unit = "deg" }
bodies.lower.shape = { kind = "rod", mass = 2, length = "L/2" }
bodies.lower.joint = { kind = "revolute", angle = "pi/2 + th" }
bodies.upper.shape = { kind = "rod", mass = 2, length = "L/2" }
bodies.upper.joint = { kind = "revolute", on = "lower.end", angle = "th2 - th", stiffness = "k" }
bodies.head.shape = { kind = "particle", mass = 0.5 }
bodies.head.joint = { kind = "prismatic", axis = [0, 1], displacement = "u" }
constraints.top = { kind = "pin", points = ["upper.end", "head.origin"] }
forces.load = { kind = "force", point = "head.origin", force = [0, "-P"] }
"""
QUARTIC = """
eomgen = 1
space = "plane"
coordinates = { x = 0.8, y = 0.1 }
bodies.b.shape = { kind = "particle", mass = 1 }
bodies.b.joint = { kind = "placed", at = ["x", "y"] }
forces.v = { kind = "potential", energy = "ENERGY" }
"""


@pytest.fixture(scope="module")
def column():
    return eomgen.statics(eomgen.loads(COLUMN))


@pytest.mark.slow
def test_folded_bars_of_a_column_may_stand_at_any_angle(column):
    """sin(th) + sin(th2) = 0 with u = L/2 (cos(th) + cos(th2)) = 0: th2 = th + pi or th - pi, at one V."""
    families = [place for place in column.places if place.curve is not None]
    assert len(families) == 2 and len(column.places) <= 9
    for place in families:
        th, u, th2 = place.curve.points[:, :3].T
        assert np.ptp(th) > math.pi and u == pytest.approx(0, abs=1e-9)
        assert np.abs(th2 - th) == pytest.approx(math.pi, abs=1e-9)
    assert column.certify().ok


@pytest.mark.slow
def test_places_are_told_in_the_units_of_the_file(column):
    """u = L is 1200 mm, the bars folded stand at 180 deg to one another."""
    text = " ".join(column.render("text").split())
    assert "1200" in text and "mm" in text and "th2 = th + 180 deg" in text and "u = 0 mm stays" in text
    assert "u within 1000000 mm of the start" in text


def test_a_family_that_is_out_of_balance_contradicts(column):
    """Q + J^T lam = 0 along the curve too: a point beside it fails."""
    (place, *_) = [place for place in column.places if place.curve is not None]
    assert balance_check([place]).ok
    place.curve.points[:, 2] += 0.01
    assert balance_check([place]).status == "fails"
    place.curve.points[:, 2] -= 0.01


@pytest.mark.parametrize(
    ("energy", "alone", "curves"),
    [
        ("(x^2 - 1)^4 + y^2", 2, 0),  # flat to third order at x = 1 and -1, both with V = 0, and alone
        ("(x^2 + y^2 - 1)^2", 1, 1),  # a ring, and the top of the hill
        ("(x^2 - 1)^2", 0, 0),  # y is held by nothing
    ],
)
def test_what_is_flat_is_a_family_only_where_it_goes_on(energy, alone, curves):
    """F(z) = 0 along z + h t: of V = (x^2 - 1)^4 there is no way from 1 to -1."""
    found = eomgen.statics(eomgen.loads(QUARTIC.replace("ENERGY", energy))).places
    assert sum(place.curve is not None for place in found) == curves
    if alone:
        assert sum(place.curve is None for place in found) >= alone
