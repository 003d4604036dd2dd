r"""Formula in LaTeX -> pieces that fit on a line.

It is broken at signs and relations, then inside brackets, then between factors.

Each piece but the first begins with the sign that joins it: a relation, + or -, a dot between factors, and \big/ where
a fraction is too wide. A bracket that is opened has a fixed size, as \left may not be closed on another line.
"""

from __future__ import annotations

import json
import re
from collections.abc import Mapping, Sequence
from dataclasses import field
from functools import cache, lru_cache
from importlib import resources
from itertools import pairwise

from eomgen.frozen import dataclass
from eomgen.symbolic.print.names import LETTERS

SHARE = 0.5  # of a line that a bracket takes before it is opened rather than the factors beside it parted
LEAST = 0.7  # of a line: the room in brackets within brackets
LEAD = 0.25  # of a line that stands before a bracket whose lines are shorter for that
PARTS = ("ord", "box", "root", "fence", "frac")  # kinds of factors
TIMES = r"\cdot "
OVER = r"\big/ "
SIGN = 1.2  # width of a sign that joins a piece to the one before it


@dataclass(frozen=True, slots=True)
class SetLine:
    """Line that formulas are broken for.

    Args:
        room: its width [size of the letters].
        font: the letters: "paper" or "page".
    """

    room: float
    font: str = "paper"

    def width(self, tex: str) -> float:
        """Width of a formula."""
        return width_of(tex, self.font)

    def pieces(self, tex: str, room: float) -> list[LinePiece]:
        """The formula in pieces that are no wider than the room, as far as it can be broken."""
        return _Breaking(tex, self.font, LEAST * room).sum(parsed(tex, self.font), room)


PAPER = SetLine(39.3)  # 0.93 of the lines of a paper, of LaTeX and of a wide page
PHONE = SetLine(17.5, "page")  # of a page that is 360 pixels wide


@dataclass(frozen=True, slots=True)
class LinePiece:
    """Part of a formula with its width."""

    tex: str
    width: float

    def then(self, tex: str, width: float) -> LinePiece:
        """The piece and what follows it."""
        return LinePiece(f"{self.tex}{tex}", self.width + width)

    def after(self, tex: str, width: float) -> LinePiece:
        """The piece and what stands before it."""
        return LinePiece(f"{tex}{self.tex}", self.width + width)


