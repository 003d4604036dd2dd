"""HTML, SVG and MathML, built so that nothing of a model can become markup.

HTML and SVG, built so that nothing of a model can become markup: the one place where text is escaped.
"""

from __future__ import annotations

import math
import re
import zlib
from base64 import b64encode
from collections.abc import Iterable
from functools import cache
from html import escape
from importlib import resources
from typing import Any

import numpy as np

from eomgen.errors import visible

VOID = frozenset({"br", "img", "input", "link", "meta"})  # elements without an end
_IMPORT = re.compile(r"^import .*\n", re.MULTILINE)
_REMARK = re.compile(r"  // .*$", re.MULTILINE)
_EXPORT = re.compile(r"^export (?=(?:const|class|function) (\w+))", re.MULTILINE)


class Html(str):
    """Text that is markup already; every other text is escaped."""

    __slots__ = ()


def html(text: str) -> Html:
    """A text as markup; control characters are shown."""
    return text if isinstance(text, Html) else Html(escape(visible(text)))


def in_a_row(*parts: str, between: str = "") -> Html:
    """Parts one after the other."""
    return Html(between.join(html(part) for part in parts))


def element(tag: str, *inside: str, **attributes: str | None) -> Html:
    """<tag attribute="value">inside</tag>.

    Args:
        attributes: an underscore stands for a hyphen, one at the end for nothing (`class_`); of those that are None
            nothing is written.
    """
    given = "".join(
        f' {name.rstrip("_").replace("_", "-")}="{html(str(value))}"'
        for name, value in attributes.items()
        if value is not None
    )
    return Html(f"<{tag}{given}>" if tag in VOID else f"<{tag}{given}>{in_a_row(*inside)}</{tag}>")


def style(text: str) -> Html:
    """A style sheet of ours."""
    return Html(f"<style>\n{text}</style>")


def script(text: str) -> Html:
    """A program of ours."""
    return Html(f"<script>\n{text}</script>")


def own_text(name: str) -> str:
    """A style sheet or a program of this room."""
    return resources.files("eomgen.page").joinpath(name).read_text(encoding="utf-8")


def packed(content: bytes) -> str:
    """Bytes as a page carries them: gzip, then base64."""
    press = zlib.compressobj(9, wbits=16 + zlib.MAX_WBITS, memLevel=7)  # no date; short blocks, each with its own code
    return b64encode(press.compress(content) + press.flush()).decode("ascii")


def in_a_script(module: str) -> str:
    """A module as a statement that gives its names to those after it; without comments."""
    names = ", ".join(_EXPORT.findall(module))
    text = _REMARK.sub("", _EXPORT.sub("", _IMPORT.sub("", module)))
    lines = [line for each in text.splitlines() if (line := each.strip()) and not line.startswith(("//", "/*", "*"))]
    return f"const {{ {names} }} = (() => {{\n{chr(10).join(lines)}\nreturn {{ {names} }};\n}})();"


# -------- paths -----------------------------------------------------------------------------------------------
# Places -> the paths of SVG in few letters: steps instead of places, no digit and no point that nobody sees.


SEEN = 0.05  # [units of the picture] a curve may pass a point by that much
_WORD = re.compile(r"[A-Za-z]|[-+]?(?:\d+\.?\d*|\.\d+)(?:e[-+]?\d+)?")
_PAIRS = {"M": 1, "L": 1, "Q": 2, "C": 3}  # places of a command


def curve_path(x: np.ndarray, y: np.ndarray) -> str:
    """A line through the points; where there is no value it is broken."""
    y = np.where(np.isfinite(y), y, np.nan)
    pieces = np.split(np.arange(len(y)), np.flatnonzero(np.diff(np.isnan(y))) + 1)
    seen = (piece[_bends(x[piece], y[piece])] for piece in pieces if len(piece) and not np.isnan(y[piece[0]]))
    words = (f"{'L' if k else 'M'}{x[i]} {y[i]}" for piece in seen for k, i in enumerate(piece.tolist()))
    return stepped("".join(words), digits=1)


def _bends(x: np.ndarray, y: np.ndarray) -> np.ndarray:
    """Indices of the points that a line needs so that no other is off it by more than SEEN (Douglas and Peucker)."""
    kept, open_ = {0, len(x) - 1}, [(0, len(x) - 1)]
    while open_:
        a, b = open_.pop()
        if b - a < 2:
            continue
        inner = slice(a + 1, b)
        off = np.abs(y[inner] - y[a] - (y[b] - y[a]) * (x[inner] - x[a]) / ((x[b] - x[a]) or 1.0))
        if off.max() > SEEN:
            middle = a + 1 + int(off.argmax())
            kept.add(middle)
            open_ += [(a, middle), (middle, b)]
    return np.array(sorted(kept))


