"""Pictures of matplotlib as figures of a report: a model at rest with its dimensions, and those of results."""

from __future__ import annotations

import re
import tempfile
from collections import Counter
from dataclasses import replace
from pathlib import Path

from eomgen.documents.figures import Picture
from eomgen.documents.rest_picture import rest_picture
from eomgen.documents.statics.picture import missing_values
from eomgen.model.parts import Model
from eomgen.page.contents import ReportFigure
from eomgen.page.markup import Html
from eomgen.page.paths import stepped

OFTEN = 4  # times that a look is said before it has a name
_SVG = re.compile(r'<svg[^>]*viewBox="0 0 ([\d.]+) ([\d.]+)"[^>]*>(.*)</svg>', re.DOTALL)

_PATH = re.compile(r' d="([^"]*)"')
_CURVED = re.compile("[CQ]")
_ID = re.compile(r'( id="|href="#|url\(#)')
_STYLE = re.compile(r' style="([^"]*)"')
_FILL = re.compile(r' style="fill: (#\w+); (stroke: [^"]*; stroke-linecap: round)"')
"""A face: its shade, and an edge that it shares with others."""
_HALO = re.compile(
    r'<path d="([^"]*)" style="fill: (#\w+); stroke: #ffffff; stroke-width: ([\d.]+)"/>\s*'
    r'<path d="\1" style="fill: \2"/>'
)
"""A letter with its white edge, and the same letter again."""


def rest_figure(model: Model) -> ReportFigure:
    """A model where it starts, with its coordinates and lengths."""
    missing = missing_values(model)
    assumed = f"; drawn with {', '.join(missing)} = 1" if missing else ""
    where = "at the start" if model.coordinates else "as it stands"
    return figure_of(replace(rest_picture(model), title=""), "figure", f"{model.name} {where}{assumed}.")


def figure_of(picture: Picture, key: str, caption: str) -> ReportFigure:
    """A picture as a figure: SVG of its own colours."""
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "picture.svg"
        picture.save(path)
        found = _SVG.search(path.read_text(encoding="utf-8"))
    assert found is not None
    size = float(found[1]), float(found[2])
    return ReportFigure(key, caption, size, Html(_lean(found[3], key)), save=picture.save, fixed=True)


def _lean(marks: str, key: str) -> str:
    """Without what says nothing to a browser: metadata, comments, unseen digits, what is said again and again.

    Args:
        key: what the names in it begin with: no two figures of a page have the same.
    """
    marks = re.sub(r"<metadata>.*?</metadata>|<!--.*?-->", "", marks, flags=re.DOTALL)
    marks = _ID.sub(rf"\1{key}-", re.sub(r'<g id="[^"]*"', "<g", marks))
    marks = _PATH.sub(lambda found: f' d="{stepped(found[1], digits=2 if _CURVED.search(found[1]) else 1)}"', marks)
    marks = _HALO.sub(r'<path d="\1" style="fill: \2; stroke: #ffffff; stroke-width: \3; paint-order: stroke"/>', marks)
    marks = _FILL.sub(r' fill="\1" style="\2"', marks)
    looks = [look for look, times in Counter(_STYLE.findall(marks)).items() if times > OFTEN]
    names = {look: f"{key}-{k}" for k, look in enumerate(looks)}
    marks = _STYLE.sub(lambda found: f' class="{names[found[1]]}"' if found[1] in names else found[0], marks)
    rules = "".join(f".{name}{{{look}}}" for look, name in names.items())
    return (f"<style>{rules}</style>" if rules else "") + re.sub(r"\n\s*", "\n", marks)
