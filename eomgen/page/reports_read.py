"""Report as it is written -> its content, by a reader that shares nothing with the writer.

A report is HTML, LaTeX, Markdown or a notebook; its content is a list of blocks in their order.

A page of HTML carries its large parts packed; they are unpacked here. Formulas in a line are read from their MathML,
displayed ones from the LaTeX that a page shows where no scripts run. Curves are read with their axes.
"""

from __future__ import annotations

import gzip
import json
import re
import unicodedata
from base64 import b64decode
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import field
from html.parser import HTMLParser

import numpy as np

from eomgen.documents import GREEK_LETTERS, PAGES, PageBlock, PageLine, PagePart, displayed, spoken
from eomgen.errors import visible
from eomgen.frozen import dataclass

_ACCENTS = {"\u02d9": r"\dot", "\u00a8": r"\ddot", "\u20db": r"\dddot", "~": r"\widetilde"}
_ACCENTS |= {"\u02c6": r"\hat", "\xaf": r"\bar", "\u02dc": r"\tilde", "\u20d7": r"\vec", "\u0302": r"\widehat"}
_STYLES = {"BOLD": r"\mathbf", "SANS-SERIF": r"\mathsf", "ITALIC": r"\mathit", "SCRIPT": r"\mathcal"}
_STYLED = re.compile(f"(?:MATHEMATICAL )?({'|'.join(_STYLES)}) (SMALL|CAPITAL|DIGIT) ([A-Z]+)$")
_SIGNS = {"\u2212": "-", "\u22c5": r"\cdot", "\u2061": "", "|": r"\rvert", "\u2264": r"\leq", "\u2202": r"\partial"}
_LETTERS = GREEK_LETTERS | {"\u03c6": r"\varphi", "\u03d5": r"\phi", "\u03b5": r"\varepsilon", "\u03f5": r"\epsilon"}
_VOID = frozenset(("br", "img", "input", "link", "meta"))
_FUNCTIONS = frozenset("sin cos tan sinh cosh tanh arcsin arccos arctan ln min max".split())
_OPERATORS = frozenset(("sign", "atan2"))
_BETWEEN = {"mtr": " & ", "mtable": r" \\ "}
_TABLES = {"{": "cases", "(": "pmatrix"}
_HEADINGS = frozenset(("h1", "h2", "h3"))
_STEP = re.compile(r"[a-zA-Z]|-?(?:\d+\.?\d*|\.\d+)(?:e[-+]?\d+)?")
_CAPTION = re.compile(r"\\begin\{center\}.*\\par\\small (.*)\\end\{center\}")
_ITEM = re.compile(r"\\item\[.*?\] (.*)")


@dataclass
class Markup:
    """An element of HTML with what is inside it."""

    tag: str
    given: dict[str, str] = field(default_factory=dict)
    inside: list[Markup | str] = field(default_factory=list)

    @property
    def elements(self) -> Iterator[Markup]:
        return (x for x in self.inside if isinstance(x, Markup))

    @property
    def text(self) -> str:
        """All words inside it."""
        return "".join(x if isinstance(x, str) else x.text for x in self.inside)

    def all(self, tag: str) -> Iterator[Markup]:
        """Every element of a kind below it."""
        for x in self.elements:
            if x.tag == tag:
                yield x
            yield from x.all(tag)


class _Builder(HTMLParser):
    def __init__(self) -> None:
        super().__init__()
        self.open = [Markup("")]

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        made = Markup(tag, {name: value or "" for name, value in attrs})
        self.open[-1].inside.append(made)
        if tag not in _VOID:
            self.open.append(made)

    def handle_startendtag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        self.open[-1].inside.append(Markup(tag, {name: value or "" for name, value in attrs}))

    def handle_endtag(self, tag: str) -> None:
        while len(self.open) > 1 and self.open.pop().tag != tag:
            pass

    def handle_data(self, data: str) -> None:
        self.open[-1].inside.append(data)


def markup_of(text: str) -> Markup:
    """A page, or a part of one, as its elements."""
    builder = _Builder()
    builder.feed(text)
    builder.close()
    return builder.open[0]


