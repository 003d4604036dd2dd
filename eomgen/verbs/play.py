"""eomgen play: the model alive in a page of its own."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from typing import Any

from eomgen.documents.document import Document, plain_document
from eomgen.documents.proven import proven
from eomgen.documents.statements import Lines
from eomgen.errors import UsageError
from eomgen.model.parts import Model
from eomgen.page import PlayerOptions, played, slider_ranges
from eomgen.verbs.outcome import with_start_reported


def play_document(
    model: Model,
    *,
    output: str,
    time: float | None,
    sliders: tuple[str, ...],
    trail: str,
    forces: bool,
    speed: float,
    certify: bool = True,
) -> Document:
    """Writes the page; the document describes its content."""
    ranges, taken = slider_ranges(model, sliders)
    options = PlayerOptions(ranges, True, trail, forces, speed)
    found = played(model, time, options)
    found.write(output)

    def payload() -> dict[str, Any]:
        reported = found.played.reported()
        names = [slider["name"] for slider in reported["sliders"]]
        return {"name": model.name, "files": [output], "sliders": names, "rests": found.rests or None}

    run = found.played.run
    document = plain_document(model, payload, Lines((output,)), failed="" if run.ok else run.message)
    document = replace(document, taken=taken, notes=tuple(filter(None, (found.rests, found.shorter))))
    return proven(with_start_reported(document, model, run), found.certify() if certify else None)


def refuse_other_endings(output: str) -> None:
    """Refuses a file name that is no page's.

    Raises:
        UsageError: the name does not end in .html.
    """
    if Path(output).suffix.lower() not in (".html", ".htm"):
        raise UsageError(f"no page can be written as '{output}'", fix="the ending is .html")
