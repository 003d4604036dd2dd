"""Report -> one HTML file that loads nothing from elsewhere: light and dark, on a screen of any width, on paper."""

from __future__ import annotations

import re
from collections.abc import Callable, Sequence
from html import unescape
from itertools import chain, zip_longest

from eomgen.documents import (
    Catalogue,
    Cell,
    Code,
    Document,
    DocumentSetter,
    Formula,
    Grid,
    Group,
    Lines,
    Piece,
    Prose,
    Step,
    display_blocks,
    formula_text,
    grouped,
    key_of,
    piece_latex,
    setter_of,
    side_latex,
    with_listings_typeset,
)
from eomgen.errors import ToolMissing
from eomgen.files import json_text
from eomgen.page.contents import Attachment, Report, ReportFigure, ReportSection
from eomgen.page.markup import (
    Html,
    element,
    html,
    in_a_row,
    in_a_script,
    mathml,
    own_text,
    packed,
    page_style,
    script,
    style,
)
from eomgen.page.packing import table_bytes, with_far_copies
from eomgen.proof import SIGNS, Certificate
from eomgen.symbolic.print import PAPER, PHONE
from eomgen.version import __version__

BEGIN, END = "\\begin{aligned}\n", "\n\\end{aligned}"
FIT = 0.95  # of its room that a formula takes whose letters are made smaller for it
SMALLEST = 0.45  # letters of a formula that a narrow page shows whole, as a share of the others
LARGEST = 1.5  # pixels of a point of a picture
DIGITS = 9  # of the numbers of a table that a page offers: as many as a run is sure of
_NUMBER = re.compile(r"(-?)(\d+(?:[.,]\d+)?)(?:e([-+]\d+))?")
_TEX = r'<annotation encoding="application/x-tex">(.*?)</annotation>'
_DISPLAY = re.compile(rf'(<math display="block">.*?{_TEX}.*?</math>)', re.DOTALL)
_DRAWN = re.compile(r"(?<=<figure )([^<]*<svg [^>]*)>((?:(?!</svg>).)*)</svg>", re.DOTALL)
_COPIED = re.compile(r' data-copy="([^"]+)"')
LARGE = 3000  # marks of a picture: it is carried packed
_POWER = re.compile(r"\^\(?(-?\d+)\)?")
MINUS = "\N{MINUS SIGN}"


def html_page(report: Report) -> str:
    """The report as a page."""
    setter, language = setter_of(report.as_document), report.head.language
    title = report.head.title
    sections = [element_of(setter, section, report) for section in report.sections]
    shown, apart = _set_apart(element("main", *sections))
    body = (
        element("header", *_head(report)),
        shown,
        element("footer", element("p", *_made(report))),
        element("template", packed(json_text(apart).encode()), id="apart"),
        script(f"{in_a_script(own_text('player/columns.mjs'))}\n{own_text('page.js')}"),
    )
    head = (
        element("meta", charset="utf-8"),
        element("meta", name="viewport", content="width=device-width, initial-scale=1"),
        element("meta", name="color-scheme", content="light dark"),
        element("meta", name="generator", content=f"eomgen {__version__}"),
        element("title", title),
        style(page_style()),
    )
    page = element(
        "html",
        element("head", *head),
        element("body", *body, data_copied=language.say("copied")),
        lang=language.language,
    )
    return f"<!doctype html>\n{page}\n"


def _set_apart(shown: Html) -> tuple[Html, dict[str, list[str]]]:
    """(the page without its long parts, which are carried packed in a fifth of the size or less; these parts in order).

    Formulas that stand alone, as MathML: who runs no program reads their LaTeX. Large pictures: their words are left.
    The text that a button copies. A program of the page puts each in its place.
    """
    parts = _DISPLAY.split(shown)
    texts = (element("pre", Html(rf"\[{tex}\]"), class_="tex") for tex in parts[2::3])
    formulas, pictures, copied = parts[1::3], list[str](), list[str]()
    shown = Html("".join(chain(*zip_longest(parts[::3], texts, fillvalue=""))))

    def empty(found: re.Match[str]) -> str:
        if len(found[2]) < LARGE:
            return found[0]
        pictures.append(found[2])
        return f'{found[1]} data-drawn="{len(pictures) - 1}"></svg>'

    def uncopied(found: re.Match[str]) -> str:
        copied.append(unescape(found[1]))
        return f' data-copied="{len(copied) - 1}"'

    shown = Html(_COPIED.sub(uncopied, _DRAWN.sub(empty, shown)))
    return shown, {"formulas": formulas, "pictures": pictures, "copied": copied}


