"""Machines as their engineers write them, each of features that rarely meet, against the oracle of the combinations.

Accelerations, determinate reactions and energies of every machine are those of maximal coordinates, at its start and at
states near it that keep every constraint; what `solve`, `reactions`, runs, small motions and code say of one quantity
is one
number, the oracle's.
"""

from __future__ import annotations

import sys
from pathlib import Path

import pytest
from slow_run import ALL, sampled, usual

sys.path.insert(0, str(Path(__file__).parents[1] / "combinations"))

import compare
import cross

import eomgen

MACHINES = {path.stem: path for path in sorted((Path(__file__).parent / "machines").glob("*.toml"))}
USUAL = (  # of every kind of feature one
    "balanced_arm", "bascule_bridge", "cable_robot", "cam_valve", "chairlift", "differential", "double_cardan",
    "geneva_drive", "governor_on_turntable", "quarter_car", "road_train", "screw_press", "stewart_on_ship",
    "washing_machine",
)  # fmt: skip
REQUESTED = [*MACHINES] if ALL else sorted({*USUAL, *[*MACHINES][::6]})


def test_there_are_thirty_machines_and_each_says_what_it_is():
    """A sentence on the first line of every file."""
    assert len(MACHINES) >= 30
    assert all(path.read_text(encoding="utf-8").startswith("# ") for path in MACHINES.values())


@sampled(3)
@pytest.mark.slow
@pytest.mark.parametrize("name", REQUESTED)
def test_a_machine_moves_as_free_bodies_do(name):
    """M z'' = F + J^T lam, J z'' + gamma = 0 in maximal coordinates: the same accelerations, reactions and energies."""
    found = compare.of_model(MACHINES[name].read_text(encoding="utf-8"), 1, count=1)
    assert found.numbers > 10
    assert not [x for x in found.skipped if x.startswith("oracle: ")]
    assert not found.faults


@sampled(3)
@pytest.mark.slow
@pytest.mark.parametrize("name", usual([*MACHINES], 8))
def test_what_is_said_of_a_machine_is_one_number_and_proven(name):
    """`solve`, `reactions`, a run's columns, eigenvalues, inverse dynamics against the oracle; a green certificate.

    Slow: every verb of large models, and the oracle of each number.
    """
    product = compare.product_of(MACHINES[name].read_text(encoding="utf-8"))
    found = cross.across(product)
    assert found.numbers
    assert not found.faults
    with compare.quiet():
        assert eomgen.derive(product.equations.model).certify().ok
