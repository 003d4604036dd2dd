"""A page of somebody -> the verdict on each of its lines, and from the first wrong one on what only carries it on.

A letter that means nothing and stands alone on the left is defined there, and stands for its right side from then on.
What cannot be read is skipped, and listed.
"""

from __future__ import annotations

import re
from collections.abc import Mapping
from dataclasses import field

from eomgen.errors import ExpressionError
from eomgen.frozen import dataclass
from eomgen.judge.judge import Judge
from eomgen.judge.reading import HandEquation
from eomgen.judge.verdict import UNDECIDED, Verdict, kind_of_equation
from eomgen.judge.written_pages import PageEquation, equations_of, matrix_of
from eomgen.symbolic.expression import Expression

GENERAL = re.compile(r"\\sum\b|\bsum\b|_\{?(?:[ijk]|ik|ij)\}?(?![\w])")
"""a sum, or an index that stands for each of several"""


@dataclass(frozen=True)
class DerivationLine:
    """A line of a derivation that was judged.

    Args:
        equation: as it stands on the page.
        verdict: on it.
        defines: the letter that it defines; "".
    """

    equation: PageEquation
    verdict: Verdict
    defines: str = ""


@dataclass(frozen=True)
class Derivation:
    """A derivation that was judged.

    Args:
        lines: its equations, in their order.
        skipped: formulas that cannot be read, and why.
        defined: letters of the author's own, and what they stand for.
    """

    lines: tuple[DerivationLine, ...]
    skipped: tuple[tuple[PageEquation, str], ...] = ()
    defined: Mapping[str, Expression] = field(default_factory=dict)


def judged_derivation(judge: Judge, page: str) -> Derivation:
    """The verdicts on the lines of a page: text, LaTeX or Markdown."""
    lines: list[DerivationLine] = []
    skipped: list[tuple[PageEquation, str]] = []
    defined: dict[str, Expression] = {}
    for equation in equations_of(page):
        if GENERAL.search(equation.text):
            skipped.append((equation, "a general law: its index stands for each of several"))
            continue
        try:
            if matrix_of(equation.text) is not None:
                lines.append(DerivationLine(equation, judge.verdict(equation.text)))
                continue
            written = judge.case.reading.read(equation.text, defined)
            if not written.names and not written.calls:
                skipped.append((equation, "numbers alone: it says nothing"))
                continue
            if not _names_something(judge, written):
                skipped.append((equation, "it names nothing of the model"))
                continue
            if equation.inline and written.name in judge.case.model.parameters and not written.right.names:
                skipped.append((equation, f"a value that is assumed for {written.name}"))
                continue
            letter = _defined_in(judge, written)
            if letter:
                defined[letter] = written.right
                kind = kind_of_equation(written, judge.case.model)
                verdict = Verdict(equation.text, kind, UNDECIDED, reason=f"it defines {letter}")
            else:
                verdict = judge.verdict(equation.text, defined=defined)
        except ExpressionError as error:
            skipped.append((equation, str(error)))
            continue
        if verdict.unknown and equation.inline:
            skipped.append((equation, verdict.reason))
        else:
            lines.append(DerivationLine(equation, verdict, letter))
    return Derivation(tuple(lines), tuple(skipped), defined)


def _names_something(judge: Judge, written: HandEquation) -> bool:
    """True if a name or function of the model stands in it."""
    return bool(written.calls) or len({name.rstrip("'") for name in written.names}) > len(
        judge.case.unknown_names(written)
    )


def _defined_in(judge: Judge, written: HandEquation) -> str:
    """The letter that an equation defines: unknown, alone on the left, all known on the right; "" where it is none."""
    unknown = judge.case.unknown_names(written)
    left = written.left.code
    alone = left[0][1] if len(left) == 1 and left[0][0] == "name" else ""
    known = judge.case.model.outputs
    return alone if unknown == [alone] and alone not in written.right.names and alone not in known else ""
