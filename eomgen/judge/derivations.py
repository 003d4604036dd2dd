"""A page of somebody -> the verdict on each of its lines, and from the first wrong one on what only carries it on.

A letter that means nothing and stands alone on the left is defined there, and stands for its right side from then on.
What cannot be read is skipped, and listed.
"""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence
from contextlib import suppress
from dataclasses import field, replace
from typing import Any

from eomgen.errors import EomgenError, ExpressionError, UsageError
from eomgen.frozen import dataclass
from eomgen.judge.case import Case
from eomgen.judge.comparison import place_of
from eomgen.judge.decision import is_zero_everywhere
from eomgen.judge.judge import Judge
from eomgen.judge.reading import HandEquation
from eomgen.judge.verdict import EXIT_CODES, RIGHT, UNDECIDED, UNREADABLE, WRONG, Verdict, kind_of_equation
from eomgen.judge.written_pages import PageEquation, equations_of, matrix_of
from eomgen.mechanics.dynamics import Contribution, System
from eomgen.model import Model, Valued
from eomgen.proof import Certificate, certify_judged
from eomgen.study import model_to_study
from eomgen.symbolic.expression import Call, Expression, Scalar, ScalarRow, depends_on

GENERAL = re.compile(r"\\sum\b|\bsum\b|_\{?(?:[ijk]|ik|ij)\}?(?![\w])")
"""a sum, or an index that stands for each of several"""
A_LAW = "a general law: its index stands for each of several"
POTENTIAL = "potential_energy()"


@dataclass(frozen=True)
class DerivationLine:
    """A line of a derivation that was judged.

    Args:
        equation: as it stands on the page.
        verdict: on it.
        defines: the letter that it defines; "".
        carried_on: it is wrong, and follows from an earlier wrong line.
    """

    equation: PageEquation
    verdict: Verdict
    defines: str = ""
    carried_on: bool = False


@dataclass(frozen=True)
class Derivation:
    """A derivation that was judged.

    Args:
        lines: its equations, in their order.
        skipped: formulas that are not judged, and why.
        defined: letters of the author's own, and what they stand for.
    """

    lines: tuple[DerivationLine, ...]
    skipped: tuple[tuple[PageEquation, str], ...] = ()
    defined: Mapping[str, Expression] = field(default_factory=dict)

    @property
    def first_wrong(self) -> DerivationLine | None:
        """The first line that is wrong; None where none is."""
        return next((line for line in self.lines if line.verdict.verdict == WRONG), None)


def judged_derivation(judge: Judge, page: str) -> Derivation:
    """The verdicts on the lines of a page: text, LaTeX or Markdown."""
    lines: list[DerivationLine] = []
    skipped: list[tuple[PageEquation, str]] = []
    defined: dict[str, Expression] = {}
    believed = Believed(judge)
    for equation in equations_of(page):
        found = _line(judge, equation, defined)
        if isinstance(found, str):
            skipped.append((equation, found))
            continue
        if found.verdict.verdict == WRONG:
            written = judge.case.reading.read(equation.text, defined)
            found = replace(found, carried_on=believed.implies(written, found.verdict.kind))
            believed.add(written)
        lines.append(found)
    return Derivation(tuple(lines), tuple(skipped), defined)


def _line(judge: Judge, equation: PageEquation, defined: dict[str, Expression]) -> DerivationLine | str:
    """The verdict on a line; why it is not judged. What it defines is added to what is defined."""
    is_general = GENERAL.search(equation.text) is not None
    try:
        if matrix_of(equation.text) is not None:
            return DerivationLine(equation, judge.verdict(equation.text))
        if (printed := judge.of_printed(equation.text, defined=defined)) is not None:
            return DerivationLine(equation, printed)
        written = judge.case.reading.read(equation.text, defined)
        if is_general and judge.case.unknown_names(written):  # r_i may be a name of the model
            return A_LAW
        if not written.names and not written.calls:
            return "numbers alone: it says nothing"
        if not _names_something(judge, written):
            return "it names nothing of the model"
        if equation.inline and written.name in judge.case.model.parameters and not written.right.names:
            return f"a value that is assumed for {written.name}"
        if letter := _defined_in(judge, written):
            defined[letter] = written.right
            kind = kind_of_equation(written, judge.case.model)
            return DerivationLine(
                equation, Verdict(equation.text, kind, UNDECIDED, reason=f"it defines {letter}"), letter
            )
        verdict = judge.verdict(equation.text, defined=defined)
    except ExpressionError as error:
        return A_LAW if is_general else f"it cannot be read: {error.what}"
    return verdict.reason if verdict.unknown and equation.inline else DerivationLine(equation, verdict)


