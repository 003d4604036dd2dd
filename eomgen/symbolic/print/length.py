"""A formula as it is typeset -> how long it is as a person reads it.

Every visible mark counts one: a letter, a digit, an operator, a bracket, a fraction bar, a root. The name of a function
is one mark too. What stands over or beside a letter (accents, primes) and where marks are placed count nothing.
"""

from __future__ import annotations

import re

_ACCENTS = (
    "dot ddot dddot ddddot hat widehat bar overline underline vec tilde widetilde acute grave breve check mathring"
    " overrightarrow overleftarrow prime"
)
_PLACES = (
    "left right middle big Big bigg Bigg bigl bigr Bigl Bigr biggl biggr Biggl Biggr quad qquad displaystyle textstyle"
    " limits nolimits hfill mathstrut nonumber notag newline"
)
_FONTS = (
    "mathrm mathbf mathit mathsf mathtt mathcal mathbb mathfrak boldsymbol bm pmb text textrm textbf textit textsf mbox"
    " mathop mathord mathbin mathrel overset underset stackrel substack phantomsection"
)
_SILENT = frozenset(f"{_ACCENTS} {_PLACES} {_FONTS}".split())
_UNREAD = frozenset(("label", "tag", "color", "hspace", "vspace", "phantom", "hphantom", "vphantom"))
_FENCES = {"cases": 1, "pmatrix": 2, "bmatrix": 2, "Bmatrix": 2, "vmatrix": 2, "Vmatrix": 2}
_INVISIBLE = frozenset("{}_^&~'$ \t\n\r")

_TOKEN = re.compile(
    r"""(?P<comment>%[^\n]*)
      | \\(?:begin|end)\s*\{(?P<environment>[^{}]*)\}(?:\{[^{}]*\})?
      | \\operatorname\*?\s*\{(?P<name>(?:[^{}]|\{[^{}]*\})*)\}
      | \\sqrt\s*\[(?P<degree>[^\[\]]*)\]
      | \\(?P<unread>[a-zA-Z]+)\*?\s*\{(?P<ignored>[^{}]*)\}
      | \\(?P<command>[a-zA-Z]+)\*?
      | (?P<break>\\\\(?:\[[^\[\]]*\])?)
      | \\(?P<escaped>.)
      | (?P<mark>.)""",
    re.VERBOSE | re.DOTALL,
)


def length_of_latex(tex: str) -> int:
    """The number of visible marks of a formula in LaTeX.

    length_of_latex(r"(M + m)\\ddot{X} + m\\ddot{s}\\cos\\alpha = 0") is 13

    Args:
        tex: a formula, with `$` around it or without.
    """
    total, place = 0, 0
    silenced = False  # by \left and its like, whose empty delimiter is a dot
    while (found := _TOKEN.match(tex, place)) is not None:
        place = found.end()
        if found["unread"] and found["unread"] not in _UNREAD:  # its braces hold what is read
            place = found.start("unread") + len(found["unread"])
            found = _TOKEN.fullmatch(f"\\{found['unread']}")
            assert found is not None
        if not (silenced and found["mark"] == "."):
            total += _marks(found)
        silenced = found["command"] in ("left", "right", "middle")
    return total


def _marks(found: re.Match[str]) -> int:
    """The visible marks of one token."""
    if found["environment"] is not None:
        return _FENCES.get(found["environment"], 0) if found[0].startswith("\\begin") else 0
    if found["degree"] is not None:
        return 1 + length_of_latex(found["degree"])
    if found["command"] is not None:
        return int(found["command"] not in _SILENT)
    if found["escaped"] is not None:
        return int(found["escaped"] not in ",;:!> \n")
    return int(found["name"] is not None or (found["mark"] is not None and found["mark"] not in _INVISIBLE))
