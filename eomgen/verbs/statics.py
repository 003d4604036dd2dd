"""eomgen statics: every reaction of a structure at rest, by virtual work and by equilibrium; or the places of rest."""

from __future__ import annotations

from eomgen.model.parts import Model
from eomgen.report.statics.result import statics as found_in
from eomgen.verbs.outcome import Outcome, told


def statics_outcome(
    model: Model,
    *,
    plot: str | None = None,
    reaction: str | None = None,
    influence: str | None = None,
) -> Outcome:
    """Reactions, member forces, inner forces of a structure; of a system that is free to move, where it is at rest.

    Args:
        plot: a picture's file.
        reaction: the only one by virtual work.
        influence: of which the influence line is asked too.
    """
    found = found_in(model, reaction=reaction, influence=influence)
    return told(found, plot=plot)
