"""Report -> a paper, set by Typst."""

from __future__ import annotations

import re
from collections.abc import Callable
from itertools import zip_longest

from eomgen.documents import (
    Cell,
    Code,
    Grid,
    Group,
    Lines,
    Piece,
    Prose,
    Side,
    display_blocks,
    grouped,
    key_of,
    piece_latex,
    setter_of,
    side_latex,
)
from eomgen.page.contents import INKS, Report, ReportFigure, ReportSection
from eomgen.page.html import svg
from eomgen.page.markup import element, in_a_row, style
from eomgen.proof import SIGNS, Certificate
from eomgen.symbolic.print import PAPER, Setter
from eomgen.version import __version__

WHOLE = 576.0  # points of a picture that is as wide as the text
TOGETHER = 5  # rows of a display that a page's end does not part
SHORT = 24  # rows of a table that stays on one page
WORDY = 24  # characters from which on a column of a table is as wide as there is room
INK = (
    "text{font-family:'New Computer Modern';font-size:11px;fill:#444}.axis{stroke:#ddd;fill:none}"
    ".zero{stroke:#888;fill:none}.curve{fill:none;stroke-width:1.4}"
    + "".join(f".c{k}{{stroke:{ink}}}" for k, ink in enumerate(INKS))
    + ".d1{stroke-dasharray:6 3}.d2{stroke-dasharray:2 2.5}.d3{stroke-dasharray:8 2.5 2 2.5}"
)
PREAMBLE = """#set page(paper: "a4", margin: (x: 24mm, top: 24mm, bottom: 26mm), numbering: "1")
#set text(font: "New Computer Modern", size: 10.5pt)
#set par(leading: 0.62em, spacing: 0.85em)
#show math.equation: set text(font: "New Computer Modern Math")
#let fitted(it) = layout(room => {
  let wide = measure(it).width
  if wide > room.width { scale(100% * (room.width / wide), reflow: true, origin: top + left, it) } else { it }
})
#show math.equation.where(block: true): set align(left)
#show math.equation.where(block: true): it => block(inset: (left: 1.4em, y: 0.25em), breakable: true, fitted(it))
#show math.equation.where(block: true): set block(breakable: true)
#show heading.where(level: 1): set text(size: 14pt)
#show heading.where(level: 1): set block(above: 1.9em, below: 0.9em)
#show heading.where(level: 2): set text(size: 10.5pt)
#show heading.where(level: 2): set block(above: 1.5em, below: 0.75em)
#show raw: set text(font: "DejaVu Sans Mono", size: 8.4pt)
#set table(stroke: none, inset: (x: 0pt, top: 3.4pt, bottom: 4.2pt), column-gutter: 1.6em)
#show table: set par(leading: 0.5em)
#show table.cell.where(y: 0): set text(size: 8.6pt, fill: luma(80))
"""


def pdf_of(report: Report) -> bytes:
    """The paper, in the letters that Typst brings."""
    import typst

    return bytes(typst.compile(typst_text(report).encode(), ignore_system_fonts=True))


def typst_text(report: Report) -> str:
    """The paper as Typst reads it."""
    setter, head = setter_of(report.as_document), report.head
    lines = [PREAMBLE, f"#set document(title: {string(head.title)}, date: none)"]
    lines.append(f"#text(size: 19pt, weight: 700, {string(head.title)})")
    lines += [f"#par(text(size: 11.5pt, {string(head.about)}))"] if head.about else []
    lines += [f"#par(text(size: 9pt, fill: luma(80), {string(head.source_words)}))"] if head.source else []
    lines += [f"#par(text(fill: rgb(160, 30, 20), weight: 700, {string(head.wrong)}))"] if head.wrong else []
    for section in report.printed:
        lines += _section(setter, section, report)
    origin = f" from {report.origin}" if report.origin else ""
    made = head.language.say(f"Made by eomgen {__version__}{origin}.")
    lines.append(f"#v(1em)\n#text(size: 8.5pt, fill: luma(80), {string(made)})")
    return "\n\n".join(lines) + "\n"