def stepped(path: str, digits: int = 2) -> str:
    """A path of absolute commands M, L, Q, C and Z by steps from place to place: the same to these digits."""
    words, said, before = _WORD.findall(path), [], ""
    at = start = (0, 0)  # in units of the last digit, so that errors do not add up
    k, size = 0, 10**digits
    command = ""
    while k < len(words):
        if words[k].isalpha():
            command, k = words[k], k + 1
        if command in "Zz":
            said.append("z")
            at, before = start, "z"
            continue
        many = 2 * _PAIRS[command]
        places = [round(float(word) * size) for word in words[k : k + many]]
        k += many
        steps = [value - at[i % 2] for i, value in enumerate(places)]
        letter = command.lower()
        if letter == "l" and at == (places[0], places[1]) and before != "m":
            continue
        implied = letter == before or (letter == "l" and before == "m")
        said.append(_joined(("" if implied else letter), (step / size for step in steps), said[-1] if implied else ""))
        at, before = (places[-2], places[-1]), letter
        if letter == "m":
            start = at
    return "".join(said)


def _joined(letter: str, values: Iterable[float], before: str) -> str:
    """Numbers one after the other, apart where they would be read as one."""
    text = letter
    for value in values:
        word = short(value)
        last = text or before
        text += word if not last or last[-1].isalpha() or word.startswith("-") else f" {word}"
    return text


def short(value: float) -> str:
    """A number of two digits at most, without the 0 before its point."""
    if not math.isfinite(value):
        return "0"
    word = f"{value:.2f}".rstrip("0").rstrip(".")
    sign, word = ("-", word[1:]) if word.startswith("-") else ("", word)
    return "0" if word in ("0", "") else sign + (word[1:] if word.startswith("0.") else word)


# -------- mathml ----------------------------------------------------------------------------------------------
# Our LaTeX -> MathML, which browsers set without a program (math-core), and the letters that it is set in.


ROWS = 'style="text-align: right;justify-items: end;padding-right: 0;"', 'class="r"'
_WORDS = re.compile(r"\\text\{((?:[^{}$]*\$(?:[^${}]|\{[^{}]*\})*\$)+[^{}$]*)\}")
OVERLINE = ">\u0332</mo></mover>", ">\xaf</mo></mover>"  # math-core takes the line that lies low
LEFT = 'style="text-align: left;justify-items: start;padding-left: 0;"', 'class="l"'


@cache
def _converters() -> tuple[Any, Any]:
    """(of formulas in a line, of those that stand alone, with their LaTeX inside)."""
    from math_core import LatexToMathML

    plain = LatexToMathML(fancy_error=False, allow_unreliable_rendering=True)  # \widetilde among them
    return plain, LatexToMathML(fancy_error=False, allow_unreliable_rendering=True, annotation=True)


def mathml(tex: str, *, display: bool = False) -> Html:
    """A formula as MathML; where it stands alone, with its LaTeX inside; one without MathML stands as its LaTeX."""
    converter = _converters()[display]
    from math_core import LatexError

    try:
        found = converter.convert_with_local_state(words_apart(tex), displaystyle=display)
    except LatexError:
        return element("code", tex, class_="unset")
    for long, short in (ROWS, LEFT, OVERLINE):
        found = found.replace(long, short)
    return Html(found)


def words_apart(tex: str) -> str:
    r"""Words with formulas among them as words, formula, words: \text{N$\cdot$m} -> \text{N}\cdot\text{m}."""
    return _WORDS.sub(lambda found: _parted(found[1]), tex)


def _parted(words: str) -> str:
    pieces = words.split("$")
    return "".join(piece if k % 2 else rf"\text{{{piece}}}" for k, piece in enumerate(pieces) if piece)


def font_face() -> str:
    """The rule of CSS that carries the letters of formulas."""
    font = resources.files("eomgen.page").joinpath("fonts/stix_two_math.woff2").read_bytes()
    source = f"url(data:font/woff2;base64,{b64encode(font).decode()}) format('woff2')"
    return f"@font-face{{font-family:'eomgen math';src:{source};}}\n"


def page_style() -> str:
    """The style sheet of a report, with the letters of its formulas."""
    return font_face() + own_text("style.css")
