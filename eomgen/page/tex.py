"""Report -> LaTeX that compiles as it is, its pictures next to it."""

from __future__ import annotations

from collections.abc import Mapping

from eomgen.documents import PREAMBLE, latex_blocks, setter_of
from eomgen.page.contents import Report, ReportFigure, ReportSection
from eomgen.page.figure import Pictures
from eomgen.proof import Status
from eomgen.symbolic.print import Setter, latex_escaped
from eomgen.version import __version__

GRAPHICS = "\\usepackage{graphicx}\n"
MARKS: dict[Status, str] = {"holds": r"$\surd$", "fails": r"$\times$", "unchecked": "?"}


def tex_files(report: Report, name: str) -> Mapping[str, str | bytes]:
    """The paper as LaTeX, under this name, and its pictures as PDF."""
    setter, head, pictures = setter_of(report.as_document), report.head, Pictures(name, ".pdf")
    lines = [f"% Made by eomgen {__version__}.", PREAMBLE + GRAPHICS + r"\begin{document}"]
    lines.append(rf"{{\LARGE\bfseries {latex_escaped(head.title)}\par}}\medskip")
    lines += [rf"\textbf{{{latex_escaped(head.wrong)}}}" + "\n"] if head.wrong else []
    lines += [latex_escaped(head.about) + "\n"] if head.about else []
    lines += [f"Source: {latex_escaped(head.source)}.\n"] if head.source else []
    for section in report.printed:
        lines += _section(setter, section, report, pictures)
    return {name: "\n".join([*lines, r"\end{document}"]) + "\n", **pictures.drawn}


def _section(setter: Setter, section: ReportSection, report: Report, pictures: Pictures) -> list[str]:
    lines = [rf"\section*{{{section.title}}}"]
    lines += [rf"\emph{{{latex_escaped(section.remark)}}}" + "\n"] if section.remark else []
    for step in section.steps:
        lines += [rf"\subsection*{{{latex_escaped(step.title)}}}"] if step.title not in ("", section.title) else []
        lines += latex_blocks(setter, step.statements)
    for drawing in section.drawings:
        lines += _picture(drawing, pictures.name(drawing))
    if section.key == "certificate" and report.certificate is not None:
        rows = [
            rf"\item[{MARKS[check.status]}] {latex_escaped(check.name)} [{latex_escaped(check.how)}]"
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
