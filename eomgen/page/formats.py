"""The formats of a report, by the ending of its file: each gives the files, by name, that are written."""

from __future__ import annotations

from collections.abc import Callable, Mapping

from eomgen.errors import visible
from eomgen.page.contents import Report
from eomgen.page.html import html_page
from eomgen.page.marked import markdown_files
from eomgen.page.notebook import notebook_text
from eomgen.page.paper import pdf_of
from eomgen.page.tex import tex_files

FilesByName = Mapping[str, str | bytes]

FORMATS: dict[str, Callable[[Report, str], FilesByName]] = {
    ".html": lambda report, name: {name: html_page(report)},
    ".pdf": lambda report, name: {name: pdf_of(report)},
    ".tex": tex_files,
    ".md": markdown_files,
    ".ipynb": lambda report, name: {name: notebook_text(report)},
}
"""ending -> the files of a report, for the name of the first"""


def written_as(report: Report, form: str, name: str) -> FilesByName:
    """The files of a report by name.

    Args:
        form: the ending, one of FORMATS.
        name: of the file; others stand beside it.
    """
    found = FORMATS[form](report, name)
    return {path: visible(text) if isinstance(text, str) and path == name else text for path, text in found.items()}