class _Breaking:
    """A formula that is broken."""

    def __init__(self, tex: str, font: str, least: float) -> None:
        self.tex, self.font, self.least = tex, font, least

    def whole(self, items: Sequence[TexItem]) -> LinePiece:
        """The items as one piece."""
        return LinePiece(self.tex[items[0].start : items[-1].end], set_length(items)) if items else LinePiece("", 0.0)

    def sum(self, items: Sequence[TexItem], room: float) -> list[LinePiece]:
        """Pieces of a formula: each of its terms in one, where it fits."""
        room = max(room, self.least)
        if set_length(items) <= room or not items:
            return [self.whole(items)]
        starts = [0, *(k for k in range(1, len(items)) if self._joins(items, k)), len(items)]
        runs = [items[first:last] for first, last in pairwise(starts)]
        return [piece for run in runs for piece in self.term(run, room)]

    def _joins(self, items: Sequence[TexItem], k: int) -> bool:
        """True if the item is a relation or a sign between terms, or stands behind a wide blank."""
        sign = items[k].kind == "bin" and self.tex[items[k].start : items[k].end] in ("+", "-", r"\pm")
        return (
            items[k].kind == "rel" or sign or self.tex[items[k - 1].start : items[k - 1].end] in (r"\quad", r"\qquad")
        )

    def term(self, run: Sequence[TexItem], room: float) -> list[LinePiece]:
        """Pieces of a term: opened where its widest part is wide, parted between its factors otherwise."""
        if set_length(run) <= room:
            return [self.whole(run)]
        openable = [k for k, item in enumerate(run) if self._opens(item)]
        widest = max(openable, key=lambda k: run[k].width, default=None)
        if widest is None or run[widest].width <= SHARE * room:
            parts = self._factors(run)
            return self._together(parts, room)
        return self._around(run[:widest], run[widest], run[widest + 1 :], room)

    def _opens(self, item: TexItem) -> bool:
        if item.kind in ("frac", "root"):
            return self.tex[item.end - 1] == "}" and not item.scripts
        return item.kind == "fence" and self.tex[item.start : item.spans[0][0]] not in (r"\left.", r"\left\{")

    def _factors(self, run: Sequence[TexItem]) -> list[Sequence[TexItem]]:
        """The factors of a term, each with the sign or the function that belongs to it."""
        starts, in_argument = [0], False
        for k in range(1, len(run)):
            before, item = run[k - 1], run[k]
            in_argument = item.kind != "op" and (before.kind == "op" or (in_argument and before.kind != "fence"))
            if not in_argument and self._parts(run, k):
                starts.append(k)
        return [run[first:last] for first, last in pairwise([*starts, len(run)])]

    def _parts(self, run: Sequence[TexItem], k: int) -> bool:
        """True if a line can end before the item, between two factors."""
        before, item = run[k - 1], run[k]
        if before.kind not in PARTS or item.kind not in (*PARTS, "op"):
            return item.kind == "bin" and before.kind != "op"
        first = k == 1 or run[k - 2].kind in ("bin", "rel")
        blank = self.tex[before.end : item.start].isspace()
        lone = first and self.tex[before.start : before.end] in ("+", "-")
        derived = self.tex[before.start : before.end].startswith(r"\frac{d}{d")
        return not lone and not derived and (blank or (item.kind != "fence" and self.tex[item.start] == "\\"))

    def _together(self, parts: Sequence[Sequence[TexItem]], room: float) -> list[LinePiece]:
        """Factors in as few pieces as hold them."""
        lines: list[list[TexItem]] = []
        for part in parts:
            if lines and set_length([*lines[-1], *part]) + (SIGN if len(lines) > 1 else 0.0) <= room:
                lines[-1] += part
            else:
                lines.append([*part])
        return [self.whole(line) if k == 0 else self._times(line, self.whole(line)) for k, line in enumerate(lines)]

    def _times(self, items: Sequence[TexItem], piece: LinePiece) -> LinePiece:
        """The piece with the dot that joins it to the factors before it; a function needs none."""
        joined = bool(items) and items[0].kind in ("bin", "rel", "punct", "op")
        return piece if joined else piece.after(TIMES, SIGN)

    def _around(
        self, before: Sequence[TexItem], item: TexItem, after: Sequence[TexItem], room: float
    ) -> list[LinePiece]:
        """Pieces of a term with one of its parts opened."""
        lead = self.whole(before).width
        inner = self._opened(item, room if lead > LEAD * room else room - lead)
        if item.kind == "frac" and any(other.kind not in ("space", "punct") for other in after):
            # (a/b) c: what is behind a/b on its line would belong to its divisor
            inner[0], inner[-1] = inner[0].after(r"\bigl(", SIGN / 2), inner[-1].then(r"\bigr)", SIGN / 2)
        tied = 0  # how many of the items before it go with it: its function, its sign, the letter it is an argument of
        while tied < len(before) and self._ties(before[-tied - 1], item if not tied else before[-tied]):
            tied += 1
        free, bound = before[: len(before) - tied], before[len(before) - tied :]
        if bound:
            inner[0] = inner[0].after(self.tex[bound[0].start : item.start], set_length(bound))
        found = inner
        if free and set_length(free) + inner[0].width <= room:
            found = [inner[0].after(f"{self.whole(free).tex} ", set_length(free)), *inner[1:]]
        elif free:
            found = [*self._enclosed(free, room), self._times((), inner[0]), *inner[1:]]
        rest = after[1:] if after and after[0].kind == "space" else after
        if not rest:
            return found
        dot = TIMES if item.kind == "frac" and rest[0].kind not in ("bin", "rel", "punct") else " "
        if rest[0].kind == "punct" or found[-1].width + set_length(rest) <= room:
            return [
                *found[:-1],
                found[-1].then(f" {dot.strip()} {self.whole(rest).tex}".replace("  ", " "), set_length(rest)),
            ]
        first, *others = self.term(rest, room - SIGN)
        return [*found, self._times(rest, first), *others]

    def _enclosed(self, items: Sequence[TexItem], room: float) -> list[LinePiece]:
        """Pieces of factors that others follow: in brackets where a fraction among them is opened."""
        found = self.term(items, room)
        if any(OVER in piece.tex for piece in found):
            sign = found[0].tex[:2] if found[0].tex.startswith(("+ ", "- ")) else ""
            found[0] = LinePiece(rf"{sign}\bigl({found[0].tex[len(sign) :]}", found[0].width + SIGN / 2)
            found[-1] = found[-1].then(r"\bigr)", SIGN / 2)
        return found

    def _ties(self, item: TexItem, after: TexItem) -> bool:
        """True if an item cannot be parted from the one after it."""
        text = self.tex[item.start : item.end]
        return (
            item.kind in ("op", "bin", "rel")
            or text in ("+", "-")
            or (after.kind == "fence" and item.end == after.start)
        )

    def _opened(self, item: TexItem, room: float) -> list[LinePiece]:
        if item.kind == "fence":
            first, last = item.spans[0]
            opening = self.tex[item.start : first].removeprefix(r"\left").removeprefix(r"\bigl").strip()
            closing = self.tex[last : item.end].strip().removeprefix(r"\right").removeprefix(r"\bigr").strip()
            blank = " " if opening.startswith("\\") else ""
            inner = self.sum(item.inside[0], room - SIGN)
            if len(inner) == 1:
                return [self.whole([item])]
            inner[0] = inner[0].after(rf"\bigl{opening}{blank}", SIGN / 2)
            return [*inner[:-1], inner[-1].then(rf"\bigr{closing}", SIGN / 2 + item.scripts)]
        if item.kind == "root":
            inner = self.sum(item.inside[0], room - SIGN)
            inner[0] = inner[0].after(r"\bigl(", SIGN / 2)
            return [*inner[:-1], inner[-1].then(r"\bigr)^{1/2}", SIGN)]
        above, below = (self._side(self.tex[first:last], room) for first, last in item.spans)
        if above[-1].width + below[0].width + SIGN <= room:
            return [*above[:-1], above[-1].then(f" {OVER}{below[0].tex}", SIGN + below[0].width), *below[1:]]
        return [*above, below[0].after(OVER, SIGN), *below[1:]]

    def _side(self, tex: str, room: float) -> list[LinePiece]:
        """A side of a quotient, in brackets where it is more than one symbol; its letters are as large as all then."""
        items = parsed(tex, self.font)
        found = _Breaking(tex, self.font, self.least).sum(items, room - SIGN)
        if len(items) > 1 or items[0].kind == "frac":
            found[0] = found[0].after(r"\bigl(", SIGN / 2)
            found[-1] = found[-1].then(r"\bigr)", SIGN / 2)
        return found


