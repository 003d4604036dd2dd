r"""A page as it leaves, LaTeX or Markdown -> what stands on it, one after the other: headings, words, formulas, tables.

A reader of its own: it knows what \subsection*, $$ and | mean, and nothing of what wrote them.
"""

from __future__ import annotations

import re
import unicodedata
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence

from eomgen.proof.typeset import Tokens, between_equals, tokens_of
from eomgen.records import dataclass

GREEK = "alpha beta gamma delta zeta eta theta iota kappa lambda mu nu xi pi rho sigma tau upsilon phi chi psi omega"
_CHARACTERS = {
    rf"\{x}": unicodedata.lookup(f"GREEK SMALL LETTER {x.replace('lambda', 'lamda')}") for x in GREEK.split()
}
_CHARACTERS |= {
    rf"\{x.title()}": unicodedata.lookup(f"GREEK CAPITAL LETTER {x.replace('lambda', 'lamda')}") for x in GREEK.split()
}
GREEK_LETTERS = {letter: command for command, letter in _CHARACTERS.items()}
_CHARACTERS |= {r"\varepsilon": "ε", r"\cdot": "·", r"^{\circ}": "°"}
_COMMANDS = {
    r"\textbackslash": "\\",
    r"\textasciicircum": "^",
    r"\textasciitilde": "~",
    r"\textless": "<",
    r"\textgreater": ">",
}
_SILENT = frozenset((r"\texttt", r"\textbf", r"\text", r"\textsuperscript", r"\emph"))
_RAISED = re.compile(r"\^\{(-?\d+)\}")
_GROUPING = str.maketrans({"^": "", "(": "", ")": "", "*": "·", "\u2212": "-"})
_TABLE = re.compile(r"\\begin\{(tabular|longtable)\}")
_BEGINS = (r"\[\begin{aligned}", r"\begin{", r"\medskip", r"\section*", r"\subsection*")
_HEADING = re.compile(r"\\(?:sub)?section\*\{(.*)\}")
_HEAD_ENDS = re.compile(r" \\\\ \\hline \\noalign\{\\vskip 3pt\}(?: \\endhead)?(?:\n|\Z)")


@dataclass(frozen=True)
class PagePart:
    """A character of a page, or a formula between dollars.

    Args:
        tex: of the formula; "" of a character.
    """

    character: str = ""
    tex: str = ""


PageLine = tuple[PagePart, ...]


@dataclass(frozen=True)
class PageBlock:
    """One thing that stands on a page.

    Args:
        kind: "heading", "words", "formula", "table" or "lines".
        words: of a heading and a paragraph.
        sides: of a formula.
        rows: of a table, its head first.
        lines: what stands as it is.
    """

    kind: str
    words: PageLine = ()
    sides: tuple[Tokens, ...] = ()
    rows: tuple[tuple[PageLine, ...], ...] = ()
    lines: tuple[str, ...] = ()


def spoken(text: str) -> str:
    """Words as they are compared: without blanks and brackets, exponents as digits, a dot for a product."""
    return "".join(unicodedata.normalize("NFKC", text).translate(_GROUPING).split())


def said_by(tex: str) -> str:
    r"""What a formula says that is only a character of a sentence: $\cdot$, $^{2}$; "" of any other."""
    raised = _RAISED.fullmatch(tex)
    return raised[1] if raised else _CHARACTERS.get(tex, "")


def latex_page(text: str) -> Iterator[PageBlock]:
    """What stands on a page of LaTeX."""
    body = text.partition("\\begin{document}\n")[2].rpartition("\\end{document}")[0]
    lines = body.split("\n")
    while lines:
        line = lines.pop(0)
        if not line or line == r"\medskip":
            continue
        heading = _HEADING.fullmatch(line)
        if heading is not None:
            yield PageBlock("heading", latex_line(heading[1]))
        elif line == r"\[\begin{aligned}":
            yield from displayed("\n".join(_until(lines, r"\end{aligned}\]")))
        elif line == r"\begin{verbatim}":
            yield PageBlock("lines", lines=tuple(_until(lines, r"\end{verbatim}")))
        elif kind := _TABLE.match(line):
            head, _, rest = _parted("\n".join(_until(lines, rf"\end{{{kind[1]}}}")))
            rows = [head, *(row.removesuffix(r" \\") for row in rest.split("\n") if row)]
            yield PageBlock("table", rows=tuple(tuple(map(latex_line, _cells(row, "&"))) for row in rows))
        else:
            paragraph = [line]
            while lines and lines[0] and not lines[0].startswith(_BEGINS):
                paragraph.append(lines.pop(0))
            yield PageBlock("words", latex_line("\n".join(paragraph)))


def _until(lines: list[str], end: str) -> Iterator[str]:
    """The lines up to the one that begins with the end, taken away with it."""
    while lines:
        line = lines.pop(0)
        if line.startswith(end):
            return
        yield line


