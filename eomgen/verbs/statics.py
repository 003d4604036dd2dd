"""eomgen statics: every reaction of a structure at rest, by virtual work and by equilibrium."""

from __future__ import annotations

from eomgen.errors import UsageError
from eomgen.mechanics.statics.rest_contacts import modes_at_rest
from eomgen.mechanics.system import system_of
from eomgen.model.parts import Model
from eomgen.report.statics.equilibrium_picture import plot_resting
from eomgen.report.statics.equilibrium_result import has_freedoms, resting_places
from eomgen.report.statics.picture import plot_statics
from eomgen.report.statics.result import statics as found_in
from eomgen.verbs.outcome import Outcome, listed


def statics(
    model: Model, *, format: str = "text", plot: str | None = None, reaction: str | None = None,
    influence: str | None = None,
) -> Outcome:  # fmt: skip
    """Reactions, member forces, inner forces of a structure.

    Args:
        format: text, latex, markdown or json.
        plot: a picture's file.
        reaction: the only one by virtual work.
        influence: of which the influence line is asked too.
    """
    system = system_of(model, modes_at_rest(model))
    if has_freedoms(system):
        resting = resting_places(model, system)
        _refuse_for_resting(reaction=reaction, influence=influence)
        if plot is not None:
            plot_resting(resting, plot)
        return Outcome("", resting.as_dict()) if format == "json" else Outcome(resting.render(format))
    found = found_in(model, reaction=reaction, influence=influence)
    if plot is not None:
        plot_statics(found, plot)
    wrong = [each.name for each in found.found.disagreeing]
    failed = f"virtual work and equilibrium do not agree: {listed(wrong)}" if wrong else "; ".join(found.broken)
    if format == "json":
        return Outcome("", found.as_dict(), failed)
    return Outcome(found.render(format), {}, failed)


def _refuse_for_resting(**asked: str | None) -> None:
    """Refuse what is asked of structures alone.

    Raises:
        UsageError: it is named.
    """
    for name, value in asked.items():
        if value is not None:
            raise UsageError(f"--{name} is of structures that stand, and this system is free to move",
                             mend="without it the places of rest are given")  # fmt: skip