@dataclass(frozen=True)
class ReadCurves:
    """The curves of a drawing with its axes.

    Args:
        curves: of each class its path, n x 2, in the units of its axes.
        near: tolerance of a place along both axes: the size of a digit of the page.
    """

    curves: tuple[tuple[str, np.ndarray], ...]
    near: tuple[float, float]


@dataclass(frozen=True)
class ReadReport:
    """Content of a report as it is read back.

    Args:
        blocks: one after the other.
        copied: texts that a button copies, with the formulas next to it.
        drawings: the curves of each drawing that has some, by its caption.
        legends: of each drawing its curves by class and name.
        files: files that it carries: name, content, and the columns that are named.
        narrow: its displayed formulas as a narrow page has them.
    """

    blocks: tuple[PageBlock, ...]
    copied: tuple[tuple[str, tuple[PageBlock, ...]], ...] = ()
    drawings: tuple[tuple[str, ReadCurves], ...] = ()
    legends: tuple[tuple[str, tuple[tuple[str, PageLine], ...]], ...] = ()
    files: tuple[tuple[str, bytes, tuple[str, ...]], ...] = ()
    narrow: tuple[PageBlock, ...] = ()


def unpacked(text: str) -> bytes:
    """Bytes that a page carries packed: gzip, then base64."""
    return gzip.decompress(b64decode(text))


# -- HTML ----------------------------------------------------------------------------------------------------------


class _HtmlReading:
    """A page of HTML that is read."""

    def __init__(self, page: Markup) -> None:
        self.page = page
        apart = next(x for x in page.all("template") if x.given.get("id") == "apart")
        self.apart: dict[str, list[str]] = json.loads(unpacked(apart.text))
        self.blocks: list[PageBlock] = []
        self.copied: list[tuple[str, tuple[PageBlock, ...]]] = []
        self.drawings: list[tuple[str, ReadCurves]] = []
        self.legends: list[tuple[str, tuple[tuple[str, PageLine], ...]]] = []
        self.files: list[tuple[str, bytes, tuple[str, ...]]] = []
        self.narrow: list[PageBlock] = []
        self.shown = 0  # formulas that stood alone so far

    def whole(self) -> ReadReport:
        header, main = next(self.page.all("header")), next(self.page.all("main"))
        for each in header.elements:
            if each.tag != "nav":
                self._element(each)
        for section in main.elements:
            played = section.given.get("id") == "motion" and any(section.all("script"))
            for each in section.elements:
                if not (played and each.tag == "p"):  # words of a player of a motion
                    self._element(each)
        parts = (self.blocks, self.copied, self.drawings, self.legends, self.files, self.narrow)
        return ReadReport(*map(tuple, parts))  # type: ignore[arg-type]

    def _element(self, each: Markup) -> None:
        kind = each.given.get("class", "")
        if each.tag in _HEADINGS:
            self.blocks.append(PageBlock("heading", tuple(_line(each))))
        elif each.tag == "p":
            self.blocks.append(PageBlock("words", tuple(_line(each))))
        elif kind == "formula":
            self._formulas(each)
        elif kind == "scroll":
            self._scrolled(each)
        elif each.tag == "figure":
            self._figure(each)
        elif kind == "files":
            self.files += [_file(link) for link in each.all("a")]

    def _formulas(self, each: Markup) -> None:
        found, narrow = list[PageBlock](), list[PageBlock]()
        apart = {id(pre) for box in each.all("div") if box.given.get("class") == "narrow" for pre in box.all("pre")}
        for pre in each.all("pre"):
            tex = pre.text.removeprefix(r"\[").removesuffix(r"\]")
            annotated = next(markup_of(self.apart["formulas"][self.shown]).all("annotation")).text
            self.shown += 1
            if annotated != tex:
                raise ValueError("a formula is another where no scripts run")
            rows = displayed(tex.removeprefix("\\begin{aligned}\n").removesuffix("\n\\end{aligned}"))
            (narrow if id(pre) in apart else found).extend(rows)
        self.blocks += found
        self.narrow += narrow or found
        for button in each.all("button"):
            if number := button.given.get("data-copied"):
                self.copied.append((self.apart["copied"][int(number)], tuple(found)))
            elif text := button.given.get("data-copy"):
                self.copied.append((text, tuple(found)))

    def _scrolled(self, each: Markup) -> None:
        for inner in each.elements:
            if inner.tag == "table":
                rows = tuple(tuple(tuple(_line(cell)) for cell in row.elements) for row in inner.all("tr"))
                self.blocks.append(PageBlock("table", rows=rows))
            else:
                self.blocks.append(PageBlock("lines", lines=tuple(inner.text.split("\n"))))

    def _figure(self, each: Markup) -> None:
        caption = next(each.all("figcaption"))
        words = "".join(x for x in caption.inside if isinstance(x, str))
        self.blocks.append(PageBlock("words", tuple(PagePart(x) for x in spoken(words))))
        named = []
        for entry in caption.all("li"):
            style = next(entry.all("path")).given["class"]
            named.append((style, tuple(_line(Markup("", inside=[x for x in entry.inside if not _is_svg(x)])))))
        self.legends.append((words, tuple(named)))
        svg = next(each.all("svg"))
        number = svg.given.get("data-drawn")
        inside = svg if number is None else markup_of(self.apart["pictures"][int(number)])
        if each.given.get("class") == "drawn":
            self.drawings.append((words, curves_of(inside, svg.given["viewbox"])))


