"""Report, its files -> checks: read again they say what the report holds; curves and tables are the run's.

The report's text by the reader of the output of `derive`; every curve by the numbers at its axes; of a table the page
carries each column by its name.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Iterator, Mapping, Sequence
from functools import partial

import numpy as np

from eomgen.documents import (
    HOW,
    Formula,
    PageComparison,
    PageLine,
    Wanted,
    flat,
    formula_said,
    spoken,
    wanted_of,
)
from eomgen.model import Unit
from eomgen.page.contents import Report, ReportSection
from eomgen.page.formats import FilesByName
from eomgen.page.reports_read import (
    ReadCurves,
    ReadReport,
    columns_reported,
    html_report,
    latex_report,
    markdown_report,
    notebook_report,
)
from eomgen.proof import Check, Tally, checked
from eomgen.simulation import Trajectory
from eomgen.symbolic.numeric import NoValue, tolerances

CURVES = "curves and tables of the report, read back, are those of the run"
BY_AXES = "by the numbers at their axes and the names of columns"
LOOKS = 32  # of curves, eight colours and four kinds of lines: with so many each has its own
SEEN = 1.5  # units of a picture: a curve may pass its points by that much, corners and rounding together
_BRACKETS = str.maketrans("", "", "[],;")  # a matrix by rows or whole, cases apart
_FEW = re.compile(r"the largest, at (\d+) of (\d+)")
_UNIT = re.compile(r" \[([^\]]*)\]")
NameOf = Callable[[str], str]
"""formula of LaTeX -> name of the symbol that it is"""
READERS: Mapping[str, Callable[[str], ReadReport]] = {
    ".html": html_report,
    ".tex": latex_report,
    ".md": markdown_report,
    ".ipynb": notebook_report,
}


def report_read_back(report: Report, files: FilesByName, form: str, run: Trajectory | None) -> Iterator[Check]:
    """Checks that the files of a report say what it holds.

    Args:
        form: the ending; only texts are read.
        run: whose curves and columns they show.
    """
    if form not in READERS:
        return
    text = next(iter(files.values()))
    assert isinstance(text, str)
    try:
        read = READERS[form](text)
    except (ValueError, KeyError, IndexError, StopIteration) as error:
        yield checked("the page, read back, says what was found", f"nobody can read it: {error}", HOW)
        return
    comparison = PageComparison(report.as_document, laws=form != ".html")
    wanted = list(_wanted(report, form))
    yield from comparison.checks(wanted, read.blocks)
    if form == ".html":
        formulas = [each for each in wanted if each.kind == "formula"]
        narrow = PageComparison(report.as_document, laws=False).checks(formulas, read.narrow)
        yield from (check for check in narrow if check.status == "fails")
        yield from _copied(report, read)
        yield from _carried(report, read)
    if run is not None and len(run.t):
        yield from _of_run(report, comparison.name_set, read, run)


def _wanted(report: Report, form: str) -> Iterator[Wanted]:
    """Elements that the file of a report has to hold, in order."""
    head = report.head
    yield Wanted("heading", (head.title,))
    if form == ".html" and report.certificate is not None and report.certificate.ok:
        held = sum(check.ok is True for check in report.certificate.checks)
        yield Wanted("words", (head.language.say(f"✓ proven by {held} checks"),))
    about = [Wanted("words", (head.about,))] if head.about else []
    source = [Wanted("words", (head.source_words,))] if head.source else []
    wrong = [Wanted("words", (head.wrong,))] if head.wrong else []
    yield from (*about, *source, *wrong) if form == ".html" else (*wrong, *about, *source)
    for section in report.sections if form == ".html" else report.printed:
        yield from _of_section(section, report, form)


def _of_section(section: ReportSection, report: Report, form: str) -> Iterator[Wanted]:
    yield Wanted("heading", (section.title,))
    if section.remark and section.live is None:
        yield Wanted("words", (section.remark,))
    for step in section.steps:
        if step.title not in ("", section.title):
            yield Wanted("heading", (step.title,))
        for statement in step.statements:
            yield from wanted_of(statement)
    for drawing in section.drawings if form != ".ipynb" else ():
        if form == ".html" or drawing.save is not None:
            yield Wanted("words", (drawing.caption,))
    if section.key == "certificate" and report.certificate is not None:
        yield from _of_proof(report, form)


def _of_proof(report: Report, form: str) -> Iterator[Wanted]:
    assert report.certificate is not None
    checks, say = report.certificate.checks, report.head.language.say
    if form == ".html":
        signs = {"holds": "✓", "fails": "✗", "unchecked": "?"}
        rows = [(signs[c.status], say(c.name) + (f": {c.detail}" if c.detail else ""), say(c.how)) for c in checks]
        yield Wanted("table", rows=(("", say("what was checked"), say("how")), *rows))
    elif form == ".tex":
        for c in checks:
            yield Wanted("words", (f"{say(c.name)} [{say(c.how)}]" + (f": {c.detail}" if c.detail else ""),))
    else:
        yield Wanted("lines", lines=tuple(str(report.certificate).split("\n")))


def _copied(report: Report, read: ReadReport) -> Iterator[Check]:
    """Check that the text which a button copies says the formulas next to it."""
    formulas = [
        statement
        for section in report.sections
        for step in section.steps
        for statement in step.statements
        if isinstance(statement, Formula)
    ]
    said = "".join(flat(formula_said(each)) for each in formulas).translate(_BRACKETS)
    found = "".join(flat(text) for text, _ in read.copied).translate(_BRACKETS)
    wrong = "" if said == found else "another formula is copied"
    yield checked("formulas, copied as text, are those of the page", wrong, "texts of the grammar")


def _carried(report: Report, read: ReadReport) -> Iterator[Check]:
    """A contradiction where a file that the page carries packed is, unpacked, another one; else nothing."""
    found = {name: content for name, content, _ in read.files}
    files = (file for section in report.sections for file in section.attachments)
    other = [file.name for file in files if isinstance(file.content, bytes) and found.get(file.name) != file.content]
    if other:
        yield checked("files that the page carries are those that were made", ", ".join(other), "unpacked, every byte")


# -- curves and tables ---------------------------------------------------------------------------------------------


def _of_run(report: Report, name_of: NameOf, read: ReadReport, run: Trajectory) -> Iterator[Check]:
    tally, legends = Tally(CURVES, BY_AXES), dict(read.legends)
    for caption, lines in read.legends:
        styles = [style for style, _ in lines]
        alike = len(set(styles)) < len(styles) <= LOOKS
        tally.add(f"legend of {caption[:30]}", partial(str, "curves that look alike" if alike else ""))
    for caption, curves in read.drawings:
        named = {style: _named(line, name_of) for style, line in legends.get(caption, ())}
        tally.add(caption.partition(" over")[0], partial(_unlike_curves, run, caption, curves, named))
        if (few := _FEW.search(caption)) is not None and int(few[1]) >= int(few[2]):
            tally.add(few[0], partial(str, "that is all of them"))
    if read.drawings and not any("not drawn" in words or "the largest" in words for words in legends):
        tally.add("drawings", partial(_left_out, run, legends, name_of))
    for name, content, columns in read.files:
        if name.endswith(".csv"):
            tally.add(name, partial(_unlike_table, run, content, columns))
        elif name.endswith(".toml"):
            tally.add(name, partial(_other_text, content, report.source))
    return tally.checks()


def _left_out(run: Trajectory, legends: Mapping[str, Sequence[tuple[str, PageLine]]], name_of: NameOf) -> str:
    """First coordinate or reaction without a curve; "" if all have one."""
    drawn = {spoken(_named(line, name_of)) for named in legends.values() for _, line in named}
    known = [*run.coordinates, *(name for name, column in run.reactions.items() if np.nan_to_num(column).any())]
    return next((f"no curve of {name}" for name in known if spoken(name) not in drawn), "")


def _other_text(content: bytes, right: str) -> str:
    return "" if content.decode() == right else "another text than the model's"


def _named(line: PageLine, name_of: NameOf) -> str:
    """The name of a column that a legend says."""
    if len(line) == 1 and line[0].tex:
        return name_of(line[0].tex)
    return "".join(part.character for part in line)


def _unlike_curves(run: Trajectory, caption: str, read: ReadCurves, named: Mapping[str, str]) -> str:
    """First curve that deviates from the column of its name, in the unit that the caption says; "" if none does."""
    if not np.isfinite(read.near).all():
        raise NoValue("numbers at an axis are alike")
    unit = _UNIT.search(caption)
    size = Unit.parse(unit[1].replace("·", "*")).size if unit is not None and unit[1] != "s" else 1.0
    columns = {spoken(name): column / size for name, column in run.columns().items()}
    energy = columns.pop("energy", None)
    if energy is not None:
        columns[""] = energy - energy[0] if "less its value" in caption else energy
    for style in dict.fromkeys(style for style, _ in read.curves):
        name = spoken(named.get(style, ""))
        if name not in columns:
            return f"a curve of '{name}'"
        pieces = [places for other, places in read.curves if other == style]
        if wrong := _off(run.t, columns[name], pieces, read.near):
            return f"{name or 'energy'}: {wrong}"
    absent = [name for name in named.values() if spoken(name) in columns and np.isfinite(columns[spoken(name)]).all()]
    drawn = {named.get(style) for style, _ in read.curves}
    return next((f"no curve of {name}" for name in absent if name not in drawn), "")


def _off(t: np.ndarray, y: np.ndarray, pieces: Sequence[np.ndarray], near: tuple[float, float]) -> str:
    """First place where a curve deviates from the values, or these from it; "" if none."""
    finite = np.isfinite(y)
    if not finite.any():
        return "there are no values"
    dt, dy = (SEEN * each for each in near)
    for piece in pieces:
        low, high = _around(t[finite], y[finite], piece[:, 0], dt)
        apart = np.maximum(low - piece[:, 1], piece[:, 1] - high)
        if np.any(apart > dy):
            k = int(np.argmax(apart))
            return f"{piece[k, 1]:.4g} for {low[k]:.4g} to {high[k]:.4g} at t = {piece[k, 0]:.4g} s"
    over = np.concatenate(pieces)
    if finite.all() and (over[0, 0] > t[0] + dt or over[-1, 0] < t[-1] - dt):
        return f"drawn from {over[0, 0]:.4g} to {over[-1, 0]:.4g} s"
    if len(pieces) == 1 and finite.all():
        low, high = _around(over[:, 0], over[:, 1], t, dt)
        apart = np.maximum(low - y, y - high)
        if np.any(apart > dy):
            return f"it does not pass {y[int(np.argmax(apart))]:.4g} at t = {t[int(np.argmax(apart))]:.4g} s"
    return ""


def _around(t: np.ndarray, y: np.ndarray, at: np.ndarray, dt: float) -> tuple[np.ndarray, np.ndarray]:
    """The least and the largest value of a line through (t, y) no more than dt from each place."""
    ends = np.stack([np.interp(at + step, t, y) for step in (-dt, 0.0, dt)])
    low, high = ends.min(axis=0), ends.max(axis=0)
    for k, (i, j) in enumerate(zip(np.searchsorted(t, at - dt), np.searchsorted(t, at + dt), strict=True)):
        if i < j:
            low[k], high[k] = min(low[k], y[i:j].min()), max(high[k], y[i:j].max())
    return low, high


def _unlike_table(run: Trajectory, content: bytes, columns: Sequence[str]) -> str:
    """Name of the first column of a table that is not the run's column of that name; "" if none."""
    right = run.columns()
    if list(columns) != list(right):
        return f"columns {', '.join(columns)}"
    for name, column in columns_reported(content).items():
        size = float(np.max(np.abs(right[name]), where=np.isfinite(right[name]), initial=0.0))
        if len(column) != len(run.t) or not np.allclose(
            column, right[name], 0, tolerances.NINE_DIGITS * size, equal_nan=True
        ):
            return name
    return ""