def _section(setter: Setter, section: ReportSection, report: Report) -> list[str]:
    lines = [f"#heading(level: 1, {string(section.title)})"]
    lines += [f"#emph({string(section.remark)})"] if section.remark else []
    for step in section.steps:
        lines += [f"#heading(level: 2, {string(step.title)})"] if step.title not in ("", section.title) else []
        groups = grouped(step.statements)
        for group, after in zip_longest(groups, groups[1:]):
            parts = _group(setter, group)
            kept = isinstance(group, Prose) and (isinstance(after, list) or (after is None and step.room))
            lines += [_kept_with_next(parts[0])] if kept else parts
        lines += [f"#rect(width: 100%, height: {step.room}cm, stroke: 0.4pt + luma(190))"] if step.room else []
    lines += [_drawing(setter, drawing) for drawing in section.drawings]
    proof = report.certificate if section.key == "certificate" else None
    return [*lines, _certificate(proof, report.head.language.say)] if proof is not None else lines


def _group(setter: Setter, group: Group) -> list[str]:
    if isinstance(group, list):
        return [_display(block) for block in display_blocks(setter, group)]
    if isinstance(group, Prose):
        return ["".join(_piece(setter, piece) for piece in group.pieces)]
    if isinstance(group, Lines):
        return [f"#raw(block: true, {string(chr(10).join(group.lines))})"]
    return [_table(setter, group if isinstance(group, Grid) else group.grid)]


def _kept_with_next(sentence: str) -> str:
    """Block for the sentence that introduces a formula: it stays on the formula's page."""
    return f"#block(sticky: true)[{sentence}]"


def _display(tex: str) -> str:
    """Formulas that stand alone: on one page, where they have few rows."""
    formula = f"$ {typst_math(tex)} $"
    return formula if tex.count(r"\\") >= TOGETHER else f"#block(breakable: false)[{formula}]"


def _piece(setter: Setter, piece: Piece) -> str:
    if isinstance(piece, str):
        return f"#{string(piece)}"
    return (
        f"#raw({string(piece.text)})"
        if isinstance(piece, Code)
        else f"${typst_math(piece_latex(setter, piece, str)[1:-1])}$"
    )


def _table(setter: Setter, grid: Grid) -> str:
    columns = ", ".join(_columns(setter, grid))
    units = [key_of(head) == "unit" for head in grid.head]
    head = "".join(f"{_cell(setter, cell, False)}, " for cell in grid.head)
    rows = "\n".join("".join(f"{_cell(setter, c, u)}, " for c, u in zip(row, units, strict=True)) for row in grid.rows)
    line = "table.hline(stroke: 0.7pt)"
    table = f"table(columns: ({columns},), {line}, table.header({head}table.hline(stroke: 0.4pt)),\n{rows}\n{line})"
    return f"#{table}" if len(grid.rows) > SHORT else f"#block(breakable: false, fitted({table}))"


def _columns(setter: Setter, grid: Grid) -> list[str]:
    """Widths of columns; in a wide table long columns of words share what the others leave."""
    formulas, words = [], []
    for column in zip(grid.head, *grid.rows, strict=True):
        words.append(max(len(cell) if isinstance(cell, str) else 0 for cell in column))
        formulas.append(max(0 if isinstance(cell, str) else _letters(setter, cell) for cell in column))
    longest = list(map(max, words, formulas))
    return [
        "1fr" if sum(longest) > 90 and each == most > WORDY else "auto"
        for each, most in zip(words, longest, strict=True)
    ]


def _letters(setter: Setter, side: Side) -> int:
    """Room of a formula in letters."""
    return round(2 * PAPER.width(side_latex(setter, side)))