# -------- width -----------------------------------------------------------------------------------------------
# Formula in LaTeX -> its parts, each as wide as the letters of a font make it.
#
# Widths are in the size of the letters (em). The measures are those of TeX: signs have 2/9 on both sides, relations
# 5/18,
# exponents are 0.7 as large, a fraction is as wide as the longer of its lines.


SIZES = (1.0, 1.0, 0.7, 0.5)  # of letters in a display, in its fractions, in exponents and indices, in theirs
SPACES = {"bin": 4 / 9, "rel": 5 / 9, "punct": 1 / 6, "op": 1 / 6}  # round a sign of a kind
BLANKS = {
    r"\,": 1 / 6,
    r"\:": 2 / 9,
    r"\;": 5 / 18,
    r"\ ": 1 / 3,
    r"\!": -1 / 6,
    r"\quad": 1.0,
    r"\qquad": 2.0,
    "~": 1 / 3,
}
FRACTION = 0.25  # what a fraction keeps free at its ends
LARGER = (0.0, 0.15, 0.8, 1.0)  # which of the larger forms of a bracket stands round content of a height
BIG = 1.75  # the width of a bracket of fixed size by that of the bracket itself
GAP = 1.0  # between columns
UNKNOWN = 600  # advance of what no font has [thousandths]
DEEPEST = 60  # levels of brackets and braces that are looked into
KEPT = 2000  # formulas whose widths are cached

