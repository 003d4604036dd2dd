"""eomgen statics: every reaction of a structure at rest, by virtual work and by equilibrium; or the places of rest."""

from __future__ import annotations

from eomgen.model.parts import Model
from eomgen.report.statics.result import statics as found_in
from eomgen.verbs.outcome import Outcome, proven, told


def statics_outcome(
    model: Model,
    *,
    plot: str | None = None,
    reaction: str | None = None,
    influence: str | None = None,
    certify: bool = True,
) -> Outcome:
    """Reactions, member forces, inner forces of a structure; of a system that is free to move, where it is at rest.

    Args:
        plot: a picture's file.
        reaction: the only one by virtual work.
        influence: of which the influence line is asked too.
        certify: whether it is proven.
    """
    found = found_in(model, reaction=reaction, influence=influence)
    return proven(told(found, plot=plot), found.certify() if certify else None)
