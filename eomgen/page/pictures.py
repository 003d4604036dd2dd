"""Pictures of a report as files beside it."""

from __future__ import annotations

import tempfile
from dataclasses import field
from pathlib import Path

from eomgen.page.contents import ReportFigure
from eomgen.records import dataclass


@dataclass(frozen=True)
class Pictures:
    """Files beside the one of this name.

    Args:
        beside: the name of the report's file.
        ending: ".pdf", ".svg".
        drawn: content by name, of those that were named.
    """

    beside: str
    ending: str
    drawn: dict[str, str | bytes] = field(default_factory=dict)

    def name(self, drawing: ReportFigure) -> str:
        """The file of a drawing, which is made; "" where it cannot be a file."""
        if drawing.save is None:
            return ""
        name = f"{Path(self.beside).stem}-{drawing.key}{self.ending}"
        with tempfile.TemporaryDirectory() as folder:
            path = Path(folder) / name
            drawing.save(path)
            self.drawn[name] = path.read_bytes()
        return name