SIGNS = {
    r"\cdot": "⋅", r"\times": "×", r"\pm": "±", r"\leq": "≤", r"\geq": "≥", r"\neq": "≠", r"\approx": "≈", r"\to": "→",
    r"\infty": "∞", r"\partial": "∂", r"\sum": "∑", r"\int": "∫", r"\ldots": "…", r"\dots": "…", r"\cdots": "⋯",
    r"\lvert": "|", r"\rvert": "|", r"\vert": "|", r"\{": "{", r"\}": "}", r"\circ": "°", "-": "−", "'": "′",
}  # fmt: skip
KINDS = dict.fromkeys(("+", "-", r"\pm", r"\cdot", r"\times", r"\big/"), "bin")
KINDS |= dict.fromkeys(("=", "<", ">", r"\leq", r"\geq", r"\neq", r"\approx", r"\to"), "rel")
KINDS |= {"(": "open", "[": "open", r"\lvert": "open", ")": "close", "]": "close", r"\rvert": "close"}
KINDS |= {",": "punct", ";": "punct", **dict.fromkeys(BLANKS, "space")}
NAMES = dict.fromkeys(
    rf"\{name}" for name in "sin cos tan sinh cosh tanh arcsin arccos arctan ln log exp min max det".split()
)
ACCENTS = frozenset(rf"\{name}" for name in "dot ddot dddot bar hat vec tilde widehat widetilde overline".split())
UPRIGHT = frozenset(rf"\{name}" for name in "mathrm mathsf mathbf operatorname".split())
_GREEK = {command: letter for letter, command in LETTERS.items()}
_VARIANTS = {r"\epsilon": "ϵ", r"\vartheta": "ϑ", r"\phi": "ϕ", r"\varphi": "φ", r"\varrho": "ϱ", r"\varpi": "ϖ"}
_SMALL = "αβγδεζηθικλμνξοπρςστυφχψω∂ϵϑϰϕϱϖ"
_TOKEN = re.compile(r"\\[a-zA-Z]+|\\.|\d+(?:\.\d+)?|\S", re.DOTALL)
_WORDS = re.compile(r"[\\${}^_]")
_BIG = re.compile(r"\\[bB]ig+[lr]?$")


@dataclass(frozen=True, slots=True)
class Font:
    """Advances of the letters of a font [thousandths of their size], and of the larger forms of its brackets.

    `advances.json` has them, made from the fonts by `python tests/helpers/advances_of_fonts.py`: a letter that is
    slanted in a formula as that letter of its own, h as \u210e.
    """

    letters: Mapping[str, int]
    larger: Mapping[str, Sequence[int]]

    def width(self, letters: str, *, slanted: bool = False) -> float:
        """Letters one after the other [em]."""
        return sum(self.letters.get(_slanted(c) if slanted else c, UNKNOWN) for c in letters) / 1000

    def bracket(self, sign: str, height: int) -> float:
        """A bracket round content of a height: 0 letters, 1 with exponents, 2 fractions, 3 what is higher."""
        forms = self.larger.get(sign) or (self.letters.get(sign, UNKNOWN),)
        return forms[round(LARGER[height] * (len(forms) - 1))] / 1000


def _slanted(c: str) -> str:
    """The letter that stands in a formula for a letter: h is \u210e."""
    if c == "h":
        return "ℎ"
    if c.isascii() and c.isalpha():
        return chr(0x1D434 + ord(c) - 65 if c.isupper() else 0x1D44E + ord(c) - 97)
    return chr(0x1D6FC + _SMALL.index(c)) if c in _SMALL else c


@cache
def _fonts() -> dict[str, Font]:
    """{"page": that of our pages, "paper": that of papers}"""
    text = resources.files("eomgen.symbolic.print").joinpath("advances.json").read_text(encoding="utf-8")
    return {name: Font(**font) for name, font in json.loads(text).items()}


@dataclass(slots=True)
class TexItem:
    """A part of a formula that no line ends in, with the parts inside it that may stand on lines of their own.

    Args:
        kind: ord, op, bin, rel, punct, space, open, close; fence, frac, root, and box for what is never opened.
        start, end: its place in the text.
        width: with its exponent and index.
        height: of its content, as `Font.bracket` counts it.
        inside: of a fence, a root or braces the content, of a fraction its two lines.
        spans: where each of them stands.
    """

    kind: str
    start: int
    end: int
    width: float
    height: int = 0
    scripts: float = 0.0
    inside: tuple[list[TexItem], ...] = ()
    spans: tuple[tuple[int, int], ...] = field(default=())