def _head(report: Report) -> list[Html]:
    head, certificate = report.head, report.certificate
    parts = [element("h1", head.title)]
    parts += [element("p", head.about, class_="about")] if head.about else []
    parts += [element("p", head.source_words, class_="source")] if head.source else []
    parts += [element("p", head.wrong, class_="wrong", role="alert")] if head.wrong else []
    links = [element("li", element("a", section.title, href=f"#{section.key}")) for section in report.sections]
    parts.append(element("nav", element("ul", *links), aria_label=head.language.say("Sections")))
    if certificate is not None and certificate.ok:
        held = sum(check.status == "holds" for check in certificate.checks)
        parts.insert(
            1,
            element(
                "p", element("a", head.language.say(f"✓ proven by {held} checks"), href="#certificate"), class_="proven"
            ),
        )
    return parts


def _made(report: Report) -> list[str]:
    origin = f" from {report.origin}" if report.origin else ""
    say = report.head.language.say
    return [say(f"Made by eomgen {__version__}{origin}."), " ", say("This page needs no network.")]


def element_of(setter: DocumentSetter, section: ReportSection, report: Report) -> Html:
    """A section of the page."""
    inside: list[Html] = [element("h2", section.title)]
    inside += [element("p", section.remark, class_="remark")] if section.remark else []
    for step in section.steps:
        inside += step_html(setter, step, titled=step.title != section.title)
    inside += [drawing_html(setter, drawing) for drawing in section.drawings]
    inside += [_live(section.live, report.head.language)] if section.live else []
    inside += [_attachments(section.attachments, _computed(report))] if section.attachments else []
    if section.key == "certificate" and report.certificate is not None:
        inside.append(_certificate(report.certificate, report.head.language.say))
    return element("section", *inside, id=section.key)


def _live(live: Callable[[], Html], language: Catalogue) -> Html:
    """Player of a motion; or a remark that says what to install for it."""
    try:
        return live()
    except ToolMissing as error:
        return element("p", language.say(f"Not here: {error.what}; {error.fix}."), class_="remark")


def step_html(setter: DocumentSetter, step: Step, *, titled: bool = True) -> list[Html]:
    """A step of a derivation, its title above it."""
    heading = [element("h3", step.title)] if step.title and titled else []
    room = [element("div", class_="room", style=f"height: {step.room}cm")] if step.room else []
    return [*heading, *(_group(setter, group) for group in grouped(step.statements)), *room]


def document_html(document: Document, wanted: Callable[[Step], bool] = lambda step: True) -> Html:
    """The steps of a document, those that are wanted, as a part of a page."""
    document = with_listings_typeset(document)
    setter = setter_of(document)
    return in_a_row(*(part for step in document.steps if wanted(step) for part in step_html(setter, step)))


def _group(setter: DocumentSetter, group: Group) -> Html:
    if isinstance(group, list):
        return _formulas(setter, group)
    if isinstance(group, Prose):
        return element("p", *(piece_html(setter, piece) for piece in group.pieces))
    if isinstance(group, Lines):
        return _scrolled(element("pre", "\n".join(group.lines)), setter.language.say("text"))
    return _table(setter, group if isinstance(group, Grid) else group.grid)


def _formulas(setter: DocumentSetter, formulas: Sequence[Formula]) -> Html:
    """Formulas below one another, which can be copied as LaTeX and as text of the grammar.

    Where a narrow page needs other lines they stand there twice: the style sheet shows those that fit.
    """
    wide, narrow = (display_blocks(setter, formulas, line) for line in (PAPER, PHONE))
    text = "\n".join(map(formula_text, formulas))
    say = setter.language.say
    buttons = (
        element("button", "LaTeX", type="button", data_copy="", aria_label=say("Copy as LaTeX")),
        element("button", say("text"), type="button", data_copy=text, aria_label=say("Copy as text")),
    )
    shown = in_a_row(*(mathml(block, display=True) for block in wide))
    if wide != narrow or any(map(_fit, narrow)):
        fitted = (element("div", mathml(block, display=True), style=_fit(block)) for block in narrow)
        shown = in_a_row(element("div", shown, class_="wide"), element("div", *fitted, class_="narrow"))
    shown = _scrolled(shown, say("formula"))
    return element("div", shown, element("span", *buttons, class_="copy"), class_="formula")


def _fit(tex: str) -> str | None:
    """The style of what cannot be broken for a narrow page, whose letters are smaller there; None where it fits."""
    rows = [row.partition("&") for row in tex.removeprefix(BEGIN).removesuffix(END).split(" \\\\\n")]
    lead = max(PHONE.width(left) for left, mark, _ in rows if mark) if rows[0][1] else 0.0
    widest = max(PHONE.width(right) + lead if mark else PHONE.width(left) for left, mark, right in rows)
    share = FIT * PHONE.room / widest if widest else FIT  # of a formula without a sign nothing is set
    return f"--fit: {max(SMALLEST, share):.2f}" if share < FIT else None


def _scrolled(inside: Html, what: str) -> Html:
    """Box for content that may be wider than the screen: it scrolls by itself, by keys too."""
    return element("div", inside, class_="scroll", tabindex="0", role="group", aria_label=what)


