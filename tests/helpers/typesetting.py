"""What is lost of a formula on its way to a page or a paper: rows, signs of alignment, commands."""

from __future__ import annotations

import re

from eomgen.page.markup import mathml
from eomgen.page.paper import UnknownCommand, typst_math


def rows_of_latex(tex: str) -> int:
    """The rows of all environments in a formula."""
    return len(re.findall(r"\\\\", tex)) + len(re.findall(r"\\begin\{", tex))


def lost_in_mathml(tex: str, found: str | None = None) -> str:
    """What is wrong with the MathML of a formula, or "".

    Args:
        found: the MathML; None: what a page has.
    """
    found = mathml(tex, display=True) if found is None else found
    shown = re.sub(r"<annotation.*?</annotation>", "", found, flags=re.S)
    if 'class="unset"' in shown or "merror" in shown or not shown.startswith("<math"):
        return "it is not set"
    if "&amp;" in shown:
        return "a sign of alignment is printed"
    rows = shown.count("<mtr")
    return "" if rows == rows_of_latex(tex) else f"{rows} rows of {rows_of_latex(tex)}"


def lost_in_typst(tex: str) -> str:
    """What is wrong with the Typst of a formula, or ""."""
    try:
        found = typst_math(tex)
    except UnknownCommand as error:
        return str(error)
    aligned = re.sub(r"\\begin\{(?:cases|.matrix)\}.*?\\end\{(?:cases|.matrix)\}", "", tex, flags=re.S)
    rows = found.count("\\\n") + 1 if r"\begin{aligned}" in tex else 0
    return "" if rows == rows_of_latex(aligned) else f"{rows} rows of {rows_of_latex(aligned)}"