def _is_svg(x: Markup | str) -> bool:
    return isinstance(x, Markup) and x.tag == "svg"


def _file(link: Markup) -> tuple[str, bytes, tuple[str, ...]]:
    columns = link.given.get("data-columns")
    content = copies_undone(unpacked(link.given["data-packed"]))
    return link.text, content, tuple(json.loads(columns)) if columns else ()


def copies_undone(content: bytes) -> bytes:
    """Content of a file whose repetitions were replaced by copies of earlier bytes.

    The length of the list of copies stands first.

    Of each copy the new bytes before it, how far back it lies, its length; seven bits a byte, the lowest first.
    """
    octets, found = iter(content), bytearray()

    def number() -> int:
        value = shift = 0
        while (octet := next(octets)) > 127:
            value |= (octet & 127) << shift
            shift += 7
        return value | octet << shift

    numbers, left = list[int](), number()
    start = len(content) - octets.__length_hint__()  # type: ignore[attr-defined]
    while len(content) - octets.__length_hint__() < start + left:  # type: ignore[attr-defined]
        numbers.append(number())
    new = bytes(octets)
    k = 0
    for before, back, length in zip(numbers[::3], numbers[1::3], numbers[2::3], strict=True):
        found += new[k : k + before]
        k += before
        for _ in range(length):
            found.append(found[-back])
    return bytes(found) + new[k:]


def _line(each: Markup) -> Iterator[PagePart]:
    """Words and formulas of a line."""
    for x in each.inside:
        if isinstance(x, str):
            yield from (PagePart(c) for c in spoken(x))
        elif x.tag == "math":
            yield PagePart(tex=tex_of(x).strip())
        else:
            yield from _line(x)


def tex_of(math: Markup, *, index: bool = False) -> str:
    """MathML as the LaTeX that means it.

    Args:
        index: it is one: max is a word there and no function.
    """
    inner = list(math.elements)
    below = math.tag in ("msub", "msubsup")
    parts = [tex_of(x, index=index or (below and k == 1)) for k, x in enumerate(inner)]
    if math.tag in ("mi", "mn", "mo", "mtext"):
        return _letter(math.tag, math.text, index)
    if math.tag == "msub":
        return f"{parts[0]}_{{{parts[1]}}}"
    if math.tag == "msup":
        return f"{parts[0]}^{{{parts[1]}}}"
    if math.tag == "msubsup":
        return f"{parts[0]}_{{{parts[1]}}}^{{{parts[2]}}}"
    if math.tag == "mfrac":
        return rf"\frac{{{parts[0]}}}{{{parts[1]}}}"
    if math.tag == "msqrt":
        return rf"\sqrt{{{' '.join(parts)}}}"
    if math.tag == "mover":
        accent = inner[1].text
        wide = accent == "\xaf" and inner[1].given.get("stretchy") == "true"
        over = r"\overline" if wide else _ACCENTS.get(accent, accent)
        return f"{over}{{{parts[0]}}}"
    if math.tag in _BETWEEN:
        return _BETWEEN[math.tag].join(parts)
    if math.tag == "mrow" and len(parts) > 2:
        if inner[1].tag == "mtable" and parts[0] in _TABLES:
            return rf"\begin{{{_TABLES[parts[0]]}}}{parts[1]}\end{{{_TABLES[parts[0]]}}}"
        if parts[0] == parts[-1] == _SIGNS["|"]:
            parts[0] = r"\lvert"
    return "" if math.tag == "mspace" else " ".join(parts)


