"""A result -> its document; what its start had to become."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import replace
from typing import TYPE_CHECKING

from eomgen.documents.document import Document
from eomgen.documents.proven import proven
from eomgen.documents.result import Result
from eomgen.errors import DerivationError, ModelError
from eomgen.mechanics.equations.system import system_of
from eomgen.mechanics.initial_state.initial_state import start_of_motion
from eomgen.mechanics.statics.contacts_at_start import contacts_at_start
from eomgen.model.parts import Model

if TYPE_CHECKING:
    from eomgen.simulation.result import Trajectory


def shown(found: Result, *, plot: str | None = None, certify: bool = True) -> Document:
    """What is found, proven where that is asked for, its picture in a file where one is."""
    if plot is not None:
        found.plot(plot)
    document = proven(found.document, found.certify() if certify else None)
    over = getattr(found, "over", None)  # the range of a picture
    return document if over is None else replace(document, taken=(*document.taken, over.taken))


def with_start_told(document: Document, model: Model, run: Trajectory | None = None) -> Document:
    """The document with a note of what was changed where its model could not start as it is written.

    Args:
        run: the motion that it tells of: that nothing moves is a note too.
    """
    if run is not None and run.still:
        document = replace(document, notes=(*document.notes, run.still))
    if not (model.coordinates and model.constraints):
        return document
    try:
        words = start_of_motion(system_of(model, contacts_at_start(model).modes)).words
    except (DerivationError, ModelError):  # told by the verb, where it needs a start
        return document
    return replace(document, notes=(*document.notes, f"The start was {words}.")) if words else document


def listed(names: Iterable[str]) -> str:
    """Names in a line of text."""
    return ", ".join(names) or "none"
