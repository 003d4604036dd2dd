"""eomgen doctor: the tools and optional packages that this machine has."""

from __future__ import annotations

import os
import platform
import shutil
from importlib import metadata

from eomgen.codegen import compiler
from eomgen.disk_cache import cache_folder
from eomgen.documents import Document, lines_document
from eomgen.errors import ToolMissing
from eomgen.page import ffmpeg
from eomgen.version import __version__

EXTRAS = {"formulas": "math-core", "PDF": "typst", "space": "jupyter-threejs-sage", "notebooks": "nbclient"}
"""What a page, a paper or a notebook takes -> the package that gives it."""


def doctor_document() -> Document:
    """Versions of the tools and packages that are there, and what is not possible without the missing ones."""
    rows: list[tuple[str, str | None]] = [("eomgen", __version__), ("python", platform.python_version())]
    for package in ("sympy", "numpy", "scipy", "matplotlib", "click", "platformdirs", "quicktions", "python-flint"):
        try:
            rows.append((package, metadata.version(package)))
        except metadata.PackageNotFoundError:
            rows.append((package, None))
    rows.append(("C compiler", compiler()))
    rows.append(("cache", _cache()))
    rows.append(("LaTeX", next(filter(None, map(shutil.which, ("pdflatex", "lualatex", "xelatex", "tectonic"))), None)))
    for what, package in EXTRAS.items():
        try:
            rows.append((what, f"{package} {metadata.version(package)}"))
        except metadata.PackageNotFoundError:
            rows.append((what, None))
    rows.append(("node", shutil.which("node")))
    rows.append(("ffmpeg", _ffmpeg()))
    lines = [f"{what:<12}  {found or 'not found' + _without(what)}" for what, found in rows]
    return lines_document(lambda: {"found": dict(rows)}, *lines)


def _without(what: str) -> str:
    """Consequence of a missing tool or package, and how to install it."""
    return {
        "C compiler": ": equations run in numpy, some 30 times slower; install cc or `pip install ziglang`",
        "cache": ": it cannot be written, code is compiled anew each time",
        "LaTeX": ": derivations are written as .tex, but cannot be typeset here",
        "formulas": ": no report as .html: pip install math-core",
        "PDF": ": no report as .pdf: pip install typst",
        "space": ": pages do not play motions in space: pip install 'eomgen[space]'",
        "notebooks": ": no report as .ipynb: pip install 'eomgen[notebook]'",
        "node": ": what runs in pages is not proven here, and not run by `--target javascript`",
        "ffmpeg": ": no .mp4, GIFs are written: pip install 'eomgen[video]'",
    }.get(what, f": pip install {what}")


def _ffmpeg() -> str | None:
    try:
        return ffmpeg()
    except ToolMissing:
        return None


def _cache() -> str | None:
    """The folder of compiled code, where it can be written."""
    place = cache_folder()
    if place is None:
        return None
    there = next(folder for folder in (place, *place.parents) if folder.exists())
    return str(place) if os.access(there, os.W_OK) else None
