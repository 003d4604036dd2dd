"""A page of somebody, text, LaTeX or Markdown -> its equations, each with the line on which it stands.

Rows of `aligned` and the like are equations of their own; one that begins with an equality sign goes on with the left
side of the row before. A chain a = b = c is a = b and a = c. Matrices are compared entry by entry. What stands between
formulas is prose and is passed over. Cases become one formula, and a number with a unit is one in SI.
"""

from __future__ import annotations

import math
import re
from collections.abc import Iterator, Sequence
from dataclasses import replace

from eomgen.errors import ExpressionError
from eomgen.frozen import dataclass
from eomgen.model import Unit
from eomgen.symbolic.expression import Fraction, parse

ROWS = re.compile(r"\\\\(?:\s*\[[^\]]*\])?|\\newline\b|\\cr\b")
DISPLAYS = "equation|align|aligned|alignat|gather|gathered|multline|split|eqnarray|displaymath|math|dmath"
MATRIX = re.compile(r"\\begin\{(?P<kind>[pbvBV]?matrix|array)\}(?:\{[^}]*\})?(?P<inside>.*?)\\end\{(?P=kind)\}", re.S)
ENVIRONMENT = re.compile(rf"\\(?:begin|end)\{{(?:{DISPLAYS})\*?\}}(?:\{{[^}}]*\}})?")
FORMULA = re.compile(
    rf"\\begin\{{(?P<kind>(?:{DISPLAYS})\*?)\}}(?P<environment>.*?)\\end\{{(?P=kind)\}}"
    r"|\\\[(?P<display>.*?)\\\]|\$\$(?P<double>.*?)\$\$|\\\((?P<inline>.*?)\\\)|(?<!\\)\$(?P<single>[^$]+?)(?<!\\)\$",
    re.S,
)
COMMENT = re.compile(r"(?<!\\)%.*")
NUMBERED = re.compile(r"\\(?:label|tag)\*?\{[^}]*\}|\\(?:nonumber|notag)\b")
SIGN = re.compile(r"(?<![<>!:=])=(?!=)")
LABEL = re.compile(r"^\s*(?:\\(?:quad|;|,|!)\s*)*[^:<>≤≥]{0,60}:(?![=:])\s*(?=[^:]*=)")
"""what stands before a colon in front of an equation: sum M_A = 0:, (1):"""
PUT_ASIDE = re.compile(r"(?:\\left|\\right|\s|[()])*\\matrix\{(\d+)\}(?:\\left|\\right|\s|[()])*")
COMMA = re.compile(r",")
BRACKETED = re.compile(r"\[([^\[\]]*)\]")
GOES_ON = "+-*/=)"
CASE = re.compile(r"\s(?:else )?where .+(?:<=|>=|<|>).+$|\sotherwise$")
INSIDE = re.compile(r"\([^()]*\)")
WORDS = re.compile(r"(?<![\w.'\\])[^\W\d_]{2,}[.,;]?\s+[^\W\d_]{2,}(?![\w'(])")
BLANK = r"(?:\s|\\q?quad\b|\\[,;:!]|~)"
CONTINUED = re.compile(rf"{BLANK}*(?:[-+=]|\\(?:cdot|times|pm)\b)|{BLANK}*\\q?quad\b")
SPACE = re.compile(rf"^{BLANK}+")
RULE = re.compile(r"[-=~^#*\s]*$")
OMITTED = re.compile(r"\(\d+ operations, not printed\)")
OPENED, CLOSED = "({[", ")}]"


@dataclass(frozen=True)
class PageEquation:
    """An equation on a page.

    Args:
        text: as it is judged, one equality sign in it.
        line: its number, from 1.
        inline: it stands within a sentence.
    """

    text: str
    line: int
    inline: bool = False


def equations_of(page: str) -> list[PageEquation]:
    """The equations of a page, in their order."""
    if "\\documentclass" in page or ("\\" in page and FORMULA.search(page)):
        return [
            replace(each, inline=inline) for text, line, inline in _formulas(page) for each in _of_display(text, line)
        ]
    return [each for text, line in _paragraphs(page) for each in _chained(text, line)]


def equations_in(given: str) -> list[str]:
    """The single equations of what is given as one: of a chain, of rows; itself where it is one, or none."""
    given = LABEL.sub("", given)
    if len(_signs(given)) < 2 and not ENVIRONMENT.search(given) and not MATRIX.search(given):
        return [given]
    return [each.text for each in _of_display(given, 1)] or [given]