def _letter(tag: str, text: str, index: bool) -> str:
    if tag == "mtext":
        return rf"\text{{{text}}}"
    text = text.replace("\ufe00", "")  # of two shapes of a script letter the first
    styles = [found[1] for c in text if (found := _STYLED.match(_name(c)))]
    if tag == "mi" and text and len(styles) == len(text):
        plain = "".join(unicodedata.normalize("NFKC", c) for c in text)
        return f"{_STYLES[styles[0]]}{{{''.join(_LETTERS.get(c, c) for c in plain)}}}"
    if text in _FUNCTIONS and not index:
        return rf"\{text} "
    if text in _OPERATORS and not index:
        return rf"\operatorname{{{text}}}"
    if tag == "mo":
        return _SIGNS.get(text, text)
    if tag == "mi" and len(text) > 1:
        return rf"\mathrm{{{text}}}"
    return f"{_LETTERS[text]} " if text in _LETTERS else text


def _name(c: str) -> str:
    """Unicode name of a letter of a style; the italic h has another name there."""
    return "ITALIC SMALL H" if c == "\u210e" else unicodedata.name(c, "")


# -- curves --------------------------------------------------------------------------------------------------------


def curves_of(svg: Markup, box: str) -> ReadCurves:
    """The curves of a drawing, in the units that the numbers at its axes say.

    Args:
        box: its viewBox: 0 0, width and height.
    Raises:
        ValueError: a curve leaves it.
    """
    ticks: dict[str, list[tuple[float, float]]] = {"middle": [], "end": []}
    texts, lines = list(svg.all("text")), [x for x in svg.all("path") if x.given.get("class") == "axis"]
    for text, line in zip(texts, lines, strict=True):
        (x, y), _ = _path(line.given["d"])[0][:2]
        value = float(text.text.replace("\N{MINUS SIGN}", "-").replace(",", "."))  # a decimal comma
        ticks[text.given["text-anchor"]].append((x if text.given["text-anchor"] == "middle" else y, value))
    across, up = (_scale(ticks[name]) for name in ("middle", "end"))
    curves = []
    width, height = map(float, box.split()[2:])
    for path in svg.all("path"):
        style = path.given.get("class", "")
        if style.startswith("curve"):
            for places in _path(path.given["d"]):
                xy = np.array(places)
                if np.any(xy < 0) or np.any(xy > (width, height)):
                    raise ValueError("a curve leaves its drawing")
                curves.append((style, np.column_stack([across[0] + across[1] * xy[:, 0], up[0] + up[1] * xy[:, 1]])))
    return ReadCurves(tuple(curves), (abs(across[1]) + across[2], abs(up[1]) + up[2]))


def _scale(ticks: list[tuple[float, float]]) -> tuple[float, float, float]:
    """(value at 0, value of a unit of the picture, how far off it may be by the digits of the numbers)."""
    places, values = np.array(sorted(ticks)).T
    slope, zero = np.polyfit(places, values, 1) if len(places) > 1 else (0.0, values[0])
    off = float(np.max(np.abs(zero + slope * places - values)))
    if len(set(values)) < len(values):  # the places of equal numbers cannot be told apart
        off = np.inf
    return float(zero), float(slope), off


