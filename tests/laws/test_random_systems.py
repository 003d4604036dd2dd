"""The certificate holds for random trees of bodies under random forces: systems that nobody has thought of.

By default a third of them; all by

    EOMGEN_ALL_MODELS=1 python -m pytest -q tests/laws/test_random_systems.py
"""

from __future__ import annotations

import pytest
from random_systems import random_model
from slow_run import sampled, usual

import eomgen
from eomgen.proof.check import Certificate

pytestmark = pytest.mark.slow


@sampled(2)
@pytest.mark.parametrize("seed", usual(range(30), 6))
@pytest.mark.parametrize("space", ["plane", "space"])
def test_the_certificate_holds_for_random_trees_with_ties(space, seed):
    """The same with a support or an equation that closes a loop."""
    text = random_model(space, 1000 + seed, constraints=1)
    certificate = certificate_of(text)
    assert certificate.ok, f"{certificate}\n{text}"


def certificate_of(text: str) -> Certificate:
    return eomgen.derive(eomgen.loads(text)).certify()


@sampled(3)
@pytest.mark.parametrize("seed", usual(range(60), 6))
@pytest.mark.parametrize("space", ["plane", "space"])
def test_the_certificate_holds_for_random_trees(space, seed):
    """Every joint and every force of this version, rheonomic or not, hung together at random."""
    text = random_model(space, seed)
    certificate = certificate_of(text)
    assert certificate.ok, f"{certificate}\n{text}"
