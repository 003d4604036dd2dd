"""eomgen inertia: mass, centre, tensors, principal axes, about points and axes."""

from __future__ import annotations

from eomgen.model.parts import Model
from eomgen.report.inertia.result import inertia as found_in
from eomgen.verbs.outcome import Outcome, told


def inertia(
    model: Model,
    *,
    plot: str | None = None,
    bodies: tuple[str, ...] = (),
    about: str | None = None,
    axis: str | None = None,
) -> Outcome:
    """Masses, mass centres, moments and products of inertia, principal axes.

    Args:
        plot: a picture's file.
        bodies: only these.
        about: a point about which they are taken too.
        axis: "A,B", or x, y, z through that point.
    """
    return told(found_in(model, bodies, about=about, axis=axis), plot=plot)