class Believed:
    """Beliefs of an author after wrong lines: quantities by their letters, energies, equations."""

    def __init__(self, judge: Judge) -> None:
        self.judge = judge
        self.formulas: dict[str, Expression] = {}  # by the text of the function that stands alone on the left
        self.rows: list[Scalar] = []

    def add(self, written: HandEquation) -> None:
        """A wrong line, which is taken for true from now on."""
        code = written.left.code
        if len(code) == 1 and code[0][0] == "call":
            self.formulas.setdefault(str(code[0][1]), written.right)
        with suppress(EomgenError):
            scalar = self.judge.case.value(written.difference)
            if depends_on(scalar, self.judge.case.forced):
                self.rows.append(scalar)

    def implies(self, written: HandEquation, kind: str) -> bool:
        """True if a wrong equation follows from what is believed."""
        case = self.judge.case
        if not self.formulas and not self.rows:
            return False
        with suppress(EomgenError):
            if self.formulas and self.judge.is_right(written.with_calls(self.formulas), kind):
                return True
            scalar = case.value(written.difference)
            if depends_on(scalar, case.forced):
                believed = filter(None, (tuple(self.rows), self._by_energies()))
                return any(case.follows(scalar, rows).holds for rows in believed)
            if POTENTIAL in self.formulas and any(call.name == "generalized_force" for call in written.calls):
                scalar = case.evaluated(written.difference, case.names, self._with_force_of_potential)
                return bool(is_zero_everywhere(case.system, scalar).holds)
        return False

    def _with_force_of_potential(self, call: Call) -> Scalar:
        """A function of the motion; of a generalized force that of the believed potential."""
        case, found = self.judge.case, self.judge.case.called(call)
        if call.name != "generalized_force":
            return found
        apart = case.value(self.formulas[POTENTIAL]) - case.called(Call("potential_energy", ()))
        names = [u.name.removesuffix("'") for u in case.system.symbols.u]
        return found + case.system.scope.from_potential(apart)[names.index(str(call).partition("(")[2][:-1])]

    def _by_energies(self) -> ScalarRow:
        """The equations of motion with the energies that are believed."""
        case = self.judge.case
        wrong = {"T": "kinetic_energy()", "V": POTENTIAL}
        more = {letter: self.formulas[text] for letter, text in wrong.items() if text in self.formulas}
        if not more or case.parts.equations is None:
            return ()
        true = {"T": case.parts.equations.T, "V": case.parts.equations.V}
        apart = {letter: case.value(formula) - true[letter] for letter, formula in more.items()}
        share = Contribution("", T=apart.get("T", 0), V=apart.get("V", 0))
        return tuple(a + b for a, b in zip(case.rows, case.parts.operator.rows(share), strict=True))


def _names_something(judge: Judge, written: HandEquation) -> bool:
    """True if a name or function of the model stands in it."""

    unknown = {*judge.case.unknown_names(written)} - judge.case.model.outputs.keys()
    return bool(written.calls) or len({name.rstrip("'") for name in written.names}) > len(unknown)


def _defined_in(judge: Judge, written: HandEquation) -> str:
    """The letter that an equation defines: unknown, alone on the left, all known on the right; "" where it is none."""
    unknown = judge.case.unknown_names(written)
    left = written.left.code
    alone = left[0][1] if len(left) == 1 and left[0][0] == "name" else ""
    known = judge.case.model.outputs
    return alone if unknown == [alone] and alone not in written.right.names and alone not in known else ""


@dataclass(frozen=True)
class Answered:
    """One equation to be judged.

    Args:
        text: the equation as it was written.
        file, line: its place; "" and 0 for a typed one.
        is_page: it is a whole derivation, of which each line is judged.
    """

    text: str
    file: str = ""
    line: int = 0
    is_page: bool = False


@dataclass(frozen=True)
class Judgements:
    """Verdicts on several equations of one model, in words, for machines, and as an exit code.

    Args:
        judge: of the model.
        found: the verdicts.
        entries: of each, for machines.
        lines: of all, in words; the last counts them, where there are several.
        exit_code: 0 where all are right.
        skipped: formulas of derivations that are not judged, for machines.
        defined: letters that authors define.
    """

    judge: Judge
    found: tuple[Verdict, ...]
    entries: tuple[Mapping[str, Any], ...]
    lines: tuple[str, ...]
    exit_code: int
    skipped: tuple[Mapping[str, Any], ...] = ()
    defined: Mapping[str, Expression] = field(default_factory=dict)

    @property
    def system(self) -> System | None:
        """The system whose equations others are held against; None of a model that has none."""
        equations = self.judge.case.parts.equations
        return None if equations is None else equations.system

    def certify(self, *, again: bool = True) -> Certificate:
        """The proof of the equations against which others are held, and of the verdicts by another decision.

        Args:
            again: the verdicts are decided again, which those at an instant are not.
        """
        equations = self.judge.case.parts.equations
        if equations is None:
            return Certificate(())
        said = [each for verdict in self.found if again for each in self.judge.said(verdict, self.defined)]
        return certify_judged(equations, said)


