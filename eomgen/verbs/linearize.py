"""eomgen linearize: small motions about a place of rest or a steady motion."""

from __future__ import annotations

from eomgen.model.parts import Model
from eomgen.report.linearize.result import linearize as found_in
from eomgen.verbs.outcome import Outcome, told


def linearize(
    model: Model,
    *,
    format: str = "text",
    plot: str | None = None,
    about: str | None = None,
    coordinates: tuple[str, ...] = (),
) -> Outcome:
    """M, C, K, modes, stability.

    Args:
        format: text, latex, markdown or json.
        plot: a picture's file.
        about: "equilibrium", "start" or "steady".
        coordinates: only these.
    """
    return told(found_in(model, about, coordinates), format=format, plot=plot)