def _parted(table: str) -> tuple[str, str, str]:
    end = _HEAD_ENDS.search(table)
    return (table, "", "") if end is None else (table[: end.start()], end[0], table[end.end() :])


def markdown_page(text: str) -> Iterator[PageBlock]:
    """What stands on a page of Markdown."""
    for fenced, block in _markdown_blocks(text):
        if fenced:
            yield PageBlock("lines", lines=tuple(block.split("\n")))
        elif block.startswith("$$\n"):
            inside = block.removeprefix("$$\n\\begin{aligned}\n").removesuffix("\n\\end{aligned}\n$$")
            yield from displayed(inside)
        elif block.startswith("#"):
            yield PageBlock("heading", markdown_line(block.lstrip("#")))
        elif block.startswith("| "):
            head, _, *rows = block.split("\n")
            cells = [_cells(row.strip()[1:-1], "|") for row in (head, *rows)]
            yield PageBlock("table", rows=tuple(tuple(map(markdown_line, row)) for row in cells))
        else:
            yield PageBlock("words", markdown_line(block))


def _markdown_blocks(text: str) -> Iterator[tuple[bool, str]]:
    """(whether it stands between fences, the block)."""
    for k, part in enumerate(re.split(r"^```$\n?", text, flags=re.MULTILINE)):
        if k % 2:
            yield True, part.removesuffix("\n")
        else:
            yield from ((False, block.strip("\n")) for block in re.split(r"\n{2,}", part) if block.strip())


def displayed(rows: str) -> Iterator[PageBlock]:
    r"""The formulas of an aligned block: a row that begins with &\quad or &= goes on with the one before it."""
    formulas: list[list[str]] = []
    for row in rows.split(" \\\\\n"):
        goes_on = row.startswith(("&\\quad ", "&= "))
        lead, mark, rest = row.partition("&")
        bare = (f"{lead}{rest}" if mark else row).removeprefix("\\quad ")
        if goes_on and formulas:
            formulas[-1].append(bare)
        else:
            formulas.append([bare])
    for formula in formulas:
        yield PageBlock("formula", sides=tuple(between_equals(tokens_of(" ".join(formula)))))


def _cells(row: str, between: str) -> list[str]:
    """The cells of a row; what is escaped or stands in a formula parts none."""
    found, in_formula, k = [""], False, 0
    while k < len(row):
        step = 2 if row[k] == "\\" else 1
        piece = row[k : k + step]
        in_formula ^= piece == "$"
        if piece == between and not in_formula:
            found.append("")
        else:
            found[-1] += piece
        k += step
    return found


def latex_line(text: str) -> PageLine:
    """Words of LaTeX, escapes undone."""
    return tuple(_line(text, _latex_character))


def markdown_line(text: str) -> PageLine:
    """Words of Markdown, escapes undone."""
    return tuple(_line(text, _markdown_character))


def _line(text: str, character: Callable[[str, int], tuple[str, int]]) -> Iterator[PagePart]:
    k = 0
    while k < len(text):
        if text[k] == "$":
            end = _formula_ends(text, k + 1)
            yield PagePart(tex=text[k + 1 : end].strip())
            k = end + 1
            continue
        found, k = character(text, k)
        yield from (PagePart(x) for x in spoken(found))


def _formula_ends(text: str, k: int) -> int:
    """Where a formula ends; a dollar in its own \\text belongs to it."""
    depth = 0
    while k < len(text):
        if text[k] == "\\":
            k += 2
            continue
        depth += (text[k] == "{") - (text[k] == "}")
        if text[k] == "$" and depth <= 0:
            return k
        k += 1
    return k


def _latex_character(text: str, k: int) -> tuple[str, int]:
    command = re.compile(r"\\[a-zA-Z]+").match(text, k)
    if command is not None:
        end = command.end()
        known = _COMMANDS.get(command[0])
        if known is not None:
            return known, end + 2 * text.startswith("{}", end)
        return "" if command[0] in _SILENT else command[0], end
    if text[k] == "\\":
        return text[k + 1 : k + 2], k + 2
    return "" if text[k] in "{}" else text[k], k + 1


def _markdown_character(text: str, k: int) -> tuple[str, int]:
    if text[k] == "\\":
        return text[k + 1 : k + 2], k + 2
    if text[k] == "`":
        end = text.find("`", k + 1)
        return (text[k + 1 : end], end + 1) if end > k else (text[k], k + 1)
    return "" if text.startswith("**", k) else text[k], k + 1 + text.startswith("**", k)


PAGES: Mapping[str, Callable[[str], Iterable[PageBlock]]] = {"latex": latex_page, "markdown": markdown_page}


def unlike_words(found: Sequence[PagePart], wanted: str) -> int | None:
    """How many of the parts say these words; None where they say others."""
    rest, k = spoken(wanted), 0
    while rest:
        if k == len(found):
            return None
        said = found[k].character or spoken(said_by(found[k].tex))
        if not said or not rest.startswith(said):
            return None
        rest, k = rest[len(said) :], k + 1
    return k
