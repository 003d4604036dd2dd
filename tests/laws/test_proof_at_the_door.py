"""No verb contradicts itself on a model of this house: what it gives is as its second way says, or it refuses.

By default an eighth of the models of models/; all of them by

    EOMGEN_ALL_MODELS=1 python -m pytest -q tests/laws/test_proof_at_the_door.py
"""

from __future__ import annotations

from pathlib import Path

import pytest
from slow_run import sampled, usual

import eomgen
from eomgen.documents.document import Document
from eomgen.documents.proven_documents import proven, proven_for_machines
from eomgen.errors import EomgenError

MODELS = sorted((Path(__file__).parents[2] / "models").rglob("*.toml"))
REQUESTED = usual(MODELS, 12, 5)
VERBS = ("inertia", "kinematics", "linearize", "statics")


def document(verb: str, path: Path) -> Document | None:
    """With all proofs that a command makes; None where the verb has no answer to such a model."""
    try:
        found = getattr(eomgen, verb)(eomgen.load(path))
        return proven_for_machines(proven(found.document, found.certify()))
    except EomgenError:
        return None


@sampled(2)
@pytest.mark.slow
@pytest.mark.parametrize("path", REQUESTED, ids=lambda path: path.stem)
def test_nothing_that_leaves_is_contradicted(path: Path):
    found = {verb: document(verb, path) for verb in VERBS}
    assert any(found.values()), "every model is a question to one of them"
    assert not {verb: str(each.certificate) for verb, each in found.items() if each is not None and each.distrust}


@pytest.mark.slow
def test_small_motions_about_a_change_point_are_refused():
    """Bricard's loop comes to rest folded, where its constraints leave two degrees of freedom to first order and no
    motion has both."""
    with pytest.raises(EomgenError, match="the place is a change point"):
        eomgen.linearize(MODELS[0].parent / "bricard.toml")
