"""eomgen kinematics: velocities, accelerations and centres of rotation at an instant."""

from __future__ import annotations

from collections.abc import Sequence

from eomgen.documents import nearest_name
from eomgen.errors import ModelError, UsageError
from eomgen.model import Model, WrittenEquation
from eomgen.results import Kinematics, kinematics


def kinematics_requested(
    model: Model,
    *,
    at: WrittenEquation | None = None,
    given: Sequence[WrittenEquation] = (),
    relative: Sequence[str] = (),
) -> Kinematics:
    """The motion at one instant.

    Args:
        at: the instant, an equation; None: the start, or the one configuration.
        given: velocities besides those of the model: "omega(crank) = 2".
        relative: points as they are seen from moving bodies: "P in disc".
    Raises:
        UsageError: no equation; no such point or body.
    """
    pairs = tuple(_pair(model, text) for text in relative)
    try:
        return kinematics(model, at, given=given, relative=pairs)
    except ModelError as error:
        if not given:
            raise
        raise UsageError(f"--given: {error.what}", fix=error.fix) from error


def _pair(model: Model, text: str) -> tuple[str, str]:
    """(point, body) of "P in disc".

    Raises:
        UsageError: it is not written so, or there is no such point or body.
    """
    point, word, body = (part.strip() for part in text.partition(" in "))
    if not word:
        raise UsageError(f'--relative "{text}" is no point in a body', fix='write --relative "bead.center in hoop"')
    if body not in model.bodies:
        raise UsageError(f"--relative: there is no body '{body}'", fix=nearest_name(body, model.bodies))
    if point not in model.named_points:
        raise UsageError(f"--relative: there is no point '{point}'", fix=nearest_name(point, model.named_points))
    return point, body
