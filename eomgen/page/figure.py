"""Pictures of matplotlib as figures of a report: a model at rest with its dimensions, and those of results."""

from __future__ import annotations

import re
import tempfile
from dataclasses import replace
from pathlib import Path

from eomgen.documents.figures import Picture
from eomgen.documents.rest_picture import rest_picture
from eomgen.documents.statics.picture import missing_values
from eomgen.model.parts import Model
from eomgen.page.contents import ReportFigure
from eomgen.page.markup import Html

SIZE = (8.0, 4.2)  # of the rest picture [inches]
_SVG = re.compile(r'<svg[^>]*viewBox="0 0 ([\d.]+) ([\d.]+)"[^>]*>(.*)</svg>', re.DOTALL)


def rest_figure(model: Model) -> ReportFigure:
    """A model where it starts, with its coordinates and lengths."""
    missing = missing_values(model)
    assumed = f"; drawn with {', '.join(missing)} = 1" if missing else ""
    where = "at the start" if model.coordinates else "as it stands"
    return figure_of(replace(rest_picture(model), size=SIZE, title=""), "figure", f"{model.name} {where}{assumed}.")


def figure_of(picture: Picture, key: str, caption: str) -> ReportFigure:
    """A picture as a figure: SVG of its own colours."""
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "picture.svg"
        picture.save(path)
        found = _SVG.search(path.read_text(encoding="utf-8"))
    assert found is not None
    size = float(found[1]), float(found[2])
    return ReportFigure(key, caption, size, Html(_lean(found[3])), save=picture.save, fixed=True)


def _lean(marks: str) -> str:
    """Without what says nothing to a browser: metadata and comments."""
    marks = re.sub(r"<metadata>.*?</metadata>|<!--.*?-->", "", marks, flags=re.DOTALL)
    return re.sub(r"\n\s*", "\n", marks)
