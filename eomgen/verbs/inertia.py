"""eomgen inertia: mass, centre, tensors, principal axes, about points and axes."""

from __future__ import annotations

from eomgen.model.parts import Model
from eomgen.report.inertia.result import inertia as found_in
from eomgen.verbs.outcome import Outcome, proven, told


def inertia_outcome(
    model: Model,
    *,
    plot: str | None = None,
    bodies: tuple[str, ...] = (),
    about: str | None = None,
    axis: str | None = None,
    certify: bool = True,
) -> Outcome:
    """Masses, mass centres, moments and products of inertia, principal axes.

    Args:
        plot: a picture's file.
        bodies: only these.
        about: a point about which they are taken too.
        axis: "A,B", or x, y, z through that point.
        certify: whether it is proven.
    """
    found = found_in(model, bodies, about=about, axis=axis)
    return proven(told(found, plot=plot), found.certify() if certify else None)
