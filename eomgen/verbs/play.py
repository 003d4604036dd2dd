"""eomgen play: the model alive in a page of its own."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

from eomgen.documents import Document, Lines, plain_document, proven
from eomgen.model import Model
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
