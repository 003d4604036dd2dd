"""The formats of a report by the ending of its file: Markdown, LaTeX, notebooks.

The formats of a report, by the ending of its file: each gives the files, by name, that are written.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from typing import Any

from eomgen.documents import markdown_blocks, markdown_escaped, setter_of
from eomgen.errors import RunFailed, ToolMissing, UsageError, visible
from eomgen.files import json_text
from eomgen.page.contents import Report, ReportSection
from eomgen.page.figure import Pictures
from eomgen.page.html import html_page
from eomgen.page.paper import pdf_of
from eomgen.page.tex import tex_files
from eomgen.symbolic.print import Setter

# -------- marked ----------------------------------------------------------------------------------------------
# Report -> Markdown with formulas between dollars, its pictures next to it.


def markdown_files(report: Report, name: str) -> Mapping[str, str | bytes]:
    """The report as Markdown, under this name, and its pictures as SVG."""
    setter, pictures = setter_of(report.as_document), Pictures(name, ".svg")
    blocks = markdown_head(report)
    for section in report.printed:
        blocks += section_markdown(setter, section, report)
        for drawing in section.drawings:
            file = pictures.name(drawing)
            blocks += (
                [f"![{markdown_escaped(drawing.caption)}](<{file}>)", markdown_escaped(drawing.caption)] if file else []
            )
    return {name: "\n\n".join(blocks) + "\n", **pictures.drawn}


def markdown_head(report: Report) -> list[str]:
    """The title, and the remarks to be read first."""
    head = report.head
    blocks = [f"# {markdown_escaped(head.title)}"]
    blocks += [f"**{markdown_escaped(head.wrong)}**"] if head.wrong else []
    blocks += [markdown_escaped(head.about)] if head.about else []
    return [*blocks, f"Source: {markdown_escaped(head.source)}."] if head.source else blocks


def section_markdown(setter: Setter, section: ReportSection, report: Report) -> list[str]:
    """A section, without its pictures."""
    blocks = [f"## {section.title}"]
    blocks += [f"*{markdown_escaped(section.remark)}*"] if section.remark else []
    for step in section.steps:
        blocks += [f"### {markdown_escaped(step.title)}"] if step.title not in ("", section.title) else []
        blocks += markdown_blocks(setter, step.statements)
    if section.key == "certificate" and report.certificate is not None:
        blocks.append(f"```\n{report.certificate}\n```")
    return blocks


# -------- formats ---------------------------------------------------------------------------------------------


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
        name: of the file; others stand next to it.
    """
    found = FORMATS[form](report, name)
    return {path: visible(text) if isinstance(text, str) and path == name else text for path, text in found.items()}


# -------- notebook --------------------------------------------------------------------------------------------
# Report -> a notebook that was run: the text of the report, and the calls that give it.


CALLS = {
    "derivation": "equations = eomgen.derive(model{values})\nequations",
    "statics": "eomgen.statics(model{values}).picture",
    "kinematics": "eomgen.kinematics(model{values}).picture",
    "inertia": "eomgen.inertia(model{values})",
    "outputs": "answers = eomgen.solve(model{values})\nanswers",
    "linearize": "small = eomgen.linearize(model{values})\nsmall.picture",
    "plots": "run = eomgen.simulate(model, time={time!r}{values})\nrun",
    "certificate": "equations.certify()",
}
"""What a section is found by."""
WAIT = 120  # seconds for a cell


def notebook_text(report: Report) -> str:
    """The notebook, its cells run in a kernel of their own.

    Raises:
        UsageError: the model has no text that a notebook could hold.
        ToolMissing: the program that runs notebooks is not installed.
        RunFailed: a cell fails.
    """
    if not report.source:
        raise UsageError(
            "a notebook holds the text of its model, and this one was made in Python", fix="write an .html"
        )
    try:
        import nbformat
        from nbclient import NotebookClient
        from nbclient.exceptions import CellExecutionError
    except ImportError as error:
        fix = "pip install 'eomgen[notebook]'; or write a .md or .html"
        raise ToolMissing("a notebook is run by nbclient, which is not installed", "", fix) from error
    v4: Any = nbformat.v4
    made = {True: v4.new_code_cell, False: v4.new_markdown_cell}
    cells = [
        made[is_code](text if is_code else visible(text), id=f"c{k}")
        for k, (is_code, text) in enumerate(_cells(report))
    ]
    kernel = {"kernelspec": {"name": "python3", "display_name": "Python 3", "language": "python"}}
    notebook = v4.new_notebook(cells=cells, metadata=kernel)
    try:
        NotebookClient(notebook, timeout=WAIT, kernel_name="python3", record_timing=False).execute()
    except CellExecutionError as error:
        raise RunFailed(
            f"a cell of the notebook fails: {error.ename}: {error.evalue}", fix="write an .html or .md"
        ) from error
    return json_text(notebook, indent=1, sort_keys=True, ensure_ascii=False) + "\n"


def _cells(report: Report) -> Iterator[tuple[bool, str]]:
    """(whether it is code, text) of each cell."""
    setter, keys = setter_of(report.as_document), [section.key for section in report.sections]
    yield False, "\n\n".join(markdown_head(report))
    other = f"values = {dict(report.values)!r}  # in place of those of the text\n" if report.values else ""
    yield True, f"import eomgen\n\nmodel = eomgen.loads({_quoted(report.source)}, {report.origin!r})\n{other}model"
    for section in report.printed:
        yield False, "\n\n".join(section_markdown(setter, section, report))
        if section.key in CALLS and not section.remark and (section.key != "certificate" or "derivation" in keys):
            call = CALLS[section.key] if section.drawings else CALLS[section.key].removesuffix(".picture")
            yield True, call.format(time=report.time, values=", **values" if report.values else "")


def _quoted(text: str) -> str:
    """A text as a literal over its lines, with any content."""
    plain = text.isprintable() or all(c.isprintable() or c == "\n" for c in text)
    if plain and '"""' not in text and "\\" not in text and not text.endswith('"'):
        return f'"""{text}"""'
    return repr(text)