def piece_html(setter: DocumentSetter, piece: Piece) -> Html:
    """One piece of a sentence."""
    if isinstance(piece, str):
        return html(piece)
    if isinstance(piece, Code):
        return element("code", piece.text)
    tex = piece_latex(setter, piece, str)[1:-1]
    fit = _fit(tex)
    return Html(mathml(tex).replace("<math", f'<math style="{fit}"', 1)) if fit else mathml(tex)


def _table(setter: DocumentSetter, grid: Grid) -> Html:
    units = [key_of(head) == "unit" for head in grid.head]
    numbers = [
        bool(grid.rows)
        and all(isinstance(row[k], str) and _NUMBER.match(str(row[k])) for row in grid.rows if row[k] != "")
        for k in range(len(grid.head))
    ]
    head = element("tr", *(element("th", _cell(setter, cell, False), scope="col") for cell in grid.head))
    rows = [
        element(
            "tr",
            *(
                element("td", _cell(setter, cell, unit), class_="number" if number else None)
                for cell, unit, number in zip(row, units, numbers, strict=True)
            ),
        )
        for row in grid.rows
    ]
    return _scrolled(element("table", element("thead", head), element("tbody", *rows)), setter.language.say("table"))


def _cell(setter: DocumentSetter, cell: Cell, is_unit: bool) -> Html:
    if not isinstance(cell, str):
        return mathml(side_latex(setter, cell))
    return unit_html(cell) if is_unit else number_html(cell)


def unit_html(unit: str) -> Html:
    """kg*m^2 as kg·m²."""
    pieces = _POWER.split(unit)
    return in_a_row(
        *(
            element("sup", piece.replace("-", MINUS)) if k % 2 else html(piece.replace("*", "·"))
            for k, piece in enumerate(pieces)
        )
    )


def number_html(text: str) -> Html:
    """A number with its minus and its power of ten set; other words as they are."""
    found = _NUMBER.fullmatch(text)
    if found is None:
        return html(text)
    sign, digits, power = found.groups()
    scale = [" · 10", element("sup", str(int(power)).replace("-", MINUS))] if power else []
    return in_a_row(MINUS if sign else "", digits, *scale)


def drawing_html(setter: DocumentSetter, drawing: ReportFigure) -> Html:
    """A picture with its legend, in the colours of the page."""
    legend = [
        element(
            "li",
            element("svg", element("path", d="M0 5H22", class_=curve.style), viewBox="0 0 22 10", aria_hidden="true"),
            *(piece_html(setter, piece) for piece in curve.name.pieces),
        )
        for curve in drawing.legend
    ]
    wide = f"max-width: {LARGEST * drawing.size[0]:.0f}px" if drawing.fixed else None
    picture = svg(drawing, role="img", aria_label=drawing.caption, style=wide)
    caption = element("figcaption", drawing.caption, *([element("ul", *legend)] if legend else []))
    return element("figure", picture, caption, class_="fixed" if drawing.fixed else "drawn")


def svg(drawing: ReportFigure, **attributes: str | None) -> Html:
    """A drawing as an element of SVG."""
    width, height = drawing.size
    return element("svg", drawing.marks, viewBox=f"0 0 {width:g} {height:g}", **attributes)


def _attachments(files: Sequence[Attachment], computed: frozenset[str]) -> Html:
    """Links to files that the page carries, packed; a program of the page unpacks the one that is clicked.

    Args:
        computed: columns that the player of the page gives: a table is carried without them.
    """
    rows = []
    for file in files:
        if isinstance(file.content, bytes):
            reported, size, content = None, f" ({max(1, round(len(file.content) / 1024))} KB)", file.content
        else:
            carried = {name: column for name, column in file.content.items() if name not in computed}
            reported, size, content = json_text(tuple(file.content)), "", table_bytes(carried, DIGITS)
        named = {"data_name": file.name, "data_media": file.media, "data_columns": reported}
        link = element("a", file.name, href="#downloads", data_packed=packed(with_far_copies(content)), **named)
        rows.append(element("li", link, f"{size}: {file.about}"))
    return element("ul", *rows, class_="files")


def _computed(report: Report) -> frozenset[str]:
    """The columns that a player in the page computes: none where there is no player."""
    for section in report.sections:
        try:
            if section.live:
                section.live()
                return section.computed
        except ToolMissing:
            pass
    return frozenset()


def _certificate(certificate: Certificate, say: Callable[[str], str]) -> Html:
    rows = [
        element(
            "tr",
            element("td", SIGNS[check.status], class_=check.status),
            element("td", say(check.name), f": {check.detail}" if check.detail else ""),
            element("td", say(check.how)),
        )
        for check in certificate.checks
    ]
    head = element("tr", *(element("th", word, scope="col") for word in ("", say("what was checked"), say("how"))))
    return _scrolled(element("table", element("thead", head), element("tbody", *rows)), "certificate")