def _path(d: str) -> list[list[tuple[float, float]]]:
    """The lines of a path, each as its places."""
    found: list[list[tuple[float, float]]] = []
    words, k, command, x, y = _STEP.findall(d), 0, "", 0.0, 0.0
    while k < len(words):
        if words[k].isalpha():
            command, k = words[k], k + 1
            if command in "Zz":
                continue
        if command in "HhVv":
            step = float(words[k])
            x = (step if command == "H" else x + step) if command in "Hh" else x
            y = (step if command == "V" else y + step) if command in "Vv" else y
            k += 1
        else:
            dx, dy = float(words[k]), float(words[k + 1])
            x, y = (x + dx, y + dy) if command.islower() else (dx, dy)
            k += 2
        if command in "Mm":
            found.append([])
            command = "l" if command == "m" else "L"
        found[-1].append((x, y))
    return found


# -- the formats ---------------------------------------------------------------------------------------------------


_NUMBERED = re.compile(r"(?<!\\)(?:\\u[0-9a-f]{4})+")


def _unhidden(text: str) -> str:
    """Text with characters that files contain only as \\u001b, restored."""

    def letters(found: re.Match[str]) -> str:
        raw = json.loads(f'"{found[0]}"')
        return raw if visible(raw) == found[0] else found[0]

    return _NUMBERED.sub(letters, text)


def html_report(text: str) -> ReadReport:
    """A report as a page of HTML."""
    return _HtmlReading(markup_of(_unhidden(text))).whole()


def latex_report(text: str) -> ReadReport:
    """A report as LaTeX: texts under pictures and in its proof are words."""
    lines = _unhidden(text).split("\n")
    found = []
    for line in lines:
        if title := re.fullmatch(r"\{\\LARGE\\bfseries (.*)\\par\}\\medskip", line):
            found.append(rf"\section*{{{title[1]}}}")
        elif caption := _CAPTION.fullmatch(line):
            found += [caption[1], ""]
        elif item := _ITEM.fullmatch(line):
            found += [item[1], ""]
        elif not line.startswith((r"\begin{itemize}", r"\end{itemize}")):
            found.append(line)
    return ReadReport(tuple(PAGES["latex"]("\n".join(found))))


def markdown_report(text: str) -> ReadReport:
    """A report as Markdown; of a picture the words under it."""
    bare = re.sub(r"^!\[.*\]\(<.*>\)\n\n", "", _unhidden(text), flags=re.MULTILINE)
    bare = re.sub(r"^\*([^*].*)\*$", r"\1", bare, flags=re.MULTILINE)  # a remark
    return ReadReport(tuple(PAGES["markdown"](bare)))


def notebook_report(text: str) -> ReadReport:
    """The words of a notebook, without its cells of code."""
    cells = json.loads(text)["cells"]
    said = ("".join(cell["source"]) for cell in cells if cell["cell_type"] == "markdown")
    return markdown_report("\n\n".join(said) + "\n")


def columns_reported(content: bytes) -> dict[str, np.ndarray]:
    """Columns of a table that a page carries: a line that names them, then their differences.

    A difference is a whole number, its sign the lowest bit, seven bits a byte, the lowest first.
    """
    head, _, packed = content.partition(b"\n")
    reported = json.loads(head)
    return dict(zip(reported["names"], columns_unpacked(reported, packed), strict=True))


def columns_unpacked(reported: Mapping[str, object], packed: bytes) -> Iterable[np.ndarray]:
    """Columns that are named."""
    octets = np.frombuffer(packed, dtype=np.uint8)
    if not len(octets):
        return
    last = np.flatnonzero(octets < 128)
    first = np.concatenate([[0], last[:-1] + 1])
    weights = (octets & 127).astype(np.int64) << (7 * (np.arange(len(octets)) - np.repeat(first, last - first + 1)))
    zigzag = np.add.reduceat(weights, first) if len(first) else weights
    values = np.where(zigzag & 1, -(zigzag + 1) // 2, zigzag // 2)
    rows, k = int(reported["rows"]), 0  # type: ignore[call-overload]
    for power, order, holes in reported["columns"]:  # type: ignore[attr-defined]
        column = values[k : k + rows]
        k += rows
        for _ in range(order):
            column = np.cumsum(column)
        found = column * 10.0**power
        for begin, count, word in holes:
            found[begin : begin + count] = float(word)
        yield found
