"""Report -> Markdown with formulas between dollars, its pictures beside it."""

from __future__ import annotations

from collections.abc import Mapping

from eomgen.documents.latex import setter_of
from eomgen.documents.latex_math import Setter
from eomgen.documents.markdown import markdown_blocks, markdown_escaped
from eomgen.page.contents import Report, ReportSection
from eomgen.page.pictures import Pictures


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
    """The title, and what is to be known first."""
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
