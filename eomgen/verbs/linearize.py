"""eomgen linearize: small motions about a place of rest or a steady motion."""

from __future__ import annotations

from eomgen.model.parts import Model
from eomgen.report.linearize.result import linearize as found_in
from eomgen.verbs.outcome import Outcome, proven, told


def linearize_outcome(
    model: Model,
    *,
    plot: str | None = None,
    about: str | None = None,
    coordinates: tuple[str, ...] = (),
    certify: bool = True,
) -> Outcome:
    """M, C, K, modes, stability.

    Args:
        plot: a picture's file.
        about: "equilibrium", "start" or "steady".
        coordinates: only these.
        certify: whether it is proven.
    """
    found = found_in(model, about, coordinates)
    return proven(told(found, plot=plot), found.certify() if certify else None)
