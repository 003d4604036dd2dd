"""A result -> its document."""

from __future__ import annotations

from collections.abc import Iterable

from eomgen.documents.document import Document
from eomgen.documents.result import Result


def shown(found: Result, *, plot: str | None = None, certify: bool = True) -> Document:
    """What is found, proven where that is asked for, its picture in a file where one is."""
    if plot is not None:
        found.plot(plot)
    return found.document.proven(found.certify() if certify else None)


def listed(names: Iterable[str]) -> str:
    """Names in a line of text."""
    return ", ".join(names) or "none"
