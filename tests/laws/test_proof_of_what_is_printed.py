"""A derivation is proven as it is printed: its formulas, read back, hold along the motion."""

from __future__ import annotations

from pathlib import Path

import pytest

import eomgen
from eomgen.documents import reaction_values
from eomgen.documents.reading import Reader
from eomgen.documents.statements import Omitted
from eomgen.mechanics.integrals.first_integrals import FirstIntegrals
from eomgen.symbolic.expression.derivatives import order, substituted
from eomgen.symbolic.expression.formula import function
from eomgen.verbs.derive import derive_document

pytestmark = pytest.mark.slow

MODELS = Path(__file__).parents[2] / "models"
PRINTED = "printed formulas, read back, hold along the motion"
CONSTANT = "first integrals as they are printed stay constant along the motion"


def statuses(name: str) -> dict[str, str]:
    model = eomgen.load(next(MODELS.rglob(f"{name}.toml")))
    certificate = derive_document(model, method="lagrange", certify=True).certificate
    assert certificate is not None
    return {check.name: check.status for check in certificate.checks}


@pytest.mark.parametrize(
    "name", ["bead_on_turning_hoop", "four_bar", "rough_incline", "ch22_p1", "chaplygin_sleigh", "elastic_pendulum"]
)
def test_printed_derivations_hold_along_the_motion(name):
    assert statuses(name)[PRINTED] == "holds"


def test_a_parameter_with_the_letter_of_an_energy_is_itself():
    """V is the rate of the luffing boom, and not the potential energy."""
    assert statuses("slewing_crane")[PRINTED] == "holds"


def test_a_formula_that_gets_wrong_on_the_way_to_the_page_is_seen(monkeypatch):
    """The equations are right, what is printed of them is not: cos where sin stood."""
    own = Reader.shown

    def shown(self, x):
        found = own(self, x)
        sines = [] if isinstance(found, Omitted) else [node for node in order((found,)) if node.op == "sin"]
        return substituted((found,), {node: function("cos", node.args[0]) for node in sines})[0]

    monkeypatch.setattr(Reader, "shown", shown)
    assert statuses("simple_pendulum")[PRINTED] == "fails"


def test_a_printed_reaction_is_worth_what_the_balance_of_all_bodies_gives(monkeypatch):
    """A letter that one formula defines is known by a second way: a couple without the lever arm of its force."""
    own = reaction_values.reactions_by_sides
    monkeypatch.setattr(reaction_values, "reactions_by_sides", lambda balance: dict.fromkeys(own(balance), 0))
    assert statuses("block_on_wedge")[PRINTED] == "fails"


@pytest.mark.parametrize("name", ["ch18_p5", "car_axis"])
def test_a_side_of_a_joint_hangs_on_the_ground_by_what_presses_there_too(name):
    """A string over a peg, a constraint between coordinates: what they do to the ground is not balanced among the
    bodies."""
    assert statuses(name)[PRINTED] == "holds"


def test_a_printed_integral_that_does_not_stay_is_seen(monkeypatch):
    """u . dT/du - 2 T + V"""
    own = FirstIntegrals.jacobi.fget

    def jacobi(integrals):
        found = own(integrals)
        return None if found is None else (found[0] - integrals.equations.T, *found[1:])

    monkeypatch.setattr(FirstIntegrals, "jacobi", property(jacobi))
    assert statuses("bead_on_turning_hoop")[CONSTANT] == "fails"


def test_a_sum_of_parts_that_is_not_the_whole_is_not_printed():
    """T + V with a part left out stays the whole, in a form of its own."""
    graph = eomgen.derive(eomgen.load(MODELS / "elastic_pendulum.toml")).graph
    reader, whole = Reader(), graph.T + graph.V
    assert reader.as_sum(whole, [graph.T]) is whole