def judged(
    model: Model,
    requested: Sequence[Answered],
    *,
    at: Any = None,
    from_rest: Mapping[str, Any] | None = None,
    kind: str | None = None,
    hint: int | None = None,
    to_first_order: bool = False,
    about: str | None = None,
) -> Judgements:
    """The verdicts on equations, each with the relations used or the reason why it is wrong.

    Args:
        at, kind: as of `verify`.
        from_rest: positions from which the motion starts with all speeds 0; None: its own start.
        hint: how much is said about what is wrong: 1 where to look, 2 at which quantity, 3 the cause.
        to_first_order, about: as of `verify`.
    Raises:
        UsageError: the only equation cannot be read.
    """
    placed = Valued.of(model, None, from_rest, options=("--set", "--from-rest")).model if from_rest else model
    case = Case(model_to_study(placed), from_rest is not None)
    judge = Judge(case, to_first_order, place_of(case, about))
    found: list[Verdict] = []
    entries: list[dict[str, Any]] = []
    lines: list[str] = []
    codes: list[int] = []
    skipped: list[dict[str, Any]] = []
    defined: dict[str, Expression] = {}
    for each in requested:
        if each.is_page:
            derivation = judged_derivation(judge, each.text)
            defined |= derivation.defined
            for line in derivation.lines:
                found += [] if line.defines else [line.verdict]
                entries.append(_entry_of(line, derivation, each.file, hint))
                lines += _lines_of(line, derivation, each.file, hint)
                codes.append(0 if line.defines else line.verdict.exit_code)
            for equation, why in derivation.skipped:
                skipped.append({"file": each.file, "line": equation.line, "text": equation.text, "why": why})
                lines.append(f"{each.file}:{equation.line}: skipped: {equation.text}\n    {why}")
            continue
        verdict, entry, reported, code = _judged(judge, each, at, kind, hint, alone=len(requested) == 1)
        found += [verdict]
        entries.append(entry | ({"file": each.file, "line": each.line} if each.file else {}))
        lines += [f"{each.file}:{each.line}: {reported[0]}" if each.file else reported[0], *reported[1:]]
        codes.append(code)
    if len(codes) + len(skipped) > 1:
        lines.append(_counted(entries, len(skipped)))
    if not codes and skipped:
        codes.append(UNREADABLE)
    code = next((c for c in (EXIT_CODES[WRONG], UNREADABLE, EXIT_CODES[UNDECIDED]) if c in codes), 0)
    return Judgements(judge, tuple(found), tuple(entries), tuple(lines), code, tuple(skipped), defined)


def _counted(entries: Sequence[Mapping[str, Any]], skipped: int) -> str:
    """Numbers of the right, the wrong, the undecided, of those that define a letter, and of the skipped."""
    judged = [entry for entry in entries if not entry.get("defines")]
    count = {name: sum(entry["verdict"] == name for entry in judged) for name in EXIT_CODES}
    text = f"{count[RIGHT]} right, {count[WRONG]} wrong, {count[UNDECIDED]} undecided"
    text += f", {len(entries) - len(judged)} that define a letter" if len(judged) < len(entries) else ""
    return text + (f", {skipped} skipped" if skipped else "")


def _entry_of(line: DerivationLine, derivation: Derivation, file: str, hint: int | None) -> dict[str, Any]:
    """A line of a derivation for machines."""
    entry = line.verdict.as_dict(hint) | {"file": file, "line": line.equation.line}
    entry |= {"first_wrong": line is derivation.first_wrong, "carried_on": line.carried_on}
    return entry | ({"defines": line.defines} if line.defines else {})


def _lines_of(line: DerivationLine, derivation: Derivation, file: str, hint: int | None) -> list[str]:
    """A line of a derivation in words."""
    head, *rest = line.verdict.lines(hint)
    where = f"{file}:{line.equation.line}"
    if line.defines:
        return [f"{where}: {line.verdict.reason}: {line.equation.text}"]
    if line.carried_on:
        return [f"{where}: {head}", "    it follows from an earlier wrong line"]
    first = ["    this is the first wrong line"] if line is derivation.first_wrong else []
    return [f"{where}: {head}", *first, *rest]


def _judged(
    judge: Judge, each: Answered, at: Any, kind: str | None, hint: int | None, *, alone: bool
) -> tuple[Verdict, dict[str, Any], tuple[str, ...], int]:
    """(the verdict, for machines, for people, exit code) of one equation."""
    try:
        verdict = judge.verdict(each.text, at=at, kind=kind)
    except ExpressionError as error:
        where = f"{each.file}:{each.line}:{error.column + 1}" if each.file else ""
        if alone:
            caret = " " * error.column + "^" * max(1, min(error.length, len(each.text) - error.column))
            raise UsageError(f"{error.what}\n    {each.text}\n    {caret}", where, error.fix) from error
        reported = Verdict(each.text, kind or "", UNDECIDED, reason=f"it cannot be read: {error.what}")
        problem = {"what": error.what, "column": error.column + 1, "fix": error.fix}
        return reported, reported.as_dict() | {"error": problem}, reported.lines(), UNREADABLE
    return verdict, verdict.as_dict(hint), verdict.lines(hint), verdict.exit_code
