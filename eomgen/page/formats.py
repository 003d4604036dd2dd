"""The formats of a report by the ending of its file: Markdown, LaTeX, notebooks.

The formats of a report, by the ending of its file: each gives the files, by name, that are written.
"""

from __future__ import annotations

from base64 import b64encode
from collections.abc import Callable, Iterator, Mapping
from dataclasses import replace
from typing import Any

from eomgen.documents import PREAMBLE, latex_blocks, markdown_blocks, markdown_escaped, setter_of
from eomgen.errors import RunFailed, ToolMissing, UsageError, visible
from eomgen.files import json_text
from eomgen.page.contents import Report, ReportFigure, ReportSection
from eomgen.page.figure import Pictures
from eomgen.page.html import html_page
from eomgen.page.paper import pdf_of
from eomgen.proof import Status
from eomgen.symbolic.print import Setter, latex_escaped
from eomgen.version import __version__

# -------- latex ----------------------------------------------------------------------------------------------
# Report -> LaTeX that compiles as it is, its pictures next to it.


GRAPHICS = "\\usepackage{graphicx}\n"
MARKS: dict[Status, str] = {"holds": r"$\surd$", "fails": r"$\times$", "unchecked": "?"}


def tex_files(report: Report, name: str) -> Mapping[str, str | bytes]:
    """The paper as LaTeX, under this name, and its pictures as PDF."""
    setter, head, pictures = setter_of(report.as_document), report.head, Pictures(name, ".pdf")
    lines = [f"% Made by eomgen {__version__}.", PREAMBLE + GRAPHICS + r"\begin{document}"]
    lines.append(rf"{{\LARGE\bfseries {latex_escaped(head.title)}\par}}\medskip")
    lines += [rf"\textbf{{{latex_escaped(head.wrong)}}}" + "\n"] if head.wrong else []
    lines += [latex_escaped(head.about) + "\n"] if head.about else []
    lines += [f"{latex_escaped(head.source_words)}\n"] if head.source else []
    for section in report.printed:
        lines += _section(setter, section, report, pictures)
    return {name: "\n".join([*lines, r"\end{document}"]) + "\n", **pictures.drawn}


def _section(setter: Setter, section: ReportSection, report: Report, pictures: Pictures) -> list[str]:
    lines = [rf"\section*{{{section.title}}}"]
    lines += [rf"\emph{{{latex_escaped(section.remark)}}}" + "\n"] if section.remark else []
    for step in section.steps:
        lines += [rf"\subsection*{{{latex_escaped(step.title)}}}"] if step.title not in ("", section.title) else []
        lines += latex_blocks(setter, step.statements)
        lines += [rf"\par\vspace*{{{step.room}cm}}"] if step.room else []
    for drawing in section.drawings:
        lines += _picture(drawing, pictures.name(drawing))
    if section.key == "certificate" and report.certificate is not None:
        say = report.head.language.say
        rows = [
            rf"\item[{MARKS[check.status]}] {latex_escaped(say(check.name))} [{latex_escaped(say(check.how))}]"
            + (f": {latex_escaped(check.detail)}" if check.detail else "")
            for check in report.certificate.checks
        ]
        lines += [r"\begin{itemize}\setlength{\itemsep}{0pt}", *rows, r"\end{itemize}"]
    return lines


def _picture(drawing: ReportFigure, name: str) -> list[str]:
    if not name:
        return []
    size = rf"width=\linewidth,height={0.4 if drawing.fixed else 0.8}\textheight,keepaspectratio"
    return [
        rf"\begin{{center}}\includegraphics[{size}]{{{name}}}\par\small {latex_escaped(drawing.caption)}\end{{center}}"
    ]


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
    return [*blocks, markdown_escaped(head.source_words)] if head.source else blocks


def section_markdown(setter: Setter, section: ReportSection, report: Report) -> list[str]:
    """A section, without its pictures."""
    blocks = [f"## {section.title}"]
    blocks += [f"*{markdown_escaped(section.remark)}*"] if section.remark else []
    for step in section.steps:
        blocks += [f"### {markdown_escaped(step.title)}"] if step.title not in ("", section.title) else []
        blocks += markdown_blocks(setter, step.statements)
        blocks += [f'<div style="height: {step.room}cm"></div>'] if step.room else []
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
    if not report.source and not report.is_open:
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
    for cell in cells if report.is_open else ():
        cell.update(_pictured(cell, report))
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
    if report.is_open:
        yield from _open_cells(report)
        return
    other = f"values = {dict(report.values)!r}  # in place of those of the text\n" if report.values else ""
    yield True, f"import eomgen\n\nmodel = eomgen.loads({_quoted(report.source)}, {report.origin!r})\n{other}model"
    for section in report.printed:
        yield False, "\n\n".join(section_markdown(setter, section, report))
        if section.key in CALLS and not section.remark and (section.key != "certificate" or "derivation" in keys):
            call = CALLS[section.key] if section.drawings else CALLS[section.key].removesuffix(".picture")
            yield True, call.format(time=report.time, values=", **values" if report.values else "")


def _open_cells(report: Report) -> Iterator[tuple[bool, str]]:
    """Cells of a sheet: its words, its pictures, and an empty cell where there is room for an answer."""
    setter = setter_of(report.as_document)
    for section in report.printed:
        pictures = [f"![{markdown_escaped(each.caption)}](attachment:{each.key}.png)" for each in section.drawings]
        written = [replace(step, room=0) for step in section.steps]
        if not any(step.room for step in section.steps):
            blocks = section_markdown(setter, replace(section, steps=tuple(written)), report)
            yield False, "\n\n".join([*blocks, *pictures])
            continue
        yield False, f"## {section.title}"
        for step in written:
            yield False, "\n\n".join(markdown_blocks(setter, step.statements))
            yield True, ""


def _pictured(cell: Any, report: Report) -> dict[str, Any]:
    """The pictures that a cell shows, as it carries them."""
    drawn = (each for section in report.sections for each in section.drawings if each.save is not None)
    shown = {f"{each.key}.png": each for each in drawn if f"(attachment:{each.key}.png)" in cell["source"]}
    found = {name: {"image/png": b64encode(each.drawn(".png")).decode()} for name, each in shown.items()}
    return {"attachments": found} if found else {}


def _quoted(text: str) -> str:
    """A text as a literal over its lines, with any content."""
    plain = text.isprintable() or all(c.isprintable() or c == "\n" for c in text)
    if plain and '"""' not in text and "\\" not in text and not text.endswith('"'):
        return f'"""{text}"""'
    return repr(text)