def _cell(setter: Setter, cell: Cell, is_unit: bool) -> str:
    if not isinstance(cell, str):
        return f"[${typst_math(side_latex(setter, cell))}$]"
    if is_unit:
        return f"[{_unit(cell)}]"
    number = re.fullmatch(r"(-?)(\d+(?:[.,]\d+)?)(?:e([-+]\d+))?", cell)
    if number is None:
        return f"[#{string(cell)}]"
    digits = number[2].replace(",", '","')
    return f"[${number[1]}{digits}" + (f" dot.op 10^({int(number[3])})$]" if number[3] else "$]")


def _unit(unit: str) -> str:
    """kg*m^2 as kg·m², upright."""
    pieces = re.split(r"\^\(?(-?\d+)\)?", unit)
    return "".join(
        f"#super({string(piece.replace('-', chr(0x2212)))})" if k % 2 else f"#{string(piece.replace('*', '·'))}"
        for k, piece in enumerate(pieces)
    )


def _drawing(setter: Setter, drawing: ReportFigure) -> str:
    picture = svg_file(drawing)
    share = min(1.0, drawing.size[0] / WHOLE) if drawing.fixed else 1.0
    parts = [f'#align(center, image(bytes({string(picture)}), format: "svg", width: {100 * share:.0f}%))']
    for curve in drawing.legend:
        dash = svg_file(ReportFigure("", "", (22, 10), element("path", d="M0 5H22", class_=curve.style)))
        sample = f'box(baseline: -0.15em, image(bytes({string(dash)}), format: "svg", width: 1.9em))'
        parts.append(
            f"#box[#{sample}#h(0.4em){''.join(_piece(setter, piece) for piece in curve.name.pieces)}#h(1.2em)]"
        )
    caption = f"#text(size: 8.8pt, fill: luma(80), {string(drawing.caption)})"
    return f"#block(breakable: false, width: 100%)[{parts[0]}\n{caption}\\\n{' '.join(parts[1:])}]"


def svg_file(drawing: ReportFigure) -> str:
    """A drawing as a file of its own, on light paper."""
    inked = ReportFigure("", "", drawing.size, in_a_row(*(() if drawing.fixed else (style(INK),)), drawing.marks))
    width, height = drawing.size
    return svg(
        inked,
        xmlns="http://www.w3.org/2000/svg",
        xmlns_xlink="http://www.w3.org/1999/xlink",
        width=f"{width:g}",
        height=f"{height:g}",
    ).replace("xmlns-xlink", "xmlns:xlink")


def _certificate(certificate: Certificate, say: Callable[[str], str]) -> str:
    rows = [
        f"[#{string(SIGNS[check.status])}], "
        f"[#{string(say(check.name) + (f': {check.detail}' if check.detail else ''))}], [#{string(say(check.how))}],"
        for check in certificate.checks
    ]
    line = "table.hline(stroke: 0.7pt)"
    head = f"table.header([], [{say('what was checked')}], [{say('how')}], table.hline(stroke: 0.4pt))"
    body = "\n".join(rows)
    return (
        f"#text(size: 9pt, table(columns: (auto, 1.6fr, 1fr), column-gutter: 0.9em, {line}, {head},\n{body}\n{line}))"
    )


# -------- typst math ------------------------------------------------------------------------------------------
# Our LaTeX -> the mathematics of Typst, which sets papers without TeX: the same commands, one after the other.


