"""Our LaTeX -> MathML, which browsers set without a program (math-core), and the letters that it is set in."""

from __future__ import annotations

import re
from base64 import b64encode
from functools import cache
from importlib import resources
from typing import Any

from eomgen.errors import ToolMissing
from eomgen.page.markup import Html, element

ROWS = 'style="text-align: right;justify-items: end;padding-right: 0;"', 'class="r"'
_WORDS = re.compile(r"\\text\{((?:[^{}$]*\$(?:[^${}]|\{[^{}]*\})*\$)+[^{}$]*)\}")
OVERLINE = ">\u0332</mo></mover>", ">\xaf</mo></mover>"  # math-core takes the line that lies low
LEFT = 'style="text-align: left;justify-items: start;padding-left: 0;"', 'class="l"'


@cache
def _converters() -> tuple[Any, Any]:
    """(of formulas in a line, of those that stand alone, with their LaTeX inside).

    Raises:
        ToolMissing: math-core is not installed.
    """
    try:
        from math_core import LatexToMathML
    except ImportError as error:
        mend = "pip install math-core; or write a .md, .tex or .pdf"
        raise ToolMissing(
            "the formulas of an HTML page are set by math-core, which is not installed", "", mend
        ) from error
    plain = LatexToMathML(fancy_error=False, allow_unreliable_rendering=True)  # \widetilde among them
    return plain, LatexToMathML(fancy_error=False, allow_unreliable_rendering=True, annotation=True)


def mathml(tex: str, *, display: bool = False) -> Html:
    """A formula as MathML, with its LaTeX as annotation where it stands alone; what has no MathML stands as its LaTeX.

    Raises:
        ToolMissing: math-core is not installed.
    """
    converter = _converters()[display]
    from math_core import LatexError

    try:
        found = converter.convert_with_local_state(_words_apart(tex), displaystyle=display)
    except LatexError:
        return element("code", tex, class_="unset")
    for long, short in (ROWS, LEFT, OVERLINE):
        found = found.replace(long, short)
    return Html(found)


def _words_apart(tex: str) -> str:
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
