"""What is told of small motions is contradicted where it is another: matrices by their names, words, conditions."""

from __future__ import annotations

from typing import Any

import pytest

import eomgen
from eomgen.proof.reported_small_motions import linear_entries
from eomgen.symbolic.exact import one_variable as conditions

TURNING = """
eomgen = 1
space = "plane"
parameters = { m = 2, k = 4, c = 0.5, n = 1, h = 0.3 }
coordinates = { x = 0, y = 0 }
[inputs]
F = 0
[bodies.p]
shape = { kind = "particle", mass = "m" }
joint = { kind = "placed", at = ["x", "y"] }
[forces]
f = { kind = "generalized", coordinate = "x", value = "F - k*x - c*x' + n*y' + h*y" }
g = { kind = "generalized", coordinate = "y", value = "-2*k*y - c*y' - n*x' - h*x" }
"""
FADING, SWINGING = {}, {"h": 3.0}  # a follower force lets it grow


def wrong(reported: dict[str, Any], found: eomgen.Linearization) -> str:
    (check,) = linear_entries(reported, found.A, found.B)
    return check.detail


CHANGES = {
    "D for G": {"gyroscopic": "damping"},
    "E for F": {"kinematic_rates": "kinematic_places"},
    "K for C": {"stiffness": "rates"},
    "M for K": {"mass": "stiffness"},
}


@pytest.mark.parametrize("swap", CHANGES.values(), ids=CHANGES)
def test_a_matrix_under_another_name_is_contradicted(swap):
    """x' = A x + B_x w, A = [F E; -M^-1 K, -M^-1 C], C = D + G."""
    found = eomgen.linearize(eomgen.loads(TURNING))
    reported = found.entries()
    assert not wrong(reported, found)
    assert wrong({**reported, **{name: reported[other] for name, other in swap.items()}}, found)


@pytest.mark.parametrize("values", [FADING, SWINGING], ids=["fades", "grows"])
def test_words_of_motions_and_of_stability_are_those_of_the_eigenvalues(values):
    """grows: Re > 0; flutter: with Im != 0."""
    found = eomgen.linearize(eomgen.loads(TURNING), parameters=values)
    reported = found.entries()
    assert not wrong(reported, found)
    modes = reported["modes"]
    turned = {"grows": "fades", "fades": "grows"}
    other = [{**mode, "kind": " ".join(turned.get(word, word) for word in mode["kind"].split())} for mode in modes]
    assert wrong({**reported, "modes": other}, found)
    assert wrong({**reported, "modes": [{**modes[0], "hertz": modes[0]["hertz"] * 2}, *modes[1:]]}, found)
    assert wrong({**reported, "why": "an oscillation grows (flutter)" if not values else "(divergence)"}, found)
    assert wrong({**reported, "eigenvalues": reported["eigenvalues"][1:]}, found)


def test_a_condition_that_is_missing_is_seen_at_other_parameters(monkeypatch):
    """A Hurwitz determinant decides: all coefficients are positive where an oscillation grows."""
    monkeypatch.setattr(conditions, "_determinants", lambda polynomial: [])
    found = eomgen.linearize(eomgen.loads(TURNING))
    wrong = [check for check in found.certify().checks if check.ok is False]
    assert [check.name for check in wrong] == ["the conditions of stability hold where nothing grows, and only there"]


def test_a_frequency_of_another_number_is_contradicted(monkeypatch):
    """frequency(k) is the k-th Im of the eigenvalues of A."""
    from eomgen.mechanics.linearization.modes import Modes

    text = TURNING
    for gone in (" - c*x' + n*y' + h*y", " - c*y' - n*x' - h*x", ", c = 0.5, n = 1, h = 0.3"):
        text = text.replace(gone, "")
    text += '[outputs]\nw = "frequency(1)"\nv = "frequency(2)"\n'
    assert eomgen.solve(eomgen.loads(text)).certify().ok
    monkeypatch.setattr(Modes, "frequency", lambda self, k: self.frequencies[-k])
    assert eomgen.solve(eomgen.loads(text)).certify().ok is False


CRITICAL = """
eomgen = 1
space = "plane"
parameters = { m = 1, k = 100, c = 20 }
coordinates = { x = 0.1 }
[bodies.b]
shape = { kind = "particle", mass = "m" }
joint = { kind = "prismatic", axis = [1, 0], displacement = "x", stiffness = "k", damping = "c" }
"""
GUTTER = """
eomgen = 1
space = "plane"
parameters = { m = 2, r = 0.1, R = 0.5, g = 9.81 }
coordinates = { q = 0.5 }
[bodies.roller]
shape = { kind = "disc", mass = "m", radius = "r" }
joint = { kind = "placed", at = ["(R - r)*sin(q)", "-(R - r)*cos(q)"], angle = "-(R - r)*q/r" }
[constraints.gutter]
kind = "rolling"
body = "roller"
circle = { at = [0, 0], radius = "R", inside = true }
[forces.weight]
kind = "gravity"
acceleration = [0, "-g"]
"""


@pytest.mark.parametrize("text", [CRITICAL, GUTTER], ids=["a double eigenvalue with one mode", "a factor (R - r)^2"])
def test_what_is_right_is_not_contradicted(text):
    """-c/2m twice, c^2 = 4 k m: numpy's two lie apart by 1e-8; omega^2 = 2 g/(3 (R - r)) is said of R > r alone"""
    assert eomgen.linearize(eomgen.loads(text)).certify().ok