TOKEN = re.compile(r"\\[a-zA-Z]+\*?|\\.|\d+(?:\.\d+|\{,\}\d+)?|[^\s]", re.DOTALL)
SMALL = (
    "alpha beta gamma delta epsilon zeta eta theta iota kappa lambda mu nu xi pi rho sigma tau upsilon phi chi psi"
    " omega varphi vartheta varepsilon varrho varpi varsigma varkappa"
).split()
LARGE = "Gamma Delta Theta Lambda Xi Pi Sigma Upsilon Phi Psi Omega".split()
GREEK = dict(zip(SMALL + LARGE, "αβγδϵζηθικλμνξπρστυϕχψωφϑεϱϖςϰΓΔΘΛΞΠΣΥΦΨΩ", strict=True))
NAMED = (
    "partial sum cdot times pm leq geq neq approx infty to int ldots cdots dots circ langle rangle ell nabla ast star"
    " bullet dagger parallel perp hbar prime vdots ddots"
).split()
TYPST_SIGNS = dict(zip(NAMED, "∂∑⋅×±≤≥≠≈∞→∫…⋯…∘⟨⟩ℓ∇∗⋆∙†∥⟂ℏ′⋮⋱", strict=True))
TYPST_SIGNS |= {"quad": "quad", "qquad": "quad quad", **dict.fromkeys(("lvert", "rvert", "mid"), r"\|")}
TYPST_SIGNS |= {"lbrace": r"\{", "rbrace": r"\}", "lbrack": r"\[", "rbrack": r"\]"}
WORDS = "sin cos tan sinh cosh tanh arcsin arccos arctan ln log exp min max sup inf lim det".split()
SPACES = {",": "thin", ":": "med", ";": "thick", " ": "thick", "!": ""}
ACCENTS = {"dot": "dot", "ddot": "dot.double", "dddot": "dot.triple", "vec": "arrow", "bar": "macron"}
ACCENTS |= {"hat": "hat", "widehat": "hat", "tilde": "tilde", "widetilde": "tilde", "overline": "overline"}
UPRIGHT = {"mathrm": "upright", "mathsf": "sans", "mathbf": "bold", "mathit": "italic", "mathcal": "cal"}
UPRIGHT |= {"operatorname": "op", "text": "", "textrm": ""}
DELIMITERS = {"pmatrix": '"("', "bmatrix": '"["', "vmatrix": '"|"', "matrix": "#none"}
ESCAPED = set("\\/#$\"_^&()[]{}|,;:`@~*'=")  # what means something to Typst


class UnknownCommand(ValueError):
    """A command that is none of ours."""


def typst_math(tex: str) -> str:
    """A formula between Typst's dollars.

    Raises:
        UnknownCommand: a command that is none of ours.
    """
    return _Reader(tex).until()


def string(text: str) -> str:
    """A text as Typst's string: nothing in it is markup."""
    return '"' + text.replace("\\", "\\\\").replace('"', '\\"').replace("\n", "\\n") + '"'