def without_first(several: Sequence[str], unknown: Sequence[str]) -> list[str]:
    """b = c of a chain a = b = c whose first member alone has names that mean nothing; []: it is no such."""
    sides = [each.partition(" = ") for each in several]
    first, others = sides[0][0], [right for _, _, right in sides]
    if len(several) < 2 or any(left != first for left, _, _ in sides) or matrix_of(several[0]) is not None:
        return []
    plain = [re.sub(r"\W|\d|_", "", side) for side in (first, *others)]
    named = [re.sub(r"\W|\d|_", "", name) for name in unknown]
    if not all(name in plain[0] for name in named) or any(name in side for name in named for side in plain[1:]):
        return []
    return [f"{others[0]} = {other}" for other in others[1:]]


# -- LaTeX and Markdown ----------------------------------------------------------------------------------------


def _formulas(page: str) -> Iterator[tuple[str, int, bool]]:
    """(formula, line, True if within a sentence) of all that is set as one."""
    page = "\n".join(COMMENT.sub("", line) for line in page.split("\n"))
    for found in FORMULA.finditer(page):
        text = next(x for x in found.group("environment", "display", "double", "inline", "single") if x is not None)
        start = found.start() + found[0].index(text)
        yield text, page.count("\n", 0, start) + 1, (found["inline"] or found["single"]) is not None


def _of_display(text: str, line: int) -> Iterator[PageEquation]:
    """The equations of a display: row by row; rows without an equality sign belong to the one before."""
    matrices: list[str] = []

    def put_aside(found: re.Match[str]) -> str:
        matrices.append(found["inside"])
        return f"\\matrix{{{len(matrices) - 1}}}"

    text = in_one_formula(text)
    text = NUMBERED.sub("", ENVIRONMENT.sub(lambda found: "\n" * found[0].count("\n"), MATRIX.sub(put_aside, text)))
    rows: list[tuple[str, int]] = []
    at = line
    for row in ROWS.split(text):
        plain = re.sub(r"(?<!\\)&", " ", row)
        if plain.strip():
            begins = at + plain[: len(plain) - len(plain.lstrip())].count("\n")
            if rows and _goes_on(rows[-1][0], plain):
                rows[-1] = (f"{rows[-1][0]} {plain.strip()}", rows[-1][1])
            else:
                rows.append((plain.strip(), begins))
        at += row.count("\n")
    left = ""
    for row, begins in rows:
        row = SPACE.sub("", row)
        if row.startswith("=") and left:
            row = f"{left} {row}"
        for each in _separate(row):
            if signs := _signs(each):
                left = each[: signs[0]].strip()
            for equation in _chained(each, begins):
                yield from _by_entries(equation, matrices)


def _goes_on(before: str, row: str) -> bool:
    """True if a row belongs to the equation of the row before: that has no equality sign yet, or this one has none."""
    if not _signs(before):
        return True
    return not _signs(row) and (CONTINUED.match(row) is not None or _is_open(before))


def _separate(row: str) -> Iterator[str]:
    """Equations side by side, a comma, a semicolon or wide space between them."""
    pieces = [piece for piece in _cut(row, re.compile(r",?\s*\\q?quad\b|(?<!\\);|(?<!\\),\s")) if piece.strip()]
    if len(pieces) > 1 and all(len(_signs(piece)) >= 1 for piece in pieces):
        yield from pieces
    else:
        yield row


def _cut(text: str, at: re.Pattern[str]) -> Iterator[str]:
    """A text cut at a pattern, outside parentheses."""
    depth, start, k = 0, 0, 0
    while k < len(text):
        found = at.match(text, k) if depth == 0 else None
        if found and found.end() > k:
            yield text[start:k]
            start = k = found.end()
            continue
        depth += (text[k] in OPENED) - (text[k] in CLOSED)
        k += 1
    yield text[start:]


def _signs(text: str) -> list[int]:
    """Places of the equality signs outside braces."""
    depth, found = 0, []
    for k, c in enumerate(text):
        depth += (c == "{") - (c == "}")
        if c == "=" and depth <= 0 and SIGN.match(text, k):
            found.append(k)
    return found


def _chained(text: str, line: int) -> Iterator[PageEquation]:
    """a = b = c as a = b and a = c."""
    text = LABEL.sub("", text)
    signs = _signs(text)
    if not signs:
        return
    sides = [text[i:k].strip() for i, k in zip([0, *(k + 1 for k in signs)], [*signs, len(text)], strict=True)]
    if not sides[0] or not all(sides[1:]) or OMITTED.search(text):
        return
    for side in sides[1:]:
        yield PageEquation(f"{sides[0]} = {side}", line)