class _Reader:
    """The tokens of a formula, one after the other."""

    def __init__(self, tex: str, font: Font) -> None:
        self.tex, self.font = tex, font
        self.tokens = [(found[0], found.start(), found.end()) for found in _TOKEN.finditer(tex)]
        self.at = 0

    def until(self, style: int, depth: int, *ends: str, upright: bool = False) -> tuple[list[TexItem], str]:
        """The items up to one of these tokens, and that token; "" at the end of the text."""
        items: list[TexItem] = []
        while self.at < len(self.tokens):
            token = self.tokens[self.at][0]
            self.at += 1
            if token in ends:
                return _folded(items, self.font, style), token
            if token in "_^" and items:
                self._script(items[-1], style, depth)
            else:
                items.append(self._one(token, style, depth, upright))
        return _folded(items, self.font, style), ""

    def _script(self, base: TexItem, style: int, depth: int) -> None:
        script = self._argument(3 if style > 1 else 2, depth)
        base.end = self.tokens[self.at - 1][2]
        base.width += max(0.0, script.width - base.scripts)
        base.scripts, base.height = max(base.scripts, script.width), max(base.height, 1)

    def _argument(self, style: int, depth: int, upright: bool = False) -> TexItem:
        if self.at >= len(self.tokens):
            return TexItem("box", len(self.tex), len(self.tex), 0.0)
        token = self.tokens[self.at][0]
        self.at += 1
        return self._one(token, style, depth, upright)

    def _one(self, token: str, style: int, depth: int, upright: bool) -> TexItem:
        start, end = self.tokens[self.at - 1][1:]
        size = SIZES[style]
        if token == "{":
            inside = self._group(style, depth, upright)
            width, height = set_length(inside, style), tallest(inside)
            return TexItem("box", start, self._end, width, height, 0.0, (inside,), ((start + 1, self._end - 1),))
        if token in (r"\frac", r"\tfrac", r"\dfrac"):
            parts, spans = [], []
            for _ in range(2):
                spans.append((self.tokens[self.at][2], 0) if self.at < len(self.tokens) else (end, 0))
                self.at += 1
                parts.append(self._group(min(style + 1, 3), depth, upright))
                spans[-1] = (spans[-1][0], self._end - 1)
            width = max(set_length(part, min(style + 1, 3)) for part in parts) + FRACTION * size
            return TexItem(
                "frac",
                start,
                self._end,
                width,
                min(3, 2 + max(map(tallest, parts)) // 2),
                0.0,
                tuple(parts),
                tuple(spans),
            )
        if token == r"\sqrt":
            under = self._argument(style, depth)
            root = self.font.bracket("√", max(2, under.height)) * size
            grouped = self.tex[under.start : under.start + 1] == "{"
            return TexItem(
                "root" if grouped else "box",
                start,
                self._end,
                under.width + root,
                max(2, under.height),
                0.0,
                under.inside,
            )
        if token == r"\left":
            return self._fence(start, style, depth)
        if token == r"\begin":
            return self._table(start, depth, style)
        if token == r"\text" or token == r"\mbox":
            words = self._words()
            return TexItem("box", start, self._end, size * self.font.width(_WORDS.sub("", words)))
        if token in UPRIGHT or token in ACCENTS:
            under = self._argument(style, depth, upright or token in UPRIGHT)
            return TexItem("op" if token == r"\operatorname" else "ord", start, self._end, under.width, under.height)
        if token in NAMES:
            return TexItem("op", start, end, size * self.font.width(token[1:]))
        if _BIG.match(token) and self.at < len(self.tokens):
            bracket = self._argument(style, depth)
            return TexItem({"l": "open", "r": "close"}.get(token[-1], "bin"), start, self._end, BIG * bracket.width, 1)
        if token in BLANKS:
            return TexItem("space", start, end, BLANKS[token])
        letter = SIGNS.get(token) or _VARIANTS.get(token) or _GREEK.get(token) or token
        known = letter if not letter.startswith("\\") else "?"
        width = size * self.font.width(known, slanted=not upright)
        return TexItem(KINDS.get(token, "ord"), start, end, width)

    @property
    def _end(self) -> int:
        return self.tokens[min(self.at, len(self.tokens)) - 1][2]

    def _group(self, style: int, depth: int, upright: bool = False) -> list[TexItem]:
        """Content of braces that are open; one that lies too deep is only measured."""
        if depth < DEEPEST:
            return self.until(style, depth + 1, "}", upright=upright)[0]
        return self._skipped("{", "}")

    def _skipped(self, opens: str, closes: str) -> list[TexItem]:
        level, first = 1, self.at
        while level and self.at < len(self.tokens):
            token = self.tokens[self.at][0]
            level += (token == opens) - (token == closes)
            self.at += 1
        return [TexItem("box", self.tokens[first - 1][2], self._end, (self.at - first) * UNKNOWN / 1000, 3)]

    def _fence(self, start: int, style: int, depth: int) -> TexItem:
        opening = self.tokens[self.at][0]
        self.at += 1
        first = self.tokens[self.at - 1][2]
        shallow = depth < DEEPEST
        inside = self.until(style, depth + 1, r"\right")[0] if shallow else self._skipped(r"\left", r"\right")
        last = self.tokens[min(self.at, len(self.tokens)) - 1][1]
        self.at += 1
        height = tallest(inside)
        brackets = 2 * self.font.bracket(SIGNS.get(opening, opening), height) * SIZES[style]
        width = set_length(inside, style) + brackets
        return TexItem("fence", start, self._end, width, height, 0.0, (inside,), ((first, last),))

    def _words(self) -> str:
        """Content of the next braces."""
        self.at += 1
        first, level = self._end, 1
        while level and self.at < len(self.tokens):
            level += {"{": 1, "}": -1}.get(self.tokens[self.at][0], 0)
            self.at += 1
        return self.tex[first : self._end - 1]

    def _table(self, start: int, depth: int, style: int) -> TexItem:
        kind = self._words()
        columns: list[float] = []
        end, number = "&", 0
        while end not in (r"\end", ""):
            cell, end = self.until(1, depth + 1, "&", r"\\", r"\end")
            columns += [0.0] * (number + 1 - len(columns))
            columns[number] = max(columns[number], set_length(cell, 1))
            number = number + 1 if end == "&" else 0
        self._words()
        brackets = {"cases": 1, "aligned": 0, "matrix": 0}.get(kind, 2) * self.font.bracket("(", 3)
        width = sum(columns) + GAP * len(columns) + brackets
        return TexItem("box", start, self._end, width * SIZES[style], 3)


def tallest(items: Sequence[TexItem]) -> int:
    """Height of what stands on a line, as `Font.bracket` counts it."""
    return max((item.height for item in items), default=0)


def set_length(items: Sequence[TexItem], style: int = 0) -> float:
    """Width of parts on one line; in exponents signs have no blanks round them."""
    blanks = 0.0 if style > 1 else sum(SPACES.get(item.kind, 0.0) for item in items)
    return blanks + sum(item.width for item in items)


def _folded(items: list[TexItem], font: Font, style: int) -> list[TexItem]:
    """The items with those between two brackets as one; a minus that belongs to what stands after it is no sign."""
    found: list[TexItem] = []
    opened: list[int] = []
    for item in items:
        before = next((other.kind for other in reversed(found) if other.kind != "space"), "open")
        if item.kind == "bin" and before in ("bin", "rel", "punct", "open"):
            item.kind = "ord"
        if item.kind == "open":
            opened.append(len(found))
        if item.kind == "close" and opened:
            first = opened.pop()
            bracket, inside = found[first], found[first + 1 :]
            width = bracket.width + set_length(inside, style) + item.width
            height = max(tallest(inside), item.height)
            span = (bracket.end, item.end if not inside else inside[-1].end)
            found[first:] = [TexItem("fence", bracket.start, item.end, width, height, item.scripts, (inside,), (span,))]
        else:
            found.append(item)
    return found


@lru_cache(maxsize=KEPT)
def parsed(tex: str, font: str = "paper") -> tuple[TexItem, ...]:
    """The parts of a formula, as far as lines can end between them."""
    return tuple(_Reader(tex, _fonts()[font]).until(0, 0)[0])


def width_of(tex: str, font: str = "paper") -> float:
    """The width of a formula in a display [em]."""
    return set_length(parsed(tex, font))