class _Reader:
    """Tokens, one after the other."""

    def __init__(self, tex: str) -> None:
        self._tex, self._place = tex, 0

    def _next(self) -> str | None:
        """The next token, and past it; None at the end."""
        found = TOKEN.search(self._tex, self._place)
        if found is None:
            return None
        self._place = found.end()
        return found[0]

    def _seen(self) -> str | None:
        place = self._place
        found = self._next()
        self._place = place
        return found

    def until(self, *ends: str) -> str:
        """Everything up to one of these tokens, which is taken."""
        parts: list[str] = []
        while (token := self._next()) is not None and token not in ends:
            parts.append(self._one(token))
        return " ".join(part for part in parts if part)

    def _one(self, token: str) -> str:
        if token in "_^" and len(token) == 1:
            return f"{token}({self._argument()})"
        if "{,}" in token:
            return string(token.replace("{,}", ","))  # a number with a decimal comma
        if token == "{":
            return self.until("}")
        if token == "&":
            return "&"
        if token == "\\\\":
            return "\\\n"
        if token.startswith("\\"):
            return self._command(token[1:])
        return f"\\{token}" if token in ESCAPED - {"=", "'", "*", ":"} else token

    def _argument(self) -> str:
        token = self._next()
        return "" if token is None else self._one(token)

    def _words(self) -> str:
        """Content of the next braces, as words."""
        return _plain(self._braces())

    def _set_words(self) -> str:
        """Words of the next braces, and what stands between dollars in them set: m/s$^2$."""
        parts = self._braces().split("$")
        set_parts = (typst_math(part) if k % 2 else string(_plain(part)) for k, part in enumerate(parts) if part)
        return " ".join(set_parts) or string("")

    def _braces(self) -> str:
        """Content of the next braces."""
        start = self._tex.index("{", self._place) + 1
        depth, place = 1, start
        while depth:
            place += 2 if self._tex[place] == "\\" else 1
            depth += {"{": 1, "}": -1}.get(self._tex[place - 1], 0) if self._tex[place - 2] != "\\" else 0
        self._place = place
        return self._tex[start : place - 1]

    def _command(self, name: str) -> str:
        if name in GREEK or name in TYPST_SIGNS:
            return GREEK.get(name) or TYPST_SIGNS[name]
        if name in WORDS:
            return name
        if name in SPACES:
            return SPACES[name]
        if name in ACCENTS:
            return f"{ACCENTS[name]}({self._argument()})"
        if name in ("mathrm", "mathsf") and SCRIPTED.match(self._tex, self._place):
            return f"{UPRIGHT[name]}({self._argument()})"
        if name in UPRIGHT:
            return f"{UPRIGHT[name]}({string(self._words())})" if UPRIGHT[name] else self._set_words()
        if name in STRUCTURES:
            return STRUCTURES[name](self)
        if len(name) == 1 and not name.isalnum():  # \_ \{ \%
            return f"\\{name}"
        raise UnknownCommand(f"\\{name}")

    def fraction(self, inline: bool = False) -> str:
        above, below = self._argument(), self._argument()
        whole = f"frac({above}, {below})"
        return f"inline({whole})" if inline else whole

    def root(self) -> str:
        return f"sqrt({self._argument()})"

    def grown(self) -> str:
        """\\left( ... \\right)"""
        opening = self._delimiter()
        inside = self.until("\\right")
        return f"lr({opening} {inside} {self._delimiter()})"

    def big(self) -> str:
        return f"lr(size: #130%, {self._delimiter()})"

    def _delimiter(self) -> str:
        token = self._next() or "."
        return "" if token == "." else self._one(token)

    def environment(self) -> str:
        """\\begin{aligned} ... \\end{aligned}"""
        name = self._words()
        inside = self.until("\\end")
        self._words()
        rows = [row.strip() for row in inside.split("\\\n")]
        if name == "aligned":
            return " \\\n".join(LEADING.sub(r'\1 "" \2', row) for row in rows)
        if name == "cases":
            return f"cases({', '.join(rows)})"
        if name in DELIMITERS:
            return f"mat(delim: {DELIMITERS[name]}, {'; '.join(row.replace('&', ',') for row in rows)})"
        raise UnknownCommand(f"\\begin{{{name}}}")


SCRIPTED = re.compile(r"\s*\{(?:[^{}\\]|\\.)*?[\^_]")  # letters of another type with an exponent or an index: m/s^2
LEADING = re.compile(r"^(& ?(?:quad)?) ([+-])")  # a sign that goes on with the row above stands apart from its term

STRUCTURES: dict[str, Callable[[_Reader], str]] = {
    "frac": _Reader.fraction,
    "tfrac": lambda reader: reader.fraction(inline=True),
    "dfrac": _Reader.fraction,
    "sqrt": _Reader.root,
    "left": _Reader.grown,
    **{name: _Reader.big for name in ("big", "bigl", "bigr")},
    "begin": _Reader.environment,
}


def _plain(tex: str) -> str:
    r"""The words of \mathrm{...} and \text{...}: escapes undone, Greek letters by themselves."""
    tex = re.sub(r"\\([a-zA-Z]+)(?:\{\})?", lambda found: GREEK.get(found[1]) or TYPST_SIGNS.get(found[1], ""), tex)
    return re.sub(r"\\(.)", r"\1", tex).replace("$", "").replace("^{", "^").replace("{", "").replace("}", "")