def _by_entries(equation: PageEquation, matrices: list[str]) -> Iterator[PageEquation]:
    """An equation between matrices of one shape as equations of their entries; K = [[a, b], [b, c]] of a letter."""
    left, _, right = equation.text.partition(" = ")
    sides = [PUT_ASIDE.fullmatch(side) for side in (left, right)]
    if r"\matrix{" not in equation.text:
        yield equation
        return
    if sides[1] and not sides[0]:
        rows = _entries(matrices[int(sides[1][1])])
        yield replace(equation, text=f"{left} = {matrix_text(rows)}")
    if not all(sides):
        return
    one, other = (_entries(matrices[int(side[1])]) for side in sides if side)
    for a, b in zip(one, other, strict=False):
        for x, y in zip(a, b, strict=False):
            if x and y:
                yield PageEquation(f"{x} = {y}", equation.line)


def matrix_text(rows: list[list[str]]) -> str:
    """A matrix as it is judged: [[a, b], [b, c]]."""
    return "[" + ", ".join("[" + ", ".join(row) + "]" for row in rows) + "]"


def matrix_of(text: str) -> tuple[str, list[list[str]]] | None:
    """(letter, entries) of a matrix that is given by its rows, [[a, b], [b, c]] or row by row; None of all else."""
    left, sign, right = text.partition("=")
    found = BRACKETED.findall(right) if sign and right.strip().startswith("[") else []
    if not found or "=" in right:
        return None
    cut = [list(_cut(row, COMMA)) if "," in row else re.split(r"\s{2,}", row.strip()) for row in found]
    return left.strip(), [[x.strip() for x in row if x.strip()] for row in cut]


def _entries(inside: str) -> list[list[str]]:
    """The entries of a matrix, row by row."""
    rows = ([x.strip() for x in re.split(r"(?<!\\)&", row)] for row in ROWS.split(inside))
    return [row for row in rows if any(row)]


# -- text ------------------------------------------------------------------------------------------------------


def _paragraphs(page: str) -> Iterator[tuple[str, int]]:
    """(equation, line) of plain text: a line that stands deeper and begins with a sign goes on with the one before."""
    whole, begun, depth = "", 0, 0
    for number, line in enumerate([*page.split("\n"), ""], start=1):
        text, inset = "" if RULE.match(line) else line.strip(), len(line) - len(line.lstrip())
        if whole and text and inset > depth and (text[0] in GOES_ON or _is_open(whole)):
            whole += f" {text}"
            continue
        if (" where " in whole and text.endswith("otherwise")) or (" where " in whole and CASE.search(text)):
            whole += f"; {text}"
            continue
        if whole and "= [" in whole and text.startswith("[") and text.endswith("]"):
            whole += f" {text}"
            continue
        if _signs(whole):
            yield whole, begun
        is_formula = bool(text) and not text.startswith("=") and not _is_prose(text)
        whole, begun, depth = (text, number, inset) if is_formula else ("", 0, 0)


def _is_open(text: str) -> bool:
    """True if a parenthesis is open at the end, or a sign waits for what follows."""
    return sum((c in OPENED) - (c in CLOSED) for c in text) > 0 or text.endswith(("+", "-", "*", "/", "="))


def _is_prose(text: str) -> bool:
    """True if words stand side by side, outside parentheses, or what follows is announced."""
    return text.endswith(":") or WORDS.search(CASE.sub("", INSIDE.sub("", text))) is not None


# -- numbers with units, and cases ------------------------------------------------------------------------------


@dataclass(frozen=True)
class WrittenNumber:
    """A number as it is written.

    Args:
        text: of the number alone.
        exact: in SI, a text of the grammar.
        half: of its last digit [SI]; 0 of a whole number.
        unit: as it is written; "" where none is.
        dimension: of the unit; None where none is.
    """

    text: str
    exact: str
    half: float
    unit: str = ""
    dimension: tuple[int, ...] | None = None

    @property
    def value(self) -> float:
        """The number in SI."""
        return float(parse(self.exact).evaluate({"pi": math.pi}))


