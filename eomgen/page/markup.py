"""HTML and SVG, built so that nothing of a model can become markup: the one place where text is escaped."""

from __future__ import annotations

import re
import zlib
from base64 import b64encode
from html import escape

from eomgen.errors import visible

VOID = frozenset({"br", "img", "input", "link", "meta"})  # elements without an end
_IMPORT = re.compile(r"^import .*\n", re.MULTILINE)
_REMARK = re.compile(r"  // .*$", re.MULTILINE)
_EXPORT = re.compile(r"^export (?=(?:const|class|function) (\w+))", re.MULTILINE)


class Html(str):
    """Text that is markup already; every other text is escaped."""

    __slots__ = ()


def html(text: str) -> Html:
    """A text as markup; what steers a screen or turns its direction is shown."""
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
