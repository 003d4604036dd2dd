"""Result -> its document, with notes on the changes of its start."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import replace
from typing import TYPE_CHECKING

from eomgen.documents import Document, Result, proven
from eomgen.errors import DerivationError, ModelError, OpenConstraints, Problem
from eomgen.mechanics.dynamics import System
from eomgen.mechanics.start import Start, start_of_motion
from eomgen.model import Model
from eomgen.study import study_of

if TYPE_CHECKING:
    from eomgen.simulation import Trajectory


def shown(found: Result, *, plot: str | None = None, certify: bool = True) -> Document:
    """Document of a result, with its proof where that is requested; its picture is saved where a file is given."""
    panels = () if plot is None else found.picture.saved(plot)
    certificate = found.certify() + found.drawn_checks(panels) if certify else None
    document = proven(found.document, certificate)
    over = getattr(found, "over", None)  # the range of a picture
    return document if over is None else replace(document, taken=(*document.taken, over.taken))


def with_start_reported(document: Document, model: Model, run: Trajectory | None = None) -> Document:
    """The document with a note on the changes where its model could not start as it is written; a warning where
    nothing closes its constraints.

    Args:
        run: the motion that it reports: that nothing moves is a note too.
    """
    if run is not None and run.still:
        document = replace(document, notes=(*document.notes, run.still))
    if not (model.coordinates and model.constraints):
        return document
    try:
        words = _begun(model).words
    except OpenConstraints as error:
        return with_open_constraints(document, error)
    except (DerivationError, ModelError):  # reported by the verb, where it needs a start
        return document
    return replace(document, notes=(*document.notes, f"The start was {words}.")) if words else document


def with_constraints_closed(document: Document, system: System) -> Document:
    """The document of a result that needs no start; with a warning where nothing closes the constraints near it."""
    try:
        start_of_motion(system)
    except OpenConstraints as error:
        return with_open_constraints(document, error)
    except (DerivationError, ModelError):  # reported by the verbs that need a start
        pass
    return document


def with_open_constraints(document: Document, error: OpenConstraints) -> Document:
    """The document with a warning that nothing closes the constraints of its model near the start."""
    return replace(document, cautions=(*document.cautions, Problem(error.where, error.what, fix=error.fix)))


def named_open(model: Model, error: OpenConstraints) -> OpenConstraints:
    """The same error with the constraint that stays open at the start and by how much, where that can be found."""
    try:
        _begun(model)
    except OpenConstraints as exact:
        return exact
    except (DerivationError, ModelError):
        pass
    return error


def _begun(model: Model) -> Start:
    return start_of_motion(study_of(model).system)


def listed(names: Iterable[str]) -> str:
    """Names in a line of text."""
    return ", ".join(names) or "none"
