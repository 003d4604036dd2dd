r"""Formula in LaTeX -> pieces that fit on a line.

It is broken at signs and relations, then inside brackets, then between factors.

Each piece but the first begins with the sign that joins it: a relation, + or -, a dot between factors, and \big/ where
a fraction is too wide. A bracket that is opened has a fixed size, as \left may not be closed on another line.
"""

from __future__ import annotations

from collections.abc import Sequence
from itertools import pairwise

from eomgen.frozen import dataclass
from eomgen.symbolic.print.width import TexItem, parsed, set_length, width_of

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
