"""What holds a system at rest is proven by its free bodies; section forces and extremes by what acts behind them."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import pytest
from slow_run import usual

import eomgen
from eomgen.mechanics.equilibrium.equations import StaticEquations
from eomgen.mechanics.free_bodies import velocity_plan as blocks
from eomgen.mechanics.statics.forces_in_sections import Extreme, SectionForces, SectionPiece
from eomgen.proof.check import Certificate
from eomgen.results.at_rest.result import statics
from eomgen.symbolic.expression.formula import over

pytestmark = pytest.mark.slow

MODELS = Path(__file__).parents[2] / "models"
HELD = "the multipliers at every equilibrium hold the free bodies"
BEHIND = "N, V and M are the same from the other end"
EXTREME = "where M has an extreme V is 0, within a part"
BLOCKS = "blocks of released structures move as one each, and differ"


def certificate_of(name: str) -> Certificate:
    return statics(eomgen.load(MODELS / f"{name}.toml")).certify()


def status(name: str, check: str) -> str:
    return next(each.status for each in certificate_of(name).checks if each.name == check)


@pytest.mark.parametrize("name", usual(["four_bar", "flyball_governor", "car_axis", "heavy_top"], 2))
def test_multipliers_at_rest_hold_the_free_bodies(name):
    """Q + J^T lam = 0, body by body."""
    assert status(name, HELD) == "holds"


def test_multipliers_of_the_wrong_sign_at_rest_are_seen(monkeypatch):
    """They balance the equations that they were found from, and no body."""
    forces = StaticEquations.forces.func

    def turned(self):
        return forces(replace(self, J=tuple(tuple(-x for x in row) for row in self.J)))

    monkeypatch.setattr(StaticEquations, "forces", property(turned))
    assert status("four_bar", HELD) == "fails"


def test_section_forces_are_proven_as_functions_of_the_place(monkeypatch):
    """M(x), not its coefficients."""
    own = SectionPiece.value
    assert status("gerber_beam", BEHIND) == status("gerber_beam", EXTREME) == "holds"
    monkeypatch.setattr(SectionPiece, "value", lambda self, kind, x: own(self, kind, x + self.start))
    assert status("gerber_beam", BEHIND) == "fails"


def test_an_extreme_beside_its_place_is_seen(monkeypatch):
    own = SectionForces.extremes.func
    monkeypatch.setattr(
        SectionForces, "extremes", property(lambda self: tuple(Extreme(e.x * 2, e.M) for e in own(self)))
    )
    assert status("gerber_beam", EXTREME) == "fails"


def test_a_block_that_turns_at_the_wrong_rate_is_seen(monkeypatch):
    """v = v_0 + w x r at both ends of a member; here w is r x (v_2 - v_1) / 2 r.r."""
    assert status("fink_truss", BLOCKS) == "holds"
    monkeypatch.setattr(blocks, "over", lambda a, b: over(a, 2 * b))
    assert status("fink_truss", BLOCKS) == "fails"