def measured(side: str) -> WrittenNumber | None:
    """A side that is a number with a unit or without, -4.46 m/s, 5.85\\ \\text{N$\\cdot$m}; None of any other.

    What a page says of its way, in brackets behind it, is left out.
    """
    found = _MEASURED.fullmatch(side)
    if found is None:
        return None
    whole, point, behind = found["number"].replace(" ", "").partition(".")
    last = int(found["ten"] or found["power"] or 0) - len(behind)  # power of ten of the last digit
    exact = int(whole + behind) * Fraction(10) ** last
    step = Fraction(10) ** last if point else Fraction(0)
    unit, pi = Unit("1"), ""
    if written := _plain_unit(found["unit"]):
        try:
            unit = Unit.parse(written)
        except ExpressionError:
            return None
        pi = {0: "", 1: "*pi", -1: "/pi"}.get(unit.pi_power, f"*pi^({unit.pi_power})")
    half = float(step * unit.factor) * math.pi**unit.pi_power / 2
    text = found["number"] if not (found["ten"] or found["power"]) else f"({exact})"
    return WrittenNumber(text, f"({exact * unit.factor}){pi}", half, written, unit.dimension if written else None)


def _plain_unit(written: str) -> str:
    """A unit without what typesets it."""
    plain = re.sub(r"\\(?:text|mathrm|mathit|unit|si)\b|\\[,;:! ]|[{}$~]", " ", written)
    plain = re.sub(r"\\cdot\b|·|⋅", "*", plain).replace("°", "deg").replace("\\degree", "deg")
    plain = re.sub(r"\s*\^\s*\(?\s*(-?\d+)\s*\)?", r"^\1", plain)
    return re.sub(r"\s*([*/])\s*", r"\1", plain).strip()


_MEASURED = re.compile(
    r"\s*(?P<number>[-+]?\s*(?:\d+(?:\.\d*)?|\.\d+))(?:[eE](?P<power>[-+]?\d+))?"
    r"(?:\s*(?:\\cdot|\\times|\*|·)\s*10\s*\^\s*\{?\s*(?P<ten>-?\d+)\s*\}?)?"
    r"(?P<unit>(?:\\[,;:! ]|[^=\[\]+()])*?)\s*(?:\[[^\]]*\]\s*(?:\([^()]*\))?)?\s*[.,]?\s*"
)
"""a number, a power of ten, a unit, and in brackets how it was found"""


def in_one_formula(written: str) -> str:
    """One formula of what is written case by case: a where x <= b; c otherwise is a + (c - a)*(1 + sign(x - b))/2."""
    written = _CASES_SET.sub(lambda found: _joined(_rows(found[1])), written)
    if " otherwise" not in written:
        return written
    sides = written.split("=")
    return "=".join(_joined(_text_cases(side)) if " otherwise" in side else side for side in _kept(sides))


def _kept(sides: list[str]) -> list[str]:
    """Sides of an equation that was cut at each sign, relations in conditions put together again."""
    found = [sides[0]]
    for side in sides[1:]:
        if found[-1].endswith(("<", ">")):
            found[-1] += f"={side}"
        else:
            found.append(side)
    return found


def _rows(inside: str) -> list[tuple[str, str]]:
    """(formula, condition) of each row of cases in LaTeX; the last condition is ""."""
    rows = [row for row in re.split(r"\\\\(?:\[[^\]]*\])?", inside) if row.strip()]
    pairs = [re.split(r"(?<!\\)&", row, maxsplit=1) for row in rows]
    return [(pair[0], pair[1] if len(pair) > 1 and _RELATION.search(pair[1]) else "") for pair in pairs]


def _text_cases(side: str) -> list[tuple[str, str]]:
    """(formula, condition) of each case in text."""
    found = []
    for piece in filter(str.strip, side.split(";")):
        formula, _, condition = piece.partition(" where ")
        found.append((formula.removesuffix(" else").removesuffix(" otherwise"), condition))
    return [(formula.strip().removesuffix("otherwise"), condition) for formula, condition in found]


def _joined(cases: list[tuple[str, str]]) -> str:
    """One formula of all cases; each counts where those before it do not."""
    formula, condition = cases[0]
    if len(cases) == 1 or not condition:
        return f"({formula})"
    relation = _RELATION.search(condition)
    if relation is None:
        return f"({formula})"
    low, high = condition[: relation.start()], condition[relation.end() :]
    if relation[0].lstrip("\\").startswith(("g", ">")):
        low, high = high, low
    rest = _joined(cases[1:])
    return f"(({formula}) + ({rest} - ({formula}))*(1 + sign(({low}) - ({high})))/2)"


_CASES_SET = re.compile(r"(?:\\left\s*\\\{)?\s*\\begin\{d?cases\}(.*?)\\end\{d?cases\}(?:\s*\\right\s*\.)?", re.S)
_RELATION = re.compile(r"\\(?:leqslant|geqslant|leq|geq|le|ge|lt|gt)(?![A-Za-z])|<=|>=|<|>|≤|≥")
